"""Error spectrum and convergence: their tables hold what the models' own verbs return."""

import pytest

from verify.analytic_modes import frequency_hz
from verify.models.catalogue import MODELS
from verify.scene.load import load_scene
from verify.studies.convergence import Convergence
from verify.studies.spectrum import Spectrum

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
    assert any("Euler-Bernoulli theory neglects" in warning for warning in result.warnings)


def test_missing_modes_are_gaps_with_a_reason(run):
    result = run("paper", Spectrum(modes=13, count=11))
    assert result.tables[0].records()[-1]["segments"] is None
    assert result.tables[0].records()[-1]["Hermite elements"] is not None
    assert any("segments" in warning and "raise count" in warning for warning in result.warnings)
    assert "segments" not in result.summary


def test_spectrum_of_a_thick_beam_compares_with_its_own_theory(run, renders):
    result = run("thick-bar", Spectrum(modes=4, count=24, theory="timoshenko"))
    assert "exact Timoshenko" in result.tables[0].records()[0]
    assert not any("theory neglects" in warning for warning in result.warnings)
    axes = renders(result)
    assert axes["mode-errors"].get_ylabel() == "frequency error, %"
    assert axes["model-form"].get_yscale() == "log"
    assert len(axes["mode-shapes"].get_yticks()) == 3


def test_convergence_tabulates_direct_solves(run):
    result = run("paper", Convergence(modes=(2, 5), counts=(11, 23, 46)))
    for model, title in (("segment", "segments"), ("fem", "Hermite elements")):
        for row in rows_of(result.tables[0], model=title):
            found = MODELS[model].solve_modes(PAPER.beam, 5, row["N"]).frequencies_hz[row["mode"] - 1]
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


def test_orders_outside_the_asymptotic_range_void_the_summary(run):
    result = run("paper", Convergence(modes=(9,), counts=(10, 11)))
    assert "segments" not in result.summary
    assert any("order not converged" in warning for warning in result.warnings)


def test_variants_stand_side_by_side(run, renders):
    result = run("taut-strip", Convergence(modes=(3,), counts=(10, 20, 40), joints=("series", "tensioned")))
    last = {row["model"]: row["order"] for row in rows_of(result.tables[0], N=40)}
    assert last["segments"] == pytest.approx(2.0, abs=0.1)
    assert last["segments, joints tensioned"] == pytest.approx(4.0, abs=0.2)
    axes = renders(result)
    guides = [line for line in axes["errors-over-size"].lines if line.get_gid() == "guide"]
    assert len(guides) == 2
