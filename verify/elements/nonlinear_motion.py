"""Large motion of nonlinear Hermite elements in time: the generalised-alpha method with error control.

J. Chung and G. M. Hulbert, J. Appl. Mech. 60 (1993) 371: order 2, unconditionally stable for linear problems; `RHO` is
the factor by which a step multiplies the fastest modes. Those are axial and short bending modes, which no step for the
motion resolves; slow modes lose 0.0007 (omega h)^3 of their amplitude per radian (`linear.step_schemes`), and the
energy balance says what was lost. The base moves as prescribed; in its frame that is inertia: Coriolis, centrifugal,
Euler, translation.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np
from scipy.linalg import LinAlgError

from verify.arrays import Array, ComplexArray
from verify.elements.nonlinear import NonlinearHermite
from verify.elements.plane_elements import NONE, QUARTER, Forces
from verify.errors import InputError, shown
from verify.linear.step_schemes import alphas
from verify.problem.base_motion import FIXED, Base
from verify.problem.beam import PointForce
from verify.timing import Pace
from verify.validation import check_number

RHO = 0.8  # spectral radius at infinite frequency: 15 steps leave a thirtieth of the fastest modes
ALPHA_M, ALPHA_F, GAMMA, BETA = alphas(RHO)
ERROR = abs(BETA - 1.0 / 6.0)
"""Of the third derivative times h^3 in a step of Newmark's method (O. C. Zienkiewicz and Y. M. Xie, Earthquake Eng.
Struct. Dyn. 20 (1991) 871). An upper bound: that of generalised-alpha is less by half of ALPHA_F - ALPHA_M, 0.086."""
SOLVED = 1e-3  # Newton step over the tolerance that ends an iteration
GROWTH, SHRINK, SAFETY = 1.5, 0.5, 0.8
"""A step changes by at most these factors, since the acceleration is that of a time that depends on it."""
LEAST = 1e-9  # step over the duration at which the run gives up

SMALL = 1e-12  # Energy over EI/L of a tip that moves by a millionth of the length


@dataclass(frozen=True, eq=False, kw_only=True)
class NonlinearMotion:
    """Motion of nonlinear elements in the frame of their base."""

    model: NonlinearHermite
    times: Array
    """(n,), s."""
    states: Array
    """(n, count + 1, 2, 2): of a node r = (x, y), m, then r'."""
    rates: Array
    """(n, count + 1, 2, 2): their derivatives by time."""
    energies: Array
    """(3, n), J: kinetic energy relative to the base, strain energy, work of loads and of the base's inertia forces."""
    steps: int
    rejected: int

    @property
    def tip(self) -> Array:
        """(n, 2), m: (x, y) of the right end."""
        return self.states[:, -1, 0]

    def position(self, s: float) -> Array:
        """(n, 2), m: (x, y) of the point at arc length `s` of the straight beam. Raises InputError off the beam."""
        weights = self.model.weights(s)
        return np.asarray(np.einsum("ij,nijc->nc", weights, self.states))

    @property
    def energy_lost(self) -> float:
        """Energy that the steps took, over the largest energy, of any sign: that of unresolved axial waves is added.

        The largest energy is at least `SMALL` EI/L, below which the motion is one of rounding.
        """
        kinetic, strain, work = self.energies
        least = SMALL * self.model.beam.bending_stiffness / self.model.beam.length
        return float(np.diff((work - kinetic - strain)[[0, -1]])[0]) / max(float((kinetic + strain).max()), least)

    def __repr__(self) -> str:
        return f"NonlinearMotion({self.model.count} elements, {self.times[-1]:g} s, {self.steps} steps)"


@dataclass(frozen=True, eq=False)
class _Instant:
    """State and rate at a time; acceleration, of (ALPHA_M - ALPHA_F) h after it, h the step that ends there."""

    time: float
    state: Array
    rate: Array
    acceleration: Array


def large_motion(
    model: NonlinearHermite,
    times: Sequence[float] | Array,
    *,
    forces: Forces | Callable[[float], Forces] = NONE,
    drive: Sequence[PointForce] = (),
    frequency_hz: float = 0.0,
    base: Base = FIXED,
    start: Array | None = None,
    start_rate: Array | None = None,
    tolerance: float = 1e-7,
    progress: Callable[[float], None] = lambda share: None,
    most_steps: float = np.inf,
) -> NonlinearMotion:
    """Motion from `start` (default: the unloaded beam) with rates `start_rate` (default: at rest relative to the base).

    `times` ascend from 0. `forces` are dead loads in the frame of the ground, which may depend on time, s; `drive` are
    harmonic forces across the straight beam, which turn with the base. `tolerance` bounds the error of a step in
    displacement over the length; that of the motion is larger by about the number of steps in a period. Raises
    InputError where the step falls below a billionth of the duration, and where more than `most_steps` are expected.
    """
    samples = np.atleast_1d(np.asarray(times, dtype=float))
    if samples[0] < 0.0 or not (np.diff(samples) > 0.0).all() or not samples[-1] > 0.0:
        raise InputError(f"times = {shown(times)}: give ascending times from 0 on, s")
    check_number("tolerance", tolerance, "of the length", above=0, at_most=1e-2)
    ground = forces if callable(forces) else (lambda time: forces)
    run = _Run(model, ground, model.across(drive), 2.0 * pi * frequency_hz, base, tolerance)
    return run.march(samples, start, start_rate, progress, Pace(float(samples[-1]), most_steps))


class _Run:
    """One run: the forces on a model, and its step."""

    def __init__(
        self,
        model: NonlinearHermite,
        forces: Callable[[float], Forces],
        drive: ComplexArray,
        omega: float,
        base: Base,
        tolerance: float,
    ) -> None:
        self.model, self.forces, self.base, self.tolerance = model, forces, base, tolerance
        self.drive, self.omega = drive, omega
        self.mass = model.element_masses
        self.turned = np.einsum("nij,jk->nik", self.mass, np.kron(np.eye(4), QUARTER))
        self.hub = np.zeros_like(model.rest)
        self.hub[:, 0, 0] = base.hub_radius

    def external(self, time: float, state: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Loads and inertia forces of the base (n_all,), minus their derivatives by state and rate, (n, 8, 8)."""
        (angle, spin, turn), model = self.base.rotation(time), self.model
        frame = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
        translation = frame @ [self.base.x(time)[2], self.base.y(time)[2]]
        ground = self.forces(time)
        forces = ground._replace(tip=frame @ ground.tip, gravity=frame @ ground.gravity - translation)
        loads, by_state = model.loads(forces, state)
        centrifugal, gyroscopic = turn * self.turned - spin**2 * self.mass, 2.0 * spin * self.turned
        inertia = centrifugal @ model.of_elements(state + self.hub)[..., None]
        inertia += gyroscopic @ model.of_elements(rate)[..., None]
        driven = (self.drive * np.exp(1j * self.omega * time)).real.ravel()
        return model.vector(loads - inertia[..., 0]) + driven, centrifugal - by_state, gyroscopic

    def step(self, now: _Instant, h: float, jerk: Array) -> tuple[_Instant, float] | None:
        """(next instant, error of the step over the tolerance); None where Newton's method does not converge.

        The error is ERROR h^2 times the change of acceleration, of fast modes as far as the step resolves them: the
        matrix of the step over that of its mass takes their part off (L. F. Shampine's filter for stiff problems).
        """
        model, a = self.model, now.acceleration + h * jerk
        start = now.state + h * now.rate + h * h * (0.5 - BETA) * now.acceleration
        start_rate = now.rate + h * (1.0 - GAMMA) * now.acceleration
        time, mix = now.time + (1.0 - ALPHA_F) * h, 1.0 - ALPHA_F
        for _ in range(8):
            state, rate = start + h * h * BETA * a, start_rate + h * GAMMA * a
            middle = mix * state + ALPHA_F * now.state
            forces, stiffness, damping = self.external(time, middle, mix * rate + ALPHA_F * now.rate)
            gradient, hessian = model.elastic(middle)
            mean = model.of_elements((1.0 - ALPHA_M) * a + ALPHA_M * now.acceleration)
            right = forces - model.vector(gradient + (self.mass @ mean[..., None])[..., 0])
            matrix = (1.0 - ALPHA_M) * self.mass + mix * (h * h * BETA * (hessian + stiffness) + h * GAMMA * damping)
            try:
                change = model.solve(model.band(matrix), right)
            except LinAlgError:
                return None
            a = a + change
            moved = h * h * BETA * abs(change[:, 0]).max() / model.beam.length
            if not moved < 1.0:
                return None
            if moved < SOLVED * self.tolerance:
                inertia = self.mass @ model.of_elements(a - now.acceleration)[..., None]
                resolved = (1.0 - ALPHA_M) * model.solve(model.band(matrix), model.vector(inertia[..., 0]))
                error = ERROR * h * h * abs(resolved[:, 0]).max() / (model.beam.length * self.tolerance)
                return _Instant(now.time + h, start + h * h * BETA * a, start_rate + h * GAMMA * a, a), float(error)
        return None

    def march(
        self, times: Array, start: Array | None, start_rate: Array | None, progress: Callable[[float], None], pace: Pace
    ) -> NonlinearMotion:
        """Steps to the last time, interpolated to all."""
        model, end = self.model, float(times[-1])
        state = model.rest if start is None else start
        rate = np.zeros_like(state) if start_rate is None else start_rate
        forces = self.external(0.0, state, rate)[0] - model.vector(model.elastic(state)[0])
        now = _Instant(0.0, state, rate, model.solve(model.band(self.mass), forces))  # in balance
        instants, jerk, placed, rejected = [now], np.zeros_like(state), 0.0, 0
        # in the first step the initial acceleration moves the beam by the tolerance
        size = abs(now.acceleration[:, 0]).max()
        h = min(1e-2 * end, (self.tolerance * model.beam.length / size) ** 0.5 if size else 1e-3 * end)
        while now.time < end * (1.0 - 1e-12):
            h = min(h, end - now.time)
            # the acceleration belongs to t + (ALPHA_M - ALPHA_F) times the step before: move it to where this one does
            moved = replace(now, acceleration=now.acceleration + (ALPHA_M - ALPHA_F) * (h - placed) * jerk)
            new, error = self.step(moved, h, jerk) or (None, 8.0)  # without convergence half the step
            pace.check(len(instants) + rejected, now.time / end)
            if new is None or error > 1.0:
                rejected, h = rejected + 1, h * max(SAFETY * error ** (-1 / 3), SHRINK)
                if h < LEAST * end:
                    text = f"tolerance = {self.tolerance!r}: no step converges at {now.time:g} s, "
                    raise InputError(f"{text}give another, more elements or a slower motion")
                continue
            now, jerk, placed = new, (new.acceleration - moved.acceleration) / h, h
            factor = min(SAFETY * max(error, 1e-9) ** (-1 / 3), GROWTH)
            h *= 1.0 if 0.9 < factor < 1.1 else factor
            instants.append(now)
            progress(now.time / end)
        return self._motion(instants, times, rejected)

    def _motion(self, instants: list[_Instant], times: Array, rejected: int) -> NonlinearMotion:
        from scipy.interpolate import CubicHermiteSpline

        at = np.array([instant.time for instant in instants])
        states, rates, accelerations = (
            np.array([getattr(instant, name) for instant in instants]) for name in ("state", "rate", "acceleration")
        )
        moving = rates.reshape(len(at), -1)[:, self.model.values]
        kinetic = 0.5 * np.einsum("tni,nij,tnj->t", moving, self.mass, moving)
        forces = np.array([self.external(now.time, now.state, now.rate)[0] for now in instants])
        shares = 0.5 * (forces[1:] + forces[:-1]) * np.diff(states.reshape(len(at), -1), axis=0)
        work = np.concatenate([[0.0], np.cumsum(shares.sum(axis=1))])  # exact for constant and for centrifugal forces
        return NonlinearMotion(
            model=self.model,
            times=times,
            states=CubicHermiteSpline(at, states, rates)(times),
            rates=CubicHermiteSpline(at, rates, accelerations)(times),
            energies=np.array([np.interp(times, at, value) for value in (kinetic, self.model.energy(states), work)]),
            steps=len(instants) - 1,
            rejected=rejected,
        )
