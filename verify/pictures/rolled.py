"""A chain of a scene's beam rolled up by an end moment, beside the exact circle, at true scale."""

import dataclasses

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.pictures.parts import chain_solids, support_solids
from verify.pictures.picture import Label, Picture, Trace
from verify.pictures.rows import Asked
from verify.pictures.sizes import drawn_section
from verify.scenes.scene import Scene

COUNT, FRAMES = 20, 36
"""Links where nobody says; and steps of the moment."""
TURNS = (0.125, 0.25, 0.5, 0.75, 1.0)
"""In one still picture."""


def rolled(scene: Scene, asked: Asked) -> Picture:
    """A cantilever of the scene's beam under an end moment up to 2 pi EI / L, which closes it, at true scale."""
    count = asked.count or COUNT
    if scene.beam.added:
        raise InputError(
            f"what = 'chain': the beam has beam.{scene.beam.added[0]}, and one section with nothing on it rolls up to "
            "the circle: draw its modes, or another scene's chain"
        )
    turns = np.linspace(0.0, 1.0, FRAMES + 1)[1:] if asked.moving else np.array(TURNS)
    lines = np.stack([_joints(scene.beam, count, float(turn)) for turn in turns])
    exact = np.stack([_arc(float(turn)) for turn in turns])
    drawn = drawn_section(scene.beam)
    values = np.clip(2.0 * lines[:, :, 1] / lines[:, :, 1].max() - 1.0, -1.0, 1.0)
    shown = (
        [(lines, values, exact)]
        if asked.moving
        else [(lines[i : i + 1], values[i : i + 1], exact[i : i + 1]) for i in range(len(turns))]
    )
    even = np.linspace(0.0, 1.0, lines.shape[1])
    solids = [part for line, value, _ in shown for part in chain_solids(even, line, value, drawn)]
    wall = list(support_solids(("clamped", "free"), 0.0, drawn))
    traces = tuple(Trace(points=arc, width=1.2, depth=1.4 * drawn.depth) for _, _, arc in shown)
    gap = float(np.hypot(*(lines[-1, -1] - lines[-1, 0])))
    tips = () if asked.moving else tuple(map(_tip, turns[:-1], lines[:-1]))
    return Picture(
        title=f"{scene.name}: {count} rigid links rolled up by an end moment",
        said=(
            f"Bending at true scale; {drawn.said}. The line is the exact circle; closed, the ends of the chain "
            f"{_apart(gap)}.",
        ),
        notes=tuple(f"moment {turn:.2f} · 2π EI/L" for turn in turns) if asked.moving else (),
        solids=(*solids, *wall),
        traces=traces,
        labels=tips,
        scale=("0", "height over the wall", f"{lines[:, :, 1].max():.2f} L"),
        frames=len(turns) if asked.moving else 1,
        seconds=3.5,
        box=(-0.26, 1.06, -0.06, float(lines[:, :, 1].max()) + 0.06),
    )


def _apart(gap: float) -> str:
    return "meet but for rounding" if gap < 1e-6 else f"are {gap:.1e} of the length apart"


def _tip(turn: float, line: Array) -> Label:
    """Words beyond the end of a chain (n, 2)."""
    way = (line[-1] - line[-2]) / np.linalg.norm(line[-1] - line[-2])
    x, y = line[-1] + (0.045 + 0.025 * abs(way[0])) * way
    return Label(text=f"{turn:g} turn", x=float(x), y=float(y), side="right" if line[-1, 0] < 0.02 else "middle")


def _joints(beam: Beam, count: int, turn: float) -> Array:
    """Joints of the chain under `turn` of the closing moment, (count + 1, 2), over the length. Raises InputError."""
    from verify.chain.dynamics import positions
    from verify.chain.statics import solve_static
    from verify.chain.system import LinkLoad, build_system

    held = replace(beam, supports=("clamped", "free"), loss_factor=0.0)
    moment = 2.0 * np.pi * turn * beam.bending_stiffness / beam.length
    system = build_system(held, count, wall="half")
    system = dataclasses.replace(system, loads=(LinkLoad(link=system.n_links, at=0.0, moment=moment),))
    return np.asarray(positions(system, solve_static(system))[0]) / beam.length


def _arc(turn: float) -> Array:
    """The exact circle's part, (n, 2), over the length."""
    s, k = np.linspace(0.0, 1.0, 181), 2.0 * np.pi * turn
    return np.stack([np.sin(k * s) / k, (1.0 - np.cos(k * s)) / k], axis=1)
