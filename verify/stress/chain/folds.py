"""Where equilibria of chains end or turn over: folds of a growing load, chains on their heads, places that stand."""

import re
from math import ceil, pi
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.beam import Beam, PointForce
from verify.chain import warm
from verify.chain.bending import bend
from verify.chain.departure import Driven, _moves, driven_chain
from verify.chain.dynamics import at_rest, linearise
from verify.chain.system import ChainSystem, build_system
from verify.errors import InputError
from verify.models.arrays import Array
from verify.motion.result import END
from verify.segments.links import link_inertia
from verify.stress.chain.beyond_buckling import LINKS, _at_the_clamp, _chain
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.limits.as_written import misplaced, taken
from verify.stress.references.beams import STEPPED, held

HERTZ = 41.0

# --- Folds ------------------------------------------------------------------------------------------------------------

AGAINST = ((-0.487, -1.822, 1.05), (6.353, 1.872, -5.644), (-4.619, 0.837, 2.772))
"""Along and across, over the buckling load; moment over it and the beam's length, against the force across."""
STEP = 0.08
"""Of a path: radians of the tip and shares of the load."""
NEAR = 1e-4
"""Of either: between which differences are taken."""


def _left(system: ChainSystem, load: Array, at: Array) -> float:
    """What is left of the clamp's angle at (the tip's angle, the load's share)."""
    along, across, moment = (at[1] * load).tolist()
    return _at_the_clamp(system, at[0], (along, across, moment))[0]


def _rises(system: ChainSystem, load: Array, at: Array) -> Array:
    """How much more is left by either, by differences."""
    moved = [_left(system, load, at + one) - _left(system, load, at - one) for one in NEAR * np.eye(2)]
    return np.array(moved) / (2.0 * NEAR)


def _fold(system: ChainSystem, load: Array) -> float:
    """The share of a load at which the path from no load turns back: there the clamp's angle does not feel the tip's.

    Followed by its length until the load sinks along it; then both are made nothing by Newton's method.
    """
    at, way = np.zeros(2), np.array([0.0, 1.0])
    while True:
        by = _rises(system, load, at)
        ahead = np.array([-by[1], by[0]]) / np.hypot(*by)
        way = ahead * (1.0 if ahead @ way > 0.0 else -1.0)
        if way[1] < 0.0:
            break
        at = at + STEP * way
        for _ in range(4):
            by = _rises(system, load, at)
            at = at - _left(system, load, at) * by / (by @ by)
    for _ in range(8):
        by = _rises(system, load, at)
        more = [_rises(system, load, at + one)[0] - _rises(system, load, at - one)[0] for one in NEAR * np.eye(2)]
        both = np.array([_left(system, load, at), by[0]])
        at = at - np.linalg.solve(np.array([by, np.array(more) / (2.0 * NEAR)]), both)
    return float(at[1])


def fold_error(number: float) -> float:
    """Of the share at which a load is carried no longer, as the refusal says it.

    Endless where none comes, or where the buckling load beside it is not right to six figures.
    """
    beam, system, least = _chain()
    along, across, moment = AGAINST[int(number)]
    load = np.array([along, across, moment * beam.length]) * least
    exact = _fold(system, load)
    said = _said(beam, load)
    found = re.search(r"its buckling load is (\S+) N\): at (\S+) of it", said)
    if found is None or _said(beam, load * exact * (1.0 - 1e-5)) or not _said(beam, load * exact * (1.0 + 1e-5)):
        return float("inf")
    return abs(float(found[2]) / exact - 1.0) if abs(float(found[1]) / least - 1.0) < 5e-6 else float("inf")


def _said(beam: Any, load: Array) -> str:
    try:
        bend(beam, LINKS, (float(load[0]), float(load[1])), moment=float(load[2]))
    except InputError as error:
        return str(error)
    return ""


# --- Heads and hinges -------------------------------------------------------------------------------------------------


def _inertia(lengths: Array, masses: Array) -> Array:
    """M of straight links over their absolute angles, (N, N), entry by entry: bars that turn, what they carry on."""
    n = len(lengths)
    found = np.zeros((n, n))
    for i in range(n):
        beyond = masses[i + 1 :].sum()
        found[i, i] = lengths[i] ** 2 * (masses[i] / 3.0 + beyond)
        for j in range(i):
            found[i, j] = found[j, i] = lengths[i] * lengths[j] * (0.5 * masses[i] + beyond)
    return found


def upright_error(links: float) -> float:
    """Of the squares of unlike links without springs that hang, and of the same on their heads, one by one.

    By M written out and K = g l (m / 2 + what hangs from it) over absolute angles.
    """
    from scipy.linalg import eigh

    n, worst = np.arange(1.0, links + 1.0), 0.0
    lengths, still = 0.1 * (1.0 + 0.3 * np.sin(n)), np.zeros(len(n))
    masses = lengths * (2.0 + np.cos(n))
    beyond = np.array([masses[i + 1 :].sum() for i in range(len(n))])
    for gravity in (9.81, -9.81):
        chain = ChainSystem(
            lengths=lengths,
            masses=masses,
            inertias=link_inertia(masses, lengths),
            stiffness=still,
            dashpots=still,
            gravity=(gravity, 0.0),
        )
        held_by = np.diag(gravity * lengths * (0.5 * masses + beyond))
        exact = eigh(held_by, _inertia(lengths, masses), eigvals_only=True)
        worst = largest(worst, float(abs(linearise(chain, at_rest(chain)).squares() / exact - 1.0).max()))
    return worst


def hinged_error(links: float) -> float:
    """Of the lowest four squares of a hinged chain, and of all over 1e5, without the hinge's; 1 where that is not 0.

    From its inertia, written out, less what that motion takes, over its springs, which has no small roots.
    """
    system = build_system(held("pinned", "free"), int(links), grading=1.7)
    sums, k = np.tri(system.n_links), system.stiffness[1:]
    mass = sums.T @ _inertia(system.lengths, system.masses) @ sums
    left = mass[1:, 1:] - np.outer(mass[1:, 0], mass[0, 1:]) / mass[0, 0]
    exact = 1.0 / np.linalg.eigvalsh(left / np.sqrt(np.outer(k, k)))[::-1]
    squares = linearise(system, at_rest(system)).squares()
    off = abs(squares[1:] / exact - 1.0)
    return largest(float(off[:4].max()), 1e-5 * float(off.max()), float(squares[0] != 0.0))


# --- Places -----------------------------------------------------------------------------------------------------------


def _reads(share: float) -> bool:
    """Whether a deflection is taken whose rms is so much of what moves a beam as a whole."""
    driven = _driven(STEPPED, "rest", None)
    mass = sum(piece.mass_per_length * piece.length for piece in STEPPED.pieces)
    return _moves(driven, np.array([1.0, -1.0, 1.0]) * share / (mass * (2.0 * pi * HERTZ) ** 2))


def _driven(beam: Beam, who: str, x: float | None, duration: float = 0.3) -> Driven:
    scene: Any = SimpleNamespace(
        beam=beam,
        forces=(PointForce(position=0.2),),
        drive=SimpleNamespace(frequency_hz=HERTZ, kind="force"),
        motion=None,
        refuse_devices=lambda who: None,
    )
    return driven_chain(scene, who, 9, duration, x)


def places_error(number: float) -> float:
    """How many limits of what a departure is read from are not where they are written; places and times that differ."""
    wrong = misplaced(((1e-9, False, _reads),))
    short, long = (_driven(STEPPED, "rest", None, duration) for duration in (0.3, 3.017))
    wrong += (len(short.times), len(long.times)) != (1001, ceil(40 * HERTZ * 3.017) + 1)
    wrong += (short.x, _driven(STEPPED, "rest", 0.73).x) != (0.5 * 0.73, 0.73)
    wrong += taken(lambda: _driven(STEPPED, "rest", 0.7301))
    return wrong


# --- Runs that break off ----------------------------------------------------------------------------------------------


def kept_error(step: float) -> float:
    """Of what a chain under a load too large for its steps keeps until it diverges, by a run to the last sample kept.

    It says when it does: after so many steps.
    """
    from verify.chain.splitting import modal_basis, simulate_modal

    forces = (PointForce(position=0.6, amplitude=300.0),)
    system = build_system(held("clamped", "free"), LINKS, forces, 37.0)
    basis, start = modal_basis(system), at_rest(system)
    run = simulate_modal(basis, start, np.linspace(0.0, 0.4, 81), step=step)
    n, told = len(run.times), re.fullmatch(r"diverged at t = (\S+) s with a step of (\S+) s", run.statistics.stopped)
    if told is None or not 2 < n < 81:
        return float("inf")
    shorter = simulate_modal(basis, start, run.times, step=step)
    end, taken_s = float(told[1]), run.statistics.steps * run.statistics.step_s
    wrong = not run.times[-1] <= end < run.times[-1] + 0.005 + step or float(told[2]) != float(f"{step:.3g}")
    wrong |= run.angles.shape != (n, LINKS) or not np.isfinite(run.angles).all() or shorter.statistics.stopped != END
    off = float(abs(run.angles - shorter.angles).max()) / float(abs(shorter.angles).max())
    return largest(off, float(wrong), 1e-9 * abs(taken_s / end - 1.0))


ROWS: tuple[Row, ...] = (
    Floor(
        id="folds-of-a-load",
        title="The share of a load at which a cantilever of unlike links snaps, as its refusal says it",
        why="chain/load_path.py: six figures are told; the path from the tip, followed by its length.",
        along="load",
        at=tuple(float(number) for number in range(len(AGAINST))),
        promise=5e-6,
        error=fold_error,
    ),
    Floor(
        id="chains-on-their-heads",
        title="How chains of unlike links swing when they hang, and how they fall from upright",
        why="chain/small_motion.py: by matrices written out entry by entry; a dense solver's rounding.",
        along="links",
        at=(3.0, 7.0),
        promise=1e-11,
        error=upright_error,
    ),
    Floor(
        id="hinged-chains",
        title="Squares of hinged chains that nothing holds from turning, the lowest four to 1e-12, all to 1e-7",
        why="chain/small_motion.py: a shift that leaves digits of both; the inverse problem of what bends.",
        along="links",
        at=(5.0, 60.0),
        promise=1e-12,
        error=hinged_error,
    ),
    Floor(
        id="places-that-stand",
        title="Where a departure is read, how often, and how little a place may move, four parts in ten thousand",
        why="chain/departure.py: what each limit is said to be.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=places_error,
    ),
    Floor(
        id="kept-until-it-diverges",
        title="What a run in steps that are too long keeps until it diverges, and when it says it does",
        why="chain/splitting.py: the same steps of a run that ends earlier; six digits are told.",
        along="s",
        at=(2.5e-3,),
        promise=1e-12,
        error=kept_error,
        kernels=warm.modal,
    ),
)
