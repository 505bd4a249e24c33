"""Bodies within a few links of an end or of each other: as the beam has them, to order 4, and in a statics of their own."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes as exact_modes
from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.segments.attached import felt_at
from verify.segments.crowded import _groups
from verify.segments.linear import solve_modes

STRIP = Beam(length=1.2, width=0.03, thickness=0.003, youngs_modulus=200e9, density=7800.0)
BRACKET = replace(
    STRIP, supports=("clamped", "clamped"), mass=(PointMass(position=0.013, mass=3.0, rotary_inertia=1e-2),)
)
FLANGES = replace(
    STRIP,
    supports=("pinned", "free"),
    mass=(
        PointMass(position=0.5, mass=0.3, rotary_inertia=1e-3),
        PointMass(position=0.503, mass=0.2, rotary_inertia=2e-3),
    ),
)


def errors(beam, count, modes=5, **settings):
    exact = np.array(exact_modes.solve_modes(beam, modes).frequencies_hz)
    return np.array(solve_modes(beam, modes, count, **settings).frequencies_hz) / exact - 1.0


@pytest.mark.parametrize(
    ("beam", "count", "worst"),
    [
        (BRACKET, 15, 0.03),
        (BRACKET, 30, 3e-4),
        (BRACKET, 60, 2e-4),
        (BRACKET, 120, 2e-6),
        (FLANGES, 30, 4e-4),
        (FLANGES, 60, 3e-5),
        (FLANGES, 240, 2e-8),
    ],
)
def test_a_bracket_beside_a_wall_and_two_flanges_together_move_as_on_the_beam(beam, count, worst):
    """Each by its own weights alone they were off by up to 34 % and by 0.5 %, and by order 0.5."""
    assert abs(errors(beam, count)).max() < worst


def test_two_flanges_closer_than_a_link_keep_order_four():
    coarse, fine = (abs(errors(FLANGES, n))[3] for n in (30, 120))
    assert np.log2(coarse / fine) / 2 > 3.9


def alone(chain, positions, rule):
    return felt_at(chain, positions, rule)


def strewn(draw):
    """A beam with bodies and a spring anywhere, on any supports that hold it or not."""
    supports = tuple(str(one) for one in draw.choice(["pinned", "clamped", "free", "guided"], 2))
    places = draw.uniform(0.005, 1.195, 4)
    masses = tuple(
        PointMass(position=float(x), mass=float(m), rotary_inertia=float(j))
        for x, m, j in zip(places[:3], 10 ** draw.uniform(-2, 0.6, 3), 10 ** draw.uniform(-5, -1.5, 3), strict=True)
    )
    spring = PointSpring(
        position=float(places[3]), stiffness=float(10 ** draw.uniform(2, 7)), rotational=float(10 ** draw.uniform(0, 4))
    )
    return replace(STRIP, supports=supports, mass=masses[: int(draw.integers(1, 4))], spring=(spring,))


@pytest.mark.parametrize("seed", range(30))
def test_bodies_anywhere_are_within_half_a_per_cent_at_forty_links(seed):
    """Five modes; alone 5 % of such beams were over 1 % off, the worst by 13 %."""
    beam = strewn(np.random.default_rng(7000 + seed))
    assert abs(errors(beam, 40)).max() < 5e-3


def test_bodies_that_come_together_are_one_body():
    apart = [
        solve_modes(replace(FLANGES, mass=(FLANGES.mass[0], replace(FLANGES.mass[1], position=0.5 + off))), 4, 31)
        for off in (1e-7, 0.0)
    ]
    assert apart[0].frequencies_hz == pytest.approx(apart[1].frequencies_hz, rel=1e-5)


@pytest.mark.parametrize("supports", [("clamped", "free"), ("pinned", "guided"), ("free", "free")])
def test_bodies_crowd_each_other_and_an_end_alike_from_either_side(supports):
    """One or two on 40 links, at joints and between, at ends; 25 links in the middle are far from both ends."""
    n = 40
    for places in ([k / 4.0] for k in range(4 * n + 1)):
        mirrored = [n - place for place in places]
        assert list(_groups(n, supports, places)) == list(_groups(n, supports[::-1], mirrored))
    for gap in (k / 4.0 for k in range(60)):
        there, back = [14.25, 14.25 + gap], [n - 14.25, n - 14.25 - gap]
        one, other = list(_groups(n, supports, there)), list(_groups(n, supports[::-1], back))
        assert sorted(map(sorted, one)) == sorted(map(sorted, other))
    alone = [place for place in range(n + 1) if not list(_groups(n, supports, [float(place)]))]
    assert set(range(15, 26)) <= set(alone)
