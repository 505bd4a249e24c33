"""Every quick stress check is within its tolerance, and the checks can fail."""

import json

import pytest

from verify.cli import status_of
from verify.errors import InputError
from verify.stress.engine import Check, registry, result, run, select

BUSY = {"size-segments", "size-elements", "near-buckling"}
"""Checks of 5 to 15 s: `verify stress` runs them."""
QUICK = [one for one in select() if one.id not in BUSY]


@pytest.mark.parametrize("check", QUICK, ids=lambda check: check.id)
def test_error_is_within_its_tolerance(check):
    outcome = check.run()
    assert outcome.passed, outcome
    assert max(error for _, error in outcome.points) == outcome.worst


@pytest.mark.parametrize("name", ["tip-mass", "exact-frequency", "friction-slope"])
def test_standard_method_exceeds_the_tolerance(name):
    check = registry()[name]
    outcome = check.run()
    assert max(error for _, error in outcome.baseline) > 100 * check.tolerance


def test_a_lost_digit_fails_a_check(monkeypatch):
    from verify.fem_beam import HermiteModel

    solve = HermiteModel.modes

    def wrong(self, n_modes):
        modes = solve(self, n_modes)
        modes.frequencies_hz[:] *= 1.0 + 3e-12
        return modes

    monkeypatch.setattr(HermiteModel, "modes", wrong)
    outcome = registry()["tip-mass"].run()
    assert not outcome.passed
    assert outcome.worst == pytest.approx(3e-12, rel=0.02)


def refuse_from_eleven(value):
    if value >= 11:
        raise InputError("value = 11: give less")
    return 1e-3 * value**3


def test_bisection_finds_the_breaking_value():
    outcome = Check("cubic", "", "x", (1.0, 3.0), 0.5, refuse_from_eleven, beyond=(5.0, 20.0)).run()
    assert outcome.passed
    assert outcome.breaks_by == "error"
    assert outcome.breaks_at == pytest.approx(500 ** (1 / 3), rel=0.01)


def test_a_range_ends_by_refusal_only_where_it_must():
    promise = {"beyond": (20.0,), "refused": True}
    assert Check("a", "", "x", (1.0, 3.0), 2.0, refuse_from_eleven, **promise).run().breaks_by == "refused"
    assert not Check("b", "", "x", (1.0, 3.0), 0.5, refuse_from_eleven, **promise).run().passed


def test_result_holds_what_was_measured():
    outcomes = run(select(["tension", "tip-mass"]), jobs=1)
    found = result(outcomes)
    data = json.loads(json.dumps(found.to_dict()))
    assert [one["id"] for one in data["checks"]] == ["tension", "tip-mass"]
    for outcome, one in zip(outcomes, data["checks"], strict=True):
        assert one["worst"] == outcome.worst <= one["tolerance"] == registry()[outcome.id].tolerance
    assert data["checks"][0]["baseline"] is None
    assert data["checks"][1]["baseline"] == max(error for _, error in outcomes[1].baseline)
    assert "tip-mass" in found.tables[0].csv()


def test_unknown_check_names_the_nearest(capsys):
    assert status_of(["stress", "tip-mas"]) == 2
    assert "did you mean 'tip-mass'?" in capsys.readouterr().err
