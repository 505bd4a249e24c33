"""The finite-element model of a beam: cubic Hermite elements, or Timoshenko elements, by scikit-fem.

scikit-fem makes the mesh and the degrees of freedom and assembles stiffness and mass. Its K alone would lose the low
eigenvalues to rounding like N^4; so the stiffness d of every element strain (mean curvature, its gradient, two shear
strains) is extracted from its entries, and K = B^T diag(d) B stays factored, B a product of two difference operators.

Elements end at the steps of the beam and at masses and springs: a mass makes the shear force jump, a rotary inertia the
moment, and a cubic, whose curvature is linear, cannot represent a jump inside the element. There frequencies are of
order 3 (mass) and 1 (rotary inertia), with a node there of order 4. Lengths are in mean element lengths L/N: nodes of
equal elements are whole numbers, exact at any N.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from typing import Any

import numpy as np

from verify.arrays import Array, Indices
from verify.errors import NoFigureError
from verify.linear.base import DiscreteModel
from verify.linear.mesh import Parts, check_division, cut_pieces, divide
from verify.linear.system import StructuralSystem
from verify.options import Theory
from verify.problem.beam import Beam
from verify.problem.supports import HOLDS
from verify.validation import MOST_PARTS, check_whole

RIGID = 1e14
"""Cap on stiffness, relative to that of an element: above it frequencies change by less than 1e-13."""


@dataclass(frozen=True)
class HermiteModel(DiscreteModel):
    """A beam of `n_elements` elements with consistent mass; its frequencies are upper bounds and of order 4.

    `grading` is the length of a stretch's last element over its first. Theories `euler-bernoulli`, `rayleigh` (rotary
    inertia) and `timoshenko` (shear as well). Raises InputError for a size that the beam cannot be divided into, or
    that exceeds the memory, and for section properties that the theory needs and the beam lacks.
    """

    beam: Beam
    n_elements: int
    grading: float = 1.0
    theory: Theory = "euler-bernoulli"

    name = "fem"
    parts = "elements"
    title = "Hermite elements"
    colour = "#e8760c"
    bounds = "above"
    library = "scikit-fem"
    modal_settings = ("grading", "theory")

    def __post_init__(self) -> None:
        check_whole("n_elements", self.n_elements, 1, MOST_PARTS)
        self.check_theory()
        check_division(self.beam, self.n_elements, self.grading, len(cut_pieces(self.beam)))
        self.check_memory()

    # --- Mesh ----------------------------------------------------------------------------------------------------

    @property
    def count(self) -> int:
        """Number of elements."""
        return self.n_elements

    @property
    def unit(self) -> float:
        """L/N, m."""
        return self.beam.length / self.n_elements

    @property
    def shear(self) -> bool:
        """Whether these are Timoshenko elements."""
        return self.theory == "timoshenko"

    @property
    def n_unknowns(self) -> int:
        """Nodal values that the supports leave free, and two shear strains in each Timoshenko element."""
        return (4 if self.shear else 2) * self.n_elements + 2 - sum(sum(HOLDS[end]) for end in self.beam.supports)

    @cached_property
    def mesh(self) -> Parts:
        """The elements; nodes at steps, masses and springs."""
        pieces = cut_pieces(self.beam)
        return divide(self.beam, self.n_elements, self.grading, pieces if len(pieces) > len(self.beam.pieces) else ())

    def of_elements(self, field: str, scale: float) -> Array:
        """A property of each element's section over `scale`, (N,)."""
        ends = np.cumsum([piece.length for piece in self.beam.pieces])[:-1] / self.unit
        figures = np.array([getattr(piece, field) for piece in self.beam.pieces]) / scale
        return np.asarray(figures[ends.searchsorted(self.mesh.nodes[:-1] + 0.5 * self.mesh.lengths)])

    @cached_property
    def basis(self) -> Any:
        """scikit-fem's basis: w and psi of each node in turn, then the shear strains of each element."""
        from verify.elements.element import cached_basis, line_basis

        nodes = self.mesh.nodes
        return cached_basis(nodes.tobytes(), self.shear) if len(nodes) <= 4000 else line_basis(nodes, self.shear)

    @cached_property
    def free(self) -> Indices:
        """Degrees of freedom that the supports leave, (n,) ascending."""
        names = [
            [name for name, held in zip(("u", "u_x"), HOLDS[end], strict=True) if held] for end in self.beam.supports
        ]
        ends = [self.basis.get_dofs(end).all(held) for end, held in zip(("left", "right"), names, strict=True)]
        return np.delete(np.arange(self.basis.N), np.concatenate(ends))

    # --- Stiffness and mass --------------------------------------------------------------------------------------

    @cached_property
    def system(self) -> StructuralSystem:
        """K = B^T diag(d) B and M over the free degrees of freedom, B in two factors.

        Strains are theta_1 - theta_0 and theta_0 + theta_1 - 2 (w_1 - w_0)/l of each element, whose squares times EI/l
        and 3 EI/l are twice its bending energy; a constant shear strain g_0 adds 2 g_0 to the latter.
        """
        from scipy.sparse import csr_array, vstack

        n, size, lengths = self.n_elements, self.basis.N, self.mesh.lengths
        e, one = np.arange(n), np.ones(n)
        # first factor: differences of neighbouring deflections, which are exact, then all values
        columns, at = np.concatenate([2 * e, 2 * e + 2, np.arange(size)]), np.concatenate([e, e, n + np.arange(size)])
        first = csr_array((np.concatenate([-one, one, np.ones(size)]), (at, columns)), shape=(n + size, size))
        left, right, constant = n + 2 * e + 1, n + 2 * e + 3, n + 2 * n + 2 + 2 * e
        chord = [(e, 1.0 / lengths)]
        mean, gradient = [(left, -one), (right, one)], [(left, one), (right, one), (e, -2.0 / lengths)]
        strains, stiffness = [mean, gradient], [self.own_stiffness]
        if self.shear:
            strains = [mean, [*gradient, (constant, 2.0 * one)], [(constant, one)], [(constant + 1, one)]]
        if self.beam.tension:
            # w'^2 has the mean chord^2 + mean^2/12 + gradient^2/20
            force = self.beam.tension * self.unit**2 / self.beam.bending_stiffness * lengths
            strains, stiffness = [*strains, chord, mean, gradient], [*stiffness, force, force / 12.0, force / 20.0]
        places, values = zip(*(entry for strain in strains for entry in strain), strict=True)
        at = np.concatenate([i * n + e for i, strain in enumerate(strains) for _ in strain])
        rows = [csr_array((np.concatenate(values), (at, np.concatenate(places))), shape=(len(strains) * n, n + size))]
        for row, value in self._foundation_and_spring_strains():
            rows.append(csr_array((row.data, row.indices + n, row.indptr), shape=(row.shape[0], n + size)))
            stiffness.append(value)
        mass, bodies = self._mass(), self._bodies()
        return StructuralSystem(
            [first[:, self.free], vstack(rows, format="csr") if len(rows) > 1 else rows[0]],
            np.concatenate(stiffness),
            (mass if bodies is None else mass + bodies.T @ bodies).tocsr()[self.free][:, self.free].tocsc(),
            self._rigid(),
            self._lower_bound(),
            None if bodies is None else bodies[:, self.free],
        )

    @property
    def own_stiffness(self) -> Array:
        """D of the elements' own strains, (2N,) or (4N,), read off what scikit-fem assembles.

        Between its two nodes K has one element alone: -4 d_1 / l^2 for the deflections, d_1 - d_0 for the slopes.
        """
        from verify.elements import element as el

        n, unit, stiffness = self.n_elements, self.unit, self.beam.bending_stiffness
        bending = el.assemble(self.basis, el.bending, self.mesh.stiffnesses)[: 2 * n + 2, : 2 * n + 2]
        between = bending.diagonal(2)
        gradient = -0.25 * self.mesh.lengths**2 * between[::2]
        own = [gradient - between[1::2], gradient]
        if self.shear:
            shear = self.of_elements("shear_stiffness", stiffness / unit**2)
            shear = np.minimum(shear, RIGID * self.mesh.stiffnesses.max())
            inside = el.assemble(self.basis, el.shear, shear).diagonal()[2 * n + 2 :]
            own += [inside[::2], inside[1::2]]
        return np.concatenate(own)

    def _foundation_and_spring_strains(self) -> list[tuple[Any, Array]]:
        """(rows over all values, stiffness of each) of foundation and springs.

        A foundation is read at four points of Gauss in each element, which integrate the square of a cubic.
        """
        beam, nodes, lengths, scale = (
            self.beam,
            self.mesh.nodes,
            self.mesh.lengths,
            self.unit / self.beam.bending_stiffness,
        )
        found = []
        if beam.foundation:
            points, weights = np.polynomial.legendre.leggauss(4)
            x = (nodes[:-1, None] + lengths[:, None] * (0.5 + 0.5 * points)).ravel()
            shares = (lengths[:, None] * 0.5 * weights).ravel()
            found.append((self._rows(x), beam.foundation * self.unit**3 * scale * shares))
        for spring in beam.spring:
            at = np.array([spring.position / self.unit])
            for value, rotation in ((spring.stiffness * self.unit**2, False), (spring.rotational, True)):
                if value:
                    most = RIGID * self.mesh.stiffnesses.max()
                    found.append((self._rows(at, rotation=rotation), np.array([min(value * scale, most)])))
        return found

    def _mass(self) -> Any:
        """M of the elements over all degrees of freedom by scikit-fem, with rotary inertia."""
        from verify.elements import element as el

        mass = el.assemble(self.basis, el.inertia, self.mesh.masses_per_length)
        if self.theory != "euler-bernoulli":
            rotary = self.of_elements("rotary_inertia", self.beam.mass_per_length * self.unit**2)
            mass = mass + el.assemble(self.basis, el.rotary_inertia, rotary)
        return mass

    def _bodies(self) -> Any:
        """Rows (r, all degrees of freedom) whose squares are the masses and rotary inertias of attached bodies."""
        from scipy.sparse import vstack

        beam, unit = self.beam, self.unit
        rows = [
            sqrt(value / beam.mass_per_length) * self._rows(np.array([body.position / unit]), rotation=rotation)
            for body in beam.mass
            for value, rotation in ((body.mass / unit, False), (body.rotary_inertia / unit**3, True))
            if value
        ]
        return vstack(rows, format="csr") if rows else None

    def _rigid(self) -> Array:
        """Rigid motions over the free degrees of freedom, (n, 0 to 2)."""
        lines, nodes = self.beam.rigid_lines, self.mesh.nodes
        shapes = np.zeros((self.basis.N, len(lines)))
        for j, (a, b) in enumerate(lines):
            shapes[: 2 * len(nodes) : 2, j] = a / self.unit + b * nodes if b else a
            shapes[1 : 2 * len(nodes) : 2, j] = b
        return shapes[self.free]

    def _lower_bound(self) -> float:
        """Lower bound k_f / (rho A) of omega^2 by the foundation, without attached bodies; 0 under compression."""
        beam = self.beam
        if not beam.foundation or beam.tension < 0.0 or self.theory != "euler-bernoulli":
            return 0.0
        return beam.foundation * self.unit**4 / beam.bending_stiffness / float(self.mesh.masses_per_length.max())

    def lossy_stiffness(self, omega: float) -> Any:
        """D with the beam's loss factor on its own bending and shear, (m,)."""
        stiffness, own = self.system.stiffness, (4 if self.shear else 2) * self.n_elements
        if not self.beam.loss_factor:
            return stiffness
        return np.concatenate([stiffness[:own] * (1.0 + 1j * self.beam.loss_factor), stiffness[own:]])

    # --- Readings ------------------------------------------------------------------------------------------------

    def _rows(self, x: Array, derivative: int = 0, *, rotation: bool = False) -> Any:
        from verify.elements.element import rows

        return rows(self.mesh.nodes, x, self.shear, derivative, rotation=rotation)

    def load_rows(self, positions: Array, *, rotation: bool = False) -> Any:
        """Weights of the free degrees of freedom at positions in m, sparse (n_positions, n)."""
        return self._rows(np.asarray(positions) / self.unit, rotation=rotation)[:, self.free]

    def _polynomials(self, unknowns: Any) -> Any:
        """Deflection and rotation of unknowns (n, k) as piecewise polynomials of x in m."""
        from verify.elements.element import piecewise

        values = np.zeros((self.basis.N, unknowns.shape[1]), dtype=unknowns.dtype)
        values[self.free] = unknowns
        return piecewise(self.mesh.nodes, values, self.unit)

    def line(self, unknowns: Any) -> Callable[[Array, int], Any]:
        """The elements' own cubics, (x in m, derivative) -> (k, len(x)); at a node the element on its right."""
        deflection = self._polynomials(unknowns)[0]
        return lambda x, derivative: np.ascontiguousarray(deflection(x, derivative).T)

    def rotation_line(self, unknowns: Any) -> Callable[[Array, int], Any] | None:
        """The rotation of Timoshenko elements likewise; None where it is the slope."""
        if not self.shear:
            return None
        rotation = self._polynomials(unknowns)[1]
        return lambda x, derivative: np.ascontiguousarray(rotation(x, derivative).T)

    def leading_sign(self, vectors: Array) -> Array:
        """+-1 for each mode: by the first of deflection, slope, curvature that the left end leaves free."""
        clamped = self.beam.supports[0] == "clamped"
        leading = (self._rows(np.zeros(1), 2)[:, self.free] @ vectors)[0] if clamped else vectors[0]
        return np.where(leading < 0.0, -1.0, 1.0)

    def modes_of(self, vectors: Array) -> dict[str, Any]:
        """Nodes, five points and two points of Gauss, where the curvature is of order 4, in each element."""
        nodes, lengths, unit = self.mesh.nodes, self.mesh.lengths, self.unit
        inside = [(nodes[:-1, None] + lengths[:, None] * xi).ravel() * unit
                  for xi in (np.arange(4) / 4.0, 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0))]  # fmt: skip
        points = np.append(inside[0], nodes[-1] * unit)
        ends = np.minimum(nodes * unit, self.beam.length)
        return {
            "nodes": ends,
            "readings": {"nodal": lambda: self.line(vectors)(ends, 0)},
            "points": points,
            "sampled": lambda: self.line(vectors)(points, 0),
            "curvature_points": inside[1],
            "curvatures": lambda: self.line(vectors)(inside[1], 2),
        }

    def time_line(self, vectors: Array, line: str) -> dict[str, Any]:
        """The cubics of all modes for motion in time, right-continuous at nodes."""
        fields = {"shapes": self.line(vectors), "edges": self.mesh.nodes * self.unit, "degree": 3}
        if self.shear and self.beam.mass:
            at = np.array([mass.position for mass in self.beam.mass])
            fields["turns"] = lambda: (self.load_rows(at, rotation=True) @ vectors).T / self.unit
        return fields

    # --- Constants -----------------------------------------------------------------------------------------------

    def expected_order(self) -> int:
        """Nodes are at steps, masses and springs: order 4."""
        return 4

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber of waves along equal elements of the beam's own section, 1/m; of the exact beam in other cases.

        The determinant of both nodal equations is a quadratic in s^2 = sin^2(k l/2), m = omega^2 rho A l^4 / 420 EI:
        ((48 + 216 m) s^2 - 420 m) (12 - 2 m - (8 + 12 m) s^2) = 4 s^2 (1 - s^2) (12 + 26 m)^2.
        """
        if self.theory != "euler-bernoulli" or self.beam.tension or self.beam.foundation:
            return super().wavenumber(frequency_hz)
        m = (2.0 * pi * frequency_hz / self._omega_unit) ** 2 / (420.0 * (1.0 + 1j * self.beam.loss_factor))
        a, b, c = 192.0 + (192.0 + 112.0 * m) * m, (3360.0 + 1904.0 * m) * m, (5040.0 - 840.0 * m) * m
        # the lower branch, without a difference of large numbers
        k = complex(2.0 * np.arcsin(np.sqrt(2.0 * c / (b + np.sqrt(b * b + 4.0 * a * c + 0j)))) / self.unit)
        return k if k.imag <= 0.0 else k.conjugate()

    def check_propagates(self, frequency_hz: float) -> None:
        """Raise NoFigureError at and beyond omega^2 = (1680/17) EI/(rho A l^4), a half wave on each element."""
        n, of_one = self.n_elements, sqrt(1680.0 / 17.0) * self.beam.wave_constant / (2.0 * pi * self.beam.length**2)
        if frequency_hz >= of_one * n**2:
            raise NoFigureError(
                f"count = {n}: {n} elements carry waves up to {of_one * n**2:.6g} Hz and frequency_hz = "
                f"{frequency_hz!r} lies beyond, give count = {int(sqrt(frequency_hz / of_one)) + 1} or more"
            )
