"""Charts of the slider as plain plotly figure data."""

from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.studies.charting import GREY, LOG, Figure, axes, model_line, plain_line, thinned
from verify.studies.told import Chart

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


def _lines(study: "SliderFound", read: "Callable[[Motion], Array]", scale: float) -> list[Figure]:
    """One line for every model, those without parts broad and first."""
    order = sorted(study.runs, key=lambda name: MODELS[name].sized)
    return [
        plain_line(
            MODELS[name].title,
            MODELS[name].colour,
            [1e3 * t for t in thinned(study.runs[name].times)],
            [scale * v for v in thinned(read(study.runs[name]))],
            1.6 if MODELS[name].sized else 4,
        )
        for name in order
    ]


def _trajectory(study: "SliderFound") -> Chart:
    return Chart(
        "slider-trajectory",
        f"Way of the slider, N = {study.count}",
        f"Distance from the start, along +x: {_how(study)}.",
        _lines(study, lambda run: run.travelled, 1e9),
        axes("time, ms", "distance, nm"),
    )


def _force(study: "SliderFound") -> Chart:
    return Chart(
        "slider-force",
        f"Tangential force on the slider, N = {study.count}",
        f"Friction saturates at ±mu N as soon as the surface moves faster than 1/K: {_how(study)}.",
        _lines(study, lambda run: run.friction, 1e3),
        axes("time, ms", "force, mN"),
    )


def _speeds(study: "SliderFound") -> Chart:
    run = study.subject
    times = [1e3 * t for t in thinned(run.times)]
    speeds = (("surface under the slider", run.surface_speed, GREY), ("slider", run.speed, SLIDER))
    data = [plain_line(name, colour, times, [1e3 * v for v in thinned(values)]) for name, values, colour in speeds]
    return Chart(
        "slider-speeds",
        "Speed of the slider and of the surface under it, segments",
        f"The surface swings both ways; what is left over of a period is the drift: {_how(study)}.",
        data,
        axes("time, ms", "speed, mm/s"),
    )


def _work(study: "SliderFound") -> Chart:
    data: list[Figure] = []
    for model in dict.fromkeys(row.model for row in study.work.rows):
        rows = [row for row in study.work.rows if row.model == model]
        trace = model_line(model, [abs(r.error) for r in rows], [r.run_ms_per_ms for r in rows])
        data.append(
            trace | {"mode": "lines+markers+text", "text": [str(r.count) for r in rows], "textposition": "top center"}
        )
    return Chart(
        "slider-work",
        "Run time against the error of the slider's displacement",
        f"The same contact code on all; sizes beside the points. Lower left is better; {_set_up(study)}.",
        data,
        axes(
            "error of the displacement against the exact beam",
            "wall ms per simulated ms",
            xaxis=LOG,
            yaxis=LOG | {"exponentformat": "none"},
        ),
    )
