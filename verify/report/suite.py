"""All scenes as one: what a run of several says, as plain values, and its page."""

import re
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.files import write_whole
from verify.report.answer import answers_of, told_remarks
from verify.report.document import environment
from verify.report.inks import dark_inks
from verify.words import seconds_in_words

if TYPE_CHECKING:
    from verify.report.kept import Written
    from verify.run.runner import RunResult

PAGE = "index.html"
NEAREST = 5
"""Gates that are told, of those nearest to their edge."""
SLOWEST = 3
_ID = re.compile(r'( id="|href="#|url\(#)')
_WORDS = re.compile(r"<text\b.*?</text>", re.DOTALL)
_SEEN = re.compile(r'viewBox="[^"]*"')
_MARGIN = 6.0
_BEAM = "30 30 800 130"
"""Of a beam's drawing, the part in which something is drawn."""


class Near(msgspec.Struct, frozen=True):
    """A gate that is held, and the share of its band that it uses."""

    scene: str
    gate: str
    share: float
    why: str


class Failed(msgspec.Struct, frozen=True):
    """A gate that is not."""

    gate: str
    reason: str


class Card(msgspec.Struct, frozen=True, kw_only=True):
    """What is told of one scene that was run."""

    name: str
    """Of its report."""
    title: str
    judged: int
    """Gates that apply."""
    aside: int
    """Gates that do not."""
    failed: tuple[Failed, ...]
    answer: str
    seconds: float
    nearest: tuple[Near, ...]
    picture: str
    """SVG; empty where no page is written."""
    seen: str
    """What the picture shows."""
    report: str
    """Its page, as a link from the page of all; empty where none is written."""
    kept: str

    @property
    def passed(self) -> bool:
        """Whether every gate is held that applies."""
        return not self.failed


class Refused(msgspec.Struct, frozen=True, kw_only=True):
    """A scene that could not be run."""

    name: str
    sentences: tuple[str, ...]


class Suite(msgspec.Struct, frozen=True, kw_only=True):
    """A run of several scenes."""

    date: str
    seconds: float
    at_once: int
    """Processes."""
    command: str
    environment: dict[str, str]
    scenes: tuple[Card | Refused, ...]
    """In the order in which they were asked for."""

    @property
    def cards(self) -> tuple[Card, ...]:
        """Those that were run."""
        return tuple(one for one in self.scenes if isinstance(one, Card))

    @property
    def refused(self) -> tuple[Refused, ...]:
        """Those that could not be."""
        return tuple(one for one in self.scenes if isinstance(one, Refused))

    @property
    def judged(self) -> int:
        """Gates that apply."""
        return sum(card.judged for card in self.cards)

    @property
    def failed(self) -> int:
        """Gates that are not held."""
        return sum(len(card.failed) for card in self.cards)

    @property
    def passed(self) -> bool:
        """Whether every scene was run and every gate is held that applies."""
        return not self.refused and not self.failed

    @property
    def verdict(self) -> str:
        """In one line."""
        n = len(self.cards)
        told = f"{n} scene{'s' * (n != 1)} in {seconds_in_words(self.seconds)}"
        lost = f", {len(self.refused)} scene{'s' * (len(self.refused) != 1)} could not run" if self.refused else ""
        if self.failed:
            return f"{self.failed} of {self.judged} gates failed{lost}: {told}"
        if not self.judged:
            return f"No gate is judged{lost}: {told}"
        return f"All {self.judged} gates passed{lost}: {told}"

    @property
    def nearest(self) -> tuple[Near, ...]:
        """Gates that are held and use most of their bands."""
        every = [near for card in self.cards for near in card.nearest]
        return tuple(sorted(every, key=lambda near: -near.share)[:NEAREST])

    @property
    def slowest(self) -> tuple[Card, ...]:
        """Scenes that took longest."""
        return tuple(sorted(self.cards, key=lambda card: -card.seconds)[:SLOWEST])


def suite_of(scenes: tuple[Card | Refused, ...], seconds: float, command: str, at_once: int) -> Suite:
    """What a run of several scenes says."""
    return Suite(
        date=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        seconds=seconds,
        at_once=at_once,
        command=command,
        environment=environment(),
        scenes=scenes,
    )


def card_of(result: "RunResult", name: str, written: "Written | None", folder: Path) -> Card:
    """What is told of a scene, with a picture where its page is written."""
    judged = [gate for gate in result.gates if gate.applicable]
    near = [Near(name, gate.id, gate.share, gate.why) for gate in judged if gate.passed and gate.share is not None]
    picture, seen = _picture(result, name) if written else ("", "")
    return Card(
        name=name,
        title=result.scene.title or result.scene.name,
        judged=len(judged),
        aside=len(result.set_aside),
        failed=tuple(Failed(gate.id, gate.reason) for gate in result.failed),
        answer=" ".join((*answers_of(result)[:1], *told_remarks(result.scene))),
        seconds=result.seconds,
        nearest=tuple(sorted(near, key=lambda one: -one.share)[:NEAREST]),
        picture=picture,
        seen=seen,
        report=written.latest.relative_to(folder).as_posix() if written else "",
        kept=written.folder.relative_to(folder).as_posix() if written and written.folder else "",
    )


def _picture(result: "RunResult", name: str) -> tuple[str, str]:
    """The first chart without its words, or the beam; what it shows."""
    from verify.report.beam_drawing import beam_drawing
    from verify.report.drawing import drawn

    charts = [chart for found in result.found.values() for chart in found.charts()]
    if not charts:
        return _bare(beam_drawing(result.scene), name, f'viewBox="{_BEAM}"'), "The beam"
    drawing = drawn(charts[0])
    left, top, right, bottom = drawing.box
    seen = f"{left - _MARGIN:g} {top - _MARGIN:g} {right - left + 2 * _MARGIN:g} {bottom - top + 2 * _MARGIN:g}"
    return _bare(drawing.svg, name, f'viewBox="{seen}" preserveAspectRatio="none"'), charts[0].title


def _bare(svg: str, name: str, seen: str) -> str:
    """A picture without words, its names made other than those of pictures beside it on one page."""
    bare = _SEEN.sub(seen, _WORDS.sub("", svg), count=1)
    return _ID.sub(lambda found: f"{found[1]}{name}-", bare)


def write_suite(suite: Suite, folder: Path) -> Path:
    """Write the page of all beside those of the scenes. Raises InputError."""
    path = folder / PAGE
    write_whole(path, rendered(suite), "reports")
    return path


def rendered(suite: Suite) -> str:
    """The page."""
    from verify.models.catalogue import MODELS
    from verify.report.html import part, templates

    keys = {MODELS[name].title or MODELS[name].parts: MODELS[name].colour for name in MODELS.built_in}
    css = part("page.css") + dark_inks() + part("suite.css")
    return templates().get_template("suite.html.j2").render(suite=suite, keys=keys, css=css)


def as_plain(suite: Suite, runs: list[dict[str, Any]], page: Path | None) -> dict[str, Any]:
    """For `verify run --json`: each scene as if it were alone, or why it could not run."""
    return {
        "passed": suite.passed,
        "seconds": suite.seconds,
        "scenes": runs,
        "report": str(page) if page else None,
    }
