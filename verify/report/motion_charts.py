"""Charts of the slider as plain plotly figure data."""

from typing import TYPE_CHECKING, Any

from verify.report.charts import COLOUR, GREY, NAME, Figure, axes, chart
from verify.studies.slider import thinned

if TYPE_CHECKING:
    from verify.studies.slider import MotionStudy

_NAMES = {"analytic": "exact beam", **NAME}
_COLOURS = {"analytic": GREY, **COLOUR}


def motion_charts(study: "MotionStudy") -> list[dict[str, Any]]:
    """Way and force on three models, the surface under the slider, work against error."""
    return [_trajectory(study), _force(study), _speeds(study), _work(study)]


def _how(study: "MotionStudy") -> str:
    """Under which condition."""
    how = study.conditions["segment"]
    return f"{how.run_words}, {how.force_words}"


def _set_up(study: "MotionStudy") -> str:
    """What is not on the axis: the time before the loop, from the least to the most."""
    spans = []
    for model in ("segment", "fem"):
        times = [row.set_up_ms for row in study.work.rows if row.model == model]
        spans.append(f"{min(times):.2g} to {max(times):.2g} ms for {NAME[model]}")
    return f"the set-up before the loop is not counted: {' and '.join(spans)}"


def _lines(study: "MotionStudy", read: str, scale: float) -> list[Figure]:
    """One line for every model."""
    order = ("analytic", "segment", "fem")
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "name": _NAMES[model],
            "x": [1e3 * t for t in thinned(run.times)],
            "y": [scale * v for v in thinned(getattr(run, read))],
            "line": {"color": _COLOURS[model], "width": 4 if model == "analytic" else 1.6},
        }
        for model, run in ((m, study.runs[m]) for m in order)
    ]


def _trajectory(study: "MotionStudy") -> dict[str, Any]:
    return chart(
        "slider-trajectory",
        f"Way of the slider, N = {study.count}",
        f"Distance from the start, along +x: {_how(study)}.",
        _lines(study, "travelled", 1e9),
        axes("time, ms", "distance, nm"),
    )


def _force(study: "MotionStudy") -> dict[str, Any]:
    return chart(
        "slider-force",
        f"Tangential force on the slider, N = {study.count}",
        f"Friction saturates at ±mu N as soon as the surface moves faster than 1/K: {_how(study)}.",
        _lines(study, "friction", 1e3),
        axes("time, ms", "force, mN"),
    )


def _speeds(study: "MotionStudy") -> dict[str, Any]:
    run = study.runs["segment"]
    times = [1e3 * t for t in thinned(run.times)]
    data: list[Figure] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": name,
            "x": times,
            "y": [1e3 * v for v in thinned(values)],
            "line": {"color": colour, "width": 1.6},
        }
        for name, values, colour in (
            ("surface under the slider", run.surface_speed, GREY),
            ("slider", run.speed, COLOUR["segment"]),
        )
    ]
    return chart(
        "slider-speeds",
        "Speed of the slider and of the surface under it, segments",
        f"The surface swings both ways; what is left over of a period is the drift: {_how(study)}.",
        data,
        axes("time, ms", "speed, mm/s"),
    )


def _work(study: "MotionStudy") -> dict[str, Any]:
    data: list[Figure] = []
    for model in ("segment", "fem"):
        rows = [row for row in study.work.rows if row.model == model]
        data.append(
            {
                "type": "scatter",
                "mode": "lines+markers+text",
                "name": NAME[model],
                "x": [abs(r.error) for r in rows],
                "y": [r.run_ms_per_ms for r in rows],
                "text": [str(r.count) for r in rows],
                "textposition": "top center",
                "line": {"color": COLOUR[model]},
            }
        )
    log = {"type": "log", "exponentformat": "power"}
    return chart(
        "slider-work",
        "Run time against the error of the slider's displacement",
        f"The same contact code on both; sizes beside the points. Lower left is better; {_set_up(study)}.",
        data,
        axes(
            "error of the displacement against the exact beam",
            "wall ms per simulated ms",
            xaxis=log,
            yaxis=log | {"exponentformat": "none"},
        ),
    )
