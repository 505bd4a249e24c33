"""Operating points of a drive: frequency of least reflection, and largest crest speed with limited reflection."""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError, NoFigureError
from verify.linear.field import phasor
from verify.waves.driven_case import DrivenCase, unit_waves
from verify.waves.two_waves import Waveguide, minimum_near, reflections
from verify.waves.window import Window, middle_half

SEARCH_SPAN = 0.015  # Half width of the frequency search, relative to the drive's frequency
PHASES_DEG = (5.0, 175.0)  # Range of the search in |phase| between the two forces, degrees
EXCESS, POINTS = 1.1, 801
"""Of a band: standing-wave ratio at its ends over the least, number of frequencies between which it is interpolated."""
ROUNDING = 1e-13  # Excess of a reflection over its limit that is rounding
_ZOOM, _LEVELS, _SHARP = 17, 13, 1e-12
"""Points per refinement, number of refinements in phase (to 1e-12 rad), last relative interval in frequency."""


class OperatingPoint(msgspec.Struct, frozen=True, kw_only=True):
    """Operating point of a drive of two actuators."""

    frequency_hz: float
    phase_deg: float
    """Phase lead of the second force."""
    reflection: float
    crest_speed: float
    """m/s, with the force amplitudes of the case."""
    at_edge: bool
    """Whether the crest speed still rises at the edge of the frequency search."""


def best_frequency(case: DrivenCase, span: float = SEARCH_SPAN, window: Window | None = None) -> float:
    """Frequency of least reflection within `span` (relative) of the drive's frequency, Hz, to 1e-5 Hz.

    Raises InputError for a minimum at the edge of the search, and for a standing wave at all frequencies.
    """
    grid = np.linspace(1.0 - span, 1.0 + span, 41) * case.frequency_hz
    least = minimum_near(lambda at: _reflection(case, at, window), grid, 1e-5)
    if least.value > 1.0 - 1e-6:
        low, high = ((1.0 + side * span) * case.frequency_hz for side in (-1, 1))
        raise InputError(
            f"phase_deg: with this phase between the forces the wave is standing at every frequency from {low:.6g} to "
            f"{high:.6g} Hz, choose another phase_deg"
        )
    if least.at_edge:
        raise InputError(
            f"span = {span!r}: the reflection still falls at the edge of the search, {least.x:.6g} Hz, give "
            f"wave.best_frequency span={min(4.0 * span, 0.45):g}, or another frequency_hz"
        )
    return least.x


def _reflection(case: DrivenCase, at: Array, window: Window | None) -> Array:
    """Reflection of the case's wave at frequencies, (n,), Hz."""
    drives = np.array([[phasor(force)] for force in case.acting])
    try:
        waves = unit_waves(case, at, window or middle_half(case.beam)).superposed(drives)
    except NoFigureError:
        if len(at) > 1:
            raise
        return np.ones(1)
    return np.nan_to_num(reflections(*waves)[:, 0], nan=1.0)  # standing wave at a resonance


def frequency_band(
    case: DrivenCase, limit: float | None = None, span: float = SEARCH_SPAN, window: Window | None = None
) -> tuple[float, float]:
    """Frequencies around the best between which the standing-wave ratio is at most `limit`, Hz.

    Default: 1.1 times the least. Raises InputError as `best_frequency`, and for a limit that the wave does not cross.
    """
    best = best_frequency(case, span, window)
    at = best + span * case.frequency_hz * np.linspace(-1.0, 1.0, POINTS)
    gammas, middle = _reflection(case, at, window), POINTS // 2
    ratio = (1.0 + gammas[middle]) / (1.0 - gammas[middle])
    most = EXCESS * ratio if limit is None else limit
    level = (most - 1.0) / (most + 1.0)
    below, above = (np.flatnonzero(side > level) for side in (gammas[middle::-1], gammas[middle:]))
    if level <= gammas[middle] or not len(below) or not len(above):
        least = f"the least standing-wave ratio is {ratio:.5g}, raise it"
        reason = least if most <= ratio else f"no ratio within span = {span!r} is above, lower it or raise span"
        raise InputError(f"limit = {most:.5g}: {reason}")
    i, j = middle - int(below[0]), middle + int(above[0])
    low, high = (np.interp(level, gammas[rows], at[rows]) for rows in ([i + 1, i], [j - 1, j]))
    return float(low), float(high)


def check_two(case: DrivenCase) -> None:
    """Raise InputError unless the case has two forces and no active device."""
    if len(case.forces) != 2:
        raise InputError(f"drive.force has {len(case.forces)} forces: give two, with a phase between them")
    if len(case.acting) > 2:
        raise InputError("drive.device.amplitude is a third force: leave it out for a phase between two forces")


def lead_deg(case: DrivenCase) -> float:
    """Phase lead of the second force, in (-180, 180] degrees."""
    return 180.0 - (180.0 - (case.forces[1].phase_deg - case.forces[0].phase_deg)) % 360.0


def maximum_crest_speed(case: DrivenCase, limit: float, span: float = SEARCH_SPAN) -> OperatingPoint:
    """Largest crest speed in the middle half with reflection up to `limit` under two forces of constant amplitude.

    Searched over frequencies within `span` (relative) of the drive's and phases of 5 to 175 degrees with the sign of
    the case. Raises InputError without two forces, and where the reflection exceeds the limit at all points.
    """
    check_two(case)
    first, second = (force.amplitude for force in case.forces)
    ends = np.copysign(np.deg2rad(PHASES_DEG), lead_deg(case) or 1.0)
    guide = Waveguide(case.beam, case.model.theory)
    edges = (1.0 - span) * case.frequency_hz, (1.0 + span) * case.frequency_hz
    at = np.linspace(*edges, 121)
    # grids around the best point, each eight times finer: no derivatives, since the best point is often a corner at
    # which the reflection reaches its limit; points beyond the limit are ranked by their reflection
    while True:
        waves, rows = unit_waves(case, at, middle_half(case.beam)), np.arange(len(at))
        omega, phases = 2.0 * np.pi * at[:, None], np.tile(np.linspace(ends[0], ends[1], 171), (len(at), 1))
        for _ in range(_LEVELS):
            drives = np.stack([np.full_like(phases, first), second * np.exp(1j * phases)], axis=1)
            forward, backward = waves.superposed(drives)
            gammas = reflections(forward, backward)
            speeds = guide.crest_speed(omega, waves.k[:, None], forward, backward)
            ranks = np.nan_to_num(np.where(gammas <= limit + ROUNDING, abs(speeds), -gammas), nan=-1.0)
            best = ranks.argmax(axis=1)
            phase, gamma, speed, rank = (values[rows, best] for values in (phases, gammas, speeds, ranks))
            low, high = (phases[rows, (best + side).clip(0, phases.shape[1] - 1)] for side in (-1, 1))
            phases = np.linspace(low, high, _ZOOM, axis=1)
        i = int(rank.argmax())
        below, above = at[max(i - 1, 0)], at[min(i + 1, len(at) - 1)]
        if above - below <= _SHARP * above:
            break
        at = np.linspace(below, above, _ZOOM)
    if rank[i] < 0.0:
        raise InputError(f"limit = {limit!r}: the reflection near the drive's frequency is larger, raise it")
    return OperatingPoint(
        frequency_hz=float(at[i]),
        phase_deg=float(np.rad2deg(phase[i])),
        reflection=float(gamma[i]),
        crest_speed=float(speed[i]),
        at_edge=bool(min(at[i] - edges[0], edges[1] - at[i]) <= 0.01 * (edges[1] - edges[0]) / 120),
    )
