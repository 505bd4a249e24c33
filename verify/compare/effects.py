"""Causes with one parameter, a compliant clamp or another shear stiffness, and their effect on the frequencies."""

from functools import lru_cache

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, Indices
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointSpring

CLAMPS, SHEARS = np.geomspace(0.3, 1e4, 400), np.geomspace(0.4, 2.5, 400)
"""k_r L/EI: softer equals a hinge, stiffer a clamp, within the digits of a list; kappa G over that of the scene."""


def varied(beam: Beam, ends: tuple[str, ...], parameter: float) -> Beam:
    """The beam with hinges and springs k_r = `parameter` EI/L at `ends`; without ends with kappa G times it."""
    if not ends:
        sizes = [(piece.shear_stiffness or 0.0) * parameter for piece in (beam.base_section, *beam.pieces)]
        sections = zip(beam.section, sizes[1:], strict=False)
        sheared = tuple(replace(section, shear_stiffness=size) for section, size in sections)
        return replace(beam, shear_stiffness=sizes[0], section=sheared)
    rotational = parameter * beam.bending_stiffness / beam.length
    places = {"left": 0.0, "right": beam.length}
    left, right = ("pinned" if name in ends else held for name, held in zip(places, beam.supports, strict=True))
    springs = tuple(PointSpring(position=places[name], rotational=rotational) for name in ends)
    return replace(beam, supports=(left, right), spring=(*beam.spring, *springs))


@lru_cache(maxsize=64)
def effect_of(beam: Beam, ends: tuple[str, ...], n_modes: int) -> tuple[Array, Array]:
    """(parameters (k,), log of exact varied over exact frequencies (k, n_modes)). Raises InputError."""
    from scipy.interpolate import CubicSpline

    grid, exact = CLAMPS if ends else SHEARS, Candidate(model=EXACT, theory="euler-bernoulli" if ends else "timoshenko")
    solved = np.geomspace(grid[0], grid[-1], 28 if ends else 9)
    hertz = [frequencies_hz(exact, varied(beam, ends, float(k)), None, n_modes) for k in solved]
    logs = np.log(np.array(hertz) / frequencies_hz(exact, beam, None, n_modes))
    return grid, np.asarray(CubicSpline(np.log(solved), logs)(np.log(grid)))


def fit_parameter(
    beam: Beam,
    ends: tuple[str, ...],
    start: float,
    candidate: Candidate,
    count: int | None,
    logs: Array,
    modes: Indices,
) -> tuple[float, Array]:
    """(least-squares parameter, log of the list over the varied candidate, (k,)). Raises InputError.

    `logs` (k,) are those of the list, `modes` (k,) its modes from 0, `start` a parameter near the optimum.
    """
    from scipy.optimize import least_squares

    grid = CLAMPS if ends else SHEARS

    def left(log_parameter: Array) -> Array:
        parameter = float(np.clip(np.exp(log_parameter[0]), grid[0], grid[-1]))
        hertz = frequencies_hz(candidate, varied(beam, ends, parameter), count, int(modes.max()) + 1)
        if len(hertz) <= modes.max():
            raise InputError(f"count = {count}: the model has {len(hertz)} modes, raise count")
        return np.asarray(logs - np.log(hertz[modes]))

    solution = least_squares(left, [np.log(start)], diff_step=1e-4, xtol=1e-9)
    return float(np.clip(np.exp(solution.x[0]), grid[0], grid[-1])), np.asarray(solution.fun)
