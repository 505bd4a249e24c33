"""A compliant clamp: a rotational spring in place of a clamped end, and its effect on the frequencies."""

from functools import lru_cache

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointSpring

STIFFNESSES = np.geomspace(0.3, 1e4, 400)
"""Range of k_r L/EI: softer equals a hinge, stiffer a clamp, within the digits of a list."""


def softened(beam: Beam, ends: tuple[str, ...], stiffness: float) -> Beam:
    """The beam with hinges and springs k_r = `stiffness` EI/L at the ends `ends`."""
    rotational = stiffness * beam.bending_stiffness / beam.length
    places = {"left": 0.0, "right": beam.length}
    left, right = ("pinned" if name in ends else held for name, held in zip(places, beam.supports, strict=True))
    springs = tuple(PointSpring(position=places[name], rotational=rotational) for name in ends)
    return msgspec.structs.replace(beam, supports=(left, right), spring=(*beam.spring, *springs))


@lru_cache(maxsize=16)
def clamp_effect(beam: Beam, ends: tuple[str, ...], n_modes: int) -> tuple[Array, Array]:
    """(k_r L/EI (k,), log of exact softened over exact clamped frequencies (k, n_modes)). Raises InputError."""
    from scipy.interpolate import CubicSpline

    exact, solved = Candidate(model=EXACT), np.geomspace(STIFFNESSES[0], STIFFNESSES[-1], 28)
    hertz = [frequencies_hz(exact, softened(beam, ends, float(k)), None, n_modes) for k in solved]
    logs = np.log(np.array(hertz) / frequencies_hz(exact, beam, None, n_modes))
    return STIFFNESSES, np.asarray(CubicSpline(np.log(solved), logs)(np.log(STIFFNESSES)))


def fit_clamp(
    beam: Beam,
    ends: tuple[str, ...],
    start: float,
    candidate: Candidate,
    count: int | None,
    logs: Array,
    modes: Indices,
) -> tuple[float, Array]:
    """(least-squares k_r L/EI, log of the list over the softened candidate, (k,)). Raises InputError.

    `logs` (k,) are those of the list, `modes` (k,) its modes from 0, `start` a stiffness near the optimum.
    """
    from scipy.optimize import least_squares

    def left(log_stiffness: Array) -> Array:
        stiffness = float(np.exp(np.clip(log_stiffness, -9.0, 18.0)[0]))
        hertz = frequencies_hz(candidate, softened(beam, ends, stiffness), count, int(modes.max()) + 1)
        if len(hertz) <= modes.max():
            raise InputError(f"count = {count}: the model has {len(hertz)} modes, raise count")
        return np.asarray(logs - np.log(hertz[modes]))

    solution = least_squares(left, [np.log(start)], diff_step=1e-4, xtol=1e-9)
    return float(np.exp(solution.x[0])), np.asarray(solution.fun)
