"""A beam's line of elements: scikit-fem's mesh, degrees of freedom, assembly, point forces and readings.

Hermite elements, or Timoshenko's under his theory. Lengths are in mean element lengths L/N, stiffnesses and masses in
those of the beam; the nodes are real coordinates in that unit, so that those of equal elements are whole numbers,
exact at any size.
"""

from functools import lru_cache
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.elements.cuts import cut
from verify.elements.weighing import KEPT
from verify.models.arrays import Array, Indices
from verify.models.division import Parts
from verify.models.theory import check_theory
from verify.options import Theory

_HELD = {"pinned": ("u",), "clamped": ("u", "u_x"), "guided": ("u_x",), "free": ()}
"""What a support holds, in scikit-fem's names of the degrees of freedom."""


class Elements(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A beam divided into elements."""

    beam: Beam
    theory: Theory
    parts: Parts
    basis: Any
    """verify.elements.element.LineBasis, or verify.elements.shear.ShearBasis of Timoshenko's theory."""
    free: Indices
    """Degrees of freedom that the supports leave, (n,) ascending."""

    @property
    def lengths(self) -> Array:
        """Of the elements as the mesh has them, (N,)."""
        return np.diff(self.basis.mesh.p[0])

    def all_values(self, vectors: Any) -> Any:
        """Values of all degrees of freedom, (k, n_all), from those of the free ones, (n, k)."""
        nodal = np.zeros((vectors.shape[1], self.basis.N), dtype=vectors.dtype)
        nodal[:, self.free] = vectors.T
        return nodal


def build_elements(beam: Beam, n_elements: int, grading: float = 1.0, theory: Theory = "euler-bernoulli") -> Elements:
    """The elements of a beam. Raises InputError where it cannot be divided so, or lacks what the theory takes."""
    check_theory(beam, theory)
    parts = cut(beam, n_elements, grading)
    basis = basis_between(parts.nodes, theory == "timoshenko")
    return Elements(beam=beam, theory=theory, parts=parts, basis=basis, free=free_unknowns(basis, beam.supports))


def basis_between(nodes: Array, shear: bool = False) -> Any:
    """scikit-fem's basis of Hermite or, with `shear`, Timoshenko elements between nodes, (N + 1,) ascending.

    Small ones are kept.
    """
    return _kept(nodes.tobytes(), shear) if len(nodes) <= KEPT else _made(nodes, shear)


@lru_cache(maxsize=16)
def _kept(nodes: bytes, shear: bool) -> Any:
    return _made(np.frombuffer(nodes), shear)


def _made(nodes: Array, shear: bool) -> Any:
    if shear:
        from verify.elements.shear import shear_basis

        return shear_basis(nodes)
    from verify.elements.element import line_basis

    return line_basis(nodes)


def free_unknowns(basis: Any, supports: tuple[str, str]) -> Indices:
    """Which degrees of freedom the supports leave, (n,) ascending."""
    left, right = supports
    return np.asarray(basis.unheld((_HELD[left], _HELD[right])))


def stiffness_matrix(basis: Any, stiffness: Array) -> Any:
    """K over all degrees of freedom by scikit-fem, (2N + 2, 2N + 2) sparse; `stiffness` is EI of each element, (N,)."""
    from verify.elements.element import bending, per_cell

    points = basis.at("simpson")
    return bending.assemble(points, stiffness=per_cell(stiffness, points))


def mass_matrix(basis: Any, mass: Array) -> Any:
    """The consistent M over all degrees of freedom by scikit-fem, likewise; `mass` is rho A of each element, (N,)."""
    from verify.elements.element import inertia, per_cell

    points = basis.at("gauss")
    return inertia.assemble(points, mass=per_cell(mass, points))


def slope_matrix(basis: Any, weight: Array) -> Any:
    """The integral of `weight` u' v' over Hermite elements by scikit-fem, likewise; of T or of rho I, (N,)."""
    from verify.elements.element import per_cell, stretching

    points = basis.at("boole")
    return stretching.assemble(points, weight=per_cell(weight, points))


def turn_matrix(basis: Any, stiffness: Array) -> Any:
    """The part of bending in K of Timoshenko elements by scikit-fem, likewise, of EI (N,)."""
    from verify.elements.element import per_cell
    from verify.elements.shear import turning

    points = basis.at("simpson")
    return turning.assemble(points, stiffness=per_cell(stiffness, points))


def shear_matrix(basis: Any, stiffness: Array) -> Any:
    """The part of shear in it, of kappa G A (N,)."""
    from verify.elements.element import per_cell
    from verify.elements.shear import shearing

    points = basis.at("simpson")
    return shearing.assemble(points, stiffness=per_cell(stiffness, points))


def moving_matrix(basis: Any, mass: Array) -> Any:
    """The consistent M of what Timoshenko elements move across by scikit-fem, likewise, of rho A (N,)."""
    from verify.elements.element import per_cell
    from verify.elements.shear import moving

    points = basis.at("gauss")
    return moving.assemble(points, mass=per_cell(mass, points))


def rolling_matrix(basis: Any, rotary: Array) -> Any:
    """The part of M of their turning, of rho I (N,)."""
    from verify.elements.element import per_cell
    from verify.elements.shear import rolling

    points = basis.at("boole")
    return rolling.assemble(points, mass=per_cell(rotary, points))


def point_loads(basis: Any, x: Array) -> Array:
    """Unit forces at x (in units from the left end) on every degree of freedom, (len(x), 2N + 2)."""
    dofs, weights = basis.weights(x)
    loads = np.zeros((len(x), basis.N))
    loads[np.arange(len(x)), dofs] = weights
    return loads


def interpolate(basis: Any, nodal: Any, x: Array, derivative: int = 0) -> Any:
    """The elements' cubics or a derivative at x (in units from the left end), (k, len(x)); nodal is (k, 2N + 2)."""
    return basis.read(nodal, x, derivative)
