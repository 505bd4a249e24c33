"""Mode shapes over one another, chosen by their number: exact, elements, segments raw and corrected."""

from typing import TYPE_CHECKING

import numpy as np

from verify.errors import InputError
from verify.judge.variants import Variant
from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import BROAD, numbers
from verify.units import Unit, unit_of

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.models.arrays import Array

POINTS = 161
"""Of the exact line."""
MOST = 24
"""Modes to choose among: of more the first and the last, and as many between."""
EXACT = "analytic"


def shapes_chart(bench: "Workbench", variants: tuple[Variant, ...], count: int, modes: int) -> tuple[Chart, ...]:
    """The chart of as many modes; none where a beam's exact shapes are not to be had."""
    chosen = sorted({int(n) for n in np.linspace(1, modes, min(modes, MOST)).round()})
    x, theory = np.linspace(0.0, bench.beam.length, POINTS), variants[0].theory
    try:
        exact = [_exact(bench, mode, x, theory) for mode in chosen]
    except InputError:
        return ()
    unit = unit_of(bench.beam.length)
    lines = [_moving(MODELS[EXACT].title, MODELS[EXACT].colour, unit.factor * x, exact, width=BROAD)]
    for one in _first(variants, theory):
        lines += _readings(bench, one, count, chosen, unit)
    return (
        Chart(
            id="mode-shapes",
            title=f"Mode shapes, N = {count}",
            caption="Normalised to the same modal mass. Points of a model are where it knows its shape: joints or ends "
            "of elements. Of the chain, raw are the joints themselves, corrected what y + δ²y/12 makes of them.",
            x=Axis(f"x, {unit.name}"),
            y=Axis("deflection, 1/√kg"),
            lines=tuple(lines),
            frames=tuple(f"mode {mode}" for mode in chosen),
        ),
    )


def _first(variants: tuple[Variant, ...], theory: str) -> list[Variant]:
    """The first variant of each model by one theory."""
    found: dict[str, Variant] = {}
    for one in variants:
        if one.theory == theory:
            found.setdefault(one.model, one)
    return list(found.values())


def _exact(bench: "Workbench", mode: int, x: "Array", theory: str) -> "Array":
    from verify.exact.modes import mode_shape

    return mode_shape(bench.beam, mode, x, theory=theory)


def _readings(bench: "Workbench", one: Variant, count: int, modes: list[int], unit: Unit) -> list[Line]:
    """A line for each way in which a model reads its shape; none where it has not as many modes."""
    try:
        found = bench.modes(one.model, count, modes[-1], one.settings)
        index = [bench.paired_index(one.model, count, mode, one.settings) for mode in modes]
    except InputError:
        return []
    model = MODELS[one.model]
    lines = []
    for i, (name, read) in enumerate(found.readings.items()):
        values = read()
        words = f"{model.title}, {name}" if len(found.readings) > 1 else model.title
        rows, x = [values[k] for k in index], unit.factor * found.nodes
        lines.append(_moving(words, model.colour, x, rows, marker="square" if i else "circle", hollow=i > 0))
    return lines


def _moving(
    name: str, colour: str, x: "Array", rows: "list[Array]", width: float = 1.6, marker: str = "", hollow: bool = False
) -> Line:
    moves = tuple(numbers(row) for row in rows)
    return Line(
        name=name,
        colour=colour,
        x=numbers(x),
        y=moves[-1],
        moves=moves,
        width=width,
        marker="square" if marker == "square" else "circle" if marker else "",
        size=5.0 if hollow else 4.0,
        joined=not marker,
        hollow=(hollow,) * len(x) if hollow else (),
    )
