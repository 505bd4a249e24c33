"""The slider on the beam: books, coupling, limits, orders, symmetry, against the coupled equations by other means."""

import numpy as np
import pytest
from motion_reference import FORCES, FREQUENCY, STRIP, coupled_motion
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.exact.modes import solve_harmonic
from verify.motion.pure_wave import terminal_speed
from verify.motion.simulate import simulate
from verify.motion.surface import basis_of
from verify.slider import Slider, changed

HEAVY = Slider(mass=0.4, mu=0.3, slope=300.0, position=0.19, coupling="two-way", normal="massless")
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
DURATION = 2.5e-3


def paper_forces(phase=90.0, amplitude=1.0):
    return (
        PointForce(position=0.0116, amplitude=amplitude),
        PointForce(position=0.5 - 0.0116, amplitude=amplitude, phase_deg=phase),
    )


def slid(slider=HEAVY, steps=240, model="segment", count=6, **asked):
    """`steps` of a period; samples at tenths of the run, so that steps divide it alike."""
    given = {"soft_start_periods": 2.0, "modal_damping": 0.003, "samples": 11, **asked}
    return simulate(
        STRIP,
        FORCES,
        FREQUENCY,
        DURATION,
        model=model,
        count=count,
        slider=slider,
        step=1 / (FREQUENCY * steps),
        **given,
    )


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_beam_and_slider_are_the_coupled_equations_by_dop853(model, coupling, kinematics):
    """To 1e-6 of the way and the speed, of order two in the step or better; the impulse is the integral of friction."""
    slider = replace(HEAVY, coupling=coupling, kinematics=kinematics)
    basis = basis_of(STRIP, model, 6, 0)
    way, speed, impulse = coupled_motion(basis, slider, DURATION, 0.003, 2.0 / FREQUENCY, coupling == "two-way")
    runs = [slid(slider, steps, model) for steps in (240, 480, 960)]
    errors = np.array([[abs(m.displacement / way - 1), abs(m.speed[-1] / speed - 1)] for m in runs])
    assert errors[-1].max() < 1e-6
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 1.6) or errors.max() < 3e-9
    if kinematics == "tangential":
        assert slider.mass * speed == pytest.approx(impulse, rel=1e-9)  # the reference keeps its own balance


@pytest.mark.parametrize("zeta", [0.0, 0.004])
@pytest.mark.parametrize("law", ["tanh", "coulomb"])
@pytest.mark.parametrize(("coupling", "order"), [("one-way", 3.5), ("two-way", 1.8)])
def test_the_energy_books_close_with_the_step(coupling, order, law, zeta):
    """Work in + work of the contact = stored + damped; the forces on slider and beam are equal and opposite.

    Two-way the beam's motion has a kink where friction turns over: order 2.
    """
    slider = changed(HEAVY, coupling=coupling, law=law, mu=0.05)
    runs = [slid(slider, steps, modal_damping=zeta) for steps in (120, 240, 480)]
    work = [abs(m.ledger.residual) / m.ledger.work_in for m in runs]
    assert work[-1] < 3e-6
    assert np.log2(work[0] / work[2]) / 2 > order or work[-1] < 1e-13
    for m in runs:
        books = m.ledger
        assert books.contact_on_beam + books.slider + books.rubbed == pytest.approx(0.0, abs=1e-12 * books.rubbed)
        assert books.slider == pytest.approx(0.5 * 0.4 * m.speed[-1] ** 2, rel=1e-9)
        assert books.rubbed > 0
        assert (books.damped > 0) == (zeta > 0)
        charged = books.contact_on_beam if coupling == "two-way" else 0.0
        assert books.residual == pytest.approx(
            books.work_in + charged - books.damped - books.kinetic - books.elastic, abs=1e-12 * books.work_in
        )


def test_what_the_beam_gives_the_slider_and_friction_take():
    """Undamped and two-way: all work that the forces do is stored, rubbed off or in the slider."""
    books = slid(modal_damping=0.0, steps=960).ledger
    assert books.work_in == pytest.approx(books.kinetic + books.elastic + books.slider + books.rubbed, rel=1e-6)
    assert books.rubbed + books.slider > 1e-3 * books.work_in


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_friction_alone_is_rubbed_off_from_a_slider_that_follows(coupling):
    """The least is lost where mu is least: what turning and gravity do to it stands by itself, and loses nothing."""
    given = {"mass": 0.02, "speed": 1.7, "kinematics": "following", "coupling": coupling, "preload": 3.0}
    runs = [slid(replace(HEAVY, **given, mu=mu), steps=960).ledger for mu in (1e-7, 3e-7)]
    way = 1.7 * DURATION
    for mu, books in zip((1e-7, 3e-7), runs, strict=True):
        force = mu * (3.0 + 0.02 * 9.81)
        assert books.rubbed == pytest.approx(force * way, rel=0.02)
        assert abs(books.turned) > 0.1 * books.rubbed


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_impulse_and_power_of_friction_are_its_own(law):
    """The slider's m dv the integral of F dt; F v_rel <= 0 at all times; |F| <= mu m g."""
    m = slid(changed(HEAVY, law=law, coupling="one-way", mu=0.05), steps=2000, samples=4001)
    limit = 0.05 * 0.4 * 9.81
    assert np.all(m.friction * (m.speed - m.surface_speed) <= 1e-15)
    assert abs(m.friction).max() <= limit * (1 + 1e-12)
    impulse = np.sum(0.5 * (m.friction[1:] + m.friction[:-1]) * np.diff(m.times))
    turns = np.count_nonzero(np.diff(np.sign(m.friction))) + len(m.events)  # where the trapezium rule misses a jump
    jumps = turns * limit * m.times[1] if law == "coulomb" else 0.0
    assert impulse == pytest.approx(0.4 * (m.speed[-1] - m.speed[0]), abs=jumps + 1e-3 * limit * 1e-5)


def test_two_way_tends_to_one_way_as_the_mass_goes_and_the_choice_goes_by_size():
    """The same mu and g: the beam feels mu m g, so the difference goes with the mass."""
    lost = []
    for mass in (0.04, 0.004, 0.0004):
        both = [slid(replace(HEAVY, mass=mass, coupling=c)).displacement for c in ("two-way", "one-way")]
        lost.append(both[0] / both[1] - 1)
    assert lost[0] / lost[1] == pytest.approx(10.0, rel=0.1)
    assert lost[1] / lost[2] == pytest.approx(10.0, rel=0.02)
    chosen = [slid(replace(HEAVY, mass=mass, coupling="auto")).coupling for mass in (0.4, 1e-6)]
    assert [c.two_way for c in chosen] == [True, False]
    assert chosen[0].relative_size == pytest.approx(4e5 * chosen[1].relative_size)
    assert not chosen[0].forced


def test_steep_tanh_tends_to_coulomb():
    """The distance to it falls with 1/K."""
    slider = replace(HEAVY, coupling="one-way")
    exact = slid(changed(slider, law="coulomb"), steps=3000).speed[-1]
    off = [abs(slid(replace(slider, slope=k), steps=3000).speed[-1] / exact - 1) for k in (1e5, 1e6, 1e7)]
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.3)
    assert off[1] / off[2] == pytest.approx(10.0, rel=0.3)
    assert off[2] < 3e-4


@pytest.mark.parametrize(
    ("model", "size"), [("fem", {"count": 23}), ("segment", {"count": 31}), ("analytic", {"count": None})]
)
def test_a_slider_at_rest_on_a_beam_that_feels_it_holds_on_to_static_friction(model, size):
    """However many modes a step leaves unresolved; what it gives in a step never exceeds it, and in slip is mu N."""
    slider = changed(HEAVY, law="coulomb", mu=0.3, mu_static=0.55, normal="massless", coupling="two-way")
    m = slid(slider, model=model, samples=6001, modal_damping=0.01, **size)
    full = slider.normal_force
    assert 0.53 * full < abs(m.friction).max() <= 0.55 * full * (1 + 1e-9)
    apart = abs(m.speed - m.surface_speed) > 1e-6
    assert apart.any()
    assert abs(m.friction[apart]) == pytest.approx(0.3 * full, rel=1e-12)


def test_a_sticking_slider_rides_on_the_surface_and_its_slips_are_located():
    """Its v is the surface's to the last digit; slip times converge with order 2 in the step."""
    slider = changed(HEAVY, law="coulomb", coupling="one-way", mu=0.05)
    m = slid(slider, steps=400, samples=2001)
    kinds, times = m.events[:, 1], m.events[:, 0]
    sticks, slips = 1.0, 2.0  # as `Motion.events` says
    assert kinds[0] == slips
    assert np.array_equal(np.sort(times), times)
    assert {sticks, slips} == set(kinds)
    riding = (m.times > 0) & (m.times < times[0] - 2 * m.statistics.step_s)
    assert riding.sum() > 20
    assert np.array_equal(m.speed[riding], m.surface_speed[riding])
    assert np.all(abs(m.friction[riding]) <= 0.05 * 0.4 * 9.81 * (1 + 1e-9))
    exact = slid(slider, steps=6400).events[:, 0]
    coarse, fine = (np.linalg.norm(slid(slider, steps=n).events[:, 0] - exact) for n in (50, 800))
    assert np.log2(coarse / fine) / 4 > 1.6
    assert fine < 2e-9


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
@pytest.mark.parametrize(("model", "count"), [("segment", 12), ("fem", 12), ("analytic", None)])
def test_exchanged_forces_mirror_the_slider(model, count, coupling):
    mirrored = tuple(replace(f, position=STRIP.length - f.position) for f in FORCES)
    slider = replace(HEAVY, coupling=coupling, kinematics="following", speed=0.003)
    other = replace(slider, position=STRIP.length - 0.19, speed=-0.003)
    asked = {"model": model, "count": count, "modes": None if count else 30, "soft_start_periods": 2.0, "samples": 51}
    one, two = (
        simulate(STRIP, forces, FREQUENCY, DURATION, slider=s, **asked)
        for forces, s in ((FORCES, slider), (mirrored, other))
    )
    assert one.travelled == pytest.approx(-two.travelled, abs=1e-10 * abs(one.travelled).max())
    assert one.friction == pytest.approx(-two.friction, abs=1e-7 * abs(one.friction).max())


def drift(phase, amplitude, x, periods=500):
    """Mean speed over the second half of a steady run, when what the start added once has gone."""
    m = simulate(
        PAPER,
        paper_forces(phase, amplitude),
        4276.0,
        periods / 4276.0,
        model="analytic",
        start="steady",
        slider=Slider(mass=1e-3, mu=0.2, slope=1e3, position=x, normal="massless"),
        samples=3,
    )
    return (m.travelled[2] - m.travelled[1]) / (m.times[2] - m.times[1])


@pytest.mark.parametrize("phase", [0.0, 180.0])
def test_a_standing_wave_carries_a_slider_nowhere_in_first_order(phase):
    """What remains is of second order in the amplitude or higher, and far below the surface's own speed."""
    speeds = np.array([drift(phase, amplitude, 0.2562) for amplitude in (0.05, 0.1)])
    assert speeds[1] / speeds[0] > 3.5
    surface = 0.5e-3 * 2 * np.pi * 4276 * 135.2 * 1.7e-7
    assert abs(speeds[1]) < 1e-3 * surface


def test_a_travelling_wave_carries_a_slider_against_itself_and_back_with_its_phase():
    """In the middle of the beam the wave of -90 degrees is the mirrored one of +90 degrees."""
    there, back = drift(90.0, 1.0, 0.25), drift(-90.0, 1.0, 0.25)
    assert there < 0
    assert back == pytest.approx(-there, rel=1e-3)


@pytest.mark.parametrize(("slope", "share"), [(3.0, 1.0), (1e7, 2.0)])
@pytest.mark.parametrize("kinematics", ["tangential", "following"])
def test_terminal_speeds_on_a_pure_wave_go_with_the_amplitude_squared(slope, share, kinematics):
    """-(k omega A^2/2)(1 + (k h/2)^2) for flat friction, twice that for steep; following keeps (k h/2)^2 of it."""
    slider = Slider(mass=1.0, mu=0.02, slope=slope, kinematics=kinematics)
    k, omega = 135.19808, 2 * np.pi * 4276
    found = np.array([terminal_speed(PAPER, slider, a, 4276.0) / a**2 for a in (0.8e-7, 1.6e-7, 3.2e-7)])
    lever = (k * 0.5e-3) ** 2
    expected = -0.5 * k * omega * (lever if kinematics == "following" else 1 + lever)
    if kinematics == "tangential" or share == 1.0:
        assert found == pytest.approx(share * expected, rel=0.02)
    assert np.ptp(found) < 0.05 * abs(found).max()


def test_displacements_converge_with_order_four_in_count():
    """Both discrete models against the exact beam, from rest under a soft start; one from below, one from above."""

    def way(model, count):
        slider = Slider(mass=1e-3, mu=0.2, slope=100.0, normal="massless")
        return simulate(
            PAPER,
            paper_forces(),
            4276.0,
            1e-3,
            model=model,
            count=count,
            soft_start_periods=2.0,
            slider=slider,
            ledger=False,
        ).displacement

    exact = way("analytic", None)
    for model, sign in (("segment", -1), ("fem", 1)):
        errors = np.array([way(model, n) for n in (98, 196, 392)]) / exact - 1
        assert np.all(sign * errors > 0)
        assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(4.0, abs=0.3)


def test_displacement_is_of_order_four_in_the_step_where_friction_is_smooth():
    slider = replace(HEAVY, coupling="one-way", slope=40.0)
    exact = slid(slider, steps=1920).displacement
    errors = [abs(slid(slider, steps=n).displacement / exact - 1) for n in (120, 240, 480)]
    assert np.log2(errors[0] / errors[2]) / 2 > 3.5


def test_a_follower_that_gathers_speed_within_a_step_meets_the_convective_terms_of_that_speed():
    """Under friction of 300 times its weight: order four, where the speed of the step's start leaves less than two."""
    slider = replace(HEAVY, coupling="one-way", kinematics="following", mu=300.0, slope=13.3, speed=0.3)
    forces = tuple(replace(f, amplitude=100.0 * f.amplitude) for f in FORCES)

    def way(steps):
        step = 1 / (FREQUENCY * steps)
        asked = {"soft_start_periods": 2.0, "samples": 2, "ledger": False}
        return simulate(
            STRIP, forces, FREQUENCY, DURATION, model="segment", count=6, slider=slider, step=step, **asked
        ).displacement

    exact = way(1920)
    errors = [abs(way(n) / exact - 1) for n in (120, 480)]
    assert np.log2(errors[0] / errors[1]) / 2 > 3.2
    assert errors[1] < 5e-12


@pytest.mark.parametrize("turned", [0.0, 180.0])
def test_a_slider_that_the_surface_leaves_at_once_slips_from_the_start_and_no_event_is_noted(turned):
    """At rest on a beam at rest under step loads, whichever way they throw its surface."""
    slider = changed(HEAVY, coupling="one-way", law="coulomb", mu=1e-3)
    forces = tuple(replace(f, phase_deg=f.phase_deg + turned) for f in FORCES)
    run = simulate(STRIP, forces, FREQUENCY, 1e-3, model="segment", count=6, slider=slider, samples=2)
    assert len(run.events) == 0
    assert np.sign(run.displacement) == (1.0 if turned else -1.0)


def test_the_raw_line_jumps_at_the_joints_and_costs_steps():
    """The paper's C2 spline has no jumps (Section II.B); on the links' own edges no step is small enough."""
    slider = Slider(mass=0.4, mu=0.3, slope=0.05, position=0.19, coupling="one-way", speed=6.0)

    def run(line, steps, **asked):
        return slid(replace(slider, line=line), steps, count=24, soft_start_periods=0.0, **asked)

    spline, raw = (run(line, 640, samples=8001).surface_speed for line in ("spline", "raw"))
    assert abs(np.diff(raw)).max() > 8 * abs(np.diff(spline)).max()

    def errors(line, *steps):
        exact = run(line, 10240).speed[-1]
        return [abs(run(line, n).speed[-1] - exact) for n in steps]

    assert max(errors("spline", 40, 80, 160)) < 1e-12
    assert min(errors("raw", 40, 320, 1280)) > 5e-12  # m/s: 32 times as many steps do not make up for it


def test_the_margins_have_the_documented_values():
    """omega^2 |w|/g under the slider; (kL)^2 <theta^2> = 1.2e-4; Timoshenko -0.33 %; 49 segments -0.27 % at mode 21."""
    slider = Slider(mass=1e-3, mu=0.2, normal="massless", position=0.271, coupling="one-way")
    asked = {"start": "steady", "slider": slider, "samples": 2}
    exact = simulate(PAPER, paper_forces(), 4276.0, 3e-4, model="analytic", **asked).margins
    amplitude = abs(solve_harmonic(PAPER, paper_forces(), 4276.0).deflection([0.271])[0])
    assert exact.lift_off == pytest.approx((2 * np.pi * 4276) ** 2 * amplitude / 9.81, rel=2e-3)
    assert exact.nonlinearity == pytest.approx(1.22e-4, rel=0.02)
    assert exact.discretisation is None
    assert exact.model_form == pytest.approx(-0.0033, abs=2e-4)
    chain = simulate(PAPER, paper_forces(), 4276.0, 1e-4, count=49, **asked).margins
    assert chain.nonlinearity == pytest.approx(1.3e-4, rel=0.05)
    assert chain.discretisation < 0
    pressed = replace(slider, preload=9 * 1e-3 * 9.81)
    tenth = simulate(PAPER, paper_forces(), 4276.0, 3e-4, model="analytic", **{**asked, "slider": pressed}).margins
    assert tenth.lift_off == pytest.approx(0.1 * exact.lift_off)
    alone = simulate(PAPER, paper_forces(), 4276.0, 3e-4, model="analytic", start="steady").margins
    assert alone.lift_off > 1.05 * exact.lift_off  # of a beam alone the largest along it


@pytest.mark.parametrize("model", ["segment", "fem", "analytic"])
def test_a_steady_beam_that_feels_its_slider_changes_little_under_a_light_one(model):
    """The steady field with modes to be pushed: the coupling's relative size is what the slider's way changes by."""
    count = None if model == "analytic" else 49
    ways = []
    for coupling in ("one-way", "two-way"):
        slider = Slider(mass=0.05, mu=0.2, slope=100.0, coupling=coupling, normal="massless")
        m = simulate(
            PAPER,
            paper_forces(),
            4276.0,
            2e-3,
            model=model,
            count=count,
            start="steady",
            slider=slider,
            modal_damping=1e-3,
            modes=None if count else 60,
        )
        ways.append(m.displacement)
    assert 1e-6 < abs(ways[1] / ways[0] - 1) < 5 * m.coupling.relative_size
