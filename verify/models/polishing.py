"""Vectors made better than what found them: of many parts, under a heavy mass, and all modes of a small pencil."""

from typing import Any

import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array, Indices
from verify.models.pencil import FactoredPencil, bordered, factored_quotient, factorised

_HEAVY = 1e6
"""Of two masses: from there on modes are found one by one, since the slow motion of the heavy one drowns the others."""
_SAME = 0.9
"""Cosine of two vectors that are one mode."""
_HOMING = 3
"""Steps to a mode that is nearly known, each the cube of the one before."""


def polished(pencil: FactoredPencil, factor: Any, vectors: Array, free: Indices, motions: Array) -> tuple[Array, Array]:
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
        if not pencil.rigid_modes:  # rounding, which a motion that is nearly rigid answers by far more than others
            right[n_strains:] -= carried[:, :k] @ (better[:, :k].T @ right[n_strains:])
        found += factor.solve(right)
        answer[free] = found[n_strains:]
        answer -= motions @ (inertia.T @ answer)
        lower = np.zeros(k)
        for _ in range(2):  # each step of inverse iteration raises them: once leaves what is nearly rigid
            part = carried[:, :k].T @ answer
            answer -= better[:, :k] @ part
            lower += part
        size = np.sqrt(answer @ (mass @ answer))
        better[:, k] = answer / size
        carried[:, k] = mass @ better[:, k]
        strains[:, k] = (found[:n_strains] / pencil.stiffness - strains[:, :k] @ lower) / size
    return better, strains


def is_heavy(pencil: FactoredPencil) -> bool:
    """Whether something on the beam weighs far more than the parts of it."""
    masses = pencil.mass_matrix().diagonal()
    most = masses.max() / _HEAVY
    if not most > masses.min():  # a middle costs more than the rest, and no mass heavy beside it is light by the least
        return False
    masses, half = np.sort(masses), len(masses) // 2  # np.median would wake numpy.ma
    return bool(most > 0.5 * (masses[half] + masses[-1 - half]))


def homed(pencil: FactoredPencil, vectors: Array) -> Array:
    """Vectors by Rayleigh quotient iteration on the mixed matrix, (n, k); one that would leave its mode stays.

    B. N. Parlett, The Symmetric Eigenvalue Problem (1980), ch. 4.
    """
    from scipy.sparse import csc_array

    mass, strain, n_strains = csc_array(pencil.mass_matrix()), pencil.strain_matrix(), len(pencil.stiffness)
    homed = vectors.copy()
    for k in range(vectors.shape[1]):
        vector = vectors[:, [k]]
        for _ in range(_HOMING):
            value, vector = factored_quotient(pencil, vector)
            right = np.concatenate([np.zeros(n_strains), (mass @ vector)[:, 0]])
            try:
                mixed = bordered(-1.0 / pencil.stiffness, strain, -value[0] * mass)
                vector = factorised(mixed).solve(right)[n_strains:, None]
            except InputError:  # singular to the last digit: it is the mode
                break
        _, vector = factored_quotient(pencil, vector)
        if abs(vector[:, 0] @ (mass @ homed[:, k])) > _SAME * np.sqrt(homed[:, k] @ (mass @ homed[:, k])):
            homed[:, k] = vector[:, 0]
    return homed


def sharpened(pencil: FactoredPencil, values: Array, vectors: Array) -> tuple[Array, Array]:
    """All pairs with what low vectors have of high ones taken out, once (Ogita and Aishima, 2018, Algorithm 1).

    V^T K V from the strains is as exact for low modes as for high ones, which no assembled K is.
    """
    strains = np.sqrt(pencil.stiffness)[:, None] * pencil.strain(vectors)
    lack = np.eye(pencil.n) - vectors.T @ (pencil.mass_matrix() @ vectors)
    gaps = values - values[:, None]
    apart = abs(gaps) > 1e-9 * (values + values[:, None])
    mixed = (strains.T @ strains + values * lack) / np.where(apart, gaps, 1.0)
    vectors = vectors + vectors @ np.where(apart, mixed, 0.5 * lack)
    elastic = factored_quotient(pencil, vectors[:, pencil.rigid_modes :])
    first = slice(pencil.rigid_modes)
    return np.append(values[first], elastic[0]), np.hstack([vectors[:, first], elastic[1]])
