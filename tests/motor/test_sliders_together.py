"""Several feet, both faces, a slider between two beams, several sliders on one beam."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import Beam, Contact, Foot, PointForce, Slider, run_motor, run_motors
from verify.models.catalogue import MODELS
from verify.motor.resting import _under

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FORCES = [PointForce(position=0.0116, amplitude=2.1), PointForce(position=0.4884, amplitude=1.9, phase_deg=83.0)]
HERTZ = 4276.0
SLIDER = Slider(
    mass=0.21,
    mu=0.17,
    law="coulomb",
    preload=23.0,
    position=0.237,
    coupling="one-way",
    contact=Contact(stiffness=5e7, damping=900.0),
    foot=(Foot(length=0.044, points=23),),
)


def moved(slider, seconds=4e-3, **given):
    kept = {"model": "segment", "count": 49, "samples": 18, **given}
    return run_motor(BEAM, FORCES, HERTZ, seconds, slider=slider, **kept)


def test_the_material_under_a_point_on_a_bent_beam_lies_no_further_than_its_end():
    """X = x + (h/2) w', of the upper face outwards where the end rises, of the lower one back."""
    beam = replace(BEAM, supports=("clamped", "free"))
    basis = MODELS["fem"].time_basis(beam, 9, 4, "spline")
    x = np.array([0.11, 0.31, 0.5])
    still = np.append([1e-4, -2e-6, 0.0, 3e-7], np.zeros(len(basis.omegas) - 4))
    still *= np.sign(still @ basis.shapes(x, 1)[:, 2])
    slope = still @ basis.shapes(x, 1)
    upper, lower = (_under(basis, still, x, np.full(3, lever)) for lever in (5e-4, -5e-4))
    assert upper[:2] == pytest.approx(x[:2] + 5e-4 * slope[:2], rel=1e-15)
    assert lower == pytest.approx(x - 5e-4 * slope, rel=1e-15)
    assert upper[2] == 0.5 > lower[2]


def test_feet_on_both_faces_are_driven_the_same_way_and_do_not_bend_the_beam():
    """At a crest the upper surface runs back, and the lower one where the beam is lowest, half a wave on."""
    upper = moved(SLIDER)
    clasp = moved(replace(SLIDER, gravity=0.0, foot=(SLIDER.foot[0], replace(SLIDER.foot[0], face="lower"))))
    lower = moved(replace(SLIDER, gravity=0.0, foot=(replace(SLIDER.foot[0], face="lower"),)))
    assert np.sign(upper.speed[-1]) == np.sign(clasp.speed[-1]) == np.sign(lower.speed[-1]) != 0.0
    assert clasp.motor_margins.sag < 1e-12
    assert upper.motor_margins.sag > 0.1
    assert clasp.normal_force[-9:].mean() == pytest.approx(23.0, rel=0.2)


def pinned_sag(x, at, load):
    """Of a pinned beam at x under loads at places, metres: the closed form of each."""
    length, total = BEAM.length, 0.0
    for a, force in zip(at, load, strict=True):
        c, y = (length - a, x) if x <= a else (a, length - x)
        total += force * c * y * (length**2 - c**2 - y**2) / (6.0 * length * BEAM.bending_stiffness)
    return total


def test_feet_of_a_clasp_that_are_not_above_each_other_bend_the_beam_by_their_couple():
    """Their forces cancel, and the beam stands highest or lowest under one of them, not under the slider."""
    upper, lower = (Foot(length=0.03, points=5, offset=-0.031), Foot(length=0.02, points=3, offset=0.043, face="lower"))
    apart = replace(SLIDER, gravity=0.0, preload=0.0031, foot=(upper, lower))
    place = apart.start_on(BEAM)
    spread = [
        place + foot.offset + foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5) for foot in apart.feet
    ]
    each = [
        np.full(len(x), 0.5 * sign * apart.normal_force / len(x)) for x, sign in zip(spread, (-1.0, 1.0), strict=True)
    ]
    at, load = np.concatenate(spread), np.concatenate(each)
    expected = max(abs(pinned_sag(x, at, load)) for x in at)
    assert moved(apart, seconds=2e-4).motor_margins.sag == pytest.approx(expected, rel=1e-3)
    held = moved(apart, seconds=2e-4, model="analytic", count=None, start="steady")
    taut = run_motor(replace(BEAM, tension=1e-3), FORCES, HERTZ, 2e-4, slider=apart, model="analytic", start="steady")
    assert taut.motor_margins.sag == pytest.approx(held.motor_margins.sag, rel=1e-3)


def test_weight_presses_an_upper_foot_on_and_a_lower_one_off():
    stiff = replace(SLIDER, gravity=9.81, contact=Contact(stiffness=5e7))
    still = [replace(one, amplitude=1e-9) for one in FORCES]
    for face, load in (("upper", 23.0 + 0.21 * 9.81), ("lower", 23.0 - 0.21 * 9.81)):
        slider = replace(stiff, foot=(replace(SLIDER.foot[0], face=face),))
        found = run_motor(BEAM, still, HERTZ, 1e-3, slider=slider, model="segment", count=49, samples=5)
        assert found.normal_force[1:] == pytest.approx(load, rel=1e-6)
        assert found.height[0, 0] == pytest.approx((-load if face == "upper" else load) / 5e7, rel=1e-6)


def test_a_preload_spring_eases_as_the_beam_it_bends_gives_way():
    """On a soft beam that feels it: P/(1 + k_s (1/k + compliance)), and the foot rests on that from the start."""
    still = [replace(one, amplitude=1e-9) for one in FORCES]
    slider = Slider(
        mass=1e-3,
        mu=0.2,
        law="tanh",
        gravity=0.0,
        preload=0.02,
        preload_stiffness=4e4,
        coupling="two-way",
        position=0.237,
        contact=Contact(stiffness=1e5),
    )
    found = run_motor(BEAM, still, HERTZ, 1e-3, slider=slider, model="fem", count=30, samples=5)
    compliance = (0.237 * 0.263) ** 2 / (3.0 * BEAM.bending_stiffness * 0.5)
    assert found.normal_force[1:] == pytest.approx(0.02 / (1.0 + 4e4 * (1e-5 + compliance)), rel=1e-3)


def test_a_slider_between_two_beams_stays_in_the_middle_and_is_pressed_alike_from_both():
    between = replace(SLIDER, gravity=0.0, foot=(replace(SLIDER.foot[0], mirrored=True),))
    found = moved(between)
    points = found.pressures.shape[1] // 2
    assert np.abs(found.height).max() < 1e-12
    assert found.pressures[:, :points] == pytest.approx(found.pressures[:, points:], rel=1e-9, abs=1e-9)
    assert found.pressures[5:].sum(axis=1).min() > 0.0
    assert np.sign(found.speed[-1]) == np.sign(moved(SLIDER).speed[-1])


@pytest.mark.parametrize("law", ["coulomb", "tanh"])
def test_two_beams_that_feel_the_slider_between_them_move_as_one_that_feels_half_of_it(law):
    """By symmetry: half the mass along the beam, and a foot that stays where it is."""
    stiff = replace(BEAM, thickness=0.004, loss_factor=0.02)
    own = {
        "mu": 0.17,
        "law": law,
        "slope": 80.0 if law == "tanh" else None,
        "gravity": 0.0,
        "position": 0.237,
        "coupling": "two-way",
    }
    contact = Contact(stiffness=4e5, damping=8.0)
    between = Slider(mass=0.06, preload=3.0, contact=contact, foot=(Foot(length=0.03, points=7, mirrored=True),), **own)
    half = Slider(
        mass=0.03, preload=3.0, contact=contact, foot=(Foot(length=0.03, points=7, mass=1e12, pitches=False),), **own
    )
    kept = {"model": "fem", "count": 30, "samples": 30, "start": "rest", "soft_start_periods": 2.0}
    forces = [replace(one, amplitude=60.0) for one in FORCES]
    two, one = (run_motor(stiff, forces, HERTZ, 4e-3, slider=slider, **kept) for slider in (between, half))
    assert two.speed[-1] == pytest.approx(one.speed[-1], rel=2e-3)
    assert two.normal_force[5:] == pytest.approx(2.0 * one.normal_force[5:], rel=2e-3, abs=2e-3)
    assert two.contact_share[1:].min() < 0.9 * two.contact_share[1:].max()
    alone = run_motor(stiff, forces, HERTZ, 4e-3, slider=replace(between, coupling="one-way"), **kept)
    assert abs(alone.speed[-1] / two.speed[-1] - 1.0) > 0.05


def test_weight_sinks_a_slider_between_two_beams_by_what_both_springs_bear():
    still = [replace(one, amplitude=1e-9) for one in FORCES]
    between = replace(SLIDER, contact=Contact(stiffness=5e7), foot=(replace(SLIDER.foot[0], mirrored=True),))
    found = run_motor(BEAM, still, HERTZ, 1e-3, slider=between, model="segment", count=49, samples=5)
    assert found.height[:, 0] == pytest.approx(-0.21 * 9.81 / 1e8, rel=1e-6)


def test_sliders_that_the_beam_does_not_feel_move_as_each_by_itself():
    other = replace(SLIDER, mass=0.34, mu=0.11, preload=31.0, position=0.331, foot=(Foot(length=0.03, points=11),))
    kept = {"model": "segment", "count": 49, "samples": 18}
    both = run_motors(BEAM, FORCES, HERTZ, 4e-3, sliders=[SLIDER, other], **kept)
    for slider, found in zip((SLIDER, other), both, strict=True):
        alone = moved(slider)
        assert found.start == alone.start
        assert found.travelled == pytest.approx(alone.travelled, rel=1e-6, abs=1e-12)
        assert found.height == pytest.approx(alone.height, rel=1e-6, abs=1e-12)
        assert found.pressures.shape == alone.pressures.shape
        assert found.point_offsets == pytest.approx(alone.point_offsets, abs=1e-15)
        assert found.ledger.residual == pytest.approx(alone.ledger.residual, abs=1e-6)


def test_sliders_on_a_beam_that_feels_them_feel_each_other_the_less_the_less_presses_the_other_on():
    first = replace(SLIDER, coupling="two-way", preload=0.3, mass=0.01, foot=(), contact=Contact(stiffness=4e5))
    kept = {"model": "segment", "count": 49, "samples": 18}
    alone = moved(first)
    apart = []
    for share in (1.0, 1e-2, 1e-4):
        second = replace(first, preload=0.3 * share, mass=0.01 * share, contact=Contact(stiffness=4e5 * share))
        second = replace(second, position=0.331)
        found = run_motors(BEAM, FORCES, HERTZ, 4e-3, sliders=[first, second], **kept)
        apart.append(float(np.abs(found[0].height - alone.height).max()))
    assert apart[0] > 10.0 * apart[1] > 100.0 * apart[2] > 0.0


def test_a_run_in_two_halves_is_the_whole_run():
    for coupling in ("one-way", "two-way"):
        slider = replace(
            SLIDER, coupling=coupling, preload=1.3, mass=0.03, contact=Contact(stiffness=3e6, damping=30.0)
        )
        period = 1.0 / HERTZ
        whole = moved(slider, 12 * period, samples=13)
        first = moved(slider, 6 * period, samples=7)
        second = moved(slider, 6 * period, samples=7, continue_from=first)
        assert second.times[0] == pytest.approx(first.times[-1])
        assert second.travelled[-1] == pytest.approx(whole.travelled[-1], rel=1e-7)
        assert second.height[-1] == pytest.approx(whole.height[-1], rel=1e-6)


def test_a_hard_slider_flies_on_where_a_run_has_left_it():
    light = Slider(mass=1e-3, mu=0.3, law="tanh", slope=300.0, preload=0.4, coupling="one-way", contact=Contact())
    slider, period = replace(light, contact=Contact(restitution=0.35)), 1.0 / HERTZ
    whole = moved(slider, 9 * period, samples=10)
    run, lands = None, 0
    for _ in range(9):
        run = moved(slider, period, samples=2, continue_from=run)
        lands += int((run.events[:, 1] == 4.0).sum())
    assert lands == int((whole.events[:, 1] == 4.0).sum()) > 2
    assert run.travelled[-1] == pytest.approx(whole.travelled[-1], rel=1e-6)
    assert run.height[-1] == pytest.approx(whole.height[-1], rel=1e-6)


def test_books_of_every_slider_close_and_what_a_slider_gets_the_beam_has_lost():
    first = replace(SLIDER, coupling="two-way", preload=0.3, mass=0.01, foot=(), contact=Contact(stiffness=4e5))
    second = replace(first, position=0.331, mu=0.4, contact=Contact(stiffness=3e5, damping=3.0))
    kept = {"model": "segment", "count": 49, "samples": 18, "steps_per_period": 509}
    for found in run_motors(BEAM, FORCES, HERTZ, 4e-3, sliders=[first, second], **kept):
        books = found.ledger
        assert abs(books.residual) < 1e-3 * (abs(books.across) + abs(books.along))
        assert books.on_beam == pytest.approx(-(books.across + books.along), rel=1e-9)


def pinned_answers(x, at, hertz, ratio):
    """Deflections of the plain pinned beam at places under 1 N at x, by its sines."""
    n = np.arange(1, 2001)[:, None] * np.pi / BEAM.length
    own = n**2 * np.sqrt(BEAM.bending_stiffness / BEAM.mass_per_length)
    omega = 2.0 * np.pi * hertz
    share = 2.0 / (BEAM.mass_per_length * BEAM.length) / (own**2 - omega**2 + 2j * ratio * own * omega)
    return (share * np.sin(n * x) * np.sin(n * at)).sum(axis=0)


def test_sliders_that_the_beam_feels_only_together_are_felt():
    """What all of them move the surface by under each, over what the drive moves: each by itself is under a thousandth."""
    ratio, hertz = 0.011, 3911.0
    first = replace(SLIDER, coupling="auto", gravity=0.0, preload=1.3e-3, foot=(), contact=Contact(stiffness=4e5))
    sliders = [first, replace(first, position=0.331, preload=0.9e-3), replace(first, position=0.268, mu=0.4)]
    asked = {"model": "analytic", "modal_damping": ratio, "modes": 9, "samples": 2}
    together = run_motors(BEAM, FORCES, hertz, 2e-5, sliders=sliders, **asked)
    alone = [run_motor(BEAM, FORCES, hertz, 2e-5, slider=one, **asked) for one in sliders]
    at = np.array([one.position for one in sliders])
    driven = [
        one.amplitude * np.exp(1j * np.radians(one.phase_deg)) * pinned_answers(one.position, at, hertz, ratio)
        for one in FORCES
    ]
    lifted = sum(one.preload * np.abs(pinned_answers(one.position, at, hertz, ratio)) for one in sliders)
    across = lifted / np.abs(sum(driven))
    assert not any(run.coupling.two_way for run in alone)
    for run in together:
        assert run.coupling.two_way
        assert run.coupling.normal_size == pytest.approx(across.max(), rel=1e-3)
        felt = run.coupling
        assert run.notes[1].endswith(
            "all that presses the sliders on moves the surface under any of them by at most "
            f"{felt.normal_size:.1e} of its motion, their friction by at most {felt.friction_size:.1e} of its speed"
        )
