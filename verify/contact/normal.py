"""Normal laws: prescribed loads, masses that follow the surface, unilateral springs and dashpots of feet."""

from verify.contact.points import NORMAL, add_response, own_product, product
from verify.contact.state import BILATERAL, PRESCRIBED, SPRING, Bodies, Kind, Record, Response
from verify.jit import inline, jit, once


@once
def following_mass(i: int, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> float:
    """Normal force of a mass that has the speed of the surface at the end of the step: momentum of the step.

    Contact forces change that speed by `couplings`; the own part is taken to the left side.
    """
    point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
    inertia, own = point.mass / dt, 0.0
    vz = contact.slope_vz * (slider.v + slider.delta_v - contact.v_end) + contact.closing
    if response is not None:
        own = response.couplings[1, i, i]
        for j in range(bodies.points.shape[0]):
            other = bodies.contacts[j]
            vz -= response.couplings[0, i, j] * other.friction + response.couplings[1, i, j] * other.normal
    load = point.load + inertia * (vz + own * contact.normal - contact.point_vz)
    return float(load / (1.0 + inertia * own))


@inline
def closing_speed(point: Record, contact: Record, foot: Record) -> float:
    """Mean rate of depth of a point in the step by the surface's and the foot's mean speeds, m/s."""
    gained = foot.delta_vz + point.arm * foot.delta_pitch_rate
    return float(contact.closing - 0.5 * point.face * gained)


@once
def spring_and_dashpot(i: int, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> float:
    """Normal force of a point of a foot: the spring at mid-step and the dashpot by the mean speed, with its response.

    In the step in which a point lands the dashpot acts from the landing on: from `depth`/(`depth` - before) of a step
    before mid-step to half a step after it. It never pulls.
    """
    point, contact, foot = bodies.points[i], bodies.contacts[i], bodies.feet[bodies.points[i].foot]
    depth, before, dashpot = contact.depth, contact.depth_before, point.dashpot
    if depth <= 0.0:
        return 0.0
    force = point.stiffness * depth
    if dashpot > 0.0:
        dashpot *= 0.5 + depth / (depth - before) if before <= 0.0 else 1.0
        own = 0.5 * dt * (foot.inverse_mass + point.arm * point.arm * foot.inverse_inertia)
        closing = closing_speed(point, contact, foot)
        if response is not None and kind.normal_two_way:
            closing += product(i, NORMAL, response)
            own += own_product(i, NORMAL, response.shapes)
        force = (force + dashpot * (closing + own * contact.normal)) / (1.0 + dashpot * own)
    return float(max(force, 0.0))


@jit(no_cpython_wrapper=True)
def set_normal_forces(every: bool, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> float:
    """Set the normal forces of points in contact and what they add to feet and columns; largest change, N.

    Of every point, or of those whose normal force depends on the forces of the step.
    """
    law, largest = kind.normal_law, 0.0
    for i in range(bodies.points.shape[0]):
        point, contact = bodies.points[i], bodies.contacts[i]
        depends = every or law == BILATERAL or point.dashpot > 0.0
        if not depends or (law == SPRING and contact.depth <= 0.0):
            continue
        if law == PRESCRIBED:
            normal = point.load
        elif law == BILATERAL:
            normal = following_mass(i, dt, kind, bodies, response)
        else:
            normal = spring_and_dashpot(i, dt, kind, bodies, response)
        more = normal - contact.normal
        contact.normal = normal
        if response is not None and kind.normal_two_way and more != 0.0:
            add_response(i, NORMAL, more, response)
        if law == SPRING:
            foot, push = bodies.feet[point.foot], dt * point.face * more
            foot.delta_vz += push * foot.inverse_mass
            foot.delta_pitch_rate += push * point.arm * foot.inverse_inertia
        largest = max(largest, abs(more))
    return largest
