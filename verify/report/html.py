"""The report page: a document in, one file out that asks no network."""

import json
from importlib.resources import files
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.files import write_whole
from verify.report.document import Document, PageTable, Section, document_of
from verify.report.inks import dark_inks
from verify.report.plain import finite
from verify.run.gates import GateResult, reference_in_words, shown_expectation
from verify.words import figure, seconds_in_words, share_of_band

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

    from verify.identify.told import Compared
    from verify.run.runner import RunResult
    from verify.scenes.scene import Scene


UPRIGHT = 112
"""Letters of a table's row on A4 in the size in which tables are printed."""
WRAPPED = 24
"""Letters of a cell from which on it is broken into lines."""


def write_report(result: "RunResult", path: Path, command: str) -> None:
    """Write the report of a run; `command` is the line that reproduces it. Raises InputError."""
    write_whole(path, page(result, command), "reports")


def write_comparison(scene: "Scene", found: "Compared", path: Path, command: str) -> None:
    """Write the report of somebody's model compared, as that of a run whose one finding it is. Raises InputError."""
    from verify.run.runner import RunResult

    named = msgspec.structs.replace(scene.bare, name=path.stem, title=f"A model of the beam of {scene.name}")
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
    """The page of a run; `work` is what was solved, where the result does not say it."""
    return rendered(document_of(result, command, work))


class GateGroup(msgspec.Struct, frozen=True, kw_only=True):
    """Gates on figures of one family."""

    name: str
    gates: tuple[GateResult, ...]

    @property
    def failed(self) -> bool:
        """Whether any of them failed."""
        return any(gate.passed is False for gate in self.gates)

    @property
    def told(self) -> str:
        """How many are held, and how near the worst is to its edge."""
        judged = [gate for gate in self.gates if gate.applicable]
        held = sum(gate.passed is True for gate in judged)
        shares = [gate.share for gate in judged if gate.share is not None]
        worst = f", at most {share_of_band(max(shares))} of a band used" if shares else ""
        aside = len(self.gates) - len(judged)
        return f"{held} of {len(judged)} held{worst}" + (f", {aside} not applicable" if aside else "")


def groups_of(gates: tuple[GateResult, ...]) -> tuple[GateGroup, ...]:
    """Gates by the family of their figures: what stands before the first dot of the quantity."""
    family = sorted(gates, key=lambda gate: gate.quantity.partition(".")[0])
    return tuple(
        GateGroup(name=name, gates=tuple(own))
        for name, own in groupby(family, key=lambda gate: gate.quantity.partition(".")[0])
    )


def worded(table: PageTable) -> bool:
    """Whether a column has sentences: a phone shows the rows of such a table one under the other."""
    return any(head.side == "long" for head in table.heads)


def broad(section: Section) -> bool:
    """Whether a table of a section has more in a row than a page of paper has room for upright."""
    return any(_letters(table) > UPRIGHT for table in section.tables if table.rows and not table.folded)


def _letters(table: PageTable) -> int:
    """In a row, each column as wide as its widest cell or what of it stays in one line."""
    columns = zip(table.heads, *table.rows, strict=True)
    return sum(2 + max(min(len(cell.text), WRAPPED) for cell in column) for column in columns)


def templates() -> "Environment":
    """Of pages, with the filters that they use."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=PackageLoader("verify", "report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {
        "figure": figure,
        "duration": seconds_in_words,
        "hyphens": _hyphens,
        "of_band": share_of_band,
        "band": shown_expectation,
        "reference": reference_in_words,
    }
    made.tests |= {"worded": worded, "broad": broad}
    return made


def rendered(document: Document) -> str:
    """The whole HTML page of a document: pictures, layer and data in one file."""
    from verify.report.plots import plot_of

    plots = [plot_of(chart) for chart in document.charts]
    set_aside = [gate for gate in document.gates if not gate.applicable]
    return (
        templates()
        .get_template("page.html.j2")
        .render(
            doc=document,
            failed=[gate for gate in document.gates if gate.passed is False],
            set_aside=set_aside,
            judged=len(document.gates) - len(set_aside),
            groups=groups_of(document.gates),
            plots=plots,
            data=_safe_json([plot.data for plot in plots]),
            css=part("page.css") + dark_inks(),
            js=part("page.js"),
        )
    )


def part(name: str) -> str:
    """A style or a script of the page."""
    return (files("verify.report") / name).read_text("utf-8")


def _hyphens(name: str) -> "Markup":
    """A name that may be broken behind its hyphens."""
    from markupsafe import Markup, escape

    return Markup("-<wbr>").join(escape(part) for part in name.split("-"))


def _safe_json(data: Any) -> str:
    """JSON that cannot end the script element it stands in."""
    return json.dumps(finite(data), allow_nan=False, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")
