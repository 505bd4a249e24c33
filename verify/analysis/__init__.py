"""Comparison of models: solution cache, paired modes, errors, orders, bounds, sizes, grid convergence index."""
