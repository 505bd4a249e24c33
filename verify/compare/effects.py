"""Causes with one parameter: a compliant clamp, a tip mass, another shear stiffness or axial force; their effects."""

from functools import lru_cache

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, Indices
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointMass, PointSpring

CAUSES = {
    "clamp": (0.3, 1e4, 28, "euler-bernoulli"),
    "tip": (1e-4, 30.0, 28, "euler-bernoulli"),
    "tension": (0.01, 10.0, 28, "euler-bernoulli"),
    "shear": (0.4, 2.5, 9, "timoshenko"),
}
"""Least and largest parameter, number of solved ones, theory. k_r L/EI: softer equals a hinge, stiffer a clamp, within
the digits of a list; mass over rho A L; axial force and kappa G over those of the scene."""
_GRID = 400  # parameters of an interpolated effect: steps of 3 % or less, refined by least squares


def varied(beam: Beam, cause: str, ends: tuple[str, ...], parameter: float) -> Beam:
    """The beam with hinges and springs k_r = `parameter` EI/L at `ends`, masses there, or another kappa G or force."""
    places = {"left": 0.0, "right": beam.length}
    if cause == "tension":
        return replace(beam, tension=parameter * beam.tension)
    if cause == "tip":
        mass = parameter * sum(piece.mass_per_length * piece.length for piece in beam.pieces)
        return replace(beam, mass=(*beam.mass, *(PointMass(position=places[end], mass=mass) for end in ends)))
    if cause == "shear":
        sizes = [(piece.shear_stiffness or 0.0) * parameter for piece in (beam.base_section, *beam.pieces)]
        sections = zip(beam.section, sizes[1:], strict=False)
        sheared = tuple(replace(section, shear_stiffness=size) for section, size in sections)
        return replace(beam, shear_stiffness=sizes[0], section=sheared)
    rotational = parameter * beam.bending_stiffness / beam.length
    left, right = ("pinned" if name in ends else held for name, held in zip(places, beam.supports, strict=True))
    springs = tuple(PointSpring(position=places[name], rotational=rotational) for name in ends)
    return replace(beam, supports=(left, right), spring=(*beam.spring, *springs))


@lru_cache(maxsize=64)
def effect_of(beam: Beam, cause: str, ends: tuple[str, ...], n_modes: int) -> tuple[Array, Array]:
    """(parameters (k,), log of exact varied over exact frequencies (k, n_modes)). Raises InputError."""
    from scipy.interpolate import CubicSpline

    least, most, size, theory = CAUSES[cause]
    exact, known, hertz = Candidate(model=EXACT, theory=theory), [], []
    for parameter in np.geomspace(least, most, size).tolist():
        try:
            hertz.append(frequencies_hz(exact, varied(beam, cause, ends, parameter), None, n_modes))
        except InputError:  # a compression beyond buckling
            continue
        known.append(parameter)
    if len(known) < 2:
        raise InputError(f"beam: no {cause} can be varied, choose another")
    grid, logs = np.geomspace(known[0], known[-1], _GRID), np.log(np.array(hertz))
    logs -= np.log(frequencies_hz(exact, beam, None, n_modes))
    return grid, np.asarray(CubicSpline(np.log(known), logs)(np.log(grid)))


def fit_parameter(
    beam: Beam,
    cause: tuple[str, tuple[str, ...]],
    start: float,
    candidate: Candidate,
    count: int | None,
    logs: Array,
    modes: Indices,
) -> tuple[float, Array]:
    """(least-squares parameter, log of the list over the varied candidate, (k,)). Raises InputError.

    `cause`: its name and ends. `logs` (k,) are those of the list, `modes` (k,) its modes from 0, `start` a parameter
    near the optimum.
    """
    from scipy.optimize import least_squares

    least, most = CAUSES[cause[0]][:2]

    def left(log_parameter: Array) -> Array:
        parameter = float(np.clip(np.exp(log_parameter[0]), least, most))
        hertz = frequencies_hz(candidate, varied(beam, *cause, parameter), count, int(modes.max()) + 1)
        if len(hertz) <= modes.max():
            raise InputError(f"count = {count}: the model has {len(hertz)} modes, raise count")
        return np.asarray(logs - np.log(hertz[modes]))

    solution = least_squares(left, [np.log(start)], diff_step=1e-4, xtol=1e-9)
    return float(np.clip(np.exp(solution.x[0]), least, most)), np.asarray(solution.fun)
