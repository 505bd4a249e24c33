"""Hermite beam elements, assembled by scikit-fem with an element defined on the reference cell.

Inside, a length is measured in mean element lengths L/N, a stiffness and a mass in those of the beam; the
mesh has the integers for nodes, so that element lengths are exact at any size.
"""

from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.eigen import DENSE_UNKNOWNS, Array, FactoredPencil, check_size, lowest, method_name
from verify.errors import InputError
from verify.modes import Modes

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


def _rigid(beam: Beam) -> int:
    held = {"pinned": 1, "clamped": 2, "guided": 1, "free": 0}
    slides = not {"pinned", "clamped"} & set(beam.supports)
    return max(2 - sum(held[support] for support in beam.supports), 1 if slides else 0)


def n_elastic(beam: Beam, n_elements: int) -> int:
    """How many elastic modes the model has."""
    return unknowns(beam, n_elements) - _rigid(beam)


def solve_modes(beam: Beam, n_modes: int, n_elements: int) -> Modes:
    """The first `n_modes` elastic modes with `n_elements` equal cubic Hermite elements and consistent mass.

    Shapes are the elements' own cubics. Raises InputError for more modes than unknowns or sizes that do not
    fit into memory.
    """
    check(beam, n_modes, n_elements)
    free = free_unknowns(beam.supports, n_elements)
    pencil = element_pencil(beam, np.ones(n_elements), free)
    pairs = lowest(pencil, n_modes)
    scale = beam.length / n_elements
    frequencies = np.sqrt(pairs.values) * (beam.wave_constant / (2.0 * pi)) / scale**2
    nodal = _all_values(n_elements, free, pairs.vectors)
    nodal = nodal * _sign(beam.supports[0], nodal)[:, None]
    nodal = nodal / sqrt(beam.mass_per_length * scale)
    nodes: Array = np.arange(n_elements + 1.0) * scale

    def shapes(x: Array, derivative: int) -> Array:
        return interpolate(nodal, x / scale, derivative) / scale**derivative

    points: Array = np.arange(4.0 * n_elements + 1.0) * (scale / 4.0)

    def sampled() -> Array:
        return interpolate(nodal, np.arange(4 * n_elements + 1) / 4.0)

    return Modes(model="fem", count=n_elements, length=beam.length, frequencies_hz=frequencies, shapes=shapes,
                 nodes=nodes, readings={"nodal": lambda: nodal[:, ::2]}, points=points, sampled=sampled,
                 method=pairs.method)  # fmt: skip


def _sign(support: str, nodal: Array) -> Array:
    """+-1 for each mode, (k,): by the first of deflection, slope, curvature that the left end leaves free."""
    derivative = {"free": 0, "guided": 0, "pinned": 1, "clamped": 2}[support]
    return np.where(interpolate(nodal[:, :4], np.zeros(1), derivative)[:, 0] < 0, -1.0, 1.0)


def check(beam: Beam, n_modes: int, n_elements: int) -> None:
    """Raise InputError, before anything is allocated, where `solve_modes` would refuse."""
    if n_elements < 1:
        raise InputError(f"{FIELD} = {n_elements!r}: give at least one element")
    check_size(unknowns(beam, n_elements), n_modes, n_elastic(beam, n_elements), FIELD, n_elements)


def interpolate(nodal: Array, x: Array, derivative: int = 0) -> Array:
    """The elements' cubics at x (in element lengths), (k, len(x)); nodal (k, 2N + 2) is w_0, w_0', ..."""
    n_elements = nodal.shape[1] // 2 - 1
    element = np.clip(x.astype(int), 0, n_elements - 1)
    weights = hermite(x - element, derivative)
    return np.asarray(sum(nodal[:, 2 * element + j] * weights[j] for j in range(4)))


def _all_values(n_elements: int, free: Array, vectors: Array) -> Array:
    nodal = np.zeros((vectors.shape[1], 2 * n_elements + 2))
    nodal[:, free] = vectors.T
    return nodal


def element_pencil(beam: Beam, lengths: Array, free: Array) -> FactoredPencil:
    """K = B^T diag(d) B over two curvatures of each element, and M by scikit-fem."""
    n_elements = len(lengths)
    mass = assemble_mass(lengths, np.ones(n_elements))[free][:, free].tocsc()
    if len(free) <= DENSE_UNKNOWNS:
        mass = mass.toarray()
    return FactoredPencil(
        n=len(free),
        rigid_modes=_rigid(beam),
        strain=lambda values: element_curvatures(lengths, _all_values(n_elements, free, values).T),
        stiffness=np.concatenate([1.0 / lengths, 3.0 / lengths]),
        strain_matrix=lambda: curvature_matrix(lengths)[:, free],
        mass_matrix=lambda: mass,
    )


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


def dispersion_frequency_hz(beam: Beam, mode: int, n_elements: int) -> float:
    """The exact frequency of mode `mode` of equal Hermite elements, pinned-pinned, Hz, in closed form.

    Sine deflections and cosine slopes at the nodes leave two equations; their lower root. Raises InputError
    for other supports and for modes from `n_elements` on, where that branch ends.
    """
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {beam.supports!r}: the discrete dispersion is for pinned-pinned beams")
    if not 1 <= mode < n_elements:
        raise InputError(f"mode = {mode!r}: the closed form covers modes 1 to {n_elements - 1} of {n_elements}")
    mu = mode * pi / n_elements
    c, s, fall = cos(mu), sin(mu), sin(mu / 2.0) ** 2  # fall = (1 - cos mu) / 2
    k11, k12, k22 = 48.0 * fall, -12.0 * s, 8.0 + 4.0 * c
    m11, m12, m22 = (312.0 + 108.0 * c) / 420.0, 26.0 * s / 420.0, (8.0 - 6.0 * c) / 420.0
    a, b, det = m11 * m22 - m12**2, k11 * m22 + k22 * m11 - 2.0 * k12 * m12, 192.0 * fall**2
    root = 2.0 * det / (b + sqrt(b * b - 4.0 * a * det))
    return sqrt(root) * beam.wave_constant * (n_elements / beam.length) ** 2 / (2.0 * pi)


def method(beam: Beam, n_modes: int, n_elements: int) -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_elements), n_modes)
