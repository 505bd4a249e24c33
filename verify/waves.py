"""Driven beams evaluated for quantities and maps: fields by model, measures, power, best frequency, orders."""

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.compare import observed_order
from verify.drives import driven_field
from verify.error_laws import discrete_wavenumber
from verify.errors import InputError
from verify.fields import HarmonicField, phasor
from verify.travelling_wave import WaveMeasures, measure
from verify.wave_arguments import InWindow
from verify.workbench import model_module

if TYPE_CHECKING:
    from verify.scene import Scene
    from verify.workbench import Workbench


def driven(a: Any, scene: "Scene", bench: "Workbench", count: int | None) -> HarmonicField:
    """The field that `wave_arguments.Driven` arguments describe, kept on the bench. Raises InputError."""
    beam = scene.beam if a.loss_factor is None else replace(scene.beam, loss_factor=a.loss_factor)
    frequency = drive_frequency(a, scene)
    forces = drive_forces(a, scene)
    kind = a.drive or (scene.drive.kind if scene.drive else "force")
    key = (a.model, count, beam, frequency, forces, kind, a.settings)
    if key not in bench.fields:
        bench.fields[key] = driven_field(
            lambda drives: solve_by_model(a.model, beam, drives, frequency, count, dict(a.settings)), forces, kind
        )
    return bench.fields[key]


def solve_by_model(
    model: str, beam: Beam, forces: Any, frequency_hz: float, count: int | None, settings: dict[str, Any]
) -> HarmonicField:
    """One model's solve_harmonic by name. Raises InputError."""
    if model == "analytic":
        from verify.analytic_modes import solve_harmonic

        return solve_harmonic(beam, forces, frequency_hz)
    field: HarmonicField = model_module(model).solve_harmonic(beam, forces, frequency_hz, count, **settings)
    return field


def drive_frequency(a: Any, scene: "Scene") -> float:
    """The frequency given, else the scene's. Raises InputError where there is none."""
    if a.frequency_hz is None and scene.drive is None:
        raise InputError("frequency_hz is missing and the scene has no drive: give frequency_hz in hertz")
    return float(a.frequency_hz if a.frequency_hz is not None else scene.drive.frequency_hz)  # type: ignore[union-attr]


def drive_forces(a: Any, scene: "Scene") -> tuple[PointForce, ...]:
    """The scene's forces with the position and phase given instead of theirs. Raises InputError."""
    forces = list(scene.forces)
    if not forces:
        raise InputError("the scene has no drive.force: add force = [{ position = ... }] to its [drive]")
    if (a.position is not None or a.phase_deg is not None) and len(forces) != 2:
        raise InputError(f"position and phase_deg are for two forces, the scene has {len(forces)}")
    if a.position is not None:
        if not 0 <= a.position <= scene.beam.length:
            raise InputError(
                f"position = {a.position!r} lies off the beam: give a distance between 0 and {scene.beam.length!r} m"
            )
        forces = [replace(forces[0], position=a.position), replace(forces[1], position=scene.beam.length - a.position)]
    if a.phase_deg is not None:
        forces[1] = replace(forces[1], phase_deg=a.phase_deg)
    return tuple(forces)


def measures(field: HarmonicField, window: tuple[float, float] | None) -> WaveMeasures:
    """Measures in a window, [L/4, 3L/4] unless given, with the model's own wavenumber stated. Raises InputError."""
    length = field.beam.length
    return measure(field, window or (0.25 * length, 0.75 * length), own_wavenumber(field))


def own_wavenumber(field: HarmonicField) -> complex:
    """The wavenumber at which waves run in the field's model, 1/m: exact, or by its discrete dispersion."""
    if field.count is None:
        return field.wavenumber
    return discrete_wavenumber(field.model, field.beam, field.count, field.frequency_hz)


def power_imbalance(field: HarmonicField, wave: WaveMeasures) -> float:
    """(input of the forces left of the window - losses up to its middle - flux through it) over that flux."""
    middle = 0.5 * sum(wave.window)
    left = [force for force in field.forces if force.position <= wave.window[0]]
    speeds = 1j * field.omega * field.deflection([force.position for force in left])
    given = sum(0.5 * (phasor(f) * np.conj(v)).real for f, v in zip(left, speeds, strict=True))
    points, weights = np.polynomial.legendre.leggauss(8)
    cells = max(int(middle * field.wavenumber.real), 8)
    edges = np.unique(np.concatenate([np.linspace(0.0, middle, cells), [f.position for f in left]]))
    half = 0.5 * np.diff(edges)
    x = (edges[:-1, None] + half[:, None] * (points + 1.0)).ravel()
    bending = abs(field.shapes(x, 2)) ** 2
    loss = 0.5 * field.omega * field.beam.loss_factor * field.beam.bending_stiffness
    lost = loss * float(bending @ (half[:, None] * weights).ravel())
    return float((given - lost - wave.energy_flux) / wave.energy_flux)


def best_frequency(a: Any, scene: "Scene", bench: "Workbench") -> float:
    """The frequency within `span` of the drive's at which the reflection is least: a grid, then Brent's method."""
    from scipy.optimize import minimize_scalar

    centre = drive_frequency(a, scene)

    def reflection(frequency: float) -> float:
        try:
            field = driven(replace(a, frequency_hz=float(frequency)), scene, bench, a.count)
        except InputError:
            return 1.0  # on a resonance the wave stands
        return measures(field, a.window).reflection

    grid = np.linspace((1.0 - a.span) * centre, (1.0 + a.span) * centre, 41)
    least = int(np.argmin([reflection(f) for f in grid]))
    around = grid[max(least - 1, 0)], grid[min(least + 1, len(grid) - 1)]
    found = minimize_scalar(reflection, bounds=around, method="bounded", options={"xatol": 1e-4})
    return float(found.x)


def wave_order(a: Any, scene: "Scene", bench: "Workbench") -> float:
    """The observed order of a discrete model's figure towards the exact field's. Raises InputError."""
    window = a.window or (0.25 * scene.beam.length, 0.75 * scene.beam.length)

    def figure(model: str, count: int | None) -> complex:
        asked = replace(a, model=model) if model != "analytic" else _exact(a)
        field = driven(asked, scene, bench, count)
        if a.of == "deflection":
            return complex(field.deflection(0.5 * sum(window))[0])
        found = measures(field, window)
        return complex(found.standing_wave_ratio if a.of == "standing_wave_ratio" else found.axis_ratio.mean())

    exact = figure("analytic", None)
    return observed_order(a.counts, [abs(figure(a.model, n) - exact) / abs(exact) for n in a.counts])


def _exact(a: Any) -> Any:
    """The same drive on the exact beam."""
    return InWindow(frequency_hz=a.frequency_hz, phase_deg=a.phase_deg, position=a.position, loss_factor=a.loss_factor,
                    drive=a.drive, window=a.window)  # fmt: skip
