"""The motor of a scene: force over speed, no load, start, stop and reversal, on every model."""

from dataclasses import dataclass
from math import copysign, inf
from typing import Annotated, Any

import numpy as np
from msgspec import Meta
from msgspec.structs import replace

from verify.analysis.margins import marked, sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, verdict_of, void
from verify.dynamics.contact_assembly import check_sliders
from verify.errors import InputError
from verify.formatting import unit_of, with_error, with_unit
from verify.linear.registry import MODELS
from verify.motor import curves
from verify.motor.steady_state import PERIODS, MotorCase, SteadyState, seconds_per_period, steady_state, surface_motion
from verify.quantities.motor import MotorOptions
from verify.quantities.options import ModelName
from verify.report.result import Column, Figure, Result, Table
from verify.settings import Start
from verify.studies.base import Progress, Scene, Study
from verify.studies.charts import Columns, Line, line_chart, model_style, percent, si, sized_title, table
from verify.studies.motion import Damping, check_driven, check_start, readings
from verify.studies.tables import path_margins, reduction_margins, scene_margins

SEARCH = 8  # steady states of the search for the no-load speed, most of them near the root
LEAST = 96  # drive periods of the shortest steady state, and of the shortest free run
TIME_CONSTANTS = 8.0  # shown of starting, stopping and reversing
SPEED = ("speed", "m/s")
AT_SPEED = "Mean friction force along +x on the slider at a prescribed speed and fixed position. Dashed: mu N."
POWERED = "Force times speed; below zero the load drives the motor."
IN_TIME = (
    "Means over a sliding period of the drive: free run from the slider's own speed (solid), drive switched off "
    "(dotted), drive phases reversed (dashed). The beam's own transient is neglected."
)
NOTES = (
    "Speeds are along +x. Crest speed: amplitude of the tangential surface velocity at the slider, with the sign at a "
    "crest, negative for a wave towards +x. No-load speed: prescribed, with zero mean force, of a heavy slider. Free "
    "speed: mean of a slider of its own mass over the last quarter of a free run, not given where it has not "
    "converged; its error includes the change from the two quarters before.",
    "Largest power and best efficiency: over the prescribed speeds. Friction and dashpot power: of the free run.",
    "Fractions: last quarter of the free run. Start, stop, reversal: 1 - 1/e of the change of the mean over a sliding "
    "period, where this mean converges without an overshoot of 5 % in a drive period or more.",
)


@dataclass(eq=False)
class Allowance:
    """Drive periods for the figures of one model."""

    per_period: float  # Processor time, s
    left: float
    """Of the steady states to come, whose number is `figures`; `free` are those of each of up to three free runs."""
    figures: int
    free: int

    @property
    def most(self) -> int:
        """Most periods of the next steady state."""
        return int(min(PERIODS, max(self.left / max(self.figures, 1), LEAST)))

    def text(self) -> str:
        """The most time that is left: 'at most 40 s left'."""
        seconds = self.per_period * (self.most * self.figures + 3 * self.free)
        return f"at most {seconds:.2g} s left" if seconds < 99.5 else f"at most {seconds / 60.0:.0f} min left"


@dataclass(frozen=True, eq=False)
class Field:
    """One model under the slider, SI; `stop` is None where the beam would ring on; `times` of approaches."""

    case: MotorCase
    name: str
    curve: list[SteadyState]  # from standstill to the crest speed, in the direction of the force
    no_load: float | None
    free: curves.Transient
    stop: curves.Transient | None
    reversal: curves.Transient | None
    times: dict[str, curves.TimeConstant]
    missing: list[str]  # why figures are not available, in words
    longer: str  # the remedy where `seconds` limits the means, else empty


class Motor(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A slider that may leave the beam: at prescribed speeds, free, started, stopped and reversed."""

    name, title, accepts = "motor", "The motor", ("drive.shunt",)
    reads = ("drive", "slider", "motion")

    models: Annotated[tuple[str, ...], Meta(min_length=1, description="Models.")] = ("analytic", "segment", "fem")
    count: Annotated[int, Meta(ge=2, le=250, description="Segments and elements; by default within 1 %.")] | None = None
    speeds: Annotated[int, Meta(ge=2, le=201, description="Points of the force-speed curve.")] = 9
    periods: Annotated[int, Meta(ge=20, le=100_000, description="Periods of a free run, at most of stopping.")] = 2000
    start: Annotated[Start, Meta(description="Beam at the start of the free run: steady or at rest.")] = "steady"
    soft_start_periods: Annotated[float, Meta(ge=0, description="Periods over which forces from rest grow.")] = 0.0
    modal_damping: Damping | None = None
    steps_per_period: Annotated[int, Meta(ge=16, le=4096, description="Steps in a period, at least.")] = 61
    seconds: Annotated[float, Meta(gt=0, description="Processor time for all of it; then means with errors.")] = 120.0

    def __post_init__(self) -> None:
        for model in self.models:
            ModelName("time_basis").check(model, "motor.models")
        check_start("motor", self.start, self.soft_start_periods)

    @property
    def steps(self) -> int:
        """Time per period, points of force over speed, no-load speed and free run on every model."""
        return len(self.models) * (self.speeds + 3)

    def check(self, scene: Scene) -> None:
        """Raise InputError without forces or a slider with contact, or where a foot is not on the beam."""
        check_driven("motor", scene)
        if scene.slider is None or scene.slider.contact is None:
            raise InputError("motor: its slider may leave the beam, add [slider] with slider.contact")
        check_sliders(scene.beam, (scene.slider,), (scene.slider.initial_position(scene.beam),))

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Run the motor on every model. Raises InputError."""
        n = self.count or sufficient_count(cache, frequency_hz=scene.drive.frequency_hz if scene.drive else None)
        fields, number = list[Field](), iter(range(1, self.steps + 1))
        settings: dict[str, Any] = {name: getattr(self, name) for name in ("modal_damping", "steps_per_period")}

        def step(what: str) -> None:
            progress(f"{next(number)} of {self.steps}: {what}")

        for model in self.models:
            case = MotorOptions(model=model, count=n if MODELS[model].sized else None, **settings).case(scene)
            fields.append(self._field(case, fields[0].curve if fields else [], cache, step))
        first, still, margins = fields[0], fields[0].curve[0], _margins(fields, scene, cache)
        margins += path_margins(first.case.model, first.case.count, scene, cache) + reduction_margins(scene)
        valid = verdict_of(margins).level != "not trusted"
        summary = _with_error("Free speed", first.free.speed, first.free.error, "m/s")
        summary += ", " + _with_error("stall force", still.means.force, still.errors.force, "N")
        return Result(
            summary=f"{summary} ({first.name})." if valid else "",
            tables=[*_tables(fields), *([readings(scene)] if scene.motion and first.case.beam == scene.beam else [])],
            figures=_figures(fields, margins),
            warnings=[f"{field.name}: {text}." for field in fields for text in field.missing],
            margins=margins,
        )

    def _allowance(self, case: MotorCase, name: str) -> Allowance:
        """The share of one model in `seconds`, by the measured time of a period. Raises InputError below the least."""
        cost, figures, share = seconds_per_period(case), self.speeds + SEARCH, self.seconds / len(self.models)
        if share < (needed := cost * (figures * LEAST + self.periods)):
            why = f"{name} takes {1e3 * cost:.2g} ms for a drive period and the motor at least"
            remedy = f"{needed * len(self.models):.2g} s, raise it, or lower motor.speeds or motor.periods"
            raise InputError(f"motor.seconds = {self.seconds:g}: {why} {remedy}")
        return Allowance(cost, share / cost - 3 * self.periods, figures, self.periods)

    def _field(self, case: MotorCase, like: list[SteadyState], cache: SolutionCache, progress: Progress) -> Field:
        """Prescribed speeds, free run, stop and reversal on one model. Raises InputError."""
        name = sized_title(case.model, case.count)
        progress(f"time per period, {name}")
        allowed = self._allowance(case, name)

        def step(what: str) -> None:
            progress(f"{what}, {name}, {allowed.text()}")

        step("stall force")
        still: SteadyState = cache.call(steady_state, case, 0.0, allowed.most)
        crest = copysign(surface_motion(case)[1], still.means.force)
        speeds = [at.speed for at in like] or [crest * k / (self.speeds - 1) for k in range(self.speeds)]
        curve = [still]
        for speed in speeds[1:]:
            allowed.left, allowed.figures = allowed.left - curve[-1].periods, allowed.figures - 1
            step(f"force at {with_unit(speed, 'm/s', '+.4g')}")
            curve.append(steady_state(case, speed, allowed.most, still.run))
        longer = "raise motor.seconds" if allowed.most < PERIODS else ""
        missing, unloaded, allowed.figures = _unsettled(curve, longer), None, SEARCH
        step("no-load speed")
        try:
            unloaded = curves.no_load(case, allowed.most, curve).speed
        except InputError as error:
            missing.append(f"no no-load speed, {error}")
        allowed.figures = 0
        step("free run")
        begun = replace(case, start=self.start, soft_start_periods=self.soft_start_periods)
        free, stop, reversal = cache.call(curves.transient, begun, self.periods), None, None
        rings = case.slider.coupling == "two-way"
        begin = free.time_constant()
        if free.run.statistics.finished and self.start == "steady":
            scale = inf if begin.missing or not free.converged else begin.time / case.period
            periods = int(min(2.0 * TIME_CONSTANTS * scale + 2.0, self.periods))
            stop = None if rings else curves.stop(case, free, periods)
            reversal = curves.reversal(case, free, periods)
        times: dict[str, curves.TimeConstant] = {}
        if free.converged or begin.missing == "overshoot":
            times["start"] = begin
        if free.converged and stop:
            times["stop"] = stop.time_constant(0.0)
        if free.converged and reversal:
            times["reversal"] = reversal.time_constant()
            if not reversal.converged:
                times["reversal"] = replace(times["reversal"], missing="start")
        reasons = [key if at.missing == "start" else at.missing for key, at in times.items() if at.missing]
        missing += [curves.REASONS[key] for key in dict.fromkeys([*reasons, *["ringing"] * rings])]
        return Field(case, name, curve, unloaded, free, stop, reversal, times, missing, longer)


def _with_error(name: str, value: float, error: float, symbol: str) -> str:
    """'Free speed -26.68 ± 0.02 mm/s', to the digits that hold, with a remark where the value lies within its error."""
    unit = unit_of(max(abs(value), error), symbol)
    text = f"{name} {with_error(unit.factor * value, unit.factor * error, '+')} {unit.name}"
    return text if abs(value) > error else f"{text} (not distinguishable from zero)"


def _unsettled(curve: list[SteadyState], longer: str) -> list[str]:
    """A warning on means that have not converged; none where all have."""
    off = [at for at in curve if not at.converged()]
    figures = ", ".join(dict.fromkeys(figure for at in off for figure in at.not_converged))
    at = f"at {len(off)} of {len(curve)} speeds after {max(at.periods for at in curve)} drive periods"
    so_far = "the tables give means so far, which hold while the motion keeps its kind"
    return [", ".join(filter(None, (f"{figures} not converged {at}", so_far, longer)))] * bool(off)


def _convergence(field: Field) -> list[Margin]:
    """Margins of a free run and of a stall force that have not converged, with the means so far."""
    found, free, still = list[Margin](), field.free, field.curve[0]
    if not free.converged and free.run.statistics.finished:
        so_far = f"mean so far {with_error(1e3 * free.speed, 1e3 * free.error, '+')} mm/s, {field.name}"
        found.append(void("the free run", f"{curves.REASONS['free speed']} ({so_far})"))
    if not still.converged("force"):
        so_far = f"{with_error(still.means.force, still.errors.force, '+')} N"
        found.append(
            Margin(
                name=f"interval of the stall force {so_far}",
                size=still.errors.force / (abs(still.means.force) or still.errors.force),
                where=f"after {still.periods} drive periods ({field.name})",
                condition=f"the stall force may be its mean so far, {so_far}",
                remedy=field.longer or "a motion of one kind has a closer mean: change slider.preload or frequency_hz",
                harm="discretisation",
            )
        )
    return found


def _margins(fields: list[Field], scene: Scene, cache: SolutionCache) -> list[Margin]:
    """Margins of the scene at the drive, free runs, and figures that have not converged."""
    case = fields[0].case
    sizes = [(field.case.model, field.case.count) for field in fields]
    runs, wave = [(field.name, field.free.run) for field in fields], surface_motion(case)[0]
    at: dict[str, Any] = {"frequency_hz": case.frequency_hz, "amplitude": wave}
    margins = scene_margins(scene, cache, sizes, slider=case.slider, runs=runs, **at)
    margins += [margin for field in fields for margin in _convergence(field)]
    if case.slider.coupling == "two-way" and not (case.modal_damping or case.beam.loss_factor):
        free = "free vibrations of the beam, which decay by contact alone, may be left out"
        margins.append(Margin(name="undamped beam", size=0.0, fine=-1.0, is_error=False, condition=free))
    return margins


def _tables(fields: list[Field]) -> list[Table]:
    def last(field: Field, share: str) -> float:
        return float(getattr(field.free.run, share)[-field.free.last :].mean())

    def time(field: Field, key: str, figure: str = "time") -> float | None:
        return getattr(field.times[key], figure) if key in field.times and not field.times[key].missing else None

    def power(field: Field, loss: str) -> float:
        return float(getattr(field.free.run.energy, loss)) / field.free.run.duration

    model: dict[Column, Any] = {Column("model"): lambda field: field.name}
    speed = model | {
        si("amplitude", "m"): lambda field: surface_motion(field.case)[0],
        si("crest speed", "m/s", "+.5g"): lambda field: surface_motion(field.case)[1],
        si("no-load speed", "m/s", "+.5g"): lambda field: field.no_load,
        si("free speed", "m/s", "+.5g"): lambda field: field.free.speed if field.free.converged else None,
        si("its error", "m/s", ".3g"): lambda field: field.free.error,
        si("stall force", "N", "+.4g"): lambda field: field.curve[0].means.force,
        si("error of the force", "N", ".2g"): lambda field: field.curve[0].errors.force,
    }
    powers = model | {
        si("largest power", "W"): lambda field: max(_if(at, at.power) or 0.0 for at in field.curve) or None,
        percent("best efficiency", ".3g"): lambda field: (
            max(_if(at, at.efficiency, "powers") or 0.0 for at in field.curve) or None
        ),
        si("friction power", "W"): lambda field: power(field, "friction_loss"),
        si("dashpot power", "W"): lambda field: power(field, "contact_loss"),
    }
    times = model | {
        percent("contact fraction", ".3g"): lambda field: last(field, "contact_fraction"),
        percent("stick fraction", ".3g"): lambda field: last(field, "stick_fraction"),
        si("start", "s", ".3g"): lambda field: time(field, "start"),
        si("its error", "s", ".1g"): lambda field: time(field, "start", "error"),
        si("stop", "s", ".3g"): lambda field: time(field, "stop"),
        si("reversal", "s", ".3g"): lambda field: time(field, "reversal"),
    }
    curve: Columns = {
        Column("model"): lambda row: row[0],
        si("speed", "m/s", "+.4g"): lambda row: row[1].speed,
        si("force", "N", "+.4g"): lambda row: row[1].means.force,
        si("its error", "N", ".3g"): lambda row: row[1].errors.force,
        si("power", "W", "+.4g"): lambda row: _if(row[1], row[1].power),
        percent("efficiency", ".3g"): lambda row: _if(row[1], row[1].efficiency, "powers"),
        percent("contact fraction", ".3g"): lambda row: row[1].means.contact_fraction,
        percent("stick fraction", ".3g"): lambda row: row[1].means.stick_fraction,
        Column("converged"): lambda row: row[1].converged(),
    }
    rows = [(field.name, at) for field in fields for at in field.curve]
    forces = table("Force at prescribed speeds, slider at a fixed position", rows, curve)
    titles = "Speeds and stall force", "Power and efficiency", "Contact and time constants"
    return [*map(table, titles, (fields,) * 3, (speed, powers, times), NOTES), forces]


def _if(at: SteadyState, value: float | None, *figures: Any) -> float | None:
    """A value of a steady state whose force, and these figures, have converged."""
    return value if at.converged("force", *figures) else None


def _figures(fields: list[Field], margins: list[Margin]) -> list[Figure]:
    forces, powers, speeds = list[Line](), list[Line](), list[Line]()
    for field in sorted(fields, key=lambda field: field.case.count or 0):
        style = model_style(field.case.model)
        states = [at for at in field.curve if at.converged("force")]
        v = np.array([at.speed for at in states])
        forces.append((field.name, v, np.array([at.means.force for at in states]), style))
        powers.append((field.name, v, np.array([at.power for at in states]), style))
        shown = TIME_CONSTANTS * max((at.time for at in field.times.values() if not at.missing), default=np.inf)
        for run, dash in ((field.free, ""), (field.stop, ":"), (field.reversal, "--")):
            if run is not None:
                n = max(int(np.searchsorted(run.times, shown)), 3)
                drawn = style | {"linestyle": dash, "linewidth": 1.4} if dash else style
                speeds.append(("" if dash else field.name, run.times[:n], run.speeds[:n], drawn))
    still, ends = fields[0].curve[0].means, np.array([0.0, fields[0].curve[-1].speed])
    limit = np.copysign(fields[0].case.slider.mu * still.normal_force, still.force)
    forces.append(("mu N", ends, np.array([limit, limit]), {"color": "#7d8590", "linestyle": "--"}))
    force, power, time = (marked(t, margins) for t in ("Force over speed", "Power over speed", "Start, stop, reversal"))
    return [
        line_chart("motor-force", force, AT_SPEED, forces, SPEED, ("force", "N")),
        line_chart("motor-power", power, POWERED, powers, SPEED, ("power", "W")),
        line_chart("motor-speed", time, IN_TIME, speeds, ("time", "s"), SPEED),
    ]
