"""The linear beam in time: segments and elements by exact steps of their modes, against the exact beam."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.bench.field_set import forces_of, relative_rms
from verify.bench.kind import ASKED_OF_PARTS, Case, Entry, Judged, Line, Reference, Told, orders_at_once, orders_due
from verify.bench.request import Settled
from verify.errors import InputError
from verify.exact.in_time import check_beam
from verify.judge.compare import EIGENVALUE_FLOOR
from verify.models.arrays import Array
from verify.models.catalogue import MODELS, discrete
from verify.models.eigen import solve_seconds
from verify.models.kind import Model
from verify.motion.result import Motion
from verify.motion.starting import SOFT_START_PERIODS, grown_in_words
from verify.quantities.motion_arguments import DeflectionAt
from verify.quantities.simulated import MODES, motion_case

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

SAMPLES = 201
TIME_S, TIME_PER_PART_S = 1e-2, 2e-4
"""Of a motion beside its modes, from above."""


def transient_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """The one. Raises InputError."""
    forces_of(scene, "transient")
    check_beam(scene.beam, "give bench.sets without 'transient'")
    if scene.motion is not None and scene.motion.start == "steady":
        raise InputError("transient: the scene's motion is steady from the start, give motion.start = 'rest'")
    able = discrete("time_basis", scene.beam)
    yield Case(
        set="transient",
        question=f"deflection at x = {its.x:g} m, rms over time",
        condition=f"the linear beam from rest for {1e3 * its.duration:.3g} ms, {grown_in_words(_soft(scene))}",
        entries=(
            *(_entry(scene, its, model, n) for model in able for n in its.counts),
            _entry(scene, its, MODELS["analytic"], None),
        ),
        pairs=tuple((able[0].title, model.title) for model in able[1:]),
        judge=lambda: _judge(scene, its),
        wanted=ASKED_OF_PARTS,
    )


def _soft(scene: "Scene") -> float:
    """Periods over which the forces grow."""
    return scene.motion.soft_start if scene.motion else SOFT_START_PERIODS


def _line(scene: "Scene", model: Model) -> Line:
    """Of a model of parts."""
    if _soft(scene):
        return Line(name=model.title, model=model.name, orders=orders_due(model, scene.beam))
    remedy = "give finer ones, or let the forces grow (motion.soft_start_periods)"
    return Line(name=model.title, model=model.name, orders=orders_at_once(model, scene.beam), remedy=remedy)


def _run(scene: "Scene", its: Settled, model: str, count: int | None, modes: int | None = None) -> Motion:
    case = motion_case(DeflectionAt(model=model, count=count, time=its.duration, modes=modes, x=its.x), scene)
    return case.run(at=[its.x], samples=SAMPLES)


def _entry(scene: "Scene", its: Settled, model: Model, count: int | None) -> Entry:
    def run() -> Told:
        found = _run(scene, its, model.name, count)
        return Told(found.deflection[:, 0], found.statistics.set_up_s, found.statistics.wall_s)

    unknowns = model.unknowns(scene.beam, count) if count else MODES
    return Entry(
        line=_line(scene, model) if count else Line(name=model.title, model=model.name),
        size=1.0 / count if count else 0.0,
        count=count,
        estimate_s=TIME_S + TIME_PER_PART_S * unknowns + (solve_seconds(unknowns, unknowns) if count else 0.0),
        prepare=lambda: run,
        afresh=True,
    )


def _judge(scene: "Scene", its: Settled) -> Callable[[Entry, Any], Judged]:
    """The exact beam, and what twice as many modes and its frequencies' rounding make of it. Raises InputError."""
    motion = _run(scene, its, "analytic", None, 2 * MODES)
    exact: Array = motion.deflection[:, 0]
    if not exact.any():
        raise InputError(f"transient: the exact beam does not move at x = {its.x:g} m, choose another place")
    half = relative_rms(_run(scene, its, "analytic", None).deflection[:, 0], exact)
    late = relative_rms(exact + motion.times * np.gradient(exact, motion.times), exact)  # for frequencies off by all
    name = f"exact beam in {2 * MODES} modes, what half as many change, rounding of its frequencies"
    reference = Reference(name, max(half, EIGENVALUE_FLOOR * late))
    return lambda entry, answer: Judged(relative_rms(answer, exact), reference)
