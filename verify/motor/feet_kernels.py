"""The compiled feet: what their points see of the surface, how they press on it, what it gives them in a step."""

from verify.models.arrays import Array
from verify.jit import inline
from verify.motor.records import (
    ABOVE,
    ACROSS,
    ANSWER,
    ARM,
    AT,
    CLIMB,
    CLOSING,
    DAMPED,
    DASHPOT,
    DEPTH,
    FACE,
    FOOT_INVERSE_INERTIA,
    FOOT_INVERSE_MASS,
    FREE,
    HEIGHT,
    IMAGE,
    INSET,
    LIFT,
    LIFTED,
    OFFSET,
    PITCH,
    PRESS,
    PRESSED,
    PUSH,
    PUSH_BEFORE,
    RAMP,
    SLOPE,
    SPRING,
    STIFF,
    STORED,
    SURFACE,
    SURFACE_BEFORE,
    TURN,
    UPHILL,
    Feet,
    Line,
    V,
    X,
)
from verify.motor.surface_kernels import material


@inline
def drift(t: float, feet: Feet) -> None:
    """Sliders and feet move on with their speeds."""
    body, state = feet.body, feet.state
    for b in range(body.shape[0]):
        body[b, X] += t * body[b, V] * feet.riders[b, FREE]
    for f in range(state.shape[0]):
        state[f, HEIGHT] += t * state[f, CLIMB]
        state[f, PITCH] += t * state[f, TURN]


@inline
def see(i: int, x: float, edge: float, length: float, v: float, half: float, line: Line, feet: Feet) -> None:
    """What point i sees of the surface under x, of its material there: speed along, height and rate, slope.

    `edge` and `length` are those of its piece, `v` is how fast its place goes along.
    """
    touch, state, foot = feet.touch, feet.state, feet.foot[i]
    image, face, arm, inset = feet.points[i, IMAGE], feet.points[i, FACE], feet.points[i, ARM], feet.points[i, INSET]
    lever = half * face * image
    above = (x - edge) / length
    at, level, slope, bend, rise, turn, along = material(feet.piece[i], above, length, lever, line)
    lift = image * (rise + slope * (v + lever * (turn + bend * v)))
    touch[i, RAMP] = image * slope * (v + lever * bend * v)
    touch[i, SURFACE_BEFORE], touch[i, SURFACE], touch[i, PUSH_BEFORE] = touch[i, SURFACE], along, touch[i, PUSH]
    touch[i, AT], touch[i, ABOVE], touch[i, SLOPE], touch[i, ANSWER], touch[i, LIFT] = at, above, slope, 0.0, lift
    touch[i, DEPTH] = inset + face * (image * level - state[foot, HEIGHT] - arm * state[foot, PITCH])
    touch[i, CLOSING] = face * (lift - state[foot, CLIMB] - arm * state[foot, TURN])


@inline
def press(dt: float, feet: Feet, before: Array) -> bool:
    """Normal forces in mid-step and what they give to the feet; whether any point has a dashpot.

    `before` is (points, 2), depth at the last mid-step.

    Dashpots see the mean speed of the step: twice more, with half of what the force before has given.
    """
    _fall_free(dt, feet)
    damped = _push(feet, before)
    for _ in range(2 if damped else 0):
        _gather(dt, feet)
        _push(feet, before)
    _gather(dt, feet)
    return damped


@inline
def _fall_free(dt: float, feet: Feet) -> None:
    """What presses the feet, given for the step."""
    given = feet.given
    for f in range(feet.state.shape[0]):
        force = given[f, PRESS] - given[f, SPRING] * feet.state[f, HEIGHT]
        feet.kick[f, 0] = dt * given[f, FOOT_INVERSE_MASS] * force
        feet.kick[f, 1] = 0.0


@inline
def _push(feet: Feet, before: Array) -> bool:
    """Normal force of every point at its depth and mean speed; whether any has a dashpot.

    That of a dashpot jumps where a point lands: it counts from there on to the end of the step.
    """
    touch, points, damped = feet.touch, feet.points, False
    for i in range(points.shape[0]):
        depth, force = touch[i, DEPTH], 0.0
        if depth > 0.0:
            force = points[i, STIFF] * depth
            if points[i, DASHPOT] > 0.0:
                foot, damped = feet.foot[i], True
                given = points[i, FACE] * (feet.kick[foot, 0] + points[i, ARM] * feet.kick[foot, 1])
                share = 0.5 + depth / (depth - before[i, 0]) if before[i, 0] <= 0.0 else 1.0
                force += share * points[i, DASHPOT] * (touch[i, CLOSING] - 0.5 * given)
            force = force if force > 0.0 else 0.0
        touch[i, PUSH] = force
    return damped


@inline
def _gather(dt: float, feet: Feet) -> None:
    """Give the normal forces to the feet."""
    _fall_free(dt, feet)
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, PUSH]
        if force > 0.0:
            foot, way = feet.foot[i], dt * points[i, FACE] * force
            feet.kick[foot, 0] += way * feet.given[foot, FOOT_INVERSE_MASS]
            feet.kick[foot, 1] += way * points[i, ARM] * feet.given[foot, FOOT_INVERSE_INERTIA]


@inline
def kick(dt: float, feet: Feet) -> None:
    """The feet take what the step gives them; its works."""
    state, sums, touch, points = feet.state, feet.sums, feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, PUSH]
        if touch[i, DEPTH] > 0.0:
            foot, b = feet.foot[i], feet.owner[i]
            given = feet.kick[foot, 0] + points[i, ARM] * feet.kick[foot, 1]
            closing = touch[i, CLOSING] - 0.5 * points[i, FACE] * given
            uphill = dt * force * points[i, FACE] * touch[i, RAMP]
            work = dt * force * points[i, FACE] * touch[i, LIFT] - uphill
            sums[b, ACROSS] += work
            sums[b, UPHILL] += uphill
            sums[b, DAMPED] += dt * (force - points[i, STIFF] * touch[i, DEPTH]) * closing
            sums[b, LIFTED] -= work
    for f in range(state.shape[0]):
        given = feet.given
        force = given[f, PRESS] - given[f, SPRING] * state[f, HEIGHT]
        sums[feet.keeper[f], PRESSED] += dt * force * (state[f, CLIMB] + 0.5 * feet.kick[f, 0])
        state[f, CLIMB] += feet.kick[f, 0]
        state[f, TURN] += feet.kick[f, 1]


@inline
def stored(dt: float, feet: Feet) -> None:
    """Energy in the springs at the end of a step, at the depths of its middle drawn on."""
    state = feet.state
    for b in range(feet.sums.shape[0]):
        feet.sums[b, STORED] = 0.0
    for i in range(feet.points.shape[0]):
        foot = feet.foot[i]
        climb = state[foot, CLIMB] + feet.points[i, ARM] * state[foot, TURN]
        depth = feet.touch[i, DEPTH] + 0.5 * dt * feet.points[i, FACE] * (feet.touch[i, LIFT] - climb)
        if depth > 0.0:
            feet.sums[feet.owner[i], STORED] += 0.5 * feet.points[i, STIFF] * depth * depth


@inline
def gone(i: int, feet: Feet) -> float:
    """How fast the place of point i goes along the beam, m/s: with its slider, unless that is kept where it is."""
    return float(feet.body[feet.owner[i], V] * feet.riders[feet.owner[i], FREE])


@inline
def place(i: int, feet: Feet) -> float:
    """Where point i stands, metres from where the slider started."""
    return float(feet.body[feet.owner[i], X] + feet.points[i, OFFSET])
