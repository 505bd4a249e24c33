"""The calls for which the kernels of a slider are compiled, with values of the right kinds."""

from collections.abc import Iterator

import numpy as np

from verify.models.compiling import Call
from verify.motion.records import Books, Drive, Given, Kept, Law, Rider, Surface
from verify.motion.stepping import contact_space, fresh_motion

LAWS = {"tanh": None, "coulomb": 0.0}
"""`Law.static`, as far as its kind goes."""
COUPLINGS = {"one-way": None, "two-way": True}
"""`Rider.two_way`."""


def calls() -> Iterator[Call]:
    """Each law, each coupling."""
    for law in LAWS:
        yield from on_belt(law)
        yield from on_chain(law)
        yield from on_beam(law, "auto")


def on_belt(law: str) -> Iterator[Call]:
    """A slider on a surface of constant speed."""
    from verify.motion import friction_kernels

    yield friction_kernels.slide_on_belt, (1, 0.0, _law(LAWS[law]), 0.0, 0.0, 0.0, np.zeros(1), np.zeros((1, 1)))


def on_chain(law: str) -> Iterator[Call]:
    """A slider on a surface that is given."""
    from verify.motion import kernels

    given = Given(local=np.zeros((1, 1, 1)), along=np.zeros((1, 2)), edges=np.zeros(1))
    rider = Rider(fresh_motion(), _law(LAWS[law]), None)
    yield kernels.slide_given, (1, 0.0, given, rider, np.zeros((1, 1)), contact_space(1))


def on_beam(law: str, coupling: str) -> Iterator[Call]:
    """A slider on a beam; both couplings where it is left open which one it is."""
    from verify.motion import kernels

    surface = Surface(modes=np.zeros((1, 1)), drive=_drive(), table=np.zeros((1, 1, 1)), edges=np.zeros(1))
    for name, two_way in COUPLINGS.items():
        if coupling in (name, "auto"):
            rider = Rider(fresh_motion(), _law(LAWS[law]), two_way)
            yield kernels.slide, (1, 0.0, surface, rider, _books(), _kept(), contact_space(1))


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
