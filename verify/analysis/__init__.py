"""Comparison of models: stored solutions, paired modes, errors, orders, bounds, sizes, grid convergence index."""
