"""Devices on a driven beam: fields against transfer matrices, power, and impedances that absorb a wave."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tests import beams
from tests.reference import transfer
from verify import Device, ExactModel, HermiteModel, PointForce, PointMass, SegmentModel
from verify.errors import InputError
from verify.problem.device import of_impedance
from verify.travelling_wave import DrivenCase, matched_device, measure
from verify.waves.impedance_matching import ending

L = 0.83
STRIP = replace(beams.STRIP, length=L)
CANTILEVER, PINNED_FREE = (replace(STRIP, supports=pair) for pair in (("clamped", "free"), ("pinned", "free")))
X = np.array([0.11, 0.449, 0.809])
FORCES = (PointForce(position=0.11, amplitude=1.3, phase_deg=17.0), PointForce(position=0.52, amplitude=0.7))
MODELS = {"exact": ExactModel, "segments": lambda b: SegmentModel(b, 31), "elements": lambda b: HermiteModel(b, 17)}

# --- Fields ----------------------------------------------------------------------------------------------------------


class WithDevices:
    """A beam for the transfer matrices with a complex spring for each device."""

    def __init__(self, beam, devices, omega):
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


SPRING_AND_DASHPOT = (Device(position=0.71, dashpot=3.1, stiffness=5200.0),)
SEVERAL = (
    Device(position=0.23, mass=0.011, rotational_dashpot=0.0031, rotational=0.9, rotary_inertia=2e-7),
    Device(position=0.71, dashpot=3.1, stiffness=5200.0, amplitude=0.6, phase_deg=-41.0),
)
CASES = [
    pytest.param(STRIP, SPRING_AND_DASHPOT, id="dashpot and spring"),
    pytest.param(STRIP, SEVERAL, id="all parameters at two positions"),
    pytest.param(STRIP, (Device(position=L, rotational_dashpot=0.0021, rotary_inertia=3e-7),), id="at a pinned end"),
    pytest.param(
        CANTILEVER, (Device(position=L, dashpot=2.7, mass=0.0004, rotational_dashpot=0.0013),), id="at a free end"
    ),
]


def off(found, exact):
    return float(abs(found - exact).max() / abs(exact).max())


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("hertz", [61.0, 2390.0])
def test_the_exact_field_with_devices_is_that_of_transfer_matrices(beam, devices, hertz):
    found = ExactModel(beam).harmonic(FORCES, hertz, devices=devices).deflection(X)
    acting = (*FORCES, *(d.own_force for d in devices if d.amplitude))
    laden = WithDevices(beam, devices, 2.0 * np.pi * hertz)
    assert off(found, transfer.deflection(laden, "euler-bernoulli", hertz, acting, X, 40)) < 2e-9


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("model", [SegmentModel, HermiteModel])
def test_segments_and_elements_with_devices_are_of_order_four(model, beam, devices):
    x = np.linspace(0.05, 0.8, 16)
    exact = ExactModel(beam).harmonic(FORCES, 733.0, devices=devices).deflection(x)
    fields = [model(beam, n).harmonic(FORCES, 733.0, devices=devices) for n in (83, 166)]
    errors = [off(field.deflection(x), exact) for field in fields]
    assert 3.4 < np.log2(errors[0] / errors[1]) < 4.6
    assert 1e-8 < errors[1] < (1e-3 if model is SegmentModel else 1e-4)


@pytest.mark.parametrize(
    ("beam", "device", "message"),
    [
        (STRIP, Device(position=0.0, mass=0.1), r"= 0\.0 m is on a pinned .*moves across and device\.mass"),
        (
            STRIP,
            Device(position=L, amplitude=1.0),
            r"pinned support, .*device\.amplitude = 1\.0 has no effect: move it",
        ),
        (CANTILEVER, Device(position=0.0, rotational=2.0), r"clamped support, where nothing turns and device\.rotat"),
        (STRIP, Device(position=0.9, dashpot=1.0), r"= 0\.9 lies off the beam: give a position between 0 and"),
    ],
)
def test_a_device_on_a_support_or_off_the_beam_is_an_input_error(beam, device, message):
    with pytest.raises(InputError, match=message):
        ExactModel(beam).harmonic(FORCES, 700.0, devices=device)


def test_a_device_without_parameters_or_with_negative_ones_is_an_input_error():
    for name in ("stiffness", "mass", "dashpot", "rotational", "rotary_inertia", "rotational_dashpot"):
        with pytest.raises(InputError, match=rf"device\.{name} = -0\.1: give a finite number of at least 0"):
            Device(position=0.2, **{name: -0.1})
    with pytest.raises(InputError, match=r"position = 0\.2 has no effect: give one of stiffness, mass"):
        Device(position=0.2)
    with pytest.raises(InputError, match="no forces or displacements and no device with an amplitude"):
        ExactModel(STRIP).harmonic([], 700.0, devices=SPRING_AND_DASHPOT)
    with pytest.raises(InputError, match=r"impedance = .* is active"):
        of_impedance(0.3, -1.0 + 2.0j, 700.0)
    with pytest.raises(InputError, match=r"drive\.kind = 'displacement': .* leave its amplitude out"):
        DrivenCase(model=ExactModel(STRIP), forces=FORCES, frequency_hz=9.0, kind="displacement", devices=SEVERAL)


# --- Absorption ------------------------------------------------------------------------------------------------------

ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


def wave_reflection(beam, hertz, d, impedance, support, turning):
    """|Gamma| of a unit wave from the left: two waves left of the device at x = 0, four between it and the end x = d."""
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
def test_the_reflection_of_a_device_is_that_of_six_waves(hertz, d, resistance, reactance, support, turning, loss):
    """Rotational impedances of the size EI k / omega, lateral ones of EI k^3 / omega. With loss k is complex."""
    k = (STRIP.mass_per_length * (2.0 * np.pi * hertz) ** 2 / STRIP.bending_stiffness) ** 0.25
    beam, impedance = replace(STRIP, loss_factor=loss), complex(resistance, reactance) / (k**2 if turning else 1.0)
    found = ending(beam, hertz, d, support, turning=turning).reflection(impedance)
    assert found == pytest.approx(wave_reflection(beam, hertz, d, impedance, support, turning), abs=3e-7)


@pytest.mark.parametrize(("ratio", "loss"), [(1.0, 0.1), (1.3, 0.02), (1.3, 0.1)])
@pytest.mark.parametrize("turning", [False, True])
def test_the_exact_beam_with_loss_has_the_reflection_of_its_device(ratio, loss, turning):
    """Two waves fitted in the middle, continued to the device by their complex wavenumber."""
    beam, hertz, d = replace(STRIP, loss_factor=loss), 7000.0, 0.0171
    end = ending(beam, hertz, d, turning=turning)
    impedance = complex(ratio * end.own.real, -end.own.imag)
    device = of_impedance(L - d, impedance, 2.0 * np.pi * hertz, turning=turning)
    field = ExactModel(beam).harmonic(PointForce(position=0.03), hertz, devices=device)
    waves = measure(field, (0.3, 0.6), field.wavenumber).waves
    at_device = waves.reflection * abs(np.exp(2j * waves.wavenumber * (L - d - 0.45)))
    assert at_device == pytest.approx(end.reflection(impedance), rel=1e-4)


FINE = {
    "exact": (ExactModel, 1e-7),
    "segments": (lambda b: SegmentModel(b, 480), 5e-4),
    "elements": (lambda b: HermiteModel(b, 480), 2e-5),
}


@pytest.mark.parametrize("model", FINE)
@pytest.mark.parametrize(
    ("beam", "d", "turning"),
    [(STRIP, 0.0171, False), (STRIP, 0.0, True), (PINNED_FREE, 0.0, False), (PINNED_FREE, 0.033, True)],
)
def test_a_matched_device_absorbs_the_wave_of_all_models(model, beam, d, turning):
    (build, error), hertz = FINE[model], 7_000.0
    device = matched_device(beam, hertz, L - d, turning=turning)
    field = build(beam).harmonic(PointForce(position=0.03), hertz, devices=device)
    measured = measure(field, (0.25 * L, 0.75 * L))
    assert measured.reflection < error
    assert measured.waves.direction == 1
    assert len(field.forces) == 2 - turning


@pytest.mark.parametrize("position", [0.0171, L - 0.0171])
def test_a_device_is_matched_to_the_nearer_end(position):
    device = matched_device(STRIP, 3000.0, position)
    assert device.impedance(2 * np.pi * 3000.0) == pytest.approx(ending(STRIP, 3000.0, 0.0171).matched, rel=1e-9)


def test_a_device_on_a_support_or_on_a_beam_with_attachments_has_no_matched_impedance():
    with pytest.raises(InputError, match=r"^position = 0\.83 m is on a pinned support, .*: move it$"):
        matched_device(STRIP, 3000.0, L)
    with pytest.raises(InputError, match=r"beam\.mass"):
        matched_device(replace(STRIP, mass=(PointMass(position=0.2, mass=0.1),)), 3000.0, 0.81)
    with pytest.raises(InputError, match=r"position = 0\.0 m is on a clamped support"):
        ending(STRIP, 3000.0, 0.0, "clamped", turning=True)
