"""Simulations that arguments and a scene describe, kept on the bench."""

from typing import TYPE_CHECKING

from msgspec.structs import asdict, replace

from verify.beam import PointForce
from verify.errors import InputError, written
from verify.models.catalogue import EXACT_MODES, MODELS
from verify.motion.case import MotionCase
from verify.motion.request import STEPS_PER_PERIOD
from verify.motion.result import Motion
from verify.motion.starting import soft_start
from verify.quantities.cases import drive_forces, drive_frequency
from verify.quantities.kind import Arguments
from verify.quantities.motion_arguments import (
    CouplingSize,
    DeflectionAt,
    InTime,
    LoadedDeflection,
    SliderInTime,
    SliderOrder,
    Steady,
)
from verify.slider import Slider, changed

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from verify.judge.workbench import Workbench
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import Scene

MODES = EXACT_MODES
"""Of the exact beam from rest, unless asked for otherwise."""
_OWN = {
    "mu": "mu",
    "slope": "slope",
    "mass": "mass",
    "law": "law",
    "coupling": "coupling",
    "line": "line",
    "kinematics": "kinematics",
    "normal": "normal",
    "preload": "preload",
    "slider_position": "position",
    "slider_speed": "speed",
}
"""Which of the slider's own fields an argument stands for."""


def slider_of(a: Arguments, scene: "Scene") -> Slider:
    """The scene's slider with what is given instead. Raises InputError where there is none, or one that may leave."""
    if scene.slider is None:
        raise InputError("the scene has no slider: add [slider] with mass and mu")
    scene.slider.check_stays()
    given = asdict(a)
    return changed(scene.slider, **{own: given[name] for name, own in _OWN.items() if given.get(name) is not None})


def motion_case(a: InTime, scene: "Scene") -> MotionCase:
    """The driven beam in time that arguments describe. Raises InputError."""
    motion = scene.motion
    time = a.time if a.time is not None else (motion.duration if motion else None)
    if time is None:
        raise InputError("time is missing and the scene has no [motion]: give time in seconds")
    check_forced(scene, "motion in time")
    start = a.start or (motion.start if motion else "rest")
    soft = a.soft_start_periods
    if soft is None:
        soft = soft_start(start, motion.soft_start_periods if motion and start == "rest" else None)
    forces = drive_forces(a, scene)
    return MotionCase(
        beam=scene.beam,
        forces=forces if a.force is None else tuple(replace(one, amplitude=a.force) for one in forces),
        frequency_hz=drive_frequency(a, scene),
        duration=time,
        model=a.model,
        count=a.count,
        modes=a.modes,
        start=start,
        soft_start_periods=soft,
        modal_damping=a.modal_damping if a.modal_damping is not None else (motion.modal_damping if motion else None),
    )


def check_forced(scene: "Scene", what: str) -> None:
    """Raise InputError for a drive by displacements, or with devices, where forces alone are taken."""
    scene.refuse_devices(what)
    if scene.drive is not None and scene.drive.kind != "force":
        raise InputError(f"drive.kind = {scene.drive.kind!r}: {what} takes imposed forces, give kind = 'force'")


def steps_per_period(scene: "Scene") -> int:
    """At least so many steps of a slider in a period of the drive."""
    return scene.motion.steps_per_period if scene.motion else STEPS_PER_PERIOD


def turned(forces: "Sequence[PointForce]") -> "tuple[PointForce, ...]":
    """All phases turned round, and with them the wave."""
    return tuple(replace(force, phase_deg=-force.phase_deg) for force in forces)


def with_slider(
    a: SliderInTime,
    scene: "Scene",
    bench: "Workbench",
    *,
    back: bool = False,
    at: tuple[float, ...] = (),
    ledger: bool = False,
) -> Motion:
    """The slider's run, solved once; `back` with all phases turned round, `ledger` booked.

    Raises InputError where it does not reach its end.
    """
    case, slider = motion_case(a, scene), slider_of(a, scene)
    case = replace(case, forces=turned(case.forces)) if back else case
    steps = steps_per_period(scene)
    key = ("slider", case, slider, a.step, steps, at, ledger)
    if key not in bench.motions:
        bench.motions[key] = case.run(
            slider=slider,
            step=a.step,
            steps_per_period=steps,
            samples=2,
            at=at,
            ledger=ledger,
            progress=bench.tell,
            patient=False,
        )
    found = bench.motions[key]
    _check_ended(found, case.duration)
    _check_stands(found)
    _check_modes(a, case.start, bool(found.coupling and found.coupling.two_way))
    return found


def _check_ended(found: Motion, duration: float) -> None:
    """Raise InputError for a run that did not reach its end, and KeyboardInterrupt for one that was broken off."""
    if found.statistics.interrupted:
        raise KeyboardInterrupt
    if not found.statistics.finished:
        raise InputError(
            f"the slider {found.statistics.stopped} after {found.end.time:.6g} s of {written(duration)} s: "
            "shorten time or start it elsewhere"
        )


def _check_stands(found: Motion) -> None:
    """Raise InputError for a slider whose way halving the step does not make stand."""
    from verify.motion.judged_step import KNOWN

    part, dt = found.statistics.moved, found.statistics.step_s
    if part is not None and part > KNOWN:
        raise InputError(
            f"step, which is not given: in steps of {dt:.3g} s the slider's way is not known to {100.0 * KNOWN:g} %, "
            f"halving them last moved it by {100.0 * part:.2g} %; give a shorter step, and halve it until the figure "
            "stands, or a shorter time"
        )


def _check_modes(a: InTime, start: str, felt: bool) -> None:
    """Raise InputError for a number of modes where no mode is taken."""
    if a.modes is not None and start == "steady" and not felt:
        raise InputError(f"modes = {a.modes!r}: a steady beam that feels no slider is one field, leave it out")


def without_slider(a: DeflectionAt, scene: "Scene", bench: "Workbench") -> Motion:
    """The beam alone at the times 0 and `time`, at x."""
    case = motion_case(a, scene)
    _check_modes(a, case.start, felt=False)
    key = ("beam", case, a.x)
    if key not in bench.motions:
        bench.motions[key] = case.run(at=[a.x])
    return bench.motions[key]


def _fields(a: Steady, scene: "Scene") -> "tuple[Slider, float, float, HarmonicField, HarmonicField]":
    """(slider, its place, Hz, driven field, field under a unit force at its place). Raises InputError."""
    check_forced(scene, "a slider's beam")
    slider, frequency, model = slider_of(a, scene), drive_frequency(a, scene), MODELS.named(a.model)
    place = slider.start_on(scene.beam)
    drive = model.solve_harmonic(scene.beam, drive_forces(a, scene), frequency, a.count)
    unit = model.solve_harmonic(scene.beam, (PointForce(position=place),), frequency, a.count)
    return slider, place, frequency, drive, unit


def coupling_size(a: CouplingSize, scene: "Scene") -> float:
    """The size of a slider's friction or of its inertia at its place, by one model. Raises InputError."""
    from verify.motion.contact import coupling_of, surface_speed
    from verify.motion.turning import couple, turned_by

    slider, x, frequency, drive, unit = _fields(a, scene)
    turned = MODELS.named(a.model).solve_harmonic(scene.beam, couple(scene.beam, x, frequency), frequency, a.count)
    yields = complex(unit.deflection([x])[0]), turned_by(turned, x)
    found = coupling_of(slider, scene.beam, frequency, surface_speed(drive, x), *yields)
    if a.of == "normal":
        return found.normal_size
    if found.friction_size is None:
        raise InputError(f"slider.position = {x!r} m: the drive does not move the surface there, choose another")
    return found.friction_size


def loaded_deflection(a: LoadedDeflection, scene: "Scene") -> complex:
    """At x, of the steady beam that carries the slider's mass at rest, by one model. Raises InputError.

    W = W_0 + m omega^2 W(x_s) G(x, x_s), and W(x_s) = W_0(x_s) / (1 - m omega^2 G(x_s, x_s)).
    """
    slider, place, _, drive, unit = _fields(a, scene)
    inertia = slider.mass * drive.omega**2
    under = drive.deflection([place])[0] / (1.0 - inertia * unit.deflection([place])[0])
    return complex(drive.deflection([a.x])[0] + inertia * under * unit.deflection([a.x])[0])


def slider_order(a: SliderOrder, scene: "Scene", bench: "Workbench") -> float:
    """Observed order of the slider's displacement. Raises InputError.

    Over counts against the exact beam, over steps against one sixteen times finer than the finest.
    """
    from verify.judge.compare import relative_error, settled_order

    given = {name: getattr(a, name) for name in SliderInTime.__struct_fields__}

    def displacement(**other: "Any") -> float:
        return with_slider(SliderInTime(**{**given, **other}), scene, bench).displacement

    if a.counts is not None:
        exact = displacement(model="analytic", count=None)
        found = [displacement(count=n, modes=None) for n in a.counts]
        return settled_order(a.counts, [relative_error(one, exact) for one in found])
    steps = a.steps or ()
    exact = displacement(step=min(steps) / 16.0)
    errors = [relative_error(displacement(step=dt), exact) for dt in steps]
    return settled_order([1.0 / dt for dt in steps], errors, told=f"steps = {list(steps)}")
