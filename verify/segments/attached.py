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

from collections.abc import Sequence
from functools import cache

import numpy as np

from verify.arrays import Array, BoolArray, Indices
from verify.segments.links import Chain
from verify.segments.loads import joint_weights

_WIDE = 8
"""Joints that a pair of weights reaches over: shorter chains have the plain ones."""
_FOUR = np.arange(-1, 3)
"""Joints around a link, from its left one."""
_SECOND_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
_NEWTON = 12
_ABOUT = 0.05
"""Relative: so unequal neighbours leave order 2, which unequal links have anyway."""


def felt_at(chain: Chain, positions: Sequence[float], rule: str) -> tuple[Array, Array]:
    """Weights of the joints' positions, (p, N + 1), and of the links' turns, (p, N), for bodies at `positions`, metres.

    At an end that nothing holds the end joint and the end link themselves; the turn of such an end, where it has a
    joint of its own, is not read here (`loaded`).
    """
    n, places = chain.n_segments, np.array(positions, dtype=float) / chain.unit
    links, on, even = places_on(chain.lengths, places)
    deflections, turns = np.zeros((len(places), n + 1)), np.zeros((len(places), n))
    alike = np.flatnonzero(even) if is_mended(rule, n) else np.arange(0)
    if len(alike):
        deflections[alike], turns[alike] = mended(chain.supports, n, links[alike], on[alike])
    for p in set(range(len(places))).difference(alike.tolist()):
        deflections[p], turns[p] = plainly(chain, positions[p], rule, int(links[p]), float(on[p]))
    return deflections, turns


def plainly(chain: Chain, position: float, rule: str, link: int, s: float) -> tuple[Array, Array]:
    """Weights of one place, `s` on `link`: of the rigid link as it is, or those that mending begins from."""
    n, turn = chain.n_segments, np.zeros(chain.n_segments)
    if rule == "reciprocal" and n >= 3:
        place, middles = position / chain.unit, np.cumsum(chain.lengths) - 0.5 * chain.lengths
        after = int(np.clip(np.searchsorted(middles, place), 1, n - 1))
        share = (place - middles[after - 1]) / (middles[after] - middles[after - 1])
        turn[after - 1 : after + 1] = np.clip([1.0 - share, share], 0.0, 1.0)
        return joint_weights(chain, position, rule), turn
    deflection = np.zeros(n + 1)
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

    Links of `lengths` (N,), from the left end, in the unit of places. A place that is a joint to rounding is that
    joint.
    """
    n = len(lengths)
    nodes = np.append(0.0, np.cumsum(lengths))
    places = np.clip(places, 0.0, nodes[-1])
    nearest = abs(nodes[:, None] - places).argmin(axis=0)
    links = np.clip((nodes[:, None] <= places).sum(axis=0) - 1, 0, n - 1)
    joint = abs(nodes[nearest] - places) < 1e-9
    links = np.where(joint, np.minimum(nearest, n - 1), links)
    on = np.where(joint, nearest - links, (places - nodes[links]) / lengths[links])
    near = lengths[np.clip(links + np.arange(-4, 5)[:, None], 0, n - 1)]
    return links, on, np.asarray(np.ptp(near, axis=0) < _ABOUT * near[0])


def mended(supports: tuple[str, str], n: int, links: Indices, s: Array) -> tuple[Array, Array]:
    """The reciprocal weights of places, (p, N + 1) and (p, N), mended; symmetric about each and continuous in s.

    Places are told by their links and where on them, 0 to 1, (p,) both.
    """
    reflects = [support in ("pinned", "guided") for support in supports]
    at = np.minimum(np.maximum(links[:, None] + _FOUR, -9 if reflects[0] else 2), n + 9 if reflects[1] else n - 2)
    first, places = at[:, :1] - 2, np.arange(len(s))[:, None]
    shares = np.stack([1.0 - s, s], axis=1)
    columns = at[:, :, None] - at[:, :1, None] + np.arange(5)
    fourths, lagrange = np.zeros((len(s), 4, _WIDE)), np.zeros((len(s), 2, _WIDE))
    fourths[places[:, :, None], np.arange(4)[:, None], columns] = _SECOND_DIFFERENCE
    fives = shares[:, :, None, None] * _five((links + s)[:, None] - at[:, 1:3])
    for row in (0, 1):
        lagrange[places[:, :, None], np.arange(2)[:, None], columns[:, [1 + row]]] += fives[:, row]
    before, after = shares[:, :1], shares[:, 1:]
    even = before * fourths[:, 1] + after * fourths[:, 2]
    odd = before * (fourths[:, 2] - fourths[:, 0]) + after * (fourths[:, 3] - fourths[:, 1])
    bending = _bending()
    slopes = _without_self(lagrange[:, 1], odd, bending)
    values = _without_selves(lagrange[:, 0], np.stack([even, odd], axis=1), bending, slopes @ bending)
    deflections, turning = _folded(supports, n, first, np.stack([values, slopes]))
    # a slope's weights add up to nothing, for which joints that a support holds give what is missing
    turning[places[:, 0], np.where(2 * first[:, 0] < n, 0, n)] -= turning.sum(axis=1)
    turns = -np.cumsum(turning, axis=1)[:, :-1]
    link = np.arange(n)
    turns[(link < first) | (link > at[:, 3:] + 1)] = 0.0  # but for the rounding of the sum
    for end, support in zip((0, n), supports, strict=True):
        if support == "free" and (there := links + s == end).any():
            deflections[there], turns[there] = np.eye(n + 1)[end], np.eye(n)[min(end, n - 1)]
    return deflections, turns


@cache
def _bending() -> Array:
    """How a chain under forces on its joints bends, (8, 8), in l^3/EI."""
    apart = abs(np.subtract.outer(np.arange(_WIDE), np.arange(_WIDE))).astype(float)
    return np.asarray((apart**3 - apart) / 12.0)


def _five(s: Array) -> Array:
    """Weights of five joints -2..2 for w and w' at s, right for powers up to 4, of y + l^2 y''/12, (..., 2, 5)."""
    square = s * s
    powers = np.stack([np.ones_like(s), s, square, square * s, square * square], axis=-1)
    return np.asarray((powers @ _of_powers()).reshape(*s.shape, 2, 5))


@cache
def _of_powers() -> Array:
    """What those weights have of the powers 0 to 4 of s, (5, 10): of w, then of w'; kept, for reading alone."""
    value, slope = np.eye(5), np.zeros((5, 5))
    for p in range(1, 5):
        slope[p - 1, p] = p
        if p > 1:
            value[p - 2, p] = p * (p - 1) / 12.0
        if p > 2:
            slope[p - 3, p] = p * (p - 1) * (p - 2) / 12.0
    inverse = np.linalg.inv(np.vander(np.arange(-2.0, 3.0), increasing=True))
    return np.asarray(np.hstack([value @ inverse, slope @ inverse]))


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

    Newton from none, on the amounts x: c + 2 b x + x A x and d + g x. Where a place leaves no such shares, next to an
    end, its weights as they are.
    """
    own = np.concatenate([shares, weights[:, None]], axis=1)
    forms, (g0, g1, d) = own @ kernel @ np.swapaxes(own, 1, 2), (own @ other[:, :, None])[:, :, 0].T
    a00, a01, a11, b0, b1, c = (forms[:, i, j] for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)))
    x0, x1, moved = np.zeros_like(c), np.zeros_like(c), np.full_like(c, np.inf)
    for _ in range(_NEWTON):
        h0, h1 = a00 * x0 + a01 * x1 + b0, a01 * x0 + a11 * x1 + b1
        errors = (h0 + b0) * x0 + (h1 + b1) * x1 + c, g0 * x0 + g1 * x1 + d
        step0, step1 = _solved((2.0 * h0, 2.0 * h1, g0, g1), errors)
        going = moved >= 1e-14
        x0, x1 = x0 - going * step0, x1 - going * step1
        moved = np.where(going, np.maximum(abs(step0), abs(step1)), moved)
        if (moved < 1e-14).all():
            break
    amounts = np.stack([x0, x1], axis=1) * (moved < 1e-14)[:, None]
    return np.asarray(weights + (amounts[:, None] @ shares)[:, 0])


def _solved(matrices: tuple[Array, Array, Array, Array], right: tuple[Array, Array]) -> tuple[Array, Array]:
    """A x = b of two unknowns each, (p,) all; where A is singular to 1e-9 the shortest of the nearest, A^T b/|A|^2."""
    (a, b, c, d), (e, f) = matrices, right
    determinant, size = a * d - b * c, a * a + b * b + c * c + d * d
    apart = abs(determinant) > 1e-9 * size
    if apart.all():
        return (d * e - b * f) / determinant, (a * f - c * e) / determinant
    by, size = np.where(apart, determinant, 1.0), np.where(size > 0.0, size, 1.0)
    x, y = np.where(
        apart, [(d * e - b * f) / by, (a * f - c * e) / by], [(a * e + c * f) / size, (b * e + d * f) / size]
    )
    return x, y


def shear_give(weights: Array) -> float:
    """How much less a chain slips under a force and where it acts than a beam, in l/(kappa G A), by joint weights."""
    there = np.flatnonzero(weights)
    apart, near = abs(np.subtract.outer(there, there)), weights[there]
    lacking = near @ (0.5 * apart + 0.25 * np.eye(len(there))) @ near
    return max(float(lacking), 0.0)


def _folded(supports: tuple[str, str], n: int, first: Indices, weights: Array) -> Array:
    """Weights (k, p, w) of joints `first` (p, 1) and after as those of joints 0..N, by the ends' reflections."""
    joints = first + np.arange(weights.shape[2])
    signs = [-1.0 if support == "pinned" else 1.0 for support in supports]
    weights = weights * np.where(joints < 0, signs[0], np.where(joints > n, signs[1], 1.0))
    rows = np.arange(weights.shape[0] * weights.shape[1]).reshape(*weights.shape[:2], 1)
    places = rows * (n + 1) + np.where(joints > n, 2 * n - joints, abs(joints))
    found = np.bincount(places.ravel(), weights.ravel(), rows.size * (n + 1))
    return np.asarray(found.reshape(*weights.shape[:2], n + 1), dtype=float)
