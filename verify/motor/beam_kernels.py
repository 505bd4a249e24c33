"""The compiled beam that feels the feet: how it answers their forces within a step, and what they leave in its modes.

Forces of points act on the polynomials of the pieces they stand on: a coefficient's share of a force is what the
coefficient adds to the way that the force goes along. A normal force goes along with how deep its point is pressed
in: the surface rises there, and slides under the point by (h/2) of the turn over its place, on a rise of w'. It is
square to the surface so: what acts straight up would make energy of that sliding. So much for the modes as the step
begins; within it the surface has, on the average, half of what the forces give it.
"""

import numpy as np

from verify.arrays import Array
from verify.jit import FAST, inline
from verify.motion.records import OMEGA, Z_IM
from verify.motor import records as rec
from verify.motor.records import BeamAnswer, Feet

WIDER = 1.125
"""Of the most that friction is: sought so far, since where a point slides one way Newton's step ends on 1."""
SWEEPS = 400
ENOUGH = 1e-13
"""Of mu N: as far as sweeps go on changing a force, they go on."""


@inline
def _lever(d: int, at: float, slope: float, lever: float, length: float) -> float:
    """What coefficient d adds to the surface's way along the tangent."""
    value = at**d
    first = d * at ** (d - 1) / length if d > 0 else 0.0
    return float((slope * value - lever * first) / np.sqrt(1.0 + slope * slope))


@inline
def _lift(i: int, d: int, lever: float, length: float, touch: Array) -> float:
    """What coefficient d adds to the height of the surface under point i, as its depth reads it."""
    value = touch[i, rec.AT] ** d
    if d > 0:
        value += touch[i, rec.SLOPE] * lever * d * touch[i, rec.ABOVE] ** (d - 1) / length
    return float(value)


@inline
def _add(
    i: int, along: float, across: float, dt: float, length: float, half: float, feet: Feet, beam: BeamAnswer
) -> None:
    """Forces of point i on its beam, newton: half of what they give is added to the rates, all of it to the load.

    Of two beams that are each other's mirror image one is kept, with the mean of what points below and above give.
    """
    touch, piece = feet.touch, feet.piece[i]
    lever, degree = half * feet.points[i, rec.FACE] * feet.points[i, rec.IMAGE], beam.load.shape[1]
    at, slope = touch[i, rec.AT], touch[i, rec.SLOPE]
    for d in range(degree):
        way = along * _lever(d, at, slope, lever, length) + across * _lift(i, d, lever, length, touch)
        impulse = feet.points[i, rec.WEIGHT] * dt * way
        beam.load[piece, d] += impulse
        _spread(0.5 * impulse, piece * degree + d, beam)


@inline(fastmath=FAST)
def _spread(impulse: float, column: int, beam: BeamAnswer) -> None:
    """What an impulse on one coefficient adds to all rates."""
    degree, row = beam.load.shape[1], beam.span[0] * beam.load.shape[1]
    for p in range(beam.span[0], beam.span[1] + 1):
        for d in range(degree):
            beam.added[p, d] += impulse * beam.answer[column, row]
            row += 1


@inline
def clear(feet: Feet, beam: BeamAnswer) -> None:
    """Nothing is pushed yet, on the pieces from the first to the last that a point stands on."""
    first = last = feet.piece[0]
    for piece in feet.piece:
        first, last = piece if piece < first else first, piece if piece > last else last
    beam.span[0], beam.span[1] = first, last
    for p in range(first, last + 1):
        for d in range(beam.load.shape[1]):
            beam.load[p, d], beam.added[p, d] = 0.0, 0.0


@inline
def bear(dt: float, edges: Array, half: float, feet: Feet, beam: BeamAnswer) -> None:
    """The surface takes the normal forces, and those of friction that are known."""
    for i in range(feet.points.shape[0]):
        force = feet.touch[i, rec.PUSH]
        if force > 0.0:
            length = edges[feet.piece[i] + 1] - edges[feet.piece[i]]
            along = -feet.touch[i, rec.RUB] if feet.points[i, rec.GRIP] > 0.0 else 0.0
            _add(i, along, -feet.points[i, rec.FACE] * feet.points[i, rec.IMAGE] * force, dt, length, half, feet, beam)


@inline
def _given(i: int, length: float, half: float, feet: Feet, beam: BeamAnswer) -> float:
    """What the forces so far add to the mean speed of the surface under point i, m/s."""
    lever, piece, total = half * feet.points[i, rec.FACE] * feet.points[i, rec.IMAGE], feet.piece[i], 0.0
    for d in range(beam.load.shape[1]):
        total += _lever(d, feet.touch[i, rec.AT], feet.touch[i, rec.SLOPE], lever, length) * beam.added[piece, d]
    return total


@inline
def _ease(i: int, dt: float, length: float, half: float, feet: Feet, beam: BeamAnswer) -> float:
    """What a unit force along the surface at point i adds to its mean speed there, m/s per newton."""
    lever, degree, total = half * feet.points[i, rec.FACE] * feet.points[i, rec.IMAGE], beam.load.shape[1], 0.0
    at, slope, first = feet.touch[i, rec.AT], feet.touch[i, rec.SLOPE], feet.piece[i] * beam.load.shape[1]
    for d in range(degree):
        own = _lever(d, at, slope, lever, length)
        for e in range(degree):
            total += own * beam.answer[first + d, first + e] * _lever(e, at, slope, lever, length)
    return float(0.5 * dt * feet.points[i, rec.WEIGHT] * total)


@inline
def match(dt: float, edges: Array, half: float, feet: Feet, slope: float | None, beam: BeamAnswer) -> None:
    """The mean speeds of the sliders at which every point's friction suits its own slip: sweeps from point to point.

    The surface has half of what all forces give it. Each point's rule is kept exactly in its turn; the sweeps are those
    of a symmetric problem and come to rest.

    What a surface gains within the step by itself is what it has gained since the forces of the step before.
    """
    touch, points, riders, means, largest = feet.touch, feet.points, feet.riders, feet.means, 0.0
    for b in range(feet.body.shape[0]):
        means[b, rec.MEAN] = feet.body[b, rec.V] + 0.5 * dt * riders[b, rec.INVERSE_MASS] * (
            riders[b, rec.PULL] + means[b, rec.HELD]
        )
    for i in range(points.shape[0]):
        if points[i, rec.GRIP] == 0.0:
            touch[i, rec.RUB], touch[i, rec.STUCK] = 0.0, 0.0
            gained = touch[i, rec.SURFACE] - touch[i, rec.SURFACE_BEFORE] - touch[i, rec.GAINED]
            touch[i, rec.AHEAD] = touch[i, rec.SURFACE] - 0.5 * gained - feet.body[feet.owner[i], rec.V]
            most = riders[feet.owner[i], rec.MU] * touch[i, rec.PUSH]
            largest = most if most > largest else largest
    for _ in range(SWEEPS):
        changed = 0.0
        for i in range(points.shape[0]):
            if touch[i, rec.PUSH] > 0.0 and points[i, rec.GRIP] == 0.0:
                length, b = edges[feet.piece[i] + 1] - edges[feet.piece[i]], feet.owner[i]
                gain = 0.5 * dt * riders[b, rec.INVERSE_MASS]
                slip = touch[i, rec.SURFACE] - means[b, rec.MEAN] + _given(i, length, half, feet, beam)
                ease = gain + _ease(i, dt, length, half, feet, beam)
                force = _suited(i, slip + ease * touch[i, rec.RUB], ease, feet, slope)
                more = force - touch[i, rec.RUB]
                touch[i, rec.RUB] = force
                means[b, rec.MEAN] += gain * more
                _add(i, -more, 0.0, dt, length, half, feet, beam)
                changed = abs(more) if abs(more) > changed else changed
        if changed <= ENOUGH * largest:
            break
    for b in range(feet.body.shape[0]):
        means[b, rec.AFTER] = 2.0 * means[b, rec.MEAN] - feet.body[b, rec.V]


@inline
def _suited(i: int, slip: float, ease: float, feet: Feet, slope: float | None) -> float:
    """Friction of point i where `slip` is what the surface is ahead by without it and `ease` what it takes of that."""
    most = feet.riders[feet.owner[i], rec.MU] * feet.touch[i, rec.PUSH]
    if slope is not None:
        return slide_by_tanh(most, slip, ease, slope)
    force, feet.touch[i, rec.STUCK] = turn(most, feet.touch[i, rec.AHEAD], slip, ease)
    return force


@inline
def turn(most: float, ahead: float, slip: float, ease: float) -> tuple[float, float]:
    """(mean friction of a step, 1 if it ends sticking) by Coulomb's law of a surface that is ahead as the step begins.

    Without friction it is ahead by `slip` in the middle, on a straight line; friction takes `ease` of that per newton,
    and twice that by the end. So it slides until the line is crossed, then sticks, or slides back. The impulse of a
    step acts at once: it is kept to where that takes energy, so that none is made whatever the step.
    """
    gain, whole, way = 2.0 * (slip - ahead), 2.0 * ease * most, 1.0 if ahead > 0.0 else -1.0
    share, stuck = 0.0, 0.0
    if ahead != 0.0:
        left = way * gain - whole
        share = 1.0 if abs(ahead) + left >= 0.0 else -abs(ahead) / left
    force = way * most * share
    if share < 1.0:
        stuck = 1.0 if abs(gain) < whole else 0.0
        after = 0.5 * gain / ease if stuck > 0.0 else most if gain > 0.0 else -most if gain < 0.0 else 0.0
        force += (1.0 - share) * after
    if force * (slip - ease * force) < 0.0:
        force = slip / ease if slip * force > 0.0 else 0.0
    return float(force), stuck


@inline
def slide_by_tanh(most: float, slip: float, ease: float, slope: float) -> float:
    """Force = most tanh(slope (slip - ease force)), which falls as the force rises."""
    low, high, force = -WIDER * most, WIDER * most, 0.0
    for _ in range(60):
        share = np.tanh(slope * (slip - ease * force))
        miss = force - most * share
        if miss > 0.0:
            high = force
        else:
            low = force
        after = force - miss / (1.0 + most * slope * ease * (1.0 - share * share))
        near = abs(after - force) <= 1e-15 * most
        if not near and not low < after < high:
            after, near = 0.5 * (low + high), high - low <= 1e-15 * most
        if near:
            return float(after)
        force = after
    return float(force)


@inline
def leave(table: Array, modes: Array, beam: BeamAnswer) -> None:
    """Give the step's impulses to the modes, in its middle."""
    for p in range(beam.span[0], beam.span[1] + 1):
        for d in range(beam.load.shape[1]):
            impulse = beam.load[p, d]
            if impulse != 0.0:
                for j in range(modes.shape[1]):
                    modes[Z_IM, j] -= table[p, d, j] * impulse / modes[OMEGA, j]


@inline
def moved(i: int, length: float, half: float, feet: Feet, beam: BeamAnswer) -> tuple[float, float]:
    """What all forces of a step add to the mean rates under point i: (along, across), m/s."""
    lever, piece, across = half * feet.points[i, rec.FACE] * feet.points[i, rec.IMAGE], feet.piece[i], 0.0
    for d in range(beam.load.shape[1]):
        across += _lift(i, d, lever, length, feet.touch) * beam.added[piece, d]
    return _given(i, length, half, feet, beam), across
