"""What of a driven figure is refused before anything is solved: for its drive, window, slider, time or start.

Each is a quantity's `needs`: no modes of others, but a sentence where a plan can know that the figure will fail.
"""

from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.quantities.cases import drive_forces, drive_frequency, driven_case
from verify.quantities.kind import AtFrequency
from verify.quantities.motion_arguments import InTime, SliderInTime, Steady
from verify.quantities.wave_arguments import AxisRatio, BestFrequency, Driven, InWindow, Sensitivity, WaveOrder

if TYPE_CHECKING:
    from verify.quantities.chain_arguments import FromRest, Ridden
    from verify.scenes.scene import Scene
    from verify.waves.case import DrivenCase


def at_frequency(a: AtFrequency, scene: "Scene") -> tuple[()]:
    """Raise InputError where there is no frequency."""
    drive_frequency(a, scene)
    return ()


def driven(a: Driven | Sensitivity, scene: "Scene") -> tuple[()]:
    """Raise InputError for a field that is not solved, or a window in which no waves are told apart."""
    case = driven_case(a, scene)
    case.check_devices()
    if not isinstance(a, BestFrequency):  # whose search passes over a resonance
        _check_closed_form(case)
    counts = a.counts if isinstance(a, WaveOrder) else (case.count,)
    for count in counts if case.beam.uniform and not isinstance(a, Sensitivity) else ():
        if count is not None:
            MODELS.named(case.model).check_carried(case.beam, count, case.frequency_hz)
    if isinstance(a, Sensitivity):
        from verify.waves.operating_point import check_two

        check_two(case)
    _check_window(a, case)
    return ()


def _check_window(a: Driven | Sensitivity, case: "DrivenCase") -> None:
    """Raise InputError for a window in which waves are not told apart, of a figure that takes one."""
    if isinstance(a, Sensitivity):
        given = None
    elif isinstance(a, InWindow) and not _at_a_place(a):
        given = a.window
    else:
        return
    from verify.waves.measures import middle_half
    from verify.waves.window import check_window

    places = [force.position for force in case.forces]
    places += [device.position for device in case.devices if device.across]
    turning = [device.position for device in case.devices if device.turning]
    theory = dict(case.settings).get("theory", "euler-bernoulli")
    check_window(case.beam, places, case.frequency_hz, given or middle_half(case.beam), turning, theory)


def _at_a_place(a: InWindow) -> bool:
    """Whether the figure is read at one place, without a window."""
    return (isinstance(a, AxisRatio) and a.x is not None) or (isinstance(a, WaveOrder) and a.of == "deflection")


def _check_closed_form(case: "DrivenCase") -> None:
    """Raise InputError where the exact field is a closed form that says so: an undamped resonance, say."""
    plain = case.beam.uniform and "theory" not in dict(case.settings) and not case.devices
    if case.model == "analytic" and case.kind == "force" and plain:
        from verify.exact.harmonic import check_closed_form

        check_closed_form(case.beam, case.forces, case.frequency_hz)


def in_time(a: InTime, scene: "Scene") -> tuple[()]:
    """Raise InputError for a run that is not begun: without a time, a slider or forces, or longer in growing."""
    from verify.quantities.simulated import motion_case, slider_of, steps_per_period

    case = motion_case(a, scene)
    slider = slider_of(a, scene) if isinstance(a, SliderInTime) else None
    step = a.step if isinstance(a, SliderInTime) else None
    case.check(slider=slider, step=step, steps_per_period=steps_per_period(scene))
    if case.model == "analytic" and case.start == "rest":
        from verify.exact.in_time import check_beam

        check_beam(case.beam)
    elif case.model == "analytic" and case.modal_damping is None and case.beam.uniform:
        from verify.exact.harmonic import check_closed_form

        check_closed_form(case.beam, case.forces, case.frequency_hz)
    return ()


def steady(a: Steady, scene: "Scene") -> tuple[()]:
    """Raise InputError for a scene without what a slider's size is made of."""
    from verify.quantities.simulated import check_forced, slider_of

    check_forced(scene, "a slider's beam")
    slider_of(a, scene).start_on(scene.beam)
    drive_frequency(a, scene)
    drive_forces(a, scene)
    return ()


def rideable(a: "Ridden", scene: "Scene") -> tuple[()]:
    """Raise InputError for a beam that is no nonlinear chain, a scene without slider, forces or time."""
    from verify.chain.from_rest import point_forces
    from verify.quantities.simulated import slider_of

    slider_of(a, scene)
    if a.soft_start_periods is None:
        point_forces(scene, "a slider on the nonlinear chain")
    ride_time(a, scene)
    return buildable(a, scene)


def ride_time(a: "Ridden", scene: "Scene") -> float:
    """Seconds. Raises InputError where nobody says."""
    time = a.time if a.time is not None or scene.motion is None else scene.motion.duration
    if time is None:
        raise InputError("time is missing and the scene has no [motion]: give time in seconds")
    return time


def pushable(a: "FromRest", scene: "Scene") -> tuple[()]:
    """Raise InputError for a beam that is no nonlinear chain, or a scene without forces from rest."""
    from verify.chain.from_rest import point_forces

    point_forces(scene, "chain.transient_deflection")
    return buildable(a, scene)


def buildable(a: object, scene: "Scene") -> tuple[()]:
    """Raise InputError for a beam that is no nonlinear chain."""
    from verify.chain.system import check_buildable

    check_buildable(scene.beam)
    return ()
