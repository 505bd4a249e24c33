"""Checks of time and memory over the number of parts, by the exponent fitted to it.

Times are processor seconds. 1.25 allows a part to cost three times as much out of memory as out of a cache, over two
decades ln 3 / ln 100 = 0.24; 1.15 what a process needs beside.
"""

import subprocess
import sys
from functools import cache
from time import process_time

from msgspec.structs import replace

from verify.errors import InputError, one_line
from verify.linear.registry import MODELS
from verify.problem.beam import PointForce
from verify.stress.engine import check
from verify.stress.reference import CANTILEVER, STRIP

DISCRETE = {"segment": "segments", "fem": "elements"}
MODES = 3
SIZES = (5000, 15_000, 50_000)
_CHILD = """
from verify.linear.registry import MODELS
from verify.stress.reference import STRIP
peaks = []
for n in (300, *{sizes}):
    MODELS[{model!r}].build(STRIP, n).modes({modes})
    with open("/proc/self/status") as status:
        peaks += [float(line.split()[1]) / 1024.0 for line in status if line.startswith("VmHWM")]
print(*(peak - peaks[0] for peak in peaks[1:]))
"""


@check("time", "N", (1000, 3000, 10_000, 30_000), 1.25, models=DISCRETE, rounds=3)
def time(model: str, n: float) -> float:
    """Exponent of the time of three modes."""
    start = process_time()
    MODELS[model].build(STRIP, int(n)).modes(MODES)
    return process_time() - start


@check("time-field", "N", (5000, 15_000, 50_000, 150_000), 1.25, rounds=5)
def time_field(n: float) -> float:
    """Exponent of the time of a damped field of elements."""
    start = process_time()
    force = (PointForce(position=0.3),)
    MODELS["fem"].build(replace(STRIP, loss_factor=0.01), int(n)).harmonic(force, 731.0).deflection([0.2])
    return process_time() - start


@check("time-chain", "N", (100, 300, 1000, 3000), 1.25, rounds=5)
def time_chain(n: float) -> float:
    """Exponent of the time of 100 accelerations of the nonlinear chain."""
    import numpy as np

    from verify.chain.rigid_links import accelerate, flatten
    from verify.chain.system import build_system

    model, y, out = flatten(build_system(CANTILEVER, int(n))), *np.zeros((2, 2 * int(n) + 2))
    start = process_time()
    for _ in range(100):
        accelerate(0.0, y, out, *model)
    return process_time() - start


@cache
def peaks(model: str) -> tuple[float, ...]:
    """Memory of three modes of each of `SIZES` above that of 300 parts, MB, in a process of its own."""
    code = _CHILD.format(model=model, modes=MODES, sizes=SIZES)
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    if done.returncode:
        raise InputError(f"memory: the process that measures it ended with {done.returncode}: {one_line(done.stderr)}")
    return tuple(map(float, done.stdout.split()))


@check("memory", "N", SIZES, 1.15, models=DISCRETE, rounds=1)
def memory(model: str, n: float) -> float:
    """Exponent of the memory of three modes."""
    return peaks(model)[SIZES.index(int(n))]
