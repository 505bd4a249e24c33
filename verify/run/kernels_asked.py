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
    from verify.scenes.scene import Scene


def kernels_asked(scene: "Scene") -> Iterator[Call]:
    """In order of need; one that several ask for comes again."""
    asks = asks_of(scene)
    for number in in_order_of_kernels(asks):
        if not asks[number].problem:
            with suppress(InputError):
                yield from asks[number].kernels()


def in_order_of_kernels(asks: Sequence[Ask]) -> list[int]:
    """Numbers of the asks: gates first, of those that need fewest kernels; helpers compile from the other end."""
    return sorted(range(len(asks)), key=lambda number: (asks[number].kind != "gate", _n_kernels(asks[number])))


def _n_kernels(ask: Ask) -> int:
    """How many it needs; of studies and claims, which come last as they stand, it is not asked."""
    if ask.kind != "gate":
        return 0
    with suppress(InputError):
        return len({kernel for kernel, _ in ask.kernels()})
    return 0
