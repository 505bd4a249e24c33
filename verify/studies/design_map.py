"""A wave figure over one or two axes: frequency, phase, position, loss factor, count.

Over frequency and phase the fields of two unit forces, or of two unit displacements, are superposed: one pair for
each frequency serves every phase. Other axes are evaluated point by point. A point without a figure (an undamped
resonance, a mesh too coarse for the wave, a field that is zero) is a gap.
"""

from collections.abc import Callable
from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.errors import InputError, NoFigureError, near_name
from verify.exact.error_laws import PARTS
from verify.models.arrays import Array
from verify.waves.measures import middle_half
from verify.waves.unit_waves import FAST, Gaps, UnitDrive, superposed

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene

AXES = {
    "frequency_hz": "4000:4600:241",
    "phase_deg": "0:180:121",
    "position": "0.005:0.03:26",
    "loss_factor": "0:0.01:11",
    "count": "49:98:50",
}
"""What a map can run over, each with an example."""
MOST_STEPS, MOST_POINTS = 10_000, 4_000_000
"""Of an axis, and of a map: 64 MB of figures."""


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
    """(len(axis 1),) or (len(axis 1), len(axis 2)); NaN where there is no figure."""
    method: str
    """Superposed, or point by point."""
    of: str = ""
    """Whose: '49 segments, scene paper'."""
    reasons: tuple[str, ...] = ()
    """Why values are missing: for each kind of reason how many and the first of them."""


def parse_axis(text: str) -> Axis:
    """'frequency_hz=4000:4600:241' as an axis. Raises InputError."""
    name, _, span = text.partition("=")
    if name not in AXES:
        raise InputError(f"--sweep {text!r}: {name!r} is no axis, {near_name(name, tuple(AXES))}")
    try:
        start, end, steps = span.split(":")
        ends, n = (float(start), float(end)), int(steps)
    except ValueError:
        raise InputError(f"--sweep {text!r}: write axis=start:end:steps, for instance {name}={AXES[name]}") from None
    if not 1 <= n <= MOST_STEPS:
        raise InputError(f"--sweep {text!r}: give from 1 to {MOST_STEPS} steps, for instance {name}={AXES[name]}")
    lowest = {"phase_deg": -np.inf, "frequency_hz": np.nextafter(0.0, 1.0), "count": 1.0}.get(name, 0.0)
    if not (np.isfinite(ends).all() and min(ends) >= lowest):
        words = {"phase_deg": "finite", "frequency_hz": "above 0", "count": "from 1"}.get(
            name, "finite and not negative"
        )
        raise InputError(f"--sweep {text!r}: start and end have to be {words}, for instance {name}={AXES[name]}")
    values = np.linspace(*ends, n)
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
    from verify.quantities.catalogue import arguments_of
    from verify.quantities.catalogue import quantity as named

    found = named(quantity)
    if not quantity.startswith("wave.") or not 1 <= len(axes) <= 2 or len({a.name for a in axes}) != len(axes):
        raise InputError(f"quantity = {quantity!r}: a map takes a wave quantity and one or two different --sweep axes")
    n_points = prod(len(axis.values) for axis in axes)
    if n_points > MOST_POINTS:
        raise InputError(f"--sweep: the axes span {n_points} points, give at most {MOST_POINTS}")
    first = {axis.name: int(v) if axis.name == "count" else v for axis in axes for v in axis.values[:1]}
    asked = arguments_of(found, arguments | first)
    if quantity in FAST and {a.name for a in axes} <= {"frequency_hz", "phase_deg"} and _superposes(asked, scene):
        return _superposed(found, asked, axes, scene)
    return _pointwise(found, asked, axes, scene, bench, progress)


def _superposes(asked: Any, scene: "Scene") -> bool:
    """Whether the drive is two forces or displacements without settings that only a single solve knows."""
    return not asked.settings and len(scene.forces) == 2


def _whose(asked: Any, axes: tuple[Axis, ...], scene: "Scene") -> str:
    """Model, count and scene of a map in words."""
    model = "exact beam" if asked.model == "analytic" else PARTS[asked.model]
    counted = asked.model == "analytic" or "count" in {axis.name for axis in axes}
    return f"{model if counted else f'{asked.count} {model}'}, scene {scene.name}"


def _superposed(found: Any, asked: Any, axes: tuple[Axis, ...], scene: "Scene") -> DesignMap:
    from verify.waves.driven import drive_forces, drive_frequency, drive_kind, driven_beam

    beam, forces = driven_beam(asked, scene), drive_forces(asked, scene)
    spans = {axis.name: np.array(axis.values) for axis in axes}
    frequencies = spans.get("frequency_hz", np.array([drive_frequency(asked, scene)]))
    phases = np.deg2rad(spans.get("phase_deg", np.array([forces[1].phase_deg])))
    drive = UnitDrive(
        beam=beam,
        model=asked.model,
        count=asked.count,
        kind=drive_kind(asked, scene),
        places=tuple(f.position for f in forces),
        window=asked.window or middle_half(beam),
    )
    first = forces[0].amplitude * np.exp(1j * np.deg2rad(forces[0].phase_deg))
    gaps = Gaps()
    (values,) = superposed(drive, (found.name,), frequencies, first, forces[1].amplitude * np.exp(1j * phases), gaps)
    reasons = gaps.reasons(values.size)
    if axes[0].name == "phase_deg":
        values = values.T
    shape = [len(axis.values) for axis in axes]
    return DesignMap(
        quantity=found.name,
        unit=found.unit,
        axes=axes,
        method="superposed",
        reasons=reasons,
        values=values.reshape(shape),
        of=_whose(asked, axes, scene),
    )


def _check_points(asked: Any, axes: tuple[Axis, ...], scene: "Scene") -> None:
    """Raise InputError where the solves behind all points would take too long."""
    from verify.waves.driven import check_fields

    counts = next((axis.values for axis in axes if axis.name == "count"), (asked.count,))
    others = prod(len(axis.values) for axis in axes if axis.name != "count")
    check_fields(scene.beam, asked.model, [None if n is None else int(n) for n in counts], others)


def _pointwise(
    found: Any,
    asked: Any,
    axes: tuple[Axis, ...],
    scene: "Scene",
    bench: "Workbench",
    progress: Callable[[str], None],
) -> DesignMap:
    _check_points(asked, axes, scene)
    shape = [len(axis.values) for axis in axes]
    values, gaps = np.full(shape, np.nan), Gaps()
    for index in product(*(range(n) for n in shape)):
        point = {a.name: a.values[i] for a, i in zip(axes, index, strict=True)}
        progress(", ".join(f"{name} = {value:g}" for name, value in point.items()))
        point = {name: int(value) if name == "count" else value for name, value in point.items()}
        try:
            value = found.evaluate(replace(asked, **point), scene, bench)
        except NoFigureError as error:
            gaps.add(error)
            continue
        if isinstance(value, complex):
            raise InputError(f"quantity = {found.name!r} is complex: map a real figure")
        values[index] = value
        bench.fields.clear()
    return DesignMap(
        quantity=found.name,
        unit=found.unit,
        axes=axes,
        values=values,
        method="point by point",
        reasons=gaps.reasons(values.size),
        of=_whose(asked, axes, scene),
    )
