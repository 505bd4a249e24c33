"""A check: an error measured along one parameter, its tolerance, and the value from which the tolerance is exceeded."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from decimal import localcontext
from functools import partial
from importlib import import_module
from math import inf, isfinite, sqrt
from time import perf_counter
from typing import Any, TypeAlias

import numpy as np

from verify.errors import InputError
from verify.parallel import map_processes
from verify.report.result import Column, Result, Table
from verify.validation import check_choice

MODULES = ("modes", "waves", "motion")
DIGITS = 60
HALVINGS = 8
COLUMNS = [Column("check"), Column("parameter"), Column("range"), Column("tolerance", format=".3g")]
COLUMNS += [Column("worst", format=".2g"), Column("breaks at"), Column("standard", format=".1g")]
NOTE = "worst: largest error over the range; standard: that of the standard method."
Error: TypeAlias = Callable[..., float]
Points: TypeAlias = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Outcome:
    """Measured values of one check."""

    id: str
    worst: float  # largest error over the guaranteed range
    passed: bool
    points: Points  # (value, error)
    breaks_at: float | None  # value from which the tolerance is exceeded or the input refused; None if neither occurs
    breaks_by: str  # 'error', 'refused', or empty
    baseline: Points  # (value, error) of the standard method; infinite if it fails
    seconds: float


@dataclass(frozen=True)
class Check:
    """`error(value)` is at most `tolerance` for all `values` of the parameter, in their order from easy to hard."""

    id: str
    title: str
    parameter: str
    values: Sequence[float]
    tolerance: float
    error: Error  # raises InputError where the value is refused
    beyond: Sequence[float] = ()
    """Values beyond the guaranteed range, to determine where the tolerance is exceeded or the value refused."""
    refused: bool = False  # whether the range has to end with an InputError and not with a large error
    baseline: tuple[Any, ...] = ()
    """(name, error, values if different) of the standard method, which may raise any error."""
    slow: bool = False

    def run(self) -> Outcome:
        """Measure the check."""
        start, baseline = perf_counter(), list[tuple[float, float]]()
        with localcontext() as context, warnings.catch_warnings():
            context.prec = DIGITS
            points = tuple((value, _error(self.error, value)[0]) for value in self.values)
            worst = max(error for _, error in points)
            breaks_at, how = self._limit() if worst <= self.tolerance else (None, "")
            warnings.simplefilter("ignore")
            if self.baseline:
                _, error, *values = self.baseline
                baseline = [(value, _error(error, value)[0]) for value in (values[0] if values else self.values)]
        passed = worst <= self.tolerance and (how == "refused" or not self.refused)
        return Outcome(self.id, worst, passed, points, breaks_at, how, tuple(baseline), perf_counter() - start)

    def _limit(self) -> tuple[float | None, str]:
        """(first value of `beyond` that fails, 'error' or 'refused'), by bisection in the logarithm."""
        good = self.values[-1]
        for bad in self.beyond:
            error, how = _error(self.error, bad)
            if error > self.tolerance:
                break
            good = bad
        else:
            return None, ""
        for _ in range(HALVINGS):
            middle = sqrt(good) * sqrt(bad)
            error, why = _error(self.error, middle)
            good, bad, how = (good, middle, why) if error > self.tolerance else (middle, bad, how)
        return bad, how


CHECKS: dict[str, Check] = {}


def check(
    id: str,
    parameter: str,
    values: Sequence[float],
    tolerance: float,
    models: Mapping[str, str] | None = None,
    **more: Any,
) -> Callable[[Error], Error]:
    """Register an error function; default title: its docstring; `more` are fields of `Check`.

    With `models` (name: suffix of the id) one check per model, of `error(model, value)` and `baseline(model, value)`.
    """

    def register(error: Error) -> Error:
        fields = {"title": (error.__doc__ or "").partition("\n")[0].rstrip(".")} | more
        for model, word in (models or {"": ""}).items():
            name, own, bound = f"{id}-{word}".rstrip("-"), dict(fields), partial(error, model) if model else error
            if model and "baseline" in more:
                standard, baseline, *others = more["baseline"]
                own["baseline"] = (standard, partial(baseline, model), *others)
            CHECKS[name] = Check(name, parameter=parameter, values=values, tolerance=tolerance, error=bound, **own)
        return error

    return register


def registry() -> dict[str, Check]:
    """All checks by id."""
    for name in MODULES:
        import_module(f"verify.stress.{name}")
    return CHECKS


def select(ids: Sequence[str] = (), *, slow: bool = False) -> list[Check]:
    """Checks by id, or all; slow ones only by id or with `slow`. Raises InputError for an unknown id."""
    checks = registry()
    for name in ids:
        check_choice("check", name, tuple(checks))
    return [checks[name] for name in ids] or [one for one in checks.values() if slow or not one.slow]


def run(
    checks: Sequence[Check], jobs: int | None = None, progress: Callable[[str], None] = lambda id: None
) -> list[Outcome]:
    """Outcomes in the order of the checks, with `jobs` processes; default: VERIFY_JOBS."""
    ids = [one.id for one in checks]
    return map_processes(_run_by_id, ids, lambda i: progress(ids[i]), jobs)


def result(outcomes: Sequence[Outcome]) -> Result:
    """Table and data of the outcomes."""
    records = []
    for outcome in outcomes:
        check = registry()[outcome.id]
        own = {name: getattr(check, name) for name in ("id", "title", "parameter", "tolerance")}
        own |= {"from": check.values[0], "to": check.values[-1]} | asdict(outcome)
        own["baseline"] = max((error for _, error in outcome.baseline), default=None)
        records.append(own | {"baseline_name": check.baseline[0] if check.baseline else ""})
    failed = [one["id"] for one in records if not one["passed"]]
    rows = []
    for one in records:
        breaks = f"{one['breaks_at']:.3g} {one['breaks_by']}" if one["breaks_by"] else None
        values = f"{one['from']:.3g} .. {one['to']:.3g}", one["tolerance"], one["worst"], breaks, one["baseline"]
        rows.append((one["id"], one["parameter"], *values))
    return Result(
        summary=f"{len(records) - len(failed)} of {len(records)} checks are within their tolerance.",
        tables=[Table("Stress checks", COLUMNS, rows, [NOTE])],
        warnings=[f"{name} fails" for name in failed],
        data={"checks": records},
    )


def _run_by_id(name: str) -> Outcome:
    return registry()[name].run()


def _error(error: Error, value: float) -> tuple[float, str]:
    """(error, infinite if the function fails; 'error' or 'refused')."""
    try:
        size = float(error(value))
    except InputError:
        return inf, "refused"
    except (ArithmeticError, ValueError, RuntimeError):  # a baseline overflows, is singular, or does not converge
        return inf, "error"
    return (size, "error") if isfinite(size) else (inf, "error")


def worst(*errors: Any) -> float:
    """Largest absolute value in numbers and arrays; NaN if one is NaN."""
    return float(np.max([np.max(np.abs(one)) for one in errors]))
