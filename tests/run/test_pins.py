"""What packaged scenes plan and find does not move without a word: `python tests/run/test_pins.py` writes it anew.

Pinned are the plan, the measured value of every gate, and every figure of `verify run --json` but run times. Figures are
held to 1e-5, for orders amplify rounding, and rounding errors to their size: pins are no references, `why` of a gate names those.
"""

import json
import sys
from functools import cache
from math import hypot, isclose
from pathlib import Path

import msgspec
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from packaged import told

from verify.run.plan import plan_scene
from verify.scenes.scene import load_scene, packaged_scenes

PINS = Path(__file__).parent / "pins"
TIMED = (
    "seconds",
    "run_time_s",
    "run_ms_per_ms",
    "set_up_ms",
    "run_spread",
    "whole_spread",
    "share_spread",
    "power_spread",
    "answer",
    "report",
    "statistics",
    "ledger",
)
"""How keys end whose values are of the clock, follow from it, or are counts and rounding of adaptive steps."""
ROUNDED = ("stress.rows", "stress.fits", "stress.machine", "stress.date", "stress.left_out", "gates")
"""Of the scene stress all but its plan: roundings, exponents and times of the machine that it runs on."""
OF_REFERENCES = (".reference", ".uncertainty", ".source")
"""Of gates: what a scene says of its references is told, not found."""
FEW = 3
"""Of a long list that many are pinned, and its length."""
ROUNDING = 3e-11
"""Of a relative error: stock scikit-fem's at N = 49 is 5e-12 on one processor and -1.2e-11 on another, of nothing else. Of
a complex figure over its size."""
OF_DIFFERENCES = {"order": 2e-2, "law_ratio": 1e-4, "axial_departure": 3e-10}
"""By a quantity's last word, what another processor moves: of an observed order by 1e-2, for the differences that it is
read from have two digits left; of what an error is of its law by 1.2e-5; of how far a chain departs by 1e-10."""


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
    words = ("why", "band", "expected", "share", "reason", "quantity", "arguments", "notes", "applicable")
    run = {
        path: value
        for path, value in leaves(told(scene))
        if not set(path.replace("]", "].").split(".")) & set(words)
        and not (path.startswith("gates[") and path.endswith(OF_REFERENCES))
    }
    if scene == "stress":
        run = {path: value for path, value in run.items() if not path.startswith(ROUNDED)}
    return {"plan": dict(leaves(plan)), "run": run}


@cache
def kinds(scene):
    """The last words of the quantities of a scene's gates, by where their figures stand; of all orders the same."""
    last = {one.id: one.quantity.rpartition(".")[2] for one in load_scene(scene).gate}
    return {f"gates[{one}].measured": "order" if word.endswith("order") else word for one, word in last.items()}


def rounding(path, pinned, scene):
    """What rounding alone may do to a figure: to a relative error, a complex one, a small difference; not to metres."""
    whole, _, part = path.rpartition(".")
    gate = path.partition(".measured")[0]
    kind = "axial_departure" if path.startswith("axial_inertia.rows") else kinds(scene).get(path)
    if kind in OF_DIFFERENCES:
        return OF_DIFFERENCES[kind]
    if part in ("re", "im"):
        return ROUNDING * hypot(pinned[f"{whole}.re"], pinned[f"{whole}.im"])
    return ROUNDING if "error" in part or pinned.get(f"{gate}.unit") == "1" else 0.0


def same(path, values, pinned, scene):
    """Whether a figure is what it was, to 1e-5 or to rounding."""
    value, held = values[path], pinned[path]
    if not (isinstance(value, float) and isinstance(held, float | int)):
        return value == held
    return isclose(value, held, rel_tol=1e-5, abs_tol=rounding(path, pinned, scene))


@pytest.mark.parametrize("scene", packaged_scenes())
def test_a_packaged_scene_plans_and_finds_what_it_did(scene):
    pinned = json.loads((PINS / f"{scene}.json").read_text("utf-8"))
    for part, values in json.loads(json.dumps(found(scene))).items():
        moved = {
            path
            for path in set(values) | set(pinned[part])
            if path not in values or path not in pinned[part] or not same(path, values, pinned[part], scene)
        }
        shown = [f"{path}: {pinned[part].get(path)!r} -> {values.get(path)!r}" for path in sorted(moved)[:8]]
        assert not moved, f"{len(moved)} figures of the {part} moved: {'; '.join(shown)}"


@pytest.mark.parametrize("factor", [1.0 + 1e-4, -1.0])
@pytest.mark.parametrize("path", ["gates[slider-elements].measured", "motion.runs.segment.displacement"])
def test_a_nanometre_that_moves_is_seen(path, factor):
    values = json.loads((PINS / "paper-slider.json").read_text("utf-8"))["run"]
    assert same(path, values, values, "paper-slider")
    assert not same(path, values | {path: factor * values[path]}, values, "paper-slider")


def test_rounding_moves_no_pin_and_what_is_more_does():
    guided = json.loads((PINS / "guided-bar.json").read_text("utf-8"))["run"]
    nothing = "gates[exact-receptance].measured.im"
    size = abs(guided["gates[exact-receptance].measured.re"])
    assert same(nothing, guided | {nothing: 6e-12 * size}, guided, "guided-bar")
    assert not same(nothing, guided | {nothing: 6e-11 * size}, guided, "guided-bar")
    ridden = json.loads((PINS / "paper-slider.json").read_text("utf-8"))["run"]
    order = "gates[slider-order-step].measured"
    assert same(order, ridden | {order: ridden[order] + 1.1e-2}, ridden, "paper-slider")
    assert not same(order, ridden | {order: ridden[order] + 4e-2}, ridden, "paper-slider")


def test_no_pin_is_left_of_a_scene_that_is_gone():
    assert {path.stem for path in PINS.glob("*.json")} == set(packaged_scenes())


if __name__ == "__main__":
    for name in packaged_scenes():
        (PINS / f"{name}.json").write_text(json.dumps(found(name), indent=1, sort_keys=True) + "\n", encoding="utf-8")
        print(name)
