"""Actuators on a beam: fields and ports against dense elements and devices, powers, orders, time."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BEAMS, HELD, MODELS, close, over
from tests.reference.dense import Elements
from tests.reference.piezo_bar import Layer, respond
from verify import Device, ExactModel, Excitation, HermiteModel, Keep, PointForce, PointMoment, SegmentModel, simulate
from verify.actuators.on_beam import Mounted, beam_in_time, on_beam
from verify.actuators.patch import Patch
from verify.actuators.shunt import Load
from verify.actuators.transducers import Stack
from verify.errors import InputError, ResonanceError
from verify.problem.device import of_impedance

BEAM, HERTZ = replace(BEAMS["clamped-pinned"], loss_factor=0.007), 733.0
OMEGA, X = 2.0 * np.pi * HERTZ, np.linspace(0.03, 0.7, 17)
SOFT = Stack(layers=11, layer_thickness=4.1e-4, area=2.3e-9, dielectric_loss=0.011, mechanical_loss=0.017,
             piezoelectric_loss=0.009)  # fmt: skip
CLEAN = SOFT.lossless
FREE = replace(CLEAN, base="free", area=25e-6)
FORCE = PointForce(position=0.52, amplitude=0.7, phase_deg=31.0)
DEVICE = Device(position=0.61, dashpot=1.3, stiffness=910.0)
SERIES = Load(resistance=3.1e5, inductance=47.0)
PATCH = Patch(length=0.061, thickness=4e-4, width=0.02, sides=1)
STACK = Stack(layers=20, layer_thickness=0.5e-3, area=25e-6)


def mounted(actuator=SOFT):
    return [
        Mounted(actuator=actuator, position=0.0731, voltage=130.0 - 41.0j),
        Mounted(actuator=actuator, position=0.2913, current=7e-6 + 2e-6j),
        Mounted(actuator=actuator, position=0.4411, load=SERIES),
    ]


# --- Fields and ports ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stiffness", [1.0, 4e4])
def test_stacks_on_elements_are_those_of_finite_elements(stiffness):
    """Hermite elements, layers of degree 6, and the voltages of the stacks, in one matrix."""
    actuator, conditions = replace(SOFT, area=SOFT.area * stiffness), mounted()
    model = HermiteModel(BEAM, 14)
    written = Elements(BEAM, model.cut_at([one.position for one in conditions]).modes(1).nodes)
    layer = Layer(actuator.layer_thickness, actuator.area, actuator.ceramic.density, *actuator.bar_constants("33"))
    blocked, moved = (np.array(respond([layer] * actuator.layers, OMEGA, base=np.inf, voltage=1.0, tip=tip)[:2])
                      for tip in (0.0, 1.0))  # fmt: skip
    (b, y), (minus_z, back) = blocked, moved - blocked  # F = b V + minus_z v, I = y V + back v
    rows, device = np.array([written.row(one.position, 0) for one in conditions]), written.row(DEVICE.position, 0)
    stiff = written.bending * (1.0 + 1j * BEAM.loss_factor) + written.rest - OMEGA**2 * written.mass
    stiff = stiff + DEVICE.dynamic_stiffness(OMEGA) * np.outer(device, device)
    stiff = stiff - 1j * OMEGA * minus_z * rows.T @ rows
    # one of V = source, I = source, V = -I/Y_el for each stack
    current = np.hstack([1j * OMEGA * back * rows, y * np.eye(3)])
    volt = np.eye(len(stiff) + 3)[-3:]
    matrix = np.vstack([np.hstack([stiff, -b * rows.T]), volt[0], current[1],
                        volt[2] + current[2] / SERIES.admittance(OMEGA)])  # fmt: skip
    right = np.concatenate([written.load([FORCE]), [conditions[0].voltage, conditions[1].current, 0.0]])
    free = [*written.free, *range(len(stiff), len(matrix))]
    values = np.zeros(len(matrix), dtype=complex)
    values[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free])
    found = on_beam(model, mounted(actuator), HERTZ, forces=FORCE, devices=DEVICE)
    close(found.field.deflection(X), written.values_at(values[:-3], X, 0), 2e-8)
    ports = np.array([[one.voltage, one.current, one.velocity] for one in found.actuators]).T
    for own, expected in zip(ports, (volt @ values, current @ values, 1j * OMEGA * rows @ values[:-3]), strict=True):
        close(own, expected, 2e-8)
    assert ports[2] == pytest.approx(1j * OMEGA * rows @ values[:-3], rel=1e-6)


@over(MODELS)
def test_stacks_on_every_model_are_devices_with_a_blocked_force(name):
    model, port = MODELS[name](BEAM), replace(SOFT, area=25e-6).port(OMEGA)
    loads = (0.0, 0.0, SERIES.admittance(OMEGA))
    impedances = (port.short_impedance, port.loaded_impedance(), port.loaded_impedance(loads[2]))
    blocked = (port.force_factor * (130.0 - 41.0j), port.force_factor / port.blocked_admittance * (7e-6 + 2e-6j), 0.0)
    devices = [replace(of_impedance(one.position, complex(z), OMEGA), amplitude=abs(f), phase_deg=np.angle(f, deg=True))
               for one, z, f in zip(mounted(), impedances, blocked, strict=True)]  # fmt: skip
    found = on_beam(model, mounted(replace(SOFT, area=25e-6)), HERTZ, forces=FORCE).field
    expected = model.cut_at([one.position for one in devices]).harmonic(FORCE, HERTZ, devices=devices)
    close(found.deflection(X), expected.deflection(X), 1e-9)
    close(found.slope(X), expected.slope(X), 1e-9)


def test_a_patch_is_a_moment_at_either_end_and_its_shunt_a_spring_between_them():
    beam, patch = PATCH.on(BEAM, 0.31), PATCH.bonded(BEAM)
    port, ends = patch.port(OMEGA), (0.31 - 0.0305, 0.31 + 0.0305)
    moments = [PointMoment(position=x, amplitude=sign * 17.0 * port.force_factor.real)
               for x, sign in zip(ends, (-1.0, 1.0), strict=True)]  # fmt: skip
    driven = on_beam(ExactModel(beam), Mounted(actuator=patch, position=0.31, voltage=17.0), HERTZ)
    close(driven.field.deflection(X), ExactModel(beam).harmonic(moments, HERTZ).deflection(X), 1e-12)
    nodes = HermiteModel(beam, 40).cut_at(ends).modes(1).nodes
    written = Elements(beam, nodes)
    row = written.row(ends[1], 1) - written.row(ends[0], 1)
    spring = 1j * OMEGA * port.force_factor**2 / (port.blocked_admittance + SERIES.admittance(OMEGA))
    values = written.harmonic(written.load([FORCE]), HERTZ, more=spring / (1j * OMEGA) * np.outer(row, row))
    shunted = Mounted(actuator=patch, position=0.31, load=SERIES)
    found = on_beam(HermiteModel(beam, 40), shunted, HERTZ, forces=FORCE)
    close(found.field.deflection(X), written.values_at(values, X, 0), 1e-8)
    assert found.actuators[0].velocity == pytest.approx(1j * OMEGA * (row @ values), rel=1e-7)


@pytest.mark.parametrize(
    ("model", "counts", "actuator", "expected"),
    [
        (SegmentModel, (61, 122, 244, 488), SOFT, (4.0, 4.0)),
        (HermiteModel, (15, 30, 60, 120), SOFT, (4.0, 4.0)),
        (HermiteModel, (15, 30, 60, 120), PATCH.bonded(BEAM), (4.0, 4.0)),
        # a moment at a step of a chain: order 1 in the rotation at its own place
        (SegmentModel, (61, 122, 244, 488), PATCH.bonded(BEAM), (2.0, 1.0)),
    ],
)
def test_orders_of_the_field_and_of_the_velocity_of_actuators(model, counts, actuator, expected):
    beam = actuator.on(BEAM, [0.21, 0.45]) if isinstance(actuator, Patch) else BEAM
    both = [Mounted(actuator=actuator, position=x, voltage=v) for x, v in ((0.21, 31.0), (0.45, 17.0j))]
    x = np.array([0.04, 0.09, 0.33, 0.58, 0.69])

    def figures(model):
        found = on_beam(model, both, HERTZ)
        return found.field.deflection(x), np.array([one.velocity for one in found.actuators])

    exact = figures(ExactModel(beam))
    errors = np.array([[abs(a - b).max() for a, b in zip(figures(model(beam, n)), exact, strict=True)] for n in counts])
    assert np.log2(errors[0] / errors[-1]) / 3.0 == pytest.approx(expected, abs=0.5)
    assert (errors[-1] < 0.03 * np.array([abs(one).max() for one in exact])).all()


# --- Powers ----------------------------------------------------------------------------------------------------------


@over(MODELS)
@pytest.mark.parametrize("actuator", [SOFT, replace(PATCH, dielectric_loss=0.013).bonded(BEAM)], ids=["stack", "patch"])
def test_power_in_is_power_out_and_losses_and_a_lossless_beam_returns_it_all(name, actuator):
    beam = replace(BEAM, loss_factor=0.0)
    found = on_beam(MODELS[name](beam), mounted(actuator), HERTZ)
    scale = max(abs(one.power_in) for one in found.actuators)
    for one in found.actuators:
        assert one.power_in == pytest.approx(one.power_out + one.loss, abs=1e-11 * scale)
        assert one.loss >= 0.0
    assert abs(sum(one.power_out for one in found.actuators)) < 1e-9 * scale
    shunt = found.actuators[2]
    assert shunt.power_in == pytest.approx(-0.5 * 3.1e5 * abs(shunt.current) ** 2, rel=1e-9)


def test_the_power_of_all_actuators_is_dissipated_in_bending_and_in_a_dashpot():
    found = on_beam(ExactModel(BEAM), mounted(), HERTZ, devices=DEVICE)
    edges = np.unique([*np.linspace(0.0, BEAM.length, 60), DEVICE.position, *(one.position for one in mounted())])
    points, weights = np.polynomial.legendre.leggauss(8)
    half = 0.5 * np.diff(edges)[:, None]
    x, weights = (edges[:-1, None] + half * (points + 1.0)).ravel(), (half * weights).ravel()
    bending = abs(found.field.derivative(x, 2)) ** 2 @ weights * BEAM.bending_stiffness
    dashpot = DEVICE.dashpot * (OMEGA * abs(found.field.deflection(DEVICE.position)[0])) ** 2
    absorbed = sum(one.power_out for one in found.actuators)
    assert absorbed == pytest.approx(0.5 * (OMEGA * BEAM.loss_factor * bending + dashpot), rel=1e-9)


# --- Time ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "actuator", "off"),
    [("voltage", CLEAN, 2e-5), ("current", CLEAN, 2e-5), ("voltage", FREE, 2e-5), ("voltage", PATCH, 1e-9)],
)
def test_a_drive_in_time_has_the_steady_state_of_its_ports(kind, actuator, off):
    beam, amplitudes, places = replace(BEAM, loss_factor=0.03), (110.0, 70.0 * np.exp(1j)), (0.21, 0.45)
    forces = [PointForce(position=x, amplitude=abs(v), phase_deg=np.angle(v, deg=True))
              for x, v in zip(places, amplitudes, strict=True)]  # fmt: skip
    there = beam_in_time(beam, kind, forces, actuator, HERTZ)
    whole, port = (actuator.on(beam, places), actuator.bonded(beam)) if actuator is PATCH else (beam, actuator)
    driven = [Mounted(actuator=port, position=x, **{kind: v}) for x, v in zip(places, amplitudes, strict=True)]
    field = on_beam(ExactModel(whole), driven, HERTZ).field
    close(ExactModel(there.beam).harmonic(there.loads, HERTZ).deflection(X), field.deflection(X), off)
    assert there.error < off
    assert bool(there.error) == (actuator is not PATCH)
    assert bool(there.beam.spring) == (actuator is CLEAN)
    excitation = Excitation(there.loads, HERTZ, soft_start_periods=9)
    run = simulate(there.beam, excitation, 800 / HERTZ, model="fem", count=20, modal_damping=0.2, keep=Keep(at=X))
    lossless = HermiteModel(replace(there.beam, loss_factor=0.0), 20)
    steady = lossless.harmonic(there.loads, HERTZ, modal_damping=0.2).deflection(X)
    close(run.deflection[-1], (steady * np.exp(1j * OMEGA * run.times[-1])).real)


def test_the_mass_of_a_stack_is_a_third_of_its_own_far_below_its_resonance_and_all_of_it_on_a_free_base():
    for base, share in (("fixed", 1.0 / 3.0), ("free", 1.0)):
        beam = beam_in_time(BEAM, "voltage", [FORCE], replace(STACK, base=base), 0.02).beam
        assert beam.mass[0].mass == pytest.approx(share * 7500.0 * 25e-6 * 0.01, rel=1e-6)


@pytest.mark.parametrize(
    ("kind", "actuator", "message"),
    [
        ("displacement", None, "a beam moves in time under no displacements"),
        ("current", PATCH, "a beam moves in time under no currents of a patch"),
        ("voltage", replace(STACK, layers=4000), "in time it is a spring and a mass, which at 733 Hz errs by"),
    ],
)
def test_what_has_no_equivalent_in_time_is_refused(kind, actuator, message):
    with pytest.raises(InputError, match=message):
        beam_in_time(BEAM, kind, [FORCE], actuator, HERTZ)


def test_what_cannot_be_solved_is_refused():
    one = Mounted(actuator=STACK, position=0.21, voltage=1.0)
    with pytest.raises(InputError, match="two are at one position"):
        on_beam(ExactModel(HELD), [one, replace(one, voltage=2.0)], HERTZ)
    with pytest.raises(InputError, match="give one of voltage, current and load"):
        replace(one, current=1.0)
    with pytest.raises(InputError, match="on a clamped support"):
        on_beam(ExactModel(HELD), replace(one, position=0.0), HERTZ)
    with pytest.raises(ResonanceError, match="superposed on the beam without them"):
        on_beam(ExactModel(HELD), one, float(ExactModel(HELD).modes(3).frequencies_hz[2]))
