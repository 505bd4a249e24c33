"""The compiled books of a run: powers of drive and damping, and the work of a step."""

import numpy as np

from verify.arrays import Array
from verify.jit import FAST, inline
from verify.motion import records as rec
from verify.motion.records import Books, Drive, Space, Surface


@inline(fastmath=FAST)
def power(drive: Drive, books: Books, time: float, factors: Array) -> float:
    """Power of the driving forces, watts."""
    angle = drive.omega * (drive.origin + time)
    c, s = np.cos(angle), np.sin(angle)
    part, grown = time / drive.unit, 0.0
    for d in range(len(drive.growth) - 1, -1, -1):
        grown = grown * part + drive.growth[d]
    loads, forces, total = books.loads, books.forces, 0.0
    for f in range(loads.shape[0]):
        speed = 0.0
        for j in range(loads.shape[1]):
            speed += loads[f, j] * factors[rec.MOVING, j]
        total += grown * (forces[0, f] * c - forces[1, f] * s) * speed
    return total


@inline(fastmath=FAST)
def loss(modes: Array, answers: Array, factors: Array) -> float:
    """Power lost in the modes, watts."""
    total, n = 0.0, modes.shape[1]
    for j in range(n):
        rate = factors[rec.MOVING, j]
        for d in range(answers.shape[1]):
            rate += answers[j, d] * factors[rec.MOVING, n + d]
        total += 2.0 * modes[rec.SIGMA, j] * rate * rate
    return total


@inline
def correct_powers(time: float, surface: Surface, books: Books, space: Space) -> None:
    """Powers at the end of a step with what the contact has added to the speeds since its start, half at mid-step."""
    seen = space.seen
    driven = power(surface.drive, books, time, space.factors)
    damped = loss(surface.modes, books.answers, space.factors)
    seen[1, rec.POWER] += 0.5 * (driven - seen[2, rec.POWER])
    seen[1, rec.LOSS] += 0.5 * (damped - seen[2, rec.LOSS])
    seen[2, rec.POWER], seen[2, rec.LOSS] = driven, damped


@inline
def by_parts(v: float, v1: float, moved: float, dt: float, mass: float, seen: Array) -> float:
    """Work of a step's friction on a beam that does not feel it: of friction times the surface's line, by parts.

    As if nothing else moved the slider; `pulled` tells of what does.
    """
    mean = (seen[0, rec.SURFACE] + 4.0 * seen[1, rec.SURFACE] + seen[2, rec.SURFACE]) / 6.0
    rise = seen[2, rec.SURFACE] - seen[0, rec.SURFACE]
    return float(-mass * (v1 * (mean + 0.5 * rise) - v * (mean - 0.5 * rise) - rise / dt * moved))


@inline
def pulled(v: float, v1: float, moved: float, dt: float, mass: float, seen: Array, took: Array) -> tuple[float, float]:
    """Work of the turning tangent and of gravity along it in a step: (on the slider, at the speed of the surface)."""
    start, end = mass * dt / 6.0 * seen[0, rec.PULL], mass * dt / 6.0 * seen[2, rec.PULL]
    middle = mass * took[rec.GIVEN_END] - start - end
    mean = (seen[0, rec.SURFACE] + 4.0 * seen[1, rec.SURFACE] + seen[2, rec.SURFACE]) / 6.0
    half = 0.5 * (seen[2, rec.SURFACE] - seen[0, rec.SURFACE])
    own = start * v + middle * (1.5 * moved / dt - 0.25 * (v + v1)) + end * v1
    return own, start * (mean - half) + middle * mean + end * (mean + half)


@inline
def account(
    v: float, v1: float, pressed: float, turned: float, dt: float, mass: float, ledger: Array, seen: Array
) -> None:
    """Add one step from the speed v to v1 to the ledger.

    `pressed` is the work of friction on the beam, `turned` that of all else on the slider.
    """
    ledger[rec.DRIVEN] += dt * (seen[0, rec.POWER] + 4.0 * seen[1, rec.POWER] + seen[2, rec.POWER]) / 6.0
    ledger[rec.DAMPED] += dt * (seen[0, rec.LOSS] + 4.0 * seen[1, rec.LOSS] + seen[2, rec.LOSS]) / 6.0
    on_slider = 0.5 * mass * (v1 * v1 - v * v)
    ledger[rec.ON_BEAM] += pressed
    ledger[rec.ON_SLIDER] += on_slider
    ledger[rec.TURNED] += turned
    ledger[rec.RUBBED] -= on_slider - turned + pressed
