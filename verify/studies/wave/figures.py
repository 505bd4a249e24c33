"""The driven beam for a table and a report: the motor's figures over sizes, envelopes, ellipses, the map."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.catalogue import MODELS, discrete
from verify.quantities.cases import driven_case
from verify.quantities.wave_arguments import Driven
from verify.studies.chart import Chart
from verify.studies.kind import Progress
from verify.studies.told import Column, Found, Table
from verify.studies.wave.design_map import Axis, DesignMap, design_map
from verify.studies.wave.request import MAP_STEPS, around
from verify.waves.case import DrivenCase
from verify.waves.driven import (
    SEARCH_SPAN,
    SEARCHED,
    Operation,
    check_fields,
    driven,
    measured_alone,
    operation,
    quietest_drive,
)
from verify.waves.measures import lifted
from verify.waves.operating_point import OperatingPoint, edge_note, operating_points
from verify.words import cell

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.models.fields import HarmonicField
    from verify.scenes.scene import Scene
    from verify.studies.wave.request import Wave


class OffSearch(msgspec.Struct, frozen=True):
    """No best frequency: the reflection still falls where the search ends."""

    edge_hz: float


class MotorRow(msgspec.Struct, frozen=True, kw_only=True):
    """One model at one size: at the frequency of the drive, and at its own best."""

    model: str
    count: int | None
    drive: Operation
    best: Operation | OffSearch | None
    """None where the wave stands at every frequency."""
    note: str = ""
    """Why there is no best."""

    @property
    def known_best(self) -> Operation | None:
        """At the best frequency, where there is one."""
        return self.best if isinstance(self.best, Operation) else None

    @property
    def off_search(self) -> bool:
        """Whether it lies beyond the frequencies that were searched."""
        return isinstance(self.best, OffSearch)


SMOOTH = 160
"""Stretches of an exact line in a moving picture."""


class Ellipse(msgspec.Struct, frozen=True, kw_only=True):
    """The path of one surface point over a period, metres."""

    x: float
    across: tuple[float, ...]
    up: tuple[float, ...]


class Snapshot(msgspec.Struct, frozen=True):
    """A model's complex deflection where it knows it, metres, at places along the beam."""

    x: tuple[float, ...]
    real: tuple[float, ...]
    imaginary: tuple[float, ...]


_OPERATION = (Column("SWR", "ratio"), Column("axis ratio", "+.5f"), Column("mm/s", "+.5g", 1e3))


def motor_rows_table(rows: "Sequence[MotorRow]") -> Table:
    """The motor's figures over sizes, at the drive's frequency and at each model's own best."""
    at = f"at {rows[0].drive.frequency_hz:g} Hz, the drive's frequency"
    if any(row.known_best for row in rows):
        at = f"left {at}, right at the model's own best"
    return Table(
        title="The motor over sizes",
        columns=(Column("model", left=True), Column("N"), *_OPERATION, Column("best Hz", ".2f"), *_OPERATION),
        rows=tuple(
            (MODELS[row.model].title or row.model, row.count, *_cells(row.drive)[1:], *_cells(row.best)) for row in rows
        ),
        notes=(
            "window [L/4, 3L/4], axis ratios as the mean over its whole half wavelengths, for the forces of the scene; "
            + at,
            *(f"{row.model}{f', N = {row.count}' if row.count else ''}: {row.note}" for row in rows if row.note),
        ),
    )


def _named(row: MotorRow) -> str:
    return MODELS[row.model].title if row.count is None else f"{row.count} {MODELS[row.model].title}"


def _cells(one: Operation | OffSearch | None) -> tuple[float | str | None, ...]:
    if not isinstance(one, Operation):
        return "falls off" if one else None, None, None, None
    return one.frequency_hz, one.standing_wave_ratio, one.axis_ratio, one.crest_speed


class MotorFound(Found, frozen=True, eq=False, kw_only=True):
    """The motor's figures alone."""

    rows: tuple[MotorRow, ...]

    def tables(self) -> tuple[Table, ...]:
        """The one."""
        return (motor_rows_table(self.rows),)

    def records(self) -> list[dict[str, Any]]:
        """Rows with one level of names."""
        return [_flat(row) for row in self.rows]

    def plain(self) -> Any:
        """The same."""
        return self.records()


def _flat(row: MotorRow) -> dict[str, Any]:
    line: dict[str, Any] = {"model": row.model, "count": row.count}
    for name, one in (("drive", row.drive), ("best", row.known_best)):
        found = msgspec.to_builtins(one) or dict.fromkeys(Operation.__struct_fields__)
        line |= {f"{name}_{key}": value for key, value in found.items()}
    return line | {"notes": [row.note] if row.note else []}


class WaveFound(Found, frozen=True, eq=False, kw_only=True):
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
    """Whether, undamped, the wave is pure along phase = -kL: equal forces as far from both pinned ends of a beam with
    nothing on it.
    """
    first_phase_deg: float
    """Of the first force; phases of the map are those of the second, absolute."""
    undamped: bool
    count: int
    other_drive: float
    """Standing-wave ratio of the exact field if the other kind of drive is imposed with the same phase."""
    snapshots: dict[str, Snapshot] = msgspec.field(default_factory=dict)
    """By model, of parts at their ends."""

    def in_short(self) -> str:
        """How pure the wave is at the drive."""
        (told,) = self.facts()
        return f"The {told}; 1 is a wave that travels, without reflection."

    def facts(self) -> tuple[str, ...]:
        """How pure the wave is on every model at the size of the envelopes, or at the largest that was asked for."""
        exact, *others = self.rows
        sizes = [row.count or 0 for row in others]
        size = self.count if self.count in sizes else max(sizes, default=0)
        shown = [exact, *(row for row in others if row.count == size)]
        ratios = [f"{_named(row)} {cell(row.drive.standing_wave_ratio, 'ratio')}" for row in shown]
        at = f"at {exact.drive.frequency_hz:g} Hz in the window [L/4, 3L/4]"
        return (f"standing-wave ratio {at}: {', '.join(ratios)}",)

    def tables(self) -> tuple[Table, ...]:
        """The motor over sizes, and where to drive."""
        motor = motor_rows_table(self.rows)
        damping = "Undamped" if self.undamped else "With the beam's loss factor"
        other = (
            f"{damping}. With the other kind of "
            "drive (force for displacement or the reverse) the exact beam's standing-wave ratio would be "
            f"{self.other_drive:.3f}."
        )
        return replace(motor, notes=(*motor.notes, other)), self._points_table()

    def _points_table(self) -> Table:
        return Table(
            title="Where to drive",
            columns=(
                Column("wanted", left=True),
                Column("frequency, Hz", ".2f"),
                Column("phase", ".2f", unit="°"),
                Column("reflection", ".4f"),
                Column("crest speed, mm/s", "+.4f", 1e3),
                Column("reflection per Hz", ".2g"),
                Column("per degree", ".2g"),
            ),
            rows=tuple(
                (p.what, p.frequency_hz, p.phase_deg, p.reflection, p.crest_speed, p.per_hertz, p.per_degree)
                for p in self.points
            ),
            notes=(
                "By the model of the map and, like the map, with loss factor "
                f"{self.operating_loss_factor:g}: without losses the crest speed has no bound near a resonance. Phases "
                "are those of the second force relative to the first.",
                *(f"{point.what}: {point.note}." for point in self.points if point.note),
                *(f"{note}." for note in self.notes),
            ),
        )

    def charts(self) -> tuple[Chart, ...]:
        """Envelopes, ellipses, map, figures over sizes."""
        from verify.studies.wave.charts import wave_charts

        return wave_charts(self)

    def plain(self) -> Any:
        """The motor's rows and operating points."""
        return {
            "rows": msgspec.to_builtins(self.rows),
            "points": msgspec.to_builtins(self.points),
            "notes": list(self.notes),
        }

    def records(self) -> list[dict[str, Any]]:
        """The motor's rows."""
        return [_flat(row) for row in self.rows]


def case_on(scene: "Scene", model: str, count: int | None) -> DrivenCase:
    """The scene's own drive on a model. Raises InputError."""
    return driven_case(Driven(model=model, count=count), scene)


def motor_row(scene: "Scene", bench: "Workbench", model: str, count: int | None) -> MotorRow:
    """The motor's figures of one model at one size."""
    case = case_on(scene, model, count)
    drive = operation(driven(case, bench))
    try:
        found = quietest_drive(case, SEARCH_SPAN, None, bench)
    except InputError as error:
        return MotorRow(model=model, count=count, drive=drive, best=None, note=str(error))
    if found.at_edge:
        off, note = OffSearch(found.x), edge_note("the reflection falls off", found.x)
        return MotorRow(model=model, count=count, drive=drive, best=off, note=note)
    best = operation(driven(replace(case, frequency_hz=found.x), bench))
    return MotorRow(model=model, count=count, drive=drive, best=best)


def models_of_waves(beam: Beam) -> list[str]:
    """Models of parts that have harmonic fields of a beam."""
    return [model.name for model in discrete("solve_harmonic", beam)]


def motor_table(
    scene: "Scene", bench: "Workbench", counts: tuple[int, ...], progress: Progress = lambda step: None
) -> tuple[MotorRow, ...]:
    """The exact beam, then every model of parts at every size. Raises InputError."""
    for model in models_of_waves(scene.beam):
        check_fields(scene.beam, model, counts, SEARCHED)
    rows = [motor_row(scene, bench, "analytic", None)]
    for model in models_of_waves(scene.beam):
        for count in counts:
            progress(f"{model}, N = {count}")
            rows.append(motor_row(scene, bench, model, count))
    return tuple(rows)


def wave_study(scene: "Scene", bench: "Workbench", asked: "Wave", progress: Progress = lambda step: None) -> WaveFound:
    """Everything a [wave] of a scene asks for. Raises InputError."""
    rows = motor_table(scene, bench, asked.counts, progress)
    progress("design map")
    model, count = asked.model, asked.count if MODELS.named(asked.model).sized else None
    eta = scene.beam.loss_factor or asked.operating_loss_factor
    chosen: dict[str, Any] = {"model": model, "loss_factor": eta} | ({"count": count} if count else {})
    assert scene.drive is not None
    span = asked.frequency_hz or around(scene.drive.frequency_hz, MAP_STEPS)
    # an axis of phases is the second force's own, what is asked for lies between both
    phases = tuple(scene.forces[0].phase_deg + between for between in _steps(asked.phase_deg))
    axes = (Axis("frequency_hz", _steps(span)), Axis("phase_deg", phases))
    sizes = {"analytic": None} | dict.fromkeys(models_of_waves(scene.beam), asked.count)
    fields = {name: driven(case_on(scene, name, n), bench) for name, n in sizes.items()}
    case = driven_case(Driven(model=model, count=count, loss_factor=eta), scene)
    points, problems = operating_points(case, asked.reflection_limit)
    x = np.linspace(0.0, scene.beam.length, 601)
    return WaveFound(
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
        other_drive=_under_the_other_drive(scene, bench),
        snapshots={name: _snapshot(field, sizes[name]) for name, field in fields.items()},
    )


def _snapshot(field: "HarmonicField", count: int | None) -> Snapshot:
    x = np.linspace(0.0, field.beam.length, (count or SMOOTH) + 1)
    w = field.deflection(x)
    return Snapshot(tuple(x.tolist()), tuple(w.real.tolist()), tuple(w.imag.tolist()))


def _under_the_other_drive(scene: "Scene", bench: "Workbench") -> float:
    """The exact beam's standing-wave ratio with displacements for forces, or the reverse."""
    own = case_on(scene, "analytic", None)
    other = replace(own, kind="displacement" if own.kind == "force" else "force")
    return measured_alone(driven(other, bench), None, "standing_wave_ratio")


def _pure_along_a_phase(scene: "Scene") -> bool:
    """Whether a phase between the forces makes the undamped wave pure at any frequency (phi = -kL).

    Not where a step, a body or a spring throws back what runs past, nor below the frequency to which a foundation
    lets nothing run.
    """
    first, second = scene.forces
    mirrored = abs(first.position + second.position - scene.beam.length) < 1e-9 * scene.beam.length
    equal = first.amplitude == second.amplitude and scene.beam.supports == ("pinned", "pinned")
    smooth = set(scene.beam.added) <= {"tension"}
    return scene.drive is not None and scene.drive.kind == "force" and mirrored and equal and smooth


def _steps(span: tuple[float, float, int]) -> tuple[float, ...]:
    return tuple(np.linspace(span[0], span[1], span[2]).tolist())


def _ellipses(beam: Beam, field: "HarmonicField") -> tuple[Ellipse, ...]:
    """Thirteen surface points evenly over the middle half of the beam."""
    places = np.linspace(0.25, 0.75, 13) * beam.length
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 49))
    across, up = lifted(beam, field.turn(places)), field.deflection(places)
    return tuple(
        Ellipse(x=float(x), across=tuple((u * turn).real.tolist()), up=tuple((w * turn).real.tolist()))
        for x, u, w in zip(places, across, up, strict=True)
    )
