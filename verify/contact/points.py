"""Friction of one point in a step, the forces of all other points given, and the response of the beam to a force.

Forces are constant over a step. The Delassus operator is never formed: `Response.rates` holds what all forces add to
the mean rates of the columns, so that a visit to a point costs two products over the columns.
"""

import math

from verify.arrays import Array
from verify.contact import laws
from verify.contact.state import SPRING, Bodies, Kind, Record, Response, Slip
from verify.jit import FAST, inline, once

TANGENTIAL, NORMAL = 0, 1  # Directions, rows of `shapes`; the responses to them are two rows further
DAMPING = 0.1
"""Share D of no slip at the end in the condition of a sticking point, (1 - D) s + D (s - s_0/2) = 0.

No mean slip alone, D = 0, would leave one that alternates from step to step, e = 2 s - s_0 = -s_0. With D it falls by
1 - D a step: a tenth takes a decade in 22 steps, within a period of the drive, and leaves the mean slip D s_0/2.
"""


@inline(fastmath=FAST)
def product(i: int, direction: int, response: Response) -> float:
    """Mean speed of the surface at point i in a direction by the mean rates of the columns, m/s."""
    total, shapes, rates = 0.0, response.shapes, response.rates
    for j in range(shapes.shape[2]):
        total += shapes[direction, i, j] * rates[j]
    return total


@inline(fastmath=FAST)
def own_product(i: int, direction: int, shapes: Array) -> float:
    """The same by a unit force of the point itself, m/s/N."""
    total = 0.0
    for j in range(shapes.shape[2]):
        total += shapes[direction, i, j] * shapes[2 + direction, i, j]
    return total


@inline(fastmath=FAST)
def add_response(i: int, direction: int, force: float, response: Response) -> None:
    """Add a force of point i on the beam to the mean rates of the columns; friction on a slider acts on it by -1."""
    shapes, rates = response.shapes, response.rates
    for j in range(shapes.shape[2]):
        rates[j] -= force * shapes[2 + direction, i, j]


@inline
def slip_at_start(kind: Kind, slider: Record, contact: Record) -> float:
    """Slip s_0 at the start of the step from its mean s and end e without contact forces, 2 s - e, m/s."""
    if kind.normal_law == SPRING:
        return float(slider.v - contact.mean + 0.5 * contact.surface_delta_v)
    return float(slider.v - 2.0 * contact.mean + contact.end)


@inline
def sticking_slip(kind: Kind, slider: Record, contact: Record) -> float:
    """Mean slip s of a sticking point, m/s."""
    return 0.5 * DAMPING * slip_at_start(kind, slider, contact)


@inline
def slip_of(dt: float, others: float, kind: Kind, slider: Record, contact: Record) -> Slip:
    """Relative speed of a point without its own friction; `others` is the mean response to all other forces, m/s.

    Without feet the speed of the surface is a parabola with the speeds at both ends and the exact mean; under feet,
    whose surface is evaluated in mid-step, a line through the mean.
    """
    own, mobility = contact.self_response, dt * slider.inverse_mass
    gained, mean = slider.delta_v - mobility * contact.friction, contact.mean + others
    if kind.normal_law == SPRING:
        rise = contact.surface_delta_v + 2.0 * others
        start, first, last = mean - 0.5 * rise, rise - gained, rise - gained
    else:
        start, end = contact.start, contact.end + 2.0 * others
        first = 6.0 * mean - 4.0 * start - 2.0 * end - gained
        last = 4.0 * end + 2.0 * start - 6.0 * mean - gained
    return Slip(
        slider.v - start,
        first,
        last,
        slider.v + 0.5 * gained - mean,
        sticking_slip(kind, slider, contact),
        mobility,
        mobility + 2.0 * own,
        dt,
        kind.several,
        own > 0.0,
    )


@once
def dissipating(force: float, slip: Slip, loss: float) -> float:
    """The force, no more than it may be on a surface that responds to it without creating energy.

    A force f that is constant over the step dissipates -dt f (s + c f/2) with the slip s without it and the compliance
    c, which is positive between zero and 2 b, b = -s/c. Beyond, as in the step of a reversal, it returns at most what
    friction has dissipated before: dt c/2 (f^2 - 2 b f) <= loss, so |f - b| <= sqrt(b^2 + 2 loss/(dt c)).
    """
    middle = -slip.mean / slip.compliance
    wide = math.sqrt(middle * middle + 2.0 * max(loss, 0.0) / (slip.dt * slip.compliance))
    return float(min(max(force, middle - wide), middle + wide))


@once
def set_friction(i: int, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> float:
    """Set the friction of point i by its law with its own response, and what that adds to its slider and the columns.

    Returns the size of the change, N.
    """
    point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
    normal, others = max(contact.normal, 0.0), 0.0
    if response is not None:
        others = product(i, TANGENTIAL, response) + contact.self_response * contact.friction
    slip = slip_of(dt, others, kind, slider, contact)
    force = laws.force(slip, normal, slider, point, contact)
    if slip.own and not laws.stores_energy(point.law):
        bounded = dissipating(force, slip, contact.loss)
        contact.slip_by_law += 0.5 * slip.compliance * (bounded - force)
        force = bounded
    contact.slip = slip.mean + 0.5 * slip.compliance * force
    more = force - contact.friction
    if more != 0.0:
        add_friction(i, more, dt, kind, bodies, response)
        contact.friction = force
    return float(abs(more))


@inline
def add_friction(i: int, more: float, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> None:
    """Add to the friction of point i, and what that adds to its slider and to the columns."""
    slider = bodies.sliders[bodies.points[i].slider]
    bodies.contacts[i].friction += more
    slider.delta_v += dt * slider.inverse_mass * more
    if response is not None:
        add_response(i, TANGENTIAL, more, response)
