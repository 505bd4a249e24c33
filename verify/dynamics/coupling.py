"""Coupling of sliders and beam: the size of what one-way coupling leaves out."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from verify.arrays import Array, ComplexArray
from verify.dynamics.linear_system import damped_field
from verify.linear.surface import section_at
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider

if TYPE_CHECKING:
    from verify.dynamics.linear_system import Stage

COUPLED = 1e-3
"""Relative change of the surface motion above which one-way coupling is an error to state."""
NEAR = 1e-3
"""Distance of the forces that represent a couple, over 1/k, or over L/50 where that is shorter."""
Receptance = Callable[[float, Array], tuple[ComplexArray, ComplexArray]]
"""(x, places) -> deflections there under a unit force at x, m/N, and slopes under a unit couple, rad/(N m)."""


class Coupling(Struct, frozen=True, kw_only=True):
    """Whether sliders and beam are coupled two-way, and the size of what one-way coupling leaves out."""

    two_way: bool
    friction_size: float | None
    """Surface speed due to full friction over that due to the drive; None where the drive moves no surface there."""
    normal_size: float
    """Surface motion due to the normal load over its motion by the drive: N |G| / |w| of a slider with contact, of a
    bilateral one m omega^2 |G| of its inertia. Infinite where the drive does not move a loaded surface."""

    @property
    def relative_size(self) -> float | None:
        """The larger of the sizes; None where the drive does not move the surface under the slider."""
        return None if self.friction_size is None else max(self.friction_size, self.normal_size)


def coupling_of(
    beam: Beam, sliders: Sequence[Slider], starts: Sequence[float], stage: "Stage", receptance: Receptance
) -> Coupling:
    """Sizes under the slider where they are largest, by the loads of all.

    Full friction mu N is a couple (h/2) mu N on the beam, which turns its section and so moves the surface h/2 off.
    """
    places, omega = np.array(starts), stage.omega
    half = np.array([section_at(beam, x).surface_distance for x in starts])
    drive = [abs(stage.drive_shapes(places, derivative)[0]) for derivative in (0, 1)]
    normal, friction = np.zeros(len(places)), np.zeros(len(places))
    for x, slider, lever in zip(starts, sliders, half, strict=True):
        lifted, turned = receptance(x, places)
        with np.errstate(divide="ignore", invalid="ignore"):
            loaded = np.where(drive[0] > 0.0, slider.load * abs(lifted) / drive[0], np.inf)
        normal += slider.mass * omega**2 * abs(lifted) if slider.contact is None else loaded
        friction += slider.mu * slider.load * lever * half * omega * abs(turned)
    speeds = half * omega * drive[1]
    return Coupling(
        two_way=sliders[0].coupling == "two-way",
        friction_size=float((friction / speeds).max()) if (speeds > 0.0).all() else None,
        normal_size=float(normal.max()),
    )


def modal_receptance(basis: TimeBasis, omega: float, damping: Ratio) -> Receptance:
    """Of all modes, and for the slope of the truncated ones too: their sum falls as slowly as 1/n."""
    compliance = 1.0 / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)

    def receptance(x: float, places: Array) -> tuple[ComplexArray, ComplexArray]:
        ends = ((basis.shapes(np.array([x]), derivative), basis.shapes(places, derivative)) for derivative in (0, 1))
        lifted, turned = (np.asarray((compliance * here[:, 0]) @ there, dtype=complex) for here, there in ends)
        if basis.tail is not None:
            hertz = omega / (2.0 * np.pi)
            turned += basis.tail(couple(basis.beam, x, hertz), hertz, damping)(places, 1)
        return lifted, turned

    return receptance


def field_receptance(
    beam: Beam, model: str, count: int | None, frequency_hz: float, damping: float | None
) -> Receptance:
    """Of the model's steady fields, with this damping ratio or the beam's own. Raises InputError."""

    def receptance(x: float, places: Array) -> tuple[ComplexArray, ComplexArray]:
        forces = (PointForce(position=x),), couple(beam, x, frequency_hz)
        fields = [damped_field(model, count, beam, some, frequency_hz, damping) for some in forces]
        return fields[0].deflection(places), fields[1].slope(places)

    return receptance


def couple(beam: Beam, x: float, frequency_hz: float) -> tuple[PointForce, ...]:
    """A unit couple at x, 1 N m, as five close forces from x inwards: the derivative of a force by its place, order 4.

    Curvature jumps under a couple: elements turn too little by up to 0.066 l/EI, links of length l by 0.15, at an end
    by 0.30.
    """
    near = NEAR * min(float(np.sqrt(beam.wave_constant / (2.0 * np.pi * frequency_hz))), 0.02 * beam.length)
    inwards = near if x < 0.5 * beam.length else -near
    places = x + inwards * np.arange(5)
    powers = np.vander((places - x) / inwards, increasing=True).T  # of the places as rounded
    weights = np.linalg.solve(powers, np.eye(5)[1]) / inwards
    return tuple(PointForce(position=float(p), amplitude=float(w)) for p, w in zip(places, weights, strict=True))
