"""Natural frequencies and mode shapes from text files, or frequencies from a model in Python."""

import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from importlib import import_module
from math import isfinite, pi
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.files import exists
from verify.linear.base import BeamModel
from verify.problem.beam import Beam

HERTZ = {"Hz": 1.0, "kHz": 1e3, "rad/s": 0.5 / pi}
"""Frequency units in Hz."""
MOST, MODEL_MODES = 2000, 10
"""Largest number of frequencies of a list; default number of modes of a Python model."""
_UNITS = {"rad/s": r"rad|omega|ω|puls", "kHz": r"khz", "Hz": r"hz|hertz|freq|^f(_?\w{0,2})?$|cycles"}
_MODE = re.compile(r"#|n|no\.?|nr\.?|modes?([ _]?(number|no\.?|nr\.?))?|number|index|i|k", re.IGNORECASE)
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][+-]?\d+)?|[+-]?(nan|inf)", re.IGNORECASE)


class FrequencyList(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Natural frequencies, (n,), relative rounding (half a unit of the last digit), and mode numbers from 1."""

    source: str
    hertz: Array
    rounding: Array
    numbers: tuple[int, ...] | None = None
    unit: str = "Hz"


class ModeShapes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Mode shapes, (n_modes, n_points), at ascending x (n_points,), m."""

    x: Array
    values: Array


def listed(source: str, values: Sequence[float], cells: Sequence[str] = (), **more: Any) -> FrequencyList:
    """A list of values in `unit`, with text `cells`. Raises InputError for negative, infinite and too many values."""
    if not 0 < len(values) <= MOST:
        raise InputError(f"{source} has {len(values)} frequencies: give 1 to {MOST}")
    for i, value in enumerate(values, start=1):
        if not isfinite(value) or value < 0.0:
            raise InputError(f"{source}, entry {i} is {value!r}: give frequencies as finite numbers from 0")
    rounding = [_rounding(cell, value) for cell, value in zip(cells or map(repr, values), values, strict=True)]
    hertz = np.array(values) * HERTZ[more.get("unit", "Hz")]
    return FrequencyList(source=source, hertz=hertz, rounding=np.array(rounding), **more)


def read_frequencies(path: Path, unit: str | None = None) -> FrequencyList:
    """Frequencies from a text file, or '-' for standard input; unit None: that of the header. Raises InputError.

    One column, two columns with mode numbers first, or several with a header that names the frequencies, separated by
    comma, semicolon, tab or spaces; decimal commas in files without points.
    """
    source = f"frequencies file {str(path)!r}"
    head, rows = _rows(path, source)
    table = np.array([[_float(cell, source, i) for cell in row] for i, row in enumerate(rows, start=1)])
    numbered = next((k for k, name in enumerate(head) if _MODE.fullmatch(name)), None)
    if not head and table.shape[1] == 2 and not (table[:, 0] % 1.0).any() and (np.diff(table[:, 0]) > 0.0).all():
        numbered = 0
    units = {k: next((u for u, pattern in _UNITS.items() if re.search(pattern, name, re.IGNORECASE)), None)
             for k, name in enumerate(head) if k != numbered}  # fmt: skip
    columns = [k for k, matches in units.items() if matches] or [k for k in range(table.shape[1]) if k != numbered]
    if len(columns) != 1:
        raise InputError(f"{source} has {len(columns)} columns that may be frequencies: name one of them 'hz'")
    column, numbers = columns[0], None
    if numbered is not None:
        order = table[:, numbered]
        if (order % 1.0).any() or not (np.diff(order) > 0.0).all() or not 0 <= order[0] <= order[-1] <= MOST:
            raise InputError(f"{source}: mode numbers {order[:5].tolist()} do not count upwards: number them from 1")
        numbers = tuple(int(number) + (order[0] == 0) for number in order)
    cells = [row[column] for row in rows]
    return listed(source, table[:, column].tolist(), cells, unit=unit or units.get(column) or "Hz", numbers=numbers)


def read_shapes(path: Path, length: float) -> ModeShapes:
    """Mode shapes in a text file: x in metres, then one column for each mode. Raises InputError."""
    source = f"modes file {str(path)!r}"
    rows = _rows(path, source)[1]
    table = np.array([[_float(cell, source, i) for cell in row] for i, row in enumerate(rows, start=1)])
    return checked_shapes(ModeShapes(x=table[:, 0], values=table[:, 1:].T), length, source)


def checked_shapes(shapes: ModeShapes, length: float, source: str) -> ModeShapes:
    """The shapes. Raises InputError for positions off the beam, out of order or too few, and for zero shapes."""
    x, off = shapes.x, 1e-9 * length
    if len(x) < 3 or not len(shapes.values):
        raise InputError(f"{source} has {len(x)} positions, {len(shapes.values)} shapes: give three positions or more")
    if not (np.diff(x) > 0.0).all() or x[0] < -off or x[-1] > length + off:
        raise InputError(f"{source}: x from {x[0]:g} to {x[-1]:g} m: give ascending x from 0 to {length!r} m")
    if not np.isfinite(shapes.values).all() or not shapes.values.any(axis=1).all():
        raise InputError(f"{source} has shapes that are zero or not finite: leave these modes out")
    return shapes


def solve_model(name: str, beam: Beam, count: int | None, n_modes: int | None) -> FrequencyList:
    """Frequencies of a Python model 'package.module:function' of (beam, n_modes, count). Raises InputError.

    The function returns Hz, or an object with `frequencies_hz`; a subclass of `BeamModel` is built first.
    """
    module, _, attribute = name.partition(":")
    sys.path.insert(0, str(Path.cwd()))
    try:
        with redirect_stdout(sys.stderr):
            model = getattr(import_module(module), attribute)
            if isinstance(model, type) and issubclass(model, BeamModel):
                solved: Any = model.build(beam, count).modes(n_modes or MODEL_MODES)
            else:
                solved = model(beam, n_modes or MODEL_MODES, count)
            values = np.asarray(getattr(solved, "frequencies_hz", solved), dtype=float)
    except InputError:
        raise
    except (Exception, SystemExit) as error:  # user code may raise any error
        why = f"{type(error).__name__}: {error}"
        raise InputError(f"model = {name!r} fails with {why}: correct model or name") from None
    finally:
        sys.path.remove(str(Path.cwd()))
    return listed(f"model {name}", values.ravel().tolist())


def _rows(path: Path, source: str) -> tuple[list[str], list[list[str]]]:
    """(header or empty, rows of cells). Raises InputError for a missing file, no text, and unequal rows."""
    try:
        if str(path) != "-" and not exists(path, "file"):
            raise InputError(f"{source} does not exist: give a text file")
        text = (sys.stdin.buffer.read() if str(path) == "-" else path.read_bytes()).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{source} cannot be read ({error}): give a text file in UTF-8") from None
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    comments = [line.lstrip("#%! ") for line in lines if line[0] in "#%!"]
    rows, head = _cells([line for line in lines if line[0] not in "#%!"]), _cells(comments[-1:])
    if rows and not any(_NUMBER.fullmatch(cell) for cell in rows[0]):
        head, rows = rows[:1], rows[1:]
    if not rows or min(map(len, rows)) != max(map(len, rows)):
        raise InputError(f"{source} has {len(rows)} rows of numbers: give one or more, all of the same length")
    words, width = (head[0] if head else []), len(rows[0])
    if len(words) != width:  # a header of words between spaces
        words = ["mode", " ".join(words)][-width:] if words and width <= 2 else []
    return words, rows


def _cells(lines: list[str]) -> list[list[str]]:
    """Cells of every line; decimal commas become points."""
    text = "\n".join(lines)
    before = [line.split(",")[0] for line in lines if _NUMBER.fullmatch(line)]
    decimal = "." not in text and len(before) == len(lines) and before != [str(i + 1) for i in range(len(before))]
    between = next((d for d in ";\t" if d in text), None if decimal or "," not in text else ",")
    rows = [[cell.strip().strip('"') for cell in line.split(between)] for line in lines]
    return [[cell.replace(",", ".") if _NUMBER.fullmatch(cell) else cell for cell in row] for row in rows]


def _float(cell: str, source: str, row: int) -> float:
    """A number in Fortran's or C's notation. Raises InputError."""
    try:
        return float(re.sub("[dD]", "e", cell))
    except ValueError:
        raise InputError(f"{source}, row {row}: {shown(cell)} is not a number: correct it or leave it out") from None


def _rounding(cell: str, value: float) -> float:
    """Half a unit of the last digit, relative."""
    mantissa, _, exponent = re.sub("[dDE]", "e", cell).partition("e")
    digits = len(mantissa.partition(".")[2])
    return max(0.5 * 10.0 ** (int(exponent or 0) - digits) / value, 1e-16) if value else 0.0
