"""Finite segments: rigid links and joint springs, linearised about the straight chain. Modes and harmonic field."""

from collections.abc import Callable, Sequence
from math import pi, sqrt

import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_number, check_whole
from verify.errors import InputError, near_name
from verify.models.arrays import Array, ComplexArray
from verify.models.division import check_division
from verify.models.driven_pencil import damped_response, modal_receptance, refuse_near_resonance
from verify.models.eigen import Eigenpairs, FactoredPencil, check_size, lowest, method_name
from verify.models.fields import HarmonicField, check_drive, phasor
from verify.models.modes import Modes
from verify.models.places import Forces, Numbers, as_forces, as_typed, in_a_row
from verify.options import JOINTS, LOADS, READINGS, WALLS, Joints, Load, Reading, Wall
from verify.segments.links import (
    Chain,
    build_chain,
    chain_pencil,
    free_joints,
    joint_curvatures,
    with_ends,
)
from verify.segments.loads import joint_weights
from verify.segments.reading import corrected_reading, spline_at

FIELD = "n_segments"


def unknowns(beam: Beam, n_segments: int) -> int:
    """How many joint positions the supports leave free."""
    return n_segments + 1 - sum(support in ("pinned", "clamped") for support in beam.supports)


def n_elastic(beam: Beam, n_segments: int) -> int:
    """How many elastic modes the chain has: unknowns less rigid motions."""
    return max(unknowns(beam, n_segments) - beam.rigid_motions, 0)


@as_typed
def solve_modes(
    beam: Beam,
    n_modes: int,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
) -> Modes:
    """The first `n_modes` elastic modes of the beam as `n_segments` rigid links.

    Links have their own rotary inertia m l^2/12 (the paper, Section II.A). `joints` is Eq. (1) in its
    "series" form or as "printed"; `wall` says how a clamped end is held (`options.WALLS`); `grading` is the
    length of a section's last link over its first. Frequencies are those of the chain to rounding. Shapes are
    read at the joints with the correction y + delta^2 y / 12 (order 4, next to a clamped wall 2; the raw y,
    order 2, is the reading "raw") and through a cubic spline between. Raises InputError for unknown settings,
    more modes than the chain has or sizes that do not fit into memory.
    """
    check(beam, n_modes, n_segments, wall=wall, joints=joints, grading=grading)
    chain = build_chain(beam, n_segments, wall=wall, joints=joints, grading=grading)
    return _modes(beam, chain, lowest(chain_pencil(chain), n_modes))


def check(
    beam: Beam,
    n_modes: int,
    n_segments: int,
    *,
    wall: str = "gregory",
    joints: str = "series",
    grading: float = 1.0,
) -> None:
    """Raise InputError, before anything is allocated, where `solve_modes` would refuse."""
    if wall not in WALLS:
        raise InputError(f"wall = {wall!r} is not known: {near_name(wall, WALLS)}")
    if joints not in JOINTS:
        raise InputError(f"joints = {joints!r} is not known: {near_name(joints, JOINTS)}")
    check_whole("n_modes", n_modes, 1)
    check_whole(FIELD, n_segments, 2)  # a single link does not bend
    if wall == "welded" and (beam.section or grading != 1.0):
        raise InputError("wall = 'welded' is for uniform beams of equal segments: choose another wall")
    check_division(beam, n_segments, grading)
    check_size(unknowns(beam, n_segments), n_modes, n_elastic(beam, n_segments), FIELD, n_segments)


def _modes(beam: Beam, chain: Chain, pairs: Eigenpairs) -> Modes:
    frequencies = np.sqrt(pairs.values) * (beam.wave_constant / (2.0 * pi)) / chain.unit**2
    raw = with_ends(chain, pairs.vectors).T * _sign(chain, pairs.vectors)[:, None]
    raw /= sqrt(beam.mass_per_length * chain.unit)

    def corrected() -> Array:
        return corrected_reading(chain, raw)

    def shapes(x: Array, derivative: int) -> Array:
        return spline_at(chain, corrected(), x, derivative)

    def curvatures() -> Array:
        return joint_curvatures(chain, raw)

    nodes = chain.nodes
    return Modes(
        model="segment",
        count=chain.n_segments,
        length=beam.length,
        frequencies_hz=frequencies,
        shapes=shapes,
        nodes=nodes,
        readings={"corrected": corrected, "raw": lambda: raw},
        points=nodes,
        sampled=corrected,
        curvature_points=nodes,
        curvatures=curvatures,
        method=pairs.method,
    )


def _sign(chain: Chain, free: Array) -> Array:
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
) -> HarmonicField:
    """The steady field of the chain under harmonic point forces, e^{+i omega t}.

    `load` shares a force among the joints (`loads`). The field between the joints is the C2 spline of the
    paper's contact line (Section II.B) through the "corrected" or the "raw" joints, or that of the rigid "links"
    themselves: straight, its slope the link's, the mean of both at a joint. Damping: the beam's loss factor;
    `modal_damping` zeta of every mode (equivalent near a resonance: eta = 2 zeta); `joint_dashpot` c in N m s
    at every joint (eta = omega c / k). Raises InputError; an undamped resonance of the chain is refused.
    """
    forces = as_forces(forces)
    check(beam, 1, n_segments, wall=wall, joints=joints, grading=grading)
    _check_harmonic(beam, forces, frequency_hz, load, reading, modal_damping, joint_dashpot)
    chain = build_chain(beam, n_segments, wall=wall, joints=joints, grading=grading)
    pencil = chain_pencil(chain)
    omega2 = (2.0 * pi * frequency_hz / beam.wave_constant) ** 2 * chain.unit**4
    if not (beam.loss_factor or modal_damping or joint_dashpot):
        refuse_near_resonance("segment", beam, pencil, omega2, frequency_hz, solve_modes, n_segments)
    loads = _loads(chain, forces, load) * (chain.unit**3 / beam.bending_stiffness)
    stiffness = _damped(beam, chain, pencil, 2.0 * pi * frequency_hz * joint_dashpot)
    raw = with_ends(chain, damped_response(pencil, loads, omega2, stiffness, modal_damping)).T
    return HarmonicField(
        model="segment",
        count=n_segments,
        beam=beam,
        frequency_hz=frequency_hz,
        forces=tuple(forces),
        shapes=_field_shapes(chain, raw, reading),
    )


def _damped(beam: Beam, chain: Chain, pencil: FactoredPencil, dashpots: float) -> ComplexArray:
    """The stiffness with the beam's loss factor and dashpots of omega c, N m, at every joint."""
    lossy = pencil.stiffness * (1.0 + 1j * beam.loss_factor) + 1j * (dashpots * chain.unit / beam.bending_stiffness)
    return np.asarray(lossy, dtype=complex)


def _check_harmonic(
    beam: Beam, forces: Sequence[PointForce], frequency_hz: float, load: str, reading: str, zeta: float, dashpot: float
) -> None:
    check_drive(beam, forces, frequency_hz)
    if load not in LOADS:
        raise InputError(f"load = {load!r} is not known: {near_name(load, LOADS)}")
    if reading not in READINGS:
        raise InputError(f"reading = {reading!r} is not known: {near_name(reading, READINGS)}")
    check_number("modal_damping", zeta, "0 means none", at_least=0, below=1)
    check_number("joint_dashpot", dashpot, "N m s, 0 means none", at_least=0)


def _loads(chain: Chain, forces: Sequence[PointForce], rule: str) -> ComplexArray:
    """The forces on the free joints, (n, 1), newton."""
    total = sum(phasor(force) * joint_weights(chain, force.position, rule) for force in forces)
    return np.asarray(total, dtype=complex)[free_joints(chain), None]


def _field_shapes(chain: Chain, raw: ComplexArray, reading: str) -> Callable[[Array, int], ComplexArray]:
    """The field between the joints; raw is (1, N + 1) complex."""
    if reading == "links":
        return lambda x, derivative: _link_reading(chain, raw[0], x, derivative)
    parts = np.vstack([raw.real, raw.imag])
    values = corrected_reading(chain, parts) if reading == "corrected" else parts

    def shapes(x: Array, derivative: int) -> ComplexArray:
        real, imaginary = spline_at(chain, values, x, derivative)
        return np.asarray(real + 1j * imaginary)

    return shapes


def _link_reading(chain: Chain, joints: ComplexArray, x: Array, derivative: int) -> ComplexArray:
    """The rigid links as they stand: deflection straight between the joints, slope of the link or links at x."""
    nodes = chain.nodes
    if derivative == 0:
        return np.asarray(np.interp(x, nodes, joints.real) + 1j * np.interp(x, nodes, joints.imag))
    if derivative > 1:
        return np.zeros(len(x), dtype=complex)
    slopes = np.diff(joints) / (chain.lengths * chain.unit)
    slack = 1e-9 * chain.unit
    before, after = (
        np.clip(np.searchsorted(nodes, x + side, side="right") - 1, 0, chain.n_segments - 1) for side in (-slack, slack)
    )
    return np.asarray(0.5 * (slopes[before] + slopes[after]))


def unit_responses(
    beam: Beam, positions: Numbers, frequencies_hz: Numbers, x: Numbers, n_segments: int
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    All modes of the chain are solved once and summed exactly for every frequency. Load and reading are the
    defaults of `solve_harmonic`. NaN at the frequencies of undamped resonances. Raises InputError for chains
    beyond the dense size.
    """
    positions, x = in_a_row("positions", positions), in_a_row("x", x)
    frequencies_hz = in_a_row("frequencies_hz", frequencies_hz)
    check(beam, 1, n_segments)
    chain = build_chain(beam, n_segments)
    pencil = chain_pencil(chain)
    weights = np.array([joint_weights(chain, p, "reciprocal")[free_joints(chain)] for p in positions]).T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * chain.unit**4
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    shapes = spline_at(chain, corrected_reading(chain, with_ends(chain, modes).T), x, 0)
    return np.asarray(receptance @ shapes) * (chain.unit**3 / beam.bending_stiffness)


def method(beam: Beam, n_modes: int, n_segments: int) -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_segments), n_modes)
