"""The nonlinear chain from rest: exact linear flow with kicks, RK4 and adaptive steps, against the converged chain.

Other engines move the same chain, so that they stand in the same case.
"""

from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from verify.bench.field_set import forces_of, relative_rms
from verify.bench.kind import Case, Entry, Judged, Line, Reference, Told
from verify.bench.request import Settled
from verify.chain.confirmed import check_moved
from verify.chain.dynamics import at_rest
from verify.chain.splitting import linear_deflection, modal_basis, simulate_modal
from verify.chain.stepping import simulate, step_limit
from verify.chain.system import ChainState, ChainSystem, build_system
from verify.chain.work import check_modes_of, fixed_steps, modal_work, per_evaluation
from verify.errors import InputError
from verify.models.arrays import Array
from verify.words import newtons

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

SAMPLES, FINE = 200, 10
"""Kept of every run; and how many of the reference lie between two of them, for engines that keep their own."""
CONVERGED, NEARLY = 1e-10, 1e-9
"""Tolerances of the reference, and of what it is held against itself."""
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
HALVINGS = 5
FIRST_STEP, BELOW_LIMIT = 1.0 / 3.0, 0.97
"""Of the drive's period, for kicks; of the stability limit, for RK4."""
KICKS, RK4, ADAPTIVE, FLOW = "kicks", "RK4", "adaptive", "linear flow"
LINK_S = 5e-8
"""Of an acceleration of a link, from above."""
WANTED = (1e-3, 1e-5)


class Chain(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """One chain, what drives it from rest, and where it is read."""

    system: ChainSystem
    start: ChainState
    count: int
    duration: float
    x: float
    period: float
    """Of the drive, seconds."""

    @property
    def times(self) -> Array:
        """(SAMPLES,), seconds; evenly, the last at the end."""
        return np.linspace(self.duration / SAMPLES, self.duration, SAMPLES)


def chain_of(scene: "Scene", its: Settled, count: int) -> Chain:
    """The chain of the scene's beam under its forces. Raises InputError."""
    forces = forces_of(scene, "chain")
    assert scene.drive is not None
    check_modes_of(count, 2)
    system = build_system(scene.beam, count, forces, scene.drive.frequency_hz)
    return Chain(
        system=system,
        start=at_rest(system),
        count=count,
        duration=its.duration,
        x=its.x,
        period=1.0 / scene.drive.frequency_hz,
    )


def chain_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """One for each number of links. Raises InputError."""
    for count in its.chains:
        chain = chain_of(scene, its, count)
        theirs: tuple[Entry, ...] = ()
        absent: tuple[str, ...] = ()
        if its.peers:
            from verify.bench.peer_set import chain_entries

            theirs, absent = chain_entries(scene, its, chain)
        names = dict.fromkeys(entry.line.name for entry in theirs)
        sizes = newtons(force.amplitude for force in scene.forces)
        yield Case(
            set="chain",
            about=f"N = {count}",
            question=f"deflection at x = {its.x:g} m, rms over time",
            condition=f"{sizes} from rest, a step load, for {1e3 * its.duration:.3g} ms",
            entries=(*_kicks(chain, 1), *_kicks(chain, 2), *_rk4(chain), *_adaptive(chain), _flow(chain), *theirs),
            pairs=(
                (f"{KICKS}, 2", RK4),
                (f"{KICKS}, 2", ADAPTIVE),
                (f"{KICKS}, 2", f"{KICKS}, 1"),
                (ADAPTIVE, RK4),
            ),
            races=tuple((ours, name) for name in names for ours in (f"{KICKS}, 2", RK4)),
            judge=_judge(chain),
            estimate_s=2.0 * _adaptive_seconds(chain, CONVERGED),
            wanted=WANTED,
            notes=absent,
        )


def _kicks(chain: Chain, number: int) -> Iterator[Entry]:
    line = Line(name=f"{KICKS}, {number}", orders=(2.0, 2.0 * number), refined="step", settings={"kicks": number})

    def prepare(step: float) -> Callable[[], Told]:
        basis = modal_basis(chain.system)

        def run() -> Told:
            moved = simulate_modal(basis, chain.start, chain.times, step=step, kicks=number)
            check_moved(moved)
            return Told(moved.deflection([chain.x])[:, 0])

        return run

    for step in (min(FIRST_STEP * chain.period, chain.duration) / 2**k for k in range(HALVINGS)):
        work = LINK_S * modal_work(chain.duration, step, number, chain.count, chain.count)
        yield _entry(chain, line, step, work + 2e-3 + 1e-7 * chain.count**3, partial(prepare, step))


def _rk4(chain: Chain) -> Iterator[Entry]:
    limit = step_limit(chain.system, chain.start)

    def run(step: float) -> Told:
        moved = simulate(chain.system, chain.start, chain.times, method="rk4", step=step, ledger=False, limit=limit)
        check_moved(moved)
        return Told(moved.deflection([chain.x])[:, 0])

    line = Line(name=RK4, orders=(4.0, 4.0), refined="step")
    for step in (BELOW_LIMIT * limit / 2**k for k in range(HALVINGS)):
        work = 4.0 * fixed_steps(chain.duration, step) * per_evaluation(chain.count) * LINK_S
        yield _entry(chain, line, step, work, partial(partial, run, step), sets_up=False)


def _adaptive(chain: Chain) -> Iterator[Entry]:
    line = Line(name=ADAPTIVE, orders=(1.0, 1.0), refined="tolerance")

    def run(tolerance: float) -> Told:
        return Told(_moved(chain, tolerance, chain.times))

    for tolerance in TOLERANCES:
        yield Entry(
            line=line,
            size=tolerance,
            count=chain.count,
            estimate_s=_adaptive_seconds(chain, tolerance),
            prepare=partial(partial, run, tolerance),
            settings={"tolerance": tolerance},
        )


def _flow(chain: Chain) -> Entry:
    """Exact, of the linear chain: what axial inertia does is its error."""

    def prepare() -> Callable[[], Told]:
        basis = modal_basis(chain.system)
        return lambda: Told(linear_deflection(basis, chain.start, chain.times, chain.x))

    seconds = 2e-3 + 1e-7 * chain.count**3
    line = Line(name=FLOW, model="segment")
    return Entry(line=line, size=0.0, count=chain.count, estimate_s=seconds, prepare=prepare, sets_up=True)


def _entry(
    chain: Chain, line: Line, step: float, seconds: float, prepare: Callable[[], Any], *, sets_up: bool = True
) -> Entry:
    return Entry(
        line=line,
        size=step,
        count=chain.count,
        estimate_s=seconds,
        prepare=prepare,
        sets_up=sets_up,
        settings={"step": step},
    )


def _moved(chain: Chain, tolerance: float, times: Array) -> Array:
    moved = simulate(chain.system, chain.start, times, tolerance=tolerance, ledger=False)
    check_moved(moved)
    return moved.deflection([chain.x])[:, 0]


def _adaptive_seconds(chain: Chain, tolerance: float) -> float:
    """An estimate from above: half a radian of the fastest mode to a step of six accelerations, more below 1e-3."""
    link = chain.system.lengths.min()
    wave = np.sqrt(chain.system.stiffness.max() * link / (chain.system.masses.min() / link))
    radians = 4.0 * 3.0**0.5 / link**2 * wave * chain.duration
    return float(radians * max(1.0, (1e-6 / tolerance) ** 0.2) * 6.0 * per_evaluation(chain.count) * LINK_S)


def _judge(chain: Chain) -> Callable[[], Callable[[Entry, Any], Judged]]:
    def judge() -> Callable[[Entry, Any], Judged]:
        times = np.linspace(0.0, chain.duration, SAMPLES * FINE + 1)[1:]
        exact = _moved(chain, CONVERGED, times)
        if not exact.any():
            raise InputError(f"chain: nothing moves at x = {chain.x:g} m, choose another place")
        left = relative_rms(_moved(chain, NEARLY, times), exact)
        reference = Reference(
            f"converged chain, adaptive at {CONVERGED:g}, and what {NEARLY:g} changes", max(left, CONVERGED)
        )

        @lru_cache(maxsize=1)
        def between() -> Callable[[Array], Array]:
            from scipy.interpolate import CubicSpline

            spline = CubicSpline(np.append(0.0, times), np.append(0.0, exact))
            return lambda at: np.asarray(spline(at))

        def error(entry: Entry, answer: Any) -> Judged:
            if isinstance(answer, tuple):
                at, found = answer
                return Judged(relative_rms(found, between()(at)), reference)
            return Judged(relative_rms(answer, exact[FINE - 1 :: FINE]), reference)

        return error

    return judge
