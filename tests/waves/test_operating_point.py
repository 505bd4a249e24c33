"""Operating points: frequency, phase, two-mode approximation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, PointForce, PointMass, analytic_modes, travelling_wave
from verify.errors import InputError, ResonanceError
from verify.linear.catalogue import MODELS
from verify.waves.best_phase import TRIED, phases_to_try
from verify.waves.driven import own_wavenumber
from verify.waves.operating_point import Landscape
from verify.waves.two_modes import TwoModes, local_swr, local_waves

# --- Operating point ---

WINDOW = (0.1825, 0.5475)
"""The middle half of 0.73 m."""


def reflection(beam, frequency, phase_deg):
    """Gamma between two equal forces at equal distances: |sin((kL + phi)/2)| over |sin((kL - phi)/2)|, or its inverse.

    w ~ sin k(L - x) + e^{i phi} sin kx; the near field e^{-kL/4} is left out.
    """
    turn, phi = beam.length * np.sqrt(2 * np.pi * frequency / beam.wave_constant), np.deg2rad(phase_deg)
    sizes = sorted(abs(np.sin(0.5 * (turn + side * phi))) for side in (1, -1))
    return sizes[0] / sizes[1]


def land(beam, model="analytic", count=None):
    drives = (PointForce(position=0.021, amplitude=1.3), PointForce(position=0.709, amplitude=1.3))
    return Landscape(beam=beam, forces=drives, model=model, count=count)


def mean_change(beam, frequency, phase, hertz, degrees):
    """Over half a step on each side."""
    middle = reflection(beam, frequency, phase)
    ahead, back = (reflection(beam, frequency + s * hertz, phase + s * degrees) for s in (0.5, -0.5))
    return abs(ahead - middle) + abs(back - middle)


@pytest.mark.parametrize(("turns", "phase"), [(17.31, 77.0), (17.69, 77.0), (18.27, -128.0), (17.5, 90.0)])
def test_sensitivities_are_the_mean_changes_of_the_closed_form(titanium_strip, turns, phase):
    """In size, on a slope and in the least reflection alike: there both sides rise, and no change is less than zero."""
    frequency = (turns * np.pi / 0.73) ** 2 * titanium_strip.wave_constant / (2 * np.pi)
    found = land(titanium_strip).point(frequency, phase, "here")
    assert found.reflection == pytest.approx(reflection(titanium_strip, frequency, phase), rel=1e-4, abs=1e-6)
    assert found.per_hertz == pytest.approx(mean_change(titanium_strip, frequency, phase, 1.0, 0.0), rel=1e-4, abs=1e-7)
    assert found.per_degree == pytest.approx(
        mean_change(titanium_strip, frequency, phase, 0.0, 1.0), rel=1e-4, abs=1e-7
    )
    assert min(found.per_hertz, found.per_degree) > 5e-4
    assert (found.frequency_hz, found.phase_deg, found.what, found.note) == (frequency, phase, "here", "")


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 75)])
def test_a_point_reads_what_the_field_itself_measures(titanium_strip, model, count):
    """The sum over unit forces against one field solved directly, with losses and unequal forces."""
    beam = replace(titanium_strip, loss_factor=0.013)
    drives = (PointForce(position=0.021, amplitude=1.3, phase_deg=0.0), PointForce(position=0.66, amplitude=0.9))
    here = Landscape(beam=beam, forces=drives, model=model, count=count)
    frequency = 1510.0
    found = here.point(frequency, 68.0, "here")

    def measured(frequency, phase):
        turned = (drives[0], replace(drives[1], phase_deg=phase))
        field = MODELS[model].solve_harmonic(beam, turned, frequency, count)
        return travelling_wave.measure(field, WINDOW, own_wavenumber(field))

    direct = measured(frequency, 68.0)
    assert found.reflection == pytest.approx(direct.reflection, rel=1e-6)
    assert found.crest_speed == pytest.approx(direct.crest_speed, rel=1e-6)
    for name, hertz, degrees in (("per_hertz", 0.5, 0.0), ("per_degree", 0.0, 0.5)):
        sides = [measured(frequency + s * hertz, 68.0 + s * degrees).reflection for s in (1, -1)]
        expected = sum(abs(side - direct.reflection) for side in sides)
        assert getattr(found, name) == pytest.approx(expected, rel=1e-4), name
        assert expected > 1e-6


@pytest.mark.parametrize(
    ("search", "edge"),
    [((0.98, 1.02), 0.98), ((1.0, 1.03), 1.03), ((0.94, 1.0), None), ((1.01, 1.06), None)],
)
def test_the_fastest_point_says_whether_it_is_one_or_where_the_search_ends(titanium_strip, search, edge):
    """Towards each resonance crests grow faster: the search ends on its lower or its upper edge, or finds the top."""
    lossy = replace(titanium_strip, loss_factor=1e-3)
    middle = (17.5 * np.pi / 0.73) ** 2 * lossy.wave_constant / (2 * np.pi)
    frequencies = np.linspace(*search, 61) * middle
    found = land(lossy).fast_point(frequencies, 90.0, 0.1)
    assert found.reflection <= 0.1 + 1e-12
    reflection, speed = land(lossy).over(frequencies, np.linspace(5.0, 175.0, 681))
    assert abs(found.crest_speed) >= abs(speed)[reflection <= 0.1].max()
    if edge is None:
        assert frequencies[1] < found.frequency_hz < frequencies[-2]
        assert found.note == ""
    else:
        assert found.frequency_hz == pytest.approx(edge * middle, rel=1e-6)
        assert f"grows off the search, at its edge, {found.frequency_hz:.6g} Hz" in found.note
        assert found.what == "crest speed with a reflection up to 0.1, grows off the search, at its edge"


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
def test_a_point_that_resonates_or_whose_neighbour_does_says_so(titanium_strip, model):
    """A change is read half a hertz to both sides."""
    here = land(titanium_strip, model, None if model == "analytic" else 90)
    resonance = float(MODELS[model].solve_modes(titanium_strip, 18, 90).frequencies_hz[17])
    for away in (-0.5, 0.0, 0.5):
        with pytest.raises(ResonanceError, match="undamped resonance"):
            here.point(resonance + away, 77.0, "there")
    assert here.point(resonance + 0.7, 77.0, "there").per_hertz > 0.0


# --- Best phase ---

CIRCLE = 4001
CASES = 400


def waves(seed, scale=3e-6):
    """Amplitudes of both drives in either wave, (CASES, 2) each, all sizes and phases different."""
    parts = np.random.default_rng(seed).standard_normal((4, CASES, 2))
    return scale * (parts[0] + 1j * parts[1]), 0.7 * scale * (parts[2] + 1j * parts[3])


def figures(forward, backward, phases):
    """(reflection, crest speed but for a factor), (n, p) each."""
    plus, minus = (abs(w[:, :1] + w[:, 1:] * np.exp(1j * phases)) ** 2 for w in (forward, backward))
    reflection = np.sqrt(np.minimum(plus, minus) / np.maximum(plus, minus))
    return reflection, abs(plus - minus) / np.sqrt(plus + minus)


def fastest(forward, backward, limit, phases):
    """The largest allowed speed among phases, (n,); 0 where none is allowed."""
    reflection, speed = figures(forward, backward, phases)
    return np.where(reflection <= limit + 1e-13, speed, 0.0).max(axis=1)


@pytest.mark.parametrize("limit", [0.05, 0.1, 0.43, 0.97])
@pytest.mark.parametrize("ends", [(0.087, 3.05), (-3.05, -0.087), (0.4, 1.7)])
def test_no_phase_of_a_fine_circle_beats_the_ten_that_are_tried(limit, ends):
    forward, backward = waves(11)
    tried = phases_to_try(forward, backward, limit, ends)
    assert tried.shape == (CASES, TRIED)
    assert ((tried >= ends[0]) & (tried <= ends[1])).all()
    found = fastest(forward, backward, limit, tried)
    every = fastest(forward, backward, limit, np.linspace(*ends, CIRCLE))
    assert (found >= every * (1.0 - 1e-15)).all()
    assert np.count_nonzero(every) > 9
    allowed = every > 0.0  # a fine circle comes as near as its steps are small
    assert found[allowed] == pytest.approx(every[allowed], rel=5e-3)


@pytest.mark.parametrize("scale", [1e-60, 1.0, 1e60, 1e-190, 1e160])
def test_amplitudes_of_any_size_have_the_same_best_phase(scale):
    forward, backward = waves(7, 1.0)
    plain = phases_to_try(forward, backward, 0.3, (0.1, 3.0))
    assert np.sort(phases_to_try(scale * forward, scale * backward, 0.3, (0.1, 3.0))) == pytest.approx(
        np.sort(plain), abs=1e-7
    )


# --- Lumped ---

SIZES = {"length": 0.83, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 193e9, "density": 7900.0}
STRIP = Beam(**SIZES)
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
TWO = [PointForce(position=0.0116), PointForce(position=0.5 - 0.0116, phase_deg=90.0)]


@given(lower=st.integers(1, 60), part=st.floats(0.01, 0.99))
def test_neighbours_of_a_pinned_beam_have_the_ratio_of_a_tangent(lower, part):
    found = TwoModes(beam=STRIP, modes=(lower, lower + 1)).local_swr(part * STRIP.length)[0]
    half = 0.5 * np.pi * part
    assert found == pytest.approx(max(np.tan(half), 1.0 / np.tan(half)), rel=1e-7)


def test_it_is_right_at_mid_span_of_the_papers_beam_and_wrong_at_a_quarter():
    """REFERENCE-motor, section 2: 1 and 2.414 where the field has 1.056 everywhere."""
    field = analytic_modes.solve_harmonic(PAPER, TWO, 4276.0)
    everywhere = local_swr(field, np.linspace(0.03, 0.47, 45))
    assert np.ptp(everywhere) < 1e-9
    assert everywhere[0] == pytest.approx(1.0563563, abs=1e-6)
    lumped = TwoModes(beam=PAPER).local_swr([0.25, 0.125, 0.375])
    assert lumped == pytest.approx([1.0, 1.0 + np.sqrt(2.0), 1.0 + np.sqrt(2.0)], rel=1e-9)


@pytest.mark.parametrize(
    "supports", [("clamped", "free"), ("free", "free"), ("guided", "pinned"), ("clamped", "pinned")]
)
def test_of_any_ends_the_near_fields_are_left_out(supports):
    """Beside a clamped end the modes are no sines; what waves in them is, and sines alone are fitted far from it."""
    beam = Beam(**SIZES, supports=supports)
    picture = TwoModes(beam=beam, modes=(17, 18), ratio=0.8, phase_deg=70.0)
    x = np.linspace(0.0, beam.length, 401)
    parts = []
    for mode in picture.modes:
        k = picture.wavenumber(mode)
        shape = analytic_modes.mode_shape(beam, mode, x)
        middle = slice(150, 250)
        basis = np.stack([np.exp(-1j * k * x[middle]), np.exp(1j * k * x[middle])], axis=1)
        parts.append(np.linalg.lstsq(basis, shape[middle].astype(complex), rcond=None)[0][:, None] * [[1.0]])
        parts[-1] = parts[-1] * np.array([np.exp(-1j * k * x), np.exp(1j * k * x)])
    fitted = parts[0] + 0.8 * np.exp(1j * np.deg2rad(70.0)) * parts[1]
    found = np.array(picture.local_waves(x))
    assert abs(found - fitted).max() < 1e-6 * abs(fitted).max()


def test_local_waves_of_a_field_are_those_that_are_fitted_in_a_window():
    forces = [PointForce(position=0.04), PointForce(position=0.78, amplitude=0.7, phase_deg=55.0)]
    field = analytic_modes.solve_harmonic(STRIP, forces, 2390.0)
    fitted = travelling_wave.measure(field, window=(0.3, 0.5)).waves
    plus, minus = (wave[0] for wave in local_waves(field, 0.4))
    assert (plus, minus) == (pytest.approx(fitted.forward, rel=1e-6), pytest.approx(fitted.backward, rel=1e-6))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"modes": (4, 4)}, r"modes = \[4, 4\]: one mode with itself stands"),
        ({"modes": (0, 4)}, r"modes = 0: give a whole number"),
        ({"ratio": -1.0}, r"ratio = -1\.0: give"),
        ({"phase_deg": float("inf")}, "phase_deg = inf: give"),
        ({"beam": Beam(**SIZES, mass=[PointMass(position=0.2, mass=0.1)])}, r"beam\.mass: two modes are one wave on"),
    ],
)
def test_what_is_no_picture_is_refused(given, said):
    with pytest.raises(InputError, match=said):
        TwoModes(**({"beam": STRIP} | given))
