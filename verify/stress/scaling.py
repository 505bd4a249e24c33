"""Checks of time and memory over the number of parts, by the exponent fitted to it.

Times are processor seconds. 1.25 allows a part to cost three times as much out of memory as out of a cache, over two
decades ln 3 / ln 100 = 0.24; 1.15 what a process needs beside.
"""

import subprocess
import sys
from collections.abc import Callable
from functools import cache
from time import process_time
from typing import Any

from msgspec.structs import replace

from verify.errors import InputError, one_line
from verify.linear.registry import MODELS
from verify.problem.beam import PointForce
from verify.stress.engine import check
from verify.stress.reference import CANTILEVER, DISCRETE, STRIP

SIZES = (5000, 15_000, 50_000)
_CHILD = """
from verify.linear.registry import MODELS
from verify.stress.reference import STRIP
peaks = []
for n in (300, *{sizes}):
    MODELS[{model!r}].build(STRIP, n).modes(3)
    with open("/proc/self/status") as status:
        peaks += [float(line.split()[1]) for line in status if line.startswith("VmHWM")]
print(*(peak - peaks[0] for peak in peaks[1:]))
"""


def seconds(run: Callable[[], Any]) -> float:
    """Processor time."""
    start = process_time()
    run()
    return process_time() - start


@check("time", "N", (1000, 3000, 10_000, 30_000), 1.25, DISCRETE, rounds=3)
def time(model: str, n: float) -> float:
    """Exponent of the time of three modes."""
    return seconds(lambda: MODELS[model].build(STRIP, int(n)).modes(3))


@check("time-field", "N", (5000, 15_000, 50_000, 150_000), 1.25, rounds=5)
def time_field(n: float) -> float:
    """Exponent of the time of a damped field of elements."""
    beam, force = replace(STRIP, loss_factor=0.01), (PointForce(position=0.3),)
    return seconds(lambda: MODELS["fem"].build(beam, int(n)).harmonic(force, 731.0).deflection([0.2]))


@check("time-chain", "N", (100, 300, 1000, 3000), 1.25, rounds=5)
def time_chain(n: float) -> float:
    """Exponent of the time of 100 accelerations of the nonlinear chain."""
    import numpy as np

    from verify.chain.rigid_links import accelerate, flatten
    from verify.chain.system import build_system

    model, y, out = flatten(build_system(CANTILEVER, int(n))), *np.zeros((2, 2 * int(n) + 2))
    accelerate(0.0, y, out, *model)
    return seconds(lambda: [accelerate(0.0, y, out, *model) for _ in range(100)])


@cache
def peaks(model: str) -> list[float]:
    """Memory of three modes of each of `SIZES` above that of 300 parts, in a process of its own."""
    command = [sys.executable, "-c", _CHILD.format(model=model, sizes=SIZES)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise InputError(f"memory: the process that measures it ended with {done.returncode}: {one_line(done.stderr)}")
    return list(map(float, done.stdout.split()))


@check("memory", "N", SIZES, 1.15, DISCRETE, rounds=1)
def memory(model: str, n: float) -> float:
    """Exponent of the memory of three modes."""
    return peaks(model)[SIZES.index(int(n))]
