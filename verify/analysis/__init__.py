"""Judgement: models solved once for all who ask, modes paired, errors, orders, bounds, sizes, eigenvalues counted.

Takes results of the models, gives figures. Quantities and studies call it; it draws and prints nothing.
"""
