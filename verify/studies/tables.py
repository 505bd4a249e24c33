"""Rows of a study over variants of a scene, keys with other values on one side, quantities on the other; their margins.

A key with a dot is one of the scene ("beam.length", "drive.force.*.amplitude" for all entries of a list), one without
is an argument of the quantities that have it. Keys joined by commas have the same value.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import inf, isfinite
from typing import Any, TypeAlias

import msgspec
from msgspec.structs import replace

from verify.analysis.comparison import ORDER_SPREAD
from verify.analysis.margins import result_margins
from verify.analysis.solution_cache import EULER, Settings, SolutionCache
from verify.analysis.variants import DEFAULTS, Variant
from verify.analysis.verdict import Margin
from verify.errors import InputError, near_name
from verify.estimate import as_plain
from verify.linear.registry import EXACT, MODELS
from verify.problem.slider import Slider
from verify.quantities.base import QUANTITIES, TABLES, evaluate
from verify.scene.load import scene_from
from verify.studies.base import Scene
from verify.studies.claims import computed

CREST_SPREAD = 2.0, 25.0
"""Standing-wave ratios up to which a crest speed is that of all crests, and up to which it is one under a condition."""
PATH_SPREAD = 1.25
"""Standing-wave ratio from which the crest speed, and with it that of a slider on short feet, varies along the beam by
more than a tenth about its mean."""
ORDER_BOUNDS = 0.2 * ORDER_SPREAD, ORDER_SPREAD  # departures from the order in theory, as of the standing-wave ratios
TRUE_OF_ANY_THEORY = ("order", ".count_needed")  # quantities that errors of beam theory do not change
Request: TypeAlias = tuple[str, dict[str, Any]]  # name and arguments of a quantity
UNREAD = ("spectrum", "convergence", "wave", "large-motion", "sweep", "optimise", "sensitivity")
"""Studies that no quantity reads, or that vary the scene themselves."""


@dataclass
class Row:
    """Figures of one variant."""

    values: list[Any]  # As plain data, by request; None from the first that is undefined
    reason: str | None = None  # Why a value is missing
    agreeing: int = 0  # Claims of the scene that agree
    margins: list[Margin] = field(default_factory=list)


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
        """The figures of one variant: if `real`, finite real numbers or none; margins and claims on request."""
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
            row.values = [None] * len(self.requests) if real else row.values
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


def scene_margins(
    scene: Scene,
    cache: SolutionCache,
    sizes: Sequence[tuple[str, int | None]] = (),
    *,
    by: Any = None,
    driven: bool = True,
    slider: Slider | None = None,
    **at: Any,
) -> list[Margin]:
    """`result_margins` of a scene with its exact steady motion by the options of a drive; none at a resonance.

    `driven`: whether the drive has to do with the result; `slider`: the one that does. `at`: see `result_margins`.
    """
    field, theory = None, dict(at.get("settings", ())).get("theory", EULER)
    if driven and scene.forces:
        from verify.quantities import waves  # which `verify measure` of a mode does not load
        from verify.waves.driven_case import driven as solved

        names = ("frequency_hz", "phase_deg", "position", "loss_factor", "drive")
        options = waves.FieldOptions(theory=theory, **{key: getattr(by, key) for key in names if hasattr(by, key)})
        with suppress(InputError):
            case = waves.driven_case(scene, options)
            if getattr(by, "force", None) is not None:
                case = replace(case, forces=options.forces(scene, by.force))
            field = solved(case, cache)
    path = slider.speed * (scene.motion.duration if scene.motion else inf) if slider and slider.speed else 0.0
    return result_margins(cache, sizes, field=field, slider=slider, path=path, **at)


def quantity_margins(name: str, arguments: Mapping[str, Any], scene: Scene, cache: SolutionCache) -> list[Margin]:
    """Margins of a quantity that the cache has evaluated: of its model at its mode or drive, and of its runs."""
    quantity = QUANTITIES.named(name)
    if "beam" not in quantity.reads:
        return []
    values, groups = quantity.with_defaults(arguments), quantity.bind(arguments).values()
    mode, hertz = values.get("mode"), values.get("frequency_hz")
    if hertz is None and "drive" in quantity.reads and scene.drive is not None:
        hertz = scene.drive.frequency_hz
    settings = tuple((key, values[key]) for key in DEFAULTS if values.get(key) not in (None, DEFAULTS[key]))
    at: dict[str, Any] = {"settings": settings, "steady": name.startswith("wave.")}
    at["by"] = next((group for group in groups if hasattr(group, "forces")), None)
    # a ratio does not depend on amplitudes, which another kind of drive gives another unit; a chain moves far
    unit = quantity.unit in ("1", "deg", "Hz") and values.get("drive") is not None
    at["driven"] = "drive" in quantity.reads and not unit and not name.startswith("chain.")
    if "slider" in quantity.reads and scene.slider is not None:
        at["runs"] = [(MODELS[run.model].title, run) for run in cache.runs if run.coupling is not None]
        moved = (group.of(scene) for group in groups if hasattr(group, "time_step"))
        at["slider"] = next(moved, scene.slider) if at["runs"] else None
    if name.endswith(TRUE_OF_ANY_THEORY) or not (isinstance(mode, int) or hertz):
        margins = scene_margins(scene, cache, **at)
    else:
        size = (values["model"], values.get("count")) if values.get("model") in MODELS else (EXACT, None)
        modal: dict[str, Any] = {"mode": mode} if isinstance(mode, int) else {"frequency_hz": hertz}
        try:
            margins = scene_margins(scene, cache, [size], **at, **modal)
        except InputError:  # a mode that the exact beam does not have
            margins = scene_margins(scene, cache, **at)
    return margins + (figure_margins(name, arguments, scene, cache, settings) if isinstance(mode, int) or hertz else [])


def premises(scene: Scene, cache: SolutionCache, reads: Collection[str] = TABLES) -> tuple[Margin, ...]:
    """Margins of what results from these tables of a scene rest on, computed once: units, drive, slider's sag."""
    if "beam" not in reads:
        return ()
    driven, slider = "drive" in reads, scene.slider if "slider" in reads else None
    key = "premises", driven, "slider" in reads
    return cache.once(key, lambda: tuple(scene_margins(scene, cache, driven=driven, slider=slider)))


def figure_margins(
    name: str, arguments: Mapping[str, Any], scene: Scene, cache: SolutionCache, settings: Settings = ()
) -> list[Margin]:
    """Conditions of `wave.crest_speed`, of a free slider on a wave, and of `mode.order`, near the order in theory."""
    if name in ("motor.free_speed", "motor.start_time"):
        return path_margins(arguments.get("model", "segment"), arguments.get("count"), scene, cache)
    if name == "wave.crest_speed":
        ratio: Any = evaluate("wave.standing_wave_ratio", arguments, scene, cache)
        fast = f"the fastest over the slowest crests along the beam are the standing-wave ratio, {ratio:.3g}"
        condition = f"the crest speed of the rms amplitude is meant ({fast})"
        failure = f"a nearly standing wave has no crest speed: {fast}"
        what, (fine, limit) = "variation of the crest speed along the beam", CREST_SPREAD
    elif name == "mode.order" and arguments["model"] in MODELS:
        if (order := Variant(arguments["model"], settings).expected_order(cache.beam)) is None:
            return []
        observed: Any = evaluate(name, arguments, scene, cache)
        condition = f"the sizes count as asymptotic: the observed order is {observed:.2f}, in theory {order}"
        what, ratio, failure, (fine, limit) = "observed order", abs(observed - order), "", ORDER_BOUNDS
    else:
        return []
    return [Margin(name=what, size=ratio, fine=fine, limit=limit, condition=condition, failure=failure, is_error=False)]


def path_margins(model: str, count: int | None, scene: Scene, cache: SolutionCache) -> list[Margin]:
    """Condition of the speed of a slider that moves along a partly standing wave."""
    with suppress(InputError):  # no two waves in the window
        ratio: Any = evaluate("wave.standing_wave_ratio", {"model": model, "count": count}, scene, cache)
        path = f"the speed along the path of the run is meant (standing-wave ratio {ratio:.3g})"
        name = "variation of the speed along the beam"
        return [Margin(name=name, size=ratio, fine=PATH_SPREAD, limit=inf, condition=path, is_error=False)]
    return []


def reduction_margins(scene: Scene) -> list[Margin]:
    """Margin of the actuators' reduction to springs and masses in time; none for other drives."""
    hertz = scene.drive.frequency_hz if scene.drive else 0.0
    error = scene.in_time(scene.forces, hertz).error
    if not error:
        return []
    softer = "use a shorter actuator, or compare with quantities of the steady wave"
    return [Margin(name="actuators as springs and masses", size=error, where=f"at {hertz:g} Hz", remedy=softer)]
