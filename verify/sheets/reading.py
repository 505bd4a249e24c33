"""Figures of a record: what a sheet asks for, read from the columns of a table of numbers."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from verify.arrays import Array
from verify.compare.record import read_record
from verify.convert import FACTORS
from verify.errors import InputError, shown
from verify.identify.ring_down import RingDown, RingMode, ring_down
from verify.sheets.sheet import Figure, Reading, Sheet

LENGTHS = FACTORS["m"] | {"µm": 1e-6}
FAR = 2.0
"""Largest factor between a frequency of the record and that of the mode which it is taken for."""


class Run:
    """The record of one run, with the columns of a sheet: times (n,), s, and signals by name, (n,), SI."""

    def __init__(self, sheet: Sheet, path: Path) -> None:
        """Raises InputError for a file that is no record, and for a column that is missing."""
        record = read_record(path)
        if record is None:
            raise InputError(f"file {shown(str(path))}: no record, give a table with times in its first column, in s")
        self.path, self.times = path, record.times
        named = {self._word(name): index for index, name in reversed([*enumerate(record.names)])}
        plain = all(name.startswith("column ") for name in record.names)  # no header: the order of the sheet
        self.signals: dict[str, Array] = {}
        for place, column in enumerate(sheet.columns[1:]):
            index = place if plain and place < len(record.names) else named.get(column)
            if index is None:
                text = f"it has {', '.join(record.names)}, the sheet asks for {', '.join(sheet.columns)}"
                raise InputError(f"file {shown(str(path))} has no column {column!r}: {text}")
            unit = re.findall(r"[^\W\d_]+", record.names[index])[-1] if not plain else ""
            self.signals[column] = record.signals[:, index] * LENGTHS.get(unit, 1.0)
        self._rings: dict[tuple[str, float | None, float | None], RingDown] = {}

    @staticmethod
    def _word(name: str) -> str:
        """'tip_x' of 'Tip_x, mm' or 'tip_x [mm]'."""
        return re.split(r"[\s,(\[/]", name.strip().strip('"').lower())[0]

    def window(self, figure: Figure) -> tuple[Array, Array]:
        """Times and values of the column in the figure's window. Raises InputError where it has no sample."""
        since, until = (-np.inf if figure.from_s is None else figure.from_s), figure.until_s or np.inf
        inside = (self.times >= since * (1 - 1e-9)) & (self.times <= until * (1 + 1e-9))
        if not inside.any() or (figure.until_s is not None and self.times[-1] < until * (1 - 1e-3)):
            need = f"from {since if np.isfinite(since) else 0:g} s" + f" to {until:g} s" * bool(np.isfinite(until))
            raise InputError(f"file {shown(str(self.path))}: {figure.name} needs samples {need}, record longer")
        return self.times[inside], self.signals[figure.column][inside]

    def mode(self, figure: Figure, hertz: float) -> RingMode:
        """The mode of the record that is nearest to a frequency, by ratio. Raises InputError."""
        key = figure.column, figure.from_s, figure.until_s
        if key not in self._rings:
            try:
                self._rings[key] = ring_down(*self.window(figure))
            except InputError as error:
                raise InputError(f"file {shown(str(self.path))}, {figure.column}: {error}") from None
        found = min(self._rings[key].modes, key=lambda mode: abs(np.log(mode.undamped_hz / hertz)))
        if not 1.0 / FAR < found.undamped_hz / hertz < FAR:
            listed = ", ".join(f"{mode.hz:.4g}" for mode in self._rings[key].modes)
            text = f"rings at {listed} Hz, none is mode {figure.mode} at {hertz:.4g} Hz: start it as the sheet says"
            raise InputError(f"file {shown(str(self.path))}: {figure.column} {text}")
        return found


def frequency_of(sheet: Sheet, figure: Figure) -> float:
    """The exact undamped frequency, Hz, of the mode of a figure."""
    return next(one.exact for one in sheet.figure if one.read == "frequency" and one.mode == figure.mode)


def value(sheet: Sheet, figure: Figure, run: Run) -> float:
    """A figure of a run. Raises InputError where the record does not have it."""
    if figure.read in ("frequency", "damping"):
        mode = run.mode(figure, figure.exact if figure.read == "frequency" else frequency_of(sheet, figure))
        return mode.undamped_hz if figure.read == "frequency" else mode.zeta
    found = READ[figure.read](*run.window(figure))
    if not np.isfinite(found):
        raise InputError(f"file {shown(str(run.path))}: {figure.column} shows no {figure.read}, record longer")
    return found


def _extreme(sign: float) -> Callable[[Array, Array], float]:
    def extreme(t: Array, y: Array) -> float:
        """Of a smooth curve through the samples."""
        from scipy.interpolate import CubicSpline

        if len(t) < 4:
            return sign * float((sign * y).max())
        curve = CubicSpline(t, sign * y)
        turns = curve.derivative().roots(extrapolate=False)
        return sign * float(max((sign * y).max(), *curve(turns[np.isfinite(turns)]), -np.inf))

    return extreme


least, greatest = _extreme(-1.0), _extreme(1.0)


def mean(t: Array, y: Array) -> float:
    """Time mean, by trapezoids."""
    return float(np.trapezoid(y, t) / (t[-1] - t[0])) if len(t) > 1 else float(y[0])


def period(t: Array, y: Array) -> float:
    """Mean time between upward crossings of the mean, with linear interpolation."""
    above = y - mean(t, y)
    up = np.flatnonzero((above[:-1] < 0.0) & (above[1:] >= 0.0))
    at = t[up] + (t[up + 1] - t[up]) * above[up] / (above[up] - above[up + 1])
    return float(np.diff(at).mean()) if len(at) > 1 else float("nan")


READ: dict[Reading, Callable[[Array, Array], float]] = {
    "last": lambda t, y: float(y[-1]),
    "mean": mean,
    "least": least,
    "greatest": greatest,
    "rate": lambda t, y: float(np.polyfit(t - t[0], y, 1)[0]) if len(t) > 1 else float("nan"),
    "amplitude": lambda t, y: 0.5 * (greatest(t, y) - least(t, y)),
    "period": period,
    "drift": lambda t, y: float((y[-1] - y[0]) / (abs(y[0]) or 1.0)),
}
"""Readings of (times, values) that need no mode: drift is the change over the first value."""
