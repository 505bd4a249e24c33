"""Results as plain data and text: JSON, CSV, Markdown."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.checked import checked
from verify.scene import Convergence, Scene, literal

if TYPE_CHECKING:
    from verify.run import RunResult
    from verify.studies import Row


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
