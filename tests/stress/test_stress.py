"""Rows of the stress table hold, break where a model is broken, and are told."""

import json
import os
import sys
from decimal import Decimal, localcontext
from importlib import import_module
from math import inf, pi, sqrt
from pathlib import Path

import pytest
from faults.stress import (
    assembled_instead_of_factored,
    slow_motions_unseen,
    unlike_parts_unseen,
)
from msgspec.structs import replace
from packaged import named, names, ran

from verify import beam
from verify.cli import status_of
from verify.errors import InputError
from verify.models import driven_pencil, eigen
from verify.run.runner import run_scene
from verify.scenes.scene import load_scene
from verify.segments import linear as segment_linear
from verify.stress.catalogue import FAMILIES, row, rows
from verify.stress.charts import takes_over
from verify.stress.figures import StressFound, measured, told
from verify.stress.kind import Floor, Growth, Refusal, exponent
from verify.stress.references.decimals import PI, asinh, cantilever_root, cos, exp, sin, sinh
from verify.stress.references.extended import Divided, hermite, links, relative_error
from verify.stress.refusals import Case, refusals
from verify.words import work_in_words

KEYS = {"id", "promise", "measured", "held"}


def light():
    """Quick rows but for those of a few seconds, which their gates run."""
    heavy = {"modes.nearly_floating", "motion.long_runs", "motion.friction", "chain.turned", "limits.growth"}
    slow = {"segments-parts", "elements-parts"}
    families = (name for name in FAMILIES if name not in heavy)
    every = [one for name in families for one in import_module(f"verify.stress.{name}").ROWS]
    return [one.id for one in every if one.quick and one.id not in slow]


def test_there_are_rows_enough_of_every_kind():
    kinds = [one.kind for one in rows().values()]
    assert len(kinds) >= 35
    assert min(kinds.count(kind) for kind in ("floor", "refusal", "growth")) >= 5
    assert all(one.why and one.title and one.at for one in rows().values())


@pytest.mark.parametrize("name", light())
def test_a_quick_row_is_held_and_says_which_kernels_it_runs(name):
    """In the packaged scene, whose gates are the rows."""
    run = ran("stress")
    found = next(gate for gate in run.told["gates"] if gate["id"] == name)
    planned = {named(kernel, map(kernel.typeof_pyval, given)) for kernel, given in row(name).kernels()}
    called = set(run.by_gate[name])
    assert found["passed"], found["reason"]
    assert 0.0 <= found["measured"] <= 1.0
    assert called <= planned
    assert names(called) == names(planned)


@pytest.mark.parametrize("name", [name for name, one in rows().items() if isinstance(one, Floor) and not one.quick])
def test_a_row_that_no_scene_runs_is_held_where_it_begins(name):
    """Ten million steps at a hundredth of the first million, a million parts at a hundredth of the first hundred thousand."""
    one = row(name)
    first = one.at[0] / 100.0 if one.at[0] >= 1e5 else one.at[0]
    found = replace(one, at=(first,), beyond=(), beside=None).run()
    assert found.held, found.reason
    assert found.measured is not None


def test_some_rows_run_kernels_and_most_none():
    """Else nothing would be compared above."""
    assert 15 < sum(bool(row(name).kernels()) for name in light()) < 0.5 * len(light())


def a_frequency_wrong_in_its_twelfth_digit(patch):
    true = segment_linear.damped_response
    patch.setattr(
        segment_linear,
        "damped_response",
        lambda pencil, loads, omega2, stiffness, ratio: true(pencil, loads, omega2 * (1.0 + 2e-12), stiffness, ratio),
    )


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("elements-counted", assembled_instead_of_factored),
        ("segments-counted", assembled_instead_of_factored),
        ("graded-segments", unlike_parts_unseen),
        ("graded-elements", unlike_parts_unseen),
        ("section-steps-elements", unlike_parts_unseen),
        ("mesh-a-million-to-one-elements", unlike_parts_unseen),
        ("tip-mass", slow_motions_unseen),
        ("near-resonance-segments", a_frequency_wrong_in_its_twelfth_digit),
    ],
)
def test_a_planted_fault_is_not_held(monkeypatch, name, fault):
    fault(monkeypatch)
    found = row(name).run()
    assert not found.held
    assert found.reason
    assert found.share > 1.0


def nothing_but_patience(*words):
    raise InputError("too long")


DROPPED = {
    "short-and-stiff": (beam, "CONTRAST", inf),
    "too-many-waves": (beam, "MOST_WAVES", inf),
    "at-resonance-segments": (driven_pencil, "RESONANCE", -1.0),
    "segments-beyond-memory": (eigen, "_memory_bytes", lambda: inf),
}
"""Where each refusal comes from, and a value at which it does not."""


@pytest.mark.parametrize("name", DROPPED)
def test_a_refusal_that_is_dropped_is_not_held(monkeypatch, name):
    monkeypatch.setattr(eigen, "check_work", nothing_but_patience)  # or what is not refused would be begun
    monkeypatch.setattr(*DROPPED[name])
    found = row(name).run()
    assert not found.held
    assert found.share == inf


def floor(error, promise=1e-6, at=(1.0, 10.0), beyond=()):
    return Floor(id="a", title="a", why="a", along="m", at=at, beyond=beyond, promise=promise, error=error)


def test_a_row_is_pushed_until_it_breaks_and_says_where():
    found = floor(lambda x: 1e-9 * x, beyond=(1e2, 1e4, 1e6)).run()
    assert found.held
    assert found.breaks
    assert found.value == pytest.approx(1000.0, rel=0.03)
    assert found.margin == pytest.approx(100.0)
    inside = floor(lambda x: 3e-7 * x).run()
    assert not inside.held
    assert inside.value == 4.0, "between whole numbers the first whole one that breaks"
    assert "at most 1e-06 is promised" in inside.reason


def test_no_number_and_a_refusal_where_none_is_promised_are_not_held():
    def refuse(x):
        raise InputError("a = 3: no")

    for error in (lambda x: float("nan"), refuse):
        found = floor(error).run()
        assert not found.held
        assert found.measured is None
        assert found.share == inf


def test_a_refusal_has_to_name_its_field_and_to_take_what_is_good():
    def ask(x):
        if x > 2.0:
            raise InputError("length = 3: lower it")
        return x

    def kept(names=("length",), taken=(1.0,), at=(3.0,)):
        return Refusal(id="b", title="b", why="b", along="m", at=at, names=names, ask=ask, taken=taken).run()

    assert kept().held
    assert "does not name width" in kept(names=("width",)).reason
    assert "where it is promised" in kept(taken=(2.5,)).reason
    assert "not refused" in kept(at=(1.5,)).reason
    crash = Refusal(id="c", title="c", why="c", along="m", at=(0.0,), names=("x",), ask=lambda x: 1.0 / x).run()
    assert "ZeroDivisionError" in crash.reason


def refuse(words):
    def ask():
        raise InputError(words)

    return ask


def test_a_row_of_refusals_says_which_is_not_as_promised():
    good = Case("width = 3", refuse("width = 3: lower it"), lambda: 2)

    def reason(*cases):
        found = refusals("e", "e", "e", good, *cases, good).run()
        assert found.held is not bool(found.reason)
        assert found.share == (0.0 if found.held else inf)
        assert len(found.said) == 2 + len(cases)
        return found.reason

    assert reason() == ""
    assert reason(Case("mass = 0", lambda: 1)) == "'mass = 0' is not refused"
    assert "another sentence: length = 3" in reason(Case("mass = 0", refuse("length = 3: lower it")))
    assert "ZeroDivisionError in place of a sentence" in reason(Case("mass = 0", lambda: 1 / 0))
    assert reason(Case("mass = 0", refuse("mass = 0: no"), refuse("mass = 1: no"))) == "beside 'mass = 0': mass = 1: no"
    assert "beside 'mass = 0': ZeroDivisionError" in reason(Case("mass = 0", refuse("mass = 0: no"), lambda: 1 / 0))


def test_what_is_refused_is_told_sentence_by_sentence():
    row_of_two = refusals("e", "e", "e", *(Case(word, refuse(f"{word} = 3: no")) for word in ("width", "mass")))
    table = told([row_of_two.run()]).tables()[-1]
    assert table.rows == (("e", "width = 3: no"), ("e", "mass = 3: no"))
    assert len(told([floor(lambda x: 0.0).run()]).tables()) == 2


def test_rows_of_refusals_name_the_numbers_that_their_gates_speak_of():
    for gate in load_scene("stress").gate:
        if gate.id.startswith("refused-"):
            cases = row(gate.id).cases
            assert str(len(cases)) in gate.why.replace(".", " ").split(), gate.id
            assert all(case.said for case in cases)
    many = sum(len(one.cases) for one in rows().values() if one.id.startswith("refused-"))
    assert f"{many} inputs that are refused" in (Path(__file__).parents[2] / "docs/stress.md").read_text()


def test_a_growth_beyond_its_exponent_is_not_held():
    def grown(power):
        return Growth(
            id="d",
            title="d",
            why="d",
            along="n",
            at=(10, 30, 700),
            promise=1.15,
            cost=lambda n: 3e-9 * n**power,
            of="s",
        ).run()

    assert grown(1.1).held
    assert grown(1.1).measured == pytest.approx(1.1)
    assert not grown(1.3).held
    assert exponent(((2.0, 5.0), (8.0, 80.0))) == pytest.approx(2.0)


@pytest.mark.skipif(sys.platform != "linux", reason="/proc/self/status tells what memory a process took")
@pytest.mark.parametrize("model", ["segments", "elements"])
def test_memory_grows_in_proportion_where_dense_matrices_take_its_square(model):
    found = row(f"{model}-memory").run()
    assert found.held, found.reason
    assert 0.7 < found.measured < found.promise
    assert found.beside == pytest.approx(2.0, abs=0.02)
    at = dict(found.beside_points)
    assert at[1000] == pytest.approx((1 if model == "segments" else 2) ** 2 * 3 * 8 * 1000**2 / 2**20, rel=0.01)


def test_rounding_takes_over_where_the_lines_cross():
    law = [((pi / n) ** 4 / 1440.0, n) for n in (50, 100, 200, 400)]
    points = tuple((n, left * (n / 163.0) ** 8) for left, n in law)
    assert takes_over(points) == pytest.approx(163.0, rel=1e-6)
    assert takes_over(points[:1]) is None


def test_decimals_are_what_they_are_called():
    with localcontext() as context:
        context.prec = 60
        assert abs(sin(PI / 6) - Decimal("0.5")) < Decimal("1e-55")
        assert abs(cos(PI * 1000003 / 3) - Decimal("0.5")) < Decimal("1e-48")
        assert abs(asinh(sinh(Decimal("0.37"))) - Decimal("0.37")) < Decimal("1e-50")
        assert abs(sinh(Decimal(3)) - (exp(3) - exp(-3)) / 2) < Decimal("1e-50")
        root = cantilever_root(2)
        assert abs(cos(root) * (exp(root) + exp(-root)) / 2 + 1) < Decimal("1e-42")


def test_the_judge_of_loaded_beams_knows_what_is_known_by_hand():
    """Two pinned links with a mass on their joint; a single element clamped with a heavy tip on a spring."""
    two = links(
        Divided(
            supports=("pinned", "pinned"),
            lengths=(1.0, 1.0),
            stiffnesses=(1.0, 1.0),
            masses=(1.0, 1.0),
            point_masses={1: 3.0},
        )
    )
    assert relative_error(two, 1, sqrt(4.0 / (2.0 / 3.0 + 3.0))) < 1e-15
    assert relative_error(two, 1, 1.001 * sqrt(4.0 / (2.0 / 3.0 + 3.0))) == pytest.approx(1e-3, rel=0.1)
    heavy = hermite(
        Divided(
            supports=("clamped", "free"),
            lengths=(1.0,),
            stiffnesses=(1.0,),
            masses=(1e-9,),
            point_masses={1: 7.0},
            springs={1: 2.0},
        )
    )
    assert relative_error(heavy, 1, sqrt(5.0 / 7.0)) < 1e-9


def test_json_has_rows_with_their_keys_and_the_status_is_that_of_the_rows(capsys, monkeypatch):
    words = ["stress", "taut", "off-the-scale", "--json", "--no-report"]
    assert status_of(words) == 0
    data = json.loads(capsys.readouterr().out)
    assert {"date", "machine", "rows", "fits"} <= set(data)
    assert [one["id"] for one in data["rows"]] == ["taut", "off-the-scale"]
    assert all(
        set(one) >= KEYS | {"margin", "value", "seconds", "beside", "kind", "unit", "title"} for one in data["rows"]
    )
    monkeypatch.setattr("verify.stress.modes.attached.frequency", lambda *words: 3.0)
    assert status_of(words) == 1
    taut = json.loads(capsys.readouterr().out)["rows"][0]
    assert not taut["held"]
    assert taut["measured"] > 1e-3


def test_the_table_fits_a_terminal_and_its_report_is_written(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "80")
    assert status_of(["stress", "tip-spring", "beyond-buckling", "--reports", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "tip-spring" in said
    assert "1e+12 EI/L^3" in said
    assert max(map(len, said.splitlines()[:-1])) <= 80
    page = (tmp_path / "stress-table.html").read_text("utf-8")
    assert "LAPACK on assembled K and M" in page


def test_rows_can_be_listed_and_left_out_by_name(capsys):
    assert status_of(["stress", "--list"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(rows())
    assert status_of(["stress", "taut", "rolled-up", "--list", "--json"]) == 0
    taut, rolled = json.loads(capsys.readouterr().out)
    assert (taut["id"], taut["title"], taut["promise"]) == ("taut", row("taut").title, row("taut").promise)
    assert rolled["promise"] == row("rolled-up").run().promise
    assert status_of(["stress", "taut", "elements-million", "--seconds", "9", "--no-report"]) == 0
    assert "left out, for they take longer than is waited for: elements-million" in " ".join(
        capsys.readouterr().out.split()
    )
    for layout in ("--csv", "--markdown"):
        assert status_of(["stress", "taut", layout, "--no-report"]) == 0
        assert "margin" in capsys.readouterr().out.splitlines()[0]


def test_each_row_is_told_once_measured_and_not_beside_json(capsys):
    assert status_of(["stress", "taut", "short-waves", "--no-report"]) == 0
    assert [line.split()[-1] for line in capsys.readouterr().err.splitlines()] == ["taut", "short-waves"]
    assert status_of(["stress", "taut", "--json", "--no-report"]) == 0
    assert not capsys.readouterr().err


def test_rows_that_take_more_than_is_waited_for_are_left_out_by_name(capsys, monkeypatch):
    monkeypatch.setenv("VERIFY_PATIENCE", "30")
    assert status_of(["stress", "taut", "elements-million", "--json", "--no-report"]) == 0
    assert json.loads(capsys.readouterr().out)["left_out"] == ["elements-million"]


def test_a_run_says_how_many_rows_it_solved():
    scene = load_scene("stress", ('stress.rows=["taut", "short-waves"]',))
    result = run_scene(replace(scene, gate=()))
    assert work_in_words(0, 0, 0, result.others) == "2 rows solved on beams of their own"


def test_an_interrupt_before_anything_was_measured_says_nothing_of_rows(capsys, monkeypatch):
    def interrupted(*words):
        raise KeyboardInterrupt

    monkeypatch.setitem(rows(), "foundation", floor(interrupted))
    assert status_of(["stress", "foundation", "--no-report"]) == 130
    assert "rows are held" not in capsys.readouterr().out


def test_an_interrupt_keeps_what_was_measured(capsys, monkeypatch):
    def interrupted(*words):
        raise KeyboardInterrupt

    monkeypatch.setitem(rows(), "foundation", floor(interrupted))
    assert status_of(["stress", "taut", "foundation", "--json", "--no-report"]) == 130
    assert [one["id"] for one in json.loads(capsys.readouterr().out)["rows"]] == ["taut"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["stress", "tip-mas"], "'tip-mas' is not known: did you mean"),
        (["stress", "--seconds", "-3"], "--seconds -3.0: give seconds above 0"),
        (["measure", "stress.share", "row=tautt"], "'tautt' is not known"),
        (["run", "stress", "--set", "stress.rows=tautt", "--no-report"], "tautt"),
    ],
)
def test_bad_input_is_one_sentence(capsys, words, said):
    assert status_of(words) == 2
    printed = capsys.readouterr().err
    assert said in printed
    assert "Traceback" not in printed
    assert len(printed.splitlines()) == 1


def test_what_is_not_held_is_printedwith_its_reason():
    found = told([floor(lambda x: 2e-6, at=(3.0,)).run(), "slow-one"])
    assert isinstance(found, StressFound)
    assert not found.held
    assert any("a is not held: 2e-06 at 3 m" in fact for fact in found.facts())
    assert found.plain()["left_out"] == ["slow-one"]
    assert json.loads(json.dumps(found.plain()))["rows"][0]["margin"] == pytest.approx(0.5)


@pytest.mark.parametrize("patience", ["0.9", "600"])
def test_a_row_is_judged_with_the_patience_that_its_promise_was_made_for(monkeypatch, patience):
    """Of both rows some cases are refused for their time: what the environment waits for makes no promise fail."""
    monkeypatch.setenv("VERIFY_PATIENCE", patience)
    for name in ("refused-sizes-and-chains", "lists-with-faults"):
        assert measured(rows()[name]).held, name
    assert os.environ["VERIFY_PATIENCE"] == patience
