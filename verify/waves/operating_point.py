"""Reflection and crest speed over frequency and phase of two drives, and the fastest crests of little reflection."""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.waves.best_frequency import SEARCH_SPAN
from verify.waves.best_phase import fastest_candidates
from verify.waves.driven_case import DrivenCase
from verify.waves.superposition import UnitWaves, unit_waves
from verify.waves.two_waves import reflections
from verify.waves.waveguide import Waveguide
from verify.waves.window import middle_half

PHASES_DEG = (5.0, 175.0)
"""Range of the search in the phase between two drives, in size."""
ROUNDING = 1e-13
"""Of a reflection at its limit."""
_ZOOM, _SHARP = 17, 1e-12
"""Frequencies of each closer scan, and the relative interval at which the search ends."""


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


class OperatingMap(msgspec.Struct, frozen=True):
    """Reflection and crest speed in the middle half over frequency and phase between two forces (displacements).

    Raises InputError without two forces, or with a device that has a force of its own.
    """

    case: DrivenCase

    def __post_init__(self) -> None:
        check_two(self.case)

    def over(self, frequencies_hz: Array, phases_deg: Array) -> tuple[Array, Array]:
        """(reflection, crest speed in m/s) on a grid, (n_frequencies, n_phases) each; NaN where there is no wave.

        Raises NoFigureError where the whole grid has none.
        """
        return self._figures(self._waves(frequencies_hz), np.deg2rad(phases_deg))

    def _waves(self, frequencies_hz: Array) -> UnitWaves:
        return unit_waves(self.case, frequencies_hz, middle_half(self.case.beam))

    def _figures(self, waves: UnitWaves, phases: Array) -> tuple[Array, Array]:
        """The same at phases (p,) or (n, p), rad."""
        first, second = (force.amplitude for force in self.case.forces)
        drives = np.stack(np.broadcast_arrays(first + 0j, second * np.exp(1j * phases)), axis=-2)
        forward, backward = waves.superposed(drives)
        guide, omega = Waveguide(self.case.beam, self.case.model.theory), 2.0 * np.pi * waves.frequencies_hz
        return reflections(forward, backward), guide.crest_speed(omega[:, None], waves.k[:, None], forward, backward)

    def fastest(self, frequencies_hz: Array, sign: float, limit: float) -> OperatingPoint:
        """The largest crest speed with a reflection up to `limit`, to 1e-12 of the frequency.

        Phases of 5 to 175 degrees with this sign. The best phase at a frequency is known in closed form, so one search
        is left: the best of a grid, then of a grid eight times finer around it, again and again. It uses no derivative,
        and so finds corners, at the limit or at an end, as closely. Raises InputError where no point keeps the limit.
        """
        ends = sorted(float(np.copysign(np.deg2rad(end), sign)) for end in PHASES_DEG)
        amplitudes, at = np.array([force.amplitude for force in self.case.forces]), frequencies_hz
        while True:
            waves = self._waves(at)
            forward, backward = (np.nan_to_num(wave * amplitudes) for wave in (waves.forward, waves.backward))
            phases = fastest_candidates(forward, backward, limit, (ends[0], ends[1]))
            gamma, speed = self._figures(waves, phases)
            speeds = np.where(gamma <= limit + ROUNDING, abs(speed), 0.0)
            best, chosen = divmod(int(speeds.argmax()), speeds.shape[1])
            if speeds[best, chosen] == 0.0:
                raise InputError(
                    f"limit = {limit!r}: no frequency and phase near the drive has so little reflection, raise it"
                )
            low, high = at[max(best - 1, 0)], at[min(best + 1, len(at) - 1)]
            if high - low <= _SHARP * high:
                break
            at = np.linspace(low, high, _ZOOM)
        hertz, first, last = float(at[best]), frequencies_hz[0], frequencies_hz[-1]
        return OperatingPoint(
            frequency_hz=hertz,
            phase_deg=float(np.rad2deg(phases[best, chosen])),
            reflection=float(gamma[best, chosen]),
            crest_speed=float(speed[best, chosen]),
            at_edge=bool(min(hertz - first, last - hertz) <= 0.01 * (frequencies_hz[1] - first)),
        )


def check_two(case: DrivenCase) -> None:
    """Raise InputError without two forces, or with a device that has a force of its own."""
    if len(case.forces) != 2:
        raise InputError(f"drive.force: there are {len(case.forces)} forces, a phase between two needs two: give two")
    if len(case.acting) > 2:
        raise InputError("drive.device.amplitude: a phase between two forces knows no third, leave it out")


def lead_deg(case: DrivenCase) -> float:
    """Lead of the second of two forces, in (-180, 180] degrees."""
    return 180.0 - (180.0 - (case.forces[1].phase_deg - case.forces[0].phase_deg)) % 360.0


def maximum_crest_speed(case: DrivenCase, limit: float) -> OperatingPoint:
    """The fastest crests with a reflection up to `limit` within 1.5 % of the drive's frequency. Raises InputError.

    The second force leads or lags as in the case.
    """
    land = OperatingMap(case)
    frequencies = np.linspace(1.0 - SEARCH_SPAN, 1.0 + SEARCH_SPAN, 121) * case.frequency_hz
    return land.fastest(frequencies, lead_deg(case) or 1.0, limit)
