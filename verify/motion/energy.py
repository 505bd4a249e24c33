"""The books of a beam without a slider: work of the forces against what is in it and what was damped."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from verify.models.arrays import Array, ComplexArray
from verify.models.time_basis import TimeBasis
from verify.motion.result import Ledger
from verify.motion.surface import Stage, free_at

GAUSS = 6
BLOCK = 2000


def driven_ledger(stages: Sequence[Stage], basis: TimeBasis, z: Array) -> Ledger:
    """From rest to the end; while the forces grow, quadrature with six points to a quarter of the fastest period."""
    work = damped = 0.0
    q, rates = stages[0].state(z, 0.0)
    for stage in stages:
        z = stage.start(q, rates)
        here = _integrals(stage, z)
        work, damped = work + here[0], damped + here[1]
        q, rates = stage.state(free_at(stage, z, stage.duration), stage.duration)
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


def _integrals(stage: Stage, z0: Array) -> tuple[float, float]:
    """(work of the forces, loss of the modes) over a stage, joules: closed form, quadrature while the forces grow."""
    if stage.forced is not None and stage.forced.amplitudes.shape[1] == 1:
        return _closed_integrals(stage, z0)
    fastest = float(max(stage.modal.omegas.max(), stage.omega))
    panels = max(int(stage.duration * fastest * 2.0 / np.pi), 1)
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    half = 0.5 * stage.duration / panels
    work = damped = 0.0
    for block in np.array_split(np.arange(panels), max(panels // BLOCK, 1)):
        t = (half * (2 * block[:, None] + 1 + points)).ravel()
        rates = _rates(stage, z0, t)
        measure = np.tile(weights * half, len(block))
        work += float(measure @ np.einsum("tn,tn->t", _loads(stage, t), rates))
        damped += float(measure @ (rates**2 @ (2.0 * stage.modal.sigmas)))
    return work, damped


def _closed_integrals(stage: Stage, z0: Array) -> tuple[float, float]:
    """Integrals of products of exponentials: force and rates are Re(A e^{a t}) for every mode."""
    assert stage.forced is not None
    modes, drive = stage.modal, 1j * stage.omega
    turn = np.exp(drive * stage.origin)
    force = modes.loads * stage.growth[0] * turn
    forced = drive * stage.forced.amplitudes[:, 0] * turn
    own = -modes.sigmas + 1j * modes.omegas
    free = own * (z0[0] + 1j * z0[1])

    def over(a: ComplexArray, rate_a: Any, b: ComplexArray, rate_b: Any) -> Array:
        return _product(a, rate_a, b, rate_b, stage.duration)

    work = over(force, drive, forced, drive) + over(force, drive, free, own)
    squares = over(forced, drive, forced, drive) + 2.0 * over(forced, drive, free, own) + over(free, own, free, own)
    return float(work.sum()), float(2.0 * modes.sigmas @ squares)


def _product(a: ComplexArray, rate_a: Any, b: ComplexArray, rate_b: Any, duration: float) -> Array:
    """Integral of Re(a e^{rate_a t}) Re(b e^{rate_b t}) from 0 to the duration, (n,)."""
    both = a * b * _exponential(rate_a + rate_b, duration)
    return np.asarray(0.5 * (both + np.conj(a) * b * _exponential(np.conj(rate_a) + rate_b, duration)).real)


def _exponential(rate: Any, duration: float) -> ComplexArray:
    """Integral of e^{rate t} from 0 to the duration."""
    turned = np.asarray(rate * duration, dtype=complex)
    still = abs(turned) < 1e-9
    return np.asarray(np.where(still, 1.0 + 0.5 * turned, np.expm1(turned) / np.where(still, 1.0, turned)) * duration)


def _rates(stage: Stage, z0: Array, t: Array) -> Array:
    """dq/dt of all modes at the times t, (len(t), n)."""
    modes = stage.modal
    decay = np.exp(-modes.sigmas * t[:, None])
    c, s = decay * np.cos(modes.omegas * t[:, None]), decay * np.sin(modes.omegas * t[:, None])
    real, imaginary = z0[0] * c - z0[1] * s, z0[0] * s + z0[1] * c
    forced = np.array([stage.forced.state(time)[1] for time in t]) if stage.forced else 0.0
    return np.asarray(-modes.sigmas * real - modes.omegas * imaginary + forced)


def _loads(stage: Stage, t: Array) -> Array:
    """Generalised forces at the times t, (len(t), n)."""
    grown = np.polynomial.polynomial.polyval(t / stage.unit_s, stage.growth)
    turn = grown * np.exp(1j * stage.omega * (t + stage.origin))
    return np.asarray((turn[:, None] * stage.modal.loads).real)
