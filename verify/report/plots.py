"""Charts on the page: the picture, its legend, what is seen in words, and the data of the layer on top."""

from collections.abc import Iterator
from math import isfinite, log10
from typing import Any

import msgspec

from verify.report.drawing import Drawing, drawn
from verify.report.inks import ink
from verify.studies.chart import Chart, Line, Map
from verify.studies.told import as_number
from verify.words import number

DIGITS = 6
"""Of the data under the cursor."""
_DASHES = {"solid": "", "dash": "5 2.5", "dot": "1.3 1.7", "dashdot": "5 2 1.3 2", "longdash": "9 3"}
MOVING_DIGITS = 4
"""Of what moves: a thousandth of a picture is no pixel."""
TOLD = 8
"""Lines that are put into words."""


class Key(msgspec.Struct, frozen=True):
    """An entry of a legend."""

    name: str
    group: str
    swatch: str
    """A small picture of the line."""


class Plot(msgspec.Struct, frozen=True, kw_only=True):
    """A chart as the page shows it."""

    chart: Chart
    svg: str
    keys: tuple[Key, ...]
    words: str
    data: dict[str, Any]


def plot_of(chart: Chart) -> Plot:
    """A chart drawn, with all that stands around it."""
    drawing = drawn(chart)
    return Plot(
        chart=chart, svg=drawing.svg, keys=tuple(_keys(chart)), words=words_of(chart), data=_data(chart, drawing)
    )


def _keys(chart: Chart) -> Iterator[Key]:
    """Entries of the legend, each name once; none where one line stands alone and the title says what it is."""
    named: set[str] = set()
    keyed = [line for line in chart.lines if line.keyed]
    if len(keyed) < 2 and chart.map is None:
        return
    for line in keyed:
        if line.name not in named:
            named.add(line.name)
            yield Key(line.name, line.group or line.name, _swatch(line))


def _swatch(line: Line) -> str:
    """A stroke with its marker, 30 by 12."""
    parts = []
    if line.joined:
        dash = f' stroke-dasharray="{_DASHES[line.dash]}"' if _DASHES[line.dash] else ""
        parts.append(f'<path d="M1 6H29" stroke="{ink(line.colour)}" stroke-width="{min(line.width, 4):g}"{dash}/>')
    marker = _marker(line.marker, ink(line.colour))
    hollow = bool(line.hollow) and all(line.hollow)
    parts.append(marker.replace("fill=", 'stroke-width="1.3" fill="none" stroke=') if hollow else marker)
    return f'<svg viewBox="0 0 30 12" aria-hidden="true">{"".join(parts)}</svg>'


def _marker(marker: str, colour: str) -> str:
    shapes = {
        "circle": f'<circle cx="15" cy="6" r="3.2" fill="{colour}"/>',
        "square": f'<path d="M12 3h6v6h-6z" fill="{colour}"/>',
        "diamond": f'<path d="M15 2l4 4-4 4-4-4z" fill="{colour}"/>',
        "triangle": f'<path d="M15 2l4 7h-8z" fill="{colour}"/>',
        "cross": f'<path d="M12 3l6 6m0-6l-6 6" stroke="{colour}" stroke-width="1.5"/>',
        "star": f'<path d="M15 1l1.5 3.6 3.5.3-2.7 2.4.9 3.7-3.2-2-3.2 2 .9-3.7L10 4.9l3.5-.3z" fill="{colour}"/>',
    }
    return shapes.get(marker, "")


def words_of(chart: Chart) -> str:
    """What is seen, for who does not see it: each line from its first to its last point, with its extremes."""
    told = [f"{chart.y.title} over {chart.x.title}." if chart.y.title else f"{chart.x.title}."]
    if chart.map is not None:
        told.append(_map_words(chart.map, chart))
    if chart.bars is not None:
        pairs = zip(reversed(chart.bars.names), reversed(chart.bars.values), strict=True)
        told.append(", ".join(f"{name} {number(value, 3)}" for name, value in pairs) + ".")
    lines = [line for line in chart.lines if not line.guide and line.y]
    told += [_line_words(line) for line in lines[:TOLD]]
    if len(lines) > TOLD:
        told.append(f"{len(lines) - TOLD} more lines; the data has them all.")
    return " ".join(one for one in told if one)


def _line_words(line: Line) -> str:
    points = [(x, y) for x, y in zip(line.x, line.y, strict=True) if x is not None and y is not None]
    if not points:
        return ""
    if len(points) == 1:
        return f"{line.name}: {_at(points[0])}."
    ends = f"{line.name}: from {_at(points[0])} to {_at(points[-1])}"
    low, high = min(points, key=lambda p: p[1]), max(points, key=lambda p: p[1])
    turned = {low, high} - {points[0], points[-1]}
    return ends + (f", least {_at(low)}, largest {_at(high)}" if turned else "") + "."


def _at(point: tuple[float, float]) -> str:
    return f"{number(point[1], 3)} at {number(point[0], 4)}"


def _map_words(found: Map, chart: Chart) -> str:
    cells = [
        (value, x, y)
        for y, row in zip(found.y, found.values, strict=True)
        for x, value in zip(found.x, row, strict=True)
        if value is not None
    ]
    if not cells:
        return f"No point has a {found.name}."
    told = [("least", min(cells)), ("largest", max(cells))]
    beyond = sum(value == found.most for value, *_ in cells)
    words = [
        f"The {word} {found.name} is {number(value, 4)}, at {chart.x.title} {number(x, 5)} and {chart.y.title} "
        f"{number(y, 4)}."
        for word, (value, x, y) in told
        if value != found.most
    ]
    if beyond:
        words.append(
            f"The {found.name} is {number(found.most or 0.0, 4)} or more at {beyond} of {len(cells)} points; how much "
            "more is not told here."
        )
    return " ".join(words)


def _data(chart: Chart, drawing: Drawing) -> dict[str, Any]:
    """For the layer: places of the axes, and every value to so many digits."""
    data: dict[str, Any] = {
        "id": chart.id,
        "box": [round(v, 2) for v in drawing.box],
        "x": drawing.x,
        "y": drawing.y,
        "xlog": chart.x.log,
        "ylog": chart.y.log,
        "xtitle": chart.x.title,
        "ytitle": chart.y.title,
        "frames": chart.frames,
        "plays": chart.plays,
        "lines": [_line_data(line) for line in chart.lines],
    }
    if chart.map is not None:
        data["map"] = msgspec.to_builtins(chart.map, enc_hook=as_number) | {
            "values": [_short(row, 4) for row in chart.map.values]
        }
    if chart.bars is not None:
        data["bars"] = msgspec.to_builtins(chart.bars, enc_hook=as_number)
    return data


def _line_data(line: Line) -> dict[str, Any]:
    data: dict[str, Any] = {"name": line.name, "group": line.group or line.name}
    data |= {"x": _short(line.x), "y": _short(line.y)}
    if line.said or line.beside:
        data["said"] = line.said or line.beside
    if line.guide:
        data["guide"] = True
    if line.moves:
        data |= {"colour": ink(line.colour), "width": line.width, "dash": _DASHES[line.dash], "joined": line.joined}
        data |= {"size": line.size if line.marker else 0, "hollow": any(line.hollow), "square": line.marker == "square"}
        data["moves"] = [_short(row, MOVING_DIGITS) for row in line.moves]
        data |= {"shifts": [_short(row, DIGITS) for row in line.shifts]} if line.shifts else {}
    return data


def _short(values: "tuple[float | None, ...]", digits: int = DIGITS) -> list[float | None]:
    """Numbers to so many digits, whole ones as such."""
    return [None if v is None or not isfinite(v) else _rounded(v, digits) for v in values]


def _rounded(value: float, digits: int) -> float:
    if value == 0.0:
        return 0
    places = digits - 1 - int(log10(abs(value)) // 1)
    rounded = round(value, places)
    return int(rounded) if rounded.is_integer() and abs(rounded) < 1e15 else rounded
