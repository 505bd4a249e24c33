"""From how many parts on a member of the family keeps an error, and what would do with fewer."""

from functools import lru_cache

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.identify.family import CHAIN, ELEMENTS, Candidate, exact_hz, frequencies_hz
from verify.judge.known import solved
from verify.judge.sizing import between, enough_from, walked
from verify.judge.variants import falls_within
from verify.judge.workbench import Workbench

_MOST = 1000
_STEP = 1.15
_IN_A_ROW = 5
"""Sizes that have to do, up to twice the first of them."""


class Enough(msgspec.Struct, frozen=True, kw_only=True):
    """Parts for an accuracy."""

    mode: int
    error: float
    count: int | None
    """Of the user's own kind of model; None where none is found."""
    known_by: str
    """Which larger numbers do, and how it is known; empty where none is found."""
    better: str
    """What does with fewer, in words; empty where nothing known does."""
    better_count: int | None


def enough(beam: Beam, candidate: Candidate, mode: int, error: float) -> Enough:
    """From which size on `candidate` keeps `error` at `mode`, and from which the best of its kind does."""
    own = parts_for(beam, candidate, mode, error)
    count, known_by = own or (None, "")
    other, words = _better(beam, candidate)
    found = parts_for(beam, other, mode, error) if other is not None else None
    fewer = found[0] if found is not None and (count is None or found[0] < count) else None
    return Enough(
        mode=mode,
        error=error,
        count=count,
        known_by=known_by,
        better="" if fewer is None else words,
        better_count=fewer,
    )


@lru_cache(maxsize=256)
def parts_for(beam: Beam, candidate: Candidate, mode: int, error: float) -> tuple[int, str] | None:
    """(from which size on the error is kept, how that is known); by the package's search for its models; or None."""
    try:
        if candidate.packaged and candidate.theory == "euler-bernoulli":
            found = enough_from(Workbench(beam), candidate.model, mode, error, candidate.settings)
            return found.count, found.known_by
        return _searched(beam, candidate, mode, error)
    except InputError:
        return None


def _searched(beam: Beam, candidate: Candidate, mode: int, error: float) -> tuple[int, str] | None:
    """Sizes 15 % apart until five in a row do, and between the last that fails and the next. Raises InputError.

    On a beam with steps those after the last that fails are gone through one by one, as the package's search does.
    """
    exact = float(exact_hz(beam, mode, candidate.theory)[-1])

    def reached(count: int) -> bool:
        found = frequencies_hz(candidate, beam, count, mode)
        return len(found) == mode and bool(np.isfinite(found[-1])) and abs(float(found[-1]) / exact - 1.0) <= error

    size = max(mode, len(beam.pieces), 2)
    low, does = size - 1, dict[int, bool]()
    while len(does) < _IN_A_ROW:
        if reached(size):
            does[size] = True
        else:
            low, does = size, {}
        size = max(size + 1, round(_STEP * size))
        if size > _MOST and not does:
            return None
    if falls_within(beam):
        low, does = walked(reached, low, does)
        return low + 1, solved(low + 1, does)
    high = between(reached, low, min(does))
    return high, solved(high, does)


def _better(beam: Beam, candidate: Candidate) -> tuple[Candidate | None, str]:
    """The best rule that is known of the same kind of model, and what it is called."""
    if candidate.model == ELEMENTS and candidate.mass != "consistent":
        theory = candidate.theory
        return Candidate(model=ELEMENTS, mass="consistent", theory=theory), "consistent mass"
    if candidate.model != CHAIN:
        return None, ""
    wall = "gregory" if "clamped" in beam.supports else None
    joints = "tensioned" if beam.tension else "series"
    best = Candidate(model=CHAIN, wall=wall, joints=joints, mass="links", theory=candidate.theory)
    if best == msgspec.structs.replace(candidate, order=None, shearing=False):
        return None, ""
    changes = ["Gregory's weights 3/8, 7/6, 23/24 at the wall"] * (candidate.wall != wall)
    changes += ["the links' own inertia m l^2/12"] * (candidate.mass != "links")
    changes += [{"series": "Eq. (1) in series", "tensioned": "tensioned joints"}[joints]] * (candidate.joints != joints)
    changes += ["reciprocal weights for what is fixed to it"] * (candidate.attachment is not None)
    return best, " and ".join(changes)
