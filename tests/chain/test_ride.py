"""The contact code of the linear beams on the nonlinear chain."""

import dataclasses
from functools import partial
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from chain_reference import ridden as ridden_by_dop853
from chain_reference import rigid_motion, stretching_motion
from msgspec.structs import replace

from verify import segment_model
from verify.beam import Beam, PointForce
from verify.chain import far
from verify.chain.dynamics import at_rest, linearise
from verify.chain.problems import contact_line_error
from verify.chain.ride import _of_rigid, _surface, check_rideable, coupling_on_chain, half_steps, ride, ride_from_rest
from verify.chain.splitting import modal_basis, simulate_linear
from verify.chain.stepping import simulate as simulate_chain
from verify.chain.system import Rotation, build_system, straight_chain
from verify.errors import InputError
from verify.models.eigen import lowest
from verify.motion.contact import coupling_of, surface_speed
from verify.motion.simulate import simulate
from verify.segments.assembly import chain_pencil
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
    assert (found.statistics.steps, found.statistics.evaluations) == (200, 401)  # both ends of a step and its middle


def test_when_a_motion_begins_is_nothing_to_the_slider_on_it(paper_beam):
    """Let go with rates of its own, at the start of all time and a quarter of a second later."""
    system = build_system(paper_beam, 9)
    begun = at_rest(system)
    rates = 3.0 * np.cos(np.arange(9.0))
    runs = [
        ride(
            simulate_chain(system, dataclasses.replace(begun, rates=rates, time=late), late + half_steps(8e-4, STEP)),
            paper_beam,
            SLIDER,
        )
        for late in (0.0, 0.25)
    ]
    assert runs[1].statistics.step_s == pytest.approx(STEP, rel=1e-9)
    assert runs[1].times[0] == 0.25
    assert runs[0].displacement
    for name in ("travelled", "speed", "friction"):
        first, late = (getattr(run, name) for run in runs)
        assert late == pytest.approx(first, abs=1e-6 * abs(first).max())
    first, late = (run.ledger for run in runs)
    assert late.rubbed == pytest.approx(first.rubbed, rel=1e-6)


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


def test_the_links_edges_are_refused(paper_beam):
    with pytest.raises(InputError, match=r"slider.line = 'raw': a nonlinear chain is touched along its spline"):
        ridden(paper_beam, 1.0, slider=replace(SLIDER, line="raw"), duration=2e-5)


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


def test_beside_a_clamped_wall_the_slope_comes_to_the_beams_with_order_one_and_inside_with_order_three(titanium_strip):
    beam = replace(titanium_strip, supports=("clamped", "pinned"))
    for x, order in ((1e-4, 1.0), (0.3, 3.0)):
        errors = [contact_line_error(beam, 3, n, x) for n in (96, 192, 384)]
        assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(order, abs=0.35), x


STEEP = Slider(mass=1.3e-3, mu=0.23, slope=300.0, position=0.231, speed=0.004, preload=0.002, coupling="one-way")


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize(("links", "n", "duration"), [("rigid", 9, 1.7e-4), ("stretching", 5, 0.9e-4)])
def test_a_slider_rides_as_dense_equations_and_dop853_say(paper_beam, links, n, duration, kinematics):
    """Chain, contact line, slider and integrator written out a second time, at 30 N."""
    slider, axial = replace(STEEP, kinematics=kinematics), 70e9 * 0.02 * 0.001
    system = build_system(paper_beam, n, forces(30.0), 4276.0, load="reciprocal")
    seen = rigid_motion(system, duration) if links == "rigid" else stretching_motion(system, axial, duration)
    way, speed, work = ridden_by_dop853(system, seen, slider, 0.5 * paper_beam.thickness, duration)
    found = ride_from_rest(
        paper_beam, forces(30.0), 4276.0, slider, n, duration, step=duration / 180, links=links, tolerance=1e-10
    )
    assert found.displacement == pytest.approx(way, rel=1e-8)
    assert found.speed[-1] == pytest.approx(speed, rel=1e-8)
    assert found.ledger.given - found.ledger.rubbed == pytest.approx(work, rel=1e-5)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
def test_the_sliders_books_close_with_order_four(paper_beam, kinematics):
    slider, books = replace(STEEP, kinematics=kinematics), []
    for step in (4e-6, 2e-6):
        run = ride_from_rest(paper_beam, forces(12.0), 4276.0, slider, 25, 6e-4, step=step, tolerance=1e-11)
        books.append(run.ledger)
    coarse, fine = books
    assert coarse.residual / fine.residual > 8.0
    assert abs(fine.residual) < 1e-6 * fine.rubbed
    assert fine.rubbed > 0.0
    assert fine.given + fine.turned == pytest.approx(fine.gained + fine.rubbed, rel=1e-6)
    assert fine.gained == pytest.approx(0.5 * 1.3e-3 * (run.speed[-1] ** 2 - 0.004**2), rel=1e-14)
    assert (fine.turned == 0.0) is (kinematics == "tangential")


def test_what_the_chain_would_feel_is_sized_as_on_the_linear_one(paper_beam):
    system = build_system(paper_beam, 25, forces(2.0), 4276.0, load="reciprocal")
    slider = replace(SLIDER, normal="held")
    found = coupling_on_chain(system, paper_beam, slider)
    drive = segment_model.solve_harmonic(paper_beam, forces(2.0), 4276.0, 25)
    unit = segment_model.solve_harmonic(paper_beam, [PointForce(position=0.231)], 4276.0, 25)
    couple = [PointForce(position=0.231 + s * 1e-5, amplitude=0.5e5 * s) for s in (-1, 1)]
    turns = segment_model.solve_harmonic(paper_beam, couple, 4276.0, 25).slope([0.231])[0]
    expected = coupling_of(slider, paper_beam, 4276.0, surface_speed(drive, 0.231), unit.deflection([0.231])[0], turns)
    assert found.friction_size == pytest.approx(expected.friction_size, rel=1e-6)
    assert found.normal_size == pytest.approx(expected.normal_size, rel=5e-3)  # read by the spline, not by reciprocity
    assert found.normal_size > 1e-3


def test_a_slider_says_with_its_figure_why_it_may_ride_one_way(paper_beam):
    light = replace(SLIDER, mass=1e-7, coupling="auto")
    run = ridden(paper_beam, 1.0, slider=light, duration=4e-5)
    (said,) = run.notes
    assert said.startswith("coupling: one-way; full friction moves the surface by ")
    assert f"{run.coupling.friction_size:.1e}" in said
    left_out = ridden(paper_beam, 1.0, slider=replace(SLIDER, mass=0.02), duration=4e-5)
    assert "slider.coupling = 'one-way', a simplification: held on the surface" in left_out.notes[0]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"mass": 0.004}, r"'auto': full friction moves the surface by .* the inertia of a slider held on it by"),
        ({"mass": 4.0, "normal": "massless"}, r"'auto': full friction moves the surface by .*: give a lighter slider"),
        ({"coupling": "two-way", "mass": 1e-9}, "'two-way': a nonlinear chain carries a slider one way"),
    ],
)
def test_a_slider_that_the_chain_would_feel_is_refused_before_the_chain_moves(paper_beam, changed, words, monkeypatch):
    monkeypatch.setattr("verify.chain.confirmed.simulate", lambda *given, **more: pytest.fail("the chain moved"))
    slider = replace(replace(SLIDER, coupling="auto"), **changed)
    with pytest.raises(InputError, match=words):
        ride_from_rest(paper_beam, forces(1.0), 4276.0, slider, 25, 1e-4, step=STEP)


def test_a_slider_is_told_of_no_motion_that_another_tolerance_does_not_confirm(paper_beam, monkeypatch):
    """Bounds of here make it far, and unknown: links of this beam turn far under tens of kilonewtons alone."""
    monkeypatch.setattr(far, "FAR", 1e-6)
    run = partial(ride_from_rest, paper_beam, forces(30.0), 4276.0, SLIDER, 9, 1e-4, step=STEP, tolerance=1e-7)
    assert run().statistics.finished
    monkeypatch.setattr(far, "KNOWN", 1e-12)
    with pytest.raises(
        InputError, match=r"tolerance = 1e-07 leaves the motion unknown .*, and with tolerance = 1e-06 "
    ):
        run()


def test_a_chain_that_no_load_drives_has_no_size_to_go_by(paper_beam):
    system = build_system(paper_beam, 9)
    assert coupling_on_chain(system, paper_beam, SLIDER) is None
    with pytest.raises(InputError, match=r"'auto': no harmonic load says how the chain moves"):
        coupling_on_chain(system, paper_beam, replace(SLIDER, coupling="auto"))


def test_a_turned_chain_and_another_beams_are_refused(paper_beam):
    system = build_system(paper_beam, 9, forces(1.0), 4276.0)
    with pytest.raises(InputError, match=r"chain.rotation: a slider rides on a chain whose base does not turn"):
        check_rideable(dataclasses.replace(system, rotation=Rotation(rate=3.0)), paper_beam, SLIDER)
    for other in ({"length": 0.51}, {"supports": ("clamped", "pinned")}):
        with pytest.raises(InputError, match=r"the chain has \['pinned', 'pinned'\] and 0.5 m"):
            check_rideable(system, replace(paper_beam, **other), SLIDER)


def test_the_straight_chain_has_the_frequencies_of_the_nonlinear_one_at_rest(titanium_strip):
    beam = replace(titanium_strip, supports=("clamped", "free"))
    system = build_system(beam, 14, wall="third-order", grading=1.7)
    values = lowest(chain_pencil(straight_chain(system)), 5).values
    assert np.sqrt(values) == pytest.approx(linearise(system, at_rest(system)).frequencies()[:5], rel=1e-9)


def test_the_joints_of_rigid_links_go_along_x_as_their_places_change():
    """Of three unequal links: the rate of the sum of l cos(theta) up to the joint, by a complex step."""
    lengths, angles, rates = np.array([0.11, 0.07, 0.16]), np.array([0.31, -0.52, 0.83]), np.array([2.3, -4.1, 1.7])
    motion = SimpleNamespace(
        directions=lambda: angles[None], rates=rates[None], system=SimpleNamespace(lengths=lengths)
    )
    turned = angles + 1e-30j * np.cumsum(rates)
    for piece in range(3):
        speeds = [(lengths * np.cos(turned))[: piece + end].sum().imag / 1e-30 for end in (0, 1)]
        assert _of_rigid(motion, piece)[2][0] == pytest.approx(speeds, rel=1e-13)


def test_a_slider_that_starts_on_a_joint_and_leaves_is_told_which_and_how_many_segments_have_none_there(paper_beam):
    """Mid-span of an even chain: the slider is on two pieces at once and comes off its own with its first way back."""
    middle = Slider(mass=1e-3, mu=0.2, slope=100.0, coupling="one-way", speed=-0.01)
    with pytest.raises(InputError, match=r"starts on the joint at 0.25 m, .* \(an odd one for mid-span\), or start it"):
        ride_from_rest(paper_beam, forces(1.0), 4276.0, middle, 24, 4e-4, step=STEP)
    assert ride_from_rest(paper_beam, forces(1.0), 4276.0, middle, 25, 4e-4, step=STEP).displacement < 0.0
    beside = Slider(mass=1e-3, mu=0.2, slope=100.0, coupling="one-way", position=0.2403, speed=-3.0)
    last = Slider(mass=1e-3, mu=0.2, slope=100.0, coupling="one-way", position=0.5, speed=0.01)
    with pytest.raises(InputError, match=r"it starts at the end of the beam at 0.5 m; start it farther in$"):
        ride_from_rest(paper_beam, forces(1.0), 4276.0, last, 24, 4e-4, step=STEP)
    with pytest.raises(InputError, match="shorten time or start it elsewhere"):
        ride_from_rest(paper_beam, forces(1.0), 4276.0, beside, 25, 4e-4, step=STEP)


def test_a_step_in_which_a_slider_would_not_see_the_drive_is_refused(paper_beam):
    """A third of a period; a quarter is taken."""
    with pytest.raises(InputError, match=r"is 0.333 periods of the drive, which a slider would not see: give at most"):
        ride_from_rest(paper_beam, forces(1.0), 4276.0, SLIDER, 9, 1e-3, step=1.0 / (3.0 * 4276.0))


@pytest.mark.parametrize(("way", "done"), [(1, 4), (-1, 2)])
def test_steps_on_a_surface_that_is_given_are_counted_to_the_last_one_that_ends_on_its_piece(way, done):
    """0.3 m/s off either end of a piece from -0.07 to 0.13 m, in steps of 0.1 s, without friction."""
    from verify.motion.kernels import slide_given
    from verify.motion.records import Given, Law, Rider
    from verify.motion.stepping import contact_space, fresh_motion

    still = Law(
        kinetic=0.0, static=None, slope=1.0, mass=1.0, half=0.0, gravity=0.0, following=False, held=False, load=0.0
    )
    given = Given(local=np.zeros((21, 2, 4)), along=np.zeros((21, 2)), edges=np.array([-0.07, 0.13]))
    kept = np.zeros((11, 4))
    found = slide_given(10, 0.1, given, Rider(fresh_motion(0.03 * 10 * way), still, None), kept, contact_space())
    assert found == done
    assert kept[: done + 1, 0] == pytest.approx(0.03 * way * np.arange(done + 1), abs=1e-15)


def test_a_force_at_the_end_of_the_beam_to_rounding_is_a_load_of_the_chain():
    beam = Beam(length=0.73, width=0.03, thickness=0.002, youngs_modulus=113e9, density=4470.0)
    for share, taken in ((1.0 + 4e-13, True), (1.0 + 3e-12, False)):
        force = PointForce(position=share * beam.length, amplitude=0.7)
        if taken:
            assert len(build_system(beam, 7, (force,), 31.0).loads)
        else:
            with pytest.raises(InputError, match="lies off the beam: give a position up to"):
                build_system(beam, 7, (force,), 31.0)
