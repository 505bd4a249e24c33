"""Curved rods in space: the 45-degree bend of Bathe and Bolourchi, and a helix that a moment straightens. Order 2.

K.-J. Bathe and S. Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961: R = 100, section 1 x 1, E = 1e7, nu = 0, a
force of 600 across the plane of the arc. They print 13.4, 53.4, 23.5 of eight elements. Most authors since take the
polar moment 1/6 for torsion; Saint-Venant's constant is 0.140577. Kynema and BeamDyn lay a parabola through the ends
and the middle of the arc, whose tip moves by 0.1 more than that of the arc.
"""

from math import pi

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.cases.base import case
from verify.chain.space_statics import bend_in_space
from verify.problem.beam import Beam

SQUARE = Beam(length=25.0 * pi, width=1.0, thickness=1.0, youngs_modulus=1e7, density=1.0, supports=("clamped", "free"))
EI = SQUARE.bending_stiffness
SHOOTING = "inextensible rod without shear by shooting, as in tests/reference/space_rods.py"
KYNEMA = "Kynema, docs/sphinx/testing/curved.rst, equal to BeamDyn; shear and extension, 6.9e-3, are left out here"
MIDDLE, TIP = (38.2683, 7.61205), (70.7107, 29.2893)  # of the parabola


def pulled(arcs: Array, curvature: Array, torsion: float, count: int) -> Array:
    """Displacement of the tip of rigid links, (3,), of a curve towards -y by its curvature at arc lengths."""
    beam = replace(SQUARE, length=float(arcs[-1]))
    stiffness = (5e6 * torsion, EI, EI)

    def bent(s: Array) -> Array:
        return np.outer(np.interp(s, arcs, curvature), [0.0, 0.0, -1.0])

    return bend_in_space(beam, count, (0.0, 0.0, 600.0), curvature=bent, stiffness=stiffness).displacement


@case("bend-45-x", -23.55938372, 5e-9, SHOOTING, component=0)
@case("bend-45-y", 13.60424372, 5e-9, SHOOTING, component=1)
@case("bend-45-z", 53.46859844, 5e-9, SHOOTING, component=2)
@case("bend-45-saint-venant-z", 53.60111408, 5e-9, SHOOTING, component=2, torsion=0.140577)
def arc(component: int, torsion: float = 1.0 / 6.0, count: int = 40) -> float:
    """Displacement of the tip of the arc."""
    return float(pulled(np.array([0.0, SQUARE.length]), np.array([0.01, 0.01]), torsion, count)[component])


@case("bend-45-parabola-z", 53.5776450627, 8e-3, KYNEMA)
def parabola(count: int = 40) -> float:
    """Displacement of the tip of the parabola across its plane."""
    bend = (TIP[1] / TIP[0] - MIDDLE[1] / MIDDLE[0]) / (TIP[0] - MIDDLE[0])
    slope = TIP[1] / TIP[0] + bend * np.linspace(-TIP[0], TIP[0], 4001)  # a table, 1e-8 of the curvature
    arcs = (np.arcsinh(slope) + slope * np.hypot(1.0, slope)) / (4.0 * bend)
    return float(pulled(arcs - arcs[0], 2.0 * bend * np.hypot(1.0, slope) ** -3, 1.0 / 6.0, count)[2])


@case("straightened-helix", 0.0, 0.0, "a moment -K psi cancels a uniform twist and curvature psi")
def gap(count: int = 40) -> float:
    """Distance of the tip of rigid links from that of the straight rod, over its length; two turns at rest."""
    rest, stiffness = np.array([1.1, 0.4, 4.0 * pi]), np.array([0.7, 1.0, 1.9])
    moment, rod = -stiffness * rest, replace(SQUARE, length=1.0)
    bent = bend_in_space(rod, count, moment=moment, curvature=lambda s: np.tile(rest, (len(s), 1)), stiffness=stiffness)
    return float(np.linalg.norm(bent.tip - [1.0, 0.0, 0.0]))
