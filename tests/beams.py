"""Unsymmetric beams that several tests share: every pair of ends, and everything that a beam may carry."""

from itertools import pairwise

from msgspec.structs import replace

from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
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
PAIRED = Beam(
    length=0.7,
    width=0.02,
    thickness=0.001,
    youngs_modulus=70e9,
    density=2700.0,
    supports=("clamped", "clamped"),
    section=(Section(length=0.2), Section(length=0.3, thickness=0.3, density=1e8), Section(length=0.2)),
)
"""Two thin strips held by a block too heavy to move: its fourth and fifth frequency are 2.4e-7 apart."""


def cut(beam):
    """(piece, begin, end) from left to right, cut wherever something is attached."""
    places = {one.position for one in (*beam.mass, *beam.spring)}
    parts, start = [], 0.0
    for piece in beam.pieces:
        end = start + piece.length
        inner = [start, *sorted(p for p in places if start + 1e-12 < p < end - 1e-12), end]
        parts += [(piece, a, b) for a, b in pairwise(inner)]
        start = end
    return parts
