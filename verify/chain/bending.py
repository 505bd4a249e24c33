"""Large bending of a cantilever of rigid links under a dead load and a moment at its tip.

Beyond its buckling load a chain has several equilibria, and Newton's method finds any of them: there the load grows
from zero along the path of stable equilibria.
"""

from dataclasses import replace

import numpy as np
from msgspec import Struct, structs

from verify.arrays import Array
from verify.chain.statics import MAX_TURN, SETTLED, TOLERANCE, Forces, forces_at, solve_static
from verify.chain.system import ChainSystem, LinkLoad, build_system
from verify.errors import InputError, shown
from verify.linear.positions import Numbers, as_vector
from verify.options import JOINTS, Joints, Wall
from verify.problem.beam import Beam
from verify.validation import check_number, check_whole, check_word

SAFE = 0.9
"""Of the buckling load: how far a load is raised at once."""
ADDED = 0.5
"""Of what a growth of the load turns links by at first: what may come to that."""
LEAST_GROWTH = 1e-12
"""Of the load, relative: where a part as small is not followed, the path ends."""


class Bent(Struct, frozen=True, eq=False, kw_only=True):
    """A cantilever of rigid links in equilibrium, clamped at x = 0; x along the straight beam, y across it."""

    beam: Beam
    """As it was given."""
    count: int
    """Segments N."""
    joints: Array
    """(N + 1, 2), metres: (x, y) from the clamp to the tip."""
    angles: Array
    """(N,), radians: of every link from the straight beam, as the beam is turned at the link's middle."""
    turn: float
    """Radians: of the tip, half a link beyond the last link's middle, which the applied moment bends."""
    moments: Array
    """(N + 1,), N m: carried by every joint, the applied one at the tip."""
    curvature: Array
    """(N + 1,), 1/m: moment over EI there, of the piece on the right where two meet."""
    energy: float
    """Elastic energy, joules: of the joints, and of the half link up to the tip under the applied moment."""

    @property
    def tip(self) -> Array:
        """(2,), metres: (x, y) of the free end."""
        return np.asarray(self.joints[-1])

    @property
    def deflection(self) -> float:
        """Y of the tip, metres."""
        return float(self.joints[-1, 1])

    @property
    def shortening(self) -> float:
        """By how much the tip has come back along x, metres."""
        return self.beam.length - float(self.joints[-1, 0])


def bend(
    beam: Beam,
    count: int,
    load: Numbers = 0.0,
    *,
    moment: float = 0.0,
    wall: Wall = "gregory",
    joints: Joints = "series",
) -> Bent:
    """A cantilever of `count` links under a dead `load` (newton) and a `moment` (N m) at its tip, however large.

    `load` is one number across the straight beam, or a pair (along, across); it keeps its direction as the beam bends.
    A load that follows the tip has no place in the chain's statics. The reference is the elastica (K. E. Bisshopp and
    D. C. Drucker, Quart. Appl. Math. 3 (1945) 272), approached with order 2 in `count` by tip, turn and energy. A joint
    stands for the half links on either side; the half link up to the tip has none, and bends under `moment` alone: its
    part of turn and energy is added. Under a moment alone both are exact, and with wall = "half" the circle closes.
    Beyond the buckling load, where a chain has several equilibria, the load grows from nothing, and the equilibrium is
    the stable one that it leads to. Raises InputError for supports other than clamped and free, what stands on the
    beam, a push along alone beyond the buckling load, and where no equilibrium is found.
    """
    _check_cantilever(beam, joints)
    check_whole("count", count, 2)
    along, across = _along_and_across(load)
    check_number("moment", moment, "N m")
    system = build_system(structs.replace(beam, loss_factor=0.0), count, wall=wall, joints=joints)
    end = LinkLoad(link=count, at=float(system.lengths[-1]), force=(along, across), moment=float(moment))
    turned = led_to(replace(system, loads=(end,)), along, across, float(moment))
    angles, moments = np.cumsum(turned), np.append(system.stiffness * turned, moment)
    steps = system.lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    curvature = moments / _stiffness_at(beam, system.nodes)
    beyond = 0.5 * float(system.lengths[-1] * curvature[-1])
    return Bent(
        beam=beam,
        count=count,
        joints=np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]),
        angles=angles,
        turn=float(angles[-1]) + beyond,
        moments=moments,
        curvature=curvature,
        energy=0.5 * (float(moments[:-1] @ turned) + moment * beyond),
    )


def _check_cantilever(beam: Beam, joints: Joints) -> None:
    """Raise InputError for a beam and joints that are not bent."""
    if beam.supports != ("clamped", "free"):
        raise InputError(f"beam.supports = {beam.supports!r}: bend takes a cantilever, give ('clamped', 'free')")
    if beam.tension:
        raise InputError(f"beam.tension = {beam.tension!r} N: bend takes it as load = (along, across), leave it out")
    check_word("joints", joints, JOINTS)
    if joints == "tensioned":
        raise InputError("joints = 'tensioned' are of a beam.tension, bend has none: give 'series' or 'printed'")


def _along_and_across(load: Numbers) -> tuple[float, float]:
    """The parts of a load, newton. Raises InputError."""
    force = as_vector("load", load, "newton")
    if force.shape not in ((1,), (2,)):
        raise InputError(f"load = {shown(load)}: give one number across the beam, or two, along and across (newton)")
    return (float(force[0]), float(force[1])) if len(force) == 2 else (0.0, float(force[0]))


def _stiffness_at(beam: Beam, x: Array) -> Array:
    """EI at places of the straight beam, (n,), of the piece on the right where two meet."""
    starts = np.cumsum([0.0, *(piece.length for piece in beam.pieces[:-1])])
    values = np.array([piece.bending_stiffness for piece in beam.pieces])
    return np.asarray(values[np.searchsorted(starts, x + 1e-12 * beam.length, side="right") - 1])


def led_to(system: ChainSystem, along: float, across: float, moment: float) -> Array:
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


def buckling_load(system: ChainSystem) -> float:
    """The least dead force at the tip, newton, under which some shape of a clamped chain is unstable."""
    from scipy.linalg import eigh_tridiagonal

    k, root = system.stiffness, np.sqrt(system.lengths)
    diagonal, beside = (k + np.append(k[1:], 0.0)) / system.lengths, -k[1:] / (root[1:] * root[:-1])
    return float(eigh_tridiagonal(diagonal, beside, eigvals_only=True, select="i", select_range=(0, 0))[0])


def stable(system: ChainSystem, angles: Array) -> bool:
    """Whether the energy of a chain that nothing holds but its joints is least there, under all of its loads."""
    return _solved(system, forces_at(system, angles, 1.0)) is not None


def _followed(system: ChainSystem, share: float, said: str, remedy: str, least: float) -> Array:
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


def _corrected(system: ChainSystem, start: Array, factor: float) -> Array | None:
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


def _solved(system: ChainSystem, found: Forces) -> Array | None:
    """Newton's turn of every link, (N,), by Cholesky's factors; None where the stiffness is not positive definite."""
    from scipy.linalg import LinAlgError, solveh_banded

    k = system.stiffness
    bands = np.array([k + np.append(k[1:], 0.0) + found.geometric, np.append(-k[1:], 0.0)])
    try:
        return np.asarray(solveh_banded(bands, -(found.moments + found.springs), lower=True))
    except LinAlgError:
        return None
