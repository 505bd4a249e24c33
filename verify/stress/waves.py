"""Checks of driven fields (close to resonance, damped, slow, short waves, long beams) and of free vibration."""

from math import atan, pi

import numpy as np
from msgspec.structs import replace

from verify.dynamics.free_vibration import free_vibration
from verify.exact.error_laws import dispersion_frequency_hz
from verify.linear.registry import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.stress.engine import check, worst
from verify.stress.reference import ALL, CANTILEVER, PI, STRIP, D, cos, pinned_hertz, sin, sinh

N, MODE = 40, 3
AT, FROM = 11, 17  # joints at which the field is evaluated and driven


def deflection(model: str, beam: Beam, hertz: float, x: float, at: float, **more: str) -> complex:
    """Deflection at `at` under a unit force at x, m."""
    count = None if model == "analytic" else N
    field = MODELS[model].build(beam, count, **more).harmonic((PointForce(position=x),), hertz)
    return complex(field.deflection([at])[0])


def green(beam: Beam, hertz: float, x: float, source: float) -> D:
    """Deflection of a pinned beam at x under a unit force, m/N."""
    k = (2 * PI * D(hertz) / D(beam.wave_constant)).sqrt()
    low, high = D(min(x, source)), D(beam.length) - D(max(x, source))
    parts: list[D] = [of(k * low) * of(k * high) / of(k * D(beam.length)) for of in (sin, sinh)]
    return (parts[0] - parts[1]) / (2 * D(beam.bending_stiffness) * k**3)


@check("near-resonance", "f / fn - 1", (1e-6, 1e-7, 1e-8, 3e-9), 1e-13, beyond=(1e-9, 1e-10, 1e-12), refused=True)
def near_resonance(distance: float) -> float:
    """Undamped field near a resonance, three models: equivalent frequency error."""
    errors = []
    for model in ALL:
        exact = model == "analytic"
        hertz = float(pinned_hertz(STRIP, MODE)) if exact else dispersion_frequency_hz(model, STRIP, MODE, N)
        shifts = hertz * (1.0 + np.array([1e-5, -1e-5, distance, -distance]))
        up, down, *real = shifts / hertz - 1.0
        ends = FROM * STRIP.length / N, AT * STRIP.length / N
        above, below, *fields = (deflection(model, STRIP, driven, *ends).real for driven in shifts)
        # the field is r / d + s near d = 0: values at +-1e-5 give r and s, to 1e-10 of the field at 1e-9
        residue = (above - below) / (1.0 / up - 1.0 / down)
        for d, field in zip(real, fields, strict=True):
            errors.append(d * (field / (residue / d + above - residue / up) - 1.0))
    return worst(errors)


@check("slow-drive", "f, Hz", (1e-7, 1e-9, 1e-12, 1e-30, 1e-100), 1e-12)
def slow_drive(hertz: float) -> float:
    """Cantilever's tip under a slow force against F L^3 / 3 EI, exact beam and elements."""
    length = CANTILEVER.length
    static = length**3 / (3.0 * CANTILEVER.bending_stiffness)
    return worst([deflection(m, CANTILEVER, hertz, length, length).real / static - 1.0 for m in ("analytic", "fem")])


_WAVES = (3.3, 33.3, 333.3, 3333.3, 33333.3)


@check("short-waves", "half waves", _WAVES, 2e-15, beyond=(333333.3, 1e7, 1e12), refused=True)
def short_waves(waves: float) -> float:
    """Exact field of short waves against sines of 60 digits, over the deflection for k L = 1."""
    beam, x, at = replace(STRIP, length=1.0), 0.4375, 0.28125
    hertz = (waves * pi) ** 2 * beam.wave_constant / (2.0 * pi)
    k, field = (2 * PI * D(hertz) / D(beam.wave_constant)).sqrt(), deflection("analytic", beam, hertz, x, at)
    exact, moved = green(beam, hertz, at, x), 1 / (2 * D(beam.bending_stiffness) * k**2 * sin(k) ** 2)
    return abs(field.real - float(exact)) / float(max(abs(exact), abs(moved)))


READ, DRIVEN, DAMPED = 0.45 * STRIP.length, 0.08 * STRIP.length, 0.19 * STRIP.length


@check("damped-resonance", "dashpot, N s/m", (100.0, 1.0, 1e-2, 1e-4), 1e-6, beyond=(1e-6, 1e-8))
def damped_resonance(dashpot: float) -> float:
    """Exact field of a strip with a dashpot at and near resonance 7 without it, against Green's function."""

    def exact(hertz: float) -> complex:
        resists, own = 2 * PI * D(hertz) * D(dashpot), green(STRIP, hertz, DAMPED, DAMPED)
        lost = resists * green(STRIP, hertz, READ, DAMPED) * green(STRIP, hertz, DAMPED, DRIVEN)
        lost /= 1 + (resists * own) ** 2
        return complex(float(green(STRIP, hertz, READ, DRIVEN) - resists * own * lost), -float(lost))

    force, devices = (PointForce(position=DRIVEN),), (Device(position=DAMPED, dashpot=dashpot),)
    drives = [float(pinned_hertz(STRIP, 7)) * (1.0 + part) for part in (0.0, 1e-12, -3e-10, 2e-9, -1e-7, 1e-5)]
    fields = [MODELS["analytic"].build(STRIP).harmonic(force, hertz, devices=devices) for hertz in drives]
    values = [field.shapes(np.array([READ]), 0)[0] for field in fields]
    return worst([value / exact(hertz) - 1.0 for value, hertz in zip(values, drives, strict=True)])


_NEWMARK = ("average acceleration, 64 steps a period", lambda periods: abs(atan(pi / 64) * 64 / pi - 1.0))


@check("free-vibration", "periods", (1, 1e3, 1e5, 1e7, 1e9), 1e-15, baseline=_NEWMARK)
def free_vibration_error(periods: float) -> float:
    """Mode 1 released, at a zero crossing: equivalent frequency error of its deflection."""
    hertz = float(pinned_hertz(STRIP, 1))
    time = (periods + 0.25) / hertz
    run = free_vibration(STRIP, 1, time, amplitude=1e-3, model="analytic", modes=2, at=[0.5 * STRIP.length], samples=2)
    angle = 2 * PI * D(hertz) * D(time)
    return abs(float(D(float(run.deflection[-1, 0])) / D("1e-3") - cos(angle)) / float(angle))
