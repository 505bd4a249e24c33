"""Records of free vibration: a table of numbers with a time column, which is how it differs from a list."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from verify.analysis.verdict import per_cent
from verify.arrays import Array
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.compare.reading import FrequencyList, read_table, solver_cells
from verify.errors import InputError
from verify.files import read_text
from verify.identify.ring_down import FEWEST, RingDown, RingMode
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table

TIME = re.compile(r"t|times?(stamp)?|sec|seconds?|zeit|temps", re.IGNORECASE)
"""First word of a header of times."""
TIMED = re.compile(rf"(?im)^[#%!\s\"]*(?:{TIME.pattern})(?![^\W\d_])")
SECONDS = {"us": 1e-6, "µs": 1e-6, "ms": 1e-3, "min": 60.0}
"""Seconds in a unit that the header of times names; otherwise seconds."""
COLOURED = "the residuals of the record are not white: more modes or nonlinear, its intervals too short"
TONES = "harmonics, sums or differences of stronger ones, of a vibration that is not small"
HEAVY = "damped too heavily beside what is left of the signals"
EMPTY = re.compile(r"(?<=[,;\t])[ ]*(?=[,;\t]|$)")
"""A cell without a value in a row of numbers."""
DIGITS, ROUNDED = 10, 0.75
"""Decimals of a time that may be rounded; deviation from even spacing, over its last digit, by half a digit and fit."""
STEADY = 1e-4
"""Damping ratio below which a single mode may be driven."""
DAMPED = 0.1
"""Damping ratio from which a mode lasts less than two cycles: an aliased mode moved one of 18 % by 2 % in frequency."""
ALIASES, NEAR = 12, 0.01
"""Modes of the beam that may be sampled too slowly, and the relative error of their frequency in a record."""


class Record(NamedTuple):
    """Times (n,), s, and signals (n, channels) with their names; `notes`: what is not as in the file.

    `unfilled`: rows at the end of the file that have no value, as of a run that diverged.
    """

    times: Array
    signals: Array
    names: list[str]
    notes: tuple[str, ...] = ()
    unfilled: int = 0


def read_record(path: Path) -> Record | None:
    """The record in a text file, None for a list of frequencies.

    Its first column is named as a time, or ascends without being mode numbers, over 16 rows or more; further columns
    are signals. Rows without a value and repeated rows are left out. Raises InputError, also for times that go back.
    """
    source = f"file {str(path)!r}"
    text = read_text(path, "file")
    if sum(bool(line.strip()) for line in text.splitlines()) < FEWEST or solver_cells(text):
        return None
    try:
        rows = (EMPTY.sub("nan", line) if line[:1] in "0123456789.+-" else line for line in text.splitlines())
        head, table = read_table("\n".join(rows), source)
    except InputError:
        if TIMED.search(text):
            raise
        return None
    if len(table) < FEWEST or table.shape[1] < 2:
        return None
    words = re.findall(r"[^\W\d_]+", head[0]) if head else []
    timed, ascending = bool(words and TIME.fullmatch(words[0])), bool((np.diff(table[:, 0]) > 0.0).all())
    if not timed and not head and ascending and not (table[:, 0] % 1.0).any() and (table[:, 1:] < 0.0).any():
        text = "whole numbers and negative values without a header: name the columns, such as 't_ms' and 'y_mm'"
        raise InputError(f"{source}: {text}")
    if not timed and (head or not ascending or not (table[:, 0] % 1.0).any()):
        return None
    unit = next((SECONDS[word] for word in words[1:] if word in SECONDS), 1.0)
    names = head[1:] or [f"column {k}" for k in range(2, table.shape[1] + 1)]
    return _cleaned(table, names, unit, source)


def need_record(path: Path) -> Record:
    """The record in a text file. Raises InputError for a list, too."""
    if (record := read_record(path)) is None:
        raise InputError(f"file {str(path)!r} is no record: give 16 rows or more of a time 't' and signals")
    return record


def _cleaned(table: Array, names: list[str], unit: float, source: str) -> Record:
    """The record of a table without empty columns, rows without a value and repeated rows. Raises InputError."""
    full = ~np.isnan(np.where(np.isinf(table), np.nan, table))
    filled = np.logical_or.reduce(full)  # a separator at the end of every line makes an empty column
    filled[0], names = True, [name for name, has in zip(names, filled[1:].tolist(), strict=True) if has]
    whole = np.logical_and.reduce(full[:, filled], axis=1)
    table, place = table[whole][:, filled], np.flatnonzero(whole)
    again = np.append(False, ~np.diff(table, axis=0).any(axis=1))
    table, place, notes = table[~again], place[~again], list[str]()
    for rows, text in ((int((~whole).sum()), "without a value"), (int(again.sum()), "that repeat the one before")):
        notes += [f"Rows left out {text}: {rows}."] * bool(rows)
    if len(table) < FEWEST or not names:
        raise InputError(f"{source} has {len(table) * bool(names)} rows with values: give {FEWEST} or more")
    times = table[:, 0]
    if len(back := np.flatnonzero(np.diff(times) <= 0.0)):
        k, remedy = int(back[0]) + 1, "give ascending times of one run; MuJoCo restarts one that diverges"
        raise InputError(f"{source}, row {place[k] + 1}: time {times[k]:.9g} after {times[k - 1]:.9g}: {remedy}")
    even, digit = np.polynomial.Polynomial.fit(place, times, 1)(place), _last_digit(times)
    if 1e-6 * digit < abs(even - times).max() <= ROUNDED * digit:
        times, notes = even, [*notes, f"Times are those of the even spacing that the file rounds to {digit:g}."]
    return Record(unit * times, table[:, 1:], names, tuple(notes), len(whole) - 1 - int(np.flatnonzero(whole)[-1]))


def _last_digit(times: Array) -> float:
    """A unit of the last decimal of rounded times, 0 of others."""
    scaled = ((10.0**-d, 10.0**d * times) for d in range(DIGITS))
    return next((digit for digit, one in scaled if abs(one - np.round(one)).max() < 1e-6), 0.0)


def as_list(modes: Sequence[RingMode], source: str) -> FrequencyList:
    """The undamped frequencies of modes of a record, with their 95 % intervals as digits."""
    hertz = np.array([mode.undamped_hz for mode in modes])
    widths = np.array([mode.hz_interval[1] - mode.hz_interval[0] for mode in modes])
    return FrequencyList(source=source, values=hertz, digits=np.maximum(widths / hertz, 1e-12), declared=True)


def listed_modes(ring: RingDown, beam: Beam) -> list[RingMode]:
    """Modes without tones and, where the residuals are not white, without heavily damped ones, which these bias."""
    tones = ring.tones(_exact(beam))
    light = [mode for mode in ring.modes if mode not in tones and (ring.white or abs(mode.zeta) < DAMPED)]
    return light or [*ring.modes]


def _exact(beam: Beam) -> list[float]:
    """Frequencies of the exact beam, Hz; none where it has no model of it."""
    try:
        return list[float](frequencies_hz(Candidate(model=EXACT), beam, None, ALIASES).tolist())
    except InputError:
        return []


def with_record(result: Result, ring: RingDown, listed: Sequence[RingMode], record: Record, beam: Beam) -> Result:
    """A comparison of a list with the modes of the record that it is from, and what its sampling hides of a beam."""
    columns = [Column("entry"), Column("damped f", "Hz", ".7g"), Column("± (95 %)", "Hz", ".2g")]
    columns += [
        Column("damping ratio", percent=True, format=".4g"),
        Column("± (95 %) of it", percent=True, format=".2g"),
    ]
    columns += [Column(f"amplitude of {name}", format=".3g") for name in record.names]

    def row(number: int, mode: RingMode) -> tuple[object, ...]:
        return number, mode.hz, mode.halves[0], mode.zeta, mode.halves[1], *mode.amplitude

    rows = [row(number, mode) for number, mode in enumerate(listed, start=1)]
    used = record.times[record.times >= ring.start]
    span = f"{len(used)} samples over {used[-1] - used[0]:.4g} s, noise {ring.noise:.2g}"
    notes = [f"Least squares over {span}, with offset and drift. Listed above: undamped frequencies.", *record.notes]
    if len(used) < len(record.times):
        notes.append(f"Free vibration from {ring.start:.4g} s on; what is before, as the rise of a load, is left out.")
    tones = ring.tones(exact := _exact(beam))
    for text, tonal in ((TONES, True), (HEAVY, False)):
        lost = [one for one in ring.modes if one not in listed and (one in tones) == tonal]
        names = ", ".join(f"{mode.hz:.4g} Hz at {per_cent(mode.zeta)}" for mode in lost)
        notes += [f"Left out, as {text}: {names}."] * bool(lost)
    unseen, warnings = _unseen(ring, exact)
    notes, warnings = [*notes, *unseen], [*result.warnings, *warnings]
    warnings += [COLOURED] * (not ring.white)
    if len(ring.modes) == 1 and abs(ring.modes[0].zeta) < STEADY:
        warnings.append(f"a vibration that does not decay: compare a steady one by --drive {ring.modes[0].hz:.4g}Hz")
    modes = [mode.__dict__ | {"undamped_hz": mode.undamped_hz} for mode in ring.modes]
    tables = [*result.tables, Table("Modes of the record", columns, rows, notes)]
    return replace(result, tables=tables, warnings=warnings, data=dict(result.data) | {"record": modes})


def _unseen(ring: RingDown, exact: list[float]) -> tuple[list[str], list[str]]:
    """(notes, warnings) on modes of a beam above half the sampling rate, which appear at lower frequencies."""
    rate = ring.rate
    fast = [(mode, hz) for mode, hz in enumerate(exact, start=1) if hz > 0.5 * rate]
    if not fast or fast[0][0] > len(ring.modes) + 1:
        return [], []
    warnings = []
    for mode, hz in (one for one in fast if one[1] < 2.5 * rate):  # of faster ones the alias is uncertain
        alias = abs(hz - rate * round(hz / rate))
        for entry, found in enumerate(ring.modes, start=1):
            if abs(found.hz - alias) < NEAR * hz and all(abs(found.hz / one - 1.0) > NEAR for one in exact):
                text = f"sampled at {rate:.4g} Hz, mode {mode} of the beam ({hz:.4g} Hz) appears at {alias:.3g} Hz"
                warnings.append(f"{text}: entry {entry} may be it, sample at {2.5 * hz:.3g} Hz or more")
    text = (
        f"Sampled at {rate:.4g} Hz: mode {fast[0][0]} of the beam ({fast[0][1]:.4g} Hz) and higher ones are not seen."
    )
    return [text], warnings
