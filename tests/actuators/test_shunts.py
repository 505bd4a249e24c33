"""Shunt damping and the absorbing stack: closed forms against search and a state-space model, independent figures."""

from types import SimpleNamespace

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import minimize

from verify import Beam, InputError
from verify.actuators.shunt import Load, ShuntedMode, absorbing_load
from verify.actuators.transducers import Stack
from verify.quantities import evaluate
from verify.waves.impedance_matching import ending

FIFTH = ShuntedMode(coupling=0.2)
PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
STACK = Stack(layers=20, layer_thickness=0.5e-3, area=25e-6)
OMEGA, DISTANCE = 2.0 * np.pi * 4276.0, 0.0116
SCENE = SimpleNamespace(beam=PAPER, drive=SimpleNamespace(frequency_hz=4276.0, actuator=STACK), beside="")


def measured(name, **arguments):
    return evaluate(name, arguments, SCENE, None)


def test_figures_at_a_coupling_of_one_fifth():
    hagood, exact = FIFTH.optimum("hagood"), FIFTH.optimum("series")
    assert FIFTH.peak(hagood) == pytest.approx(7.28797, rel=1e-6)
    assert [1.0 / hagood.inductance, 1.0 / exact.inductance] == pytest.approx([1.04, 1.04033925381565], rel=1e-13)
    assert [exact.resistance, FIFTH.peak(exact)] == pytest.approx([0.239411627043163, 6.97213657278449], rel=1e-13)
    resistor = FIFTH.optimum("resistor")
    assert [FIFTH.peak(resistor), resistor.resistance] == pytest.approx([50.0, np.sqrt(2.0 / 2.04)], rel=1e-12)


@pytest.mark.parametrize("coupling", [0.03, 0.17, 0.61])
@pytest.mark.parametrize("circuit", ["resistor", "series", "parallel", "negative-parallel"])
def test_closed_form_is_the_optimum_of_a_search(circuit, coupling):
    mode = ShuntedMode(coupling=coupling, omega=731.0, capacitance=23e-9)
    load = mode.optimum(circuit, 0.43 * mode.capacitance if circuit == "negative-parallel" else None)
    names, step = ["resistance", "inductance"][: 1 + bool(load.inductance)], 0.3 * coupling

    def peak(x):
        factors = zip(names, np.exp(x).tolist(), strict=True)
        return mode.peak(replace(load, **{name: factor * getattr(load, name) for name, factor in factors}))

    simplex = [[step, 0.1 * step], [0.5 * step, -0.1 * step], [-step, 0.0]] if len(names) == 2 else [[0.2], [-0.1]]
    options = {"xatol": 1e-10, "fatol": 1e-14, "initial_simplex": simplex, "maxiter": 2000}
    least = minimize(peak, simplex[0], method="Nelder-Mead", options=options)
    assert mode.peak(load) == pytest.approx(least.fun, rel=1e-9)
    assert least.x == pytest.approx(0.0, abs=2e-6)


def test_peaks_of_single_resistors_in_closed_form():
    assert FIFTH.peak(FIFTH.optimum("negative-parallel", 0.43)) == pytest.approx(50.0 * 0.57, rel=1e-12)
    stiffness = FIFTH.stiffness(FIFTH.optimum("resistor-loss"), np.linspace(0.5, 1.5, 1001))
    loss = stiffness.imag / stiffness.real
    assert loss.max() == loss[500] == pytest.approx(0.02 / np.sqrt(1.04), rel=1e-12)
    parallel = FIFTH.optimum("parallel")  # near Yamada's fixed points
    assert [parallel.inductance, FIFTH.peak(parallel)] == pytest.approx([2.0 / 1.96, np.sqrt(2.0) / 0.2], rel=1e-3)
    assert FIFTH.peak(Load(inductance=0.7)) == np.inf


def states(mode, load):
    """First-order matrix of (deflection, speed, charge of the actuator, charge through a series load), mass 1."""
    stiffness, c = mode.omega**2, mode.capacitance
    theta = mode.coupling * np.sqrt(stiffness * c)  # F = theta V, charge C V + theta w
    volt = np.array([-theta, 0.0, 1.0, 0.0]) / c  # by (w, speed, q, its rate)
    across = volt + (np.array([0.0, 0.0, 1.0, 0.0]) / load.capacitance if load.capacitance else 0.0)
    rows = np.array([[0.0, 1.0, 0.0, 0.0], theta * volt - [stiffness, 0.0, 0.0, 0.0], -across / load.resistance])
    if not load.inductance:
        return rows[:, :3]
    rows[2] = [0.0, 0.0, 0.0, 1.0]
    return np.vstack([rows, -(across + load.resistance * rows[2]) / load.inductance])


@pytest.mark.parametrize("parts", [(3.1e4, 71.0, None), (3.1e4, None, None), (2e4, None, -61e-9), (2e4, 43.0, 57e-9)])
def test_response_equals_the_state_space_model(parts):
    load = Load(**dict(zip(("resistance", "inductance", "capacitance"), parts, strict=True)))
    mode = ShuntedMode(coupling=0.34, omega=731.0, capacitance=23e-9)
    matrix, omegas = states(mode, load), np.array([311.0, 735.0, 911.0])
    force = np.eye(len(matrix))[1]
    expected = [np.linalg.solve(1j * omega * np.eye(len(matrix)) - matrix, force)[0] for omega in omegas]
    assert mode.response(load, omegas) == pytest.approx(np.array(expected) * mode.omega**2, rel=1e-11)


def test_negative_capacitance_is_refused_beyond_stability():
    mode = ShuntedMode(coupling=0.31, omega=731.0, capacitance=23e-9)
    least = (1.0 + mode.coupling**2) * mode.capacitance
    with pytest.raises(InputError, match=r"negative = .* below"):
        mode.optimum("negative-parallel", mode.capacitance)
    stable, unstable = (Load(resistance=4e4, capacitance=-factor * least) for factor in (1.001, 0.999))
    growth = [np.linalg.eigvals(states(mode, load)).real.max() for load in (stable, unstable)]
    assert growth[0] < 0.0 < growth[1]
    softened = 1.0 - mode.coupling**2 / (1.001 * (1.0 + mode.coupling**2) - 1.0)
    assert mode.peak(stable) == pytest.approx(1.0 / softened, rel=1e-9)
    parallel = Load(resistance=4e4, capacitance=-1.001 * mode.capacitance, connection="parallel")
    for load in (unstable, parallel):
        with pytest.raises(InputError, match="makes the mode unstable"):
            mode.peak(load)


def test_loads_are_circuits():
    w, (r, ind, c) = np.array([13.0, 170.0]), (3.0, 0.11, 2.3e-3)
    both = [Load(resistance=r, inductance=ind, capacitance=c, connection=name) for name in ("series", "parallel")]
    series, parallel = (load.admittance(w) for load in both)
    assert 1.0 / series == pytest.approx(r + 1j * w * ind + 1.0 / (1j * w * c), rel=1e-13)
    assert parallel == pytest.approx(1.0 / r + 1.0 / (1j * w * ind) + 1j * w * c, rel=1e-13)
    for values, field in (({}, ": it has no load"), ({"resistance": -1.0}, r"\.resistance = -1")):
        with pytest.raises(InputError, match=f"shunt{field}"):
            Load(**values)


def test_the_absorbing_load_of_a_stack_has_no_reflection_and_is_passive():
    port, end = STACK.port(OMEGA), ending(PAPER, 4276.0, DISTANCE)
    load = absorbing_load(port, end.matched, OMEGA)
    assert end.reflection(port.loaded_impedance(load.admittance(OMEGA))) < 1e-9
    with pytest.raises(InputError, match="ohm, which is active"):
        absorbing_load(port, -end.matched.conjugate(), OMEGA)


def test_quantities_without_an_actuator():
    best = ShuntedMode(coupling=0.34, omega=2.0 * np.pi * 116.3, capacitance=23e-9).optimum("parallel")
    real = {"coupling": 0.34, "short_hz": 116.3, "capacitance": 23e-9}
    for figure in ("resistance", "inductance"):
        value = measured("shunt.optimum", figure=figure, circuit="parallel", **real)
        assert value == pytest.approx(getattr(best, figure), rel=1e-12)
    lossy = {"circuit": "resistor-loss", "coupling": 0.2, "figure": "loss_factor"}
    assert measured("shunt.optimum", **lossy) == pytest.approx(0.02 / np.sqrt(1.04), rel=1e-12)
    assert measured("shunt.optimum", coupling=0.2, circuit="negative-parallel", negative=0.43) == pytest.approx(28.5)
    for changed, sentence in (
        ({}, "give coupling, or mode and position"),
        ({"mode": 1, "position": 0.2}, "kind = 'patch'"),
        ({"coupling": 0.2, "circuit": "resistor", "figure": "inductance"}, "inductance: the load"),
        ({"coupling": 1.2}, "coupling = 1.2 has no optimum of two equal peaks"),
        ({"coupling": 0.2, "negative": 0.4}, "negative = 0.4"),
    ):
        with pytest.raises(InputError, match=sentence):
            measured("shunt.optimum", **changed)
