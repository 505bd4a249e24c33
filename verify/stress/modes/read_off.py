"""What is read off fields and shapes: derivatives, places in any arrangement, fields of a sweep, zeros."""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.models.arrays import Array, ComplexArray
from verify.models.catalogue import MODELS
from verify.models.fields import HarmonicField
from verify.models.kind import Model
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


SPREAD = np.array([[0.02, 0.31, 0.47], [0.64, 0.65, 0.73]])
"""Metres, in rows."""


def arranged_error(n: float) -> float:
    """Of fields and modes of every model read at places in rows and at one, against the same places in one row.

    Likewise of sweeps of two frequencies and of one, against fields: by two theories, as these take other ways.
    """
    forces, beam = FORCES[:1], replace(STRIP, loss_factor=0.02)
    pairs = list[tuple[Any, Any]]()
    for model, theory in product(MODELS.built_in, THEORIES):
        own = MODELS[model]
        sized: int | None = int(n) if own.sized else None
        field = own.solve_harmonic(beam, forces, HERTZ, sized, theory=theory)
        modes = own.solve_modes(beam, 3, int(n), theory=theory)
        lines = (field.deflection, field.slope, field.turn, modes.deflection, modes.slope)
        for read in lines:
            flat = np.asarray(read(SPREAD.ravel()))
            pairs.append((np.asarray(read(SPREAD)), flat.reshape(flat.shape[:-1] + SPREAD.shape)))
            pairs.append((np.asarray(read(float(SPREAD[1, 0]))), flat[..., 3:4]))
        for hertz in ((HERTZ,), (0.7 * HERTZ, HERTZ)):
            for verb in (own.sweep_harmonic, partial(Model.sweep_harmonic, own)):
                sweep = verb(beam, forces, np.array(hertz), sized, theory=theory)
                pairs.append((sweep.deflection(SPREAD)[-1], field.deflection(SPREAD)))
                pairs.append((sweep.field(-1).turn(SPREAD.ravel()), field.turn(SPREAD.ravel())))
    wrong = sum(one.shape != other.shape for one, other in pairs)
    off = [abs(one.ravel() - other.ravel()).max() / abs(other).max() for one, other in pairs if one.size == other.size]
    return float(np.max(off) + wrong)


def zeros_error(mode: float) -> float:
    """Of places between pins where a mode's shape is zero, over the beam, evenly spaced."""
    from verify.exact.modes import mode_shape
    from verify.judge.compare import zeros

    number = int(mode)
    found = zeros(lambda x: mode_shape(STRIP, number, x), STRIP.length, number) / STRIP.length
    exact = np.arange(1, number) / number
    return float(abs(found - exact).max()) if len(found) == len(exact) else 1.0


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
    Floor(
        id="places-in-any-arrangement",
        title="Fields, modes and sweeps at places in rows, in one row and at one, by every model and two theories",
        why="models/places.py, models/sweeps.py: how places are written changes no digit but a sweep's rounding.",
        along="parts",
        at=(12,),
        promise=1e-12,
        error=arranged_error,
    ),
    Floor(
        id="zeros-of-shapes",
        title="Where shapes between pins are zero, low and high",
        why="judge/compare.py: a mode has 40 places for each of its half waves, none of which is passed over.",
        along="mode",
        at=(5, 67),
        promise=1e-12,
        error=zeros_error,
    ),
)
