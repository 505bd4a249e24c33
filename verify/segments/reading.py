"""What a chain's joints say of the beam between them: the one corrected reading, and the contact line through it.

Linear and nonlinear chains, steady fields, modes and sliders all read with these.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.linear.spline import natural_or_flat
from verify.segments.links import Chain, plain_curvatures, with_ends


def joint_positions(chain: Chain, free: Any) -> Any:
    """Positions of joints 0..N of the unknowns (n, k), (k, N + 1)."""
    return with_ends(chain, free[: chain.n_segments + 1 - sum(chain.held)]).T


def joint_readings(chain: Chain, free: Array) -> Array:
    """The beam's deflection at joints 0..N of the unknowns (n, k), order 4, (k, N + 1)."""
    joints = joint_positions(chain, free)
    if chain.slips is None:
        return corrected_reading(chain, joints)
    from verify.segments.loaded import corrections

    return np.asarray(joints + corrections(chain, free))


def joint_curvatures(chain: Chain, free: Array, values: Array) -> Array:
    """Curvature of the beam at joints 0..N of modes (n, k), (k, N + 1), 1/m: on a step that right of it.

    `values` (k,) are their eigenvalues, which shear takes its change from.
    """
    if chain.plain:
        return plain_curvatures(chain, joint_positions(chain, free))
    from verify.segments.loaded import bending, shear_change

    bent = bending(chain, free)
    if chain.slips is not None:
        bent = bent + shear_change(chain, joint_readings(chain, free), values)
    return np.asarray(bent / chain.unit**2)


def link_slopes(chain: Chain, free: Any) -> Any:
    """Turns of the links of the unknowns (n, k), (k, N), radians."""
    if chain.slips is None:
        return np.diff(joint_positions(chain, free)) / (chain.lengths * chain.unit)
    from verify.segments.loaded import turns

    return turns(chain, free).T / chain.unit


def body_turns(chain: Chain, n_bodies: int, free: Array) -> Array:
    """Turns of the first bodies, as the chain's masses feel them, of the unknowns (n, k), (k, n_bodies), radians.

    One with a rotary inertia beyond an end's joint turns by itself.
    """
    from verify.segments.crowded import felt_together
    from verify.segments.loaded import end_turns

    places = [body.position for body in chain.bodies]
    felt = felt_together(chain, places, chain.attachment)[1][:n_bodies]
    found, beyond = felt @ link_slopes(chain, free).T, end_turns(chain, free) / chain.unit
    for end, inertia in enumerate(chain.end_inertias):
        if inertia:
            found[np.isclose(places[:n_bodies], chain.nodes[-end], rtol=0.0, atol=1e-9 * chain.unit)] = beyond[end]
    return np.asarray(found.T)


def link_middles(chain: Chain, free: Any) -> Any:
    """Positions of the links' middles, (k, N)."""
    from verify.segments.loaded import middles

    return middles(chain, free).T


def node_curvatures(chain: Chain, joints: Array) -> Array:
    """Change of slope over the mean of the adjoining links at every joint, (k, N + 1), in 1/unit.

    At a wall the chain goes on by reflection (guided even, clamped even); zero at pinned and free ends.
    """
    slopes = np.diff(joints, axis=1) / chain.lengths
    curvatures = np.zeros_like(joints)
    curvatures[:, 1:-1] = np.diff(slopes, axis=1) / (0.5 * (chain.lengths[1:] + chain.lengths[:-1]))
    left, right = chain.walls
    if left:
        curvatures[:, 0] = 2.0 * slopes[:, 0] / chain.lengths[0]
    if right:
        curvatures[:, -1] = -2.0 * slopes[:, -1] / chain.lengths[-1]
    return curvatures


def corrected_reading(chain: Chain, joints: Array) -> Array:
    """Y + delta^2 y / 12 at every joint, (k, N + 1); ends that keep their position keep it.

    For unequal links (l_i^2 + l_j^2)/24 times the curvature, which is the same for equal ones.
    """
    squares = np.zeros(chain.n_segments + 1)
    squares[:-1] += chain.lengths**2
    squares[1:] += chain.lengths**2
    squares[[0, -1]] *= 2.0
    left, right = chain.held
    squares[0] *= not left
    squares[-1] *= not right
    if chain.edges is not None:
        squares *= chain.edges
    return np.asarray(joints + squares / 24.0 * node_curvatures(chain, joints))


def spline(chain: Chain, values: Array) -> Any:
    """Cubic C2 spline through a value at every joint, (k, N + 1): no moment at pinned and free ends, no slope at walls.

    Over metres. Elastic ends, and those that shear bends or turns, go on as the last two links do.
    """
    ends = [1 if wall else 2 for wall in chain.walls]
    if any(chain.elastic) or chain.slips is not None:
        known = (s == "guided" or (s == "pinned" and not e) for s, e in zip(chain.supports, chain.elastic, strict=True))
        ends = [end if there else 0 for there, end in zip(known, ends, strict=True)]
    return natural_or_flat(chain.nodes, values, (ends[0], ends[1]))


def line_through(chain: Chain, values: Callable[[], Array]) -> Callable[[Array, int], Array]:
    """(x, derivative) -> that spline or a derivative of it at x, (k, len(x)); made once, when first read."""
    nodes, made = chain.nodes, cache(lambda: spline(chain, values()))

    def read(x: Array, derivative: int) -> Array:
        inside = np.clip(x, nodes[0], nodes[-1])  # a welded half segment stands still
        return np.asarray(made()(inside, derivative))

    return read


def contact_line(chain: Chain, joints: Array) -> Any:
    """The paper's C2 line (Section II.B) through the corrected joints, (k, N + 1), as `spline` gives it."""
    return spline(chain, corrected_reading(chain, joints))


def contact_piece(chain: Chain, joints: Array, piece: int) -> Array:
    """The contact line of joints (k, N + 1) on one piece, (k, 4): coefficients of the powers of xi, 0 to 1 along it."""
    length = float(chain.lengths[piece]) * chain.unit
    powers = contact_line(chain, joints).c[::-1, piece]
    return np.asarray((powers * length ** np.arange(4)[:, None]).T)
