"""Rows of the nonlinear chain."""
