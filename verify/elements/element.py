"""The beam elements that scikit-fem assembles: cubic Hermite, and Timoshenko with internal shear strains.

This module imports scikit-fem and is therefore imported inside functions. scikit-fem's own ElementLineHermite inverts
a Vandermonde matrix in global coordinates, with rounding like n^3 (`stock`); here the polynomials of the reference
cell are mapped.

The Timoshenko element has nodal deflection w and rotation psi and two internal shear strains, gamma = w' - psi =
g_0 + g_1 (2 xi - 1). w is cubic and psi quadratic with this difference: no shear locking, and in the limit of stiff
shear the Hermite element. g_0 alone is the element that is exact in statics (Friedman and Kosmatka, Computers &
Structures 47, 1993), whose frequencies are of order 2; with g_1 they are of order 4.
"""

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval
from scipy.interpolate import PPoly
from skfem.assembly import BilinearForm, CellBasis
from skfem.element import DiscreteField
from skfem.element.element import Element
from skfem.mesh import MeshLine
from skfem.refdom import RefLine

from verify.arrays import Array, Indices, Sparse
from verify.linear.factored import sparse_rows

DEFLECTION = np.array(
    [[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1], [0, 1, -3, 2], [0, -1, 1, 0]], dtype=float
)
"""w on [0, 1] of w_0, psi_0, w_1, psi_1, g_0 and g_1, each by its powers of xi; all but w times the length."""
ROTATION = np.array([[0, -6, 6], [1, -4, 3], [0, 6, -6], [0, -2, 3], [0, -6, 6], [0, 0, 0]], dtype=float)
"""psi over the length on [0, 1], for the same unknowns by powers of xi."""


def polynomial(table: Array, i: int, xi: Array, derivative: int = 0) -> Array:
    """Function i of a table, or a derivative, at xi (n,)."""
    return np.asarray(polyval(xi, polyder(table[i], derivative)))


class HermiteLine(Element):  # type: ignore[misc]
    """Cubic C1 element: deflection `u` and slope `u_x` at its ends; two fields, w and psi = w'."""

    nodal_dofs = 2
    maxdeg = 3
    dofnames: tuple[str, ...] = ("u", "u_x")
    doflocs = np.array([[0.0], [0.0], [1.0], [1.0]])
    refdom = RefLine

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
        """W and psi of basis function i with their gradients, at local points X of the cells `tind`."""
        shrink = mapping.invDF(X, tind)[0, 0]
        size = mapping.DF(X, tind)[0, 0] if i not in (0, 2) else 1.0
        w, slope = (polynomial(DEFLECTION, i, X[0], order) * (size * shrink**order) for order in (0, 1))
        psi, bend = (polynomial(ROTATION, i, X[0], order) * (size * shrink ** (order + 1)) for order in (0, 1))
        return DiscreteField(value=w, grad=slope[None]), DiscreteField(value=psi, grad=bend[None])


class TimoshenkoLine(HermiteLine):
    """Timoshenko element: deflection and rotation at its ends and two internal shear strains."""

    interior_dofs = 2
    dofnames = ("u", "u_x", "g_0", "g_1")
    doflocs = np.array([[0.0], [0.0], [1.0], [1.0], [0.5], [0.5]])


@BilinearForm  # type: ignore[untyped-decorator]
def bending(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """EI psi' psi'; `w.weight` is EI."""
    return w.weight * p.grad[0] * q.grad[0]


@BilinearForm  # type: ignore[untyped-decorator]
def shear(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Kappa G A gamma gamma; `w.weight` is kappa G A."""
    return w.weight * (u.grad[0] - p) * (v.grad[0] - q)


@BilinearForm  # type: ignore[untyped-decorator]
def inertia(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Rho A w w; `w.weight` is rho A."""
    return w.weight * u * v


@BilinearForm  # type: ignore[untyped-decorator]
def rotary_inertia(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Rho I psi psi; `w.weight` is rho I."""
    return w.weight * p * q


def line_basis(nodes: Array, shear: bool) -> Any:
    """scikit-fem's basis of Hermite (with `shear`, Timoshenko) elements between ascending nodes (N + 1,).

    Degrees of freedom are w and psi of each node from left to right, then g_0 and g_1 of each element. Four points of
    Gauss integrate products of two cubics exactly.
    """
    number = np.arange(len(nodes))
    mesh = MeshLine(nodes[None], np.array([number[:-1], number[1:]]))
    ends = {"left": np.array([0]), "right": np.array([len(nodes) - 1])}
    element = TimoshenkoLine() if shear else HermiteLine()
    return CellBasis(mesh.with_boundaries(ends), element, intorder=6)


@lru_cache(maxsize=16)
def cached_basis(nodes: bytes, shear: bool) -> Any:
    """`line_basis` of small meshes, shared by beams of different lengths; about 1 kB per element."""
    return line_basis(np.frombuffer(nodes), shear)


def element_matrices(basis: Any, form: Any, weight: Array) -> Any:
    """Element matrices of a form with a weight per element, (N,), as scikit-fem's COOData."""
    return form.coo_data(basis, weight=DiscreteField(np.broadcast_to(weight[:, None], basis.dx.shape)))


def rows(nodes: Array, x: Array, unknowns: Indices, derivative: int = 0, *, rotation: bool = False) -> Sparse:
    """Weights of the unknowns in w or psi, or a derivative, at x (p,): sparse (p, n).

    `unknowns` (n_all,) are the numbers 0..n - 1 of the degrees of freedom, -1 for those that supports prevent.
    """
    n = len(nodes) - 1
    cell = np.searchsorted(nodes[1:-1], x, side="right")
    length = nodes[cell + 1] - nodes[cell]
    xi, table = (x - nodes[cell]) / length, ROTATION if rotation else DEFLECTION
    columns = [*(2 * cell + i for i in range(4)), *(2 * n + 2 + 2 * cell + i for i in range(2))]
    columns = columns[: 6 if len(unknowns) > 2 * n + 2 else 4]
    sizes = length ** -(derivative + rotation)
    values = [
        polynomial(table, i, xi, derivative) * (sizes if i in (0, 2) else sizes * length) for i in range(len(columns))
    ]
    return sparse_rows(unknowns[np.stack(columns, axis=1)], np.stack(values, axis=1), int(unknowns.max()) + 1)


def piecewise(nodes: Array, values: Any, unit: float) -> tuple[PPoly, PPoly]:
    """(w, psi) as piecewise polynomials for values of all degrees of freedom (n_all, k): x in m -> (n, k)."""
    n = len(nodes) - 1
    length, deflections, slopes = np.diff(nodes)[:, None], values[: 2 * n + 2 : 2], values[1 : 2 * n + 2 : 2]
    chord, first, second = np.diff(deflections, axis=0) / length, slopes[:-1], slopes[1:]
    gradient = (first + second - 2.0 * chord) / length
    w = np.array([gradient / length, (chord - first) / length - gradient, first, deflections[:-1]])
    psi = np.array([3.0 * w[0], 2.0 * w[1], w[2]])
    if len(values) > 2 * n + 2:
        g0, g1 = values[2 * n + 2 :: 2], values[2 * n + 3 :: 2]
        w = w + np.array([2.0 * g0 / length**2, (g1 - 3.0 * g0) / length, g0 - g1, 0.0 * g0])
        psi = psi + np.array([6.0 * g0 / length**2, -6.0 * g0 / length, 0.0 * g0])
    powers = unit ** -np.arange(4.0)[:, None, None]
    x = nodes * unit
    return PPoly.construct_fast(w * powers[::-1], x), PPoly.construct_fast(psi * powers[2::-1] / unit, x)
