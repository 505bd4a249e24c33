"""The travelling wave as a moving picture: the beam as segments beside the elements, ellipses with their points."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import BROAD, in_units, numbers
from verify.units import unit_of, unit_over

if TYPE_CHECKING:
    from verify.models.arrays import ComplexArray
    from verify.studies.wave.figures import Ellipse, Snapshot

FRAMES = 36
"""Of one period."""
SURFACE = "#d6427a"


def phases() -> "ComplexArray":
    """e^{i omega t} of every frame, (FRAMES,); the last is that of the whole period."""
    return np.asarray(np.exp(2j * np.pi * np.arange(1, FRAMES + 1) / FRAMES))


def wave_movie(snapshots: "dict[str, Snapshot]", ellipses: "tuple[Ellipse, ...]", count: int) -> Chart:
    """One period; the exact beam broad, the chain's links between their joints, the elements as points."""
    order = sorted(snapshots, key=lambda name: MODELS[name].sized)
    along = unit_of(max(shot.x[-1] for shot in snapshots.values()))
    up = unit_over(v for shot in snapshots.values() for v in np.hypot(shot.real, shot.imaginary).tolist())
    drawn = (*(_beam(name, snapshots[name]) for name in order), _surface(ellipses))
    return Chart(
        id="wave-moving",
        title=f"The wave over one period, N = {count}",
        caption="Links of the chain are drawn straight from joint to joint, elements by their ends. Pink: points of "
        "the surface, whose motion along the beam is drawn as large as in the ellipses.",
        x=Axis(f"x, {along.name}"),
        y=Axis(f"deflection, {up.name}"),
        lines=tuple(in_units(one, along, up) for one in drawn),
        frames=tuple(f"{round(360 * (k + 1) / FRAMES)}° of a period" for k in range(FRAMES)),
        plays=True,
    )


def _beam(name: str, shot: "Snapshot") -> Line:
    model, w = MODELS[name], np.asarray(shot.real) + 1j * np.asarray(shot.imaginary)
    moves = tuple(numbers((w * phase).real) for phase in phases())
    links = name == "segment" or not model.sized
    return Line(
        name=model.title,
        colour=model.colour,
        x=numbers(shot.x),
        y=moves[-1],
        moves=moves,
        width=1.6 if model.sized else BROAD,
        marker="circle" if model.sized else "",
        size=3.0 if links else 4.5,
        joined=links,
    )


def _surface(ellipses: "tuple[Ellipse, ...]") -> Line:
    """Points of the surface on their ellipses."""
    magnified, n = magnification(ellipses), len(ellipses[0].across) - 1
    at = [round(k * n / FRAMES) % n for k in range(1, FRAMES + 1)]
    shifts = tuple(numbers(e.x + magnified * e.across[k] for e in ellipses) for k in at)
    moves = tuple(numbers(e.up[k] for e in ellipses) for k in at)
    return Line(
        name="points of the surface",
        colour=SURFACE,
        x=shifts[-1],
        y=moves[-1],
        moves=moves,
        shifts=shifts,
        marker="circle",
        size=6.0,
        joined=False,
    )


def magnification(ellipses: "tuple[Ellipse, ...]") -> float:
    """By how much motion along the beam is drawn larger, so that neighbours leave each other room."""
    across = max(max(map(abs, e.across)) for e in ellipses)
    return 0.42 * (ellipses[1].x - ellipses[0].x) / across
