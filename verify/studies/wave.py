"""The driven beam for a table and a report: the motor's figures over sizes, envelopes, ellipses, the map."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.quantities.wave_arguments import BestFrequency, InWindow
from verify.studies.design_map import Axis, DesignMap, design_map
from verify.waves.driven import SEARCHED, check_fields, driven, measures, quietest_drive
from verify.waves.measures import surface_motion
from verify.waves.operating_point import OperatingPoint, edge_note, operating_points

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene, Wave


class Operation(msgspec.Struct, frozen=True, kw_only=True):
    """The wave at one frequency."""

    frequency_hz: float
    standing_wave_ratio: float
    axis_ratio: float
    """Signed mean over the whole half wavelengths in the window's middle."""
    crest_speed: float
    """m/s for the scene's forces."""


class MotorRow(msgspec.Struct, frozen=True, kw_only=True):
    """One model at one size: at the frequency of the drive, and at its own best."""

    model: str
    count: int | None
    drive: Operation
    best: Operation | None
    """None where the wave stands at every frequency."""
    note: str = ""
    """What is wrong with `best`: it is missing, or lies at the edge of the search."""


class Ellipse(msgspec.Struct, frozen=True, kw_only=True):
    """The path of one surface point over a period, metres."""

    x: float
    across: tuple[float, ...]
    up: tuple[float, ...]


class WaveStudy(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a wave."""

    rows: tuple[MotorRow, ...]
    x: tuple[float, ...]
    envelopes: dict[str, tuple[float, ...]]
    """|w| along the beam by model, metres."""
    ellipses: tuple[Ellipse, ...]
    """Of the exact field."""
    map: DesignMap
    points: tuple[OperatingPoint, ...]
    notes: tuple[str, ...]
    """Why an operating point is missing."""
    operating_loss_factor: float
    """Of the map and of the operating points."""
    pure_phase: bool
    """Whether, undamped, the wave is pure along phase = -kL: equal forces as far from both pinned ends."""
    first_phase_deg: float
    """Of the first force; phases of the map are those of the second, absolute."""
    undamped: bool
    count: int
    other_drive: float
    """Standing-wave ratio of the exact field if the other kind of drive is imposed with the same phase."""


def motor_row(scene: "Scene", bench: "Workbench", model: str, count: int | None) -> MotorRow:
    """The motor's figures of one model at one size."""
    a = InWindow(model=model, count=count)  # type: ignore[arg-type]
    asked = BestFrequency(model=model, count=count)  # type: ignore[arg-type]
    assert scene.drive is not None
    drive = _operation(a, scene, bench, scene.drive.frequency_hz)
    try:
        found = quietest_drive(asked, scene, bench)
    except InputError as error:
        return MotorRow(model=model, count=count, drive=drive, best=None, note=str(error))
    note = edge_note("the reflection still falls", found.x) if found.at_edge else ""
    return MotorRow(model=model, count=count, drive=drive, best=_operation(a, scene, bench, found.x), note=note)


def _operation(a: Any, scene: "Scene", bench: "Workbench", frequency: float) -> Operation:
    found = measures(driven(replace(a, frequency_hz=frequency), scene, bench, a.count), a.window)
    return Operation(
        frequency_hz=frequency,
        standing_wave_ratio=found.standing_wave_ratio,
        axis_ratio=found.mean_axis_ratio,
        crest_speed=found.crest_speed,
    )


def motor_table(
    scene: "Scene", bench: "Workbench", counts: tuple[int, ...], progress: Callable[[str], None] = lambda step: None
) -> tuple[MotorRow, ...]:
    """The exact beam, then both discrete models at every size. Raises InputError."""
    for model in ("segment", "fem"):
        check_fields(scene.beam, model, counts, SEARCHED)
    rows = [motor_row(scene, bench, "analytic", None)]
    for model in ("segment", "fem"):
        for count in counts:
            progress(f"{model}, N = {count}")
            rows.append(motor_row(scene, bench, model, count))
    return tuple(rows)


def wave_study(
    scene: "Scene", bench: "Workbench", asked: "Wave", progress: Callable[[str], None] = lambda step: None
) -> WaveStudy:
    """Everything a [wave] of a scene asks for. Raises InputError."""
    rows = motor_table(scene, bench, asked.counts, progress)
    progress("design map")
    model, count = asked.model, None if asked.model == "analytic" else asked.count
    eta = scene.beam.loss_factor or asked.operating_loss_factor
    chosen: dict[str, Any] = {"model": model, "loss_factor": eta} | ({"count": count} if count else {})
    axes = (Axis("frequency_hz", _steps(asked.frequency_hz)), Axis("phase_deg", _steps(asked.phase_deg)))
    drive = scene.drive
    assert drive is not None
    fields = {
        name: driven(InWindow(model=name, count=n), scene, bench, n)  # type: ignore[arg-type]
        for name, n in (("analytic", None), ("segment", asked.count), ("fem", asked.count))
    }
    other = "displacement" if drive.kind == "force" else "force"
    across = measures(driven(InWindow(drive=other), scene, bench, None), None).standing_wave_ratio  # type: ignore[arg-type]
    x = np.linspace(0.0, scene.beam.length, 601)
    points, problems = operating_points(scene, model, count, asked.reflection_limit, eta)
    return WaveStudy(
        rows=rows,
        x=tuple(x.tolist()),
        count=asked.count,
        undamped=not scene.beam.loss_factor,
        envelopes={name: tuple(abs(field.deflection(x)).tolist()) for name, field in fields.items()},
        ellipses=_ellipses(scene.beam, fields["analytic"]),
        map=design_map(asked.quantity, chosen, axes, scene, bench),
        points=points,
        notes=tuple(str(problem) for problem in problems),
        operating_loss_factor=eta,
        pure_phase=_pure_along_a_phase(scene),
        first_phase_deg=scene.forces[0].phase_deg,
        other_drive=across,
    )


def _pure_along_a_phase(scene: "Scene") -> bool:
    """Whether a phase between the forces makes the undamped wave pure at any frequency (phi = -kL)."""
    first, second = scene.forces
    mirrored = abs(first.position + second.position - scene.beam.length) < 1e-9 * scene.beam.length
    equal = first.amplitude == second.amplitude and scene.beam.supports == ("pinned", "pinned")
    return scene.drive is not None and scene.drive.kind == "force" and mirrored and equal


def _steps(span: tuple[float, float, int]) -> tuple[float, ...]:
    return tuple(np.linspace(span[0], span[1], span[2]).tolist())


def _ellipses(beam: Beam, field: Any) -> tuple[Ellipse, ...]:
    """Thirteen surface points evenly over the middle half of the beam."""
    places = np.linspace(0.25, 0.75, 13) * beam.length
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 49))
    across, up = surface_motion(beam, field.slope(places)), field.deflection(places)
    return tuple(
        Ellipse(x=float(x), across=tuple((u * turn).real.tolist()), up=tuple((w * turn).real.tolist()))
        for x, u, w in zip(places, across, up, strict=True)
    )
