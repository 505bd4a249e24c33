"""Sliders between two beams that they press apart, and sliders whose forces grow before they are as they are.

By the statics of matrices written out, and by all equations of beam and feet at once (`feet`).
"""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.models.compiling import Call
from verify.motion.result import END
from verify.section import Section
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.braked import STILL
from verify.stress.motion.sliders import BAR, FORCES, HERTZ, PARTS, RATIO
from verify.stress.references.dense import Elements

STIFF, PRELOAD = 2.7e5, 0.9
CLASP = Slider(
    mass=0.021,
    mu=1e-9,
    slope=9.0,
    gravity=0.0,
    preload=PRELOAD,
    position=0.0579,
    coupling="two-way",
    contact=Contact(stiffness=STIFF),
    foot=(
        Foot(mass=0.006, offset=-0.011, mirrored=True),
        Foot(mass=0.004, offset=0.017, mirrored=True),
        Foot(mass=0.003, offset=0.029, mirrored=True),
    ),
)
"""Three feet between the beams."""


def _bent(own: Elements, places: Array, faces: Array) -> Array:
    """Nodal values of a beam at rest under a third of the preload at each point, on the material under it."""
    lever, found = faces * BAR.surface_distance, np.zeros(len(own.mass))
    for _ in range(9):
        load = np.zeros(len(found))
        for x, face, reach in zip(places.tolist(), faces.tolist(), lever.tolist(), strict=True):
            under = x + reach * float(own.row(x, 1) @ found)
            turned = reach * float(own.row(under, 1) @ found) * own.row(x, 1)
            load -= face * PRELOAD / 3.0 * (own.row(under, 0) + turned)
        found[own.free] = np.linalg.solve(own.kept(own.bent), load[own.free])
    return found


GIVEN: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "start": "rest"}
READ = (0.031, 0.0579, 0.1)


def clasped_error(periods: float) -> float:
    """Of how far two beams are bent by what they hold, and of the forces that hold it, as it is put down.

    Over 4e8 that of both later, and of what presses each foot: they swing by a thousandth of the part that a slope
    turns forces by, which is felt in their squares.
    """
    from verify.motor.run import run_motor

    run = run_motor(
        BAR,
        STILL,
        HERTZ,
        periods / HERTZ,
        slider=CLASP,
        held_speed=0.0,
        frozen=True,
        at=READ,
        samples=5,
        step=0.002 / HERTZ,
        **GIVEN,
    )
    own, places = Elements(BAR, np.linspace(0.0, BAR.length, PARTS + 1)), np.array([one.offset for one in CLASP.feet])
    bent = own.read(_bent(own, 0.0579 + places, np.ones(3)), np.array(READ), 0)
    size = float(abs(bent).max())
    start = float(abs(run.deflection[0] - bent).max()) / size + abs(float(run.normal_force[0]) / (2.0 * PRELOAD) - 1.0)
    later = float(abs(run.deflection - bent).max()) / size + float(abs(run.normal_force / (2.0 * PRELOAD) - 1.0).max())
    pressed = float(abs(run.pressures / (PRELOAD / 3.0) - 1.0).max())
    return largest(start, max(later, pressed) / 4e8, float(abs(run.height).max()) / size)


# --- Grown and gone ---------------------------------------------------------------------------------------------------

SPEED, LEGS = 0.37, (0.8, 0.7)
RIDER = replace(
    CLASP,
    preload=PRELOAD,
    coupling="one-way",
    foot=(Foot(mass=0.006, offset=-0.011), Foot(length=0.013, points=2, mass=0.004, offset=0.017, pitches=False)),
)
"""Its points reach from 0.011 m before its place to 0.02025 m beyond it."""


def grown_error(periods: float) -> float:
    """Of energies of a beam whose forces grow for so many periods under a motor, and go on; of way, time and steps."""
    from verify.motor.run import run_motor
    from verify.stress.motion.damped_books import _followed

    total = periods + LEGS[0]
    more: dict[str, Any] = GIVEN | {"count": 3, "slider": RIDER, "held_speed": SPEED, "step": 0.001 / HERTZ}
    first = run_motor(BAR, FORCES, HERTZ, total / HERTZ, soft_start_periods=periods, samples=6, **more)
    last = run_motor(BAR, FORCES, HERTZ, LEGS[1] / HERTZ, samples=4, continue_from=first, **more)
    basis, worst = MODELS["fem"].time_basis(BAR, 3, 9, "spline"), 0.0
    for run, seconds in ((first, total / HERTZ), (last, (total + LEGS[1]) / HERTZ)):
        exact = _followed(RATIO, HERTZ, seconds, ((periods / HERTZ, (0.0, 0.0, 3.0, -2.0)),))[:2]
        state = run.state
        found = 0.5 * np.array([state.rates @ state.rates, (basis.omegas * state.q) @ (basis.omegas * state.q)])
        worst = largest(worst, float(abs(found - exact).max() / exact.max()))
        worst = largest(worst, abs(state.travelled / (SPEED * seconds) - 1.0), abs(state.time / seconds - 1.0))
    steps = first.statistics.steps + last.statistics.steps
    return largest(worst, float(steps < 1000.0 * (total + LEGS[1])), float(first.statistics.stopped != END))


WAYS = ((41.0, 0.097 - 0.0579 - 0.02025, "came to a step of beam.section at 0.097 m"), (-41.0, 0.0469, "left the beam"))
"""A slider's speed, m/s, how far its foremost point may go, metres, and why it stops there."""


def gone_error(number: float) -> float:
    """Of how far a slider goes on at its speed until its foremost point leaves its ground, in halves of a step."""
    from verify.motor.run import run_motor

    speed, room, why = WAYS[int(number)]
    beam = replace(BAR, section=(Section(length=0.097), Section(length=0.023, thickness=0.011)))
    more: dict[str, Any] = GIVEN | {"count": 3, "slider": RIDER, "samples": 9}
    run = run_motor(beam, STILL, HERTZ, 0.003, held_speed=speed, step=2e-5, **more)
    off = abs(abs(run.state.travelled) - room) / (0.5 * abs(speed) * 2e-5)
    odd = run.statistics.stopped != why or abs(run.state.travelled / (speed * run.state.time) - 1.0) > 1e-9
    return float("inf") if odd else off


# --- What presses, what is left ---------------------------------------------------------------------------------------

UP, LOW = Foot(offset=0.003), Foot(offset=0.003, face="lower")
CANCELS: tuple[tuple[tuple[Foot, ...], float, bool], ...] = (
    ((UP, LOW), 0.0, True),
    ((UP, replace(LOW, offset=0.0031)), 0.0, False),
    ((UP, LOW), 9.81, False),
    ((UP, UP, LOW), 0.0, False),
    ((replace(UP, offset=-0.02), UP, LOW, replace(LOW, offset=-0.02)), 0.0, True),
    ((replace(UP, offset=-0.02), replace(UP, offset=0.04), LOW, replace(LOW, offset=0.017)), 0.0, True),
    ((replace(UP, length=0.01, points=3), LOW), 0.0, True),
    ((Foot(mirrored=True), UP, LOW), 0.0, False),
)
"""Feet, gravity, whether what presses them on leaves neither a force nor a moment."""
LEFT = "left the links that it was put on"
GONE: tuple[tuple[float, tuple[float, ...], str], ...] = (
    (0.047, (0.2, 0.3, 0.35), LEFT),
    (-0.12, (0.2, 0.3, 0.35), LEFT),
    (0.047, (0.2, 0.3, 0.41), "came to a step"),
    (-0.12, (0.12, 0.3, 0.35), LEFT),
    (0.047, (0.2, 0.3, 0.41 + 3e-13), "came to a step"),
    (0.047, (0.2, 0.3, 0.41 + 3e-12), LEFT),
)
"""How far a slider at 0.3 m has gone, edges of the links that it was put on, what it has done.

Its ground goes from the beam's end at 0.12 m to a step at 0.41 m.
"""


def cancelled_error(number: float) -> float:
    """How many sliders are told wrongly to push a beam away that nothing holds."""
    from verify.motor.feet import Placed
    from verify.motor.resting import _moves

    wrong = 0
    for feet, gravity, cancels in CANCELS:
        slider = replace(CLASP, foot=feet, gravity=gravity, coupling="one-way")
        wrong += _moves(Placed(slider, 0.0579)) is cancels
    return float(wrong)


def left_error(number: float) -> float:
    """How many sliders that have gone beyond the links under them are told otherwise than where these end."""
    from verify.models.underfoot import LEFT_BEAM
    from verify.motor import records
    from verify.motor.feet import Placed, feet_of
    from verify.motor.on_chain import _gone

    wrong = 0
    for travelled, edges, why in GONE:
        feet = feet_of((Placed(replace(RIDER, foot=()), 0.3, travelled * 10.0),))
        feet.body[0, records.X] = 0.9 * travelled
        riding: Any = SimpleNamespace(start=0.3, feet=feet)
        stage: Any = SimpleNamespace(dt=0.01, ends=(LEFT_BEAM, "came to a step"), edges=np.array([0.12, 0.41]))
        wrong += _gone(np.array(edges) - 0.3, stage, riding) != why
    return float(wrong + sum(_told_otherwise()))


def _told_otherwise() -> Iterator[bool]:
    """Of which of several sliders left their ground: True where others are told, or one that is alone."""
    from verify.models.underfoot import LEFT_BEAM
    from verify.motor import records
    from verify.motor.feet import Placed, feet_of
    from verify.motor.outcome import _who_left

    stage: Any = SimpleNamespace(dt=0.01, ends=(LEFT_BEAM, "came to a step"), edges=np.array([0.0, 0.41]))
    for travelled, stopped, said in (
        ((0.2,), LEFT_BEAM, ()),
        ((0.0, 0.2), LEFT_BEAM, ("of 2 sliders number 2 left the beam, and the runs of all end there",)),
        ((-0.4, 0.2), LEFT_BEAM, ("all 2 sliders left the beam, and their runs end there",)),
        ((-0.4, 0.0, 0.2), LEFT_BEAM, ("of 3 sliders numbers 1 and 3 left the beam, and the runs of all end there",)),
        ((0.0, 0.0), LEFT_BEAM, ()),
        ((0.0, 0.2), END, ()),
    ):
        placed = tuple(Placed(replace(RIDER, foot=()), 0.3, 0.0) for _ in travelled)
        feet = feet_of(placed)
        feet.body[:, records.X] = travelled
        riding, ended, plan = (
            SimpleNamespace(start=0.3, feet=feet),
            SimpleNamespace(stopped=stopped),
            SimpleNamespace(stages=[stage], placed=placed),
        )
        yield _who_left(plan, riding, ended) != said  # type: ignore[arg-type]


def _loops() -> Iterator[Call]:
    from verify.motor import warm

    yield from warm.on_springs("tanh", "two-way")
    yield from warm.on_springs("tanh", "one-way")


ROWS: tuple[Row, ...] = (
    Floor(
        id="feet-between-two-beams",
        title="Two beams bent apart by what they hold, to 1e-12 as it is put down and 4e-4 two periods later",
        why="motor/resting.py: springs as deep as the beams give way, on the material under them; by matrices.",
        along="periods",
        at=(0.5, 2.0),
        promise=1e-12,
        error=clasped_error,
        kernels=_loops,
    ),
    Floor(
        id="forces-that-grow-under-a-motor",
        title="Energies of a beam under a motor whose forces grow and have grown, and as another run goes on",
        why="motor/stepping.py: the beam's own motion is closed from stage to stage; exponentials of matrices.",
        along="periods",
        at=(0.4, 2.3),
        promise=1e-9,
        error=grown_error,
        kernels=_loops,
    ),
    Floor(
        id="feet-that-leave",
        title="How far a slider with two feet goes to a step of the surface and to an end, in halves of a step",
        why="motor/stepping.py: points are looked for in the middle of a step.",
        along="run",
        at=(0.0, 1.0),
        promise=1.0,
        error=gone_error,
        kernels=_loops,
    ),
    Floor(
        id="presses-that-cancel",
        title="Feet above and below that press a free beam away, or turn it away, and those that do not",
        why="motor/resting.py: forces and moments of what presses.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=cancelled_error,
    ),
    Floor(
        id="links-that-are-left",
        title="Sliders beyond the links that they were put on: at a step of the surface, at an end, elsewhere",
        why="motor/on_chain.py: where those kept end, to rounding.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=left_error,
    ),
)
