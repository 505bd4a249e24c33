"""A subject beside ours: scikit-fem's own Hermite element and its own solve, as its documentation has them.

`ElementLineHermite` inverts a Vandermonde matrix of cubics in metres for every element, and the eigenvalues come from
the assembled K: two reasons to lose digits as the mesh is refined. Nothing of this package takes part.
"""

from math import pi, sqrt

import numpy as np

from verify.elements.linear import check, unknowns
from verify.errors import InputError
from verify.problem.beam import Beam

_HELD: dict[str, list[str]] = {"pinned": ["u"], "clamped": ["u", "u_x"], "guided": ["u_x"], "free": []}


def stock_frequency_hz(beam: Beam, mode: int, n_elements: int, start: float = 0.0) -> float:
    """The frequency of a mode of a uniform held beam by stock scikit-fem on equal elements, Hz.

    The mesh reaches from `start` metres on; where it lies has no meaning but for what rounding makes of it.

    NaN where K has lost so many digits that it is singular or its eigenvalue negative. Raises InputError for stepped
    beams, for rigid motions, which leave K singular, and for modes that the mesh or its solver does not have.
    """
    check_stock(beam, mode, n_elements)
    return _solved(beam, mode, n_elements, start)


def check_stock(beam: Beam, mode: int, n_elements: int) -> None:
    """Raise InputError where `stock_frequency_hz` would."""
    beam.check_added("the comparison with stock scikit-fem", ("section",))
    if beam.section:
        raise InputError("beam.section: stock scikit-fem is compared on uniform beams, leave the sections out")
    if beam.rigid_motions:
        raise InputError(f"beam.supports = {list(beam.supports)!r} leave rigid motions: hold the beam at both ends")
    check(beam, mode, n_elements)
    if mode == unknowns(beam, n_elements):
        raise InputError(f"mode = {mode}: scikit-fem's solver stops one short of all {mode} modes, raise count")


def _solved(beam: Beam, mode: int, n_elements: int, start: float) -> float:
    from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine, condense, solve
    from skfem.helpers import dd, ddot
    from skfem.utils import solver_eigen_scipy_sym

    nodes = np.linspace(start, start + beam.length, n_elements + 1)
    ends = {"left": lambda x: x[0] == nodes[0], "right": lambda x: x[0] == nodes[-1]}
    basis = Basis(MeshLine(nodes).with_boundaries(ends), ElementLineHermite())
    bending = BilinearForm(lambda u, v, w: beam.bending_stiffness * ddot(dd(u), dd(v))).assemble(basis)
    inertia = BilinearForm(lambda u, v, w: beam.mass_per_length * u * v).assemble(basis)
    supports = zip(ends, beam.supports, strict=True)
    held = np.concatenate([basis.get_dofs(end).all(_HELD[support]) for end, support in supports])
    solver = solver_eigen_scipy_sym(k=mode, sigma=0.0, v0=np.ones(basis.N - len(held)))
    try:
        values, _ = solve(*condense(bending, inertia, D=held), solver=solver)
    except RuntimeError:  # SuperLU's and ARPACK's
        return float("nan")
    value = float(np.sort(values)[mode - 1])
    return sqrt(value) / (2.0 * pi) if value > 0.0 else float("nan")
