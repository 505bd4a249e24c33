"""Judgement: modes paired, errors, observed order, two-sided bounds. Sees arrays, knows no model."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import isfinite
from typing import TypeVar

import numpy as np

from verify.analysis.bracket import Bracket
from verify.arrays import Array, Indices
from verify.errors import InputError, NoBracketError, NoFigureError
from verify.linear.modes import Modes
from verify.linear.search import zero_between

ASTRAY = 1.0
"""Largest difference between observed orders, and from the known one."""

T = TypeVar("T", float, complex)
EIGENVALUE_FLOOR = 2e-14
"""Relative frequency error that rounding may leave (measured: 1.1e-14 up to 10^4 segments or elements)."""
ORDER_FLOOR = 50 * EIGENVALUE_FLOOR
"""Below this an error is too close to rounding to speak of an order."""
ASTRAY = 1.0
"""How far orders between neighbouring sizes may lie apart in the asymptotic range."""
RESTING = 1e-11
"""Share of its typical size below which a shape is at rest: mode 3 of a pinned beam at the nodes of three parts."""
LIKENESS = 0.5
"""A mode pairs with an exact one only above this MAC."""
HARDLY = 0.8
"""Below it what pairs is hardly a mode of the beam as it is held: a clamped beam's first shapes have 0.62 and 0.75 with
a cantilever's nearest, mode 6 of a cantilever of twenty links 0.996 with its own."""


def relative_error(value: T, exact: T) -> T:
    """(value - exact) / exact, signed or complex. Raises NoFigureError where the exact figure is zero."""
    check_reference(exact)
    return (value - exact) / exact


def check_reference(exact: complex) -> None:
    """Raise NoFigureError for an exact figure that no error can be relative to."""
    if not exact or not np.isfinite(exact):
        raise NoFigureError(
            f"the exact figure is {'infinite' if exact else 'zero'}, so that no error is relative to it: change the "
            "drive, or ask elsewhere"
        )


def mac(reference: Array, shapes: Array) -> Array:
    """Modal assurance criterion of every pair, (n_reference, n_shapes), 0 to 1; shapes are (n, n_points).

    Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003).
    """
    cross = reference @ shapes.T
    squares = np.einsum("ij,ij->i", reference, reference)[:, None] * np.einsum("ij,ij->i", shapes, shapes)
    likeness: Array = np.divide(cross**2, squares, out=np.zeros_like(cross), where=squares > 0.0)
    return likeness  # one at rest is like none


def pair_modes(likeness: Array) -> tuple[Indices, Array]:
    """For every exact mode the index of its computed mode, one to one, and their MAC: (n_reference,) each.

    The pairing with the largest sum of MAC values; `likeness` is (n_reference, n_shapes).
    """
    if (likeness.argmax(axis=1) == np.arange(len(likeness))).all():
        index = np.arange(len(likeness))  # every mode is most like its own number: nothing to search
    else:
        from scipy.optimize import linear_sum_assignment

        index = np.asarray(linear_sum_assignment(-likeness)[1])
    return index, likeness[np.arange(len(index)), index]


def paired_index(modes: Modes, exact_shapes: Array, mode: int, stride: int) -> int:
    """The index in `modes` of the mode that looks like exact mode `mode`.

    exact_shapes (n_modes, n_points) at modes.points[::stride]. Raises InputError where none does.
    """
    index, likeness = pair_modes(mac(exact_shapes, modes.sampled()[:, ::stride]))
    if likeness[mode - 1] < LIKENESS:
        raise InputError(
            f"mode = {mode}: no {modes.model} mode at count = {modes.count} has its shape "
            f"(best MAC {likeness[mode - 1]:.2f}), raise count"
        )
    return int(index[mode - 1])


def node_weights(nodes: Array) -> Array:
    """Trapezoidal weights of positions in ascending order, (n_nodes,)."""
    gaps = np.diff(nodes)
    weights = np.zeros(len(nodes))
    weights[:-1] += 0.5 * gaps
    weights[1:] += 0.5 * gaps
    return weights


def shape_error(exact: Array, computed: Array, weights: Array, typical: float = 0.0) -> float:
    """Relative L2 distance of two mass-normalised shapes, free of sign; all (n_nodes,).

    `typical` is what such a shape has elsewhere: what is RESTING of it at every node is rounding. Raises
    NoFigureError where the exact shape is at rest at every node.
    """
    size = float(weights @ exact**2)
    if size <= (RESTING * typical) ** 2 * float(weights.sum()):
        raise NoFigureError("count: the exact shape is at rest at every node of so few parts, give more")
    distances = [float(weights @ (computed * sign - exact) ** 2) for sign in (1.0, -1.0)]
    return float(np.sqrt(min(distances) / size))


def zeros(shape: Callable[[Array], Array], length: float, mode: int) -> Array:
    """Where a shape crosses zero between the ends of the beam, (n_zeros,), metres, ascending.

    `shape` takes (n,) positions. Sampled 40 times per mode number, then Brent's method.
    """
    margin = 1e-4 / mode  # the ends themselves are supports, not nodes
    x = np.linspace(margin * length, (1.0 - margin) * length, 40 * mode + 1)
    above = shape(x) >= 0
    turns = np.flatnonzero(above[:-1] != above[1:])

    def at(position: float) -> float:
        return float(shape(np.array([position]))[0])

    return np.array([zero_between(at, float(x[i]), float(x[i + 1]), 1e-14 * length, 1e-14) for i in turns])


def observed_order(counts: Sequence[float], errors: Sequence[complex], told: str = "") -> float:
    """Minus the least-squares slope of log |error| over log count; `errors` signed, or complex.

    `told` is what was asked for where it is not counts: 'steps = [...]'. Raises InputError for fewer than three sizes,
    equal sizes, an error that changes its sign, or turns by more than a right angle (then no power of the count
    describes it), or one at the rounding floor.
    """
    told = told or f"counts = {list(counts)}"
    sizes, values = np.asarray(counts, dtype=float), np.asarray(errors, dtype=complex)
    if len(sizes) < 3 or len(set(counts)) != len(sizes):
        raise InputError(f"{told}: an observed order needs three or more different sizes")
    if not np.isfinite(values).all():
        raise InputError(f"{told}: an error that is not finite is rounding, or of an infinite figure: ask for another")
    if (abs(values) < ORDER_FLOOR).any():
        raise InputError(
            f"{told}: an error of {abs(values).min():.1e} is rounding (floor {ORDER_FLOOR:.0e}), "
            "use coarser sizes or a higher mode"
        )
    if (np.outer(values, values.conj()).real < 0.0).any():
        raise InputError(f"{told}: the error changes sign between them, so it has no order there")
    return float(-np.polyfit(np.log(sizes), np.log(abs(values)), 1)[0])


def settled_order(counts: Sequence[float], errors: Sequence[complex], due: int | None = None, told: str = "") -> float:
    """`observed_order` of errors that fall from size to size at orders within ASTRAY of the one that is due.

    Of each other where nobody knows that one. Raises InputError where they do not: sizes are too coarse, or the error
    is about to change its sign, and a slope through them is no order.
    """
    found = observed_order(counts, errors, told)
    by_size = sorted(zip(counts, np.abs(errors), strict=True))
    orders = [float(np.log(e / f) / np.log(m / n)) for (n, e), (m, f) in pairwise(by_size)]
    low, high = (min(orders), max(orders)) if due is None else (due, due)
    if min(orders) <= 0.0 or max(orders) - low > ASTRAY or high - min(orders) > ASTRAY:
        seen = ", ".join(f"{order:.2f}" for order in orders)
        raise InputError(
            f"{told or f'counts = {list(counts)}'}: the error falls at no settled order between them ({seen}"
            f"{'' if due is None else f', where {due} is due'}), near a change of sign or too coarse: give others"
        )
    return found


def bracket(below: float, above: float) -> Bracket:
    """The bound made of a value known to lie below and one known to lie above. Raises NoBracketError."""
    width = (above - below) / above
    if not isfinite(width) or width <= 10 * EIGENVALUE_FLOOR:
        raise NoBracketError(
            f"bracket from {below!r} to {above!r} is thinner than the eigenvalue error ({EIGENVALUE_FLOOR:.0e}) "
            "allows: use a smaller count"
        )
    return Bracket(below, above)
