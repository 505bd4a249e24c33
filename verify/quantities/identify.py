"""Quantities of identification: intervals of the section [identify], and their coverage over synthetic data."""

from typing import Annotated, Any, Literal

from msgspec import Meta
from msgspec.json import encode
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.identify import fit
from verify.quantities.base import TABLES, Scene, quantity

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
        own, model = study.synthetic, study.data(scene)[0]
        exact, settings = model.predict(model.values(own.true))[0], {"start": own.true, "noise": own.noise}
        return fit.fit(model, exact, study.parameters, **settings, profiles=False).estimates[parameter].sd
    model, _, found = study.fitted(scene, cache)
    one, known = found.estimates[parameter], model.known[parameter]
    if one.reason and side not in ("value", "sd", "profile-lower", "profile-upper"):
        raise InputError(f"parameter = {parameter!r} is not identifiable: {one.reason}")
    if one.profile is None and side.startswith("profile"):
        raise InputError(f"side = {side!r}: {one.reason or 'no profile is computed, give [identify] profiles = true'}")
    (lower, upper), (left, right) = one.interval, one.profile or (None, None)
    figures = {"half-width": 0.5 * (upper - lower), "lower": lower, "upper": upper, "value": one.value, "sd": one.sd}
    figures["profile-lower"] = known.lower if left is None else left
    figures["profile-upper"] = known.upper if right is None else right
    return float(figures[side])


@quantity("identify.coverage", unit="1", reads=READS)
def coverage(scene: Scene, cache: SolutionCache, *, parameter: Name, repeats: Repeats = 2000) -> float:
    """Fraction of fits to synthetic data whose 95 % interval by Fisher information contains the true value."""
    study = _study(scene, parameter, synthetic=True)
    own, model = study.synthetic, study.data(scene)[0]
    key: Any = ("coverage", encode(study), scene.beam, scene.slider, scene.drive, repeats)  # of all its parameters
    if key not in cache.motors:
        settings = {"repeats": repeats, "seed": own.seed}
        cache.motors[key] = fit.coverage(model, study.parameters, own.true, own.noise, **settings)
    return float(cache.motors[key][parameter])
