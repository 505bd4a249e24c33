"""Operating points of a drive: the frequency of least reflection, and the fastest crests of little reflection."""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError, NoFigureError
from verify.linear.field import phasor
from verify.waves.driven_case import DrivenCase, unit_waves
from verify.waves.two_waves import Waveguide, minimum_near, reflections
from verify.waves.window import Window, middle_half

SEARCH_SPAN = 0.015
"""Half width of a search, relative to the drive's frequency."""
PHASES_DEG = (5.0, 175.0)
"""Range of the search in the phase between two drives, in size."""
ROUNDING = 1e-13
"""Excess over the limit of a reflection that is rounding."""
_ZOOM, _LEVELS, _SHARP = 17, 13, 1e-12
"""Points of a finer grid, number of such grids in phase (to 1e-12 rad), and relative interval of the last in
frequency."""


class OperatingPoint(msgspec.Struct, frozen=True, kw_only=True):
    """A drive of two actuators."""

    frequency_hz: float
    phase_deg: float
    """Lead of the second force."""
    reflection: float
    crest_speed: float
    """m/s, under the forces of the case."""
    at_edge: bool
    """Whether the crest speed still grows at the edge of the search in frequency."""


def best_frequency(case: DrivenCase, span: float = SEARCH_SPAN, window: Window | None = None) -> float:
    """The frequency within `span` (relative) of the drive's with the least reflection, Hz, to 1e-5 Hz.

    Raises InputError where the reflection still falls at the edge of the search, and where the wave stands throughout.
    """
    drives = np.array([[phasor(force)] for force in case.acting])

    def reflection(at: Array) -> Array:
        try:
            waves = unit_waves(case, at, window or middle_half(case.beam)).superposed(drives)
        except NoFigureError:
            if len(at) > 1:
                raise
            return np.ones(1)
        return np.nan_to_num(reflections(*waves)[:, 0], nan=1.0)  # on a resonance the wave stands

    least = minimum_near(reflection, np.linspace(1.0 - span, 1.0 + span, 41) * case.frequency_hz, 1e-5)
    if least.value > 1.0 - 1e-6:
        low, high = ((1.0 + side * span) * case.frequency_hz for side in (-1, 1))
        raise InputError(
            f"phase_deg: with this phase between the forces the wave stands at every frequency from {low:.6g} to "
            f"{high:.6g} Hz, so none is best, choose another phase_deg"
        )
    if least.at_edge:
        raise InputError(
            f"span = {span!r}: the reflection still falls at the edge of the search, {least.x:.6g} Hz, give a wider "
            "span or another frequency_hz"
        )
    return least.x


def check_two(case: DrivenCase) -> None:
    """Raise InputError without two forces, or with a device that has a force of its own."""
    if len(case.forces) != 2:
        raise InputError(f"drive.force: there are {len(case.forces)} forces, a phase between two needs two: give two")
    if len(case.acting) > 2:
        raise InputError("drive.device.amplitude: a phase between two forces knows no third, leave it out")


def lead_deg(case: DrivenCase) -> float:
    """Lead of the second of two forces, in (-180, 180] degrees."""
    return 180.0 - (180.0 - (case.forces[1].phase_deg - case.forces[0].phase_deg)) % 360.0


def maximum_crest_speed(case: DrivenCase, limit: float, span: float = SEARCH_SPAN) -> OperatingPoint:
    """The fastest crests in the middle half with a reflection up to `limit`, by two forces of these amplitudes.

    Over frequencies within `span` (relative) of the drive's and phases of 5 to 175 degrees, of the sign that the case
    has. Raises InputError without two forces, and where no point keeps the limit.
    """
    check_two(case)
    first, second = (force.amplitude for force in case.forces)
    ends = np.copysign(np.deg2rad(PHASES_DEG), lead_deg(case) or 1.0)
    guide = Waveguide(case.beam, case.model.theory)
    edges = (1.0 - span) * case.frequency_hz, (1.0 + span) * case.frequency_hz
    at = np.linspace(*edges, 121)
    # grids around the best point, eight times finer each: without derivatives, since the best point is often a corner,
    # where the reflection reaches its limit; points beyond the limit rank by their reflection, which leads to it
    while True:
        waves, rows = unit_waves(case, at, middle_half(case.beam)), np.arange(len(at))
        omega, phases = 2.0 * np.pi * at[:, None], np.tile(np.linspace(ends[0], ends[1], 171), (len(at), 1))
        for _ in range(_LEVELS):
            drives = np.stack([np.full_like(phases, first), second * np.exp(1j * phases)], axis=1)
            forward, backward = waves.superposed(drives)
            gammas, speeds = (
                reflections(forward, backward),
                guide.crest_speed(omega, waves.k[:, None], forward, backward),
            )
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
        raise InputError(f"limit = {limit!r}: no frequency and phase near the drive has so little reflection, raise it")
    return OperatingPoint(
        frequency_hz=float(at[i]),
        phase_deg=float(np.rad2deg(phase[i])),
        reflection=float(gamma[i]),
        crest_speed=float(speed[i]),
        at_edge=bool(min(at[i] - edges[0], edges[1] - at[i]) <= 0.01 * (edges[1] - edges[0]) / 120),
    )
