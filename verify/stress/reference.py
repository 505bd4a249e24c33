"""References of the stress checks: the beams, textbook matrices, eigenvalue counts and functions in 60 digits.

No model and no solver of the package takes part. `Check.run` sets the digits.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from itertools import combinations_with_replacement
from typing import Any, TypeAlias

from msgspec.structs import replace

from verify.problem.beam import Beam

D = Decimal
PI = D("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803")
Bands: TypeAlias = list[list[D]]
"""Row j holds the entries (j, j), (j, j + 1), ... up to the half bandwidth."""
_BENDING = ((12, 6, -12, 6), (6, 4, -6, 2), (-12, -6, 12, -6), (6, 2, -6, 4))
_MASS = ((156, 22, 54, -13), (22, 4, 13, -3), (54, 13, 156, -22), (-13, -3, -22, 4))
_TENSION = ((36, 3, -36, 3), (3, 4, -3, -1), (-36, -3, 36, -3), (3, -1, -3, 4))
_FIXED: dict[str, tuple[int, ...]] = {"pinned": (0,), "clamped": (0, 1), "free": ()}
_GREGORY = (D(3) / 8, D(7) / 6, D(23) / 24)
"""Compliance of the first joints from a wall over that of equal links in series."""

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
"""A titanium strip between pins."""
CANTILEVER = replace(STRIP, supports=("clamped", "free"))
FREE = replace(STRIP, supports=("free", "free"))


@dataclass(frozen=True)
class Parts:
    """A beam in parts, SI units; point masses and springs by node."""

    supports: tuple[str, str]
    lengths: Sequence[D]
    ei: Sequence[D]
    ra: Sequence[D]
    masses: Mapping[int, float] = field(default_factory=dict)
    springs: Mapping[int, float] = field(default_factory=dict)
    foundation: D | int = 0
    tension: D | int = 0


def equal(beam: Beam, n: int, **attached: Any) -> Parts:
    """N equal parts of a uniform beam with its foundation and tension; `attached` are `masses` and `springs`."""
    one = D(beam.length) / n, D(beam.bending_stiffness), D(beam.mass_per_length)
    lengths, ei, ra = ([value] * n for value in one)
    more = {"foundation": D(beam.foundation), "tension": D(beam.tension), **attached}
    return Parts(beam.supports, lengths, ei, ra, **more)


def hermite(parts: Parts) -> tuple[Bands, Bands]:
    """K and M of cubic elements with consistent mass over the free nodal values, deflection before slope."""
    n = len(parts.lengths)
    fixed = {*_FIXED[parts.supports[0]], *(2 * n + j for j in _FIXED[parts.supports[1]])}
    number = {u: k for k, u in enumerate(u for u in range(2 * n + 2) if u not in fixed)}
    k, m = ([[D(0)] * 4 for _ in number] for _ in range(2))
    for e, (h, ei, ra) in enumerate(zip(parts.lengths, parts.ei, parts.ra, strict=True)):
        scale = (1, h, 1, h)
        for i, j in combinations_with_replacement(range(4), 2):
            p, q = number.get(2 * e + i), number.get(2 * e + j)
            if p is not None and q is not None:
                both, carried = scale[i] * scale[j], h * _MASS[i][j] / 420
                bending = ei * _BENDING[i][j] / h**3 + parts.tension * _TENSION[i][j] / (30 * h)
                k[p][q - p] += both * (bending + parts.foundation * carried)
                m[p][q - p] += both * ra * carried
    _attach(parts, k, m, lambda node: number[2 * node])
    return k, m


def links(parts: Parts) -> tuple[Bands, Bands]:
    """K and M of rigid links over the free joint deflections, joint springs in series, a wall at the left at most."""
    n, (left, right) = len(parts.lengths), parts.supports
    k, m = ([[D(0)] * 3 for _ in range(n + 1)] for _ in range(2))

    def add(bands: Bands, first: int, row: tuple[D, ...], weight: D) -> None:
        for i, a in enumerate(row):
            for j, b in enumerate(row[i:]):
                bands[first + i][j] += weight * a * b

    for e, (h, ra) in enumerate(zip(parts.lengths, parts.ra, strict=True)):
        middle, tilt = (D("0.5"), D("0.5")), (-1 / h, 1 / h)
        for bands, line in ((m, ra), (k, parts.foundation)):
            add(bands, e, middle, h * line)
            add(bands, e, tilt, h**3 / 12 * line)
        add(k, e, tilt, h * parts.tension)
    for j in range(n):
        a, b = parts.lengths[j - 1], parts.lengths[j]
        compliance = a / (2 * parts.ei[j - 1]) + b / (2 * parts.ei[j])
        if left == "clamped" and j < len(_GREGORY):
            compliance *= _GREGORY[j]
        if j:
            add(k, j - 1, (1 / a, -1 / a - 1 / b, 1 / b), 1 / compliance)
        elif left == "clamped":
            add(k, 0, (-1 / b, 1 / b), 1 / compliance)
    _attach(parts, k, m, lambda node: node)
    kept = slice(left != "free", n if right != "free" else n + 1)
    return k[kept], m[kept]


def _attach(parts: Parts, k: Bands, m: Bands, row: Callable[[int], int]) -> None:
    for bands, values in ((m, parts.masses), (k, parts.springs)):
        for node, value in values.items():
            bands[row(node)][0] += D(value)


MATRICES = {"segment": links, "fem": hermite}


def _shifted(k: Bands, m: Bands, omega2: D) -> Bands:
    return [[a - omega2 * b for a, b in zip(*pair, strict=True)] for pair in zip(k, m, strict=True)]


def _eliminate(rows: Bands, right: list[D] | None = None) -> int:
    """Eliminate in place without pivoting; the number of negative pivots."""
    negative = 0
    for j, row in enumerate(rows):
        negative += row[0] < 0
        for i in range(1, min(len(row), len(rows) - j)):
            factor = row[i] / row[0]
            if right is not None:
                right[j + i] -= factor * right[j]
            for c in range(i, len(row)):
                rows[j + i][c - i] -= factor * row[c]
    return negative


def relative_error(k: Bands, m: Bands, mode: int, omega: D | float) -> float:
    """|omega / omega_mode - 1|, at least 1e-18, to one part in a hundred; infinite from 1 on.

    Bisection between eigenvalue counts, the negative pivots of K - omega^2 M (Sylvester's law of inertia).
    """
    omega = D(omega)

    def below(part: D) -> bool:
        return _eliminate(_shifted(k, m, (omega * (1 + part)) ** 2)) < mode

    side = 1 if below(D(0)) else -1
    low = high = D("1e-18")
    while below(side * high) == (side > 0):
        low, high = high, high * 10
        if high > 1:
            return float("inf")
    for _ in range(7):
        middle = (low * high).sqrt()
        low, high = (middle, high) if below(side * middle) == (side > 0) else (low, middle)
    return float(high)


def response(k: Bands, m: Bands, omega: D, at: int) -> list[D]:
    """V with (K - omega^2 M) v = 1 at one unknown."""
    rows, v = _shifted(k, m, omega**2), [D(int(j == at)) for j in range(len(k))]
    _eliminate(rows, v)
    for j in range(len(rows) - 1, -1, -1):
        known = sum((a * v[j + i] for i, a in enumerate(rows[j]) if i and j + i < len(rows)), D(0))
        v[j] = (v[j] - known) / rows[j][0]
    return v


def sparse(bands: Bands) -> Any:
    """The symmetric matrix in double precision, scipy.sparse."""
    from scipy.sparse import diags_array

    upper = [[float(row[c]) for row in bands[: len(bands) - c]] for c in range(len(bands[0]))]
    offsets = range(len(upper))
    return diags_array([*upper, *upper[1:]], offsets=[*offsets, *(-c for c in offsets[1:])]).tocsc()


def sin(x: D | float) -> D:
    """Of radians."""
    turns = (D(x) / PI).to_integral_value()
    rest = D(x) - turns * PI
    term, total, k = rest, rest, 1
    while abs(term) > D("1e-60"):
        term *= -rest * rest / ((k + 1) * (k + 2))
        total, k = total + term, k + 2
    return total if int(turns) % 2 == 0 else -total


def cos(x: D | float) -> D:
    """Of radians."""
    return sin(D(x) + PI / 2)


def sinh(x: D | float) -> D:
    """Of arguments from 1e-20 on, to 40 digits."""
    return (D(x).exp() - (-D(x)).exp()) / 2


def cantilever_root(mode: int) -> D:
    """Y with cos y cosh y = -1, by Newton on the equation over e^y."""
    y = (D(mode) - D("0.5")) * PI
    for _ in range(12):
        fall = (-y).exp()
        rest = cos(y) * (1 + fall * fall) + 2 * fall
        y -= rest / (cos(y) * (1 - fall * fall) - sin(y) * (1 + fall * fall))
    return y
