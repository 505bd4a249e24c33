"""What the studies of modes say in words: against which theory a figure is, and why a column is empty."""

import pytest

from verify.judge.workbench import Workbench
from verify.scenes.scene import load_scene
from verify.studies.convergence import Convergence
from verify.studies.convergence_figures import convergence
from verify.studies.spectrum import Spectrum
from verify.studies.spectrum_figures import spectrum

THICK = Workbench(load_scene("thick-bar").beam)


def test_a_table_of_two_theories_names_the_exact_frequency_of_each():
    told = convergence(THICK, Convergence(modes=(2,), counts=(7, 12), theory=("euler-bernoulli", "timoshenko")))
    first, *_, rules = told.tables()
    assert first.title == "mode 2, exact 1454.4703 Hz (Euler-Bernoulli), 1401.4956 Hz (Timoshenko)"
    heads = [column.head for column in rules.columns]
    assert heads[1:3] == ["default", "default, timoshenko"]
    assert len(set(heads)) == len(heads)


def test_a_table_of_one_theory_names_its_exact_frequency():
    told = convergence(THICK, Convergence(modes=(3,), counts=(7, 12), theory="timoshenko"))
    assert told.tables()[0].title == "mode 3, exact 3747.5412 Hz"  # by a transfer matrix written apart


def test_a_theory_s_own_shift_is_not_said_to_be_against_itself():
    (told,) = spectrum(THICK, Spectrum(modes=5, count=11, theory="timoshenko")).facts()
    thick, _, theories = told.partition(", and against Euler-Bernoulli ")
    assert thick.startswith("mode 5 at N = 11 against Timoshenko: segments")
    assert "theory" not in thick
    assert theories.startswith("Rayleigh theory -")


@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
def test_a_mesh_is_called_too_fine_for_a_theory_that_leaves_something_out_alone(theory):
    chart = spectrum(THICK, Spectrum(modes=3, count=11, theory=theory)).charts()[1]
    assert ("nobody asked" in chart.caption) == (theory == "euler-bernoulli")


def test_a_rule_that_is_refused_at_every_size_says_why_and_one_that_cannot_exist_has_no_column():
    taut = load_scene("paper", ("beam.tension=1e5", 'beam.supports=["clamped","pinned"]')).beam
    rules = convergence(Workbench(taut), Convergence(modes=(1,), counts=(15, 22))).tables()[-1]
    assert any(note.startswith("joints tensioned: ") and "leaves no stiffness" in note for note in rules.notes)
    assert "wall welded" not in [column.head for column in rules.columns]
