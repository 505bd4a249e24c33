"""Checks of driven fields (close to resonance, damped, slow, short waves, long beams) and of free vibration."""

from math import atan, pi
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.stress.engine import check, worst
from verify.stress.reference import CANTILEVER, PI, STRIP, D, cos, sin, sinh

N, MODE = 40, 3
AT, FROM = 11, 17
"""Joints at which the field is read and driven."""
ALL = ("analytic", "segment", "fem")
LEVER = {"load": "lever", "reading": "raw"}
"""Forces and readings of a chain on its joints."""


def deflection(model: str, beam: Beam, hertz: float, x: float, at: float, **more: str) -> complex:
    """At a place under a unit force at x, m."""
    count = None if model == "analytic" else N
    field = MODELS[model].build(beam, count, **more).harmonic((PointForce(position=x),), hertz)
    return complex(field.deflection([at])[0])


def resonance(model: str) -> float:
    """Hz, of mode 3 of the pinned strip, in closed form."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.error_laws import dispersion_frequency_hz

    return frequency_hz(STRIP, MODE) if model == "analytic" else dispersion_frequency_hz(model, STRIP, MODE, N)


@check("near-resonance", "f / fn - 1", (1e-6, 1e-7, 1e-8, 3e-9), 1e-13, beyond=(1e-9, 1e-10, 1e-12), refused=True)
def near_resonance(distance: float) -> float:
    """Undamped field beside a resonance, three models: the frequency error that would explain its error."""
    x, at, errors = FROM * STRIP.length / N, AT * STRIP.length / N, []
    for model in ALL:
        hertz = resonance(model)

        def answer(part: float, model: str = model, hertz: float = hertz) -> tuple[float, float]:
            driven = hertz * (1.0 + part)
            return driven / hertz - 1.0, deflection(model, STRIP, driven, x, at).real

        # the field is r / d + s near d = 0: readings at +-1e-5 give r and s, to 1e-10 of the field at 1e-9
        (up, above), (down, below) = answer(1e-5), answer(-1e-5)
        residue = (above - below) / (1.0 / up - 1.0 / down)
        for side in (1.0, -1.0):
            real, found = answer(side * distance)
            errors.append(real * (found / (residue / real + above - residue / up) - 1.0))
    return worst(errors)


def beam_sum(beam: Beam, omega: float) -> complex:
    """The pinned beam's field over 200 000 modes, whose tail is 1e-16 of it, m."""
    n = np.arange(200_000, 0, -1.0)
    squares = (beam.wave_constant * (n * pi / beam.length) ** 2) ** 2
    shapes = np.sin(n * pi * AT / N) * np.sin(n * pi * FROM / N)
    terms = shapes / (squares * (1.0 + 1j * beam.loss_factor) - omega**2)
    return complex(2.0 * terms.sum() / (beam.mass_per_length * beam.length))


def links_sum(beam: Beam, omega: float) -> complex:
    """The field of its chain over all modes, K_n = (2 sin a/2)^4 and M_n = (2 + cos a) / 3, a = n pi / N, m."""
    angle, length = np.arange(1, N) * pi / N, beam.length / N
    stiffness = beam.bending_stiffness / length**3 * (2.0 * np.sin(angle / 2.0)) ** 4 * (1.0 + 1j * beam.loss_factor)
    inertia = beam.mass_per_length * length * (2.0 + np.cos(angle)) / 3.0 * omega**2
    return complex((2.0 / N * np.sin(AT * angle) * np.sin(FROM * angle) / (stiffness - inertia)).sum())


_LOSSES = (0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 9.99)


@check("loss-factor", "loss factor", _LOSSES, 1e-12, beyond=(10.0, 1e6), refused=True)
def loss_factor(eta: float) -> float:
    """Fields of the exact beam and of segments against sums over their modes."""
    beam, hertz = replace(STRIP, loss_factor=eta), 1.37 * resonance("analytic")
    x, at = FROM * beam.length / N, AT * beam.length / N
    exact = deflection("analytic", beam, hertz, x, at) / beam_sum(beam, 2.0 * pi * hertz)
    chain = deflection("segment", beam, hertz, x, at, **LEVER) / links_sum(beam, 2.0 * pi * hertz)
    return worst(exact - 1.0, chain - 1.0)


@check("slow-drive", "f, Hz", (1e-7, 1e-9, 1e-12, 1e-30, 1e-100), 1e-12)
def slow_drive(hertz: float) -> float:
    """Cantilever's tip under a slow force against F L^3 / 3 EI, exact beam and elements."""
    length = CANTILEVER.length
    static = length**3 / (3.0 * CANTILEVER.bending_stiffness)
    return worst([deflection(m, CANTILEVER, hertz, length, length).real / static - 1.0 for m in ("analytic", "fem")])


_WAVES = (3.3, 33.3, 333.3, 3333.3, 33333.3)


@check("short-waves", "half waves", _WAVES, 2e-15, beyond=(333333.3, 1e7, 1e12), refused=True)
def short_waves(waves: float) -> float:
    """Exact field of short waves against sines of 60 digits, over what k L = 1 moves."""
    beam, x, at = replace(STRIP, length=1.0), 0.4375, 0.28125
    hertz = (waves * pi) ** 2 * beam.wave_constant / (2.0 * pi)
    k, length = (2 * PI * D(hertz) / D(beam.wave_constant)).sqrt(), D(beam.length)
    a, b, scale = D(at), D(x), 1 / (2 * D(beam.bending_stiffness) * k**3)
    running = sin(k * a) * sin(k * (length - b)) / sin(k * length)
    near = (-k * (b - a)).exp() * (1 - (-2 * k * a).exp()) * (1 - (-2 * k * (length - b)).exp())
    exact = scale * (running - near / (2 * (1 - (-2 * k * length).exp())))
    moved = k * length * scale / sin(k * length) ** 2
    return abs(deflection("analytic", beam, hertz, x, at).real - float(exact)) / float(max(abs(exact), abs(moved)))


@check("long-beam", "L, m", (1e-3, 1.0, 1e3, 1e6, 1e9), 1e-12)
def long_beam(length: float) -> float:
    """Field near the far end against its mirror image near the origin, three models."""
    beam = replace(STRIP, length=length)
    hertz = 1.37 * 9.0 * pi / 2.0 * beam.wave_constant / length**2
    x, at = 2 * length / N, 3 * length / N
    mirrored = {m: deflection(m, beam, hertz, length - x, length - at) for m in ALL}
    return worst([mirrored[m] / deflection(m, beam, hertz, x, at) - 1.0 for m in ALL])


BESIDE = (0.0, 1e-12, -3e-10, 2e-9, -1e-7, 1e-5)
"""Relative distances of the drive from resonance 7 of the bare strip."""
READ, DRIVEN, DAMPED = 0.45 * STRIP.length, 0.08 * STRIP.length, 0.19 * STRIP.length


def green(hertz: float, x: float, source: float) -> D:
    """Deflection of the pinned strip at x under a unit force, m/N."""
    k = (2 * PI * D(hertz) / D(STRIP.wave_constant)).sqrt()
    low, high = D(min(x, source)), D(STRIP.length) - D(max(x, source))
    parts: list[D] = [of(k * low) * of(k * high) / of(k * D(STRIP.length)) for of in (sin, sinh)]
    return (parts[0] - parts[1]) / (2 * D(STRIP.bending_stiffness) * k**3)


def beside_resonance() -> list[float]:
    """Hz."""
    from verify.exact.closed_forms import frequency_hz

    return [frequency_hz(STRIP, 7) * (1.0 + part) for part in BESIDE]


def read(field: Any) -> complex:
    """Deflection at the place of reading, m."""
    return complex(field.shapes(np.array([READ]), 0)[0])


@check("damped-resonance", "dashpot, N s/m", (100.0, 1.0, 1e-2, 1e-4), 1e-6, beyond=(1e-6, 1e-8))
def damped_resonance(dashpot: float) -> float:
    """Exact field of a strip with one dashpot where the bare strip resonates, against Green's function."""
    errors = []
    for hertz in beside_resonance():
        resists, own = 2 * PI * D(hertz) * D(dashpot), green(hertz, DAMPED, DAMPED)
        lost = resists * green(hertz, READ, DAMPED) * green(hertz, DAMPED, DRIVEN) / (1 + (resists * own) ** 2)
        exact = complex(float(green(hertz, READ, DRIVEN) - resists * own * lost), -float(lost))
        devices = (Device(position=DAMPED, dashpot=dashpot),)
        field = MODELS["analytic"].build(STRIP).harmonic((PointForce(position=DRIVEN),), hertz, devices=devices)
        errors.append(read(field) / exact - 1.0)
    return worst(errors)


@check("imposed-near-node", "half waves from a node", (0.3, 1e-2, 1e-3, 1e-4), 1e-7)
def imposed_near_node(off: float) -> float:
    """Exact field under a displacement imposed near a node of the bare strip's resonance, against Green's function."""
    place, errors = (3.0 + off) * STRIP.length / 7, []
    for hertz in beside_resonance():
        exact = float(green(hertz, READ, place) / green(hertz, place, place))
        drives = (PointForce(position=place),)
        field = MODELS["analytic"].build(STRIP).imposed(drives, hertz)
        errors.append(read(field) / exact - 1.0)
    return worst(errors)


def newmark_error(periods: float) -> float:
    """Relative frequency error of average acceleration in 64 steps a period, in closed form."""
    return abs(2.0 * atan(pi / 64) * 64 / (2.0 * pi) - 1.0)


_NEWMARK = ("average acceleration, 64 steps a period", newmark_error)


@check("free-vibration", "periods", (1, 1e3, 1e5, 1e7, 1e9), 1e-15, baseline=_NEWMARK)
def free_vibration_error(periods: float) -> float:
    """Mode 1 released and read at a zero crossing: the frequency error that would explain its deflection."""
    from verify.dynamics.free_vibration import free_vibration
    from verify.exact.closed_forms import frequency_hz

    hertz = frequency_hz(STRIP, 1)
    time = (periods + 0.25) / hertz
    run = free_vibration(STRIP, 1, time, amplitude=1e-3, model="analytic", modes=2, at=[0.5 * STRIP.length], samples=2)
    angle = 2 * PI * D(hertz) * D(time)
    return abs(float(D(float(run.deflection[-1, 0])) / D("1e-3") - cos(angle)) / float(angle))
