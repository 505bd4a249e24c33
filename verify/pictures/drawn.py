"""What is drawn of a scene: one of its modes, its wave; its slider's run and a rolled chain stand beside."""

from collections.abc import Callable
from math import ceil

import numpy as np
from msgspec.structs import replace

from verify.checks import check_whole
from verify.errors import InputError
from verify.judge.workbench import Workbench, no_such_mode
from verify.models.arrays import Array, ComplexArray
from verify.models.catalogue import MODELS
from verify.pictures.parts import force_solids
from verify.pictures.picture import Picture, Solid
from verify.pictures.ridden import ridden
from verify.pictures.rolled import rolled
from verify.pictures.rows import (
    CHAIN,
    ELEMENTS,
    FINE,
    FORCE,
    IN_A_WAVE,
    MOST,
    Asked,
    Row,
    check_moves,
    count_of,
    exaggerated,
    picture_of_rows,
    scale_of,
    stage_of,
)
from verify.pictures.sizes import drawn_section
from verify.scenes.scene import Scene

MODE, PERIOD = 3, 36
"""The mode where nobody says; and frames of a period."""


def picture_of(scene: Scene, asked: Asked) -> Picture:
    """What is asked for, in plain arrays. Raises InputError."""
    if asked.what != "wave":
        scene.refuse_devices(f"a picture of what = {asked.what!r}")
    if asked.mode is not None and asked.what != "modes":
        raise InputError(f"mode = {asked.mode}: {asked.what} has no mode, leave it out or ask for modes")
    if asked.count is not None:
        check_whole("count", asked.count, 2)
        if asked.count > MOST:
            raise InputError(f"count = {asked.count}: more than {MOST} links are too small to be seen, give fewer")
    made: dict[str, Callable[[Scene, Asked], Picture]] = {
        "modes": _modes,
        "wave": _wave,
        "slider": ridden,
        "chain": rolled,
    }
    return made[asked.what](scene, asked)


def _modes(scene: Scene, asked: Asked) -> Picture:
    """A mode by segments above and elements below, the exact one as a line."""
    mode, count = asked.mode or MODE, count_of(scene, asked, "spectrum")
    bench, fine = Workbench(scene.beam), np.linspace(0.0, scene.beam.length, max(FINE, IN_A_WAVE * mode))
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
        Row(words=words[0], upper=True, x=chain.nodes, deflection=swing[:, None] * shapes[0], links=True),
        Row(words=words[1], upper=False, x=fine, deflection=swing[:, None] * shapes[1], links=False),
    ]
    return picture_of_rows(
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


def _wave(scene: Scene, asked: Asked) -> Picture:
    """The steady field under the drive, segments above elements, the forces on them."""
    from verify.waves.case import DrivenCase
    from verify.waves.driven import driven

    if scene.drive is None or not scene.forces:
        raise InputError("what = 'wave': the scene has no drive with forces, add [drive] or draw modes")
    count, bench = count_of(scene, asked, "wave"), Workbench(scene.beam)
    case = DrivenCase(
        beam=scene.beam,
        model=CHAIN,
        count=count,
        forces=scene.forces,
        frequency_hz=scene.drive.frequency_hz,
        kind=scene.drive.kind,
        devices=scene.devices,
    )
    joints = np.asarray(bench.modes(CHAIN, count, 1).nodes)
    fine = _fine_enough(scene)
    raw = driven(replace(case, settings=(("reading", "raw"),)), bench).deflection(joints)
    own = driven(replace(case, model=ELEMENTS), bench).deflection(fine)
    largest = float(abs(own).max())
    check_moves(largest, "the drive")
    degrees = 360.0 * np.arange(PERIOD) / PERIOD if asked.moving else _highest(own)
    turn = np.exp(1j * np.deg2rad(degrees))
    rows = [
        Row(words=f"{count} {words}", upper=links, x=x, deflection=np.real(turn[:, None] * w), links=links)
        for words, x, w, links in (
            ("rigid links and joints", joints, raw, True),
            ("Hermite elements", fine, own, False),
        )
    ]
    stage = stage_of(scene.beam, rows, largest)
    loads = [one for row in rows for one in _loads(scene, stage.y(row), turn)] if scene.drive.kind == "force" else []
    return picture_of_rows(
        scene,
        rows,
        title=f"{scene.name}: driven at {scene.drive.frequency_hz:g} Hz",
        said=exaggerated(scene.beam, stage, "over the period"),
        scale=scale_of(largest),
        largest=largest,
        notes=tuple(f"{one:.0f}° of the period" for one in degrees),
        seconds=3.0,
        more=tuple(loads),
    )


def _highest(field: ComplexArray) -> Array:
    """The part of the period, (1,), degrees, at which a steady field (n,) deflects as far as it ever does."""
    degrees = float(np.rint(-np.angle(field[abs(field).argmax()], deg=True)))
    return np.array([degrees % 360.0])


def _fine_enough(scene: Scene) -> Array:
    """Places for what is smooth, (n,), metres."""
    from verify.models.fields import wavenumber

    assert scene.drive is not None
    waves = abs(wavenumber(scene.beam, scene.drive.frequency_hz)) * scene.beam.length / (2.0 * np.pi)
    return np.linspace(0.0, scene.beam.length, min(max(FINE, ceil(IN_A_WAVE * waves)), 4000))


def _loads(scene: Scene, y: float, turn: Array) -> list[Solid]:
    """An arrow of each force from the straight beam at the height y."""
    drawn, strongest = drawn_section(scene.beam), max(abs(force.amplitude) for force in scene.forces)
    solids: list[Solid] = []
    for force in scene.forces:
        size = FORCE * force.amplitude / (strongest or 1.0) * np.real(turn * np.exp(1j * np.deg2rad(force.phase_deg)))
        foot = np.stack([np.full(len(turn), force.position / scene.beam.length), np.full(len(turn), y)], axis=1)
        solids += force_solids(foot, np.stack([np.zeros_like(size), size], axis=1), drawn)
    return solids
