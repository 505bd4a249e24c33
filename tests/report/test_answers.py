"""The answer of a report: of studies, or of what the gates found, never only that they are held."""

import pytest

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
