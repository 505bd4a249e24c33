"""The characteristic equation of a beam by minors of its transfer matrix, and the count of frequencies below a trial.

The two motions that the left support leaves free are transferred along the beam as 2 x 2 minors (the delta matrix of
Pestel and Leckie, Matrix Methods in Elastomechanics, 1963): growing exponentials of long spans are a common factor,
short spans have no cancellation, and no stiffness is assembled, whose small eigenvalues would be lost to rounding.

Minors of (w, psi, M, V) are u = p12, p13, p14, p24, p34; p23 = p14 by reciprocity. The stiffness of the beam to the
left of a position against w and psi is [[u3, -u2], [-u2, u1]] / u0, with determinant u4 / u0. The count of Wittrick and
Williams (Q. J. Mech. Appl. Math. 24, 1971) is the number of negative eigenvalues at every station plus the number of
frequencies of each span with clamped ends below the trial, derived from pinned ends (Howson and Williams, J. Sound Vib.
26, 1973).
"""

from collections.abc import Callable
from functools import lru_cache
from math import cos, exp, expm1, floor, pi, sin, sqrt
from typing import NamedTuple

from msgspec.structs import replace

from verify.errors import InputError
from verify.exact import closed_forms
from verify.exact.layout import BeamLayout, Station, layout_of
from verify.problem.beam import Beam, rigid_lines

_END = {"clamped": 0, "pinned": 1, "guided": 3, "free": 4}
"""Minor of the quantities that a support sets to zero; that of the others is 4 less this."""
_SHORT, _TERMS = 2.25, 16  # Largest |wavenumber l|^2 for power series, and their number of terms
_CLOSE = 16.0  # (sigma1 - sigma2)^2 / (sigma1 sigma2) below which two squares of wavenumbers are close
_TINY = 1e-120  # Replaces a minor that is exactly zero, where a stiffness is infinite
_NOTHING = Station()
_CANCELLED = 1e-3  # Ratio of a determinant to its products below which another form computes it

Minors = tuple[float, float, float, float, float]


class Carry(NamedTuple):
    """Transfer of minors over a span of length and stiffness 1, all times one positive factor."""

    one: float
    both: float  # Product of the two cosh
    g2: float
    g3: float
    h4: float  # As in `_series`; g2 is half the product of the two sinh, each over its wavenumber
    tip: float
    guide: float
    lift: float
    turn: float
    bend: float
    """With e1 = g2', m = p + c q, t = p - c q: the last five are e1 - m g3, e1 + m g3, e1 - t g3, c e1 + (2 + c m) g3
    and p e1 - (p m + 2 q) g3."""


class Count(NamedTuple):
    """The characteristic equation at a trial value."""

    below: int  # Number of frequencies below it
    minor: float  # The minor that vanishes at a frequency, up to a positive factor


def _waves(square: float, shift: float) -> tuple[float, float, float]:
    """(cosh z, sinh z / z, (cosh z - 1) / z^2) of z^2 = square, times e^-shift; shift >= z wherever z is real."""
    if square > 0.0:
        z = sqrt(square)
        rise, tail = exp(z - shift), -expm1(-2.0 * z)
        growing = 0.5 * expm1(-z)
        return rise * (1.0 - 0.5 * tail), rise * 0.5 * tail / z, rise * 2.0 * growing * growing / square
    z, scale = sqrt(-square), exp(-shift)
    if z < 1e-30:
        return scale, scale, 0.5 * scale
    half = sin(0.5 * z) / z
    return scale * cos(z), scale * sin(z) / z, scale * 2.0 * half * half


def carry(c: float, p: float, q: float) -> Carry:
    """Transfer of minors over a span of length 1 and EI = 1, with c = 1 / (kappa G A)."""
    sums, m, v = p - c * q, p + c * q, 1.0 + p * c
    product, gap = -q * v, m * m + 4.0 * q  # sum, product and squared difference of the squares sigma of wavenumbers
    if max(abs(sums), sqrt(abs(product))) <= _SHORT:
        return _from_plain(c, p, q, *_series(sums, gap))
    if product > 0.0 and gap < _CLOSE * product:
        return _from_plain(c, p, q, *_close(sums, product, gap))
    root = sqrt(gap)
    large = 0.5 * (sums + root) if sums >= 0.0 else 0.5 * (sums - root)
    first, second = (large, product / large) if sums >= 0.0 else (product / large, large)
    up = 0.5 * (root + m) if m >= 0.0 else q / (0.5 * (root - m))
    down = q / up if m >= 0.0 else 0.5 * (root - m)
    growth = sqrt(max(first, 0.0)), sqrt(max(second, 0.0))
    (ca, sa, _), (cb, sb, _) = _waves(first, growth[0]), _waves(second, growth[1])
    one, x, y, half = exp(-growth[0] - growth[1]), ca * sb / root, sa * cb / root, 0.5 * sa * sb
    less = v / (1.0 + c * up) if up >= 0.0 else 1.0 - c * down
    return Carry(
        one,
        ca * cb,
        half,
        0.5 * (x - y),
        (sums * half - ca * cb + one) / gap,
        down * x + up * y,
        up * x + down * y,
        first * y - second * x,
        (1.0 + c * up) * x - less * y,
        down * second * x + up * first * y,
    )


def _from_plain(c: float, p: float, q: float, one: float, e1: float, g3: float, g2: float, h4: float) -> Carry:
    """`carry` from the fundamental solutions of fourth order."""
    t, m = p - c * q, p + c * q
    return Carry(
        one,
        one + t * g2 - (m * m + 4.0 * q) * h4,
        g2,
        g3,
        h4,
        e1 - m * g3,
        e1 + m * g3,
        e1 - t * g3,
        c * e1 + (2.0 + c * m) * g3,
        p * e1 - (p * m + 2.0 * q) * g3,
    )


def _series(sums: float, gap: float) -> tuple[float, float, float, float, float]:
    """(1, e1, g3, g2, h4): g3 solves g'''' = 2 sums g'' - gap g from z^3 / 6; g2 and e1 are its derivatives."""
    before, term, over = 0.0, 1.0, 6.0
    e1 = g3 = g2 = h4 = 0.0
    n = 3
    for _ in range(_TERMS):
        g3 += term / over
        g2 += term * n / over
        e1 += term * n * (n - 1) / over
        h4 += term / (over * (n + 1))
        before, term = term, 2.0 * sums * term - gap * before
        over *= (n + 1) * (n + 2)
        n += 2
    return 1.0, e1, g3, g2, h4


def _close(sums: float, product: float, gap: float) -> tuple[float, float, float, float, float]:
    """`_series` for close squares of both wavenumbers, by their sum and difference."""
    w = 2.0 * sqrt(product)
    far = sums + w if sums >= 0.0 else sums - w
    a, d = (far, gap / far) if sums >= 0.0 else (gap / far, far)
    growth = sqrt(max(a, d, 0.0))
    (ca, sa, ha), (cd, sd, hd) = _waves(a, growth), _waves(d, growth)
    w *= 2.0
    return exp(-growth), (a * sa - d * sd) / w, (sa - sd) / w, (ca - cd) / w, (ha - hd) / w


def _carried(u: Minors, by: Carry, c: float, p: float, q: float) -> Minors:
    """Minors at the far end of a span."""
    u0, u1, u2, u3, u4 = u
    one, both, g2, g3, h4, tip, guide, lift, turn, bend = by
    m, guide = p + c * q, q * guide
    outer, ahead, back, corner = both + 2.0 * q * h4, g2 - m * h4, q * (g2 + m * h4), 2.0 * (c * g2 + h4)
    return (
        u0 * outer + u1 * tip + 2.0 * u2 * ahead + u3 * turn + u4 * corner,
        u0 * bend + u1 * both + 2.0 * u2 * lift + 2.0 * u3 * (1.0 + p * c) * g2 + u4 * turn,
        u3 * lift + u4 * ahead - u0 * back - 2.0 * u1 * q * g3 + u2 * (one - 4.0 * q * h4),
        u3 * both + u4 * tip - u0 * guide - 2.0 * u1 * q * g2 - 4.0 * u2 * q * g3,
        2.0 * u0 * q * (q * h4 - p * g2) - u1 * guide - 2.0 * u2 * back + u3 * bend + u4 * outer,
    )


def _over(u: Minors, station: Station, omega2: float) -> Minors:
    """Minors to the right of attachments; a support at the station is an infinite stiffness."""
    if station == _NOTHING:
        return u
    u0, u1, u2, u3, u4 = u
    k, turning = station.stiffness - omega2 * station.mass, station.rotational - omega2 * station.inertia
    u3, u4 = u3 + k * u0, u4 + k * u1
    u1, u4 = u1 + turning * u0, u4 + turning * u3
    if station.support in ("pinned", "clamped"):
        u0, u1, u2, u3, u4 = 0.0, 0.0, 0.0, u0, u1
    if station.support in ("guided", "clamped"):
        u0, u1, u2, u3, u4 = 0.0, u0, 0.0, 0.0, u3
    return (u0, u1, u2, u3, u4)


@lru_cache(maxsize=20_000)
def count_at(layout: BeamLayout, omega2: float) -> Count:
    """The count at a trial omega^2 over EI / (rho A L^4): frequencies below it, rigid motions at 0 included.

    At omega = 0 the number of buckled shapes under the layout's tension. Dashpots have no effect.
    """
    start = [0.0] * 5
    start[4 - _END[layout.supports[0]]] = 1.0
    u = _over((start[0], start[1], start[2], start[3], start[4]), layout.stations[0], omega2)
    below, left = 0, layout.supports[0]
    for span, station in zip(layout.spans, layout.stations[1:], strict=True):
        length, stiffness = span.length, span.stiffness
        c = span.compliance * stiffness / length**2
        p = (layout.tension - span.rotary * omega2) * length**2 / stiffness
        q = (span.mass * omega2 - layout.foundation) * length**4 / stiffness
        by = carry(c, p, q)
        # minors of a span of length and stiffness 1, and back, with the largest about 1
        by_moment, by_force = length**2 / stiffness, length**3 / stiffness
        sizes = (length, by_moment, by_force, length * by_force, by_moment * by_force)
        near = (u[0] * sizes[0], u[1] * sizes[1], u[2] * sizes[2], u[3] * sizes[3], u[4] * sizes[4])
        far = _carried(near, by, c, p, q)
        below += _count_clamped(by, c, p, q) + _at_station(near, by, c, p, q, far[0], left)
        v = [minor / size for minor, size in zip(far, sizes, strict=True)]
        largest = max(map(abs, v))
        u = _over((v[0] / largest, v[1] / largest, v[2] / largest, v[3] / largest, v[4] / largest), station, omega2)
        left = station.support
    right, base = layout.supports[1], u[0] or _TINY
    if right == "free":
        below += _negatives(u[3] / base, -u[2] / base, u[1] / base, u[4] * base)
    elif right != "clamped":
        below += u[_END[right]] / base < 0.0
    return Count(below, u[_END[right]])


def _count_clamped(by: Carry, c: float, p: float, q: float) -> int:
    """Number of frequencies of a span with clamped ends below the trial.

    Pinned ends have at most two more; the parity follows from the sign of the minor. For pinned ends a sine of
    wavenumber n pi = k has one if k^4 - (c q - p) k^2 - q (1 + p c) < 0, and up to two above the cut-off.
    """
    half, product, gap = 0.5 * (c * q - p), -q * (1.0 + p * c), (p + c * q) ** 2 + 4.0 * q
    if gap <= 0.0:
        return 0
    root = 0.5 * sqrt(gap)
    high = half + root if half >= 0.0 else product / (half - root)
    low = product / high if half >= 0.0 and high != 0.0 else 0.0  # negative where half is
    first, second = (floor(sqrt(square) / pi) if square > 0.0 else 0 for square in (low, high))
    twice = c > 0.0 and 1.0 + p * c < 0.0  # above the cut-off: rotation alone, and a second family
    pinned = second - first + (2 * first if twice and q > 0.0 else 0) + twice
    corner = c * by.g2 + by.h4
    if pinned == 0 or pinned % 2 != (corner < 0.0):
        return max(pinned - 1, 0)
    return pinned if by.turn * corner > 0.0 else pinned - 2


def _at_station(u: Minors, by: Carry, c: float, p: float, q: float, ahead: float, left: str) -> int:
    """Number of negative eigenvalues of the stiffness at a station: beam to the left, and next span clamped at its end.

    ahead: p12 at the far end of that span, whose sign is that of the determinant.
    """
    corner = 2.0 * (c * by.g2 + by.h4) or _TINY
    force, slope, moment = (part / corner for part in (by.tip, by.g2 - (p + c * q) * by.h4, by.turn))
    if left == "clamped":
        return 0
    if left == "pinned":
        return int(u[4] / (u[3] or _TINY) + moment < 0.0)
    if left == "guided":
        return int(u[4] / (u[1] or _TINY) + force < 0.0)
    base = u[0] or _TINY
    ww, wp, pp = u[3] / base + force, slope - u[2] / base, u[1] / base + moment
    return _negatives(ww, wp, pp, ahead * base * corner)


def _negatives(a: float, b: float, d: float, determinant: float) -> int:
    """Number of negative eigenvalues of [[a, b], [b, d]]; `determinant` has the sign of its determinant."""
    products = a * d, b * b
    difference = products[0] - products[1]
    sign = difference if abs(difference) > _CANCELLED * sum(products) else determinant
    return 1 if sign < 0.0 else 2 if a + d < 0.0 else 0


@lru_cache(maxsize=20_000)
def wavenumber_length(layout: BeamLayout, number: int) -> float:
    """Wavenumber beta L of frequency `number` from 1, rigid-body motions included: omega = beta^2 at L = 1.

    In closed form for a uniform Euler-Bernoulli beam without attachments.
    """
    if layout.plain:
        deflections, rotations = (sum(s in (held, "clamped") for s in layout.supports) for held in ("pinned", "guided"))
        rigid = max(2 - deflections - min(rotations, 1), 0)
        return closed_forms.wavenumber_length(layout.supports, number - rigid) if number > rigid else 0.0
    try:
        return nth_root(lambda beta: count_at(layout, beta**4), number)
    except OverflowError:
        raise InputError(f"beam: mode {number} is beyond floating point: lower its tension or foundation") from None


def nth_root(count: Callable[[float], Count], number: int) -> float:
    """The positive trial value at which the count reaches `number`.

    The same intervals are bisected for all roots, until one contains a single root, or roots that coincide.
    """
    from scipy.optimize import brentq

    low, high = 0.0, 1.0
    while count(high).below < number:
        low, high = high, 2.0 * high
    while high - low > 4e-16 * high and high > 1e-300:
        lower, upper = count(low), count(high)
        alone = low > 0.0 and upper.below - lower.below == 1 and (upper.minor > 0.0) != (lower.minor > 0.0)
        if alone and high - low < 0.1 * high:
            return float(brentq(lambda trial: count(trial).minor, low, high, xtol=1e-300, rtol=8.9e-16))
        middle = 0.5 * (low + high)
        low, high = (low, middle) if count(middle).below >= number else (middle, high)
    return high


def buckling_load(beam: Beam) -> float:
    """Lowest buckling load in compression, N, without the beam's own axial force; 0 with a rigid-body rotation.

    The root of the characteristic equation at omega = 0 by Euler-Bernoulli theory, for a force of constant direction.
    """
    bare = replace(beam, tension=0.0)
    if any(slope for _, slope in rigid_lines(bare)):
        return 0.0
    layout = layout_of(bare)
    if rigid_lines(bare):  # a translation changes no energy: the left end is pinned
        left = {"free": "pinned", "guided": "clamped"}[layout.supports[0]]
        layout = replace(layout, supports=(left, layout.supports[1]))
    root = nth_root(lambda root: count_at(replace(layout, tension=-root * root), 0.0), 1)
    return root * root * beam.bending_stiffness / beam.length**2


@lru_cache(maxsize=256)
def check_stable(beam: Beam) -> None:
    """Raise InputError for an axial compression that reaches the buckling load."""
    if beam.tension < 0.0 and -beam.tension >= (load := buckling_load(beam)):
        raise InputError(
            f"beam.tension = {beam.tension!r} N exceeds the buckling load {load:.6g} N: compress the beam less or "
            "support it better"
        )
