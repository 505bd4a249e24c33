"""Chains made of beams, and their matrices: bare links, or links with all that stands on the beam."""

import numpy as np

from verify.checks import MOST_PARTS, check_whole, check_word
from verify.linear.mesh import divide
from verify.linear.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.options import ATTACHMENTS, JOINTS, WALLS, Attachment, Joints, Theory, Wall
from verify.problem.beam import Beam
from verify.segments.links import (
    FIELD,
    Chain,
    elastic_ends,
    joint_angles,
    link_inertia,
    mass_matrix,
    rigid_shapes,
    series_compliances,
    strain_matrix,
)
from verify.segments.walls import wall_factors, welded_halves


def check_set_up(n_segments: int, wall: str, joints: str, attachment: str) -> None:
    """Raise InputError for a number of links that is none, a single link, which does not bend, or an unknown word."""
    words = (("wall", wall, WALLS), ("joints", joints, JOINTS), ("attachment", attachment, ATTACHMENTS))
    for field, word, known in words:
        check_word(field, word, known)
    check_whole(FIELD, n_segments, 2, MOST_PARTS)


def build_chain(
    beam: Beam,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> Chain:
    """The chain of a beam: links of its sections, joints between and at the walls (see `segment_model`).

    Raises InputError where a tensioned joint would have no stiffness left.
    """
    parts = divide(beam, n_segments, grading)
    masses = parts.lengths * parts.masses_per_length
    factors = wall_factors(beam.supports, n_segments, wall, elastic_ends(beam, attachment))
    halves = welded_halves(beam.supports) if wall == "welded" else (0, 0)
    chain = Chain(
        supports=beam.supports,
        rigid_motions=beam.rigid_motions,
        unit=beam.length / (n_segments + 0.5 * sum(halves)),
        start=0.5 * halves[0],
        lengths=parts.lengths,
        compliances=series_compliances(parts, parts.stiffnesses, joints) * factors,
        masses=masses,
        inertias=link_inertia(masses, parts.lengths),
        stiffnesses=parts.stiffnesses,
    )
    if theory == "euler-bernoulli" and beam.added in ((), ("section",)):
        return chain
    from verify.segments.carried import carried

    return carried(beam, chain, parts, factors, wall=wall, joints=joints, theory=theory, attachment=attachment)


def chain_pencil(chain: Chain) -> FactoredPencil:
    """K = B^T diag(k) B over the joint angles, and M."""
    if not chain.plain:
        from verify.segments.loaded import loaded_pencil

        return loaded_pencil(chain)
    left, right = chain.walls
    has_joint = np.concatenate([[left], np.ones(chain.n_segments - 1, dtype=bool), [right]])
    n = chain.n_segments + 1 - sum(chain.held)
    mass = mass_matrix(chain) if n > DENSE_UNKNOWNS else mass_matrix(chain, dense=True)
    return FactoredPencil(
        n=n,
        rigid=rigid_shapes(chain),
        strain=lambda free: joint_angles(chain, free),
        stiffness=1.0 / chain.compliances[has_joint],
        strain_matrix=lambda: strain_matrix(chain),
        mass_matrix=lambda: mass,
        bending=chain.first_bending,
    )
