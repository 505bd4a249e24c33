"""How long every packaged scene takes: with nothing compiled yet, and warm.

    python -m benchmarks.scenes [ROUNDS]

Each run is a process of its own without a report. Cold: an empty folder for what numba compiles; one run. Warm: the
median of ROUNDS (3) in turns, and the least. Beside them a bare interpreter, and what `verify run` says it took itself.
"""

import json
import os
import platform
import subprocess
import sys
from datetime import date
from importlib import metadata
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from verify.scenes.scene import packaged_scenes

PACKAGES = ("numpy", "scipy", "scikit-fem", "numba")


def ran(scene: str, compiled: str) -> tuple[float, float]:
    """(seconds of the whole process, of the run in it) of a scene that keeps its kernels in a folder."""
    env = os.environ | {"NUMBA_CACHE_DIR": compiled, "OPENBLAS_NUM_THREADS": "1"}
    words = [sys.executable, "-m", "verify", "run", scene, "--no-report", "--json"]
    begun = perf_counter()
    done = subprocess.run(words, env=env, capture_output=True, text=True, check=True)
    return perf_counter() - begun, json.loads(done.stdout)["seconds"]


def bare() -> float:
    """Seconds of an interpreter that does nothing."""
    begun = perf_counter()
    subprocess.run([sys.executable, "-c", ""], check=True)
    return perf_counter() - begun


def measured(scenes: tuple[str, ...], rounds: int) -> list[tuple[str, float, float, float, float]]:
    """(scene, cold, median and least of the warm ones, median of the run inside), seconds."""
    cold, warm = {}, {scene: [] for scene in scenes}
    with TemporaryDirectory() as folder:
        for scene in scenes:
            with TemporaryDirectory() as empty:
                cold[scene] = ran(scene, empty)[0]
            ran(scene, folder)
        for _ in range(rounds):
            for scene in scenes:
                warm[scene].append(ran(scene, folder))
    return [
        (scene, cold[scene], median(t for t, _ in times), min(t for t, _ in times), median(own for _, own in times))
        for scene, times in warm.items()
    ]


def processor() -> str:
    """Its name, where the system tells it."""
    lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines() if Path("/proc/cpuinfo").exists() else []
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown")


def main() -> None:
    """Print the table, with the machine."""
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in PACKAGES)
    print(f"{date.today()}: {processor()}, {os.cpu_count()} cores, Python {platform.python_version()}, {versions};")
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0
    print(f"medians of {rounds} in turns; a bare interpreter {1e3 * median(bare() for _ in range(9)):.0f} ms;")
    print(f"load before the first run {load:.1f}\n")
    print("| scene | cold, s | warm, s | least, s | of that the run itself, s |")
    print("|---|---|---|---|---|")
    for scene, *times in measured(packaged_scenes(), rounds):
        print(f"| {scene} |", " | ".join(f"{seconds:.2f}" for seconds in times), "|", flush=True)


if __name__ == "__main__":
    main()
