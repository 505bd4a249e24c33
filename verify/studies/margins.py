"""Margins of a figure: what the value of a quantity, or a run of the scene, neglects."""

from collections.abc import Mapping
from contextlib import suppress
from math import inf
from typing import Any

import msgspec

from verify.analysis.comparison import ORDER_SPREAD
from verify.analysis.margins import beam_margins, run_margins, sag_margins
from verify.analysis.solution_cache import Settings, SolutionCache
from verify.analysis.variants import DEFAULTS, Variant
from verify.analysis.verdict import Margin
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.quantities.base import QUANTITIES, Scene, evaluate

CREST_SPREAD = 2.0, 25.0
"""Standing-wave ratios up to which a crest speed is that of all crests, and up to which it is one under a condition."""
PATH_SPREAD = 1.25
"""Standing-wave ratio from which the crest speed, and with it that of a slider on short feet, varies along the beam by
more than a tenth about its mean."""
TRUE_OF_ANY_THEORY = ("order", ".count_needed")  # quantities that errors of beam theory do not change


def quantity_margins(name: str, arguments: Mapping[str, Any], scene: Scene, cache: SolutionCache) -> list[Margin]:
    """Margins of a quantity that the cache has evaluated: of its model at its mode or drive, and of its runs."""
    quantity = QUANTITIES.named(name)
    fields = msgspec.structs.fields(quantity.schema)
    values = {field.name: field.default for field in fields if not field.required} | dict(arguments)
    mode, hertz = values.get("mode"), values.get("frequency_hz")
    if hertz is None and "drive" in quantity.reads and scene.drive is not None:
        hertz = scene.drive.frequency_hz
    margins: list[Margin] = []
    if "beam" in quantity.reads and (isinstance(mode, int) or hertz is not None):
        settings = tuple((key, values[key]) for key in DEFAULTS if values.get(key) not in (None, DEFAULTS[key]))
        size = (values["model"], values.get("count")) if values.get("model") in MODELS else (EXACT, None)
        at = {"mode": mode} if isinstance(mode, int) else {"frequency_hz": hertz}
        if not name.endswith(TRUE_OF_ANY_THEORY):
            with suppress(InputError):
                margins += beam_margins(cache, [size], **at, settings=settings)
        margins += figure_margins(name, arguments, scene, cache, settings)
    runs = [*cache.motions.values(), *(entry.run for entry in cache.motors.values() if hasattr(entry, "run"))]
    if scene.slider is not None and (sliding := [run for run in runs if run.coupling is not None]):
        margins += [m for run in sliding for m in run_margins(run, scene.slider, MODELS[run.model].title)]
        margins += sag_margins(cache, scene.slider)
    return margins


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
        what, ratio, failure, fine, limit = (
            "observed order",
            abs(observed - order),
            "",
            0.2 * ORDER_SPREAD,
            ORDER_SPREAD,
        )
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
