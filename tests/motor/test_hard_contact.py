"""A hard contact with restitution: flights, bounces and impacts against exact parabolas, sliding against DOP853."""

from math import asin, cos, pi, sin, sqrt

import numpy as np
import pytest
import reference.motor as by
from driven_strip import HALF, MIDDLE, OMEGA, PERIOD, drive, on_strip
from msgspec.structs import replace

from verify.cases.landing import landing_phase
from verify.contact.state import LANDS, LEAVES
from verify.problem.slider import Contact, Slider

GRAVITY, MASS = 9.81e-3, 2.3e-3
"""So little that the wave is 20 pm high: the material below a place moves along by nothing then."""


def point(contact, **given):
    own = {"mass": MASS, "mu": 0.2, "law": "coulomb", "gravity": GRAVITY, "coupling": "one-way", **given}
    return Slider(contact=contact, **own)


def shaken(ratio, contact, periods=12, steps=64, **asked):
    """(run, phases of landings, of leavings) held over a place that shakes as A sin theta, A = ratio g/omega^2."""
    amplitude = ratio * GRAVITY / OMEGA**2
    run = on_strip(point(contact), amplitude, periods=periods, steps=steps, **{"speed": 0.0, **asked})
    phases = run.events[:, 0] * OMEGA + 0.5 * pi - drive(amplitude)[1].k * MIDDLE
    phases -= 2.0 * pi * np.floor(phases[:1] / (2.0 * pi))
    return run, phases[run.events[:, 1] == LANDS], phases[run.events[:, 1] == LEAVES]


@pytest.mark.parametrize("steps", [32, 101])
@pytest.mark.parametrize(
    ("ratio", "restitution"), [(1.9, 0.4), (1.3, 0.6), (2.3, 0.5), (1.5, 0.0), (sqrt(1.0 + pi**2), 0.0)]
)
def test_landings_are_those_of_parabolas_at_any_step(ratio, restitution, steps):
    _, lands, leaves = shaken(ratio, Contact(restitution=restitution), steps=steps)
    wanted = [one.phase for one in by.bounces(ratio, restitution, 12)][:8]
    assert leaves[0] == pytest.approx(asin(1.0 / ratio), abs=2e-9)
    assert lands[:8] == pytest.approx(wanted, abs=2e-7)
    assert lands[0] == pytest.approx(wanted[0], abs=3e-9)


def test_a_thousand_bounces_die_away_and_the_point_leaves_at_the_same_phase():
    run, lands, leaves = shaken(1.01, Contact(restitution=0.99), periods=10)
    assert run.statistics.stopped == "end"
    assert len(lands) > 7000
    assert leaves - 2.0 * pi * np.arange(10) == pytest.approx(np.full(10, asin(1.0 / 1.01)), abs=1e-6)
    assert abs(run.energy.residual) < 1e-8 * run.energy.contact_loss


@pytest.mark.parametrize("restitution", [1.0, 1.0 - 1e-12])
def test_bounces_without_loss_never_come_to_rest(restitution):
    run, lands, leaves = shaken(1.9, Contact(restitution=restitution), periods=200)
    assert lands[:5] == pytest.approx([one.phase for one in by.bounces(1.9, restitution, 12)][:5], abs=2e-7)
    assert len(lands) > 20
    assert len(leaves) == 1
    assert run.energy.contact_loss == pytest.approx(0.0, abs=1e-20)


@pytest.mark.parametrize(("ratio", "restitution"), [(1.9, 0.4), (2.3, 0.5), (1.7, 0.0)])
def test_impacts_lose_the_kinetic_energy_that_restitution_leaves_out(ratio, restitution):
    """M (1 - e^2)/2 times the square of every relative speed of landing."""
    run, lands, _ = shaken(ratio, Contact(restitution=restitution), periods=6)
    speed = ratio * GRAVITY / OMEGA
    landed = by.bounces(ratio, restitution, 12)[: len(lands)]
    lost = sum(0.5 * MASS * (1.0 - restitution**2) * (one.closing * speed) ** 2 for one in landed)
    assert run.energy.contact_loss == pytest.approx(lost, rel=1e-6)
    assert abs(run.energy.residual) < 1e-10 * run.energy.contact_loss


@pytest.mark.parametrize(("ratio", "restitution"), [(1.9, 0.4), (1.5, 0.0), (0.7, 0.3)])
def test_the_work_that_holds_a_speed_is_mu_n_times_the_way(ratio, restitution):
    held = -3e-6
    contact = Contact(restitution=restitution)
    run, *_ = shaken(ratio, contact, 6, 640, speed=held, fixed_position=True, samples=2)
    assert run.energy.load_work == pytest.approx(-0.2 * run.normal_force[-1] * 6.0 * PERIOD * held, rel=1e-9)
    assert abs(run.energy.residual) < 1e-6 * run.energy.friction_loss


def thrown(ratio, restitution, off, periods, held=0.0, mu=0.2):
    """(phases of landings, the bounce, run) of a point that has left in step, but for `off` of its speed."""
    amplitude, bounce = ratio * GRAVITY / OMEGA**2, by.periodic_bounce(ratio, restitution)
    slider = point(Contact(restitution=restitution), mu=mu)
    before = on_strip(slider, amplitude, periods=1, steps=64, speed=0.0)
    lead = (0.5 * pi - drive(amplitude)[1].k * MIDDLE) % (2.0 * pi)
    flown, speed = (lead - bounce.phase) % (2.0 * pi), (1.0 + off) * bounce.speed
    contact = before.end.contact
    feet, touch = contact.feet.copy(), contact.contacts.copy()
    feet["height"] = amplitude * (sin(bounce.phase) + speed * flown - 0.5 * flown**2 / ratio)
    feet["velocity_z"] = amplitude * OMEGA * (speed - flown / ratio)
    touch["depth"] = -1.0  # in the air
    went = replace(before, end=replace(before.end, contact=contact._replace(feet=feet, contacts=touch)))
    asked = {"speed": held, "samples": periods + 1, "start": went}
    run = on_strip(slider, amplitude, periods=periods, steps=64, **asked)
    return run.events[run.events[:, 1] == LANDS, 0] * OMEGA + lead, bounce, run


@pytest.mark.parametrize("restitution", [0.35, 0.6])
def test_bouncing_in_step_is_stable_between_its_limits_alone(restitution):
    low, high = by.bouncing_limits(restitution)
    phases, bounce, _ = thrown(0.4 * low + 0.6 * high, restitution, 1e-3, 60)
    assert np.diff(phases)[-12:] == pytest.approx(2.0 * pi, abs=1e-7)
    assert phases[-1] % (2.0 * pi) == pytest.approx(bounce.phase, abs=1e-7)
    phases, bounce, _ = thrown(1.05 * high, restitution, 1e-3, 60)
    assert max(abs(one) for one in bounce.multipliers) > 1.05
    assert np.abs(np.diff(phases)[-12:] - 2.0 * pi).max() > 1e-2


def test_a_deviation_decays_by_the_larger_multiplier():
    phases, bounce, _ = thrown(0.97 * by.bouncing_limits(0.35)[1], 0.35, 1e-3, 20)
    away, largest = phases % (2.0 * pi) - bounce.phase, max(bounce.multipliers, key=abs)
    assert largest.imag == 0.0
    assert away[6:12] / away[5:11] == pytest.approx(largest.real, abs=0.02)


def test_a_bouncing_point_gains_mu_of_every_impact_until_it_runs_as_the_surface_where_it_lands():
    """By mu (1 + e) times the speed of landing each time; then by what is left to u = -V sin(phase)."""
    restitution, mu = 0.35, 4e-4
    low, high = by.bouncing_limits(restitution)
    ratio = 0.7 * low + 0.3 * high
    _, bounce, run = thrown(ratio, restitution, 0.0, 40, held=None, mu=mu)
    amplitude = ratio * GRAVITY / OMEGA**2
    blow = mu * (1.0 + restitution) * amplitude * OMEGA * (bounce.speed + cos(bounce.phase))
    last = -HALF * drive(amplitude)[1].k * OMEGA * amplitude * sin(bounce.phase)
    assert run.speed[-1] == pytest.approx(last, rel=1e-6)
    gained = -np.diff(run.speed)
    assert gained[gained > 0.999 * blow] == pytest.approx(blow, rel=1e-6)
    assert np.count_nonzero(gained > 0.999 * blow) == int(abs(last) / blow) > 3
    assert abs(run.energy.residual) < 1e-9 * run.energy.contact_loss


@pytest.mark.parametrize("share", [0.2, 0.5])
def test_a_stiff_spring_with_a_dashpot_tends_to_a_hard_contact_of_its_restitution(share):
    """It starts with an impact, at rest on a surface that rises, and lands later by its duration, of first order."""
    zeta, ratio = by.damping_ratio_for(share), 2.3
    lead = (0.5 * pi - drive(1e-9)[1].k * MIDDLE) % (2.0 * pi)
    wanted, off = by.bounces(ratio, share, 4, (lead, (1.0 + share) * cos(lead)))[0].phase, []
    for times in (50.0, 100.0, 200.0):
        stiffness = MASS * (times * OMEGA) ** 2
        contact = Contact(stiffness=stiffness, damping=2.0 * zeta * sqrt(stiffness * MASS))
        off.append(abs(shaken(ratio, contact, periods=4, steps=9000)[1][0] - wanted))
    assert off[-1] < 0.03
    assert np.log2(np.array(off)[:-1] / np.array(off)[1:]) == pytest.approx(1.0, abs=0.4)


@pytest.mark.parametrize("ratio", [0.35, 0.8])
def test_a_point_that_stays_on_is_driven_by_the_troughs(ratio):
    """N = P (1 - Gamma sin theta) and u = -V sin theta: 2 Gamma/pi of mu P in the mean, against the crests."""
    asked = {"speed": 0.0, "fixed_position": True, "samples": 4}
    run = on_strip(point(Contact()), ratio * GRAVITY / OMEGA**2, periods=3, steps=1000, **asked)
    assert len(run.events) == 0
    assert run.normal_force[-1] == pytest.approx(MASS * GRAVITY, rel=1e-5)
    assert run.friction[-1] / (0.2 * MASS * GRAVITY) == pytest.approx(2.0 * ratio / pi, abs=1e-5)


@pytest.mark.parametrize(("speed", "steps"), [(1.3e-3, 122), (-0.9e-3, 976)])
def test_a_point_kept_at_its_place_lands_once_a_period_at_any_speed(speed, steps):
    ratio, amplitude = 1.1, 4.1e-7
    slider = point(Contact(), gravity=amplitude * OMEGA**2 / ratio)
    run = on_strip(slider, amplitude, periods=20, steps=steps, samples=21, speed=speed, fixed_position=True)
    share = 1.0 - (landing_phase(ratio) - asin(1.0 / ratio)) / (2.0 * pi)
    assert np.count_nonzero(run.events[:, 1] == LANDS) == 20
    assert run.contact_fraction[2:].mean() == pytest.approx(share, abs=1e-5)
    assert run.energy.slope_work == 0.0


@pytest.mark.parametrize(("speed", "steps"), [(0.0, 61), (3.1e-5, 64), (-2.2e-5, 61)])
def test_friction_of_a_hard_point_reverses_within_the_step(speed, steps):
    """Mean of sign(u - v) (g + w_tt)/g by quadrature over a period."""
    amplitude, gravity, back = 3.7e-8, 100.0, 0.2
    times = np.arange(200_000) * PERIOD / 200_000
    _, rise, _, along = by.surface(drive(amplitude, back)[1].at, MIDDLE, times, HALF)
    wanted = np.mean(np.sign(along - speed) * (1.0 + np.gradient(rise, times) / gravity))
    slider = point(Contact(), gravity=gravity)
    run = on_strip(slider, amplitude, back, periods=4, steps=steps, samples=5, speed=speed, fixed_position=True)
    assert run.friction[1:].mean() / (0.2 * MASS * gravity) == pytest.approx(wanted, abs=1e-3)


def test_a_run_continued_in_flight_equals_one_run():
    slider = Slider(mass=1e-3, mu=0.3, law="tanh", slope=300.0, preload=0.4, coupling="one-way", contact=Contact())
    slider = replace(slider, contact=Contact(restitution=0.35))
    whole, run = on_strip(slider, periods=9, samples=10), None
    for _ in range(9):
        run = on_strip(slider, periods=1, samples=2, start=run)
    assert np.count_nonzero(whole.events[:, 1] == LANDS) > 2
    assert run.travelled[-1] == pytest.approx(whole.travelled[-1], rel=1e-6)
    assert run.height[-1] == pytest.approx(whole.height[-1], rel=1e-6)
