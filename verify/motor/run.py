"""Sliders that may leave the surface, on a beam in time: `run_motor` for one, `run_motors` for several together."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from verify.errors import InputError, written
from verify.linear.positions import Forces, Numbers, forces_on
from verify.motion.request import Request, check_same_beam, requested
from verify.motor.combine import CHAIN, check_together
from verify.motor.feet import Placed
from verify.motor.result import MotorRun
from verify.motor.setup import carry_out, lay_out
from verify.options import LINKS, Links, Start
from verify.problem.beam import Beam
from verify.problem.slider import Slider
from verify.validation import check_kind, check_number, check_word, plain, several

MODES = 80
"""Of the exact beam, unless given."""
STEPS_PER_PERIOD = 61
"""A prime: points that stand evenly in a wave do not all reverse their friction at the same phases of it."""


def run_motor(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    slider: Slider,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    start: Start = "steady",
    soft_start_periods: float = 0.0,
    modal_damping: float | None = None,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int = STEPS_PER_PERIOD,
    held_speed: float | None = None,
    frozen: bool = False,
    links: Links = "rigid",
    continue_from: MotorRun | None = None,
    progress: Callable[[float], None] = lambda part: None,
) -> MotorRun:
    """A slider with `slider.contact` on a driven beam, steady or from rest, for `duration` seconds.

    `model` = 'chain' is the nonlinear chain of `count` links, rigid or stretching, from rest and undamped; the exact
    beam keeps `modes` modes, 80 unless given. The slider starts level where its springs carry the preload, at rest
    across the beam. `held_speed` (m/s) prescribes its speed, `frozen` its place, so that its motion is periodic. Steps
    are a `steps_per_period`-th of the drive's period, or shorter where the contact is stiff, unless `step` is given;
    forces act in mid-step, of second order. Otherwise as `simulate`. Raises InputError.
    """
    check_kind("slider", slider, Slider)
    if continue_from is not None:
        check_kind("continue_from", continue_from, MotorRun)
    runs = [] if continue_from is None else [continue_from]
    settings = {
        "model": model,
        "count": count,
        "modes": modes,
        "start": start,
        "soft_start_periods": soft_start_periods,
        "modal_damping": modal_damping,
        "at": at,
        "samples": samples,
        "step": step,
        "steps_per_period": steps_per_period,
    }
    driven = (beam, forces_on(beam, forces), frequency_hz, duration)
    return _run(driven, settings, links, [(slider, held_speed, frozen)], runs, progress)[0]


def run_motors(
    beam: Beam,
    forces: Forces,
    frequency_hz: float,
    duration: float,
    *,
    sliders: Sequence[Slider],
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    start: Start = "steady",
    soft_start_periods: float = 0.0,
    modal_damping: float | None = None,
    at: Numbers = (),
    samples: int = 201,
    step: float | None = None,
    steps_per_period: int = STEPS_PER_PERIOD,
    held_speed: float | Sequence[float | None] | None = None,
    frozen: bool | Sequence[bool] = False,
    links: Links = "rigid",
    continue_from: Sequence[MotorRun] = (),
    progress: Callable[[float], None] = lambda part: None,
) -> tuple[MotorRun, ...]:
    """Several sliders on one beam, one run for each: with two-way coupling they interact through it.

    They share one friction law, slope and coupling; `held_speed` and `frozen` are of all, or one for each. All end
    where one leaves the beam, and continue (`continue_from`) from one instant of one motion. Otherwise as `run_motor`.
    Raises InputError.
    """
    put, runs = several("sliders", sliders, Slider), several("continue_from", continue_from, MotorRun)
    speeds, stay = _each("held_speed", held_speed, len(put)), _each("frozen", frozen, len(put))
    settings = {
        "model": model,
        "count": count,
        "modes": modes,
        "start": start,
        "soft_start_periods": soft_start_periods,
        "modal_damping": modal_damping,
        "at": at,
        "samples": samples,
        "step": step,
        "steps_per_period": steps_per_period,
    }
    driven = (beam, forces_on(beam, forces), frequency_hz, duration)
    return _run(driven, settings, links, list(zip(put, speeds, stay, strict=True)), runs, progress)


def _each(field: str, given: Any, n: int) -> tuple[Any, ...]:
    """One for each slider. Raises InputError."""
    row = given.tolist() if getattr(given, "shape", ()) else given
    found = tuple(row) if isinstance(row, Sequence) else (row,) * n
    if len(found) != n:
        raise InputError(f"{field} has {len(found)} of them for {n} sliders: give one for each, or one for all")
    return found


def _run(
    driven: tuple[Any, ...],
    settings: dict[str, Any],
    links: Links,
    put: Sequence[tuple[Slider, float | None, bool]],
    runs: Sequence[MotorRun],
    progress: Callable[[float], None],
) -> tuple[MotorRun, ...]:
    """The runs of sliders, each with its held speed and whether it stays at its place. Raises InputError."""
    began, beam, model = perf_counter(), driven[0], settings["model"]
    check_together(model, settings["start"], [slider for slider, _, _ in put])
    for _, speed, stays in put:
        if speed is not None:
            check_number("held_speed", speed, "m/s")
        check_kind("frozen", plain(stays), bool)
    if model == CHAIN:
        check_word("links", links, LINKS)
        for name, needed in (("count", True), ("modes", False)):
            if (settings[name] is not None) != needed:
                raise InputError(f"{name} = {settings[name]!r}: a nonlinear chain has a count of links and no modes")
        settings = settings | {"model": "segment"}
    request = requested(*driven, **settings, slider=put[0][0], default_modes=MODES)
    placed = tuple(Placed(slider, slider.start_on(beam), speed, bool(stays)) for slider, speed, stays in put)
    _check_runs(model, runs, request, placed)
    if model == CHAIN:
        from verify.motor.on_chain import run_on_chain

        starts: tuple[tuple[str, Any], ...] = (("start", "rest"), ("soft_start_periods", 0.0))
        for name, wanted in starts:
            if settings[name] != wanted:
                raise InputError(f"{name} = {settings[name]!r}: a nonlinear chain starts so: give {wanted!r}")
        if request.damping:
            raise InputError(f"modal_damping = {request.damping!r}: a nonlinear chain is undamped, give 0.0")
        return run_on_chain(request, placed, links, began, progress)
    if links != "rigid":
        raise InputError(f"links = {links!r} is of model = 'chain': leave it out on {model}")
    before = [run.state for run in runs]
    return carry_out(lay_out(request, placed, before), before, began, progress)


def _check_runs(model: str, runs: Sequence[MotorRun], request: Request, placed: Sequence[Placed]) -> None:
    """Raise InputError for runs that these sliders cannot continue: another beam, instant, motion or slider."""
    if runs and (model == CHAIN or any(run.state.model == CHAIN for run in runs)):
        raise InputError("continue_from: runs on a nonlinear chain start at rest and are not continued, leave it out")
    if runs and len(runs) != len(placed):
        raise InputError(f"continue_from has {len(runs)} runs for {len(placed)} sliders: give one for each")
    for run, one in zip(runs, placed, strict=bool(runs)):
        check_same_beam(run.state, request.beam, request.model, request.count)
        first, state = runs[0].state, run.state
        if first.time != state.time or not (
            np.array_equal(first.q, state.q) and np.array_equal(first.rates, state.rates)
        ):
            raise InputError(
                f"continue_from has runs of different motions, at {written(first.time)} s and {written(state.time)} s: "
                "give those of one run_motors"
            )
        if run.start is not None and run.start != one.start:
            raise InputError(
                f"slider.position = {written(one.start)} m: continue_from is of a slider put on at "
                f"{written(run.start)} m, give that"
            )
        own = run.slider.speed if run.slider else 0.0
        if one.slider.speed not in (0.0, own, state.speed):
            raise InputError(
                f"slider.speed = {written(one.slider.speed)} m/s: continue_from ends at {written(state.speed)} m/s, "
                "leave the speed as it was"
            )
