"""Vectors of many parts made better than the factors that found them. Called by `eigen` for its sparse solver."""

from typing import TYPE_CHECKING, Any

import numpy as np

from verify.models.arrays import Array, Indices

if TYPE_CHECKING:
    from verify.models.eigen import FactoredPencil


def polished(
    pencil: "FactoredPencil", factor: Any, vectors: Array, free: Indices, motions: Array
) -> tuple[Array, Array]:
    """A step of inverse iteration whose solution is refined once, (n, k), and its strains, (m, k).

    The residual is by differences of differences. The strains are those of the mixed solution: digits of the last
    place of v alone would be n^2 eps of them.
    """
    n_strains, mass = len(pencil.stiffness), pencil.mass_matrix()
    transposed = pencil.strain_matrix()[:, free].T
    inertia = mass @ pencil.rigid
    better, strains = np.empty_like(vectors), np.empty((n_strains, vectors.shape[1]))
    carried = np.empty_like(vectors)
    for k, vector in enumerate(vectors.T):
        load = mass @ (vector - better[:, :k] @ (carried[:, :k].T @ vector))
        load -= inertia @ (motions.T @ load)
        load /= abs(load).max()
        right = np.concatenate([np.zeros(n_strains), load[free]])
        found, answer = factor.solve(right), np.zeros(pencil.n)
        force, answer[free] = found[:n_strains], found[n_strains:]
        right[:n_strains] = force / pencil.stiffness - pencil.strain(answer[:, None])[:, 0]
        right[n_strains:] -= transposed @ force
        if pencil.below:
            right[n_strains:] += pencil.below * (mass @ answer)[free]
        found += factor.solve(right)
        answer[free] = found[n_strains:]
        answer -= motions @ (inertia.T @ answer)
        lower = carried[:, :k].T @ answer  # which each step of inverse iteration raises
        answer -= better[:, :k] @ lower
        size = np.sqrt(answer @ (mass @ answer))
        better[:, k] = answer / size
        carried[:, k] = mass @ better[:, k]
        strains[:, k] = (found[:n_strains] / pencil.stiffness - strains[:, :k] @ lower) / size
    return better, strains
