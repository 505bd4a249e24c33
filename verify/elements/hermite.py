"""Hermite beam elements, assembled by scikit-fem with an element defined on the reference cell.

Inside, a length is measured in mean element lengths L/N, a stiffness and a mass in those of the beam. The mesh
has the integers for nodes and each element its length beside it, so that lengths are exact at any size.
"""

from collections.abc import Sequence
from math import pi, sqrt
from typing import Any

import numpy as np

from verify.beam import Beam, PointForce, check_number, check_whole
from verify.models.arrays import Array, ComplexArray
from verify.models.division import Parts, check_division, divide
from verify.models.driven_pencil import damped_response, modal_receptance, refuse_near_resonance
from verify.models.eigen import DENSE_UNKNOWNS, Eigenpairs, FactoredPencil, check_size, lowest, method_name
from verify.models.fields import HarmonicField, check_drive, phasor
from verify.models.modes import Modes

FIELD = "n_elements"


def hermite(xi: Array, derivative: int = 0) -> Array:
    """The four cubic Hermite polynomials on [0, 1] or a derivative, (4, ...): w_0, w_0', w_1, w_1'."""
    one, zero = np.ones_like(xi), np.zeros_like(xi)
    if derivative == 0:
        rest = 1.0 - xi
        return np.array([rest**2 * (1 + 2 * xi), xi * rest**2, xi**2 * (3 - 2 * xi), -(xi**2) * rest])
    if derivative == 1:
        slope = 6.0 * xi * (xi - 1.0)
        return np.array([slope, (1 - xi) * (1 - 3 * xi), -slope, xi * (3 * xi - 2)])
    if derivative == 2:
        return np.array([12 * xi - 6, 6 * xi - 4, 6 - 12 * xi, 6 * xi - 2])
    return np.array([12 * one, 6 * one, -12 * one, 6 * one]) if derivative == 3 else np.array([zero] * 4)


def reference_basis(lengths: Array) -> Any:
    """scikit-fem's basis on cells of unit size that stand for elements of the given lengths, (N,).

    Nodal unknowns are deflection and slope; a slope's polynomial carries its element's length.
    scikit-fem's own ElementLineHermite inverts a Vandermonde matrix in global coordinates and loses n^3 eps.
    """
    from skfem import Basis, MeshLine
    from skfem.element import DiscreteField, ElementH1
    from skfem.refdom import RefLine

    class ReferenceHermite(ElementH1):  # type: ignore[misc]
        nodal_dofs = 2
        maxdeg = 3
        dofnames = ("u", "u_x")
        doflocs = np.array([[0.0], [0.0], [1.0], [1.0]])
        refdom = RefLine

        def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:  # noqa: N803
            scale = (lengths if i % 2 else np.ones_like(lengths))[:, None]
            value, slope, bend = (hermite(X[0], k)[i] * scale / lengths[:, None] ** k for k in range(3))
            return (DiscreteField(value=value, grad=slope[None], hess=bend[None, None]),)

    return Basis(MeshLine(np.arange(len(lengths) + 1.0)), ReferenceHermite(), intorder=6)


def assemble(lengths: Array, stiffness: Array, mass: Array) -> tuple[Any, Any]:
    """K and M over all nodes (w_0, w_0', w_1, ...), scikit-fem's assembly, (2N + 2, 2N + 2) sparse.

    `lengths`, `stiffness` (EI) and `mass` (rho A) are (N,), one for each element.
    """
    from skfem import BilinearForm

    basis = reference_basis(lengths)

    @BilinearForm  # type: ignore[untyped-decorator]
    def bending(u: Any, v: Any, w: Any) -> Any:
        return (stiffness * lengths)[:, None] * u.hess[0, 0] * v.hess[0, 0]

    return bending.assemble(basis), assemble_mass(lengths, mass)


def assemble_mass(lengths: Array, mass: Array) -> Any:
    """The consistent M over all nodes, scikit-fem's assembly, (2N + 2, 2N + 2) sparse."""
    from skfem import BilinearForm

    @BilinearForm  # type: ignore[untyped-decorator]
    def inertia(u: Any, v: Any, w: Any) -> Any:
        return (mass * lengths)[:, None] * u * v

    return inertia.assemble(reference_basis(lengths))


def free_unknowns(supports: tuple[str, str], n_elements: int) -> Array:
    """Which of (w_0, w_0', ..., w_N, w_N') the supports leave free, (n,) ascending."""
    fixed: list[int] = []
    for support, node in zip(supports, (0, n_elements), strict=True):
        fixed += [2 * node] * (support in ("pinned", "clamped"))
        fixed += [2 * node + 1] * (support in ("clamped", "guided"))
    return np.setdiff1d(np.arange(2 * n_elements + 2), fixed)


def unknowns(beam: Beam, n_elements: int) -> int:
    """How many nodal values the supports leave free."""
    held = {"pinned": 1, "clamped": 2, "guided": 1, "free": 0}
    return 2 * n_elements + 2 - sum(held[support] for support in beam.supports)


def n_elastic(beam: Beam, n_elements: int) -> int:
    """How many elastic modes the model has."""
    return unknowns(beam, n_elements) - beam.rigid_motions


def solve_modes(beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0) -> Modes:
    """The first `n_modes` elastic modes with `n_elements` cubic Hermite elements and consistent mass.

    Elements end on the steps of the beam; `grading` is the length of a section's last element over its first.
    Shapes are the elements' own cubics. Raises InputError for a wrong grading, more modes than unknowns or
    sizes that do not fit into memory.
    """
    check(beam, n_modes, n_elements, grading=grading)
    parts = divide(beam, n_elements, grading)
    free = free_unknowns(beam.supports, n_elements)
    pairs = lowest(element_pencil(beam, parts, free), n_modes)
    nodal = _all_values(n_elements, free, pairs.vectors)
    nodal = nodal * _sign(beam.supports[0], parts.lengths, nodal)[:, None]
    nodal = nodal / sqrt(beam.mass_per_length * parts.unit)
    return _modes(beam, parts, nodal, pairs)


def check(beam: Beam, n_modes: int, n_elements: int, *, grading: float = 1.0) -> None:
    """Raise InputError, before anything is allocated, where `solve_modes` would refuse."""
    check_whole("n_modes", n_modes, 1)
    check_whole(FIELD, n_elements, 1)
    check_division(beam, n_elements, grading)
    check_size(unknowns(beam, n_elements), n_modes, n_elastic(beam, n_elements), FIELD, n_elements)


def _modes(beam: Beam, parts: Parts, nodal: Array, pairs: Eigenpairs) -> Modes:
    unit = parts.unit
    frequencies = np.sqrt(pairs.values) * (beam.wave_constant / (2.0 * pi)) / unit**2

    def shapes(x: Array, derivative: int) -> Array:
        return interpolate(parts.lengths, nodal, x / unit, derivative) / unit**derivative

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
        readings={"nodal": lambda: nodal[:, ::2]},
        points=points * unit,
        sampled=lambda: interpolate(parts.lengths, nodal, points),
        curvature_points=gauss * unit,
        curvatures=lambda: interpolate(parts.lengths, nodal, gauss, 2) / unit**2,
        method=pairs.method,
    )


def _inside(parts: Parts, xi: Array) -> Array:
    """The points xi of every element, in units from the left end, (N len(xi),)."""
    return np.asarray((parts.nodes[:-1, None] + parts.lengths[:, None] * xi).ravel())


def _sign(support: str, lengths: Array, nodal: Array) -> Array:
    """+-1 for each mode, (k,): by the first of deflection, slope, curvature that the left end leaves free."""
    derivative = {"free": 0, "guided": 0, "pinned": 1, "clamped": 2}[support]
    return np.where(interpolate(lengths[:1], nodal[:, :4], np.zeros(1), derivative)[:, 0] < 0, -1.0, 1.0)


def interpolate(lengths: Array, nodal: Array, x: Array, derivative: int = 0) -> Array:
    """The elements' cubics or a derivative at x (in the unit of lengths), (k, len(x)).

    nodal is (k, 2N + 2): w_0, w_0', w_1, w_1', ...
    """
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    element = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, len(lengths) - 1)
    h = lengths[element]
    weights = hermite((x - ends[element]) / h, derivative) / h**derivative
    weights[1::2] *= h
    return np.asarray(sum(nodal[:, 2 * element + j] * weights[j] for j in range(4)))


def _all_values(n_elements: int, free: Array, vectors: Any) -> Any:
    nodal = np.zeros((vectors.shape[1], 2 * n_elements + 2), dtype=vectors.dtype)
    nodal[:, free] = vectors.T
    return nodal


def element_pencil(beam: Beam, parts: Parts, free: Array) -> FactoredPencil:
    """K = B^T diag(d) B over two curvatures of each element, and M by scikit-fem."""
    lengths, n_elements = parts.lengths, len(parts.lengths)
    mass = assemble_mass(lengths, parts.masses_per_length)[free][:, free].tocsc()
    if len(free) <= DENSE_UNKNOWNS:
        mass = mass.toarray()
    stiffness = parts.stiffnesses / lengths
    return FactoredPencil(
        n=len(free),
        rigid=rigid_shapes(beam, parts)[free],
        strain=lambda values: element_curvatures(lengths, _all_values(n_elements, free, values).T),
        stiffness=np.concatenate([stiffness, 3.0 * stiffness]),
        strain_matrix=lambda: curvature_matrix(lengths)[:, free],
        mass_matrix=lambda: mass,
    )


def rigid_shapes(beam: Beam, parts: Parts) -> Array:
    """The motions without strain that the supports leave, over all nodal values, (2N + 2, 0 to 2)."""
    x = parts.nodes
    held = [end for end, support in zip((x[0], x[-1]), beam.supports, strict=True) if support in ("pinned", "clamped")]
    lift, turn = np.zeros((2, 2 * len(x)))
    lift[::2], turn[1::2] = 1.0, 1.0
    turn[::2] = x - (held[0] if held else 0.5 * x[-1])
    shapes = [lift] * (not held) + [turn] * (beam.rigid_motions > (not held))
    return np.array(shapes).reshape(len(shapes), len(lift)).T


def element_curvatures(lengths: Array, nodal: Array) -> Array:
    """Mean curvature and its gradient in every element, (2N, k), from nodal values (2N + 2, k).

    theta_1 - theta_0 and theta_0 + theta_1 - 2 (w_1 - w_0)/l: their squares weighted with EI/l and 3 EI/l
    are twice the bending energy of a cubic element. Written as differences of differences.
    """
    chord = np.diff(nodal[::2], axis=0) / lengths[:, None]
    left, right = nodal[1:-1:2] - chord, nodal[3::2] - chord
    return np.concatenate([np.diff(nodal[1::2], axis=0), left + right])


def curvature_matrix(lengths: Array) -> Any:
    """B of `element_curvatures` as a sparse array (2N, 2N + 2)."""
    from scipy.sparse import csc_array

    n = len(lengths)
    e, one = np.arange(n), np.ones(n)
    rows = np.concatenate([e, e, n + e, n + e, n + e, n + e])
    columns = np.concatenate([2 * e + 1, 2 * e + 3, 2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3])
    values = np.concatenate([-one, one, 2.0 / lengths, one, -2.0 / lengths, one])
    return csc_array((values, (rows, columns)), shape=(2 * n, 2 * n + 2))


def solve_harmonic(
    beam: Beam,
    forces: Sequence[PointForce],
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
    check(beam, 1, n_elements, grading=grading)
    check_drive(beam, forces, frequency_hz)
    check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
    parts = divide(beam, n_elements, grading)
    free = free_unknowns(beam.supports, n_elements)
    pencil = element_pencil(beam, parts, free)
    omega2 = (2.0 * pi * frequency_hz / beam.wave_constant) ** 2 * parts.unit**4
    if not (beam.loss_factor or modal_damping):
        refuse_near_resonance("fem", beam, pencil, omega2, frequency_hz, solve_modes, n_elements)
    total = sum(phasor(force) * nodal_weights(parts, force.position / parts.unit) for force in forces)
    loads = np.array(total, dtype=np.complex128)[free, None] * (parts.unit**3 / beam.bending_stiffness)
    stiffness: ComplexArray = np.asarray(pencil.stiffness * (1.0 + 1j * beam.loss_factor), dtype=complex)
    nodal = _all_values(n_elements, free, damped_response(pencil, loads, omega2, stiffness, modal_damping))

    def shapes(x: Array, derivative: int) -> ComplexArray:
        values: ComplexArray = interpolate(parts.lengths, nodal, x / parts.unit, derivative)[0]
        return values / parts.unit**derivative

    return HarmonicField(
        model="fem", count=n_elements, beam=beam, frequency_hz=frequency_hz, forces=tuple(forces), shapes=shapes
    )


def nodal_weights(parts: Parts, x: float) -> Array:
    """Nodal values' weights of a unit force at x (in units from the left end), (2N + 2,): Hermite polynomials."""
    n = len(parts.lengths)
    element = int(np.clip(np.searchsorted(parts.nodes, x, side="right") - 1, 0, n - 1))
    h = parts.lengths[element]
    weights = hermite(np.array([(x - parts.nodes[element]) / h]))[:, 0]
    weights[1::2] *= h
    loads = np.zeros(2 * n + 2)
    loads[2 * element : 2 * element + 4] = weights
    return loads


def unit_responses(
    beam: Beam, positions: Sequence[float], frequencies_hz: Array, x: Array, n_elements: int
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    All modes of the mesh are solved once and summed exactly for every frequency. NaN at the frequencies of
    undamped resonances. Raises InputError for meshes beyond the dense size.
    """
    check(beam, 1, n_elements)
    parts, free = divide(beam, n_elements), free_unknowns(beam.supports, n_elements)
    pencil = element_pencil(beam, parts, free)
    weights = np.array([nodal_weights(parts, p / parts.unit)[free] for p in positions]).T
    omega2 = (2.0 * pi * frequencies_hz / beam.wave_constant) ** 2 * parts.unit**4
    modes, receptance = modal_receptance(pencil, weights, omega2, beam.loss_factor)
    shapes = interpolate(parts.lengths, _all_values(n_elements, free, modes), x / parts.unit)
    return np.asarray(receptance @ shapes) * (parts.unit**3 / beam.bending_stiffness)


def method(beam: Beam, n_modes: int, n_elements: int) -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_elements), n_modes)
