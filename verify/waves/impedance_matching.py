"""A device that takes up the wave: the impedance that matches the beam, and what another one leaves.

Impedance is force over velocity, Z = R + i (omega m - S/omega) of a dashpot R, a spring S and a mass m; or couple over
speed of turning. The beam ends at `distance` beyond the device, on any support; waves come from the other side, far
enough for their near field to have died. Source: flexural waves on a half-infinite beam, L. Cremer, M. Heckl,
Structure-Borne Sound, chapters on impedance and on reflection; the classic of matching is Z = conj(Z_beam).

With a loss factor conj(Z_beam) takes the most power and still reflects: k is complex. A wave e^{-ikx} from the left
makes s = w (or w') at the bare beam's place and comes back as r. A unit force (or couple) there sends A s e^{ikx} to
the left, with A = -i/(4 EI k^3) of an endless beam, as a force far to the left that makes s times A there: reciprocity.
The device pulls with i omega Z s Z_b/(Z + Z_b), so that

    Gamma = r - i omega A s^2 Z Z_b/(Z + Z_b) = Gamma_held (Z - Z_m)/(Z + Z_b),

where Gamma_held = r - i omega A s^2 Z_b is of a place that is held, and Z_m = -Z_b r/Gamma_held reflects nothing.
Without a loss factor Z_m = conj(Z_b) and |Gamma_held| = 1.
"""

from math import inf

import msgspec
import numpy as np

from verify.arrays import ComplexArray
from verify.checks import check_kind, check_number
from verify.errors import InputError
from verify.linear.fields import wavenumber
from verify.linear.places import as_typed
from verify.problem.beam import Beam, check_frequency
from verify.problem.device import Device, of_impedance

_ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Derivatives of the deflection that a support sets to zero."""
_WAYS = np.array([1j, 1.0])
"""Of e^{-q k x} away from where it starts: a wave, and a near field."""


class Ending(msgspec.Struct, frozen=True):
    """What a half-infinite beam is to a device at a place before its end."""

    own: complex
    """Z_b: force over velocity there, kg/s, or couple over speed of turning, N m s."""
    matched: complex
    """Z_m of the device that reflects nothing, likewise."""
    held: complex
    """What the wave is reflected by, at the place, where a device holds it."""


def ending(
    beam: Beam,
    frequency_hz: float,
    distance: float,
    support: str = "pinned",
    *,
    turning: bool = False,
    position: float | None = None,
) -> Ending:
    """What a half-infinite beam is to a device at `distance` (metres) from an end on a support.

    Against turning with `turning`. Raises InputError on a support where nothing moves, told by `position` where that is
    another, and for a beam that is not uniform.
    """
    check_number("position", distance, "metres from the end", at_least=0)
    told = distance if position is None else position
    if not beam.uniform:
        raise InputError(f"beam.{beam.added[0]}: the impedance of a half-infinite beam is that of a uniform one")
    k, omega = wavenumber(beam, frequency_hz), 2.0 * np.pi * frequency_hz
    unit = 4.0 * beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * k**3 / omega
    moved = _moved(k, distance, support, turning)
    if moved == 0.0:  # to rounding
        raise InputError(f"position = {told!r} m stands on a {support} support, where a device does nothing: move it")
    own = complex(unit / (1j * moved))
    back = _sent_back(k, distance, support, np.array([np.exp(-1j * k * distance), 0.0]))
    seen = k * (1j - back @ _WAYS) if turning else 1.0 + back.sum()
    held = complex(back[0] - seen**2 * own / unit)
    return Ending(own, -own * complex(back[0]) / held if beam.loss_factor else own.conjugate(), held)


def _moved(k: complex, distance: float, support: str, turning: bool) -> complex:
    """How the place answers a unit force, or turns by a unit couple, in 1/(4 EI k^3).

    The answer of an endless beam, -(i e^{-ikr} + e^{-kr})/(4 EI k^3) to a force and its derivative by the place to a
    couple, and both waves that the end sends back.
    """
    sent = -np.array([1j, 1.0]) * (-_WAYS * k if turning else 1.0)  # by the distance r from end to source, e^{-q k r}
    back = _sent_back(k, distance, support, sent * np.exp(-_WAYS * k * distance))
    there = (1.0 - 1j) * k**2 if turning else -(1.0 + 1j)
    return complex(there + (back @ (-_WAYS * k) if turning else back.sum()))


def _sent_back(k: complex, distance: float, support: str, arriving: ComplexArray) -> ComplexArray:
    """Wave and near field at the place, (2,), of what an end sends back, `arriving` there, (2,)."""
    rows = np.array([(-_WAYS) ** order for order in _ENDS[support]])
    given = np.array([_WAYS**order @ arriving for order in _ENDS[support]])
    return np.asarray(np.linalg.solve(rows, -given) * np.exp(-_WAYS * k * distance))


def beam_impedance(
    beam: Beam, frequency_hz: float, distance: float, support: str = "pinned", *, turning: bool = False
) -> complex:
    """Force over velocity that a half-infinite beam asks for at `distance` (metres) from an end on a support, kg/s.

    With `turning` couple over speed of turning, N m s. Raises InputError as `ending` does.
    """
    return ending(beam, frequency_hz, distance, support, turning=turning).own


def matched_impedance(
    beam: Beam, frequency_hz: float, distance: float, support: str = "pinned", *, turning: bool = False
) -> complex:
    """The impedance of a device that reflects nothing, kg/s, or N m s with `turning`. Raises InputError."""
    return ending(beam, frequency_hz, distance, support, turning=turning).matched


def reflection(impedance: complex, end: Ending) -> float:
    """|Gamma| at the device, by which one of this impedance reflects what comes."""
    return float(abs(end.held) * abs(impedance - end.matched) / abs(impedance + end.own))


def best_dashpot(end: Ending) -> tuple[float, float]:
    """(resistance, |Gamma| that it leaves) of the best dashpot alone; kg/s, N m s against turning.

    Without a loss factor |Z_b| and tan(|arg Z_b| / 2): over real R, |R - Z_m|^2 / |R + Z_b|^2 is least where
    Re(Z_m + Z_b) R^2 + (|Z_b|^2 - |Z_m|^2) R = Re(Z_m) |Z_b|^2 + Re(Z_b) |Z_m|^2 rises through nought, or at no
    dashpot, or, with losses, at inf: the stiffer the dashpot the less it leaves, down to what a held place does.
    """
    matched, own = end.matched, end.own
    a, b = (matched + own).real, abs(own) ** 2 - abs(matched) ** 2
    c = matched.real * abs(own) ** 2 + own.real * abs(matched) ** 2
    root, best = float(np.sqrt(max(b * b + 4.0 * a * c, 0.0))), 0.0
    if b >= 0.0 and b + root > 0.0:
        best = max(2.0 * c / (b + root), 0.0)
    elif a > 0.0:
        best = max((root - b) / (2.0 * a), 0.0)
    found = [(one, reflection(complex(one), end)) for one in (best, 0.0)]
    return min(*found, (inf, abs(end.held)), key=lambda one: one[1])


@as_typed
def matched_device(beam: Beam, frequency_hz: float, position: float, *, turning: bool = False) -> Device:
    """The device at a place (metres from the left end) that takes up what comes from the beam's longer side.

    Beyond it the beam ends on its nearer support. Raises InputError.
    """
    check_frequency("frequency_hz", frequency_hz, beam)
    check_kind("turning", turning, bool)
    check_number("position", position, "metres on the beam", at_least=0.0, below=beam.length * (1.0 + 1e-12))
    right = position > 0.5 * beam.length
    distance = max(beam.length - position, 0.0) if right else position
    support = beam.supports[right]
    end = ending(beam, frequency_hz, distance, support, turning=turning, position=position)
    return of_impedance(position, end.matched, 2.0 * np.pi * frequency_hz, turning=turning)
