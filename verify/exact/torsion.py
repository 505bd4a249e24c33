"""Torsion of a beam: Saint-Venant's constant of its sections and the exact natural frequencies."""

from collections.abc import Iterable
from math import atan2, cos, pi, sin, sqrt, tanh

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.cross_section import SIZES, merged, set_fields


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


def shafts(beam: Beam) -> Array:
    """Length (m), GJ (N m^2) and rho (I_y + I_z) (kg m) of every piece, (pieces, 3).

    Raises InputError for a section that is not defined by shape and material.
    """
    made = []
    every = [merged(section, beam) for section in beam.section] or [set_fields(beam)]
    for fields, piece in zip(every, beam.pieces, strict=True):
        if unsuitable := {"bending_stiffness", "mass_per_length", "rotary_inertia"} & set(fields):
            raise InputError(
                f"beam.{min(unsuitable)}: a chain in space needs shape, sizes, E and rho in its place, give them"
            )
        shape = fields.get("shape", "rectangle")
        sizes = [fields[name] for name in SIZES[shape]]
        width, thickness = (sizes[0], 0.5 * sizes[0]) if shape == "round" else sizes
        constant = torsion_constant(shape, width, thickness)
        polar = width * thickness * (width**2 + thickness**2) / 12.0 if shape == "rectangle" else constant
        shear = fields["youngs_modulus"] / (2.0 * (1.0 + beam.poissons_ratio))
        made.append((piece.length, shear * constant, fields["density"] * polar))
    return np.array(made)


def torsion_hz(
    pieces: Array, fixed: tuple[bool, bool], n_modes: int, bodies: Iterable[tuple[float, float]] = ()
) -> Array:
    """The first elastic frequencies of `shafts` in torsion, (n_modes,), Hz; `fixed`: whether each end has no rotation.

    `bodies` are (position, rotary inertia) pairs, m and kg m^2. The phase of (torque over Z omega, rotation), with
    Z^2 = GJ rho I_p, grows along the shaft and with the frequency; at a mode it is a whole number of quarter turns.
    """
    from scipy.optimize import brentq

    ends, start = np.cumsum(pieces[:, 0]), 0.0 if fixed[0] else 0.5 * pi
    stations = sorted([(float(end), 0.0) for end in ends] + [body for body in bodies if body[1]])

    def phase(omega: float) -> float:
        angle, at, before = start, 0.0, 0.0

        def jump(torque: float, rotation: float) -> float:
            """Angle by which the state turns to (torque, rotation)."""
            c, s = cos(angle), sin(angle)
            return atan2(c * rotation - s * torque, c * torque + s * rotation)

        for place, inertia in stations:
            _, stiffness, inertia_per_length = pieces[
                min(int(np.searchsorted(ends, 0.5 * (at + place))), len(ends) - 1)
            ]
            impedance = sqrt(stiffness * inertia_per_length)
            angle += jump(cos(angle) * (before or impedance), sin(angle) * impedance)  # the torque is continuous
            angle += omega * (place - at) * sqrt(inertia_per_length / stiffness)
            angle += jump(cos(angle) - omega * inertia / impedance * sin(angle), sin(angle))
            at, before = place, impedance
        return angle

    roots = []
    for goal in start + (0.5 * pi if fixed[0] != fixed[1] else pi) + pi * np.arange(n_modes):
        top = 1.0
        while phase(top) < goal:
            top *= 2.0
        roots.append(brentq(lambda omega, goal=goal: phase(omega) - goal, 0.0, top, xtol=1e-300, rtol=1e-14))
    return np.array(roots) / (2.0 * pi)
