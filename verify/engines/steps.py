"""A chain of links in the steps of an engine: frequency, damping ratio and stability limit of the simulation.

Small vibration about rest, without equalities and contacts. In MuJoCo an equality acts after the dashpots of Euler and
implicit steps: with a supported far end damped figures are approximate.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, inf, pi
from typing import Any, NamedTuple

import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray, Indices
from verify.blas import one_blas_thread
from verify.engines.description import Axis, RigidChain
from verify.errors import InputError
from verify.linear.step_schemes import REAL, Scheme
from verify.validation import check_integer, check_number

UNCOUPLED = 1e-9
"""Modal damping c_ij over (c_ii c_jj)^(1/2) + (omega_i omega_j)^(1/2) that leaves poles as they are."""
SINGULAR = 1e-12
"""Eigenvalue of K with a unit diagonal that is 0 but for rounding."""
GROWTH = 1e-12
"""Rounding of |lambda| - 1, in one step, of a motion that does not grow."""


class Poles(NamedTuple):
    """Poles s of M, C, K, (2n,), 1/s, the undamped mode of each, its modal K and C: s^2 + damping s + stiffness = 0.

    `first`: index of the pole of every mode, (n,), the upper one of a pair or the slower of two real ones.
    """

    s: ComplexArray
    mode: Indices
    stiffness: ComplexArray
    damping: ComplexArray
    first: Indices


class Modes(NamedTuple):
    """Damped frequencies, Hz, and damping ratios, (n,) each, of the file and of its simulation.

    0 Hz: overdamped or rigid; nan: the sign flips at every step. A negative ratio grows.
    """

    file_hz: Array
    file_zeta: Array
    hz: Array
    zeta: Array


@dataclass(frozen=True, eq=False)
class Simulated:
    """M, C, K (n, n) of a chain about rest, with joint armature in M, in steps h (s) of a scheme.

    Modes ascend by undamped frequency. `constraints`: rows (m, n) that are zero. Raises InputError
    for a mass or stiffness matrix that is not positive, up to rigid motions.
    """

    mass: Array
    damping: Array
    stiffness: Array
    step: float
    scheme: Scheme
    constraints: Array | None = None

    def __post_init__(self) -> None:
        check_number("step", self.step, "s", above=0)

    @cached_property
    @one_blas_thread()
    def modal(self) -> tuple[Array, Array, Array]:
        """(omega (n,), 1/s, C (n, n), shapes (unknowns, n)) of the undamped modes with unit modal mass."""
        from scipy.linalg import eigh, null_space

        constrained = self.constraints is not None and len(self.constraints)
        basis = null_space(self.constraints) if constrained else np.eye(len(self.mass))
        mass, damping, stiffness = (basis.T @ one @ basis for one in (self.mass, self.damping, self.stiffness))
        scale = np.where(np.diag(stiffness) > 0.0, np.diag(stiffness), 1.0) ** -0.5
        relative = eigh(stiffness * np.outer(scale, scale), eigvals_only=True)
        loose = int((relative < SINGULAR).sum())
        if relative[0] < -SINGULAR or loose == len(relative):
            raise InputError("stiffness: it is not positive, judge a chain with springs and stable at rest")
        try:  # the inverse problem leaves low modes and proportional dashpots their digits
            subset = {"eigvals_only": True, "subset_by_index": [loose, loose]}
            shift = float(eigh(stiffness, mass, **subset)[0]) if loose else 0.0
            inverse, shapes = (one[..., ::-1] for one in eigh(mass, stiffness + shift * mass))
        except np.linalg.LinAlgError:
            inverse = np.zeros(1)
        if inverse[-1] <= 0.0:
            raise InputError("mass, stiffness: they are not positive, give every link a mass and an inertia")
        omega2 = np.where(np.arange(len(inverse)) < loose, 0.0, 1.0 / inverse - shift)
        shapes = shapes / np.sqrt(inverse)
        return np.sqrt(omega2), shapes.T @ damping @ shapes, basis @ shapes

    @cached_property
    def _groups(self) -> tuple[Indices, list[Indices]]:
        """(modes that the dashpots leave uncoupled, groups of the others)."""
        from scipy.sparse.csgraph import connected_components

        omega, damping, _ = self.modal
        scales = (np.sqrt(abs(one)) for one in (np.diag(damping), np.maximum(omega, omega[omega > 0.0][0])))
        _, labels = connected_components(abs(damping) > UNCOUPLED * sum(np.outer(one, one) for one in scales))
        _, inverse, sizes = np.unique(labels, return_inverse=True, return_counts=True)
        groups = [np.flatnonzero(inverse == i) for i in np.flatnonzero(sizes > 1)]
        return np.flatnonzero(sizes[inverse] == 1), groups

    @cached_property
    @one_blas_thread()
    def poles(self) -> Poles:
        """Poles of the file, exact for every C."""
        from scipy.optimize import linear_sum_assignment

        omega, damping, _ = self.modal
        alone, groups = self._groups
        c, k = np.diag(damping)[alone].astype(complex), omega[alone] ** 2
        root = np.sqrt(c**2 / 4.0 - k)
        far = -c / 2.0 - root
        near = np.divide(k, far, out=-c / 2.0 + root, where=(far != 0.0) & (root.imag == 0.0))
        parts = [(near, alone, k, c), (far, alone, k, c)]
        first = np.zeros(len(omega), dtype=np.int64)
        first[alone] = np.arange(len(alone))
        start = 2 * len(alone)
        for group in groups:
            x, d, n = omega[group], damping[np.ix_(group, group)], len(group)
            s, vectors = np.linalg.eig(np.block([[np.zeros((n, n)), np.diag(x)], [-np.diag(x), -d]]))
            still = np.sum(abs(vectors[n:]) ** 2, axis=0) < REAL**2  # a rigid motion at rest has no rates
            shapes = np.where(still, vectors[:n], vectors[n:])
            share = abs(shapes) ** 2 / np.sum(abs(shapes) ** 2, axis=0)
            size = np.sum(shapes**2, axis=0)
            c, k = (np.sum(shapes * (a @ shapes), axis=0) / size for a in (d, np.diag(x**2)))
            upper = np.flatnonzero(s.imag >= 0.0)
            slow = 1e-6 * abs(s[upper]) / abs(s).max()  # of two real poles with one shape the slower
            rows, columns = linear_sum_assignment(slow - share[:, upper])
            first[group[rows]] = start + upper[columns]
            parts.append((s, group[share.argmax(axis=0)], k, c))
            start += 2 * n
        s, mode, k, c = (np.concatenate(each) for each in zip(*parts, strict=True))
        return Poles(s.astype(complex), mode, k.astype(complex), c.astype(complex), first)

    @cached_property
    @one_blas_thread()
    def _stepped(self) -> tuple[ComplexArray, ComplexArray]:
        """(of the modes, (n,), of all states) lambda - 1."""
        from scipy.optimize import linear_sum_assignment

        p, h, scheme = self.poles, self.step, self.scheme
        modes = scheme.mode(h, *(one[p.first] for one in (p.s, p.stiffness, p.damping)))
        if scheme.state:
            return modes, scheme.state_roots(h * p.s).ravel()
        omega, damping, _ = self.modal
        alone, groups = self._groups
        every = [scheme.roots(h * omega[alone, None], h * np.diag(damping)[alone, None, None]).ravel()]
        for group in groups:
            every.append(scheme.roots(h * omega[group], h * damping[np.ix_(group, group)]))
            # the pole's own shape gives a root whose error is of second order, near enough to name the exact one
            rows, columns = linear_sum_assignment(abs(modes[group, None] - every[-1]))
            modes[group[rows]] = every[-1][columns]
        return modes, np.concatenate(every)

    @property
    def multipliers(self) -> ComplexArray:
        """Multipliers of one step, 2n, of multi-step and alpha methods more."""
        return 1.0 + self._stepped[1]

    @cached_property
    def modes(self) -> Modes:
        """Every mode in the file and in the simulation."""
        file, steps = self.poles.s[self.poles.first], self._stepped[0]
        s = _pole(steps, self.step)
        hertz = np.where((steps.real < -1.0) & (abs(steps.imag) <= REAL * abs(steps)), np.nan, _hertz(s))
        return Modes(_hertz(file), _ratio(file), hertz, _ratio(s))

    @property
    def rigid(self) -> int:
        """Number of rigid motions, the first modes."""
        return int((self.modal[0] == 0.0).sum())

    @property
    def omega_max(self) -> float:
        """Highest undamped frequency, 1/s."""
        return float(self.modal[0][-1])

    @cached_property
    @one_blas_thread()
    def limit(self) -> float:
        """Largest stable step, s; inf of an implicit scheme, 0 of one that every undamped mode makes grow."""
        from scipy.linalg import eigh

        omega, damping, _ = self.modal
        if self.scheme.limit == inf:
            return inf
        if self.scheme.state:
            return _reach(self.scheme, self.poles.s)
        # a scheme of three instants leaves the circle at lambda = -1: the largest 1/h of a hyperbolic problem
        m, c, k = self.scheme.at(-2.0)
        shape, value = np.eye(len(omega))[-1], 0.0
        for _ in range(50):  # the root of a shape's quotient rises to the largest, quadratically
            half = 0.5 * c * float(shape @ damping @ shape) / m
            before, value = value, -half + float(np.sqrt(half**2 - k * np.sum((omega * shape) ** 2) / m))
            if value <= before * (1.0 + 1e-13):
                break
            matrix = np.diag(m * value**2 + k * omega**2) + c * value * damping
            shape = eigh(matrix, subset_by_index=[0, 0])[1][:, 0]
        return 1.0 / value

    @property
    def stable(self) -> bool:
        """Whether the step is within the limit."""
        return self.step <= self.limit

    @property
    def substeps(self) -> int:
        """Least number of equal parts of the step that are stable; 0: no number is."""
        return max(ceil(self.step / self.limit), 1) if self.limit else 0

    def step_for(self, mode: int, within: float, *, damping: bool = False) -> float:
        """Largest step, s, up to which |f/f of the file - 1| of a mode, or |zeta - zeta of the file|, is `within`.

        Not the stability limit. Where dashpots couple modes by the shape of the pole, to second order.
        Raises InputError.
        """
        check_integer("mode", mode, 1, len(self.poles.first))
        p, i = self.poles, self.poles.first[mode - 1]
        pole, each = p.s[i : i + 1], (p.s[i : i + 1], p.stiffness[i : i + 1], p.damping[i : i + 1])
        if not abs(pole[0].imag) > 0.0:
            raise InputError(f"mode = {mode}: it is overdamped or rigid, choose another")

        def good(steps: Array) -> BoolArray:
            s = _pole(self.scheme.mode(steps, *each), steps)
            error = _ratio(s) - _ratio(pole) if damping else _hertz(s) / _hertz(pole) - 1.0
            return np.asarray(abs(error) <= within)

        low, steps = 0.0, np.geomspace(1e-6, 4.0, 400) / abs(pole[0])
        for _ in range(5):  # to the first bad step, then 400 times closer each
            bad = ~good(steps)
            if not bad.any():
                return inf
            last = int(bad.argmax())
            low = float(steps[last - 1]) if last else low
            steps = np.linspace(low, steps[last], 401)[1:]
        return low


def _pole(increments: ComplexArray, step: Array | float) -> ComplexArray:
    """ln(lambda)/h of lambda - 1."""
    return np.asarray(np.log1p(increments) / step)


def _hertz(s: ComplexArray) -> Array:
    """|Im s|/(2 pi)."""
    return np.asarray(abs(s.imag) / (2.0 * pi))


def _ratio(s: ComplexArray) -> Array:
    """-Re s/|s|, 0 of a rigid motion."""
    return np.asarray(-s.real / np.where(s == 0.0, 1.0, abs(s)))


def _reach(scheme: Scheme, s: ComplexArray) -> float:
    """Largest step at which no pole s grows by an explicit scheme."""
    size = float(abs(s).max())
    # decay below rounding is none: it would hide, or feign, a slow growth
    unit = np.where(abs(s.real) < REAL * abs(s), 0.0, s.real / size) + 1j * s.imag / size

    def grows(r: float) -> BoolArray:
        return np.asarray(abs(1.0 + scheme.state_roots(r * unit)).max(axis=-1) > 1.0 + GROWTH)

    # no explicit scheme of the table is stable beyond |z| = 4 in the left half plane
    edges = np.linspace(0.0, 4.0, 81)
    last = next(i for i in range(1, len(edges)) if grows(edges[i]).any())
    low, high = edges[last - 1], edges[last]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle).any() else (middle, high)
    # at |z| = 2e-3 a scheme that makes undamped modes grow does it by less than GROWTH
    return low / size if low > 2e-3 else 0.0


def simulated_chain(chain: RigidChain, step: float, scheme: Scheme, axis: Axis | None = None) -> Simulated:
    """A chain in the steps of a scheme, with armature and drag, about all axes of its hinges or one."""
    from scipy.linalg import block_diag

    axes, damping = chain.motions if axis is None else (axis,), list[Array]()
    mass, stiffness = (list(each) for each in zip(*map(chain.matrices, axes), strict=True))
    for i, about in enumerate(axes):
        unknowns = chain.unknowns(about)
        turns: Any = [name.partition("_")[2] if name.startswith("joint") else "" for name, *_ in unknowns]
        hinges = [chain.joints[j].hinge(turn) for turn, (_, j, _) in zip(turns, unknowns, strict=True)]
        damping.append(np.diag([hinge.damping if hinge else 0.0 for hinge in hinges]))
        mass[i] = mass[i] + np.diag([hinge.armature if hinge else 0.0 for hinge in hinges])
        for _, weights, _, dashpot in chain.grounded(about):
            damping[-1] += dashpot * np.outer(weights, weights)
        if chain.viscosity:
            damping[-1] += chain.drag(about)
    constraints = block_diag(*map(chain.constraints, axes))
    return Simulated(block_diag(*mass), block_diag(*damping), block_diag(*stiffness), step, scheme, constraints)
