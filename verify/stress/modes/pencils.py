"""Pencils and their factors by themselves: what is lifted, told apart, sharpened, counted; weights that bodies have.

Against numpy's dense matrices, and against what was put in.
"""

from importlib import import_module
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STEPPED, STRIP, held
from verify.stress.references.dense import Elements, Links

PARTS = 12

# --- Ground -----------------------------------------------------------------------------------------------------------

GROUNDED = replace(STEPPED, foundation=7e5, supports=("free", "guided"))
"""Its ground is stiffer than its first bending: its heavier section would turn as slowly as by itself."""


def lifted_error(part: float) -> float:
    """How far the bound below the modes on ground is from that of the heaviest section, less what bends.

    A millionth is left at least; where masses or a push may take modes down again it is nothing.
    """
    from verify.elements.linear import driven

    beam = replace(GROUNDED, foundation=part * 7e5)
    elements, pencil = driven(beam, PARTS, 1.0, "euler-bernoulli")
    heavy = max(piece.mass_per_length for piece in beam.pieces)
    unit = beam.bending_stiffness / (beam.mass_per_length * elements.parts.unit**4)
    lifted = beam.foundation / heavy / unit
    bare = driven(replace(beam, foundation=0.0), PARTS, 1.0, "euler-bernoulli")[1].bending
    worst = abs(pencil.below - max(lifted - max(1e-6 * lifted, bare), 0.0)) / lifted
    values = np.linalg.eigvalsh(_dense(pencil))
    worst = largest(worst, float(pencil.below >= values[0]))
    for changes in ({"mass": (PointMass(position=0.2, mass=0.01),)}, {"tension": -0.1}):
        worst = largest(worst, abs(driven(replace(beam, **changes), PARTS, 1.0, "euler-bernoulli")[1].below))
    return largest(worst, abs(driven(beam, PARTS, 1.0, "rayleigh")[1].below))


def _strains(pencil: Any) -> Array:
    """What each motion strains, written out."""
    return np.asarray(pencil.strain_matrix() @ np.eye(pencil.n))


def _dense(pencil: Any) -> Array:
    """L^-1 K L^-T of M = L L^T."""
    lower = np.linalg.cholesky(np.asarray(pencil.mass_matrix() @ np.eye(pencil.n)))
    half = np.linalg.solve(lower, _strains(pencil).T * np.sqrt(pencil.stiffness))
    return np.asarray(half @ half.T)


ON_GROUND: tuple[Beam, ...] = tuple(
    replace(STRIP, length=0.6 + 0.05 * i, foundation=3e3 * (1.0 + i % 3), supports=ends)
    for i, ends in enumerate((("pinned", "pinned"), ("free", "free"), ("clamped", "free"), ("pinned", "free")) * 2)
)


def on_ground_error(model: float) -> float:
    """Of beams on ground in one call, by each one's matrices written out: their inverse problem keeps the low modes."""
    from scipy.linalg import eigh

    room, written = (("elements", Elements), ("segments", Links))[int(model)]
    found, worst = import_module(f"verify.{room}.sweeps").sweep_modes(ON_GROUND, 5, PARTS), 0.0
    for row, beam in zip(np.asarray(found), ON_GROUND, strict=True):
        own = written(beam, np.linspace(0.0, beam.length, PARTS + 1))
        inverse = eigh(own.kept(own.mass), own.kept(own.bent + own.rest), eigvals_only=True)[:-6:-1]
        worst = largest(worst, float(abs(2.0 * np.pi * row * np.sqrt(inverse) - 1.0).max()))
    return worst


# --- Slow motions -----------------------------------------------------------------------------------------------------

SOFT = replace(
    STEPPED,
    supports=("free", "free"),
    spring=(PointSpring(position=0.1, stiffness=2e-9), PointSpring(position=0.6, stiffness=2.3e-9)),
)
"""Its two slow motions are all but alike in frequency."""
TURN = 0.6
"""Radians by which modes are mixed, two by two."""


def apart_error(number: float) -> float:
    """Of two slow motions and two that bend, told apart from mixtures, or with a slow one missed.

    Slow are those of a rigid beam on its springs, which it bends by a part of 1e-12; the others are dense ones.
    """
    from scipy.linalg import eigh

    from verify.elements.linear import driven
    from verify.elements.pencil import own_strains
    from verify.models.inverse import fitting_inverse
    from verify.models.pencil import factored_quotient
    from verify.models.polishing import told_apart

    elements, pencil = driven(SOFT, PARTS, 1.0, "euler-bernoulli")
    mass, stiffness = pencil.mass_matrix() @ np.eye(pencil.n), _stiffness(pencil)
    strain = _strains(pencil)
    rigid = np.linalg.svd(strain[: own_strains(elements)])[2][-2:].T  # what strains nothing of its own
    strains = strain @ rigid
    slow, shares = eigh(strains.T @ (pencil.stiffness[:, None] * strains), rigid.T @ mass @ rigid)
    bent, vectors = eigh(stiffness, mass, subset_by_index=[2, 3])
    modes = np.hstack([rigid @ shares, vectors])
    c, s = np.cos(TURN), np.sin(TURN)
    given = np.hstack([modes[:, :2] @ [[c, -s], [s, c]], vectors]) if not number else modes[:, [1, 2, 3]]
    found, strains = told_apart(fitting_inverse(pencil), given)
    off = abs(factored_quotient(pencil, found, strains)[0][:4] / np.append(slow, bent) - 1.0)
    return float(off.max())


def _stiffness(pencil: Any) -> Array:
    strain = _strains(pencil)
    return np.asarray(strain.T @ (pencil.stiffness[:, None] * strain))


SMALL = 1e-5


def sharpened_error(number: float) -> float:
    """Of modes mixed with each other by 1e-5, over the square of that, once they are sharpened; of their values."""
    from scipy.linalg import eigh

    from verify.elements.linear import driven
    from verify.models.polishing import sharpened

    _, pencil = driven(STEPPED, PARTS, 1.0, "euler-bernoulli")
    mass, stiffness = pencil.mass_matrix() @ np.eye(pencil.n), _stiffness(pencil)
    values, exact = eigh(stiffness, mass)
    n, low = pencil.n, slice(0, 8)
    i, j = np.indices((n, n))
    mixed = exact @ (np.eye(n) + SMALL * np.sin(1.0 + 3.0 * i + 7.0 * j) * (i < 12) * (j < 12))
    taken = mixed.copy()
    told, found = sharpened(pencil, values, taken)
    off = exact.T @ mass @ found - np.eye(n)
    left = float(abs(off[low, low]).max()) / (1e3 * SMALL**2)
    return largest(left, float(abs(told[low] / values[low] - 1.0).max()) / (1e3 * SMALL**2))


# --- Factors ----------------------------------------------------------------------------------------------------------


def factors_error(unknowns: float) -> float:
    """Of counts, logs, rounding's room and solutions of bands beside bodies, at four shifts, by dense matrices."""
    from verify.models.band_stack import Pencils, factorised, tally

    n, at = int(unknowns), np.arange(unknowns)
    k = np.zeros((n, 3, 1))
    k[:, 0, 0], k[:-1, 1, 0], k[:-2, 2, 0] = 6.0 + np.sin(at), -3.0 + 0.2 * np.cos(at[:-1]), 0.7 + 0.1 * np.sin(at[:-2])
    m = np.zeros((n, 2, 1))
    m[:, 0, 0], m[:-1, 1, 0] = 1.0 + 0.3 * np.cos(at), 0.2
    felt = np.stack([np.exp(-0.3 * abs(at - 4.2)), np.sin(0.2 * at), np.cos(0.5 * at)], axis=1)[:, :, None]
    held, heavy = np.array([[3.0], [0.0], [0.4]]), np.array([[0.5], [2.0], [0.0]])
    pencils = Pencils(stiffness=k, mass=m, felt=felt, held=held, heavy=heavy)
    stiff, mass = (
        _full(band[:, :, 0]) + (felt[:, :, 0] * weight[:, 0]) @ felt[:, :, 0].T
        for band, weight in ((k, held), (m, heavy))
    )
    lower = np.linalg.cholesky(mass)
    values = np.linalg.eigvalsh(np.linalg.solve(lower, np.linalg.solve(lower, stiff).T))
    shifts = np.array([[0.9 * values[0]], [0.5 * (values[1] + values[2])], [0.5 * (values[-3] + values[-2])], [1e3]])
    counts, logs = tally(pencils, shifts)
    wrong = counts[:, 0].tolist() != [int((values < shift).sum()) for shift in shifts[:, 0]]
    exact = np.array([np.linalg.slogdet(stiff - shift * mass)[1] for shift in shifts[:, 0]])
    worst = max(float(wrong), float(abs(logs[:, 0] / exact - 1.0).max()))
    factors = factorised(pencils, shifts)
    for which, shift in enumerate(shifts[:, 0].tolist()):
        lines = _lower(factors, which)
        grown = lines**2 @ abs(factors.pivots[:, which])
        worst = largest(worst, float(abs(factors.grown[:, which] / grown - 1.0).max()))
        load = np.sin(0.7 * at)[:, None, None] + np.zeros((n, 1, len(shifts)))
        solved = factors.solve(load)[:, 0, which]
        right = np.linalg.solve(stiff - shift * mass, load[:, 0, 0])
        worst = largest(worst, float(abs(solved - right).max() / abs(right).max()))
    return worst


def _full(band: Array) -> Array:
    found = np.diag(band[:, 0])
    for above in range(1, band.shape[1]):
        found += np.diag(band[:-above, above], above) + np.diag(band[:-above, above], -above)
    return np.asarray(found)


def _lower(factors: Any, which: int) -> Array:
    """L of one of the matrices, with the motions of bodies last."""
    pivots, (n, w, _), r = factors.pivots[:, which], factors.beside.shape, len(factors.roots)
    found = np.eye(n + r)
    for a in range(w):
        rows = np.arange(n - 1 - a)
        found[rows + 1 + a, rows] = factors.beside[: n - 1 - a, a, which] / pivots[rows]
    for j in range(r):
        found[n + j, :n] = factors.roots[j, which] * factors.felt[:, j, which] / pivots[:n]
        for after in range(j + 1, r):
            found[n + after, n + j] = factors.corner[j, after, which] / pivots[n + j]
    return found


# --- Weights ----------------------------------------------------------------------------------------------------------

CROWDS: tuple[tuple[tuple[str, str], tuple[float, ...]], ...] = (
    (("clamped", "free"), (1.3, 3.8)),
    (("free", "pinned"), (2.6, 21.7, 22.4)),
    (("pinned", "guided"), (11.2, 13.9)),
)
"""Ends, and places of bodies in links, of 24: near a wall, near both ends, within."""


def moments_error(number: float) -> float:
    """Of weights of bodies that stand near each other, had back from the moments in the joints that they make."""
    from verify.segments import crowded
    from verify.segments.assembly import build_chain

    ends, places = CROWDS[int(number)]
    beam, n = held(*ends), 24
    chain = build_chain(beam, n)
    at = np.array(places)
    found = crowded.felt_together(chain, tuple(at * beam.length / n), "reciprocal")
    worst, seen = 0.0, 0
    for stretch in crowded._stretches(at[None], crowded.links_of(chain)):
        felt, turned = (stretch.seen(one[None]) for one in found)
        moments = crowded._moments(stretch, felt, turned)
        back = crowded._of_moments(stretch, moments, felt.shape[2])
        worst = largest(worst, *(float(abs(a - b).max()) for a, b in zip(back, (felt, turned), strict=True)))
        for which in range(len(moments)):
            lever = _levers(stretch, which, felt[which], turned[which])
            worst = largest(worst, float(abs(moments[which].T - lever).max()))
        seen += stretch.rows.size
    return largest(worst, float(seen != len(places)))


def _levers(stretch: Any, which: int, felt: Array, turned: Array) -> Array:
    """Moments in joints that a unit force, then couple, at each place makes, less those of what it does to a chain.

    From the joints that are further along: those hold it.
    """
    rows = []
    every, layout = stretch.window[which], stretch.layout
    joints = every[layout.before : layout.before + layout.width]
    for place, weights in zip(stretch.places[which] + joints[0] - layout.inner, felt, strict=True):
        ahead = np.maximum(every - joints[:, None], 0)
        rows.append(joints - place + ahead @ weights)
    after = every[:, None] >= joints
    return np.vstack([np.array(rows), 1.0 - turned @ after])


ROWS: tuple[Row, ...] = (
    Floor(
        id="lifted-by-ground",
        title="The bound below the modes of a stepped beam on ground, and where there is none",
        why="elements/added.py: what the ground lifts the heaviest section by, less what bends.",
        along="of bending",
        at=(1e-3, 1.0, 100.0),
        promise=1e-12,
        error=lifted_error,
    ),
    Floor(
        id="plain-beams-on-ground",
        title="Eight uniform beams on ground in one call, some free to move as a whole, by elements and links",
        why="models/sweeps.py: ground lifts every square by k_f / (rho A); by matrices that have it, to rounding.",
        along="model",
        at=(0.0, 1.0),
        promise=1e-12,
        error=on_ground_error,
    ),
    Floor(
        id="slow-motions-told-apart",
        title="Two slow motions of a beam on two soft springs, from mixtures of both or without one of them",
        why="models/polishing.py: those of a rigid beam, which bends by a part of 1e-12.",
        along="missed",
        at=(0.0, 1.0),
        promise=1e-10,
        error=apart_error,
    ),
    Floor(
        id="modes-sharpened",
        title="Modes with a hundred thousandth of each other, sharpened once, over its square a thousandfold",
        why="models/polishing.py: what is left is of second order, sums over a dozen others.",
        along="1",
        at=(1.0,),
        promise=1.0,
        error=sharpened_error,
    ),
    Floor(
        id="factors-beside-bodies",
        title="Counts, determinants, room for rounding and solutions of bands beside bodies, by dense matrices",
        why="models/band_stack.py: Sylvester's law, and sums over the factors; next to modes rounding grows.",
        along="unknowns",
        at=(40.0, 300.0),
        promise=1e-9,
        error=factors_error,
    ),
    Floor(
        id="weights-and-moments",
        title="Weights of bodies beside each other and ends: moments in the joints, and back",
        why="segments/crowded.py: a chain held beyond them, joint by joint.",
        along="crowd",
        at=(0.0, 1.0, 2.0),
        promise=1e-12,
        error=moments_error,
    ),
)
