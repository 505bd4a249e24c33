"""The controlled motor of a scene: settings of the loop, its plants, and the overshoot."""

from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING, Annotated, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.errors import InputError
from verify.quantities import options as opt
from verify.quantities.base import Scene, quantity
from verify.quantities.motor import cached
from verify.validation import unit

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.control.controller import Controller
    from verify.control.loop import Response
    from verify.control.plants import AveragedMotor, FullMotor
Time = Annotated[float, unit("s", gt=0)]


class Loop(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A controller with the plants of a motor."""

    controller: "Controller"
    plants: "dict[str, AveragedMotor | FullMotor]"
    """linear (about the target), averaged, full."""
    command: float
    """Steady command before the step."""
    duration: float
    """s."""
    times: tuple[float, float]
    """Time constants of motor and envelope, s."""
    overshoot: float
    """Closed form without limits for K_p/K_i equal to the slower time constant, sampling counted with the faster."""

    def response(
        self, options: "ControlOptions", plant: str, progress: Callable[[float], None] = lambda part: None
    ) -> "Response":
        """The response of one of the plants. Raises InputError."""
        from verify.control.loop import closed_loop

        start = options.speed, self.command
        return closed_loop(self.controller, self.plants[plant], options.target, self.duration, start, progress)


class ControlOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Target, plant, controller and sampling of a motor's control."""

    target: Annotated[float, Meta(description="speed, m/s, or position from the start, m")] = 1.0
    of: Annotated[Literal["speed", "position"], Meta(description="controlled variable")] = "speed"
    plant: Annotated[
        Literal["linear", "averaged", "full"],
        Meta(description="plant: linearised at the target, averaged over a drive period, beam and slider in time"),
    ] = "averaged"
    command: Annotated[
        Literal["amplitude", "phase"], Meta(description="command: factor of all forces, or phase of the last, degrees")
    ] = "amplitude"
    speed: Annotated[float, unit("m/s"), Meta(description="steady speed before the step, m/s")] = 0.0
    gain: Annotated[float, Meta(description="K_p; default: magnitude optimum")] | None = None
    integral_gain: Annotated[float, Meta(description="K_i, 1/s; default: magnitude optimum")] | None = None
    feed_forward: Annotated[bool, Meta(description="whether the no-load command of the target is added")] = False
    sample_time: Annotated[Time, Meta(description="s; default: 8 drive periods")] | None = None
    delay: Annotated[int, Meta(ge=0, description="computational delay, ticks")] = 0
    saturation: (
        Annotated[tuple[float, float], Meta(description="limits of the command; default: 0.1, 1.5 or -90, 90 degrees")]
        | None
    ) = None
    duration: Annotated[Time, Meta(description="s; default: 30 of the shorter time constants")] | None = None
    speeds: Annotated[int, Meta(ge=4, le=101, description="points of the force-speed curves")] = 13
    commands: Annotated[int, Meta(ge=2, le=51, description="number of force-speed curves")] = 4
    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    modal_damping: opt.ModalDamping | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="least number of time steps")] = 61

    def loop(self, scene: Scene, cache: "SolutionCache") -> Loop:
        """The loop on a scene; gains, where not given, by the magnitude optimum at the target. Raises InputError."""
        from verify.control import plants
        from verify.control.controller import Controller, damping_ratio, magnitude_optimum, step_overshoot
        from verify.motor.steady_state import MotorCase

        opt.check_count(self.model, self.count)
        opt.check_forces(scene, "a controlled motor")
        if scene.slider is None:
            raise InputError("slider is missing: add [slider] with mass and mu to the scene")
        if self.of == "position" and self.command == "amplitude":
            raise InputError("command = 'amplitude': a position loop reverses the motor, give command = 'phase'")
        if not (damping := self.modal_damping or 0.5 * scene.beam.loss_factor):
            raise InputError("modal_damping: the envelope of an undamped beam has no time constant, give modal_damping")
        hertz, slider = opt.drive_frequency(scene), scene.slider
        settings = {name: getattr(self, name) for name in ("model", "count", "modal_damping", "steps_per_period")}
        forces = opt.DriveOptions().forces(scene)
        case = MotorCase(beam=scene.beam, forces=forces, frequency_hz=hertz, slider=slider, **settings)
        lower, upper = self.saturation or ((-90.0, 90.0) if self.command == "phase" else (0.1, 1.5))
        one_way = replace(case, slider=replace(slider, coupling="one-way")) if slider.contact is None else case
        force = cached(cache, plants.force_map, one_way, lower, upper, self.command, self.speeds, self.commands)
        envelope = 1.0 / (damping * 2.0 * pi * hertz)
        averaged = plants.AveragedMotor(mass=slider.mass, force=force, time_constant=envelope)

        def command_at(speed: float) -> float:
            return averaged.command_at(speed, lower, upper)

        speed = self.target if self.of == "speed" else 0.0
        linear, plant_gain, motor = averaged.linearised(speed, command_at(speed))
        h = self.sample_time or 8.0 / hertz
        slow, fast = max(motor, envelope), min(motor, envelope) + (self.delay + 0.5) * h
        own = magnitude_optimum(plant_gain, slow, fast)
        gains = [mine if mine is not None else best for mine, best in zip((self.gain, self.integral_gain), own, strict=True)]
        controller = Controller(
            gain=gains[0], integral_gain=gains[1], sample_time=h, lower=lower, upper=upper, delay=self.delay,
            position_gain=0.25 / fast if self.of == "position" else 0.0,
            **({"feed_forward": command_at} if self.feed_forward else {}),
        )  # fmt: skip
        full = plants.FullMotor(case=replace(case, start="rest"), kind=self.command, settling=8.0 * envelope)
        return Loop(
            controller=controller,
            plants={"linear": linear, "averaged": averaged, "full": full},
            command=command_at(self.speed),
            duration=self.duration or 30.0 * fast,
            times=(motor, envelope),
            overshoot=step_overshoot(damping_ratio(gains[0] * plant_gain, slow, fast)),
        )


@quantity("control.overshoot", unit="1")
def overshoot(scene: Scene, cache: "SolutionCache", control: ControlOptions) -> float:
    """Overshoot of the controlled slider's speed or position over the step of its target; negative if not reached."""
    return control.loop(scene, cache).response(control, control.plant).overshoot
