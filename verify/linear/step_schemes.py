"""Schemes of time integration as maps of one step, for M q'' + C q' + K q = 0 about rest.

The eigenvalues lambda of the map, the multipliers, are powers of one step: a motion grows unless |lambda| <= 1, and
s = ln(lambda)/h, h the step, is the pole of the simulation. A scheme is one of two kinds.

- In place of the whole state: lambda = R(h s) of a pole s of M, C, K, for every C (Runge-Kutta, trapezoidal).
- In accelerations, dashpots and springs at times of their own, d = lambda - 1:
  mass(d) M + h dashpots(d) C + h^2 springs(d) K is singular. A mode alone has x = omega h and 2 zeta x for h C.

Sources: Hairer & Wanner, Solving Ordinary Differential Equations II (R); Newmark, J. Eng. Mech. Div. 85 (1959); Chung &
Hulbert, J. Appl. Mech. 60 (1993) 371; Dormand & Prince, J. Comp. Appl. Math. 6 (1980) 19.
"""

from itertools import zip_longest
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from verify.arrays import Array, ComplexArray

Powers = tuple[float, ...]  # Coefficients of a polynomial, ascending
REAL = 1e-9  # Largest imaginary over absolute part of a root that is real but for rounding


class Scheme(NamedTuple):
    """An integrator: `mass`, `dashpots`, `springs` in d = lambda - 1, or `state`: coefficients of lambda^i z^j, z = hs.

    Of one undamped mode: `limit`, the largest x, inf of a scheme that is stable for every M, C, K >= 0; `frequency` and
    `numerical`, (factor, power) of x in the first terms of the relative error of f and of the damping ratio.
    """

    name: str
    limit: float
    frequency: tuple[float, int]
    numerical: tuple[float, int]
    dashpots: Powers = ()
    springs: Powers = ()
    mass: Powers = (0.0, 0.0, 1.0)
    state: tuple[Powers, ...] = ()  # two of lambda^0 and lambda^1

    @property
    def powers(self) -> list[tuple[float, float, float]]:
        """Coefficients of mass, dashpots and springs by power of d."""
        return list(zip_longest(self.mass, self.dashpots, self.springs, fillvalue=0.0))

    def at(self, d: float) -> list[float]:
        """Values of mass, dashpots, springs."""
        return [sum(one * d**i for i, one in enumerate(row)) for row in zip(*self.powers, strict=True)]

    def roots(self, x: ComplexArray | Array, damping: ComplexArray | Array) -> ComplexArray:
        """Roots d = lambda - 1 of coupled modes, (..., p n): x = omega h (..., n), h times modal C (..., n, n).

        The states are x q, d q, d^2 q, ...: without loss of digits at small steps, where lambda is near 1.
        """
        n, p = x.shape[-1], len(self.mass) - 1
        eye, square = np.eye(n), np.eye(n) * (x**2)[..., None]
        terms = [m * eye + c * damping + k * square for m, c, k in self.powers]
        companion = np.zeros((*x.shape[:-1], p * n, p * n), dtype=np.result_type(x, damping))
        rows = np.arange(n)
        companion[..., rows, n + rows] = x
        for i in range(1, p - 1):
            companion[..., i * n + rows, (i + 1) * n + rows] = 1.0
        last = np.concatenate([np.eye(n) * x[..., None], *terms[1:p]], axis=-1)
        companion[..., (p - 1) * n :, :] = -np.linalg.solve(terms[p], last)
        return np.linalg.eigvals(companion).astype(complex)

    def state_roots(self, z: ComplexArray) -> ComplexArray:
        """The root d = lambda - 1 at z = h s, (..., 1), from the difference: near 1 lambda has lost its digits."""
        both = [sum(pair) for pair in zip_longest(*self.state, fillvalue=0.0)]
        over = np.polynomial.polynomial.polyval(z, self.state[1])
        return np.asarray(-np.polynomial.polynomial.polyval(z, both) / over)[..., None]

    def mode(
        self, step: Array | float, pole: ComplexArray, stiffness: ComplexArray, damping: ComplexArray
    ) -> ComplexArray:
        """The root of a mode without the spurious ones, d = lambda - 1, over steps or modes that broadcast.

        `pole` s, with s^2 + damping s + stiffness = 0. Real roots: the slower, or the one that grows.
        """
        z = np.asarray(step * pole)
        if self.state:
            return self.state_roots(z)[..., 0]
        terms = step * np.sqrt(stiffness), step * damping
        x, d = (np.broadcast_to(one, z.shape).astype(complex)[..., None] for one in terms)
        every = self.roots(x, d[..., None])
        turning = every.imag > REAL * abs(every)  # before all real roots, of which the size counts
        size = abs(1.0 + every) / (1.0 + abs(1.0 + every))
        best = np.where(turning, 1.0 + every.imag, size).argmax(axis=-1)
        return np.asarray(np.take_along_axis(every, best[..., None], axis=-1)[..., 0])

    def undamped(self, x: Array) -> ComplexArray:
        """Poles of the simulation over omega, (...), of undamped modes at x = omega h > 0; -re/abs is their damping."""
        one = np.ones(np.shape(x), dtype=complex)
        return np.asarray(np.log1p(self.mode(x, 1j * one, one, np.zeros_like(one))) / x)


class Alpha(NamedTuple):
    """Instants, shares of the step before its end, of inertia and of forces, and Newmark's constants."""

    mass: float
    force: float
    gamma: float
    beta: float


def alphas(radius: float) -> Alpha:
    """Constants of the generalised alpha method by its spectral radius at infinite frequency, 0 to 1."""
    mass, force = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    return Alpha(mass, force, 0.5 - mass + force, 0.25 * (1.0 - mass + force) ** 2)


def newmark(beta: float, gamma: float = 0.5) -> Scheme:
    """Newmark's method; central differences are beta = 0, gamma = 1/2."""
    g, limit = gamma - 0.5, inf if 2.0 * beta >= gamma else 2.0 / sqrt(2.0 * gamma - 4.0 * beta)
    fast = 1.0 / 24.0 - 0.5 * beta + 0.25 * g - g * g / 8.0
    first = (fast, 2) if abs(fast) > 1e-12 else (1.0 / 480.0, 4)
    name = f"Newmark {beta:.4g}, {gamma:.4g}"
    return Scheme(name, limit, first, (0.5 * g, 1), (0.0, 1.0, gamma), (1.0, 0.5 + gamma, beta))


def generalised_alpha(radius: float) -> Scheme:
    """The generalised alpha method, whose equation of motion is a mean over two instants; see `alphas`."""
    (mass, force, gamma, beta), share = alphas(radius), 1.0 / (radius + 1.0) ** 2
    frequency = -(11.0 * radius**2 - 14.0 * radius + 11.0) * share / 24.0, 2
    numerical = ((1.0 - radius) / (1.0 + radius)) ** 3 / 2.0, 3
    every, mean = ((0.0, 1.0, gamma), (1.0, 0.5 + gamma, beta)), (1.0, 1.0 - force)
    dashpots, springs = (tuple(np.convolve(mean, one)) for one in every)
    inertia = (0.0, 0.0, 1.0, 1.0 - mass)
    return Scheme(f"generalised alpha {radius:.4g}", inf, frequency, numerical, dashpots, springs, inertia)


EULER = "semi-implicit Euler"
IMPLICIT_DASHPOTS = Scheme(f"{EULER}, implicit dashpots", 2.0, (1 / 24, 2), (0.0, 1), (0.0, 1.0, 1.0), (1.0, 1.0))
EXPLICIT_DASHPOTS = Scheme(f"{EULER}, explicit dashpots", 2.0, (1 / 24, 2), (0.0, 1), (0.0, 1.0), (1.0, 1.0))
IMPLICIT_EULER = Scheme("implicit Euler", inf, (-1 / 3, 2), (1 / 2, 1), (0.0, 1.0, 1.0), (1.0, 2.0, 1.0))
CENTRAL = newmark(0.0)._replace(name="central differences")
TRAPEZOIDAL = Scheme("trapezoidal rule", inf, (-1 / 12, 2), (0.0, 1), state=((-1.0, -0.5), (1.0, -0.5)))
EXPLICIT_EULER = Scheme("explicit Euler", 0.0, (-1 / 3, 2), (-1 / 2, 1), state=((-1.0, -1.0), (1.0,)))
RK2 = Scheme("Runge-Kutta 2", 0.0, (1 / 6, 2), (-1 / 8, 3), state=((-1.0, -1.0, -1 / 2), (1.0,)))
RK3 = Scheme("Runge-Kutta 3", sqrt(3), (1 / 30, 4), (1 / 24, 3), state=((-1.0, -1.0, -1 / 2, -1 / 6), (1.0,)))
RK4 = Scheme("Runge-Kutta 4", sqrt(8), (-1 / 120, 4), (1 / 144, 5), state=((-1.0, -1.0, -0.5, -1 / 6, -1 / 24), (1.0,)))
RADAU3 = Scheme("Radau IIA 3", inf, (-1 / 270, 4), (1 / 72, 3), state=((-1.0, -1 / 3), (1.0, -2 / 3, 1 / 6)))
TWO_HALVES = Scheme("implicit Euler in halves", inf, (-1 / 12, 2), (1 / 4, 1), state=((-1.0,), (1.0, -1.0, 1 / 4)))
_DORMAND_PRINCE = (-1.0, -1.0, -1 / 2, -1 / 6, -1 / 24, -1 / 120, -1 / 600), (1.0,)
DORMAND_PRINCE = Scheme("Dormand-Prince 5", 0.997189, (1 / 2100, 6), (1 / 3600, 5), state=_DORMAND_PRINCE)
