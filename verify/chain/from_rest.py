"""The forces of a scene on a nonlinear chain, which starts from rest. Loads no kernels: a plan asks for it too."""

from typing import TYPE_CHECKING

from verify.beam import PointForce
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


def point_forces(scene: "Scene", who: str) -> tuple[PointForce, ...]:
    """The scene's driving forces.

    Raises InputError where it drives nothing, or by displacements, and for a [motion] that a chain from rest, undamped
    and under forces of full size does not make.
    """
    if scene.drive is None or scene.drive.kind != "force" or not scene.forces:
        raise InputError(f"{who}: the scene has no drive by forces; give it a [drive] of kind force")
    scene.refuse_devices(who)
    if scene.motion is not None:
        for name, rest in (("start", "rest"), ("soft_start_periods", 0.0), ("modal_damping", 0.0)):
            if (value := getattr(scene.motion, name)) not in (rest, None):
                raise InputError(
                    f"motion.{name} = {value!r}: {who} is from rest, undamped, under forces of full size; give {rest!r}"
                )
    return scene.forces
