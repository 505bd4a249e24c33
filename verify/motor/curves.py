"""Curves of a motor: force over speed, no-load speed, start, stop and reversal.

The no-load speed is that of a heavy slider, with a prescribed speed that is constant within a drive period. That of a
light free slider (`transient`) differs, since its speed varies within the period. Time constants come from means over a
sliding period, which are independent of the phase of the drive at the start.
"""

from collections.abc import Sequence
from math import ceil, e
from typing import Literal

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.arrays import Array
from verify.dynamics.result import Motion
from verify.errors import InputError
from verify.estimate import Estimate
from verify.formatting import one_line, with_error, with_unit
from verify.motor.steady_state import (
    BATCHES,
    PERIODS,
    UNCONVERGED,
    MotorCase,
    SteadyState,
    balanced,
    batch_error,
    crest_speed,
    steady_state,
)

FINE = 32  # Number of periods of a free run with samples at every step; later one sample per period
LEVEL = 1.0 - 1.0 / e  # Fraction of the change after a time constant
STEADY = 0.05
"""Largest error of a free speed, relative to it. A speed and a time constant are specified to some per cent; the error
itself is part of the result. A wave that is partly standing changes the speed by much more in half a wavelength."""
STANDSTILL = 1e-3
"""Largest speed and error, relative to the crest speed, of a slider that stands: zero has no relative error."""
OVERSHOOT = 0.05
"""Excess of the mean speed over the final one, relative to its change, from which the approach has no time constant:
`STEADY`. The mean force at one place depends on the speed alone, dv/dt = F(v)/m, and such an approach is monotone."""
Missing = Literal["start", "overshoot", "resolution"]
REASONS: dict[str, str] = {
    "no load": "mean friction has one sign at all speeds up to twice the crest speed, raise slider.preload",
    "free speed": "the free run has not reached a steady state, raise periods or slider.preload, or lower the "
    "standing-wave ratio along which the slider moves",
    "overshoot": "the mean speed overshoots and has no time constant, lower the standing-wave ratio along which the "
    "slider moves, or raise slider.mass",
    "resolution": "the time constant is below a drive period, half of which is the least that means over a period "
    "resolve, raise slider.mass",
    "start": "the change of speed in the free run is within its error, choose another slider.speed",
    "stop": "the speed does not fall to 1/e after the drive is switched off, raise periods",
    "reversal": "the speed does not change after the phases are reversed, raise periods",
    "ringing": "a two-way coupled beam vibrates after the drive is switched off, choose one-way coupling for stopping",
    "left": "the slider leaves the beam, lower periods or change slider.position",
}
"""Reasons why a result is not available."""


def no_load(case: MotorCase, periods: int = PERIODS, known: Sequence[SteadyState] = ()) -> SteadyState:
    """Steady state at the speed, up to twice the crest speed, at which the mean friction force vanishes.

    `known` are states at other speeds, the first at standstill. The search ends at a force within its error; `speed`
    is an `Estimate` with the error that this leaves. Raises InputError if the force has one sign in that range, or has
    not converged near the root, with the interval of speeds in which it is.
    """
    from scipy.optimize import brentq

    states = {one.speed: one for one in known or [steady_state(case, 0.0, periods)]}
    still = states[0.0]

    def force(speed: float) -> float:
        """Mean friction, N, zero within its error."""
        if speed not in states:
            states[speed] = steady_state(case, speed, periods, still.run, relative=0.01)
        mean, error = states[speed].means.force, states[speed].errors.force
        return mean if abs(mean) > error else 0.0

    def ends() -> tuple[float, float]:
        """The slowest speed with the other sign than at standstill, and the fastest below it with the same, m/s."""
        beyond = min((v for v in states if force(v) * still.means.force < 0.0), key=abs, default=limit)
        return max((v for v in states if abs(v) < abs(beyond) and force(v)), key=abs, default=0.0), beyond

    def inside(speed: float) -> float:
        """The force at a speed of the search, of whose ends the sign is enough."""
        value, state = force(speed), states[speed]
        enough = 0.01 if speed not in bracket else 1.0
        if not state.converged("force") and state.errors.force >= enough * abs(value):
            low, high = sorted(ends())
            between = f"no-load speed so far: {with_unit(low, 'm/s')} to {with_unit(high, 'm/s')}"
            raise InputError(f"periods = {periods!r}: {UNCONVERGED['force']} ({between})")
        return value

    limit = float(np.copysign(2.0 * crest_speed(case), still.means.force))
    bracket = ends()
    if force(bracket[0]) * force(bracket[1]) > 0.0:
        raise InputError(f"slider.preload = {case.slider.preload!r} N: {REASONS['no load']}")
    root = float(brentq(inside, *bracket, xtol=1e-6 * abs(limit)))
    inside(root)
    low, high = ends()
    rise = abs(states[high].means.force - states[low].means.force)
    return replace(states[root], speed=Estimate(root, states[root].errors.force * abs(high - low) / (rise or np.inf)))


class TimeConstant(Struct, frozen=True, kw_only=True):
    """Approach of the mean speed to a final one."""

    time: float
    """From the start of the run to 1 - 1/e of the change, s; infinite where it is not reached."""
    error: float
    """Of `time`, s."""
    peak: float
    """The mean speed farthest beyond the final or the initial one, m/s."""
    peak_time: float
    """To 1 - 1/e of the change to `peak`, s."""
    missing: Missing | None
    """Why the approach has no time constant."""


class Transient(Struct, frozen=True, eq=False, kw_only=True):
    """A free run from an initial speed."""

    case: MotorCase
    periods: int
    """Number of drive periods."""
    run: Motion
    """The motion, in long runs without the first 32 periods."""
    start_speed: float
    """Speed before the run, m/s along +x."""
    times: Array
    """(n,), middles of the sliding periods, s from the start of the run; the first is half a period."""
    speeds: Array
    """(n,), means over these periods, m/s."""
    speed: float
    """Mean of `speeds` over the last quarter, m/s."""
    error: float
    """Error of `speed`, m/s: the largest of `batch_error` and the differences from the means of the two quarters
    before. A slider that wanders along a standing wave may be slow for longer than one quarter."""
    last: int
    """Number of samples of `run` in the last quarter, a multiple of 16."""
    converged: bool
    """Whether the run reached its end with `error` up to 5 % of `speed` (or both up to 0.1 % of the crest speed), mean
    acceleration up to 1 % of mu N / mass and mean normal force within 10 % of the load."""
    __repr__ = one_line(periods="", speed="m/s", error="m/s")

    @property
    def final_speed(self) -> Estimate:
        """`speed` with its error, m/s. Raises InputError where the run leaves the beam or has no steady state."""
        self._check_finished()
        if not self.converged:
            last = with_error(1e3 * self.speed, 1e3 * self.error)
            raise InputError(f"periods = {self.periods!r}: {REASONS['free speed']} (last quarter: {last} mm/s)")
        return Estimate(self.speed, self.error)

    @property
    def start_time(self) -> Estimate:
        """Time constant of the approach to the final speed with its error, s. Raises InputError where it has none."""
        self._check_finished()
        start = self.time_constant()
        if start.missing == "overshoot":
            peak, reached = with_unit(start.peak, "m/s"), with_unit(start.peak_time, "s")
            course = (
                f"reaches {peak} (1 - 1/e of the change at {reached}), then returns to {with_unit(self.speed, 'm/s')}"
            )
            raise InputError(f"periods = {self.periods!r}: {REASONS['overshoot']} (it {course})")
        _ = self.final_speed  # which raises InputError without a steady state
        if start.missing == "resolution":
            half, mass = with_unit(float(self.times[0]), "s"), self.case.slider.mass
            raise InputError(f"slider.mass = {mass!r} kg: {REASONS['resolution']} ({half})")
        if start.missing:
            raise InputError(f"periods = {self.periods!r}: {REASONS['start']}")
        return Estimate(start.time, start.error)

    def _check_finished(self) -> None:
        if not self.run.statistics.finished:
            raise InputError(f"periods = {self.periods!r}: {REASONS['left']}")

    def time_constant(self, target: float | None = None) -> TimeConstant:
        """Time to 1 - 1/e of the change to `target` (m/s, default: the final speed).

        Its error is that of the crossing, under `error` and under the fluctuation of the means in the last quarter, and
        that of means over a period T, T^2/(24 t) in an exponential: 4 % at a period, below which there is no result.
        """
        uncertain = self.error if target is None else 0.0
        target = self.speed if target is None else target
        span, period = target - self.start_speed, 2.0 * float(self.times[0])
        if not span:
            return TimeConstant(time=np.inf, error=np.inf, peak=target, peak_time=np.inf, missing="start")
        change = (self.speeds - self.start_speed) / span
        steady, ends = change[-self.last :], (float(change.min()), float(change.max()))
        band = LEVEL * uncertain / abs(span) + float(steady.std())
        time, early, late = (_first(change, self.times, LEVEL + one) for one in (0.0, -band, band))
        below, above = min(0.0, float(steady.min())) - ends[0], ends[1] - max(1.0, float(steady.max()))
        peak, error = ends[below <= max(above, 0.0)], np.inf
        peak_time = _first(np.sign(peak) * change, self.times, LEVEL * abs(peak))
        excess = max(below, above) * abs(span)
        if time < np.inf:
            late = max([late, *self.times[change < LEVEL][-1:].tolist()])
            error = max(time - early, late - time) + period**2 / (24.0 * time)
        missing: Missing | None = None
        if excess > uncertain + OVERSHOOT * abs(span) and peak_time >= period:
            missing = "overshoot"
        elif abs(span) <= uncertain or time == np.inf:
            missing = "start"
        elif time < period:
            missing = "resolution"
        elif error >= time:
            missing = "start"
        peak = self.start_speed + peak * span
        return TimeConstant(time=time, error=error, peak=peak, peak_time=peak_time, missing=missing)


def _first(change: Array, times: Array, level: float) -> float:
    """Time at which `change` first reaches `level`, at least the first; infinite where it does not."""
    past = np.flatnonzero(change >= level)
    if not len(past):
        return np.inf
    i = max(int(past[0]), 1)
    return float(np.interp(level, change[i - 1 : i + 1], times[i - 1 : i + 1]))


def transient(case: MotorCase, periods: int, before: Transient | None = None) -> Transient:
    """The free slider over `periods` drive periods, from `slider.speed` or from the end of another run.

    Raises InputError where the slider leaves the beam in the first period, or for fewer than 16 means.
    """
    fine = max(FINE, ceil(case.soft_start_periods))
    fine = periods if periods < 2 * fine else fine
    run = case.run(fine, fine * case.steps_per_period + 1, before.run if before else None)
    times, slider = run.times - run.times[0], case.slider
    if times[-1] <= case.period:
        raise InputError(f"slider.position = {slider.initial_position(case.beam):.6g} m: {REASONS['left']}")
    times = times[times <= (1.0 + 1e-9) * (times[-1] - case.period)]
    ends = np.interp(times + case.period, run.times - run.times[0], run.travelled)
    times, speeds = times + 0.5 * case.period, (ends - run.travelled[: len(times)]) / case.period
    if run.statistics.finished and periods > fine:
        begin, rest = run.times[0], periods - fine
        run = replace(case, soft_start_periods=0.0).run(rest, rest + 1, run)
        times = np.append(times, run.times[1:] - begin - 0.5 * case.period)
        speeds = np.append(speeds, np.diff(run.travelled) / np.diff(run.times))
    if len(speeds) < BATCHES:
        raise InputError(f"periods = {periods!r}: {REASONS['free speed' if run.statistics.finished else 'left']}")
    last = max(len(run.times) // (4 * BATCHES), 1) * BATCHES
    batches = speeds[-last:].reshape(BATCHES, -1).mean(axis=1)
    speed, load = float(batches.mean()), slider.normal_force
    quarters = speeds[-2 * last : -last].mean(), speeds[-3 * last : -2 * last].mean()
    error = float(max(batch_error(batches), *(abs(speed - one) for one in quarters)))
    drift = abs(batches[: BATCHES // 2].mean() - batches[BATCHES // 2 :].mean()) / (run.times[-1] - run.times[-last])
    steady = error <= STEADY * abs(speed) or max(error, abs(speed)) <= STANDSTILL * crest_speed(case)
    steady &= 2.0 * slider.mass * drift <= 0.01 * slider.mu * load
    carries = not balanced(slider) or abs(run.normal_force[-last:].mean() - load) <= 0.1 * load
    return Transient(
        case=case,
        periods=periods,
        run=run,
        start_speed=before.speed if before else slider.speed,
        times=times,
        speeds=speeds,
        speed=speed,
        error=error,
        last=last,
        converged=bool(run.statistics.finished and steady and carries),
    )


def stop(case: MotorCase, before: Transient, periods: int) -> Transient:
    """Continue a run with the drive switched off; the field of a one-way coupled steady beam vanishes immediately."""
    forces = tuple(replace(one, amplitude=1e-12 * one.amplitude) for one in case.forces)
    return transient(replace(case, forces=forces), periods, before)


def reversal(case: MotorCase, before: Transient, periods: int) -> Transient:
    """Continue a run with the phases of all forces negated."""
    forces = tuple(replace(one, phase_deg=-one.phase_deg) for one in case.forces)
    return transient(replace(case, forces=forces), periods, before)
