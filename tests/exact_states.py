"""Beams with anything on them by the states along them, in 30 digits: the tests' own reference, of no model.

w, psi, M and S follow w' = psi + S/(kappa G A), psi' = M/EI, M' = -S + (T - omega^2 rho I) psi and
S' = (k_f - omega^2 rho A) w from end to end; S jumps by (k - omega^2 m) w and M by (k_r - omega^2 J) psi where
something stands.
"""

import mpmath as mp

_FREE = {"clamped": (2, 3), "pinned": (1, 3), "guided": (0, 2), "free": (0, 1)}
"""Which of w, psi, M, S an end leaves."""
DIGITS = 30


def _exponential(matrix):
    """By its series, the matrix halved until that is short."""
    halvings = max(0, int(mp.ceil(mp.log(mp.mnorm(matrix, 1) + 1, 2))) + 2)
    scaled, term, total = matrix / 2**halvings, mp.eye(4), mp.eye(4)
    for k in range(1, 24):
        term = term * scaled / k
        total += term
    for _ in range(halvings):
        total = total * total
    return total


def determinant(beam, theory, hertz):
    """Zero at the frequencies of a beam, lengths in L and forces in EI / L^2."""
    length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    square = (2 * mp.pi * hertz) ** 2
    states = mp.zeros(4, 2)
    for column, left in enumerate(_FREE[beam.supports[0]]):
        states[left, column] = 1
    at, places = mp.mpf(0), sorted({one.position for one in (*beam.mass, *beam.spring)})
    for piece in beam.pieces:
        end = at + mp.mpf(piece.length)
        cuts = [mp.mpf(p) for p in places if at <= p < end or (p == beam.length and end >= p)]
        for cut in [*cuts, None]:
            goal = end if cut is None else min(cut, end)
            states = _along(beam, piece, theory, square, (goal - at) / length) * states
            at = goal
            if cut is not None:
                states = _past(beam, cut, square, length, stiff) * states
    right = [i for i in range(4) if i not in _FREE[beam.supports[1]]]
    return mp.det(mp.matrix([[states[i, j] for j in (0, 1)] for i in right]))


def _along(beam, piece, theory, square, distance):
    length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
    force, ground = mp.mpf(beam.tension) * length**2 / stiff, mp.mpf(beam.foundation) * length**4 / stiff
    mass = square * piece.mass_per_length * length**4 / stiff
    rotary = 0 if theory == "euler-bernoulli" else square * piece.rotary_inertia * length**2 / stiff
    shear = 0 if theory != "timoshenko" else stiff / (mp.mpf(piece.shear_stiffness) * length**2)
    bend = stiff / piece.bending_stiffness
    law = mp.matrix([[0, 1, 0, shear], [0, 0, bend, 0], [0, force - rotary, 0, -1], [ground - mass, 0, 0, 0]])
    return _exponential(law * distance)


def _past(beam, place, square, length, stiff):
    """What stands at a place."""
    past = mp.eye(4)
    for one in beam.mass:
        if one.position == place:
            past[3, 0] -= square * one.mass * length**3 / stiff
            past[2, 1] -= square * one.rotary_inertia * length / stiff
    for one in beam.spring:
        if one.position == place:
            past[3, 0] += one.stiffness * length**3 / stiff
            past[2, 1] += one.rotational * length / stiff
    return past


def frequency_near(beam, theory, hertz):
    """The frequency of a beam nearest to a guess, Hz."""
    with mp.workdps(DIGITS):
        found = mp.findroot(
            lambda f: determinant(beam, theory, f), (mp.mpf(hertz), mp.mpf(hertz) * (1 + mp.mpf(10) ** -7)),
            solver="secant", tol=1e-30, verify=False,
        )
        return float(found)
