"""Unsymmetric beams that several tests share: all pairs of ends, all attachments."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import Beam, Device, ExactModel, HermiteModel, PointForce, PointMass, PointSpring, Section, SegmentModel

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
STRIP_TOML = """
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
"""
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
BAR = Beam(length=0.41, width=0.03, thickness=0.037, youngs_modulus=206e9, density=7850.0, poissons_ratio=0.29)
ENDS = ("pinned", "clamped", "free", "guided")
PAIRS = [(left, right) for left in ENDS for right in ENDS]
SECTIONS = (
    Section(length=0.31, thickness=0.0023),
    Section(length=0.17, thickness=0.0035, width=0.027),
    Section(length=0.25, thickness=0.0029, youngs_modulus=71e9, density=2710.0),
)
MASSES = (PointMass(position=0.47, mass=0.041, rotary_inertia=3.1e-5), PointMass(position=0.66, mass=0.012))
SPRINGS = (PointSpring(position=0.29, stiffness=810.0), PointSpring(position=0.61, stiffness=95.0, rotational=0.7))
HELD = replace(STRIP, supports=("clamped", "pinned"))
ARM = replace(STRIP, supports=("clamped", "free"))
LADEN = {
    "stepped": replace(HELD, section=SECTIONS),
    "masses": replace(ARM, mass=MASSES),
    "springs": replace(HELD, spring=SPRINGS),
    "masses-springs-steps": replace(ARM, mass=MASSES, spring=SPRINGS, section=SECTIONS),
    "tip-mass": replace(ARM, mass=(PointMass(position=0.73, mass=0.09, rotary_inertia=2.3e-4),)),
    "tension": replace(HELD, tension=140.0),
    "compression": replace(HELD, tension=-19.0),
    "foundation": replace(HELD, foundation=5.1e3),
    "free-on-foundation": replace(STRIP, supports=("free", "free"), foundation=37.0),
    "tension-masses": replace(HELD, tension=61.0, mass=MASSES),
    "losses": replace(HELD, loss_factor=0.013),
}
BEAMS = {"-".join(pair): replace(STRIP, supports=pair) for pair in PAIRS} | LADEN
FORCES = (
    PointForce(position=0.017, amplitude=1.3, phase_deg=11.0),
    PointForce(position=0.697, amplitude=0.8, phase_deg=97.0),
)
DEVICES = (
    Device(position=0.31, stiffness=2.1e3, dashpot=1.7, mass=2.9e-3, amplitude=0.7, phase_deg=23.0),
    Device(position=0.62, rotational=0.9, rotational_dashpot=3e-4),
)
MODELS = {
    "exact": ExactModel,
    "segment": lambda beam, count=23, **settings: SegmentModel(beam, count, **settings),
    "fem": lambda beam, count=14, **settings: HermiteModel(beam, count, **settings),
}
PAIRED = Beam(
    length=0.7, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0, supports=("clamped", "clamped"),
    section=(Section(length=0.2), Section(length=0.3, thickness=0.3, density=1e8), Section(length=0.2))
)  # fmt: skip
"""Two thin strips clamped in a block too heavy to move: frequencies 4 and 5 are 2.4e-7 apart."""
ABSTRACT = Beam(length=0.73, bending_stiffness=3.7, mass_per_length=0.31, rotary_inertia=3e-5, shear_stiffness=2e4)
"""A beam by its stiffnesses, slenderness L sqrt(A / I) = 74."""


def supported(beam, letters, **changes):
    """The beam on supports by their initials (P, C, F, G), with further changes."""
    names = {end[0].upper(): end for end in ENDS}
    return replace(beam, supports=tuple(names[letter] for letter in letters), **changes)


def mass(beam, at, mass=0.0, rotary=0.0):
    """A point mass at a fraction of the length, in m and m L^2 of the beam."""
    whole = beam.mass_per_length * beam.length
    inertia = rotary * whole * beam.length**2
    return (PointMass(position=at * beam.length, mass=mass * whole, rotary_inertia=inertia),)


def spring(beam, at, stiffness=0.0, rotational=0.0):
    """A spring at a fraction of the length, in EI / L^3 and EI / L."""
    unit = beam.bending_stiffness / beam.length
    across = stiffness * unit / beam.length**2
    return (PointSpring(position=at * beam.length, stiffness=across, rotational=rotational * unit),)


def cut(beam):
    """(piece, begin, end) between steps and attachments, from left to right."""
    ends = np.cumsum([piece.length for piece in beam.pieces])
    stops = np.unique([0.0, *ends, *(one.position for one in (*beam.mass, *beam.spring))])
    pieces = np.searchsorted(ends, 0.5 * (stops[1:] + stops[:-1]))
    return [(beam.pieces[i], a, b) for i, a, b in zip(pieces, stops[:-1], stops[1:], strict=True) if b - a > 1e-12]


def over(beams):
    return pytest.mark.parametrize("name", beams)


def close(found, expected, bound=1e-8):
    assert found == pytest.approx(expected, abs=bound * abs(expected).max())
