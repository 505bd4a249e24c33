"""Resonances, antiresonances, coupling, impedance and circuit branches of a transducer whose tip is free.

The frequencies are those without losses. The count of W. Wittrick and F. Williams (Q. J. Mech. Appl. Math. 24:263,
1971) brackets each of them, so that none is missed; a motion that the voltage does not excite has no electrical
resonance and is left out.
"""

from math import gcd, pi, sqrt, tan
from typing import TYPE_CHECKING, Any, NamedTuple

from verify.actuators.port import Actuator
from verify.actuators.transducers import Longitudinal, Parts
from verify.errors import InputError
from verify.validation import check_integer, check_type

if TYPE_CHECKING:
    from verify.arrays import Array

SPLIT = 0.381966  # node within each line, whose clamped modes then coincide with no mode of the transducer
POLISHED = 1e-7  # relative half width in which a frequency is polished
UNCOUPLED = 1e-8  # relative distance of resonance and antiresonance, k_eff^2/2, below which a mode is not electrical


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
    from scipy.optimize import bisect, brentq

    check_type("actuator", actuator, Longitudinal)
    check_integer("count", count, 1)
    lossless, rigid = actuator.lossless, int(actuator.base == "free")
    parts = lossless.parts
    # the count is lost in rounding far below the first mode, and at half waves of a line: 0.48 is not 0.5
    scale = 0.48 / sum(line.length / complex(line.speed).real for line in parts if line is not None)
    lowest = 1e-6 * scale

    def mode(number: int, is_open: bool) -> float:
        """Frequency of an elastic mode, from 1, Hz."""

        def excess(f: float) -> float:
            return _modes_below(actuator, parts, 2.0 * pi * f, is_open) - rigid - number + 0.5

        def rising(f: float) -> float:
            port = lossless.port(2.0 * pi * f)
            zero, pole = port.short_impedance, port.blocked_admittance * port.short_impedance + port.force_factor**2
            return complex(pole / zero if is_open else zero / pole).imag

        if excess(lowest) > 0.0:
            raise InputError(f"actuator.base = {actuator.base!r}: so soft a spring is lost in rounding, give 'free'")
        upper = scale
        while excess(upper) < 0.0:
            upper *= 2.0
        f = float(bisect(excess, lowest, upper, xtol=1e-15 * scale, rtol=1e-15))
        low, high = f * (1.0 - POLISHED), f * (1.0 + POLISHED)  # where nodes coincide, the count loses half the digits
        return float(brentq(rising, low, high, xtol=1e-15 * f, rtol=1e-15)) if rising(low) < 0.0 < rising(high) else f

    short, open_ = list[float](), list[float]()
    while True:
        short.append(mode(len(short) + 1, False))
        open_.append(mode(len(open_) + 1, True))
        # the electrodes add stiffness of rank 1: an uncoupled mode is as far up in `open_` as in `short`, or one before
        alike = np.isclose(np.array(short)[:, None], open_, rtol=UNCOUPLED, atol=0.0)
        coupled = np.array(short)[~alike.any(axis=1)][:count], np.array(open_)[:-1][~alike.any(axis=0)[:-1]][:count]
        if min(map(len, coupled)) == count:
            return coupled


def _modes_below(actuator: Longitudinal, parts: Parts, omega: float, is_open: bool) -> int:
    """Number of natural frequencies below omega, the rigid motion included.

    It is that of the clamped modes of the chain's elements plus that of negative eigenvalues of its dynamic stiffness.
    Each line has two elements, each stack two groups of layers that are periodic lines.
    """
    import numpy as np

    active = parts.active
    electrical = complex(active.force_factor**2 / active.capacitance).real
    count, node, stiffness = 0, 0, np.zeros((7, 7))
    for line in (one for one in parts if one is not None):
        layers = active.layers if line is active else 1
        # odd and prime to the number of layers: a mode with nodes at the ends of the group is lost in rounding
        group = next(one for one in range(round(SPLIT * layers) | 1, layers + 1, 2) if gcd(one, layers) == 1)
        for share, size in ((SPLIT, 1), (1.0 - SPLIT, 1)) if layers == 1 else ((1.0, group), (1.0, layers - group)):
            half = 0.5 * omega * share * line.length / complex(line.speed).real
            rigidity = omega * complex(line.impedance).real
            stretch, shift = rigidity / tan(half), -rigidity * tan(half)  # of both ends apart, and of both alike
            own, transfer = 0.5 * (stretch + shift), 0.5 * (stretch - shift)
            count += size * int(2.0 * half // pi)
            if layers > 1:  # its speed is that with open electrodes; closed ones soften it
                stretch -= 2.0 * electrical
                within = np.cos(np.arange(1, size) * pi / size)
                count += int(np.sum(stretch * (1.0 - within) + shift * (1.0 + within) < 0.0))
                phase = 2.0 * np.arctan(np.sqrt(complex(-shift / (stretch or 1e-300))))
                scale = 0.5 * (stretch - shift) * np.sin(phase)
                own, transfer = (scale / np.tan(size * phase)).real, (scale / np.sin(size * phase)).real
            stiffness[node : node + 2, node : node + 2] += [[own, -transfer], [-transfer, own]]
            node += 1
    first = 0 if parts.back is None else 2
    softening = -electrical if active.along and active.layers == 1 else 0.0
    across = softening + (electrical / active.layers if is_open else 0.0)
    stiffness[np.ix_([first, first + 2], [first, first + 2])] += [[across, -across], [-across, across]]
    stiffness[0, 0] += actuator.base if isinstance(actuator.base, float) else 0.0
    fixed = int(actuator.base == "fixed")
    free = stiffness[fixed : node + 1, fixed : node + 1]
    return count + int(np.sum(np.linalg.eigvalsh(free) < 0.0))
