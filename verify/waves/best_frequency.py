"""The frequency of least reflection near a drive's."""

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.waves.driven_case import DrivenCase
from verify.waves.results import reflections
from verify.waves.superposition import amplitudes, unit_waves
from verify.waves.two_waves import Minimum, minimum_near
from verify.waves.window import Window, middle_half

SEARCH_SPAN = 0.015
"""Half width of the search, relative to the drive's frequency."""
_GRID, _TOLERANCE = 41, 1e-5
"""Frequencies of the first scan, and how closely the minimum is found, Hz."""


def minimum_reflection(case: DrivenCase, span: float = SEARCH_SPAN, window: Window | None = None) -> Minimum:
    """Where within `span` (relative) of the drive's frequency the reflection is least, Hz.

    Its `at_edge` says that the reflection still falls there. Raises InputError where the wave stands at all of them.
    """
    window = window or middle_half(case.beam)
    frequencies = np.linspace(1.0 - span, 1.0 + span, _GRID) * case.frequency_hz
    drives = amplitudes(case)

    def reflection(at: Array) -> Array:
        waves = unit_waves(case, at, window)
        found = reflections(*waves.superposed(drives))[:, 0]
        # a resonance among others is a standing wave; where no frequency has a wave, the reason is raised
        return np.nan_to_num(waves.check_any(found) if len(at) > 1 else found, nan=1.0)

    least = minimum_near(reflection, frequencies, _TOLERANCE)
    if least.value > 1.0 - 1e-6:
        raise InputError(
            f"phase_deg: with this phase between the forces the wave stands at every frequency from "
            f"{frequencies[0]:.6g} to {frequencies[-1]:.6g} Hz, so none is best, choose another phase_deg"
        )
    return least


def best_frequency(case: DrivenCase, span: float = SEARCH_SPAN, window: Window | None = None) -> float:
    """The frequency of that minimum, Hz. Raises InputError where the reflection still falls at the edge as well."""
    least = minimum_reflection(case, span, window)
    if least.at_edge:
        raise InputError(
            f"span = {span!r}: the reflection still falls at the edge of the search, {least.x:.6g} Hz, give a wider "
            "span or another frequency_hz"
        )
    return least.x
