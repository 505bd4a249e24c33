"""A compliant clamp: a rotational spring in place of a clamped end, and its effect on the frequencies."""

from functools import lru_cache

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointSpring

SOFTEST, STIFFEST = 0.3, 1e4
"""Range of k_r L/EI: softer is a hinge, stiffer changes nothing that a list shows."""
SOLVED, INTERPOLATED = 28, 400
"""Compliances."""


def clamped_ends(beam: Beam) -> tuple[tuple[str, ...], ...]:
    """Which clamped ends may be compliant: each alone and both; of a symmetric beam the left one and both."""
    ends = tuple(name for name, held in zip(("left", "right"), beam.supports, strict=True) if held == "clamped")
    if len(ends) < 2:
        return (ends,) if ends else ()
    return (("left",), ends) if beam.mirrored() == beam else (("left",), ("right",), ends)


def softened(beam: Beam, ends: tuple[str, ...], stiffness: float) -> Beam:
    """The beam on hinges with springs of k_r = `stiffness` EI/L at these ends."""
    rotational = stiffness * beam.bending_stiffness / beam.length
    places = {"left": 0.0, "right": beam.length}
    left, right = ("pinned" if name in ends else held for name, held in zip(places, beam.supports, strict=True))
    springs = tuple(PointSpring(position=places[name], rotational=rotational) for name in ends)
    return msgspec.structs.replace(beam, supports=(left, right), spring=(*beam.spring, *springs))


@lru_cache(maxsize=16)
def clamp_effect(beam: Beam, ends: tuple[str, ...], n_modes: int) -> tuple[Array, Array]:
    """(k_r L/EI (k,), log of the exact softened over the exact clamped frequencies (k, n_modes)). Raises InputError."""
    from scipy.interpolate import CubicSpline

    exact = Candidate(model=EXACT)
    solved, fine = (np.geomspace(SOFTEST, STIFFEST, n) for n in (SOLVED, INTERPOLATED))
    hertz = [frequencies_hz(exact, softened(beam, ends, float(k)), None, n_modes) for k in solved]
    logs = np.log(np.array(hertz) / frequencies_hz(exact, beam, None, n_modes))
    return fine, np.asarray(CubicSpline(np.log(solved), logs)(np.log(fine)))


def fit_clamp(
    beam: Beam,
    ends: tuple[str, ...],
    start: float,
    candidate: Candidate,
    count: int | None,
    logs: Array,
    modes: Indices,
) -> tuple[float, Array]:
    """(k_r L/EI of least squares, log of a list over the softened candidate, (k,)). Raises InputError.

    `logs` (k,) are of the list, `modes` (k,) its modes from 0, `start` the stiffness about which it is looked for.
    """
    from scipy.optimize import minimize_scalar

    def left(log_stiffness: float) -> Array:
        hertz = frequencies_hz(candidate, softened(beam, ends, float(np.exp(log_stiffness))), count, modes.max() + 1)
        return np.asarray(logs - np.log(hertz[modes])) if len(hertz) > modes.max() else np.full(len(logs), np.inf)

    around = np.log(start) + np.array([-0.5, 0.5])
    found = minimize_scalar(lambda k: float(np.sum(left(k) ** 2)), bounds=around, options={"xatol": 1e-7})
    return float(np.exp(found.x)), left(found.x)
