"""The calls for which the kernels of a chain are compiled, with values of the right kinds."""

from collections.abc import Iterator

import numpy as np

from verify.chain.records import FREE, Elastic, Flat, Modal, idle
from verify.models.compiling import Call


def calls() -> Iterator[Call]:
    """Rigid links in steps and in modes, links that stretch."""
    yield from rigid()
    yield from modal()
    yield from stretching()


def rigid() -> Iterator[Call]:
    """Rigid links in steps, and how they are accelerated as they stand."""
    from verify.chain import kernels

    yield kernels.march, (_flat(), idle(1), 1, np.zeros((1, 1)))


def modal() -> Iterator[Call]:
    """Rigid links in modes."""
    from verify.chain import splitting_kernels

    yield from rigid()
    flat, one, few = np.zeros((1, 1)), np.zeros(1), np.zeros(1, dtype=np.int64)
    yield splitting_kernels.march_modal, (_flat(), _modal(), one, few, one, np.zeros((1, 1, 1)), 1, flat, flat)


def stretching() -> Iterator[Call]:
    """Links that stretch."""
    from verify.chain import stretching_kernels

    flat, one, cube = np.zeros((1, 1)), np.zeros(1), np.zeros((1, 1, 1))
    links = Elastic(links=flat, loads=flat, gravity=one, factors=cube)
    yield stretching_kernels.march, (links, 0.0, 0.0, 1, flat, flat, cube, cube)


def _flat() -> Flat:
    flat = np.zeros((1, 1))
    return Flat(
        links=flat,
        numbers=np.zeros(1),
        loads=flat,
        held=flat,
        small=flat,
        tip=FREE,
        tip_spring=0.0,
        axial=True,
        ledger=False,
    )


def _modal() -> Modal:
    flat, one = np.zeros((1, 1)), np.zeros(1)
    return Modal(
        kicks=one,
        shares_of_step=one,
        flows=np.zeros((1, 1, 1)),
        spacing=flat,
        omega=one,
        modes=flat,
        duals=flat,
        rest=one,
        drives=flat,
        shares=flat,
        tilt=0.0,
        loose=_flat(),
        start=flat,
        steady=flat,
        trial=flat,
        vectors=flat,
        force=one,
    )
