"""Sizes in the order in which they are tried, members that shear written out, and what is told of factors and shapes.

Zeros of harmonics, forces on feet beyond the crests' speed and errors of shapes stand beside them, by closed forms.
"""

from collections.abc import Iterator
from math import acos, log, pi, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import LADEN, PLAIN, STEPPED, STRIP, held

# --- Sizes ------------------------------------------------------------------------------------------------------------

LOOK = (2, 3, 4, 6, 9, 14, 21, 32, 48, 72, 108, 162, 243, 364, 400)
"""Sizes half as large again as those before."""
RISING: tuple[tuple[tuple[float, ...], bool], ...] = (
    ((3.0, 1.0, 2.0, 3.0, 3.0), True),
    ((1.0, 2.0, 3.0, 3.0), True),
    ((1.0, 2.0, 3.0), False),
    ((3.0, 1.0, 2.0, 3.0, 2.0), False),
    ((3.0, 1.0, 1.0, 2.0, 3.0), False),
    ((3.0, 1.0, 2.0, 2.0, 3.0), False),
    ((0.5, 1.0, 2.0, 3.0, 4.0), False),
)
MODES = np.arange(1.0, 6.0)


def _one(size: int, score: float, differences: Array | None = None) -> Any:
    return SimpleNamespace(count=size, score=score, differences=np.zeros(5) if differences is None else differences)


def _straight(size: int, right: float, beside: float = 0.0) -> Any:
    """Of a list of another size, whose differences go with 1/N^2, and something that does not."""
    off = 0.3 * MODES * (size**-2.0 - right**-2.0) + beside * MODES**2
    return _one(size, float(np.log(np.linalg.norm(off) + 1e-15)), off)


def _looks() -> Iterator[bool]:
    """Of first looks, where they end, and where neighbours point to: True where something is wrong."""
    from verify.identify.searching import _grid, _pointed_to, _rising, best_size

    yield tuple(_grid(1.5)) != LOOK
    yield any(_rising(list(scores)) is not told for scores, told in RISING)
    for around, right in (((14, 21, 32), 18), ((14, 21, 32), 27), ((6, 9), 7), ((2, 3, 4), 3), ((108, 162, 243), 130)):
        for beside in (0.0, 1e-9):
            yield _pointed_to([_straight(size, right, beside) for size in around]) != right
    yield _pointed_to([None, _straight(21, 30.0), _one(32, 0.0, np.zeros(4))]) != 21
    yield _pointed_to([_straight(14, 40.0), _straight(21, 40.0), None]) != 21
    for right in (120, 130):
        asked: list[int] = []

        def tried(size: int | None, right: int = right, asked: list[int] = asked) -> Any:
            asked.append(size or 0)
            return _straight(size or 0, right)

        found = best_size(tried, (377, 55))
        yield found is None or found.count != right
        yield asked[:14] != [*LOOK[:14]] or sorted(asked[-3:]) != [right - 1, right, right + 1]
        yield len(asked) != 14 + 1 * (asked[14] == 400) + 2 + 3


def _steps() -> Iterator[bool]:
    """Of the way downhill, and of sizes around the best where errors go up and down: True where something is wrong."""
    from verify.identify.searching import closest, downhill

    scores = {n: float((n - 40) ** 2 % 23) + 0.1 * abs(n - 40) for n in range(2, 401)}
    visited: list[int] = []

    def tried(size: int | None) -> Any:
        visited.append(size or 0)
        return _one(size or 0, scores[size or 0])

    known: dict[int, Any] = {31: _one(31, scores[31])}
    yield downhill(tried, known, 31, lambda size: 3) != _down(scores, 31, 3)
    yield visited[0] != 30 or len(visited) != len(set(visited)) or set(known) != {31, *visited}
    edge: dict[int, Any] = {3: _one(3, 5.0)}
    yield downhill(lambda size: _one(size or 0, float(size or 0)), edge, 3, lambda size: 4) != 2
    yield any(one is not None for size, one in edge.items() if size < 2)
    for right in (27, 60, 331):
        found = closest(lambda size, right=right: _one(size or 0, _uneven(size or 0, right)), (), (), lambda one: False)  # type: ignore[misc]
        yield found is None or found.count != right
    yield closest(lambda size: None, (), (), lambda one: True) is not None
    few: list[int] = []

    def told(size: int | None) -> Any:
        few.append(size or 0)
        return _one(size or 0, _uneven(size or 0, 48))

    found = closest(told, (), (55,), lambda one: one.count == 48)
    yield found is None or found.count != 48 or sorted(few) != sorted({*LOOK, 55})


def _down(scores: dict[int, float], here: int, near: int) -> int:
    """Where no size as near is better, by moving to the nearest that is."""
    while better := [n for n in range(here - near, here + near + 1) if scores[n] < scores[here]]:
        here = min(better, key=lambda n: (abs(n - here), n))
    return here


def _uneven(size: int, right: int) -> float:
    """A score that goes up and down about a straight one: on the first looks the nearest is least."""
    return float(abs(log(size / right)) + 0.2 * (size not in LOOK and size != right))


def sizes_error(number: float) -> float:
    """How often other sizes are tried, or another is found to be the best."""
    return float(sum((*_looks(), *_steps())))


# --- Members that shear -----------------------------------------------------------------------------------------------


def _rod(beam: Beam, n: int, wall: float) -> tuple[Array, Array]:
    """K and M of deflections 0..n and turns 0..n-1 of a rod, entry by entry: a joint at the left wall alone."""
    part, stiffness, mass = beam.length / n, beam.bending_stiffness, beam.mass_per_length
    shear, inertia = beam.pieces[0].shear_stiffness or 0.0, beam.pieces[0].rotary_inertia or 0.0
    k, m = np.zeros((2 * n + 1, 2 * n + 1)), np.zeros(2 * n + 1)
    for i in range(n):
        slope = np.zeros(2 * n + 1)
        slope[[i, i + 1, n + 1 + i]] = -1.0 / part, 1.0 / part, -1.0
        k += shear * part * np.outer(slope, slope)
        m[[i, i + 1]] += 0.5 * mass * part
        m[n + 1 + i] = inertia * part
    for i in range(1, n):
        jump = np.zeros(2 * n + 1)
        jump[[n + i, n + 1 + i]] = -1.0, 1.0
        k += stiffness / part * np.outer(jump, jump)
    k[n + 1, n + 1] += 0.0 if wall in (0.0, np.inf) else stiffness / (wall * part)
    return k, m


def shearing_error(parts: float) -> float:
    """Of rods whose links shear, on a wall by three rules, against their matrices written out entry by entry."""
    from scipy.linalg import eigh

    from verify.identify.matrices import rod

    n, beam, worst = int(parts), replace(held("clamped", "free"), thickness=0.06), 0.0
    for rule, wall in (("half", 0.5), ("full", 1.0), ("rigid", 0.0)):
        k, m = _rod(beam, n, wall)
        kept = [i for i in range(2 * n + 1) if i != 0 and not (rule == "rigid" and i == n + 1)]
        own = eigh(k[np.ix_(kept, kept)], np.diag(m[kept]), eigvals_only=True)[:4]
        worst = largest(worst, float(abs(rod(beam, n, 4, wall=rule) / np.sqrt(own) * 2.0 * pi - 1.0).max()))
    loose = replace(beam, supports=("pinned", "pinned"))
    k, m = _rod(loose, n, np.inf)
    kept = [i for i in range(2 * n + 1) if i not in (0, n)]
    own = eigh(k[np.ix_(kept, kept)], np.diag(m[kept]), eigvals_only=True)[:4]
    worst = largest(worst, float(abs(rod(loose, n, 4, wall="half") / np.sqrt(own) * 2.0 * pi - 1.0).max()))
    return largest(worst, float(sum(_unsaid())))


def _unsaid() -> Iterator[bool]:
    """Whether matrices of a theory are made of a beam that does not say what it takes."""
    from verify.identify.matrices import line_of

    inert = replace(PLAIN, rotary_inertia=1e-6)
    for beam, theory, made in (
        (PLAIN, "euler-bernoulli", True),
        (PLAIN, "rayleigh", False),
        (inert, "rayleigh", True),
        (inert, "timoshenko", False),
        (replace(inert, shear_stiffness=1e5), "timoshenko", True),
    ):
        try:
            line = line_of(beam, 6, theory)
        except InputError as error:
            yield made or "rotary_inertia or beam.shear_stiffness is missing" not in str(error)
        else:
            thick, sheared = theory != "euler-bernoulli", theory == "timoshenko"
            yield not made or bool(line.rotary.any()) is not thick or bool(np.isfinite(line.shear).all()) is not sheared


# --- In words ---------------------------------------------------------------------------------------------------------

SPRUNG = replace(STRIP, spring=(PointSpring(position=0.2, stiffness=900.0),))
ROUND = Beam(length=0.5, diameter=0.011, shape="round", youngs_modulus=70e9, density=2700.0)
MADE: tuple[tuple[float, Beam, str, str], ...] = (
    (1.02, STRIP, "euler-bernoulli", "E is +4.04 % or rho -3.88 %, or the thickness +2 %, or the length -0.985 %"),
    (0.4, STRIP, "timoshenko", "E is 0.16 times the scene's or rho 6.25 times the scene's"),
    (1.02, SPRUNG, "euler-bernoulli", "rho is -3.88 %"),
    (1.02, LADEN, "euler-bernoulli", "E is +4.04 %"),
    (0.97, replace(SPRUNG, mass=LADEN.mass), "rayleigh", "neither E nor rho nor a size alone makes one on this beam"),
    (0.97, replace(STRIP, tension=30.0), "euler-bernoulli", "rho is +6.28 %"),
    (1.02, STEPPED, "rayleigh", "in all sections alike E is +4.04 % or rho -3.88 %"),
    (1.02, PLAIN, "euler-bernoulli", "E is +4.04 % or rho -3.88 %, or the length -0.985 %"),
    (1.5, ROUND, "euler-bernoulli", "or the diameter +50 %, or the length -18.4 %"),
)
"""A factor on all frequencies, a beam, a theory; what alone makes it."""


def words_error(number: float) -> float:
    """How often what one factor is of, what else a list may be, or how far off the next is, is told otherwise."""
    from verify.identify.causes_told import made_by
    from verify.identify.family import Candidate
    from verify.identify.told import _either, _times

    wrong = sum(words not in made_by(factor, beam, theory) for factor, beam, theory, words in MADE)
    fits: Any = [
        SimpleNamespace(candidate=Candidate(model=model, mass=mass), count=count)
        for model, mass, count in (
            ("fem", "consistent", 7),
            ("analytic", None, None),
            ("fem", "hrz", 9),
            ("fem", "lumped", 8),
        )
    ]
    first = "cubic Hermite elements with consistent mass with N = 7"
    both = f"{first} or the exact beam"
    told = [first, both, f"{both} or 1 more", f"{both} or 2 more"]
    wrong += [_either(tuple(fits[:n])) for n in range(1, 5)] != told
    wrong += [_times(ratio) for ratio in (2.234, 99.4, 100.4, 1234.0)] != [
        "2.2 times",
        "99 times",
        "100 times",
        "1234 times",
    ]
    return float(wrong)


# --- Closed forms -----------------------------------------------------------------------------------------------------


def _harmonics() -> Iterator[float]:
    """Of zeros of a mean and one harmonic: how far from them it is none, or from its least where there are none."""
    from verify.waves.best_phase import FirstHarmonic

    mean, turn = np.array([0.3, -0.8, 2.0, 0.0]), np.array([0.5 * np.exp(0.7j), 1.7 * np.exp(-2j), 0.4j, 0.0])
    found = FirstHarmonic(mean, turn).zeros()
    at = mean[:, None] + (turn[:, None] * np.exp(1j * found)).real
    yield from abs(at[:2]).ravel() / 2.0
    yield from abs(at[2] - 1.6)
    yield from abs(abs(found[3]) - 0.5 * pi)
    yield float(abs(found[0, 0] - found[0, 1]) < 0.1)


def _feet() -> Iterator[float]:
    """Of the friction on a foot that all touches, within and beyond the crests' speed, by pressures and directions."""
    from verify.contact.foot import foot_force

    for load, r in ((1.7, 0.4), (1.0, -0.85), (2.9, 1.0), (2.9, 1.3), (1.2, -1.0), (1.2, -4.0)):
        psi = acos(min(max(r, -1.0), 1.0))
        driven = sin(psi) + load * psi  # of load + cos s over what runs faster, the other half line braked
        yield abs(foot_force(load, r) - (2.0 * driven / (pi * load) - 1.0))
        s = (np.arange(4000) + 0.5) * pi / 4000.0
        yield largest(
            abs(float((load + np.cos(s)) @ np.sign(np.cos(s) - r)) / load / 4000.0 - foot_force(load, r)) - 1e-3, 0.0
        )


def _shapes() -> Iterator[float]:
    """Of the distance of two shapes of a sine and its neighbour, of either sign; and of orders between two points."""
    from verify.judge.compare import shape_error
    from verify.judge.crossing import Point, observed

    x = np.linspace(0.0, pi, 41)
    weights = np.full(41, pi / 40.0)
    weights[[0, -1]] *= 0.5
    one, other = np.sin(2.0 * x), np.sin(3.0 * x)
    for share, size in ((0.03, 1.0), (0.2, 0.9)):
        for sign in (1.0, -1.0):
            off = shape_error(one, sign * (size * one + share * other), weights)
            yield abs(off / float(np.hypot(share, 1.0 - size)) - 1.0)
    for low, high, floor, order in ((0.2, 0.05, 0.01, 2.0), (0.05, 0.2, 0.01, -2.0), (-0.2, -0.1, 0.01, 1.0)):
        found = observed(Point(0.4, low, 1.0), Point(0.2, high, 3.0), floor)
        yield 1.0 if found is None else abs(found - order)
    for low, high in ((0.2, 0.005), (0.005, 0.2), (0.2, -0.1), (0.2, 0.0)):
        yield float(observed(Point(0.4, low, 1.0), Point(0.2, high, 3.0), 0.01) is not None)


def _points() -> Iterator[float]:
    """Of an operating point, by how much it changes over half a hertz and half a degree, below a hertz half of it."""
    from verify.waves.operating_point import Landscape

    def known(frequencies: Array, phases: Array) -> tuple[Array, Array]:
        f, phase = frequencies[:, None], phases[None, :]
        return 0.02 * f**3 + 1e-5 * phase**3, 0.4 * f + 0.01 * phase**2

    here: Any = SimpleNamespace(_known=known)
    for hertz, phase, step in ((0.6, 31.0, 0.3), (7.0, -12.0, 0.5)):
        point = Landscape.point(here, hertz, phase, "here", "so")
        turned = 1e-5 * (3.0 * phase**2 + 0.25)
        yield abs(point.reflection - (0.02 * hertz**3 + 1e-5 * phase**3)) + abs(point.per_degree - turned)
        yield abs(point.crest_speed - (0.4 * hertz + 0.01 * phase**2))
        yield abs(point.per_hertz - 0.02 * (3.0 * hertz**2 + step**2))
        yield float((point.frequency_hz, point.phase_deg, point.what, point.note) != (hertz, phase, "here", "so"))


def forms_error(number: float) -> float:
    """Of harmonics' zeros, friction on feet, distances of shapes, orders and operating points, the worst."""
    return float(np.max([*_harmonics(), *_feet(), *_shapes(), *_points()]))


ROWS: tuple[Row, ...] = (
    Floor(
        id="sizes-in-turn",
        title="Which sizes are looked at first, where that ends, where neighbours point to, and the way downhill",
        why="identify/searching.py: half as large again, until three go up; by 1/N^2 between neighbours.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=sizes_error,
    ),
    Floor(
        id="rods-that-shear",
        title="Rods whose links shear, on a wall by three rules and between pins, entry by entry; what they take",
        why="identify/matrices.py: masses at the nodes, a turn and a shear of each part.",
        along="parts",
        at=(9.0,),
        promise=1e-9,
        error=shearing_error,
    ),
    Floor(
        id="factors-in-words",
        title="What alone makes one factor on all frequencies of nine beams; what else a list may be",
        why="identify/causes_told.py, told.py: EI / (rho A L^4) where that is all there is.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=words_error,
    ),
    Floor(
        id="zeros-feet-and-shapes",
        title="Zeros of a harmonic, friction on feet beyond the crests, distances of shapes, orders, how points change",
        why="waves/best_phase.py, operating_point.py, contact/foot.py, judge/compare.py, crossing.py: closed forms.",
        along="1",
        at=(1.0,),
        promise=1e-11,
        error=forms_error,
    ),
)
