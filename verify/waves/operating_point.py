"""Where to drive: the frequency of least reflection, and the fastest crests under a limit on the reflection."""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.waves.best_phase import TRIED, phases_to_try
from verify.waves.case import DrivenCase
from verify.waves.superposition import Gaps, UnitDrive, figures_of, superposed
from verify.waves.two_waves import middle_half

PHASES_DEG = (5.0, 175.0)
"""Between two drives, in size: what is searched."""
ROUNDING = 1e-13
"""Of a reflection at its limit."""
OFF = "off the search, at its edge"
"""Said of what is no optimum but where the search ends."""
_ZOOM, _SHARP = 17, 1e-12
"""Frequencies that are looked at around the best, until they lie together to this part."""


class OperatingPoint(msgspec.Struct, frozen=True, kw_only=True):
    """Where to drive."""

    frequency_hz: float
    phase_deg: float
    reflection: float
    crest_speed: float
    """m/s, for the forces of the scene."""
    per_hertz: float
    """Change of the reflection with frequency there, 1/Hz (one-sided means, in size)."""
    per_degree: float
    """Change of the reflection with phase there, 1/degree."""
    what: str
    note: str = ""
    """What limits it: the edge of the search; empty where the point is a true optimum."""


class Landscape(msgspec.Struct, frozen=True, kw_only=True):
    """Reflection and crest speed of a beam under two forces or displacements, over frequency and phase between them."""

    beam: Beam
    forces: tuple[PointForce, PointForce]
    model: str
    count: int | None
    kind: str = "force"
    """What is imposed, force or displacement."""
    theory: str = "euler-bernoulli"
    """Of the beam."""

    def over(self, frequencies: Array, phases_deg: Array) -> tuple[Array, Array]:
        """(reflection, crest speed in m/s) on a grid, (n_frequencies, n_phases) each; window [L/4, 3L/4]."""
        reflection, speed = self._known(frequencies, phases_deg)
        return np.where(np.isnan(reflection), 1.0, reflection), np.nan_to_num(speed)  # a gap attracts nobody

    def _known(self, frequencies: Array, phases_deg: Array) -> tuple[Array, Array]:
        """The same, NaN where there is none. Raises NoFigureError where there is none at all."""
        first, second = self.forces
        turned = np.asarray(second.amplitude * np.exp(1j * np.deg2rad(phases_deg)), dtype=complex)
        gaps, figures = Gaps(), ("reflection", "crest_speed")
        reflection, speed = superposed(self._drive, figures, frequencies, complex(first.amplitude), turned, gaps)
        gaps.reasons(reflection.size)
        return reflection, speed

    @property
    def _drive(self) -> UnitDrive:
        return UnitDrive(
            beam=self.beam,
            model=self.model,
            count=self.count,
            kind=self.kind,
            places=(self.forces[0].position, self.forces[1].position),
            window=middle_half(self.beam),
            theory=self.theory,
        )

    def fastest_phases(self, frequencies: Array, ends: tuple[float, float], limit: float) -> tuple[Array, Array]:
        """(phases, sizes of the crest speed there) of the fastest crests that keep a limit on the reflection, (n,).

        Phases in radians between both ends; the speed is 0 where none keeps it. Raises NoFigureError where no
        frequency has a figure.
        """
        first, second = (force.amplitude for force in self.forces)
        drive, gaps, figures = self._drive, Gaps(), ("reflection", "crest_speed")
        waves = drive.waves(frequencies, gaps)
        amplitudes = np.array([first, second])
        phases = np.zeros((len(frequencies), TRIED))
        phases[waves.known] = tried = phases_to_try(
            waves.forward * amplitudes, waves.backward * amplitudes, limit, ends
        )
        turned = np.asarray(second * np.exp(1j * tried))
        reflection, speed = figures_of(drive, waves, figures, frequencies, complex(first), turned, gaps)
        gaps.reasons(len(frequencies))
        allowed = np.where(reflection <= limit + ROUNDING, abs(speed), 0.0)
        rows, best = np.arange(len(frequencies)), allowed.argmax(axis=1)
        return phases[rows, best], allowed[rows, best]

    def point(self, frequency: float, phase_deg: float, what: str, note: str = "") -> OperatingPoint:
        """A point with its sensitivity: mean changes over half a hertz and half a degree on both sides.

        Below one hertz it is half of the frequency. Raises NoFigureError where it or a neighbour has none.
        """
        hertz, degrees, sides = min(0.5, 0.5 * frequency), 0.5, np.array([0.0, 1.0, -1.0])
        frequencies, phases = frequency + hertz * sides, phase_deg + degrees * sides
        gamma, speed = self._known(frequencies, phases)
        for i, j in zip(*np.nonzero(np.isnan(gamma) & (sides * sides[:, None] == 0.0)), strict=True):
            self._known(frequencies[[i]], phases[[j]])  # which says why
        return OperatingPoint(
            frequency_hz=frequency,
            phase_deg=phase_deg,
            reflection=float(gamma[0, 0]),
            crest_speed=float(speed[0, 0]),
            per_hertz=float(abs(gamma[1:, 0] - gamma[0, 0]).mean() / hertz),
            per_degree=float(abs(gamma[0, 1:] - gamma[0, 0]).mean() / degrees),
            what=what,
            note=note,
        )

    def fast_point(self, frequencies: Array, phase_deg: float, limit: float) -> OperatingPoint:
        """Largest crest speed with a reflection up to `limit`. Raises InputError where no point keeps it."""
        frequency, phase = fastest(self, frequencies, phase_deg, limit)
        inside = min(frequency - frequencies[0], frequencies[-1] - frequency) > 0.01 * np.diff(frequencies)[0]
        within = f"crest speed with a reflection up to {limit:g}"
        if inside:
            return self.point(frequency, phase, f"largest {within}")
        return self.point(frequency, phase, f"{within}, grows {OFF}", edge_note("the crest speed grows off", frequency))


def check_two(case: DrivenCase) -> None:
    """Raise InputError without two forces."""
    case.check_no_devices("a phase between two forces")
    if len(case.forces) != 2:
        raise InputError(
            f"the reflection has a phase between two forces, the scene has {len(case.forces)}: give it two"
        )


def landscape(case: DrivenCase) -> Landscape:
    """Over frequency and phase around a case. Raises InputError without two forces."""
    check_two(case)
    first, second = case.forces
    return Landscape(
        beam=case.beam,
        forces=(first, second),
        model=case.model,
        count=case.count,
        kind=case.kind,
        theory=dict(case.settings).get("theory", "euler-bernoulli"),
    )


def edge_note(what: str, frequency: float) -> str:
    """A sentence about what is at the edge of its search, Hz, instead of an optimum."""
    return f"{what} the search, at its edge, {frequency:.6g} Hz: no optimum but where the search ends"


def fastest_point(case: DrivenCase, limit: float) -> OperatingPoint:
    """The second of these points. Raises InputError where it does not exist."""
    land = landscape(case)
    phase, frequencies = _around(case)
    return land.fast_point(frequencies, phase, limit)


def _around(case: DrivenCase) -> tuple[float, Array]:
    """(phase between both forces in degrees, frequencies that are searched) of a case of two forces."""
    return _between(case), np.linspace(0.985, 1.015, 121) * case.frequency_hz


def _between(case: DrivenCase) -> float:
    """By how much the second force leads the first, degrees, above -180 to 180: 270 and -90 are one drive."""
    lead = case.forces[1].phase_deg - case.forces[0].phase_deg
    return lead if -180.0 < lead <= 180.0 else 180.0 - (180.0 - lead) % 360.0


def fastest(land: Landscape, frequencies: Array, phase_deg: float, limit: float) -> tuple[float, float]:
    """(Hz, degrees) of the largest crest speed with a reflection up to `limit`, to 1e-12 of the frequency.

    At every frequency the best phase is known in closed form (`best_phase`), so that one search is left: the best of
    a grid, then the same eight times closer around it, again and again. Nothing is differentiated: where the best
    point is a corner, of the limit or at an end, it is found as closely. Phases of 5 to 175 degrees with the sign of
    `phase_deg`. Raises InputError where no point keeps the limit.
    """
    ends = tuple(sorted(float(np.copysign(np.deg2rad(end), phase_deg or 1.0)) for end in PHASES_DEG))
    at = frequencies
    while True:
        phases, speeds = land.fastest_phases(at, (ends[0], ends[1]), limit)
        best = int(speeds.argmax())
        low, high = at[max(best - 1, 0)], at[min(best + 1, len(at) - 1)]
        if speeds[best] == 0.0:
            raise InputError(f"limit = {limit!r}: no frequency and phase near the drive keeps the reflection below it")
        if high - low <= _SHARP * high:
            return float(at[best]), float(np.rad2deg(phases[best]))
        at = np.linspace(low, high, _ZOOM)
