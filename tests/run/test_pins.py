"""What packaged scenes plan and find does not move without a word: `python tests/run/test_pins.py` writes it anew.

Pinned are the plan, the measured value of every gate, and every figure of `verify run --json` but run times. Figures are
held to 1e-5, for orders amplify rounding, and rounding errors to their size: pins are no references, `why` of a gate names those.
"""

import json
import sys
from math import isclose
from pathlib import Path

import msgspec
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from packaged import told

from verify.run.plan import plan_scene
from verify.scenes.scene import load_scene, packaged_scenes

PINS = Path(__file__).parent / "pins"
TIMED = ("seconds", "run_time_s", "run_ms_per_ms", "set_up_ms", "answer", "report", "statistics", "ledger")
"""How keys end whose values are of the clock, follow from it, or are counts and rounding of adaptive steps."""
FEW = 3
"""Of a long list that many are pinned, and its length."""
ROUNDING = 1e-11


def leaves(data, path=""):
    """(path, value) of plain data without run times."""
    if isinstance(data, dict):
        for key, value in data.items():
            if not key.endswith(TIMED):
                yield from leaves(value, f"{path}.{key}" if path else key)
    elif isinstance(data, list | tuple):
        names = [one.get("id") if isinstance(one, dict) else None for one in data]
        yield f"{path}.length", len(data)
        for i, one in enumerate(data):
            if names[i] or i < FEW:
                yield from leaves(one, f"{path}[{names[i] or i}]")
    else:
        yield path, data


def found(scene):
    plan = msgspec.to_builtins(plan_scene(load_scene(scene)))
    words = ("why", "band", "expected", "share", "reason", "quantity", "arguments", "notes")
    run = {
        path: value for path, value in leaves(told(scene)) if not set(path.replace("]", "].").split(".")) & set(words)
    }
    return {"plan": dict(leaves(plan)), "run": run}


def same(value, pinned):
    if isinstance(value, float) and isinstance(pinned, float | int):
        return isclose(value, pinned, rel_tol=1e-5, abs_tol=ROUNDING)
    return value == pinned


@pytest.mark.parametrize("scene", packaged_scenes())
def test_a_packaged_scene_plans_and_finds_what_it_did(scene):
    pinned = json.loads((PINS / f"{scene}.json").read_text("utf-8"))
    for part, values in json.loads(json.dumps(found(scene))).items():
        moved = {
            path
            for path in set(values) | set(pinned[part])
            if path not in values or path not in pinned[part] or not same(values[path], pinned[part][path])
        }
        shown = [f"{path}: {pinned[part].get(path)!r} -> {values.get(path)!r}" for path in sorted(moved)[:8]]
        assert not moved, f"{len(moved)} figures of the {part} moved: {'; '.join(shown)}"


def test_no_pin_is_left_of_a_scene_that_is_gone():
    assert {path.stem for path in PINS.glob("*.json")} == set(packaged_scenes())


if __name__ == "__main__":
    for name in packaged_scenes():
        (PINS / f"{name}.json").write_text(json.dumps(found(name), indent=1, sort_keys=True) + "\n", encoding="utf-8")
        print(name)
