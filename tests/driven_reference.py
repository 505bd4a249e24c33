"""What gates of driven fields and of shapes expect, by states, textbook matrices and links of no model.

The exact field is carried as w, psi, M and S in 30 digits (`states_reference`); elements are the textbook's 4 x 4
matrices, chains rigid links with springs between them, both dense, in metres and newtons. Forces are
(position, newton, degrees). Only what a beam is made of comes from the suite.
"""

from types import SimpleNamespace

import mpmath as mp
import numpy as np
from carried_reference import GREGORY, hermite
from msgspec.structs import replace
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh
from states_reference import _end, _states, frequency_near

DIGITS = 60
"""A field at 20 kHz grows by 1e17 from end to end, twice."""

HELD = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
WALLS = ("clamped", "guided")


def phasor(force):
    return force[1] * np.exp(1j * np.deg2rad(force[2]))


# --- The exact beam -------------------------------------------------------------------------------------------------


def field(beam, theory, hertz, forces, x):
    """Deflection, turn of the section, its moment and its shear force at x, (4,) complex, SI."""
    return sum(phasor(force) * unit_field(beam, theory, hertz, force[0], x) for force in forces)


def unit_field(beam, theory, hertz, place, x):
    with mp.workdps(DIGITS):
        end = _end(beam, _states(beam, theory, hertz, place))
        start = mp.lu_solve(end[:, :2], -end[:, 2])
        found = _states(beam, theory, hertz, place, x) * mp.matrix([start[0], start[1], 1])
        length, stiff = mp.mpf(beam.length), mp.mpf(beam.bending_stiffness)
        scale = length**3 / stiff
        return np.array(
            [
                complex(found[0] * scale),
                complex(found[1] * scale / length),
                complex(found[2] * length),
                complex(found[3]),
            ]
        )


def slip(beam, theory, x, force):
    """By how much a line is steeper than its section turns, radians, without loss."""
    return force / piece_at(beam, x).shear_stiffness if theory == "timoshenko" else 0.0


def shape(beam, theory, hertz, x):
    """Deflection and slope of the mode nearest to a frequency, of modal mass 1 kg, positive off the left end, (2,)."""
    beam = replace(beam, loss_factor=0.0)
    hertz = frequency_near(beam, theory, hertz)
    with mp.workdps(DIGITS):
        end = _end(beam, _states(beam, theory, hertz)[:, :2])
        row = 0 if abs(end[0, 0]) + abs(end[0, 1]) > abs(end[1, 0]) + abs(end[1, 1]) else 1
        start = mp.matrix([end[row, 1], -end[row, 0]])

        def at(place):
            found = _states(beam, theory, hertz, None, place)[:, :2] * start
            return (
                float(found[0]),
                float(found[1]) / beam.length,
                float(found[3]) * beam.bending_stiffness / beam.length**3,
            )

        mass, left = 0.0, 0.0
        points, weights = np.polynomial.legendre.leggauss(16)
        for piece, length in equal(beam, (3,) * (len(cuts(beam)) - 1)):
            for z, weight in zip(points, weights, strict=True):
                w, turn, _ = at(left + length / 2 * (z + 1))
                inertia = 0.0 if theory == "euler-bernoulli" else piece.rotary_inertia
                mass += weight * length / 2 * (piece.mass_per_length * w * w + inertia * turn * turn)
            left += length
        for one in beam.mass:
            w, turn, _ = at(one.position)
            mass += one.mass * w * w + one.rotary_inertia * turn * turn
        first = at(1e-3 * beam.length)[0]
        w, turn, force = at(x)
    return np.array([w, turn + slip(beam, theory, x, force)]) * np.sign(first) / np.sqrt(mass)


# --- Hermite elements -----------------------------------------------------------------------------------------------


def cuts(beam, stands=True):
    """Both ends and what lies between: where sections meet and, `stands`, where something stands on the beam."""
    bodies = {one.position for one in (*beam.mass, *beam.spring)} if stands else set()
    stops = sorted({0.0, *bodies, *np.cumsum([p.length for p in beam.pieces])})
    stops = [a for i, a in enumerate(stops) if i == 0 or a - stops[i - 1] > 1e-9 * beam.length]
    return [*stops[:-1], beam.length]


def equal(beam, counts, cut=True):
    """(piece, length) of every part, `counts` of them between what changes the beam or, `cut`, stands on it."""
    stops = cuts(beam, cut)
    parts = []
    for a, b, n in zip(stops[:-1], stops[1:], counts, strict=True):
        ends = np.cumsum([p.length for p in beam.pieces])
        piece = beam.pieces[min(int(np.searchsorted(ends, 0.5 * (a + b))), len(ends) - 1)]
        parts += [(piece, (b - a) / n)] * n
    return parts


class Elements:
    """Dense matrices of Hermite elements on any beam: bending alone, all else that is stiff, and mass."""

    def __init__(self, beam, parts):
        self.beam, self.lengths = beam, np.array([length for _, length in parts])
        self.nodes = np.append(0.0, np.cumsum(self.lengths))
        size = 2 * len(self.nodes)
        self.bent, self.held, self.mass = np.zeros((3, size, size))
        for i, (piece, length) in enumerate(parts):
            bending, pulled, inertia = hermite(length)
            at = slice(2 * i, 2 * i + 4)
            self.bent[at, at] += piece.bending_stiffness * bending
            self.held[at, at] += beam.tension * pulled + beam.foundation * inertia
            self.mass[at, at] += piece.mass_per_length * inertia
        for one in beam.mass:
            self.mass[self._at(one), self._at(one)] += one.mass
            self.mass[self._at(one) + 1, self._at(one) + 1] += one.rotary_inertia
        for one in beam.spring:
            self.held[self._at(one), self._at(one)] += one.stiffness
            self.held[self._at(one) + 1, self._at(one) + 1] += one.rotational
        fixed = [side + k for side, s in zip((0, size - 2), beam.supports, strict=True) for k in HELD[s]]
        self.free = [i for i in range(size) if i not in fixed]

    def _at(self, one):
        return 2 * int(abs(self.nodes - one.position).argmin())

    def row(self, x, derivative=0):
        """What reads a derivative at x off the nodal values."""
        i = int(np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.lengths) - 1))
        n, z = self.lengths[i], (x - self.nodes[i]) / self.lengths[i]
        cubics = [[1, 0, -3, 2], [0, n, -2 * n, n], [0, 0, 3, -2], [0, 0, -n, n]]
        values = np.zeros(2 * len(self.nodes))
        values[2 * i : 2 * i + 4] = [np.polynomial.Polynomial(c).deriv(derivative)(z) / n**derivative for c in cubics]
        return values

    def field(self, hertz, forces, x, damping=0.0, derivative=0):
        """The driven field at x; `damping` is a ratio of every mode beside the beam's loss factor."""
        omega, keep = 2 * np.pi * hertz, np.ix_(self.free, self.free)
        load = sum(phasor(force) * self.row(force[0]) for force in forces)[self.free]
        return (
            _answer(*(m[keep] for m in (self.bent, self.held, self.mass)), self.beam, omega, damping, load)
            @ (self.row(x, derivative)[self.free])
        )

    def mode(self, number, x, derivative=0):
        """Frequency and shape at x, of modal mass 1 and positive off the left end."""
        keep = np.ix_(self.free, self.free)
        values, vectors = eigh((self.bent + self.held)[keep], self.mass[keep])
        vector = vectors[:, number - 1 + self.beam.rigid_motions]
        near, read = (self.row(at, d)[self.free] @ vector for at, d in ((1e-3 * self.beam.length, 0), (x, derivative)))
        return float(np.sqrt(values[number - 1 + self.beam.rigid_motions]) / (2 * np.pi)), read * np.sign(near)


def _answer(bent, held, mass, beam, omega, damping, load):
    """Amplitudes under a load: complex bending stiffness, and with a ratio the sum over modes that it damps."""
    lossy = 1 + 1j * beam.loss_factor
    if not damping:
        return np.linalg.solve(bent * lossy + held - omega**2 * mass, load)
    values, vectors = eigh(bent + held, mass)
    values[: beam.rigid_motions] = 0.0  # whose rounding a ratio would damp, of its root
    own = values * lossy - omega**2 + 2j * damping * omega * np.sqrt(np.maximum(values, 0.0))
    return vectors @ ((vectors.T @ load) / own)


# --- Rigid links ----------------------------------------------------------------------------------------------------


class Links:
    """Dense matrices of rigid links: springs EI/l in the joints, Gregory's at a clamp; bodies where they sit."""

    def __init__(self, beam, parts, wall=GREGORY):
        self.beam, self.lengths = beam, np.array([length for _, length in parts])
        self.nodes, n = np.append(0.0, np.cumsum(self.lengths)), len(parts)
        eye = np.eye(n + 1)
        self.tilt, middle = np.diff(eye, axis=0) / self.lengths[:, None], 0.5 * (eye[1:] + eye[:-1])
        left, right = beam.supports
        none, rows = np.zeros((1, n + 1)), [self.tilt]
        rows = ([none] if left in WALLS else []) + rows + ([none] if right in WALLS else [])
        bend = np.diff(np.vstack(rows), axis=0)
        half = np.array([0.5 * length / piece.bending_stiffness for piece, length in parts])
        soft = list(half[1:] + half[:-1])
        soft = ([2 * half[0]] if left in WALLS else []) + soft + ([2 * half[-1]] if right in WALLS else [])
        self.soft = np.array(soft)
        for side, support in ((1, left), (-1, right)):
            if support == "clamped":
                self.soft[::side][: len(wall)] *= wall
            if support == "guided":  # the chain goes on as its mirror image: half the joint's energy, twice the turn
                self.soft[::side][0] *= 0.5
        self.bend = bend
        self.bent = (bend.T / self.soft) @ bend
        line = np.array([piece.mass_per_length * length for piece, length in parts])
        self.mass = (middle.T * line) @ middle + (self.tilt.T * (line * self.lengths**2 / 12)) @ self.tilt
        bed = beam.foundation * self.lengths
        self.held = (middle.T * bed) @ middle + (self.tilt.T * (bed * self.lengths**2 / 12)) @ self.tilt
        self.held += (self.tilt.T * (beam.tension * self.lengths)) @ self.tilt
        for one in (*beam.mass, *beam.spring):
            body = hasattr(one, "mass")
            matrix, share, turn = (
                (self.mass, one.mass, one.rotary_inertia) if body else (self.held, one.stiffness, one.rotational)
            )
            row, link = self.row(one.position), self._link(one.position)
            matrix += share * np.outer(row, row) + turn * np.outer(self.tilt[link], self.tilt[link])
        fixed = [end for end, s in zip((0, n), beam.supports, strict=True) if s in ("pinned", "clamped")]
        self.free = [i for i in range(n + 1) if i not in fixed]

    def _link(self, x):
        return int(np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.lengths) - 1))

    def row(self, x):
        """The lever rule: shares of both joints of a link."""
        i = self._link(x)
        values = np.zeros(len(self.nodes))
        s = (x - self.nodes[i]) / self.lengths[i]
        values[i : i + 2] = 1 - s, s
        return values

    def field(self, hertz, forces, damping=0.0, dashpot=0.0, load="lever"):
        """All joints under the forces, raw."""
        omega, keep = 2 * np.pi * hertz, np.ix_(self.free, self.free)
        share = self.row if load == "lever" else self.reciprocal
        loads = sum(phasor(force) * share(force[0]) for force in forces)[self.free]
        held = self.held + 1j * omega * dashpot * self.bend.T @ self.bend
        if not dashpot:
            held = self.held
        found = np.zeros(len(self.nodes), dtype=complex)
        found[self.free] = _answer(self.bent[keep], held[keep], self.mass[keep], self.beam, omega, damping, loads)
        return found

    def reciprocal(self, x):
        """Shares of the four joints around x on equal links: cubic Lagrange, and a twelfth of its second derivative."""
        unit, n = self.lengths[0], len(self.lengths)
        reflects = [s in ("pinned", "guided") for s in self.beam.supports]
        first = int(np.clip(self._link(x) - 1, -int(reflects[0]), n - 3 + int(reflects[1])))
        z, values = x / unit - first, np.zeros(n + 1)
        for j in range(4):
            others = [k for k in range(4) if k != j]
            lagrange = np.polynomial.Polynomial.fromroots(others) / np.prod([j - k for k in others])
            weight, at, sign = lagrange(z) + lagrange.deriv(2)(z) / 12, first + j, 1.0
            if at < 0:
                at, sign = -at, -1.0 if self.beam.supports[0] == "pinned" else 1.0
            if at > n:
                at, sign = 2 * n - at, -1.0 if self.beam.supports[1] == "pinned" else 1.0
            values[at] += sign * weight
        return values

    def mode(self, number):
        """Frequency and all joints, raw, of modal mass 1 and positive off the left end."""
        keep = np.ix_(self.free, self.free)
        values, vectors = eigh((self.bent + self.held)[keep], self.mass[keep])
        shape = np.zeros(len(self.nodes))
        shape[self.free] = vectors[:, number - 1 + self.beam.rigid_motions]
        sign = np.sign(shape[abs(shape) > 1e-9 * abs(shape).max()][0])
        return float(np.sqrt(values[number - 1 + self.beam.rigid_motions]) / (2 * np.pi)), sign * shape

    def corrected(self, joints):
        """Joints of equal links and the beam they stand for: y + delta^2 y / 12, mirrored at walls."""
        y = joints
        left, right = self.beam.supports
        bends = np.zeros(len(y), dtype=y.dtype)
        bends[1:-1] = y[2:] - 2 * y[1:-1] + y[:-2]
        if left == "guided":
            bends[0] = 2 * (y[1] - y[0])
        if right == "guided":
            bends[-1] = 2 * (y[-2] - y[-1])
        return y + bends / 12

    def line(self, joints, x, derivative=0):
        """Cubic C2 spline through values at the joints: no slope at walls, no moment at other ends."""
        ends = tuple((1 if s in WALLS else 2, 0.0) for s in self.beam.supports)
        return complex(CubicSpline(self.nodes, joints, bc_type=ends)(x, derivative))


# --- What a gate expects -----------------------------------------------------------------------------------------------

COUNTS = {
    ("stepped-beam", "fem", 24): (10, 14),
    ("stepped-beam", "segment", 24): (10, 14),
    ("instrument-arm", "fem", 24): (9, 15),
}
"""(scene, model, count) -> parts between what cuts the beam, where there is such a thing."""
FIGURES = ("wave.deflection", "wave.slope", "wave.curvature", "wave.receptance", "mode.deflection", "mode.slope")
"""Quantities that are known here."""
ON_RESONANCE = ("imposed-on-resonance",)
"""Gates of displacements at a resonance of the beam under forces."""
DERIVATIVES = {"deflection": 0, "slope": 1, "curvature": 2, "receptance": 0}


def known(scene, gate):
    """The figure of a gate of a driven field or of a shape, by its arguments."""
    given, what = gate.arguments, gate.quantity.partition(".")[2]
    beam = replace(scene.beam, loss_factor=given.get("loss_factor", scene.beam.loss_factor))
    count, model = given.get("count"), given.get("model", "analytic")
    parts = count and equal(beam, COUNTS.get((scene.name, model, count), (count,)), cut=model == "fem")
    solve = {"analytic": exactly, "fem": by_elements, "segment": by_links}[model]
    if gate.quantity.startswith("mode."):
        return solve(beam, parts, given, None, None, given["x"], DERIVATIVES[what])
    hertz = given.get("frequency_hz", scene.drive.frequency_hz)
    forces = [(f.position, f.amplitude, f.phase_deg) for f in scene.forces]
    if what == "receptance":
        forces = [(given["position"], 1.0, 0.0)]

    def at(drives, x, derivative):
        return solve(beam, parts, given, hertz, drives, x, derivative)

    if (
        scene.name == "driven-cantilever" and gate.id in ON_RESONANCE
    ):  # of the beam without what holds it: from both sides
        hertz = [hertz * (1 + side) for side in (-1e-6, 1e-6)]
        sides = [{**given, "frequency_hz": one} for one in hertz]
        return sum(known(scene, SimpleNamespace(id="", quantity=gate.quantity, arguments=one)) for one in sides) / 2
    if given.get("drive", scene.drive.kind) == "displacement":
        places = [force[0] for force in forces]
        receptance = [[at([(b, 1.0, 0.0)], a, 0) for b in places] for a in places]
        held = np.linalg.solve(receptance, [phasor(force) for force in forces])
        forces = [(place, abs(f), np.rad2deg(np.angle(f))) for place, f in zip(places, held, strict=True)]
    return at(forces, given["x"], DERIVATIVES[what])


def exactly(beam, parts, given, hertz, forces, x, derivative):
    theory = given.get("theory", "euler-bernoulli")
    if forces is None:
        from verify.exact.modes import exact_frequency_hz  # where to look: the root is sought again

        return shape(beam, theory, exact_frequency_hz(beam, given["mode"], theory), x)[derivative]
    states = field(beam, theory, hertz, forces, x)
    states[1] += slip(beam, theory, x, states[3]) / (1 + 1j * beam.loss_factor)
    return states[derivative] / (
        piece_at(beam, x).bending_stiffness * (1 + 1j * beam.loss_factor) if derivative == 2 else 1
    )


def piece_at(beam, x):
    ends = np.cumsum([piece.length for piece in beam.pieces])
    return beam.pieces[min(int(np.searchsorted(ends, x, side="right")), len(ends) - 1)]


def by_elements(beam, parts, given, hertz, forces, x, derivative):
    elements = Elements(beam, parts)
    if forces is None:
        return elements.mode(given["mode"], x, derivative)[1]
    return elements.field(hertz, forces, x, given.get("modal_damping", 0.0), derivative)


def by_links(beam, parts, given, hertz, forces, x, derivative):
    links = Links(beam, parts, GREGORY if given.get("wall", "gregory") == "gregory" else np.array([0.5]))
    reading = given.get("reading", "corrected")
    if forces is None:
        joints = links.mode(given["mode"])[1]
    else:
        joints = links.field(
            hertz,
            forces,
            given.get("modal_damping", 0.0),
            given.get("joint_dashpot", 0.0),
            given.get("load", "reciprocal"),
        )
    if reading == "links":
        link = links._link(x)
        turn = (links.tilt @ joints)[link]
        return turn if derivative else joints[link] + turn * (x - links.nodes[link])
    found = links.line(links.corrected(joints) if reading == "corrected" else joints, x, derivative)
    return found if forces is not None else found.real
