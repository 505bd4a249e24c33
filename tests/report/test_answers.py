"""The answer of a report: of studies, or of what the gates found, never only that they are held."""

import pytest
from strip import STRIP

from verify import run_scene
from verify.report.answer import answers_of, gates_in_short
from verify.run.runner import RunResult
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type


@pytest.fixture(scope="module", params=["driven-cantilever", "driving-layer", "heavy-slider", "stick-slip-belt"])
def told(request) -> RunResult:
    return run_scene(request.param)


def test_a_scene_of_gates_alone_answers_with_a_figure_of_its_own(told):
    first, held, *_ = answers_of(told)
    assert any(first.startswith(f"{gate.quantity} (") for gate in told.gates)
    assert "known figures are met to" in first
    assert held.startswith("Every gate that applies is held")


def test_models_of_parts_stand_beside_the_exact_beam_where_gates_ask_for_both():
    """Of a cantilever at x = 0.2957 m: |w - w_exact| / |w_exact| from the figures of three gates."""
    found = run_scene("driven-cantilever")
    at = {
        gate.id: complex(gate.measured["re"], gate.measured["im"])
        for gate in found.gates
        if "-deflection" in gate.id and isinstance(gate.measured, dict)
    }
    exact = at["exact-deflection"]
    (told,) = gates_in_short(found.gates)
    assert told.startswith(
        "wave.deflection (complex deflection, e^{+i omega t}) is 1.12331e-05 +4.54692e-06i m at x = "
    )
    for parts, name in (("Hermite elements", "elements-deflection"), ("segments", "segments-deflection")):
        assert f"23 {parts} are {100 * abs(at[name] / exact - 1):+.4f} % off" in told


def test_a_scene_without_gates_or_studies_answers_with_its_scale_alone():
    from verify import load_scene

    bare = load_scene("driving-layer").bare
    found = RunResult(scene=bare, gates=(), found={}, solves=(), n_fields=0, n_motions=0, seconds=0.1)
    assert answers_of(found) == ("The beam's first mode is at 9.2354 Hz.",)


LONE = """
[[gate]]
id = "lone"
quantity = "mode.frequency"
arguments = {{ {asked}, mode = 2 }}
expect = 49.9
within = 9.0
why = "Near it."
"""


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ('model = "segment", count = 9', "49.89118 Hz at mode = 2, of 9 segments."),
        ('model = "fem", count = 3', "50.49024 Hz at mode = 2, of 3 Hermite elements."),
        ('model = "analytic"', "49.90041 Hz at mode = 2, of the exact beam."),
    ],
)
def test_a_figure_that_stands_alone_says_of_which_model_it_is(asked, told, tmp_path):
    """Nine segments' and forty's were both "49.9 Hz at mode = 2"."""
    path = tmp_path / "strip.toml"
    path.write_text(STRIP.partition("[[gate]]")[0] + LONE.format(asked=asked))
    answer, *_ = answers_of(run_scene(str(path)))
    assert answer == f"mode.frequency (frequency of one mode) is {told}"


OWN = {"length": 0.61, "width": 0.03, "thickness": 0.002, "youngs_modulus": 7.1e10, "density": 2710.0}


def gate(name, **band):
    reference = band.pop("reference", None)
    return {
        "id": name,
        "quantity": "mode.frequency",
        "arguments": {"model": "analytic", "mode": len(name)},
        "why": "It is asked.",
        **({"reference": reference} if reference else {}),
        **band,
    }


def judged(*gates):
    return run_scene(checked({"name": "own", "beam": OWN, "gate": list(gates)}, scene_type()))


def test_a_figure_that_is_not_met_and_one_of_the_suite_itself_are_no_known_figures():
    """Those that are: 1 in 10 000 off, and exact."""
    right = [one.measured for one in judged(gate("a", at_least=0.0), gate("bb", at_least=0.0)).gates]
    met = gate("a", expect=1.0001 * right[0], within=1.0), gate("bb", expect=right[1], within=1.0)
    missed = gate("ccc", expect=2.0 * right[0], within=1e-9)
    own = gate("dddd", expect=1.3 * right[0], within=1e9, reference="regression")
    (told,) = gates_in_short(judged(*met, missed, own).gates)
    assert "2 known figures are met to 0.0100 % or better" in told


def test_the_nearest_to_its_edge_is_of_those_whose_bands_have_a_size():
    first = judged(gate("a", at_least=0.0)).gates[0].measured
    near = gate("a", expect=first, within=first)
    assert "held; the nearest to its edge is a, at 0 % of its band" in " ".join(answers_of(judged(near)))
    found = judged(near, gate("bb", at_least=-1e-9))
    assert "held; of 1 whose band has a size the nearest to its edge is a" in " ".join(answers_of(found))
