"""What a bench is asked for, and what that comes to in a scene."""

from typing import Annotated, TypeAlias

import msgspec
from msgspec import Meta

from verify.checks import check_number
from verify.errors import InputError
from verify.options import BenchSet

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=2)], ...], Meta(min_length=1)]
Modes: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]


class Bench(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for run time against error: of modes, harmonic fields, motions in time, sliders and nonlinear chains."""

    sets: Annotated[tuple[BenchSet, ...], Meta(min_length=1)] | None = None
    """What methods are compared in; all that the scene asks for unless given."""
    counts: Counts | None = None
    """Segments and elements; those of the scene's [convergence] or [motion] unless given."""
    modes: Modes | None = None
    """Which modes; those of the scene's [convergence] unless given."""
    duration: float | None = None
    """Seconds of beams and chains in time; the scene's [motion], else four periods of the drive, unless given. The
    slider's own run lasts as its [motion] says."""
    x: float | None = None
    """Metres from the left end where motions are read; mid-span unless given."""
    seconds: float = 20.0
    """Of work, estimated: the largest that does not fit is left out, and named."""
    rounds: Annotated[int, Meta(ge=3, le=99)] = 9
    """In which all methods take turns, at most."""
    peers: bool = True
    """Whether other engines take part, where they are installed."""
    push: bool = False
    """Whether other engines are pushed until they break, at each number of links: up to a minute each."""
    imports: bool = True
    """Whether imports are timed, in processes of their own."""
    cold: bool = False
    """Whether compiling is timed, in processes of their own with nothing kept on disk."""

    def __post_init__(self) -> None:
        check_number("bench.seconds", self.seconds, "seconds", above=0)
        if self.duration is not None:
            check_number("bench.duration", self.duration, "seconds", above=0)
        if self.x is not None:
            check_number("bench.x", self.x, "metres", above=0)
        for name in ("sets", "counts", "modes"):
            given = getattr(self, name) or ()
            if len(set(given)) != len(given):
                raise InputError(f"bench.{name} = {list(given)!r} names one twice: give each once")


class Settled(msgspec.Struct, frozen=True, kw_only=True):
    """What is asked with the scene's own in place of what is not given."""

    sets: tuple[BenchSet, ...]
    counts: tuple[int, ...]
    chains: tuple[int, ...]
    """Links of the nonlinear chains."""
    modes: tuple[int, ...]
    duration: float
    x: float
    peers: bool
