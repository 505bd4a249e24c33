"""What a comparison found, told: the answer first, then modes, candidates, a chart, gates."""

from typing import Any

import msgspec

from verify.beam import Beam
from verify.identify.causes_told import left, loosely, nearest, plain_cause
from verify.identify.family import CHAIN, Candidate
from verify.identify.fitting import FLOOR, TOLERANCE, Fit, Identified
from verify.identify.pairing import Found as Remark
from verify.identify.rows import Row
from verify.identify.sizing import Enough
from verify.run.gates import GateResult
from verify.studies.chart import Axis, Chart, Numbers
from verify.studies.charting import GREY, line, percent, plain_line
from verify.studies.told import Column, Found, Table
from verify.words import percent as in_percent

_YOURS, _BEST, _NEXT, _SCALED = "#d6427a", "#2f80ed", "#e8760c", "#7a4fb5"
_OFF_THE_CHART = 2.0
"""A factor beyond which a list as given is not drawn beside the candidates."""
_SHOWN = 8
"""Candidates in the terminal."""


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
            return ""  # each of them is told with what is nearest by it
        if self.found.short:
            few = {1: "one frequency does", 2: "two frequencies do", 3: "three frequencies do"}[len(best.pairs.entries)]
            return f"{few} not say which model it is: the nearest, {nearest(best)}, leaves {left(best)}"
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
        return f"{f'Probably y{answer[1:]}' if self._doubted() else answer}{self._parts()}"

    def _doubted(self) -> bool:
        """Whether the answer is a probable one."""
        return bool(self.found.doubtful) or self._loose() or not self._within()

    def _loose(self) -> bool:
        """Whether it is read with a common factor that is told and not claimed."""
        return self.found.reading.factor is None and loosely(self.found.best)

    def _within(self) -> bool:
        """Whether every entry is within the tolerance of the best, as the gate has it."""
        return all(gate.passed for gate in self.gates if gate.id == "identified")

    def _claimed(self) -> bool:
        """Whether one candidate is named as the answer, surely or probably."""
        return self.found.explained and self._within() and not (self._unseen() or self.found.rivals)

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
        times = f", {_times(self.found.odds)} as much" if self.found.best.residual > FLOOR else ""
        return f"next, with {left(following)}{times}, comes {nearest(following)}"

    def in_short(self) -> str:
        """The answer."""
        return self.answer

    def facts(self) -> tuple[str, ...]:
        """The answer."""
        return (self.answer, self._largest())

    def _largest(self) -> str:
        """Of the list as it was given; beside it as it is read, named as such."""
        worst = max(self.rows, key=lambda row: abs(row.error))
        said = f"Against the exact beam ({self.theory}) the largest error is {_at(worst.error, worst)}"
        if not (self.scaled or self.shifted):
            return f"{said}."
        error, mode = max(self._read(), key=lambda read: abs(read[0]))
        read = " and ".join(
            [f"of the list over {self.found.best.factor:.6g}"] * self.scaled
            + ["with each entry as it is read"] * self.shifted
        )
        return f"{said}, of your list as it is; {read} it would be {in_percent(error)}, at mode {mode}."

    @property
    def scaled(self) -> bool:
        """Whether the list was read as one that has a wrong unit or a common factor."""
        return self.rows[0].scaled_hz is not None

    @property
    def shifted(self) -> bool:
        """Whether an entry was read as another mode than its number says, or as none."""
        return any(row.read_as != row.mode for row in self.rows)

    def _read(self) -> list[tuple[float, int]]:
        """(error, mode) of every entry as it is read."""
        return [(row.read_error, row.read_as) for row in self.rows if row.read_error is not None and row.read_as]

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
            *[Column("scaled, Hz", ".4f")] * self.scaled,
            *[Column("read as")] * self.shifted,
            *[Column(f"{self._freed()} error, %", "bare percent")] * bool(self._freed()),
            Column("best, Hz", ".4f"),
            Column("off it, %", "bare percent"),
            *([Column("MAC", ".4f")] if shaped else []),
        )
        rows = []
        for row in self.rows:
            off = "rounding" if row.difference is not None and abs(row.difference) <= FLOOR else row.difference
            read = (row.scaled_hz,) * self.scaled + (row.read_as,) * self.shifted
            read += (row.read_error,) * bool(self._freed())
            cells = (row.mode, row.entry, row.frequency_hz, row.exact_hz, row.error, *read, row.best_hz, off)
            rows.append((*cells, row.likeness) if shaped else cells)
        return Table(title="Modes", columns=columns, rows=tuple(rows), notes=self._notes(), shown="both")

    def _freed(self) -> str:
        """What errors that a diagnosis leaves are called; empty without one."""
        return "scaled" if self.scaled else "read" if self.shifted else ""

    def _notes(self) -> tuple[str, ...]:
        """What is beside the list as it was given."""
        scaled = f"Scaled: yours over {self.found.best.factor:.6g}, as diagnosed. Off it: the scaled ones off the best."
        read = "Read as: the mode that an entry is by what was diagnosed; errors before that column are by its number."
        return (*[scaled] * self.scaled, *[read] * self.shifted)

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
        modes = sorted({row.mode for row in self.rows} | {mode for _, mode in self._read()})
        lines = [
            plain_line("exact", GREY, modes, [0.0] * len(modes)),
            *(line(name, colour, at, percent(off), joined=False) for name, colour, at, off in self._points()),
            plain_line(self.found.best.candidate.words, _BEST, *self._errors_of(self.found.best)),
        ]
        following = self.found.next
        if following is not None:
            lines.append(plain_line(following.candidate.words, _NEXT, *self._errors_of(following), dash="dash"))
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

    def _errors_of(self, one: Fit) -> tuple[list[int], Numbers]:
        """(modes that are paired, the errors of a candidate in them, %): those of the list less what is off it."""
        off = {int(m) + 1: float(d) for m, d in zip(one.pairs.modes, one.differences, strict=True)}
        own = [(error, mode) for error, mode in self._read() if mode in off]
        return [mode for _, mode in own], percent([(1.0 + error) / (1.0 + off[mode]) - 1.0 for error, mode in own])

    def _points(self) -> list[tuple[str, str, list[int], list[float]]]:
        """(name, colour, modes, errors) of yours, and of yours as read; of these alone where the others lie far off."""
        given = ("yours", _YOURS, [row.mode for row in self.rows], [row.error for row in self.rows])
        freed = self._freed()
        if not freed:
            return [given]
        read = (f"yours, {freed}", _SCALED, [mode for _, mode in self._read()], [error for error, _ in self._read()])
        return [read] if self._far_off() else [given, read]

    def _far_off(self) -> bool:
        return self.shifted or not 1.0 / _OFF_THE_CHART < self.found.best.factor < _OFF_THE_CHART

    def _pointed(self) -> str:
        over = f"over {self.found.best.factor:.6g}, as diagnosed" if self.scaled else "as read"
        if not self._freed():
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
                "sure": self._claimed() and not self._doubted(),
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


def _times(ratio: float) -> str:
    """'2.2 times', '113 times'."""
    return f"{ratio:.0f} times" if ratio >= 100.0 else f"{ratio:.2g} times"


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
