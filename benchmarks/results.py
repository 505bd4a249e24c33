"""Dated results of the benches of all packaged scenes, or of those named, one page for each in docs/bench.

Run: python -m benchmarks.results [scene ...]
"""

import os
import sys

from verify.cli import status_of
from verify.scenes.scene import packaged_scenes

SECONDS = "40"
"""Of estimated work for each scene."""


def main(names: list[str]) -> int:
    """The number of scenes whose bench failed."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    failed = 0
    for name in names or packaged_scenes():
        print(f"== {name}", flush=True)
        failed += status_of(["bench", name, "--seconds", SECONDS, "--keep", "docs/bench"]) != 0
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
