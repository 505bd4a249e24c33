"""Shares of uncertain inputs in the variance of a quantity: Sobol's first-order and total indices.

The first-order share Var(E[Y|X]) / Var(Y) is what the knowledge of X alone would remove, the total share what remains
where all others are known (I. M. Sobol', Math. Comput. Simul. 55 (2001) 271-280). `scipy.stats.sobol_indices` estimates
them (A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270).
"""

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import msgspec
from msgspec import Meta

from verify.errors import InputError
from verify.parallel import completed, workers
from verify.quantities.base import QUANTITIES
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Progress, Study
from verify.studies.optimise import figures_at
from verify.studies.sweep import plain_tables, quantity_margins, value_at, varied

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.analysis.solution_cache import SolutionCache
    from verify.arrays import Array
    from verify.scene.model import Scene

CONFIDENCE = 0.95
CAPTION = "First-order and total shares in the variance, with 95 % intervals of the sampling."
NOTES = [
    "first order: removed by knowledge of the input alone; total: remains where all others are known.",
    "Intervals: 95 % of the sampling by bootstrap; four times n halves them.",
]


class Input(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An uncertain number of the scene, around its value there. Raises InputError for another's parameters."""

    key: Annotated[str, Meta(description="'beam.youngs_modulus', 'drive.force.*.amplitude'; or an argument.")]
    distribution: Annotated[
        Literal["normal", "lognormal", "uniform"], Meta(description="The scene's value is its mean, or its median.")
    ] = "normal"
    sd: Annotated[float, Meta(gt=0, description="Standard deviation; of lognormal that of the logarithm.")] | None = (
        None
    )
    low: Annotated[float, Meta(description="Of uniform, in the key's unit.")] | None = None
    high: Annotated[float, Meta(description="Of uniform, in the key's unit.")] | None = None

    def __post_init__(self) -> None:
        uniform = self.low is not None and self.high is not None and self.low < self.high and self.sd is None
        other = self.low is None and self.high is None and self.sd is not None
        if not (uniform if self.distribution == "uniform" else other):
            raise InputError(f"sensitivity.input {self.key}: give low below high for uniform, sd alone for the others")

    def median(self, value: Any) -> float:
        """The median, from the scene's value. Raises InputError."""
        if self.low is not None and self.high is not None:
            return 0.5 * (self.low + self.high)
        if not isinstance(value, int | float) or (self.distribution == "lognormal" and value <= 0.0):
            raise InputError(f"sensitivity.input {self.key}: {value!r} is no suitable number, set it in the scene")
        return float(value)

    def around(self, median: float) -> Any:
        """The distribution of `scipy.stats` with a median."""
        from scipy.stats import lognorm, norm, uniform

        if self.low is not None and self.high is not None:
            return uniform(self.low, self.high - self.low)
        return norm(median, self.sd) if self.distribution == "normal" else lognorm(self.sd, scale=median)


class Sensitivity(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How much of the variance of a quantity each uncertain input causes."""

    name: ClassVar[str] = "sensitivity"
    title: ClassVar[str] = "Shares of uncertain inputs"
    devices: ClassVar[bool] = True

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = msgspec.field(default_factory=dict)
    logarithm: Annotated[bool, Meta(description="Shares of the logarithm of its size.")] = False
    input: Annotated[tuple[Input, ...], Meta(min_length=1, description="What is uncertain.")]
    n: Annotated[int, Meta(ge=16, description="A power of two; n (inputs + 2) values are computed.")] = 256
    seed: Annotated[int, Meta(ge=0, description="Of random numbers.")] = 1

    def check(self, scene: "Scene") -> None:
        """Raise InputError for an unknown quantity, argument or key, and for n that is no power of two."""
        if self.n & (self.n - 1):
            raise InputError(f"sensitivity.n = {self.n}: give a power of two, {1 << self.n.bit_length()}")
        self.medians(plain_tables(scene))

    def medians(self, tables: dict[str, Any]) -> dict[str, float]:
        """The median of each input by its key. Raises InputError."""
        requests = [(self.quantity, self.arguments)]
        found = {one.key: one.median(value_at(tables, one.key, requests)) for one in self.input}
        varied(tables, requests, found)
        if len(found) < len(self.input):
            raise InputError("sensitivity.input: a key occurs twice, give each once")
        return found

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Evaluate the quantity at Saltelli's points with the workers of `parallel`, and estimate the shares.

        Raises InputError where it has no value at one of the points.
        """
        import numpy as np
        from scipy.stats import bootstrap, sobol_indices

        self.check(scene)
        tables, keys, requests = plain_tables(scene), [one.key for one in self.input], [(self.quantity, self.arguments)]
        values: list[float] = []

        def quantity(points: "Array") -> "Array":
            """Values at points (inputs, m), which are those of the samples A and B, then of A with columns of B."""
            tasks: list[Any] = [(tables, requests, dict(zip(keys, map(float, x), strict=True))) for x in points.T]
            found: dict[int, float] = {}
            for i, (figures, reason) in completed(figures_at, tasks, executor, first_here=not values):
                if figures is None or (self.logarithm and figures[0] == 0.0):
                    at = ", ".join(f"{key} = {value:.6g}" for key, value in tasks[i][2].items())
                    raise InputError(f"sensitivity: {self.quantity} has no value at {at} ({reason}): reduce sd")
                found[i] = float(np.log(abs(figures[0]))) if self.logarithm else figures[0]
                progress(f"sensitivity: {len(values) + len(found)} points")
            values.extend(found[i] for i in range(len(tasks)))
            return np.array([values[-len(tasks) :]])

        distributions = [one.around(own) for one, own in zip(self.input, self.medians(tables).values(), strict=True)]
        with workers(self.n) as executor:
            shares = sobol_indices(func=quantity, n=self.n, dists=distributions, rng=self.seed)
        both, mixed = np.reshape(values[: 2 * self.n], (2, self.n)), np.reshape(values[2 * self.n :], (self.n, -1)).T
        centre = both.mean()
        both, mixed = both - centre, mixed - centre

        def estimates(index: "Array", axis: int = -1) -> "Array":
            """First-order and total shares of resampled points, (2, inputs, resamples), by Saltelli's estimator."""
            (a, b), ab = both[:, index], mixed[:, index]
            variance = both[:, index].var(axis=(0, -1))
            shares: Array = np.stack([(b * (ab - a)).mean(axis=-1), 0.5 * ((a - ab) ** 2).mean(axis=-1)]) / variance
            return shares

        # the bootstrap of `SobolResult` has no seed
        options: Any = {"confidence_level": CONFIDENCE, "method": "percentile", "vectorized": True, "rng": self.seed}
        ends = bootstrap([np.arange(self.n)], estimates, n_resamples=999, batch=32, **options).confidence_interval
        first, total = np.atleast_1d(shares.first_order), np.atleast_1d(shares.total_order)
        rows = [
            (key, own.distribution, *map(float, (first[i], ends.low[0, i], ends.high[0, i])),
             *map(float, (total[i], ends.low[1, i], ends.high[1, i])))
            for i, (key, own) in enumerate(zip(keys, self.input, strict=True))
        ]  # fmt: skip
        names = ("first order", "from", "to", "total", "total from", "total to")
        columns = [Column("input"), Column("distribution"), *(Column(name, format=".4f") for name in names)]
        low, middle, high = (float(one) for one in np.quantile(both, [0.025, 0.5, 0.975]) + centre)
        unit = "" if (own := QUANTITIES[self.quantity].unit) == "1" or self.logarithm else f" {own}"
        what, largest = f"ln |{self.quantity}|" if self.logarithm else self.quantity, int(np.argmax(total))
        at, cache, requests = varied(tables, requests, {})
        rivals = [key for i, key in enumerate(keys) if i != largest and ends.high[1, i] > ends.low[1, largest]]
        unclear = f" (its interval overlaps that of {', '.join(rivals)}: no rank)" if rivals else ""
        return Result(
            summary=f"{what}: 95 % of its values are between {low:.6g} and {high:.6g}{unit}, median {middle:.6g}; "
            f"{keys[largest]} has the largest share in its variance, {total[largest]:.3f}{unclear}.",
            tables=[Table(f"Shares in the variance of {what}", columns, rows, NOTES)],
            figures=[Figure("sensitivity-shares", f"Shares in the variance of {what}", CAPTION, partial(_draw, rows))],
            data={"points": len(values), "mean": centre, "sd": both.std(), "sum of first order": first.sum()},
            margins=quantity_margins(*requests[0], at, cache),
        )


def _draw(rows: list[Any], ax: "Axes") -> None:
    """Bars with their intervals."""
    for shift, name, k in ((0.2, "first order", 2), (-0.2, "total", 5)):
        places = [len(rows) - i + shift for i in range(len(rows))]
        sizes = [row[k] for row in rows]
        ends = [[max(row[k] - row[k + 1], 0.0) for row in rows], [max(row[k + 2] - row[k], 0.0) for row in rows]]
        ax.barh(places, sizes, 0.36, xerr=ends, label=name)
    ax.set_yticks([len(rows) - i for i in range(len(rows))], [row[0] for row in rows])
    ax.set_xlabel("share in the variance")
    ax.legend()
