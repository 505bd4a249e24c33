"""The books of a beam without a slider: work of the forces against what is in it and what was damped."""

from collections.abc import Sequence

import numpy as np

from verify.motion import Ledger
from verify.moving_surface import Stage, free_at
from verify.time_basis import Array, TimeBasis

GAUSS = 6
BLOCK = 2000


def driven_ledger(stages: Sequence[Stage], basis: TimeBasis, z: Array) -> Ledger:
    """From rest to the end: Gauss' quadrature of the power, six points to a quarter of the fastest period."""
    work = damped = 0.0
    q, rates = stages[0].state(z, 0.0)
    for stage in stages:
        z = stage.start(q, rates)
        here = _integrals(stage, z)
        work, damped = work + here[0], damped + here[1]
        q, rates = stage.state(free_at(stage, z, stage.duration), stage.duration)
    kinetic, elastic = 0.5 * float(rates @ rates), 0.5 * float((basis.omegas**2 * q) @ q)
    return Ledger(kinetic=kinetic, elastic=elastic, slider=0.0, work_in=work, damped=damped, rubbed=0.0,
                  contact_on_beam=0.0, residual=work - damped - kinetic - elastic)  # fmt: skip


def _integrals(stage: Stage, z0: Array) -> tuple[float, float]:
    """(work of the forces, loss of the modes) over a stage, joules."""
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
