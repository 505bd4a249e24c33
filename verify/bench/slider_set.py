"""A slider on the linear beam: its displacement on segments and on elements, the exact beam as reference."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from verify.bench.kind import Case, Entry, Judged, Line, Reference, Told, orders_due
from verify.bench.request import Settled
from verify.errors import InputError
from verify.exact.in_time import check_beam
from verify.judge.compare import check_reference, relative_error
from verify.models.catalogue import discrete
from verify.models.eigen import solve_seconds
from verify.models.kind import Model
from verify.motion.starting import grown_in_words
from verify.motion.stepping import slider_seconds
from verify.studies.slider.work_precision import exact_way, run_once

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

TABLES_S = 2e-4
"""Of the tables of shapes, for each unknown, from above."""


def slider_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """Ours over sizes, as [motion] has it; then other engines over steps, under a step load. Raises InputError."""
    if scene.slider is None or scene.motion is None or scene.drive is None:
        missing = next(name for name in ("slider", "motion", "drive") if getattr(scene, name) is None)
        raise InputError(f"slider: the scene has no [{missing}], add it")
    check_beam(scene.beam, "give bench.sets without 'slider'")
    able = discrete("time_basis", scene.beam)
    motion = scene.motion
    start = grown_in_words(motion.soft_start) if motion.start == "rest" else "in the steady state"
    yield Case(
        set="slider",
        question="displacement at the end",
        condition=f"one-way coupling, {1e3 * motion.duration:g} ms, {start}",
        entries=tuple(_entry(scene, model, n) for model in able for n in its.counts),
        pairs=tuple((able[0].title, model.title) for model in able[1:]),
        judge=lambda: _judge(scene),
    )
    if its.peers:
        from verify.bench.ride_set import ride_cases

        yield from ride_cases(scene, its)


def _line(scene: "Scene", model: Model) -> Line:
    """Under a step load the path converges at no order."""
    assert scene.motion is not None
    if scene.motion.start == "rest" and not scene.motion.soft_start:
        remedy = "let the forces grow (motion.soft_start_periods), under a step load they fall at none"
        return Line(name=model.title, model=model.name, remedy=remedy)
    return Line(name=model.title, model=model.name, orders=orders_due(model, scene.beam))


def _entry(scene: "Scene", model: Model, count: int) -> Entry:
    motion, drive = scene.motion, scene.drive
    assert motion is not None
    assert drive is not None

    def run() -> Told:
        found = run_once(scene, model.name, count, coupling="one-way")
        if not found.statistics.finished:
            raise InputError(f"slider: the run {found.statistics.stopped}, shorten motion.duration")
        return Told(found.displacement, found.statistics.set_up_s, found.statistics.wall_s)

    unknowns = model.unknowns(scene.beam, count)
    steps = motion.duration * drive.frequency_hz * motion.steps_per_period
    loop = slider_seconds(steps, unknowns, two_way=False)
    return Entry(
        line=_line(scene, model),
        size=1.0 / count,
        count=count,
        estimate_s=loop + TABLES_S * unknowns + solve_seconds(unknowns, unknowns),
        prepare=lambda: run,
        afresh=True,
    )


def _judge(scene: "Scene") -> Callable[[Entry, Any], Judged]:
    way, floor = exact_way(scene)
    check_reference(way)
    reference = Reference("displacement on the exact beam at the same step, and what half the step changes", floor)
    return lambda entry, answer: Judged(relative_error(answer, way), reference)
