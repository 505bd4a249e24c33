"""Records of free vibration: a table of numbers with a time column, which is how it differs from a list."""

import re
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.compare.reading import FrequencyList, read_table
from verify.files import read_text
from verify.identify.ring_down import FEWEST, RingDown, RingMode
from verify.report.result import Column, Result, Table

TIME = re.compile(r"t|time|zeit|temps", re.IGNORECASE)
"""First word of a header of times."""
SECONDS = {"us": 1e-6, "µs": 1e-6, "ms": 1e-3}
"""Seconds in a unit that the header of times names; otherwise seconds."""


class Record(NamedTuple):
    """Times (n,), s, and signals (n, channels) with their names."""

    times: Array
    signals: Array
    names: list[str]


def read_record(path: Path) -> Record | None:
    """The record in a text file, None for a list of frequencies.

    Its first column is named as a time, or ascends without being mode numbers, over 16 rows or more; further columns
    are signals. Raises InputError.
    """
    source = f"file {str(path)!r}"
    text = read_text(path, "file")
    if sum(bool(line.strip()) for line in text.splitlines()) < FEWEST:
        return None
    head, table = read_table(text, source)
    if len(table) < FEWEST or table.shape[1] < 2:
        return None
    words = re.findall(r"[^\W\d_]+", head[0]) if head else []
    timed = bool(words and TIME.fullmatch(words[0]))
    ascending = bool((np.diff(table[:, 0]) > 0.0).all())
    if not timed and (head or not ascending or not (table[:, 0] % 1.0).any()):
        return None
    unit = next((SECONDS[word] for word in words[1:] if word in SECONDS), 1.0)
    names = head[1:] or [f"column {k}" for k in range(2, table.shape[1] + 1)]
    return Record(unit * table[:, 0], table[:, 1:], names)


def as_list(ring: RingDown, source: str) -> FrequencyList:
    """The undamped frequencies of a record, with their 95 % intervals as digits."""
    hertz = np.array([mode.undamped_hz for mode in ring.modes])
    widths = np.array([mode.hz_interval[1] - mode.hz_interval[0] for mode in ring.modes])
    return FrequencyList(source=source, values=hertz, digits=np.maximum(widths / hertz, 1e-12), declared=True)


def with_record(result: Result, ring: RingDown, record: Record) -> Result:
    """A comparison of a list with the modes of the record that it is from."""
    columns = [Column("entry"), Column("damped f", "Hz", ".7g"), Column("± (95 %)", "Hz", ".2g")]
    columns += [
        Column("damping ratio", percent=True, format=".4g"),
        Column("± (95 %) of it", percent=True, format=".2g"),
    ]
    columns += [Column(f"amplitude of {name}", format=".3g") for name in record.names]

    def row(number: int, mode: RingMode) -> tuple[object, ...]:
        halves = [0.5 * (high - low) for low, high in (mode.hz_interval, mode.zeta_interval)]
        return number, mode.hz, halves[0], mode.zeta, halves[1], *mode.amplitude

    rows = [row(number, mode) for number, mode in enumerate(ring.modes, start=1)]
    span = f"{len(record.times)} samples over {record.times[-1] - record.times[0]:.4g} s, noise {ring.noise:.2g}"
    notes = [f"Least squares over {span}, with offset and drift. Listed above: undamped frequencies."]
    warnings = [*result.warnings]
    if not ring.white:
        warnings.append("the residuals of the record are not white: more modes or nonlinear, its intervals too short")
    modes = [mode.__dict__ | {"undamped_hz": mode.undamped_hz} for mode in ring.modes]
    tables = [*result.tables, Table("Modes of the record", columns, rows, notes)]
    return replace(result, tables=tables, warnings=warnings, data=dict(result.data) | {"record": modes})
