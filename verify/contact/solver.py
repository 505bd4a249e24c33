"""Contact forces of a step: normal laws, friction laws and the responses of beam, feet and sliders to them.

Points are swept one after the other (Gauss-Seidel), each law solved exactly with its own response, the others' forces
fixed; where the sweeps do not converge, the friction of all points is solved together by active sets. On a surface
without a response the points of a slider are one root.
"""

import math

from verify.contact import laws
from verify.contact.active_sets import SETTLED, revise_limits, solve_active_sets
from verify.contact.normal import set_normal_forces
from verify.contact.one_way import solve_one_way_friction
from verify.contact.points import NORMAL, TANGENTIAL, own_product, product, set_friction
from verify.contact.state import BILATERAL, HOLDS, SLIDES, SPRING, Bodies, Kind, Record, Response
from verify.jit import inline, jit, once

SWEEPS = 24  # Sweeps before the friction forces of a step are solved together: a third of the time of that solution
TOLERANCE = 1e-12  # Change of a force in a sweep, of the largest normal force, at which sweeps have converged
PASSES = 50
"""Rounds of friction at given normal forces and of normal forces at given friction. The one acts on the other by the
slope of the surface and by dashpots, both small; a step that needs more counts as not converged."""
UNCONVERGED = 1e-9  # Change of a force, of the largest normal force, above which a step counts as not converged


@once
def begin_forces(dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> bool:
    """Set gains of speed by external forces and all contact forces to zero; whether forces depend on each other."""
    for b in range(bodies.sliders.shape[0]):
        slider = bodies.sliders[b]
        slider.delta_v = dt * (slider.inverse_mass * slider.external_force + slider.tilt)
    for k in range(bodies.feet.shape[0]):
        foot = bodies.feet[k]
        foot.delta_vz = dt * foot.inverse_mass * (foot.load - foot.spring_rate * foot.height)
        foot.delta_pitch_rate = 0.0
    if response is not None:
        for j in range(len(response.rates)):
            response.rates[j] = 0.0
    n = bodies.points.shape[0]
    coupled = kind.normal_law == BILATERAL or kind.several
    for i in range(n):
        contact = bodies.contacts[i]
        contact.friction_before, contact.sticks_before = contact.friction, contact.sticks
        contact.normal, contact.friction, contact.slip, contact.sticks, contact.holds = 0.0, 0.0, 0.0, 0.0, 0.0
        contact.self_response = 0.0
        if response is not None:
            contact.self_response = own_product(i, TANGENTIAL, response.shapes)
        contact.limit_state = HOLDS if contact.sticks_before > 0.0 else SLIDES
        coupled = coupled or bodies.points[i].dashpot > 0.0
    return coupled


@once
def sweep(first: bool, dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> tuple[float, float]:
    """Set all forces once, one after the other; (largest change of a normal force, of any force), N."""
    normal = set_normal_forces(first, dt, kind, bodies, response)
    changed = normal
    if kind.normal_law == SPRING and response is None:
        return normal, changed  # friction is one root at the end
    for i in range(bodies.points.shape[0]):
        if kind.normal_law != SPRING or bodies.contacts[i].depth > 0.0:
            changed = max(changed, set_friction(i, dt, kind, bodies, response))
    return normal, changed


@once
def end_forces(dt: float, kind: Kind, bodies: Bodies, response: Response | None) -> None:
    """Set the speeds of the surface with all forces, sticking, and the energy that friction has dissipated."""
    for i in range(bodies.points.shape[0]):
        contact = bodies.contacts[i]
        contact.surface = contact.mean
        if response is not None:
            contact.surface += product(i, TANGENTIAL, response)
            if kind.normal_two_way:
                answer = product(i, NORMAL, response)
                contact.vz += bodies.points[i].face * answer
                contact.closing += answer if kind.normal_law == SPRING else 0.0
        contact.surface_before = 2.0 * contact.surface - contact.mean
        contact.sticks = contact.holds if contact.normal > 0.0 else 0.0
        if not laws.stores_energy(bodies.points[i].law):
            contact.loss -= dt * contact.friction * contact.slip


@inline
def solve_together(every: bool, largest: float, dt: float, kind: Kind, bodies: Bodies, response: Response) -> float:
    """Friction of all points and the normal forces that depend on it, in turns; largest change of the last round, N.

    `every` is False, an argument because a constant would compile `set_normal_forces` once more.
    """
    changed = math.inf
    for _ in range(PASSES):
        changed = solve_active_sets(dt, largest, kind, bodies, response)
        normal = set_normal_forces(every, dt, kind, bodies, response)
        changed = max(changed, normal)
        if normal <= SETTLED * largest:
            break
    return changed


@jit(no_cpython_wrapper=True)
def solve(dt: float, kind: Kind, bodies: Bodies, response: Response | None, balance: Record) -> None:
    """Contact forces of the step, and what they add to sliders, feet and the columns (`response.rates`).

    `response` is None of a surface that does not respond: numba then leaves out all that needs one. Limits of friction
    are revised from kinetic to static and from static to let go, so that each point revises them twice at most.
    """
    n, coupled = bodies.points.shape[0], begin_forces(dt, kind, bodies, response)
    largest, sweeps, changed, revised = 0.0, 0, 0.0, True
    while revised:
        revised = False
        for _ in range(SWEEPS):
            normal, changed = sweep(sweeps == 0, dt, kind, bodies, response)
            sweeps, largest = sweeps + 1, max(largest, normal)  # the first change is the largest force
            if changed <= TOLERANCE * largest or not coupled:
                changed = 0.0
                break
        if response is not None:
            if changed > 0.0:
                changed = solve_together(sweeps == 0, largest, dt, kind, bodies, response)
            revised = kind.several and revise_limits(dt, kind, bodies)
    if kind.normal_law == SPRING and response is None:
        for i in range(n):
            if i + 1 == n or bodies.points[i + 1].slider != bodies.points[i].slider:
                changed = max(changed, solve_one_way_friction(i, dt, kind, bodies))
    balance.unconverged += 1.0 if changed > UNCONVERGED * largest else 0.0
    end_forces(dt, kind, bodies, response)
