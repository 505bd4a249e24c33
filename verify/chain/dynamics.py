"""The nonlinear finite-segment chain: states on its constraints, energies, equilibria, exact linearisation.

The chain is the paper's: rigid links in relative joint coordinates q_i = theta_i - theta_{i-1}, closed at the right
by a roller of which only y_N = 0 is asked. The closure is a matter of coordinate partitioning (R. A. Wehage and E. J.
Haug, J. Mech. Design 104 (1982) 247): as many angles as there are held points depend on the others, chosen by pivot.
Forward dynamics is compiled (`chain.recursion_kernels`), motion in time is in `chain.stepping`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verify.arrays import Array, Indices
from verify.chain import kinematics, records
from verify.chain.system import ChainState, ChainSystem, circular
from verify.errors import InputError
from verify.validation import check_unmasked

PIVOT_LOSS = 0.1
"""A dependent angle is kept until its lever arm falls below this share of the longest."""
NEWTON_STEPS = 20
SETTLED = 1e-14
"""Radians, for one link; a tenth of it for every other, whose rounding adds up."""


def flatten(system: ChainSystem, *, ledger: bool = True) -> records.Flat:
    """The chain as the kernels see it."""
    half, turn = system.lengths / 2.0, system.rotation
    held = [(float(half[-1]), 0.0, 0.0, 0.0, system.n_links - 1)] if system.tip == "roller" else []
    held += [(a.at - half[a.link - 1], a.amplitude, *_cycle(a), a.link - 1) for a in system.actuators]
    loads = [(p.at - half[p.link - 1], *p.force, p.moment, *_cycle(p), p.link - 1) for p in system.loads]
    own = np.stack([half, system.masses, system.inertias, system.stiffness, system.dashpots], axis=1)
    return records.Flat(
        links=np.hstack([own, records.mobilities(half, own[:, records.MASS], own[:, records.INERTIA])]),
        numbers=np.array([turn.offset, turn.rate, turn.amplitude, *_cycle(turn), *system.gravity], dtype=float),
        loads=np.array(loads, dtype=float).reshape(len(loads), 7),
        held=np.array(held, dtype=float).reshape(len(held), 5),
        small=np.zeros((len(held), len(held) + 1)),
        tip=records.ROLLER if system.tip == "roller" else records.FREE,
        tip_spring=float(system.axial_spring),
        axial=bool(system.axial_inertia),
        ledger=ledger,
    )


def _cycle(one: Any) -> tuple[float, float]:
    """Circular frequency and phase in radians of what moves harmonically."""
    return circular(one.frequency_hz), float(np.deg2rad(one.phase_deg))


def workspace(system: ChainSystem) -> Array:
    """Scratch for the kernels, (N + 1, columns)."""
    return np.zeros((system.n_links + 1, records.WORK_COLUMNS))


def at_rest(system: ChainSystem, angles: Array | None = None) -> ChainState:
    """A state without motion, straight unless angles are given, on the held points."""
    check_unmasked("angles", angles, "radians")
    still = np.zeros(system.n_links)
    return project(system, ChainState(still if angles is None else np.array(angles, dtype=float), still))[0]


def accelerations(system: ChainSystem, state: ChainState) -> Array:
    """Relative angular accelerations, (N,), rad/s^2."""
    return accelerated(system)(state.time, *_arrays(system, state))


def accelerated(system: ChainSystem) -> Callable[[float, Array | float, Array | float], Array]:
    """The accelerations, (N,), of a chain at a time, by its angles and rates: from the loop of steps, of which none.

    A loop of their own would be compiled beside it.
    """
    from verify.chain import kernels

    n, flat, work = system.n_links, flatten(system, ledger=False), workspace(system)
    run = records.idle(n)

    def answer(t: float, angles: Array | float, rates: Array | float) -> Array:
        run.clock[0], run.y[:n], run.y[n : 2 * n] = t, angles, rates
        kernels.march(flat, run, 0, work)
        return run.k[0, n : 2 * n].copy()

    return answer


def _arrays(system: ChainSystem, state: ChainState) -> tuple[Array, Array]:
    """Copies of angles and rates. Raises InputError for a wrong shape or a value that is not finite."""
    arrays = []
    for name in ("angles", "rates"):
        check_unmasked(f"state.{name}", getattr(state, name), "SI")
        values = np.array(getattr(state, name), dtype=float)
        if values.shape != (system.n_links,) or not np.isfinite(values).all():
            raise InputError(f"state.{name}: give {system.n_links} finite numbers, one for each joint")
        arrays.append(values)
    return arrays[0], arrays[1]


def positions(system: ChainSystem, state: ChainState) -> tuple[Array, Array]:
    """Joints 0..N, (N + 1, 2) metres, and their velocities, (N + 1, 2) m/s."""
    placed = kinematics.place(system, state.time, *_arrays(system, state))
    return placed.joints, placed.velocities


def energies(system: ChainSystem, state: ChainState) -> tuple[float, float, float]:
    """Kinetic, elastic and gravitational energy, joule."""
    angles, rates = _arrays(system, state)
    found = kinematics.energies(system, np.array([state.time]), angles[None], rates[None])[:, 0]
    return float(found[0]), float(found[1]), float(found[2])


def held_rows(system: ChainSystem, state: ChainState) -> Array:
    """Derivatives of the held points' y by the relative angles, (n_held, N), metres."""
    return kinematics.held_rows(system, positions(system, state)[0][:, 0])


def keep_pivots(rows: Array, pivots: Indices) -> Indices:
    """The same dependent angles while they are good enough, better ones else."""
    chosen = choose_pivots(rows)
    if not len(rows):
        return chosen
    now, best = (abs(float(np.linalg.det(rows[:, p]))) for p in (pivots, chosen))
    return pivots if now >= PIVOT_LOSS ** len(rows) * best else chosen


def project(system: ChainSystem, state: ChainState) -> tuple[ChainState, float]:
    """The state brought onto the held points, and the largest change of an angle or (times 1 s) of a rate.

    Angles by Newton, rates by one linear solve; only the dependent angles move, chosen by pivot. Raises InputError
    where Newton finds no position.
    """
    q, v = _arrays(system, state)
    rows = kinematics.held_rows(system, kinematics.place(system, state.time, q, v).joints[:, 0])
    pivots = choose_pivots(rows)
    if not _settle(system, state.time, q, v, pivots) or not np.isfinite(q).all():
        raise InputError(
            f"state.angles cannot be brought onto the held points by turning joint {int(pivots[0]) + 1}: "
            "give angles that nearly meet them"
        )
    changed = max(abs(q - state.angles).max(), abs(v - state.rates).max())
    return ChainState(q, v, state.time), float(changed)


def _settle(system: ChainSystem, time: float, q: Array, v: Array, pivots: Indices) -> bool:
    """Turn dependent angles by Newton's method until a change is rounding, then set their rates; whether it ends."""
    if not len(pivots):
        return True
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(NEWTON_STEPS):
            placed = kinematics.place(system, time, q, v)
            rows = kinematics.held_rows(system, placed.joints[:, 0])[:, pivots]
            off, leaving = kinematics.strayed(system, time, placed)
            try:
                change, correction = np.linalg.solve(rows, np.stack([off, leaving], axis=1)).T
            except np.linalg.LinAlgError:
                return False
            q[pivots] -= change
            if abs(change).max() < SETTLED * (1.0 + 0.1 * len(q)):
                v[pivots] -= correction
                return True
    return False


def choose_pivots(rows: Array) -> Indices:
    """Which angles depend on the others, (n_held,): complete pivoting on the constraint rows.

    Raises InputError where the held points leave no angle to depend on: a chain that stands upright under its
    roller, or two held points in one place.
    """
    left, pivots = rows.copy(), np.zeros(len(rows), dtype=np.int64)
    free, largest = list(range(len(rows))), abs(rows).max() if rows.size else 0.0
    for _ in range(len(rows)):
        row = free[int(abs(left[free]).max(axis=1).argmax())]
        column = int(abs(left[row]).argmax())
        if abs(left[row, column]) <= 1e-9 * largest:
            raise InputError("chain: its held points cannot be held at once in this position; move one or drop one")
        pivots[row] = column
        free.remove(row)
        for other in free:
            left[other] -= left[other, column] / left[row, column] * left[row]
    return pivots
