"""The tables of a scene: what its run prints, its gates first; or its modes beside the exact ones."""

from typing import Any

import numpy as np

from verify.exports.sheets import Wanted, count_of, described, modes_sheet
from verify.judge.workbench import Workbench
from verify.run.gates import shown_expectation
from verify.run.runner import RunResult
from verify.scenes.scene import Scene
from verify.studies.told import Column, Table
from verify.words import figure, percent

_VERDICT = {True: "passed", False: "failed", None: "set aside"}


def tables_of(result: RunResult) -> tuple[Table, ...]:
    """Gates, then all tables of all studies."""
    found = [table for one in result.found.values() for table in one.tables()]
    return (*([_gates(result)] if result.gates else []), *found)


def _gates(result: RunResult) -> Table:
    columns = (
        Column("gate", left=True),
        Column("measured"),
        Column("unit", left=True),
        Column("expected", left=True),
        Column("verdict", left=True),
    )
    rows = tuple(
        (gate.id, figure(gate.measured), gate.unit, shown_expectation(gate.band), _VERDICT[gate.passed])
        for gate in result.gates
    )
    return Table(title="Gates", columns=columns, rows=rows)


def frequency_table(scene: Scene, wanted: Wanted) -> Table:
    """A model's frequencies beside the exact ones. Raises InputError."""
    found, count = modes_sheet(scene, wanted).beside["frequency_hz"], count_of(scene, wanted, ("spectrum",))
    bench = Workbench(scene.beam)
    exact = np.array([bench.exact_hz(mode) for mode in range(1, len(found) + 1)])
    rows = tuple(
        (mode, float(hertz), float(known), percent(float(hertz / known - 1.0)))
        for mode, (hertz, known) in enumerate(zip(found, exact, strict=True), start=1)
    )
    name = described(wanted.model, count)
    columns = (Column("mode"), Column(f"{name}, Hz", ".6f"), Column("exact, Hz", ".6f"), Column("error"))
    return Table(title=f"Natural frequencies of {name}", columns=columns, rows=rows)


def as_plain(tables: tuple[Table, ...]) -> list[dict[str, Any]]:
    """For JSON: every figure with all its digits."""
    return [
        {
            "title": table.title,
            "notes": list(table.below(range(len(table.columns)))),
            "rows": table.records(),
        }
        for table in tables
    ]
