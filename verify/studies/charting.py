"""What charts are made of: axes, lines, colours that mean the same in every chart. Plain plotly data."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from verify.models.catalogue import MODELS

if TYPE_CHECKING:
    from verify.models.arrays import Array

Figure = dict[str, Any]

GREY = "#8a8f98"
MEAN_COLOUR, RAYLEIGH, TIMOSHENKO = "#2a9d5c", "#9b6bdf", "#d6427a"
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")
PALETTE = ("#2a9d5c", "#d6427a", "#9b6bdf", "#c79a00", "#00a3a3", "#7a5c3e", "#5c6773")
"""Of lines that are told from each other by nothing else."""
SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x")
LOG: Figure = {"type": "log", "exponentformat": "power"}


def axes(x: str, y: str, **more: Any) -> Figure:
    """A layout with titled axes and settings for either."""
    layout: Figure = {"xaxis": {"title": {"text": x}}, "yaxis": {"title": {"text": y}}}
    for axis, settings in more.items():
        layout[axis] |= settings
    return layout


def line(name: str, colour: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Figure:
    """A line with its points."""
    trace: Figure = {
        "type": "scatter",
        "mode": "lines+markers",
        "name": name,
        "x": list(x),
        "y": list(y),
        "line": {"color": colour},
        "marker": {"color": colour, "size": 6},
    }
    of_line = trace["line"] | more.pop("line", {})
    of_marker = trace["marker"] | more.pop("marker", {})
    return trace | more | {"line": of_line, "marker": of_marker}


def plain_line(name: str, colour: str, x: Sequence[float], y: Sequence[float], width: float = 1.6) -> Figure:
    """A line without points."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": x,
        "y": y,
        "line": {"color": colour, "width": width},
    }


def model_line(model: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Figure:
    """The line of a model, in its colour."""
    return line(MODELS[model].title or MODELS[model].parts, MODELS[model].colour, x, y, **more)


def percent(values: Iterable[float | None], *, size: bool = False) -> list[float | None]:
    """In per cent; `size` without the sign."""
    return [None if v is None else 100.0 * (abs(v) if size else v) for v in values]


def sizes_axis(counts: Iterable[int]) -> Figure:
    """A logarithmic axis with a tick at every size that was solved."""
    found = sorted(set(counts))
    return {"type": "log", "tickvals": found, "ticktext": [str(n) for n in found]}


def thinned(values: "Sequence[float] | Array", most: int = 1000) -> list[float]:
    """Every so manyth value, for a chart."""
    return [float(v) for v in values[:: max(len(values) // most, 1)]]
