"""The driven beam: the motor's figures over sizes, envelopes, ellipses, a map with operating points."""

from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError, WindowError
from verify.models.catalogue import MODELS, discrete
from verify.models.naming import Among
from verify.studies.kind import Progress, Study
from verify.studies.wave.request import Wave

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene
    from verify.studies.told import Found
    from verify.studies.wave.figures import WaveFound


class WaveStudy(Study[Wave, "WaveFound"]):
    """Harmonic fields of every model, and one map."""

    name, section, work = "wave", Wave, "harmonic"
    title = "The driven beam"

    def check_on(self, asked: Wave, scene: "Scene") -> None:
        """Raise InputError for a scene without two forces, or a model of the map that has no fields."""
        if len(scene.forces) != 2:
            raise InputError("wave: the studies of a wave take a [drive] with two forces, add them")
        for verb in ("solve_harmonic", "unit_responses"):
            Among(verb).check(asked.model, "wave.model")

    def check_run(self, asked: Wave, scene: "Scene") -> None:
        """Raise InputError for a beam without waves, forces inside the window, a wave too long or short for it."""
        from verify.waves.measures import middle_half
        from verify.waves.window import check_window

        assert scene.drive is not None
        MODELS["analytic"].check(scene.beam, 1, 0)
        places = [force.position for force in scene.forces]
        try:
            check_window(scene.beam, places, scene.drive.frequency_hz, middle_half(scene.beam))
        except WindowError as error:
            raise WindowError(
                f"wave reads the middle half of the beam, which does not suit it ({error}): leave [wave] out, and ask "
                "for figures by gates with a window of their own"
            ) from None
        bare = msgspec.structs.replace(scene.beam, mass=(), spring=())
        for model in discrete("solve_harmonic", scene.beam) if bare.uniform else ():
            for count in asked.counts:
                model.check_carried(bare, count, scene.drive.frequency_hz)

    def models(self, asked: Wave, scene: "Scene") -> tuple[str, ...]:
        """All that can."""
        return tuple(model.name for model in discrete("solve_harmonic"))

    def told(self, asked: Wave, scene: "Scene") -> str:
        """Sizes."""
        sizes = ", ".join(str(n) for n in asked.counts)
        titles = " and ".join(model.title or model.name for model in discrete("solve_harmonic", scene.beam))
        return f"harmonic fields of {titles} at N = {sizes}, one map"

    def n_steps(self, asked: Wave, scene: "Scene") -> int:
        """A step for each model at each size, and the map."""
        return len(discrete("solve_harmonic", scene.beam)) * len(asked.counts) + 1

    def run(
        self, asked: Wave, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "WaveFound":
        """See `wave_study`."""
        from verify.studies.wave.figures import wave_study

        self.check_run(asked, scene)
        return wave_study(scene, bench, asked, step)
