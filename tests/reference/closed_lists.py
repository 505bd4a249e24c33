"""Frequencies of uniform beams by textbook formulas, as lists with few digits."""

from math import cosh, floor, log10, pi, sqrt, tanh

import numpy as np
from scipy.optimize import brentq

BETAS = [
    brentq(lambda x: np.cos(x) + 1 / cosh(x), (i - 0.5) * pi - 0.4, (i - 0.5) * pi + 0.4, xtol=1e-15)
    for i in range(1, 7)
]


def written(value, digits, how="rounded", i=0):
    """A value with so many digits: rounded, cut, or with the last off by one."""
    unit = 10.0 ** (floor(log10(value)) - digits + 1)
    whole = floor(value / unit) if how == "cut" else round(value / unit) + (how == "off") * (-1) ** i
    return float(f"{whole * unit:.{digits - 1}e}")


def euler(beam, betas=BETAS):
    return np.array(betas) ** 2 * beam.wave_constant / beam.length**2 / (2 * pi)


def pinned_timoshenko(beam, nu, kappa, n):
    """Hz of a pinned rectangle with shear (Timoshenko, Phil. Mag. 41, 1921), of other constants than the beam's."""
    k = np.arange(1, n + 1) * pi / beam.length
    a = (k * beam.thickness) ** 2 / 12
    s = a * 2 * (1 + nu) / kappa
    ratio = 2 / (1 + a + s + np.sqrt((1 + a + s) ** 2 - 4 * a * s))
    return k**2 * beam.wave_constant / (2 * pi) * np.sqrt(ratio)


def space(beam, ends=0.5):
    """(Hz, motions) of bending in both planes, torsion and extension of a rectangle, ascending."""
    b, h, c = beam.width, beam.thickness, sqrt(beam.youngs_modulus / beam.density)
    j = b * h**3 / 3 * (1 - 192 / pi**5 * h / b * sum(tanh(n * pi * b / 2 / h) / n**5 for n in (1, 3, 5, 7)))
    twist = c * sqrt(12 * j / (b * h * (b * b + h * h)) / 2 / (1 + beam.poissons_ratio))
    rows = [(f, "bending") for f in euler(beam)] + [(f * b / h, "bending, width") for f in euler(beam)]
    rows += [
        ((i - ends) * v / 2 / beam.length, name)
        for i in (1, 2, 3)
        for v, name in ((c, "extension"), (twist, "torsion"))
    ]
    return zip(*sorted(rows)[:9], strict=True)
