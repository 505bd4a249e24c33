"""Quantities of modes: frequencies, shapes, errors, orders, bounds, required N; the paper's drive rule; buckling."""

from functools import partial
from math import pi, sqrt
from typing import Annotated

from msgspec import Meta

from verify.analysis import comparison
from verify.analysis.comparison import asymptotic_order, node_weights
from verify.analysis.sizing import sufficient_size
from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.elements.stock import stock_frequency_hz
from verify.errors import InputError
from verify.exact import closed_forms, plate
from verify.exact.error_laws import law_of, leading_error
from verify.linear.numerics import zeros
from verify.linear.registry import MEAN, MODELS
from verify.quantities import options as opt
from verify.quantities.base import Scene, quantity
from verify.validation import Relative, check_sizes

BEAM = ("beam",)
Node = Annotated[int, Meta(ge=1, description="number of the node from the left, without the ends")]
UpperMode = Annotated[int, Meta(ge=2, description="upper mode number of the pair")]
Largest = Annotated[Relative, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")]
BucklingModel = Annotated[str, opt.model_name("model of the beam", "buckling_load")]
Reading = Annotated[
    str, Meta(description="nodal values. segment: corrected (default, y + delta^2 y / 12) or raw; fem: nodal")
]


@quantity("mode.frequency", unit="Hz", reads=BEAM)
def frequency(cache: SolutionCache, of: opt.OneModeOrMean) -> float:
    """Natural frequency of one mode."""
    if of.count is None:
        return cache.exact_hz(of.mode, of.theory)
    return cache.frequency_hz(of.model, of.count, of.mode, of.settings)


@quantity("mode.frequency_error", unit="1", reads=BEAM)
def frequency_error(cache: SolutionCache, of: opt.OneModeOrMean) -> float:
    """Signed error against the exact frequency of the same theory; model = analytic: theory over Euler-Bernoulli."""
    if of.count is not None:
        return cache.frequency_error(of.model, of.count, of.mode, of.settings)
    exact = cache.exact_hz(of.mode)
    return (cache.exact_hz(of.mode, of.theory) - exact) / exact


@quantity("mode.plate_error", unit="1", reads=BEAM)
def plate_error(scene: Scene, *, mode: opt.Mode) -> float:
    """Relative frequency difference of a thin plate with free long edges from Euler-Bernoulli theory."""
    return plate.plate_error(scene.beam, mode)


@quantity("mode.law_ratio", unit="1", reads=BEAM)
def law_ratio(
    scene: Scene, cache: SolutionCache, *, model: opt.DiscreteModel, mode: opt.Mode, count: opt.Size
) -> float:
    """Frequency error over its leading term: fem mu^4/1440, segment mu^4 (-1/1440 + c/(12 N)); mu = beta l."""
    law_of(model)
    closed_forms.check_uniform(scene.beam)
    return cache.frequency_error(model, count, mode) / leading_error(model, scene.beam.supports, mode, count)


@quantity("mode.shape_error", unit="1", reads=BEAM)
def shape_error(cache: SolutionCache, of: opt.OneDiscreteMode, *, reading: Reading | None = None) -> float:
    """Relative L2 error of the mass-normalised deflection at the model's nodes."""
    return cache.shape_error(of.model, of.count, of.mode, reading, of.settings)


@quantity("mode.curvature_error", unit="1", reads=BEAM)
def curvature_error(cache: SolutionCache, of: opt.OneDiscreteMode) -> float:
    """Relative L2 error of the curvature at joints or Gauss points."""
    modes = cache.modes(of.model, of.count, of.mode, of.settings)
    exact = cache.exact_shape(of.mode, modes.curvature_points, 2, of.theory)
    computed = modes.curvatures()[cache.paired_index(of.model, of.count, of.mode, of.settings)]
    return comparison.shape_error(exact, computed, node_weights(modes.curvature_points))


@quantity("mode.node_position", unit="m", reads=BEAM)
def node_position(cache: SolutionCache, of: opt.OneMode, *, node: Node = 1) -> float:
    """Position of a node of a mode, from the left end."""
    if of.count is None:
        positions = zeros(partial(cache.exact_shape, of.mode, theory=of.theory), cache.beam.length, of.mode)
    else:
        index = cache.paired_index(of.model, of.count, of.mode, of.settings)
        positions = cache.modes(of.model, of.count, of.mode, of.settings).node_positions(index + 1)
    if node > len(positions):
        raise InputError(f"node = {node}: mode {of.mode} has {len(positions)} nodes between the ends, give fewer")
    return float(positions[node - 1])


class Orders(opt.ModelOptions, frozen=True, kw_only=True):
    """One mode of one discrete model at several sizes."""

    model: opt.DiscreteModel
    mode: opt.Mode
    counts: opt.Sizes

    def __post_init__(self) -> None:
        check_sizes("counts", self.counts)
        if self.model != MEAN:
            opt.check_settings(self.model, self.settings)


class OrdersOrMean(Orders, frozen=True, kw_only=True):
    """One mode of one discrete model, or of the mean of segment and fem, at several sizes."""

    model: Annotated[str, opt.model_name("discrete model, or mean of segment and fem", "modes", sized=True, mean=True)]


@quantity("mode.order", unit="1", reads=BEAM)
def order(scene: Scene, cache: SolutionCache, of: OrdersOrMean) -> float:
    """Observed order of the frequency error in N; an error outside the asymptotic range."""
    expected = None
    if of.model != MEAN:
        expected = MODELS.named(of.model).build(scene.beam, max(of.counts), **dict(of.settings)).expected_order()
    errors = [cache.frequency_error(of.model, n, of.mode, of.settings) for n in of.counts]
    return asymptotic_order(of.counts, errors, expected)


@quantity("mode.shape_order", unit="1", reads=BEAM)
def shape_order(cache: SolutionCache, of: Orders, *, reading: Reading | None = None) -> float:
    """Observed order of the shape error in N; an error outside the asymptotic range."""
    errors = [cache.shape_error(of.model, n, of.mode, reading, of.settings) for n in of.counts]
    return asymptotic_order(of.counts, errors)


@quantity("mode.bracket", unit="Hz", reads=BEAM)
def bracket(cache: SolutionCache, options: opt.ModelOptions, *, mode: opt.Mode, count: opt.Size) -> Bracket:
    """Segments below, fem above the exact frequency of a bare uniform beam; clamped ends with wall = half alone."""
    return cache.bracket(mode, count, options.settings)


@quantity("mode.count_needed", unit="1", reads=BEAM)
def count_needed(
    cache: SolutionCache, options: opt.ModelOptions, *, model: opt.DiscreteModel, mode: opt.Mode, error: Largest
) -> float:
    """Sufficient number of segments or elements: for this and every larger number the error is at most `error`."""
    return sufficient_size(cache, model, mode, error, opt.check_settings(model, options.settings)).count


@quantity("mode.stock_difference", unit="1", reads=BEAM)
def stock_difference(scene: Scene, cache: SolutionCache, *, mode: opt.Mode, count: opt.Size) -> float:
    """Relative frequency difference of scikit-fem's own Hermite element and solver from model = fem."""
    return stock_frequency_hz(scene.beam, mode, count) / cache.frequency_hz("fem", count, mode) - 1.0


@quantity("drive.rule_frequency", unit="Hz", reads=BEAM)
def rule_frequency(scene: Scene, *, mode: UpperMode = 22) -> float:
    """Drive frequency at which two neighbouring modes respond equally: rms of their natural frequencies."""
    return sqrt(sum(closed_forms.frequency_hz(scene.beam, n) ** 2 for n in (mode - 1, mode)) / 2.0)


@quantity("drive.quarter_wavelength", unit="m", reads=("beam", "drive"))
def quarter_wavelength(scene: Scene, *, frequency_hz: opt.Frequency | None = None) -> float:
    """Quarter of the bending wavelength: best distance of a force from a pinned end; 0.364 of one from a clamped end.

    A force at d in a half-infinite beam causes a wave proportional to sin kd beside a pinned end (the paper's), to
    sin kd - cos kd + e^{-kd} beside a clamped one; beside a free end it is best at the end itself.
    """
    closed_forms.check_uniform(scene.beam)
    return sqrt(0.125 * pi * scene.beam.wave_constant / opt.drive_frequency(scene, frequency_hz))


@quantity("beam.buckling_load", unit="N", reads=BEAM)
def buckling_load(scene: Scene, *, model: BucklingModel, count: opt.Size | None = None) -> float:
    """Lowest buckling load of the beam in compression; its own axial force is ignored."""
    opt.check_count(model, count)
    return MODELS.named(model).build(scene.beam, count).buckling_load()
