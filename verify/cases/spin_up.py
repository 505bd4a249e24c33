"""Spin-up: largest lag, over L, of the tip of a cantilever on a hub that accelerates to 6 rad/s in 15 s.

T. R. Kane, R. R. Ryan and A. K. Banerjee, J. Guidance 10 (1987) 139, with the data of J. C. Simo and L. Vu-Quoc, J.
Appl. Mech. 53 (1986) 849: a linear model without centrifugal stiffening bends without bound. Order 2 of links,
4 with joints that follow the axial force; of elements 4, and 2 in the time step.
"""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np

from verify.arrays import Array
from verify.cases.base import case
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import tensioned
from verify.chain.motion import check_moved, simulate
from verify.chain.system import build_system
from verify.elements.nonlinear import NonlinearHermite
from verify.elements.nonlinear_motion import large_motion
from verify.problem.base_motion import Base
from verify.problem.beam import Beam
from verify.settings import Joints

BEAM = Beam(length=10.0, bending_stiffness=1.4e4, mass_per_length=1.2, supports=("clamped", "free"))
RIGID = """extrapolated: links of the suite with joints that follow the axial force -0.57375066 m, with joints EI/l \
-0.5737507 m; elements with EA = 2.8e10 N -0.5737517 m"""
AXIAL = "16 nonlinear elements of the suite, extrapolated in step: -0.5737869 m"
SPEED, DURATION, EA = 6.0, 15.0, 2.8e7
TIMES = np.linspace(6.0, 7.5, 301)
"""The largest lag is at 6.76 s."""


def hub(time: float) -> tuple[float, float, float]:
    """Angle, rad, rate and acceleration of the hub while it accelerates."""
    w, rate = 2.0 * pi / DURATION, SPEED / DURATION
    angle = rate * (0.5 * time**2 + (cos(w * time) - 1.0) / w**2)
    return angle, rate * (time - sin(w * time) / w), rate * (1.0 - cos(w * time))


def largest(lags: Array) -> float:
    """The least value of a smooth curve at `TIMES`, over L."""
    from scipy.interpolate import CubicSpline

    curve = CubicSpline(TIMES, lags)
    return float(curve(np.append(TIMES, curve.derivative().roots(extrapolate=False))).min()) / BEAM.length


@case("spin-up", -0.057375066, 1e-7, RIGID)
@case("spin-up-tensioned", -0.057375066, 1e-7, RIGID, joints="tensioned")
def lag(joints: Joints = "series", count: int = 20, tolerance: float = 1e-7) -> float:
    """Lag of rigid links."""
    system = replace(build_system(BEAM, count), base=Base(rotation=hub))
    system = tensioned(system) if joints == "tensioned" else system
    motion = simulate(system, at_rest(system), TIMES, tolerance=tolerance)
    check_moved(motion)
    return largest(motion.in_base()[:, -1, 1])


@case("spin-up-elements", -0.0573786, 2e-7, AXIAL)
def lag_of_elements(count: int = 8, tolerance: float = 1e-7) -> float:
    """Lag of nonlinear elements with EA = 2.8e7 N."""
    model = NonlinearHermite(BEAM, count, axial_stiffness=EA)
    return largest(large_motion(model, TIMES, base=Base(rotation=hub), tolerance=tolerance).tip[:, 1])
