"""References of the stress checks: the beams, textbook matrices, eigenvalue counts and functions in 60 digits.

No model and no solver of the package takes part. `Check.run` sets the digits.
"""

from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from typing import Any, TypeAlias

import numpy as np
from msgspec.structs import replace
from scipy.sparse import diags_array

from verify.problem.beam import Beam

D = Decimal
PI = D("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803")
BLOCKED = D("1e99")  # diagonal entry of K at an unknown that a support blocks
Bands: TypeAlias = Any
"""Array of Decimal; row j holds the entries (j, j), (j, j + 1), ... up to the half bandwidth."""
_BENDING = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], object)
_MASS = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]], object)
_TENSION = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]], object)
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


def _add(bands: Bands, first: int, block: Any) -> None:
    for i, row in enumerate(block):
        bands[first + i, : len(row) - i] += row[i:]


def _attach(beam: Beam, lengths: Sequence[D], k: Bands, m: Bands, per_node: int) -> tuple[Bands, Bands]:
    """Add masses and springs at the nodes, and constrain the unknowns that supports prevent."""
    nodes = np.cumsum([0.0, *map(float, lengths)])
    for one in beam.attached:
        row = per_node * int(np.argmin(abs(nodes - one.position)))
        m[row, 0] += D(one.mass)
        k[row, 0] += D(one.stiffness)
    for first, support in zip((0, per_node * len(lengths)), beam.supports, strict=True):
        k[first : first + {"free": 0, "pinned": 1, "clamped": per_node}[support], 0] = BLOCKED
    return k, m


def hermite(beam: Beam, lengths: Sequence[D]) -> tuple[Bands, Bands]:
    """K and M of cubic elements with consistent mass over the nodal values, deflection before slope."""
    k, m = np.full((2, 2 * len(lengths) + 2, 4), D(0))
    for e, (h, ei, ra) in enumerate(_parts(beam, lengths)):
        both = np.outer([1, h, 1, h], [1, h, 1, h])
        carried = both * _MASS * (h / 420)
        bending = both * (ei / h**3 * _BENDING + D(beam.tension) / (30 * h) * _TENSION)
        _add(k, 2 * e, bending + D(beam.foundation) * carried)
        _add(m, 2 * e, ra * carried)
    return _attach(beam, lengths, k, m, 2)


def links(beam: Beam, lengths: Sequence[D]) -> tuple[Bands, Bands]:
    """K and M of rigid links over the joint deflections, joint springs in series, a wall at the left at most."""
    k, m = np.full((2, len(lengths) + 1, 3), D(0))
    parts = list(_parts(beam, lengths))
    for e, (h, _, ra) in enumerate(parts):
        tilt = np.outer([-1 / h, 1 / h], [-1 / h, 1 / h])
        inertia = h / 4 + h**3 / 12 * tilt
        _add(m, e, ra * inertia)
        _add(k, e, D(beam.foundation) * inertia + D(beam.tension) * h * tilt)
    wall = beam.supports[0] == "clamped"
    for j, ((a, ei, _), (b, next_ei, _)) in enumerate(zip([parts[0], *parts[:-1]], parts, strict=True)):
        compliance = (a / ei + b / next_ei) / 2 * (_GREGORY[j] if wall and j < len(_GREGORY) else 1)
        bend = np.array([1 / a, -1 / a - 1 / b, 1 / b] if j else [-1 / b, 1 / b])
        if j or wall:
            _add(k, max(j - 1, 0), np.outer(bend, bend) / compliance)
    return _attach(beam, lengths, k, m, 1)


MATRICES: dict[str, Callable[[Beam, Sequence[D]], tuple[Bands, Bands]]] = {"segment": links, "fem": hermite}


def _eliminate(k: Bands, m: Bands, omega2: D, right: list[D] | None = None) -> Bands:
    """K - omega^2 M eliminated without pivoting."""
    rows = k - omega2 * m
    for j, row in enumerate(rows):
        for i in range(1, min(len(row), len(rows) - j)):
            factor = row[i] / row[0]
            rows[j + i, : len(row) - i] -= factor * row[i:]
            if right is not None:
                right[j + i] -= factor * right[j]
    return rows


def relative_error(k: Bands, m: Bands, mode: int, omega: D | float) -> float:
    """|omega / omega_mode - 1|, at least 1e-18, to one part in a hundred; infinite from 1 on.

    Bisection between eigenvalue counts, the negative pivots of K - omega^2 M (Sylvester's law of inertia).
    """

    def below(part: D) -> bool:
        return bool((_eliminate(k, m, (D(omega) * (1 + part)) ** 2)[:, 0] < 0).sum() < mode)

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
    rows = _eliminate(k, m, omega**2, v)
    for j in reversed(range(len(rows))):
        v[j] = (v[j] - sum(a * b for a, b in zip(rows[j][1:], v[j + 1 :], strict=False))) / rows[j][0]
    return v


def sparse(k: Bands, m: Bands) -> list[Any]:
    """K and M of the free unknowns in double precision, scipy.sparse."""
    moves, matrices = k[:, 0] < BLOCKED, []
    for bands in (k, m):
        upper = [bands[: len(bands) - c, c].astype(float) for c in range(bands.shape[1])]
        both = diags_array([*upper, *upper[1:]], offsets=[*range(len(upper)), *range(-1, -len(upper), -1)])
        matrices.append(both.tocsc()[moves][:, moves])
    return matrices


def sin(x: D | float) -> D:
    """Sine of radians."""
    turns = (D(x) / PI).to_integral_value()
    rest = term = total = D(x) - turns * PI
    k = 1
    while abs(term) > D("1e-60"):
        term *= -rest * rest / ((k + 1) * (k + 2))
        total, k = total + term, k + 2
    return total if int(turns) % 2 == 0 else -total


def cos(x: D | float) -> D:
    """Cosine of radians."""
    return sin(D(x) + PI / 2)


def sinh(x: D | float) -> D:
    """Hyperbolic sine of arguments from 1e-20 on, to 40 digits."""
    return (D(x).exp() - (-D(x)).exp()) / 2


def cantilever_root(mode: int) -> D:
    """Root y of cos y cosh y = -1, by Newton's method for the equation over e^y."""
    y = (D(mode) - D("0.5")) * PI
    for _ in range(12):
        fall = (-y).exp()
        rest = cos(y) * (1 + fall * fall) + 2 * fall
        y -= rest / (cos(y) * (1 - fall * fall) - sin(y) * (1 + fall * fall))
    return y


def pinned_hertz(beam: Beam, mode: int) -> D:
    """((EI beta^2 + T) beta^2 + k) / (rho A) = omega^2, beta = n pi / L."""
    square = (mode * PI / D(beam.length)) ** 2
    stiffness = (D(beam.bending_stiffness) * square + D(beam.tension)) * square + D(beam.foundation)
    return (stiffness / D(beam.mass_per_length)).sqrt() / (2 * PI)
