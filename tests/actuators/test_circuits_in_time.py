"""Circuits on a beam in time: coupled equations, steady states, limits of the load, sliders and energies."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.integrate import solve_ivp

from tests.beams import close
from verify import (
    Beam,
    Excitation,
    HermiteModel,
    Keep,
    PointForce,
    PointMass,
    PointSpring,
    Slider,
    free_vibration,
    simulate,
)
from verify.actuators.on_beam import Mounted, QuasiStatic, beam_in_time, on_beam
from verify.actuators.patch import Patch
from verify.actuators.shunt import Load
from verify.actuators.transducers import Stack
from verify.analysis.solution_cache import SolutionCache
from verify.dynamics.linear_system import basis_of
from verify.errors import InputError
from verify.quantities import evaluate
from verify.scene.model import Drive, Scene, SceneForce, SceneShunt
from verify.studies.motion import Motion

BARE = Beam(
    length=0.2, width=0.017, thickness=0.0011, youngs_modulus=71e9, density=2700, supports=("pinned", "clamped")
)
SPRING, BODY = PointSpring(position=0.07, stiffness=900.0), PointMass(position=0.07, mass=1e-3)
BEAM, HERTZ, X = replace(BARE, spring=(SPRING,), mass=(BODY,)), 263.0, [0.031, 0.113]
FORCES = (PointForce(position=0.13, amplitude=0.4, phase_deg=33.0), PointForce(position=0.05, amplitude=0.2))
ACTUATOR, STACK = QuasiStatic(force_factor=0.05, capacitance=4e-8), Stack(layers=11, layer_thickness=4e-4, area=2.3e-9)
COIL = Load(resistance=900.0, inductance=0.9)
# load, voltage of a source behind it, F in parallel with the actuator, (V, A, C) -> (A into it, A/s of the coil)
CIRCUITS = {
    "segment": (replace(COIL, capacitance=3e-7), 3 - 2j, 0.0, lambda u, i, q: (i, (-u - 900.0 * i - q / 3e-7) / 0.9)),
    "fem": (Load(resistance=4100.0), 3 - 2j, 0.0, lambda u, i, q: (-u / 4100.0, 0.0)),
    "parallel": (Load(resistance=7000.0, inductance=0.5, capacitance=1.7e-8, connection="parallel"), None, 1.7e-8,
                 lambda u, i, q: (i - u / 7000.0, -u / 0.5)),
    "negative": (Load(resistance=3000.0, capacitance=-1.1e-8, connection="parallel"), None, -1.1e-8,
                 lambda u, i, q: (-u / 3000.0, 0.0)),
}  # fmt: skip


def shunt(load, voltage=None, **changes):
    return Mounted(actuator=replace(ACTUATOR, **changes), position=0.07, load=load, voltage=voltage)


@pytest.mark.parametrize("kind", CIRCUITS)
def test_free_decay_is_that_of_the_coupled_equations(kind):
    (load, _, beside, law), model, ratio = CIRCUITS[kind], kind if kind == "fem" else "segment", 0.0013
    settings = {"model": model, "count": 4, "modal_damping": ratio}
    before = free_vibration(BEAM, lambda x: 1e-3 * x * (0.2 - x) ** 2, 1e-9, samples=2, **settings)
    shunted = Excitation((), HERTZ, circuits=shunt(load))
    run = simulate(BEAM, shunted, 0.004, start=before, keep=Keep(at=X, samples=9), **settings)
    basis = basis_of(BEAM, model, 4, None)
    b, n, w = 0.05 * basis.loads(0.07), len(basis.omegas), basis.omegas

    def slope(t, y):
        q, v, (volt, current, charge) = y[:n], y[n : 2 * n], y[2 * n :]
        into, rate = law(volt, current, charge)
        ends = (into - b @ v) / (4e-8 + beside), rate, current
        return np.concatenate([v, b * volt - 2.0 * ratio * w * v - w**2 * q, ends])

    # in equilibrium a capacitor in series has a part of the charge that short-circuited electrodes have
    charge = b @ before.end.q
    start = [-charge / 3.4e-7, 0.0, charge * 3.0 / 3.4] if kind == "segment" else [0.0, 0.0, 0.0]
    start, times = np.concatenate([before.end.q, before.end.rates, start]), run.times - 1e-9
    exact = solve_ivp(slope, (0.0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-15).y
    close(run.deflection, exact[:n].T @ basis.shapes(np.array(X), 0), 1e-9)
    close(run.voltages[:, 0], exact[2 * n], 1e-9)


@pytest.mark.parametrize("kind", [*CIRCUITS, "patch"])
def test_a_driven_circuit_settles_in_the_steady_state_of_its_port(kind):
    beam, one, turn = BEAM, shunt(*CIRCUITS.get(kind, (COIL, None))[:2]), np.exp(2j * np.pi * HERTZ * 1.5)
    if kind == "patch":
        patch = Patch(length=0.041, thickness=4e-4, width=0.011, sides=1)
        there = beam_in_time(BARE, "force", (), patch, HERTZ, [(0.07, Load(resistance=2.1e4, inductance=31.0))])
        beam, (one,) = there.beam, there.circuits
    exact = on_beam(HermiteModel(beam, 5), one, HERTZ, forces=FORCES, modal_damping=0.04)
    (port,), settings = (
        exact.actuators,
        {"model": "fem", "count": 5, "modal_damping": 0.04, "keep": Keep(at=X, samples=2)},
    )
    for start, periods in (("rest", 5.0), ("steady", 0.0)):
        excitation = Excitation(FORCES, HERTZ, soft_start_periods=periods, circuits=one)
        run = simulate(beam, excitation, 1.5, start=start, **settings)
        close(run.deflection[-1], (exact.field.deflection(X) * turn).real, 1e-9)
        close(run.voltages[-1], (port.voltage * turn).real, 1e-9)
        close(run.charges[-1], (port.current / (2j * np.pi * HERTZ) * turn).real, 1e-9)


def test_resistors_go_to_short_and_to_open_electrodes():
    def off(resistance, like):
        settings = {"model": "segment", "count": 7, "keep": Keep(at=X, samples=7)}
        one = simulate(BEAM, Excitation(FORCES, HERTZ, circuits=shunt(Load(resistance=resistance))), 0.01, **settings)
        return abs(one.deflection - simulate(like, Excitation(FORCES, HERTZ), 0.01, **settings).deflection).max()

    opened = replace(BEAM, spring=(replace(SPRING, stiffness=900.0 + 0.05**2 / 4e-8),))
    for far, near, like in ((2e-2, 1e-2, BEAM), (5e9, 1e10, opened)):
        assert off(far, like) / off(near, like) == pytest.approx(2.0, rel=1e-3)
        assert off(near, like) < 1e-5 * off(4000.0, like)


@pytest.mark.parametrize("load", [Load(resistance=4100.0), COIL])
def test_energy_of_a_slider_on_a_shunted_beam_balances(load):
    settings = {"model": "segment", "count": 12, "modal_damping": 0.013, "keep": Keep(samples=4001), "step": 2e-6}
    settings |= {"slider": Slider(mass=0.02, mu=0.3, position=0.12)}
    strong = tuple(replace(force, amplitude=60.0 * force.amplitude) for force in FORCES)
    bare, weak, run = (
        simulate(BEAM, Excitation(strong, 911.0, circuits=one), 0.02, **settings)
        for one in ((), shunt(load, force_factor=1e-9), shunt(load))
    )
    close(weak.travelled, bare.travelled, 1e-9)
    assert abs(run.displacement / bare.displacement - 1.0) > 0.1
    energy, volt, charge = run.energy, run.voltages[:, 0], run.charges[:, 0]
    assert abs(energy.residual) < 1e-4 * energy.drive_work
    stored = 0.5 * (load.inductance or 0.0) * np.gradient(charge, run.times, edge_order=2)[-1] ** 2
    assert energy.circuit_loss == pytest.approx(-np.trapezoid(volt, charge) - stored, rel=1e-3)
    assert energy.circuit_loss > 0.05 * energy.drive_work


def test_a_scene_runs_its_shunts_in_time():
    load = SceneShunt(position=0.09, measured_from="right", resistance=3.1e5, inductance=470.0)
    drive = Drive(frequency_hz=HERTZ, force=(SceneForce(position=0.05, amplitude=3.0),), actuator=STACK, shunt=(load,))
    scene = Scene(name="shunted", beam=replace(BARE, loss_factor=0.02), drive=drive, slider=Slider(mass=0.002, mu=0.3),
                  studies={"motion": Motion(duration=0.01, count=6)})  # fmt: skip
    scenes = scene, replace(scene, drive=replace(drive, shunt=(), actuator=None))
    moved = [evaluate("slider.displacement", {"count": 6}, one, SolutionCache(one.beam)) for one in scenes]
    assert 1e-3 < abs(moved[0] / moved[1] - 1.0) < 10.0
    there, one = scene.in_time(scene.forces, HERTZ), Mounted(actuator=STACK, position=0.11, load=scene.shunts[0][1])
    excitation = Excitation(there.loads, HERTZ, circuits=there.circuits)
    run = simulate(there.beam, excitation, 1e-3, model="fem", count=20, start="steady")
    exact = on_beam(HermiteModel(scene.beam, 20), one, HERTZ, forces=scene.forces)
    assert run.voltages[0, 0] == pytest.approx(exact.actuators[0].voltage.real, rel=1e-5)
    with pytest.raises(InputError, match=r"does not model drive\.shunt"):
        evaluate("chain.transient_deflection", {"segments": 5, "x": 0.1}, scene, SolutionCache(scene.beam))


@pytest.mark.parametrize(("one", "message"), [
    (shunt(None, 1.0), "has no load, give one"),
    (Mounted(actuator=STACK, position=0.07, load=COIL), "see beam_in_time"),
    (shunt(Load(capacitance=1e-8), 1.0), "is behind a resistance or inductance"),
    (shunt(Load(capacitance=-4.01e-8)), "a negative capacitance makes the beam unstable"),
    (shunt(Load(capacitance=-3.9e-8, resistance=90.0)), "a negative capacitance makes the beam unstable"),
])  # fmt: skip
def test_what_has_no_equivalent_is_refused(one, message):
    with pytest.raises(InputError, match=message):
        simulate(BEAM, Excitation(FORCES, HERTZ, circuits=one), 1e-3, model="fem", count=5)
    with pytest.raises(InputError, match="circuits act on truncated modes too"):
        simulate(BARE, Excitation(FORCES, HERTZ, circuits=shunt(COIL)), 1e-3, model="analytic")
