"""Rows of a study over variants of a scene: keys with other values on one side, quantities on the other.

A key with a dot is one of the scene ("beam.length", "drive.force.*.amplitude" for all entries of a list), one without
is an argument of the quantities that have it. Keys joined by commas have the same value.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin
from verify.errors import InputError, near_name
from verify.quantities.base import QUANTITIES, as_plain, evaluate
from verify.scene.load import scene_from
from verify.studies.base import Scene, Study
from verify.studies.claims import computed
from verify.studies.margins import quantity_margins

Request: TypeAlias = tuple[str, dict[str, Any]]  # name and arguments of a quantity
UNREAD = ("spectrum", "convergence", "wave", "sweep", "optimise", "sensitivity")
"""Studies that no quantity reads, or that vary the scene themselves."""


@dataclass
class Row:
    """Figures of one variant."""

    values: list[Any]
    """As plain data, by request; None from the first that is undefined."""
    reason: str | None = None
    """Why a value is missing."""
    agreeing: int = 0
    """Claims of the scene that agree."""
    margins: list[Margin] = field(default_factory=list)

    @property
    def numbers(self) -> list[Any]:
        """The values; None for all where one is undefined."""
        return self.values if self.reason is None else [None] * len(self.values)


@dataclass(frozen=True)
class Variants:
    """Quantities on a scene, which is plain tables without gates and without the studies that vary it."""

    tables: dict[str, Any]
    requests: Sequence[Request]

    @classmethod
    def of(cls, scene: Scene, requests: Sequence[Request]) -> "Variants":
        """The variants of a scene."""
        tables = {name: msgspec.to_builtins(getattr(scene, name)) for name in scene.__struct_fields__ if name != "gate"}
        studies = tables.pop("studies")
        return cls(tables | {name: study for name, study in studies.items() if name not in UNREAD}, requests)

    def check_keys(self, keys: Iterable[str], field: str) -> None:
        """Raise InputError for a key that is neither one of the scene nor an argument; `field` names their list."""
        arguments = dict.fromkeys(key for name, _ in self.requests for key in QUANTITIES.named(name).types)
        for key in keys:
            if "." in key:
                _put(self.tables, key.split("."), f"{field}.{key}", None)
            elif key not in arguments:
                names = ", ".join(dict.fromkeys(name for name, _ in self.requests))
                raise InputError(f"{field}: {key} is no argument of {names}: {near_name(key, tuple(arguments))}")

    def at(self, values: Mapping[str, Any], field: str = "values") -> tuple[Scene, SolutionCache, list[Request]]:
        """Scene, cache and quantities of one variant. Raises InputError."""
        each = {key.strip(): value for keys, value in values.items() for key in keys.split(",")}
        self.check_keys(each, field)
        tables, requests = self.tables, list[Request]()
        for key, value in each.items():
            tables = _put(tables, key.split("."), key, value) if "." in key else tables
        for name, arguments in self.requests:
            types = QUANTITIES[name].types
            requests.append((name, arguments | {key: value for key, value in each.items() if key in types}))
            QUANTITIES[name].bind(requests[-1][1])
        scene = scene_from(tables)
        return scene, SolutionCache(scene.beam), requests

    def check(self, field: str, values: Sequence[tuple[str, float]]) -> dict[str, float]:
        """Values by key, of which `at` takes each once. Raises InputError for what it refuses, naming the field."""
        self.at(dict(values), field)
        if len(dict(values)) < len(values):
            raise InputError(f"{field}: a key occurs twice, give each once")
        return dict(values)

    def row(self, values: Mapping[str, Any], *, real: bool = False, margins: bool = False, claims: bool = False) -> Row:
        """The figures of one variant; `real` requires finite real numbers, margins and claims are optional."""
        row = Row([None] * len(self.requests))
        try:
            scene, cache, requests = self.at(values)
            for i, (name, arguments) in enumerate(requests):
                value = evaluate(name, arguments, scene, cache)
                if real and not (isinstance(value, int | float) and isfinite(value)):
                    raise InputError(f"quantity = {name!r} is no finite real number: {value}")
                row.values[i] = as_plain(value)
                row.margins += quantity_margins(name, arguments, scene, cache) if margins else ()
            for claim in scene.claim if claims else ():
                row.agreeing += claim.agrees(computed(claim, scene, cache))
        except InputError as error:
            row.reason = str(error)
        return row

    def margins(self, values: Mapping[str, Any]) -> list[Margin]:
        """Margins of all quantities at one variant, of what is known without their evaluation. Raises InputError."""
        scene, cache, requests = self.at(values)
        return [margin for request in requests for margin in quantity_margins(*request, scene, cache)]

    def value(self, keys: str) -> Any:
        """The scene's value of a key, of the first of several, or of an argument; None where it has none."""
        key = keys.partition(",")[0].strip()
        if "." not in key:
            return next((arguments[key] for _, arguments in self.requests if key in arguments), None)
        here: Any = self.tables
        for step in key.split("."):
            _put(here, [step], key, None)  # which refuses an unknown one
            here = here[0 if step == "*" else int(step)] if isinstance(here, list | tuple) else here[step]
        return here


class OfQuantity(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A study of one quantity under other values of keys."""

    quantity: Annotated[str, Meta(description="Name, see `verify quantities`.")]
    arguments: Annotated[dict[str, Any], Meta(description="Its arguments.")] = msgspec.field(default_factory=dict)


def _put(node: Any, path: list[str], field: str, value: Any) -> Any:
    """A copy of plain tables with another value at a path. Raises InputError for a path that does not exist."""
    head, *tail = path
    names = dict(enumerate(node)) if isinstance(node, list | tuple) else node if isinstance(node, dict) else {}
    entries = {str(name): entry for name, entry in names.items()}
    if head not in entries and not (head == "*" and isinstance(node, list | tuple) and node):
        raise InputError(f"{field}: {head} is not known: {near_name(head, tuple(entries))}")
    for name, entry in entries.items():
        if head in ("*", name):
            entries[name] = _put(entry, tail, field, value) if tail else value
    return list(entries.values()) if isinstance(node, list | tuple) else entries
