"""Sliders held at a speed so small that what gives way under them takes long to slip: the force of one that has."""

from types import SimpleNamespace

import numpy as np
import pytest
from motor_setups import HALF, HERTZ, MIDDLE, OMEGA, STRIP, drive
from msgspec.structs import replace

from verify.errors import InputError
from verify.motor import figures
from verify.motor.case import MotorCase
from verify.motor.figures import at_speed, no_load
from verify.motor.gripping import dragged_at
from verify.motor.withheld import not_settled
from verify.slider import Contact, Foot, Slider
from verify.studies.motor.words import unsettled

MASS, MU, PRELOAD, WAVE = 0.015, 0.23, 0.31, 2.6e-7
STIFF, DASHPOT, GRIP = 6.1e4, 8.0, 3.3e5
FORCES, WAVES = drive(WAVE, backward=1.0)
"""A standing wave: a running one has a mean speed, of second order, where a slider is held."""
PLACE = MIDDLE + 0.0061
LIFT, _, RISE, *_ = WAVES.at(PLACE, 0.0)
"""Deflection and slope where the slider is held, metres and radians; both go as cos(omega t)."""
CASE = MotorCase(
    beam=STRIP,
    forces=FORCES,
    frequency_hz=HERTZ,
    slider=Slider(
        mass=MASS,
        mu=MU,
        law="coulomb",
        position=PLACE,
        coupling="one-way",
        gravity=0.0,
        preload=PRELOAD,
        contact=Contact(stiffness=STIFF, damping=DASHPOT, tangential_stiffness=GRIP),
    ),
    model="analytic",
    count=None,
    steps_per_period=244,
)


def played(speed, steps=2000, turns=2):
    """Mean friction of a point that has slipped: its stretch follows the surface as far as friction lets it, by hand."""
    theta = 2.0 * np.pi * np.arange(turns * steps) / steps
    held = STIFF + 1j * OMEGA * DASHPOT
    pressed = held * (-MASS * OMEGA**2) / (held - MASS * OMEGA**2) * LIFT
    most = MU * (PRELOAD + (pressed * np.exp(1j * theta)).real) / GRIP
    assert most.min() > 0.0, "it leaves the surface"
    along = -HALF * RISE * np.cos(theta) - speed * theta / OMEGA
    stretch, found = -most[0] * np.sign(speed), []
    for gone, limit in zip(np.diff(along).tolist(), most[1:].tolist(), strict=True):
        stretch = max(-limit, min(stretch + gone, limit))
        found.append(stretch)
    return GRIP * float(np.mean(found[-steps:]))


@pytest.mark.parametrize("speed", [1e-9, -1e-8, 2e-7])
def test_a_slider_that_creeps_is_told_the_force_of_one_that_slips(speed):
    """At 1e-9 m/s it takes 160 s, or 680 000 periods, to slip: two blocks of them differ by 1e-5 of mu N until then."""
    found = at_speed(CASE, speed)
    assert not found.unsettled
    assert found.taken_up < 1e-4
    assert found.force == pytest.approx(played(speed), rel=4e-3)


def test_a_slider_is_dragged_until_the_softest_of_unlike_points_slips_under_all_that_presses():
    """Under one force a foot of 0.4 mm of a layer is stretched 17 times as far as a third of one of 20 mm."""
    layer = Contact(layer_stiffness=3.1e6, layer_tangential_stiffness=1.65e7)
    feet = (Foot(length=0.02, points=3), Foot(length=4e-4, offset=0.017))
    slider = replace(CASE.slider, contact=layer, foot=feet)
    seconds = 12.0 / HERTZ
    full = MU * PRELOAD / (1.65e7 * 4e-4)
    for speed in (1e-9, -1e-9):
        assert abs(dragged_at(slider, speed, seconds)) * seconds > 2.0 * full
        assert dragged_at(slider, speed, seconds) * speed > 0.0
    assert dragged_at(slider, 2.0 * full / seconds, seconds) is None


def test_runs_in_which_a_slider_is_dragged_are_among_the_time_that_a_search_takes(monkeypatch):
    """A search for the speed without load hears of every run before its first halving: two ends and standing still."""
    whole, estimated, told = figures._whole, [], []

    def counted(run):
        estimated.append(run.statistics.estimated_s)
        return whole(run)

    def heard(field, value, seconds, remedy):
        if field == "reach":
            told.append(seconds)
            raise InputError("enough")

    monkeypatch.setattr(figures, "_whole", counted)
    monkeypatch.setattr(figures, "check_work", heard)
    with pytest.raises(InputError, match="enough"):
        no_load(CASE, 1e-7)
    assert told == [pytest.approx(sum(estimated), rel=1e-9)]


def test_what_has_not_slipped_yet_is_no_mean(monkeypatch):
    monkeypatch.setattr(figures, "dragged_at", lambda slider, speed, seconds: None)
    found = at_speed(CASE, 1e-9, periods=96)
    assert found.taken_up == pytest.approx(1.0, rel=1e-3)
    assert "force" in found.unsettled
    assert found.spread >= 0.99 * MU * PRELOAD > abs(played(1e-9) - found.force)
    assert found.crept
    told = not_settled(CASE, found, ("force",), 96)
    assert "at 1e-09 m/s what gives way along the surface takes up 100 % of the slider's way" in told


SPREAD = 0.03 * MU * PRELOAD
"""Of a mean friction, newton: more than lets it stand."""


def test_only_what_leaves_the_surface_is_said_to_bounce():
    settled = at_speed(CASE, 1e-5)
    creeps = replace(settled, unsettled=("force",), taken_up=0.03, spread=SPREAD, crept=True)
    swings = replace(creeps, taken_up=0.012, crept=False)
    bounces = replace(swings, contact_share=0.83)
    said = [not_settled(CASE, one, ("force",), 48) for one in (creeps, swings, bounces)]
    assert "what gives way along the surface takes up 3 % of the slider's way and has not all slipped" in said[0]
    assert said[0].endswith(": give more periods, or more speed")
    assert "the slider stays on the surface, and its means have not settled by then" in said[1]
    assert said[1].endswith(": give more periods, more slider.contact.damping or more slider.preload")
    assert "the slider bounces and its means have not settled by then" in said[2]
    late = not_settled(CASE, creeps, ("force",), 2 * creeps.periods)
    assert late.endswith(": set VERIFY_PATIENCE to more seconds, or give more speed")
    free = SimpleNamespace(settled=True)
    field = SimpleNamespace(title="exact beam", curve=(settled, bounces, creeps, bounces, swings), free=free)
    first, second, third = unsettled([field], False)
    assert first.startswith("bouncing: on the exact beam means at 2 of 5 held speeds have not settled")
    assert second.startswith("creeping, all points on the surface: on the exact beam means at 1 of 5 held speeds")
    assert third.startswith("not come to rest, all points on the surface: on the exact beam means at 1 of 5 held")
    assert ["slider.contact.damping or more slider.preload" in one for one in (first, second, third)] == [
        True,
        False,
        True,
    ]


def test_a_slider_that_leaves_the_surface_and_creeps_is_told_to_take_more_time_and_not_more_damping():
    hops = replace(
        at_speed(CASE, 1e-5), unsettled=("force",), taken_up=0.4, spread=SPREAD, crept=True, contact_share=0.6
    )
    field = SimpleNamespace(title="exact beam", curve=(hops, hops), free=SimpleNamespace(settled=True))
    (told,) = unsettled([field], False)
    assert told.startswith("creeping, points leaving the surface: on the exact beam means at 2 of 2 held speeds")
    assert "damping" not in told
    assert "over more periods" in told


@pytest.mark.parametrize(
    ("contact", "preload", "speed", "periods", "damping"),
    [
        (Contact(stiffness=STIFF, damping=0.01), PRELOAD, 1e-4, 240, 1.0),
        (CASE.slider.contact, PRELOAD, 0.01, 48, 40.0),
        (Contact(stiffness=0.81 * MASS * OMEGA**2, damping=0.5, tangential_stiffness=GRIP), 30.0, 0.01, 480, 20.0),
    ],
)
def test_what_swings_on_its_contact_and_stays_on_is_not_said_to_creep(contact, preload, speed, periods, damping):
    """Of the last, near resonance, 1.2 % of the way is taken up, but more speed settles nothing. Damping settles all."""
    case = replace(CASE, slider=replace(CASE.slider, preload=preload, contact=contact))
    found = at_speed(case, speed, periods=periods)
    assert not found.bounces
    assert not found.crept
    told = not_settled(case, found, ("force",), periods)
    assert "the slider stays on the surface, and its means have not settled" in told
    assert told.endswith(": give more periods, more slider.contact.damping or more slider.preload")
    calm = case.on(replace(case.slider, contact=replace(contact, damping=damping)))
    assert not at_speed(calm, speed, periods=240).unsettled
