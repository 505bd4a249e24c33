"""Figures of a motor against closed forms of the driving layer; light, bouncing and creeping sliders; refusals."""

from math import acos, cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from driven_strip import HALF, HERTZ, MIDDLE, OMEGA, STRIP, drive
from msgspec.structs import replace
from reference.motor import bounces
from scipy.integrate import solve_ivp

from verify import Beam, Contact, Excitation, Foot, InputError, PointForce, Slider, simulate
from verify.analysis.solution_cache import SolutionCache
from verify.cases import layer
from verify.cases.foot_on_wave import AMPLITUDE, foot_on_wave
from verify.cases.wave import CREST
from verify.motor.curves import no_load, reversal, stop, transient
from verify.motor.periodic_orbit import periodic_orbit
from verify.motor.steady_state import MotorCase, crest_speed, steady_state, surface_motion
from verify.quantities.base import evaluate
from verify.quantities.motor import FreeRun
from verify.scene.load import load_scene, scene_from

HEIGHT, KAPPA, MU = 1e-8, 2e9, 0.2
FORCES, WAVE = drive(HEIGHT)
CRESTS = HALF * WAVE.k * OMEGA * HEIGHT


def case_of(slider, forces, **given):
    return MotorCase(
        beam=STRIP, forces=forces, frequency_hz=HERTZ, slider=slider, model="analytic", count=None, **given
    )


def motor(phi, mass=4.0):
    """(case, normal force) of an upright foot of one wavelength; 50 g of it move across."""
    load = 2.0 * KAPPA * HEIGHT * layer.normal_integral(phi, phi) / WAVE.k
    own = {"mass": mass, "mu": MU, "law": "coulomb", "gravity": 0.0, "preload": load, "position": MIDDLE}
    contact = Contact(layer_stiffness=KAPPA)
    feet = (Foot(length=2.0 * pi / WAVE.k, points=61, pitches=False, mass=0.05),)
    slider = Slider(coupling="one-way", contact=contact, foot=feet, **own)
    return case_of(slider, FORCES, start="steady", steps_per_period=127), load


@pytest.mark.parametrize(("phi", "ratio"), [(0.8, 0.83), (2.3, 0.61), (3.0, -0.3)])
def test_friction_of_two_points_reverses_within_the_step(phi, ratio):
    """A step is 2/61 = 0.033 of the force."""
    wrong = []
    for steps in (61, 488):
        last = foot_on_wave(phi, ratio, 0.0, 2, steps)
        work = -last["friction"] * ratio * CREST * AMPLITUDE / HERTZ
        assert last["tangential_work"] == pytest.approx(work + last["friction_loss"], rel=1e-9)
        wrong.append(last["friction"] / (MU * last["normal_force"]) + layer.force(phi, ratio))
    assert abs(wrong[0]) < 6e-3
    assert abs(wrong[1]) < 6e-5


def one_point(**given):
    """A motor of one contact point on the wave of two unequal forces."""
    case, _ = motor(1.0)
    forces = (PointForce(position=0.012, amplitude=6.0), PointForce(position=0.25, amplitude=9.0, phase_deg=70.0))
    beam = Beam(length=0.26, width=0.012, thickness=0.0014, youngs_modulus=200e9, density=7850.0)
    own = {"mu": 0.25, "preload": 8.0, "position": 0.115, "contact": Contact(stiffness=2e5, damping=40.0)}
    slider = replace(case.slider, foot=(Foot(points=1, mass=0.02),), **own, **given.pop("slider", {}))
    return replace(case, beam=beam, forces=forces, frequency_hz=7300.0, slider=slider, **given)


@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("segment", 40)])
def test_the_crest_speed_is_what_the_slider_sees_with_damping(model, count):
    slow, damped = (one_point(model=model, count=count, modal_damping=zeta) for zeta in (None, 0.05))
    seen = damped.run(1, 62, None, 0.0).surface_speed
    assert crest_speed(damped) == pytest.approx(np.nanmax(abs(seen)), rel=3e-3)
    assert crest_speed(slow) < 0.9 * crest_speed(damped)


@pytest.mark.parametrize(("phase_sign", "towards"), [(1.0, -1.0), (-1.0, 1.0)])
def test_the_crest_speed_of_a_wave_is_against_it(phase_sign, towards):
    forces = [replace(one, phase_deg=phase_sign * one.phase_deg) for one in FORCES]
    case = replace(motor(1.0)[0], forces=tuple(forces))
    assert surface_motion(case)[1] == pytest.approx(towards * CRESTS, rel=2e-3)


@pytest.mark.parametrize(("tension", "foundation"), [(0.0, 0.0), (4300.0, 0.0), (0.0, 2.6e6), (-700.0, 1.1e6)])
def test_epsilon_is_over_a_wavelength_of_the_beam_under_tension_and_on_a_foundation(tension, foundation):
    case = one_point(model="fem", count=40)
    stiffness, mass = case.beam.pieces[0].bending_stiffness, case.beam.pieces[0].mass_per_length
    load = mass * (2.0 * pi * 7300.0) ** 2 - foundation
    k = sqrt((sqrt(tension**2 + 4.0 * stiffness * load) - tension) / (2.0 * stiffness))
    beam = replace(case.beam, tension=tension, foundation=foundation)
    give = Contact(stiffness=2e5, damping=40.0, tangential_stiffness=9e4)
    case = replace(case, beam=beam, slider=replace(case.slider, contact=give))
    found = case.run(1, 2).margins
    assert found.presliding == pytest.approx(2.0 * 0.25 * 2e5 / (9e4 * k * 0.0014), rel=1e-12)
    evanescent = replace(case, beam=replace(beam, foundation=foundation + 1.4 * load))
    assert evanescent.run(1, 2).margins.presliding is None


def test_a_motor_starts_by_the_layers_force_over_its_mass():
    """M dv/dt = mu N F(v/V): to 1 - 1/e of the no-load speed; near that with a time constant in closed form."""
    phi, mass = 1.0, 40.0
    case, load = motor(phi, mass=mass)
    speed, rate = layer.no_load_speed(phi), MU * load / (mass * CRESTS)

    def reached(t, r):
        return r[0] - (1.0 - exp(-1.0)) * speed

    reached.terminal = True
    span = (0.0, 5.0 / rate)
    wanted = solve_ivp(
        lambda t, r: [rate * layer.force(phi, r[0])], span, [0.0], events=reached, rtol=1e-9, max_step=0.01
    )
    found = transient(case, 300)
    start = found.time_constant(-speed * CRESTS)
    assert start.missing is None
    assert start.time == pytest.approx(wanted.t_events[0][0], rel=5e-3)
    assert abs(start.time - wanted.t_events[0][0]) < start.error + 2e-3 * start.time
    assert start.error < 0.02 * start.time
    psi, left = acos(speed), speed + found.speeds / CRESTS
    constant = (
        mass * CRESTS * sin(psi) * 2.0 * layer.normal_integral(phi, phi) / (4.0 * MU * load * (cos(psi) - cos(phi)))
    )
    last = (left > 0.005) & (left < 0.02)
    assert -1.0 / np.polyfit(found.times[last], np.log(left[last]), 1)[0] == pytest.approx(constant, rel=0.08)


def test_a_motor_stops_by_friction_alone():
    """1/e of the speed is left after (1 - 1/e) m v/(mu N)."""
    case, load = motor(1.0, mass=40.0)
    feet = (replace(case.slider.foot[0], points=9),)
    case = replace(case, slider=replace(case.slider, speed=-0.8 * CRESTS, foot=feet))
    before = transient(case, 2)
    found = stop(case, before, 200)
    wanted = (1.0 - exp(-1.0)) * 40.0 * abs(before.run.speed[-1]) / (MU * load)
    assert found.time_constant(0.0).time == pytest.approx(wanted, rel=5e-3)
    assert abs(found.speed) < 1e-6 * CRESTS


def light(shift, mass=3e-3):
    """A motor of one point under way within a period, with the phases of its drive shifted, deg."""
    forces = [(0.021, 1.4, shift), (0.27, 1.3, 80.0 + shift)]
    return MotorCase(
        beam=Beam(length=0.31, width=0.013, thickness=0.0012, youngs_modulus=68e9, density=2650.0),
        forces=tuple(PointForce(position=x, amplitude=f, phase_deg=phase) for x, f, phase in forces),
        frequency_hz=3175.0,
        slider=Slider(
            mass=mass, mu=0.23, law="coulomb", preload=0.5, gravity=0.0, coupling="one-way", position=0.15,
            contact=Contact(stiffness=6e4, damping=2.0),
        ),
        model="analytic",
        count=None,
    )  # fmt: skip


def test_a_light_motor_starts_and_stops_faster_than_means_over_a_drive_period_resolve():
    """(1 - 1/e) m v/(mu N) is a twelfth of a period; its speed swings by more than its mean within a period."""
    missing, speeds = set(), []
    for shift in (0.0, 60.0, 120.0, 180.0, 240.0, 300.0):
        case = light(shift)
        free = transient(case, 96)
        assert free.converged
        least = (1.0 - exp(-1.0)) * 3e-3 * abs(free.speed) / (0.23 * 0.5)
        assert 0.07 < least / case.period < 0.1
        ends = free.time_constant(), stop(case, free, 30).time_constant(0.0), reversal(case, free, 96).time_constant()
        missing |= {one.missing for one in ends}
        speeds.append(free.speed)
    assert missing <= {"resolution", "overshoot"}
    assert speeds == pytest.approx([speeds[0]] * 6, rel=4e-3)
    scene = load_scene("preloaded-motor", ("slider.mass=0.0005",))
    with pytest.raises(InputError, match=r"slider.mass = 0.0005 kg.*117"):  # half a period, µs
        evaluate("motor.start_time", {"model": "analytic", "periods": 400}, scene, SolutionCache(scene.beam))


WANDERING = {
    "name": "wandering",
    "beam": {
        "length": 0.43, "width": 0.02, "thickness": 0.0015, "youngs_modulus": 2e11, "density": 7800.0,
        "supports": ["clamped", "pinned"], "loss_factor": 0.01,
    },
    "drive": {
        "frequency_hz": 3170.0,
        "force": [{"position": 0.012, "amplitude": 30.0}, {"position": 0.41, "amplitude": 37.5, "phase_deg": 70.0}],
    },
    "slider": {
        "mass": 0.1, "mu": 0.25, "law": "coulomb", "preload": 1.2, "gravity": 0, "position": 0.17,
        "coupling": "one-way", "contact": {"stiffness": 1e5, "damping": 1.0},
        "foot": [{"length": 0.012, "points": 5}, {"length": 0.012, "points": 5, "face": "lower"}],
    },
}  # fmt: skip
"""Short feet on a wave of standing-wave ratio 4.6: the speed depends on the place."""
FORCES_OF_FOUR = [{"position": 0.012, "amplitude": 60.0}, {"position": 0.41, "amplitude": 75.0, "phase_deg": 70.0}]
LONG_AND_SHORT = [
    {"length": 0.02, "points": 5, "offset": -0.03, "mass": 0.003, "inertia": 2e-7},
    {"length": 0.008, "points": 3, "offset": 0.025, "mass": 0.009, "pitches": False, "face": "lower"},
]
CHAOTIC = {
    **WANDERING,
    "name": "chaotic",
    "drive": {"frequency_hz": 3170.0, "force": FORCES_OF_FOUR},
    "slider": {
        "mass": 0.4, "mu": 0.25, "law": "coulomb", "preload": 30.0, "position": 0.17, "coupling": "one-way",
        "contact": {"stiffness": 8e5, "damping": 30.0}, "foot": LONG_AND_SHORT,
    },
}  # fmt: skip


def measured(tables, name, **arguments):
    scene = scene_from(tables)
    return evaluate(f"motor.{name}", {"model": "analytic", **arguments}, scene, SolutionCache(scene.beam))


def test_a_slider_that_wanders_along_a_partly_standing_wave_has_no_time_constant():
    """Its speed rises to 29.4 mm/s, 63 % of which it has after 14.7 ms, and falls to 9.8 (simulated in many samples)."""
    case = FreeRun(model="analytic").case(scene_from(WANDERING))
    run = case.run(2000, 2000 * 20 + 1)
    means = (run.travelled[20:] - run.travelled[:-20]) / case.period
    peak = means.max()
    reached = run.times[np.argmax(means >= (1.0 - exp(-1.0)) * peak)] + 0.5 * case.period
    free = transient(case, 2000)
    start = free.time_constant()
    assert peak == pytest.approx(29.4e-3, rel=0.02)
    assert means[-10_000:].mean() == pytest.approx(free.speed, rel=0.02)
    assert start.missing == "overshoot"
    assert start.peak == pytest.approx(peak, rel=0.01)
    assert start.peak_time == pytest.approx(reached, abs=0.1 * case.period + 0.01 * reached)
    with pytest.raises(InputError, match="periods = 2000"):
        measured(WANDERING, "start_time", periods=2000)
    between = transient(replace(case, slider=replace(case.slider, speed=0.02)), 2000).time_constant()
    assert between.missing == "overshoot"
    assert between.peak == pytest.approx(peak, rel=0.02)


@pytest.mark.parametrize("tables", [WANDERING, CHAOTIC], ids=lambda one: one["name"])
@pytest.mark.parametrize("periods", [1000, 2000, 4000])
def test_the_speed_of_one_place_along_the_wave_is_no_steady_one(tables, periods):
    """Over 12 500 periods, half a wavelength, it changes threefold or more; no quarter of a shorter run is its mean."""
    free = transient(FreeRun(model="analytic").case(scene_from(tables)), periods)
    assert free.error > 0.05 * abs(free.speed)
    with pytest.raises(InputError, match=f"periods = {periods}"):
        measured(tables, "free_speed", periods=periods)


def test_the_errors_of_speed_and_start_time_cover_the_next_periods_and_another_phase_of_the_drive():
    """The phases shift the start by up to half a period; the slider moves on along a standing-wave ratio of 1.3."""
    speeds, times, after = [], [], []
    for shift in (0.0, 100.0):
        phases = (f"drive.force.0.phase_deg={shift}", f"drive.force.1.phase_deg={shift + 72.0}")
        scene = load_scene("preloaded-motor", (*phases, "slider.position=0.2437", "slider.mass=0.013"))
        for name, found in (("free_speed", speeds), ("start_time", times)):
            given = {"model": "analytic", "periods": 2000}
            found.append(evaluate(f"motor.{name}", given, scene, SolutionCache(scene.beam)))
        case = FreeRun(model="analytic").case(scene)
        run = case.run(2500, 2501)
        after.append((run.travelled[-1] - run.travelled[-501]) / (500.0 * case.period))
    assert abs(speeds[0] - after[0]) < speeds[0].error
    assert abs(speeds[1] - after[1]) < speeds[1].error
    assert abs(times[0] - times[1]) < times[0].error + times[1].error + 0.5 / 4276.0
    assert all(0.0 < one.error < 0.01 * abs(one) for one in (*speeds, *times))


def test_a_light_motor_runs_slower_than_the_speed_at_which_a_heavy_one_has_no_load():
    prescribed = no_load(light(0.0)).speed
    free = [transient(light(0.0, mass), 400).speed for mass in (1e-3, 0.3)]
    assert free[0] / prescribed == pytest.approx(0.2, abs=0.03)
    assert free[1] == pytest.approx(prescribed, rel=0.03)


def on_spring(ratio, zeta, **given):
    """A point on a linear spring that never leaves the wave: drive over natural frequency, damping ratio."""
    mass, own = 2e-3, OMEGA / ratio
    contact = Contact(stiffness=mass * own**2, damping=2.0 * zeta * mass * own)
    pressed = {"mu": MU, "gravity": 0.0, "preload": 30.0 * mass * HEIGHT * OMEGA**2, "position": MIDDLE}
    return case_of(Slider(mass=mass, coupling="one-way", contact=contact, **pressed), FORCES, **given)


@pytest.mark.parametrize(("ratio", "zeta"), [(0.6, 0.07), (1.9, 0.2)])
def test_a_periodic_orbit_has_the_multipliers_of_its_spring(ratio, zeta):
    """exp(omega_c T (-zeta +- i sqrt(1 - zeta^2))) over a period."""
    found = periodic_orbit(on_spring(ratio, zeta, steps_per_period=400))
    wanted = np.exp(2.0 * pi / ratio * (-zeta + 1j * sqrt(1.0 - zeta**2) * np.array([1.0, -1.0])))
    assert abs(found.multipliers).max() < 1.0
    assert found.residual < 1e-10
    assert np.sort_complex(np.array(found.multipliers)) == pytest.approx(np.sort_complex(wanted), abs=2e-3)


# --- means of a slider that bounces

MASS, PRELOAD, RATIO = 2.3e-3, 2.3e-5, 150.0
GRAVITY = PRELOAD / MASS
"""Acceleration of the surface over that of the fall: a flight lasts up to 48 periods, four blocks of means."""
SPRING = Contact(stiffness=MASS * (0.31 * OMEGA) ** 2, damping=0.02 * MASS * OMEGA)


def bouncing(ratio=RATIO, **given):
    """A point pressed on a place that a wave to the right shakes."""
    pressed = {"gravity": 0.0, "preload": PRELOAD, **given}
    slider = Slider(mass=MASS, mu=MU, law="coulomb", position=MIDDLE, coupling="one-way", **pressed)
    return case_of(slider, drive(ratio * GRAVITY / OMEGA**2)[0])


BOUNCING = {
    "plastic": bouncing(contact=Contact(restitution=0.0)),
    "restitution 0.5": bouncing(contact=Contact(restitution=0.5)),
    "spring": bouncing(contact=SPRING),
    "spring without loss": bouncing(contact=Contact(stiffness=SPRING.stiffness)),
    "clasp": bouncing(
        contact=SPRING, foot=(Foot(length=0.04, points=3), Foot(length=0.03, points=2, face="lower", offset=0.004))
    ),
    "below, with a weight": bouncing(
        contact=SPRING, gravity=9.81, preload=MASS * 9.81 + PRELOAD, foot=(Foot(face="lower"),)
    ),
}


@pytest.mark.parametrize("name", BOUNCING)
def test_the_mean_normal_force_of_a_bouncing_slider_balances_what_presses_it_on(name):
    """To a few flights in the window of a chaotic one; the reported spread covers what is missing."""
    one = steady_state(BOUNCING[name], 0.4 * crest_speed(BOUNCING[name]), periods=12_500)
    missing = abs(one.means.normal_force - PRELOAD)
    assert missing < (0.03 if name.startswith("restitution") else 0.01) * PRELOAD
    assert missing <= one.errors.normal_force + 1e-12 * PRELOAD
    assert one.converged("normal force") == (one.errors.normal_force <= 0.01 * max(one.means.normal_force, PRELOAD))
    assert abs(one.means.force) <= MU * one.means.normal_force * (1.0 + 1e-9)
    assert one.means.friction_power >= 0.0


def parabolas(ratio, restitution, turns, after):
    """(normal force over the preload, friction over mu times it) of a point in parabolas, after so many turns.

    The surface is A sin theta and runs against the wave on its crests: along +x where sin theta < 0.
    """
    landed = [one for one in bounces(ratio, restitution, turns) if one.phase >= 2.0 * pi * after]
    pushed = rubbed = 0.0
    for one in landed[1:]:
        blow = ratio * one.closing * (1.0 if one.left > one.phase else 1.0 + restitution)
        theta = np.linspace(one.phase, one.left, 4001)
        rides = np.maximum(1.0 - ratio * np.sin(theta), 0.0) * (one.left > one.phase)
        pushed += blow + np.trapezoid(rides, theta)
        rubbed -= blow * np.sign(np.sin(one.phase)) + np.trapezoid(rides * np.sign(np.sin(theta)), theta)
    span = landed[-1].phase - landed[0].phase
    return pushed / span, rubbed / span


@pytest.mark.parametrize(("ratio", "restitution"), [(RATIO, 0.3), (31.0, 0.0)])
def test_means_of_a_hard_point_are_those_of_parabolas(ratio, restitution):
    one = steady_state(bouncing(ratio, contact=Contact(restitution=restitution)), 0.0)
    push, rub = parabolas(ratio, restitution, 6000, 700)
    assert push == pytest.approx(1.0, abs=0.02)
    assert one.means.force / (MU * PRELOAD) == pytest.approx(rub, abs=0.03 + one.errors.force / (MU * PRELOAD))


def test_means_that_have_not_converged_say_so():
    few = steady_state(bouncing(contact=Contact(restitution=0.5)), 0.0, periods=96)
    assert not few.converged()
    with pytest.raises(InputError, match=r"has not converged, raise periods.*so far"):
        no_load(bouncing(contact=Contact(restitution=0.9)), periods=1440)
    repeats = steady_state(bouncing(0.4, contact=SPRING), 0.0)
    assert repeats.converged()
    assert repeats.means.normal_force == pytest.approx(PRELOAD, rel=3e-3)


def test_a_free_run_in_flight_at_its_end_has_come_to_no_speed():
    found = transient(bouncing(contact=Contact(restitution=0.5)), 40)
    assert float(found.run.normal_force[-found.last :].mean()) == 0.0
    assert not found.converged
    assert transient(bouncing(0.4, contact=SPRING), 60).converged


# --- a slider held at a speed so small that what gives way under it takes long to slip

STIFF, DASHPOT, GRIP, PLACE = 6.1e4, 8.0, 3.3e5, MIDDLE + 0.0061
CREEPING = case_of(
    Slider(
        mass=0.015,
        mu=0.23,
        law="coulomb",
        position=PLACE,
        coupling="one-way",
        gravity=0.0,
        preload=0.31,
        contact=Contact(stiffness=STIFF, damping=DASHPOT, tangential_stiffness=GRIP),
    ),
    drive(2.6e-7, backward=1.0)[0],
    steps_per_period=244,
)


def played(speed, steps=2000, turns=2):
    """Mean friction of a point that has slipped: its stretch follows the surface as far as friction lets it."""
    lift, _, rise, *_ = drive(2.6e-7, backward=1.0)[1].at(PLACE, 0.0)
    theta = 2.0 * np.pi * np.arange(turns * steps) / steps
    held = STIFF + 1j * OMEGA * DASHPOT
    pressed = held * (-0.015 * OMEGA**2) / (held - 0.015 * OMEGA**2) * lift
    most = 0.23 * (0.31 + (pressed * np.exp(1j * theta)).real) / GRIP
    assert most.min() > 0.0, "it leaves the surface"
    along = -HALF * rise * np.cos(theta) - speed * theta / OMEGA
    stretch, found = -most[0] * np.sign(speed), []
    for gone, limit in zip(np.diff(along).tolist(), most[1:].tolist(), strict=True):
        stretch = max(-limit, min(stretch + gone, limit))
        found.append(stretch)
    return GRIP * float(np.mean(found[-steps:]))


@pytest.mark.parametrize("speed", [1e-9, -1e-8, 2e-7])
def test_a_creeping_slider_has_the_force_of_one_that_slips(speed):
    """At 1e-9 m/s it takes 680 000 periods to slip: two windows of them differ by 1e-5 of mu N until then."""
    found = steady_state(CREEPING, speed)
    assert found.converged()
    assert found.means.force == pytest.approx(played(speed), rel=4e-3)


# --- refusals

BAR = Beam(length=0.31, width=0.013, thickness=0.0012, youngs_modulus=68e9, density=2650.0, loss_factor=0.01)
TWO = [PointForce(position=0.021, amplitude=0.4), PointForce(position=0.27, amplitude=0.3, phase_deg=70.0)]


def pressed(**given):
    own = {"mass": 0.003, "mu": 0.23, "law": "coulomb", "preload": 0.05, "coupling": "one-way"}
    return Slider(**{**own, "contact": Contact(stiffness=6e4), **given})


@pytest.mark.parametrize(
    ("slider", "given", "said"),
    [
        ({"foot": (Foot(length=0.5, points=3),)}, {}, "slider.foot.length = 0.5"),
        ({"foot": (Foot(length=0.1, points=3),), "position": 0.03}, {}, "slider.position = 0.03"),
        ({"preload": 0.0, "foot": (Foot(face="lower"),)}, {}, "slider.preload"),
        ({"contact": Contact(stiffness=6e7)}, {"step": 3e-5}, "step = 3e-05"),
        ({"contact": Contact(), "coupling": "two-way"}, {}, "slider.coupling = 'two-way'"),
        ({"contact": Contact(), "foot": (Foot(offset=0.003),)}, {}, "slider.foot.offset = 0.003"),
        ({"contact": Contact(), "preload_stiffness": 3.0}, {}, "slider.preload_stiffness = 3.0"),
        ({"foot": (Foot(mirrored=True),), "coupling": "two-way"}, {}, "slider.gravity = 9.81"),
        ({}, {"beam": replace(BAR, tension=-1e6)}, "beam.tension"),
    ],
)
def test_a_motor_that_cannot_run_is_refused_by_name(slider, given, said):
    asked = {"beam": BAR, "model": "fem", "count": 17, **given}
    with pytest.raises(InputError) as refused:
        simulate(excitation=Excitation(TWO, 3130.0), duration=6e-4, slider=pressed(**slider), **asked)
    assert said in str(refused.value)


@pytest.mark.parametrize(("field", "own"), [("coupling", {"coupling": "two-way"}), ("contact", {"contact": None})])
def test_sliders_on_one_beam_share_coupling_and_kind_of_contact(field, own):
    with pytest.raises(InputError, match=rf"slider\.{field}"):
        simulate(
            BAR, Excitation(TWO, 3130.0), 1e-4, slider=[pressed(position=0.1), pressed(position=0.2, **own)], count=9
        )
