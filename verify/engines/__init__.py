"""Adapters of other multibody engines for the same chain; an engine is imported on first use."""
