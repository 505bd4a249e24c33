"""A clamp that gives: a beam with rotational springs in place of clamped ends, and what its frequencies lose by it."""

from functools import lru_cache

import msgspec
import numpy as np

from verify.attached import PointSpring
from verify.beam import Beam
from verify.identify.family import exact_hz
from verify.models.arrays import Array

SOFTEST, STIFFEST = 0.3, 1e4
"""k_r L/EI between which a clamp is looked for: softer it is a hinge, stiffer nothing of it is left in a list."""
_SOLVED, _GRID = 28, 400
"""Compliances that are solved, and those between that a spline tells: steps of equal ratio."""


class Clamp(msgspec.Struct, frozen=True, kw_only=True):
    """A rotational spring in place of a clamped end, or of both."""

    ends: tuple[str, ...]
    """left, right."""
    stiffness: float
    """k_r L/EI, by the beam's own EI."""
    rotational: float
    """k_r, N m/rad."""
    either: bool = False
    """Whether the other end of a beam that is its own mirror image would do as well."""

    @property
    def words(self) -> str:
        """What gives and how much, without a full stop."""
        one = "one of both clamped ends turns" if self.either else f"the clamped {self.ends[0]} end turns"
        which = "both clamped ends turn" if len(self.ends) > 1 else one
        return f"{which} against a spring of k_r = {self.stiffness:.4g} EI/L ({self.rotational:.6g} N m/rad)"


def clamped_ends(beam: Beam) -> tuple[tuple[str, ...], ...]:
    """Which of a beam's clamped ends may give: each, and both; of a beam that is its own mirror image left and both."""
    ends = tuple(name for name, held in zip(("left", "right"), beam.supports, strict=True) if held == "clamped")
    if len(ends) < 2:
        return (ends,) if ends else ()
    alike = beam.mirrored() == beam
    return (("left",), ends) if alike else (("left",), ("right",), ends)


def clamp_of(beam: Beam, ends: tuple[str, ...], compliance: float) -> Clamp:
    """The clamp of a compliance EI/(k_r L)."""
    stiffness = 1.0 / compliance
    rotational = stiffness * beam.bending_stiffness / beam.length
    either = len(ends) == 1 and beam.supports == ("clamped", "clamped") and beam.mirrored() == beam
    return Clamp(ends=ends, stiffness=stiffness, rotational=rotational, either=either)


def softened(beam: Beam, clamp: Clamp) -> Beam:
    """The beam with that clamp in place of its clamped ends."""
    places = {"left": 0.0, "right": beam.length}
    left, right = ("pinned" if name in clamp.ends else held for name, held in zip(places, beam.supports, strict=True))
    springs = tuple(PointSpring(position=places[name], rotational=clamp.rotational) for name in clamp.ends)
    return msgspec.structs.replace(beam, supports=(left, right), spring=(*beam.spring, *springs))


class Loss(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What the exact frequencies lose by a clamp that gives."""

    compliances: Array
    """(k,), EI/(k_r L), rising by equal ratios."""
    logs: Array
    """(k, n_modes), log of the softened beam's frequencies over the clamped one's."""


@lru_cache(maxsize=16)
def loss_of(beam: Beam, ends: tuple[str, ...], n_modes: int) -> Loss:
    """Of clamps of all compliances. Raises InputError where the exact frequencies are not known."""
    from scipy.interpolate import CubicSpline

    solved = np.geomspace(1.0 / STIFFEST, 1.0 / SOFTEST, _SOLVED)
    held = exact_hz(beam, n_modes)
    logs = np.log(np.array([exact_hz(softened(beam, clamp_of(beam, ends, float(c))), n_modes) for c in solved]) / held)
    between = np.geomspace(solved[0], solved[-1], _GRID)
    return Loss(compliances=between, logs=np.asarray(CubicSpline(np.log(solved), logs)(np.log(between))))
