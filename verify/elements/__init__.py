"""Hermite and Timoshenko beam elements for scikit-fem, behind `fem_beam`; `stock` is scikit-fem's own."""
