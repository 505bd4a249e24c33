"""What a reader takes home of a run: sentences of its studies, of its gates, of the beam's own scale."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from verify.models.catalogue import MODELS
from verify.quantities.catalogue import QUANTITIES
from verify.run.remarks import remarks_on
from verify.run.scale import scale_in_words
from verify.scenes.scene import Complex
from verify.words import figure, percent

if TYPE_CHECKING:
    from verify.run.gates import GateResult
    from verify.run.runner import RunResult
    from verify.scenes.scene import Scene

ANSWERS = 2
"""Sentences of studies and gates; that of the beam's scale, and remarks, follow."""
SAID_AT = 3
"""Arguments of a figure that a sentence has room for."""


def answers_of(result: "RunResult") -> tuple[str, ...]:
    """What the studies found, or the gates where they say nothing; how far those are from failing; the beam's scale."""
    said = [sentence for found in result.found.values() if (sentence := found.in_short())]
    said = said or [*gates_in_short(result.gates)]
    if result.passed:
        said += _nearest(result.gates)
    scale = scale_in_words(result.scene)
    return (*said[:ANSWERS], *([scale] if scale else []), *told_remarks(result.scene))


def told_remarks(scene: "Scene") -> tuple[str, ...]:
    """What looks like another unit, as sentences."""
    return tuple(f"Remark: {remark}." for remark in remarks_on(scene))


def _nearest(gates: "tuple[GateResult, ...]") -> Iterator[str]:
    """Which gate is nearest to its edge."""
    judged = [gate for gate in gates if gate.share is not None and gate.passed]
    if judged:
        worst = max(judged, key=lambda gate: gate.share or 0.0)
        share = int(100.0 * (worst.share or 0.0))
        others = sum(bool(gate.passed) and gate.share is None for gate in gates)
        of = f"of {len(judged)} whose band has a size " if others else ""
        yield f"Every gate that applies is held; {of}the nearest to its edge is {worst.id}, at {share} % of its band."


def gates_in_short(gates: "tuple[GateResult, ...]") -> Iterator[str]:
    """A figure on the exact beam and on models of parts where gates ask for both, else the first; how all agree."""
    known = [gate for gate in gates if gate.applicable and _value(gate.measured) is not None]
    if not known:
        return
    side = next((group for group in _side_by_side(known) if len(group) > 1), known[:1])
    first, *others = side
    off = [f"{_parts(one)} are {percent(_apart(one.measured, first.measured))} off" for one in others]
    unit = "" if first.unit == "1" else f" {first.unit}"
    told = f"{_named(first)} is {figure(first.measured)}{unit}{_at(first)}{'' if others else _of(first)}"
    met = [gate for gate in known if gate.passed and gate.reference != "regression"]
    sure = [abs(_apart(gate.measured, gate.band.expect)) for gate in met if _value(gate.band.expect)]
    n = len(sure)
    agree = f"{n} known figures are met to {percent(max(sure), sign=False)} or better" if n > 1 else ""
    yield "; ".join(part for part in (told, ", ".join(off), agree) if part) + "."


def _side_by_side(gates: "list[GateResult]") -> Iterator["list[GateResult]"]:
    """Gates on one figure under the same arguments: on the exact beam, then one on each model of parts."""

    def about(gate: "GateResult") -> str:
        others = {key: value for key, value in gate.arguments.items() if key not in ("model", "count")}
        return f"{gate.quantity} {sorted(others.items(), key=str)}"

    groups: dict[str, list[GateResult]] = {}
    for gate in gates:
        groups.setdefault(about(gate), []).append(gate)
    for group in groups.values():
        exact = [gate for gate in group if _model(gate) and not MODELS[_model(gate)].sized]
        sized = {_model(gate): gate for gate in group if _model(gate) and gate.arguments.get("count")}
        if exact and sized:
            yield [exact[0], *sized.values()]


def _model(gate: "GateResult") -> str:
    """The model that a gate is about; empty where its figure has none of ours."""
    fields = {one.name: one.default for one in _fields(gate)}
    name = gate.arguments.get("model", fields.get("model"))
    return name if isinstance(name, str) and name in MODELS else ""


def _fields(gate: "GateResult") -> Any:
    from msgspec.structs import fields

    return fields(QUANTITIES[gate.quantity].arguments)


def _parts(gate: "GateResult") -> str:
    return f"{gate.arguments['count']} {MODELS[_model(gate)].title}"


def _named(gate: "GateResult") -> str:
    """A figure by its name, and what that is."""
    about = QUANTITIES[gate.quantity].summary.rstrip(".") if gate.quantity in QUANTITIES else ""
    return f"{gate.quantity} ({about[:1].lower()}{about[1:]})" if about else gate.quantity


def _conditions(gate: "GateResult") -> dict[str, Any]:
    """Its arguments beside the model."""
    return {key: value for key, value in gate.arguments.items() if key not in ("model", "count")}


def _at(gate: "GateResult") -> str:
    """Under which arguments, or as which gate has them."""
    given = _conditions(gate)
    if len(given) > SAID_AT:
        return f" as gate {gate.id} has it"
    told = ", ".join(f"{key} = {f'{value:.4g}' if isinstance(value, float) else value}" for key, value in given.items())
    return f" at {told}" if told else ""


def _of(gate: "GateResult") -> str:
    """Of which model, in how many parts, where nothing beside it says so."""
    name = _model(gate)
    if not name or len(_conditions(gate)) > SAID_AT:
        return ""
    if not MODELS[name].sized:
        return f", of the {MODELS[name].title}"
    return f", of {_parts(gate)}" if gate.arguments.get("count") else f", of {MODELS[name].title}"


def _value(told: Any) -> complex | float | None:
    """A measured or expected figure as a number; None for a bracket, or where there is none."""
    if isinstance(told, Complex):
        return complex(told.re, told.im)
    if isinstance(told, dict):
        return complex(told["re"], told["im"]) if "re" in told else None
    return float(told) if isinstance(told, float | int) else None


def _apart(one: Any, other: Any) -> float:
    """Relative; signed where both are real."""
    a, b = _value(one), _value(other)
    if a is None or not b:
        return 0.0
    off = a / b - 1.0
    return abs(off) if isinstance(off, complex) else off
