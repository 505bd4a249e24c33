"""A device that takes up the wave: the impedance that matches the beam, and what another one leaves.

Impedance is force over velocity, Z = R + i (omega m - S/omega) of a dashpot R, a spring S and a mass m; or couple over
speed of turning. The beam ends at `distance` beyond the device, on any support; waves come from the other side, far
enough for their near field to have died. Source: flexural waves on a half-infinite beam, L. Cremer, M. Heckl,
Structure-Borne Sound, chapters on impedance and on reflection; the classic of matching is Z = conj(Z_beam).
"""

import numpy as np

from verify.beam import Beam
from verify.checks import check_number
from verify.device import Device, of_impedance
from verify.errors import InputError
from verify.models.fields import wavenumber

_ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Derivatives of the deflection that a support sets to zero."""
_IDLE = {False: ("pinned", "clamped"), True: ("clamped", "guided")}
"""Supports on which a device across (False) or against turning (True) does nothing."""
_WAYS = np.array([1j, 1.0])
"""Of e^{-q k x} away from where it starts: a wave, and a near field."""


def beam_impedance(
    beam: Beam,
    frequency_hz: float,
    distance: float,
    support: str = "pinned",
    *,
    turning: bool = False,
    position: float | None = None,
) -> complex:
    """Force over velocity that a half-infinite beam asks for at `distance` (metres) from an end on a support, kg/s.

    With `turning` couple over speed of turning, N m s. The answer of an endless beam, -(i e^{-ikr} + e^{-kr})/(4 EI
    k^3) to a force and its derivative by the place to a couple, and both waves that the end sends back. Raises
    InputError on a support where nothing moves, told by `position` where that is another, and for a beam that is not
    uniform.
    """
    check_number("position", distance, "metres from the end", at_least=0)
    told = distance if position is None else position
    idle = f"position = {told!r} m stands on a {support} support, where a device does nothing: move it"
    if distance == 0.0 and support in _IDLE[turning]:
        raise InputError(idle)
    if not beam.uniform:
        raise InputError(f"beam.{beam.added[0]}: the impedance of a half-infinite beam is that of a uniform one")
    k, omega = wavenumber(beam, frequency_hz), 2.0 * np.pi * frequency_hz
    stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
    sent = -np.array([1j, 1.0]) * (-_WAYS * k if turning else 1.0)  # by the distance r from end to source, e^{-q k r}
    arriving = sent * np.exp(-_WAYS * k * distance)
    rows = np.array([(-_WAYS) ** order for order in _ENDS[support]])
    given = np.array([_WAYS**order @ arriving for order in _ENDS[support]])
    back = np.linalg.solve(rows, -given) * np.exp(-_WAYS * k * distance)
    there = (1.0 - 1j) * k**2 if turning else -(1.0 + 1j)
    seen = there + (back @ (-_WAYS * k) if turning else back.sum())
    if seen == 0.0:  # to rounding
        raise InputError(idle)
    return complex(4.0 * stiffness * k**3 / (1j * omega * seen))


def matched_impedance(
    beam: Beam, frequency_hz: float, distance: float, support: str = "pinned", *, turning: bool = False
) -> complex:
    """The impedance of a device that reflects nothing, kg/s, or N m s with `turning`. Raises InputError."""
    return beam_impedance(beam, frequency_hz, distance, support, turning=turning).conjugate()


def reflection(impedance: complex, own: complex) -> float:
    """|Gamma| that a device of this impedance leaves where the beam asks for `own`."""
    return float(abs(impedance - own.conjugate()) / abs(impedance + own))


def best_dashpot(own: complex) -> tuple[float, float]:
    """(resistance, |Gamma| that it leaves) of the best dashpot alone where the beam asks for `own`.

    |Z_b| and tan(|arg Z_b| / 2): over real Z, |Z - conj Z_b|^2 / |Z + Z_b|^2 is least where Z = |Z_b|.
    """
    return abs(own), float(np.tan(0.5 * abs(np.angle(own))))


def matched_device(beam: Beam, frequency_hz: float, position: float, *, turning: bool = False) -> Device:
    """The device at a place (metres from the left end) that takes up what comes from the beam's longer side.

    Beyond it the beam ends on its nearer support. Raises InputError.
    """
    check_number("position", position, "metres on the beam", at_least=0.0, below=beam.length * (1.0 + 1e-12))
    right = position > 0.5 * beam.length
    distance = max(beam.length - position, 0.0) if right else position
    support = beam.supports[right]
    own = beam_impedance(beam, frequency_hz, distance, support, turning=turning, position=position)
    return of_impedance(position, own.conjugate(), 2.0 * np.pi * frequency_hz, turning=turning)
