"""Motions in time and sliders that are refused, before anything moves."""

from math import nan, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.models.underfoot import check_one_ground
from verify.motion.free_vibration import Shape, free_vibration
from verify.motion.simulate import simulate
from verify.motor.combine import check_combines, check_together
from verify.motor.feet import Placed
from verify.motor.going_on import check_runs
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Row
from verify.stress.references.beams import STEPPED, STRIP, held
from verify.stress.refusals import Ask, Case, refusals

FORCES = (PointForce(position=0.2),)
HERTZ = 37.0
PLACES = np.linspace(0.0, STRIP.length, 5)
LIGHT = Slider(mass=0.01, mu=0.3)


def run(
    on: Beam = STRIP,
    forces: tuple[PointForce, ...] = FORCES,
    duration: float = 0.01,
    model: str = "segment",
    count: int = 6,
    **more: Any,
) -> Ask:
    """Driven links in time."""
    return lambda: simulate(on, forces, HERTZ, duration, model=model, count=count, **more)


def going_on(count: int, **more: Any) -> Ask:
    """A run of so many links after one of six."""

    def ask() -> object:
        before = simulate(STRIP, FORCES, HERTZ, 0.01, count=6, samples=3)
        return simulate(STRIP, FORCES, HERTZ, 0.01, count=count, continue_from=before, **more)

    return ask


def let_go(shape: Shape | None = 1, amplitude: float | None = 1e-4, duration: float = 0.01, **more: Any) -> Ask:
    """Links let go from a shape."""
    return lambda: free_vibration(STRIP, shape, duration, amplitude=amplitude, count=6, **more)


def slider(**more: Any) -> Ask:
    """A light one with other figures."""
    return lambda: replace(LIGHT, **more)


def between(**more: Any) -> Ask:
    """A slider between two beams that feel it."""
    own = {"preload": 2.0, "coupling": "two-way", "contact": Contact(stiffness=1e5), "foot": (Foot(mirrored=True),)}
    return lambda: check_combines("segment", "rest", replace(LIGHT, **(own | more)))


TOUCHING = replace(LIGHT, contact=Contact(stiffness=1e5))
HARD = replace(LIGHT, contact=Contact(), coupling="one-way")
MIRRORED: dict[str, Any] = {"gravity": 0.0, "preload": 2.0, "coupling": "two-way", "foot": (Foot(mirrored=True),)}


def together(*others: Slider, first: Slider = TOUCHING) -> Ask:
    """Sliders on one beam."""
    return lambda: check_together("segment", "rest", (first, *others))


def beside(**more: Any) -> Ask:
    """A slider, and one with other figures."""
    return together(replace(TOUCHING, **more))


def steadily(*sliders: Slider) -> Ask:
    """Sliders on a steady beam."""
    return lambda: check_together("segment", "steady", sliders)


def after(*places: float | None, count: int = 6, on: Beam = STRIP, speed: float = 0.0, **more: Any) -> Ask:
    """Sliders at 0.1 m and 0.2 m that go on from runs of sliders put on at places, the last of which ended otherwise.

    By `more`: at another time, or with other motions of the beam, (2,). All went at 0.3 m/s by their ends.
    """
    still = {"beam": STRIP, "model": "segment", "count": 6, "time": 0.5, "q": np.zeros(2), "rates": np.zeros(2)}
    still |= {"speed": 0.3}
    ends = [still] * (len(places) - 1) + [still | more] * bool(places)
    runs: Any = [
        SimpleNamespace(state=SimpleNamespace(**end), start=at, slider=replace(TOUCHING, speed=0.1))
        for end, at in zip(ends, places, strict=True)
    ]
    request: Any = SimpleNamespace(beam=on, model="segment", count=count)
    put = replace(TOUCHING, speed=speed)
    return lambda: check_runs(runs, request, (Placed(put, 0.1), Placed(put, 0.2)))


def apart(*places: float) -> Ask:
    """Sliders on a beam with a step at 0.4 m."""
    return lambda: check_one_ground(STEPPED, places)


def growing(seconds: float, *coefficients: float) -> dict[str, Any]:
    """Forces that grow in one piece."""
    return {"envelope": ((seconds, coefficients),)}


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-motions",
        "Motions in time that are not begun",
        "docstrings of simulate and free_vibration: times, steps, starts and shapes; a slider sees its drive.",
        Case("duration = 0.0", run(duration=0.0), run(duration=1e-4)),
        Case("samples = 1:", run(samples=1), run(samples=2)),
        Case("samples = 10000001", run(samples=10_000_001)),
        Case("modal_damping = 1.0", run(modal_damping=1.0), run(modal_damping=0.99)),
        Case("modal_damping = -1e-09", run(modal_damping=-1e-9)),
        Case("at = 0.7301", run(at=(0.7301,)), run(at=(0.73,))),
        Case("at = -1e-09", run(at=(-1e-9,)), run(at=(0.0,))),
        Case("start = 'still'", run(start="still"), run(start="steady")),
        Case("soft_start_periods = -1e-09", run(soft_start_periods=-1e-9), run(soft_start_periods=0.0)),
        Case("soft_start_periods = 0.2 with start", run(soft_start_periods=0.2, start="steady"), run(start="steady")),
        Case("soft_start_periods = 0.2 with continue_from", going_on(6, soft_start_periods=0.2), going_on(6)),
        Case("soft_start_periods = 0.2 and", run(soft_start_periods=0.2, **growing(0.01, 0.0, 1.0))),
        Case("the forces grow over", run(soft_start_periods=0.371), run(soft_start_periods=0.369)),
        Case("envelope", run(**growing(0.0, 1.0)), run(**growing(0.01, 0.0, 1.0))),
        Case("envelope", run(**growing(0.01))),
        Case("envelope", run(**growing(0.01, nan))),
        Case("continue_from is of model = 'segment', count = 6 and this run of", going_on(7)),
        Case("steps_per_period = 0", run(steps_per_period=0), run(steps_per_period=64)),
        Case("steps_per_period = 0", run(slider=LIGHT, steps_per_period=0)),
        Case("step = 0.0", run(step=0.0, slider=LIGHT), run(step=None)),
        Case("step = 1e-12", run(step=1e-12, slider=LIGHT)),
        Case("step = 0.00675", run(step=0.25001 / HERTZ, slider=LIGHT)),
        Case("slider.line = 'raw' is the edge", run(model="fem", slider=replace(LIGHT, line="raw"))),
        Case("slider.line = 'raw' is for", run(start="steady", slider=replace(LIGHT, line="raw"))),
        Case("slider.contact is of a slider", run(slider=replace(LIGHT, contact=Contact()))),
        Case("slider.position = 0.7301", run(slider=replace(LIGHT, position=0.7301))),
        Case("model = 'linear'", run(model="linear")),
        Case("beam.supports = ['free', 'free']", run(held("free", "free"))),
        Case("forces is empty", run(forces=())),
        Case("duration = 0.0", let_go(duration=0.0), let_go()),
        Case("modal_damping = 1.0", let_go(modal_damping=1.0), let_go(modal_damping=0.99)),
        Case("samples = 1:", let_go(samples=1), let_go(samples=2)),
        Case("samples = 1000001", let_go(samples=1_000_001)),
        Case("at = 0.7301", let_go(at=(0.7301,)), let_go(at=(0.73,))),
        Case(
            "shape is None",
            let_go(None, None),
            let_go(None, None, velocity=lambda x: np.sin(pi * x / STRIP.length)),
        ),
        Case("velocity = 2", let_go(velocity=2)),
        Case("amplitude = 0.0001", let_go((PLACES, 0.0 * PLACES)), let_go((PLACES, 0.0 * PLACES), None)),
        Case("shape = 0", let_go(0), let_go(1)),
        Case("shape = 6", let_go(6), let_go(5)),
        Case("amplitude is missing", let_go(1, None)),
        Case("amplitude = nan", let_go(1, nan)),
        Case("shape = 'sine'", let_go("sine", None)),  # type: ignore[arg-type]
        Case("shape has x", let_go((PLACES, PLACES[:4]), None)),
        Case("shape has x", let_go((PLACES, nan * PLACES), None)),
        Case("shape[0] runs from 0.73", let_go((PLACES[::-1], PLACES), None)),
        Case("shape[0] runs from 0.0", let_go((0.99 * PLACES, PLACES), None)),
        Case("shape[0] runs from 0.001", let_go((PLACES + 1e-3, PLACES), None)),
        Case("shape(x) answers", let_go(lambda x: nan, None)),
    ),
    refusals(
        "refused-sliders",
        "What no slider is",
        "slider.py: laws, contacts and feet that go together.",
        Case("slider.gravity = 9.81 with slider.foot.mirrored", between(), between(gravity=0.0)),
        Case("slider.preload_stiffness = 7.0 with", between(gravity=0.0, preload_stiffness=7.0)),
        Case("slider.position = 0.5 m stands on another", apart(0.2, 0.5), apart(0.2, 0.39)),
        Case("sliders is empty", lambda: check_together("segment", "rest", ()), together()),
        Case("sliders: some are between two beams", beside(**MIRRORED), together(first=replace(TOUCHING, **MIRRORED))),
        Case(
            "slider.law differs among sliders on one beam, ['coulomb', 'tanh']", beside(law="coulomb"), beside(mu=0.7)
        ),
        Case("slider.slope differs", beside(slope=7.0), beside(position=0.2)),
        Case("slider.coupling differs", beside(coupling="two-way"), beside(preload=2.0)),
        Case("sliders: a hard contact is of one", steadily(HARD, HARD), steadily(HARD)),
        Case("continue_from has 1 runs for 2 sliders", after(0.1), after(0.1, 0.2)),
        Case("continue_from has 3 runs for 2 sliders", after(0.1, 0.2, 0.3), after()),
        Case("continue_from is of a slider that was put on at 0.3 m", after(0.1, 0.3), after(None, 0.2)),
        Case(
            "continue_from is of a slider that goes at 0.3 m/s", after(0.1, 0.2, speed=0.2), after(0.1, 0.2, speed=0.3)
        ),
        Case("continue_from is of a slider that goes at", after(0.1, 0.2, speed=-0.1), after(0.1, 0.2, speed=0.1)),
        Case("continue_from is of model = 'segment', count = 6", after(0.1, 0.2, count=7)),
        Case("continue_from is of another beam", after(0.1, 0.2, on=STEPPED)),
        Case("continue_from holds runs that end at", after(0.1, 0.2, time=0.6), after(0.1, 0.2, time=0.5)),
        Case("continue_from holds runs under which", after(0.1, 0.2, q=np.ones(2)), after(0.1, 0.2, q=np.zeros(2))),
        Case("continue_from holds runs under which", after(0.1, 0.2, rates=np.ones(2))),
        Case("slider.mass = 0.0", slider(mass=0.0), slider(mass=1e-9)),
        Case("slider.mu = 0.0", slider(mu=0.0), slider(mu=1e-9)),
        Case("slider.slope = 0.0", slider(slope=0.0), slider(slope=1e-9)),
        Case("slider.preload = -1e-09", slider(preload=-1e-9), slider(preload=0.0)),
        Case("slider.law = 'viscous'", slider(law="viscous")),
        Case(
            "slider.mu_static = 0.29",
            slider(mu_static=0.29, law="coulomb"),
            slider(mu_static=0.3, law="coulomb"),
        ),
        Case("slider.mu_static = 0.4 is for law", slider(mu_static=0.4)),
        Case("slider.gravity = 0.0", slider(gravity=0.0), slider(gravity=0.0, preload=0.1)),
        Case("slider.pull is of a slider", slider(pull=0.1), slider(pull=0.1, contact=Contact())),
        Case("slider.line = 'raw' is of a slider", slider(line="raw", contact=Contact())),
        Case("slider.contact.stiffness = 0.0", lambda: Contact(stiffness=0.0), lambda: Contact(stiffness=1.0)),
        Case(
            "slider.contact.restitution = 1.001",
            lambda: Contact(restitution=1.001),
            lambda: Contact(restitution=1.0),
        ),
        Case("slider.contact.stiffness = 1.0", lambda: Contact(stiffness=1.0, layer_stiffness=2.0)),
        Case("slider.contact.restitution = 0.5 is of a hard", lambda: Contact(stiffness=1.0, restitution=0.5)),
        Case("slider.contact.damping = 1.0 is of springs", lambda: Contact(damping=1.0)),
        Case("slider.foot.points = 0", lambda: Foot(points=0), lambda: Foot(points=1)),
        Case("slider.foot.face = 'left'", lambda: Foot(face="left")),  # type: ignore[arg-type]
        Case("slider.foot: a hard contact", slider(contact=Contact(), foot=(Foot(points=2, length=0.01),))),
    ),
)
