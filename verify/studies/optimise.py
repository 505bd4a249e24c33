"""Optimisation of a quantity over keys of the scene and its arguments, under limits of other quantities.

Variables run from 0 to 1 between their bounds. A point that violates limits, or at which a quantity has no value, ranks
behind every feasible one by the size of its violation (K. Deb, Comput. Methods Appl. Mech. Eng. 186 (2000) 311-338):
populations need one number for each point, which an executor evaluates. The local method, COBYQA, needs no derivatives
and treats limits as constraints. Before it is reported the optimum is searched again on a finer model, from the first.
"""

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from itertools import accumulate
from math import inf, isfinite, log
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, void
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.parallel import completed, workers
from verify.quantities.base import QUANTITIES, evaluate
from verify.report.result import Column, Figure, Result, Table
from verify.scene.model import Limits
from verify.studies.base import Progress, Study
from verify.studies.sweep import Request, plain_tables, quantity_margins, value_at, varied

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

Task: TypeAlias = tuple[dict[str, Any], Sequence[Request], dict[str, float]]  # arguments of `varied`
Point: TypeAlias = tuple[float, ...]  # of variables between 0 and 1
STAGES = {"global": ("DE", "COBYQA"), "cma": ("CMA-ES", "COBYQA"), "local": ("COBYQA",)}
INFEASIBLE = 1e30  # least merit of a point that violates a limit
TOLERANCE = 1e-6  # violation, relative to a limit, up to which a point is feasible
ACTIVE = 1e-3
FINAL = 1e-9  # accuracy of a variable relative to its range
POPULATION = 15  # of differential evolution, for each variable
NOTES = [
    "A bound or a limit is active within 0.1 % of the range or of the limit.",
    "finer: the exact beam where the quantity has it, else twice the count; twice the time steps.",
]
VARIABLES = ("variable", "low", "high", "start", "optimum", "finer optimum", "bound")
FIGURES = ("quantity", "limit", "active", "unit", "start", "optimum", "there, finer", "finer optimum", "finer model")
HISTORY = "Points that satisfy the limits, in the order of their evaluation, and the best of them so far."


class Variable(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number between two bounds. Raises InputError for bounds in the wrong order."""

    key: Annotated[str, Meta(description="Of the scene: 'drive.force.*.amplitude, beam.width'; or an argument.")]
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
        return self.low * (self.high / self.low) ** u if self.scale == "log" else self.low + u * (self.high - self.low)

    def unit(self, value: float) -> float:
        """The u of a value."""
        if self.scale == "log":
            return log(value / self.low) / log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


class Limit(Limits, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A quantity that has to stay within limits. Raises InputError without one."""

    def __post_init__(self) -> None:
        self.check(f"optimise.limit.{self.id}", "at_least", "at_most", other=None)

    def distances(self, value: float) -> list[float]:
        """Distance of a value from each limit, relative to it unless it is zero; negative where violated."""
        sides = (self.at_least, 1.0), (self.at_most, -1.0)
        return [sign * (value - limit) / (abs(limit) or 1.0) for limit, sign in sides if limit is not None]


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
        Literal["global", "cma", "local"],
        Meta(description="global: differential evolution, cma: CMA-ES, each before a local search; local: from start."),
    ] = "global"
    evaluations: Annotated[int, Meta(ge=10, description="Most points of each search.")] = 1000
    seed: Annotated[int, Meta(ge=1, description="Of random numbers.")] = 1

    @property
    def requests(self) -> list[Request]:
        """The quantity, then those of the limits."""
        return [(self.quantity, self.arguments), *((one.quantity, one.arguments) for one in self.limit)]

    def check(self, scene: "Scene") -> None:
        """Raise InputError for an unknown quantity, argument or key, and a start outside of its bounds."""
        tables = plain_tables(scene)
        varied(tables, self.requests, values := self.values(self.start(tables)))
        if len(values) < len(self.variable):
            raise InputError("optimise.variable: a key occurs twice, give each once")

    def start(self, tables: dict[str, Any]) -> Point:
        """Start of each variable, from 0 to 1. Raises InputError."""
        found = []
        for one in self.variable:
            value: Any = value_at(tables, one.key, self.requests) if one.start is None else one.start
            if not isinstance(value, int | float) or not one.low <= value <= one.high:
                bounds = f"between {one.low:g} and {one.high:g}"
                raise InputError(f"optimise.variable {one.key}: its start {value!r} is no number {bounds}: give start")
            found.append(one.unit(value))
        return tuple(found)

    def values(self, point: Point) -> dict[str, float]:
        """Values by key."""
        return {one.key: one.value(u) for one, u in zip(self.variable, point, strict=True)}

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Search the optimum, and from it again on a finer model, with the workers of `parallel`.

        Returns the variables with active bounds, the quantities at the start and at both optima, and the history.
        Without a feasible point the result is void. Raises InputError.
        """
        self.check(scene)
        tables = plain_tables(scene)
        begin = self.start(tables)
        with workers(self.evaluations) as executor:
            coarse = finer = Search(self, tables, self.requests, executor, progress)
            coarse.merits([begin])  # in this process, so that forked workers inherit what it compiles
            for stage in STAGES[self.method]:
                coarse.run(stage)
            requests, labels = _finer(tables, self.requests, self.values(coarse.best))
            if coarse.feasible and any(labels):
                finer = Search(self, tables, requests, executor, progress)
                finer.merits([coarse.best])
                finer.run("COBYQA")
        points = (coarse, begin), (coarse, coarse.best), (finer, coarse.best), (finer, finer.best)
        best, values = finer.best, self.values(finer.best)
        missing: list[float | None] = [None] * len(requests)
        start, optimum, there, last = (search.found[point][0] or missing for search, point in points)
        rows, sizes = [], list[tuple[Any, ...]]()
        for one, *at in zip(self.variable, begin, coarse.best, best, strict=True):
            bound = "low" if at[-1] < ACTIVE else "high" if at[-1] > 1.0 - ACTIVE else ""
            rows.append((one.key, one.low, one.high, *map(one.value, at), bound))
        for i, (name, _) in enumerate(requests):
            role, unit, active = self.limit[i - 1].limits if i else f"{self.goal}d", QUANTITIES[name].unit, None
            if i and (size := last[i]) is not None:
                active = min(map(abs, self.limit[i - 1].distances(size))) < ACTIVE
            head = name, role, active, "" if unit == "1" else unit
            model = labels[i] if labels[i] and finer is not coarse else "the same"
            sizes.append((*head, start[i], optimum[i], there[i], last[i], model))
        shown = [
            Table("Variables", [Column(name, format=".9g") for name in VARIABLES], rows, NOTES),
            Table("Objective and limits", [Column(name, format=".6g") for name in FIGURES], sizes),
        ]
        data = {"optimum": values, "points": len(coarse.found) + (finer is not coarse) * len(finer.found)}
        notes = list(dict.fromkeys(coarse.notes + finer.notes))
        if not finer.feasible or last[0] is None:
            failure = "no point satisfies all limits (the best one is in the table)"
            if last[0] is None:
                failure = f"no point has a value of all quantities (the first: {finer.found[best][1]})"
            margins = [void("the optimum", failure, "widen optimise.variable, or relax optimise.limit")]
            return Result("", shown, warnings=notes, data=data, margins=margins)
        loss = inf if there[0] is None else abs(there[0] - last[0]) / (max(abs(last[0]), abs(start[0] or 0.0)) or 1.0)
        margins = []
        if any(label not in ("", EXACT) for label in labels):
            cause = "the optimum moves with the discretisation"
            margins = [Margin(name="discretisation of the optimum", size=loss, failure=cause, remedy="raise count")]
        at_best, solved, requests = varied(tables, requests, values)
        margins += [one for request in requests for one in quantity_margins(*request, at_best, solved)]
        before = "" if start[0] is None else f" (start: {start[0]:.6g})"
        where = ", ".join(f"{key} = {x:.8g}" for key, x in values.items())
        return Result(
            summary=f"{self.quantity} {self.goal}d: {last[0]:.6g}{f' {sizes[0][3]}'.rstrip()}{before} at {where}.",
            tables=shown,
            figures=[Figure("optimise-history", f"Search for the optimum of {self.quantity}", HISTORY, coarse.draw)],
            warnings=notes,
            data=data | {"loss by discretisation": loss, "history": coarse.history},
            margins=margins,
        )


@dataclass
class Search:
    """Objective and limits on one model, in variables from 0 to 1; every point is evaluated once and recorded."""

    study: Optimise
    tables: dict[str, Any]
    requests: list[Request]
    executor: Executor | None
    progress: Progress
    found: dict[Point, tuple[list[float] | None, str]] = field(default_factory=dict)
    """(values, '') or (None, reason) of the requests, by point."""
    notes: list[str] = field(default_factory=list)
    """Searches that stopped early."""

    @property
    def sign(self) -> float:
        """Of the objective in its merit."""
        return 1.0 if self.study.goal == "minimise" else -1.0

    def merits(self, points: "Iterable[Iterable[float]]") -> list[float]:
        """Merit of each point: the least is the best."""
        keys: list[Point] = [tuple(map(float, point)) for point in points]
        new = [key for key in dict.fromkeys(keys) if key not in self.found]
        tasks: list[Task] = [(self.tables, self.requests, self.study.values(key)) for key in new]
        results = dict(completed(figures_at, tasks, self.executor if len(new) > 1 else None))
        self.found |= {key: results[i] for i, key in enumerate(new)}
        self.progress(f"optimise: {len(self.found)} points")
        return [self.merit(key) for key in keys]

    def merit(self, point: Point) -> float:
        """Signed objective of a feasible point; for another beyond INFEASIBLE by its violation."""
        values = self.found[point][0]
        if values is None:
            return 1e3 * INFEASIBLE
        excess = sum(-one for one in self.distances(values) if one < -TOLERANCE)
        return INFEASIBLE * (1.0 + min(excess, 900.0)) if excess else self.sign * values[0]

    def distances(self, values: Sequence[float]) -> list[float]:
        """Relative distances from all limits, negative where violated."""
        limits = zip(self.study.limit, values[1:], strict=True)
        return [distance for one, value in limits for distance in one.distances(value)]

    @property
    def best(self) -> Point:
        """The point of least merit."""
        return min(self.found, key=self.merit)

    @property
    def feasible(self) -> bool:
        """Whether a point satisfies all limits."""
        return self.merit(self.best) < INFEASIBLE

    @property
    def history(self) -> list[tuple[int, float]]:
        """(number, objective) of every feasible point."""
        merits = enumerate(map(self.merit, self.found), 1)
        return [(i, self.sign * merit) for i, merit in merits if merit < INFEASIBLE]

    def run(self, stage: str) -> None:
        """One method, from the best point so far. Raises InputError where it is not installed."""
        from scipy.optimize import NonlinearConstraint, differential_evolution, minimize

        start, most, d, before = self.best, self.study.evaluations, len(self.study.variable), len(self.found)
        if stage == "DE":
            options: Any = {"vectorized": True, "updating": "deferred", "polish": False, "rng": self.study.seed}
            options |= {"popsize": POPULATION, "maxiter": max(most // (POPULATION * d) - 1, 1), "x0": start}
            try:
                differential_evolution(lambda x: self.merits(x.T), [(0.0, 1.0)] * d, **options)
            except RuntimeError as error:  # which scipy makes of the ValueError of a killed worker
                raise error.__cause__ or error from None
            return
        if stage == "CMA-ES":
            try:
                import cma
            except ImportError:
                missing = "cma is not installed, pip install 'fem-segment-verify[optimise]', or give 'global'"
                raise InputError(f"optimise.method = 'cma': {missing}") from None
            settings = {"bounds": [0.0, 1.0], "seed": self.study.seed, "maxfevals": most, "verbose": -9}
            evolution = cma.CMAEvolutionStrategy(start, 0.25, settings)
            while not evolution.stop():
                points = evolution.ask()
                evolution.tell(points, self.merits(points))
            return
        n = len(self.distances([0.0] * len(self.requests)))
        first = self.found[start][0]  # violates limits where it is the optimum of a coarser model
        size = (abs(first[0]) if first else 0.0) or 1.0

        def values(x: "Array") -> list[float] | None:
            self.merits([x])
            return self.found[tuple(map(float, x))][0]

        def objective(x: "Array") -> float:
            return self.sign * here[0] / size if (here := values(x)) else 1e3

        def distances(x: "Array") -> list[float]:
            return self.distances(here) if (here := values(x)) else [-1.0] * n

        limits = [NonlinearConstraint(distances, 0.0, inf)] if n else []
        radii = {"maxfev": most, "initial_tr_radius": 0.05, "final_tr_radius": FINAL}
        minimize(objective, start, method=stage, bounds=[(0.0, 1.0)] * d, constraints=limits, options=radii)
        if len(self.found) - before >= most:
            self.notes.append(f"The local search stopped at its {most} points: raise optimise.evaluations.")

    def draw(self, ax: "Axes") -> None:
        """Feasible points and the best so far."""
        numbers, values = zip(*self.history, strict=True)
        ax.plot(numbers, values, ".", alpha=0.5, label="points")
        best = accumulate(values, min if self.sign > 0.0 else max)
        ax.step(numbers, list(best), where="post", label="best so far")
        if min(values) > 0.0 and max(values) > 30.0 * min(values):
            ax.set_yscale("log")
        unit = QUANTITIES[self.study.quantity].unit
        ax.set(xlabel="point", ylabel=self.study.quantity + ("" if unit == "1" else f", {unit}"))
        ax.legend()


def figures_at(task: Task) -> tuple[list[float] | None, str]:
    """(values of quantities on a scene with other values by key, ''), or (None, reason) where there is none."""
    try:
        scene, cache, requests = varied(*task)
        found = []
        for name, arguments in requests:
            value = evaluate(name, arguments, scene, cache)
            if not isinstance(value, int | float) or not isfinite(value):
                raise InputError(f"quantity = {name!r} is no finite real number: {value}")
            found.append(float(value))
        return found, ""
    except InputError as error:
        return None, str(error)


def _finer(
    tables: dict[str, Any], requests: list[Request], values: dict[str, float]
) -> tuple[list[Request], list[str]]:
    """Each quantity on the exact beam where it has that model, else with twice the count; with twice the time steps.

    The first that has a value at this point; with a label each, empty where there is no finer model.
    """
    found, labels = list(requests), [""] * len(requests)
    for i, (name, arguments) in enumerate(requests):
        fields = msgspec.structs.fields(QUANTITIES[name].schema)
        settings = {one.name: one.default for one in fields if not one.required} | arguments
        model, count, steps = settings.get("model", ""), settings.get("count"), settings.get("steps_per_period")
        exact = {key: one for key, one in arguments.items() if key != "count"} | {"model": EXACT}
        tries = [(exact, EXACT)] if model in MODELS and MODELS[model].sized else []
        tries += [(arguments | {"count": 2 * count}, f"count = {2 * count}")] if count else []
        if steps:
            label = f"{2 * steps} steps a period"
            tries = [(own | {"steps_per_period": 2 * steps}, f"{text}, {label}") for own, text in tries]
            tries.append((arguments | {"steps_per_period": 2 * steps}, label))
        for own, label in tries:
            if figures_at((tables, [(name, own)], values))[0] is not None:
                found[i], labels[i] = (name, own), label
                break
    return found, labels
