"""The two waves in a window, and what is a matter of their amplitudes alone."""

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import StandingError

STANDING = 1e-12
"""Distance of a reflection from 1 below which the wave is a standing one: its ratio is infinite."""


def reflections(forward: ComplexArray, backward: ComplexArray) -> Array:
    """Gamma of amplitudes of one shape: the weaker over the stronger; 1 where both are zero."""
    sizes = np.sort(np.stack([abs(forward), abs(backward)]), axis=0)
    return np.asarray(sizes[0] / np.where(sizes[1] > 0.0, sizes[1], 1.0) + (sizes[1] == 0.0))


def standing_wave_ratios(gammas: Array) -> Array:
    """(1 + Gamma) / (1 - Gamma) of reflections of any shape, infinite from 1 - `STANDING` on."""
    travels = gammas < 1.0 - STANDING
    return np.where(travels, (1.0 + gammas) / np.where(travels, 1.0 - gammas, 1.0), np.inf)


class TwoWaves(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A forward and a backward wave fitted to phasors, amplitudes at the middle of the window."""

    wavenumber: complex
    """k, 1/m, the one used."""
    forward: complex
    """A+ of e^{-ik(x - middle)}, m."""
    backward: complex
    """A- of e^{+ik(x - middle)}, m."""
    residual: float
    """Part of the field that the two waves do not explain, rms over rms."""

    @property
    def direction(self) -> int:
        """+1 where the stronger wave runs towards +x, else -1."""
        return 1 if abs(self.forward) >= abs(self.backward) else -1

    @property
    def reflection(self) -> float:
        """Gamma, the weaker amplitude over the stronger, 0 to 1; 0 where both are zero."""
        weak, strong = sorted((abs(self.forward), abs(self.backward)))
        return float(weak / strong) if strong > 0 else 0.0

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), 1 for a pure travelling wave, infinite for a standing one."""
        return float(standing_wave_ratios(np.asarray(self.reflection)))

    def check_travelling(self) -> None:
        """Raise StandingError for a standing wave: its flux and signed area are zero but for rounding."""
        if self.reflection >= 1.0 - STANDING:
            raise StandingError(
                "the wave stands: it carries no power and its ellipses have no area to relate to, choose another "
                "phase_deg"
            )
