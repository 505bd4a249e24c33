"""Work-precision rows, orders, ratios at equal errors, and the sets on the paper's beam."""

import json

import numpy as np
import pytest

from verify.bench.methods import Problem, engines_slider, questions
from verify.bench.work_precision import Method, Question, Row, measure, result, time_at
from verify.cli import status_of
from verify.engines.base import ENGINES, missing
from verify.errors import InputError
from verify.problem.beam import PointForce
from verify.problem.slider import Slider


def rows_of(name, exponent, cost, sizes=(10, 20, 40, 80)):
    """Error = N^-exponent, seconds = cost N."""
    return [Row(name, "N", n, n**-exponent, None, cost * n, 0.1) for n in sizes]


def synthetic(uncertainty=0.0):
    def run(n):
        return 1.0 + 3.0 * n**-4.0

    methods = [Method("fourth", run, (10, 20, 40)), Method("second", lambda n: 1.0 + 3.0 * n**-2.0, (10, 20, 40))]
    return Question("synthetic", "a value", "one", uncertainty, lambda found: found - 1.0, methods)


def test_observed_order_is_the_exponent():
    rows = measure(synthetic(), limit=0.1)
    assert [row.order for row in rows[:3]] == [None, pytest.approx(4.0, abs=1e-6), pytest.approx(4.0, abs=1e-6)]
    assert [row.order for row in rows[3:]] == [None, pytest.approx(2.0), pytest.approx(2.0)]
    assert all(row.seconds > 0.0 for row in rows)


def test_no_order_below_the_uncertainty_of_the_reference():
    rows = measure(synthetic(uncertainty=1e-5), limit=0.1)
    assert rows[1].order is None
    assert rows[1].error == pytest.approx(3.0 / 20**4)
    assert rows[4].order is not None


def test_time_limit_ends_a_method():
    def slow(n):
        np.linalg.eigvals(np.random.default_rng(3).random((60 * n, 60 * n)))
        return 1.0 + 1.0 / n

    question = Question("slow", "", "", 0.0, lambda found: found - 1.0, [Method("slow", slow, (1, 2, 3, 4, 5, 6, 7))])
    rows = measure(question, limit=0.02)
    assert 1 <= len(rows) < 7


def test_refused_sizes_have_no_row():
    def run(n):
        if n < 20:
            raise InputError("count = 10: give more")
        return 1.0 + 1.0 / n

    question = Question("some", "", "", 0.0, lambda found: found - 1.0, [Method("some", run, (10, 20, 40))])
    assert [row.size for row in measure(question, limit=0.05)] == [20, 40]


def test_time_at_an_error_is_interpolated_in_logarithms():
    rows = rows_of("a", 4.0, 2e-3)
    assert time_at(rows, 30**-4.0) == pytest.approx(2e-3 * 30, rel=1e-12)
    assert time_at(rows, 0.5) == pytest.approx(2e-2)  # the coarsest is within it
    assert time_at(rows, 81**-4.0) is None
    astray = [*rows[:2], Row("a", "N", 40, 1e-2, None, 0.08, 0.1), rows[3]]
    assert 0.08 < time_at(astray, 1e-3) < 0.16  # a size that is within it by chance does not count


def test_ratio_compares_equal_errors(capsys):
    question = synthetic()
    found = result([(question, [*rows_of("fourth", 4.0, 1e-3), *rows_of("second", 2.0, 5e-4)])])
    (data,) = found.data["questions"]
    # 1e-3: N = 10^(3/4) at order 4, below the coarsest; 10^(3/2) at order 2
    assert data["ratios"]["second"][1] == pytest.approx(5e-4 * 10**1.5 / 1e-2, rel=1e-9)
    assert data["ratios"]["fourth"] == [1.0, 1.0, 1.0, 1.0]
    assert data["ratios"]["second"][3] is None
    assert [cell and cell.endswith("*") for cell in found.tables[1].rows[1][2:]] == [True, True, None, None]


@pytest.mark.parametrize(
    ("name", "bound"),
    [("modes", 1e-3), ("field", 2e-2), ("transient", 2e-2), ("slider", 0.1), ("ride", 1e-3), ("chain", 1e-3)],
)
def test_every_set_reaches_its_reference(name, bound):
    found = list(questions([name], Problem(sizes=(98,))))
    rows = [row for one in found for row in measure(one, limit=0.3)]
    finest = {row.method: row.error for row in rows}
    assert len(finest) >= 2
    assert all(error < bound for error in finest.values()), finest


def test_engines_agree_where_they_are_installed():
    pytest.importorskip("mujoco")
    question = next(questions(["engines"], Problem(mode=3, sizes=(49,))))
    errors = {row.method: row.error for row in measure(question, limit=0.1) if row.size == 49}
    assert errors["MuJoCo"] == pytest.approx(errors["segments"], rel=1e-4)


SLIDER = Slider(mass=7.3e-4, mu=0.31, slope=6e3, position=0.2071, speed=-1.3e-5, preload=2.7e-3)
FORCES = (PointForce(position=0.0371, amplitude=0.7), PointForce(position=0.4519, amplitude=1.3, phase_deg=71.0))


def test_sliders_on_chains_of_engines_converge_to_the_same_displacement():
    problem = Problem(forces=FORCES, frequency_hz=3319.0, slider=SLIDER, duration=1.3e-3, mode=3, sizes=(24,))
    if not (adapters := {name: one.adapter() for name, one in ENGINES.items() if not missing(one)}):
        pytest.skip("no engine is installed")
    question = engines_slider(problem, adapters, 49, "")
    for method in question.methods:
        coarse, fine = (question.error(method.run(method.sizes[k])) for k in (0, -1))
        assert fine < 7e-4, method.name
        assert fine < 0.05 * coarse, method.name


def test_command_prints_rows(capsys):
    assert status_of(["bench", "modes", "--mode", "3", "--sizes", "20,40", "--seconds", "0.1", "--json"]) == 0
    text = capsys.readouterr().out
    assert {row["method"] for row in json.loads(text)["questions"][0]["rows"]} >= {"segments", "elements", "exact"}


@pytest.mark.parametrize(
    ("words", "message"), [(["modez"], "did you mean 'modes'?"), (["modes", "--sizes", "ten"], "--sizes[0] = 'ten'")]
)
def test_bad_options_are_named(words, message, capsys):
    assert status_of(["bench", *words]) == 2
    assert message in capsys.readouterr().err


def test_undriven_beam_has_modes_alone():
    bare = Problem(forces=(), mode=2, sizes=(20,))
    assert len(list(questions(["modes"], bare))) == 1
    with pytest.raises(InputError, match=r"field: the scene has no \[drive\]"):
        list(questions(["field"], bare))
