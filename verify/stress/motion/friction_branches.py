"""Friction alone: every branch of Eq. (3) in decimals, springs on belts from change to change, a surface that is given.

A slider on a belt is stepped by the loop of a beam's friction; a given surface by that of a chain's.
"""

from collections.abc import Iterator
from decimal import Decimal, localcontext
from functools import partial
from itertools import product
from math import acos, atan2, copysign, cos, hypot, pi, sin, tanh

import numpy as np

from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.motion.records import SLIPS, STICKS, TURNS, Given, Law, Rider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

# --- Eq. (3) ----------------------------------------------------------------------------------------------------------

FULL, SLOPE = 2.3, 31.0
"""Mu g and K."""
PULLS = (0.0, 0.37, -0.52, 0.995, -1.3, 1.7, 24.0)
"""Accelerations of the surface over mu g; from 1 on there is no speed at rest with it."""
RELATIVE = (0.0, 4e-3, -0.6, 2.9, -5.1, 27.0, -61.0)
"""Speeds over 1 / K."""


def law(static: float | None, kinetic: float = FULL, half: float = 0.0, following: bool = False) -> Law:
    """Friction alone, or on a surface that is followed."""
    return Law(
        kinetic=kinetic,
        static=static,
        slope=SLOPE if static is None else None,
        mass=1.0,
        half=half,
        gravity=9.81,
        following=following,
        held=False,
        load=9.81,
    )


def _ahead(x: Decimal, pull: Decimal) -> Decimal:
    """An integral of 1 / (tanh x + pull)."""
    one = Decimal(1)
    if abs(pull) == one:
        return pull * x / 2 - (-2 * pull * x).exp() / 4
    rises = (one + pull) * x.exp() - (one - pull) * (-x).exp()
    return (pull * x - (abs(rises) / 2).ln()) / (pull * pull - one)


def tanh_error(pulls: tuple[float, ...], time: float) -> float:
    """Of a speed after a step of so many 1 / (K mu g), over what full friction makes of it, by that integral.

    What is missing of the time counts with the rate at the end. A speed at rest with the surface takes long to reach.
    """
    from verify.motion.friction_kernels import slide_on_belt

    worst, dt = 0.0, time / (SLOPE * FULL)
    with localcontext() as context:
        context.prec = 45
        slope, full = Decimal(SLOPE), Decimal(FULL)
        for pull, relative in product(pulls, RELATIVE):
            state = np.array([0.3, relative / SLOPE, 0.0])
            slide_on_belt(1, dt, law(None), 0.0, 0.0, -pull * FULL, state, np.zeros((0, 3)))
            start, end, a = Decimal(relative / SLOPE) * slope, Decimal(float(state[1])) * slope, Decimal(pull)
            falls = (2 * end).exp()
            rate = (falls - 1) / (falls + 1) + a
            if abs(rate) < 1e-30:
                worst = largest(worst, abs(float(end - start)) / time if time < 50.0 else 0.0)
                continue
            lack = _ahead(end, a) - _ahead(start, a) + Decimal(dt) * slope * full
            worst = largest(worst, abs(float(lack * rate)) / time)
    return worst


# --- Springs on belts -------------------------------------------------------------------------------------------------

OMEGA, PULL = 13.0, 0.9
"""Of mass and spring, rad/s; a constant acceleration."""
BELTS: tuple[tuple[float, float, float, float], ...] = (
    (0.05, 1.1, 2.3, 0.2),
    (-0.07, 0.8, 1.5, -0.5),
    (0.0, 0.3, 0.5, 1.7),
    (0.4, 0.2, 0.2, -0.3),
    (0.0, 0.6, 1.9, 0.2),
)
"""Speeds of belts, kinetic and static friction by the mass, speeds at first."""
SECONDS, STEPS = 2.3, 40_000


def _sprung(belt: float, kinetic: float, static: float, speed: float) -> tuple[list[tuple[float, float, float]], Array]:
    """((time, kind, place) of all changes, (place, speed) in the end) of a mass from 0.1 m, arc by arc."""
    t, x, v, square = 0.0, 0.1, speed, OMEGA**2
    found: list[tuple[float, float, float]] = []
    sticks, side = False, copysign(1.0, speed - belt)
    while t < SECONDS:
        left = SECONDS - t
        if sticks:
            edge = (PULL - copysign(static, -belt)) / square
            stays = (edge - x) / belt if belt else left
            if stays >= left:
                return found, np.array([x + belt * left, belt])
            t, x, v, sticks = t + stays, edge, belt, False
            side = copysign(1.0, PULL - square * x)
            found.append((t, SLIPS, x))
            continue
        rest = (PULL - side * kinetic) / square
        size, lead = hypot(x - rest, v / OMEGA), atan2(-v / OMEGA, x - rest)  # x = rest + size cos(omega t + lead)
        ratio = -belt / (size * OMEGA)
        half = [copysign(1.0, s) * acos(ratio) for s in (1.0, -1.0)] if abs(ratio) <= 1.0 else []
        turns = [(pi / 2 + s - lead) % (2.0 * pi) for s in half]
        stays = min((turn / OMEGA for turn in turns if 1e-7 < turn < 2.0 * pi - 1e-7), default=left)
        until = min(stays, left)
        x, v = rest + size * cos(OMEGA * until + lead), -size * OMEGA * sin(OMEGA * until + lead)
        t += until
        if stays >= left:
            break
        v, need = belt, PULL - square * x
        sticks = abs(need) <= static
        side = copysign(1.0, need)
        found.append((t, STICKS if sticks else TURNS, x))
    return found, np.array([x, v])


def sprung_error(number: float) -> float:
    """Of changes of a mass on a spring and a belt and where it ends, over a period and its first place."""
    from verify.motion.friction_kernels import slide_on_belt

    belt, kinetic, static, speed = BELTS[int(number)]
    state, events = np.array([0.1, speed, 0.0]), np.zeros((64, 3))
    n = slide_on_belt(STEPS, SECONDS / STEPS, law(static, kinetic), belt, OMEGA**2, PULL, state, events)
    exact, end = _sprung(belt, kinetic, static, speed)
    if n != len(exact) or events[:n, 1].tolist() != [kind for _, kind, _ in exact]:
        return 1.0
    off = abs(events[:n] - np.array(exact).reshape(n, 3)) * (OMEGA / (2.0 * pi), 0.0, 10.0)
    return float(largest(off.max(initial=0.0), abs(state[0] - end[0]) / 0.1, abs(state[1] - end[1]) / (0.1 * OMEGA)))


def smooth_error(belt: float) -> float:
    """Of a mass on a spring and a belt under Eq. (3), place and speed in the end, by Runge and Kutta's method."""
    from scipy.integrate import solve_ivp

    from verify.motion.friction_kernels import slide_on_belt

    def flow(t: float, y: Array) -> list[float]:
        return [float(y[1]), PULL - OMEGA**2 * float(y[0]) - FULL * tanh(SLOPE * (float(y[1]) - belt))]

    found = solve_ivp(flow, (0.0, 0.6), [0.1, 0.3], "DOP853", rtol=1e-10, atol=1e-13).y[:, -1]
    state = np.array([0.1, 0.3, 0.0])
    slide_on_belt(6000, 1e-4, law(None), belt, OMEGA**2, PULL, state, np.zeros((0, 3)))
    return float(largest(abs(state[0] - found[0]) / 0.1, abs(state[1] - found[1]) / (0.1 * OMEGA)))


# --- A surface that is given ------------------------------------------------------------------------------------------

CUBIC, EDGES, HALF, TURN = np.array([1.3, -0.7, 2.9, -1.9]) * 1e-3, (-0.02, 0.05), 4e-3, 2.0 * pi * 97.0
"""Powers of the place on a piece, its ends, half the thickness, rad/s."""
DRAWN = np.array([0.03, -0.017])
"""Speeds of those ends along x at their largest, m/s."""
LONG, KEPT = 6e-3, 6000
"""Seconds, and steps."""


def _surface(t: float, x: float) -> tuple[float, ...]:
    """Deflection's slope and bend at the material under x and their rates with its own; speed along x over it."""
    length = EDGES[1] - EDGES[0]
    powers = [np.polynomial.polynomial.polyder(CUBIC, d) / length**d for d in range(3)]
    c, s = cos(TURN * t + 0.4), -TURN * sin(TURN * t + 0.4)
    value = np.polynomial.polynomial.polyval
    z = (x - EDGES[0]) / length
    whole = float(DRAWN[0] + z * (DRAWN[1] - DRAWN[0])) * sin(211.0 * t)
    z += HALF * c * float(value(z, powers[1])) / length
    w, slope, bend = (float(value(z, power)) for power in powers)
    return c * slope, c * bend, s * w, s * slope, whole


def _moved(t: float, x: float, v: float, follows: bool) -> tuple[float, float, float]:
    """(speed of the surface, how fast the slider gets on, its acceleration without friction)."""
    slope, bend, rise, turn, whole = _surface(t, x)
    speed = (rise * slope - HALF * turn) / hypot(1.0, slope) + whole
    if not follows:
        return speed, v, 0.0
    return speed, v - slope * rise, rise * (turn + bend * v) - 9.81 * slope


def given_error(number: float) -> float:
    """Of a slider's way, speed and friction on a surface that is given, over the largest: Eq. (3), followed or not.

    The third slides under Coulomb's law, the fourth sticks to the surface all the time, and the fifth is gripped by
    Eq. (3) so hard that 1 / K of relative speed is lost within ten steps.
    """
    from scipy.integrate import solve_ivp

    from verify.motion.kernels import slide_given
    from verify.motion.stepping import contact_space, fresh_motion

    follows, sticks, grips = number in (1.0, 2.0), number == 3.0, number == 4.0
    static = None if number < 2.0 or grips else 1e4 if sticks else FULL
    kinetic, along = (1e4 if sticks or grips else FULL), _moved(0.0, 0.0, 0.0, False)[0]
    speed = along if sticks else along + 0.03 if grips else 1.9

    def flow(t: float, y: Array) -> list[float]:
        along, ahead, pull = _moved(t, float(y[0]), float(y[1]), follows)
        if sticks:
            return [along, 0.0]
        slip = float(y[1]) - along
        return [ahead, pull - kinetic * (tanh(SLOPE * slip) if static is None else copysign(1.0, slip))]

    times = np.linspace(0.0, LONG, 13)
    exact = solve_ivp(flow, (0.0, LONG), [0.0, speed], "DOP853", times, rtol=1e-12, atol=1e-15, max_step=2e-4).y
    half = np.arange(2 * KEPT + 1) * 0.5 * LONG / KEPT
    swings = np.stack([np.cos(TURN * half + 0.4), -TURN * np.sin(TURN * half + 0.4)], axis=1)
    given = Given(
        local=swings[:, :, None] * CUBIC,
        along=DRAWN * np.sin(211.0 * half)[:, None],
        edges=np.array(EDGES, dtype=float),
    )
    rider = Rider(fresh_motion(speed, sticks), law(static, kinetic, HALF, follows), None)
    kept = np.zeros((KEPT + 1, 4))
    if slide_given(KEPT, LONG / KEPT, given, rider, kept, contact_space()) != KEPT:
        return 1.0
    rows = kept[:: KEPT // 12]
    seen = np.array(
        [_moved(float(t), float(y[0]), float(y[1]), follows)[0] for t, y in zip(times, exact.T, strict=True)]
    )
    if sticks:
        exact[1] = seen
    pairs = [(rows[:, 0], exact[0]), (rows[:, 1], exact[1]), (rows[:, 3], seen)]
    if static is None:
        pairs.append((rows[:, 2], -kinetic * np.tanh(SLOPE * (exact[1] - seen))))
    if sticks:  # what holds it on gives it its speed
        before = kept[KEPT // 12 - 1 :: KEPT // 12]
        pairs.append((rows[1:, 2], (rows[1:, 1] - before[:12, 1]) * KEPT / LONG))
    return largest(float(abs(a - b).max() / abs(b).max()) for a, b in pairs)


def _belts() -> Iterator[Call]:
    from verify.motion.warm import on_belt

    yield from on_belt("tanh")
    yield from on_belt("coulomb")


def _chains() -> Iterator[Call]:
    from verify.motion.warm import on_chain

    yield from on_chain("tanh")
    yield from on_chain("coulomb")


ROWS: tuple[Row, ...] = (
    Floor(
        id="friction-branch-by-branch",
        title="Tanh friction in one step, brief to long, slow to fast, on surfaces that drag, against an integral",
        why="motion/friction_kernels.py: exact; 1e-11 of a short step, roundings of speeds in others.",
        along="1/(K mu g)",
        at=(1e-3, 0.04, 0.8, 3.0, 11.0, 150.0),
        promise=2e-11,
        error=partial(tanh_error, PULLS),
        kernels=_belts,
    ),
    Floor(
        id="friction-at-its-edge",
        title="The same on surfaces that drag with all of mu g",
        why="motion/friction_kernels.py: there formulas part, and 1e-7 of the drag is added.",
        along="1/(K mu g)",
        at=(0.04, 0.8, 11.0),
        promise=1e-7,
        error=partial(tanh_error, (1.0, -1.0)),
        kernels=_belts,
    ),
    Floor(
        id="springs-on-belts",
        title="Five masses on springs and belts: when and where they stick, slip and turn, arc by arc",
        why="motion/friction_kernels.py: each step to order 2, (omega dt)^2 = 5.6e-7, over changes.",
        along="belt",
        at=(0.0, 1.0, 2.0, 3.0, 4.0),
        promise=2e-6,
        error=sprung_error,
        kernels=_belts,
    ),
    Floor(
        id="springs-on-rough-belts",
        title="A mass on a spring and a belt under Eq. (3), against Runge and Kutta's method",
        why="motion/friction_kernels.py: the spring's force to order 2 in steps of 1e-4 s, (omega dt)^2 = 1.7e-6.",
        along="m/s",
        at=(0.0, 0.1, -0.4),
        promise=1e-7,
        error=smooth_error,
        kernels=_belts,
    ),
    Floor(
        id="surfaces-given",
        title="Three sliders on a surface that is given, as a chain's is: Eq. (3), followed, Coulomb's law",
        why="motion/kernels.py: smooth friction to order 4 in steps of 1e-6 s.",
        along="run",
        at=(0.0, 1.0, 2.0),
        promise=1e-11,
        error=given_error,
        kernels=_chains,
    ),
    Floor(
        id="surfaces-that-carry",
        title="A slider that sticks to that surface all the time",
        why="motion/kernels.py: what sticks moves with the surface, to order 2 in a step.",
        along="run",
        at=(3.0,),
        promise=1e-7,
        error=given_error,
        kernels=_chains,
    ),
    Floor(
        id="surfaces-that-grip",
        title="A slider that Eq. (3) grips hard, faster than the surface by 1 / K at first, and its way",
        why="motion/way_kernels.py: exact on a surface that speeds up evenly in a step.",
        along="run",
        at=(4.0,),
        promise=1e-9,
        error=given_error,
        kernels=_chains,
    ),
)
