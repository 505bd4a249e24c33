"""Figures of a record: what a sheet asks for, read from the columns of a table of numbers."""

import re
from collections.abc import Callable, Sequence
from copy import copy
from pathlib import Path

import numpy as np

from verify.analysis.verdict import per_cent
from verify.arrays import Array
from verify.compare.record import read_record
from verify.errors import InputError, shown
from verify.identify.ring_down import RingDown, RingMode, ring_down
from verify.sheets.sheet import Figure, Reading, Sheet
from verify.validation import FACTORS

LENGTHS = FACTORS["m"] | {"µm": 1e-6}
FAR = 2.0
"""Largest factor between a frequency of the record and that of the mode which it is taken for."""
CUT = 2
"""Rows without a value at the end of a record of a run that diverged; a logger may cut the last row."""
ALIKE = 0.02
"""Relative difference within which several frequencies are off by one factor."""
LATE = 0.02
"""Largest time of the first row over the duration of the sheet: a logger may skip the first step."""
SAMPLED = 0.49
"""Largest frequency of a mode over the sampling rate: one next to half the rate cannot be fitted."""
NOISE = 1e-4
"""Least sd of noise over the range of a signal that can hide a mode."""
MILLI = 500.0, 2000.0
"""Factors between times of a record and those of the sheet that tell milliseconds."""


class Run:
    """The record of one run, with the columns of a sheet: times (n,), s, and signals by name, (n,), SI."""

    def __init__(self, sheet: Sheet, path: Path, count: int | None = None) -> None:
        """`count`: number of links, where it is known.

        Raises InputError for a file that is no record, and for a column that is missing.
        """
        record = read_record(path)
        if record is None:
            raise InputError(f"file {shown(str(path))}: no record, give a table with times in its first column, in s")
        self.path, self.count, self.times, self.notes = path, count, record.times, record.notes
        if record.unfilled >= CUT:
            text = f"no value in its last {record.unfilled} rows, after {self.times[-1]:.4g} s: the run diverged"
            raise InputError(f"file {shown(str(path))}: {text}, take a smaller step")
        self.duration, self.every = sheet.duration_s, sheet.every_s
        if text := self._wrong_times():
            raise InputError(f"file {shown(str(path))}: {text}")
        named = {self._word(name, sheet.columns): index for index, name in reversed([*enumerate(record.names)])}
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

    def _wrong_times(self) -> str:
        """What times are instead of those of the sheet, '' where they may be: counts, ms, or a multiple."""
        rows, end, last = len(self.times), self.duration, float(self.times[-1])
        step = (last - float(self.times[0])) / (rows - 1)
        if self.every and step == 1.0 != self.every and not (self.times % 1.0).any():
            return f"its times count the rows, {self.times[0]:g} to {last:g}: give them in s, every {self.every:g} s"
        if MILLI[0] * end < last < MILLI[1] * end:
            return f"times up to {last:.4g} s for {end:g} s: name them 'time_ms' if they are in ms"
        if self.every and abs(rows - 1 - end / self.every) <= 1.0 and abs(last / end - 1.0) > LATE:
            text = f"times up to {last:.4g} s in {rows} rows, which are {self.every:g} s apart in the sheet"
            return f"{text}: give the times of the engine, in s, up to {end:g} s"
        return ""

    def with_signals(self, signals: dict[str, Array]) -> "Run":
        """The same run with other signals of its columns."""
        other = copy(self)
        other.signals, other._rings = self.signals | signals, {}
        return other

    def noise(self, column: str) -> float:
        """The sd of noise in a column, by its fourth differences, of which those of a smooth motion are small."""
        return float(1.4826 * np.median(abs(np.diff(self.signals[column], 4))) / 70.0**0.5)

    @staticmethod
    def _word(name: str, columns: tuple[str, ...]) -> str:
        """'tip_x' of 'Tip_x, mm', 'tip_x [mm]' or 'tip_x_mm'."""
        word = re.split(r"[\s,(\[/]", name.strip().strip('"').lower())[0]
        front, _, unit = word.rpartition("_")
        return front if word not in columns and unit in LENGTHS else word

    def window(self, figure: Figure) -> tuple[Array, Array]:
        """Times and values of the column in the figure's window. Raises InputError where it has no sample."""
        since, until = (-np.inf if figure.from_s is None else figure.from_s), figure.until_s or np.inf
        inside = (self.times >= since * (1 - 1e-9)) & (self.times <= until * (1 + 1e-9))
        end = figure.until_s or self.duration
        step = (self.times[-1] - self.times[0]) / (len(self.times) - 1)  # the last sample may be one step early
        if not inside.any() or self.times[-1] + 1.5 * step < end:
            need = f"from {since if np.isfinite(since) else 0:g} s" + f" to {end:g} s" * bool(end)
            text = f"{figure.name} needs samples {need}, it ends at {self.times[-1]:.4g} s: record longer"
            raise InputError(f"file {shown(str(self.path))}: {text}")
        late = 0.0 if figure.read == "first" else LATE * self.duration
        if end and self.times[0] > max(late, 1.5 * step):
            text = f"its times start at {self.times[0]:.4g} s: give those from the start of the motion, from 0 on"
            raise InputError(f"file {shown(str(self.path))}: {text}")
        return self.times[inside], self.signals[figure.column][inside]

    def mode(self, figure: Figure, hertz: float, exact: Sequence[float]) -> RingMode:
        """The mode of the record that is nearest to a frequency, by ratio; `exact`: those of its column, Hz.

        Raises InputError.
        """
        key = figure.column, figure.from_s, figure.until_s
        times, _ = self.window(figure)
        rate = (len(times) - 1) / (times[-1] - times[0])
        if hertz > SAMPLED * rate:
            text = f"{figure.column} is sampled {rate:.4g} times a second, mode {figure.mode} at {hertz:.4g} Hz"
            need = 1.0 / self.every if self.every else 4.0 * max(exact)
            raise InputError(f"file {shown(str(self.path))}: {text} needs more: record {need:.3g} rows a second")
        if key not in self._rings:
            try:
                self._rings[key] = ring_down(*self.window(figure))
            except InputError as error:
                raise InputError(f"file {shown(str(self.path))}, {figure.column}: {error}") from None
        ring = self._rings[key]
        factor = self._factor(ring, exact)
        found = min(ring.modes, key=lambda mode: abs(np.log(mode.undamped_hz / (factor * hertz))))
        nearest = min(exact, key=lambda one: abs(np.log(found.undamped_hz / (factor * one))))
        if nearest != hertz or not 1.0 / FAR < found.undamped_hz / hertz < FAR:
            listed = ", ".join(f"{mode.hz:.4g}" for mode in ring.modes)
            text = (
                f"rings at {listed} Hz, none is mode {figure.mode} at {hertz:.4g} Hz: {self._why(figure, ring, exact)}"
            )
            raise InputError(f"file {shown(str(self.path))}: {figure.column} {text}")
        return found

    @staticmethod
    def _factor(ring: RingDown, exact: Sequence[float]) -> float:
        """The factor by which two or more of the exact frequencies are off alike, 1 where there is none."""
        rings = np.array([mode.undamped_hz for mode in ring.modes])
        if max(exact) > SAMPLED * ring.rate:  # modes appear at other frequencies
            return 1.0

        def alike(factor: float) -> int:
            return sum(bool((abs(rings / (factor * one) - 1.0) < ALIKE).any()) for one in exact)

        factor = float(rings[0] / exact[0])
        return factor if alike(factor) > max(alike(1.0), 1) else 1.0

    def _why(self, figure: Figure, ring: RingDown, exact: Sequence[float]) -> str:
        """Why a record does not ring at a frequency: a factor of all frequencies, noise, or its start."""
        if (factor := self._factor(ring, exact)) != 1.0:
            text = f"frequencies are {factor:.4g} times those of the sheet"
            return f"{text}, check the unit of time, the section, E and the density"
        if ring.modes[-1].undamped_hz < min(exact) / FAR:
            return "check the units of E (Pa), section, length (m) and density (kg/m^3), and that of time"
        y = self.signals[figure.column]
        if (share := ring.noise / float(np.ptp(y))) > NOISE and ring.white:
            text = f"noise of {ring.noise:.2g} (sd), {per_cent(share)} of its range, hides it"
            return f"{text}: record what the engine computes, with all digits"
        return "start it as the sheet says, and clamp the end that it says"


def is_modal(figure: Figure) -> bool:
    """Whether a figure is read from the modes of a record."""
    return figure.read in ("frequency", "damping")


def frequency_of(sheet: Sheet, figure: Figure) -> float:
    """The exact undamped frequency, Hz, of the mode of a figure."""
    return next(one.exact for one in sheet.figure if one.read == "frequency" and one.mode == figure.mode)


def value(sheet: Sheet, figure: Figure, run: Run) -> float:
    """A figure of a run. Raises InputError where the record does not have it."""
    if is_modal(figure):
        same = [one for one in sheet.figure if one.read == "frequency" and one.column == figure.column]
        hertz = figure.exact if figure.read == "frequency" else frequency_of(sheet, figure)
        mode = run.mode(figure, hertz, sorted(one.exact for one in same))
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
    "first": lambda t, y: float(y[0]),
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
