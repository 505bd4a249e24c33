"""The entries of a list one by one: as they stand, by number, and as they are read."""

import msgspec
import numpy as np

from verify.identify.alignment import Pairs
from verify.identify.fitting import Data, Fit, Identified
from verify.identify.pairing import Elastic, Found, missing
from verify.identify.yielding import frequencies_of
from verify.models.arrays import Array, Indices
from verify.words import percent


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One entry."""

    mode: int
    """By its number in the list, or by its shape."""
    entry: int
    """Of the list, from 1."""
    given_hz: float
    """The same as `frequency_hz`."""
    frequency_hz: float
    """As it was given, in hertz."""
    exact_hz: float
    error: float
    """Of what was given, relative to exact."""
    scaled_hz: float | None
    """Freed of a wrong unit or a common factor that was diagnosed; None without one."""
    scaled_error: float | None
    """Of `scaled_hz`, relative to the exact mode that it is read as."""
    read_as: int | None
    """The mode that it is, with the gaps that were diagnosed: `mode` without any; None where it is read as none."""
    read_error: float | None
    """Of `scaled_hz`, else of what was given, relative to the exact mode `read_as`."""
    best_hz: float | None
    """Of the best candidate, mode `read_as`; None where it has none."""
    difference: float | None
    """Of `scaled_hz`, else of what was given, relative to the best candidate."""
    beyond: float | None
    """Its size, less what the rounding of the list explains."""
    likeness: float | None
    """MAC of its shape with the exact one; None without shapes."""


def rows_of(
    data: Data, found: Identified, exact: Array, likeness: dict[int, float], elastic: Elastic
) -> tuple[Row, ...]:
    """Every entry whose mode its number or its shape says, in the order of modes."""
    best = found.best
    known = frequencies_of(data, best)
    read = _read_as(data, best, len(known))
    rows = []
    for entry, mode in _by_number(data).items():
        given, at = float(data.listed[entry]), read.get(entry)
        freed = given / best.factor
        read_error = None if at is None else freed / float(exact[at]) - 1.0
        best_hz = None if at is None or at >= len(known) else float(known[at])
        off = None if best_hz is None else freed / best_hz - 1.0
        rows.append(
            Row(
                mode=mode + 1,
                entry=int(elastic.kept[entry]) + 1,
                given_hz=given,
                frequency_hz=given,
                exact_hz=float(exact[mode]),
                error=given / float(exact[mode]) - 1.0,
                scaled_hz=None if best.factor == 1.0 else freed,
                scaled_error=None if best.factor == 1.0 else read_error,
                read_as=None if at is None else at + 1,
                read_error=read_error,
                best_hz=best_hz,
                difference=off,
                beyond=None if off is None else max(abs(off) - float(data.rounding[entry]), 0.0),
                likeness=likeness.get(entry),
            )
        )
    return tuple(sorted(rows, key=lambda row: row.mode))


def _by_number(data: Data) -> dict[int, int]:
    """Which mode each entry is as the list stands, from 0: what numbers or shapes say, else its own place."""
    said = {} if data.paired is None else _modes(data.paired.entries, data.paired.modes)
    free = set(range(len(data.listed))) - set(said.values())
    return said | {entry: entry for entry in range(len(data.listed)) if entry not in said and entry in free}


def _read_as(data: Data, best: Fit, n_modes: int) -> dict[int, int]:
    """Which of the candidate's modes each entry is read as, from 0: those that are apart in their own places."""
    apart = best.pairs.apart(len(data.listed)) if data.paired is None else {}
    there = {entry: mode for entry, mode in apart.items() if mode < n_modes}
    return _modes(best.pairs.entries, best.pairs.modes) | there


def gaps_of(data: Data, best: Fit, elastic: Elastic) -> tuple[Found, ...]:
    """What is to be told of a list in which modes are missing or too many: entries that are apart, and those gaps."""
    known = frequencies_of(data, best)
    read = _read_as(data, best, len(known))
    paired = set(map(int, best.pairs.entries))
    told = []
    for entry, mode in sorted(read.items()):
        if entry not in paired:
            off = percent(float(data.listed[entry] / best.factor / known[mode] - 1.0))
            words = f"entry {elastic.kept[entry] + 1} is {off} off mode {mode + 1}, and the others fit"
            may_be = "a slip, a motion of another kind, or something that the scene does not have"
            told.append(Found(kind="apart", words=f"{words}: {may_be}"))
    entries = sorted(read)
    pairs = Pairs(entries=np.array(entries), modes=np.array([read[entry] for entry in entries]))
    return (*told, *missing(pairs, elastic.kept))


def _modes(entries: Indices, modes: Indices) -> dict[int, int]:
    return dict(zip(map(int, entries), map(int, modes), strict=True))
