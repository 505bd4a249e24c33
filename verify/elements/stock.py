"""scikit-fem's own Hermite element and solver as in its documentation, for benchmarks.

`ElementLineHermite` inverts a Vandermonde matrix of cubics in metres, and the eigenvalues come from the assembled K.
"""

from math import nan, pi, sqrt

import numpy as np

from verify.errors import InputError
from verify.problem.beam import Beam, check_features
from verify.problem.supports import FIXED


def stock_frequency_hz(beam: Beam, mode: int, n_elements: int) -> float:
    """Frequency of a mode, Hz, with equal elements; NaN if rounding makes K singular or the eigenvalue negative.

    Raises InputError for non-uniform beams, rigid-body motions, and modes that the solver does not have.
    """
    from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine, condense, solve
    from skfem.helpers import dd, ddot
    from skfem.utils import solver_eigen_scipy_sym

    check_features(beam, "the comparison with stock scikit-fem")
    if beam.rigid_motions:
        raise InputError(f"beam.supports = {list(beam.supports)!r} allow rigid-body motions: support both ends")
    ends = {"left": lambda x: x[0] == 0.0, "right": lambda x: x[0] == beam.length}
    mesh = MeshLine(np.linspace(0.0, beam.length, n_elements + 1)).with_boundaries(ends)
    basis = Basis(mesh, ElementLineHermite())
    bending = BilinearForm(lambda u, v, w: beam.bending_stiffness * ddot(dd(u), dd(v))).assemble(basis)
    inertia = BilinearForm(lambda u, v, w: beam.mass_per_length * u * v).assemble(basis)
    names = [[name for name, held in zip(("u", "u_x"), FIXED[end], strict=True) if held] for end in beam.supports]
    held = np.concatenate([basis.get_dofs(end).all(n) for end, n in zip(ends, names, strict=True)])
    if not 0 < mode < basis.N - len(held):
        raise InputError(f"mode = {mode}: scikit-fem's solver has {basis.N - len(held) - 1} modes, raise count")
    solver = solver_eigen_scipy_sym(k=mode, sigma=0.0, v0=np.ones(basis.N - len(held)))
    try:
        value = float(np.sort(solve(*condense(bending, inertia, D=held), solver=solver)[0])[mode - 1])
    except RuntimeError:  # SuperLU's and ARPACK's
        return nan
    return sqrt(value) / (2.0 * pi) if value > 0.0 else nan
