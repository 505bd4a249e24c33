"""The motor for a report: force over speed on every field, free runs, margins, and what a chain says from rest."""

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.models.fields import travelling_wavenumber
from verify.models.underfoot import standing_at
from verify.motor.case import MotorCase
from verify.motor.figures import (
    FEWER,
    AtSpeed,
    Timed,
    comes_to_speed,
    crest_speed,
    held,
    mean_speed,
    next_seconds,
    no_load,
    phase_portrait,
    reversed_way,
    started,
    started_of,
    stopped,
)
from verify.motor.result import MotorMargins, MotorRun, uninterrupted
from verify.patience import check_work
from verify.studies.chart import Chart
from verify.studies.charting import thinned
from verify.studies.kind import Progress
from verify.studies.motor.from_rest import FromRest, rest_runs
from verify.studies.motor.request import FREE_RUNS, case_of
from verify.studies.motor.words import doubts, facts_of, in_short_of
from verify.studies.told import Found, Table

if TYPE_CHECKING:
    from verify.motion.contact import Coupling
    from verify.scenes.scene import Scene
    from verify.studies.motor.request import Motor

HELD_PERIODS = 11_520
"""At most, at each held speed, until its means settle."""
SEARCHED = 24
"""Held speeds at most on the way to the one without force: both ends, rest, halvings to a millionth of the reach."""
LAST = 0.25
"""Of a free run, at its end: of which means are taken."""
PORTRAIT = (40, 12)
"""Periods, and samples in each, of the foot's motion across."""
CONSTANTS = 8.0
"""Of time: what charts show of starting, stopping and turning round."""
FRAMES = 36
PLACES = 73
"""Of the surface in the picture."""


class History(msgspec.Struct, frozen=True, kw_only=True):
    """One thing over time, or over another."""

    x: tuple[float, ...]
    y: tuple[float, ...]


class Shooting(msgspec.Struct, frozen=True, kw_only=True):
    """The motion across that repeats itself, found by Newton's method, of a slider that stands still."""

    force: float
    """Newton along +x."""
    return_error: float
    """How far its state is off after a period, over its own size."""
    largest_multiplier: float
    """Of a small departure after a period: below 1 it dies away."""


class FreeRun(msgspec.Struct, frozen=True, kw_only=True):
    """A slider that runs as it will, from its own speed."""

    speed: float
    """Mean over the last quarter, m/s."""
    spread: float
    """By how much the two halves of that quarter differ, m/s."""
    settled: bool
    """Whether that is little of the crests' speed, and the quarter carries what presses the slider on."""
    contact_share: float
    """Of points and time that touch, in that quarter."""
    stuck_share: float
    wear_power: float
    """Lost in friction, and put into what gives way along the surface, W."""
    damped_power: float
    """Lost in the contact's dashpots or landings, mean over all of the run, W."""
    seconds: float
    run_ms_per_ms: float
    """Run time over simulated time."""
    stopped: str
    """'end', or why it ended before."""

    @property
    def goes(self) -> bool:
        """Whether it comes to a speed that is more than its scatter: else it has no way, and no time to get there."""
        return self.settled and abs(self.speed) > self.spread


class FieldFound(msgspec.Struct, frozen=True, kw_only=True):
    """The motor on one field."""

    model: str
    count: int | None
    crest_speed: float
    """First-order speed amplitude of the surface at the slider, m/s."""
    curve: tuple[AtSpeed, ...]
    """At the speeds that are asked for, the first standing still."""
    no_load: AtSpeed | None
    """None where no speed is without force."""
    free: FreeRun
    start_time: float | None
    """Seconds until 1 - 1/e of the free speed; None where it is not reached."""
    stop_time: float | None
    """Seconds until 1/e of it is left once the drive is cut; None where it is not, or where the beam would ring on."""
    reversal_time: float | None
    """Seconds until 1 - 1/e of the way to the opposite speed, phases turned round."""
    shooting: Shooting | None
    """None where no motion repeats itself, or where the beam feels the slider."""
    margins: MotorMargins
    coupling: "Coupling"
    amplitude: float
    """Of the surface across at the slider, metres."""

    @property
    def title(self) -> str:
        """'49 segments', 'exact beam'."""
        name = MODELS[self.model].title
        return name if self.count is None else f"{self.count} {name}"

    @property
    def stall(self) -> AtSpeed:
        """Held still."""
        return self.curve[0]

    @property
    def most_power(self) -> float | None:
        """Of the speeds of the curve whose force has settled, W; None of none, and where it pushes at none of them."""
        return max((one.power for one in self.curve if one.settled("force") and one.power > 0.0), default=None)

    @property
    def best_efficiency(self) -> float | None:
        """Of those whose powers have settled too; None where the slider drives the surface at all of them."""
        return max((e for one in self.curve if one.settled("force", "powers") and (e := one.efficiency)), default=None)


class Drawn(msgspec.Struct, frozen=True, kw_only=True, eq=False):
    """What charts show beside the figures: histories by name, the period of the moving picture."""

    histories: dict[str, dict[str, History]]
    """By what is shown and by field."""
    period: MotorRun | None
    """The slider at its no-load speed over one period, kept at its place; None where there is none."""
    title: str
    """Of the field of that."""


class MotorFound(Found, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a motor."""

    fields: tuple[FieldFound, ...]
    rest: FromRest | None
    """None where no chain was asked for."""
    doubts: tuple[str, ...]
    """A sentence for every margin that is not small."""
    hard: bool
    """Whether the contact is."""
    mu: float
    drawn: Drawn
    n_motions: int

    def in_short(self) -> str:
        """Speed without load and force standing still, on the first field."""
        return in_short_of(self)

    def facts(self) -> tuple[str, ...]:
        """What was found, how far it can be believed, what it costs."""
        return facts_of(self)

    def tables(self) -> tuple[Table, ...]:
        """The motor on every field, force over speed, margins, from rest."""
        from verify.studies.motor.tables import motor_tables

        return motor_tables(self)

    def charts(self) -> tuple[Chart, ...]:
        """The contact line, force and power over speed, portrait, shares, starting and stopping."""
        from verify.studies.motor.charts import motor_charts

        return motor_charts(self)

    def plain(self) -> Any:
        """Figures of every field, those from rest, doubts."""
        from verify.studies.motor.tables import field_as_plain, rest_as_plain

        rest = rest_as_plain(self.rest) if self.rest else None
        return {"fields": [field_as_plain(one) for one in self.fields], "rest": rest, "doubts": list(self.doubts)}

    def motions(self) -> int:
        """All of them."""
        return self.n_motions


def motor_study(scene: "Scene", asked: "Motor", progress: Progress = lambda step: None) -> MotorFound:
    """Run the scene's motor on every field that is asked for. Raises InputError."""
    names = ("start", "stop", "reversal", "contact", "stuck", "portrait")
    fields, histories = [], {name: dict[str, History]() for name in names}
    speeds: tuple[float, ...] = ()
    for number, model in enumerate(asked.linear):
        case = case_of(asked, scene, model)
        progress(f"held speeds on {model}")
        still, settled = held(case, 0.0, periods=HELD_PERIODS)
        check_felt(asked, still, settled, len(asked.linear) - number)
        speeds = speeds or _speeds(case, still, asked.speeds)
        curve = (still, *(held(case, speed, settled, HELD_PERIODS)[0] for speed in speeds[1:]))
        free_of_load = _no_load(case, settled)
        progress(f"free runs on {model}")
        found, kept = _field(case, asked, curve, free_of_load)
        fields.append(found)
        for name, one in kept.items():
            histories[name][model] = one
    first = fields[0]
    rest = rest_runs(scene, asked, -1.0 if first.stall.force < 0.0 else 1.0, progress)
    progress("the picture of one period")
    assert scene.slider is not None
    return MotorFound(
        fields=tuple(fields),
        rest=rest,
        doubts=doubts(fields, scene.slider, _wavenumber(case), 2.0 * under(case).surface_distance),
        hard=scene.slider.contact is not None and scene.slider.contact.hard,
        mu=scene.slider.mu,
        drawn=Drawn(histories=histories, period=_picture(case_of(asked, scene, first.model), first), title=first.title),
        n_motions=len(fields) * (asked.speeds + 4) + (rest.n_runs if rest else 0) + 1,
    )


def check_felt(asked: "Motor", still: AtSpeed, settled: MotorRun, n_fields: int) -> None:
    """Raise InputError where the beam feels the motor and fields as this one would take too long.

    Each held speed as long as standing still, `settled`, took to settle, and the runs that are free. Estimated from
    above of a step that the beam feels; one that it does not feel takes a hundredth of that.
    """
    assert settled.coupling is not None
    if not settled.coupling.two_way:
        return
    free = asked.periods * (FREE_RUNS if asked.start == "steady" else 1) + PORTRAIT[0]
    periods = still.periods * (asked.speeds - 1 + SEARCHED) + free
    remedy = f"lower it or motor.speeds, or {FEWER}"
    check_work("motor.periods", asked.periods, n_fields * next_seconds(settled, periods), remedy)


def _wavenumber(case: MotorCase) -> float | None:
    """Of a wave on the section under the slider, without losses, 1/m; None where none travels."""
    return travelling_wavenumber(under(case), case.frequency_hz)


def under(case: MotorCase) -> Beam:
    """A beam of the section on which the slider is put."""
    return standing_at(case.beam, case.slider.start_on(case.beam))


def _speeds(case: MotorCase, still: AtSpeed, number: int) -> tuple[float, ...]:
    """From standing still to the speed of the crests, the way that friction pushes; of the first field, for all."""
    way = -1.0 if still.force < 0.0 else 1.0
    return tuple(way * crest_speed(case) * k / (number - 1) for k in range(number))


def _no_load(case: MotorCase, settled: MotorRun) -> AtSpeed | None:
    try:
        return no_load(case, None, settled, HELD_PERIODS)
    except InputError:
        return None


def _field(
    case: MotorCase, asked: "Motor", curve: tuple[AtSpeed, ...], free_of_load: AtSpeed | None
) -> tuple[FieldFound, dict[str, History]]:
    """A field's figures with its free runs, and what charts show of them."""
    begun = replace(case, start=asked.start, soft_start_periods=asked.soft_start_periods)
    target = free_of_load.speed if free_of_load else 0.0
    under_way = started(begun, target, asked.periods)
    crests = crest_speed(case)
    free, run = _free(under_way, crests), under_way.run
    assert run.coupling is not None
    one_way = not run.coupling.two_way
    whole = free.stopped == "end"
    cut_off = stopped(case, run, asked.periods) if one_way and whole and asked.start == "steady" else None
    turned = reversed_way(case, run, -free.speed, asked.periods) if whole and asked.start == "steady" else None
    found = FieldFound(
        model=case.model,
        count=case.count,
        crest_speed=crests,
        curve=curve,
        no_load=free_of_load,
        free=free,
        start_time=started_of(run, free.speed),
        stop_time=cut_off.time if cut_off else None,
        reversal_time=turned.time if turned else None,
        shooting=_shooting(case, one_way),
        margins=run.motor_margins,
        coupling=run.coupling,
        amplitude=float(abs(case.field().deflection([case.slider.start_on(case.beam)])[0])),
    )
    return found, _histories(begun, under_way, cut_off, turned)


def _free(under_way: Timed, crests: float) -> FreeRun:
    run = under_way.run
    if len(run.times) < 3:
        raise InputError(f"motor.start: the free run {run.statistics.stopped} within two periods, give smaller forces")
    last = max(int(LAST * (len(run.times) - 1)) // 2 * 2, 2)
    speed, spread = mean_speed(run, last)
    seconds = float(run.times[-1] - run.times[-1 - last])
    return FreeRun(
        speed=speed,
        spread=spread,
        settled=comes_to_speed(run, last, crests),
        contact_share=float(run.contact_share[-last:].mean()),
        stuck_share=float(run.stuck_share[-last:].mean()),
        wear_power=float(run.rubbed[-last:].sum()) / seconds,
        damped_power=(run.ledger.damped + run.ledger.impacts) / run.duration,
        seconds=run.duration,
        run_ms_per_ms=run.statistics.wall_s / run.duration,
        stopped=run.statistics.stopped,
    )


def _shooting(case: MotorCase, one_way: bool) -> Shooting | None:
    """Standing still; None where there is none."""
    from verify.motor.shooting import periodic

    if not one_way:
        return None
    slider = replace(case.slider, coupling="one-way")
    try:
        found = periodic(case.on(slider), 0.0)
    except (InputError, np.linalg.LinAlgError):
        return None
    return Shooting(
        force=float(found.run.friction[1:].mean()),
        return_error=found.missed,
        largest_multiplier=float(np.abs(found.multipliers).max()),
    )


def _histories(case: MotorCase, under_way: Timed, cut_off: Timed | None, turned: Timed | None) -> dict[str, History]:
    """What charts show of free runs: as much as is still under way."""
    run = under_way.run
    n = _still_moving(under_way)
    kept = {
        "start": _history(run.times[:n], run.speed[:n]),
        "contact": _history(run.times[1:n], run.contact_share[1:n]),
        "stuck": _history(run.times[1:n], run.stuck_share[1:n]),
    }
    for name, one in (("stop", cut_off), ("reversal", turned)):
        if one is not None:
            m = _still_moving(one)
            kept[name] = _history(one.run.times[:m] - one.run.times[0], one.run.speed[:m])
    if run.statistics.finished:
        periods, samples = PORTRAIT
        fine = uninterrupted(case.run(periods * case.period, samples=periods * samples + 1, continue_from=run))
        height, rate = phase_portrait(fine)
        kept["portrait"] = History(x=tuple(map(float, height - height.mean())), y=tuple(map(float, rate)))
    return kept


def _still_moving(one: Timed) -> int:
    """Samples until some time constants have passed; all where there is none."""
    times = one.run.times - one.run.times[0]
    return len(times) if one.time is None else max(int(np.searchsorted(times, CONSTANTS * one.time)), 3)


def _history(times: Any, values: Any) -> History:
    return History(x=tuple(thinned(times, 300)), y=tuple(thinned(values, 300)))


def _picture(case: MotorCase, field: FieldFound) -> MotorRun | None:
    """One period at the no-load speed, settled before, with the surface under the feet and beside them."""
    slider, beam = case.slider, case.beam
    x = slider.start_on(beam)
    ends = [x + foot.offset + 0.75 * side * foot.length for foot in slider.feet for side in (-1.0, 1.0)]
    span = max(max(ends) - min(ends), 0.25 * beam.length / 10.0)
    middle = 0.5 * (max(ends) + min(ends))
    places = np.clip(np.linspace(middle - 0.5 * span, middle + 0.5 * span, PLACES), 0.0, beam.length)
    speed = field.no_load.speed if field.no_load else 0.0
    settled = held(case, speed, periods=HELD_PERIODS)[1]
    return uninterrupted(
        case.run(
            case.period, held_speed=speed, frozen=True, at=places.tolist(), samples=FRAMES + 1, continue_from=settled
        )
    )
