"""Rounding error and run time of the eigenvalues of both models, from 10^2 to 10^5 parts.

Errors are bounds counted in 50-digit arithmetic against the model itself; time is one solve for 50 modes, and its
ratio to one sparse factorisation of the mixed matrix.
Run: OMP_NUM_THREADS=1 python benchmarks/eigenvalues.py [largest count]
"""

import sys
from collections.abc import Callable
from statistics import median
from time import perf_counter

from scipy.sparse.linalg import splu

from verify.beam import Beam
from verify.elements import linear as fem_beam
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.judge.extended_precision import eigenvalue_error
from verify.models import pencil
from verify.segments import linear as segment_model

SUPPORTS = (("pinned", "pinned"), ("clamped", "clamped"), ("clamped", "free"), ("free", "free"))
MODELS = {"segment": segment_model, "fem": fem_beam}
MODES = (1, 2, 7, 23, 50)


def pencil_of(model: str, beam: Beam, count: int) -> pencil.FactoredPencil:
    """The factored pencil that a model solves."""
    if model == "segment":
        return segment_model.chain_pencil(segment_model.build_chain(beam, count))
    return element_pencil(build_elements(beam, count))


def times(*jobs: Callable[[], object], rounds: int) -> list[float]:
    """Median seconds of jobs that take turns."""
    measured: list[list[float]] = [[] for _ in jobs]
    for _ in range(rounds):
        for job, seconds in zip(jobs, measured, strict=True):
            start = perf_counter()
            job()
            seconds.append(perf_counter() - start)
    return [median(seconds) for seconds in measured]


def row(beam: Beam, model: str, count: int) -> str:
    """One row of the table."""
    module = MODELS[model]
    modes = module.solve_modes(beam, 50, count)
    bounds = [eigenvalue_error(beam, model, count, n, float(modes.frequencies_hz[n - 1])) for n in MODES]
    matrix, _ = pencil.mixed_matrix(pencil_of(model, beam, count))
    solve, factor = times(
        lambda: module.solve_modes(beam, 50, count), lambda: splu(matrix), rounds=7 if count <= 10_000 else 2
    )
    name = "-".join(beam.supports)
    return f"{count:>7} {name:<16} {model:<8} {max(bounds):>18.0e} {solve:>8.3f}s {solve / factor:>16.1f}"


def main(largest: int) -> None:
    """Print one row for each size, support pair and model."""
    print(f"{'N':>7} {'supports':<16} {'model':<8} {'worst error bound':>18} {'time':>9} {'/ factorisation':>16}")
    count = 100
    while count <= largest:
        for supports in SUPPORTS:
            beam = Beam(length=0.6, width=0.02, thickness=0.002, youngs_modulus=70e9, density=2700.0, supports=supports)
            for model in MODELS:
                print(row(beam, model, count), flush=True)
        count *= 10


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
