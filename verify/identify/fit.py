"""Nonlinear least squares with intervals by Fisher information and by profile likelihood.

Data y = f(p) + noise, normal and independent, of known or estimated standard deviation sigma. A parameter with a
positive lower bound is fitted by its logarithm, theta = ln p, others as they are. With the Jacobian J of f by theta the
covariance is sigma^2 (J^T J)^-1, the inverse of the Fisher information, the 95 % interval theta +- q sd(theta), and q
the quantile of Student's t, of the normal distribution for a known sigma (Seber and Wild, Nonlinear Regression, 1989,
sections 2.1, 5.2). The profile of a parameter is the least sum of squares over all others at its fixed value; its
interval has a profile within q^2 sigma^2 of the minimum (section 5.4). A parameter is not identifiable where the
information is singular, or its profile does not rise by this threshold (Raue et al., Bioinformatics 25:1923, 2009).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from verify.arrays import Array, BoolArray, Indices
from verify.errors import InputError, near_name
from verify.formatting import one_line

Values: TypeAlias = dict[str, float]
REJECTED, HARD, WIDER, ROUGH = 0.01, 0.1, 3.0, 0.1
"""Probability below which residuals contradict the model; relative half width of an interval that needs a profile;
factor by which an interval by differences may be too short; relative noise that is too large to be estimated from the
residuals, which are as large where the fit is wrong."""
SINGULAR, INVOLVED = 1e5, 0.05
"""Condition of the Jacobian with columns of unit length, above which it is singular; least component of a singular
direction, over its largest, in relative changes, that involves a parameter."""
DOUBLINGS, END, LAGS, FEWEST = 12, 1e-7, 8, 24
"""Steps outwards of a profile; tolerance of its ends, in such steps: below it is the rounding of the least squares;
lags of the test of white residuals, and its least number of residuals."""
LARGE = "the residuals are larger than the noise, the model, the start or the noise is wrong"
UNLIKELY = "the residuals are above 10 %, the model or the start is wrong; give the noise if the data are that rough"
COLOURED = "the residuals are not white, the model is incomplete and the intervals are too short"


@dataclass(frozen=True)
class Parameter:
    """Value, unit and bounds of a parameter."""

    value: float
    unit: str = ""
    lower: float = -np.inf
    upper: float = np.inf


@dataclass(frozen=True, eq=False)
class Model:
    """y over x by parameters: their values by name -> (y (n,), derivatives (n,) by name, None for differences).

    y has `channels` parts over all of `x`; of two, the second is an angle. `labels`: (name, unit) of x and y; `logs`: y
    is the logarithm of its label.
    """

    known: Mapping[str, Parameter]
    predict: Callable[[Values], tuple[Array, Mapping[str, Array] | None]]
    x: Array
    labels: tuple[tuple[str, str], tuple[str, str]]
    channels: int = 1
    logs: bool = False

    def values(self, changed: Mapping[str, float] = {}, names: Sequence[str] = ()) -> Values:
        """Values of all parameters. Raises InputError for unknown or repeated names, and values outside the bounds."""
        for name in (*changed, *names):
            if name not in self.known or names.count(name) > 1:
                remedy = "give it once" if name in self.known else near_name(name, tuple(self.known))
                raise InputError(f"parameters: {name!r} is unknown to this model, or repeated: {remedy}")
        for name, value in changed.items():
            one = self.known[name]
            if not one.lower <= value <= one.upper:
                raise InputError(f"{name} = {value!r}: give a value from {one.lower:.4g} to {one.upper:.4g} {one.unit}")
        return {name: one.value for name, one in self.known.items()} | dict(changed)


@dataclass(frozen=True, eq=False)
class Estimate:
    """A fitted parameter; `interval` by Fisher information, not beyond its bounds, `profile` with None for no end.

    `reason`: why it is not identifiable; empty where it is.
    """

    name: str
    unit: str
    value: float
    sd: float
    interval: tuple[float, float]
    profile: tuple[float | None, float | None] | None
    reason: str


@dataclass(frozen=True, eq=False)
class Fit:
    """A model fitted to data: `curve` and `residuals` (data - curve), (n,); `noise`, the sd that the intervals use.

    `chi2` is the sum of squares over noise^2, `fitness` the probability of more if the model holds, None where the
    noise is estimated; `whiteness` that of more correlated residuals, None for too few. `rejected`: of LARGE,
    UNLIKELY and COLOURED those that hold.
    """

    estimates: Mapping[str, Estimate]
    curve: Array
    residuals: Array
    noise: float
    freedom: int
    chi2: float | None
    fitness: float | None
    whiteness: float | None
    rejected: tuple[str, ...]
    __repr__ = one_line(noise="", freedom="", residuals="")


class Problem:
    """Residuals of a model in the coordinates theta (p,), their least squares, and profiles."""

    def __init__(self, model: Model, data: Array, names: Sequence[str], fixed: Values) -> None:
        known = [model.known[name] for name in names]
        self.model, self.data, self.names, self.fixed = model, data, names, fixed
        self.logs = np.array([one.lower > 0.0 for one in known])
        rows = [fixed[name] for name in names], [one.lower for one in known], [one.upper for one in known]
        self.start, self.lower, self.upper = np.where(self.logs, np.log(np.where(self.logs, rows, 1.0)), rows)
        self.last: tuple[bytes, tuple[Array, Any, Array]] | None = None

    def values(self, theta: Array) -> Array:
        """Parameters of coordinates, (p,)."""
        return np.where(self.logs, np.exp(np.where(self.logs, theta, 0.0)), theta)

    def at(self, theta: Array) -> tuple[Array, Any, Array]:
        """Curve - data, Jacobian by theta (n, p), curve; the last point is stored, as scipy evaluates it twice."""
        if self.last is None or self.last[0] != theta.tobytes():
            values, half = self.values(theta), len(self.data) // 2
            curve, by = self.model.predict(self.fixed | dict(zip(self.names, values.tolist(), strict=True)))
            rest, scale = curve - self.data, np.where(self.logs, values, 1.0)
            if self.model.channels == 2:
                rest[half:] = (rest[half:] + np.pi) % (2.0 * np.pi) - np.pi
            self.last = theta.tobytes(), (rest, by and np.array([by[name] for name in self.names]).T * scale, curve)
        return self.last[1]

    def solve(self, theta: Array, free: Indices) -> Any:
        """Least squares over the coordinates `free`, others as in theta."""
        from scipy.optimize import least_squares

        def at(part: Array) -> tuple[Array, Any, Array]:
            whole = theta.copy()
            whole[free] = part
            return self.at(whole)

        exact: Any = "3-point" if at(theta[free])[1] is None else lambda part: at(part)[1][:, free]
        return least_squares(
            lambda part: at(part)[0],
            theta[free],
            exact,
            (self.lower[free], self.upper[free]),
            x_scale="jac",
            xtol=1e-9,
            ftol=1e-11,
            gtol=1e-14,
            max_nfev=200,
            diff_step=1e-3,  # of a simulation, far above the tolerance of its time steps
        )

    def profile_end(self, theta: Array, i: int, step: float, rise: float) -> float | None:
        """The value of parameter i at which its profile is rise^2 above the best fit theta; None without that rise.

        `step`, with its sign, is the distance of this value by Fisher information.
        """
        from scipy.optimize import brentq

        others, edge = np.delete(np.arange(len(theta)), i), float((self.upper if step > 0.0 else self.lower)[i])
        least, far = float((self.at(theta)[0] ** 2).sum()), float(theta[i])

        def excess(to: float) -> float:
            point = theta.copy()
            point[i] = to
            if len(others):  # from the best fit: the last optimum may be at a bound, without a gradient
                point[others] = self.solve(point, others).x
            return float(np.sqrt(max((self.at(point)[0] ** 2).sum() - least, 0.0))) - rise

        for k in range(DOUBLINGS):
            near, far = far, float(theta[i]) + 2.0**k * step
            far = min(far, edge) if step > 0.0 else max(far, edge)
            if far != near and excess(far) > 0.0:
                root = brentq(excess, near, far, xtol=END * abs(far - near))
                return float(np.exp(root) if self.logs[i] else root)
        return None


def fit(
    model: Model,
    data: Array,
    names: Sequence[str],
    *,
    start: Mapping[str, float] = {},
    noise: float | None = None,
    profiles: bool | None = None,
) -> Fit:
    """Fit the parameters `names` to data (n,); others keep the value of `start` or of the model.

    `noise`: standard deviation in the unit of y; None: by the residuals. `profiles`: None where an interval is wide.
    Raises InputError for unknown names, values outside the bounds, too few data, and a fit that does not converge.
    """
    from scipy.special import chdtrc, ndtri, stdtrit

    fixed, n, p = model.values(start, names), len(data), len(names)
    if n < p + (noise is None):
        raise InputError(f"data: {n} values for {p} parameters, give more, or the noise")
    problem = Problem(model, data, names, fixed)
    solved = problem.solve(problem.start, np.arange(p))
    if solved.status < 1:
        raise InputError(f"start = {dict(start)!r}: the fit does not converge, start nearer to the solution")
    theta, logs, least = solved.x, problem.logs, 2.0 * float(solved.cost)
    scale = np.where(logs, 1.0, abs(theta))
    undetermined, involved, unit_sds = determined(solved.jac, scale)
    freedom = n - p + undetermined
    sigma = noise if noise is not None else float(np.sqrt(least / freedom))
    quantile = float(ndtri(0.975) if noise is not None else stdtrit(freedom, 0.975))
    sds = np.where(involved, np.inf, sigma * unit_sds)
    reach = np.minimum(quantile * sds, 1e3 * np.maximum(1.0, abs(theta)))
    profiles = bool((reach > HARD * scale).any()) if profiles is None else profiles
    (rest, exact, curve), values, estimates = problem.at(theta), problem.values(theta), dict[str, Estimate]()
    ends = [problem.values(np.clip(theta + side * reach, problem.lower, problem.upper)) for side in (-1.0, 1.0)]
    for i, name in enumerate(names):
        one, interval = model.known[name], (float(ends[0][i]), float(ends[1][i]))
        others = ", ".join(other for other, k in zip(names, involved, strict=True) if k and other != name)
        sd, profile, reason = float(sds[i] * values[i] if logs[i] else sds[i]), None, ""
        if not solved.jac[:, i].any():
            reason = "the data do not depend on it"
        elif involved[i] and others:
            reason = f"the data determine only its combination with {others}, fix one of them"
        elif profiles:
            left, right = (problem.profile_end(theta, i, side * reach[i], quantile * sigma) for side in (-1.0, 1.0))
            missing = [edge for edge, end in (("lower", left), ("upper", right)) if end is None]
            profile, reason = (left, right), f"its profile has no {' and no '.join(missing)} end" if missing else ""
        elif interval[0] <= one.lower or interval[1] >= one.upper or (logs[i] and quantile * sd >= values[i]):
            reason = "its interval includes a bound or zero"
        if not reason and exact is None:  # a step of the curve, as where a slider comes to stick, is not its slope
            sides = (theta + side * reach * (np.arange(p) == i) for side in (-1.0, 1.0))
            rises = [(problem.at(np.clip(at, problem.lower, problem.upper))[0] ** 2).sum() - least for at in sides]
            if min(rises) < (quantile * sigma / WIDER) ** 2:
                reason = "the data change less over its interval than their derivative states"
        estimates[name] = Estimate(name, one.unit, float(values[i]), sd, interval, profile, reason)
    ratio = least / noise**2 if noise else None
    fitness = None if ratio is None or not freedom else float(chdtrc(freedom, ratio))
    white = whiteness(rest.reshape(model.channels, -1)) if sigma > 1e-9 * abs(curve).max() else None  # else rounding
    tests = {LARGE: fitness, COLOURED: white, UNLIKELY: 0.0 if model.logs and not noise and sigma > ROUGH else None}
    rejected = tuple(words for words, chance in tests.items() if chance is not None and chance < REJECTED)
    return Fit(estimates, curve, -rest, sigma, freedom, ratio, fitness, white, rejected)


def determined(jacobian: Array, scale: Array) -> tuple[int, BoolArray, Array]:
    """(number of combinations of parameters that the data leave open, parameters in them, sds for noise of 1).

    By a Jacobian (n, p) over coordinates of typical sizes `scale`, (p,).
    """
    norms = np.linalg.norm(jacobian, axis=0)
    size = np.where(norms > 0.0, norms, 1.0)
    _, scales, directions = np.linalg.svd(jacobian / size, full_matrices=False)
    loose = scales * SINGULAR < scales[0]
    changes = abs(directions[loose]) / (size * scale + 1e-300)
    involved = (changes > INVOLVED * changes.max(axis=1, keepdims=True)).any(axis=0) | (norms == 0.0)
    inverse = ((directions[~loose] / scales[~loose, None]) ** 2).sum(axis=0)
    return int(loose.sum()), involved, np.sqrt(inverse) / size


def whiteness(rest: Array) -> float | None:
    """Probability of more correlated residuals (channels, m) if they are white (Ljung and Box, Biometrika 65, 1978)."""
    from scipy.special import chdtrc

    channels, m = rest.shape
    if m < FEWEST or not rest.any(axis=1).all():
        return None
    rest = rest - rest.mean(axis=1, keepdims=True)
    r = [(rest[:, k:] * rest[:, :-k]).sum(axis=1) / (rest**2).sum(axis=1) for k in range(1, LAGS + 1)]
    q = m * (m + 2.0) * sum((one**2).sum() / (m - k) for k, one in enumerate(r, start=1))
    return float(chdtrc(LAGS * channels, q))


def coverage(
    model: Model, names: Sequence[str], true: Mapping[str, float], noise: float, *, repeats: int, seed: int = 0
) -> dict[str, float]:
    """Fraction of fits to synthetic data whose interval by Fisher information contains the true value, by name.

    The fits start from the true values and estimate the noise. Raises InputError.
    """
    values, rng, hits = model.values(true), np.random.default_rng(seed), dict.fromkeys(names, 0)
    exact = model.predict(values)[0]
    for _ in range(repeats):
        found = fit(model, exact + noise * rng.standard_normal(len(exact)), names, start=values, profiles=False)
        for name, one in found.estimates.items():
            hits[name] += one.interval[0] <= values[name] <= one.interval[1]
    return {name: count / repeats for name, count in hits.items()}
