"""The exact Euler-Bernoulli beam, and what is known of the discrete models without solving them.

Takes a beam, gives modes, harmonic fields and time bases in closed form. Stands behind `analytic_modes`; knows
neither elements nor segments.
"""
