"""One sentence for each comparison: where the cheaper method changes, or why nobody can say."""

from collections.abc import Sequence
from itertools import groupby
from math import log
from operator import itemgetter

from msgspec import Struct
from msgspec.structs import replace

from verify.bench.kind import Case
from verify.bench.measuring import Outcome, floors
from verify.bench.rows import Row, Sentence
from verify.judge.crossing import (
    ABOVE_FLOOR,
    Crossing,
    Point,
    Stretch,
    Unearned,
    at_error,
    converging,
    crossing,
    within,
)
from verify.units import in_words

UNTIMED = "its time is below the resolution of the clock"
NEAR = 0.01
"""Within which a method of parts is set beside the exact solution."""


def sentences_of(case: Case, found: Sequence[Outcome], scene: str) -> list[Sentence]:
    """One for each pair of a case's lines, then what is exact beside the rest."""
    told = [_compared(case, found, scene, *pair) for pair in case.pairs]
    told += [_raced(case, found, scene, *pair) for pair in case.races]
    return told + _exact(case, found, scene)


def _raced(case: Case, found: Sequence[Outcome], scene: str, first: str, second: str) -> Sentence:
    """How much longer the second takes at every wanted error, each at its own longest step."""
    told = {wanted: _race(case, found, wanted, (first, second)) for wanted in case.wanted}
    ratios = {wanted: answer.whole for wanted, answer in told.items() if isinstance(answer, _Ratio)}
    parts = [
        answer
        if isinstance(answer, str)
        else f"at {percent(wanted)} {second} takes {answer.whole:.3g} times as long, "
        f"without their set-up {answer.run:.3g} times"
        for wanted, answer in told.items()
    ]
    finest = min(ratios, default=None)
    own = f"{case.name}: {first} against {second}: {'; '.join(parts)}"
    return Sentence(
        set=case.set,
        about=case.about,
        methods=(first, second),
        text=f"{own} (each at its own longest step; {_condition(case, found, scene)})",
        earned=bool(ratios),
        ratio=ratios[finest] if finest is not None else None,
        at_error=finest,
        at=tuple(ratios.items()),
    )


class _Ratio(Struct, frozen=True):
    """Times of the second over those of the first, at one error."""

    whole: float
    run: float
    """Without their set-up."""
    spread: float
    """Of the first, relative."""


def _race(
    case: Case, found: Sequence[Outcome], wanted: float, methods: tuple[str, str], *, between: bool = True
) -> _Ratio | str:
    """Each at the coarsest size, or `between` two, from which on all are within an error; why there is no ratio."""
    seconds: list[tuple[float, float]] = []
    spread = 0.0
    for name in methods:
        ran = sorted((o for o in found if o.entry.line.name == name), key=lambda o: -o.entry.size)
        own = [o for o in ran if o.point]
        floor = floors(case, (o.row for o in own))
        if own and wanted < ABOVE_FLOOR * floor:
            known = f"what {name} is held against is known to {percent(floor)} alone"
            return f"at {percent(wanted)} nothing is said, {known}"
        points = [p for o in own if (p := o.point)]
        alone = [replace(p, seconds=o.row.warm_s or 0.0) for p, o in zip(points, own, strict=True)]
        if any(_untimed(o.row) or (o.point and not o.row.warm_s) for o in ran):
            return f"at {percent(wanted)} nothing is said, {name}: {UNTIMED}"
        whole, run = (within(ran_in, wanted, between=between) for ran_in in (points, alone))
        if whole is None or run is None:
            least = min((abs(p.error) for p in points), default=None)
            why = "has no figure" if least is None else f"comes to {100 * least:.3g} %"
            left = sum(bool(o.row.left_out) for o in found if o.entry.line.name == name)
            return f"at {percent(wanted)} nothing is said, {name} {why}" + (f", {left} steps left out" if left else "")
        seconds.append((whole, run))
        spread += max(p.spread for p in points)
    (a, b), (c, d) = seconds
    return _Ratio(c / a, d / b, spread)


def _untimed(row: Row) -> bool:
    """Whether a row ran and a coarse clock saw no time pass."""
    return row.whole_s == 0.0


def _compared(case: Case, found: Sequence[Outcome], scene: str, first: str, second: str) -> Sentence:
    stretches = [_stretch(case, found, name) for name in (first, second)]
    for name, one in zip((first, second), stretches, strict=True):
        if isinstance(one, Unearned):
            return _at_wanted(case, found, scene, (first, second), f"{name}: {one.why}; {one.remedy}")
    a, b = (one for one in stretches if isinstance(one, Stretch))
    answer = crossing(a, b)
    if isinstance(answer, Unearned):
        return _at_wanted(case, found, scene, (first, second), f"{answer.why}; {answer.remedy}")
    ends = [_end(name, one) for name, one in ((first, a), (second, b)) if one.n_finer]
    at = _inside(case, answer, a, b)
    verdict, slower = _verdict(first, second, answer)
    wanted = [f"{_likewise(first, second, slower, ratio)} at {percent(error)}" for error, ratio in at]
    alone = _alone(found, (first, second), answer)
    if alone is not None:
        said = _likewise(first, second, slower, alone)
        wanted.append(f"runs without their set-up {said} at {percent(answer.low)}")
    parts = (verdict, *wanted, *ends)
    orders = f"observed orders {_span(a.orders)} and {_span(b.orders)}"
    text = f"{case.name}: {first} against {second}: {'; '.join(parts)} ({orders}; {_condition(case, found, scene)})"
    return _sentence(case, (first, second), text, answer, at)


def _end(name: str, stretch: Stretch) -> str:
    """Where errors cease to fall at their order, though no finer size is worse."""
    sizes = "a finer size" if stretch.n_finer == 1 else f"{stretch.n_finer} finer sizes"
    return f"{sizes} of {name} {'is' if stretch.n_finer == 1 else 'are'} no part of it, not at that order"


def _at_wanted(case: Case, found: Sequence[Outcome], scene: str, methods: tuple[str, str], why: str) -> Sentence:
    """Ratios at errors that somebody asks for, where times cannot be compared over all of them; or nothing."""
    first, second = methods
    told = {wanted: _race(case, found, wanted, methods, between=False) for wanted in case.wanted}
    ratios = {wanted: ratio for wanted, ratio in told.items() if isinstance(ratio, _Ratio)}
    about = f"{case.name}: {first} against {second}"
    if not ratios:
        return _sentence(case, methods, f"{about}: no time is set against another, {why}")
    words = [(percent(wanted), _told(first, second, ratio)) for wanted, ratio in ratios.items()]
    alike = [(said, [at for at, _ in group]) for said, group in groupby(words, key=itemgetter(1))]
    parts = ", ".join(f"at {' and '.join(errors)} {said}" for said, errors in alike)
    text = (
        f"{about}: {parts}, each at the coarsest of its sizes from which on all are within; "
        f"where the cheaper one changes is not told, {why} ({_condition(case, found, scene)})"
    )
    return _sentence(case, methods, text, at=tuple((wanted, ratio.whole) for wanted, ratio in ratios.items()))


def _told(first: str, second: str, ratio: _Ratio) -> str:
    """A ratio, or that it is none beyond the spread."""
    if abs(log(ratio.whole)) <= ratio.spread:
        return f"as long by either within the spread of {100 * ratio.spread:.0f} %"
    return _slower(first, second, ratio.whole)


def _stretch(case: Case, found: Sequence[Outcome], name: str) -> Stretch | Unearned:
    own = [one for one in found if one.entry.line.name == name]
    orders, remedy = own[0].entry.line.orders, own[0].entry.line.remedy
    if orders is None:
        return Unearned("nobody knows the order of its errors", remedy or "compare its rows")
    pairs = [(one, one.point) for one in sorted(own, key=lambda o: -o.entry.size)]
    points: list[Point] = [point for _, point in pairs if point is not None]
    floor = ABOVE_FLOOR * floors(case, (one.row for one, point in pairs if point is not None))
    if any(_untimed(one.row) for one in own):
        return Unearned(UNTIMED, "give larger sizes")
    if not points:
        return Unearned(own[-1].row.left_out or "it has no figure", "see its rows")
    return converging(points, orders, floor, finer=remedy or "give finer ones")


def _verdict(first: str, second: str, answer: Crossing) -> tuple[str, str]:
    """(which is cheaper, over which errors, by how much; the slower one, empty where that changes or is none)."""
    span = f"at errors from {percent(answer.high)} down to {percent(answer.low)}"
    if answer.crossings:
        ends = (
            f"{_slower(first, second, ratio)} at {percent(e)}" for e, ratio in (answer.ratios[0], answer.ratios[-1])
        )
        return f"the cheaper one changes at an error of {_turns(first, second, answer)}; {', '.join(ends)}", ""
    sizes = [ratio for _, ratio in answer.ratios]
    low, high = min(sizes), max(sizes)
    if max(abs(log(low)), abs(log(high))) <= answer.spread:
        spread = f"the spread of {100 * answer.spread:.0f} %"
        return f"{span} neither is cheaper beyond {spread}, {second} takes {_span(sizes)} times as long as {first}", ""
    if log(low) + log(high) < 0.0:
        first, second, low, high = second, first, 1.0 / high, 1.0 / low
    if low < 1.0:
        most = _slower(first, second, high)
        return f"{span} the cheaper one, where they differ beyond the spread, is {first}: up to {most}", second
    return f"{span} it takes {_span((low, high))} times as long by {second} as by {first}", second


def _turns(first: str, second: str, answer: Crossing) -> str:
    """Errors at which the cheaper one changes, and which it is on either side, where they differ beyond the spread."""
    coarse = next(ratio for _, ratio in reversed(answer.ratios) if abs(log(ratio)) > answer.spread)
    pair = (first, second) if coarse > 1.0 else (second, first)
    above, *between, below = (pair[i % 2] for i in range(len(answer.crossings) + 1))
    changes = ", ".join(percent(error) for error in reversed(answer.crossings))
    inside = f" {', '.join(between)} between," if between else ""
    return f"{changes}: {above} above,{inside} {below} below"


def _likewise(first: str, second: str, slower: str, ratio: float) -> str:
    """A ratio after a verdict: the number alone where the same one is slower."""
    told = _slower(first, second, ratio)
    own = f" times as long by {slower}"
    return told.removesuffix(own) if slower else told


def _slower(first: str, second: str, ratio: float) -> str:
    """'1.62 times as long by elements'."""
    return f"{max(ratio, 1.0 / ratio):.2f} times as long by {second if ratio > 1.0 else first}"


def _span(values: Sequence[float]) -> str:
    low, high = min(values), max(values)
    return f"{high:.2f}" if high - low < 0.02 * abs(high) else f"{low:.2f} to {high:.2f}"


def _inside(case: Case, answer: Crossing, a: Stretch, b: Stretch) -> tuple[tuple[float, float], ...]:
    """(error, ratio) at errors that somebody asks for, where both reach them."""
    inside = [error for error in case.wanted if answer.low <= error <= answer.high]
    return tuple((error, b.seconds(error) / a.seconds(error)) for error in inside)


def _alone(found: Sequence[Outcome], methods: tuple[str, str], answer: Crossing) -> float | None:
    """The ratio of the runs without their set-up, at the smallest error that both reach; None without a set-up."""
    seconds: list[float] = []
    for name in methods:
        own = sorted(
            (o for o in found if o.entry.line.name == name and o.point), key=lambda o: -abs(o.row.error or 0.0)
        )
        if not all(o.row.warm_s for o in own):
            return None
        seconds.append(at_error([abs(o.row.error or 0.0) for o in own], [o.row.warm_s or 0.0 for o in own], answer.low))
    if not any(o.row.set_up_s for o in found if o.entry.line.name in methods):
        return None
    return seconds[1] / seconds[0]


def _condition(case: Case, found: Sequence[Outcome], scene: str) -> str:
    rounds = min((one.row.rounds for one in found if one.row.rounds), default=0)
    return f"{scene}, {case.question}; {case.condition}; medians of {rounds} rounds of this run on this machine"


def _exact(case: Case, found: Sequence[Outcome], scene: str) -> list[Sentence]:
    """What the exact solution costs beside the cheapest of parts that is within what is asked of it at least.

    Of lines whose errors converge over the sizes that were run: one size may be near by chance, or far too fine.
    """
    exact = next((one for one in found if one.entry.line.orders is None and one.row.model == "analytic"), None)
    near = [one for one in found if one.entry.line.orders and one.row.whole_s and abs(one.row.error or 0.0) <= NEAR]
    if exact is None or not exact.row.whole_s or not near:
        return []
    stretches = {name: _stretch(case, found, name) for name in dict.fromkeys(one.entry.line.name for one in near)}
    earned = [one for one in near if isinstance(stretches[one.entry.line.name], Stretch)]
    own, name = exact.row.whole_s, exact.entry.line.name
    if not earned:
        first, why = next(iter(stretches.items()))
        assert isinstance(why, Unearned)
        text = f"{case.name}: no time is set beside the exact solution's, {first}: {why.why}; {why.remedy}"
        return [_sentence(case, (name, first), text)]
    least = min(earned, key=lambda one: one.row.whole_s or 0.0)
    other, line = least.row.whole_s or 0.0, least.entry.line.name
    spread = sum((one.row.spread_s or 0.0) / (one.row.whole_s or 1.0) for one in (exact, least))
    converge, cheaper = _cheaper(near, other, stretches)
    text = (
        f"{case.name}: the exact solution takes {in_words(own, 's')}, the cheapest of parts within {percent(NEAR)}"
        f"{converge}, {least.entry.told}, {in_words(other, 's')}: "
        f"{_told(name, line, _Ratio(other / own, other / own, spread))}{cheaper} ({_condition(case, found, scene)})"
    )
    return [Sentence(set=case.set, about=case.about, methods=(name, line), text=text, earned=True, ratio=other / own)]


def _cheaper(near: Sequence[Outcome], seconds: float, stretches: dict[str, Stretch | Unearned]) -> tuple[str, str]:
    """What is to be said where something cheaper is as near in lines whose errors do not converge: before, behind."""
    cheaper = [one for one in near if (one.row.whole_s or 0.0) < seconds]
    if not cheaper:
        return "", ""
    least = min(cheaper, key=lambda one: one.row.whole_s or 0.0)
    why = stretches[least.entry.line.name]
    assert isinstance(why, Unearned)
    own = f"{least.entry.told}, is within it in {in_words(least.row.whole_s or 0.0, 's')}: {why.why}"
    return " whose errors converge over these sizes", f"; {own}"


def _sentence(
    case: Case,
    methods: tuple[str, str],
    text: str,
    answer: Crossing | None = None,
    at: tuple[tuple[float, float], ...] = (),
) -> Sentence:
    return Sentence(
        set=case.set,
        about=case.about,
        methods=methods,
        text=text,
        earned=answer is not None,
        ratio=answer.ratios[0][1] if answer else None,
        at_error=answer.low if answer else None,
        crossing=answer.crossings[0] if answer and answer.crossings else None,
        at=at,
    )


def percent(error: float) -> str:
    """An error in per cent, short."""
    return f"{100 * error:.2g} %"
