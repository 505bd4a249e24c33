"""Hermite and Timoshenko beam elements for scikit-fem, parts of `fem_beam`; `stock` is scikit-fem's own element."""
