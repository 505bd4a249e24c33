"""A slider under a step load, one-way: other engines beside ours, at each number of links.

Engines read a surface by a cubic of their own, ours is a spline: each is held against a slider on its own reading, that
of engines on the exact linear chain where the forces are small enough.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import groupby
from math import inf
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.bench.chain_set import FIRST_STEP, WANTED, chain_of
from verify.bench.field_set import forces_of, relative_rms
from verify.bench.kind import Case, Entry, Judged, Line, Reference, Told
from verify.bench.peer_set import RUNGS, START_S, engines, first_steps, further, ladder
from verify.bench.request import Settled
from verify.chain.splitting import linear_deflection, modal_basis, simulate_modal
from verify.errors import InputError
from verify.models.arrays import Array
from verify.peers import references
from verify.peers.case import case_of, sled_of

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.slider import Slider

OURS = "segments, modal steps"
SMALL = 3e-6
"""Departure of the nonlinear chain from the linear one up to which that is what engines are held against."""
OWN_STEP_S = 1e-5
"""Of our own slider, from above."""
RIDE_S = 6e-5
"""Of a step of a slider on the exact linear chain, and of half as many again, from above."""
Answer = tuple[Array, Array, Array]
"""(times, way, speed)."""
Known = tuple[Callable[[Array], tuple[Array, Array]], Reference, float]
"""(times -> way and speed, what it is, the step of the row that it is as well, 0 where it is none's)."""


def ride_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """One for each number of links; without engines nothing but, once, who is missing."""
    ready, absent = engines()
    assert scene.drive is not None
    assert scene.slider is not None
    assert scene.motion is not None
    slider, forces = replace(scene.slider, coupling="one-way"), forces_of(scene, "slider")
    for count in its.chains:
        try:
            links = case_of(scene.beam, count, forces, scene.drive.frequency_hz)
            sled = sled_of(scene.beam, slider)
        except InputError as error:
            yield _nobody(count, (*absent, *(f"{name} is left out: {error}" for name in ready)))
            continue
        if not ready:
            yield _nobody(count, absent)
            continue
        theirs = [entry for name, engine in ready.items() for entry in ladder(name, engine, links, sled, its.duration)]
        ours = list(_own(scene, its, slider, count))
        departure = departs(scene, its, count)
        known: dict[str, Callable[[], Known]] = {OURS: partial(_finer, scene, its, slider, count, ours[0].size)}
        exact = partial(_exact, partial(references.ride, links, sled, its.duration), departure)
        for name, own in groupby(theirs, key=lambda one: one.line.name):
            known[name] = exact if departure <= SMALL else partial(_finest, list(own))
        yield Case(
            set="slider",
            about=f"step load, N = {count}",
            question="way and speed, rms over time",
            condition=f"one-way coupling, {1e3 * its.duration:.3g} ms from rest under a step load; ours is linear",
            entries=(*ours, *theirs),
            pairs=(),
            races=tuple((OURS, name) for name in ready),
            judge=partial(_judge, known),
            estimate_s=_reference_s(theirs, small=departure <= SMALL) + 8.0 * ours[-1].estimate_s,
            wanted=WANTED,
            notes=absent,
        )


def _nobody(count: int, why: tuple[str, ...]) -> Case:
    """No engine takes part: notes alone."""
    about, judge = f"step load, N = {count}", partial(_judge, {})
    return Case(set="slider", about=about, question="", condition="", entries=(), pairs=(), judge=judge, notes=why)


def departs(scene: "Scene", its: Settled, count: int) -> float:
    """How far the nonlinear chain departs from the linear one under the scene's forces, relative rms."""
    chain = chain_of(scene, its, count)
    basis = modal_basis(chain.system)
    linear = linear_deflection(basis, chain.start, chain.times, chain.x)
    if not linear.any():
        return inf
    moved = simulate_modal(basis, chain.start, chain.times, step=FIRST_STEP * chain.period, kicks=1)
    found = moved.deflection([chain.x])[:, 0]
    return relative_rms(found, linear) if len(found) == len(linear) else inf


def _own(scene: "Scene", its: Settled, slider: "Slider", count: int) -> Iterator[Entry]:
    assert scene.drive is not None
    least = first_steps(1.0 / scene.drive.frequency_hz, its.duration, inf)
    line = Line(name=OURS, model="segment", orders=(1.0, 4.0), refined="step")
    for steps in (least * 2**k for k in range(RUNGS + further(count))):
        yield Entry(
            line=line,
            size=its.duration / steps,
            count=count,
            estimate_s=START_S + OWN_STEP_S * steps,
            prepare=partial(partial, _ride, scene, its, slider, count, steps, least),
            afresh=True,
            settings={"step": its.duration / steps},
        )


def _ride(scene: "Scene", its: Settled, slider: "Slider", count: int, steps: int, kept: int) -> Told:
    """Our slider in so many steps, samples `kept` of them: a step is an upper bound, and cut at samples."""
    from verify.motion.simulate import simulate

    assert scene.drive is not None
    found = simulate(
        scene.beam,
        scene.forces,
        scene.drive.frequency_hz,
        its.duration,
        count=count,
        slider=slider,
        step=its.duration / steps * (1.0 + 1e-9),
        samples=kept + 1,
        ledger=False,
        patient=False,
    )
    if found.statistics.steps != steps:
        raise InputError(f"{OURS}: it took {found.statistics.steps} steps where {steps} were asked for")
    answer = found.times, found.travelled, found.speed
    return Told(answer, found.statistics.set_up_s, found.statistics.wall_s)


def _reference_s(theirs: Sequence[Entry], *, small: bool) -> float:
    """Seconds of what engines are held against, from above."""
    if small:
        return RIDE_S * references.RIDE_STEPS
    lines = [[entry.estimate_s for entry in own] for _, own in groupby(theirs, key=lambda one: one.line.name)]
    return sum(sum(own[-2:]) for own in lines)


def _judge(known: dict[str, Callable[[], Known]]) -> Callable[[Entry, Any], Judged]:
    """Every line against its own, made where it is asked for. Raises InputError."""
    made: dict[Callable[[], Known], Known] = {}

    def error(entry: Entry, answer: Answer) -> Judged:
        maker = known[entry.line.name]
        if maker not in made:
            made[maker] = maker()
        true, reference, size = made[maker]
        if entry.size == size:
            raise InputError(f"{entry.line.name}: its shortest step is its own reference")
        pairs = zip(answer[1:], true(answer[0]), strict=True)
        return Judged(max(relative_rms(*pair) for pair in pairs), reference)

    return error


def _exact(ride: Callable[..., references.Ride], departure: float) -> Known:
    """A slider on the exact linear chain."""
    fine, coarse = (ride(steps=references.RIDE_STEPS // k) for k in (1, 2))
    left = _apart((coarse.times, coarse.distance, coarse.speed), fine.at)
    name = "a slider on the exact linear chain, and how far the nonlinear one departs"
    return fine.at, Reference(name, max(left, departure)), 0.0


def _finer(scene: "Scene", its: Settled, slider: "Slider", count: int, longest: float) -> Known:
    """Ours in steps of a half and a quarter of its shortest."""
    least = round(its.duration / longest)
    steps = [least * 2 ** (RUNGS + further(count) + k) for k in range(2)]
    coarse, fine = (_ride(scene, its, slider, count, n, least).answer for n in steps)
    between = _between(fine)
    return between, Reference(f"its own run in {steps[1]} steps", _apart(coarse, between)), 0.0


def _finest(own: Sequence[Entry]) -> Known:
    """An engine's own run at its shortest step, as well known as the step twice as long changes it."""
    coarse, fine = (entry.prepare()().answer for entry in own[-2:])
    between = _between(fine)
    name = f"its own run at a step of {own[-1].size:.3g} s"
    return between, Reference(name, _apart(coarse, between)), own[-1].size


def _between(run: Answer) -> Callable[[Array], tuple[Array, Array]]:
    """A run at any times within, by cubics."""
    from scipy.interpolate import CubicSpline

    way, speed = (CubicSpline(run[0], values) for values in run[1:])
    return lambda times: (way(times), speed(times))


def _apart(found: Answer, true: Callable[[Array], tuple[Array, Array]]) -> float:
    """The larger of the relative rms errors of way and speed."""
    return max(relative_rms(*pair) for pair in zip(found[1:], true(found[0]), strict=True))
