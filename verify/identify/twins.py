"""What no list can tell of a lumped cantilever: a wall's joint and the mass at the free end stand for each other.

Read from its other end, by moments in place of deflections, a chain of n equal joints EI/l and masses m is one of the
same kind: w EI/l at the wall and t m at the free end have the frequencies of EI/(t l) and m/w. So a wrong mass at the
tip of a chain whose wall is right looks like a wrong wall.
"""

from verify.beam import Beam
from verify.identify.fitting import Identified
from verify.identify.pairing import Found

_TIPS = {
    "full": "a whole mass in place of half a one",
    "rigid": "no mass",
}
"""By the wall of the family: what stands at the free end of its twin, whose wall has 2EI/l."""


def twin_of(beam: Beam, found: Identified) -> tuple[Found, ...]:
    """The chain of another wall and another mass at the free end that has the same frequencies, where there is one."""
    one = found.best.candidate
    tip = _TIPS.get(one.wall or "") if one.mass == "joints" and not one.shearing else None
    lone = beam.uniform and set(beam.supports) == {"clamped", "free"} and one.theory == "euler-bernoulli"
    if tip is None or not lone or not found.explained or found.best.clamp is not None:
        return ()
    words = f"no list can tell it from one with 2EI/l at the wall and {tip} at its free end: look at both"
    return (Found(kind="twin", words=words, wrong=False),)
