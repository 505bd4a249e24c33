"""Forces that grow and then stay harmonic, and the exact answer of a mode to them: no quadrature, no step."""

from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray
from verify.errors import InputError, ResonanceError
from verify.linear.field import phasor
from verify.linear.system import RESONANCE
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import PointForce

CONSTANT = np.array([1.0])
SMOOTH_STEP = np.array([0.0, 0.0, 3.0, -2.0])
"""3 p^2 - 2 p^3: from 0 to 1 with a flat start and end."""
SLOW = 0.5
"""Radians of beat or nepers of decay, within the growth, below which a mode's forced part is summed as a series."""
MOST_PERIODS = 1e12
"""Of what swings: its phase is known to 1e-3 rad by then."""
GONE = 40.0
"""Nepers of decay after which a free mode is nothing beside its start."""
COUNTED = 1e100
"""Radians, beyond which no decay is looked at."""
SERIES = 12
"""Powers beyond the growth's own: SLOW^12 / 12! is rounding."""


class Modal(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Modes with their damping and their share of the forces."""

    sigmas: Array
    """(n,), 1/s: zeta omega."""
    omegas: Array
    """(n,), rad/s: damped."""
    squares: Array
    """(n,): undamped omega squared."""
    loads: ComplexArray
    """(n,): generalised force phasors."""


class Answer(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The forced part of every mode, q(t) = Re(sum_d Q_d (t/T)^d e^{i omega (t + origin)})."""

    amplitudes: ComplexArray
    """Q, (n, degree + 1)."""
    omega: float
    origin: float
    unit_s: float
    """T."""

    def state(self, t: float) -> tuple[Array, Array]:
        """(q, dq/dt) of every mode at time t, (n,) each."""
        powers = (t / self.unit_s) ** np.arange(self.amplitudes.shape[1])
        rates = np.zeros_like(powers)
        rates[1:] = np.arange(1, len(powers)) * powers[:-1] / self.unit_s
        turn = np.exp(1j * self.omega * (t + self.origin))
        still = self.amplitudes @ powers * turn
        moving = self.amplitudes @ rates * turn + 1j * self.omega * still
        return still.real, moving.real


def modal(basis: TimeBasis, forces: Sequence[PointForce], damping: Ratio) -> Modal:
    """A basis with the ratio `damping` in every mode, under the forces."""
    loads = sum((phasor(f) * basis.loads(f.position) for f in forces), np.zeros(len(basis.omegas), dtype=complex))
    return Modal(
        sigmas=damping * basis.omegas,
        omegas=basis.omegas * np.sqrt(1.0 - damping**2),
        squares=basis.omegas**2,
        loads=np.asarray(loads, dtype=complex),
    )


def answer(modes: Modal, omega: float, growth: Array, unit_s: float, origin: float = 0.0) -> Answer:
    """The forced part under Re(F sum_d growth_d (t/T)^d e^{i omega (t + origin)}), 0 <= t <= T where it grows.

    Exact for any polynomial, from the highest power down: (omega_n^2 - omega^2 + 2 i sigma omega) Q_d +
    2 (sigma + i omega) (d+1)/T Q_{d+1} + (d+2)(d+1)/T^2 Q_{d+2} = F growth_d. omega = 0 is a force that is a
    polynomial in time. The powers of a mode that beats slower than it grows would cancel its free part, to no digit
    at all near a resonance: it gets a series.
    """
    push = modes.loads[:, None] * growth
    amplitudes = forced_powers(modes, omega, push, unit_s, SLOW * (len(growth) > 1), SERIES)
    return Answer(amplitudes=amplitudes, omega=omega, origin=origin, unit_s=unit_s)


def forced_powers(
    modes: Modal, omega: float, push: ComplexArray, unit_s: float, within: float, series: int
) -> ComplexArray:
    """Q of `answer` under Re(sum_d push_d (t/T)^d e^{i omega t}), (n, degree + 1) both.

    With `series` powers more where a mode beats by less than `within` radians or decays by less nepers, from rest.
    """
    slow = abs(-modes.sigmas + 1j * (modes.omegas - omega)) * unit_s < within
    stiff = np.where(slow, 1.0, modes.squares - omega**2 + 2j * modes.sigmas * omega)
    first = 2.0 * (modes.sigmas + 1j * omega) / unit_s
    amplitudes = np.pad(np.zeros_like(push), ((0, 0), (0, 2)))
    for d in range(push.shape[1] - 1, -1, -1):
        carried = first * (d + 1) * amplitudes[:, d + 1] + (d + 2) * (d + 1) / unit_s**2 * amplitudes[:, d + 2]
        amplitudes[:, d] = (push[:, d] - carried) / stiff
    amplitudes = amplitudes[:, : push.shape[1]]
    if slow.any():
        amplitudes, push = (np.pad(part, ((0, 0), (0, series))) for part in (amplitudes, push))
        amplitudes[slow] = _beating(some(modes, slow), omega, push[slow], unit_s, within)
    return amplitudes


def some(modes: Modal, which: BoolArray) -> Modal:
    """The modes of which that is True."""
    return Modal(
        sigmas=modes.sigmas[which],
        omegas=modes.omegas[which],
        squares=modes.squares[which],
        loads=modes.loads[which],
    )


def _beating(modes: Modal, omega: float, push: ComplexArray, unit_s: float, within: float) -> ComplexArray:
    """Powers of the envelope a of q = Re(a e^{i omega t}) that starts at zero, as many as of `push`, (n, powers).

    (D - r)(D - s) a = push with r = -sigma + i (omega_d - omega), slow, and s = -sigma - i (omega_d + omega):
    (D - s) b = push, which ends with the highest power of the push where s is fast, then (D - r) a = b.
    """
    r, s = -modes.sigmas + 1j * (modes.omegas - omega), -modes.sigmas - 1j * (modes.omegas + omega)
    ended = np.zeros_like(push)
    for d in range(push.shape[1] - 1, -1, -1):
        carried = (d + 1) / unit_s * ended[:, d + 1] if d + 1 < push.shape[1] else 0.0
        ended[:, d] = (carried - push[:, d]) / s
    b = np.where((abs(s) * unit_s < within)[:, None], _risen(s, push, unit_s), ended)
    return _risen(r, b, unit_s)


def _risen(rate: ComplexArray, push: ComplexArray, unit_s: float) -> ComplexArray:
    """Powers of t / unit_s of y' = rate y + push, y(0) = 0, as many as of `push`, (n, powers)."""
    y = np.zeros_like(push)
    for d in range(push.shape[1] - 1):
        y[:, d + 1] = unit_s * (push[:, d] + rate * y[:, d]) / (d + 1)
    return y


def free_part(modes: Modal, q: Array, qd: Array) -> Array:
    """The z of free modes with the given state, (2, n): q = Re z, dq/dt = Re((-sigma + i omega) z)."""
    return np.array([q, -(qd + modes.sigmas * q) / modes.omegas])


def state_of(modes: Modal, z: Array) -> tuple[Array, Array]:
    """(q, dq/dt) of free modes, (n,) each."""
    return z[0], -modes.sigmas * z[0] - modes.omegas * z[1]


def turns(modes: Modal, t: float) -> Array:
    """e^{(-sigma + i omega) t}, (2, n)."""
    decay = np.exp(-modes.sigmas * t)
    return np.array([decay * np.cos(modes.omegas * t), decay * np.sin(modes.omegas * t)])


def advanced(modes: Modal, z: Array, t: Any) -> Array:
    """Free modes at the times t after z, (len(t), n): their q."""
    t = np.atleast_1d(t)[:, None]
    return np.asarray(np.exp(-modes.sigmas * t) * (z[0] * np.cos(modes.omegas * t) - z[1] * np.sin(modes.omegas * t)))


def check_no_resonance(basis: TimeBasis, frequency_hz: float, damping: Ratio) -> None:
    """Raise InputError where an undamped mode is driven at its own frequency."""
    if not frequency_hz:
        return
    ratio = np.abs(2.0 * np.pi * frequency_hz / basis.omegas - 1.0)
    nearest = int(ratio.argmin())
    if ratio[nearest] < RESONANCE and not np.broadcast_to(damping, ratio.shape)[nearest]:
        raise ResonanceError(
            f"frequency_hz = {frequency_hz!r} lies {ratio[nearest]:.1e} (relative) from the undamped resonance of mode "
            f"{nearest + 1} of the {basis.model} model: give the beam a loss_factor or choose another frequency"
        )


def check_phase(whose: str, hertz: float, duration: float, since: float = 0.0) -> None:
    """Raise InputError where what has swung at a frequency for `since` seconds goes on until its phase is not known."""
    if hertz * (since + duration) > MOST_PERIODS:
        before = f" after {since!r} s" if since else ""
        raise InputError(
            f"duration = {duration!r} s{before} is more than {MOST_PERIODS:.0e} periods of {whose}, at {hertz:.4g} Hz, "
            "whose phase is not known to 1e-3 rad by then: shorten it"
        )


def check_free_phases(basis: TimeBasis, damping: Ratio, duration: float) -> None:
    """Likewise for every free mode that is not damped out before, after GONE / (2 pi zeta) periods of it."""
    lasting = (damping * MOST_PERIODS * 2.0 * np.pi < GONE) | (basis.omegas >= COUNTED / duration)
    if lasting.any():
        hertz = float(basis.omegas[lasting].max()) / (2.0 * np.pi)
        check_phase("the highest mode that is not damped out before", hertz, duration)
