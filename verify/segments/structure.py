"""Links, joints, stiffness and mass of a chain with attachments: the base of `SegmentModel`."""

from functools import cached_property
from typing import Any

import numpy as np

from verify.arrays import Array, Numeric, Sparse
from verify.errors import InputError
from verify.linear.discrete import DiscreteModel
from verify.linear.mesh import Parts, divide
from verify.linear.system import StructuralSystem
from verify.problem.beam import is_stepped, rigid_lines
from verify.problem.supports import FIXED
from verify.segments import shear
from verify.segments.attachments import Attached, attachment_weights
from verify.segments.chain import Chain, Motions, at_joints, link_inertia, link_mass, plain_factors, selection, squares
from verify.segments.walls import reading_factors, tension_excess, wall_factors
from verify.settings import WALLS, Attachment, Joints, Wall


class ChainStructure(DiscreteModel):
    """A chain of links and joints with bodies and springs, and with rotary inertia and shear by theory."""

    n_segments: int
    wall: Wall
    joints: Joints
    grading: float
    attachment: Attachment
    joint_dashpot: float

    @property
    def unit(self) -> float:
        """Mean length of a link, m, without what is part of a clamped wall."""
        return self.beam.length / (self.n_segments + WALLS[self.wall].first * self.beam.supports.count("clamped"))

    # --- Links, joints and walls ---------------------------------------------------------------------------------

    @cached_property
    def links(self) -> Parts:
        """Lengths and properties of the links; steps of the beam are at joints."""
        return divide(self.beam, self.n_segments, self.grading)

    @cached_property
    def chain(self) -> Chain:
        """Links and joints without attachments. Raises InputError where the stiffness of a joint is not positive."""
        lengths, masses = self.links.lengths, self.links.lengths * self.links.masses_per_length
        compliances = self._corrected_compliances.copy()
        compliances[[0, -1]] += self.attached.end_springs
        inertias = link_inertia(masses, lengths)
        if self._thick:
            inertias = inertias + self._rotary_inertias
        return Chain(
            supports=self.beam.supports,
            unit=self.unit,
            start=WALLS[self.wall].first * (self.beam.supports[0] == "clamped"),
            lengths=lengths,
            compliances=compliances,
            masses=masses,
            inertias=inertias,
            elastic=self.attached.elastic,
            flexibilities=lengths / self.links.stiffnesses if is_stepped(self.beam) else None,
            reading_factors=reading_factors(self.attached.elastic, self.n_segments, self.wall)
            if any(self.attached.elastic)
            else None,
        )

    def _joint_compliances(self, stiffnesses: Array) -> Array:
        """1/k of joints 0..N by Eq. (1), (N + 1,), times the wall factors; `stiffnesses` (N,) are EI of the links."""
        lengths = self.links.lengths
        halves = 0.5 * lengths / stiffnesses
        inner = halves[:-1] + halves[1:]
        if self.joints == "printed":
            # k = 2 E_i E_j I_i I_j / (E_i I_j l_j + E_j I_i l_i) is dimensionally right but pairs the wrong links:
            # order 1 where both I and E / l differ; for EI without E, E is 1 and "printed" equals "series"
            e, i = self.links.moduli, self.links.second_moments
            inner = 0.5 * lengths[1:] / (e[1:] * i[:-1]) + 0.5 * lengths[:-1] / (e[:-1] * i[1:])
        return np.concatenate([2.0 * halves[:1], inner, 2.0 * halves[-1:]]) * self._wall_factors

    @cached_property
    def _wall_factors(self) -> Array:
        return wall_factors(self.beam.supports, self.n_segments, self.wall, self.attached.elastic)

    @cached_property
    def _beam_compliances(self) -> Array:
        """1/k of the joints with the beam's bending stiffness, (N + 1,)."""
        return self._joint_compliances(self.links.stiffnesses)

    @cached_property
    def _corrected_compliances(self) -> Array:
        """1/k of tensioned joints, (N + 1,): EI - T l^2/12 in Eq. (1), and less at a clamped wall."""
        if self.joints != "tensioned" or not self.beam.tension:
            return self._beam_compliances
        lengths, stiffnesses = self.links.lengths, self.links.stiffnesses - self._tension * self.links.lengths**2 / 12.0
        compliances = self._joint_compliances(stiffnesses)
        for end, (support, turns) in enumerate(zip(self.beam.supports, self.attached.elastic, strict=True)):
            if support == "clamped" or turns:
                excess = self._tension * lengths[-end] * tension_excess(self.wall) / 12.0
                compliances[-end] = 1.0 / (1.0 / compliances[-end] - excess / self._wall_factors[-end] ** 2)
        if stiffnesses.min() <= 0.0 or compliances.min() <= 0.0:
            raise InputError(
                f"joints = 'tensioned': beam.tension = {self.beam.tension!r} N leaves no stiffness in a joint of "
                f"{self.n_segments} segments (limit 12 EI/l^2, at a clamped wall two thirds of it): give more segments "
                "or choose joints = 'series'"
            )
        return compliances

    @property
    def _thick(self) -> bool:
        """Whether the theory has rotary inertia of the sections."""
        return self.theory != "euler-bernoulli"

    @cached_property
    def _rotary_inertias(self) -> Array:
        """Rotary inertia rho I l of the links, (N,)."""
        return self.links.lengths * self.links.of("rotary_inertia") / (self.beam.mass_per_length * self.unit**2)

    @cached_property
    def attached(self) -> Attached:
        """Bodies and springs."""
        return Attached(self.beam, self.unit, self.attachment)

    @property
    def n_unknowns(self) -> int:
        """Free joint positions, rotations beyond elastic ends, slips of joints and of bodies."""
        held = sum(FIXED[support].deflection for support in self.beam.supports)
        count = self.n_segments + 1 - held + sum(body.rotary_inertia > 0.0 for body in self.attached.at_ends)
        if self.theory == "timoshenko":
            bodies = int(self.attached.massive.sum()) if self.attachment == "reciprocal" else 0
            count += self.n_segments - 1 + held + bodies
        return count

    @cached_property
    def _weights(self) -> tuple[Sparse, Sparse]:
        return attachment_weights(self.chain, [body.position for body in self.attached.bodies], self.attachment)

    @cached_property
    def _rotations(self) -> Sparse:
        return self.attached.rotations(self._weights[1], self.motions)

    # --- Stiffness and mass --------------------------------------------------------------------------------------

    @cached_property
    def _shears(self) -> Array:
        """Kappa G A of the links, (N,)."""
        return self.links.of("shear_stiffness") * self.unit**2 / self.beam.bending_stiffness

    @cached_property
    def _shear_compliances(self) -> Array:
        """Slip compliances of joints 0..N by Eq. (1), without wall factors, (N + 1,)."""
        return at_joints(self.links.lengths / self._shears)

    @cached_property
    def _slips(self) -> tuple[Array, Array]:
        """Slip compliances of joints, (N + 1,), infinite without slip, and of bodies, (bodies,), 0 without slip."""
        if self.theory != "timoshenko":
            return np.zeros(0), np.zeros(len(self.attached.bodies))
        bodies = self.attached.bodies if self.attachment == "reciprocal" else ()
        weights = self._weights[0].toarray()
        return shear.slip_compliances(self.chain, self._shear_compliances, bodies, weights, self.wall)

    @cached_property
    def motions(self) -> Motions:
        """Positions, rotations and slips as linear maps of the unknowns."""
        slips, at_bodies = self._slips
        rotating = [end for end, body in enumerate(self.attached.at_ends) if body.rotary_inertia]
        return Motions(self.chain, rotating, slips, at_bodies[(at_bodies > 0.0) & self.attached.massive])

    @cached_property
    def system(self) -> StructuralSystem:
        """Stiffness and mass of links, joints and attachments."""
        from scipy.sparse import csc_array, vstack

        beam, chain, motions, lengths, n = self.beam, self.chain, self.motions, self.links.lengths, self.n_segments
        if not (motions.n_slips or beam.foundation or beam.tension or self.attached.bodies) and self.joints == "series":
            stiffness = 1.0 / chain.compliances[self._springs]
            return StructuralSystem(plain_factors(chain), stiffness, link_mass(motions), self._rigid(None))
        # strain rows over (link rotations, unknowns v), and their stiffnesses
        links = selection(np.arange(n), np.arange(n), (n, n + motions.n))
        unknowns = selection(np.arange(motions.n), n + np.arange(motions.n), (motions.n, n + motions.n))
        strains = [(motions.angles_of[self._springs], 1.0 / chain.compliances[self._springs])]
        strains.append((unknowns[motions.n - motions.n_slips :], np.ones(motions.n_slips)))
        bound = 0.0
        if beam.foundation:
            ground = self._foundation * lengths
            strains += [(motions.middles @ unknowns, ground), (links, ground * lengths**2 / 12.0)]
            if beam.tension >= 0.0:
                bound = np.minimum(ground / chain.masses, ground * lengths**2 / (12.0 * chain.inertias)).min()
        if beam.tension:
            strains.append((links, self._tension * lengths))
        mass, across, bodies = link_mass(motions), None, None
        if self.joints == "tensioned" and self._thick:
            inertias = shear.joint_inertias(self._rotary_inertias, self._wall_factors, self._beam_fraction, self.wall)
            mass = mass - squares(motions.angles_of @ motions.both, inertias)
            if motions.n_slips:
                mass = mass - squares(motions.joint_slips, shear.slip_masses(chain, motions.slips))
        if self.attached.bodies:
            at_bodies = self._slips[1]
            across = self.attached.deflections(self._weights[0], motions, at_bodies)
            attached, bodies = self.attached.energies(across, self._rotations, motions, at_bodies)
            strains, mass = strains + attached, mass + bodies.T @ bodies
        rows, stiffnesses = zip(*strains, strict=True)
        factors = [*motions.factors, vstack(rows, format="csr")]
        stiffness, rigid = np.concatenate(stiffnesses), self._rigid(across)
        return StructuralSystem(factors, stiffness, csc_array(mass), rigid, bound, bodies)

    @cached_property
    def _springs(self) -> Any:
        """Indices of joints with a spring."""
        return np.flatnonzero(np.isfinite(self.chain.compliances))

    @cached_property
    def _beam_fraction(self) -> Array:
        """Fraction of each joint's angle that is in the beam and not in a spring behind its end, (N + 1,)."""
        beam, whole = self._corrected_compliances, self.chain.compliances
        return np.divide(beam, whole, out=np.ones(len(beam)), where=np.isfinite(whole))

    def _rigid(self, across: Any) -> Array:
        """Rigid-body modes, (n, 0 to 2)."""
        x, motions = self.chain.nodes / self.unit, self.motions
        rigid = np.zeros((motions.n, self.beam.rigid_motions))
        for column, (start, tilt) in enumerate(rigid_lines(self.beam)):
            rigid[:, column] = (start / self.unit + tilt * x) @ motions.positions + [tilt, tilt] @ motions.end_rotations
        springs = [i for i, body in enumerate(self.attached.bodies) if body.stiffness]
        if springs and rigid.size:
            # zero strain of a single spring, whose interpolated position has an error on unequal links
            rigid[: len(motions.free)] -= (across[springs[:1]] @ rigid)[0]
        return rigid

    def lossy_stiffness(self, omega: float) -> Numeric:
        """Stiffness d with the beam's loss factor and joint dashpots; springs, foundation and tension are lossless."""
        d, dashpots = self.system.stiffness, self.joint_dashpot * omega * self.unit / self.beam.bending_stiffness
        if not (self.beam.loss_factor or dashpots):
            return d
        sprung, series, lossy = self._springs, np.zeros(self.n_segments + 1), d.astype(complex)
        series[[0, -1]] = self.attached.end_springs
        loss = self.beam.loss_factor / self._beam_compliances[sprung] + dashpots
        lossy[: len(sprung)] = 1.0 / (1.0 / (1.0 / self._corrected_compliances[sprung] + 1j * loss) + series[sprung])
        lossy[len(sprung) : len(sprung) + self.motions.n_slips] *= 1.0 + 1j * self.beam.loss_factor
        return lossy
