"""Named quantities of interest: the `@quantity` decorator, the registry, evaluation, arguments and their listing.

The signature of the function is the schema of the quantity: an annotation carries type, limits and description, a
default value makes an argument optional, and a parameter annotated with a `msgspec.Struct` is an option group whose
fields become arguments of the quantity. `evaluate` supplies parameters named `scene` and `cache`. `figures` registers
the attributes of a result.

    @quantity("drive.rule_frequency", unit="Hz", reads=("beam",))
    def rule_frequency(scene: Scene, *, mode: Annotated[int, Meta(ge=2, description="the upper one of two")] = 22):
        \"\"\"Root mean square of two neighbouring natural frequencies.\"\"\"
"""

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from math import isfinite
from operator import attrgetter
from pathlib import Path
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.blas import one_blas_thread
from verify.errors import InputError, near_name, shown
from verify.estimate import Value
from verify.registry import Registry
from verify.validation import convert, description_of, entry_of, extra_of, python_scalar, type_name, typed

if TYPE_CHECKING:
    from verify.scene.model import Scene as Scene  # noqa: PLC0414
else:
    Scene = Any
    """Stand-in for annotations, which `@quantity` evaluates; scenes import quantities."""


MODEL_NAME = "model name"  # annotation key of an argument that names a model (`options.model_name`)
PLACE = "place"
Place: TypeAlias = Annotated[float, Meta(description="m from the left end", extra={PLACE: True, "unit": "m"})]
"""A position on the beam: `evaluate` raises InputError for one off the beam."""
TABLES = ("beam", "drive", "slider", "motion", "base")  # tables of a scene that a quantity may depend on
ROUNDING = 1e-12  # tolerance of a position at an end of the beam, relative to its length (as in `linear.positions`)
UNITS = {"resistance": "ohm", "inductance": "H", "capacitance": "F", "peak": "1", "loss_factor": "1"}
"""Unit of a quantity with several figures by the argument that names the figure."""


class Quantity:
    """A named quantity of interest. `@quantity` and `figures` make and register it."""

    def __init__(
        self,
        function: Callable[..., Any],
        name: str,
        unit: str,
        summary: str = "",
        reads: Sequence[str] = TABLES,
        devices: bool = False,
        read: Callable[[Any], Value] = lambda value: value,
    ) -> None:
        """`reads`: tables of a scene on which the value depends; `devices`: whether the quantity models drive.device.

        `summary` replaces the first paragraph of the function's docstring; `read` maps the function's result to the
        value.
        """
        self.name, self.unit, self.reads, self.devices = name, unit, tuple(reads), devices
        self.summary = summary or " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
        self.function, self.read = function, read
        parameters = inspect.signature(function).parameters
        self._supplied = [name for name in ("scene", "cache") if name in parameters]
        self._groups: dict[str, type[msgspec.Struct]] = {}
        fields: list[Any] = []
        for parameter in (parameters[name] for name in parameters if name not in self._supplied):
            kind = parameter.annotation
            if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
                self._groups[parameter.name] = kind
                options = msgspec.structs.fields(kind)
                fields += [(f.name, f.type, *(() if f.required else (f.default,))) for f in options]
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
            models = extra_of(field.type, MODEL_NAME)
            kind = " | ".join(models.names()) if models else type_name(field.type)
            default = None if field.required else field.default
            entry = {"name": field.name, "type": kind, "required": field.required, "default": default}
            entries.append(entry | {"description": description_of(field.type)})
        return entries

    def bind(self, arguments: Mapping[str, Any]) -> dict[str, Any]:
        """Keyword arguments of the function: checked, with defaults, option groups built. Raises InputError."""
        data = {name: _native(value, name) for name, value in arguments.items()}
        required = {field.name for field in msgspec.structs.fields(self.schema) if field.required}
        for name, kind in self.types.items():
            models = extra_of(kind, MODEL_NAME)
            if models is not None and isinstance(data.get(name), str):
                models.check(data[name], name)
            elif models is not None and name in required - set(data) and set(data) <= set(self.types):
                raise InputError(f"{name} is missing: give one of {', '.join(models.names())}")
            if name in data and isinstance(data[name], int | float) and entry_of(kind) is not None:
                data[name] = [data[name]]
        checked = convert(data, self.schema)
        values = {name: getattr(checked, name) for name in self.types}
        groups = {
            parameter: kind(**{name: values.pop(name) for name in kind.__struct_fields__})
            for parameter, kind in self._groups.items()
        }
        return values | groups

    def with_defaults(self, arguments: Mapping[str, Any]) -> dict[str, Any]:
        """The arguments and the defaults of the others."""
        fields = msgspec.structs.fields(self.schema)
        return {field.name: field.default for field in fields if not field.required} | dict(arguments)

    def unit_of(self, arguments: Mapping[str, Any]) -> str:
        """Its unit; where that depends on an argument as resistance or inductance, the unit for these arguments."""
        values = self.with_defaults(arguments).values()
        units = [UNITS[value] for value in values if isinstance(value, str) and value in UNITS]
        return units[0] if units and " or " in self.unit else self.unit

    @one_blas_thread()
    def evaluate(self, arguments: Mapping[str, Any], scene: Scene, cache: SolutionCache) -> Value:
        """The value for arguments that are plain data. Raises InputError."""
        bound = self.bind(arguments)
        accepted = [name for group in self._groups.values() for name in getattr(group, "accepts", ())]
        if not self.devices and "beam" in self.reads and (part := scene.beside) and part not in accepted:
            x = scene.devices[0].position if scene.devices else scene.shunts[0][0]
            raise InputError(
                f"quantity = {self.name!r} does not model {part}, and the scene has one at {x:g} m: leave {part} out, "
                "or use a quantity of the steady wave"
            )
        for name in (name for name in arguments if extra_of(self.types[name], PLACE)):
            x, length = arguments[name], scene.beam.length
            if x is not None and not -ROUNDING * length <= x <= length * (1.0 + ROUNDING):
                raise InputError(f"{name} = {x!r} lies off the beam: give a position between 0 and {length!r} m")
        supplied = {"scene": scene, "cache": cache}
        result = self.function(**{name: supplied[name] for name in self._supplied}, **bound)
        value = python_scalar(self.read(result))
        if not isinstance(value, float | int | complex | Bracket):
            raise InputError(f"quantity = {self.name!r} returns {shown(value)}: return a number or a Bracket")
        return value


MODULES = sorted({module.name for module in iter_modules([str(Path(__file__).parent)])} - {"base", "options"})
"""Modules of this folder that register quantities."""
FAMILIES = {
    "mode": "modes",
    "beam": "modes",
    "drive": "modes",
    "wave": "waves",
    "shunt": "actuator",
    "motion": "slider",
}
"""First module for a family, the first word of a name, where it has another name; the others follow."""


class Quantities(Registry[Quantity]):
    """The quantities; a name imports the modules of this folder until one registers it, a list imports all."""

    def __contains__(self, name: object) -> bool:
        family = str(name).partition(".")[0]
        first = FAMILIES.get(family, family)
        for module in sorted(MODULES, key=lambda module: module != first):
            if name not in self._members:
                import_module(f"verify.quantities.{module}")
        return super().__contains__(name)

    def __iter__(self) -> Iterator[str]:
        for module in MODULES:
            import_module(f"verify.quantities.{module}")
        return super().__iter__()


QUANTITIES = Quantities("quantity", "verify.quantities")
"""The quantities of this package, those registered in this process, and entry points of `verify.quantities`."""


def quantity(
    name: str, *, unit: str, reads: Sequence[str] = TABLES, devices: bool = False
) -> Callable[[Callable[..., Value]], Quantity]:
    """Register a function as a quantity, whose docstring is its summary; see `Quantity` for the options."""
    return lambda function: QUANTITIES.register(Quantity(function, name, unit, "", reads, devices))


def figures(
    family: str, result: Callable[..., Any], *, reads: Sequence[str] = TABLES, devices: bool = False
) -> Callable[..., Quantity]:
    """A function that registers a figure of `result`: a row of name, unit, sentence and attribute (default: the name).

    The signature of `result` is the schema. `read` in place of an attribute maps the result to the value.
    """

    def figure(
        name: str, unit: str, sentence: str, attribute: str = "", read: Callable[[Any], Value] | None = None
    ) -> Quantity:
        read = read or attrgetter(attribute or name)
        return QUANTITIES.register(Quantity(result, f"{family}.{name}", unit, sentence, reads, devices, read))

    return figure


def evaluate(name: str, arguments: Mapping[str, Any], scene: Scene, cache: SolutionCache) -> Value:
    """The value of a quantity. `arguments` is plain data as in a scene file; unknown ones raise InputError."""
    return QUANTITIES.named(name).evaluate(arguments, scene, cache)


def parse_arguments(name: str, words: Iterable[str]) -> dict[str, Any]:
    """Convert KEY=VALUE arguments of a command line by their types. Raises InputError.

    Lists are 20,40,80 or a range 10-50:10 in steps of 10; a relative number may be in per cent.
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
    quantities = [
        {"name": q.name, "unit": q.unit, "summary": q.summary, "arguments": q.arguments}
        for q in QUANTITIES.values()
        for text in [" ".join((q.name, q.summary, q.unit, *q.schema.__struct_fields__)).casefold()]
        if all(word.casefold() in text for word in words)
    ]
    if not quantities:
        remedy = "leave a word out" if len(words) > 1 else "give another word, or none for all"
        raise InputError(f"words = {shown(' '.join(words))}: no quantity matches, {remedy}")
    return quantities


def _native(value: Any, name: str) -> Any:
    """Convert numpy's numbers to Python's. Raises InputError for a value that is not finite."""
    if isinstance(value, list | tuple | range):
        return [_native(item, name) for item in value]
    value = python_scalar(value)
    if isinstance(value, float) and not isfinite(value):
        raise InputError(f"{name} = {value!r}: give a finite number")
    return value
