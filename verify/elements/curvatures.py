"""The strains of the elements as differences of differences, and the stiffness of each read off what is assembled."""

from typing import Any

import numpy as np

from verify.arrays import Array


def curvature_weights(lengths: Array, stiffness: Any) -> Array:
    """d, (2N,), of mean curvatures and their gradients: EI/l and 3 EI/l, from an assembled K, (2N + 2, 2N + 2).

    Between its two nodes K has one element alone: -4 d_1 / l^2 for the deflections, d_1 - d_0 for the slopes.
    """
    beside = stiffness.diagonal(2)
    gradients = -0.25 * lengths**2 * beside[::2]
    return np.concatenate([gradients - beside[1::2], gradients])


def element_curvatures(lengths: Array, nodal: Array) -> Array:
    """Mean curvature and its gradient in every element, (2N, k), from nodal values (2N + 2, k).

    theta_1 - theta_0 and theta_0 + theta_1 - 2 (w_1 - w_0)/l: their squares weighted with EI/l and 3 EI/l
    are twice the bending energy of a cubic element. Written as differences of differences.
    """
    chord = np.diff(nodal[::2], axis=0) / lengths[:, None]
    left, right = nodal[1:-1:2] - chord, nodal[3::2] - chord
    return np.concatenate([np.diff(nodal[1::2], axis=0), left + right])


def element_shear_strains(lengths: Array, values: Array) -> Array:
    """Mean curvature, its gradient and two shear strains in every element, (4N, k), of all values (4N + 2, k).

    A constant shear strain g_0 turns the section by -6 g_0 xi (1 - xi), which is 2 g_0 in the gradient; a linear one
    turns nothing. Weighted with EI/l, 3 EI/l, kappa G A l and kappa G A l/3.
    """
    nodes = 2 * len(lengths) + 2
    mean, gradient = np.split(element_curvatures(lengths, values[:nodes]), 2)
    constant, linear = values[nodes::2], values[nodes + 1 :: 2]
    return np.concatenate([mean, gradient + 2.0 * constant, constant, linear])


def curvature_matrix(lengths: Array) -> Any:
    """B of `element_curvatures` as a sparse array (2N, 2N + 2)."""
    from scipy.sparse import csc_array

    n = len(lengths)
    e, one = np.arange(n), np.ones(n)
    rows = np.concatenate([e, e, n + e, n + e, n + e, n + e])
    columns = np.concatenate([2 * e + 1, 2 * e + 3, 2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3])
    values = np.concatenate([-one, one, 2.0 / lengths, one, -2.0 / lengths, one])
    return csc_array((values, (rows, columns)), shape=(2 * n, 2 * n + 2))


def shear_strain_matrix(lengths: Array) -> Any:
    """B of `element_shear_strains` as a sparse array (4N, 4N + 2)."""
    from scipy.sparse import block_array, csc_array

    n = len(lengths)
    e, one = np.arange(n), np.ones(n)
    rows, columns = np.concatenate([n + e, 2 * n + e, 3 * n + e]), np.concatenate([2 * e, 2 * e, 2 * e + 1])
    inside = csc_array((np.concatenate([2.0 * one, one, one]), (rows, columns)), shape=(4 * n, 2 * n))
    return block_array([[curvature_matrix(lengths), inside[: 2 * n]], [None, inside[2 * n :]]], format="csc")


def axial_weights(lengths: Array, beside: Array, beyond: Array) -> Array:
    """D of chords, mean curvatures and gradients, (3N,): from the integral of T u' v' as scikit-fem assembles it.

    Its second and third diagonals are given. Between the two nodes of an element:
    2 d_2 / l of left deflection and right slope, d_2 - d_1 of both slopes, -(d_0 + 4 d_2) / l^2 of both deflections.
    """
    gradients = 0.5 * lengths * beyond[::2]
    return np.concatenate([-(lengths**2) * beside[::2] - 4.0 * gradients, gradients - beside[1::2], gradients])
