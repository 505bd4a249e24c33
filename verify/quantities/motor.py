"""Named figures of a motor: a slider that may leave the beam, held at a speed, without load, under way."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import Meta
from msgspec.structs import replace

from verify import options
from verify.checks import Relative
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import compiled
from verify.quantities.cases import drive_forces, drive_frequency
from verify.quantities.kind import WHAT_EXISTS, DriveArguments, MovingModel, Quantity, Size, check_count
from verify.quantities.motion_arguments import check_law
from verify.slider import changed

if TYPE_CHECKING:
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Reading
    from verify.scenes.scene import Scene
    from verify.slider import Contact, Foot, Slider

Positive = Annotated[float, Meta(gt=0)]


class Motor(DriveArguments, frozen=True, kw_only=True):
    """The scene's motor, one model's beam in its steady state, with what is given instead."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position")
    reads: ClassVar[tuple[str, ...]] = WHAT_EXISTS
    slides: ClassVar[bool] = True

    model: MovingModel = "segment"
    count: Size | None = None
    force: Annotated[float, Meta(ge=0, description="of every force, newton; default: the scene's")] | None = None
    modal_damping: Annotated[Relative, Meta(ge=0, lt=1, description="ratio of every mode")] | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="at least; more where the contact is stiff")] = 61
    mu: Annotated[float, Meta(gt=0, description="coefficient of friction")] | None = None
    slope: Annotated[float, Meta(gt=0, description="K of Eq. (3), s/m")] | None = None
    mass: Annotated[float, Meta(gt=0, description="kg")] | None = None
    law: Annotated[options.Law, Meta(description="Eq. (3), or true sticking")] | None = None
    coupling: Annotated[options.CouplingChoice, Meta(description="whether the beam feels it")] | None = None
    preload: Annotated[float, Meta(ge=0, description="newton pressing it on beside its weight")] | None = None
    slider_position: Annotated[float, Meta(description="where it is put, metres")] | None = None
    stiffness: Annotated[float, Meta(gt=0, description="of each foot's contact, N/m")] | None = None
    damping: Annotated[float, Meta(ge=0, description="of each foot's contact, N s/m")] | None = None
    tangential_stiffness: Annotated[float, Meta(gt=0, description="of each foot along the surface, N/m")] | None = None
    restitution: Annotated[float, Meta(ge=0, le=1, description="of a hard contact")] | None = None
    points: Annotated[int, Meta(ge=1, description="of every foot")] | None = None
    foot_length: Annotated[float, Meta(gt=0, description="of every foot, metres")] | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        check_law(self.law, self.slope)


class Held(Motor, frozen=True, kw_only=True):
    """Its slider held still, at its place."""

    periods: Annotated[int, Meta(ge=24, description="of the drive, at most, until the means have settled")] = 46_080


class AtSpeedOf(Held, frozen=True, kw_only=True):
    """Its slider held at a speed, at its place."""

    speed: Annotated[float, Meta(description="along +x, m/s")] = 0.0


class ForceAt(Held, frozen=True, kw_only=True):
    """The same at a speed that has to be said."""

    speed: Annotated[float, Meta(description="along +x, m/s")]


class FreeRun(Motor, frozen=True, kw_only=True):
    """Its slider free, from rest."""

    periods: Annotated[int, Meta(ge=2, description="of the drive, that are run")] = 2000
    pull: Annotated[float, Meta(description="on the slider along +x, newton")] | None = None


class UnderWay(FreeRun, frozen=True, kw_only=True):
    """The same, at its end."""

    last: Annotated[int, Meta(ge=2, description="periods at the end of which the mean is taken")] = 200

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.last >= self.periods:
            raise InputError(f"last = {self.last!r} of periods = {self.periods!r}: take the mean of fewer than all")


class OfRun(FreeRun, frozen=True, kw_only=True):
    """A line of its energy books over the work of the surface on it."""

    of: Annotated[
        Literal["damped", "impacts", "rubbed", "residual"],
        Meta(description="lost in dashpots, in hard landings, in friction; what the books miss"),
    ]


def slider_on_feet(a: Motor, scene: "Scene") -> "Slider":
    """The scene's slider with what is given instead of its own. Raises InputError where it never leaves the beam."""
    if scene.slider is None:
        raise InputError("the scene has no slider: add [slider] with mass, mu and [slider.contact]")
    if scene.slider.contact is None:
        raise InputError("slider.contact is missing: a motor's slider may leave the beam, add [slider.contact]")
    own = {name: getattr(a, name) for name in ("mu", "slope", "mass", "law", "coupling", "preload")}
    own |= {"position": a.slider_position, "pull": getattr(a, "pull", None)}
    touching = {name: getattr(a, name) for name in ("stiffness", "damping", "tangential_stiffness", "restitution")}
    contact = replace(scene.slider.contact, **_given(touching))
    standing = _given({"points": a.points, "length": a.foot_length})
    feet = tuple(replace(foot, **standing) for foot in scene.slider.feet) if standing else scene.slider.foot
    _check_length(a.foot_length, contact, feet)
    return changed(scene.slider, contact=contact, foot=feet, **_given(own))


def _check_length(length: float | None, contact: "Contact", feet: "tuple[Foot, ...]") -> None:
    """Raise InputError for a length on which a foot of one point does not touch."""
    layered = contact.layer_stiffness is not None or contact.layer_tangential_stiffness is not None
    if length is not None and (contact.hard or (not layered and any(foot.points == 1 for foot in feet))):
        remedy = "leave it out" if contact.hard else "give points as well"
        raise InputError(f"foot_length = {length!r} of a foot of one point, which touches at its middle: {remedy}")


def _given(settings: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in settings.items() if value is not None}


def motor_case(a: Motor, scene: "Scene") -> "MotorCase":
    """The motor that arguments and a scene describe. Raises InputError."""
    from verify.motor.case import MotorCase
    from verify.quantities.simulated import check_forced

    check_forced(scene, "a motor")
    forces = drive_forces(a, scene)
    return MotorCase(
        beam=scene.beam,
        forces=forces if a.force is None else tuple(replace(one, amplitude=a.force) for one in forces),
        frequency_hz=drive_frequency(a, scene),
        slider=slider_on_feet(a, scene),
        model=a.model,
        count=a.count,
        modal_damping=a.modal_damping,
        steps_per_period=a.steps_per_period,
    )


def _needs(a: Motor, scene: "Scene") -> tuple[()]:
    """Raise InputError for a motor that is not run."""
    from verify.motor.combine import check_combines
    from verify.motor.feet import check_on_beam

    case = motor_case(a, scene)
    check_combines(case.model, case.start, case.slider)
    check_on_beam(case.slider, case.beam, case.slider.start_on(case.beam))
    return ()


def _held(a: Held, scene: "Scene", bench: Workbench) -> "AtSpeed":
    """The motor at the speed that is asked for, solved once."""
    from verify.motor.figures import at_speed

    case, speed = motor_case(a, scene), float(getattr(a, "speed", 0.0))
    key = ("motor", case, speed, a.periods)
    if key not in bench.motors:
        bench.motors[key] = at_speed(case, speed, periods=a.periods)
    found: AtSpeed = bench.motors[key]
    return found


def _of_held(figure: "Callable[[AtSpeed], float]", *readings: "Reading") -> "Callable[[Held, Scene, Workbench], float]":
    """A figure that stands on some readings. Raises InputError where one of them has not settled."""

    def evaluate(a: Held, scene: "Scene", bench: Workbench) -> float:
        from verify.motor.withheld import not_settled

        found = _held(a, scene, bench)
        if not found.settled(*readings):
            raise InputError(not_settled(motor_case(a, scene), found, readings, a.periods))
        return figure(found)

    return evaluate


def _efficiency(found: "AtSpeed") -> float:
    """Raises InputError where the slider drives the surface."""
    if found.efficiency is None:
        raise InputError(f"speed = {found.speed!r} m/s: there the slider drives the surface, give a speed in between")
    return found.efficiency


def _no_load(a: Held, scene: "Scene", bench: Workbench) -> float:
    from verify.motor.figures import no_load

    return no_load(motor_case(a, scene), periods=a.periods).speed


def _free_speed(a: UnderWay, scene: "Scene", bench: Workbench) -> float:
    """Raises InputError where the run has no steady end."""
    from verify.motor.figures import comes_to_speed, crest_speed, mean_speed, pushed_on

    run, case = _free(a, scene, bench), motor_case(a, scene)
    speed, spread = mean_speed(run, a.last)
    crests = crest_speed(case)
    if not comes_to_speed(run, a.last, crests):
        carried = float(run.normal_force[-a.last :].mean())
        raise InputError(
            f"periods = {a.periods!r} with last = {a.last!r}: the free run has no steady end, its halves differ by "
            f"{spread:.2g} m/s where crests run at {crests:.3g} m/s, {pushed_on(run, a.last):.2g} of mu N push it on, "
            f"and {carried:.3g} N are carried of {case.slider.normal_force:.3g} N: give more of both, or more "
            "slider.preload"
        )
    return speed


def _free(a: FreeRun, scene: "Scene", bench: Workbench) -> Any:
    """The free run, sampled once a period, solved once. Raises InputError where it does not reach its end."""
    case = motor_case(a, scene)
    key = ("motor free", case, a.periods)
    if key not in bench.motors:
        bench.motors[key] = case.run(a.periods * case.period, samples=a.periods + 1, patient=False)
    run = bench.motors[key]
    if run.statistics.interrupted:
        raise KeyboardInterrupt
    if not run.statistics.finished:
        raise InputError(
            f"the slider {run.statistics.stopped} after {run.state.time:.6g} s: ask for fewer periods, or put it "
            "elsewhere"
        )
    return run


def _start_time(a: UnderWay, scene: "Scene", bench: Workbench) -> float:
    """Raises InputError where it is not under way by then."""
    from verify.motor.figures import started_of

    found = started_of(_free(a, scene, bench), _free_speed(a, scene, bench))
    if found is None:
        raise InputError(f"periods = {a.periods!r}: the slider is not under way by then, give more")
    return found


def _booked(a: OfRun, scene: "Scene", bench: Workbench) -> float:
    books = _free(a, scene, bench).ledger
    return float(getattr(books, a.of) / (abs(books.across) + abs(books.along)))


MOTOR_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "slider.stall_force",
        "N",
        "Mean friction on a slider that may leave the beam, held still.",
        Held,
        "in time",
        _of_held(lambda found: found.force, "force"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.force_speed",
        "N",
        "The same at a speed.",
        ForceAt,
        "in time",
        _of_held(lambda found: found.force, "force"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.normal_mean",
        "N",
        "Mean normal force on that slider.",
        AtSpeedOf,
        "in time",
        _of_held(lambda found: found.normal_force, "normal force"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.contact_share",
        "1",
        "Share of its points and of time that touch.",
        AtSpeedOf,
        "in time",
        _of_held(lambda found: found.contact_share, "shares"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.stuck_share",
        "1",
        "Share of its points and of time that stick.",
        AtSpeedOf,
        "in time",
        _of_held(lambda found: found.stuck_share, "shares"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.power",
        "W",
        "Mean power on that slider at a speed.",
        ForceAt,
        "in time",
        _of_held(lambda found: found.power, "force"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.efficiency",
        "1",
        "That power over what the surface gives along the beam.",
        ForceAt,
        "in time",
        _of_held(_efficiency, "force", "powers"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.wear_power",
        "W",
        "What friction takes at a speed, and what gives way along the surface.",
        AtSpeedOf,
        "in time",
        _of_held(lambda found: found.rubbed, "powers"),
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.no_load_speed",
        "m/s",
        "Speed along +x at which the mean friction on that slider is nought.",
        Held,
        "in time",
        _no_load,
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.free_speed",
        "m/s",
        "Mean speed of that slider at the end of a free run.",
        UnderWay,
        "in time",
        _free_speed,
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.start_time",
        "s",
        "Until 1 - 1/e of the way from its first speed to that one is made.",
        UnderWay,
        "in time",
        _start_time,
        needs=_needs,
        kernels=compiled.motor,
    ),
    Quantity(
        "slider.contact_energy",
        "1",
        "A line of the books of that run over the work of the surface.",
        OfRun,
        "in time",
        _booked,
        needs=_needs,
        kernels=compiled.motor,
    ),
)
