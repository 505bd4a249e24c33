"""Natural frequencies and mode shapes from text files of other programs or from a model in Python."""

import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from importlib import import_module
from itertools import pairwise
from math import isfinite, pi
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError, shown
from verify.files import exists
from verify.models.arrays import Array

HERTZ = {"Hz": 1.0, "kHz": 1e3, "rad/s": 0.5 / pi}
"""In one of a unit."""
MOST = 2000
"""Frequencies in a list."""
_UNITS = {"rad/s": r"rad|omega|ω|puls", "kHz": r"khz", "Hz": r"hz|hertz|freq|^f(_?\w{0,2})?$|cycles"}
_NUMBERED = r"#|n|no\.?|nr\.?|modes?([ _]?(number|no\.?|nr\.?))?|number|index|i|k"
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][+-]?\d+)?|[+-]?(nan|inf)", re.IGNORECASE)
MODEL_MODES, MODEL_POINTS = 10, 201
"""Modes and places at which a Python model is solved."""


class FrequencyList(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Natural frequencies as given."""

    source: str
    hertz: Array
    """(n,)."""
    rounding: Array
    """(n,): half a unit of the last digit, relative."""
    numbers: tuple[int, ...] | None = None
    """Mode numbers from 1, where the list has them."""
    unit: str = "Hz"


class ModeShapes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Mode shapes as given."""

    x: Array
    """(n_points,), metres, ascending."""
    values: Array
    """(n_modes, n_points)."""


def listed(source: str, values: Sequence[float], cells: Sequence[str] = (), **more: Any) -> FrequencyList:
    """Check frequencies in `unit` and convert them. Raises InputError for negative, too many and infinite ones."""
    if not values or len(values) > MOST:
        raise InputError(f"{source} has {len(values)} frequencies: give 1 to {MOST}")
    for i, value in enumerate(values, start=1):
        if not isfinite(value) or value < 0.0:
            raise InputError(f"{source}, entry {i} is {value!r}: give frequencies as finite numbers from 0")
    rounding = [_rounding(cell, value) for cell, value in zip(cells or map(repr, values), values, strict=True)]
    hertz = np.array(values) * HERTZ[more.get("unit", "Hz")]
    return FrequencyList(source=source, hertz=hertz, rounding=np.array(rounding), **more)


def read_frequencies(path: Path, unit: str | None = None) -> FrequencyList:
    """Frequencies in a text file or, as '-', on standard input, in a unit that else the header says. Raises InputError.

    One column, or two with mode numbers first, or more with a header that names frequencies. Comma, semicolon, tab or
    spaces between them; decimal commas where no point is.
    """
    source = f"frequencies file {str(path)!r}"
    head, rows = _rows(path, source)
    width = len(rows[0])
    named = [k for k, name in enumerate(head) if not _is_mode(name) and any(map(_finds(name), _UNITS.values()))]
    numbered = next((k for k, name in enumerate(head) if _is_mode(name)), None)
    first = [row[0] for row in rows]
    if not head and width == 2 and all(cell.isdigit() for cell in first) and _rises([int(cell) for cell in first]):
        numbered = 0
    others = [k for k in range(width) if k != numbered]
    columns = named or others
    if len(columns) != 1:
        raise InputError(f"{source} has {width} columns, {len(columns)} of which may be frequencies: name one 'hz'")
    column = columns[0]
    found = next((u for u, pattern in _UNITS.items() if head and _finds(head[column])(pattern)), "Hz")
    cells = [row[column] for row in rows]
    values = [_float(cell, source, i) for i, cell in enumerate(cells, start=1)]
    numbers = None if numbered is None else [_float(row[numbered], source, i) for i, row in enumerate(rows, start=1)]
    if numbers and (not _rises(numbers) or any(n % 1.0 or not 0 <= n <= MOST for n in numbers)):
        raise InputError(f"{source}: mode numbers {numbers[:6]} do not count upwards: number the modes from 1")
    counted = None if numbers is None else tuple(int(n) + (numbers[0] == 0) for n in numbers)
    return listed(source, values, cells, unit=unit or found, numbers=counted)


def read_shapes(path: Path, length: float) -> ModeShapes:
    """Mode shapes in a text file: x in metres, then one column for each mode. Raises InputError."""
    source = f"modes file {str(path)!r}"
    _, rows = _rows(path, source)
    table = np.array([[_float(cell, source, i) for cell in row] for i, row in enumerate(rows, start=1)])
    return checked_shapes(ModeShapes(x=table[:, 0], values=table[:, 1:].T), length, source)


def checked_shapes(shapes: ModeShapes, length: float, source: str) -> ModeShapes:
    """The shapes. Raises InputError for places off the beam, out of order or too few, and for shapes of zeros."""
    x, off = shapes.x, 1e-9 * length
    if len(x) < 3 or not len(shapes.values):
        raise InputError(f"{source} has {len(x)} places and {len(shapes.values)} shapes: give three places or more")
    if not (np.diff(x) > 0.0).all() or x[0] < -off or x[-1] > length + off:
        raise InputError(f"{source}: x from {x[0]:g} to {x[-1]:g} m: give rising places between 0 and {length!r} m")
    if not np.isfinite(shapes.values).all() or not shapes.values.any(axis=1).all():
        raise InputError(f"{source} has shapes that are zero or not finite: leave these modes out")
    return shapes


def solve_model(name: str, beam: Beam, count: int | None, n_modes: int | None) -> tuple[FrequencyList, ModeShapes | None]:
    """Frequencies, and shapes if any, of a Python model 'package.module:function'. Raises InputError.

    The function, or the `solve_modes` of a class or object, takes (beam, n_modes, count) and returns frequencies in Hz,
    or an object with `frequencies_hz` and optionally `deflection(x)`, (n_modes, len(x)).
    """
    source, (module, _, attribute) = f"model = {name!r}", name.partition(":")
    sys.path.insert(0, str(Path.cwd()))
    try:
        with redirect_stdout(sys.stderr):
            model = getattr(import_module(module), attribute)
            model = model() if isinstance(model, type) else model
            solved = getattr(model, "solve_modes", model)(beam, n_modes or MODEL_MODES, count)
            values = np.asarray(getattr(solved, "frequencies_hz", solved), dtype=float)
            x = np.linspace(0.0, beam.length, MODEL_POINTS)
            deflection = np.asarray(solved.deflection(x), dtype=float) if hasattr(solved, "deflection") else None
    except InputError:
        raise
    except (Exception, SystemExit) as error:  # a stranger's code fails in any way
        raise InputError(f"{source} fails with {type(error).__name__}: {error}: correct the model or its name") from None
    finally:
        sys.path.remove(str(Path.cwd()))
    if values.ndim != 1 or (deflection is not None and deflection.shape != (len(values), MODEL_POINTS)):
        raise InputError(f"{source} returns arrays of wrong shape: return (n_modes,) frequencies, (n_modes, len(x)) shapes")
    shapes = None if deflection is None else ModeShapes(x=x, values=deflection)
    return listed(source, values.tolist()), shapes and checked_shapes(shapes, beam.length, source)


def _rows(path: Path, source: str) -> tuple[list[str], list[list[str]]]:
    """(header or nothing, rows of cells). Raises InputError for no file, no text, and rows of unequal length."""
    try:
        data = sys.stdin.buffer.read() if str(path) == "-" else path.read_bytes() if exists(path, "file") else None
        text = None if data is None else data.decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{source} cannot be read ({error}): give a text file in UTF-8") from None
    if text is None:
        raise InputError(f"{source} does not exist: give a text file")
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    comments = [line.lstrip("#%! ") for line in lines if line[0] in "#%!"]
    lines = [line for line in lines if line[0] not in "#%!"]
    rows = _cells(lines)
    head: list[str] = []
    if rows and not any(_NUMBER.fullmatch(cell) for cell in rows[0]):
        head, rows = rows[0], rows[1:]
    elif comments:
        head = _cells(comments[-1:])[0]
    if not rows:
        raise InputError(f"{source} has no numbers: give one on each line")
    for i, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise InputError(f"{source}, row {i} has {len(row)} cells, the first {len(rows[0])}: give equal rows")
    if len(head) != len(rows[0]):  # words between spaces
        head = ["mode", " ".join(head)][-len(rows[0]) :] if head and len(rows[0]) <= 2 else []
    return head, rows


def _cells(lines: list[str]) -> list[list[str]]:
    """Cells of every line; decimal commas become points."""
    text = "\n".join(lines)
    before = [line.split(",")[0] for line in lines if _NUMBER.fullmatch(line)]
    decimal = "." not in text and len(before) == len(lines) and before != [str(i + 1) for i in range(len(before))]
    between = next((d for d in ";\t" if d in text), None if decimal or "," not in text else ",")
    rows = [[cell.strip().strip('"') for cell in line.split(between)] for line in lines]
    if between == ",":
        return rows
    return [[cell.replace(",", ".") if _NUMBER.fullmatch(cell) else cell for cell in row] for row in rows]


def _is_mode(name: str) -> bool:
    return bool(re.fullmatch(_NUMBERED, name, re.IGNORECASE))


def _finds(name: str) -> Any:
    return lambda pattern: re.search(pattern, name, re.IGNORECASE)


def _rises(numbers: Sequence[float]) -> bool:
    return all(b > a for a, b in pairwise(numbers)) and numbers[0] <= MOST


def _float(cell: str, source: str, row: int) -> float:
    """A number in Fortran's or C's notation. Raises InputError."""
    try:
        return float(re.sub("[dD]", "e", cell))
    except ValueError:
        raise InputError(f"{source}, row {row}: {shown(cell)} is not a number: correct it or leave it out") from None


def _rounding(cell: str, value: float) -> float:
    """Half a unit of the last digit as written, relative."""
    mantissa, _, exponent = cell.lower().replace("d", "e").partition("e")
    digits = len(mantissa.partition(".")[2])
    return max(0.5 * 10.0 ** (int(exponent or 0) - digits) / value, 1e-16) if value else 0.0
