"""The forces of a scene on a nonlinear chain, which starts from rest. Loads no kernels: a plan asks for it too."""

from typing import TYPE_CHECKING

from verify.beam import PointForce
from verify.errors import InputError
from verify.motion.starting import soft_start

if TYPE_CHECKING:
    from verify.scenes.scene import MotionAsk, Scene


def point_forces(scene: "Scene", who: str) -> tuple[PointForce, ...]:
    """The scene's driving forces.

    Raises InputError where it drives nothing, or by displacements, and for a [motion] that a chain from rest, undamped
    and under forces of full size does not make.
    """
    if scene.drive is None or scene.drive.kind != "force" or not scene.forces:
        raise InputError(f"{who}: the scene has no drive by forces; give it a [drive] of kind force")
    scene.refuse_devices(who)
    if scene.motion is not None:
        _check_at_once(scene.motion, who)
    return scene.forces


def _check_at_once(motion: "MotionAsk", who: str) -> None:
    """Raise InputError for another motion; forces that nobody says to act at once grow, in a motion that is given."""
    softly = soft_start("rest", motion.soft_start_periods)
    for name, value, rest in (
        ("start", motion.start, "rest"),
        ("modal_damping", motion.modal_damping or 0.0, 0.0),
        ("soft_start_periods", softly, 0.0),
    ):
        if value != rest:
            unless = " unless given" if getattr(motion, name) is None else ""
            raise InputError(
                f"motion.{name} = {value!r}{unless}: {who} is from rest, undamped, under forces of full size; "
                f"give {rest!r}"
            )
