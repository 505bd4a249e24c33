"""Two races of the nonlinear chain against other engines, and what one evaluation costs over the number of links.

The paper's beam from rest for two milliseconds, forces sin and cos at 11.6 mm from both ends. Race 1: 0.1 N against
the exact linear chain. Race 2: 10 N against the converged nonlinear chain. Every engine takes its own longest step
for an rms error of 1e-3 at mid-span over 200 samples or more; models and modes are made beforehand; medians of rounds
in which all take turns of at least 20 ms.
Run: OMP_NUM_THREADS=1 python -m benchmarks.chain_races [links ...]       (needs the `peers` extra for the others)
"""

import sys
from collections.abc import Callable
from importlib import import_module
from math import log, sqrt
from time import perf_counter

import numpy as np
from scipy.linalg import eigh

from benchmarks.peers.case import Array, Case, Run, matrices
from verify.beam import Beam, PointForce
from verify.chain.dynamics import at_rest, flatten, workspace
from verify.chain.kernels import accelerate
from verify.chain.splitting import linear_deflection, modal_basis, simulate_modal
from verify.chain.stepping import simulate, step_limit
from verify.chain.system import ChainSystem, build_system
from verify.timing import interleaved_medians

END, SAMPLES, WANTED = 2e-3, 200, 1e-3
BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FREQUENCY = 4276.0
PEERS = {"MuJoCo": "mujoco_chain", "Pinocchio": "pinocchio_chain", "Exudyn": "exudyn_chain"}
TURN_S = 0.02
"""Shortest turn of a round."""
MODES = 60
"""Modes that take part in the nonlinear motion, where the chain has more: 15 kHz at 49 links, 33 kHz at 199."""


def case_of(n: int, amplitude: float) -> Case:
    """The paper's beam as a chain."""
    link, mass = BEAM.length / n, BEAM.mass_per_length * BEAM.length / n
    forces = ((0.0116, amplitude, -90.0), (BEAM.length - 0.0116, amplitude, 0.0))
    return Case(
        n=n,
        length=BEAM.length,
        mass=mass,
        inertia=mass * link**2 / 12,
        spring=BEAM.bending_stiffness / link,
        frequency_hz=FREQUENCY,
        forces=forces,
    )


def system_of(case: Case) -> ChainSystem:
    """The same for this suite."""
    forces = [PointForce(position=x, amplitude=a, phase_deg=p) for x, a, p in case.forces]
    return build_system(BEAM, case.n, forces, case.frequency_hz)


def exact_linear(case: Case, times: Array) -> Array:
    """Mid-span of the linear chain: dense matrices of joint positions, a sum over all modes, from rest."""
    n, link = case.n, case.link
    mass, stiffness = matrices(case)
    values, shapes = eigh(stiffness[1:-1, 1:-1], mass[1:-1, 1:-1])
    omega, drive = np.sqrt(values), 2 * np.pi * case.frequency_hz

    def lever(x: float) -> Array:
        i, at = case.place(x)
        row = np.zeros(n + 1)
        row[i], row[i + 1] = 1 - at / link, at / link
        return np.asarray(shapes.T @ row[1:-1])

    total = np.zeros(len(times))
    for x, amplitude, phase_deg in case.forces:
        phase = np.deg2rad(phase_deg)
        steady = lever(x) * lever(case.length / 2) * amplitude / (values - drive**2)
        start = np.cos(phase) * np.cos(np.outer(times, omega)) - drive / omega * np.sin(phase) * np.sin(
            np.outer(times, omega)
        )
        total += (np.cos(drive * times + phase)[:, None] - start) @ steady
    return total


def converged(case: Case, times: Array) -> Array:
    """Mid-span of the nonlinear chain by the adaptive integrator."""
    system = system_of(case)
    motion = simulate(system, at_rest(system), times, tolerance=1e-9 if case.n < 100 else 1e-7, ledger=False)
    return motion.deflection([case.length / 2])[:, 0]


def kicks(case: Case) -> Run:
    """Ours: exact linear flow and one nonlinear kick to a step."""
    system = system_of(case)
    basis, start = modal_basis(system), at_rest(system)
    modes = min(MODES, case.n - 1)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        motion = simulate_modal(basis, start, times, step=step, kicks=1, n_modes=modes)
        return motion.times, motion.deflection([case.length / 2])[:, 0]

    return run


def fixed_steps(case: Case) -> Run:
    """Ours: RK4 on the O(N) recursion."""
    system = system_of(case)
    start = at_rest(system)
    limit = step_limit(system, start)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        motion = simulate(system, start, times, method="rk4", step=step, ledger=False, limit=limit)
        return motion.times, motion.deflection([case.length / 2])[:, 0]

    return run


def linear_flow(case: Case) -> Run:
    """Ours: the exact linear flow, read at mid-span; no step."""
    system = system_of(case)
    basis, start = modal_basis(system), at_rest(system)

    def run(step: float, end: float) -> tuple[Array, Array]:
        times = np.linspace(end / SAMPLES, end, SAMPLES)
        return times, linear_deflection(basis, start, times, case.length / 2)

    return run


def runners(case: Case, race: int) -> dict[str, tuple[Run, float]]:
    """Engines and the first step to try, seconds; peers that are not installed are left out, and said."""
    limit = step_limit(system_of(case), at_rest(system_of(case)))
    found: dict[str, tuple[Run, float]] = {
        "ours, kicks": (kicks(case), 8e-5),
        "ours, RK4": (fixed_steps(case), 0.97 * limit),
    }
    if race == 1:
        found["ours, linear flow"] = linear_flow(case), END
    for name, module in PEERS.items():
        try:
            prepare: Callable[[Case], Run] = import_module(f"benchmarks.peers.{module}").prepare
            found[name] = prepare(case), 1.2e-6 if name == "Exudyn" else min(1.2e-5, 0.97 * limit)
        except ImportError:
            print(f"  {name} is not installed and left out")
    return found


def error(run: Run, step: float, reference: Callable[[Array], Array]) -> float:
    """Rms error over the samples, relative to the rms of the reference."""
    times, values = run(step, END)
    exact = reference(times)
    return float(sqrt(np.mean((values - exact) ** 2) / np.mean(exact**2))) if len(times) >= SAMPLES else float("nan")


def longest_step(run: Run, first: float, reference: Callable[[Array], Array]) -> tuple[float, float]:
    """The longest step of a ladder whose error is within the wanted one, and that error."""
    step = END / round(END / first)
    for _ in range(24):
        found = error(run, step, reference)
        if found <= WANTED:
            break
        step = END / max(round(END / (step / 1.15)), round(END / step) + 1)
    return step, found


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


def race(number: int, n: int) -> None:
    """One race at one size."""
    case = case_of(n, 0.1 if number == 1 else 10.0)
    times = np.linspace(END / 4000, END, 4000)
    dense = exact_linear(case, times) if number == 1 else converged(case, times)

    def reference(at: Array) -> Array:
        from scipy.interpolate import CubicSpline

        return np.asarray(CubicSpline(times, dense)(at))

    print(f"race {number}, N = {n}: {0.1 if number == 1 else 10.0:g} N")
    entries = runners(case, number)
    steps = {name: longest_step(run, first, reference) for name, (run, first) in entries.items()}
    ready = [name for name in entries if steps[name][1] <= WANTED]
    taken = timed({name: (entries[name][0], steps[name][0]) for name in ready})
    peers = [taken[name] for name in PEERS if name in taken]
    print(f"  {'engine':<20}{'step':>12}{'rms error':>12}{'per simulated ms':>20}{'fastest peer / this':>22}")
    for name in entries:
        step, found = steps[name]
        seconds = f"{taken[name] / END / 1e3 * 1e3:>17.3f} ms" if name in taken else f"{'not reached':>20}"
        ratio = f"{min(peers) / taken[name]:>22.1f}" if peers and name in taken else ""
        print(f"  {name:<20}{step * 1e6:>9.2f} us{found:>12.1e}{seconds}{ratio}", flush=True)


def evaluation_costs() -> None:
    """Time of one evaluation from 50 to 10000 links, and the exponent between them."""
    sizes, seconds = (50, 200, 1000, 5000, 10_000), []
    for n in sizes:
        system = system_of(case_of(n, 1.0))
        flat, work, out, still = flatten(system, ledger=False), workspace(system), np.zeros(n), np.zeros(n)
        best = float("inf")
        for _ in range(15):
            start = perf_counter()
            for _ in range(max(20_000 // n, 5)):
                accelerate(flat, 1e-6, still, still, work, out)
            best = min(best, (perf_counter() - start) / max(20_000 // n, 5))
        seconds.append(best)
        print(f"  N = {n:>6}: {best * 1e6:8.2f} us, {best / n * 1e9:6.1f} ns for each link")
    print(f"  exponent from 50 to 10000: {log(seconds[-1] / seconds[0]) / log(sizes[-1] / sizes[0]):.3f}")


def main(sizes: list[int]) -> None:
    """Both races at every size, then the cost of an evaluation."""
    for n in sizes:
        for number in (1, 2):
            race(number, n)
    print("one evaluation (called from Python, which adds about a microsecond):")
    evaluation_costs()


if __name__ == "__main__":
    main([int(word) for word in sys.argv[1:]] or [49, 199])
