"""A scene that takes no time: one gate, and a spectrum where it is drawn."""

STRIP = """
name = "strip"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
[[gate]]
id = "second"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
expect = 49.90041
within = 1e-3
why = "2 pi sqrt(E h^2 / 12 rho) / L^2."
"""
DRAWN = "spectrum = { modes = 3, count = 9 }\n" + STRIP
