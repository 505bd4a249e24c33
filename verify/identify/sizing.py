"""From how many parts on a member of the family keeps an error, and what would do with fewer."""

from functools import lru_cache

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.identify.family import CHAIN, ELEMENTS, Candidate, exact_hz, frequencies_hz
from verify.judge.sizing import enough_from
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
    better: str
    """What does with fewer, in words; empty where nothing known does."""
    better_count: int | None


def enough(beam: Beam, candidate: Candidate, mode: int, error: float) -> Enough:
    """From which size on `candidate` keeps `error` at `mode`, and from which the best of its kind does."""
    count = parts_for(beam, candidate, mode, error)
    other, words = _better(beam, candidate)
    fewer = parts_for(beam, other, mode, error) if other is not None else None
    worth = fewer is not None and (count is None or fewer < count)
    return Enough(
        mode=mode, error=error, count=count, better=words if worth else "", better_count=fewer if worth else None
    )


@lru_cache(maxsize=256)
def parts_for(beam: Beam, candidate: Candidate, mode: int, error: float) -> int | None:
    """From which size on the error is kept, by the package's own search where the model is the package's; or None."""
    try:
        if candidate.packaged and candidate.theory == "euler-bernoulli":
            return enough_from(Workbench(beam), candidate.model, mode, error, candidate.settings).count
        return _searched(beam, candidate, mode, error)
    except InputError:
        return None


def _searched(beam: Beam, candidate: Candidate, mode: int, error: float) -> int | None:
    """Sizes 15 % apart until five in a row do, and between the last that fails and the next. Raises InputError."""
    exact = float(exact_hz(beam, mode, candidate.theory)[-1])

    def reached(count: int) -> bool:
        found = frequencies_hz(candidate, beam, count, mode)
        return len(found) == mode and bool(np.isfinite(found[-1])) and abs(float(found[-1]) / exact - 1.0) <= error

    size = max(mode, len(beam.pieces), 2)
    low, does = size - 1, list[int]()
    while len(does) < _IN_A_ROW:
        if reached(size):
            does.append(size)
        else:
            low, does = size, []
        size = max(size + 1, round(_STEP * size))
        if size > _MOST and not does:
            return None
    high = does[0]
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


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
