"""A wave figure over one or two axes: frequency, phase, position, loss factor, count.

Over frequency and phase the fields of two unit forces, or of two unit displacements, are superposed: one pair for
each frequency serves every phase. Other axes are evaluated point by point. A point without a figure (an undamped
resonance, a mesh too coarse for the wave, a field that is zero) is a gap.
"""

from itertools import product
from math import isfinite, prod
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.errors import InputError, NoFigureError, near_name
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.models.ordered import distinct
from verify.patience import check_work
from verify.quantities.cases import driven_case
from verify.quantities.kind import Quantity
from verify.quantities.wave_arguments import Driven, InWindow
from verify.studies.kind import Progress
from verify.studies.told import Column, Found, Table
from verify.studies.wave.request import around
from verify.waves.measures import middle_half
from verify.waves.unit_waves import Gaps, UnitDrive, superposed

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
AXIS_STEPS = 241
COARSE = (13, 7)
"""Rows and columns of a map that are shown at most."""
MOST_STEPS, MOST_POINTS = 10_000, 4_000_000
POINT_S, WINDOW_S = 0.003, 0.01
"""About, of a figure that is not superposed at one point, and where it is a mean or an extreme over a window."""
"""Of an axis, and of a map: 64 MB of figures."""


class Axis(msgspec.Struct, frozen=True):
    """Evenly spaced values of one argument."""

    name: str
    values: tuple[float, ...]


class DesignMap(Found, frozen=True, eq=False, kw_only=True):
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

    def facts(self) -> tuple[str, ...]:
        """Whose it is, its extremes, and how many points it has."""
        finite = np.isfinite(self.values)
        if not finite.any():
            endless = f", it is infinite at {n} of {self.values.size}" if (n := self._n_endless) else ""
            return f"{self.quantity} of {self.of}", f"no point has a finite figure{endless}", self._how()
        endless = f"infinite at {n} of {self.values.size} points, elsewhere " if (n := self._n_endless) else ""
        extremes = (("least", np.argmin, np.inf), (f"{endless}largest", np.argmax, -np.inf))
        places = [
            self._extreme(word, int(pick(np.where(finite, self.values, other)))) for word, pick, other in extremes
        ]
        return (f"{self.quantity} of {self.of}", *places, self._how())

    @property
    def _n_endless(self) -> int:
        return int(np.isinf(self.values).sum())

    def _how(self) -> str:
        left_out = self.values.size - prod(map(min, self._grid(), COARSE))
        told = f"; {left_out} of them are left out of the table, --json and --csv give them all" if left_out else ""
        return f"{self.values.size} points, {self.method}{told}"

    def _grid(self) -> tuple[int, int]:
        """Rows and columns of all points."""
        n = len(self.axes[0].values)
        return n, self.values.size // n

    def _extreme(self, word: str, index: int) -> str:
        at = np.unravel_index(index, self.values.shape)
        place = ", ".join(f"{axis.name} = {axis.values[i]:g}" for axis, i in zip(self.axes, at, strict=True))
        unit = f" {self.unit}" if self.unit != "1" else ""
        return f"{word} {self.quantity} = {self.values[at]:.6g}{unit} at {place}"

    def tables(self) -> tuple[Table, ...]:
        """A coarse look: at most 13 by 7 of the values."""
        first, *second = self.axes
        grid = self.values.reshape(len(first.values), -1)
        rows, columns = (_spread(n, most) for n, most in zip(grid.shape, COARSE, strict=True))
        heads = [f"{second[0].values[j]:g}" if second else self.quantity for j in columns]
        return (
            Table(
                columns=(Column(" \\ ".join(axis.name for axis in self.axes), "g"), *(Column(h, "4") for h in heads)),
                rows=tuple((first.values[i], *(float(v) for v in grid[i, columns])) for i in rows),
                notes=self.reasons,
            ),
        )

    def records(self) -> list[dict[str, Any]]:
        """Every point; nothing where there is no figure, which infinity is."""
        names = [axis.name for axis in self.axes]
        points = product(*(axis.values for axis in self.axes))
        return [
            {**dict(zip(names, point, strict=True)), self.quantity: None if np.isnan(value) else float(value)}
            for point, value in zip(points, self.values.ravel(), strict=True)
        ]

    def plain(self) -> dict[str, Any]:
        """Axes and values, nested as the axes are; which of those without a number are infinite, by their places."""
        rows = self.values.tolist()
        flat = self.values.ndim == 1
        return {
            "quantity": self.quantity,
            "unit": self.unit,
            "axes": msgspec.to_builtins(self.axes),
            "values": [finite_or_none(v) if flat else [finite_or_none(one) for one in v] for v in rows],
            "infinite": np.argwhere(np.isinf(self.values)).tolist(),
            "method": self.method,
            "reasons": list(self.reasons),
        }


def _spread(n: int, most: int) -> "list[int]":
    """At most so many of n places, evenly."""
    return [int(i) for i in distinct(np.linspace(0, n - 1, most).round().astype(int))]


def finite_or_none(value: float) -> float | None:
    """A figure, or None where there is none."""
    return value if isfinite(value) else None


def parse_axis(text: str, drive_hz: float | None = None) -> Axis:
    """'frequency_hz=4000:4600:241' as an axis, or its name alone: about the drive, or as in AXES. Raises InputError."""
    name, equals, span = text.partition("=")
    if name not in AXES:
        raise InputError(f"--sweep {text!r}: {name!r} is no axis, {near_name(name, tuple(AXES))}")
    if not equals:
        about = None if drive_hz is None else around(drive_hz, AXIS_STEPS)
        span = ":".join(map(str, about)) if about and name == "frequency_hz" else AXES[name]
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
        values = distinct(np.round(values))
    return Axis(name, tuple(float(v) for v in values))


def design_map(
    quantity: str,
    arguments: dict[str, Any],
    axes: tuple[Axis, ...],
    scene: "Scene",
    bench: "Workbench",
    progress: Progress = lambda step: None,
) -> DesignMap:
    """Evaluate a wave quantity over its axes; `arguments` are its others. Raises InputError."""
    from verify.quantities.catalogue import arguments_of
    from verify.quantities.catalogue import quantity as named

    found = named(quantity)
    mapped = issubclass(found.arguments, Driven)
    if not mapped or not 1 <= len(axes) <= 2 or len({a.name for a in axes}) != len(axes):
        raise InputError(f"quantity = {quantity!r}: a map takes a wave quantity and one or two different --sweep axes")
    n_points = prod(len(axis.values) for axis in axes)
    if n_points > MOST_POINTS:
        raise InputError(f"--sweep: the axes span {n_points} points, give at most {MOST_POINTS}")
    first = {axis.name: int(v) if axis.name == "count" else v for axis in axes for v in axis.values[:1]}
    asked = arguments_of(found, arguments | first)
    if found.superposed and {a.name for a in axes} <= {"frequency_hz", "phase_deg"} and _superposes(asked, scene):
        return _superposed(found, asked, axes, scene)
    return _pointwise(found, asked, axes, scene, bench, progress)


def _superposes(asked: Driven, scene: "Scene") -> bool:
    """Whether the drive is two forces or displacements without settings that only a single solve knows."""
    return not asked.settings and len(scene.forces) == 2 and not scene.devices


def _whose(asked: Driven, axes: tuple[Axis, ...], scene: "Scene") -> str:
    """Model, count and scene of a map in words."""
    parts = MODELS[asked.model].parts
    counted = asked.count is None or "count" in {axis.name for axis in axes}
    return f"{parts if counted else f'{asked.count} {parts}'}, scene {scene.name}"


def _superposed(found: Quantity[InWindow], asked: InWindow, axes: tuple[Axis, ...], scene: "Scene") -> DesignMap:
    case = driven_case(asked, scene)
    forces = case.forces
    spans = {axis.name: np.array(axis.values) for axis in axes}
    frequencies = spans.get("frequency_hz", np.array([case.frequency_hz]))
    phases = np.deg2rad(spans.get("phase_deg", np.array([forces[1].phase_deg])))
    drive = UnitDrive(
        beam=case.beam,
        model=case.model,
        count=case.count,
        kind=case.kind,
        places=tuple(f.position for f in forces),
        window=asked.window or middle_half(case.beam),
    )
    first = forces[0].amplitude * np.exp(1j * np.deg2rad(forces[0].phase_deg))
    gaps = Gaps()
    (values,) = superposed(
        drive, (found.superposed,), frequencies, first, forces[1].amplitude * np.exp(1j * phases), gaps
    )
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


def _check_points(asked: Driven, axes: tuple[Axis, ...], scene: "Scene") -> None:
    """Raise InputError where the solves behind all points would take too long."""
    from verify.waves.driven import check_fields

    counts = next((axis.values for axis in axes if axis.name == "count"), (asked.count,))
    others = prod(len(axis.values) for axis in axes if axis.name != "count")
    check_fields(scene.beam, asked.model, [None if n is None else int(n) for n in counts], others)
    n_points, each = prod(len(axis.values) for axis in axes), WINDOW_S if isinstance(asked, InWindow) else POINT_S
    check_work("points of the map", n_points, n_points * each, "give its axes fewer steps")


def _pointwise(
    found: Quantity[Any],
    asked: Driven,
    axes: tuple[Axis, ...],
    scene: "Scene",
    bench: "Workbench",
    progress: Progress,
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
        bench.sweeps.clear()
    return DesignMap(
        quantity=found.name,
        unit=found.unit,
        axes=axes,
        values=values,
        method="point by point",
        reasons=gaps.reasons(values.size),
        of=_whose(asked, axes, scene),
    )
