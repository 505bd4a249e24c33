"""Beams with bodies let go from shapes, sliders that come to a step, models from outside: what no scene has."""

from collections.abc import Iterator
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.models.kind import Model
from verify.models.modes import Modes
from verify.section import Section
from verify.slider import Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held

PARTS = 10
SHAPE = (0.3, -1.1, 0.7, 0.4, -0.2)
"""Shares of the first modes, sqrt(kg) m."""


def _bodies() -> Beam:
    """A cantilever with bodies that turn: on a node, next to another, within an element, at its end."""
    length = STRIP.length
    places = (0.4 * length, 0.4 * length + 2e-4, 0.531, length)
    bodies = tuple(
        PointMass(position=at, mass=0.02 * (i + 1), rotary_inertia=3e-5 * (3 - i)) for i, at in enumerate(places[:3])
    )
    return replace(held("clamped", "free"), mass=(*bodies, PointMass(position=length, mass=0.01, rotary_inertia=7e-5)))


def turned_error(pieces: float) -> float:
    """Of the modes' shares of a shape that is made of them, given as a function; of one with a corner, as lines too.

    Where a body stands on the corner both ways take the mean of the slopes on either side.
    """
    from verify.models.catalogue import MODELS
    from verify.motion.free_vibration import free_vibration

    beam, n = _bodies(), int(pieces)
    basis = MODELS["fem"].time_basis(beam, n, 4, "spline")
    share = np.append(SHAPE, np.zeros(len(basis.omegas) - len(SHAPE)))
    given: dict[str, Any] = {"model": "fem", "count": n, "samples": 2}
    found = free_vibration(beam, lambda x: 1e-3 * share @ basis.shapes(np.asarray(x), 0), 0.01, **given)
    worst = float(abs(1e3 * found.amplitudes - share).max())
    corners, heights = np.array([0.0, 0.4, 1.0]) * beam.length, np.array([0.0, 0.002, -0.001])
    lines = free_vibration(beam, (corners, heights), 0.01, **given)
    drawn = free_vibration(beam, lambda x: np.interp(x, corners, heights), 0.01, **given)
    size = float(abs(lines.amplitudes).max())
    return largest(worst, found.unread, float(abs(drawn.amplitudes - lines.amplitudes).max()) / size)


# --- Steps of a surface -----------------------------------------------------------------------------------------------

THICKER = replace(STRIP, section=(Section(length=0.2), Section(length=0.17), Section(length=0.36, thickness=0.003)))
STEP = 1e-4
WAYS = (
    (0.35, 0.9, 0.37, "came to a step of beam.section at 0.37 m"),
    (0.39, -0.7, 0.37, "came to a step of beam.section at 0.37 m"),
    (0.03, -1.1, 0.0, "left the beam"),
    (0.71, 1.3, 0.73, "left the beam"),
    (0.37 - 2e-13, 9.3, 0.73, "left the beam"),
)
"""Where a slider starts, its speed, where it ends, and why: sections of one thickness are no step.

On an edge, by rounding too, the section to its right stands."""


def step_error(number: float) -> float:
    """Of when a slider all but free of friction comes to the end of its ground, in steps; endless for another word."""
    from verify.motion.simulate import simulate

    start, speed, end, why = WAYS[int(number)]
    slider = Slider(mass=1e-6, mu=1e-12, slope=1.0, position=start, speed=speed, normal="massless", coupling="one-way")
    force = (PointForce(position=0.3, amplitude=0.0),)
    given: dict[str, Any] = {"model": "analytic", "modes": 3, "step": STEP, "samples": 400, "slider": slider}
    run = simulate(THICKER, force, 40.0, 0.0399, start="steady" if number % 2 else "rest", **given)
    if run.statistics.stopped != why:
        return float("inf")
    last, due = float(run.end.position or 0.0), (end - start) / speed
    off = abs(float(run.times[-1]) + (end - float(run.position[-1])) / speed - due)
    return largest(abs(last - end) / (abs(speed) * STEP), 1e9 * off / due)


def _loops() -> Iterator[Call]:
    from verify.motion.warm import on_beam

    return on_beam("tanh", "one-way")


# --- A model from outside ---------------------------------------------------------------------------------------------


class Sine(Model):
    """Modes of a pinned beam, each two per cent too high."""

    name, parts, title = "sine", "sines", "Sines"

    def refuses(self, beam: Beam) -> str:
        """Of other ends."""
        return "" if beam.supports == ("pinned", "pinned") else "its sines fit pinned ends alone"

    def solve_modes(self, beam: Beam, n_modes: int, count: int, **settings: Any) -> Modes:
        """By closed form."""
        self.check(beam, n_modes, count)
        n = np.arange(1.0, n_modes + 1.0)[:, None]
        size = sqrt(2.0 / (beam.mass_per_length * beam.length))

        def shapes(x: Array, derivative: int) -> Array:
            k = pi * n / beam.length
            return np.asarray(size * k**derivative * np.sin(k * x + 0.5 * pi * derivative))

        hertz = 1.02 * n[:, 0] ** 2 * 0.5 * pi * beam.wave_constant / beam.length**2
        return Modes.of_shapes(self.name, count, hertz, np.linspace(0.0, beam.length, count + 1), shapes)


def outside_error(count: float) -> float:
    """Of what a model that has modes alone says of itself, and of what its modes are at places."""
    model, parts = Sine(), int(count)
    found, x = model.solve_modes(STRIP, 3, parts), np.array([0.13, 0.61])
    wave, line = pi / STRIP.length, np.linspace(0.0, STRIP.length, parts + 1)
    size = sqrt(2.0 / (STRIP.mass_per_length * STRIP.length))
    pairs: list[tuple[Any, Any]] = [
        (found.deflection(x)[1], size * np.sin(2.0 * wave * x)),
        (found.slope(x)[2], size * 3.0 * wave * np.cos(3.0 * wave * x)),
        (found.curvatures()[0][1:-1], -size * wave**2 * np.sin(wave * line[1:-1])),
        (found.sampled()[2], size * np.sin(3.0 * wave * line)),
        (found.readings["shapes"]()[0], size * np.sin(wave * line)),
        (found.curvature_points, line),
        (model.n_elastic(held("free", "free"), parts), model.unknowns_per_part * parts - 2),
        (model.wavenumber(STRIP, parts, 41.7).real, sqrt(2.0 * pi * 41.7 / STRIP.wave_constant)),
        (model.method(STRIP, 1, parts) == "Sines", 1.0),
        (model.order(STRIP) is None, 1.0),
        (found.length, STRIP.length),
    ]
    worst = max(float(abs(np.asarray(a) - b).max() / abs(np.asarray(b)).max()) for a, b in pairs)
    most = model.n_elastic(STRIP, parts)
    refused = (_said(model, most + 1, parts), _said(model, most, parts))
    return worst + (refused != (f"mode = {most + 1}", ""))


def _said(model: Model, n_modes: int, count: int) -> str:
    """How the sentence of a refusal begins; nothing where it is taken."""
    try:
        model.check(STRIP, n_modes, count)
    except InputError as error:
        return str(error).split(":")[0]
    return ""


def slope_error(hertz: float) -> float:
    """Of (kL)^2 <theta^2> of a field between pins, from the sines and hyperbolic sines of its two sides."""
    from verify.exact.harmonic import solve_harmonic
    from verify.motion.validity import field_size

    at, newton, length = 0.31, 1.7, STRIP.length
    k, x = sqrt(2.0 * pi * hertz / STRIP.wave_constant), np.linspace(0.0, length, 40_001)[1::2]
    near, far = np.where(x < at, x, length - x), np.where(x < at, length - at, at)
    round_, flat = (
        of(k * near) * to(k * far) / whole
        for of, to, whole in ((np.cos, np.sin, np.sin(k * length)), (np.cosh, np.sinh, np.sinh(k * length)))
    )
    slopes = newton / (2.0 * STRIP.bending_stiffness * k**2) * (round_ - flat)
    exact = (k * length) ** 2 * 0.5 * float((slopes**2).mean())
    field = solve_harmonic(STRIP, (PointForce(position=at, amplitude=newton),), hertz)
    return abs(field_size(field) / exact - 1.0)


ROWS: tuple[Row, ...] = (
    Floor(
        id="bodies-that-turn-with-a-shape",
        title="Shares of modes in a shape given as a function, bodies on the beam turning with it; one with a corner",
        why="motion/free_vibration.py: slopes of a cubic from five values 4e-4 m apart at most, rounding over that.",
        along="elements",
        at=(10.0,),
        promise=1e-10,
        error=turned_error,
    ),
    Floor(
        id="steps-of-a-surface",
        title="When a slider comes to a step of the surface or leaves the beam, in steps of time",
        why="motion/surface.py, models/underfoot.py: at the end of the step before; sections as thick are no step.",
        along="run",
        at=(0.0, 1.0, 2.0, 3.0, 4.0),
        promise=1.0,
        error=step_error,
        kernels=_loops,
    ),
    Floor(
        id="a-model-from-outside",
        title="What a model with modes alone says of itself, and its modes at places",
        why="models/kind.py, models/modes.py: closed forms read as they are given.",
        along="parts",
        at=(7.0, 12.0),
        promise=1e-12,
        error=outside_error,
    ),
    Floor(
        id="slopes-of-a-field",
        title="How nonlinear a chain is under a field: its slopes' mean square, against Green's function",
        why="motion/validity.py: a mean over 400 places, ends included, is off by a part of a four hundredth.",
        along="Hz",
        at=(131.0, 1731.0),
        promise=3e-3,
        error=slope_error,
    ),
)
