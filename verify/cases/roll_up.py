"""Roll-up: gap between the ends over L of a cantilever that an end moment 2 pi EI / L bends to a circle.

Equal joints, with 2EI/l at the wall, make a regular polygon, which closes exactly. Gregory's weights at the wall add up
to the same turn but leave a gap. Elements leave one of order 2 up to 32, with a small factor: their slopes, which a
soft restraint keeps to unit length, stretch by (l kappa)^2/36 so that the curvature is uniform; then of order 4.
"""

from math import cos, hypot, pi, sin

import numpy as np

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, EI, inextensible
from verify.chain.statics import bend
from verify.settings import Wall

JOINTS = "constant curvature: a joint turns by the moment over its stiffness"


def polygon(count: int, *weights: float) -> float:
    """Gap of a polygon whose first angles have these weights, its others 1."""
    angles = np.cumsum(2.0 * pi / count * np.array([*weights, *np.ones(count - len(weights))]))
    return hypot(sum(map(cos, angles)), sum(map(sin, angles))) / count


@case("roll-up", 0.0, 0.0, JOINTS, wall="half")
@case("roll-up-gregory", polygon(20, 3 / 8, 7 / 6, 23 / 24), 1e-16, JOINTS, wall="gregory", count=20)
def gap(wall: Wall, count: int = 20, turns: float = 1.0) -> float:
    """Gap of rigid links under `turns` times the moment."""
    return hypot(*bend(CANTILEVER, count, moment=2.0 * pi * turns * EI, wall=wall).tip)


@case("roll-up-elements", 0.0, 0.0, JOINTS)
def gap_of_elements(count: int = 16) -> float:
    """Gap of nonlinear elements under the moment."""
    return hypot(*inextensible(count).bend(moment=2.0 * pi * EI).tip)
