"""What changed between two runs that were kept: gates first, then what is said, versions and inputs."""

from collections.abc import Iterable, Iterator
from typing import Any

import msgspec

from verify.errors import InputError
from verify.report.document import Document
from verify.report.kept import Kept
from verify.run.gates import GateResult
from verify.words import VERDICTS, figure, seconds_in_words, share_of_band

WORDS = {True: "pass", False: "FAIL", None: "n/a"}
"""Verdicts of gates."""
ABSENT = "–"
_VERDICTS = set(VERDICTS.values())
_REFERRED = ("reference", "uncertainty", "source", "why")
"""Fields of a gate that say where its expectation comes from."""


class GateChange(msgspec.Struct, frozen=True, kw_only=True):
    """A gate that is not what it was; None where a run has no such gate."""

    id: str
    before: GateResult | None
    after: GateResult | None

    @property
    def broken(self) -> bool:
        """Whether it was held and fails now."""
        return bool(self.before and self.after and self.before.passed is True and self.after.passed is False)

    @property
    def fails_now(self) -> bool:
        """Whether it fails and did not, held before or not judged."""
        return bool(self.after and self.after.passed is False and not self.same_verdict)

    @property
    def unjudged(self) -> bool:
        """Whether it was held, and is gone or does not apply."""
        return bool(self.before and self.before.passed and (self.after is None or self.after.passed is None))

    @property
    def verdict(self) -> str:
        """'pass', or 'pass to FAIL'."""
        words = [WORDS[one.passed] if one else "not there" for one in (self.before, self.after)]
        return words[0] if words[0] == words[1] else f"{words[0]} to {words[1]}"

    @property
    def same_verdict(self) -> bool:
        """Whether it is there in both runs and judged alike."""
        return bool(self.before and self.after and self.before.passed is self.after.passed)

    @property
    def measured(self) -> str:
        """What was and is measured, and by how much that differs."""
        old, new = (one.measured if one else None for one in (self.before, self.after))
        return figure(new) if old == new else f"{_apart(old, new)}{_relative(old, new)}"

    @property
    def expected(self) -> str:
        """What was and is expected."""
        return _two(*(one.expected if one else ABSENT for one in (self.before, self.after)))

    @property
    def share(self) -> str:
        """The share of its band that it used and uses."""
        return _two(*(_share(one) for one in (self.before, self.after)))


class Change(msgspec.Struct, frozen=True):
    """Something that is not what it was; None where a run has none."""

    what: str
    before: str | None
    after: str | None


class Difference(msgspec.Struct, frozen=True, kw_only=True):
    """All that changed in one scene."""

    name: str
    dates: tuple[str, str]
    seconds: tuple[float, float]
    gates: tuple[GateChange, ...]
    same: int
    """Judged gates of which nothing changed."""
    aside: int
    """Gates that neither run judged."""
    said: tuple[Change, ...]
    """What holds and did not or the other way, answers and facts; one that stands in another's place beside it."""
    versions: tuple[Change, ...]
    inputs: tuple[Change, ...]

    @property
    def broken(self) -> tuple[GateChange, ...]:
        """Gates that were held and fail."""
        return tuple(gate for gate in self.gates if gate.broken)

    @property
    def verdict(self) -> str:
        """In one line."""
        if self.broken:
            return f"{_counted(len(self.broken), 'gate')} held before and fail{'s' * (len(self.broken) == 1)} now"
        others = [gate for gate in self.gates if not gate.same_verdict]
        if others:
            return f"{_counted(len(others), 'verdict')} changed, none from pass to FAIL"
        if self.gates:
            return f"the same verdicts; {len(self.gates)} of {self.same + len(self.gates)} gates are not what they were"
        changed = ", not all else" if self.said or self.versions or self.inputs else ""
        aside = f", {_counted(self.aside, 'gate')} judged in neither" if self.aside else ""
        return f"{_counted(self.same, 'gate')} the same to the last digit{aside}{changed}"


class Differences(msgspec.Struct, frozen=True, kw_only=True):
    """All that changed between two runs, or two folders of them."""

    before: str
    after: str
    scenes: tuple[Difference, ...]
    only_before: tuple[str, ...]
    only_after: tuple[str, ...]
    unjudged: int
    """Gates that were held and of which nothing is known now: they, or their scene, are gone, or they do not apply."""

    @property
    def broken(self) -> int:
        """Gates that were held and fail."""
        return sum(len(one.broken) for one in self.scenes)

    @property
    def verdict(self) -> str:
        """In one line."""
        n = self.unjudged
        gone = f", {n} {'is' if n == 1 else 'are'} judged no more" if n else ""
        if self.broken:
            return f"{_counted(self.broken, 'gate')} held before and fail{'s' * (self.broken == 1)} now{gone}"
        return f"No gate that was held fails now{gone}"


def differences(before: dict[str, Kept], after: dict[str, Kept], names: tuple[str, str]) -> Differences:
    """What changed between runs of the same names; two single runs are compared whatever they are called.

    Raises InputError where there is nothing to compare.
    """
    if len(before) == len(after) == 1:
        (one,), (other,) = before.values(), after.values()
        title = one.report if one.report == other.report else f"{one.report} to {other.report}"
        pairs = {title: (one.document, other.document)}
    else:
        pairs = {name: (before[name].document, after[name].document) for name in before if name in after}
    if not pairs:
        raise InputError(
            f"A = {names[0]!r} holds {', '.join(before)} and B = {names[1]!r} holds {', '.join(after)}, nothing of one "
            "name: give two runs of the same"
        )
    single = len(before) == len(after) == 1
    scenes = [difference(name, *pair) for name, pair in pairs.items()]
    gone = [] if single else [kept.document for name, kept in before.items() if name not in after]
    return Differences(
        before=names[0],
        after=names[1],
        scenes=tuple(sorted(scenes, key=lambda one: not one.broken)),
        only_before=() if single else tuple(name for name in before if name not in after),
        only_after=() if single else tuple(name for name in after if name not in before),
        unjudged=sum(gate.unjudged for one in scenes for gate in one.gates)
        + sum(gate.passed is True for one in gone for gate in one.gates),
    )


def difference(name: str, before: Document, after: Document) -> Difference:
    """What changed between two documents."""
    gates = tuple(_gates(before.gates, after.gates))
    changed = {gate.id for gate in gates}
    alike = [gate for gate in after.gates if gate.id not in changed]
    return Difference(
        name=name,
        dates=(before.date, after.date),
        seconds=(before.seconds, after.seconds),
        gates=tuple(sorted(gates, key=lambda gate: (not gate.broken, gate.same_verdict))),
        same=sum(gate.passed is not None for gate in alike),
        aside=sum(gate.passed is None for gate in alike),
        said=(*_held(before, after), *_lines("answer", before.answers, after.answers), *_facts(before, after)),
        versions=tuple(_values(before.environment, after.environment)),
        inputs=(
            *_values(_inputs(before.problem.toml), _inputs(after.problem.toml)),
            *_questions(before.gates, after.gates),
        ),
    )


def _gates(before: Iterable[GateResult], after: Iterable[GateResult]) -> Iterator[GateChange]:
    """Gates of which verdict, figure, expectation or share changed; how long they took is none of it."""
    old, new = ({gate.id: gate for gate in gates} for gates in (before, after))
    for name in dict.fromkeys((*old, *new)):
        one, other = old.get(name), new.get(name)
        if one is None or other is None or _judged(one) != _judged(other):
            yield GateChange(id=name, before=one, after=other)


def _questions(before: Iterable[GateResult], after: Iterable[GateResult]) -> Iterator[Change]:
    """What gates that are in both runs ask, and what they refer to: by that their figures can differ, or not at all."""
    old, new = ({gate.id: dict(_asked(gate)) for gate in gates} for gates in (before, after))
    for name in (name for name in old if name in new):
        yield from _values(old[name], new[name])


def _asked(gate: GateResult) -> Iterator[tuple[str, str]]:
    told = {name: getattr(gate, name) for name in ("quantity", "arguments", *_REFERRED)}
    return _flat({name: value for name, value in told.items() if value not in (None, "")}, f"gate.{gate.id}")


def _judged(gate: GateResult) -> tuple[Any, ...]:
    return gate.passed, gate.measured, gate.expected, gate.share


def _held(before: Document, after: Document) -> Iterator[Change]:
    """Rows that hold or fail, as claims do, and have another verdict than before; None where a run has no such row."""
    old, new = _judged_rows(before), _judged_rows(after)
    for what, name in dict.fromkeys((*old, *new)):
        one, other = old.get((what, name)), new.get((what, name))
        if (one and one[0]) != (other and other[0]):
            yield Change(what, *(f"{told[0]} {name}{told[1]}" if told else None for told in (one, other)))


def _judged_rows(document: Document) -> dict[tuple[str, str], tuple[str, str]]:
    """Rows that begin with a verdict, by their study and name: the verdict, and their figures by their heads."""
    found = {}
    for section in document.sections:
        for table in section.tables:
            for verdict, name, *rest in (row for row in table.rows if len(row) > 1 and row[0].text in _VERDICTS):
                pairs = zip(table.heads[2:], rest, strict=True)
                shown = (
                    f"{head.text} {cell.text}"
                    for head, cell in pairs
                    if cell.side != "long" and cell.text not in ("", ABSENT)
                )
                found[section.name, name.text] = verdict.text, "".join(f", {one}" for one in shown)
    return found


def _facts(before: Document, after: Document) -> Iterator[Change]:
    """Sentences of every study."""
    old, new = ({one.name: one for one in document.sections} for document in (before, after))
    for name in dict.fromkeys((*old, *new)):
        yield from _lines(name, *(found[name].facts if name in found else () for found in (old, new)))


def _lines(what: str, before: tuple[str, ...], after: tuple[str, ...]) -> Iterator[Change]:
    """Sentences that are not in both, those in the same place side by side."""
    from difflib import SequenceMatcher
    from itertools import zip_longest

    for kind, i0, i1, j0, j1 in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind != "equal":
            yield from (Change(what, one, other) for one, other in zip_longest(before[i0:i1], after[j0:j1]))


def _values(before: dict[str, str], after: dict[str, str]) -> Iterator[Change]:
    for name in dict.fromkeys((*before, *after)):
        if (one := before.get(name)) != (other := after.get(name)):
            yield Change(name, one, other)


def _inputs(toml: str) -> dict[str, str]:
    """Every value of a scene by its key, its gates left out: they are compared one by one."""
    import tomllib

    data = tomllib.loads(toml)
    return dict(_flat({key: value for key, value in data.items() if key != "gate"}, ""))


def _flat(data: Any, key: str) -> Iterator[tuple[str, str]]:
    """(key, value), of tables and lists of tables theirs."""
    if isinstance(data, dict):
        for name, value in data.items():
            yield from _flat(value, f"{key}.{name}" if key else name)
    elif isinstance(data, list) and any(isinstance(one, dict) for one in data):
        for i, one in enumerate(data):
            yield from _flat(one, f"{key}.{i}")
    else:
        yield key, str(data)


def _relative(old: Any, new: Any) -> str:
    """' (+0.5 %)', of real figures."""
    if not all(isinstance(one, int | float) and not isinstance(one, bool) for one in (old, new)) or not old:
        return ""
    return f" ({100.0 * (new - old) / abs(old):+.3g} %)"


def _apart(old: Any, new: Any) -> str:
    """Two figures in so many digits that they are not the same."""
    one, other = figure(old), figure(new)
    return _two(one, other) if one != other else _two(repr(old), repr(new))


def _share(gate: GateResult | None) -> str:
    return ABSENT if gate is None else share_of_band(gate.share)


def _two(before: str, after: str) -> str:
    return before if before == after else f"{before} to {after}"


def _counted(n: int, what: str) -> str:
    return f"{n} {what}{'s' * (n != 1)}"


def times_in_words(one: Difference) -> str:
    """When both were run, and how long they took."""
    (then, now), (before, after) = one.dates, one.seconds
    return f"{then}, {seconds_in_words(before)}; {now}, {seconds_in_words(after)}"


def as_plain(found: Differences) -> dict[str, Any]:
    """For `verify diff --json`."""
    return {
        "before": found.before,
        "after": found.after,
        "broken": found.broken,
        "unjudged": found.unjudged,
        "scenes": [msgspec.to_builtins(one) | {"broken": [gate.id for gate in one.broken]} for one in found.scenes],
        "only_before": list(found.only_before),
        "only_after": list(found.only_after),
    }


def rendered(found: Differences) -> str:
    """The page."""
    from verify.report.html import part, templates

    page = templates().get_template("diff.html.j2")
    return page.render(found=found, times=times_in_words, css=part("page.css"))
