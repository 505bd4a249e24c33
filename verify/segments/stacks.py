"""Chains of many beams of one layout as one stack of pencils: what `chain_pencil` has of each, the beam's axis last."""

from collections.abc import Hashable, Sequence
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.models.arrays import Array, Indices
from verify.models.band_stack import Pencils, banded, of_unknowns
from verify.models.division import divide_each
from verify.models.stacks import PencilStack
from verify.segments.attached import is_mended, mended, places_on, plainly
from verify.segments.crowded import Links, mend_each, near
from verify.segments.links import Chain, elastic_ends, joint_compliance, link_inertia
from verify.segments.walls import wall_factors

_OWN = ("mass_per_length", "bending_stiffness")


class Chains(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Chains of N links of n_beams beams on the same supports, in the units of each (`Chain`)."""

    free: Indices
    """Joints that the supports leave free, (n,)."""
    lengths: Array
    """(N, n_beams)."""
    joints: Array
    """(N + 1, n_beams), k of the joints, zero where an end has none."""
    masses: Array
    """(N, n_beams)."""
    inertias: Array
    """(N, n_beams)."""
    ground: Array | None = None
    """(N, n_beams), what resists the links' middles, None where nothing does."""
    twist: Array | None = None
    """(N, n_beams), what resists their turns, likewise."""
    felt: Array | None = None
    """(bodies, N + 1, n_beams), weights of the joints' positions for bodies and springs, None where there are none."""
    turned: Array | None = None
    """(bodies, N, n_beams), of the links' turns."""
    bodies: Array | None = None
    """(4, bodies, n_beams), mass, rotary inertia, stiffness and rotational stiffness."""


def layout(beam: Beam, wall: str, joints: str, grading: float, theory: str, attachment: str) -> Hashable:
    """What beams have in common that one stack takes, and whose refusals are the same; None for one to be taken alone.

    Alone are chains that slip, printed, tensioned thick and welded ones, what is compressed and may buckle, and rotary
    inertias at an end, which turn beyond its joint.
    """
    if theory == "timoshenko" or wall == "welded" or joints == "printed" or beam.tension < 0.0:
        return None
    if joints == "tensioned" and (beam.tension or theory != "euler-bernoulli"):
        return None
    if theory != "euler-bernoulli" and (beam.tension or any(piece.rotary_inertia is None for piece in beam.pieces)):
        return None
    if not (beam.mass or beam.spring or beam.tension or beam.foundation):
        return (beam.supports, len(beam.section))
    if any(mass.rotary_inertia and mass.position in (0.0, beam.length) for mass in beam.mass):
        return None
    loads = (len(beam.mass) + len(beam.spring), beam.tension > 0.0, beam.foundation > 0.0)
    return (beam.supports, len(beam.section), *loads, beam.rigid_motions, elastic_ends(beam, attachment))


def chain_stack(beams: Sequence[Beam], n_segments: int, settings: dict[str, Any]) -> PencilStack:
    """The pencils of beams of one `layout`."""
    first = beams[0]
    loaded = first.mass or first.spring or first.tension or first.foundation
    chains = (_loaded if loaded else _plain)(beams, n_segments, settings)
    springs = [chains.joints, *_present(chains.ground, chains.twist)]
    if chains.bodies is not None:
        springs += [*chains.bodies[2:]]
    return PencilStack(
        pencils=_pencils(chains),
        strain=lambda vectors: _strain(chains, vectors),
        loads=lambda forces: _loads(chains, forces),
        springs=np.concatenate(springs),
        rigid_modes=first.rigid_motions,
        masses=None if chains.bodies is None else lambda vectors: _weighed(chains, vectors),
    )


def _present(*arrays: Array | None) -> list[Array]:
    return [array for array in arrays if array is not None]


def _free(supports: tuple[str, str], n_segments: int) -> Indices:
    left, right = (support in ("pinned", "clamped") for support in supports)
    return np.arange(int(left), n_segments + 1 - right)


def _plain(
    beams: Sequence[Beam], n_segments: int, settings: dict[str, Any], elastic: tuple[bool, bool] = (False, False)
) -> Chains:
    """Links, joints and walls alone, without a chain for each beam; `elastic` ends have joints of their own."""
    supports = beams[0].supports
    parts = divide_each(beams, n_segments, [beam.pieces for beam in beams], settings["grading"])
    lengths, stiffness = parts.lengths, parts.stiffnesses
    inner = joint_compliance(lengths[:-1], stiffness[:-1], lengths[1:], stiffness[1:])
    ends = lengths / stiffness
    factors = wall_factors(supports, n_segments, settings["wall"], elastic)[:, None]
    masses = lengths * parts.masses_per_length
    inertias = link_inertia(masses, lengths)
    if settings["theory"] == "rayleigh":
        rotary = np.array([[piece.rotary_inertia for piece in beam.pieces] for beam in beams]).T
        own = np.array([beam.mass_per_length for beam in beams])
        inertias = inertias + lengths * parts.of_pieces(rotary) / (own * parts.unit**2)
    return Chains(
        free=_free(supports, n_segments),
        lengths=lengths,
        joints=1.0 / (np.concatenate([ends[:1], inner, ends[-1:]]) * factors),
        masses=masses,
        inertias=inertias,
    )


def _loaded(beams: Sequence[Beam], n_segments: int, settings: dict[str, Any]) -> Chains:
    """The same of chains that carry something, as `carried` has it of each."""
    attachment = settings["attachment"]
    elastic = elastic_ends(beams[0], attachment)
    chains = _plain(beams, n_segments, settings, elastic)
    lengths, unit = chains.lengths, np.array([beam.length for beam in beams]) / n_segments
    scale = unit**2 / np.array([beam.bending_stiffness for beam in beams])
    ground = np.array([beam.foundation for beam in beams]) * unit**2 * scale * lengths
    twist = np.array([beam.tension for beam in beams]) * scale * lengths + ground * lengths**2 / 12.0
    chains = replace(chains, ground=ground if ground.any() else None, twist=twist if twist.any() else None)
    if not (beams[0].mass or beams[0].spring):
        return chains
    joints, bodies = _beyond(beams, chains.joints, _bodies(beams, unit), elastic)
    felt, turned = _where_felt(beams, chains, unit, attachment, elastic)
    return replace(chains, joints=joints, bodies=bodies, felt=felt, turned=turned)


def _positions_of(beam: Beam) -> list[float]:
    """Where masses and then springs stand, metres."""
    return [mass.position for mass in beam.mass] + [spring.position for spring in beam.spring]


def _bodies(beams: Sequence[Beam], unit: Array) -> Array:
    """Mass, rotary inertia, stiffness and rotational stiffness of all bodies in units, (4, bodies, n_beams)."""
    rows = [
        [(mass.mass, mass.rotary_inertia, 0.0, 0.0) for mass in beam.mass]
        + [(0.0, 0.0, spring.stiffness, spring.rotational) for spring in beam.spring]
        for beam in beams
    ]
    mass, stiffness = (np.array([getattr(beam, own) for beam in beams]) for own in _OWN)
    scales = np.array([1.0 / (mass * unit), 1.0 / (mass * unit**3), unit**3 / stiffness, unit / stiffness])
    return np.asarray(np.array(rows).transpose(2, 1, 0) * scales[:, None])


def _beyond(beams: Sequence[Beam], joints: Array, bodies: Array, elastic: tuple[bool, bool]) -> tuple[Array, Array]:
    """(k of the joints, bodies) with the rotational springs at elastic ends put beyond their joints."""
    places = np.array([_positions_of(beam) for beam in beams]).T
    joints, bodies = joints.copy(), bodies.copy()
    for end, there, at in zip((0, -1), elastic, (0.0, np.array([beam.length for beam in beams])), strict=True):
        if there:
            of_end = np.where(places == at, bodies[3], 0.0)
            joints[end] = 1.0 / (1.0 / joints[end] + 1.0 / of_end.sum(axis=0))
            bodies[3] -= of_end
    return joints, bodies


def _where_felt(
    beams: Sequence[Beam], chains: Chains, unit: Array, attachment: str, elastic: tuple[bool, bool]
) -> tuple[Array, Array]:
    """Where bodies are felt (`felt_together`), (bodies, N + 1, n_beams) and (bodies, N, n_beams)."""
    n, n_beams = chains.lengths.shape
    positions = np.array([_positions_of(beam) for beam in beams]).T
    felt, turned = np.zeros((n_beams, len(positions), n + 1)), np.zeros((n_beams, len(positions), n))
    standing, on = np.zeros(positions.shape, dtype=np.intp), np.zeros(positions.shape)
    for body, row in enumerate(positions):
        standing[body], on[body], even = places_on(chains.lengths, row / unit)
        at_once = even & is_mended(attachment, n)
        felt[at_once, body], turned[at_once, body] = mended(
            beams[0].supports, n, standing[body, at_once], on[body, at_once]
        )
        for j in map(int, np.flatnonzero(~at_once)):
            where = int(standing[body, j]), float(on[body, j])
            felt[j, body], turned[j, body] = plainly(_chain_of(beams[j], chains, j), float(row[j]), attachment, *where)
    crowded = np.flatnonzero(near(standing + on, n) & is_mended(attachment, n))
    links = Links(
        supports=beams[0].supports,
        elastic=elastic,
        lengths=chains.lengths.T[crowded],
        compliances=_compliances(chains.joints).T[crowded],
    )
    mended_felt, mended_turned = felt[crowded], turned[crowded]
    mend_each((standing + on).T[crowded], mended_felt, mended_turned, links)
    felt[crowded], turned[crowded] = mended_felt, mended_turned
    return np.ascontiguousarray(felt.transpose(1, 2, 0)), np.ascontiguousarray(turned.transpose(1, 2, 0))


def _chain_of(beam: Beam, chains: Chains, index: int) -> Chain:
    """The links of a beam and the beam's own joints."""
    return Chain(
        supports=beam.supports,
        rigid_motions=beam.rigid_motions,
        unit=beam.length / len(chains.lengths),
        start=0.0,
        lengths=chains.lengths[:, index],
        compliances=_compliances(chains.joints[:, index]),
        masses=chains.masses[:, index],
        inertias=chains.inertias[:, index],
    )


def _compliances(joints: Array) -> Array:
    """Infinite where there is no joint."""
    return np.divide(1.0, joints, out=np.full_like(joints, np.inf), where=joints > 0.0)


def _pencils(chains: Chains) -> Pencils:
    """K and M over the free joints."""
    n, n_beams = chains.joints.shape
    stiffness, mass = np.zeros((n, 3, n_beams)), np.zeros((n, 2, n_beams))
    _add_angles(chains, stiffness)
    _add_links(chains, mass, chains.masses, chains.inertias)
    if chains.ground is not None or chains.twist is not None:
        none = np.zeros_like(chains.lengths)
        ground, twist = (none if one is None else one for one in (chains.ground, chains.twist))
        _add_links(chains, stiffness, ground, twist)
    alone = banded(of_unknowns(stiffness, chains.free), of_unknowns(mass, chains.free))
    if chains.bodies is None:
        return alone
    heavy, held = (np.concatenate(chains.bodies[one]) for one in (slice(2), slice(2, 4)))
    there = np.flatnonzero(heavy.any(axis=1) | held.any(axis=1))
    felt = _body_rows(chains)[there][:, chains.free].swapaxes(0, 1)
    return replace(alone, felt=np.ascontiguousarray(felt), held=held[there], heavy=heavy[there])


def _add_angles(chains: Chains, bands: Array) -> None:
    """Joints that resist the differences of their links' turns."""
    slopes = _padded(1.0 / chains.lengths)
    before, at, after, joints = slopes[:-1], -(slopes[:-1] + slopes[1:]), slopes[1:], chains.joints
    bands[:, 0] += joints * at**2
    bands[:-1, 0] += (joints * before**2)[1:]
    bands[1:, 0] += (joints * after**2)[:-1]
    bands[:-1, 1] += (joints * at * after)[:-1] + (joints * before * at)[1:]
    bands[:-2, 2] += (joints * before * after)[1:-1]


def _add_links(chains: Chains, bands: Array, of_middles: Array, of_turns: Array) -> None:
    """What acts on the middles and on the turns of the links (`links.joint_masses`)."""
    spin = of_turns / chains.lengths**2
    own = of_middles / 4.0 + spin
    bands[:-1, 0] += own
    bands[1:, 0] += own
    bands[:-1, 1] += of_middles / 4.0 - spin


def _body_rows(chains: Chains) -> Array:
    """What bodies feel of positions and then of turns, over the joints, (2 bodies, N + 1, n_beams)."""
    assert chains.felt is not None
    assert chains.turned is not None
    by_slope = chains.turned / chains.lengths
    padded = np.zeros((len(by_slope), len(chains.joints) + 1, by_slope.shape[2]))
    padded[:, 1:-1] = by_slope
    return np.concatenate([chains.felt, padded[:, :-1] - padded[:, 1:]])


def _padded(values: Array) -> Array:
    """Values (N, ...) with a row of zeros before and after."""
    padded = np.zeros((len(values) + 2, *values.shape[1:]))
    padded[1:-1] = values
    return padded


def _positions(chains: Chains, vectors: Array) -> Array:
    """Of joints 0..N, (N + 1, k, n_beams): zeros at held ends."""
    found = np.zeros((len(chains.joints), *vectors.shape[1:]))
    found[chains.free[0] : chains.free[-1] + 1] = vectors
    return found


def _strain(chains: Chains, vectors: Array) -> Array:
    """Everything that costs energy, (m, k, n_beams), by differences of differences."""
    places = _positions(chains, vectors)
    turns = np.diff(places, axis=0) / chains.lengths[:, None]
    found = [np.diff(_padded(turns), axis=0)]
    if chains.ground is not None:
        found.append(0.5 * (places[1:] + places[:-1]))
    if chains.twist is not None:
        found.append(turns)
    if chains.bodies is not None:
        found += _felt(chains, places, turns)
    return np.concatenate(found) if len(found) > 1 else found[0]


def _loads(chains: Chains, forces: Array) -> Array:
    """What forces (m, k, n_beams) in the strains are on the free joints, (n, k, n_beams)."""
    n = len(chains.joints)
    turning, forces = forces[: n - 1] - forces[1:n], forces[n:]
    found = np.zeros((n, *forces.shape[1:]))
    if chains.ground is not None:
        halves, forces = 0.5 * forces[: n - 1], forces[n - 1 :]
        found[1:] += halves
        found[:-1] += halves
    if chains.twist is not None:
        turning, forces = turning + forces[: n - 1], forces[n - 1 :]
    if chains.felt is not None and chains.turned is not None:
        of_places, of_turns = np.split(forces, 2)
        found += np.einsum("bin,bkn->ikn", chains.felt, of_places)
        turning = turning + np.einsum("bin,bkn->ikn", chains.turned, of_turns)
    shares = turning / chains.lengths[:, None]
    found[1:] += shares
    found[:-1] -= shares
    return found[chains.free[0] : chains.free[-1] + 1]


def _felt(chains: Chains, places: Array, turns: Array) -> tuple[Array, Array]:
    """Deflections and turns of bodies, (bodies, k, n_beams) both."""
    assert chains.felt is not None
    assert chains.turned is not None
    pairs = ((chains.felt, places), (chains.turned, turns))
    felt, turned = (np.einsum("bin,ikn->bkn", weights, values) for weights, values in pairs)
    return felt, turned


def _weighed(chains: Chains, vectors: Array) -> Array:
    """V^T M v by the turns themselves, (k, n_beams) (`loaded`)."""
    places = _positions(chains, vectors)
    turns, middles = np.diff(places, axis=0) / chains.lengths[:, None], 0.5 * (places[1:] + places[:-1])
    felt, turned = _felt(chains, places, turns)
    assert chains.bodies is not None
    moving = [chains.masses, chains.inertias, *chains.bodies[:2]]
    motions = [middles, turns, felt, turned]
    return np.asarray(sum(np.einsum("in,ikn->kn", one, motion**2) for one, motion in zip(moving, motions, strict=True)))
