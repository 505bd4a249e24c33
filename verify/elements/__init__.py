"""Hermite beam elements by scikit-fem: modes, harmonic fields, motion in time.

Takes a beam and a number of elements. Stands behind `fem_beam`; knows neither segments nor the exact beam.
`element` is what scikit-fem is given and imports it; `mesh` asks it, `pencil` factors its K, `linear` and `in_time`
answer in metres and hertz; `stock` is scikit-fem with nothing of ours, a subject to compare with.
"""
