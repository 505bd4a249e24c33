"""The nonlinear chain in time: `simulate` with rigid links, `simulate_elastic` with stretching ones, `from_rest`.

Large rotations are soon chaotic: step errors grow by a factor per swing until no digit is correct. `from_rest`
confirms such a motion by a second run with ten times the tolerance.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from msgspec import structs

from verify.arrays import Array
from verify.chain.kinematics import at_rest, energies, place, project
from verify.chain.system import ChainState, ChainSystem, link_at, straight_chain
from verify.dynamics.result import END, Statistics
from verify.errors import InputError
from verify.linear.step_schemes import RK4 as RK4_SCHEME
from verify.problem.base_motion import FIXED
from verify.segments.chain import Motions, link_mass, plain_factors
from verify.segments.reading import contact_line
from verify.settings import ChainReading
from verify.validation import check_number

if TYPE_CHECKING:
    from verify.chain.runge_kutta import Marched

Progress = Callable[[float], None]  # called with the completed fraction of a motion, 0 to 1
FAR = 0.3  # rotation of links, rad, above which a motion from rest is confirmed by a second run
STRAIGHT = 0.5
"""Turn of a link from the hub, rad, up to which joints follow the axial force: beyond it the straight chain's is off by
more than an eighth, and twelve links err more than with joints EI/l."""
AGREED = 0.01  # largest distance of two runs, over the largest deflection, at which the second confirms the first


class ChainStatistics(Statistics, frozen=True, kw_only=True):
    """Cost and end of a chain's run."""

    furthest: float
    """Largest rotation of a link from the straight chain, rad, at the ends of steps; of stretching links at samples."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ChainMotion(ABC):
    """Motion of a chain at its times."""

    system: ChainSystem
    times: Array  # (n,), s; fewer than requested where the run stopped early
    states: Array  # (n, size), coordinates of the march, their rates, quadratures
    statistics: ChainStatistics

    @abstractmethod
    def joints(self) -> Array:
        """Positions of joints 0..N from joint 0 of the straight chain, (n, N + 1, 2), m."""

    @abstractmethod
    def directions(self) -> Array:
        """Absolute angles of the links, (n, N), rad."""

    def deflection(self, x: Sequence[float], *, reading: ChainReading = "corrected") -> Array:
        """Deflection at x of the straight chain, (n, len(x)), m. Raises InputError for positions off the chain.

        `reading`: "corrected", the contact line of `SegmentModel` and sliders through the corrected joints, or "links",
        material points of the straight links.
        """
        columns, heights = [], self.joints()[..., 1]
        for position in x:
            check_number("x", position, "metres, on the chain", at_least=0, at_most=self.system.length * (1.0 + 1e-12))
        if reading == "corrected":
            line = contact_line(straight_chain(self.system), heights)
            return np.asarray(line(np.minimum(x, self.system.length)))
        for position in x:
            link, at = link_at(self.system, position)
            share = at / self.system.lengths[link - 1]
            columns.append((1.0 - share) * heights[:, link - 1] + share * heights[:, link])
        return np.stack(columns, axis=1)


class RigidMotion(ChainMotion):
    """Motion of a chain of rigid links: absolute angles, their rates, energy dissipated, work of loads and hub."""

    @property
    def angles(self) -> Array:
        """Relative angles, (n, N), rad."""
        return np.diff(self.directions(), prepend=self.system.hub(self.times)[0][:, None])

    @property
    def rates(self) -> Array:
        """Rates of the relative angles, (n, N), rad/s."""
        n = self.system.n_links
        return np.diff(self.states[:, n : 2 * n], prepend=self.system.hub(self.times)[1][:, None])

    def state(self, index: int) -> ChainState:
        """The state at one of the times."""
        return ChainState(self.angles[index], self.rates[index], float(self.times[index]))

    def energies(self) -> Array:
        """Kinetic, elastic and gravitational energy, (3, n), J, of the motion relative to the hub's joint."""
        return energies(self.system, self.times, self.angles, self.rates)

    def residual(self) -> Array:
        """Change of energy less work plus dissipation, (n,), J: the error of the time steps."""
        balance = self.energies().sum(axis=0) - self.states[:, -1] + self.states[:, -2]
        return np.asarray(balance - balance[0])

    def directions(self) -> Array:
        """Absolute angles of the links, (n, N), rad."""
        return self.states[:, : self.system.n_links]

    def joints(self) -> Array:
        """Positions of joints 0..N, (n, N + 1, 2), m."""
        return place(self.system, self.times, self.angles, self.rates).joints

    def root_moments(self) -> Array:
        """Moment of the joint at the hub, (n,), N m."""
        stiffness = np.full(len(self.times), self.system.stiffness[0])
        if len(self.system.softening):
            stiffness -= self.system.softening[0] * self.system.tension(self.times)[:, 0]
        return np.asarray(stiffness * self.angles[:, 0])

    def in_base(self) -> Array:
        """Positions of joints 0..N from joint 0 along and across the hub's direction, (n, N + 1, 2), m."""
        angle = self.system.hub(self.times)[0]
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        x, y = np.moveaxis(self.joints(), -1, 0)
        return np.stack([c * x + s * y, c * y - s * x], axis=-1)


class ElasticMotion(ChainMotion):
    """Motion of a chain of stretching links: displacements of joints 0..N from the straight chain, their rates."""

    def moved(self) -> tuple[Array, Array]:
        """Displacements, m, and velocities, m/s, of joints 0..N, (n, N + 1, 2) each."""
        u, v = self.states.reshape(len(self.times), 2, -1, 2).transpose(1, 0, 2, 3)
        return u, v

    def directions(self) -> Array:
        """Absolute angles of the links, (n, N), rad."""
        along, across = np.diff(self.moved()[0], axis=1).transpose(2, 0, 1)
        return np.asarray(np.arctan2(across, self.system.lengths + along))

    def joints(self) -> Array:
        """Positions of joints 0..N, (n, N + 1, 2), m."""
        return self.moved()[0] + np.stack([self.system.nodes, 0.0 * self.system.nodes], axis=1)


def highest_frequency(system: ChainSystem) -> tuple[float, float]:
    """(largest circular frequency of the straight chain at rest, rad/s, largest damping coefficient c / m, 1/s)."""
    from scipy.linalg import eigh
    from scipy.sparse import diags_array
    from scipy.sparse.linalg import eigsh

    chain = straight_chain(system)
    differences, angles = plain_factors(chain)
    bends, mass = angles @ differences, link_mass(Motions(chain))

    def largest(coefficients: Array) -> float:
        if not coefficients.any():
            return 0.0
        matrix = bends.T @ diags_array(coefficients[system.n_links - bends.shape[0] :]) @ bends
        if mass.shape[0] <= 8:
            return float(eigh(matrix.toarray(), mass.toarray(), eigvals_only=True)[-1])
        start = np.random.default_rng(49).standard_normal(mass.shape[0])
        return float(eigsh(matrix.tocsc(), 1, mass, which="LM", v0=start, tol=1e-6, return_eigenvectors=False)[0])

    return float(np.sqrt(largest(system.stiffness))), largest(system.dashpots)


def step_limit(system: ChainSystem) -> float:
    """The longest stable step of RK4 about the straight chain at rest, s; infinite without springs.

    2 sqrt(2) over the highest circular frequency; with dashpots 2.6156 over the fastest root.
    """
    return _stable_step(*highest_frequency(system))


def _stable_step(omega: float, damping: float) -> float:
    """The stable step of RK4 for roots of lambda^2 + damping lambda + omega^2 = 0, s.

    2 sqrt(2) on the imaginary axis; the least radius of the stability region in the left half plane is 2.6156, at
    122.6 degrees.
    """
    fastest = max(omega, 0.5 * damping + np.sqrt(max(0.25 * damping**2 - omega**2, 0.0)))
    return float((2.6156 if damping else RK4_SCHEME.limit) / fastest) if fastest else float("inf")


def elastic_step_limit(system: ChainSystem) -> float:
    """A stable step of RK4 of stretching links, s: `step_limit` with bounds on the highest frequency and damping.

    Neither exceeds the highest of any link by itself (B. M. Irons and G. Treharne): sqrt(EA l / J) in stretching,
    sqrt(2 (k_i + k_j) / J) in bending, the rate 2 (c_i + c_j) / J of the dashpots.
    """
    springs, dashpots = (rate + np.append(rate[1:], 0.0) for rate in (system.stiffness, system.dashpots))
    squares = np.maximum(system.axial_stiffness * system.lengths, 2.0 * springs) / system.inertias
    return _stable_step(float(np.sqrt(squares.max())), float((2.0 * dashpots / system.inertias).max()))


def simulate(
    system: ChainSystem,
    start: ChainState,
    times: Sequence[float] | Array,
    *,
    step: float | None = None,
    tolerance: float = 1e-8,
    progress: Progress = lambda part: None,
    most_steps: float = np.inf,
) -> RigidMotion:
    """The motion from `start` at ascending `times`, from start.time on; the last one is the exact end of a step.

    A fixed `step`, at most `step_limit`, is one of RK4; without it Dormand and Prince's pair of orders 5 and 4 has an
    error per step of at most `tolerance` of the largest motion so far. A start off the roller is projected. Raises
    InputError, also where more than `most_steps` are to be expected.
    """
    began, follows = perf_counter(), len(system.softening) > 0
    if follows and any(any(load.force) for load in system.loads):
        raise InputError("chain.loads: tensioned joints follow the force of base and gravity alone, leave forces out")
    if system.base is not FIXED and (system.tip == "roller" or system.hub_rate):
        raise InputError("chain.base: a moving base carries a chain with a free tip and no hub_rate, give such a chain")
    samples, state = np.atleast_1d(np.asarray(times, dtype=float)), project(system, start)
    if step is not None and not 0.0 < step <= (limit := step_limit(system)):
        raise InputError(f"step = {step!r} s: give one above 0 and up to the stability limit, {limit:.4g} s, or none")
    from verify.chain import rigid_links
    from verify.chain.runge_kutta import DORMAND_PRINCE, RK4, integrate

    n, fastest = system.n_links, 0.0 if step else highest_frequency(system)[0]
    first = step or min(0.1 / max(fastest, 1e-12), max(float(samples[-1]) - start.time, 1e-12))
    floor = 1e-3 * tolerance**1.5
    control = (tolerance, floor, floor * max(fastest, 1.0), np.pi if step else np.inf)
    model = rigid_links.flatten(system, float(samples[-1]))
    y, ready = rigid_links.begin(system, state, model[2]), perf_counter()
    table = RK4 if step else DORMAND_PRINCE
    run = integrate(
        rigid_links.accelerate, model, table, n, y, start.time, samples, first, control, progress, most_steps
    )
    statistics = _statistics(run, run.furthest, began, ready)
    motion = RigidMotion(system=system, times=samples[: len(run.kept)], states=run.kept, statistics=statistics)
    if follows and (far := abs(np.cumsum(motion.angles, axis=1)).max()) > STRAIGHT:
        raise InputError(
            f"joints: tensioned ones take the axial force of a straight chain, whose links turn by up to {STRAIGHT} "
            f"rad from the base, these by {far:.2g}: choose joints = 'series', or move the base more slowly"
        )
    return motion


def simulate_elastic(
    system: ChainSystem, times: Sequence[float] | Array, *, step: float | None = None
) -> ElasticMotion:
    """The motion of stretching links from rest at even `times` from 0.

    `step` of RK4 is at most `elastic_step_limit`, half of it unless given, shortened to divide the spacing of the
    times. Hub, axial spring and `axial_inertia` are not modelled. Raises InputError.
    """
    began = perf_counter()
    if system.base is not FIXED:
        raise InputError("chain.base: links that stretch have a base at rest, give rigid links")
    samples = np.asarray(times, dtype=float)
    limit = elastic_step_limit(system)
    step = 0.5 * limit if step is None else step
    check_number("step", step, "seconds", above=0, at_most=limit)
    from verify.chain import elastic_links
    from verify.chain.runge_kutta import RK4, integrate

    size = 2 * system.n_links + 2
    model, y = elastic_links.flatten(system), np.zeros(2 * size)
    spacing, ready = float(samples[1]), perf_counter()
    step = spacing / np.ceil(spacing / step - 1e-9)
    run = integrate(elastic_links.accelerate, model, RK4, size, y, 0.0, samples, step, (0.0, 0.0, 0.0, np.inf))
    statistics = _statistics(run, 0.0, began, ready)
    motion = ElasticMotion(system=system, times=samples[: len(run.kept)], states=run.kept, statistics=statistics)
    return replace(motion, statistics=structs.replace(statistics, furthest=float(abs(motion.directions()).max())))


def _statistics(run: "Marched", furthest: float, began: float, ready: float) -> ChainStatistics:
    """Cost and end of a run that began and was ready for its steps at these times."""
    steps, evaluations, _ = run.counts.tolist()
    reason = {2: "diverged", 3: "the step became too small"}
    return ChainStatistics(
        steps=steps,
        evaluations=evaluations,
        step_s=run.step,
        set_up_s=ready - began,
        wall_s=perf_counter() - ready,
        stopped=END if run.status == 1 else f"{reason[run.status]} at t = {run.time:.6g} s",
        furthest=furthest,
    )


def from_rest(
    system: ChainSystem, times: Array, *, tolerance: float, progress: Progress = lambda part: None
) -> ChainMotion:
    """The motion from rest at `times`, (n,), s, of rigid links with `tolerance` or of stretching ones.

    Where links turn by more than `FAR` a run at ten times the tolerance (half the step) confirms it to `AGREED` of the
    largest deflection. Raises InputError for a run that diverges and one that is not confirmed.
    """

    def run(size: float | None) -> ChainMotion:
        if system.rigid:
            return simulate(system, at_rest(system), times, tolerance=size or tolerance, progress=progress)
        return simulate_elastic(system, times, step=size)

    motion = run(None)
    check_moved(motion)
    if motion.statistics.furthest > FAR:
        name, other = ("tolerance", 10.0 * tolerance) if system.rigid else ("step", 0.5 * motion.statistics.step_s)
        heights, others = (one.joints()[..., 1] for one in (motion, run(other)))
        largest = np.maximum.accumulate(abs(heights).max(axis=1))[: len(others)]
        apart = ~(abs(heights[: len(others)] - others).max(axis=1) <= AGREED * largest)
        if apart.any() or len(others) < len(heights):
            last = motion.times[int(np.argmax(apart)) if apart.any() else len(others)]
            raise InputError(
                f"{name} does not converge after {last:.4g} s, where links turn by up to "
                f"{motion.statistics.furthest:.2g} rad: a run with {name} = {other:g} departs from it; give a shorter "
                "time or smaller forces"
            )
    return motion


def check_moved(motion: ChainMotion) -> None:
    """Raise InputError for a run that did not reach its end."""
    if not motion.statistics.finished:
        raise InputError(f"the chain's motion {motion.statistics.stopped}: give smaller forces or a smaller step")
