"""The answer of a report: of studies, or of what the gates found, never only that they are held."""

import pytest
from strip import STRIP

from verify import run_scene
from verify.report.answer import answers_of, gates_in_short
from verify.run.runner import RunResult


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
