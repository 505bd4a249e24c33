"""A bench beside an earlier one: ratios between methods, which a faster machine leaves as they are, and errors."""

from collections.abc import Iterable
from math import exp, log
from pathlib import Path
from statistics import median
from typing import Any, TypeAlias

import msgspec
from msgspec.structs import replace

from verify.bench.found import BenchFound
from verify.bench.rows import Row, Sentence
from verify.errors import InputError
from verify.options import BenchSet

LEAST = 0.1
"""Logarithm of a change below which nothing is said, whatever the spread."""
SHORTEST_S = 1e-12
"""Below which no clock tells a time: a row that a coarse clock saw take none has no ratio."""
BUSY = 1.0
"""Processes to a core from which on they wait for each other, which ratios may feel beyond their spread."""
ERROR_MOVED = 1e-6
"""Relative change of an error that is no rounding, beside what its reference leaves open."""
Key: TypeAlias = tuple[Any, ...]


class Earlier(msgspec.Struct, frozen=True, kw_only=True):
    """What is read of an earlier `--json`."""

    scene: str
    rows: tuple[Row, ...]
    date: str = ""
    machine: dict[str, str] = {}
    versions: dict[str, str] = {}
    load: float | None = None


def read_earlier(path: Path) -> Earlier:
    """Rows of an earlier run. Raises InputError for a file that holds none."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=Earlier)
    except OSError as error:
        raise InputError(f"--against {str(path)!r} cannot be read ({error.strerror or error}): name another") from None
    except (msgspec.DecodeError, msgspec.ValidationError, UnicodeDecodeError) as error:
        raise InputError(f"--against {str(path)!r} is no output of `verify bench --json`: {error}") from None


def beside(found: BenchFound, earlier: Earlier) -> BenchFound:
    """The same with a sentence for everything that moved. Raises InputError for another scene or nothing in common."""
    if earlier.scene != found.scene:
        raise InputError(f"--against: the file is about the scene {earlier.scene!r}, not {found.scene!r}: name another")
    return replace(found, moved=moved(earlier.rows, found.rows, _when(found, earlier)))


def _when(found: BenchFound, earlier: Earlier) -> str:
    """The date of an earlier run, with what of its machine and versions is another now."""
    own, then = found.machine | found.versions, earlier.machine | earlier.versions
    other = [_named(name, was) for name, was in then.items() if own.get(name) != was]
    other += [f"without {name}" for name in found.versions if then and name not in then]
    busy = {"then": earlier.load, "now": found.load}
    other += [f"{load:g} processes to a core {at}" for at, load in busy.items() if load and load > BUSY]
    return (earlier.date or "before") + (f" ({', '.join(other)})" if other else "")


def _named(name: str, was: str) -> str:
    """A machine is told by what it is, a program by its name and version."""
    return was if name in ("processor", "cores", "system") else f"{name} {was}"


def moved(old: Iterable[Row], new: Iterable[Row], when: str) -> tuple[Sentence, ...]:
    """A sentence for each ratio and each error that moved by more than the spread of both; one if none did.

    Ratios are to a common method of the same case at the same size, the one whose own time changed neither more nor
    less than most. Raises InputError where the two have no row in common.
    """
    before, after = _timed(old), _timed(new)
    common = [key for key in after if key in before]
    if not common:
        raise InputError("--against: the two have no timed row in common, bench the same sets and counts")
    told = [_error_moved(before[key], after[key], when) for key in common]
    sentences = [one for one in told if one is not None]
    groups: dict[Key, list[Key]] = {}
    for key in common:
        groups.setdefault(_group(after[key], groups), []).append(key)
    for keys in groups.values():
        sentences += _ratios_moved([(before[key], after[key]) for key in keys], when)
    if sentences:
        return tuple(sentences)
    beside_others = sum(len(keys) for keys in groups.values() if len(keys) > 1)
    return (_nothing_moved(after[common[0]].set, len(common), beside_others, when),)


def _nothing_moved(of: BenchSet, n_rows: int, n_beside_others: int, when: str) -> Sentence:
    """Of how many rows no error moved, and of how many no ratio; of times nothing is earned where there is none."""
    if n_beside_others:
        rows = f"of {n_beside_others} rows no ratio between methods moved beyond its spread"
        text = f"against {when}: {rows}, and no error of {n_rows}"
    else:
        text = f"against {when}: no error of {n_rows} moved; of times nothing is said, for none stands beside another's"
    return Sentence(set=of, about="", methods=("", ""), text=text, earned=n_beside_others > 0)


def _timed(rows: Iterable[Row]) -> dict[Key, Row]:
    return {_key(row): row for row in rows if (row.whole_s or 0.0) >= SHORTEST_S}


def _key(row: Row) -> Key:
    return (*row.line, row.count, tuple(sorted((name, _short(value)) for name, value in row.settings.items())))


def _short(value: object) -> object:
    """A step as it is told: its last digits may differ from machine to machine."""
    return f"{value:.6g}" if isinstance(value, float) else value


def _group(row: Row, groups: dict[Key, list[Key]]) -> Key:
    """Of what stands beside each other: the same case and size; what has no size stands with the first."""
    case = row.set, row.about
    return next((one for one in groups if one[:2] == case), case) if row.count is None else (*case, row.count)


def _ratios_moved(pairs: list[tuple[Row, Row]], when: str) -> list[Sentence]:
    """Sentences of one group; `pairs` are (earlier, now)."""
    if len(pairs) < 2:
        return []
    changes = [log((now.whole_s or 1.0) / (then.whole_s or 1.0)) for then, now in pairs]
    common = _common(changes)
    found = []
    for i, (then, now) in enumerate(pairs):
        size = changes[i] - changes[common]
        allowed = max(LEAST, sum(_relative(row) for row in (then, now, *pairs[common])))
        if i == common or abs(size) <= allowed:
            continue
        other = pairs[common][1].method
        text = (
            f"against {when}: {_told(now)} takes {exp(size):.2f} times what it took over {other}, where the spread of "
            f"both allows {exp(allowed):.2f}"
        )
        methods = (now.method, other)
        found.append(Sentence(set=now.set, about=now.about, methods=methods, text=text, earned=True, ratio=exp(size)))
    return found


def _common(changes: list[float]) -> int:
    """The method that others are held against: the one whose change lies nearest the middle, of two the first."""
    middle = median(changes)
    return min(range(len(changes)), key=lambda i: (round(abs(changes[i] - middle), 12), i))


def _relative(row: Row) -> float:
    return (row.spread_s or 0.0) / (row.whole_s or 1.0)


def _error_moved(then: Row, now: Row, when: str) -> Sentence | None:
    """Where a method gives another answer than before."""
    if then.error is None or now.error is None:
        return None
    open_ = 3.0 * max(then.reference_uncertainty or 0.0, now.reference_uncertainty or 0.0) + 1e-12
    if abs(now.error - then.error) <= ERROR_MOVED * max(abs(then.error), abs(now.error)) + open_:
        return None
    text = f"against {when}: the error of {_told(now)} is {now.error:.6g} and was {then.error:.6g}"
    return Sentence(set=now.set, about=now.about, methods=(now.method, ""), text=text, earned=True)


def _told(row: Row) -> str:
    at = next((f", {n} {v:.3g}" for n, v in row.settings.items() if n in ("step", "tolerance")), "")
    size = "" if row.count is None else f", N = {row.count}"
    return f"{row.method} in {row.set}{', ' + row.about if row.about else ''}{size}{at}"
