"""What the entries of a list are: their unit, rigid-body motions, and the motion of each in a model in space.

Families: bending across thickness and width, torsion, extension. A list is in the unit declared unless its values fit
the beam in another.
"""

from itertools import product
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.reading import UNITS, FrequencyList
from verify.errors import InputError
from verify.exact.closed_forms import rod_frequency_hz
from verify.problem.beam import Beam, in_plane
from verify.settings import THEORIES

RIGID = 3e-3
"""Fraction of the next frequency below which leading ones are rigid-body motions, unless the beam has such a gap."""
LOOSE, CLOSE, BAND = 0.25, 0.05, 0.03
"""Largest log differences from the exact beam: of all modes, of the lower half in another unit, of motions in space."""
MOST_IN_SPACE, FEWEST_SCALED = 100, 5
"""Numbers of entries that are sorted by their motion: largest, and least with a common factor."""
EQUAL = 1e-4
"""Relative difference of a pair of frequencies, as meshes of solid elements have it."""
SAME = 4
"""Number of equal frequencies that no beam has: two planes and torsion may coincide."""
BENDING, ACROSS, ASIDE = "bending", "bending, width", "unknown"
NEAR, SKIPPED = 5e-3, 8
"""Largest log difference of the lowest entry of a list with gaps: other supports differ by more. Most modes missing."""
OUTLIER, LEAST_OFF, SHARE = 5.0, 3e-3, 0.25
"""Error of a mode without its pair over the largest of those below it, and least error, with which an entry is no such
mode: from mode 4 on that of elements of order 4 grows by a factor of 3. Distance from the common error, over that as
a bending mode, with which it is another motion."""


class Sorted(msgspec.Struct, frozen=True, eq=False):
    """Elastic entries of a list, (k,) from 0, in the unit of its values, after the `rigid` leading ones.

    `motions` (k,), their `modes` (k,) from 0 and exact frequencies (k,), Hz; MAC (k,) of entries known by shape.
    """

    listed: FrequencyList
    rigid: int
    entries: Indices
    motions: tuple[str, ...]
    modes: Indices
    exact: Array
    macs: Array | None = None
    aside: tuple[int, ...] = ()
    """Entries from 0 that are none of the known motions."""

    @property
    def unknown(self) -> list[str]:
        """Entries of no known motion in words."""
        return [f"entry {i + 1}, {self.listed.hertz[i]:.7g} Hz" for i in self.aside]

    @property
    def gaps(self) -> tuple[int, ...]:
        """Modes from 1 that the list leaves out below its last, where it neither numbers its entries nor has shapes."""
        known = set(self.modes.tolist()) if self.macs is None and self.listed.numbers is None else None
        return () if known is None else tuple(mode + 1 for mode in range(max(known)) if mode not in known)


def rigid_of(beam: Beam, hertz: Array) -> int:
    """Number of leading entries that are rigid-body motions."""
    exact = frequencies_hz(Candidate(model=EXACT), beam, None, min(len(hertz), 7))
    for k in range(min(len(hertz), 7) - 1, 0, -1):
        gap = min(4.0 * exact[k - 1] / exact[k], 1.0)
        if hertz[:k].max() == 0.0 or hertz[:k].max() < RIGID * gap * hertz[k]:
            return k
    return 0


def sort_list(beam: Beam, listed: FrequencyList, theory: str) -> Sorted:
    """The elastic entries by their order, as bending modes or motions in space; exact frequencies by the theory.

    Raises InputError for frequencies that do not ascend and for a list without an elastic one.
    """
    tried: list[tuple[FrequencyList, int]] = []
    for unit in dict.fromkeys((listed.unit, *UNITS)):
        one = msgspec.structs.replace(listed, unit=unit)
        rigid = rigid_of(beam, one.hertz) if np.isfinite(one.hertz).all() else 0
        elastic = one.hertz[rigid:]  # those of rigid-body motions are rounding errors in any order
        if np.isfinite(elastic).all() and elastic.all() and (np.diff(elastic) >= 0.0).all():
            tried.append((one, rigid))
    same = np.lib.stride_tricks.sliding_window_view(listed.values, min(SAME, len(listed.values)))
    if len(listed.values) >= SAME and (np.ptp(same, axis=1) == 0.0)[same[:, 0] > 0.0].any():
        raise InputError(f"{listed.source} has {SAME} equal frequencies or more: no beam has, give different modes")
    numbers = np.array(listed.numbers or range(1, len(listed.values) + 1))
    known = all(piece.shear_stiffness and piece.rotary_inertia for piece in beam.pieces) and not beam.tension
    theories = THEORIES if known else (EULER,)
    solved = [frequencies_hz(Candidate(model=EXACT, theory=t), beam, None, int(numbers.max())) for t in theories]
    exact = frequencies_hz(Candidate(model=EXACT, theory=theory), beam, None, int(numbers.max()))

    def by_order(one: FrequencyList, rigid: int) -> Sorted:
        modes = (numbers - 1 - rigid if numbers[0] == 1 else numbers - 1)[rigid:]
        return Sorted(one, rigid, np.arange(rigid, len(numbers)), (BENDING,) * len(modes), modes, exact[modes])

    for one, rigid in tried:
        plane, logs = by_order(one, rigid), np.log(one.hertz[rigid:])
        low, high = (np.log(bound(solved, axis=0))[plane.modes] for bound in (np.min, np.max))
        off = np.maximum(np.maximum(low - logs, logs - high), 0.0)
        if off.max() < LOOSE and (one.unit == listed.unit or off[: (len(off) + 1) // 2].max() < CLOSE):
            return plane
    planes = {BENDING: beam, ACROSS: in_plane(beam, "width")}
    lowest = min(frequencies_hz(Candidate(model=EXACT), plane, None, 1)[0] for plane in planes.values())
    for scaled, (one, rigid) in product((False, True), tried if len(numbers) <= MOST_IN_SPACE else ()):
        elastic = one.hertz[rigid:]  # first as they are, then with a common factor, for example of another modulus
        factor = elastic[0] / lowest if scaled else 1.0
        if abs(np.log(factor)) > LOOSE or (scaled and len(elastic) < FEWEST_SCALED):
            continue
        if motions := _motions(beam, planes, elastic / factor, factor, theories):
            names, modes, values = motions
            there = np.array([name != ASIDE for name in names])
            entries, values = np.arange(rigid, len(numbers)), values[there, theories.index(theory)]
            names, aside = tuple(name for name in names if name != ASIDE), tuple(entries[~there].tolist())
            return Sorted(one, rigid, entries[there], names, modes[there], values, aside=aside)
    for one, rigid in tried if listed.numbers is None else ():
        logs = np.log(one.hertz[rigid:])
        found = _gaps(beam, logs, theories)
        if found is not None and (one.unit == listed.unit or len(logs) > FEWEST_SCALED):
            exact = frequencies_hz(Candidate(model=EXACT, theory=theory), beam, None, int(found[-1]) + 1)[found]
            return Sorted(one, rigid, np.arange(rigid, len(numbers)), (BENDING,) * len(found), found, exact)
    if tried and tried[0][0].unit == listed.unit:
        return by_order(*tried[0])
    if listed.hertz[rigid_of(beam, listed.hertz) :].all():
        raise InputError(f"{listed.source}: values do not ascend: sort them, or give the shapes of the modes")
    raise InputError(f"{listed.source} has zeros but no elastic mode: give elastic frequencies")


def _gaps(beam: Beam, logs: Array, theories: tuple[str, ...]) -> Indices | None:
    """Ascending modes (k,) of log frequencies (k,) of which some are missing; None unless each is within BAND."""
    n = len(logs) + SKIPPED
    if not 1 < len(logs) <= MOST_IN_SPACE:
        return None
    exact = np.log([frequencies_hz(Candidate(model=EXACT, theory=one), beam, None, n) for one in theories])[:, None]
    off = np.maximum(np.maximum(exact.min(axis=0) - logs[:, None], logs[:, None] - exact.max(axis=0)), 0.0)
    modes, least = off.argmin(axis=1), off.min(axis=1)
    fits = (np.diff(modes) > 0).all() and least.max() < (BAND if len(logs) > 2 else NEAR) and least[0] < NEAR
    return modes if fits else None


def _motions(
    beam: Beam, planes: dict[str, Beam], hertz: Array, factor: float, theories: tuple[str, ...]
) -> tuple[tuple[str, ...], Indices, Array] | None:
    """Motions, modes (n,) and exact Hz (n, theories) of elastic frequencies (n,); None if they are not in space.

    Each is within BAND of an exact one, no bending mode is missing. `hertz` are without their common factor.
    """
    from scipy.optimize import linear_sum_assignment

    top = hertz[-1] * (1.0 + BAND)
    rows: list[tuple[Any, ...]] = []
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
            if value > top * max(factor, 1.0 / factor):
                break
            rows.append((motion, mode, *[value] * len(theories)))
    spare = (len(hertz) - 1) // 4
    if len(rows) + spare < len(hertz):
        return None
    exact = np.array([row[2:] for row in rows], dtype=float)
    bends = np.array([row[0] in planes for row in rows])
    apart = np.where(bends, 0.0, -np.log(factor))  # other motions have the factor, or have it not: a wrong wall joint
    low, high = np.log(exact.min(axis=1)) + np.minimum(apart, 0.0), np.log(exact.max(axis=1)) + np.maximum(apart, 0.0)
    logs = np.log(hertz)[:, None]
    off = np.maximum(np.maximum(low - logs, logs - high), 0.0)
    # all entries are of one theory; only motions other than bending may be missing, few entries are of no motion
    barred, alone = np.zeros(off.shape, dtype=bool), np.full((len(hertz), spare), 8.0 * BAND)
    pairs = planes[BENDING] == planes[ACROSS]
    twin = np.append(np.diff(hertz) < EQUAL * hertz[1:], False)  # two equal ones are of both planes
    barred |= np.outer((twin | np.roll(twin, 1)) & pairs, ~bends)
    for _ in range(spare + 1):
        costs = [abs(logs - near) + 1e3 * ((off > BAND) | barred) + BAND * ~bends for near in np.log(exact.T)]
        tables = [np.hstack([cost, alone]) for cost in costs]
        solved = [linear_sum_assignment(table) for table in tables]
        theory = int(np.argmin([table[one].sum() for table, one in zip(tables, solved, strict=True)]))
        at = solved[theory][1]
        known = at < len(rows)
        left = np.log(hertz)[:, None] - np.log(exact[:, theory])
        wrong = _outlier(left, at, np.array([row[1] for row in rows]), bends, pairs=pairs)
        if wrong is None:
            break
        barred[wrong, bends] = True
    names = tuple(rows[i][0] if i < len(rows) else ASIDE for i in at)
    missing = np.delete(bends & (high < np.log(hertz[known].max(initial=0.0)) - BAND), at[known])
    if not known.any() or missing.any():
        return None
    far = off[np.flatnonzero(known), at[known]].max() > BAND or barred[np.flatnonzero(known), at[known]].any()
    if far or BENDING not in names or len(set(names)) < 2:
        return None
    modes = np.array([rows[i][1] if i < len(rows) else 0 for i in at])
    return names, modes, np.array([exact[i] if i < len(rows) else np.full(exact.shape[1], np.nan) for i in at])


def _outlier(left: Array, at: Indices, modes: Indices, bends: Array, *, pairs: bool) -> int | None:
    """Index of the entry that is no bending mode, by its log error `left` (entries, motions) as motion `at`.

    Where bending comes in `pairs`, a single entry leaves the trend of the errors below it; elsewhere another motion has
    the error that most of the bending modes below have.
    """
    bent = [i for i, motion in enumerate(at) if motion < len(bends) and bends[motion]]
    free = np.setdiff1d(np.flatnonzero(np.logical_not(bends)), at)
    for k, i in enumerate(bent):
        mode, below = modes[at[i]], np.array([left[j, at[j]] for j in bent[:k] if modes[at[j]] != modes[at[i]]])
        if len(below) < 3:
            continue
        single = pairs and sum(modes[at[j]] == mode for j in bent) == 1
        if single and abs(left[i, at[i]]) > max(LEAST_OFF, OUTLIER * abs(below).max()):
            return i
        off, common = left[i, at[i]], float(np.median(below))
        if abs(off - common) > BAND and (abs(left[i, free] - common) < SHARE * abs(off - common)).any():
            return i
    return None
