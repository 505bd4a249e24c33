"""Frequency errors over the number of segments or elements: orders, grid convergence index, bound, solve times."""

from contextlib import suppress
from functools import partial
from itertools import pairwise, product
from math import log, log10
from typing import Annotated, Any, TypeAlias

import numpy as np
from msgspec import Meta

from verify.analysis.comparison import ORDER_FLOOR, ORDER_SPREAD, grid_convergence, relative_error
from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache, comparable, theory_of, unproven
from verify.analysis.variants import Rules, Variant
from verify.analysis.verdict import missing
from verify.errors import InputError, NoBracketError
from verify.linear.mesh import divide
from verify.linear.registry import MEAN, MODELS
from verify.problem.beam import Beam
from verify.report.plotting import MODEL_COLORS, PAPER, slope_guide
from verify.report.result import Column, Figure, Result
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import percent, si, table, variant_colors
from verify.timing import interleaved_medians

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]
Row: TypeAlias = dict[str, Any]
Times: TypeAlias = dict[tuple[Variant, int], float]
STYLES = ("-o", "--s", ":^", "-.d", "-v")  # line and marker of each mode
NOTES = [
    "Order: from the size before. GCI: grid convergence index of this size and the two before, where all three are in "
    "the asymptotic range; factor of safety 1.25, observed order, at most the theoretical one. It is the uncertainty "
    "that a user without an exact solution would state. Extrapolated: error of Richardson's value from the same three.",
    "In range: the order at this size and at all larger ones is within 0.5 of the theoretical order (of the last "
    "observed order where theory gives none): the asymptotic range.",
    "Time: warm solve of all modes, assembly included, median of repeats.",
]
BOUND = (
    "On a bare uniform beam of equal parts the exact frequency lies in it at every N, without a reference solution: "
    "without a clamped end, or with 2EI/l at the wall (wall half), where it is of order 2."
)
ERRORS = {Column("mode"): "mode", Column("model"): "model", Column("N"): "N"}
ERRORS |= {Column("frequency", "Hz", ".8g"): "frequency_hz", percent("error"): "error"}
ERRORS |= {Column("order", format=".2f"): "order", Column("in range"): "asymptotic", percent("GCI", ".3g"): "gci"}
ERRORS |= {percent("extrapolated", "+.3g"): "extrapolated_error", si("solve time", "s", ".3g"): "run_time_s"}
BOUNDS = {Column("mode"): "mode", Column("N"): "N", Column("lower", "Hz", ".8g"): "lower_hz"}
BOUNDS |= {Column("upper", "Hz", ".8g"): "upper_hz", percent("width", ".4g"): "width"}
BOUNDS |= {percent("error of the mean"): "mean_error"}
UNLIKE = "where links of unlike I and of unlike material or length (E/l) meet"
ALIKE = "nowhere, no links meet that are unlike in I and in material or length (E/l)"
CAPTION = (
    "Filled markers: order from the size before in the asymptotic range. Dashed: slopes of the theoretical orders. The "
    "mean, of order 6, is drawn where segments and Hermite elements are of order 4."
)


class Convergence(Rules, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Frequency errors of a few modes over several sizes, every rule of the models side by side."""

    name, title = "convergence", "Convergence"
    reads = ()

    modes: Annotated[Counts, Meta(description="Mode numbers, from 1.")] = (1, 3, 5)
    counts: Annotated[Counts, Meta(description="Numbers of segments and of elements.")] = (10, 20, 40, 80)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Solve every variant at every size and time it. Raises InputError for a size that cannot be solved."""
        models, left_out = comparable(cache.beam, self.counts, max(self.modes))
        variants = self.variants(models)
        seconds = self._times(cache, variants, progress)
        rows = [row for mode, v in product(self.modes, variants) for row in self._series(cache, v, mode, seconds)]
        bounds, no_bound = self._bounds(cache)
        settled, warnings = self._summarise(cache, rows)
        margins = []
        for settings in dict.fromkeys(variant.settings for variant in variants):
            sizes = [(variant.model, max(self.counts)) for variant in variants if variant.settings == settings]
            margins += beam_margins(cache, sizes, mode=max(self.modes), settings=settings)
        reasons = [row["why"] for row in rows if row["why"]]
        margins += missing("errors", len(reasons), len(rows), next(iter(reasons), ""))
        rule = " with wall half" if "clamped" in cache.beam.supports else ""
        title, draw = "Frequency error over N", partial(self._draw_errors, cache, rows, [] if rule else bounds)
        tables = [table(title, rows, ERRORS, *NOTES, *self._printed_joints(cache.beam))]
        bound = f"Two-sided bound: segments{rule} below, Hermite elements above"
        return Result(
            summary=f"Mode {max(self.modes)}, N = {self.counts[-1]}, error: {', '.join(settled)}." if settled else "",
            tables=[*tables, *[table(bound, bounds, BOUNDS, BOUND)] * bool(bounds)],
            figures=[Figure("errors-over-size", title, CAPTION, draw)],
            warnings=[*warnings, *no_bound, *left_out.values()],
            data={"rows": rows, "bounds": bounds},
            margins=margins,
        )

    def _times(self, cache: SolutionCache, variants: tuple[Variant, ...], progress: Progress) -> Times:
        """Time of a warm solve of each variant at each size, s."""
        seconds: Times = {}
        for count in self.counts:
            progress(f"N = {count}")
            solves = []
            for variant in variants:
                build = partial(MODELS[variant.model].build, cache.beam, count, **dict(variant.settings))
                n = min(max(self.modes), build().n_elastic)
                cache.modes(variant.model, count, n, variant.settings)
                solves.append(lambda build=build, n=n: build().modes(n))
            seconds |= zip(((variant, count) for variant in variants), interleaved_medians(solves), strict=True)
        return seconds

    def _series(self, cache: SolutionCache, variant: Variant, mode: int, seconds: Times) -> list[Row]:
        """A row for each size of a variant at a mode."""
        rows: list[Row] = []
        theory, exact = variant.expected_order(cache.beam), cache.exact_hz(mode, theory_of(variant.settings))
        frequencies: dict[int, float] = {}
        coarser: tuple[int, float] | None = None
        for count in self.counts:
            error, why = cache.error_or_reason(variant.model, count, mode, variant.settings)
            row: Row = {"mode": mode, "model": variant.title, "N": count, "frequency_hz": None, "error": error}
            row |= dict.fromkeys(("order", "asymptotic", "gci", "extrapolated_error", "run_time_s"))
            if error is not None:
                hertz = cache.paired_frequency_hz(variant.model, count, mode, variant.settings)
                row |= {"frequency_hz": hertz, "run_time_s": seconds[variant, count]}
                frequencies[count] = hertz
                # No order across a change of sign, nor at the rounding of the eigenvalues.
                resolved = coarser is not None and min(abs(coarser[1]), abs(error)) >= ORDER_FLOOR
                if coarser and resolved and coarser[0] != count and coarser[1] * error > 0.0:
                    row["order"] = log(coarser[1] / error) / log(count / coarser[0])
                with suppress(InputError):  # fewer than three sizes, or rounding
                    gci = grid_convergence(list(frequencies)[-3:], list(frequencies.values())[-3:], theory)
                    if gci.order is not None:
                        row |= {"gci": gci.index, "extrapolated_error": relative_error(gci.extrapolated, exact)}
            rows.append(row | {"variant": variant, "why": why})
            coarser = None if error is None else (count, error)
        _mark_asymptotic(rows, theory)
        return rows

    def _printed_joints(self, beam: Beam) -> list[str]:
        """A note on where joints as printed differ from those in series; none without printed joints."""
        notes: dict[str, None] = {}
        for settings in (settings for settings in self.combinations if ("joints", "printed") in settings):
            parts = divide(beam, max(self.counts), float(dict(settings).get("grading", 1.0)))
            figures: Any = parts.second_moments, parts.moduli / parts.lengths
            changes = [abs(np.diff(np.log(v))) > 1e-9 for v in figures]
            places = parts.unit * np.cumsum(parts.lengths)[:-1][changes[0] & changes[1]]
            where = f"at x = {', '.join(f'{x:.4g}' for x in places)} m alone, {UNLIKE}" if len(places) else ALIKE
            notes[f"Joints printed, N = {max(self.counts)}: they differ from joints in series {where}."] = None
        return list(notes)

    def _bounds(self, cache: SolutionCache) -> tuple[list[Row], list[str]]:
        """(a row for each mode and size with a bound, why there are none elsewhere)."""
        rows: list[Row] = []
        reasons: dict[str, None] = {}
        proven = (settings for settings in self.combinations if not unproven(cache.beam, settings))
        settings = next(proven, self.combinations[0])
        for mode, count in product(self.modes, self.counts):
            try:
                bound = cache.bracket(mode, count, settings)
                error = cache.frequency_error(MEAN, count, mode, settings)
            except NoBracketError as problem:
                reasons[f"No two-sided bound: {problem}"] = None
                continue
            except InputError:  # one of the models has no such mode, which its row says
                continue
            row = {"mode": mode, "N": count, "lower_hz": bound.lower, "upper_hz": bound.upper}
            rows.append(row | {"width": (bound.upper - bound.lower) / bound.mean, "mean_error": error})
        return rows, list(reasons)

    def _summarise(self, cache: SolutionCache, rows: list[Row]) -> tuple[list[str], list[str]]:
        """(errors of the highest mode, marked outside the asymptotic range; warnings on orders outside of it)."""
        errors, warnings = [], dict[str, None]()
        highest = [row for row in rows if row["mode"] == max(self.modes)]
        for variant in dict.fromkeys(row["variant"] for row in rows):
            series = [row for row in highest if row["variant"] == variant]
            orders, finest = [row for row in series if row["order"] is not None], series[-1]["error"]
            if finest is None:
                continue
            text = f"{variant.title} {100 * finest:+.4g} %"
            if orders and all(row["asymptotic"] for row in orders[-2:]):
                errors.append(f"{text} (order {orders[-1]['order']:.2f})")
                continue
            observed = ", ".join(f"{row['order']:.2f}" for row in orders) or "none"
            errors.append(f"{text} (order {observed}: not asymptotic)")
            expected = f"observed {observed}; {variant.expected_order(cache.beam)}"
            warnings[f"{variant.title}, mode {max(self.modes)}: order not converged ({expected})."] = None
        return errors, list(warnings)

    def _draw_errors(self, cache: SolutionCache, rows: list[Row], bounds: list[Row], ax: Axes) -> None:
        from matplotlib.ticker import NullLocator

        rows, means = [row for row in rows if row["error"]], [row for row in bounds if row["mean_error"]]
        colors = variant_colors(tuple(dict.fromkeys(row["variant"] for row in rows)))
        for mode, style in zip(self.modes, STYLES * len(self.modes), strict=False):
            first = mode == self.modes[0]
            for variant, color in colors.items():
                series = [row for row in rows if row["variant"] == variant and row["mode"] == mode]
                sizes, errors = [row["N"] for row in series], [100 * abs(row["error"]) for row in series]
                begin = next((i for i, row in enumerate(series) if row["asymptotic"]), len(series))
                coarse, fine = slice(begin + 1), slice(begin, None)
                label = variant.title if first else ""
                ax.loglog(sizes[coarse], errors[coarse], style, color=color, label=label, markerfacecolor=PAPER)
                ax.loglog(sizes[fine], errors[fine], style, color=color)
            series = [row for row in means if row["mode"] == mode]
            label, errors = "mean of both" if first and bounds else "", [100 * abs(row["mean_error"]) for row in series]
            ax.loglog([row["N"] for row in series], errors, style, color=MODEL_COLORS[MEAN], label=label)
            ax.plot([], [], style, color="#7d8590", label=f"mode {mode}")
        ax.set_xticks(self.counts, [str(count) for count in self.counts])
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set(xlabel="number of segments or elements N", ylabel="|frequency error|, %")
        ax.legend(ncols=2)
        guides = {v.expected_order(cache.beam): [row for row in rows if row["variant"] == v] for v in colors}
        if len(means) > 1 and means[-1]["N"] > means[-2]["N"]:  # of the highest mode
            ratio, growth = (means[-2]["mean_error"] / means[-1]["mean_error"], means[-1]["N"] / means[-2]["N"])
            if abs(log(abs(ratio)) / log(growth) - 6.0) <= ORDER_SPREAD:
                guides[6] = [row | {"error": row["mean_error"]} for row in means]
        span = log10(max(self.counts) / min(self.counts))
        for order, series in guides.items():
            if order and series and span:
                slope_guide(ax, -order, (series[0]["N"], 250.0 * abs(series[0]["error"])), span)


def _mark_asymptotic(rows: list[Row], expected: int | None) -> None:
    """State of the rows of a series whether they are in the asymptotic range; drop indices outside of it."""
    within, order = True, expected
    for coarse, fine in reversed(list(pairwise(rows))):
        errors, observed = (coarse["error"] or 0.0, fine["error"] or 0.0), fine["order"]
        if observed is not None:
            order = observed if order is None else order
            fine["asymptotic"] = within = within and abs(observed - order) <= ORDER_SPREAD
        elif errors[0] * errors[1] < 0.0 and min(map(abs, errors)) >= ORDER_FLOOR:  # the error changes its sign
            fine["asymptotic"] = within = False
    for coarse, fine in pairwise(rows):  # three sizes in range: two orders
        fine["gci"] = fine["gci"] if coarse["asymptotic"] and fine["asymptotic"] else None
