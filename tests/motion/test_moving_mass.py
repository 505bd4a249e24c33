"""A slider held on the surface is a moving mass: against closed forms, the coupled equations, and its own books."""

import numpy as np
import pytest
from motion_reference import FORCES, FREQUENCY, STRIP, held_motion
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.motion import judged_step, stepping
from verify.motion.records import SLIPS, STICKS
from verify.motion.simulate import simulate
from verify.motion.surface import basis_of
from verify.run.runner import workbench_for
from verify.scenes.scene import load_scene
from verify.slider import Slider, changed

HELD = Slider(mass=0.04, mu=0.3, slope=300.0, position=0.19, coupling="two-way")
DURATION = 2.5e-3
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)


def paper_forces(amplitude=1.0):
    return (
        PointForce(position=0.0116, amplitude=amplitude),
        PointForce(position=0.5 - 0.0116, amplitude=amplitude, phase_deg=90.0),
    )


def slid(slider=HELD, steps=240, model="segment", count=6, **asked):
    given = {"soft_start_periods": 2.0, "modal_damping": 0.003, "samples": 11, "at": [0.123], **asked}
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


@pytest.mark.parametrize(
    ("model", "count", "kinematics", "speed"),
    [("segment", 6, "tangential", 0.0), ("segment", 6, "following", 3.0), ("fem", 4, "tangential", 3.0)],
)
def test_beam_and_held_mass_are_the_coupled_equations_by_dop853(model, count, kinematics, speed):
    """As heavy as the beam, at rest or at 3 m/s, where it meets all convective terms: of order two in the step."""
    slider = replace(HELD, kinematics=kinematics, speed=speed)
    basis = basis_of(STRIP, model, count, 0)
    q, way, along = held_motion(basis, slider, DURATION, 0.003, 2.0 / FREQUENCY)
    deflection = q @ basis.shapes(np.array([0.123]), 0)[:, 0]
    errors = []
    for steps in (240, 480, 960):
        m = slid(slider, steps, model, count)
        errors.append([m.deflection[-1, 0] / deflection - 1, m.displacement / way - 1, m.speed[-1] / along - 1])
    errors = abs(np.array(errors))
    assert errors[-1].max() < 1e-5
    assert errors[-1, 0] < 2e-9  # of a deflection that is mostly sag
    falls = np.log2(errors[:-1] / errors[1:])
    assert np.all((falls > 1.6) | (errors[1:] < 2e-9))


@pytest.mark.parametrize(("model", "count"), [("segment", 98), ("fem", 98), ("analytic", None)])
def test_a_mass_at_rest_stays_in_the_steady_state_of_the_beam_that_carries_it(model, count):
    """W = W_0 / (1 - m omega^2 G) on the sag of its weight, in every model by its own field."""
    place, x, omega = 0.25, 0.31, 2 * np.pi * 4276
    slider = Slider(mass=1.3e-3, mu=1e-9, position=place, coupling="two-way")
    m = simulate(
        PAPER,
        paper_forces(),
        4276.0,
        0.9e-3,
        model=model,
        count=count,
        start="steady",
        slider=slider,
        at=[x],
        samples=51,
        steps_per_period=400,
    )
    drive = MODELS[model].solve_harmonic(PAPER, paper_forces(), 4276.0, count)
    unit = MODELS[model].solve_harmonic(PAPER, (PointForce(position=place),), 4276.0, count)
    inertia = 1.3e-3 * omega**2
    under = drive.deflection([place])[0] / (1 - inertia * unit.deflection([place])[0])
    steady = drive.deflection([x])[0] + inertia * under * unit.deflection([x])[0]
    sag = -1.3e-3 * 9.81 * place * (0.5 - x) * (0.25 - place**2 - (0.5 - x) ** 2) / (6 * PAPER.bending_stiffness * 0.5)
    found = m.deflection[:, 0] - (steady * np.exp(1j * omega * m.times)).real
    # chains: their sag and their driving point are read by a spline; the exact beam's modes are cut off at 400; what is
    # quadratic in the motion has a mean of 1.0e-11 m
    assert np.ptp(found) < {"segment": 2e-3, "fem": 2e-4, "analytic": 1e-4}[model] * abs(steady)
    assert found.mean() == pytest.approx(sag, abs={"segment": 3e-9, "fem": 1.1e-11, "analytic": 1e-10}[model])
    reaction = m.normal_force[1:] - 1.3e-3 * 9.81
    assert abs(reaction).max() == pytest.approx(inertia * abs(under), rel=0.02)


def test_the_reaction_of_the_papers_slider_is_larger_than_its_drive():
    """1.02 g held at mid-span needs m omega^2 |w| = 1.24 N against forces of 1 N, its own weight is 0.01 N."""
    slider = Slider(mass=2e-3 / 0.2 / 9.81, mu=0.2, slope=1e4, coupling="one-way")
    m = simulate(PAPER, paper_forces(), 4276.0, 1e-3, model="analytic", start="steady", slider=slider, samples=2001)
    assert m.normal_force.max() == pytest.approx(1.2425, rel=0.01)
    assert m.normal_force.min() < -1.2  # it would have lifted off
    assert not m.coupling.pushes_back
    assert m.coupling.normal_size == pytest.approx(1.24204, rel=1e-4)
    chosen = simulate(PAPER, paper_forces(), 4276.0, 1e-4, model="analytic", slider=replace(slider, coupling="auto"))
    assert chosen.coupling.pushes_back
    massless = replace(slider, coupling="auto", normal="massless")
    left_out = simulate(PAPER, paper_forces(), 4276.0, 1e-4, model="analytic", slider=massless)
    assert not left_out.coupling.two_way
    assert any("simplification" in note for note in left_out.notes)
    assert left_out.normal_force[1:] == pytest.approx(2e-3 / 0.2)


def moving(mass, preload, duration, **asked):
    beam = Beam(length=0.83, width=0.024, thickness=0.0021, youngs_modulus=113e9, density=4430.0)
    critical = np.pi / 0.83 * beam.wave_constant
    slider = Slider(mass=mass, preload=preload, mu=1e-13, position=0.0, speed=0.5 * critical, coupling="two-way")
    at_rest = (PointForce(position=0.31, amplitude=0.0),)
    return beam, critical, simulate(beam, at_rest, 40.0, duration * 0.83 / (0.5 * critical), slider=slider, **asked)


def test_a_force_at_half_the_critical_speed_bends_mid_span_most_at_two_thirds_of_the_way():
    """Fryba: 1.705445 of the static deflection."""
    beam, _, m = moving(1e-9, 0.37, 0.95, model="analytic", modes=60, at=[0.415], samples=1901, step=2e-5)
    deepest = int(m.deflection[:, 0].argmin())
    assert m.deflection[deepest, 0] == pytest.approx(
        -1.7054451 * 0.37 * 0.83**3 / (48 * beam.bending_stiffness), rel=6e-6
    )
    assert m.position[deepest] / 0.83 == pytest.approx(2 / 3, abs=1e-3)


def test_a_moving_mass_bends_the_beam_as_its_equations_say():
    """The reaction m (g + w_tt + 2 v w_xt + v^2 w_xx) on six modes by DOP853, half the critical speed, 0.3 of the beam."""
    from scipy.integrate import solve_ivp

    beam, critical, m = moving(
        0.3 * 0.83 * 0.024 * 0.0021 * 4430, 0.0, 0.7, model="analytic", modes=6, at=[0.415], samples=2, step=2e-5
    )
    mass, v, n = m.slider.mass, 0.5 * critical, np.arange(1, 7)
    k = n * np.pi / 0.83
    scale = np.sqrt(2 / (0.83 * 0.024 * 0.0021 * 4430))
    omegas = k**2 * beam.wave_constant

    def rates(t, y):
        q, qd = y[:6], y[6:]
        phi, slope, bend = scale * np.sin(k * v * t), scale * k * np.cos(k * v * t), -scale * k**2 * np.sin(k * v * t)
        given = 9.81 + 2 * v * (slope @ qd) + v * v * (bend @ q) - (phi @ (omegas**2 * q))
        reaction = mass * given / (1 + mass * phi @ phi)
        return np.concatenate([qd, -(omegas**2) * q - phi * reaction])

    end = float(m.times[-1])
    q = solve_ivp(rates, (0, end), np.zeros(12), method="DOP853", rtol=1e-11, atol=1e-16).y[:6, -1]
    assert m.deflection[-1, 0] == pytest.approx(float(q @ (scale * np.sin(k * 0.415))), rel=2e-5)


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_the_books_of_a_held_slider_close_with_the_step(law):
    """Work in + work of friction and of the reaction = stored + damped: order 2."""
    runs = [slid(changed(HELD, law=law, mu=0.05), steps) for steps in (120, 240, 480)]
    parts = [abs(m.ledger.residual) / m.ledger.work_in for m in runs]
    assert parts[-1] < 1e-6
    assert np.log2(parts[0] / parts[2]) / 2 > 1.6
    assert abs(runs[-1].ledger.normal_on_beam) > 1e-2 * runs[-1].ledger.work_in
    for m in runs:
        assert m.ledger.contact_on_beam + m.ledger.slider + m.ledger.rubbed == pytest.approx(
            0.0, abs=1e-12 * m.ledger.rubbed
        )


def test_no_step_makes_a_held_slider_unstable():
    """Heavy, on a fine chain, at steps that no mode of its upper half resolves: the energy stays the work."""
    for mass in (1e-4, 1e-2, 1.0):
        slider = Slider(mass=mass, mu=1e-9, position=0.2137, coupling="two-way")
        m = simulate(
            PAPER,
            paper_forces(),
            4276.0,
            20e-3,
            count=196,
            slider=slider,
            soft_start_periods=3.0,
            step=1 / (16 * 4276.0),
            samples=2,
        )
        assert abs(m.ledger.residual) < 0.05 * (m.ledger.kinetic + m.ledger.elastic)


def test_the_lighter_the_slider_the_less_it_matters_whether_it_is_held():
    lost = []
    for mass in (4e-4, 4e-5, 4e-6):
        both = [
            slid(replace(HELD, mass=mass, normal=n, gravity=0.0, preload=mass * 9.81), 480)
            for n in ("held", "massless")
        ]
        lost.append(both[0].displacement / both[1].displacement - 1)
    assert lost[0] / lost[1] == pytest.approx(10.0, rel=0.1)
    assert lost[1] / lost[2] == pytest.approx(10.0, rel=0.05)


@pytest.mark.parametrize("preload", [0.0, 3.7e-5])
def test_the_surface_falls_away_under_a_held_slider_as_under_a_massless_one(preload):
    """Of its own reaction, the largest fall over what presses it on: ten milligrams change no beam."""
    light = replace(HELD, mass=1e-5, preload=preload)
    held, felt = (slid(one).margins.lift_off for one in (light, replace(light, normal="massless", coupling="one-way")))
    assert held == pytest.approx(felt, rel=5e-3)
    assert felt == pytest.approx(1.827 / (1 + preload / (1e-5 * 9.81)), rel=1e-3)


def test_a_run_of_a_held_slider_continues_where_it_stopped():
    asked = {
        "samples": 11,
        "ledger": False,
        "modal_damping": 0.003,
        "at": [0.123],
        "count": 6,
        "slider": HELD,
        "step": 1e-6,
    }
    whole = simulate(STRIP, FORCES, FREQUENCY, 2e-3, **asked)
    begun = simulate(STRIP, FORCES, FREQUENCY, 0.8e-3, **asked)
    ended = simulate(STRIP, FORCES, FREQUENCY, 1.2e-3, continue_from=begun, **asked)
    assert begun.end.height is not None
    assert ended.deflection[-1, 0] == pytest.approx(whole.deflection[-1, 0], rel=1e-7)
    assert ended.speed[-1] == pytest.approx(whole.speed[-1], rel=1e-4)


def test_a_mass_in_resonance_with_an_undamped_drive_is_refused():
    """1 - m omega^2 G = 0: there is no steady state to start in."""
    basis, omega = basis_of(PAPER, "fem", 49, 0), 2 * np.pi * 4450
    places = np.linspace(0.24, 0.26, 21)
    felt = basis.shapes(places, 0).T ** 2 @ (1 / (basis.omegas**2 - omega**2))
    place, most = places[felt.argmax()], felt.max()
    unit = MODELS["fem"].solve_harmonic(PAPER, (PointForce(position=place),), 4450.0, 49)
    assert unit.deflection([place])[0].real == pytest.approx(most, rel=1e-6)
    slider = Slider(mass=1 / (omega**2 * most), mu=0.1, position=place, coupling="two-way")
    with pytest.raises(InputError, match="resonance"):
        simulate(PAPER, paper_forces(), 4450.0, 1e-4, model="fem", count=49, start="steady", slider=slider)


def test_a_stick_and_a_slip_that_share_a_step_are_both_kept():
    """Coarse steps see the same events as fine ones."""
    slider = Slider(mass=0.4, mu=0.05, position=0.19, coupling="one-way", law="coulomb", normal="massless")
    coarse, fine = (slid(slider, steps, modal_damping=0.003) for steps in (12, 800))
    assert len(coarse.events) == len(fine.events) > 4
    assert list(coarse.events[:, 1]) == list(fine.events[:, 1])
    assert {STICKS, SLIPS} == set(fine.events[:, 1])
    assert coarse.events[:, 0] == pytest.approx(fine.events[:, 0], abs=1 / (12 * FREQUENCY))


def test_a_run_says_how_many_sticks_and_slips_it_had_no_room_for(monkeypatch):
    slider = Slider(mass=0.4, mu=0.05, position=0.19, coupling="one-way", law="coulomb", normal="massless")
    every = slid(slider, 12, modal_damping=0.003)
    monkeypatch.setattr(stepping, "EVENTS", 3)
    few = slid(slider, 12, modal_damping=0.003)
    assert few.notes == (*every.notes, f"events: the first 3 of {len(every.events)}")
    assert few.events == pytest.approx(every.events[:3], rel=1e-15)
    assert few.displacement == every.displacement


def test_steps_follow_what_a_step_load_excites():
    """K = 100 s/m: the displacement converges with N, and no caller has to know how short a step that takes."""

    def way(count, **asked):
        slider = Slider(mass=2e-3 / 0.2 / 9.81, mu=0.2, slope=100.0, normal="massless")
        return simulate(
            PAPER, paper_forces(), 4276.0, 1e-3, count=count, slider=slider, samples=2, ledger=False, **asked
        )

    runs = {count: way(count) for count in (196, 392, 784)}
    assert runs[784].displacement == pytest.approx(-5.19e-10, rel=1e-3)
    assert abs(runs[392].displacement / runs[784].displacement - 1) < 1e-3
    assert abs(runs[196].displacement / runs[784].displacement - 1) < 1e-2
    for count, run in runs.items():
        assert run.displacement == pytest.approx(way(count, step=5e-8).displacement, rel=1e-3)
        assert not any(note.startswith("step") for note in run.notes)
    long = way(392, step=1 / (64 * 4276.0))
    assert abs(long.displacement / runs[392].displacement - 1) > 0.2
    told = next(note for note in long.notes if note.startswith("step"))
    assert "times too long" in told
    assert "give at most" in told
    assert way(392, soft_start_periods=2.0).statistics.step_s == pytest.approx(1 / (64 * 4276.0), rel=0.01)


def test_a_beam_that_a_weight_bends_is_not_shaken_by_it():
    """The sag stands still: a heavy slider on an undriven beam starts with no finer steps than a light one.

    How many times they are halved until its way stands is the slider's own.
    """
    at_rest = (PointForce(position=0.1, amplitude=0.0),)
    steps = [
        simulate(
            PAPER, at_rest, 300.0, 0.01, count=98, slider=Slider(mass=mass, mu=0.2, slope=1.0, coupling="two-way")
        ).statistics
        for mass in (1e-9, 0.7)
    ]
    assert steps[0].steps == pytest.approx(0.01 * 300 * 128, rel=0.6)
    halvings = np.log2(steps[1].steps / steps[0].steps)
    assert halvings in range(-judged_step.HALVINGS, judged_step.HALVINGS + 1)


def test_the_choice_of_coupling_is_told_with_both_sizes():
    scene = load_scene("paper-slider")
    from verify.run.plan import plan_scene

    chosen = {entry.what: entry.why for entry in plan_scene(scene).chosen}
    assert "1.4e-04" in chosen["one-way coupling"]
    assert "1.2 of its motion" in chosen["slider that the beam does not carry"]
    held = replace(scene, slider=replace(scene.slider, normal="held"), readings=None)
    chosen = {entry.what: entry.why for entry in plan_scene(held).chosen}
    assert "1.2e+00" in chosen["two-way coupling"]
    assert "slider that the beam does not carry" not in chosen
    unmoved = replace(scene, drive=replace(scene.drive, force=(replace(scene.drive.force[0], amplitude=0.0),)))
    assert "inf" not in str(plan_scene(unmoved).chosen)
    assert workbench_for(scene) is not None


def test_the_report_names_the_simplification_and_the_size_of_what_it_leaves_out():
    from verify.report.html import page
    from verify.run.runner import run_scene

    scene = load_scene("paper-slider", ("motion.counts=[9,18,27]", "motion.count=9", "motion.duration=5e-4"))
    told = page(run_scene(replace(scene, gate=(), readings=None, claim=())), "verify run")
    assert "massless slider" in told
    assert "a simplification: held on the surface, its inertia would move the beam under it by 1.2" in told
