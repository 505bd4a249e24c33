"""Post-buckling: mid-span deflection and shortening over L of a pinned column whose ends turn by an angle, degrees.

The models are under the load that belongs to the angle. Order 2 of links, with a large factor just above the buckling
load, where the deflection grows as the square root of the excess; between 3 and 4 of elements.
"""

from dataclasses import replace
from math import pi, radians

import numpy as np
from msgspec import structs

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, EI, inextensible
from verify.chain.statics import solve_static
from verify.chain.system import ChainState, LinkLoad, build_system

TABLE = "S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, 1961, article 2.7: elliptic integrals"
ELASTICA = {
    20: (1.015396866, 0.1097065212, 0.0302690926),
    40: (1.063663266, 0.2111201701, 0.1187964883),
    60: (1.15171962, 0.2966038231, 0.2589803939),
    80: (1.293889324, 0.3597485524, 0.440604081),
    100: (1.518388793, 0.3957697483, 0.6510106996),
    120: (1.884800869, 0.401585495, 0.8768400276),
}
"""Angle: load over Euler's, deflection, shortening; the load's last digit is 2e-8 of the deflection at 20 degrees."""
COLUMN = structs.replace(CANTILEVER, supports=("pinned", "pinned"))
SIDE = 0.05 * EI / COLUMN.mass_per_length
"""Acceleration across that chooses the side, m/s^2; it bends a straight column by 7e-4 of L."""


def figure(component: str, x: float, deflection: float) -> float:
    """The deflection, or the shortening of a column whose end is at x."""
    return deflection if component == "deflection" else COLUMN.length - x


def buckled(angle: int, component: str, count: int = 40) -> float:
    """Figure of rigid links, from a half wave of the same end angle."""
    end = LinkLoad(link=count, at=COLUMN.length / count, force=(-ELASTICA[angle][0] * pi**2 * EI, 0.0))
    system = replace(build_system(COLUMN, count), loads=(end,))
    guess = radians(angle) * np.cos(pi * (np.arange(count) + 0.5) / count)
    bent = solve_static(system, ChainState(np.diff(guess, prepend=0.0), np.zeros(count)))
    turns = np.cumsum(bent.angles)
    x, y = (np.cumsum(system.lengths * line) for line in (np.cos(turns), np.sin(turns)))
    return figure(component, float(x[-1]), float(np.interp(0.5 * COLUMN.length, system.nodes[1:], y)))


def buckled_elements(angle: int, component: str, count: int = 16) -> float:
    """Figure of nonlinear elements, on the side of a small weight that is then taken off."""
    model, load = inextensible(count, COLUMN), (-ELASTICA[angle][0] * pi**2 * EI, 0.0)
    bent = model.bend(load, gravity=SIDE)
    for share in (0.1, 0.01, 0.0):
        bent = model.bend(load, gravity=share * SIDE, start=bent)
    middle = np.einsum("ij,ijc->c", model.weights(0.5 * COLUMN.length), bent.state)
    return figure(component, float(bent.tip[0]), float(middle[1]))


for _angle, (_, *_exact) in ELASTICA.items():
    for _name, _value in zip(("deflection", "shortening"), _exact, strict=True):
        for _prefix, _run in (("buckled", buckled), ("buckled-elements", buckled_elements)):
            case(f"{_prefix}-{_angle}-{_name}", _value, 3e-8 * _value, TABLE, angle=_angle, component=_name)(_run)
