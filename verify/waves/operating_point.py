"""Where to drive: the frequency of least reflection, and the fastest crests under a limit on the reflection."""

import msgspec
import numpy as np

from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.models.arrays import Array
from verify.waves.case import DrivenCase
from verify.waves.driven import quietest
from verify.waves.measures import middle_half
from verify.waves.unit_waves import Gaps, UnitDrive, superposed


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
        first, second = self.forces
        drive = UnitDrive(
            beam=self.beam,
            model=self.model,
            count=self.count,
            kind=self.kind,
            places=(first.position, second.position),
            window=middle_half(self.beam),
            theory=self.theory,
        )
        turned = np.asarray(second.amplitude * np.exp(1j * np.deg2rad(phases_deg)), dtype=complex)
        gaps, figures = Gaps(), ("reflection", "crest_speed")
        reflection, speed = superposed(drive, figures, frequencies, complex(first.amplitude), turned, gaps)
        gaps.reasons(reflection.size)
        return np.where(np.isnan(reflection), 1.0, reflection), np.nan_to_num(speed)  # a gap attracts nobody

    def at(self, frequency: float, phase_deg: float) -> tuple[float, float]:
        """(reflection, crest speed) at one point."""
        reflection, speed = self.over(np.array([frequency]), np.array([phase_deg]))
        return float(reflection[0, 0]), float(speed[0, 0])

    def point(self, frequency: float, phase_deg: float, what: str, note: str = "") -> OperatingPoint:
        """A point with its sensitivity: mean changes over half a hertz and half a degree on both sides.

        Below one hertz it is half of the frequency.
        """
        gamma, speed = self.at(frequency, phase_deg)

        def change(hertz: float, degrees: float) -> float:
            sides = [self.at(frequency + s * hertz, phase_deg + s * degrees)[0] for s in (1.0, -1.0)]
            return 0.5 * sum(abs(side - gamma) for side in sides) / (hertz + degrees)

        return OperatingPoint(
            frequency_hz=frequency,
            phase_deg=phase_deg,
            reflection=gamma,
            crest_speed=speed,
            per_hertz=change(min(0.5, 0.5 * frequency), 0.0),
            per_degree=change(0.0, 0.5),
            what=what,
            note=note,
        )

    def quiet_point(self, frequencies: Array, phase_deg: float) -> OperatingPoint:
        """Least reflection at one phase. Raises InputError where the wave stands at every frequency."""
        least = quietest(lambda f: self.over(f, np.array([phase_deg]))[0][:, 0], frequencies)
        note = edge_note("the reflection still falls", least.x) if least.at_edge else ""
        return self.point(least.x, phase_deg, "least reflection at the scene's phase", note)

    def fast_point(self, frequencies: Array, phase_deg: float, limit: float) -> OperatingPoint:
        """Largest crest speed with a reflection up to `limit`. Raises InputError where no point keeps it."""
        frequency, phase = fastest(self, frequencies, phase_deg, limit)
        inside = min(frequency - frequencies[0], frequencies[-1] - frequency) > 0.01 * np.diff(frequencies)[0]
        note = "" if inside else edge_note("the crests still grow faster", frequency)
        return self.point(frequency, phase, f"largest crest speed with a reflection up to {limit:g}", note)


def driven_point(case: DrivenCase) -> OperatingPoint:
    """The point at which a case drives. Raises InputError without two forces."""
    land = landscape(case)
    first, second = case.forces
    return land.point(case.frequency_hz, second.phase_deg - first.phase_deg, "as driven")


def check_two(case: DrivenCase) -> None:
    """Raise InputError without two forces."""
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
    """A sentence about an optimum at the edge of its search, Hz."""
    return f"{what} at the edge of the search, {frequency:.6g} Hz: not an optimum but where the search ends"


def operating_points(case: DrivenCase, limit: float = 0.1) -> tuple[tuple[OperatingPoint, ...], tuple[InputError, ...]]:
    """(least reflection at the case's phase; largest crest speed with a reflection up to `limit` over both).

    Within 1.5 % of its frequency and phases of 5 to 175 degrees in size; beside them the reasons for those that do
    not exist. Raises InputError for a case without two forces.
    """
    land = landscape(case)
    phase, frequencies = _around(case)
    points, problems = [], []
    for find in (land.quiet_point, lambda f, p: land.fast_point(f, p, limit)):
        try:
            points.append(find(frequencies, phase))
        except InputError as error:
            problems.append(error)
    return tuple(points), tuple(problems)


def fastest_point(case: DrivenCase, limit: float) -> OperatingPoint:
    """The second of these points. Raises InputError where it does not exist."""
    land = landscape(case)
    phase, frequencies = _around(case)
    return land.fast_point(frequencies, phase, limit)


def _around(case: DrivenCase) -> tuple[float, Array]:
    """(phase between both forces in degrees, frequencies that are searched) of a case of two forces."""
    return case.forces[1].phase_deg - case.forces[0].phase_deg, np.linspace(0.985, 1.015, 121) * case.frequency_hz


def fastest(land: Landscape, frequencies: Array, phase_deg: float, limit: float) -> tuple[float, float]:
    """(Hz, degrees) of the largest crest speed with a reflection up to `limit`: the best of a grid, then SLSQP.

    Phases of the sign of `phase_deg`. Raises InputError where no point keeps the limit.
    """
    from scipy.optimize import minimize

    phases = np.copysign(np.linspace(5.0, 175.0, 69), phase_deg or 1.0)
    reflection, speed = land.over(frequencies, phases)
    allowed = np.where(reflection <= limit, abs(speed), 0.0)
    if not allowed.any():
        raise InputError(f"limit = {limit!r}: no frequency and phase near the drive keeps the reflection below it")
    row, column = np.unravel_index(int(allowed.argmax()), allowed.shape)
    start, top = np.array([frequencies[row], phases[column]]), float(allowed.max())
    scale = np.array([1e-3 * frequencies.mean(), 1.0])

    def there(u: Array) -> tuple[float, float]:
        frequency, phase = start + u * scale
        return land.at(float(frequency), float(phase))

    ends = (frequencies[[0, -1]] - start[0]) / scale[0]
    found = minimize(
        lambda u: -abs(there(u)[1]) / top,
        [0.0, 0.0],
        method="SLSQP",
        bounds=[tuple(ends), (-30.0, 30.0)],
        constraints={"type": "ineq", "fun": lambda u: limit - there(u)[0]},
    )
    frequency, phase = start + found.x * scale if found.success else start
    return float(frequency), float(phase)
