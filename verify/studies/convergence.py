"""Frequency errors over the number of segments or elements: orders, grid convergence index, bound, solve times."""

from contextlib import suppress
from functools import partial
from itertools import pairwise
from math import log, log10
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

from msgspec import Meta

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache, comparable, theory_of, unproven
from verify.analysis.variants import Rules, Variant
from verify.errors import InputError, NoBracketError
from verify.linear.registry import MEAN, MODELS
from verify.problem.beam import Beam
from verify.report.plotting import PAPER, slope_guide
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Progress, Study
from verify.studies.charts import percent, si, variant_colors
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]
Row: TypeAlias = dict[str, Any]
STYLES = ("-o", "--s", ":^", "-.d", "-v")  # line and marker of each mode
NOTES = [
    "Order: from the size before. GCI: grid convergence index of this size and the two before, where all three are in "
    "the asymptotic range; factor of safety 1.25, observed order, at most the theoretical one. It is the uncertainty "
    "that a user without an exact solution would state. Extrapolated: error of Richardson's value from the same three.",
    "In range: the order at this size and at all larger ones is within 0.5 of the theoretical order (of the last "
    "observed order where theory gives none): the asymptotic range.",
    "Time: warm solve of all modes, assembly included, median of repeats.",
]
CAPTION = (
    "Filled markers: order from the size before in the asymptotic range. Dashed: slopes of the theoretical orders. The "
    "mean, of order 6, is drawn where segments and Hermite elements are of order 4."
)


class Convergence(Rules, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Frequency errors of a few modes over several sizes, every rule of the models side by side."""

    name: ClassVar[str] = "convergence"
    title: ClassVar[str] = "Convergence"

    modes: Annotated[Counts, Meta(description="Mode numbers, from 1.")] = (1, 3, 5)
    counts: Annotated[Counts, Meta(description="Numbers of segments and of elements.")] = (10, 20, 40, 80)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Solve every variant at every size and time it. Raises InputError for a size that cannot be solved."""
        models, left_out = comparable(cache.beam, self.counts, max(self.modes))
        variants = self.variants(models)
        rows = self._rows(cache, variants, progress)
        bounds, no_bound = self._bounds(cache)
        settled, warnings = self._summarise(cache, rows)
        margins = []
        for settings in dict.fromkeys(one.settings for one in variants):
            sizes = [(one.model, max(self.counts)) for one in variants if one.settings == settings]
            margins += beam_margins(cache, sizes, mode=max(self.modes), settings=settings)
        columns = [Column("mode"), Column("model"), Column("N"), Column("frequency", "Hz", ".8g"), percent("error")]
        columns += [Column("order", format=".2f"), Column("in range"), percent("GCI", ".3g")]
        columns += [percent("extrapolated", "+.3g"), si("solve time", "s", ".3g")]
        cells = [tuple(list(row.values())[:10]) for row in rows]
        rule = " with wall half" if "clamped" in cache.beam.supports else ""
        title, draw = "Frequency error over N", partial(self._draw_errors, cache, rows, [] if rule else bounds)
        tables = [Table(title, columns, cells, [*NOTES, *self._printed_joints(cache.beam)])]
        if bounds:
            columns = [Column("mode"), Column("N"), Column("lower", "Hz", ".8g"), Column("upper", "Hz", ".8g")]
            columns += [percent("width", ".4g"), percent("error of the mean")]
            bound = f"Two-sided bound: segments{rule} below, Hermite elements above"
            note = (
                "On a bare uniform beam of equal parts the exact frequency lies in it at every N, without a reference "
                "solution: without a clamped end, or with 2EI/l at the wall (wall half), where it is of order 2."
            )
            tables.append(Table(bound, columns, [tuple(row.values()) for row in bounds], [note]))
        errors = ", ".join(settled)
        return Result(
            summary=f"Mode {max(self.modes)}, N = {self.counts[-1]}, error: {errors}." if settled else "",
            tables=tables,
            figures=[Figure("errors-over-size", title, CAPTION, draw)],
            warnings=[*warnings, *no_bound, *left_out.values()],
            data={"rows": rows, "bounds": bounds},
            margins=margins,
        )

    def _rows(self, cache: "SolutionCache", variants: tuple[Variant, ...], progress: Progress) -> list[Row]:
        """A row for each mode, variant and size, in this order."""
        from verify.analysis.comparison import ORDER_FLOOR, ORDER_SPREAD, grid_convergence, relative_error

        seconds: dict[tuple[Variant, int], float] = {}
        for count in self.counts:
            progress(f"N = {count}")
            solves = []
            for one in variants:
                model, how = MODELS[one.model], dict(one.settings)
                n = min(max(self.modes), model.build(cache.beam, count, **how).n_elastic)
                cache.modes(one.model, count, n, one.settings)
                solves.append(lambda m=model, k=count, n=n, how=how: m.build(cache.beam, k, **how).modes(n))
            seconds |= zip(((one, count) for one in variants), interleaved_medians(solves), strict=True)
        rows: list[Row] = []
        for mode in self.modes:
            for one in variants:
                theory = one.expected_order(cache.beam)
                before: tuple[int, float] | None = None
                known: dict[int, float] = {}
                for count in self.counts:
                    error, why = cache.error_or_reason(one.model, count, mode, one.settings)
                    frequency = order = index = extrapolated = None
                    if error is not None:
                        frequency = cache.paired_frequency_hz(one.model, count, mode, one.settings)
                        # No order across a change of sign, nor at the rounding of the eigenvalues.
                        coarse = before is not None and min(abs(before[1]), abs(error)) >= ORDER_FLOOR
                        if before and coarse and before[0] != count and before[1] * error > 0.0:
                            order = log(before[1] / error) / log(count / before[0])
                        known[count] = frequency
                        with suppress(InputError):  # fewer than three sizes, or rounding
                            gci = grid_convergence(list(known)[-3:], list(known.values())[-3:], theory)
                            if gci.order is not None:
                                exact = cache.exact_hz(mode, theory_of(one.settings))
                                index, extrapolated = gci.index, relative_error(gci.extrapolated, exact)
                    row = {"mode": mode, "model": one.title, "N": count, "frequency_hz": frequency, "error": error}
                    time = None if error is None else seconds[one, count]
                    row |= {"order": order, "asymptotic": None, "gci": index, "extrapolated_error": extrapolated}
                    rows.append(row | {"run_time_s": time, "variant": one, "why": why})
                    before = None if error is None else (count, error)
                within, expected = True, theory
                for last, finer in reversed(list(pairwise(rows[-len(self.counts) :]))):
                    two, observed = (last["error"] or 0.0, finer["error"] or 0.0), finer["order"]
                    if observed is not None:
                        expected = observed if expected is None else expected
                        finer["asymptotic"] = within = within and abs(observed - expected) <= ORDER_SPREAD
                    elif two[0] * two[1] < 0.0 and min(map(abs, two)) >= ORDER_FLOOR:  # the error changes its sign
                        finer["asymptotic"] = within = False
                for last, finer in pairwise(rows[-len(self.counts) :]):  # three sizes in range: two orders
                    finer["gci"] = finer["gci"] if last["asymptotic"] and finer["asymptotic"] else None
        return rows

    def _printed_joints(self, beam: "Beam") -> list[str]:
        """A note on where joints as printed differ from those in series; none without printed joints."""
        import numpy as np

        from verify.linear.mesh import divide

        notes: dict[str, None] = {}
        for settings in self.combinations:
            if ("joints", "printed") in settings:
                parts = divide(beam, max(self.counts), float(dict(settings).get("grading", 1.0)))
                figures: Any = parts.second_moments, parts.moduli / parts.lengths
                changes = [abs(np.diff(np.log(v))) > 1e-9 for v in figures]
                at = parts.unit * np.cumsum(parts.lengths)[:-1][changes[0] & changes[1]]
                places = ", ".join(f"{x:.4g}" for x in at)
                where = f"at x = {places} m alone, where links of unlike I and of unlike material or length (E/l) meet"
                none = "nowhere, no links meet that are unlike in I and in material or length (E/l)"
                note = f"they differ from joints in series {where if places else none}."
                notes[f"Joints printed, N = {max(self.counts)}: {note}"] = None
        return list(notes)

    def _bounds(self, cache: "SolutionCache") -> tuple[list[Row], list[str]]:
        """(a row for each mode and size with a bound, why there are none elsewhere)."""
        rows: list[Row] = []
        reasons: dict[str, None] = {}
        settings = next((one for one in self.combinations if not unproven(cache.beam, one)), self.combinations[0])
        for mode in self.modes:
            for count in self.counts:
                try:
                    bound = cache.bracket(mode, count, settings)
                    mean = cache.frequency_error(MEAN, count, mode, settings)
                except NoBracketError as error:
                    reasons[f"No two-sided bound: {error}"] = None
                    continue
                except InputError:  # one of the models has no such mode, which its row says
                    continue
                row = {"mode": mode, "N": count, "lower_hz": bound.lower, "upper_hz": bound.upper}
                rows.append(row | {"width": (bound.upper - bound.lower) / bound.mean, "mean_error": mean})
        return rows, list(reasons)

    def _summarise(self, cache: "SolutionCache", rows: list[Row]) -> tuple[list[str], list[str]]:
        """(errors of the highest mode, marked outside the asymptotic range; warnings on orders outside of it)."""
        errors, warnings = [], dict.fromkeys(row["why"] for row in rows if row["why"])
        for one in dict.fromkeys(row["variant"] for row in rows):
            own = [row for row in rows if row["variant"] == one and row["mode"] == max(self.modes)]
            orders, last = [row for row in own if row["order"] is not None], own[-1]["error"]
            if last is None:
                continue
            if orders and all(row["asymptotic"] for row in orders[-2:]):
                errors.append(f"{one.title} {100 * last:+.4g} % (order {orders[-1]['order']:.2f})")
                continue
            observed = ", ".join(f"{row['order']:.2f}" for row in orders) or "none"
            errors.append(f"{one.title} {100 * last:+.4g} % (order {observed}: not asymptotic)")
            known = f"observed {observed}; {one.expected_order(cache.beam)}"
            warnings[f"{one.title}, mode {max(self.modes)}: order not converged ({known})."] = None
        return errors, list(warnings)

    def _draw_errors(self, cache: "SolutionCache", rows: list[Row], bounds: list[Row], ax: "Axes") -> None:
        from matplotlib.ticker import NullLocator

        from verify.analysis.comparison import ORDER_SPREAD

        mean, span = "#2a9d5c", log10(max(self.counts) / min(self.counts))
        colors = variant_colors(tuple(dict.fromkeys(row["variant"] for row in rows)))
        for mode, style in zip(self.modes, STYLES * len(self.modes), strict=False):
            first = mode == self.modes[0]
            for one, color in colors.items():
                own = [row for row in rows if row["variant"] == one and row["mode"] == mode and row["error"]]
                errors = [100 * abs(row["error"]) for row in own]
                begin = next((i for i, row in enumerate(own) if row["asymptotic"]), len(own))
                coarse, fine = slice(begin + 1), slice(begin, None)
                label, sizes = one.title if first else "", [row["N"] for row in own]
                ax.loglog(sizes[coarse], errors[coarse], style, color=color, label=label, markerfacecolor=PAPER)
                ax.loglog(sizes[fine], errors[fine], style, color=color)
            own = [row for row in bounds if row["mode"] == mode and row["mean_error"]]
            label, errors = "mean of both" if first and bounds else "", [100 * abs(row["mean_error"]) for row in own]
            ax.loglog([row["N"] for row in own], errors, style, color=mean, label=label)
            ax.plot([], [], style, color="#7d8590", label=f"mode {mode}")
        ax.set_xticks(self.counts, [str(count) for count in self.counts])
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set(xlabel="number of segments or elements N", ylabel="|frequency error|, %")
        ax.legend(ncols=2)
        solved = [row for row in rows if row["error"]]
        guides = {one.expected_order(cache.beam): [r for r in solved if r["variant"] == one] for one in colors}
        means = [row | {"error": row["mean_error"]} for row in bounds if row["mean_error"]]
        if len(means) > 1 and means[-1]["N"] > means[-2]["N"]:  # of the highest mode
            ratio, growth = (means[-2]["error"] / means[-1]["error"], means[-1]["N"] / means[-2]["N"])
            guides |= {6: means} if abs(log(abs(ratio)) / log(growth) - 6.0) <= ORDER_SPREAD else {}
        for order, own in guides.items():
            if order and own and span:
                slope_guide(ax, -order, (own[0]["N"], 250.0 * abs(own[0]["error"])), span)
