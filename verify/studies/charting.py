"""What charts are made of: axes, lines, colours that mean the same in every chart."""

from collections.abc import Iterable, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Dash, Line, Marker, Numbers
from verify.units import Unit

if TYPE_CHECKING:
    from verify.models.arrays import Array

GREY = "#8a8f98"
MEAN_COLOUR, RAYLEIGH, TIMOSHENKO, PLATE = "#2a9d5c", "#9b6bdf", "#d6427a", "#00a3a3"
SHADES = ("#56c7c2", "#3fa7d6", "#2f80ed", "#6d6fe0", RAYLEIGH)
"""Of one thing that grows from line to line."""
DASHES: tuple[Dash, ...] = ("solid", "dash", "dot", "dashdot", "longdash")
PALETTE = ("#2a9d5c", "#d6427a", "#9b6bdf", "#b38a00", "#00a3a3", "#9a7450", "#6f7d8c")
"""Of a few lines that stand beside no model and no theory."""
OTHERS = (
    *("#543c00", "#006090", "#d82400", "#8424cc", "#607860", "#cc00b4"),
    *("#303090", "#903c0c", "#0000fc", "#902460", "#004854", "#fc18f0"),
)
"""Of lines that stand beside models, theories and means, and are none of their colours."""
ON_DARK = dict(
    zip(
        OTHERS,
        (
            *("#fccc00", "#9cc0fc", "#fc6c84", "#d86cfc", "#6cd854", "#d824cc"),
            *("#00789c", "#b46018", "#60d8c0", "#f0cca8", "#786c60", "#fcc0fc"),
        ),
        strict=True,
    )
)
ON_DARK |= {"#7a4fb5": "#a27fd8"}
ON_LIGHT = {"#e8760c": "#de6e04", "#3fa7d6": "#2089b9", "#56c7c2": "#1a928c"}
"""What colours are on a page of the other kind, where on both they would not stand out by three to one. The others are
as far apart as colours can be, seen by all and by eyes without the green cones: twelve that contrast enough, drawn so
that the least distance (Ottosson's Oklab) among them and to models' colours is largest."""
SYMBOLS: tuple[Marker, ...] = ("circle", "square", "diamond", "triangle", "cross")
BROAD = 4.0
"""Of a line that others lie on."""


def numbers(values: "Iterable[float | None] | Array") -> Numbers:
    """Plain numbers, None where there is none or one that is not finite."""
    return tuple(None if v is None or not isfinite(v) else float(v) for v in values)


def in_units(one: Line, x: Unit, y: Unit) -> Line:
    """A line whose places are in SI, in these units, at every frame."""
    return replace(
        one,
        x=_times(x.factor, one.x),
        y=_times(y.factor, one.y),
        moves=tuple(_times(y.factor, row) for row in one.moves),
        shifts=tuple(_times(x.factor, row) for row in one.shifts),
    )


def _times(factor: float, values: Numbers) -> Numbers:
    return tuple(None if v is None else factor * v for v in values)


def line(name: str, colour: str, x: Iterable[Any], y: Iterable[Any], *, marker: Marker = "circle", **more: Any) -> Line:
    """A line with its points."""
    return Line(name=name, colour=colour, x=numbers(x), y=numbers(y), marker=marker, **more)


def plain_line(name: str, colour: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Line:
    """A line without points."""
    return line(name, colour, x, y, marker="", **more)


def model_line(model: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Line:
    """The line of a model, in its colour."""
    own = {"name": MODELS[model].title or MODELS[model].parts, "colour": MODELS[model].colour} | more
    return line(x=x, y=y, **own)


def other_line(i: int, name: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Line:
    """The i-th of lines that are told from each other, from models and from theories by nothing but their strokes.

    Where colours come round again markers are hollow, then strokes broad, then both.
    """
    turn, at = divmod(i, len(OTHERS))
    own = line(name, OTHERS[at], x, y, **({"width": 3.2} if turn // 2 % 2 else {}) | more)
    return replace(own, hollow=(True,) * len(own.x)) if turn % 2 else own


def key(name: str, **style: Any) -> Line:
    """An entry of the legend alone, which explains what a dash or a marker means."""
    return Line(name=name, colour=GREY, x=(), y=(), **style)


def percent(values: Iterable[float | None], *, size: bool = False) -> Numbers:
    """In per cent; `size` without the sign."""
    return tuple(None if v is None else 100.0 * (abs(v) if size else v) for v in values)


def sizes_axis(title: str, counts: Iterable[int]) -> Axis:
    """A logarithmic axis with a tick at every size that was solved."""
    return Axis(title, log=True, ticks=tuple(sorted(set(counts))))


def unbroken(words: str) -> str:
    """A figure that no line ends within."""
    return words.replace("-", "\N{NON-BREAKING HYPHEN}").replace(" ", "\N{NO-BREAK SPACE}")


def thinned(values: "Sequence[float] | Array", most: int = 1000) -> list[float]:
    """Every so manyth value, for a chart."""
    return [float(v) for v in values[:: max(len(values) // most, 1)]]
