"""The exact beam by three theories, and what is known of the discrete models without solving them.

Takes a beam, gives modes, shapes, harmonic fields, buckling loads and time bases: in closed form where there is one,
else by one characteristic equation with counting. Stands behind `analytic_modes`; knows neither elements nor segments.
"""
