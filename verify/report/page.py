"""HTML pages: one file each, with charts inside, that needs no network and no script."""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verify.report.plotting import figure_svg, movie_image
from verify.report.result import Figure, Movie, Result, Table, to_json
from verify.report.summary import (
    environment,
    expected,
    gates_table,
    skipped_table,
    study_title,
    value_text,
    worst_gate,
)

if TYPE_CHECKING:
    from jinja2 import Template

    from verify.scene.run import RunResult

LONG = 30
"""Rows beyond which a table is folded."""
DENSE = 6
"""Columns beyond which a table has small print."""
WIDE, NARROW = 40, 22
"""Characters of a column of text beyond which it wraps early, and below which it does not wrap."""


@dataclass(frozen=True)
class Section:
    """A part of a page under one heading."""

    id: str
    title: str
    paragraphs: Sequence[str] = ()
    warnings: Sequence[str] = ()
    figures: Sequence[Figure] = ()
    movies: Sequence[Movie] = ()
    tables: Sequence[Table] = ()
    links: Mapping[str, str] = field(default_factory=dict)
    """Addresses by the text of a table cell that becomes a link."""
    code: str = ""
    folded: bool = False


def run_page(run: "RunResult", command: str = "") -> str:
    """The report of a run as HTML."""
    from verify.report.beam_drawing import beam_figure

    scene, beam = run.scene, beam_figure(run.scene)
    studies = [_study_section(run, name, result) for name, result in run.results.items()]
    summaries = [(section.title, section.id, " ".join(section.paragraphs)) for section in studies if section.paragraphs]
    sections = [Section("gates", "Gates", tables=[gates_table(run)])] if run.gates else []
    sections += studies
    if run.skipped:
        sections.append(Section("skipped", "Not run", tables=[skipped_table(run)]))
    sections.append(Section("inputs", "Inputs", code=to_json(scene), folded=True))
    worst = worst_gate(run)
    return render(
        name=scene.name,
        title=scene.title or scene.name,
        subtitle=scene.description,
        verdict=run.verdict,
        seconds=run.seconds,
        gates=run.gates_in_words,
        problems=[f"{one.gate.id}: {one.reason}" for one in run.failed],
        warnings=list(dict.fromkeys(run.warnings)),
        drawing=figure_svg(beam),
        drawing_caption=beam.caption,
        summaries=summaries,
        worst=None if worst is None else (worst, value_text(worst.value), expected(worst.gate)),
        sections=sections,
        command=command,
    )


def _study_section(run: "RunResult", name: str, result: Result) -> Section:
    figures = [replace(one, id=f"{name}-{one.id.removeprefix(f'{name}-')}") for one in result.figures]
    movies = [replace(one, id=f"{name}-{one.id.removeprefix(f'{name}-')}") for one in result.movies]
    summary = [result.summary] if result.summary else []
    return Section(name, study_title(run, name), summary, result.warnings, figures, movies, result.tables)


def render(name: str, sections: Sequence[Section], **values: Any) -> str:
    """A page of sections below a verdict; `values` are the template's other variables."""
    shown = [
        {
            "id": section.id,
            "section": section,
            "figures": [_figure(figure, name) for figure in section.figures],
            "movies": [_movie(movie, name) for movie in section.movies],
            "tables": [_table(table, section.links) for table in section.tables],
        }
        for section in sections
    ]
    css = Path(__file__).with_name("page.css").read_text("utf-8")
    return _template().render(name=name, sections=shown, environment=environment(), css=css, **values)


@lru_cache
def _template() -> "Template":
    from jinja2 import Environment, FileSystemLoader

    loader = FileSystemLoader(Path(__file__).parent)
    made = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    return made.get_template("page.html.j2")


def data_uri(kind: str, content: str | bytes) -> str:
    """Content as an address that a page carries with it."""
    raw = content.encode() if isinstance(content, str) else content
    return f"data:{kind};base64,{b64encode(raw).decode()}"


def _figure(figure: Figure, page: str) -> dict[str, Any]:
    svg = figure_svg(figure)
    return {"figure": figure, "svg": svg, "file": f"{page}-{figure.id}", "link": data_uri("image/svg+xml", svg)}


def _movie(movie: Movie, page: str) -> dict[str, Any]:
    moving, still = (data_uri("image/webp", image) for image in movie_image(movie))
    return {"movie": movie, "moving": moving, "still": still, "file": f"{page}-{movie.id}"}


def _table(table: Table, links: Mapping[str, str]) -> dict[str, Any]:
    headings, texts, n = table.headings(), table.text_rows(), range(len(table.columns))
    words = [any(isinstance(row[i], str) for row in table.rows) for i in n]
    widths = [max((len(row[i]) for row in texts), default=0) for i in n]
    kinds = ["n" if not words[i] else "long" if widths[i] > WIDE else "short" if widths[i] < NARROW else "" for i in n]

    def cell(i: int, value: Any, text: str) -> dict[str, Any]:
        kind = {"pass": "pass", "FAIL": "fail", "cannot run": "fail"}.get(text, kinds[i])
        bar = float(value) if table.columns[i].name == "of tolerance" and value is not None else None
        return {"text": text, "kind": kind, "heading": headings[i], "bar": bar, "link": links.get(text)}

    stacked = " stack" if len(n) > DENSE or "long" in kinds else ""
    return {
        "table": table,
        "headings": [(headings[i], "" if words[i] else "n") for i in n],
        "rows": [[cell(i, row[i], text[i]) for i in n] for row, text in zip(table.rows, texts, strict=True)],
        "folded": len(table.rows) > LONG,
        "kind": f"{' dense' * (len(n) > DENSE)}{' whole' * (len(table.rows) < 12)}{stacked}",
        "csv": data_uri("text/csv", table.csv()),
    }
