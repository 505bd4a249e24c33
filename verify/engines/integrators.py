"""Time integrators of multibody engines as maps of one step, for M q'' + C q' + K q = 0 about rest.

The eigenvalues lambda of the map, the multipliers, are powers of one step: a motion grows unless |lambda| <= 1, and
s = ln(lambda)/h, h the step, is the pole of the simulation. A scheme is one of two kinds.

- In place of the whole state: lambda = R(h s) of a pole s of M, C, K, for every C (Runge-Kutta, trapezoidal, Adams).
- In accelerations, dashpots and springs at times of their own, d = lambda - 1:
  mass(d) M + h dashpots(d) C + h^2 springs(d) K is singular. A mode alone has x = omega h and 2 zeta x for h C.

Sources: Hairer & Wanner, Solving Ordinary Differential Equations II (R); Newmark, J. Eng. Mech. Div. 85 (1959); Hilber,
Hughes & Taylor, Earthq. Eng. Struct. Dyn. 5 (1977); Chung & Hulbert, J. Appl. Mech. 60 (1993). What an engine does was
measured in the version of its row, with springs and dashpots of joints, without equalities and contacts.
"""

from itertools import zip_longest
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, shown
from verify.validation import check_choice

Powers = tuple[float, ...]
"""Coefficients of a polynomial, ascending."""
REAL = 1e-9
"""Largest imaginary over absolute part of a root that is real but for rounding."""


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
    state: tuple[Powers, ...] = ()

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
        """Roots d = lambda - 1 at z = h s, (..., p)."""
        rows = [np.polynomial.polynomial.polyval(z, row) for row in self.state]
        if len(rows) == 2:  # the difference first: near 1 lambda has lost its digits
            both = [sum(pair) for pair in zip_longest(*self.state, fillvalue=0.0)]
            return np.asarray(-np.polynomial.polynomial.polyval(z, both) / rows[1])[..., None]
        companion = np.zeros((*z.shape, len(rows) - 1, len(rows) - 1), dtype=complex)
        companion[..., range(len(rows) - 2), range(1, len(rows) - 1)] = 1.0
        companion[..., -1, :] = np.stack([-row / rows[-1] for row in rows[:-1]], axis=-1)
        return np.asarray(np.linalg.eigvals(companion) - 1.0)

    def mode(
        self, step: Array | float, pole: ComplexArray, stiffness: ComplexArray, damping: ComplexArray
    ) -> ComplexArray:
        """The root of a mode without the spurious ones, d = lambda - 1, over steps or modes that broadcast.

        `pole` s, with s^2 + damping s + stiffness = 0. Real roots: the slower, or the one that grows.
        """
        z = np.asarray(step * pole)
        if self.state:
            every = self.state_roots(z)
            best = abs(every + 1.0 - np.exp(z)[..., None]).argmin(axis=-1)
        else:
            terms = step * np.sqrt(stiffness), step * damping
            x, d = (np.broadcast_to(one, z.shape).astype(complex)[..., None] for one in terms)
            every = self.roots(x, d[..., None])
            turning = every.imag > REAL * abs(every)  # before all real roots, of which the size counts
            size = abs(1.0 + every) / (1.0 + abs(1.0 + every))
            best = np.where(turning, 1.0 + every.imag, size).argmax(axis=-1)
        return np.asarray(np.take_along_axis(every, best[..., None], axis=-1)[..., 0])


def newmark(beta: float, gamma: float = 0.5) -> Scheme:
    """Newmark's method; central differences are beta = 0, gamma = 1/2."""
    g, limit = gamma - 0.5, inf if 2.0 * beta >= gamma else 2.0 / sqrt(2.0 * gamma - 4.0 * beta)
    fast = 1.0 / 24.0 - 0.5 * beta + 0.25 * g - g * g / 8.0
    first = (fast, 2) if abs(fast) > 1e-12 else (1.0 / 480.0, 4)
    name = f"Newmark {beta:.4g}, {gamma:.4g}"
    return Scheme(name, limit, first, (0.5 * g, 1), (0.0, 1.0, gamma), (1.0, 0.5 + gamma, beta))


def generalised_alpha(radius: float) -> Scheme:
    """The generalised alpha method by its spectral radius at infinite frequency, 0 to 1."""
    mass, force, share = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0), 1.0 / (radius + 1.0) ** 2
    frequency = -(11.0 * radius**2 - 14.0 * radius + 11.0) * share / 24.0, 2
    numerical = ((1.0 - radius) / (1.0 + radius)) ** 3 / 2.0, 3
    return _alpha(f"generalised alpha {radius:.4g}", mass, force, share, frequency, numerical)


def hht(alpha: float) -> Scheme:
    """The method of Hilber, Hughes and Taylor, alpha from 0 to 1/3."""
    frequency = (9.0 * alpha**2 - 6.0 * alpha - 2.0) / 24.0, 2
    numerical = 0.125 * alpha * (1.0 - alpha) ** 2, 3
    return _alpha(f"HHT {alpha:.4g}", 0.0, alpha, 0.25 * (1.0 + alpha) ** 2, frequency, numerical)


def _alpha(name: str, mass: float, force: float, beta: float, *errors: tuple[float, int]) -> Scheme:
    """A method whose equation of motion is a mean over two instants."""
    gamma, mean = 0.5 - mass + force, (1.0, 1.0 - force)
    dashpots, springs = (tuple(np.convolve(mean, one)) for one in ((0.0, 1.0, gamma), (1.0, 0.5 + gamma, beta)))
    return Scheme(name, inf, errors[0], errors[1], dashpots, springs, (0.0, 0.0, 1.0, 1.0 - mass))


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
_ADAMS = (0.0, 9 / 24), (0.0, -37 / 24), (0.0, 59 / 24), (-1.0, -55 / 24), (1.0,)
ADAMS4 = Scheme("Adams-Bashforth 4", 0.4300, (-251 / 720, 4), (0.541, 5), state=_ADAMS)


class Integrator(NamedTuple):
    """A setting of an engine, its scheme (None: no one-step map in N m/rad), the version measured, and remarks."""

    engine: str
    setting: str
    scheme: Scheme | None
    version: str
    remark: str = ""


INTEGRATORS = (
    Integrator("MuJoCo", "Euler", IMPLICIT_DASHPOTS, "4.0.0"),
    Integrator("MuJoCo", "implicit", IMPLICIT_DASHPOTS, "4.0.0"),
    Integrator(
        "MuJoCo", "implicitfast", IMPLICIT_DASHPOTS, "4.0.0", "springs are explicit in it: the limit is Euler's"
    ),
    Integrator("MuJoCo", "Euler without eulerdamp", EXPLICIT_DASHPOTS, "4.0.0"),
    Integrator("MuJoCo", "RK4", RK4, "4.0.0"),
    Integrator("MuJoCo", "discrete", IMPLICIT_EULER, "4.0.0"),
    Integrator("Drake", "SAP", IMPLICIT_DASHPOTS, "1.51.1", "of a discrete plant; also Lagged and Similar"),
    Integrator("Drake", "TAMSI", EXPLICIT_DASHPOTS, "1.51.1", "of a discrete plant without contact"),
    Integrator("Drake", "SAP, PD gains", IMPLICIT_EULER, "1.51.1", "springs and dashpots are gains of an actuator"),
    Integrator("Drake", "runge_kutta2", RK2, "1.51.1", "fixed step"),
    Integrator("Drake", "runge_kutta3", RK3, "1.51.1", "fixed step; the default controls its error"),
    Integrator("Drake", "explicit_euler", EXPLICIT_EULER, "1.51.1", "fixed step"),
    Integrator("Drake", "semi_explicit_euler", EXPLICIT_DASHPOTS, "1.51.1", "fixed step"),
    Integrator("Drake", "radau1", IMPLICIT_EULER, "1.51.1", "fixed step"),
    Integrator("Drake", "radau3", RADAU3, "1.51.1", "fixed step"),
    Integrator("Drake", "implicit_euler", TWO_HALVES, "1.51.1", "fixed step; also velocity_implicit_euler"),
    Integrator("DART", "default", IMPLICIT_EULER, "6.20.0"),
    Integrator("Gazebo", "DART", IMPLICIT_EULER, "", "from DART, not run in Gazebo"),
    Integrator("Newton", "Featherstone", EXPLICIT_DASHPOTS, "1.8.0", "single precision"),
    Integrator("Newton", "MuJoCo implicitfast", IMPLICIT_DASHPOTS, "1.8.0", "single precision"),
    Integrator("Newton", "MuJoCo Euler", IMPLICIT_DASHPOTS, "1.8.0", "passive damping of joints"),
    Integrator("Newton", "MuJoCo Euler, target_kd", EXPLICIT_DASHPOTS, "1.8.0"),
    Integrator("Newton", "VBD", IMPLICIT_EULER, "1.8.0", "target gains, within 0.2 % from 100 iterations on"),
    Integrator("Newton", "XPBD", None, "1.8.0", "its frequencies depend on the number of iterations"),
    Integrator("Newton", "SemiImplicit", None, "1.8.0", "its joints are penalties with modes of their own"),
    Integrator("Bullet", "user torque", EXPLICIT_DASHPOTS, "3.2.7", "set body damping, 0.04 1/s by default, to 0"),
    Integrator("Bullet", "POSITION_CONTROL", None, "3.2.7", "it is a constraint on velocity"),
    Integrator("Exudyn", "GeneralizedAlpha", generalised_alpha(0.9), "1.13.6", "default, spectral radius 0.9"),
    Integrator("Exudyn", "GeneralizedAlpha 0.5", generalised_alpha(0.5), "1.13.6"),
    Integrator("Exudyn", "Newmark", newmark(0.25), "1.13.6"),
    Integrator("Exudyn", "TrapezoidalIndex2", TRAPEZOIDAL, "1.13.6"),
    Integrator("Exudyn", "ExplicitEuler", EXPLICIT_EULER, "1.13.6"),
    Integrator("Exudyn", "ExplicitMidpoint", RK2, "1.13.6"),
    Integrator("Exudyn", "RK33", RK3, "1.13.6"),
    Integrator("Exudyn", "RK44", RK4, "1.13.6"),
    Integrator("Exudyn", "VelocityVerlet", EXPLICIT_DASHPOTS, "1.13.6"),
    Integrator("PyElastica", "PositionVerlet", CENTRAL, "1.0.0"),
)
"""The first setting of an engine is its default."""


def integrator_of(engine: str, setting: str = "") -> Integrator:
    """The row of an engine, by default its first one; capitals do not matter. Raises InputError."""
    rows = [row for row in INTEGRATORS if row.engine.casefold() == str(engine).casefold()]
    if not rows:
        check_choice("engine", engine, tuple(dict.fromkeys(row.engine for row in INTEGRATORS)))
    named = {row.setting.casefold(): row for row in rows}
    if (name := setting or rows[0].setting).casefold() not in named:
        check_choice("integrator", setting, [row.setting for row in rows])
    return named[name.casefold()]


def scheme_of(engine: str, setting: str = "") -> Scheme:
    """The scheme of a row of `integrator_of`. Raises InputError."""
    if (scheme := (row := integrator_of(engine, setting)).scheme) is None:
        text = f"has no springs in N m/rad: {row.remark}, choose another of {engine}"
        raise InputError(f"integrator = {shown(setting)} {text}")
    return scheme
