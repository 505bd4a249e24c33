"""Optima against closed forms and brute force, on a finer model; shares in a variance against their closed form."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.scene.load import load_scene, scene_from, tables_of
from verify.studies.optimise import Limit, Optimise, Variable
from verify.studies.sensitivity import Input, Sensitivity

PAPER, WAVE = load_scene("paper"), load_scene("paper-wave")
PURE_PHASE = 86.86030057630933  # -kL modulo 360 degrees
DASHPOT, SPRING = 17.500485439641, 223708.36493887  # conj(Z_b) at 4276 Hz, as in absorbing-end
PHASE = Variable(key="drive.force.1.phase_deg", low=0.0, high=180.0)


def optimum(scene, quantity, variables, **settings):
    study = Optimise(quantity=quantity, variable=variables, **settings)
    return study.run(scene, SolutionCache(scene.beam), lambda step: None)


def rows(table):
    return {next(iter(row.values())): row for row in table.records()}


@pytest.mark.parametrize(("method", "evaluations"), [("global", 120), ("cma", 120), ("local", 60)])
def test_the_pure_wave_has_the_phase_of_the_closed_form(method, evaluations):
    if method == "cma":
        pytest.importorskip("cma")
    result = optimum(WAVE, "wave.reflection", (PHASE,), method=method, evaluations=evaluations)
    # the near field of the ends moves the least reflection by e^{-kL/4} = 5e-8 rad
    assert result.data["optimum"][PHASE.key] == pytest.approx(PURE_PHASE, abs=2e-6)
    assert result.data["points"] < 2.5 * evaluations


def test_the_matched_absorber_is_the_conjugate_impedance(renders):
    scene = load_scene("absorbing-end")
    variables = (
        Variable(key="drive.device.0.dashpot", low=1.0, high=100.0, scale="log", start=5.0),
        Variable(key="drive.device.0.stiffness", low=0.0, high=1e6, start=6e5),
    )
    result = optimum(scene, "wave.reflection", variables, method="local")
    assert list(result.data["optimum"].values()) == pytest.approx([DASHPOT, SPRING], rel=1e-7)
    assert rows(result.tables[1])["wave.reflection"]["finer optimum"] < 1e-8
    assert renders(result)["optimise-history"].get_ylabel() == "wave.reflection"


def test_a_global_search_starts_again_far_from_the_lesser_optimum():
    """Of a motor whose two optima, near 8957 and 9664 Hz, differ by 0.2 %."""
    beam = {"length": 0.24, "width": 0.012, "thickness": 0.0015, "youngs_modulus": 200e9, "density": 7850}
    left, right = ({"position": at, "amplitude": 40.0} for at in (0.00958, 0.24 - 0.00958))
    drive = {"frequency_hz": 9357.8, "force": [left, right | {"phase_deg": 90}]}
    scene = scene_from(
        {"name": "best", "beam": beam | {"supports": ["pinned"] * 2, "loss_factor": 0.01}, "drive": drive}
    )
    frequency, coarse = Variable(key="drive.frequency_hz", low=8700.0, high=10000.0), {"model": "segment", "count": 49}
    limit = Limit(id="pure", quantity="wave.standing_wave_ratio", arguments=coarse, at_most=1.2)
    settings = {"arguments": coarse, "goal": "maximise", "limit": (limit,)}

    def fastest(hertz, phase, method):
        variables = replace(frequency, start=hertz), replace(PHASE, start=phase)
        result = optimum(scene, "wave.crest_speed", variables, **settings, method=method)
        return result, rows(result.tables[1])["wave.crest_speed"]["finer optimum"]

    found, speed = fastest(9357.8, 90.0, "global")
    best, lesser = fastest(8950.0, 52.0, "local")[1], fastest(9664.0, 126.0, "local")[1]
    assert lesser == pytest.approx(0.0497029, rel=1e-5)
    assert best == pytest.approx(0.0498021, rel=1e-5)
    assert speed == pytest.approx(best, rel=1e-6)
    ends = found.data["optima by start"]
    assert 1e-3 < max(ends) / min(ends) - 1.0 < 2.5e-3


def test_a_bound_is_active_below_the_quarter_wavelength():
    places = Variable(key="drive.force.0.position, drive.force.1.position", low=0.005, high=0.011, start=0.006)
    result = optimum(WAVE, "wave.energy_flux", (places,), goal="maximise", method="local")
    assert rows(result.tables[0])[places.key]["bound"] == "high"


def test_points_without_a_value_and_impossible_limits_are_infeasible():
    thickness = Variable(key="beam.thickness", low=-0.001, high=0.002)  # no beam below zero
    arguments = {"model": "segment", "count": 12, "mode": 2}
    below = Limit(id="low", quantity="mode.frequency", arguments=arguments, at_most=30.0)
    result = optimum(
        PAPER, "mode.frequency", (thickness,), arguments=arguments, goal="maximise", limit=(below,), evaluations=60
    )
    assert rows(result.tables[1])["mode.frequency"]["finer optimum"] == pytest.approx(30.0, rel=1e-5)
    never = replace(below, at_most=None, at_least=1e9)
    result = optimum(PAPER, "mode.frequency", (thickness,), arguments=arguments, limit=(never,), evaluations=30)
    assert result.summary == ""
    assert result.verdict.level == "not trusted"
    assert "no point satisfies all limits" in result.verdict.headline


def test_a_doubled_count_where_the_exact_beam_has_no_value_leaves_a_margin():
    section = {"quantity": "mode.shape_error", "arguments": {"model": "segment", "count": 20, "mode": 3}}
    section |= {"variable": [{"key": "beam.length", "low": 0.3, "high": 0.6}], "method": "local"}
    scene = scene_from(tables_of("paper", ()) | {"optimise": section})
    result = scene.studies["optimise"].run(scene, SolutionCache(scene.beam), lambda step: None)
    assert rows(result.tables[1])["mode.shape_error"]["finer model"] == "count = 40"
    assert "discretisation of the optimum" in {margin.name for margin in result.margins}


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"quantity": "wave.reflexion"}, "wave.reflection"),
        ({"variable": (Variable(key="drive.forse.1.phase_deg", low=0.0, high=1.0),)}, "'force'"),
        ({"variable": (replace(PHASE, low=100.0),)}, "start"),
        ({"variable": (PHASE, PHASE)}, "a key occurs twice"),
        ({"variable": (Variable(key="phase", low=0.0, high=1.0, start=0.5),)}, "'phase_deg'"),
        ({"arguments": {"modell": "fem"}}, "'model'"),
    ],
)
def test_wrong_studies_are_refused_before_they_run(change, word):
    with pytest.raises(InputError, match=word):
        optimum(WAVE, **({"quantity": "wave.reflection", "variables": change.pop("variable", (PHASE,))} | change))


# --- Sensitivity ---

SPREADS = {"beam.youngs_modulus": 0.05, "beam.density": 0.03, "beam.thickness": 0.02, "beam.length": 0.008}
POWERS = np.array([0.5, -0.5, 1.0, -2.0])
FUNDAMENTAL = {"model": "analytic", "mode": 3}


def test_shares_of_a_product_of_powers_equal_the_closed_form(renders):
    """The shares are (a_i s_i)^2 over their sum, by ln f = 1/2 ln E - 1/2 ln rho + ln h - 2 ln L + const."""
    inputs = tuple(Input(key=key, distribution="lognormal", sd=sd) for key, sd in SPREADS.items())
    study = Sensitivity(quantity="mode.frequency", arguments=FUNDAMENTAL, logarithm=True, input=inputs, n=128)
    result = study.run(PAPER, SolutionCache(PAPER.beam), lambda step: None)
    parts = (POWERS * list(SPREADS.values())) ** 2
    for row, share in zip(result.tables[0].records(), parts / parts.sum(), strict=True):
        assert row["total"] == pytest.approx(share, abs=0.01)
        assert row["first order"] == pytest.approx(share, abs=0.03)
        assert row["from"] < share < row["to"]
        assert row["total from"] < share < row["total to"]
    assert result.data["sd"] == pytest.approx(np.sqrt(parts.sum()), rel=0.02)
    assert result.data["sum of first order"] == pytest.approx(1.0, abs=0.03)
    renders(result)


def test_one_input_causes_all_of_the_variance():
    spread = (Input(key="beam.thickness", distribution="lognormal", sd=0.02),)
    study = Sensitivity(quantity="mode.frequency", arguments=FUNDAMENTAL, logarithm=True, input=spread, n=512)
    result = study.run(PAPER, SolutionCache(PAPER.beam), lambda step: None)
    (row,) = result.tables[0].records()
    assert row["total"] == row["first order"] == 1.0
    assert result.data["sd"] == pytest.approx(0.02, rel=0.08)  # of 1024 random points: 3.5 standard errors


def test_an_interaction_has_a_total_share_above_its_first_order():
    """Two forces a distance apart: neither amplitude alone decides the reflection."""
    inputs = (
        Input(key="drive.force.0.amplitude", distribution="uniform", low=0.2, high=2.0),
        Input(key="phase_deg", distribution="uniform", low=-180.0, high=180.0),
    )
    study = Sensitivity(quantity="wave.energy_flux", input=inputs, n=64)
    first, second = study.run(WAVE, SolutionCache(WAVE.beam), lambda step: None).tables[0].records()
    assert first["first order"] < 0.1 < 0.8 * first["total"]
    assert second["first order"] > 0.6


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"n": 100}, "give a power of two, 128"),
        ({"input": (Input(key="beam.lenght", sd=0.1),)}, "'length'"),
        ({"input": (Input(key="beam.length", sd=0.5),)}, "reduce sd"),
        ({"input": 2 * (Input(key="beam.length", sd=0.01),)}, "a key occurs twice"),
    ],
)
def test_what_has_no_shares_is_refused(change, word):
    inputs = (Input(key="beam.length", sd=0.001),)
    study = Sensitivity(**({"quantity": "mode.frequency", "arguments": FUNDAMENTAL, "input": inputs, "n": 16} | change))
    with pytest.raises(InputError, match=word):
        study.run(PAPER, SolutionCache(PAPER.beam), lambda step: None)
    with pytest.raises(InputError, match="give low below high for uniform"):
        Input(key="beam.length", distribution="uniform", sd=0.1)
