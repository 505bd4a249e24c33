"""A slider as the compiled loop has it: friction law, motion, working space."""

import numpy as np

from verify.arrays import Array
from verify.motion import records
from verify.motion.records import Law, Space
from verify.problem.beam import Beam
from verify.problem.slider import Slider


def law_of(slider: Slider, beam: Beam) -> Law:
    """The slider as the kernels read it, on a beam of its own section."""
    pressing = slider.normal_force / slider.mass
    static = slider.mu if slider.mu_static is None else slider.mu_static
    return Law(
        kinetic=float(slider.mu * pressing),
        static=float(static * pressing) if slider.law == "coulomb" else None,
        slope=slider.steepness,
        mass=float(slider.mass),
        half=float(beam.surface_distance),
        gravity=float(slider.gravity),
        following=slider.kinematics == "following",
        held=slider.normal == "held",
        load=float(slider.normal_force),
    )


def fresh_motion(speed: float = 0.0, stuck: bool = False) -> Array:
    """`Rider.motion` at the start."""
    motion = np.zeros(records.HARDEST + 1)
    motion[[records.V, records.STUCK]] = speed, stuck
    return motion


def of_all_steps(motion: Array, mass: float, seconds: float) -> tuple[float, float, float]:
    """(mean friction, newton, largest friction of all steps, mean speed of the surface, m/s); NaN without a step."""
    pushed, swept, hardest = (float(motion[of]) for of in (records.PUSHED, records.SWEPT, records.HARDEST))
    mean = 1.0 / seconds if seconds > 0.0 else float("nan")
    return mass * pushed * mean, mass * hardest, swept * mean


def contact_space() -> Space:
    """Working space of the kernels."""
    return Space(
        seen=np.zeros((3, 6)),
        slip=np.zeros(records.FIRST_EVENT + 2 * records.SPANS),
    )
