"""The nonlinear chain by exact linear flow and nonlinear kicks in modal coordinates: no step limit of order l^2.

In modes about an equilibrium the linear chain, harmonic loads included, has a flow in closed form; what is left of
the accelerations is small where the motion is small, and is put in as kicks. With one kick to a step that is
Strang's splitting, of order 2 times the size of the nonlinearity; with two kicks at Gauss's points (J. Laskar and P.
Robutel, Celest. Mech. Dyn. Astron. 80 (2001) 39) errors are of order 4 times that size and of order 2 times its
square. With all modes a step costs O(N^2), with m of them O(N m). Modes left out move as the linear chain's; what they
add to the axial inertia is lost, a part (up to a quarter was seen) of the nonlinear part of the motion. The kicks
are explicit: where the nonlinearity is not small in a step the motion diverges, is stopped and says so.

The roller's closure is one chord step along the last mode after each kick while links have turned little; once they
have not, Newton's method at the end of each step, along the way in which the roller's force moves the links as they
stand. A chain that cannot be brought back to the line is stopped likewise.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from time import perf_counter
from typing import Any

import numpy as np

from verify.chain import records
from verify.chain.dynamics import accelerated, at_rest, flatten, linearise, project, workspace
from verify.chain.modes import lowest_modes
from verify.chain.result import ChainMotion, ChainStatistics
from verify.chain.stepping import checked_times, how_started
from verify.chain.system import ChainState, ChainSystem, circular, link_at
from verify.chain.work import modal_work, refuse_work
from verify.checks import check_number
from verify.errors import InputError
from verify.models.arrays import Array
from verify.motion.result import END

SCHEMES: dict[int, tuple[tuple[float, ...], tuple[float, ...]]] = {
    1: ((0.5, 0.5), (1.0,)),
    2: ((0.5 - 3**-0.5 / 2, 3**-0.5, 0.5 - 3**-0.5 / 2), (0.5, 0.5)),
    3: ((0.5 - 15**0.5 / 10, 15**0.5 / 10, 15**0.5 / 10, 0.5 - 15**0.5 / 10), (5 / 18, 4 / 9, 5 / 18)),
}
"""Shares of the step of flows and kicks, by the number of kicks."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ModalBasis:
    """Modes of a chain about an equilibrium, ascending; with a roller, last, the motion off its line."""

    system: ChainSystem
    rest: ChainState
    omega: Array
    """(m,), rad/s; 0 for the motion off the roller's line."""
    modes: Array
    """(m, N): row j holds the relative angles of mode j, of unit modal mass."""
    duals: Array
    """(m, N): row j takes relative angles to modal coordinate j."""
    drives: Array
    """(n_loads, 2), circular frequencies and phases of the harmonic loads."""
    shares: Array
    """(n_loads, m), steady modal amplitudes."""
    tilt: float
    """How far the last motion moves the tip off its line, metres; 0 without a roller."""


def modal_basis(system: ChainSystem, rest: ChainState | None = None, n_modes: int | None = None) -> ModalBasis:
    """Modes of the chain about an equilibrium (straight unless given), for `simulate_modal`.

    All of them by dense matrices, O(N^3); or the lowest `n_modes` of an unloaded straight chain by Lanczos, which goes
    to 10^4 links and leaves the others out of the linear motion too. Raises InputError for actuators and moving
    hubs, which the linear flow does not know, and for an equilibrium that is unstable.
    """
    if system.actuators or system.rotation.rate or system.rotation.amplitude:
        raise InputError("chain: actuators and a turning base have no modal flow; give method = 'adaptive' or 'rk4'")
    if n_modes is not None and rest is not None:
        raise InputError("n_modes: the lowest modes alone are those about straight; give n_modes or rest")
    rest = at_rest(system) if rest is None else rest
    omega, modes, duals, tilt = _all_modes(system, rest) if n_modes is None else lowest_modes(system, n_modes)
    drives, shares = _steady(system, rest, omega, duals)
    return ModalBasis(
        system=system, rest=rest, omega=omega, modes=modes, duals=duals, drives=drives, shares=shares, tilt=tilt
    )


def _all_modes(system: ChainSystem, rest: ChainState) -> tuple[Array, Array, Array, float]:
    """Frequencies, modes, duals, and the tilt of the motion off the roller's line, which comes last."""
    from scipy.linalg import eigh

    linear = linearise(system, rest)
    basis = linear.independent()
    values, vectors = eigh(basis.T @ linear.stiffness @ basis, basis.T @ linear.mass @ basis)
    modes, tilt = (basis @ vectors).T, 0.0
    if len(values) and values[0] < 0.0:
        linear.frequencies()  # says what is unstable; below 0 by rounding alone is a motion without a spring
    omega = np.sqrt(np.maximum(values, 0.0))
    if len(linear.constraint):
        normal = np.linalg.solve(linear.mass, linear.constraint[0])
        normal /= np.sqrt(normal @ linear.mass @ normal)
        modes, omega = np.vstack([modes, normal]), np.append(omega, 0.0)
        tilt = float(linear.constraint[0] @ normal)
    return omega, modes, modes @ linear.mass, tilt


def _steady(system: ChainSystem, rest: ChainState, omega: Array, duals: Array) -> tuple[Array, Array]:
    """Frequencies and phases of the harmonic loads, and the modes' steady amplitudes under each."""
    harmonic = [load for load in system.loads if load.frequency_hz > 0.0]
    still = replace(system, loads=tuple(load for load in system.loads if load.frequency_hz == 0.0))
    base = _answer(still, rest)
    drives, shares = np.zeros((len(harmonic), 2)), np.zeros((len(harmonic), len(omega)))
    for k, load in enumerate(harmonic):
        drives[k] = circular(load.frequency_hz), np.deg2rad(load.phase_deg)
        alone = replace(still, loads=(*still.loads, replace(load, frequency_hz=0.0, phase_deg=0.0)))
        gap = omega**2 - drives[k, 0] ** 2
        # at a resonance any steady answer will do: the kicks know the difference
        gap = np.where(abs(gap) < 1e-6 * drives[k, 0] ** 2, 1e-6 * drives[k, 0] ** 2, gap)
        shares[k] = duals @ (_answer(alone, rest) - base) / gap
    return drives, shares


def _answer(system: ChainSystem, rest: ChainState) -> Array:
    return accelerated(system)(0.0, rest.angles, rest.rates)


def simulate_modal(
    basis: ModalBasis,
    start: ChainState,
    times: Sequence[float] | Array,
    *,
    step: float,
    kicks: int = 2,
    n_modes: int | None = None,
    most: float = inf,
) -> ChainMotion:
    """The motion from `start`, kept at `times`, by exact linear flow and nonlinear kicks.

    `kicks` to a step, 1 to 3; `n_modes` (all unless given) take part in the nonlinear motion, which dashpots allow
    all of them alone. The chain has no ledger of work here. Raises InputError, also for more work than `most`
    accelerations of links (`chain.work`).
    """
    began = perf_counter()
    check_number("step", step, "seconds", above=0)
    if kicks not in SCHEMES:
        raise InputError(f"kicks = {kicks!r}: give 1, 2 or 3 kicks to a step")
    n, held = len(basis.omega), int(basis.tilt != 0.0)
    if n_modes is not None and not 1 <= n_modes <= n - held:
        raise InputError(f"n_modes = {n_modes!r}: there are modes 1 to {n - held}")
    if n_modes is not None and n_modes < n - held:
        _refuse_dashpots(basis.system)
    samples = checked_times(start, times)
    seconds, taking = float(samples[-1] - start.time), n - held if n_modes is None else n_modes
    refuse_work(modal_work(seconds, step, kicks, basis.system.n_links, taking), most, seconds)
    begin, moved = project(basis.system, start)
    run = _Modal(basis, begin, samples, step, kicks, taking)
    ready = perf_counter()
    stopped = run.march()
    return run.motion(kicks, (ready - began, perf_counter() - ready), stopped, how_started(moved, start))


def simulate_linear(basis: ModalBasis, start: ChainState, times: Sequence[float] | Array) -> ChainMotion:
    """The linearised chain's motion, exact at any time, in the relative angles of the nonlinear one.

    Raises InputError for a chain with dashpots, which couple the modes.
    """
    _refuse_dashpots(basis.system)
    began = perf_counter()
    samples = checked_times(start, times)
    every = np.arange(len(basis.omega))
    state = linear_states(basis, _free(basis, start), samples - start.time, samples, every)
    angles, rates = state[:, :, 0] @ basis.modes + basis.rest.angles, state[:, :, 1] @ basis.modes
    statistics = ChainStatistics(
        method="linear, exact",
        steps=0,
        evaluations=0,
        step_s=0.0,
        set_up_s=0.0,
        wall_s=perf_counter() - began,
        stopped=END,
    )
    none = np.zeros(len(samples))
    return ChainMotion(
        system=basis.system,
        times=samples,
        angles=angles,
        rates=rates,
        dissipated=none,
        work_in=none,
        statistics=statistics,
    )


def linear_deflection(basis: ModalBasis, start: ChainState, times: Array, x: float) -> Array:
    """Y of one material point of the linearised chain at evenly spaced times, (n,), metres; about straight.

    A sum of exponentials at times t_i + s_j is a product of two small matrices: 2 sqrt(n) exponentials for each
    mode instead of n. Raises InputError where the times are not evenly spaced, and for dashpots.
    """
    _refuse_dashpots(basis.system)
    gaps = np.diff(times)
    if len(times) < 2 or np.ptp(gaps) > 1e-9 * abs(gaps[0]):
        raise InputError("times: give two or more, evenly spaced")
    link, at = link_at(basis.system, x)
    reach = np.append(basis.system.lengths[: link - 1], at)
    weights = np.cumsum(basis.modes, axis=1)[:, :link] @ reach
    free = _free(basis, start)
    moving = basis.omega > 0.0
    omega, still = basis.omega[moving], ~moving
    amplitudes = weights[moving] * (free[moving, 0] - 1j * free[moving, 1] / omega)
    block = int(np.ceil(np.sqrt(len(times))))
    starts = times[0] - start.time + gaps[0] * block * np.arange(-(-len(times) // block))
    fine = np.exp(1j * np.outer(omega, gaps[0] * np.arange(block)))
    swing = ((amplitudes * np.exp(1j * np.outer(starts, omega))) @ fine).real.ravel()[: len(times)]
    drift = weights[still] @ (free[still, :1] + free[still, 1:] * (times - start.time))
    steady = np.cos(np.outer(times, basis.drives[:, 0]) + basis.drives[:, 1]) @ (basis.shares @ weights)
    return np.asarray(swing + drift + steady)


def _refuse_dashpots(system: ChainSystem) -> None:
    """Raise InputError where the linear flow, which is undamped, is not the chain's."""
    if system.dashpots.any():
        raise InputError(
            f"chain.dashpots up to {float(system.dashpots.max())!r} N m s: the linear flow is undamped, leave them out "
            "or give method = 'adaptive', 'rk4' or 'modal' with all modes"
        )


def _free(basis: ModalBasis, start: ChainState) -> Array:
    """Modal state less the steady answer, (N, 2)."""
    state = np.stack([basis.duals @ (start.angles - basis.rest.angles), basis.duals @ start.rates], axis=1)
    return np.asarray(state - _steady_at(basis, np.array([start.time]))[0])


def _steady_at(basis: ModalBasis, times: Array) -> Array:
    """Steady answers to the harmonic loads, (n, N, 2)."""
    phases = np.outer(times, basis.drives[:, 0]) + basis.drives[:, 1]
    rates = -basis.drives[:, 0] * np.sin(phases)
    return np.stack([np.cos(phases) @ basis.shares, rates @ basis.shares], axis=2)


def linear_states(basis: ModalBasis, free: Array, since: Array, times: Array, which: Any) -> Array:
    """Modal states of some modes by the exact linear flow of `free`, (n, len(which), 2)."""
    cosine, sine, falling = np.moveaxis(_turns(basis.omega[which], since), 2, 0)
    x, y = free[which].T
    flow = np.stack([cosine * x + sine * y, cosine * y + falling * x], axis=2)
    return np.asarray(_steady_at(basis, times)[:, which] + flow)


def _turns(omega: Array, times: Array) -> Array:
    """(n, m, 3) for the exact flows of some times: cosine, sine over omega, -omega times sine."""
    turns = times[:, None] * omega
    c, s = np.cos(turns), np.sin(turns)
    sinc = np.where(omega > 0.0, s / np.where(omega > 0.0, omega, 1.0), times[:, None])
    return np.stack([c, sinc, -omega * s], axis=2)


def _flattened(basis: ModalBasis, chosen: Any, samples: Array, step: float, kicks: int) -> records.Modal:
    """The splitting as the kernels see it."""
    flows, weights = SCHEMES[kicks]
    omega, m, n = basis.omega[chosen], len(chosen), basis.system.n_links
    gaps = np.diff(samples)
    even = len(gaps) > 1 and np.ptp(gaps) < 1e-9 * gaps[0]
    return records.Modal(
        kicks=np.array(weights),
        shares_of_step=np.array(flows),
        omega=omega,
        flows=_turns(omega, step * np.array([*flows, 1.0])),
        spacing=_turns(omega, gaps[:1])[0] if even else np.zeros((0, 3)),
        modes=np.ascontiguousarray(basis.modes[chosen]),
        duals=np.ascontiguousarray(basis.duals[chosen]),
        rest=basis.rest.angles,
        drives=basis.drives,
        shares=np.ascontiguousarray(basis.shares[:, chosen]),
        tilt=basis.tilt,
        loose=flatten(basis.system, ledger=False)._replace(tip=records.FREE),
        start=np.zeros((m, 2)),
        steady=np.zeros((m, 2)),
        trial=np.zeros((m, 2)),
        vectors=np.zeros((3, n)),
        force=np.zeros(m),
    )


class _Modal:
    """Arrays of one run."""

    def __init__(
        self, basis: ModalBasis, start: ChainState, samples: Array, step: float, kicks: int, n_modes: int
    ) -> None:
        n, held = len(basis.omega), int(basis.tilt != 0.0)
        self.basis, self.samples, self.started = basis, samples, start.time
        chosen = np.concatenate([np.arange(n_modes), np.arange(n - held, n)]).astype(np.int64)
        self.chosen, self.others = chosen, np.arange(n_modes, n - held)
        steady = _steady_at(basis, np.array([start.time]))[0]
        self.begin = _free(basis, start)
        self.flat, self.work = flatten(basis.system, ledger=False), workspace(basis.system)
        self.kept = np.zeros((len(samples), 2, len(chosen)))
        self.clock, self.counts = np.array([start.time, step, 0.0]), np.zeros(5, dtype=np.int64)
        at_start = int(np.searchsorted(samples, start.time, side="right"))
        self.kept[:at_start], self.counts[3] = (self.begin + steady)[chosen].T, at_start
        self.free = np.ascontiguousarray(self.begin[chosen])
        self.modal = _flattened(basis, chosen, samples, step, kicks)

    def march(self) -> str:
        """Step until every sample is kept; why it stopped."""
        from verify.chain import splitting_kernels

        try:
            while True:
                status = splitting_kernels.march_modal(
                    self.flat, self.modal, self.clock, self.counts, self.samples, self.kept, 256, self.free, self.work
                )
                if status == records.DONE:
                    return END
                if status == records.DIVERGED:
                    return f"diverged at t = {self.clock[0]:.6g} s with a step of {self.clock[1]:.3g} s"
        except KeyboardInterrupt:
            return f"interrupted at t = {self.clock[0]:.6g} s"

    def motion(self, kicks: int, took: tuple[float, float], stopped: str, started: str) -> ChainMotion:
        """What was kept, back in angles; `took` are the seconds before and in the run."""
        kept, basis = int(self.counts[3]), self.basis
        times, modes = self.samples[:kept], self.modal.modes
        angles, rates = self.kept[:kept, 0] @ modes + basis.rest.angles, self.kept[:kept, 1] @ modes
        if len(self.others):
            state = linear_states(basis, self.begin, times - self.started, times, self.others)
            angles += state[:, :, 0] @ basis.modes[self.others]
            rates += state[:, :, 1] @ basis.modes[self.others]
        none = np.zeros(kept)
        statistics = ChainStatistics(
            method=f"modal, {kicks} kicks",
            steps=int(self.counts[0]),
            evaluations=int(self.counts[2]),
            step_s=float(self.clock[1]),
            set_up_s=took[0],
            wall_s=took[1],
            stopped=stopped,
            started=started,
            furthest=float(self.clock[2]),
        )
        return ChainMotion(
            system=basis.system,
            times=times,
            angles=angles,
            rates=rates,
            dissipated=none,
            work_in=none,
            statistics=statistics,
        )
