"""Named quantities of interest: the `@quantity` decorator, the registry, evaluation, arguments and their listing.

The signature of the function is the schema of the quantity: an annotation carries type, limits and description, a
default value makes an argument optional, and a parameter annotated with a `msgspec.Struct` is an option group whose
fields become arguments of the quantity. `evaluate` supplies parameters named `scene` and `cache`.

    @quantity("drive.rule_frequency", unit="Hz", reads=("beam",))
    def rule_frequency(scene: Scene, *, mode: Annotated[int, Meta(ge=2, description="the upper one of two")] = 22):
        \"\"\"Root mean square of two neighbouring natural frequencies.\"\"\"

Nothing here imports numpy.
"""

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import isfinite, isnan
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import Bracket
from verify.blas import one_blas_thread
from verify.convert import convert, description_of, entry_of, extra_of, type_name, typed
from verify.errors import InputError, near_name, shown
from verify.formatting import with_error
from verify.registry import Registry
from verify.validation import python_scalar

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.scene.model import Scene as Scene  # noqa: PLC0414
else:
    Scene = Any
    """Stand-in for annotations, which `@quantity` evaluates; scenes import quantities."""


class Estimate(float):
    """A value with the error of its estimation, of which `verify measure` prints the digits that hold."""

    error: float

    def __new__(cls, value: float, error: float = 0.0) -> "Estimate":
        """`error` in the unit of the value; a copy or an unpickled value sets it later."""
        one = super().__new__(cls, value)
        one.error = float(error)
        return one


Value: TypeAlias = float | complex | Bracket  # type of an evaluated quantity
MODEL_NAME = "model name"  # annotation key of an argument that names a model (`options.model_name`)
PLACE = "place"
Place: TypeAlias = Annotated[float, Meta(description="m from the left end", extra={PLACE: True, "unit": "m"})]
"""A position on the beam: `evaluate` raises InputError for one off the beam."""
TABLES = ("beam", "drive", "slider", "motion")  # tables of a scene that a quantity may depend on
ROUNDING = 1e-12  # tolerance of a position at an end of the beam, relative to its length (as in `linear.positions`)


UNITS = {"resistance": "ohm", "inductance": "H", "capacitance": "F", "peak": "1", "loss_factor": "1"}
"""Unit of a quantity with several figures by the argument that names the figure."""


class Quantity:
    """A named quantity of interest. `@quantity` makes and registers it."""

    def __init__(
        self,
        function: Callable[..., Value],
        name: str,
        unit: str,
        summary: str = "",
        reads: Sequence[str] = TABLES,
        devices: bool = False,
    ) -> None:
        """`reads`: tables of a scene on which the value depends; `devices`: whether the quantity models drive.device.

        `summary` replaces the first paragraph of the function's docstring.
        """
        self.name, self.unit, self.reads, self.devices = name, unit, tuple(reads), devices
        self.summary = summary or " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
        self.function = function
        parameters = inspect.signature(function).parameters
        self._supplied = [name for name in ("scene", "cache") if name in parameters]
        self._groups: dict[str, type[msgspec.Struct]] = {}
        fields: list[Any] = []
        for parameter in (one for name, one in parameters.items() if name not in self._supplied):
            kind = parameter.annotation
            if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
                self._groups[parameter.name] = kind
                own = msgspec.structs.fields(kind)
                fields += [(one.name, one.type, *(() if one.required else (one.default,))) for one in own]
            else:
                default = () if parameter.default is inspect.Parameter.empty else (parameter.default,)
                fields.append((parameter.name, kind, *default))
        fields.sort(key=lambda field: {"model": 0, "count": 1}.get(field[0], 2))
        self.types = {field[0]: field[1] for field in fields}
        self.schema = msgspec.defstruct(name, fields, frozen=True, kw_only=True, forbid_unknown_fields=True)

    @property
    def arguments(self) -> list[dict[str, Any]]:
        """The arguments as plain data: name, type, whether required, default, description."""
        entries = []
        for field in msgspec.structs.fields(self.schema):
            among = extra_of(field.type, MODEL_NAME)
            one: dict[str, Any] = {
                "name": field.name,
                "type": " | ".join(among.names()) if among else type_name(field.type),
            }
            one |= {"required": field.required, "default": None if field.required else field.default}
            entries.append(one | {"description": description_of(field.type)})
        return entries

    def bind(self, arguments: Mapping[str, Any]) -> dict[str, Any]:
        """Keyword arguments of the function: checked, with defaults, option groups built. Raises InputError."""
        data = {name: _native(value, name) for name, value in arguments.items()}
        required = {field.name for field in msgspec.structs.fields(self.schema) if field.required}
        for name, kind in self.types.items():
            among = extra_of(kind, MODEL_NAME)
            if among is not None and isinstance(data.get(name), str):
                among.check(data[name], name)
            elif among is not None and name in required - set(data) and set(data) <= set(self.types):
                raise InputError(f"{name} is missing: give one of {', '.join(among.names())}")
            if name in data and isinstance(data[name], int | float) and entry_of(kind) is not None:
                data[name] = [data[name]]
        checked = convert(data, self.schema)
        values = {name: getattr(checked, name) for name in self.types}
        groups = {
            parameter: kind(**{name: values.pop(name) for name in kind.__struct_fields__})
            for parameter, kind in self._groups.items()
        }
        return values | groups

    def unit_of(self, arguments: Mapping[str, Any]) -> str:
        """Its unit; where that depends on an argument as resistance or inductance, the unit for these arguments."""
        values = {one.name: one.default for one in msgspec.structs.fields(self.schema)} | dict(arguments)
        units = [UNITS[value] for value in values.values() if isinstance(value, str) and value in UNITS]
        return units[0] if units and " or " in self.unit else self.unit

    @one_blas_thread()
    def evaluate(self, arguments: Mapping[str, Any], scene: Scene, cache: "SolutionCache") -> Value:
        """The value for arguments that are plain data. Raises InputError."""
        bound = self.bind(arguments)
        accepts = [name for one in self._groups.values() for name in getattr(one, "accepts", ())]
        if not self.devices and "beam" in self.reads and (also := scene.beside) and also not in accepts:
            at = scene.devices[0].position if scene.devices else scene.shunts[0][0]
            raise InputError(
                f"quantity = {self.name!r} does not model {also}, and the scene has one at {at:g} m: leave {also} out, "
                "or use a quantity of the steady wave"
            )
        length = scene.beam.length
        for name, x in arguments.items():
            if (
                extra_of(self.types[name], PLACE)
                and x is not None
                and not -ROUNDING * length <= x <= length * (1.0 + ROUNDING)
            ):
                raise InputError(f"{name} = {x!r} lies off the beam: give a position between 0 and {length!r} m")
        supplied = {"scene": scene, "cache": cache}
        value = python_scalar(self.function(**{name: supplied[name] for name in self._supplied}, **bound))
        if not isinstance(value, float | int | complex | Bracket):
            raise InputError(f"quantity = {self.name!r} returns {shown(value)}: return a number or a Bracket")
        return value


QUANTITIES: Registry[Quantity] = Registry("quantity", "verify.quantities")
"""The quantities of this package, those registered in this process, and entry points of `verify.quantities`."""


def quantity(
    name: str, *, unit: str, summary: str = "", reads: Sequence[str] = TABLES, devices: bool = False
) -> Callable[[Callable[..., Value]], Quantity]:
    """Register a function as a quantity; see `Quantity` for the options."""
    return lambda function: QUANTITIES.register(Quantity(function, name, unit, summary, reads, devices))


def evaluate(name: str, arguments: Mapping[str, Any], scene: Scene, cache: "SolutionCache") -> Value:
    """The value of a quantity. `arguments` is plain data as in a scene file; unknown ones raise InputError."""
    return QUANTITIES.named(name).evaluate(arguments, scene, cache)


def parse_arguments(name: str, words: Iterable[str]) -> dict[str, Any]:
    """Convert KEY=VALUE arguments of a command line by their types. Raises InputError.

    Lists are 20,40,80 or a range 10-50:10; a relative number may be in per cent.
    """
    chosen = QUANTITIES.named(name)
    arguments: dict[str, Any] = {}
    for word in words:
        key, equals, text = (part.strip() for part in word.partition("="))
        if not equals:
            raise InputError(f"argument = {word!r}: write it as KEY=VALUE")
        if key in arguments:
            raise InputError(f"{key} = {text!r} repeats an argument: give it once")
        kind = chosen.types.get(key)
        if kind is None:
            other = f"give --set {key}={text}" if "." in key else near_name(key, tuple(chosen.types))
            raise InputError(f"{key} is not a known key: {other}")
        arguments[key] = typed(text, kind, key)
    chosen.bind(arguments)
    return arguments


def describe(*words: str) -> list[dict[str, Any]]:
    """Quantities as plain data: name, unit, summary, arguments; only those in which all `words` occur.

    Raises InputError where no quantity matches.
    """
    quantities = []
    for one in QUANTITIES.values():
        text = " ".join((one.name, one.summary, one.unit, *one.schema.__struct_fields__)).casefold()
        if all(word.casefold() in text for word in words):
            quantities.append({"name": one.name, "unit": one.unit, "summary": one.summary, "arguments": one.arguments})
    if not quantities:
        remedy = "leave a word out" if len(words) > 1 else "give another word, or none for all"
        raise InputError(f"words = {shown(' '.join(words))}: no quantity matches, {remedy}")
    return quantities


def as_plain(value: Value | None) -> Any:
    """A value as JSON data: a number, {"re", "im"} or {"lower", "upper"}; an estimate without its error."""
    if isinstance(value, complex):
        return {"re": value.real, "im": value.imag}
    if isinstance(value, Bracket):
        return {"lower": value.lower, "upper": value.upper}
    return float(value) if isinstance(value, Estimate) else value


def as_text(value: Value, digits: int = 12) -> str:
    """A value as text: '1.5', '1 +2i', '0.9 .. 1.1', '9.8 ± 0.2'."""
    if isinstance(value, complex):
        return f"{value.real:.{digits}g} {value.imag:+.{digits}g}i"
    if isinstance(value, Bracket):
        return f"{value.lower:.{digits}g} .. {value.upper:.{digits}g}"
    if isinstance(value, Estimate) and value.error:
        return with_error(value, value.error)
    return "NaN" if isnan(value) else f"{value:.{digits}g}" if isfinite(value) else "infinity"


def _native(value: Any, name: str) -> Any:
    """Convert numpy's numbers to Python's. Raises InputError for a value that is not finite."""
    if isinstance(value, list | tuple | range):
        return [_native(one, name) for one in value]
    value = python_scalar(value)
    if isinstance(value, float) and not isfinite(value):
        raise InputError(f"{name} = {value!r}: give a finite number")
    return value
