"""Whether means of a slider held at a speed have settled: they agree, and momentum across the beam balances.

What presses a foot on, less its mean normal force, is the change of its momentum across over the time of the mean, in
every run: where the slider is in flight all that time no normal force at all is seen, and any two such means agree.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from verify.models.arrays import Array
from verify.motor import records

if TYPE_CHECKING:
    from verify.motor.result import MotorRun, MotorState
    from verify.slider import Slider

BLOCK = 12
"""Periods between two looks at whether the means have settled."""
SETTLED = 1e-4
"""Of mu times the normal force: as much as the friction of two blocks may differ where a motion repeats itself."""
BALANCED = 3e-3
"""Of what presses on: as much as the normal force of such a block may miss of it."""
SMALL = 1e-2
"""Of a figure's full scale: a spread that lets the figure stand."""
PARTS = 16
"""Of a window, whose means tell the spread of its own."""


class Means(NamedTuple):
    """Of what is read at a speed, or their spreads: newton, shares, watt."""

    force: float
    normal_force: float
    contact_share: float
    stuck_share: float
    given: float
    rubbed: float


def rows(run: "MotorRun") -> Array:
    """(n, 6), what `Means` names over each interval of a run."""
    steps = np.diff(run.times)
    columns = (
        run.friction[1:],
        run.normal_force[1:],
        run.contact_share[1:],
        run.stuck_share[1:],
        run.carried[1:] / steps,
        run.rubbed[1:] / steps,
    )
    return np.stack(columns, axis=1)


def means_of(run: "MotorRun") -> Means:
    """Over all its periods."""
    return Means(*map(float, rows(run).mean(axis=0)))


def missed(slider: "Slider", before: "MotorState", run: "MotorRun") -> float:
    """By how much the normal force of a run misses what presses on, newton: of all feet, whichever way."""
    masses = np.array([slider.moved_by(foot) for foot in slider.feet])
    gained = run.state.feet[:, records.CLIMB] - before.feet[:, records.CLIMB]
    return float(np.abs(masses * gained).sum()) / run.duration


def told_by_balance(slider: "Slider") -> bool:
    """Whether what presses on is a constant: no spring presses, and no second beam."""
    return not slider.preload_stiffness and not any(foot.mirrored for foot in slider.feet)


def apart(means: Means, other: Means, off: float, balance: bool) -> Means:
    """How far the means of two blocks lie apart; `off` and `balance` as for `spread_of`."""
    found = Means(*(abs(one - another) for one, another in zip(means, other, strict=True)))
    return found._replace(normal_force=off if balance else max(found.normal_force, off))


def spread_of(found: Array, off: float, balance: bool) -> Means:
    """How far means over a window, (n, 6) by periods, may be off, from its parts: twice their standard error.

    With `balance` the mean of the normal force is off by what it misses, `off` in newton, and by nothing else; each
    other figure by its share in that, and by what is left of its own once the normal force of every part is taken out.
    """
    cells = found[: len(found) // PARTS * PARTS].reshape(PARTS, -1, found.shape[1]).mean(axis=1)
    if not balance:
        plain = Means(*map(float, _of_parts(cells)))
        return plain._replace(normal_force=max(plain.normal_force, off))
    pushes = cells[:, 1] - cells[:, 1].mean()
    size = float(pushes @ pushes)
    slopes = pushes @ cells / size if size > 0.0 else np.zeros(cells.shape[1])
    own = np.asarray(_of_parts(cells - np.outer(pushes, slopes)) + np.abs(slopes) * off)
    return Means(*map(float, own))._replace(normal_force=off)


def _of_parts(cells: Array) -> Array:
    """(6,), twice the standard error of means of parts, or the difference of their halves where that is more."""
    error = 2.0 * cells.std(axis=0, ddof=1) / np.sqrt(len(cells))
    half = len(cells) // 2
    return np.asarray(np.maximum(error, np.abs(cells[:half].mean(axis=0) - cells[half:].mean(axis=0))))
