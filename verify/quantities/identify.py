"""Quantities of identification: intervals of the section [identify], and their coverage over synthetic data."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from msgspec import Meta

from verify.errors import InputError
from verify.quantities.base import TABLES, Scene, quantity

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache

READS = (*TABLES, "identify")
Name = Annotated[str, Meta(description="fitted parameter of [identify]")]
Side = Annotated[
    Literal["half-width", "lower", "upper", "profile-lower", "profile-upper", "value", "sd"],
    Meta(description="half the width or an end of the interval, the estimate, or its standard deviation"),
]


def _study(scene: Scene, parameter: str) -> Any:
    """The section [identify]. Raises InputError where the scene or the section lacks the parameter."""
    study = scene.studies.get("identify")
    if study is None or parameter not in study.parameters:
        known = "add [identify] to the scene" if study is None else f"give one of {', '.join(study.parameters)}"
        raise InputError(f"parameter = {parameter!r} is not fitted: {known}")
    return study


@quantity("identify.interval", unit="SI", reads=READS)
def interval(scene: Scene, cache: "SolutionCache", *, parameter: Name, side: Side = "half-width") -> float:
    """95 % interval, estimate or standard deviation of a parameter identified from data, in its SI unit."""
    one = _study(scene, parameter).fitted(scene, cache)[2].estimates[parameter]
    if one.reason and side not in ("value", "sd", "profile-lower", "profile-upper"):
        raise InputError(f"parameter = {parameter!r} is not identifiable: {one.reason}")
    (lower, upper), ends = one.interval, one.profile or (None, None)
    figures = {"half-width": 0.5 * (upper - lower), "lower": lower, "upper": upper, "value": one.value, "sd": one.sd}
    figure = (figures | {"profile-lower": ends[0], "profile-upper": ends[1]})[side]
    if figure is None:
        raise InputError(f"side = {side!r}: {one.reason or 'no profile is computed, give [identify] profiles = true'}")
    return float(figure)


@quantity("identify.coverage", unit="1", reads=READS)
def coverage(
    scene: Scene,
    *,
    parameter: Name,
    repeats: Annotated[int, Meta(ge=100, le=100_000, description="number of fits")] = 2000,
) -> float:
    """Fraction of fits to synthetic data whose 95 % interval by Fisher information contains the true value."""
    from verify.identify import fit

    study = _study(scene, parameter)
    if (own := study.synthetic) is None:
        raise InputError("identify.synthetic is missing: coverage needs true values and a noise, add it")
    model = study.data(scene)[0]
    return fit.coverage(model, study.parameters, own.true, own.noise, repeats=repeats, seed=own.seed)[parameter]
