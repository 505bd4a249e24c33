"""The step of a slider's run: as long as it can be for what the start excites, and no longer."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array
from verify.motion.surface import Stage, cut, free_at

UNSEEN = 1e-4
"""Of the surface's speed, rms: what the steps of a run may miss of it."""
STICKY = 0.1
"""Of friction's own rate K mu N / m times a step: from there on a slider all but sticks to the beam it pushes back on.
"""
PLACES = 129
"""Along the beam, for the slope of a steady field."""


def speeds(stages: Sequence[Stage], z: Array, length: float) -> tuple[Array, Array, float]:
    """(omega, speed of the surface by every free mode, by the driven motion), (n,), (n,), but for a common factor.

    Means over the beam, the largest of all stages: omega |q| n pi / L, the slope of the nth mode being taken as
    n pi / L of its deflection, whose mean square over a beam of uniform mass is 1/mass.
    """
    free: Array = np.max([np.hypot(*start) for start in _starts(stages, z)], axis=0)
    omegas = stages[0].modal.omegas
    wavenumbers: Array = np.asarray(np.pi / length * np.arange(1.0, len(free) + 1.0), dtype=np.float64)
    return (
        omegas,
        np.asarray(omegas * free * wavenumbers),
        stages[-1].omega * _driven_slope(stages[-1], wavenumbers, length),
    )


def _driven_slope(stage: Stage, wavenumbers: Array, length: float) -> float:
    """Of the driven motion, as large as the amplitudes of modes times their wavenumbers."""
    if stage.forced is not None:
        return float(np.linalg.norm(stage.forced.amplitudes[:, 0] * wavenumbers))
    x = np.linspace(0.0, length, PLACES)
    first = np.sqrt((stage.free_shapes(x, 0)[0] ** 2).mean())
    return float(np.sqrt((stage.drive_shapes(x, 1)[:2] ** 2).sum(axis=0).mean()) / first)


def _starts(stages: Sequence[Stage], z: Array) -> Iterator[Array]:
    """The free modes at the start of every stage, (2, n) each."""
    yield z
    for before, stage in pairwise(stages):
        z = stage.start(*before.state(free_at(before, z, before.duration), before.duration))
        yield z


def missed(omegas: Array, free: Array, driven: float, dt: float) -> float:
    """Share of the surface's speed, rms, that steps of dt do not follow.

    A step sees its start, middle and end: the parabola through them misses (omega dt / 2)^4 / 180 of the mean of a
    cosine, and all of one that turns faster than that.
    """
    errors = np.minimum((0.5 * omegas * dt) ** 4 / 180.0, 1.0)
    total = np.hypot(driven, np.sqrt((free**2).sum()))
    return float(np.sqrt(((free * errors) ** 2).sum()) / total) if total else 0.0


def longest_step(stages: Sequence[Stage], z: Array, length: float, longest: float) -> float:
    """The longest of `longest`, its half, its quarter, ... that misses less than UNSEEN, seconds."""
    if not len(stages[0].modal.omegas):
        return longest
    found = speeds(stages, z, length)
    step = longest
    while missed(*found, step) > UNSEEN:
        step *= 0.5
    return step


def gripped_step(stages: Sequence[Stage], rate: float, longest: float) -> float:
    """The longest of `longest`, its half, ... in which a slider that pushes back may stick to the beam, seconds.

    `rate` is K mu N / m, endless for Coulomb's law. A stick matches speeds at the end of a step, which feeds modes that
    make more than half a turn in it, and friction gains energy; a soft grip does not.
    """
    step, omegas = longest, stages[0].modal.omegas
    fastest = float(omegas.max()) if len(omegas) else 0.0
    while fastest * step > np.pi and rate * step > STICKY:
        step *= 0.5
    return step


def stepped(stages: Sequence[Stage], step: float, closer: int = 1) -> list[Stage]:
    """The same stages in steps no longer than `step`, with the same samples, or so many times as many."""
    return [_cut(stage, step, closer) for stage in stages]


def _cut(stage: Stage, step: float, closer: int) -> Stage:
    steps = cut(stage.duration, step, closer * (stage.n_steps // stage.every))
    return replace(stage, n_steps=steps.n, dt=steps.dt, every=steps.every)
