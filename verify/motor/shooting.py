"""A motor's periodic motion by shooting: the state that a period gives back, by Newton's method on the period's map."""

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray, Indices
from verify.errors import InputError
from verify.motor import records
from verify.motor.case import Block, MotorCase, blocks
from verify.motor.feet import Placed, feet_of
from verify.motor.result import MotorRun, MotorState, uninterrupted

MOST = 12
SMALL = 1e-4
"""Of a coordinate's own size: the difference by which the map's slopes are taken."""
REPEATS = 1e-3
"""Of its own size: what is off by more after a period does not repeat itself. Landings on dashpots jump by steps."""


class Periodic(Struct, frozen=True, eq=False, kw_only=True):
    """A motion that repeats itself."""

    run: MotorRun
    """One period of it, from its start."""
    state: MotorState
    """At its start."""
    missed: float
    """How far the state is off after a period, over its own size."""
    multipliers: ComplexArray
    """Eigenvalues of the period's map, (n,) complex: stable where all are below 1 in size."""
    rounds: int
    """Of Newton's method."""

    @property
    def stable(self) -> bool:
        """Whether small departures die away."""
        return bool(np.abs(self.multipliers).max() < 1.0)


def periodic(case: MotorCase, speed: float = 0.0, *, tolerance: float = 1e-10, settle: int = 100) -> Periodic:
    """The periodic motion across of a slider held at a speed (m/s) and at its place, one-way on a steady beam.

    After `settle` periods of running, heights, pitches and their rates are sought that a period gives back. Raises
    InputError where they are not found, as of a slider that bounces without a pattern.
    """
    if case.slider.coupling != "one-way" or case.start != "steady":
        raise InputError(
            f"slider.coupling = {case.slider.coupling!r}, start = {case.start!r}: shooting is of a steady beam that "
            "does not feel its slider, give 'one-way' and 'steady'"
        )
    run = uninterrupted(
        case.run(
            settle * case.period,
            held_speed=speed,
            frozen=True,
            samples=2,
        )
    )
    given, once = feet_of((Placed(case.slider, 0.0),)).given, blocks(case, speed, 1, 2)
    moves = np.repeat(given[:, [records.FOOT_INVERSE_MASS, records.FOOT_INVERSE_INERTIA]] > 0.0, 2, axis=1)
    free = np.flatnonzero(moves.ravel())  # heights and their rates, pitches of feet that turn

    def period(state: MotorState | None) -> MotorRun:
        return uninterrupted(once(state))

    omega = 2.0 * np.pi / max(run.duration, 1e-300)
    height = float(np.ptp(run.height)) + float(np.abs(run.state.feet[:, 0]).max()) + 1e-12
    arm = float(np.abs(run.point_offsets).max()) or 1.0
    scale = np.array([height, height * omega, height / arm, height * omega / arm])
    state, size, best = run.state, np.tile(scale, len(given))[free], None
    for rounds in range(1, MOST + 1):
        run = period(state)
        missed = (run.state.feet - state.feet).ravel()[free] / size
        slopes = _slopes(period, state, run, size, free)
        off, multipliers = float(np.abs(missed).max()), np.asarray(np.linalg.eigvals(slopes), dtype=np.complex128)
        if best is None or off < best.missed:
            best = Periodic(run=run, state=state, missed=off, multipliers=multipliers, rounds=rounds)
        if off <= tolerance:
            break
        step = np.linalg.lstsq(slopes - np.eye(len(size)), -missed, rcond=None)[0] * size
        state = replace(state, feet=_moved(state.feet, free, step), touch=run.state.touch)
    if best is not None and best.missed <= REPEATS:
        return best
    raise InputError(
        f"no periodic motion was found in {MOST} rounds: it does not repeat after one period; take means over many "
        "periods instead"
    )


def _moved(feet: Array, free: Indices, by: Array) -> Array:
    """The feet with their free coordinates moved."""
    found = feet.ravel().copy()
    found[free] += by
    return found.reshape(feet.shape)


def _slopes(period: Block, state: MotorState, run: MotorRun, size: Array, free: Indices) -> Array:
    """The period's map of the free coordinates by differences, (n, n), in units of `size`."""
    base, columns = run.state.feet.ravel()[free], []
    for j in range(len(free)):
        by = SMALL * size[j] * (np.arange(len(free)) == j)
        after = period(replace(state, feet=_moved(state.feet, free, by))).state.feet.ravel()[free]
        columns.append((after - base) / SMALL / size)
    return np.array(columns).T
