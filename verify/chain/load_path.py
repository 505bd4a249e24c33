"""Where a growing dead load leads a cantilever of links from rest: the equilibrium that stays stable all the way.

Beyond its buckling load a chain has several equilibria, and Newton's method finds any of them. Below it there is one.
"""

from typing import TYPE_CHECKING

import numpy as np

from verify.chain.statics import MAX_TURN, SETTLED, TOLERANCE, Forces, forces_at, solve_static
from verify.errors import InputError, shown
from verify.models.arrays import Array

if TYPE_CHECKING:
    from verify.chain.system import ChainSystem

SAFE = 0.9
"""Of the buckling load: how far a load is raised at once."""
ADDED = 0.5
"""Of what a growth of the load turns links by at first: what may come to that."""
LEAST_GROWTH = 1e-12
"""Of the load, relative: where a part as small is not followed, the path ends."""


def led_to(system: "ChainSystem", along: float, across: float, moment: float) -> Array:
    """Relative angles, (N,), of a clamped chain with a free tip under the dead load and moment there that it carries.

    The load is raised from nothing, force and moment in proportion. Raises InputError where it pushes along alone
    beyond the buckling load, and where the stable path ends.
    """
    size, least = float(np.hypot(along, across)), buckling_load(system)
    if along < 0.0 and not across and not moment and -along >= least:
        raise InputError(
            f"load = {shown((along, across))} N pushes the straight cantilever beyond its buckling load of "
            f"{least:.6g} N, to neither side rather than the other: give a small force across as well, or push less"
        )
    if size < least or (along >= 0.0 and not moment):
        angles = solve_static(system).angles
        if size < least or stable(system, angles):
            return angles
    said = f"load = {shown((along, across))} N" + (f" with moment = {shown(moment)} N m" if moment else "")
    remedy = "another moment" if moment else "a larger force across"
    return _followed(system, min(SAFE * least / size, 1.0), said, f"give {remedy}, or less load", least)


def buckling_load(system: "ChainSystem") -> float:
    """The least dead force at the tip, newton, under which some shape of a clamped chain is unstable."""
    from scipy.linalg import eigh_tridiagonal

    k, root = system.stiffness, np.sqrt(system.lengths)
    diagonal, beside = (k + np.append(k[1:], 0.0)) / system.lengths, -k[1:] / (root[1:] * root[:-1])
    return float(eigh_tridiagonal(diagonal, beside, eigvals_only=True, select="i", select_range=(0, 0))[0])


def stable(system: "ChainSystem", angles: Array) -> bool:
    """Whether the energy of a chain that nothing holds but its joints is least there, under all of its loads."""
    return _solved(system, forces_at(system, angles, 1.0)) is not None


def _followed(system: "ChainSystem", share: float, said: str, remedy: str, least: float) -> Array:
    """The equilibrium under the whole load, through stable ones near to each other from a share of it on."""
    done, growth, angles = 0.0, 1.0, np.zeros(system.n_links)
    while done < 1.0:
        wanted = min(done * (1.0 + growth) if done else share, 1.0)
        found = _corrected(system, angles, wanted)
        if found is not None:
            angles, done, growth = found, wanted, min(2.0 * growth, 1.0)
        elif growth > LEAST_GROWTH:
            share, growth = 0.25 * share, 0.25 * growth
        else:
            raise InputError(
                f"{said} buckles the cantilever (its buckling load is {least:.6g} N): at {done:.6g} of it no stable "
                f"equilibrium follows, {remedy}"
            )
    return angles


def _corrected(system: "ChainSystem", start: Array, factor: float) -> Array | None:
    """The equilibrium next to a start, all stable on the way there; None where Newton's method leaves it.

    Beyond a fold it finds another path, if any, and by more than its first step: half of that is what it may add.
    """
    angles, first = start, None
    for _ in range(30):
        found = forces_at(system, angles, factor)
        turn = _solved(system, found)
        if turn is None or abs(turn).max() > MAX_TURN:
            return None
        angles, first = angles + np.diff(turn, prepend=0.0), turn if first is None else first
        if abs(np.cumsum(angles - start) - first).max() > ADDED * abs(first).max():
            return None
        scale = abs(found.moments).max() + abs(system.stiffness * angles).max()
        if abs(found.moments + found.springs).max() <= TOLERANCE * scale and abs(turn).max() < SETTLED:
            return angles if _solved(system, forces_at(system, angles, factor)) is not None else None
    return None


def _solved(system: "ChainSystem", found: Forces) -> Array | None:
    """Newton's turn of every link, (N,), by Cholesky's factors; None where the stiffness is not positive definite."""
    from scipy.linalg import LinAlgError, solveh_banded

    k = system.stiffness
    bands = np.array([k + np.append(k[1:], 0.0) + found.geometric, np.append(-k[1:], 0.0)])
    try:
        return np.asarray(solveh_banded(bands, -(found.moments + found.springs), lower=True))
    except LinAlgError:
        return None
