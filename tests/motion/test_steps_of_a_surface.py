"""A beam whose surface has steps is the same beam whichever of its sections is stated as its own."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import to_builtins
from msgspec.structs import replace

from verify import travelling_wave
from verify.beam import Beam, PointForce
from verify.chain.ride import ride_from_rest
from verify.errors import InputError, WindowError
from verify.models.catalogue import MODELS
from verify.models.underfoot import ground_at, piece_at, standing_at, surface_distance_at
from verify.motion.simulate import simulate
from verify.motor.case import MotorCase
from verify.motor.figures import at_speed, crest_speed
from verify.motor.run import run_motor, run_motors
from verify.section import Section
from verify.slider import Contact, Foot, Slider, changed
from verify.waves.medium import Medium

THIN, THICK, STEP = 0.0011, 0.0029, 0.137
PLAIN = Beam(length=0.31, width=0.013, thickness=THIN, youngs_modulus=114e9, density=4430.0, loss_factor=0.004)
OWN_THIN = replace(PLAIN, section=(Section(length=STEP), Section(length=0.31 - STEP, thickness=THICK)))
OWN_THICK = replace(PLAIN, thickness=THICK, section=(Section(length=STEP, thickness=THIN), Section(length=0.31 - STEP)))
OWN_NOWHERE = replace(
    PLAIN,
    thickness=0.0077,
    section=(Section(length=STEP, thickness=THIN), Section(length=0.31 - STEP, thickness=THICK)),
)
TWICE = (OWN_THICK, OWN_NOWHERE)
FORCES = (PointForce(position=0.021, amplitude=1.3), PointForce(position=0.2873, amplitude=0.9, phase_deg=73.0))
HERTZ = 2963.0
RIDER = Slider(mass=1.1e-3, mu=0.23, slope=90.0, position=0.2037, coupling="one-way")
STANDS = replace(RIDER, contact=Contact(stiffness=9e4, damping=1.3), foot=(Foot(length=0.004, points=3),), preload=0.7)
COUNT = 40


def close(found, expected, rel=1e-12):
    found, expected = np.asarray(found, dtype=complex), np.asarray(expected, dtype=complex)
    assert abs(found - expected).max() <= rel * abs(expected).max()


# --- What stands where ------------------------------------------------------------------------------------------------


@st.composite
def stepped_beams(draw):
    sizes = draw(st.lists(st.tuples(st.floats(0.01, 0.4), st.sampled_from([5e-4, 1e-3, 2.3e-3])), min_size=1))
    sections = tuple(Section(length=length, thickness=thickness) for length, thickness in sizes)
    return replace(PLAIN, length=sum(length for length, _ in sizes), section=sections)


@settings(max_examples=60, deadline=None)
@given(stepped_beams(), st.floats(0.0, 1.0))
def test_the_surface_at_a_place_is_that_of_the_section_that_holds_it(beam, share):
    x = share * beam.length
    left, number = 0.0, 0
    while number < len(beam.section) - 1 and x >= left + beam.section[number].length:
        left += beam.section[number].length
        number += 1
    if min(abs(x - left), abs(x - left - beam.section[number].length)) < 1e-9:
        return  # on an edge, of which the next test speaks
    section = beam.section[number]
    assert int(piece_at(beam, x)) == number
    assert float(surface_distance_at(beam, x)) == 0.5 * section.thickness
    alone = replace(beam, section=(), thickness=section.thickness)
    under = standing_at(beam, x)
    assert under.surface_distance == alone.surface_distance
    assert under.wave_constant == pytest.approx(alone.wave_constant, rel=1e-14)
    omega = 2.0 * np.pi * HERTZ
    assert Medium(under, "timoshenko").turn(omega) == pytest.approx(Medium(alone, "timoshenko").turn(omega), rel=1e-13)
    ground = ground_at(beam, x)
    ends = np.cumsum([0.0, *(one.length for one in beam.section)])
    middles = 0.5 * (ends[1:] + ends[:-1])
    inside = [one for one, m in zip(beam.section, middles, strict=True) if ground.start < m < ground.end]
    assert {one.thickness for one in inside} == {section.thickness}
    for edge, beyond in ((ground.start, middles[middles < ground.start]), (ground.end, middles[middles > ground.end])):
        assert len(beyond) == 0 or float(abs(ends - edge).min()) < 1e-12
    for m in (middles[middles < ground.start][-1:], middles[middles > ground.end][:1]):
        assert all(beam.section[int(piece_at(beam, at))].thickness != section.thickness for at in m)


@pytest.mark.parametrize("off", [-1e-14, 0.0, 1e-14])
def test_on_an_edge_the_section_to_the_right_stands(off):
    assert surface_distance_at(OWN_THIN, [0.0, STEP - 1e-9, STEP + off, 0.31]).tolist() == [
        0.5 * THIN,
        0.5 * THIN,
        0.5 * THICK,
        0.5 * THICK,
    ]
    assert ground_at(OWN_THIN, STEP + off).end == OWN_THIN.length
    assert ground_at(OWN_THIN, STEP + off).start <= STEP + off


def test_a_beam_of_one_section_stands_itself():
    assert standing_at(PLAIN, 0.2) is PLAIN
    alike = replace(PLAIN, section=(Section(length=0.1), Section(length=0.21)))
    assert standing_at(alike, 0.2) is alike


def test_a_section_without_sizes_keeps_the_surface_of_its_beam():
    patched = replace(
        PLAIN,
        section=(
            Section(length=0.1),
            Section(length=0.05, bending_stiffness=0.4, mass_per_length=0.11),
            Section(length=0.05, extreme_fibre=0.0009, bending_stiffness=0.4, mass_per_length=0.11),
            Section(length=0.11),
        ),
    )
    assert surface_distance_at(patched, [0.05, 0.12, 0.17, 0.3]).tolist() == [5.5e-4, 5.5e-4, 9e-4, 5.5e-4]
    assert (ground_at(patched, 0.12).start, ground_at(patched, 0.12).end) == (0.0, pytest.approx(0.15))


# --- Points of the surface --------------------------------------------------------------------------------------------


def test_the_way_of_a_surface_point_does_not_ask_which_section_is_the_beams_own():
    x = np.array([0.05, 0.1, 0.19, 0.26])
    for beam in (OWN_THIN, *TWICE):
        field = MODELS["analytic"].solve_harmonic(beam, FORCES, HERTZ, None)
        slope = field.slope(x)
        half = np.array([0.5 * THIN, 0.5 * THIN, 0.5 * THICK, 0.5 * THICK])
        assert travelling_wave.surface_motion(beam, slope, x=x) == pytest.approx(-half * slope, rel=1e-15)
        with pytest.raises(InputError, match=r"x is missing: the surface has steps"):
            travelling_wave.surface_motion(beam, slope)


@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
@pytest.mark.parametrize("model", ["analytic", "fem"])
@pytest.mark.parametrize("x", [0.07, 0.2037])
def test_an_ellipse_is_that_of_the_section_under_it(model, theory, x):
    from verify.quantities.catalogue import QUANTITIES
    from verify.run.runner import workbench_for
    from verify.scenes.scene import Drive, Scene, SceneForce

    def ratio(beam):
        forces = tuple(SceneForce(**to_builtins(force)) for force in FORCES)
        scene = Scene(name="s", title="s", beam=beam, drive=Drive(frequency_hz=HERTZ, force=forces))
        quantity = QUANTITIES["wave.axis_ratio"]
        given = {"x": x, "theory": theory, "model": model, "count": None if model == "analytic" else COUNT}
        return quantity.evaluate(quantity.arguments(**given), scene, workbench_for(scene, gates_only=True))

    for beam in TWICE:
        assert ratio(beam) == pytest.approx(ratio(OWN_THIN), rel=1e-12)


def test_a_window_over_another_surface_of_the_same_waves_is_refused():
    raised = replace(PLAIN, section=(Section(length=STEP), Section(length=0.31 - STEP, extreme_fibre=0.001)))
    field = MODELS["analytic"].solve_harmonic(raised, FORCES, HERTZ, None)
    with pytest.raises(WindowError, match=r"holds a beam\.section other than the beam's own"):
        travelling_wave.measure(field, (0.1, 0.2))
    assert travelling_wave.measure(field, (0.03, STEP)).ideal_axis_ratio > 0.0


# --- Sliders ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("position", [0.0821, 0.2037])
@pytest.mark.parametrize(
    "how",
    [
        {"model": "analytic", "start": "steady"},
        {"model": "fem", "count": COUNT, "start": "steady", "coupling": "two-way"},
        {"model": "segment", "count": COUNT, "start": "rest", "kinematics": "following"},
        {"model": "fem", "count": COUNT, "start": "rest", "coupling": "two-way"},
    ],
)
def test_a_slider_is_carried_by_the_section_under_it(how, position):
    """To 5e-12, but where all modes take up a two-way push: of the highest, eigenvalues have 1e-11 left in phase."""
    how, rel = dict(how), 1e-10 if "coupling" in how else 5e-12
    changes = {name: how.pop(name) for name in ("coupling", "kinematics") if name in how}
    slider = replace(RIDER, position=position, **changes)

    def run(beam):
        return simulate(beam, FORCES, HERTZ, 2e-4, slider=slider, **how)

    expected = run(OWN_THIN)
    for found in map(run, TWICE):
        close(found.surface_speed, expected.surface_speed, rel)
        close(found.travelled, expected.travelled, rel)
        assert found.coupling.friction_size == pytest.approx(expected.coupling.friction_size, rel=1e-6)


def test_a_slider_rides_on_a_stepped_chain_as_on_the_linear_one():
    slider = replace(RIDER, position=0.2041)
    forces = tuple(replace(one, amplitude=1e-3 * one.amplitude) for one in FORCES)

    def ridden(beam):
        beam = replace(beam, loss_factor=0.0)
        return beam, ride_from_rest(beam, forces, HERTZ, slider, 31, 3e-4, step=2e-6)

    beam, expected = ridden(OWN_THIN)
    linear = simulate(beam, forces, HERTZ, 3e-4, slider=slider, count=31, step=2e-6)
    assert expected.displacement == pytest.approx(linear.displacement, rel=1e-3)
    for other in TWICE:
        found = ridden(other)[1]
        close(found.travelled, expected.travelled, rel=1e-10)
        assert found.ledger.given == pytest.approx(expected.ledger.given, rel=1e-9)


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
@pytest.mark.parametrize("start", ["rest", "steady"])
def test_a_slider_that_comes_to_a_step_stops_and_says_where(model, start):
    slider = replace(RIDER, position=STEP + 1e-4, speed=-0.7)
    how = {"model": model, "start": start} | ({"modes": 30} if model == "analytic" else {"count": 23})
    found = simulate(OWN_THIN, FORCES, HERTZ, 1e-3, slider=slider, **how)
    assert found.statistics.stopped == "came to a step of beam.section at 0.137 m"
    assert STEP - 0.8 * found.statistics.step_s < found.end.position < STEP
    with pytest.raises(InputError, match=r"continue_from ended where its slider came to a step .* at 0\.137 m"):
        simulate(OWN_THIN, FORCES, HERTZ, 1e-4, slider=slider, continue_from=found, **how)
    up = replace(slider, position=STEP - 1e-4, speed=0.7)
    assert simulate(OWN_THIN, FORCES, HERTZ, 1e-3, slider=up, **how).statistics.stopped == found.statistics.stopped
    away = replace(slider, speed=0.7)
    assert simulate(OWN_THIN, FORCES, HERTZ, 1e-3, slider=away, **how).statistics.finished


def test_a_slider_crosses_sections_of_one_thickness():
    alike = replace(PLAIN, section=(Section(length=STEP), Section(length=0.31 - STEP, density=5100.0)))
    slider = replace(RIDER, position=STEP + 1e-5, speed=-0.7)
    found = simulate(alike, FORCES, HERTZ, 1e-4, slider=slider, model="fem", count=COUNT)
    assert found.statistics.finished
    assert found.position[-1] < STEP


# --- Motors -----------------------------------------------------------------------------------------------------------


def case(beam, **changes):
    return MotorCase(beam=beam, forces=FORCES, frequency_hz=HERTZ, slider=replace(STANDS, **changes), count=COUNT)


@pytest.mark.parametrize("position", [0.0821, 0.2037])
@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_a_motors_figures_are_those_of_the_section_under_it(position, coupling):
    expected = case(OWN_THIN, position=position, coupling=coupling)
    still = at_speed(expected, 0.0)
    assert abs(still.force) > 1e-4
    for beam in TWICE:
        other = case(beam, position=position, coupling=coupling)
        assert crest_speed(other) == pytest.approx(crest_speed(expected), rel=1e-12)
        found = at_speed(other, 0.0)
        for name in ("force", "normal_force", "given", "rubbed"):
            assert getattr(found, name) == pytest.approx(getattr(still, name), rel=1e-11), name


def test_a_motors_margins_are_those_of_the_section_under_it():
    springs = Contact(stiffness=9e4, tangential_stiffness=4e4)

    def margins(beam):
        slider = changed(STANDS, contact=springs, law="coulomb")
        run = run_motor(beam, FORCES, HERTZ, 2.0 / HERTZ, slider=slider, count=COUNT)
        return run.motor_margins, run.coupling

    (expected, felt), k = margins(OWN_THIN), (2 * np.pi * HERTZ) ** 0.5 / (THICK * (114e9 / 4430.0 / 12) ** 0.5) ** 0.5
    assert expected.epsilon == pytest.approx(2 * 0.23 * 9e4 / (4e4 * k * THICK), rel=1e-12)
    for beam in TWICE:
        found, coupling = margins(beam)
        assert (found.epsilon, found.step) == pytest.approx((expected.epsilon, expected.step), rel=1e-12)
        assert coupling.friction_size == pytest.approx(felt.friction_size, rel=1e-6)


@pytest.mark.parametrize("how", [{}, {"start": "rest"}, {"start": "rest", "model": "chain"}])
def test_a_motor_that_comes_to_a_step_stops_and_says_where(how):
    slider = replace(STANDS, position=STEP + 0.0023, foot=(Foot(length=0.004, points=2),))
    asked = {"model": "segment", "count": COUNT, **how}
    found = run_motor(replace(OWN_THIN, loss_factor=0.0), FORCES, HERTZ, 4e-3, slider=slider, held_speed=-0.9, **asked)
    assert found.statistics.stopped == "came to a step of beam.section at 0.137 m"
    assert found.start + found.travelled[-1] >= STEP + 0.001 - 1e-12


def test_a_hard_slider_that_comes_to_a_step_stops_and_says_where():
    slider = replace(RIDER, position=STEP - 2e-4, contact=Contact(restitution=0.3), preload=40.0)
    found = run_motor(OWN_THIN, FORCES, HERTZ, 2e-3, slider=slider, held_speed=0.9, count=COUNT)
    assert found.statistics.stopped == "came to a step of beam.section at 0.137 m"


def test_feet_over_a_step_and_sliders_on_both_sides_of_one_are_refused():
    over = replace(STANDS, position=STEP + 0.001)
    with pytest.raises(InputError, match=r"slider\.position = 0\.138 m puts a foot from 0\.136 to 0\.14 m, over the s"):
        run_motor(OWN_THIN, FORCES, HERTZ, 1e-4, slider=over, count=COUNT)
    run_motor(OWN_THIN, FORCES, HERTZ, 1e-4, slider=replace(STANDS, position=STEP + 0.002), count=COUNT)
    sliders = [replace(STANDS, position=x) for x in (0.2, 0.1)]
    with pytest.raises(InputError, match=r"slider\.position = 0\.1 m stands on another beam\.section than 0\.2 m"):
        run_motors(OWN_THIN, FORCES, HERTZ, 1e-4, sliders=sliders, count=COUNT)
