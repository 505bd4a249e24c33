"""Measures of travelling waves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.beams import MODELS
from tests.beams import PAPER as BEAM
from tests.reference import transfer
from verify import Beam, PointForce, Section
from verify.analytic_modes import ExactModel
from verify.errors import InputError, NoFigureError, WindowError
from verify.fem_beam import HermiteModel
from verify.linear.field import HarmonicField
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segment_model import SegmentModel
from verify.travelling_wave import (
    DrivenCase,
    best_frequency,
    ellipse,
    measure,
    measure_series,
    middle_half,
    surface_motion,
)
from verify.waves.two_waves import Waveguide, fitted_wavenumber

# --- Travelling wave ---

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
    return ExactModel(beam).harmonic(forces, frequency)


def case(model, d=0.0116, phase=90.0, frequency=4276.0):
    forces = (PointForce(position=d), PointForce(position=0.5 - d, phase_deg=phase))
    return DrivenCase(model=model, forces=forces, frequency_hz=frequency)


def measured(one):
    field = one.field(one.forces, one.frequency_hz)
    return measure(field, WINDOW, one.wavenumber(one.frequency_hz))


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 0.99), st.floats(-3.1, 3.1), st.booleans(), st.floats(0.985, 1.015))
def test_the_fit_of_two_waves_is_exact_and_so_is_their_fitted_wavenumber(gamma, phase, reversed_, factor):
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
    wanted = measure(field, WINDOW, 135.2)
    assert found.crest_speed == pytest.approx(wanted.crest_speed, rel=5e-3)
    assert found.ellipses[0].mean() == pytest.approx(wanted.ellipses[0].mean(), rel=0.04)


@pytest.mark.parametrize(
    ("end", "points", "periods", "rate", "message"),
    [
        (0.375, 33, 20.0, 1.9, r"times have 1\.9 samples per period"),
        (0.375, 11, 20.0, 31.3, r"x has a gap of 0\.025 m, half a wavelength"),
        (0.375, 33, 0.7, 57.0, r"times cover 0\.[67].* periods"),
        (0.375, 33, 2.0, 3.0, "eight samples"),
        (0.135, 30, 20.0, 31.3, "half a wavelength"),
    ],
)
def test_series_too_short_or_sampled_below_nyquist_are_refused(end, points, periods, rate, message):
    x, times = np.linspace(0.125, end, points), np.arange(0.0, periods, 1.0 / rate) / 4276.0
    series = (two_waves(1e-6, 1e-7).deflection(x)[None] * np.exp(2j * np.pi * 4276.0 * times)[:, None]).real
    with pytest.raises(InputError, match=message):
        measure_series(BEAM, x, times, series, 4276.0)


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
    assert swept == pytest.approx(-0.5 * np.pi * area[0], rel=1e-6)  # negative area turns counter-clockwise


def test_a_wave_towards_plus_x_turns_counter_clockwise_and_moves_crests_backwards():
    found = measure(two_waves(1e-6, 0.0), WINDOW, 135.2)
    assert found.s3_range[2] < 0.0
    assert found.ellipses[0] == pytest.approx(-found.guide.axis_ratio(found.omega, found.waves.wavenumber), rel=1e-12)
    assert found.crest_speed == pytest.approx(-2 * np.pi * 4276 * 0.0005 * 135.2 * 1e-6, rel=1e-12)
    field = two_waves(1e-6, 0.0)
    t = -np.angle(field.deflection(0.2)[0]) / field.omega  # when the surface point at x = 0.2 is highest
    speed = (1j * field.omega * surface_motion(BEAM, field.slope(0.2), [0.2]) * np.exp(1j * field.omega * t)).real[0]
    assert speed == pytest.approx(found.crest_speed, rel=1e-9)


@pytest.mark.parametrize("gamma", [0.0, 0.03, 0.1, 0.6, 0.97])
@pytest.mark.parametrize("window", [WINDOW, (0.1301, 0.3513), (0.2, 0.2277)])
def test_travelling_index_of_known_waves(gamma, window):
    """On any window of half a wavelength or more, cut anywhere: the index goes by whole half wavelengths inside it."""
    found = measure(two_waves(1e-6, gamma * 1e-6 * np.exp(0.8j)), window, 135.2)
    assert found.travelling_index == pytest.approx((1 - gamma) / (1 + gamma), rel=1e-12)


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


def test_the_signed_area_is_the_energy_flux():
    """Flux = -omega EI k^2 S3 / h for any two waves without near fields."""
    found = measure(driven(phase=37.0), WINDOW, driven().wavenumber)
    k = found.waves.wavenumber.real
    flux = -2 * np.pi * 4276 * BEAM.bending_stiffness * k**2 / BEAM.thickness * found.ellipses[2].mean()
    assert flux == pytest.approx(found.energy_flux, rel=1e-6)


def test_the_ratio_and_the_flux_of_elements_do_not_drift_with_the_mesh():
    found = measured(case(HermiteModel(BEAM, 20_000)))
    assert found.standing_wave_ratio == pytest.approx(1.05635631395, rel=2e-8)
    assert found.energy_flux == pytest.approx(0.0233318340824, rel=2e-8)


@pytest.mark.parametrize(("model", "fewest", "root"), [(SegmentModel, 26, 48.0), (HermiteModel, 22, 1680.0 / 17.0)])
def test_a_mesh_that_cannot_carry_the_wave_is_refused_with_the_fewest_parts_that_can(model, fewest, root):
    for count in (3, 10, 20, fewest - 1):
        with pytest.raises(NoFigureError, match=f"give count = {fewest} or more"):
            measured(case(model(BEAM, count)))
    assert np.isfinite(measured(case(model(BEAM, fewest))).standing_wave_ratio)
    cut_off = np.sqrt(root) * BEAM.wave_constant / (2 * np.pi * BEAM.length**2)
    assert cut_off * (fewest - 1) ** 2 <= 4276.0 < cut_off * fewest**2


@pytest.mark.parametrize("factor", [0.9, 1.07])
def test_a_wavenumber_fitted_to_the_edge_of_its_search_is_refused(factor):
    field = two_waves(1e-6, 0.2e-6, 135.2 * factor)
    with pytest.raises(InputError, match="at the edge of its search"):
        measure(field, WINDOW)
    assert measure(field, WINDOW, 135.2 * factor).reflection == pytest.approx(0.2, rel=1e-9)


def test_the_best_frequency_is_where_the_law_is_least():
    """|cos kL| is least at a quarter between two resonances."""
    between = (21.5 * np.pi / 0.5) ** 2 * BEAM.wave_constant / (2 * np.pi)
    assert best_frequency(case(ExactModel(BEAM))) == pytest.approx(between, abs=2e-3)
    for phase in (0.0, 180.0):
        with pytest.raises(InputError, match="the wave is standing at every frequency"):
            best_frequency(case(ExactModel(BEAM), phase=phase))
    with pytest.raises(InputError, match="still falls at the edge"):
        best_frequency(case(ExactModel(BEAM)), 0.001)


@pytest.mark.parametrize("model", [ExactModel(BEAM), SegmentModel(BEAM, 49), HermiteModel(BEAM, 49)])
def test_a_force_on_a_support_makes_no_wave_to_measure(model):
    with pytest.raises(NoFigureError, match="the field is zero in the window"):
        measured(case(model, d=0.0))
    assert measured(case(model, d=1e-6)).standing_wave_ratio < 2.0


@pytest.mark.parametrize(
    ("window", "message"),
    [
        ((0.0, 0.2), "is not between two neighbouring forces"),
        ((0.3, 0.499), "is not between"),
        ((0.2, 0.21), "shorter than half a wavelength"),
        ((0.3, 0.2), "ascending"),
        ((float("nan"), 0.2), "ascending"),
        ((0.2, 0.6), "between 0 and"),
    ],
)
def test_windows_that_measure_nothing_are_refused(window, message):
    with pytest.raises(InputError, match=message):
        measure(driven(), window)


def test_what_relates_to_the_flux_of_a_standing_wave_is_refused():
    field = driven(phase=0.0)
    found = measure(field, WINDOW, field.wavenumber)
    with pytest.raises(NoFigureError, match="standing wave: "):
        found.power_imbalance  # noqa: B018
    with pytest.raises(NoFigureError, match="standing wave: "):
        assert found.signed_area_spread


STEPS = (Section(length=0.2), Section(length=0.1, thickness=0.0013), Section(length=0.2))


@pytest.mark.parametrize(
    ("beam", "devices", "message"),
    [
        (replace(BEAM, mass=(PointMass(position=0.3, mass=1e-3),)), (), r"contains a mass or a spring at \[0\.3\] m"),
        (replace(BEAM, spring=(PointSpring(position=0.2, stiffness=9.0),)), (), "contains a mass or a spring"),
        (BEAM, (Device(position=0.21, dashpot=0.1),), r"is not between two neighbouring forces .*0\.21"),
        (BEAM, (Device(position=0.21, rotational_dashpot=1e-4),), r"contains a moment, .* at \[0\.21\] m"),
        (replace(BEAM, foundation=1e9), (), "no wave propagates below"),
        (replace(BEAM, section=STEPS), (), r"contains a beam\.section that differs"),
    ],
)
def test_a_window_holds_no_attachment_no_device_and_a_wave(beam, devices, message):
    field = ExactModel(beam).harmonic(driven().forces, 4276.0, devices=devices)
    with pytest.raises(WindowError, match=message):
        measure(field, WINDOW)


# --- Rotations of thick beams ---

SIZES = {"length": 0.2, "width": 0.02, "thickness": 0.018, "youngs_modulus": 114e9, "density": 4430.0}
BAR = Beam(**SIZES, poissons_ratio=0.33, loss_factor=0.01, supports=("free", "clamped"))
FORCE = (PointForce(position=0.045),)


def solve(model, beam, forces=FORCE, hertz=23000.0, theory="timoshenko"):
    size = {"segment": {"count": 400}, "fem": {"count": 120}}.get(model, {})
    return MODELS[model](beam, theory=theory, **size).harmonic(forces, hertz)


@pytest.mark.parametrize("supports", [("free", "clamped"), ("pinned", "guided"), ("guided", "free")], ids="-".join)
def test_sections_of_all_models_rotate_as_by_transfer_matrices(supports):
    beam = replace(BAR, supports=supports, mass=(PointMass(position=0.13, mass=0.02, rotary_inertia=3e-6),))
    places = [0.003, 0.043, 0.11, 0.187]
    exact = np.array([transfer.state(beam, "timoshenko", 23000.0, 0.045, x)[1] for x in places])
    for model, within in (("exact", 1e-11), ("fem", 2e-3), ("segment", 2e-3)):
        assert abs(solve(model, beam).rotation(places) - exact).max() < within * abs(exact).max()


def test_a_pure_wave_has_the_rotation_ratio_of_its_waveguide_with_losses_too():
    """Far from the force on a long lossy bar the reflected wave has decayed: a pure wave e^{-ikx}."""
    beam = replace(BAR, length=3.0, loss_factor=0.08, supports=("pinned", "pinned"))
    field = solve("exact", beam, (PointForce(position=0.1),), 30000.0)
    ratio = Waveguide(beam, "timoshenko").rotation_ratio(field.omega)
    assert field.rotation(1.0) / field.slope(1.0) == pytest.approx(ratio, rel=1e-5)
    assert abs(ratio.imag) > 1e-3


@pytest.mark.parametrize(("model", "within"), [("analytic", 1e-7), ("fem", 1e-3)])
@pytest.mark.parametrize("loss_factor", [0.005, 0.03])
def test_forces_give_what_bending_and_shear_lose_and_waves_carry(model, within, loss_factor):
    beam = replace(BAR, length=0.9, loss_factor=loss_factor, supports=("pinned", "clamped"))
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
    one = ExactModel(beam, theory="timoshenko") if model == "analytic" else HermiteModel(beam, 450, theory="timoshenko")
    field = one.harmonic(forces, 47000.0)
    assert abs(measure(field, middle_half(beam), field.wavenumber).power_imbalance) < within
