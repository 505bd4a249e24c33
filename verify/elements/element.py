"""What scikit-fem is given: the cubic Hermite element, a line of them, and the two forms of a bending beam.

Imports scikit-fem, so it is itself imported in functions alone. scikit-fem's own ElementLineHermite is the same
element found by inverting a Vandermonde matrix in global coordinates, which costs it digits (`stock`).
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from skfem import BilinearForm, CellBasis
from skfem.element import DiscreteField
from skfem.element.element import Element
from skfem.mesh import MeshLine1
from skfem.quadrature import get_quadrature
from skfem.refdom import RefLine

from verify.elements.mesh import KEPT
from verify.models.arrays import Array

_RULES = {
    "gauss": get_quadrature(RefLine, 6),
    "simpson": (np.array([[0.0, 0.5, 1.0]]), np.array([1.0, 4.0, 1.0]) / 6.0),
}
"""Points and weights on [0, 1]. Simpson's are exact for the squares of curvatures and lie on floats."""
_MIDDLE = (np.array([[0.5]]), np.array([1.0]))

_Polynomials = tuple[Callable[[Array], Any], ...]
_CUBICS: tuple[_Polynomials, ...] = (
    (
        lambda xi: (1.0 - xi) ** 2 * (1 + 2 * xi),
        lambda xi: xi * (1.0 - xi) ** 2,
        lambda xi: xi**2 * (3 - 2 * xi),
        lambda xi: -(xi**2) * (1.0 - xi),
    ),
    (
        lambda xi: 6.0 * xi * (xi - 1.0),
        lambda xi: (1 - xi) * (1 - 3 * xi),
        lambda xi: -(6.0 * xi * (xi - 1.0)),
        lambda xi: xi * (3 * xi - 2),
    ),
    (lambda xi: 12 * xi - 6, lambda xi: 6 * xi - 4, lambda xi: 6 - 12 * xi, lambda xi: 6 * xi - 2),
    (
        lambda xi: np.full_like(xi, 12.0),
        lambda xi: np.full_like(xi, 6.0),
        lambda xi: np.full_like(xi, -12.0),
        lambda xi: np.full_like(xi, 6.0),
    ),
)


def cubic(xi: Array, i: int, derivative: int = 0) -> Array:
    """Hermite polynomial i of (w_0, w_0', w_1, w_1') on [0, 1] or a derivative, shaped as xi."""
    return np.asarray(_CUBICS[derivative][i](xi) if derivative < len(_CUBICS) else np.zeros_like(xi))


def mapped(mapping: Any, X: Array, i: int, tind: Any, orders: tuple[int, ...]) -> list[Array]:  # noqa: N803
    """Derivatives of basis function i by the mesh's coordinate, each (cells, points): slopes are slopes there too."""
    shrink = mapping.invDF(X, tind)[0, 0]
    length = mapping.DF(X, tind)[0, 0] if i % 2 else 1.0
    return [cubic(X[0], i, order) * (length * shrink**order) for order in orders]


class HermiteLine(Element):  # type: ignore[misc]
    """The cubic C1 element: deflection `u` and slope `u_x` at its ends, mapped from the reference cell."""

    nodal_dofs = 2
    maxdeg = 3
    dofnames = ("u", "u_x")
    doflocs = np.array([[0.0], [0.0], [1.0], [1.0]])
    refdom = RefLine

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
        """Value, grad and hess of basis function i at local points X of the cells `tind`."""
        value, slope, bend = mapped(mapping, X, i, tind, (0, 1, 2))
        return (DiscreteField(value=value, grad=slope[None], hess=bend[None, None]),)


class HermiteDerivative(HermiteLine):
    """The same element, whose values are a derivative of it: what `probes` is to read."""

    def __init__(self, order: int) -> None:
        """`order` of the derivative, 0 the deflection itself."""
        self.order = order

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
        """The derivative of basis function i at local points X of the cells `tind`, as the value of a field."""
        return (DiscreteField(value=mapped(mapping, X, i, tind, (self.order,))[0]),)


class Line(MeshLine1):  # type: ignore[misc]
    """Cells from left to right between ascending nodes."""

    def element_finder(self, mapping: Any = None) -> Callable[[Array], Any]:
        """The cell of every point, at a node the one on its right; rounding beyond the ends is taken inside.

        scikit-fem's own finder compares every point with every cell, points times cells in memory.
        """
        nodes = self.p[0]
        return lambda x: np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, len(nodes) - 2).astype(np.int32)


class LineBasis(CellBasis):  # type: ignore[misc]
    """Hermite elements on a line at one point each, with what is made of them when first asked for.

    Of small meshes it is kept for the next time; of large ones it would stand beside a solve in memory.
    """

    def at(self, points: str) -> Any:
        """The same elements at the points of a rule, "gauss" (of degree 6) or "simpson"."""
        return self._made(points, lambda: self._beside(self.elem, _RULES[points]))

    def derivative(self, order: int) -> Any:
        """The basis whose values are a derivative of this one's."""
        return self._made(order, lambda: self._beside(HermiteDerivative(order), _MIDDLE))

    def unheld(self, held: tuple[tuple[str, ...], tuple[str, ...]]) -> Any:
        """Degrees of freedom that are left where both ends hold those of the given names, ascending."""

        def find() -> Any:
            ends = zip((0, self.mesh.nelements), held, strict=True)
            return self.complement_dofs(*(self.get_dofs(nodes=np.array([end])).all(list(names)) for end, names in ends))

        return self._made(held, find)

    @cached_property
    def _kept(self) -> dict[Any, Any]:
        return {}

    def _made(self, key: Any, make: Callable[[], Any]) -> Any:
        found = self._kept[key] if key in self._kept else make()
        if self.mesh.nelements < KEPT:
            self._kept[key] = found
        return found

    def _beside(self, element: Element, quadrature: tuple[Array, Array]) -> Any:
        return CellBasis(
            self.mesh, element, mapping=self.mapping, quadrature=quadrature, dofs=self.dofs, disable_doflocs=True
        )


def line_basis(nodes: Array) -> LineBasis:
    """Hermite elements between nodes, (N + 1,) ascending."""
    number = np.arange(len(nodes) - 1)
    return LineBasis(Line(nodes[None], np.array([number, number + 1])), HermiteLine(), quadrature=_MIDDLE)


@BilinearForm  # type: ignore[untyped-decorator]
def bending(u: Any, v: Any, w: Any) -> Any:
    """Of bending, EI u'' v''; `w.stiffness` is EI."""
    return w.stiffness * u.hess[0, 0] * v.hess[0, 0]


@BilinearForm  # type: ignore[untyped-decorator]
def inertia(u: Any, v: Any, w: Any) -> Any:
    """Of inertia, rho A u v; `w.mass` is rho A."""
    return w.mass * u * v


def per_cell(values: Array, basis: Any) -> DiscreteField:
    """A property of each cell, (N,), as a field at the points of a basis."""
    return DiscreteField(np.broadcast_to(values[:, None], basis.dx.shape))
