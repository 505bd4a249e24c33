"""The paper's beam as a chain in Exudyn, MuJoCo and Pinocchio beside this suite: modes, transients, a slider, breaking.

Forces sin and cos at 11.6 mm from both ends, from rest (the cosine is a step load), one millisecond; a slider of 1 g
with K = 1e4 s/m and mu = 0.2, one-way, starts at mid-span. Every engine takes its own longest step for a relative rms
error over its samples of 1e-3 and of 1e-5: mid-span against the exact linear chain (above 0.3 N against the converged
nonlinear one), the slider's distance and speed against a slider on the exact linear chain; this suite's own slider
reads its own spline, and is compared with itself converged. An explicit engine starts at 0.99 of its stability limit.
Times are of the steps alone, for a simulated millisecond: processor time (all have one thread; other work on the
machine does not lengthen it), of this suite's slider the least wall time of a turn; medians of rounds in which all take
turns of at least 20 ms, long runs by their first part. Set-up stands apart, in wall time, the least of a ladder's runs.

Two things a ratio does not say by itself: this suite's slider loop and its linear flow are linear, modes advanced by
their exact step, where the others are nonlinear engines that could as well do large rotations; and set-up counts for a
single run.
Run: OMP_NUM_THREADS=1 python -m benchmarks.peers [--force N] [links ...]      (the `peers` extra brings the others;
what it prints is Markdown, for `docs/bench/peers.md`)
"""

import argparse
import platform
from collections.abc import Callable
from datetime import date
from functools import cache
from importlib.metadata import version
from math import isnan
from os import cpu_count
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import NamedTuple

import numpy as np

from benchmarks.chains import BEAM, FREQUENCY, Run, case_of, converged, fixed_steps, forces_of, kicks, linear_flow
from verify import segment_model
from verify.models.arrays import Array
from verify.motion.simulate import simulate
from verify.peers import references
from verify.peers.breaking import IMPLICIT, pushed
from verify.peers.case import Case, PeerRun, clocks, since, sled_of
from verify.peers.catalogue import PEERS, PeerAdapter, Prepared, adapter, installed, missing
from verify.peers.ladder import Rung, deflection_error, longest_step, ride_error
from verify.slider import Slider

END = 1e-3
WANTED = (1e-3, 1e-5)
ROUNDS, TURN_S, LONGEST_TURN_S = 7, 0.02, 0.5
PATIENCE_S = 120.0
NEAR_LIMIT = 0.99
MODES = 22
LINEAR_N = 0.3
"""Force up to which the linear chain is the reference, to 1e-5."""
SLIDER = Slider(mass=1e-3, mu=0.2, slope=1e4, coupling="one-way")
NONE = np.zeros(0)


class Entry(NamedTuple):
    """Somebody who takes part in a race."""

    run: Prepared
    first: float
    error: Callable[[PeerRun], float]


class Found(NamedTuple):
    """One row: at which step, and how far off."""

    name: str
    wanted: float
    rung: Rung
    set_up_s: float


def own(run: Run) -> Prepared:
    """One of this suite's integrators as a peer's run."""

    def timed(step: float, end: float) -> PeerRun:
        begun = clocks()
        times, values = run(step, end)
        seconds, cpu_s = since(begun)
        return PeerRun(
            times=times, deflection=values, distance=NONE, speed=NONE, seconds=seconds, cpu_s=cpu_s, set_up_s=0.0,
            steps=round(end / step), broke="" if len(times) else "nothing was kept",
        )  # fmt: skip

    return timed


def own_slider(n: int, force: float, samples: int = 200) -> Prepared:
    """Linear segments with a slider; set-up is part of every call, and told apart."""

    def run(step: float, end: float) -> PeerRun:
        kept = min(max(round(end / step), 1), samples) + 1
        found = simulate(
            BEAM, forces_of(force), FREQUENCY, end, count=n, slider=SLIDER, step=step, samples=kept, ledger=False
        )
        return PeerRun(
            times=found.times, deflection=NONE, distance=found.travelled, speed=found.speed,
            seconds=found.statistics.wall_s, set_up_s=found.statistics.set_up_s, steps=found.statistics.steps,
        )  # fmt: skip

    return run


def here() -> dict[str, PeerAdapter]:
    """The engines that are installed; the others are named."""
    for peer in PEERS.values():
        if why := missing(peer):
            print(f"{peer.name} is left out: {why}")
    return {peer.name: adapter(peer) for peer in PEERS.values() if installed(peer)}


def first_step(name: str, case: Case) -> float:
    """Where a ladder begins."""
    return 2.4e-6 if name in IMPLICIT else min(2e-5, NEAR_LIMIT * references.explicit_limit(case))


def transients(case: Case, engines: dict[str, PeerAdapter]) -> dict[str, Entry]:
    """Everybody without a slider."""
    small = max(abs(force.amplitude) for force in case.forces) <= LINEAR_N
    exact: Callable[[Array], Array] = lambda times: references.deflection(case, times)  # noqa: E731
    if not small:
        from scipy.interpolate import CubicSpline

        dense = np.linspace(END / 4000, END, 4000)
        exact = CubicSpline(dense, converged(case, dense))
    limit = references.explicit_limit(case)
    ours = {"verify, linear flow": (linear_flow(case), END)} if small else {}
    ours |= {"verify, kicks": (kicks(case), 2.5e-4), "verify, RK4": (fixed_steps(case), 0.97 * limit)}
    error = lambda run: deflection_error(run, exact)  # noqa: E731
    entries = {name: Entry(own(run), first, error) for name, (run, first) in ours.items()}
    return entries | {
        name: Entry(engine.prepare(case, None), first_step(name, case), error) for name, engine in engines.items()
    }


def sliders(case: Case, force: float, engines: dict[str, PeerAdapter]) -> dict[str, Entry]:
    """Everybody with one."""
    sled = sled_of(BEAM, SLIDER)
    exact = references.ride(case, sled, END)
    ours = own_slider(case.n, force)
    dense = own_slider(case.n, force, 12_800)(END / 51_200, END)
    true = references.Ride(times=dense.times, distance=dense.distance, speed=dense.speed)
    entries = {"verify, segments": Entry(ours, 2e-5, lambda run: ride_error(run, true.at))}
    return entries | {
        name: Entry(engine.prepare(case, sled), first_step(name, case), lambda run: ride_error(run, exact.at))
        for name, engine in engines.items()
    }


def ladders(entries: dict[str, Entry]) -> list[Found]:
    """The steps of everybody for each wanted error; a step once run is not run again."""
    found = []
    for name, entry in entries.items():
        set_up: list[float] = []

        @cache
        def run(step: float, entry: Entry = entry, set_up: list[float] = set_up) -> tuple[float, float]:
            got = entry.run(step, END)
            set_up.append(got.set_up_s)
            return entry.error(got), got.seconds if isnan(got.cpu_s) else got.cpu_s

        first = entry.first
        for wanted in WANTED:
            rung = longest_step(run, first, wanted, lambda got: got[0], patience=PATIENCE_S, clock=lambda got: got[1])
            found.append(Found(name, wanted, rung, min(set_up)))
            first = rung.step if rung.reached else first
    return found


def turn(run: Prepared, step: float, per_second: float) -> float:
    """Seconds for a simulated second in a turn of at least TURN_S, by a first part where that is long.

    The median run's processor time; where that was not taken the least wall time, which other work lengthens at will.
    """
    end, begun, taken = min(END, max(10.0 * step, LONGEST_TURN_S / per_second)), perf_counter(), []
    while not taken or perf_counter() - begun < TURN_S:
        found = run(step, end)
        taken.append(found)
    if isnan(taken[0].cpu_s):
        return min(run.seconds for run in taken) / end
    return median(run.cpu_s for run in taken) / end


def race(title: str, n: int, entries: dict[str, Entry], beside: dict[str, tuple[str, Prepared]]) -> None:
    """Ladders, then interleaved times; `beside` are runs at the step of another, (whose, run)."""
    found = ladders(entries)
    jobs = {(row.name, row.wanted): (entries[row.name].run, row.rung.step) for row in found if row.rung.reached}
    for name, (whose, run) in beside.items():
        jobs |= {(name, wanted): (run, step) for (at, wanted), (_, step) in tuple(jobs.items()) if at == whose}
    rough = {key: run(step, min(END, 20.0 * step)).seconds / min(END, 20.0 * step) for key, (run, step) in jobs.items()}
    rounds: dict[tuple[str, float], list[float]] = {key: [] for key in jobs}
    for _ in range(ROUNDS):
        for key, (run, step) in jobs.items():
            rounds[key].append(turn(run, step, rough[key]))
    taken = {key: median(times) for key, times in rounds.items()}
    ours = [name for name in entries if name.startswith("verify")]
    over = [f"over {name.removeprefix('verify, ')}" for name in ours]
    head(f"{title}, N = {n}", "wanted", "step, us", "error", "ms per ms", *over, "set-up, ms")
    rows = {(row.name, row.wanted): row for row in found}
    for wanted in WANTED:
        for name in [*entries, *beside]:
            row = rows.get((name, wanted))
            if row is not None and not row.rung.reached:
                why = f"not reached: {row.rung.why_not}; least error {row.rung.error:.1e}"
                line(name, f"{wanted:g}", why, *[""] * (len(ours) + 3))
            elif (name, wanted) in taken:
                ratios = [
                    short(taken[name, wanted] / taken[one, wanted]) if (one, wanted) in taken else "" for one in ours
                ]
                step, took = short(1e6 * jobs[name, wanted][1]), short(taken[name, wanted])
                error = f"{row.rung.error:.1e}" if row else "no forces"
                line(name, f"{wanted:g}", step, error, took, *ratios, short(1e3 * row.set_up_s) if row else "")


def short(value: float) -> str:
    """Three digits; nothing for 0."""
    return f"{float(f'{value:.3g}'):g}" if value else ""


def line(*cells: str) -> None:
    """One row."""
    print("|", " | ".join(cells), "|", flush=True)


def head(*cells: str) -> None:
    """The first row, and the line below it."""
    print()
    line(*cells)
    line(*["---"] * len(cells))


def modes(case: Case, engines: dict[str, PeerAdapter]) -> None:
    """Errors of natural frequencies against the closed form of the chain, and what they take."""
    exact = references.frequencies(case)
    some = min(MODES, len(exact))
    verbs: dict[str, Callable[[], Array | None]] = {
        f"verify, first {some}": lambda: segment_model.solve_modes(BEAM, some, n_segments=case.n).frequencies_hz
    }
    verbs |= {name: lambda engine=engine: engine.frequencies(case) for name, engine in engines.items()}  # type: ignore[misc]
    found = {name: verb() for name, verb in verbs.items()}
    rounds: dict[str, list[float]] = {name: [] for name in verbs}
    for _ in range(3 if case.n > 200 else 5):
        for name, verb in verbs.items():
            begun = clocks()
            verb()
            rounds[name].append(since(begun)[1])
    base = median(rounds[f"verify, first {some}"])
    head(f"modes, N = {case.n}", f"error, 1 to {some}", "of all", "ms", "over verify")
    for name, values in found.items():
        if values is None:
            line(name, "has none", "", "", "")
            continue
        off = np.abs(values / exact[: len(values)] - 1.0)
        every = f"{off.max():.1e}" if len(values) == len(exact) else ""
        seconds = median(rounds[name])
        line(name, f"{off[:some].max():.1e}", every, short(1e3 * seconds), short(seconds / base))


def breaking(case: Case, engines: dict[str, PeerAdapter]) -> None:
    """What each does beyond what it bears."""
    head(f"pushed, N = {case.n}", "by", "what it did", "good steps", "last sample, ms of 1", "wall time, s")
    for name in engines:
        row = pushed(name, case, END)
        line(name, row.pushed, row.did or "did not break", str(row.steps), short(1e3 * row.until), short(row.seconds))


def machine() -> str:
    """Processor, cores, versions, date."""
    info = Path("/proc/cpuinfo")
    names = [line.partition(":")[2].strip() for line in info.read_text().splitlines() if line.startswith("model name")]
    versions = [f"{name} {version(name)}" for name in ("numpy", "scipy", "numba")]
    versions += [f"{peer.name} {found}" for peer in PEERS.values() if (found := installed(peer))]
    return (
        f"{names[0] if names else platform.processor()}, {cpu_count()} cores; Python {platform.python_version()}, "
        f"{', '.join(versions)}; {date.today().isoformat()}"
    )


def main() -> None:
    """All tables at every size."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("links", type=int, nargs="*", default=[49, 99, 199, 399])
    parser.add_argument(
        "--force", type=float, default=0.1, help="newton; above 0.3 the nonlinear chain is the reference"
    )
    given = parser.parse_args()
    print(machine())
    engines = here()
    for n in given.links:
        case = case_of(n, given.force)
        print(f"\n### N = {n}, {given.force:g} N")
        if given.force <= LINEAR_N:
            modes(case, engines)
        race("transient", n, transients(case, engines), {})
        if given.force <= LINEAR_N:
            bare = {}
            if "MuJoCo" in engines:
                from verify.peers.mujoco import Mujoco

                bare = {"MuJoCo, not called back": ("MuJoCo", Mujoco().bare(case, sled_of(BEAM, SLIDER)))}
            race("slider", n, sliders(case, given.force, engines), bare)
        breaking(case, engines)


if __name__ == "__main__":
    main()
