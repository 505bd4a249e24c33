"""Energy of a chain in time: constant without loads and damping, else work less losses."""

from dataclasses import replace
from math import pi

import numpy as np

from verify.cases.base import case
from verify.cases.beams import CANTILEVER, EI, OMEGA, STRIP
from verify.cases.large_amplitude import on_sine
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.motion import check_moved, simulate
from verify.chain.system import LinkLoad, build_system
from verify.settings import Tip
from verify.validation import check_integer

BALANCE = "balance of energy; the rest is the error of the time steps"


@case("energy-drift", 0.0, 0.0, BALANCE, step=1e-4)
def drift(step: float, count: int = 20) -> float:
    """Largest relative change over a linear period from L/20, rigid links by RK4 with `step`, s. Order 4."""
    system = build_system(STRIP, count)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    motion = simulate(system, on_sine(system, 0.05 * STRIP.length), np.linspace(0.0, 2.0 * pi / linear, 65), step=step)
    check_moved(motion)
    kinetic, elastic, _ = motion.energies()
    return float(abs(motion.residual()).max() / (kinetic + elastic)[0])


@case("energy-balance", 0.0, 0.0, BALANCE, tip="free", tolerance=1e-9)
def imbalance(tip: Tip, tolerance: float, count: int = 5) -> float:
    """Largest residual over the damping loss, rigid links under a hub that rotates and an eccentric harmonic load.

    With a moment and dashpots; the tip is free, or a roller with an axial spring.
    """
    check_integer("count", count, 3)
    force, moment, hertz = (0.2 * EI, -0.4 * EI), 0.13 * EI, 0.9 * OMEGA
    load = LinkLoad(link=count, at=0.3 / count, force=force, moment=moment, frequency_hz=hertz, phase_deg=40.0)
    system = replace(
        build_system(CANTILEVER, count),
        dashpots=np.full(count, 0.03 * count * EI / OMEGA),
        tip=tip,
        axial_spring=40.0 * EI if tip == "roller" else 0.0,
        hub_rate=0.25 * OMEGA,
        loads=(load,),
    )
    motion = simulate(system, at_rest(system), np.linspace(0.0, 1.0 / OMEGA, 17), tolerance=tolerance)
    check_moved(motion)
    return float(abs(motion.residual()).max() / motion.states[-1, -2])
