"""The exact beam by three theories, and the error laws of the discrete models.

Layout of spans and stations, characteristic equation with counting, multiple-shooting fields and shapes, closed forms.
Stands behind `analytic_modes`; imports neither elements nor segments.
"""
