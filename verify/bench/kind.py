"""What is benched: a case, its methods at their sizes or steps, and what judges their answers. All plain values."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

import msgspec

from verify.options import BenchSet

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.models.kind import Model

Setting: TypeAlias = str | float | int
Run: TypeAlias = Callable[[], "Told"]
"""One warm run, set up beforehand."""


ASKED_OF_PARTS = (1e-2, 1e-3, 1e-4)
"""Errors at which a number of parts is chosen: sentences of modes and linear motions name ratios there."""


class Told(msgspec.Struct, frozen=True, eq=False):
    """What one run gave, with how long its parts took where it knows."""

    answer: Any
    set_up_s: float | None = None
    """Seconds of modes and tables that this run made anew."""
    warm_s: float | None = None
    """Seconds of the rest."""
    share: float = 1.0
    """Of the rest, that this run went: a long one is timed by its first part."""

    @property
    def set_up_share(self) -> float | None:
        """Of the run's time; None where nobody knows."""
        if self.set_up_s is None or self.warm_s is None or self.set_up_s + self.warm_s <= 0.0:
            return None
        return self.set_up_s / (self.set_up_s + self.warm_s)


class Reference(msgspec.Struct, frozen=True):
    """What errors are against, and how well that is known itself."""

    name: str
    uncertainty: float
    """Relative, as the error."""


class Judged(msgspec.Struct, frozen=True):
    """An answer against its reference."""

    error: float
    """Relative; signed where it is of one figure, rms where it is of many."""
    reference: Reference


class Line(msgspec.Struct, frozen=True, kw_only=True):
    """One method in one case: a line in its chart."""

    name: str
    model: str = ""
    """By its name among the models, for its colour; empty where it is none."""
    orders: tuple[float, float] | None = None
    """Between which the error falls with what is refined, as theory has it; None where nothing is refined."""
    refined: str = "N"
    """What is refined: N, step or tolerance."""
    remedy: str = ""
    """What to do where errors fall at no such order: finer sizes, or a look at the rows, unless given."""
    settings: dict[str, Setting] = {}


def orders_due(model: "Model", beam: "Beam", **settings: Setting) -> tuple[float, float] | None:
    """Between which a model's errors of frequencies and of motions at a place fall; None where nobody says."""
    order = model.order(beam, **settings)
    return (float(order), float(order)) if order else None


def orders_of_fields(model: "Model", beam: "Beam") -> tuple[float, float] | None:
    """Likewise of fields, rms over the beam: at first as frequencies, of many parts by what single parts leave."""
    order, last = model.order(beam), model.field_order(beam)
    return (float(min(order, last)), float(order)) if order and last else None


def orders_at_once(model: "Model", beam: "Beam") -> tuple[float, float] | None:
    """Likewise of motions under a step load.

    It moves mode n by n^-4, its phase goes astray as n^2 (n/N)^p, and is lost from n = N^(p/(p + 2)) on: an rms of
    N^(-7p / (2p + 4)). Losses, and forces that pass nought as they are switched on, bring that nearer to p.
    """
    order = model.order(beam)
    return (3.5 * order / (order + 2.0), float(order)) if order else None


class Entry(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """One method at one size, step or tolerance."""

    line: Line
    size: float
    """A power of which the error is: 1/N, seconds, a tolerance; 0 where nothing is refined."""
    count: int | None = None
    estimate_s: float
    """Of one run with its set-up, from above."""
    prepare: Callable[[], Run]
    """What is made once, before runs that can be repeated."""
    sets_up: bool = False
    """Whether that is work worth telling."""
    runs_first: bool = False
    """Whether making it takes a run as well, which is no part of its cost."""
    part: Callable[[], Run] | None = None
    """What rounds repeat in its place where a run is long: its first part."""
    part_s: float = 0.0
    """Of one such part with its set-up, from above."""
    afresh: bool = False
    """Whether every run finds nothing that one before it has kept: its time is that from the beam on."""
    settings: dict[str, Setting] = {}
    """Its step or tolerance."""

    def work_s(self, repeats: int) -> float:
        """Of a run and of repeated ones, from above."""
        return self.estimate_s + repeats * (self.part_s if self.part else self.estimate_s)

    @property
    def told(self) -> str:
        """'segments, N = 49', 'RK4, step 1.2e-05'."""
        size = "" if self.count is None else f", N = {self.count}"
        return self.line.name + size + "".join(f", {name} {value:.3g}" for name, value in self.settings.items())


class Case(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Methods that answer one question, and what judges them."""

    set: BenchSet
    about: str = ""
    """Which of several cases of the set: 'mode 22', 'N = 49'."""
    question: str
    """What the error is of: 'frequency', 'deflection'."""
    condition: str
    """Under which what is found holds: material, drive, duration."""
    entries: tuple[Entry, ...]
    pairs: tuple[tuple[str, str], ...]
    """Lines that a sentence compares, by name."""
    races: tuple[tuple[str, str], ...] = ()
    """Lines that a sentence compares at the errors `wanted` alone, each at its own longest step.

    Of the second, one that nothing else is compared with, sizes finer than the least of these takes are not run.
    """
    judge: Callable[[], Callable[[Entry, Any], Judged]]
    """The reference, solved now; then (entry, answer) -> how far off. Both raise InputError."""
    estimate_s: float = 0.0
    """Of the reference, from above."""
    floor: float = 0.0
    """Below which an error is rounding, beside what the reference leaves open."""
    wanted: tuple[float, ...] = ()
    """Errors at which sentences name the ratio."""
    notes: tuple[str, ...] = ()
    """Methods that take no part, each with the reason."""

    @property
    def name(self) -> str:
        """'modes, mode 22'."""
        return f"{self.set}, {self.about}" if self.about else self.set
