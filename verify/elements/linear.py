"""Modes and harmonic fields of Hermite elements: what the model answers, in metres, hertz and newtons."""

from math import pi, sqrt

import numpy as np

from verify.beam import Beam
from verify.checks import check_number, check_whole
from verify.elements.mesh import Elements, build_elements, interpolate, point_loads
from verify.elements.pencil import element_pencil
from verify.models.arrays import Array, ComplexArray
from verify.models.division import Parts, check_division
from verify.models.driven_pencil import damped_response, modal_receptance, refuse_near_resonance
from verify.models.eigen import Eigenpairs, check_size, lowest, method_name
from verify.models.fields import HarmonicField, check_drive, phasor
from verify.models.modes import Modes
from verify.models.places import Forces, Numbers, as_forces, as_typed, in_a_row

FIELD = "n_elements"


def unknowns(beam: Beam, n_elements: int) -> int:
    """How many nodal values the supports leave free."""
    held = {"pinned": 1, "clamped": 2, "guided": 1, "free": 0}
    return 2 * n_elements + 2 - sum(held[support] for support in beam.supports)


def n_elastic(beam: Beam, n_elements: int) -> int:
    """How many elastic modes the model has."""
    return unknowns(beam, n_elements) - beam.rigid_motions


@as_typed
def solve_modes(beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0) -> Modes:
    """The first `n_modes` elastic modes with `n_elements` cubic Hermite elements and consistent mass.

    Elements end on the steps of the beam; `grading` is the length of a section's last element over its first.
    Shapes are the elements' own cubics. Raises InputError for a wrong grading, more modes than unknowns or
    sizes that do not fit into memory.
    """
    check(beam, n_modes, n_elements, grading=grading)
    elements = build_elements(beam, n_elements, grading)
    pairs = lowest(element_pencil(elements), n_modes)
    nodal = elements.all_values(pairs.vectors)
    nodal = nodal * _sign(elements, nodal)[:, None]
    return _modes(elements, nodal / sqrt(beam.mass_per_length * elements.parts.unit), pairs)


def check(beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0) -> None:
    """Raise InputError, before anything is allocated, where `solve_modes` would refuse."""
    check_whole("n_modes", n_modes, 1)
    check_whole(FIELD, n_elements, 1)
    check_division(beam, n_elements, grading)
    check_size(unknowns(beam, n_elements), n_modes, n_elastic(beam, n_elements), FIELD, n_elements)


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
        nodes=parts.nodes * unit,
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


def _sign(elements: Elements, nodal: Array) -> Array:
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
) -> HarmonicField:
    """The steady field of the Hermite elements under harmonic point forces, e^{+i omega t}.

    Stiffness stays factored, so the error has no floor that grows with the mesh. Damping: the beam's loss
    factor, or `modal_damping` zeta of every mode (near a resonance eta = 2 zeta). Raises InputError; an
    undamped resonance of the mesh is refused.
    """
    forces = as_forces(forces)
    check(beam, 1, n_elements, grading=grading)
    check_drive(beam, forces, frequency_hz)
    check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
    elements = build_elements(beam, n_elements, grading)
    pencil, basis, unit = element_pencil(elements), elements.basis, elements.parts.unit
    omega2 = (2.0 * pi * frequency_hz / beam.wave_constant) ** 2 * unit**4
    if not (beam.loss_factor or modal_damping):
        refuse_near_resonance("fem", beam, pencil, omega2, frequency_hz, solve_modes, n_elements)
    unit_loads = point_loads(basis, np.array([force.position for force in forces]) / unit)
    total = sum(phasor(force) * load for force, load in zip(forces, unit_loads, strict=True))
    loads = np.array(total, dtype=np.complex128)[elements.free, None] * (unit**3 / beam.bending_stiffness)
    stiffness: ComplexArray = np.asarray(pencil.stiffness * (1.0 + 1j * beam.loss_factor), dtype=complex)
    nodal = elements.all_values(damped_response(pencil, loads, omega2, stiffness, modal_damping))

    def shapes(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = interpolate(basis, nodal, x / unit, derivative)[0]
        return values / unit**derivative

    return HarmonicField(
        model="fem", count=n_elements, beam=beam, frequency_hz=frequency_hz, forces=tuple(forces), shapes=shapes
    )


def unit_responses(
    beam: Beam, positions: Numbers, frequencies_hz: Numbers, x: Numbers, n_elements: int
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    All modes of the mesh are solved once and summed exactly for every frequency. NaN at the frequencies of
    undamped resonances. Raises InputError for meshes beyond the dense size.
    """
    positions, x = in_a_row("positions", positions), in_a_row("x", x)
    frequencies_hz = in_a_row("frequencies_hz", frequencies_hz)
    check(beam, 1, n_elements)
    elements = build_elements(beam, n_elements)
    pencil, basis, unit = element_pencil(elements), elements.basis, elements.parts.unit
    weights = point_loads(basis, np.array(positions) / unit)[:, elements.free].T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * unit**4
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    shapes: Array = interpolate(basis, elements.all_values(modes), x / unit)
    return np.asarray(receptance @ shapes) * (unit**3 / beam.bending_stiffness)


def method(beam: Beam, n_modes: int, n_elements: int) -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_elements), n_modes)
