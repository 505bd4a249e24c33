"""The run of a slider on segments and on elements, friction as an arrow."""

import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.motion.result import Motion
from verify.pictures.parts import force_solids
from verify.pictures.picture import RED, Picture, Solid, box
from verify.pictures.rows import (
    CHAIN,
    ELEMENTS,
    FINE,
    FORCE,
    Asked,
    Row,
    Stage,
    check_moves,
    count_of,
    exaggerated,
    picture_of_rows,
    scale_of,
    stage_of,
)
from verify.pictures.sizes import drawn_section
from verify.scenes.scene import Scene
from verify.units import in_words, unit_over

RUN = 72
"""Frames."""


def ridden(scene: Scene, asked: Asked) -> Picture:
    """The run of the slider on segments and on elements, friction as an arrow."""
    if scene.slider is None or scene.motion is None:
        missing = "slider" if scene.slider is None else "motion"
        raise InputError(f"what = 'slider': the scene has no [{missing}], add it or draw its wave")
    count = count_of(scene, asked, "motion")
    runs = {model: _run(scene, model, count) for model in (CHAIN, ELEMENTS)}
    n = min(len(run.times) for run in runs.values())
    shown = slice(0, n) if asked.moving else slice(n - 1, n)
    rows, blocks, told = [], [], []
    largest = max(float(abs(run.deflection).max()) for run in runs.values())
    check_moves(largest, "the drive")
    hardest = max(float(abs(run.friction).max()) for run in runs.values()) or 1.0
    for model, run in runs.items():
        words = f"{count} {'rigid links and joints' if model == CHAIN else 'Hermite elements'}"
        is_chain = model == CHAIN
        row = Row(words=words, upper=is_chain, x=run.points, deflection=run.deflection[shown], links=is_chain)
        rows.append(row)
    stage = stage_of(scene.beam, rows, largest)
    for row, run in zip(rows, runs.values(), strict=True):
        blocks += _block(scene.beam, row, run, shown, stage, hardest)
        way = unit_over(run.travelled.tolist())
        told.append([f"{round(way.factor * x, 2) + 0.0:+.2f} {way.name}" for x in run.travelled[shown].tolist()])
    instants = runs[CHAIN].times[shown]
    time = unit_over(instants.tolist(), "s")
    notes = [
        f"{time.factor * t:.3f} {time.name}; travelled on segments {a}, on elements {b}"
        for t, a, b in zip(instants, *told, strict=True)
    ]
    return picture_of_rows(
        scene,
        rows,
        title=f"{scene.name}: the slider and the friction on it",
        said=f"{exaggerated(scene.beam, stage, f'of {n} instants')}; the longest arrow of them is "
        f"{in_words(hardest, 'N')}; the slider's travel is not enlarged",
        scale=scale_of(largest),
        largest=largest,
        notes=tuple(notes),
        seconds=6.0,
        more=tuple(blocks),
    )


def _run(scene: Scene, model: str, count: int) -> Motion:
    """One model's run, kept at RUN instants and at its own nodes. Raises InputError."""
    from verify.quantities.motion_arguments import InTime, SliderInTime
    from verify.quantities.simulated import motion_case, slider_of, steps_per_period

    x = Workbench(scene.beam).modes(model, count, 1).nodes
    if model != CHAIN:
        x = np.linspace(0.0, scene.beam.length, max(FINE, 10 * count + 1))
    found = motion_case(InTime(model=model, count=count), scene).run(
        slider=slider_of(SliderInTime(model=model, count=count), scene),
        at=x.tolist(),
        samples=RUN,
        steps_per_period=steps_per_period(scene),
        patient=False,
    )
    if found.statistics.interrupted:
        raise KeyboardInterrupt
    return found


def _block(beam: Beam, row: Row, run: Motion, shown: slice, stage: Stage, hardest: float) -> list[Solid]:
    """The slider on the surface as it is drawn, and the friction on it."""
    drawn, line = drawn_section(beam), stage.line(beam, row)
    x = run.position[shown] / beam.length
    y = np.array([np.interp(at, one[:, 0], one[:, 1]) for at, one in zip(x, line, strict=True)])
    slope = np.array(
        [np.interp(at, one[:, 0], np.gradient(one[:, 1], one[:, 0])) for at, one in zip(x, line, strict=True)]
    )
    turn = np.arctan(slope)
    up = drawn.half_at(x)
    foot = np.stack([x - up * np.sin(turn), y + up * np.cos(turn)], axis=1)
    half, height = 0.016, 0.026
    middle = foot + 0.5 * height * np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    push = FORCE * run.friction[shown] / hardest
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    start = middle + way * (half * np.sign(push))[:, None]
    block = Solid(outlines=box(foot, turn, half, height), depth=0.8 * drawn.depth, colour="#4b5568", edges=True)
    return [block, *force_solids(start, way * push[:, None], drawn, RED)]
