"""The free modes of the Hermite elements for motion in time, closed-form where they have one."""

from collections.abc import Callable, Iterator
from math import pi
from typing import Any, Literal

import numpy as np

from verify.beam import Beam
from verify.elements.curvatures import curvature_weights
from verify.elements.linear import check, leading_sign
from verify.elements.mesh import Elements, basis_between, build_elements, mass_matrix, stiffness_matrix
from verify.elements.pencil import damped_stiffness, element_pencil
from verify.elements.weighing import weighed
from verify.models.arrays import Array, Indices
from verify.models.division import Parts
from verify.models.driven_pencil import check_dense
from verify.models.eigen import modal_basis
from verify.models.places import as_typed
from verify.models.time_basis import TimeBasis, check_held, own_ratios

Nodal = Callable[[Indices], tuple[Array, Array]]
"""Node numbers -> deflection and slope (per element length) of all modes there, each (len(numbers), n)."""


@as_typed
def time_basis(beam: Beam, n_elements: int) -> TimeBasis:
    """All modes of the Hermite elements, (n,), from two-by-two problems on a uniform pinned-pinned beam, else dense.

    With whatever stands on the beam; of Euler and Bernoulli's theory alone. Raises InputError for rigid motions and
    meshes beyond the dense size.
    """
    check(beam, 1, n_elements)
    check_held(beam)
    uniform = beam.supports == ("pinned", "pinned") and beam.uniform and not beam.section and n_elements > 1
    elements = build_elements(beam, n_elements)
    omegas, nodal, method, ratios = _pinned(beam, n_elements) if uniform else _dense(elements)
    parts, basis = elements.parts, elements.basis
    node, on_mesh = _nodes(basis), _on_mesh(parts)
    layout: Literal["C", "F"] = "F" if uniform else "C"  # of what BLAS sums, as it rounds by it

    def loads(position: float) -> Array:
        beside, lift, turn = _unit_force(basis, position / parts.unit, node)
        w, slope = (kind.copy(layout) for kind in nodal(beside))
        return np.asarray(lift @ w + turn @ slope)

    def shapes(x: Array, derivative: int) -> Array:
        dofs, weights = basis.weights(on_mesh(x), derivative)
        if derivative:
            weights = [weight / parts.unit**derivative for weight in weights]
        values = _at_both_ends(nodal, node[dofs[::2]], n_elements + 1)
        return np.ascontiguousarray(weighed(values, [weight[:, None] for weight in weights]).T)

    return TimeBasis(
        model="fem",
        count=n_elements,
        beam=beam,
        omegas=omegas,
        shapes=shapes,
        loads=loads,
        edges=parts.nodes * parts.unit,
        degree=3,
        method=method,
        ratios=ratios,
    )


def _nodes(basis: Any) -> Indices:
    """The node of every degree of freedom."""
    nodes = np.zeros(basis.N, dtype=int)
    nodes[basis.nodal_dofs] = np.arange(basis.nodal_dofs.shape[1])
    return nodes


def _unit_force(basis: Any, x: float, node: Indices) -> tuple[Indices, Array, Array]:
    """The nodes beside a unit force at x on the mesh, and its force and moment on each, (2,) each."""
    dofs, weights = basis.weights(np.array([x]))
    lift, turn = np.array(weights).reshape(2, 2).T.copy()
    return node[dofs[::2, 0]], lift, turn


def _at_both_ends(nodal: Nodal, ends: Indices, count: int) -> Iterator[Array]:
    """Deflection and slope left, then right, each (points, n), at nodes (2, points) of `count`."""
    if ends.size > count:
        kinds = nodal(np.arange(count))
        yield from (kind[end] for end in ends for kind in kinds)
    else:
        kinds, half = nodal(ends.ravel()), ends.shape[1]
        yield from (kind[end] for end in (slice(half), slice(half, None)) for kind in kinds)


def _on_mesh(parts: Parts) -> Callable[[Array], Array]:
    """Metres -> the mesh's unit; a position at a node stays on its right, where rounding would put it on its left."""
    nodes, unit = parts.nodes, parts.unit
    inner = nodes[1:-1] * unit
    return lambda x: np.maximum(np.asarray(x) / unit, nodes[inner.searchsorted(x, side="right")])


def _dense(elements: Elements) -> tuple[Array, Nodal, str, Array | None]:
    beam, unit = elements.beam, elements.parts.unit
    pencil = element_pencil(elements)
    check_dense(pencil, "motion in time")
    values, vectors = modal_basis(pencil)
    deflections, slopes = elements.basis.nodal_dofs
    nodal = elements.all_values(vectors / np.sqrt(beam.mass_per_length * unit))
    everywhere = np.ascontiguousarray((nodal * leading_sign(elements, nodal)[:, None]).T)
    omegas = np.sqrt(values) * beam.wave_constant / unit**2
    unlike = beam.loss_factor and beam.lossless
    ratios = own_ratios(pencil, vectors, damped_stiffness(elements, pencil)) if unlike else None
    return omegas, lambda i: (everywhere[deflections[i]], everywhere[slopes[i]]), "dense eigenvalues", ratios


def _pinned(beam: Beam, n: int) -> tuple[Array, Nodal, str, None]:
    """Equal elements between pinned ends: w_j = W sin(mu j), slopes T cos(mu j), two branches for each mu = m pi / N.

    The rows of the matrices at an inner node are scikit-fem's, of three elements. Frequencies come from the
    quotient of bending energy and mass, so that nothing cancels in the low ones.
    """
    mu, w, slope, values = _branches(n)
    element = beam.length / n
    numbers = np.round(mu * n / pi).astype(int)
    alone = (numbers == 0) | (numbers == n)
    scale = 1.0 / np.sqrt(beam.mass_per_length * element * np.where(alone, float(n), 0.5 * n))
    turn = pi * np.arange(2 * n) / n
    waves = np.array([np.sin(turn), np.cos(turn)])
    scale[slope < 0.0] *= -1.0  # which is the slope at the left end
    scales = np.array([scale * w, scale * slope])[:, None]

    def nodal(nodes: Indices) -> tuple[Array, Array]:
        deflections, slopes = scales * waves.take(nodes[:, None] * numbers % (2 * n), axis=1)
        return deflections, slopes

    return np.sqrt(values) * beam.wave_constant / element**2, nodal, "two by two for every wavelength", None


def _branches(n: int) -> tuple[Array, Array, Array, Array]:
    """(mu, W, T, lambda) of all 2 N modes, ascending, each (2N,); W and T of unit mass per element."""
    one, basis = np.ones(3), basis_between(np.arange(4.0))
    assembled = stiffness_matrix(basis, one)
    mean, gradient = curvature_weights(one, assembled).reshape(2, -1)[:, 0]
    stiffness, mass = (matrix.toarray()[2:4, :6] for matrix in (assembled, mass_matrix(basis, one)))
    inner = pi * np.arange(1, n) / n
    shapes = _two_by_two(_symbol(stiffness, inner), _symbol(mass, inner))
    ends = np.array([0.0, pi])
    mass_ends = mass[1, 3] + 2.0 * mass[1, 5] * np.cos(ends)
    mu = np.concatenate([inner, inner, ends])
    w = np.concatenate([shapes[:, 0, 0], shapes[:, 0, 1], [0.0, 0.0]])
    slope = np.concatenate([shapes[:, 1, 0], shapes[:, 1, 1], 1.0 / np.sqrt(mass_ends)])
    s, c = np.sin(0.5 * mu), np.cos(0.5 * mu)
    values = mean * 4.0 * (s * slope) ** 2 + gradient * (2.0 * c * slope - 4.0 * s * w) ** 2
    order = np.argsort(values)
    return mu[order], w[order], slope[order], values[order]


def _symbol(rows: Array, mu: Array) -> Array:
    """A matrix on waves W sin(mu j), T cos(mu j) from its two rows at an inner node, (len(mu), 2, 2)."""
    ww, wt, tt = (
        rows[0, 2] + 2 * rows[0, 4] * np.cos(mu),
        rows[0, 5] * np.sin(mu),
        rows[1, 3] + 2 * rows[1, 5] * np.cos(mu),
    )
    return np.moveaxis(np.array([[ww, -2.0 * wt], [-2.0 * wt, tt]]), 2, 0)


def _two_by_two(stiffness: Array, mass: Array) -> Array:
    """Vectors with v^T M v = 1, ascending, (n, 2, 2) in columns."""
    lower = np.linalg.cholesky(mass)
    inverse = np.linalg.inv(lower)
    _, vectors = np.linalg.eigh(inverse @ stiffness @ inverse.transpose(0, 2, 1))
    return np.asarray(inverse.transpose(0, 2, 1) @ vectors)
