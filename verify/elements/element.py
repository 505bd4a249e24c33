"""What scikit-fem is given: the cubic Hermite element, a line of them, and the forms of a bending beam.

Imports scikit-fem, so it is itself imported in functions alone. scikit-fem's own ElementLineHermite is the same
element found by inverting a Vandermonde matrix in global coordinates, which costs it digits (`stock`).
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from skfem.assembly import BilinearForm, CellBasis
from skfem.element import DiscreteField
from skfem.element.element import Element
from skfem.mapping import MappingAffine
from skfem.mesh import MeshLine1
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from verify.arrays import Array, Indices
from verify.elements.mesh import KEPT

_RULES = {
    "gauss": get_quadrature(RefLine, 6),
    "simpson": (np.array([[0.0, 0.5, 1.0]]), np.array([1.0, 4.0, 1.0]) / 6.0),
    "boole": (np.array([[0.0, 0.25, 0.5, 0.75, 1.0]]), np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0),
}
"""Points and weights on [0, 1]. Simpson's are exact for squares of curvatures, Boole's for squares of slopes, and
both lie on floats: what cancels in a sum over a cell does so exactly."""
_MIDDLE = (np.array([[0.5]]), np.array([1.0]))


def cubics(xi: Array, derivative: int = 0) -> tuple[Array, Array, Array, Array]:
    """The four Hermite polynomials on [0, 1] or a derivative, each shaped as xi: w_0, w_0', w_1, w_1'."""
    if derivative == 0:
        twice, rest, square = 2 * xi, 1.0 - xi, xi * xi
        other = rest * rest
        return other * (1 + twice), xi * other, square * (3 - twice), -square * rest
    if derivative == 1:
        thrice, bow = 3 * xi, 6.0 * xi * (xi - 1.0)
        return bow, (1 - xi) * (1 - thrice), -bow, xi * (thrice - 2)
    if derivative == 2:
        six, twelve = 6 * xi, 12 * xi
        return twelve - 6, six - 4, 6 - twelve, six - 2
    flat, jerk = np.zeros_like(xi), np.full_like(xi, 6.0 if derivative == 3 else 0.0)
    return flat + 2 * jerk, jerk, flat - 2 * jerk, jerk


class HermiteLine(Element):  # type: ignore[misc]
    """The cubic C1 element: deflection `u` and slope `u_x` at its ends, mapped from the reference cell."""

    nodal_dofs = 2
    maxdeg = 3
    dofnames = ("u", "u_x")
    doflocs = np.array([[0.0], [0.0], [1.0], [1.0]])
    refdom = RefLine

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
        """Value, grad and hess of basis function i at local points X of the cells `tind`: slopes are the mesh's."""
        shrink = mapping.invDF(X, tind)[0, 0]
        length = mapping.DF(X, tind)[0, 0] if i % 2 else 1.0
        value, slope, bend = (cubics(X[0], order)[i] * (length * shrink**order) for order in (0, 1, 2))
        return (DiscreteField(value=value, grad=slope[None], hess=bend[None, None]),)


class Line(MeshLine1):  # type: ignore[misc]
    """Cells from left to right between ascending nodes."""

    def element_finder(self, mapping: Any = None) -> Callable[[Array], Any]:
        """The cell of every point, at a node the one on its right; rounding beyond the ends is taken inside.

        scikit-fem's own finder compares every point with every cell, points times cells in memory.
        """
        inner = self.p[0, 1:-1]
        return lambda x: inner.searchsorted(x, side="right")


class LineBasis(CellBasis):  # type: ignore[misc]
    """Hermite elements on a line at one point each, with what is made of them when first asked for.

    Of small meshes it is kept for the next time; of large ones it would stand beside a solve in memory.
    """

    def at(self, points: str) -> Any:
        """The same elements at the points of a rule, "gauss" (of degree 6), "simpson" or "boole"."""
        return self._made(points, lambda: self._beside(_RULES[points]))

    def weights(self, x: Array, derivative: int = 0) -> tuple[Indices, list[Array]]:
        """Which degrees of freedom are read at x (in the mesh's coordinate), (4, len(x)), and the weights of each.

        What `probes` has in a sparse matrix, by the same finder, mapping and degrees of freedom, in a tenth of its
        time. An affine mapping stretches a cell alike all over.
        """
        cells, xi, lift, turn = self._beneath(x, derivative)
        w0, s0, w1, s1 = cubics(xi, derivative)
        return self.element_dofs[:, cells], [w0 * lift, s0 * turn, w1 * lift, s1 * turn]

    def turn_weights(self, x: Array) -> tuple[Indices, list[Array]]:
        """Likewise of what a rotational spring or a rotary inertia at x feels: the slope."""
        return self.weights(x, 1)

    def _beneath(self, x: Array, derivative: int) -> tuple[Indices, Array, Array, Array]:
        """The cells under x, x in each, and what deflections and slopes of a derivative are multiplied with there."""
        cells = self.mesh.element_finder(mapping=self.mapping)(x)
        xi = self.mapping.invF(x[None, :, None], tind=cells)[0, :, 0]
        lengths, shrinks = self._stretches
        lift = shrinks[cells] ** derivative
        return cells, xi, lift, lengths[cells] * lift

    def read(self, nodal: Any, x: Array, derivative: int = 0) -> Any:
        """The cubics or a derivative at x (in the mesh's coordinate), (k, len(x)); nodal is (k, 2N + 2)."""
        dofs, weights = self.weights(x, derivative)
        return sum(nodal.take(each, axis=1) * weight for each, weight in zip(dofs, weights, strict=True))

    @cached_property
    def _stretches(self) -> tuple[Array, Array]:
        """The mesh's coordinate by each cell's and each cell's by the mesh's, (N,)."""
        return self.mapping.DF(self.X)[0, 0, :, 0], self.mapping.invDF(self.X)[0, 0, :, 0]

    def unheld(self, held: tuple[tuple[str, ...], tuple[str, ...]]) -> Any:
        """Degrees of freedom that are left where both ends hold those of the given names, ascending."""

        def find() -> Any:
            ends = zip((0, self.mesh.nelements), held, strict=True)
            kinds = self.elem.dofnames
            gone = [self.nodal_dofs[kinds.index(name), end] for end, names in ends for name in names]
            # scikit-fem's complement_dofs hashes all of them, which takes ever longer beyond the caches
            return np.delete(np.arange(self.N), np.array(gone, dtype=int))

        return self._made(held, find)

    @cached_property
    def _kept(self) -> dict[Any, Any]:
        return {}

    def _made(self, key: Any, make: Callable[[], Any]) -> Any:
        found = self._kept[key] if key in self._kept else make()
        if self.mesh.nelements < KEPT:
            self._kept[key] = found
        return found

    def _beside(self, quadrature: tuple[Array, Array]) -> Any:
        return CellBasis(
            self.mesh, self.elem, mapping=self.mapping, quadrature=quadrature, dofs=self.dofs, disable_doflocs=True
        )


def line_basis(nodes: Array) -> LineBasis:
    """Hermite elements between nodes, (N + 1,) ascending."""
    number = np.arange(len(nodes))
    line = Line(nodes[None], np.array([number[:-1], number[1:]]))
    return LineBasis(line, HermiteLine(), mapping=MappingAffine(line), quadrature=_MIDDLE)


@BilinearForm  # type: ignore[untyped-decorator]
def bending(u: Any, v: Any, w: Any) -> Any:
    """Of bending, EI u'' v''; `w.weight` is EI."""
    return w.weight * u.hess[0, 0] * v.hess[0, 0]


@BilinearForm  # type: ignore[untyped-decorator]
def inertia(u: Any, v: Any, w: Any) -> Any:
    """Of inertia, rho A u v; `w.weight` is rho A."""
    return w.weight * u * v


@BilinearForm  # type: ignore[untyped-decorator]
def stretching(u: Any, v: Any, w: Any) -> Any:
    """Of slopes, u' v': an axial force's, or rho I's; `w.weight` is T or rho I."""
    return w.weight * u.grad[0] * v.grad[0]


def per_cell(values: Array, basis: Any) -> DiscreteField:
    """A property of each cell, (N,), as a field at the points of a basis."""
    return DiscreteField(np.broadcast_to(values[:, None], basis.dx.shape))
