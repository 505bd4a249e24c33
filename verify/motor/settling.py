"""Convergence of the means of a slider held at a speed: agreement, momentum across, presliding.

The preload less the mean normal force is the change of momentum across over the time of the mean, in every run: while
the slider is in flight no normal force is seen, and any two such means agree.

A point with tangential stiffness takes up the slider's displacement until it slips. At a small speed that takes any
number of periods, in which the mean friction grows so slowly that any two blocks agree. A point that has slipped has
forgotten its start (play operator: M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with Hysteresis, Springer 1989,
ch. 2), so that a slider dragged until all points slip comes to the same force at once.
"""

from math import copysign
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from verify.arrays import Array
from verify.motor import records
from verify.motor.feet import Placed, feet_of

if TYPE_CHECKING:
    from verify.motor.result import MotorRun, MotorState
    from verify.problem.slider import Slider

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
SOON = 8.0
"""Times as long as it would be dragged, in which a slider slips of itself before the means of its blocks agree."""
FURTHER = 4.0
"""Times as far as the softest point is stretched from one way to the other under all that presses, one is dragged."""


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


def grips(slider: "Slider") -> Array:
    """Stiffness of every point along the surface, (points,), N/m; none where nothing gives way."""
    contact = slider.contact
    if contact is None or not any(contact.along(foot.length) for foot in slider.feet):
        return np.zeros(0)
    return feet_of((Placed(slider, 0.0),)).points[:, records.GRIP]


def dragged_at(slider: "Slider", speed: float, seconds: float) -> float | None:
    """The speed, m/s, at which a slider is dragged for so long before it is held at `speed`; None where it need not be.

    It need where it takes its softest point long to go from full stretch one way, under a like share of what presses,
    to full stretch the other.
    """
    grip = grips(slider)
    if not speed or not grip.any():
        return None
    most = 2.0 * slider.mu * slider.normal_force / float(grip.min())
    soon = SOON * abs(speed) * seconds >= most / len(grip)
    return None if soon else copysign(FURTHER * most / seconds, speed)


def taken_up(slider: "Slider", speed: float, before: "MotorState", run: "MotorRun") -> float:
    """Share of a slider's way over a run at a speed, m/s, that went into stretching what gives way: 1 where all sticks.

    By stiffness; points that left the surface meanwhile have let go.
    """
    grip = grips(slider)
    if not speed or not grip.any():
        return 0.0
    stretched = np.abs(run.state.touch[:, records.STRETCH] - before.touch[:, records.STRETCH])
    shares = np.minimum(stretched / (abs(speed) * run.duration), 1.0)
    left = run.events[run.events[:, records.EVENT_KIND] == records.LEAVES, records.EVENT_POINT]
    shares[left.astype(int)] = 0.0
    return float(grip @ shares / grip.sum())


def creeps(spreads: Means, share: float, slider: "Slider", presses: float) -> bool:
    """Whether spreads of means, before they are widened, are less than what is still to come, and that is felt.

    Nothing else may be under way: where the contact swings, more way does not settle it.
    """
    felt = share > SMALL and share * slider.mu * presses >= spreads.force
    return felt and spreads.normal_force <= BALANCED * presses


def widened(spreads: Means, share: float, friction: float, speed: float) -> Means:
    """Spreads of means no less than what is still to come where so much of the way is still taken up.

    Stretched from nought at K v, friction comes to F as 1 - e^{-K v t / F}: what it lacks is F times that share.
    """
    return spreads._replace(
        force=max(spreads.force, share * friction),
        stuck_share=max(spreads.stuck_share, share),
        rubbed=max(spreads.rubbed, share * friction * abs(speed)),
    )
