"""Published claims are a scene's data: what they are, how they are refused, and that no code knows a paper."""

import ast
import json
import re

import pytest
from msgspec.structs import replace
from sources import PACKAGE, nodes_of, paths

from verify import load_scene, run_scene
from verify.cli import status_of
from verify.errors import InputError
from verify.report.html import page
from verify.run.plan import plan_scene
from verify.scenes.checked import checked
from verify.scenes.claims import Claim
from verify.section import Section
from verify.studies.claims import found_words
from verify.studies.slider.work_precision import (
    Comparison,
    NotCompared,
    Work,
    WorkRow,
    _check_rounds,
    answer_in_words,
    at_equal_error,
    work_of,
)

STRANGER = """
name = "mine"
[beam]
length = 0.43
width = 0.017
thickness = 0.0013
youngs_modulus = 113e9
density = 4470
[drive]
frequency_hz = 1310
force = [{ position = 0.037, amplitude = 1.3, phase_deg = 17 }, { position = 0.402, amplitude = 0.8, phase_deg = 101 }]
[slider]
mass = 0.002
mu = 0.3
slope = 300
[motion]
duration = DURATION
soft_start_periods = 2
count = 12
counts = [12, 24, 48]
"""
CLAIM = {"id": "c", "source": "Somebody, page 3", "quantity": "slider.mean_speed", "read": "figure"}


def stranger(tmp_path, text="", duration=2e-3):
    path = tmp_path / "mine.toml"
    path.write_text(STRANGER.replace("DURATION", str(duration)) + text, "utf-8")
    return path


# --- Claims as data ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("band", "inside", "outside"),
    [
        ({"value": -0.015, "tolerance": 5e-4}, (-0.01549, -0.01451), (-0.0156, 0.015, float("nan"))),
        ({"value": "negative"}, (-1e-300, -4.0), (0.0, 2.0, float("nan"))),
        ({"value": "positive"}, (1e-300, 7.0), (0.0, -2.0, float("nan"))),
        ({"at_most": 2.0}, (2.0, -9.0), (2.1, float("nan"))),
        ({"at_least": -1.0, "at_most": 2.0}, (-1.0, 2.0), (-1.1, 2.1)),
    ],
)
def test_a_claim_holds_in_its_band_and_nowhere_else(band, inside, outside):
    claim = checked(CLAIM | band, Claim)
    assert all(claim.holds(value) for value in inside)
    assert not any(claim.holds(value) for value in outside)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "claims nothing clear"),
        ({"value": 1.0}, "tolerance = None"),
        ({"value": 1.0, "tolerance": 0.0}, "tolerance = 0.0"),
        ({"value": "negative", "tolerance": 1.0}, "tolerance = 1.0"),
        ({"value": "left"}, "left"),
        ({"value": 1.0, "tolerance": 0.1, "at_most": 3.0}, "claims nothing clear"),
        ({"at_least": 2.0, "at_most": 1.0}, "exchange them"),
        ({"value": float("inf"), "tolerance": 1.0}, "claim.c.value = inf"),
        ({"value": "negative", "read": "guessed"}, "guessed"),
        ({"value": "negative", "source": ""}, "source"),
        ({"value": "negative", "judge": 1}, "judge is not a known key"),
    ],
)
def test_a_claim_that_is_none_is_refused_in_one_sentence(given, message):
    with pytest.raises(InputError) as refused:
        checked(CLAIM | given, Claim)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_claim_may_not_stand_twice():
    with pytest.raises(InputError, match="claim\\.to-the-left stands twice"):
        load_scene("paper-slider", ("claim.1.id=to-the-left",))


# --- Claims beside what is found -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def result():
    few = (
        "readings.forces=[30]",
        "readings.mu=[0.2]",
        "readings.slope=[1e4]",
        "readings.positions=[0.25]",
        'readings.kinematics=["following"]',
        "motion.counts=[49,98,196]",
    )
    return run_scene(replace(load_scene("paper-slider", few), gate=()))


def test_each_claim_stands_beside_what_is_found_under_a_condition_that_is_named(result):
    by_id = {claim.id: claim for claim in result.found["claims"].claims}
    assert {name: claim.holds for name, claim in by_id.items()} == {
        "to-the-left": True,
        "mean-speed": False,
        "saturation": True,
        "mean-force": False,
        "surface-speed": False,
        "reversal": True,
    }
    speed = by_id["mean-speed"]
    assert speed.found == pytest.approx(-1.3834e-6, rel=1e-3)
    assert speed.exact == pytest.approx(-9.107e-7, rel=1e-3)
    assert speed.departure == pytest.approx(0.519, abs=0.002)
    assert "+52 % off" in found_words(speed)
    for words in ("tangential kinematics", "soft start of 2 periods", "1 ms", "1 N", "mu = 0.2", "49 segments"):
        assert words in speed.condition
    assert result.passed  # claims judge nothing


def test_report_terminal_and_json_carry_claims_and_readings(result, capsys):
    from verify.report.plain import finite, run_as_plain
    from verify.report.terminal import print_run

    text = page(result, "verify run x")
    print_run(result, None)
    shown = re.sub(r"\s+", " ", capsys.readouterr().out)
    for words in ("fails", "+52 % off", "Collard et al., Section III", "ABCDEF", "ABCF", "-1.5303"):
        assert words in text, words
        assert words in shown, words
    assert 'id="slider-readings"' in text
    plain = json.loads(json.dumps(finite(run_as_plain(result, None))))
    assert [claim["holds"] for claim in plain["claims"]] == [True, False, True, False, False, True]
    last = plain["readings"]["groups"][-1]
    assert last["best"]["condition"]["model"] == "chain"
    assert all(last["best"]["met"].values())


def test_a_claim_that_cannot_be_evaluated_says_why(tmp_path):
    text = """
[[claim]]
id = "odd"
source = "Nobody"
quantity = "slider.mean_sped"
value = "negative"
read = "stated"
[[claim]]
id = "many"
source = "Nobody"
quantity = "mode.frequency"
arguments = { model = "segment", count = 3, mode = 9 }
value = "positive"
read = "stated"
"""
    path = stranger(tmp_path, text)
    found = run_scene(path).found["claims"].claims
    assert [claim.holds for claim in found] == [None, None]
    assert "slider.mean_speed" in found[0].reason
    assert "mode" in found[1].reason
    problems = {problem.who: problem.why for problem in plan_scene(load_scene(path)).problems}
    assert "slider.mean_speed" in problems["claim odd"]


def test_a_plan_counts_readings_and_says_when_there_are_none(tmp_path):
    planned = plan_scene(load_scene("paper-slider"))
    assert any("320 readings of the slider and 160 on the nonlinear chain, 960 runs" in who for who in planned.stepped)
    alone = {skipped.what for skipped in plan_scene(load_scene(stranger(tmp_path))).skipped}
    assert {"readings study", "claims study"} <= alone


# --- A stranger's motor --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("duration", [2e-3, 17e-3])
def test_a_motor_without_claims_gets_its_figures_and_no_judgement(tmp_path, duration, capsys):
    path = stranger(tmp_path, duration=duration)
    assert status_of(["run", str(path), "--reports", str(tmp_path)]) == 0
    shown = capsys.readouterr().out
    report = (tmp_path / "mine.html").read_text("utf-8")
    ours = re.sub(r"<style>.*?</style>|<script.*?</script>", "", report, flags=re.DOTALL)
    for text in (shown, ours):
        for word in ("aper", "1.5 cm/s", "4276 Hz", "holds", "fails", "not so"):
            assert word not in text, word
        assert "tangential" in text
        assert "soft start of 2 periods" in text


@pytest.mark.parametrize("duration", [0.016, 0.05])
def test_a_longer_motion_of_the_paper_s_slider_runs_to_its_end(duration, capsys):
    few = [
        f"--set=readings.{name}=[{value}]"
        for name, value in (("forces", 1), ("mu", 0.2), ("kinematics", '"tangential"'))
    ]
    sets = [
        f"--set=motion.duration={duration}",
        "--set=gate=[]",
        "--set=motion.counts=[49]",
        "--set=readings.duration=1e-3",
    ]
    assert status_of(["run", "paper-slider", "--no-report", *sets, *few]) == 0
    assert f"{1e3 * duration:g} ms" in capsys.readouterr().out


def test_no_printed_word_of_the_code_names_a_paper():
    """Docstrings may cite an equation; what is printed of somebody's motor may not."""
    for path in paths():
        docs = {
            id(node.value)
            for node in nodes_of(path)
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        }
        for node in nodes_of(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
                words = node.value.replace("paper-slider", "").replace("_bgcolor", "")
                assert "paper" not in words.lower() or words == "paper", f"{path.name}: {node.value!r}"
    template = (PACKAGE / "report" / "page.html.j2").read_text("utf-8").replace("paper_bgcolor", "")
    assert "paper" not in template.lower()


# --- Run times at equal error ----------------------------------------------------------------------------------------


def rows(segment, fem, times=(1.0, 2.0, 4.0), due=4):
    """Work with the errors of both models at N = 20, 40, 80; elements take twice the time, and ten times the set-up."""
    made = []
    for model, errors, factor in (("segment", segment, 1.0), ("fem", fem, 2.0)):
        before = None
        for n, error, time in zip((20, 40, 80), errors, times, strict=True):
            from math import log2

            order = log2(before / error) if before and before * error > 0 else None
            made.append(
                WorkRow(
                    model=model,
                    count=n,
                    rows=n,
                    displacement=1 + error,
                    error=error,
                    order=order,
                    run_ms_per_ms=factor * time,
                    set_up_ms=5 * factor**3.3219280948873626,
                )
            )
            before = error
    return Work(rows=tuple(made), step_floor=1e-7, duration=2e-3, orders={"segment": due, "fem": 4}, n_runs=0)


GOOD = (-0.16, -0.01, -0.000625)


def test_two_models_are_compared_at_one_error_loop_and_set_up_apart():
    """Both at 6.25e-4: twice the loop; with the set-up of 5 and 50 ms over 2 ms: (50 + 16) / (5 + 8)."""
    found = at_equal_error(rows(GOOD, tuple(-e for e in GOOD)))
    assert isinstance(found, Comparison)
    assert found.error == pytest.approx(6.25e-4)
    assert found.ratio == pytest.approx(2.0)
    assert found.whole_ratio == pytest.approx(66 / 13)
    words = answer_in_words(found)
    assert "take 2 times (spread 0 %) as long as segments in the loop" in words
    assert "5.1 times (spread 0 %) as long for the whole run of 2 ms, with a set-up of 50 and 5 ms" in words


def test_segments_are_compared_at_the_order_that_is_due_on_the_beam():
    """Two on steps, where no finer size would bring them to four."""
    segment, fem = (-0.16, -0.04, -0.01), tuple(-e for e in GOOD)
    found = at_equal_error(rows(segment, fem, due=2))
    assert isinstance(found, Comparison)
    assert found.error == pytest.approx(0.01)
    assert "do not fall at order 4 but at 2.0, 2.0" in at_equal_error(rows(segment, fem)).why
    assert "segments do not fall at order 2 but at 4.0, 4.0" in at_equal_error(rows(GOOD, fem, due=2)).why
    nobody = at_equal_error(rows(GOOD, GOOD, due=None))
    assert "nobody knows the order of the errors of segments" in nobody.why


def shaken(work, **spreads):
    return replace(work, rows=tuple(replace(row, **spreads) for row in work.rows))


def test_a_ratio_says_how_far_repetitions_lie_apart():
    """A tenth on either side: a fifth; what differs by less than that has no figure."""
    words = answer_in_words(at_equal_error(shaken(rows(GOOD, GOOD), run_spread=0.1, whole_spread=0.05)))
    assert "take 2 times (spread 20 %) as long" in words
    assert "5.1 times (spread 10 %) as long for the whole run" in words
    close = rows(GOOD, GOOD)
    alike = replace(
        close, rows=tuple(replace(row, run_ms_per_ms=1.0 + 0.1 * (row.model == "fem")) for row in close.rows)
    )
    words = answer_in_words(at_equal_error(shaken(alike, run_spread=0.08)))
    assert "take within the spread of 16 % as long as segments in the loop" in words


def test_repetitions_that_do_not_agree_give_no_ratio():
    found = at_equal_error(shaken(rows(GOOD, GOOD), run_spread=0.31))
    assert isinstance(found, NotCompared)
    assert "repetitions of one run lie 62 % apart" in answer_in_words(found)
    assert "times" not in answer_in_words(found).removeprefix("run times")


def test_a_time_that_no_clock_sees_is_not_compared():
    work = rows(GOOD, GOOD)
    unseen = replace(work, rows=tuple(replace(row, run_ms_per_ms=0.0) for row in work.rows))
    assert "below the resolution of the clock" in at_equal_error(unseen).why


def test_the_time_of_a_run_is_the_processors_and_nothing_is_kept_from_the_one_before(monkeypatch):
    """A run that waits for others took none of that; and each run solves its modes again."""
    from time import sleep

    from verify.motion import kernels
    from verify.studies.slider import work_precision

    slide, forget, told = kernels.slide, work_precision.forget, []

    def waits(*args):
        sleep(WAIT_S)
        return slide(*args)

    def forgets():
        told.append("forget")
        forget()

    def runs(*args, once=work_precision.run_once, **how):
        told.append("run")
        return once(*args, **how)

    monkeypatch.setattr(kernels, "slide", waits)
    monkeypatch.setattr(work_precision, "forget", forgets)
    monkeypatch.setattr(work_precision, "run_once", runs)
    scene = load_scene("paper-slider")
    work = work_of(scene, (10, 20, 30))
    assert all(row.run_ms_per_ms * scene.motion.duration < 0.8 * WAIT_S for row in work.rows)
    assert told == ["run"] * 2 + ["forget", "run"] * (work.n_runs - 2)


@pytest.mark.parametrize(
    ("slider", "begins"),
    [
        ({"mass": 0.02}, "full friction moves"),
        (
            {"mass": 0.02, "normal": "massless", "coupling": "two-way"},
            "slider.coupling = 'two-way'; full friction moves",
        ),
        ({"mass": 0.02, "coupling": "one-way"}, ""),
        ({"mass": 1e-9}, ""),
    ],
)
def test_a_table_of_one_way_runs_says_where_the_scene_s_slider_is_felt_and_compares_nothing(slider, begins):
    """Of 20 g on the paper's beam `verify plan` says two-way: its errors are not those of one that is not felt."""
    from verify.studies.slider import work_precision
    from verify.studies.slider.tables import work_table

    scene = load_scene("paper-slider")
    scene = replace(scene, readings=None, slider=replace(scene.slider, **slider))
    own = work_precision.run_once(scene, "segment", 10).coupling
    work = work_of(scene, (10, 20, 30))
    assert own.two_way == bool(begins) == bool(work.felt)
    assert work.felt.startswith(begins)
    notes, answer = " ".join(work_table(work).notes), at_equal_error(work)
    assert ("coupling = 'one-way', not the scene's" in notes) is bool(begins)
    if begins:
        assert "the beam feels the scene's own slider" in answer.why
        assert "slider.coupling = 'one-way'" in answer.remedy
    else:
        assert "feels" not in answer_in_words(answer)


def test_a_slider_that_leaves_is_said_to_have_left_and_its_times_are_not_compared(monkeypatch):
    """Errors were said to jump between 0 and 0, or the slider not to move, where it was gone before a sample."""
    from verify.studies.conditions import condition_of
    from verify.studies.slider import figures as slider_figures
    from verify.studies.slider import work_precision

    scene = load_scene("paper-slider")
    slider = replace(scene.slider, position=scene.beam.length - 4e-4, speed=0.9)
    scene = replace(scene, readings=None, slider=slider)
    seen, gone = (work_precision.run_once(scene, "segment", 10, samples=n) for n in (50, 2))
    conditions = {name: condition_of(scene, name, 10) for name in ("segment", "analytic")}
    findings = slider_figures._findings(scene, {"segment": seen, "analytic": seen}, conditions, ["none"])
    (ended,) = (one.found for one in findings if one.what == "end of that run, until which these are")
    assert re.match(r"on 10 segments the slider left the beam after 44\d\.\d+ µs of 1 ms; on", ended)
    work = replace(rows(GOOD, (0.64, 0.04, 0.0025)), left=ended)
    assert at_equal_error(work).why == ended
    monkeypatch.setattr(work_precision, "run_once", lambda *asked, **how: gone)
    with pytest.raises(InputError, match=r"on 10 segments the slider left the beam after .* of 1 ms: no error can be"):
        work_of(scene, (10,))


WAIT_S = 0.05


def test_times_are_interpolated_in_logarithms_where_one_model_reaches_less():
    """Elements end at 0.01 - 2 ^ -2 of an order above: segments' time lies midway by logarithms."""
    found = at_equal_error(rows(GOOD, (0.64, 0.04, 0.0025)))
    assert found.error == pytest.approx(0.0025)
    assert found.segment.run_ms_per_ms == pytest.approx(2.0 * 2**0.5)
    assert found.ratio == pytest.approx(8.0 / (2.0 * 2**0.5))


@pytest.mark.parametrize(
    ("segment", "fem", "why"),
    [
        ((-2.77, 0.0066, -0.68), GOOD, "errors of segments jump between -277 % and +0.66 %"),
        ((-2e-16, 0.0, -1e-16), GOOD, "segments are right to rounding at every count, the wave hardly moves"),
        ((-2e-13, 0.0, -1e-13), GOOD, "errors of segments jump between"),
        (GOOD, (0.2, 0.05, 0.0125), "errors of elements do not fall at order 4 but at 2.0, 2.0"),
        (GOOD, (0.01, 0.16, 0.01), "errors of elements do not fall at order 4 but at -4.0, 4.0"),
        ((-0.16, -0.01, -1e-5), GOOD, "do not fall at order 4 but at 4.0, 10.0"),
        ((-1e-4, -3e-6, -2e-7), GOOD, "too near"),
        ((-1.6e-2, -1e-3, -6.25e-5), (160.0, 10.0, 0.625), "share no error"),
    ],
)
def test_nothing_is_compared_where_errors_do_not_fall_at_their_order(segment, fem, why):
    found = at_equal_error(rows(segment, fem))
    assert isinstance(found, NotCompared)
    assert why in found.why
    assert found.remedy.startswith("give ")
    assert "times as long" not in answer_in_words(found)


def test_the_way_over_a_stepped_exact_beam_is_estimated_before_it_is_begun():
    """Half mu g t^2 past cells of 0.4 wavenumbers, in each of which 400 modes are read; a uniform beam's are closed."""
    words = ("motion.duration=1.3", "slider.mu=0.31", "motion.counts=[4,7]", "drive.frequency_hz=173.0")
    plain = load_scene("paper-slider", words)
    _check_rounds(plain, plain.motion.counts)
    half = Section(length=0.5 * plain.beam.length)
    stepped = replace(plain.bare, beam=replace(plain.beam, section=(half, replace(half, density=3100.0))))
    with pytest.raises(InputError, match=r"^motion.duration = 1.3 would take about .*: shorten it"):
        _check_rounds(stepped, plain.motion.counts)
    short = replace(stepped, motion=replace(stepped.motion, duration=0.13))
    _check_rounds(short, plain.motion.counts)


def test_two_sizes_show_no_order():
    work = rows(GOOD, GOOD)
    two = replace(work, rows=tuple(row for row in work.rows if row.count < 80))
    assert "2 sizes show no order" in at_equal_error(two).why
    one = replace(work, rows=tuple(row for row in work.rows if row.count < 40))
    assert "one size shows no order" in at_equal_error(one).why


def test_a_step_load_seen_too_coarsely_is_not_compared_and_a_soft_start_is():
    """Four milliseconds after a step load errors jump; two periods of soft start and both models keep order four."""
    hard = load_scene("paper-slider", ("motion.duration=0.004", "motion.soft_start_periods=0"))
    found = at_equal_error(shaken(work_of(hard, hard.motion.counts), run_spread=0.04, whole_spread=0.03))
    assert isinstance(found, NotCompared)
    assert "errors of segments jump between -2" in found.why
    assert "longer soft start" in found.remedy
    soft = load_scene("paper-slider")
    work = shaken(work_of(soft, soft.motion.counts), run_spread=0.04, whole_spread=0.03)  # however busy the machine
    assert isinstance(at_equal_error(work), Comparison)


def test_a_claim_with_arguments_of_its_own_is_found_with_them(tmp_path, capsys):
    text = (
        STRANGER.split("[motion]", maxsplit=1)[0]
        + """
[[claim]]
id = "sense"
source = "Nobody"
quantity = "slider.mean_speed"
arguments = { count = 20 }
value = "negative"
read = "stated"
"""
    )
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    status_of(["run", str(path), "--reports", str(tmp_path)])
    shown = capsys.readouterr().out
    assert "cannot be evaluated" in shown
    assert "found with count = 20" in " ".join(shown.split())
    assert "Found with ." not in (tmp_path / "mine.html").read_text("utf-8")


def test_friction_that_sticks_allows_what_mu_static_does(tmp_path):
    from verify.studies.slider.figures import slider_study

    path = stranger(tmp_path)
    path.write_text(path.read_text("utf-8").replace("slope = 300", 'law = "coulomb"\nmu_static = 0.9'), "utf-8")
    found = {finding.what: finding.found for finding in slider_study(load_scene(path)).findings}
    assert "mu_static N = 17.66 mN" in found["largest friction in that run"]
    assert "mu_static N t / 2m = 0.883 cm/s" in found["what friction alone allows"]


def test_a_slider_that_leaves_the_steady_wave_has_no_mean_speed_there(tmp_path):
    from verify.studies.slider.figures import slider_study

    path = stranger(tmp_path)
    path.write_text(path.read_text("utf-8").replace("slope = 300", "slope = 300\nspeed = 3.0"), "utf-8")
    (found,) = (one.found for one in slider_study(load_scene(path)).findings if "steady wave" in one.what)
    assert found.count("none, the slider left the beam after 0.07") == 2
    assert "m/s" not in found


def test_the_mean_speed_on_the_steady_wave_is_that_after_the_start(tmp_path):
    """Whatever speed it starts at; a heavy slider on hardly any friction still has that of its start, and says so."""
    from verify.studies.slider.figures import slider_study

    def told(*given):
        scene = load_scene(stranger(tmp_path), given)
        return next(one for one in slider_study(scene).findings if "steady wave" in one.what)

    still, pushed = told(), told("slider.speed=0.003")
    assert "from 0.3 cm/s; phases reversed" in pushed.what
    speeds = [[float(word.split()[0]) for word in one.found.split("; ")] for one in (still, pushed)]
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-2)
    assert speeds[0][0] * speeds[0][1] < 0.0
    heavy = told("slider.speed=0.003", "slider.mass=0.2", "slider.mu=0.3", "slider.slope=0.5")
    assert heavy.found.count("not settled, +") == 2


@pytest.mark.parametrize(("left_out", "named"), [("slider", "slider"), ("motion", "motion")])
def test_a_claim_about_a_run_that_the_scene_has_not_names_what_is_missing(left_out, named):
    whole = load_scene("paper-slider")
    with pytest.raises(
        InputError, match=rf"claim.to-the-left is about the run of a slider and the scene has no \[{named}\]"
    ):
        replace(whole, readings=None, gate=(), **{left_out: None})


def test_the_plan_sizes_a_coupling_with_the_damping_of_the_motion():
    """Strong damping leaves the surface slower: full friction is more of its speed."""
    bare = replace(load_scene("paper-slider"), readings=None, claim=(), gate=())
    damped = replace(bare, motion=replace(bare.motion, modal_damping=0.05))
    one, other = (plan_scene(scene).chosen[0].why for scene in (bare, damped))
    assert one != other
