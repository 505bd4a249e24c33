"""Named figures of a motor: a slider that may leave the beam, held at a speed, without load, under way."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import compiled
from verify.quantities.cases import drive_forces, drive_frequency
from verify.quantities.kind import Quantity
from verify.quantities.motor_arguments import AtSpeedOf, ForceAt, FreeRun, Held, Motor, OfRun, UnderWay, slider_on_feet

if TYPE_CHECKING:
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Reading
    from verify.scenes.scene import Scene


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
    """Raises InputError where the surface gives nothing along the beam, or does no work on the load."""
    if found.efficiency is None:
        why = "the load drives the slider" if found.given > 0.0 else "the slider drives the surface"
        raise InputError(f"speed = {found.speed!r} m/s: there {why}, give a speed in between")
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
    from verify.motor.figures import mean_speed, started_of

    run, speed = _free(a, scene, bench), _free_speed(a, scene, bench)
    spread, first = mean_speed(run, a.last)[1], float(run.speed[0])
    if abs(speed - first) <= spread:
        gives = run.slider is not None and run.slider.contact is not None and run.slider.contact.tangential_stiffness
        other = ", or its contact another tangential_stiffness" if gives else ""
        raise InputError(
            f"periods = {a.periods!r} with last = {a.last!r}: the slider begins at {first:.6g} m/s and comes to "
            f"{speed:.2g} m/s, the same within the {spread:.2g} m/s by which halves of its end differ: no way takes a "
            f"time; give slider.speed another start{other}"
        )
    found = started_of(run, speed)
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
