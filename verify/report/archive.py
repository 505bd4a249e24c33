"""Saved runs: a folder for each with its page and its data, and a copy of the latest page above them.

reports/paper.html                            the latest page, a copy: one file can be sent or served
reports/paper/2026-03-01_14-05-09-271828/index.html  the page of a saved run
reports/paper/2026-03-01_14-05-09-271828/run.json    its data (`report.summary.run_data`)
"""

import json
import re
import shutil
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from verify.errors import InputError
from verify.files import exists, write_folder, write_whole
from verify.report.summary import run_data

if TYPE_CHECKING:
    from verify.scene.run import RunResult

DATA, PAGE = "run.json", "index.html"
KEEP = 5
"""Saved runs of one name."""
_TIME = re.compile(r"\d{4}-\d{2}-\d{2}_\d{2}-\d{2}-\d{2}-\d{6}")


class Saved(NamedTuple):
    """Where a run is."""

    page: Path
    """The latest page of that name."""
    folder: Path | None
    """The saved run; None where none is kept."""


def report_name(scene: str, overrides: Sequence[str] = ()) -> str:
    """Name of a report: the scene's, with the overrides that other reports of the scene do not have."""
    changes = "_".join(re.sub(r"[^A-Za-z0-9.=+-]+", "-", text).strip("-") for text in overrides)
    return f"{scene}_{changes}"[:120] if changes else scene


def save_run(run: "RunResult", reports: Path, name: str, command: str = "", keep: int = KEEP) -> Saved:
    """Write page and data of a run and delete all but the `keep` newest saved runs of that name.

    Every file is whole or absent. With keep = 0 the latest page is the only file. Raises InputError where it cannot
    be written, or where a file has the name of the folder.
    """
    from verify.report.page import run_page
    from verify.report.result import to_json

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
    found = [one.parent for one in home.glob(f"*/{DATA}") if _TIME.fullmatch(one.parent.name)]
    return sorted(one for one in found if not one.is_symlink())


def read_runs(path: Path, field: str) -> dict[str, dict[str, Any]]:
    """Data of saved runs by report name: of a file, a run's folder, the newest of a report, or of all reports.

    Raises InputError where there is none.
    """
    if not exists(path, field):
        raise InputError(f"{field} = {str(path)!r} does not exist: give a {DATA}, or a folder of saved runs")
    if path.is_file():
        files = [path]
    elif (path / DATA).is_file():
        files = [path / DATA]
    else:
        homes = [path] if saved_in(path) else sorted(one for one in path.iterdir() if one.is_dir())
        files = [saved_in(home)[-1] / DATA for home in homes if saved_in(home)]
    runs = [_read(file, field) for file in files]
    if not runs:
        raise InputError(f"{field} = {str(path)!r} has no saved run: give a {DATA}, or a folder of saved runs")
    return {run["report"]: run for run in runs}


def _read(path: Path, field: str) -> dict[str, Any]:
    try:
        run = json.loads(path.read_text("utf-8"))
        run["report"], run["verdict"]["level"], run["gates"], run["inputs"], run["environment"]
    except (OSError, ValueError, TypeError, KeyError):
        raise InputError(f"{field} = {str(path)!r} is no saved run: give the {DATA} that `verify run` writes") from None
    return dict(run)
