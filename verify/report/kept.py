"""Runs that are kept: a folder for each, its page beside its document and figures as JSON; the latest page above them.

    reports/paper.html                            the latest page, a copy
    reports/paper/2026-03-01_14-05-09/index.html  a page that is kept
    reports/paper/2026-03-01_14-05-09/run.json    what it says, and what `verify run --json` printed

The latest is a copy because a page is one whole file: it can be sent, served and unpacked anywhere, where a link would
point to nothing, and Windows makes links for administrators alone.
"""

import json
import re
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify import __version__
from verify.errors import InputError, shortened
from verify.files import delete_folder, exists, write_folder, write_whole
from verify.report.document import Document, document_of
from verify.report.plain import finite, run_as_plain

if TYPE_CHECKING:
    from verify.run.runner import RunResult

FILE, PAGE = "run.json", "index.html"
LAYOUT = 1
"""Of the file; another number where what is kept can no longer be read."""
KEPT = 5
"""Runs of one name that are kept, unless told."""
_WORDS = ("inf", "-inf", "nan")
"""Of figures that are not finite, as Python writes and reads them."""
_TIME = re.compile(r"(\d{4}-\d{2}-\d{2}_\d{2}-\d{2}-\d{2})(?:-(\d+))?")


class Kept(msgspec.Struct, frozen=True, kw_only=True):
    """What `run.json` holds."""

    layout: int
    verify: str
    """The version that wrote it."""
    report: str
    """The name of its page: the scene's, and what `--set` changed."""
    document: Document
    figures: msgspec.Raw
    """What `verify run --json` prints."""


class Written(msgspec.Struct, frozen=True):
    """Where a run lies."""

    latest: Path
    folder: Path | None
    """Where it is kept; None where it is not."""


def folder_for(reports: Path, name: str) -> Path:
    """The folder of the runs of one name. Raises InputError where something else has that name."""
    home = reports / name
    if exists(home, "reports") and not home.is_dir():
        raise InputError(f"reports = {str(home)!r} is no folder, and runs are kept there: move it, or give --keep 0")
    return home


def keep(result: "RunResult", reports: Path, name: str, command: str, most: int = KEPT, *, at_once: int = 1) -> Written:
    """Write the page of a run and what it says, and take away what is older than the `most` newest runs of that name.

    `at_once` scenes ran side by side, which the page says where they were several, for their times are of that.

    The page in the folder stands before the latest one does, so that what is shown is always kept too; with `most` 0
    the latest stands alone. Raises InputError.
    """
    from verify.report.html import rendered

    document = document_of(result, command)
    if at_once > 1:
        beside = {"scenes at once": f"up to {at_once}: run times here are of a machine that did other things too"}
        document = msgspec.structs.replace(document, environment=document.environment | beside)
    page = rendered(document)
    latest, folder = reports / f"{name}.html", None
    home = folder_for(reports, name) if most else reports / name
    if most:
        text = as_text(document, name, run_as_plain(result, latest))
        stamp = datetime.now(UTC).strftime("%Y-%m-%d_%H-%M-%S")
        folder = write_folder(home / stamp, {PAGE: page, FILE: text}, "reports")
    write_whole(latest, page, "reports")
    for old in runs_in(home)[: -most or None]:
        delete_folder(old)
    return Written(latest, folder)


def as_text(document: Document, name: str, figures: dict[str, Any]) -> str:
    """The file of a run."""
    plain = json.dumps(finite(figures), allow_nan=False, separators=(",", ":"))
    document = _with_measured(document, _in_words)
    kept = Kept(layout=LAYOUT, verify=__version__, report=name, document=document, figures=msgspec.Raw(plain.encode()))
    return msgspec.json.encode(kept, enc_hook=float).decode() + "\n"  # numpy's numbers of a study from elsewhere


def _with_measured(document: Document, told: Callable[[Any], Any]) -> Document:
    """A document with what its gates measured told otherwise."""
    replace = msgspec.structs.replace
    return replace(document, gates=tuple(replace(gate, measured=told(gate.measured)) for gate in document.gates))


def _in_words(measured: Any) -> Any:
    """What is not finite as a word, for JSON has no number for it."""
    if isinstance(measured, dict):
        return {name: _in_words(value) for name, value in measured.items()}
    return str(float(measured)) if isinstance(measured, float) and not isfinite(measured) else measured


def _in_numbers(measured: Any) -> Any:
    """The same as it was."""
    if isinstance(measured, dict):
        return {name: _in_numbers(value) for name, value in measured.items()}
    return float(measured) if isinstance(measured, str) and measured in _WORDS else measured


def runs_in(home: Path) -> list[Path]:
    """Folders that hold a kept run and nothing else, from the oldest to the newest."""
    return [path for path in _all_runs_in(home) if _is_ours(path)]


def _all_runs_in(home: Path) -> list[Path]:
    """Folders that hold a kept run, whatever lies beside it, from the oldest to the newest."""
    found = [(when, path) for path in _folders(home) if (when := _when(path)) and (path / FILE).is_file()]
    return [path for _, path in sorted(found)]


def _when(path: Path) -> tuple[str, int] | None:
    """The time in a folder's name, and the number behind it."""
    match = _TIME.fullmatch(path.name)
    return (match[1], int(match[2] or 1)) if match else None


def _is_ours(path: Path) -> bool:
    names = {one.name for one in path.iterdir()}
    return FILE in names and names <= {FILE, PAGE}


def _folders(home: Path) -> Iterator[Path]:
    """Folders that are no links; none where there is nothing."""
    if home.is_dir():
        yield from (path for path in sorted(home.iterdir()) if path.is_dir() and not path.is_symlink())


def read_kept(path: Path, field: str) -> Kept:
    """The run that a file holds. Raises InputError for anything else, and for what another version wrote otherwise."""
    remedy = f"give the {FILE} of a run that is kept"
    try:
        exists(path, field)
        data = path.read_bytes()
        head = msgspec.json.decode(data, type=_Head)
    except OSError as error:
        raise InputError(f"{field} = {str(path)!r} cannot be read ({error.strerror or error}): {remedy}") from None
    except msgspec.DecodeError:
        raise InputError(f"{field} = {str(path)!r} is no run that was kept: {remedy}") from None
    try:
        if head.layout == LAYOUT:
            kept = msgspec.json.decode(data, type=Kept)
            return msgspec.structs.replace(kept, document=_with_measured(kept.document, _in_numbers))
        why = f"layout {head.layout} for {LAYOUT}"
    except msgspec.DecodeError as error:
        why = shortened(str(error), 120)
    told = f"was written by verify {head.verify}, and this is {__version__}, which lays runs out otherwise"
    if head.verify == __version__:
        told = f"is no run as verify {__version__} keeps it"
    raise InputError(f"{field} = {str(path)!r} {told} ({why}): run its scene again")


class _Head(msgspec.Struct, frozen=True):
    """What a file of any version has."""

    layout: int
    verify: str


def runs_at(path: Path, field: str) -> dict[str, Kept]:
    """Runs by their names: of a file, of the folder of one run, the newest of a name's folder, those of all reports.

    Raises InputError where there is none.
    """
    if not exists(path, field):
        raise InputError(f"{field} = {str(path)!r} is not there: give a {FILE}, or a folder of runs")
    if not path.is_dir():
        return _named(read_kept(path, field))
    if (path / FILE).is_file():
        return _named(read_kept(path / FILE, field))
    if own := _all_runs_in(path):
        return _named(read_kept(own[-1] / FILE, field))
    newest = [runs[-1] for home in _folders(path) if (runs := _all_runs_in(home))]
    if not newest:
        raise InputError(f"{field} = {str(path)!r} holds no run that was kept: give a {FILE}, or a folder of runs")
    found: dict[str, Kept] = {}
    for one in sorted(newest, key=lambda run: _when(run) or ("", 0)):  # of two folders of one name the newest is last
        found |= _named(read_kept(one / FILE, field))
    return dict(sorted(found.items()))


def _named(kept: Kept) -> dict[str, Kept]:
    return {kept.report: kept}
