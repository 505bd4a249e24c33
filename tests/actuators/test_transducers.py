"""Bars, stacks and Langevin transducers against closed forms and against finite elements of their single layers."""

from math import inf, pi, sqrt

import numpy as np
import pytest
from msgspec.structs import asdict, replace
from scipy.optimize import brentq

from tests.reference.piezo_bar import Layer, bar_constants, respond
from verify.actuators.materials import EPS0, PIEZO
from verify.actuators.resonances import antiresonances, branch, coupling, impedance, resonances
from verify.actuators.transducers import Bar31, Bar33, EndMass, Langevin, Stack
from verify.errors import InputError

PZT4 = PIEZO["pzt-4"]
LOSSES = {"dielectric_loss": 0.004, "mechanical_loss": 0.002, "piezoelectric_loss": 0.003}
ALUMINIUM = EndMass(length=0.045, youngs_modulus=71e9, density=2800.0)
STEEL = EndMass(length=0.023, youngs_modulus=203e9, density=7810.0, area=7.1e-4)
LONG = Bar33(length=0.02, area=9e-6)
ACROSS = Bar31(length=0.02, width=0.003, thickness=0.0005)
STACK = Stack(layers=20, layer_thickness=0.0005, area=25e-6)
HALF_WAVE = Langevin(rings=2, ring_thickness=0.005, area=pi / 4 * (0.038**2 - 0.013**2), front=ALUMINIUM)
UNEQUAL = Langevin(rings=3, ring_thickness=0.0042, area=8.3e-4, front=ALUMINIUM, back=STEEL, material="pzt-8")
OTHERS = (
    Bar33(length=0.017, area=1.1e-5, material="pzt-8"),
    Bar31(length=0.023, width=0.0031, thickness=0.0007),
    Stack(layers=5, layer_thickness=0.0021, area=2.3e-5),
    UNEQUAL,
)
EACH = pytest.mark.parametrize("actuator", OTHERS, ids=lambda one: one.__struct_config__.tag)
CAPACITANCE = PZT4.derived.eps33 * ACROSS.length * ACROSS.width / ACROSS.thickness  # free, of the bar across the field


def layers_of(actuator):
    """The layers of a transducer from its base to its tip, for the finite elements."""
    density = actuator.ceramic.density
    if isinstance(actuator, Bar31):
        constants, area = actuator.bar_constants("31"), actuator.width * actuator.thickness
        return [Layer(actuator.length, area, density, *constants, actuator.thickness)]
    constants = (actuator.area, density, *actuator.bar_constants("33"))
    if isinstance(actuator, Bar33):
        return [Layer(actuator.length, *constants)]
    if isinstance(actuator, Stack):
        return [Layer(actuator.layer_thickness, *constants)] * actuator.layers
    back, front = (
        Layer(m.length, m.area or actuator.area, m.density, 1.0 / m.youngs_modulus)
        for m in (actuator.back, actuator.front)
    )
    return [back, *[Layer(actuator.ring_thickness, *constants)] * actuator.rings, front]


def test_pzt8_is_the_inverse_of_its_catalogue():
    """Strain-charge constants of the Morgan catalogue; k33, k31 of it and of APC 880 (Navy III) are 0.64, 0.30."""
    one = PIEZO["pzt-8"].derived
    assert (1e12 * one.s11, 1e12 * one.s33, 1e12 * one.d31, 1e12 * one.d33) == pytest.approx(
        (11.5, 13.5, -97.0, 225.0), rel=1e-3
    )
    assert one.eps33 / EPS0 == pytest.approx(1000.0, rel=1e-3)
    assert (one.k33, one.k31) == pytest.approx((0.64, 0.30), abs=0.012)


@pytest.mark.parametrize("name", PIEZO)
@pytest.mark.parametrize("direction", ["33", "31"])
def test_bar_constants_by_elimination_of_lateral_strains(name, direction):
    m = PIEZO[name]
    expected = bar_constants(m.c11, m.c12, m.c13, m.c33, m.e31, m.e33, EPS0 * m.eps33, direction == "33")
    assert replace(LONG, material=name).bar_constants(direction) == pytest.approx(expected, rel=1e-13)


def test_own_material_and_losses():
    own = replace(PZT4, c33=111e9)
    lossless, lossy = replace(LONG, material=own), replace(LONG, material=own, **LOSSES)
    assert resonances(lossy) == resonances(lossless) != resonances(LONG)
    assert impedance(lossy, 5e4).real > 1e-3 * abs(impedance(lossy, 5e4))
    for name, value, word in (("c13", 130e9, "definite"), ("c12", -140e9, "definite"), ("density", -1.0, "above 0")):
        with pytest.raises(InputError, match=word):
            replace(own, **{name: value})
    with pytest.raises(InputError, match="source of energy"):
        replace(lossy, piezoelectric_loss=0.0042)


def test_impedance_and_circuit_of_free_bars():
    f, one = np.array([1e3, 41e3, 93e3, 277e3]), PZT4.derived
    speed = 1.0 / sqrt(PZT4.density * one.s33_open)
    x = pi * f * LONG.length / speed
    clamped = one.eps33 * (1.0 - one.k33**2) * LONG.area / LONG.length
    expected = (1.0 - one.k33**2 * np.tan(x) / x) / (2j * pi * f * clamped)
    np.testing.assert_allclose(impedance(LONG, f), expected, rtol=1e-12)
    assert antiresonances(LONG, 2) == pytest.approx([speed / 0.04, 3 * speed / 0.04], rel=1e-13)
    ratio = resonances(LONG)[0] / antiresonances(LONG)[0]
    assert one.k33**2 == pytest.approx(0.5 * pi * ratio * np.tan(0.5 * pi * (1.0 - ratio)), rel=1e-12)
    x = pi * f * ACROSS.length * sqrt(PZT4.density * one.s11)
    admittance = 2j * pi * f * CAPACITANCE * (1.0 + one.k31**2 * (np.tan(x) / x - 1.0))
    np.testing.assert_allclose(1.0 / impedance(ACROSS, f), admittance, rtol=1e-12)
    inductance = ACROSS.length**2 * PZT4.density * one.s11 / (8.0 * one.k31**2 * CAPACITANCE)
    for n in (1, 2, 5):
        capacitance = 8.0 * one.k31**2 * CAPACITANCE / ((2 * n - 1) * pi) ** 2
        assert branch(ACROSS, n) == pytest.approx((capacitance, inductance), rel=1e-10)


def test_half_wave_langevin_equation():
    one, metal = PZT4.derived, ALUMINIUM
    ring = HALF_WAVE.ring_thickness * sqrt(PZT4.density * one.s33_open)
    ratio = sqrt(metal.density * metal.youngs_modulus * one.s33_open / PZT4.density)
    for frequencies, k in ((resonances(HALF_WAVE, 3), one.k33), (antiresonances(HALF_WAVE, 3), 0.0)):
        theta = 2.0 * pi * frequencies * ring
        mass = 2.0 * pi * frequencies * metal.length * sqrt(metal.density / metal.youngs_modulus)
        np.testing.assert_allclose(ratio * np.tan(mass) * np.tan(theta), 1.0 - k**2 * np.tan(theta) / theta, rtol=1e-11)


def test_stack_below_its_resonance_and_as_a_wave():
    one, length, w = PZT4.derived, 0.01, 2.0 * pi * np.array([40.0, 4000.0, 4276.0])
    port = STACK.port(w)
    np.testing.assert_allclose(port.force_factor, one.d33 * STACK.area / (one.s33 * STACK.layer_thickness), rtol=1e-12)
    dynamic = (1j * w * port.short_impedance).real
    assert dynamic[0] == pytest.approx(STACK.area / (one.s33 * length), rel=1e-6)
    mass = (dynamic[0] - dynamic[1]) / (w[1] ** 2 - w[0] ** 2)
    assert mass == pytest.approx(PZT4.density * STACK.area * length / 3.0, rel=1e-3)
    thin = replace(STACK, layers=400, layer_thickness=2.5e-5)  # a wave with the speed of short-circuited electrodes
    assert resonances(thin)[0] == pytest.approx(1.0 / sqrt(PZT4.density * one.s33) / (4.0 * length), rel=1e-5)
    bar = replace(STACK, layers=1, layer_thickness=length)  # one bar, C0 -> n^2 C0, h -> h/n, but for n
    assert bar.port(w[2]).short_impedance == pytest.approx(port.short_impedance[2], rel=1e-6)
    assert resonances(bar)[0] == pytest.approx(76534.907, abs=5e-4)  # a quarter of the wave of the free bar of 20 mm


@pytest.mark.parametrize("base", ["fixed", "free", 3.1e7])
@pytest.mark.parametrize("losses", [{}, LOSSES], ids=["lossless", "lossy"])
@EACH
def test_port_and_power_equal_those_of_finite_elements(actuator, losses, base):
    one = replace(actuator, base=base, **losses)
    for frequency, voltage, tip in ((7.1e3, 3.0 - 2.0j, 0.01 + 0.02j), (61e3, -1.3j, 0.7 - 0.1j)):
        w = 2.0 * pi * frequency
        stiffness = {"fixed": inf, "free": 0.0}.get(base, base)
        reference, port = respond(layers_of(one), w, base=stiffness, voltage=voltage, tip=tip), one.port(w)
        force = port.force_factor * voltage - port.short_impedance * tip
        current = port.blocked_admittance * voltage + port.force_factor * tip
        assert (force, current) == pytest.approx((reference.force, reference.current), rel=1e-8)
        lost = 0.5 * (voltage * np.conj(current)).real - 0.5 * (force * np.conj(tip)).real
        scale = 0.5 * (abs(voltage * current) + abs(force * tip))
        assert lost == pytest.approx(reference.loss, abs=1e-9 * scale)
        assert lost > 1e-6 * scale if losses else abs(lost) < 1e-12 * scale


@pytest.mark.parametrize("base", ["fixed", "free", 3.1e7])
@EACH
def test_forms_agree(actuator, base):
    mason, w = replace(actuator, base=base, **LOSSES), 2.0 * pi * np.array([300.0, 21e3, 87e3, 331e3])
    expected = asdict(mason.port(w))
    for name, value in asdict(replace(mason, form="klm").port(w)).items():
        np.testing.assert_allclose(value, expected[name], rtol=1e-12)
    errors = [
        max(np.max(abs(value / expected[name] - 1.0)) for name, value in asdict(one.port(w)).items())
        for one in (replace(mason, form="circuit", branches=n) for n in (40, 80))
    ]
    assert errors[0] < 1e-3
    assert 2.8 < np.log2(errors[0] / errors[1]) < 3.2


@pytest.mark.parametrize("actuator", [replace(UNEQUAL, base=3e8), STACK, LONG], ids=["langevin", "stack", "bar"])
def test_branches_add_up_to_the_admittance(actuator):
    branches, s = [branch(actuator, n) for n in range(1, 6)], 2j * pi * np.array([2e3, 11e3, 37e3])
    total = (1.0 / impedance(actuator, s.imag / (2.0 * pi)) / s).real
    rest = total - sum(1.0 / (1.0 / c + s**2 * inductance) for c, inductance in branches).real  # clamped, higher
    assert np.ptp(rest) < 4e-3 * rest.mean() < 0.1 * np.ptp(total)


@pytest.mark.parametrize("base", ["fixed", "free", 4.4e8])
@pytest.mark.parametrize(
    "actuator",
    [
        UNEQUAL,
        replace(HALF_WAVE, back=replace(ALUMINIUM, length=0.0451)),
        replace(HALF_WAVE, front=replace(ALUMINIUM, area=HALF_WAVE.area / 300)),
        replace(STACK, layers=7),
    ],
    ids=["unequal", "nearly symmetric", "thin", "stack"],
)
def test_no_resonance_is_missed(actuator, base):
    one = replace(actuator, base=base)
    poles, zeros = resonances(one, 6), antiresonances(one, 6)
    assert np.all(poles < zeros)
    assert np.all(zeros[:-1] < poles[1:])
    f = np.unique(np.concatenate([np.geomspace(500.0, zeros[-1], 20_001), poles * (1 - 1e-9), poles * (1 + 1e-9)]))
    susceptance = (1.0 / impedance(one, f)).imag
    falls = np.flatnonzero((susceptance[:-1] > 0.0) & (susceptance[1:] < 0.0))  # it rises everywhere else (Foster)
    roots = [brentq(lambda x: impedance(one, x).imag, f[i], f[i + 1], xtol=1e-9, rtol=1e-15) for i in falls]
    assert poles == pytest.approx(roots, rel=1e-11)


def test_modes_that_the_voltage_does_not_excite_are_left_out():
    assert resonances(ACROSS, 3) == pytest.approx(resonances(ACROSS)[0] * np.array([1.0, 3.0, 5.0]), rel=1e-12)
    assert coupling(ACROSS, 2) < coupling(ACROSS)
    with pytest.raises(InputError, match="excites no resonance"):
        resonances(replace(LONG, material=replace(PZT4, e31=0.0, e33=0.0)))
    with pytest.raises(InputError, match="count = 0"):
        resonances(LONG, 0)
