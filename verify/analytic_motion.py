"""The first exact modes for motion in time: what is cut off is said."""

import numpy as np

from verify.analytic_modes import mode_shape, solve_modes
from verify.beam import Beam
from verify.closed_forms import check_uniform
from verify.errors import InputError
from verify.time_basis import Array, TimeBasis, check_held

DEGREE = 8
"""Of the Taylor pieces: the fastest mode is followed to 1e-9, the others far closer."""


def time_basis(beam: Beam, n_modes: int) -> TimeBasis:
    """The first n_modes exact modes. Raises InputError for stepped beams, rigid motions and n_modes < 1."""
    check_uniform(beam)
    check_held(beam)
    if n_modes < 1:
        raise InputError(f"n_modes = {n_modes!r}: ask for at least one mode")
    modes = solve_modes(beam, n_modes)
    omegas = 2.0 * np.pi * modes.frequencies_hz
    fourth = omegas**2 / beam.wave_constant**2  # beta^4

    def shapes(x: Array, derivative: int) -> Array:
        turns, rest = divmod(derivative, 4)
        values = np.array([mode_shape(beam, n, x, rest) for n in range(1, n_modes + 1)])
        return values * fourth[:, None] ** turns

    cells = int(np.ceil(beam.length * float(fourth[-1]) ** 0.25 / 0.4)) + 1
    return TimeBasis(model="analytic", count=None, beam=beam, omegas=omegas, shapes=shapes,
                     loads=lambda position: shapes(np.array([position]), 0)[:, 0],
                     edges=np.linspace(0.0, beam.length, cells + 1), degree=DEGREE,
                     method=f"the first {n_modes} exact modes")  # fmt: skip
