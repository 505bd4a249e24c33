"""Results as plain data and text: JSON, CSV, Markdown."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.checked import checked
from verify.errors import InputError
from verify.scene import Convergence, Scene, literal

if TYPE_CHECKING:
    from verify.run import RunResult
    from verify.sizing import Choice
    from verify.studies import Row
    from verify.workbench import Workbench


def run_as_plain(result: "RunResult", report: Path | None) -> dict[str, Any]:
    """A run for `verify run --json`."""
    return {
        "scene": result.scene.name,
        "passed": result.passed,
        "gates": msgspec.to_builtins(result.gates),
        "spectrum": msgspec.to_builtins(result.spectrum),
        "convergence": [flat_row(row) for row in result.convergence or ()],
        "sensitivity": msgspec.to_builtins(result.sensitivity),
        "solves": msgspec.to_builtins(result.solves),
        "seconds": result.seconds,
        "report": str(report) if report else None,
    }


def table_request(scene: Scene, modes: str | None, counts: str | None) -> Convergence:
    """What a table shows: the command line's lists, else the scene's [convergence], else defaults."""
    asked = msgspec.to_builtins(scene.convergence or Convergence())
    for name, text in (("modes", modes), ("counts", counts)):
        if text is not None:
            value = literal(text)
            asked[name] = value if isinstance(value, list) else [value]
    return checked(asked, Convergence)


def flat_row(row: "Row") -> dict[str, Any]:
    """One row of the convergence table with one level of names."""
    flat: dict[str, Any] = {"mode": row.mode, "count": row.count, "exact_hz": row.exact_hz}
    for model in ("segment", "fem"):
        flat |= {f"{model}_{name}": value for name, value in msgspec.to_builtins(getattr(row, model)).items()}
    return flat | {"bracket_width": row.bracket_width, "mean_error": row.mean_error, "notes": list(row.notes)}


def table_text(rows: "tuple[Row, ...]", layout: str) -> str:
    """A convergence table as json, csv or markdown, ending in a newline."""
    flat = [flat_row(row) for row in rows]
    if layout == "json":
        import json

        return json.dumps(flat, indent=2, allow_nan=False) + "\n"
    columns = [name for name in flat[0] if name != "notes"]
    cells = [["" if row[name] is None else repr(row[name]) for name in columns] for row in flat]
    if layout == "csv":
        return "".join(",".join(line) + "\n" for line in [columns, *cells])
    rule = ["---:"] * len(columns)
    return "".join("| " + " | ".join(line) + " |\n" for line in [columns, rule, *cells])


def mode_number(text: str) -> int:
    """A mode number as typed. Raises InputError."""
    value = literal(text)
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"mode = {text!r}: give a whole number from 1")
    return value


def accuracy(text: str) -> float:
    """A relative error as typed, '1%' or '0.01'. Raises InputError unless it lies between 1e-12 and 1."""
    value = literal(text.strip().removesuffix("%"))
    number = isinstance(value, int | float) and not isinstance(value, bool)
    error = float(value) / (100.0 if text.strip().endswith("%") else 1.0) if number else 0.0
    if not 1e-12 <= error < 1.0:
        raise InputError(f"error = {text!r}: give a relative error from 1e-12 up to 1, for instance 1% or 0.01")
    return error


def choice_as_plain(bench: "Workbench", mode: int, error: float, choices: "list[Choice]") -> dict[str, Any]:
    """An answer of `verify choose --json`."""
    return {"mode": mode, "error": error, "exact_hz": bench.exact_hz(mode), "choices": msgspec.to_builtins(choices)}
