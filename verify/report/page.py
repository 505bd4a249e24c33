"""HTML pages of a run and of several: one file each, with charts inside, that needs no network and no script."""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from os.path import relpath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verify.analysis import verdict
from verify.files import write_whole
from verify.formatting import with_unit
from verify.report import beam_drawing
from verify.report.plotting import figure_files, movie_image
from verify.report.result import Column, Figure, Movie, Result, Table, plain
from verify.report.summary import environment, gates_sentence, gates_table, study_title
from verify.scene.file import toml_text

if TYPE_CHECKING:
    from verify.report.archive import Saved
    from verify.scene.run import RunResult

LONG = 30  # rows beyond which a table is folded
DENSE = 6  # columns beyond which a table has small print
LEVELS = verdict.LEVELS[::-1]  # levels of a verdict, the worst first
CANNOT = "cannot run"
MARKS = dict.fromkeys((LEVELS[0], "FAIL", CANNOT), "fail") | dict.fromkeys((LEVELS[2], "pass"), "pass")
MARKS[LEVELS[1]] = "warn"  # class of a cell with this text
SPEEDS = "Speed of the slider"  # title of a table that follows the verdict, whichever study it belongs to
WORST, REST = 3, "Further margins"  # margins that are not folded, and the title of the others
WIDE, NARROW = 40, 22  # characters of a column of text beyond which it wraps early, and below which it does not wrap


@dataclass(frozen=True)
class Section:
    """A part of a page under one heading."""

    id: str
    title: str
    finding: str = ""  # the result in a sentence, which follows the verdict with a link to the section
    caveats: Sequence[tuple[str, str, str]] = ()  # (title of a section, its id, sentence)
    figures: Sequence[Figure] = ()
    condition: str = ""  # condition of all figures, a part of their captions
    movies: Sequence[Movie] = ()
    tables: Sequence[Table] = ()
    links: Mapping[str, str] = field(default_factory=dict)  # addresses by the text of a table cell that becomes a link
    code: str = ""
    folded: bool = False


def run_page(run: "RunResult", command: str = "") -> str:
    """The report of a run as HTML: verdict, results, margins and caveats, then figures, no sentence twice."""
    scene, headline = run.scene, run.verdict.headline
    problems = [(gate.id, gate.reason) for gate in run.failed]
    caveats = dict.fromkeys(run.warnings, ("", ""))
    for name, result in run.results.items():
        for text in result.warnings:
            caveats.setdefault(text, (study_title(run, name), name))
    above = {headline, *(why for _, why in problems)}
    listed = [(*where, text) for text, where in caveats.items() if text not in above]
    speeds = [table for result in run.results.values() for table in result.tables if table.title == SPEEDS]
    sizes = (Column(name, format=".3g", percent=True) for name in ("trusted below", "not trusted above"))
    columns = [Column("level"), Column("margin"), *sizes, Column("condition"), Column("remedy")]
    rows: list[Any] = []
    for margin in (margin for margin in run.verdict.margins if margin.name != "gates"):  # they have a table
        limits = (margin.fine, margin.limit) if margin.is_error and isfinite(margin.size) else (None, None)
        texts = [margin.condition if margin.level == "conditional" else margin.failure, margin.remedy]
        texts = ["" if margin.level == "trusted" or text.lower() in headline.lower() else text for text in texts]
        rows.append((margin.level, margin.text, *map(plain, limits), *texts))
    reasons = [Table("Margins", columns, rows[:WORST]), Table(REST, columns, rows[WORST:])]
    skipped = Table("Not run", [Column("what"), Column("why")], [(part.what, part.why) for part in run.skipped])
    sections = [
        Section("margins", "Margins", tables=[table for table in reasons if table.rows]),
        Section("caveats", "Caveats", caveats=listed),
        Section("speeds", SPEEDS, tables=speeds),
        *(_study_section(run, name) for name in run.results),
        Section("gates", "Gates", gates_sentence(run), tables=[gates_table(run)] * bool(run.gates)),
        Section("skipped", "Not run", tables=[skipped] * bool(run.skipped), folded=True),
        Section("inputs", "Inputs", code=_inputs(scene), folded=True),
    ]
    return render(
        name=scene.name,
        title=scene.title or scene.name,
        subtitle=scene.description,
        level=run.verdict.level,
        verdict=headline,
        seconds=run.seconds,
        problems=[f"{what}: {why}" for what, why in problems if why not in headline],
        others=run.verdict.others,
        drawing=beam_drawing.beam_figure(scene),
        narrow=figure_files(beam_drawing.beam_figure(scene, beam_drawing.NARROW), 0.0)[0],
        sections=[part for part in sections if part.id in run.results or part.tables or part.caveats or part.code],
        command=command,
    )


def _inputs(scene: Any) -> str:
    """The values of a scene as TOML; its gates have a table."""

    def given(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: one for key, part in value.items() if (one := given(part)) not in (None, [], {})}
        return [given(one) for one in value if one is not None] if isinstance(value, list) else value

    return toml_text(given({key: value for key, value in plain(scene).items() if key != "gate"}))


def _study_section(run: "RunResult", name: str) -> Section:
    result, beam, drive = run.results[name], run.scene.beam, run.scene.drive
    charts: Any = (result.figures, result.movies)
    figures, movies = ([replace(x, id=f"{name}-{x.id.removeprefix(f'{name}-')}") for x in kind] for kind in charts)
    tables = [table for table in result.tables if table.title != SPEEDS]
    driven = f", driven at {drive.frequency_hz:g} Hz" if drive and name in ("wave", "motion", "motor") else ""
    condition = f"Beam: {with_unit(beam.length, form='.4g')}, {'-'.join(beam.supports)}{driven}."
    finding = result.summary or "No valid result: see its caveats and margins."
    return Section(name, study_title(run, name), finding, (), figures, condition, movies, tables)


def scene_line(run: "RunResult", name: str, saved: "Saved | None") -> dict[str, Any]:
    """The index's line of one run, as plain data."""
    return {
        "scene": name,
        "title": run.scene.title or run.scene.name,
        "passed": run.passed,
        "gates": [sum(gate.passed is True for gate in run.gates), len(run.gates)],
        "level": run.verdict.level,
        "verdict": run.verdict.headline,
        "failed": [{"gate": gate.id, "reason": gate.reason} for gate in run.failed],
        "seconds": run.seconds,
        "page": str(saved.page) if saved else None,
        "folder": str(saved.folder) if saved and saved.folder else None,
    }


def failed_line(name: str, sentences: Sequence[str]) -> dict[str, Any]:
    """Index line of a scene that cannot run."""
    return {"scene": name, "title": name, "passed": None, "gates": [0, 0], "failed": [], "errors": list(sentences)}


def index_result(lines: Sequence[dict[str, Any]]) -> Result:
    """All scenes as a result, a row for each: the worst first."""
    ordered = sorted(lines, key=lambda line: [None, *LEVELS].index(line.get("level")))
    rows = [(x.get("level", CANNOT), x["scene"], x.get("verdict"), *x["gates"], x.get("seconds")) for x in ordered]
    columns = [*map(Column, ("level", "scene", "headline", "passed", "gates")), Column("time", "s", ".3g")]
    reasons = [(line["scene"], gate["gate"], gate["reason"]) for line in ordered for gate in line["failed"]]
    reasons += [(line["scene"], "", text) for line in ordered for text in line.get("errors", ())]
    failed = Table("Failed", [Column("scene"), Column("gate"), Column("reason")], reasons)
    levels = [line.get("level", CANNOT) for line in lines]
    counts = [f"{levels.count(level)} {level}" for level in (CANNOT, *LEVELS) if level in levels]
    bad, n = sum(line["passed"] is not True for line in lines), len(lines)
    passed, gates = (sum(line["gates"][i] for line in lines) for i in (0, 1))
    good = f"{n} scenes, " + (f"all {passed} gates passed" if passed else "no gate ran")
    none = sum(not line["gates"][1] for line in lines)
    good += f", {none} without a gate" * bool(passed and none)
    good += f", --set skips {gates - passed}" * (gates > passed)
    return Result(
        summary=(f"{bad} of {n} scenes failed" if bad else good) + f". Verdicts: {', '.join(counts)}.",
        tables=[Table("Scenes", columns, rows), *([failed] if reasons else [])],
        data={"scenes": list(lines), "passed": all(line["passed"] for line in lines)},
    )


def write_index(lines: Sequence[dict[str, Any]], path: Path, command: str, seconds: float) -> None:
    """Write the page over all scenes, with the banner of the gates. Raises InputError where it cannot be written."""
    links = {line["scene"]: Path(relpath(line["page"], path.parent)).as_posix() for line in lines if line.get("page")}
    result = index_result(lines)
    worst = min((line.get("level", LEVELS[0]) for line in lines), key=LEVELS.index)
    sections = [Section(table.title.lower(), table.title, tables=[table], links=links) for table in result.tables]
    page = render(
        "scenes",
        sections,
        title="All scenes",
        level="gates passed" if all(line["passed"] and line["gates"][0] for line in lines) else worst,
        verdict=result.summary,
        seconds=seconds,
        command=command,
    )
    write_whole(path, page, "reports")


def render(name: str, sections: Sequence[Section], **values: Any) -> str:
    """A page of sections below a verdict; `values` are the template's other variables."""
    from jinja2 import Environment, FileSystemLoader

    loader = FileSystemLoader(Path(__file__).parent)
    templates = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    templates.globals.update(show_figure=_figure, show_movie=_movie, cells=_table, environment=environment())
    css = Path(__file__).with_name("page.css").read_text("utf-8")
    return templates.get_template("page.html.j2").render(name=name, sections=sections, css=css, **values)


def data_uri(kind: str, content: str | bytes) -> str:
    """Content as an address that a page carries with it."""
    raw = content.encode() if isinstance(content, str) else content
    return f"data:{kind};base64,{b64encode(raw).decode()}"


def _figure(figure: Figure, page: str) -> dict[str, Any]:
    svg, png = figure_files(figure, 110.0)
    links = {"SVG": data_uri("image/svg+xml", svg), "PNG": data_uri("image/png", png)}
    return {"svg": svg, "file": f"{page}-{figure.id}", "links": links}


def _movie(movie: Movie) -> dict[str, str]:
    moving, still = (data_uri("image/webp", image) for image in movie_image(movie))
    return {"moving": moving, "still": still}


def _table(table: Table, links: Mapping[str, str]) -> dict[str, Any]:
    (headings, texts, words, widths), n = table.layout(), range(len(table.columns))
    kinds = ["n" if not words[i] else "long" if widths[i] > WIDE else "short" if widths[i] < NARROW else "" for i in n]

    def cell(i: int, value: Any, text: str) -> dict[str, Any]:
        kind = MARKS.get(text, kinds[i])
        bar = float(value) if table.columns[i].name == "of tolerance" and value is not None else None
        return {"text": text, "kind": kind, "heading": headings[i], "bar": bar, "link": links.get(text)}

    stacked = " stack" if "long" in kinds else ""
    return {
        "table": table,
        "headings": [(headings[i], "" if words[i] else "n") for i in n],
        "rows": [[cell(i, row[i], text[i]) for i in n] for row, text in zip(table.rows, texts, strict=True)],
        "folded": len(table.rows) > LONG or table.title == REST,
        "kind": f"{' dense' * (len(n) > DENSE)}{' whole' * (len(table.rows) < 12)}{stacked}",
        "csv": data_uri("text/csv", table.csv()),
    }
