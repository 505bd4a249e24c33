"""One sentence for each comparison: where the cheaper method changes, or why nobody can say."""

from collections.abc import Sequence
from math import log

from verify.bench.kind import Case
from verify.bench.measuring import Outcome, floors
from verify.bench.rows import Sentence
from verify.judge.crossing import ABOVE_FLOOR, Crossing, Point, Stretch, Unearned, converging, crossing

ASTRAY = 0.5
"""How far an observed order may lie from the known one."""


def sentences_of(case: Case, found: Sequence[Outcome], scene: str) -> list[Sentence]:
    """One for each pair of a case's lines, then what is exact beside the rest."""
    told = [_compared(case, found, scene, *pair) for pair in case.pairs]
    return told + _exact(case, found, scene)


def _compared(case: Case, found: Sequence[Outcome], scene: str, first: str, second: str) -> Sentence:
    stretches = [_stretch(case, found, name) for name in (first, second)]
    about = f"{case.name}: {first} against {second}"
    for name, one in zip((first, second), stretches, strict=True):
        if isinstance(one, Unearned):
            text = f"{about}: no time is set against another, {name}: {one.why}; {one.remedy}"
            return _sentence(case, (first, second), text)
    a, b = (one for one in stretches if isinstance(one, Stretch))
    answer = crossing(a, b)
    if isinstance(answer, Unearned):
        text = f"{about}: no time is set against another, {answer.why}; {answer.remedy}"
        return _sentence(case, (first, second), text)
    text = f"{about}: {_verdict(first, second, answer)}{_wanted(case, answer, a, b)} ({_condition(case, found, scene)})"
    return _sentence(case, (first, second), text, answer)


def _stretch(case: Case, found: Sequence[Outcome], name: str) -> Stretch | Unearned:
    own = [one for one in found if one.entry.line.name == name]
    orders = own[0].entry.line.orders
    if orders is None:
        return Unearned("nobody knows the order of its errors", "compare its rows")
    pairs = [(one, one.point) for one in sorted(own, key=lambda o: -o.entry.size)]
    points: list[Point] = [point for _, point in pairs if point is not None]
    floor = ABOVE_FLOOR * floors(case, (one.row for one, point in pairs if point is not None))
    if not points:
        return Unearned(own[-1].row.left_out or "it has no figure", "see its rows")
    return converging(points, orders, ASTRAY, floor)


def _verdict(first: str, second: str, answer: Crossing) -> str:
    """Which is cheaper, over which errors, by how much."""
    span = f"from {percent(answer.high)} down to {percent(answer.low)}"
    sizes = [ratio for _, ratio in answer.ratios]
    low, high = min(sizes), max(sizes)
    if not answer.crossings:
        if max(abs(log(low)), abs(log(high))) <= answer.spread:
            return (
                f"neither is cheaper at errors {span}: ratios {low:.2f} to {high:.2f} lie within the spread of "
                f"{100 * answer.spread:.0f} %"
            )
        loser, times = (second, (low, high)) if low * high > 1.0 else (first, (1.0 / high, 1.0 / low))
        return f"at errors {span}, {loser} takes {_times(*times)} as long"
    changes = ", ".join(percent(error) for error in reversed(answer.crossings))
    at_high = first if answer.ratios[-1][1] > 1.0 else second
    fine = answer.ratios[0]
    finer = first if fine[1] > 1.0 else second
    size = max(fine[1], 1.0 / fine[1])
    return (
        f"the cheaper one changes at an error of {changes}: above it {at_high}, at {percent(answer.low)} {finer} by "
        f"{size:.2f} times"
    )


def _times(low: float, high: float) -> str:
    return f"{low:.2f} times" if high < 1.02 * low else f"{low:.2f} to {high:.2f} times"


def _wanted(case: Case, answer: Crossing, a: Stretch, b: Stretch) -> str:
    """The ratio at errors that somebody asks for, where both reach them."""
    inside = [error for error in case.wanted if answer.low <= error <= answer.high]
    return "".join(f"; at {error:g} the ratio is {b.seconds(error) / a.seconds(error):.2f}" for error in inside)


def _condition(case: Case, found: Sequence[Outcome], scene: str) -> str:
    rounds = [one.row.rounds for one in found if one.row.rounds]
    return (
        f"{scene}, {case.question}; {case.condition}; set-up and run, medians of {min(rounds)} rounds, this run on this "
        "machine"
    )


def _exact(case: Case, found: Sequence[Outcome], scene: str) -> list[Sentence]:
    """Where a method has no size, what it costs beside the cheapest of parts."""
    exact = next((one for one in found if one.entry.line.orders is None and one.row.model == "analytic"), None)
    others = [one for one in found if one.entry.line.orders is not None and one.row.whole_s]
    if exact is None or exact.row.whole_s is None or not others:
        return []
    least = min(others, key=lambda one: one.row.whole_s or 0.0)
    own, other = exact.row.whole_s, least.row.whole_s
    assert other is not None
    assert least.row.error is not None
    compared = (
        f"{other / own:.2f} times less than the cheapest of parts, {least.entry.told}"
        if other > own
        else f"{own / other:.2f} times as long as the cheapest of parts, {least.entry.told}"
    )
    text = (
        f"{case.name}: the exact solution takes {1e3 * own:.3g} ms, {compared} with its error of "
        f"{percent(abs(least.row.error))} ({_condition(case, found, scene)})"
    )
    methods = (exact.entry.line.name, least.entry.line.name)
    return [Sentence(set=case.set, about=case.about, methods=methods, text=text, earned=True, ratio=other / own)]


def _sentence(case: Case, methods: tuple[str, str], text: str, answer: Crossing | None = None) -> Sentence:
    return Sentence(
        set=case.set,
        about=case.about,
        methods=methods,
        text=text,
        earned=answer is not None,
        ratio=answer.ratios[0][1] if answer else None,
        at_error=answer.low if answer else None,
        crossing=answer.crossings[0] if answer and answer.crossings else None,
    )


def percent(error: float) -> str:
    """An error in per cent, short."""
    return f"{100 * error:.2g} %"
