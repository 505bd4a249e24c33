"""Nonlinear least squares with intervals by Fisher information and by profile likelihood.

Data y = f(p) + noise, normal and independent, of known or of estimated standard deviation sigma. A positive parameter
is fitted by its logarithm, theta = ln p, others as they are. With the Jacobian J of f by theta the covariance of theta
is sigma^2 (J^T J)^-1, its inverse the Fisher information, and the interval theta +- q sd(theta), q the quantile of
Student's t at n - p degrees of freedom, of the normal distribution for a known sigma (Seber and Wild, Nonlinear
Regression, 1989, sections 2.1 and 5.2). The profile of a parameter is the least sum of squares over all others at a
fixed value; its interval contains the values at which the profile is within q^2 sigma^2 of the minimum (section 5.4). A
parameter is not identifiable where the information is singular (structurally), or where its profile never rises by the
threshold on one side (practically; Raue et al., Bioinformatics 25:1923, 2009).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError, near_name

Values: TypeAlias = dict[str, float]
Side: TypeAlias = Literal["value", "sd", "lower", "upper", "half-width"]
LEVEL, REJECTED = 0.95, 0.01
"""Probability of the intervals; probability below which residuals contradict the model."""
SINGULAR, INVOLVED = 1e5, 0.05
"""Condition of the Jacobian with columns of unit length (square root of that of the scaled information), above which it
is singular; least component of a singular direction that involves a parameter."""
DOUBLINGS, LAGS, FEWEST = 12, 8, 24
"""Most steps outwards of a profile; lags of a test of white residuals, and its least number of residuals."""
DIFFERENCE = 1e-3
"""Relative step of finite differences, for a model that is a simulation."""
LARGE = "The residuals are larger than the noise: the model, or the noise, is wrong."
SMALL = "The residuals are smaller than the noise: the noise is overestimated."
COLOURED = "The residuals are not white: the model is incomplete, and the intervals are too short."


@dataclass(frozen=True)
class Parameter:
    """A parameter of a model with its value, unit and bounds; with a positive lower bound fitted by its logarithm."""

    value: float
    unit: str = ""
    lower: float = -np.inf
    upper: float = np.inf


@dataclass(frozen=True, eq=False)
class Model:
    """y over x as a function of parameters by name: their values -> (y (n,), derivatives (n,) by name).

    Without derivatives the fit takes central differences. `phases`: first and last+1 of the entries of y that are angles. `channels`: equal
    parts of y, each over the whole of `x`. `labels`: (name, unit) of x and y. `logs`: y is the logarithm of its label.
    """

    known: Mapping[str, Parameter]
    predict: Callable[[Values], tuple[Array, Mapping[str, Array] | None]]
    x: Array
    labels: tuple[tuple[str, str], tuple[str, str]]
    phases: tuple[int, int] = (0, 0)
    channels: int = 1
    logs: bool = False

    def defaults(self, values: Mapping[str, float] = {}) -> Values:
        """Values of all parameters, by default those of the model. Raises InputError for an unknown name."""
        for name, value in values.items():
            one = self.known.get(name)
            if one is None:
                raise InputError(f"parameter = {name!r} is not known: {near_name(name, tuple(self.known))}")
            if not one.lower <= value <= one.upper:
                raise InputError(f"{name} = {value!r}: give a value from {one.lower:.4g} to {one.upper:.4g} {one.unit}")
        return {name: one.value for name, one in self.known.items()} | dict(values)

    def synthetic(self, true: Mapping[str, float], noise: float, seed: int) -> Array:
        """Data of true values with normal noise of this standard deviation, (n,)."""
        y = self.predict(self.defaults(true))[0]
        return y + noise * np.random.default_rng(seed).standard_normal(len(y))


@dataclass(frozen=True, eq=False)
class Estimate:
    """A fitted parameter; intervals (lower, upper) of 95 %, infinite or None where they do not exist."""

    name: str
    unit: str
    value: float
    sd: float
    interval: tuple[float, float]
    profile: tuple[float | None, float | None] | None
    """By profile likelihood, None on a side without rise; None altogether without a profile."""
    reason: str
    """Why it is not identifiable; empty where it is."""

    def read(self, side: Side, profile: bool = False) -> float:
        """Value, standard deviation, a bound of an interval or half its width. Raises InputError for none."""
        lower, upper = (self.profile or (None, None)) if profile else self.interval
        figures = {"value": self.value, "sd": self.sd, "lower": lower, "upper": upper}
        figures["half-width"] = None if lower is None or upper is None else 0.5 * (upper - lower)
        figure = figures[side]
        if figure is None or not np.isfinite(figure):
            raise InputError(f"parameter = {self.name!r} has no {side}: {self.reason or 'it has no profile'}")
        return float(figure)


@dataclass(frozen=True, eq=False)
class Fit:
    """The fit of a model to data; `curve` and `residuals` (n,), `noise` the standard deviation that the fit uses."""

    estimates: tuple[Estimate, ...]
    curve: Array
    residuals: Array
    noise: float
    freedom: int
    chi2: float | None
    """Sum of squares over sigma^2; None where sigma is estimated."""
    fitness: float | None
    """Probability of a larger chi^2 if the model holds; None where sigma is estimated."""
    whiteness: float | None
    """Probability of more correlated residuals if they are white (Ljung and Box); None for too few."""
    correlation: Array
    condition: float
    """Condition of the Jacobian with columns of unit length."""
    rejected: tuple[str, ...]
    """Why the model, or its noise, contradicts the data."""

    def __getitem__(self, name: str) -> Estimate:
        """The estimate of a parameter. Raises InputError for one that is not fitted."""
        names = [one.name for one in self.estimates]
        if name not in names:
            raise InputError(f"parameter = {name!r} is not fitted: {near_name(name, names)}")
        return self.estimates[names.index(name)]


@dataclass(frozen=True, eq=False)
class Problem:
    """Least squares of a model, parameters `names` in coordinates theta, others at fixed values."""

    model: Model
    data: Array
    names: Sequence[str]
    fixed: Values
    last: dict[bytes, Any] = field(default_factory=dict)

    @cached_property
    def logs(self) -> Any:
        """(p,), which parameters are fitted by their logarithm."""
        return np.array([self.model.known[name].lower > 0.0 for name in self.names])

    def theta(self, values: Any) -> Array:
        """Coordinates of values, (p,)."""
        values = np.array(values, dtype=float)
        return np.where(self.logs, np.log(np.where(self.logs, values, 1.0)), values)

    def values(self, theta: Array) -> Array:
        """Values of coordinates, (p,)."""
        return np.where(self.logs, np.exp(np.clip(np.where(self.logs, theta, 0.0), -600.0, 600.0)), theta)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of theta, (p,) each."""
        known = [self.model.known[name] for name in self.names]
        return self.theta([one.lower for one in known]), self.theta([one.upper for one in known])

    def at(self, theta: Array) -> tuple[Array, Array | None, Array]:
        """(residuals (n,), Jacobian (n, p) by theta, curve (n,)); the last point is stored."""
        if (key := theta.tobytes()) not in self.last:
            values = self.values(theta)
            curve, by = self.model.predict(self.fixed | dict(zip(self.names, values.tolist(), strict=True)))
            rest = curve - self.data
            angles = slice(*self.model.phases)
            rest[angles] = (rest[angles] + np.pi) % (2.0 * np.pi) - np.pi
            jacobian = None if by is None else np.array([by[name] for name in self.names]).T
            if jacobian is not None:
                jacobian = jacobian * np.where(self.logs, values, 1.0)
            self.last.clear()
            self.last[key] = rest, jacobian, curve
        return self.last[key]  # type: ignore[no-any-return]

    def solve(self, start: Array, free: Indices) -> Any:
        """scipy's result over the coordinates `free`, others as in `start`."""
        from scipy.optimize import least_squares

        def full(part: Array) -> Array:
            theta = start.copy()
            theta[free] = part
            return theta

        lower, upper = (bound[free] for bound in self.bounds)
        start = np.clip(start, *self.bounds)
        exact: Any = "3-point" if self.at(start)[1] is None else lambda part: self.at(full(part))[1][:, free]  # type: ignore[index]
        return least_squares(
            lambda part: self.at(full(part))[0], start[free], exact, (lower, upper), x_scale="jac", xtol=1e-9,
            ftol=1e-11, gtol=1e-14, diff_step=DIFFERENCE, max_nfev=200,
        )  # fmt: skip


def fit(
    model: Model,
    data: Array,
    names: Sequence[str],
    *,
    start: Mapping[str, float] = {},
    noise: float | None = None,
    profiles: bool = True,
) -> Fit:
    """Fit the parameters `names` to data (n,); others keep the value of `start` or of the model.

    `noise`: standard deviation of the data, in the unit of y; None: estimated from the residuals. Raises InputError for
    unknown names, values outside the bounds, too few data, and a fit that does not converge.
    """
    from scipy.stats import chi2, norm, t

    fixed, n, p = model.defaults(start), len(data), len(names)
    if n < p + (noise is None):
        raise InputError(f"data: {n} values for {p} parameters, give more{', or the noise' if n == p else ''}")
    problem = Problem(model, data, names, fixed)
    solved = problem.solve(problem.theta([fixed[name] for name in names]), np.arange(p))
    if solved.status < 1:
        raise InputError(f"start = {dict(start)!r}: the fit does not converge, start nearer to the solution")
    theta, squares, freedom = solved.x, 2.0 * float(solved.cost), n - p
    sigma = noise if noise is not None else float(np.sqrt(squares / freedom))
    quantile = float(norm.ppf(0.5 + 0.5 * LEVEL) if noise is not None else t.ppf(0.5 + 0.5 * LEVEL, freedom))
    # Information of columns of unit length: its singular directions are combinations that the data do not determine.
    size = np.linalg.norm(solved.jac, axis=0)
    _, scales, directions = np.linalg.svd(solved.jac / np.where(size > 0.0, size, 1.0), full_matrices=False)
    loose = scales * SINGULAR < scales[0]
    weight = size * np.where(problem.logs, 1.0, abs(theta)) + 1e-300  # of relative changes
    changes = abs(directions[loose]) / weight
    involved = (changes > INVOLVED * changes.max(axis=1, keepdims=True)).any(axis=0) | (size == 0.0)
    inverse = (directions[~loose].T / scales[~loose] ** 2) @ directions[~loose]
    covariance = sigma**2 * inverse / np.outer(size, size).clip(1e-300)
    sds = np.where(involved, np.inf, np.sqrt(np.diag(covariance)))
    values, estimates = problem.values(theta), []
    reach = quantile * np.minimum(sds, 1e300)
    ends = np.array([problem.values(np.clip(theta + side * reach, *problem.bounds)) for side in (-1.0, 1.0)]).T
    for i, name in enumerate(names):
        one, log, reason, profile = model.known[name], problem.logs[i], "", None
        sd = float(sds[i] * values[i] if log else sds[i])
        others = [other for other, k in zip(names, involved, strict=True) if k and other != name]
        if involved[i] and (others or not profiles or size[i] == 0.0):
            reason = f"only a combination with {', '.join(others)} is" if others else "the data do not depend on it"
        elif profiles:
            profile = tuple(_profile_end(problem, theta, i, side, quantile * sigma, reach[i]) for side in (-1, 1))
            missing = [edge for end, edge in zip(profile, ("lower", "upper"), strict=True) if end is None]
            reason = f"its profile has no {' and no '.join(missing)} end" if missing else ""
        elif ends[i, 0] <= one.lower or ends[i, 1] >= one.upper or (log and quantile * sd >= values[i]):
            reason = "its interval includes a bound or zero"
        estimates.append(Estimate(name, one.unit, float(values[i]), sd, tuple(ends[i].tolist()), profile, reason))
    rest, _, curve = problem.at(theta)
    fitness = float(chi2.sf(squares / noise**2, freedom)) if noise and freedom else None
    whiteness = _whiteness(rest.reshape(model.channels, -1))
    deviations = np.where(involved, 1.0, sds)
    return Fit(
        estimates=tuple(estimates),
        curve=curve,
        residuals=-rest,
        noise=sigma,
        freedom=freedom,
        chi2=squares / noise**2 if noise else None,
        fitness=fitness,
        whiteness=whiteness,
        correlation=covariance / np.outer(deviations, deviations),
        condition=float(scales[0] / scales[-1]) if scales[-1] > 0.0 else np.inf,
        rejected=tuple(
            words
            for words, contradicted in (
                (LARGE, fitness is not None and fitness < REJECTED),
                (SMALL, fitness is not None and fitness > 1.0 - REJECTED),
                (COLOURED, whiteness is not None and whiteness < REJECTED),
            )
            if contradicted
        ),
    )


def _profile_end(problem: Problem, theta: Array, i: int, side: int, threshold: float, step: float) -> float | None:
    """The value of parameter i on one side at which the root of the rise of its profile is `threshold`.

    `step` is the distance by Fisher information. None where the profile stays below up to the bound.
    """
    from scipy.optimize import brentq

    others, edge = np.delete(np.arange(len(theta)), i), float(problem.bounds[int(side > 0)][i])
    least = float((problem.at(theta)[0] ** 2).sum())
    step = min(step, 1e3 * max(1.0, abs(float(theta[i]))))

    def excess(at: float) -> float:
        point = theta.copy()
        point[i] = at
        if len(others):  # from the best fit: in a flat direction the last optimum may be at a bound, without gradient
            point[others] = problem.solve(point, others).x
        rise = float((problem.at(point)[0] ** 2).sum()) - least
        return float(np.sqrt(max(rise, 0.0))) - threshold

    inner, outer = float(theta[i]), float(theta[i])
    for _ in range(DOUBLINGS):
        inner, outer = outer, float(theta[i]) + side * step
        outer = min(outer, edge) if side > 0 else max(outer, edge)
        if excess(outer) > 0.0:
            ends = {float(theta[i]): -threshold}
            root = brentq(lambda at: ends.get(at) or excess(at), inner, outer, xtol=1e-4 * abs(outer - inner))
            return float(problem.values(np.where(np.arange(len(theta)) == i, root, theta))[i])
        if outer == edge:
            return None
        step *= 2.0
    return None


def _whiteness(rest: Array) -> float | None:
    """Probability of more correlated residuals (channels, m) if they are white; None for too few.

    Ljung and Box, Biometrika 65:297 (1978).
    """
    from scipy.stats import chi2

    channels, m = rest.shape
    if m < FEWEST or not rest.any():
        return None
    rest = rest - rest.mean(axis=1, keepdims=True)
    power = (rest**2).sum(axis=1)
    lags = range(1, LAGS + 1)
    r = np.array([(rest[:, k:] * rest[:, :-k]).sum(axis=1) / power for k in lags])
    q = m * (m + 2.0) * sum((r[k - 1] ** 2).sum() / (m - k) for k in lags)
    return float(chi2.sf(q, LAGS * channels))


def coverage(
    model: Model, names: Sequence[str], true: Mapping[str, float], noise: float, *, repeats: int, seed: int = 0
) -> dict[str, float]:
    """Fraction of fits to synthetic data whose interval by Fisher information contains the true value, by name.

    The fits know the noise; they start from the true values. Raises InputError.
    """
    values, rng, hits = model.defaults(true), np.random.default_rng(seed), dict.fromkeys(names, 0)
    exact = model.predict(values)[0]
    for _ in range(repeats):
        data = exact + noise * rng.standard_normal(len(exact))
        for one in fit(model, data, names, start=values, noise=noise, profiles=False).estimates:
            hits[one.name] += one.interval[0] <= values[one.name] <= one.interval[1]
    return {name: count / repeats for name, count in hits.items()}
