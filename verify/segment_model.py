"""The finite-segment model of a beam (Section II.A of the paper): rigid links, revolute joints and their springs.

A beam of N links has N + 1 joints. A rotational spring at the joint of links i and j, two half links in series, has

    k_ij = 2 E_i I_i E_j I_j / (E_i I_i l_j + E_j I_j l_i),    k = EI / l for identical links.    (1), (2)

The paper has no clamped end. At a clamped end the compliances of the first three joints are l/EI times 3/8, 7/6, 23/24
(Gregory's end correction, `segments.walls`). A link has mass m and inertia m l^2/12 about its middle. For small motion
about the straight chain the unknowns are the transverse positions y of the joints that the supports leave free; the
rotation of a link is the difference of its joint positions over l.

A joint's angle is l times the mean curvature of the beam around it, and the second difference of a deflection w is l^2
w'' + l^4 w''''/12: the beam's deflection at the joint is w = y + l^2 y''/12, order 4 (`segments.reading`). The contact
line is a C2 spline through these corrected positions on the neutral line, and the surface moves by u_x = -(h/2) w'.
The paper (Section II.B) interpolates uncorrected upper corners of the links and the velocities of the joints.

Unknowns are dimensionless: lengths in `unit` = L/N, stiffnesses in EI, masses in rho A unit.
"""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, replace
from math import pi
from typing import Any, ClassVar, Literal

import msgspec
import numpy as np

from verify.arrays import Array
from verify.engines.description import RigidChain, rigid_chain
from verify.errors import InputError
from verify.linear.mesh import check_division
from verify.problem.beam import Beam
from verify.segments import shear
from verify.segments.attachments import attachment_weights, joint_weights
from verify.segments.chain import link_inertia, right_of
from verify.segments.dispersion import cut_off2, phase
from verify.segments.orders import order_of
from verify.segments.reading import corrected_reading, line_through, rigid_links
from verify.segments.structure import ChainStructure
from verify.settings import DEFAULT, WALLS, Attachment, Joints, Load, ModelSettings, Reading, Theory, Wall
from verify.validation import MOST_PARTS, check_integer, python_scalar

_FEWEST_CORRECTED = 6
"""Smallest N for which the mass matrix with tensioned Timoshenko joints is positive definite at all supports."""
_PASSES, _CONVERGED = 60, 1e-13
"""Iteration limit and relative tolerance of the buckling load of tensioned joints, which depend on it."""


@dataclass(frozen=True)
class SegmentModel(ChainStructure):
    """A beam of `n_segments` rigid links with the settings of `verify.settings`, the table of their choices.

    Raises InputError for unknown and contradictory settings.
    """

    name: ClassVar[str] = "segment"
    parts: ClassVar[str] = "segments"
    title: ClassVar[str] = "segments"
    colour: ClassVar[str] = "#2f80ed"
    bounds: ClassVar[Literal["below", "above"] | None] = "below"
    fewest: ClassVar[int] = 2
    lines: ClassVar[tuple[str, ...]] = ("spline", "raw")

    beam: Beam
    n_segments: int
    _: KW_ONLY
    wall: Wall = DEFAULT.wall
    joints: Joints = DEFAULT.joints
    grading: float = DEFAULT.grading
    """Length of a section's last link over its first; lengths are in geometric progression."""
    theory: Theory = DEFAULT.theory
    attachment: Attachment = DEFAULT.attachment
    load: Load = DEFAULT.load
    reading: Reading = DEFAULT.reading
    joint_dashpot: float = DEFAULT.joint_dashpot
    """c of a dashpot at every joint, N m s, in harmonic motion."""

    def __post_init__(self) -> None:
        for name in ("n_segments", "grading", "joint_dashpot"):
            object.__setattr__(self, name, python_scalar(getattr(self, name)))
        check_integer("n_segments", self.n_segments, self.fewest, MOST_PARTS)
        super().__post_init__()
        check_division(self.beam, self.n_segments, self.grading)
        if WALLS[self.wall].first and (self.beam.features or self.grading != 1.0 or self.theory != "euler-bernoulli"):
            raise InputError(
                f"wall = {self.wall!r} is for uniform beams of equal segments without attachments: choose another wall"
            )
        if self.joints == "tensioned" and self.theory == "timoshenko" and self.n_segments < _FEWEST_CORRECTED:
            raise InputError(
                f"n_segments = {self.n_segments}: joints = 'tensioned' with theory = 'timoshenko' take "
                f"{_FEWEST_CORRECTED} or more, raise it or choose joints = 'series'"
            )
        self.check_memory()

    @property
    def count(self) -> int:
        """N."""
        return self.n_segments

    def rigid_chain(self, *, in_space: bool = False, damping: float = 0.0) -> RigidChain:
        """Joints in N m/rad, links with mass and inertia, in plain units, for other engines (`engines.writers`).

        `damping`: damping ratio of mode 1. Raises InputError for settings other than `wall`, and as `describe` does.
        """
        plain = SegmentModel(self.beam, self.n_segments, wall=self.wall, attachment=self.attachment)
        if replace(self, load=plain.load, reading=plain.reading) != plain:
            raise InputError("joints, grading, theory, joint_dashpot: a rigid chain has their defaults, leave them out")
        return rigid_chain(SegmentModel, self.beam, self.n_segments, self.wall, in_space, damping)

    # --- Loads and readings --------------------------------------------------------------------------------------

    def load_rows(self, positions: Array, *, rotation: bool = False) -> Any:
        """Weights of the unknowns by `load`; a couple has the weights of an attachment."""
        from scipy.sparse import vstack

        if not rotation:
            return joint_weights(self.chain, positions, self.load) @ self.motions.positions
        ends = {body.position: body.end for body in self.attached.at_ends if body.rotary_inertia}
        each = [
            self.motions.end_rotations[[ends[position]]]
            if position in ends
            else attachment_weights(self.chain, [float(position)], self.load)[1] @ self.motions.rotations
            for position in positions
        ]
        return vstack(each, format="csr")

    def device_rows(self, positions: Array) -> Any:
        """Weights of an attached body, order 4: those of a force omit its compliance at its own position, order 3."""
        from scipy.sparse import vstack

        weights = [attachment_weights(self.chain, [at], self.attachment)[0] for at in positions.tolist()]
        return vstack(weights, format="csr") @ self.motions.positions

    def _joints(self, unknowns: Any) -> Any:
        """Positions of joints 0..N, (k, N + 1), from unknowns (n, k)."""
        return (self.motions.positions @ unknowns).T

    def _corrected(self, unknowns: Any) -> Any:
        """The beam's deflection at joints 0..N, (k, N + 1), from unknowns (n, k)."""
        if self.theory != "timoshenko":
            return corrected_reading(self.chain, self._joints(unknowns))
        change = shear.shear_change(self.motions, self._shear_compliances, unknowns)
        return corrected_reading(self.chain, self._joints(unknowns), (self.motions.rotations @ unknowns).T, change)

    def line(self, unknowns: Any) -> Callable[[Array, int], Any]:
        """The C2 spline through the joints, or the links, by `reading`."""
        if self.reading == "links":
            return self._links(unknowns)
        read = self._corrected if self.reading == "corrected" else self._joints
        return line_through(self.chain, lambda: read(unknowns), slipping=self.theory == "timoshenko")

    def _links(self, unknowns: Any, *, both_sides: bool = True) -> Callable[[Array, int], Any]:
        middles, rotations = ((m @ unknowns).T for m in (self.motions.middles, self.motions.rotations))
        return rigid_links(self.chain, middles, rotations / self.unit, both_sides=both_sides)

    def rotation_line(self, unknowns: Any) -> Callable[[Array, int], Any] | None:
        """The rotation of the section under Timoshenko's theory."""
        if self.theory != "timoshenko":
            return None
        if self.reading == "links":
            links = self._links(unknowns)
            return lambda x, derivative: links(x, derivative + 1)
        corrected = self.reading == "corrected"
        factors, fraction = self._wall_factors, self._beam_fraction
        return shear.section_rotation(self.motions, factors, fraction, unknowns, corrected=corrected)

    def leading_sign(self, vectors: Array) -> Array:
        """Sign of the first free joint's position."""
        return np.asarray(np.where(vectors[0] < 0.0, -1.0, 1.0))

    def modes_of(self, vectors: Array) -> dict[str, Any]:
        """Fields of `Modes`: joints as nodes, their readings, and the curvature M/EI of every joint's moment."""

        def curvatures() -> Array:
            sprung, bent = self._springs, np.zeros((vectors.shape[1], self.n_segments + 1))
            share = self._beam_fraction / (right_of(self.links.stiffnesses) * self._beam_compliances)
            bent[:, sprung] = self.system.strain(vectors)[: len(sprung)].T * share[sprung]
            if self.theory == "timoshenko":
                values = self.system.rayleigh_quotients(vectors)
                joints = self._corrected(vectors)
                bent += shear.modal_shear_change(self.chain, self._shears, self._foundation, joints, values)
            return np.asarray(bent / self.unit**2)

        readings = {"corrected": lambda: self._corrected(vectors), "raw": lambda: self._joints(vectors)}
        nodes = np.clip(self.chain.nodes, 0.0, self.beam.length)
        places = dict.fromkeys(("nodes", "points", "curvature_points"), nodes)
        return places | {"readings": readings, "sampled": readings["corrected"], "curvatures": curvatures}

    def time_line(self, vectors: Array, line: str) -> dict[str, Any]:
        """Contact line through the corrected joints, or the "raw" links, and rotations of attached masses."""
        if self.reading != "corrected":
            raise InputError(
                f"reading = {self.reading!r} is for harmonic fields: for motion in time give line = 'spline' "
                "(corrected joints) or 'raw' (rigid links)"
            )
        if self.joint_dashpot:
            raise InputError(
                f"joint_dashpot = {self.joint_dashpot!r} is for harmonic fields: for motion in time leave it out or "
                "give the beam a loss_factor"
            )
        index = {body.position: i for i, body in enumerate(self.attached.bodies)}

        def rotations() -> Array:
            rows = self._rotations[[index[mass.position] for mass in self.beam.mass]]
            return np.asarray((rows @ self.motions.both @ vectors).T / self.unit)

        raw = line == "raw"
        shapes = (
            self._links(vectors, both_sides=False)
            if raw
            else line_through(self.chain, lambda: self._corrected(vectors), slipping=self.theory == "timoshenko")
        )
        turns = rotations if self.beam.mass else None
        return {"shapes": shapes, "edges": self.edges, "degree": 1 if raw else 3, "turns": turns}

    @property
    def edges(self) -> Array:
        """Joints, (N + 1,), m."""
        return self.chain.nodes

    # --- Buckling, order, waves ----------------------------------------------------------------------------------

    def buckling_load(self) -> float:
        """Lowest buckling load of the chain in compression, N; the beam's own axial force is ignored.

        Between pinned ends (4 EI/l^2) sin^2(pi/(2N)), order 2; with tensioned joints order 4.
        """
        force = 0.0 if self._tilts else self.beam.bending_stiffness / self.beam.length**2
        for _ in range(_PASSES if force else 0):
            compressed = msgspec.structs.replace(self.beam, tension=-force)
            factor = replace(self, beam=compressed, theory="euler-bernoulli").system.buckling_factor()
            force *= factor
            if self.joints != "tensioned" or abs(factor - 1.0) < _CONVERGED:
                break
        return force

    def expected_order(self) -> int | None:
        """Order of the frequencies in N (`segments.orders`); None where it depends on N."""
        return order_of(self.beam, **{name: getattr(self, name) for name in ModelSettings.__struct_fields__})

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber of waves along equal links of the beam's own section, 1/m, with the losses of the joints."""
        omega, section, loss = 2.0 * pi * frequency_hz, self.beam.base_section, 1.0 + 1j * self.beam.loss_factor
        rigidity, inertia = section.shear_stiffness or 0.0, section.rotary_inertia or 0.0
        k = phase(
            (omega / self._omega_unit) ** 2,
            loss + 1j * self.joint_dashpot * omega * self.unit / self.beam.bending_stiffness,
            self.beam.bending_stiffness / (rigidity * self.unit**2 * loss) if self.theory == "timoshenko" else 0.0,
            spin=self._thick * inertia / (self.beam.mass_per_length * self.unit**2),
            tension=self._tension,
            foundation=self._foundation,
            tensioned=self.joints == "tensioned",
        )
        return (k if k.imag <= 0.0 else k.conjugate()) / self.unit

    @property
    def cut_off_hz(self) -> float:
        """Cut-off frequency, Hz: half a wavelength on the link with the lowest one."""
        share = 2.0 / 3.0 if self.joints == "tensioned" else 1.0  # 1 - 4/12: a joint bends twice the link's rotation
        lengths, masses = self.links.lengths, self.links.lengths * self.links.masses_per_length
        inertias = link_inertia(masses, lengths) + (share * self._rotary_inertias if self._thick else 0.0)
        slips, masses = (self._shears, share * masses) if self.theory == "timoshenko" else (np.inf, masses)
        square = cut_off2(
            lengths, self.links.stiffnesses, masses, inertias, slips, share * self._tension, self._foundation
        )
        return float(np.sqrt(square)) * self._omega_unit / (2.0 * pi)
