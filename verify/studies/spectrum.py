"""Frequency errors of many modes at one size, beside what other beam theories change, and mode shapes."""

from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, ClassVar

from msgspec import Meta

from verify.errors import InputError
from verify.judge.variants import Rules, Variant
from verify.studies.base import Progress, Study, variant_colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.judge.cache import SolutionCache
    from verify.models.arrays import Array
    from verify.report.result import Figure, Result
    from verify.scene.model import Scene

MOST_COUNTED = 200
"""Modes up to which frequencies by other theories are computed where they have no closed form."""
THEORY_COLORS = {"rayleigh": "#8f5bd1", "timoshenko": "#cc3f76", "plate": "#008f8f"}


class Spectrum(Rules, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Frequency errors of modes 1 to `modes` at one size, every rule of the models side by side."""

    name: ClassVar[str] = "spectrum"
    title: ClassVar[str] = "Error spectrum"

    modes: Annotated[int, Meta(ge=1, le=10_000, description="Number of modes, from the first.")] = 22
    count: Annotated[int, Meta(ge=1, description="Number of segments and of elements.")] = 49

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Errors against the exact beam of the same theory. Raises InputError for a size that cannot be solved."""
        from verify.judge.compare import EIGENVALUE_FLOOR
        from verify.judge.workbench import comparable, theory_of
        from verify.report.result import Column, Figure, Result, Table
        from verify.words import theory_name

        progress(f"modes 1 to {self.modes}, N = {self.count}")
        models, left_out = comparable(cache.beam, (self.count,), self.modes)
        variants, numbers = self.variants(models), range(1, self.modes + 1)
        # The last mode first: one solve with the most modes then serves all.
        cells = {
            one: [cache.error_or_why(one.model, self.count, mode, one.settings) for mode in reversed(numbers)][::-1]
            for one in variants
        }
        errors = {one: [error for error, _ in own] for one, own in cells.items()}
        theories = self._theories(cache)
        theory = theory_of(variants[0].settings)
        columns = [Column("mode"), Column(f"exact {theory_name(theory)}", "Hz", ".7g")]
        columns += [Column(one.title, percent=True, format="+.4g") for one in variants]
        columns += [Column(f"{theory_name(name)} theory", percent=True, format="+.4g") for name in theories]
        rows = [
            (mode, cache.exact_hz(mode, theory), *(own[mode - 1] for own in (*errors.values(), *theories.values())))
            for mode in numbers
        ]
        parts = [(f"discretisation, {one.title}", own[-1]) for one, own in errors.items()]
        parts += [(f"theory, {theory_name(name)}", own[-1]) for name, own in theories.items()]
        parts += [("rounding of eigenvalues, at most", EIGENVALUE_FLOOR)]
        known = [f"{one.title} {100 * own[-1]:+.4g} %" for one, own in errors.items() if own[-1] is not None]
        warnings = [f"{one.title}: {own[-1][1]}" for one, own in cells.items() if own[-1][1]]
        largest = max((abs(own[-1]) for own in theories.values()), default=0.0)
        euler_alone = all(theory_of(one.settings) == "euler-bernoulli" for one in variants)
        if known and euler_alone and largest > max(abs(own[-1] or 0.0) for own in errors.values()):
            warnings.append(
                f"Mode {self.modes}: what Euler-Bernoulli theory neglects changes its frequency by up to "
                f"{100 * largest:.3g} %, more than the discretisation does."
            )
        return Result(
            summary=f"Mode {self.modes}, N = {self.count}, against the exact beam: {', '.join(known)}."
            if known
            else "",
            tables=[
                Table(f"Frequency errors, N = {self.count}", columns, rows),
                Table(
                    f"Contributions to the error of mode {self.modes}",
                    [Column("contribution"), Column("relative size", percent=True, format="+.3g")],
                    parts,
                    ["Theory: the change of the exact frequency against Euler-Bernoulli theory."],
                ),
            ],
            figures=[
                Figure(
                    "mode-errors",
                    f"Frequency error over mode number, N = {self.count}",
                    "Signed, against the exact beam of the same theory.",
                    lambda ax: draw_errors(ax, errors, {}),
                ),
                Figure(
                    "model-form",
                    f"Discretisation error and model-form error, N = {self.count}",
                    "Solid: discretisation. Dashed: what Euler-Bernoulli theory neglects, rotary inertia (Rayleigh), "
                    "shear as well (Timoshenko), bending across the width (Plate).",
                    lambda ax: draw_errors(ax, errors, theories),
                ),
                *self._shapes(cache, variants),
            ],
            warnings=[*warnings, *left_out.values()],
            data={
                "count": self.count,
                "errors": {one.label: own for one, own in errors.items()},
                "theories": theories,
            },
        )

    def _theories(self, cache: "SolutionCache") -> dict[str, list[float]]:
        """Relative change of each frequency by each other theory; those without a value on this beam are left out."""
        from verify.exact.plate_strip import plate_error
        from verify.options import THEORIES

        closed = cache.beam.supports == ("pinned", "pinned") and cache.beam.uniform
        if not closed and self.modes > MOST_COUNTED:
            return {}
        found, numbers = {}, range(1, self.modes + 1)
        for name in THEORIES[1:]:
            with suppress(InputError):
                found[name] = [cache.exact_hz(mode, name) / cache.exact_hz(mode) - 1.0 for mode in numbers]
        with suppress(InputError):
            found["plate"] = [plate_error(cache.beam, mode) for mode in numbers]
        return found

    def _shapes(self, cache: "SolutionCache", variants: tuple[Variant, ...]) -> "list[Figure]":
        """First, middle and last mode above one another; no figure where exact shapes are not available."""
        import numpy as np

        from verify.exact.modes import mode_shape
        from verify.judge.workbench import theory_of
        from verify.models.catalogue import MODELS
        from verify.report.plotting import MODEL_COLORS
        from verify.report.result import Figure

        theory = theory_of(variants[0].settings)
        chosen = sorted({1, (self.modes + 1) // 2, self.modes})
        x = np.linspace(0.0, cache.beam.length, 40 * self.modes + 1)
        shown = {one.model: one for one in reversed(variants) if theory_of(one.settings) == theory}
        points: list[tuple[str, str, Array, list[Array]]] = []
        try:
            exact = [mode_shape(cache.beam, mode, x, theory=theory) for mode in chosen]
            for model, one in shown.items():
                modes = cache.modes(model, self.count, self.modes, one.settings)
                index = [cache.paired_index(model, self.count, mode, one.settings) for mode in chosen]
                for reading, read in modes.readings.items():
                    label = f"{MODELS[model].title}, {reading}" if len(modes.readings) > 1 else MODELS[model].title
                    color = MODEL_COLORS.get(model, MODELS[model].colour)
                    points.append((label, color, modes.nodes, [read()[k] for k in index]))
        except InputError:
            return []

        def draw(ax: "Axes") -> None:
            step = 2.4 * max(float(np.abs(one).max()) for one in exact)
            for i, one in enumerate(exact):
                ax.plot(
                    x, one + step * i, color=MODEL_COLORS["analytic"], linewidth=1.2, label="" if i else "exact beam"
                )
            for (label, color, nodes, shapes), marker in zip(points, ("x", "o", "s", "+", "d", "^"), strict=False):
                for i, shape in enumerate(shapes):
                    text = "" if i else label
                    ax.plot(nodes, shape + step * i, marker, color=color, fillstyle="none", markersize=4.0, label=text)
            ax.set(xlabel="x, m", yticks=[step * i for i in range(len(chosen))])
            ax.set_yticklabels([f"mode {mode}" for mode in chosen])
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)

        caption = (
            "Normalised to the same modal mass. Lines: exact. Markers: joints or element ends; the joints of a chain "
            "raw, and corrected (y + second difference / 12)."
        )
        return [Figure("mode-shapes", f"Mode shapes, N = {self.count}", caption, draw, (6.4, 5.2))]


def draw_errors(ax: "Axes", errors: "dict[Variant, list[float | None]]", theories: "dict[str, list[float]]") -> None:
    """Errors in per cent over mode number: signed alone, as absolute values on a logarithmic axis beside theories."""
    from verify.words import theory_name

    def values(own: "list[float] | list[float | None]") -> list[float]:
        return [float("nan") if v is None else 100 * (abs(v) if theories else v) for v in own]

    for one, color in variant_colors(tuple(errors)).items():
        ax.plot(range(1, len(errors[one]) + 1), values(errors[one]), "-o", color=color, label=one.title, markersize=3.5)
    for name, own in theories.items():
        color = THEORY_COLORS[name]
        ax.plot(range(1, len(own) + 1), values(own), "--", color=color, label=f"{theory_name(name)} theory")
    ax.set(xlabel="mode number", ylabel="|frequency error|, %" if theories else "frequency error, %")
    if theories:
        ax.set_yscale("log")
    ax.legend()
