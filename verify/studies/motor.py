"""The motor of a scene: force over speed, no load, starting and stopping on every model, and from rest on the chain."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from msgspec import Meta
from msgspec.structs import replace

from verify.checks import Relative, check_number
from verify.errors import InputError, near_name
from verify.options import OF_THE_CHAIN, Links, Start
from verify.studies.base import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure

    from verify.judge.cache import SolutionCache
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Timed
    from verify.motor.result import MotorRun
    from verify.motor.shooting import Periodic
    from verify.report.result import Figure, Movie, Result, Table
    from verify.scene.model import Scene

CHAIN = "chain"
HELD_PERIODS = 11_520
"""Periods after which a held speed counts as not converged."""
LAST = 0.25
"""Fraction of a free run, at its end, over which means are formed."""
MOST_REST_PERIODS = 1000
FRAMES, PLACES = 36, 73
SAG = 0.1
"""Static deflection over amplitude beyond which a one-way run is doubtful; likewise the compliance number epsilon."""
STEP_ERROR = 1e-3


@dataclass(frozen=True, eq=False)
class Field:
    """One model under the slider."""

    case: "MotorCase"
    name: str
    crest_speed: float
    """First-order speed amplitude of the surface at the slider, m/s."""
    curve: "list[AtSpeed]"
    """From standing still to the crest speed, in the direction of the force."""
    no_load: "AtSpeed | None"
    """None where no held speed is without force."""
    free: "MotorRun"
    speed: float
    """Mean over the last quarter of the free run, m/s."""
    spread: float
    """Difference of the means of the halves of that quarter, m/s."""
    converged: bool
    """Whether the free run reached its end at a steady speed."""
    stop: "Timed | None"
    """With the drive switched off; None where the beam would ring on."""
    reversal: "Timed | None"
    periodic: "Periodic | None"
    """The periodic motion at standstill; None where there is none."""
    period: "MotorRun"
    """One period at the no-load speed, at a fixed place, with the surface around the feet."""
    amplitude: float
    """Of the surface under the slider, m."""


class Motor(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A slider that may leave the beam: held at speeds, free, started, stopped and reversed."""

    name: ClassVar[str] = "motor"
    title: ClassVar[str] = "The motor"

    models: Annotated[
        tuple[str, ...],
        Meta(min_length=1, description="Models under the slider; 'chain' is the nonlinear chain, which runs from rest."),
    ] = ("analytic", "segment", "fem")
    count: Annotated[int, Meta(ge=2, le=250, description="Segments, elements and links.")] = 49
    speeds: Annotated[int, Meta(ge=2, le=201, description="Points of the force-speed curve, 0 to the crest speed.")] = 9
    periods: Annotated[int, Meta(ge=20, le=100_000, description="Periods of a free run, of stopping, reversing.")] = 2000
    start: Annotated[Start, Meta(description="Beam at the start of the free run: steady or at rest.")] = "steady"
    soft_start_periods: Annotated[float, Meta(ge=0, description="Periods over which forces from rest grow.")] = 0.0
    modal_damping: Annotated[
        Relative | None, Meta(description="Damping ratio of every mode; from the beam's loss factor unless set.")
    ] = None
    steps_per_period: Annotated[int, Meta(ge=16, le=4096, description="Steps in a period, at least.")] = 61
    chain: Annotated[float | None, Meta(description="Duration of the runs from rest, s; 0.02 unless set.")] = None
    chain_force: Annotated[
        float | None, Meta(description="Amplitude of all forces in the runs from rest, N; preload in proportion.")
    ] = None
    links: Annotated[tuple[Links, ...] | None, Meta(description="Links of the chain; rigid and stretching.")] = None
    places: Annotated[
        Annotated[int, Meta(ge=2, le=64)] | None, Meta(description="Start positions in a wavelength; 8 unless set.")
    ] = None

    def __post_init__(self) -> None:
        from verify.models.catalogue import MODELS
        from verify.models.naming import Among

        for name in self.linear:
            if name not in MODELS or not MODELS[name].can("time_basis"):
                known = (*Among("time_basis").names(), CHAIN)
                raise InputError(f"motor.models has {name!r}, which is not known: {near_name(name, known)}")
        for name, values in (("models", self.models), ("links", self.links or ())):
            if len(set(values)) < len(values):
                raise InputError(f"motor.{name} = {list(values)!r} has one twice: give each once")
        if not self.linear:
            raise InputError("motor.models has the nonlinear chain alone: add a linear model to compare with")
        for name in OF_THE_CHAIN if CHAIN not in self.models else ():
            if getattr(self, name) is not None:
                raise InputError(f"motor.{name} belongs to model 'chain': add 'chain' to motor.models, or leave it out")
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motor.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )
        for name in ("chain", "chain_force"):
            if getattr(self, name) is not None:
                check_number(f"motor.{name}", getattr(self, name), "seconds or newton", above=0)

    @property
    def linear(self) -> tuple[str, ...]:
        """The linear models."""
        return tuple(name for name in self.models if name != CHAIN)

    def check(self, scene: "Scene") -> None:
        """Raise InputError without forces or a slider with contact, and for what does not combine."""
        from verify.motor.combine import check_combines
        from verify.motor.feet import check_on_beam

        if not scene.forces or scene.drive is None or scene.drive.kind != "force":
            raise InputError("motor: the beam moves under a [drive] of kind force, add its forces")
        if scene.slider is None or scene.slider.contact is None:
            raise InputError("motor: its slider may leave the beam, add [slider] with contact; [motion] runs one that stays")
        for model in self.linear:
            for start in ("steady", self.start):
                check_combines(model, start, scene.slider)
        check_on_beam(scene.slider, scene.beam, scene.slider.start_on(scene.beam))
        if CHAIN in self.models:
            check_combines(CHAIN, "rest", scene.slider)
            if scene.beam.supports != ("pinned", "pinned"):
                raise InputError(
                    f"motor.models has the chain, with beam.supports = {list(scene.beam.supports)!r}: give pinned ends, "
                    "or leave the chain out"
                )
            if (self.chain or 0.02) * scene.drive.frequency_hz > MOST_REST_PERIODS:
                raise InputError(
                    f"motor.chain = {self.chain or 0.02!r} s exceeds {MOST_REST_PERIODS} periods of the drive: shorten it"
                )

    def case(self, scene: "Scene", model: str) -> "MotorCase":
        """The scene's motor on a model, with a steady beam."""
        from verify.models.catalogue import MODELS
        from verify.motor.case import MotorCase

        return MotorCase(
            beam=scene.beam,
            forces=scene.forces,
            frequency_hz=scene.drive.frequency_hz,
            slider=scene.slider,
            model=model,
            count=self.count if model == CHAIN or MODELS[model].sized else None,
            modal_damping=self.modal_damping,
            steps_per_period=self.steps_per_period,
        )

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Run the motor on every model. Raises InputError."""
        from verify.report.result import Result

        fields: list[Field] = []
        for model in self.linear:
            speeds = [at.speed for at in fields[0].curve] if fields else []
            fields.append(self._field(self.case(scene, model), speeds, progress))
        rest = self._from_rest(scene, fields[0], progress) if CHAIN in self.models else []
        warnings, valid = _warnings(fields)
        first = fields[0]
        speed, force = 100 * first.speed, first.curve[0].force
        return Result(
            summary=f"Without load {speed:+.4g} cm/s, stall force {force:+.4g} N ({first.name})." if valid else "",
            tables=[*_tables(fields), *([_rest_table(rest)] if rest else [])],
            figures=_figures(fields, rest),
            movies=[_movie(first)],
            warnings=warnings,
            data={"fields": [_plain(field) for field in fields], "from_rest": rest},
        )

    def _field(self, case: "MotorCase", speeds: list[float], progress: Progress) -> Field:
        """Held speeds, free run, stopping and reversing on one model. Raises InputError."""
        import numpy as np

        from verify.motor.figures import comes_to_speed, crest_speed, held, mean_speed, no_load, reversed_way
        from verify.motor.figures import started, stopped
        from verify.motor.shooting import periodic

        name = f"{case.count} {_title(case.model)}" if case.count else _title(case.model)
        progress(f"force over speed, {name}")
        crests = crest_speed(case)
        still, settled = held(case, 0.0, periods=HELD_PERIODS)
        way = -1.0 if still.force < 0.0 else 1.0
        speeds = speeds or [way * crests * k / (self.speeds - 1) for k in range(self.speeds)]
        curve = [still, *(held(case, speed, settled, HELD_PERIODS)[0] for speed in speeds[1:])]
        unloaded = _or_none(lambda: no_load(case, None, settled, HELD_PERIODS))
        progress(f"free run, {name}")
        begun = replace(case, start=self.start, soft_start_periods=self.soft_start_periods)
        run = started(begun, unloaded.speed if unloaded else 0.0, self.periods).run
        if len(run.times) < 3:
            raise InputError(f"motor.start: the free run {run.statistics.stopped} within two periods, give smaller forces")
        last = _last(run)
        speed, spread = mean_speed(run, last)
        goes_on = run.statistics.finished and self.start == "steady"
        assert run.coupling is not None
        alone = goes_on and not run.coupling.two_way
        one_way = case.on(replace(case.slider, coupling="one-way"))
        x = case.slider.start_on(case.beam)
        ends = [x + foot.offset + 0.75 * side * foot.length for foot in case.slider.feet for side in (-1.0, 1.0)]
        half = max(0.5 * (max(ends) - min(ends)), 0.0125 * case.beam.length)
        places = np.clip(0.5 * (max(ends) + min(ends)) + np.linspace(-half, half, PLACES), 0.0, case.beam.length)
        loaded = held(case, unloaded.speed if unloaded else 0.0, periods=HELD_PERIODS)[1]
        return Field(
            case=case,
            name=name,
            crest_speed=crests,
            curve=curve,
            no_load=unloaded,
            free=run,
            speed=speed,
            spread=spread,
            converged=run.statistics.finished and comes_to_speed(run, last, crests),
            stop=stopped(case, run, self.periods) if alone else None,
            reversal=reversed_way(case, run, -speed, self.periods) if goes_on else None,
            periodic=_or_none(lambda: periodic(one_way, 0.0)) if not run.coupling.two_way else None,
            period=case.run(
                case.period,
                held_speed=unloaded.speed if unloaded else 0.0,
                frozen=True,
                at=places.tolist(),
                samples=FRAMES + 1,
                continue_from=loaded,
            ),
            amplitude=float(abs(case.field().deflection([x])[0])),
        )

    def _from_rest(self, scene: "Scene", first: Field, progress: Progress) -> list[dict[str, Any]]:
        """All models from rest, undamped, forces switched on at once: a nonlinear chain has no other start.

        The beam never comes to a steady wave, and where a slider ends depends on where it starts: it is placed at
        several positions of one wavelength, the wave in either direction, and means have a standard error.
        """
        import numpy as np

        from verify.models.fields import lossless_wavenumber
        from verify.models.underfoot import standing_at
        from verify.motor.run import run_motors

        factor = 1.0
        if self.chain_force is not None:
            factor = self.chain_force / max(abs(force.amplitude) for force in scene.forces)
        slider = scene.slider
        slider = replace(slider, preload=factor * slider.preload, gravity=factor * slider.gravity)
        x, n, seconds = slider.start_on(scene.beam), self.places or 8, self.chain or 0.02
        length = 2.0 * pi / abs(lossless_wavenumber(standing_at(scene.beam, x), scene.drive.frequency_hz))
        sliders = [replace(slider, position=x + (k - n // 2) / n * length) for k in range(n)]
        kinds = [(model, "rigid") for model in self.linear] + [(CHAIN, links) for links in self.links or LINKS]
        rows: list[dict[str, Any]] = []
        for model, links in kinds:
            name = f"{links} links" if model == CHAIN else f"{self.count} {_title(model)}" if model != "analytic" else _title(model)
            progress(f"from rest, {name}")
            case = self.case(scene, model).driven(factor)
            ends, pushes = [], []
            for sign, one in ((1.0, case), (-1.0, case.turned())):
                runs = run_motors(
                    one.beam,
                    one.forces,
                    one.frequency_hz,
                    seconds,
                    sliders=[*sliders, *sliders],
                    held_speed=[None] * n + [0.0] * n,
                    frozen=[False] * n + [True] * n,
                    model=model,
                    count=one.count,
                    start="rest",
                    modal_damping=0.0,
                    links=links,
                    samples=int(seconds * one.frequency_hz) + 2,
                    steps_per_period=one.steps_per_period,
                )
                if any(run.statistics.interrupted for run in runs):
                    raise KeyboardInterrupt
                ends += [run.displacement for run in runs[:n]]
                friction = [float(run.friction[len(run.friction) // 2 :].mean()) for run in runs[n:]]
                pushes += [sign * force / (slider.mu * slider.normal_force) for force in friction]
                path = path if sign < 0.0 else (runs[n // 2].times, runs[n // 2].travelled)
            apart = np.array(ends) - np.array(rows[0]["ends"] if rows else ends)
            rows.append(
                {
                    "model": model,
                    "name": name,
                    "ends": ends,
                    "departure": float(apart.mean()),
                    "departure_error": float(apart.std(ddof=1)) / sqrt(2 * n),
                    "departure_rms": float(np.sqrt((apart**2).mean())),
                    "push": float(np.mean(pushes)),
                    "push_error": float(np.std(pushes, ddof=1)) / sqrt(2 * n),
                    "axial_inertia": runs[0].motor_margins.chain,
                    "times": path[0],
                    "path": path[1],
                }
            )
        return rows


def _title(model: str) -> str:
    from verify.models.catalogue import MODELS

    return MODELS[model].title


def _last(run: "MotorRun") -> int:
    """Samples of the last quarter of a free run, an even number."""
    return max(int(LAST * (len(run.times) - 1)) // 2 * 2, 2)


def _or_none(compute: "Callable[[], Any]") -> Any:
    """The value, or None where there is none."""
    import numpy as np

    try:
        return compute()
    except (InputError, np.linalg.LinAlgError):
        return None


def _warnings(fields: list[Field]) -> tuple[list[str], bool]:
    """(what is not converged or outside its range of validity, whether the summary holds nevertheless)."""
    from verify.motion.contact import FELT
    from verify.motion.validity import NONLINEAR

    warnings, valid = [], True
    for field in fields:
        unsettled = [at for at in field.curve if not at.settled()]
        if unsettled:
            warnings.append(
                f"{field.name}: means at {len(unsettled)} of {len(field.curve)} held speeds are not converged after "
                f"{max(at.periods for at in unsettled)} periods; values derived from them are omitted. More "
                "slider.contact.damping or slider.preload calms the motion."
            )
        if not field.converged:
            warnings.append(
                f"{field.name}: the free run has no steady end, the halves of its last quarter differ by "
                f"{100 * field.spread:.2g} cm/s; raise motor.periods."
            )
        valid = valid and field.converged and field.curve[0].settled("force")
    first = fields[0]
    margins, coupling = first.free.motor_margins, first.free.coupling
    assert coupling is not None
    contact = max(coupling.normal_size, coupling.friction_size or 0.0) if not coupling.two_way else 0.0
    sag = (margins.sag or 0.0) / first.amplitude if not margins.sag_taken else 0.0
    chain, epsilon = margins.chain or 0.0, margins.epsilon or 0.0
    step = max(field.free.motor_margins.step for field in fields) ** 2 / 24.0
    limits = (
        (contact, FELT, f"Coupling: contact changes the surface motion by {100 * contact:.2g} %, one-way coupling neglects it."),
        (sag, SAG, f"Sag: preload bends the beam by {sag:.2g} of the wave's amplitude, one-way coupling neglects it."),
        (chain, NONLINEAR, f"Nonlinearity: linear models neglect an axial inertia (kL)² ⟨θ²⟩ = {chain:.2g} of rigid links."),
        (epsilon, SAG, f"Compliance: epsilon = {epsilon:.3g}, points deflect along the surface before they slip."),
        (step, STEP_ERROR, f"Time step: the period of the contact's oscillation is {step:.1e} off, raise steps_per_period."),
    )
    warnings += [text for value, limit, text in limits if value > limit]
    return warnings, valid and max(contact, sag, chain) < SAG


def _row(field: Field) -> dict[str, Any]:
    """What the overview table shows; None where it is not converged."""
    run, last = field.free, _last(field.free)
    goes = field.converged and abs(field.speed) > field.spread
    pushing = [at for at in field.curve if at.settled("force")]
    efficient = [at.efficiency for at in pushing if at.settled("powers") and at.efficiency]
    seconds = float(run.times[-1] - run.times[-1 - last])
    from verify.motor.figures import started_of

    return {
        "field": field.name,
        "crest_speed": field.crest_speed,
        "no_load_speed": field.no_load.speed if field.no_load else None,
        "free_speed": field.speed if field.converged else None,
        "stall_force": field.curve[0].force if field.curve[0].settled("force") else None,
        "largest_power": max((at.power for at in pushing if at.power > 0.0), default=None),
        "best_efficiency": max(efficient, default=None),
        "contact_share": float(run.contact_share[-last:].mean()),
        "stick_share": float(run.stuck_share[-last:].mean()),
        "start_time": started_of(run, field.speed) if goes else None,
        "stop_time": field.stop.time if goes and field.stop else None,
        "reversal_time": field.reversal.time if goes and field.reversal else None,
        "friction_power": float(run.rubbed[-last:].sum()) / seconds,
        "dashpot_power": (run.ledger.damped + run.ledger.impacts) / run.duration,
    }


def _tables(fields: list[Field]) -> "list[Table]":
    from verify.report.result import Column, Table

    speed, watt, time = (".5g", True), ".4g", ".3g"
    columns = [
        *(Column("model"), Column("crest speed", "m/s", ".5g", prefix=True)),
        *(Column("no-load speed", "m/s", "+.5g", prefix=True), Column("free speed", "m/s", "+.5g", prefix=True)),
        *(Column("stall force", "N", "+.4g", prefix=True), Column("largest power", "W", ".4g", prefix=True)),
        *(Column("best efficiency", percent=True, format=".3g"), Column("contact", percent=True, format=".3g")),
        *(Column("stick", percent=True, format=".3g"), Column("start", "s", ".3g", prefix=True)),
        *(Column("stop", "s", ".3g", prefix=True), Column("reversal", "s", ".3g", prefix=True)),
        *(Column("friction power", "W", ".4g", prefix=True), Column("dashpot power", "W", ".4g", prefix=True)),
    ]
    curve = [
        *(Column("model"), Column("speed", "m/s", "+.4g", prefix=True), Column("force", "N", "+.4g", prefix=True)),
        *(Column("±", "N", ".1g", prefix=True), Column("normal force", "N", ".4g", prefix=True)),
        *(Column("power", "W", "+.4g", prefix=True), Column("efficiency", percent=True, format=".3g")),
        *(Column("contact", percent=True, format=".3g"), Column("stick", percent=True, format=".3g")),
    ]
    held, limits = [], []
    for field in fields:
        for at in field.curve:
            power = at.power if at.settled("force") else None
            efficiency = at.efficiency if at.settled("force", "powers") else None
            own = (at.force, at.spread, at.normal_force, power, efficiency, at.contact_share, at.stuck_share)
            held.append((field.name, at.speed, *own))
        margins, coupling, repeated = field.free.motor_margins, field.free.coupling, field.periodic
        assert coupling is not None
        sizes = (coupling.normal_size, coupling.friction_size, margins.chain, margins.step, field.spread)
        stable = float(abs(repeated.multipliers).max()) if repeated else None
        force = float(repeated.run.friction[1:].mean()) if repeated else None
        limits.append((field.name, margins.epsilon, margins.sag, field.amplitude, *sizes, force, stable))
    validity = [
        *(Column("model"), Column("epsilon", format=".3g"), Column("sag", "m", ".3g", prefix=True)),
        *(Column("amplitude", "m", ".4g", prefix=True), Column("normal coupling", format=".1e")),
        *(Column("friction coupling", format=".1e"), Column("(kL)² ⟨θ²⟩", format=".1e")),
        *(Column("contact phase per step", "rad", ".2g"), Column("speed spread", "m/s", ".1e")),
        *(Column("periodic stall force", "N", "+.5g", prefix=True), Column("largest multiplier", format=".5f")),
    ]
    return [
        Table(
            "The motor on each model",
            columns,
            [tuple(_row(field).values()) for field in fields],
            [
                "No-load speed: held, with zero mean friction. Free speed, contact and stick shares, friction power: last "
                "quarter of a free run. Start, stop, reversal: time constants (1 - 1/e) from the slider's own speed, with "
                "the drive switched off, with its phases reversed; the beam's own transient is neglected.",
            ],
        ),
        Table("Force over speed, slider held at its place", curve, held),
        Table("Validity of these runs", validity, limits),
    ]
