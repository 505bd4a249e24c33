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
from verify.workbench import Need, Workbench

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


class Arguments(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the typed arguments of a quantity."""


class AtSize(Arguments, frozen=True, kw_only=True):
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


class ShapeAt(Arguments, frozen=True, kw_only=True):
    """One shape of one discrete model."""

    model: DiscreteModel
    mode: Mode
    count: Size
    reading: Reading | None = None


class OverSizes(Arguments, frozen=True, kw_only=True):
    """One mode of one model over several sizes."""

    model: Annotated[Literal["fem", "segment", "mean"], Meta(description="mean is the middle of the bracket")]
    mode: Mode
    counts: Sizes


class BracketAt(Arguments, frozen=True, kw_only=True):
    """One mode at one size, both discrete models."""

    mode: Mode
    count: Size


class FirstModes(Arguments, frozen=True, kw_only=True):
    """The first modes of one discrete model at one size."""

    model: DiscreteModel
    count: Size
    modes: Annotated[int, Meta(ge=1, description="how many modes, from the first")] = 22


class ToError(Arguments, frozen=True, kw_only=True):
    """An accuracy wanted of one mode of one discrete model."""

    model: DiscreteModel
    mode: Mode
    error: Annotated[float, Meta(gt=0, lt=1, description="largest relative frequency error, for instance 0.01")]


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


def _solved(model: str, count: int | None, n_modes: int) -> tuple[Need, ...]:
    """The solves behind one figure; the mean of both models takes both."""
    if model == "analytic" or count is None:
        return ()
    models = ("segment", "fem") if model == "mean" else (model,)
    return tuple(Need(m, count, n_modes) for m in models)


def _frequency(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.model == "analytic" or a.count is None:
        from verify.closed_forms import frequency_hz

        return frequency_hz(scene.beam, a.mode, a.theory)
    return bench.frequency_hz(a.model, a.count, a.mode)


def _frequency_error(a: AtSize, scene: "Scene", bench: Workbench) -> float:
    if a.model == "analytic" or a.count is None:
        from verify.closed_forms import frequency_hz

        exact = frequency_hz(scene.beam, a.mode)
        return (frequency_hz(scene.beam, a.mode, a.theory) - exact) / exact
    return bench.frequency_error(a.model, a.count, a.mode)


def _dispersion_error(a: FirstModes, scene: "Scene", bench: Workbench) -> float:
    from verify.workbench import model_module

    solved = bench.modes(a.model, a.count, a.modes).frequencies_hz
    closed: list[float] = [
        model_module(a.model).dispersion_frequency_hz(scene.beam, n, a.count) for n in range(1, a.modes + 1)
    ]
    return max(abs(float(f) / exact - 1.0) for f, exact in zip(solved, closed, strict=False))


def _order(a: OverSizes, scene: "Scene", bench: Workbench) -> float:
    from verify.compare import observed_order

    return observed_order(a.counts, [bench.frequency_error(a.model, count, a.mode) for count in a.counts])


def _count_needed(a: ToError, scene: "Scene", bench: Workbench) -> int:
    """The smallest count that a solve confirms, from the closed form's guess and its neighbours."""

    def reached(count: int) -> bool:
        return abs(bench.frequency_error(a.model, count, a.mode)) <= a.error

    count = guess = _count_guess(a, scene)
    while not reached(count):
        count += 1
        if count > 2 * guess + 10:
            raise InputError(
                f"error = {a.error!r}: the {a.model} model does not reach it up to count = {count}, although its "
                f"dispersion says {guess}; one of the two is wrong"
            )
    while count - 1 > a.mode and reached(count - 1):
        count -= 1
    return count


def _count_guess(a: ToError, scene: "Scene") -> int:
    """The smallest count of the discrete dispersion's error: doubling, then halving the interval."""
    from verify.closed_forms import frequency_hz
    from verify.workbench import model_module

    dispersion, exact = model_module(a.model).dispersion_frequency_hz, frequency_hz(scene.beam, a.mode)

    def reached(count: int) -> bool:
        return abs(float(dispersion(scene.beam, a.mode, count)) - exact) <= a.error * exact

    if a.error < 1e-12:
        raise InputError(f"error = {a.error!r} is as small as rounding: ask for 1e-12 or more")
    low, high = a.mode, a.mode + 1
    while not reached(high):
        low, high = high, 2 * high
        if high > 10**8:
            raise InputError(f"error = {a.error!r}: the {a.model} model's dispersion does not reach it at any size")
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


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
        Quantity(
            "mode.frequency", "Hz", "Frequency of one mode.",
            AtSize, lambda a, s: _solved(a.model, a.count, a.mode), _frequency,
        ),
        Quantity(
            "mode.frequency_error", "1", "Signed error relative to the exact Euler-Bernoulli frequency.",
            AtSize, lambda a, s: _solved(a.model, a.count, a.mode), _frequency_error,
        ),
        Quantity(
            "mode.dispersion_error", "1", "Largest deviation of the solver from the model's own exact dispersion.",
            FirstModes, lambda a, s: _solved(a.model, a.count, a.modes), _dispersion_error,
        ),
        Quantity(
            "mode.shape_error", "1", "Relative L2 error of the mass-normalised deflection at the model's nodes.",
            ShapeAt, lambda a, s: _solved(a.model, a.count, a.mode),
            lambda a, s, bench: bench.shape_error(a.model, a.count, a.mode, a.reading),
        ),
        Quantity(
            "mode.order", "1", "Observed order of the frequency error over sizes.",
            OverSizes, lambda a, s: tuple(n for c in a.counts for n in _solved(a.model, c, a.mode)), _order,
        ),
        Quantity(
            "mode.bracket", "Hz", "Two-sided bound on the exact frequency: segments below, Hermite above.",
            BracketAt, lambda a, s: _solved("mean", a.count, a.mode),
            lambda a, s, bench: bench.bracket(a.mode, a.count),
        ),
        Quantity(
            "mode.count_needed", "1", "Fewest segments or elements whose frequency error is within `error`.",
            ToError, lambda a, s: _solved(a.model, _count_guess(a, s), a.mode), _count_needed,
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


def arguments_as_plain(arguments: Arguments) -> dict[str, Any]:
    """What was asked, without what was left open."""
    plain: dict[str, Any] = msgspec.to_builtins(arguments)
    return {key: value for key, value in plain.items() if value is not None}


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
