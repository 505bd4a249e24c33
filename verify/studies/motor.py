"""The motor of a scene: force over speed, no load, starting, stopping and reversing on every model."""

from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from msgspec import Meta
from msgspec.structs import replace

from verify.errors import InputError
from verify.options import Start
from verify.studies.base import Progress, Study
from verify.studies.charts import model_style, percent, plot_lines, si, sized_title
from verify.validation import Relative

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Timed
    from verify.motor.result import MotorRun
    from verify.report.result import Figure, Result, Table
    from verify.scene.model import Scene

HELD_PERIODS = 11_520
"""Periods after which the means at a held speed count as not converged."""
LAST = 0.25
"""Fraction of a free run, at its end, over which means are formed."""
TIME_CONSTANTS = 8.0
"""Shown of starting, stopping and reversing."""
LARGE = 0.1
"""Size of a neglected effect beyond which a summary is omitted."""
WARNINGS = {
    "means": "{}: means at {} of {} held speeds are not converged after {} periods, values derived from them are "
    "omitted; more slider.contact.damping or slider.preload calms the motion.",
    "free": "{}: the free run has no steady end, the halves of its last quarter differ by {:.2g} cm/s; raise "
    "motor.periods.",
    "coupling": "Coupling: contact changes the surface motion by {:.1%}, which one-way coupling neglects.",
    "sag": "Sag: the preload bends the beam by {:.2g} amplitudes of the wave, which one-way coupling neglects.",
    "axial": "Nonlinearity: linear models neglect an axial inertia (kL)² ⟨θ²⟩ = {:.2g} of a chain of rigid links.",
    "epsilon": "Compliance: epsilon = {:.3g}, points deflect along the surface before they slip.",
    "step": "Time step: the period of the contact's oscillation has an error of {:.1e}; raise motor.steps_per_period.",
}
CAPTIONS = {
    "motor-force": "Mean friction force along +x on the slider, held at each speed and at its place. Dashed: mu N.",
    "motor-power": "Force times speed; below zero the load drives the motor.",
    "motor-speed": "Free run from the slider's own speed (solid), drive switched off (dotted), drive phases reversed "
    "(dashed). The beam's own transient is neglected.",
}


@dataclass(frozen=True, eq=False)
class Field:
    """One model under the slider."""

    case: "MotorCase"
    name: str
    crest_speed: float
    """First-order speed amplitude of the surface at the slider, m/s."""
    curve: "list[AtSpeed]"
    """From standstill to the crest speed, in the direction of the force."""
    no_load: "AtSpeed | None"
    """None where no held speed is without force."""
    free: "MotorRun"
    speed: float
    """Mean over the last quarter of the free run, m/s."""
    spread: float
    """Difference of the means of the halves of that quarter, m/s."""
    converged: bool
    """Whether the free run ends at a steady speed."""
    stop: "Timed | None"
    """Drive switched off; None where the beam would ring on."""
    reversal: "Timed | None"
    """Drive phases reversed."""
    amplitude: float
    """Of the surface under the slider, m."""
    last: int
    """Samples of the last quarter of the free run, an even number."""


class Motor(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A slider that may leave the beam: held at speeds, free, started, stopped and reversed."""

    name: ClassVar[str] = "motor"
    title: ClassVar[str] = "The motor"

    models: Annotated[tuple[str, ...], Meta(min_length=1, description="Models.")] = ("analytic", "segment", "fem")
    count: Annotated[int, Meta(ge=2, le=250, description="Segments and elements.")] = 49
    speeds: Annotated[int, Meta(ge=2, le=201, description="Points of the force-speed curve.")] = 9
    periods: Annotated[int, Meta(ge=20, le=100_000, description="Periods of a free run, at most of stopping.")] = 2000
    start: Annotated[Start, Meta(description="Beam at the start of the free run: steady or at rest.")] = "steady"
    soft_start_periods: Annotated[float, Meta(ge=0, description="Periods over which forces from rest grow.")] = 0.0
    modal_damping: Annotated[
        Relative | None, Meta(description="Damping ratio of every mode; from the beam's loss factor unless set.")
    ] = None
    steps_per_period: Annotated[int, Meta(ge=16, le=4096, description="Steps in a period, at least.")] = 61

    def __post_init__(self) -> None:
        from verify.quantities.options import ModelName

        for model in self.models:
            ModelName("time_basis").check(model, "motor.models")
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motor.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )

    def check(self, scene: "Scene") -> None:
        """Raise InputError without forces or a slider with contact, and for what does not combine."""
        from verify.motor.combine import check_combines
        from verify.motor.feet import check_on_beam

        if not scene.forces or scene.drive is None or scene.drive.kind != "force":
            raise InputError("motor: the beam moves under a [drive] of kind force, add its forces")
        if scene.slider is None or scene.slider.contact is None:
            raise InputError("motor: its slider may leave the beam, add [slider] with slider.contact")
        for model in self.models:
            for start in ("steady", self.start):
                check_combines(model, start, scene.slider)
        check_on_beam(scene.slider, scene.beam, scene.slider.start_on(scene.beam))

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Run the motor on every model. Raises InputError."""
        from verify.linear.registry import MODELS
        from verify.quantities.motor import MotorOptions
        from verify.report.result import Result

        fields: list[Field] = []
        for model in self.models:
            speeds = [at.speed for at in fields[0].curve] if fields else []
            count = self.count if MODELS[model].sized else None
            options = MotorOptions(
                model=model, count=count, modal_damping=self.modal_damping, steps_per_period=self.steps_per_period
            )
            fields.append(self._field(options.case(scene), speeds, progress))
        warnings, valid = _warnings(fields)
        first = fields[0]
        speed, force = 100 * first.speed, first.curve[0].force
        return Result(
            summary=f"Without load {speed:+.4g} cm/s, stall force {force:+.4g} N ({first.name})." if valid else "",
            tables=_tables(fields),
            figures=_figures(fields),
            warnings=warnings,
            data={
                "curves": {field.name: field.curve for field in fields},
                "margins": {field.name: field.free.motor_margins for field in fields},
            },
        )

    def _field(self, case: "MotorCase", speeds: list[float], progress: Progress) -> Field:
        """Held speeds, free run, stopping and reversing on one model. Raises InputError."""
        from verify.motor import figures as motor

        name = sized_title(case.model, case.count)
        progress(f"force over speed, {name}")
        crests = motor.crest_speed(case)
        still, settled = motor.held(case, 0.0, periods=HELD_PERIODS)
        way = -1.0 if still.force < 0.0 else 1.0
        speeds = speeds or [way * crests * k / (self.speeds - 1) for k in range(self.speeds)]
        curve = [still, *(motor.held(case, speed, settled, HELD_PERIODS)[0] for speed in speeds[1:])]
        unloaded = None
        with suppress(InputError):  # no held speed is without force
            unloaded = motor.no_load(case, None, settled, HELD_PERIODS)
        target = unloaded.speed if unloaded else 0.0
        progress(f"free run, {name}")
        begun = replace(case, start=self.start, soft_start_periods=self.soft_start_periods)
        run = motor.started(begun, target, self.periods).run
        if len(run.times) < 3:
            raise InputError(f"motor.start: the slider {run.statistics.stopped} at once, give smaller forces")
        last = max(int(LAST * (len(run.times) - 1)) // 2 * 2, 2)
        speed, spread = motor.mean_speed(run, last)
        goes_on = run.statistics.finished and self.start == "steady"
        two_way = run.coupling is not None and run.coupling.two_way
        return Field(
            case=case,
            name=name,
            crest_speed=crests,
            curve=curve,
            no_load=unloaded,
            free=run,
            last=last,
            speed=speed,
            spread=spread,
            converged=run.statistics.finished and motor.comes_to_speed(run, last, crests),
            stop=motor.stopped(case, run, self.periods) if goes_on and not two_way else None,
            reversal=motor.reversed_way(case, run, -speed, self.periods) if goes_on else None,
            amplitude=float(abs(case.field().deflection([case.slider.start_on(case.beam)])[0])),
        )


def _warnings(fields: list[Field]) -> tuple[list[str], bool]:
    """(what is not converged or outside its range of validity, whether the summary holds nevertheless)."""
    from verify.motion.contact import FELT
    from verify.motion.validity import NONLINEAR

    warnings = []
    for field in fields:
        loose = [at for at in field.curve if not at.settled()]
        if loose:
            most = max(at.periods for at in loose)
            warnings.append(WARNINGS["means"].format(field.name, len(loose), len(field.curve), most))
        if not field.converged:
            warnings.append(WARNINGS["free"].format(field.name, 100 * field.spread))
    margins, coupling = fields[0].free.motor_margins, fields[0].free.coupling
    assert coupling is not None
    contact = 0.0 if coupling.two_way else max(coupling.normal_size, coupling.friction_size or 0.0)
    sag = 0.0 if margins.sag_taken else (margins.sag or 0.0) / fields[0].amplitude
    axial, epsilon = margins.chain or 0.0, margins.epsilon or 0.0
    step = max(field.free.motor_margins.step for field in fields) ** 2 / 24.0
    limits = {"coupling": (contact, FELT), "sag": (sag, LARGE), "axial": (axial, NONLINEAR)}
    limits |= {"epsilon": (epsilon, LARGE), "step": (step, 1e-3)}
    warnings += [WARNINGS[key].format(value) for key, (value, limit) in limits.items() if value > limit]
    converged = all(field.converged and field.curve[0].settled("force") for field in fields)
    return warnings, converged and max(contact, sag, axial) < LARGE


def _times(field: Field) -> list[float | None]:
    """Time constants of starting, stopping and reversing, s; None where the motor does not reach a speed."""
    from verify.motor.figures import started_of

    if not field.converged or abs(field.speed) <= field.spread:
        return [None, None, None]
    return [started_of(field.free, field.speed), *(one.time if one else None for one in (field.stop, field.reversal))]


def _tables(fields: list[Field]) -> "list[Table]":
    from verify.report.result import Column, Table

    overview, held, validity = [], [], []
    for field in fields:
        run, last, still = field.free, field.last, field.curve[0]
        stall = still.force if still.settled("force") else None
        pushing = [at for at in field.curve if at.settled("force")]
        power = max((at.power for at in pushing if at.power > 0.0), default=None)
        efficient = [at.efficiency for at in pushing if at.settled("powers") and at.efficiency]
        unloaded = field.no_load.speed if field.no_load else None
        own = (field.crest_speed, unloaded, field.speed if field.converged else None, stall, power)
        shares = (float(run.contact_share[-last:].mean()), float(run.stuck_share[-last:].mean()))
        friction = float(run.rubbed[-last:].sum()) / float(run.times[-1] - run.times[-1 - last])
        dashpots = (run.ledger.damped + run.ledger.impacts) / run.duration
        best = max(efficient, default=None)
        overview.append((field.name, *own, best, *shares, *_times(field), friction, dashpots))
        for at in field.curve:
            power = at.power if at.settled("force") else None
            efficiency = at.efficiency if at.settled("force", "powers") else None
            shares = (at.contact_share, at.stuck_share)
            held.append((field.name, at.speed, at.force, at.spread, power, efficiency, *shares, at.settled()))
        margins, coupling = run.motor_margins, run.coupling
        assert coupling is not None
        sag = None if margins.sag is None else round(margins.sag, 12)  # of balanced loads rounding is left
        sizes = (coupling.normal_size, coupling.friction_size, margins.chain, margins.step, field.spread)
        validity.append((field.name, margins.epsilon, sag, field.amplitude, *sizes))
    columns = [Column("model"), si("crest speed", "m/s", ".5g"), si("no-load speed", "m/s", "+.5g")]
    columns += [si("free speed", "m/s", "+.5g"), si("stall force", "N", "+.4g"), si("largest power", "W")]
    columns += [percent("best efficiency", ".3g"), percent("contact", ".3g"), percent("stick", ".3g")]
    columns += [si("start", "s", ".3g"), si("stop", "s", ".3g"), si("reversal", "s", ".3g")]
    columns += [si("friction power", "W"), si("dashpot power", "W")]
    curve = [Column("model"), si("speed", "m/s", "+.4g"), si("force", "N", "+.4g"), si("±", "N", ".1g")]
    curve += [si("power", "W", "+.4g"), percent("efficiency", ".3g"), percent("contact", ".3g")]
    curve += [percent("stick", ".3g"), Column("converged")]
    limits = [Column("model"), Column("epsilon", format=".3g"), si("sag", "m", ".3g"), si("amplitude", "m")]
    limits += [Column("normal coupling", format=".1e"), Column("friction coupling", format=".1e")]
    limits += [Column("(kL)² ⟨θ²⟩", format=".1e"), Column("contact phase per step", "rad", ".2g")]
    limits += [Column("speed spread", "m/s", ".1e")]
    notes = [
        "No-load speed: held, without mean friction. Free speed, contact, stick, friction power: last quarter of a "
        "free run. Start, stop, reversal: time constants (1 - 1/e) from the slider's own speed, with the drive "
        "switched off, with its phases reversed."
    ]
    return [
        Table("The motor on each model", columns, overview, notes),
        Table("Force over speed, slider held at its place", curve, held),
        Table("Validity of these runs", limits, validity),
    ]


def _figures(fields: list[Field]) -> "list[Figure]":
    import numpy as np

    from verify.report.result import Figure

    force: list[Any] = []
    power: list[Any] = []
    speed: list[Any] = []
    for field in sorted(fields, key=lambda one: one.case.count or 0):
        style = model_style(field.case.model)
        settled = [at for at in field.curve if at.settled("force")]
        v = np.array([at.speed for at in settled])
        force.append((field.name, v, np.array([at.force for at in settled]), style))
        power.append((field.name, v, np.array([at.power for at in settled]), style))
        runs: dict[str, Any] = {"-": field.free, ":": field.stop and field.stop.run}
        runs["--"] = field.reversal and field.reversal.run
        seconds = TIME_CONSTANTS * max(filter(None, _times(field)), default=field.free.duration)
        for line, run in runs.items():
            if run is not None:
                n = max(int(np.searchsorted(run.times - run.times[0], seconds)), 3)
                label, own = (field.name, style) if line == "-" else ("", style | {"linestyle": line, "linewidth": 1.4})
                speed.append((label, run.times[:n] - run.times[0], run.speed[:n], own))
    still, ends = fields[0].curve[0], np.array([0.0, fields[0].curve[-1].speed])
    limit = np.copysign(fields[0].case.slider.mu * still.normal_force, still.force)
    force.append(("mu N", ends, np.array([limit, limit]), {"color": "#7d8590", "linestyle": "--"}))
    charts = [
        ("motor-force", "Force over speed", force, ("speed", "m/s"), ("force", "N")),
        ("motor-power", "Power over speed", power, ("speed", "m/s"), ("power", "W")),
        ("motor-speed", "Starting, stopping, reversing", speed, ("time", "s"), ("speed", "m/s")),
    ]
    return [
        Figure(key, title, CAPTIONS[key], partial(plot_lines, lines=lines, x=x, y=y))
        for key, title, lines, x, y in charts
    ]
