"""The free modes of the chain of rigid links for motion in time."""

from collections.abc import Callable
from functools import partial

import numpy as np

from verify.arrays import Array
from verify.checks import check_word
from verify.linear.driven_pencil import check_dense
from verify.linear.eigen import modal_basis
from verify.linear.places import as_typed
from verify.linear.time_basis import TimeBasis, check_held, own_ratios
from verify.options import LINES, LOADS, Attachment, Joints, Line, Load, Wall
from verify.problem.beam import Beam
from verify.segments.assembly import build_chain, chain_pencil
from verify.segments.linear import check, damped, leading_sign
from verify.segments.links import Chain
from verify.segments.loads import joint_weights
from verify.segments.reading import body_turns, corrected_reading, joint_positions, line_through


@as_typed
def time_basis(
    beam: Beam,
    n_segments: int,
    *,
    load: Load = "reciprocal",
    line: Line = "spline",
    wall: Wall = "gregory",
    joints: Joints = "series",
    attachment: Attachment = "reciprocal",
) -> TimeBasis:
    """All modes of the chain, (n,), by Euler-Bernoulli's theory.

    `line` "spline" reads order 4 joints through the C2 spline, "raw" the rigid links as they stand. Raises InputError
    for unknown settings, rigid motions and chains beyond the dense size.
    """
    check(beam, 1, n_segments, wall=wall, joints=joints, attachment=attachment)
    check_held(beam)
    check_word("load", load, LOADS)
    check_word("line", line, LINES)
    chain = build_chain(beam, n_segments, wall=wall, joints=joints, attachment=attachment)
    pencil = chain_pencil(chain)
    check_dense(pencil, "motion in time")
    values, vectors = modal_basis(pencil)
    unlike = beam.loss_factor and beam.lossless
    ratios = own_ratios(pencil, vectors, damped(beam, chain, pencil, 0.0)) if unlike else None
    vectors = vectors * (leading_sign(chain, vectors) / np.sqrt(beam.mass_per_length * chain.unit))
    deflections = joint_positions(chain, vectors)

    def loads(position: float) -> Array:
        weights = joint_weights(chain, position, load)
        near = np.flatnonzero(weights)
        return np.asarray(weights[near] @ deflections[:, near].T)

    if line == "raw":
        shapes = _straight(chain, deflections)
    else:
        readings = corrected_reading(chain, deflections)
        shapes = line_through(chain, lambda: readings)
    return TimeBasis(
        model="segment",
        count=n_segments,
        beam=beam,
        omegas=np.sqrt(values) * beam.wave_constant / chain.unit**2,
        shapes=shapes,
        loads=loads,
        edges=chain.nodes,
        degree=1 if line == "raw" else 3,
        method="dense eigenvalues",
        ratios=ratios,
        turns=partial(body_turns, chain, len(beam.mass), vectors) if beam.mass else None,
    )


def _straight(chain: Chain, deflections: Array) -> Callable[[Array, int], Array]:
    """The rigid links: straight between the joints, the link to the right at a joint."""
    nodes, lengths = chain.nodes, chain.lengths * chain.unit

    def shapes(x: Array, derivative: int) -> Array:
        link = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, chain.n_segments - 1)
        left, right = deflections[:, link], deflections[:, link + 1]
        slopes = (right - left) / lengths[link]
        if derivative == 0:
            return np.asarray(left + slopes * (x - nodes[link]))
        return slopes if derivative == 1 else np.zeros_like(slopes)

    return shapes
