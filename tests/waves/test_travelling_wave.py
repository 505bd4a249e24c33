"""Wave measures on fields whose answer is known, in noise, from time series, and as laws of the driven beam."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from packaged_beams import packaged_beam

from verify import analytic_modes
from verify.attached import PointMass, PointSpring
from verify.beam import PointForce
from verify.errors import InputError, WindowError, ZeroFieldError
from verify.exact import error_laws
from verify.models import intervals
from verify.models.catalogue import MODELS
from verify.models.fields import HarmonicField, wavenumber
from verify.segments import linear as segment_model
from verify.waves import measures as travelling_wave
from verify.waves.driven import own_wavenumber
from verify.waves.measures import ellipse, fit_waves, fitted_wavenumber, measure, surface_motion
from verify.waves.series import measure_series, phasors

BEAM = packaged_beam("paper")
WINDOW = (0.125, 0.375)


def two_waves(forward, backward, k=135.2):
    """A synthetic field with amplitudes at the middle of the window."""

    def shapes(x, derivative):
        s = x - 0.25
        return forward * (-1j * k) ** derivative * np.exp(-1j * k * s) + backward * (1j * k) ** derivative * np.exp(
            1j * k * s
        )

    return HarmonicField(
        model="analytic",
        count=None,
        beam=BEAM,
        frequency_hz=4276.0,
        shapes=shapes,
        forces=(PointForce(position=0.01), PointForce(position=0.49)),
    )


def driven(phase=90.0, d=0.0116, eta=0.0, frequency=4276.0):
    beam = replace(BEAM, loss_factor=eta)
    forces = (PointForce(position=d), PointForce(position=0.5 - d, phase_deg=phase))
    return analytic_modes.solve_harmonic(beam, forces, frequency)


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 0.99), st.floats(-3.1, 3.1), st.booleans(), st.floats(0.985, 1.015))
def test_two_waves_are_found_exactly_and_their_wavenumber_is_fitted(gamma, phase, reversed_, factor):
    k = 135.2 * factor
    amplitudes = (2e-6 * np.exp(0.4j), 2e-6 * gamma * np.exp(1j * phase))
    forward, backward = amplitudes[::-1] if reversed_ else amplitudes
    found = measure(two_waves(forward, backward, k), WINDOW, k)
    assert found.reflection == pytest.approx(gamma, abs=1e-11)
    assert found.standing_wave_ratio == pytest.approx((1 + gamma) / (1 - gamma), rel=1e-9)
    if gamma > 1e-9:
        assert found.waves.direction == (-1 if reversed_ else 1)
    x = found.x
    assert fitted_wavenumber(x, two_waves(forward, backward, k).deflection(x), 135.2 + 0j) == pytest.approx(k, rel=2e-7)


@pytest.mark.parametrize("gamma", [0.0, 0.03, 0.2, 0.9])
def test_reflection_survives_noise(gamma):
    """One per cent of noise on 257 phasors: the amplitudes are uncertain by 1 % / sqrt(257)."""
    rng = np.random.default_rng(7)
    x = np.linspace(*WINDOW, 257)
    clean = two_waves(1e-6, gamma * 1e-6 * np.exp(1.1j)).deflection(x)
    found = []
    for _ in range(40):
        noise = 1e-8 * (rng.standard_normal(257) + 1j * rng.standard_normal(257)) / np.sqrt(2)
        found.append(fit_waves(x, clean + noise, 135.2).reflection)
    assert np.mean(found) == pytest.approx(gamma, abs=1.2e-3)
    assert np.std(found) < 1.5e-3


@pytest.mark.parametrize("gamma", [0.0, 0.03, 0.2, 0.9])
@pytest.mark.parametrize("periods", [20.0, 20.37])
def test_the_same_from_time_series_with_trend_noise_and_broken_periods(gamma, periods):
    rng = np.random.default_rng(11)
    x = np.linspace(*WINDOW, 129)
    times = np.arange(0, periods / 4276.0, 1 / 4276.0 / 31.3)
    field = two_waves(1e-6 * np.exp(0.7j), gamma * 1e-6)
    series = (field.deflection(x)[None] * np.exp(2j * np.pi * 4276.0 * times)[:, None]).real
    series = series + 3e-7 + 2e-4 * times[:, None] + 1e-8 * rng.standard_normal(series.shape)
    found = measure_series(BEAM, x, times, series, 4276.0, k=135.2)
    assert found.reflection == pytest.approx(gamma, abs=1e-3)
    assert found.crest_speed == pytest.approx(measure(field, WINDOW, 135.2).crest_speed, rel=5e-3)
    assert found.axis_ratio.mean() == pytest.approx(measure(field, WINDOW, 135.2).axis_ratio.mean(), rel=0.04)


def test_series_too_short_to_measure_are_refused():
    times = np.linspace(0, 0.7 / 4276, 40)
    with pytest.raises(InputError, match=r"times cover 0\.7. periods"):
        phasors(times, np.zeros((40, 5)), 4276.0)
    with pytest.raises(InputError, match="eight samples"):
        phasors(np.linspace(0, 2 / 4276, 6), np.zeros((6, 5)), 4276.0)
    with pytest.raises(InputError, match="half a wavelength"):
        measure_series(BEAM, np.linspace(0.2, 0.21, 30), np.linspace(0, 1e-2, 300), np.zeros((300, 30)), 4276.0)


def test_series_across_a_body_or_a_spring_of_the_beam_are_refused():
    """Two waves alone live beside it: 39 % were left over, and nothing was told."""
    x, times = np.linspace(0.19, 0.37, 40), np.linspace(0.0, 5 / 4276.0, 100)
    waves = np.cos(2 * np.pi * 4276.0 * times[:, None] - 135.2 * x)
    for added in (
        {"mass": (PointMass(position=0.23, mass=0.05),)},
        {"spring": (PointSpring(position=0.23, rotational=2.0),)},
    ):
        with pytest.raises(WindowError, match=r"x from 0\.19 to 0\.37 m holds a mass or a spring at \[0\.23\] m: "):
            measure_series(replace(BEAM, **added), x, times, waves, 4276.0, 135.2)
    beside = replace(BEAM, mass=(PointMass(position=0.19, mass=0.05),))
    assert measure_series(beside, x, times, waves, 4276.0, 135.2).reflection < 1e-3


def test_the_ellipse_of_a_point_is_that_of_its_path():
    """Axes, tilt and sense by brute force over one period."""
    across, up = np.array([0.3 * np.exp(0.9j)]), np.array([1.1 * np.exp(-0.4j)])
    ratio, tilt, area = ellipse(across, up)
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 200_001))
    px, py = (across[0] * turn).real, (up[0] * turn).real
    radius = np.hypot(px, py)
    assert abs(ratio[0]) == pytest.approx(radius.min() / radius.max(), rel=1e-6)
    far = radius.argmax()
    assert np.tan(np.deg2rad(tilt[0])) == pytest.approx(py[far] / px[far], rel=1e-3)
    swept = 0.5 * np.sum(px[:-1] * np.diff(py) - py[:-1] * np.diff(px))
    assert swept == pytest.approx(
        -0.5 * np.pi * area[0], rel=1e-6
    )  # e^{+i omega t}: negative area turns counter-clockwise


def test_a_wave_towards_plus_x_turns_counter_clockwise_and_moves_crests_backwards():
    found = measure(two_waves(1e-6, 0.0), WINDOW, 135.2)
    assert found.rotation == "counter-clockwise"
    assert found.axis_ratio == pytest.approx(np.full(len(found.x), -found.ideal_axis_ratio), rel=1e-12)
    assert found.crest_speed == pytest.approx(-2 * np.pi * 4276 * 0.0005 * 135.2 * 1e-6, rel=1e-12)
    field = two_waves(1e-6, 0.0)
    t = -np.angle(field.deflection(0.2)[0]) / field.omega  # when the surface point at x = 0.2 is highest
    speed = (1j * field.omega * surface_motion(BEAM, field.slope(0.2)) * np.exp(1j * field.omega * t)).real[0]
    assert speed == pytest.approx(found.crest_speed, rel=1e-9)


@pytest.mark.parametrize("gamma", [0.0, 0.03, 0.1, 0.6, 0.97])
@pytest.mark.parametrize("window", [WINDOW, (0.1301, 0.3513), (0.2, 0.2277)])
def test_travelling_index_and_envelope_of_known_waves(gamma, window):
    """On any window of half a wavelength or more, cut anywhere: the index goes by whole half wavelengths inside it."""
    found = measure(two_waves(1e-6, gamma * 1e-6 * np.exp(0.8j)), window, 135.2)
    assert found.travelling_index == pytest.approx((1 - gamma) / (1 + gamma), rel=1e-12)
    assert found.envelope == pytest.approx(gamma, abs=1e-8)


@pytest.mark.parametrize("gamma", [0.0, 0.05, 0.3, 0.7])
@pytest.mark.parametrize("backwards", [False, True])
def test_the_mean_axis_ratio_is_that_of_a_pure_wave_on_a_thin_beam(gamma, backwards):
    """S3 is constant and the ratio S3 / (2 |w|^2) where kh is small; 1 / |w|^2 has the mean 1 / (|A+|^2 - |A-|^2)."""
    thin = replace(BEAM, thickness=1e-6)
    forward, backward = (gamma * 1e-6, 1e-6) if backwards else (1e-6, gamma * 1e-6)
    field = two_waves(forward, backward)
    field = replace(field, beam=thin, frequency_hz=4276.0 * 1e-3)  # the same wavelength
    found = measure(field, (0.1301, 0.3513), 135.2)
    assert found.mean_axis_ratio == pytest.approx((1 if backwards else -1) * 135.2 * 0.5e-6, rel=1e-6)


def index_figures(found):
    return np.array(
        [found.reflection, found.envelope, found.travelling_index, found.mean_axis_ratio, found.signed_area_spread]
    )


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("segment", 49), ("segment", 196), ("fem", 49)])
@pytest.mark.parametrize(("phase", "eta"), [(90.0, 0.0), (37.0, 0.01)])
def test_no_figure_of_a_wave_depends_on_points(monkeypatch, model, count, phase, eta):
    """Other points, of the fit, of the means and around extremes, move them by less than 2e-6."""
    beam = replace(BEAM, loss_factor=eta)
    forces = (PointForce(position=0.0116), PointForce(position=0.4884, phase_deg=phase))
    field = MODELS[model].solve_harmonic(beam, forces, 4276.0, count)
    coarse = index_figures(measure(field, WINDOW, own_wavenumber(field)))
    monkeypatch.setattr(travelling_wave, "SHARPNESS", 83)
    monkeypatch.setattr(travelling_wave, "HILLS_OF_A_PART", 29)
    monkeypatch.setattr(intervals, "GAUSS", 37)
    monkeypatch.setattr(intervals, "_DEPTH", 6)
    intervals._legendre.cache_clear()
    fine = index_figures(measure(field, WINDOW, own_wavenumber(field)))
    monkeypatch.undo()
    intervals._legendre.cache_clear()
    assert abs(coarse - fine).max() < 2e-6


def test_a_plain_sample_of_the_window_would_move_them_by_half_a_per_cent():
    """Compared subject: 24 points for each half wavelength, ends included, as it stood here before."""
    field = driven()
    x = np.linspace(*WINDOW, 260)
    size = abs(field.deflection(x))
    values = np.linalg.svd(np.column_stack([field.deflection(x).real, field.deflection(x).imag]), compute_uv=False)
    assert abs(values[1] / values[0] - 0.94665028) > 3e-3
    assert abs((size.max() - size.min()) / (size.max() + size.min()) - 0.02740591) > 1e-7


def test_the_fit_is_one_over_the_whole_window():
    """Forty-nine segments, read by a spline that is no wave: against normal equations by Simpson's rule."""
    forces = (PointForce(position=0.0116), PointForce(position=0.4884, phase_deg=90.0))
    field = segment_model.solve_harmonic(BEAM, forces, 4276.0, 49)
    k = own_wavenumber(field).real
    edges = np.unique(np.concatenate([np.linspace(*WINDOW, 4001), np.arange(13, 37) * 0.5 / 49]))
    middle, sixth = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges) / 6
    x, weights = np.concatenate([edges[:-1], middle, edges[1:]]), np.concatenate([sixth, 4 * sixth, sixth])
    basis = np.column_stack([np.exp(-1j * k * (x - 0.25)), np.exp(1j * k * (x - 0.25))])
    amplitudes = np.linalg.solve((basis.conj().T * weights) @ basis, (basis.conj().T * weights) @ field.deflection(x))
    weak, strong = sorted(abs(amplitudes))
    assert measure(field, WINDOW, k).reflection == pytest.approx(weak / strong, abs=1e-7)


def test_every_hill_is_looked_at():
    """Two tops that the grid takes in the wrong order."""
    from verify.models.intervals import extremes

    def figure(x):
        return np.exp(-(((x - 0.31) / 0.02) ** 2)) + 1.003 * np.exp(-(((x - 0.755) / 0.02) ** 2)) - 0.1 * x

    least, largest = extremes(figure, np.linspace(0, 1, 101))
    grid = np.linspace(0, 1, 2_000_001)
    assert largest == pytest.approx(figure(grid).max(), rel=1e-9)
    assert least == pytest.approx(figure(grid).min(), rel=1e-9)


@pytest.mark.parametrize("frequency", [4100.0, 4276.0, 4333.0])
def test_the_standing_wave_ratio_follows_its_law_undamped(frequency):
    kl = wavenumber(BEAM, frequency).real * 0.5
    law = np.sqrt((1 + abs(np.cos(kl))) / (1 - abs(np.cos(kl))))
    assert measure(
        driven(frequency=frequency), WINDOW, wavenumber(BEAM, frequency)
    ).standing_wave_ratio == pytest.approx(law, rel=1e-6)


@pytest.mark.parametrize("eta", [0.0, 0.001, 0.1])
def test_exchanging_the_phase_mirrors_the_field_at_any_damping(eta):
    x = np.linspace(0, 0.5, 37)
    ahead, back = driven(53.0, eta=eta).deflection(x), driven(-53.0, eta=eta).deflection(0.5 - x)
    assert back == pytest.approx(ahead * np.exp(-1j * np.deg2rad(53.0)), rel=1e-9, abs=1e-9 * abs(ahead).max())


def test_the_signed_area_is_the_energy_flux():
    """S3 = -(h k_0...) far from forces: flux = -omega EI k^2 / h * S3 for any two waves."""
    found = measure(driven(phase=37.0), WINDOW, driven().wavenumber)
    k = found.waves.wavenumber.real
    flux = -2 * np.pi * 4276 * BEAM.bending_stiffness * k**2 / BEAM.thickness * found.signed_area.mean()
    assert flux == pytest.approx(found.energy_flux, rel=1e-6)


def test_the_discrete_wavenumbers_are_the_inverse_of_the_discrete_dispersion():
    for model in ("segment", "fem"):
        for mode in (3, 22, 40):
            frequency = error_laws.dispersion_frequency_hz(model, BEAM, mode, 49)
            assert error_laws.discrete_wavenumber(model, BEAM, 49, frequency) == pytest.approx(
                mode * np.pi / 0.5, rel=1e-9
            )
    assert error_laws.discrete_wavenumber("segment", BEAM, 49, 4276.0).real * 0.5 / np.pi == pytest.approx(
        21.559, abs=5e-4
    )
    damped = replace(BEAM, loss_factor=0.02)
    assert error_laws.discrete_wavenumber("segment", damped, 4000, 4276.0) == pytest.approx(
        wavenumber(damped, 4276.0), rel=1e-7
    )


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_the_discrete_wavenumber_keeps_its_digits_on_the_finest_mesh(model):
    """Against 40 digits at 10^6 parts, where mu is 7e-5 and 1 - cos mu has lost all but seven of its digits."""
    n = 1_000_000
    with mpmath.workdps(40):
        root = (
            (2 * mpmath.pi * mpmath.mpf("4276") / mpmath.mpf(BEAM.wave_constant)) ** 2 * mpmath.mpf("0.5") ** 4 / n**4
        )
        start = root ** mpmath.mpf("0.25")

        def equation(mu):
            c, s = mpmath.cos(mu), mpmath.sin(mu)
            if model == "segment":
                return 48 * mpmath.sin(mu / 2) ** 4 - root * (3 - 2 * mpmath.sin(mu / 2) ** 2)
            m = root / 420
            return (24 * (1 - c) - m * (312 + 108 * c)) * (8 + 4 * c - m * (8 - 6 * c)) - s**2 * (12 + 26 * m) ** 2

        exact = mpmath.findroot(equation, (start, start * (1 + mpmath.mpf("1e-9"))), tol=1e-60) * n / mpmath.mpf("0.5")
    assert error_laws.discrete_wavenumber(model, BEAM, n, 4276.0).real == pytest.approx(float(exact), rel=1e-14)


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_the_cut_off_is_where_half_a_wave_stands_on_each_part(model):
    """At mu = pi the joints stand still in turns: the exact discrete frequency there, from just below."""
    beam = replace(BEAM, supports=("pinned", "guided"))  # mu = (n - 1/2) pi / N, not pi itself
    below = error_laws.dispersion_frequency_hz(model, beam, 1000, 1000)
    assert below == pytest.approx(error_laws.cut_off_hz(model, beam, 1000), rel=2e-5)
    assert below < error_laws.cut_off_hz(model, beam, 1000)
    assert error_laws.discrete_wavenumber(model, beam, 1000, below) == pytest.approx(999.5 * np.pi / 0.5, rel=1e-8)


@pytest.mark.parametrize("factor", [0.9, 1.07])
def test_a_wavenumber_fitted_to_the_edge_of_its_search_is_refused(factor):
    field = two_waves(1e-6, 0.2e-6, 135.2 * factor)
    with pytest.raises(InputError, match="ends at the edge of its search"):
        measure(field, WINDOW)
    assert measure(field, WINDOW, 135.2 * factor).reflection == pytest.approx(0.2, rel=1e-9)


def test_the_wavenumber_is_fitted_over_a_long_window_too():
    """A hundred half wavelengths: the residual has many valleys within four per cent."""
    x = np.linspace(0.0, 100 * np.pi / 135.2, 3000)
    for factor in (0.97, 1.0, 1.031):
        wave = np.exp(-135.2j * factor * x)
        assert fitted_wavenumber(x, wave, 135.2 + 0j) == pytest.approx(135.2 * factor, rel=1e-8)


@pytest.mark.parametrize(
    ("times", "values", "frequency", "message"),
    [
        (np.linspace(0, 1e-2, 80), np.zeros((80, 5)), 4276.0, "samples in each period"),
        (np.arange(200) / 8552.0, np.zeros((200, 5)), 4276.0, "samples in each period"),
        (np.empty(0), np.empty((0, 5)), 4276.0, "neither empty"),
        (np.linspace(0, 1e-2, 800), np.empty((800, 0)), 4276.0, "neither empty"),
        (np.linspace(0, 1e-2, 800), np.zeros((799, 5)), 4276.0, r"shape \(800,\)"),
        (np.linspace(0, 1e-2, 800), np.full((800, 5), np.nan), 4276.0, "finite"),
        (np.full(800, np.inf), np.zeros((800, 5)), 4276.0, "finite"),
        (np.linspace(1e-2, 0, 800), np.zeros((800, 5)), 4276.0, "ascending"),
        (np.linspace(0, 1e-2, 800), np.zeros((800, 5)), 0.0, r"frequency_hz = 0\.0"),
        (np.linspace(0, 1e-2, 800), np.zeros((800, 5)), float("nan"), "frequency_hz = nan"),
        (np.linspace(0, 1e-2, 800), np.zeros((800, 5)), -4276.0, r"frequency_hz = -4276"),
        (np.zeros(1), np.zeros((1, 5)), 4276.0, "eight samples"),
    ],
)
def test_series_that_hold_no_phasor_are_refused(times, values, frequency, message):
    with pytest.raises(InputError, match=message):
        phasors(times, values, frequency)


def test_series_at_rest_have_no_wave():
    x, times = np.linspace(*WINDOW, 65), np.arange(1000) / 4276.0 / 31.3
    with pytest.raises(ZeroFieldError, match="do not move"):
        measure_series(BEAM, x, times, np.full((1000, 65), 3e-6), 4276.0)
    with pytest.raises(InputError, match="ascending"):
        measure_series(BEAM, x[::-1], times, np.ones((1000, 65)), 4276.0)


@pytest.mark.parametrize(
    ("window", "message"),
    [
        ((0.0, 0.2), "leaves the span between two forces"),
        ((0.3, 0.499), "leaves the span"),
        ((0.2, 0.21), "shorter than half a wavelength"),
        ((0.3, 0.2), "ascending"),
        ((float("nan"), 0.2), "ascending"),
        ((0.2, 0.6), "between 0 and"),
    ],
)
def test_windows_that_measure_nothing_are_refused(window, message):
    with pytest.raises(InputError, match=message):
        measure(driven(), window)


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("segment", 49), ("fem", 31)])
def test_a_figure_that_is_found_alone_is_the_one_among_all_measures(model, count):
    forces = (PointForce(position=0.0116, amplitude=1.3), PointForce(position=0.4871, amplitude=0.8, phase_deg=71.0))
    field = MODELS.named(model).solve_harmonic(replace(BEAM, loss_factor=0.004), forces, 4263.0, count)
    window = (0.117, 0.391)
    together = measure(field, window, own_wavenumber(field))
    assert len(travelling_wave.FIGURES) == 8
    for name in travelling_wave.FIGURES:
        alone = travelling_wave.measured_figure(field, window, own_wavenumber(field), name)
        assert alone == getattr(together, name), name


@pytest.mark.parametrize("shift", [0.0, 0.3, -40.0])
def test_a_smooth_figure_is_looked_at_twice(shift):
    """Until its mean stands, whatever its sign."""
    from verify.models.intervals import mean_over

    asked = []

    def figure(x):
        asked.append(len(x))
        return shift + np.sin(3.0 * x)

    assert mean_over(figure, (0.2, 0.9), 4) == pytest.approx(shift + (np.cos(0.6) - np.cos(2.7)) / 2.1, rel=1e-13)
    assert asked == [48, 96]
