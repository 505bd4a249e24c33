"""Finite segments: rigid links and joint springs about the straight chain. The room is `verify.segments`."""

from verify.options import JOINTS, LOADS, READINGS, WALLS
from verify.segments.in_time import time_basis
from verify.segments.linear import check, n_elastic, solve_harmonic, solve_modes, unit_responses, unknowns

__all__ = [
    "JOINTS",
    "LOADS",
    "READINGS",
    "WALLS",
    "check",
    "n_elastic",
    "solve_harmonic",
    "solve_modes",
    "time_basis",
    "unit_responses",
    "unknowns",
]
