"""A slider of the contact engine on a rigid surface: at rest, or a unit mass on a unit spring.

The mass on a spring is a modal row whose rotation moves the surface; the slider has a prescribed speed then.
"""

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.cases.beams import STRIP
from verify.dynamics.arguments import PrescribedSlider
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.excitation import Rows
from verify.dynamics.linear_system import Stage, Steps
from verify.dynamics.stepping import Assembly, Run, run_stages
from verify.problem.slider import Slider

LEVER = 1e6
"""h/2 of the surface in units of its motion: rotations are 1e-6, their squares rounding."""


def on_surface(slider: Slider, speed: float | None = None) -> Assembly:
    """A slider in bilateral contact at x = 0, of prescribed speed on the mass on a spring."""
    slider = replace(slider, coupling="one-way") if speed is None else replace(slider, normal="massless")
    assembly = assemble(STRIP, [PrescribedSlider(slider, speed)], (0.0,))
    assembly.points["lever"] = LEVER
    return assembly


def march(assembly: Assembly, steps: int, dt: float, z: ComplexArray | None = None) -> Run:
    """March on a surface at rest, or on a unit mass on a unit spring with the state z = position - i speed."""

    def shapes(x: Array, derivative: int) -> Array:
        slope = -1.0 / LEVER  # the surface moves by -(h/2) w'
        return np.atleast_2d(slope * x if derivative == 0 else np.full(len(x), slope * (derivative == 1)))

    oscillator = Rows(rates=np.array([1j]), participations=np.array([-1j]), loads=np.zeros(1, dtype=complex))
    stage = Stage(
        field=lambda x, derivative, psi: np.zeros((1, len(x)), dtype=complex),
        edges=np.array([-1e300, 1e300]),
        degree=1,
        omega=1.0,
        steps=Steps(steps, dt, steps),
    )
    if z is not None:
        stage = replace(stage, rows=oscillator, shapes=shapes, edges=np.array([-1.0, 1.0]))
    return run_stages([stage], np.empty(0, dtype=complex) if z is None else z, assembly, np.empty(0))
