"""The exact beam: modes, shapes, harmonic fields, buckling, motion in time. The room is `verify.exact`."""

from verify.exact.buckling import buckling_load
from verify.exact.closed_forms import frequency_hz as closed_form
from verify.exact.harmonic import solve_harmonic, sweep_harmonic, unit_responses
from verify.exact.in_time import time_basis
from verify.exact.modes import (
    exact_frequency_hz,
    mode_shape,
    mode_shapes,
    solve_modes,
    stepped_frequency_hz,
    sweep_modes,
)
from verify.exact.roots import modes_below
from verify.linear.places import as_typed

__all__ = [
    "buckling_load",
    "exact_frequency_hz",
    "frequency_hz",
    "mode_shape",
    "mode_shapes",
    "modes_below",
    "solve_harmonic",
    "solve_modes",
    "stepped_frequency_hz",
    "sweep_harmonic",
    "sweep_modes",
    "time_basis",
    "unit_responses",
]

frequency_hz = as_typed(closed_form)
