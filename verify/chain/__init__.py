"""The nonlinear chain of rigid links: equilibria, exact linearisation, motion in time, sliders and feet on it.

Takes a described system, gives states, modes and motions. Quantities and studies call it.
"""
