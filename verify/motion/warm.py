"""The calls for which the kernels of a slider are compiled, with values of the right kinds."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from verify.motion.records import Books, Drive, Given, Kept, Law, Rider, Surface
from verify.motion.stepping import contact_space, fresh_motion

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A kernel and what it is called with."""


def calls() -> Iterator[Call]:
    """Each law, each coupling."""
    from verify.motion import friction_kernels, kernels

    flat, one, space = np.zeros((1, 1)), np.zeros(1), contact_space(1)
    surface = Surface(modes=flat, drive=_drive(), table=np.zeros((1, 1, 1)), edges=one)
    given = Given(local=np.zeros((1, 1, 1)), along=one, edges=one)
    for law in (_law(None), _law(0.0)):
        yield friction_kernels.slide_on_belt, (1, 0.0, law, 0.0, 0.0, 0.0, one, flat)
        yield kernels.slide_given, (1, 0.0, given, Rider(one, law, None), flat, space)
        for two_way in (None, True):
            rider = Rider(fresh_motion(), law, two_way)
            yield kernels.look, (surface, rider, space, 0)
            yield kernels.slide, (1, 0.0, surface, rider, _books(), _kept(), space)


def _law(static: float | None) -> Law:
    return Law(
        kinetic=0.0,
        static=static,
        slope=0.0 if static is None else None,
        mass=1.0,
        half=0.0,
        gravity=0.0,
        following=False,
        held=False,
        load=0.0,
    )


def _drive() -> Drive:
    return Drive(omega=0.0, origin=0.0, unit=1.0, growth=np.zeros(1))


def _books() -> Books:
    flat = np.zeros((1, 1))
    return Books(open=False, loads=flat, forces=flat, answers=flat, ledger=np.zeros(1))


def _kept() -> Kept:
    flat = np.zeros((1, 1))
    return Kept(every=1, kept=flat, points=flat, deflections=flat, events=flat, tally=np.zeros(3, dtype=np.int64))
