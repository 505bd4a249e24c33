"""Resonances, antiresonances, coupling, impedance and circuit branches of a transducer whose tip is free.

The frequencies are those without losses. The impedance at the tip, Z with short-circuited and Z + B^2/Y with open
electrodes, is then i X, where X rises between its poles (R. Foster, Bell Syst. Tech. J. 3:259, 1924), so that the phase
atan(X) rises steadily and passes a multiple of pi at each natural frequency. A motion that the voltage does not excite
has no electrical resonance and is left out, as is a suspension mode below a millionth of the first half wave.
"""

from math import pi, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from verify.actuators.port import Actuator
from verify.actuators.transducers import Longitudinal
from verify.errors import InputError
from verify.validation import check_integer, check_type

if TYPE_CHECKING:
    from verify.arrays import Array

UNCOUPLED = 1e-8  # relative distance of resonance and antiresonance, k_eff^2/2, below which a mode is not electrical
STEPS = 3001  # of frequency in a half wave: sections that differ a thousandfold reflect within some of them


class Branch(NamedTuple):
    """A resonance as a series branch of the equivalent circuit."""

    capacitance: float  # C_n, F
    inductance: float  # L_n, H


def resonances(actuator: Longitudinal, count: int = 1) -> "Array":
    """The first `count` frequencies with short-circuited electrodes, Hz, (count,). Raises InputError."""
    return _frequencies(actuator, count)[0]


def antiresonances(actuator: Longitudinal, count: int = 1) -> "Array":
    """The first `count` frequencies with open electrodes, Hz, (count,). Raises InputError."""
    return _frequencies(actuator, count)[1]


def coupling(actuator: Longitudinal, mode: int = 1) -> float:
    """Effective coupling factor of a resonance, sqrt(1 - (f_r/f_a)^2) (IEEE Std 176-1987, Eq. 124). InputError."""
    resonance, antiresonance = (one[-1] for one in _frequencies(actuator, mode))
    return sqrt(1.0 - float(resonance / antiresonance) ** 2)


def impedance(actuator: Actuator, frequency_hz: Any) -> Any:
    """Electrical impedance with a free tip, ohm, at frequencies in Hz, a number or (n,)."""
    port = actuator.port(2.0 * pi * frequency_hz)
    return port.short_impedance / (port.blocked_admittance * port.short_impedance + port.force_factor**2)


def branch(actuator: Longitudinal, mode: int = 1) -> Branch:
    """The series branch of a resonance: L_n = (dX/domega)/2, X the reactance, C_n = 1/(omega_n^2 L_n). InputError.

    Butterworth and Van Dyke: a free bar with its field across has C_n = 8 k31^2 C/((2n-1)^2 pi^2), L_n = l^2/(8 k31^2
    C v^2). The branches of all resonances and the clamped capacitance in parallel are the exact circuit.
    """
    frequency = resonances(actuator, mode)[-1]
    step = 1e-10 * frequency  # along the imaginary axis: the error is of second order, and nothing cancels
    inductance = float((impedance(actuator.lossless, frequency + 1j * step) / 1j).imag / (4.0 * pi * step))
    return Branch(1.0 / (float(2.0 * pi * frequency) ** 2 * inductance), inductance)


def _frequencies(actuator: Longitudinal, count: int) -> "tuple[Array, Array]":
    """(resonances, antiresonances), the first `count` of each, Hz. Raises InputError."""
    import numpy as np

    check_type("actuator", actuator, Longitudinal)
    check_integer("count", count, 1)
    lossless = actuator.lossless
    lines = [(line, line.layers if line is lossless.parts.active else 1) for line in lossless.parts if line]
    # modes of plain bars are at multiples of 0.5: at a step of the grid their sign is lost in rounding
    half_wave = 0.4987 / sum(layers * line.length / complex(line.speed).real for line, layers in lines)
    for halves in range(count + 1, 32 * (count + 1), count + 1):
        grid = half_wave * np.append(np.geomspace(1e-6, 1.0 / STEPS, 100)[:-1], np.arange(1, halves * STEPS) / STEPS)
        short, open_ = (_zeros(lossless, grid, is_open) for is_open in (False, True))
        alike = np.isclose(short[:, None], open_, rtol=UNCOUPLED, atol=0.0)
        coupled = short[~alike.any(axis=1)], open_[~alike.any(axis=0)]
        if min(map(len, coupled)) > count:  # one more: the range may end between two that are alike
            return coupled[0][:count], coupled[1][:count]
    raise InputError(f"actuator.material = {actuator.ceramic!r} excites no resonance {count}, check e31 and e33")


def _zeros(lossless: Longitudinal, grid: "Array", is_open: bool) -> "Array":
    """Natural frequencies within the range of `grid`, Hz."""
    import numpy as np
    from scipy.optimize import brentq

    unit = complex(lossless.parts.active.impedance).real

    def reactance(f: Any) -> Any:
        port = lossless.port(2.0 * pi * f)
        return (port.loaded_impedance() if is_open else port.short_impedance).imag / unit

    phase = np.arctan(reactance(grid))
    while (steep := np.flatnonzero(np.diff(phase) % pi > 0.5)).size:  # until no step holds a pole and a zero
        more = 0.5 * (grid[steep] + grid[steep + 1])
        more = more[(more > grid[steep]) & (more < grid[steep + 1])]
        if not more.size:
            break
        grid, phase = np.insert(grid, steep + 1, more), np.insert(phase, steep + 1, np.arctan(reactance(more)))
    at = np.flatnonzero((phase[:-1] < 0.0) & (phase[1:] >= 0.0) & (np.diff(phase) < 0.5 * pi))
    return np.array([brentq(reactance, grid[i], grid[i + 1], xtol=1e-15 * grid[i], rtol=1e-15) for i in at])
