"""A slider on a beam against the coupled equations by DOP853, closed forms of moving loads, and its energy balance."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from verify import Excitation, Keep, PrescribedSlider, Step, simulate
from verify.cases.slider_on_wave import terminal_speed
from verify.dynamics.result import Motion
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.slider import Slider

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ, DURATION, PARTS, ZETA = 1310.0, 2.5e-3, 4, 0.003
FORCES = (
    PointForce(position=0.037, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.402, amplitude=0.8, phase_deg=101.0),
)
HEAVY = Slider(mass=0.04, mu=0.3, slope=300.0, position=0.19, coupling="two-way", preload=0.31)
FAST = {
    "one-way, following": ({"coupling": "one-way", "kinematics": "following", "speed": 1.3}, 3.23354611695e-3),
    "bilateral": ({"preload": 2.31}, -8.12078768e-8),
    "bilateral, fast": ({"speed": 3.0}, 7.483073968e-3),
    "bilateral, following, fast": ({"kinematics": "following", "speed": -2.1}, -5.23316806e-3),
}
"""Sliders that start with a speed, or under a preload, and their displacements, m, by `reference.contact.ran`."""


def run(slider, steps=240, grown=2.0, **more) -> Motion:
    model = {} if "model" in more else {"model": "fem", "count": PARTS}
    given = {"step": 1 / (HERTZ * steps), "modal_damping": ZETA, "keep": Keep(at=0.123, samples=11), **model, **more}
    return simulate(STRIP, Excitation(FORCES, HERTZ, grown), DURATION, slider=slider, **given)


@pytest.mark.parametrize("kind", FAST)
def test_fast_sliders_and_beams_move_as_one_system_of_equations_of_second_order_in_the_step(kind):
    (own, displacement), slider = FAST[kind], HEAVY
    slider = replace(slider, **own)
    errors = np.array([abs(run(slider, steps).displacement / displacement - 1) for steps in (240, 480, 960)])
    assert errors[-1] < 1e-5
    assert np.all((np.log2(errors[:-1] / errors[1:]) > 1.6) | (errors[1:] < 2e-8))


@pytest.mark.parametrize("law", ["tanh", "coulomb"])
def test_friction_opposes_slip_and_its_impulse_is_the_momentum(law):
    slider = Slider(
        mass=0.4, mu=0.05, law=law, position=0.19, coupling="one-way", slope=300.0 if law == "tanh" else None
    )
    motion, limit = run(slider, 2000, keep=Keep(samples=4001)), 0.05 * 0.4 * 9.81
    assert np.all(motion.friction * (motion.speed - motion.surface_speed) <= 1e-14)
    assert motion.largest_friction <= limit * (1 + 1e-12)
    assert motion.mean_friction * motion.duration == pytest.approx(0.4 * motion.speed[-1], rel=1e-9)
    assert motion.mean_surface_speed == pytest.approx(
        np.trapezoid(motion.surface_speed, motion.times) / motion.duration, rel=1e-3, abs=1e-6
    )


def test_a_continued_run_of_a_held_slider_equals_one_run():
    asked = {"model": "fem", "count": PARTS, "slider": HEAVY, "step": 1e-6, "modal_damping": ZETA}
    drive, keeps = Excitation(FORCES, HERTZ), [Keep(at=0.123, samples=n) for n in (11, 5, 7)]
    whole = simulate(STRIP, drive, 2e-3, keep=keeps[0], **asked)
    begun = simulate(STRIP, drive, 0.8e-3, keep=keeps[1], **asked)
    ended = simulate(STRIP, drive, 1.2e-3, start=begun, keep=keeps[2], **asked)
    assert ended.deflection[-1, 0] == pytest.approx(whole.deflection[-1, 0], rel=1e-7)
    assert ended.position[-1] == pytest.approx(whole.position[-1], rel=1e-9)


def test_the_beam_vibrates_on_after_a_moving_load_has_left():
    beam = Beam(length=0.83, width=0.024, thickness=0.0021, youngs_modulus=113e9, density=4430.0)
    speed = 0.5 * np.pi / 0.83 * beam.wave_constant
    load = Slider(mass=1e-9, preload=0.37, mu=0.0, position=0.0)
    leaves, asked = 0.83 / speed, {"model": "analytic", "modes": 20, "step": 2e-5}
    moving, keep = PrescribedSlider(load, speed), Keep(at=0.415, samples=1501)
    motion = simulate(beam, Excitation((), 40.0), 1.5 * leaves, slider=moving, keep=keep, **asked)
    assert motion.statistics.finished
    own = (np.pi / 0.83) ** 2 * beam.wave_constant
    k, t, w = np.pi / 0.83 * np.arange(1, 21), motion.times[motion.times > 1.001 * leaves], 0.0
    for j, one in enumerate(k, 1):  # Fryba's series to the end of the load, then free
        natural, driven_ = one**2 * beam.wave_constant, one * speed
        scale = -2 * 0.37 / (beam.mass_per_length * 0.83) * np.sin(one * 0.415)
        if j == 2:  # at resonance at half the critical speed, a node at mid-span
            continue
        q = (np.sin(driven_ * leaves) - driven_ / natural * np.sin(natural * leaves)) / (natural**2 - driven_**2)
        qd = driven_ * (np.cos(driven_ * leaves) - np.cos(natural * leaves)) / (natural**2 - driven_**2)
        since = t - leaves
        w = w + scale * (q * np.cos(natural * since) + qd / natural * np.sin(natural * since))
    assert own > 0.0
    assert motion.deflection[-len(t) :, 0] == pytest.approx(w, abs=1e-3 * abs(w).max())


@pytest.mark.parametrize("amplitude", [0.0, 2.3], ids=["without drive", "driven"])
def test_a_run_continues_at_its_end_though_a_moving_load_left_before(amplitude):
    beam, drive = replace(STRIP, loss_factor=0.013), Excitation(PointForce(position=0.037, amplitude=amplitude), 531.0)
    load = PrescribedSlider(Slider(mass=1e-3, mu=0.0, position=0.31), 23.0)
    asked = {"model": "fem", "count": PARTS, "keep": Keep(at=0.123, samples=2)}
    begun, whole = (simulate(beam, drive, t, slider=load, step=5e-6, **asked) for t in (0.0113, 0.0184))
    assert begun.statistics.finished
    assert begun.travelled[-1] > STRIP.length - 0.31
    ended = simulate(beam, drive, 0.0071, start=begun, **asked)
    assert begun.mean_surface_speed == pytest.approx(whole.mean_surface_speed, rel=1e-9)  # under the load
    assert ended.times[[0, -1]] == pytest.approx([0.0113, 0.0184], rel=1e-12)
    assert ended.deflection[0, 0] == pytest.approx(begun.deflection[-1, 0], rel=1e-9)
    assert ended.deflection[-1, 0] == pytest.approx(whole.deflection[-1, 0], rel=1e-7)


def test_a_moving_mass_bends_the_beam_by_all_convective_terms():
    """Reaction m (g + w_tt + 2 v w_xt + v^2 w_xx) on six sines by DOP853, 0.3 of the beam's mass."""
    line, still = 0.024 * 0.0021 * 4430, (PointForce(position=0.31, amplitude=0.0),)
    beam = Beam(length=0.83, width=0.024, thickness=0.0021, youngs_modulus=113e9, density=4430.0)
    v = 0.5 * np.pi / 0.83 * beam.wave_constant  # half the critical speed
    load = Slider(mass=0.3 * 0.83 * line, mu=1e-13, position=0.0, speed=v, coupling="two-way")
    asked = {"model": "analytic", "modes": 6, "step": 2e-5, "keep": Keep(at=0.415, samples=2)}
    motion = simulate(beam, Excitation(still, 40.0), 0.7 * 0.83 / v, slider=load, **asked)
    mass, k = motion.slider.mass, np.arange(1, 7) * np.pi / 0.83
    scale, own = np.sqrt(2 / (0.83 * line)), k**2 * beam.wave_constant

    def rates(t, y):
        q, qd, turn = y[:6], y[6:], k * v * t
        phi, slope, bend = scale * np.sin(turn), scale * k * np.cos(turn), -scale * k**2 * np.sin(turn)
        free = 9.81 + 2 * v * (slope @ qd) + v * v * (bend @ q) - phi @ (own**2 * q)
        return np.concatenate([qd, -(own**2) * q - phi * mass * free / (1 + mass * phi @ phi)])

    end = float(motion.times[-1])
    q = solve_ivp(rates, (0, end), np.zeros(12), method="DOP853", rtol=1e-11, atol=1e-16).y[:6, -1]
    assert motion.deflection[-1, 0] == pytest.approx(q @ (scale * np.sin(k * 0.415)), rel=2e-5)


@pytest.mark.parametrize("model", [{"model": "segment", "count": 98}, {"model": "analytic"}])
def test_a_mass_at_rest_is_part_of_the_steady_beam(model):
    """W = W_0 / (1 - m omega^2 G) on the sag of its weight."""
    slider = Slider(mass=1.3e-3, mu=1e-9, position=0.25, coupling="two-way")
    forces = (PointForce(position=0.0116, amplitude=1.0), PointForce(position=0.4884, amplitude=1.0, phase_deg=90.0))
    asked = {"start": "steady", "keep": Keep(at=0.31, samples=101), **model}
    motion = simulate(PAPER, Excitation(forces, 4276.0), 1e-3, slider=slider, step=1e-6, **asked)
    turn = 2 * np.pi * 4276.0 * motion.times
    rows = np.stack([np.cos(turn), -np.sin(turn), np.ones_like(turn)], axis=1)
    (real, imaginary, _), rest, *_ = np.linalg.lstsq(rows, motion.deflection[:, 0], rcond=None)
    assert np.sqrt(rest[0] / len(turn)) < 2e-4 * np.hypot(real, imaginary)
    alone = simulate(PAPER, Excitation(forces, 4276.0), 1e-3, **asked)
    assert np.hypot(real, imaginary) / abs(alone.deflection).max() == pytest.approx(1.0, abs=0.9)
    assert abs(np.hypot(real, imaginary) / abs(alone.deflection).max() - 1.0) > 0.02


def test_default_steps_resolve_a_step_load_and_report_their_convergence():
    forces = (PointForce(position=0.0116, amplitude=1.0), PointForce(position=0.4884, amplitude=1.0, phase_deg=90.0))
    slider = Slider(mass=1.02e-3, mu=0.2, slope=100.0, normal="massless", coupling="one-way")
    chosen, fine, coarse = (
        simulate(PAPER, Excitation(forces, 4276.0), 1e-3, count=392, slider=slider, keep=Keep(samples=2), step=step)
        for step in (None, 5e-8, 1 / (64 * 4276.0))
    )
    assert chosen.displacement == pytest.approx(fine.displacement, rel=2e-3)
    assert coarse.displacement == pytest.approx(fine.displacement, rel=0.01)
    assert any(note.startswith("step:") for note in coarse.notes)
    refined = run(replace(HEAVY, preload=2.31), step=None)
    assert refined.statistics.step_change < 0.01
    assert refined.displacement == pytest.approx(FAST["bilateral"][1], rel=0.01)
    assert len(refined.times) == 11


def test_the_slider_stops_at_the_end_of_its_section_and_of_the_beam():
    sections = (Section(length=0.22, thickness=0.001), Section(length=0.18, thickness=0.0016))
    stepped = Beam(length=0.4, width=0.02, thickness=0.001, youngs_modulus=7e10, density=2700.0, section=sections)
    slider = Slider(mass=0.01, mu=1e-6, speed=9.0, position=0.19, coupling="one-way")
    drive = Excitation(FORCES[0], 400.0)
    at_step = simulate(stepped, drive, 0.02, count=40, slider=slider)
    off = simulate(STRIP, drive, 0.1, count=12, slider=slider)
    assert at_step.statistics.stopped.startswith("came to a step of beam.section at 0.22")
    assert off.statistics.stopped == "left the beam"
    assert at_step.end.time == pytest.approx(0.03 / 9.0, rel=0.02)
    with pytest.raises(InputError, match="start: its slider left the beam"):
        simulate(STRIP, drive, 0.1, count=12, slider=slider, start=off)


@pytest.mark.parametrize("kinematics", ["tangential", "following"])
@pytest.mark.parametrize(("slope", "amplitude"), [(1e4, 1e-6), (100.0, 3e-7)])
def test_terminal_speed_on_a_pure_wave_equals_its_ode(kinematics, slope, amplitude):
    """One point on w = a cos(omega t - k x), integrated over periods until its speed repeats."""
    slider = Slider(mass=1.0, mu=0.2, slope=slope, kinematics=kinematics)
    omega, half = 2 * np.pi * 4276.0, 0.5 * PAPER.thickness
    k, follows = np.sqrt(omega / PAPER.wave_constant), kinematics == "following"

    def rates(t, y):
        x, v = y

        def wave(x):
            turn = omega * t - k * x
            return (amplitude * k * np.sin(turn), -amplitude * k**2 * np.cos(turn), -amplitude * omega * np.sin(turn),
                    amplitude * omega * k * np.cos(turn))  # fmt: skip

        slope_w, bend, rise, twist = wave(x + half * wave(x)[0])
        surface = (rise * slope_w - half * twist) / np.hypot(1.0, slope_w)
        friction = -0.2 * 9.81 * np.tanh(slope * (v - surface))
        if not follows:
            return [v, friction]
        return [v - slope_w * rise, rise * (twist + bend * v) - 9.81 * slope_w + friction]

    found = terminal_speed(slider, amplitude)
    period = 2 * np.pi / (omega - k * found)

    def after(v):
        ended = solve_ivp(
            rates, (0.0, period), [0.25, v], method="DOP853", rtol=1e-11, atol=1e-17, max_step=period / 60
        )
        return ended.y[:, -1] - [0.25, v]

    crest = 2 * half * k * omega * amplitude
    start = brentq(lambda v: after(v)[1], -crest, crest, xtol=1e-14, rtol=1e-12)
    assert after(start)[0] / period == pytest.approx(found, rel=1e-4)
    assert found < 0.0  # against the wave


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({"step": 1e-3}, "step"),
        ({"step": 1e-13}, "step"),
        ({"step": Step(per_period=3)}, "step.per_period"),
        ({"slider": 3.0}, "slider"),
        ({"slider": replace(HEAVY, position=0.5)}, "position"),
        ({"slider": replace(HEAVY, line="raw"), "start": "steady", "grown": 0.0}, "line"),
    ],
)
def test_bad_sliders_and_steps_are_refused_by_name(more, field):
    with pytest.raises(InputError, match=field):
        run(**{"slider": HEAVY, **more})
