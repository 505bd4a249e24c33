"""Hermite and Timoshenko beam elements by scikit-fem: modes, harmonic fields, motion in time.

Takes a beam with all that stands on it, a theory and a number of elements. Stands behind `fem_beam`; knows neither
segments nor the exact beam. `element` and `shear` are what scikit-fem is given and import it; `cuts` says where nodes
lie, `mesh` asks scikit-fem, `curvatures` and `added` are what strains, `pencil` factors K, `linear` and `in_time`
answer in metres and hertz; `stock` is scikit-fem with nothing of ours, a subject to compare with.
"""
