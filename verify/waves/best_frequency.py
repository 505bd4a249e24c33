"""The frequency of least reflection near a drive's."""

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, NoFigureError
from verify.linear.field import phasor
from verify.waves.driven_case import DrivenCase
from verify.waves.superposition import unit_waves
from verify.waves.two_waves import Minimum, minimum_near, reflections
from verify.waves.window import Window, middle_half

SEARCH_SPAN = 0.015
"""Half width of the search, relative to the drive's frequency."""


def minimum_reflection(case: DrivenCase, span: float = SEARCH_SPAN, window: Window | None = None) -> Minimum:
    """Where within `span` (relative) of the drive's frequency the reflection is least, to 1e-5 Hz.

    Its `at_edge` says that the reflection still falls there. Raises InputError where the wave stands at all of them.
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
