"""Saved runs, a folder for each with its page and its data and a copy of the latest page above them, and their changes.

reports/paper.html                            the latest page, a copy: one file can be sent or served
reports/paper/2026-03-01_14-05-09-271828/index.html  the page of a saved run
reports/paper/2026-03-01_14-05-09-271828/run.json    its data (`report.summary.run_data`)
"""

import json
import os
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from verify.errors import InputError, shown
from verify.files import exists, read_text, write_folder, write_whole
from verify.report.page import run_page
from verify.report.result import Column, Result, Table, to_json
from verify.report.summary import VERDICTS, run_data

if TYPE_CHECKING:
    from verify.scene.run import RunResult

DATA, PAGE = "run.json", "index.html"
ARROW = "→"
Run = Mapping[str, Any]
"""Data of a run (`report.summary.run_data`)."""
KEEP = 5  # saved runs of one name
DEEPEST = 50  # levels of inputs that are compared one by one, five times those of a scene
_GATE = msgspec.defstruct(
    "Gate", [("id", str), ("passed", bool | None), ("value", float | str | dict | None), ("expected", str | None)]
)
_VERDICT = msgspec.defstruct("Verdict", [("level", str), ("headline", str)])
_RUN = msgspec.defstruct(
    "Run",
    [("report", str), ("verdict", _VERDICT), ("gates", list[_GATE]), ("inputs", dict), ("environment", dict)],  # type: ignore[valid-type]
)  # what is compared; other keys may be beside them
_TIME = re.compile(r"\d{4}-\d{2}-\d{2}_\d{2}-\d{2}-\d{2}-\d{6}")


class Saved(NamedTuple):
    """Where a run is."""

    page: Path  # The latest page of that name
    folder: Path | None  # The saved run; None where none is kept


def report_name(scene: str, overrides: Sequence[str] = ()) -> str:
    """Name of a report: the scene's, with the overrides that other reports of the scene do not have."""
    changes = "_".join(re.sub(r"[^A-Za-z0-9.=+-]+", "-", text).strip("-") for text in overrides)
    return f"{scene}_{changes}"[:120] if changes else scene


def save_run(run: "RunResult", reports: Path, name: str, command: str = "", keep: int = KEEP) -> Saved:
    """Write page and data of a run and delete all but the `keep` newest saved runs of that name.

    Every file is whole or absent. With keep = 0 the latest page is the only file. Raises InputError where it cannot
    be written, or where a file has the name of the folder.
    """
    page, home, folder = run_page(run, command), reports / name, None
    if keep:
        if exists(home, "reports") and not home.is_dir():
            raise InputError(f"reports = {str(home)!r} is no folder, runs are saved there: move it, or give --keep 0")
        folder = home / datetime.now(UTC).strftime("%Y-%m-%d_%H-%M-%S-%f")
        data = to_json(run_data(run, command) | {"report": name})
        write_folder(folder, {PAGE: page, DATA: data}, "reports")
        for old in saved_in(home)[:-keep]:
            shutil.rmtree(old, ignore_errors=True)
    write_whole(reports / f"{name}.html", page, "reports")
    return Saved(reports / f"{name}.html", folder)


def saved_in(home: Path) -> list[Path]:
    """Folders with a saved run, from the oldest to the newest."""
    folders = [folder.parent for folder in home.glob(f"*/{DATA}") if _TIME.fullmatch(folder.parent.name)]
    return sorted(folder for folder in folders if not folder.is_symlink())


def read_runs(path: Path, field: str) -> dict[str, dict[str, Any]]:
    """Data of saved runs by report name: of a file, a run's folder, the newest of a report, or of all reports.

    Raises InputError where there is none.
    """
    if not exists(path, field):
        raise InputError(f"{field} = {str(path)!r} does not exist: give a {DATA}, or a folder of saved runs")
    if not path.is_dir():
        files = [path]
    elif exists(path / DATA, field):
        files = [path / DATA]
    elif not os.access(path, os.R_OK):
        remedy = f"change its permissions, or give a {DATA} in it"
        raise InputError(f"{field} = {shown(str(path))} may not be read: {remedy}")
    else:
        homes = [path] if saved_in(path) else sorted(home for home in path.iterdir() if home.is_dir())
        files = [saved_in(home)[-1] / DATA for home in homes if saved_in(home)]
    runs = [_read(file, field) for file in files]
    if not runs:
        raise InputError(f"{field} = {str(path)!r} has no saved run: give a {DATA}, or a folder of saved runs")
    return {run["report"]: run for run in runs}


def _read(path: Path, field: str) -> dict[str, Any]:
    try:
        run = json.loads(read_text(path, field))
        msgspec.convert(run, _RUN)
    except (json.JSONDecodeError, msgspec.ValidationError, RecursionError):
        raise InputError(f"{field} = {str(path)!r} is no saved run: give the {DATA} that `verify run` writes") from None
    return dict(run)


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
        different = f"A has {', '.join(before)} and B has {', '.join(after)}, no name in both"
        raise InputError(f"{different}: give runs of the same scene")
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
        gate_before, gate_after = old.get(name, nothing), new.get(name, nothing)
        if any(gate_before[key] != gate_after[key] for key in ("passed", "value", "expected")):
            a, b = gate_before["value"], gate_after["value"]
            real = isinstance(a, float | int) and isinstance(b, float | int) and a
            values = [", ".join(f"{k} {v}" for k, v in x.items()) if isinstance(x, dict) else x for x in (a, b)]
            verdicts = [VERDICTS.get(gate["passed"], "missing") for gate in (gate_before, gate_after)]
            criteria = _turn(gate_before["expected"] or "", gate_after["expected"] or "")
            yield name, _turn(*verdicts), criteria, *values, (b - a) / abs(a) if real else None


def _turn(before: str, after: str) -> str:
    return before if before == after else f"{before} {ARROW} {after}"


def _versions(run: Run) -> dict[str, Any]:
    return {key: value for key, value in run["environment"].items() if key != "date"}


def _changed(before: Any, after: Any, path: str = "") -> Iterator[tuple[str, str | None, str | None]]:
    """(path, before, after) of values that differ in nested data."""
    if before == after:
        return
    if isinstance(before, list) and isinstance(after, list):
        before, after = dict(enumerate(before)), dict(enumerate(after))
    if isinstance(before, dict) and isinstance(after, dict) and path.count(".") < DEEPEST:
        for key in dict.fromkeys((*before, *after)):
            yield from _changed(before.get(key), after.get(key), f"{path}.{key}".lstrip("."))
    else:
        yield path, None if before is None else str(before), None if after is None else str(after)
