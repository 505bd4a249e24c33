"""A record of a steady vibration: amplitude and phase with 95 % intervals, beside the exact field of the drive."""

import re
from collections.abc import Sequence
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, per_cent
from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.compare.record import need_record
from verify.errors import InputError
from verify.identify.fit import REJECTED, whiteness
from verify.report.result import Column, Result, Table
from verify.scene.model import Scene

STEADY = "steady record"
METRES = {"nm": 1e-9, "um": 1e-6, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2}
"""Metres in a unit that the name of a signal ends with; otherwise metres."""


class Sine(NamedTuple):
    """a cos(2 pi f t + phase), phase in degrees, with half widths of 95 % intervals for white noise."""

    amplitude: float
    within: float
    phase: float
    phase_within: float


def sines(times: Array, signals: Array, hz: float) -> tuple[list[Sine], bool]:
    """(sine of every column of signals (n, channels), whether the residuals are white) at a frequency, s and Hz.

    Linear least squares with offset and drift. Raises InputError for less than a period and two samples of a period.
    """
    from scipy.special import stdtrit

    periods, freedom = hz * float(times[-1] - times[0]), len(times) - 4
    if periods < 1.0 or len(times) < 2.0 * periods:
        text = f"{len(times)} samples of {periods:.3g} periods, give one or more, sampled faster"
        raise InputError(f"drive = {hz:g} Hz: {text}")
    turns = 2.0 * pi * hz * times
    basis = np.stack([np.cos(turns), -np.sin(turns), np.ones(len(times)), times - times.mean()], axis=1)
    values = np.linalg.lstsq(basis, signals, rcond=None)[0]
    rest, found = signals - basis @ values, list[Sine]()
    spread = float(stdtrit(freedom, 0.975)) * np.sqrt((rest**2).sum(axis=0) / freedom)
    cov = np.linalg.inv(basis.T @ basis)[:2, :2]
    for (a, b), one in zip(values[:2].T.tolist(), spread.tolist(), strict=True):
        size = max(float(np.hypot(a, b)), 1e-300)
        along, across = np.array([a, b]) / size, np.array([-b, a]) / size
        halves = [one * float(np.sqrt(row @ cov @ row)) for row in (along, across)]
        phase, within = np.degrees((np.arctan2(b, a), halves[1] / size)).tolist()
        found.append(Sine(size, halves[0], phase, min(within, 180.0)))
    chance = whiteness(rest.T)
    return found, chance is None or chance > REJECTED


def compare_steady(scene: Scene, path: Path, hz: float | None, places: Sequence[float], within: float) -> Result:
    """Amplitudes and phases of a record, and where the scene has a drive by forces, those of the exact beam.

    `hz`: default that of the drive. `places`: x of the signals, m. `data["passed"]`: amplitudes, in their phase, are
    `within` the exact ones, relative, beyond their intervals. Raises InputError.
    """
    record, drive = need_record(path), scene.drive
    if places and (drive is None or drive.kind != "force" or drive.shunt):
        raise InputError("at: a steady record is compared with a scene's drive by forces without shunts, leave it out")
    hz = hz or (drive.frequency_hz if drive else None)
    if hz is None:
        raise InputError("drive: the scene has none, give --drive HZ")
    if places and len(places) != len(record.names):
        raise InputError(f"at: {len(places)} places for {len(record.names)} signals, give one for each")
    units = np.array([METRES.get((re.findall(r"[^\W\d_]+", name) or [""])[-1], 1.0) for name in record.names])
    found, white = sines(record.times, units * record.signals, hz)
    columns = [Column("signal"), Column("amplitude", "m", ".6g"), Column("± (95 %)", "m", ".2g")]
    columns += [Column("phase", "deg", ".5g"), Column("± (95 %) of it", "deg", ".2g")]
    rows = [list[object]([name, *one]) for name, one in zip(record.names, found, strict=True)]
    margins, limits = list[Margin](), dict[str, Any](name=STEADY, fine=within, limit=within)
    text = f"Steady vibration at {hz:.6g} Hz: cos(2 pi f t + phase), t as in the record."
    if places and drive:
        margins += beam_margins(SolutionCache(scene.beam), (), frequency_hz=hz)
        exact = ExactModel(scene.beam).harmonic(scene.forces, hz, devices=scene.devices).deflection(np.array(places))
        columns += [Column("x", "m", ".4g"), Column("exact amplitude", "m", ".6g"), Column("exact phase", "deg", ".5g")]
        columns += [Column("off", percent=True, format="+.2g")]
        for k, (one, w) in enumerate(zip(found, exact.tolist(), strict=True)):
            rows[k] += [places[k], abs(w), float(np.degrees(np.angle(w))), one.amplitude / abs(w) - 1.0]
            miss = abs(one.amplitude * np.exp(1j * np.radians(one.phase)) - w) / abs(w)
            size = max(miss - max(one.within / one.amplitude, np.radians(one.phase_within)), 0.0)
            failure = f"{record.names[k]} is {per_cent(miss)} off the exact field of the drive at {hz:.6g} Hz"
            margins.append(Margin(size=size, where=f"at x = {places[k]:g} m", failure=failure, **limits))
    coloured = "residuals are not white: another frequency, harmonics or a transient, intervals too short"
    data = {
        "hz": hz,
        "sines": [one._asdict() for one in found],
        "passed": all(one.name != STEADY or one.size <= within for one in margins),
    }
    tables = [Table("Steady signals", columns, [tuple(row) for row in rows], list(record.notes))]
    return Result(text, tables, warnings=[coloured] * (not white), margins=margins, data=data)
