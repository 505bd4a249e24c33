"""Hermite and Timoshenko elements by scikit-fem: modes, fields, motion in time. The room is `verify.elements`."""

from verify.elements.in_time import time_basis
from verify.elements.linear import (
    buckling_load,
    check,
    n_elastic,
    solve_harmonic,
    solve_modes,
    sweep_harmonic,
    sweep_modes,
    unit_responses,
    unknowns,
)

__all__ = [
    "buckling_load",
    "check",
    "n_elastic",
    "solve_harmonic",
    "solve_modes",
    "sweep_harmonic",
    "sweep_modes",
    "time_basis",
    "unit_responses",
    "unknowns",
]
