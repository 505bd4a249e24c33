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

from collections.abc import Hashable, Iterator, Sequence
from math import ceil, floor

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array, BoolArray, Indices
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
_RIGHT = 1e-7
"""What is so near to what it should be stays as it is."""
_TIE = 1e-10
"""Of what the weights are to be near: added to it, it settles which way to go where two are as near."""
_ABOUT = 0.05


class _Stretch(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The joints around bodies that stand near each other, told from the nearer end, in links, of m chains."""

    places: Array
    """(m, p), from joint `origin`, ascending or descending."""
    origin: int
    first: int
    """The first joint whose moments may be chosen, from joint 0."""
    beyond: int
    """The first after them."""
    powers: tuple[int, ...]
    """Of moments from far away, over the distance from `origin`."""
    weights: Array
    """(m, beyond - first), c_k in what a joint inside has."""

    @property
    def joints(self) -> Array:
        """Those that may be chosen, from `origin`."""
        return np.asarray(np.arange(self.first, self.beyond) - float(self.origin))

    @property
    def edge(self) -> float:
        """The first after them, from `origin`."""
        return float(self.beyond - self.origin)


class _Crowd(msgspec.Struct, frozen=True, eq=False):
    """Bodies of one chain that stand near each other or an end."""

    rows: Indices
    """Which of its bodies, one of each place."""
    end: int
    """The nearer one, 0 or 1."""
    stretch: _Stretch

    @property
    def layout(self) -> Hashable:
        """What crowds have in common whose weights are found at once."""
        stretch = self.stretch
        return (len(self.rows), self.end, stretch.origin, stretch.first, stretch.beyond, stretch.powers)


def felt_together(chain: Chain, positions: Sequence[float], rule: str) -> tuple[Array, Array]:
    """`felt_at` of all bodies of a chain, (p, N + 1) and (p, N), mended where they stand near an end or each other.

    They stay as they are where links are not about alike, and where a chain is too short for so many.
    """
    felt, turned = felt_at(chain, positions, rule)
    n = chain.n_segments
    if not is_mended(rule, n) or chain.start or not len(felt):
        return felt, turned
    places = np.array(positions, dtype=float) / chain.unit
    links, on, _ = places_on(np.broadcast_to(chain.lengths[:, None], (n, len(places))), places)
    mend_each([chain], (links + on)[None], felt[None], turned[None])
    return felt, turned


def mend_each(chains: Sequence[Chain], places: Array, felt: Array, turned: Array) -> None:
    """Mend the weights of the bodies of m chains that have each alone, (m, p, N + 1) and (m, p, N), in place.

    Places, (m, p), are told in links. What crowds have in common is solved once for all of them.
    """
    alike: dict[Hashable, list[tuple[int, _Crowd]]] = {}
    for number, (chain, own) in enumerate(zip(chains, places, strict=True)):
        for crowd in _crowds(chain, own):
            alike.setdefault(crowd.layout, []).append((number, crowd))
    for members in alike.values():
        numbers = np.array([number for number, _ in members])
        rows, step = np.array([crowd.rows for _, crowd in members]), -1 if members[0][1].end else 1
        stretch = replace(
            members[0][1].stretch,
            places=np.concatenate([crowd.stretch.places for _, crowd in members]),
            weights=np.concatenate([crowd.stretch.weights for _, crowd in members]),
        )
        across = numbers[:, None], rows
        mended = _mended(stretch, felt[across][..., ::step], turned[across][..., ::step])
        for which, number in enumerate(numbers):
            for place, row in enumerate(rows[which]):
                same = abs(places[number] - places[number, row]) < 1e-9
                for weights, found in zip((felt, turned), mended, strict=True):
                    weights[number, same, ::step] = found[which, place]


def near(places: Array, n: int) -> BoolArray:
    """Whether bodies at `places` (p, ...) on n links may stand near an end or each other, (...)."""
    ordered = np.sort(places, axis=0)
    after, before = np.minimum(np.floor(ordered), n - 1), np.maximum(np.ceil(ordered) - 1, 0)
    ends = (before < _WALL + _BEFORE) | (after >= n - _WALL - _BEFORE)
    apart = np.minimum(np.diff(after, axis=0), np.diff(before, axis=0))
    return np.asarray(ends.any(axis=0) | (apart < _BEFORE + _AFTER).any(axis=0))


def _crowds(chain: Chain, places: Array) -> Iterator[_Crowd]:
    """Bodies at places (p,) of a chain that may be mended."""
    for rows in _groups(chain, places):
        end = int(places[rows].mean() > 0.5 * chain.n_segments)
        stretch = _stretch(chain, places[rows], end)
        if stretch is not None:
            yield _Crowd(rows, end, stretch)


def _groups(chain: Chain, places: Array) -> Iterator[Indices]:
    """Rows of bodies that stand near each other or an end, one of each place; without those at an end it turns with.

    One on a joint is on both its links, so that bodies are as near seen from the other end. Of a few bodies, which
    numpy would take ten times as long for.
    """
    n, rows, groups = chain.n_segments, dict[float, int](), list[list[int]]()
    ends = {end for end, support in zip((0.0, float(n)), chain.supports, strict=True) if support != "guided"}
    for row, place in enumerate(places.tolist()):
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
            yield np.array(group, dtype=np.intp)


def _stretch(chain: Chain, places: Array, end: int) -> _Stretch | None:
    """The joints around bodies at places (p,), from the end 0 or 1 on; None where a chain has none to choose."""
    n, support = chain.n_segments, chain.supports[end]
    places = n - places if end else places
    lengths, compliances = (one[::-1] if end else one for one in (chain.lengths, chain.compliances))
    holds = support in ("clamped", "guided") and not chain.elastic[end]
    first = max(int(places.min()) - _BEFORE, 0 if holds else 1)
    beyond = max(int(places.max()) + _AFTER, first + max(_FEWEST, 3 + 2 * len(places)))
    if beyond > n - 3:
        return None
    there, weights = lengths[max(first - 1, 0) : beyond + 1], compliances[first:beyond] / compliances[beyond]
    inside = abs(weights[max(_WALL - first, 0) :] - 1.0)
    if np.ptp(there) > _ABOUT * there[0] or (inside > _ABOUT).any():
        return None
    at_end = first <= 1 and int(places.min()) - _BEFORE <= first
    origin = 0 if at_end else first
    powers = _PARABOLA if not at_end or chain.elastic[end] else _POWERS.get(support, _PARABOLA)
    return _Stretch(
        places=places[None] - origin, origin=origin, first=first, beyond=beyond, powers=powers, weights=weights[None]
    )


def _mended(stretch: _Stretch, felt: Array, turned: Array) -> tuple[Array, Array]:
    """Weights (m, p, N + 1) and (m, p, N), from the nearer end, with the products of their bodies on the beam."""
    roots = np.sqrt(stretch.weights)[..., None]
    far = roots * stretch.joints[:, None] ** np.array(stretch.powers)
    seen, products = _of_far(stretch), _of_each_other(stretch)
    alone = roots * _moments(stretch, felt, turned)
    lack = (abs(_turned(far) @ alone - seen), abs(_turned(alone) @ alone - products))
    right = np.maximum(*(each.max(axis=(1, 2)) for each in lack)) < _RIGHT
    if right.all():
        return felt, turned
    basis, triangle = np.linalg.qr(far, mode="complete")
    n_far = len(stretch.powers)
    least, rest = basis[..., :n_far] @ np.linalg.solve(_turned(triangle[:, :n_far]), seen), basis[..., n_far:]
    values, vectors = np.linalg.eigh(products - _turned(least) @ least)
    lacking = (vectors * np.sqrt(np.maximum(values, 0.0))[:, None]) @ _turned(vectors)
    aligned = _turned(rest) @ alone @ lacking
    aligned += _TIE * abs(aligned).max(axis=(1, 2), keepdims=True) * np.eye(*aligned.shape[1:])
    left, _, after = np.linalg.svd(aligned, full_matrices=False)
    found = _of_moments(stretch, (least + rest @ (left @ after) @ lacking) / roots, felt.shape[2])
    stays = right[:, None, None]
    return np.where(stays, felt, found[0]), np.where(stays, turned, found[1])


def _turned(matrices: Array) -> Array:
    """Each of (m, i, j) transposed."""
    return matrices.swapaxes(1, 2)


def _of_far(stretch: _Stretch) -> Array:
    """Integrals of M q less what joints from `edge` on have of them, (m, powers, 2 p): of forces, then of couples."""
    x, b, p = stretch.places[:, None], stretch.edge, np.array(stretch.powers, dtype=float)[:, None]
    couples = (b ** (p + 1) - x ** (p + 1)) / (p + 1)
    forces = (b ** (p + 2) - x ** (p + 2)) / (p + 2) - x * couples
    return np.concatenate([forces - _beyond(b, p + 1) + x * _beyond(b, p), couples - _beyond(b, p)], axis=2)


def _beyond(b: float, p: Array) -> Array:
    """Joints from b on over the integral of x^p from there on: Euler and Maclaurin's terms, exact up to p = 4."""
    return np.asarray(0.5 * b**p - p * b ** (p - 1) / 12.0 + p * (p - 1) * (p - 2) * b ** (p - 3) / 720.0)


def _of_each_other(stretch: _Stretch) -> Array:
    """Integrals of M N less what joints from `edge` on have of them, (m, 2 p, 2 p): of forces, then of couples."""
    to_edge = stretch.edge - stretch.places
    one, other = to_edge[:, :, None], to_edge[:, None]
    cut, product, total = np.minimum(one, other), one * other, one + other
    forces = product * cut - total * cut**2 / 2.0 + cut**3 / 3.0 - product / 2.0 + total / 12.0
    mixed = one * cut - cut**2 / 2.0 - one / 2.0 + 1.0 / 12.0 + 0.0 * other
    return np.block([[forces, mixed], [_turned(mixed), cut - 0.5]])


def _moments(stretch: _Stretch, felt: Array, turned: Array) -> Array:
    """Moments of weights in the joints that may be chosen, (m, joints, 2 p), of forces, then of couples."""
    window = np.arange(stretch.first, min(stretch.beyond + 8, felt.shape[2]))
    joints = window[: stretch.beyond - stretch.first]
    ahead = np.maximum(window[:, None] - joints, 0)
    forces = stretch.joints[:, None] - stretch.places[:, None] + _turned(felt[..., window] @ ahead)
    links = window[window < turned.shape[2]]
    couples = 1.0 - _turned(turned[..., links] @ (links[:, None] >= joints))
    return np.concatenate([forces, couples], axis=2)


def _of_moments(stretch: _Stretch, moments: Array, n_joints: int) -> tuple[Array, Array]:
    """Weights (m, p, N + 1) and (m, p, N) of moments (m, joints, 2 p): changes of links' forces, and of moments."""
    (m, p), first, beyond = stretch.places.shape, stretch.first, stretch.beyond
    begin = max(first - 1, 0)
    every = np.zeros((m, 2 * p, beyond + 2 - begin))
    every[..., first - begin : beyond - begin] = _turned(moments)
    ahead = np.arange(2.0) + stretch.edge
    every[:, :p, beyond - begin :] = ahead - stretch.places[..., None]
    every[:, p:, beyond - begin :] = 1.0
    across = np.diff(every)
    felt, turned = np.zeros((m, p, n_joints)), np.zeros((m, p, n_joints - 1))
    felt[..., begin : beyond + 1] = np.diff(across[:, :p], prepend=0.0)
    turned[..., begin:beyond] = across[:, p:, :-1]
    return felt, turned
