"""What an axial force, a foundation, springs and masses add to the elements' K and M.

Strains of their own, each with its stiffness: an axial force strains the chord of an element as well as its two
curvatures, w'^2 having the mean (chord^2 + mean^2/12 + gradient^2/20); a foundation is strained where scikit-fem's
cubics are read, at four Gauss points of each element; a spring where it stands.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.elements.curvatures import axial_weights, curvature_matrix, element_curvatures
from verify.elements.mesh import Elements
from verify.linear.pencil import FactoredPencil

SAME_PLACE = 1e-9
"""Of a mean element: what stands so near to a node stands on it."""

RIGID = 1e14
"""Times the bending stiffness of an element: what is stiffer moves no frequency by 1e-13, its strain is rounding."""


def stiffest(elements: Elements) -> float:
    """What stiffness is as good as rigid, in EI / unit^3."""
    return RIGID * float(elements.parts.stiffnesses.max())


def added_strains(elements: Elements, plain: FactoredPencil) -> FactoredPencil:
    """The pencil with the strains of axial force, foundation and springs after those of `plain`."""
    beam, free = elements.beam, elements.free
    parts = [_axial(elements)] if beam.tension else []
    parts += [_ground(elements)] if beam.foundation else []
    parts += [_springs(elements)] if beam.spring else []
    if not parts:
        return plain
    reads, matrices, stiffnesses = zip(*parts, strict=True)

    def strain(values: Array) -> Array:
        everywhere = elements.all_values(values).T
        return np.concatenate([plain.strain(values), *(read(everywhere) for read in reads)])

    def strain_matrix() -> Any:
        from scipy.sparse import vstack

        return vstack([plain.strain_matrix(), *(matrix()[:, free] for matrix in matrices)], format="csc")

    stiffness = np.concatenate([plain.stiffness, *stiffnesses])
    below = _lifted(elements, plain.bending)
    return replace(plain, strain=strain, strain_matrix=strain_matrix, stiffness=stiffness, below=below)


def _lifted(elements: Elements, bending: float) -> float:
    """What a foundation lifts all eigenvalues above, 0 where masses or an axial force may take them down again.

    What is left is as large as what bends, for a motion that it bears may be rigid, and a million roundings of it.
    """
    beam, parts = elements.beam, elements.parts
    if beam.mass or beam.tension < 0.0 or elements.theory != "euler-bernoulli":
        return 0.0
    lifted = _ground_stiffness(elements) / float(parts.masses_per_length.max())
    return max(lifted - max(1e-10 * lifted, bending), 0.0)


Strained = tuple[Callable[[Array], Array], Callable[[], Any], Array]
"""All values -> strains, the same as a sparse array, and the stiffness of each."""


def _axial(elements: Elements) -> Strained:
    """Chord, mean curvature and gradient of every element, (3N, ...), with T l, T l/12 and T l/20."""
    lengths, beam = elements.lengths, elements.beam
    force = np.full(len(lengths), beam.tension * elements.parts.unit**2 / beam.bending_stiffness)

    def read(values: Array) -> Array:
        chord = np.diff(values[::2], axis=0) / lengths[:, None]
        return np.concatenate([chord, element_curvatures(lengths, values)])

    def matrix() -> Any:
        from scipy.sparse import csc_array, vstack

        e, n = np.arange(len(lengths)), len(lengths)
        entries = np.concatenate([-1.0 / lengths, 1.0 / lengths])
        where = (np.concatenate([e, e]), np.concatenate([2 * e, 2 * e + 2]))
        return vstack([csc_array((entries, where), shape=(n, 2 * n + 2)), curvature_matrix(lengths)], format="csc")

    pulled = elements.assemble("stretching", force)
    return read, matrix, axial_weights(lengths, pulled.diagonal(2), pulled.diagonal(3))


def _ground(elements: Elements) -> Strained:
    """Deflection at four Gauss points of every element, (4N, ...), with k_f times their share of its length."""
    points, weights = np.polynomial.legendre.leggauss(4)
    lengths, nodes = elements.lengths, elements.parts.nodes
    x = (nodes[:-1, None] + lengths[:, None] * (0.5 + 0.5 * points)).ravel()
    matrix = _rows(elements, elements.basis.weights(x))
    stiffness = _ground_stiffness(elements) * (lengths[:, None] * 0.5 * weights).ravel()
    return lambda values: matrix @ values, lambda: matrix, stiffness


def _ground_stiffness(elements: Elements) -> float:
    """K_f in EI / unit^4."""
    return elements.beam.foundation * elements.parts.unit**4 / elements.beam.bending_stiffness


def _springs(elements: Elements) -> Strained:
    """What each spring feels."""
    beam, unit = elements.beam, elements.parts.unit
    lift = [(spring.position, spring.stiffness * unit**3) for spring in beam.spring if spring.stiffness]
    turn = [(spring.position, spring.rotational * unit) for spring in beam.spring if spring.rotational]
    matrix, stiffness = _felt(elements, lift, turn)
    stiffness = np.minimum(stiffness / beam.bending_stiffness, stiffest(elements))
    return lambda values: matrix @ values, lambda: matrix, stiffness


def added_mass(elements: Elements) -> Any:
    """What masses and rotary inertias add to M, over all degrees of freedom, sparse."""
    from scipy.sparse import diags_array

    beam, unit = elements.beam, elements.parts.unit
    lift = [(mass.position, mass.mass / unit) for mass in beam.mass if mass.mass]
    turn = [(mass.position, mass.rotary_inertia / unit**3) for mass in beam.mass if mass.rotary_inertia]
    matrix, inertia = _felt(elements, lift, turn)
    return (matrix.T @ diags_array(inertia / beam.mass_per_length) @ matrix).tocsr()


def _felt(elements: Elements, lift: list[tuple[float, float]], turn: list[tuple[float, float]]) -> tuple[Any, Array]:
    """Deflections, then turns, at the places of each as a sparse array (n, n_all), and their values, (n,)."""
    from scipy.sparse import vstack

    at, basis = (np.array([place for place, _ in group]) for group in (lift, turn)), elements.basis
    places = [_on_nodes(elements, x / elements.parts.unit) for x in at]
    rows = [_rows(elements, basis.weights(places[0])), _rows(elements, basis.turn_weights(places[1]))]
    return vstack(rows, format="csc"), np.array([value for _, value in (*lift, *turn)])


def _on_nodes(elements: Elements, x: Array) -> Array:
    """Places on the mesh, on the node itself where rounding alone keeps them off it."""
    nodes = elements.parts.nodes
    nearest = nodes[abs(x[:, None] - nodes).argmin(axis=1)] if len(x) else x
    return np.where(abs(nearest - x) < SAME_PLACE, nearest, x)


def _rows(elements: Elements, weights: tuple[Any, list[Array]]) -> Any:
    """Readings as a sparse array, (points, n_all)."""
    from scipy.sparse import csc_array

    dofs, values = weights
    where = np.broadcast_to(np.arange(dofs.shape[1]), dofs.shape)
    found = csc_array((np.ravel(values), (where.ravel(), dofs.ravel())), shape=(dofs.shape[1], elements.basis.N))
    found.eliminate_zeros()
    return found
