"""A motor's point on a hard contact, held over a shaking place: flights, bounces and blows beside exact parabolas."""

from math import asin, cos, pi, sin, sqrt

import motor_references as by
import numpy as np
import pytest
from motor_references import bounces
from motor_setups import HALF, HERTZ, MIDDLE, OMEGA, PERIOD, STRIP, drive, ridden
from msgspec.structs import replace

from verify.contact import bouncing, landing
from verify.motor import records
from verify.slider import Contact, Slider

GRAVITY, MASS = 9.81e-3, 2.3e-3
"""So little that the wave is 20 pm high: the material below a place moves along by nothing then."""
LANDS, LEAVES = 4, 5
DIES = ((1.5, 0.0), (2.0, 0.0), (sqrt(1.0 + pi**2), 0.0))


def flown(ratio, contact, periods=12, step=64, gravity=GRAVITY, **slider):
    """(run, phases of landings, phases of leavings) over a place that shakes as A sin theta, A = ratio g/omega^2."""
    amplitude = ratio * gravity / OMEGA**2
    given = {"mass": MASS, "mu": 0.2, "law": "coulomb", "gravity": gravity, "coupling": "one-way", **slider}
    run = ridden(Slider(contact=contact, **given), amplitude, periods=periods, step=step, held_speed=0.0)
    lead = 0.5 * pi - drive(amplitude)[1].k * MIDDLE
    phases = run.events[:, 0] * OMEGA + lead
    phases -= 2.0 * pi * np.floor(phases[0] / (2.0 * pi))
    return run, phases[run.events[:, 1] == LANDS], phases[run.events[:, 1] == LEAVES]


@pytest.mark.parametrize(("ratio", "restitution"), DIES)
def test_a_point_leaves_and_lands_at_the_phases_of_the_closed_form(ratio, restitution):
    _, lands, leaves = flown(ratio, Contact(restitution=restitution))
    assert leaves[0] == pytest.approx(asin(1.0 / ratio), abs=2e-9)
    assert lands[0] == pytest.approx(bouncing.landing_phase(ratio), abs=2e-9)
    again = np.diff(lands[:6]) / (2.0 * pi)
    assert again == pytest.approx(np.round(again), abs=1e-9)
    assert again.min() > 0.99


@pytest.mark.parametrize(("ratio", "phase"), [(1.5, 4.295944393155), (2.0, 5.182450251310)])
def test_landing_phases_are_those_of_thirty_digits(ratio, phase):
    assert flown(ratio, Contact())[1][0] == pytest.approx(phase, abs=2e-9)


@pytest.mark.parametrize("step", [32, 101])
@pytest.mark.parametrize(("ratio", "restitution"), [(1.9, 0.4), (1.3, 0.6), (2.3, 0.5)])
def test_a_point_bounces_as_parabolas_do_whatever_the_step(ratio, restitution, step):
    _, lands, _ = flown(ratio, Contact(restitution=restitution), step=step)
    wanted = [one.phase for one in bounces(ratio, restitution, 12)][:8]
    assert lands[:8] == pytest.approx(wanted, abs=2e-7)
    assert lands[0] == pytest.approx(wanted[0], abs=3e-9)


@pytest.mark.parametrize(("ratio", "restitution", "periods"), [(1.01, 0.99, 10), (1.001, 0.999, 2)])
def test_bounces_that_lose_little_die_away_and_the_point_leaves_again_at_the_same_phase(ratio, restitution, periods):
    """After a thousand blows and more, of which rounding feeds the last."""
    run, lands, leaves = flown(ratio, Contact(restitution=restitution), periods=periods)
    assert run.statistics.stopped == "end"
    assert len(lands) > 700 * periods
    assert leaves - 2.0 * pi * np.arange(periods) == pytest.approx(np.full(periods, asin(1.0 / ratio)), abs=1e-6)
    assert abs(run.ledger.residual) < 1e-8 * run.ledger.impacts


@pytest.mark.parametrize("restitution", [1.0, 1.0 - 1e-12])
def test_bounces_that_lose_nothing_go_on(restitution):
    """They land as parabolas do as long as these can be followed, and none is a rest."""
    run, lands, leaves = flown(1.9, Contact(restitution=restitution), periods=200)
    assert lands[:5] == pytest.approx([one.phase for one in bounces(1.9, restitution, 12)][:5], abs=2e-7)
    assert len(lands) > 20
    assert len(leaves) == 1
    assert run.ledger.impacts == pytest.approx(0.0, abs=1e-20)


@pytest.mark.parametrize(("ratio", "restitution"), [(1.9, 0.4), (2.3, 0.5), (1.7, 0.0)])
def test_blows_lose_what_restitution_leaves_out_and_the_books_close(ratio, restitution):
    """M (1 - e^2)/2 times the square of every relative speed of landing."""
    run, lands, _ = flown(ratio, Contact(restitution=restitution), periods=6)
    speed = ratio * GRAVITY / OMEGA
    landed = bounces(ratio, restitution, 12)[: len(lands)]
    lost = sum(0.5 * MASS * (1.0 - restitution**2) * (one.closing * speed) ** 2 for one in landed)
    assert run.ledger.impacts == pytest.approx(lost, rel=1e-6)
    assert abs(run.ledger.residual) < 1e-10 * run.ledger.impacts


@pytest.mark.parametrize(("ratio", "restitution"), [(1.9, 0.4), (1.5, 0.0), (0.7, 0.3)])
def test_what_holds_a_speed_against_friction_stands_in_the_books(ratio, restitution):
    """It pulls against mu of every push and blow: work - mu (mean N) v t, friction being ahead all the time."""
    amplitude, held = ratio * GRAVITY / OMEGA**2, -3e-6
    slider = Slider(
        mass=MASS, mu=0.2, law="coulomb", gravity=GRAVITY, coupling="one-way", contact=Contact(restitution=restitution)
    )
    run = ridden(slider, amplitude, periods=6, step=640, held_speed=held, frozen=True, samples=2)
    books, pushed = run.ledger, float(run.normal_force[-1]) * 6.0 / HERTZ
    assert books.pulled == pytest.approx(-0.2 * pushed * held, rel=1e-9)
    assert abs(books.residual) < 1e-6 * books.rubbed


def thrown(ratio, restitution, off, periods, held=0.0, mu=0.2):
    """(phases of landings, the bounce, run) of a point that has left in step, but for `off` of its speed."""
    amplitude, bounce = ratio * GRAVITY / OMEGA**2, bouncing.bounce_in_step(ratio, restitution)
    slider = Slider(
        mass=MASS,
        mu=mu,
        law="coulomb",
        gravity=GRAVITY,
        coupling="one-way",
        contact=Contact(restitution=restitution),
    )
    before = ridden(slider, amplitude, periods=1, step=64, held_speed=0.0)
    lead = (0.5 * pi - drive(amplitude)[1].k * MIDDLE) % (2.0 * pi)
    flown, speed = (lead - bounce.phase) % (2.0 * pi), (1.0 + off) * bounce.speed
    feet = np.zeros((1, 4))
    feet[0, 0] = amplitude * (sin(bounce.phase) + speed * flown - 0.5 * flown**2 / ratio)
    feet[0, 1] = amplitude * OMEGA * (speed - flown / ratio)
    assert feet[0, 0] > amplitude * sin(lead)
    touch = before.state.touch.copy()
    touch[0, records.DEPTH] = -1.0  # in the air
    went = replace(before, state=replace(before.state, feet=feet, touch=touch))
    asked = {"held_speed": held, "samples": periods + 1, "continue_from": went}
    run = ridden(slider, amplitude, periods=periods, step=64, **asked)
    return run.events[run.events[:, 1] == LANDS, 0] * OMEGA + lead, bounce, run


@pytest.mark.parametrize("restitution", [0.35, 0.6])
def test_in_step_between_its_limits_a_point_comes_back_into_step_and_above_them_it_does_not(restitution):
    low, high = bouncing.bouncing_limits(restitution)
    phases, bounce, _ = thrown(0.4 * low + 0.6 * high, restitution, 1e-3, 60)
    turns = np.diff(phases)[-12:]
    assert turns == pytest.approx(2.0 * pi, abs=1e-7)
    assert phases[-1] % (2.0 * pi) == pytest.approx(bounce.phase, abs=1e-7)
    phases, bounce, _ = thrown(1.05 * high, restitution, 1e-3, 60)
    assert max(abs(one) for one in bounce.multipliers) > 1.05
    assert np.abs(np.diff(phases)[-12:] - 2.0 * pi).max() > 1e-2


def test_a_deviation_dies_out_by_the_multipliers_of_the_bounce():
    """At e = 0.35 near the upper limit both are real, and the larger one tells."""
    restitution = 0.35
    ratio = 0.97 * bouncing.bouncing_limits(restitution)[1]
    phases, bounce, _ = thrown(ratio, restitution, 1e-3, 20)
    away = phases % (2.0 * pi) - bounce.phase
    largest = max(bounce.multipliers, key=abs)
    assert largest.imag == 0.0
    assert away[6:12] / away[5:11] == pytest.approx(largest.real, abs=0.02)


@pytest.mark.parametrize("share", [0.2, 0.5])
def test_a_stiff_contact_with_a_dashpot_bounces_as_a_hard_one_of_its_restitution(share):
    """It starts with a blow, at rest on a surface that rises; it lands later by the time of that, of first order."""
    zeta, ratio = landing.damping_ratio_for(share), 2.3
    lead = (0.5 * pi - drive(1e-9)[1].k * MIDDLE) % (2.0 * pi)
    wanted = bounces(ratio, share, 4, (lead, (1.0 + share) * cos(lead)))[0].phase
    off = []
    for times in (50.0, 100.0, 200.0):
        stiffness = MASS * (times * OMEGA) ** 2
        damping = 2.0 * zeta * sqrt(stiffness * MASS)
        lands = flown(ratio, Contact(stiffness=stiffness, damping=damping), periods=4, step=9000)[1]
        off.append(abs(lands[0] - wanted))
    orders = np.log2(np.array(off)[:-1] / np.array(off)[1:])
    assert off[-1] < 0.03
    assert np.all((orders > 0.7) & (orders < 1.4))


@pytest.mark.parametrize("ratio", [0.35, 0.8])
def test_a_point_that_never_leaves_is_driven_by_troughs_that_press_harder(ratio):
    """N = P (1 - Gamma sin theta) and u = -V sin theta: 2 Gamma/pi of mu P in the mean, against the crests."""
    amplitude = ratio * GRAVITY / OMEGA**2
    slider = Slider(mass=MASS, mu=0.2, law="coulomb", gravity=GRAVITY, coupling="one-way", contact=Contact())
    run = ridden(slider, amplitude, periods=3, step=1000, held_speed=0.0, frozen=True, samples=4)
    assert len(run.events) == 0
    assert run.normal_force[-1] == pytest.approx(MASS * GRAVITY, rel=1e-5)
    assert run.friction[-1] / (0.2 * MASS * GRAVITY) == pytest.approx(2.0 * ratio / pi, abs=1e-5)


def test_a_bouncing_point_is_thrown_along_by_mu_of_every_blow_until_it_runs_as_the_surface_where_it_lands():
    """By mu (1 + e) times the speed of landing each time; then by what is left to u = -V sin(phase)."""
    restitution, mu = 0.35, 4e-4
    low, high = bouncing.bouncing_limits(restitution)
    ratio = 0.7 * low + 0.3 * high
    _, bounce, run = thrown(ratio, restitution, 0.0, 40, held=None, mu=mu)
    amplitude = ratio * GRAVITY / OMEGA**2
    blow = mu * (1.0 + restitution) * amplitude * OMEGA * (bounce.speed + cos(bounce.phase))
    last = -0.5 * STRIP.thickness * drive(amplitude)[1].k * OMEGA * amplitude * sin(bounce.phase)
    assert run.speed[-1] == pytest.approx(last, rel=1e-6)
    gained = -np.diff(run.speed)
    ramp = gained[gained > 0.999 * blow]
    assert ramp == pytest.approx(blow, rel=1e-6)
    assert len(ramp) == int(abs(last) / blow) > 3
    assert run.ledger.rubbed > 0.0
    assert abs(run.ledger.residual) < 1e-9 * run.ledger.impacts


@pytest.mark.parametrize(("law", "slope"), [("coulomb", None), ("tanh", 3e3)])
def test_a_hard_point_that_stays_on_sticks_and_slips_as_dop853_says(law, slope):
    """At 0.7 of what lifts it off, three periods from rest, of second order in the step."""
    amplitude, mu, load = 1e-6, 0.03, MASS * 1e-6 * OMEGA**2 / 0.7
    wave, times = drive(amplitude, 0.1)[1], np.arange(1, 4) / HERTZ
    point = by.Point(MASS, MASS, load, 1.0, mu=mu, slope=slope, half=0.5 * STRIP.thickness)
    followed = by.Resting(point, by.OneWay(wave.at, point.half)).run(by.body(x=MIDDLE), times[-1], times, times[0])
    slider = Slider(
        mass=MASS,
        mu=mu,
        law=law,
        slope=slope,
        gravity=0.0,
        preload=load,
        coupling="one-way",
        contact=Contact(),
    )

    def miss(steps):
        run = ridden(slider, amplitude, 0.1, 3, steps, samples=4)
        assert len(run.events[run.events[:, 1] == LEAVES]) == 0
        assert law == "tanh" or 0.1 < run.stuck_share[1:].mean() < 0.9
        return np.abs(run.speed[1:] - followed.states[:, by.V]).max() / np.abs(followed.states[:, by.V]).max()

    coarse, fine = (np.mean([miss(n) for n in steps]) for steps in ((97, 103, 107, 113), (1552, 1648, 1712, 1808)))
    assert fine < 2e-5
    assert 1.4 < np.log2(coarse / fine) / 4.0 < 2.6


@pytest.mark.parametrize("speed", [1.3e-3, -0.9e-3])
@pytest.mark.parametrize("step", [122, 976])
def test_a_point_that_is_kept_at_its_place_lands_once_a_period_at_any_speed(speed, step):
    """No slope comes along under it: it is touching from where a mass lands on a shaking place to where it leaves."""
    ratio, amplitude = 1.1, 4.1e-7
    slider = Slider(mass=MASS, mu=0.2, law="coulomb", gravity=amplitude * OMEGA**2 / ratio, contact=Contact())
    slider = replace(slider, coupling="one-way")
    run = ridden(slider, amplitude, periods=20, step=step, samples=21, held_speed=speed, frozen=True)
    share = 1.0 - (bouncing.landing_phase(ratio) - asin(1.0 / ratio)) / (2.0 * pi)
    assert np.count_nonzero(run.events[:, 1] == LANDS) == 20
    assert run.contact_share[2:].mean() == pytest.approx(share, abs=1e-5)
    assert run.ledger.uphill == 0.0


@pytest.mark.parametrize("speed", [0.0, 3.1e-5, -2.2e-5])
@pytest.mark.parametrize("step", [61, 64])
def test_friction_of_a_hard_point_turns_round_within_the_step(speed, step):
    """Held in a wave with a fifth of it coming back it is pushed as by quadrature: mean of sign(u - v) (g + w_tt)/g."""
    amplitude, gravity, mu, back = 3.7e-8, 100.0, 0.2, 0.2
    slider = Slider(mass=MASS, mu=mu, law="coulomb", gravity=gravity, coupling="one-way", contact=Contact())
    times = np.arange(200_000) * PERIOD / 200_000
    _, rise, _, along = by.felt(drive(amplitude, back)[1].at, MIDDLE, times, HALF)
    wanted = np.mean(np.sign(along - speed) * (1.0 + np.gradient(rise, times) / gravity))
    run = ridden(slider, amplitude, back, periods=4, step=step, samples=5, held_speed=speed, frozen=True)
    assert run.friction[1:].mean() / (mu * MASS * gravity) == pytest.approx(wanted, abs=1e-3)
