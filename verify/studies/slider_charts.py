"""Charts of the slider."""

from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import BROAD, GREY, model_line, plain_line, thinned

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.models.arrays import Array
    from verify.motion.result import Motion
    from verify.studies.slider_figures import SliderFound


SLIDER = "#2f80ed"


def slider_charts(study: "SliderFound") -> tuple[Chart, ...]:
    """Way and force on three models, the surface under the slider, work against error."""
    return _trajectory(study), _force(study), _speeds(study), _work(study)


def _how(study: "SliderFound") -> str:
    """Under which condition."""
    how = study.condition
    return f"{how.run_words}, {how.force_words}"


def _set_up(study: "SliderFound") -> str:
    """What is not on the axis: the time before the loop, from the least to the most."""
    spans = []
    for model in dict.fromkeys(row.model for row in study.work.rows):
        times = [row.set_up_ms for row in study.work.rows if row.model == model]
        spans.append(f"{min(times):.2g} to {max(times):.2g} ms for {MODELS[model].title}")
    return f"the set-up before the loop is not counted: {' and '.join(spans)}"


def _lines(study: "SliderFound", read: "Callable[[Motion], Array]", scale: float) -> tuple[Line, ...]:
    """One line for every model, those without parts broad and first."""
    order = sorted(study.runs, key=lambda name: MODELS[name].sized)
    return tuple(
        plain_line(
            MODELS[name].title,
            MODELS[name].colour,
            [1e3 * t for t in thinned(study.runs[name].times)],
            [scale * v for v in thinned(read(study.runs[name]))],
            width=1.6 if MODELS[name].sized else BROAD,
        )
        for name in order
    )


def _trajectory(study: "SliderFound") -> Chart:
    return Chart(
        id="slider-trajectory",
        title=f"Way of the slider, N = {study.count}",
        caption=f"Distance from the start, along +x: {_how(study)}.",
        x=Axis("time, ms"),
        y=Axis("distance, nm"),
        lines=_lines(study, lambda run: run.travelled, 1e9),
    )


def _force(study: "SliderFound") -> Chart:
    return Chart(
        id="slider-force",
        title=f"Tangential force on the slider, N = {study.count}",
        caption=f"Friction saturates at ±mu N as soon as the surface moves faster than 1/K: {_how(study)}.",
        x=Axis("time, ms"),
        y=Axis("force, mN"),
        lines=_lines(study, lambda run: run.friction, 1e3),
    )


def _speeds(study: "SliderFound") -> Chart:
    run = study.subject
    times = [1e3 * t for t in thinned(run.times)]
    speeds = (("surface under the slider", run.surface_speed, GREY), ("slider", run.speed, SLIDER))
    return Chart(
        id="slider-speeds",
        title="Speed of the slider and of the surface under it, segments",
        caption=f"The surface swings both ways; what is left over of a period is the drift: {_how(study)}.",
        x=Axis("time, ms"),
        y=Axis("speed, mm/s"),
        lines=tuple(
            plain_line(name, colour, times, [1e3 * v for v in thinned(values)]) for name, values, colour in speeds
        ),
    )


def _work(study: "SliderFound") -> Chart:
    lines = []
    for model in dict.fromkeys(row.model for row in study.work.rows):
        rows = [row for row in study.work.rows if row.model == model]
        sizes = tuple(str(r.count) for r in rows)
        errors = [abs(r.error) for r in rows]
        lines.append(model_line(model, errors, [r.run_ms_per_ms for r in rows], beside=sizes))
    return Chart(
        id="slider-work",
        title="Run time against the error of the slider's displacement",
        caption=f"The same contact code on all; sizes beside the points. Lower left is better; {_set_up(study)}.",
        x=Axis("error of the displacement against the exact beam", log=True),
        y=Axis("wall ms per simulated ms", log=True),
        lines=tuple(lines),
    )
