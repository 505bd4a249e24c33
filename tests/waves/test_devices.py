"""Devices on a driven beam: fields against transfer matrices, and impedances that absorb a wave."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests.reference import transfer
from verify import Beam, PointForce, PointMass
from verify.analytic_modes import ExactModel
from verify.errors import InputError, ResonanceError
from verify.exact.closed_forms import frequency_hz
from verify.fem_beam import HermiteModel
from verify.linear.field import phasor
from verify.problem.device import Device, of_impedance
from verify.segment_model import SegmentModel
from verify.travelling_wave import DrivenCase, matched_device, measure
from verify.waves.impedance_matching import ending, reflection

# --- Devices ---

SIZES = {"length": 0.83, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 193e9, "density": 7900.0}
STRIP = Beam(**SIZES)
"""Of steel, no size of the paper's."""
CANTILEVER = Beam(**SIZES, supports=("clamped", "free"))
ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
X = np.array([0.013, 0.11, 0.294, 0.449, 0.603, 0.757, 0.809])
FORCES = (PointForce(position=0.11, amplitude=1.3, phase_deg=17.0), PointForce(position=0.52, amplitude=0.7))
MODELS = {"exact": ExactModel, "segments": lambda b: SegmentModel(b, 31), "elements": lambda b: HermiteModel(b, 17)}


class WithDevices:
    """A beam for the transfer matrices with a complex spring for each device."""

    def __init__(self, beam, devices, hertz):
        omega = 2.0 * np.pi * hertz
        self._beam = beam
        self.spring = tuple(
            SimpleNamespace(
                position=d.position,
                stiffness=d.dynamic_stiffness(omega),
                rotational=d.rotational_dynamic_stiffness(omega),
            )
            for d in devices
        )

    def __getattr__(self, name):
        return getattr(self._beam, name)


def by_transfer(beam, forces, hertz, devices, x, digits=40):
    acting = (*forces, *(d.own_force for d in devices if d.amplitude))
    return transfer.deflection(WithDevices(beam, devices, hertz), "euler-bernoulli", hertz, acting, x, digits)


ONE = (Device(position=0.71, dashpot=3.1, stiffness=5200.0),)
SEVERAL = (
    Device(position=0.23, mass=0.011, rotational_dashpot=0.0031, rotational=0.9, rotary_inertia=2e-7),
    Device(position=0.71, dashpot=3.1, stiffness=5200.0, amplitude=0.6, phase_deg=-41.0),
)
PINNED_END = (Device(position=0.83, rotational_dashpot=0.0021, rotary_inertia=3e-7),)
FREE_END = (Device(position=0.83, dashpot=2.7, mass=0.0004, rotational_dashpot=0.0013),)
CASES = [
    pytest.param(STRIP, ONE, id="dashpot and spring"),
    pytest.param(STRIP, SEVERAL, id="everything at two places"),
    pytest.param(STRIP, PINNED_END, id="rotation at a pinned end"),
    pytest.param(CANTILEVER, FREE_END, id="both at a free end"),
]


def off(found, wanted):
    return float(abs(found - wanted).max() / abs(wanted).max())


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("hertz", [61.0, 2390.0])
def test_the_exact_field_with_devices_is_that_of_transfer_matrices(beam, devices, hertz):
    found = ExactModel(beam).harmonic(FORCES, hertz, devices=devices).deflection(X)
    assert off(found, by_transfer(beam, FORCES, hertz, devices, X)) < 2e-9


@pytest.mark.parametrize("part", [0.0, 1e-12, -2e-10, 3e-9, 1e-5])
@pytest.mark.parametrize("dashpot", [1e-4, 0.01, 100.0])
def test_a_dashpot_alone_damps_the_exact_beam_where_it_resonates_without_one(part, dashpot):
    hertz, devices = frequency_hz(STRIP, 7) * (1.0 + part), (Device(position=0.19, dashpot=dashpot),)
    found = ExactModel(STRIP).harmonic(FORCES, hertz, devices=devices).deflection(X)
    assert off(found, by_transfer(STRIP, FORCES, hertz, devices, X)) < 1e-6


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
def test_segments_and_elements_with_devices_converge_to_it(model, beam, devices):
    """With order 4; segments with 3 on a clamped beam, where it is 3 under forces alone."""
    wanted = by_transfer(beam, FORCES, 733.0, devices, X)
    fields = [model(beam, n).harmonic(FORCES, 733.0, devices=devices) for n in (83, 166)]
    errors = [off(field.deflection(X), wanted) for field in fields]
    low, high = (2.8, 4.6) if model is SegmentModel and beam is CANTILEVER else (3.4, 4.6)
    assert low < np.log2(errors[0] / errors[1]) < high
    assert errors[1] < (1e-3 if model is SegmentModel else 1e-4)


@pytest.mark.parametrize("model", MODELS)
def test_a_force_as_large_as_its_reaction_replaces_a_device(model):
    solve, device = MODELS[model](STRIP).harmonic, matched_device(STRIP, 739.0, 0.81)
    passive = solve(FORCES[:1], 739.0, devices=device)
    reaction = passive.forces[-1]
    active = Device(position=0.81, amplitude=reaction.amplitude, phase_deg=reaction.phase_deg)
    assert off(solve(FORCES[:1], 739.0, devices=active).deflection(X), passive.deflection(X)) < 1e-10


def powers(field, forces):
    """1/2 Re(F conj(v)) of each force, W."""
    speeds = 1j * field.omega * field.deflection([force.position for force in forces])
    return [float(0.5 * (phasor(f) * np.conj(v)).real) for f, v in zip(forces, speeds, strict=True)]


@pytest.mark.parametrize("model", ["exact", "elements"])
def test_the_dashpot_loses_what_the_forces_give(model):
    device = Device(position=0.71, dashpot=3.1, stiffness=5200.0, mass=0.002)
    field = MODELS[model](STRIP).harmonic(FORCES, 739.0, devices=device)
    lost = 0.5 * 3.1 * abs(field.omega * field.deflection(0.71)[0]) ** 2
    assert sum(powers(field, FORCES)) == pytest.approx(lost, rel=1e-9)
    assert powers(field, field.forces[2:])[0] == pytest.approx(-lost, rel=1e-9)


@pytest.mark.parametrize("model", ["exact", "elements"])
def test_a_resonance_with_a_device_that_loses_nothing_is_refused(model):
    built = MODELS[model](STRIP)
    own = built.harmonic(PointForce(position=0.3), 311.0).deflection(0.3)[0].real
    reactive = {"stiffness": -1.0 / own} if own < 0 else {"mass": 1.0 / (own * (2.0 * np.pi * 311.0) ** 2)}
    with pytest.raises(ResonanceError, match=r"frequency_hz = 311\.0"):
        built.harmonic(FORCES, 311.0, devices=Device(position=0.3, **reactive))


@pytest.mark.parametrize(
    ("beam", "device", "said"),
    [
        (
            STRIP,
            Device(position=0.0, mass=0.1),
            r"position = 0\.0 m stands on a pinned .*moves across and device\.mass",
        ),
        (
            STRIP,
            Device(position=0.83, amplitude=1.0),
            r"pinned support, .*device\.amplitude = 1\.0 does nothing: move it",
        ),
        (
            CANTILEVER,
            Device(position=0.0, rotational=2.0),
            r"clamped support, where nothing turns and device\.rotational",
        ),
        (STRIP, Device(position=0.9, dashpot=1.0), r"position = 0\.9 lies off the beam: give a position between 0 and"),
    ],
)
def test_a_device_on_a_support_or_off_the_beam_is_refused(beam, device, said):
    with pytest.raises(InputError, match=said):
        ExactModel(beam).harmonic(FORCES, 700.0, devices=device)


def test_what_is_no_device_drives_nothing_or_gives_energy_is_refused():
    for name in ("stiffness", "mass", "dashpot", "rotational", "rotary_inertia", "rotational_dashpot"):
        with pytest.raises(InputError, match=rf"device\.{name} = -0\.1: give a finite number of at least 0"):
            Device(position=0.2, **{name: -0.1})
    with pytest.raises(InputError, match=r"position = 0\.2 does nothing: give it one of stiffness, mass"):
        Device(position=0.2)
    with pytest.raises(InputError, match="forces is empty and no device has an amplitude"):
        ExactModel(STRIP).harmonic([], 700.0, devices=ONE)
    with pytest.raises(InputError, match="gives energy"):
        of_impedance(0.3, -1.0 + 2.0j, 700.0)
    with pytest.raises(InputError, match=r"drive\.kind = 'displacement': .* leave drive\.device\.amplitude out"):
        DrivenCase(model=ExactModel(STRIP), forces=FORCES, frequency_hz=9.0, kind="displacement", devices=SEVERAL)


# --- Absorber ---

SIZES_ABSORBER = {"length": 0.9, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}
STRIP_ABSORBER = Beam(**SIZES_ABSORBER)


def solved(beam, hertz, d, impedance, support="pinned", turning=False):
    """|Gamma| from the waves on both sides: (reflected, near field) left, four waves between device and end.

    x = 0 at the device, the end at x = d; e^{+i omega t}, a wave from the left of size one.
    """
    omega = 2.0 * np.pi * hertz
    ei, z = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor), 1j * omega * impedance
    k = (beam.mass_per_length * omega**2 / ei) ** 0.25
    a = np.zeros((6, 6), dtype=complex)  # r, n | A e^{-ikx}, B e^{ikx}, C e^{-kx}, D e^{k(x - d)}
    q = np.array([1j * k, k, -1j * k, 1j * k, -k, k])
    size = np.array([1, 1, 1, 1, 1, np.exp(-k * d)])
    gain, jumps, reads = (z, 2, 1) if turning else (-z, 3, 0)
    right = np.zeros(6, dtype=complex)
    for row in range(4):
        a[row] = q**row * size * np.array([-1, -1, 1, 1, 1, 1])
        right[row] = (-1j * k) ** row
    a[jumps, :2] -= gain / ei * q[:2] ** reads
    right[jumps] += gain / ei * (-1j * k) ** reads
    for row, order in enumerate(ENDS[support], start=4):
        a[row, 2:] = q[2:] ** order * size[2:] * np.exp(q[2:] * d)
    scale = abs(a).max(axis=1)
    return abs(np.linalg.solve(a / scale[:, None], right / scale)[0])


@given(
    hertz=st.floats(300.0, 20_000.0),
    d=st.floats(1e-3, 0.2),
    resistance=st.floats(0.1, 300.0),
    reactance=st.floats(-200.0, 200.0),
    support=st.sampled_from(list(ENDS)),
    turning=st.booleans(),
    loss=st.sampled_from([0.0, 0.02, 0.3]),
)
def test_a_device_reflects_what_waves_say(hertz, d, resistance, reactance, support, turning, loss):
    """Against turning impedances of that size: EI k / omega beside EI k^3 / omega. With a loss factor k is complex."""
    beam, omega = replace(STRIP_ABSORBER, loss_factor=loss), 2.0 * np.pi * hertz
    k = (STRIP_ABSORBER.mass_per_length * omega**2 / STRIP_ABSORBER.bending_stiffness) ** 0.25
    impedance = complex(resistance, reactance) / (k**2 if turning else 1.0)
    found = reflection(impedance, ending(beam, hertz, d, support, turning=turning))
    assert found == pytest.approx(solved(beam, hertz, d, impedance, support, turning), abs=3e-7)


def test_ends_that_are_known_by_heart():
    """Free: a dashpot EI k^3/(2 omega) with a spring EI k^3/2. Pinned, turning: EI k/omega with EI k/omega^2."""
    hertz = 1873.0
    omega = 2.0 * np.pi * hertz
    k = (STRIP_ABSORBER.mass_per_length * omega**2 / STRIP_ABSORBER.bending_stiffness) ** 0.25
    ei = STRIP_ABSORBER.bending_stiffness
    free = Beam(**SIZES_ABSORBER, supports=("pinned", "free"))
    across, turning = matched_device(free, hertz, 0.9), matched_device(STRIP_ABSORBER, hertz, 0.9, turning=True)
    assert across.dashpot == pytest.approx(ei * k**3 / (2 * omega), rel=1e-12)
    assert (across.stiffness, across.mass) == (pytest.approx(ei * k**3 / 2, rel=1e-12), 0.0)
    assert turning.rotational_dashpot == pytest.approx(ei * k / omega, rel=1e-12)
    assert (turning.rotary_inertia, turning.rotational) == (pytest.approx(ei * k / omega**2, rel=1e-12), 0.0)
    for end in (ending(free, hertz, 0.0, "free"), ending(STRIP_ABSORBER, hertz, 0.0, turning=True)):
        assert reflection(complex(abs(end.own)), end) == pytest.approx(np.sqrt(2) - 1, rel=1e-12)


@pytest.mark.parametrize(("ratio", "loss"), [(1.0, 0.1), (1.3, 0.02), (1.3, 0.1)])
@pytest.mark.parametrize("turning", [False, True])
def test_with_losses_the_exact_beam_has_the_reflection_at_the_device(ratio, loss, turning):
    """What two waves fitted in the middle carry to the device, each by its complex wavenumber."""
    beam, hertz, d = Beam(**SIZES_ABSORBER, loss_factor=loss), 7000.0, 0.0171
    end = ending(beam, hertz, d, turning=turning)
    given = complex(ratio * end.own.real, -end.own.imag)
    device = of_impedance(0.9 - d, given, 2.0 * np.pi * hertz, turning=turning)
    field = ExactModel(beam).harmonic(PointForce(position=0.03), hertz, devices=device)
    waves = measure(field, (0.3, 0.7), field.wavenumber).waves
    there = waves.reflection * abs(np.exp(2j * waves.wavenumber * (0.9 - d - 0.5)))
    assert there == pytest.approx(reflection(given, end), rel=1e-4)


FREE = Beam(**SIZES_ABSORBER, supports=("pinned", "free"))
FINE = {
    "exact": (ExactModel, 1e-7),
    "segments": (lambda b: SegmentModel(b, 480), 5e-4),
    "elements": (lambda b: HermiteModel(b, 480), 2e-5),
}


@pytest.mark.parametrize("model", FINE)
@pytest.mark.parametrize(
    ("beam", "d", "turning"),
    [(STRIP_ABSORBER, 0.0171, False), (STRIP_ABSORBER, 0.0, True), (FREE, 0.0, False), (FREE, 0.033, True)],
)
def test_a_matched_device_takes_up_the_wave_of_every_model(model, beam, d, turning):
    (build, error), hertz = FINE[model], 7_000.0
    device = matched_device(beam, hertz, beam.length - d, turning=turning)
    field = build(beam).harmonic(PointForce(position=0.03), hertz, devices=device)
    measured = measure(field, (0.25 * beam.length, 0.75 * beam.length))
    assert measured.reflection < error
    assert measured.waves.direction == 1
    assert len(field.forces) == 2 - turning


@pytest.mark.parametrize(("place", "d"), [(0.0171, 0.0171), (0.9 - 0.0171, 0.0171)])
def test_the_matched_device_knows_which_end_is_beyond_it(place, d):
    device, omega = matched_device(STRIP_ABSORBER, 3000.0, place), 2 * np.pi * 3000.0
    assert device.impedance(omega) == pytest.approx(ending(STRIP_ABSORBER, 3000.0, d).matched, rel=1e-9)


def test_a_device_on_a_support_is_refused_and_so_is_a_beam_that_is_not_uniform():
    with pytest.raises(InputError, match=r"^position = 0\.9 m stands on a pinned support, .*: move it$"):
        matched_device(STRIP_ABSORBER, 3000.0, 0.9)
    stepped = Beam(length=0.9, bending_stiffness=3.0, mass_per_length=0.3, mass=[PointMass(position=0.2, mass=0.1)])
    with pytest.raises(InputError, match=r"beam\.mass"):
        ending(stepped, 3000.0, 0.02)
    with pytest.raises(InputError, match=r"position = 0\.0 m stands on a clamped support"):
        ending(STRIP_ABSORBER, 3000.0, 0.0, "clamped", turning=True)
