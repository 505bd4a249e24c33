"""Optimisation of a quantity over keys of the scene and its arguments, under limits of other quantities.

Variables run from 0 to 1 between their bounds. A point that violates limits, or at which a quantity has no value, ranks
behind every feasible one by the size of its violation (K. Deb, Comput. Methods Appl. Mech. Eng. 186 (2000) 311-338):
populations need one number for each point, which an executor evaluates. The local method, COBYQA, needs no derivatives
and treats limits as constraints. Before it is reported the optimum is searched again on a finer model, from the first.
"""

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import accumulate
from math import dist, inf, log
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, void
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.parallel import completed, workers
from verify.quantities.base import QUANTITIES
from verify.report.result import Column, Figure, Result, Table
from verify.scene.model import Limits
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import unit_symbol
from verify.studies.tables import Row, Variants

Point: TypeAlias = tuple[float, ...]  # of variables between 0 and 1
STAGES = {"global": ("DE", "COBYQA"), "cma": ("CMA-ES", "COBYQA"), "local": ("COBYQA",)}
METHODS = "global: differential evolution, cma: CMA-ES, each before a local search; local: from start."
INFEASIBLE = 1e30  # least merit of a point that violates a limit
MOST_EXCESS = 900.0  # that counts: a point without a value, of merit 1000 INFEASIBLE, ranks behind all others
TOLERANCE = 1e-6  # violation, relative to a limit, up to which a point is feasible
ACTIVE = 1e-3
FINAL = 1e-9  # accuracy of a variable relative to its range
POPULATION = 15  # of differential evolution, for each variable
STARTS = 3  # local searches on the first model: enough for the lesser optimum of the documented example, not varied
APART = 0.15  # of a range, least distance of a start from starts and optima before it; not varied
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

    name, title, devices = "optimise", "Optimum", True

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = msgspec.field(default_factory=dict)
    goal: Annotated[Literal["minimise", "maximise"], Meta(description="What to do with it.")] = "minimise"
    variable: Annotated[tuple[Variable, ...], Meta(min_length=1, description="What varies.")]
    limit: Annotated[tuple[Limit, ...], Meta(description="Limits of other quantities.")] = ()
    method: Annotated[Literal["global", "cma", "local"], Meta(description=METHODS)] = "global"
    evaluations: Annotated[int, Meta(ge=10, description="Most points of each search.")] = 1000
    seed: Annotated[int, Meta(ge=1, description="Of random numbers.")] = 1

    def variants(self, scene: Scene) -> Variants:
        """The quantity, then those of the limits, on the scene."""
        limits = [(limit.quantity, limit.arguments) for limit in self.limit]
        return Variants.of(scene, [(self.quantity, self.arguments), *limits])

    def check(self, scene: Scene) -> None:
        """Raise InputError for an unknown quantity, argument or key, and a start outside of its bounds."""
        variants = self.variants(scene)
        start = self.start(variants)
        variants.check("optimise.variable", [(v.key, v.value(u)) for v, u in zip(self.variable, start, strict=True)])

    def start(self, variants: Variants) -> Point:
        """Start of each variable, from 0 to 1. Raises InputError."""
        point = []
        for variable in self.variable:
            value: Any = variants.value(variable.key) if variable.start is None else variable.start
            if not isinstance(value, int | float) or not variable.low <= value <= variable.high:
                which = f"its start {value!r} is no number between {variable.low:g} and {variable.high:g}"
                raise InputError(f"optimise.variable {variable.key}: {which}: give start")
            point.append(variable.unit(value))
        return tuple(point)

    def values(self, point: Point) -> dict[str, float]:
        """Values by key."""
        return {variable.key: variable.value(u) for variable, u in zip(self.variable, point, strict=True)}

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Search the optimum, and from it again on a finer model, with the workers of `parallel`.

        Returns the variables with active bounds, the quantities at the start and at both optima, and the history.
        Without a feasible point the result is void. Raises InputError.
        """
        self.check(scene)
        variants = self.variants(scene)
        begin = self.start(variants)
        with workers(self.evaluations) as executor:
            coarse = finer = Search(self, variants, executor, progress)
            coarse.merits([begin])  # in this process, so that forked workers inherit what it compiles
            for stage in STAGES[self.method]:
                coarse.run(stage)
            ends = coarse.restarted() if self.method != "local" and coarse.feasible else []
            finest, labels = _finer(variants, self.values(coarse.best))
            if coarse.feasible and any(labels):
                finer = Search(self, finest, executor, progress)
                finer.merits([coarse.best])
                finer.run("COBYQA")
        values = self.values(finer.best)
        stages = [coarse.rows[begin], coarse.rows[coarse.best], finer.rows[coarse.best], finer.rows[finer.best]]
        start, _, refined, last = (row.values[0] for row in stages)
        models = [label if label and finer is not coarse else "the same" for label in labels]
        shown = [self._variables(begin, coarse.best, finer.best), self._objective(stages, models)]
        data = {"optimum": values, "points": len(coarse.rows) + (finer is not coarse) * len(finer.rows)}
        notes = list(dict.fromkeys(coarse.notes + finer.notes))
        if not finer.feasible or last is None:
            failure = "no point satisfies all limits (the best one is in the table)"
            if last is None:
                failure = f"no point has a value of all quantities (the first: {stages[-1].reason})"
            margins = [void("the optimum", failure, "widen optimise.variable, or relax optimise.limit")]
            return Result("", shown, warnings=notes, data=data, margins=margins)
        loss = inf if refined is None else abs(refined - last) / (max(abs(last), abs(start or 0.0)) or 1.0)
        margins = []
        if any(label not in ("", EXACT) for label in labels):
            cause = "the optimum moves with the discretisation"
            margins = [Margin(name="discretisation of the optimum", size=loss, failure=cause, remedy="raise count")]
        before = "" if start is None else f" (start: {start:.6g})"
        where = ", ".join(f"{key} = {x:.8g}" for key, x in values.items())
        value = f"{last:.6g} {unit_symbol(QUANTITIES[self.quantity].unit)}".rstrip()
        several = f"from {len(ends)} starts, on the first model, it ends at {', '.join(f'{x:.6g}' for x in ends)}"
        missed = f" The search may miss a better optimum: {several}." if len(ends) > 1 else ""
        return Result(
            summary=f"{self.quantity} {self.goal}d: {value}{before} at {where}.{missed}",
            tables=shown,
            figures=[Figure("optimise-history", f"Search for the optimum of {self.quantity}", HISTORY, coarse.draw)],
            warnings=notes,
            data=data | {"optima by start": ends, "loss by discretisation": loss, "history": coarse.history},
            margins=[*margins, *finer.variants.margins(values)],
        )

    def _variables(self, *points: Point) -> Table:
        """Values of the variables at the start and at both optima, with active bounds."""
        rows = []
        for variable, *stages in zip(self.variable, *points, strict=True):
            bound = "low" if stages[-1] < ACTIVE else "high" if stages[-1] > 1.0 - ACTIVE else ""
            rows.append((variable.key, variable.low, variable.high, *map(variable.value, stages), bound))
        return Table("Variables", [Column(name, format=".9g") for name in VARIABLES], rows, NOTES)

    def _objective(self, stages: Sequence[Row], models: Sequence[str]) -> Table:
        """Values of objective and limits at these points, with active limits, and the finer model of each."""
        rows = []
        names, limits = [self.quantity, *(limit.quantity for limit in self.limit)], [None, *self.limit]
        for i, (name, limit, model) in enumerate(zip(names, limits, models, strict=True)):
            sizes, active = [row.values[i] for row in stages], None
            if limit and sizes[-1] is not None:
                active = min(map(abs, limit.distances(sizes[-1]))) < ACTIVE
            role = limit.limits if limit else f"{self.goal}d"
            rows.append((name, role, active, unit_symbol(QUANTITIES[name].unit), *sizes, model))
        return Table("Objective and limits", [Column(name, format=".6g") for name in FIGURES], rows)


@dataclass
class Search:
    """Objective and limits on one model, in variables from 0 to 1; every point is evaluated once and recorded."""

    study: Optimise
    variants: Variants
    executor: Executor | None
    progress: Progress
    rows: dict[Point, Row] = field(default_factory=dict)  # By point
    notes: list[str] = field(default_factory=list)  # Searches that stopped early

    @property
    def sign(self) -> float:
        """Of the objective in its merit."""
        return 1.0 if self.study.goal == "minimise" else -1.0

    def merits(self, points: Iterable[Iterable[float]]) -> list[float]:
        """Merit of each point: the least is the best."""
        keys: list[Point] = [tuple(map(float, point)) for point in points]
        new = [key for key in dict.fromkeys(keys) if key not in self.rows]
        row_at, executor = partial(self.variants.row, real=True), self.executor if len(new) > 1 else None
        rows = dict(completed(row_at, map(self.study.values, new), executor))
        self.rows |= {key: rows[i] for i, key in enumerate(new)}
        self.progress(f"optimise: {len(self.rows)} points")
        return [self.merit(key) for key in keys]

    def merit(self, point: Point) -> float:
        """Signed objective of a feasible point; for another beyond INFEASIBLE by its violation."""
        row = self.rows[point]
        if row.reason is not None:
            return 1e3 * INFEASIBLE
        excess = sum(-distance for distance in self.distances(row.values) if distance < -TOLERANCE)
        return INFEASIBLE * (1.0 + min(excess, MOST_EXCESS)) if excess else self.sign * row.values[0]

    def distances(self, values: Sequence[float]) -> list[float]:
        """Relative distances from all limits, negative where violated."""
        limits = zip(self.study.limit, values[1:], strict=True)
        return [distance for limit, value in limits for distance in limit.distances(value)]

    @property
    def best(self) -> Point:
        """The point of least merit."""
        return min(self.rows, key=self.merit)

    @property
    def feasible(self) -> bool:
        """Whether a point satisfies all limits."""
        return self.merit(self.best) < INFEASIBLE

    @property
    def history(self) -> list[tuple[int, float]]:
        """(number, objective) of every feasible point."""
        merits = enumerate(map(self.merit, self.rows), 1)
        return [(i, self.sign * merit) for i, merit in merits if merit < INFEASIBLE]

    def restarted(self) -> list[float]:
        """The optimum, then those of local searches from the best feasible points far from all starts and optima."""
        seen, ends = [self.best], [self.sign * self.merit(self.best)]
        while len(ends) < STARTS:
            far = [key for key in self.rows if all(dist(key, one) > APART for one in seen)]
            start, before = min(far, key=self.merit, default=self.best), len(self.rows)
            if start in seen or self.merit(start) >= INFEASIBLE:
                break
            self.run("COBYQA", start)
            end = min([start, *list(self.rows)[before:]], key=self.merit)
            seen += [start, end]
            ends.append(self.sign * self.merit(end))
        return ends

    def run(self, stage: str, start: Point | None = None) -> None:
        """One method, from `start` or the best point so far. Raises InputError where it is not installed."""
        from scipy.optimize import NonlinearConstraint, differential_evolution, minimize

        start = start or self.best
        most, d, before = self.study.evaluations, len(self.study.variable), len(self.rows)
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
        n = len(self.distances([0.0] * len(self.variants.requests)))
        first = self.rows[start].values[0]  # of a point that violates limits if it is the optimum of a coarser model
        size = abs(first or 0.0) or 1.0

        def row(x: Array) -> Row:
            self.merits([x])
            return self.rows[tuple(map(float, x))]

        def objective(x: Array) -> float:
            return self.sign * here.values[0] / size if (here := row(x)).reason is None else 1e3

        def distances(x: Array) -> list[float]:
            return self.distances(here.values) if (here := row(x)).reason is None else [-1.0] * n

        limits = [NonlinearConstraint(distances, 0.0, inf)] if n else []
        radii = {"maxfev": most, "initial_tr_radius": 0.05, "final_tr_radius": FINAL}
        minimize(objective, start, method=stage, bounds=[(0.0, 1.0)] * d, constraints=limits, options=radii)
        if len(self.rows) - before >= most:
            self.notes.append(f"The local search stopped at its {most} points: raise optimise.evaluations.")

    def draw(self, ax: Axes) -> None:
        """Feasible points and the best so far."""
        numbers, values = zip(*self.history, strict=True)
        ax.plot(numbers, values, ".", alpha=0.5, label="points")
        best = accumulate(values, min if self.sign > 0.0 else max)
        ax.step(numbers, list(best), where="post", label="best so far")
        if min(values) > 0.0 and max(values) > 30.0 * min(values):
            ax.set_yscale("log")
        quantity = self.study.quantity
        ax.set(xlabel="point", ylabel=f"{quantity}, {unit_symbol(QUANTITIES[quantity].unit)}".rstrip(", "))
        ax.legend()


def _finer(variants: Variants, values: dict[str, float]) -> tuple[Variants, list[str]]:
    """Each quantity on the exact beam where it has that model, else with twice the count; with twice the time steps.

    The first that has a value at this point; with a label each, empty where there is no finer model.
    """
    requests, labels = list(variants.requests), [""] * len(variants.requests)
    for i, request in enumerate(requests):
        for arguments, label in _refinements(*request):
            if replace(variants, requests=[(request[0], arguments)]).row(values, real=True).reason is None:
                requests[i], labels[i] = (request[0], arguments), label
                break
    return replace(variants, requests=requests), labels


def _refinements(name: str, arguments: dict[str, Any]) -> list[tuple[dict[str, Any], str]]:
    """(arguments, label) of a quantity on finer models, the finest first."""
    settings = QUANTITIES[name].with_defaults(arguments)
    model, count, steps = settings.get("model", ""), settings.get("count"), settings.get("steps_per_period")
    exact = {key: value for key, value in arguments.items() if key != "count"} | {"model": EXACT}
    finer = [(exact, EXACT)] if model in MODELS and MODELS[model].sized else []
    finer += [(arguments | {"count": 2 * count}, f"count = {2 * count}")] if count else []
    if steps:
        label, doubled = f"{2 * steps} steps a period", {"steps_per_period": 2 * steps}
        finer = [(more | doubled, f"{text}, {label}") for more, text in finer]
        finer.append((arguments | doubled, label))
    return finer
