"""Measures of travelling waves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.reference import transfer
from verify import Beam, PointForce, analytic_modes, fem_beam, load_scene, segment_model
from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError, NoFigureError, WindowError
from verify.exact import error_laws
from verify.linear.fields import HarmonicField, wavenumber
from verify.problem.point_attachments import PointMass
from verify.quantities.base import evaluate
from verify.scene.load import scene_from
from verify.waves.driven import measures, power_imbalance
from verify.waves.series import measure_series, phasors
from verify.waves.two_waves import ellipse, fit_waves, fitted_wavenumber, measure, surface_motion
from verify.waves.waveguide import Medium

# --- Travelling wave ---

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


@pytest.mark.parametrize("window", [(0.005, 0.3), (0.2, 0.495)])
def test_a_wave_in_time_is_not_measured_across_a_force(window):
    scene, found = load_scene("paper-slider"), "motion.reflection"
    given = {"model": "analytic", "start": "steady", "time": 0.0011, "window": list(window)}
    with pytest.raises(WindowError, match="leaves the span between two forces"):
        evaluate(found, given, scene, SolutionCache(scene.beam))


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


def test_the_ratio_and_the_flux_of_elements_do_not_drift_with_the_mesh():
    bench = SolutionCache(BEAM)
    arguments = {"model": "fem", "count": 100_000}
    for name, exact in (("wave.standing_wave_ratio", 1.05635631395), ("wave.energy_flux", 0.0233318340824)):
        found = name
        assert evaluate(found, arguments, PAPER, bench) == pytest.approx(exact, rel=2e-8)


@pytest.mark.parametrize(("model", "fewest", "counts"), [("segment", 26, (3, 10, 20, 25)), ("fem", 22, (1, 12, 21))])
def test_a_mesh_that_cannot_carry_the_wave_is_refused_with_the_fewest_parts_that_can(model, fewest, counts):
    bench = SolutionCache(BEAM)
    for name, more in (("wave.standing_wave_ratio", {}), ("wave.deflection", {"x": 0.3})):
        found = name
        for count in counts:
            with pytest.raises(NoFigureError, match=f"give count = {fewest} or more"):
                evaluate(found, {"model": model, "count": count} | more, PAPER, bench)
        assert np.isfinite(evaluate(found, {"model": model, "count": fewest} | more, PAPER, bench))
    assert error_laws.cut_off_hz(model, BEAM, fewest - 1) <= 4276.0 < error_laws.cut_off_hz(model, BEAM, fewest)
    with pytest.raises(NoFigureError, match="give count = "):
        error_laws.check_carried(model, BEAM, 7, 1e300)


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


def test_two_drives_in_phase_have_no_best_frequency():
    best = "wave.best_frequency"
    for phase in (0.0, 180.0):
        with pytest.raises(InputError, match="the wave stands at every frequency"):
            evaluate(best, {"phase_deg": phase}, PAPER, SolutionCache(BEAM))


@pytest.mark.parametrize("position", [0.0, 0.5])
@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("segment", 49), ("fem", 49)])
def test_a_force_on_a_support_makes_no_wave_to_measure(model, count, position):
    found = "wave.standing_wave_ratio"
    given = {"model": model, "position": position} | ({"count": count} if count else {})
    with pytest.raises(NoFigureError, match="the field is zero in the window"):
        evaluate(found, given, PAPER, SolutionCache(BEAM))
    near = given | {"position": abs(position - 1e-6)}
    assert evaluate(found, near, PAPER, SolutionCache(BEAM)) < 2.0


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


@pytest.mark.parametrize("name", ["wave.signed_area_spread", "wave.power_imbalance"])
def test_what_relates_to_the_flux_of_a_standing_wave_is_refused(name):
    found = name
    with pytest.raises(InputError, match="the wave stands"):
        evaluate(found, {"phase_deg": 0.0}, PAPER, SolutionCache(BEAM))


# --- Patched strips ---

PATCH = {"bending_stiffness": 0.35, "mass_per_length": 0.11}
SECTIONS = [{"length": 0.03}, {"length": 0.03, **PATCH}, {"length": 0.3}, {"length": 0.03, **PATCH}, {"length": 0.03}]
SCENE = {
    "name": "patches",
    "beam": {
        "length": 0.42,
        "width": 0.018,
        "thickness": 0.0012,
        "youngs_modulus": 70e9,
        "density": 2700.0,
        "supports": ["free", "free"],
        "loss_factor": 1e-3,
        "section": SECTIONS,
        "spring": [{"position": 0.0, "stiffness": 3e5}, {"position": 0.42, "stiffness": 2e5}],
    },
    "drive": {"frequency_hz": 1700.0, "force": [{"position": 0.045}, {"position": 0.372, "phase_deg": 90.0}]},
}


def scene(**tables):
    return scene_from(SCENE | tables)


def figure(name, whole=None, **asked):
    loaded = whole or scene()
    return evaluate(name, asked, loaded, SolutionCache(loaded.beam))


def test_both_models_come_to_the_exact_standing_wave_ratio_of_a_patched_strip():
    exact = figure("wave.standing_wave_ratio", model="analytic")
    for model in ("segment", "fem"):
        coarse, fine = (abs(figure("wave.standing_wave_ratio", model=model, count=n) / exact - 1) for n in (140, 280))
        assert coarse < 2e-3, model
        assert 3.0 < coarse / fine < 20.0, model


def test_the_flux_through_the_strip_is_the_same_all_along_it_but_for_losses():
    lossless = scene(beam=SCENE["beam"] | {"loss_factor": 0.0})
    left, right = (
        figure("wave.energy_flux", lossless, model="analytic", window=w) for w in ([0.16, 0.21], [0.21, 0.26])
    )
    assert left == pytest.approx(right, rel=2e-4)


def test_a_window_over_a_patch_is_refused_and_one_beside_it_is_not():
    with pytest.raises(WindowError, match=r"holds a beam\.section other than the beam's own"):
        figure("wave.standing_wave_ratio", model="analytic", window=[0.05, 0.25])
    assert figure("wave.standing_wave_ratio", model="analytic", window=[0.06, 0.25]) > 1.0


# --- Turns ---

BAR = Beam(
    length=0.2,
    width=0.02,
    thickness=0.018,
    youngs_modulus=114e9,
    density=4430.0,
    poissons_ratio=0.33,
    loss_factor=0.01,
    supports=("free", "clamped"),
)
SOLVERS = {"analytic": (analytic_modes, ()), "fem": (fem_beam, (120,)), "segment": (segment_model, (400,))}
FORCE = (PointForce(position=0.045),)
EVERYWHERE = np.linspace(0.0, 0.2, 61)


def solve(model, beam, forces=FORCE, hertz=23000.0, theory="timoshenko", **settings):
    module, count = SOLVERS[model]
    return module.solve_harmonic(beam, forces, hertz, *count, theory=theory, **settings)


@pytest.mark.parametrize("supports", [("free", "clamped"), ("pinned", "guided"), ("guided", "free")], ids="-".join)
def test_every_model_turns_as_the_states_along_the_beam_do(supports):
    beam = replace(BAR, supports=supports, mass=(PointMass(position=0.13, mass=0.02, rotary_inertia=3e-6),))
    places = [0.003, 0.043, 0.11, 0.187]
    exact = np.array([transfer.state(beam, "timoshenko", 23000.0, 0.045, x)[1] for x in places])
    for model, within in (("analytic", 1e-11), ("fem", 2e-3), ("segment", 2e-3)):
        assert abs(solve(model, beam).turn(places) - exact).max() < within * abs(exact).max()


def test_what_is_clamped_keeps_its_section_upright_while_its_line_slopes():
    for model in SOLVERS:
        field = solve(model, BAR)
        size = abs(field.turn(EVERYWHERE)).max()
        assert abs(field.turn(0.2)) < 1e-12 * size
    field = solve("analytic", BAR)
    assert abs(field.slope(0.2)) > 0.1 * size


def test_shear_balances_what_the_bar_between_two_places_is_driven_with():
    """(kappa G A (w' - psi))' = -rho A omega^2 w over a stretch without forces, with the loss in kappa G A."""
    field = solve("analytic", BAR)
    stiffness = BAR.own.shear_stiffness * (1.0 + 0.01j)
    ends = [stiffness * (field.slope(x) - field.turn(x)) for x in (0.06, 0.16)]
    points, weights = np.polynomial.legendre.leggauss(40)
    swung = 0.05 * weights @ field.deflection(0.11 + 0.05 * points)
    assert ends[1] - ends[0] == pytest.approx(-BAR.mass_per_length * field.omega**2 * swung, rel=1e-11)


def test_the_turn_of_links_has_order_two_next_to_a_clamped_wall():
    beam, near = replace(BAR, supports=("clamped", "clamped")), 0.2 - np.array([0.0003, 0.0011, 0.0024])
    true = solve("analytic", beam).turn(near)
    off = [
        abs(segment_model.solve_harmonic(beam, FORCE, 23000.0, n, theory="timoshenko").turn(near) - true).max()
        for n in (200, 400)
    ]
    assert off[1] < 0.3 * off[0]


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh"])
@pytest.mark.parametrize("model", SOLVERS)
def test_what_does_not_shear_turns_as_its_line_slopes(model, theory):
    field = solve(model, BAR, theory=theory)
    assert (field.turn(EVERYWHERE) == field.slope(EVERYWHERE)).all()


def test_a_pure_wave_turns_its_sections_as_the_medium_says_with_losses_too():
    """Far from the force on a long bar with an end that swallows nothing in time: e^{-ikx} times what is left of it."""
    beam = replace(BAR, length=3.0, loss_factor=0.08, supports=("pinned", "pinned"))
    field = solve("analytic", beam, (PointForce(position=0.1),), 30000.0)
    turn = Medium(beam, "timoshenko").turn(field.omega)
    assert field.turn(1.0) / field.slope(1.0) == pytest.approx(turn, rel=1e-5)
    assert abs(turn.imag) > 1e-3


@pytest.mark.parametrize(("model", "within"), [("analytic", 1e-7), ("fem", 1e-3)])
@pytest.mark.parametrize("loss_factor", [0.005, 0.03])
def test_forces_give_what_bending_and_shear_lose_and_waves_carry(model, within, loss_factor):
    beam = replace(BAR, length=0.9, loss_factor=loss_factor, supports=("pinned", "clamped"))
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
    count = {"analytic": (), "fem": (450,)}[model]
    field = SOLVERS[model][0].solve_harmonic(beam, forces, 47000.0, *count, theory="timoshenko")
    assert abs(power_imbalance(field, measures(field, None))) < within


@pytest.mark.parametrize("hertz", [9000.0, 47000.0])
def test_the_ellipse_of_a_pure_wave_is_as_high_as_its_section_turns(hertz):
    """By the shear that carries a wave's inertia: psi = (k - rho A omega^2 / (kappa G A k)) w, times h/2."""
    beam = replace(BAR, length=0.9, loss_factor=0.0, supports=("pinned", "pinned"))
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
    field, piece = analytic_modes.solve_harmonic(beam, forces, hertz, theory="timoshenko"), beam.pieces[0]
    k = field.wavenumber.real
    turn = k - piece.mass_per_length * (2.0 * np.pi * hertz) ** 2 / (piece.shear_stiffness * k)
    assert measures(field, None).ideal_axis_ratio == pytest.approx(turn * 0.009, rel=1e-9)
    assert turn < 0.98 * k


@pytest.mark.parametrize("x", [0.001, 0.03, 0.1, 0.195])
def test_a_surface_point_near_forces_and_ends_moves_as_its_section_turns(x):
    paper = load_scene("paper-wave")
    forces = (PointForce(position=0.02), PointForce(position=0.17, phase_deg=90.0))
    given = tuple(
        replace(one, position=at, measured_from="left") for one, at in zip(paper.drive.force, (0.02, 0.17), strict=True)
    )
    assert [(f.amplitude, f.phase_deg) for f in paper.drive.force] == [(1.0, 0.0), (1.0, 90.0)]
    scene = replace(paper, beam=BAR, drive=replace(paper.drive, frequency_hz=30000.0, force=given))
    lifts, turns = np.array([transfer.state(BAR, "timoshenko", 30000.0, one.position, x)[:2] for one in forces]).T
    up, across = lifts @ [1.0, 1j], -0.009 * (turns @ [1.0, 1j])
    area = 2.0 * (np.conj(across) * up).imag / (abs(across) ** 2 + abs(up) ** 2)
    exact = np.tan(0.5 * np.arcsin(area))
    ratio = "wave.axis_ratio"
    for given, within in (({"model": "analytic"}, 1e-10), ({"model": "fem", "count": 100}, 1e-3)):
        asked = given | {"theory": "timoshenko", "x": x}
        assert evaluate(ratio, asked, scene, SolutionCache(BAR)) == pytest.approx(exact, rel=within)


@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
def test_a_chains_field_tends_to_the_exact_one_of_its_own_theory(theory):
    """What rotary inertia and shear do to a thick bar is no error of its segments: by 40 of them it is far more."""
    scene, of = load_scene("thick-bar"), "wave.order"
    given = {"model": "segment", "counts": [40, 80, 160], "of": "deflection", "window": [0.12, 0.21]}
    asked = given | {"theory": theory}
    assert evaluate(of, asked, scene, SolutionCache(scene.beam)) == pytest.approx(2.0, abs=0.1)
