"""Time of every packaged scene, with an empty folder of compiled kernels and warm, in processes of their own.

    python -m benchmarks.scenes [ROUNDS [SCENE ...]]

Processor seconds and least wall time, medians over ROUNDS (3) that take turns.
"""

import os
import resource
import subprocess
import sys
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from verify.report.summary import environment
from verify.scene.file import packaged_scenes


def seconds(scene: str, kernels: str) -> tuple[float, float]:
    """(processor seconds, wall time) of one run whose compiled kernels are kept in a folder."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), perf_counter()
    words = [sys.executable, "-m", "verify", "run", scene, "--no-report", "--json"]
    subprocess.run(words, env=os.environ | {"NUMBA_CACHE_DIR": kernels}, stdout=subprocess.DEVNULL, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, perf_counter() - start


def main(rounds: int, scenes: list[str]) -> None:
    """Print the table."""
    cold: dict[str, tuple[float, float]] = {}
    warm: dict[str, list[tuple[float, float]]] = {scene: [] for scene in scenes}
    with TemporaryDirectory() as folder:
        for scene in scenes:
            with TemporaryDirectory() as empty:
                cold[scene] = seconds(scene, empty)
            seconds(scene, folder)
        for _ in range(rounds):
            for scene in scenes:
                warm[scene].append(seconds(scene, folder))
    print(", ".join(environment().values()), f", load {os.getloadavg()[0]:.1f}\n")
    print("| scene | cold, processor s | warm, processor s | cold, wall s | warm, wall s |\n|---|---|---|---|---|")
    for scene, times in warm.items():
        cells = cold[scene][0], median(t for t, _ in times), cold[scene][1], min(wall for _, wall in times)
        print(f"| {scene} |", " | ".join(f"{value:.2f}" for value in cells), "|")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3, sys.argv[2:] or list(packaged_scenes()))
