"""What gives way along the surface under a slider held at a speed: whether it has slipped since it was put down.

A point that sticks takes all of the slider's way up in what gives way under it, until friction there lets go. At a
small speed that takes any number of periods, in which the mean friction grows so slowly that any two blocks agree. A
point that has slipped has forgotten how it was put down (play: M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with
Hysteresis, Springer 1989, ch. 2), so that a slider dragged until all slips comes to the same force, and at once.
"""

from math import copysign
from typing import TYPE_CHECKING

import numpy as np

from verify.models.arrays import Array
from verify.motor import records
from verify.motor.feet import Placed, feet_of
from verify.motor.settling import BALANCED, SMALL, Means

if TYPE_CHECKING:
    from verify.motor.result import MotorRun, MotorState
    from verify.slider import Slider

SOON = 8.0
"""Times as long as it would be dragged, in which a slider slips of itself before the means of its blocks agree."""
FURTHER = 4.0
"""Times as far as the softest point is stretched from one way to the other under all that presses, one is dragged."""


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
