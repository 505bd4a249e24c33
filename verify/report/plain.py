"""Results as plain data and text: JSON, CSV, Markdown."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.run.remarks import remarks_on
from verify.scenes.toml import literal
from verify.studies.catalogue import STUDIES

if TYPE_CHECKING:
    from verify.judge.sizing import Choice
    from verify.judge.workbench import Workbench
    from verify.run.runner import RunResult
    from verify.studies.told import Found


def run_as_plain(result: "RunResult", report: Path | None) -> dict[str, Any]:
    """A run for `verify run --json`."""
    return {
        "scene": result.scene.name,
        **_remarked(result),
        "passed": result.passed,
        "gates": msgspec.to_builtins(result.gates),
        **dict(_studies_as_plain(result)),
        "solves": msgspec.to_builtins(result.solves),
        "seconds": result.seconds,
        "report": str(report) if report else None,
    }


def _remarked(result: "RunResult") -> dict[str, list[str]]:
    """What looks like another unit; nothing where nothing does."""
    remarks = remarks_on(result.scene)
    return {"remarks": list(remarks)} if remarks else {}


def _studies_as_plain(result: "RunResult") -> Iterator[tuple[str, Any]]:
    """Every study by its name, what it says of nothing where the scene did not ask for it."""
    for name in dict.fromkeys((*STUDIES.built_in, *result.found)):
        yield name, result.found[name].plain() if name in result.found else STUDIES[name].nothing


def text_of(found: "Found", layout: str) -> str:
    """What a study found as json, csv or markdown, ending in a newline."""
    if layout == "json":
        import json

        return json.dumps(finite(found.plain()), indent=2, allow_nan=False) + "\n"
    return rows_as_text(found.records(), layout)


def rows_as_text(rows: list[dict[str, Any]], layout: str) -> str:
    """Rows as csv or markdown, an infinite ratio in a word; notes are left to JSON."""
    if not rows:
        raise InputError(f"--{layout}: the study has no table, ask for --json")
    columns = [name for name in rows[0] if name != "notes"]
    cells = [[_cell(row[name]) for name in columns] for row in rows]
    if layout == "csv":
        import csv
        from io import StringIO

        text = StringIO()
        csv.writer(text, lineterminator="\n").writerows([columns, *cells])
        return text.getvalue()
    rule = ["---:"] * len(columns)
    return "".join("| " + " | ".join(line) + " |\n" for line in [columns, rule, *cells])


def _cell(value: Any) -> str:
    """A figure with all its digits; nothing where there is none."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return f"{'-' * (value < 0)}infinity" if isinstance(value, float) and math.isinf(value) else str(value)


def finite(data: Any) -> Any:
    """Plain data with None for numbers that JSON cannot hold."""
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {key: finite(value) for key, value in data.items()}
    return [finite(value) for value in data] if isinstance(data, list | tuple) else data


def mode_number(text: str) -> int:
    """A mode number as typed. Raises InputError."""
    value = literal(text, "mode")
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"mode = {text!r}: give a whole number from 1")
    return value


def mode_numbers(text: str) -> int | range:
    """A mode number, or all of several, as typed: '12', '1-12'. Raises InputError."""
    first, dash, last = text.strip().partition("-")
    if "," in text:
        raise InputError(f"mode = {text!r}: give one mode, or all from one to another, as 1-12")
    if not (first and dash):
        return mode_number(text)
    low, high = mode_number(first), mode_number(last)
    if high < low:
        raise InputError(f"mode = {text!r}: the last is below the first, write {high}-{low}")
    return range(low, high + 1)


def accuracy(text: str, field: str = "error") -> float:
    """A relative error as typed, '1%' or '0.01'. Raises InputError unless it lies between 1e-12 and 1.

    A plain number of 0.1 or more is meant in per cent by most who write it, and is refused.
    """
    value = literal(text.strip().removesuffix("%"), field)
    number = isinstance(value, int | float) and not isinstance(value, bool)
    in_percent = text.strip().endswith("%")
    error = float(value) / (100.0 if in_percent else 1.0) if number else 0.0
    if not 1e-12 <= error < 1.0 and not (in_percent is False and 1.0 <= error < 100.0):
        raise InputError(f"{field} = {text!r}: give a relative error from 1e-12 up to 1, for instance 1% or 0.01")
    if error >= _PLAIN and not in_percent:
        below = f" or {error / 100.0:g}" if error / 100.0 < _PLAIN else ""
        whole = f", for {100.0 * error:g} per cent {100.0 * error:g}%" if error < 1.0 else ""
        raise InputError(
            f"{field} = {text!r} has no per cent sign: for {error:g} per cent write {error:g}%{below}{whole}"
        )
    return error


_PLAIN = 0.1
"""From here on an error needs its per cent sign."""


def choice_as_plain(
    bench: "Workbench", mode: int | range, error: float, choices: "list[Choice]", left_out: dict[str, str]
) -> dict[str, Any]:
    """An answer of `verify choose --json`; of several modes, `mode` is the last."""
    modes = [mode] if isinstance(mode, int) else list(mode)
    return {
        "mode": modes[-1],
        "modes": modes,
        "error": error,
        "exact_hz": bench.exact_hz(modes[-1]),
        "choices": [msgspec.to_builtins(one) | {"settings": dict(one.settings)} for one in choices],
        "left_out": left_out,
    }
