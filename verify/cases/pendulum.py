"""Flexible pendulum, EI / (m g L^3) = 0.01, released straight and level: the tip after sqrt(L / g), over L. Order 2."""

from dataclasses import replace

import numpy as np

from verify.cases.base import case
from verify.chain.kinematics import at_rest
from verify.chain.motion import check_moved, simulate
from verify.chain.system import build_system
from verify.elements.nonlinear import NonlinearHermite
from verify.elements.nonlinear_motion import large_motion
from verify.elements.plane_elements import Forces
from verify.problem.beam import Beam

BEAM = Beam(length=1.0, bending_stiffness=0.01, mass_per_length=1.0, supports=("pinned", "free"))
BOTH = "links and elements of the suite, extrapolated, agree to 1e-6"
TIMES = np.array([0.0, 1.0])
EA = 1e5  # the tip moves by 9e-6 of L for it


@case("pendulum", -0.519676, 1e-6, BOTH)
def height(count: int = 40) -> float:
    """Height of the tip of rigid links."""
    system = replace(build_system(BEAM, count), gravity=(0.0, -1.0))
    motion = simulate(system, at_rest(system), TIMES)
    check_moved(motion)
    return float(motion.joints()[-1, -1, 1])


@case("pendulum-elements", -0.519676, 1e-6, BOTH)
def height_of_elements(count: int = 16) -> float:
    """Height of the tip of nonlinear elements."""
    model = NonlinearHermite(BEAM, count, axial_stiffness=EA)
    return float(large_motion(model, TIMES, forces=Forces(gravity=np.array([0.0, -1.0]))).tip[-1, 1])
