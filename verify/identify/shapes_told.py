"""What was found of somebody's mode shapes, told: the answer first, then each shape, then the models beside."""

from typing import Any

import msgspec

from verify.identify.told import Compared
from verify.judge.compare import HARDLY
from verify.run.gates import Band, GateResult
from verify.studies.told import Column, Found, Table
from verify.words import percent

ALIKE = 1.1
"""Errors of two models nearer than this cannot be told apart."""
ROUNDING = 1e-10
"""Below it a shape is another's but for rounding."""


class ShapeRow(msgspec.Struct, frozen=True, kw_only=True):
    """One shape."""

    name: str
    mode: int
    """Of the exact beam, from 1."""
    likeness: float
    """MAC with it."""
    error: float
    """Free of scale, relative, root mean square along the beam."""
    frequency_hz: float | None
    exact_hz: float | None
    frequency_error: float | None
    """Relative to exact."""


class Nearness(msgspec.Struct, frozen=True, kw_only=True):
    """How far the shapes lie from those of one model of ours."""

    words: str
    count: int | None
    error: float
    """Relative, root mean square over beam and modes."""


class Unlike(msgspec.Struct, frozen=True, kw_only=True):
    """A shape that has no mode of its own."""

    name: str
    best_mac: float
    """With any exact mode."""
    again: int | None
    """The mode that it is like, from 1, and another shape more so, or before it."""

    @property
    def words(self) -> str:
        """What is wrong with it."""
        if self.again is not None:
            return f"{self.name} is like mode {self.again}, which another shape is already (MAC {self.best_mac:.2f})"
        return f"{self.name} is like no mode (best MAC {self.best_mac:.2f})"


class Resembling(msgspec.Struct, frozen=True, kw_only=True):
    """A mode that so few places do not tell from others."""

    mode: int
    """From 1."""
    others: tuple[int, ...]
    """Likewise."""


class ShapesJudged(Found, frozen=True, eq=False, kw_only=True):
    """Mode shapes of somebody's, judged."""

    scene: str
    source: str
    notes: tuple[str, ...]
    """What was done with the mesh."""
    rows: tuple[ShapeRow, ...]
    unlike: tuple[Unlike, ...]
    """Shapes that are no mode's, or one's that another shape is."""
    exchanged: bool
    """Whether shapes stand in another order than the modes."""
    resembling: tuple[Resembling, ...]
    """What the places leave open."""
    n_points: int
    """Places along the beam."""
    count: int
    """Parts of the models that they are held against."""
    normalised: bool
    """Whether sizes of shapes were compared as well as forms."""
    nearest: tuple[Nearness, ...]
    """The nearest first."""
    compared: Compared | None
    """What the frequencies are; None without any."""

    @property
    def gates(self) -> tuple[GateResult, ...]:
        """Whether every shape is a mode's, in their order; then those of the frequencies."""
        wrong = [one.words for one in self.unlike]
        wrong += [f"{row.name} is hardly mode {row.mode} (MAC {row.likeness:.2f})" for row in self._hardly]
        wrong += [f"shapes stand in another order: they are modes {self._order()}"] * self.exchanged
        return (_gate(len(wrong), "; ".join(wrong)), *(self.compared.gates if self.compared else ()))

    @property
    def _hardly(self) -> list[ShapeRow]:
        """Those whose nearest mode they are not much like."""
        return [row for row in self.rows if row.likeness < HARDLY]

    @property
    def passed(self) -> bool:
        """Whether every gate passed."""
        return all(gate.passed for gate in self.gates)

    def _order(self) -> str:
        return ", ".join(f"{row.mode} ({row.name})" for row in self.rows)

    @property
    def answer(self) -> str:
        """What they are, in a sentence or two."""
        worst = max(self.rows, key=lambda row: row.error)
        modes = [row.mode for row in self.rows]
        which = f"{modes[0]} to {modes[-1]}" if modes == list(range(modes[0], modes[-1] + 1)) and len(modes) > 1 else ""
        said = (
            f"{len(modes)} shape{'s are' if len(modes) > 1 else ' is'} of mode{'s' * (len(modes) > 1)} "
            f"{which or ', '.join(map(str, modes))}, "
        )
        off = f"the worst {percent(worst.error, sign=False)} off at mode {worst.mode} (MAC {worst.likeness:.6f})"
        said += off if worst.error > ROUNDING else f"{'each ' * (len(modes) > 1)}in form the exact one but for rounding"
        frequencies = f" By its frequencies: {self.compared.answer}" if self.compared else ""
        held = " That is hardly a mode of the beam as the scene holds it: check beam.supports." if self._hardly else ""
        return f"{said}.{held} {self._open()}{self._nearest()}.{frequencies}"

    def _open(self) -> str:
        """What so few places do not tell apart."""
        pairs = [f"mode {one.mode} from {' and '.join(map(str, one.others))}" for one in self.resembling]
        return f"{self.n_points} places do not tell {', nor '.join(pairs)}: give more. " if pairs else ""

    def _nearest(self) -> str:
        if not self.nearest:
            return "No model of ours has so many modes with so few parts"
        best, rest = self.nearest[0], self.nearest[1:]
        alike = [one for one in rest if one.error <= max(ALIKE * best.error, ROUNDING)]
        of = "form and size" if self.normalised else "form"
        named = " or ".join(_named(one) for one in (best, *alike))
        left = "rounding" if best.error <= ROUNDING else percent(best.error, sign=False)
        said = f"In {of} nearest: {named}, which leaves {left}"
        following = next((one for one in rest if one not in alike), None)
        return said + (f"; next {_named(following)}, {percent(following.error, sign=False)}" if following else "")

    def facts(self) -> tuple[str, ...]:
        """The answer, and what was done with the mesh."""
        return (self.answer, *(f"{note[:1].upper()}{note[1:]}." for note in self.notes))

    def tables(self) -> tuple[Table, ...]:
        """Shapes, and models."""
        columns = (
            Column("shape", left=True),
            Column("mode"),
            Column("MAC", ".6f"),
            Column("form off, %", "bare size"),
            *(
                [Column("yours, Hz", ".4f"), Column("exact, Hz", ".4f"), Column("error, %", "bare percent")]
                * self._heard
            ),
        )
        rows = tuple(
            (
                row.name,
                row.mode,
                row.likeness,
                row.error if row.error > ROUNDING else "rounding",
                *([row.frequency_hz, row.exact_hz, row.frequency_error] * self._heard),
            )
            for row in self.rows
        )
        models = tuple((_named(one), one.error if one.error > ROUNDING else "rounding") for one in self.nearest)
        told = "form and size" if self.normalised else "form alone"
        return (
            Table(title="Shapes", columns=columns, rows=rows, shown="both"),
            Table(
                title=f"Models beside, by {told}",
                columns=(Column("", left=True), Column("off", "size")),
                rows=models,
                shown="both",
            ),
        )

    @property
    def _heard(self) -> bool:
        return self.compared is not None

    def plain(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene,
            "source": self.source,
            "answer": self.answer,
            "notes": list(self.notes),
            "shapes": msgspec.to_builtins(self.rows),
            "unlike": msgspec.to_builtins(self.unlike),
            "resembling": msgspec.to_builtins(self.resembling),
            "exchanged": self.exchanged,
            "places": self.n_points,
            "sizes_compared": self.normalised,
            "nearest": msgspec.to_builtins(self.nearest),
            "frequencies": self.compared.plain() if self.compared else None,
            "gates": msgspec.to_builtins(self.gates),
            "passed": self.passed,
        }


def _named(one: Nearness) -> str:
    return f"{one.count} {one.words}" if one.count is not None else one.words


def _gate(wrong: int, reason: str) -> GateResult:
    return GateResult(
        id="shapes",
        quantity="compare.shapes",
        arguments={},
        why="Every shape is one mode's, and they stand in the order of the modes.",
        unit="1",
        expected="at most 0",
        band=Band(expect=None, within=None, at_least=None, at_most=0.0),
        measured=float(wrong),
        passed=not wrong,
        applicable=True,
        share=None,
        reason=reason,
        seconds=0.0,
    )
