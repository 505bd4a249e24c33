"""The controlled motor of a scene: response to a step of the target on the linear, the averaged and the full plant."""

from typing import Any

from verify.analysis.margins import marked
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, verdict_of, void
from verify.quantities.control import ControlOptions
from verify.report.result import Column, Result, Table
from verify.studies.base import Progress, Scene, Study
from verify.studies.charts import Columns, line_chart, percent, si, sized_title, table
from verify.studies.motion import check_driven
from verify.studies.tables import scene_margins

COLOURS = {"linear": "#7d8590", "averaged": "#1f6feb", "full": "#d96c05"}
LIMIT = {"color": "#7d8590", "linestyle": "--", "linewidth": 1.0}
LOOP = [Column("law"), Column("K_p"), Column("K_i", "1/s"), si("sample time", "s")]
LOOP += [si("motor time constant", "s"), si("envelope time constant", "s")]
RESPONSE: Columns = {
    Column("plant"): lambda row: row[0],
    percent("overshoot", ".4g"): lambda row: row[1].overshoot,
    si("settling time", "s"): lambda row: row[1].settling_time,
    percent("steady error", "+.3g"): lambda row: row[1].steady_error,
    Column("steady command", format=".4g"): lambda row: float(row[1].command[-1]),
    percent("saturated", ".3g"): lambda row: row[1].saturated,
}
NOTE = (
    "Linear and averaged plant: the wave follows the command with the time constant 2Q/omega of one resonance. Full: "
    "between resonances it beats at the detuning of the modes, and feet take their time to follow it; speed over the "
    "last drive period. Settling: to 2 % of the step. Saturated: fraction of ticks with the command at a limit."
)


class Control(ControlOptions, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor whose slider is controlled in speed or position."""

    name, title = "control", "The controlled motor"
    reads = ("drive", "slider", "motion")

    def check(self, scene: Scene) -> None:
        """Raise InputError without forces."""
        check_driven("control", scene)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """The responses of all plants up to the chosen one. Raises InputError."""
        progress("force over speed and command")
        loop, responses = self.loop(scene, cache), dict[str, Any]()
        for plant in list(COLOURS)[: list(COLOURS).index(self.plant) + 1]:
            progress(f"response of the {plant} plant")
            responses[plant] = self.response(scene, cache, plant)
        last, hertz = responses[self.plant], scene.drive.frequency_hz if scene.drive else 0.0
        assert scene.slider is not None
        steady = loop.plants["full"].start(self.target if self.of == "speed" else 0.0, float(last.command[-1]))
        sizes, runs = [(self.model, self.count)], [(sized_title(self.model, self.count), steady)]
        margins = scene_margins(scene, cache, sizes, slider=scene.slider, frequency_hz=hertz, runs=runs)
        condition, size = "the motor is slow against a drive period", 1.0 / (hertz * min(loop.times))
        margins.append(Margin(name="averaging", size=size, fine=0.1, limit=1.0, condition=condition, is_error=False))
        margins.append(Margin(name="interpolation of the force", size=loop.map_error, remedy="raise control.curves"))
        if self.plant == "full":
            differs = abs(last.overshoot - responses["averaged"].overshoot)
            margins.append(Margin(name="overshoot of the averaged plant", size=differs))
        if last.settling_time is None:
            margins.append(void("the loop", "the response does not settle", "give a longer duration, or smaller gains"))
        law, ends = loop.controller, last.times[[0, -1]]
        gains = ["PI", law.gain, law.integral_gain, law.sample_time, *loop.times]
        lines = [("target", ends, 0.0 * ends + self.target, LIMIT)]
        steps = [("", ends, 0.0 * ends + limit, LIMIT) for limit in (law.lower, law.upper)]
        for name, response in responses.items():
            style = {"color": COLOURS[name], "linewidth": 1.4}
            lines.append((name, response.times, response.controlled, style))
            steps.append((name, response.times[:-1], response.command, style | {"drawstyle": "steps-post"}))
        controlled = (self.of, "m" if self.of == "position" else "m/s")
        command = ("phase", "degrees") if self.output == "phase" else ("factor of the amplitudes", "")
        charts = (controlled, f"Controlled {self.of}", lines), (command, "Command", steps)
        caption, valid = "After a step of the target at time 0.", verdict_of(margins).level != "not trusted"
        return Result(
            summary=f"Overshoot {100.0 * last.overshoot:.3g} % on the {self.plant} plant." if valid else "",
            tables=[table("Step response", responses.items(), RESPONSE, NOTE), Table("Loop", LOOP, [gains])],
            figures=[
                line_chart(f"control-{y[0]}", marked(title, margins), caption, drawn, ("time", "s"), y)
                for y, title, drawn in charts
            ],
            margins=margins,
        )
