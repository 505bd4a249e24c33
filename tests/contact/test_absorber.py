"""A device that takes up the wave: waves solved directly, and whole beams of all three models, beside the closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify import Beam, PointForce, PointMass, analytic_modes, fem_beam, segment_model, travelling_wave
from verify.errors import InputError
from verify.waves.absorber import beam_impedance, field_with_device, matched_impedance, reflection

STRIP = Beam(length=0.9, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)


def solved(beam, hertz, d, impedance):
    """|Gamma| from the waves on both sides: (reflected, near field) left, four waves between device and pin.

    x = 0 at the device, the pin at x = d; e^{+i omega t}, a wave from the left of size one.
    """
    omega = 2.0 * np.pi * hertz
    k = (beam.mass_per_length * omega**2 / beam.bending_stiffness) ** 0.25
    ei, z = beam.bending_stiffness, 1j * omega * impedance
    a = np.zeros((6, 6), dtype=complex)  # r, n | A e^{-ikx}, B e^{ikx}, C e^{-kx}, D e^{kx}
    q = np.array([1j * k, k, -1j * k, 1j * k, -k, k])
    for row, power in enumerate((0, 1, 2)):
        a[row] = q**power * np.array([1, 1, -1, -1, -1, -1])
    a[3] = ei * q**3 * np.array([-1, -1, 1, 1, 1, 1])
    a[3, :2] += z
    a[4, 2:], a[5, 2:] = np.exp(q[2:] * d), q[2:] ** 2 * np.exp(q[2:] * d)
    rows = [-((-1j * k) ** power) for power in (0, 1, 2)]
    return abs(np.linalg.solve(a, np.array([*rows, ei * (-1j * k) ** 3 - z, 0, 0]))[0])


@given(
    hertz=st.floats(300.0, 20_000.0),
    d=st.floats(1e-3, 0.2),
    resistance=st.floats(0.1, 300.0),
    reactance=st.floats(-200.0, 200.0),
)
def test_a_device_reflects_what_waves_say(hertz, d, resistance, reactance):
    impedance = complex(resistance, reactance)
    found = reflection(impedance, beam_impedance(STRIP, hertz, d))
    assert found == pytest.approx(solved(STRIP, hertz, d, impedance), abs=1e-7)


def test_the_closed_form_as_it_is_published():
    """Y_b = (omega/(EI k^3)) [sin^2(kd)/2 - (i/4)(1 - e^{-2kd} - sin 2kd)] (REFERENCE, section 2)."""
    hertz, d = 4276.0, 0.0371
    omega = 2.0 * np.pi * hertz
    k = (STRIP.mass_per_length * omega**2 / STRIP.bending_stiffness) ** 0.25
    mobility = omega / (STRIP.bending_stiffness * k**3)
    mobility *= 0.5 * np.sin(k * d) ** 2 - 0.25j * (1.0 - np.exp(-2 * k * d) - np.sin(2 * k * d))
    assert beam_impedance(STRIP, hertz, d) == pytest.approx(1.0 / mobility, rel=1e-12)


@pytest.mark.parametrize(
    ("solve", "error"),
    [
        (lambda f, hz: analytic_modes.solve_harmonic(STRIP, f, hz), 1e-7),
        (lambda f, hz: segment_model.solve_harmonic(STRIP, f, hz, n_segments=480), 2e-4),
        (lambda f, hz: fem_beam.solve_harmonic(STRIP, f, hz, n_elements=480), 2e-5),
    ],
    ids=["exact", "segments", "elements"],
)
def test_a_matched_device_takes_up_the_wave_of_every_model(solve, error):
    hertz, d = 9_000.0, 0.0171
    field = field_with_device(
        solve, [PointForce(position=0.03)], hertz, STRIP.length - d, matched_impedance(STRIP, hertz, d)
    )
    measured = travelling_wave.measure(field, window=(0.25 * STRIP.length, 0.75 * STRIP.length))
    assert measured.reflection < error
    assert measured.waves.direction == 1
    assert len(field.forces) == 2


def test_a_resistance_off_by_a_factor_reflects_by_that_factor_alone():
    own = beam_impedance(STRIP, 3000.0, 0.02)
    for s in (0.2, 0.9, 3.7):
        device = complex(s * own.real, -own.imag)
        assert reflection(device, own) == pytest.approx(abs(s - 1) / (s + 1), rel=1e-12)


def test_a_device_on_a_support_is_refused_and_so_is_a_beam_that_is_not_uniform():
    with pytest.raises(InputError, match=r"position = 0\.0"):
        matched_impedance(STRIP, 3000.0, 0.0)
    stepped = Beam(length=0.9, bending_stiffness=3.0, mass_per_length=0.3, mass=[PointMass(position=0.2, mass=0.1)])
    with pytest.raises(InputError, match=r"beam\.mass"):
        matched_impedance(stepped, 3000.0, 0.02)
    with pytest.raises(InputError, match="stands on a support"):
        field_with_device(
            lambda f, hz: analytic_modes.solve_harmonic(STRIP, f, hz), [PointForce(position=0.03)], 3000.0, 0.9, 3 + 0j
        )
