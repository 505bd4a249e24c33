"""Joints of a chain near a clamped wall: compliances as the weights of a quadrature of M^2/EI along the beam.

Interior joints have weight 1 of the trapezoidal rule, in link lengths. At a wall the rule needs an end correction.
"""

from collections.abc import Sequence

import numpy as np

from verify.arrays import Array
from verify.problem.supports import FIXED
from verify.settings import WALLS


def wall_factors(
    supports: Sequence[str], n_segments: int, wall: str, elastic: tuple[bool, bool] = (False, False)
) -> Array:
    """Factors on the compliances of joints 0..N, (N + 1,); infinite at an end without a joint.

    A guided wall has half a joint, exact by reflection. An `elastic` end transmits a moment and has the joints of a
    clamped end. On short chains the corrections of both ends add up.
    """
    factors = np.ones(n_segments + 1)
    for end, support, turns in zip((0, n_segments), supports, elastic, strict=True):
        if support == "clamped" or turns:
            corrections = np.array(WALLS[wall].corrections[: n_segments + 1])
            factors[abs(end - np.arange(len(corrections)))] += corrections
        else:
            factors[end] = np.inf if not FIXED[support].rotation else factors[end] - 0.5
    return factors


def tension_excess(wall: str) -> float:
    """Weight of T l/12 in the first tensioned joint of a clamped wall, in excess of 1/c; 5/24 for Gregory's weights.

    Corrections a_k of the joints rotate link i by -l kappa sum_{k>i} a_k from the smooth line; the axial force acts on
    the squares of these rotations.
    """
    return float(12.0 * (np.cumsum(WALLS[wall].corrections[:0:-1]) ** 2).sum())


def reading_factors(elastic: tuple[bool, bool], n_segments: int, wall: str) -> Array:
    """Factors on the reading corrections of joints near elastic ends, (N + 1,).

    Corrections a_k of the joints move joint j from the smooth line by l^2 kappa sum_{k>j} a_k (k - j), and scale its
    angle by 1 + a_j.
    """
    factors, a = np.ones(n_segments + 1), np.array(WALLS[wall].corrections)
    for end, turns in zip((0, n_segments), elastic, strict=True):
        for j in range(1, min(len(a), n_segments + 1) * turns):
            factors[abs(end - j)] *= (1.0 - 12.0 * a[j + 1 :] @ np.arange(1, len(a) - j)) / (1.0 + a[j])
    return factors
