"""What no wave is measured in, what no device does, and contacts in closed form that do not exist."""

from math import nan, pi, sqrt

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam, PointForce
from verify.contact import belt, bouncing, foot, landing, layer
from verify.device import Device
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.stress.kind import Row
from verify.stress.references.beams import STEPPED, STRIP
from verify.stress.refusals import Ask, Case, refusals
from verify.waves.absorber import beam_impedance, matched_device
from verify.waves.devices import field_with_devices
from verify.waves.lumped import TwoModes
from verify.waves.series import measure_series
from verify.waves.unit_waves import receptance
from verify.waves.window import check_halves, check_window

HERTZ = 370.0
FORCES = (PointForce(position=0.1), PointForce(position=0.6, phase_deg=83.0))
WITH_MASS = replace(STRIP, mass=(PointMass(position=0.3, mass=0.02),))
TIMES, PLACES = np.linspace(0.0, 0.01, 101), np.linspace(0.1, 0.6, 21)
SEEN = np.cos(2.0 * pi * HERTZ * TIMES[:, None] - 26.0 * PLACES)
SPRING = Device(position=0.2, stiffness=3000.0)
HALF = pi / sqrt(2.0 * pi * HERTZ / STRIP.wave_constant)
"""Of a wavelength."""
MOST_HERTZ = STRIP.wave_constant * (1e4 * pi / STRIP.length) ** 2 / (2.0 * pi)
"""Of ten thousand half waves on the beam."""


def window(*ends: float, on: Beam = STRIP) -> Ask:
    """Between the two forces."""
    return lambda: check_window(on, [force.position for force in FORCES], HERTZ, ends)  # type: ignore[arg-type]


def among(*ends: float) -> Ask:
    """Beside three forces, the last of them given first."""
    return lambda: check_window(STRIP, [0.7, 0.1, 0.6], 9100.0, ends)  # type: ignore[arg-type]


def halves(*ends: float, on: Beam = STRIP, hertz: float = HERTZ) -> Ask:
    """Half wavelengths in a window."""
    return lambda: check_halves(on, hertz, ends)  # type: ignore[arg-type]


def ground(share: float) -> Beam:
    """On which waves run from `HERTZ` on, at a share of 1."""
    return replace(STRIP, foundation=share * STRIP.mass_per_length * (2.0 * pi * HERTZ) ** 2)


def turned(at: float) -> Ask:
    """A window with a device against turning."""
    places = [force.position for force in FORCES]
    return lambda: check_window(STRIP, places, HERTZ, (0.35, 0.5), (at,))


def series(x: Array = PLACES, times: Array = TIMES, values: Array = SEEN, hertz: float = HERTZ) -> Ask:
    """Of a wave seen at 21 places."""
    return lambda: measure_series(STRIP, x, times, values, hertz)


def bouncing_at(share: float) -> Ask:
    """In step, at a share of the least ratio."""
    return lambda: bouncing.bounce_in_step(share * bouncing.bouncing_limits(0.3)[0], 0.3)


def driven(*devices: Device, forces: tuple[PointForce, ...] = FORCES) -> Ask:
    """The exact beam with devices."""
    return lambda: field_with_devices(
        lambda of, acting, hertz: MODELS["analytic"].solve_harmonic(of, acting, hertz, None),
        STRIP,
        forces,
        HERTZ,
        devices,
    )


ROWS: tuple[Row, ...] = (
    refusals(
        "refused-waves",
        "Windows, series and devices that no wave is told from",
        "waves/window.py, waves/series.py, device.py: two waves alone live between forces, on one section, half a "
        "wavelength and longer.",
        Case("window = [0.2, 0.1]", window(0.2, 0.1), window(0.2, 0.5)),
        Case("window = [-0.1, 0.5]", window(-0.1, 0.5)),
        Case("window = (0.2,)", window(0.2)),
        Case("window = [0.05, 0.5] leaves the span", window(0.05, 0.5), window(0.1, 0.6)),
        Case("window = [0.2, 0.61] leaves the span", window(0.2, 0.61)),
        Case("window = [0.05, 0.09] leaves the span", among(0.05, 0.09), among(0.63, 0.69)),
        Case("window = [0.2, 0.5] holds a mass", window(0.2, 0.5, on=WITH_MASS), window(0.32, 0.5, on=WITH_MASS)),
        Case("window = [0.2, 0.5] holds a beam.section", window(0.2, 0.5, on=STEPPED), window(0.2, 0.39, on=STEPPED)),
        Case("window = [0.2, ", halves(0.2, 0.2 + 0.999 * HALF), halves(0.2, 0.2 + 1.001 * HALF)),
        Case(
            "window = [0.0, 0.73] spans 1e+04 half",
            halves(0.0, 0.73, hertz=1.0001 * MOST_HERTZ),
            halves(0.0, 0.73, hertz=0.9999 * MOST_HERTZ),
        ),
        Case("frequency_hz = 370: no wave runs below 370", halves(0.2, 0.5, on=ground(1.0 + 1e-9))),
        Case("frequency_hz = 370: no wave runs below 370", halves(0.2, 0.5, on=ground(1.0))),
        Case("window = [0.2, 0.5] is shorter", halves(0.2, 0.5, on=ground(1.0 - 1e-6))),
        Case("window = [0.4, 0.6] holds a beam.section", window(0.4, 0.6, on=STEPPED), window(0.2, 0.4, on=STEPPED)),
        Case("window = [0.35, 0.5] holds a device", turned(0.43), turned(0.35)),
        Case("window = [0.35, 0.5] holds a device", turned(0.35 + 1e-9), turned(0.5)),
        Case("frequency_hz = -1.0", series(hertz=-1.0), series()),
        Case("times and values have to be finite", series(times=TIMES[::-1])),
        Case("times have the shape", series(times=TIMES[:5])),
        Case("times cover", series(times=TIMES[:5], values=SEEN[:5])),
        Case("times have 1.351 samples", series(times=20.0 * TIMES)),
        Case("x has to be finite", series(PLACES[::-1])),
        Case("x covers less", series(PLACES[:3], values=SEEN[:, :3])),
        Case("values do not move", series(values=0.0 * SEEN)),
        Case("modes = [3, 3]", lambda: TwoModes(beam=STRIP, modes=(3, 3)), lambda: TwoModes(beam=STRIP, modes=(3, 4))),
        Case("modes = 0", lambda: TwoModes(beam=STRIP, modes=(0, 1))),
        Case("beam.section", lambda: TwoModes(beam=STEPPED, modes=(3, 4))),
        Case("forces is empty", driven(SPRING, forces=()), driven(SPRING)),
        Case("device.position = 0.8", driven(Device(position=0.8, mass=0.01))),
        Case("device.position = 0.0 m stands", driven(Device(position=0.0, mass=0.01))),
        Case("device at position = 0.1", lambda: Device(position=0.1), lambda: Device(position=0.1, dashpot=1.0)),
        Case("device.dashpot = -1.0", lambda: Device(position=0.1, dashpot=-1.0)),
        Case(
            "position = 0.7301",
            lambda: matched_device(STRIP, HERTZ, 0.7301),
            lambda: matched_device(STRIP, HERTZ, 0.72),
        ),
        Case(
            "position = 0.0 m stands",
            lambda: beam_impedance(STRIP, HERTZ, 0.0, "pinned"),
            lambda: beam_impedance(STRIP, HERTZ, 0.0, "pinned", turning=True),
        ),
        Case("position = -0.1", lambda: beam_impedance(STRIP, HERTZ, -0.1, "pinned")),
        Case("beam.section", lambda: beam_impedance(STEPPED, HERTZ, 0.1, "pinned")),
        Case(
            "position = 0.7301",
            lambda: receptance("segment", STRIP, 0.7301, 37.0, 0.2, 9),
            lambda: receptance("segment", STRIP, 0.73, 37.0, 0.2, 9),
        ),
        Case("x = 0.7301", lambda: receptance("fem", STRIP, 0.2, 37.0, 0.7301, 9)),
    ),
    refusals(
        "refused-contacts",
        "Contacts in closed form that do not exist",
        "contact: docstrings; no bounce without loss has limits, no drop of friction no stick and slip.",
        Case(
            "kinetic = 1.0",
            lambda: belt.stick_slip_times(1.0, 1.0, 1.0, 1.0, 0.1),
            lambda: belt.stick_slip_times(1.0, 1.0, 1.0, 0.999, 0.1),
        ),
        Case("mass = 0.0", lambda: belt.stick_slip_times(0.0, 1.0, 1.0, 0.5, 0.1)),
        Case("stiffness = 0.0", lambda: belt.stick_slip_times(1.0, 0.0, 1.0, 0.5, 0.1)),
        Case("speed = 0.0", lambda: belt.stick_slip_times(1.0, 1.0, 1.0, 0.5, 0.0)),
        Case(
            "acceleration_ratio = 1.0",
            lambda: bouncing.leaving_phase(1.0),
            lambda: bouncing.leaving_phase(1.0 + 1e-9),
        ),
        Case("restitution = 1.0", lambda: bouncing.bouncing_limits(1.0), lambda: bouncing.bouncing_limits(0.999)),
        Case("restitution = -1e-09", lambda: bouncing.bouncing_limits(-1e-9), lambda: bouncing.bouncing_limits(0.0)),
        Case("acceleration_ratio = ", bouncing_at(0.999), bouncing_at(1.001)),
        Case("periods = 0", lambda: bouncing.bounce_in_step(3.0, 0.3, 0)),
        Case("load = 0.0", lambda: foot.contact_half_angle(0.0), lambda: foot.contact_half_angle(1e-9)),
        Case("span = -1e-09", lambda: foot.short_foot_force(-1e-9, 0.3), lambda: foot.short_foot_force(0.0, 0.3)),
        Case("span = -1e-09", lambda: foot.short_foot_speed(-1e-9), lambda: foot.short_foot_speed(0.0)),
        Case("span = -1e-09", lambda: foot.height_swing(-1e-9), lambda: foot.height_swing(0.0)),
        Case("speed_ratio = nan", lambda: foot.foot_force(2.0, nan), lambda: foot.foot_force(2.0, 0.5)),
        Case("damping_ratio = -1e-09", lambda: landing.contact_time(-1e-9), lambda: landing.contact_time(0.0)),
        Case("mass = 0.0", lambda: landing.damping_ratio(0.0, 1.0, 1.0), lambda: landing.damping_ratio(1e-3, 1.0, 0.0)),
        Case("damping = -1e-09", lambda: landing.damping_ratio(1.0, 1.0, -1e-9)),
        Case("damping = 1e+300", lambda: landing.damping_ratio(1e-300, 1e-300, 1e300)),
        Case("restitution = 1.001", lambda: landing.damping_ratio_for(1.001), lambda: landing.damping_ratio_for(1.0)),
        Case("restitution = 0.0", lambda: landing.damping_ratio_for(0.0)),
        Case("frequency_ratio = -1e-09", lambda: landing.lift_off_ratio(-1e-9), lambda: landing.lift_off_ratio(0.0)),
        Case("contact_half_angle = 3.14159", lambda: layer.force(pi, 0.3), lambda: layer.force(3.14, 0.3)),
        Case("epsilon = -1e-09", lambda: layer.force(1.0, 0.3, -1e-9), lambda: layer.force(1.0, 0.3, 0.0)),
        Case("speed_ratio = 1.0", lambda: layer.efficiency(1.0, 1.0), lambda: layer.efficiency(1.0, 0.6)),
        Case("speed_ratio = 0.999", lambda: layer.efficiency(1.0, 0.999)),
        Case(
            "pressure_ratio = 1.0",
            lambda: layer.half_space_force(1.0, 0.3),
            lambda: layer.half_space_force(0.999, 0.3),
        ),
    ),
)
