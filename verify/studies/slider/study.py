"""The slider of a scene: its run on every model, what bounds it, and run time against error."""

from typing import TYPE_CHECKING

from verify.models.catalogue import discrete
from verify.scenes.claims import asks_for_turned
from verify.scenes.scene import MotionAsk
from verify.studies.kind import Progress, Study
from verify.studies.slider.request import DRIFTS, EXACT, ROUNDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.studies.slider.figures import SliderFound
    from verify.studies.told import Found


MEASURED = (
    "leave [motion] out, whose runs are measured against that beam, and ask for slider.displacement with model = 'fem' "
    "or 'segment', count and time"
)
"""What a beam in time does that the exact model does not move."""


class SliderStudy(Study[MotionAsk, "SliderFound"]):
    """What [motion] asks for where the scene has a slider; without one it says how long figures in time are."""

    name, work = "motion", "in time"
    slides = True
    title = "The slider"

    def asked(self, scene: "Scene") -> MotionAsk | None:
        """The scene's [motion], where there is a slider to move."""
        return scene.motion if scene.slider is not None and scene.slider.contact is None else None

    def skipped(self, scene: "Scene") -> str:
        """Without [motion], or without a slider."""
        if scene.motion is None:
            return "the scene has no [motion]"
        if scene.slider is not None:
            return "slider.contact lets the slider leave the beam, which [motor] runs; [motion] is of one that stays on"
        return "the scene has no [slider]; its [motion] says how gates and claims in time are run"

    def check_run(self, asked: MotionAsk, scene: "Scene") -> None:
        """Raise InputError for a beam that the exact model does not move in time, or a run that is not begun."""
        from verify.exact.in_time import check_beam
        from verify.models.underfoot import surface_distance_at
        from verify.motion.case import MotionCase

        check_beam(scene.beam, MEASURED)
        if scene.drive is None or scene.slider is None or scene.drive.kind != "force":
            return
        surface_distance_at(scene.beam, scene.slider.start_on(scene.beam))  # which has to be known
        case = MotionCase(
            beam=scene.beam,
            forces=scene.forces,
            frequency_hz=scene.drive.frequency_hz,
            duration=asked.duration,
            model="segment",
            count=asked.count,
            modes=None,
            start=asked.start,
            soft_start_periods=asked.soft_start,
            modal_damping=asked.modal_damping,
        )
        case.check(slider=scene.slider, step=None, steps_per_period=asked.steps_per_period)

    def models(self, asked: MotionAsk, scene: "Scene") -> tuple[str, ...]:
        """All that can."""
        return tuple(model.name for model in discrete("time_basis"))

    def told(self, asked: MotionAsk, scene: "Scene") -> str:
        """On what, and at which sizes."""
        sizes = ", ".join(str(n) for n in asked.counts)
        titles = ", ".join(model.title or model.name for model in discrete("time_basis", scene.beam))
        return f"slider on {titles} and the exact beam, work against error at N = {sizes}"

    def n_steps(self, asked: MotionAsk, scene: "Scene") -> int:
        """A step for each model, for the steady wave, and for each round."""
        return len(discrete("time_basis", scene.beam)) + 1 + 1 + ROUNDS

    def n_motions(self, asked: MotionAsk, scene: "Scene") -> int:
        """Of each model, turned round where a claim asks for it, and what work against error takes."""
        models = len(discrete("time_basis", scene.beam))
        once = (models + 1) * (2 if asks_for_turned(scene.claim) else 1)
        return once + DRIFTS + EXACT + ROUNDS * models * len(set(asked.counts))

    def kernels(self, asked: MotionAsk, scene: "Scene") -> "Iterable[Call]":
        """The slider's, on a beam."""
        from verify.motion import warm

        assert scene.slider is not None
        return warm.on_beam(scene.slider.law, scene.slider.coupling)

    def run(
        self, asked: MotionAsk, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "SliderFound":
        """See `slider_study`."""
        from verify.exact.in_time import check_beam
        from verify.studies.slider.figures import slider_study

        check_beam(scene.beam, MEASURED)
        return slider_study(scene, step)
