"""Hanging chain: natural frequencies omega sqrt(L / g) of uniform bars without springs that hang from a pin.

Many bars converge with order 2 to a continuous chain, j_{0,n} / 2.
"""

from math import sqrt

import numpy as np

from verify.cases.base import case
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.system import ChainSystem
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
