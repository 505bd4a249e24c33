"""A beam as what stands in line along it, in units of its own: stretches of one section, and joints between them.

Every stretch obeys, for the state deflection w, turn psi, moment M and transverse force V,

    w' = psi - V / (kappa G A),  psi' = M / EI,  M' = V + p psi,  V' = q w,
    p = T - rho I omega^2,  q = rho A omega^2 - k_f,

which is Euler-Bernoulli's beam under a tension T on a foundation k_f where 1 / (kappa G A) and rho I are zero,
Rayleigh's where only the first is, Timoshenko's where none is. V = EI w''' - T w' balances what is fixed to the beam:
over a point mass or spring V falls by (k - m omega^2) w and M rises by (k_r - J omega^2) psi.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import msgspec

from verify.linear.theory import check_theory
from verify.problem.beam import Beam
from verify.problem.cross_section import Piece

SAME_PLACE = 1e-12
"""Of the beam's length: what lies closer stands at one place."""
HELD = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Which of w, psi, M, V a support sets to zero."""


class Stretch(NamedTuple):
    """A stretch of one section, relative to the beam's own L, EI and rho A."""

    length: float
    stiffness: float
    """EI."""
    mass: float
    """Rho A."""
    shear: float
    """1 / (kappa G A), times EI / L^2 of the beam; 0 where shear does not count."""
    turning: float
    """Rho I, over rho A L^2 of the beam; 0 where it does not count."""


class Joint(NamedTuple):
    """What is fixed to the beam at one place, relative likewise."""

    stiffness: float = 0.0
    rotational: float = 0.0
    mass: float = 0.0
    inertia: float = 0.0


class Lineup(msgspec.Struct, frozen=True, kw_only=True):
    """What stands in line along a beam."""

    supports: tuple[str, str]
    stretches: tuple[Stretch, ...]
    """From the left, n of them."""
    joints: tuple[Joint, ...]
    """N + 1: at the left end, between stretches, at the right end."""
    tension: float
    """T L^2 / EI."""
    foundation: float
    """k_f L^4 / EI."""

    @property
    def places(self) -> tuple[float, ...]:
        """Where the joints are, of the beam's length."""
        places = [0.0]
        for stretch in self.stretches:
            places.append(places[-1] + stretch.length)
        return tuple(places)


@lru_cache(maxsize=256)
def line_up(beam: Beam, theory: str = "euler-bernoulli", also: tuple[float, ...] = ()) -> Lineup:
    """What stands along a beam; `also` are places in metres where stretches end besides. Raises InputError."""
    check_theory(beam, theory)
    cuts = [*(m.position for m in beam.mass), *(s.position for s in beam.spring), *also]
    stretches = [part for i in range(len(beam.pieces)) for part in _parts_of(beam, i, theory, cuts)]
    ends = [0.0]
    for stretch in stretches:
        ends.append(ends[-1] + stretch.length)
    length, stiffness = beam.length, beam.bending_stiffness
    return Lineup(
        supports=beam.supports,
        stretches=tuple(stretches),
        joints=_joints(beam, ends),
        tension=beam.tension * length**2 / stiffness,
        foundation=beam.foundation * length**4 / stiffness,
    )


def _parts_of(beam: Beam, number: int, theory: str, cuts: Sequence[float]) -> list[Stretch]:
    """The stretches of one piece, cut where something stands inside it."""
    piece, start = beam.pieces[number], sum(piece.length for piece in beam.pieces[:number])
    room = SAME_PLACE * beam.length
    inside = sorted(cut - start for cut in cuts if room < cut - start < piece.length - room)
    ends = [0.0]
    for cut in inside:
        if cut - ends[-1] > room:
            ends.append(cut)
    base = beam.bending_stiffness, beam.mass_per_length
    shear, turning = _thickness(piece, theory)
    return [
        Stretch(
            (end - begin) / beam.length,
            piece.bending_stiffness / base[0],
            piece.mass_per_length / base[1],
            shear * base[0] / beam.length**2,
            turning / base[1] / beam.length**2,
        )
        for begin, end in zip(ends, [*ends[1:], piece.length], strict=True)
    ]


def _thickness(piece: Piece, theory: str) -> tuple[float, float]:
    """(1 / (kappa G A), rho I) as far as they count in a theory that the piece has the figures for."""
    if theory == "euler-bernoulli" or piece.rotary_inertia is None:
        return 0.0, 0.0
    if theory == "rayleigh" or piece.shear_stiffness is None:
        return 0.0, piece.rotary_inertia
    return 1.0 / piece.shear_stiffness, piece.rotary_inertia


def place_of(ends: Sequence[float], at: float) -> int:
    """Which of the ends of stretches lies at a place, both of the beam's length."""
    return min(range(len(ends)), key=lambda i: abs(ends[i] - at))


def _joints(beam: Beam, ends: Sequence[float]) -> tuple[Joint, ...]:
    """All that is fixed at each end of a stretch, added up."""
    length, stiffness, mass = beam.length, beam.bending_stiffness, beam.mass_per_length
    sums = [[0.0] * 4 for _ in ends]
    for spring in beam.spring:
        here = sums[place_of(ends, spring.position / length)]
        here[0] += spring.stiffness * length**3 / stiffness
        here[1] += spring.rotational * length / stiffness
    for body in beam.mass:
        here = sums[place_of(ends, body.position / length)]
        here[2] += body.mass / (mass * length)
        here[3] += body.rotary_inertia / (mass * length**3)
    return tuple(Joint(*values) for values in sums)
