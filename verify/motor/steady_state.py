"""Steady state of a motor at a prescribed speed: means over whole periods of the drive, with their standard errors.

The slider has the prescribed speed and a fixed position, so that its transverse motion can be periodic. Consecutive
windows of whole periods, each as long as all before it, are divided into 16 batches, whose means give the standard
error (batch means: G. S. Fishman, Discrete-Event Simulation, Springer 2001, sec. 6.6). The error of the normal force is
the momentum balance: preload less mean normal force is the transverse momentum gained over the window.

A point with tangential stiffness follows the slider elastically until it slips, at low speed for any number of periods,
in which mean friction grows too slowly for a comparison of windows. The state of a point that has slipped is
independent of its start (play operator: M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with Hysteresis, Springer
1989, ch. 2): in the first window the speed is so high that all points slip.
"""

from functools import lru_cache
from math import copysign
from typing import Literal, NamedTuple

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.actuators.on_beam import Mounted
from verify.arrays import Array
from verify.dynamics.arguments import Excitation, Keep, PrescribedSlider, Step
from verify.dynamics.linear_system import steady_beam
from verify.dynamics.request import FEET_STEPS_PER_PERIOD
from verify.dynamics.result import Motion
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.estimate import Estimate
from verify.formatting import one_line, with_error
from verify.linear.surface import section_at
from verify.problem.beam import Beam, PointLoad
from verify.problem.slider import Slider
from verify.settings import Start

Figure = Literal["force", "normal force", "fractions", "powers"]
BATCHES = 16
FIRST = 48
"""Periods of the first two windows: batches of 3, then of 6 periods, multiples of subharmonics of order 2 and 3."""
PERIODS = 12_500  # Default for the largest number of periods until the means converge
CHAOTIC = 768
"""Periods above which the tolerance is that of a nonperiodic motion; in shorter windows its batches are correlated."""
TOLERANCES: "dict[Figure, tuple[float, float]]" = {
    "force": (3e-4, 1e-2),
    "normal force": (3e-3, 1e-2),
    "fractions": (1e-2, 1e-2),
    "powers": (1e-2, 1e-2),
}
"""Largest error over full scale (mu N, N, 1, mu N times the largest slip speed), before and from `CHAOTIC` on."""
UNCONVERGED: dict[str, str] = {
    "force": "the mean friction force has not converged, raise periods or slider.preload",
    "normal force": "the mean normal force has not converged, raise periods or slider.contact.damping",
    "fractions": "the fractions of contact and stick have not converged, raise periods or slider.contact.damping",
    "powers": "the mean powers have not converged, raise periods or slider.contact.damping",
}
NO_POWER = "no power flows from the surface to the load, choose a speed between zero and the no-load speed"
GROUPS: "dict[str, Figure]" = {
    "normal_force": "normal force",
    "contact_fraction": "fractions",
    "stick_fraction": "fractions",
    "friction_power": "powers",
}
"""Criterion of convergence of a mean; that of all others is the force."""
UNITS: "dict[Figure, str]" = {"force": " N", "normal force": " N", "fractions": "", "powers": " W"}
TIMED = 16  # Periods over which the time of a period is measured, to some per cent
SLIPS = 8.0
"""Slider displacement in the first window over mu N / (stiffness of the softest point), at which all points slip."""


class MotorCase(Struct, frozen=True, kw_only=True):
    """A slider with feet on a driven beam, and the model of the beam; fields as in `simulate`."""

    beam: Beam
    forces: tuple[PointLoad, ...]
    frequency_hz: float
    slider: Slider
    model: str
    count: int | None = None
    modes: int | None = None
    start: Start = "steady"
    soft_start_periods: float = 0.0
    modal_damping: float | None = None
    steps_per_period: int = FEET_STEPS_PER_PERIOD
    circuits: tuple[Mounted, ...] = ()

    @property
    def period(self) -> float:
        """Drive period, s."""
        return 1.0 / self.frequency_hz

    def run(
        self, periods: float, samples: int, before: Motion | None = None, prescribed_speed: float | None = None
    ) -> Motion:
        """A run of `periods` drive periods, fixed in position if the speed (m/s) is prescribed. Raises InputError."""
        free = prescribed_speed is None
        return simulate(
            self.beam,
            Excitation(self.forces, self.frequency_hz, self.soft_start_periods, circuits=self.circuits),
            periods * self.period,
            model=self.model,
            count=self.count,
            modes=self.modes,
            modal_damping=self.modal_damping,
            slider=self.slider if free else PrescribedSlider(self.slider, prescribed_speed, fixed_position=True),
            start=self.start if before is None else before,
            step=Step(per_period=self.steps_per_period),
            keep=Keep(samples=samples),
        )


@lru_cache(maxsize=16)
def surface_motion(case: MotorCase) -> tuple[float, float]:
    """(deflection amplitude, m, crest speed (h/2) omega |w'|, m/s) at the slider's position, without slider.

    The crest speed has the sign of the velocity along +x at a crest: negative for a wave towards +x.
    """
    settings = case.model, case.count, case.beam, case.forces, case.frequency_hz, case.modal_damping
    field = steady_beam(*settings, case.circuits).field
    x = case.slider.initial_position(case.beam)
    tangential = section_at(case.beam, x).surface_distance * field.omega
    deflection, slope = complex(field.deflection([x])[0]), complex(field.slope([x])[0])
    return abs(deflection), tangential * float(np.copysign(abs(slope), (slope * deflection.conjugate()).imag))


def crest_speed(case: MotorCase) -> float:
    """Amplitude of the tangential surface velocity under the slider, first order, m/s."""
    return abs(surface_motion(case)[1])


class Means(NamedTuple):
    """Means over a window and all points, or their errors."""

    force: float
    """Friction on the slider along +x, N."""
    normal_force: float
    """N."""
    contact_fraction: float
    """Fraction of points and time in contact."""
    stick_fraction: float
    """Fraction of points and time in stick."""
    surface_power: float
    """Power of the surface's tangential motion on the slider, W."""
    friction_power: float
    """Power lost in friction and tangential compliance, W."""


class SteadyState(Struct, frozen=True, eq=False, kw_only=True):
    """A motor at a prescribed speed."""

    speed: float
    """m/s along +x."""
    means: Means
    """Means over the last window."""
    errors: Means
    """Errors of the means: the larger of twice the standard error of the batch means and the difference of the window's
    halves; for the normal force the momentum balance; for the powers the change from the previous window. A force that
    has not converged has at least its change from the two windows before, since the motion may change its kind."""
    periods: int
    """Number of periods of all windows."""
    not_converged: tuple[Figure, ...]
    run: Motion
    """The last window, which another run can continue."""
    __repr__ = one_line(speed="m/s", periods="", power="W")

    @property
    def power(self) -> float:
        """Mechanical power on the slider, force times speed, W."""
        return self.means.force * self.speed + 0.0  # no negative zero

    @property
    def efficiency(self) -> float | None:
        """Power over surface power; None if one is negative or the surface power is zero."""
        supplied = self.means.surface_power
        return self.power / supplied if supplied > 0.0 and self.power >= 0.0 else None

    def estimate(self, figure: str) -> Estimate:
        """One of `Means`, the power, or the efficiency (whose error is 0), SI. Raises InputError if not converged."""
        criteria: tuple[Figure, ...] = ("force", "powers") if figure == "efficiency" else (GROUPS.get(figure, "force"),)
        if missing := next((name for name in criteria if not self.converged(name)), None):
            name = figure if figure in Means._fields else "force" if missing == "force" else "friction_power"
            so_far = with_error(getattr(self.means, name), getattr(self.errors, name))
            text = f"{UNCONVERGED[missing]} ({name.replace('_', ' ')} so far: {so_far}{UNITS[missing]})"
            raise InputError(f"periods = {self.periods!r}: {text}")
        if figure == "power":
            return Estimate(self.power, abs(self.speed) * self.errors.force)
        if figure != "efficiency":
            return Estimate(getattr(self.means, figure), getattr(self.errors, figure))
        if self.efficiency is None:
            raise InputError(f"speed = {self.speed!r} m/s: {NO_POWER}")
        return Estimate(self.efficiency)

    def converged(self, *figures: Figure) -> bool:
        """Whether `figures` (default: all) have converged."""
        return not set(figures or TOLERANCES) & set(self.not_converged)


def steady_state(
    case: MotorCase, speed: float, periods: int = PERIODS, before: Motion | None = None, relative: float = 0.0
) -> SteadyState:
    """Means of a motor at a prescribed speed, m/s, within `periods` drive periods; `before` is a run to continue.

    A force with a relative error below `relative` counts as converged. Raises InputError where the motion diverges.
    """
    slider, contact = case.slider, case.slider.contact
    stiffnesses = [contact.along(foot.length) / foot.points for foot in slider.feet] if contact else []
    softest = min((one for one in stiffnesses if one), default=np.inf)
    # all points slip in the first window: 8 times the deformation of the softest under the limit of the whole slider
    least = SLIPS * slider.mu * slider.normal_force / softest / (FIRST * case.period)
    first = copysign(max(abs(speed), least), speed) if speed else 0.0
    state = _window(case, first, FIRST, before, None)
    state = _window(case, speed, FIRST, state.run, state)
    forces = [state.means.force]
    while state.not_converged and 2 * state.periods <= periods:
        if state.errors.force < relative * abs(state.means.force):
            break
        state = _window(case, speed, state.periods, state.run, state)
        forces.append(state.means.force)
    if state.converged("force"):
        return state
    changes = np.abs(np.subtract(forces[-3:], forces[-1]))
    return replace(state, errors=state.errors._replace(force=max(state.errors.force, float(changes.max()))))


def seconds_per_period(case: MotorCase) -> float:
    """Measured processor time of a drive period of the slider at standstill, s."""
    first = case.run(1.0, 2, None, 0.0)  # which may compile
    return case.run(TIMED, 2, first, 0.0).statistics.loop_s / TIMED


def _window(
    case: MotorCase, speed: float, periods: int, before: Motion | None, last: SteadyState | None
) -> SteadyState:
    """The next window, with the errors of its means; those of the first window are not valid. Raises InputError."""
    run = case.run(periods, BATCHES + 1, before, speed)
    if not run.statistics.finished:
        stopped = run.statistics.stopped
        raise InputError(f"steps_per_period = {case.steps_per_period!r}: the slider {stopped}, give more")
    batches = np.stack([run.friction, run.normal_force, run.contact_fraction, run.stick_fraction], axis=1)[1:]
    assert run.energy is not None
    powers = np.array([run.energy.tangential_work, run.energy.friction_loss]) / run.duration
    slider, means = case.slider, Means(*np.append(batches.mean(axis=0), powers).tolist())
    errors = Means(*6 * [np.inf])
    if last:
        errors = Means(*np.append(batch_error(batches), np.abs(powers - last.means[4:])).tolist())
        if balanced(slider):
            errors = errors._replace(normal_force=abs(means.normal_force - slider.normal_force))
    load, total = max(means.normal_force, slider.normal_force), periods + (last.periods if last else 0)
    fastest = crest_speed(case) + abs(speed)
    relative: dict[Figure, float] = {
        "force": errors.force / (slider.mu * load),
        "normal force": errors.normal_force / load,
        "fractions": max(errors[2:4]),
        "powers": max(errors[4:]) / max(slider.mu * load * fastest, abs(means.surface_power)),
    }
    missing = tuple(name for name, error in relative.items() if error > TOLERANCES[name][total >= CHAOTIC])
    return SteadyState(speed=speed, means=means, errors=errors, periods=total, not_converged=missing, run=run)


def batch_error(batches: Array) -> Array:
    """Error of the mean of batch means (n, k): the larger of twice its standard error and the difference of halves."""
    half = len(batches) // 2
    error = 2.0 * batches.std(axis=0, ddof=1) / np.sqrt(len(batches))
    return np.asarray(np.maximum(error, np.abs(batches[:half].mean(axis=0) - batches[half:].mean(axis=0))))


def balanced(slider: Slider) -> bool:
    """Whether the mean normal force equals the load: neither preload springs nor a second beam."""
    return not slider.preload_stiffness and not any(foot.mirrored for foot in slider.feet)
