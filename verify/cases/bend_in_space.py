"""Curved rods in space: the 45-degree bend of Bathe and Bolourchi, and a helix that a moment straightens. Order 2.

K.-J. Bathe and S. Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961: R = 100, section 1 x 1, E = 1e7, nu = 0, a
force of 600 across the plane of the arc. They print 13.4, 53.4, 23.5 of eight elements. Most authors since take the
polar moment 1/6 for torsion; Saint-Venant's constant is 0.140577. Kynema and BeamDyn lay a parabola through the ends
and the middle of the arc, whose tip moves by 0.1 more than that of the arc.
"""

from math import atan, pi

import numpy as np

from verify.cases.base import case
from verify.chain.space_statics import bend_in_space
from verify.problem.beam import Beam

EI = 1e7 / 12.0
SHOOTING = "inextensible rod without shear by shooting, as in tests/reference/space_rods.py"
KYNEMA = "Kynema, docs/sphinx/testing/curved.rst, equal to BeamDyn; shear and extension, 6.9e-3, are left out here"
MIDDLE, TIP = (38.2683, 7.61205), (70.7107, 29.2893)  # of the parabola
PULL = (0.0, 0.0, 600.0)


def square(length: float) -> Beam:
    """A cantilever of the bend's section."""
    return Beam(length=length, width=1.0, thickness=1.0, youngs_modulus=1e7, density=1.0, supports=("clamped", "free"))


@case("bend-45-x", -23.55938372, 5e-9, SHOOTING, component=0)
@case("bend-45-y", 13.60424372, 5e-9, SHOOTING, component=1)
@case("bend-45-z", 53.46859844, 5e-9, SHOOTING, component=2)
@case("bend-45-saint-venant-z", 53.60111408, 5e-9, SHOOTING, component=2, torsion=0.140577)
def arc(component: int, torsion: float = 1.0 / 6.0, count: int = 40) -> float:
    """Displacement of the tip, of rigid links; the arc turns towards -y."""
    bent = bend_in_space(
        square(25.0 * pi),
        count,
        PULL,
        curvature=lambda s: np.outer(np.ones_like(s), [0.0, 0.0, -0.01]),
        stiffness=(5e6 * torsion, EI, EI),
    )
    return float(bent.displacement[component])


@case("bend-45-parabola-y", 13.7208006040, 2e-3, KYNEMA, component=1)
@case("bend-45-parabola-z", 53.5776450627, 8e-3, KYNEMA, component=2)
def parabola(component: int, count: int = 40) -> float:
    """Displacement of the tip of the parabola, of rigid links."""
    bend = (TIP[1] / TIP[0] - MIDDLE[1] / MIDDLE[0]) / (TIP[0] - MIDDLE[0])
    start = TIP[1] / TIP[0] - bend * TIP[0]
    slope = start + 2.0 * bend * np.linspace(0.0, TIP[0], 4001)  # a table of the arc length, 1e-8 of the curvature
    arcs = (np.arcsinh(slope) + slope * np.hypot(1.0, slope)) / (4.0 * bend)
    arcs, curvature = arcs - arcs[0], -2.0 * bend * np.hypot(1.0, slope) ** -3
    bent = bend_in_space(
        square(float(arcs[-1])),
        count,
        PULL,
        curvature=lambda s: np.outer(np.interp(s, arcs, curvature), [0.0, 0.0, 1.0]),
        stiffness=(EI, EI, EI),
    )
    x, y, z = bent.displacement
    turned = (x + 1j * y) * np.exp(-1j * atan(start))
    return float((turned.real, turned.imag, z)[component])


@case("straightened-helix", 0.0, 0.0, "a moment -K psi cancels a uniform twist and curvature psi")
def gap(count: int = 40) -> float:
    """Distance of the tip of rigid links from that of the straight rod, over its length; two turns at rest."""
    rest, stiffness = np.array([1.1, 0.4, 2.0 * pi * 2.0]), np.array([0.7, 1.0, 1.9])
    rod = Beam(length=1.0, bending_stiffness=1.0, mass_per_length=1.0, supports=("clamped", "free"))
    bent = bend_in_space(
        rod,
        count,
        moment=-stiffness * rest,
        curvature=lambda s: np.outer(np.ones_like(s), rest),
        stiffness=stiffness,
    )
    return float(np.linalg.norm(bent.tip - [1.0, 0.0, 0.0]))
