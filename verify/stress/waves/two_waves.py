"""Verbs asked as users ask them, by closed forms: two waves measured whole, sweeps about resonances, bodies at ends."""

from collections.abc import Callable
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import PointForce
from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held

# --- Two waves --------------------------------------------------------------------------------------------------------

HERTZ, BEGIN = 2300.0, 0.11
AMPLITUDES: tuple[tuple[complex, complex], ...] = (
    (1.3e-6 - 0.4e-6j, 0.3e-6 + 0.5e-6j),
    (0.2e-6j, -0.9e-6 + 0.1e-6j),
    (0.7e-6 + 0j, 0j),
)
"""Of e^{-ikx} and e^{+ikx} at the middle of the window, metres."""
NEAR = 1.023
"""Times the beam's own wavenumber: that of the field."""


def _two(forward: complex, backward: complex, k: float, middle: float, count: int | None) -> Any:
    from verify.models.fields import HarmonicField

    def shapes(x: Array, derivative: int) -> ComplexArray:
        ahead, back = np.exp(-1j * k * (x - middle)), np.exp(1j * k * (x - middle))
        return np.asarray((-1j * k) ** derivative * forward * ahead + (1j * k) ** derivative * backward * back)

    model, forces = "analytic" if count is None else "fem", (PointForce(position=0.01),)
    return HarmonicField(model=model, count=count, beam=STRIP, frequency_hz=HERTZ, forces=forces, shapes=shapes)


def _ellipses(k: float, x: Array, forward: complex, backward: complex) -> tuple[Array, Array]:
    """(axis ratio, signed area) of the paths of points x beside the middle, by their two axes."""
    up = forward * np.exp(-1j * k * x) + backward * np.exp(1j * k * x)
    across = STRIP.surface_distance * 1j * k * (forward * np.exp(-1j * k * x) - backward * np.exp(1j * k * x))
    ahead, behind = abs(across - 1j * up), abs(across + 1j * up)  # twice the circles that a path is made of
    return (ahead - behind) / (ahead + behind), 2.0 * (np.conj(across) * up).imag


def _weighed_error() -> float:
    """Of the travelling index of uneven points, by the roots of its Gram matrix."""
    from verify.waves.measures import travelling_index

    weights, values = np.array([0.2, 1.7, 0.4, 3.1]), np.array([1.0 + 2.0j, -0.3 + 0.4j, 2.0 - 1.1j, 0.6j])
    one, other, mixed = (float(weights @ part) for part in (values.real**2, values.imag**2, values.real * values.imag))
    half, apart = 0.5 * (one + other), float(np.hypot(0.5 * (one - other), mixed))
    nothing = travelling_index(np.zeros(4, dtype=complex), weights)
    return abs(travelling_index(values, weights) / sqrt((half - apart) / (half + apart)) - 1.0) + nothing


def _standing(k: float, window: tuple[float, float], middle: float) -> bool:
    """Whether a wave that stands is told so, and a field of parts is looked at eight times in each."""
    from verify.errors import StandingError
    from verify.waves.measures import _seen, measure, measured_figure

    even, parts = _two(1e-6, 1e-6j, k, middle, 400), 8.0 * 400 * (window[1] - window[0]) / STRIP.length
    asks: tuple[Callable[[], float], ...] = (
        lambda: measure(even, window, k).signed_area_spread,
        lambda: measured_figure(even, window, k, "signed_area_spread"),
    )
    for ask in asks:
        try:
            ask()
        except StandingError:
            continue
        return False
    return len(_seen(even, window, k).fine) == int(parts) + 1


def measured_error(halves: float) -> float:
    """Of all measures of two waves, of exact fields and of parts, their wavenumber stated or not.

    Over whole half waves Re w and Im w have the singular values |A+| + |A-| and their difference.
    """
    from verify.waves.measures import measure, measured_figure

    k, omega, worst = NEAR * sqrt(2.0 * pi * HERTZ / STRIP.wave_constant), 2.0 * pi * HERTZ, _weighed_error()
    window = (BEGIN, BEGIN + halves * pi / k)
    middle, whole = 0.5 * (window[0] + window[1]), int(halves) * pi / k
    even = whole * ((np.arange(4096) + 0.5) / 4096 - 0.5)
    for (forward, backward), count in zip(AMPLITUDES, (None, 40, None), strict=True):
        field, sizes = _two(forward, backward, k, middle, count), (abs(forward), abs(backward))
        found = measure(field, window, k if count is None else None)
        gamma, apart = min(sizes) / max(sizes), sizes[0] ** 2 - sizes[1] ** 2
        ratio, area = _ellipses(k, found.x - middle, forward, backward)
        ratios, areas = _ellipses(k, even, forward, backward)
        crest = -omega * STRIP.surface_distance * k * apart / sqrt(sizes[0] ** 2 + sizes[1] ** 2)
        pairs = [
            (found.waves.wavenumber, k),
            (found.waves.forward, forward),
            (found.envelope + 1.0, gamma + 1.0),
            (found.travelling_index, (1.0 - gamma) / (1.0 + gamma)),
            (found.waves.reflection + 1.0, gamma + 1.0),
            (found.waves.standing_wave_ratio, (1.0 + gamma) / (1.0 - gamma)),
            (found.mean_axis_ratio, ratios.mean()),
            (found.axis_ratio, ratio),
            (found.signed_area, area),
            (found.signed_area_range[1], areas.mean() if halves == int(halves) else found.signed_area_range[1]),
            (found.signed_area_range[0], areas.min()),
            (found.signed_area_range[2], areas.max()),
            (found.crest_speed, crest),
            (found.energy_flux, STRIP.bending_stiffness * k**3 * omega * apart),
            (found.ideal_axis_ratio, k * STRIP.surface_distance),
            (measured_figure(field, window, k, "travelling_index"), found.travelling_index),
        ]
        worst = largest(worst, *(float(np.max(abs(np.asarray(a) - b)) / np.max(abs(np.asarray(b)))) for a, b in pairs))
        worst = largest(worst, abs(found.waves.backward - backward) / sizes[0] * (sizes[1] > 0.0), found.waves.residual)
    return largest(worst, float(not _standing(k, window, middle)))


# --- Sweeps -----------------------------------------------------------------------------------------------------------

PUSH = (PointForce(position=0.21, amplitude=1.7, phase_deg=20.0),)
PARTS, OFF = 12, 0.03
"""OFF: of the distance within which a resonance is refused."""


def _refusal(ask: Callable[[], object]) -> str:
    try:
        ask()
    except InputError as error:
        return str(error)
    return ""


def swept_error(mode: float) -> float:
    """How often few and many frequencies, one just off a resonance of links, elements or the beam, are not refused.

    Or refused where they should be taken, or not by the index, the mode and the resonance.
    """
    from verify.models.catalogue import MODELS

    wrong, n = 0, int(mode)
    for model, count in (("segment", PARTS), ("fem", PARTS), ("analytic", None)):
        own = MODELS[model].solve_modes(STRIP, n + 1, PARTS).frequencies_hz[n - 1]
        for others in (2, 6):
            for part in (-1.0 - OFF, -1.0 + OFF, 1.0 - OFF, 1.0 + OFF):
                hertz = own * np.array([1.0 + part * 1e-9, *np.linspace(0.83, 1.19, others)])[::-1]
                said = _refusal(lambda: MODELS[model].sweep_harmonic(STRIP, PUSH, hertz, count))  # noqa: B023
                words = (f"frequencies_hz[{others}] = ", f"resonance of mode {n} of the {model} model")
                wrong += bool(said) is not (abs(part) < 1.0) or (bool(said) and not all(one in said for one in words))
        for part in (-1.0 + OFF, 1.0 - OFF):
            said = _refusal(lambda: MODELS[model].solve_harmonic(STRIP, PUSH, own * (1.0 + part * 1e-9), count))  # noqa: B023
            wrong += f"of mode {n} of the {model} model" not in said or "frequency_hz = " not in said
            resonance = said.partition("model at ")[2].partition(" Hz")[0]
            wrong += not resonance or not abs(float(resonance) / own - 1.0) <= 1e-12
    return float(wrong)


# --- Bodies -----------------------------------------------------------------------------------------------------------

CROWDS = (0.02, 0.06, 0.065, 0.41, 0.69, 0.712)
"""Metres: beside both ends, next to each other, alone."""
PAIRS = (
    ("pinned", "free"),
    ("guided", "pinned"),
    ("free", "guided"),
    ("clamped", "guided"),
    ("clamped", "clamped"),
    ("pinned", "pinned"),
)


def crowded_error(links: float) -> float:
    """Of modes 1 to 3 of links with heavy bodies beside their ends and each other, over their turn a link ^4."""
    from verify.models.catalogue import MODELS

    n, worst = int(links), 0.0
    for pair in PAIRS:
        bodies = tuple(
            PointMass(position=at, mass=0.02 * (1.0 + i), rotary_inertia=1e-5 * (3.0 + i))
            for i, at in enumerate(CROWDS)
        )
        beam = replace(held(*pair), mass=bodies)
        exact, found = (MODELS[m].solve_modes(beam, 3, n).frequencies_hz for m in ("analytic", "segment"))
        off = abs(np.asarray(found) / np.asarray(exact) - 1.0)
        worst = largest(worst, float((off / (np.arange(2.0, 5.0) * pi / n) ** 4).max()))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="two-waves-measured-whole",
        title="Every measure of two waves, of an exact field and of parts, over whole half waves and more",
        why="waves/measures.py: closed forms of two waves, to what a search for extremes leaves.",
        along="half waves",
        at=(5.0, 7.0, 6.3),
        promise=1e-10,
        error=measured_error,
    ),
    Floor(
        id="resonances-in-sweeps-of-parts",
        title="Few and many frequencies of every model, one just within or without 1e-9 of a resonance",
        why="models/sweeps.py, driven_pencil.py: refused by index, mode and resonance.",
        along="mode",
        at=(1.0, 4.0),
        promise=0.5,
        error=swept_error,
    ),
    Floor(
        id="crowds-beside-all-ends",
        title="Heavy bodies beside both ends of a chain and each other, between six pairs of supports: modes 1 to 3",
        why="segments/crowded.py: order 4 in a link, as bodies alone.",
        along="links",
        at=(24.0, 40.0),
        promise=0.0025,
        error=crowded_error,
    ),
)
