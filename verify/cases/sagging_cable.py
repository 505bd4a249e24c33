"""Sagging cable: in-plane symmetric frequency over that of the taut string, of a cable between two fixed ends.

Irvine's parameter lambda^2 = (w L/H)^2 EA/H, with weight per length w and tension H; at 4 pi^2 the symmetric mode has
the frequency of the antisymmetric one. Order 2 of links, whose stretching is that of a spring at the end. Elements have
a small EI, and modes of their slopes from 2 sqrt(EI/rho A)/l^2 on: 64 have them above the first two modes.
"""

from math import pi

import numpy as np

from verify.arrays import Array
from verify.cases.base import case
from verify.chain.linearisation import linearise
from verify.chain.statics import solve_static
from verify.chain.system import ChainState, ChainSystem, LinkLoad
from verify.elements.nonlinear import NonlinearHermite
from verify.problem.beam import Beam
from verify.segments.chain import link_inertia
from verify.validation import check_integer

IRVINE = "H. M. Irvine and T. K. Caughey, Proc. R. Soc. A 341 (1974) 299: tan(W/2) = W/2 - 4 (W/2)^3/lambda^2"
RATIOS = {
    "1": (1.0, 1.040200487),
    "10": (10.0, 1.345124511),
    "crossover": (4.0 * pi**2, 2.0),
    "100": (100.0, 2.597184545),
}
"""Name: lambda^2, frequency over the string's."""
WEIGHT = 0.003
"""w L/H: the theory of small sag errs by its square, 1e-5. L, H and rho A are 1."""
BENDING = 1e-6  # EI/(H L^2), which adds up to 4e-5 to the frequency
FEWEST = 64  # elements whose soft modes are above the first two


def links(square: float, count: int = 80) -> float:
    """Frequency of rigid links without springs, linearised about their equilibrium."""
    unit, zero, axial = np.full(count, 1.0 / count), np.zeros(count), square / WEIGHT**2
    turns = WEIGHT * ((np.arange(count) + 0.5) / count - 0.5)
    force = 1.0 - axial * float(unit @ (1.0 - np.cos(turns)))  # with the spring's H = 1
    system = ChainSystem(
        lengths=unit,
        masses=unit,
        inertias=link_inertia(unit, unit),
        stiffness=zero,
        dashpots=zero,
        tip="roller",
        axial_spring=axial,
        axial_inertia=False,
        gravity=(0.0, -WEIGHT),
        loads=(LinkLoad(link=count, at=1.0 / count, force=(force, 0.0)),),
    )
    hung = solve_static(system, ChainState(np.diff(turns, prepend=0.0), zero))
    return symmetric(linearise(system, hung).frequencies(), square)


def elements(square: float, count: int = FEWEST) -> float:
    """Frequency of nonlinear elements, pulled by H, hung, then fixed. Raises InputError for fewer than `FEWEST`."""
    check_integer("count", count, FEWEST)
    beam = Beam(length=1.0, bending_stiffness=BENDING, mass_per_length=1.0, supports=("pinned", "pinned"))
    sliding, fixed = (NonlinearHermite(beam, count, square / WEIGHT**2, immovable=one) for one in (False, True))
    hung = fixed.bend(gravity=-WEIGHT, start=sliding.bend((1.0, 0.0), gravity=-WEIGHT))
    return symmetric(2.0 * pi * hung.frequencies_hz(), square)


def symmetric(omega: Array, square: float) -> float:
    """The first symmetric mode over the string's: the second beyond the crossover."""
    return float(omega[int(square > 4.0 * pi**2)]) / pi


for _name, (_square, _exact) in RATIOS.items():
    case(f"sagging-cable-{_name}", _exact, 2e-5, IRVINE, square=_square)(links)
    case(f"sagging-cable-elements-{_name}", _exact, 6e-5, IRVINE, square=_square)(elements)
