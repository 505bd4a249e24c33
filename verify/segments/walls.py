"""How a chain of rigid links is held at a clamped or guided end.

The compliances of the joints are the weights of a quadrature of M^2 / EI over the beam. Inside, a joint stands
for one link length (the trapezoidal rule); at a clamped wall that rule needs an end correction.
"""

import numpy as np

from verify.arrays import Array

# What a clamped end adds to the weights 1 of its joints, from the wall on, in l/EI.
_CORRECTIONS: dict[str, tuple[float, ...]] = {
    # Gregory's end correction of the trapezoidal rule: weights 3/8, 7/6, 23/24; frequencies of order 4
    "gregory": (-5 / 8, 1 / 6, -1 / 24),
    # the literature's wall joint k = 2EI/l, Eq. (1) with a rigid neighbour: order 2
    "half": (-1 / 2,),
    # half a segment is part of the wall, and a whole joint EI/l follows it: order 2
    "welded": (),
    # weights 5/12, 13/12: order 3
    "third-order": (-7 / 12, 1 / 12),
    # weights 95/288, 317/240, 23/30, 793/720, 157/160: order 4 and a little more for low modes
    "five-joint": (95 / 288 - 1, 317 / 240 - 1, 23 / 30 - 1, 793 / 720 - 1, 157 / 160 - 1),
}


def wall_factors(
    supports: tuple[str, str], n_segments: int, wall: str, elastic: tuple[bool, bool] = (False, False)
) -> Array:
    """What to multiply the compliances of joints 0..N with, (N + 1,); infinite where an end has no joint.

    A guided wall has half a joint, which is exact by reflection. On short chains the corrections of both
    clamped ends overlap and add up; what falls on an end without a moment is dropped, because there is none.
    An end that is `elastic` has a moment, and the joint of a clamped one.
    """
    if any(elastic):
        left, right = ("clamped" if turns else support for support, turns in zip(supports, elastic, strict=True))
        supports = (left, right)
    factors = np.ones(n_segments + 1)
    for end, support in zip((0, n_segments), supports, strict=True):
        if support == "guided":
            factors[end] = 0.5
    for end, support in zip((0, n_segments), supports, strict=True):
        if support == "clamped":
            for depth, correction in enumerate(_CORRECTIONS[wall][: n_segments + 1]):
                factors[abs(end - depth)] += correction
    for end, support in zip((0, n_segments), supports, strict=True):
        if support in ("pinned", "free"):
            factors[end] = np.inf
    return factors


def tension_excess(wall: str) -> float:
    """What a clamped wall adds to the weights 1/c of the tensioned joints' T l/12, in l (`loaded`).

    Corrections a_k of the joints turn link i by -l kappa sum_{k>i} a_k from the smooth line; axial force feels the
    squares of that. 5/24 for Gregory's.
    """
    turned = np.cumsum(np.array(_CORRECTIONS[wall])[:0:-1])
    return float(12.0 * (turned**2).sum())


def reading_factors(elastic: tuple[bool, bool], n_segments: int, wall: str) -> Array:
    """What to multiply the corrections of the joints' reading with beside elastic ends, (N + 1,).

    Corrections a_k of the joints put joint j off the smooth line by l^2 kappa sum_{k>j} a_k (k - j), and make its
    angle 1 + a_j of the beam's.
    """
    factors, a = np.ones(n_segments + 1), np.array(_CORRECTIONS[wall])
    for end, turns in zip((0, n_segments), elastic, strict=True):
        for depth in range(1, min(len(a), n_segments + 1) * turns):
            off = sum(a[k] * (k - depth) for k in range(depth + 1, len(a)))
            factors[abs(end - depth)] *= (1.0 - 12.0 * off) / (1.0 + a[depth])
    return factors


def welded_halves(supports: tuple[str, str]) -> tuple[int, int]:
    """Which ends have half a segment welded to the wall."""
    left, right = (int(support == "clamped") for support in supports)
    return left, right


def shear_factors(
    supports: tuple[str, str], n_segments: int, wall: str, loaded: tuple[bool, bool] = (False, False)
) -> Array:
    """The same for the compliances against slipping, (N + 1,): the quadrature of Q^2 / (kappa G A).

    A clamped wall takes its correction; a pinned one half a joint, exact by reflection; guided and free ends carry no
    shear force, but where they are `loaded` by a body or a spring.
    """
    held = {"clamped": "clamped", "pinned": "guided", "guided": "free", "free": "free"}
    return wall_factors((held[supports[0]], held[supports[1]]), n_segments, wall, loaded)
