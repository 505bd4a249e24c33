"""Sheets as csv, json and npz: for a spreadsheet, for any language, for numpy."""

import csv
import json
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from verify.exports.sheet import Sheet
from verify.files import whole, write_whole
from verify.models.arrays import Array


def write_csv(sheet: Sheet, path: Path) -> None:
    """A row for each point, of a motion for each instant; the unit stands in the head. Raises InputError."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    head, rows = _motion_rows(sheet) if sheet.what == "motion" else _point_rows(sheet)
    writer.writerow(head)
    writer.writerows([repr(float(value)) for value in row] for row in rows)
    write_whole(path, text.getvalue(), "to")


def _point_rows(sheet: Sheet) -> tuple[list[str], Array]:
    """Deflections across the beam alone: the other two components are zero."""
    if sheet.what == "modes":
        named = zip(sheet.at_points, sheet.beside["frequency_hz"], strict=True)
        head = [f"{name} at {float(hertz)!r} Hz" for name, hertz in named]
    else:
        head = list(sheet.at_points)
    columns = [values[:, 1] if values.ndim == 2 else values for values in sheet.at_points.values()]
    return ["x_m", *head], np.column_stack([sheet.x, *columns])


def _motion_rows(sheet: Sheet) -> tuple[list[str], Array]:
    head = [sheet.step_name, *sheet.histories, *(f"deflection at {float(x)!r} m" for x in sheet.x)]
    return head, np.column_stack([sheet.steps, *sheet.histories.values(), sheet.stepped["deflection"][:, :, 1]])


def write_json(sheet: Sheet, path: Path) -> None:
    """Everything, each array under its name. Raises InputError."""
    named = dict(_arrays(sheet))
    data: dict[str, Any] = {"what": sheet.what, "told": sheet.told}
    data |= {name: values.tolist() for name, values in named.items()}
    write_whole(path, json.dumps(data, allow_nan=False) + "\n", "to")


def write_npz(sheet: Sheet, path: Path) -> None:
    """Everything, each array under its name, for `numpy.load`. Raises InputError."""
    with whole(path, "to") as part, part.open("wb") as stream:
        np.savez_compressed(stream, **dict(_arrays(sheet)), told=np.array(sheet.told))  # type: ignore[arg-type]


def _arrays(sheet: Sheet) -> Iterator[tuple[str, Array]]:
    """Points and lines, then whatever there is; of modes no second copy as a series."""
    yield "points", sheet.points
    yield "lines", np.asarray(sheet.lines)
    yield from sheet.cells.items()
    yield from sheet.at_points.items()
    if sheet.what == "modes":
        yield from sheet.beside.items()
        return
    yield "drive_frequency_hz", sheet.beside["frequency_hz"]
    yield sheet.step_name, sheet.steps
    yield from sheet.stepped.items()
    yield from sheet.histories.items()
