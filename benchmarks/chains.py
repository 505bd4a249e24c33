"""What benchmarks of the nonlinear chain share: the paper's beam as a chain, this suite's integrators on it, timing."""

from collections.abc import Callable
from math import sqrt
from time import perf_counter

import numpy as np

from verify.beam import Beam, PointForce
from verify.chain.dynamics import at_rest
from verify.chain.splitting import linear_deflection, modal_basis, simulate_modal
from verify.chain.stepping import simulate, step_limit
from verify.chain.system import ChainSystem, build_system
from verify.models.arrays import Array
from verify.peers import case as peers
from verify.peers.case import Case
from verify.timing import interleaved_medians

Run = Callable[[float, float], tuple[Array, Array]]
"""(step, end) -> (times, deflection of the middle of the chain)."""
END, SAMPLES = 2e-3, 200
BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FREQUENCY = 4276.0
TURN_S = 0.02
"""Shortest turn of a round."""
MODES = 60
"""Modes that take part in the nonlinear motion, where the chain has more: 15 kHz at 49 links, 33 kHz at 199."""


def forces_of(amplitude: float) -> list[PointForce]:
    """Sin and cos at the paper's 11.6 mm from both ends."""
    return [
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=BEAM.length - 0.0116, amplitude=amplitude),
    ]


def case_of(n: int, amplitude: float) -> Case:
    """The paper's beam as a chain."""
    return peers.case_of(BEAM, n, forces_of(amplitude), FREQUENCY)


def system_of(case: Case) -> ChainSystem:
    """The same for this suite."""
    return build_system(BEAM, case.n, list(case.forces), case.frequency)


def converged(case: Case, times: Array) -> Array:
    """Mid-span of the nonlinear chain by the adaptive integrator."""
    system = system_of(case)
    motion = simulate(system, at_rest(system), times, tolerance=1e-9 if case.n < 100 else 1e-7, ledger=False)
    return motion.deflection([case.length / 2])[:, 0]


def kicks(case: Case) -> Run:
    """Exact linear flow and one nonlinear kick to a step."""
    system = system_of(case)
    basis, start = modal_basis(system), at_rest(system)
    modes = min(MODES, case.n - 1)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        motion = simulate_modal(basis, start, times, step=step, kicks=1, n_modes=modes)
        return motion.times, motion.deflection([case.length / 2])[:, 0]

    return run


def fixed_steps(case: Case) -> Run:
    """RK4 on the O(N) recursion."""
    system = system_of(case)
    start = at_rest(system)
    limit = step_limit(system, start)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        motion = simulate(system, start, times, method="rk4", step=step, ledger=False, limit=limit)
        return motion.times, motion.deflection([case.length / 2])[:, 0]

    return run


def linear_flow(case: Case) -> Run:
    """The exact linear flow, read at mid-span; no step."""
    system = system_of(case)
    basis, start = modal_basis(system), at_rest(system)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        return times, linear_deflection(basis, start, times, case.length / 2)

    return run


def error(run: Run, step: float, reference: Callable[[Array], Array]) -> float:
    """Rms error over the samples, relative to the rms of the reference."""
    times, values = run(step, END)
    exact = reference(times)
    return float(sqrt(np.mean((values - exact) ** 2) / np.mean(exact**2))) if len(times) >= SAMPLES else float("nan")


def timed(entries: dict[str, tuple[Run, float]]) -> dict[str, float]:
    """Median seconds of one run of each, in rounds where all take turns; short runs are repeated in their turn."""
    jobs, repeats = [], []
    for run, step in entries.values():
        begin = perf_counter()
        run(step, END)
        repeats.append(max(1, int(TURN_S / (perf_counter() - begin))))

        def job(run: Run = run, step: float = step, times: int = repeats[-1]) -> None:
            for _ in range(times):
                run(step, END)

        jobs.append(job)
    medians = interleaved_medians(jobs, 12.0)
    return {name: median / times for name, median, times in zip(entries, medians, repeats, strict=True)}
