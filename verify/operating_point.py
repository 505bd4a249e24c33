"""Where to drive: the frequency of least reflection, and the fastest crests under a limit on the reflection."""

from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.design_map import unit_waves, wave_figure
from verify.errors import InputError
from verify.fields import Array

if TYPE_CHECKING:
    from verify.scene import Scene


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


class Landscape(msgspec.Struct, frozen=True, kw_only=True):
    """Reflection and crest speed of a beam under two forces, over frequency and phase between them."""

    beam: Beam
    forces: tuple[PointForce, PointForce]
    model: str
    count: int | None

    def over(self, frequencies: Array, phases_deg: Array) -> tuple[Array, Array]:
        """(reflection, crest speed in m/s) on a grid, (n_frequencies, n_phases) each; window [L/4, 3L/4]."""
        window = (0.25 * self.beam.length, 0.75 * self.beam.length)
        places = [force.position for force in self.forces]
        k, plus, minus = unit_waves(self.beam, self.model, self.count, places, frequencies, window)
        turn = self.forces[1].amplitude * np.exp(1j * np.deg2rad(phases_deg))
        waves = [w[:, 0, None] * self.forces[0].amplitude + w[:, 1, None] * turn for w in (plus, minus)]
        figures = ("wave.reflection", "wave.crest_speed")
        f = frequencies[:, None]
        reflection, speed = (wave_figure(name, self.beam, f, k[:, None], *waves) for name in figures)
        return reflection, speed

    def at(self, frequency: float, phase_deg: float) -> tuple[float, float]:
        """(reflection, crest speed) at one point."""
        reflection, speed = self.over(np.array([frequency]), np.array([phase_deg]))
        return float(reflection[0, 0]), float(speed[0, 0])

    def point(self, frequency: float, phase_deg: float, what: str) -> OperatingPoint:
        """A point with its sensitivity: mean changes over half a hertz and half a degree on both sides."""
        gamma, speed = self.at(frequency, phase_deg)

        def change(hertz: float, degrees: float) -> float:
            sides = [self.at(frequency + s * hertz, phase_deg + s * degrees)[0] for s in (1.0, -1.0)]
            return 0.5 * sum(abs(side - gamma) for side in sides) / (hertz + degrees)

        return OperatingPoint(frequency_hz=frequency, phase_deg=phase_deg, reflection=gamma, crest_speed=speed,
                              per_hertz=change(0.5, 0.0), per_degree=change(0.0, 0.5), what=what)  # fmt: skip


def best_points(
    scene: "Scene", model: str, count: int | None, limit: float = 0.1, loss_factor: float | None = None
) -> tuple[OperatingPoint, OperatingPoint]:
    """(least reflection at the scene's phase; largest crest speed with a reflection up to `limit` over both).

    Within 1.5 % of the drive's frequency and phases of 5 to 175 degrees in size. Raises InputError.
    """
    if scene.drive is None or len(scene.forces) != 2:
        raise InputError("an operating point takes a scene with two forces: add them to its [drive]")
    beam = scene.beam if loss_factor is None else replace(scene.beam, loss_factor=loss_factor)
    first, second = scene.forces
    land = Landscape(beam=beam, forces=(first, second), model=model, count=count)
    phase = second.phase_deg - first.phase_deg
    frequencies = np.linspace(0.985, 1.015, 121) * scene.drive.frequency_hz
    return (
        land.point(quietest(land, frequencies, phase), phase, "least reflection at the scene's phase"),
        land.point(*fastest(land, frequencies, phase, limit), f"largest crest speed with a reflection up to {limit:g}"),
    )


def quietest(land: Landscape, frequencies: Array, phase_deg: float) -> float:
    """The frequency of least reflection at one phase, Hz: the best of a grid, then Brent's method around it."""
    from scipy.optimize import minimize_scalar

    least = int(np.argmin(land.over(frequencies, np.array([phase_deg]))[0]))
    around = frequencies[max(least - 1, 0)], frequencies[min(least + 1, len(frequencies) - 1)]
    found = minimize_scalar(lambda f: land.at(float(f), phase_deg)[0], bounds=around, method="bounded",
                            options={"xatol": 1e-5})  # fmt: skip
    return float(found.x)


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
        lambda u: -abs(there(u)[1]) / top, [0.0, 0.0], method="SLSQP", bounds=[tuple(ends), (-30.0, 30.0)],
        constraints={"type": "ineq", "fun": lambda u: limit - there(u)[0]},
    )  # fmt: skip
    frequency, phase = start + found.x * scale if found.success else start
    return float(frequency), float(phase)
