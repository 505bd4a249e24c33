"""Charts as SVG, drawn by matplotlib: the same picture on the page, in print and without scripts.

Ink and grid lines are CSS variables with a fall-back, so that a dark page shows a dark chart; legends are the page's.
"""

import re
from collections.abc import Sequence
from io import StringIO
from math import floor, isfinite, isnan, log10, nan
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.models.arrays import Array
from verify.report.inks import inked
from verify.studies.chart import Axis, Bars, Chart, Line, Map, Mark
from verify.studies.charting import BROAD

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 430.0, 285.0
"""Of the picture, in units of its own; text is drawn for a page that shows it at 0.8 to 1.35 of that."""
FONT = 11.0
UNDER = 1.7
"""By which the lowest lines are broader."""
CLOSEST = 27.0
"""Between two ticks that were chosen."""
FEW, MANY = (1.0, 2.0, 5.0), (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
"""Times a power of ten: ticks of an axis that is short."""
LETTER = 7.0
"""Width of one beside a point, as broad as any page shows it."""
NAMED = 26
"""Letters of a bar's name in a row; what is longer is broken, and the picture higher."""
ROW = 13.0
"""Height of a row of a bar's name, and of what stands below the bars."""
SHORT = 0.2
"""Of all bars' span: words of a bar to the left that is shorter stand at its right, clear of the names."""
_INK, _RULE, _PAPER = "#010203", "#010204", "#010205"
_VARIABLES = {
    _INK: "var(--ink, #1c2026)",
    _RULE: "var(--line, #dfe3e8)",
    _PAPER: "var(--card, #ffffff)",
}
_DASHES = {"solid": "-", "dash": (0, (5, 2.5)), "dot": (0, (1.3, 1.7)), "dashdot": (0, (5, 2, 1.3, 2))}
_DASHES |= {"longdash": (0, (9, 3))}
_MARKERS = {"circle": "o", "square": "s", "diamond": "D", "triangle": "^", "cross": "x", "star": "*", "": ""}
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PLACES = re.compile(r"(\d+\.\d{2})\d+")
_SETTINGS: dict[Any, Any] = {
    "svg.fonttype": "none",
    "font.size": FONT,
    "axes.edgecolor": _INK,
    "axes.labelcolor": _INK,
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "grid.color": _RULE,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.axisbelow": True,
    "grid.linewidth": 0.7,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "savefig.facecolor": "none",
    "path.simplify_threshold": 0.4,
}


class Drawing(msgspec.Struct, frozen=True):
    """A chart drawn."""

    svg: str
    box: tuple[float, float, float, float]
    """Left, top, right and bottom of the axes in the picture's units, downwards."""
    x: tuple[float, float]
    """What stands at its left and right."""
    y: tuple[float, float]
    """What stands at its bottom and top."""


def drawn(chart: Chart) -> Drawing:
    """A chart as SVG, and where its axes are; of several frames the last."""
    import matplotlib as mpl
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with mpl.rc_context(_SETTINGS | {"svg.hashsalt": chart.id}):
        figure = Figure(figsize=(WIDTH / 72, _height(chart) / 72), dpi=72)
        FigureCanvasSVG(figure)
        axes = figure.add_axes((0.12, 0.15, 0.86, 0.83))
        if chart.map is not None:
            _map(figure, axes, chart.map)
        if chart.bars is not None:
            _bars(axes, chart.bars)
        _lines(axes, chart)
        for i, mark in enumerate(chart.marks):
            _mark(axes, mark, i)
        _axis(axes, "x", chart.x, chart)
        _axis(axes, "y", chart.y, chart)
        _settle(figure, axes)
        _beside(axes, chart.lines)
        box = _settle(figure, axes)
        if chart.equal:
            axes.set_aspect("equal", adjustable="datalim")
            axes.apply_aspect()
        text = StringIO()
        figure.savefig(text, format="svg", dpi=144, metadata={"Date": None, "Creator": None, "Format": None})
        (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    return Drawing(_cleaned(text.getvalue()), box, (float(x0), float(x1)), (float(y0), float(y1)))


def _lines(axes: "Axes", chart: Chart) -> None:
    """Every line of the last frame; those that are shaded with the one before."""
    before: Line | None = None
    lowest = _lowest(chart)
    for i, line in enumerate(chart.lines):
        if line.filled and before is not None:
            axes.fill_between(
                _gaps(line.x), _gaps(before.y), _gaps(line.y), color="#8a8f98", alpha=0.18, lw=0, zorder=1
            )
        _line(axes, replace(line, width=UNDER * line.width) if i in lowest else line, f"{chart.id}-{i}")
        before = line
        _room(axes, line)


def _beside(axes: "Axes", lines: Sequence[Line]) -> None:
    """Words over the points of the first line and under those of the others; elsewhere where words stand there."""
    style: dict[str, Any] = {"ha": "center", "va": "baseline", "fontsize": FONT - 2}
    over, taken = True, list[tuple[float, float, float]]()
    for line in (one for one in lines if one.beside):
        for x, y, words in zip(_gaps(line.x), _gaps(line.y), line.beside, strict=False):
            if isnan(x + y):
                continue
            reach = LETTER * len(words)
            beside = 0.5 * reach + 7.0
            level = (5.0, -13.0) if over else (-13.0, 5.0)
            places = [(0.0, level[0]), (0.0, level[1]), (beside, -3.0), (-beside, -3.0)]
            spot = axes.transData.transform((x, y))
            free = (place for place in places if _is_free(spot + place, reach, taken))
            place = next(free, places[0])
            taken.append((*(spot + place), reach))
            axes.annotate(words, (x, y), place, textcoords="offset points", **style)
        over = False


def _is_free(spot: Array, reach: float, taken: Sequence[tuple[float, float, float]]) -> bool:
    """Whether words of such a width, in points, their middle there, lie on no others."""
    return all(abs(spot[0] - x) > 0.5 * (reach + other) or abs(spot[1] - y) > FONT for x, y, other in taken)


def _room(axes: "Axes", line: Line) -> None:
    """Limits that hold every frame."""
    for k, y in enumerate(line.moves):
        x = line.shifts[k] if line.shifts else line.x
        points = [(a, b) for a, b in zip(x, y, strict=True) if a is not None and b is not None]
        axes.update_datalim(points)
    if line.moves:
        axes.autoscale_view()


def _lowest(chart: Chart) -> set[int]:
    """Lines of the first colour: drawn a little broader, so that they are seen where others lie on them."""
    own = [i for i, line in enumerate(chart.lines) if line.joined and not line.guide and line.width < BROAD]
    colours = dict.fromkeys(chart.lines[i].colour for i in own)
    return {i for i in own if chart.lines[i].colour == next(iter(colours))} if len(colours) > 1 else set()


def _line(axes: "Axes", line: Line, gid: str) -> None:
    x, y = _gaps(line.x), _gaps(line.y)
    style: dict[str, Any] = {"color": line.colour, "linewidth": line.width if line.joined else 0.0}
    style |= {"linestyle": _DASHES[line.dash] if line.joined else "", "zorder": 1.5 if line.guide else 2.0}
    marker: dict[str, Any] = {"marker": _MARKERS[line.marker], "markersize": line.size, "markeredgewidth": 1.2}
    if not line.hollow:
        axes.plot(x, y, gid=gid, **style, **marker)
        return
    for hollow in (False, True):
        own = [one is hollow for one in line.hollow]
        axes.plot(
            [v for v, mine in zip(x, own, strict=True) if mine],
            [v for v, mine in zip(y, own, strict=True) if mine],
            gid=f"{gid}{'h' if hollow else ''}",
            markerfacecolor="none" if hollow else line.colour,
            **style,
            **marker,
        )


def _gaps(values: Sequence[float | None]) -> list[float]:
    return [nan if value is None else value for value in values]


def _height(chart: Chart) -> float:
    """Of the picture: more where bars have names of several rows."""
    rows = sum(name.count("\n") + 1.5 for name in _names(chart.bars)) if chart.bars is not None else 0.0
    return max(HEIGHT, ROW * (rows + 4.0))


def _names(bars: Bars) -> list[str]:
    """Of bars, in rows that leave them the better part of the picture."""
    return ["\n".join(wrap(name, NAMED)) for name in bars.names]


def _bars(axes: "Axes", bars: Bars) -> None:
    places = range(len(bars.names))
    axes.barh(places, bars.values, color=bars.colours, height=0.72)
    axes.set_yticks(places, _names(bars), fontsize=FONT - 1)
    span = max(bars.values, default=0.0) - min(bars.values, default=0.0)
    for at, value, words in zip(places, bars.values, bars.words, strict=False):
        side = -1 if value < -SHORT * span else 1
        style: dict[str, Any] = {"ha": "left" if side > 0 else "right", "va": "center"}
        axes.annotate(
            words, (max(value, 0.0) if side > 0 else value, at), (4 * side, 0), textcoords="offset points", **style
        )
    if bars.words:
        axes.margins(x=0.22)


def _map(figure: "Figure", axes: "Axes", found: Map) -> None:
    import numpy as np

    values = np.ma.masked_invalid([_gaps(row) for row in found.values])
    mesh = axes.pcolormesh(found.x, found.y, values, cmap="viridis_r", shading="nearest", rasterized=True)
    place = figure.add_axes((0.9, 0.15, 0.025, 0.83))
    bar = figure.colorbar(mesh, cax=place)
    bar.outline.set_visible(False)
    bar.set_label(found.name)
    axes.grid(visible=False)


def _mark(axes: "Axes", mark: Mark, i: int) -> None:
    axes.axvline(mark.x, color=mark.colour, linewidth=1.4, linestyle=_DASHES["dot"] if mark.words else "-", zorder=1.6)
    place = (mark.x, 1.0 - 0.07 * i)
    axes.annotate(
        mark.words,
        place,
        (4, 0),
        xycoords=axes.get_xaxis_transform(),
        textcoords="offset points",
        va="top",
    )


def _axis(axes: "Axes", which: str, axis: Axis, chart: Chart) -> None:
    """Title, scale, ticks and grid of one axis."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

    own = axes.xaxis if which == "x" else axes.yaxis
    if axis.log and _positive(chart, which):
        (axes.set_xscale if which == "x" else axes.set_yscale)("log", nonpositive="clip" if chart.bars else "mask")
        own.set_minor_locator(NullLocator())
        own.set_minor_formatter(NullFormatter())
        own.set_major_locator(LogLocator(numticks=7))
        own.set_major_formatter(FuncFormatter(lambda value, _: power(value)))
        _at_least_two(axes, which)
    if axis.ticks:
        own.set_major_locator(FixedLocator(_apart(axis, WIDTH if which == "x" else HEIGHT)))
        own.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    own.set_label_text(axis.title)
    if chart.map is None and not (chart.bars is not None and which == "y"):
        axes.grid(visible=True, axis="x" if which == "x" else "y", zorder=0)
    if axis.backwards:
        (axes.invert_xaxis if which == "x" else axes.invert_yaxis)()


def _at_least_two(axes: "Axes", which: str) -> None:
    """Ticks at 1, 2 and 5 where the axis has no two powers of ten; more of them where it has not two of those."""
    from matplotlib.ticker import LogLocator

    low, high = sorted(axes.get_xlim() if which == "x" else axes.get_ylim())
    if log10(high / low) < 2.0:
        decades = range(floor(log10(low)), floor(log10(high)) + 1)
        few = sum(low <= sub * 10.0**k <= high for k in decades for sub in FEW) < 3
        own = axes.xaxis if which == "x" else axes.yaxis
        own.set_major_locator(LogLocator(subs=MANY if few else FEW, numticks=20))


def _positive(chart: Chart, which: str) -> bool:
    """Whether anything stands where a logarithm has a place for it."""
    values = [v for line in chart.lines for v in (line.x if which == "x" else line.y) if v is not None]
    values += list(chart.bars.values) if chart.bars is not None else []
    return any(value > 0.0 for value in values)


def power(value: float) -> str:
    """0.001, 5, 200, 10⁻⁵."""
    if not isfinite(value) or value <= 0.0:
        return f"{value:g}"
    exponent = floor(log10(value) + 1e-9)
    if -3 <= exponent <= 3:
        return f"{value:g}"
    mantissa = value / 10.0**exponent
    times = "" if abs(mantissa - 1.0) < 1e-6 else f"{mantissa:g}·"
    return f"{times}10{str(exponent).translate(_SUPERSCRIPTS)}"


def _apart(axis: Axis, room: float) -> list[float]:
    """Chosen ticks that do not stand on each other, from the largest down."""
    places = [log10(tick) if axis.log else tick for tick in axis.ticks]
    span = max(places) - min(places) or 1.0
    kept: list[float] = []
    for tick, place in sorted(zip(axis.ticks, places, strict=True), reverse=True):
        last = (log10(kept[-1]) if axis.log else kept[-1]) if kept else None
        if last is None or (last - place) / span * 0.8 * room >= CLOSEST:
            kept.append(tick)
    return kept[::-1]


def _settle(figure: "Figure", axes: "Axes") -> tuple[float, float, float, float]:
    """Give the axes the room that their words leave; where they are then, in the picture's units."""
    from matplotlib.backends.backend_svg import RendererSVG

    measuring: Any = RendererSVG
    height = 72.0 * float(figure.get_figheight())
    renderer = measuring(WIDTH, height, StringIO())
    bars = [one for one in figure.axes if one is not axes]
    for _ in range(2 if axes.texts else 1):  # words at a bar's end go farther out as the axes shrink
        left, above, over, bottom, right = _margins(axes, bars, renderer)
        wide, tall = (WIDTH - left - over) / WIDTH, (height - bottom - above) / height
        axes.set_position((left / WIDTH, bottom / height, wide, tall))
        for bar in bars:
            bar.set_position(((WIDTH - right) / WIDTH, bottom / height, 10.0 / WIDTH, tall))
    return left, above, WIDTH - over, height - bottom


def _margins(axes: "Axes", bars: "list[Axes]", renderer: Any) -> tuple[float, float, float, float, float]:
    """What words need at the left, above, at the right, below; and of the right what a bar of colours needs."""
    words, own = axes.get_tightbbox(renderer, bbox_extra_artists=axes.texts), axes.get_window_extent()
    assert words is not None
    right, top = 0.0, words.y1
    for bar in bars:
        beside = bar.get_tightbbox(renderer)
        right = (beside.width if beside else 0.0) + 8.0
        top = max(top, beside.y1 if beside else 0.0)
    over, above = max(words.x1 - own.x1, 0.0) + 4.0 + right, max(top - own.y1, 0.0) + 4.0
    return (
        float(own.x0 - words.x0 + 3.0),
        float(above),
        float(over),
        float(own.y0 - words.y0 + 3.0),
        float(right),
    )


def _cleaned(text: str) -> str:
    """What stands on a page: no declarations, shorter numbers, colours that follow the page."""
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->|\n *", "", text, flags=re.DOTALL)
    text = re.sub(r'(?<= )(?:d|x|y|transform|points)="[^"]*"', lambda found: _PLACES.sub(r"\1", found[0]), text)
    text = re.sub(r' (width|height)="[\d.]+pt"', "", text, count=2)
    text = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", text)
    for sentinel, variable in _VARIABLES.items():
        text = text.replace(sentinel, variable)
    return inked(text).replace("<svg ", '<svg class="drawn" ', 1)
