"""Small motion of the nonlinear chain about an equilibrium: its matrices, and what they say of its stability."""

from dataclasses import dataclass

import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError

STRAYED = 1e-6
"""A root of a turning chain is neither oscillation nor growth where both its parts are larger than this share of it."""
LIFTED = 1e-8
"""Of the largest square: what a chain is lifted by, at least, in which a motion is rigid."""
ROUNDING = 1e-13
"""Of the largest root or square: what a dense solver leaves of a small one."""


@dataclass(frozen=True, eq=False)
class Linearisation:
    """M q'' + (C + G) q' + K q = 0 about an equilibrium, on the q with `constraint` q = 0; relative angles."""

    mass: Array
    """(N, N), kg m^2."""
    damping: Array
    """(N, N), N m s."""
    stiffness: Array
    """(N, N), N m; with the geometric terms of loads and of the forces in the held points."""
    constraint: Array
    """(n_held, N), metres: derivatives of the held points' y."""
    gyroscopic: Array
    """G, (N, N), N m s, antisymmetric; (0, 0) where the base does not turn."""

    def independent(self) -> Array:
        """Columns that span the motions left free, (N, N - n_held): coordinate partitioning by pivot."""
        n = self.mass.shape[0]
        rows = self.constraint
        if not len(rows):
            return np.eye(n)
        pivots = choose_pivots(rows)
        others = np.setdiff1d(np.arange(n), pivots)
        basis = np.zeros((n, n - len(pivots)))
        basis[others, np.arange(len(others))] = 1.0
        basis[pivots] = -np.linalg.solve(rows[:, pivots], rows[:, others])
        return basis

    def squares(self) -> Array:
        """Signed omega^2 of the undamped motion, (N - n_held,), ascending, 1/s^2: below 0 what grows instead.

        What rounding cannot tell from 0 is 0. Raises InputError where a bent, turning chain flutters.
        """
        basis = self.independent()
        mass, stiffness = basis.T @ self.mass @ basis, basis.T @ self.stiffness @ basis
        if not len(mass):
            return np.zeros(0)
        if self.gyroscopic.any():
            return _turning_squares(mass, basis.T @ self.gyroscopic @ basis, stiffness)
        return _squares(mass, stiffness)

    def frequencies(self) -> Array:
        """Undamped circular frequencies, (N - n_held,), ascending, rad/s.

        Raises InputError at an unstable equilibrium, and names the modes that grow; `squares` has their figures.
        """
        squares = self.squares()
        refuse_unstable_modes(squares)
        return np.asarray(np.sqrt(squares), dtype=float)


def refuse_unstable_modes(squares: Array) -> None:
    """Raise InputError where modes (ascending, 1/s^2) grow instead of swinging, and say which and how fast."""
    grow = squares[squares < 0.0]
    if len(grow):
        which = "mode 1 grows" if len(grow) == 1 else f"modes 1 to {len(grow)} grow"
        raise InputError(
            f"the equilibrium is unstable: {which} (omega^2 = {grow[0]:.4g} 1/s^2, e-fold in "
            f"{(-grow[0]) ** -0.5:.3g} s), give a smaller load or another equilibrium"
        )


def _squares(mass: Array, stiffness: Array) -> Array:
    """Signed, ascending: by the inverse problem, which keeps the low ones accurate, shifted where it must be.

    Of hinged chains a shift of `LIFTED` leaves the lowest four right to 1e-12. The upper half of 60, 400, 1000 links
    lies within 5e-9, 3e-7 and 9e-6 of eigh(K, M), which over relative and absolute angles differs from itself by 1e-9,
    2e-7 and 6e-6.
    """
    from scipy.linalg import LinAlgError, eigh

    try:
        return np.asarray(1.0 / eigh(mass, stiffness, eigvals_only=True)[::-1])
    except LinAlgError:
        lowest = abs(float(eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 0])[0]))
    shift = max(2.0 * lowest, LIFTED * float(np.max(abs(np.diag(stiffness)) / np.diag(mass))))
    while True:
        try:
            inverse, vectors = eigh(mass, stiffness + shift * mass)
            break
        except LinAlgError:
            shift *= 4.0
    squares = 1.0 / inverse[::-1] - shift
    shape = abs(vectors[:, -1]) / np.sqrt(vectors[:, -1] @ mass @ vectors[:, -1])
    floor = 8.0 * len(mass) * np.finfo(float).eps * (shape @ abs(stiffness) @ shape + shift)
    return np.where(abs(squares) <= floor, 0.0, squares)


def _turning_squares(mass: Array, gyroscopic: Array, stiffness: Array) -> Array:
    """Minus the squared roots of M lambda^2 + G lambda + K, which come in pairs of both signs, ascending."""
    n, answers = len(mass), np.linalg.solve(mass, np.hstack([stiffness, gyroscopic]))
    roots = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-answers[:, :n], -answers[:, n:]]]))
    strayed = np.minimum(abs(roots.real), abs(roots.imag)) > STRAYED * abs(roots) + ROUNDING * abs(roots).max()
    if strayed.any():
        fastest = roots[strayed][np.argmax(roots[strayed].real)]
        raise InputError(
            f"the equilibrium is unstable: it flutters at {abs(fastest.imag):.4g} rad/s and grows with "
            f"{fastest.real:.4g} 1/s, give a smaller load or a slower rotation.rate"
        )
    squares = np.sort(-(roots**2).real)[::2]
    return np.where(abs(squares) <= ROUNDING * abs(squares).max(), 0.0, squares)


def choose_pivots(rows: Array) -> Indices:
    """Which angles depend on the others, (n_held,): complete pivoting on the constraint rows.

    Raises InputError where the held points leave no angle to depend on: a chain that stands upright under its
    roller, or two held points in one place.
    """
    left, pivots = rows.copy(), np.zeros(len(rows), dtype=np.int64)
    free, largest = list(range(len(rows))), abs(rows).max() if rows.size else 0.0
    for _ in range(len(rows)):
        row = free[int(abs(left[free]).max(axis=1).argmax())]
        column = int(abs(left[row]).argmax())
        if abs(left[row, column]) <= 1e-9 * largest:
            raise InputError("chain: its held points cannot be held at once in this position; move one or drop one")
        pivots[row] = column
        free.remove(row)
        for other in free:
            left[other] -= left[other, column] / left[row, column] * left[row]
    return pivots
