"""The characteristic equation of any beam by the minors of its transfer, and the count of frequencies below a trial.

The two motions that the left end leaves free are carried along the beam not themselves but as their 2 x 2 minors
(the delta matrix of Pestel and Leckie, Matrix Methods in Elastomechanics, 1963). Of long stretches the growing parts
then leave a common factor, of short ones nothing cancels, and no stiffness is assembled whose small eigenvalues
could drown.

Minors of w, psi, M, V are listed as u = p12, p13, p14, p24, p34; p23 = p14 throughout, by reciprocity. Of the beam to
the left of a place they hold its stiffness against w and psi there, [[u3, -u2], [-u2, u1]] / u0, determinant u4 / u0.
The count of Wittrick and Williams (Q. J. Mech. Appl. Math. 24, 1971) needs no other matrix: the negative eigenvalues at
every joint, and what each stretch has of its own with both ends clamped, found by way of pinned ends (Howson and
Williams, J. Sound Vib. 26, 1973).
"""

from math import cos, exp, expm1, floor, pi, sin, sqrt
from typing import NamedTuple

from verify.exact.layout import Joint, Lineup

_END = {"clamped": 0, "pinned": 1, "guided": 3, "free": 4}
"""The minor of what an end holds at zero; that of what it leaves free is 4 less this."""
_SHORT = 2.25
"""Of |wavenumber l|^2, up to where power series are summed."""
_TERMS = 16
"""Of those series, to rounding."""
_CLOSE = 16.0
"""Of (sigma1 - sigma2)^2 / (sigma1 sigma2), below which two squares of wavenumbers count as close."""
_TINY = 1e-120
"""In place of a minor that is zero to the last digit, where a stiffness is infinite."""
_CANCELLED = 1e-3
"""Of a determinant that is left of its products, below which another form of it is trusted."""

Minors = tuple[float, float, float, float, float]


class Carry(NamedTuple):
    """What takes minors over a stretch of length and stiffness 1, all times one positive factor."""

    one: float
    both: float
    """Product of the two cosh."""
    g2: float
    g3: float
    h4: float
    """As in `_series`; g2 is half the product of the two sinh, each over its wavenumber."""
    tip: float
    guide: float
    lift: float
    turn: float
    bend: float
    """E1 - m g3, e1 + m g3, e1 - t g3, c e1 + (2 + c m) g3, p e1 - (p m + 2 q) g3.

    Of e1 = g2', m = p + c q, t = p - c q.
    """


class Found(NamedTuple):
    """What a trial value says."""

    below: int
    """How many frequencies lie below it."""
    minor: float
    """What vanishes at a frequency, up to a positive factor."""


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
    """What takes minors over a stretch of length 1 and EI = 1, with c = 1 / (kappa G A)."""
    sums, m, v = p - c * q, p + c * q, 1.0 + p * c
    product, gap = -q * v, m * m + 4.0 * q  # of the squares sigma of both wavenumbers: sums, product, (difference)^2
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
    """By the fundamental solutions of fourth order themselves."""
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
    """The same where the squares of both wavenumbers lie close to each other, by their sum and difference."""
    w = 2.0 * sqrt(product)
    far = sums + w if sums >= 0.0 else sums - w
    a, d = (far, gap / far) if sums >= 0.0 else (gap / far, far)
    growth = sqrt(max(a, d, 0.0))
    (ca, sa, ha), (cd, sd, hd) = _waves(a, growth), _waves(d, growth)
    w *= 2.0
    return exp(-growth), (a * sa - d * sd) / w, (sa - sd) / w, (ca - cd) / w, (ha - hd) / w


def _carried(u: Minors, by: Carry, c: float, p: float, q: float) -> Minors:
    """Minors at the far end of a stretch."""
    u0, u1, u2, u3, u4 = u
    one, both, g2, g3, h4, tip, guide, lift, turn, bend = by
    m, guide = p + c * q, q * guide
    rest, ahead, back, corner = both + 2.0 * q * h4, g2 - m * h4, q * (g2 + m * h4), 2.0 * (c * g2 + h4)
    return (
        u0 * rest + u1 * tip + 2.0 * u2 * ahead + u3 * turn + u4 * corner,
        u0 * bend + u1 * both + 2.0 * u2 * lift + 2.0 * u3 * (1.0 + p * c) * g2 + u4 * turn,
        u3 * lift + u4 * ahead - u0 * back - 2.0 * u1 * q * g3 + u2 * (one - 4.0 * q * h4),
        u3 * both + u4 * tip - u0 * guide - 2.0 * u1 * q * g2 - 4.0 * u2 * q * g3,
        2.0 * u0 * q * (q * h4 - p * g2) - u1 * guide - 2.0 * u2 * back + u3 * bend + u4 * rest,
    )


def _over(u: Minors, joint: Joint, omega2: float) -> Minors:
    """Minors behind what is fixed to the beam."""
    if not any(joint):
        return u
    u0, u1, u2, u3, u4 = u
    k, turning = joint.stiffness - omega2 * joint.mass, joint.rotational - omega2 * joint.inertia
    u3, u4 = u3 + k * u0, u4 + k * u1
    return (u0, u1 + turning * u0, u2, u3, u4 + turning * u3)


def trial(line: Lineup, omega2: float, tension: float | None = None) -> Found:
    """What a trial value says: omega^2 over EI / (rho A L^4), or T L^2 / EI in place of the beam's own.

    Counted are the frequencies below it, rigid motions at 0 included; of a trial tension, at omega = 0, the shapes that
    the beam has buckled into.
    """
    force = line.tension if tension is None else tension
    start = [0.0] * 5
    start[4 - _END[line.supports[0]]] = 1.0
    u: Minors = _over((start[0], start[1], start[2], start[3], start[4]), line.joints[0], omega2)
    below, left = 0, line.supports[0]
    for stretch, joint in zip(line.stretches, line.joints[1:], strict=True):
        length, stiffness = stretch.length, stretch.stiffness
        c = stretch.shear * stiffness / length**2
        p = (force - stretch.turning * omega2) * length**2 / stiffness
        q = (stretch.mass * omega2 - line.foundation) * length**4 / stiffness
        by = carry(c, p, q)
        sizes = _sizes(length, stiffness)
        near = (u[0] * sizes[0], u[1] * sizes[1], u[2] * sizes[2], u[3] * sizes[3], u[4] * sizes[4])
        far = _carried(near, by, c, p, q)
        below += _own(by, c, p, q) + _at_joint(near, by, c, p, q, far[0], left)
        u = _over(_rescaled(far, sizes), joint, omega2)
        left = "free"
    right = line.supports[1]
    return Found(below + _at_end(u, right), u[_END[right]])


def _sizes(length: float, stiffness: float) -> Minors:
    """What minors are multiplied by, so that a stretch has length and stiffness 1."""
    by_moment, by_force = length**2 / stiffness, length**3 / stiffness
    return (length, by_moment, by_force, length * by_force, by_moment * by_force)


def _rescaled(u: Minors, sizes: Minors) -> Minors:
    """Minors in the beam's own units again, the largest 1 or so."""
    v = [one / size for one, size in zip(u, sizes, strict=True)]
    largest = max(map(abs, v))
    return (v[0] / largest, v[1] / largest, v[2] / largest, v[3] / largest, v[4] / largest)


def _own(by: Carry, c: float, p: float, q: float) -> int:
    """How many frequencies of a stretch with both ends clamped lie below.

    With both ends pinned it has at most two more. Their parity is that of the sign of its minor.
    """
    pinned = _pinned(c, p, q)
    corner = c * by.g2 + by.h4
    if pinned == 0 or pinned % 2 != (corner < 0.0):
        return max(pinned - 1, 0)
    return pinned if by.turn * corner > 0.0 else pinned - 2


def _pinned(c: float, p: float, q: float) -> int:
    """How many sines n pi of a stretch with both ends pinned have frequencies below, each once or twice.

    A sine of wavenumber k has one below where k^4 - (c q - p) k^2 - q (1 + p c) < 0.
    """
    half, product, gap = 0.5 * (c * q - p), -q * (1.0 + p * c), (p + c * q) ** 2 + 4.0 * q
    if gap <= 0.0:
        return 0
    root = 0.5 * sqrt(gap)
    high = half + root if half >= 0.0 else product / (half - root)
    low = product / high if half >= 0.0 and high != 0.0 else 0.0  # below nought where half is
    first, second = (floor(sqrt(square) / pi) if square > 0.0 else 0 for square in (low, high))
    twice = c > 0.0 and 1.0 + p * c < 0.0  # above the cut-off: the section's turning alone, and a second family
    return second - first + (2 * first if twice and q > 0.0 else 0) + twice


def _at_joint(u: Minors, by: Carry, c: float, p: float, q: float, ahead: float, left: str) -> int:
    """Negative eigenvalues of the stiffness at a joint: of the beam to its left, and of the stretch ahead clamped.

    ahead: p12 at the far end of that stretch, whose sign is that of the determinant.
    """
    corner = 2.0 * (c * by.g2 + by.h4) or _TINY
    force, slope, moment = (part / corner for part in (by.tip, by.g2 - (p + c * q) * by.h4, by.turn))
    if left == "clamped":
        return 0
    if left == "pinned":
        return int(u[4] / u[3] + moment < 0.0)
    if left == "guided":
        return int(u[4] / u[1] + force < 0.0)
    base = u[0] or _TINY
    ww, wp, pp = u[3] / base + force, slope - u[2] / base, u[1] / base + moment
    return _negatives(ww, wp, pp, ahead * base * corner)


def _at_end(u: Minors, support: str) -> int:
    """Negative eigenvalues of the beam's stiffness at its right end, where that is free to move."""
    base = u[0] or _TINY
    if support == "free":
        return _negatives(u[3] / base, -u[2] / base, u[1] / base, u[4] * base)
    return int(support != "clamped" and u[_END[support]] / base < 0.0)


def _negatives(a: float, b: float, d: float, determinant: float) -> int:
    """Negative eigenvalues of [[a, b], [b, d]]; the sign of its determinant is known otherwise too."""
    products = a * d, b * b
    difference = products[0] - products[1]
    sign = difference if abs(difference) > _CANCELLED * sum(products) else determinant
    return 1 if sign < 0.0 else 2 if a + d < 0.0 else 0
