"""Dated results of the benches of all packaged scenes, or of those named, one page for each in docs/bench.

Run: python -m benchmarks.results [scene ...]
"""

import os
import sys
from contextlib import suppress

from verify.bench.request import Bench
from verify.bench.sets import settled
from verify.cli import status_of
from verify.errors import InputError
from verify.scenes.scene import load_scene, packaged_scenes

SECONDS = "40"
"""Of estimated work for each scene."""


def main(names: list[str]) -> int:
    """The number of scenes whose bench failed."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    failed = 0
    for name in names or _with_a_bench():
        print(f"== {name}", flush=True)
        failed += status_of(["bench", name, "--seconds", SECONDS, "--keep", "docs/bench"]) != 0
    return failed


def _with_a_bench() -> list[str]:
    """Packaged scenes that a bench takes: none whose drive has devices."""
    found = []
    for name in packaged_scenes():
        with suppress(InputError):
            settled(Bench(), load_scene(name))
            found.append(name)
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
