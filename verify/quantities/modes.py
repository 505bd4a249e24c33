"""Quantities of modes: frequencies, shapes, errors, orders, bounds, required N; the paper's drive rule; buckling."""

from typing import TYPE_CHECKING, Annotated, Literal

from msgspec import Meta

from verify.checks import Relative, check_sizes
from verify.errors import InputError
from verify.judge.bracket import Bracket
from verify.models.catalogue import MODELS
from verify.models.naming import MEAN, model_meta
from verify.quantities.base import Place, Scene, quantity
from verify.quantities.options import (
    AnyModel,
    DiscreteModel,
    Frequency,
    Mode,
    ModelOptions,
    ModesModel,
    Reading,
    Size,
    Sizes,
    check_count,
    drive_frequency,
)

if TYPE_CHECKING:
    from verify.judge.cache import SolutionCache

BEAM = ("beam",)


@quantity("mode.frequency", unit="Hz", reads=BEAM)
def frequency(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: AnyModel,
    mode: Mode,
    count: Size | None = None,
) -> float:
    """Natural frequency of one mode."""
    check_count(model, count)
    settings = options.settings(model)
    return cache.exact_hz(mode, options.theory) if count is None else cache.frequency_hz(model, count, mode, settings)


@quantity("mode.frequency_error", unit="1", reads=BEAM)
def frequency_error(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: AnyModel,
    mode: Mode,
    count: Size | None = None,
) -> float:
    """Signed error relative to the exact frequency by the same theory; of the exact beam, to Euler-Bernoulli theory."""
    check_count(model, count)
    settings = options.settings(model)
    if count is not None:
        return cache.frequency_error(model, count, mode, settings)
    exact = cache.exact_hz(mode)
    return (cache.exact_hz(mode, options.theory) - exact) / exact


@quantity("mode.plate_error", unit="1", reads=BEAM)
def plate_error(scene: Scene, cache: "SolutionCache", *, mode: Mode) -> float:
    """Frequency as a thin plate with free long edges, relative to Euler-Bernoulli theory, less 1."""
    from verify.exact.plate_strip import plate_error

    return plate_error(scene.beam, mode)


@quantity("mode.law_ratio", unit="1", reads=BEAM)
def law_ratio(
    scene: Scene, cache: "SolutionCache", options: ModelOptions, *, model: DiscreteModel, mode: Mode, count: Size
) -> float:
    """Frequency error over its leading term, mu^4/1440 or mu^4 (-1/1440 + c/(12 N)), mu = beta l."""
    from verify.exact.closed_forms import check_uniform
    from verify.exact.error_laws import law_of, leading_error

    settings = options.settings(model)
    law_of(model)
    check_uniform(scene.beam)
    for name, value in settings:
        if name in ("theory", "grading") or (name == "wall" and "clamped" in scene.beam.supports):
            raise InputError(f"{name} = {value!r}: the leading law has none, leave it out or use mode.frequency_error")
    law = leading_error(model, scene.beam.supports, mode, count)
    return cache.frequency_error(model, count, mode, settings) / law


@quantity("mode.shape_error", unit="1", reads=BEAM)
def shape_error(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: DiscreteModel,
    mode: Mode,
    count: Size,
    reading: Reading | None = None,
) -> float:
    """Relative L2 error of the mass-normalised deflection at the model's nodes."""
    return cache.shape_error(model, count, mode, reading, options.settings(model))


@quantity("mode.curvature_error", unit="1", reads=BEAM)
def curvature_error(
    scene: Scene, cache: "SolutionCache", options: ModelOptions, *, model: DiscreteModel, mode: Mode, count: Size
) -> float:
    """Relative L2 error of the curvature at joints or Gauss points."""
    return cache.curvature_error(model, count, mode, options.settings(model))


def _shape(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    model: str,
    mode: int,
    x: float,
    count: int | None,
    d: int,
) -> float:
    from verify.models.places import places

    check_count(model, count)
    at = places("x", x, scene.beam.length).ravel()
    return cache.shape_at(model, count, mode, at, d, options.settings(model))


@quantity("mode.deflection", unit="1/sqrt(kg)", reads=BEAM)
def deflection(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: ModesModel,
    mode: Mode,
    x: Place,
    count: Size | None = None,
) -> float:
    """Deflection of a mode of modal mass 1 kg at x, positive at the first displacement from the left end."""
    return _shape(scene, cache, options, model, mode, x, count, 0)


@quantity("mode.slope", unit="1/(m sqrt(kg))", reads=BEAM)
def slope(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: ModesModel,
    mode: Mode,
    x: Place,
    count: Size | None = None,
) -> float:
    """Slope of the deflection of a mode of modal mass 1 kg at x."""
    return _shape(scene, cache, options, model, mode, x, count, 1)


@quantity("mode.node_position", unit="m", reads=BEAM)
def node_position(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: ModesModel,
    mode: Mode,
    node: Annotated[int, Meta(ge=1, description="number of the node from the left, ends not counted")] = 1,
    count: Size | None = None,
) -> float:
    """Position of a node of a mode, from the left end."""
    check_count(model, count)
    positions = cache.node_positions(model, count, mode, options.settings(model))
    if node > len(positions):
        raise InputError(f"node = {node}: mode {mode} has {len(positions)} nodes between the ends, give fewer")
    return float(positions[node - 1])


@quantity("mode.order", unit="1", reads=BEAM)
def order(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: Annotated[str, model_meta("mean: middle of segment and fem", "solve_modes", sized=True, mean=True)],
    mode: Mode,
    counts: Sizes,
) -> float:
    """Observed order of the frequency error over N; outside the asymptotic range an InputError."""
    from verify.judge.compare import settled_order

    check_sizes("counts", counts)
    settings = options.settings(model)
    expected = None if model == MEAN else MODELS.named(model).order(scene.beam, **dict(settings))
    return settled_order(counts, [cache.frequency_error(model, n, mode, settings) for n in counts], expected)


@quantity("mode.shape_order", unit="1", reads=BEAM)
def shape_order(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: DiscreteModel,
    mode: Mode,
    counts: Sizes,
    reading: Reading | None = None,
) -> float:
    """Observed order of the shape error over N; outside the asymptotic range an InputError."""
    from verify.judge.compare import settled_order

    check_sizes("counts", counts)
    settings = options.settings(model)
    return settled_order(counts, [cache.shape_error(model, n, mode, reading, settings) for n in counts])


@quantity("mode.bracket", unit="Hz", reads=BEAM)
def bracket(scene: Scene, cache: "SolutionCache", options: ModelOptions, *, mode: Mode, count: Size) -> Bracket:
    """Two-sided bound on the exact frequency: segments below, Hermite elements above."""
    return cache.bracket(mode, count, options.chosen)


@quantity("mode.count_needed", unit="1", reads=BEAM)
def count_needed(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: DiscreteModel,
    mode: Mode,
    error: Annotated[Relative, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")],
    of: Annotated[
        Literal["enough", "least"], Meta(description="N from which all larger ones suffice, or the least N that does")
    ] = "enough",
) -> float:
    """Number of segments or elements for a frequency error of at most `error`."""
    from verify.judge.sizing import enough_from

    found = enough_from(cache, model, mode, error, options.settings(model))
    return found.smaller if of == "least" and found.smaller is not None else found.count


@quantity("mode.stock_difference", unit="1", reads=BEAM)
def stock_difference(scene: Scene, cache: "SolutionCache", *, mode: Mode, count: Size) -> float:
    """Frequency by scikit-fem's own Hermite element and solver relative to that of our elements, less 1."""
    from verify.elements.stock import stock_frequency_hz

    return stock_frequency_hz(scene.beam, mode, count) / cache.frequency_hz("fem", count, mode) - 1.0


@quantity("drive.rule_frequency", unit="Hz", reads=BEAM)
def rule_frequency(
    scene: Scene,
    cache: "SolutionCache",
    *,
    mode: Annotated[int, Meta(ge=2, description="the upper one of two neighbouring modes")] = 22,
) -> float:
    """Root mean square of two neighbouring natural frequencies, where both respond equally."""
    from verify.exact.closed_forms import rule_frequency_hz

    return rule_frequency_hz(scene.beam, mode - 1, mode)


@quantity("drive.quarter_wavelength", unit="m", reads=("beam", "drive"))
def quarter_wavelength(scene: Scene, cache: "SolutionCache", *, frequency_hz: Frequency | None = None) -> float:
    """A quarter of the bending wavelength: the distance of a force from its end of the beam."""
    from verify.exact.closed_forms import quarter_wavelength

    return quarter_wavelength(scene.beam, drive_frequency(scene, frequency_hz))


@quantity("beam.buckling_load", unit="N", reads=BEAM)
def buckling_load(
    scene: Scene,
    cache: "SolutionCache",
    options: ModelOptions,
    *,
    model: Annotated[str, model_meta("which model", "buckling_load")],
    count: Size | None = None,
) -> float:
    """Compression at first buckling, whatever axial force the beam itself has."""
    check_count(model, count)
    settings = options.settings(model, "buckling")
    return MODELS.named(model).buckling_load(scene.beam, count, **dict(settings))
