"""What waves are measured of, as people give it: what it cannot be is refused in one sentence, and nothing is read on."""

import numpy as np
import pytest

from verify import Beam, InputError, PointForce, analytic_modes, travelling_wave

BEAM = Beam(length=0.31, width=0.013, thickness=0.0021, youngs_modulus=101e9, density=8400.0, loss_factor=0.01)
FORCES = (PointForce(position=0.05, amplitude=1.7), PointForce(position=0.27, phase_deg=90.0))
HERTZ, WINDOW = 1433.3, (0.06, 0.26)
FIELD = analytic_modes.solve_harmonic(BEAM, FORCES, HERTZ)
K = FIELD.wavenumber
SIGN = "give a finite k of e\\^{-ikx} in 1/m, its real part above 0, its imaginary part at most 0"


@pytest.mark.parametrize("k", [-K, K.conjugate(), 0, True, float("nan"), float("inf"), "a", [65.4], 10**309])
def test_a_wavenumber_that_is_none_of_a_wave_towards_plus_x_is_refused(k):
    """-k turned every wave round: direction -1 was told of a wave that runs towards +x."""
    with pytest.raises(InputError, match=f"wave_number = .*: {SIGN}"):
        travelling_wave.two_waves(FIELD, WINDOW, k)


X = np.linspace(*WINDOW, 41)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"x": 0.1}, r"shapes \(1,\), \(41,\) and \(1,\): give two or more numbers in a row"),
        ({"deflection": np.ones((41, 2))}, r"shapes \(41,\), \(41, 2\) and \(41,\)"),
        ({"weights": -X}, "have to be finite and weights above 0"),
        ({"deflection": np.full(41, np.nan)}, "have to be finite"),
        ({"deflection": np.zeros(41)}, "the field is zero"),
        ({"deflection": "abc"}, "deflection = 'abc': give a number, a list or an array of numbers"),
        ({"k": -70.0}, f"k = -70.0: {SIGN}"),
    ],
)
def test_two_waves_are_fitted_to_as_many_finite_numbers_as_places(changed, said):
    with pytest.raises(InputError, match=said):
        travelling_wave.fit_waves(**{"x": X, "deflection": FIELD.deflection(X), "k": K} | changed)
