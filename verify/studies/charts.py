"""What the tables, charts and movies of several studies share: columns, lines in suitable units."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, TypeAlias

from verify.analysis.variants import Variant
from verify.formatting import unit_of, unit_over
from verify.linear.registry import MODELS
from verify.report.plotting import CYCLE, MODEL_COLORS, MovingLine, animation
from verify.report.result import Column, Figure, Table
from verify.studies.base import Axes

Columns: TypeAlias = Mapping[Column, str | Callable[[Any], Any]]
Line: TypeAlias = tuple[str, Any, Any, dict[str, Any]]  # label, x, y in SI units, style
Axis: TypeAlias = tuple[str, str]  # name, SI unit
THIN, BROAD = 1.4, 4.0  # widths of lines of discrete models, and of the exact beam below them
MOST_POINTS = 2000


def si(name: str, unit: str, form: str = ".4g") -> Column:
    """A column of values that are shown with the SI prefix that suits the largest."""
    return Column(name, unit, form, prefix=True)


def percent(name: str, form: str = "+.4g") -> Column:
    """A column of ratios that are shown in per cent."""
    return Column(name, format=form, percent=True)


def unit_symbol(unit: str) -> str:
    """The unit of a quantity for a table or an axis: none for '1'."""
    return "" if unit == "1" else unit


def table(title: str, items: Iterable[Any], columns: Columns, *notes: str) -> Table:
    """A row of each item; every column with the key of its value in an item, or the function that reads it."""
    rows = [[item[read] if isinstance(read, str) else read(item) for read in columns.values()] for item in items]
    return Table(title, list(columns), rows, notes)


def sized_title(model: str, count: int | None) -> str:
    """'49 segments', 'exact beam'."""
    return f"{count} {MODELS[model].title}" if count else MODELS[model].title


def model_style(model: str) -> dict[str, Any]:
    """Colour and line width of a model in every chart."""
    color = MODEL_COLORS.get(model, MODELS[model].colour)
    return {"color": color, "linewidth": THIN if MODELS[model].sized else BROAD}


def variant_colors(variants: tuple[Variant, ...]) -> dict[Variant, str]:
    """The colour of a model for its first variant, others from the colour cycle."""
    colors: dict[Variant, str] = {}
    for variant in variants:
        first = all(other.model != variant.model for other in colors)
        colors[variant] = model_style(variant.model)["color"] if first else CYCLE[len(colors) % len(CYCLE)]
    return colors


def line_chart(name: str, title: str, caption: str, lines: Iterable[Line], x: Axis, y: Axis) -> Figure:
    """A chart of lines."""
    return Figure(name, title, caption, partial(plot_lines, lines=list(lines), x=x, y=y))


def plot_lines(ax: Axes, lines: Iterable[Line], x: Axis, y: Axis) -> None:
    """Lines (label, x, y, style) in SI units on axes (name, unit), drawn in the prefixes that suit the largest."""
    drawn = [line for line in lines if len(line[1])]
    x_unit = unit_over((float(abs(xs).max()) for _, xs, _, _ in drawn), x[1])
    y_unit = unit_over((float(abs(ys).max()) for _, _, ys, _ in drawn), y[1])
    for label, xs, ys, style in drawn:
        every = slice(None, None, max(len(xs) // MOST_POINTS, 1))
        ax.plot(x_unit.factor * xs[every], y_unit.factor * ys[every], label=label, **style)
    ax.set(xlabel=f"{x[0]}, {x_unit.name}".rstrip(", "), ylabel=f"{y[0]}, {y_unit.name}".rstrip(", "))
    if any(label for label, *_ in drawn):
        ax.legend()


def beam_movie(
    lines: Sequence[MovingLine], length: float, height: float, texts: Sequence[str], left: float = 0.0
) -> Callable[[Axes], Any]:
    """What `Movie.animate` is, of lines in SI units over a beam of this length from `left` up to this height, m."""
    along, up = unit_of(length), unit_of(height)

    def animate(ax: Axes) -> Any:
        ends, top = (left - 0.05 * length, 1.05 * length), 1.2 * up.factor * height
        ax.set(xlim=(along.factor * ends[0], along.factor * ends[1]), ylim=(-top, top))
        ax.set(xlabel=f"x, {along.name}", ylabel=f"deflection, {up.name}")
        clock = ax.text(0.99, 0.02, "", transform=ax.transAxes, ha="right")
        scaled = [(along.factor * x, up.factor * y, *style) for x, y, *style in lines]
        update = animation(ax, scaled, clock, texts)
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
        return update, range(len(texts))

    return animate
