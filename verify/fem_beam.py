"""The finite-element model of a beam: cubic Hermite elements, or Timoshenko elements, by scikit-fem.

scikit-fem defines mesh and degrees of freedom and assembles stiffness and mass. Rounding in the assembled K costs the
low eigenvalues digits like N^4; so the stiffness d of every element strain (mean curvature, its gradient, two shear
strains) is extracted from its entries, and K = B^T diag(d) B stays factored, B a product of two difference operators.

Elements end at the steps of the beam and at masses and springs. The shear force jumps at a mass, the moment at a rotary
inertia, and the linear curvature of a cubic cannot represent a jump inside an element: frequencies are then of order 3
(mass) or 1 (rotary inertia), with a node at the attachment of order 4. Lengths are in mean element lengths L/N: nodes
of equal elements are integers, exact at any N.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, Curve, Indices, Numeric, Sparse
from verify.linear.discrete import DiscreteModel
from verify.linear.factored import sparse_rows
from verify.linear.mesh import Parts, check_division, cut_pieces, divide
from verify.linear.surface import section_at
from verify.linear.system import StructuralSystem
from verify.problem.beam import Beam, rigid_lines, with_attachments
from verify.problem.supports import FIXED
from verify.settings import DEFAULT, Theory
from verify.validation import MOST_PARTS, check_integer

RIGID = 1e14  # largest stiffness relative to that of an element: above it frequencies change by less than 1e-13


@dataclass(frozen=True)
class HermiteModel(DiscreteModel):
    """A beam of `n_elements` elements with consistent mass; its frequencies are upper bounds of order 4.

    `grading` is the length of a section's last element over its first. Theories: `euler-bernoulli`, `rayleigh` (rotary
    inertia), `timoshenko` (rotary inertia and shear). Raises InputError for fewer elements than sections, a size that
    exceeds the memory, and missing section properties.
    """

    beam: Beam
    n_elements: int
    grading: float = DEFAULT.grading
    theory: Theory = DEFAULT.theory

    name = "fem"
    parts = "elements"
    title = "Hermite elements"
    colour = "#e8760c"
    bounds = "above"
    library = "scikit-fem"

    def __post_init__(self) -> None:
        check_integer("n_elements", self.n_elements, 1, MOST_PARTS)
        super().__post_init__()
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
        """Number of free nodal values, and of two shear strains in each Timoshenko element."""
        return (4 if self.shear else 2) * self.n_elements + 2 - sum(sum(FIXED[end]) for end in self.beam.supports)

    @cached_property
    def mesh(self) -> Parts:
        """The elements, with nodes at steps, masses and springs."""
        pieces = cut_pieces(self.beam)
        return divide(self.beam, self.n_elements, self.grading, pieces if len(pieces) > len(self.beam.pieces) else ())

    @cached_property
    def basis(self) -> Any:
        """scikit-fem's basis: w and psi of each node in turn, then the shear strains of each element."""
        from verify.elements.element import cached_basis, line_basis

        nodes = self.mesh.nodes
        return cached_basis(nodes.tobytes(), self.shear) if len(nodes) <= 4000 else line_basis(nodes, self.shear)

    @cached_property
    def unknowns(self) -> Indices:
        """Index of each degree of freedom among the unknowns, (n_all,); -1 where a support prevents it."""
        ends = [
            2 * self.n_elements * i + j for i, end in enumerate(self.beam.supports) for j in (0, 1) if FIXED[end][j]
        ]
        free = np.delete(np.arange((4 if self.shear else 2) * self.n_elements + 2), ends)
        unknowns = np.full(len(free) + len(ends), -1)
        unknowns[free] = np.arange(len(free))
        return unknowns

    # --- Stiffness and mass --------------------------------------------------------------------------------------

    @cached_property
    def system(self) -> StructuralSystem:
        """K = B^T diag(d) B and M over the free degrees of freedom, B in two factors.

        The strains of an element are theta_1 - theta_0 and theta_0 + theta_1 - 2 (w_1 - w_0)/l; their squares times
        EI/l and 3 EI/l are twice its bending energy. A constant shear strain g_0 adds 2 g_0 to the second strain.
        """
        from scipy.sparse import csr_array, vstack

        n, free, lengths, every = self.n_elements, self.n_unknowns, self.mesh.lengths, self.unknowns
        # first factor: differences of neighbouring deflections, exact in floating point, then all unknowns
        e, single = np.arange(n), np.arange(free)
        ends = np.concatenate([np.stack([every[2 * e], every[2 * e + 2]], 1), np.stack([single, single], 1)])
        signs = np.repeat([[-1.0, 1.0], [1.0, 0.0]], [n, free], axis=0)
        # second: strains of the elements, each a list of (column, value)
        columns = np.where(every < 0, -1, n + every)
        left, right, constant = columns[2 * e + 1], columns[2 * e + 3], columns[2 * n + 2 :: 2]
        mean, chord = [(left, -1.0), (right, 1.0)], [(e, 1.0 / lengths)]
        gradient: list[Any] = [(left, 1.0), (right, 1.0), (e, -2.0 / lengths)]
        strains: list[list[Any]] = [mean, gradient]
        stiffness = [self.strain_stiffness]
        if self.shear:
            strains = [mean, [*gradient, (constant, 2.0)], [(constant, 1.0)], [(constant + 1, 1.0)]]
        if self.beam.tension:
            # w'^2 has the mean chord^2 + mean^2/12 + gradient^2/20
            force = self._tension * lengths
            strains += [chord, mean, gradient]
            stiffness += [force, force / 12.0, force / 20.0]
        places, values = np.full((len(strains), n, 4), -1), np.zeros((len(strains), n, 4))
        for i, strain in enumerate(strains):
            for j, (place, value) in enumerate(strain):
                places[i, :, j], values[i, :, j] = place, value
        rows = [sparse_rows(places.reshape(-1, 4), values.reshape(-1, 4), n + free)]
        for row, value in self._foundation_and_spring_strains():
            rows.append(csr_array((row.data, row.indices + n, row.indptr), shape=(row.shape[0], n + free)))
            stiffness.append(value)
        mass, bodies, bound = self._mass(), self._bodies(), 0.0
        if self.beam.foundation and self.beam.tension >= 0.0 and self.theory == "euler-bernoulli":
            bound = self._foundation / float(self.mesh.masses_per_length.max())  # k_f / (rho A), without bodies
        return StructuralSystem(
            [sparse_rows(ends, signs, free), vstack(rows, format="csr") if len(rows) > 1 else rows[0]],
            np.concatenate(stiffness),
            mass if bodies is None else (mass + bodies.T @ bodies).tocsc(),
            self._rigid(),
            bound,
            bodies,
        )

    @property
    def strain_stiffness(self) -> Array:
        """Stiffness d of the element strains, (2N,) or (4N,), from the element matrices of scikit-fem.

        K of an element has -4 d_1 / l^2 between its deflections and d_1 - d_0 between its slopes.
        """
        from verify.elements import element as el

        stiffness = self.beam.bending_stiffness / self.unit**2
        bending = el.element_matrices(self.basis, el.bending, self.mesh.stiffnesses).tolocal()
        gradient = -0.25 * self.mesh.lengths**2 * bending[:, 0, 2]
        stiffnesses = [gradient - bending[:, 1, 3], gradient]
        if self.shear:
            shear = np.minimum(self.mesh.of("shear_stiffness") / stiffness, RIGID * self.mesh.stiffnesses.max())
            inside = el.element_matrices(self.basis, el.shear, shear).tolocal()
            stiffnesses += [inside[:, 4, 4], inside[:, 5, 5]]
        return np.concatenate(stiffnesses)

    def _foundation_and_spring_strains(self) -> list[tuple[Any, Array]]:
        """(strain rows over the unknowns, their stiffness) of foundation and springs.

        Four Gauss points per element integrate the foundation's energy, the square of a cubic, exactly.
        """
        beam, nodes, lengths, strains = self.beam, self.mesh.nodes, self.mesh.lengths, []
        scale = self.unit / beam.bending_stiffness
        if beam.foundation:
            points, weights = np.polynomial.legendre.leggauss(4)
            x = (nodes[:-1, None] + lengths[:, None] * (0.5 + 0.5 * points)).ravel()
            shares = (lengths[:, None] * 0.5 * weights).ravel()
            strains.append((self._rows(x), self._foundation * shares))
        for attachment in beam.attached:
            at = np.array([attachment.position / self.unit])
            for value, rotation in ((attachment.stiffness * self.unit**2, False), (attachment.rotational, True)):
                if value:
                    most = RIGID * self.mesh.stiffnesses.max()
                    strains.append((self._rows(at, rotation=rotation), np.array([min(value * scale, most)])))
        return strains

    def _mass(self) -> Sparse:
        """Mass matrix M of the elements over the unknowns by scikit-fem, with rotary inertia."""
        from scipy.sparse import csc_array

        from verify.elements import element as el

        mass = el.element_matrices(self.basis, el.inertia, self.mesh.masses_per_length)
        data, (rows, columns) = mass.data, self.unknowns[mass.indices]
        if self.theory != "euler-bernoulli":
            rotary = self.mesh.of("rotary_inertia") / (self.beam.mass_per_length * self.unit**2)
            data = data + el.element_matrices(self.basis, el.rotary_inertia, rotary).data
        free = (rows >= 0) & (columns >= 0)
        return csc_array((data[free], (rows[free], columns[free])), shape=(self.n_unknowns,) * 2)

    def _bodies(self) -> Sparse | None:
        """Rows R (r, n) of attached bodies: R^T R is their part of M."""
        from scipy.sparse import vstack

        beam, unit = self.beam, self.unit
        rows = [
            sqrt(value / beam.mass_per_length) * self._rows(np.array([body.position / unit]), rotation=rotation)
            for body in beam.attached
            for value, rotation in ((body.mass / unit, False), (body.rotary_inertia / unit**3, True))
            if value
        ]
        return vstack(rows, format="csr") if rows else None

    def _rigid(self) -> Array:
        """Rigid motions, (n, 0 to 2)."""
        lines, nodes = rigid_lines(self.beam), self.mesh.nodes
        shapes = np.zeros((len(self.unknowns), len(lines)))
        for j, (a, b) in enumerate(lines):
            shapes[: 2 * len(nodes) : 2, j] = a / self.unit + b * nodes if b else a
            shapes[1 : 2 * len(nodes) : 2, j] = b
        return shapes[self.unknowns >= 0]

    def lossy_stiffness(self, omega: float) -> Numeric:
        """Stiffness d with the beam's loss factor on bending and shear, (m,)."""
        stiffness, strains = self.system.stiffness, (4 if self.shear else 2) * self.n_elements
        if not self.beam.loss_factor:
            return stiffness
        return np.concatenate([stiffness[:strains] * (1.0 + 1j * self.beam.loss_factor), stiffness[strains:]])

    # --- Readings ------------------------------------------------------------------------------------------------

    def _rows(self, x: Array, derivative: int = 0, *, rotation: bool = False) -> Sparse:
        from verify.elements.element import rows

        return rows(self.mesh.nodes, x, self.unknowns, derivative, rotation=rotation)

    def load_rows(self, positions: Array, *, rotation: bool = False) -> Sparse:
        """Shape functions of the unknowns at positions (m), sparse (n_positions, n)."""
        return self._rows(np.asarray(positions) / self.unit, rotation=rotation)

    def _read(self, unknowns: Numeric, which: int) -> Curve:
        """Deflection (which = 0) or rotation (1) of unknowns (n, k); at a node that of the right element."""

        @cache
        def polynomials() -> Any:
            from verify.elements.element import piecewise

            values = np.zeros((len(self.unknowns), unknowns.shape[1]), dtype=unknowns.dtype)
            values[self.unknowns >= 0] = unknowns
            return piecewise(self.mesh.nodes, values, self.unit)[which]

        return lambda x, derivative: np.ascontiguousarray(polynomials()(x, derivative).T)

    def line(self, unknowns: Numeric) -> Curve:
        """Deflection by the cubics of the elements: (x in m, derivative) -> (k, len(x))."""
        return self._read(unknowns, 0)

    def rotation_line(self, unknowns: Numeric) -> Curve | None:
        """Section rotation of Timoshenko elements: (x in m, derivative) -> (k, len(x)); None without shear."""
        return self._read(unknowns, 1) if self.shear else None

    def leading_sign(self, vectors: Array) -> Array:
        """+-1 for each mode: the sign of the first of deflection, slope, curvature that is free at the left end."""
        clamped = self.beam.supports[0] == "clamped"
        leading = (self._rows(np.zeros(1), 2) @ vectors)[0] if clamped else vectors[0]
        return np.where(leading < 0.0, -1.0, 1.0)

    def modes_of(self, vectors: Array) -> dict[str, Any]:
        """Fields of `Modes`: nodes, even points, and two Gauss points per element, at which curvature is of order 4."""
        nodes, lengths, unit = self.mesh.nodes, self.mesh.lengths, self.unit
        fractions = np.arange(4) / 4.0, 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
        inside = [(nodes[:-1, None] + lengths[:, None] * xi).ravel() * unit for xi in fractions]
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
        """Cubics of all modes for motion in time, right-continuous at nodes."""
        fields = {"shapes": self.line(vectors), "edges": self.edges, "degree": 3}
        if self.shear and self.beam.attached:
            at = np.array([attachment.position for attachment in self.beam.attached])
            fields["turns"] = lambda: (self.load_rows(at, rotation=True) @ vectors).T / self.unit
        return fields

    @property
    def edges(self) -> Array:
        """Nodes, (N + 1,), m."""
        return self.mesh.nodes * self.unit

    # --- Constants -----------------------------------------------------------------------------------------------

    def expected_order(self) -> int:
        """Order 4, since nodes are at steps, masses and springs."""
        return 4

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber along equal elements of the beam's own section, 1/m; in other cases that of the exact beam.

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

    @cached_property
    def cut_off_hz(self) -> float:
        """Cut-off frequency, Hz: half a wavelength on the element with the lowest one.

        omega^2 = (1680/17) EI/(rho A l^4) without tension, foundation or shear; in other cases that of one element
        whose ends move in opposite phase.
        """
        beam = self.beam
        if self.theory == "euler-bernoulli" and not (beam.section or beam.tension or beam.foundation):
            # scene validation calls it: neither scipy nor scikit-fem is imported
            return float(np.sqrt(1680.0 / 17.0) * self._omega_unit / (2.0 * pi) / self.mesh.lengths.max() ** 2)
        from scipy.linalg import eigh

        limits, last = list[float](), np.cumsum(self.mesh.shares) - 1
        for first, stop in zip([0, *(last[:-1] + 1)], last + 1, strict=True):
            lengths = self.mesh.lengths[first:stop]
            section = section_at(self.beam, self.mesh.nodes[first] * self.unit)
            element = replace(with_attachments(section), length=lengths.max() * self.unit, supports=("free", "free"))
            model = HermiteModel(element, 1, theory=self.theory)
            system, opposite = model.system, np.eye(model.n_unknowns)[:, [0, 1, *range(4, model.n_unknowns)]]
            opposite[[2, 3], [0, 1]] = -1.0
            strain, mass = system.strain(opposite), opposite.T @ (system.mass @ opposite)
            value = eigh(strain.T @ (system.stiffness[:, None] * strain), mass, eigvals_only=True)[0]
            limits.append(float(np.sqrt(max(value, 0.0))) * model._omega_unit / (2.0 * pi))
        return min(limits)
