"""Verdicts: how far a result can be trusted, from the margins of the assumptions behind it."""

from collections.abc import Iterable
from math import isfinite
from typing import Any, Literal, TypeAlias

import msgspec

Level: TypeAlias = Literal["trusted", "conditional", "not trusted"]
COLOURS: dict[Level, str] = {"trusted": "green", "conditional": "yellow", "not trusted": "red"}
"""Terminal colours; green is for results without a condition."""
LEVELS: tuple[Level, ...] = tuple(COLOURS)
FINE, LIMIT = 0.01, 0.10
"""Relative errors up to which a result is trusted, and trusted under a condition."""
Harm: TypeAlias = Literal["premise", "void", "model form", "discretisation", "rounding"]
HARMS: tuple[Harm, ...] = ("premise", "void", "model form", "discretisation", "rounding")
"""What a margin leaves out, in the order of harm: what all results rest on (units, linear theory), a result that does
not exist, the physics of the model, its sizes and steps, its arithmetic. The first not trusted explains the others."""
LESS, OPEN = "press it less, or stiffen the beam", "model its contact by [slider.contact]"
MORE = f"press it more, or {OPEN}"  # contradicts LESS: OPEN remains


class Margin(msgspec.Struct, frozen=True, kw_only=True):
    """One assumption behind a result, with the size of what it leaves out."""

    name: str
    """'discretisation of 49 segments'."""
    size: float
    """Relative error that it leaves in the result, or its fraction of a limit; infinite where there is no result."""
    where: str = ""
    """The mode or frequency that answers: 'at mode 22'."""
    fine: float = FINE
    """Size above which the result is trusted only under the condition."""
    limit: float = LIMIT
    """Size above which the result is not trusted."""
    condition: str = ""
    """After 'only if': 'bending across the width may be left out: 2.5 % at mode 22'."""
    failure: str = ""
    """After 'not to be trusted': 'the preload bends the beam by 84 mm'."""
    remedy: str = ""
    """What to change: 'give 60 segments or more'."""
    is_error: bool = True
    """Whether the size is an error of the result, which 'trusted to' names; otherwise a fraction of a limit."""
    harm: Harm = "model form"
    """Its kind, whose order precedes the sizes of margins that are not trusted."""

    @property
    def level(self) -> Level:
        """Its own level; a size that is not a number is not trusted."""
        return "trusted" if self.size <= self.fine else "conditional" if self.size <= self.limit else "not trusted"

    @property
    def text(self) -> str:
        """The size in words: 'discretisation of 49 segments 0.43 % at mode 22', 'lift-off 152 times its limit'."""
        if not isfinite(self.size):
            return self.failure or f"{self.name} without a value {self.where}".rstrip()
        bound, words = (self.fine, "what is trusted") if self.level == "conditional" else (self.limit, "its limit")
        size = per_cent(self.size) if self.is_error else f"{three_digits(self.size / bound)} times {words}"
        return " ".join(filter(None, (self.name, size if self.size else "", self.where)))


class Verdict(msgspec.Struct, frozen=True, kw_only=True):
    """How far a result can be trusted."""

    level: Level
    headline: str
    """One sentence with the worst margin in words and per cent, and a remedy where it is not trusted."""
    margins: tuple[Margin, ...] = ()
    """Worst first."""

    def __repr__(self) -> str:
        """The level and the sentence."""
        return f"<Verdict {self.level}: {self.headline}>"

    @property
    def holds(self) -> bool:
        """Whether findings in words may stand: of what is not trusted, sizes alone fail."""
        return not any(one.level == "not trusted" and one.harm in HARMS[:3] for one in self.margins)

    @property
    def others(self) -> str:
        """Further margins beyond `fine`, of each name the worst: 'also: one-way coupling 2 %, shear 1.1 %'."""
        off = [one for one in reversed(self.margins) if one.level != "trusted"]
        worst = {m.name: m.text if m.is_error or m.level == "conditional" else m.failure or m.text for m in off}
        told = {name: text for name, text in reversed(worst.items()) if name != self.margins[0].name}
        texts = [text for text in told.values() if text not in self.headline]
        return f"also: {', '.join(texts)}" if texts else ""

    def to_dict(self) -> dict[str, Any]:
        """For JSON: level, headline, margins with their sizes and limits."""
        margins = [msgspec.structs.asdict(one) | {"level": one.level} for one in self.margins]
        return {"level": self.level, "headline": self.headline, "margins": margins}


def verdict_of(margins: Iterable[Margin]) -> Verdict:
    """The verdict by the worst margin: by level, then harm, then size over limit; of like ones the worst."""
    worst_of = {(one.name, one.where): one for one in sorted(margins, key=badness)}
    sized = (one for one in worst_of.values() if one.size or one.level != "trusted")
    ordered = sorted(sized, key=badness, reverse=True)
    if any(one.remedy == LESS and one.level == "not trusted" for one in ordered):
        ordered = [msgspec.structs.replace(one, remedy=OPEN) if one.remedy == MORE else one for one in ordered]
    if not ordered:
        return Verdict(level="trusted", headline="Trusted: no assumption leaves an error.")
    worst, largest = ordered[0], max(ordered, key=lambda one: one.is_error * one.size)
    if worst.level == "not trusted":
        headline = f"Not to be trusted: {worst.failure or f'{worst.text}, more than {per_cent(worst.limit)}'}."
        if worst.remedy:
            headline += f" {worst.remedy[0].upper()}{worst.remedy[1:]}."
    elif worst.level == "conditional":
        others = len({one.name for one in ordered if one.level == "conditional"}) - 1
        more = f" ({others} more condition{'s' * (others > 1)})" if others else ""
        size = f": {per_cent(worst.size)} {worst.where}".rstrip() if worst.is_error and isfinite(worst.limit) else ""
        headline = f"Trusted only if {worst.condition or f'{worst.name} may be left out'}{size}{more}."
    elif largest.is_error:
        headline = f"Trusted to {per_cent(largest.size)} ({f'{largest.name} {largest.where}'.rstrip()})."
    else:
        headline = "Trusted: no margin is beyond its limit."
    return Verdict(level=worst.level, headline=headline, margins=tuple(ordered))


def void(name: str, failure: str, remedy: str = "", *, leads: bool = False) -> Margin:
    """The margin of a result that does not exist: not converged, diverged, left the beam."""
    harm: Harm = "premise" if leads else "void"
    return Margin(name=name, size=float("inf"), failure=failure, remedy=remedy, harm=harm)


def missing(what: str, count: int, total: int, why: str = "") -> list[Margin]:
    """The margin of `count` values without a result of `total`, `what` in the plural: void where all are missing."""
    if not count:
        return []
    where, size = f"({why})" if why else "", count / total
    text = f"{count} of {total} {what} have no value {where}".rstrip()
    if count == total:
        return [void(what, text)]
    name, condition = f"{what} without a value", f"the others suffice: {text}"
    return [Margin(name=name, size=size, where=where, fine=0.0, limit=float("inf"), condition=condition)]


def three_digits(value: float) -> str:
    """'0.0123', '30400': without an exponent below a million."""
    return f"{float(f'{value:.3g}'):g}"


def per_cent(ratio: float) -> str:
    """'0.43 %', '110 %': two digits, no exponent where a person reads one badly."""
    if not isfinite(ratio):
        return "more than all of it"
    value = 100.0 * abs(ratio)
    return f"{float(f'{value:.2g}'):.0f} %" if 100.0 <= value < 1e5 else f"{value:.2g} %"


def badness(margin: Margin) -> tuple[int, int, float]:
    """Key of an order with the worst margin last."""
    share = margin.size / margin.limit if margin.size == margin.size else float("inf")
    first = -HARMS.index(margin.harm) if margin.level == "not trusted" else 0
    return LEVELS.index(margin.level), first, share
