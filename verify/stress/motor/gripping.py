"""What gives way under a slider: how fast it swings, what of the way it takes up, by springs and shares by hand."""

from math import sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.motor.records import LEAVES
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

MASS, LIGHTEST, AT = 0.05, 0.004, 0.3
"""Of a slider and of its lighter foot, kg; where it stands, metres."""
FEET = (Foot(mass=0.006), Foot(offset=0.02, mass=LIGHTEST))
SLIDER = Slider(
    mass=MASS, mu=0.3, slope=9.0, gravity=0.0, preload=7.0, position=AT, foot=FEET, contact=Contact(stiffness=1e5)
)
ALONG, ACROSS, DAMPED = (
    {"tangential_stiffness": 3e5, "stiffness": 1e4},
    {"tangential_stiffness": 2e3, "stiffness": 4e5},
    {"tangential_stiffness": 2e3, "stiffness": 2.0, "damping": 70.0},
)
"""Contacts that swing fastest along, across, and that a dashpot holds."""


def rate_error(number: float) -> float:
    """Of the fastest rate that a contact on a rigid surface may have, of a slider on two feet of a point each.

    Along it both points hold all the mass; across each holds its own foot, by a spring or by a dashpot.
    """
    from verify.motor.feet import Placed
    from verify.motor.resting import contact_rate

    given = (ALONG, ACROSS, DAMPED)[int(number)]
    known = (
        sqrt(2.0 * given["tangential_stiffness"] / MASS),
        sqrt(given["stiffness"] / LIGHTEST),
        given.get("damping", 0.0) / LIGHTEST,
    )
    found = contact_rate(Placed(replace(SLIDER, contact=Contact(**given)), AT), None)
    return abs(found / known[int(number)] - 1.0) + float(largest(known) != known[int(number)])


UNLIKE = replace(
    SLIDER, foot=(Foot(mass=0.006, length=0.01, points=2), Foot(offset=0.03, mass=0.004, length=0.03, points=3))
)
"""Its points hold a layer along the surface by the length of their foot."""
LAYER = Contact(layer_stiffness=1e6, layer_tangential_stiffness=1e6)
SPEED, SECONDS = -0.02, 0.003
WAYS = (0.7e-5, -2.1e-5, 9e-5, -4e-6)
"""Metres that points of the feet are stretched by in that time, in turns: 6e-5 is all that the slider went."""


def way_error(left: float) -> float:
    """Of the share of a slider's way that is stretched, where one point, `left`, has meanwhile left the surface.

    Points count by their stiffness; none takes up more than the whole way, and which way it does so is all one.
    """
    from verify.motor.gripping import grips, taken_up
    from verify.motor.records import EVENT_KIND, EVENT_POINT, STRETCH, TOUCH

    slider = replace(UNLIKE, contact=LAYER)
    stiff = grips(slider)
    before, after, event = np.zeros((len(stiff), TOUCH)), np.zeros((len(stiff), TOUCH)), np.zeros((2, 4))
    before[:, STRETCH] = np.linspace(-3e-5, 2e-5, len(stiff))
    after[:, STRETCH] = before[:, STRETCH] + np.resize(WAYS, len(stiff))
    event[:, EVENT_KIND], event[:, EVENT_POINT] = (LEAVES, LEAVES + 1.0), (left, left + 1.0)
    run: Any = SimpleNamespace(state=SimpleNamespace(touch=after), duration=SECONDS, events=event)
    found = taken_up(slider, SPEED, SimpleNamespace(touch=before), run)  # type: ignore[arg-type]
    went, force, all_ = abs(SPEED) * SECONDS, 0.0, 0.0
    for i, k in enumerate(stiff):
        all_ += k
        force += 0.0 if i == left else k * min(abs(WAYS[i % len(WAYS)]), went) / went
    still = taken_up(slider, 0.0, SimpleNamespace(touch=before), run)  # type: ignore[arg-type]
    return float(abs(found * all_ / force - 1.0) + still + float(np.ptp(stiff) == 0.0))


def told_error(share: float) -> float:
    """0 where what is still to come is told beside spreads just below it, and widens them; 1 where it is not.

    Of a full force of mu N a share is to come; where the normal force swings, more way does not help.
    """
    from verify.motor.gripping import creeps, widened
    from verify.motor.settling import BALANCED, Means

    presses = 5.0
    lacks, swings = share * SLIDER.mu * presses, BALANCED * presses

    def said(force: float, swing: float) -> bool:
        return creeps(Means(force, swing, 0.1, 0.2, 0.3, 0.4), share, SLIDER, presses)

    told = [said(0.999 * lacks, 0.999 * swings), not said(1.001 * lacks, 0.0), not said(0.0, 1.001 * swings)]
    small = Means(1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9)
    wide, large = widened(small, share, 0.9, SPEED), Means(9.0, 9.0, 9.0, 9.0, 9.0, 9.0)
    off = np.subtract(wide, (0.9 * share, 2e-9, 3e-9, share, 5e-9, 0.9 * share * abs(SPEED)))
    return float(not all(told)) + float(abs(off).max() / share) + float(widened(large, share, 0.9, SPEED) != large)


ROWS: tuple[Row, ...] = (
    Floor(
        id="rates-of-a-contact",
        title="The fastest rate of a contact that swings along, across, or is damped, against springs and masses",
        why="motor/resting.py: roots of stiffness over mass, dashpot over mass; roundings.",
        along="contact",
        at=(0.0, 1.0, 2.0),
        promise=1e-14,
        error=rate_error,
    ),
    Floor(
        id="ways-taken-up",
        title="The share of a slider's way that stretches unlike points, one of which leaves the surface",
        why="motor/gripping.py: sums by stiffness; roundings.",
        along="point that leaves",
        at=(0.0, 2.0, 3.0),
        promise=1e-13,
        error=way_error,
    ),
    Floor(
        id="forces-still-to-come",
        title="What friction lacks while a slider creeps: told where it is more than spreads, and added to them",
        why="motor/gripping.py: share of mu N, of friction and of its power; roundings.",
        along="share of the way",
        at=(0.013, 0.4),
        promise=1e-13,
        error=told_error,
    ),
)
