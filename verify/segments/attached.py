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

from verify.models.arrays import Array, BoolArray, Indices
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
    n, place = chain.n_segments, position / chain.unit - chain.start
    links, on, even = places_on(chain.lengths[:, None], np.array([place]))
    if is_mended(rule, n) and even[0]:
        deflections, turns = mended(chain.supports, n, links, on)
        return deflections[0], turns[0]
    deflection, turn, link, s = np.zeros(n + 1), np.zeros(n), int(links[0]), float(on[0])
    if rule == "reciprocal" and n >= 3:
        middles = np.cumsum(chain.lengths) - 0.5 * chain.lengths
        after = int(np.clip(np.searchsorted(middles, place), 1, n - 1))
        share = (place - middles[after - 1]) / (middles[after] - middles[after - 1])
        turn[after - 1 : after + 1] = np.clip([1.0 - share, share], 0.0, 1.0)
        return joint_weights(chain, position, rule), turn
    deflection[link], deflection[link + 1] = 1.0 - s, s
    turn[link] = 1.0
    if link > 0 and s == 0.0:
        turn[link - 1 : link + 1] = 0.5
    return deflection, turn


def is_mended(rule: str, n: int) -> bool:
    """Whether a chain of n links has mended weights where they are about equally long."""
    return rule == "reciprocal" and n >= _WIDE


def places_on(lengths: Array, places: Array) -> tuple[Indices, Array, BoolArray]:
    """(links, where on them, 0 to 1, whether links around are about equally long) of places, (p,) all.

    `lengths` (N, p) are those of each place's own chain, from whose left end it is told in the same unit. A place that
    is a joint to rounding is that joint.
    """
    n, every = len(lengths), np.arange(len(places))
    nodes = np.concatenate([np.zeros_like(lengths[:1]), np.cumsum(lengths, axis=0)])
    places = np.clip(places, 0.0, nodes[-1])
    nearest = abs(nodes - places).argmin(axis=0)
    links = np.clip((nodes <= places).sum(axis=0) - 1, 0, n - 1)
    joint = abs(nodes[nearest, every] - places) < 1e-9
    links = np.where(joint, np.minimum(nearest, n - 1), links)
    on = np.where(joint, nearest - links, (places - nodes[links, every]) / lengths[links, every])
    near = lengths[np.clip(links + np.arange(-4, 5)[:, None], 0, n - 1), every]
    return links, on, np.asarray(np.ptp(near, axis=0) < _ABOUT * near[0])


def mended(supports: tuple[str, str], n: int, links: Indices, s: Array) -> tuple[Array, Array]:
    """The reciprocal weights of places, (p, N + 1) and (p, N), mended; symmetric about each and continuous in s.

    Places are told by their links and where on them, 0 to 1, (p,) both.
    """
    reflects = [support in ("pinned", "guided") for support in supports]
    at = links[:, None] + np.arange(-1, 3)
    at = np.clip(at, -9 if reflects[0] else 2, n + 9 if reflects[1] else n - 2)
    first, centres = at[:, 0] - 2, at - at[:, :1]
    lagrange, fourths = np.zeros((len(s), 2, _WIDE)), np.zeros((len(s), 4, _WIDE))
    places, own = np.arange(len(s))[:, None], np.arange(5)
    for row in range(4):
        fourths[places, row, centres[:, [row]] + own] = _SECOND_DIFFERENCE
    for row, share in ((1, 1.0 - s), (2, s)):
        five = share[:, None, None] * _five(links + s - at[:, row])
        for which in (0, 1):
            lagrange[places, which, centres[:, [row]] + own] += five[:, which]
    even = (1.0 - s)[:, None] * fourths[:, 1] + s[:, None] * fourths[:, 2]
    odd = (1.0 - s)[:, None] * (fourths[:, 2] - fourths[:, 0]) + s[:, None] * (fourths[:, 3] - fourths[:, 1])
    apart = abs(np.subtract.outer(np.arange(_WIDE), np.arange(_WIDE))).astype(float)
    bending = (apart**3 - apart) / 12.0
    slopes = _without_self(lagrange[:, 1], odd, bending)
    values = _without_selves(lagrange[:, 0], np.stack([even, odd], axis=1), bending, slopes @ bending)
    turns = -np.cumsum(_folded(supports, n, first, slopes, True), axis=1)[:, :-1]
    link, begin = np.arange(n), np.maximum(first, 0)[:, None]
    turns[(link < begin) | (link >= begin + at[:, -1:] - first[:, None] + 3)] = 0.0  # but for the rounding of the sum
    deflections = _folded(supports, n, first, values, False)
    for free, end in ((supports[0] == "free", 0), (supports[1] == "free", n)):
        if free and (there := links + s == end).any():
            deflections[there], turns[there] = np.eye(n + 1)[end], np.eye(n)[min(end, n - 1)]
    return deflections, turns


def _five(s: Array) -> Array:
    """Weights of five joints -2..2 for w and w' at s, right for powers up to 4, of y + l^2 y''/12, (p, 2, 5)."""
    value = [s**p + p * (p - 1) / 12.0 * s ** max(p - 2, 0) for p in range(5)]
    slope = [p * s ** max(p - 1, 0) + p * (p - 1) * (p - 2) / 12.0 * s ** max(p - 3, 0) for p in range(5)]
    return np.asarray(np.moveaxis(np.array([value, slope]), 2, 0) @ _of_powers())


@cache
def _of_powers() -> Array:
    """What weights of joints -2..2 are of the sums of powers 0 to 4 that they give, (5, 5); kept, for reading alone."""
    return np.asarray(np.linalg.inv(np.vander(np.arange(-2.0, 3.0), increasing=True)))


def _without_self(weights: Array, shares: Array, kernel: Array) -> Array:
    """Weights (p, w) with the smallest shares that make their quadratic forms zero, or least where none does."""
    pairs = ((shares, shares), (weights, shares), (weights, weights))
    a, b, c = ((one @ kernel * other).sum(axis=1) for one, other in pairs)
    root = b * b - a * c
    there, real = abs(a) >= 1e-12, root >= 0.0
    with np.errstate(invalid="ignore", divide="ignore"):
        amount = np.where(real, -c / (b + np.copysign(np.sqrt(np.where(real, root, 0.0)), b)), -b / a)
    return np.asarray(weights + np.where(there, amount, 0.0)[:, None] * shares)


def _without_selves(weights: Array, shares: Array, kernel: Array, other: Array) -> Array:
    """Weights (p, w) with shares (p, 2, w) that make their quadratic forms and products with `other` (p, w) zero.

    Newton from none. Where a place leaves no such shares, next to an end, its weights as they are.
    """
    found, open_ = weights.copy(), np.arange(len(weights))
    for _ in range(_NEWTON):
        own, against = found[open_], other[open_]
        carried, of_own = own @ kernel, shares[open_]
        errors = np.stack([(carried * own).sum(axis=1), (own * against).sum(axis=1)], axis=1)
        slopes = np.stack(
            [2.0 * (of_own @ carried[:, :, None])[..., 0], (of_own @ against[:, :, None])[..., 0]], axis=1
        )
        step = _solved(slopes, errors)
        found[open_] = own - (step[:, None] @ of_own)[:, 0]
        open_ = open_[~(abs(step).max(axis=1) < 1e-14)]
        if not len(open_):
            return found
    found[open_] = weights[open_]
    return found


def _solved(matrices: Array, right: Array) -> Array:
    """A x = b of two unknowns each, (p, 2), the shortest of the nearest where an A is singular to 1e-9."""
    a, b, c, d = matrices.reshape(-1, 4).T
    determinant = a * d - b * c
    apart = abs(determinant) > 1e-8 * (a * a + b * b + c * c + d * d)
    first, second = right.T
    found = np.stack([d * first - b * second, a * second - c * first], axis=1)
    found /= np.where(apart, determinant, 1.0)[:, None]
    for p in np.flatnonzero(~apart):
        found[p] = np.linalg.lstsq(matrices[p], right[p], rcond=1e-9)[0]
    return np.asarray(found)


def shear_give(weights: Array) -> float:
    """How much less a chain slips under a force and where it acts than a beam, in l/(kappa G A), by joint weights."""
    there = np.flatnonzero(weights)
    apart, near = abs(np.subtract.outer(there, there)), weights[there]
    lacking = near @ (0.5 * apart + 0.25 * np.eye(len(there))) @ near
    return max(float(lacking), 0.0)


def _folded(supports: tuple[str, str], n: int, first: Indices, weights: Array, slope: bool) -> Array:
    """Weights (p, w) of joints `first` (p,) and after as those of joints 0..N, by the ends' reflections, (p, N + 1).

    A slope's add up to nothing, for which joints that a support holds give what is missing.
    """
    folded, places = np.zeros((len(first), n + 1)), np.arange(len(first))
    signs = [-1.0 if support == "pinned" else 1.0 for support in supports]
    for column in range(weights.shape[1]):
        joint = first + column
        sign = np.where(joint < 0, signs[0], np.where(joint > n, signs[1], 1.0))
        folded[places, np.where(joint > n, 2 * n - joint, abs(joint))] += sign * weights[:, column]
    if slope:
        folded[places, np.where(2 * first < n, 0, n)] -= folded.sum(axis=1)
    return folded


def rows_at(chain: Chain, positions: list[float], rule: str) -> tuple[Any, Any]:
    """`felt_at` of several places, (p, N + 1) and (p, N)."""
    pairs = [felt_at(chain, position, rule) for position in positions]
    n = chain.n_segments
    return np.array([f for f, _ in pairs]).reshape(-1, n + 1), np.array([h for _, h in pairs]).reshape(-1, n)
