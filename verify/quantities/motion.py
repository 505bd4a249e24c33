"""Named figures in time: friction laws on their own, the slider on a beam, the beam itself."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.motion.figures import RUN_FIGURES, RunFigure
from verify.quantities import beforehand, compiled
from verify.quantities.kind import Quantity
from verify.quantities.motion_arguments import (
    CouplingSize,
    Creep,
    DeflectionAt,
    FreeDecay,
    LoadedDeflection,
    OnBelt,
    OnWave,
    Oscillator,
    SliderBooked,
    SliderDeflection,
    SliderInTime,
    SliderOrder,
)

if TYPE_CHECKING:
    from verify.motion.result import Ledger
    from verify.scenes.scene import Scene


def _free_decay(a: FreeDecay, scene: "Scene", bench: Workbench) -> float:
    from verify.motion.rigid_surface import free_decay

    return free_decay(a.mu, a.slope, a.speed, a.time, a.gravity)


def _creep_speed(a: Creep, scene: "Scene", bench: Workbench) -> float:
    from verify.motion.rigid_surface import creep_speed

    return creep_speed(a.mu, a.slope, a.pull, a.gravity)


def _belt(which: int) -> Callable[[OnBelt, "Scene", Workbench], float]:
    """Stick time (0) or slip time (1)."""

    def evaluate(a: OnBelt, scene: "Scene", bench: Workbench) -> float:
        from verify.motion.rigid_surface import stick_slip_times

        return stick_slip_times(a.mass, a.stiffness, a.static, a.kinetic, a.speed)[which]

    return evaluate


def _decrement(a: Oscillator, scene: "Scene", bench: Workbench) -> float:
    from verify.motion.rigid_surface import coulomb_decrement

    return coulomb_decrement(a.mass, a.stiffness, a.force)


def _terminal_speed(a: OnWave, scene: "Scene", bench: Workbench) -> float:
    from verify.motion.pure_wave import terminal_speed
    from verify.quantities.cases import drive_frequency
    from verify.slider import Slider

    slider = Slider(mass=1.0, mu=a.mu, slope=a.slope, kinematics=a.kinematics, gravity=a.gravity)
    return terminal_speed(scene.beam, slider, a.amplitude, drive_frequency(a, scene))


def _slider(figure: RunFigure) -> Callable[[SliderInTime, "Scene", Workbench], float]:
    """One figure of the slider's run."""

    def evaluate(a: SliderInTime, scene: "Scene", bench: Workbench) -> float:
        from verify.quantities.simulated import with_slider

        run = with_slider(a, scene, bench)
        return figure.of(run, with_slider(a, scene, bench, back=True) if figure.turned else None)

    return evaluate


def _deflection_under(a: SliderDeflection, scene: "Scene", bench: Workbench) -> float:
    from verify.quantities.simulated import with_slider

    return float(with_slider(a, scene, bench, at=(a.x,)).deflection[-1, 0])


def _books(a: SliderInTime, scene: "Scene", bench: Workbench) -> "Ledger":
    from verify.quantities.simulated import with_slider

    books = with_slider(a, scene, bench, ledger=True).ledger
    if books is None:
        raise InputError("start = 'steady': a beam in its steady state is not booked, give start = 'rest'")
    return books


def _booked(a: SliderBooked, scene: "Scene", bench: Workbench) -> float:
    return float(getattr(_books(a, scene, bench), a.of))


def _imbalance(a: SliderInTime, scene: "Scene", bench: Workbench) -> float:
    books = _books(a, scene, bench)
    return abs(books.residual) / books.work_in


def _loaded(a: LoadedDeflection, scene: "Scene", bench: Workbench) -> complex:
    from verify.quantities.simulated import loaded_deflection

    return loaded_deflection(a, scene)


def _coupling_size(a: CouplingSize, scene: "Scene", bench: Workbench) -> float:
    from verify.quantities.simulated import coupling_size

    return coupling_size(a, scene)


def _order(a: SliderOrder, scene: "Scene", bench: Workbench) -> float:
    from verify.quantities.simulated import slider_order

    return slider_order(a, scene, bench)


def _deflection(a: DeflectionAt, scene: "Scene", bench: Workbench) -> float:
    from verify.quantities.simulated import without_slider

    return float(without_slider(a, scene, bench).deflection[-1, 0])


MOTION_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "friction.free_decay",
        "m/s",
        "Speed left after a time on a surface at rest, tanh friction.",
        FreeDecay,
        "in time",
        _free_decay,
        kernels=compiled.on_belt("tanh"),
    ),
    Quantity(
        "friction.creep_speed",
        "m/s",
        "Speed under a constant pull below the friction's limit, tanh friction.",
        Creep,
        "in time",
        _creep_speed,
        kernels=compiled.on_belt("tanh"),
    ),
    Quantity(
        "friction.belt_stick_time",
        "s",
        "Time a spring-held mass rides on a belt, Coulomb friction.",
        OnBelt,
        "in time",
        _belt(0),
        kernels=compiled.on_belt("coulomb"),
    ),
    Quantity(
        "friction.belt_slip_time",
        "s",
        "Time it slips back.",
        OnBelt,
        "in time",
        _belt(1),
        kernels=compiled.on_belt("coulomb"),
    ),
    Quantity(
        "friction.coulomb_decrement",
        "m",
        "Amplitude an oscillator with Coulomb friction loses in a cycle.",
        Oscillator,
        "in time",
        _decrement,
        kernels=compiled.on_belt("coulomb"),
    ),
    Quantity(
        "slider.terminal_speed",
        "m/s",
        "Settled mean speed along +x on a pure wave towards +x.",
        OnWave,
        "in time",
        _terminal_speed,
        needs=beforehand.at_frequency,
        kernels=compiled.on_wave,
    ),
    *(
        Quantity(
            name,
            figure.unit,
            figure.summary,
            SliderInTime,
            "in time",
            _slider(figure),
            needs=beforehand.in_time,
            kernels=compiled.slid,
        )
        for name, figure in RUN_FIGURES.items()
    ),
    Quantity(
        "slider.order",
        "1",
        "Observed order of the slider's displacement in the size or in the step, refused where it is not settled.",
        SliderOrder,
        "in time",
        _order,
        needs=beforehand.in_time,
        kernels=compiled.slid,
    ),
    Quantity(
        "slider.deflection",
        "m",
        "Of the beam at a place and time while the slider is on it.",
        SliderDeflection,
        "in time",
        _deflection_under,
        needs=beforehand.in_time,
        kernels=compiled.slid,
    ),
    Quantity(
        "slider.energy",
        "J",
        "A line of the books of the driven beam and its slider, from rest.",
        SliderBooked,
        "in time",
        _booked,
        needs=beforehand.in_time,
        kernels=compiled.slid,
    ),
    Quantity(
        "slider.imbalance",
        "1",
        "What the books of beam and slider miss over the work of the forces, from rest.",
        SliderInTime,
        "in time",
        _imbalance,
        needs=beforehand.in_time,
        kernels=compiled.slid,
    ),
    Quantity(
        "slider.coupling_size",
        "1",
        "What of the slider the beam may feel: full friction, or its inertia.",
        CouplingSize,
        "harmonic",
        _coupling_size,
        needs=beforehand.steady,
    ),
    Quantity(
        "slider.loaded_deflection",
        "m",
        "Complex, of the steady beam that carries the slider's mass at rest.",
        LoadedDeflection,
        "harmonic",
        _loaded,
        needs=beforehand.steady,
    ),
    Quantity(
        "motion.deflection",
        "m",
        "Of the driven beam at a place and time.",
        DeflectionAt,
        "in time",
        _deflection,
        needs=beforehand.in_time,
    ),
)
