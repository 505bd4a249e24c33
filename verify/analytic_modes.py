"""The exact Euler-Bernoulli beam: modes, shapes, harmonic fields, motion in time. The room is `verify.exact`."""

from verify.exact.closed_forms import frequency_hz
from verify.exact.harmonic import solve_harmonic, unit_responses
from verify.exact.in_time import time_basis
from verify.exact.modes import mode_shape, mode_shapes, modes_below, solve_modes, stepped_frequency_hz

__all__ = [
    "frequency_hz",
    "mode_shape",
    "mode_shapes",
    "modes_below",
    "solve_harmonic",
    "solve_modes",
    "stepped_frequency_hz",
    "time_basis",
    "unit_responses",
]
