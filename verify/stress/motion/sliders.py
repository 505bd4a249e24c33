"""Sliders on beams of few elements against all their equations at once: every law, coupling and way to follow.

The beam's motion is summed over the modes of matrices written out; slider and beam go on together by Runge and Kutta's
method of order 8, with the reaction that keeps the slider on the surface.
"""

from collections.abc import Callable, Iterator
from functools import cache, partial
from math import copysign, cos, hypot, pi, sin, tanh
from typing import Any, NamedTuple

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.motion.result import Motion
from verify.slider import Slider, changed
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.dense import CUBICS, Elements

BAR = Beam(
    length=0.12, width=0.011, thickness=0.009, youngs_modulus=2.3e9, density=1190.0, supports=("pinned", "clamped")
)
PARTS, HERTZ, RATIO, LEG, SAMPLES = 2, 610.0, 0.013, 0.8e-3, 5
"""Parts of the beam; the drive; the damping ratio of every mode; half the length of a run, and what is kept of it."""
FORCES = (
    PointForce(position=0.031, amplitude=57.0, phase_deg=25.0),
    PointForce(position=0.095, amplitude=33.0, phase_deg=-70.0),
)
STEP = 4e-7
START = Slider(mass=0.0041, mu=0.37, slope=9.0, position=0.0599, speed=0.61, preload=11.0, coupling="one-way")
"""It slides from one part of the beam to the next."""
PLACES = (0.03, 0.0593, 0.1)

BOOKS = ("work_in", "damped", "rubbed", "contact_on_beam", "normal_on_beam")
"""Works, as a ledger calls them."""
RUNS: tuple[Slider, ...] = (
    replace(START, kinematics="following"),
    replace(START, coupling="two-way", normal="massless"),
    replace(START, coupling="two-way", kinematics="following"),
    changed(START, coupling="two-way", law="coulomb", speed=-5.3),
    changed(START, law="coulomb", mu_static=0.5, speed=5.9),
    changed(START, coupling="two-way", normal="massless", law="coulomb", mu=70.0, speed=0.0),
    changed(START, coupling="two-way", normal="massless", law="coulomb", mu=0.2, speed=0.05, position=0.027),
    changed(
        START, coupling="two-way", normal="massless", law="coulomb", mu=0.2, mu_static=0.45, speed=0.05, position=0.027
    ),
)
"""Of those with Coulomb's law two slide all the time, one sticks, and the last two stick and slip."""
STICKS, CHANGES = 5, (6, 7)
EXACTLY: dict[str, Any] = {"rtol": 1e-7, "atol": 1e-11, "max_step": 1e-4}
CLOSELY: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-13, "max_step": 1e-4}
"""Of a beam that feels its slider, which steps are off from by more, and of one that does not."""


class Seen(NamedTuple):
    """What a slider at x sees of all modes (n,): at the material under it, and slope and bend of the mid-line at x."""

    value: Array
    first: Array
    second: Array
    over: Array
    bend: float
    along: Array
    """How every mode moves the surface along its tangent."""
    lifted: Array
    """How every mode lifts what stands on it: the way of its reaction."""


class Ridden:
    """A beam and a slider on it as one system of equations: modes, their rates, place and speed."""

    def __init__(self, slider: Slider, grown: Callable[[float], float]) -> None:
        own = Elements(BAR, np.linspace(0.0, BAR.length, PARTS + 1))
        self.squares, vectors = own.modes
        self.n, self.half, self.part = len(self.squares), BAR.surface_distance, BAR.length / PARTS
        sizes = np.array([1.0, self.part, 1.0, self.part])[:, None]
        self.cubics = [CUBICS.T @ (sizes * vectors[2 * i : 2 * i + 4]) for i in range(PARTS)]
        self.damped = 2.0 * RATIO * np.sqrt(self.squares)
        self.loads = vectors.T @ own.load(FORCES)
        self.slider, self.grown = slider, grown
        self.two_way = slider.coupling == "two-way"
        self.held, self.follows = slider.normal == "held", slider.kinematics == "following"
        self.sticks = slider == RUNS[STICKS]
        self.events: list[tuple[float, float, float]] = []
        self.tick = 1e-4 / float(np.sqrt(self.squares[-1]))

    def shapes(self, x: float) -> Array:
        """Deflection, slope and bend of all modes at a place, (3, n)."""
        i = min(max(int(x / self.part), 0), PARTS - 1)
        n, z = self.part, x / self.part - i
        powers = (
            (1.0, z, z**2, z**3),
            (0.0, 1.0 / n, 2.0 * z / n, 3.0 * z**2 / n),
            (0.0, 0.0, 2.0 / n**2, 6.0 * z / n**2),
        )
        return np.asarray(np.array(powers) @ self.cubics[i])

    def seen(self, y: Array) -> Seen:
        """By the slider."""
        q, (_, over, bent) = y[: self.n], self.shapes(y[2 * self.n])
        value, first, second = self.shapes(y[2 * self.n] + self.half * (q @ over))
        slope = q @ first
        along = (slope * value - self.half * first) / hypot(1.0, slope)
        return Seen(value, first, second, over, float(q @ bent), along, value + slope * self.half * over)

    def slip(self, y: Array, seen: Seen) -> float:
        """Speed of the slider over that of the surface."""
        return float(y[2 * self.n + 1] - y[self.n : 2 * self.n] @ seen.along)

    def friction(self, y: Array, seen: Seen) -> float:
        """On the slider, newton, where it slides."""
        slider, slip = self.slider, self.slip(y, seen)
        share = copysign(1.0, slip) if slider.steepness is None else tanh(slider.steepness * slip)
        return -slider.mu * slider.normal_force * share

    def ahead(self, y: Array, seen: Seen) -> float:
        """How fast it gets on along x."""
        fall = (y[: self.n] @ seen.first) * (y[self.n : 2 * self.n] @ seen.value) if self.follows else 0.0
        return float(y[2 * self.n + 1] - fall)

    def across(self, y: Array) -> float:
        """Speed across the beam of a slider that stays on the surface."""
        seen, q, rates = self.seen(y), y[: self.n], y[self.n : 2 * self.n]
        moved = self.ahead(y, seen) * (1.0 + self.half * seen.bend) + self.half * (rates @ seen.over)
        return float(rates @ seen.value + (q @ seen.first) * moved)

    def rates(self, t: float, y: Array, seen: Seen, rubbed: float, reaction: float) -> Array:
        """Of all that moves, under both forces."""
        q, rates, turn = y[: self.n], y[self.n : 2 * self.n], 2.0 * pi * HERTZ * t
        drive = self.grown(t) * (self.loads.real * cos(turn) - self.loads.imag * sin(turn))
        push = drive - self.squares * q - self.damped * rates
        pull = rubbed / self.slider.mass
        if self.follows:
            pull += (rates @ seen.value) * (rates @ seen.first + (q @ seen.second) * y[2 * self.n + 1])
            pull -= self.slider.gravity * (q @ seen.first)
        if self.two_way:
            push = push - rubbed * seen.along - reaction * seen.lifted
        turned = rubbed * float(rates @ seen.along)
        works = (rates @ drive, self.damped @ rates**2, -rubbed * self.slip(y, seen), -turned)
        return np.concatenate([rates, push, [self.ahead(y, seen), pull, *works, -reaction * (rates @ seen.lifted)]])

    def forces(self, t: float, y: Array, seen: Seen) -> tuple[float, float]:
        """Friction and reaction: what keeps the slider from sliding, or on the surface, is linear in itself."""
        slider, more = self.slider, np.zeros(len(y))
        if self.sticks:
            more[self.n : 2 * self.n], more[2 * self.n + 1] = -seen.along * self.two_way, 1.0 / slider.mass
            own = self._gained(self.slid, y, self.rates(t, y, seen, 0.0, 0.0))
            return -own / self._gained(self.slid, y, more), slider.normal_force
        rubbed = self.friction(y, seen)
        if not self.held:
            return rubbed, slider.normal_force
        more[self.n : 2 * self.n] = -seen.lifted * self.two_way
        own = self._gained(self.across, y, self.rates(t, y, seen, rubbed, 0.0))
        each = self._gained(self.across, y, more)
        return rubbed, (slider.normal_force + slider.mass * own) / (1.0 - slider.mass * each)

    def slid(self, y: Array) -> float:
        """`slip`, of a state alone."""
        return self.slip(y, self.seen(y))

    def _gained(self, speed: Callable[[Array], float], y: Array, way: Array) -> float:
        """By the second."""
        return (speed(y + self.tick * way) - speed(y - self.tick * way)) / (2.0 * self.tick)

    def flow(self, t: float, y: Array) -> Array:
        """Of all that moves, with the forces that are due."""
        seen = self.seen(y)
        if not (self.sticks or (self.two_way and self.held)):
            return self.rates(t, y, seen, self.friction(y, seen), 0.0)
        rubbed, reaction = self.forces(t, y, seen)
        return self.rates(t, y, seen, rubbed, reaction if self.held else 0.0)

    def run(self, times: Array) -> Array:
        """States and the works of `BOOKS` so far at all times, (len(times), 2 n + 7)."""
        from scipy.integrate import solve_ivp

        start = np.zeros(2 * self.n + 7)
        start[2 * self.n : 2 * self.n + 2] = self.slider.position or 0.0, self.slider.speed
        if self.two_way and self.held:
            for _ in range(12):
                start[: self.n] = -self.slider.normal_force * self.seen(start).lifted / self.squares
        if self.slider in [RUNS[number] for number in CHANGES]:
            return self._changing(start, times)
        limits = EXACTLY if self.two_way else CLOSELY
        found = solve_ivp(self.flow, (0.0, times[-1]), start, "DOP853", times, **limits)
        return np.asarray(found.y.T)

    def _changing(self, y: Array, times: Array) -> Array:
        """The same from change to change of Coulomb's friction, which are kept in `events`: time, kind, way."""
        from scipy.integrate import solve_ivp

        parts, t, begin = [], 0.0, float(y[2 * self.n])
        full = self.slider.mu * self.slider.normal_force
        most = (self.slider.mu_static or self.slider.mu) * self.slider.normal_force
        self.sticks, rubbed = False, -copysign(full, self.slider.speed)

        def flow(t: float, y: Array) -> Array:
            seen = self.seen(y)
            return self.rates(t, y, seen, self.forces(t, y, seen)[0] if self.sticks else rubbed, 0.0)

        def change(t: float, y: Array) -> float:
            seen = self.seen(y)
            if self.sticks:
                return most - abs(self.forces(t, y, seen)[0])
            return -self.slip(y, seen) * copysign(1.0, rubbed)

        change.terminal, change.direction = True, -1.0  # type: ignore[attr-defined]
        while t < times[-1]:
            ahead = times[times > t] if t else times
            found = solve_ivp(flow, (t, times[-1]), y, "DOP853", ahead, events=change, **EXACTLY)
            if len(found.t):
                parts.append(found.y.T)
            if found.status != 1:
                break
            t, y = float(found.t_events[0][0]), found.y_events[0][0]
            was, self.sticks = self.sticks, True
            need = self.forces(t, y, self.seen(y))[0]
            self.sticks = not was and abs(need) <= most
            rubbed = copysign(full, need)
            if was or self.sticks:
                self.events.append((t, 1.0 if self.sticks else 2.0, float(y[2 * self.n]) - begin))
        self.sticks = False
        return np.concatenate(parts)


def softly(t: float) -> float:
    """Forces grow by 3 p^2 - 2 p^3 over 0.4 of a period."""
    p = min(2.5 * HERTZ * t, 1.0)
    return p * p * (3.0 - 2.0 * p)


@cache
def _legs(number: int) -> tuple[Motion, Motion]:
    from verify.motion.simulate import simulate

    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "at": PLACES}
    given |= {"slider": RUNS[number], "samples": SAMPLES, "step": STEP}
    first = simulate(BAR, FORCES, HERTZ, LEG, soft_start_periods=0.4, **given)
    return first, simulate(BAR, FORCES, HERTZ, LEG, continue_from=first, **given)


@cache
def _ridden(number: int) -> tuple[Ridden, Array, Array]:
    """States when samples are taken, and half a step before each, without the first."""
    ridden, sampled = Ridden(RUNS[number], softly), np.concatenate([leg.times[1:] for leg in _legs(number)])
    states = ridden.run(np.concatenate([[0.0], np.column_stack([sampled - 0.5 * STEP, sampled]).ravel()]))
    return ridden, states[1::2], states[2::2]


def events_error(number: float) -> float:
    """Of when a slider sticks and slips, over the run; 1 for another order, or another way two steps later."""
    _legs.cache_clear()
    ridden, _, _ = _ridden(int(number))
    first, second = _legs(int(number))
    found = np.concatenate([first.events, second.events])
    found[len(first.events) :, 2] += first.travelled[-1]
    exact = np.array(ridden.events)
    if len(exact) < 2 or found[:, 1].tolist() != exact[:, 1].tolist():
        return 1.0
    if not (abs(found - exact)[:, 2] < 2.0 * STEP * abs(_both(int(number), "speed")).max()).all():
        return 1.0
    return float(abs(found - exact)[:, 0].max() / (2.0 * LEG))


def _off(found: Any, exact: Any) -> float:
    return float(abs(np.asarray(found) - exact).max() / abs(np.asarray(exact)).max())


def _both(number: int, name: str) -> Array:
    """What both legs tell at the samples."""
    return np.concatenate([getattr(leg, name)[1:] for leg in _legs(number)])


def motion_error(number: float) -> float:
    """Of way, speed, speed of the surface and friction of a run in two legs, and of the beam's deflection."""
    n = int(number)
    _legs.cache_clear()  # every row runs what it judges
    ridden, _, states = _ridden(n)
    pairs = [(y, ridden.seen(y)) for y in states]
    bent = states[:, : ridden.n] @ np.array([ridden.shapes(x)[0] for x in PLACES]).T
    start = float(RUNS[n].start_on(BAR))
    off = [
        _off(np.concatenate([leg.position[1:] for leg in _legs(n)]) - start, states[:, 2 * ridden.n] - start),
        _off(_both(n, "speed"), states[:, 2 * ridden.n + 1]),
        _off(_both(n, "surface_speed"), [y[2 * ridden.n + 1] - ridden.slip(y, seen) for y, seen in pairs]),
        _off(_both(n, "deflection"), bent),
    ]
    if n not in (STICKS, *CHANGES):
        off.append(_off(_both(n, "friction"), [ridden.friction(y, seen) for y, seen in pairs]))
    return largest(off)


def forces_error(number: float) -> float:
    """Of the normal reaction in the middle of a step, and of friction there of a slider that sticks."""
    n = int(number)
    _legs.cache_clear()
    ridden, states, _ = _ridden(n)
    times = np.concatenate([leg.times[1:] for leg in _legs(n)]) - 0.5 * STEP
    exact = np.array([ridden.forces(t, y, ridden.seen(y)) for t, y in zip(times, states, strict=True)])
    off = [_off(_both(n, "normal_force"), exact[:, 1])]
    return largest(*off, _off(_both(n, "friction"), exact[:, 0])) if n == STICKS else off[0]


def books_error(number: float) -> float:
    """Of works and energies of the first leg, over the work of the forces."""
    _legs.cache_clear()
    n, books = int(number), _legs(int(number))[0].ledger
    ridden, _, states = _ridden(n)
    y, slider = states[SAMPLES - 2], RUNS[n]
    rates, places = y[ridden.n : 2 * ridden.n], y[: ridden.n]
    works = dict(zip(BOOKS, y[2 * ridden.n + 2 :].tolist(), strict=True))
    works["slider"] = 0.5 * slider.mass * (float(y[2 * ridden.n + 1]) ** 2 - slider.speed**2)
    works["kinetic"], works["elastic"] = 0.5 * float(rates @ rates), 0.5 * float(ridden.squares @ places**2)
    return float(largest(abs(getattr(books, name) - works[name]) / works["work_in"] for name in works))


def margin_error(number: float) -> float:
    """Of how near a slider comes to lifting off, by what presses it on in every step of the first leg."""
    from verify.motion.simulate import simulate

    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "slider": RUNS[int(number)]}
    run = simulate(BAR, FORCES, HERTZ, LEG, samples=1 + round(LEG / STEP), step=STEP, **given)
    assert run.normal_force is not None
    slider, pressed = RUNS[int(number)], run.normal_force[1:]
    fall = float((slider.normal_force - pressed).max()) / slider.mass
    return abs(run.margins.lift_off * slider.effective_gravity / fall - 1.0)


def _loops() -> Iterator[Call]:
    from verify.motion.warm import on_beam

    for law in ("tanh", "coulomb"):
        yield from on_beam(law, "auto")


_row = partial(Floor, along="run", kernels=_loops)

ROWS: tuple[Row, ...] = (
    _row(
        id="sliders-not-felt",
        title="Two sliders on a beam of two elements that does not feel them: ways, speeds, friction, deflections",
        why="motion/kernels.py: smooth friction to order 4 in steps of 4e-7 s; against all equations at once.",
        at=(0.0, 4.0),
        promise=2e-8,
        error=motion_error,
    ),
    _row(
        id="sliders-written-out",
        title="Six that it feels, each going on once: held on it or not, sliding, stuck, changing",
        why="motion/kernels.py: forces of a step act in its middle, so that it is off by the square of the step; "
        "against all equations at once.",
        at=(1.0, 2.0, 3.0, 5.0, 6.0, 7.0),
        promise=1e-5,
        error=motion_error,
    ),
    _row(
        id="reactions-written-out",
        title="What presses some of these on, and what holds the one that sticks",
        why="motion/contact_kernels.py: means over a step of 4e-7 s, where a following slider is seen to first order.",
        at=(0.0, 2.0, 3.0, 5.0),
        promise=2e-4,
        error=forces_error,
    ),
    _row(
        id="nearest-to-lifting-off",
        title="How near sliders come to lifting off, against what presses them on in every step",
        why="motion/kernels.py: the least reaction of a mean over a step, whose samples are the same means.",
        at=(0.0, 2.0),
        promise=1e-9,
        error=margin_error,
    ),
    _row(
        id="books-written-out",
        title="What forces, damping, friction and reactions have done by the middle of these runs, and energies",
        why="motion/books_kernels.py: a quadrature over each step; off by the square of it where the beam feels them.",
        at=(0.0, 1.0, 2.0, 4.0),
        promise=3e-6,
        error=books_error,
    ),
    _row(
        id="changes-written-out",
        title="When the last two of them stick and slip, and how far they are then: mu_static as mu, and above it",
        why="motion/friction_kernels.py: located within steps of 4e-7 s, 2.5e-4 of the run.",
        at=(6.0, 7.0),
        promise=2e-5,
        error=events_error,
    ),
)
