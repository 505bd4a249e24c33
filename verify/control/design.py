"""The loop of a controlled motor: gains by the magnitude optimum, and the motor as linear, averaged and full plant."""

from collections.abc import Callable
from math import pi
from typing import Annotated, Any, Literal, NamedTuple

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.control import plants
from verify.control.controller import Controller, magnitude_optimum
from verify.errors import InputError
from verify.motor.steady_state import MotorCase
from verify.validation import unit

PLANTS = "plant: linearised at the target, averaged over a drive period, or beam and slider in full"
OUTPUT = "command: factor of all forces, or phase of the last one, degrees"


class Loop(NamedTuple):
    """A controller, and its motor as every plant: linear, averaged, full."""

    controller: Controller
    plants: dict[str, Any]
    command: float  # steady, before the step
    times: tuple[float, float]  # time constants of motor and envelope, s
    map_error: float  # of the interpolated force at the target, as a fraction of the speed


class LoopOptions(msgspec.Struct, frozen=True, kw_only=True):
    """Step of the target, controller, plant and sampling."""

    target: Annotated[float, Meta(description="speed, m/s, or position from the start, m")]
    of: Annotated[Literal["speed", "position"], Meta(description="controlled variable")] = "speed"
    speed: Annotated[float, unit("m/s"), Meta(description="steady speed before the step, m/s")] = 0.0
    plant: Annotated[Literal["linear", "averaged", "full"], Meta(description=PLANTS)] = "averaged"
    output: Annotated[Literal["amplitude", "phase"], Meta(description=OUTPUT)] = "amplitude"
    lower: Annotated[float, Meta(description="least command, above 0 for an amplitude")] = 0.1
    upper: Annotated[float, Meta(description="largest command")] = 1.5
    gain: Annotated[float, Meta(description="K_p; default: magnitude optimum")] | None = None
    integral_gain: Annotated[float, Meta(description="K_i, 1/s; default: magnitude optimum")] | None = None
    feed_forward: Annotated[bool, Meta(description="whether the steady command of the target is added")] = False
    sample_time: Annotated[float, unit("s", gt=0), Meta(description="s; default: 8 drive periods")] | None = None
    delay: Annotated[int, Meta(ge=0, description="computational delay, ticks")] = 0
    duration: Annotated[float, unit("s", gt=0), Meta(description="s; default: 30 ticks and envelopes")] | None = None
    speeds: Annotated[int, Meta(ge=4, le=101, description="points of every force-speed curve")] = 13
    curves: Annotated[int, Meta(ge=2, le=51, description="number of force-speed curves over the command")] = 7

    def loop_on(self, case: MotorCase, force_map: Callable[..., plants.Force] = plants.force_map) -> Loop:
        """The loop on a motor; gains by default of the magnitude optimum at the target. Raises InputError."""
        if self.of == "position" and self.output == "amplitude":
            raise InputError("output = 'amplitude': a position loop reverses the motor, give output = 'phase'")
        if self.target == (self.speed if self.of == "speed" else 0.0):
            raise InputError(f"target = {self.target!r}: the motor starts there, give another")
        slider, hertz = case.slider, case.frequency_hz
        damping = 0.5 * case.beam.loss_factor if case.modal_damping is None else case.modal_damping
        if not damping:
            raise InputError("beam.loss_factor = 0: a controlled motor has a damped beam, give it or modal_damping")
        point = replace(case, slider=replace(slider, coupling="one-way")) if slider.contact is None else case
        limits, envelope = (self.lower, self.upper), 1.0 / (damping * 2.0 * pi * hertz)
        force = force_map(point, limits, self.output, (self.curves, self.speeds))
        averaged = plants.AveragedMotor(mass=slider.mass, force=force, time_constant=envelope)
        full = plants.FullMotor(case=replace(case, start="rest"), output=self.output, settling=8.0 * envelope)

        def command_at(speed: float) -> float:
            return averaged.command_at(speed, *limits)

        speed = self.target if self.of == "speed" else 0.0
        if not self.lower < (command := command_at(speed)) < self.upper:
            raise InputError(
                f"target = {self.target!r}: no command from {self.lower!r} to {self.upper!r} holds this speed, give "
                "one of the sign of wave.crest_speed and below its size, or wider limits"
            )
        linear, plant_gain, motor = averaged.linearised(speed, command)
        tick = self.sample_time or 8.0 / hertz
        if self.plant == "full" and abs(tick * hertz - max(round(tick * hertz), 1)) > 1e-6:
            raise InputError(
                f"sample_time = {tick!r}: give whole drive periods, over which the full plant has its speed"
            )
        slow, fast = max(motor, envelope), min(motor, envelope) + (self.delay + 0.5) * tick
        gain, integral_gain = magnitude_optimum(plant_gain, slow, fast)
        controller = Controller(
            gain=gain if self.gain is None else self.gain,
            integral_gain=integral_gain if self.integral_gain is None else self.integral_gain,
            sample_time=tick,
            lower=self.lower,
            upper=self.upper,
            delay=self.delay,
            position_gain=0.25 / fast if self.of == "position" else 0.0,  # damping ratio 1/sqrt(2) about the speed loop
            feed_forward=command_at if self.feed_forward else lambda speed: 0.0,
        )
        direct = plants.mean_force(plants.commanded(point, command, self.output), speed)
        error = abs(direct * motor / (slider.mass * (speed or plant_gain * self.upper)))
        motors = {"linear": linear, "averaged": averaged, "full": full}
        return Loop(controller, motors, command_at(self.speed), (motor, envelope), error)
