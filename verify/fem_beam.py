"""Hermite beam elements by scikit-fem: modes, harmonic fields, motion in time. The room is `verify.elements`."""

from verify.elements.linear import check, n_elastic, solve_harmonic, solve_modes, unit_responses, unknowns
from verify.elements.in_time import time_basis

__all__ = ["check", "n_elastic", "solve_harmonic", "solve_modes", "time_basis", "unit_responses", "unknowns"]
