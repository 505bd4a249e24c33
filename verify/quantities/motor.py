"""Quantities of a motor: a slider with unilateral contact, at a prescribed speed or free."""

from collections.abc import Callable
from typing import Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.formatting import with_error, with_unit
from verify.motor.curves import REASONS, Transient, no_load, transient
from verify.motor.periodic_orbit import periodic_orbit
from verify.motor.steady_state import Figure, MotorCase, SteadyState, steady_state
from verify.quantities import options as opt
from verify.quantities.base import Estimate, Scene, quantity
from verify.validation import unit

Speed = Annotated[float, unit("m/s"), Meta(description="prescribed speed of the slider along +x, m/s")]


class MotorOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Beam model and time steps of a motor."""

    accepts: ClassVar[tuple[str, ...]] = ("drive.shunt",)
    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    theory: opt.TimeTheory = "euler-bernoulli"
    modal_damping: opt.ModalDamping | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="least number; stiff contact takes more")] = 61

    def case(self, scene: Scene) -> MotorCase:
        """The motor of a scene. Raises InputError where the scene has none."""
        opt.check_count(self.model, self.count)
        opt.check_theory("a motor", self.theory)
        if scene.slider is None or scene.slider.contact is None:
            raise InputError("slider.contact is missing: add [slider] with mass, mu and [slider.contact] to the scene")
        settings = {name: getattr(self, name) for name in MotorOptions.__struct_fields__ if name != "theory"}
        hertz = opt.drive_frequency(scene)
        there = scene.in_time(opt.DriveOptions().forces(scene), hertz)
        settings |= {"slider": scene.slider, "circuits": there.circuits}
        return MotorCase(beam=there.beam, forces=there.loads, frequency_hz=hertz, **settings)


def cached(cache: SolutionCache, function: Callable[..., Any], *arguments: Any) -> Any:
    """The value of a function, computed once for equal arguments."""
    key = (function, *arguments)
    if key not in cache.motors:
        cache.motors[key] = function(*arguments)
    return cache.motors[key]


class Prescribed(MotorOptions, frozen=True, kw_only=True):
    """A slider at a prescribed speed and a fixed position."""

    periods: Annotated[int, Meta(ge=96, description="most drive periods until the means converge")] = 12_500

    def state(self, scene: Scene, cache: SolutionCache, speed: float, *figures: "Figure") -> SteadyState:
        """Steady state at a speed, m/s. Raises InputError where one of `figures` has not converged."""
        state: SteadyState = cached(cache, steady_state, self.case(scene), speed, self.periods)
        if missing := next((name for name in figures if not state.converged(name)), None):
            raise InputError(f"periods = {self.periods!r}: {REASONS[missing]}")
        return state


def _at_speed(
    name: str, unit: str, summary: str, read: "Callable[[SteadyState], float | None]", *figures: "Figure"
) -> None:
    """Register a quantity of the slider at a prescribed speed."""

    @quantity(f"motor.{name}", unit=unit, summary=f"{summary} at a prescribed speed.")
    def at_speed(scene: Scene, cache: SolutionCache, motor: Prescribed, *, speed: Speed = 0.0) -> float:
        value = read(motor.state(scene, cache, speed, *figures))
        if value is None:
            raise InputError(f"speed = {speed!r} m/s: {REASONS[name]}")
        return value


def _mean(name: str) -> "Callable[[SteadyState], float]":
    return lambda at: Estimate(getattr(at.means, name), getattr(at.errors, name))


def _power(at: SteadyState) -> float:
    return Estimate(at.power, abs(at.speed) * at.errors.force)


_at_speed("force_speed", "N", "Mean friction force on the slider", _mean("force"), "force")
_at_speed("power", "W", "Mean mechanical power on the slider", _power, "force")
_at_speed("efficiency", "1", "Power over tangential surface power", lambda at: at.efficiency, "force", "powers")
_at_speed("normal_mean", "N", "Mean normal force on the slider", _mean("normal_force"), "normal force")
for _one in ("contact", "stick"):
    _name = f"{_one}_fraction"
    _at_speed(_name, "1", f"Fraction of points and time in {_one}", _mean(_name), "fractions")
_at_speed("friction_power", "W", "Power lost in friction and compliance", _mean("friction_power"), "powers")


@quantity("motor.stall_force", unit="N")
def stall_force(scene: Scene, cache: SolutionCache, motor: Prescribed) -> float:
    """Mean friction force on the slider at standstill."""
    return _mean("force")(motor.state(scene, cache, 0.0, "force"))


@quantity("motor.no_load_speed", unit="m/s")
def no_load_speed(scene: Scene, cache: SolutionCache, motor: Prescribed) -> float:
    """No-load speed along +x of a heavy slider: the prescribed speed at which the mean friction force vanishes."""
    return float(cached(cache, no_load, motor.case(scene), motor.periods).speed)


class FreeRun(MotorOptions, frozen=True, kw_only=True):
    """A free slider that starts with `slider.speed` on the steady beam."""

    periods: Annotated[int, Meta(ge=2, description="number of drive periods")] = 2000

    def run(self, scene: Scene, cache: SolutionCache) -> Transient:
        """The free run. Raises InputError where the slider leaves the beam."""
        free: Transient = cached(cache, transient, self.case(scene), self.periods)
        if not free.run.statistics.finished:
            raise InputError(f"periods = {self.periods!r}: {REASONS['left']}")
        return free

    def check(self, free: Transient) -> None:
        """Raise InputError, with the mean and its error, where a run has reached no steady state."""
        if not free.converged:
            last = with_error(1e3 * free.speed, 1e3 * free.error)
            raise InputError(f"periods = {self.periods!r}: {REASONS['free speed']} (last quarter: {last} mm/s)")


@quantity("motor.free_speed", unit="m/s")
def free_speed(scene: Scene, cache: SolutionCache, motor: FreeRun) -> float:
    """Mean speed of the free slider over the last quarter of a run; a light slider varies within a drive period."""
    free = motor.run(scene, cache)
    motor.check(free)
    return Estimate(free.speed, free.error)


@quantity("motor.start_time", unit="s")
def start_time(scene: Scene, cache: SolutionCache, motor: FreeRun) -> float:
    """Time constant of the free slider's start: 1 - 1/e of the change to its final mean speed, without overshoot."""
    free = motor.run(scene, cache)
    start = free.time_constant()
    if start.missing == "overshoot":
        peak, there = with_unit(start.peak, "m/s"), with_unit(start.peak_time, "s")
        course = f"reaches {peak} (1 - 1/e of the change at {there}), then returns to {with_unit(free.speed, 'm/s')}"
        raise InputError(f"periods = {motor.periods!r}: {REASONS['overshoot']} (it {course})")
    motor.check(free)
    if start.missing == "resolution":
        half, mass = with_unit(float(free.times[0]), "s"), motor.case(scene).slider.mass
        raise InputError(f"slider.mass = {mass!r} kg: {REASONS['resolution']} ({half})")
    if start.missing:
        raise InputError(f"periods = {motor.periods!r}: {REASONS['start']}")
    return Estimate(start.time, start.error)


@quantity("motor.multiplier", unit="1")
def multiplier(scene: Scene, cache: SolutionCache, motor: MotorOptions, *, speed: Speed = 0.0) -> float:
    """Largest Floquet multiplier of the periodic motion at a prescribed speed; stable below 1."""
    return float(max(abs(cached(cache, periodic_orbit, motor.case(scene), speed).multipliers)))


@quantity("motor.contact_imbalance", unit="1")
def contact_imbalance(scene: Scene, motor: FreeRun) -> float:
    """Residual of the free slider's energy balance, over the work of the surface."""
    balance = motor.case(scene).run(motor.periods, 2).energy
    assert balance is not None
    return float(abs(balance.residual) / (abs(balance.normal_work) + abs(balance.tangential_work)))
