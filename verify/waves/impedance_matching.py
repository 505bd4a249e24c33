"""Impedance matching of an absorbing device on a beam, and the reflection by any device.

Impedance is force over velocity, Z = R + i (omega m - S/omega) for a dashpot R, a spring S and a mass m; or couple over
angular velocity. The beam ends at `distance` behind the device, on any support; waves arrive from the other side
without near field. Source: flexural waves on a half-infinite beam, L. Cremer, M. Heckl, Structure-Borne Sound, chapters
on impedance and on reflection; the classical matching condition is Z = conj(Z_beam).

On the beam without device a wave e^{-ikx} from the left has the motion s = w (or w') at the device's position and the
reflection r. By reciprocity a unit force (or couple) at that position sends A s e^{ikx} to the left, A = -i/(4 EI k^3)
for an infinite beam. The device exerts i omega Z s Z_b/(Z + Z_b), so that

    Gamma = r - i omega A s^2 Z Z_b/(Z + Z_b) = Gamma_rigid (Z - Z_m)/(Z + Z_b),

where Gamma_rigid = r - i omega A s^2 Z_b is the reflection by a rigid device, and Z_m = -Z_b r/Gamma_rigid has no
reflection. Without losses Z_m = conj(Z_b) and |Gamma_rigid| = 1; with a loss factor k is complex, and conj(Z_b), which
absorbs the most power, still reflects.
"""

import msgspec
import numpy as np

from verify.arrays import ComplexArray
from verify.errors import InputError
from verify.exact.layout import HELD
from verify.linear.field import wavenumber
from verify.problem.beam import Beam, check_features, check_frequency
from verify.problem.device import Device, of_impedance
from verify.validation import check_number, check_type

_DECAY = np.array([1j, 1.0])  # q in e^{-q k x} away from a source: a wave, and a near field


class Ending(msgspec.Struct, frozen=True):
    """A half-infinite beam at a device near its end. Impedances in kg/s, against rotation in N m s."""

    own: complex  # Z_b, impedance of the beam
    matched: complex  # Z_m, impedance of a device without reflection
    rigid: complex  # Gamma_rigid, the reflection by a rigid device

    def reflection(self, impedance: complex) -> float:
        """|Gamma| at a device of an impedance in kg/s (rotational: N m s)."""
        return float(abs(self.rigid) * abs(impedance - self.matched) / abs(impedance + self.own))


def ending(
    beam: Beam, frequency_hz: float, distance: float, support: str = "pinned", *, turning: bool = False, name: str = ""
) -> Ending:
    """A half-infinite beam with a device at `distance` (m) from its end, against rotation if `turning`.

    Raises InputError at a support without motion (message with the `name` of the position) and for a non-uniform beam.
    """
    check_number("position", distance, "metres from the end", at_least=0)
    check_features(beam, "the half-infinite beam")
    k, omega = wavenumber(beam, frequency_hz), 2.0 * np.pi * frequency_hz
    unit = 4.0 * beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * k**3 / omega

    def returned(arriving: ComplexArray) -> ComplexArray:
        """Reflected wave and near field at the device, (2,), for those arriving from it, (2,)."""
        rows, decay = np.array([(-_DECAY) ** order for order in HELD[support]]), np.exp(-_DECAY * k * distance)
        right = np.array([_DECAY**order @ (arriving * decay) for order in HELD[support]])
        return np.asarray(np.linalg.solve(rows, -right) * decay)

    # motion under a unit force or couple, in 1/(4 EI k^3): that of an infinite beam, whose response at the distance r
    # is -(i e^{-ikr} + e^{-kr}), or its derivative by the source position, plus wave and near field from the end
    back = returned(-np.array([1j, 1.0]) * (-_DECAY * k if turning else 1.0))
    motion = (1.0 - 1j) * k**2 + back @ (-_DECAY * k) if turning else back.sum() - (1.0 + 1j)
    if motion == 0.0:
        name = name or f"position = {distance!r} m"
        raise InputError(f"{name} is on a {support} support, where a device has no effect: move it")
    own = complex(unit / (1j * motion))
    back = returned(np.array([1.0, 0.0]))
    s = k * (1j - back @ _DECAY) if turning else 1.0 + back.sum()
    rigid = complex(back[0] - s**2 * own / unit)
    return Ending(own, -own * complex(back[0]) / rigid if beam.loss_factor else own.conjugate(), rigid)


def matched_device(beam: Beam, frequency_hz: float, position: float, *, turning: bool = False) -> Device:
    """The device at a position (m from the left end) that absorbs the wave from the beam's longer side.

    The beam behind the device ends on the nearer support. Raises InputError.
    """
    check_frequency("frequency_hz", frequency_hz, beam)
    check_type("turning", turning, bool)
    check_number("position", position, "metres on the beam", at_least=0.0, below=beam.length * (1.0 + 1e-12))
    right = position > 0.5 * beam.length
    distance, support = max(beam.length - position, 0.0) if right else position, beam.supports[right]
    name = f"position = {position!r} m"
    end = ending(beam, frequency_hz, distance, support, turning=turning, name=name)
    return of_impedance(position, end.matched, 2.0 * np.pi * frequency_hz, turning=turning)
