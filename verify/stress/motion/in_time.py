"""Linear beams in time against their matrices written out, and the modes that they move in against their states.

Every mode answers a force that is a polynomial in time on a harmonic wave: a linear system with constant coefficients,
taken to any time by the exponential of its matrix.
"""

from functools import partial
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.models.arrays import Array
from verify.models.fields import phasor
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import FORCES, MASSES, PLACES, PLAIN, SECTIONS, States
from verify.stress.modes.written_out import PARTS, written
from verify.stress.references.dense import Elements

HERTZ, RATIO, TIMES = 61.0, 0.017, 5
PIECES = ((0.011, (0.0, 0.7, 0.9)), (0.007, (1.6, 0.0, -0.3, -0.3)))
"""Seconds, and powers of the time in them over that: how forces grow."""
SHORT = 0.023
"""Seconds of a run; forces grow in less."""


class Moved:
    """All modes of elements written out, from rest, under forces that grow piece by piece."""

    def __init__(self, own: Elements, ratio: float, forces: tuple[PointForce, ...] = FORCES) -> None:
        self.own, self.forces = own, forces
        values, self.vectors = own.modes
        self.omegas, self.ratio = np.sqrt(np.maximum(values, 0.0)), ratio
        self.state = np.zeros((len(values), 2), dtype=complex)

    def after(self, since: float, seconds: float, grown: tuple[float, ...], over: float, at: Array) -> Array:
        """Complex states (len(at), n, 2) at times `at` of a piece that begins at `since`; the last is kept."""
        from scipy.linalg import expm

        matrices, start = self._led(since, grown, over)
        flows = expm(matrices * np.append(at, seconds)[:, None, None, None])
        found = (flows @ start[:, :, None])[..., 0][..., :2]
        self.state = found[-1]
        return np.asarray(found[:-1])

    def _led(self, since: float, grown: tuple[float, ...], over: float) -> tuple[Array, Array]:
        """Matrices (n, k, k) and states (n, k) of all modes with what drives them."""
        drive, n = 2j * pi * HERTZ, len(grown)
        loads = self.vectors.T @ self.own.load(self.forces) * np.exp(drive * since)
        matrices = np.zeros((len(loads), n + 2, n + 2), dtype=complex)
        matrices[:, 0, 1] = 1.0
        matrices[:, 1, 0], matrices[:, 1, 1] = -(self.omegas**2), -2.0 * self.ratio * self.omegas
        matrices[:, 1, 2:] = loads[:, None] * np.array(grown)
        for power in range(n):
            matrices[:, 2 + power, 2 + power] = drive
            if power:
                matrices[:, 2 + power, 1 + power] = power / over
        return matrices, np.hstack([self.state, np.eye(n)[:1].repeat(len(loads), axis=0)])

    def lost(self, since: float, seconds: float, grown: tuple[float, ...]) -> float:
        """What damping takes in a piece, joules, by Boole's rule over 2048 steps; the state is that at its end then."""
        from scipy.linalg import expm

        matrices, start = self._led(since, grown, seconds)
        step, states = expm(matrices * (seconds / 2048)), [start[:, :, None]]
        for _ in range(2048):
            states.append(step @ states[-1])
        rates, weights = np.array(states)[:, :, 1, 0].real, np.tile([14.0, 32.0, 12.0, 32.0], 513)[:2049]
        weights[[0, -1]] = 7.0
        self.state = states[-1][:, :2, 0]
        return float(weights @ (2.0 * self.ratio * rates**2 @ self.omegas)) * 4.0 * seconds / 2048 / 90.0

    def read(self, states: Array, x: Array) -> Array:
        """Deflections (times, places)."""
        every = states[..., 0] @ self.vectors.T
        return np.array([self.own.read(one, x, 0).real for one in every])


def driven_error(number: float) -> float:
    """Of a beam from rest under forces that grow in two pieces and stay, and of its books; and going on from there."""
    from verify.motion.simulate import simulate

    own, _ = written("fem", int(number))
    moved, grown, lost = Moved(own, RATIO), sum(seconds for seconds, _ in PIECES), 0.0
    for since, (seconds, powers) in zip((0.0, PIECES[0][0]), PIECES, strict=True):
        lost += moved.lost(since, seconds, powers)
    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "at": PLACES}
    first = simulate(own.beam, FORCES, HERTZ, SHORT, envelope=PIECES, samples=9, **given)
    after = [float(t) for t in first.times if t > grown]
    before = moved.state
    lost += moved.lost(grown, SHORT - grown, (1.0,))
    moved.state = before
    exact = moved.read(moved.after(grown, SHORT - grown, (1.0,), 1.0, np.array(after) - grown), PLACES)
    worst = _off(first.deflection[-len(after) :], exact)
    second = simulate(own.beam, FORCES, HERTZ, 0.4 * SHORT, continue_from=first, samples=TIMES, **given)
    rates, places = moved.state[:, 1].real, moved.state[:, 0].real
    exact = moved.read(moved.after(SHORT, 0.4 * SHORT, (1.0,), 1.0, second.times - SHORT), PLACES)
    books: Any = first.ledger
    energies = (0.5 * float(rates @ rates), 0.5 * float(moved.omegas**2 @ places**2))
    told = zip((books.kinetic, books.elastic, books.damped), (*energies, lost), strict=True)
    worst = largest(worst, *(abs(found / energy - 1.0) for found, energy in told))
    return largest(float(worst), _off(second.deflection, exact), float(abs(books.residual / books.work_in)))


def _off(found: Any, exact: Any) -> float:
    return float(abs(found - exact).max() / abs(exact).max())


def soft_error(number: float) -> float:
    """Of a beam whose forces grow by 3 p^2 - 2 p^3 over 1.7 periods, and of one in its steady state, at all times."""
    from verify.motion.simulate import simulate

    own, _ = written("fem", int(number))
    given: dict[str, Any] = {"model": "fem", "count": PARTS, "modal_damping": RATIO, "at": PLACES, "samples": 12}
    soft = simulate(own.beam, FORCES, HERTZ, 1.7 / HERTZ + 0.01, soft_start_periods=1.7, **given)
    moved, grown = Moved(own, RATIO), 1.7 / HERTZ
    early, late = soft.times[soft.times <= grown], soft.times[soft.times > grown]
    parts = [moved.read(moved.after(0.0, grown, (0.0, 0.0, 3.0, -2.0), grown, early), PLACES)]
    parts.append(moved.read(moved.after(grown, 1.0, (1.0,), 1.0, late - grown), PLACES))
    steady = simulate(own.beam, FORCES, HERTZ, SHORT, start="steady", **given)
    field = own.read(own.under(own.load(FORCES), HERTZ, RATIO), PLACES, 0)
    turned = (field * np.exp(2j * pi * HERTZ * steady.times)[:, None]).real
    return largest(_off(soft.deflection, np.concatenate(parts)), _off(steady.deflection, turned))


def released_error(number: float) -> float:
    """Of a beam let go from straight lines with a speed, all that is told of it, by the nodal values that fit best."""
    from verify.motion.free_vibration import free_vibration

    own, _ = written("fem", int(number))
    length = own.beam.length
    corners = np.array([0.0, 0.41 * length, length])
    held = own.beam.supports[1] in ("pinned", "clamped")
    heights, speeds = np.array([0.0, 0.002, 0.0 if held else -0.001]), np.array([0.1, -0.2, 0.3])
    found = free_vibration(
        own.beam,
        (corners, heights),
        SHORT,
        velocity=(corners, speeds),
        model="fem",
        count=PARTS,
        modal_damping=RATIO,
        at=PLACES,
        samples=TIMES,
    )
    values, vectors = own.modes
    omegas, edges = np.sqrt(np.maximum(values, 0.0)), np.union1d(own.nodes, corners)
    points, weights = np.polynomial.legendre.leggauss(6)
    x = (edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (points + 1.0)).ravel()
    starts = np.cumsum([piece.length for piece in own.beam.pieces])
    line = np.array([piece.mass_per_length for piece in own.beam.pieces])
    weight = (0.5 * np.diff(edges)[:, None] * weights).ravel()
    weight = weight * line[np.clip(np.searchsorted(starts, x), 0, len(line) - 1)]
    x = np.append(x, [mass.position for mass in own.beam.mass])
    weight = np.append(weight, [mass.mass for mass in own.beam.mass])
    bodies = [mass for mass in own.beam.mass if mass.rotary_inertia]
    turns = np.array([mass.position for mass in bodies])
    weight = np.append(weight, [mass.rotary_inertia for mass in bodies])
    rows = np.array([own.row(float(at), 0) for at in x] + [own.row(float(at), 1) for at in turns])
    drawn = np.array([_drawn(corners, given, x, turns) for given in (heights, speeds)])
    q, rates = (drawn * weight) @ rows @ vectors  # v^T M w: modes are orthogonal by all that has inertia
    left = drawn[0] - rows @ (vectors @ q)
    unread = sqrt(float(weight @ left**2) / float(weight @ drawn[0] ** 2))
    damped, sigma = omegas * sqrt(1.0 - RATIO**2), RATIO * omegas
    t = found.times[:, None]
    c, s, fall = np.cos(damped * t), np.sin(damped * t) / damped, np.exp(-sigma * t)
    now = fall * (q * c + (rates + sigma * q) * s)
    speed = fall * (rates * c - (sigma * rates + omegas**2 * q) * s)
    read = np.array([own.row(float(at), 0) for at in PLACES]) @ vectors
    pairs = [(found.deflection, now @ read.T), (found.velocity, speed @ read.T)]
    pairs += [(found.kinetic, 0.5 * (speed**2).sum(axis=1)), (found.elastic, 0.5 * now**2 @ omegas**2)]
    pairs += [(found.frequencies_hz, omegas / (2.0 * pi)), (abs(found.amplitudes), abs(q))]
    return largest(abs(found.unread / unread - 1.0), *(_off(a, b) for a, b in pairs))


def _drawn(corners: Array, given: Array, x: Array, turns: Array) -> Array:
    """Straight lines at x, and their slopes where bodies turn, none of them at a corner."""
    slopes = (np.diff(given) / np.diff(corners))[np.clip(np.searchsorted(corners, turns) - 1, 0, len(given) - 2)]
    return np.append(np.interp(x, corners, given), slopes)


STEPPED = replace(PLAIN, section=SECTIONS, mass=(replace(MASSES[0], rotary_inertia=0.0), MASSES[1]))


def basis_error(derivative: float) -> float:
    """Of a derivative of the first modes that a stepped beam with masses moves in, against null vectors of states."""
    from verify.models.catalogue import MODELS

    basis, worst = MODELS["analytic"].time_basis(STEPPED, None, 5, "spline"), 0.0
    x = np.setdiff1d(PLACES, [0.17, 0.61])  # there it jumps
    for mode, omega in enumerate(basis.omegas):
        states = States(STEPPED, "euler-bernoulli", float(omega) ** 2, x.tolist())
        own = states.past(np.linalg.svd(states.matrix.real)[2][-1]).real
        own /= sqrt(states.inertia(own))
        exact = np.array([states.read(own, float(at), int(derivative)).real for at in x])
        found = basis.shapes(x, int(derivative))[mode]
        worst = largest(worst, _off(np.sign(found @ exact) * found, exact))
    return worst


def tail_error(hertz: float) -> float:
    """Of what the modes that are cut off add to a stepped beam's motion at once, with what the others have of it."""
    from verify.models.catalogue import MODELS

    basis: Any = MODELS["analytic"].time_basis(STEPPED, None, 5, "spline")
    omega, worst = 2.0 * pi * hertz, 0.0
    x = np.setdiff1d(PLACES, [0.17, 0.61])
    stops = (*x.tolist(), *(force.position for force in FORCES))
    states = States(replace(STEPPED, loss_factor=2.0 * RATIO), "euler-bernoulli", omega**2, stops)
    under, rest = states.under(FORCES), basis.tail(FORCES, hertz, RATIO)
    own = basis.omegas**2 * (1.0 + 2j * RATIO) - omega**2
    loads = sum(phasor(one) * basis.shapes(np.array([one.position]), 0)[:, 0] for one in FORCES)
    for derivative in range(10):
        exact = np.array([states.read(under, float(at), derivative) for at in x])
        worst = largest(worst, _off(rest(x, derivative) + (loads / own) @ basis.shapes(x, derivative), exact))
    return worst


NUMBERS = (0.0, 5.0)
_row = partial(Floor, along="beam", promise=1e-8)

ROWS: tuple[Row, ...] = (
    _row(
        id="beams-driven-in-time",
        title="Two beams with anything on them from rest under forces that grow in pieces, going on, and their books",
        why="motion/forcing.py: every mode exactly, against exponentials of matrices; modes of dense matrices.",
        at=NUMBERS,
        error=driven_error,
    ),
    _row(
        id="beams-started-softly",
        title="One of them under forces that grow by 3 p^2 - 2 p^3 over 1.7 periods, and in their steady state",
        why="motion/forcing.py: every mode exactly, against exponentials of matrices; modes of dense matrices.",
        at=(5.0,),
        error=soft_error,
    ),
    _row(
        id="beams-let-go",
        title="Three, one with a body at its end, let go from lines with a speed: motion, energies, shares and rest",
        why="motion/free_vibration.py: shares v^T M w with the turns of bodies in M, then every mode exactly.",
        at=(0.0, 1.0, 5.0),
        error=released_error,
    ),
    Floor(
        id="modes-to-move-in",
        title="Derivatives of the modes in which a stepped beam with masses moves, against null vectors of states",
        why="exact/in_time.py: four derivatives are beta^4; a null vector keeps nine digits.",
        along="derivative",
        at=(0.0, 1.0, 3.0, 4.0, 5.0, 6.0, 9.0),
        promise=1e-7,
        error=basis_error,
    ),
    Floor(
        id="modes-cut-off",
        title="What follows at once of the modes that are cut off, with the others, nine derivatives, against states",
        why="exact/in_time.py: the exact field less its part of the modes that are kept.",
        along="Hz",
        at=(3.1, 431.0),
        promise=1e-9,
        error=tail_error,
    ),
)
