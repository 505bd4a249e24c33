"""What the entries of a list are: their unit, rigid-body motions, and the motion of each in a model in space.

Families: bending across thickness and width, torsion, extension. A list is in the unit declared unless its values fit
the beam in another.
"""

from itertools import product
from operator import itemgetter
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.reading import UNITS, FrequencyList
from verify.errors import InputError
from verify.exact.closed_forms import rod_frequency_hz
from verify.options import THEORIES
from verify.problem.beam import Beam

RIGID = 3e-3
"""Fraction of the next frequency below which leading ones are rigid-body motions, unless the beam has such a gap."""
LOOSE, CLOSE, BAND = 0.25, 0.05, 0.03
"""Largest log differences from the exact beam: of all modes, of the lower half in another unit, of motions in space."""
MOST_IN_SPACE = 100
"""Largest number of entries that are sorted by their motion."""
BENDING, ACROSS = "bending", "bending, width"


class Motions(msgspec.Struct, frozen=True, eq=False):
    """The motion of each elastic entry, its number from 0, (n,), and exact Hz, (n, k), of THEORIES or the first."""

    names: tuple[str, ...]
    modes: Indices
    exact: Array


def rigid_of(beam: Beam, hertz: Array) -> int:
    """Number of leading entries that are rigid-body motions."""
    exact = frequencies_hz(Candidate(model=EXACT), beam, None, min(len(hertz), 7))
    for k in range(min(len(hertz), 7) - 1, 0, -1):
        gap = min(4.0 * exact[k - 1] / exact[k], 1.0)
        if hertz[:k].max() == 0.0 or hertz[:k].max() < RIGID * gap * hertz[k]:
            return k
    return 0


def ascends(beam: Beam, hertz: Array) -> bool:
    """Whether the elastic frequencies ascend; those of rigid-body motions are rounding errors in any order."""
    return bool((np.diff(hertz[rigid_of(beam, hertz) :]) >= 0.0).all())


def sort_list(beam: Beam, listed: FrequencyList) -> tuple[FrequencyList, Motions | None]:
    """The list in the unit of its values, and its motions if they are those of a model in space, else None."""
    tried = [listed, *(msgspec.structs.replace(listed, unit=unit) for unit in UNITS if unit != listed.unit)]
    tried = [one for one in tried if np.isfinite(one.hertz).all() and ascends(beam, one.hertz)]
    numbers = np.array(listed.numbers or range(1, len(listed.values) + 1))
    top = int(numbers.max())
    exact = np.log([frequencies_hz(Candidate(model=EXACT, theory=t), beam, None, top) for t in _theories(beam)])
    for one in tried:
        rigid = rigid_of(beam, one.hertz)
        if not one.hertz[rigid:].all():
            continue
        modes = (numbers - 1 - rigid if numbers[0] == 1 else numbers - 1)[rigid:]
        logs = np.log(one.hertz[rigid:])
        off = np.maximum(np.maximum(exact.min(axis=0)[modes] - logs, logs - exact.max(axis=0)[modes]), 0.0)
        if off.max() < LOOSE and (one is listed or off[: (len(off) + 1) // 2].max() < CLOSE):
            return one, None
    for one in tried if len(listed.values) <= MOST_IN_SPACE else ():
        rigid = rigid_of(beam, one.hertz)
        if one.hertz[rigid:].all() and (motions := _motions(beam, one.hertz[rigid:])):
            return one, motions
    return listed, None


def _theories(beam: Beam) -> tuple[str, ...]:
    """Theories of the exact beam for which its properties are known."""
    known = all(piece.shear_stiffness and piece.rotary_inertia for piece in beam.pieces)
    return THEORIES if known else (EULER,)


def second_plane(beam: Beam) -> Beam:
    """The beam that bends across its width: width and thickness exchanged; other sections are alike in both planes."""
    if not (beam.width and beam.thickness):
        return beam
    turned = msgspec.structs.replace
    sections = tuple(turned(one, width=one.thickness, thickness=one.width) for one in beam.section)
    return turned(beam, width=beam.thickness, thickness=beam.width, section=sections)


def _motions(beam: Beam, hertz: Array) -> Motions | None:
    """Motions of the elastic frequencies (n,), Hz, if each is within BAND of one and no bending mode is missing."""
    from scipy.optimize import linear_sum_assignment

    planes, top = {BENDING: beam, ACROSS: second_plane(beam)}, hertz[-1] * (1.0 + BAND)
    rows: list[tuple[Any, ...]] = []
    theories = _theories(beam)
    for name, plane in planes.items():
        solved = [frequencies_hz(Candidate(model=EXACT, theory=t), plane, None, len(hertz)) for t in theories]
        rows += [(name, i, *values) for i, values in enumerate(zip(*solved, strict=True)) if values[-1] < top]
    choices = [{"clamped": (True,), "free": (False,)}.get(support, (True, False)) for support in beam.supports]
    for motion, fixed in product(("torsion", "extension"), product(*choices)):
        for mode in range(len(hertz)):
            try:
                value = rod_frequency_hz(beam, mode + 1, motion, (fixed[0], fixed[1]))
            except InputError:  # stepped, with attachments, or without shape
                break
            if value > top:
                break
            rows.append((motion, mode, *[value] * len(theories)))
    if len(rows) < len(hertz):
        return None
    exact = np.array([row[2:] for row in rows], dtype=float)
    low, high = np.log(exact.min(axis=1)), np.log(exact.max(axis=1))
    logs = np.log(hertz)[:, None]
    off = np.maximum(np.maximum(low - logs, logs - high), 0.0)
    costs = [abs(logs - near) + 1e3 * (off > BAND) for near in np.log(exact.T)]  # all entries are of one theory
    at = min(
        ((cost[pairs].sum(), *pairs) for cost in costs for pairs in [linear_sum_assignment(cost)]), key=itemgetter(0)
    )[2]
    missing = np.delete(np.array([row[0] in planes for row in rows]) & (high < np.log(hertz[-1]) - BAND), at)
    names = tuple(rows[i][0] for i in at)
    if off[np.arange(len(hertz)), at].max() > BAND or missing.any() or BENDING not in names or len(set(names)) < 2:
        return None
    return Motions(names, np.array([rows[i][1] for i in at]), exact[at])
