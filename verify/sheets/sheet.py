"""Sheets of cases: what to build, what to record, exact values with their sources, and values that mistakes give."""

from math import log
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import msgspec
from msgspec import Meta

from verify.errors import InputError, near_name, shown
from verify.scene.file import read_toml
from verify.settings import Wall
from verify.validation import convert

DATA = Path(__file__).with_name("data")
Reading: TypeAlias = Literal[
    "frequency", "damping", "first", "last", "mean", "least", "greatest", "rate", "amplitude", "period", "drift"
]
"""How a figure is read from a column (`reading.READ`)."""
Positive = Annotated[float, Meta(gt=0)]
Vector = tuple[float, float, float]


class Cause(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A value that a known mistake gives instead of the exact one."""

    value: float
    within: Positive
    """Relative."""
    because: str
    """Cause and remedy in a sentence."""


class Figure(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A number that the judge reads from a record, and its exact value, SI."""

    name: str
    meaning: str
    read: Reading
    column: str
    exact: float
    within: Positive
    """Largest error that passes: relative; of an exact value of 0 absolute."""
    source: str
    unit: str = ""
    mode: Annotated[int, Meta(ge=1)] = 1
    from_s: float | None = None
    until_s: float | None = None
    uncertainty: Annotated[float, Meta(ge=0)] = 0.0
    """Absolute, of `exact`."""
    order: Annotated[int, Meta(ge=0)] = 0
    """Least order in the number of links, or in 1/step, that a right model has; 0: none is expected."""
    frictionless: float | None = None
    """The value without friction, of a figure that is a function of the friction coefficient alone."""
    friction: Literal["linear", "inverse", "exponential"] = "linear"
    """What the figure is in the coefficient."""
    powers: dict[str, float] = {}
    """Relative change of the figure, absolute of an exact value of 0, over that of a parameter of the sheet."""
    cause: tuple[Cause, ...] = ()

    def error(self, value: float) -> float:
        """Signed error: relative, absolute where the exact value is 0."""
        return (value - self.exact) / (abs(self.exact) or 1.0)

    def share(self, value: float) -> float:
        """The error over the largest that passes, less what is uncertain in the exact value."""
        return max(abs(self.error(value)) - self.uncertainty / (abs(self.exact) or 1.0), 0.0) / self.within

    def fails(self, value: float) -> bool:
        """Whether the error is larger than what passes."""
        return not self.share(value) <= 1.0

    def logarithm(self, value: float) -> float:
        """Of the value over the exact one, a sum of powers of parameters; the error where the exact value is 0."""
        ratio = value / self.exact if self.exact else 0.0
        return log(ratio) if ratio > 0.0 else self.error(value)


class Start(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The value of a column at time 0, by which a wrong sign, unit, order or initial condition shows."""

    column: str
    value: float
    unit: str
    within: Positive = 0.01
    """As of a figure: relative, absolute of a value of 0."""
    powers: dict[str, float] = {}
    """As of a figure."""


class Chain(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The chain of rigid links that stands in the file of an engine, its loads and its start; x along it, z across."""

    beam: str
    """A beam in one line, as of `--beam`."""
    count: Annotated[int, Meta(ge=2)] = 20
    wall: Wall = "gregory"
    space: bool = False
    damping: Annotated[float, Meta(ge=0)] = 0.0
    """Ratio of mode 1, by dashpots in proportion to the springs."""
    step_s: Positive
    every_s: Positive
    duration_s: Positive
    ramp_s: Annotated[float, Meta(ge=0)] = 0.0
    """Time in which the loads grow."""
    gravity: Vector = (0.0, 0.0, 0.0)
    tip_force: Vector = (0.0, 0.0, 0.0)
    tip_moment: Vector = (0.0, 0.0, 0.0)
    start_force: float = 0.0
    """Force across the tip, N, whose linear static angles the joints start from."""
    start_angle: float = 0.0
    """Of the first joint, rad."""
    start_moment: float = 0.0
    """Moment about the axis at the tip, N m, likewise."""


class Sheet(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A case: all that an engine needs to run it, all that a judge needs to read the run."""

    title: str
    license: Literal["CC0-1.0"]
    build: str
    record: str
    columns: Annotated[tuple[str, ...], Meta(min_length=2)]
    """Header of the table: `time`, s, first; SI."""
    parameters: dict[str, float]
    """Every number of `build`, with its unit at the end of its name."""
    figure: Annotated[tuple[Figure, ...], Meta(min_length=1)]
    start: tuple[Start, ...] = ()
    blind: str = ""
    """Mistakes that pass, as no figure depends on them: 'the record cannot tell ...'."""
    chain: Chain | None = None

    @property
    def figures(self) -> tuple[Figure, ...]:
        """All figures that are judged: those of the sheet, and the values that the motion starts at."""
        return *self.figure, *(
            Figure(
                name=f"start-{one.column}",
                meaning=f"start of {one.column}",
                read="first",
                column=one.column,
                exact=one.value,
                within=one.within,
                source="what the sheet says to build",
                unit=one.unit,
                powers=one.powers,
            )
            for one in self.start
        )

    def resolution(self, parameter: str) -> float | None:
        """The least relative error of a parameter that fails a run without other errors, None where none fails."""
        known = [one.within / abs(one.powers[parameter]) for one in self.figures if one.powers.get(parameter)]
        return min(known, default=None)

    @property
    def duration_s(self) -> float:
        """Time of the last row, 0 where the sheet asks for none."""
        return self.chain.duration_s if self.chain else self.parameters.get("duration_s", 0.0)

    @property
    def every_s(self) -> float:
        """Time between rows, 0 where the sheet asks for none."""
        rate = self.parameters.get("rate_hz", 0.0)
        return self.chain.every_s if self.chain else 1.0 / rate if rate else 0.0


def names() -> tuple[str, ...]:
    """Names of all sheets."""
    return tuple(sorted(path.parent.name for path in DATA.glob("*/sheet.toml")))


def load(name: str) -> Sheet:
    """The sheet of a name, or of the path of a sheet. Raises InputError."""
    if name in names():
        return convert(read_toml(DATA / name / "sheet.toml"), Sheet, name)
    if Path(name).suffix == ".toml":
        return convert(read_toml(Path(name)), Sheet, name)
    raise InputError(f"case = {shown(name)} is not known: {near_name(name, names())}")
