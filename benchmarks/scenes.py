"""How long every packaged scene takes: with nothing compiled yet, and warm.

    python -m benchmarks.scenes [ROUNDS [SCENE ...]]

Each run is a process of its own without a report. Cold: an empty folder for what numba compiles; two runs. Warm: ROUNDS
(3) in turns. Medians of seconds of the processor, which a busy machine does not stretch as it does the clock's; beside
them the least by the clock, and by how much a first run is longer: what compilation costs whoever waits for it.
"""

import os
import platform
import resource
import subprocess
import sys
from datetime import date
from importlib import metadata
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from verify.scenes.scene import packaged_scenes

COLD_ROUNDS = 2
COLUMNS = ("cold, processor s", "warm, processor s", "cold, by the clock, s", "warm, by the clock, s", "longer by, s")
PACKAGES = ("numpy", "scipy", "scikit-fem", "numba")


def spent() -> float:
    """Processor seconds of all processes that have ended below this one."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def timed(words: list[str], **environment: str) -> tuple[float, float]:
    """(processor seconds, seconds by the clock) of a process."""
    before, begun = spent(), perf_counter()
    subprocess.run(words, env=os.environ | environment, stdout=subprocess.DEVNULL, check=True)
    return spent() - before, perf_counter() - begun


def ran(scene: str, compiled: str) -> tuple[float, float]:
    """The same of a scene that keeps its kernels in a folder."""
    words = [sys.executable, "-m", "verify", "run", scene, "--no-report", "--json"]
    return timed(words, NUMBA_CACHE_DIR=compiled, OPENBLAS_NUM_THREADS="1")


def measured(scenes: tuple[str, ...], rounds: int) -> dict[str, tuple[float, ...]]:
    """Median processor seconds and least by the clock, cold and warm, and how much longer cold is by the clock."""
    cold: dict[str, list[tuple[float, float]]] = {scene: [] for scene in scenes}
    warm: dict[str, list[tuple[float, float]]] = {scene: [] for scene in scenes}
    with TemporaryDirectory() as folder:
        for _ in range(COLD_ROUNDS):
            for scene in scenes:
                with TemporaryDirectory() as empty:
                    cold[scene].append(ran(scene, empty))
        for scene in scenes:
            ran(scene, folder)
        for _ in range(rounds):
            for scene in scenes:
                warm[scene].append(ran(scene, folder))
    return {scene: told(cold[scene], warm[scene]) for scene in scenes}


def told(cold: list[tuple[float, float]], warm: list[tuple[float, float]]) -> tuple[float, ...]:
    """The columns of a scene."""
    by_clock = [min(clock for _, clock in times) for times in (cold, warm)]
    by_processor = [median(cpu for cpu, _ in times) for times in (cold, warm)]
    return by_processor[0], by_processor[1], by_clock[0], by_clock[1], by_clock[0] - by_clock[1]


def processor() -> str:
    """Its name, where the system tells it."""
    lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines() if Path("/proc/cpuinfo").exists() else []
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown")


def main() -> None:
    """Print the table, with the machine."""
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in PACKAGES)
    print(f"{date.today()}: {processor()}, {os.cpu_count()} cores, Python {platform.python_version()}, {versions};")
    idle = median(timed([sys.executable, "-c", ""])[0] for _ in range(9))
    print(
        f"medians of {rounds} in turns; a bare interpreter takes {1e3 * idle:.0f} ms; load {os.getloadavg()[0]:.1f}.\n"
    )
    print(f"| scene | {' | '.join(COLUMNS)} |\n|{'---|' * (len(COLUMNS) + 1)}")
    for scene, times in measured(tuple(sys.argv[2:]) or packaged_scenes(), rounds).items():
        print(f"| {scene} |", " | ".join(f"{seconds:.2f}" for seconds in times), "|", flush=True)


if __name__ == "__main__":
    main()
