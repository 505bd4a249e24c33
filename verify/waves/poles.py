"""A beam at a resonance that it has alone, and has not with what stands on it or holds it.

All answers of the bare beam have a pole there: on it there are none, beside it they are large and differences of them
lose digits. Held at one more place, a, the beam has no resonance there. With u_L its answer to load L and u_a that to
a unit force at a,

    u_L - u_a u_L(a) / u_a(a),  u_a / u_a(a);  -u_L(a) / u_a(a),  1 / u_a(a)

are its answers with a at rest and to a unit displacement of a, and the force that each takes at a. All are smooth, and
are taken from four frequencies around, as a cubic. With the next pole R steps away that is wrong by 4/R^4, and the
third difference of the four is 12/R^3 of it, or far more where a pole lies among them: it has to be small. The
resonance is left to one condition, that no force acts at a. It is solved at the frequency itself, with those of devices
or of imposed displacements, so that the pole of the whole may lie as near as it likes.
"""

from collections.abc import Callable, Sequence
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import ResonanceError
from verify.linear.fields import RESONANCE, HarmonicField, combined, unit_response
from verify.problem.beam import Beam, PointForce

STEP = 1e-5
"""Relative distance of the frequencies that an interpolation or a derivative takes."""
AROUND = ((-2.0, -1.0 / 6.0), (-1.0, 4.0 / 6.0), (1.0, 4.0 / 6.0), (2.0, -1.0 / 6.0))
"""(steps, weight): exact for cubics."""
_STILL = 1e-290
"""Kg/s^2: what moves a beam whole so slowly that it takes no force."""
_NEAR = 1e5
"""Unit responses beyond which a bare beam's answers are read apart: a resonance lies within about STEP / 10."""
_THIRD = (-1.0, 2.0, -2.0, 1.0)
_ROUGH = 1e-7
"""Third difference from which on answers are not smooth: the cubic is wrong by 1e-10 there."""
_DAMPED = 1e-12
"""Damping ratio below which the whole counts as undamped: what it lets pass is good to a thousandth and better."""
_LOOKED_AT = np.array([0.137, 0.382, 0.724])
"""Parts of the length at which an answer's size is told, and at which a place that moves is first looked for."""
_GRID = np.linspace(0.0, 1.0, 97)


class UnsettledError(ResonanceError):
    """So near to a resonance of the bare beam lies another that one more held place does not take both away."""


class Conditions(msgspec.Struct, frozen=True, eq=False):
    """What holds at n places: give times the force there and take times the deflection there are right."""

    give: ComplexArray
    """(n,)."""
    take: ComplexArray
    """(n,), N/m where `give` is a number."""
    right: ComplexArray
    """(n, k)."""


class Shares(msgspec.Struct, frozen=True, eq=False):
    """What the bare beam's answers around a frequency add up to."""

    of_answers: ComplexArray
    """(4, n_known + n + 1, k): of the known loads, unit forces at the places and one at a."""
    forces: ComplexArray
    """At the n places, (n, k), newton."""


Check = Callable[[Beam, complex, bool], None]
"""Raises what is to be said of a resonance of the whole, by its relative distance (its imaginary part is a damping
ratio), and of conditions that are none at other frequencies either."""


def looked_at(places: Array, beam: Beam) -> Array:
    """Where answers are read: at the places, then where their size is told."""
    return np.append(places, _LOOKED_AT * beam.length)


def is_near(
    answers: Sequence[ComplexArray], newtons: Sequence[float], unit: float, beam: Beam, frequency_hz: float
) -> bool:
    """Whether answers to loads of so many newtons each, (m,) of each, tell of a resonance next to the frequency.

    `unit` is the beam's `unit_response`.
    """
    large = large_responses(beam, unit, frequency_hz)
    return any(bool(abs(one).max() > large * newton) for one, newton in zip(answers, newtons, strict=True))


def large_responses(beam: Beam, units: Any, frequencies_hz: Any) -> Any:
    """What no answer to a unit force exceeds away from resonances, m/N: many of those that bend it or move it whole."""
    whole = beam.mass_per_length * beam.length * (2.0 * np.pi * frequencies_hz) ** 2
    return _NEAR * (units + 1.0 / np.maximum(whole, _STILL))


def is_resonant(beam: Beam, distance: complex) -> bool:
    """Whether an undamped whole is driven on its resonance, so far away (relative)."""
    return not beam.loss_factor and abs(distance) < RESONANCE and abs(distance.imag) < _DAMPED


def around(frequency_hz: float) -> Array:
    """The frequencies that are taken, (4,)."""
    return frequency_hz * (1.0 + STEP * np.array([steps for steps, _ in AROUND]))


def place_that_moves(answers: Callable[[Array, Array], ComplexArray], beam: Beam) -> float:
    """Where the beam moves most next to a resonance; `answers` is (places of unit forces, x) -> (len(places), len(x)).

    Wherever the search begins, the second force acts where the resonance is felt.
    """
    grid, places = _GRID * beam.length, _LOOKED_AT * beam.length
    for _ in range(2):
        places = grid[[int(np.argmax(abs(answers(places, grid)).max(axis=0)))]]
    return float(places[0])


def shares(
    answers: ComplexArray,
    conditions: Callable[[float], Conditions],
    beam: Beam,
    frequency_hz: float,
    check: Check,
) -> Shares:
    """What four frequencies' answers (4, n_known + n + 1, n + m + 1) add up to, known loads taken once.

    Rows: known loads, unit forces at the n places, one at a. Columns: at the places, anywhere, at a. `conditions` are
    those at a frequency. Raises UnsettledError where the held beam's answers are not smooth, and what `check` does.
    """
    unit, here = unit_response(beam, frequency_hz), conditions(frequency_hz)
    each = _held(answers / unit)
    smooth = np.tensordot([weight for _, weight in AROUND], each, 1)
    if not abs(np.tensordot(_THIRD, each, 1)).max() <= _ROUGH * abs(smooth).max():
        raise UnsettledError(
            f"frequency_hz = {frequency_hz!r} lies between several resonances of the beam: give it a loss_factor or "
            "choose another frequency"
        )
    scale = 1.0 / (abs(here.give) + unit * abs(here.take))
    sides = [_system(each[i], conditions(float(around(frequency_hz)[i])), unit, scale) for i in (1, 2)]
    matrix = _system(smooth, here, unit, scale)
    check(beam, _distance(matrix, sides), all(_singular(side) for side in sides))
    n, n_known = len(scale), len(smooth) - len(scale) - 1
    known = smooth[:n_known].sum(axis=0)
    right = scale[:, None] * (here.right - unit * (here.take * known[:n])[:, None])
    right = np.vstack([right, np.full((1, right.shape[1]), -known[-1])])
    found = np.asarray(np.linalg.solve(matrix, right), dtype=complex)
    every = np.vstack([np.ones((n_known, found.shape[1])), found])
    at_rest = np.broadcast_to(every[:-1], (4, *every[:-1].shape))
    taken = np.swapaxes(each[:, :, -1:], 1, 2) @ every  # the force that keeps a where it is, at each frequency
    weights = np.array([weight for _, weight in AROUND])[:, None, None]
    return Shares(of_answers=weights * np.concatenate([at_rest, taken], axis=1), forces=found[:n])


def _distance(matrix: ComplexArray, sides: Sequence[ComplexArray]) -> complex:
    """From a frequency to the zero of a determinant, by those one STEP below and above: relative."""
    own, below, above = (complex(np.linalg.det(each)) for each in (matrix, *sides))
    return -2.0 * STEP * own / (above - below) if above != below else complex(1.0)


def _singular(matrix: ComplexArray) -> bool:
    return bool(np.linalg.svd(matrix, compute_uv=False)[-1] < 1e-12 * max(1.0, float(abs(matrix).max())))


def _held(answers: ComplexArray) -> ComplexArray:
    """Answers of the beam with its last place at rest, then to a displacement of it; the last column its force."""
    own = answers[..., -1:, -1:]
    shape = answers[..., -1:, :] / own
    rest = answers[..., :-1, :] - answers[..., :-1, -1:] * shape
    rest[..., -1:] = -answers[..., :-1, -1:] / own
    shape[..., -1:] = 1.0 / own
    return np.concatenate([rest, shape], axis=-2)


def _system(held: ComplexArray, at: Conditions, unit: float, scale: Array) -> ComplexArray:
    """The conditions on the forces at n places and on the deflection of a, in unit responses, (n + 1, n + 1)."""
    n = len(scale)
    unknown = held[len(held) - n - 1 :]
    rows = scale[:, None] * (unit * at.take[:, None] * unknown[:, :n].T + np.eye(n, n + 1) * at.give[:, None])
    return np.vstack([rows, unknown[None, :, -1]])


def field_at_pole(
    solve: Callable[[Sequence[PointForce], float], HarmonicField],
    loads: Sequence[Sequence[PointForce]],
    conditions: Callable[[float], Conditions],
    frequency_hz: float,
    check: Check,
) -> tuple[HarmonicField, ComplexArray]:
    """(The field of loads, of which the last are unit forces with conditions on each, these forces, (n,), newton).

    `solve` is (forces, hertz) -> the bare beam's field. Raises UnsettledError and what `check` does.
    """
    frequencies = around(frequency_hz).tolist()

    def read(places: Array, x: Array) -> ComplexArray:
        return np.array([solve([PointForce(position=at)], frequencies[2]).shapes(x, 0) for at in places.tolist()])

    try:
        beam = solve(loads[0], frequencies[2]).beam
        a = place_that_moves(read, beam)
        fields = [[solve(load, f) for load in (*loads, [PointForce(position=a)])] for f in frequencies]
    except ResonanceError as error:
        raise UnsettledError(str(error)) from None
    n = len(conditions(frequency_hz).give)
    places = [load[0].position for load in loads[len(loads) - n :]]
    x = np.concatenate([places, _GRID * beam.length, [a]])
    answers = np.array([[field.shapes(x, 0) for field in row] for row in fields])
    found = shares(answers, conditions, beam, frequency_hz, check)
    parts = zip(found.of_answers[:, :, 0].ravel().tolist(), [field for row in fields for field in row], strict=True)
    return replace(combined(list(parts)), frequency_hz=frequency_hz), found.forces[:, 0]
