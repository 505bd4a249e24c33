"""How many runs the study of a slider takes."""

ROUNDS = 7
"""In which models and sizes take turns for their run times."""
DRIFTS, EXACT = 2, 2
"""Runs on the steady wave, both ways; and of the exact beam that errors are relative to, at the step and at half."""
