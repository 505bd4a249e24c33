"""A linear beam in time by exact steps, and a slider with friction on it.

Takes a beam, forces and a slider, gives a frozen motion with its ledger and its margins. Stands behind `simulate`;
the compiled loop sees `records` alone, and kernels are loaded where something steps.
"""
