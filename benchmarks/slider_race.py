"""The slider's race: the paper's chain with a slider on it, against other engines on the same chain.

0.1 N sin and cos at 11.6 mm from both ends, from rest, one millisecond, K = 1e4 s/m, mu = 0.2, m = 1 g. Every engine
takes its own longest step at which the slider's distance and speed at the end are within 1e-3 of its own converged
answer. Wall time for a simulated millisecond without set-up and compilation, medians of rounds in which all take
turns of at least 20 ms.

Two things the ratio does not say by itself, so that they stand in its row: this suite's loop is a linear one, modes
advanced by their exact step, where the others are nonlinear engines that could as well do large rotations; and its
set-up, modes and tables, takes several times as long as its loop, so that a single run is set-up above all.
Run: OMP_NUM_THREADS=1 python -m benchmarks.slider_race [links ...]      (others need the `peers` extra)
"""

import sys
from importlib import import_module, metadata
from statistics import median
from time import perf_counter

from benchmarks.chain_races import BEAM, FREQUENCY, case_of
from benchmarks.peers.slider import Run, Sled, reference
from verify.beam import PointForce
from verify.motion.simulate import simulate
from verify.slider import Slider

OWN = "verify, segments"
END, WANTED, ROUNDS, TURN_S = 1e-3, 1e-3, 9, 0.02
PEERS = {"MuJoCo": ("mujoco_slider", "mujoco"), "Exudyn": ("exudyn_slider", "exudyn")}
STEPS = (20e-6, 15e-6, 12.5e-6, 10e-6, 7e-6, 5e-6, 3.5e-6, 2.5e-6, 1.7e-6, 1.2e-6, 0.8e-6, 0.55e-6, 0.4e-6)


def own_run(n: int, model: str = "segment") -> Run:
    """The chain or the elements of this suite."""
    forces = [
        PointForce(position=0.0116, amplitude=0.1, phase_deg=-90.0),
        PointForce(position=BEAM.length - 0.0116, amplitude=0.1),
    ]
    sled = Sled()
    slider = Slider(mass=sled.mass, mu=sled.mu, slope=sled.slope, coupling="one-way")

    def run(step: float, end: float) -> tuple[float, float, float]:
        found = simulate(
            BEAM, forces, FREQUENCY, end, model=model, count=n, slider=slider, step=step, samples=2, ledger=False
        )
        return found.displacement, float(found.speed[-1]), found.statistics.wall_s

    return run


def set_up(n: int) -> float:
    """Seconds of modes and tables before the first step, the compiled loop loaded."""
    forces = [PointForce(position=0.0116, amplitude=0.1)]
    slider = Slider(mass=1e-3, mu=0.2, coupling="one-way")
    found = [simulate(BEAM, forces, FREQUENCY, END, count=n, slider=slider, samples=2, ledger=False) for _ in range(5)]
    return median(one.statistics.set_up_s for one in found)


def errors(found: tuple[float, float], true: tuple[float, float]) -> float:
    """The larger of the relative errors of distance and speed."""
    return max(abs(f / t - 1.0) for f, t in zip(found, true, strict=True))


def longest_step(run: Run, true: tuple[float, float], shortest: float = 0.5e-6) -> tuple[float, float] | None:
    """(step, error) of the longest step from which on all shorter ones tried are good enough, or None."""
    best = None
    for step in sorted(s for s in STEPS if s >= shortest):
        error = errors(run(step, END)[:2], true)
        if not error <= WANTED:
            break
        best = step, error
    return best


def engines(n: int) -> dict[str, tuple[Run, float, str]]:
    """Name -> (run, its step, what it is)."""
    case, sled, ready = case_of(n, 0.1), Sled(), {}
    run = own_run(n)
    found = longest_step(run, run(END / 51200, END)[:2])
    assert found is not None
    ready[OWN] = run, found[0], f"linear modal loop, step {1e6 * found[0]:.3g} us, error {found[1]:.1e}"
    true = reference(case, sled, END)
    for name, (module, package) in PEERS.items():
        try:
            prepare = import_module(f"benchmarks.peers.{module}").prepare
            version = metadata.version(package)
        except (ImportError, metadata.PackageNotFoundError):
            print(f"  {name}: not installed")
            continue
        begun = perf_counter()
        peer = prepare(case, sled)
        peer(20e-6, 20e-6)
        apart = f"set-up with one step {1e3 * (perf_counter() - begun):.2g} ms apart"
        found = longest_step(peer, true)
        if found is None:
            print(f"  {name} {version}: no step down to {1e6 * min(STEPS):.2g} us reaches {WANTED:g}")
            continue
        ready[name] = (
            peer,
            found[0],
            f"{version}, nonlinear engine, step {1e6 * found[0]:.3g} us, error {found[1]:.1e}, {apart}",
        )
        if name == "MuJoCo":
            bare = import_module(f"benchmarks.peers.{module}").prepare_bare(case, sled)
            ready["MuJoCo, bare"] = bare, found[0], "the same steps without the Python callback: no forces"
    return ready


def turn(run: Run, step: float) -> float:
    """Mean seconds of the runs of one turn, which lasts for at least TURN_S."""
    found = [run(step, END)[2]]
    while sum(found) < TURN_S:
        found.append(run(step, END)[2])
    return sum(found) / len(found)


def race(n: int) -> None:
    """One size: every engine at its own accuracy."""
    print(f"N = {n}")
    ready = engines(n)
    rounds: dict[str, list[float]] = {name: [] for name in ready}
    for _ in range(ROUNDS):
        for name, (run, step, _) in ready.items():
            rounds[name].append(turn(run, step))
    own, once = median(rounds[OWN]), set_up(n)
    for name, (_, _, note) in ready.items():
        seconds = median(rounds[name])
        once_in_words = f"set-up {1e3 * once:.2g} ms apart, {once / own:.1f} times the loop"
        both = once_in_words if name == OWN else f"{seconds / (own + once):.1f} x with this suite's set-up counted"
        print(f"  {name:17} {1e3 * seconds:9.4f} ms per ms   {seconds / own:7.1f} x   {note}; {both}")


def modal_path() -> None:
    """What a step costs over the number of links: the modes are advanced one by one."""
    print("one step of beam and slider over N")
    for n in (49, 98, 196, 392, 1000, 2000):
        run = own_run(n)
        run(2e-6, END)
        step = median(run(2e-6, END)[2] for _ in range(7)) / (END / 2e-6)
        print(f"  N = {n:4}  {1e6 * step:7.3f} us")


def loading() -> None:
    """Seconds to import and to load the compiled loop from its cache, in a process of its own."""
    from subprocess import check_output

    code = (
        "from time import perf_counter as t; b = t(); from verify.motion import friction_kernels as k; i = t();"
        "k.tanh_speed_change(0.1, 0.2, 1.0, 1.0, 0.1); print(i - b, t() - i)"
    )
    found = [[float(v) for v in check_output([sys.executable, "-c", code], text=True).split()] for _ in range(5)]
    imported, loaded = (median(column) for column in zip(*found, strict=True))
    print(f"numba imported in {imported:.2f} s, one kernel loaded from its cache in {loaded:.3f} s")


if __name__ == "__main__":
    for size in [int(text) for text in sys.argv[1:]] or [49, 99, 199]:
        race(size)
    modal_path()
    loading()
