"""Rotating cantilever: lead-lag frequencies omega sqrt(rho A L^4 / EI), hub speed in the same unit.

Their squares are those of the flapping frequencies less that of the speed. Order 2 of links, due to the centrifugal
force, 4 of elements. At a speed of 12 mode 1 would be 3.516 without that force; it flaps at 13.17.
"""

from dataclasses import replace
from math import pi

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, OMEGA, inextensible
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise, tensioned
from verify.chain.system import build_system
from verify.settings import Joints
from verify.validation import check_integer

SERIES = "A. D. Wright et al., J. Appl. Mech. 49 (1982) 197: power series, summed in 60 digits"


@case("rotating-cantilever-1", 5.42704927779, 5e-12, SERIES, mode=1, speed=12.0)
@case("rotating-cantilever-3", 78.70492478, 5e-9, SERIES, mode=3, speed=12.0)
@case("rotating-cantilever-tensioned-1", 5.42704927779, 5e-12, SERIES, mode=1, speed=12.0, joints="tensioned")
@case("rotating-cantilever-tensioned-3", 78.70492478, 5e-9, SERIES, mode=3, speed=12.0, joints="tensioned")
def frequency(mode: int, speed: float, joints: Joints = "series", count: int = 80) -> float:
    """Frequency of rigid links, linearised. Raises InputError for more modes than links."""
    check_integer("count", count, mode)
    system = replace(build_system(CANTILEVER, count), hub_rate=speed * OMEGA)
    system = tensioned(system) if joints == "tensioned" else system
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1]) / OMEGA


@case("rotating-cantilever-elements-1", 5.42704927779, 5e-12, SERIES, mode=1, speed=12.0)
@case("rotating-cantilever-elements-3", 78.70492478, 5e-9, SERIES, mode=3, speed=12.0)
def frequency_of_elements(mode: int, speed: float, count: int = 32) -> float:
    """Frequency of nonlinear elements about their steady rotation."""
    spun = inextensible(count).bend(rate=speed * OMEGA)
    return float(spun.frequencies_hz()[mode - 1]) * 2.0 * pi / OMEGA
