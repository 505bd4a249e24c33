"""The compression at which a chain buckles: where its joints, springs and ground no longer hold its links' turns."""

from math import inf
from typing import Any

from msgspec.structs import replace

from verify.errors import InputError
from verify.linear.compression import buckling_ratio
from verify.linear.places import as_typed
from verify.options import Attachment, Joints, Wall
from verify.problem.beam import Beam
from verify.segments.assembly import build_chain, chain_pencil, check_set_up

_PASSES = 60
_SETTLED = 1e-13
"""Relative, of a load that the joints follow."""


@as_typed
def buckling_load(
    beam: Beam,
    n_segments: int,
    *,
    wall: Wall = "gregory",
    joints: Joints = "series",
    grading: float = 1.0,
    attachment: Attachment = "reciprocal",
) -> float:
    """The compression, N, at which the chain buckles first, whatever the beam's own axial force.

    Pinned ends: (4 EI/l^2) sin^2(pi/(2N)), -mu^2/12, of joints in series; order 4 of tensioned ones, which stiffen as
    the force grows. 0 where nothing keeps the chain from turning. Raises InputError for settings that are not known and
    a single link, which does not bend.
    """
    check_set_up(n_segments, wall, joints, attachment)
    force = beam.bending_stiffness / beam.length**2
    for _ in range(_PASSES):
        least = _least(replace(beam, tension=-force), n_segments, wall, joints, grading, attachment)
        force *= least
        if joints != "tensioned" or least == 0.0 or abs(least - 1.0) < _SETTLED:
            break
    return force


def check_loaded(beam: Beam, n_segments: int, wall: Any, joints: Any, grading: float, attachment: Any) -> None:
    """Raise InputError where axial force leaves a tensioned joint no stiffness, or buckles the chain as it is."""
    if _least(beam, n_segments, wall, joints, grading, attachment) > 1.0:
        return
    load = buckling_load(beam, n_segments, wall=wall, joints=joints, grading=grading, attachment=attachment)
    raise InputError(
        f"beam.tension = {beam.tension!r} N compresses the beam beyond its buckling load: the chain of {n_segments} "
        f"segments buckles at {load:.6g} N, lower the compression or hold the beam better"
    )


def _least(beam: Beam, n_segments: int, wall: Any, joints: Any, grading: float, attachment: Any) -> float:
    """The smallest factor of its own axial force at which the chain buckles; infinite under tension."""
    if beam.tension < 0.0 and any(tilt for _, tilt in replace(beam, tension=0.0).rigid_lines):
        return 0.0  # nothing but the force itself bears on its turning as a whole
    chain = build_chain(beam, n_segments, wall=wall, joints=joints, grading=grading, attachment=attachment)
    return 1.0 / buckling_ratio(chain_pencil(chain)) if beam.tension < 0.0 else inf
