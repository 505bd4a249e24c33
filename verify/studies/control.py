"""The controlled motor of a scene: response to a step of the target, linearised, averaged and in full."""

from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from verify.quantities.control import ControlOptions
from verify.studies.base import Progress, Study
from verify.studies.motion import check_driven

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.report.result import Result
    from verify.scene.model import Scene
COLORS = {"linear": "#7d8590", "averaged": "#1f6feb", "full": "#d96c05"}
NOTES = (
    "Linear: about the target, a response without limits in closed form with the sampling as a time constant. "
    "Averaged: force-speed curves and the envelope of one resonance. Full: beam and slider in time, whose envelope "
    "beats at the detuning of its modes and whose speed is a mean over the last drive period.",
)


class Control(ControlOptions, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor whose slider is controlled in speed or position."""

    name: ClassVar[str] = "control"
    title: ClassVar[str] = "The controlled motor"

    def check(self, scene: "Scene") -> None:
        """Raise InputError for a scene without a driven slider."""
        check_driven("control", scene)
        self.check_scene(scene)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Responses of the plants up to the chosen one. Raises InputError."""
        from verify.analysis.margins import beam_margins, marked, run_margins
        from verify.analysis.verdict import Margin, void
        from verify.report.result import Column, Figure, Result
        from verify.studies.charts import percent, plot_lines, si, table

        progress("force over speed and command")
        loop, chosen = self.loop(scene, cache), list(COLORS)[: list(COLORS).index(self.plant) + 1]
        responses = {
            name: loop.response(self, name, lambda part, name=name: progress(f"{name} plant, {100 * part:.0f} %"))
            for name in chosen
        }
        last = responses[self.plant]
