"""The calls for which the kernels of a chain are compiled, with values of the right kinds."""

from collections.abc import Iterator

import numpy as np

from verify.chain.records import FREE, Flat, March, Modal
from verify.models.compiling import Call


def calls() -> Iterator[Call]:
    """Rigid links in steps and in modes, links that stretch."""
    yield from with_energies()
    yield from modal()
    yield from stretching()
    yield from stretching_energy()


def placed() -> Iterator[Call]:
    """Links where they stand."""
    from verify.chain import held_kernels, recursion_kernels

    one = np.zeros(1)
    yield recursion_kernels.hub_motion, (one, 0.0)
    yield held_kernels.place, (_flat(), 0.0, one, one, np.zeros((1, 1)))


def resting() -> Iterator[Call]:
    """Links on their constraints, about an equilibrium."""
    from verify.chain import held_kernels

    one = np.zeros(1)
    yield from placed()
    yield held_kernels.project, (_flat(), 0.0, one, one, np.zeros(1, dtype=np.int64), 0.0, np.zeros((1, 1)))


def accelerations() -> Iterator[Call]:
    """Of links as they stand."""
    from verify.chain import kernels

    one = np.zeros(1)
    yield kernels.accelerate, (_flat(), 0.0, one, one, np.zeros((1, 1)), one)


def accelerated() -> Iterator[Call]:
    """Links on their constraints and their accelerations, from which modes and steps are found."""
    yield from resting()
    yield from accelerations()


def rigid() -> Iterator[Call]:
    """Rigid links in steps."""
    from verify.chain import kernels

    yield from accelerated()
    yield kernels.march, (_flat(), _march(), 1, np.zeros((1, 1)))


def energies() -> Iterator[Call]:
    """Energies of rigid links."""
    from verify.chain import kernels

    one = np.zeros(1)
    yield kernels.energies, (_flat(), 0.0, one, one, np.zeros((1, 1)))


def with_energies() -> Iterator[Call]:
    """Rigid links in steps, and their energies."""
    yield from rigid()
    yield from energies()


def modal() -> Iterator[Call]:
    """Rigid links in modes."""
    from verify.chain import splitting_kernels

    flat, one, few = np.zeros((1, 1)), np.zeros(1), np.zeros(1, dtype=np.int64)
    yield splitting_kernels.march_modal, (_flat(), _modal(), one, few, one, np.zeros((1, 1, 1)), 1, flat, flat)


def stretching() -> Iterator[Call]:
    """Links that stretch."""
    from verify.chain import stretching_kernels

    flat, one, cube = np.zeros((1, 1)), np.zeros(1), np.zeros((1, 1, 1))
    links = stretching_kernels.Elastic(links=flat, loads=flat, gravity=one, factors=cube)
    yield stretching_kernels.factorise, (one, one, flat, cube)
    yield stretching_kernels.march, (links, 0.0, 0.0, 1, flat, flat, cube, cube)


def stretching_energy() -> Iterator[Call]:
    """Their energy."""
    from verify.chain import stretching_kernels

    flat, one = np.zeros((1, 1)), np.zeros(1)
    links = stretching_kernels.Elastic(links=flat, loads=flat, gravity=one, factors=np.zeros((1, 1, 1)))
    yield stretching_kernels.energy, (links, one, one, flat, flat)


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


def _march() -> March:
    flat, one, few = np.zeros((1, 1)), np.zeros(1), np.zeros(1, dtype=np.int64)
    return March(
        a=flat,
        c=one,
        weights=one,
        order=5.0,
        y=one,
        new=one,
        k=flat,
        clock=one,
        counts=few,
        samples=one,
        kept=flat,
        scale=one,
        pivots=few,
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
        start=flat,
        steady=flat,
        trial=flat,
        vectors=flat,
        force=one,
    )
