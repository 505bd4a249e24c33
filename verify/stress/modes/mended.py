"""Chains mended to order 4 for what a beam has on it: modes, what is read of them, and both from the other end."""

from math import log2, pi
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held

CLAMPED = replace(held("clamped", "free"), tension=40.0)
TURNED = replace(held("pinned", "pinned"), spring=(PointSpring(position=0.73, rotational=9.0),))
HEAVY = replace(STRIP, mass=(PointMass(position=0.29, mass=0.05),), spring=(PointSpring(position=0.51, stiffness=3e3),))
TIP = replace(held("clamped", "free"), mass=(PointMass(position=0.73, mass=0.05, rotary_inertia=2e-5),))
TENSIONED: dict[str, Any] = {"joints": "tensioned"}
SHEAR: dict[str, Any] = {"theory": "timoshenko", "joints": "tensioned"}
MENDED: tuple[tuple[Beam, dict[str, Any]], ...] = (
    (CLAMPED, TENSIONED),
    (replace(CLAMPED, supports=("guided", "clamped")), TENSIONED),
    (replace(TURNED, tension=40.0), TENSIONED),
    (held("clamped", "free"), SHEAR),
    (held("guided", "clamped"), SHEAR),
    (held("clamped", "pinned"), {"theory": "rayleigh", "joints": "tensioned"}),
    (HEAVY, SHEAR),
    (HEAVY, {}),
    (TIP, {}),
    (TIP, SHEAR),
    (TURNED, {}),
)
"""Whatever a chain is mended for to order 4."""


def mended_error(count: float) -> float:
    """Of mode 2 of mended chains, over 0.012 of its turn from link to link ^4; of the first two's order, over 0.3.

    And of both modes of each from its other end, over 1e-12 of frequencies and 1e-9 of slopes.
    """
    n = int(count)
    worst = max(abs(_mode_error(i, n)) for i in range(len(MENDED))) / 0.012
    worst = largest(worst, *(_turned_round(i, n) for i in range(len(MENDED))))
    orders = [log2(_mode_error(i, n) / _mode_error(i, 2 * n)) for i in range(2)]
    return largest(worst, *(abs(order) / 0.3 for order in orders))


def _turned_round(number: int, n: int) -> float:
    from verify.models.catalogue import MODELS

    beam, given = MENDED[number]
    x = np.linspace(0.03, 0.97, 17) * beam.length
    here, there = (MODELS["segment"].solve_modes(one, 2, n, **given) for one in (beam, beam.mirrored()))
    off = float(abs(there.frequencies_hz / here.frequencies_hz - 1.0).max()) / 1e-12
    slopes, others = here.shapes(x, 1), -there.shapes(beam.length - x, 1)
    sides = np.sign((slopes * others).sum(axis=1))[:, None]
    return largest(off, float(abs(slopes - sides * others).max() / abs(slopes).max()) / 1e-9)


def _mode_error(number: int, n: int) -> float:
    from verify.judge.workbench import Workbench

    beam, given = MENDED[number]
    error = Workbench(beam).frequency_error("segment", n, 2, tuple(given.items()))
    return error / (2.0 * pi / n) ** 4


def readings_error(count: float) -> float:
    """Of deflection and slope of mode 2 of mended chains over its turn^3, of curvatures over its turn^4.

    In parts of what walls leave of them: 0.2, 0.8 and 0.25. A body inside bends the beam on both sides of a joint.
    """
    from verify.exact.modes import mode_shape
    from verify.models.catalogue import MODELS

    n, worst = int(count), 0.0
    mu, shares = 2.0 * pi / n, np.linspace(0.03, 0.97, 17)
    for beam, given in MENDED:
        modes, theory = MODELS["segment"].solve_modes(beam, 2, n, **given), given.get("theory", "euler-bernoulli")
        x, middle = shares * beam.length, modes.curvature_points[1:-1]
        pairs = [(modes.shapes(x, d)[1], mode_shape(beam, 2, x, d, theory)) for d in range(2)]
        pairs += [(modes.curvatures()[1, 1:-1], mode_shape(beam, 2, middle, 2, theory))] if beam != HEAVY else []
        side = np.sign(pairs[0][0] @ pairs[0][1])
        for (found, exact), left in zip(pairs, (0.2 * mu**3, 0.8 * mu**3, 0.25 * mu**4), strict=False):
            worst = largest(worst, float(abs(side * found - exact).max() / abs(exact).max()) / left)
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="mended-chains",
        title="Mode 2 of eleven chains mended for tension, shear, turning, bodies and ends, each from both ends",
        why="segments/carried.py: order 4; a rule left out is order 3, 2 or 1, ten times as much at 20 links.",
        along="links",
        at=(20, 40),
        promise=1.0,
        error=mended_error,
    ),
    Floor(
        id="readings-of-mended-chains",
        title="Deflection, slope and curvature of mode 2 of these chains, over what their order leaves",
        why="segments/reading.py: order 4 inside and of curvatures, order 3 beside a clamp.",
        along="links",
        at=(20, 40),
        promise=1.0,
        error=readings_error,
    ),
)
