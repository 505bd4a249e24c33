"""What changed between two saved runs: levels of verdicts, gates by outcome and value, inputs, versions."""

from collections.abc import Iterator, Mapping
from typing import Any

from verify.errors import InputError
from verify.report.result import Column, Result, Table
from verify.report.summary import VERDICTS

ARROW = "→"
Run = Mapping[str, Any]
"""Data of a run (`report.summary.run_data`)."""


def compare_runs(before: Mapping[str, Run], after: Mapping[str, Run]) -> Result:
    """Differences of runs by report name; two single runs are compared whatever their names are.

    `data["broken"]` lists gates that passed before and fail, or are missing, now. Raises InputError where no name is
    in both.
    """
    names = [name for name in before if name in after]
    pairs = [(name, before[name], after[name]) for name in names]
    if len(before) == len(after) == 1:
        (name, old), (_, new) = *before.items(), *after.items()
        pairs = [(name, old, new)]
    elif not pairs:
        raise InputError(
            f"A has {', '.join(before)} and B has {', '.join(after)}, no name in both: give runs of the same scene"
        )
    gates = [(name, *row) for name, old, new in pairs for row in _gates(old["gates"], new["gates"])]
    inputs = [(name, *row) for name, old, new in pairs for row in _changed(old["inputs"], new["inputs"])]
    versions = [(name, *row) for name, old, new in pairs for row in _changed(_versions(old), _versions(new))]
    both = [(name, old["verdict"], new["verdict"]) for name, old, new in pairs]
    levels = [(name, _turn(a["level"], b["level"]), b["headline"]) for name, a, b in both if a["level"] != b["level"]]
    broken = [f"{row[0]}: {row[1]}" for row in gates if row[2].startswith(f"{VERDICTS[True]} {ARROW}")]
    keys = ("report", "key", "before", "after")
    columns = [Column(name) for name in ("report", "gate", "verdict", "expected")]
    columns += [Column("before", format=".10g"), Column("after", format=".10g")]
    tables = [
        Table("Verdicts that changed", [Column(key) for key in ("report", "level", "headline now")], levels),
        Table("Gates that changed", [*columns, Column("change", percent=True, format="+.3g")], gates),
        Table("Inputs that changed", [Column(key) for key in keys], inputs),
        Table("Environment", [Column(key) for key in keys], versions),
    ]
    missing = [name for name in (*before, *after) if len(before) + len(after) > 2 and name not in names]
    return Result(
        summary=f"Changed: {len(levels)} verdicts, {len(gates)} gates ({len(broken)} broken), {len(inputs)} inputs.",
        tables=[table for table in tables if table.rows],
        warnings=[f"{name} is in one of the two only" for name in missing],
        data={"broken": broken},
    )


def _gates(before: list[Any], after: list[Any]) -> Iterator[tuple[Any, ...]]:
    old, new = ({gate["id"]: gate for gate in gates} for gates in (before, after))
    nothing = {"passed": "missing", "value": None, "expected": None}
    for name in dict.fromkeys((*old, *new)):
        one, other = old.get(name, nothing), new.get(name, nothing)
        if any(one[key] != other[key] for key in ("passed", "value", "expected")):
            a, b = one["value"], other["value"]
            real = isinstance(a, float | int) and isinstance(b, float | int) and a
            values = [_text(value) for value in (a, b)] if not real else [a, b]
            verdicts = [VERDICTS.get(gate["passed"], "missing") for gate in (one, other)]
            criteria = _turn(one["expected"] or "", other["expected"] or "")
            yield name, _turn(*verdicts), criteria, *values, (b - a) / abs(a) if real else None


def _turn(before: str, after: str) -> str:
    return before if before == after else f"{before} {ARROW} {after}"


def _text(value: Any) -> Any:
    return value if value is None or isinstance(value, float | int) else ", ".join(f"{k} {v}" for k, v in value.items())


def _versions(run: Run) -> dict[str, Any]:
    return {key: value for key, value in run["environment"].items() if key != "date"}


def _changed(before: Any, after: Any, path: str = "") -> Iterator[tuple[str, str | None, str | None]]:
    """(path, before, after) of values that differ in nested data."""
    if before == after:
        return
    if isinstance(before, list) and isinstance(after, list):
        before, after = dict(enumerate(before)), dict(enumerate(after))
    if isinstance(before, dict) and isinstance(after, dict):
        for key in dict.fromkeys((*before, *after)):
            yield from _changed(before.get(key), after.get(key), f"{path}.{key}".lstrip("."))
    else:
        yield path, None if before is None else str(before), None if after is None else str(after)
