"""Stepped beams and unequal parts against the exact transfer through the sections."""

import mpmath
import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import PAIRED
from verify.analytic_modes import ExactModel
from verify.fem_beam import HermiteModel
from verify.linear.mesh import divide, part_counts
from verify.problem.beam import Beam
from verify.problem.cross_section import Section

STEPPED = Beam(
    length=0.6,
    width=0.02,
    thickness=0.004,
    youngs_modulus=70e9,
    density=2700.0,
    supports=("clamped", "pinned"),
    section=(Section(length=0.25), Section(length=0.35, thickness=0.002, youngs_modulus=210e9, density=7850.0)),
)
CONDITIONS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


def transfer_determinant(beam, omega):
    """End conditions carried through the sections by transfer matrices of (w, w', M, Q), in extended precision."""
    transfer = mpmath.eye(4)
    for piece in beam.pieces:
        ei, mass = mpmath.mpf(piece.bending_stiffness), mpmath.mpf(piece.mass_per_length)
        b = (mass * omega**2 / ei) ** mpmath.mpf("0.25")
        y = b * mpmath.mpf(piece.length)
        ch, sh, c, s = mpmath.cosh(y), mpmath.sinh(y), mpmath.cos(y), mpmath.sin(y)
        a0, a1, a2, a3 = (ch + c) / 2, (sh + s) / (2 * b), (ch - c) / (2 * b**2), (sh - s) / (2 * b**3)
        b4 = b**4
        step = mpmath.matrix(
            [
                [a0, a1, a2 / ei, a3 / ei],
                [b4 * a3, a0, a1 / ei, a2 / ei],
                [ei * b4 * a2, ei * b4 * a3, a0, a1],
                [ei * b4 * a1, ei * b4 * a2, b4 * a3, a0],
            ]
        )
        transfer = step * transfer
    free = [k for k in range(4) if k not in CONDITIONS[beam.supports[0]]]
    held = CONDITIONS[beam.supports[1]]
    return mpmath.det(mpmath.matrix([[transfer[i, j] for j in free] for i in held]))


def near_root(beam, found):
    """The root of the transfer equation next to a frequency, Hz, from 60 digits."""
    with mpmath.workdps(60):
        omega = 2 * mpmath.pi * mpmath.mpf(found)
        near = (omega * (1 - mpmath.mpf("1e-9")), omega * (1 + mpmath.mpf("1e-9")))
        root = mpmath.findroot(lambda w: transfer_determinant(beam, w), near, tol=1e-40, verify=False)
        return float(root / (2 * mpmath.pi))


def many_sections(supports, lengths):
    """Sections of six materials and thicknesses in turn, no two neighbours alike."""
    pieces = [
        Section(
            length=part,
            thickness=1e-3 * (1 + (3 * i) % 5),
            youngs_modulus=1e9 * (60 + (37 * i) % 211),
            density=900.0 + (1300 * i) % 7700,
        )
        for i, part in enumerate(lengths)
    ]
    return Beam(
        length=sum(lengths),
        width=0.03,
        thickness=0.002,
        youngs_modulus=90e9,
        density=4100.0,
        supports=supports,
        section=tuple(pieces),
    )


@pytest.mark.parametrize(
    ("supports", "lengths"),
    [
        (("pinned", "free"), (0.11, 0.004, 0.03, 0.2, 0.007, 0.0011, 0.09, 0.05)),
        (("guided", "clamped"), (0.3, 0.0012, 0.02, 0.0009, 0.13, 0.004, 0.06, 0.11, 0.002, 0.01, 0.08)),
        (("free", "free"), (0.21, 1e-5, 0.17)),
        (("pinned", "pinned"), (0.21, 1e-6, 0.17)),
    ],
)
def test_short_sections_cost_no_digit(supports, lengths):
    """By the sign of a count alone they cost five to ten: its stiffness grows as (L / shortest section)^3."""
    beam = many_sections(supports, lengths)
    for mode in (1, 2, 7, 24):
        found = ExactModel(beam).frequency_hz(mode)
        assert found == pytest.approx(near_root(beam, found), rel=1e-14)


def test_two_frequencies_that_nearly_coincide_are_told_apart():
    """Two thin strips held by a block too heavy to move: a pair 2.4e-7 apart, each exact and none twice."""
    pair = [ExactModel(PAIRED).frequency_hz(mode) for mode in (4, 5)]
    assert pair[1] / pair[0] - 1 == pytest.approx(2.364e-7, rel=1e-3)
    for found in pair:
        with mpmath.workdps(60):
            sides = [transfer_determinant(PAIRED, 2 * mpmath.pi * found * (1 + e)) for e in (-1e-14, 1e-14)]
        assert sides[0] * sides[1] < 0


def test_no_stepped_frequency_is_missed():
    beam = replace(STEPPED, supports=("free", "free"))
    elements = HermiteModel(beam, 240).modes(25).frequencies_hz
    exact = [ExactModel(beam).frequency_hz(n) for n in range(1, 26)]
    assert elements == pytest.approx(exact, rel=1e-4)
    assert (elements > exact).all()


def order(model, mode, counts, **settings):
    exact = ExactModel(STEPPED).frequency_hz(mode)
    first, second = (
        abs(model(STEPPED, n, **settings).modes(mode).frequencies_hz[mode - 1] / exact - 1) for n in counts
    )
    return np.log(first / second) / np.log(counts[1] / counts[0])


def test_elements_that_end_on_the_steps_keep_order_four():
    assert order(HermiteModel, 4, (24, 48)) == pytest.approx(4.0, abs=0.06)
    assert order(HermiteModel, 4, (24, 48), grading=0.6) == pytest.approx(4.0, abs=0.06)


def test_parts_follow_the_sections():
    parts = divide(STEPPED, 12)
    assert parts.lengths.sum() == pytest.approx(12.0, rel=1e-14)
    assert sum(parts.moduli == 1.0) == 5
    assert parts.stiffnesses[-1] == pytest.approx(3 / 8, rel=1e-14)
    assert parts.masses_per_length[-1] == pytest.approx(7850 / 2700 / 2, rel=1e-14)
    assert part_counts([0.25, 0.35], 12) == [5, 7]
    assert part_counts([0.001, 1.0, 0.001], 5) == [1, 3, 1]
    graded = divide(STEPPED, 12, 3.0)
    assert graded.lengths[4] / graded.lengths[0] == pytest.approx(3.0, rel=1e-14)
    assert graded.nodes[5] == pytest.approx(5.0, rel=1e-13)
