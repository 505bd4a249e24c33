"""Devices on a driven beam: every model's field beside one matched span by span here, and what is refused."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from scipy.optimize import brentq

from verify import Beam, PointForce, PointMass, PointSpring, analytic_modes, fem_beam, segment_model
from verify.device import Device, of_impedance
from verify.errors import InputError, WindowError
from verify.judge.cache import SolutionCache
from verify.models.fields import phasor
from verify.waves.absorber import matched_device
from verify.waves.case import DrivenCase
from verify.waves.devices import DevicesResonanceError, field_with_devices, powers
from verify.waves.driven import driven, own_wavenumber
from verify.waves.imposed import driven_field
from verify.waves.measures import measure

SIZES = {"length": 0.83, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 193e9, "density": 7900.0}
STRIP = Beam(**SIZES)
"""Of steel, no size of the paper's."""
CANTILEVER = Beam(**SIZES, supports=("clamped", "free"))
ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
X = np.linspace(0.013, 0.809, 23)
FORCES = [PointForce(position=0.11, amplitude=1.3, phase_deg=17.0), PointForce(position=0.52, amplitude=0.7)]


def exact(beam, forces, hertz):
    return analytic_modes.solve_harmonic(beam, forces, hertz)


def segments(n):
    return lambda beam, forces, hertz: segment_model.solve_harmonic(beam, forces, hertz, n_segments=n)


def elements(n):
    return lambda beam, forces, hertz: fem_beam.solve_harmonic(beam, forces, hertz, n_elements=n)


def matched(beam, forces, hertz, devices, x):
    """Deflection at x, (len(x),): four exponentials on every span; at each place deflection, slope, moment, shear.

    EI w'' jumps by the couple i omega Z_theta w', EI w''' by F - i omega Z w, e^{+i omega t}.
    """
    omega, ei = 2 * np.pi * hertz, beam.bending_stiffness * (1 + 1j * beam.loss_factor)
    k = (beam.mass_per_length * omega**2 / ei) ** 0.25
    q = k * np.array([1j, -1j, 1.0, -1.0])
    cuts = sorted({0.0, beam.length} | {one.position for one in (*forces, *devices)})
    n = len(cuts) - 1

    def row(span, at, order):
        """Each exponential starts where it is largest, at its own end of the span."""
        from_left, from_right = at - cuts[span], at - cuts[span + 1]
        found = np.zeros((n, 4), dtype=complex)
        found[span] = q**order * np.exp(np.where(q.real > 0, q * from_right, q * from_left))
        return found.ravel()

    def acts(at, order):
        """What a place adds to EI w^(order + 1) from its left to its right: of w, w' and of nothing, as a row."""
        here = [d for d in devices if d.position == at]
        across, turning = (
            sum(z) for z in ([d.impedance(omega) for d in here], [d.turning_impedance(omega) for d in here])
        )
        return 1j * omega * (turning if order == 2 else -across), 1 if order == 2 else 0

    def push(at):
        own = [
            PointForce(position=at, amplitude=d.amplitude, phase_deg=d.phase_deg) for d in devices if d.position == at
        ]
        return sum(phasor(f) for f in (*[f for f in forces if f.position == at], *own))

    rows, right = [], []
    for at, span, support, side in ((0.0, 0, beam.supports[0], 1), (beam.length, n - 1, beam.supports[1], -1)):
        for order in ENDS[support]:
            line, value = row(span, at, order), 0.0
            if order >= 2:
                gain, reads = acts(at, order)
                line = side * ei * line - gain * row(span, at, reads)
                value = push(at) if order == 3 else 0.0
            rows.append(line)
            right.append(value)
    for i, at in enumerate(cuts[1:-1]):
        for order in range(4):
            line = row(i + 1, at, order) - row(i, at, order)
            value = 0.0
            if order >= 2:
                gain, reads = acts(at, order)
                line = ei * line - gain * row(i, at, reads)
                value = push(at) if order == 3 else 0.0
            rows.append(line)
            right.append(value)
    rows = np.array(rows)
    scale = abs(rows).max(axis=1)
    amplitudes = np.linalg.solve(rows / scale[:, None], np.array(right) / scale)
    return np.array([row(max(np.searchsorted(cuts, at) - 1, 0), at, 0) @ amplitudes for at in x])


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
    pytest.param(STRIP, PINNED_END, id="turning at a pinned end"),
    pytest.param(CANTILEVER, FREE_END, id="across and turning at a free end"),
]


def off(found, wanted):
    return float(abs(found - wanted).max() / abs(wanted).max())


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("hertz", [61.0, 2390.0])
def test_the_exact_field_with_devices_is_that_of_matched_spans(beam, devices, hertz):
    found = field_with_devices(exact, beam, FORCES, hertz, devices).deflection(X)
    assert off(found, matched(beam, FORCES, hertz, devices, X)) < 2e-9


@pytest.mark.parametrize(("beam", "devices"), CASES)
@pytest.mark.parametrize("model", [segments, elements], ids=["segments", "fem"])
def test_segments_and_elements_with_devices_come_to_it_at_their_own_order(model, beam, devices):
    """4; of segments 3 on a clamped beam, where it is 3 under forces alone and with a body that they know."""
    wanted = matched(beam, FORCES, 733.0, devices, X)
    errors = [off(field_with_devices(model(n), beam, FORCES, 733.0, devices).deflection(X), wanted) for n in (83, 166)]
    low, high = (2.8, 3.4) if model is segments and beam is CANTILEVER else (3.4, 4.6)
    assert low < np.log2(errors[0] / errors[1]) < high
    assert errors[1] < (3e-4 if model is segments else 1e-4)


@settings(max_examples=40, deadline=None)
@given(
    hertz=st.floats(30.0, 9000.0),
    place=st.floats(0.05, 0.78),
    values=st.tuples(*[st.floats(0.0, 1.0)] * 6),
    ends=st.tuples(st.sampled_from(list(ENDS)), st.sampled_from(list(ENDS))),
)
def test_any_device_at_any_place_of_any_beam(hertz, place, values, ends):
    """Impedances of the beam's own size: EI k^3 / omega across, EI k / omega turning."""
    beam = Beam(**SIZES, supports=ends, loss_factor=0.013)
    omega = 2 * np.pi * hertz
    k = (beam.mass_per_length * omega**2 / beam.bending_stiffness) ** 0.25
    across, turning = beam.bending_stiffness * k**3 / omega, beam.bending_stiffness * k / omega
    a, b, c, d, e, f = values
    device = Device(
        position=place,
        dashpot=across * a + 1e-3 * across,
        stiffness=across * omega * b,
        mass=across / omega * c,
        rotational_dashpot=turning * d,
        rotational=turning * omega * e,
        rotary_inertia=turning / omega * f,
    )
    found = field_with_devices(exact, beam, FORCES[:1], hertz, [device]).deflection(X)
    assert off(found, matched(beam, FORCES[:1], hertz, [device], X)) < 1e-7


BODY = {"rotary_inertia": 4e-6, "rotational": 3.3}


def carrying(**also):
    """The strip with a body that turns, and perhaps has a mass, and a spring against turning, of the beam's own."""
    return Beam(
        **SIZES,
        mass=[PointMass(position=0.31, rotary_inertia=4e-6, **also)],
        spring=[PointSpring(position=0.31, rotational=3.3)],
    )


@pytest.mark.parametrize("model", [exact, segments(31), elements(17)], ids=["exact", "segments", "fem"])
def test_a_body_that_only_turns_is_felt_to_rounding_as_the_models_feel_one_of_the_beams(model):
    on_drive = field_with_devices(model, STRIP, FORCES, 311.0, [Device(position=0.31, **BODY)])
    assert off(on_drive.deflection(X), model(carrying(), FORCES, 311.0).deflection(X)) < 1e-9
    assert on_drive.beam is STRIP


def test_a_body_of_the_drive_moves_the_exact_beam_as_one_of_the_beam_does():
    on_drive = field_with_devices(exact, STRIP, FORCES, 311.0, [Device(position=0.31, mass=0.017, **BODY)])
    assert off(on_drive.deflection(X), exact(carrying(mass=0.017), FORCES, 311.0).deflection(X)) < 1e-9


def test_under_timoshenkos_theory_a_device_turns_with_the_section_as_a_body_does():
    def thick(beam, forces, hertz):
        return analytic_modes.solve_harmonic(beam, forces, hertz, theory="timoshenko")

    on_drive = field_with_devices(thick, STRIP, FORCES, 9000.0, [Device(position=0.31, mass=0.017, **BODY)])
    assert off(on_drive.deflection(X), thick(carrying(mass=0.017), FORCES, 9000.0).deflection(X)) < 1e-8


def test_an_active_force_alone_takes_up_the_wave_as_the_matched_device_does():
    hertz, device = 2390.0, matched_device(STRIP, 2390.0, 0.81)
    passive = field_with_devices(exact, STRIP, FORCES[:1], hertz, [device])
    reaction = passive.forces[-1]
    active = Device(position=0.81, amplitude=reaction.amplitude, phase_deg=reaction.phase_deg)
    assert (
        off(field_with_devices(exact, STRIP, FORCES[:1], hertz, [active]).deflection(X), passive.deflection(X)) < 1e-12
    )


def test_power_given_is_power_taken():
    device = Device(position=0.71, dashpot=3.1, stiffness=5200.0, mass=0.002)
    field = field_with_devices(exact, STRIP, FORCES, 2390.0, [device])
    speed = abs(field.omega * field.deflection(0.71)[0])
    assert sum(powers(field, FORCES)) == pytest.approx(0.5 * 3.1 * speed**2, rel=1e-9)
    assert powers(field, field.forces[2:])[0] == pytest.approx(-0.5 * 3.1 * speed**2, rel=1e-9)


def case(**given):
    base = {"beam": STRIP, "model": "analytic", "count": None, "forces": tuple(FORCES), "frequency_hz": 1500.0}
    return DrivenCase(**(base | given))


def test_a_resonance_of_the_bare_beam_is_none_of_the_beam_with_its_device():
    hertz = analytic_modes.frequency_hz(STRIP, 9)
    found = driven(case(frequency_hz=hertz, devices=ONE), SolutionCache(STRIP))
    assert off(found.deflection(X), matched(STRIP, FORCES, hertz, ONE, X)) < 1e-6
    assert powers(found, found.forces[:2]) == pytest.approx(
        powers(driven(case(frequency_hz=hertz * (1 + 1e-7), devices=ONE), SolutionCache(STRIP)), FORCES), rel=1e-3
    )


TURNING = ({"rotational_dashpot": 1e-5}, {"rotational_dashpot": 2e-3, "rotational": 0.5}, {"rotary_inertia": 1e-6})


@pytest.mark.parametrize("beam", [STRIP, CANTILEVER], ids=["pinned", "cantilever"])
@pytest.mark.parametrize("given", TURNING, ids=" ".join)
def test_a_device_against_turning_is_right_where_the_bare_beam_resonates(beam, given):
    devices = [Device(position=0.31, **given)]
    for mode in (2, 7):
        for part in (0.0, 1e-12, -3e-9, 1e-7):
            hertz = analytic_modes.frequency_hz(beam, mode) * (1.0 + part)
            found = field_with_devices(exact, beam, FORCES, hertz, devices).deflection(X)
            assert off(found, matched(beam, FORCES, hertz, devices, X)) < 1e-8


@pytest.mark.parametrize("beam", [STRIP, CANTILEVER], ids=["pinned", "cantilever"])
def test_a_resonance_with_a_body_that_turns_and_loses_nothing_is_refused(beam):
    devices = [Device(position=0.31, rotary_inertia=1e-6)]

    def give(hertz):
        return 1.0 / matched(beam, FORCES[1:], hertz, devices, [0.63])[0].real

    bare = analytic_modes.frequency_hz(beam, 5)
    resonance = brentq(give, bare * (1.0 - 2e-3), bare * (1.0 - 3e-5), xtol=1e-13, rtol=1e-15)
    for part in (0.0, 2e-10):
        with pytest.raises(DevicesResonanceError, match=r"beam with devices at \[0\.31\] m"):
            field_with_devices(exact, beam, FORCES, resonance * (1.0 + part), devices)
    beside = resonance * (1.0 + 3e-9)
    found = field_with_devices(exact, beam, FORCES, beside, devices).deflection(X)
    assert off(found, matched(beam, FORCES, beside, devices, X)) < 1e-5


def test_a_resonance_with_a_device_that_loses_nothing_is_refused():
    own = exact(STRIP, [PointForce(position=0.3)], 1500.0).deflection(0.3)[0].real
    spring = Device(
        position=0.3, **({"stiffness": -1.0 / own} if own < 0 else {"mass": 1.0 / own / (3000 * np.pi) ** 2})
    )
    with pytest.raises(DevicesResonanceError, match=r"frequency_hz = 1500\.0 is an undamped resonance.*give a device"):
        driven(case(devices=(spring,)), SolutionCache(STRIP))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffness": -3.0}, r"device\.stiffness = -3\.0: give a finite number of at least 0 \(N/m\)"),
        ({"mass": -0.1}, r"device\.mass = -0\.1: give"),
        ({"dashpot": float("nan")}, r"device\.dashpot = nan: give"),
        ({"rotational": -1.0}, r"device\.rotational = -1\.0: give"),
        ({"rotary_inertia": -1.0}, r"device\.rotary_inertia = -1\.0: give"),
        ({"rotational_dashpot": -1.0}, r"device\.rotational_dashpot = -1\.0: give"),
        ({}, r"position = 0\.2 does nothing: give it one of stiffness, mass"),
    ],
)
def test_a_device_that_is_none_is_refused_by_field_value_and_remedy(given, said):
    with pytest.raises(InputError, match=said):
        Device(position=0.2, **given)


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
        field_with_devices(exact, beam, FORCES, 700.0, [device])


def test_what_drives_nothing_or_gives_energy_is_refused():
    with pytest.raises(InputError, match="forces is empty and no device has an amplitude"):
        field_with_devices(exact, STRIP, [], 700.0, ONE)
    with pytest.raises(InputError, match="gives energy"):
        of_impedance(0.3, -1.0 + 2.0j, 700.0)
    with pytest.raises(InputError, match=r"drive\.kind = 'displacement': beside a device"):
        driven(case(kind="displacement", devices=ONE), SolutionCache(STRIP))


TURNS = Device(position=0.31, rotational_dashpot=0.02)
AROUND = [PointForce(position=0.07), PointForce(position=0.79, phase_deg=90.0)]


@pytest.mark.parametrize("model", [exact, segments(60), elements(60)])
@pytest.mark.parametrize("more", [[], [Device(position=0.81, dashpot=2.0)]])
def test_a_window_over_a_device_that_only_turns_is_refused(model, more):
    """Its couple parts the waves as a force does: 37 % were left over, and nothing was told."""
    field = field_with_devices(model, STRIP, AROUND, 1700.0, [TURNS, *more])
    with pytest.raises(WindowError, match=r"holds a device against turning at \[0\.31\] m: two waves alone live"):
        measure(field, (0.2, 0.6))
    assert measure(field, (0.14, 0.26), own_wavenumber(field)).waves.residual < 0.02
    assert measure(field, (0.36, 0.7), own_wavenumber(field)).waves.residual < 0.01


TURNING_SCENE = """name = "turns"
[beam]
length = 0.5
width = 0.02
thickness = 0.001
youngs_modulus = 70e9
density = 2700.0
[drive]
frequency_hz = 4276.0
[[drive.force]]
position = 0.05
[[drive.force]]
position = 0.45
phase_deg = 90.0
[[drive.device]]
position = 0.3
rotational_dashpot = 0.02
[[gate]]
id = "ratio"
quantity = "wave.standing_wave_ratio"
expect = 1.6876
within = 0.1
why = "A device inside the window."
"""


def test_a_drive_slower_than_any_square_of_it_leaves_the_static_field():
    """It ended in a division by nought, as one did of which no impedance is made."""
    device = Device(position=0.21, stiffness=37.0)

    def at(hertz):
        return field_with_devices(analytic_modes.solve_harmonic, STRIP, FORCES, hertz, [device]).deflection([0.13])

    assert at(1e-170) == pytest.approx(at(1e-5), rel=1e-9)
    with pytest.raises(InputError, match="frequency_hz = 1e-320: give a finite number of at least 1e-200"):
        at(1e-320)


@pytest.mark.parametrize("solve", [exact, elements(30), segments(30)], ids=["exact", "elements", "segments"])
def test_a_floating_beam_that_a_device_holds_is_refused_where_its_digits_are_lost(solve):
    """Alone it moves EI / (rho A L^4 omega^2) as far: 2e-16 of that is a twentieth of all that it does when held."""
    floating, held = replace(STRIP, supports=("pinned", "free")), 0.6
    spring = 2.0 * STRIP.bending_stiffness / STRIP.length**3
    device = Device(position=held, stiffness=spring)
    with pytest.raises(InputError, match=r"the beam alone moves \de\+1[2-4] times as far .*raise the frequency"):
        field_with_devices(solve, floating, FORCES, 1e-6, [device])
    found = field_with_devices(solve, floating, FORCES, 1e-3, [device]).deflection(X)
    sprung = replace(floating, spring=(PointSpring(position=held, stiffness=spring),))
    assert found == pytest.approx(solve(sprung, FORCES, 1e-3).deflection(X), rel=2e-6)


def told_frequency(refusal):
    """Hertz that a refused drive is said to need, which are enough for what inertia alone holds."""
    return float(re.search(r"to at least (\S+) Hz", str(refusal.value))[1])


def test_what_a_floating_beam_on_a_device_is_told_to_do_instead_answers():
    floating, spring = replace(STRIP, supports=("pinned", "free")), 2.0 * STRIP.bending_stiffness / STRIP.length**3
    device = Device(position=0.6, stiffness=spring)
    with pytest.raises(InputError) as refusal:
        field_with_devices(exact, floating, FORCES, 1e-6, [device])
    raised = field_with_devices(exact, floating, FORCES, told_frequency(refusal), [device]).deflection(X)
    sprung = replace(floating, spring=(PointSpring(position=0.6, stiffness=spring),))
    assert raised == pytest.approx(exact(sprung, FORCES, 1e-6).deflection(X), rel=1e-3)


@pytest.mark.parametrize("solve", [exact, elements(30), segments(30)], ids=["exact", "elements", "segments"])
def test_a_stiff_device_where_the_force_acts_is_answered_on_a_beam_that_does_not_float(solve):
    """At all places a hundredth as far as behind one a hundredth as stiff: all but nothing, which nobody loses."""
    held, force = replace(STRIP, supports=("clamped", "pinned")), PointForce(position=0.3, amplitude=1.7)
    soft, stiff = (
        field_with_devices(solve, held, force, 3000.0, [Device(position=0.3, stiffness=k)]).deflection(X)
        for k in (1e16, 1e18)
    )
    assert 100.0 * stiff == pytest.approx(soft, rel=1e-3)
    assert abs(soft).max() < 1e-14


def test_whatever_rounding_leaves_of_a_floating_beam_that_a_stiff_device_stops_is_refused():
    """All of its force goes into the device: what is left of 2e11 m is rounding. Driven fast enough it is answered."""
    floating, force = replace(STRIP, supports=("pinned", "free")), PointForce(position=0.6, amplitude=1.7)
    field_with_devices(exact, floating, [force], 0.3, [Device(position=0.6, stiffness=1e15)])
    for stiffness in (1e10, 1e15, 1e20):
        with pytest.raises(InputError, match=r"alone moves \de\+1\d times as far"):
            field_with_devices(exact, floating, [force], 1e-6, [Device(position=0.6, stiffness=stiffness)])


def test_a_floating_beam_bent_by_three_places_is_refused_where_its_digits_are_lost():
    floating = replace(STRIP, supports=("free", "free"))
    bent = [PointForce(position=x, amplitude=y) for x, y in ((0.02, 1e-3), (0.5, 3e-3), (0.8, 1e-3))]

    def bends(beam, hertz):
        return driven_field(lambda acts, f: exact(beam, acts, f), bent, hertz, "displacement").deflection(X)

    with pytest.raises(InputError, match=r"alone moves .* as far as it does where the drive holds it") as refusal:
        bends(floating, 1e-6)
    k = STRIP.bending_stiffness / STRIP.length**3
    sprung = replace(floating, spring=tuple(PointSpring(position=one.position, stiffness=k) for one in bent))
    assert bends(floating, told_frequency(refusal)) == pytest.approx(bends(sprung, 1e-6), rel=1e-4)
