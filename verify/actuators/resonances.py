"""Resonances, antiresonances, coupling, impedance and circuit branches of a transducer whose tip is free.

The frequencies are those without losses. The count of W. Wittrick and F. Williams (Q. J. Mech. Appl. Math. 24:263,
1971) brackets each of them, so that none is missed; a motion that the voltage does not excite has no electrical
resonance and is left out.
"""

from math import pi, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

from verify.actuators.port import Actuator
from verify.actuators.transducers import Longitudinal, Parts
from verify.errors import InputError
from verify.validation import check_integer, check_type

if TYPE_CHECKING:
    from verify.arrays import Array

SPLIT = 0.381966  # node within each line, so that its clamped modes coincide with no mode of the transducer
UNCOUPLED = 1e-9  # relative distance of resonance and antiresonance, k_eff^2/2, below which a mode is not electrical


class Branch(NamedTuple):
    """A resonance as a series branch of the equivalent circuit."""

    capacitance: float
    """C_n, F."""
    inductance: float
    """L_n, H."""


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
    step = 1e-8 * frequency  # along the imaginary axis: the error is of second order, and nothing cancels
    inductance = float((impedance(actuator.lossless, frequency + 1j * step) / 1j).imag / (4.0 * pi * step))
    return Branch(1.0 / (float(2.0 * pi * frequency) ** 2 * inductance), inductance)


def _frequencies(actuator: Longitudinal, count: int) -> "tuple[Array, Array]":
    """(resonances, antiresonances), the first `count` of each, Hz. Raises InputError."""
    import numpy as np
    from scipy.optimize import bisect

    check_type("actuator", actuator, Longitudinal)
    check_integer("count", count, 1)
    parts, rigid = actuator.lossless.parts(), int(actuator.base == "free")
    scale = pi / sum(line.length / complex(line.speed).real for line in parts if line is not None)
    lowest = 1e-6 * scale  # below it the count is lost in rounding

    def mode(number: int, is_open: bool) -> float:
        """Angular frequency of an elastic mode, from 1."""

        def excess(omega: float) -> float:
            return _modes_below(actuator, parts, omega, is_open) - rigid - number + 0.5

        if excess(lowest) > 0.0:
            raise InputError(
                f"actuator.base = {actuator.base!r}: the spring is too soft to tell from none, give 'free'"
            )
        upper = scale
        while excess(upper) < 0.0:
            upper *= 2.0
        return float(bisect(excess, lowest, upper, xtol=1e-15 * scale, rtol=1e-15))

    total = 2 * count
    while True:
        short = np.array([mode(number, False) for number in range(1, total + 1)])
        open_ = np.array([mode(number, True) for number in range(1, total + 1)])
        # the electrodes add stiffness of rank 1: an uncoupled mode is as far up in `open_` as in `short`, or one before
        uncoupled = np.isclose(short[:, None], open_, rtol=UNCOUPLED, atol=0.0)
        electrical = short[~uncoupled.any(axis=1)][:count], open_[:-1][~uncoupled.any(axis=0)[:-1]][:count]
        if min(map(len, electrical)) == count:
            return electrical[0] / (2.0 * pi), electrical[1] / (2.0 * pi)
        total *= 2


def _modes_below(actuator: Longitudinal, parts: Parts, omega: float, is_open: bool) -> int:
    """Number of natural frequencies below omega, the rigid motion included.

    It is the number of the lines' modes with clamped ends plus that of negative eigenvalues of the dynamic stiffness.
    """
    import numpy as np

    count, size, nodes = 0, 0, [0]
    stiffness = np.zeros((7, 7))
    for line in parts:
        for share in (SPLIT, 1.0 - SPLIT):
            if line is None:
                break
            theta = omega * share * line.length / complex(line.speed).real
            own, transfer = (omega * complex(line.impedance).real / one for one in (np.tan(theta), np.sin(theta)))
            stiffness[size : size + 2, size : size + 2] += [[own, -transfer], [-transfer, own]]
            count, size = count + int(theta // pi), size + 1
        nodes.append(size)
    active = parts.active
    if is_open != active.along:  # the speed is that with open electrodes along the field, with closed ones across it
        ends = np.ix_(nodes[1:3], nodes[1:3])
        added = (1.0 if is_open else -1.0) * complex(active.force_factor**2 / active.capacitance).real
        stiffness[ends] += added * np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness[0, 0] += actuator.base if isinstance(actuator.base, float) else 0.0
    free = slice(int(actuator.base == "fixed"), size + 1)
    return count + int(np.sum(np.linalg.eigvalsh(stiffness[free, free]) < 0.0))
