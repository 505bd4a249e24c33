"""What the compiled loop of a slider on a moving surface sees, by name. SI; frozen but for the arrays in it.

The surface is a set of rows: row j has a deflection shape, on every piece of the beam a polynomial in the local
coordinate xi in [0, 1], and a time factor q_j(t). Rows 0..n-1 are modes that vibrate freely, q = Re z with
z' = (-sigma + i omega) z, which a rotation advances exactly by any step. The rest belong to the drive: real and
imaginary part of (t/T)^d e^{i omega t}.
"""

from typing import NamedTuple

import numpy as np

from verify.arrays import Array, Indices

X, V, STUCK, HEIGHT, CLIMB, NORMAL, FALL, PUSHED, SWEPT, HARDEST = range(10)
"""Entries of `Rider.motion`: what the slider carries from step to step. Height and climb are those of a slider held on
the surface, its normal reaction is the mean over the step, the fall is the largest downward acceleration so far; so
far, too, what friction has added to its speed, the way of the surface under it, and the largest friction per mass."""
SURFACE, PULL, DRIFT, POWER, LOSS, LEVEL = range(6)
"""Columns of `Space.seen`."""
ON_BEAM, ON_SLIDER, DRIVEN, DAMPED, RUBBED, LIFTED, TURNED = range(7)
"""Entries of `Books.ledger`, joules; LIFTED is the work of the normal reaction on the beam, TURNED what a slider that
follows the surface has of its turning and of gravity along it."""
STEP, SAMPLES, EVENTS = range(3)
"""Entries of `Kept.tally`: steps of this stage, samples and events of the whole run."""
KEPT_X, KEPT_V, KEPT_FRICTION, KEPT_SURFACE, KEPT_NORMAL = range(5)
"""Columns of `Kept.kept`."""
DONE, OFF_PIECES, NOT_FINITE = range(3)
"""Why the loop came back."""
STICKS, SLIPS, TURNS = 1.0, 2.0, 3.0
"""Kinds of events."""
Z_RE, Z_IM, SIGMA, OMEGA, HALF_RE, HALF_IM, FULL_RE, FULL_IM, LEVER, LIFT, READ = range(11)
"""Rows of `Surface.modes`: the state z, its decay and frequency, its turns over half a step and a whole one, levers of
a tangential force and of a normal one in mid-step, deflection under the slider at the end."""
STILL, MOVING, BEFORE = range(3)
"""Rows of `Space.factors` (two) and of `Space.local`: deflection, velocity, deflection a step before."""
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


class Drive(NamedTuple):
    """The time factors of the drive's rows."""

    omega: float
    origin: float
    """Seconds that had passed when the stage began."""
    unit: float
    """Seconds: of the powers of time."""
    growth: Array
    """(degree + 1,): the forces' amplitude as a polynomial in t / unit."""


class Surface(NamedTuple):
    """One stage's beam on the pieces around the slider."""

    modes: Array
    """(11, n), `Z_RE` and so on; advanced in place."""
    drive: Drive
    table: Array
    """(pieces, degree + 1, rows), polynomials of deflection."""
    edges: Array
    """(pieces + 1,), metres from where the slider started."""


class Rider(NamedTuple):
    """The slider."""

    motion: Array
    """(10,), `X` and so on; advanced in place."""
    law: Law
    two_way: bool | None
    """True where the beam feels it; None: it does not, and nothing of that is compiled."""


class Books(NamedTuple):
    """What the powers of drive and damping are read from, and the work that they add up to."""

    open: bool
    """Whether they are kept."""
    loads: Array
    """(n_forces, rows)."""
    forces: Array
    """(2, n_forces), real and imaginary part of the forces' amplitudes."""
    answers: Array
    """(n, drive rows), the forced part of every mode."""
    ledger: Array
    """(6,), `ON_BEAM` and so on; advanced in place."""


class Kept(NamedTuple):
    """What is written down on the way."""

    every: int
    """Steps from sample to sample."""
    kept: Array
    """(samples, 5), `KEPT_X` and so on: distance travelled, v, friction per mass, speed of the surface, normal
    reaction on the slider."""
    points: Array
    """(n_points, rows), where the deflection is kept."""
    deflections: Array
    """(samples, n_points)."""
    events: Array
    """(capacity, 3): time, kind, x at the end of the step."""
    tally: Indices
    """(3,), `STEP` and so on; advanced in place."""


class Space(NamedTuple):
    """Working space."""

    factors: Array
    """(2, rows)."""
    local: Array
    """(3, degree + 1): polynomials of deflection and velocity on the slider's piece."""
    seen: Array
    """(3, 6): the surface at the start, the middle and the end of a step."""
    slip: Array
    """(47,), `CHANGE` and so on."""


class Here(NamedTuple):
    """The material under the slider in mid-step."""

    piece: int
    at: float
    """On the piece, 0 to 1."""
    above: float
    """Where the slider itself is, on the piece: the material is (h/2) w' beyond."""
    slope: float
    """w'."""


class Given(NamedTuple):
    """A surface that is given at every half step of n, on one piece."""

    local: Array
    """(2 n + 1, 2, degree + 1), polynomials of deflection and velocity."""
    along: Array
    """(2 n + 1, 2), speed of the piece's ends along x, m/s; between them it changes evenly."""
    edges: Array
    """(2,), metres from where the slider started."""
