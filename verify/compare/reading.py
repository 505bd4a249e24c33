"""Natural frequencies from text files, output of solvers or a model in Python; mode shapes from text files."""

import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from importlib import import_module
from itertools import takewhile
from math import isfinite, pi
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.files import read_text
from verify.io.mode_files import UNIVERSAL, read_response
from verify.linear.base import BeamModel
from verify.problem.beam import Beam

UNITS: dict[str, tuple[float, int | float]] = {
    "Hz": (1.0, 1),
    "kHz": (1e3, 1),
    "mHz": (1e-3, 1),
    "rad/s": (0.5 / pi, 1),
    "1/min": (1.0 / 60.0, 1),
    "Hz/(2 pi)": (2.0 * pi, 1),
    "rad2/s2": (0.5 / pi, 0.5),
    "s": (1.0, -1),
    "ms": (1e3, -1),
}
"""Units of a list: frequency in Hz = factor * value**power. rad2/s2: squares of omega; s, ms: periods."""
MOST, MODEL_MODES = 2000, 10
"""Largest number of frequencies of a list; default number of modes of a Python model."""
_HEADS = {
    "rad2/s2": r"eigenval|lambda|λ|(omega|ω|w)(\^|\*\*)?[2²]|rad\S*2/s",
    "rad/s": r"rad|omega|ω|puls|^w\d*$",
    "ms": r"period.*\bms\b",
    "s": r"period|^t(_?\w{0,2})?$|^s$",
    "1/min": r"1/min|rpm|cpm",
    "kHz": r"khz",
    "mHz": r"mHz",
    "Hz": r"hz|hertz|freq|^f(_?\w{0,2})?$|cycles",
}
_MODE = re.compile(r"#|n|no\.?|nr\.?|modes?([ _]?(number|no\.?|nr\.?))?|number|index|i|k", re.IGNORECASE)
_DIGITS = r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD][+-]?\d+)?"
_NUMBER = re.compile(rf"{_DIGITS}|[+-]?(nan|inf)", re.IGNORECASE)
_VALUE = re.compile(rf"(?:[^\W\d]\w*\s*[=:]\s*)?({_DIGITS})\s*([a-zA-Z/]+[\w/^²]*)?")
"""A number, perhaps with a name and a unit: 'f1=15.7', '15.7Hz'."""


class FrequencyList(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Values of natural frequencies in a unit of UNITS, (n,), relative last digit, (n,), and mode numbers from 1.

    `declared`: whether the unit is that of an option or header.
    """

    source: str
    values: Array
    digits: Array
    numbers: tuple[int, ...] | None = None
    unit: str = "Hz"
    declared: bool = False

    @property
    def hertz(self) -> Array:
        """Frequencies, (n,), Hz."""
        factor, power = UNITS[self.unit]
        with np.errstate(divide="ignore"):
            return factor * self.values**power

    @property
    def rounding(self) -> Array:
        """Relative last digit of the frequencies, (n,)."""
        return abs(UNITS[self.unit][1]) * self.digits


class ModeShapes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Mode shapes, (n_modes, n_points), at ascending x (n_points,), m."""

    x: Array
    values: Array


def listed(source: str, values: Sequence[float], cells: Sequence[str] = (), **more: Any) -> FrequencyList:
    """A list of values in `unit`, with text `cells`. Raises InputError for negative, infinite and too many values."""
    if not 0 < len(values) <= MOST:
        raise InputError(f"{source} has {len(values)} frequencies: give 1 to {MOST}")
    array = np.array(values, dtype=float)
    if UNITS[more.get("unit", "Hz")][1] > 0:  # rigid motions may have small negative values
        array = np.where(abs(array) < 1e-6 * abs(array).max(), abs(array), array)
    for i, value in enumerate(array.tolist(), start=1):
        if not isfinite(value) or value < 0.0 or (value == 0.0 and more.get("unit") in ("s", "ms")):
            raise InputError(f"{source}, entry {i} is {value!r}: give frequencies as finite numbers from 0")
    cells = cells or [*map(repr, values)]
    significant = [len(re.sub(r"[eEdD].*|\D", "", cell).lstrip("0")) for cell in cells]
    most = max((n for n, cell in zip(significant, cells, strict=True) if "." in cell), default=max(significant))
    digits = [_last_digit(cell, value, most) for cell, value in zip(cells, values, strict=True)]
    return FrequencyList(source=source, values=array, digits=np.array(digits), **more)


def read_words(words: Sequence[str], unit: str | None = None) -> FrequencyList | None:
    """The list of typed words such as '15.7', 'f1=15.7', '15.7Hz' or '15.7,98.4'; None if they are no numbers.

    Raises InputError for units that differ, and for one word that may be a decimal comma or two values.
    """
    words = [word.rstrip(",;") for word in words if word.strip(",;")]
    cells = [word.replace(",", ".") if re.fullmatch(_DIGITS, word) else word for word in words]
    if len(words) == 1 and re.fullmatch(r"\d+,\d+", words[0]):
        raise InputError(f"frequencies = {words[0]}: a decimal comma or two values, write a point or a space")
    if not all(_VALUE.fullmatch(cell) for cell in cells):
        cells = [cell for word in words for cell in re.split(r"[;\s]+", word.strip("[]()")) if cell]
        decimal = len(cells) > 1 and all(re.fullmatch(r"\d+,\d+", cell) for cell in cells)
        cells = [part for cell in cells for part in ([cell.replace(",", ".")] if decimal else cell.split(",")) if part]
    matches = [_VALUE.fullmatch(cell) for cell in cells]
    if not cells or not all(matches):
        return None
    units = {match[2] for match in matches if match and match[2]}
    written = next((name for name in UNITS if {u.lower() for u in units} == {name.lower()}), None)
    if units and written is None:
        text = f"{shown(' '.join(words))}: units {', '.join(sorted(units))}"
        raise InputError(f"frequencies = {text}, give one of --unit")
    numbers, chosen = [match[1] for match in matches if match], unit or written
    values = _numbers(numbers, "frequencies")
    return listed("frequencies", values, numbers, unit=chosen or "Hz", declared=chosen is not None)


def read_frequencies(path: Path, unit: str | None = None) -> FrequencyList:
    """Frequencies from a text file, or '-' for standard input; unit None: that of the header. Raises InputError.

    Output of a solver with columns omega^2, omega, omega / 2 pi; else values in one column, one row or a Python list;
    two columns with mode numbers first; or several with a header that names the frequencies. Comma, semicolon, tab or
    spaces separate; decimal commas in files without points.
    """
    source = f"frequencies file {str(path)!r}"
    text = read_text(path, "file")
    if cells := solver_cells(text):
        return listed(source, _numbers(cells, source), cells, declared=True)
    lines = [line.strip() for line in text.splitlines() if line.strip() and line.strip()[0] not in "#%!"]
    if brackets := re.match(r"\s*(?:\w+\s*=\s*)?(?:(?:np\.)?array\()?[\[(](.*)[\])]", text, re.DOTALL):
        lines = re.sub(r"np\.float64\(|[()\[\]]", " ", brackets[1]).replace(",", " ").split()
    elif len(lines) == 1 and len(row := lines[0].replace(";", " ").split()) > 2:
        lines, brackets = row, re.match("", "")
    named = all(map(_VALUE.fullmatch, lines)) and not all(map(_NUMBER.fullmatch, lines))
    if (brackets or named) and (read := read_words(lines, unit)):
        return msgspec.structs.replace(read, source=source)
    head, rows = _rows(text, source)
    table = np.array([_numbers(row, source, i) for i, row in enumerate(rows, start=1)])
    numbered = next((k for k, name in enumerate(head) if _MODE.fullmatch(name)), None)
    if not head and table.shape[1] == 2 and not (table[:, 0] % 1.0).any() and (np.diff(table[:, 0]) > 0.0).all():
        numbered = 0
    units = {
        k: next((u for u, pattern in _HEADS.items() if re.search(pattern, name, 0 if u == "mHz" else re.I)), None)
        for k, name in enumerate(head)
        if k != numbered
    }
    columns = [k for k, matches in units.items() if matches] or [k for k in range(table.shape[1]) if k != numbered]
    best = [k for k in columns if units.get(k) == "Hz"]
    columns = best[:1] if len(columns) > 1 and len(best) == 1 else columns
    if len(columns) != 1:
        raise InputError(
            f"{source} has {len(columns)} columns that may be frequencies: name one 'hz', or the times of a record 't'"
        )
    column, numbers = columns[0], None
    chosen = unit or units.get(column)
    if numbered is not None:
        order = table[:, numbered]
        if (order % 1.0).any() or not (np.diff(order) > 0.0).all() or not 0 <= order[0] <= order[-1] <= MOST:
            raise InputError(f"{source}: mode numbers {order[:5].tolist()} do not count upwards: number them from 1")
        numbers = tuple(int(number) + (order[0] == 0) for number in order)
    more = {"unit": chosen or "Hz", "declared": chosen is not None, "numbers": numbers}
    return listed(source, table[:, column].tolist(), [row[column] for row in rows], **more)


def solver_cells(text: str) -> list[str]:
    """Frequencies in Hz as text from a solver's table: a mode number, then among others omega^2, omega, omega / 2 pi.

    So do CalculiX (.dat), Nastran (.f06) and Abaqus (.dat) print them. The first table, empty without one.
    """
    runs: list[list[str]] = [[]]
    for line in text.splitlines():
        words = list(takewhile(_NUMBER.fullmatch, line.split()))
        values = [abs(value) for value in _numbers(words, "")]
        for k in range(1, min(len(values) - 2, 4)):
            square, omega, hertz = values[k : k + 3]
            fits = abs(square - omega**2) <= 1e-3 * square and abs(omega - 2.0 * pi * hertz) <= 1e-3 * omega
            if fits or omega == hertz == 0.0:  # zeros of rigid motions, or of coordinates in a table of nodes
                if values[0] == 1.0:
                    runs.append([])
                if values[0] == len(runs[-1]) + 1:
                    runs[-1].append(words[k + 2].lstrip("-"))
                break
    return next((run for run in runs if any(_numbers(run, ""))), [])


def read_shapes(path: Path, length: float) -> ModeShapes:
    """Mode shapes in a text file: x in metres, then one column for each mode. Raises InputError."""
    source = f"modes file {str(path)!r}"
    table = _table(path, source)[1]
    return checked_shapes(ModeShapes(x=table[:, 0], values=table[:, 1:].T), length, source)


def read_series(path: Path) -> tuple[Array, Array, Array | None]:
    """(x, y, angle of y or None), each (n,), of a text file with columns x, y, or of a universal file's first response.

    Third columns: the phase, in degrees unless its header has 'rad', or with headers 're' and 'im' the imaginary part.
    Raises InputError.
    """
    source = f"file {str(path)!r}"
    if path.suffix.lower() in UNIVERSAL:
        x, response = read_response(path, source)
        return x, np.abs(response), np.angle(response)
    head, table = _table(path, source)
    if table.shape[1] not in (2, 3):
        raise InputError(f"{source} has {table.shape[1]} columns: give x, y and for a response its phase")
    if table.shape[1] == 2:
        return table[:, 0], table[:, 1], None
    if head and re.match(r"\W*re", head[1], re.I) and re.match(r"\W*im", head[2], re.I):
        response = table[:, 1] + 1j * table[:, 2]
        return table[:, 0], np.abs(response), np.angle(response)
    return table[:, 0], table[:, 1], table[:, 2] if head and "rad" in head[2].lower() else np.deg2rad(table[:, 2])


def _table(path: Path, source: str) -> tuple[list[str], Array]:
    """(header or empty, numbers (n, k)) of a text file. Raises InputError."""
    return read_table(read_text(path, "file"), source)


def read_table(text: str, source: str) -> tuple[list[str], Array]:
    """(header or empty, numbers (n, k)) of a text. Raises InputError."""
    head, rows = _rows(text, source)
    return head, np.array([_numbers(row, source, i) for i, row in enumerate(rows, start=1)])


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


def _rows(text: str, source: str) -> tuple[list[str], list[list[str]]]:
    """(header or empty, rows of cells). Raises InputError for no rows and for unequal ones."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    comments = [line.lstrip("#%! ") for line in lines if line[0] in "#%!"]
    rows, head = _cells([line for line in lines if line[0] not in "#%!"]), _cells(comments[-1:])
    if rows and not any(_NUMBER.fullmatch(cell) for cell in rows[0]):
        head, rows = rows[:1], rows[1:]
    if not rows:
        raise InputError(f"{source} has 0 rows of numbers: give one or more")
    width = max(widths := [len(row) for row in rows], key=widths.count)
    for i, row in enumerate(rows, start=1):
        if len(row) != width:
            text = shown(" ".join(row))
            raise InputError(f"{source}, row {i} has other columns than most of the rows, cut it: {text}")
    words = head[0] if head else []
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


def _numbers(cells: Sequence[str], source: str, row: int | None = None) -> list[float]:
    """Numbers in Fortran's or C's notation, one for each row from 1, or all of `row`. Raises InputError."""
    for i, cell in enumerate(cells, start=1):
        if not _NUMBER.fullmatch(cell):
            text = f"row {row or i}: {shown(cell)} is not a number"
            raise InputError(f"{source}, {text}: correct it or leave it out")
    return [float(re.sub("[dD]", "e", cell.replace(",", "."))) for cell in cells]


def _last_digit(cell: str, value: float, most: int) -> float:
    """A unit of the last digit, relative; zeros that end an integer count up to the `most` digits of other cells."""
    mantissa, _, exponent = re.sub("[dDE]", "e", cell).partition("e")
    digits = len(mantissa.partition(".")[2])
    if "." not in mantissa:
        digits = -min(len(mantissa) - len(mantissa.rstrip("0")), max(len(mantissa) - most, 0))
    return max(float(f"1e{int(exponent or 0) - digits}") / abs(value), 1e-16) if value else 0.0
