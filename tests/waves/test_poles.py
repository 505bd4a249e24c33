"""Devices and displacements where the bare beam resonates: every model beside its own equations in 40 digits."""

from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from verify import Beam, PointForce, analytic_modes, fem_beam, segment_model
from verify.device import Device
from verify.errors import InputError, ResonanceError
from verify.models.fields import HarmonicField
from verify.waves.devices import DevicesResonanceError, field_with_devices
from verify.waves.imposed import HeldResonanceError, driven_field, held_units
from verify.waves.measures import measured_figure

STRIP = Beam(length=0.24, width=0.012, thickness=0.0015, youngs_modulus=200e9, density=7850.0)
N, MODE = 14, 5
JOINTS = np.array([1, 4, 6, 9, 12]) * STRIP.length / N
PARTS = (0.0, 1e-12, -2e-10, 3e-9, -4e-8, 5e-7, -6e-6, 1e-5)
"""Off the resonance, relative."""
mp.dps = 40


class Exact:
    """Green's function of the pinned beam."""

    def __init__(self, hertz):
        self.omega, self.length = 2 * mp.pi * mpf(hertz), mpf(STRIP.length)
        self.k = mp.sqrt(self.omega / mpf(STRIP.wave_constant))
        self.answer = cache(self.answer)

    def answer(self, x, source, derivative=0):
        k, left = self.k, x <= source
        own, other = (x, self.length - source) if left else (self.length - x, source)
        sign = 1 if left else -1
        turned = {0: (mp.sin, mp.sinh), 1: (mp.cos, mp.cosh)}[derivative]
        parts = [
            of(k * own) * whole(k * other) / whole(k * self.length)
            for of, whole in zip(turned, (mp.sin, mp.sinh), strict=True)
        ]
        return (sign * k) ** derivative * (parts[0] - parts[1]) / (2 * mpf(STRIP.bending_stiffness) * k**3)


class Dense:
    """Unknowns under D = K - omega^2 M; a force acts on them and a place is read by the same weights."""

    def __init__(self, hertz):
        self.omega, self.size = 2 * mp.pi * mpf(hertz), mpf(STRIP.length) / N
        stiffness, mass = self.matrices(mpf(STRIP.bending_stiffness), mpf(STRIP.mass_per_length), self.size)
        self.inverse = mp.inverse(stiffness - self.omega**2 * mass)

    def answer(self, x, source):
        return (self.weights(x) * self.inverse * self.weights(source).T)[0]


class Links(Dense):
    """Rigid links between pins: joints with EI/l, links with m l^2/12, read by y + l^2 y''/12."""

    @staticmethod
    def matrices(ei, m, size):
        n = N - 1
        bends, mass = mp.zeros(n), mp.zeros(n)
        for i in range(n):
            bends[i, i], mass[i, i] = mpf(-2), mpf(2) / 3
            for j in (i - 1, i + 1):
                if 0 <= j < n:
                    bends[i, j], mass[i, j] = mpf(1), mpf(1) / 6
        return ei / size**3 * bends.T * bends, m * size * mass

    def weights(self, x):
        row, joint = mp.zeros(1, N - 1), round(float(x / self.size))
        for at, weight in ((joint - 1, 1), (joint, 10), (joint + 1, 1)):
            if 0 < at < N:
                row[at - 1] = mpf(weight) / 12
        return row


class Elements(Dense):
    """Hermite elements between pins."""

    @staticmethod
    def matrices(ei, m, h):
        k = mp.matrix([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2]])
        own = mp.matrix([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2]])
        stiffness, mass = mp.zeros(2 * N + 2), mp.zeros(2 * N + 2)
        turn = (-1, 1, -1, 1)  # seen from the other end
        for e in range(N):
            for whole, half, factor in ((stiffness, k, ei / h**3), (mass, own, m * h / 420)):
                for i in range(2):
                    for j in range(4):
                        whole[2 * e + i, 2 * e + j] += factor * half[i, j]
                        flipped = turn[i] * turn[j] * half[i, j]
                        whole[2 * e + 2 + i, 2 * e + (j + 2) % 4] += factor * flipped
        kept = [i for i in range(2 * N + 2) if i not in (0, 2 * N)]
        return tuple(mp.matrix([[one[i, j] for j in kept] for i in kept]) for one in (stiffness, mass))

    def weights(self, x):
        row, e = mp.zeros(1, 2 * N + 2), min(int(x / self.size), N - 1)
        s = x / self.size - e
        cubics = (
            1 - 3 * s**2 + 2 * s**3,
            (s - 2 * s**2 + s**3) * self.size,
            3 * s**2 - 2 * s**3,
            (s**3 - s**2) * self.size,
        )
        for i, value in enumerate(cubics):
            row[2 * e + i] = value
        return mp.matrix([[row[i] for i in range(2 * N + 2) if i not in (0, 2 * N)]])


MODELS = {
    "analytic": (Exact, analytic_modes, ()),
    "segment": (Links, segment_model, (N,)),
    "fem": (Elements, fem_beam, (N,)),
}


def solving(model):
    _, module, count = MODELS[model]
    return lambda beam, forces, hertz: module.solve_harmonic(beam, forces, hertz, *count)


def resonance(model, mode=MODE):
    _, module, count = MODELS[model]
    return float(module.solve_modes(STRIP, mode, *count).frequencies_hz[-1])


def with_dashpot(system, dashpot, x, source, place, derivative=0):
    """Deflection or slope at x under a unit force, in digits: the receptances and one force more."""
    more = (derivative,) if derivative else ()
    x, source, place = (mpf(float(at)) for at in (x, source, place))
    pull = mp.mpc(0, 1) * system.omega * mpf(dashpot)
    share = pull * system.answer(place, source) / (1 + pull * system.answer(place, place))
    return complex(system.answer(x, source, *more) - share * system.answer(x, place, *more))


def off(found, wanted):
    return float(abs(found - wanted).max() / abs(wanted).max())


@settings(deadline=None, max_examples=60)
@given(
    mode=st.integers(1, 12),
    power=st.floats(-4.0, 2.0),
    part=st.one_of(
        st.just(0.0),
        st.tuples(st.floats(-12.0, -5.0), st.sampled_from((-1.0, 1.0))).map(lambda pair: pair[1] * 10.0 ** pair[0]),
    ),
    place=st.floats(0.03, 0.97),
    source=st.floats(0.03, 0.97),
)
def test_a_field_with_any_light_dashpot_is_right_on_a_resonance_and_beside(mode, power, part, place, source):
    """To the rounding of the frequency over the distance to the damped pole."""
    place, source, dashpot = place * STRIP.length, source * STRIP.length, 10.0**power
    hertz = analytic_modes.frequency_hz(STRIP, mode) * (1.0 + part)
    weight = np.sin(mode * np.pi * place / STRIP.length) ** 2 / (STRIP.mass_per_length * STRIP.length)
    damping = dashpot * weight / (2 * np.pi * hertz)
    assume(damping > 1e-11)
    field = field_with_devices(
        solving("analytic"), STRIP, [PointForce(position=source)], hertz, [Device(position=place, dashpot=dashpot)]
    )
    system, x = Exact(hertz), np.linspace(0.013, 0.231, 5)
    for derivative in (0, 1):
        wanted = np.array([with_dashpot(system, dashpot, at, source, place, derivative) for at in x])
        assert off(field.shapes(x, derivative), wanted) < 2e-9 + 5e-15 / np.hypot(damping, part)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("part", PARTS)
def test_every_model_with_a_light_dashpot_is_right_at_its_own_resonance(model, part):
    hertz = resonance(model) * (1.0 + part)
    system, place, source = MODELS[model][0](hertz), float(JOINTS[1]), float(JOINTS[3])
    for dashpot, within in ((1e-4, 1e-6), (1e-3, 1e-7), (0.01, 1e-8), (1.0, 2e-9), (100.0, 2e-9)):
        device = Device(position=place, dashpot=dashpot)
        field = field_with_devices(solving(model), STRIP, [PointForce(position=source)], hertz, [device])
        wanted = np.array([with_dashpot(system, dashpot, x, source, place) for x in JOINTS])
        assert off(field.deflection(JOINTS), wanted) < within
        pull = complex(1j * float(system.omega) * dashpot * wanted[1])
        assert field.forces[1].amplitude == pytest.approx(abs(pull), rel=within)
        assert field.frequency_hz == hertz


@pytest.mark.parametrize("dashpot", [0.01, 0.3, 20.0])
def test_crests_and_the_quality_of_the_wave_are_right_on_a_resonance(dashpot):
    hertz, place = analytic_modes.frequency_hz(STRIP, 9), 0.211
    system = Exact(hertz)

    def shapes(x, derivative):
        return np.array([with_dashpot(system, dashpot, at, 0.0099, place, derivative) for at in x])

    exact = HarmonicField(model="analytic", count=None, beam=STRIP, frequency_hz=hertz, forces=(), shapes=shapes)
    force, device = PointForce(position=0.0099), Device(position=place, dashpot=dashpot)
    field = field_with_devices(solving("analytic"), STRIP, [force], hertz, [device])
    for figure in ("crest_speed", "standing_wave_ratio", "energy_flux"):
        found, wanted = (measured_figure(one, (0.05, 0.17), waves_of(hertz), figure) for one in (field, exact))
        assert found == pytest.approx(wanted, rel=1e-6), figure


def waves_of(hertz):
    return complex(np.sqrt(2 * np.pi * hertz / STRIP.wave_constant))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("part", [0.0, 1e-12, -2e-10, 3e-9, -4e-8, 1e-5])
def test_displacements_near_a_node_are_held(model, part):
    """The held beam resonates as much closer to the free one as the square of the distance to the node."""
    hertz = resonance(model) * (1.0 + part)
    system = MODELS[model][0](hertz)
    for away in (0.1, 0.004, 2e-4) if model != "segment" else (1 / 14,):  # a joint
        place = STRIP.length * (1 + away) / MODE
        drive = PointForce(position=place, amplitude=1e-6, phase_deg=30.0)
        field = driven_field(lambda forces, f: solving(model)(STRIP, forces, f), [drive], hertz, "displacement")
        own = system.answer(mpf(place), mpf(place))
        wanted = np.array([complex(system.answer(mpf(float(x)), mpf(place)) / own) for x in JOINTS])
        wanted = wanted * 1e-6 * np.exp(1j * np.deg2rad(30.0))
        within = 1e-9 + 1e-15 / away**2
        assert off(field.deflection(JOINTS), wanted) < within
        assert field.deflection(place) == pytest.approx(1e-6 * np.exp(1j * np.deg2rad(30.0)), rel=within)

        def units(acting, frequencies, x):
            _, module, count = MODELS[model]
            return module.unit_responses(STRIP, acting, frequencies, x, *count)

        mapped = held_units(units, np.array([place]), STRIP, np.array([hertz, 77.0]), JOINTS)
        assert off(mapped[0, 0] * 1e-6 * np.exp(1j * np.deg2rad(30.0)), wanted) < max(within, 1e-6 * bool(part))


@pytest.mark.parametrize("model", MODELS)
def test_a_node_of_the_resonance_is_refused_for_devices_and_displacements(model):
    hertz, node = resonance(model, 7), 2 * STRIP.length / 7  # a joint of 14 links
    force, solve = [PointForce(position=0.0099)], solving(model)
    for device in (Device(position=node, dashpot=3.0), Device(position=0.03, mass=1e-13)):
        with pytest.raises(DevicesResonanceError, match=r"undamped resonance of the beam with devices at \[0\.0"):
            field_with_devices(solve, STRIP, force, hertz * (1.0 + 2e-10), [device])
        beside = field_with_devices(solve, STRIP, force, hertz * (1.0 + 2e-9), [device])
        assert abs(beside.deflection(JOINTS)).max() > 1.0
    with pytest.raises(HeldResonanceError, match=r"held at its actuators \[0\.0685"):
        driven_field(lambda acting, f: solve(STRIP, acting, f), [PointForce(position=node)], hertz, "displacement")
    for nothing in ([PointForce(position=STRIP.length)], [PointForce(position=0.1), PointForce(position=0.1)]):
        with pytest.raises(InputError, match="cannot be imposed at a held end or twice"):
            driven_field(lambda acting, f: solve(STRIP, acting, f), nothing, hertz, "displacement")
    with pytest.raises(ResonanceError, match=f"mode 7 of the {model} model"):
        field_with_devices(solve, STRIP, [], hertz, [Device(position=0.03, amplitude=1.0)])
