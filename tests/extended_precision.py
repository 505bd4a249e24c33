"""A judge for eigenvalue solvers: how many frequencies lie below a value, counted in 50-digit arithmetic.

Sylvester's law of inertia on K - lambda M, eliminated in `decimal`. The matrices are written down here once
more, from the textbook, for uniform beams of equal parts; no solver and no model takes part.
"""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import inf
from typing import TypeAlias

from verify.beam import Beam
from verify.errors import InputError
from verify.exact.closed_forms import check_uniform

Bands: TypeAlias = list[list[Decimal]]
"""Row j holds the entries (j, j), (j, j + 1), ... up to the half bandwidth."""

DIGITS = 50
_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")
_LADDER = [Decimal(m).scaleb(e) for e in range(-16, -1) for m in (1, 2, 5)]
_GREGORY = (Decimal(3) / 8, Decimal(7) / 6, Decimal(23) / 24)


def eigenvalue_error(beam: Beam, model: str, count: int, mode: int, frequency_hz: float) -> float:
    """A bound on the relative error of a computed frequency of a discrete model, against the model itself.

    The smallest of 1e-16, 2e-16, 5e-16, ... 5e-2 such that the model's frequency of that rank lies within it;
    infinite where none does. Raises InputError for stepped beams.
    """
    check_uniform(beam)
    with localcontext() as context:
        context.prec = DIGITS
        bands = _bands_of(model)(beam.supports, count)
        omega = 2 * _PI * Decimal(frequency_hz) / Decimal(beam.wave_constant)
        root = omega * (Decimal(beam.length) / count) ** 2
        rank = mode + beam.rigid_motions
        for part in _LADDER:
            if count_below(*bands, (root * (1 - part)) ** 2) < rank <= count_below(*bands, (root * (1 + part)) ** 2):
                return float(part)
    return inf


def count_below(stiffness: Bands, mass: Bands, value: Decimal) -> int:
    """How many eigenvalues of K v = lambda M v lie below `value`: negative pivots of K - value M."""
    rows = [[k - value * m for k, m in zip(*pair, strict=True)] for pair in zip(stiffness, mass, strict=True)]
    width, negative = len(rows[0]), 0
    for j, row in enumerate(rows):
        pivot = row[0]
        negative += pivot < 0
        for i in range(1, min(width, len(rows) - j)):
            if row[i]:
                factor, below = row[i] / pivot, rows[j + i]
                for k in range(i, width):
                    below[k - i] -= factor * row[k]
    return negative


def _empty(n: int, width: int) -> Bands:
    return [[Decimal(0)] * width for _ in range(n)]


def _add(bands: Bands, at: list[int], block: list[list[Decimal]]) -> None:
    """Add a symmetric block at ascending unknowns; negative ones and those past the end are not there."""
    for i, a in enumerate(at):
        for j, b in enumerate(at):
            if 0 <= a <= b < len(bands):
                bands[a][b - a] += block[i][j]


def _outer(row: list[int], weight: Decimal) -> list[list[Decimal]]:
    return [[weight * a * b for b in row] for a in row]


def chain_bands(supports: tuple[str, str], n: int) -> tuple[Bands, Bands]:
    """K and M of N equal links over the free joint positions, Gregory's joints at clamped walls.

    EI = rho A = l = 1. Raises InputError for chains so short that the corrections of both walls overlap.
    """
    if "clamped" in supports and n < 6:
        raise InputError(f"count = {n}: the extended-precision chain is for 6 or more segments")
    first = int(supports[0] in ("pinned", "clamped"))
    unknowns = n + 1 - first - int(supports[1] in ("pinned", "clamped"))
    stiffness, mass = _empty(unknowns, 3), _empty(unknowns, 3)
    third, sixth = Decimal(1) / 3, Decimal(1) / 6
    for link in range(n):
        _add(mass, [link - first, link + 1 - first], [[third, sixth], [sixth, third]])
    for joint in range(1, n):
        at = [joint - 1 - first, joint - first, joint + 1 - first]
        _add(stiffness, at, _outer([1, -2, 1], 1 / _weight(supports, n, joint)))
    for support, end, inner in ((supports[0], 0, 1), (supports[1], n, n - 1)):
        if support in ("clamped", "guided"):
            low, high = sorted((end - first, inner - first))
            _add(stiffness, [low, high], _outer([-1, 1], 1 / _weight(supports, n, end)))
    return stiffness, mass


def _weight(supports: tuple[str, str], n: int, joint: int) -> Decimal:
    """Compliance of a joint in l/EI."""
    for support, depth in ((supports[0], joint), (supports[1], n - joint)):
        if support == "clamped" and depth < len(_GREGORY):
            return _GREGORY[depth]
        if support == "guided" and depth == 0:
            return Decimal(1) / 2
    return Decimal(1)


def hermite_bands(supports: tuple[str, str], n: int) -> tuple[Bands, Bands]:
    """K and M of N equal Hermite elements over the free nodal values, from the textbook's 4x4 matrices.

    EI = rho A = l = 1.
    """
    ke = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
    me = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    k = [[Decimal(x) for x in row] for row in ke]
    m = [[Decimal(x) / 420 for x in row] for row in me]
    held = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
    fixed = {*held[supports[0]], *(2 * n + j for j in held[supports[1]])}
    number: dict[int, int] = {}
    for unknown in range(2 * n + 2):
        if unknown not in fixed:
            number[unknown] = len(number)
    stiffness, mass = _empty(len(number), 4), _empty(len(number), 4)
    for element in range(n):
        at = [number.get(2 * element + j, -1) for j in range(4)]
        _add(stiffness, at, k)
        _add(mass, at, m)
    return stiffness, mass


def _bands_of(model: str) -> Callable[[tuple[str, str], int], tuple[Bands, Bands]]:
    """Of stiffness and mass. Raises InputError for a model whose matrices are not written out here."""
    known = {"segment": chain_bands, "fem": hermite_bands}
    if model not in known:
        raise InputError(f"model = {model!r}: eigenvalues are counted for {' and '.join(known)} alone")
    return known[model]
