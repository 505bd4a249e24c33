"""Finite segments: rigid links and joint springs about the straight chain. The room is `verify.segments`."""

from verify.segments.in_time import time_basis
from verify.segments.linear import READINGS, check, n_elastic, solve_harmonic, solve_modes, unit_responses, unknowns
from verify.segments.links import JOINTS
from verify.segments.loads import LOADS
from verify.segments.walls import WALLS

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
