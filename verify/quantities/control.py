"""The controlled motor of a scene: settings of the loop, and its overshoot."""

from functools import partial

from verify.analysis.solution_cache import SolutionCache
from verify.control import plants
from verify.control.design import Loop, LoopOptions
from verify.control.loop import Response, closed_loop
from verify.errors import InputError
from verify.motor.steady_state import MotorCase
from verify.quantities import options as opt
from verify.quantities.base import Scene, figures


class ControlOptions(LoopOptions, frozen=True, kw_only=True):
    """Step of the target, controller, plant, sampling and model of the beam."""

    model: opt.TimeModel = "segment"
    count: opt.Size | None = None
    modal_damping: opt.ModalDamping | None = None

    def loop(self, scene: Scene, cache: SolutionCache) -> Loop:
        """The loop on a scene; gains by default of the magnitude optimum at the target. Raises InputError."""
        if scene.slider is None:
            raise InputError(
                "slider is missing: a controlled motor has one, add [slider] with mass and mu to the scene"
            )
        opt.check_count(self.model, self.count)
        opt.check_forces(scene, "a controlled motor")
        case = MotorCase(
            beam=scene.beam,
            forces=opt.DriveOptions().forces(scene),
            frequency_hz=opt.drive_frequency(scene),
            slider=scene.slider,
            model=self.model,
            count=self.count,
            modal_damping=self.modal_damping,
        )
        return self.loop_on(case, partial(cache.call, plants.force_map))

    def response(self, scene: Scene, cache: SolutionCache, plant: str = "") -> Response:
        """The response of a plant, by default `plant`, computed once. Raises InputError."""
        plant = plant or self.plant
        options = {name: getattr(self, name) for name in ControlOptions.__struct_fields__} | {"plant": plant}

        def computed() -> Response:
            loop = self.loop(scene, cache)
            duration = self.duration or 30.0 * (loop.times[1] + loop.controller.sample_time)
            start = self.speed, loop.command
            return closed_loop(loop.controller, loop.plants[plant], self.target, duration, start)

        return cache.once(("control", *options.values(), scene.slider, scene.drive), computed)


def response(scene: Scene, cache: SolutionCache, control: ControlOptions) -> Response:
    """The response of a scene's controlled motor. Raises InputError."""
    return control.response(scene, cache)


figure = figures("control", response)
figure(
    "overshoot",
    "1",
    "Overshoot of the controlled slider's speed or position over the step of its target; negative if not reached.",
)
figure(
    "settling_time",
    "s",
    "Time after a step of the target from which the controlled slider stays within 2 % of the step.",
    "settled_after",
)
