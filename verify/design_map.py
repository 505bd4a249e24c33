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
