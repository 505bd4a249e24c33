"""Driven waves against their closed forms, and against the states along the beam: what no scene drives."""

from functools import cache, partial
from math import pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.device import Device
from verify.models.arrays import ComplexArray
from verify.models.fields import phasor
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import PLACES, PLAIN, States
from verify.stress.references.beams import STRIP
from verify.waves.case import DrivenCase

# --- Two modes --------------------------------------------------------------------------------------------------------


def two_modes_error(mode: float) -> float:
    """Of both waves of two modes n and n + 3 between pins, one ahead of the other: each sine is two waves.

    sin(k x) = (i e^{-ikx} - i e^{ikx}) / 2, of which e^{-ikx} runs towards +x.
    """
    from verify.waves.lumped import TwoModes

    numbers, ratio, phase = (int(mode), int(mode) + 3), 0.6, 70.0
    found = TwoModes(beam=STRIP, modes=numbers, ratio=ratio, phase_deg=phase)
    size = sqrt(2.0 / (STRIP.mass_per_length * STRIP.length))
    x = np.linspace(0.05, 0.7, 14)
    turns = [n * pi * x / STRIP.length for n in numbers]
    shares = (1.0, ratio * np.exp(1j * np.deg2rad(phase)))
    forward = size * sum(0.5j * share * np.exp(-1j * turn) for share, turn in zip(shares, turns, strict=True))
    backward = size * sum(-0.5j * share * np.exp(1j * turn) for share, turn in zip(shares, turns, strict=True))
    pairs = [*zip(found.local_waves(x), (forward, backward), strict=True), (found.deflection(x), forward + backward)]
    return largest(float(abs(a - b).max() / size) for a, b in pairs)


def local_waves_error(hertz: float) -> float:
    """Of both waves of a field between pins, left and right of its force, against the sines of Green's function.

    Left of the force w = F sin(k x) sin(k (L - a)) / (2 EI k^3 sin(k L)), less the same of hyperbolic sines.
    """
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.lumped import local_waves

    at, newton = 0.31, 1.7
    field = solve_harmonic(STRIP, (PointForce(position=at, amplitude=newton),), hertz)
    k, length = sqrt(2.0 * pi * hertz / STRIP.wave_constant), STRIP.length
    size = newton / (2.0 * STRIP.bending_stiffness * k**3 * np.sin(k * length))
    worst = 0.0
    for x, across, away, side in ((0.12, length - at, 0.0, 1.0), (0.57, at, length, -1.0)):
        sent = 0.5j * size * np.sin(k * across) * np.exp(-1j * k * side * (x - away))
        waves = (sent, np.conj(sent))  # i e^{-iy} / 2 and -i e^{iy} / 2 of sin y
        exact = waves if side > 0.0 else waves[::-1]
        worst = largest(
            worst, *(abs(a[0] - b) / abs(sent) for a, b in zip(local_waves(field, [x]), exact, strict=True))
        )
    return worst


def turning_error(phase: float) -> float:
    """Whether crests run and points turn as two forces a phase apart drive them, and as power flows."""
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.measures import measure

    forces = (PointForce(position=0.05), PointForce(position=0.69, phase_deg=phase))
    found = measure(solve_harmonic(replace(STRIP, loss_factor=0.01), forces, 9100.0), (0.21, 0.52))
    way = 1.0 if abs(found.waves.forward) > abs(found.waves.backward) else -1.0
    turns = "counter-clockwise" if way > 0.0 else "clockwise"
    right = (found.waves.direction == way, found.rotation == turns, found.energy_flux * way > 0.0)
    least, mean, most = found.signed_area_range
    off = abs(found.signed_area_spread / ((most - least) / abs(mean)) - 1.0)
    return largest(off, float(not all(right)), float(found.crest_speed * way > 0.0), float(mean * way > 0.0))


# --- Power ------------------------------------------------------------------------------------------------------------

BAR = replace(PLAIN, extreme_fibre=0.0013)
POWERED: tuple[tuple[Beam, str, float], ...] = (
    (replace(BAR, supports=("pinned", "pinned")), "euler-bernoulli", 9100.0),
    (replace(BAR, supports=("clamped", "free"), shear_stiffness=1.2e5), "timoshenko", 5300.0),
    (replace(BAR, supports=("clamped", "free")), "rayleigh", 9100.0),
    (replace(BAR, supports=("pinned", "guided"), tension=900.0), "euler-bernoulli", 9100.0),
    (replace(BAR, supports=("free", "guided"), foundation=7e6, shear_stiffness=1.2e5), "timoshenko", 5300.0),
)


def power_error(number: float) -> float:
    """Power through the middle of a window against what the force behind it gives, with nothing lost on the way."""
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.measures import measured_figure

    beam, theory, hertz = POWERED[int(number)]
    forces = (PointForce(position=0.05), PointForce(position=0.57, amplitude=1.2, phase_deg=66.0))
    states = States(beam, theory, (2.0 * pi * hertz) ** 2, [force.position for force in forces])
    speed = 2j * pi * hertz * states.read(states.under(forces), forces[0].position, 0)
    given = 0.5 * (phasor(forces[0]) * np.conj(speed)).real
    field = solve_harmonic(beam, forces, hertz, theory)
    return abs(measured_figure(field, (0.2, 0.42), field.wavenumber, "energy_flux") / float(given) - 1.0)


# --- Devices and held places ------------------------------------------------------------------------------------------

FORCES = (PointForce(position=0.11, amplitude=1.4, phase_deg=-35.0), PointForce(position=0.47, phase_deg=80.0))
DEVICES = (
    Device(position=0.22, stiffness=900.0, mass=0.017, dashpot=2.3),
    Device(position=0.39, rotational=1.9, rotary_inertia=2e-5, rotational_dashpot=7e-3, dashpot=0.9),
    Device(position=0.52, dashpot=1.1, amplitude=0.8, phase_deg=130.0),
)
STOP = Device(position=0.33, stiffness=1e16)
DEVICED = replace(
    PLAIN,
    loss_factor=0.004,
    supports=("clamped", "free"),
    mass=(PointMass(position=0.29, mass=0.02),),
    spring=(PointSpring(position=0.61, stiffness=200.0),),
)


def devices_error(hertz: float) -> float:
    """Of the exact field with devices that resist deflection and turning, and of the powers they take.

    Once more with one of them so stiff that it is a support: whatever it is beside the others, nothing resonates.
    """
    return largest(_devices_error(devices, hertz) for devices in (DEVICES, (*DEVICES, STOP)))


def _devices_error(devices: tuple[Device, ...], hertz: float) -> float:
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.devices import field_with_devices, powers

    omega = 2.0 * pi * hertz
    resists = {one.position: _resists(one, omega) for one in devices}
    own = PointForce(position=0.52, amplitude=0.8, phase_deg=130.0)
    stops = [*PLACES.tolist(), *resists, *(force.position for force in FORCES)]
    states = States(DEVICED, "euler-bernoulli", omega**2, stops, resists)
    under = states.under((*FORCES, own))
    exact = np.array([states.read(under, x, 0) for x in PLACES.tolist()])
    field = field_with_devices(solve_harmonic, DEVICED, FORCES, hertz, devices)
    worst = float(abs(field.shapes(PLACES, 0) - exact).max() / abs(exact).max())
    moved = {at: abs(states.read(under, at, 0)) ** 2 for at in resists}
    taken = {at: -0.5 * omega * resists[at][0].imag * square for at, square in moved.items() if resists[at][0].imag}
    pulls = [force for force in field.forces if force.position in taken and force != own]
    found = powers(field, pulls)
    return largest(worst, *(abs(value / taken[at.position] - 1.0) for at, value in zip(pulls, found, strict=True)))


def _resists(one: Device, omega: float) -> tuple[complex, complex]:
    """Dynamic stiffness across and against turning."""
    across = one.stiffness - omega**2 * one.mass + 1j * omega * one.dashpot
    turning = one.rotational - omega**2 * one.rotary_inertia + 1j * omega * one.rotational_dashpot
    return complex(across), complex(turning)


def imposed_error(hertz: float) -> float:
    """Of fields under imposed displacements, alone and in a map, against states; at a resonance from both sides."""
    from verify.exact.harmonic import solve_harmonic, unit_responses
    from verify.waves.imposed import driven_field, held_units

    beam = replace(PLAIN, supports=("clamped", "free"))
    hertz = _resonance(beam) if hertz == 0.0 else hertz
    drives = (PointForce(position=0.11, amplitude=1e-3, phase_deg=20.0), PointForce(position=0.47, amplitude=2e-3))
    places = np.array([drive.position for drive in drives])
    sides = (-1e-6, 1e-6) if hertz == _resonance(beam) else (0.0,)
    exact = np.mean([_held(beam, drives, hertz * (1.0 + side)) for side in sides], axis=0)
    field = driven_field(lambda forces, f: solve_harmonic(beam, forces, f), drives, hertz, "displacement")
    units = held_units(partial(unit_responses, beam), places, beam, np.array([hertz, 77.0]), PLACES)
    together = units[0].T @ np.array([phasor(drive) for drive in drives])
    return largest(float(abs(found - exact).max() / abs(exact).max()) for found in (field.shapes(PLACES, 0), together))


@cache
def _resonance(beam: Beam) -> float:
    from verify.exact.closed_forms import frequency_hz

    return frequency_hz(beam, 4)


def _held(beam: Beam, drives: tuple[PointForce, ...], hertz: float) -> ComplexArray:
    """Deflections at all places, by the states under a unit force at each place that is held."""
    states = States(beam, "euler-bernoulli", (2.0 * pi * hertz) ** 2, [*PLACES.tolist(), *(d.position for d in drives)])
    units = [states.under((PointForce(position=drive.position),)) for drive in drives]
    receptance = np.array([[states.read(unit, drive.position, 0) for unit in units] for drive in drives])
    shares = np.linalg.solve(receptance, [phasor(drive) for drive in drives])
    return np.array(
        [
            sum(share * states.read(unit, x, 0) for share, unit in zip(shares, units, strict=True))
            for x in PLACES.tolist()
        ]
    )


@cache
def held_resonance() -> float:
    """A frequency at which a pinned strip that is held at 0.3 m resonates, Hz: its receptance there is zero."""
    from scipy.optimize import brentq

    def receptance(hertz: float) -> float:
        k = sqrt(2.0 * pi * hertz / STRIP.wave_constant)
        parts = [of(k * 0.3) * of(k * (STRIP.length - 0.3)) / of(k * STRIP.length) for of in (np.sin, np.sinh)]
        return float(parts[0] - parts[1])

    low, high = (pi * STRIP.wave_constant / (2.0 * STRIP.length**2) * n**2 for n in (1.0, 2.0))
    return float(brentq(receptance, 1.001 * low, 0.999 * high, xtol=1e-13, rtol=1e-15))


# --- The best drive ---------------------------------------------------------------------------------------------------


def fastest_error(phase: float) -> float:
    """How far the fastest crests that keep a limit lie from the best of a grid around, and whether one beats them."""
    from verify.waves.operating_point import fastest_point, landscape

    case = _case(phase)
    found, land = fastest_point(case, 0.2), landscape(case)
    hertz = np.clip(found.frequency_hz * (1.0 + np.linspace(-2e-4, 2e-4, 41)), 0.985 * 9100.0, 1.015 * 9100.0)
    degrees = np.sign(phase) * np.clip(abs(found.phase_deg + np.linspace(-2.0, 2.0, 81)), 5.0, 175.0)
    gamma, speed = land.over(hertz, degrees)
    best = float(np.where(gamma <= 0.2, abs(speed), 0.0).max())
    if found.reflection > 0.2 + 1e-9 or np.sign(found.phase_deg) != np.sign(phase):
        return 1.0
    return largest(best / abs(found.crest_speed) - 1.0, 0.0) * 1e6 + max(1.0 - best / abs(found.crest_speed), 0.0)


def quietest_error(phase: float) -> float:
    """By how much a reflection close by lies below the least that is found, over it."""
    from verify.judge.workbench import Workbench
    from verify.waves.driven import driven, measures
    from verify.waves.operating_point import driven_point, landscape, operating_points

    case = _case(phase)
    (quiet, fast), problems = operating_points(case, 0.2)
    around = quiet.frequency_hz * (1.0 + np.array([-1e-5, -1e-6, 1e-6, 1e-5]))
    gamma = landscape(case).over(around, np.array([case.forces[1].phase_deg - case.forces[0].phase_deg]))[0]
    sides = [
        landscape(case).over(np.array([quiet.frequency_hz + side]), np.array([quiet.phase_deg]))[0]
        for side in (-0.5, 0.5)
    ]
    slope = float(np.mean([abs(side[0, 0] - quiet.reflection) for side in sides]) / 0.5)
    off = max(abs(quiet.per_hertz / slope - 1.0), float(len(problems)), abs(fast.reflection - 0.2))
    here, told = driven_point(case), measures(driven(case, Workbench(case.beam)), None)
    off = largest(off, abs(here.reflection / told.reflection - 1.0), abs(here.crest_speed / told.crest_speed - 1.0))
    return largest(off, quiet.reflection / float(gamma.min()) - 1.0, 0.0)


def _case(phase: float) -> DrivenCase:
    forces = (
        PointForce(position=0.02, phase_deg=17.0),
        PointForce(position=0.71, amplitude=0.9, phase_deg=17.0 + phase),
    )
    beam = replace(STRIP, loss_factor=0.002)
    return DrivenCase(beam=beam, model="analytic", count=None, forces=forces, frequency_hz=9100.0)


ROWS: tuple[Row, ...] = (
    Floor(
        id="waves-of-two-modes",
        title="Both waves of two modes between pins, by their sines",
        why="waves/lumped.py: three derivatives of closed forms, to rounding.",
        along="mode",
        at=(1, 8, 21),
        promise=1e-11,
        error=two_modes_error,
    ),
    Floor(
        id="local-waves",
        title="Both waves of a field between pins, left and right of its force, by Green's function",
        why="waves/lumped.py: three derivatives of closed forms, to rounding.",
        along="Hz",
        at=(37.0, 410.0, 9100.0),
        promise=1e-9,
        error=local_waves_error,
    ),
    Floor(
        id="which-way",
        title="Direction, sense of turning, power and crests of waves both ways, and their ellipses' spread",
        why="waves/found.py: points turn counter-clockwise under a wave towards +x, and move backwards on its crests.",
        along="degrees",
        at=(-130.0, -40.0, 50.0, 140.0),
        promise=1e-12,
        error=turning_error,
    ),
    Floor(
        id="power-by-every-theory",
        title="Power through a window of waves that shear, turn, are pulled at or lie on ground, against the force's",
        why="waves/measures.py: what near fields leave in a window eight wavelengths off.",
        along="beam",
        at=(0, 1, 2, 3, 4),
        promise=1e-4,
        error=power_error,
    ),
    Floor(
        id="devices-in-states",
        title="The exact field with springs, masses and dashpots that resist deflection and turning, and their powers",
        why="waves/devices.py: three springs say what any device does, losing four digits.",
        along="Hz",
        at=(37.0, 290.0, 1300.0),
        promise=1e-9,
        error=devices_error,
    ),
    Floor(
        id="places-held",
        title="Fields under imposed displacements, alone and in a map, at a resonance of the free beam (0) too",
        why="waves/imposed.py: a small system; the mean of two sides is off by its curvature, 1e-9.",
        along="Hz",
        at=(0.0, 31.0, 433.0),
        promise=1e-7,
        error=imposed_error,
    ),
    Floor(
        id="fastest-crests",
        title="Fastest crests that keep a reflection, against a grid around them: none faster by a millionth",
        why="waves/operating_point.py: to 1e-12 of the frequency, phases in closed form; a grid's best lies 2 % off.",
        along="degrees",
        at=(-60.0, 70.0),
        promise=0.05,
        error=fastest_error,
    ),
    Floor(
        id="quietest-drive",
        title="Least reflection at a phase, its slope over half a hertz, and the fastest point at its limit",
        why="waves/operating_point.py: to 1e-5 Hz, and differences over half a hertz.",
        along="degrees",
        at=(-100.0, 70.0),
        promise=1e-6,
        error=quietest_error,
    ),
)
