"""The contact code of the linear beams on the nonlinear chain."""

import numpy as np
import pytest

from verify.beam import PointForce
from verify.chain.dynamics import at_rest
from verify.chain.ride import _reading, half_steps, ride
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
    assert found.stopped == "left the piece of the chain it began on"
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
    from msgspec.structs import replace

    system = build_system(paper_beam, 9, forces(0.01), 4276.0)
    chain = simulate_linear(modal_basis(system), at_rest(system), times)
    with pytest.raises(InputError, match=words):
        ride(chain, paper_beam, replace(SLIDER, **changed))


def test_the_links_edges_and_unlike_thicknesses_are_refused(paper_beam):
    from msgspec.structs import replace

    from verify.beam import Section

    with pytest.raises(InputError, match=r"slider.line = 'raw': a nonlinear chain is touched along its spline"):
        ridden(paper_beam, 1.0, slider=replace(SLIDER, line="raw"), duration=2e-5)
    stepped = replace(paper_beam, section=(Section(length=0.2), Section(length=0.3, thickness=2e-3)))
    with pytest.raises(InputError, match=r"beam.section has a thickness of its own"):
        ridden(stepped, 1.0, duration=2e-5)


def test_the_contact_line_of_unequal_links_goes_through_the_corrected_joints(paper_beam):
    from verify.segments.links import build_chain, corrected_reading

    system = build_system(paper_beam, 12, forces(1.0), 4276.0, grading=2.7)
    chain = build_chain(paper_beam, 12, grading=2.7)
    heights = np.random.default_rng(5).normal(0, 1e-6, (3, 13))
    heights[:, [0, -1]] = 0.0
    expected = corrected_reading(chain, heights)
    for piece in range(12):
        line = np.diff(heights, axis=1) @ _reading(system.nodes, piece)
        assert line[:, 0] == pytest.approx(expected[:, piece], rel=1e-12, abs=1e-20)
        assert line.sum(axis=1) == pytest.approx(expected[:, piece + 1], rel=1e-9, abs=1e-18)
