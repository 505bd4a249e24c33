"""Operating points: frequency, phase and amplitude ratio of two drives; two-mode approximation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, PointForce, PointMass
from verify.analysis.solution_cache import SolutionCache
from verify.analytic_modes import ExactModel
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.fem_beam import HermiteModel
from verify.linear.field import point_force
from verify.problem.device import Device
from verify.quantities.base import evaluate
from verify.scene.load import scene_from
from verify.segment_model import SegmentModel
from verify.travelling_wave import DrivenCase, OperatingMap, best_drive, measure, middle_half
from verify.waves.two_modes import lumped_swr

# --- Operating point ---

WINDOW = (0.1825, 0.5475)
"""The middle half of 0.73 m."""


def built(model, beam, count):
    return (
        ExactModel(beam) if model == "analytic" else {"segment": SegmentModel, "fem": HermiteModel}[model](beam, count)
    )


def land(beam, model="analytic", count=None):
    drives = (PointForce(position=0.021, amplitude=1.3), PointForce(position=0.709, amplitude=1.3))
    return OperatingMap(DrivenCase(model=built(model, beam, count), forces=drives, frequency_hz=1510.0))


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 75)])
def test_a_point_reads_what_the_field_itself_measures(titanium_strip, model, count):
    """The sum over unit forces against one field solved directly, with losses and unequal forces."""
    beam = replace(titanium_strip, loss_factor=0.013)
    drives = (PointForce(position=0.021, amplitude=1.3, phase_deg=0.0), PointForce(position=0.66, amplitude=0.9))
    case = DrivenCase(model=built(model, beam, count), forces=drives, frequency_hz=1510.0)
    frequency = 1510.0
    gamma, speed = OperatingMap(case).over(np.array([frequency, 1.01 * frequency]), np.array([-31.0, 68.0]))
    for i, hertz in enumerate((frequency, 1.01 * frequency)):
        for j, phase in enumerate((-31.0, 68.0)):
            turned = (drives[0], replace(drives[1], phase_deg=phase))
            direct = measure(case.model.harmonic(turned, hertz), WINDOW, case.wavenumber(hertz))
            assert gamma[i, j] == pytest.approx(direct.reflection, rel=1e-6)
            assert speed[i, j] == pytest.approx(direct.crest_speed, rel=1e-6)


@pytest.mark.parametrize(
    ("search", "edge"),
    [((0.98, 1.02), 0.98), ((1.0, 1.03), 1.03), ((0.94, 1.0), None), ((1.01, 1.06), None)],
)
def test_the_fastest_point_says_whether_it_is_one_or_where_the_search_ends(titanium_strip, search, edge):
    """Towards each resonance crests grow faster: the search ends on its lower or its upper edge, or finds the top."""
    lossy = replace(titanium_strip, loss_factor=1e-3)
    middle = (17.5 * np.pi / 0.73) ** 2 * lossy.wave_constant / (2 * np.pi)
    frequencies = np.linspace(*search, 61) * middle
    found = land(lossy).fastest(frequencies, 1.0, 0.1)
    assert found.reflection <= 0.1 + 1e-12
    reflection, speed = land(lossy).over(frequencies, np.linspace(5.0, 175.0, 681))
    assert abs(found.crest_speed) >= abs(speed)[reflection <= 0.1].max()
    if edge is None:
        assert frequencies[1] < found.frequency_hz < frequencies[-2]
        assert not found.at_edge
    else:
        assert found.frequency_hz == pytest.approx(edge * middle, rel=1e-6)
        assert found.at_edge


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
def test_a_resonance_is_a_gap_of_the_map_and_refused_alone(titanium_strip, model):
    here = land(titanium_strip, model, None if model == "analytic" else 90)
    resonance = float(here.case.model.modes(18).frequencies_hz[17])
    gamma, speed = here.over(np.array([resonance, resonance + 1.0]), np.array([77.0]))
    assert np.isnan([gamma[0, 0], speed[0, 0]]).all()
    assert 0.0 < gamma[1, 0] < 1.0
    with pytest.raises(ResonanceError, match="undamped resonance"):
        here.over(np.array([resonance]), np.array([77.0]))


# --- Best drive ---


def brass(tip=0.002, loss_factor=0.0):
    return Beam(
        length=0.3,
        width=0.012,
        thickness=0.0008,
        youngs_modulus=100e9,
        density=8500.0,
        supports=("clamped", "free"),
        mass=(PointMass(position=0.3, mass=tip),),
        loss_factor=loss_factor,
    )


def brass_case(model=ExactModel, positions=(0.02, 0.28), frequency=2000.0, loss_factor=0.0, **settings):
    forces = tuple(PointForce(position=p) for p in positions)
    return DrivenCase(model=model(brass(loss_factor=loss_factor)), forces=forces, frequency_hz=frequency, **settings)


def swr(case, ratio, phase_deg, frequency=None):
    """Of the field solved with both actuators at once."""
    second = point_force(case.forces[1].position, ratio * np.exp(1j * np.deg2rad(phase_deg)))
    hertz = frequency or case.frequency_hz
    field = case.field((case.forces[0], second), hertz)
    return measure(field, middle_half(case.beam), case.wavenumber(hertz)).standing_wave_ratio


@pytest.mark.parametrize("direction", [1, -1])
def test_a_ratio_leaves_no_reflection_where_equal_amplitudes_leave_1_8(direction):
    """A brass cantilever with a tip mass; no phase on a fine circle does better at equal amplitudes."""
    case = brass_case()
    best = best_drive(case, direction=direction)
    assert best.equal_standing_wave_ratio == pytest.approx(1.763, abs=1e-3)
    circle = [swr(case, 1.0, phase) for phase in np.arange(-180.0, 180.0, 3.0)]
    assert 0.0 <= min(circle) / best.equal_standing_wave_ratio - 1.0 < 3e-3
    assert swr(case, 1.0, best.equal_phase_deg) == pytest.approx(best.equal_standing_wave_ratio, rel=1e-6)
    assert best.standing_wave_ratio == pytest.approx(1.0, abs=1e-12)
    assert swr(case, best.ratio, best.phase_deg) == pytest.approx(1.0, abs=1e-6)
    assert (best.ratio, best.phase_deg) == pytest.approx((1.538, 47.957 * direction), abs=1e-3)
    field = case.field(
        (case.forces[0], point_force(0.28, best.ratio * np.exp(1j * np.deg2rad(best.phase_deg)))), 2000.0
    )
    assert measure(field, middle_half(case.beam)).waves.direction == direction


@pytest.mark.parametrize("model", [ExactModel, lambda b: SegmentModel(b, 80), lambda b: HermiteModel(b, 80)])
@pytest.mark.parametrize(
    "settings", [{}, {"kind": "displacement"}, {"devices": (Device(position=0.26, dashpot=0.02),)}]
)
def test_the_best_ratio_of_all_models_under_forces_displacements_and_devices_leaves_a_pure_wave(model, settings):
    case = brass_case(model, positions=(0.02, 0.28), loss_factor=0.01, **settings)
    window = (0.08, 0.24)
    best = best_drive(case, window)
    second = point_force(0.28, best.ratio * np.exp(1j * np.deg2rad(best.phase_deg)))
    field = case.field((case.forces[0], second), 2000.0)
    assert measure(field, window, case.wavenumber(2000.0)).standing_wave_ratio == pytest.approx(1.0, abs=1e-6)
    assert best.equal_standing_wave_ratio > 1.02


def test_the_best_ratio_is_a_quantity():
    table = {"position": 0.3, "mass": 0.002}
    beam = {"length": 0.3, "width": 0.012, "thickness": 0.0008, "youngs_modulus": 100e9, "density": 8500.0}
    drive = {"frequency_hz": 2000.0, "force": [{"position": 0.02}, {"position": 0.28, "phase_deg": 90.0}]}
    beam |= {"supports": ["clamped", "free"], "mass": [table]}
    scene = scene_from({"name": "brass", "beam": beam, "drive": drive})
    cache, best = SolutionCache(scene.beam), best_drive(brass_case())
    for model in ({}, {"model": "segment", "count": 80}, {"model": "fem", "count": 80}):
        assert evaluate("wave.best_ratio", model, scene, cache) == pytest.approx(best.ratio, rel=2e-4)
        assert evaluate("wave.best_ratio_phase", model, scene, cache) == pytest.approx(best.phase_deg, rel=2e-3)
    assert evaluate("wave.best_ratio_phase", {"direction": "-x"}, scene, cache) == pytest.approx(-best.phase_deg)


def test_the_ratio_for_a_band_is_the_best_in_the_mean_square():
    case, band = brass_case(), np.linspace(1950.0, 2050.0, 7)
    best = best_drive(case, frequencies_hz=band)
    assert best.reflection.max() > 1e-3

    def mean_square(ratio, phase_deg):
        """Backward over forward power, of fields solved with both actuators at once."""
        second = point_force(0.28, ratio * np.exp(1j * np.deg2rad(phase_deg)))
        waves = [
            measure(case.field((case.forces[0], second), f), middle_half(case.beam), case.wavenumber(f)).waves
            for f in band
        ]
        return sum(abs(w.backward) ** 2 for w in waves) / sum(abs(w.forward) ** 2 for w in waves)

    least = mean_square(best.ratio, best.phase_deg)
    for ratio, phase in ((1.02, 0.0), (0.98, 0.0), (1.0, 1.5), (1.0, -1.5), (1.01, 1.0)):
        assert mean_square(best.ratio * ratio, best.phase_deg + phase) > least
    assert best_drive(case, frequencies_hz=band[:1]).reflection == pytest.approx([0.0], abs=1e-12)


def test_a_drive_says_where_an_actuator_is_near_a_node_and_where_no_ratio_exists():
    node = best_drive(brass_case(positions=(0.02, 0.28), frequency=5000.0))
    assert node.ratio < 0.1
    assert "the amplitude at 0.02 m is 15.9 times the other: it acts near a node, move it" in node.note
    resonance = float(ExactModel(brass()).modes(10).frequencies_hz[9])
    near, none = (best_drive(brass_case(frequency=resonance * (1.0 + off))) for off in (1e-4, 1e-7))
    assert "nearly the same standing wave" in near.note
    near.check_exists()
    assert np.isnan(none.ratio)
    with pytest.raises(NoFigureError, match="both actuators make the same standing wave"):
        none.check_exists()
    assert best_drive(brass_case()).note == ""


# --- Lumped ---

SIZES = {"length": 0.83, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 193e9, "density": 7900.0}
STRIP = Beam(**SIZES)
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
TWO = [PointForce(position=0.0116), PointForce(position=0.5 - 0.0116, phase_deg=90.0)]


@given(lower=st.integers(1, 60), part=st.floats(0.01, 0.99))
def test_neighbours_of_a_pinned_beam_have_the_ratio_of_a_tangent(lower, part):
    found = lumped_swr(STRIP, part * STRIP.length, (lower, lower + 1))[0]
    half = 0.5 * np.pi * part
    assert found == pytest.approx(max(np.tan(half), 1.0 / np.tan(half)), rel=1e-7)


def test_it_is_right_at_mid_span_of_the_papers_beam_and_wrong_at_a_quarter():
    """REFERENCE-motor, section 2: 1 and 2.414 where the field has 1.056 everywhere."""
    field = ExactModel(PAPER).harmonic(TWO, 4276.0)
    for window in ((0.15, 0.25), (0.27, 0.36)):
        assert measure(field, window, field.wavenumber).standing_wave_ratio == pytest.approx(1.0563563, abs=1e-5)
    lumped = lumped_swr(PAPER, [0.25, 0.125, 0.375])
    assert lumped == pytest.approx([1.0, 1.0 + np.sqrt(2.0), 1.0 + np.sqrt(2.0)], rel=1e-9)


def test_two_equal_modes_are_a_standing_wave():
    with pytest.raises(InputError, match=r"modes = \[4, 4\]: one mode with itself stands"):
        lumped_swr(STRIP, 0.1, (4, 4))
    with pytest.raises(InputError, match=r"beam\.mass: two modes are one wave on"):
        lumped_swr(brass(), 0.1)
