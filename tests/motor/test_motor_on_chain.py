"""A motor on the nonlinear chain, beside the same motor on the linear one."""

import numpy as np

from verify.beam import Beam, PointForce
from verify.motor.run import run_motor
from verify.slider import Contact, Foot, Slider

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ = 900.0


def pushed(model, size):
    """Two periods of everything `size` times as large: forces, preload, what friction's slope asks of speeds."""
    forces = [
        PointForce(position=0.04, amplitude=size),
        PointForce(position=0.45, amplitude=0.7 * size, phase_deg=80.0),
    ]
    slider = Slider(
        mass=2e-3,
        mu=0.2,
        slope=100.0 / size,
        gravity=0.0,
        preload=0.3 * size,
        position=0.23,
        coupling="one-way",
        contact=Contact(stiffness=3e5, damping=5.0),
        foot=(Foot(length=0.02, points=3),),
    )
    asked = {"model": model, "count": 9, "start": "rest", "samples": 9, "steps_per_period": 400}
    return run_motor(BEAM, forces, HERTZ, 2.0 / HERTZ, slider=slider, **asked)


def test_on_a_small_motion_the_nonlinear_chain_carries_a_motor_as_the_linear_one_does():
    """Heights part by less than a millionth; speeds by what the chain draws in, of first order beside themselves."""
    sizes, apart = (1.0, 0.25, 0.0625), []
    for size in sizes:
        bent, straight = pushed("chain", size), pushed("segment", size)
        pairs = [(bent.height, straight.height), (bent.speed, straight.speed)]
        apart.append([np.abs(one - other).max() / np.abs(other).max() for one, other in pairs])
    heights, speeds = np.array(apart).T
    assert heights[-1] < 1e-6
    assert np.all(np.diff(heights) < 0.0)
    assert speeds[-1] < 1e-2
    orders = np.log2(speeds[:-1] / speeds[1:]) / 2.0
    assert np.all((orders > 0.9) & (orders < 1.1))
