"""Whether the beam feels a slider that may leave it: what all that presses it on moves the surface by."""

from collections.abc import Sequence

import numpy as np

from verify.beam import Beam
from verify.models.time_basis import TimeBasis
from verify.models.underfoot import standing_at
from verify.motion.carried import yielding_at
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
    return _over_drive(slider.load * abs(receptance), rub, moved, beam.surface_distance * omega * turned)


def _over_drive(across: float, rub: float, moved: float, speed: float) -> tuple[float, float | None]:
    """Metres across and m/s along, over those of the drive: infinite, and None, where it does not move the surface."""
    return float(across / moved) if moved else np.inf, float(rub / speed) if speed else None


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


def in_words(coupling: Coupling, together: bool = False) -> str:
    """Both sizes; `together` are those of several sliders."""
    whose, where, most = ("the sliders", " under any of them", "at most ") if together else ("the slider", "", "")
    if np.isinf(coupling.normal_size):
        return f"the drive does not move the surface under {'one of ' * together}{whose}"
    across, along = f"{most}{coupling.normal_size:.1e} of its motion", ""
    if coupling.friction_size is not None:
        along = f", {'their' if together else 'its'} friction by {most}{coupling.friction_size:.1e} of its speed"
    return f"all that presses {whose} on moves the surface{where} by {across}{along}"


def coupling_of(request: Request, placed: Sequence[Placed], stage: Stage, basis: TimeBasis | None) -> Coupling:
    """One-way or two-way by size, unless the sliders say which: what all their loads move, over what the drive moves.

    Each of the two sizes under the slider where it is most.
    """
    found = _sizes_of_all(request, placed, stage, basis)
    along = None if any(size is None for _, size in found) else max(size or 0.0 for _, size in found)
    return coupled(placed[0].slider, max(size for size, _ in found), along)


def _sizes_of_all(
    request: Request, placed: Sequence[Placed], stage: Stage, basis: TimeBasis | None
) -> list[tuple[float, float | None]]:
    """Under every slider what all that presses all of them on moves the surface by, over its own motion."""
    beam, omega = standing_at(request.beam, placed[0].start), request.omega
    places = np.array([one.start for one in placed])
    across, rub = np.zeros(len(placed)), np.zeros(len(placed))
    for one in placed:
        lifted, turned = yielding_at(request, one.start, places, basis)
        across += one.slider.load * np.abs(lifted)
        rub += [friction_speed(one.slider, beam, omega, complex(turn)) for turn in turned]
    moved, turned = (np.hypot(*stage.drive_shapes(places, d)[:2]) for d in (0, 1))
    speeds = beam.surface_distance * omega * turned
    return [_over_drive(*each) for each in zip(across, rub, moved, speeds, strict=True)]
