"""Modes and harmonic fields of Hermite and Timoshenko elements: what the model answers in metres, hertz, newtons."""

from collections.abc import Iterable
from functools import lru_cache
from math import pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.checks import MOST_PARTS, check_number, check_whole, check_word
from verify.elements.mesh import HELD, KEPT, Elements, build_elements, check_cuts, point_loads
from verify.elements.pencil import check_unbuckled, damped_stiffness, element_pencil, mesh_buckling_load
from verify.linear.driven_pencil import check_dampings, harmonic_response, modal_receptance, name_resonance
from verify.linear.eigen import Eigenpairs, check_size, lowest
from verify.linear.fields import RESONANCE, HarmonicField, check_drive, phasor, unit_drives
from verify.linear.mesh import Parts
from verify.linear.modes import Modes
from verify.linear.pencil import FactoredPencil
from verify.linear.places import Forces, Numbers, as_forces, as_typed, within
from verify.linear.response import forced_response, resonance_distance
from verify.linear.sweeps import FIELD as FREQUENCIES
from verify.linear.sweeps import HarmonicSweep, swept_frequencies, swept_modes
from verify.linear.theory import check_theory
from verify.options import THEORIES, Theory
from verify.problem.beam import Beam, PointForce

FIELD = "n_elements"


@as_typed
def unknowns(beam: Beam, n_elements: int, theory: Theory = "euler-bernoulli") -> int:
    """How many nodal values the supports leave free, and two shear strains in each of Timoshenko's elements.

    Raises InputError for a count or a theory that is none.
    """
    check_whole(FIELD, n_elements, 1)
    check_word("theory", theory, THEORIES)
    inside = 2 * n_elements if theory == "timoshenko" else 0
    return 2 * n_elements + 2 + inside - sum(len(HELD[support]) for support in beam.supports)


@as_typed
def n_elastic(beam: Beam, n_elements: int, theory: Theory = "euler-bernoulli") -> int:
    """How many elastic modes the model has. Raises InputError likewise."""
    return unknowns(beam, n_elements, theory) - beam.rigid_motions


@as_typed
def solve_modes(
    beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0, theory: Theory = "euler-bernoulli"
) -> Modes:
    """The first `n_modes` elastic modes with `n_elements` elements and consistent mass.

    Cubic Hermite elements, under Timoshenko's theory with two shear strains in each. Elements end on the steps of the
    beam and where masses and springs stand; `grading` is the length of a stretch's last element over its first.
    Shapes are the elements' own cubics. Raises InputError for a wrong grading, more modes than unknowns, sizes that
    do not fit into memory, what a theory lacks, or a compression at which the elements buckle.
    """
    check_asked(beam, n_modes, n_elements, grading, theory)
    elements = build_elements(beam, n_elements, grading, theory)
    pairs = lowest(element_pencil(elements), n_modes)
    nodal = elements.all_values(pairs.vectors)
    nodal = nodal * leading_sign(elements, nodal)[:, None]
    return _modes(elements, nodal / sqrt(beam.mass_per_length * elements.parts.unit), pairs)


@as_typed
def check(
    beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0, theory: Theory = "euler-bernoulli"
) -> None:
    """Raise InputError where `solve_modes` would refuse: before anything is allocated, but for a mesh that buckles."""
    check_asked(beam, n_modes, n_elements, grading, theory)
    if beam.tension < 0.0:
        check_unbuckled(build_elements(beam, n_elements, grading, theory))


def check_asked(beam: Beam, n_modes: int, n_elements: int, grading: float, theory: Theory) -> None:
    """Raise InputError, before anything is allocated, for what elements cannot be asked for."""
    check_whole("n_modes", n_modes, 1)
    check_whole(FIELD, n_elements, 1, MOST_PARTS)
    check_theory(beam, theory)
    check_cuts(beam, n_elements, grading)
    free, elastic = unknowns(beam, n_elements, theory), n_elastic(beam, n_elements, theory)
    check_size(free, n_modes, elastic, FIELD, n_elements)


@as_typed
def buckling_load(beam: Beam, n_elements: int, *, grading: float = 1.0) -> float:
    """The compression at which `n_elements` elements buckle first, newton, whatever the beam's own axial force.

    0 where nothing keeps the beam from tilting. Raises InputError where `solve_modes` would.
    """
    compressed = replace(beam, tension=-float(beam.bending_stiffness / beam.length**2))
    check_asked(compressed, 1, n_elements, grading, "euler-bernoulli")
    return mesh_buckling_load(build_elements(compressed, n_elements, grading))


def _modes(elements: Elements, nodal: Array, pairs: Eigenpairs) -> Modes:
    beam, parts, basis, unit = elements.beam, elements.parts, elements.basis, elements.parts.unit

    def shapes(x: Array, derivative: int) -> Array:
        return np.asarray(basis.read(nodal, x / unit, derivative) / unit**derivative)

    quarters = _inside(parts, np.arange(4) / 4.0)
    points = np.append(quarters, parts.nodes[-1])
    gauss = _inside(parts, np.array([0.5 - 0.5 / sqrt(3.0), 0.5 + 0.5 / sqrt(3.0)]))
    return Modes(
        model="fem",
        count=len(parts.lengths),
        length=beam.length,
        frequencies_hz=_frequencies(elements, pairs.values),
        shapes=shapes,
        nodes=within(parts.nodes * unit, beam.length),
        readings={"nodal": lambda: nodal[:, basis.nodal_dofs[0]]},
        points=points * unit,
        sampled=lambda: basis.read(nodal, points),
        curvature_points=gauss * unit,
        curvatures=lambda: basis.read(nodal, gauss, 2) / unit**2,
        method=pairs.method,
    )


def _frequencies(elements: Elements, values: Array) -> Array:
    """Hz, of eigenvalues in the elements' units."""
    return np.asarray(np.sqrt(values) * (elements.beam.wave_constant / (2.0 * pi)) / elements.parts.unit**2)


def _inside(parts: Parts, xi: Array) -> Array:
    """The points xi of every element, in units from the left end, (N len(xi),)."""
    return np.asarray((parts.nodes[:-1, None] + parts.lengths[:, None] * xi).ravel())


def leading_sign(elements: Elements, nodal: Array) -> Array:
    """+-1 for each mode, (k,): by the first of deflection, slope, curvature that the left end leaves free."""
    if elements.beam.supports[0] == "clamped":
        leading = elements.basis.read(nodal, np.zeros(1), 2)[:, 0]
    else:
        leading = nodal[:, elements.free[0]]
    return np.where(leading < 0, -1.0, 1.0)


@as_typed
def solve_harmonic(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    n_elements: int,
    *,
    modal_damping: float = 0.0,
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
) -> HarmonicField:
    """The steady field of the elements under harmonic point forces, e^{+i omega t}.

    Stiffness stays factored, so the error has no floor that grows with the mesh. Damping: the beam's loss
    factor, or `modal_damping` zeta of every mode (near a resonance eta = 2 zeta where all stiffness has the loss).
    Raises InputError; an undamped resonance of the mesh is refused, and both dampings together where springs, an axial
    force or a foundation have no loss.
    """
    forces = as_forces(forces)
    check_drive(beam, forces, frequency_hz)
    return _fields(beam, forces, np.array([frequency_hz]), n_elements, modal_damping, grading, theory).field(0)


@as_typed
def sweep_harmonic(
    beam: Beam,
    forces: Forces,
    frequencies_hz: Numbers,
    n_elements: int,
    *,
    modal_damping: float = 0.0,
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
) -> HarmonicSweep:
    """The steady fields of `solve_harmonic` at many frequencies, to rounding.

    Raises InputError as `solve_harmonic` does, by index: of several resonances the first.
    """
    forces = as_forces(forces)
    check_asked(beam, 1, n_elements, grading, theory)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, 2 * n_elements)
    return _fields(beam, forces, frequencies, n_elements, modal_damping, grading, theory, FREQUENCIES)


def _fields(
    beam: Beam,
    forces: tuple[PointForce, ...],
    frequencies: Array,
    n_elements: int,
    modal_damping: float,
    grading: float,
    theory: Theory,
    field: str = "",
) -> HarmonicSweep:
    """The fields at frequencies, (n,); `field` names them in messages by index."""
    check_asked(beam, 1, n_elements, grading, theory)
    check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
    check_dampings(beam, modal_damping)
    elements, pencil = _driven(beam, n_elements, grading, theory)
    basis, unit = elements.basis, elements.parts.unit
    omega2 = (2.0 * pi * frequencies / beam.wave_constant) ** 2 * unit**4

    def modes_around(beam: Beam, n_modes: int, n_elements: int) -> Modes:
        # a plain beam has n_modes below the frequency; masses lower others
        wanted = n_modes if beam.uniform and theory == "euler-bernoulli" else 2 * n_modes + 2 * len(beam.mass)
        most = n_elastic(beam, n_elements, theory)
        return solve_modes(beam, min(wanted, most), n_elements, grading=grading, theory=theory)

    def refuse(index: int) -> None:
        named = f"{field}[{index}]" if field else "frequency_hz"
        name_resonance("fem", beam, pencil, float(frequencies[index]), modes_around, n_elements, named)

    unit_loads = point_loads(basis, np.array([force.position for force in forces]) / unit)
    total = sum(phasor(force) * load for force, load in zip(forces, unit_loads, strict=True))
    loads = np.array(total, dtype=np.complex128)[elements.free, None] * (unit**3 / beam.bending_stiffness)
    undamped = not (beam.loss_factor or modal_damping)
    stiffness = damped_stiffness(elements, pencil)
    free = harmonic_response(pencil, loads, omega2, stiffness, modal_damping, refuse if undamped else None)
    nodal = elements.all_values(free)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = basis.read(nodal, x / unit, derivative)
        return values / unit**derivative

    def turned(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = basis.read_turn(nodal, x / unit, derivative)
        return values / unit ** (derivative + 1)

    return HarmonicSweep(
        theory=theory,
        model="fem",
        count=n_elements,
        beam=beam,
        frequencies_hz=frequencies,
        forces=forces,
        shapes=shapes,
        turned=turned if elements.shears else None,
    )


def _driven(beam: Beam, n_elements: int, grading: float, theory: Theory) -> tuple[Elements, FactoredPencil]:
    """The elements of a beam and their pencil, which knows no loss; small ones are cached for the next frequency."""
    bare = replace(beam, loss_factor=0.0) if beam.loss_factor else beam
    elements, pencil = (_cached if n_elements < KEPT else _made)(bare, n_elements, grading, theory)
    return replace(elements, beam=beam), pencil


def _made(beam: Beam, n_elements: int, grading: float, theory: Theory) -> tuple[Elements, FactoredPencil]:
    elements = build_elements(beam, n_elements, grading, theory)
    return elements, element_pencil(elements)


_cached = lru_cache(maxsize=16)(_made)


@as_typed
def sweep_modes(
    beams: Iterable[Beam],
    n_modes: int,
    n_elements: int,
    *,
    grading: float = 1.0,
    theory: Theory = "euler-bernoulli",
) -> Array:
    """Frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Raises InputError as `solve_modes` does, naming the beam by its index.
    """

    def solve(beam: Beam) -> Array:
        check_asked(beam, n_modes, n_elements, grading, theory)
        elements = build_elements(beam, n_elements, grading, theory)
        return _frequencies(elements, lowest(element_pencil(elements), n_modes).values)

    return swept_modes(beams, n_modes, solve)


@as_typed
def unit_responses(
    beam: Beam,
    positions: Numbers,
    frequencies_hz: Numbers,
    x: Numbers,
    n_elements: int,
    *,
    theory: Theory = "euler-bernoulli",
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    All modes of the mesh are solved once and summed exactly for every frequency; where a loss factor couples them,
    beside what has no loss, and under Timoshenko's theory, every frequency is solved. NaN at the frequencies of
    undamped resonances. Raises InputError, also for meshes beyond the dense size.
    """
    positions, frequencies_hz, x = unit_drives(beam, positions, frequencies_hz, x)
    check_asked(beam, 1, n_elements, 1.0, theory)
    elements, pencil = _driven(beam, n_elements, 1.0, theory)
    basis, unit = elements.basis, elements.parts.unit
    weights = point_loads(basis, positions / unit)[:, elements.free].T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * unit**4
    if (beam.loss_factor and beam.lossless) or theory == "timoshenko":
        found = [_one_by_one(elements, pencil, weights, value, x) for value in omega2]
        return np.array(found).reshape(len(omega2), len(positions), len(x)) * (unit**3 / beam.bending_stiffness)
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    shapes: Array = basis.read(elements.all_values(modes), x / unit)
    return np.asarray(receptance @ shapes) * (unit**3 / beam.bending_stiffness)


def _one_by_one(elements: Elements, pencil: FactoredPencil, weights: Array, omega2: float, x: Array) -> ComplexArray:
    """Responses to each load at one frequency, (n_loads, len(x)); NaN at an undamped resonance."""
    if not elements.beam.loss_factor and abs(resonance_distance(pencil, omega2)) <= 2.0 * RESONANCE:
        return np.full((weights.shape[1], len(x)), np.nan, dtype=complex)
    nodal = elements.all_values(forced_response(pencil, weights, omega2, damped_stiffness(elements, pencil)))
    return np.asarray(elements.basis.read(nodal, x / elements.parts.unit))
