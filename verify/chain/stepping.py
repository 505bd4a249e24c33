"""The nonlinear chain in time: explicit Runge-Kutta with a fixed or a controlled step, and what came of it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Literal, get_args

import numpy as np

from verify.arrays import Array
from verify.chain import records
from verify.chain.dynamics import (
    PIVOT_LOSS,
    accelerated,
    choose_pivots,
    flatten,
    held_rows,
    keep_pivots,
    project,
    workspace,
)
from verify.chain.result import ChainMotion, ChainStatistics
from verify.chain.system import ChainState, ChainSystem
from verify.errors import InputError, near_name
from verify.motion.result import END
from verify.validation import check_number, check_unmasked

Method = Literal["rk4", "adaptive"]
METHODS: tuple[str, ...] = get_args(Method)
PROJECTED = 1e-9
"""A start is said to be inconsistent where projection changes an angle or rate by more than this share."""
_BUDGET = 100_000
"""Link steps between two looks at the keyboard: some tens of milliseconds."""


@dataclass(frozen=True, eq=False)
class Tableau:
    """An explicit Runge-Kutta method of s stages; its last row of `a` is its answer."""

    a: Array
    """(s + 1, s)."""
    c: Array
    """(s,)."""
    weights: Array
    """(s + 1,) of the error estimate, the last for the rates at the answer; empty without one."""
    order: float


def _tableau(rows: list[list[float]], c: list[float], weights: list[float], order: float) -> Tableau:
    a = np.zeros((len(c) + 1, len(c)))
    for i, row in enumerate(rows, start=1):
        a[i, : len(row)] = row
    # a whole number would be a type of its own to numba, which compiles for types
    return Tableau(a, np.array(c, dtype=float), np.array(weights, dtype=float), float(order))


RK4 = _tableau([[0.5], [0, 0.5], [0, 0, 1], [1 / 6, 1 / 3, 1 / 3, 1 / 6]], [0, 0.5, 0.5, 1], [], 4)
DORMAND_PRINCE = _tableau(
    [
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ],
    [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1],
    [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
    5,
)
"""J. R. Dormand and P. J. Prince, J. Comp. Appl. Math. 6 (1980) 19."""


def simulate(
    system: ChainSystem,
    start: ChainState,
    times: Sequence[float] | Array,
    *,
    method: Method = "adaptive",
    step: float | None = None,
    tolerance: float = 1e-8,
    ledger: bool = True,
    progress: Callable[[float], None] = lambda part: None,
) -> ChainMotion:
    """The motion from `start`, kept at `times` (ascending, from start.time on).

    "rk4" takes a fixed `step` and is refused above its stability limit (`step_limit`); "adaptive" is Dormand and
    Prince's pair of orders 5 and 4, its error per step held to `tolerance` of the largest motion so far. Both are of
    order l^2 in the step they can take. A start off the held points is projected, and the statistics say so.
    An interrupt returns what is kept. `progress` is
    called with the fraction of time done. Raises InputError.
    """
    began = perf_counter()
    _check_method(method, step, tolerance)
    samples = checked_times(start, times)
    begin, moved = project(system, start)
    if method == "rk4" and step is not None:
        refuse_unstable(step, step_limit(system, begin))
    run = _Run(system, begin, samples, RK4 if method == "rk4" else DORMAND_PRINCE, step, tolerance, ledger)
    ready = perf_counter()
    stopped = run.march(progress)
    return run.motion(method, (ready - began, perf_counter() - ready), stopped, how_started(moved, start))


def _check_method(method: str, step: float | None, tolerance: float) -> None:
    """Raise InputError for settings that do not go together."""
    if method not in METHODS:
        raise InputError(f"method = {method!r} is not known: {near_name(method, METHODS)}")
    if (method == "rk4") != (step is not None):
        raise InputError(f"step = {step!r}: give a step in seconds with method = 'rk4', and none with 'adaptive'")
    if step is not None:
        check_number("step", step, "seconds", above=0)
    check_number("tolerance", tolerance, "relative", above=0, below=0.1)


def checked_times(start: ChainState, times: Any) -> Array:
    """The times as an array. Raises InputError unless they ascend from the start's on."""
    check_unmasked("times", times, "seconds")
    samples = np.atleast_1d(np.asarray(times, dtype=float))
    if not samples.size or not np.isfinite(samples).all() or (np.diff(samples) <= 0).any() or samples[0] < start.time:
        raise InputError(f"times: give ascending finite times from {start.time!r} s on")
    return samples


def how_started(moved: float, start: ChainState) -> str:
    """Whether the start was consistent, in words."""
    size = max(abs(start.angles).max(), abs(start.rates).max(), 1e-300)
    if moved <= PROJECTED * size:
        return "consistent"
    return f"projected onto the held points: an angle or rate changed by {moved:.3g}"


class _Run:
    """Arrays of one run."""

    def __init__(
        self,
        system: ChainSystem,
        start: ChainState,
        samples: Array,
        table: Tableau,
        step: float | None,
        tolerance: float,
        ledger: bool,
    ) -> None:
        self.system = system
        self.flat, self.work = flatten(system, ledger=ledger), workspace(system)
        rows = held_rows(system, start)
        fastest = 0.0 if step else highest_rate(system, start)
        first = step or min(0.1 / max(fastest, 1e-12), max(samples[-1] - start.time, 1e-12))
        floor = 1e-3 * tolerance**1.5
        size = 2 * system.n_links + 2
        self.m = records.March(
            a=table.a,
            c=table.c,
            weights=table.weights,
            order=table.order,
            y=np.concatenate([start.angles, start.rates, [0.0, 0.0]]),
            new=np.zeros(size),
            k=np.zeros((len(table.c) + 1, size)),
            samples=samples,
            kept=np.zeros((len(samples), size)),
            counts=np.zeros(5, dtype=np.int64),
            clock=np.array([start.time, first, PIVOT_LOSS]),
            scale=np.array([tolerance, floor, floor * max(fastest, 1.0), 0.0, 0.0, 0.0]),
            pivots=choose_pivots(rows),
        )
        at_start = int(np.searchsorted(samples, start.time, side="right"))
        self.m.kept[:at_start], self.m.counts[3] = self.m.y, at_start

    def march(self, progress: Callable[[float], None]) -> str:
        """Step until every sample is kept; why it stopped."""
        from verify.chain import kernels

        budget = max(_BUDGET // self.system.n_links, 16)
        begun, end = float(self.m.clock[0]), float(self.m.samples[-1])
        try:
            while True:
                status = kernels.march(self.flat, self.m, budget, self.work)
                if status != records.RUNNING:
                    return self.ended(status)
                progress((float(self.m.clock[0]) - begun) / (end - begun))
                if self.flat.held.shape[0] > 1:
                    self.keep_pivots()
        except KeyboardInterrupt:
            return f"interrupted at t = {self.m.clock[0]:.6g} s"

    def keep_pivots(self) -> None:
        """Exchange dependent angles that have become poor."""
        n = self.system.n_links
        rows = held_rows(self.system, ChainState(self.m.y[:n], self.m.y[n : 2 * n], float(self.m.clock[0])))
        better = keep_pivots(rows, self.m.pivots)
        self.m.counts[4] += int((better != self.m.pivots).any())
        self.m.pivots[:] = better

    def ended(self, status: int) -> str:
        """The end in words."""
        if status == records.DONE:
            return END
        at = f"at t = {self.m.clock[0]:.6g} s with a step of {self.m.clock[1]:.3g} s"
        return f"diverged {at}" if status == records.DIVERGED else f"stopped {at}, too small to go on"

    def motion(self, method: str, took: tuple[float, float], stopped: str, started: str) -> ChainMotion:
        """What was kept; `took` are the seconds before and in the run."""
        n, kept = self.system.n_links, int(self.m.counts[3])
        steps, rejected, evaluations, _, changes = (int(c) for c in self.m.counts)
        rows = self.m.kept[:kept]
        return ChainMotion(
            system=self.system,
            times=self.m.samples[:kept],
            angles=rows[:, :n],
            rates=rows[:, n : 2 * n],
            dissipated=rows[:, 2 * n],
            work_in=rows[:, 2 * n + 1],
            statistics=ChainStatistics(
                method=method,
                steps=steps,
                rejected=rejected,
                evaluations=evaluations,
                step_s=float(self.m.clock[1]),
                set_up_s=took[0],
                wall_s=took[1],
                stopped=stopped,
                started=started,
                pivot_changes=changes,
                furthest=float(self.m.scale[5]),
            ),
        )


def _largest(apply: Callable[[Array], Array], n: int) -> float:
    """The largest eigenvalue, by modulus, of a linear map given by its action."""
    if n <= 8:
        values = np.linalg.eigvals(np.array([apply(column) for column in np.eye(n)]).T)
        return float(abs(values).max())
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

    operator = LinearOperator((n, n), matvec=lambda u: apply(np.ravel(u)), dtype=float)
    start = np.random.default_rng(49).standard_normal(n)
    try:
        values = eigs(operator, k=1, which="LM", v0=start, tol=1e-3, return_eigenvectors=False)
    except ArpackNoConvergence as error:  # the limit is then a little on the bold side; divergence is caught anyway
        values = error.eigenvalues if len(error.eigenvalues) else np.array([0.0])
    return float(abs(values[0]))


def _slopes(system: ChainSystem, state: ChainState) -> tuple[Callable[[Array], Array], Callable[[Array], Array]]:
    """Derivatives of the accelerations by angles and by rates, as maps."""
    answer = accelerated(system)
    base = answer(state.time, state.angles, 0.0)

    def by_angles(u: Array) -> Array:
        size = 1e-6 / max(float(abs(u).max()), 1e-300)
        return (answer(state.time, state.angles + size * u, 0.0) - base) / size

    def by_rates(u: Array) -> Array:
        size = 1e-6 / max(float(abs(u).max()), 1e-300)
        return (answer(state.time, state.angles, size * u) - base) / size

    return by_angles, by_rates


def highest_rate(system: ChainSystem, state: ChainState) -> float:
    """The highest circular frequency of the chain held still in a state, rad/s."""
    return float(np.sqrt(_largest(_slopes(system, state)[0], system.n_links)))


def step_limit(system: ChainSystem, state: ChainState) -> float:
    """The longest stable step of RK4 about a state, seconds: |R(h lambda)| <= 1 for the fastest modes.

    2 sqrt(2) over the highest circular frequency without dashpots.
    """
    by_angles, by_rates = _slopes(system, state)
    omega2 = _largest(by_angles, system.n_links)
    damping = _largest(by_rates, system.n_links) if system.dashpots.any() else 0.0
    root = np.sqrt(complex(0.25 * damping**2 - omega2))
    fastest = max(abs(-0.5 * damping + root), abs(-0.5 * damping - root))
    if fastest == 0.0:
        return float("inf")
    z = np.linspace(0.0, 3.0, 30001)[1:]
    stable = np.ones(len(z), dtype=bool)
    for value in (-0.5 * damping + root, -0.5 * damping - root):
        w = z * value / fastest
        stable &= abs(1 + w + w**2 / 2 + w**3 / 6 + w**4 / 24) <= 1.0 + 1e-12
    return float(z[np.argmin(stable) - 1] / fastest)  # at 3 no root is stable: each grows by 1.118 or more


def refuse_unstable(step: float, limit: float) -> None:
    """Raise InputError for a fixed step above the limit, naming the limit."""
    if step > limit:
        raise InputError(
            f"step = {step!r} s lies above the stability limit {limit:.4g} s of rk4 on this chain: "
            "give a smaller step, fewer segments or method = 'adaptive'"
        )
