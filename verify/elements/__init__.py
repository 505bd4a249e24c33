"""Hermite beam elements by scikit-fem: modes, harmonic fields, motion in time.

Takes a beam and a number of elements. Stands behind `fem_beam`; knows neither segments nor the exact beam.
"""
