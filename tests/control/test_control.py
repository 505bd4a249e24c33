"""Controllers and their plants against linear closed forms, python-control and the beam in time."""

from math import cos, exp, log, pi, sqrt

import numpy as np
import pytest
from msgspec.structs import replace

from verify import Beam, ExactModel, InputError, PointForce, Slider
from verify.analysis.solution_cache import SolutionCache
from verify.control.controller import Controller, ExtremumSeeker, magnitude_optimum, phase_locked_loop
from verify.control.loop import closed_loop, wave_drive
from verify.control.plants import AveragedMotor, Resonance, beam_tick
from verify.quantities.control import ControlOptions
from verify.scene.model import Drive, Scene, SceneForce
from verify.studies.control import Control
from verify.travelling_wave import best_drive, fit_waves
from verify.waves.driven_case import DrivenCase, unit_waves

BEAM = Beam(length=0.12, width=0.011, thickness=0.0013, youngs_modulus=71e9, density=2750.0)
SLOW, FAST, GAIN, MASS = 0.051, 0.0037, -0.83, 0.013


RATE = MASS / SLOW
LINEAR = AveragedMotor(
    mass=MASS, force=lambda v, y: RATE * (GAIN * y - v), time_constant=FAST
)  # K/((1 + slow s)(1 + fast s))


def test_the_magnitude_optimum_overshoots_by_its_closed_form():
    gain, integral = magnitude_optimum(GAIN, SLOW, FAST)
    for factor in (1.0, 2.7):  # of the gain: damping ratio 1/sqrt(2), 1/sqrt(5.4)
        zeta = sqrt(SLOW / (factor * gain * GAIN * FAST)) / 2.0
        closed = exp(-pi * zeta / sqrt(1.0 - zeta**2))
        own = {"gain": factor * gain, "integral_gain": factor * integral}
        coarse, fine = (closed_loop(Controller(sample_time=FAST / n, **own), LINEAR, 0.4, 8 * FAST) for n in (60, 120))
        assert 2.0 * fine.overshoot - coarse.overshoot == pytest.approx(closed, rel=2e-3)  # order 1 in the sample time


@pytest.mark.parametrize(("delay", "position_gain"), [(0, 0.0), (2, 0.0), (1, 37.0)])
def test_the_sampled_loop_equals_python_control(delay, position_gain):
    control = pytest.importorskip("control")
    h, target, kp, ki = 0.0011, 0.0173, -3.7, -61.0
    one = Controller(gain=kp, integral_gain=ki, sample_time=h, delay=delay, position_gain=position_gain)
    response = closed_loop(one, LINEAR, target, 160 * h)
    a = [[0.0, 1.0, 0.0], [0.0, -1.0 / SLOW, GAIN / SLOW], [0.0, 0.0, -1.0 / FAST]]
    plant = control.ss(a, [[0.0], [0.0], [1.0 / FAST]], np.eye(3)[:2], 0.0).sample(h, "zoh")
    law = control.tf([kp, ki * h - kp], [1.0, -1.0], h) * control.tf([1.0], [1.0] + delay * [0.0], h)
    forward = plant * control.ss(law)
    back = forward.B @ [[position_gain, 1.0]] @ forward.C  # e = k (x* - x) - v, or v* - v
    closed = control.ss(forward.A - back, forward.B, forward.C, 0.0, h)
    _, out = control.step_response(closed * (position_gain or 1.0), response.times)
    assert response.controlled == pytest.approx(target * out[0 if position_gain else 1].ravel(), abs=1e-10 * target)


def test_back_calculation_ends_windup_at_the_limit():
    """While the command is at its limit the integral stays at the limit, so that it leaves when the error changes sign."""
    one = Controller(gain=2.3, integral_gain=71.0, sample_time=1.7e-3, lower=-0.2, upper=0.7)
    state = one.start(0.0)
    for _ in range(400):
        state, command = one.step(state, 5.1, 1.4)
    assert command == 0.7
    assert state[0] == pytest.approx(0.7, rel=1e-9)
    _, command = one.step(state, 5.1, 5.2)
    assert command == pytest.approx(0.7 - 2.3 * 0.1, rel=1e-9)
    waves = Controller(gain=0.0, integral_gain=100.0, sample_time=1e-3, upper=0.3)
    assert waves.step(waves.start(np.array([3.0 + 4.0j, 0.1j])), 0.0, 0.0)[1] == pytest.approx(
        [0.18 + 0.24j, 0.1j], rel=1e-12
    )


OMEGA, TAU = 2.0 * pi * 4276.0, 0.0043


def tracked(detuned, ratio, from_steady, h=TAU / 400):
    """Detuning over its first value under a phase-locked loop, from the steady state or after a step of the resonance."""
    plant, loop = Resonance(omega=OMEGA, time_constant=TAU), phase_locked_loop(TAU, 4300.0, h, ratio)
    omega = OMEGA + detuned
    envelope, state, found = plant.start(omega if from_steady else OMEGA), loop.start(omega), []
    for _ in range(int(24 * TAU / h)):
        state, omega = loop.step(state, -0.5 * pi, float(np.angle(envelope)))
        envelope = plant.advance(envelope, omega, h)
        found.append((omega - OMEGA) / detuned)
    return np.array(found)


def test_a_phase_locked_loop_overshoots_by_its_closed_forms():
    small = 1e-3 / TAU
    assert -min(tracked(small, 1.0, steady).min() for steady in (True, False)) < 1e-4  # K_i = 1/(4 tau^2): critical
    ratio = sqrt(0.5)  # K_i = 1/(2 tau^2); from the steady state e^{-x} cos x, x = t/(2 tau)
    found = tracked(small, ratio, True)
    assert -found.min() == pytest.approx(exp(-0.75 * pi) / sqrt(2.0), rel=0.01)  # 6.702 %
    assert -tracked(small, ratio, False).min() == pytest.approx(exp(-pi), rel=0.01)
    assert found[699] == pytest.approx(exp(-0.875) * cos(0.875), abs=2e-3)
    assert abs(tracked(0.7 / TAU, ratio, True)[-1]) < 1e-4  # far from linear: atan(0.7)


def test_the_loop_on_the_beam_is_that_on_one_resonance():
    hertz, zeta = ExactModel(BEAM).frequency_hz(1), 0.004
    tau, h, first = 1.0 / (zeta * 2.0 * pi * hertz), 2.0 / hertz, 2.0 * pi * hertz * 0.997
    loop, one = phase_locked_loop(tau, hertz, h), Resonance(omega=2.0 * pi * hertz, time_constant=tau)
    beam = {"beam": BEAM, "model": "fem", "count": 6, "modal_damping": zeta, "at": [0.051]}
    force, turn = (PointForce(position=0.043, amplitude=0.7, phase_deg=31.0),), np.exp(-1j * np.deg2rad(31.0))
    tick, envelope = beam_tick(force, first, 12 * tau, **beam), one.start(first)
    states, commands = [loop.start(first)] * 2, []
    for _ in range(160):
        phases = float(np.angle(turn * tick.phasors[0])), float(np.angle(envelope))
        steps = [loop.step(state, -0.5 * pi, phase) for state, phase in zip(states, phases, strict=True)]
        states, omegas = [state for state, _ in steps], [omega for _, omega in steps]
        tick, envelope = beam_tick(force, omegas[0], h, tick, **beam), one.advance(envelope, omegas[1], h)
        commands.append(omegas)
    offsets = np.array(commands) / (2.0 * pi * hertz) - 1.0
    assert offsets[-1] == pytest.approx([0.0, 0.0], abs=1.2e-4)  # e^{-4} of the first
    assert offsets[:, 0] == pytest.approx(offsets[:, 1], abs=0.02 * 0.003)
    assert 0.04 < offsets.max(axis=0)[0] / 0.003 < 0.09


def test_extremum_seeking_converges_at_the_rate_of_the_averaged_loop():
    seeker = ExtremumSeeker(dither=0.13, omega=2.0 * pi * 5.0, gain=0.7, washout=2.0, sample_time=1e-3)
    command, state, found = 2.0, (2.0, 4.2 - 0.85 * 0.49, 0), []
    for _ in range(4000):
        state, command = seeker.step(state, 4.2 - 0.85 * (command - 1.3) ** 2)
        found.append(state[0] - 1.3)
    means = [np.mean(found[k : k + 200]) for k in (800, 2400)]
    assert log(means[0] / means[1]) / 1.6 == pytest.approx(0.7 * 1.7, rel=0.02)
    plant, command = Resonance(omega=OMEGA, time_constant=TAU), OMEGA - 0.9 / TAU
    seeker = ExtremumSeeker(dither=60.0, omega=90.0, gain=2e5, washout=25.0, sample_time=7e-4)
    envelope = plant.start(command)
    state = command, abs(envelope), 0
    for _ in range(6000):
        state, command = seeker.step(state, abs(envelope))
        envelope = plant.advance(envelope, command, 7e-4)
    assert state[0] == pytest.approx(OMEGA, abs=0.02 / TAU)


HERTZ, WINDOW = 6300.0, (0.03, 0.09)
UNITS = (PointForce(position=0.009), PointForce(position=0.107))


def test_two_actuators_make_a_wanted_pair_of_waves():
    case = DrivenCase(model=ExactModel(BEAM), forces=UNITS, frequency_hz=HERTZ)
    unit = unit_waves(case, np.array([HERTZ, 6150.0]), WINDOW)
    wanted = 1.3e-7 * np.exp(0.4j), 0.2e-7 * np.exp(-1.9j)
    drives = wave_drive(unit, *wanted)
    for wave, own in zip(unit.superposed(drives[:, :, None]), wanted, strict=True):
        assert wave[:, 0] == pytest.approx(own, rel=1e-9)
    first, second = wave_drive(unit, 1e-7, 0.0)[0]
    pure = best_drive(case, WINDOW)
    assert second / first == pytest.approx(pure.ratio * np.exp(1j * np.deg2rad(pure.phase_deg)), rel=1e-9)


def test_two_phase_control_of_the_beam_in_time():
    """The exact undamped beam decouples the waves; the plant, coarse and damped, is 6 % off without integral action."""
    unit = unit_waves(DrivenCase(model=ExactModel(BEAM), forces=UNITS, frequency_hz=HERTZ), np.array([HERTZ]), WINDOW)
    target, at, k = np.array([1.3e-7 * np.exp(0.4j), 0.2e-7j]), np.linspace(*WINDOW, 9), complex(unit.k[0].real)
    law = Controller(gain=0.0, integral_gain=110.0, sample_time=12 / HERTZ, upper=2e-7)
    state, command, tick, errors = law.start(target), target, None, []
    for _ in range(40):
        forces = tuple(replace(one, amplitude=abs(f), phase_deg=float(np.angle(f, deg=True)))
                       for one, f in zip(UNITS, wave_drive(unit, *command)[0], strict=True))  # fmt: skip
        tick = beam_tick(forces, 2.0 * pi * HERTZ, 12 / HERTZ, tick, beam=BEAM, model="fem", count=14,
                         modal_damping=0.02, at=at)  # fmt: skip
        waves = fit_waves(at, tick.phasors, k)
        measured = np.array([waves.forward, waves.backward])
        errors.append(float(abs(measured - target).max()) / 1.3e-7)
        state, command = law.step(state, target, measured)
    assert 0.02 < errors[3] < 0.3
    assert errors[-1] < 1e-3


DRIVE = Drive(frequency_hz=HERTZ, force=(
    SceneForce(position=0.009, amplitude=30.0),
    SceneForce(position=0.009, measured_from="right", amplitude=30.0, phase_deg=90.0),
))  # fmt: skip
SLIDER = Slider(mass=0.004, mu=0.23, slope=20.0, coupling="one-way")
SCENE = Scene(name="small", beam=BEAM, drive=DRIVE, slider=SLIDER)
OWN = {"model": "fem", "count": 9, "modal_damping": 0.02, "upper": 2.5, "target": -5e-3, "speed": -4e-3}
CACHE = SolutionCache(BEAM)


def test_the_wave_between_resonances_follows_sooner_than_one_resonance():
    result = Control(plant="full", duration=0.12, **OWN).run(SCENE, CACHE, lambda what: None)
    rows = {row["plant"]: row for row in result.tables[0].records()}
    assert rows["averaged"]["overshoot"] == pytest.approx(0.0302, abs=0.001)
    assert rows["full"]["overshoot"] == pytest.approx(0.0153, abs=0.002)
    assert rows["full"]["settling time"] < rows["averaged"]["settling time"]
    assert abs(rows["full"]["steady error"]) < 0.01
    sizes = {margin.name: margin.size for margin in result.margins}
    assert sizes["interpolation of the force"] == pytest.approx(0.00383, abs=1e-4)


def test_the_averaged_motor_reaches_the_speeds_of_the_full_one():
    loop = ControlOptions(**(OWN | {"upper": 1.5})).loop(SCENE, CACHE)
    plants = loop.plants["averaged"], loop.plants["full"]
    states = [plant.start(-4e-3, loop.command) for plant in plants]  # the slider moves 1.5 mm
    for command, within in ((loop.command, 0.005), (1.3, 0.03), (0.9, 0.05)):
        states = [plant.advance(state, command, 1000 / HERTZ) for plant, state in zip(plants, states, strict=True)]
        averaged, full = (plant.read(state)[1] for plant, state in zip(plants, states, strict=True))
        assert full == pytest.approx(averaged, rel=within)


def test_feed_forward_alone_holds_the_target():
    options = ControlOptions(**(OWN | {"gain": 0.0, "integral_gain": 0.0, "feed_forward": True, "duration": 1.0}))
    assert options.response(SCENE, CACHE).steady_error == pytest.approx(0.0, abs=2e-4)


def test_position_is_controlled_by_the_phase():
    own = OWN | {"target": 2e-4, "speed": 0.0, "of": "position", "output": "phase", "lower": -90.0, "upper": 90.0}
    result = Control(**own, plant="full", duration=0.3, sample_time=40 / HERTZ).run(SCENE, CACHE, lambda what: None)
    rows = {row["plant"]: row for row in result.tables[0].records()}
    assert rows["full"]["overshoot"] == pytest.approx(rows["averaged"]["overshoot"], abs=0.02)
    assert abs(rows["full"]["steady error"]) < 1e-3
    assert rows["full"]["saturated"] > 0.2


def test_a_loop_that_cannot_exist_is_one_sentence():
    wrong = {"modal_damping": {"modal_damping": None}, "output": {"of": "position"}, "target": {"target": -0.9},
             "amplitude": {"lower": 0.0}, "upper": {"lower": 7.0}, "delay": {"delay": -1},
             "the motor starts there": {"target": -4e-3},
             "whole drive periods": {"plant": "full", "sample_time": 1.4 / HERTZ}}  # fmt: skip
    for words, changed in wrong.items():
        with pytest.raises(InputError, match=words):
            ControlOptions(**(OWN | changed)).loop(SCENE, CACHE)
