"""The named figures that a gate, a table or `verify measure` can ask for.

A quantity is data: its name, unit, typed arguments, what it will need solved, and one function. Nothing here
imports numpy until a figure that needs it is asked for.
"""

from collections import Counter
from functools import cache
from math import isfinite, isnan
from typing import TYPE_CHECKING, Any, Literal, cast, get_args, get_origin

import msgspec

from verify.checks import plain
from verify.errors import InputError, shown
from verify.judge.bracket import Bracket
from verify.judge.workbench import Need, Workbench
from verify.quantities.chain import CHAIN_QUANTITIES
from verify.quantities.contact import CONTACT_QUANTITIES
from verify.quantities.energies import ENERGY_QUANTITIES
from verify.quantities.kind import A, Arguments, Figure, Quantity
from verify.quantities.modes import MODE_QUANTITIES
from verify.quantities.motion import MOTION_QUANTITIES
from verify.quantities.motor import MOTOR_QUANTITIES
from verify.quantities.over_wave import WAVE_FORCE_QUANTITIES
from verify.quantities.statics import STATIC_QUANTITIES
from verify.quantities.waves import WAVE_QUANTITIES
from verify.registry import Registry
from verify.scenes.checked import checked
from verify.scenes.described import among_of, type_words
from verify.scenes.given import as_meant

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

QUANTITIES: Registry[Quantity[Any]] = Registry(
    "quantity",
    "verify.quantities",
    own=(
        *MODE_QUANTITIES,
        *WAVE_QUANTITIES,
        *MOTION_QUANTITIES,
        *ENERGY_QUANTITIES,
        *CHAIN_QUANTITIES,
        *STATIC_QUANTITIES,
        *CONTACT_QUANTITIES,
        *MOTOR_QUANTITIES,
        *WAVE_FORCE_QUANTITIES,
    ),
    homes={"stress.share": "verify.stress.quantity:SHARE"},
)


def quantity(name: str) -> Quantity[Any]:
    """A quantity by name. Raises InputError with the nearest name."""
    return QUANTITIES.named(name)


def arguments_of(found: Quantity[A], given: dict[str, Any]) -> A:
    """Arguments checked against the quantity's types; one number stands for a list of one. Raises InputError."""
    kinds, lists, registries = _fields_of(found.arguments)
    data = {k: as_meant(v, kinds.get(k), k) for k, v in _one_name(given, set(kinds)).items()}
    data = {k: [v] if k in lists and not isinstance(v, list) else v for k, v in data.items()}
    for field, among in registries.items():
        if isinstance(name := data.get(field), str):
            among.check(name, field)
        elif field not in data and set(data) <= set(kinds) and _is_required(found.arguments, field):
            raise InputError(f"{field} is missing: give one of {', '.join(among.names())}")
    made = checked(data, found.arguments)
    for name, value in data.items():  # types and bounds of their own let some through
        _check_finite(name, value)
    return made


def _check_finite(name: str, value: Any) -> None:
    """Raise InputError for a number, alone or in a list, that is none or endless: no figure is of one."""
    for one in value if isinstance(value, list) else [value]:
        if isinstance(one, float) and not isfinite(one):
            raise InputError(f"{name} = {value!r}: give a finite number")


def _is_required(kind: type[Arguments], name: str) -> bool:
    return any(field.required for field in msgspec.structs.fields(kind) if field.name == name)


@cache
def _fields_of(kind: type[Arguments]) -> tuple[dict[str, Any], frozenset[str], dict[str, Any]]:
    """(type of each argument, those that are lists, what those are checked among that name something)."""
    kinds = {field.name: field.type for field in msgspec.structs.fields(kind)}
    lists = frozenset(name for name, of in kinds.items() if _is_list(of))
    return kinds, lists, {name: among for name, of in kinds.items() if (among := among_of(of))}


def models_named(arguments: Arguments) -> tuple[str, ...]:
    """The models that arguments name, whatever the argument is called."""
    return tuple(str(getattr(arguments, name)) for name in _fields_of(type(arguments))[2])


def _is_list(kind: Any) -> bool:
    """Whether an argument is a list of values, or nothing."""
    return get_origin(kind) is tuple or any(_is_list(arm) for arm in get_args(kind) if get_origin(kind) is not Literal)


def _one_name(given: dict[str, Any], known: set[str]) -> dict[str, Any]:
    """`segments` for `count` where a quantity knows one of the two alone. Raises InputError for both."""
    other = {"segments": "count", "count": "segments"}
    if set(given) >= set(other):
        raise InputError(f"count = {given['count']!r} and segments = {given['segments']!r} mean the same: give one")
    return {other[k] if k in other and k not in known and other[k] in known else k: v for k, v in given.items()}


def needs_of(found: Quantity[A], arguments: A, scene: "Scene") -> tuple[Need, ...]:
    """The solves a figure will ask for."""
    _check_devices(found, scene)
    _check_places(arguments, scene.beam.length)
    return found.needs(arguments, scene)


ROUNDED = 1e-12
"""Of a beam's length, as in `models/places.py`: as far off an end a place is one that rounding put there."""


def _check_places(arguments: Arguments, length: float) -> None:
    """Raise InputError for a place off the beam: a plan knows it before anything is solved."""
    for name in arguments.places:
        x = getattr(arguments, name)
        if x is not None and not -ROUNDED * length <= x <= length * (1.0 + ROUNDED):
            raise InputError(f"{name} = {x!r} lies off the beam: give a place between 0 and {length!r} m")


def _check_devices(found: Quantity[A], scene: "Scene") -> None:
    """Raise InputError for a figure of the beam that knows no device, where the drive has one."""
    if not found.devices and "beam" in found.arguments.reads:
        scene.refuse_devices(found.name)


UNCOUNTED = {
    "equilibrium": "equilibria and modes of the nonlinear chain",
    "matrices": "figures of matrices",
}
"""By kind of work, what a figure was solved by that no workbench counts."""


def evaluate(found: Quantity[A], arguments: A, scene: "Scene", bench: Workbench) -> Figure:
    """The figure. Raises InputError, also where the quantity gives none."""
    _check_devices(found, scene)
    value = plain(found.evaluate(arguments, scene, bench), found.name)  # of a quantity from elsewhere it may be numpy's
    if not isinstance(value, float | int | complex | Bracket):
        raise InputError(f"quantity = {found.name!r} gave {value!r}, which is no figure: let it give a number")
    if told := UNCOUNTED.get(found.work):
        bench.others[told] = bench.others.get(told, 0) + 1
    return cast(Figure, value)


def as_plain(value: Figure | None) -> Any:
    """A figure for JSON: a number, {"re", "im"} or {"lower", "upper"}."""
    if isinstance(value, complex):
        return {"re": value.real, "im": value.imag}
    if isinstance(value, Bracket):
        return {"lower": value.lower, "upper": value.upper}
    return value


def arguments_as_plain(arguments: Arguments, given: dict[str, Any]) -> dict[str, Any]:
    """What was asked, as it was understood."""
    plain: dict[str, Any] = msgspec.to_builtins(arguments)
    return {key: plain[key] for key in _one_name(given, set(plain))}


def in_words(plain: Any) -> str:
    """A plain figure for a person."""
    if isinstance(plain, dict):
        return (
            " .. ".join(in_words(v) for v in plain.values())
            if "lower" in plain
            else f"{plain['re']:.12g} {plain['im']:+.12g}i"
        )
    return f"{plain:.12g}" if isfinite(plain) else "no number" if isnan(plain) else "infinity"


def described(*words: str) -> list[dict[str, Any]]:
    """Every quantity with its arguments, units and defaults, in plain data; of `words` each stands in what is told.

    Raises InputError where no quantity is told with these words.
    """
    listed = _all_described()
    found = [one for one in listed if all(word.casefold() in _told(one) for word in words)]
    if not found:
        raise InputError(f"no quantity is told with {shown(' '.join(words))}: leave a word out, or all of them")
    return found


def _told(one: dict[str, Any]) -> str:
    """Name, summary, unit and arguments of a quantity, for looking words up."""
    names = (argument["name"] for argument in one["arguments"])
    return " ".join((one["quantity"], one["summary"], one["unit"], *names)).casefold()


def shared_arguments(listed: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """By name, the argument that several of these quantities describe alike; of several such the most frequent."""
    texts = Counter(_as_text(argument) for one in listed for argument in one["arguments"])
    described = {_as_text(argument): argument for one in listed for argument in one["arguments"]}
    found: dict[str, dict[str, Any]] = {}
    for text, times in texts.most_common():
        if times > 1:
            found.setdefault(described[text]["name"], described[text])
    return found


def _as_text(argument: dict[str, Any]) -> str:
    return repr(sorted(argument.items()))


def _all_described() -> list[dict[str, Any]]:
    return [
        {
            "quantity": q.name,
            "unit": q.unit,
            "summary": q.summary,
            "arguments": [_described_argument(f) for f in sorted(msgspec.structs.fields(q.arguments), key=_place)],
        }
        for q in QUANTITIES.values()
    ]


def _place(field: msgspec.structs.FieldInfo) -> int:
    """Which model and how many parts first."""
    return {"model": 0, "count": 1}.get(field.name, 2)


def _described_argument(field: Any) -> dict[str, Any]:
    """One argument: name, type in words, default, meaning."""
    kind, meaning = field.type, ""
    for part in (kind, *getattr(kind, "__args__", ())):
        meaning = next((m.description for m in getattr(part, "__metadata__", ()) if m.description), meaning)
    default = None if field.required else field.default
    return {
        "name": field.name,
        "type": type_words(kind),
        "required": field.required,
        "default": default if default is not None or field.required else "none",
        "meaning": meaning,
    }
