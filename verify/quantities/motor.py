"""Quantities of a motor: a slider that may leave the beam, held at a speed, without load, from rest."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.errors import InputError
from verify.quantities import options as opt
from verify.quantities.base import Scene, quantity
from verify.quantities.slider import SliderValues, changed_slider
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.judge.cache import SolutionCache
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Reading
    from verify.motor.result import MotorRun

Periods = Annotated[int, Meta(ge=24, description="of the drive, at most, until the means converge")]
Speed = Annotated[float, Meta(description="of the slider along +x, m/s")]


class MotorOptions(opt.DriveOptions, frozen=True, kw_only=True):
    """Drive and model of a motor's steady beam."""

    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    force: opt.ForceAmplitude | None = None
    modal_damping: opt.ModalDamping | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="at least; more where the contact is stiff")] = 61


class FeetOptions(SliderValues, frozen=True, kw_only=True):
    """The slider of a motor and its feet, by default the scene's."""

    stiffness: Annotated[float, Meta(gt=0, description="of each foot's contact, N/m")] | None = None
    damping: Annotated[float, Meta(ge=0, description="of each foot's contact, N s/m")] | None = None
    tangential_stiffness: Annotated[float, Meta(gt=0, description="of each foot's contact, N/m")] | None = None
    restitution: Annotated[float, Meta(ge=0, le=1, description="of a hard contact")] | None = None
    points: Annotated[int, Meta(ge=1, description="of every foot")] | None = None
    foot_length: Annotated[float, Meta(gt=0, description="of every foot, m")] | None = None

    def of(self, scene: Scene) -> Slider:
        """The scene's slider with these values. Raises InputError where there is none, or one without contact."""
        if scene.slider is None or (contact := scene.slider.contact) is None:
            raise InputError("slider.contact is missing: add [slider] with mass, mu and [slider.contact] to the scene")
        given = {name: value for name, value in msgspec.structs.asdict(self).items() if value is not None}
        feet, names = scene.slider.foot, ("stiffness", "damping", "tangential_stiffness", "restitution")
        contact = replace(contact, **{name: given.pop(name) for name in names if name in given})
        if shape := {name: given.pop(key) for name, key in FOOT.items() if key in given}:
            feet = tuple(replace(foot, **shape) for foot in scene.slider.feet)
        layered = contact.layer_stiffness is not None or contact.layer_tangential_stiffness is not None
        if self.foot_length is not None and (contact.hard or (not layered and any(foot.points == 1 for foot in feet))):
            remedy = "leave it out" if contact.hard else "give points as well"
            raise InputError(f"foot_length = {self.foot_length!r} of a foot with one point of contact: {remedy}")
        return changed_slider(replace(scene.slider, contact=contact, foot=feet), given)


FOOT = {"points": "points", "length": "foot_length"}


def motor_case(scene: Scene, motor: MotorOptions, feet: FeetOptions) -> "MotorCase":
    """The motor of a scene with these options. Raises InputError."""
    from verify.motor.case import MotorCase
    from verify.motor.combine import check_combines

    opt.check_count(motor.model, motor.count)
    opt.check_forces(scene, "a motor")
    case = MotorCase(
        beam=scene.beam,
        forces=motor.forces(scene, motor.force),
        frequency_hz=motor.frequency(scene),
        slider=feet.of(scene),
        model=motor.model,
        count=motor.count,
        modal_damping=motor.modal_damping,
        steps_per_period=motor.steps_per_period,
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
        scene: Scene,
        cache: "SolutionCache",
        motor: MotorOptions,
        feet: FeetOptions,
        *,
        speed: Speed = 0.0,
        periods: Periods = 46_080,
    ) -> float:
        return read(_held(cache, motor_case(scene, motor, feet), speed, periods, readings))

    return held_figure


for _name, (_unit, _text, _read, _readings) in HELD.items():
    quantity(f"slider.{_name}", unit=_unit, summary=_text)(_held_figure(_read, _readings))


@quantity("slider.stall_force", unit="N")
def stall_force(
    scene: Scene, cache: "SolutionCache", motor: MotorOptions, feet: FeetOptions, *, periods: Periods = 46_080
) -> float:
    """Mean friction force on the slider held still."""
    return _held(cache, motor_case(scene, motor, feet), 0.0, periods, ("force",)).force


@quantity("slider.no_load_speed", unit="m/s")
def no_load_speed(scene: Scene, motor: MotorOptions, feet: FeetOptions, *, periods: Periods = 46_080) -> float:
    """Speed along +x at which the mean friction force on the slider vanishes."""
    from verify.motor.figures import no_load

    return no_load(motor_case(scene, motor, feet), periods=periods).speed


class FreeRun(msgspec.Struct, frozen=True, kw_only=True):
    """The slider free, from rest."""

    periods: Annotated[int, Meta(ge=2, description="of the drive")] = 2000
    pull: Annotated[float, Meta(description="external force on the slider along +x, N")] | None = None

    def run(self, cache: "SolutionCache", case: "MotorCase") -> "MotorRun":
        """The run, sampled once a period. Raises InputError where it stops before its end."""
        key = ("free", case, self.periods)
        if key not in cache.motors:
            cache.motors[key] = case.run(self.periods * case.period, samples=self.periods + 1)
        run: MotorRun = cache.motors[key]
        if run.statistics.interrupted:
            raise KeyboardInterrupt
        if not run.statistics.finished:
            raise InputError(
                f"periods = {self.periods!r}: the slider {run.statistics.stopped} after {run.state.time:.6g} s, give "
                "fewer, or another slider_position"
            )
        return run

    def case(self, scene: Scene, motor: MotorOptions, feet: FeetOptions) -> "MotorCase":
        """The motor with this external force."""
        case = motor_case(scene, motor, feet)
        return case if self.pull is None else replace(case, slider=replace(case.slider, pull=self.pull))


Last = Annotated[int, Meta(ge=2, description="periods of the mean at the end")]


def _free_speed(cache: "SolutionCache", case: "MotorCase", free: FreeRun, last: int) -> "tuple[MotorRun, float, float]":
    """(run, mean speed at its end, difference of that end's halves). Raises InputError without a steady end."""
    from verify.motor.figures import comes_to_speed, crest_speed, mean_speed

    if last >= free.periods:
        raise InputError(f"last = {last!r} of periods = {free.periods!r}: give fewer")
    run = free.run(cache, case)
    speed, spread = mean_speed(run, last)
    if not comes_to_speed(run, last, crest_speed(case)):
        raise InputError(
            f"periods = {free.periods!r} with last = {last!r}: the free run has no steady end, the halves of its mean "
            f"{speed:.3g} m/s differ by {spread:.2g} m/s, give more of both, or more slider.preload"
        )
    return run, speed, spread


@quantity("slider.free_speed", unit="m/s")
def free_speed(
    scene: Scene, cache: "SolutionCache", motor: MotorOptions, feet: FeetOptions, free: FreeRun, *, last: Last = 200
) -> float:
    """Mean speed of the free slider at the end of a run from rest."""
    return _free_speed(cache, free.case(scene, motor, feet), free, last)[1]


@quantity("slider.start_time", unit="s")
def start_time(
    scene: Scene, cache: "SolutionCache", motor: MotorOptions, feet: FeetOptions, free: FreeRun, *, last: Last = 200
) -> float:
    """Time from rest until the free slider has made 1 - 1/e of the change to its final speed."""
    from verify.motor.figures import started_of

    run, speed, spread = _free_speed(cache, free.case(scene, motor, feet), free, last)
    if abs(speed - float(run.speed[0])) <= spread:
        raise InputError(
            f"periods = {free.periods!r}: the speed at the start, {run.speed[0]:.6g} m/s, equals that at the end "
            f"within {spread:.2g} m/s, give slider.speed another value"
        )
    found = started_of(run, speed)
    if found is None:
        raise InputError(f"periods = {free.periods!r}: the slider does not reach its speed in these, give more")
    return found


@quantity("slider.contact_imbalance", unit="1")
def contact_imbalance(
    scene: Scene, cache: "SolutionCache", motor: MotorOptions, feet: FeetOptions, free: FreeRun
) -> float:
    """Residual of the free run's energy balance over the work of the surface."""
    balance: Any = free.run(cache, free.case(scene, motor, feet)).ledger
    return float(abs(balance.residual) / (abs(balance.across) + abs(balance.along)))
