"""The report page: results in, one file out."""

import json
import os
import platform
import sys
from collections import Counter
from collections.abc import Iterator
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.files import write_whole
from verify.report.plain import finite
from verify.run.gates import shown_expectation
from verify.studies.catalogue import STUDIES
from verify.words import cell, figure, seconds_in_words, told_once, work_in_words

if TYPE_CHECKING:
    from markupsafe import Markup

    from verify.identify.told import Compared
    from verify.run.runner import RunResult
    from verify.scenes.scene import Scene
    from verify.studies.told import Column, Table

SENTENCE = 32
"""Characters from which on words in a cell may be broken into lines."""
_PACKAGES = ("fem-segment-verify", "numpy", "scipy", "scikit-fem", "plotly")


def write_report(result: "RunResult", path: Path, command: str) -> None:
    """Write the report of a run; `command` is the line that reproduces it. Raises InputError."""
    write_whole(path, page(result, command), "reports")


def write_comparison(scene: "Scene", found: "Compared", path: Path, command: str) -> None:
    """Write the report of somebody's model compared, as that of a run whose one finding it is. Raises InputError."""
    from verify.run.runner import RunResult

    named = msgspec.structs.replace(
        scene.bare, name=path.stem, title=f"A model of the beam of {scene.name}", description=found.answer
    )
    result = RunResult(
        scene=named,
        gates=found.gates,
        found={"compare": found},
        solves=(),
        n_fields=0,
        n_motions=0,
        seconds=found.seconds,
    )
    write_whole(path, page(result, command, f"{found.solved} candidates solved"), "reports")


def page(result: "RunResult", command: str, work: str = "") -> str:
    """The whole HTML page, plotly's script included; `work` is what was solved, where the result does not say it."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    loader = PackageLoader("verify", "report")
    templates = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    templates.filters |= {
        "figure": figure,
        "duration": seconds_in_words,
        "hyphens": _hyphens,
        "band": shown_expectation,
    }
    charts = [chart for found in result.found.values() for chart in found.charts()]
    return templates.get_template("page.html.j2").render(
        result=result,
        work=work or work_in_words(len(result.solves), result.n_fields, result.n_motions, result.others),
        judged=len(result.gates) - len(result.set_aside),
        charts=charts,
        sections=list(sections_of(result)),
        figures=_safe_json({chart.id: {"data": chart.data, "layout": chart.layout} for chart in charts}),
        plotly=_plotly_script() if charts else "",
        environment=environment(),
        command=command,
    )


class Section(msgspec.Struct, frozen=True):
    """What one study tells on the page, beside its charts."""

    name: str
    title: str
    facts: tuple[str, ...]
    tables: tuple[dict[str, Any], ...]
    notes: tuple[str, ...]
    """What stands below several of its tables, once."""


def sections_of(result: "RunResult") -> Iterator[Section]:
    """Every study that has words or tables for the page."""
    for name, found in result.found.items():
        shown = [table for table in found.tables() if table.shown != "terminal"]
        counted = Counter(note for table in shown for note in table.notes)
        shared = tuple(told_once(note for note, times in counted.items() if times > 1))
        tables = tuple(_on_page(table, shared) for table in shown)
        if facts := found.facts():
            facts = tuple(fact[:1].upper() + fact[1:] for fact in facts)
        if facts or tables:
            title = STUDIES[name].title if name in STUDIES else ""
            yield Section(name, title or name.capitalize(), facts, tables, shared)


def _hyphens(name: str) -> "Markup":
    """A name that may be broken behind its hyphens."""
    from markupsafe import Markup, escape

    return Markup("-<wbr>").join(escape(part) for part in name.split("-"))


def _verdict(value: bool | None) -> str:
    """The colour of a verdict."""
    return "soft" if value is None else "pass" if value else "fail"


def _side(i: int, column: "Column", rows: tuple[tuple[Any, ...], ...]) -> str:
    """Numbers stand right; words left, with room where they are sentences."""
    if not column.left:
        return "n"
    longest = max((len(row[i]) for row in rows if isinstance(row[i], str)), default=0)
    return "long" if longest > SENTENCE else "word" if longest < SENTENCE // 2 else ""


def _on_page(table: "Table", shared: tuple[str, ...]) -> dict[str, Any]:
    """A table with its figures written out: heads with their side, rows of cells, sentences before and after."""
    sides = [_side(i, column, table.rows) for i, column in enumerate(table.columns)]
    rows = [
        [
            (
                _verdict(value) if column.form == "verdict" else side,
                cell(value, column.form, column.factor, column.unit),
            )
            for side, value, column in zip(sides, row, table.columns, strict=True)
        ]
        for row in table.rows
    ]
    heads = [(side, column.head) for side, column in zip(sides, table.columns, strict=True)]
    return {
        "title": table.title,
        "before": table.before,
        "heads": heads,
        "rows": rows,
        "notes": told_once(note for note in table.notes if note not in shared),
        "folded": table.folded,
    }


def environment() -> dict[str, str]:
    """What the figures were made with: versions, those of packages that bring models too, platform, processors."""
    versions = {name: metadata.version(name) for name in _PACKAGES}
    groups = ("verify.models", "verify.quantities", "verify.studies")
    points = (point for group in groups for point in metadata.entry_points(group=group))
    versions |= {point.dist.name: point.dist.version for point in points if point.dist}
    return {
        "Python": platform.python_version(),
        **versions,
        "platform": f"{platform.system()} {platform.machine()}",
        "processors": str(len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count()),
    }


def _safe_json(data: Any) -> str:
    """JSON that cannot end the script element it stands in."""
    return json.dumps(finite(data), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _plotly_script() -> str:
    """plotly.js as installed, found without importing plotly."""
    spec = find_spec("plotly")
    for folder in (spec.submodule_search_locations or []) if spec else []:
        script = Path(folder) / "package_data" / "plotly.min.js"
        if script.is_file():
            return script.read_text("utf-8")
    raise InputError("plotly's script plotly.min.js is not installed: reinstall plotly, or use --no-report")
