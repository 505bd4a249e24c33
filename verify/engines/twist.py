"""Torsion of a chain in a file: the rule of its joints, the shaft that they mean, what is wrong, correct joints."""

from math import pi

import numpy as np

from verify.arrays import Array
from verify.engines.line import Line
from verify.engines.rules import Judged, rigid
from verify.engines.stiffness_law import ALIKE
from verify.errors import InputError
from verify.exact.torsion import shafts
from verify.problem.beam import Beam

UNEVEN = 0.01
"""Relative difference of polar inertias per length from which they are not those of one shaft."""


def judge_twist(line: Line, beam: Beam | None) -> Judged | None:
    """The joints in torsion, by GJ and polar inertia of `beam` or, without, of the round shaft that the file means.

    None where the joint at the wall is free, for ball joints, polar inertias of no section, a file that no uniform
    shaft explains, and a beam without sections.
    """
    (lengths, masses, _, inertias), k = line.links.T, line.springs
    held, half = bool(np.isnan(k[0])), 0.5 * lengths

    def series(soft: Array) -> Array:
        """Compliances of joints between half links; all of a fixed link is in the joint behind."""
        both = soft + np.append(0.0, soft[:-1])
        if held:
            both[:2] = np.nan, both[1] + soft[0]
        return np.asarray(both)

    whole, length, spin = k * series(half), float(lengths.sum()), float(np.median(inertias / lengths))
    uneven = np.ptp(whole[1:]) > ALIKE * whole[1:].min() or np.ptp(inertias / lengths) > UNEVEN * spin
    if not line.solid or line.ball or k[0] == 0.0 or not (k[1:] > 0.0).all() or (uneven and not beam):
        return None
    twist, density = float(np.median(whole[1:])), float(np.median(masses / lengths))
    if beam is None:  # of this mass and polar inertia, with E = 2 G
        diameter, density = (8.0 * spin / density) ** 0.5, density**2 / (2.0 * pi * spin)
        sizes = {"shape": "round", "diameter": diameter, "supports": ("clamped", "free"), "poissons_ratio": 0.0}
        beam = Beam(length=length, youngs_modulus=64.0 * twist / (pi * diameter**4), density=density, **sizes)
    try:
        pieces, stiffness, inertia = shafts(beam).T
    except InputError:
        return None
    at = np.searchsorted(np.cumsum(pieces)[:-1], np.cumsum(lengths) - half)
    springs = 1.0 / series(half / stiffness[at])
    wall, inner = k[0] / springs[0], float(np.median((k / springs)[1:]))
    mass = float(np.median(inertias / lengths / inertia[at]))
    rule = "first link fixed" if held else f"{2.0 * wall / inner:.4g} GJ/l at the wall"
    faults = [f"{rule} in place of 2 GJ/l"] * bool(held or abs(wall / inner - 1.0) > ALIKE)
    faults += [f"torsional stiffness {inner:.5g} times that of the beam"] * bool(abs(inner - 1.0) > ALIKE)
    links = [f"polar inertia {mass:.4g} times that of the beam"] * bool(abs(mass - 1.0) > UNEVEN)
    present, correct = (rigid(line, each, beam, "") for each in (k, springs))
    return Judged(line, present, correct, rule, twist, springs, faults + links, links, [], {}, f"= {twist:.6g} N m2")
