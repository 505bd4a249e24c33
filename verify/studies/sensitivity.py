"""Shares of uncertain inputs in the variance of a quantity: Sobol's first-order and total indices.

The first-order share Var(E[Y|X]) / Var(Y) is what the knowledge of X alone would remove, the total share what remains
where all others are known (I. M. Sobol', Math. Comput. Simul. 55 (2001) 271-280). `scipy.stats.sobol_indices` estimates
them (A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270).
"""

from functools import partial
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.arrays import Array
from verify.errors import InputError
from verify.parallel import completed, workers
from verify.quantities.base import QUANTITIES
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import unit_symbol
from verify.studies.tables import Variants

CONFIDENCE = 0.95
CAPTION = "First-order and total shares in the variance, with 95 % intervals of the sampling."
Distribution = Literal["normal", "lognormal", "uniform"]
SD = "Standard deviation; of lognormal that of the logarithm."
SHARES = "first order", "from", "to", "total", "total from", "total to"
NOTES = [
    "first order: removed by knowledge of the input alone; total: remains where all others are known.",
    "Intervals: 95 % of the sampling by bootstrap; four times n halves them.",
]


class Input(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An uncertain number of the scene, around its value there. Raises InputError for another's parameters."""

    key: Annotated[str, Meta(description="'beam.youngs_modulus', 'drive.force.*.amplitude'; or an argument.")]
    distribution: Annotated[Distribution, Meta(description="The scene's value is its mean, or its median.")] = "normal"
    sd: Annotated[float, Meta(gt=0, description=SD)] | None = None
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

    name, title, devices = "sensitivity", "Shares of uncertain inputs", True

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = {}  # noqa: RUF012
    logarithm: Annotated[bool, Meta(description="Shares of the logarithm of its size.")] = False
    input: Annotated[tuple[Input, ...], Meta(min_length=1, description="What is uncertain.")]
    n: Annotated[int, Meta(ge=16, description="A power of two; n (inputs + 2) values are computed.")] = 256
    seed: Annotated[int, Meta(ge=0, description="Of random numbers.")] = 1

    def check(self, scene: Scene) -> None:
        """Raise InputError for an unknown quantity, argument or key, and for n that is no power of two."""
        if self.n & (self.n - 1):
            raise InputError(f"sensitivity.n = {self.n}: give a power of two, {1 << self.n.bit_length()}")
        self.medians(Variants.of(scene, [(self.quantity, self.arguments)]))

    def medians(self, variants: Variants) -> dict[str, float]:
        """The median of each input by its key. Raises InputError."""
        medians = [(uncertain.key, uncertain.median(variants.value(uncertain.key))) for uncertain in self.input]
        return variants.check("sensitivity.input", medians)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Evaluate the quantity at Saltelli's points with the workers of `parallel`, and estimate the shares.

        Raises InputError where it has no value at one of the points.
        """
        self.check(scene)
        variants = Variants.of(scene, [(self.quantity, self.arguments)])
        values, first, total = self._shares(variants, progress)
        both = values[: 2 * self.n]
        low, middle, high = np.quantile(both, [0.025, 0.5, 0.975])
        keys, largest = [uncertain.key for uncertain in self.input], int(np.argmax(total[0]))
        shares = np.vstack([first, total]).T.tolist()
        rows = [(x.key, x.distribution, *share) for x, share in zip(self.input, shares, strict=True)]
        columns = [Column("input"), Column("distribution"), *(Column(name, format=".4f") for name in SHARES)]
        unit = "" if self.logarithm else f" {unit_symbol(QUANTITIES[self.quantity].unit)}".rstrip()
        what = f"ln |{self.quantity}|" if self.logarithm else self.quantity
        rivals = [key for i, key in enumerate(keys) if i != largest and total[2, i] > total[1, largest]]
        unclear = f" (its interval overlaps that of {', '.join(rivals)}: no rank)" if rivals else ""
        return Result(
            summary=f"{what}: 95 % of its values are between {low:.6g} and {high:.6g}{unit}, median {middle:.6g}; "
            f"{keys[largest]} has the largest share in its variance, {total[0, largest]:.3f}{unclear}.",
            tables=[Table(f"Shares in the variance of {what}", columns, rows, NOTES)],
            figures=[Figure("sensitivity-shares", f"Shares in the variance of {what}", CAPTION, partial(_draw, rows))],
            data={"points": len(values), "mean": both.mean(), "sd": both.std(), "sum of first order": first[0].sum()},
            margins=variants.margins({}),
        )

    def _shares(self, variants: Variants, progress: Progress) -> tuple[Array, Array, Array]:
        """(values of the quantity, first-order and total shares with the ends of their intervals, (3, inputs) each)."""
        from scipy.stats import bootstrap, sobol_indices

        keys, values = [uncertain.key for uncertain in self.input], list[float]()

        def quantity(points: Array) -> Array:
            """Values at points (inputs, m), which are those of the samples A and B, then of A with columns of B."""
            at = [dict(zip(keys, map(float, x), strict=True)) for x in points.T]
            row_at, sizes = partial(variants.row, real=True), dict[int, float]()
            for i, row in completed(row_at, at, executor, first_here=not values):
                size = row.values[0]
                if row.reason is not None or (self.logarithm and size == 0.0):
                    where = ", ".join(f"{key} = {value:.6g}" for key, value in at[i].items())
                    reason = row.reason or "its logarithm is infinite"
                    raise InputError(f"sensitivity: {self.quantity} has no value at {where} ({reason}): reduce sd")
                sizes[i] = float(np.log(abs(size))) if self.logarithm else size
                progress(f"sensitivity: {len(values) + len(sizes)} points")
            values.extend(sizes[i] for i in range(len(at)))
            return np.array([values[-len(at) :]])

        medians = self.medians(variants).values()
        distributions = [uncertain.around(median) for uncertain, median in zip(self.input, medians, strict=True)]
        with workers(self.n) as executor:
            if len(distributions) == 1:  # causes all of the variance; `sobol_indices` takes two or more
                quantity(distributions[0].rvs((1, 2 * self.n), random_state=self.seed))
                return np.array(values), np.ones((3, 1)), np.ones((3, 1))
            shares = sobol_indices(func=quantity, n=self.n, dists=distributions, rng=self.seed)
        samples = np.array(values)
        samples -= samples[: 2 * self.n].mean()
        both, mixed = samples[: 2 * self.n].reshape(2, -1), samples[2 * self.n :].reshape(self.n, -1).T

        def estimates(index: Array, axis: int = -1) -> Array:
            """First-order and total shares of resampled points, (2, inputs, resamples), by Saltelli's estimator."""
            (a, b), ab = both[:, index], mixed[:, index]
            variance = both[:, index].var(axis=(0, -1))
            ratios: Array = np.stack([(b * (ab - a)).mean(axis=-1), 0.5 * ((a - ab) ** 2).mean(axis=-1)]) / variance
            return ratios

        # the bootstrap of `SobolResult` has no seed
        options: Any = {"confidence_level": CONFIDENCE, "method": "percentile", "vectorized": True, "rng": self.seed}
        ends = bootstrap([np.arange(self.n)], estimates, n_resamples=999, batch=32, **options).confidence_interval
        orders = np.atleast_2d(shares.first_order, shares.total_order)
        first, total = (np.vstack([share, ends.low[i], ends.high[i]]) for i, share in enumerate(orders))
        return np.array(values), first, total


def _draw(rows: list[Any], ax: Axes) -> None:
    """Bars with their intervals."""
    for shift, name, k in ((0.2, "first order", 2), (-0.2, "total", 5)):
        places = [len(rows) - i + shift for i in range(len(rows))]
        sizes = [row[k] for row in rows]
        ends = [[max(row[k] - row[k + 1], 0.0) for row in rows], [max(row[k + 2] - row[k], 0.0) for row in rows]]
        ax.barh(places, sizes, 0.36, xerr=ends, label=name)
    ax.set_yticks([len(rows) - i for i in range(len(rows))], [row[0] for row in rows])
    ax.set_xlabel("share in the variance")
    ax.legend()
