"""What the tables and charts of several studies share: columns, lines in suitable units."""

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from verify.analysis.variants import Variant
from verify.formatting import unit_over
from verify.linear.registry import MODELS
from verify.report.plotting import CYCLE, MODEL_COLORS
from verify.report.result import Column, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

THIN, BROAD = 1.4, 4.0  # widths of lines of discrete models, and of the exact beam below them
MOST_POINTS = 2000


def si(name: str, unit: str, form: str = ".4g") -> "Column":
    """A column of values that are shown with the SI prefix that suits the largest."""
    return Column(name, unit, form, prefix=True)


def percent(name: str, form: str = "+.4g") -> "Column":
    """A column of ratios that are shown in per cent."""
    return Column(name, format=form, percent=True)


def table(title: str, items: Iterable[Any], columns: "Mapping[Column, Callable[[Any], Any]]", *notes: str) -> "Table":
    """A row of each item; every column with the function that reads its value from an item."""
    return Table(title, list(columns), [[read(item) for read in columns.values()] for item in items], notes)


def sized_title(model: str, count: int | None) -> str:
    """'49 segments', 'exact beam'."""
    return f"{count} {MODELS[model].title}" if count else MODELS[model].title


def model_style(model: str) -> dict[str, Any]:
    """Colour and line width of a model in every chart."""
    color = MODEL_COLORS.get(model, MODELS[model].colour)
    return {"color": color, "linewidth": THIN if MODELS[model].sized else BROAD}


def variant_colors(variants: "tuple[Variant, ...]") -> "dict[Variant, str]":
    """The colour of a model for its first variant, others from the colour cycle."""
    colors: dict[Variant, str] = {}
    for one in variants:
        first = all(other.model != one.model for other in colors)
        colors[one] = model_style(one.model)["color"] if first else CYCLE[len(colors) % len(CYCLE)]
    return colors


def plot_lines(
    ax: "Axes", lines: Iterable[tuple[str, Any, Any, dict[str, Any]]], x: tuple[str, str], y: tuple[str, str]
) -> None:
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
