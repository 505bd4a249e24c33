"""Hanging chain: natural frequencies omega sqrt(L / g) of uniform bars without springs that hang from a pin.

Many bars converge with order 2 to a continuous chain, j_{0,n} / 2. Elements have
a small EI, which adds 7e-6, and under tension modes of their slopes at 2 sqrt(EI/rho A)/l^2: 64 have them above mode 2.
"""

from math import pi, sqrt

import numpy as np

from verify.cases.base import case
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.system import ChainSystem
from verify.elements.nonlinear import NonlinearHermite
from verify.problem.beam import Beam
from verify.segments.chain import link_inertia
from verify.validation import check_integer

ZERO = 5.520078110286311  # the second of J_0


@case("hanging-two-bars", sqrt(6.0 + 12.0 / sqrt(7.0)), 1e-15, "2 x 2 eigenvalue problem by hand", mode=2, count=2)
@case("hanging-chain", 0.5 * ZERO, 1e-15, "Daniel Bernoulli 1733: J_0(2 omega sqrt(L / g)) = 0", mode=2)
def frequency(mode: int, count: int = 200) -> float:
    """Frequency of rigid links, linearised. Raises InputError for more modes than links."""
    check_integer("count", count, mode)
    unit, zero = np.full(count, 1.0 / count), np.zeros(count)
    links = {"lengths": unit, "masses": unit, "inertias": link_inertia(unit, unit)}
    system = ChainSystem(**links, stiffness=zero, dashpots=zero, gravity=(1.0, 0.0))
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1])


@case("hanging-chain-elements", 0.5 * ZERO, 1e-5, "Daniel Bernoulli 1733; EI = 1e-7 rho A g L^3", mode=2)
def frequency_of_elements(mode: int, count: int = 64) -> float:
    """Frequency of nonlinear elements that hang. Raises InputError for fewer than 64."""
    check_integer("count", count, 64)
    beam = Beam(length=1.0, bending_stiffness=1e-7, mass_per_length=1.0, supports=("pinned", "free"))
    hung = NonlinearHermite(beam, count, axial_stiffness=1e6).bend(gravity=(1.0, 0.0))
    return 2.0 * pi * float(hung.frequencies_hz(flapping=True)[mode - 1])
