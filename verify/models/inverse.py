"""The inverse of a pencil, K - below M, through the sparse factors of its mixed matrix, rigid motions taken out.

A motion so slow that it hardly bends the beam - a bar on foam, on long springs - has next to no stiffness: in the
inverse of K it is so large that its rounding drowns what bends. Of K + slow M, slow being of the order of what bends
the beam first, all modes are the same and none is large.
"""

from math import pi
from typing import Any

import msgspec
import numpy as np

from verify.models.arrays import Array, Indices
from verify.models.pencil import FactoredPencil, factorised, mixed_matrix

_HARDLY_BENT = 0.01
"""Of (pi / phase)^4 and what an axial force adds: below the first bending mode of any ends."""


class Inverse(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What answers loads with K - below M."""

    pencil: FactoredPencil
    below: float
    factor: Any
    free: Indices
    """Unknowns that are not grounded."""
    mass: Any
    inertia: Array
    """M R, (n, r)."""
    motions: Array
    """R (R^T M R)^-1, (n, r)."""

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

    def solve(self, load: Array) -> Array:
        """The answer to a load, (n,) both."""
        right, answer = np.zeros(self.n_strains + len(self.free)), np.zeros(self.pencil.n)
        right[self.n_strains :] = self.balanced(load)[self.free]
        answer[self.free] = self.factor.solve(right)[self.n_strains :]
        return self.still(answer)


def inverse_of(pencil: FactoredPencil, below: float) -> Inverse:
    """The inverse of K - below M; of K alone, 0, where motions are rigid, with as many unknowns grounded."""
    mixed, free = mixed_matrix(pencil, below)
    mass = pencil.mass_matrix()
    inertia = mass @ pencil.rigid
    return Inverse(
        pencil=pencil,
        below=below,
        factor=factorised(mixed),
        free=free,
        mass=mass,
        inertia=inertia,
        motions=np.linalg.solve(pencil.rigid.T @ inertia, pencil.rigid.T).T,
    )


def slow_limit(lengths: Array, stiffnesses: Any, masses_per_length: Array, tension: float = 0.0) -> float:
    """Below which omega^2 is of a motion that hardly bends a beam of parts (N,), or pulls it straight, in their units.

    Between any ends a bending mode passes a phase of about pi or more, of (m omega^2 / EI)^(1/4) a length.
    """
    phase = (lengths * (masses_per_length / stiffnesses) ** 0.25).sum()
    pulled = max(tension, 0.0) * (pi / lengths.sum()) ** 2 * lengths.sum() / (lengths * masses_per_length).sum()
    return float(_HARDLY_BENT * ((pi / phase) ** 4 + pulled))
