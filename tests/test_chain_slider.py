"""The contact code of the linear beams on the nonlinear chain."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from msgspec.structs import replace

from verify import segment_model
from verify.beam import PointForce
from verify.chain.dynamics import at_rest
from verify.chain.problems import contact_line_error
from verify.chain.ride import _surface, half_steps, ride
from verify.chain.splitting import modal_basis, simulate_linear
from verify.chain.stepping import simulate as simulate_chain
from verify.chain.system import build_system
from verify.errors import InputError
from verify.motion.simulate import simulate
from verify.slider import Slider

STEP = 4e-6
SLIDER = Slider(mass=1e-3, mu=0.23, slope=120.0, position=0.231, coupling="one-way")


def forces(amplitude):
    return [
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=0.4871, amplitude=1.3 * amplitude),
    ]


def ridden(beam, amplitude, n=25, slider=SLIDER, nonlinear=True, duration=0.8e-3):
    system = build_system(beam, n, forces(amplitude), 4276.0, load="reciprocal")
    times = half_steps(duration, STEP)
    if nonlinear:
        return ride(simulate_chain(system, at_rest(system), times, tolerance=1e-10, ledger=False), beam, slider)
    return ride(simulate_linear(modal_basis(system), at_rest(system), times), beam, slider)


def linear(beam, amplitude, n=25, slider=SLIDER, duration=0.8e-3):
    return simulate(beam, forces(amplitude), 4276.0, duration, count=n, slider=slider, step=STEP, ledger=False)


def test_small_waves_carry_a_slider_on_the_nonlinear_chain_as_on_the_linear_one(paper_beam):
    found, expected = ridden(paper_beam, 1e-4), linear(paper_beam, 1e-4)
    assert found.displacement == pytest.approx(expected.displacement, rel=1e-4)
    assert found.speed[-1] == pytest.approx(expected.speed[-1], rel=1e-4)
    assert found.friction[-1] == pytest.approx(expected.friction[-1], rel=1e-3)


def test_the_shortening_of_the_chain_is_felt_in_proportion_to_the_force(paper_beam):
    # the speed of a shortening chain along x is quadratic in the force, what carries the slider linear
    parts = []
    for amplitude in (0.01, 0.02):
        found, expected = ridden(paper_beam, amplitude, nonlinear=False), linear(paper_beam, amplitude)
        parts.append(found.displacement / expected.displacement - 1.0)
    assert abs(parts[0]) > 1e-4
    assert parts[1] / parts[0] == pytest.approx(2.0, abs=0.05)


def test_nonlinear_and_linear_chain_part_company_with_the_force(paper_beam):
    part = []
    for amplitude in (1.5, 15.0):
        found, flat = ridden(paper_beam, amplitude), ridden(paper_beam, amplitude, nonlinear=False)
        part.append(abs(found.displacement / flat.displacement - 1.0))
    assert part == pytest.approx([3.1e-4, 5.05e-3], rel=0.1)


def test_coulomb_sticks_on_the_chain(paper_beam):
    slider = Slider(mass=1e-3, mu=5000.0, law="coulomb", position=0.231, coupling="one-way")
    found = ridden(paper_beam, 0.01, slider=slider, duration=0.3e-3)
    assert np.allclose(found.speed[2:], found.surface_speed[2:], rtol=1e-9, atol=1e-15)


def test_a_slider_that_leaves_its_piece_stops_and_keeps_its_way(paper_beam):
    slider = Slider(mass=1e-3, mu=0.2, slope=100.0, position=0.2401, speed=-3.0, coupling="one-way")
    found = ridden(paper_beam, 0.01, slider=slider)
    assert found.statistics.stopped == "left the piece of the chain it began on"
    assert 0 < len(found.times) == len(found.travelled) < 201
    assert slider.position + found.displacement >= 0.24


@pytest.mark.parametrize(
    ("times", "changed", "words"),
    [
        (np.linspace(0, 1e-4, 20), {}, "half_steps"),
        (np.array([0.0, 1e-5, 3e-5]), {}, "half_steps"),
        (half_steps(1e-4, STEP), {"coupling": "two-way"}, "two-way"),
    ],
)
def test_what_a_chain_cannot_carry_is_refused(paper_beam, times, changed, words):
    system = build_system(paper_beam, 9, forces(0.01), 4276.0)
    chain = simulate_linear(modal_basis(system), at_rest(system), times)
    with pytest.raises(InputError, match=words):
        ride(chain, paper_beam, replace(SLIDER, **changed))


def test_the_links_edges_and_unlike_thicknesses_are_refused(paper_beam):
    from verify.beam import Section

    with pytest.raises(InputError, match=r"slider.line = 'raw': a nonlinear chain is touched along its spline"):
        ridden(paper_beam, 1.0, slider=replace(SLIDER, line="raw"), duration=2e-5)
    stepped = replace(paper_beam, section=(Section(length=0.2), Section(length=0.3, thickness=2e-3)))
    with pytest.raises(InputError, match=r"beam.section has a thickness of its own"):
        ridden(stepped, 1.0, duration=2e-5)


AS_THE_CHAIN_LIES = [
    (("clamped", "pinned"), 1.0),
    (("clamped", "free"), 1.0),
    (("clamped", "pinned"), 2.7),
    (("pinned", "pinned"), 2.7),
]
"""Beside a clamped wall, on unequal links, and both."""


def bent(titanium_strip, supports, grading, n=24, mode=3):
    """A nonlinear chain that stands in one mode of the linear one, a millionth of its length high."""
    beam = replace(titanium_strip, supports=supports)
    system = build_system(beam, n, grading=grading)
    modes = segment_model.solve_modes(beam, mode, n, grading=grading)
    shape = modes.readings["raw"]()[mode - 1]
    size = 1e-6 * beam.length / abs(shape).max()
    angles = np.diff(np.arcsin(size * np.diff(shape) / system.lengths), prepend=0.0)
    moved = simulate_linear(modal_basis(system), at_rest(system), [0.0, 1e-9])
    return beam, modes, size, dataclasses.replace(moved, angles=np.stack([angles, -0.7 * angles]))


@pytest.mark.parametrize(("supports", "grading"), AS_THE_CHAIN_LIES)
def test_the_contact_line_is_the_linear_chains_reading_everywhere(titanium_strip, supports, grading):
    beam, modes, size, moved = bent(titanium_strip, supports, grading)
    highest = abs(modes.slope(np.linspace(0.0, beam.length, 300))[2]).max()
    for piece, (left, right) in enumerate(pairwise(moved.system.nodes)):
        xi = np.array([0.0, 0.23, 0.71, 1.0])
        local, _, edges = _surface(moved, 0.4 * left + 0.6 * right)
        assert edges == pytest.approx([left, right], abs=1e-15), piece
        slopes = np.polynomial.polynomial.polyval(xi, np.polynomial.polynomial.polyder(local[0, 0])) / (right - left)
        expected = modes.slope(left + xi * (right - left))[2]
        assert slopes / size == pytest.approx(expected, abs=1e-9 * highest), piece
        assert local[1, 0] == pytest.approx(-0.7 * local[0, 0], rel=1e-6, abs=1e-9 * size)


@pytest.mark.parametrize(("supports", "grading", "least"), [(("clamped", "pinned"), 1.0, 1.9)])
def test_beside_a_clamped_wall_the_contact_line_comes_to_the_beams_slope_with_order_two(
    titanium_strip, supports, grading, least
):
    errors = []
    for n in (24, 48, 96):
        beam = replace(titanium_strip, supports=supports)
        errors.append(contact_line_error(beam, 3, n, 1e-3 * beam.length))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > least).all()
    assert (orders < 2.2).all()
