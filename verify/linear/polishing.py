"""Vectors made better than what found them: of many parts, slow motions, and all modes of a small pencil."""

from math import inf

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.inverse import SLOW, Inverse, start_of
from verify.linear.pencil import FactoredPencil, factored_quotient

_STEPS = 12
"""To a slow motion at most; each leaves a tenth or less of what else is in it."""
_STEADY = 1e-14
"""Of a value: a change after which there is no other."""
_UNSETTLED = 1e-9
"""Of what a value is a sum of: a change after the last step with which it is refused."""
_FELT = 1e-31
"""Of the lowest bending's omega^2, about: below it is rounding of strains, whatever holds the beam."""
_SOUGHT = 6
"""Steps to one that was missed."""


def polished(inverse: Inverse, vectors: Array) -> tuple[Array, Array]:
    """A step of inverse iteration whose solution is refined, (n, k), and its strains, (m, k).

    The strains are those of the mixed solution: digits of the last place of v alone would be n^2 eps of them.
    """
    pencil, mass = inverse.pencil, inverse.mass
    better, strains = np.empty_like(vectors), np.empty((inverse.n_strains, vectors.shape[1]))
    carried = np.empty_like(vectors)
    for k, vector in enumerate(vectors.T):
        load = mass @ (vector - better[:, :k] @ (carried[:, :k].T @ vector))
        force, answer = inverse.refined(load / abs(load).max())
        lower = carried[:, :k].T @ answer  # which each step of inverse iteration raises
        answer -= better[:, :k] @ lower
        size = np.sqrt(answer @ (mass @ answer))
        better[:, k] = answer / size
        carried[:, k] = mass @ better[:, k]
        strains[:, k] = (force / pencil.stiffness - strains[:, :k] @ lower) / size
    return better, strains


def told_apart(inverse: Inverse, vectors: Array) -> tuple[Array, Array]:
    """Modes of an inverse in which slow motions are all alike, each by itself, and their strains, ascending.

    Those of the slow are read where they have most digits, those of others off the vectors but where unknowns are many.
    """
    pencil = inverse.pencil
    values, vectors = factored_quotient(pencil, _with_missed(inverse, vectors))
    some = (values < SLOW * pencil.bending) | inverse.many
    others = vectors[:, ~some]
    motions, strains = _settled(inverse, vectors[:, some])
    vectors, strains = np.hstack([motions, others]), np.hstack([strains, pencil.strain(others)])
    order = np.argsort(factored_quotient(pencil, vectors, strains)[0], kind="stable")
    return vectors[:, order], strains[:, order]


def _settled(inverse: Inverse, vectors: Array) -> tuple[Array, Array]:
    """Slow motions and what stands after them, and their strains, stepped until values of the slow no longer change.

    Raises InputError where they still do, and where one is less than rounding tells.
    """
    pencil, last, change = inverse.pencil, np.zeros(0), inf
    for _ in range(_STEPS):
        vectors, strains = polished(inverse, vectors)
        strains = best_read(pencil, vectors, strains)
        slow = factored_quotient(pencil, vectors, strains)[0] < SLOW * pencil.bending
        turned = _turned(pencil, vectors[:, slow], strains[:, slow])
        vectors[:, slow], strains[:, slow] = vectors[:, slow] @ turned, strains[:, slow] @ turned
        values = factored_quotient(pencil, vectors[:, slow], strains[:, slow])[0]
        if len(last) == len(values):
            change = float((abs(values - last) / _energies(pencil, strains[:, slow])).max(initial=0.0))
            if (abs(values - last) < _STEADY * values).all():
                break
        last = values
    if len(last) and abs(last).min() < _FELT * pencil.bending:
        raise InputError(
            f"count: a motion of {pencil.n} unknowns, which next to nothing holds, is told by rounding alone (its "
            f"omega^2 is {abs(last).min() / pencil.bending:.0e} of the lowest bending's): hold the beam better"
        )
    if not change < _UNSETTLED:
        raise InputError(
            f"count: a motion of {pencil.n} unknowns, which next to nothing holds, does not settle (its omega^2 "
            f"still moves by {change:.0e} of it): lower count, or hold the beam better"
        )
    return vectors, strains


def _energies(pencil: FactoredPencil, strains: Array) -> Array:
    """What values are sums of, (k,): of strains (m, k) that an axial force takes energy from as well."""
    return np.asarray(abs(pencil.stiffness) @ strains**2)


def _with_missed(inverse: Inverse, vectors: Array) -> Array:
    """Vectors, (n, k), and slow motions that are not among them: to Lanczos two that are alike may be one."""
    while len(vectors) > vectors.shape[1] + inverse.pencil.rigid_modes:
        carried = inverse.mass @ vectors
        other = start_of(len(vectors))[:, 0]
        for _ in range(_SOUGHT):
            other = inverse.solve(inverse.mass @ other)
            other -= vectors @ np.linalg.solve(carried.T @ vectors, carried.T @ other)
            last, other = other, other / np.sqrt(other @ (inverse.mass @ other))
        if np.sqrt(last @ (inverse.mass @ last)) < 0.5 / -inverse.below:
            break
        vectors = np.hstack([vectors, other[:, None]])
    return vectors


def best_read(pencil: FactoredPencil, vectors: Array, strains: Array) -> Array:
    """Strains (m, k) of a solution, or off its vectors where these tell more.

    A spring so soft that the rounding of what it feels is less than that of the forces is read off the vector; what
    bends is not, in which a slow motion has no digit.
    """
    rounding = abs(pencil.stiffness)[:, None] * (abs(pencil.strain_matrix()) @ abs(vectors))
    soft = rounding < abs(pencil.stiffness[:, None] * strains).max(axis=0)
    return np.where(soft, pencil.strain(vectors), strains)


def _turned(pencil: FactoredPencil, vectors: Array, strains: Array) -> Array:
    """What makes modes of vectors that span them, (k, k), by their strains (Rayleigh and Ritz)."""
    from scipy.linalg import eigh

    stiffness, mass = strains.T @ (pencil.stiffness[:, None] * strains), vectors.T @ (pencil.mass_matrix() @ vectors)
    return np.asarray(eigh(stiffness, mass)[1]) if len(stiffness) > 1 else np.eye(len(stiffness))


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
