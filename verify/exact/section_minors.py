"""The frequency equation of a stepped beam by the minors of its transfer, which keeps every digit.

The two motions that the left end leaves free are carried along the beam not themselves but as their 2 x 2 minors
(the delta matrix of Pestel and Leckie, Matrix Methods in Elastomechanics, 1963). Of long sections the growing parts
then leave a common factor, of short ones nothing cancels, and no stiffness is assembled whose small eigenvalues
could drown.

Minors of w, w', M = EI w'' and Q = EI w''' are listed as p12, p13, p14 + p23, p24, p34; p14 = p23 throughout.
"""

from math import cos, exp, sin

_HELD = {"clamped": 0, "pinned": 1, "guided": 3, "free": 4}
"""The minor of what an end holds at zero; that of what it leaves free is 4 less this."""
_TERMS = 7
"""Of the series in y^4, to rounding up to y = 1."""


def end_minor(stretches: list[tuple[float, float, float]], supports: tuple[str, str], beta_length: float) -> float:
    """What vanishes where omega = beta^2 sqrt(EI / rho A) is a frequency, by beta L, up to a positive factor.

    stretches: (length, EI, rho A) of the sections from the left, relative to the beam's.
    """
    minors = [0.0] * 5
    minors[4 - _HELD[supports[0]]] = 1.0
    for length, bending, mass in stretches:
        beta = beta_length * (mass / bending) ** 0.25
        sizes = (1.0, bending * beta, bending * beta**2, bending * beta**3, (bending * beta**2) ** 2)
        carried = _carried([minor / size for minor, size in zip(minors, sizes, strict=True)], beta * length)
        minors = [minor * size for minor, size in zip(carried, sizes, strict=True)]
        largest = max(map(abs, minors))
        minors = [minor / largest for minor in minors]
    return minors[_HELD[supports[1]]]


def _carried(minors: list[float], y: float) -> tuple[float, ...]:
    """Minors u at the far end of a section of beta l = y, times e^{-y}.

    In units of beta and EI: u0' = u1, u1' = u2, u2' = 2 u3, u3' = u4 - u0, u4' = -u1, so that u0 + u4 is constant
    and u1'''' = -4 u1.
    """
    u0, u1, u2, u3, u4 = minors
    g0, g1, g2, g3, g4, rest = _waves(y)
    rise = 2.0 * (u4 - u0)
    return (
        u0 * rest + u1 * g1 + u2 * g2 + 2.0 * u3 * g3 + 2.0 * u4 * g4,
        u1 * g0 + u2 * g1 + 2.0 * u3 * g2 + rise * g3,
        u2 * g0 + 2.0 * u3 * g1 + rise * g2 - 4.0 * u1 * g3,
        u3 * g0 + 0.5 * rise * g1 - 2.0 * u1 * g2 - 2.0 * u2 * g3,
        u4 * rest + 2.0 * u0 * g4 - u1 * g1 - u2 * g2 - 2.0 * u3 * g3,
    )


def _waves(y: float) -> tuple[float, ...]:
    """Solutions g0 to g3 of g'''' = -4 g with one derivative 1 at 0, the integral g4 of g3, 1 - 2 g4; times e^{-y}.

    cos cosh, (sin cosh + cos sinh) / 2, sin sinh / 2, (sin cosh - cos sinh) / 4, (1 - cos cosh) / 4; their power
    series up to y = 1, where the last two would cancel.
    """
    c, s, tail = cos(y), sin(y), exp(-y)
    if y <= 1.0:
        sums = [_series(y, first) * tail for first in range(5)]
        return (*sums, tail - 2.0 * sums[4])
    ch, sh = 0.5 * (1.0 + tail * tail), 0.5 * (1.0 - tail * tail)
    return (
        c * ch,
        0.5 * (s * ch + c * sh),
        0.5 * s * sh,
        0.25 * (s * ch - c * sh),
        0.25 * (tail - c * ch),
        0.5 * (tail + c * ch),
    )


def _series(y: float, first: int) -> float:
    """Sum over k of (-4)^k y^(4k + first) / (4k + first)!."""
    term = 1.0
    for n in range(1, first + 1):
        term *= y / n
    total = 0.0
    for k in range(_TERMS):
        total += term
        n = 4 * k + first
        term *= -4.0 * y**4 / ((n + 1) * (n + 2) * (n + 3) * (n + 4))
    return total
