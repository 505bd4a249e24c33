"""The free modes of the chain of rigid links for motion in time, closed-form where they have one."""

from collections.abc import Callable
from functools import lru_cache, partial
from math import pi
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.checks import check_word
from verify.models.arrays import Array
from verify.models.driven_pencil import check_dense
from verify.models.eigen import modal_basis
from verify.models.places import as_typed
from verify.models.time_basis import TimeBasis, check_held, own_ratios
from verify.options import LINES, LOADS, Attachment, Joints, Line, Load, Wall
from verify.segments.assembly import build_chain, chain_pencil
from verify.segments.linear import check, damped, leading_sign
from verify.segments.links import Chain
from verify.segments.loads import joint_weights
from verify.segments.reading import body_turns, corrected_reading, joint_positions, line_through


@as_typed
def time_basis(
    beam: Beam,
    n_segments: int,
    *,
    load: Load = "reciprocal",
    line: Line = "spline",
    wall: Wall = "gregory",
    joints: Joints = "series",
    attachment: Attachment = "reciprocal",
) -> TimeBasis:
    """All modes of the chain, (n,), in closed form on a uniform pinned-pinned beam, else from a dense solve.

    Of Euler-Bernoulli's theory, with whatever stands on the beam. `line` "spline" reads order 4 joints through the C2
    spline, "raw" the rigid links as they stand. Raises InputError for unknown settings, rigid
    motions and chains beyond the dense size.
    """
    check(beam, 1, n_segments, wall=wall, joints=joints, attachment=attachment)
    check_held(beam)
    check_word("load", load, LOADS)
    check_word("line", line, LINES)
    chain = build_chain(beam, n_segments, wall=wall, joints=joints, attachment=attachment)
    uniform = beam.supports == ("pinned", "pinned") and beam.uniform and not beam.section
    omegas, read, method, turns, ratios = _pinned(beam, n_segments) if uniform else _dense(beam, chain)

    def loads(position: float) -> Array:
        weights: Any = joint_weights(chain, position, load)
        near = np.flatnonzero(weights)
        return np.asarray(weights[near] @ read(near).T)

    shapes = _straight(chain, read) if line == "raw" else _splined(beam, chain, read, uniform)
    return TimeBasis(
        model="segment",
        count=n_segments,
        beam=beam,
        omegas=omegas,
        shapes=shapes,
        loads=loads,
        edges=chain.nodes,
        degree=1 if line == "raw" else 3,
        method=method,
        ratios=ratios,
        turns=turns,
    )


Read = Callable[[Any], Array]
"""Joint numbers -> deflection of all modes there, (n, len(numbers))."""
Turns = Callable[[], Array] | None


def _pinned(beam: Beam, n: int) -> tuple[Array, Read, str, Turns, None]:
    """Equal links between pinned ends: y_j = a sin(n pi j / N), omega = 4 s^2 / sqrt(1 - 2 s^2/3) in link units."""
    mu = pi * np.arange(1, n) / n
    square = np.sin(0.5 * mu) ** 2
    inertia = _mass_share(square)
    link = beam.length / n
    omegas = beam.wave_constant / link**2 * 4.0 * square / np.sqrt(inertia)
    scale = 1.0 / np.sqrt(beam.mass_per_length * link * inertia * 0.5 * n)
    sines = np.sin(pi * np.arange(2 * n) / n)  # of n pi j / N, by n j modulo 2 N: exact at any size

    def joints(numbers: Any) -> Array:
        return np.asarray(scale[:, None] * sines[np.outer(np.arange(1, n), np.asarray(numbers, dtype=int)) % (2 * n)])

    return omegas, joints, "closed-form dispersion", None, None


def _mass_share(square: Array) -> Array:
    """Kinetic energy of links in a wave over that of their joints' mass alone, 1 - 2 s^2/3: m l^2/12 included."""
    return np.asarray(1.0 - 2.0 * square / 3.0)


def _dense(beam: Beam, chain: Chain) -> tuple[Array, Read, str, Turns, Array | None]:
    pencil = chain_pencil(chain)
    check_dense(pencil, "motion in time")
    values, vectors = modal_basis(pencil)
    unlike = beam.loss_factor and beam.lossless
    ratios = own_ratios(pencil, vectors, damped(beam, chain, pencil, 0.0)) if unlike else None
    vectors = vectors * (leading_sign(chain, vectors) / np.sqrt(beam.mass_per_length * chain.unit))
    raw = joint_positions(chain, vectors)
    omegas = np.sqrt(values) * beam.wave_constant / chain.unit**2
    turns = partial(body_turns, chain, len(beam.mass), vectors) if beam.mass else None
    return omegas, lambda numbers: np.asarray(raw[:, numbers]), "dense eigenvalues", turns, ratios


def _straight(chain: Chain, joints: Read) -> Callable[[Array, int], Array]:
    """The rigid links: straight between the joints, the link to the right at a joint."""
    nodes, lengths = chain.nodes, chain.lengths * chain.unit

    def shapes(x: Array, derivative: int) -> Array:
        link = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, chain.n_segments - 1)
        left, right = joints(link), joints(link + 1)
        slopes = (right - left) / lengths[link]
        if derivative == 0:
            return np.asarray(left + slopes * (x - nodes[link]))
        return slopes if derivative == 1 else np.zeros_like(slopes)

    return shapes


def _splined(beam: Beam, chain: Chain, joints: Read, uniform: bool) -> Callable[[Array, int], Array]:
    """The C2 spline through the corrected joints."""
    if not uniform:
        everywhere = corrected_reading(chain, joints(np.arange(chain.n_segments + 1)))
        return line_through(chain, lambda: everywhere)
    return _sine_spline(chain, joints)


def _sine_spline(chain: Chain, joints: Read) -> Callable[[Array, int], Array]:
    """Corrected reading and spline of sines, which both leave sines: no system to solve.

    y + delta^2 y / 12 is (1 - s^2/3) y, the spline's second derivative -4 s^2 / (1 - 2 s^2/3) y per link squared.
    """
    n, link = chain.n_segments, chain.unit
    square = np.sin(0.5 * pi * np.arange(1, n) / n)[:, None] ** 2
    reading = 1.0 - square / 3.0
    bend = -4.0 * square / (1.0 - 2.0 * square / 3.0)  # times y, per link length squared

    nodes = chain.nodes

    @lru_cache(maxsize=4)
    def pieces(places: bytes) -> tuple[Array, tuple[Array, ...]]:
        """(xi, the spline's coefficients) at places, of which every derivative is asked."""
        x = np.frombuffer(places)
        number = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, n - 1)
        left, right = np.asarray(reading * joints(number)), np.asarray(reading * joints(number + 1))
        m0, m1 = bend * left, bend * right
        bends = left, right - left - (2.0 * m0 + m1) / 6.0, 0.5 * m0, (m1 - m0) / 6.0
        return (x - nodes[number]) / link, bends

    def shapes(x: Array, derivative: int) -> Array:
        xi, found = pieces(np.asarray(x, dtype=float).tobytes())
        c = list(found)
        for _ in range(derivative):
            c = [(d + 1) * c[d + 1] for d in range(len(c) - 1)] or [np.zeros_like(found[0])]
        value = np.zeros_like(found[0])
        for part in reversed(c):
            value = value * xi + part
        return np.asarray(value / link**derivative)

    return shapes
