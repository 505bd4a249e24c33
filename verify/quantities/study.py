"""Quantities of studies: numbers in their tables; intervals of [identify], and their coverage over synthetic data."""

from typing import Annotated, Any, Literal

from msgspec import Meta
from msgspec.json import encode
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.identify import fit
from verify.quantities.base import TABLES, Scene, quantity
from verify.studies.base import OWN, result_of

READS = (*TABLES, "identify")
Name = Annotated[str, Meta(description="fitted parameter of [identify]")]
Side = Annotated[
    Literal["half-width", "lower", "upper", "profile-lower", "profile-upper", "value", "sd", "cramer-rao"],
    Meta(description="of the interval or the profile (its bound for no end), the estimate or its deviation"),
]
Repeats = Annotated[int, Meta(ge=100, le=100_000, description="number of fits")]
Until = Annotated[float, Meta(gt=0, description="end of the synthetic data, in the unit of their span")]


def _study(scene: Scene, parameter: str, *, synthetic: bool = False) -> Any:
    """The section [identify]. Raises InputError where it or the scene lacks the parameter, or synthetic data."""
    study = scene.studies.get("identify")
    if study is None or parameter not in study.parameters:
        known = "add [identify] to the scene" if study is None else f"give one of {', '.join(study.parameters)}"
        raise InputError(f"parameter = {parameter!r} is not fitted: {known}")
    if synthetic and study.synthetic is None:
        raise InputError("identify.synthetic is missing: this figure needs true values and a noise, add it")
    return study


@quantity("identify.interval", unit="SI", reads=READS)
def interval(
    scene: Scene, cache: SolutionCache, *, parameter: Name, side: Side = "half-width", until: Until | None = None
) -> float:
    """95 % interval, estimate or standard deviation of a parameter identified from data, in its SI unit."""
    study = _study(scene, parameter, synthetic=until is not None or side == "cramer-rao")
    if until is not None:
        (first, last), steps = study.synthetic.span, study.synthetic.points - 1
        remaining = int((until - first) / (last - first) * steps * (1.0 + 1e-12))  # intervals between the points
        if not 1 <= remaining <= steps:
            raise InputError(f"until = {until!r} is not within identify.synthetic.span: give up to {last:g}")
        span = first, first + (last - first) * remaining / steps
        study = replace(study, synthetic=replace(study.synthetic, span=span, points=remaining + 1))
    if side == "cramer-rao":
        true, noise, model = study.synthetic.true, study.synthetic.noise, study.data(scene)[0]
        exact = model.predict(model.values(true))[0]
        result = fit.fit(model, exact, study.parameters, start=true, noise=noise, profiles=False)
        return result.estimates[parameter].sd
    model, _, result = study.fitted(scene, cache)
    estimate, bounds = result.estimates[parameter], model.known[parameter]
    if estimate.reason and side not in ("value", "sd", "profile-lower", "profile-upper"):
        raise InputError(f"parameter = {parameter!r} is not identifiable: {estimate.reason}")
    if estimate.profile is None and side.startswith("profile"):
        reason = estimate.reason or "no profile is computed, give [identify] profiles = true"
        raise InputError(f"side = {side!r}: {reason}")
    (lower, upper), (left, right) = estimate.interval, estimate.profile or (None, None)
    figures = {"half-width": 0.5 * (upper - lower), "lower": lower, "upper": upper}
    figures["profile-lower"] = bounds.lower if left is None else left
    figures["profile-upper"] = bounds.upper if right is None else right
    return float(figures[side] if side in figures else getattr(estimate, side))


@quantity("identify.coverage", unit="1", reads=READS)
def coverage(scene: Scene, cache: SolutionCache, *, parameter: Name, repeats: Repeats = 2000) -> float:
    """Fraction of fits to synthetic data whose 95 % interval by Fisher information contains the true value."""
    study = _study(scene, parameter, synthetic=True)
    synthetic, model = study.synthetic, study.data(scene)[0]
    of: Any = (model, study.parameters, synthetic.true, synthetic.noise)
    key = "coverage", encode(study), scene.beam, scene.slider, scene.drive, repeats  # of all its parameters
    return float(cache.once(key, lambda: fit.coverage(*of, repeats=repeats, seed=synthetic.seed))[parameter])


@quantity("study.value", unit="SI", reads=(*TABLES, *OWN), devices=True)
def value(
    scene: Scene,
    cache: SolutionCache,
    *,
    study: Annotated[str, Meta(description="name of its section, for instance optimise")],
    row: Annotated[str, Meta(description="first entry of the row")],
    column: Annotated[str, Meta(description="heading of the column, without its unit")],
) -> float:
    """A number in a table of a study of the scene, in its SI unit."""
    records = [record for table in result_of(study, scene, cache).tables for record in table.records()]
    for record in records:
        if str(next(iter(record.values()))) == row and isinstance(number := record.get(column), int | float):
            return float(number)
    raise InputError(
        f"row = {row!r}, column = {column!r}: no table of [{study}] has a number there, see `verify table`"
    )
