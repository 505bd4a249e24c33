"""Frequency errors of many modes at one size, beside what other beam theories change, and mode shapes."""

from contextlib import suppress
from functools import partial
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from verify.analysis.margins import beam_margins, marked, sufficient_count
from verify.analysis.solution_cache import SolutionCache, comparable, theory_of
from verify.analysis.variants import Rules, Variant
from verify.analysis.verdict import Margin, missing
from verify.arrays import Array
from verify.errors import InputError
from verify.exact.plate import plate_error
from verify.formatting import theory_name
from verify.linear.registry import MODELS
from verify.report.result import Column, Figure, Result, Table
from verify.settings import THEORIES
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import model_style, percent, variant_colors

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

    name, title = "spectrum", "Error spectrum"
    reads = ()

    modes: Annotated[int, Meta(ge=1, le=10_000, description="Number of modes, from the first.")] = 22
    count: Annotated[int, Meta(ge=1, description="Segments and elements; by default within 1 %.")] | None = None

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Errors against the exact beam of the same theory. Raises InputError for a size that cannot be solved."""
        count = self.count or sufficient_count(cache, modes=self.modes)
        progress(f"modes 1 to {self.modes}, N = {count}")
        models, left_out = comparable(cache.beam, (count,), self.modes)
        variants, numbers = self.variants(models), range(1, self.modes + 1)
        errors: dict[Variant, list[float | None]] = {}
        absent, ends = list[Margin](), list[str]()
        for variant in variants:
            # The last mode first: one solve with the most modes then serves all.
            cells = [cache.error_or_reason(variant.model, count, n, variant.settings) for n in reversed(numbers)][::-1]
            errors[variant] = [error for error, _ in cells]
            error, reason = cells[-1]
            absent += missing(f"errors of {variant.title}", errors[variant].count(None), self.modes, reason)
            ends += [] if error is None else [f"{variant.title} {100 * error:+.4g} %"]
        theories, theory, settings = self._theories(cache), theory_of(variants[0].settings), variants[0].settings
        exact = [cache.exact_hz(n, theory) for n in numbers]
        rows = zip(numbers, exact, *errors.values(), *theories.values(), strict=True)
        columns = [Column("mode"), Column(f"exact {theory_name(theory)}", "Hz", ".7g")]
        columns += [percent(v.title) for v in variants] + [percent(f"{theory_name(t)} theory") for t in theories]
        note = "Theory: change of the exact frequency against Euler-Bernoulli theory."
        sizes = [(variant.model, count) for variant in variants if variant.settings == settings]
        margins = beam_margins(cache, sizes, mode=self.modes, settings=settings) + absent
        size, draw = f"N = {count}", partial(draw_errors, errors, theories)
        title = marked(f"Frequency error over mode number, {size}", margins)
        return Result(
            summary=f"Mode {self.modes}, {size}, against the exact beam: {', '.join(ends)}." if ends else "",
            tables=[Table(f"Frequency errors, {size}", columns, list(rows), [note] * bool(theories))],
            figures=[
                Figure("mode-errors", title, CAPTIONS["mode-errors"], draw),
                *self._shapes(cache, variants, count),
            ],
            warnings=list(left_out.values()),
            data={"count": count, "errors": {v.label: series for v, series in errors.items()}, "theories": theories},
            margins=margins,
        )

    def _theories(self, cache: SolutionCache) -> dict[str, list[float]]:
        """Relative change of each frequency by each other theory; those without a value on this beam are left out."""
        closed = cache.beam.supports == ("pinned", "pinned") and cache.beam.uniform
        if not closed and self.modes > MOST_COUNTED:
            return {}
        changes, numbers = {}, range(1, self.modes + 1)
        for name in THEORIES[1:]:
            with suppress(InputError):
                changes[name] = [cache.exact_hz(mode, name) / cache.exact_hz(mode) - 1.0 for mode in numbers]
        if closed or self.modes <= MOST_PLATES:
            with suppress(InputError):
                changes["plate"] = [plate_error(cache.beam, mode) for mode in numbers]
        return changes

    def _shapes(self, cache: SolutionCache, variants: tuple[Variant, ...], count: int) -> list[Figure]:
        """First, middle and last mode above one another; no figure where exact shapes are not available."""
        theory = theory_of(variants[0].settings)
        chosen = sorted({1, (self.modes + 1) // 2, self.modes})
        x = np.linspace(0.0, cache.beam.length, 40 * self.modes + 1)
        lines: list[tuple[str, str, dict[str, Any], Array, list[Array]]] = []
        try:
            exact = [cache.exact_shape(mode, x, theory=theory) for mode in chosen]
            style = {"color": model_style("analytic")["color"], "linewidth": 1.2}
            lines.append((MODELS["analytic"].title, "-", style, x, exact))
            markers = iter("xos+d^")
            for model, variant in {v.model: v for v in reversed(variants) if theory_of(v.settings) == theory}.items():
                modes = cache.modes(model, count, self.modes, variant.settings)
                index = [cache.paired_index(model, count, mode, variant.settings) for mode in chosen]
                style = {"color": model_style(model)["color"], "fillstyle": "none", "markersize": 4.0}
                for reading, read in modes.readings.items():
                    label = f"{MODELS[model].title}, {reading}" if len(modes.readings) > 1 else MODELS[model].title
                    lines.append((label, next(markers), style, modes.nodes, [read()[k] for k in index]))
        except InputError:
            return []

        def draw(ax: Axes) -> None:
            step = 2.4 * max(float(np.abs(shape).max()) for shape in exact)
            for label, form, style, places, shapes in lines:
                for i, shape in enumerate(shapes):
                    ax.plot(places, shape + step * i, form, label="" if i else label, **style)
            ax.set(xlabel="x, m", yticks=[step * i for i in range(len(chosen))])
            ax.set_yticklabels([f"mode {mode}" for mode in chosen])
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)

        return [Figure("mode-shapes", f"Mode shapes, N = {count}", CAPTIONS["mode-shapes"], draw, (6.4, 5.2))]


def draw_errors(errors: dict[Variant, list[float | None]], theories: dict[str, list[float]], ax: Axes) -> None:
    """Sizes of the errors over mode number, beside what other theories change."""
    colors = variant_colors(tuple(errors))
    lines: list[Any] = [(v.title, "-o", {"color": colors[v], "markersize": 3.5}, errors[v]) for v in errors]
    lines += [(f"{theory_name(t)} theory", "--", {"color": THEORY_COLORS[t]}, theories[t]) for t in theories]
    for label, form, style, series in lines:
        sizes = [float("nan") if value is None else 100 * abs(value) for value in series]
        ax.plot(range(1, len(sizes) + 1), sizes, form, label=label, **style)
    ax.set(xlabel="mode number", ylabel="|frequency error|, %", yscale="log")
    ax.legend()
