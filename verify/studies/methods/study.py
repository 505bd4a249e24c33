"""Both ways of driving a travelling wave: one actuator excites, a device takes it up; or two forces a phase apart."""

from typing import TYPE_CHECKING, Annotated, TypeAlias

import msgspec
from msgspec.structs import replace

from verify.checks import check_number
from verify.errors import InputError
from verify.models.catalogue import discrete
from verify.studies.kind import Progress, Study
from verify.units import time_in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.quantities.kind import Work
    from verify.scenes.scene import Scene
    from verify.studies.methods.figures import MethodsFound
    from verify.studies.told import Found

Several: TypeAlias = Annotated[tuple[float, ...], msgspec.Meta(min_length=1, max_length=200)]


class Methods(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for both ways of driving side by side: the scene's device, and in its place a second force like the first."""

    phase_deg: float = 90.0
    """Of the second force to the first, degrees."""
    span_hz: float = 200.0
    """Below and above the drive's frequency, hertz."""
    steps: Annotated[int, msgspec.Meta(ge=3, le=2001)] = 81
    """Frequencies of the charts."""
    factors: Several = (0.25, 0.35, 0.5, 0.7, 0.85, 1.0, 1.2, 1.4, 2.0, 2.8, 4.0)
    """By which the device's dashpot, its spring and mass, and the second force are off."""
    load_position: float | None = None
    """Of a load between force and device, metres from the left end; in the middle between them unless given."""
    load_mass: Several = (1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3)
    """Kilograms that ride on the beam there."""
    load_dashpot: Several = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
    """Dashpots that brake it there, N s/m."""
    modes: tuple[int, int] | None = None
    """Of the lumped picture; the neighbours around the drive's frequency unless given."""
    count: Annotated[int, msgspec.Meta(ge=1)] = 196
    """Segments and elements on which both are solved too."""
    duration: float = 0.05
    """Of the slider's run, seconds, where the scene has a slider."""

    def __post_init__(self) -> None:
        check_number("methods.phase_deg", self.phase_deg, "degrees")
        check_number("methods.span_hz", self.span_hz, "hertz", above=0)
        check_number("methods.duration", self.duration, "seconds", above=0)
        for name in ("factors", "load_mass", "load_dashpot"):
            for value in getattr(self, name):
                check_number(f"methods.{name}", value, "each", above=0)


class MethodsStudy(Study[Methods, "MethodsFound"]):
    """The exact field of both over frequency, load and detuning; every model at the drive; the slider on both."""

    name, section, work = "methods", Methods, "harmonic"
    title = "Two ways of driving the wave"
    devices, slides = True, True

    def check_on(self, asked: Methods, scene: "Scene") -> None:
        """Raise InputError without one force and one device across on a uniform beam."""
        if len(scene.forces) != 1 or len(scene.devices) != 1:
            raise InputError(
                f"methods takes a [drive] with one force and one device, and finds {len(scene.forces)} and "
                f"{len(scene.devices)}: give both"
            )
        (force,), (device,) = scene.forces, scene.devices
        if not device.across or device.turning or device.amplitude:
            raise InputError(
                f"methods puts a second force in place of the device at {device.position:g} m: give it stiffness, mass "
                "or dashpot alone"
            )
        if not scene.beam.uniform or scene.beam.tension or scene.beam.foundation:
            raise InputError(f"methods reads waves of one length: leave beam.{scene.beam.added[0]} out")
        assert scene.drive is not None
        if asked.span_hz >= scene.drive.frequency_hz:
            raise InputError(
                f"methods.span_hz = {asked.span_hz!r} is not below drive.frequency_hz = {scene.drive.frequency_hz!r}: "
                "give less"
            )
        low, high = sorted((force.position, device.position))
        if asked.load_position is not None and not low < asked.load_position < high:
            raise InputError(
                f"methods.load_position = {asked.load_position!r} does not lie between force and device: give one "
                f"between {low!r} and {high!r} m"
            )

    def check_run(self, asked: Methods, scene: "Scene") -> None:
        """Raise InputError for a resonance, a window without waves, or a wave that is too short for the parts."""
        from verify.exact.harmonic import check_closed_form
        from verify.waves.lumped import TwoModes
        from verify.waves.measures import middle_half
        from verify.waves.window import check_window

        assert scene.drive is not None
        hertz = scene.drive.frequency_hz
        check_closed_form(scene.beam, scene.forces, hertz)
        places = [scene.forces[0].position, scene.devices[0].position]
        check_window(scene.beam, places, hertz, middle_half(scene.beam))
        for model in discrete("solve_harmonic", scene.beam):
            model.check_carried(scene.beam, asked.count, hertz)
        if asked.modes is not None:
            TwoModes(beam=scene.beam, modes=asked.modes)

    def works_on(self, asked: Methods, scene: "Scene") -> "tuple[Work, ...]":
        """Fields, and steps of a slider where the scene has one."""
        return ("harmonic", "in time") if scene.slider else ("harmonic",)

    def models(self, asked: Methods, scene: "Scene") -> tuple[str, ...]:
        """All that can."""
        return tuple(model.name for model in discrete("solve_harmonic"))

    def told(self, asked: Methods, scene: "Scene") -> str:
        """How many fields, and runs."""
        titles = " and ".join(model.title for model in discrete("solve_harmonic", scene.beam))
        rides = f", the slider for {time_in_words(asked.duration)} on each" if scene.slider else ""
        return f"exact fields over {2 * asked.span_hz:g} Hz, load and detuning, {titles} at N = {asked.count}{rides}"

    def n_steps(self, asked: Methods, scene: "Scene") -> int:
        """Frequencies, detuning, load, models, rides."""
        return 5 if scene.slider else 4

    def n_motions(self, asked: Methods, scene: "Scene") -> int:
        """Both at three frequencies, with a slider."""
        return 6 if scene.slider else 0

    def kernels(self, asked: Methods, scene: "Scene") -> "Iterable[Call]":
        """The slider's, on a field that does not feel it."""
        if scene.slider is None:
            return ()
        from verify.motion import warm as motion
        from verify.motor import warm as motor

        slider = replace(scene.slider, coupling="one-way")
        return motion.on_beam(slider.law, slider.coupling) if slider.contact is None else motor.on_beam(slider)

    def run(
        self, asked: Methods, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "MethodsFound":
        """See `methods_study`."""
        from verify.studies.methods.figures import methods_study

        return methods_study(scene, bench, asked, step)
