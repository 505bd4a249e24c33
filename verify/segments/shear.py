"""Joints that slip: chains under Timoshenko's theory, and the corrections of rotary inertia of thick beams.

A joint slips against kappa G A/l, the weights of a quadrature of Q^2/(kappa G A) as the angles' are of M^2/EI. The
rotary inertia rho I l theta^2 of the links acts like an axial force -omega^2 rho I: order 2, unless the inertia that
"tensioned" joints take off where they bend and slip restores order 4 (`docs/theory.md`, "Finite segments").
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.segments.bodies import Body
from verify.segments.chain import Chain, Motions, right_of
from verify.segments.walls import tension_excess, wall_factors

_LEAST = 1e-9
"""Relative compliance of the slip of an attachment, so that no unknown is without mass."""


def shear_factors(chain: Chain, wall: str, loaded: tuple[bool, bool]) -> Array:
    """Factors on the compliances of joints 0..N against slip, (N + 1,).

    A clamped wall has its correction; a pinned end half a joint, exact by reflection; guided and free ends carry no
    shear force, but where they are `loaded` by an attachment.
    """
    left, right = ({"pinned": "guided", "guided": "free"}.get(support, support) for support in chain.supports)
    return wall_factors((left, right), chain.n_segments, wall, loaded)


def slip_compliances(
    chain: Chain, softness: Array, bodies: Sequence[Body], weights: Array, wall: str
) -> tuple[Array, Array]:
    """Compliances against slip of joints 0..N, (N + 1,), infinite without, and of bodies, (bodies,), 0 without.

    A body slips by itself, but at a free end, where the end joint is its slip; a spring alone is in series with that.
    `weights` (bodies, N + 1) are those of the joints.
    """
    tips = [b for b in bodies if b.end is not None and chain.supports[b.end] == "free" and b.mass + b.stiffness > 0.0]
    loaded = {body.end for body in tips}
    slips, gives = softness * shear_factors(chain, wall, (0 in loaded, 1 in loaded)), np.zeros(len(weights))
    for i, body in enumerate(bodies):
        if body in tips:
            if not body.mass:
                gives[i], slips[-(body.end or 0)] = slips[-(body.end or 0)], np.inf
        elif body.mass + body.stiffness > 0.0:
            gives[i] = attachment_compliance(chain, softness, body.position, weights[i])
    return slips, gives


def attachment_compliance(chain: Chain, softness: Array, position: float, weights: Array) -> float:
    """Compliance of the slip of an attachment at a position (m) whose weights of the joints are (N + 1,).

    Where a force acts a chain slips less than the beam, by sum w_i w_j (|i - j|/2 + delta_ij/4) l/(kappa G A).
    At a guided end the attachment represents both its sides.
    """
    nearest = int(abs(chain.nodes - position).argmin())
    there, doubled = np.flatnonzero(weights), 1.0
    near = weights[there]
    if nearest in (0, chain.n_segments) and abs(chain.nodes[nearest] - position) < 1e-9 * chain.unit:
        there = np.append(2 * nearest - there, there)
        near, doubled = 0.5 * np.append(near, near), 2.0
    apart = abs(np.subtract.outer(there, there))
    lacking = near @ (0.5 * apart + 0.25 * (apart == 0)) @ near
    return float(softness[nearest] * max(doubled * lacking, _LEAST))


def joint_inertias(thick: Array, factors: Array, own: Array, wall: str) -> Array:
    """Rho I l/12 to be taken off the links' rotary inertia `thick` (N,) where joints 0..N bend, (N + 1,).

    As T l/12 is off a tensioned joint. `factors` are those of the walls, `own` the part of a joint's angle that is the
    beam's and not a spring's beyond it.
    """
    found, weights = _harmonic_means(thick) / 12.0, factors.copy()
    weights[[0, -1]] += tension_excess(wall) * ~np.isin(factors[[0, -1]], (0.5, np.inf))
    return np.divide(found * weights * own**2, factors**2, out=np.zeros(len(found)), where=np.isfinite(factors))


def slip_masses(chain: Chain, slips: Array) -> Array:
    """Rho A l/12 to be taken off the links' mass where joints 0..N slip, (N + 1,)."""
    masses = _harmonic_means(chain.masses) / 12.0
    masses[[0, -1]] *= 2.0 * np.array(chain.held)  # more would leave less than no mass at a wall
    return np.where(np.isfinite(slips), masses, 0.0)


def _harmonic_means(links: Array) -> Array:
    """Harmonic means of adjoining links at joints 0..N, (N + 1,).

    Links have m/6 of a square at either end to give; any other mean leaves less than no mass between unlike links.
    """
    inner = 2.0 * links[1:] * links[:-1] / (links[1:] + links[:-1])
    return np.concatenate([links[:1], inner, links[-1:]])


def shear_angles(motions: Motions, softness: Array, unknowns: Any) -> Any:
    """Shear angles gamma of the beam at joints 0..N, (N + 1, k): of the force, whatever a wall's factor is."""
    there, found = motions.sliding, motions.joint_slips @ unknowns
    found[there] *= (softness[there] / motions.slips[there])[:, None]
    return found / motions.chain.spans[:, None]


def shear_change(motions: Motions, softness: Array, unknowns: Any) -> Any:
    """Change gamma' of the shear angle at joints 0..N, (k, N + 1), per unit of length."""
    chain = motions.chain
    return np.gradient(shear_angles(motions, softness, unknowns), chain.nodes / chain.unit, axis=0, edge_order=2).T


def modal_shear_change(chain: Chain, shears: Array, foundation: float, joints: Array, values: Array) -> Array:
    """The same of modes of eigenvalues (k,) with deflections (k, N + 1) at the joints.

    By balance of forces, kappa G A gamma' = (k_f - rho A omega^2) w: at bodies and steps shear itself jumps.
    """
    force = foundation - values[:, None] * right_of(chain.masses / chain.lengths)
    return np.asarray(force * joints / right_of(shears))


def section_rotation(
    motions: Motions, factors: Array, own: Array, unknowns: Any, *, corrected: bool
) -> Callable[[Array, int], Any]:
    """Rotation psi of the section of unknowns (n, k): (x in m, derivative) -> (k, len(x)), rad per m^derivative.

    A C2 spline through the links' middles and the ends. A link's rotation is the mean of psi over its length,
    psi = theta + l^2 psi''/24 at its middle; corrections of a wall's joints turn the links off that line. `own`
    (N + 1,) is the part of a joint's angle that is the beam's, not a spring's beyond the end.
    """
    from scipy.interpolate import CubicSpline

    chain, links = motions.chain, motions.rotations @ unknowns
    angles = motions.angles_of @ np.concatenate([links, unknowns])
    lengths = chain.lengths[:, None]
    jointed = [wall or elastic for wall, elastic in zip(chain.walls, chain.elastic, strict=True)]
    # the end itself, beyond its joint: a body there, or the spring that has the rest of the angle
    ends = motions.end_rotations @ unknowns + ([[1.0], [-1.0]] * angles[[0, -1]]) * (1.0 - own[[0, -1], None])
    if corrected:
        plain = (angles * own[:, None] / factors[:, None]) / chain.spans[:, None]
        off = np.cumsum((angles * (1.0 - 1.0 / factors[:, None]))[1:-1], axis=0)
        off = np.concatenate([np.zeros_like(off[:1]), off])
        links = links + off[len(off) // 2] - off + lengths / 24.0 * np.diff(plain, axis=0)
    # without a moment psi is even in the distance from the end
    for end, (near, far) in enumerate(((0, 1), (-1, -2))):
        if not jointed[end]:
            here, there = (0.5 * lengths[near]) ** 2, (lengths[near] + 0.5 * lengths[far]) ** 2
            ends[-end] = links[near] - (links[far] - links[near]) * here / (there - here)
    nodes = chain.nodes
    x = np.concatenate([nodes[:1], 0.5 * (nodes[1:] + nodes[:-1]), nodes[-1:]])
    values = np.concatenate([ends[:1], links, ends[1:]]) / chain.unit
    kinds = tuple("not-a-knot" if there else "clamped" for there in jointed)
    line = CubicSpline(x, values.T, axis=1, bc_type=kinds)
    return lambda at, derivative: line(np.clip(at, nodes[0], nodes[-1]), derivative)
