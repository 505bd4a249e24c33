"""Friction of all points together on a beam that responds to it: limits of friction and active sets."""

import math

from verify.arrays import Array
from verify.contact import laws
from verify.contact.coulomb import CREEP
from verify.contact.points import TANGENTIAL, add_friction, product, slip_at_start, sticking_slip
from verify.contact.state import HOLDS, LETS_GO, SLIDES, Bodies, Kind, Path, Record, Response
from verify.jit import inline, jit, once

SETTLED = 1e-10
"""Change of a force, of the largest normal force, at which Newton's method ends: its next one would be rounding."""
ROUNDS = 10
"""Rounds over the number of points, beside 20: with up to 31 points on 8 modes every step converged within them."""


@inline
def own_compliance(dt: float, slider: Record, contact: Record) -> float:
    """Mean slip of a point by a unit of its own friction, m/s/N."""
    return float(0.5 * dt * slider.inverse_mass + contact.self_response + 1e-300)


@jit(no_cpython_wrapper=True)
def revise_limits(dt: float, kind: Kind, bodies: Bodies) -> bool:
    """Whether the limit of a rigid point by Coulomb's law changes, with static friction above the kinetic one.

    Several points may then stick in more than one way. Those that reverse their slip in the step try to stick beside
    those that stuck before; of all that exceed the static limit the worst lets go, which loads the others anew.
    """
    tries, worst, exceeds = False, 1.0, -1
    for i in range(bodies.points.shape[0]):
        point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
        static = slider.mu_static * contact.normal
        if slider.mu_static <= slider.mu or not laws.set_valued(point.law) or static <= 0.0 or contact.holds > 0.0:
            continue
        if contact.limit_state == SLIDES:
            start = slip_at_start(kind, slider, contact)
            if start * (2.0 * contact.slip - start) < 0.0:
                contact.limit_state, tries = HOLDS, True
        elif contact.limit_state == HOLDS:
            excess = abs(contact.friction - contact.slip / own_compliance(dt, slider, contact)) / static
            if excess > worst:
                worst, exceeds = excess, i
    if not tries and exceeds >= 0:
        bodies.contacts[exceeds].limit_state = LETS_GO
    return tries or exceeds >= 0


@inline
def residual(
    dt: float, slip: float, kind: Kind, slider: Record, point: Record, contact: Record
) -> tuple[float, float, float, float]:
    """Residual of a point's law within its limit, for its mean slip and force: (by force, by slip, value, unlimited).

    `unlimited` is the force, N, that meets the law without its limit by the point's own response. The residual of a
    rigid sticking point is its slip beyond that at which it sticks and CREEP, m/s; all others are forces, N, by the law
    at the mean slip.
    """
    normal, force = max(contact.normal, 0.0), contact.friction
    if slider.mu * normal <= 0.0:
        return 1.0, 0.0, force, 0.0
    if laws.set_valued(point.law):
        stuck, own = contact.sticks_before > 0.0 or contact.limit_state == HOLDS, own_compliance(dt, slider, contact)
        excess = slip - (sticking_slip(kind, slider, contact) if stuck else 0.0) + CREEP * own * force
        return CREEP * own, 1.0, excess, force - excess / own
    path = Path(slip, slip, 0.0, 0.0, math.inf, 0.0, dt)
    unlimited, _, by_end = laws.slope(path, normal, slider, point, contact)
    return 1.0, -2.0 * by_end, force - unlimited, unlimited  # both ends of the path move with the slip


@inline
def mean_slip(i: int, bodies: Bodies, response: Response) -> float:
    """Mean slip of point i in the step under all forces, m/s."""
    slider = bodies.sliders[bodies.points[i].slider]
    return float(slider.v + 0.5 * slider.delta_v - bodies.contacts[i].mean - product(i, TANGENTIAL, response))


@inline
def limit_of(i: int, bodies: Bodies) -> float:
    """Limit of friction of point i, N, infinite without one."""
    point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
    limit = laws.limits(slider, point, contact)
    return limit if limit > 0.0 else math.inf


@once
def set_rows(dt: float, kind: Kind, bodies: Bodies, response: Response) -> None:
    """Matrix and right side of the changes of all forces at which the residuals of points between limits vanish."""
    n, block, shapes = bodies.points.shape[0], response.block, response.shapes
    for i in range(n):
        point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
        diagonal, slope, miss = 1.0, 0.0, 0.0
        if contact.limit_sign == 0.0:
            slip = mean_slip(i, bodies, response)
            diagonal, slope, miss, _ = residual(dt, slip, kind, slider, point, contact)
        for k in range(n):
            block[i, k] = 0.5 * slope * dt * slider.inverse_mass if bodies.points[k].slider == point.slider else 0.0
            for j in range(shapes.shape[2] if slope != 0.0 else 0):
                block[i, k] += slope * shapes[TANGENTIAL, i, j] * shapes[2 + TANGENTIAL, k, j]
        block[i, i] += diagonal
        block[i, n] = -miss


@once
def eliminate(block: Array) -> None:
    """Solve in place; the solution is the last column.

    Without pivoting: the rows between limits are those of a symmetric positive definite matrix (compliances and a
    positive diagonal), each times a scale, and such a matrix needs none; rows at a limit are those of the identity.
    """
    n = block.shape[0]
    for k in range(n):
        for i in range(n):
            if i != k:
                share = block[i, k] / block[k, k]
                for j in range(k, n + 1):
                    block[i, j] -= share * block[k, j]
    for i in range(n):
        block[i, n] /= block[i, i]


@once
def step_to_limit(dt: float, kind: Kind, bodies: Bodies, response: Response) -> float:
    """Add the changes of forces up to the first limit on the way; the largest one, N, infinite where a limit stops."""
    n, share, first, side, largest = bodies.points.shape[0], 1.0, -1, 0.0, 0.0
    for i in range(n):
        contact, more, limit = bodies.contacts[i], response.block[i, n], limit_of(i, bodies)
        if contact.limit_sign == 0.0 and abs(contact.friction + share * more) > limit:
            first, side = i, math.copysign(1.0, more)
            share = max((side * limit - contact.friction) / more, 0.0)
    for i in range(n):
        more = share * response.block[i, n]
        if i == first:
            more = side * limit_of(i, bodies) - bodies.contacts[i].friction
            bodies.contacts[i].limit_sign = side
        add_friction(i, more, dt, kind, bodies, response)
        largest = max(largest, abs(more))
    return math.inf if first >= 0 else largest


@once
def release_worst(dt: float, kind: Kind, bodies: Bodies, response: Response) -> bool:
    """Set the slips; whether a point leaves its limit: that whose law asks for the least share of it."""
    least, leaves = 1.0 - SETTLED, -1
    for i in range(bodies.points.shape[0]):
        point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
        contact.slip = mean_slip(i, bodies, response)
        if contact.limit_sign != 0.0:
            _, _, _, unlimited = residual(dt, contact.slip, kind, slider, point, contact)
            share = contact.limit_sign * unlimited / limit_of(i, bodies)
            if share < least:
                least, leaves = share, i
    if leaves >= 0:
        bodies.contacts[leaves].limit_sign = 0.0
    return leaves >= 0


@once
def solve_active_sets(dt: float, largest: float, kind: Kind, bodies: Bodies, response: Response) -> float:
    """Friction of all points together, which a beam responds to, at given normal forces; change of the last round, N.

    With Coulomb's law a strictly convex quadratic program with bounds, whose primal active sets (Nocedal and Wright,
    Numerical Optimization 2006, sec. 16.5) end after finitely many rounds. Smooth laws are solved by Newton's method in
    the same rounds.
    """
    n, changed = bodies.points.shape[0], math.inf
    for i in range(n):  # start between the limits
        contact, limit = bodies.contacts[i], limit_of(i, bodies)
        inside = min(max(contact.friction, -limit), limit)
        if bodies.contacts[i].normal <= 0.0:
            inside = 0.0
        add_friction(i, inside - contact.friction, dt, kind, bodies, response)
        contact.limit_sign = math.copysign(1.0, inside) if abs(inside) == limit else 0.0
    for _ in range(ROUNDS * n + 20):
        set_rows(dt, kind, bodies, response)
        eliminate(response.block)
        changed = step_to_limit(dt, kind, bodies, response)
        if changed < math.inf:
            leaves = release_worst(dt, kind, bodies, response)
            if not leaves and changed <= SETTLED * largest:
                break
    for i in range(n):
        point, contact = bodies.points[i], bodies.contacts[i]
        bounded = laws.limits(bodies.sliders[point.slider], point, contact) < math.inf
        contact.holds, contact.slip_by_law = 1.0 if bounded and contact.limit_sign == 0.0 else 0.0, contact.slip
        contact.events = 0
    return changed
