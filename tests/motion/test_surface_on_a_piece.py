"""What the compiled surface tells of one piece, beside a surface that is written down here and moved by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted
from mpmath import mp

from verify.motion import surface_kernels
from verify.motion.records import BEFORE, DRIFT, LEVEL, MOVING, PULL, STILL, SURFACE, Here

EDGES = np.array([-0.3, 0.17, 0.193, 0.4])
PIECE, X, HALF = 1, 0.1791, 6e-4
LENGTH = EDGES[2] - EDGES[1]
LOCAL = np.zeros((3, 5))
LOCAL[STILL] = [3e-6, -2.1e-5, 1.4e-5, 0.8e-5, -0.5e-5]
LOCAL[MOVING] = [0.011, 0.023, -0.031, 0.017, 0.009]
LOCAL[BEFORE] = LOCAL[STILL] - 1e-5 * LOCAL[MOVING] * [1.0, 0.7, 1.2, 0.9, 1.1]
"""Slopes of 1e-3 and bends that turn the surface by 1e-4 over its half thickness: what is left out is their product."""


def line(row, x, derivative=0):
    """Of the mid-line's coefficients, over x in metres."""
    at, n = (mp.mpf(x) - mp.mpf(EDGES[PIECE])) / mp.mpf(LENGTH), derivative
    terms = (mp.mpf(c) * mp.ff(d, n) * at ** (d - n) for d, c in enumerate(row.tolist()) if d >= n)
    return sum(terms) / mp.mpf(LENGTH) ** n


def under(row, x):
    """The material place whose point of the surface stands over x: X - (h/2) w'(X) = x."""
    return mp.findroot(lambda place: place - HALF * line(row, place, 1) - x, x)


def level(row, x):
    return line(row, under(row, x))


def seen(**law):
    told = np.zeros((1, 12))
    interpreted(surface_kernels, "touch")(LOCAL, EDGES, PIECE, X, 0.7, SimpleNamespace(half=HALF, **law), told, 0)
    return told[0]


def tangent(row):
    """Along the surface where it stands over X."""
    place = under(row, X)
    along = np.array([1 - HALF * line(row, place, 2), line(row, place, 1)], dtype=float)
    return along / np.hypot(*along)


def test_the_material_under_a_place_is_where_the_lean_of_its_section_puts_it():
    found = interpreted(surface_kernels, "material")(LOCAL, EDGES, PIECE, X, HALF)
    exact = float((under(LOCAL[STILL], X) - EDGES[PIECE]) / LENGTH)
    plain = (X - EDGES[PIECE]) / LENGTH
    assert found - plain == pytest.approx(exact - plain, rel=2e-3)
    assert abs(exact - plain) > 1e-6


def test_a_surface_moves_as_its_material_does_along_its_tangent():
    place, told = under(LOCAL[STILL], X), seen(following=False, gravity=9.0)
    moves = np.array([-HALF * line(LOCAL[MOVING], place, 1), line(LOCAL[MOVING], place)], dtype=float)
    assert told[SURFACE] == pytest.approx(moves @ tangent(LOCAL[STILL]), rel=2e-6)
    assert told[LEVEL] == pytest.approx(float(level(LOCAL[STILL], X)), rel=1e-6)
    assert told[PULL] == told[DRIFT] == 0.0


def test_what_follows_the_surface_is_pulled_by_its_slope_and_its_turning():
    """By Lagrange's equation of a point on y = w(x, t), to the second order: V = x' + w' w_t is kept but for its rate."""
    place, told = under(LOCAL[STILL], X), seen(following=True, gravity=9.0)
    slope, bend = (float(line(LOCAL[STILL], place, n)) for n in (1, 2))
    rise, turn = (float(line(LOCAL[MOVING], place, n)) for n in (0, 1))
    assert told[PULL] == pytest.approx(rise * (turn + bend * 0.7) - 9.0 * slope, rel=1e-6)
    assert told[DRIFT] == pytest.approx(-slope * rise, rel=1e-6)


@pytest.mark.parametrize("along", [0.0, 0.8, -2.3])
def test_a_point_that_moves_along_a_moving_surface_climbs_as_fast_as_what_is_under_it(along):
    def height(time):
        return level(LOCAL[STILL] + float(time) * LOCAL[MOVING], X + along * time)

    found = interpreted(surface_kernels, "climb")(LOCAL, EDGES, PIECE, X, along, HALF)
    with mp.workdps(30):
        step = mp.mpf(2) ** -20
        exact = float((height(step) - height(-step)) / (2 * step))
    assert found == pytest.approx(exact, rel=1e-7)


def test_a_surface_lifts_and_carries_in_a_step_as_far_as_it_has_moved():
    above = (X - EDGES[PIECE]) / LENGTH
    at = interpreted(surface_kernels, "material")(LOCAL, EDGES, PIECE, X, HALF)
    slope = float(line(LOCAL[STILL], under(LOCAL[STILL], X), 1))
    here = Here(piece=PIECE, at=at, above=above, slope=slope)
    lifted = interpreted(surface_kernels, "climbed")(LOCAL, EDGES, here, HALF)
    assert lifted == pytest.approx(float(level(LOCAL[STILL], X) - level(LOCAL[BEFORE], X)), rel=1e-6)
    place, change = under(LOCAL[STILL], X), LOCAL[STILL] - LOCAL[BEFORE]
    moved = np.array([-HALF * line(change, place, 1), line(change, place)], dtype=float)
    carried = interpreted(surface_kernels, "carried")(LOCAL, EDGES, here, HALF)
    assert carried == pytest.approx(moved @ tangent(LOCAL[STILL]), rel=2e-6)
