"""What a beam puts on its chain: axial force and what it takes of the joints, thickness, shear, bodies and springs."""

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.mesh import Parts, part_counts
from verify.problem.beam import Beam
from verify.segments.attached import shear_give
from verify.segments.crowded import felt_together
from verify.segments.links import Body, Chain, elastic_ends, series_compliances
from verify.segments.walls import reading_factors, shear_factors, tension_excess


def carried(
    beam: Beam, chain: Chain, parts: Parts, factors: Array, *, wall: str, joints: str, theory: str, attachment: str
) -> Chain:
    """The chain of links and joints with all the rest of its beam; `factors` are those of its walls (`walls`).

    Raises InputError where a tensioned joint would have no stiffness left.
    """
    elastic, tension = elastic_ends(beam, attachment), beam.tension * chain.unit**2 / beam.bending_stiffness
    mends = joints == "tensioned" and theory != "euler-bernoulli"
    if theory != "euler-bernoulli":
        thick = chain.lengths * _of_links(beam, chain.n_segments, "rotary_inertia")
        thick = thick / (beam.mass_per_length * chain.unit**2)
        chain = replace(chain, inertias=chain.inertias + thick)
        if mends:
            chain = replace(chain, joint_inertias=_joint_inertias(thick, factors, tension_excess(wall)))
        elif theory == "rayleigh" and beam.added in ((), ("section",)):
            return chain
    if joints == "tensioned" and tension:
        compliances = _tensioned(beam, parts, tension, factors, tension_excess(wall), elastic)
        chain = replace(chain, compliances=compliances, eased=_ratio(chain.compliances, compliances))
    chain = _added(beam, chain, tension, attachment, elastic)
    if any(elastic):
        chain = replace(chain, edges=reading_factors(elastic, chain.n_segments, wall))
    return replace(_slipping(beam, chain, wall), weights=factors) if theory == "timoshenko" else chain


def _ratio(series: Array, compliances: Array) -> Array:
    """Of two compliances, one where an end has none, (N + 1,)."""
    return np.divide(series, compliances, out=np.ones(len(series)), where=np.isfinite(series))


def _tensioned(
    beam: Beam, parts: Parts, tension: float, factors: Array, excess: float, elastic: tuple[bool, bool]
) -> Array:
    """1/k of joints 0..N with EI - T l^2/12 for every link's EI, which restores order 4 under axial force (`loaded`).

    The first joint of a clamped wall gives up `excess` more. Raises InputError where no stiffness is left.
    """
    stiffness = parts.stiffnesses - tension * parts.lengths**2 / 12.0
    found = series_compliances(parts, stiffness, "series") * factors
    for end, support, turns in zip((0, -1), beam.supports, elastic, strict=True):
        if support == "clamped" or turns:
            found[end] = 1.0 / (1.0 / found[end] - tension * parts.lengths[end] * excess / 12.0 / factors[end] ** 2)
    if (stiffness <= 0.0).any() or (found <= 0.0).any():
        raise InputError(
            f"joints = 'tensioned': beam.tension = {beam.tension!r} N leaves no stiffness in a joint of "
            f"{len(stiffness)} segments, which takes less than 12 EI/l^2, at a clamped wall about two thirds of it: "
            "give more segments or choose joints = 'series'"
        )
    return found


def _joint_inertias(thick: Array, factors: Array, excess: float) -> Array:
    """Rho I l/12 of joints 0..N, as `_tensioned` has T l/12, zero where an end has none, (N + 1,)."""
    found = _of_joints(thick) / 12.0
    weights = factors.copy()
    for end in (0, -1):
        weights[end] += excess * (factors[end] not in (0.5, np.inf))
    return np.divide(found * weights, factors**2, out=np.zeros(len(found)), where=np.isfinite(factors))


def _of_joints(links: Array) -> Array:
    """The harmonic mean of what the links on either side have, of joints 0..N, (N + 1,): the end link's at an end.

    Links have m/6 of a square at either end to give; a joint between m and m' that takes m m'/(m + m')/6 leaves just
    that to the next, however unlike its links are. Any other mean leaves less than no mass somewhere.
    """
    inner = 2.0 * links[1:] * links[:-1] / (links[1:] + links[:-1])
    return np.concatenate([links[:1], inner, links[-1:]])


def _of_links(beam: Beam, n_segments: int, field: str) -> Array:
    """A figure of the beam's pieces as that of the links, (N,), SI."""
    figures = [float(getattr(piece, field)) for piece in beam.pieces]
    return np.repeat(figures, part_counts([piece.length for piece in beam.pieces], n_segments))


def _softness(chain: Chain, shears: Array) -> Array:
    """1/k against slipping of joints 0..N, l/(kappa G A) as bending has l/(EI), two half links in series, (N + 1,)."""
    links = chain.lengths / shears
    return np.concatenate([links[:1], 0.5 * (links[1:] + links[:-1]), links[-1:]])


def _slipping(beam: Beam, chain: Chain, wall: str) -> Chain:
    """The chain with joints that slip. A body slips too: at an end beyond a joint of its own, inside by its `give`.

    A spring without a body is in series with that slip, so that no position is without mass.
    """
    n = chain.n_segments
    shears = _of_links(beam, n, "shear_stiffness") * chain.unit**2 / beam.bending_stiffness
    softness = _softness(chain, shears)
    chain = replace(chain, shears=shears, softness=softness)
    free = {at: joint for at, joint in ((0.0, 0), (beam.length, n)) if beam.supports[bool(joint)] == "free"}
    places = {body.position for body in chain.bodies if body.mass or body.stiffness}
    loaded = (beam.supports[0] == "free" and 0.0 in places, beam.supports[1] == "free" and beam.length in places)
    if chain.attachment == "lever":
        slips = softness * shear_factors(beam.supports, n, wall)
        return replace(chain, slips=slips, slip_masses=_slip_masses(chain, slips))
    slips = softness * shear_factors(beam.supports, n, wall, loaded)
    bodies, every = [], sorted({body.position for body in chain.bodies})
    weights = felt_together(chain, every, chain.attachment)[0]
    for place, felt in zip(every, weights, strict=True):
        body = _one_body([body for body in chain.bodies if body.position == place])
        end = free.get(place)
        give = _give(chain, softness, place, felt) if end is None else slips[end]
        if body.stiffness and not body.mass:
            body = replace(body, stiffness=1.0 / (1.0 / body.stiffness + give))
            if end is not None:
                slips[end] = np.inf
        elif body.mass and end is None:
            body = replace(body, give=give)
        bodies.append(body)
    taken = _slip_masses(chain, slips)
    return replace(chain, bodies=tuple(bodies), slips=slips, slip_masses=taken)


def _slip_masses(chain: Chain, slips: Array) -> Array | None:
    """Rho A l/12 of mended joints 0..N that slip, (N + 1,); None where none are mended."""
    if chain.joint_inertias is None:
        return None
    masses = _of_joints(chain.masses)
    halves = np.concatenate([[2.0], np.ones(len(masses) - 2), [2.0]])  # more would leave less than no mass at a wall
    halves[[0, -1]] *= chain.held
    return np.where(np.isfinite(slips), masses * halves / 12.0, 0.0)


def _give(chain: Chain, softness: Array, place: float, felt: Array) -> float:
    """Compliance of the slip of what stands at a place inside, or at a guided end, which stands for both its sides.

    `felt` (N + 1,) are the joints' weights there.
    """
    nearest = int(abs(chain.nodes - place).argmin())
    if nearest in (0, chain.n_segments) and abs(chain.nodes[nearest] - place) < 1e-9 * chain.unit:
        inward = felt if nearest == 0 else felt[::-1]
        both = np.concatenate([0.5 * inward[:0:-1], inward[:1], 0.5 * inward[1:]])
        return float(2.0 * softness[nearest] * shear_give(both))
    return float(softness[nearest] * shear_give(felt))


def _one_body(bodies: list[Body]) -> Body:
    """Everything that stands at one place."""
    fields = ("mass", "rotary_inertia", "stiffness", "rotational")
    return Body(
        position=bodies[0].position, **{field: sum(getattr(body, field) for body in bodies) for field in fields}
    )


def _added(beam: Beam, chain: Chain, tension: float, attachment: str, elastic: tuple[bool, bool]) -> Chain:
    """The chain with what stands on the beam; what turns with an end is put beyond its joint."""
    unit, stiffness, mass = chain.unit, beam.bending_stiffness, beam.mass_per_length
    bodies = [
        Body(position=m.position, mass=m.mass / (mass * unit), rotary_inertia=m.rotary_inertia / (mass * unit**3))
        for m in beam.mass
    ]
    bodies += [
        Body(
            position=s.position,
            stiffness=s.stiffness * unit**3 / stiffness,
            rotational=s.rotational * unit / stiffness,
        )
        for s in beam.spring
    ]
    ends = [
        [b for b in bodies if there and b.position == at] for there, at in zip(elastic, (0.0, beam.length), strict=True)
    ]
    inertias = [sum((body.rotary_inertia for body in end), 0.0) for end in ends]
    springs = [sum((body.rotational for body in end), 0.0) for end in ends]
    beyond = [0.0 if inertia or not spring else 1.0 / spring for inertia, spring in zip(inertias, springs, strict=True)]
    compliances = chain.compliances.copy()
    compliances[[0, -1]] += beyond
    taken = chain.joint_inertias
    if taken is not None:  # of the turn of an end's joint, without that of the spring behind it
        own = np.divide(chain.compliances, compliances, out=np.ones(len(taken)), where=np.isfinite(compliances))
        taken = taken * own**2
    at_ends = [body for end in ends for body in end]
    standing = [replace(b, rotary_inertia=0.0, rotational=0.0) if b in at_ends else b for b in bodies]
    return replace(
        chain,
        compliances=compliances,
        joint_inertias=taken,
        tension=tension,
        foundation=beam.foundation * unit**4 / stiffness,
        bodies=tuple(standing),
        attachment=attachment,
        elastic=elastic,
        end_inertias=(inertias[0], inertias[1]),
        end_springs=(springs[0] * bool(inertias[0]), springs[1] * bool(inertias[1])),
        end_compliances=(beyond[0], beyond[1]),
        end_joints=(float(chain.compliances[0]), float(chain.compliances[-1])),
        lines=beam.rigid_lines,
    )
