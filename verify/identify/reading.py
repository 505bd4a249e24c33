"""Lists that others have written: natural frequencies and mode shapes, in any of the layouts that tables come in."""

import re
import sys
from itertools import pairwise
from math import isfinite, pi
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from verify.errors import InputError, shown
from verify.files import exists

if TYPE_CHECKING:
    from verify.models.arrays import Array

STANDARD_INPUT = Path("-")
"""A name for what is piped in, as other tools have it."""
MOST = 2000
"""Modes that a list may have."""
_PER_HERTZ = {"hz": 1.0, "khz": 1e3, "rad/s": 0.5 / pi}
"""Hertz in one of a unit."""
_UNITS = {
    "rad/s": re.compile(r"rad|omega|ω|\bpuls", re.IGNORECASE),
    "khz": re.compile(r"khz", re.IGNORECASE),
    "hz": re.compile(r"hz|hertz|freq|^f(_?\w{0,2})?$|cps|cycles", re.IGNORECASE),
}
_NUMBERED = re.compile(r"^(#|n|no\.?|nr\.?|mode|modes?[ _]?(number|no\.?|nr\.?)|number|index|i|k)$", re.IGNORECASE)
_SHORT, _LONG = "(?:std|sd|se|dev|err|unc|var)", "(?:sigma|deviation|error|uncertainty|variance)"
_SCATTER = re.compile(rf"(?:^|[^a-z]){_SHORT}(?:[^a-z]|$)|{_LONG}|[σ±]|\+/-", re.IGNORECASE)
"""Names of what is known of frequencies beside them."""
_SIZED = re.compile(
    rf"(?:±|\+/-|[(\[]\s*(?:{_SHORT}\.?|(?:standard )?{_LONG}|σ))\s*[=:<≤~]?\s*"
    r"[\d.,]+(?:e[+-]?\d+)?\s*(?:%|‰|k?hz|rad/s)?\s*(?=$|[)\],;])",
    re.IGNORECASE,
)
"""How far what a column holds scatters, as its head says it with a figure: ±0.1 %, (std 0.1)."""
_NUMBER = re.compile(r"^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][+-]?\d+)?$")


class Listed(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Natural frequencies as somebody gave them."""

    frequencies_hz: "Array"
    """(n,)."""
    numbers: tuple[int, ...] | None
    """Their mode numbers where the list has a column of them."""
    rounding: "Array"
    """(n,): half a unit of the last digit written, relative."""
    source: str
    """Where they are from."""
    unit: str
    """In which they were given: Hz, kHz or rad/s."""

    @property
    def n(self) -> int:
        """How many."""
        return len(self.frequencies_hz)


class Shapes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Mode shapes as somebody gave them."""

    x: "Array"
    """(n_points,), metres, ascending."""
    values: "Array"
    """(n_modes, n_points)."""


class _Rows(msgspec.Struct, frozen=True):
    """Cells of a text, and the head above them."""

    head: tuple[str, ...]
    cells: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]
    """The line, from 1, that each row stands on."""
    where: str


def read_frequencies(path: Path, unit: str | None = None, *, sorted_list: bool = True) -> Listed:
    """The frequencies in a text file: comma, semicolon, tab or spaces, with a head or without, decimal comma or point.

    The file `-` is standard input. One column, or one named or known as frequencies, beside a column of mode numbers.
    `unit` is Hz, kHz or rad/s; where it is None the head says it, else hertz. Raises InputError, with the line, for
    text, gaps, numbers that are not finite, negative ones and, where `sorted_list`, those that do not rise.
    """
    rows = _rows(path, "frequencies")
    numbered, column = _columns(rows)
    values = [_value(rows, i, column, "frequency") for i in range(len(rows.cells))]
    for line, value in zip(rows.lines, values, strict=True):
        if value < 0.0:
            raise InputError(f"{rows.where} line {line} has {value!r}: frequencies are not negative, give their size")
    if sorted_list:
        check_rising(values, rows.where, rows.lines)
    known = unit.lower() if unit else _unit_of(rows.head[column]) if rows.head else "hz"
    return Listed(
        frequencies_hz=np.array(values) * _PER_HERTZ[known],
        numbers=_mode_numbers(rows, numbered),
        rounding=np.array([_rounding(row[column], value) for row, value in zip(rows.cells, values, strict=True)]),
        source=rows.where,
        unit={"hz": "Hz", "khz": "kHz"}.get(known, known),
    )


def check_rising(values: "list[float]", where: str, lines: "tuple[int, ...] | range") -> None:
    """Raise InputError where a frequency lies below the one before."""
    for i in range(1, len(values)):
        if values[i] < values[i - 1]:
            raise InputError(
                f"{where} line {lines[i]}: {values[i]!r} lies below {values[i - 1]!r} before it: sort the list, or "
                "give the shapes with --modes, by which modes are then paired"
            )


def read_shapes(path: Path, length: float, n_modes: int) -> Shapes:
    """Mode shapes in a text file: x in the first column, metres, then one column for each of `n_modes` frequencies.

    Raises InputError for text, gaps, numbers that are not finite, x that does not rise or lies off the beam, another
    number of modes than the list has, and a mode at rest.
    """
    rows = _rows(path, "modes")
    width = len(rows.cells[0])
    if width - 1 != n_modes:
        raise InputError(
            f"{rows.where} has {width - 1} mode shapes beside x, and the list {n_modes} frequencies: give a column for "
            "each"
        )
    table = np.array([[_value(rows, i, k, "value") for k in range(width)] for i in range(len(rows.cells))])
    shapes = Shapes(x=table[:, 0], values=table[:, 1:].T)
    check_shapes(shapes, length, rows.where)
    return shapes


def check_shapes(shapes: Shapes, length: float, where: str) -> None:
    """Raise InputError for shapes at places off the beam or out of order, at too few of them, or at rest."""
    x = shapes.x
    if len(x) < 3:
        raise InputError(f"{where} has {len(x)} places: give the shapes at three or more")
    if not (np.diff(x) > 0.0).all():
        raise InputError(f"{where}: x = {float(x[1:][np.diff(x) <= 0.0][0])!r} m does not rise: sort the places")
    if x[0] < -1e-9 * length or x[-1] > (1.0 + 1e-9) * length:
        off = float(x[0] if x[0] < 0.0 else x[-1])
        raise InputError(f"{where}: x = {off!r} m lies off the beam: give places between 0 and {length!r} m")
    for mode, shape in enumerate(shapes.values, start=1):
        if not shape.any():
            raise InputError(f"{where}: the shape of mode {mode} is zero everywhere: give it, or leave the mode out")


def _rows(path: Path, field: str) -> _Rows:
    """The table in a file. Raises InputError where there is none."""
    where = f"{field} on standard input" if path == STANDARD_INPUT else f"{field} file {str(path)!r}"
    lines = [(i, line.strip()) for i, line in enumerate(_text(path, field, where).splitlines(), start=1)]
    kept = [(i, line) for i, line in lines if line]
    comments = [line.lstrip("#%! ") for _, line in kept if line[0] in "#%!"]
    kept = [(i, line) for i, line in kept if line[0] not in "#%!"]
    if not kept:
        raise InputError(f"{where} is empty: give a number on each line")
    cells = _split([line for _, line in kept])
    head: tuple[str, ...] = ()
    if not any(_is_number(cell) for cell in cells[0]):
        head, cells, kept = cells[0], cells[1:], kept[1:]
    elif comments:  # as numpy writes one
        said = _split([comments[-1]])[0]
        head = said if len(said) == len(cells[0]) else ()
    if not cells:
        raise InputError(f"{where} has a head and no numbers: give a number on each line")
    if len(cells) > MOST:
        raise InputError(f"{where} has {len(cells)} rows: give at most {MOST}")
    for (line, _), row in zip(kept, cells, strict=True):
        if len(row) != len(cells[0]):
            raise InputError(
                f"{where} line {line} has {len(row)} cells and the first row {len(cells[0])}: make them alike"
            )
    width = len(cells[0])
    if head and len(head) != width:  # words between spaces: the unit is somewhere among them
        head = ("mode", " ".join(head))[-width:] if width <= 2 else ()
    return _Rows(head, tuple(cells), tuple(i for i, _ in kept), where)


def _piped() -> bytes:
    """What standard input holds; nothing where it is closed."""
    return sys.stdin.buffer.read() if sys.stdin else b""


def _text(path: Path, field: str, where: str) -> str:
    exists(path, field)
    try:
        return (_piped() if path == STANDARD_INPUT else path.read_bytes()).decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{where} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise InputError(f"{where} is not text in UTF-8: save it as CSV in UTF-8") from None


def _split(lines: list[str]) -> list[tuple[str, ...]]:
    """The cells of every line, by the delimiter that the lines have; a decimal comma becomes a point."""
    text = "\n".join(lines)
    for delimiter in (";", "\t"):
        if delimiter in text:
            return [tuple(_pointed(cell.strip().strip('"')) for cell in line.split(delimiter)) for line in lines]
    if "," in text and not _has_decimal_commas(lines):
        return [tuple(cell.strip().strip('"') for cell in line.split(",")) for line in lines]
    return [tuple(_pointed(cell.strip('"')) for cell in line.split()) for line in lines]


def _has_decimal_commas(lines: list[str]) -> bool:
    """Whether commas between spaces or alone on their line are decimal: no point beside them, no count before them."""
    numbers = [line for line in lines if line[0] in "+-.,0123456789"]
    parts = [part for line in numbers for part in line.split()]
    if not numbers or "." in "".join(numbers) or any(part.count(",") > 1 or part.endswith(",") for part in parts):
        return False
    if any(len(line.split()) > 1 for line in numbers):
        return all(_is_number(part) for part in parts)
    before = [line.split(",")[0] for line in numbers]
    return before not in ([str(i) for i in range(1, len(before) + 1)], [str(i) for i in range(len(before))])


def _pointed(cell: str) -> str:
    return cell.replace(",", ".") if _NUMBER.match(cell) else cell


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.match(cell)) or cell.lower().lstrip("+-") in ("nan", "inf", "infinity")


def _value(rows: _Rows, row: int, column: int, what: str) -> float:
    """A finite number in a cell. Raises InputError, with its line."""
    cell, where = rows.cells[row][column], f"{rows.where} line {rows.lines[row]}"
    if not cell:
        raise InputError(f"{where} has a gap where a {what} should stand: give it, or leave the line out")
    try:
        value = float(cell.replace("d", "e").replace("D", "e"))
    except ValueError:
        raise InputError(f"{where}: {shown(cell)} is no number: give the {what} as one") from None
    if not isfinite(value):
        raise InputError(f"{where}: {cell} is no {what}: leave the line out or mend what wrote it")
    return value


def _columns(rows: _Rows) -> tuple[int | None, int]:
    """(the column of mode numbers or None, that of frequencies). Raises InputError where that cannot be told."""
    width = len(rows.cells[0])
    if rows.head:
        numbered = next((k for k, name in enumerate(rows.head) if _NUMBERED.match(name)), None)
        others = [k for k, name in enumerate(rows.head) if k != numbered and not _SCATTER.search(_without_size(name))]
        named = [k for k in others if _names_frequencies(rows.head[k])]
        if others and not named:
            _check_none_is_dropped(rows, others, numbered)
        by_unit = ([k for k in named if _unit_of(rows.head[k]) == unit] for unit in _PER_HERTZ)
        found = next(filter(None, by_unit), others)
        if named and len(found) > 1:
            names = " and ".join(repr(rows.head[k]) for k in found)
            raise InputError(f"{rows.where} has {len(found)} columns of frequencies, {names}: leave the one to compare")
        if len(found) == 1:
            return numbered, found[0]
    if width == 1:
        return None, 0
    first = [row[0] for row in rows.cells]
    if width == 2 and all(cell.isdigit() for cell in first) and (len(first) == 1 or _rises([int(c) for c in first])):
        return 0, 1
    raise InputError(
        f"{rows.where} has {width} columns, and which holds the frequencies cannot be told: give a head with "
        "'mode' and 'frequency_hz' or 'omega_rad/s'"
    )


def _check_none_is_dropped(rows: _Rows, others: list[int], numbered: int | None) -> None:
    """Raise InputError where only columns of scatter are named after frequencies: they, or `others`, may be them."""
    for k, name in enumerate(rows.head):
        if k != numbered and k not in others and _names_frequencies(name):
            other = shown(rows.head[others[0]])
            raise InputError(
                f"{rows.where}: {shown(name)} is named after frequencies and after scatter, {other} after neither: "
                "name the one to compare 'frequency_hz'"
            )


def _without_size(name: str) -> str:
    """A column's name without the figure of how far its values scatter."""
    return _SIZED.sub("", name).strip(" ()[],;")


def _names_frequencies(name: str) -> bool:
    return any(pattern.search(_without_size(name)) for pattern in _UNITS.values())


def _rises(numbers: list[int]) -> bool:
    return all(b > a for a, b in pairwise(numbers)) and numbers[0] <= 1


def _unit_of(name: str) -> str:
    bare = _without_size(name)
    return next((unit for unit, pattern in _UNITS.items() if pattern.search(bare)), "hz")


def _mode_numbers(rows: _Rows, column: int | None) -> tuple[int, ...] | None:
    """Mode numbers from 1, where there is a column of them. Raises InputError where they do not rise."""
    if column is None:
        return None
    numbers = [_value(rows, i, column, "mode number") for i in range(len(rows.cells))]
    for i, number in enumerate(numbers):
        if number != int(number) or not 0 <= number <= MOST or (i and number <= numbers[i - 1]):
            raise InputError(
                f"{rows.where} line {rows.lines[i]}: mode number {number:g} is no whole number above the one before "
                f"and up to {MOST}: number the modes upwards"
            )
    return tuple(int(number) + (numbers[0] == 0) for number in numbers)


def _rounding(cell: str, value: float) -> float:
    """Half a unit of the last digit of a number as written, relative; that of double precision at least."""
    mantissa, _, exponent = cell.lower().replace("d", "e").partition("e")
    digits = len(mantissa.partition(".")[2])
    return max(0.5 * 10.0 ** (int(exponent or 0) - digits) / value, 1e-16) if value else 0.0
