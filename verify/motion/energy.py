"""Energy balance of a beam without a slider in closed form: work of the forces, energy, damping."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray
from verify.linear.time_basis import TimeBasis
from verify.motion.forcing import Modal, forced_powers, free_part, some, state_of, turns
from verify.motion.result import Ledger
from verify.motion.surface import Stage, free_at

SLOW = 2.0
"""Radians of beat or nepers of decay within a stage below which a mode is driven as a series from rest. The forced part
of its own would cancel the free one in their squares; where the series begins, its terms are at most e^2 of the sum."""
STEEP = 3.0
"""sigma / omega_d from which a mode's own motion is hardly a turn, and its two exponentials cancel in the square."""
TURN = 21
"""Powers of an angle below a radian that e^{i angle} is made of: 1/21! is rounding."""

ABOVE = 40
"""Powers above the highest, and half as many as that, from which the downward recursion starts."""


class _Drive(msgspec.Struct, frozen=True, eq=False):
    """The forces over a stage, Re(load sum_d growth_d p^d e^{i omega t}) in every mode, p = t / duration."""

    omega: float
    loads: ComplexArray
    """(n,), turned to the start of the stage."""
    growth: Array
    """(n, degree + 1)."""
    turned: complex
    """e^{i omega duration}."""
    within: float
    """SLOW, or more under a growth of many powers."""


class _Pushed(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Modes under a drive, dq/dt = Re(load sum_k driven_k p^k e^{i omega t}) + Re(free e^{own t})."""

    modes: Modal
    loads: ComplexArray
    """(n,)."""
    growth: Array
    """(n, degree + 1)."""
    driven: ComplexArray
    """(n, powers), under unit loads: what is not damped takes no work but by its free part, to the last digit."""
    free: ComplexArray
    """(n,)."""
    z: Array
    """(2, n), of the free part at the start."""
    duration: float
    """Seconds."""
    fast: ComplexArray
    """(k,), integrals of p^k e^{2 i omega t}."""
    sums: ComplexArray
    """(powers, n), likewise of e^{(own + i omega) t}."""
    beats: ComplexArray
    """(powers, n), likewise of e^{(own - i omega) t}."""
    ends: ComplexArray
    """(n,), e^{own duration}."""


def driven_ledger(stages: Sequence[Stage], basis: TimeBasis, z: Array) -> Ledger:
    """From rest to the end: all integrals are closed; what the books miss is rounding."""
    work = damped = 0.0
    q, rates = stages[0].state(z, 0.0)
    for stage in stages:
        here = _integrals(stage, q, rates)
        work, damped = work + here[0], damped + here[1]
        q, rates = stage.state(free_at(stage, stage.start(q, rates), stage.duration), stage.duration)
    kinetic, elastic = 0.5 * float(rates @ rates), 0.5 * float((basis.omegas**2 * q) @ q)
    return Ledger(
        kinetic=kinetic,
        elastic=elastic,
        slider=0.0,
        work_in=work,
        damped=damped,
        rubbed=0.0,
        contact_on_beam=0.0,
        normal_on_beam=0.0,
        residual=work - damped - kinetic - elastic,
    )


def _integrals(stage: Stage, q: Array, rates: Array) -> tuple[float, float]:
    """(work of the forces, loss of the modes) over a stage from its state, joules: integrals of t^k e^{z t}."""
    drive = _drive(stage)
    beat = abs(-stage.modal.sigmas + 1j * (stage.modal.omegas - drive.omega)) * stage.duration
    work = damped = 0.0
    for which in (beat < drive.within, beat >= drive.within):
        if which.any():
            pushed = _pushed(drive, stage.duration, some(stage.modal, which), which, (q[which], rates[which]))
            work, damped = work + _work(pushed), damped + _loss(pushed)
    return work, damped


def _drive(stage: Stage) -> _Drive:
    """Of a stage; powers of time where it turns by less than a radian: the squares of phasors lose a sine's start."""
    start, end = np.exp(1j * stage.omega * np.array([stage.origin, stage.origin + stage.duration]))
    loads, angle = stage.modal.loads * start, stage.omega * stage.duration
    growth = np.append(stage.growth[0], np.trim_zeros(stage.growth[1:], "b"))
    within = max(SLOW, 0.5 * (len(growth) - 1))
    rows = np.broadcast_to(growth, (len(loads), len(growth)))
    if angle >= 1.0:
        return _Drive(stage.omega, loads, rows, complex(end / start), within)
    turn = np.cumprod(np.append(1.0, 1j * angle / np.arange(1.0, TURN)))
    return _Drive(0.0, np.ones_like(loads), multiplied(rows, (loads[:, None] * turn).real).real, 1.0, within)


def _pushed(drive: _Drive, unit: float, modes: Modal, which: BoolArray, state: tuple[Array, Array]) -> _Pushed:
    """Modes that are all slow or all not, from their (q, dq/dt) at the start of a stage of `unit` seconds."""
    turning, loads, growth = 1j * drive.omega, drive.loads[which], drive.growth[which]
    powers = forced_powers(modes, drive.omega, growth.astype(complex), unit, drive.within, int(12 + 7 * drive.within))
    driven = turning * powers
    driven[:, :-1] += np.arange(1, powers.shape[1]) / unit * powers[:, 1:]
    z = free_part(modes, state[0] - (loads * powers[:, 0]).real, state[1] - (loads * driven[:, 0]).real)
    own, highest = -modes.sigmas + 1j * modes.omegas, driven.shape[1] - 1
    ends = np.asarray(np.array([1.0, 1j]) @ turns(modes, unit), dtype=complex)
    doubled = weighted_powers(np.array([2.0 * turning * unit]), np.array([drive.turned**2]), 2 * highest)
    return _Pushed(
        modes=modes,
        loads=loads,
        growth=growth,
        driven=driven,
        free=own * (z[0] + 1j * z[1]),
        z=z,
        duration=unit,
        fast=doubled[:, 0],
        sums=weighted_powers((own + turning) * unit, ends * drive.turned, highest),
        beats=weighted_powers((own - turning) * unit, ends / drive.turned, highest),
        ends=ends,
    )


def _work(pushed: _Pushed) -> float:
    """Of the forces, joules: Re(a) Re(b) is half of Re(a b) + Re(a* b)."""
    growth, load, n = pushed.growth.T, pushed.loads, pushed.growth.shape[1]
    power = multiplied(pushed.growth, pushed.driven)
    by_free = load * np.sum(growth * pushed.sums[:n], axis=0) + load.conj() * np.sum(growth * pushed.beats[:n], axis=0)
    return float(0.5 * pushed.duration * np.sum(_over(pushed, power, power) + (pushed.free * by_free).real))


def _loss(pushed: _Pushed) -> float:
    """Of the modes, joules: 2 sigma times the integral of (dq/dt)^2."""
    v, load = pushed.driven, pushed.loads
    mixed = load * np.sum(v.T * pushed.sums, axis=0) + load.conj() * np.sum(v.conj().T * pushed.beats, axis=0)
    squares = 0.5 * _over(pushed, multiplied(v, v), multiplied(v.conj(), v)) + (pushed.free * mixed).real
    return float(np.sum(2.0 * pushed.modes.sigmas * pushed.duration * squares + _own_loss(pushed)))


def _over(pushed: _Pushed, straight: ComplexArray, crossed: ComplexArray) -> Array:
    """Real part of load^2 straight_k p^k e^{2 i omega t} + |load|^2 crossed_k p^k, integrated over p, (n,)."""
    powers = straight.shape[1]
    turning = pushed.loads**2 * (straight @ pushed.fast[:powers])
    still = crossed.real @ (1.0 / np.arange(1.0, powers + 1.0))
    return np.asarray(turning.real + abs(pushed.loads) ** 2 * still)


def _own_loss(pushed: _Pushed) -> Array:
    """Of the free parts alone, (n,), joules: their squares, or where those cancel the energy that is gone."""
    modes, unit, ends = pushed.modes, pushed.duration, pushed.ends
    own = np.asarray(2.0 * unit * (-modes.sigmas + 1j * modes.omegas), dtype=complex)
    turning = weighted_powers(own, ends**2, 0)[0]
    still = weighted_powers(own.real.astype(complex), ends * ends.conj(), 0)[0].real
    squares = (pushed.free**2 * turning).real + abs(pushed.free) ** 2 * still
    last = (pushed.z[0] + 1j * pushed.z[1]) * ends
    gone = _energies(modes, pushed.z) - _energies(modes, np.array([last.real, last.imag]))
    return np.where(modes.sigmas > STEEP * modes.omegas, gone, modes.sigmas * unit * squares)


def _energies(modes: Modal, z: Array) -> Array:
    """Of free modes, (n,), joules."""
    q, rates = state_of(modes, z)
    return np.asarray(0.5 * (rates**2 + modes.squares * q**2))


def weighted_powers(z: ComplexArray, end: ComplexArray, highest: int) -> ComplexArray:
    """Integrals of p^k e^{z p} over 0 <= p <= 1 for k = 0..highest, (highest + 1, n); z (n,) with Re z <= 0.

    `end` is e^z, (n,), as whoever asks has it: of a long motion its phase is that of the state at its end, to the last
    digit. Parts give I_k = (e^z - k I_{k-1}) / z, which loses nothing upwards while k <= |z|, and downwards beyond
    (as F. W. J. Olver, D. W. Lozier, R. F. Boisvert, C. W. Clark, NIST Handbook of Mathematical Functions, 2010, 3.6).
    """
    size = abs(z)
    found = _downwards(np.where(size <= highest + 1, z, 0.0), highest)
    far = size >= 1.0
    up = np.where(far, z, 1.0)
    found[0] = np.where(far, (end - 1.0) / up, found[0])
    for k in range(1, highest + 1):
        found[k] = np.where(far & (k <= size), (end - k * found[k - 1]) / up, found[k])
    return found


def _downwards(z: ComplexArray, highest: int) -> ComplexArray:
    """The same from above: right for the powers k > |z|, (highest + 1, n)."""
    end, last = np.exp(z), highest + highest // 2 + ABOVE
    value = np.asarray(end / (last + 1.0), dtype=complex)
    found = np.empty((highest + 1, len(z)), dtype=complex)
    for k in range(last, 0, -1):
        value = (end - z * value) / k
        if k <= highest + 1:
            found[k - 1] = value
    return found


def multiplied(a: Array | ComplexArray, b: Array | ComplexArray) -> ComplexArray:
    """Coefficients of the product of polynomials, row by row, (n, j) and (n, k) -> (n, j + k - 1)."""
    found = np.zeros((len(b), a.shape[1] + b.shape[1] - 1), dtype=complex)
    for power in range(a.shape[1]):
        found[:, power : power + b.shape[1]] += a[:, power, None] * b
    return found
