"""What is drawn of a scene: one of its modes, its wave, its slider's run, a chain of its beam rolled up."""

import dataclasses
from collections.abc import Callable
from math import ceil

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.checks import check_whole
from verify.errors import InputError
from verify.judge.workbench import Workbench, no_such_mode
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.motion.result import Motion
from verify.pictures.parts import (
    Drawn,
    attached_parts,
    bar_solids,
    chain_solids,
    drawn_section,
    force_solids,
    support_solids,
    times,
)
from verify.pictures.picture import RED, Label, Picture, Solid, Trace, box
from verify.scenes.scene import Scene

CHAIN, ELEMENTS = "segment", "fem"
COUNT, ROLLED, MOST = 49, 20, 400
"""Segments where nobody says; of a chain rolled up; and at most, beyond which none is seen."""
MODE = 3
"""Where nobody says."""
AMPLITUDE, STEEPEST = 0.055, 1.6
"""The largest deflection drawn, over the length, unless a slope is drawn steeper than that."""
ROOM, LETTERS = 0.052, 0.034
"""Between what the upper beam and the lower one reach, half of it; and for the words above each, over the length."""
FINE = 241
"""Points of what is smooth."""
PERIOD, RUN = 36, 72
"""Frames of a period; of a run."""
FORCE = 0.07
"""The longest arrow, over the length."""
TURNS = (0.125, 0.25, 0.5, 0.75, 1.0)
"""Of the rolled chain, in one still picture."""


class Asked(msgspec.Struct, frozen=True, kw_only=True):
    """What is drawn."""

    what: str
    mode: int | None = None
    count: int | None = None
    moving: bool = False
    """Whether a file takes more than one frame."""


class _Stage(msgspec.Struct, frozen=True, kw_only=True):
    """How far deflections are drawn, and where the two beams lie above and below the middle, over the length."""

    largest: float
    """The deflection of the highest colour."""
    amplitude: float
    apart: float

    def y(self, row: "_Row") -> float:
        """Where a beam lies when it is straight."""
        return self.apart if row.upper else -self.apart

    def line(self, beam: Beam, row: "_Row") -> Array:
        """(f, n, 2) in the picture."""
        y = self.y(row) + self.amplitude * row.deflection / self.largest
        return np.stack([np.broadcast_to(row.x / beam.length, y.shape), y], axis=2)


class _Row(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """One beam of a picture."""

    words: str
    upper: bool
    x: Array
    """(n,), metres."""
    deflection: Array
    """(f, n), in the unit of `largest`."""
    links: bool


def picture_of(scene: Scene, asked: Asked) -> Picture:
    """What is asked for, in plain arrays. Raises InputError."""
    if asked.mode is not None and asked.what != "modes":
        raise InputError(f"mode = {asked.mode}: {asked.what} has no mode, leave it out or ask for modes")
    if asked.count is not None:
        check_whole("count", asked.count, 2)
        if asked.count > MOST:
            raise InputError(f"count = {asked.count}: more than {MOST} links are too small to be seen, give fewer")
    made: dict[str, Callable[[Scene, Asked], Picture]] = {
        "modes": _modes,
        "wave": _wave,
        "slider": _slider,
        "chain": _rolled,
    }
    return made[asked.what](scene, asked)


def _count(scene: Scene, asked: Asked, section: str) -> int:
    """As asked, else as the scene's own section says."""
    its = getattr(scene, section, None)
    return asked.count or (min(its.count, MOST) if its is not None else COUNT)


def _modes(scene: Scene, asked: Asked) -> Picture:
    """A mode by segments above and elements below, the exact one as a line."""
    mode, count = asked.mode or MODE, _count(scene, asked, "spectrum")
    bench, fine = Workbench(scene.beam), np.linspace(0.0, scene.beam.length, max(FINE, 16 * mode))
    most = MODELS[CHAIN].n_elastic(scene.beam, count)
    if mode > most:
        raise InputError(no_such_mode(mode, CHAIN, count, most))
    chain, elements = (bench.modes(model, count, mode) for model in (CHAIN, ELEMENTS))
    raw = chain.readings.get("raw", lambda: chain.deflection(chain.nodes))()[mode - 1]
    swing = np.cos(2.0 * np.pi * np.arange(PERIOD) / PERIOD) if asked.moving else np.ones(1)
    shapes = [_unit(raw), _unit(elements.deflection(fine)[mode - 1])]
    exact = bench.exact_hz(mode)
    found = [float(one.frequencies_hz[mode - 1]) for one in (chain, elements)]
    words = [
        f"{count} {what}: {hertz:.6g} Hz ({100.0 * (hertz / exact - 1.0):+.3g} %)"
        for what, hertz in zip(("rigid links and joints", "Hermite elements"), found, strict=True)
    ]
    rows = [
        _Row(words=words[0], upper=True, x=chain.nodes, deflection=swing[:, None] * shapes[0], links=True),
        _Row(words=words[1], upper=False, x=fine, deflection=swing[:, None] * shapes[1], links=False),
    ]
    return _of_rows(
        scene,
        rows,
        title=f"{scene.name}: mode {mode}, exactly {exact:.6g} Hz",
        said="A mode has no size: its deflection is drawn as large as can be seen well; the line is the exact shape",
        scale=("down", "deflection", "up"),
        largest=1.0,
        notes=(),
        seconds=2.0,
        exact=swing[:, None] * _unit(_exact_shape(scene, mode, fine)),
    )


def _exact_shape(scene: Scene, mode: int, x: Array) -> Array:
    """Of the beam itself, (len(x),). Raises InputError."""
    from verify.exact.modes import mode_shape

    return np.asarray(mode_shape(scene.beam, mode, x))


def _unit(shape: Array) -> Array:
    """A shape with a largest value of 1, positive where it first moves off its left end."""
    return np.asarray(shape / abs(shape).max())


def _of_rows(
    scene: Scene,
    rows: list[_Row],
    *,
    title: str,
    said: str,
    scale: tuple[str, str, str],
    largest: float,
    notes: tuple[str, ...],
    seconds: float,
    more: tuple[Solid, ...] = (),
    exact: Array | None = None,
) -> Picture:
    """Beams above each other, each held, loaded and named; `largest` is the deflection of the highest colour.

    `exact` (f, n), at even places, is a line in front of each.
    """
    drawn, stage = drawn_section(scene.beam), _stage(scene.beam, rows, largest)
    solids: list[Solid] = []
    traces: list[Trace] = []
    for row in rows:
        line, y = stage.line(scene.beam, row), stage.y(row)
        values = np.clip(row.deflection / largest, -1.0, 1.0)
        solids += (chain_solids if row.links else bar_solids)(line, values, drawn)
        solids += support_solids(scene.beam.supports, y, drawn)
        bodies, springs = attached_parts(scene.beam, row.x, line, y, drawn)
        solids, traces = solids + bodies, traces + springs
        still = np.array([[[0.0, y], [1.0, y]]])
        traces.append(Trace(points=still, colour="#9aa2b1", width=0.8, depth=drawn.depth))
        if exact is not None:
            even = np.linspace(0.0, scene.beam.length, exact.shape[1])
            known = _Row(words="", upper=row.upper, x=even, deflection=exact, links=False)
            traces.append(Trace(points=stage.line(scene.beam, known), width=1.2, depth=1.3 * drawn.depth))
    left = _free_place([one.position / scene.beam.length for one in scene.forces] if more else [])
    top = stage.apart + max(stage.amplitude, drawn.half) + LETTERS + 0.02
    return Picture(
        title=title,
        said=(f"{said}; {drawn.said}.",),
        notes=notes,
        solids=(*solids, *more),
        traces=tuple(traces),
        labels=tuple(Label(text=row.words, x=left, y=stage.y(row) + stage.amplitude + LETTERS) for row in rows),
        scale=scale,
        frames=len(rows[0].deflection),
        seconds=seconds,
        box=(-0.035, 1.035, -stage.apart - max(stage.amplitude, 0.11 if scene.beam.spring else 0.05), top),
    )


def _free_place(taken: list[float]) -> float:
    """Where words begin that no arrow stands in."""
    free = (x for x in np.arange(0.0, 0.65, 0.05) if not any(x - 0.02 < at < x + 0.34 for at in taken))
    return float(next(free, 0.0))


def _stage(beam: Beam, rows: list[_Row], largest: float) -> _Stage:
    """Lower than AMPLITUDE where that would be too steep to look at."""
    smooth = next(row for row in rows if not row.links)
    steep = float(abs(np.gradient(smooth.deflection, smooth.x / beam.length, axis=1)).max()) / largest
    amplitude = min(AMPLITUDE, STEEPEST / steep)
    return _Stage(largest=largest, amplitude=amplitude, apart=amplitude + ROOM)


def _wave(scene: Scene, asked: Asked) -> Picture:
    """The steady field under the drive, segments above elements, the forces on them."""
    from verify.waves.case import DrivenCase
    from verify.waves.driven import driven

    if scene.drive is None or not scene.forces:
        raise InputError("what = 'wave': the scene has no drive with forces, add [drive] or draw modes")
    count, bench = _count(scene, asked, "wave"), Workbench(scene.beam)
    case = DrivenCase(
        beam=scene.beam,
        model=CHAIN,
        count=count,
        forces=scene.forces,
        frequency_hz=scene.drive.frequency_hz,
        kind=scene.drive.kind,
    )
    joints = np.asarray(bench.modes(CHAIN, count, 1).nodes)
    turn = np.exp(2j * np.pi * np.arange(PERIOD) / PERIOD) if asked.moving else np.ones(1, dtype=complex)
    rows = []
    for model, words in ((CHAIN, "rigid links and joints"), (ELEMENTS, "Hermite elements")):
        x = joints if model == CHAIN else _fine_enough(scene)
        settings = (("reading", "raw"),) if model == CHAIN else ()
        w = driven(replace(case, model=model, settings=settings), bench).deflection(x)
        moved = np.real(turn[:, None] * w[None, :])
        is_chain = model == CHAIN
        rows.append(_Row(words=f"{count} {words}", upper=is_chain, x=x, deflection=moved, links=is_chain))
    largest = max(float(abs(row.deflection).max()) for row in rows)
    _check_moves(largest, "the drive")
    stage = _stage(scene.beam, rows, largest)
    loads = [one for row in rows for one in _loads(scene, stage.y(row), turn)] if scene.drive.kind == "force" else []
    unit, factor = _unit_of(largest)
    period = tuple(f"{360.0 * i / PERIOD:.0f}° of the period" for i in range(len(turn))) if asked.moving else ()
    return _of_rows(
        scene,
        rows,
        title=f"{scene.name}: driven at {scene.drive.frequency_hz:g} Hz",
        said=_exaggerated(scene.beam, stage),
        scale=(f"-{factor * largest:.3g} {unit}", "deflection", f"+{factor * largest:.3g} {unit}"),
        largest=largest,
        notes=period,
        seconds=3.0,
        more=tuple(loads),
    )


def _fine_enough(scene: Scene) -> Array:
    """Places for what is smooth: sixteen in a wave at least."""
    from verify.models.fields import wavenumber

    assert scene.drive is not None
    waves = abs(wavenumber(scene.beam, scene.drive.frequency_hz)) * scene.beam.length / (2.0 * np.pi)
    return np.linspace(0.0, scene.beam.length, min(max(FINE, ceil(16.0 * waves)), 4000))


def _check_moves(largest: float, what: str) -> None:
    """Raise InputError for a beam at rest, of which nothing can be drawn."""
    if not largest > 0.0 or not np.isfinite(largest):
        raise InputError(f"drive: {what} does not move the beam, give it a force")


def _exaggerated(beam: Beam, stage: _Stage) -> str:
    unit, factor = _unit_of(stage.largest)
    drawn = times(stage.amplitude * beam.length / stage.largest)
    return f"Deflection drawn {drawn} (the largest is {factor * stage.largest:.3g} {unit})"


def _unit_of(size: float) -> tuple[str, float]:
    """A unit of length that suits, and how many of it a metre has."""
    for unit, factor in (("m", 1.0), ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)):
        if abs(size) * factor >= 1.0:
            return unit, factor
    return "pm", 1e12


def _loads(scene: Scene, y: float, turn: Array) -> list[Solid]:
    """An arrow of each force from the straight beam at the height y."""
    drawn, strongest = drawn_section(scene.beam), max(abs(force.amplitude) for force in scene.forces)
    solids: list[Solid] = []
    for force in scene.forces:
        size = FORCE * force.amplitude / (strongest or 1.0) * np.real(turn * np.exp(1j * np.deg2rad(force.phase_deg)))
        foot = np.stack([np.full(len(turn), force.position / scene.beam.length), np.full(len(turn), y)], axis=1)
        solids += force_solids(foot, np.stack([np.zeros_like(size), size], axis=1), drawn)
    return solids


def _slider(scene: Scene, asked: Asked) -> Picture:
    """The run of the slider on segments and on elements, friction as an arrow."""
    if scene.slider is None or scene.motion is None:
        missing = "slider" if scene.slider is None else "motion"
        raise InputError(f"what = 'slider': the scene has no [{missing}], add it or draw its wave")
    count = _count(scene, asked, "motion")
    runs = {model: _run(scene, model, count) for model in (CHAIN, ELEMENTS)}
    n = min(len(run.times) for run in runs.values())
    shown = slice(0, n) if asked.moving else slice(n - 1, n)
    rows, blocks, told = [], [], []
    largest = max(float(abs(run.deflection).max()) for run in runs.values())
    _check_moves(largest, "the drive")
    hardest = max(float(abs(run.friction).max()) for run in runs.values()) or 1.0
    for model, run in runs.items():
        words = f"{count} {'rigid links and joints' if model == CHAIN else 'Hermite elements'}"
        is_chain = model == CHAIN
        row = _Row(words=words, upper=is_chain, x=run.points, deflection=run.deflection[shown], links=is_chain)
        rows.append(row)
    stage = _stage(scene.beam, rows, largest)
    for row, run in zip(rows, runs.values(), strict=True):
        blocks += _block(scene.beam, row, run, shown, stage, hardest)
        unit, factor = _unit_of(float(abs(run.travelled).max()))
        told.append([f"{factor * x:+.2f} {unit}" for x in run.travelled[shown]])
    instants = runs[CHAIN].times[shown]
    notes = [
        f"{1e3 * t:.3f} ms; travelled on segments {a}, on elements {b}"
        for t, a, b in zip(instants, *told, strict=True)
    ]
    unit, factor = _unit_of(largest)
    return _of_rows(
        scene,
        rows,
        title=f"{scene.name}: the slider and the friction on it",
        said=f"{_exaggerated(scene.beam, stage)}; the longest arrow is {1e3 * hardest:.3g} mN; the slider's travel is "
        "not enlarged",
        scale=(f"-{factor * largest:.3g} {unit}", "deflection", f"+{factor * largest:.3g} {unit}"),
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
        x = np.linspace(0.0, scene.beam.length, max(FINE, 5 * count + 1))
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


def _block(beam: Beam, row: _Row, run: Motion, shown: slice, stage: _Stage, hardest: float) -> list[Solid]:
    """The slider on the surface as it is drawn, and the friction on it."""
    drawn, line = drawn_section(beam), stage.line(beam, row)
    x = run.position[shown] / beam.length
    y = np.array([np.interp(at, one[:, 0], one[:, 1]) for at, one in zip(x, line, strict=True)])
    slope = np.array([np.interp(at, one[:, 0], np.gradient(one[:, 1], one[:, 0])) for at, one in zip(x, line, strict=True)])
    turn = np.arctan(slope)
    foot = np.stack([x - drawn.half * np.sin(turn), y + drawn.half * np.cos(turn)], axis=1)
    half, height = 0.016, 0.026
    middle = foot + 0.5 * height * np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    push = FORCE * run.friction[shown] / hardest
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    start = middle + way * (half * np.sign(push))[:, None]
    block = Solid(outlines=box(foot, turn, half, height), depth=0.8 * drawn.depth, colour="#4b5568", edges=True)
    return [block, *force_solids(start, way * push[:, None], drawn, RED)]


def _rolled(scene: Scene, asked: Asked) -> Picture:
    """A cantilever of the scene's beam under an end moment up to 2 pi EI / L, which closes it, at true scale."""
    count = asked.count or ROLLED
    if scene.beam.added:
        raise InputError(
            f"what = 'chain': the beam has beam.{scene.beam.added[0]}, and one section with nothing on it rolls up to "
            "the circle: draw its modes, or another scene's chain"
        )
    turns = np.linspace(0.0, 1.0, PERIOD + 1)[1:] if asked.moving else np.array(TURNS)
    lines = np.stack([_joints(scene.beam, count, float(turn)) for turn in turns])
    exact = np.stack([_arc(float(turn)) for turn in turns])
    drawn = drawn_section(scene.beam)
    values = np.clip(2.0 * lines[:, :, 1] / lines[:, :, 1].max() - 1.0, -1.0, 1.0)
    shown = [(lines, values, exact)] if asked.moving else [
        (lines[i : i + 1], values[i : i + 1], exact[i : i + 1]) for i in range(len(turns))
    ]
    solids = [part for line, value, _ in shown for part in chain_solids(line, value, drawn)]
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
    x, y = line[-1] + 0.045 * (line[-1] - line[-2]) / np.linalg.norm(line[-1] - line[-2])
    return Label(text=f"{turn:g} turn", x=float(x), y=float(y), side="middle")


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
