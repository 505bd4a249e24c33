"""Beams of the cases whose dimensionless figures hold for any beam."""

from math import sqrt

from verify.elements.nonlinear import NonlinearHermite
from verify.problem.beam import Beam

CANTILEVER = Beam(
    length=1.0, width=1.2, thickness=0.01, youngs_modulus=1e7, density=1000.0, supports=("clamped", "free")
)
EI, OMEGA = CANTILEVER.bending_stiffness, sqrt(CANTILEVER.bending_stiffness / CANTILEVER.mass_per_length)
"""EI of `CANTILEVER`, N m^2, and sqrt(EI / (rho A L^4)), rad/s."""
STRIP = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ = 4276.0  # of the wave on `STRIP`: a wavelength of 46 mm, 46 thicknesses


def inextensible(count: int, beam: Beam = CANTILEVER) -> NonlinearHermite:
    """Nonlinear elements with EA L^2 / EI = 1e8: strains below 1e-7, and rounding of EA's strain below 1e-8 of EI."""
    return NonlinearHermite(beam, count, axial_stiffness=1e8 * beam.bending_stiffness / beam.length**2)
