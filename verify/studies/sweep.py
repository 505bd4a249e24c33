"""Quantities over the Cartesian product of scene keys and quantity arguments, on all cores or on a cluster.

A sweep may write its rows to a file of JSON lines as they complete, from which the same sweep continues after a kill.
The first line has the versions, a hash of the scene, and the sweep; each further one has a combination, its values, and
what `Sweep.run` needs beside them. When all are there the file is sorted: then it is the same, byte for byte, whatever
computed it.
"""

import json
import os
from collections.abc import Mapping, Sequence
from functools import partial
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta

from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.analysis.verdict import Margin, badness, missing
from verify.errors import InputError, shown
from verify.estimate import as_text
from verify.files import MESH, append, exists, readable, write_whole
from verify.parallel import completed, versions, workers
from verify.quantities.base import QUANTITIES
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import unit_symbol
from verify.studies.tables import Variants

MOST = 100_000  # combinations, each of which is a row in memory
AGREE = "claims that agree"
WIDE = 30.0  # ratio of largest to smallest value from which an axis is logarithmic


class Sweep(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Quantities over every combination of the lists in `over`.

    A key of `over` with a dot is a key of the scene ("beam.youngs_modulus", "drive.force.0.phase_deg", with * for all
    entries), one without is an argument of the quantities. Several keys joined by commas vary together, through a list
    of lists.
    """

    name, title, devices = "sweep", "Sweep", True

    quantities: Annotated[tuple[str, ...], Meta(min_length=1, description="Names, see `verify quantities`.")]
    over: Annotated[dict[str, list[Any]], Meta(min_length=1, description="Values by scene key or argument.")]
    arguments: Annotated[dict[str, Any], Meta(description="Fixed arguments, where a quantity has them.")] = {}  # noqa: RUF012
    claims: Annotated[bool, Meta(description="Count the scene's claims that agree in each combination.")] = False

    def _variants(self, scene: Scene) -> Variants:
        return Variants.of(scene, [(name, {}) for name in self.quantities])

    def check(self, scene: Scene) -> None:
        """Raise InputError for an unknown quantity, scene key or argument, and for an empty list."""
        self._variants(scene).check_keys((*self.arguments, *_combinations(self.over)[0]), "sweep")
        if self.claims and not scene.claim:
            raise InputError("sweep.claims = true, and the scene has no [[claim]]: add one, or leave it out")

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress, file: Path | None = None) -> Result:
        """Evaluate the quantities over every combination of the lists in `over`, the first key slowest.

        Runs on as many processes as VERIFY_JOBS says, or on the workers of `parallel.cluster`.
        Rows are appended to `file`; those that it already has are not computed. Returns one table with a row for each
        combination, and a chart of each quantity over one or two lists. Raises InputError for an unknown quantity, key
        or argument, and for a file of another sweep; a combination that raises it is a row with the reason.
        """
        self.check(scene)
        variants, combinations = self._variants(scene), _combinations(self.over)
        header = _header(self, variants.tables) if file else b""
        lines = _lines(file, header) if file else {}
        todo = [i for i in range(len(combinations)) if i not in lines]
        tasks = [(variants, self, combinations[i], i) for i in todo]
        # unbuffered: an interrupt comes before or after a whole line
        with open(file or os.devnull, "ab", buffering=0) as out, workers(len(todo) - 1) as executor:
            for i, line in completed(_evaluate, tasks, executor, first_here=True):
                append(out, line, "--to")
                lines[todo[i]] = line
                progress(f"combination {len(lines)} of {len(combinations)}")
        if file:
            write_whole(file, b"".join((header, *(lines[i] for i in sorted(lines)))).decode(), "--to")
        rows = [_row(lines[i]) for i in range(len(combinations))]
        ordered = sorted((margin for row in rows for margin in row.pop("margins")), key=badness)
        margins = list({margin.name: margin for margin in ordered}.values())  # of each the worst combination's
        if "count" in combinations[0]:  # coarse sizes are the subject, not a fault
            margins = [margin for margin in margins if not margin.name.startswith("discretisation")]
        quantities, reasons = [QUANTITIES[name] for name in self.quantities], [row["reason"] for row in rows]
        failed, why = sum(reason is not None for reason in reasons), next(filter(None, reasons), "")
        margins += missing("combinations", failed, len(rows), why)
        columns = [Column(key, format=".6g") for key in combinations[0]]
        columns += [Column(q.name, unit_symbol(q.unit), ".7g") for q in quantities]
        columns += [Column(AGREE)] * self.claims + [Column("reason")] * bool(failed)
        cells = [tuple(_cell(row[column.name]) for column in columns) for row in rows]
        note, where = f"Claims of the scene: {len(scene.claim)}.", " and ".join(self.over)
        return Result(
            summary=f"{len(rows)} combinations, {failed} without a value.",
            tables=[Table(f"Sweep over {where}", columns, cells, [note] * self.claims)],
            figures=[
                Figure(f"sweep-{q.name}", f"{q.name} over {where}", q.summary, partial(_draw, self, rows, q))
                for q in quantities
                if len(self.over) <= 2 and any(_number(row[q.name]) for row in rows)
            ],
            data={"rows": rows},
            margins=margins,
        )


def _evaluate(task: tuple[Variants, Sweep, dict[str, Any], int]) -> bytes:
    """The line of one combination: values by quantity, claims that agree, reason for a missing value, margins."""
    variants, study, combination, number = task
    row = variants.row(study.arguments | combination, margins=True, claims=study.claims)
    figures = dict(zip(study.quantities, row.values, strict=True))
    notes = {AGREE: row.agreeing, "reason": row.reason, "margins": msgspec.to_builtins(row.margins)}
    return json.dumps({"row": number, "combination": combination, **figures, **notes}).encode() + b"\n"


def _row(line: bytes) -> dict[str, Any]:
    """The combination and the values of a line, with its margins."""
    row = json.loads(line)
    del row["row"]
    return {**row.pop("combination"), **row, "margins": msgspec.convert(row["margins"], list[Margin])}


def _header(study: Sweep, tables: Mapping[str, Any]) -> bytes:
    """The first line of a sweep's file."""
    digest = sha256(json.dumps({**tables, "title": "", "description": ""}, sort_keys=True).encode()).hexdigest()
    provenance = {"versions": versions(), "scene": tables["name"], "sha256 of the scene": digest}
    return json.dumps(provenance | {"sweep": msgspec.to_builtins(study)}).encode() + b"\n"


def _lines(file: Path, header: bytes) -> dict[int, bytes]:
    """Lines by number of the combinations that a file has; a new file gets its header. Raises InputError."""
    text = readable(file, "--to", MESH).read_bytes() if exists(file, "--to") else b""
    first, *lines = text.splitlines(keepends=True) or [header]
    lines = [line for line in lines if line.endswith(b"\n")]  # a kill may leave half of one
    try:
        required, present = json.loads(header), json.loads(first)
        differing = [name for name in required if required[name] != present[name]]
        complete = {json.loads(line)["row"]: line for line in lines}
    except (ValueError, KeyError, TypeError):
        differing, complete = ["contents"], {}
    if differing:
        what = f"has the rows of another sweep (other {', '.join(differing)}): name another file, or delete it"
        raise InputError(f"--to {shown(str(file))} {what}")
    write_whole(file, b"".join((header, *lines)).decode(), "--to")
    return complete


def _combinations(over: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Values by key of every combination, the first key slowest. Raises InputError."""
    axes, size = [], 1
    for joined, values in over.items():
        keys = [key.strip() for key in joined.split(",")]
        together = [value if len(keys) > 1 else [value] for value in values]
        if not values or any(not isinstance(row, list) or len(row) != len(keys) for row in together):
            each = f"lists of {len(keys)} values" if len(keys) > 1 else "values"
            raise InputError(f"sweep.over.{joined} = {shown(list(values))}: give {each}, one at least")
        axes.append([dict(zip(keys, row, strict=True)) for row in together])
        size *= len(values)
    if size > MOST:
        raise InputError(f"sweep.over has {size} combinations: give at most {MOST}")
    return [{key: value for part in parts for key, value in part.items()} for parts in product(*axes)]


def _cell(value: Any) -> Any:
    """A value of a table: numbers, words; anything else as text."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    kind = {("re", "im"): complex, ("lower", "upper"): Bracket}.get(tuple(value)) if isinstance(value, dict) else None
    return as_text(kind(*value.values())) if kind else str(value)


def _draw(study: Sweep, rows: list[dict[str, Any]], quantity: Any, ax: Axes) -> None:
    """A line over one list, lines or a colour map over two, by whether the second has words; gaps without a value."""
    values = np.array([row[quantity.name] if _number(row[quantity.name]) else np.nan for row in rows], dtype=float)
    first, *second = study.over.items()
    places = [_place(ax, "x", *first)]
    label = f"{quantity.name}, {unit_symbol(quantity.unit)}".rstrip(", ")
    if second and _rising(second[0][1]):
        places.append(_place(ax, "y", *second[0]))
        mesh = ax.pcolormesh(*places, values.reshape(len(places[0]), -1).T, shading="nearest", cmap="viridis")
        ax.figure.colorbar(mesh, ax=ax, label=label)
        ax.grid(False)
        return
    keys = [key.rpartition(".")[2] for key in second[0][0].split(",")] if second else []
    names = [f"{', '.join(keys)} = {_label(value)}" for value in second[0][1]] if second else [""]
    for name, line in zip(names, values.reshape(len(places[0]), -1).T, strict=True):
        ax.plot(places[0], line, "-o", label=name)
    if np.nanmin(values) > 0.0 and np.nanmax(values) > WIDE * np.nanmin(values):
        ax.set_yscale("log")
    ax.set_ylabel(label)
    if second:
        ax.legend()


def _rising(values: list[Any]) -> bool:
    return all(map(_number, values)) and sorted(set(values)) == values


def _place(ax: Axes, axis: str, key: str, values: list[Any]) -> list[Any]:
    """Label and scale an axis for a list; the coordinates of its values."""
    getattr(ax, f"set_{axis}label")(key)
    if not _rising(values):
        getattr(ax, f"set_{axis}ticks")(range(len(values)), [_label(value) for value in values])
        return list(range(len(values)))
    if values[0] > 0.0 and values[-1] / values[0] > WIDE:
        getattr(ax, f"set_{axis}scale")("log")
    return values


def _label(value: Any) -> str:
    return f"{value:g}" if _number(value) else ", ".join(map(_label, value)) if isinstance(value, list) else str(value)


def _number(value: Any) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool)
