"""What the compiled loop of a slider on feet sees, by name. SI; frozen but for the arrays in it.

A stage carries any number of feet, each with a height and a pitch of its own; every foot has points, which press on the
surface under them and leave it. A point's face is +1 on the upper face of the beam, -1 on the lower one; a mirrored
point touches the mirror image of the beam, above it.
"""

from typing import NamedTuple

from verify.arrays import Array, Indices

X, V = range(2)
"""Columns of `Feet.body`: distance travelled, speed."""
MU, INVERSE_MASS, PULL, FREE = range(4)
"""Columns of `Feet.riders`: coefficient of friction; 1/mass, 0 where the speed is held; newton along x; 0 where the
slider stays at its place, whatever its speed, otherwise 1."""
MEAN, AFTER, HELD = range(3)
"""Columns of `Feet.means`: speed in the middle of the step and at its end, friction of what gives way."""
HEIGHT, CLIMB, PITCH, TURN = range(4)
"""Columns of `Feet.state`."""
FOOT_INVERSE_MASS, FOOT_INVERSE_INERTIA, PRESS, SPRING = range(4)
"""Columns of `Feet.given`: 1/mass, 1/inertia (0: it does not pitch), force along z, stiffness of what presses."""
OFFSET, ARM, STIFF, DASHPOT, GRIP, FACE, IMAGE, INSET, WEIGHT = range(9)
"""Columns of `Feet.points`: place from the stage's x and from the middle of its foot, metres; stiffness, damping and
stiffness along the surface; on which face, +1 or -1, and of which beam, +1 or -1 for the mirror image; how deep it
sits in the straight beam at height 0, metres; 1/2 of a point between two beams, which stand for each other, else 1."""
TOUCH = 19
"""Columns of `Feet.touch`, each named:"""
(
    PUSH, RUB, SURFACE, SURFACE_BEFORE, DEPTH, STRETCH, AT, SLOPE, CLOSING, LIFT, STUCK, ANSWER, ABOVE, RAMP,
    PUSH_BEFORE, MOST, GAINED, AHEAD, BEYOND,
) = range(TOUCH)  # fmt: skip
"""Normal force, friction on the stage, speed of the surface, now and a step before; how
deep it is pressed in (below 0: the gap), how far it is stretched along; where on its piece the material under it lies,
its slope; how fast the gap closes, how fast the surface rises, both without the foot's own kick; whether it sticks;
what the step's forces give the beam of that closing; where on the piece the point itself is; how much of that rise is
a slope that the slider goes along; normal force a step before; what Coulomb's friction can do there, what the surface
gains in speed in a step (two-way, what the forces of the step have given it by its middle), by how much it is faster
than the slider at an instant within it; power of friction on that beyond what the means of the step say."""
SUMS = 13
(
    ACROSS, ALONG, PULLED, RUBBED, DAMPED, PRESSED, MEAN_RUB, MEAN_PUSH, TOUCHING, STICKING, STORED, LIFTED, UPHILL,
) = range(SUMS)  # fmt: skip
"""Columns of `Feet.sums`: work of the surface across on the feet, along on the stage, of the pull and of what holds
a speed, rubbed away, lost in dashpots, of what presses; integrals over time of friction, normal force, share of points
that touch and stick; energy in the springs now; work of the feet on the beam, and of the slopes
that a slider goes along on the feet."""
KEPT_X, KEPT_V, KEPT_RUB, KEPT_PUSH, KEPT_TOUCHING, KEPT_STICKING, KEPT_RUBBED, KEPT_ALONG, KEPT_SURFACE = range(9)
"""Columns of `Log.kept`; friction, normal force, shares, works and the surface's speed under what touches are means, or
sums, over the interval that ends there."""
STEP, SAMPLES, EVENTS = range(3)
"""Entries of `Log.tally`."""
DONE, OFF_BEAM, NOT_FINITE, CHATTERS = range(4)
"""Why the loop came back."""
STICKS, SLIPS, LANDS, LEAVES = 1.0, 2.0, 4.0, 5.0
"""Kinds of events."""
EVENT_TIME, EVENT_KIND, EVENT_POINT, EVENT_X = range(4)
"""Columns of `Log.events`."""


class Rubbing(NamedTuple):
    """Friction's law, of all sliders."""

    slope: float | None
    """K of Eq. (3), s/m; None: Coulomb's law, and no other law is compiled."""
    half: float
    """Half the thickness, metres."""


class Feet(NamedTuple):
    """Sliders, their feet and points; advanced in place."""

    body: Array
    """(sliders, 2)"""
    riders: Array
    """(sliders, 4)"""
    means: Array
    """(sliders, 3)"""
    state: Array
    """(feet, 4)"""
    given: Array
    """(feet, 4)"""
    points: Array
    """(points, 9)"""
    touch: Array
    """(points, TOUCH)"""
    foot: Indices
    """(points,), the foot of each."""
    owner: Indices
    """(points,), the slider of each."""
    first: Indices
    """(sliders + 1,), where the points of each slider begin, and how many there are."""
    keeper: Indices
    """(feet,), the slider of each."""
    piece: Indices
    """(points,), the piece of the beam under each."""
    kick: Array
    """(feet, 2), what the step gives to height and pitch, m/s and 1/s."""
    sums: Array
    """(sliders, SUMS)"""


class Line(NamedTuple):
    """The surface in mid-step, on every piece that a point stands on."""

    local: Array
    """(pieces, 2, degree + 1), polynomials of deflection and velocity."""
    stamp: Indices
    """(pieces,), the step for which they were made."""


class GivenSurface(NamedTuple):
    """A surface that is given in the middle of every step."""

    local: Array
    """(n, pieces, 2, degree + 1), polynomials of deflection and velocity."""
    along: Array
    """(n, pieces + 1), speed of the edges along x, m/s; between them it changes evenly."""


class Log(NamedTuple):
    """What is written down on the way."""

    every: int
    kept: Array
    """(samples, sliders, 9)"""
    heights: Array
    """(samples, feet, 2), height and pitch."""
    pressures: Array
    """(samples, points), normal force in the middle of the step before."""
    events: Array
    """(capacity, 4)"""
    tally: Indices
    """(3,)"""
    before: Array
    """(sliders, SUMS), the sums at the last sample."""
