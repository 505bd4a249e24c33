"""The minors carried over one stretch against 2 x 2 minors of its transfer, in extended precision."""

from itertools import combinations

import mpmath
import pytest

from verify.exact import minors

PAIRS = [(0, 1), (0, 2), (0, 3), (1, 3), (2, 3)]

CASES = {
    "short": (0.0, 0.0, 0.7),
    "static under tension": (0.0, 1.3, 0.0),
    "long": (0.0, 0.0, 6.1e4),
    "hardly waving": (0.0, 0.0, 1e-7),
    "under tension": (0.0, 40.0, 900.0),
    "a cable": (0.0, 3e4, 7e6),
    "compressed": (0.0, -31.0, 12.0),
    "on a foundation": (0.0, 0.0, -800.0),
    "compressed on a foundation, nearly buckled": (0.0, -2 * 800.0**0.5 * (1 - 1e-9), -800.0),
    "pulled on a foundation, nearly alike": (0.0, 2 * 800.0**0.5 * (1 + 1e-9), -800.0),
    "pulled hard on a foundation": (0.0, 300.0, -800.0),
    "at the foundation's own frequency": (0.0, 0.0, 0.0),
    "thick": (0.03, -2.2, 310.0),
    "thick, below the cut-off by little": (0.03, -(1 - 1e-9) / 0.03, 310.0),
    "thick, above the cut-off": (0.03, -71.0, 9100.0),
    "thick and far above it": (0.01, -9e3, 2e6),
    "thick with both waves alike": (0.02, -2000.0, 2000.0 / 0.02 * 1.0001),
    "short and thick": (4.0, -0.03, 0.8),
    "thick on a foundation": (0.05, -1.0, -600.0),
}


def exact_minors(c, p, q):
    """Minors (i) of the transfer of (w, psi, M, V) by pairs of columns (j), (5, 5)."""
    c, p, q = (mpmath.mpf(v) for v in (c, p, q))
    rate = mpmath.matrix([[0, 1, 0, -c], [0, 0, 1, 0], [0, p, 0, 1], [q, 0, 0, 0]])
    transfer = mpmath.expm(rate, method="taylor")

    def minor(rows, columns):
        (a, b), (d, e) = rows, columns
        return transfer[a, d] * transfer[b, e] - transfer[a, e] * transfer[b, d]

    columns = {pair: [minor(rows, pair) for rows in PAIRS] for pair in combinations(range(4), 2)}
    columns[0, 3] = [one + other for one, other in zip(columns[0, 3], columns[1, 2], strict=True)]
    return [columns[pair] for pair in PAIRS]


@pytest.mark.parametrize("case", CASES)
def test_minors_are_carried_as_those_of_the_transfer(case):
    """Each of them to 1e-13 of the largest that comes of the same start, one positive factor for all."""
    c, p, q = CASES[case]
    by = minors.carry(c, p, q)
    with mpmath.workdps(250):
        exact = exact_minors(c, p, q)
        growth = exact[4][0] / mpmath.mpf(2 * (c * by.g2 + by.h4))  # what both ends clamped have
        for start in range(5):
            unit = tuple(float(i == start) for i in range(5))
            found = minors._carried(unit, by, c, p, q)
            expected = [float(one / growth) for one in exact[start]]
            scales = [abs(value) for value in expected]
            for i in range(5):
                assert found[i] == pytest.approx(expected[i], rel=1e-12, abs=1e-13 * max(scales) * weight(i, c, p, q))
    assert growth > 0


def weight(i, c, p, q):
    """Of a minor beside the others: its power of the wavenumber."""
    k = max(abs(p) + abs(c * q), abs(q) ** 0.5, 1.0) ** 0.5
    return k ** ([0, 1, 2, 3, 4][i] - 4)


def test_the_two_forms_of_a_stretch_meet_where_one_gives_way_to_the_other():
    for c, p, q in ((0.0, 0.9, 4.99), (0.3, -1.1, 3.7), (0.0, -2.0, -0.4)):
        square = max(abs(p - c * q), abs(q * (1 + p * c)) ** 0.5)
        below, above = (minors._SHORT / square * (1 + side * 1e-12) for side in (-1, 1))
        forms = [minors.carry(c / s, p * s, q * s * s) for s in (below, above)]
        sizes = [form.one for form in forms]
        for one, other in zip(*forms, strict=True):
            assert one / sizes[0] == pytest.approx(other / sizes[1], rel=2e-11)
