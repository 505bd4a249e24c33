"""The compiled feet: what their points see of the surface, how they press on it, what it gives them in a step."""

from verify.jit import inline
from verify.models.arrays import Array
from verify.motor import records as rec
from verify.motor.records import Feet, Line
from verify.motor.surface_kernels import material


@inline
def drift(t: float, feet: Feet) -> None:
    """Sliders and feet move on with their speeds."""
    body, state = feet.body, feet.state
    for b in range(body.shape[0]):
        body[b, rec.X] += t * body[b, rec.V] * feet.riders[b, rec.FREE]
    for f in range(state.shape[0]):
        state[f, rec.HEIGHT] += t * state[f, rec.CLIMB]
        state[f, rec.PITCH] += t * state[f, rec.TURN]


@inline
def see(i: int, x: float, edge: float, length: float, v: float, half: float, line: Line, feet: Feet) -> None:
    """What point i sees of the surface under x, of its material there: speed along, height and rate, slope.

    `edge` and `length` are those of its piece, `v` is how fast its place goes along.
    """
    touch, state, foot = feet.touch, feet.state, feet.foot[i]
    image, face, arm, inset = (
        feet.points[i, rec.IMAGE],
        feet.points[i, rec.FACE],
        feet.points[i, rec.ARM],
        feet.points[i, rec.INSET],
    )
    lever = half * face * image
    above = (x - edge) / length
    at, level, slope, bend, rise, turn, along = material(feet.piece[i], above, length, lever, line)
    lift = image * (rise + slope * (v + lever * (turn + bend * v)))
    touch[i, rec.RAMP] = image * slope * (v + lever * bend * v)
    touch[i, rec.SURFACE_BEFORE], touch[i, rec.SURFACE], touch[i, rec.PUSH_BEFORE] = (
        touch[i, rec.SURFACE],
        along,
        touch[i, rec.PUSH],
    )
    touch[i, rec.AT], touch[i, rec.ABOVE], touch[i, rec.SLOPE], touch[i, rec.ANSWER], touch[i, rec.LIFT] = (
        at,
        above,
        slope,
        0.0,
        lift,
    )
    touch[i, rec.DEPTH] = inset + face * (image * level - state[foot, rec.HEIGHT] - arm * state[foot, rec.PITCH])
    touch[i, rec.CLOSING] = face * (lift - state[foot, rec.CLIMB] - arm * state[foot, rec.TURN])


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
        force = given[f, rec.PRESS] - given[f, rec.SPRING] * feet.state[f, rec.HEIGHT]
        feet.kick[f, 0] = dt * given[f, rec.FOOT_INVERSE_MASS] * force
        feet.kick[f, 1] = 0.0


@inline
def _push(feet: Feet, before: Array) -> bool:
    """Normal force of every point at its depth and mean speed; whether any has a dashpot.

    That of a dashpot jumps where a point lands: it counts from there on to the end of the step.
    """
    touch, points, damped = feet.touch, feet.points, False
    for i in range(points.shape[0]):
        depth, force = touch[i, rec.DEPTH], 0.0
        if depth > 0.0:
            force = points[i, rec.STIFF] * depth
            if points[i, rec.DASHPOT] > 0.0:
                foot, damped = feet.foot[i], True
                given = points[i, rec.FACE] * (feet.kick[foot, 0] + points[i, rec.ARM] * feet.kick[foot, 1])
                share = 0.5 + depth / (depth - before[i, 0]) if before[i, 0] <= 0.0 else 1.0
                force += share * points[i, rec.DASHPOT] * (touch[i, rec.CLOSING] - 0.5 * given)
            force = force if force > 0.0 else 0.0
        touch[i, rec.PUSH] = force
    return damped


@inline
def _gather(dt: float, feet: Feet) -> None:
    """Give the normal forces to the feet."""
    _fall_free(dt, feet)
    touch, points = feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, rec.PUSH]
        if force > 0.0:
            foot, way = feet.foot[i], dt * points[i, rec.FACE] * force
            feet.kick[foot, 0] += way * feet.given[foot, rec.FOOT_INVERSE_MASS]
            feet.kick[foot, 1] += way * points[i, rec.ARM] * feet.given[foot, rec.FOOT_INVERSE_INERTIA]


@inline
def kick(dt: float, feet: Feet) -> None:
    """The feet take what the step gives them; its works."""
    state, sums, touch, points = feet.state, feet.sums, feet.touch, feet.points
    for i in range(points.shape[0]):
        force = touch[i, rec.PUSH]
        if touch[i, rec.DEPTH] > 0.0:
            foot, b = feet.foot[i], feet.owner[i]
            given = feet.kick[foot, 0] + points[i, rec.ARM] * feet.kick[foot, 1]
            closing = touch[i, rec.CLOSING] - 0.5 * points[i, rec.FACE] * given
            uphill = dt * force * points[i, rec.FACE] * touch[i, rec.RAMP]
            work = dt * force * points[i, rec.FACE] * touch[i, rec.LIFT] - uphill
            sums[b, rec.ACROSS] += work
            sums[b, rec.UPHILL] += uphill
            sums[b, rec.DAMPED] += dt * (force - points[i, rec.STIFF] * touch[i, rec.DEPTH]) * closing
            sums[b, rec.LIFTED] -= work
    for f in range(state.shape[0]):
        given = feet.given
        force = given[f, rec.PRESS] - given[f, rec.SPRING] * state[f, rec.HEIGHT]
        sums[feet.keeper[f], rec.PRESSED] += dt * force * (state[f, rec.CLIMB] + 0.5 * feet.kick[f, 0])
        state[f, rec.CLIMB] += feet.kick[f, 0]
        state[f, rec.TURN] += feet.kick[f, 1]


@inline
def stored(dt: float, feet: Feet) -> None:
    """Energy in the springs at the end of a step, at the depths of its middle drawn on."""
    state = feet.state
    for b in range(feet.sums.shape[0]):
        feet.sums[b, rec.STORED] = 0.0
    for i in range(feet.points.shape[0]):
        foot = feet.foot[i]
        climb = state[foot, rec.CLIMB] + feet.points[i, rec.ARM] * state[foot, rec.TURN]
        depth = feet.touch[i, rec.DEPTH] + 0.5 * dt * feet.points[i, rec.FACE] * (feet.touch[i, rec.LIFT] - climb)
        if depth > 0.0:
            feet.sums[feet.owner[i], rec.STORED] += 0.5 * feet.points[i, rec.STIFF] * depth * depth


@inline
def gone(i: int, feet: Feet) -> float:
    """How fast the place of point i goes along the beam, m/s: with its slider, unless that is kept where it is."""
    return float(feet.body[feet.owner[i], rec.V] * feet.riders[feet.owner[i], rec.FREE])


@inline
def place(i: int, feet: Feet) -> float:
    """Where point i stands, metres from where the slider started."""
    return float(feet.body[feet.owner[i], rec.X] + feet.points[i, rec.OFFSET])
