"""Whether the beam feels a slider that may leave it: what all that presses it on moves the surface by."""

from collections.abc import Sequence

import numpy as np

from verify.beam import Beam
from verify.models.time_basis import TimeBasis
from verify.models.underfoot import standing_at
from verify.motion.carried import yielding
from verify.motion.contact import FELT, Coupling, friction_speed
from verify.motion.request import Request
from verify.motion.surface import Stage
from verify.motor.feet import Placed
from verify.slider import Slider


def sizes(
    slider: Slider, beam: Beam, omega: float, moved: float, turned: float, receptance: complex, turning: complex
) -> tuple[float, float | None]:
    """What the slider's whole load moves the surface by, over what the drive moves: (across, by friction along).

    `moved` (metres) and `turned` are the drive's amplitudes of deflection and slope under it, `receptance` is the
    beam's there, G(x, x) in m/N, `turning` its slope under a unit couple, rad/(N m). Along, None where the drive does
    not turn the surface. The surface is that of the beam's own section: give the beam that is `standing_at` there.
    """
    rub = friction_speed(slider, beam, omega, turning)
    across = slider.load * abs(receptance) / moved if moved else np.inf
    return float(across), float(rub / (beam.surface_distance * omega * turned)) if turned else None


def coupled(slider: Slider, across: float, along: float | None) -> Coupling:
    """One-way or two-way by these sizes, unless the slider says which."""
    choice = slider.coupling
    return Coupling(
        two_way=choice == "two-way" if choice != "auto" else along is None or max(along, across) > FELT,
        friction_size=along,
        normal_size=across,
        normal="held",
        forced=choice != "auto",
    )


def in_words(coupling: Coupling) -> str:
    """Both sizes."""
    if np.isinf(coupling.normal_size):
        return "the drive does not move the surface under the slider"
    along = "" if coupling.friction_size is None else f", its friction by {coupling.friction_size:.1e} of its speed"
    return f"all that presses the slider on moves the surface by {coupling.normal_size:.1e} of its motion{along}"


def coupling_of(request: Request, placed: Sequence[Placed], stage: Stage, basis: TimeBasis | None) -> Coupling:
    """One-way or two-way by size, unless the sliders say which: what their load moves, over what the drive moves."""
    found = [_load_sizes(request, one, stage, basis) for one in placed]
    across = max(size for size, _ in found)
    along = None if any(size is None for _, size in found) else max(size or 0.0 for _, size in found)
    return coupled(placed[0].slider, across, along)


def _load_sizes(request: Request, one: Placed, stage: Stage, basis: TimeBasis | None) -> tuple[float, float | None]:
    """What all that presses a slider on moves the surface by, over its own motion: (across, by friction along)."""
    beam, omega = standing_at(request.beam, one.start), request.omega
    slider, x = one.slider, np.array([one.start])
    moved, turned = (float(np.hypot(*stage.drive_shapes(x, d)[:2, 0])) for d in (0, 1))
    return sizes(slider, beam, omega, moved, turned, *yielding(request, one.start, basis))
