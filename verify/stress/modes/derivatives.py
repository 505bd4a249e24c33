"""Derivatives of fields and of turns, of every model, against differences of those before them."""

from collections.abc import Callable, Iterator

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import HarmonicField
from verify.options import Theory
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STEPPED, STRIP, held

FORCES = (PointForce(position=0.19), PointForce(position=0.58, amplitude=0.7, phase_deg=50.0))
HERTZ, THICK = 3700.0, 0.04
"""Of which waves on the thick strip are 0.3 m long, so that shear is felt."""
THEORIES: tuple[Theory, ...] = ("euler-bernoulli", "timoshenko")
ENDS = (("pinned", "pinned"), ("clamped", "free"), ("free", "free"))
ASIDE, STEP = (0.31, 0.77), 1e-4
"""Where in a part derivatives are looked at, and over what they are taken, of the part."""
Read = Callable[[Array, int], ComplexArray]


def _fields(n: int) -> Iterator[HarmonicField]:
    """Of a thick lossy strip on three pairs of supports and of a stepped thin one: elements, links, exact."""
    from verify.elements import linear as elements
    from verify.exact import harmonic
    from verify.segments import linear as segments

    for beam in (
        *(replace(held(*ends), thickness=THICK, loss_factor=0.02) for ends in ENDS),
        replace(STEPPED, loss_factor=0.01),
    ):
        for theory in THEORIES:
            yield elements.solve_harmonic(beam, FORCES, HERTZ, n, theory=theory)
            yield segments.solve_harmonic(beam, FORCES, HERTZ, n, theory=theory)
            yield harmonic.solve_harmonic(beam, FORCES, HERTZ, theory)


def _off(read: Read, x: Array, step: float, highest: int) -> float:
    """Of derivatives up to the highest at places (n,), metres, by differences over a step to both sides."""
    worst = 0.0
    for derivative in range(1, highest + 1):
        ahead, behind = (read(x + side * step, derivative - 1) for side in (1.0, -1.0))
        slopes, found = (ahead - behind) / (2.0 * step), read(x, derivative)
        worst = largest(worst, float(abs(found - slopes).max() / abs(found).max()))
    return worst


def derivatives_error(n: float) -> float:
    """Of deflections to their third derivative and of turns to their second, within the parts of every model."""
    parts = np.arange(n)[:, None] + np.array(ASIDE)
    x, step = STRIP.length / n * parts.ravel(), STEP * STRIP.length / n
    worst = 0.0
    for field in _fields(int(n)):
        worst = largest(worst, _off(field.shapes, x, step, 3))
        worst = largest(worst, _off(field.turns, x, step, 2))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="derivatives-of-fields",
        title="Derivatives of driven fields and of sections' turns, by every model and two theories, by differences",
        why="Within a part a field is a cubic or a sum of waves: a difference over 1e-4 of it is its slope.",
        along="parts",
        at=(17,),
        promise=1e-7,
        error=derivatives_error,
    ),
)
