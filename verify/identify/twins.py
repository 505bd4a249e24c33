"""What no list can tell of a cantilever: its wall and the mass at its free end stand for each other.

By Euler and Bernoulli the moments of a uniform cantilever are the deflections of one that is turned round: a clamp of
k_r = kappa EI/L has the frequencies of a rigid one with rho A L / kappa at the free end.

Read from its other end, by moments in place of deflections, a chain of n equal joints EI/l and masses m is one of the
same kind: w EI/l at the wall and t m at the free end have the frequencies of EI/(t l) and m/w. So a wrong mass at the
tip of a chain whose wall is right looks like a wrong wall.
"""

from verify.beam import Beam
from verify.identify.clamps import Clamp
from verify.identify.fitting import Identified
from verify.identify.pairing import Found

_TIPS = {
    "full": "a whole mass in place of half a one",
    "rigid": "no mass",
}
"""By the wall of the family: what stands at the free end of its twin, whose wall has 2EI/l."""


def twin_of(beam: Beam, found: Identified) -> tuple[Found, ...]:
    """What has the same frequencies with another wall and another mass at the free end, where there is such a thing."""
    if not beam.uniform or set(beam.supports) != {"clamped", "free"}:
        return ()
    clamps = [one.best.clamp for one in (found, *found.rivals) if one.best.clamp is not None]
    return _heavy_tip(beam, clamps[0]) if clamps else _other_wall(found)


def _heavy_tip(beam: Beam, clamp: Clamp) -> tuple[Found, ...]:
    """The mass at the free end that does as much as a clamp that gives."""
    share = 1.0 / clamp.stiffness
    words = (
        f"no list can tell that clamp from a rigid one with {share:.4g} rho A L "
        f"({share * beam.mass_per_length * beam.length:.4g} kg) at the free end: look at both"
    )
    return (Found(kind="twin", words=words, wrong=False),)


def _other_wall(found: Identified) -> tuple[Found, ...]:
    """The chain with 2EI/l at its wall and another mass at its free end."""
    one = found.best.candidate
    tip = _TIPS.get(one.wall or "") if one.mass == "joints" and not one.shearing else None
    if tip is None or one.theory != "euler-bernoulli" or not found.explained:
        return ()
    words = f"no list can tell it from one with 2EI/l at the wall and {tip} at its free end: look at both"
    return (Found(kind="twin", words=words, wrong=False),)
