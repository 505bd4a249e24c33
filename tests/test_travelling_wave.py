"""Wave measures on fields whose answer is known, in noise, from time series, and as laws of the driven beam."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import analytic_modes, error_laws, fem_beam, load_scene, segment_model
from verify.beam import PointForce
from verify.design_map import design_map, parse_axis
from verify.errors import InputError
from verify.fields import HarmonicField, wavenumber
from verify.operating_point import best_points
from verify.travelling_wave import (
    ellipse,
    fit_waves,
    fitted_wavenumber,
    measure,
    measure_series,
    phasors,
    surface_motion,
)
from verify.workbench import Workbench

PAPER = load_scene("paper")
BEAM = PAPER.beam
WINDOW = (0.125, 0.375)


def two_waves(forward, backward, k=135.2):
    """A synthetic field with amplitudes at the middle of the window."""

    def shapes(x, derivative):
        s = x - 0.25
        return forward * (-1j * k) ** derivative * np.exp(-1j * k * s) + backward * (1j * k) ** derivative * np.exp(
            1j * k * s
        )

    return HarmonicField(model="analytic", count=None, beam=BEAM, frequency_hz=4276.0, shapes=shapes,
                         forces=(PointForce(position=0.01), PointForce(position=0.49)))  # fmt: skip


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


def test_travelling_index_and_envelope_of_known_waves():
    whole = (0.25 - 5 * np.pi / 135.2, 0.25 + 5 * np.pi / 135.2)  # ten half wavelengths
    for gamma in (0.0, 0.1, 0.6):
        found = measure(two_waves(1e-6, gamma * 1e-6), whole, 135.2)
        assert found.travelling_index == pytest.approx((1 - gamma) / (1 + gamma), abs=0.006)
        assert found.envelope == pytest.approx(gamma, abs=2e-3)


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


def test_a_map_of_the_chain_is_its_single_solves():
    bench = Workbench(BEAM)
    axes = (parse_axis("frequency_hz=4100:4500:5"), parse_axis("phase_deg=20:160:3"))
    for quantity in ("wave.standing_wave_ratio", "wave.crest_speed", "wave.energy_flux", "wave.reflection"):
        for model, module in (("segment", segment_model), ("fem", fem_beam)):
            found = design_map(quantity, {"model": model, "count": 61}, axes, PAPER, bench)
            assert found.method == "superposed"
            for i, j in ((0, 0), (3, 2), (4, 1)):
                forces = (PointForce(position=0.0116), PointForce(position=0.4884, phase_deg=axes[1].values[j]))
                frequency = axes[0].values[i]
                own = error_laws.discrete_wavenumber(model, BEAM, 61, frequency)
                single = measure(module.solve_harmonic(BEAM, forces, frequency, 61), WINDOW, own)
                assert found.values[i, j] == pytest.approx(getattr(single, quantity.removeprefix("wave.")), rel=2e-4)


def test_axes_may_be_exchanged_and_other_axes_are_walked():
    bench = Workbench(BEAM)
    f, p = parse_axis("frequency_hz=4100:4500:3"), parse_axis("phase_deg=20:160:4")
    one, other = (design_map("wave.reflection", {}, axes, PAPER, bench).values for axes in ((f, p), (p, f)))
    assert one == pytest.approx(other.T)
    walked = design_map("wave.axis_ratio", {"x": 0.25}, (parse_axis("loss_factor=0:0.01:3"),), PAPER, bench)
    assert walked.method == "point by point"
    assert walked.values.shape == (3,)
    counts = design_map("wave.standing_wave_ratio", {"model": "segment"}, (parse_axis("count=49:98:2"),), PAPER, bench)
    assert counts.values == pytest.approx([1.20599, 1.06266], abs=1e-5)


def test_an_undamped_resonance_in_a_sweep_is_a_gap_with_its_reason():
    from verify.closed_forms import frequency_hz

    f = frequency_hz(BEAM, 21)
    found = design_map("wave.axis_ratio", {}, (parse_axis(f"frequency_hz={f!r}:{f + 10!r}:2"),), PAPER, Workbench(BEAM))
    assert np.isnan(found.values[0])
    assert np.isfinite(found.values[1])
    assert "mode 21" in found.reasons[0]


@pytest.mark.parametrize(
    "text",
    ["frequency=1:2:3", "frequency_hz=1:2", "frequency_hz=a:b:c", "frequency_hz=1:2:0", "count=-3:9:2", "frequency_hz"],
)
def test_sweeps_that_cannot_be_are_refused(text):
    with pytest.raises(InputError, match="--sweep"):
        parse_axis(text)


@pytest.mark.parametrize(
    ("model", "count", "best"), [("analytic", None, 4269.07), ("segment", 49, 4252.71), ("fem", 49, 4279.22)]
)
def test_the_best_frequency_is_where_kl_is_an_odd_number_of_quarter_turns(model, count, best):
    quiet, fast = best_points(PAPER, model, count, limit=0.1, loss_factor=1e-3)
    assert quiet.frequency_hz == pytest.approx(best, abs=0.05)
    assert quiet.reflection < 0.01
    assert fast.reflection <= 0.1 + 1e-6
    assert abs(fast.crest_speed) > abs(quiet.crest_speed)


def test_the_papers_rule_lies_seven_hertz_above_the_best_frequency():
    """4276 Hz answers both modes equally; the least reflection is where cos kL = 0, at 4269.07 Hz."""
    quiet, _ = best_points(PAPER, "analytic", None, loss_factor=1e-3)
    at_rule = measure(driven(eta=1e-3), WINDOW).reflection
    assert 4276.0 - quiet.frequency_hz == pytest.approx(6.93, abs=0.02)
    assert at_rule > 3 * quiet.reflection
