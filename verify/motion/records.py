"""Arrays of the compiled loop of a slider on a given surface, by name. SI."""

from typing import NamedTuple

import numpy as np

from verify.arrays import Array

X, V, STUCK, HEIGHT, CLIMB, NORMAL, FALL, PUSHED, SWEPT, HARDEST = range(10)
"""Entries of `Rider.motion`: what the slider carries from step to step. Height and climb are those of a slider held on
the surface, its normal reaction is the mean over the step, the fall is the largest downward acceleration so far; so
far, too, what friction has added to its speed, the way of the surface under it, and the largest friction per mass."""
SURFACE, PULL, DRIFT, POWER, LOSS, LEVEL = range(6)
"""Columns of `Space.seen`."""
KEPT_X, KEPT_V, KEPT_FRICTION, KEPT_SURFACE, KEPT_NORMAL = range(5)
"""Columns of `Kept.kept`."""
STICKS, SLIPS, TURNS = 1.0, 2.0, 3.0
"""Kinds of events."""
STILL, MOVING = range(2)
"""Rows of polynomials: deflection and velocity."""
CHANGE, STICKING, GIVEN_MIDDLE, GIVEN_END, RELATIVE, N_EVENTS, FIRST_EVENT = range(7)
"""Entries of `Space.slip`: what friction adds to the speed, sticking at the end, what else adds by the middle and the
end, the way relative to the surface under Coulomb's law, how many events, and from FIRST_EVENT on their times within
the step and their kinds in turns."""
NOUGHT: int = np.int64(0)  # type: ignore[assignment]
AT_START: int = np.int64(0)  # type: ignore[assignment]
AT_END: int = np.int64(2)  # type: ignore[assignment]
"""A count, and rows of `Space.seen`, for calls: a number written out would have a copy of the kernel compiled."""
SPANS = 20
"""Of a step, between which friction changes its mind."""


class Law(NamedTuple):
    """How a slider rubs and what it weighs."""

    kinetic: float
    """mu N / m, m/s^2."""
    static: float | None
    """The same at rest, of Coulomb's law with true sticking; None: tanh, Eq. (3), and no other law is compiled."""
    slope: float | None
    """K of Eq. (3), s/m; None: Coulomb's law, and no other law is compiled."""
    mass: float
    half: float
    """Half the thickness: the lever of the surface about the mid-line, metres."""
    gravity: float
    following: bool
    """Whether the slider follows the surface across, with all that it feels there."""
    held: bool
    """Whether its inertia across acts on the surface."""
    load: float
    """Its weight and what else presses it on, newton."""


class Rider(NamedTuple):
    """The slider."""

    motion: Array
    """(10,), `X` and so on; advanced in place."""
    law: Law


class Space(NamedTuple):
    """Working space."""

    seen: Array
    """(3, 6): the surface at the start, the middle and the end of a step."""
    slip: Array
    """(47,), `CHANGE` and so on."""


class Given(NamedTuple):
    """A surface that is given at every half step of n, on one piece."""

    local: Array
    """(2 n + 1, 2, degree + 1), polynomials of deflection and velocity."""
    along: Array
    """(2 n + 1, 2), speed of the piece's ends along x, m/s; between them it changes evenly."""
    edges: Array
    """(2,), metres from where the slider started."""
