"""Memory and time over size, with fitted exponents."""

from collections.abc import Callable
from functools import cache
from time import process_time
from typing import Literal

from verify.chain import warm
from verify.models.catalogue import MODELS
from verify.stress.kind import Growth, Row
from verify.stress.references.beams import STRIP, held

MODES = 3
NEARLY_LINEAR = 1.15
"""Of memory: in proportion, with room for what a process takes beside."""
BEYOND_CACHES = 1.25
"""Of time: in proportion, but that a part may cost three times as much out of memory as out of a cache, which over two
decades of size is ln 3 / ln 100 = 0.24 more. Processor seconds, the least of several rounds: neither does it count
who else uses the machine."""
HELD = (5000, 15_000, 50_000)
"""Parts of which memory is measured."""
_CHILD = """
from verify.models.catalogue import MODELS
from verify.stress.references.beams import STRIP
def peak():
    with open("/proc/self/status") as told:
        return next(int(line.split()[1]) / 1024.0 for line in told if line.startswith("VmHWM"))
solve = MODELS[{model!r}].solve_modes
solve(STRIP, {modes}, 300)
before = peak()
for n in {sizes}:
    solve(STRIP, {modes}, n)
    print(peak() - before)
"""


def seconds(model: str) -> Callable[[float], float]:
    """N -> processor seconds of three modes."""

    def cost(n: float) -> float:
        began = process_time()
        MODELS[model].solve_modes(STRIP, MODES, int(n))
        return process_time() - began

    return cost


def field_seconds(n: float) -> float:
    """Processor seconds of a damped field of so many elements, more than are kept for the next frequency."""
    from msgspec.structs import replace

    from verify.beam import PointForce

    began = process_time()
    beam = replace(STRIP, loss_factor=0.01)
    MODELS["fem"].solve_harmonic(beam, (PointForce(position=0.3),), 731.0, int(n)).deflection([0.2])
    return process_time() - began


def dense_seconds(model: Literal["segment", "fem"]) -> Callable[[float], float]:
    """The same by LAPACK on dense matrices."""

    def cost(n: float) -> float:
        from scipy.linalg import eigh

        from verify.stress.references.textbook import assembled

        began = process_time()
        stiffness, mass = (one.toarray() for one in assembled(model, STRIP.supports, int(n)))
        eigh(stiffness, mass, subset_by_index=(0, MODES - 1))
        return process_time() - began

    return cost


def megabytes(model: str) -> Callable[[float], float]:
    """N, one of HELD -> memory that three modes take at most, in a process of their own, less that of 300 parts."""
    return lambda n: _peaks(model)[HELD.index(int(n))]


@cache
def _peaks(model: str) -> tuple[float, ...]:
    """Megabytes of each size, ascending, so that each is the largest so far. Raises InputError where nobody tells."""
    import subprocess
    import sys
    from pathlib import Path

    from verify.errors import InputError, one_line

    if not Path("/proc/self/status").exists():
        raise InputError("memory: this system has no /proc/self/status, leave rows of memory out")
    code = _CHILD.format(model=model, modes=MODES, sizes=HELD)
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    if done.returncode:
        raise InputError(f"memory: the process that measures it ended with {done.returncode}: {one_line(done.stderr)}")
    return tuple(float(line) for line in done.stdout.split())


def dense_megabytes(model: str) -> Callable[[float], float]:
    """N -> what K, M and the vectors of so many parts take as dense matrices, 8 bytes an entry: not run, counted."""
    return lambda n: 3.0 * 8.0 * MODELS[model].unknowns(STRIP, int(n)) ** 2 / 2.0**20


def chain_seconds(n: float) -> float:
    """Processor seconds of accelerations of a nonlinear chain, a hundred times."""
    from verify.chain.dynamics import accelerated, at_rest
    from verify.chain.system import build_system

    system = build_system(held("clamped", "free"), int(n))
    state, answer = at_rest(system), accelerated(system)
    answer(0.0, state.angles, state.rates)
    began = process_time()
    for _ in range(100):
        answer(0.0, state.angles, state.rates)
    return process_time() - began


ROWS: tuple[Row, ...] = (
    *(
        Growth(
            id=f"{parts}-time",
            title=f"Time of three modes of {parts}",
            why="DESIGN: O(N) everywhere; the band of the mixed matrix has no fill-in that grows.",
            along=parts,
            at=(1000, 3000, 10_000, 30_000),
            promise=BEYOND_CACHES,
            unit="s",
            of="processor seconds",
            rounds=3,
            cost=seconds(model),
            beside=dense_seconds(model),  # type: ignore[arg-type]
            beside_at=(200, 400, 800) if model == "segment" else (100, 200, 400),
            textbook=f"LAPACK on dense matrices of {parts}",
            seconds=5.0,
        )
        for model, parts in (("segment", "segments"), ("fem", "elements"))
    ),
    Growth(
        id="field-time",
        title="Time of a damped field of elements",
        why="The same.",
        along="elements",
        at=(5000, 15_000, 50_000, 150_000),
        promise=BEYOND_CACHES,
        unit="s",
        of="processor seconds",
        rounds=5,
        cost=field_seconds,
        seconds=10.0,
        quick=False,
    ),
    Growth(
        id="chain-time",
        title="Time of a hundred accelerations of the nonlinear chain",
        why="chain/dynamics.py: O(N) by recursion; REFERENCE 7: 4.5 us at 199, 22 us at 999 links.",
        along="links",
        at=(100, 300, 1000, 3000),
        promise=BEYOND_CACHES,
        unit="s",
        of="processor seconds",
        rounds=5,
        cost=chain_seconds,
        seconds=4.0,
        kernels=warm.rigid,
    ),
    *(
        Growth(
            id=f"{parts}-memory",
            title=f"Memory of three modes of {parts}",
            why="models/eigen.py: bytes in proportion to the unknowns.",
            along=parts,
            at=HELD,
            promise=NEARLY_LINEAR,
            unit="MB",
            of="megabytes",
            cost=megabytes(model),
            beside=dense_megabytes(model),
            beside_at=(300, 1000, 3000),
            textbook=f"dense K, M and vectors of {parts}",
            seconds=5.0,
        )
        for model, parts in (("segment", "segments"), ("fem", "elements"))
    ),
)
