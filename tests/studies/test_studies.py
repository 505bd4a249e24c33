"""Studies against direct calls of the public verbs; every chart draws."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz
from verify.linear.registry import MODELS
from verify.motor.steady_state import seconds_per_period
from verify.quantities.base import evaluate
from verify.quantities.motor import MotorOptions
from verify.scene.load import load_scene
from verify.studies.convergence import Convergence
from verify.studies.motion import Motion
from verify.studies.motor import Motor
from verify.studies.spectrum import Spectrum
from verify.studies.wave import Wave

# --- Modes studies ---

PAPER = load_scene("paper")


def rows_of(table, **wanted):
    return [row for row in table.records() if all(row[key] == value for key, value in wanted.items())]


def test_spectrum_states_the_published_error(run):
    result = run("paper", Spectrum(modes=22, count=49))
    row = result.tables[0].records()[-1]
    assert row["segments"] == pytest.approx(-0.0042802, abs=1e-7)
    assert row["Hermite elements"] == pytest.approx(0.0026000, abs=1e-6)
    assert "-0.428 %" in result.summary
    assert "Mode 22, N = 49" in result.summary
    assert result.verdict.level == "conditional"
    assert result.verdict.headline.endswith("bending across the width may be left out: 2.5 % at mode 22.")


def test_missing_modes_are_gaps_with_a_reason(run):
    result = run("paper", Spectrum(modes=13, count=11))
    assert result.tables[0].records()[-1]["segments"] is None
    assert result.tables[0].records()[-1]["Hermite elements"] is not None
    assert result.verdict.level == "not trusted"
    assert "segments have no answer at mode 13" in result.verdict.headline
    assert any(one.name.startswith("errors of segments") for one in result.verdict.margins)
    assert "segments" not in result.summary


def test_spectrum_of_a_thick_beam_compares_with_its_own_theory(run, renders):
    result = run("thick-bar", Spectrum(modes=4, count=24, theory="timoshenko"))
    assert "exact Timoshenko" in result.tables[0].records()[0]
    assert not any(margin.name.startswith("shear") for margin in result.margins)
    axes = renders(result)
    assert axes["mode-errors"].get_ylabel() == "|frequency error|, %"
    assert axes["mode-errors"].get_yscale() == "log"
    assert len(axes["mode-shapes"].get_yticks()) == 3


def test_convergence_tabulates_direct_solves(run):
    result = run("paper", Convergence(modes=(2, 5), counts=(11, 23, 46)))
    for model, title in (("segment", "segments"), ("fem", "Hermite elements")):
        for row in rows_of(result.tables[0], model=title):
            found = MODELS[model].build(PAPER.beam, row["N"]).modes(5).frequencies_hz[row["mode"] - 1]
            assert row["frequency"] == pytest.approx(found, rel=1e-12)
            assert row["error"] == pytest.approx(found / frequency_hz(PAPER.beam, row["mode"]) - 1.0, rel=1e-6)
            assert row["solve time"] > 0.0
            assert row["order"] is None if row["N"] == 11 else 3.7 < row["order"] < 4.6


def test_two_sided_bound_contains_the_exact_frequency(run):
    table = run("paper", Convergence(modes=(2, 5), counts=(11, 23, 46))).tables[1]
    assert "bound" in table.title
    for row in table.records():
        assert row["lower"] < frequency_hz(PAPER.beam, row["mode"]) < row["upper"]
        assert abs(row["error of the mean"]) < row["width"]


def test_orders_outside_the_asymptotic_range_are_marked(run, renders):
    result = run("steel-cantilever", Convergence(modes=(5,), counts=(20, 40, 80), wall=("gregory", "half")))
    marks = {row["model"]: row["in range"] for row in rows_of(result.tables[0], N=80)}
    assert marks == {"segments": False, "segments, wall half": True, "Hermite elements": True}
    assert "segments -1.879e-05 % (order 6.44, 5.46: not asymptotic)" in result.summary
    assert [row["model"] for row in rows_of(result.tables[0], N=80) if row["GCI"] is None] == ["segments"]
    assert any("order not converged" in warning for warning in result.warnings)
    table = run("steel-cantilever", Convergence(modes=(3,), counts=(10, 20, 40, 320, 640))).tables[0]
    assert [row["in range"] for row in rows_of(table, model="segments")] == [None, False, False, False, True]
    curves = [line for line in renders(result)["errors-over-size"].lines if len(line.get_xdata()) in (1, 2, 3)]
    hollow = [list(line.get_xdata()) for line in curves if line.get_markerfacecolor() != line.get_color()]
    assert hollow == [[20, 40, 80], [20, 40], [20, 40]]


def test_variants_stand_side_by_side(run, renders):
    result = run("taut-strip", Convergence(modes=(3,), counts=(10, 20, 40), joints=("series", "tensioned")))
    last = {row["model"]: row["order"] for row in rows_of(result.tables[0], N=40)}
    assert last["segments"] == pytest.approx(2.0, abs=0.1)
    assert last["segments, joints tensioned"] == pytest.approx(4.0, abs=0.2)
    axes = renders(result)
    guides = [line for line in axes["errors-over-size"].lines if line.get_gid() == "guide"]
    assert len(guides) == 2


# --- Wave study ---

SMALL = Wave(count=49, counts=(49, 98))


def test_ratios_equal_the_quantities(run):
    scene = load_scene("paper-wave")
    cache, table = SolutionCache(scene.beam), run("paper-wave", SMALL).tables[0]
    names = {"exact beam": "analytic", "segments": "segment", "Hermite elements": "fem"}
    assert len(table.rows) == 5
    for row in table.records():
        arguments = {"model": names[row["model"]]} | ({"count": row["N"]} if row["N"] else {})
        for name, heading in (
            ("standing_wave_ratio", "SWR"),
            ("axis_ratio", "axis ratio"),
            ("crest_speed", "crest speed"),
        ):
            expected = evaluate(f"wave.{name}", arguments, scene, cache)
            assert row[heading] == pytest.approx(expected, rel=1e-9)
        assert row["SWR there"] < row["SWR"]


def test_wave_renders(run, renders):
    axes = renders(run("paper-wave", SMALL))
    assert axes["wave-envelopes"].get_ylabel() == "amplitude, µm"
    places = [np.mean(line.get_xdata()) for line in axes["wave-ellipses"].lines[:13]]
    half_wave = 1e3 * np.pi / np.sqrt(2.0 * np.pi * 4276.0 / np.sqrt(70e9 / 2700.0 / 12.0) / 1e-3)  # mm
    assert max(np.diff(places)) < half_wave / 2.0  # fewer points show a wave of another length


@pytest.mark.parametrize(
    ("scene", "study", "word"), [("stepped-beam", Wave(), "wave"), ("paper-wave", Wave(counts=(7,)), "count")]
)
def test_refusals_name_the_field(scene, study, word):
    with pytest.raises(InputError, match=word):
        study.check(load_scene(scene))


# --- Time studies ---


def column(table, name):
    return [record[name] for record in table.records()]


SHORT = Motion(duration=8e-4, soft_start_periods=1.0, count=21, steps_per_period=32)
QUICK = Motor(models=("fem",), count=49, speeds=3, periods=20)


@pytest.fixture(scope="module")
def slider():
    """The paper's slider under a preload that keeps it on the surface."""
    scene = load_scene("paper-slider")
    return replace(scene.bare, slider=replace(scene.slider, preload=2.7, coupling="one-way"), studies={"motion": SHORT})


def test_lift_off_voids_the_summary(run):
    free = load_scene("paper-slider")
    result = run(replace(free.bare, studies={"motion": SHORT}), SHORT)
    assert result.summary == ""
    assert result.verdict.level == "not trusted"
    assert {"lift-off", "one-way coupling"} <= {one.name for one in result.margins if one.level != "trusted"}


def test_slider_renders(run, slider, renders):
    axes = renders(run(slider, SHORT))
    assert axes["slider-displacement"].get_xlabel() == "time, µs"
    assert axes["slider-friction"].get_ylabel().startswith("friction force, ")
    assert {line.get_label() for line in axes["slider-velocity"].lines} == {"surface under the slider", "slider"}


@pytest.mark.parametrize(
    ("study", "scene", "word"),
    [
        (Motor(), "paper-slider", "contact"),
        (Motion(), "stick-slip-belt", "drive"),
        (Motion(steps_per_period=99), "paper", "steps_per_period"),
    ],
)
def test_scenes_without_what_a_study_needs_are_refused(study, scene, word):
    with pytest.raises(InputError, match=word):
        study.check(load_scene(scene))


def test_motor_figures_equal_the_quantities(run):
    scene = load_scene("preloaded-motor")
    overview, _, _, held = run("preloaded-motor", QUICK).tables
    cache = SolutionCache(scene.beam)
    first, arguments = overview.records()[0], {"model": "fem", "count": 49}
    for name, heading in (("stall_force", "stall force"), ("no_load_speed", "no-load speed")):
        expected = evaluate(f"motor.{name}", arguments, scene, cache)
        assert first[heading] == pytest.approx(expected, rel=1e-3)
    assert column(held, "speed") == pytest.approx([0.0, 0.5 * first["crest speed"], first["crest speed"]])
    wave = evaluate("wave.crest_speed", {"model": "analytic"}, scene, cache)
    assert first["crest speed"] == pytest.approx(wave, rel=0.25)  # at the slider, and of the mean wave in the window
    assert first["crest speed"] * first["stall force"] > 0.0  # crests drag the slider along


def test_a_motor_within_a_time_gives_the_means_so_far_with_their_errors(run):
    bouncing = ("slider.contact={stiffness=6e4}", "slider.foot=[]", "slider.preload=0.05")
    scene = load_scene("preloaded-motor", bouncing)
    least = seconds_per_period(MotorOptions(model="fem", count=49).case(scene)) * (20 + 96 * (QUICK.speeds + 8))
    with pytest.raises(InputError, match=r"motor\.seconds"):
        run(scene, replace(QUICK, seconds=0.1 * least))
    result = run(scene, replace(QUICK, seconds=25.0 * least))
    still = result.tables[3].records()[0]
    assert not still["converged"]
    assert any("motor.seconds" in warning for warning in result.warnings)
    longer = evaluate(
        "motor.stall_force", {"model": "fem", "count": 49, "periods": 200_000}, scene, SolutionCache(scene.beam)
    )
    assert abs(still["force"] - longer) < 1.5 * still["its error"] < 0.05 * 0.2


def test_a_free_run_that_is_too_short_is_not_converged(run, renders):
    result = run("preloaded-motor", QUICK)
    assert result.summary == ""
    assert any("free run has not reached a steady state" in margin.failure for margin in result.margins)
    assert column(result.tables[0], "free speed") == [None]
    axes = renders(result)
    assert axes["motor-force"].get_xlabel() == "speed, mm/s"
    assert "mu N" in [line.get_label() for line in axes["motor-force"].lines]


def test_the_speed_on_a_standing_wave_is_not_distinguishable_from_zero(run):
    scene = load_scene("preloaded-motor", ("drive.force.1.phase_deg=0", "slider.position=0.2437"))
    result = run(scene, replace(QUICK, speeds=2, periods=50))
    assert "(not distinguishable from zero), stall force" in result.summary
    row = result.tables[0].records()[0]
    assert abs(row["free speed"]) < row["its error"] < 1e-3 * abs(row["crest speed"])
