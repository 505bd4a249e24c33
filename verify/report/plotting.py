"""Charts as SVG and PNG, movies as animated images: colours and style for both, in one place.

Studies draw on the `Axes` that they receive, in `MODEL_COLORS` and the colour cycle. Colours of text, axes and paper
are placeholders that `figure_files` turns into CSS variables, so that one SVG serves light and dark pages.
"""

import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from html import escape
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure

    from verify.report.result import Figure, Movie

MODEL_COLORS = {"analytic": "#7d8590", "segment": "#2f80ed", "fem": "#d96c05", "mean": "#2a9d5c"}
"""Colour of each model, the same in all charts; every one has a contrast of 3:1 on white and on dark."""
CYCLE = ("#8f5bd1", "#cc3f76", "#008f8f", "#a67c00", "#9a6a45", "#5f7fa8", "#4f9a34", "#b3559f")
"""Colours of lines that belong to no model."""
MARKERS = "osD^vPX*"  # markers of curves by colour, in the order in which they are drawn
INK, GRID, PAPER, EVEN = "#010203", "#d0d4da", "#fefdfc", "#7f8388"
"""Text and axes, grid, background of legends; ink of movies, which reads on light and on dark."""
VARIABLES = {INK: "currentColor", "#000000": "currentColor", GRID: f"var(--grid, {GRID})", PAPER: "var(--card, #fff)"}
MovingLine: TypeAlias = tuple[Any, Any, str, Mapping[str, Any]]
"""x (points,) or (frames, points), y (frames, points), line and marker, further settings."""
NO_METADATA = {"Creator": None, "Date": None, "Format": None, "Type": None}


@contextmanager
def style(ink: str = INK, salt: str = "verify") -> Iterator[None]:
    """Matplotlib's settings for all charts, within the context."""
    import matplotlib as mpl
    from cycler import cycler

    inked = ("axes.edgecolor", "axes.labelcolor", "text.color", "xtick.color", "ytick.color")
    settings: Any = dict.fromkeys(inked, ink)
    settings |= {"axes.facecolor": "none", "figure.facecolor": "none", "savefig.facecolor": "none"}
    settings |= {"axes.prop_cycle": cycler(color=CYCLE), "axes.grid": True, "grid.linewidth": 0.6}
    settings |= {"grid.color": GRID} if ink == INK else {"grid.color": ink, "grid.alpha": 0.3}
    settings |= {"axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": 10.0, "font.size": 10.0}
    paper = PAPER if ink == INK else "none"
    settings |= {"legend.facecolor": paper, "legend.edgecolor": "none", "legend.framealpha": 0.8}
    settings |= {"lines.linewidth": 1.6, "lines.markersize": 4.5, "legend.fontsize": 9.0}
    settings |= {"axes.formatter.limits": (-4, 5), "axes.formatter.useoffset": False}
    settings |= {"svg.fonttype": "none", "svg.hashsalt": salt}
    with mpl.rc_context(settings):
        yield


def slope_guide(ax: "Axes", slope: float, at: tuple[float, float], decades: float = 0.7) -> None:
    """Draw a dashed line of this slope from `at` on logarithmic axes, with the order as its label."""
    x, y = at
    far = x * 10.0**decades
    ends = [y, y * (far / x) ** slope]
    ax.plot([x, far], ends, color=INK, linestyle=(0, (4, 3)), linewidth=1.0, alpha=0.7, gid="guide")
    middle = (x * 10.0 ** (decades / 2), y * 10.0 ** (slope * decades / 2))
    ax.annotate(f"order {abs(slope):g}", middle, (5, 5), textcoords="offset points", fontsize=8.5)


def drawn(figure: "Figure") -> "MatplotlibFigure":
    """The chart as a matplotlib figure; call it and save it within `style`."""
    from matplotlib.figure import Figure as MatplotlibFigure

    canvas = MatplotlibFigure(figsize=figure.size, layout="constrained")
    figure.draw(canvas.subplots())
    for ax in canvas.axes:
        ax.set_axisbelow(True)
        for mesh in ax.collections:
            mesh.set_rasterized(type(mesh).__name__ == "QuadMesh")
        distinguish(ax, figure.size)
    return canvas


def distinguish(ax: "Axes", size: tuple[float, float]) -> None:
    """Separate curves by more than colour: markers, a wider first curve, and names at their ends.

    Line styles keep the meaning that a study assigns to them. Where the ends of curves coincide, or a legend has
    entries that are no curves, the names stand in a legend above the axes.
    """
    from matplotlib.colors import to_hex

    curves: list[Any] = [line for line in ax.lines if line.get_linestyle() != "None" and line.get_gid() != "guide"]
    named = [line for line in curves if line.get_label()[:1] not in ("", "_")]
    colours = list(dict.fromkeys(to_hex(line.get_color()) for line in named if len(line.get_xdata()) > 1))
    colours = [one for one in colours if one not in (INK, MODEL_COLORS["analytic"])]
    for line in curves if len(colours) > 1 else ():
        if (colour := to_hex(line.get_color())) in colours:
            rank, many = colours.index(colour), len(line.get_xdata()) > 30
            if line.get_marker() == "None" and line in named:
                line.set(marker=MARKERS[rank % 8], markevery=(0.03 + 0.04 * (rank % 4), 0.16) if many else None)
            if rank == 0:  # shows below an equal curve
                line.set(linewidth=line.get_linewidth() + 1.1, markersize=7.0)
    names = ax.get_legend_handles_labels()[1]
    if (legend := ax.get_legend()) is None or not names:
        return
    ax.autoscale_view()
    to_axes = (ax.transData + ax.transAxes.inverted()).transform
    lasts = [(line.get_xydata()[-1], line) for line in named if len(line.get_xydata()) > 1]
    ends = [(to_axes(last), last, line) for last, line in lasts if np.isfinite(last).all()]
    ends.sort(key=lambda end: float(end[0][1]))
    high = np.array([54.0 * size[1] * place[1] for place, *_ in ends])  # points: axes fill 3/4 of the chart
    step = 12.0 * np.arange(len(ends))
    low = np.maximum.accumulate(high - step) + step  # at least a line of text apart
    shift = low - high - 0.5 * (low - high).max(initial=0.0)
    direct = len(ends) == len(names) <= 6 and all(place[0] > 0.85 for place, *_ in ends)
    if direct and abs(shift).max() <= 14.0 and np.diff(high).min(initial=12.0) > 2.0:
        legend.remove()
        for (_, end, line), up in zip(ends, shift, strict=True):
            place: Any = {"xytext": (14, up), "textcoords": "offset points", "va": "center", "fontsize": 9.0}
            arrow = {"arrowstyle": "-", "color": line.get_color(), "shrinkA": 0.0, "shrinkB": 0.0}
            ax.annotate(line.get_label(), end, **place, arrowprops=arrow)
    else:
        columns = min(max(int(12.0 * size[0] / (max(map(len, names)) + 6.0)), 1), 4)
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.2, frameon=False)


def figure_files(figure: "Figure", dpi: float = 160.0) -> tuple[str, bytes]:
    """The chart, drawn once, as an SVG element without scripts and as a PNG in black on white (empty for dpi = 0).

    Colours of text and axes in the SVG follow the page: they are CSS variables. Ids are prefixed with the figure's id,
    so that several stand on one page. Its role is img, its accessible name the title and caption.
    """
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from PIL import Image

    out, raw, small = io.StringIO(), io.BytesIO(), io.BytesIO()
    with style(salt=figure.id):  # not by savefig, which draws twice: the layout engine runs in either draw
        chart = drawn(figure)
        vector: Any = FigureCanvasSVG(chart)
        vector.print_svg(out, metadata=NO_METADATA)
        if dpi:
            chart.set_layout_engine("none")
            chart.savefig(raw, format="png", dpi=dpi, facecolor="white")
            palette = Image.open(raw).convert("RGB").quantize(128, dither=Image.Dither.NONE)
            palette.save(small, "png", dpi=(dpi, dpi))  # a third of the size of all colours
    svg = out.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", svg, count=1, flags=re.DOTALL)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{figure.id}-", svg)
    svg = re.sub(r"'DejaVu Sans'[^;\"]*", "'DejaVu Sans', Verdana, sans-serif", svg)
    for colour, variable in VARIABLES.items():
        svg = svg.replace(colour, variable)
    name = escape(f"{figure.title}. {figure.caption}", quote=True)
    svg = svg.replace("<svg ", f'<svg role="img" aria-label="{name}" stroke-linejoin="round" ', 1)
    return svg, small.getvalue()


def animation(ax: "Axes", lines: Sequence[MovingLine], clock: Any, texts: Sequence[str]) -> Callable[[int], list[Any]]:
    """What moves lines on prepared axes to a frame and shows its text in the artist `clock`, for `Movie.animate`."""
    artists = [ax.plot([], [], form, **style)[0] for *_, form, style in lines]

    def update(frame: int) -> list[Any]:
        for artist, (x, y, *_) in zip(artists, lines, strict=True):
            artist.set_data(x[frame] if x.ndim > 1 else x, y[frame])
        clock.set_text(texts[frame])
        return [*artists, clock]

    return update


def movie_frames(movie: "Movie", dpi: float = 90.0, ink: str = EVEN, paper: str = "none") -> list[Any]:
    """The movie's pictures (pillow, RGBA), of which only the artists that move are drawn anew."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as MatplotlibFigure
    from PIL import Image

    pictures: list[Any] = []
    with style(ink):
        figure = MatplotlibFigure(figsize=(6.4, 3.8), dpi=dpi, layout="constrained", facecolor=paper)
        canvas: Any = FigureCanvasAgg(figure)
        update, frames = movie.animate(canvas.figure.subplots())
        for artist in update(0):
            artist.set_animated(True)
        canvas.draw()
        still = canvas.copy_from_bbox(canvas.figure.bbox)
        for frame in frames:
            canvas.restore_region(still)
            for artist in update(frame):
                canvas.figure.draw_artist(artist)
            pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba()).copy()))
    return pictures


def movie_image(movie: "Movie") -> tuple[bytes, bytes]:
    """The movie for a page: (animated WebP that repeats, its first frame as WebP), transparent, for light and dark."""
    # a third of the size for lines
    few = [frame.quantize(32, method=2).convert("RGBA") for frame in movie_frames(movie)]
    moving, still = io.BytesIO(), io.BytesIO()
    settings = {"format": "webp", "lossless": True, "quality": 50, "method": 2}
    few[0].save(still, **settings)
    few[0].save(moving, **settings, save_all=True, append_images=few[1:], duration=60, loop=0)
    return moving.getvalue(), still.getvalue()
