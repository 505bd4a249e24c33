"""A wave figure over one or two axes: frequency, phase, position, loss factor, count.

Over frequency and phase the two forces' fields are superposed: one pair of responses for each frequency serves
every phase. Other axes are evaluated point by point.
"""

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.error_laws import discrete_wavenumber
from verify.errors import InputError, near_name
from verify.fields import Array, ComplexArray, wavenumber
from verify.travelling_wave import STANDING, crest_speed, energy_flux, sample_points, wave_basis

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scene import Scene
    from verify.workbench import Workbench

AXES = ("frequency_hz", "phase_deg", "position", "loss_factor", "count")
FAST = ("wave.reflection", "wave.standing_wave_ratio", "wave.crest_speed", "wave.energy_flux")


class Axis(msgspec.Struct, frozen=True):
    """Evenly spaced values of one argument."""

    name: str
    values: tuple[float, ...]


class DesignMap(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A figure over one or two axes."""

    quantity: str
    unit: str
    axes: tuple[Axis, ...]
    values: Array
    """(len(axis 1),) or (len(axis 1), len(axis 2)); NaN where there is no figure (an undamped resonance)."""
    method: str
    """Superposed, or point by point."""
    reasons: tuple[str, ...] = ()
    """Why values are missing."""


def parse_axis(text: str) -> Axis:
    """'frequency_hz=4000:4600:241' as an axis. Raises InputError."""
    name, _, span = text.partition("=")
    if name not in AXES:
        raise InputError(f"--sweep {text!r}: {name!r} is no axis, {near_name(name, AXES)}")
    try:
        start, end, steps = span.split(":")
        values = np.linspace(float(start), float(end), int(steps))
    except ValueError:
        raise InputError(f"--sweep {text!r}: write axis=start:end:steps, for instance {name}=4000:4600:241") from None
    if not np.isfinite(values).all() or len(values) < 1 or (name != "phase_deg" and (values < 0).any()):
        raise InputError(f"--sweep {text!r}: give finite values that are not negative and at least one step")
    if name == "count":
        values = np.unique(np.round(values))
    return Axis(name, tuple(float(v) for v in values))


def design_map(
    quantity: str,
    arguments: dict[str, Any],
    axes: tuple[Axis, ...],
    scene: "Scene",
    bench: "Workbench",
    progress: Callable[[str], None] = lambda step: None,
) -> DesignMap:
    """Evaluate a wave quantity over its axes; `arguments` are its others. Raises InputError."""
    from verify.quantities import arguments_of
    from verify.quantities import quantity as named

    found = named(quantity)
    if not quantity.startswith("wave.") or not 1 <= len(axes) <= 2 or len({a.name for a in axes}) != len(axes):
        raise InputError(f"quantity = {quantity!r}: a map takes a wave quantity and one or two different --sweep axes")
    first = {axis.name: int(v) if axis.name == "count" else v for axis in axes for v in axis.values[:1]}
    asked = arguments_of(found, arguments | first)
    if quantity in FAST and {a.name for a in axes} <= {"frequency_hz", "phase_deg"} and _superposes(asked, scene):
        return _superposed(found, asked, axes, scene)
    return _pointwise(found, asked, axes, scene, bench, progress)


def _superposes(asked: Any, scene: "Scene") -> bool:
    """Whether the drive is two imposed forces without settings that only a single solve knows."""
    kind = asked.drive or (scene.drive.kind if scene.drive else "force")
    return kind == "force" and not asked.settings and len(scene.forces) == 2


def _superposed(found: Any, asked: Any, axes: tuple[Axis, ...], scene: "Scene") -> DesignMap:
    from verify.waves import drive_forces, drive_frequency

    beam = scene.beam if asked.loss_factor is None else replace(scene.beam, loss_factor=asked.loss_factor)
    forces = drive_forces(asked, scene)
    spans = {axis.name: np.array(axis.values) for axis in axes}
    frequencies = spans.get("frequency_hz", np.array([drive_frequency(asked, scene)]))
    phases = np.deg2rad(spans.get("phase_deg", np.array([forces[1].phase_deg])))
    window = asked.window or (0.25 * beam.length, 0.75 * beam.length)
    k, plus, minus = unit_waves(beam, asked.model, asked.count, [f.position for f in forces], frequencies, window)
    first = forces[0].amplitude * np.exp(1j * np.deg2rad(forces[0].phase_deg))
    turn = forces[1].amplitude * np.exp(1j * phases)
    forward, backward = (a[:, 0, None] * first + a[:, 1, None] * turn for a in (plus, minus))
    values = wave_figure(found.name, beam, frequencies[:, None], k[:, None], forward, backward)
    if axes[0].name == "phase_deg":
        values = values.T
    return DesignMap(quantity=found.name, unit=found.unit, axes=axes, method="superposed",
                     values=values.reshape([len(axis.values) for axis in axes]))  # fmt: skip


def unit_waves(
    beam: "Beam",
    model: str,
    count: int | None,
    positions: list[float],
    frequencies: Array,
    window: tuple[float, float],
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """(k (n,), A+ (n, n_forces), A- (n, n_forces)) fitted in the window for a unit force at each position."""
    x = sample_points(window, wavenumber(beam, float(frequencies.max())).real)
    if model == "analytic" or count is None:
        from verify.analytic_modes import unit_responses

        k: ComplexArray = np.array([wavenumber(beam, float(f)) for f in frequencies])
        fields = unit_responses(beam, positions, frequencies, x)
    else:
        from verify.workbench import model_module

        k = np.array([discrete_wavenumber(model, beam, count, float(f)) for f in frequencies])
        fields = model_module(model).unit_responses(beam, positions, frequencies, x, count)
    basis = wave_basis(x, k)
    adjoint = np.conj(np.swapaxes(basis, 1, 2))
    amplitudes = np.linalg.solve(adjoint @ basis, adjoint @ np.swapaxes(fields, 1, 2))
    return k, np.asarray(amplitudes[:, 0]), np.asarray(amplitudes[:, 1])


def wave_figure(name: str, beam: "Beam", frequency: Array, k: ComplexArray, forward: Any, backward: Any) -> Array:
    """One of the FAST figures from two amplitudes, of their shape."""
    omega = 2.0 * np.pi * frequency
    if name == "wave.crest_speed":
        return np.asarray(crest_speed(beam, omega, k, forward, backward))
    if name == "wave.energy_flux":
        return np.asarray(energy_flux(beam, omega, k, forward, backward))
    sizes = np.sort(np.stack([abs(forward), abs(backward)]), axis=0)
    gamma = sizes[0] / sizes[1]
    if name == "wave.reflection":
        return np.asarray(gamma)
    travelling = gamma < 1.0 - STANDING
    return np.where(travelling, (1.0 + gamma) / np.where(travelling, 1.0 - gamma, 1.0), np.inf)


def _pointwise(
    found: Any,
    asked: Any,
    axes: tuple[Axis, ...],
    scene: "Scene",
    bench: "Workbench",
    progress: Callable[[str], None],
) -> DesignMap:
    shape = [len(axis.values) for axis in axes]
    values, reasons = np.full(shape, np.nan), {}
    for index in product(*(range(n) for n in shape)):
        point = {a.name: a.values[i] for a, i in zip(axes, index, strict=True)}
        progress(", ".join(f"{name} = {value:g}" for name, value in point.items()))
        point = {name: int(value) if name == "count" else value for name, value in point.items()}
        try:
            value = found.evaluate(replace(asked, **point), scene, bench)
        except InputError as error:
            if "resonance" not in str(error):
                raise
            reasons[str(error)] = True
            continue
        if isinstance(value, complex):
            raise InputError(f"quantity = {found.name!r} is complex: map a real figure")
        values[index] = value
        bench.fields.clear()
    return DesignMap(quantity=found.name, unit=found.unit, axes=axes, values=values, method="point by point",
                     reasons=tuple(reasons))  # fmt: skip


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


def best_points(
    scene: "Scene", model: str, count: int | None, limit: float = 0.1, loss_factor: float | None = None
) -> tuple[OperatingPoint, OperatingPoint]:
    """(least reflection at the scene's phase; largest crest speed with a reflection up to `limit` over both).

    Within 1.5 % of the drive's frequency and phases 0 to 180 degrees in size, by scipy's bounded search and
    SLSQP from the best point of a map. Raises InputError.
    """
    from scipy.optimize import minimize, minimize_scalar

    beam = scene.beam if loss_factor is None else replace(scene.beam, loss_factor=loss_factor)
    forces = scene.forces
    if scene.drive is None or len(forces) != 2:
        raise InputError("an operating point takes a scene with two forces: add them to its [drive]")
    centre, phase0 = scene.drive.frequency_hz, forces[1].phase_deg - forces[0].phase_deg
    window = (0.25 * beam.length, 0.75 * beam.length)
    places = [force.position for force in forces]

    def grid(f: Array, phase: Array) -> tuple[Array, Array]:
        k, plus, minus = unit_waves(beam, model, count, places, f, window)
        turn = forces[1].amplitude * np.exp(1j * np.deg2rad(phase))
        a, b = (w[:, 0, None] * forces[0].amplitude + w[:, 1, None] * turn for w in (plus, minus))
        figures = ("wave.reflection", "wave.crest_speed")
        gammas, speeds = (wave_figure(name, beam, f[:, None], k[:, None], a, b) for name in figures)
        return gammas, speeds

    def point(frequency: float, phase: float) -> tuple[float, float]:
        gammas, speeds = grid(np.array([frequency]), np.array([phase]))
        return float(gammas[0, 0]), float(speeds[0, 0])

    def described(frequency: float, phase: float, what: str) -> OperatingPoint:
        gamma, speed = point(frequency, phase)
        slopes = [
            0.5 * sum(abs(point(frequency + s * df, phase + s * dp)[0] - gamma) for s in (1, -1)) / (df + dp)
            for df, dp in ((0.5, 0.0), (0.0, 0.5))
        ]
        return OperatingPoint(frequency_hz=frequency, phase_deg=phase, reflection=gamma, crest_speed=speed,
                              per_hertz=slopes[0], per_degree=slopes[1], what=what)  # fmt: skip

    bounds = (0.985 * centre, 1.015 * centre)
    frequencies = np.linspace(*bounds, 121)
    phases = np.copysign(np.linspace(5.0, 175.0, 69), phase0 or 1.0)
    gammas, speeds = grid(frequencies, np.append(phases, phase0))
    i = int(np.argmin(gammas[:, -1]))
    around = frequencies[max(i - 1, 0)], frequencies[min(i + 1, 120)]
    quiet = minimize_scalar(lambda f: point(float(f), phase0)[0], bounds=around, method="bounded",
                            options={"xatol": 1e-5})  # fmt: skip
    allowed = np.where(gammas <= limit, abs(speeds), 0.0)[:, :-1]
    if not allowed.any():
        raise InputError(f"limit = {limit!r}: no frequency and phase near the drive keeps the reflection below it")
    row, column = np.unravel_index(int(allowed.argmax()), allowed.shape)
    f0, p0, top = float(frequencies[row]), float(phases[column]), float(allowed.max())
    scale = np.array([0.001 * centre, 1.0])
    fast = minimize(
        lambda u: -abs(point(f0 + u[0] * scale[0], p0 + u[1] * scale[1])[1]) / top,
        [0.0, 0.0], method="SLSQP",
        bounds=[((bounds[0] - f0) / scale[0], (bounds[1] - f0) / scale[0]), (-30.0, 30.0)],
        constraints={"type": "ineq", "fun": lambda u: limit - point(f0 + u[0] * scale[0], p0 + u[1] * scale[1])[0]},
    )  # fmt: skip
    best = (f0 + fast.x[0] * scale[0], p0 + fast.x[1] * scale[1]) if fast.success else (f0, p0)
    return (
        described(float(quiet.x), phase0, "least reflection at the scene's phase"),
        described(float(best[0]), float(best[1]), f"largest crest speed with a reflection up to {limit:g}"),
    )
