"""Operating points: frequency, phase and amplitude ratio of two drives; two-mode approximation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, PointForce, PointMass
from verify.analytic_modes import ExactModel
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.fem_beam import HermiteModel
from verify.linear.field import point_force
from verify.linear.registry import MODELS
from verify.problem.device import Device
from verify.segment_model import SegmentModel
from verify.travelling_wave import DrivenCase, best_drive, maximum_crest_speed, measure, middle_half
from verify.waves.driven_case import unit_waves
from verify.waves.operating_point import frequency_band
from verify.waves.two_modes import lumped_swr
from verify.waves.two_waves import Waveguide

# --- Operating point ---

WINDOW = (0.1825, 0.5475)
"""The middle half of 0.73 m."""


def case_of(beam, model="analytic", count=None, frequency=1510.0, second=1.3):
    drives = (PointForce(position=0.021, amplitude=1.3), PointForce(position=0.709, amplitude=second))
    return DrivenCase(model=MODELS[model].build(beam, count), forces=drives, frequency_hz=frequency)


def over(case, frequencies, phases_deg):
    """(reflection, crest speed) on a grid by superposed unit waves."""
    waves = unit_waves(case, frequencies, WINDOW)
    drives = np.array([[one.amplitude * np.exp(1j * i * np.deg2rad(phases_deg))] for i, one in enumerate(case.forces)])
    plus, minus = waves.superposed(drives[:, 0])
    omega = 2 * np.pi * frequencies[:, None]
    sizes = np.sort([abs(plus), abs(minus)], axis=0)
    return sizes[0] / sizes[1], Waveguide(case.beam).crest_speed(omega, waves.k[:, None], plus, minus)


@pytest.mark.parametrize(("limit", "second"), [(None, 1.3), (1.6, 1.1), (1.9, 1.3)])
def test_between_the_ends_of_the_frequency_band_the_wave_is_as_pure_as_asked(titanium_strip, limit, second):
    case, span = case_of(replace(titanium_strip, loss_factor=0.004), second=second), 0.06
    case = replace(case, forces=(case.forces[0], replace(case.forces[1], phase_deg=83.0)))
    low, high = frequency_band(case, limit, span)
    scan = np.linspace(low - 1.0, high + 1.0, 4001)
    gammas = over(case, scan, np.array([83.0]))[0][:, 0]
    ratios, inside = (1.0 + gammas) / (1.0 - gammas), (scan > low) & (scan < high)
    most = limit or 1.1 * ratios.min()
    assert ratios[inside].max() == pytest.approx(most, rel=2e-3)
    assert ratios[[0, -1]].min() > most
    assert high - low > 1.0
    with pytest.raises(InputError, match="limit"):
        frequency_band(case, 1.0 + 0.5 * (ratios.min() - 1.0), span)


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 75)])
def test_superposed_unit_waves_are_the_wave_that_the_field_itself_carries(titanium_strip, model, count):
    """Unit forces at many frequencies against one field solved directly, with losses and unequal forces."""
    case = case_of(replace(titanium_strip, loss_factor=0.013), model, count, second=0.9)
    frequencies, phases = np.array([1510.0, 1525.1]), np.array([-31.0, 68.0])
    gamma, speed = over(case, frequencies, phases)
    for i, hertz in enumerate(frequencies):
        for j, phase in enumerate(phases):
            turned = (case.forces[0], replace(case.forces[1], phase_deg=phase))
            direct = measure(case.model.harmonic(turned, hertz), WINDOW, case.wavenumber(hertz))
            assert gamma[i, j] == pytest.approx(direct.reflection, rel=1e-6)
            assert speed[i, j] == pytest.approx(direct.crest_speed, rel=1e-6)


@pytest.mark.parametrize("limit", [0.04, 0.1, 0.8])
@pytest.mark.parametrize(("centre", "edge"), [(1.0, 0.98), (1.01, 1.03), (0.97, None), (1.035, None)])
def test_the_fastest_point_is_no_slower_than_any_of_a_fine_grid(titanium_strip, centre, edge, limit):
    """Towards each resonance crests grow faster: the search ends on its lower or its upper edge, or inside."""
    lossy = replace(titanium_strip, loss_factor=1e-3)
    middle = (17.5 * np.pi / 0.73) ** 2 * lossy.wave_constant / (2 * np.pi)
    span = 0.02 if edge else 0.025
    case = case_of(lossy, frequency=centre * middle)
    best = maximum_crest_speed(case, limit, span / centre)
    assert best.reflection <= limit + 1e-12
    frequencies = np.linspace(centre - span, centre + span, 61) * middle
    reflection, speed = over(case, frequencies, np.linspace(5.0, 175.0, 681))
    allowed = reflection <= limit
    if allowed.any():
        assert 0.0 <= abs(best.crest_speed) / abs(speed)[allowed].max() - 1.0 < 0.05
    turned = (case.forces[0], replace(case.forces[1], phase_deg=best.phase_deg))
    direct = measure(case.model.harmonic(turned, best.frequency_hz), WINDOW, case.wavenumber(best.frequency_hz))
    assert direct.crest_speed == pytest.approx(best.crest_speed, rel=1e-6)
    assert best.at_edge == (min(abs(best.frequency_hz - frequencies[[0, -1]])) < 1e-3)
    if limit == 0.1:
        assert best.at_edge == (edge is not None)
        assert edge is None or best.frequency_hz == pytest.approx(edge * middle, rel=1e-6)


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
def test_a_resonance_is_a_gap_among_other_frequencies_and_refused_alone(titanium_strip, model):
    case = case_of(titanium_strip, model, None if model == "analytic" else 90)
    resonance = float(case.model.modes(18).frequencies_hz[17])
    gamma, speed = over(case, np.array([resonance, resonance + 1.0]), np.array([77.0]))
    assert np.isnan([gamma[0, 0], speed[0, 0]]).all()
    assert 0.0 < gamma[1, 0] < 1.0
    with pytest.raises(ResonanceError, match="undamped resonance"):
        over(case, np.array([resonance]), np.array([77.0]))


# --- Best drive ---


BRASS = {"length": 0.3, "width": 0.012, "thickness": 0.0008, "youngs_modulus": 100e9, "density": 8500.0}


def brass(tip=0.002, loss_factor=0.0):
    body = PointMass(position=0.3, mass=tip)
    return Beam(**BRASS, supports=("clamped", "free"), mass=(body,), loss_factor=loss_factor)


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


def test_near_a_resonance_the_unit_waves_are_proportional_and_at_it_no_ratio_exists():
    resonance = float(ExactModel(brass()).modes(10).frequencies_hz[9])
    near, none = (best_drive(brass_case(frequency=resonance * (1.0 + off))) for off in (1e-4, 1e-7))
    assert near.independence < 0.05
    assert "both actuators make the same standing wave" in near.note
    near.check_exists()
    assert np.isnan(none.ratio)
    with pytest.raises(NoFigureError, match="both actuators make the same standing wave"):
        none.check_exists()
    assert best_drive(brass_case()).note == ""


# --- Lumped ---

SIZES = {"length": 0.83, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 193e9, "density": 7900.0}
STRIP = Beam(**SIZES)


@given(lower=st.integers(1, 60), part=st.floats(0.01, 0.99))
def test_neighbours_of_a_pinned_beam_have_the_ratio_of_a_tangent(lower, part):
    found = lumped_swr(STRIP, part * STRIP.length, (lower, lower + 1))[0]
    half = 0.5 * np.pi * part
    assert found == pytest.approx(max(np.tan(half), 1.0 / np.tan(half)), rel=1e-7)


def test_two_equal_modes_are_a_standing_wave():
    with pytest.raises(InputError, match=r"modes = \[4, 4\]: give two different modes"):
        lumped_swr(STRIP, 0.1, (4, 4))
    with pytest.raises(InputError, match=r"beam\.mass"):
        lumped_swr(brass(), 0.1)
