"""Bodies and springs on a chain: by weights of joints and links inside, behind an elastic joint at an end."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from verify.arrays import Array, BoolArray, Sparse
from verify.problem.beam import Beam
from verify.segments.chain import Motions, selection


class Body(NamedTuple):
    """Sum of the attachments at one position (m), dimensionless."""

    position: float
    end: int | None = None  # the end, 0 or 1, behind whose joint the body is
    mass: float = 0.0
    rotary_inertia: float = 0.0
    stiffness: float = 0.0
    rotational: float = 0.0


@dataclass(frozen=True, eq=False)
class Attached:
    """Attachments of a beam in lengths of `unit` (m), with `rule` "reciprocal" or "lever"."""

    beam: Beam
    unit: float
    rule: str

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Attached masses and springs, summed at equal positions."""
        mass, stiffness = self.beam.mass_per_length * self.unit, self.beam.bending_stiffness / self.unit**3
        square, bodies = self.unit**2, dict[float, Body]()
        units, ends = (mass, mass * square, stiffness, stiffness * square), {0.0: 0, self.beam.length: 1}
        for attachment in self.beam.attached:
            body = bodies.get(at := attachment.position, Body(at, ends.get(at) if self.rule != "lever" else None))
            values = (attachment.mass, attachment.rotary_inertia, attachment.stiffness, attachment.rotational)
            sums = (a + value / size for a, value, size in zip(body[2:], values, units, strict=True))
            bodies[at] = Body(*body[:2], *sums)
        return tuple(bodies.values())

    @cached_property
    def at_ends(self) -> tuple[Body, Body]:
        """Bodies behind the joints of the left and the right end."""
        left, right = (next((b for b in self.bodies if b.end == end), Body(0.0)) for end in (0, 1))
        return left, right

    @property
    def elastic(self) -> tuple[bool, bool]:
        """Whether each end has an elastic joint, with a rotational spring or a rotary inertia behind it."""
        left, right = (body.rotational + body.rotary_inertia > 0.0 for body in self.at_ends)
        return left, right

    @property
    def end_springs(self) -> Array:
        """Compliances of rotational springs in series with an end joint (no inertia between them), (2,)."""
        return np.array([b.rotational and not b.rotary_inertia and 1.0 / b.rotational for b in self.at_ends], float)

    @property
    def massive(self) -> BoolArray:
        """Whether each body has a mass, (bodies,)."""
        return np.array([body.mass > 0.0 for body in self.bodies], dtype=bool)

    def rotations(self, weights: Sparse, motions: Motions) -> Sparse:
        """Rotations of the bodies as rows over (link rotations, unknowns), sparse (bodies, N + n)."""
        from scipy.sparse import diags_array, hstack

        beyond = np.array([body.end is not None and self.elastic[body.end] for body in self.bodies], dtype=bool)
        at = np.flatnonzero(beyond)
        ends = selection(at, [self.bodies[i].end for i in at], (len(beyond), 2))
        return hstack([diags_array(1.0 - beyond) @ weights, ends @ motions.end_rotations], format="csr")

    def deflections(self, weights: Sparse, motions: Motions, compliances: Array) -> Sparse:
        """Deflections of the bodies including slip (compliances `compliances`, (bodies,)), sparse (bodies, n)."""
        slipping = np.flatnonzero((compliances > 0.0) & self.massive)
        slip = selection(slipping, np.arange(len(slipping)), (len(compliances), len(slipping))) @ motions.body_slips
        return weights @ motions.positions + slip

    def energies(
        self, deflections: Sparse, rotations: Sparse, motions: Motions, compliances: Array
    ) -> tuple[list[Any], Any]:
        """(strain rows over (link rotations, unknowns) with stiffnesses, rows R with R^T R the mass of the bodies).

        A massless spring is in series with its slip, at an end with the joint, so that no unknown is massless.
        """
        from scipy.sparse import diags_array, hstack, vstack

        masses, rotary, lateral, rotational = np.array([body[2:] for body in self.bodies]).T
        lateral = lateral / (1.0 + lateral * np.where(self.massive, 0.0, compliances))
        rotational[[b.end is not None and self.end_springs[b.end] > 0.0 for b in self.bodies]] = 0.0
        across = hstack([selection([], [], (len(masses), motions.chain.n_segments)), deflections], format="csr")
        strains = [(across[lateral > 0.0], lateral[lateral > 0.0])]
        strains.append((rotations[rotational > 0.0], rotational[rotational > 0.0]))
        rows = [diags_array(np.sqrt(masses)) @ deflections, diags_array(np.sqrt(rotary)) @ rotations @ motions.both]
        return strains, vstack(rows, format="csr")
