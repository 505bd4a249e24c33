"""Rows measured: what fits into the time, first calls, set-ups, then rounds in which all methods take turns.

Times are of the processor, spent by this process in one thread, so that what else a machine does counts less; on a
machine that does nothing else they are what a clock on the wall shows.
"""

from collections.abc import Callable, Iterable, Sequence
from statistics import median
from time import process_time
from typing import TypeAlias

import msgspec

from verify.bench.kind import Case, Entry, Judged, Run, Told
from verify.bench.rows import Row
from verify.errors import InputError
from verify.judge.crossing import Point, observed
from verify.timing import forget, spread

Clock: TypeAlias = Callable[[], float]
"""Seconds from anywhere; those of the processor unless a test gives another."""

LEAST_ROUNDS = 3
TURN_S = 2e-3
"""Shortest turn of a round: shorter runs are repeated within it, so that a clock and its neighbours matter less."""
ONCE = 3
"""Runs beside the rounds: the first, with its set-up, and one that tells how long a turn is."""


class Outcome(msgspec.Struct, frozen=True, eq=False):
    """An entry and what came of it."""

    entry: Entry
    row: Row

    @property
    def point(self) -> Point | None:
        """For a comparison; None where there is no error or no time."""
        row = self.row
        if row.error is None or not row.whole_s or not self.entry.size:
            return None
        return Point(self.entry.size, row.error, row.whole_s, (row.spread_s or 0.0) / row.whole_s)


class _Ready(msgspec.Struct, frozen=True, eq=False):
    """An entry that ran once."""

    entry: Entry
    run: Run
    judged: Judged
    first_s: float
    set_up_s: float
    repeats: int


def fitting(cases: Sequence[Case], seconds: float) -> tuple[dict[int, str], float]:
    """(why an entry is left out, by its identity; seconds that the rest is estimated to take).

    The least go first, as long as they fit; the reference of a case is paid with the first entry that is taken of it.
    """
    work = [(entry.work_s(LEAST_ROUNDS + ONCE - 1), entry, case) for case in cases for entry in case.entries]
    total, begun = 0.0, set[int]()
    why: dict[int, str] = {}
    for taken, entry, case in sorted(work, key=lambda one: one[0]):
        cost = taken + case.estimate_s * (id(case) not in begun)
        if total + cost <= seconds:
            total += cost
            begun.add(id(case))
            continue
        reference = f" with its reference, which takes {case.estimate_s:.2g}," if cost > taken else ","
        why[id(entry)] = (
            f"about {cost:.2g} s of work (estimated from above){reference} more than is left of the {seconds:g} s: "
            f"give more seconds, or leave {entry.told} out"
        )
    return why, total


def measured(
    case: Case, left_out: dict[int, str], rounds: int, budget_s: float, clock: Clock = process_time
) -> list[Outcome]:
    """Every entry of a case with its error and times; with the reason where it has none. Raises InputError."""
    told: dict[int, str] = {id(e): left_out[id(e)] for e in case.entries if id(e) in left_out}
    ready: dict[int, _Ready] = {}
    if len(told) < len(case.entries):
        error, raced = case.judge(), _raced_alone(case)
        seen: dict[str, list[float]] = {}
        for entry in (one for one in case.entries if id(one) not in told):
            name, found = entry.line.name, seen.setdefault(entry.line.name, [])
            if name in raced and _is_enough(found, min(case.wanted)):
                told[id(entry)] = f"longer steps of {name} come to {100.0 * min(case.wanted):g} %, it is not run"
                continue
            try:
                ready[id(entry)] = _first(entry, error, clock)
                found.append(abs(ready[id(entry)].judged.error))
            except InputError as problem:
                told[id(entry)] = str(problem)
    times = _rounds(list(ready.values()), rounds, budget_s, clock)
    rows = [_row(case, entry, ready.get(id(entry)), times, told.get(id(entry), "")) for entry in case.entries]
    return _with_orders(case, [Outcome(*pair) for pair in zip(case.entries, rows, strict=True)])


def _raced_alone(case: Case) -> set[str]:
    """Names of lines of which nothing is asked but their time at the errors `wanted`."""
    compared = {name for pair in case.pairs for name in pair}
    return {name for _, name in case.races} - compared


def _is_enough(errors: Sequence[float], wanted: float) -> bool:
    """Whether the last two are within it, or the last within a tenth of it: one alone may be so by chance."""
    last = errors[-2:]
    return (len(last) == 2 and max(last) < wanted) or (bool(last) and last[-1] < 0.1 * wanted)


def _first(entry: Entry, error: Callable[[Entry, object], Judged], clock: Clock) -> _Ready:
    """The first call, what it found, and a second one that tells how often a turn repeats it."""
    begun = clock()
    told = entry.prepare()()
    first = clock() - begun
    judged = error(entry, told.answer)
    if not judged.error < float("inf") or judged.error != judged.error:
        raise InputError(f"{entry.told} gives no finite figure")
    begun = clock()
    run = (entry.part or entry.prepare)()
    set_up = clock() - begun
    _, took = _timed(entry, run, clock)
    set_up = max(set_up - took, 0.0) if entry.runs_first else set_up
    return _Ready(entry, run, judged, first, set_up, max(1, round(TURN_S / took)) if took > 0.0 else 1)


def _timed(entry: Entry, run: Run, clock: Clock) -> tuple[Told, float]:
    """What a run gave, and its seconds."""
    if entry.afresh:
        forget()
    begun = clock()
    told = run()
    return told, clock() - begun


def _rounds(
    ready: Sequence[_Ready], rounds: int, budget_s: float, clock: Clock
) -> dict[int, list[tuple[float, float | None]]]:
    """(seconds of a run, the share of its set-up) of every entry in each round, by its identity."""
    found: dict[int, list[tuple[float, float | None]]] = {id(one.entry): [] for one in ready}
    begun, done = clock(), 0
    while ready and done < rounds and (done < LEAST_ROUNDS or clock() - begun < budget_s):
        for one in ready:
            found[id(one.entry)].append(_turn(one, clock))
        done += 1
    return found


def _turn(one: _Ready, clock: Clock) -> tuple[float, float | None]:
    """Mean seconds of a run within a turn, and what share of it went into a set-up that the run made anew."""
    if one.entry.afresh:
        pairs = [_timed(one.entry, one.run, clock) for _ in range(one.repeats)]
        told, seconds = [t for t, _ in pairs], median(s for _, s in pairs)
    else:
        begun = clock()
        told = [one.run() for _ in range(one.repeats)]
        seconds = (clock() - begun) / one.repeats
    shares = [t.set_up_share for t in told if t.set_up_share is not None]
    return _of_the_whole(seconds, median(shares) if shares else None, told[0].share)


def _of_the_whole(seconds: float, set_up: float | None, part: float) -> tuple[float, float | None]:
    """(seconds, the share of its set-up) of a whole run, from those of its first part."""
    if part == 1.0:
        return seconds, set_up
    made = (set_up or 0.0) * seconds
    whole = made + (seconds - made) / part
    return whole, made / whole if set_up is not None and whole > 0.0 else None


def _row(
    case: Case, entry: Entry, ready: _Ready | None, times: dict[int, list[tuple[float, float | None]]], why: str
) -> Row:
    row = Row(
        set=case.set,
        about=case.about,
        method=entry.line.name,
        model=entry.line.model,
        settings=entry.line.settings | entry.settings,
        count=entry.count,
        left_out=why,
    )
    if ready is None:
        return row
    turns = times[id(entry)]
    seconds, shares = [s for s, _ in turns], [share for _, share in turns if share is not None]
    whole, share = median(seconds), median(shares) if shares else 0.0
    made = ready.set_up_s if entry.sets_up else None
    return msgspec.structs.replace(
        row,
        error=ready.judged.error,
        reference=ready.judged.reference.name,
        reference_uncertainty=ready.judged.reference.uncertainty,
        warm_s=(1.0 - share) * whole,
        spread_s=spread(seconds),
        set_up_s=(made or 0.0) + share * whole if shares else made,
        first_s=ready.first_s,
        rounds=len(turns),
    )


def _with_orders(case: Case, found: Sequence[Outcome]) -> list[Outcome]:
    """The same with the order of every row from the coarser one before it on its line."""
    coarser: dict[str, Outcome] = {}
    ordered: dict[int, Row] = {}
    for one in sorted(found, key=lambda o: -o.entry.size):
        before, point = coarser.get(one.entry.line.name), one.point
        if point is None:
            continue
        if before is not None and before.point is not None:
            order = observed(before.point, point, floor_of(case, one.row))
            ordered[id(one)] = msgspec.structs.replace(one.row, order=order)
        coarser[one.entry.line.name] = one
    return [Outcome(one.entry, ordered.get(id(one), one.row)) for one in found]


def floor_of(case: Case, row: Row) -> float:
    """Below which an error of a row is not its method's."""
    return max(case.floor, row.reference_uncertainty or 0.0)


def floors(case: Case, rows: Iterable[Row]) -> float:
    """The highest of them."""
    return max((floor_of(case, row) for row in rows), default=case.floor)
