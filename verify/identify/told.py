"""What a comparison found, told: the answer first, then modes, candidates, a chart, gates."""

from typing import Any

import msgspec

from verify.beam import Beam
from verify.identify.causes_told import left, loosely, nearest, plain_cause
from verify.identify.family import CHAIN, Candidate
from verify.identify.fitting import FLOOR, TOLERANCE, Fit, Identified
from verify.identify.pairing import Found as Remark
from verify.identify.sizing import Enough
from verify.run.gates import Band, GateResult
from verify.studies.chart import Axis, Chart
from verify.studies.charting import GREY, line, percent, plain_line
from verify.studies.told import Column, Found, Table
from verify.words import percent as in_percent

_YOURS, _BEST, _NEXT, _SCALED = "#d6427a", "#2f80ed", "#e8760c", "#7a4fb5"
_OFF_THE_CHART = 2.0
"""A factor beyond which a list as given is not drawn beside the candidates."""
_SHOWN = 8
"""Candidates in the terminal."""


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One mode."""

    mode: int
    entry: int
    """Of the list, from 1."""
    given_hz: float
    """The same as `frequency_hz`."""
    frequency_hz: float
    """As it was given, in hertz."""
    exact_hz: float
    error: float
    """Of what was given, relative to exact."""
    scaled_hz: float | None
    """Freed of a wrong unit or a common factor that was diagnosed; None without one."""
    scaled_error: float | None
    """Of `scaled_hz`, relative to exact."""
    best_hz: float
    """Of the best candidate."""
    difference: float
    """Of `scaled_hz`, else of what was given, relative to the best candidate."""
    beyond: float
    """Its size, less what the rounding of the list explains."""
    likeness: float | None
    """MAC of its shape with the exact one; None without shapes."""


class Compared(Found, frozen=True, eq=False, kw_only=True):
    """A model of somebody's, compared."""

    scene: str
    beam: Beam
    source: str
    unit: str
    theory: str
    found: Identified
    told: tuple[Remark, ...]
    """What is wrong with the list, or to be known of it."""
    rows: tuple[Row, ...]
    size: Enough | None
    gates: tuple[GateResult, ...]
    solved: int
    """Candidates and sizes that were solved."""
    seconds: float
    left_out: dict[str, str]
    """Candidates that do not exist here, and why."""

    @property
    def passed(self) -> bool:
        """Whether every gate passed."""
        return all(gate.passed for gate in self.gates)

    @property
    def answer(self) -> str:
        """What the model is, in a sentence or two."""
        wrong = [remark.words for remark in self.told if remark.wrong]
        notes = [remark.words for remark in self.told if not remark.wrong]
        sentences = [*wrong, self._identity(), self._surety(), *notes]
        return " ".join(f"{one[:1].upper()}{one[1:]}." for one in sentences if one)

    def _identity(self) -> str:
        best = self.found.best
        if self.found.rivals:
            return f"read by (a), the nearest is {nearest(best)}"
        if best.residual > TOLERANCE:
            known = "what is known of the family on this beam" if self.left_out else "the known family"
            return f"none of {known} fits: the nearest, {nearest(best)}, leaves {in_percent(best.residual, sign=False)}"
        if self.found.systematic:
            return (
                f"nothing of the known family is it quite: the nearest, {nearest(best)}, leaves "
                f"{in_percent(best.residual, sign=False)}, which goes smoothly with the mode"
            )
        if self._unseen():
            return (
                "these frequencies do not show how the beam was divided: too few, too noisy, or divided too finely; "
                f"the nearest is {nearest(best)}"
            )
        answer = best.candidate.answer
        return f"{f'Probably y{answer[1:]}' if self.found.doubtful or self._loose() else answer}{self._parts()}"

    def _loose(self) -> bool:
        """Whether it is read with a common factor that is told and not claimed."""
        return self.found.reading.factor is None and loosely(self.found.best)

    def _claimed(self) -> bool:
        """Whether it is said to be one candidate and no other."""
        return self.found.explained and not self._unseen() and not self.found.rivals

    def _unseen(self) -> bool:
        """Whether the exact beam fits about as well as the best model of parts."""
        return self.found.best.candidate.sized and any(not one.candidate.sized for one in self.found.alike)

    def _parts(self) -> str:
        """'; 69 links for 0.1 % at mode 5 (19 with ...)'."""
        size = self.size
        if size is None:
            return ""
        parts = "links" if self.found.best.candidate.model == CHAIN else "elements"
        wanted = f"for {100.0 * size.error:g} % at mode {size.mode}"
        theory = self.found.best.candidate.theory
        wanted += f" by the theory {theory}" * (theory != self.theory)
        said = f"{size.count} {parts} {wanted}" if size.count is not None else f"no number of {parts} found {wanted}"
        return f"; {said}" + (f" ({size.better_count} with {size.better})" if size.better else "")

    def _surety(self) -> str:
        """How surely: what is left over, what else it may be, how far off the next is."""
        best = self.found.best
        if not self.found.explained or self.found.rivals:
            return ""
        leaves = f"{f'With {best.count} parts' if best.count else 'So read,'} it leaves {left(best)}"
        return "; ".join(part for part in (leaves, self._alike(), self._following()) if part)

    def _alike(self) -> str:
        """What it may be as well: what has the same frequencies, and what this list does not tell from it."""
        same = f"no list can tell it from {_either(self.found.same)}, of the same frequencies"
        doubtful = f"this list does not tell it from {_either(self.found.doubtful)}"
        return "; ".join([same] * bool(self.found.same) + [doubtful] * bool(self.found.doubtful))

    def _following(self) -> str:
        """What it is not."""
        following = self.found.next
        if following is None:
            return ""
        times = f", {self.found.odds:.2g} times as much" if self.found.best.residual > FLOOR else ""
        return f"next, with {left(following)}{times}, comes {nearest(following)}"

    def in_short(self) -> str:
        """The answer."""
        return self.answer

    def facts(self) -> tuple[str, ...]:
        """The answer."""
        return (self.answer, self._largest())

    def _largest(self) -> str:
        """Of the list as it was given; beside it of the scaled one, named as such."""
        worst = max(self.rows, key=lambda row: abs(row.error))
        said = f"Against the exact beam ({self.theory}) the largest error is {_at(worst.error, worst)}"
        if not self.scaled:
            return f"{said}."
        least = max(self.rows, key=lambda row: abs(row.scaled_error or 0.0))
        scaled = _at(least.scaled_error or 0.0, least)
        return f"{said}, of your list as it is; of the list over {self.found.best.factor:.6g} it would be {scaled}."

    @property
    def scaled(self) -> bool:
        """Whether the list was read as one that has a wrong unit or a common factor."""
        return self.rows[0].scaled_hz is not None

    def tables(self) -> tuple[Table, ...]:
        """Modes, and candidates."""
        return (self._modes(), self._candidates())

    def _modes(self) -> Table:
        shaped = any(row.likeness is not None for row in self.rows)
        columns = (
            Column("mode"),
            Column("entry", wide=True),
            Column("yours, Hz", ".4f"),
            Column("exact, Hz", ".4f"),
            Column("error, %", "bare percent"),
            *[Column("scaled, Hz", ".4f"), Column("scaled error, %", "bare percent")] * self.scaled,
            Column("best, Hz", ".4f"),
            Column("off it, %", "bare percent"),
            *([Column("MAC", ".4f")] if shaped else []),
        )
        rows = []
        for row in self.rows:
            off: float | str = row.difference if abs(row.difference) > FLOOR else "rounding"
            scaled = (row.scaled_hz, row.scaled_error) if self.scaled else ()
            cells = (row.mode, row.entry, row.frequency_hz, row.exact_hz, row.error, *scaled, row.best_hz, off)
            rows.append((*cells, row.likeness) if shaped else cells)
        return Table(title="Modes", columns=columns, rows=tuple(rows), notes=self._scaling(), shown="both")

    def _scaling(self) -> tuple[str, ...]:
        """What `scaled` and `off it` are, where they are not of what was given."""
        if not self.scaled:
            return ()
        return (
            f"Scaled: yours over {self.found.best.factor:.6g}, as diagnosed. Off it: the scaled ones off the best.",
        )

    def _candidates(self) -> Table:
        columns = (
            Column("", left=True),
            Column("N"),
            Column("order"),
            Column("leaves", "size"),
            Column("largest", "size", wide=True),
        )
        shown = self.found.fits[:_SHOWN]
        rows = tuple(
            (
                one.candidate.words,
                one.count,
                one.candidate.order,
                one.residual if one.residual > FLOOR else "rounding",
                float(abs(one.differences).max()),
            )
            for one in shown
        )
        rest = len(self.found.fits) - len(shown)
        notes: tuple[str, ...] = (f"{rest} more candidates fit worse, --json has them all.",) if rest else ()
        if self.left_out:
            notes += (f"{len(self.left_out)} candidates are left out here, --json has the reason of each.",)
        return Table(title="Candidates, the nearest first", columns=columns, rows=rows, notes=notes, shown="both")

    def charts(self) -> tuple[Chart, ...]:
        """Errors over the mode: yours, of the best candidate, of the next."""
        modes = [row.mode for row in self.rows]
        best = [row.best_hz / row.exact_hz - 1.0 for row in self.rows]
        lines = [
            plain_line("exact", GREY, modes, [0.0] * len(modes)),
            *(line(name, colour, modes, percent(off), joined=False) for name, colour, off in self._points()),
            plain_line(self.found.best.candidate.words, _BEST, modes, percent(best)),
        ]
        following = self.found.next
        if following is not None:
            by_mode = {int(m) + 1: float(d) for m, d in zip(following.pairs.modes, following.differences, strict=True)}
            own = [row.error if row.scaled_error is None else row.scaled_error for row in self.rows]
            errors = [(1.0 + e) / (1.0 + by_mode[row.mode]) - 1.0 for e, row in zip(own, self.rows, strict=True)]
            lines.append(plain_line(following.candidate.words, _NEXT, modes, percent(errors), dash="dash"))
        return (
            Chart(
                id="compare",
                title="Your frequencies beside the nearest candidates",
                caption=f"Points: {self._pointed()}, against the exact beam ({self.theory}). Lines: the candidates.",
                x=Axis("mode number"),
                y=Axis("frequency error, %"),
                lines=tuple(lines),
            ),
        )

    def _points(self) -> list[tuple[str, str, list[float]]]:
        """(name, colour, errors) of yours, and of yours scaled; of these alone where the others lie far off."""
        given = ("yours", _YOURS, [row.error for row in self.rows])
        if not self.scaled:
            return [given]
        scaled = ("yours, scaled", _SCALED, [row.scaled_error or 0.0 for row in self.rows])
        return [scaled] if self._far_off() else [given, scaled]

    def _far_off(self) -> bool:
        return not 1.0 / _OFF_THE_CHART < self.found.best.factor < _OFF_THE_CHART

    def _pointed(self) -> str:
        over = f"over {self.found.best.factor:.6g}, as diagnosed"
        if not self.scaled:
            return "yours"
        return f"yours {over} (as given they lie off the chart)" if self._far_off() else f"yours, and yours {over}"

    def plain(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene,
            "source": self.source,
            "unit": self.unit,
            "answer": self.answer,
            "best": _candidate(self.found.best) | {"identified": self._claimed()},
            "certainty": {
                "told_apart": not self.found.alike,
                "alike": [_candidate(one) for one in self.found.alike],
                "next_over_best": self.found.odds,
                "systematic": self.found.systematic,
            },
            "told": msgspec.to_builtins(self.told),
            "factor": self.found.best.factor,
            "causes": [plain_cause(one, self.beam) for one in (self.found, *self.found.rivals)],
            "parts_needed": msgspec.to_builtins(self.size),
            "theory": self.theory,
            "modes": msgspec.to_builtins(self.rows),
            "candidates": [_candidate(one) for one in self.found.fits],
            "left_out": self.left_out,
            "gates": msgspec.to_builtins(self.gates),
            "solved": self.solved,
            "seconds": self.seconds,
            "passed": self.passed,
        }


def _at(error: float, row: Row) -> str:
    return f"{in_percent(error)}, at mode {row.mode}"


def _either(fits: tuple[Fit, ...]) -> str:
    """The first two, and how many more."""
    named = " or ".join(nearest(one) for one in fits[:2])
    return named + (f" or {len(fits) - 2} more" if len(fits) > 2 else "")


def _candidate(one: Fit) -> dict[str, Any]:
    """A candidate in JSON."""
    candidate: Candidate = one.candidate
    return {
        "model": candidate.model,
        "wall": candidate.wall,
        "joints": candidate.joints,
        "mass": candidate.mass,
        "attachment": candidate.attachment,
        "theory": candidate.theory,
        "order": candidate.order,
        "count": one.count,
        "residual": one.residual,
        "words": candidate.words,
    }


def judged(
    found: Identified, told: tuple[Remark, ...], rows: tuple[Row, ...], within: float | None
) -> tuple[GateResult, ...]:
    """The list as it stands, what it is, and where asked its errors against the exact beam."""
    wrong = [one for one in told if one.wrong]
    reason = "; ".join(one.words for one in wrong)
    gates = [
        _gate("list", float(len(wrong)), 0.0, reason, "A list that stands as it is has nothing to be mended.", "1")
    ]
    off = max(rows, key=lambda row: row.beyond)
    why = (
        "A model is a member of the family if every mode is its mode, and what is left over does not go with the mode."
    )
    over = f" over {found.best.factor:.6g}" if off.scaled_hz is not None else ""
    reason = f"mode {off.mode}{over} is {in_percent(off.difference)} off the nearest candidate"
    if found.systematic and off.beyond <= TOLERANCE:
        reason = (
            f"what is left over, up to {in_percent(off.difference)} at mode {off.mode}, goes smoothly with the mode"
        )
    passed = off.beyond <= TOLERANCE and not found.systematic
    gates.append(_gate("identified", off.beyond, TOLERANCE, "" if passed else reason, why, "1"))
    if within is not None:
        gates.append(_errors(rows, within))
    return tuple(gates)


def _errors(rows: tuple[Row, ...], within: float) -> GateResult:
    """What was given against the exact beam, whatever it was read as."""
    beyond = [row for row in rows if not abs(row.error) <= within]
    worst = max(rows, key=lambda row: abs(row.error))
    modes = ", ".join(str(row.mode) for row in beyond[:6]) + (" and more" if len(beyond) > 6 else "")
    reason = f"beyond it: mode{'s' * (len(beyond) > 1)} {modes}; the largest error is {in_percent(worst.error)}"
    why = "Every mode, as it was given, against the exact beam."
    return _gate("within", abs(worst.error), within, reason if beyond else "", why, "1")


def _gate(name: str, measured: float, at_most: float, reason: str, why: str, unit: str) -> GateResult:
    return GateResult(
        id=name,
        quantity=f"compare.{name}",
        arguments={},
        why=why,
        unit=unit,
        expected=f"at most {at_most:g}",
        band=Band(expect=None, within=None, at_least=None, at_most=at_most),
        measured=measured,
        passed=not reason,
        applicable=True,
        share=measured / at_most if at_most else None,
        reason=reason,
        seconds=0.0,
    )
