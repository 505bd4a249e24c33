"""Modes and harmonic fields of Hermite and Timoshenko elements: what the model answers in metres, hertz, newtons."""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from math import pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.checks import MOST_PARTS, check_number, check_whole, check_word
from verify.elements.cuts import check_cuts
from verify.elements.mesh import Elements, build_elements, interpolate, point_loads
from verify.elements.pencil import (
    check_unbuckled,
    damped_stiffness,
    element_pencil,
    mesh_buckling_load,
    uneven,
)
from verify.elements.weighing import KEPT
from verify.models.arrays import Array, ComplexArray
from verify.models.division import Parts
from verify.models.driven_pencil import check_dampings, damped_response, modal_receptance, probed, refuse_near_resonance
from verify.models.eigen import Eigenpairs, check_size, lowest, method_name
from verify.models.fields import RESONANCE, HarmonicField, check_drive, phasor, unit_drives
from verify.models.modes import Modes
from verify.models.pencil import FactoredPencil
from verify.models.places import Forces, Numbers, as_forces, as_typed, within
from verify.models.response import forced_response, resonance_distance
from verify.models.theory import check_theory
from verify.options import THEORIES, Theory

FIELD = "n_elements"


@as_typed
def unknowns(beam: Beam, n_elements: int, theory: Theory = "euler-bernoulli") -> int:
    """How many nodal values the supports leave free, and two shear strains in each of Timoshenko's elements.

    Raises InputError for a count or a theory that is none.
    """
    check_whole(FIELD, n_elements, 1)
    check_word("theory", theory, THEORIES)
    held = {"pinned": 1, "clamped": 2, "guided": 1, "free": 0}
    inside = 2 * n_elements if theory == "timoshenko" else 0
    return 2 * n_elements + 2 + inside - sum(held[support] for support in beam.supports)


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
    frequencies = np.sqrt(pairs.values) * (beam.wave_constant / (2.0 * pi)) / unit**2

    def shapes(x: Array, derivative: int) -> Array:
        return np.asarray(interpolate(basis, nodal, x / unit, derivative) / unit**derivative)

    quarters = _inside(parts, np.arange(4) / 4.0)
    points = np.append(quarters, parts.nodes[-1])
    gauss = _inside(parts, np.array([0.5 - 0.5 / sqrt(3.0), 0.5 + 0.5 / sqrt(3.0)]))
    return Modes(
        model="fem",
        count=len(parts.lengths),
        length=beam.length,
        frequencies_hz=frequencies,
        shapes=shapes,
        nodes=within(parts.nodes * unit, beam.length),
        readings={"nodal": lambda: nodal[:, basis.nodal_dofs[0]]},
        points=points * unit,
        sampled=lambda: interpolate(basis, nodal, points),
        curvature_points=gauss * unit,
        curvatures=lambda: interpolate(basis, nodal, gauss, 2) / unit**2,
        method=pairs.method,
    )


def _inside(parts: Parts, xi: Array) -> Array:
    """The points xi of every element, in units from the left end, (N len(xi),)."""
    return np.asarray((parts.nodes[:-1, None] + parts.lengths[:, None] * xi).ravel())


def leading_sign(elements: Elements, nodal: Array) -> Array:
    """+-1 for each mode, (k,): by the first of deflection, slope, curvature that the left end leaves free."""
    if elements.beam.supports[0] == "clamped":
        leading = interpolate(elements.basis, nodal, np.zeros(1), 2)[:, 0]
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
    check_asked(beam, 1, n_elements, grading, theory)
    check_drive(beam, forces, frequency_hz)
    check_damping(beam, modal_damping)
    elements, pencil = driven(beam, n_elements, grading, theory)
    unit = elements.parts.unit
    omega2 = (2.0 * pi * frequency_hz / beam.wave_constant) ** 2 * unit**4
    loads, undamped = force_loads(elements, forces), not (beam.loss_factor or modal_damping)
    stiffness, asked = damped_stiffness(elements, pencil), probed(pencil, loads) if undamped else loads
    free = damped_response(pencil, asked, omega2, stiffness, modal_damping)
    if undamped:
        near = partial(modes_around, theory=theory, grading=grading)
        refuse_near_resonance("fem", beam, pencil, omega2, frequency_hz, near, n_elements, free)
    every, turned = swept_shapes(elements, free[:, :1]), swept_turns(elements, free[:, :1])

    return HarmonicField(
        theory=theory,
        model="fem",
        count=n_elements,
        beam=beam,
        frequency_hz=frequency_hz,
        forces=tuple(forces),
        shapes=lambda x, derivative: every(x, derivative)[0],
        turned=None if turned is None else lambda x, derivative: turned(x, derivative)[0],
    )


def swept_shapes(elements: Elements, free: ComplexArray) -> Callable[[Array, int], ComplexArray]:
    """The elements' cubics of the unknowns (n, k) complex: (x, derivative) -> (k, len(x))."""
    nodal, basis, unit = elements.all_values(free), elements.basis, elements.parts.unit

    def shapes(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = interpolate(basis, nodal, x / unit, derivative)
        return values / unit**derivative

    return shapes


def swept_turns(elements: Elements, free: ComplexArray) -> Callable[[Array, int], ComplexArray] | None:
    """Likewise the turns of sections that shear; None of elements in which nothing does."""
    if elements.theory != "timoshenko":
        return None
    nodal, basis, unit = elements.all_values(free), elements.basis, elements.parts.unit

    def turns(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = basis.read_turn(nodal, x / unit, derivative)
        return values / unit ** (derivative + 1)

    return turns


def force_loads(elements: Elements, forces: Sequence[PointForce]) -> ComplexArray:
    """Forces on the free unknowns, (n, 1), in the elements' units."""
    unit = elements.parts.unit
    unit_loads = point_loads(elements.basis, np.array([force.position for force in forces]) / unit)
    total = sum(phasor(force) * load for force, load in zip(forces, unit_loads, strict=True))
    return np.array(total, dtype=np.complex128)[elements.free, None] * (unit**3 / elements.beam.bending_stiffness)


def driven(beam: Beam, n_elements: int, grading: float, theory: Theory) -> tuple[Elements, FactoredPencil]:
    """The elements of a beam and their pencil, which knows no loss; small ones are kept for the next frequency."""
    bare = replace(beam, loss_factor=0.0) if beam.loss_factor else beam
    elements, pencil = (_kept if n_elements < KEPT else _made)(bare, n_elements, grading, theory)
    return replace(elements, beam=beam), pencil


def _made(beam: Beam, n_elements: int, grading: float, theory: Theory) -> tuple[Elements, FactoredPencil]:
    elements = build_elements(beam, n_elements, grading, theory)
    return elements, element_pencil(elements)


_kept = lru_cache(maxsize=16)(_made)


def check_damping(beam: Beam, modal_damping: float) -> None:
    """Raise InputError for a modal ratio that is none, or beside a loss factor where the two couple the modes."""
    check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
    check_dampings(beam, modal_damping)


def modes_around(beam: Beam, n_modes: int, n_elements: int, *, grading: float, theory: Theory) -> Modes:
    """Modes among which that of a frequency is, `n_modes` of which a plain beam has below it: masses lower others."""
    wanted = n_modes if beam.uniform and theory == "euler-bernoulli" else 2 * n_modes + 2 * len(beam.mass)
    most = n_elastic(beam, n_elements, theory)
    return solve_modes(beam, min(wanted, most), n_elements, grading=grading, theory=theory)


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
    elements, pencil = driven(beam, n_elements, 1.0, theory)
    basis, unit = elements.basis, elements.parts.unit
    weights = point_loads(basis, positions / unit)[:, elements.free].T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * unit**4
    if (beam.loss_factor and beam.lossless) or theory == "timoshenko":
        found = [_one_by_one(elements, pencil, weights, value, x) for value in omega2]
        return np.array(found).reshape(len(omega2), len(positions), len(x)) * (unit**3 / beam.bending_stiffness)
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    shapes: Array = interpolate(basis, elements.all_values(modes), x / unit)
    return np.asarray(receptance @ shapes) * (unit**3 / beam.bending_stiffness)


def _one_by_one(elements: Elements, pencil: FactoredPencil, weights: Array, omega2: float, x: Array) -> ComplexArray:
    """Responses to each load at one frequency, (n_loads, len(x)); NaN at an undamped resonance."""
    if not elements.beam.loss_factor and abs(resonance_distance(pencil, omega2)) <= 2.0 * RESONANCE:
        return np.full((weights.shape[1], len(x)), np.nan, dtype=complex)
    nodal = elements.all_values(forced_response(pencil, weights, omega2, damped_stiffness(elements, pencil)))
    return np.asarray(interpolate(elements.basis, nodal, x / elements.parts.unit))


def method(beam: Beam, n_modes: int, n_elements: int, theory: Theory = "euler-bernoulli") -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_elements, theory), n_modes, uneven(beam, theory))
