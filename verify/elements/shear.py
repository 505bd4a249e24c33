"""Timoshenko's element for scikit-fem: Hermite cubics with a constant and a linear shear strain in every cell.

At its ends it has deflection w and turn psi, as the Hermite element has deflection and slope, and inside two shear
strains of its own, gamma = w' - psi = g_0 + g_1 (2 xi - 1). Its w is cubic and its psi quadratic with no more than
that between them, so that nothing locks: gamma is no difference of w' and psi but an unknown, and where shear is
stiff it goes and the Hermite element is left. g_0 alone is the element that is exact in statics (Friedman and
Kosmatka, Computers & Structures 47, 1993), whose frequencies are of order 2 as it has no shear that inertia makes;
with g_1 they are of order 4. Imports scikit-fem, so it is itself imported in functions alone.
"""

from typing import Any

import numpy as np
from skfem.assembly import BilinearForm
from skfem.element import DiscreteField
from skfem.element.element import Element
from skfem.refdom import RefLine

from verify.arrays import Array, Indices
from verify.elements.element import _MIDDLE, Line, LineBasis, cubics


def sheared(xi: Array, derivative: int = 0) -> tuple[Array, Array]:
    """Deflection on [0, 1] of a unit of g_0 and of g_1 with ends that stand still, or a derivative: as xi."""
    if derivative == 0:
        hill = xi * (1.0 - xi)
        return hill * (1.0 - 2 * xi), -hill
    if derivative == 1:
        return 1.0 + 6.0 * xi * (xi - 1.0), 2 * xi - 1.0
    if derivative == 2:
        return 12 * xi - 6.0, np.full_like(xi, 2.0)
    return np.full_like(xi, 12.0 if derivative == 3 else 0.0), np.zeros_like(xi)


def turned(xi: Array, derivative: int = 0) -> Array:
    """Turn psi on [0, 1] of a unit of g_0, or a derivative; g_1 has none."""
    if derivative > 1:
        return np.full_like(xi, 12.0 if derivative == 2 else 0.0)
    return 6.0 * xi * (xi - 1.0) if derivative == 0 else 12 * xi - 6.0


class ShearLine(Element):  # type: ignore[misc]
    """Deflection `u` and turn `u_x` at the ends of a cell, its shear strains inside; gives w and psi as two fields."""

    nodal_dofs = 2
    interior_dofs = 2
    maxdeg = 3
    dofnames = ("u", "u_x", "g_0", "g_1")
    doflocs = np.array([[0.0], [0.0], [1.0], [1.0], [0.5], [0.5]])
    refdom = RefLine

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
        """W and psi of basis function i with their gradients, at local points X of the cells `tind`."""
        shrink = mapping.invDF(X, tind)[0, 0]
        length = mapping.DF(X, tind)[0, 0]
        if i < 4:
            size = length if i % 2 else 1.0
            value, slope, bend = (cubics(X[0], order)[i] * (size * shrink**order) for order in (0, 1, 2))
            return DiscreteField(value=value, grad=slope[None]), DiscreteField(value=slope, grad=bend[None])
        value, slope = (sheared(X[0], order)[i - 4] * (length * shrink**order) for order in (0, 1))
        turn, bend = ((turned(X[0], order) if i == 4 else 0.0 * X[0]) * shrink**order for order in (0, 1))
        return DiscreteField(value=value, grad=slope[None]), DiscreteField(value=turn, grad=bend[None])


class ShearBasis(LineBasis):
    """Timoshenko elements on a line: what is read of them as of Hermite elements."""

    def weights(self, x: Array, derivative: int = 0) -> tuple[Indices, list[Array]]:
        """Which degrees of freedom make the deflection or a derivative at x, (6, len(x)), and the weights of each."""
        cells, xi, lift, turn = self._beneath(x, derivative)
        w0, s0, w1, s1 = cubics(xi, derivative)
        g0, g1 = sheared(xi, derivative)
        return self.element_dofs[:, cells], [w0 * lift, s0 * turn, w1 * lift, s1 * turn, g0 * turn, g1 * turn]

    def turn_weights(self, x: Array, derivative: int = 0) -> tuple[Indices, list[Array]]:
        """Likewise of the turn psi at x or a derivative of it."""
        cells, xi, lift, turn = self._beneath(x, derivative + 1)
        w0, s0, w1, s1 = cubics(xi, derivative + 1)
        own = turned(xi, derivative) * self._stretches[1][cells] ** derivative
        return self.element_dofs[:, cells], [w0 * lift, s0 * turn, w1 * lift, s1 * turn, own, 0.0 * xi]

    def read_turn(self, nodal: Any, x: Array, derivative: int = 0) -> Any:
        """The turns or a derivative at x (in the mesh's coordinate), (k, len(x)); nodal is (k, 4N + 2)."""
        dofs, weights = self.turn_weights(x, derivative)
        return sum(nodal.take(each, axis=1) * weight for each, weight in zip(dofs, weights, strict=True))


def shear_basis(nodes: Array) -> ShearBasis:
    """Timoshenko elements between nodes, (N + 1,) ascending."""
    number = np.arange(len(nodes) - 1)
    return ShearBasis(Line(nodes[None], np.array([number, number + 1])), ShearLine(), quadrature=_MIDDLE)


@BilinearForm  # type: ignore[untyped-decorator]
def turning(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Of bending, EI psi' psi'; `w.weight` is EI."""
    return w.weight * p.grad[0] * q.grad[0]


@BilinearForm  # type: ignore[untyped-decorator]
def shearing(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Of shear, kappa G A gamma gamma; `w.weight` is kappa G A."""
    return w.weight * (u.grad[0] - p) * (v.grad[0] - q)


@BilinearForm  # type: ignore[untyped-decorator]
def moving(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Of inertia, rho A w w, or of a foundation; `w.weight` is rho A or k_f."""
    return w.weight * u * v


@BilinearForm  # type: ignore[untyped-decorator]
def rolling(u: Any, p: Any, v: Any, q: Any, w: Any) -> Any:
    """Of rotary inertia, rho I psi psi; `w.weight` is rho I."""
    return w.weight * p * q
