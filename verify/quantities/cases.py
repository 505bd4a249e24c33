"""What arguments and a scene describe together: the drive, and the driven beam as one case."""

from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.beam import Beam, PointForce, check_frequency
from verify.errors import InputError
from verify.quantities.kind import AtFrequency, DriveArguments
from verify.quantities.wave_arguments import Driven, Receptance, Sensitivity, WaveOrder

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.waves.case import DrivenCase


def drive_frequency(a: AtFrequency, scene: "Scene") -> float:
    """The frequency given, else the scene's. Raises InputError where there is none."""
    given = a.frequency_hz if a.frequency_hz is not None else scene.drive.frequency_hz if scene.drive else None
    if given is None:
        raise InputError("frequency_hz is missing and the scene has no drive: give frequency_hz in hertz")
    check_frequency("frequency_hz", float(given), scene.beam)
    return float(given)


def drive_forces(a: DriveArguments, scene: "Scene") -> tuple[PointForce, ...]:
    """The scene's forces with the position and phase given instead of theirs. Raises InputError."""
    forces = list(scene.forces)
    if not forces:
        raise InputError("the scene has no drive.force: add force = [{ position = ... }] to its [drive]")
    if (a.position is not None or a.phase_deg is not None) and len(forces) != 2:
        raise InputError(f"position and phase_deg are for two forces, the scene has {len(forces)}")
    if a.position is not None:
        if not 0 <= a.position <= scene.beam.length:
            raise InputError(
                f"position = {a.position!r} lies off the beam: give a distance between 0 and {scene.beam.length!r} m"
            )
        forces = [replace(forces[0], position=a.position), replace(forces[1], position=scene.beam.length - a.position)]
    if a.phase_deg is not None:
        forces[1] = replace(forces[1], phase_deg=a.phase_deg)
    return tuple(forces)


def driven_beam(a: Driven | Receptance | Sensitivity, scene: "Scene") -> Beam:
    """The scene's beam, with the loss factor given instead of its own."""
    return scene.beam if a.loss_factor is None else replace(scene.beam, loss_factor=a.loss_factor)


def drive_kind(a: Driven | Sensitivity, scene: "Scene") -> str:
    """What is imposed, force or displacement: as given, else as in the scene."""
    return str(a.drive or (scene.drive.kind if scene.drive else "force"))


def _theory_of(a: Sensitivity) -> tuple[tuple[str, str], ...]:
    return () if a.theory == "euler-bernoulli" else (("theory", a.theory),)


def driven_case(a: Driven | Sensitivity, scene: "Scene") -> "DrivenCase":
    """The driven beam that arguments describe. Raises InputError."""
    from verify.waves.case import DrivenCase

    return DrivenCase(
        beam=driven_beam(a, scene),
        model=a.model,
        count=None if isinstance(a, WaveOrder) else a.count,
        forces=drive_forces(a, scene),
        frequency_hz=drive_frequency(a, scene),
        kind=drive_kind(a, scene),
        settings=a.settings if isinstance(a, Driven) else _theory_of(a),
        devices=scene.devices,
    )
