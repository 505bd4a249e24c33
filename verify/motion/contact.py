"""What a slider does to a beam and what a run with one can be believed for: law, coupling, margins."""

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from msgspec import Struct
from verify.models.underfoot import standing_at
from verify.motion.records import Law
from verify.options import NormalChoice
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.models.fields import HarmonicField

FELT = 1e-3
"""From this relative change of the surface's motion on, a slider is coupled back to the beam."""


def law_of(slider: Slider, beam: Beam) -> Law:
    """The slider as the compiled loop sees it, on this beam's own section."""
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


class Coupling(Struct, frozen=True, kw_only=True):
    """Whether the beam feels the slider, and by how much."""

    two_way: bool
    """Whether the slider pushes back on the beam."""
    friction_size: float | None
    """Speed that full friction gives to the surface, over the speed the drive gives to it; None where that is 0."""
    normal_size: float
    """m omega^2 |G|: motion that the inertia of a slider held on the surface gives to it, over its own motion."""
    normal: NormalChoice
    """massless: the normal reaction is left out, whatever its size."""
    forced: bool
    """Whether the slider says which; otherwise the larger of the sizes that act decides."""

    @property
    def relative_size(self) -> float | None:
        """The larger of the sizes that act; None where the drive does not move the surface under the slider."""
        return larger(self.friction_size, self.normal_size if self.normal == "held" else 0.0)

    @property
    def pushes_back(self) -> bool:
        """Whether the beam carries the slider's weight and inertia."""
        return self.two_way and self.normal == "held"

    @property
    def felt(self) -> bool:
        """Whether the beam feels the slider, by size, whatever the slider says."""
        size = larger(self.friction_size, self.normal_size * (self.normal == "held"))
        return size is None or size > FELT

    @property
    def note(self) -> str:
        """In words, for the notes of a run."""
        carried = "; the beam carries its weight and inertia, and holds it where it would lift off" * self.pushes_back
        carried += "; friction keeps mu (m g + preload)" * self.pushes_back
        return f"coupling: {'two' if self.two_way else 'one'}-way{carried}; {self.told}" + (
            f"; {self.simplified}" if self.simplified else ""
        )

    @property
    def told(self) -> str:
        """In words: both sizes, and what is left out."""
        if self.friction_size is None:
            return "the drive does not move the surface under the slider"
        friction = f"full friction moves the surface by {self.friction_size:.1e} of its own speed"
        if self.normal == "massless":
            return friction
        return f"{friction}, the inertia of a slider held on it by {self.normal_size:.1e} of its motion"

    @property
    def simplified(self) -> str:
        """What a beam that does not carry its slider leaves out, in words; empty where it does or need not."""
        if self.normal == "held" and (self.two_way or self.normal_size <= FELT):
            return ""
        choice = "normal = 'massless'" if self.normal == "massless" else "coupling = 'one-way'"
        return (
            f"slider.{choice}, a simplification: held on the surface, its inertia would move the beam under "
            f"it by {self.normal_size:.2g} of its motion, and its weight would bend the beam"
        )


class Margins(Struct, frozen=True, kw_only=True):
    """How far a run can be believed; each is small where its assumption holds."""

    lift_off: float
    """Largest downward acceleration of the surface over g_eff: above 1 a slider that nothing holds would lift off.

    In a run with a slider under the slider during the run; of a beam alone the largest along it, steady."""
    nonlinearity: float
    """(kL)^2 <theta^2>: the axial inertia of a roller-ended chain that linear theory leaves out."""
    model_form: float | None
    """Frequency of Timoshenko's theory against Euler-Bernoulli's at the mode nearest the drive, less 1.

    None unless the beam is uniform, pinned at both ends and carries nothing: there it has a closed form."""
    discretisation: float | None
    """Leading error of the discrete frequency at that mode; None for the exact beam, and for a beam that is stepped or
    carries anything: no law is known there."""


def larger(friction_size: float | None, normal_size: float) -> float | None:
    """The size that decides; None stays, because nothing bounds it."""
    return None if friction_size is None else max(friction_size, normal_size)


def surface_speed(field: "HarmonicField", x: float) -> float:
    """First-order speed amplitude of the surface at x, (h/2) omega |w'|, m/s."""
    return standing_at(field.beam, x).surface_distance * field.omega * float(abs(field.slope([x]))[0])


def friction_speed(slider: Slider, beam: Beam, omega: float, turning: complex) -> float:
    """Speed that full friction gives to the surface, m/s: a couple (h/2) mu N turns the beam, the surface h/2 off.

    h is that of the beam's own section, as in `coupling_of`: give the beam that is `standing_at` the slider.
    """
    return float(slider.mu * slider.load * beam.surface_distance**2 * omega * abs(turning))


def coupling_of(
    slider: Slider, beam: Beam, frequency_hz: float, surface_speed: float, receptance: complex, turning: complex
) -> Coupling:
    """One-way or two-way by size, unless the slider says which.

    `receptance` is G(x, x) under it at the drive, m/N, `turning` the slope there under a unit couple, rad/(N m): both
    the driven beam's own, whose resonances they know. Full friction is a couple (h/2) mu N, the speed of the surface
    under it is held against the drive's. A mass held on the surface pushes with m omega^2 w, which moves the surface
    by m omega^2 G w.
    """
    omega = 2.0 * np.pi * frequency_hz
    answer = friction_speed(slider, beam, omega, turning)
    friction_size = float(answer / surface_speed) if surface_speed > 0.0 else None
    normal_size = float(slider.mass * omega**2 * abs(receptance))
    found = Coupling(
        two_way=slider.coupling == "two-way",
        friction_size=friction_size,
        normal_size=normal_size,
        normal=slider.normal,
        forced=slider.coupling != "auto",
    )
    return found if found.forced else replace(found, two_way=found.felt)
