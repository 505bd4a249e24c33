"""Beams with everything on them, by two other ways: plain transfer matrices of many digits, and Ritz's polynomials."""

from itertools import pairwise

import mpmath
import numpy as np
from scipy.linalg import eigh, null_space

from verify.beam import Beam
from verify.section import Section

_STRIP = Section(length=0.2)
PAIRED = Beam(
    length=0.7,
    width=0.02,
    thickness=0.001,
    youngs_modulus=70e9,
    density=2700.0,
    supports=("clamped", "clamped"),
    section=(_STRIP, Section(length=0.3, thickness=0.3, density=1e8), _STRIP),
)
"""Two thin strips held by a block too heavy to move: its fourth and fifth frequency are 2.4e-7 apart."""
HELD = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


def cut(beam, also=()):
    """(piece, begin, end) from left to right, ending wherever anything stands, and at places besides."""
    places = {*(x.position for x in (*beam.mass, *beam.spring)), *also}
    parts, start = [], 0.0
    for piece in beam.pieces:
        end = start + piece.length
        inner = [start, *sorted(p for p in places if start + 1e-12 < p < end - 1e-12), end]
        parts += [(piece, a, b) for a, b in pairwise(inner)]
        start = end
    return parts


def transfers(beam, theory, omega, also=()):
    """(place, what takes w, psi, M, V there) from the left end on, jumps included, in extended precision.

    By exponentials of the equations of motion; V balances what is fixed to the beam.
    """
    mp, thick = mpmath.mpf, theory != "euler-bernoulli"
    lossy = 1 + mpmath.mpc(0, beam.loss_factor) if beam.loss_factor else mp(1)
    omega2, tension, ground = omega**2, mp(beam.tension), mp(beam.foundation)

    def joint(x):
        matrix = mpmath.eye(4)
        for m in beam.mass:
            if abs(m.position - x) < 1e-12:
                matrix[3, 0] += omega2 * mp(m.mass)
                matrix[2, 1] -= omega2 * mp(m.rotary_inertia)
        for s in beam.spring:
            if abs(s.position - x) < 1e-12:
                matrix[3, 0] -= mp(s.stiffness)
                matrix[2, 1] += mp(s.rotational)
        return matrix

    found = [(0.0, joint(0.0))]
    for piece, a, b in cut(beam, also):
        rate = mpmath.zeros(4)
        rate[0, 1] = 1
        rate[0, 3] = -1 / (lossy * mp(piece.shear_stiffness)) if theory == "timoshenko" else 0
        rate[1, 2] = 1 / (lossy * mp(piece.bending_stiffness))
        rate[2, 3] = 1
        rate[2, 1] = tension - (mp(piece.rotary_inertia) * omega2 if thick else 0)
        rate[3, 0] = mp(piece.mass_per_length) * omega2 - ground
        length = mp(piece.length) if b - a > 0.999999999 * piece.length else mp(b) - mp(a)
        found.append((b, joint(b) * mpmath.expm(rate * length, method="taylor")))
    return found


def determinant(beam, theory, omega):
    """End conditions carried through the beam: it vanishes at a frequency."""
    whole = mpmath.eye(4)
    for _, step in transfers(beam, theory, omega):
        whole = step * whole
    moves = [k for k in range(4) if k not in HELD[beam.supports[0]]]
    return mpmath.det(mpmath.matrix([[whole[i, j] for j in moves] for i in HELD[beam.supports[1]]]))


def driven(beam, theory, forces, omega, places):
    """Deflections at places under complex forces {place: newton}, in extended precision."""
    moves = [k for k in range(4) if k not in HELD[beam.supports[0]]]
    whole, rest, found = mpmath.eye(4), mpmath.zeros(4, 1), {}
    for at, step in transfers(beam, theory, omega, (*forces, *places)):
        whole, rest = step * whole, step * rest
        for place, force in forces.items():
            if abs(place - at) < 1e-12:
                rest[3] += mpmath.mpmathify(complex(force))
        found[at] = (whole.copy(), rest.copy())
    ends = HELD[beam.supports[1]]
    matrix = mpmath.matrix([[whole[i, j] for j in moves] for i in ends])
    free = mpmath.lu_solve(matrix, mpmath.matrix([-rest[i] for i in ends]))
    start = mpmath.zeros(4, 1)
    for k, value in zip(moves, free, strict=True):
        start[k] = value
    values = []
    for place in places:
        whole, rest = found[min(found, key=lambda at, place=place: abs(at - place))]
        values.append(complex((whole * start + rest)[0]))
    return np.array(values)


def a_root_lies_within(beam, theory, found, rel, digits=40):
    """Whether the determinant changes its sign within a relative distance of a frequency in Hz."""
    with mpmath.workdps(digits):
        sides = [determinant(beam, theory, 2 * mpmath.pi * found * (1 + side * mpmath.mpf(rel))) for side in (-1, 1)]
        return sides[0] * sides[1] < 0


def ritz(beam, theory, degree=14, parts=1):
    """(frequencies in Hz, shapes: x -> (n, len(x)) of w) by Legendre polynomials on every stretch, all of them."""
    timoshenko, n = theory == "timoshenko", degree + 1
    stretches = [
        (piece, a + (b - a) * i / parts, a + (b - a) * (i + 1) / parts)
        for piece, a, b in cut(beam)
        for i in range(parts)
    ]
    fields = 2 if timoshenko else 1
    size = fields * n * len(stretches)
    stiffness, mass, rules = np.zeros((size, size)), np.zeros((size, size)), []
    z, weights = np.polynomial.legendre.leggauss(degree + 2)

    def row(i, x, field, derivative):
        """Coefficients of a field (0 w, 1 turn) on stretch i at x."""
        _, a, b = stretches[i]
        values = np.zeros(size)
        if field == 1 and not timoshenko:
            field, derivative = 0, derivative + 1
        at = (i * fields + field) * n
        where = 2 * (x - a) / (b - a) - 1
        for k in range(n):
            unit = np.polynomial.legendre.legder(np.eye(n)[k], derivative) if derivative else np.eye(n)[k]
            values[at + k] = np.polynomial.legendre.legval(where, unit) * (2 / (b - a)) ** derivative
        return values

    for i, (piece, a, b) in enumerate(stretches):
        for point, weight in zip((a + b) / 2 + (b - a) / 2 * z, (b - a) / 2 * weights, strict=True):
            w, slope, turn, bend = (row(i, point, *what) for what in ((0, 0), (0, 1), (1, 0), (1, 1)))
            stiffness += weight * piece.bending_stiffness * np.outer(bend, bend)
            stiffness += weight * (beam.foundation * np.outer(w, w) + beam.tension * np.outer(slope, slope))
            mass += weight * piece.mass_per_length * np.outer(w, w)
            if theory != "euler-bernoulli":
                mass += weight * piece.rotary_inertia * np.outer(turn, turn)
            if timoshenko:
                stiffness += weight * piece.shear_stiffness * np.outer(slope - turn, slope - turn)
    for i in range(len(stretches) - 1):
        at = stretches[i][2]
        rules += [row(i, at, field, 0) - row(i + 1, at, field, 0) for field in (0, 1)]
    for i, end, support in ((0, 0.0, beam.supports[0]), (len(stretches) - 1, stretches[-1][2], beam.supports[1])):
        rules += [row(i, end, field, 0) for field in HELD[support] if field < 2]

    def at(x):
        return next(i for i, (_, a, b) in enumerate(stretches) if a - 1e-12 <= x <= b + 1e-12)

    for m in beam.mass:
        w, turn = (row(at(m.position), m.position, field, 0) for field in (0, 1))
        mass += m.mass * np.outer(w, w) + m.rotary_inertia * np.outer(turn, turn)
    for s in beam.spring:
        w, turn = (row(at(s.position), s.position, field, 0) for field in (0, 1))
        stiffness += s.stiffness * np.outer(w, w) + s.rotational * np.outer(turn, turn)
    rules = np.array([rule / np.linalg.norm(rule) for rule in rules]) if rules else np.zeros((0, size))
    basis = null_space(rules) if len(rules) else np.eye(size)
    values, vectors = eigh(basis.T @ stiffness @ basis, basis.T @ mass @ basis)
    vectors = basis @ vectors

    def shapes(x, derivative=0):
        return np.array([row(at(one), one, 0, derivative) @ vectors for one in x]).T

    return np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi), shapes
