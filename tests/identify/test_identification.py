"""Identification: Jacobians against differences, Cramer-Rao bounds, coverage, and what data do not determine."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.integrate import solve_ivp

from verify.analysis.solution_cache import SolutionCache
from verify.analytic_modes import ExactModel
from verify.errors import InputError
from verify.identify import beam as beams
from verify.identify import friction
from verify.identify.fit import COLOURED, LARGE, UNLIKELY, coverage, fit
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.problem.slider import Slider
from verify.quantities.base import evaluate
from verify.report.plotting import figure_files
from verify.scene.load import load_scene, scene_from
from verify.studies.base import result_of
from verify.studies.identify import Identify, Synthetic

SLIDER = Slider(mass=0.05, mu=0.2, slope=50.0, speed=0.1)
TIMES = np.linspace(0.0, 0.08, 400)
LOOSE = Slider(mass=0.05, mu=0.15, mu_static=0.25, law="coulomb", speed=-0.3)
SHAPE = {"length": 0.3, "width": 0.02, "thickness": 0.003, "youngs_modulus": 2e11, "density": 7800.0}
BEAM = Beam(**SHAPE, supports=("clamped", "free"))
LADEN = Beam(
    **SHAPE,
    supports=("clamped", "free"),
    loss_factor=0.02,
    section=(Section(length=0.2), Section(length=0.1, thickness=0.002)),
    mass=(PointMass(position=0.3, mass=0.01, rotary_inertia=1e-6),),
    spring=(PointSpring(position=0.11, stiffness=2000.0, rotational=0.7),),
)
MODES = np.arange(1, 7)


def measured(model, noise, seed, **true):
    y = model.predict(model.values(true))[0]
    return y + noise * np.random.default_rng(seed).standard_normal(len(y))


# --- Derivatives ---


@pytest.mark.parametrize(
    ("model", "within"),
    [
        (friction.decay(SLIDER, TIMES), 1e-8),
        (friction.decay(replace(SLIDER, slope=7500.0, speed=-0.1), TIMES), 1e-4),  # sinh(K v0) overflows
        (friction.decay(LOOSE, np.linspace(0.0, 0.3, 90)), 1e-8),
        (friction.breakaway(LOOSE, np.linspace(0.0, 1.0, 101), 0.3), 1e-8),
        (beams.frequencies(LADEN, ("wall_left",), MODES), 1e-7),
        (beams.response(LADEN, ("wall_left",), np.linspace(15.0, 700.0, 60), 0.07, 0.19), 1e-6),
    ],
)
def test_jacobians_are_derivatives(model, within):
    values = model.values()
    for name, exact in model.predict(values)[1].items():
        step = 1e-5 * abs(values[name])
        after, before = (model.predict(values | {name: values[name] + way * step})[0] for way in (1.0, -1.0))
        assert abs((after - before) / (2.0 * step) - exact).max() < within * abs(exact).max(), name


def test_closed_forms_solve_the_equations_of_motion():
    g, normal, exact = 9.81, LOOSE.mass * 9.81, {"rtol": 1e-10, "atol": 1e-12}
    slow = solve_ivp(lambda t, v: -0.2 * g * np.tanh(50.0 * v), (0.0, 0.08), [0.1], t_eval=TIMES, **exact)
    assert measured(friction.decay(SLIDER, TIMES), 0.0, 0) == pytest.approx(slow.y[0], abs=1e-9)
    times, begins = np.linspace(0.0, 1.0, 101), 0.25 * normal / 0.3
    after = times[times > begins]
    slide = solve_ivp(lambda t, v: [(0.3 * t - 0.15 * normal) / 0.05], (begins, 1.0), [0.0], t_eval=after, **exact)
    speeds = np.append(0.0 * times[times <= begins], slide.y[0])
    assert measured(friction.breakaway(LOOSE, times, 0.3), 0.0, 0) == pytest.approx(speeds, abs=1e-9)


# --- Intervals ---


def test_a_record_that_ends_before_the_bend_leaves_the_slope_open():
    model = friction.decay(SLIDER, TIMES[TIMES <= 0.02])  # K v = 3.05 at its end
    found = fit(model, measured(model, 0.0, 0), ("mu", "slope"), noise=1e-3)
    assert found.estimates["slope"].sd == pytest.approx(121.0, rel=5e-3)
    for seed in range(4):
        found = fit(model, measured(model, 1e-3, seed), ("mu", "slope"), noise=1e-3)
        mu, slope = found.estimates.values()
        assert slope.reason == "its profile has no upper end"
        assert 15.0 < slope.profile[0] < 50.0
        assert mu.reason == ""
        assert mu.profile[0] < 0.2 < mu.profile[1]
    without = fit(model, measured(model, 1e-3, 0), ("mu", "slope"), noise=1e-3, profiles=False)
    assert without.estimates["slope"].reason == "its interval includes a bound or zero"


def test_coverage_of_the_intervals():
    """Of friction it is a gate of the scene identify-friction."""
    model = beams.frequencies(BEAM, (), MODES[:4])
    assert 0.935 < coverage(model, ("youngs_modulus",), {}, 2e-3, repeats=2000, seed=1)["youngs_modulus"] < 0.965


def test_the_profile_of_a_linear_parameter_is_its_interval():
    model = friction.decay(LOOSE, np.linspace(0.0, 0.15, 60))
    one = fit(model, measured(model, 5e-3, 4), ("speed",), profiles=True).estimates["speed"]
    assert one.profile == pytest.approx(one.interval, rel=1e-5)


# --- What data determine ---


def test_frequencies_determine_the_quotient_of_modulus_and_density():
    model = beams.frequencies(BEAM, (), MODES)
    data = measured(model, 1e-3, 2)
    both = fit(model, data, ("youngs_modulus", "density"), start={"youngs_modulus": 1.5e11}, noise=1e-3).estimates
    assert fit(model, data, ("youngs_modulus", "density")).freedom == 5  # one combination of two is determined
    assert "only its combination with density" in both["youngs_modulus"].reason
    assert "only its combination with youngs_modulus" in both["density"].reason
    assert both["youngs_modulus"].value / both["density"].value == pytest.approx(2e11 / 7800.0, rel=3e-3)
    one = fit(model, data, ("youngs_modulus",), noise=1e-3).estimates["youngs_modulus"]
    assert one.reason == ""
    assert one.sd == pytest.approx(2.0 * 1e-3 * one.value / np.sqrt(6.0), rel=1e-9)


def test_a_wall_too_stiff_for_the_noise_has_a_lower_bound_alone():
    model = beams.frequencies(BEAM, ("wall_left",), MODES)
    found = fit(model, measured(model, 1e-3, 1, wall_left=2e5), ("youngs_modulus", "wall_left"), noise=1e-3).estimates
    assert found["wall_left"].reason == "its profile has no upper end"
    assert 100.0 < found["wall_left"].profile[0] < 2e5
    assert found["youngs_modulus"].profile[0] < 2e11 < found["youngs_modulus"].profile[1]


def test_a_response_determines_modulus_density_losses_and_wall():
    model = beams.response(BEAM, ("wall_left",), np.linspace(15.0, 700.0, 90), 0.07, 0.19)
    true = {"youngs_modulus": 1.9e11, "density": 7650.0, "loss_factor": 0.013, "wall_left": 410.0}
    found = fit(model, measured(model, 0.01, 5, **true), tuple(true), start={"loss_factor": 0.05})
    assert found.noise == pytest.approx(0.01, rel=0.15)
    for name, value in true.items():
        one = found.estimates[name]
        assert one.interval[0] < value < one.interval[1], name
        assert one.sd < 0.03 * value


def test_breakaway_separates_static_and_kinetic_friction():
    model = friction.breakaway(LOOSE, np.linspace(0.0, 1.0, 101), 0.3)
    found = fit(model, measured(model, 1e-2, 3), ("mu", "mu_static"), start={"mu": 0.1, "mu_static": 0.2}).estimates
    for name, value in (("mu", 0.15), ("mu_static", 0.25)):
        assert found[name].interval[0] < value < found[name].interval[1]
        assert found[name].sd < 0.01


def test_a_wrong_law_is_rejected():
    smooth = friction.decay(SLIDER, TIMES)
    wrong = friction.decay(replace(SLIDER, law="coulomb", slope=None), TIMES)
    known = fit(wrong, measured(smooth, 1e-3, 1), ("mu",), noise=1e-3)
    assert {LARGE, COLOURED} <= {*known.rejected} & {LARGE, *fit(wrong, measured(smooth, 1e-3, 1), ("mu",)).rejected}
    assert fit(smooth, measured(smooth, 1e-3, 7), ("mu", "slope"), noise=1e-3).rejected == ()


@pytest.mark.parametrize("noise", [0.01, None])
@pytest.mark.parametrize("phase", [True, False])
def test_a_start_at_another_resonance_is_rejected(noise, phase):
    model = beams.response(BEAM, (), np.linspace(20.0, 500.0, 14), 0.07, 0.19, phase=phase)
    data = measured(model, 0.01, 0, loss_factor=0.02)
    wrong = fit(model, data, ("youngs_modulus", "loss_factor"), start={"youngs_modulus": 1e10}, noise=noise)
    assert wrong.estimates["youngs_modulus"].value < 1e11
    assert wrong.rejected == ((LARGE,) if noise else (UNLIKELY,))
    right = fit(model, data, ("youngs_modulus", "loss_factor"), start={"youngs_modulus": 1.8e11}, noise=noise)
    assert right.rejected == ()
    assert right.estimates["youngs_modulus"].value == pytest.approx(2e11, rel=1e-2)


# --- Scenes ---

TABLES = {
    "name": "decay",
    "beam": SHAPE,
    "slider": {"mass": 0.05, "mu": 0.2, "slope": 50.0, "speed": 0.1},
    "identify": {
        "what": "friction-decay",
        "parameters": ["mu", "slope"],
        "start": {"mu": 0.1},
        "noise": 1e-3,
        "synthetic": {"noise": 1e-3, "span": [0.0, 0.08], "points": 400, "seed": 7},
        "profiles": True,
    },
}


def run(scene):
    return scene.studies["identify"].run(scene, SolutionCache(scene.beam), lambda step: None)


def changed(**values):
    return scene_from(TABLES | {"identify": TABLES["identify"] | values})


SHORT = {"noise": 1e-3, "span": [0.0, 0.02], "points": 101, "seed": 7}


def test_the_study_states_the_intervals():
    scene = scene_from(TABLES)
    result, cache = run(scene), SolutionCache(scene.beam)
    mu, slope = result.tables[0].records()
    assert (mu["verdict"], slope["unit"]) == ("identified", "s/m")
    assert slope["profile upper"] == pytest.approx(slope["upper"], rel=1e-3)
    assert result.verdict.headline == "Trusted to 2.8 % (95 % interval of slope)."
    sides = ({"parameter": "slope", "side": side} for side in ("half-width", "lower", "profile-upper", "sd"))
    half, lower, upper, sd = (evaluate("identify.interval", side, scene, cache) for side in sides)
    assert sd == pytest.approx(0.71331, rel=0.05)
    assert half == pytest.approx(0.5 * (upper - lower), rel=0.01)
    assert 0.9 < evaluate("identify.coverage", {"parameter": "mu", "repeats": 200}, scene, cache) < 0.99
    assert all(figure_files(figure)[1] for figure in result.figures)


def test_gates_and_report_share_the_result_of_a_study():
    scene = scene_from(TABLES)
    cache = SolutionCache(scene.beam)
    result = result_of("identify", scene, cache)
    assert result_of("identify", scene, cache) is result
    assert result_of("identify", scene_from(TABLES), cache) is not result  # the scenes of a sweep share a cache
    arguments = {"study": "identify", "row": "slope", "column": "sd"}
    assert evaluate("study.value", arguments, scene, cache) == result.tables[0].records()[1]["sd"]
    for wrong, words in (
        ({"row": "mass"}, "row = 'mass'"),
        ({"study": "motor"}, "study = 'motor' is not in the scene"),
    ):
        with pytest.raises(InputError, match=words):
            evaluate("study.value", arguments | wrong, scene, cache)


def test_a_short_record_is_not_trusted():
    scene = changed(synthetic=SHORT)
    result = run(scene)
    assert result.verdict.headline.startswith("Not to be trusted: slope is not identifiable")
    assert "slope" not in result.summary
    with pytest.raises(InputError, match="'slope' is not identifiable: its profile has no upper end"):
        evaluate("identify.interval", {"parameter": "slope"}, scene, SolutionCache(scene.beam))
    cut, arguments = (
        changed(synthetic={"noise": 1e-3, "span": [0.0, 0.0398], "points": 200, "seed": 7}),
        {"until": 0.02},
    )
    for side in ("value", "profile-lower", "cramer-rao"):  # the same points, the same noise
        own = {"parameter": "slope", "side": side}
        short = evaluate("identify.interval", own, changed(synthetic=SHORT), SolutionCache(scene.beam))
        assert evaluate("identify.interval", own | arguments, cut, SolutionCache(cut.beam)) == pytest.approx(short)
    with pytest.raises(InputError, match="until = 0"):
        evaluate("identify.interval", own | {"until": 0.05}, cut, SolutionCache(cut.beam))


def test_a_file_is_beside_its_scene(tmp_path):
    hertz, force_at, sensor_at = np.linspace(20.0, 500.0, 40), 0.07, 0.19
    true = replace(BEAM, density=7700.0, loss_factor=0.02)
    h = ExactModel(true).receptance([force_at], hertz, [sensor_at])[:, 0, 0]
    columns = {
        "f,re,im": np.array([hertz, h.real, h.imag]),
        "f;|H|;phase deg": np.array([hertz, abs(h), np.rad2deg(np.angle(h))]),
        "f,|A|": np.array([hertz, abs(h) * (2.0 * np.pi * hertz) ** 2]),
    }
    scene = tmp_path / "rod.toml"
    scene.write_text(
        'name = "rod"\n[beam]\nlength = 0.3\nwidth = 0.02\nthickness = 0.003\nyoungs_modulus = 2e11\ndensity = 7800\n'
        'supports = ["clamped", "free"]\n[identify]\nwhat = "response"\nfile = "h.csv"\nforce_at = 0.07\n'
        'sensor_at = 0.19\nparameters = ["density", "loss_factor"]\nnoise = 1e-3\nstart = { loss_factor = 0.01 }\n'
    )
    for head, table in columns.items():  # the last, of an accelerometer
        between = ";" if ";" in head else ","
        np.savetxt(tmp_path / "h.csv", table.T, delimiter=between, header=head, comments="", fmt="%.15e")
        sensor = ["identify.sensor=acceleration"] if "A" in head else []
        values = [row["value"] for row in run(load_scene(scene, sensor)).tables[0].records()]
        assert values == pytest.approx([7700.0, 0.02], rel=1e-6), head
    pyuff = pytest.importorskip("pyuff")
    from tests.reference.universal_files import RESPONSE

    pyuff.UFF(str(tmp_path / "h.uff")).write_sets(pyuff.prepare_58(**RESPONSE, rsp_node=1, num_pts=40, data=h, x=hertz))
    scene.write_text(scene.read_text().replace("h.csv", "h.uff"))
    values = [row["value"] for row in run(load_scene(scene)).tables[0].records()]
    assert values == pytest.approx([7700.0, 0.02], rel=1e-4)


def test_friction_on_the_driven_beam():
    scene = load_scene("paper-slider")
    own = Identify(
        what="run", parameters=("mu",), start={"mu": 0.15}, count=49, profiles=False, noise=1e-6,
        synthetic=Synthetic(noise=1e-6, span=(0.0, 6e-4), points=30, seed=2),
    )  # fmt: skip
    one = own.fitted(scene, SolutionCache(scene.beam))[2].estimates["mu"]
    assert one.interval[0] < scene.slider.mu < one.interval[1]
    assert one.sd < 0.02


def test_static_friction_of_a_run_is_kinetic_unless_it_is_a_parameter():
    scene, cache = load_scene("paper-slider"), SolutionCache(BEAM)
    own = Identify(what="run", parameters=("mu",), start={"mu": 0.3}, count=25, noise=1e-4,
                   synthetic=Synthetic(noise=1e-4, span=(0.0, 3e-3), points=60, true={"mu": 0.2}))  # fmt: skip
    high, low, apart = (replace(scene.slider, law="coulomb", slope=None, mu=mu, mu_static=static)
                        for mu, static in ((0.3, None), (0.2, None), (0.15, 0.25)))  # fmt: skip
    data = [own.data(replace(scene, slider=one))[1] for one in (high, low)]
    assert data[0] == pytest.approx(data[1], abs=1e-12)
    both = replace(own, parameters=("mu", "mu_static"), synthetic=replace(own.synthetic, true={}), start={})
    both = replace(both, start={"mu_static": 0.26}, profiles=False)
    found = both.fitted(replace(scene, slider=apart), cache)[2].estimates
    assert found["mu"].interval[0] < 0.15 < found["mu"].interval[1]
    assert found["mu_static"].reason  # one step of the curve is of the size of the noise


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"parameters": ["mu", "slop"]}, "did you mean 'slope'"),
        ({"parameters": ["mu", "mu"]}, "give it once"),
        ({"what": "frequencies", "parameters": ["loss_factor"]}, "'loss_factor' is unknown to this model"),
        ({"x": [0.0, 0.1], "y": [0.1, 0.0]}, "give x and y, or a file, or synthetic"),
        ({"x": [0.0, 0.1, 0.2], "y": [0.1, float("nan"), 0.0], "synthetic": None}, "not finite"),
    ],
)
def test_a_wrong_section_is_one_sentence(values, words):
    with pytest.raises(InputError, match=words):
        run(changed(**values))
