"""References of the stress checks: the beams, textbook matrices, eigenvalue counts and functions in 60 digits.

No model and no solver of the package takes part. `Check.run` sets the digits.
"""

from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from itertools import combinations_with_replacement
from typing import Any, TypeAlias

import numpy as np
from msgspec.structs import replace

from verify.problem.beam import Beam

D = Decimal
PI = D("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803")
Bands: TypeAlias = list[list[D]]
"""Row j holds the entries (j, j), (j, j + 1), ... up to the half bandwidth."""
_BENDING = ((12, 6, -12, 6), (6, 4, -6, 2), (-12, -6, 12, -6), (6, 2, -6, 4))
_MASS = ((156, 22, 54, -13), (22, 4, 13, -3), (54, 13, 156, -22), (-13, -3, -22, 4))
_TENSION = ((36, 3, -36, 3), (3, 4, -3, -1), (-36, -3, 36, -3), (3, -1, -3, 4))
_FIXED = {"pinned": (0,), "clamped": (0, 1), "free": ()}
_GREGORY = (D(3) / 8, D(7) / 6, D(23) / 24)
"""Compliance of the first joints from a wall over that of equal links in series."""

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
"""A titanium strip between pins."""
CANTILEVER = replace(STRIP, supports=("clamped", "free"))
FREE = replace(STRIP, supports=("free", "free"))
DISCRETE = {"segment": "segments", "fem": "elements"}
ALL = ("analytic", *DISCRETE)


def equal(beam: Beam, n: int) -> list[D]:
    """Lengths of n equal parts, m."""
    return [D(beam.length) / n] * n


def _parts(beam: Beam, lengths: Sequence[D]) -> Iterator[tuple[D, D, D]]:
    """(length, EI, rho A) of each part."""
    sizes = np.array(lengths, float)
    owners = np.searchsorted(np.cumsum([piece.length for piece in beam.pieces]), np.cumsum(sizes) - 0.5 * sizes)
    for h, i in zip(lengths, owners, strict=True):
        yield h, D(beam.pieces[i].bending_stiffness), D(beam.pieces[i].mass_per_length)


def _attach(beam: Beam, lengths: Sequence[D], k: Bands, m: Bands, row: Callable[[int], int]) -> None:
    nodes = np.cumsum([0.0, *map(float, lengths)])
    masses, springs = [(one.position, one.mass) for one in beam.mass], [(s.position, s.stiffness) for s in beam.spring]
    for bands, attached in ((m, masses), (k, springs)):
        for x, value in attached:
            bands[row(int(np.argmin(abs(nodes - x))))][0] += D(value)


def hermite(beam: Beam, lengths: Sequence[D]) -> tuple[Bands, Bands]:
    """K and M of cubic elements with consistent mass over the free nodal values, deflection before slope."""
    n, (left, right), tension, foundation = len(lengths), beam.supports, D(beam.tension), D(beam.foundation)
    fixed = {*_FIXED[left], *(2 * n + j for j in _FIXED[right])}
    number = {u: k for k, u in enumerate(u for u in range(2 * n + 2) if u not in fixed)}
    k, m = ([[D(0)] * 4 for _ in number] for _ in range(2))
    for e, (h, ei, ra) in enumerate(_parts(beam, lengths)):
        for i, j in combinations_with_replacement(range(4), 2):
            p, q = number.get(2 * e + i), number.get(2 * e + j)
            if p is not None and q is not None:
                both, carried = h ** (i % 2 + j % 2), h * _MASS[i][j] / 420
                bending = ei * _BENDING[i][j] / h**3 + tension * _TENSION[i][j] / (30 * h)
                k[p][q - p] += both * (bending + foundation * carried)
                m[p][q - p] += both * ra * carried
    _attach(beam, lengths, k, m, lambda node: number[2 * node])
    return k, m


def links(beam: Beam, lengths: Sequence[D]) -> tuple[Bands, Bands]:
    """K and M of rigid links over the free joint deflections, joint springs in series, a wall at the left at most."""
    n, (left, right), parts = len(lengths), beam.supports, list(_parts(beam, lengths))
    k, m = ([[D(0)] * 3 for _ in range(n + 1)] for _ in range(2))

    def add(bands: Bands, first: int, row: tuple[D, ...], weight: D) -> None:
        for i, j in combinations_with_replacement(range(len(row)), 2):
            bands[first + i][j - i] += weight * row[i] * row[j]

    for e, (h, _, ra) in enumerate(parts):
        tilt = (-1 / h, 1 / h)
        for bands, line in ((m, ra), (k, D(beam.foundation))):
            add(bands, e, (D("0.5"), D("0.5")), h * line)
            add(bands, e, tilt, h**3 / 12 * line)
        add(k, e, tilt, h * D(beam.tension))
    for j, ((a, ei, _), (b, next_ei, _)) in enumerate(zip([parts[-1], *parts[:-1]], parts, strict=True)):
        compliance = a / (2 * ei) + b / (2 * next_ei)
        if left == "clamped" and j < len(_GREGORY):
            compliance *= _GREGORY[j]
        if j:
            add(k, j - 1, (1 / a, -1 / a - 1 / b, 1 / b), 1 / compliance)
        elif left == "clamped":
            add(k, 0, (-1 / b, 1 / b), 1 / compliance)
    _attach(beam, lengths, k, m, lambda node: node)
    free = slice(left != "free", n if right != "free" else n + 1)
    return k[free], m[free]


MATRICES = {"segment": links, "fem": hermite}


def _eliminate(k: Bands, m: Bands, omega2: D, right: list[D] | None = None) -> tuple[Bands, int]:
    """K - omega^2 M eliminated without pivoting, and its number of negative pivots."""
    rows = [[a - omega2 * b for a, b in zip(*pair, strict=True)] for pair in zip(k, m, strict=True)]
    for j, row in enumerate(rows):
        for i in range(1, min(len(row), len(rows) - j)):
            factor = row[i] / row[0]
            if right is not None:
                right[j + i] -= factor * right[j]
            for c in range(i, len(row)):
                rows[j + i][c - i] -= factor * row[c]
    return rows, sum(row[0] < 0 for row in rows)


def relative_error(k: Bands, m: Bands, mode: int, omega: D | float) -> float:
    """|omega / omega_mode - 1|, at least 1e-18, to one part in a hundred; infinite from 1 on.

    Bisection between eigenvalue counts, the negative pivots of K - omega^2 M (Sylvester's law of inertia).
    """

    def below(part: D) -> bool:
        return _eliminate(k, m, (D(omega) * (1 + part)) ** 2)[1] < mode

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
    v = [D(int(j == at)) for j in range(len(k))]
    rows, _ = _eliminate(k, m, omega**2, v)
    for j in reversed(range(len(rows))):
        known = sum((a * v[j + i] for i, a in enumerate(rows[j]) if i and j + i < len(rows)), D(0))
        v[j] = (v[j] - known) / rows[j][0]
    return v


def sparse(bands: Bands) -> Any:
    """The symmetric matrix in double precision, scipy.sparse."""
    from scipy.sparse import diags_array

    upper = [[float(row[c]) for row in bands[: len(bands) - c]] for c in range(len(bands[0]))]
    return diags_array([*upper, *upper[1:]], offsets=[*range(len(upper)), *range(-1, -len(upper), -1)]).tocsc()


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


def pinned_hertz(beam: Beam, mode: int) -> D:
    """((EI beta^2 + T) beta^2 + k) / (rho A) = omega^2, beta = n pi / L."""
    square = (mode * PI / D(beam.length)) ** 2
    stiffness = (D(beam.bending_stiffness) * square + D(beam.tension)) * square + D(beam.foundation)
    return (stiffness / D(beam.mass_per_length)).sqrt() / (2 * PI)


def cantilever_root(mode: int) -> D:
    """Y with cos y cosh y = -1, by Newton on the equation over e^y."""
    y = (D(mode) - D("0.5")) * PI
    for _ in range(12):
        fall = (-y).exp()
        rest = cos(y) * (1 + fall * fall) + 2 * fall
        y -= rest / (cos(y) * (1 - fall * fall) - sin(y) * (1 + fall * fall))
    return y
