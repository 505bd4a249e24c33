"""The compression at which a beam buckles, by the same characteristic equation at omega = 0."""

from functools import lru_cache

from msgspec.structs import replace

from verify.errors import InputError
from verify.exact.characteristic import Found, trial
from verify.exact.layout import line_up
from verify.exact.roots import nth_root
from verify.linear.places import as_typed
from verify.problem.beam import Beam


@as_typed
def buckling_load(beam: Beam) -> float:
    """The smallest compression at which the beam is no longer stable, newton, whatever its own axial force is.

    Euler's load of any beam: the force keeps its size and direction. 0 where supports and springs let the beam turn as
    a whole. Masses do not matter. By Euler-Bernoulli's theory. Raises InputError for what is no beam.
    """
    return _load(beam)


@lru_cache(maxsize=256)
def _load(beam: Beam) -> float:
    bare = replace(beam, tension=0.0)
    lines = bare.rigid_lines
    if any(slope for _, slope in lines):
        return 0.0
    line = line_up(bare)
    if lines:  # it moves along as a whole, which changes no energy: its left end is kept where it is
        left = {"free": "pinned", "guided": "clamped"}[line.supports[0]]
        line = type(line)(
            supports=(left, line.supports[1]),
            stretches=line.stretches,
            joints=line.joints,
            tension=0.0,
            foundation=0.0,
        )

    @lru_cache(maxsize=1000)
    def say(root: float) -> Found:
        return trial(line, 0.0, -root * root)

    root = nth_root(say, 1)
    return root * root * beam.bending_stiffness / beam.length**2


def check_stable(beam: Beam) -> None:
    """Raise InputError where an axial compression is as large as the buckling load or larger."""
    if beam.tension < 0.0 and -beam.tension >= (load := buckling_load(beam)):
        raise InputError(
            f"beam.tension = {beam.tension!r} N compresses the beam beyond its buckling load of {load:.6g} N: it has "
            "no vibration about its straight shape, compress it less or hold it more"
        )
