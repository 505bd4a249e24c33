"""The beam's deflection from the joints of a chain: corrected reading and contact line."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from verify.arrays import Array, Curve, Numeric
from verify.segments.chain import Chain, at_joints


def corrected_reading(
    chain: Chain, joints: Numeric, rotations: Numeric | None = None, shear_change: Numeric | float = 0.0
) -> Numeric:
    """The beam's deflection y + l^2 y''/12 at joints 0..N, (k, N + 1), from joint positions y: order 4.

    l^2 y'' is the joint angle, times (l_i^2 + l_j^2)/2 over the mean length for unequal links. With shear the angle is
    that of the links' `rotations` (k, N), and `shear_change` (k, N + 1) is gamma' at the joints. No correction at ends
    without deflection and at free ends, where no moment acts; at guided ends the chain continues by reflection.
    """
    slopes = np.diff(joints, axis=1) / chain.lengths if rotations is None else rotations
    curvatures = np.zeros_like(joints)
    curvatures[:, 1:-1] = np.diff(slopes, axis=1) / chain.spans[1:-1]
    left, right = chain.walls
    curvatures[:, 0] = left * 2.0 * slopes[:, 0] / chain.lengths[0]
    curvatures[:, -1] = right * -2.0 * slopes[:, -1] / chain.lengths[-1]
    squares = at_joints(chain.lengths**2) / 12.0
    squares[[0, -1]] *= np.logical_not(chain.supported)
    if chain.reading_factors is not None:
        squares = squares * chain.reading_factors
    return joints + squares * (curvatures - shear_change)


def spline(chain: Chain, values: Numeric, *, slipping: bool = False) -> Any:
    """Cubic C2 spline through a value at every joint, (k, N + 1), over x in m.

    End conditions: zero second derivative at pinned and free ends, zero slope at walls, not-a-knot at elastic ends and
    with shear.
    """
    from scipy.interpolate import CubicSpline

    ends = ["clamped" if wall else "natural" for wall in chain.walls]
    for end, (support, elastic) in enumerate(zip(chain.supports, chain.elastic, strict=True)):
        by_symmetry = support == "guided" or (support == "pinned" and not elastic)
        if (any(chain.elastic) or slipping) and not by_symmetry:
            ends[end] = "not-a-knot"
    return CubicSpline(chain.nodes, values, axis=1, bc_type=tuple(ends))


def line_through(chain: Chain, values: Callable[[], Numeric], *, slipping: bool = False) -> Curve:
    """(x in m, derivative) -> `spline` or its derivative at x, (k, len(x)); built on first use."""
    nodes, made = chain.nodes, cache(lambda: spline(chain, values(), slipping=slipping))
    # zero deflection of a half segment that is welded to a wall
    return lambda x, derivative: made()(np.clip(x, nodes[0], nodes[-1]), derivative)


def rigid_links(chain: Chain, middles: Numeric, rotations: Numeric, *, both_sides: bool = True) -> Curve:
    """(x in m, derivative) -> deflection of the straight links at x, (k, len(x)).

    `middles` and `rotations` are (k, N), m and rad. At a joint the mean of both links, or the right link alone.
    """
    nodes, slack = chain.nodes, 1e-9 * chain.unit
    centres = 0.5 * (nodes[1:] + nodes[:-1])

    def read(x: Array, derivative: int) -> Numeric:
        sides = (-slack, slack) if both_sides else (0.0, 0.0)
        links = [np.clip(np.searchsorted(nodes, x + s, side="right") - 1, 0, chain.n_segments - 1) for s in sides]
        if derivative > 1:
            return np.zeros((len(rotations), len(x)), dtype=rotations.dtype)
        each = [rotations[:, i] if derivative else middles[:, i] + rotations[:, i] * (x - centres[i]) for i in links]
        return 0.5 * (each[0] + each[1])

    return read


def contact_line(chain: Chain, joints: Array) -> Any:
    """The paper's C2 contact line (Section II.B) through corrected joint positions (k, N + 1), as a `spline`."""
    return spline(chain, corrected_reading(chain, joints))
