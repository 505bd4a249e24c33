"""The controlled motor of a scene: response to a step of the target on the linear, the averaged and the full plant."""

from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from verify.quantities.control import ControlOptions
from verify.studies.base import Progress, Study
from verify.studies.motion import check_driven

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.report.result import Result
    from verify.scene.model import Scene
COLOURS = {"linear": "#7d8590", "averaged": "#1f6feb", "full": "#d96c05"}
LIMIT = {"color": "#7d8590", "linestyle": "--", "linewidth": 1.0}
NOTE = (
    "Linear and averaged plant: the wave follows the command with the time constant 2Q/omega of one resonance. Full: "
    "between resonances it beats at the detuning of the modes, and feet take their time to follow it; speed over the "
    "last drive period. Settling: to 2 % of the step. Saturated: fraction of ticks with the command at a limit."
)


class Control(ControlOptions, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor whose slider is controlled in speed or position."""

    name: ClassVar[str] = "control"
    title: ClassVar[str] = "The controlled motor"

    def check(self, scene: "Scene") -> None:
        """Raise InputError without forces."""
        check_driven("control", scene)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """The responses of all plants up to the chosen one. Raises InputError."""
        from verify.analysis.margins import beam_margins, marked, run_margins
        from verify.analysis.verdict import Margin, verdict_of, void
        from verify.report.result import Column, Figure, Result, Table
        from verify.studies.charts import percent, plot_lines, si, sized_title, table

        progress("force over speed and command")
        loop, responses = self.loop(scene, cache), dict[str, Any]()
        for plant in list(COLOURS)[: list(COLOURS).index(self.plant) + 1]:
            progress(f"response of the {plant} plant")
            responses[plant] = self.response(scene, cache, plant)
        last, hertz = responses[self.plant], scene.drive.frequency_hz if scene.drive else 0.0
        assert scene.slider is not None
        steady = loop.plants["full"].start(self.target if self.of == "speed" else 0.0, float(last.command[-1]))
        margins = beam_margins(cache, [(self.model, self.count)], frequency_hz=hertz)
        margins += run_margins(steady, scene.slider, sized_title(self.model, self.count))
        condition, size = "the motor is slow against a drive period", 1.0 / (hertz * min(loop.times))
        margins.append(Margin(name="averaging", size=size, fine=0.1, limit=1.0, condition=condition, is_error=False))
        margins.append(Margin(name="interpolation of the force", size=loop.map_error, remedy="raise control.curves"))
        if self.plant == "full":
            differs = abs(last.overshoot - responses["averaged"].overshoot)
            margins.append(Margin(name="overshoot of the averaged plant", size=differs))
        if last.settling_time is None:
            margins.append(void("the loop", "the response does not settle", "give a longer duration, or smaller gains"))
        results = {
            Column("plant"): lambda row: row[0],
            percent("overshoot", ".4g"): lambda row: row[1].overshoot,
            si("settling time", "s"): lambda row: row[1].settling_time,
            percent("steady error", "+.3g"): lambda row: row[1].steady_error,
            Column("steady command", format=".4g"): lambda row: float(row[1].command[-1]),
            percent("saturated", ".3g"): lambda row: row[1].saturated,
        }
        gains = [Column("law"), Column("K_p"), Column("K_i", "1/s"), si("sample time", "s")]
        gains += [si("motor time constant", "s"), si("envelope time constant", "s")]
        own = loop.controller
        row = ["PI", own.gain, own.integral_gain, own.sample_time, *loop.times]
        what = (self.of, "m" if self.of == "position" else "m/s")
        command = ("phase", "degrees") if self.output == "phase" else ("factor of the amplitudes", "")
        ends = last.times[[0, -1]]
        lines = [("target", ends, 0.0 * ends + self.target, LIMIT)]
        steps = [("", ends, 0.0 * ends + one, LIMIT) for one in (own.lower, own.upper)]
        for name, one in responses.items():
            style = {"color": COLOURS[name], "linewidth": 1.4}
            lines.append((name, one.times, one.controlled, style))
            steps.append((name, one.times[:-1], one.command, style | {"drawstyle": "steps-post"}))
        charts = (what, f"Controlled {self.of}", lines), (command, "Command", steps)
        summary = f"Overshoot {100.0 * last.overshoot:.3g} % on the {self.plant} plant."
        return Result(
            summary=summary if verdict_of(margins).level != "not trusted" else "",
            tables=[table("Step response", responses.items(), results, NOTE), Table("Loop", gains, [row])],
            figures=[
                Figure(f"control-{y[0]}", marked(title, margins), "After a step of the target at time 0.",
                       partial(plot_lines, lines=drawn, x=("time", "s"), y=y))
                for y, title, drawn in charts
            ],
            margins=margins,
        )  # fmt: skip
