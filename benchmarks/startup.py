"""Start-up time of the commands over that of a bare interpreter, medians of interleaved rounds.

python -m benchmarks.startup [ROUNDS]
"""

import subprocess
import sys
from statistics import median
from time import perf_counter

COMMANDS = {
    "bare interpreter": ["-c", "pass"],
    "import numpy": ["-c", "import numpy"],
    "import skfem": ["-c", "import skfem"],
    "verify --help": ["-m", "verify", "--help"],
    "verify quantities": ["-m", "verify", "quantities"],
    **{
        f"verify measure, {model}": [
            "-m",
            "verify",
            "measure",
            "paper",
            "mode.frequency",
            f"model={model}",
            "mode=22",
            *count,
        ]
        for model, count in (("analytic", []), ("segment", ["count=49"]), ("fem", ["count=49"]))
    },
    "verify run paper": ["-m", "verify", "run", "paper", "--no-report"],
    "verify run paper-wave": ["-m", "verify", "run", "paper-wave", "--no-report"],
}


def seconds(arguments: list[str]) -> float:
    """Wall time of a fresh process."""
    start = perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def main(rounds: int) -> None:
    """Print median times and ratios."""
    times = [{name: seconds(words) for name, words in COMMANDS.items()} for _ in range(rounds + 1)][1:]
    for name in COMMANDS:
        ratio = median(row[name] / row["bare interpreter"] for row in times)
        print(f"{name:<26} {median(row[name] for row in times) * 1e3:7.1f} ms   {ratio:5.1f} x")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 15)
