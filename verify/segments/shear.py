"""Shear and rotary inertia: joints that slip in Timoshenko theory, and corrections of the rotary inertia.

A joint has the slip stiffness kappa G A/l; slip compliances are weights of a quadrature of Q^2/(kappa G A), as joint
compliances are of M^2/EI. The links' rotary inertia rho I l theta^2 acts like an axial force -omega^2 rho I: order 2,
unless "tensioned" joints subtract inertia where they bend and slip: order 4 (`docs/theory.md`, "Finite segments").
"""

from collections.abc import Sequence

import numpy as np

from verify.arrays import Array, Curve, Numeric
from verify.segments.attachments import Body
from verify.segments.chain import Chain, Motions, right_of
from verify.segments.walls import tension_excess, wall_factors

_LEAST = 1e-9  # relative slip compliance of an attachment, so that no unknown is massless


def slip_compliances(
    chain: Chain, softness: Array, bodies: Sequence[Body], weights: Array, wall: str
) -> tuple[Array, Array]:
    """Slip compliances of joints 0..N, (N + 1,), infinite without slip, and of bodies, (bodies,), 0 without slip.

    Clamped end: the wall's correction; pinned end: 1/2, exact by reflection; guided and free ends transmit no shear
    force unless loaded. A body at a free end has the slip of the end joint; a massless spring is in series with its
    slip. `weights` (bodies, N + 1) are those of the joints.
    """
    tips = [b for b in bodies if b.end is not None and chain.supports[b.end] == "free" and b.mass + b.stiffness > 0.0]
    loaded = {body.end for body in tips}
    left, right = ({"pinned": "guided", "guided": "free"}.get(support, support) for support in chain.supports)
    factors = wall_factors((left, right), chain.n_segments, wall, (0 in loaded, 1 in loaded))
    slips, at_bodies = softness * factors, np.zeros(len(weights))
    for i, body in enumerate(bodies):
        if body in tips:
            if not body.mass:
                at_bodies[i], slips[-(body.end or 0)] = slips[-(body.end or 0)], np.inf
        elif body.mass + body.stiffness > 0.0:
            at_bodies[i] = attachment_compliance(chain, softness, body.position, weights[i])
    return slips, at_bodies


def attachment_compliance(chain: Chain, softness: Array, position: float, weights: Array) -> float:
    """Slip compliance of an attachment at a position (m) with joint `weights` (N + 1,).

    At a force the chain slips less than the beam, by sum w_i w_j (|i - j|/2 + delta_ij/4) l/(kappa G A). At a guided
    end the attachment includes its reflection.
    """
    nearest = int(abs(chain.nodes - position).argmin())
    joints, doubled = np.flatnonzero(weights), 1.0
    near = weights[joints]
    if nearest in (0, chain.n_segments) and abs(chain.nodes[nearest] - position) < 1e-9 * chain.unit:
        joints = np.append(2 * nearest - joints, joints)
        near, doubled = 0.5 * np.append(near, near), 2.0
    apart = abs(np.subtract.outer(joints, joints))
    lacking = near @ (0.5 * apart + 0.25 * (apart == 0)) @ near
    return float(softness[nearest] * max(doubled * lacking, _LEAST))


def joint_inertias(thick: Array, factors: Array, fraction: Array, wall: str) -> Array:
    """Rotary inertia rho I l/12 subtracted from that of the links, `thick` (N,), at bending joints 0..N, (N + 1,).

    It corresponds to the correction T l/12 of a tensioned joint. `factors` are the wall factors, `fraction` the part of
    a joint's angle that is in the beam and not in a spring behind the end.
    """
    inertias, weights = _harmonic_means(thick) / 12.0, factors.copy()
    weights[[0, -1]] += tension_excess(wall) * ~np.isin(factors[[0, -1]], (0.5, np.inf))
    weights *= fraction**2
    return np.divide(inertias * weights, factors**2, out=np.zeros(len(inertias)), where=np.isfinite(factors))


def slip_masses(chain: Chain, slips: Array) -> Array:
    """Mass rho A l/12 subtracted from that of the links at slipping joints 0..N, (N + 1,)."""
    masses = _harmonic_means(chain.masses) / 12.0
    masses[[0, -1]] *= 2.0 * np.array(chain.supported)  # a larger factor makes the mass at a wall negative
    return np.where(np.isfinite(slips), masses, 0.0)


def _harmonic_means(links: Array) -> Array:
    """Harmonic mean of a property of the adjoining links at joints 0..N, (N + 1,).

    Each link end has m/6 of a square to subtract from; other means make the mass between unequal links negative.
    """
    inner = 2.0 * links[1:] * links[:-1] / (links[1:] + links[:-1])
    return np.concatenate([links[:1], inner, links[-1:]])


def shear_change(motions: Motions, softness: Array, unknowns: Numeric) -> Numeric:
    """Derivative gamma' of the shear angle at joints 0..N, (k, N + 1), per unit length.

    From the shear force; independent of wall factors.
    """
    chain, slipping, angles = motions.chain, motions.sliding, motions.joint_slips @ unknowns
    angles[slipping] *= (softness[slipping] / motions.slips[slipping])[:, None]
    change = np.gradient(angles / chain.spans[:, None], chain.nodes / chain.unit, axis=0, edge_order=2)
    return np.asarray(change.T)


def modal_shear_change(chain: Chain, shears: Array, foundation: float, joints: Array, values: Array) -> Array:
    """Derivative gamma' of modes with eigenvalues `values` (k,) and deflections `joints` (k, N + 1), (k, N + 1).

    From the balance of forces, kappa G A gamma' = (k_f - rho A omega^2) w: gamma jumps at bodies and steps.
    """
    force = foundation - values[:, None] * right_of(chain.masses / chain.lengths)
    return np.asarray(force * joints / right_of(shears))


def section_rotation(motions: Motions, factors: Array, fraction: Array, unknowns: Numeric, *, corrected: bool) -> Curve:
    """Section rotation psi of unknowns (n, k): (x in m, derivative) -> (k, len(x)), rad per m^derivative.

    A C2 spline through the links' middles and the ends. A link's rotation is the mean of psi over its length,
    psi = theta + l^2 psi''/24 at its middle, plus the effect of wall corrections. `fraction` (N + 1,) is the part of a
    joint's angle that is in the beam and not in a spring behind the end.
    """
    from scipy.interpolate import CubicSpline

    chain, links = motions.chain, motions.rotations @ unknowns
    angles = motions.angles_of @ np.concatenate([links, unknowns])
    lengths = chain.lengths[:, None]
    jointed = [wall or elastic for wall, elastic in zip(chain.walls, chain.elastic, strict=True)]
    # rotation behind the end joint: of a body, or less the angle of the spring
    ends = motions.end_rotations @ unknowns + ([[1.0], [-1.0]] * angles[[0, -1]]) * (1.0 - fraction[[0, -1], None])
    if corrected:
        plain = (angles * fraction[:, None] / factors[:, None]) / chain.spans[:, None]
        off = np.cumsum((angles * (1.0 - 1.0 / factors[:, None]))[1:-1], axis=0)
        off = np.concatenate([np.zeros_like(off[:1]), off])
        links = links + off[len(off) // 2] - off + lengths / 24.0 * np.diff(plain, axis=0)
    # at an end without moment psi is even in the distance from it
    for end, (near, far) in enumerate(((0, 1), (-1, -2))):
        if not jointed[end]:
            near_square, far_square = (0.5 * lengths[near]) ** 2, (lengths[near] + 0.5 * lengths[far]) ** 2
            ends[-end] = links[near] - (links[far] - links[near]) * near_square / (far_square - near_square)
    nodes = chain.nodes
    x = np.concatenate([nodes[:1], 0.5 * (nodes[1:] + nodes[:-1]), nodes[-1:]])
    values = np.concatenate([ends[:1], links, ends[1:]]) / chain.unit
    kinds = tuple("not-a-knot" if joint else "clamped" for joint in jointed)
    line = CubicSpline(x, values.T, axis=1, bc_type=kinds)
    return lambda at, derivative: line(np.clip(at, nodes[0], nodes[-1]), derivative)
