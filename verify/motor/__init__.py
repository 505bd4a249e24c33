"""Characteristics of a motor: steady states, curves, periodic orbits, closed waves; feet on the nonlinear chain."""
