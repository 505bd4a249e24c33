"""Exact beams by transfer matrices in 30 digits or more (mpmath): frequencies, shapes, harmonic fields.

State (w, psi, M, S) with w' = psi + S/(kappa G A), psi' = M/EI, M' = -S + (T - omega^2 rho I) psi and
S' = (k_f - omega^2 rho A) w; S jumps by (k - omega^2 m) w - F and M by (k_r - omega^2 J) psi at attachments. Lengths in
units of L, forces in EI / L^2; EI and kappa G A carry 1 + i eta. Independent of the package but for its value types.
"""

from typing import Any

import mpmath as mp
import numpy as np

from verify.problem.beam import Beam, PointForce

_FREE = {"clamped": (2, 3), "pinned": (1, 3), "guided": (0, 2), "free": (0, 1)}
"""Components of (w, psi, M, S) that a support leaves free."""
DIGITS = 30


def has_frequency_within(beam: Beam, theory: str, hertz: float, rel: float, digits: int = 40) -> bool:
    """Whether the frequency determinant changes sign within a relative distance of a frequency in Hz."""
    with mp.workdps(digits):
        low, high = (_determinant(beam, theory, mp.mpf(hertz) * (1 + side * mp.mpf(rel))) for side in (-1, 1))
        return bool(low * high < 0)


def state(beam: Beam, theory: str, hertz: float, position: float, x: float, digits: int = DIGITS) -> Any:
    """Deflection, section rotation, moment and shear force at x under a unit force, (4,) complex, SI per newton."""
    with mp.workdps(digits):
        end = _at_right_end(beam, _states(beam, theory, hertz, position))
        start = mp.lu_solve(end[:, :2], -end[:, 2])
        found = _states(beam, theory, hertz, position, x) * mp.matrix([start[0], start[1], 1])
        length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
        scales = (length**3 / stiff, length**2 / stiff, length, 1)
        return np.array([complex(value * scale) for value, scale in zip(found, scales, strict=True)])


def deflection(beam: Beam, theory: str, hertz: float, forces: tuple[PointForce, ...], x: Any, digits: int = 60) -> Any:
    """Deflection under several forces at places x, (len(x),) complex, metres."""
    phasors = [(f.position, f.amplitude * np.exp(1j * np.deg2rad(f.phase_deg))) for f in forces]
    return np.array(
        [sum(value * state(beam, theory, hertz, at, float(one), digits)[0] for at, value in phasors) for one in x]
    )


def _determinant(beam: Any, theory: str, hertz: Any) -> Any:
    return mp.det(_at_right_end(beam, _states(beam, theory, hertz)[:, :2]))


def _at_right_end(beam: Any, states: Any) -> Any:
    """Rows of the states that the right support holds at zero."""
    return mp.matrix([[states[i, j] for j in range(states.cols)] for i in range(4) if i not in _FREE[beam.supports[1]]])


def _states(beam: Any, theory: str, hertz: Any, force: float | None = None, upto: float | None = None) -> Any:
    """(4, 3): states at `upto` or the right end of each unknown at the left end, and of a unit force."""
    square = (2 * mp.pi * hertz) ** 2
    upto = beam.length if upto is None else upto
    states, at, end = mp.zeros(4, 3), 0.0, 0.0
    for column, left in enumerate(_FREE[beam.supports[0]]):
        states[left, column] = 1
    places = {one.position for one in (*beam.mass, *beam.spring)} | ({force} - {None})
    for i, piece in enumerate(beam.pieces):
        end = beam.length if i == len(beam.pieces) - 1 else end + piece.length
        stops = sorted({p for p in places if at <= p < end or p == end == beam.length} | {min(end, max(at, upto)), end})
        for stop in stops:
            states = _along(beam, piece, theory, square, (mp.mpf(stop) - at) / beam.length) * states
            at = stop
            if stop in places and (stop < end or end == beam.length):
                states = _past(beam, stop, square) * states
                states[3, 2] -= stop == force
            if at == upto:
                return states
    return states


def _along(beam: Any, piece: Any, theory: str, square: Any, distance: Any) -> Any:
    length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    loss = 1 + 1j * mp.mpf(beam.loss_factor) if beam.loss_factor else mp.mpf(1)
    force, ground = beam.tension * length**2 / stiff, beam.foundation * length**4 / stiff
    mass = square * piece.mass_per_length * length**4 / stiff
    rotary = 0 if theory == "euler-bernoulli" else square * piece.rotary_inertia * length**2 / stiff
    shear = 0 if theory != "timoshenko" else stiff / (piece.shear_stiffness * length**2 * loss)
    bend = stiff / (piece.bending_stiffness * loss)
    law = mp.matrix([[0, 1, 0, shear], [0, 0, bend, 0], [0, force - rotary, 0, -1], [ground - mass, 0, 0, 0]])
    return _exponential(law * distance)


def _past(beam: Any, place: float, square: Any) -> Any:
    past, length, stiff = mp.eye(4), mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    for one in (one for one in beam.mass if one.position == place):
        past[3, 0] -= square * one.mass * length**3 / stiff
        past[2, 1] -= square * one.rotary_inertia * length / stiff
    for one in (one for one in beam.spring if one.position == place):
        past[3, 0] += one.stiffness * length**3 / stiff
        past[2, 1] += one.rotational * length / stiff
    return past


def _exponential(matrix: Any) -> Any:
    """By scaling and squaring; ten times faster than mpmath's own on 4 x 4 matrices."""
    halvings = max(0, int(mp.ceil(mp.log(mp.mnorm(matrix, 1) + 1, 2))) + 2)
    scaled, term, total = matrix / 2**halvings, mp.eye(4), mp.eye(4)
    for k in range(1, 22 if mp.mp.dps <= DIGITS else 40):
        term = term * scaled / k
        total += term
    for _ in range(halvings):
        total = total * total
    return total
