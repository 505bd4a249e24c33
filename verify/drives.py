"""What the actuators impose: forces, or displacements, which forces are then found to hold."""

from collections.abc import Callable, Sequence

import numpy as np

from verify.beam import PointForce
from verify.errors import InputError
from verify.fields import HarmonicField, phasor

Solve = Callable[[Sequence[PointForce]], HarmonicField]


def driven_field(solve: Solve, drives: Sequence[PointForce], kind: str) -> HarmonicField:
    """The field under imposed forces, or under imposed displacements (amplitudes then in metres).

    Displacements are held by forces at the same points: the receptances of unit forces make a small system.
    Raises InputError where two displacements are imposed at one point, or one at a held end.
    """
    if kind == "force":
        return solve(drives)
    places = [drive.position for drive in drives]
    units = [solve([PointForce(position=place)]) for place in places]
    receptance = np.array([unit.deflection(places) for unit in units]).T
    if np.linalg.cond(receptance) > 1e12:
        raise InputError(
            f"drive.force positions {places}: displacements cannot be imposed at a held end or twice at one point"
        )
    held = np.linalg.solve(receptance, [phasor(drive) for drive in drives])
    return solve([
        PointForce(position=place, amplitude=float(abs(f)), phase_deg=float(np.rad2deg(np.angle(f))))
        for place, f in zip(places, held, strict=True)
    ])  # fmt: skip
