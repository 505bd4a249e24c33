"""How far a beam turns where a couple acts on it, which is what friction at its surface is."""

import numpy as np

from verify.beam import Beam, PointForce
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import HarmonicField
from verify.models.time_basis import Ratio, TimeBasis

HAIR = 1e-3
"""Of 1/k, or of a fiftieth of the beam where that is shorter: between the forces that stand for a couple."""
FORCES = 5
"""In a row, which leave the fourth power of a hair."""


def couple(beam: Beam, x: float, frequency_hz: float) -> tuple[PointForce, ...]:
    """A unit couple at x, 1 N m, as forces a hair apart: a derivative over their place, from x inwards.

    Good to fourth order, though the shear that a force leaves behind makes its answers kink at its own place. Under a
    couple curvature jumps: elements turn too little by up to 0.066 l/EI, links of length l by 0.15, at an end by 0.30.
    """
    near = HAIR * min(float(np.sqrt(beam.wave_constant / (2.0 * np.pi * frequency_hz))), 0.02 * beam.length)
    inwards = near if x < 0.5 * beam.length else -near
    places = x + inwards * np.arange(FORCES)
    powers = np.vander((places - x) / inwards, increasing=True).T  # of where they came out, rounded
    weights = np.linalg.solve(powers, np.eye(FORCES)[1]) / inwards
    return tuple(PointForce(position=float(p), amplitude=float(w)) for p, w in zip(places, weights, strict=True))


def turned_by(field: HarmonicField, x: float) -> complex:
    """Slope at x of the field under `couple` there, rad/(N m)."""
    return complex(field.slope([x])[0])


def modal_turning(basis: TimeBasis, x: float, at: Array, omega: float, damping: Ratio) -> ComplexArray:
    """Slopes at places `at` under a unit couple at x, (n,), rad/(N m): of all modes, and of those beyond the last.

    Where they were cut off these are kept too: their sum falls as slowly as 1/n.
    """
    here = basis.shapes(np.array([x]), 1)[:, 0]
    shares = here / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
    found = np.asarray(shares @ basis.shapes(at, 1), dtype=np.complex128)
    if basis.tail is None:
        return found
    frequency = omega / (2.0 * np.pi)
    return np.asarray(
        found + basis.tail(couple(basis.beam, x, frequency), frequency, damping)(at, 1), dtype=np.complex128
    )
