"""The named figures that a gate, a table or `verify measure` can ask for.

A quantity is data: its name, unit, typed arguments, what it will need solved, and one function. Nothing here
imports numpy until a figure that needs it is asked for.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from verify.checked import checked
from verify.errors import InputError, near_name
from verify.workbench import Need, Settings, Workbench, for_model

if TYPE_CHECKING:
    from verify.scene import Scene

Value = "float | complex | Bracket"

Mode = Annotated[int, Meta(ge=1, description="mode number from 1, elastic modes only")]
Size = Annotated[int, Meta(ge=1, description="segments or elements; the exact beam has none")]
Sizes = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(description="three or more sizes, 20,40,80")]
AnyModel = Annotated[
    Literal["analytic", "fem", "segment", "mean"],
    Meta(description="mean is the middle between segment (below) and fem (above)"),
]
DiscreteModel = Annotated[Literal["fem", "segment"], Meta(description="which discrete model")]
Theory = Annotated[
    Literal["euler-bernoulli", "rayleigh", "timoshenko"], Meta(description="beam theory of the analytic model")
]
Reading = Annotated[
    str, Meta(description="segment: corrected (y + delta^2 y / 12) or raw; fem: nodal; default the first")
]
Wall = Annotated[
    Literal["gregory", "half", "welded", "third-order", "five-joint"],
    Meta(description="how segments are held at a clamped end; half is the literature's k = 2EI/l"),
]
Joints = Annotated[
    Literal["series", "printed"], Meta(description="Eq. (1) of the segments' joints: put right, or as printed")
]
Grading = Annotated[float, Meta(gt=0, description="length of a section's last part over its first")]


class Arguments(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the typed arguments of a quantity."""


class Divided(Arguments, frozen=True, kw_only=True):
    """Arguments with the settings of the discrete models."""

    wall: Wall = "gregory"
    joints: Joints = "series"
    grading: Grading = 1.0

    @property
    def settings(self) -> Settings:
        """Those that are not the default."""
        chosen: list[tuple[str, str | float]] = []
        chosen += [("wall", self.wall)] if self.wall != "gregory" else []
        chosen += [("joints", self.joints)] if self.joints != "series" else []
        chosen += [("grading", self.grading)] if self.grading != 1.0 else []
        return tuple(chosen)

    def check_settings(self, model: str) -> None:
        """Raise InputError for a setting that the model does not have."""
        for name, _ in self.settings:
            if model in ("analytic", "fem") and (name != "grading" or model == "analytic"):
                raise InputError(f"{name} = {getattr(self, name)!r} is a setting of model = segment, not of {model}")


class AtSize(Divided, frozen=True, kw_only=True):
    """One mode of one model at one size."""

    model: AnyModel
    mode: Mode
    count: Size | None = None
    theory: Theory = "euler-bernoulli"

    def __post_init__(self) -> None:
        if self.model != "analytic" and self.count is None:
            raise InputError(f"count is missing: give the number of segments or elements for model = {self.model}")
        if self.model != "analytic" and self.theory != "euler-bernoulli":
            raise InputError(
                f"theory = {self.theory!r} belongs to model = analytic: the {self.model} model is Euler-Bernoulli"
            )
        self.check_settings(self.model)


class DiscreteAtSize(Divided, frozen=True, kw_only=True):
    """One mode of one discrete model at one size."""

    model: DiscreteModel
    mode: Mode
    count: Size

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class ShapeAt(DiscreteAtSize, frozen=True, kw_only=True):
    """One shape of one discrete model."""

    reading: Reading | None = None


class NodeAt(Divided, frozen=True, kw_only=True):
    """One node of one shape of one model."""

    model: Annotated[Literal["analytic", "fem", "segment"], Meta(description="which model")]
    mode: Mode
    node: Annotated[int, Meta(ge=1, description="which node, from the left, ends not counted")] = 1
    count: Size | None = None

    def __post_init__(self) -> None:
        if self.model != "analytic" and self.count is None:
            raise InputError(f"count is missing: give the number of segments or elements for model = {self.model}")
        self.check_settings(self.model)


class OverSizes(Divided, frozen=True, kw_only=True):
    """One mode of one model over several sizes."""

    model: Annotated[Literal["fem", "segment", "mean"], Meta(description="mean is the middle of the bracket")]
    mode: Mode
    counts: Sizes

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class ShapesOverSizes(OverSizes, frozen=True, kw_only=True):
    """One shape of one discrete model over several sizes."""

    model: DiscreteModel
    reading: Reading | None = None


class BracketAt(Divided, frozen=True, kw_only=True):
    """One mode at one size, both discrete models."""

    mode: Mode
    count: Size


class FirstModes(Arguments, frozen=True, kw_only=True):
    """The first modes of one discrete model at one size."""

    model: DiscreteModel
    count: Size
    modes: Annotated[int, Meta(ge=1, description="how many modes, from the first")] = 22


class ToError(Divided, frozen=True, kw_only=True):
    """An accuracy wanted of one mode of one discrete model."""

    model: DiscreteModel
    mode: Mode
    error: Annotated[float, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")]

    def __post_init__(self) -> None:
        self.check_settings(self.model)


class NeighbourModes(Arguments, frozen=True, kw_only=True):
    """A mode and the one below it."""

    mode: Annotated[int, Meta(ge=2, description="the upper one of two neighbouring modes")] = 22


class AtFrequency(Arguments, frozen=True, kw_only=True):
    """A frequency, the scene's drive unless given."""

    frequency_hz: Annotated[float, Meta(gt=0, description="default: the scene's drive")] | None = None


class Quantity(msgspec.Struct, frozen=True):
    """A named figure."""

    name: str
    unit: str
    summary: str
    arguments: type[Arguments]
    needs: Callable[[Any, "Scene"], tuple[Need, ...]]
    """What has to be solved for it, as far as can be known beforehand."""
    evaluate: Callable[[Any, "Scene", Workbench], Any]


def _solved(model: str, count: int | None, n_modes: int, settings: Settings = ()) -> tuple[Need, ...]:
    """The solves behind one figure; the mean of both models takes both."""
    if model == "analytic" or count is None:
        return ()
    models = ("segment", "fem") if model == "mean" else (model,)
    return tuple(Need(m, count, n_modes, for_model(m, settings)) for m in models)


def _at_size(a: Any, scene: "Scene") -> tuple[Need, ...]:
    return _solved(a.model, a.count, a.mode, a.settings)


def _over_sizes(a: Any, scene: "Scene") -> tuple[Need, ...]:
    return tuple(need for count in a.counts for need in _solved(a.model, count, a.mode, a.settings))


def _frequency(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.model == "analytic" or a.count is None:
        from verify.closed_forms import frequency_hz

        return frequency_hz(scene.beam, a.mode, a.theory)
    return bench.frequency_hz(a.model, a.count, a.mode, a.settings)


def _frequency_error(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.model == "analytic" or a.count is None:
        from verify.closed_forms import frequency_hz

        exact = frequency_hz(scene.beam, a.mode)
        return (frequency_hz(scene.beam, a.mode, a.theory) - exact) / exact
    return bench.frequency_error(a.model, a.count, a.mode, a.settings)


def _dispersion_error(a: FirstModes, scene: "Scene", bench: Workbench) -> float:
    from verify.error_laws import dispersion_frequency_hz

    solved = bench.modes(a.model, a.count, a.modes).frequencies_hz
    closed = [dispersion_frequency_hz(a.model, scene.beam, n, a.count) for n in range(1, a.modes + 1)]
    return max(abs(float(f) / exact - 1.0) for f, exact in zip(solved, closed, strict=False))


def _law_ratio(a: DiscreteAtSize, scene: "Scene", bench: Workbench) -> float:
    from verify.closed_forms import check_uniform
    from verify.error_laws import leading_error

    check_uniform(scene.beam)
    law = leading_error(a.model, scene.beam.supports, a.mode, a.count)
    return bench.frequency_error(a.model, a.count, a.mode, a.settings) / law


def _order(a: OverSizes, scene: "Scene", bench: Workbench) -> float:
    from verify.compare import observed_order

    return observed_order(a.counts, [bench.frequency_error(a.model, n, a.mode, a.settings) for n in a.counts])


def _shape_order(a: ShapesOverSizes, scene: "Scene", bench: Workbench) -> float:
    from verify.compare import observed_order

    errors = [bench.shape_error(a.model, n, a.mode, a.reading, a.settings) for n in a.counts]
    return observed_order(a.counts, errors)


def _count_needed(a: ToError, scene: "Scene", bench: Workbench) -> int:
    from verify.sizing import count_needed

    return count_needed(bench, a.model, a.mode, a.error, a.settings)


def _count_guess(a: ToError, scene: "Scene") -> tuple[Need, ...]:
    from verify.sizing import count_guess

    return _solved(a.model, count_guess(a.model, scene.beam, a.mode, a.error), a.mode, a.settings)


def _node_position(a: NodeAt, scene: "Scene", bench: Workbench) -> float:
    positions = bench.node_positions(a.model, a.count, a.mode, a.settings)
    if a.node > len(positions):
        raise InputError(f"node = {a.node}: mode {a.mode} has {len(positions)} nodes between the ends")
    return float(positions[a.node - 1])


def _rule_frequency(a: NeighbourModes, scene: "Scene", bench: Workbench) -> float:
    from verify.closed_forms import rule_frequency_hz

    return rule_frequency_hz(scene.beam, a.mode - 1, a.mode)


def _quarter_wavelength(a: AtFrequency, scene: "Scene", bench: Workbench) -> float:
    from verify.closed_forms import quarter_wavelength

    if a.frequency_hz is None and scene.drive is None:
        raise InputError("frequency_hz is missing and the scene has no drive: give frequency_hz in hertz")
    return quarter_wavelength(scene.beam, a.frequency_hz or scene.drive.frequency_hz)  # type: ignore[union-attr]


QUANTITIES: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity("mode.frequency", "Hz", "Frequency of one mode.", AtSize, _at_size, _frequency),
        Quantity(
            "mode.frequency_error", "1", "Signed error relative to the exact Euler-Bernoulli frequency.",
            AtSize, _at_size, _frequency_error,
        ),
        Quantity(
            "mode.dispersion_error", "1", "Largest deviation of the solver from the model's own exact dispersion.",
            FirstModes, lambda a, s: _solved(a.model, a.count, a.modes), _dispersion_error,
        ),
        Quantity(
            "mode.law_ratio", "1", "Frequency error over its leading law, mu^4/1440 or mu^4 (-1/1440 + c/(12 N)).",
            DiscreteAtSize, _at_size, _law_ratio,
        ),
        Quantity(
            "mode.shape_error", "1", "Relative L2 error of the mass-normalised deflection at the model's nodes.",
            ShapeAt, _at_size,
            lambda a, s, bench: bench.shape_error(a.model, a.count, a.mode, a.reading, a.settings),
        ),
        Quantity(
            "mode.curvature_error", "1", "Relative L2 error of the curvature at joints or Gauss points.",
            DiscreteAtSize, _at_size,
            lambda a, s, bench: bench.curvature_error(a.model, a.count, a.mode, a.settings),
        ),
        Quantity(
            "mode.node_position", "m", "Where a mode stands still, from the left end.",
            NodeAt, _at_size, _node_position,
        ),
        Quantity(
            "mode.order", "1", "Observed order of the frequency error over sizes.",
            OverSizes, _over_sizes, _order,
        ),
        Quantity(
            "mode.shape_order", "1", "Observed order of the shape error over sizes.",
            ShapesOverSizes, _over_sizes, _shape_order,
        ),
        Quantity(
            "mode.bracket", "Hz", "Two-sided bound on the exact frequency: segments below, Hermite above.",
            BracketAt, lambda a, s: _solved("mean", a.count, a.mode, a.settings),
            lambda a, s, bench: bench.bracket(a.mode, a.count, a.settings),
        ),
        Quantity(
            "mode.count_needed", "1", "Fewest segments or elements whose frequency error is within `error`.",
            ToError, _count_guess, _count_needed,
        ),
        Quantity(
            "drive.rule_frequency", "Hz", "The paper's drive rule: root mean square of two exact neighbours.",
            NeighbourModes, lambda a, s: (), _rule_frequency,
        ),
        Quantity(
            "drive.quarter_wavelength", "m", "A quarter of the bending wavelength: the paper's actuator distance d.",
            AtFrequency, lambda a, s: (), _quarter_wavelength,
        ),
    )
}  # fmt: skip


def quantity(name: str) -> Quantity:
    """A quantity by name. Raises InputError with the nearest name."""
    if name not in QUANTITIES:
        raise InputError(f"quantity = {name!r} is not known: {near_name(name, tuple(QUANTITIES))}")
    return QUANTITIES[name]


def arguments_of(found: Quantity, given: dict[str, Any]) -> Arguments:
    """Arguments checked against the quantity's types; one number stands for a list of one. Raises InputError."""
    lists = {f.name for f in msgspec.structs.fields(found.arguments) if f.type is Sizes}
    data = {k: [v] if k in lists and not isinstance(v, list) else v for k, v in given.items()}
    return checked(data, found.arguments)


def needs_of(found: Quantity, arguments: Arguments, scene: "Scene") -> tuple[Need, ...]:
    """The solves a figure will ask for."""
    return found.needs(arguments, scene)


def evaluate(found: Quantity, arguments: Arguments, scene: "Scene", bench: Workbench) -> Any:
    """The figure: float, int, complex or Bracket. Raises InputError."""
    return found.evaluate(arguments, scene, bench)


def as_plain(value: Any) -> Any:
    """A figure for JSON: a number, {"re", "im"} or {"lower", "upper"}."""
    if isinstance(value, complex):
        return {"re": value.real, "im": value.imag}
    if hasattr(value, "lower"):
        return {"lower": value.lower, "upper": value.upper}
    return value


def arguments_as_plain(arguments: Arguments, given: dict[str, Any]) -> dict[str, Any]:
    """What was asked, as it was understood."""
    plain: dict[str, Any] = msgspec.to_builtins(arguments)
    return {key: plain[key] for key in given}


def in_words(plain: Any) -> str:
    """A plain figure for a person."""
    if isinstance(plain, dict):
        return (
            " .. ".join(in_words(v) for v in plain.values())
            if "lower" in plain
            else f"{plain['re']:.12g} {plain['im']:+.12g}i"
        )
    return f"{plain:.12g}"


def described() -> list[dict[str, Any]]:
    """Every quantity with its arguments, units and defaults, in plain data."""
    return [
        {
            "quantity": q.name,
            "unit": q.unit,
            "summary": q.summary,
            "arguments": [_described_argument(f) for f in msgspec.structs.fields(q.arguments)],
        }
        for q in QUANTITIES.values()
    ]


def _described_argument(field: Any) -> dict[str, Any]:
    """One argument: name, type in words, default, meaning."""
    kind, meaning = field.type, ""
    for part in (kind, *getattr(kind, "__args__", ())):
        meaning = next((m.description for m in getattr(part, "__metadata__", ()) if m.description), meaning)
    default = None if field.required else field.default
    return {"name": field.name, "type": _type_words(kind), "required": field.required,
            "default": default if default is not None or field.required else "none", "meaning": meaning}  # fmt: skip


def _type_words(kind: Any) -> str:
    """A type as a user would say it."""
    from typing import get_args, get_origin

    if hasattr(kind, "__metadata__"):
        return _type_words(get_args(kind)[0])
    if get_origin(kind) is Literal:
        return " | ".join(map(str, get_args(kind)))
    if get_origin(kind) is tuple:
        return "list of " + _type_words(get_args(kind)[0])
    arms = [arm for arm in get_args(kind) if arm is not type(None)]
    return _type_words(arms[0]) if arms else {int: "whole number", float: "number", str: "word"}.get(kind, str(kind))
