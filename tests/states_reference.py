"""Beams with anything on them by the states along them, in 30 digits: the tests' own reference, of no model.

w, psi, M and S follow w' = psi + S/(kappa G A), psi' = M/EI, M' = -S + (T - omega^2 rho I) psi and
S' = (k_f - omega^2 rho A) w from end to end; S jumps by (k - omega^2 m) w - F and M by (k_r - omega^2 J) psi where
something stands. Lengths in L, forces in EI / L^2; EI and kappa G A with 1 + i eta.
"""

import mpmath as mp

_FREE = {"clamped": (2, 3), "pinned": (1, 3), "guided": (0, 2), "free": (0, 1)}
"""Which of w, psi, M, S an end leaves."""
DIGITS = 30


def frequency_near(beam, theory, hertz):
    """The frequency of a beam nearest to a guess, Hz."""

    def determinant(f):
        return mp.det(_end(beam, _states(beam, theory, f)[:, :2]))

    with mp.workdps(DIGITS):
        guesses = (mp.mpf(hertz), mp.mpf(hertz) * (1 + mp.mpf(10) ** -7))
        return float(mp.findroot(determinant, guesses, solver="secant", tol=1e-30, verify=False))


def response(beam, theory, hertz, force, x):
    """Deflection and turn at x under a unit force at another place, complex, m/N and rad/N."""
    with mp.workdps(DIGITS):
        end = _end(beam, _states(beam, theory, hertz, force))
        start = mp.lu_solve(end[:, :2], -end[:, 2])
        found = _states(beam, theory, hertz, force, x) * mp.matrix([start[0], start[1], 1])
        scale = mp.mpf(beam.length) ** 3 / mp.mpf(beam.bending_stiffness)
        return complex(found[0] * scale), complex(found[1] * scale / beam.length)


def _end(beam, states):
    """What the right end holds."""
    return mp.matrix([[states[i, j] for j in range(states.cols)] for i in range(4) if i not in _FREE[beam.supports[1]]])


def _states(beam, theory, hertz, force=None, upto=None):
    """At `upto` or the right end: of each unknown on the left, then under a unit force, (4, 3)."""
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


def _along(beam, piece, theory, square, distance):
    length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    loss = 1 + 1j * mp.mpf(beam.loss_factor) if beam.loss_factor else mp.mpf(1)
    force, ground = beam.tension * length**2 / stiff, beam.foundation * length**4 / stiff
    mass = square * piece.mass_per_length * length**4 / stiff
    rotary = 0 if theory == "euler-bernoulli" else square * piece.rotary_inertia * length**2 / stiff
    shear = 0 if theory != "timoshenko" else stiff / (piece.shear_stiffness * length**2 * loss)
    bend = stiff / (piece.bending_stiffness * loss)
    law = mp.matrix([[0, 1, 0, shear], [0, 0, bend, 0], [0, force - rotary, 0, -1], [ground - mass, 0, 0, 0]])
    return _exponential(law * distance)


def _past(beam, place, square):
    """What stands at a place."""
    past, length, stiff = mp.eye(4), mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    for one in (one for one in beam.mass if one.position == place):
        past[3, 0] -= square * one.mass * length**3 / stiff
        past[2, 1] -= square * one.rotary_inertia * length / stiff
    for one in (one for one in beam.spring if one.position == place):
        past[3, 0] += one.stiffness * length**3 / stiff
        past[2, 1] += one.rotational * length / stiff
    return past


def _exponential(matrix):
    """By its series, the matrix halved until that is short."""
    halvings = max(0, int(mp.ceil(mp.log(mp.mnorm(matrix, 1) + 1, 2))) + 2)
    scaled, term, total = matrix / 2**halvings, mp.eye(4), mp.eye(4)
    for k in range(1, 22):
        term = term * scaled / k
        total += term
    for _ in range(halvings):
        total = total * total
    return total
