"""Frequency errors of many modes at one size, beside what other beam theories change, and mode shapes."""

from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Annotated, ClassVar

from msgspec import Meta

from verify.analysis.margins import beam_margins, marked, sufficient_count
from verify.analysis.solution_cache import SolutionCache, comparable, theory_of
from verify.analysis.variants import Rules, Variant
from verify.errors import InputError
from verify.exact.plate import plate_error
from verify.formatting import theory_name
from verify.linear.registry import MODELS
from verify.report.result import Column, Figure, Result, Table
from verify.settings import THEORIES
from verify.studies.base import Progress, Study
from verify.studies.charts import model_style, percent, variant_colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.arrays import Array
    from verify.scene.model import Scene

MOST_COUNTED = 200  # modes up to which frequencies by other theories are computed where they have no closed form
MOST_PLATES = 60  # the same for plate theory, about 0.1 s a mode
THEORY_COLORS = {"rayleigh": "#8f5bd1", "timoshenko": "#cc3f76", "plate": "#008f8f"}
CAPTIONS = {
    "mode-errors": "Solid: against the exact beam of the same theory. Dashed: what Euler-Bernoulli theory neglects, "
    "rotary inertia (Rayleigh), shear as well (Timoshenko), bending across the width (Plate).",
    "mode-shapes": "Normalised to the same modal mass. Lines: exact. Markers: joints or element ends; the joints of a "
    "chain raw, and corrected (y + second difference / 12).",
}


class Spectrum(Rules, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Frequency errors of modes 1 to `modes` at one size, every rule of the models side by side."""

    name: ClassVar[str] = "spectrum"
    title: ClassVar[str] = "Error spectrum"

    modes: Annotated[int, Meta(ge=1, le=10_000, description="Number of modes, from the first.")] = 22
    count: Annotated[int, Meta(ge=1, description="Segments and elements; by default within 1 %.")] | None = None

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Errors against the exact beam of the same theory. Raises InputError for a size that cannot be solved."""
        count = self.count or sufficient_count(cache, modes=self.modes)
        progress(f"modes 1 to {self.modes}, N = {count}")
        models, left_out = comparable(cache.beam, (count,), self.modes)
        variants, numbers = self.variants(models), range(1, self.modes + 1)
        errors: dict[Variant, list[float | None]] = {}
        warnings = []
        for one in variants:
            # The last mode first: one solve with the most modes then serves all.
            cells = [cache.error_or_reason(one.model, count, mode, one.settings) for mode in reversed(numbers)][::-1]
            errors[one] = [error for error, _ in cells]
            warnings += [f"{one.title}: {cells[-1][1]}"] if cells[-1][1] else []
        theories, theory = self._theories(cache), theory_of(variants[0].settings)
        series: list[Sequence[float | None]] = [*errors.values(), *theories.values()]
        rows = [(mode, cache.exact_hz(mode, theory), *(own[mode - 1] for own in series)) for mode in numbers]
        known = {one.title: own[-1] for one, own in errors.items() if own[-1] is not None}
        own = dict(variants[0].settings)
        sizes = [(one.model, count) for one in variants if dict(one.settings) == own]
        margins = beam_margins(cache, sizes, mode=self.modes, settings=variants[0].settings)
        summary = ", ".join(f"{name} {100 * error:+.4g} %" for name, error in known.items())
        columns = [Column("mode"), Column(f"exact {theory_name(theory)}", "Hz", ".7g")]
        columns += [percent(one.title) for one in variants] + [percent(f"{theory_name(t)} theory") for t in theories]
        note = "Theory: change of the exact frequency against Euler-Bernoulli theory."
        size, draw = f"N = {count}", partial(draw_errors, errors, theories)
        title = marked(f"Frequency error over mode number, {size}", margins)
        shapes = self._shapes(cache, variants, count)
        return Result(
            summary=f"Mode {self.modes}, {size}, against the exact beam: {summary}." if known else "",
            tables=[Table(f"Frequency errors, {size}", columns, rows, [note] * bool(theories))],
            figures=[Figure("mode-errors", title, CAPTIONS["mode-errors"], draw), *shapes],
            warnings=[*warnings, *left_out.values()],
            data={"count": count, "errors": {one.label: own for one, own in errors.items()}, "theories": theories},
            margins=margins,
        )

    def _theories(self, cache: "SolutionCache") -> dict[str, list[float]]:
        """Relative change of each frequency by each other theory; those without a value on this beam are left out."""
        closed = cache.beam.supports == ("pinned", "pinned") and cache.beam.uniform
        if not closed and self.modes > MOST_COUNTED:
            return {}
        found, numbers = {}, range(1, self.modes + 1)
        for name in THEORIES[1:]:
            with suppress(InputError):
                found[name] = [cache.exact_hz(mode, name) / cache.exact_hz(mode) - 1.0 for mode in numbers]
        if closed or self.modes <= MOST_PLATES:
            with suppress(InputError):
                found["plate"] = [plate_error(cache.beam, mode) for mode in numbers]
        return found

    def _shapes(self, cache: "SolutionCache", variants: tuple[Variant, ...], count: int) -> "list[Figure]":
        """First, middle and last mode above one another; no figure where exact shapes are not available."""
        import numpy as np

        theory = theory_of(variants[0].settings)
        chosen = sorted({1, (self.modes + 1) // 2, self.modes})
        x = np.linspace(0.0, cache.beam.length, 40 * self.modes + 1)
        shown = {one.model: one for one in reversed(variants) if theory_of(one.settings) == theory}
        points: list[tuple[str, str, Array, list[Array]]] = []
        try:
            exact = [cache.exact_shape(mode, x, theory=theory) for mode in chosen]
            for model, one in shown.items():
                modes = cache.modes(model, count, self.modes, one.settings)
                index = [cache.paired_index(model, count, mode, one.settings) for mode in chosen]
                for reading, read in modes.readings.items():
                    label = f"{MODELS[model].title}, {reading}" if len(modes.readings) > 1 else MODELS[model].title
                    points.append((label, model_style(model)["color"], modes.nodes, [read()[k] for k in index]))
        except InputError:
            return []

        def draw(ax: "Axes") -> None:
            step = 2.4 * max(float(np.abs(one).max()) for one in exact)
            color = model_style("analytic")["color"]
            for i, one in enumerate(exact):
                ax.plot(x, one + step * i, color=color, linewidth=1.2, label="" if i else MODELS["analytic"].title)
            for (label, color, nodes, shapes), marker in zip(points, "xos+d^", strict=False):
                for i, shape in enumerate(shapes):
                    text = "" if i else label
                    ax.plot(nodes, shape + step * i, marker, color=color, fillstyle="none", markersize=4.0, label=text)
            ax.set(xlabel="x, m", yticks=[step * i for i in range(len(chosen))])
            ax.set_yticklabels([f"mode {mode}" for mode in chosen])
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)

        return [Figure("mode-shapes", f"Mode shapes, N = {count}", CAPTIONS["mode-shapes"], draw, (6.4, 5.2))]


def draw_errors(errors: dict[Variant, list[float | None]], theories: dict[str, list[float]], ax: "Axes") -> None:
    """Sizes of the errors over mode number, beside what other theories change."""

    def values(own: "list[float] | list[float | None]") -> list[float]:
        return [float("nan") if v is None else 100 * abs(v) for v in own]

    for one, color in variant_colors(tuple(errors)).items():
        ax.plot(range(1, len(errors[one]) + 1), values(errors[one]), "-o", color=color, label=one.title, markersize=3.5)
    for name, own in theories.items():
        label = f"{theory_name(name)} theory"
        ax.plot(range(1, len(own) + 1), values(own), "--", color=THEORY_COLORS[name], label=label)
    ax.set(xlabel="mode number", ylabel="|frequency error|, %", yscale="log")
    ax.legend()
