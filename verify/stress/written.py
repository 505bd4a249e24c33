"""Elements and links of beams with anything on them, against matrices that are written out in full and solved densely.

Textbook elements of 4 by 4, and rigid links with a spring in every joint, in metres and newtons. Only where a beam is
cut comes from the models.
"""

from collections.abc import Callable, Sequence
from functools import cache, cached_property, partial
from math import pi
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import phasor
from verify.section import Piece
from verify.stress.anything import ANY, FORCES, PLACES, SECTIONS
from verify.stress.kind import Floor, Row

PARTS, MODES = 13, 6
HELD = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
"""Which of deflection and slope an end holds."""
WALLS = ("clamped", "guided")
GREGORY = np.array([3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0])
"""How soft joints are from a clamp on, over those of links alike inside."""
CUBICS = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Hermite's, of deflection and slope at both ends, over the length."""
THIN = tuple(n for n, (_, theory) in enumerate(ANY) if theory == "euler-bernoulli")
LOSS, RATIO, DASHPOT = 0.037, 0.021, 0.013
HERTZ = np.array([3.1, 67.0, 131.0, 293.0, 431.0])
"""More than are solved one by one."""


def beams() -> tuple[Beam, ...]:
    """Those of Euler and Bernoulli with anything on them, and a stepped one between a guide and a clamp."""
    mass = PointMass(position=0.36, mass=0.022)
    spring = PointSpring(position=0.0, stiffness=510.0)
    last = replace(ANY[7][0], section=SECTIONS, mass=(mass,), spring=(spring,), supports=("guided", "clamped"))
    return (*(ANY[n][0] for n in THIN), last)


class Written:
    """Dense matrices over all unknowns: of bending, of all else that is stiff, of mass."""

    bent: Array
    rest: Array
    mass: Array
    free: list[int]

    def __init__(self, beam: Beam, nodes: Array) -> None:
        self.beam, self.nodes, self.lengths = beam, nodes, np.diff(nodes)
        ends = np.cumsum([piece.length for piece in beam.pieces])
        middles = np.clip(np.searchsorted(ends, nodes[:-1] + 0.5 * self.lengths), 0, len(ends) - 1)
        self.pieces: list[Piece] = [beam.pieces[int(i)] for i in middles]

    def kept(self, matrix: Any) -> Any:
        """Of the unknowns that the ends leave free."""
        return matrix[np.ix_(self.free, self.free)]

    @cached_property
    def modes(self) -> tuple[Array, Array]:
        """(omega^2, shapes over all unknowns in columns, of modal mass 1)."""
        from scipy.linalg import eigh

        values, vectors = eigh(self.kept(self.bent + self.rest), self.kept(self.mass))
        values[: self.beam.rigid_motions] = 0.0
        every = np.zeros((len(self.mass), len(values)))
        every[self.free] = vectors
        return values, every

    def hertz(self, n_modes: int) -> Array:
        """Of the first elastic modes."""
        rigid = self.beam.rigid_motions
        return np.asarray(np.sqrt(self.modes[0][rigid : rigid + n_modes]) / (2.0 * pi))

    def under(self, load: ComplexArray, hertz: float, ratio: float = 0.0, more: Array | None = None) -> ComplexArray:
        """All unknowns under a load: bending with the beam's loss, `more` dashpots, a ratio of every mode."""
        omega, lossy = 2.0 * pi * hertz, 1.0 + 1j * self.beam.loss_factor
        found = np.zeros(len(self.mass), dtype=complex)
        if ratio:
            values, vectors = self.modes
            answers = (vectors.T @ load) / (values - omega**2 + 2j * ratio * omega * np.sqrt(np.maximum(values, 0.0)))
            return np.asarray(vectors @ answers)
        stiffness = self.bent * lossy + self.rest + (0.0 if more is None else 1j * omega * more)
        matrix: Any = self.kept(stiffness - omega**2 * self.mass)
        found[self.free] = np.linalg.solve(matrix, load[self.free])
        return found

    def buckling(self, turned: Array) -> float:
        """The least compression under which no stiffness is left, `turned` being that of a tension of 1."""
        from scipy.linalg import eigh

        values = eigh(self.kept(turned), self.kept(self.bent + self.rest), eigvals_only=True)
        return float(1.0 / values[-1])


class Elements(Written):
    """Hermite elements by their textbook entries."""

    def __init__(self, beam: Beam, nodes: Array) -> None:
        super().__init__(beam, nodes)
        size = 2 * len(nodes)
        self.bent, self.rest, self.mass, self.turned = np.zeros((4, size, size))
        for i, (piece, n) in enumerate(zip(self.pieces, self.lengths, strict=True)):
            at = slice(2 * i, 2 * i + 4)
            bending, pulled, inertia = _hermite(float(n))
            self.bent[at, at] += piece.bending_stiffness * bending
            self.turned[at, at] += pulled
            self.rest[at, at] += beam.foundation * inertia
            self.mass[at, at] += piece.mass_per_length * inertia
        self.rest += beam.tension * self.turned
        for mass in beam.mass:
            self._stands(self.mass, mass.position, mass.mass, mass.rotary_inertia)
        for spring in beam.spring:
            self._stands(self.rest, spring.position, spring.stiffness, spring.rotational)
        held = list(HELD[beam.supports[0]]) + [size - 2 + k for k in HELD[beam.supports[1]]]
        self.free = [i for i in range(size) if i not in held]

    def _stands(self, matrix: Array, at: float, across: float, turning: float) -> None:
        for derivative, value in ((0, across), (1, turning)):
            row = self.row(at, derivative)
            matrix += value * np.outer(row, row)

    def row(self, x: float, derivative: int) -> Array:
        """What reads a derivative at x off the nodal values."""
        i = int(np.clip(np.searchsorted(self.nodes, x + 1e-12, side="right") - 1, 0, len(self.lengths) - 1))
        n, z = float(self.lengths[i]), (x - float(self.nodes[i])) / float(self.lengths[i])
        powers = ((1.0, z, z**2, z**3), (0.0, 1.0, 2.0 * z, 3.0 * z**2), (0.0, 0.0, 2.0, 6.0 * z))[derivative]
        row = np.zeros(2 * len(self.nodes))
        row[2 * i : 2 * i + 4] = CUBICS @ powers * (1.0, n, 1.0, n) / n**derivative
        return row

    def load(self, forces: Sequence[PointForce]) -> ComplexArray:
        """Of point forces."""
        return np.asarray(sum(phasor(force) * self.row(force.position, 0) for force in forces), dtype=complex)

    def read(self, found: ComplexArray, x: Array, derivative: int) -> ComplexArray:
        """At places."""
        return np.asarray(np.array([self.row(at, derivative) for at in x.tolist()]) @ found)


def _hermite(n: float) -> tuple[Array, Array, Array]:
    """K of bending, of a tension of 1, and M of an element of length n, EI = rho A = 1."""
    d = np.array([1.0, n, 1.0, n])
    scale = np.outer(d, d)
    bending = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) * scale / n**3
    pulled = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]]) * scale / (30.0 * n)
    mass = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * scale * n / 420.0
    return bending, pulled, mass


class Links(Written):
    """Rigid links, half of each one's give in the joint at either end; what stands on one moves as it does there."""

    def __init__(self, beam: Beam, nodes: Array, wall: Array = GREGORY) -> None:
        super().__init__(beam, nodes)
        n, (left, right) = len(self.lengths), beam.supports
        eye = np.eye(n + 1)
        self.tilt, middle = np.diff(eye, axis=0) / self.lengths[:, None], 0.5 * (eye[1:] + eye[:-1])
        none = np.zeros((1, n + 1))
        walled = [self.tilt, *([none] if right in WALLS else [])]
        self.bend = np.diff(np.vstack([none, *walled] if left in WALLS else walled), axis=0)
        half = np.array([0.5 * a / piece.bending_stiffness for piece, a in zip(self.pieces, self.lengths, strict=True)])
        give = half[1:] + half[:-1]
        self.give = np.concatenate([2.0 * half[: left in WALLS], give, 2.0 * half[n - (right in WALLS) :]])
        for side, support in ((1, left), (-1, right)):
            along = self.give[::side]
            along[: len(wall) if support == "clamped" else 0] *= wall[: len(wall) if support == "clamped" else 0]
            along[: int(support == "guided")] *= 0.5
        self.bent = (self.bend.T / self.give) @ self.bend
        line = np.array([piece.mass_per_length for piece in self.pieces]) * self.lengths
        bed = beam.foundation * self.lengths
        self.turned = (self.tilt.T * self.lengths) @ self.tilt
        self.mass, self.rest = (
            (middle.T * own) @ middle + (self.tilt.T * (own * self.lengths**2 / 12.0)) @ self.tilt
            for own in (line, bed)
        )
        self.rest += beam.tension * self.turned
        for mass in beam.mass:
            self._stands(self.mass, mass.position, mass.mass, mass.rotary_inertia)
        for spring in beam.spring:
            self._stands(self.rest, spring.position, spring.stiffness, spring.rotational)
        held = [end for end, support in zip((0, n), beam.supports, strict=True) if support in ("pinned", "clamped")]
        self.free = [i for i in range(n + 1) if i not in held]

    def _link(self, x: float) -> int:
        return int(np.clip(np.searchsorted(self.nodes, x, side="right") - 1, 0, len(self.lengths) - 1))

    def _stands(self, matrix: Array, at: float, across: float, turning: float) -> None:
        row, tilt = self.row(at), self.tilt[self._link(at)]
        matrix += across * np.outer(row, row) + turning * np.outer(tilt, tilt)

    def row(self, x: float) -> Array:
        """Shares of both joints of a link by the lever rule."""
        i = self._link(x)
        share = (x - self.nodes[i]) / self.lengths[i]
        row = np.zeros(len(self.nodes))
        row[i : i + 2] = 1.0 - share, share
        return row

    def load(self, forces: Sequence[PointForce]) -> ComplexArray:
        """Of point forces, by the lever rule."""
        return np.asarray(sum(phasor(force) * self.row(force.position) for force in forces), dtype=complex)

    def read(self, found: ComplexArray, x: Array, derivative: int) -> ComplexArray:
        """At places of the cubic spline through the joints, level at walls and without moment at other ends."""
        from scipy.interpolate import CubicSpline

        ends = tuple((1 if support in WALLS else 2, 0.0) for support in self.beam.supports)
        return np.asarray(CubicSpline(self.nodes, found, bc_type=ends)(x, derivative))


def _nodes(beam: Beam, model: str, grading: float = 1.0) -> Array:
    """Where a model cuts a beam, metres. Raises ArithmeticError where its stretches are not graded as they are told."""
    if model == "fem":
        from verify.elements.cuts import cut, stretches

        parts, pieces = cut(beam, PARTS, grading), stretches(beam)
    else:
        from verify.models.division import divide

        parts, pieces = divide(beam, PARTS, grading), beam.pieces
    lengths, start, total = parts.lengths * parts.unit, 0, 0.0
    for piece in pieces:
        total += piece.length
        end = int(np.argmin(abs(np.cumsum(lengths) - total))) + 1
        own, start = lengths[start:end], end
        steps = grading ** (1.0 / (len(own) - 1)) if len(own) > 1 else 1.0
        if (
            abs(own.sum() / piece.length - 1.0) > 1e-12
            or abs(own[1:] / own[:-1] / steps - 1.0).max(initial=0.0) > 1e-12
        ):
            raise ArithmeticError("parts end elsewhere than the beam's stretches, or are graded otherwise")
    if len(lengths) != PARTS:
        raise ArithmeticError(f"{len(lengths)} parts in place of {PARTS}")
    return np.concatenate([[0.0], np.cumsum(lengths)])


@cache
def written(model: str, number: int, grading: float = 1.0, **changes: float) -> tuple[Any, dict[str, Any]]:
    """(a model's matrices written out of one of the beams, the settings that it is asked with)."""
    beam = replace(beams()[number], **changes)
    graded = {} if grading == 1.0 else {"grading": grading}
    if model == "fem":
        return Elements(beam, _nodes(beam, model, grading)), graded
    return Links(beam, _nodes(beam, model, grading)), graded | {"attachment": "lever"}


def modes_error(model: str) -> Callable[[float], float]:
    """Beam -> worst error of frequencies, shapes, slopes and bends of parts, equal and graded."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        worst = 0.0
        for grading in (1.0, 1.7):
            own, settings = written(model, int(number), grading)
            found = MODELS[model].solve_modes(own.beam, MODES, PARTS, **settings)
            worst = max(worst, float(abs(found.frequencies_hz / own.hertz(MODES) - 1.0).max()))
            if model == "segment":
                shapes, x = found.readings["raw"](), own.nodes
                pairs = [(shapes, own.modes[1].T)]
            else:
                x = PLACES
                pairs = [(found.shapes(x, d), own.read(own.modes[1], x, d).T) for d in range(3)]
            for seen, every in pairs:
                exact = every[own.beam.rigid_motions :][:MODES]
                sides = np.sign(np.sum(pairs[0][0] * pairs[0][1][own.beam.rigid_motions :][:MODES], axis=1))[:, None]
                worst = max(worst, float((abs(sides * seen - exact).max(axis=1) / abs(exact).max(axis=1)).max()))
                first = pairs[0][0][:, : len(x) // 2]
                worst = max(worst, float((first[np.arange(MODES), (abs(first) > 1e-3).argmax(axis=1)] < 0.0).any()))
        return worst

    return error


def fields_error(model: str) -> Callable[[float], float]:
    """Beam -> worst error of fields without loss, with a loss factor, a ratio, dashpots; alone and in a sweep."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        worst, dashed = 0.0, model == "segment"
        cases = [({}, 0.0, 0.0), ({"loss_factor": LOSS}, 0.0, 0.0), ({}, RATIO, 0.0), *([({}, 0.0, DASHPOT)] * dashed)]
        for changes, ratio, dashpot in cases:
            own, settings = written(model, int(number), **changes)
            settings = settings | ({"load": "lever", "reading": "raw"} if dashed else {})
            settings |= ({"modal_damping": ratio} if ratio else {}) | ({"joint_dashpot": dashpot} if dashpot else {})
            more = dashpot * own.bend.T @ own.bend if dashpot else None
            sweep = MODELS[model].sweep_harmonic(own.beam, FORCES, HERTZ, PARTS, **settings)
            for i, hertz in enumerate(HERTZ):
                states = own.under(own.load(FORCES), float(hertz), ratio, more)
                alone = MODELS[model].solve_harmonic(own.beam, FORCES, float(hertz), PARTS, **settings)
                for derivative in range(3):
                    exact = own.read(states, PLACES, derivative)
                    for found in (alone.shapes(PLACES, derivative), sweep.shapes(PLACES, derivative)[i]):
                        worst = max(worst, float(abs(found - exact).max() / abs(exact).max()))
        return worst

    return error


def units_error(number: float) -> float:
    """Worst error of elements' deflections under unit forces at two places, without and with loss."""
    from verify.models.catalogue import MODELS

    worst, positions = 0.0, (0.13, 0.48)
    for changes in ({}, {"loss_factor": LOSS}):
        own, _ = written("fem", int(number), **changes)
        found = MODELS["fem"].unit_responses(own.beam, positions, HERTZ, PLACES, PARTS)
        for i, hertz in enumerate(HERTZ):
            for j, at in enumerate(positions):
                states = own.under(own.load([PointForce(position=at)]), float(hertz))
                exact = own.read(states, PLACES, 0)
                worst = max(worst, float(abs(found[i, j] - exact).max() / abs(exact).max()))
    return worst


def buckling_error(model: str) -> Callable[[float], float]:
    """Beam -> error of its buckling load, whatever pulls at it."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS

        own, settings = written(model, int(number), tension=0.0)
        load = float(own.buckling(own.turned))
        pulled = replace(own.beam, tension=0.3 * load)
        return max(
            abs(MODELS[model].buckling_load(beam, PARTS, **settings) / load - 1.0) for beam in (own.beam, pulled)
        )

    return error


def stacked_error(model: str) -> Callable[[float], float]:
    """Beam -> worst difference between nine beams like it solved together and each by itself, and how many are not."""

    def error(number: float) -> float:
        from importlib import import_module

        from verify.models.catalogue import MODELS
        from verify.models.eigen import lowest
        from verify.models.stacks import lowest_of_each

        several = [_like(beams()[int(number)], 1.0 + 0.07 * i) for i in range(9)]
        room, settings = ("elements", {}) if model == "fem" else ("segments", {"attachment": "lever"})
        together = import_module(f"verify.{room}.sweeps").sweep_modes(several, 2, 20, **settings)
        alone = [MODELS[model].solve_modes(beam, 2, 20, **settings).frequencies_hz for beam in several]
        stack, pencil = _stacked(model, several, 20)
        start = np.hstack([pencil.rigid, lowest(pencil, 5).vectors])
        left = sum(not sure for sure in lowest_of_each(stack, 2, start)[1])
        return max(float(abs(together / np.array(alone) - 1.0).max()), float(left))

    return error


def _stacked(model: str, several: list[Beam], count: int) -> tuple[Any, Any]:
    """(a stack of beams, the pencil of the first). Raises ArithmeticError where they are not of one layout."""
    if model == "fem":
        from verify.elements.mesh import build_elements
        from verify.elements.pencil import element_pencil
        from verify.elements.stacks import element_stack, layout

        shared = {layout(beam, count, 1.0, "euler-bernoulli") for beam in several}
        found = element_stack(several, count), element_pencil(build_elements(several[0], count, 1.0, "euler-bernoulli"))
    else:
        from verify.segments import stacks
        from verify.segments.linear import settings_of
        from verify.segments.links import build_chain, chain_pencil

        settings = settings_of("gregory", "series", 1.0, "euler-bernoulli", "lever")
        shared = {stacks.layout(beam, **settings) for beam in several}
        found = stacks.chain_stack(several, count, settings), chain_pencil(build_chain(several[0], count, **settings))
    if len(shared) != 1 or None in shared:
        raise ArithmeticError("beams that are alike are not taken together")
    return found


def _like(beam: Beam, part: float) -> Beam:
    """The same with what stands on it, pulls at it and carries it so many times as much."""
    mass = tuple(replace(one, mass=one.mass * part, rotary_inertia=one.rotary_inertia * part**2) for one in beam.mass)
    spring = tuple(
        replace(one, stiffness=one.stiffness / part, rotational=one.rotational * part) for one in beam.spring
    )
    section = beam.section and (replace(beam.section[0], bending_stiffness=3.1 * part), *beam.section[1:])
    own = {} if section else {"bending_stiffness": (beam.bending_stiffness or 1.0) * part, "length": beam.length}
    return replace(beam, mass=mass, spring=spring, section=section, foundation=beam.foundation * part, **own)


NUMBERS = tuple(float(n) for n in range(len(THIN) + 1))
_row = partial(Floor, along="beam", at=NUMBERS)

ROWS: tuple[Row, ...] = (
    _row(
        id="modes-of-elements-written-out",
        title="Six modes of 13 elements, equal and graded, against textbook matrices solved densely",
        why="elements/linear.py: the same elements; LAPACK on assembled matrices keeps nine digits.",
        promise=1e-9,
        error=modes_error("fem"),
    ),
    _row(
        id="modes-of-links-written-out",
        title="Six modes of 13 links, equal and graded, with bodies where they stand, against matrices solved densely",
        why="segments/links.py: the same links and springs, to the rounding of dense matrices.",
        promise=1e-9,
        error=modes_error("segment"),
    ),
    _row(
        id="fields-of-elements-written-out",
        title="Fields of 13 elements without loss, with a loss factor and with a ratio, alone and in a sweep",
        why="elements/linear.py, elements/sweeps.py: the same matrices, solved densely.",
        promise=1e-8,
        error=fields_error("fem"),
    ),
    _row(
        id="fields-of-links-written-out",
        title="Fields of 13 links without loss, with a loss factor, a ratio and dashpots, alone and in a sweep",
        why="segments/linear.py, segments/sweeps.py: the same matrices, solved densely.",
        promise=1e-9,
        error=fields_error("segment"),
    ),
    _row(
        id="unit-forces-of-elements",
        title="Deflections of 13 elements under unit forces, without and with loss",
        why="elements/linear.py: sums over all modes, against the same matrices solved densely.",
        promise=1e-9,
        error=units_error,
    ),
    Floor(
        id="buckling-of-elements-written-out",
        title="Buckling loads of 13 elements on springs and ground, pulled at or not",
        why="elements/pencil.py: the same matrices, solved densely.",
        along="beam",
        at=NUMBERS[:4] + NUMBERS[5:],
        promise=1e-9,
        error=buckling_error("fem"),
    ),
    Floor(
        id="buckling-of-links-written-out",
        title="The same of 13 links",
        why="segments/buckling.py: the same matrices, solved densely.",
        along="beam",
        at=NUMBERS[:4] + NUMBERS[5:],
        promise=1e-9,
        error=buckling_error("segment"),
    ),
    Floor(
        id="nine-beams-at-once-elements",
        title="Nine beams of elements in one call against each by itself, and how many of them do not settle together",
        why="models/stacks.py: each as right as if it had been asked for alone.",
        along="beam",
        at=(4, 5),
        promise=1e-11,
        error=stacked_error("fem"),
    ),
    Floor(
        id="nine-beams-at-once-segments",
        title="The same of segments",
        why="models/stacks.py: each as right as if it had been asked for alone.",
        along="beam",
        at=(0, 2, 3, 5),
        promise=1e-11,
        error=stacked_error("segment"),
    ),
)
