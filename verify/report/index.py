"""Several runs as one: a line for each scene, on a page that links to theirs and in the terminal."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verify.analysis.verdict import LEVELS, Verdict
from verify.report.result import Column, Result, Table
from verify.report.summary import worst_gate

if TYPE_CHECKING:
    from verify.report.archive import Saved
    from verify.scene.run import RunResult

CANNOT = "cannot run"


def scene_line(run: "RunResult", name: str, saved: "Saved | None") -> dict[str, Any]:
    """What the index says of one run, as plain data."""
    worst = worst_gate(run)
    return {
        "scene": name,
        "title": run.scene.title or run.scene.name,
        "passed": run.passed,
        "level": run.verdict.level,
        "verdict": run.verdict.headline,
        "failed": [{"gate": one.gate.id, "reason": one.reason} for one in run.failed],
        "worst": None if worst is None else worst.gate.id,
        "fraction": None if worst is None else worst.fraction,
        "seconds": run.seconds,
        "page": str(saved.page) if saved else None,
        "folder": str(saved.folder) if saved and saved.folder else None,
    }


def failed_line(name: str, sentences: Sequence[str]) -> dict[str, Any]:
    """The same of a scene that cannot run."""
    return {"scene": name, "title": name, "passed": None, "level": LEVELS[-1], "failed": [], "errors": list(sentences)}


def index_result(lines: Sequence[dict[str, Any]]) -> Result:
    """All scenes as a result: those that fail first."""
    ordered = sorted(lines, key=lambda line: (line["passed"] is not None, line["passed"], -LEVELS.index(line["level"])))
    keys = ("scene", "verdict", "worst", "fraction", "seconds")
    rows = [(CANNOT if one["passed"] is None else one["level"], *map(one.get, keys)) for one in ordered]
    columns = [Column(name) for name in ("level", "scene", "verdict", "worst gate")]
    columns += [Column("of tolerance", format=".3g", percent=True), Column("time", "s", ".3g")]
    reasons = [(line["scene"], one["gate"], one["reason"]) for line in ordered for one in line["failed"]]
    reasons += [(line["scene"], "", text) for line in ordered for text in line.get("errors", ())]
    failed = Table("Failed", [Column("scene"), Column("gate"), Column("reason")], reasons)
    return Result(
        summary=index_verdict(lines),
        tables=[Table("Scenes", columns, rows), *([failed] if reasons else [])],
        data={"scenes": list(lines), "passed": all(line["passed"] for line in lines)},
    )


def index_verdict(lines: Sequence[dict[str, Any]]) -> str:
    """One line over all scenes."""
    bad = sum(line["passed"] is not True for line in lines)
    text, levels = f"{bad} of {len(lines)} scenes failed", [line["level"] for line in lines]
    return f"{text}: " + ", ".join(f"{levels.count(one)} {one}" for one in LEVELS if one in levels)


def write_index(lines: Sequence[dict[str, Any]], path: Path, command: str, seconds: float) -> None:
    """Write the page over all scenes. Raises InputError where it cannot be written."""
    from os.path import relpath

    from verify.files import write_whole
    from verify.report.page import Section, render

    links = {line["scene"]: Path(relpath(line["page"], path.parent)).as_posix() for line in lines if line.get("page")}
    result = index_result(lines)
    sections = [Section(table.title.lower(), table.title, tables=[table], links=links) for table in result.tables]
    page = render(
        "scenes",
        sections,
        title="All scenes",
        verdict=Verdict(level=max((line["level"] for line in lines), key=LEVELS.index), headline=result.summary),
        seconds=seconds,
        command=command,
    )
    write_whole(path, page, "reports")
