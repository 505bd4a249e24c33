"""State of sliders, feet and contact points that the compiled contact engine reads and advances, SI throughout.

Record arrays by the names of their fields (`contacts[i].friction` in a kernel, `contacts["friction"]` in Python), and
named tuples of arrays. All are advanced in place.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from verify.arrays import Array

Record = Any  # A record of one of the types below; its fields are numbers
Records = NDArray[Any]
EVENTS = 12
"""Most changes of friction of a point in a step: of Coulomb's law with a linear acceleration there are at most four,
the others are left for roundings at rest."""
COULOMB, TANH, ELASTIC = range(3)  # Friction laws of a point, the numbers of the switch in `laws`
LAWS = {"coulomb": COULOMB, "tanh": TANH}
"""The law of a rigid point by `Slider.law`; a tangential spring is in series with either."""
PRESCRIBED, BILATERAL, SPRING = range(3)
"""Normal laws of all points: N = load; N = load + mass times the acceleration of the surface; springs and dashpots."""
SLIDES, HOLDS, LETS_GO = 0.0, 1.0, 2.0
"""`limit_state` of a point in the step: kinetic limit; static limit; kinetic one after the static one was exceeded."""
STICKS, SLIPS, TURNS, LANDS, LEAVES = 1.0, 2.0, 3.0, 4.0, 5.0  # Kinds of events, rows (time, kind, point, distance)


def record(*numbers: str, integers: str = "", rows: str = "") -> np.dtype[np.void]:
    """Type of a record of numbers, integers, and rows of EVENTS numbers, all by their names."""
    fields: list[tuple[str, type] | tuple[str, type, tuple[int]]] = [(name, np.int64) for name in integers.split()]
    fields += [(name, float) for names in numbers for name in names.split()]
    fields += [(name, float, (EVENTS,)) for name in rows.split()]
    return np.dtype(fields)


SLIDER = record(
    "x v inverse_mass mu mu_static steepness external_force free",
    "delta_v drift tilt",  # of the step
)
"""A slider: distance travelled and speed (state); 1/mass, 0 at a prescribed speed; kinetic and static coefficient of
friction; K of the tanh law, 0 for Coulomb's; external force along x, N; 0 at a fixed position, else 1. In the step:
gain of speed; of kinematics "following" the mean drift along x and the mean acceleration by the turning tangent and
gravity."""
FOOT = record(
    "height velocity_z pitch pitch_rate inverse_mass inverse_inertia load spring_rate",
    "delta_vz delta_pitch_rate",  # of the step
)
"""A foot: height, its rate, pitch, its rate (state); 1/mass across, 1/inertia (0: no pitch), force along z, N, and
stiffness of the preload spring, N/m. In the step: gains of the two rates."""
POINT = record(
    "offset arm stiffness dashpot tangential_stiffness face image inset weight load mass lever",
    integers="slider foot law",
)
"""A contact point, static: its slider, foot (0 without feet) and friction law; place from the first slider's x and from
the middle of the foot, m; normal stiffness, damping and tangential stiffness (0: rigid); +1 on the upper face, -1 on
the lower one; +1, or -1 on the mirror image of the beam; depth in the straight beam at foot height 0, m; 1/2 of a point
between two beams, else 1; normal load of a point without foot, N, and its mass across the beam, kg; half the thickness
h/2 times face times image, m."""
CONTACT = record(
    "normal friction sticks depth stretch point_vz surface surface_before loss",  # state
    "xi xi_point xi_end xi_point_end slope v_end vz slope_vz closing start mean end surface_delta_v",
    "depth_before sticks_before friction_before tilt_end drift_end",
    "slip self_response limit_state holds slip_by_law limit_sign stopping_gain least most power",
    integers="piece events",
    rows="event_share event_kind",
)
"""State of a contact point, zero at first except `depth` (below zero: gap) and, of bilateral contact, `point_vz`, the
speed of the point across the beam, m/s. `normal` and `friction` are means over the step, friction acts on the slider;
`sticks` is 1, or 0.5 from an event in the step; `stretch` is the elastic tangential displacement; `surface` is the mean
tangential speed of the surface over the step with all forces, `surface_before` extrapolates it; `loss` is the energy
that friction of a rigid point has dissipated so far.

Motion in the step: piece of the beam; material under the point (`xi`) and the point itself on the piece, in mid-step
and at the end; slope; speed of the point along at the end; mean rate of rise under it, share of it by slopes, rate at
which the gap closes; speed of the surface at the start, in the mean and at the end without contact forces, its gain;
values of the last step; acceleration and drift of "following" at the end without forces.

Friction in the step: mean slip v - s; own response; limit (SLIDES, HOLDS, LETS_GO); `holds` becomes `sticks`; relative
displacement over dt; 1 or -1 at a limit of the active sets; gain of speed that stops the point, bounds of its force and
dissipated power in `one_way`; events: number, share of the step and kind of each."""


class Bodies(NamedTuple):
    """Sliders, their feet and contact points, in the order of the sliders."""

    sliders: Records  # (sliders,), SLIDER
    feet: Records  # (feet,), FOOT; empty for points without feet
    points: Records  # (points,), POINT
    contacts: Records  # (points,), CONTACT


class Kind(NamedTuple):
    """What is common to all points of a run."""

    normal_law: int
    two_way: bool  # Whether the beam responds to friction
    normal_two_way: bool  # Whether it responds to normal forces as well
    several: bool  # Whether several points are coupled by the response of the beam
    following: bool  # Whether points follow the deflected surface (kinematics "following")
    gravity: float  # m/s^2 along the slope, with `following`


class Response(NamedTuple):
    """Response of the beam to contact forces that are constant over the step, and working space of the solver."""

    shapes: Array
    """(4, points, columns): tangential and normal speed at a point by the rates of the columns, then the mean rates of
    the columns by a unit force of either direction at it, times its weight."""
    rates: Array  # (columns,): what all contact forces add to the mean rates
    couplings: Array  # (2, points, points): speed across at the end of the step by unit friction and normal forces
    block: Array  # (points, points + 1), matrix and right side of the active sets


class Slip(NamedTuple):
    """Relative speed r = v - s of a point in a step without its own friction, which adds `compliance` times its force.

    In units of one step r' = compliance f - a, `a` linear from `first` to `last`.
    """

    start: float  # r at the start, m/s
    first: float  # Gain of the surface over the slider a at the start, m/s per step
    last: float  # The same at the end
    mean: float  # Mean of r, m/s
    sticking: float  # Mean of r at which a point sticks, m/s
    mobility: float  # dt/m of the slider
    compliance: float  # dt/m + 2 w, with the mean response w of the surface to a unit force
    dt: float
    several: bool  # Whether several points are coupled by the response of the beam
    own: bool  # Whether the surface responds to this point


class Path(NamedTuple):
    """Relative speed of a point that goes from `start` to `end` in the step, linear but for its own reversal."""

    start: float
    end: float
    mobility: float  # dt/m of the slider, which bends the line where the point's own force reverses
    end_weight: float  # Share of the force at the end of the step in the mean of a smooth law
    limit: float  # Largest friction, N, infinite for the law without its limit
    rounding: float  # Speed below which the point is at rest
    dt: float
