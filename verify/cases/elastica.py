"""Elastica: tip of a cantilever under a dead transverse force P. Order 2 of links, 4 of elements."""

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, EI, inextensible
from verify.chain.statics import bend

TABLE = "K. E. Bisshopp and D. C. Drucker, Q. Appl. Math. 3 (1945) 272, elliptic integrals"


@case("elastica-deflection", 0.66996418, 5e-9, TABLE, load=4.0, component="deflection")
@case("elastica-shortening", 0.32894124, 5e-9, TABLE, load=4.0, component="shortening")
def tip(load: float, component: str, count: int = 80) -> float:
    """Deflection or shortening of rigid links over L at P L^2 / EI = `load`."""
    return float(getattr(bend(CANTILEVER, count, load * EI), component))


@case("elastica-elements", 0.66996418, 5e-9, TABLE, load=4.0)
def tip_of_elements(load: float, count: int = 16) -> float:
    """Deflection of nonlinear elements over L at P L^2 / EI = `load`."""
    return inextensible(count).bend(load * EI).deflection
