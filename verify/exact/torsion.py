"""Torsion of a beam: Saint-Venant's constant of its sections and the exact natural frequencies."""

from collections.abc import Iterable, Sequence
from math import atan2, cos, pi, sin, sqrt, tanh
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.cross_section import merged, set_fields


class Shaft(NamedTuple):
    """A piece of a beam in torsion. SI."""

    length: float
    stiffness: float
    """GJ, N m^2."""
    inertia: float
    """rho (I_y + I_z) per length, kg m."""


def torsion_constant(shape: str, width: float, thickness: float) -> float:
    """Saint-Venant's J, m^4, of a rectangle, or of a round section or tube of diameter `width` and wall `thickness`.

    The rectangle by its series (Timoshenko and Goodier, Theory of Elasticity, section 109).
    """
    if shape != "rectangle":
        return pi * (width**4 - (width - 2.0 * thickness) ** 4) / 32.0
    short, long = sorted((width, thickness))
    odd = range(1, 40, 2)
    series = sum(tanh(0.5 * n * pi * long / short) / n**5 for n in odd)
    return long * short**3 * (1.0 - 192.0 / pi**5 * short / long * series) / 3.0


def shafts(beam: Beam) -> list[Shaft]:
    """The pieces of a beam in torsion. Raises InputError for a section without shape, sizes or material."""
    shear, made = 2.0 * (1.0 + beam.poissons_ratio), []
    every = [merged(section, beam) for section in beam.section] or [set_fields(beam)]
    for fields, piece in zip(every, beam.pieces, strict=True):
        shape, direct = fields.get("shape", "rectangle"), {"bending_stiffness", "mass_per_length", "rotary_inertia"}
        if given := sorted(direct & set(fields)):
            raise InputError(f"beam.{given[0]}: a chain in space needs shape, sizes, E and rho in its place, give them")
        if shape == "rectangle":
            one, other = fields["width"], fields["thickness"]
            moments = one * other * (one**2 + other**2) / 12.0
        else:
            one, other = fields["diameter"], fields.get("wall_thickness", 0.5 * fields["diameter"])
            moments = torsion_constant(shape, one, other)
        stiffness = fields["youngs_modulus"] / shear * torsion_constant(shape, one, other)
        made.append(Shaft(piece.length, stiffness, fields["density"] * moments))
    return made


def torsion_hz(
    pieces: Sequence[Shaft], held: tuple[bool, bool], n_modes: int, bodies: Iterable[tuple[float, float]] = ()
) -> Array:
    """The first elastic frequencies in torsion, (n_modes,), Hz; `held`: whether each end has no rotation.

    `bodies` are (position, rotary inertia) pairs, m and kg m^2. The phase of (rotation, torque over Z omega), with
    Z^2 = GJ rho I_p, grows along the shaft and with the frequency; a mode is a whole number of quarter turns.
    """
    from scipy.optimize import brentq

    ends = np.cumsum([piece.length for piece in pieces])
    cuts = [(float(end), 0.0) for end in ends[:-1]] + [body for body in bodies if body[1]]
    stations = [*sorted(cuts), (float(ends[-1]), 0.0)]
    start = 0.0 if held[0] else 0.5 * pi

    def phase(omega: float) -> float:
        turned, at, before = start, 0.0, 0.0
        for place, inertia in stations:
            piece = pieces[min(int(np.searchsorted(ends, 0.5 * (at + place))), len(pieces) - 1)]
            impedance = sqrt(piece.stiffness * piece.inertia)
            if before and before != impedance:  # the torque is continuous, its scale is not
                turned += _turn(turned, cos(turned) * before, sin(turned) * impedance)
            turned += omega * (place - at) * sqrt(piece.inertia / piece.stiffness)
            turned += _turn(turned, cos(turned) - omega * inertia / impedance * sin(turned), sin(turned))
            at, before = place, impedance
        return turned

    first = start + (0.5 * pi if held[0] != held[1] else pi)
    found = []
    for goal in first + pi * np.arange(n_modes):
        top = 1.0
        while phase(top) < goal:
            top *= 2.0
        found.append(brentq(lambda omega, goal=goal: phase(omega) - goal, 0.0, top, xtol=1e-300, rtol=1e-14))
    return np.array(found) / (2.0 * pi)


def _turn(phase: float, torque: float, rotation: float) -> float:
    """Angle from the direction of `phase` to (torque, rotation), between -pi and pi."""
    c, s = cos(phase), sin(phase)
    return atan2(c * rotation - s * torque, c * torque + s * rotation)
