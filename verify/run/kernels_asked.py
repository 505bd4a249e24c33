"""Which kernels a scene asks for, for whoever compiles them ahead of it.

Gates, claims and studies say it themselves. Where only a size will tell whether a beam feels its slider both loops are
named; one too many is ended with the run, and one that is left out is compiled when it is asked for.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.models.compiling import Call
from verify.run.asks import Ask, asks_of

if TYPE_CHECKING:
    from verify.models.ahead import Ahead
    from verify.scenes.scene import Scene


def kernels_asked(scene: "Scene") -> Iterator[Call]:
    """Of all that a scene asks for."""
    return kernels_of(asks_of(scene))


def kernels_of(asks: Sequence[Ask]) -> Iterator[Call]:
    """In order of need; one that several ask for comes again."""
    for number in in_order_of_kernels(asks):
        yield from _kernels(asks[number])


def in_order_of_kernels(asks: Sequence[Ask]) -> list[int]:
    """Numbers of the asks: gates first, of those that need fewest kernels; helpers compile from the other end."""
    return sorted(range(len(asks)), key=lambda number: (asks[number].kind != "gate", _n_kernels(asks[number])))


def ready_first(asks: Sequence[Ask], ahead: "Ahead") -> Iterator[int]:
    """Their numbers in the same order, but that none waits for what others compile while there is something to do.

    Studies keep their order: one may take what those before it found.
    """
    left = in_order_of_kernels(asks)
    while left:
        gates, studies = ([n for n in left if (asks[n].kind == "gate") is of_gate] for of_gate in (True, False))
        number = ahead.first_ready([*gates, *studies[:1]], lambda number: _kernels(asks[number]))
        left.remove(number)
        yield number


def _kernels(ask: Ask) -> list[Call]:
    """None where it cannot be run."""
    with suppress(InputError):
        return [] if ask.problem else list(ask.kernels())
    return []


def _n_kernels(ask: Ask) -> int:
    """How many it needs; of studies and claims, which come last as they stand, it is not asked."""
    return len({kernel for kernel, _ in _kernels(ask)}) if ask.kind == "gate" else 0
