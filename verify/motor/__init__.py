"""A slider that may leave the beam: feet on springs or hard landings, and the figures of the motor that it makes.

Takes a beam under forces and a slider with `contact`; gives its run and figures of it. Knows nothing of scenes.
"""
