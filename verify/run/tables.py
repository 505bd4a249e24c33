"""What `verify table` can tabulate: each kind says how many steps it takes, runs, and becomes text or a drawing."""

import math
from collections.abc import Callable
from math import isinf, isnan
from typing import Any

import msgspec

from verify.judge.workbench import Workbench
from verify.report.plain import finite, flat_row, work_as_plain
from verify.scenes.checked import checked
from verify.scenes.scene import Convergence, Counts, Scene, given_arguments, literal

Step = Callable[[str], None]


class Job(msgspec.Struct, frozen=True):
    """One table."""

    n_steps: int
    run: Callable[[Step], Any]
    flat: Callable[[Any], list[dict[str, Any]]]
    """Rows with one level of names, for CSV and Markdown."""
    draw: Callable[[Any], None]
    plain: Callable[[Any], Any] | None = None
    """For JSON; the flat rows where it is None."""

    def text(self, found: Any, layout: str) -> str:
        """The table as json, csv or markdown, ending in a newline."""
        if layout == "json":
            import json

            data = self.plain(found) if self.plain else self.flat(found)
            return json.dumps(finite(data), indent=2, allow_nan=False) + "\n"
        return rows_as_text(self.flat(found), layout)


def rows_as_text(rows: list[dict[str, Any]], layout: str) -> str:
    """Rows as csv or markdown, an infinite ratio in a word; notes are left to JSON."""
    columns = [name for name in rows[0] if name != "notes"]
    cells = [[_cell(row[name]) for name in columns] for row in rows]
    if layout == "csv":
        return "".join(",".join(line) + "\n" for line in [columns, *cells])
    rule = ["---:"] * len(columns)
    return "".join("| " + " | ".join(line) + " |\n" for line in [columns, rule, *cells])


def _cell(value: Any) -> str:
    """A figure with all its digits; nothing where there is none."""
    if value is None or (isinstance(value, float) and isnan(value)):
        return ""
    return f"{'-' * (value < 0)}infinity" if isinstance(value, float) and isinf(value) else str(value)


def convergence(scene: Scene, modes: str | None, counts: str | None) -> Job:
    """Errors and run time of modes over sizes. Raises InputError."""
    asked = msgspec.to_builtins(scene.convergence or Convergence())
    asked |= {name: _listed(text) for name, text in (("modes", modes), ("counts", counts)) if text is not None}
    request = checked(asked, Convergence)

    def run(step: Step) -> Any:
        from verify.studies.modes import convergence as solve

        return solve(Workbench(scene.beam), request, step)

    def draw(rows: Any) -> None:
        from verify.report.terminal import print_table

        print_table(rows)

    return Job(len(request.counts), run, lambda rows: [flat_row(row) for row in rows], draw)


def motor(scene: Scene, counts: str | None) -> Job:
    """SWR, axis ratio and crest speed over sizes, at the drive's frequency and at each model's best."""
    given = _listed(counts) if counts is not None else (scene.wave.counts if scene.wave else (49, 98, 196))
    sizes = checked(list(given), Counts, "counts")
    if len(scene.forces) != 2:
        from verify.errors import InputError

        raise InputError("--wave takes a scene with two forces: add them to its [drive]")

    def run(step: Step) -> Any:
        from verify.studies.wave import motor_table

        return motor_table(scene, Workbench(scene.beam), tuple(sizes), step)

    def draw(rows: Any) -> None:
        from verify.report.terminal import print_motor

        print_motor(rows)

    return Job(2 * len(sizes), run, _flat_motor, draw)


def _flat_motor(rows: Any) -> list[dict[str, Any]]:
    from verify.studies.wave import Operation

    flat = []
    for row in rows:
        line: dict[str, Any] = {"model": row.model, "count": row.count}
        for name in ("drive", "best"):
            found = msgspec.to_builtins(getattr(row, name)) or dict.fromkeys(Operation.__struct_fields__)
            line |= {f"{name}_{key}": value for key, value in found.items()}
        flat.append(line | {"notes": [row.note] if row.note else []})
    return flat


def slider(scene: Scene, counts: str | None) -> Job:
    """The slider's displacement, its error and its run time over sizes, both models. Raises InputError."""
    if scene.slider is None or scene.motion is None:
        from verify.errors import InputError

        raise InputError("--slider takes a scene with [slider] and [motion], for instance paper-slider")
    from verify.studies.work_precision import ROUNDS

    sizes = checked(list(_listed(counts) if counts is not None else scene.motion.counts), Counts, "counts")

    def run(step: Step) -> Any:
        from verify.studies.work_precision import work_of

        return work_of(scene, tuple(sizes), step)

    def draw(work: Any) -> None:
        from verify.report.terminal import print_work

        print_work(work)

    return Job(ROUNDS, run, lambda work: [msgspec.to_builtins(row) for row in work.rows], draw, work_as_plain)


def sweep(scene: Scene, sweeps: tuple[str, ...], quantity: str, arguments: tuple[str, ...]) -> Job:
    """A wave quantity over one or two axes. Raises InputError."""
    from verify.studies.design_map import design_map, parse_axis

    axes = tuple(parse_axis(text) for text in sweeps)
    given = given_arguments(arguments)

    def run(step: Step) -> Any:
        return design_map(quantity, given, axes, scene, Workbench(scene.beam), step)

    def draw(found: Any) -> None:
        from verify.report.terminal import print_map

        print_map(found)

    return Job(math.prod(len(axis.values) for axis in axes), run, _flat_map, draw, _plain_map)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _plain_map(found: Any) -> dict[str, Any]:
    rows = found.values.tolist()
    nested = [[_finite(v) for v in row] for row in rows] if found.values.ndim == 2 else [_finite(v) for v in rows]
    return {
        "quantity": found.quantity,
        "unit": found.unit,
        "axes": msgspec.to_builtins(found.axes),
        "values": nested,
        "method": found.method,
        "reasons": list(found.reasons),
    }


def _flat_map(found: Any) -> list[dict[str, Any]]:
    from itertools import product

    points = product(*(axis.values for axis in found.axes))
    names = [axis.name for axis in found.axes]
    return [
        {**dict(zip(names, point, strict=True)), found.quantity: _finite(float(value))}
        for point, value in zip(points, found.values.ravel(), strict=True)
    ]


def _listed(text: str) -> list[Any]:
    value = literal(text)
    return value if isinstance(value, list) else [value]
