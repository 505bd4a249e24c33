"""Readings of modes, fields and waves that no scene takes: derivatives of every model, ellipses seen in time, gaps."""

from functools import partial
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held

PARTS, STEP = 11, 1e-6
PLACES = np.array([0.031, 0.163, 0.292, 0.41, 0.577, 0.68])
"""Metres, none of them on a node."""
SETTINGS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("segment", {}),
    ("segment", {"theory": "timoshenko", "joints": "tensioned"}),
    ("fem", {}),
    ("fem", {"theory": "timoshenko"}),
    ("analytic", {}),
    ("analytic", {"theory": "timoshenko"}),
)


def derivatives_error(derivative: float) -> float:
    """Of a derivative of modes and of a field of every model, by both theories, against differences of the last one."""
    from verify.models.catalogue import MODELS

    d, worst, beam = int(derivative), 0.0, replace(STRIP, supports=("clamped", "free"), loss_factor=0.02)
    forces = (PointForce(position=0.23, phase_deg=40.0),)
    for model, given in SETTINGS:
        count, theory = (None if model == "analytic" else PARTS), {k: v for k, v in given.items() if k == "theory"}
        modes = MODELS[model].solve_modes(replace(beam, loss_factor=0.0), 3, PARTS, **given)
        field = MODELS[model].solve_harmonic(beam, forces, 131.0, count, **theory)
        for shapes in (modes.shapes, field.shapes):
            found, before = (shapes(PLACES + side * STEP, d - 1) for side in (1.0, -1.0))
            exact = (found - before) / (2.0 * STEP)
            worst = largest(worst, float(abs(shapes(PLACES, d) - exact).max() / abs(exact).max()))
    return worst


FREE: tuple[Beam, ...] = (
    replace(held("free", "free"), mass=(PointMass(position=0.0, mass=0.03, rotary_inertia=2e-5),)),
    replace(held("pinned", "free"), mass=(PointMass(position=0.29, mass=0.05),)),
    replace(held("guided", "free"), mass=(PointMass(position=0.73, mass=0.02),)),
)


def free_error(number: float) -> float:
    """Of modes 1 and 3 of links and elements that drift off with what they carry, over their turn a part ^4."""
    from verify.judge.workbench import Workbench

    bench, n = Workbench(FREE[int(number)]), 24
    errors = [abs(bench.frequency_error(model, n, mode)) for model in ("segment", "fem") for mode in (1, 3)]
    return largest(error / ((1 + mode) * pi / n) ** 4 for error, mode in zip(errors, (1, 3, 1, 3), strict=True))


def ellipses_error(places: float) -> float:
    """Of ellipses and areas of two waves seen in time, by the paths of the surface's points."""
    from verify.waves.series import measure_series

    hertz, forward, backward = 370.0, 1.3e-6, 0.4e-6
    omega, k = 2.0 * pi * hertz, sqrt(2.0 * pi * hertz / STRIP.wave_constant)
    times, x = np.linspace(0.0, 3.0 / hertz, 91)[:-1, None], np.linspace(0.1, 0.6, int(places))
    values = forward * np.cos(omega * times - k * x) + backward * np.cos(omega * times + k * x + 0.7)
    found = measure_series(STRIP, x, times[:, 0], values, hertz, k)
    sent, back = forward * np.exp(-1j * k * found.x), backward * np.exp(1j * (k * found.x + 0.7))
    up, across = sent + back, -STRIP.surface_distance * 1j * k * (back - sent)
    area = 2.0 * (np.conj(across) * up).imag
    total = abs(across) ** 2 + abs(up) ** 2
    tilt = 0.5 * np.arctan2(2.0 * (np.conj(across) * up).real, abs(across) ** 2 - abs(up) ** 2)
    pairs = [(found.signed_area, area), (found.axis_ratio, np.tan(0.5 * np.arcsin(area / total)))]
    off = [float(abs(a - b).max() / abs(b).max()) for a, b in pairs]
    turned = np.deg2rad(found.tilt_deg) - tilt
    return largest(
        *off, float(abs(np.sin(turned)).max()), abs(found.ideal_axis_ratio / (k * STRIP.surface_distance) - 1.0)
    )


def gaps_error(share: float) -> float:
    """How often a map over imposed displacements has a figure where the held beam resonates, or none beside it."""
    from verify.exact.harmonic import unit_responses
    from verify.stress.waves.closed_forms import held_resonance
    from verify.waves.imposed import held_units

    at, x = np.array([0.3]), np.array([0.11, 0.55])
    hertz = held_resonance() * np.array([1.0, 1.0 + share, 1.0 - share])
    found = held_units(partial(unit_responses, STRIP), at, STRIP, hertz, x)
    return float(np.isfinite(found[0]).any()) + float(not np.isfinite(found[1:]).all())


LOSSY: tuple[tuple[Beam, dict[str, Any]], ...] = (
    (replace(STRIP, spring=(PointSpring(position=0.73, rotational=9.0),), tension=30.0), {}),
    (replace(STRIP, spring=(PointSpring(position=0.0, rotational=4.0),)), {"joints": "tensioned"}),
    (replace(held("clamped", "free"), tension=60.0, foundation=300.0), {"joints": "tensioned"}),
)


def lossy_error(parts: float) -> float:
    """Of fields of links whose beam loses much, and whose springs, ground and tension lose nothing, by exact ones."""
    from verify.exact.harmonic import solve_harmonic
    from verify.models.catalogue import MODELS

    worst, forces = 0.0, (PointForce(position=0.23, phase_deg=40.0),)
    for beam, given in LOSSY:
        lossy = replace(beam, loss_factor=0.3)
        exact = solve_harmonic(lossy, forces, 31.0).deflection(PLACES)
        found = MODELS["segment"].solve_harmonic(lossy, forces, 31.0, int(parts), **given).deflection(PLACES)
        worst = largest(worst, float(abs(found - exact).max() / abs(exact).max()) * parts**2)
    return worst


def devices_error(stiffness: float) -> float:
    """How often a beam is driven where it resonates with its device, and not where it does alone; field there."""
    from scipy.optimize import brentq

    from verify.device import Device
    from verify.errors import ResonanceError
    from verify.judge.workbench import Workbench
    from verify.waves.case import DrivenCase
    from verify.waves.driven import driven

    device, wrong = Device(position=0.2, stiffness=stiffness), 0

    def receptance(hertz: float) -> float:
        k = sqrt(2.0 * pi * hertz / STRIP.wave_constant)
        parts = [of(k * 0.2) * of(k * (STRIP.length - 0.2)) / of(k * STRIP.length) for of in (np.sin, np.sinh)]
        return float((parts[0] - parts[1]) / (2.0 * STRIP.bending_stiffness * k**3)) * stiffness + 1.0

    first, second = (pi * STRIP.wave_constant / (2.0 * STRIP.length**2) * n**2 for n in (1.0, 2.0))
    both = float(brentq(receptance, 1.0001 * first, 0.9999 * second, xtol=1e-13, rtol=1e-15))
    for hertz, refused in ((both, True), (first, False), (1.01 * both, False)):
        case = DrivenCase(
            beam=STRIP,
            model="analytic",
            count=None,
            forces=(PointForce(position=0.05), PointForce(position=0.6, phase_deg=80.0)),
            frequency_hz=hertz,
            devices=(device,),
        )
        try:
            field = driven(case, Workbench(STRIP))
            wrong += refused or not np.isfinite(field.deflection([0.31])).all()
        except ResonanceError as error:
            wrong += not refused or "with devices" not in str(error)
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="derivatives-by-differences",
        title="Derivatives of modes and fields of every model by two theories, against differences",
        why="segments/reading.py, elements/shear.py, exact: differences over a micrometre leave their rounding.",
        along="derivative",
        at=(1, 2),
        promise=1e-8,
        error=derivatives_error,
    ),
    Floor(
        id="beams-that-drift",
        title="Modes 1 and 3 of beams that drift off with what they carry, by links and elements, over their turn ^4",
        why="segments/loaded.py, elements/pencil.py: rigid motions leave no share in others.",
        along="beam",
        at=(0, 1, 2),
        promise=0.004,
        error=free_error,
    ),
    Floor(
        id="ellipses-seen-in-time",
        title="Ellipses of the surface's points under two waves seen in time, their tilts and areas",
        why="waves/measures.py: Stokes's parameters of two phasors.",
        along="places",
        at=(9, 33),
        promise=1e-9,
        error=ellipses_error,
    ),
    Floor(
        id="gaps-of-maps",
        title="Figures of a map where the held beam resonates, and gaps beside it",
        why="waves/imposed.py: none there, and all of them a millionth beside.",
        along="relative",
        at=(1e-6, 1e-3),
        promise=0.5,
        error=gaps_error,
    ),
    Floor(
        id="losses-of-the-beam-alone",
        title="Fields of links whose beam loses 0.3 and whose end springs, ground and tension lose nothing, times N^2",
        why="segments/loaded.py: what is part of a joint and no beam has no loss; tension leaves order 2.",
        along="parts",
        at=(20, 40),
        promise=0.4,
        error=lossy_error,
    ),
    Floor(
        id="resonances-with-devices",
        title="Drives on a resonance of beam and spring, and on one of the beam alone",
        why="waves/driven.py: refused with the device's place; the beam's own resonance is none then.",
        along="N/m",
        at=(3000.0,),
        promise=0.5,
        error=devices_error,
    ),
)
