"""Frequency errors over the number of segments or elements: observed orders, two-sided bound, solve times."""

from functools import partial
from math import log, log10
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

from msgspec import Meta

from verify.errors import InputError, NoBracketError
from verify.judge.variants import Rules, Variant
from verify.studies.base import Progress, Study, variant_colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.judge.cache import SolutionCache
    from verify.report.result import Result
    from verify.scene.model import Scene

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]
Row: TypeAlias = dict[str, Any]
ORDER_TOLERANCE = 1.0
"""Distance of an observed order from the theoretical one up to which sizes count as asymptotic."""
STYLES = ("-o", "--s", ":^", "-.d", "-v")
"""Line and marker of each mode."""


class Convergence(Rules, Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Frequency errors of a few modes over several sizes, every rule of the models side by side."""

    name: ClassVar[str] = "convergence"
    title: ClassVar[str] = "Convergence"

    modes: Annotated[Counts, Meta(description="Mode numbers, from 1.")] = (1, 5, 22)
    counts: Annotated[Counts, Meta(description="Numbers of segments and of elements.")] = (10, 20, 49, 98)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Solve every variant at every size and time it. Raises InputError for a size that cannot be solved."""
        from verify.judge.cache import comparable
        from verify.report.result import Column, Figure, Result, Table

        models, left_out = comparable(cache.beam, self.counts, max(self.modes))
        variants = self.variants(models)
        rows = self._rows(cache, variants, progress)
        bounds, no_bound = self._bounds(cache)
        joints = self._joint_models(cache, variants)
        settled, warnings = self._summarise(cache, rows)
        numbers = [Column("frequency", "Hz", ".8g"), Column("error", percent=True, format="+.4g")]
        numbers += [Column("order", format=".2f"), Column("solve time", "s", ".3g", prefix=True)]
        error_table = Table(
            "Frequency error over N",
            [Column("mode"), Column("model"), Column("N"), *numbers],
            [tuple(list(row.values())[:7]) for row in rows],
            ["Order: from the size before. Time: warm solve of all modes, set-up included, median of repeats."],
        )
        bound_table = Table(
            "Two-sided bound: segments below, Hermite elements above",
            [
                *(Column("mode"), Column("N"), Column("lower", "Hz", ".8g"), Column("upper", "Hz", ".8g")),
                *(
                    Column("width", percent=True, format=".4g"),
                    Column("error of the mean", percent=True, format="+.4g"),
                ),
            ],
            [tuple(row.values()) for row in bounds],
        )
        joint_table = Table(
            f"Joint models of the chain, mode {max(self.modes)}",
            [Column("N"), *(Column(one.title, percent=True, format="+.4g") for one in joints)],
            list(zip(self.counts, *joints.values(), strict=True)),
        )
        sizes = Figure(
            "errors-over-size",
            "Convergence with the number of segments or elements",
            "Dashed: slopes of the theoretical orders. The mean is of order 6 where the leading errors of segments and "
            "Hermite elements cancel.",
            lambda ax: self._draw_errors(ax, cache, rows, bounds),
            (6.4, 4.8),
        )
        work = Figure(
            "work-precision",
            "Frequency error over solve time",
            "Warm solve from beam to modes, set-up included, median of interleaved repeats. Numbers: N.",
            lambda ax: self._draw_work(ax, rows),
        )
        bracket = Figure(
            "bracket",
            f"Two-sided bound on mode {max(self.modes)}",
            "The exact frequency (zero) lies in the band for every N; no reference solution is needed for that.",
            lambda ax: self._draw_bound(ax, cache, bounds),
        )
        rules = Figure(
            "joint-models",
            f"Joint models of the chain, mode {max(self.modes)}",
            "Absolute values: a dip is a change of sign of the error.",
            lambda ax: self._draw_joints(ax, joints),
        )
        return Result(
            summary=f"Mode {max(self.modes)}, N = {self.counts[-1]}, error: {', '.join(settled)}." if settled else "",
            tables=[error_table, *[bound_table] * bool(bounds), *[joint_table] * bool(joints)],
            figures=[sizes, *[bracket] * bool(bounds), work, *[rules] * bool(joints)],
            warnings=[*warnings, *no_bound, *left_out.values()],
            data={"rows": rows, "bounds": bounds},
        )

    def _rows(self, cache: "SolutionCache", variants: tuple[Variant, ...], progress: Progress) -> list[Row]:
        """A row for each mode, variant and size, in this order."""
        from verify.judge.compare import ORDER_FLOOR
        from verify.models.catalogue import MODELS
        from verify.timing import interleaved_medians

        seconds: dict[tuple[Variant, int], float] = {}
        for count in self.counts:
            progress(f"N = {count}")
            solves = []
            for one in variants:
                model, how = MODELS[one.model], dict(one.settings)
                n = min(max(self.modes), model.n_elastic(cache.beam, count, **how))
                cache.modes(one.model, count, n, one.settings)
                solves.append(partial(model.solve_modes, cache.beam, n, count, **how))
            seconds |= zip(((one, count) for one in variants), interleaved_medians(solves), strict=True)
        rows = []
        for mode in self.modes:
            for one in variants:
                before: tuple[int, float] | None = None
                for count in self.counts:
                    error, why = cache.error_or_why(one.model, count, mode, one.settings)
                    frequency = order = None
                    if error is not None:
                        frequency = cache.paired_frequency_hz(one.model, count, mode, one.settings)
                        # No order across a change of sign, nor at the rounding of the eigenvalues.
                        coarse = before is not None and min(abs(before[1]), abs(error)) >= ORDER_FLOOR
                        if before and coarse and before[0] != count and before[1] * error > 0.0:
                            order = log(before[1] / error) / log(count / before[0])
                    row = {"mode": mode, "model": one.title, "N": count, "frequency_hz": frequency, "error": error}
                    time = None if error is None else seconds[one, count]
                    rows.append(row | {"order": order, "run_time_s": time, "variant": one, "why": why})
                    before = None if error is None else (count, error)
        return rows

    def _bounds(self, cache: "SolutionCache") -> tuple[list[Row], list[str]]:
        """(a row for each mode and size with a bound, why there are none elsewhere)."""
        from verify.judge.cache import has_bracket
        from verify.models.naming import MEAN

        rows: list[Row] = []
        reasons: dict[str, None] = {}
        settings = next((one for one in self.combinations if has_bracket(cache.beam, one)), self.combinations[0])
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
                rows.append(row | {"width": bound.relative_width, "mean_error": mean})
        return rows, list(reasons)

    def _joint_models(self, cache: "SolutionCache", variants: tuple[Variant, ...]) -> dict[Variant, list[float | None]]:
        """Errors of the highest mode over sizes by every joint model that differs on this beam, the default first."""
        others = self.every_rule(cache.beam)
        chosen = [one for one in variants if one.model in {other.model for other in others}]
        return {
            one: [cache.error_or_why(one.model, count, max(self.modes), one.settings)[0] for count in self.counts]
            for one in dict.fromkeys([*chosen, *others] if others else [])
        }

    def _summarise(self, cache: "SolutionCache", rows: list[Row]) -> tuple[list[str], list[str]]:
        """(errors of the highest mode whose orders are those of theory, warnings on the others)."""
        settled, warnings = [], dict.fromkeys(row["why"] for row in rows if row["why"])
        for one in dict.fromkeys(row["variant"] for row in rows):
            own = [row for row in rows if row["variant"] == one and row["mode"] == max(self.modes)]
            orders = [row["order"] for row in own if row["order"] is not None][-2:]
            theory = one.order(cache.beam)
            expected = theory if theory is not None else orders[-1] if orders else 0.0
            if own[-1]["error"] is None:
                continue
            if orders and all(abs(order - expected) <= ORDER_TOLERANCE for order in orders):
                settled.append(f"{one.title} {100 * own[-1]['error']:+.4g} % (order {orders[-1]:.2f})")
            else:
                seen = ", ".join(f"{order:.2f}" for order in orders) or "none"
                warnings[f"{one.title}, mode {max(self.modes)}: order not converged (observed {seen}; {theory})."] = (
                    None
                )
        return settled, list(warnings)

    def _draw_errors(self, ax: "Axes", cache: "SolutionCache", rows: list[Row], bounds: list[Row]) -> None:
        from verify.report.plotting import MODEL_COLORS, slope_guide

        colors = variant_colors(tuple(dict.fromkeys(row["variant"] for row in rows)))
        for mode, style in zip(self.modes, STYLES * len(self.modes), strict=False):
            for one, color in colors.items():
                own = [row for row in rows if row["variant"] == one and row["mode"] == mode and row["error"]]
                label = one.title if mode == self.modes[0] else ""
                ax.loglog([r["N"] for r in own], [100 * abs(r["error"]) for r in own], style, color=color, label=label)
            own = [row for row in bounds if row["mode"] == mode and row["mean_error"]]
            label = "mean of both" if mode == self.modes[0] and bounds else ""
            means = [100 * abs(row["mean_error"]) for row in own]
            ax.loglog([row["N"] for row in own], means, style, color=MODEL_COLORS["mean"], label=label)
            ax.plot([], [], style, color="#7d8590", label=f"mode {mode}")
        span = log10(max(self.counts) / min(self.counts))
        guides = {one.order(cache.beam): [r for r in rows if r["variant"] == one and r["error"]] for one in colors}
        if bounds:
            guides.setdefault(6, [row | {"error": row["mean_error"]} for row in bounds if row["mean_error"]])
        for order, own in guides.items():
            if order and own and span:
                slope_guide(ax, -order, (own[0]["N"], 250.0 * abs(own[0]["error"])), span)
        size_axis(ax, self.counts)
        ax.set_ylabel("|frequency error|, %")
        ax.legend(ncols=2)

    def _draw_work(self, ax: "Axes", rows: list[Row]) -> None:
        colors = variant_colors(tuple(dict.fromkeys(row["variant"] for row in rows)))
        for mode, style in zip(self.modes, STYLES * len(self.modes), strict=False):
            for one, color in colors.items():
                own = [row for row in rows if row["variant"] == one and row["mode"] == mode and row["error"]]
                times, errors = [1e3 * r["run_time_s"] for r in own], [100 * abs(r["error"]) for r in own]
                ax.loglog(times, errors, style, color=color, label=one.title if mode == self.modes[0] else "")
                for row, time, error in zip(own, times, errors, strict=True):
                    if mode == self.modes[-1]:
                        ax.annotate(str(row["N"]), (time, error), (4, 4), textcoords="offset points", fontsize=8)
            ax.plot([], [], style, color="#7d8590", label=f"mode {mode}")
        ax.set(xlabel="solve time, ms", ylabel="|frequency error|, %")
        ax.legend(ncols=2)

    def _draw_bound(self, ax: "Axes", cache: "SolutionCache", bounds: list[Row]) -> None:
        from verify.report.plotting import MODEL_COLORS

        own = [row for row in bounds if row["mode"] == max(self.modes)]
        exact, counts = cache.exact_hz(max(self.modes)), [row["N"] for row in own]
        lower, upper = ([100 * (row[key] / exact - 1.0) for row in own] for key in ("lower_hz", "upper_hz"))
        ax.fill_between(counts, lower, upper, color=MODEL_COLORS["mean"], alpha=0.15, linewidth=0)
        ax.plot(counts, upper, "-o", color=MODEL_COLORS["fem"], label="upper bound, Hermite elements")
        ax.plot(counts, lower, "-o", color=MODEL_COLORS["segment"], label="lower bound, segments")
        ax.plot(counts, [100 * row["mean_error"] for row in own], "-o", color=MODEL_COLORS["mean"], label="mean")
        ax.axhline(0.0, color=MODEL_COLORS["analytic"], linewidth=1.0)
        ax.set_xscale("log")
        size_axis(ax, counts)
        ax.set_ylabel("against the exact frequency, %")
        ax.legend()

    def _draw_joints(self, ax: "Axes", joints: dict[Variant, list[float | None]]) -> None:
        for one, color in variant_colors(tuple(joints)).items():
            errors = [float("nan") if error is None else 100 * abs(error) for error in joints[one]]
            ax.loglog(self.counts, errors, "-o", color=color, label=one.title)
        size_axis(ax, self.counts)
        ax.set_ylabel("|frequency error|, %")
        ax.legend()


def size_axis(ax: "Axes", counts: "tuple[int, ...] | list[int]") -> None:
    """A tick at every size that was solved."""
    from matplotlib.ticker import NullLocator

    ax.set_xlabel("number of segments or elements N")
    ax.set_xticks(sorted(set(counts)), [str(count) for count in sorted(set(counts))])
    ax.xaxis.set_minor_locator(NullLocator())
