"""Every packaged gate says what stands behind its figure, how far that may be off, and where it is from."""

from collections import Counter

import catalogue_reference
import pytest

from verify.errors import InputError
from verify.options import REFERENCES
from verify.run.gates import judge, reference_in_words
from verify.run.runner import workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import STARTER, Complex, Gate, load_scene, packaged_scenes
from verify.stress.catalogue import row

GATES = [(scene, gate) for scene in packaged_scenes() for gate in load_scene(scene).gate]
NAMED = [(scene, gate) for scene, gates in catalogue_reference.KNOWN.items() for gate in gates]


def plain(expect):
    return complex(expect.re, expect.im) if isinstance(expect, Complex) else expect


def test_every_packaged_gate_names_its_reference():
    for scene, gate in GATES:
        assert gate.reference in REFERENCES, (scene, gate.id)
        assert gate.uncertainty is not None, (scene, gate.id)
        assert 4 <= len(gate.source) <= 100, (scene, gate.id)


def test_figures_that_this_suite_alone_vouches_for_are_few_and_say_so():
    kinds = Counter(gate.reference for _, gate in GATES)
    figures = len(GATES) - kinds["promise"] - kinds["refusal"]
    assert kinds["regression"] <= 0.1 * figures
    assert sum(kinds.values()) == len(GATES)
    assert kinds["closed form"] + kinds["independent method"] > 0.9 * figures
    for scene, gate in GATES:
        assert (gate.reference == "regression") == gate.why.startswith("A regression value"), (scene, gate.id)


def test_what_the_stress_table_promises_and_refuses_is_called_so_and_nothing_else_is():
    """Kinds of rows decide. Less than a promise is no closed form; a share that is itself derived is."""
    called = {"floor": "promise", "growth": "promise", "refusal": "refusal"}
    for scene, gate in GATES:
        kind = row(gate.arguments["row"]).kind if gate.quantity == "stress.share" else ""
        if kind == "refusal" or (kind and gate.at_most is not None):
            assert gate.reference == called[kind], gate.id
        else:
            assert gate.reference not in called.values(), (scene, gate.id)


def test_a_regression_value_guards_nothing_that_is_derived_here():
    derived = {*NAMED}
    assert not [(s, g.id) for s, g in GATES if g.reference == "regression" and (s, g.id) in derived]


def test_a_band_is_wider_than_its_references_uncertainty():
    """A printed figure's band is half its last digit, and so is its uncertainty."""
    for scene, gate in GATES:
        if gate.within is not None:
            share = gate.uncertainty / gate.within
            assert share < 1 or (gate.reference == "published" and share == 1), (scene, gate.id, share)
        elif gate.expect is None:
            bound = gate.at_most if gate.at_most is not None else gate.at_least
            assert gate.uncertainty < abs(bound), (scene, gate.id)
        else:
            assert gate.uncertainty < 1e-9 * abs(gate.expect), (scene, gate.id)


def test_nothing_but_whole_numbers_and_balances_is_said_to_be_exact():
    """0 stands for counts, for refusals and for what is kept: everything else is rounded somewhere."""
    for scene, gate in GATES:
        if gate.uncertainty == 0:
            exact = gate.expect is None or float(gate.expect).is_integer()
            assert exact, (scene, gate.id)


@pytest.mark.parametrize(("scene", "gate"), NAMED)
def test_an_expectation_lies_within_its_uncertainty_of_its_reference(scene, gate):
    found = next(one for one in load_scene(scene).gate if one.id == gate)
    off = abs(catalogue_reference.KNOWN[scene][gate]() - (plain(found.expect) or 0.0))
    assert off <= found.uncertainty


# --- A gate of one's own ----------------------------------------------------------------------------------------------

OWN = {"id": "mine", "quantity": "mode.frequency", "expect": 231.0, "within": 2.0, "why": "measured in the laboratory"}
MEASURED = {"arguments": {"model": "analytic", "mode": 5}}


def test_a_gate_of_ones_own_need_not_say_and_is_shown_so():
    paper = load_scene("paper")
    found = judge(checked(OWN | MEASURED, Gate), paper, workbench_for(paper))
    assert (found.reference, found.uncertainty, found.source) == (None, None, "")
    assert reference_in_words(found) == "not said"
    assert all(gate.reference is None for gate in load_scene(STARTER).gate)


def test_what_a_gate_says_of_its_reference_is_in_its_result():
    paper = load_scene("paper")
    said = {"reference": "published", "uncertainty": 0.3, "source": "laboratory's sheet 7"}
    found = judge(checked(OWN | MEASURED | said, Gate), paper, workbench_for(paper))
    assert (found.reference, found.uncertainty, found.source) == ("published", 0.3, "laboratory's sheet 7")
    assert reference_in_words(found) == "published ± 0.3 Hz, laboratory's sheet 7"
    exact = checked(OWN | MEASURED | said | {"uncertainty": 0.0, "source": ""}, Gate)
    assert reference_in_words(judge(exact, paper, workbench_for(paper))) == "published, exact"


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"reference": "closed from"}, r"reference = 'closed from' is not known: did you mean 'closed form'\?"),
        (
            {"reference": "published", "uncertainty": -1.0},
            r"gate.mine.uncertainty = -1.0: give a finite number of at l",
        ),
        ({"reference": "published", "uncertainty": float("inf")}, r"gate.mine.uncertainty = inf"),
        (
            {"uncertainty": 0.1},
            r"gate.mine.uncertainty = 0.1 is of a reference that is not said: give gate.mine.refere",
        ),
        (
            {"source": "Fryba"},
            r"gate.mine.source = 'Fryba' is of a reference that is not said: .* one of closed form, ",
        ),
    ],
)
def test_what_makes_no_sense_of_a_reference_is_refused(said, words):
    with pytest.raises(InputError, match=words):
        checked(OWN | said, Gate)
