"""Optimisation of a quantity over keys of the scene, under limits of other quantities.

Variables run from 0 to 1 between their bounds. A point that violates limits, or at which a quantity has no value, ranks
behind every feasible one by the size of its violation (K. Deb, Comput. Methods Appl. Mech. Eng. 186 (2000) 311-338), so
that populations need one number for each point, which an executor evaluates. Local steps treat limits as constraints.
The optimum is searched again on a finer model, from the first one, before it is reported: what discretisation changes
is the difference between both.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from math import exp, isfinite, log
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, void
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.parallel import completed, cores, workers
from verify.quantities.base import QUANTITIES, evaluate
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Progress, Study
from verify.studies.sweep import plain_tables, quantity_margins, scene_with, value_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

Request: TypeAlias = tuple[str, dict[str, Any]]  # name and arguments of a quantity
Task: TypeAlias = tuple[dict[str, Any], tuple[Request, ...], dict[str, float]]
STAGES: dict[str, tuple[str, ...]] = {
    "global": ("differential evolution", "COBYQA"),
    "cma": ("CMA-ES", "COBYQA"),
    "cobyqa": ("COBYQA",),
    "slsqp": ("SLSQP",),
    "nelder-mead": ("Nelder-Mead",),
}
INFEASIBLE = 1e30  # merit of the boundary between feasible and infeasible points
TOLERANCE = 1e-6
"""Violation of a limit, relative to it, up to which a point is feasible; accuracy of variables relative to their range."""
ACTIVE = 1e-3  # distance from a bound or limit below which it is active, relative to the range or the limit


class Variable(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number of the scene between two bounds. Raises InputError for bounds in the wrong order."""

    key: Annotated[str, Meta(description="'beam.thickness', 'drive.force.*.amplitude'; several joined by commas.")]
    low: Annotated[float, Meta(description="Lower bound, in the key's unit.")]
    high: Annotated[float, Meta(description="Upper bound, in the key's unit.")]
    start: Annotated[float, Meta(description="Default: the scene's value.")] | None = None
    scale: Annotated[Literal["linear", "log"], Meta(description="log: for bounds that are decades apart.")] = "linear"

    def __post_init__(self) -> None:
        if not self.low < self.high or (self.scale == "log" and self.low <= 0.0):
            above = ", with scale = 'log' above 0" if self.scale == "log" else ""
            raise InputError(f"optimise.variable {self.key}: low = {self.low!r}: give less than high{above}")

    def value(self, u: float) -> float:
        """The value at u from 0 to 1."""
        if self.scale == "log":
            return min(max(exp(log(self.low) + u * log(self.high / self.low)), self.low), self.high)
        return self.low + u * (self.high - self.low)

    def unit(self, value: float) -> float:
        """The u of a value."""
        if self.scale == "log":
            return log(value / self.low) / log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


class Limit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A quantity that has to stay within limits. Raises InputError without one."""

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = msgspec.field(default_factory=dict)
    at_least: Annotated[float, Meta(description="Lower limit, in the quantity's unit.")] | None = None
    at_most: Annotated[float, Meta(description="Upper limit, in the quantity's unit.")] | None = None

    def __post_init__(self) -> None:
        if self.at_least is None and self.at_most is None:
            raise InputError(f"optimise.limit {self.quantity}: give at_least, at_most or both")

    @property
    def text(self) -> str:
        """'at least 0.02, at most 0.03'."""
        sides = (("at least", self.at_least), ("at most", self.at_most))
        return ", ".join(f"{side} {value:g}" for side, value in sides if value is not None)

    def distances(self, value: float) -> list[float]:
        """Distance of a value from each limit, negative where it is violated, relative to the limit unless that is 0."""
        found = [] if self.at_least is None else [(value - self.at_least) / (abs(self.at_least) or 1.0)]
        return found if self.at_most is None else [*found, (self.at_most - value) / (abs(self.at_most) or 1.0)]


class Optimise(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The least or largest value of a quantity over keys of the scene."""

    name: ClassVar[str] = "optimise"
    title: ClassVar[str] = "Optimum"
    devices: ClassVar[bool] = True

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = msgspec.field(default_factory=dict)
    goal: Annotated[Literal["minimise", "maximise"], Meta(description="What to do with it.")] = "minimise"
    variable: Annotated[tuple[Variable, ...], Meta(min_length=1, description="What varies.")]
    limit: Annotated[tuple[Limit, ...], Meta(description="Limits of other quantities.")] = ()
    method: Annotated[
        Literal["global", "cma", "cobyqa", "slsqp", "nelder-mead"],
        Meta(description="global: differential evolution, then COBYQA from its best point; cma: CMA-ES (extra "
                         "`optimise`), then COBYQA; the others are local, from the start."),
    ] = "global"  # fmt: skip
    evaluations: Annotated[int, Meta(ge=10, description="Most points of each stage.")] = 1000
    seed: Annotated[int, Meta(ge=1, description="Of random numbers.")] = 1

    @property
    def requests(self) -> tuple[Request, ...]:
        """The quantity, then those of the limits."""
        return ((self.quantity, self.arguments), *((one.quantity, one.arguments) for one in self.limit))

    def check(self, scene: "Scene") -> None:
        """Raise InputError for an unknown quantity, argument or key, and a start that is outside of its bounds."""
        for name, arguments in self.requests:
            QUANTITIES.named(name, "optimise.quantity").bind(arguments)
        self.start(plain_tables(scene))

    def start(self, tables: dict[str, Any]) -> list[float]:
        """Start of each variable, from 0 to 1. Raises InputError."""
        found = []
        for one in self.variable:
            value: Any = one.start if one.start is not None else value_at(tables, one.key, "optimise.variable")
            if isinstance(value, bool) or not isinstance(value, int | float) or not one.low <= value <= one.high:
                bounds = f"between {one.low:g} and {one.high:g}"
                raise InputError(f"optimise.variable {one.key}: its start {value!r} is no number {bounds}: give start")
            found.append(one.unit(value))
        return found

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Search the optimum, and again on a finer model. Raises InputError."""
        import numpy as np

        self.check(scene)
        tables = plain_tables(scene)
        begin = np.array(self.start(tables))
        with workers(self.evaluations, cores()) as executor:
            coarse = Search(self, tables, self.requests, executor, progress)
            coarse.merits([begin])  # in this process, so that forked workers inherit what it compiles
            for stage in STAGES[self.method]:
                coarse.run(stage)
            first, finer, labels = coarse.best, coarse, [""] * len(self.requests)
            if coarse.feasible(first):
                requests, labels = _finer(scene_with(tables, self.values(first)), self.requests)
                finer = Search(self, tables, requests, executor, progress) if any(labels) else coarse
                finer.merits([np.array(first)])
                if finer is not coarse:
                    finer.run(STAGES[self.method][-1])
        return self._result(coarse, finer, tuple(begin), labels)

    def values(self, u: Sequence[float]) -> dict[str, float]:
        """Values by key at u from 0 to 1."""
        return {one.key: one.value(float(x)) for one, x in zip(self.variable, u, strict=True)}

    def _result(self, coarse: "Search", finer: "Search", begin: "Point", labels: list[str]) -> Result:
        first, best, again = coarse.best, finer.best, finer is not coarse
        columns = [Column("variable"), *(Column(name, format=".8g") for name in ("low", "high", "start", "optimum"))]
        columns += [Column("on the finer model", format=".10g"), Column("bound")]
        rows: list[tuple[Any, ...]] = []
        for i, one in enumerate(self.variable):
            bound = "low" if best[i] < ACTIVE else "high" if best[i] > 1.0 - ACTIVE else ""
            there = one.value(best[i]) if again else None
            rows.append((one.key, one.low, one.high, one.value(begin[i]), one.value(first[i]), there, bound))
        none = [None] * len(self.requests)
        at = [search.found[point][0] or none for search, point in ((coarse, begin), (coarse, first))]
        at += [finer.found[point][0] or none if again else none for point in (first, best)]
        heads = [Column(name) for name in ("quantity", "limit", "active", "unit")]
        heads += [Column(n, format=".6g") for n in ("at start", "at optimum", "there, finer", "finer optimum")]
        sizes: list[tuple[Any, ...]] = []
        for i, (name, _) in enumerate(self.requests):
            text, last, unit = self.limit[i - 1].text if i else f"{self.goal}d", (at[3] if again else at[1])[i], ""
            active = last is not None and min(map(abs, self.limit[i - 1].distances(last))) < ACTIVE if i else None
            unit = "" if QUANTITIES[name].unit == "1" else QUANTITIES[name].unit
            sizes.append((name, text, active, unit, *(values[i] for values in at), labels[i] or "none"))
        notes = ["A bound or a limit is active within 0.1 % of the range or of the limit."]
        tables = [
            Table("Variables", columns, rows, notes),
            Table("Objective and limits", [*heads, Column("finer model")], sizes),
        ]
        count = len(coarse.found) + again * len(finer.found)
        data: dict[str, Any] = {"optimum": self.values(best), "evaluations": count, "start": self.values(begin)}
        if not coarse.feasible(first) or not finer.feasible(best):
            reason = finer.found[best][1] or "a limit is violated at each point, by least at the one in the table"
            failure = f"no point satisfies all limits ({reason})"
            margins = [void("the optimum", failure, "widen optimise.variable or relax optimise.limit")]
            return Result("", tables, data=data | {"feasible": False}, warnings=coarse.notes, margins=margins)
        start, there, value = (
            None if values is none else values[0] for values in (at[0], at[2], at[3 if again else 1])
        )
        assert value is not None
        size = max(abs(value), abs(start or 0.0)) or 1.0
        loss = abs(there - value) / size if there is not None else 0.0
        part = Margin(name="discretisation of the optimum", size=loss,
                      failure="the optimum moves with the discretisation", remedy="use a larger count")  # fmt: skip
        inexact = [part] if again and not all(one in ("", EXACT) for one in labels) else []
        scene, own = scene_with(coarse.tables, self.values(best)), SolutionCache
        cache = own(scene.beam)
        margins = [margin for name, arguments in finer.requests
                   for margin in quantity_margins(name, arguments, scene, cache)]  # fmt: skip
        where = ", ".join(f"{key} = {x:.8g}" for key, x in self.values(best).items())
        unit = sizes[0][3] and f" {sizes[0][3]}"
        before = f" (start: {start:.6g}{unit})" if start is not None else ""
        model = "; on the finer model" if again else ""
        return Result(
            summary=f"{self.quantity} {self.goal}d: {value:.6g}{unit}{before} at {where}{model}.",
            tables=tables,
            figures=[Figure("optimise-history", f"Search for the optimum of {self.quantity}", HISTORY, coarse.draw)],
            warnings=coarse.notes + (finer.notes if again else []),
            data=data | {"feasible": True, "loss by discretisation": loss, "history": coarse.history},
            margins=[*inexact, *margins],
        )


HISTORY = "Points that satisfy the limits, in the order of their evaluation, and the best of them so far."
Point: TypeAlias = tuple[float, ...]


class Search:
    """Objective and limits on one model, in variables from 0 to 1; every point is evaluated once and recorded."""

    def __init__(
        self,
        study: Optimise,
        tables: dict[str, Any],
        requests: tuple[Request, ...],
        executor: Executor | None,
        progress: Progress,
    ) -> None:
        self.study, self.tables, self.requests = study, tables, requests
        self.executor, self.progress = executor, progress
        self.found: dict[Point, tuple[list[float] | None, str]] = {}
        """(values, '') or (None, reason) of the requests, by point."""
        self.notes: list[str] = []

    def merits(self, points: "Sequence[Array] | Array") -> "Array":
        """Merit of each point, (n,): the least is the best."""
        import numpy as np

        keys: list[Point] = [tuple(map(float, np.clip(point, 0.0, 1.0))) for point in points]
        new = [key for key in dict.fromkeys(keys) if key not in self.found]
        tasks: list[Task] = [(self.tables, self.requests, self.study.values(key)) for key in new]
        results = dict(completed(figures_at, tasks, self.executor if len(new) > 1 else None))
        self.found.update((key, results[i]) for i, key in enumerate(new))
        self.progress(f"optimise: {len(self.found)} points")
        return np.array([self.merit(key) for key in keys])

    def merit(self, point: Point) -> float:
        """Signed objective of a feasible point; beyond INFEASIBLE by its violation for another."""
        values = self.found[point][0]
        if values is None:
            return 1e3 * INFEASIBLE
        excess = sum(max(-one, 0.0) for one in self.distances(values) if one < -TOLERANCE)
        sign = 1.0 if self.study.goal == "minimise" else -1.0
        return INFEASIBLE * (1.0 + min(excess, 900.0)) if excess else sign * values[0]

    def distances(self, values: Sequence[float]) -> list[float]:
        """Relative distances from all limits, negative where violated."""
        return [d for one, value in zip(self.study.limit, values[1:], strict=True) for d in one.distances(value)]

    def feasible(self, point: Point) -> bool:
        """Whether a point satisfies all limits."""
        return self.merit(point) < INFEASIBLE

    @property
    def best(self) -> Point:
        """The point of least merit."""
        return min(self.found, key=self.merit)

    @property
    def history(self) -> list[tuple[int, float]]:
        """(number, objective) of every feasible point."""
        return [(i, v[0]) for i, (key, (v, _)) in enumerate(self.found.items(), 1) if v and self.feasible(key)]

    def run(self, stage: str) -> None:
        """One method, from the best point so far."""
        import numpy as np
        from scipy.optimize import Bounds, NonlinearConstraint, differential_evolution, minimize

        study, start, d = self.study, np.array(self.best), len(self.study.variable)
        most, before = study.evaluations, len(self.found)
        if stage == "differential evolution":
            options: dict[str, Any] = {"vectorized": True, "updating": "deferred", "polish": False, "rng": study.seed}
            generations = max(most // (15 * d) - 1, 1)
            differential_evolution(
                lambda x: self.merits(x.T), [(0.0, 1.0)] * d, x0=start, maxiter=generations, popsize=15, **options
            )
            return
        if stage == "CMA-ES":
            self._cma(start)
            return
        size = (abs(self.merit(self.best)) if self.feasible(self.best) else 0.0) or 1.0
        sign = 1.0 if study.goal == "minimise" else -1.0

        def values(x: "Array") -> list[float] | None:
            self.merits([x])
            return self.found[tuple(map(float, np.clip(x, 0.0, 1.0)))][0]

        def objective(x: "Array") -> float:
            """About one at the start: methods stop by its absolute change."""
            if stage == "Nelder-Mead":
                return float(self.merits([x])[0]) / size
            return sign * here[0] / size if (here := values(x)) else 1e3

        def distances(x: "Array") -> list[float]:
            return self.distances(here) if (here := values(x)) else [-1.0] * n

        n = sum(len(one.distances(0.0)) for one in study.limit)
        limits = [NonlinearConstraint(distances, 0.0, np.inf)] if n and stage != "Nelder-Mead" else []
        own: dict[str, Any] = {
            "COBYQA": {"maxfev": most, "initial_tr_radius": 0.05, "final_tr_radius": 1e-9},
            "SLSQP": {"maxiter": max(most // (d + 1), 1), "ftol": 1e-12, "eps": 1e-6},
            "Nelder-Mead": {"maxfev": most, "xatol": 1e-9, "fatol": 1e-12},
        }
        minimize(
            objective, start, method=stage, bounds=Bounds([0.0] * d, [1.0] * d), constraints=limits, options=own[stage]
        )
        if len(self.found) - before >= most:
            self.notes.append(f"{stage} stopped at its {most} points: raise optimise.evaluations.")

    def _cma(self, start: "Array") -> None:
        try:
            import cma
        except ImportError:
            raise InputError(
                "optimise.method = 'cma': it is not installed, pip install 'fem-segment-verify[optimise]', or give 'global'"
            ) from None
        settings = {"bounds": [0.0, 1.0], "seed": self.study.seed, "maxfevals": self.study.evaluations, "verbose": -9}
        evolution = cma.CMAEvolutionStrategy(start, 0.25, settings)
        while not evolution.stop():
            points = evolution.ask()
            evolution.tell(points, list(self.merits(points)))

    def draw(self, ax: "Axes") -> None:
        """Feasible points and the best so far."""
        import numpy as np

        numbers, values = zip(*self.history, strict=True)
        best = np.minimum if self.study.goal == "minimise" else np.maximum
        ax.plot(numbers, values, ".", alpha=0.5, label="points")
        ax.step(numbers, best.accumulate(values), where="post", label="best so far")
        if min(values) > 0.0 and max(values) > 30.0 * min(values):
            ax.set_yscale("log")
        unit = QUANTITIES[self.study.quantity].unit
        ax.set(xlabel="point", ylabel=self.study.quantity + ("" if unit == "1" else f", {unit}"))
        ax.legend()


def figures_at(task: Task) -> tuple[list[float] | None, str]:
    """(values of quantities on a scene with other values by key, ''), or (None, reason) where there is none."""
    tables, requests, values = task
    try:
        scene = scene_with(tables, values)
        cache, found = SolutionCache(scene.beam), []
        for name, arguments in requests:
            value = evaluate(name, arguments, scene, cache)
            if not isinstance(value, int | float) or not isfinite(value):
                raise InputError(f"quantity = {name!r} is no finite real number: {value}")
            found.append(float(value))
        return found, ""
    except InputError as error:
        return None, str(error)


def _finer(scene: "Scene", requests: Sequence[Request]) -> tuple[tuple[Request, ...], list[str]]:
    """Each quantity on the exact beam where it has that model, else with twice the count; with twice the time steps.

    The first that has a value at this point; with a label each, empty where there is no finer model.
    """
    found, labels, cache = list(requests), [""] * len(requests), SolutionCache(scene.beam)
    for i, (name, arguments) in enumerate(requests):
        bound = {
            f.name: f.default for f in msgspec.structs.fields(QUANTITIES[name].schema) if not f.required
        } | arguments
        model, count, steps = bound.get("model"), arguments.get("count"), bound.get("steps_per_period")
        time = {"steps_per_period": 2 * steps} if isinstance(steps, int) else {}
        more = f"{2 * steps} steps a period" if time else ""
        tries: list[tuple[dict[str, Any], str]] = []
        if model in MODELS and MODELS[model].sized:
            exact = {key: value for key, value in arguments.items() if key != "count"} | {"model": EXACT}
            tries = [(exact, EXACT)] + [(arguments | {"count": 2 * count}, f"count = {2 * count}")] * bool(count)
        for own, label in [
            *((own | time, f"{label}, {more}".strip(", ")) for own, label in tries),
            *[(arguments | time, more)] * bool(time),
        ]:
            try:
                evaluate(name, own, scene, cache)
            except InputError:
                continue
            found[i], labels[i] = (name, own), label
            break
    return tuple(found), labels
