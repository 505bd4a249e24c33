"""A device on the beam that takes up the wave: its matched impedance, what another leaves, any model's field.

Impedance is force over velocity, Z = R + S/(i omega) of a dashpot R and a spring S. The beam beyond the place ends at
`distance` from it on a pin; waves come from the other side, from far enough for their near field to have died. Source:
flexural waves on a half-infinite beam, L. Cremer, M. Heckl, Structure-Borne Sound, chapters on impedance and on
reflection; the classic of matching is Z = conj(Z_beam).
"""

from collections.abc import Sequence

import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_number
from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import HarmonicField, wavenumber
from verify.waves.imposed import Solve


def beam_impedance(beam: Beam, frequency_hz: float, distance: float) -> complex:
    """Force over velocity that a half-infinite beam asks for at `distance` (metres) from its pinned end, kg/s.

    Raises InputError on the support, where nothing moves, for a beam that is not uniform, and another end.
    """
    check_number("position", distance, "metres from the end", above=0)
    if not beam.uniform:
        raise InputError(f"beam.{beam.added[0]}: the impedance of a half-infinite beam is that of a uniform one")
    k, omega = wavenumber(beam, frequency_hz), 2.0 * np.pi * frequency_hz
    stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
    # a force and its mirror image of the other sign: w = F / (4 EI k^3) (-i - 1 + i e^{-2ikd} + e^{-2kd})
    seen = (-1j - 1.0 + 1j * np.exp(-2j * k * distance) + np.exp(-2.0 * k * distance)) / (4.0 * stiffness * k**3)
    return complex(1.0 / (1j * omega * seen))


def matched_impedance(beam: Beam, frequency_hz: float, distance: float) -> complex:
    """The impedance of a device that reflects nothing, kg/s. Raises InputError."""
    return beam_impedance(beam, frequency_hz, distance).conjugate()


def reflection(impedance: complex, own: complex) -> float:
    """|Gamma| that a device of this impedance leaves where the beam asks for `own`."""
    return float(abs(impedance - own.conjugate()) / abs(impedance + own))


def field_with_device(
    solve: Solve, forces: Sequence[PointForce], frequency_hz: float, position: float, impedance: complex
) -> HarmonicField:
    """A model's field with a device at `position`, by the beam's own answer to a unit force there.

    `solve` gives the model's field under forces at a frequency. Raises InputError where the device stands on a support.
    """
    free, unit = solve(forces, frequency_hz), solve([PointForce(position=position)], frequency_hz)
    at = np.array([position])
    own = complex(unit.deflection(at)[0])
    if own == 0.0:
        raise InputError(f"position = {position!r} m stands on a support, where a device does nothing: move it")
    resistance = 1j * free.omega * impedance
    pull = -resistance * complex(free.deflection(at)[0]) / (1.0 + resistance * own)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        return np.asarray(free.shapes(x, derivative) + pull * unit.shapes(x, derivative))

    reaction = PointForce(position=position, amplitude=float(abs(pull)), phase_deg=float(np.rad2deg(np.angle(pull))))
    return HarmonicField(
        model=free.model,
        count=free.count,
        beam=free.beam,
        frequency_hz=frequency_hz,
        forces=(*free.forces, reaction),
        shapes=shapes,
        theory=free.theory,
    )
