"""The coefficients of Runge and Kutta's steps against the conditions of their orders."""

import numpy as np

from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest


def tableau_error(order: float) -> float:
    """Of Runge-Kutta's conditions up to an order, and of the error estimate's, which vanishes below order 5."""
    from verify.chain.stepping import DORMAND_PRINCE, RK4

    worst = 0.0
    for tableau, reached in ((RK4, 4), (DORMAND_PRINCE, 5)):
        a, b, c = tableau.a[:-1], tableau.a[-1], tableau.c
        worst = largest(worst, float(abs(a.sum(axis=1) - c).max()), abs(tableau.order - reached))
        for weights, exact in _conditions(a, c, min(int(order), reached)):
            worst = largest(worst, abs(float(b @ weights) - exact))
        if len(tableau.weights):
            every, at_end = np.vstack([a, b]), np.append(c, 1.0)
            for weights, _ in _conditions(np.hstack([every, np.zeros((len(every), 1))]), at_end, min(int(order), 4)):
                worst = largest(worst, abs(float(tableau.weights @ weights)))
    return worst


def _conditions(a: Array, c: Array, order: int) -> list[tuple[Array, float]]:
    """(what weights are multiplied with, what comes of it) for every rooted tree of up to so many vertices."""
    one, ac = np.ones(len(c)), a @ c
    trees = [
        (1, one, 1.0),
        (2, c, 1 / 2),
        (3, c**2, 1 / 3),
        (3, ac, 1 / 6),
        (4, c**3, 1 / 4),
        (4, c * ac, 1 / 8),
        (4, a @ c**2, 1 / 12),
        (4, a @ ac, 1 / 24),
        (5, c**4, 1 / 5),
        (5, c**2 * ac, 1 / 10),
        (5, ac**2, 1 / 20),
        (5, c * (a @ c**2), 1 / 15),
        (5, a @ c**3, 1 / 20),
        (5, c * (a @ ac), 1 / 30),
        (5, a @ (c * ac), 1 / 40),
        (5, a @ (a @ c**2), 1 / 60),
        (5, a @ (a @ ac), 1 / 120),
    ]
    return [(weights, exact) for size, weights, exact in trees if size <= order]


ROWS: tuple[Row, ...] = (
    Floor(
        id="runge-kutta-conditions",
        title="Coefficients of the chain's steps against the conditions of orders 1 to 5, and of the error estimate",
        why="chain/stepping.py: fractions to rounding (Hairer, Norsett and Wanner, II.2 and II.5).",
        along="order",
        at=(1, 2, 3, 4, 5),
        promise=2e-15,
        error=tableau_error,
    ),
)
