"""Named figures of modes: frequencies, shapes, their errors and orders, bounds; and of the paper's drive rule."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.judge.workbench import Need, Settings, Workbench, check_bracket, for_model
from verify.models.catalogue import MODELS, bounding
from verify.models.naming import MEAN
from verify.quantities.cases import drive_frequency
from verify.quantities.kind import (
    AtFrequency,
    AtSize,
    BracketAt,
    DiscreteAtSize,
    Elements,
    FirstModes,
    NeighbourModes,
    NodeAt,
    OverSizes,
    PlateMode,
    Quantity,
    ShapeAt,
    ShapeOf,
    ShapesOverSizes,
    StockMode,
    ToError,
)

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scenes.scene import Scene


def _solved(
    model: str, count: int | None, n_modes: int, settings: Settings = (), beam: "Beam | None" = None
) -> tuple[Need, ...]:
    """The solves behind one figure; the middle of both takes both. Raises InputError where the exact beam has none."""
    if count is None:
        if beam is not None:
            MODELS.named(model).check(beam, n_modes, 0, **dict(settings))
        return ()
    models = bounding() if model == MEAN else (MODELS.named(model),)
    return tuple(Need(m.name, count, n_modes, for_model(m.name, settings)) for m in models)


def _at_size(a: AtSize | DiscreteAtSize | NodeAt | ShapeOf, scene: "Scene") -> tuple[Need, ...]:
    return _solved(a.model, a.count, a.mode, a.settings, scene.beam)


def _by_dispersion(a: FirstModes, scene: "Scene") -> tuple[Need, ...]:
    from verify.exact.error_laws import dispersion_frequency_hz

    dispersion_frequency_hz(a.model, scene.beam, a.modes, a.count)
    return _solved(a.model, a.count, a.modes)


def _check_law(a: DiscreteAtSize, beam: "Beam") -> None:
    """Raise InputError where the leading law is that of other parts, another wall or another theory."""
    from verify.exact.closed_forms import check_uniform
    from verify.exact.error_laws import law_of

    law_of(a.model)
    check_uniform(beam)
    for name, value in a.settings:
        if name in ("theory", "grading") or (name == "wall" and "clamped" in beam.supports):
            raise InputError(
                f"{name} = {value!r}: the leading law is that of equal parts, Gregory's joints and Euler-Bernoulli's "
                f"theory, leave {name} out or ask for mode.frequency_error"
            )


def _beside_a_law(a: DiscreteAtSize, scene: "Scene") -> tuple[Need, ...]:
    _check_law(a, scene.beam)
    return _at_size(a, scene)


def _bracketed(a: BracketAt, scene: "Scene") -> tuple[Need, ...]:
    check_bracket(scene.beam, a.settings)
    return _solved(MEAN, a.count, a.mode, a.settings)


def _over_sizes(a: OverSizes, scene: "Scene") -> tuple[Need, ...]:
    return tuple(need for count in a.counts for need in _solved(a.model, count, a.mode, a.settings))


def _frequency(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.count is None:
        return bench.exact_hz(a.mode, a.theory)
    return bench.frequency_hz(a.model, a.count, a.mode, a.settings)


def _frequency_error(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.count is None:
        exact = bench.exact_hz(a.mode)
        return (bench.exact_hz(a.mode, a.theory) - exact) / exact
    return bench.frequency_error(a.model, a.count, a.mode, a.settings)


def _plate_error(a: PlateMode, scene: "Scene", bench: Workbench) -> float:
    from verify.exact.plate_strip import plate_error

    return plate_error(scene.beam, a.mode)


def _on_a_strip(a: PlateMode, scene: "Scene") -> tuple[Need, ...]:
    from verify.exact.plate_strip import check_strip

    check_strip(scene.beam)
    return ()


def _dispersion_error(a: FirstModes, scene: "Scene", bench: Workbench) -> float:
    from verify.exact.error_laws import dispersion_frequency_hz

    solved = bench.modes(a.model, a.count, a.modes).frequencies_hz
    closed = [dispersion_frequency_hz(a.model, scene.beam, n, a.count) for n in range(1, a.modes + 1)]
    return max(abs(float(f) / exact - 1.0) for f, exact in zip(solved, closed, strict=False))


def _law_ratio(a: DiscreteAtSize, scene: "Scene", bench: Workbench) -> float:
    from verify.exact.error_laws import leading_error

    _check_law(a, scene.beam)
    law = leading_error(a.model, scene.beam.supports, a.mode, a.count)
    return bench.frequency_error(a.model, a.count, a.mode, a.settings) / law


def _order(a: OverSizes, scene: "Scene", bench: Workbench) -> float:
    from verify.judge.compare import settled_order

    due = None if a.model == MEAN else MODELS.named(a.model).order(scene.beam, **dict(a.settings))
    errors = [bench.frequency_error(a.model, n, a.mode, a.settings) for n in a.counts]
    return settled_order(a.counts, errors, due)


def _shape_order(a: ShapesOverSizes, scene: "Scene", bench: Workbench) -> float:
    from verify.judge.compare import settled_order

    errors = [bench.shape_error(a.model, n, a.mode, a.reading, a.settings) for n in a.counts]
    return settled_order(a.counts, errors)


def _count_needed(a: ToError, scene: "Scene", bench: Workbench) -> int:
    from verify.judge.sizing import enough_from

    found = enough_from(bench, a.model, a.mode, a.error, a.settings)
    return found.smaller if a.of == "least" and found.smaller is not None else found.count


def _count_guess(a: ToError, scene: "Scene") -> tuple[Need, ...]:
    from verify.judge.several import count_guess
    from verify.judge.sizing import check_reachable

    check_reachable(scene.beam, a.model, a.settings)
    guess = count_guess(a.model, scene.beam, a.mode, a.error)
    while not _taken(a, scene, guess):  # what so few parts refuse
        guess *= 2
    return _solved(a.model, guess, a.mode, a.settings)


def _taken(a: ToError, scene: "Scene", count: int) -> bool:
    try:
        MODELS.named(a.model).check(scene.beam, a.mode, count, **dict(a.settings))
    except InputError:
        return False
    return True


def _node_position(a: NodeAt, scene: "Scene", bench: Workbench) -> float:
    positions = bench.node_positions(a.model, a.count, a.mode, a.settings)
    if a.node > len(positions):
        raise InputError(f"node = {a.node}: mode {a.mode} has {len(positions)} nodes between the ends")
    return float(positions[a.node - 1])


def _shape(derivative: int) -> Callable[[ShapeOf, "Scene", Workbench], float]:
    """A derivative of a mass-normalised shape at a place."""

    def evaluate(a: ShapeOf, scene: "Scene", bench: Workbench) -> float:
        from verify.models.places import places

        at = places("x", a.x, scene.beam.length).ravel()
        return bench.shape_at(a.model, a.count, a.mode, at, derivative, a.settings)

    return evaluate


def _beside_stock(a: StockMode, scene: "Scene") -> tuple[Need, ...]:
    from verify.elements.stock import check_stock

    check_stock(scene.beam, a.mode, a.count)
    return _solved("fem", a.count, a.mode)


def _assembled(a: Elements, scene: "Scene") -> tuple[Need, ...]:
    MODELS.named("fem").check(scene.beam, 1, a.count, grading=a.grading)
    return ()


def _stock_difference(a: StockMode, scene: "Scene", bench: Workbench) -> float:
    from verify.elements.stock import stock_frequency_hz

    return stock_frequency_hz(scene.beam, a.mode, a.count) / bench.frequency_hz("fem", a.count, a.mode) - 1.0


def _stiffness_difference(a: Elements, scene: "Scene", bench: Workbench) -> float:
    from verify.elements.pencil import factor_difference

    _assembled(a, scene)
    return factor_difference(scene.beam, a.count, a.grading)


def _rule_frequency(a: NeighbourModes, scene: "Scene", bench: Workbench) -> float:
    from verify.exact.closed_forms import rule_frequency_hz

    return rule_frequency_hz(scene.beam, a.mode - 1, a.mode)


def _quarter_wavelength(a: AtFrequency, scene: "Scene", bench: Workbench) -> float:
    from verify.exact.closed_forms import quarter_wavelength

    return quarter_wavelength(scene.beam, drive_frequency(a, scene))


MODE_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity("mode.frequency", "Hz", "Frequency of one mode.", AtSize, "modes", _frequency, needs=_at_size),
    Quantity(
        "mode.frequency_error",
        "1",
        "Signed error relative to the exact frequency by the same theory; of a theory itself, to Euler-Bernoulli's.",
        AtSize,
        "modes",
        _frequency_error,
        needs=_at_size,
    ),
    Quantity(
        "mode.plate_error",
        "1",
        "Frequency as a thin plate with free long edges relative to Euler-Bernoulli's, less one: bending across.",
        PlateMode,
        "closed form",
        _plate_error,
        needs=_on_a_strip,
    ),
    Quantity(
        "mode.dispersion_error",
        "1",
        "Largest deviation of the solver from the model's own exact dispersion.",
        FirstModes,
        "modes",
        _dispersion_error,
        needs=_by_dispersion,
    ),
    Quantity(
        "mode.law_ratio",
        "1",
        "Frequency error over its leading law, mu^4/1440 or mu^4 (-1/1440 + c/(12 N)), which is for N beyond 200 c.",
        DiscreteAtSize,
        "modes",
        _law_ratio,
        needs=_beside_a_law,
    ),
    Quantity(
        "mode.shape_error",
        "1",
        "Relative L2 error of the mass-normalised deflection at the model's nodes.",
        ShapeAt,
        "modes",
        lambda a, s, bench: bench.shape_error(a.model, a.count, a.mode, a.reading, a.settings),
        needs=_at_size,
    ),
    Quantity(
        "mode.curvature_error",
        "1",
        "Relative L2 error of the curvature at joints or Gauss points.",
        DiscreteAtSize,
        "modes",
        lambda a, s, bench: bench.curvature_error(a.model, a.count, a.mode, a.settings),
        needs=_at_size,
    ),
    Quantity(
        "mode.deflection",
        "1/sqrt(kg)",
        "Deflection of a mode of modal mass 1 kg at a place, positive where the beam first moves off its left end.",
        ShapeOf,
        "modes",
        _shape(0),
        needs=_at_size,
    ),
    Quantity(
        "mode.slope",
        "1/(m sqrt(kg))",
        "Slope of that deflection at a place.",
        ShapeOf,
        "modes",
        _shape(1),
        needs=_at_size,
    ),
    Quantity(
        "mode.node_position",
        "m",
        "Where a mode stands still, from the left end.",
        NodeAt,
        "modes",
        _node_position,
        needs=_at_size,
    ),
    Quantity(
        "mode.order",
        "1",
        "Observed order of the frequency error over sizes, refused where it is not settled between them.",
        OverSizes,
        "modes",
        _order,
        needs=_over_sizes,
    ),
    Quantity(
        "mode.shape_order",
        "1",
        "Observed order of the shape error over sizes, refused where it is not settled between them.",
        ShapesOverSizes,
        "modes",
        _shape_order,
        needs=_over_sizes,
    ),
    Quantity(
        "mode.bracket",
        "Hz",
        "Two-sided bound on the exact frequency: segments below, Hermite above.",
        BracketAt,
        "modes",
        lambda a, s, bench: bench.bracket(a.mode, a.count, a.settings),
        needs=_bracketed,
    ),
    Quantity(
        "mode.count_needed",
        "1",
        "Segments or elements from which on the frequency error stays within `error`, as far as larger ones were "
        "looked through, or the least that happen to.",
        ToError,
        "modes",
        _count_needed,
        needs=_count_guess,
        searches=True,
    ),
    Quantity(
        "mode.stock_difference",
        "1",
        "Frequency by stock scikit-fem, its own Hermite element and solve, relative to that of our elements.",
        StockMode,
        "modes",
        _stock_difference,
        needs=_beside_stock,
    ),
    Quantity(
        "mode.stiffness_difference",
        "1",
        "Largest entry of the elements' factored stiffness minus scikit-fem's assembled one, over sqrt(K_ii K_jj).",
        Elements,
        "matrices",
        _stiffness_difference,
        needs=_assembled,
        models=("fem",),
    ),
    Quantity(
        "drive.rule_frequency",
        "Hz",
        "Root mean square of two exact neighbours: where both answer alike.",
        NeighbourModes,
        "closed form",
        _rule_frequency,
    ),
    Quantity(
        "drive.quarter_wavelength",
        "m",
        "A quarter of the bending wavelength: a force's distance from its end.",
        AtFrequency,
        "closed form",
        _quarter_wavelength,
    ),
)
