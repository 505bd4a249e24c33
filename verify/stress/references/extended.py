"""Discrete models with everything that a beam may have, written out from the textbook and counted in 50 digits.

No model takes part: matrices of rigid links and of Hermite elements of any lengths and sections, with point masses,
springs, ground and axial force; `judge.extended_precision` counts their eigenvalues.
"""

from collections.abc import Mapping, Sequence
from decimal import Decimal, localcontext

import msgspec

from verify.judge.extended_precision import DIGITS, Bands, count_below

Numbers = Sequence[float | Decimal]
_HELD = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
_BENDING = ((12, 6, -12, 6), (6, 4, -6, 2), (-12, -6, 12, -6), (6, 2, -6, 4))
_INERTIA = ((156, 22, 54, -13), (22, 4, 13, -3), (54, 13, 156, -22), (-13, -3, -22, 4))
_TURNING = ((36, 3, -36, 3), (3, 4, -3, -1), (-36, -3, 36, -3), (3, -1, -3, 4))
_LEVELS = 17
"""Powers of ten from 1e-17 on in which an error is looked for."""
_HALVINGS = 7


class Divided(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A beam in parts, in any units that go together."""

    supports: tuple[str, str]
    lengths: Numbers
    """(N,)."""
    stiffnesses: Numbers
    """EI, (N,)."""
    masses: Numbers
    """Rho A, (N,)."""
    point_masses: Mapping[int, float | Decimal] = {}
    """By the node from 0."""
    springs: Mapping[int, float | Decimal] = {}
    """Lateral, by the node from 0."""
    foundation: float | Decimal = 0.0
    tension: float | Decimal = 0.0


def hermite(beam: Divided) -> tuple[Bands, Bands]:
    """K and M of Hermite elements over the free nodal values; slopes times no length."""
    n = len(beam.lengths)
    number = _numbered(beam.supports, n)
    stiffness, mass = _empty(len(number), 4), _empty(len(number), 4)
    ground, pull = Decimal(beam.foundation), Decimal(beam.tension)
    for e, (length, ei, ra) in enumerate(
        zip(*(map(Decimal, each) for each in (beam.lengths, beam.stiffnesses, beam.masses)), strict=True)
    ):
        scale = (Decimal(1), length, Decimal(1), length)
        at = [number.get(2 * e + j, -1) for j in range(4)]
        for i in range(4):
            for j in range(i, 4):
                if at[i] < 0 or at[j] < 0:
                    continue
                both = scale[i] * scale[j]
                bent = ei * _BENDING[i][j] / length**3 + pull * _TURNING[i][j] / (30 * length)
                carried = length * _INERTIA[i][j] / 420
                stiffness[at[i]][at[j] - at[i]] += both * (bent + ground * carried)
                mass[at[i]][at[j] - at[i]] += both * ra * carried
    _stand(beam, {node: number.get(2 * node, -1) for node in range(n + 1)}, stiffness, mass)
    return stiffness, mass


def links(beam: Divided) -> tuple[Bands, Bands]:
    """K and M of rigid links with joints in series over the free joint positions; pinned or free ends."""
    n = len(beam.lengths)
    first = int(beam.supports[0] == "pinned")
    unknowns = n + 1 - first - int(beam.supports[1] == "pinned")
    lengths, eis, ras = (list(map(Decimal, each)) for each in (beam.lengths, beam.stiffnesses, beam.masses))
    stiffness, mass = _empty(unknowns, 3), _empty(unknowns, 3)
    third, sixth, ground = Decimal(1) / 3, Decimal(1) / 6, Decimal(beam.foundation)
    for e in range(n):
        block = [[third, sixth], [sixth, third]]
        at = [e - first, e + 1 - first]
        _add(mass, at, [[lengths[e] * ras[e] * x for x in row] for row in block])
        _add(stiffness, at, [[lengths[e] * ground * x for x in row] for row in block])
        pull = Decimal(beam.tension) / lengths[e]
        _add(stiffness, at, [[pull, -pull], [-pull, pull]])
    for j in range(1, n):
        before, after = lengths[j - 1], lengths[j]
        spring = 1 / (before / (2 * eis[j - 1]) + after / (2 * eis[j]))
        row = [1 / before, -1 / before - 1 / after, 1 / after]
        _add(stiffness, [j - 1 - first, j - first, j + 1 - first], [[spring * a * b for b in row] for a in row])
    _stand(beam, {node: node - first for node in range(n + 1)}, stiffness, mass)
    return stiffness, mass


def relative_error(bands: tuple[Bands, Bands], rank: int, omega: float | Decimal) -> float:
    """|omega / the model's own - 1| for the eigenvalue of that rank, rigid ones counted; at least 1e-18.

    Found by bisection between counts, to one part in a hundred of the error; infinite beyond one.
    """
    with localcontext() as context:
        context.prec = DIGITS
        given = Decimal(omega)

        def below(part: Decimal) -> bool:
            return count_below(*bands, (given * (1 + part)) ** 2) < rank

        side = 1 if below(Decimal(0)) else -1  # on which side of what was given the eigenvalue lies
        low = Decimal("1e-18")
        for level in range(_LEVELS, -1, -1):
            high = Decimal(10) ** -level
            if below(side * high) != (side > 0):
                break
            low = high
        else:
            return float("inf")
        for _ in range(_HALVINGS):
            middle = (low * high).sqrt()
            low, high = (middle, high) if below(side * middle) == (side > 0) else (low, middle)
        return float(high)


def _numbered(supports: tuple[str, str], n: int) -> dict[int, int]:
    """Number of each free unknown among 2n + 2, deflection before slope."""
    fixed = {*_HELD[supports[0]], *(2 * n + j for j in _HELD[supports[1]])}
    free = [unknown for unknown in range(2 * n + 2) if unknown not in fixed]
    return {unknown: k for k, unknown in enumerate(free)}


def _stand(beam: Divided, place: Mapping[int, int], stiffness: Bands, mass: Bands) -> None:
    """Add what stands on nodes that are free."""
    for bands, given in ((mass, beam.point_masses), (stiffness, beam.springs)):
        for node, value in given.items():
            if 0 <= (at := place[node]) < len(bands):
                bands[at][0] += Decimal(value)


def _empty(n: int, width: int) -> Bands:
    return [[Decimal(0)] * width for _ in range(n)]


def _add(bands: Bands, at: list[int], block: list[list[Decimal]]) -> None:
    for i, a in enumerate(at):
        for j, b in enumerate(at):
            if 0 <= a <= b < len(bands):
                bands[a][b - a] += block[i][j]


def answered(stiffness: Bands, mass: Bands, omega2: Decimal, at: int) -> list[Decimal]:
    """V with (K - omega^2 M) v = 1 at one unknown, by elimination without exchanges."""
    with localcontext() as context:
        context.prec = DIGITS
        rows = [[k - omega2 * m for k, m in zip(*pair, strict=True)] for pair in zip(stiffness, mass, strict=True)]
        n, right = len(rows), [Decimal(int(j == at)) for j in range(len(rows))]
        for j, row in enumerate(rows):
            for i in range(1, min(len(row), n - j)):
                factor, below = row[i] / row[0], rows[j + i]
                right[j + i] -= factor * right[j]
                for k in range(i, len(row)):
                    below[k - i] -= factor * row[k]
        for j in range(n - 1, -1, -1):
            known = sum((row * right[j + i] for i, row in enumerate(rows[j][: n - j]) if i), Decimal(0))
            right[j] = (right[j] - known) / rows[j][0]
    return right
