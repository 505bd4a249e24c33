"""Which published claims about a slider hold under which reading of what their source leaves open."""

from typing import TYPE_CHECKING

from verify.scenes.claims import asks_for_turned
from verify.studies.kind import Progress, Study
from verify.studies.readings.request import ReadingsAsk

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.studies.readings.figures import ReadingsFound
    from verify.studies.told import Found


class ReadingsStudy(Study[ReadingsAsk, "ReadingsFound"]):
    """Every combination of the lists, run and held against the claims."""

    name, section, work = "readings", ReadingsAsk, "in time"
    slides = True
    title = "Which reading of the claims fits"
    of_source = True

    def check_on(self, asked: ReadingsAsk, scene: "Scene") -> None:
        """Raise InputError where the scene has nothing to read, or where the search would take too long."""
        asked.check_on(scene)

    def models(self, asked: ReadingsAsk, scene: "Scene") -> tuple[str, ...]:
        """The one of the readings."""
        return (asked.model,)

    def told(self, asked: ReadingsAsk, scene: "Scene") -> str:
        """How many, on what."""
        assert scene.motion is not None
        chain = f" and {asked.n_chain(scene)} on the nonlinear chain" if asked.chain else ""
        return (
            f"{asked.n_readings} readings of the slider{chain}, {asked.n_runs(scene)} runs of {asked.model} "
            f"at N = {asked.count or scene.motion.count} of about {asked.n_steps(scene):.3g} steps, "
            f"{min(asked.shown, asked.n_groups)} on the exact beam beside"
        )

    def n_steps(self, asked: ReadingsAsk, scene: "Scene") -> int:
        """A step for each reading."""
        return asked.n_readings + asked.n_chain(scene) + min(asked.shown, asked.n_groups)

    def n_motions(self, asked: ReadingsAsk, scene: "Scene") -> int:
        """Of each reading, those on the exact beam among them, again where a claim asks for phases turned round."""
        return self.n_steps(asked, scene) * (2 if asks_for_turned(scene.claim) else 1)

    def kernels(self, asked: ReadingsAsk, scene: "Scene") -> "Iterable[Call]":
        """The slider's, on a beam, and on a chain of rigid links where one carries it beside."""
        from verify.chain.warm import rigid
        from verify.motion import warm

        assert scene.slider is not None
        yield from warm.on_beam(scene.slider.law, scene.slider.coupling)
        if asked.chain:
            yield from rigid()
            yield from warm.on_chain(scene.slider.law)

    def run(
        self, asked: ReadingsAsk, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "ReadingsFound":
        """See `readings_study`."""
        from verify.studies.readings.figures import readings_study

        return readings_study(scene, asked, step)
