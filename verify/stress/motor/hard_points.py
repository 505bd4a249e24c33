"""A hard point thrown by one place of a wave, against parabolas between roots of the wave and blows by hand."""

from collections.abc import Iterator
from math import asin, copysign, cos, pi, sin, tanh
from typing import TYPE_CHECKING, Any

import numpy as np

from verify.beam import PointForce
from verify.models.compiling import Call
from verify.motor.records import EVENT_X, LANDS, LEAVES
from verify.slider import Contact, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP

if TYPE_CHECKING:
    from verify.motor.result import MotorRun

AT, TURNS, MASS = 0.2437, 6.3, 2.3e-3
SMALL = 1e-10
"""Metres: a wave so flat that what is of second order in it is lost."""
ENOUGH = 12.0
"""Times the share of the load that presses at least: so much friction that the point sticks whatever the wave does."""
HARD: tuple[tuple[float, float, float, float | None, float | None, float], ...] = (
    (1.9, 0.4, 0.02, None, None, -6.0),
    (1.5, 0.0, 0.02, None, -3.0, 0.0),
    (2.3, 0.5, 0.02, 2.0, 0.6, 0.0),
    (0.7, 0.3, 0.02, 1.5, -0.4, 0.0),
    (1.9, 0.4, 0.3, None, None, 24.0),
)
"""How much harder the surface throws than the load presses; restitution; mu; slope of tanh friction and the speed that
the point is held at, both over the surface's own; its speed at first, likewise, where nothing holds it."""


class Thrown:
    """A point over one place of a surface that rises as A cos(theta): impulses and works so far, landings, leavings."""

    def __init__(self, number: int, omega: float, deflection: complex, slope: complex) -> None:
        self.ratio, self.restitution, self.mu, steep, held, speed = HARD[number]
        self.omega, self.size, self.lead = omega, abs(deflection), float(np.angle(deflection))
        self.along = -1j * omega * STRIP.surface_distance * slope / np.exp(1j * self.lead)
        self.press = self.size * omega**2 / self.ratio
        self.steep = None if steep is None else steep / abs(self.along)
        self.held, self.v = held is not None, (speed if held is None else held) * abs(self.along)
        self.push, self.rub, self.lost, self.events = 0.0, 0.0, 0.0, list[tuple[float, float]]()
        self.rubbed, self.z, self.climb, self.ridden = 0.0, 0.0, 0.0, 0.0

    def strike(self, theta: float, push: float) -> None:
        """An impulse across, over the mass; friction does not drive the point beyond the surface's speed."""
        ahead, most = float((self.along * np.exp(1j * theta)).real) - self.v, self.mu * push
        if self.steep:
            rub = most * tanh(self.steep * ahead)
        else:
            rub = copysign(most, ahead) if self.held else min(max(ahead, -most), most)
        after = self.v if self.held else self.v + rub
        self.rubbed += rub * (ahead - 0.5 * (after - self.v))
        self.push, self.rub, self.v = self.push + push, self.rub + rub, after

    def ride(self, theta: float, end: float) -> None:
        """From a phase to another, by Gauss's rule."""
        points, weights = np.polynomial.legendre.leggauss(200)
        self.ridden += end - theta
        for point, weight in zip(points, weights, strict=True):
            at = theta + 0.5 * (end - theta) * (point + 1.0)
            push = self.press * (1.0 - self.ratio * cos(at))
            self.strike(float(at), 0.5 * (end - theta) * float(weight) * push / self.omega)

    def fly(self, theta: float, end: float) -> float:
        """From a phase to where it lands; there it is struck."""
        from scipy.optimize import brentq

        def gap(at: float) -> float:
            t = (at - theta) / self.omega
            return self.z + (self.climb - 0.5 * self.press * t) * t - self.size * cos(at)

        low = theta + 1e-4
        while low < end and gap(low + 0.01) > 0.0:
            low += 0.01
        lands = float(brentq(gap, low, low + 0.01, xtol=1e-14)) if low < end else end
        t = (min(lands, end) - theta) / self.omega
        self.z, self.climb = self.z + (self.climb - 0.5 * self.press * t) * t, self.climb - self.press * t
        if lands < end:
            into = -self.size * self.omega * sin(lands) - self.climb
            self.climb += (1.0 + self.restitution) * into
            self.lost += 0.5 * (1.0 - self.restitution**2) * into**2
            self.events.append((lands, LANDS))
            self.strike(lands, (1.0 + self.restitution) * into)
        return min(lands, end)

    def run(self, end: float) -> None:
        """From the first phase, where it rides, to an end."""
        theta, rides = self.lead, True
        while theta < end:
            if rides:
                thrown = self.thrown(theta)
                self.ride(theta, min(thrown, end))
                theta, self.z, self.climb = thrown, self.size * cos(thrown), -self.size * self.omega * sin(thrown)
                if theta < end:
                    self.events.append((theta, LEAVES))
            else:
                theta = self.fly(theta, end)
            rides = not rides and self.restitution == 0.0 and theta < end

    def thrown(self, theta: float) -> float:
        """Where the surface falls faster than the load does."""
        if self.ratio <= 1.0:
            return 1e9
        edge = asin(1.0 / self.ratio) - 0.5 * pi  # cos is above 1 / ratio from there on
        turn = (theta - edge) % (2.0 * pi)
        return theta if turn < -2.0 * edge else theta + 2.0 * pi - turn


def _flat(hertz: float) -> tuple[PointForce, complex, complex]:
    """A force under which the surface at AT rises SMALL metres, and the phasors of deflection and slope there."""
    from verify.exact.harmonic import solve_harmonic

    field = solve_harmonic(STRIP, (PointForce(position=0.03),), hertz)
    force = PointForce(position=0.03, amplitude=SMALL / abs(complex(field.deflection([AT])[0])))
    deflection, slope = (complex(one[0]) * force.amplitude for one in (field.deflection([AT]), field.slope([AT])))
    return force, deflection, slope


def thrown_error(number: float) -> float:
    """Of events in radians, of height, speed, means and what blows and friction take."""
    from verify.motor.run import run_motor

    hertz, i = 4276.0, int(number)
    force, deflection, slope = _flat(hertz)
    own, omega = Thrown(i, 2.0 * pi * hertz, deflection, slope), 2.0 * pi * hertz
    start = own.v
    slider = Slider(
        mass=MASS,
        mu=own.mu,
        law="coulomb" if own.steep is None else "tanh",
        slope=own.steep,
        gravity=0.0,
        preload=MASS * own.press,
        position=AT,
        speed=0.0 if own.held else start,
        coupling="one-way",
        contact=Contact(restitution=own.restitution),
    )
    given: dict[str, Any] = {"model": "analytic", "samples": 2, "step": 1.0 / hertz / 500.0, "frozen": True}
    run = run_motor(
        STRIP, (force,), hertz, TURNS / hertz, slider=slider, held_speed=start if own.held else None, **given
    )
    end = own.lead + omega * float(run.times[-1])
    own.run(end)
    found = run.events[np.isin(run.events[:, 1], (LANDS, LEAVES))]
    if [int(kind) for kind in found[:, 1]] != [kind for _, kind in own.events]:
        return 1.0
    off = [abs(omega * t + own.lead - theta) for (t, *_), (theta, _) in zip(found, own.events, strict=True)]
    off.append(float(abs(run.events[:, EVENT_X]).max(initial=0.0)))  # it stays at its place
    return float(largest(*off, 0.0, *_off(run, own)))


def _off(run: "MotorRun", own: Thrown) -> list[float]:
    """Of height, shares of time, speed, means and books of a run, each over its own size."""
    off, span, blow, books = list[float](), float(run.times[-1]), own.size * own.omega, run.ledger
    if own.restitution and own.ratio > 1.0:
        off.append(abs(float(run.height[-1, 0]) - own.z) / own.size)
        off.append(abs(books.impacts / (MASS * own.lost) - 1.0))
    off += [abs(float(run.contact_share[-1]) - own.ridden / (own.omega * span)), float(run.stuck_share[-1])]
    off.append(abs(float(run.speed[-1]) - own.v) / blow)
    off.append(abs(float(run.normal_force[-1]) * span / (MASS * own.push) - 1.0))
    off.append(abs(float(run.friction[-1]) * span - MASS * own.rub) / (MASS * own.mu * own.push))
    off.append(abs(books.rubbed / (MASS * own.rubbed) - 1.0))
    off.append(abs(books.residual) / (abs(books.across) + books.rubbed))
    return off


def stuck_error(ratio: float) -> float:
    """Of the speed of a point that a flat wave carries along, which is the surface's; of its momentum and its friction.

    `ratio` of how hard the surface throws over how hard the load presses lies below 1: the point never flies.
    """
    from verify.motor.run import run_motor

    hertz = 4276.0
    force, deflection, slope = _flat(hertz)
    omega = 2.0 * pi * hertz
    press, along = abs(deflection) * omega**2 / ratio, -1j * omega * STRIP.surface_distance * slope
    slider = Slider(
        mass=MASS,
        mu=ENOUGH / (1.0 - ratio),
        law="coulomb",
        gravity=0.0,
        preload=MASS * press,
        position=AT,
        speed=along.real,
        coupling="one-way",
        contact=Contact(restitution=0.0),
    )
    given: dict[str, Any] = {"model": "analytic", "samples": 12, "step": 1.0 / hertz / 500.0, "frozen": True}
    run = run_motor(STRIP, (force,), hertz, TURNS / hertz, slider=slider, **given)
    carried = (along * np.exp(1j * omega * run.times)).real
    taken = run.friction[1:] * np.diff(run.times) / MASS - np.diff(run.speed)
    off = [abs(run.speed - carried).max() / abs(along), abs(taken).max() / abs(along)]
    off.append(1.0 - min(run.stuck_share[1:].min(), run.contact_share.min()))
    return float(largest(*off, abs(run.ledger.rubbed) / (MASS * abs(along) ** 2)))


def _loops() -> Iterator[Call]:
    from verify.motor import warm

    for law in ("tanh", "coulomb"):
        yield from warm.hard(law)


ROWS: tuple[Row, ...] = (
    Floor(
        id="hard-points-thrown",
        title="A hard point on a flat wave: landings, leavings, height, speed, forces, what blows and friction take",
        why="motor/hop_kernels.py: landings by halving wherever they fall in a step, friction in the middle of what is "
        "ridden; against parabolas.",
        along="run",
        at=tuple(float(number) for number in range(len(HARD))),
        promise=1e-5,
        error=thrown_error,
        kernels=_loops,
    ),
    Floor(
        id="hard-points-carried",
        title="A hard point that friction holds on a flat wave: speed of the surface, momentum, nothing rubbed away",
        why="motor/hop_kernels.py: friction of a point that sticks gives it the surface's speed at a step's end; "
        "against the wave itself. What is rubbed away is summed from means over steps, to their square.",
        along="how hard the surface throws over how hard the load presses",
        at=(0.3, 0.7),
        promise=2e-5,
        error=stuck_error,
        kernels=_loops,
    ),
)
