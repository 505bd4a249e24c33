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
_REACH = 8
"""Columns of weights beyond the joints that may be chosen: as many as a body has alone."""
_RIGHT = 1e-7
"""What is so near to what it should be stays as it is."""
_TIE = 1e-10
"""Of what the weights are to be near: added to it, it settles which way to go where two are as near."""
_ABOUT = 0.05


class Links(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Of m chains on the same supports what crowds on them are told by."""

    supports: tuple[str, str]
    elastic: tuple[bool, bool]
    lengths: Array
    """(m, N), in units of each chain."""
    compliances: Array
    """(m, N + 1)."""

    @property
    def n(self) -> int:
        """N."""
        return int(self.lengths.shape[1])


class _Layout(msgspec.Struct, frozen=True):
    """What crowds have in common whose weights are found at once, joints told from the nearer end."""

    bodies: int
    inner: int
    """The first joint whose moments may be chosen, from that where powers are told from."""
    width: int
    """How many there are of these."""
    before: int
    """Of joints before the first of them, 1 or 0."""
    powers: tuple[int, ...]
    """Of moments from far away."""


class _Crowd(msgspec.Struct, frozen=True, eq=False):
    """Bodies of one chain that stand near each other or an end."""

    chain: int
    rows: list[int]
    """Which of its bodies, one of each place."""
    end: int
    """The nearer one, 0 or 1."""
    first: int
    """The first joint whose moments may be chosen, from there."""


class _Stretch(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The joints around m crowds of one layout, told from the nearer end of each, in links."""

    layout: _Layout
    chains: Indices
    """(m, 1)."""
    rows: Indices
    """(m, p)."""
    ends: Indices
    """(m, 1)."""
    window: Indices
    """(m, columns), joints and links where weights are seen: the one before those that may be chosen, and on."""
    places: Array
    """(m, p), from the joint where powers are told from."""
    weights: Array
    """(m, width), c_k in what a joint inside has."""

    @property
    def joints(self) -> Array:
        """Those that may be chosen, likewise."""
        return np.asarray(np.arange(self.layout.width) + float(self.layout.inner))

    @property
    def edge(self) -> float:
        """The first after them, likewise."""
        return float(self.layout.inner + self.layout.width)

    def of(self, which: BoolArray) -> "_Stretch":
        """Those of some crowds."""
        arrays = {name: getattr(self, name)[which] for name in self.__struct_fields__ if name != "layout"}
        return _Stretch(layout=self.layout, **arrays)

    def seen(self, weights: Array) -> Array:
        """Of weights of all bodies (chains, bodies, N or N + 1) these, (m, p, columns); zeros beyond the other end."""
        return _from_end(weights[self.chains, self.rows], self.ends[..., None], self.window[:, None])

    def put(self, weights: Array, found: Array, which: BoolArray) -> None:
        """Put what is found, (m, p, columns), in place of some of these."""
        chains, rows = self.chains[which], self.rows[which]
        columns = self.window[which, : self.layout.before + self.layout.width + 1]
        columns = np.where(self.ends[which], weights.shape[2] - 1 - columns, columns)
        weights[chains, rows] = 0.0
        weights[chains[..., None], rows[..., None], columns[:, None]] = found[which][..., : columns.shape[1]]


def _from_end(values: Array, ends: Indices, at: Indices) -> Array:
    """Of values (..., columns) those of columns `at` from the ends; zeros beyond the other."""
    last = values.shape[-1] - 1
    there = np.take_along_axis(values, np.clip(np.where(ends, last - at, at), 0, last), axis=-1)
    return np.where((at >= 0) & (at <= last), there, 0.0)


def links_of(chain: Chain) -> Links:
    """Those of one chain."""
    return Links(
        supports=chain.supports,
        elastic=chain.elastic,
        lengths=chain.lengths[None],
        compliances=chain.compliances[None],
    )


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
    mend_each((links + on)[None], felt[None], turned[None], links_of(chain))
    return felt, turned


def mend_each(places: Array, felt: Array, turned: Array, links: Links) -> None:
    """Mend the weights of the bodies of m chains that have each alone, (m, p, N + 1) and (m, p, N), in place.

    Places, (m, p), are told in links. What crowds have in common is solved once for all of them.
    """
    for stretch in _stretches(places, links):
        own = stretch.seen(felt), stretch.seen(turned)
        found = _mended(stretch, *own)
        changed = np.any([(one != other).any(axis=(1, 2)) for one, other in zip(found, own, strict=True)], axis=0)
        stretch.put(felt, found[0], changed)
        stretch.put(turned, found[1], changed)
    same = abs(places[:, :, None] - places[:, None]) < 1e-9
    for number in np.flatnonzero(same.sum(axis=(1, 2)) > places.shape[1]):
        first = same[number].argmax(axis=1)
        felt[number], turned[number] = felt[number, first], turned[number, first]


def _stretches(places: Array, links: Links) -> Iterator[_Stretch]:
    """The joints around crowds, where these are about alike and a chain has as many, all of one layout together."""
    alike: dict[_Layout, list[_Crowd]] = {}
    for number, own in enumerate(places.tolist()):
        for rows in _groups(links.n, links.supports, own):
            layout, crowd = _told(links, number, rows, own)
            if crowd.first + layout.width <= links.n - 3:
                alike.setdefault(layout, []).append(crowd)
    for layout, crowds in alike.items():
        stretch, alike_there = _stretch(layout, crowds, places, links)
        if alike_there.any():
            yield stretch.of(alike_there)


def _stretch(layout: _Layout, crowds: list[_Crowd], places: Array, links: Links) -> tuple[_Stretch, BoolArray]:
    """(The joints around crowds of one layout, of which links and joints but for a wall's are about alike)."""
    told = np.array([(crowd.chain, crowd.end, crowd.first) for crowd in crowds], dtype=np.intp)
    chains, ends, firsts = np.split(told, 3, axis=1)
    rows, window = np.array([crowd.rows for crowd in crowds]), np.arange(-layout.before, layout.width + _REACH) + firsts
    first, beyond = layout.before, layout.before + layout.width
    compliances = _from_end(links.compliances[chains[:, 0]], ends, window[:, : beyond + 1])
    lengths = _from_end(links.lengths[chains[:, 0]], ends, window[:, : beyond + 1])
    weights, there = compliances[:, first:beyond] / compliances[:, beyond:], places[chains, rows]
    inside = np.where(window[:, first:beyond] < _WALL, 1.0, weights)
    stretch = _Stretch(
        layout=layout,
        chains=chains,
        rows=rows,
        ends=ends,
        window=window,
        places=np.where(ends, links.n - there, there) - (firsts - layout.inner),
        weights=weights,
    )
    even = np.ptp(lengths, axis=1) <= _ABOUT * lengths.max(axis=1)
    return stretch, np.asarray(even & (abs(inside - 1.0) <= _ABOUT).all(axis=1))


def near(places: Array, n: int) -> BoolArray:
    """Whether bodies at `places` (p, ...) on n links may stand near an end or each other, (...)."""
    ordered = np.sort(places, axis=0)
    after, before = np.minimum(np.floor(ordered), n - 1), np.ceil(ordered) - 1
    ends = (before < _WALL + _BEFORE) | (after >= n - _WALL - _BEFORE)
    apart = np.minimum(np.diff(after, axis=0), np.diff(before, axis=0))
    return np.asarray(ends.any(axis=0) | (apart < _BEFORE + _AFTER).any(axis=0))


def _groups(n: int, supports: tuple[str, str], places: Sequence[float]) -> Iterator[list[int]]:
    """Rows of bodies that stand near each other or an end, one of each place; without those at an end it turns with.

    One on a joint is on both its links, so that bodies are as near seen from the other end. Of a few bodies, which
    numpy would take ten times as long for.
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


def _told(links: Links, number: int, rows: list[int], places: Sequence[float]) -> tuple[_Layout, _Crowd]:
    """The crowd of some bodies of a chain, told from the nearer end on, and its layout."""
    end = int(sum(places[row] for row in rows) > 0.5 * links.n * len(rows))
    support, elastic = links.supports[end], links.elastic[end]
    there = [links.n - places[row] if end else places[row] for row in rows]
    before, after = int(min(there)) - _BEFORE, int(max(there)) + _AFTER
    first = max(before, 0 if support in ("clamped", "guided") and not elastic else 1)
    beyond = max(after, first + max(_FEWEST, 3 + 2 * len(rows)))
    at_end = first <= 1 and before <= first
    powers = _PARABOLA if not at_end or elastic else _POWERS.get(support, _PARABOLA)
    layout = _Layout(len(rows), first if at_end else 0, beyond - first, int(first > 0), powers)
    return layout, _Crowd(number, rows, end, first)


def _mended(stretch: _Stretch, felt: Array, turned: Array) -> tuple[Array, Array]:
    """Weights of joints and turns, (m, p, columns) both, with the products of their bodies on the beam."""
    roots = np.sqrt(stretch.weights)[..., None]
    far = roots * stretch.joints[:, None] ** np.array(stretch.layout.powers)
    seen, products = _of_far(stretch), _of_each_other(stretch)
    alone = roots * _moments(stretch, felt, turned)
    lack = (abs(_turned(far) @ alone - seen), abs(_turned(alone) @ alone - products))
    right = np.maximum(*(each.max(axis=(1, 2)) for each in lack)) < _RIGHT
    if right.all():
        return felt, turned
    basis, triangle = np.linalg.qr(far, mode="complete")
    n_far = len(stretch.layout.powers)
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
    x, b, p = stretch.places[:, None], stretch.edge, np.array(stretch.layout.powers, dtype=float)[:, None]
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
    felt, turned = felt[..., stretch.layout.before :], turned[..., stretch.layout.before :]
    ahead = np.arange(felt.shape[2])[:, None] - np.arange(stretch.layout.width)
    forces = stretch.joints[:, None] - stretch.places[:, None] + _turned(felt @ np.maximum(ahead, 0))
    return np.concatenate([forces, 1.0 - _turned(turned @ (ahead >= 0))], axis=2)


def _of_moments(stretch: _Stretch, moments: Array, columns: int) -> tuple[Array, Array]:
    """Weights (m, p, columns) both of moments (m, joints, 2 p): changes of links' forces, and of moments."""
    (m, p), before, width = stretch.places.shape, stretch.layout.before, stretch.layout.width
    every = np.zeros((m, 2 * p, before + width + 2))
    every[..., before : before + width] = _turned(moments)
    every[:, :p, before + width :] = np.arange(2.0) + stretch.edge - stretch.places[..., None]
    every[:, p:, before + width :] = 1.0
    across = np.diff(every)
    felt, turned = np.zeros((m, p, columns)), np.zeros((m, p, columns))
    felt[..., : before + width + 1] = np.diff(across[:, :p], prepend=0.0)
    turned[..., : before + width] = across[:, p:, :-1]
    return felt, turned
