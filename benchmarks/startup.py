"""Start-up of the commands as ratios to a bare interpreter, medians of interleaved rounds.

Modules are compiled beforehand, as installing does: without bytecode on disk a start takes twice as long.

Run: python benchmarks/startup.py [rounds]
"""

import os
import subprocess
import sys
from statistics import median
from time import perf_counter

COMMANDS = {
    "bare interpreter": ["-c", "pass"],
    "verify --help": ["-m", "verify", "--help"],
    "closed-form figure": ["-m", "verify", "measure", "mode.frequency", "model=analytic", "mode=22"],
    "import numpy": ["-c", "import numpy"],
    "import skfem": ["-c", "import skfem"],
    "verify quantities": ["-m", "verify", "quantities"],
    "segment figure": ["-m", "verify", "measure", "mode.frequency", "model=segment", "mode=22", "count=49"],
    "fem figure": ["-m", "verify", "measure", "mode.frequency", "model=fem", "mode=22", "count=49"],
    "verify run paper": ["-m", "verify", "run", "paper", "--no-report"],
    "verify run paper-wave": ["-m", "verify", "run", "paper-wave", "--no-report"],
}


def seconds(arguments: list[str]) -> float:
    """Wall time of one fresh process."""
    start = perf_counter()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL, env=environment)
    return perf_counter() - start


def main(rounds: int) -> None:
    """Print each command's median time and the median of its ratio to the bare interpreter of the same round."""
    times = [{name: seconds(arguments) for name, arguments in COMMANDS.items()} for _ in range(rounds + 1)][1:]
    for name in COMMANDS:
        ratio = median(row[name] / row["bare interpreter"] for row in times)
        print(f"{name:<20} {median(row[name] for row in times) * 1e3:7.1f} ms   {ratio:5.1f} x")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
