"""One sheet for each case, as a manual of verification has it: problem, references, models, figures, reasons.

Takes scenes and, where their gates were judged, the verdicts; gives plain values and Markdown (MyST), no file. A sheet
of a scene that was not run has everything but what is measured.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import msgspec

from verify.models.catalogue import MODELS
from verify.options import REFERENCES, Reference
from verify.quantities.catalogue import QUANTITIES
from verify.run.asks import Ask, asks_of
from verify.run.gates import NOT_SAID, Band, GateResult, given_band, reference_in_words, shown_expectation
from verify.words import figure, share_of_band

if TYPE_CHECKING:
    from verify.scenes.scene import Gate, Scene

WHAT_EXISTS = ("beam", "drive", "slider", "motion")
"""Sections of a scene that are its problem; what is asked of it stands in its figures."""
DRAWING = "<!-- drawing: {scene} -->"
"""Where a drawing of the beam belongs."""


class Input(msgspec.Struct, frozen=True, kw_only=True):
    """One given value of a problem."""

    key: str
    """Dotted, an entry of a list by its number from 1: beam.mass 2.position."""
    value: Any
    meaning: str
    """With its unit."""


class Figure(msgspec.Struct, frozen=True, kw_only=True):
    """One gate: what is asked, what stands behind its expectation, and where it was judged what came out."""

    id: str
    quantity: str
    meaning: str
    """Of the quantity."""
    arguments: dict[str, Any]
    models: tuple[str, ...]
    """Of the three by name, and what is made of them; none where the figure is of no such model."""
    work: str
    """What kind of work the figure is: modes, harmonic, in time, equilibrium, a closed form."""
    unit: str
    expected: str
    band: Band
    reference: Reference | None
    uncertainty: float | None
    source: str
    why: str
    measured: Any = None
    """A number, { re, im } or { lower, upper }; None where nothing was judged."""
    share: float | None = None
    """Of the band: 0 in its middle, 1 at its edge."""
    passed: bool | None = None
    """None where nothing was judged."""
    reason: str = ""
    """Why it failed."""


class Sheet(msgspec.Struct, frozen=True, kw_only=True):
    """One case."""

    scene: str
    title: str
    description: str
    inputs: tuple[Input, ...]
    references: dict[str, int]
    """How many figures have which kind of reference; those of none under `not said`."""
    figures: tuple[Figure, ...]
    judged: bool


def sheet_of(scene: "Scene", tables: dict[str, Any], results: Iterable[GateResult] = ()) -> Sheet:
    """The sheet of a scene as its plain `tables` state it, with what was measured for gates that `results` has."""
    verdicts = {one.id: one for one in results}
    asks = {ask.name: ask for ask in asks_of(scene, gates_only=True)}
    figures = tuple(_figure(gate, asks[gate.id], verdicts.get(gate.id)) for gate in scene.gate)
    return Sheet(
        scene=scene.name,
        title=scene.title or scene.name,
        description=" ".join(scene.description.split()),
        inputs=tuple(_inputs(tables)),
        references=kinds(figures),
        figures=figures,
        judged=bool(verdicts),
    )


def kinds(figures: Iterable[Figure]) -> dict[str, int]:
    """How many figures have which kind of reference, in the order of `options`; kinds that do not occur left out."""
    counted = Counter(one.reference or NOT_SAID for one in figures)
    return {kind: counted[kind] for kind in (*REFERENCES, NOT_SAID) if counted[kind]}


def _figure(gate: "Gate", ask: Ask, result: GateResult | None) -> Figure:
    found = QUANTITIES.get(gate.quantity, None)
    models = dict.fromkeys((*(need.model for need in ask.needs), *ask.models))
    return Figure(
        id=gate.id,
        quantity=gate.quantity,
        meaning=found.summary if found else "",
        arguments=gate.arguments,
        models=tuple(models),
        work=" and ".join(ask.works),
        unit=found.unit if found else "",
        expected=shown_expectation(given_band(gate)),
        band=given_band(gate),
        reference=gate.reference,
        uncertainty=gate.uncertainty,
        source=gate.source,
        why=gate.why,
        measured=result.measured if result else None,
        share=result.share if result else None,
        passed=result.passed if result else None,
        reason=result.reason if result else "",
    )


def _inputs(tables: dict[str, Any]) -> Iterator[Input]:
    """What the tables of a scene say of what exists, in the order in which they say it."""
    from verify.scenes.described import sections

    kinds_of_tables = sections()
    for name in WHAT_EXISTS:
        if name in tables:
            yield from _stated(tables[name], name, name, kinds_of_tables)


def _stated(table: dict[str, Any], where: str, section: str, kinds_of_tables: dict[str, Any]) -> Iterator[Input]:
    """One table, dotted as `verify keys` has it in `section`, with the numbers of entries in `where`."""
    from verify.scenes.described import meanings

    told = meanings(kinds_of_tables[section])
    for key, value in table.items():
        inner, name = f"{section}.{key}", f"{where}.{key}"
        if inner not in kinds_of_tables:
            yield Input(key=name, value=value, meaning=told.get(key, ""))
            continue
        for i, entry in enumerate(value, 1) if isinstance(value, list) else ((0, value),):
            yield from _stated(entry, f"{name} {i}" if i else name, inner, kinds_of_tables)


# --- Markdown --------------------------------------------------------------------------------------------------------


def markdown(sheet: Sheet, drawing: str = "") -> str:
    """A sheet as Markdown, `drawing` (Markdown as well) in its slot."""
    inputs = [[f"`{one.key}`", _in_words(one.value), one.meaning] for one in sheet.inputs]
    overview = [
        [
            f"[{one.id}](#{_label(sheet, one)})",
            _models(one),
            one.reference or NOT_SAID,
            _with_unit(one.expected, one.unit),
        ]
        + [_measured(one)] * sheet.judged
        for one in sheet.figures
    ]
    heads = ["figure", "model", "reference", "expected", *["measured"] * sheet.judged]
    parts = [
        f"# {_escaped(sheet.title)}",
        f"Scene `{sheet.scene}`: `verify run {sheet.scene}`",
        "## Problem",
        _escaped(sheet.description),
        drawing or DRAWING.format(scene=sheet.scene),
        _table(["input", "value", "meaning"], inputs),
        "## References",
        f"{_sum_of_kinds(sheet.references)}.",
        "## Figures",
        _table(heads, overview) if overview else "No figure is held to anything.",
        *(_section(sheet, one) for one in sheet.figures),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def _row(sheet: Sheet, one: Figure) -> list[str]:
    """One figure in the table of all."""
    link, expected = f"[{one.id}](#{_label(sheet, one)})", _with_unit(one.expected, one.unit)
    return [link, _models(one), one.reference or NOT_SAID, expected, *[_measured(one)] * sheet.judged]


def index(sheets: Iterable[Sheet]) -> str:
    """The page before all sheets: how many figures have which reference, and a table of contents."""
    sheets = tuple(sheets)
    known = tuple(one for sheet in sheets for one in sheet.figures)
    rows = [
        [f"[{_escaped(sheet.title)}]({sheet.scene}.md)", str(len(sheet.figures)), _kinds_in_words(sheet.references)]
        for sheet in sheets
    ]
    contents = "\n".join(("```{toctree}", ":hidden:", "", *(sheet.scene for sheet in sheets), "```"))
    parts = [
        "# Catalogue",
        f"{_sum_of_kinds(kinds(known))}.",
        _table(["case", "figures", "references"], rows),
        contents,
    ]
    return "\n\n".join(parts) + "\n"


def _sum_of_kinds(counted: dict[str, int]) -> str:
    """'24 figures: 17 closed form, 3 published'."""
    total = sum(counted.values())
    if not total:
        return "No figures"
    return f"{total} figure{'s' * (total > 1)}: {_kinds_in_words(counted)}"


def _kinds_in_words(counted: dict[str, int]) -> str:
    return ", ".join(f"{n} {kind}" for kind, n in counted.items())


def _label(sheet: Sheet, one: Figure) -> str:
    """What links name a figure by: two scenes may have gates of one id."""
    return f"{sheet.scene}-{one.id}".lower()


def _section(sheet: Sheet, one: Figure) -> str:
    """Everything about one figure."""
    arguments = ", ".join(f"`{key} = {_in_words(value)}`" for key, value in one.arguments.items())
    rows = [
        ["quantity", f"`{one.quantity}`: {_escaped(one.meaning)}"],
        ["arguments", arguments or "as the scene has them"],
        ["models", _models(one)],
        ["expected", _with_unit(one.expected, one.unit)],
        ["reference", _escaped(_reference(one))],
        ["source", _escaped(one.source) or NOT_SAID],
        *([["measured", _measured(one)]] if sheet.judged else []),
        ["why", _escaped(one.why)],
    ]
    return f"({_label(sheet, one)})=\n### {one.id}\n\n" + _table(["", ""], rows)


def _reference(one: Figure) -> str:
    """Kind and uncertainty; the source has a line of its own."""
    from types import SimpleNamespace

    kept: Any = SimpleNamespace(reference=one.reference, uncertainty=one.uncertainty, source="")
    return reference_in_words(kept, one.unit)


def _models(one: Figure) -> str:
    """In words: 'rigid segments, Hermite elements'."""
    return (
        ", ".join(MODELS[name].title if name in MODELS else name for name in one.models)
        or f"none of the three ({one.work})"
    )


def _measured(one: Figure) -> str:
    if one.passed is None:
        return "–"
    share = "" if one.share is None else f", {share_of_band(one.share)} of its band"
    failed = "" if one.passed else f", **failed**: {_escaped(one.reason)}"
    return f"{_with_unit(figure(one.measured), one.unit)}{share}{failed}"


def _with_unit(text: str, unit: str) -> str:
    return text if unit in ("", "1") else f"{text} {unit}"


def _in_words(value: Any) -> str:
    """A value of a scene: numbers with all digits given, lists with commas."""
    if isinstance(value, list | tuple):
        return ", ".join(map(_in_words, value))
    return f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else str(value)


def _table(heads: list[str], rows: list[list[str]]) -> str:
    """A table of Markdown; what would end a cell is escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(_cell(cell) for cell in line) + " |" for line in lines)


def _cell(text: str) -> str:
    return re.sub(r"(?<!\\)\|", r"\\|", " ".join(text.split()))


def _escaped(text: str) -> str:
    """Words in which Markdown would read signs of its own."""
    return re.sub(r"([*<`$])", r"\\\1", text)
