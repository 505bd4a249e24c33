"""Finite segments: rigid links and joint springs about the straight chain. The room is `verify.segments`."""

from verify.options import ATTACHMENTS, JOINTS, LOADS, READINGS, THEORIES, WALLS
from verify.segments.buckling import buckling_load
from verify.segments.in_time import time_basis
from verify.segments.linear import (
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
    "ATTACHMENTS",
    "JOINTS",
    "LOADS",
    "READINGS",
    "THEORIES",
    "WALLS",
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
