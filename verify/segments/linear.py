"""Finite segments: rigid links and joint springs, linearised about the straight chain. Modes and harmonic field."""

from collections.abc import Callable, Iterable
from functools import lru_cache, partial
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.checks import check_number, check_whole, check_word
from verify.errors import InputError
from verify.linear.driven_pencil import check_dampings, harmonic_response, modal_receptance, name_resonance
from verify.linear.eigen import Eigenpairs, check_size, lowest
from verify.linear.fields import HarmonicField, check_drive, phasor, unit_drives
from verify.linear.mesh import check_division
from verify.linear.modes import Modes
from verify.linear.pencil import FactoredPencil
from verify.linear.places import Forces, Numbers, as_forces, as_typed, within
from verify.linear.response import forced_response
from verify.linear.sweeps import FIELD as FREQUENCIES
from verify.linear.sweeps import HarmonicSweep, swept_frequencies, swept_modes
from verify.linear.theory import check_theory
from verify.options import ATTACHMENTS, LOADS, READINGS, THEORIES, Attachment, Joints, Load, Reading, Theory, Wall
from verify.problem.beam import Beam, PointForce
from verify.segments.assembly import build_chain, chain_pencil, check_set_up
from verify.segments.links import FIELD, Chain, elastic_ends, free_joints
from verify.segments.loads import joint_weights
from verify.segments.reading import (
    joint_curvatures,
    joint_positions,
    joint_readings,
    line_through,
    link_middles,
    link_slopes,
)

_FEWEST_MENDED = 6
"""Links of which mended joints that slip leave a positive mass, whatever stands at the ends."""


@as_typed
def unknowns(
    beam: Beam, n_segments: int, theory: Theory = "euler-bernoulli", attachment: Attachment = "reciprocal"
) -> int:
    """How many joint positions the supports leave free, slips of joints and turns of bodies beyond end joints.

    Raises InputError for a count, a theory or an attachment that is none.
    """
    check_whole(FIELD, n_segments, 1)
    check_word("theory", theory, THEORIES)
    check_word("attachment", attachment, ATTACHMENTS)
    held = sum(support in ("pinned", "clamped") for support in beam.supports)
    slips = n_segments - 1 + held if theory == "timoshenko" else 0
    weighty = {m.position for m in beam.mass if m.rotary_inertia}
    ends = zip((0.0, beam.length), elastic_ends(beam, attachment), strict=True)
    return n_segments + 1 - held + slips + sum(elastic and at in weighty for at, elastic in ends)


@as_typed
def n_elastic(
    beam: Beam, n_segments: int, theory: Theory = "euler-bernoulli", attachment: Attachment = "reciprocal"
) -> int:
    """How many elastic modes the chain has: unknowns less rigid motions. Raises InputError likewise."""
    return max(unknowns(beam, n_segments, theory, attachment) - beam.rigid_motions, 0)


@as_typed
def solve_modes(
    beam: Beam,
    n_modes: int,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> Modes:
    """The first `n_modes` elastic modes of the beam as `n_segments` rigid links.

    Links have their own rotary inertia m l^2/12 (the paper, Section II.A). `joints` is Eq. (1) in its
    "series" form or as "printed", or "tensioned" for beams under axial force; `wall` says how a clamped end is held
    (`options.WALLS`); `grading` is the length of a section's last link over its first. `theory` adds the links'
    thickness inertia ("rayleigh") and joints that slip ("timoshenko"); `attachment` says how masses and springs sit
    on their links (`attached`). Frequencies are those of the chain to rounding. Shapes are
    read at the joints with the correction y + delta^2 y / 12 (order 4, next to a clamped wall 2; the raw y,
    order 2, is the reading "raw") and through a cubic spline between. Raises InputError for unknown settings,
    more modes than the chain has, sizes that do not fit into memory, and compression beyond the chain's buckling.
    """
    settings = settings_of(wall, joints, grading, theory, attachment)
    check(beam, n_modes, n_segments, **settings)
    chain = build_chain(beam, n_segments, **settings)
    try:
        return _modes(beam, chain, lowest(chain_pencil(chain), n_modes))
    except np.linalg.LinAlgError:
        if joints != "tensioned":
            raise
        raise InputError(
            f"{FIELD} = {n_segments}: joints = 'tensioned' and wall = {wall!r} take more off the mass of a beam as "
            "thick as this than its end links have: choose joints = 'series', or another wall or n_segments"
        ) from None


def settings_of(wall: Wall, joints: Joints, grading: float, theory: Theory, attachment: Attachment) -> dict[str, Any]:
    """How the chain is set up, by the keywords of `build_chain`."""
    return {"wall": wall, "joints": joints, "grading": grading, "theory": theory, "attachment": attachment}


@as_typed
def check(
    beam: Beam,
    n_modes: int,
    n_segments: int,
    *,
    wall: str = "gregory",
    joints: str = "series",
    grading: float = 1.0,
    theory: str = "euler-bernoulli",
    attachment: str = "reciprocal",
) -> None:
    """Raise InputError, before anything large is allocated, where `solve_modes` would refuse."""
    check_set_up(n_segments, wall, joints, attachment)
    check_whole("n_modes", n_modes, 1)
    if wall == "welded" and (beam.added or grading != 1.0 or theory != "euler-bernoulli"):
        raise InputError(
            "wall = 'welded' is for uniform beams of equal segments with nothing on them: choose another wall"
        )
    if joints == "tensioned" and theory == "timoshenko" and n_segments < _FEWEST_MENDED:
        raise InputError(
            f"{FIELD} = {n_segments}: joints = 'tensioned' with theory = 'timoshenko' take {_FEWEST_MENDED} or more, "
            "raise it or choose joints = 'series'"
        )
    check_division(beam, n_segments, grading)
    check_theory(beam, theory)
    available = n_elastic(beam, n_segments, theory, attachment)  # type: ignore[arg-type]
    check_size(unknowns(beam, n_segments, theory, attachment), n_modes, available, FIELD, n_segments)  # type: ignore[arg-type]
    if beam.tension:
        from verify.segments.buckling import check_loaded

        check_loaded(beam, n_segments, wall, joints, grading, attachment)


def _modes(beam: Beam, chain: Chain, pairs: Eigenpairs) -> Modes:
    vectors = pairs.vectors * (leading_sign(chain, pairs.vectors) / sqrt(beam.mass_per_length * chain.unit))
    raw = joint_positions(chain, vectors)

    def corrected() -> Array:
        return joint_readings(chain, vectors)

    shapes = line_through(chain, corrected)

    def curvatures() -> Array:
        return joint_curvatures(chain, vectors, pairs.values)

    nodes = within(chain.nodes, beam.length)
    return Modes(
        model="segment",
        count=chain.n_segments,
        length=beam.length,
        frequencies_hz=_frequencies(beam, chain, pairs.values),
        shapes=shapes,
        nodes=nodes,
        readings={"corrected": corrected, "raw": lambda: raw},
        points=nodes,
        sampled=corrected,
        curvature_points=nodes,
        curvatures=curvatures,
        method=pairs.method,
    )


def _frequencies(beam: Beam, chain: Chain, values: Array) -> Array:
    """Hz, of eigenvalues in the chain's units."""
    return np.asarray(np.sqrt(values) * (beam.wave_constant / (2.0 * pi)) / chain.unit**2)


def leading_sign(chain: Chain, free: Array) -> Array:
    """+-1 for each mode, (k,): positive where the chain first moves off its left end."""
    return np.where(free[0] < 0, -1.0, 1.0)


@as_typed
def solve_harmonic(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    n_segments: int,
    *,
    load: Load = "reciprocal",
    reading: Reading = "corrected",
    modal_damping: float = 0.0,
    joint_dashpot: float = 0.0,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> HarmonicField:
    """The steady field of the chain under harmonic point forces, e^{+i omega t}.

    `load` shares a force among the joints (`loads`). The field between the joints is the C2 spline of the
    paper's contact line (Section II.B) through the "corrected" or the "raw" joints, or that of the rigid "links"
    themselves: straight, its slope the link's, the mean of both at a joint. Damping: the beam's loss factor;
    `modal_damping` zeta of every mode (near a resonance eta = 2 zeta where all stiffness has the loss); `joint_dashpot`
    c in N m s at every joint (eta = omega c / k); springs, ground and axial force have no loss. Raises InputError; an
    undamped resonance of the chain is refused, and a loss factor with `modal_damping` where there are springs, axial
    force or ground: the modes would couple.
    """
    forces = as_forces(forces)
    check_drive(beam, forces, frequency_hz)
    settings = settings_of(wall, joints, grading, theory, attachment)
    driven = (load, reading, modal_damping, joint_dashpot)
    return _fields(beam, forces, np.array([frequency_hz]), n_segments, driven, settings).field(0)


@as_typed
def sweep_harmonic(
    beam: Beam,
    forces: Forces,
    frequencies_hz: Numbers,
    n_segments: int,
    *,
    load: Load = "reciprocal",
    reading: Reading = "corrected",
    modal_damping: float = 0.0,
    joint_dashpot: float = 0.0,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> HarmonicSweep:
    """The steady fields of `solve_harmonic` at many frequencies, to rounding.

    Raises InputError as `solve_harmonic` does, by index: of several resonances the first.
    """
    forces = as_forces(forces)
    settings = settings_of(wall, joints, grading, theory, attachment)
    check(beam, 1, n_segments, **settings)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, 2 * n_segments)
    driven = (load, reading, modal_damping, joint_dashpot)
    return _fields(beam, forces, frequencies, n_segments, driven, settings, FREQUENCIES)


def _fields(
    beam: Beam,
    forces: tuple[PointForce, ...],
    frequencies: Array,
    n_segments: int,
    driven: tuple[Load, Reading, float, float],
    settings: dict[str, Any],
    field: str = "",
) -> HarmonicSweep:
    """The fields at frequencies, (n,); `field` names them in messages by index."""
    load, reading, modal_damping, joint_dashpot = driven
    check(beam, 1, n_segments, **settings)
    check_word("load", load, LOADS)
    check_word("reading", reading, READINGS)
    check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
    check_number("joint_dashpot", joint_dashpot, "N m s, 0 means none", at_least=0)
    check_dampings(beam, modal_damping)
    chain, pencil = _driven(beam, n_segments, settings)
    omega2 = (2.0 * pi * frequencies / beam.wave_constant) ** 2 * chain.unit**4

    def refuse(index: int) -> None:
        named = f"{field}[{index}]" if field else "frequency_hz"
        solve = partial(solve_modes, **settings)
        name_resonance("segment", beam, pencil, float(frequencies[index]), solve, n_segments, named)

    total = sum(phasor(force) * joint_weights(chain, force.position, load) for force in forces)
    loads = np.zeros((pencil.n, 1), dtype=complex)  # of which the free joints come first
    on_joints = np.asarray(total, dtype=complex)[free_joints(chain)]
    loads[: len(on_joints), 0] = on_joints * (chain.unit**3 / beam.bending_stiffness)
    if joint_dashpot:
        each = [damped(beam, chain, pencil, 2.0 * pi * float(f) * joint_dashpot) for f in frequencies]
        stiffness: ComplexArray = np.array(each)
    else:
        stiffness = damped(beam, chain, pencil, 0.0)
    undamped = not (beam.loss_factor or modal_damping or joint_dashpot)
    free = harmonic_response(pencil, loads, omega2, stiffness, modal_damping, refuse if undamped else None)
    return HarmonicSweep(
        theory=settings["theory"],
        model="segment",
        count=n_segments,
        beam=beam,
        frequencies_hz=frequencies,
        forces=forces,
        shapes=_field_shapes(chain, free, reading),
        turned=_field_turns(chain, free, reading),
    )


@as_typed
def sweep_modes(
    beams: Iterable[Beam],
    n_modes: int,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
    attachment: Attachment = "reciprocal",
) -> Array:
    """Frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Raises InputError as `solve_modes` does, naming the beam by its index.
    """
    check_set_up(n_segments, wall, joints, attachment)
    settings = settings_of(wall, joints, grading, theory, attachment)

    def solve(beam: Beam) -> Array:
        check(beam, n_modes, n_segments, **settings)
        chain = build_chain(beam, n_segments, **settings)
        return _frequencies(beam, chain, lowest(chain_pencil(chain), n_modes).values)

    return swept_modes(beams, n_modes, solve)


KEPT = 4000
"""Links up to which a chain is cached for the next frequency."""


def _driven(beam: Beam, n_segments: int, settings: dict[str, Any]) -> tuple[Chain, FactoredPencil]:
    """The chain of a beam and its pencil, which know no loss; small ones are cached."""
    bare = replace(beam, loss_factor=0.0) if beam.loss_factor else beam
    return (_cached if n_segments < KEPT else _made)(bare, n_segments, tuple(settings.items()))


def _made(beam: Beam, n_segments: int, settings: tuple[tuple[str, Any], ...]) -> tuple[Chain, FactoredPencil]:
    chain = build_chain(beam, n_segments, **dict(settings))
    return chain, chain_pencil(chain)


_cached = lru_cache(maxsize=16)(_made)


def damped(beam: Beam, chain: Chain, pencil: FactoredPencil, dashpots: float) -> ComplexArray:
    """The stiffness with the beam's loss factor and dashpots of omega c, N m, at every joint."""
    if not chain.plain:
        from verify.segments.loaded import lossy_stiffness

        return lossy_stiffness(
            chain, pencil.stiffness, beam.loss_factor, dashpots * chain.unit / beam.bending_stiffness
        )
    lossy = pencil.stiffness * (1.0 + 1j * beam.loss_factor) + 1j * (dashpots * chain.unit / beam.bending_stiffness)
    return np.asarray(lossy, dtype=complex)


def _field_turns(chain: Chain, free: ComplexArray, reading: str) -> Callable[[Array, int], ComplexArray] | None:
    """Turns of the section of the unknowns (n, k) complex: (x, derivative) -> (k, len(x)); None where nothing slips."""
    if chain.slips is None:
        return None
    if reading == "links":
        shapes = _field_shapes(chain, free, reading)
        return lambda x, derivative: shapes(x, derivative + 1)
    from verify.segments.turned import section_turns

    return section_turns(chain, free, reading == "corrected")


def _field_shapes(chain: Chain, free: ComplexArray, reading: str) -> Callable[[Array, int], ComplexArray]:
    """Fields between the joints of the unknowns (n, k) complex: (x, derivative) -> (k, len(x))."""
    if reading == "links":
        columns = free.T[:, :, None]
        return lambda x, derivative: np.array([_link_reading(chain, one, x, derivative) for one in columns])
    parts = np.hstack([free.real, free.imag])
    values = joint_readings(chain, parts) if reading == "corrected" else joint_positions(chain, parts)

    line = line_through(chain, lambda: values)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        real, imaginary = np.split(line(x, derivative), 2)
        return np.asarray(real + 1j * imaginary)

    return shapes


def _link_reading(chain: Chain, free: ComplexArray, x: Array, derivative: int) -> ComplexArray:
    """The rigid links as they stand: deflection straight between the joints, slope of the link or links at x.

    Between links that slip, the mean of both.
    """
    nodes, joints = chain.nodes, joint_positions(chain, free)[0]
    if derivative > 1:
        return np.zeros(len(x), dtype=complex)
    slack = 1e-9 * chain.unit
    before, after = (
        np.clip(np.searchsorted(nodes, x + side, side="right") - 1, 0, chain.n_segments - 1) for side in (-slack, slack)
    )
    slopes = link_slopes(chain, free)[0]
    if derivative == 1:
        return np.asarray(0.5 * (slopes[before] + slopes[after]))
    if chain.slips is None:
        return np.asarray(np.interp(x, nodes, joints.real) + 1j * np.interp(x, nodes, joints.imag))
    middles, centres = link_middles(chain, free)[0], 0.5 * (nodes[1:] + nodes[:-1])
    ends = [middles[link] + slopes[link] * (x - centres[link]) for link in (before, after)]
    return np.asarray(0.5 * (ends[0] + ends[1]))


@as_typed
def unit_responses(
    beam: Beam,
    positions: Numbers,
    frequencies_hz: Numbers,
    x: Numbers,
    n_segments: int,
    *,
    theory: Theory = "euler-bernoulli",
    joints: Joints = "series",
    attachment: Attachment = "reciprocal",
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    All modes of the chain are solved once and summed exactly for every frequency; every frequency is solved where
    there is a loss factor and the beam carries anything, or its joints slip. Load and reading are the defaults of
    `solve_harmonic`. NaN at the frequencies of undamped resonances. Raises InputError, also for chains beyond the
    dense size.
    """
    positions, frequencies_hz, x = unit_drives(beam, positions, frequencies_hz, x)
    settings = settings_of("gregory", joints, 1.0, theory, attachment)
    check(beam, 1, n_segments, **settings)
    chain, pencil = _driven(beam, n_segments, settings)
    weights = np.zeros((pencil.n, len(positions)))
    loads = [joint_weights(chain, p, "reciprocal")[free_joints(chain)] for p in positions]
    weights[: len(loads[0]) if loads else 0] = np.array(loads).T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * chain.unit**4
    scale = chain.unit**3 / beam.bending_stiffness
    if beam.loss_factor and not chain.plain:  # what has no loss would couple the modes
        stiffness = damped(beam, chain, pencil, 0.0)
        found = [forced_response(pencil, weights, float(square), stiffness) for square in omega2]
        read = [_read_at(chain, free.real, x) + 1j * _read_at(chain, free.imag, x) for free in found]
        return np.asarray(np.array(read, dtype=complex).reshape(len(omega2), len(positions), len(x)) * scale)
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    return np.asarray(receptance @ _read_at(chain, modes, x)) * scale


def _read_at(chain: Chain, free: Array, x: Array) -> Array:
    """The corrected reading of the unknowns (n, k) at x, (k, len(x))."""
    return line_through(chain, lambda: joint_readings(chain, free))(x, 0)
