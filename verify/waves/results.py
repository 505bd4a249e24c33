"""What is found of a wave: the two waves in a window, and all measures of them (`waves.measures` finds them)."""

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import NoFigureError

STANDING = 1e-12
"""A reflection this near 1 is a standing wave; its ratio is infinite, not rounding's."""


def reflections(forward: ComplexArray, backward: ComplexArray) -> Array:
    """Gamma of amplitudes of one shape: the weaker over the stronger; 1 where nothing moves."""
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
    """A+ of e^{-ik(x - middle)}, metres."""
    backward: complex
    """A- of e^{+ik(x - middle)}, metres."""
    residual: float
    """What the two waves leave unexplained, rms over rms."""

    @property
    def direction(self) -> int:
        """+1 where the stronger wave runs towards +x, else -1."""
        return 1 if abs(self.forward) >= abs(self.backward) else -1

    @property
    def reflection(self) -> float:
        """Gamma, the weaker amplitude over the stronger, 0 to 1."""
        weak, strong = sorted((abs(self.forward), abs(self.backward)))
        return float(weak / strong) if strong > 0 else 0.0

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), 1 for a pure travelling wave, infinite for a standing one."""
        return float(standing_wave_ratios(np.asarray(self.reflection)))

    def check_travelling(self) -> None:
        """Raise NoFigureError where the wave stands: flux and signed area are then zero but for rounding."""
        if self.reflection >= 1.0 - STANDING:
            raise NoFigureError(
                "the wave stands: it carries no power and its ellipses have no area to relate to, choose another "
                "phase_deg"
            )


class WaveMeasures(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What kind of wave a field carries in a window, and what the surface does there."""

    window: tuple[float, float]
    """Metres."""
    waves: TwoWaves
    """The forward and the backward wave fitted in the window."""
    envelope: float
    """(max - min) / (max + min) of |w| over the window: equals Gamma for two waves."""
    travelling_index: float
    """1 / cond of [Re w, Im w] in the mean square (Feeny's complex orthogonal decomposition): 1 travelling, 0 standing.

    Over whole half wavelengths, the most that fit in the middle of the window: there, and only there, it equals
    (1 - Gamma) / (1 + Gamma) for two waves.
    """
    mean_axis_ratio: float
    """Of `axis_ratio` over the same whole half wavelengths: there `ideal_axis_ratio` for any two waves as
    kh goes to 0."""
    x: Array
    """(n,), metres: where the surface quantities are given, 24 points for each half wavelength of the exact beam."""
    axis_ratio: Array
    """(n,), signed ratio of the ellipse's axes, tan chi; `ideal_axis_ratio` of a pure wave, negative towards +x."""
    tilt_deg: Array
    """(n,), angle of the long axis from x, degrees."""
    signed_area: Array
    """(n,), S3, m^2."""
    signed_area_range: tuple[float, float, float]
    """Least, mean and largest over the window, not over the points."""
    ideal_axis_ratio: float
    """k h/2, by Timoshenko's theory times psi/w' of a running wave: what `axis_ratio` is of a pure one."""
    crest_speed: float
    """Of the surface at the crests, m/s along +x: -omega r (|A+|^2 - |A-|^2) / sqrt(|A+|^2 + |A-|^2), r the
    `ideal_axis_ratio`."""
    energy_flux: float
    """Power carried towards +x through the middle of the window, watt."""

    @property
    def reflection(self) -> float:
        """Gamma, 0 to 1."""
        return self.waves.reflection

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma)."""
        return self.waves.standing_wave_ratio

    @property
    def signed_area_spread(self) -> float:
        """(max - min) / |mean| of the signed area: 0 for undamped waves away from forces and ends.

        Raises NoFigureError where the wave stands.
        """
        self.waves.check_travelling()
        least, mean, largest = self.signed_area_range
        return (largest - least) / abs(mean)

    @property
    def rotation(self) -> str:
        """The sense in which most surface points turn, in (x, y)."""
        return "counter-clockwise" if self.signed_area_range[1] < 0 else "clockwise"
