"""Driven beams evaluated for quantities and maps: fields by model, measures, power, best frequency, orders."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce, check_frequency
from verify.errors import InputError, ResonanceError
from verify.exact.error_laws import check_carried, discrete_wavenumber
from verify.judge.compare import observed_order, relative_error
from verify.judge.workbench import model_module
from verify.models.arrays import Array
from verify.models.eigen import solve_seconds
from verify.models.fields import HarmonicField, phasor
from verify.models.search import Least, least_over
from verify.patience import check_work
from verify.quantities.wave_arguments import InWindow
from verify.waves.imposed import driven_field
from verify.waves.measures import WaveMeasures, measure, middle_half, two_waves

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene

SEARCHED = 70
"""Driven fields behind a best frequency: a grid of 41, the rest by Brent's method."""


def driven(a: Any, scene: "Scene", bench: "Workbench", count: int | None) -> HarmonicField:
    """The field that `wave_arguments.Driven` arguments describe, its solves kept on the bench. Raises InputError."""
    beam = driven_beam(a, scene)

    def solve(forces: Sequence[PointForce], frequency: float) -> HarmonicField:
        key = (a.model, count, beam, frequency, tuple(forces), a.settings)
        if key not in bench.fields:
            bench.fields[key] = solve_by_model(a.model, beam, forces, frequency, count, dict(a.settings))
            bench.n_fields += 1
        return bench.fields[key]

    frequency = drive_frequency(a, scene)
    field = driven_field(solve, drive_forces(a, scene), frequency, drive_kind(a, scene))
    if count is not None and not beam.stepped:
        check_carried(a.model, beam, count, frequency)
    return field


def driven_beam(a: Any, scene: "Scene") -> Beam:
    """The scene's beam, with the loss factor given instead of its own."""
    return scene.beam if a.loss_factor is None else replace(scene.beam, loss_factor=a.loss_factor)


def drive_kind(a: Any, scene: "Scene") -> str:
    """What is imposed, force or displacement: as given, else as in the scene."""
    return str(a.drive or (scene.drive.kind if scene.drive else "force"))


def check_fields(beam: Beam, model: str, counts: Sequence[int | None], times: int = 1) -> None:
    """Raise InputError where driven fields of a discrete model at all sizes, so many times, would take too long."""
    sizes = [count for count in counts if count is not None]
    if model == "analytic" or not sizes:
        return
    module = model_module(model)
    seconds = times * sum(solve_seconds(module.unknowns(beam, count), 1) for count in sizes)
    check_work("count", max(sizes), seconds, f"lower it, {times * len(sizes)} driven fields are asked for")


def solve_by_model(
    model: str, beam: Beam, forces: Any, frequency_hz: float, count: int | None, settings: dict[str, Any]
) -> HarmonicField:
    """One model's solve_harmonic by name. Raises InputError."""
    if model == "analytic":
        from verify.exact.modes import solve_harmonic

        return solve_harmonic(beam, forces, frequency_hz)
    field: HarmonicField = model_module(model).solve_harmonic(beam, forces, frequency_hz, count, **settings)
    return field


def drive_frequency(a: Any, scene: "Scene") -> float:
    """The frequency given, else the scene's. Raises InputError where there is none."""
    if a.frequency_hz is None and scene.drive is None:
        raise InputError("frequency_hz is missing and the scene has no drive: give frequency_hz in hertz")
    frequency = float(a.frequency_hz if a.frequency_hz is not None else scene.drive.frequency_hz)  # type: ignore[union-attr]
    check_frequency("frequency_hz", frequency, scene.beam)
    return frequency


def drive_forces(a: Any, scene: "Scene") -> tuple[PointForce, ...]:
    """The scene's forces with the position, phase and amplitude given instead of theirs. Raises InputError."""
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
    if getattr(a, "force", None) is not None:
        forces = [replace(force, amplitude=a.force) for force in forces]
    return tuple(forces)


def measures(field: HarmonicField, window: tuple[float, float] | None) -> WaveMeasures:
    """Measures in a window, the middle half unless given, with the model's own wavenumber stated. Raises InputError."""
    return measure(field, window or middle_half(field.beam), own_wavenumber(field))


def own_wavenumber(field: HarmonicField) -> complex:
    """The wavenumber at which waves run in the field's model, 1/m: exact, or by its discrete dispersion."""
    if field.count is None:
        return field.wavenumber
    return discrete_wavenumber(field.model, field.beam, field.count, field.frequency_hz)


def power_imbalance(field: HarmonicField, wave: WaveMeasures) -> float:
    """(input of the forces left of the window - losses up to its middle - flux through it) over that flux.

    Raises StandingError where the wave stands.
    """
    wave.waves.check_travelling()
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
    """The frequency within `span` of the drive's at which the reflection is least.

    Raises InputError where the reflection still falls at the edge of the search or the wave stands everywhere.
    """
    found = quietest_drive(a, scene, bench)
    if found.at_edge:
        raise InputError(
            f"span = {a.span!r}: the reflection still falls at the edge of the search, {found.x:.6g} Hz, give a wider "
            "span or another frequency_hz"
        )
    return found.x


def quietest_drive(a: Any, scene: "Scene", bench: "Workbench") -> Least:
    """Where within `span` of the drive's frequency the reflection is least. Raises InputError where the wave stands."""
    centre = drive_frequency(a, scene)
    check_fields(scene.beam, a.model, (a.count,), SEARCHED)

    def reflection(frequency: float) -> float:
        try:
            field = driven(replace(a, frequency_hz=frequency), scene, bench, a.count)
        except ResonanceError:
            return 1.0  # on a resonance the wave stands
        return two_waves(field, a.window or middle_half(field.beam), own_wavenumber(field)).reflection

    grid = np.linspace((1.0 - a.span) * centre, (1.0 + a.span) * centre, 41)
    return quietest(lambda frequencies: np.array([reflection(float(f)) for f in frequencies]), grid)


def quietest(reflection: Callable[[Array], Array], frequencies: Array) -> Least:
    """Where a reflection over frequency is least, to 1e-5 Hz. Raises InputError where the wave stands everywhere."""
    found = least_over(reflection, frequencies, 1e-5)
    if found.value > 1.0 - 1e-6:
        raise InputError(
            f"phase_deg: with this phase between the forces the wave stands at every frequency from "
            f"{frequencies[0]:.6g} to {frequencies[-1]:.6g} Hz, so none is best, choose another phase_deg"
        )
    return found


def wave_order(a: Any, scene: "Scene", bench: "Workbench") -> float:
    """The observed order of a discrete model's figure towards the exact field's. Raises InputError."""
    window = a.window or middle_half(scene.beam)
    check_fields(scene.beam, a.model, a.counts)

    def figure(model: str, count: int | None) -> complex:
        asked = replace(a, model=model) if model != "analytic" else _exact(a)
        field = driven(asked, scene, bench, count)
        if a.of == "deflection":
            return complex(field.deflection(0.5 * sum(window))[0])
        found = measures(field, window)
        return complex(found.standing_wave_ratio if a.of == "standing_wave_ratio" else found.mean_axis_ratio)

    exact = figure("analytic", None)
    return observed_order(a.counts, [abs(relative_error(figure(a.model, n), exact)) for n in a.counts])


def _exact(a: Any) -> Any:
    """The same drive on the exact beam."""
    return InWindow(
        frequency_hz=a.frequency_hz,
        phase_deg=a.phase_deg,
        position=a.position,
        loss_factor=a.loss_factor,
        drive=a.drive,
        window=a.window,
    )
