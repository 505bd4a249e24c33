"""Beams with anything on them, as no scene has them, against the states along them by plain exponentials.

Sections, masses that turn, springs, ground, axial force, shear and turning, between all kinds of ends. The reference
carries w, psi, M and V by scipy's exponential of a matrix from one end of a span to the other and solves for all of
them at once, densely: neither minors nor power series, nothing of the exact model.
"""

from collections.abc import Mapping, Sequence
from functools import cache, partial
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import phasor
from verify.section import Piece, Section
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

HELD = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Which of w, psi, M, V an end sets to zero."""
REACH = 0.8
"""Of the largest rate times the length of a span."""

PLAIN = Beam(
    length=0.61,
    bending_stiffness=2.3,
    mass_per_length=0.41,
    shear_stiffness=5.2e3,
    rotary_inertia=3.1e-5,
    supports=("clamped", "free"),
)
SECTIONS = (
    Section(length=0.17, bending_stiffness=3.1, mass_per_length=0.53, shear_stiffness=7.1e3, rotary_inertia=4.3e-5),
    Section(length=0.23, bending_stiffness=1.4, mass_per_length=0.29, shear_stiffness=4.4e3, rotary_inertia=1.9e-5),
    Section(length=0.21, bending_stiffness=2.2, mass_per_length=0.47, shear_stiffness=6.3e3, rotary_inertia=2.7e-5),
)
MASSES = (PointMass(position=0.29, mass=0.031, rotary_inertia=4.7e-5), PointMass(position=0.61, mass=0.013))
SPRINGS = (PointSpring(position=0.09, stiffness=170.0, rotational=3.9), PointSpring(position=0.43, stiffness=310.0))
FIRST = PointSpring(position=0.0, stiffness=240.0, rotational=1.7)
BODY = PointMass(position=0.0, mass=0.017, rotary_inertia=2.3e-5)
LAST = PointSpring(position=0.61, rotational=2.6)

ANY: tuple[tuple[Beam, str], ...] = (
    (replace(PLAIN, section=SECTIONS, mass=MASSES, spring=SPRINGS, tension=37.0, foundation=2100.0), "euler-bernoulli"),
    (
        replace(
            PLAIN,
            section=SECTIONS,
            mass=MASSES,
            spring=(FIRST, *SPRINGS),
            foundation=900.0,
            supports=("free", "guided"),
        ),
        "timoshenko",
    ),
    (replace(PLAIN, section=SECTIONS, mass=MASSES[:1], supports=("guided", "pinned")), "timoshenko"),
    (replace(PLAIN, mass=(BODY,), spring=(FIRST,), tension=-11.0, supports=("free", "clamped")), "euler-bernoulli"),
    (replace(PLAIN, section=SECTIONS, mass=(BODY, MASSES[0]), spring=(LAST,), supports=("free", "pinned")), "rayleigh"),
    (replace(PLAIN, tension=64.0, foundation=5300.0, spring=(LAST,), supports=("pinned", "pinned")), "euler-bernoulli"),
    (replace(PLAIN, mass=MASSES[:1], foundation=1.3e5, supports=("pinned", "clamped")), "euler-bernoulli"),
    (replace(PLAIN, section=SECTIONS[::-1], supports=("free", "free")), "euler-bernoulli"),
    (replace(PLAIN, shear_stiffness=640.0, rotary_inertia=6.4e-4, supports=("clamped", "guided")), "timoshenko"),
    (
        replace(PLAIN, shear_stiffness=60.0, foundation=1e5, mass=MASSES[:1], supports=("free", "pinned")),
        "timoshenko",
    ),
    (replace(PLAIN, shear_stiffness=640.0, rotary_inertia=6e-3, supports=("pinned", "pinned")), "timoshenko"),
)
"""Each with the theory that it is taken by; of the ninth the section's own turning is soon fast enough for a wave, the
tenth hardly resists shear and lies on stiff ground, the last has its cut-off and more beyond among six modes."""
LEAF = SECTIONS[0], Section(length=0.23, bending_stiffness=1.9e-3, mass_per_length=0.11), SECTIONS[2]
DRIVEN = (*ANY, (replace(PLAIN, section=LEAF, supports=("clamped", "guided")), "euler-bernoulli"))
"""The last has a leaf in it that bends in waves a fourth as long as those beside it."""
MODES = 6
SHAPES = (1, 2, 5)
HERTZ = (3.1, 67.0, 431.0)
FORCES = (
    PointForce(position=0.1, amplitude=1.3, phase_deg=20.0),
    PointForce(position=0.29, amplitude=0.7, phase_deg=-110.0),
    PointForce(position=0.555, amplitude=2.1, phase_deg=75.0),
)
PLACES = np.array([0.0, 0.05, 0.17, 0.222, 0.31, 0.4, 0.487, 0.58, 0.61])


def _exponential(rates: Any) -> Any:
    """Of matrices of 4 by 4, (..., 4, 4)."""
    from scipy.linalg import expm

    return np.asarray(expm(rates))


class States:
    """A beam at one omega^2, cut at every step, at what stands on it and wherever else is asked, L = 1."""

    def __init__(
        self,
        beam: Beam,
        theory: str,
        square: float,
        also: Sequence[float] = (),
        resists: Mapping[float, tuple[complex, complex]] | None = None,
    ) -> None:
        """`resists`: stiffness across and against turning at places among `also`, N/m and N m."""
        self.beam, self.theory, self.square, self.resists = beam, theory, square, resists or {}
        self.lossy = 1.0 + 1j * beam.loss_factor
        standing = [*(mass.position for mass in beam.mass), *(spring.position for spring in beam.spring)]
        self.ends, self.rates, self.steps, start = [0.0], [], [], 0.0
        for piece in beam.pieces:
            rate, end = self._rate(piece), start + piece.length
            inner = {round(at, 12) for at in (*standing, *also) if start + 1e-9 < at < end - 1e-9}
            for stop in (*sorted(inner), end):
                n = int(np.ceil(abs(np.linalg.eigvals(rate)).max() * (stop - start) / beam.length / REACH)) + 1
                self.ends += list(np.linspace(start, stop, n + 1)[1:])
                self.rates += n * [rate]
                self.steps += n * [_exponential(rate * (stop - start) / (n * beam.length))]
                start = stop

    def _rate(self, piece: Piece) -> ComplexArray:
        """Of w / L, psi, M L / EI and V L^2 / EI of the beam's own EI, over x / L."""
        beam = self.beam
        unit, ei = beam.length, beam.bending_stiffness
        turning = 0.0 if self.theory == "euler-bernoulli" else piece.rotary_inertia or 0.0
        rate = np.zeros((4, 4), dtype=complex)
        rate[0, 1] = rate[2, 3] = 1.0
        if self.theory == "timoshenko" and piece.shear_stiffness:
            rate[0, 3] = -ei / (float(piece.shear_stiffness) * self.lossy * unit**2)
        rate[1, 2] = ei / (float(piece.bending_stiffness) * self.lossy)
        rate[2, 1] = (beam.tension - turning * self.square) * unit**2 / ei
        rate[3, 0] = (float(piece.mass_per_length) * self.square - beam.foundation) * unit**4 / ei
        return rate

    def _over(self, at: float) -> ComplexArray:
        """From left to right of what stands at a place."""
        beam, over = self.beam, np.eye(4, dtype=complex)
        unit, ei = beam.length, beam.bending_stiffness
        for mass in beam.mass:
            if abs(mass.position - at) < 1e-9:
                over[3, 0] += mass.mass * self.square * unit**3 / ei
                over[2, 1] -= mass.rotary_inertia * self.square * unit / ei
        for spring in beam.spring:
            if abs(spring.position - at) < 1e-9:
                over[3, 0] -= spring.stiffness * unit**3 / ei
                over[2, 1] += spring.rotational * unit / ei
        for place, (across, turning) in self.resists.items():
            if abs(place - at) < 1e-9:
                over[3, 0] -= across * unit**3 / ei
                over[2, 1] += turning * unit / ei
        return over

    @property
    def matrix(self) -> ComplexArray:
        """Of all states left of the ends of spans, square: both ends' conditions and every span."""
        n = len(self.rates)
        matrix = np.zeros((4 * n + 4, 4 * n + 4), dtype=complex)
        matrix[[0, 1], HELD[self.beam.supports[0]]] = 1.0
        for i, step in enumerate(self.steps):
            matrix[4 * i + 2 : 4 * i + 6, 4 * i : 4 * i + 4] = -step @ self._over(self.ends[i])
            matrix[4 * i + 2 : 4 * i + 6, 4 * i + 4 : 4 * i + 8] = np.eye(4)
        matrix[-2:, -4:] = self._over(self.ends[-1])[list(HELD[self.beam.supports[1]])]
        return matrix

    def under(self, forces: Sequence[PointForce]) -> ComplexArray:
        """States right of every end but the last, which is left of what stands there, (n + 1, 4), in metres."""
        beam, matrix = self.beam, self.matrix
        right, jumps = np.zeros(len(matrix), dtype=complex), np.zeros((len(self.ends), 4), dtype=complex)
        for force in forces:
            jumps[self.end(force.position), 3] += phasor(force) * beam.length**3 / beam.bending_stiffness
        for i, step in enumerate(self.steps):
            right[4 * i + 2 : 4 * i + 6] = step @ jumps[i]
        right[-2:] = -jumps[-1][list(HELD[beam.supports[1]])]
        jumps[-1] = 0.0
        return np.asarray(self.past(np.linalg.solve(matrix, right)) + jumps)

    def past(self, left: Any) -> ComplexArray:
        """States right of what stands at every end but the last, left of that, (n + 1, 4)."""
        each = left.reshape(-1, 4)
        return np.array([*(self._over(at) @ state for at, state in zip(self.ends[:-1], each, strict=False)), each[-1]])

    def end(self, at: float) -> int:
        """Which end of a span a place is."""
        return int(np.argmin(abs(np.array(self.ends) - at)))

    def read(self, states: Any, at: float, derivative: int) -> complex:
        """A derivative of the deflection by x right of a place."""
        i = self.end(at)
        state = states[i]
        for _ in range(derivative):
            state = self.rates[min(i, len(self.rates) - 1)] @ state
        return complex(state[0] / self.beam.length**derivative)

    def inertia(self, states: Array) -> float:
        """Modal mass of a motion: of every span by Gauss's rule, and of what stands on the beam."""
        beam, total = self.beam, 0.0
        points, weights = np.polynomial.legendre.leggauss(6)
        starts = np.cumsum([piece.length for piece in beam.pieces])
        for i, rate in enumerate(self.rates):
            length = self.ends[i + 1] - self.ends[i]
            piece = beam.pieces[min(int(np.searchsorted(starts, self.ends[i] + 0.5 * length)), len(beam.pieces) - 1)]
            turning = 0.0 if self.theory == "euler-bernoulli" else piece.rotary_inertia or 0.0
            within = _exponential(rate.real * (0.5 + 0.5 * points)[:, None, None] * length / beam.length)
            w, psi = (within @ states[i])[:, :2].T
            total += 0.5 * length * weights @ (piece.mass_per_length * w**2 + turning * (psi / beam.length) ** 2)
        for body in beam.mass:
            w, psi = states[self.end(body.position)][:2]
            total += body.mass * w**2 + body.rotary_inertia * (psi / beam.length) ** 2
        return float(total)

    @property
    def sign(self) -> float:
        """Of the determinant, which is real without loss."""
        return float(np.linalg.slogdet(self.matrix.real)[0])


def fields_error(number: float) -> float:
    """Worst error of exact fields of a beam, to the second derivative, alone and in a sweep, over the largest."""
    from verify.exact.harmonic import solve_harmonic
    from verify.exact.sweeps import sweep_harmonic

    (beam, theory), worst = DRIVEN[int(number)], 0.0
    stops = (*(float(x) for x in PLACES), *(force.position for force in FORCES))
    for loss in (0.0, 0.037):
        lossy = replace(beam, loss_factor=loss)
        sweep = sweep_harmonic(lossy, FORCES, np.array(HERTZ), theory)
        for i, hertz in enumerate(HERTZ):
            states = States(lossy, theory, (2.0 * pi * hertz) ** 2, stops)
            under = states.under(FORCES)
            fields = [sweep.field(i), *([solve_harmonic(lossy, FORCES, hertz, theory)] if i == 1 else [])]
            for derivative in range(3):
                exact = np.array([states.read(under, float(x), derivative) for x in PLACES])
                off = [abs(field.shapes(PLACES, derivative) - exact).max() for field in fields]
                worst = largest(worst, float(largest(off) / abs(exact).max()))
    return worst


@cache
def exact_frequencies(number: int) -> tuple[float, ...]:
    """Of the first modes, Hz."""
    from verify.exact.modes import solve_modes

    beam, theory = ANY[number]
    return tuple(solve_modes(beam, MODES, theory).frequencies_hz)


def frequencies_error(number: float) -> float:
    """Of exact frequencies: by how far the determinant's change of sign may be missed, and whether one is left out.

    Between neighbours, and below the first, the determinant keeps its sign on a grid.
    """
    beam, theory = ANY[int(number)]
    found = exact_frequencies(int(number))

    def sign(hertz: float) -> float:
        return States(beam, theory, (2.0 * pi * hertz) ** 2).sign

    missed = 0.0
    for n, hertz in enumerate(found):
        before = found[n - 1] if n else 0.15 * hertz
        between = {sign(before + part * (hertz - before)) for part in (1e-3, 0.37, 0.81, 0.999)}
        if len(between) != 1 or sign(hertz * (1.0 + 1e-6)) in between:
            return 1.0
        within = next(
            (part for part in (1e-13, 1e-12, 1e-11, 1e-10) if sign(hertz * (1 - part)) != sign(hertz * (1 + part))), 1.0
        )
        missed = largest(missed, within)
    return missed


def counted_error(number: float) -> float:
    """How many modes are counted wrongly below trial values that lie between frequencies."""
    from verify.exact.roots import modes_below

    beam, theory = ANY[int(number)]
    found, wrong = np.array(exact_frequencies(int(number))), 0
    beside = np.outer((1.0 - 1e-6, 1.0 + 1e-6), found).ravel()
    between = np.concatenate([found[:1] * 0.4, found[:-1] + np.diff(found) * 0.6, beside])
    for hertz in between:
        root = sqrt(2.0 * pi * hertz / beam.wave_constant) * beam.length
        wrong += modes_below(beam, root, theory) != int((found < hertz).sum()) + beam.rigid_motions
    return float(wrong)


def shapes_error(number: float) -> float:
    """Worst error of exact shapes, with their slopes, of the inertia of all that moves, against null vectors."""
    from verify.exact.modes import mode_shape

    (beam, theory), worst = ANY[int(number)], 0.0
    for mode in SHAPES:
        states = States(beam, theory, (2.0 * pi * exact_frequencies(int(number))[mode - 1]) ** 2, PLACES.tolist())
        own = states.past(np.linalg.svd(states.matrix.real)[2][-1]).real
        own /= sqrt(states.inertia(own))
        for derivative in range(2):
            exact = np.array([states.read(own, float(x), derivative).real for x in PLACES])
            found = mode_shape(beam, mode, PLACES, derivative, theory)
            worst = largest(worst, float(abs(np.sign(found @ exact) * found - exact).max() / abs(exact).max()))
    return worst


def buckling_error(number: float) -> float:
    """Of exact buckling loads: by how far the determinant's change of sign at rest may be missed."""
    from verify.exact.buckling import buckling_load

    beam = replace(ANY[int(number)][0], tension=0.0)
    load = buckling_load(beam)

    def sign(part: float) -> float:
        return States(replace(beam, tension=-part * load), "euler-bernoulli", 0.0).sign

    if len({sign(part) for part in (0.02, 0.3, 0.7, 0.97)}) != 1 or sign(0.97) == sign(1.0 + 1e-6):
        return 1.0
    return next((part for part in (1e-13, 1e-12, 1e-11, 1e-10) if sign(1 - part) != sign(1 + part)), 1.0)


NUMBERS = tuple(float(n) for n in range(len(ANY)))
_row = partial(Floor, along="beam")

ROWS: tuple[Row, ...] = (
    _row(
        id="fields-of-any-beam",
        title="Exact fields of twelve beams with anything on, alone and in a sweep, against states by exponentials",
        why="exact/spans.py: power series to rounding; the exponential's own rounding is what is left.",
        at=(*NUMBERS, float(len(ANY))),
        promise=1e-10,
        error=fields_error,
    ),
    _row(
        id="frequencies-of-any-beam",
        title="Six exact frequencies of each, against changes of sign of a dense determinant, none left out",
        why="exact/minors.py: to rounding; the determinant's own is what is left.",
        at=NUMBERS,
        promise=1e-11,
        error=frequencies_error,
    ),
    _row(
        id="counts-of-any-beam",
        title="Modes counted below values between frequencies, wrong ones",
        why="exact/minors.py: the count of Wittrick and Williams is a whole number.",
        at=NUMBERS,
        promise=0.5,
        error=counted_error,
    ),
    _row(
        id="shapes-of-any-beam",
        title="Five exact shapes and slopes of each, of modal mass 1, against null vectors and Gauss's rule",
        why="exact/shapes.py: inverse iteration to rounding; a null vector keeps nine digits.",
        at=NUMBERS,
        promise=1e-8,
        error=shapes_error,
    ),
    _row(
        id="buckling-of-any-beam",
        title="Exact buckling loads of beams with springs, ground and sections, against a dense determinant at rest",
        why="exact/buckling.py: the same equation as for frequencies, to rounding.",
        at=(0.0, 1.0, 3.0, 5.0, 6.0),
        promise=1e-11,
        error=buckling_error,
    ),
)
