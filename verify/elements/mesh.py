"""A beam's line of elements: scikit-fem's mesh, degrees of freedom and assembly.

Hermite elements, or Timoshenko's. Lengths are in mean element lengths L/N, stiffnesses and masses in those of the
beam; the nodes of equal elements are whole numbers, exact at any size.

Elements end on the steps of the beam and where masses and springs stand: a mass makes the shear force jump and a rotary
inertia the moment, and a cubic bends linearly. With the jump inside an element, frequencies are of order 3 and 1 (1 and
1 under Timoshenko's theory, whose slope jumps with the shear force), with a node there they are of order 4. An
attachment nearer than the shortest section to a step, an end or its neighbour acts inside its element.
"""

from functools import lru_cache
from importlib import import_module
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, Indices
from verify.errors import InputError
from verify.linear.mesh import Parts, check_division, divide
from verify.linear.theory import check_theory
from verify.options import Theory
from verify.problem.beam import SHORTEST_SECTION, Beam
from verify.problem.cross_section import Piece

KEPT = 4000
"""Nodes up to which a basis is cached: about a kilobyte each."""
HELD = {"pinned": ("u",), "clamped": ("u", "u_x"), "guided": ("u_x",), "free": ()}
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

    @property
    def shears(self) -> bool:
        """Whether these are Timoshenko's elements."""
        return self.theory == "timoshenko"

    def all_values(self, vectors: Any) -> Any:
        """Values of all degrees of freedom, (k, n_all), from those of the free ones, (n, k)."""
        nodal = np.zeros((vectors.shape[1], self.basis.N), dtype=vectors.dtype)
        nodal[:, self.free] = vectors.T
        return nodal

    def assemble(self, form: str, weight: Array) -> Any:
        """A form of scikit-fem with a weight of each element, (N,), over all degrees of freedom, sparse."""
        return assemble(self.basis, form, weight)

    def of_pieces(self, figures: list[float]) -> Array:
        """A figure of every piece of the beam for every element, (N,)."""
        ends = np.cumsum([piece.length for piece in self.beam.pieces])[:-1] / self.parts.unit
        return np.array(figures)[ends.searchsorted(self.parts.nodes[:-1] + 0.5 * self.parts.lengths)]


def build_elements(beam: Beam, n_elements: int, grading: float = 1.0, theory: Theory = "euler-bernoulli") -> Elements:
    """The elements of a beam. Raises InputError where it cannot be divided so, or lacks what the theory takes."""
    check_theory(beam, theory)
    check_cuts(beam, n_elements, grading)
    pieces = stretches(beam)
    parts = divide(beam, n_elements, grading, pieces if len(pieces) > len(beam.pieces) else ())
    basis = basis_between(parts.nodes, theory == "timoshenko")
    left, right = beam.supports
    free = basis.unheld((HELD[left], HELD[right]))
    return Elements(beam=beam, theory=theory, parts=parts, basis=basis, free=free)


def check_cuts(beam: Beam, n_elements: int, grading: float) -> None:
    """Raise InputError where a beam cannot be divided so."""
    check_division(beam, n_elements, grading)
    if n_elements < (least := len(stretches(beam))):
        raise InputError(
            f"n_elements = {n_elements}: the beam's steps, masses and springs cut it into {least} stretches and each "
            f"takes an element, give {least} or more"
        )


def stretches(beam: Beam) -> tuple[Piece, ...]:
    """The pieces of a beam, cut where something stands on it."""
    if not (beam.mass or beam.spring):
        return beam.pieces
    near, found, start = SHORTEST_SECTION * beam.length, [], 0.0
    places = sorted({mass.position for mass in beam.mass} | {spring.position for spring in beam.spring})
    for piece in beam.pieces:
        left, end = start, start + piece.length
        for place in places:
            if left + near <= place <= end - near:
                found.append(replace(piece, length=place - left))
                left = place
        found.append(replace(piece, length=end - left) if left > start else piece)
        start = end
    return tuple(found)


def basis_between(nodes: Array, shear: bool = False) -> Any:
    """scikit-fem's basis of Hermite or, with `shear`, Timoshenko elements between nodes, (N + 1,) ascending."""
    return _cached(nodes.tobytes(), shear) if len(nodes) <= KEPT else _made(nodes, shear)


@lru_cache(maxsize=16)
def _cached(nodes: bytes, shear: bool) -> Any:
    return _made(np.frombuffer(nodes), shear)


def _made(nodes: Array, shear: bool) -> Any:
    if shear:
        from verify.elements.shear import shear_basis

        return shear_basis(nodes)
    from verify.elements.element import line_basis

    return line_basis(nodes)


def assemble(basis: Any, form: str, weight: Array) -> Any:
    """A form of scikit-fem over all degrees of freedom, sparse, with `weight` (N,) of each element.

    Of Hermite elements "bending" EI u'' v'', "inertia" rho A u v, "stretching" T u' v'; of Timoshenko's "turning"
    EI psi' psi', "shearing" kappa G A gamma gamma, "moving" rho A w w, "rolling" rho I psi psi.
    """
    from verify.elements.element import per_cell

    module, rule = _FORMS[form]
    points = basis.at(rule)
    return getattr(import_module(module), form).assemble(points, weight=per_cell(weight, points))


_FORMS = {
    "bending": ("verify.elements.element", "simpson"),
    "inertia": ("verify.elements.element", "gauss"),
    "stretching": ("verify.elements.element", "boole"),
    "turning": ("verify.elements.shear", "simpson"),
    "shearing": ("verify.elements.shear", "simpson"),
    "moving": ("verify.elements.shear", "gauss"),
    "rolling": ("verify.elements.shear", "boole"),
}
"""Module and quadrature of each form."""


def point_loads(basis: Any, x: Array) -> Array:
    """Unit forces at x (in units from the left end) on every degree of freedom, (len(x), n_all)."""
    dofs, weights = basis.weights(x)
    loads = np.zeros((len(x), basis.N))
    loads[np.arange(len(x)), dofs] = weights
    return loads
