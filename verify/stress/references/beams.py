"""The beams that are pushed: plain figures of no symmetry, in metres and kilograms."""

from math import pi

from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam
from verify.section import Section

STRIP = Beam(
    length=0.73,
    width=0.031,
    thickness=0.0023,
    youngs_modulus=113e9,
    density=4470.0,
    supports=("pinned", "pinned"),
)
"""A strip of titanium between pins."""
STEPPED = replace(STRIP, section=(Section(length=0.4), Section(length=0.33, thickness=0.003)))
LADEN = replace(STRIP, mass=(PointMass(position=0.29, mass=0.05),))
"""The strip with a body of 50 g off its middle."""
PLAIN = Beam(length=0.73, bending_stiffness=3.1, mass_per_length=0.27)
"""Given by figures alone."""
COUPLE = ((-2.0, 1.0 / 12.0), (-1.0, -2.0 / 3.0), (1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
"""(steps from its place, weight): forces that are a couple's derivative over a step, of cubics to rounding."""


def held(*supports: str) -> Beam:
    """The strip between other supports."""
    return replace(STRIP, supports=supports)


def root_of(beam: Beam, frequency_hz: float, length: float) -> float:
    """Omega over sqrt(EI / (rho A)) times length^2, dimensionless."""
    return 2.0 * pi * frequency_hz / beam.wave_constant * length**2
