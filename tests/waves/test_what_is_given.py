"""What waves are measured of, as people give it: what it cannot be is refused in one sentence, and nothing is read on."""

import numpy as np
import pytest

from verify import Beam, InputError, PointForce, analytic_modes, fem_beam, segment_model, travelling_wave

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


@pytest.mark.parametrize(("k", "halves"), [(1e-9, "6.37e-11"), (1e9, "6.37e\\+07")])
def test_a_wavenumber_whose_half_waves_a_window_does_not_hold_is_refused(k, halves):
    with pytest.raises(InputError, match=rf"wave_number = .* 1/m: \[0.06, 0.26\] m hold {halves} half waves of it"):
        travelling_wave.measure(FIELD, WINDOW, k)


def test_a_wavenumber_of_numpys_is_a_number():
    stated = travelling_wave.two_waves(FIELD, WINDOW, np.array(K))
    assert stated.forward == travelling_wave.two_waves(FIELD, WINDOW, K).forward
    assert stated.direction == 1


X = np.linspace(*WINDOW, 41)
TIMES = np.linspace(0.0, 0.01, 401)
SERIES = np.real(FIELD.deflection(X) * np.exp(2j * np.pi * HERTZ * TIMES)[:, None])


@pytest.mark.parametrize("off", [-0.1, 0.1])
def test_series_beside_the_beam_are_refused(off):
    with pytest.raises(InputError, match=r"x = .* lies off the beam: give positions between 0 and 0.31 m"):
        travelling_wave.measure_series(BEAM, X + off, TIMES, SERIES, HERTZ)


@pytest.mark.parametrize("k", [-K, float("nan"), "a"])
def test_series_are_measured_with_a_wavenumber_alone(k):
    with pytest.raises(InputError, match=f"k = .*: {SIGN}"):
        travelling_wave.measure_series(BEAM, X, TIMES, SERIES, HERTZ, k)


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


def test_ellipses_are_of_as_many_motions_along_as_across():
    with pytest.raises(InputError, match=r"across has the shape \(2,\) and up \(3,\): give as many of both"):
        travelling_wave.ellipse([1j, 2.0], [1.0, 2.0, 3.0])
    with pytest.raises(InputError, match=r"x has the shape \(3,\) and slope \(2,\): give a place for each"):
        travelling_wave.surface_motion(BEAM, [1j, 2.0], x=[0.1, 0.2, 0.3])


@pytest.mark.parametrize("hertz", [np.float32(HERTZ), np.float16(700.0)])
def test_a_short_number_is_the_number_that_it_is(hertz):
    """Its own arithmetic rounds to 7 or 3 digits: the matched dashpot was 8e-8 and 6e-4 off."""
    assert travelling_wave.matched_device(BEAM, hertz, 0.01) == travelling_wave.matched_device(BEAM, float(hertz), 0.01)
    device = travelling_wave.matched_device(BEAM, 900.0, 0.02)
    given, same = (
        travelling_wave.field_with_devices(analytic_modes.solve_harmonic, BEAM, FORCES, one, device).deflection(X)
        for one in (hertz, float(hertz))
    )
    assert (given == same).all()


@pytest.mark.parametrize("hertz", [0, -7.0, float("nan"), "a", [500.0]])
def test_devices_are_of_a_frequency(hertz):
    said = r"frequency_hz = .*: give a finite number above 0 \(hertz\)"
    with pytest.raises(InputError, match=said):
        travelling_wave.matched_device(BEAM, hertz, 0.01)
    device = travelling_wave.matched_device(BEAM, 900.0, 0.02)
    with pytest.raises(InputError, match=said):
        travelling_wave.field_with_devices(analytic_modes.solve_harmonic, BEAM, FORCES, hertz, device)


@pytest.mark.parametrize("model", [segment_model, fem_beam, analytic_modes])
def test_a_sweep_keeps_its_frequencies_whatever_becomes_of_the_array_that_gave_them(model):
    """It said 77 Hz of the field at 500 Hz."""
    given = np.array([500.0, 333.0])
    size = () if model is analytic_modes else (12,)
    sweep = model.sweep_harmonic(BEAM, FORCES, given, *size)
    given[:] = 77.0
    assert (*sweep.frequencies_hz, sweep.field(0).frequency_hz) == (500.0, 333.0, 500.0)
