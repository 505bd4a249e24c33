"""Run time over error: where errors fall at their order, what a method costs at an error, where the cheaper changes.

Sees numbers alone. Between two points of a line a cost is a straight line in logarithms.
"""

from collections.abc import Sequence
from itertools import pairwise
from math import exp, log

import msgspec

ABOVE_FLOOR = 3.0
"""How many times an error has to exceed what its reference leaves open."""
ASTRAY = 1.0
"""How far an observed order may lie from the known one for times to be compared."""
NO_ANSWER = 0.5
"""An error from which on a figure is none: what falls from there on falls at no order."""
ROUNDED = 1e-6
"""Above it an error that has changed its sign and grows is on its way to its order, and no rounding of any method."""
LEAST = 3
"""Points between which an order is seen twice."""


class Point(msgspec.Struct, frozen=True):
    """One method at one size."""

    size: float
    """A power of which the error is."""
    error: float
    """Signed or not."""
    seconds: float
    spread: float = 0.0
    """Of the seconds, relative."""


class Stretch(msgspec.Struct, frozen=True):
    """Points between which errors fall at their order, coarse to fine."""

    points: tuple[Point, ...]
    orders: tuple[float, ...]
    """Observed between them."""
    n_finer: int = 0
    """Sizes beyond, which are no worse than the last of these and do not go on at that order."""

    @property
    def span(self) -> tuple[float, float]:
        """Smallest and largest error."""
        errors = [abs(p.error) for p in self.points]
        return min(errors), max(errors)

    @property
    def spread(self) -> float:
        """The largest of its points' times, relative."""
        return max(p.spread for p in self.points)

    def seconds(self, error: float) -> float:
        """What the method costs at an error within its span."""
        return at_error([abs(p.error) for p in self.points], [p.seconds for p in self.points], error)


class Unearned(msgspec.Struct, frozen=True):
    """Why times stand for nothing, and what to change."""

    why: str
    remedy: str


class Crossing(msgspec.Struct, frozen=True):
    """Two methods over the errors that both reach."""

    low: float
    high: float
    ratios: tuple[tuple[float, float], ...]
    """(error, seconds of the second over those of the first), errors ascending."""
    spread: float
    """Of the ratios, relative."""
    crossings: tuple[float, ...]
    """Errors at which the cheaper one changes, ascending."""


def at_error(errors: Sequence[float], values: Sequence[float], error: float) -> float:
    """A value at an error on the line through its two neighbours, in logarithms; errors fall along it, above 0."""
    fine = next((i for i, own in enumerate(errors) if own <= error), len(errors) - 1)
    coarse = max(fine - 1, 0)
    if coarse == fine:
        return values[fine]
    part = log(error / errors[coarse]) / log(errors[fine] / errors[coarse])
    return exp(log(values[coarse]) + part * log(values[fine] / values[coarse]))


def within(points: Sequence[Point], wanted: float, *, between: bool = True) -> float | None:
    """Seconds at the coarsest size from which on all errors are within a wanted one; None where there is none.

    `points` from coarse to fine. `between` sizes by the line through the two on either side, else of the sizes alone;
    nothing is foretold beyond them, so that a method whose coarsest size is good enough takes the time of that.
    """
    errors = [abs(p.error) for p in points]
    first = max((i + 1 for i, error in enumerate(errors) if error > wanted), default=0)
    if first == len(points):
        return None
    if not (first and between) or errors[first - 1] >= NO_ANSWER or not errors[first]:
        return points[first].seconds
    pair = slice(first - 1, first + 1)
    return at_error(errors[pair], [p.seconds for p in points[pair]], wanted)


def observed(a: Point, b: Point, floor: float) -> float | None:
    """The order between two points; None where an error is rounding, changes its sign or the sizes are equal."""
    if a.size == b.size or a.error * b.error <= 0.0 or min(abs(a.error), abs(b.error)) <= floor:
        return None
    return log(a.error / b.error) / log(a.size / b.size)


def too_few(n_sizes: int) -> str:
    """Why fewer sizes than `LEAST` say nothing."""
    return "one size shows no order" if n_sizes == 1 else f"{n_sizes} sizes show no order"


def converging(
    points: Sequence[Point], orders: tuple[float, float], floor: float, *, finer: str = "give finer ones"
) -> Stretch | Unearned:
    """The finest stretch whose observed orders lie within ASTRAY of the known ones, up to an error that all keep.

    `points` from coarse to fine; errors up to `floor` are rounding, the first from NO_ANSWER on are none. Finer sizes
    than those of the stretch may fall otherwise, or no further, but exceed its smallest error nowhere: what is said of
    the errors within it holds at all sizes from there on. `finer` is what to do without one, while errors fall.
    """
    known = f"{orders[0]:g}" if orders[0] == orders[1] else f"{orders[0]:.3g} to {orders[1]:.3g}"
    first_answer = next((i for i, p in enumerate(points) if abs(p.error) < NO_ANSWER), len(points))
    above = [p for p in points[first_answer:] if floor < abs(p.error)]
    if len(points) < LEAST:
        return Unearned(too_few(len(points)), "give three or more")
    if len(above) < LEAST:
        low, high = min(abs(p.error) for p in points), max(abs(p.error) for p in points)
        if low > floor:
            return Unearned(f"errors up to {100 * high:.2g} % are no answers", "give finer sizes")
        return Unearned(f"errors down to {low:.1e} are rounding", "give coarser sizes")
    seen = [observed(a, b, floor) for a, b in pairwise(above)]
    fit = [order is not None and orders[0] - ASTRAY <= order <= orders[1] + ASTRAY for order in seen]
    found = _finest_run([abs(p.error) for p in above], fit)
    if found is None:
        words = ", ".join("a change of sign" if order is None else f"{order:.2f}" for order in seen)
        grows = abs(above[-1].error) >= min(abs(p.error) for p in above[:-1])
        turned = None in seen and abs(above[-1].error) > ROUNDED
        remedy = "give coarser ones" if grows and not turned else finer
        return Unearned(f"errors fall not at order {known} but at {words}", remedy)
    first, last = found
    kept = tuple(order for order in seen[first:last] if order is not None)
    return Stretch(tuple(above[first : last + 1]), kept, len(above) - 1 - last)


def _finest_run(errors: Sequence[float], fit: Sequence[bool]) -> tuple[int, int] | None:
    """First and last of at least LEAST sizes whose steps fit, where no finer size exceeds the last; None without."""
    for last in range(len(errors) - 1, LEAST - 2, -1):
        first = last
        while first and fit[first - 1]:
            first -= 1
        if last - first + 1 >= LEAST and max(errors[last:]) <= errors[last]:
            return first, last
    return None


def crossing(a: Stretch, b: Stretch) -> Crossing | Unearned:
    """Which of two is cheaper, over the errors that both reach."""
    low, high = max(a.span[0], b.span[0]), min(a.span[1], b.span[1])
    if low >= high:
        spans = " and ".join(f"{s.span[0]:.1e} to {s.span[1]:.1e}" for s in (a, b))
        return Unearned(f"both reach no error in common ({spans})", "give sizes that overlap in error")
    inner = {abs(p.error) for s in (a, b) for p in s.points if low < abs(p.error) < high}
    ratios = tuple((error, b.seconds(error) / a.seconds(error)) for error in sorted({low, high} | inner))
    spread = a.spread + b.spread
    return Crossing(low=low, high=high, ratios=ratios, spread=spread, crossings=_changes(ratios, spread))


def _changes(ratios: Sequence[tuple[float, float]], spread: float) -> tuple[float, ...]:
    """Where ratios pass 1 on their way from beyond the spread on one side to beyond it on the other.

    Of several places on one way, which the spread does not tell apart, the middle one.
    """
    logs = [(log(error), log(ratio)) for error, ratio in ratios]
    sure = [i for i, (_, ratio) in enumerate(logs) if abs(ratio) > spread]
    ways = [logs[i : j + 1] for i, j in pairwise(sure) if logs[i][1] * logs[j][1] < 0.0]
    return tuple(exp(met[len(met) // 2]) for met in map(_passed, ways))


def _passed(way: Sequence[tuple[float, float]]) -> list[float]:
    """Where the straight lines between points (x, y) pass y = 0."""
    steps = [(one, other) for one, other in pairwise(way) if (one[1] < 0.0) != (other[1] < 0.0)]
    return [x1 + y1 / (y1 - y2) * (x2 - x1) for (x1, y1), (x2, y2) in steps]
