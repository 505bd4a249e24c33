"""Sliders on feet on a beam of two elements, against all their equations at once.

A foot above the beam has the height z and the pitch p; its point at s from the middle presses the material below it,
X = x + (h/2) w'(x), by a spring and a dashpot on w(X) - z - s p, and rubs by the speed of the surface there. What it
does to the beam is what every mode's motion does to it. Below the beam all of that is turned round.
"""

from collections.abc import Iterator
from functools import cache, partial
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.motor.records import STRETCH
from verify.motor.result import MotorRun
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.sliders import BAR, FORCES, HERTZ, PARTS, RATIO
from verify.stress.references.dense import CUBICS, Elements

PERIOD = 1.0 / HERTZ
STEPS = 4096
"""Of a period."""
LEAD, LEG = 0.3, 0.45
"""Periods that a run has had, and that are followed."""
FEET = (
    Foot(length=0.013, points=2, offset=-0.004, mass=0.006, inertia=3.1e-7),
    Foot(offset=0.009, mass=0.004, face="lower"),
)
START = Slider(
    mass=0.021,
    mu=0.07,
    slope=9.0,
    position=0.0579,
    speed=0.11,
    preload=260.0,
    preload_stiffness=3e3,
    pull=1.3,
    coupling="one-way",
    contact=Contact(stiffness=2.7e5, damping=3.1),
    foot=FEET,
)
GIVES = Contact(stiffness=2.7e5, damping=3.1, tangential_stiffness=4e4)
PRESSED = replace(START, preload=900.0)
"""So that no foot leaves a beam that does not feel it."""
RUNS: tuple[tuple[Slider, float | None], ...] = (
    (PRESSED, None),
    (replace(START, coupling="two-way"), None),
    (replace(START, coupling="two-way", law="coulomb", slope=None, contact=GIVES, mu=2.0), None),
    (replace(PRESSED, law="coulomb", slope=None, speed=9.1, mu=0.03), None),
    (PRESSED, -0.7),
    (replace(START, coupling="two-way", law="coulomb", slope=None, speed=-4.7, mu=0.03), None),
)
"""With the speed at which each is held: rubbed by tanh, felt, sticking to what gives way, sliding all the time."""
BOOKS = ("across", "uphill", "along", "pressed", "pulled", "rubbed", "damped", "on_beam")
"""Works, as a ledger calls them."""


class Under(NamedTuple):
    """What all points (p,) see and do."""

    depth: Array
    closing: Array
    lift: Array
    """Rate of the surface's height under them."""
    uphill: Array
    """The part of that which is the slope's that they go along."""
    along: Array
    """Speed of the surface."""
    lifted: Array
    """(p, n): how every mode lifts what they stand on."""
    dragged: Array
    """(p, n): how every mode moves the surface along."""


class Standing:
    """A beam, a slider and its feet as one system of equations: [q, dq/dt, x, v, feet x 4, stretches, works]."""

    def __init__(self, slider: Slider, held: float | None) -> None:
        own = Elements(BAR, np.linspace(0.0, BAR.length, PARTS + 1))
        self.squares, vectors = own.modes
        vectors = vectors * np.sign(vectors[1])  # up from the left pin on
        self.n, self.part, self.half = len(self.squares), BAR.length / PARTS, BAR.surface_distance
        sizes = np.array([1.0, self.part, 1.0, self.part])[:, None]
        self.cubics = np.array([CUBICS.T @ (sizes * vectors[2 * i : 2 * i + 4]) for i in range(PARTS)])
        self.loads = vectors.T @ own.load(FORCES)
        self.slider, self.held, self.contact = slider, held, slider.contact
        feet = slider.feet
        cells = [foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5) for foot in feet]
        self.foot = np.repeat(np.arange(len(feet)), [foot.points for foot in feet])
        self.arm, share = np.concatenate(cells), 1.0 / np.array([feet[i].points for i in self.foot])
        self.face = np.array([-1.0 if feet[i].face == "lower" else 1.0 for i in self.foot])
        self.offset = self.arm + np.array([feet[i].offset for i in self.foot])
        assert self.contact is not None
        self.stiff, self.dashpot = share * float(self.contact.stiffness or 0.0), share * self.contact.damping
        self.grip = share * float(self.contact.tangential_stiffness or 0.0)
        self.masses = np.array([float(foot.mass or 0.0) for foot in feet])
        self.inertias = np.array([float(foot.inertia or np.inf) for foot in feet])
        sides = np.array([1.0 if foot.face == "lower" else -1.0 for foot in feet])
        self.press = (sides * slider.preload - slider.mass * slider.gravity) / len(feet)

    def shapes(self, x: Array) -> tuple[Array, Array, Array]:
        """Deflection, slope and bend of all modes at places, (p, n) each."""
        i = np.clip((x / self.part).astype(int), 0, PARTS - 1)
        z, none, one = x / self.part - i, np.zeros(len(x)), np.ones(len(x))
        powers = ((one, z, z**2, z**3), (none, one, 2.0 * z, 3.0 * z**2), (none, none, 2.0 * one, 6.0 * z))
        found = (np.einsum("kp,pkn->pn", np.array(row), self.cubics[i]) for row in powers)
        return tuple(rows / self.part**d for d, rows in enumerate(found))

    def seen(self, y: Array) -> Under:
        """By all points."""
        n, q, rates = self.n, y[: self.n], y[self.n : 2 * self.n]
        x, v, feet = float(self.slider.position or 0.0) + y[2 * n], y[2 * n + 1], self.feet(y)
        lever = self.half * self.face
        _, over, bent = self.shapes(x + self.offset)
        value, first, _ = self.shapes(x + self.offset + lever * (over @ q))
        slope, bend = first @ q, bent @ q
        ramp = slope * (v + lever * bend * v)
        lift = value @ rates + slope * lever * (over @ rates) + ramp
        size = np.hypot(1.0, slope)[:, None]
        dragged = (slope[:, None] * value - lever[:, None] * first) / size
        height, climb, pitch, turn = feet[self.foot].T
        return Under(
            depth=self.face * (value @ q - height - self.arm * pitch),
            closing=self.face * (lift - climb - self.arm * turn),
            lift=lift,
            uphill=ramp,
            along=dragged @ rates,
            lifted=value + (slope * lever)[:, None] * over,
            dragged=dragged,
        )

    def feet(self, y: Array) -> Array:
        """(feet, 4): height, its rate, pitch, its rate."""
        return y[2 * self.n + 2 :][: 4 * len(self.masses)].reshape(-1, 4)

    def flow(self, t: float, y: Array) -> Array:
        """Of all that moves, and of the works of `BOOKS`."""
        n, here, feet = self.n, self.seen(y), self.feet(y)
        rates, v, turn = y[n : 2 * n], y[2 * n + 1], 2.0 * pi * HERTZ * t
        push = self.stiff * here.depth + self.dashpot * here.closing
        slip, most = here.along - v, self.slider.mu * push
        stretch = y[2 * n + 2 + feet.size :][: len(push)]
        if self.grip.any():
            rub = self.grip * stretch
        else:
            rub = most * (np.sign(slip) if self.slider.steepness is None else np.tanh(self.slider.steepness * slip))
        drive = self.loads.real * cos(turn) - self.loads.imag * sin(turn)
        force = drive - self.squares * y[:n] - 2.0 * RATIO * np.sqrt(self.squares) * rates
        if self.slider.coupling == "two-way":
            force = force - (self.face * push) @ here.lifted - rub @ here.dragged
        pressed = self.press - float(self.slider.preload_stiffness) * feet[:, 0]
        given = np.bincount(self.foot, self.face * push, len(feet))
        turned = np.bincount(self.foot, self.face * push * self.arm, len(feet))
        moved = np.stack([feet[:, 1], (pressed + given) / self.masses, feet[:, 3], turned / self.inertias], axis=1)
        gained = 0.0 if self.held is not None else (rub.sum() + self.slider.pull) / self.slider.mass
        works = (
            (self.face * push) @ (here.lift - here.uphill),
            (self.face * push) @ here.uphill,
            rub @ here.along,
            pressed @ feet[:, 1],
            v * (self.slider.pull if self.held is None else -rub.sum()),
            rub @ slip,
            (self.dashpot * here.closing) @ here.closing,
            -(self.face * push) @ (here.lift - here.uphill) - rub @ here.along,
        )
        return np.concatenate([rates, force, [v, gained], moved.ravel(), slip, works])


@cache
def _legs(number: int) -> tuple[MotorRun, MotorRun]:
    from verify.motor.run import run_motor

    slider, held = RUNS[number]
    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "start": "rest", "samples": 2}
    given |= {"slider": slider, "step": PERIOD / STEPS, "held_speed": held}
    first = run_motor(BAR, FORCES, HERTZ, LEAD * PERIOD, **given)
    return first, run_motor(BAR, FORCES, HERTZ, LEG * PERIOD, continue_from=first, **given)


@cache
def _followed(number: int) -> tuple[Standing, Array]:
    """The equations, and the last state."""
    from scipy.integrate import solve_ivp

    standing, before = Standing(*RUNS[number]), _legs(number)[0].state
    along = np.array([before.travelled, before.speed])
    parts = [before.q, before.rates, along, before.feet.ravel(), before.touch[:, STRETCH], np.zeros(len(BOOKS))]
    span = (before.time, before.time + LEG * PERIOD)
    found = solve_ivp(standing.flow, span, np.concatenate(parts), "DOP853", rtol=1e-8, atol=1e-13)
    return standing, found.y[:, -1]


def _off(found: Any, exact: Any) -> float:
    return float(abs(np.asarray(found) - exact).max() / abs(np.asarray(exact)).max())


def stood_error(number: float) -> float:
    """Of the beam's modes and their rates, of way and speed, of height and pitch of the feet and their rates."""
    _followed.cache_clear()
    _legs.cache_clear()  # every row runs what it judges
    (standing, y), run = _followed(int(number)), _legs(int(number))[1]
    n, feet, state = standing.n, standing.feet(y), run.state
    pairs = [(state.q, y[:n]), (state.rates, y[n : 2 * n]), (state.travelled, y[2 * n]), (state.speed, y[2 * n + 1])]
    pairs += zip(state.feet.T, feet.T, strict=True)
    return largest(_off(*pair) for pair in pairs)


def works_error(number: float) -> float:
    """Of the works in the books, over each and a hundredth of the largest, and of what they miss."""
    _followed.cache_clear()
    _legs.cache_clear()
    (_, y), books = _followed(int(number)), _legs(int(number))[1].ledger
    felt = RUNS[int(number)][0].coupling == "two-way"
    exact = dict(zip(BOOKS, y[-len(BOOKS) :].tolist() if felt else y[-len(BOOKS) : -1].tolist(), strict=felt))
    size = max(map(abs, exact.values()))
    off = [abs(getattr(books, name) - work) / (abs(work) + 0.01 * size) for name, work in exact.items()]
    return float(largest(*off, abs(books.residual) / size))


def rest_error(share: float) -> float:
    """Of feet on a beam at rest, pulled along by a share of mu N: they stay, friction is the pull, points share it.

    They stand where springs and what presses them on by its own stiffness balance. Over mu N, over the
    load, over the depth.
    """
    from verify.motor.run import run_motor

    limit = START.mu * START.preload
    plain = Contact(stiffness=2.7e5)
    slider = replace(START, law="coulomb", slope=None, speed=0.0, pull=share * limit, contact=plain)
    still = tuple(replace(one, amplitude=0.0) for one in FORCES)
    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "start": "rest", "samples": 3}
    run = run_motor(BAR, still, HERTZ, PERIOD, slider=slider, **given)
    press = Standing(slider, None).press
    heights = press / (2.7e5 + 3e3)
    off = [abs(run.height[-1] - heights).max() / abs(heights).max(), abs(float(run.speed[-1])) * slider.mass / limit]
    carried = 2.7e5 * abs(heights)
    pressures = np.repeat(carried / (2.0, 1.0), (2, 1))
    off += [abs(run.pressures[-1] - pressures).max() / pressures.max()]
    off += [abs(float(run.normal_force[-1]) / carried.sum() - 1.0), abs(float(run.friction[-1]) + slider.pull) / limit]
    off += [abs(float(run.stuck_share[-1]) - 1.0), abs(float(run.contact_share[-1]) - 1.0)]
    return float(largest(*off, abs(run.ledger.rubbed) / limit))


def _loops() -> Iterator[Call]:
    from verify.motor import warm

    for law in ("tanh", "coulomb"):
        yield from warm.on_springs(law, "auto")


_row = partial(Floor, along="run")

ROWS: tuple[Row, ...] = (
    _row(
        id="feet-written-out",
        title="Beam, slider and feet above and below, which pitch: felt, rubbing, sticking to what gives way, held",
        why="motor/kernels.py: forces in the middle of a step of a 4096th of a period, of order 2; against all "
        "equations at once.",
        at=tuple(float(number) for number in range(len(RUNS))),
        promise=1e-4,
        error=stood_error,
        kernels=_loops,
    ),
    _row(
        id="works-of-feet",
        title="What three of these runs book: works across, uphill, along, of load and pull, friction, dashpots, beam",
        why="motor/feet_kernels.py: sums over mid-steps, of order 2; a hundredth of the largest is none.",
        at=(0.0, 2.0, 5.0),
        promise=3e-4,
        error=works_error,
        kernels=_loops,
    ),
    _row(
        id="feet-that-stick",
        title="Feet on a beam at rest, pulled along by less than friction holds: forces, heights, shares",
        why="motor/rub_kernels.py: points that stick share what is left; springs in a row carry the load to rounding.",
        at=(0.1, -0.6, 0.95),
        promise=1e-10,
        error=rest_error,
        kernels=_loops,
    ),
)
