"""Sliders that may leave the surface, on a beam in time: `run_motor` of one, `run_motors` of several together."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import msgspec

from verify.beam import Beam
from verify.checks import check_kind, check_number, plain, several
from verify.errors import InputError
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.motion.request import Driven, Modelled, Started, Watched, requested
from verify.motor.carry import carry_out
from verify.motor.combine import CHAIN, check_goes_on, check_together
from verify.motor.feet import Placed
from verify.motor.going_on import check_runs
from verify.motor.plan import lay_out
from verify.motor.result import MotorRun
from verify.options import Links, Start
from verify.slider import Slider

MODES = 80
"""Of the exact beam, unless asked for otherwise."""
STEPS_PER_PERIOD = 61
"""A prime: points that stand evenly in a wave do not all meet the turn of friction at the same phases of it."""


class Asked(msgspec.Struct, frozen=True, eq=False):
    """A run as it is asked for, whatever the sliders."""

    driven: Driven
    modelled: Modelled
    started: Started
    watched: Watched
    links: Links
    progress: Callable[[float], None]
    patient: bool


@as_typed
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
    patient: bool = True,
) -> MotorRun:
    """A slider with `slider.contact` on a driven beam, steady or from rest, for `duration` seconds.

    `model` = 'chain' is the nonlinear chain of `count` links, rigid or stretching, from rest and undamped; the exact
    beam keeps `modes` modes, 80 unless given. The slider is put down level where its springs carry what presses it on,
    at rest across the beam. `held_speed` (m/s) keeps its speed whatever friction does, `frozen` its place whatever its
    speed, so that its motion is periodic. Steps are a `steps_per_period`-th of the drive's period, or shorter where the
    contact is stiff, unless `step` is given; forces act in mid-step, of second order, coupled two-way on the modes.
    Otherwise as `simulate`. Raises InputError.
    """
    check_kind("slider", slider, Slider)
    if continue_from is not None:
        check_kind("continue_from", continue_from, MotorRun)
    driven = Driven(beam, as_forces(forces), frequency_hz, duration)
    by = Modelled(model, count, modes, modal_damping, MODES)
    watched = Watched(at, samples, step, steps_per_period, False)
    asked = Asked(driven, by, Started(start, soft_start_periods, (), None), watched, links, progress, patient)
    return _run(asked, [(slider, held_speed, frozen)], [] if continue_from is None else [continue_from])[0]


@as_typed
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
    patient: bool = True,
) -> tuple[MotorRun, ...]:
    """Several sliders on one beam, one run for each: coupled two-way they feel each other through it.

    They rub by one law of one slope and are coupled alike, by size by what all do together; `held_speed` and `frozen`
    are of all, or one for each. All end where one leaves the beam; they go on (`continue_from`) from one instant of one
    motion. Otherwise as `run_motor`. Raises InputError.
    """
    driven = Driven(beam, as_forces(forces), frequency_hz, duration)
    by = Modelled(model, count, modes, modal_damping, MODES)
    watched = Watched(at, samples, step, steps_per_period, False)
    asked = Asked(driven, by, Started(start, soft_start_periods, (), None), watched, links, progress, patient)
    put, before = several("sliders", sliders, Slider), several("continue_from", continue_from, MotorRun)
    speeds, stay = _each("held_speed", held_speed, len(put)), _each("frozen", frozen, len(put))
    return _run(asked, list(zip(put, speeds, stay, strict=True)), before)


def _each(field: str, given: Any, n: int) -> tuple[Any, ...]:
    """One for each slider. Raises InputError."""
    row = given.tolist() if getattr(given, "shape", ()) else given
    found = tuple(row) if isinstance(row, Sequence) else (row,) * n
    if len(found) != n:
        raise InputError(f"{field} has {len(found)} of them for {n} sliders: give one for each, or one for all")
    return found


def _run(
    asked: Asked, put: Sequence[tuple[Slider, float | None, bool]], runs: Sequence[MotorRun]
) -> tuple[MotorRun, ...]:
    """The runs of sliders, each with its held speed and whether it stays at its place. Raises InputError."""
    began, beam, model, start = perf_counter(), asked.driven.beam, asked.modelled.model, asked.started.start
    check_kind("patient", asked.patient, bool)
    check_together(model, start, [slider for slider, _, _ in put])
    before = [run.state for run in runs]
    check_goes_on(model, before)
    for _, speed, stays in put:
        if speed is not None:
            check_number("held_speed", speed, "m/s")
        check_kind("frozen", plain(stays, "frozen"), bool)
    if model == CHAIN:
        from verify.motor.on_chain import check_links_asked

        check_links_asked(asked.modelled, asked.links)
    linear = msgspec.structs.replace(asked.modelled, model="segment") if model == CHAIN else asked.modelled
    request = requested(asked.driven, linear, asked.started, asked.watched, put[0][0])
    placed = tuple(Placed(slider, slider.start_on(beam), speed, bool(stays)) for slider, speed, stays in put)
    check_runs(runs, request, placed)
    if model == CHAIN:
        from verify.motor.on_chain import check_chain, run_on_chain

        check_chain(request, asked.started.soft)
        return run_on_chain(request, placed, asked.links, began, asked.progress)
    if asked.links != "rigid":
        raise InputError(f"links = {asked.links!r} is of model = 'chain': leave it out on {model}")
    return carry_out(lay_out(request, placed, before), before, began, asked.progress, asked.patient)
