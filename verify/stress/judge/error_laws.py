"""What error laws say of clamped ends, against sums in 60 digits and sizes gone through one by one."""

from decimal import Decimal, localcontext
from math import pi, sqrt

import numpy as np

from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.laws import exact_root
from verify.stress.references.beams import held
from verify.stress.references.decimals import cos, exp, sin

GREGORY = (Decimal(3) / 8 - 1, Decimal(7) / 6 - 1, Decimal(23) / 24 - 1)
"""His weights of the first three joints, over 1."""
PAIRS: tuple[tuple[str, str], ...] = (
    ("clamped", "free"),
    ("clamped", "clamped"),
    ("clamped", "pinned"),
    ("free", "free"),
    ("guided", "pinned"),
)


def moment(z: Decimal) -> Decimal:
    """At a clamped end of a long beam, over its mean square far from there."""
    return cos(z) - sin(z) + exp(-z)


def residual(mu: float) -> Decimal:
    """Gregory's sum of squared moments over the joints from a wall on less their integral.

    Squared, 1 - sin 2z + 2 e^-z (cos z - sin z) + e^-2z, whose sums over z = k mu are geometric ones: of what goes on
    for good a half is left of 1, and (cot mu)/2 - 1/(2 mu) of the sine.
    """
    with localcontext() as context:
        context.prec = 50
        step = Decimal(mu)
        falling = exp(-step)
        along, across = falling * cos(step), falling * sin(step)
        size = (1 - along) ** 2 + across**2
        found = Decimal("0.5") - (cos(step) / sin(step) / 2 - 1 / (2 * step))
        found += 2 * (1 - along - across) / size + 1 / (1 - falling**2) - 1 / (2 * step)
        return found + sum(more * moment(k * step) ** 2 for k, more in enumerate(GREGORY))


def residual_error(mu: float) -> float:
    """Of it, over mu^4 / 6."""
    from verify.exact.error_laws import wall_residual

    with localcontext() as context:
        context.prec = 50
        return abs(float((Decimal(wall_residual(mu)) - residual(mu)) / (Decimal(mu) ** 4 / 6)))


def own_error(model: str, mu: float) -> float:
    """Of a wave along equal parts of mu radians each, by the equations of a node: rigid links, Hermite elements."""
    if model == "segment":
        square = sin_half(mu)
        return sqrt(48.0 * square**2 / (3.0 - 2.0 * square)) / mu**2 - 1.0
    c, s = np.cos(mu), np.sin(mu)
    stiff = np.array([[24.0 - 24.0 * c, -12.0 * s], [-12.0 * s, 8.0 + 4.0 * c]])
    mass = np.array([[312.0 + 108.0 * c, 26.0 * s], [26.0 * s, 8.0 - 6.0 * c]]) / 420.0
    return sqrt(float(np.linalg.eigvals(np.linalg.solve(mass, stiff)).real.min())) / mu**2 - 1.0


def sin_half(mu: float) -> float:
    """Its square."""
    return float(np.sin(0.5 * mu) ** 2)


def terms(model: str, pair: tuple[str, str], mode: int, count: int) -> tuple[float, float]:
    """(the error of the waves, what clamped ends add)."""
    mu = float(exact_root(pair, mode)) / count
    clamps = pair.count("clamped") * (model == "segment")
    return own_error(model, mu), -0.5 * clamps * float(residual(mu)) / count


def law_error(mode: float) -> float:
    """Of expected errors of both models between three pairs of ends, over their terms; 1 where none should be told."""
    from verify.exact.error_laws import expected_error, has_law, is_kept

    worst, number = 0.0, int(mode)
    for pair in PAIRS:
        beam, y = held(*pair), float(exact_root(pair, number))
        for model, count in (("segment", 2 * number + 9), ("segment", 47 * number), ("fem", 3 * number + 2)):
            own, walls = terms(model, pair, number, count)
            size = abs(own) + abs(walls)
            worst = largest(worst, abs(expected_error(model, beam, number, count) - own - walls) / size)
            for share, kept in ((0.33, True), (0.34, False), (-0.33, True), (-0.34, False)):
                found = is_kept(model, beam, number, count, own + walls + share * size, 0.0)
                worst = largest(worst, float(found is not kept))
        edge = y / (2.5 if "free" in pair or "clamped" in pair else pi)
        spoken = (has_law(beam, number, int(edge) + 1), has_law(beam, number, int(edge)))
        worst = largest(worst, float(spoken != (True, False)))
    return worst


def certain_error(mode: float) -> float:
    """Of sizes from which on all errors are sure to lie within another, gone through from where the law speaks on."""
    from verify.exact.error_laws import certain_from

    wrong, number = 0.0, int(mode)
    for pair in PAIRS:
        beam, y = held(*pair), float(exact_root(pair, number))
        for model, error in (("segment", 0.3), ("segment", 3e-4), ("segment", 1e-5), ("fem", 2e-3), ("fem", 1e-6)):
            clamps, count = pair.count("clamped") * (model == "segment"), max(20, int(y / 2.5) + 1, number + 1)
            while 4.0 / 3.0 * (abs(own_error(model, y / count)) + clamps * (y / count) ** 4 / 12.0 / count) > error:
                count += 1
            wrong += abs(certain_from(model, beam, number, error) - count)
    return wrong


ROWS: tuple[Row, ...] = (
    Floor(
        id="sums-at-a-wall",
        title="What Gregory's sum at a clamped end has more than its integral, over mu^4 / 6",
        why="exact/error_laws.py: a series below mu = 0.2, where sums cancel to 3e-4 of themselves; in 50 digits.",
        along="radians",
        at=(0.03, 0.11, 0.199, 0.21, 0.6, 1.4, 2.4),
        promise=1e-10,
        error=residual_error,
    ),
    Floor(
        id="expected-errors",
        title="Errors that laws expect of links and elements between five pairs of ends, and where they speak",
        why="exact/error_laws.py: a node's equations, and at walls the same sums; a third of both terms is left to it.",
        along="mode",
        at=(2, 7),
        promise=1e-6,
        error=law_error,
    ),
    Floor(
        id="sizes-that-are-certain",
        title="Sizes from which on the law is certain of an error, gone through one by one",
        why="exact/error_laws.py: the first that does of those where the law speaks.",
        along="mode",
        at=(1, 4, 9),
        promise=0.5,
        error=certain_error,
    ),
)
