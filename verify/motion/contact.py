"""Contact of a slider with a beam: friction law, size of the two-way coupling, and the coupled beam at the start."""

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.surface import section_at
from verify.linear.system import RESONANCE
from verify.linear.time_basis import Ratio, TimeBasis
from verify.motion.records import Law
from verify.options import NormalChoice
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

if TYPE_CHECKING:
    from verify.linear.field import HarmonicField
    from verify.motion.surface import Stage

FELT = 1e-3
"""Relative change of the surface motion from which coupling = "auto" is two-way."""
LEFT_OUT = "coupling: inertia and weight of the slider across the beam are left out"
HAIR = 1e-3
"""Distance of the forces that stand for a couple, over 1/k, or over L/50 where that is shorter."""
PASSES = 4
"""Fixed-point iterations for the material point under the slider; each reduces its error by (h/2) w'' and more."""


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


class Coupling(Struct, frozen=True, kw_only=True):
    """Whether slider and beam are coupled two-way, and the size of what one-way coupling leaves out."""

    two_way: bool
    """Whether the slider acts on the beam."""
    friction_size: float | None
    """Surface speed due to full friction over that due to the drive; None where the drive moves no surface there."""
    normal_size: float
    """m omega^2 |G|: surface motion due to the inertia of a slider held on the surface, over its own motion."""
    normal: NormalChoice
    """massless: the normal reaction is left out, whatever its size."""
    forced: bool
    """Whether the slider states the coupling; otherwise the larger of the sizes that act decides."""

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
        """Whether the sizes call for two-way coupling, whatever the slider states."""
        size = self.relative_size
        return size is None or size > FELT

    @property
    def notes(self) -> tuple[str, ...]:
        """Coupling and sizes, and what a one-way or massless slider leaves out."""
        friction = "infinite" if self.friction_size is None else f"{self.friction_size:.1e}"
        way = "two-way" if self.two_way else "one-way"
        sizes = f"coupling: {way}; relative size of friction {friction}, of normal inertia {self.normal_size:.1e}"
        simplified = self.normal == "massless" or (not self.two_way and self.normal_size > FELT)
        return (sizes, LEFT_OUT) if simplified else (sizes,)


class Margins(Struct, frozen=True, kw_only=True):
    """Validity of a run; each margin is small where its assumption holds."""

    lift_off: float
    """Largest downward acceleration of the surface over g_eff: a free slider lifts off above 1.

    Under the slider during the run; of a beam alone the largest along it, steady."""
    nonlinearity: float
    """(kL)^2 <theta^2>: the axial inertia of a roller-ended chain that linear theory leaves out."""
    model_form: float | None
    """Timoshenko's frequency over Euler-Bernoulli's at the mode nearest the drive, less 1.

    None unless the beam is uniform, pinned at both ends and carries nothing: there it has a closed form."""
    discretisation: float | None
    """Leading error of the discrete frequency at that mode; None for the exact beam and where no law is known."""


def larger(friction_size: float | None, normal_size: float) -> float | None:
    """The larger size; None stays None, because nothing bounds it."""
    return None if friction_size is None else max(friction_size, normal_size)


def surface_speed(field: "HarmonicField", x: float) -> float:
    """First-order speed amplitude of the surface at x, (h/2) omega |w'|, m/s."""
    return section_at(field.beam, x).surface_distance * field.omega * float(abs(field.slope([x]))[0])


def friction_speed(slider: Slider, beam: Beam, omega: float, turning: complex) -> float:
    """Surface speed due to full friction, m/s: a couple (h/2) mu N turns the beam, the surface lies h/2 off.

    `beam` has the slider's own section (`section_at`).
    """
    return float(slider.mu * slider.load * beam.surface_distance**2 * omega * abs(turning))


def coupling_of(
    slider: Slider, beam: Beam, frequency_hz: float, surface_speed: float, receptance: complex, turning: complex
) -> Coupling:
    """One-way or two-way by size, unless the slider states it.

    `receptance` is G(x, x) at the drive frequency, m/N, `turning` the slope there under a unit couple, rad/(N m).
    Full friction is a couple (h/2) mu N; a mass held on the surface loads the beam by m omega^2 w.
    """
    omega = 2.0 * np.pi * frequency_hz
    speed = friction_speed(slider, beam, omega, turning)
    found = Coupling(
        two_way=slider.coupling == "two-way",
        friction_size=float(speed / surface_speed) if surface_speed > 0.0 else None,
        normal_size=float(slider.mass * omega**2 * abs(receptance)),
        normal=slider.normal,
        forced=True,
    )
    return found


def couple(beam: Beam, x: float, frequency_hz: float) -> tuple[PointForce, ...]:
    """A unit couple at x, 1 N m, as five close forces from x inwards: the derivative of a force by its place, order 4.

    Curvature jumps under a couple: elements turn too little by up to 0.066 l/EI, links of length l by 0.15, at an end
    by 0.30.
    """
    near = HAIR * min(float(np.sqrt(beam.wave_constant / (2.0 * np.pi * frequency_hz))), 0.02 * beam.length)
    inwards = near if x < 0.5 * beam.length else -near
    places = x + inwards * np.arange(5)
    powers = np.vander((places - x) / inwards, increasing=True).T  # of the places as rounded
    weights = np.linalg.solve(powers, np.eye(5)[1]) / inwards
    return tuple(PointForce(position=float(p), amplitude=float(w)) for p, w in zip(places, weights, strict=True))


def turned_by(field: "HarmonicField", x: float) -> complex:
    """Slope at x of the field under `couple` there, rad/(N m)."""
    return complex(field.slope([x])[0])


def modal_turning(basis: TimeBasis, x: float, at: Array, omega: float, damping: Ratio) -> ComplexArray:
    """Slopes at places `at` under a unit couple at x, (n,), rad/(N m), of all modes and of the truncated ones.

    Their sum falls as slowly as 1/n, so that the tail is added where modes are cut off.
    """
    here = basis.shapes(np.array([x]), 1)[:, 0]
    shares = here / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
    found = np.asarray(shares @ basis.shapes(at, 1), dtype=np.complex128)
    if basis.tail is None:
        return found
    frequency = omega / (2.0 * np.pi)
    tail = basis.tail(couple(basis.beam, x, frequency), frequency, damping)
    return np.asarray(found + tail(at, 1), dtype=np.complex128)


def modal_receptance(basis: TimeBasis, x: float, omega: float, damping: Ratio) -> ComplexArray:
    """Deflection of every mode under a unit force e^{i omega t} at x, (n,): phi / (omega_n^2 - omega^2 + ...)."""
    stiff = basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega
    return np.asarray(basis.shapes(np.array([x]), 0)[:, 0] / stiff)


def weighed_down(basis: TimeBasis, x: float, load: float) -> Array:
    """Modal amplitudes of a beam at rest under a weight on its surface at x, (n,).

    The weight acts at the material point x + (h/2) w', square to the surface, so that it also turns it by (h/2) w'.
    """
    half, here = section_at(basis.beam, x).surface_distance, basis.shapes(np.array([x]), 1)[:, 0]
    still = np.zeros(len(basis.omegas))
    for _ in range(PASSES):
        at = np.array([min(max(x + half * float(still @ here), 0.0), basis.beam.length)])
        lean = half * float(still @ basis.shapes(at, 1)[:, 0])
        still = -load * (basis.shapes(at, 0)[:, 0] + lean * here) / basis.omegas**2
    return np.asarray(still)


def carried_along(basis: TimeBasis, stage: "Stage", x: float, slider: Slider, damping: Ratio) -> tuple[Array, Array]:
    """What the slider's mass at rest at x adds to a steady beam at the stage's time 0: (q, dq/dt), (n,) each.

    W = W_0 / (1 - m omega^2 G): the mass loads the beam by m omega^2 W. Raises InputError at a resonance.
    """
    omega = stage.omega
    response = modal_receptance(basis, x, omega, damping)
    driven = stage.drive_shapes(np.array([x]), 0)[:, 0]
    loop = 1.0 - slider.mass * omega**2 * complex(basis.shapes(np.array([x]), 0)[:, 0] @ response)
    if abs(loop) < RESONANCE:
        raise InputError(
            f"slider.mass = {slider.mass!r} kg held at {x!r} m is in resonance with the drive: give the beam a "
            "loss_factor or choose another mass"
        )
    force = slider.mass * omega**2 * (driven[0] + 1j * driven[1]) / loop * np.exp(1j * omega * stage.origin)
    phasors = force * response
    return phasors.real, (1j * omega * phasors).real
