"""Rules that are followed without a word: steps, pivots, feet that rise and fall, the judge of eigenvalues."""

from math import pi, sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held
from verify.stress.references.textbook import assembled


def missed_error(turn: float) -> float:
    """Of what a step misses of two waves' speed, against Simpson's rule on cosines; `turn` is omega dt / 2 of one."""
    from verify.motion.step_size import missed

    turns, sizes, driven, dt = np.array([turn, 0.6 * turn]), np.array([0.7, 1.1]), 0.9, 0.004
    simpson = abs((2.0 * np.cos(turns) + 4.0) / 6.0 * turns / np.sin(turns) - 1.0)
    exact = sqrt(float(((sizes * simpson) ** 2).sum()) / float(driven**2 + (sizes**2).sum()))
    return abs(missed(2.0 * turns / dt, sizes, driven, dt) / exact - 1.0)


def pivots_error(points: float) -> float:
    """Pivots that are left too early or kept too long, where a determinant passes a tenth a point."""
    from verify.chain.dynamics import keep_pivots

    n = int(points)
    wrong = 0
    for share, kept in ((1.03 * 0.1**n, True), (0.97 * 0.1**n, False)):
        rows = np.hstack([np.eye(n), 3.0 * share ** (1.0 / n) * np.eye(n), 3.0 * np.eye(n)])
        pivots = np.arange(n) + n
        wrong += np.array_equal(keep_pivots(rows, pivots), pivots) is not kept
        wrong += 0 if n > 1 else sum(_kept_in_steps(share, link) is not kept for link in (0, 2))
    return float(wrong)


def _kept_in_steps(share: float, furthest: int) -> bool:
    """Whether a loop over steps keeps the angle of the second of three links, whose lever arm at a roller is a share.

    Of the longest, which is that of the first, or of the third, at whose end the roller is.
    """
    from verify.chain.held_kernels import repivot

    arms = np.array([0.3, share * 0.7, 0.4, 0.0])
    arms[furthest] = -0.7
    work, pivots = np.zeros((4, 14)), np.array([1])
    work[:, 13] = 1.1 - arms
    python: Any = repivot
    left = python.py_func(SimpleNamespace(held=np.array([[0.0, 0.0, 0.0, 0.0, 2.0]])), pivots, work, 0.1)
    return bool(not left and pivots[0] == 1)


def short_foot_error(span: float) -> float:
    """Of mean friction, speed, dead band and rise of a short foot, against sums over a period, in shares of a turn."""
    from verify.contact.foot import dead_band, height_swing, short_foot_force, short_foot_speed

    turns = (np.arange(20_000) + 0.5) / 10_000.0 * pi - pi
    beside = np.maximum(abs(turns) - span, 0.0)  # of the nearer edge from the crest
    worst = abs(height_swing(span) - float(np.ptp(np.cos(beside))))
    for r in (-0.4, 0.0, 0.6):
        worst = largest(worst, abs(short_foot_force(span, r) - float(np.sign(np.cos(beside) - r).mean())))
    worst = largest(worst, abs(dead_band(span) - float(np.sign(np.cos(beside)).mean())))
    return largest(worst, abs(float(np.sign(np.cos(beside) - short_foot_speed(span)).mean())) * (span < 0.5 * pi))


def standing_error(load: float) -> float:
    """Of how high a long foot stands and what drives it, against sums over what touches of a wave."""
    from verify.contact.foot import foot_force, standing_height

    turns = (np.arange(20_000) + 0.5) / 10_000.0 * pi - pi
    height = standing_height(load)
    pressed = np.maximum(np.cos(turns) - height, 0.0)
    drive = [
        abs(foot_force(load, r) - float(pressed @ np.sign(np.cos(turns) - r) / pressed.sum())) for r in (-0.3, 0.5)
    ]
    return largest(abs(float(pressed.mean()) / load - 1.0), *drive)


def giving_error(epsilon: float) -> float:
    """Of forces through a layer that gives way, against its stretch followed in 3000 steps, whatever touches and slips.

    A spring goes on with the surface as far as friction there lets it, and never further.
    """
    from verify.contact.layer import force, no_load_speed

    pairs = [(phi, r) for phi in (0.4, 1.3, 2.2, 3.1) for r in (-1.4, -0.3, 0.25, 0.8, 1.3)]
    phi, r = np.array(pairs).T
    places, stretch, total = np.linspace(-1.0, 1.0, 3001)[:, None] * phi, np.zeros(len(phi)), np.zeros(len(phi))
    limits = epsilon * (np.cos(places) - np.cos(phi))
    for before, after, most in zip(places[:-1], places[1:], limits[1:], strict=True):
        passed = np.sin(after) - np.sin(before) - r * (after - before)
        moved = np.clip(stretch + passed, -most, most)
        stretch, total = moved, total + 0.5 * (stretch + moved) * (after - before)
    exact = total / (2.0 * epsilon * (np.sin(phi) - phi * np.cos(phi)))
    worst = float(abs(np.array([force(*pair, epsilon) for pair in pairs]) - exact).max())
    return largest(worst, *(abs(force(one, no_load_speed(one, epsilon), epsilon)) for one in (0.4, 1.3, 2.2)))


CROWD = np.array([0.31, 1.72, 2.0, 5.4, 5.41, 19.6, 38.2])
"""Links from the wall at which bodies stand: beside it, on a joint, next to each other, alone, near the tip."""


def crowd_error(links: float) -> float:
    """Of how bodies on a cantilever of links feel each other's forces and couples, and their own, as on the beam.

    x^2 (3 y - x) / 6 of forces, x (2 y - x) / 2 or x^2 / 2 of a force and a couple, x of couples, for x < y; and the
    same from the other end.
    """
    from verify.segments.assembly import build_chain
    from verify.segments.crowded import felt_together

    n, worst = int(links), 0.0
    joints = np.arange(n + 1)
    x, y = np.meshgrid(CROWD, CROWD, indexing="ij")
    low, high = np.minimum(x, y), np.maximum(x, y)
    turns = np.where(x < y, x**2 / 2.0, y * (2.0 * x - y) / 2.0)
    exact = np.block([[low**2 * (3.0 * high - low) / 6.0, turns], [turns.T, low]])
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    for way, pair in ((1, ("clamped", "free")), (-1, ("free", "clamped"))):
        chain = build_chain(held(*pair), n)
        places = (CROWD if way > 0 else n - CROWD) * chain.unit
        felt, turned = (rows[:, ::way] for rows in felt_together(chain, places.tolist(), "reciprocal"))
        couples = np.pad(turned, ((0, 0), (1, 0))) - np.pad(turned, ((0, 0), (0, 1)))
        moments = (np.maximum(joints - joints[:, None], 0) @ np.vstack([felt, couples]).T)[:-1]
        found = moments.T @ (chain.compliances[::way][:-1, None] * moments)
        worst = largest(worst, float((abs(found - exact) / scale).max()))
    return worst


def _judged_hertz(model: str, supports: tuple[str, str], n: int, mode: int) -> float:
    """By dense matrices; of links with a wall or a free end, which those do not know, by their strains."""
    from scipy.linalg import eigh

    beam = held(*supports)
    if model == "segment" and supports != ("pinned", "pinned"):
        from verify.segments.linear import solve_modes

        return float(solve_modes(beam, mode, n).frequencies_hz[-1])
    values: Array = eigh(*(one.toarray() for one in assembled(model, supports, n)), eigvals_only=True)
    own = sqrt(float(values[mode - 1 + beam.rigid_motions])) * (n / STRIP.length) ** 2
    return own * STRIP.wave_constant / (2.0 * pi)


def judge_error(part: float) -> float:
    """By how far the judge of eigenvalues misses a frequency that is off by a part: the next of 1, 2 and 5 above it."""
    from verify.judge.extended_precision import eigenvalue_error

    wrong, n, mode = 0, 9, 2
    for supports in (("pinned", "pinned"), ("clamped", "free"), ("free", "free"), ("guided", "clamped")):
        for model in ("segment", "fem"):
            beam = held(*supports)
            hertz = _judged_hertz(model, supports, n, mode)
            above = min(m * 10.0**e for e in range(-12, 0) for m in (1, 2, 5) if m * 10.0**e > part)
            for side in (1.0, -1.0):
                wrong += (
                    not abs(eigenvalue_error(beam, model, n, mode, hertz * (1.0 + side * part)) / above - 1.0) <= 1e-9
                )
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="speed-that-steps-miss",
        title="What a step misses of two waves, against Simpson's rule on cosines",
        why="motion/step_size.py: (omega dt / 2)^4 / 180, the next power of which is a fortieth of the square.",
        along="radians",
        at=(0.02, 0.06),
        promise=1e-3,
        error=missed_error,
    ),
    Floor(
        id="pivots-kept",
        title="Pivots left too early or kept too long, between steps and in their loop",
        why="chain/dynamics.py, held_kernels.py: while a tenth for each held point is left of the best determinant.",
        along="points",
        at=(1, 2, 3),
        promise=0.5,
        error=pivots_error,
    ),
    Floor(
        id="short-feet",
        title="Friction, speed, dead band and rise of feet shorter than a wave, against sums over a period",
        why="contact/foot.py: arcs of a turn; a sum over 20 000 places misses one of them at either edge.",
        along="radians",
        at=(0.0, 0.4, 1.3),
        promise=1e-3,
        error=short_foot_error,
    ),
    Floor(
        id="long-feet",
        title="Height and friction of feet of whole waves, in part on the wave and pressed on all of it, against sums",
        why="contact/foot.py: roots and arcs; a sum over 20 000 places.",
        along="load",
        at=(0.05, 0.6, 1.7),
        promise=1e-3,
        error=standing_error,
    ),
    Floor(
        id="layers-that-give",
        title="Forces through layers that give way along the surface, half touching or nearly all of a wave, any speed",
        why="contact/layer.py: stretches of sticking and slipping by closed forms; 3000 steps miss 1e-6 at turns.",
        along="epsilon",
        at=(0.07, 0.4, 2.5),
        promise=1e-5,
        error=giving_error,
    ),
    Floor(
        id="crowds-on-a-cantilever",
        title="Bodies beside a wall and next to each other on links, statically: forces and couples that they feel",
        why="segments/crowded.py: weights whose products are the beam's, to the rounding of their factorisations.",
        along="links",
        at=(40.0, 55.0),
        promise=1e-8,
        error=crowd_error,
    ),
    Floor(
        id="judge-of-eigenvalues",
        title="Frequencies that are off by a part, judged by counts in 50 digits: the next of 1, 2 and 5 above it",
        why="judge/extended_precision.py: Sylvester's law on matrices written down once more, of links at any support.",
        along="relative",
        at=(3e-7, 1.3e-4),
        promise=0.5,
        error=judge_error,
    ),
)
