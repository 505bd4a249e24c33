"""One point of the contact engine on a rigid surface: at rest, or a unit mass on a unit spring.

The mass on a spring is a modal row whose rotation moves the surface; a belt is a slider of prescribed speed.
"""

from math import inf

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.contact.state import CONTACT, COULOMB, FOOT, POINT, PRESCRIBED, SLIDER, TANH, Bodies, Kind
from verify.dynamics.excitation import Rows
from verify.dynamics.linear_system import Stage, Steps
from verify.dynamics.stepping import Assembly, Run, run_stages

LARGE = 1e100
"""Largest mass, stiffness, force; the smallest is its reciprocal."""
LEVER = 1e6
"""h/2 of the surface in units of its motion: rotations are 1e-6, their squares rounding."""


def contact_point(
    speed: float, mu: float, static: float, slope: float = 0.0, load: float = 1.0, force: float = 0.0, mass: float = inf
) -> Assembly:
    """One contact point at x = 0; an infinite mass is a slider of prescribed speed that moves the surface."""
    sliders, points, contacts = np.zeros(1, SLIDER), np.zeros(1, POINT), np.zeros(1, CONTACT)
    names = ["v", "inverse_mass", "mu", "mu_static", "steepness", "external_force"]
    for name, value in zip(names, (speed, 1.0 / mass, mu, static, slope, force), strict=True):
        sliders[name] = value
    for name, value in zip(("face", "image", "weight", "load", "lever"), (1.0, 1.0, 1.0, load, LEVER), strict=True):
        points[name] = value
    points["law"] = TANH if slope else COULOMB
    return Assembly(
        start=0.0,
        bodies=Bodies(sliders, np.zeros(0, FOOT), points, contacts),
        kind=Kind(PRESCRIBED, mass == inf, False, False, False, 0.0),
    )


def march(contact: Assembly, steps: int, dt: float, z: ComplexArray | None = None) -> Run:
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
    return run_stages([stage], np.empty(0, dtype=complex) if z is None else z, contact, np.empty(0))
