"""Several runs as one: a line for each scene, on a page that links to theirs and in the terminal."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from verify.report.page import LEVELS, Section, render
from verify.report.result import Column, Result, Table

if TYPE_CHECKING:
    from verify.report.archive import Saved
    from verify.scene.run import RunResult

CANNOT = "cannot run"


def scene_line(run: "RunResult", name: str, saved: "Saved | None") -> dict[str, Any]:
    """The index's line of one run, as plain data."""
    return {
        "scene": name,
        "title": run.scene.title or run.scene.name,
        "passed": run.passed,
        "gates": [sum(one.passed is True for one in run.gates), len(run.gates)],
        "level": run.verdict.level,
        "verdict": run.verdict.headline,
        "failed": [{"gate": one.gate.id, "reason": one.reason} for one in run.failed],
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
    reasons = [(line["scene"], one["gate"], one["reason"]) for line in ordered for one in line["failed"]]
    reasons += [(line["scene"], "", text) for line in ordered for text in line.get("errors", ())]
    failed = Table("Failed", [Column("scene"), Column("gate"), Column("reason")], reasons)
    levels = [line.get("level", CANNOT) for line in lines]
    counts = [f"{levels.count(level)} {level}" for level in (CANNOT, *LEVELS) if level in levels]
    bad, n = sum(line["passed"] is not True for line in lines), len(lines)
    passed, gates = (sum(line["gates"][i] for line in lines) for i in (0, 1))
    good = f"{n} scenes, " + (f"all {passed} gates passed" if passed else "no gate ran")
    good += f", --set skips {gates - passed}" * (gates > passed)
    return Result(
        summary=(f"{bad} of {n} scenes failed" if bad else good) + f". Verdicts: {', '.join(counts)}.",
        tables=[Table("Scenes", columns, rows), *([failed] if reasons else [])],
        data={"scenes": list(lines), "passed": all(line["passed"] for line in lines)},
    )


def write_index(lines: Sequence[dict[str, Any]], path: Path, command: str, seconds: float) -> None:
    """Write the page over all scenes, with the banner of the gates. Raises InputError where it cannot be written."""
    from os.path import relpath

    from verify.files import write_whole

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
