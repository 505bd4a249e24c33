"""Rows and sentences of a bench, and what the machine was: plain values that JSON holds."""

from typing import Annotated, Any, TypeAlias

import msgspec
from msgspec import Meta

from verify.bench.kind import Setting
from verify.options import BenchSet

Seconds: TypeAlias = Annotated[float, Meta(ge=0.0, le=1e12)]


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One method at one size. None where there is no such figure; `left_out` says why a row has none at all."""

    set: BenchSet
    about: str
    """Which case of the set: 'mode 22'."""
    method: str
    model: str
    settings: dict[str, Setting]
    count: int | None
    error: float | None = None
    """Relative."""
    reference: str = ""
    reference_uncertainty: float | None = None
    order: float | None = None
    """Observed from the coarser row before it."""
    warm_s: Seconds | None = None
    """Seconds of a run after its set-up, median of interleaved rounds."""
    spread_s: Seconds | None = None
    """Between the quartiles of the rounds, of all that each ran."""
    set_up_s: Seconds | None = None
    """Seconds before it, for models and modes that are made once; None where the run is all there is."""
    first_s: Seconds | None = None
    """Its first call in this process: what it is the first of all to import or to bring in compiled is in that."""
    compile_s: Seconds | None = None
    """Of compiling what no method before it in its set has compiled, with nothing kept on disk; None where nothing is
    compiled or nobody asked."""
    rounds: int = 0
    left_out: str = ""

    @property
    def line(self) -> tuple[str, str, str]:
        """Set, case and method."""
        return self.set, self.about, self.method

    @property
    def whole_s(self) -> float | None:
        """Set-up and run."""
        return None if self.warm_s is None else self.warm_s + (self.set_up_s or 0.0)


class Sentence(msgspec.Struct, frozen=True, kw_only=True):
    """One comparison: which method takes less time at the same error, or why nobody can say."""

    set: BenchSet
    about: str
    methods: tuple[str, str]
    text: str
    earned: bool
    """Whether errors of both fall at their order; of steps raced at wanted errors, whether both come to one."""
    ratio: float | None = None
    """Time of the second over that of the first, at the smallest error that both reach."""
    at_error: float | None = None
    """That error."""
    crossing: float | None = None
    """The error at which the cheaper of the two changes; None where it does not."""
    at: tuple[tuple[float, float], ...] = ()
    """(error, time of the second over that of the first) at errors that are asked for, where both come to them."""


class ChildCost(msgspec.Struct, frozen=True):
    """What a process of its own paid for once."""

    what: str
    seconds: float


def plain_row(row: Row) -> dict[str, Any]:
    """For JSON."""
    plain: dict[str, Any] = msgspec.to_builtins(row)
    return plain
