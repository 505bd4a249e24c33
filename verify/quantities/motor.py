"""Quantities of a motor: a slider with unilateral contact, at a prescribed speed or free."""

from operator import methodcaller
from typing import Annotated, ClassVar

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.motor.curves import no_load, transient
from verify.motor.periodic_orbit import periodic_orbit
from verify.motor.steady_state import MotorCase, SteadyState, steady_state
from verify.quantities import options as opt
from verify.quantities.base import Scene, figures, quantity
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
        loaded = scene.in_time(opt.DriveOptions().forces(scene), hertz)
        settings |= {"slider": scene.slider, "circuits": loaded.circuits}
        return MotorCase(beam=loaded.beam, forces=loaded.loads, frequency_hz=hertz, **settings)


class Prescribed(MotorOptions, frozen=True, kw_only=True):
    """A slider at a prescribed speed and a fixed position."""

    periods: Annotated[int, Meta(ge=96, description="most drive periods until the means converge")] = 12_500


def at_speed(scene: Scene, cache: SolutionCache, motor: Prescribed, *, speed: Speed = 0.0) -> SteadyState:
    """The motor at a prescribed speed. Raises InputError."""
    return cache.call(steady_state, motor.case(scene), speed, motor.periods)


for _name, _unit, _summary, _figure in (
    ("force_speed", "N", "Mean friction force on the slider", "force"),
    ("power", "W", "Mean mechanical power on the slider", "power"),
    ("efficiency", "1", "Power over tangential surface power", "efficiency"),
    ("normal_mean", "N", "Mean normal force on the slider", "normal_force"),
    ("contact_fraction", "1", "Fraction of points and time in contact", "contact_fraction"),
    ("stick_fraction", "1", "Fraction of points and time in stick", "stick_fraction"),
    ("friction_power", "W", "Power lost in friction and compliance", "friction_power"),
):
    figures("motor", at_speed)(
        _name, _unit, f"{_summary} at a prescribed speed.", read=methodcaller("estimate", _figure)
    )


@quantity("motor.stall_force", unit="N")
def stall_force(scene: Scene, cache: SolutionCache, motor: Prescribed) -> float:
    """Mean friction force on the slider at standstill."""
    return at_speed(scene, cache, motor).estimate("force")


@quantity("motor.no_load_speed", unit="m/s")
def no_load_speed(scene: Scene, cache: SolutionCache, motor: Prescribed) -> float:
    """No-load speed along +x of a heavy slider: the prescribed speed at which the mean friction force vanishes."""
    return cache.call(no_load, motor.case(scene), motor.periods).speed


class FreeRun(MotorOptions, frozen=True, kw_only=True):
    """A free slider that starts with `slider.speed` on the steady beam."""

    periods: Annotated[int, Meta(ge=2, description="number of drive periods")] = 2000


@quantity("motor.free_speed", unit="m/s")
def free_speed(scene: Scene, cache: SolutionCache, motor: FreeRun) -> float:
    """Mean speed of the free slider over the last quarter of a run; a light slider varies within a drive period."""
    return cache.call(transient, motor.case(scene), motor.periods).final_speed


@quantity("motor.start_time", unit="s")
def start_time(scene: Scene, cache: SolutionCache, motor: FreeRun) -> float:
    """Time constant of the free slider's start: 1 - 1/e of the change to its final mean speed, without overshoot."""
    return cache.call(transient, motor.case(scene), motor.periods).start_time


@quantity("motor.multiplier", unit="1")
def multiplier(scene: Scene, cache: SolutionCache, motor: MotorOptions, *, speed: Speed = 0.0) -> float:
    """Largest Floquet multiplier of the periodic motion at a prescribed speed; stable below 1."""
    return cache.call(periodic_orbit, motor.case(scene), speed).largest_multiplier


@quantity("motor.contact_imbalance", unit="1")
def contact_imbalance(scene: Scene, motor: FreeRun) -> float:
    """Residual of the free slider's energy balance, over the work of the surface."""
    balance = motor.case(scene).run(motor.periods, 2).energy
    assert balance is not None
    return balance.contact_imbalance
