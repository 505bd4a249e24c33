"""What a slider does to a beam and what a run with one can be believed for: law, coupling, margins."""

from typing import TYPE_CHECKING

import msgspec
import numpy as np

from verify.beam import Beam
from verify.slider import Slider
from verify.time_basis import Array

if TYPE_CHECKING:
    from verify.fields import HarmonicField

FELT = 1e-3
"""From this relative change of the surface's speed on, a slider is coupled back to the beam."""


def law_entries(slider: Slider, beam: Beam) -> Array:
    """The numbers the compiled loop sees (`contact_kernels.KIND` and so on), (8,)."""
    pressing = slider.normal_force / slider.mass
    static = slider.mu if slider.mu_static is None else slider.mu_static
    return np.array([
        float(slider.law == "coulomb"), slider.mu * pressing, static * pressing, slider.slope, slider.mass,
        0.5 * beam.thickness, slider.gravity, float(slider.kinematics == "following"),
    ])  # fmt: skip


class Coupling(msgspec.Struct, frozen=True, kw_only=True):
    """Whether the beam feels the slider, and by how much."""

    two_way: bool
    relative_size: float
    """Speed that full friction gives to the surface, over the speed the drive gives to it."""
    forced: bool


class Margins(msgspec.Struct, frozen=True, kw_only=True):
    """How far a run can be believed; each is small where its assumption holds."""

    lift_off: float
    """omega^2 A / g_eff: above 1 the surface falls faster than the slider can follow."""
    nonlinearity: float
    """(kL)^2 <theta^2>: the axial inertia of a roller-ended chain that linear theory leaves out."""
    model_form: float | None
    """Frequency of Timoshenko's theory against Euler-Bernoulli's at the mode nearest the drive, less 1."""
    discretisation: float | None
    """Leading error of the discrete frequency at that mode; None for the exact beam."""


def surface_speed(field: "HarmonicField", x: float) -> float:
    """First-order speed amplitude of the surface at x, (h/2) omega |w'|, m/s."""
    return 0.5 * field.beam.thickness * field.omega * float(abs(field.slope([x]))[0])


def coupling_of(slider: Slider, beam: Beam, frequency_hz: float, surface_speed: float) -> Coupling:
    """One-way or two-way by size, unless the slider says which.

    Full friction is a moment (h/2) mu N on an infinite beam, whose slope answers with the speed
    omega sqrt(2) / (4 EI k); its surface speed is held against the drive's.
    """
    omega = 2.0 * np.pi * frequency_hz
    k = float(np.sqrt(omega / beam.wave_constant))
    lever = 0.5 * beam.thickness
    answer = slider.mu * slider.normal_force * lever**2 * np.sqrt(2.0) * omega / (4.0 * beam.bending_stiffness * k)
    size = float(answer / surface_speed) if surface_speed > 0.0 else float("inf")
    forced = slider.coupling != "auto"
    two_way = slider.coupling == "two-way" if forced else size > FELT
    return Coupling(two_way=two_way, relative_size=size, forced=forced)
