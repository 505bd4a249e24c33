"""The lumped picture: two modes in quadrature beside the field that a beam has; local waves told apart."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify import Beam, PointForce, PointMass, analytic_modes, travelling_wave
from verify.errors import InputError
from verify.waves.lumped import TwoModes, local_swr, local_waves

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
