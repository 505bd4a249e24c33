"""Large amplitude: first frequency over the linear one of a beam between immovable hinges, released from a sine.

The chain's roller has an axial spring EA / L. Its first mode obeys Duffing's equation q'' + q + a^2/4 q^3 = 0, a its
amplitude in radii of gyration sqrt(I/A), but for the square of its slopes.
"""

from dataclasses import replace
from math import pi, sqrt

import numpy as np

from verify.arrays import Array
from verify.cases.base import case
from verify.cases.beams import STRIP
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.motion import check_moved, simulate
from verify.chain.system import ChainState, ChainSystem, build_system

WOINOWSKY = "S. Woinowsky-Krieger, J. Appl. Mech. 17 (1950) 35, elliptic integral; slopes, 4.6e-6, are neglected"
GYRATION = STRIP.surface_distance / sqrt(3.0)


def on_sine(system: ChainSystem, height: float) -> ChainState:
    """State of a chain at rest with joints on height sin(pi x / L)."""
    joints: Array = height * np.sin(pi * np.arange(system.n_links + 1) / system.n_links)
    return at_rest(system, np.diff(np.arcsin(np.diff(joints) / system.lengths), prepend=0.0))


@case("large-amplitude", 1.317776065, 5e-6, WOINOWSKY, amplitude=2.0)
def frequency(amplitude: float, count: int = 10) -> float:
    """Frequency of rigid links in time, for an amplitude from 1e-6 (rounding) to L/10."""
    system = replace(build_system(STRIP, count), axial_spring=STRIP.base_section.axial_stiffness / STRIP.length)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    times = np.linspace(0.0, 1.01 * pi / 2 / linear, 801)
    motion = simulate(system, on_sine(system, amplitude * GYRATION), times, tolerance=1e-10)
    check_moved(motion)
    middle = motion.deflection([0.5 * STRIP.length], reading="links")[:, 0]
    k = int(np.argmax(middle <= 0.0))  # stiffer than linear: zero within a quarter of the linear period
    return pi / 2.0 / float(np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]])) / linear
