"""Which kernels a scene asks for, for whoever compiles them ahead of it.

Gates, claims and studies say it themselves. Where only a size will tell whether a beam feels its slider both loops are
named; one too many is ended with the run, and one that is left out is compiled when it is asked for.
"""

from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.models.compiling import Call
from verify.run.asks import asks_of

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


def kernels_asked(scene: "Scene") -> Iterator[Call]:
    """In order of need; one that several ask for comes again."""
    for ask in asks_of(scene):
        if not ask.problem:
            with suppress(InputError):
                yield from ask.kernels()
