"""Bodies within a few links of an end or of each other: weights by which they feel each other as on the beam.

A body's own weights (`attached`) are right where its chain goes on alike for four links either way, and alone. Nearer
to a wall it bends by the wall's joints, nearer to an end by what reflects there, nearer to another body by that one
too: what bodies feel of each other and of themselves is then off by a constant of the weights, so that a short stub
with a rotary inertia on it was wrong by a third.

Weights of joints and turns are moments m_k in the joints, those of a unit force or couple at x that the chain beyond
holds: M = x' - x or 1 for x' > x. Compliances c_k of the joints are the weights of a quadrature, so that

    sum c_k m_k q(k) = integral M q,    sum c_k m_k n_k = integral M N

say that a body feels what stands far away, whose moments q are parabolas here, and any other here, of moment N, as on a
beam. The least m that do the first lack D = integral M N - sum c_k m_k n_k of the second, by Bessel's inequality no
less than nothing. Vectors without a part along any q whose products are D give it. Of all those the nearest to
the weights that each body has alone are taken: where these are right already they stay (orthogonal Procrustes,
Schoenemann, Psychometrika 31 (1966)).

No moment reaches a free or a pinned end: there q is s, s^2 or s, s^3 of the distance s, and 1, s^2 at a guided one.
"""

from collections.abc import Iterator, Sequence
from math import ceil, floor

import msgspec
import numpy as np

from verify.arrays import Array
from verify.segments.attached import felt_at, is_mended, places_on
from verify.segments.links import Chain

_BEFORE, _AFTER = 2, 4
"""Joints before and from a body's link on that are its own to choose."""
_FEWEST = 6
_WALL = 5
"""Joints that a wall's corrections reach over, at most."""
_POWERS = {"pinned": (1, 3), "free": (1, 2), "guided": (0, 2)}
"""Of the distance from an end, in moments from far away."""
_PARABOLA = (0, 1, 2)
_REACH = 8
"""Columns of weights beyond the joints that may be chosen: as many as a body has alone."""
_RIGHT = 1e-7
"""What is so near to what it should be stays as it is."""
_TIE = 1e-10
"""Of what the weights are to be near: added to it, it settles which way to go where two are as near."""
_ABOUT = 0.05


class _Window(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The joints around p bodies that stand near each other or an end, counted from the nearer end, in links."""

    from_right: bool
    first: int
    """The first joint whose moment may be chosen."""
    inner: int
    """The same, from the joint where powers of the distance are taken from."""
    width: int
    """How many moments may be chosen."""
    before: int
    """Joints before the first of them, 1 or 0."""
    powers: tuple[int, ...]
    """Of moments from far away."""
    places: Array
    """(p,), of the bodies, from the joint where powers are taken from."""
    weights: Array
    """(width,), c_k of the joints over what a joint inside has."""

    @property
    def joints(self) -> Array:
        """Those whose moments may be chosen, (width,), likewise."""
        return np.asarray(np.arange(self.width) + float(self.inner))

    @property
    def edge(self) -> float:
        """The first joint after them, likewise."""
        return float(self.inner + self.width)

    def of(self, weights: Array) -> Array:
        """Weights (p, N or N + 1) of the bodies in the window, (p, columns); zeros beyond the other end."""
        start, size = self.first - self.before, self.before + self.width + _REACH
        there = (weights[:, ::-1] if self.from_right else weights)[:, start : start + size]
        return np.pad(there, ((0, 0), (0, size - there.shape[1])))

    def put(self, weights: Array, rows: list[int], found: Array) -> None:
        """Put what is found, (p, columns), in place of some rows of all weights (bodies, N or N + 1)."""
        start, size = self.first - self.before, self.before + self.width + 1
        placed = np.zeros((len(rows), weights.shape[1]))
        placed[:, start : start + size] = found[:, :size]
        weights[rows] = placed[:, ::-1] if self.from_right else placed


def felt_together(chain: Chain, positions: Sequence[float], rule: str) -> tuple[Array, Array]:
    """`felt_at` of all bodies of a chain, (p, N + 1) and (p, N), mended where they stand near an end or each other.

    They stay as they are where links are not about alike, and where a chain is too short for so many.
    """
    felt, turned = felt_at(chain, positions, rule)
    n = chain.n_segments
    if not is_mended(rule, n) or chain.start or not len(felt):
        return felt, turned
    links, on = places_on(chain.lengths, np.array(positions, dtype=float) / chain.unit)[:2]
    places = links + on
    for rows in _groups(n, chain.supports, places.tolist()):
        window = _window(chain, places[rows])
        if window is None:
            continue
        own = window.of(felt[rows]), window.of(turned[rows])
        mended = _mended(window, *own)
        if any((one != other).any() for one, other in zip(mended, own, strict=True)):
            window.put(felt, rows, mended[0])
            window.put(turned, rows, mended[1])
    first = (abs(places[:, None] - places) < 1e-9).argmax(axis=1)  # bodies at one place have the same weights
    return felt[first], turned[first]


def _groups(n: int, supports: tuple[str, str], places: Sequence[float]) -> Iterator[list[int]]:
    """Rows of bodies that stand near each other or an end, one of each place; without those at an end it turns with.

    One on a joint is on both its links, so that bodies are as near seen from the other end.
    """
    rows, groups = dict[float, int](), list[list[int]]()
    ends = {end for end, support in zip((0.0, float(n)), supports, strict=True) if support != "guided"}
    for row, place in enumerate(places):
        if place not in ends:
            rows.setdefault(round(place, 9), row)
    links = {row: (min(floor(place), n - 1), max(ceil(place) - 1, 0)) for place, row in sorted(rows.items())}
    for row, link in links.items():
        last = links[groups[-1][-1]] if groups else link
        if not groups or min(link[0] - last[0], link[1] - last[1]) >= _BEFORE + _AFTER:
            groups.append([])
        groups[-1].append(row)
    for group in groups:
        after, before = links[group[0]]
        if len(group) > 1 or before < _WALL + _BEFORE or after >= n - _WALL - _BEFORE:
            yield group


def _window(chain: Chain, places: Array) -> _Window | None:
    """The joints around bodies at places (p,), in links.

    None where links, or joints but a wall's, are not about alike, or a chain has too few.
    """
    n = chain.n_segments
    from_right = bool(places.sum() > 0.5 * n * len(places))
    support, elastic = chain.supports[from_right], chain.elastic[from_right]
    there = n - places if from_right else places
    before, after = int(there.min()) - _BEFORE, int(there.max()) + _AFTER
    first = max(before, 0 if support in ("clamped", "guided") and not elastic else 1)
    beyond = max(after, first + max(_FEWEST, 3 + 2 * len(places)))
    at_end = first <= 1 and before <= first
    if beyond > n - 3:
        return None
    order = slice(None, None, -1 if from_right else 1)
    seen = slice(max(first - 1, 0), beyond + 1)
    lengths, compliances = chain.lengths[order][seen], chain.compliances[order]
    weights = compliances[first:beyond] / compliances[beyond]
    inside = np.where(np.arange(first, beyond) < _WALL, 1.0, weights)
    if np.ptp(lengths) > _ABOUT * lengths.max() or not (abs(inside - 1.0) <= _ABOUT).all():
        return None
    return _Window(
        from_right=from_right,
        first=first,
        inner=first if at_end else 0,
        width=beyond - first,
        before=int(first > 0),
        powers=_PARABOLA if not at_end or elastic else _POWERS.get(support, _PARABOLA),
        places=there if at_end else there - first,
        weights=weights,
    )


def _mended(window: _Window, felt: Array, turned: Array) -> tuple[Array, Array]:
    """Weights of joints and turns, (p, columns) both, with the products of their bodies on the beam."""
    roots = np.sqrt(window.weights)[:, None]
    far = roots * window.joints[:, None] ** np.array(window.powers)
    seen, products = _of_far(window), _of_each_other(window)
    alone = roots * _moments(window, felt, turned)
    if max(abs(far.T @ alone - seen).max(), abs(alone.T @ alone - products).max()) < _RIGHT:
        return felt, turned
    basis, triangle = np.linalg.qr(far, mode="complete")
    n_far = len(window.powers)
    least, rest = basis[:, :n_far] @ np.linalg.solve(triangle[:n_far].T, seen), basis[:, n_far:]
    values, vectors = np.linalg.eigh(products - least.T @ least)
    lacking = (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    aligned = rest.T @ alone @ lacking
    aligned += _TIE * abs(aligned).max() * np.eye(*aligned.shape)
    left, _, after = np.linalg.svd(aligned, full_matrices=False)
    return _of_moments(window, (least + rest @ (left @ after) @ lacking) / roots, felt.shape[1])


def _of_far(window: _Window) -> Array:
    """Integrals of M q less what joints from `edge` on have of them, (powers, 2 p): of forces, then of couples."""
    x, b, p = window.places, window.edge, np.array(window.powers, dtype=float)[:, None]
    couples = (b ** (p + 1) - x ** (p + 1)) / (p + 1)
    forces = (b ** (p + 2) - x ** (p + 2)) / (p + 2) - x * couples
    return np.hstack([forces - _beyond(b, p + 1) + x * _beyond(b, p), couples - _beyond(b, p)])


def _beyond(b: float, p: Array) -> Array:
    """Joints from b on over the integral of x^p from there on: Euler and Maclaurin's terms, exact up to p = 4."""
    return np.asarray(0.5 * b**p - p * b ** (p - 1) / 12.0 + p * (p - 1) * (p - 2) * b ** (p - 3) / 720.0)


def _of_each_other(window: _Window) -> Array:
    """Integrals of M N less what joints from `edge` on have of them, (2 p, 2 p): of forces, then of couples."""
    to_edge = window.edge - window.places
    one, other = to_edge[:, None], to_edge
    cut, product, total = np.minimum(one, other), one * other, one + other
    forces = product * cut - total * cut**2 / 2.0 + cut**3 / 3.0 - product / 2.0 + total / 12.0
    mixed = one * cut - cut**2 / 2.0 - one / 2.0 + 1.0 / 12.0 + 0.0 * other
    return np.block([[forces, mixed], [mixed.T, cut - 0.5]])


def _moments(window: _Window, felt: Array, turned: Array) -> Array:
    """Moments of weights in the joints that may be chosen, (width, 2 p), of forces, then of couples."""
    felt, turned = felt[:, window.before :], turned[:, window.before :]
    ahead = np.arange(felt.shape[1])[:, None] - np.arange(window.width)
    forces = window.joints[:, None] - window.places + (felt @ np.maximum(ahead, 0)).T
    return np.hstack([forces, 1.0 - (turned @ (ahead >= 0)).T])


def _of_moments(window: _Window, moments: Array, columns: int) -> tuple[Array, Array]:
    """Weights (p, columns) both of moments (width, 2 p): changes of links' forces, and of moments."""
    p, before, width = len(window.places), window.before, window.width
    every = np.zeros((2 * p, before + width + 2))
    every[:, before : before + width] = moments.T
    every[:p, before + width :] = np.arange(2.0) + window.edge - window.places[:, None]
    every[p:, before + width :] = 1.0
    across = np.diff(every)
    felt, turned = np.zeros((p, columns)), np.zeros((p, columns))
    felt[:, : before + width + 1] = np.diff(across[:p], prepend=0.0)
    turned[:, : before + width] = across[p:, :-1]
    return felt, turned
