"""Quantities of a motor: a slider that may leave the beam, held at a speed, without load, from rest."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
from msgspec import Meta

from verify.errors import InputError
from verify.quantities import options as opt
from verify.quantities.base import Scene, quantity

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Reading
    from verify.motor.result import MotorRun

Periods = Annotated[int, Meta(ge=24, description="of the drive, at most, until the means converge")]
Speed = Annotated[float, Meta(description="of the slider along +x, m/s")]


class MotorOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Model of a motor's beam, and its time steps."""

    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    modal_damping: opt.ModalDamping | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="at least; more where the contact is stiff")] = 61

    def case(self, scene: Scene) -> "MotorCase":
        """The motor of a scene. Raises InputError where the scene has none."""
        from verify.motor.case import MotorCase
        from verify.motor.combine import check_combines

        opt.check_count(self.model, self.count)
        opt.check_forces(scene, "a motor")
        if scene.slider is None or scene.slider.contact is None:
            raise InputError("slider.contact is missing: add [slider] with mass, mu and [slider.contact] to the scene")
        case = MotorCase(
            beam=scene.beam,
            forces=opt.DriveOptions().forces(scene),
            frequency_hz=opt.drive_frequency(scene),
            slider=scene.slider,
            model=self.model,
            count=self.count,
            modal_damping=self.modal_damping,
            steps_per_period=self.steps_per_period,
        )
        check_combines(case.model, case.start, case.slider)
        return case


def _held(
    cache: "SolutionCache", case: "MotorCase", speed: float, periods: int, readings: "tuple[Reading, ...]"
) -> "AtSpeed":
    """The motor at a held speed. Raises InputError where one of the readings has not converged."""
    from verify.motor.figures import at_speed

    key = ("held", case, speed, periods)
    if key not in cache.motors:
        cache.motors[key] = at_speed(case, speed, periods=periods)
    found: AtSpeed = cache.motors[key]
    if not found.settled(*readings):
        missing = " and ".join(one for one in readings if one in found.unsettled)
        raise InputError(
            f"periods = {periods!r}: at {speed:.6g} m/s {missing} has not converged (friction {found.force:.4g} +- "
            f"{found.spread:.1g} N), give more periods, slider.contact.damping or slider.preload"
        )
    return found


def _efficiency(found: "AtSpeed") -> float:
    if found.efficiency is None:
        raise InputError(f"speed = {found.speed!r} m/s: no power from the surface to the load, give one between")
    return found.efficiency


HELD: "dict[str, tuple[str, str, Callable[[AtSpeed], float], tuple[Reading, ...]]]" = {
    "force_speed": ("N", "Mean friction force on the slider held at a speed.", lambda at: at.force, ("force",)),
    "power": ("W", "Mean mechanical power of the slider held at a speed.", lambda at: at.power, ("force",)),
    "efficiency": ("1", "That power over the power of the surface along the beam.", _efficiency, ("force", "powers")),
    "normal_mean": ("N", "Mean normal force on the slider.", lambda at: at.normal_force, ("normal force",)),
    "contact_share": ("1", "Share of points and time in contact.", lambda at: at.contact_share, ("shares",)),
    "stuck_share": ("1", "Share of points and time that stick.", lambda at: at.stuck_share, ("shares",)),
    "wear_power": ("W", "Power lost in friction and tangential compliance.", lambda at: at.rubbed, ("powers",)),
}


def _held_figure(read: "Callable[[AtSpeed], float]", readings: "tuple[Reading, ...]") -> Callable[..., float]:
    def held_figure(
        scene: Scene, cache: "SolutionCache", motor: MotorOptions, *, speed: Speed = 0.0, periods: Periods = 46_080
    ) -> float:
        return read(_held(cache, motor.case(scene), speed, periods, readings))

    return held_figure


for _name, (_unit, _text, _read, _readings) in HELD.items():
    quantity(f"slider.{_name}", unit=_unit, summary=_text)(_held_figure(_read, _readings))


@quantity("slider.stall_force", unit="N")
def stall_force(scene: Scene, cache: "SolutionCache", motor: MotorOptions, *, periods: Periods = 46_080) -> float:
    """Mean friction force on the slider held still."""
    return _held(cache, motor.case(scene), 0.0, periods, ("force",)).force


@quantity("slider.no_load_speed", unit="m/s")
def no_load_speed(scene: Scene, motor: MotorOptions, *, periods: Periods = 46_080) -> float:
    """Speed along +x at which the mean friction force on the slider vanishes."""
    from verify.motor.figures import no_load

    return no_load(motor.case(scene), periods=periods).speed


class FreeRun(MotorOptions, frozen=True, kw_only=True):
    """The slider free, from rest."""

    periods: Annotated[int, Meta(ge=2, description="of the drive")] = 2000

    def run(self, scene: Scene, cache: "SolutionCache") -> "MotorRun":
        """The run, sampled once a period. Raises InputError where it stops before its end."""
        case = self.case(scene)
        key = ("free", case, self.periods)
        if key not in cache.motors:
            cache.motors[key] = case.run(self.periods * case.period, samples=self.periods + 1)
        run: MotorRun = cache.motors[key]
        if run.statistics.interrupted:
            raise KeyboardInterrupt
        if not run.statistics.finished:
            raise InputError(
                f"periods = {self.periods!r}: the slider {run.statistics.stopped} after {run.state.time:.6g} s, give "
                "fewer, or another slider.position"
            )
        return run


class FreeSpeed(FreeRun, frozen=True, kw_only=True):
    """Its speed at the end."""

    last: Annotated[int, Meta(ge=2, description="periods of the mean at the end")] = 200

    def speed(self, scene: Scene, cache: "SolutionCache") -> "tuple[MotorRun, float, float]":
        """(run, mean speed at its end, difference of that end's halves). Raises InputError without a steady end."""
        from verify.motor.figures import comes_to_speed, crest_speed, mean_speed

        if self.last >= self.periods:
            raise InputError(f"last = {self.last!r} of periods = {self.periods!r}: give fewer")
        run = self.run(scene, cache)
        speed, spread = mean_speed(run, self.last)
        if not comes_to_speed(run, self.last, crest_speed(self.case(scene))):
            raise InputError(
                f"periods = {self.periods!r} with last = {self.last!r}: the free run has no steady end, the halves of "
                f"its mean {speed:.3g} m/s differ by {spread:.2g} m/s, give more of both, or more slider.preload"
            )
        return run, speed, spread


@quantity("slider.free_speed", unit="m/s")
def free_speed(scene: Scene, cache: "SolutionCache", free: FreeSpeed) -> float:
    """Mean speed of the free slider at the end of a run from rest."""
    return free.speed(scene, cache)[1]


@quantity("slider.start_time", unit="s")
def start_time(scene: Scene, cache: "SolutionCache", free: FreeSpeed) -> float:
    """Time from rest until the free slider has made 1 - 1/e of the change to its final speed."""
    from verify.motor.figures import started_of

    run, speed, spread = free.speed(scene, cache)
    found = started_of(run, speed)
    if found is None or abs(speed - float(run.speed[0])) <= spread:
        raise InputError(
            f"periods = {free.periods!r}: the slider does not get from {run.speed[0]:.6g} to {speed:.6g} m/s, "
            "give more, or slider.speed another value"
        )
    return found


@quantity("slider.contact_imbalance", unit="1")
def contact_imbalance(scene: Scene, cache: "SolutionCache", free: FreeRun) -> float:
    """Residual of the free run's energy balance over the work of the surface."""
    balance: Any = free.run(scene, cache).ledger
    return float(abs(balance.residual) / (abs(balance.across) + abs(balance.along)))
