"""The driven beam: the motor's figures over sizes, envelopes, ellipses, a map with operating points."""

from typing import TYPE_CHECKING, Annotated

import msgspec

from verify.checks import Relative, check_number
from verify.errors import InputError, WindowError
from verify.models.catalogue import MODELS, discrete
from verify.models.naming import Among, model_meta
from verify.studies.convergence import Counts
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene
    from verify.studies.told import Found
    from verify.studies.wave_figures import WaveFound


class Wave(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the driven beam: the motor's figures over sizes, envelopes, ellipses, a map with operating points."""

    count: Annotated[int, msgspec.Meta(ge=1)] = 49
    """Segments and elements of the envelopes and, with `model`, of the map."""
    counts: Counts = (49, 98, 196)
    """Segments and elements of the motor's figures."""
    model: Annotated[str, model_meta("of the map", "solve_harmonic")] = "segment"
    quantity: str = "wave.standing_wave_ratio"
    """What the map shows."""
    frequency_hz: tuple[float, float, int] | None = None
    """Start, end and steps of the map; a tenth below and above the scene's drive unless given."""
    phase_deg: tuple[float, float, int] = (0.0, 180.0, 91)
    """Start, end and steps of the map, degrees between the two forces."""
    reflection_limit: Relative = 0.1
    """Largest reflection, relative, that an operating point may have."""
    operating_loss_factor: Relative = 1e-3
    """For the operating points where the beam is undamped: without losses the crest speed has no bound."""

    def __post_init__(self) -> None:
        spans = {"frequency_hz": self.frequency_hz, "phase_deg": self.phase_deg}
        for name, span in spans.items():
            if span is None:
                continue
            start, end, steps = span
            check_number(f"wave.{name}[0]", start, "start of the map", above=0 if name == "frequency_hz" else -3600)
            check_number(f"wave.{name}[1]", end, "end of the map", above=start)
            check_number(f"wave.{name}[2]", steps, "steps of the map", above=1, below=2001)
        check_number("wave.reflection_limit", self.reflection_limit, "relative", above=0, below=1)
        check_number("wave.operating_loss_factor", self.operating_loss_factor, "eta", above=0, below=1)


MAP_STEPS = 121
SPREAD = 0.1
"""Of the drive's frequency, below and above it, that a map covers unless it is told."""


def around(drive_hz: float, steps: int) -> tuple[float, float, int]:
    """Start, end and steps of the frequencies about a drive's."""
    return (1.0 - SPREAD) * drive_hz, (1.0 + SPREAD) * drive_hz, steps


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
        from verify.studies.wave_figures import wave_study

        self.check_run(asked, scene)
        return wave_study(scene, bench, asked, step)
