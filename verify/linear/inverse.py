"""The inverse of a pencil, K - below M, through the sparse factors of its mixed matrix, rigid motions taken out.

A motion so slow that it hardly bends the beam - a bar on foam, on long springs - has next to no stiffness: in the
inverse of K it is so large that its rounding drowns what bends. Of K + slow M, slow being of the order of what bends
the beam first, all modes are the same and none is large.
"""

from functools import lru_cache
from math import inf, pi
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, Indices
from verify.errors import InputError
from verify.linear.pencil import DENSE_UNKNOWNS, LARGE, FactoredPencil, factorised, mixed_matrix, soft_scales, swing

SLOW = 0.01
"""Of `first_bending`: an eigenvalue below it is of a motion that hardly bends the beam."""

REFINED = 12
"""Solutions of one load at most."""
STILL = 1e-7
"""Of the largest force: a step after which there is none."""


class Inverse(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What answers loads with K - below M."""

    pencil: FactoredPencil
    below: float
    factor: Any
    free: Indices
    """Unknowns that are not grounded."""
    scales: Array
    """Of forces (m,) in the mixed matrix."""
    unit: float
    """Of the unknowns in it."""
    mass: Any
    inertia: Array
    """M R, (n, r)."""
    motions: Array
    """R (R^T M R)^-1, (n, r)."""
    rough: bool = False
    """Whether the lowest mode is so low that others lose digits to it."""

    @property
    def many(self) -> bool:
        """Whether unknowns are so many that vectors are polished."""
        return self.pencil.n * (4 if self.rough or self.below < 0.0 else 1) >= LARGE

    @property
    def n_strains(self) -> int:
        """How many forces come before the unknowns."""
        return len(self.pencil.stiffness)

    def balanced(self, load: Array) -> Array:
        """A load (n,) less what moves rigid motions."""
        return np.asarray(load - self.inertia @ (self.motions.T @ load))

    def still(self, answer: Array) -> Array:
        """An answer (n,) less its rigid motions."""
        return np.asarray(answer - self.motions @ (self.inertia.T @ answer))

    def answered(self, right: Array) -> Array:
        """(forces (m,), unknowns) of the mixed matrix to what stands on its right."""
        scales = self.scales
        right[: len(scales)] *= scales / self.unit
        found = self.factor.solve(right)
        found[: len(scales)] *= scales
        found[len(scales) :] *= self.unit
        return np.asarray(found)

    def solve(self, load: Array) -> Array:
        """The answer to a load, (n,) both."""
        right, answer = np.zeros(self.n_strains + len(self.free)), np.zeros(self.pencil.n)
        right[self.n_strains :] = self.balanced(load)[self.free]
        answer[self.free] = self.unit * self.factor.solve(right)[self.n_strains :]
        return self.still(answer)

    def refined(self, load: Array) -> tuple[Array, Array]:
        """(forces in the strains (m,), answer (n,)) to a load (n,), by residuals of differences of differences.

        Once at the least, and until a step is small: where factors lose digits, each gives some back.
        """
        m, pencil, free = self.n_strains, self.pencil, self.free
        transposed = pencil.transposed()[free]
        load, found, answer = self.balanced(load)[free], np.zeros(self.n_strains + len(free)), np.zeros(pencil.n)
        for step in range(REFINED):
            right = np.concatenate([found[:m] / pencil.stiffness, load - transposed @ found[:m]])
            right[:m] -= pencil.strain(answer[:, None])[:, 0]
            if self.below:
                right[m:] += self.below * (self.mass @ answer)[free]
            more = self.answered(right)
            found += more
            answer[free] = found[m:]
            if step and abs(more[:m]).max() < STILL * abs(found[:m]).max():
                break
        return found[:m], self.still(answer)


def fitting_inverse(pencil: FactoredPencil) -> Inverse:
    """The inverse that modes are found from: of K - below M, where motions are slow of K + slow M."""
    slow = SLOW * pencil.bending
    try:
        inverse = inverse_of(pencil, pencil.below)
        lowest = abs(lowest_told(inverse)) if slow else inf
    except InputError:  # to rounding a motion is not slow but free
        if not slow:
            raise
        lowest = 0.0
    felt = slow * min(pencil.n / DENSE_UNKNOWNS, 1.0) ** 4  # of few parts others keep their digits beside slower ones
    return replace(inverse, rough=lowest < pencil.bending) if lowest >= felt else inverse_of(pencil, -slow)


def inverse_of(pencil: FactoredPencil, below: float) -> Inverse:
    """The inverse of K - below M; of K alone, 0, where motions are rigid, with as many unknowns grounded."""
    unit = swing(max(abs(below), pencil.bending) or 1.0)
    mixed, free = mixed_matrix(pencil, below, unit)
    mass = pencil.mass_matrix()
    inertia = mass @ pencil.rigid
    return Inverse(
        pencil=pencil,
        below=below,
        factor=factorised(mixed),
        free=free,
        scales=soft_scales(1.0 / (1.0 / (unit * pencil.stiffness))),  # as `bordered` has them, to the last bit
        unit=unit,
        mass=mass,
        inertia=inertia,
        motions=np.linalg.solve(pencil.rigid.T @ inertia, pencil.rigid.T).T,
    )


def lowest_told(inverse: Inverse) -> float:
    """About the lowest eigenvalue less `below`, by two steps of inverse iteration; rounding may turn its sign.

    NaN where motions are so slow that their answers are no numbers.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        first = inverse.solve(inverse.mass @ start_of(inverse.pencil.n)[:, 0])
        load = inverse.mass @ first
        second = inverse.solve(load)
        return float(second @ load / (second @ (inverse.mass @ second)))


@lru_cache(maxsize=8)
def start_of(n: int) -> Array:
    """What inverse iteration starts from, (n, 1), the same every time."""
    return np.random.default_rng(4276).standard_normal((n, 1))


def first_bending(lengths: Array, stiffnesses: Any, masses_per_length: Array, tension: float = 0.0) -> float:
    """About the lowest omega^2 of a beam of parts (N,), in their units, that bends between pins: of others a tenth.

    It passes a phase of pi, of (m omega^2 / EI)^(1/4) a length; an axial force adds what it does to a string.
    """
    phase = (lengths * (masses_per_length / stiffnesses) ** 0.25).sum()
    pulled = max(tension, 0.0) * pi**2 / (lengths.sum() * (lengths * masses_per_length).sum())
    return float((pi / phase) ** 4 + pulled)
