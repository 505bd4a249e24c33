"""Where a body or a spring is felt on a chain of rigid links: weights of the joints' positions and of the links' turns.

The lever rule takes the rigid link as it is. A couple then makes a jump in the moment, which the joints' quadrature of
M^2/EI meets anywhere in its step: order 1, but for the middle of a link, where it is 2.

The reciprocal rule. With y = w - l^2 w''/12 a chain is a beam to order 4 (`reading`), so w and w' are read from the
joints by weights f, g that are right for w = x^p, p = 0..4, and forces and couples act through the same weights. That
makes what one body feels of another right to order 4. What it feels of itself is a constant of the weights: a chain
under unit forces on its joints bends like G(d) = (d^3 - d)/12 l^3/EI over d links (delta^4 G = 1 at 0), the beam like
d^3/12, so that f, g are right only where

    sum f_i f_j G(i - j) = 0,  sum g_i g_j G(i - j) = 0,  sum f_i g_j G(i - j) = 0.

Lagrange's weights have 0.007 l^3/EI, -0.16 l/EI and 0.01 l^2/EI there: order 3 for a mass, 1 for a rotary inertia. A
share of fourth and fifth differences, which no power up to the third and fourth feels, mends all three: order 4.
Under Timoshenko's theory a chain also slips, like -d/2 l/(kappa G A) and -1/4 at d = 0, where the joint under a force
has the mean of the shear on either side: too little, by `shear_give`. No weights of a fair size mend that. A body that
stands on as much of a slip of its own does: order 2, as everything there.
"""

from functools import cache
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.segments.links import Chain
from verify.segments.loads import joint_weights

_WIDE = 8
"""Joints that a pair of weights reaches over: shorter chains have the plain ones."""
_SECOND_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
_NEWTON = 12
_ABOUT = 0.05
"""Relative: so unequal neighbours leave order 2, which unequal links have anyway."""


def felt_at(chain: Chain, position: float, rule: str) -> tuple[Array, Array]:
    """Weights of the joints' positions, (N + 1,), and of the links' turns, (N,), for a body at `position` (metres).

    At an end that nothing holds the end joint and the end link themselves; the turn of such an end, where it has a
    joint of its own, is not read here (`loaded`).
    """
    n, place, link, s = _place(chain, position)
    deflection, turn = np.zeros(n + 1), np.zeros(n)
    if rule == "reciprocal" and n >= _WIDE and _even(chain, link):
        return _mended(chain, link, s)
    if rule == "reciprocal" and n >= 3:
        middles = np.cumsum(chain.lengths) - 0.5 * chain.lengths
        return joint_weights(chain, position, rule), np.array([np.interp(place, middles, row) for row in np.eye(n)])
    deflection[link], deflection[link + 1] = 1.0 - s, s
    turn[link] = 1.0
    if link > 0 and s == 0.0:
        turn[link - 1 : link + 1] = 0.5
    return deflection, turn


def _place(chain: Chain, position: float) -> tuple[int, float, int, float]:
    """N, the place in units, its link and where on it, 0 to 1; a place that is a joint to rounding is that joint."""
    n, nodes = chain.n_segments, chain.nodes / chain.unit
    place = float(np.clip(position / chain.unit, nodes[0], nodes[-1]))
    nearest = int(abs(nodes - place).argmin())
    if abs(nodes[nearest] - place) < 1e-9:
        link = min(nearest, n - 1)
        return n, float(nodes[nearest]), link, float(nearest - link)
    link = int(np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, n - 1))
    return n, place, link, float((place - nodes[link]) / chain.lengths[link])


def _even(chain: Chain, link: int) -> bool:
    """Whether the links around are about equally long."""
    near = chain.lengths[max(link - 4, 0) : link + 5]
    return bool(np.ptp(near) < _ABOUT * near[0])


def _mended(chain: Chain, link: int, s: float) -> tuple[Array, Array]:
    """The reciprocal weights of a place, mended; symmetric about it and continuous in s."""
    n = chain.n_segments
    if chain.supports[0] == "free" and link + s == 0.0:
        return np.eye(n + 1)[0], np.eye(n)[0]
    if chain.supports[1] == "free" and link + s == n:
        return np.eye(n + 1)[n], np.eye(n)[n - 1]
    ends = [support in ("pinned", "guided") for support in chain.supports]
    lowest, highest = -9 if ends[0] else 2, n + 9 if ends[1] else n - 2
    at = np.clip(np.arange(link - 1, link + 3), lowest, highest)
    first = int(at[0]) - 2
    width = int(at[-1]) - first + 3
    lagrange = np.zeros((2, width))
    for centre, share in ((at[1], 1.0 - s), (at[2], s)):
        window = slice(centre - 2 - first, centre + 3 - first)
        lagrange[:, window] += share * _five(link + s - centre)
    fourths = np.zeros((4, width))
    for row, centre in zip(fourths, at, strict=True):
        row[centre - 2 - first : centre + 3 - first] = _SECOND_DIFFERENCE
    even = (1.0 - s) * fourths[1] + s * fourths[2]
    odd = (1.0 - s) * (fourths[2] - fourths[0]) + s * (fourths[3] - fourths[1])
    apart = abs(np.subtract.outer(np.arange(width), np.arange(width))).astype(float)
    bending = (apart**3 - apart) / 12.0
    slope = _without_self(lagrange[1], odd, bending)
    value = _without_selves(lagrange[0], np.array([even, odd]), bending, bending @ slope)
    turn = -np.cumsum(_folded(chain, first, slope, True))[:-1]
    turn[: max(first, 0)] = turn[max(first, 0) + width :] = 0.0  # but for the rounding of the sum
    return _folded(chain, first, value, False), turn


def _five(s: float) -> Array:
    """Weights of five joints -2..2 for w and w' at s, right for powers up to the fourth, of y + l^2 y''/12, (2, 5)."""
    value = [s**p + p * (p - 1) / 12.0 * s ** max(p - 2, 0) for p in range(5)]
    slope = [p * s ** max(p - 1, 0) + p * (p - 1) * (p - 2) / 12.0 * s ** max(p - 3, 0) for p in range(5)]
    return np.asarray(np.array([value, slope]) @ _of_powers())


@cache
def _of_powers() -> Array:
    """What weights of joints -2..2 are of the sums of powers 0 to 4 that they give, (5, 5); kept, for reading alone."""
    return np.asarray(np.linalg.inv(np.vander(np.arange(-2.0, 3.0), increasing=True)))


def _without_self(weights: Array, share: Array, kernel: Array) -> Array:
    """The weights with the smallest share that makes their quadratic form zero, or least where none does."""
    a, b, c = share @ kernel @ share, weights @ kernel @ share, weights @ kernel @ weights
    if abs(a) < 1e-12:
        return weights
    root = b * b - a * c
    amount = -b / a if root < 0.0 else -c / (b + np.copysign(np.sqrt(root), b))
    return np.asarray(weights + amount * share)


def _without_selves(weights: Array, shares: Array, kernel: Array, other: Array) -> Array:
    """The weights with shares that make their quadratic form zero, and the product with `other`: Newton from none.

    Where the places leave no such shares, next to an end, the weights as they are.
    """
    found = weights
    for _ in range(_NEWTON):
        errors = np.array([found @ kernel @ found, found @ other])
        slopes = np.array([2.0 * shares @ kernel @ found, shares @ other])
        step = _solved(slopes, errors)
        found = found - step @ shares
        if abs(step).max() < 1e-14:
            return np.asarray(found)
    return weights


def _solved(matrix: Array, right: Array) -> Array:
    """A x = b of two unknowns, the shortest of the nearest where A is singular to 1e-9."""
    (a, b), (c, d) = matrix.tolist()
    determinant = a * d - b * c
    if abs(determinant) <= 1e-8 * (a * a + b * b + c * c + d * d):
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-9)[0])
    first, second = right.tolist()
    return np.asarray(np.array([d * first - b * second, a * second - c * first]) / determinant)


def shear_give(weights: Array) -> float:
    """How much less a chain slips under a force and where it acts than a beam, in l/(kappa G A), by joint weights."""
    there = np.flatnonzero(weights)
    apart, near = abs(np.subtract.outer(there, there)), weights[there]
    lacking = near @ (0.5 * apart + 0.25 * np.eye(len(there))) @ near
    return max(float(lacking), 0.0)


def _folded(chain: Chain, first: int, weights: Array, slope: bool) -> Array:
    """Weights of joints `first`, `first` + 1, ... as those of joints 0..N, by the ends' reflections, (N + 1,).

    A slope's add up to nothing, for which joints that a support holds give what is missing.
    """
    n, folded = chain.n_segments, np.zeros(chain.n_segments + 1)
    signs = [-1.0 if support == "pinned" else 1.0 for support in chain.supports]
    for joint, weight in zip(range(first, first + len(weights)), weights, strict=True):
        if joint < 0:
            folded[-joint] += signs[0] * weight
        elif joint > n:
            folded[2 * n - joint] += signs[1] * weight
        else:
            folded[joint] += weight
    if slope:
        folded[0 if 2 * first < n else n] -= folded.sum()
    return folded


def rows_at(chain: Chain, positions: list[float], rule: str) -> tuple[Any, Any]:
    """`felt_at` of several places, (p, N + 1) and (p, N)."""
    pairs = [felt_at(chain, position, rule) for position in positions]
    n = chain.n_segments
    return np.array([f for f, _ in pairs]).reshape(-1, n + 1), np.array([h for _, h in pairs]).reshape(-1, n)
