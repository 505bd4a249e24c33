"""What a chart shows, as plain values: axes, lines, bars, a map, marks. Nothing is drawn and nothing imported here."""

from typing import Annotated, Literal, TypeAlias

import msgspec
from msgspec import Meta

Number: TypeAlias = Annotated[float, Meta(ge=-1e200, le=1e200)]
"""What an axis can hold: nothing larger is read from a file."""
Numbers: TypeAlias = tuple[Number | None, ...]
"""None, and what is not finite, is a gap."""
Dash: TypeAlias = Literal["solid", "dash", "dot", "dashdot", "longdash"]
Marker: TypeAlias = Literal["", "circle", "square", "diamond", "triangle", "cross", "star"]


class Axis(msgspec.Struct, frozen=True):
    """One axis."""

    title: str
    """With its unit."""
    log: bool = False
    ticks: tuple[Number, ...] = ()
    """Where they are chosen: every size that was solved."""
    backwards: bool = False
    """From large to small."""


class Line(msgspec.Struct, frozen=True, kw_only=True):
    """Points that belong together, joined or not."""

    name: str
    x: Numbers
    y: Numbers
    colour: str
    """Hexadecimal; that of a model means the same in every chart."""
    width: float = 1.6
    dash: Dash = "solid"
    marker: Marker = ""
    size: float = 5.0
    hollow: tuple[bool, ...] = ()
    """Of each marker; none is unless told."""
    joined: bool = True
    said: tuple[str, ...] = ()
    """Of each point, under the cursor."""
    beside: tuple[str, ...] = ()
    """Of each point, written beside it."""
    group: str = ""
    """Lines of one group are switched on and off together; the name unless given."""
    keyed: bool = True
    """Whether the legend has it."""
    guide: bool = False
    """Something to hold the others against: it is not pointed at and not put into words."""
    filled: bool = False
    """The room between this line and the one before it is shaded."""
    moves: tuple[Numbers, ...] = ()
    """`y` at every frame of a chart that has some, the last as `y`."""
    shifts: tuple[Numbers, ...] = ()
    """`x` at every frame, where that changes too."""


class Bars(msgspec.Struct, frozen=True):
    """Bars from the left, the first at the bottom."""

    names: tuple[str, ...]
    values: tuple[Number, ...]
    colours: tuple[str, ...]
    words: tuple[str, ...] = ()
    """Of each, at its end."""


class Map(msgspec.Struct, frozen=True, kw_only=True):
    """A value over two axes."""

    name: str
    """What the colours are."""
    x: tuple[Number, ...]
    y: tuple[Number, ...]
    values: tuple[Numbers, ...]
    """A row for each y."""
    most: Number | None = None
    """What stands for all larger values too, where they are cut off."""


class Mark(msgspec.Struct, frozen=True):
    """An upright line with words at its top."""

    x: Number
    words: str
    colour: str


class Chart(msgspec.Struct, frozen=True, kw_only=True):
    """One chart of the page."""

    id: str
    title: str
    caption: str
    """What is seen, under which condition."""
    x: Axis
    y: Axis
    lines: tuple[Line, ...] = ()
    bars: Bars | None = None
    map: Map | None = None
    marks: tuple[Mark, ...] = ()
    frames: tuple[str, ...] = ()
    """Names of frames to choose among, the last is shown first."""
    plays: bool = False
    """Whether frames follow each other as a moving picture; they are chosen by hand unless told."""
    equal: bool = False
    """Whether both axes have one scale."""

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        return self.bars is None and self.map is None and not any(_seen(line) for line in self.lines)


def _seen(line: Line) -> bool:
    return not line.guide and any(value is not None for value in line.y)
