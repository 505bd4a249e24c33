"""A device that takes up the wave: waves solved directly, and whole beams of all three models, beside the closed form."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, PointForce, PointMass, analytic_modes, fem_beam, segment_model, travelling_wave
from verify.device import of_impedance
from verify.errors import InputError
from verify.waves.absorber import beam_impedance, best_dashpot, ending, matched_device, matched_impedance, reflection
from verify.waves.devices import field_with_devices

SIZES = {"length": 0.9, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}
STRIP = Beam(**SIZES)


ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


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
    beam, omega = replace(STRIP, loss_factor=loss), 2.0 * np.pi * hertz
    k = (STRIP.mass_per_length * omega**2 / STRIP.bending_stiffness) ** 0.25
    impedance = complex(resistance, reactance) / (k**2 if turning else 1.0)
    found = reflection(impedance, ending(beam, hertz, d, support, turning=turning))
    assert found == pytest.approx(solved(beam, hertz, d, impedance, support, turning), abs=3e-7)


def test_ends_that_are_known_by_heart():
    """Free: a dashpot EI k^3/(2 omega) with a spring EI k^3/2. Pinned, turning: EI k/omega with EI k/omega^2."""
    hertz = 1873.0
    omega = 2.0 * np.pi * hertz
    k = (STRIP.mass_per_length * omega**2 / STRIP.bending_stiffness) ** 0.25
    ei = STRIP.bending_stiffness
    free = Beam(**SIZES, supports=("pinned", "free"))
    across, turning = matched_device(free, hertz, 0.9), matched_device(STRIP, hertz, 0.9, turning=True)
    assert across.dashpot == pytest.approx(ei * k**3 / (2 * omega), rel=1e-12)
    assert (across.stiffness, across.mass) == (pytest.approx(ei * k**3 / 2, rel=1e-12), 0.0)
    assert turning.rotational_dashpot == pytest.approx(ei * k / omega, rel=1e-12)
    assert (turning.rotary_inertia, turning.rotational) == (pytest.approx(ei * k / omega**2, rel=1e-12), 0.0)
    for end in (ending(free, hertz, 0.0, "free"), ending(STRIP, hertz, 0.0, turning=True)):
        assert best_dashpot(end)[1] == pytest.approx(np.sqrt(2) - 1, rel=1e-12)


@given(
    hertz=st.floats(300.0, 9000.0),
    d=st.floats(2e-3, 0.1),
    s=st.floats(0.2, 5.0),
    loss=st.sampled_from([0.0, 0.03, 0.4]),
)
@example(hertz=5877.19, d=0.0344, s=4.27, loss=0.4)  # a little one helps, though the least that it leaves lies far out
@example(hertz=3218.24, d=0.04524, s=4.27, loss=0.4)  # the place held, as by an endless one, is best
@example(hertz=8047.15, d=0.02574, s=1.3, loss=0.03)
def test_no_dashpot_alone_leaves_less_than_the_best(hertz, d, s, loss):
    end = ending(replace(STRIP, loss_factor=loss), hertz, d)
    resistance, left = best_dashpot(end)
    told = min(resistance, 1e12)
    assert reflection(told + 0j, end) == pytest.approx(left, rel=1e-8)
    assert all(
        reflection(one + 0j, end) >= left * (1 - 1e-9) for one in (s * told, s, *np.geomspace(1e-3, 1e9, 40), 0.0)
    )
    if not loss:
        assert (resistance, left) == pytest.approx((abs(end.own), np.tan(0.5 * abs(np.angle(end.own)))), rel=1e-9)


def test_the_closed_form_as_it_is_published():
    """Y_b = (omega/(EI k^3)) [sin^2(kd)/2 - (i/4)(1 - e^{-2kd} - sin 2kd)] (REFERENCE, section 2)."""
    hertz, d = 4276.0, 0.0371
    omega = 2.0 * np.pi * hertz
    k = (STRIP.mass_per_length * omega**2 / STRIP.bending_stiffness) ** 0.25
    mobility = omega / (STRIP.bending_stiffness * k**3)
    mobility *= 0.5 * np.sin(k * d) ** 2 - 0.25j * (1.0 - np.exp(-2 * k * d) - np.sin(2 * k * d))
    assert beam_impedance(STRIP, hertz, d) == pytest.approx(1.0 / mobility, rel=1e-12)


@pytest.mark.parametrize(
    ("support", "d", "turning"), [("pinned", 0.0171, False), ("free", 0.0, False), ("pinned", 0.0, True)]
)
@pytest.mark.parametrize("loss", [0.02, 0.1])
def test_with_losses_a_device_takes_up_the_wave_and_the_conjugate_does_not(support, d, turning, loss):
    """conj(Z_b) takes the most power and left 0.35 of the loss factor at a free end; nothing was told of it."""
    beam = Beam(**SIZES, loss_factor=loss, supports=("clamped", support))
    end = ending(beam, 3000.0, d, support, turning=turning)
    own = beam_impedance(beam, 3000.0, d, support, turning=turning)
    assert solved(beam, 3000.0, d, end.matched, support, turning) < 1e-7
    left = solved(beam, 3000.0, d, own.conjugate(), support, turning)
    assert left > 0.1 * loss
    assert reflection(own.conjugate(), end) == pytest.approx(left, rel=1e-6)
    if support == "free":
        assert left == pytest.approx(0.354 * loss, rel=0.03)
        assert end.matched == pytest.approx(1j * own * -1.0, rel=1e-12)


@pytest.mark.parametrize(("ratio", "loss"), [(1.0, 0.1), (1.3, 0.02), (1.3, 0.1)])
@pytest.mark.parametrize("turning", [False, True])
def test_with_losses_the_exact_beam_has_the_reflection_at_the_device(ratio, loss, turning):
    """What two waves fitted in the middle carry to the device, each by its complex wavenumber."""
    beam, hertz, d = Beam(**SIZES, loss_factor=loss), 7000.0, 0.0171
    end = ending(beam, hertz, d, turning=turning)
    given = complex(ratio * end.own.real, -end.own.imag)
    device = of_impedance(0.9 - d, given, 2.0 * np.pi * hertz, turning=turning)
    field = field_with_devices(analytic_modes.solve_harmonic, beam, [PointForce(position=0.03)], hertz, [device])
    waves = travelling_wave.measure(field, (0.3, 0.7), field.wavenumber).waves
    there = waves.reflection * abs(np.exp(2j * waves.wavenumber * (0.9 - d - 0.5)))
    assert there == pytest.approx(reflection(given, end), rel=1e-4)


FREE = Beam(**SIZES, supports=("pinned", "free"))
MODELS = {
    "exact": (analytic_modes.solve_harmonic, 1e-7),
    "segments": (lambda b, f, hz: segment_model.solve_harmonic(b, f, hz, n_segments=480), 3e-4),
    "elements": (lambda b, f, hz: fem_beam.solve_harmonic(b, f, hz, n_elements=480), 2e-5),
}


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("beam", "d", "turning"), [(STRIP, 0.0171, False), (STRIP, 0.0, True), (FREE, 0.0, False), (FREE, 0.033, True)]
)
def test_a_matched_device_takes_up_the_wave_of_every_model(model, beam, d, turning):
    (solve, error), hertz = MODELS[model], 7_000.0
    device = matched_device(beam, hertz, beam.length - d, turning=turning)
    field = field_with_devices(solve, beam, [PointForce(position=0.03)], hertz, [device])
    measured = travelling_wave.measure(field, window=(0.25 * beam.length, 0.75 * beam.length))
    assert measured.reflection < error
    assert measured.waves.direction == 1
    assert len(field.forces) == 2 - turning


@pytest.mark.parametrize(("place", "d"), [(0.0171, 0.0171), (0.9 - 0.0171, 0.0171)])
def test_the_matched_device_knows_which_end_is_beyond_it(place, d):
    device, omega = matched_device(STRIP, 3000.0, place), 2 * np.pi * 3000.0
    assert device.impedance(omega) == pytest.approx(matched_impedance(STRIP, 3000.0, d), rel=1e-9)


def test_a_resistance_off_by_a_factor_reflects_by_that_factor_alone():
    end = ending(STRIP, 3000.0, 0.02)
    for s in (0.2, 0.9, 3.7):
        device = complex(s * end.own.real, -end.own.imag)
        assert reflection(device, end) == pytest.approx(abs(s - 1) / (s + 1), rel=1e-12)


def test_a_device_on_a_support_is_refused_and_so_is_a_beam_that_is_not_uniform():
    with pytest.raises(InputError, match=r"position = 0\.0"):
        matched_impedance(STRIP, 3000.0, 0.0)
    stepped = Beam(length=0.9, bending_stiffness=3.0, mass_per_length=0.3, mass=[PointMass(position=0.2, mass=0.1)])
    with pytest.raises(InputError, match=r"beam\.mass"):
        matched_impedance(stepped, 3000.0, 0.02)
    with pytest.raises(InputError, match=r"position = 0\.0 m stands on a clamped support"):
        beam_impedance(STRIP, 3000.0, 0.0, "clamped", turning=True)


@pytest.mark.parametrize(
    ("supports", "turning", "place"),
    [
        (("free", "pinned"), False, 0.9),
        (("pinned", "free"), False, 0.0),
        (("free", "clamped"), True, 0.9),
        (("free", "guided"), True, 0.9),
    ],
)
def test_a_matched_device_on_a_support_is_refused_where_it_was_asked_for(supports, turning, place):
    """At the right end it was told by its distance from there, 0.0 m."""
    end = supports[place > 0.0]
    with pytest.raises(InputError, match=rf"^position = {place!r} m stands on a {end} support, .*: move it$"):
        matched_device(replace(STRIP, supports=supports), 3000.0, place, turning=turning)
