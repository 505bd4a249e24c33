"""The compiled loop of sliders on the nonlinear chain: the steps of `dynamics` and `contact` on another surface.

Columns of the surface are the transverse components of the N links, then their changes along x. With one-way coupling
they follow from states at half steps. With two-way coupling every step of the chain is repeated with the contact forces
as dead loads on its joints, of equal virtual power, until forces and motion agree; the response is the exact difference
of two marches.
"""

import math
from typing import NamedTuple

from verify.arrays import Array, Indices
from verify.chain import rigid_links
from verify.chain.runge_kutta import DONE as MARCHED
from verify.chain.runge_kutta import KEPT, STEP, TIME, Model, State, Tableau, march
from verify.contact.points import NORMAL, TANGENTIAL, add_response, product
from verify.contact.solver import solve
from verify.contact.state import SPRING, Bodies, Kind, Response
from verify.dynamics.columns import set_mean_rates, set_shapes
from verify.dynamics.integrator import are_finite, begin_bodies, close_step
from verify.dynamics.recording import sample
from verify.dynamics.state import DONE, END, HALF, MIDDLE, NOT_FINITE, OFF_PIECES, RATE, START, VALUE, Journal, Surface
from verify.dynamics.surface import SIMPSON, evaluate_surface, find_pieces, set_start_speeds
from verify.jit import inline, jit

CORRECTIONS = 20  # Largest number of marches of a step before it is not converged
AGREED = 1e-9  # Tolerance of the change of a force between two marches, over the load
STALE = 3  # Number of marches of a step after which the response is computed anew: that takes a march for every force
BUDGET = 1_000_000_000  # Largest number of steps of one march


class Chain(NamedTuple):
    """The chain under the sliders."""

    surface: Surface
    limits: Array  # (2,), ends of the surface, m from the first slider's start
    load: float  # Scale of the contact forces, N
    model: Model  # Two-way with dead loads at the far joints in its last rows
    tableau: Tableau
    march: State
    n: int  # Number of coordinates: N of rigid links, 2 N + 2 of stretching ones
    substep: float  # Step of the march, s
    states: Array  # States of half steps, (2 steps + 1, y.size), or two-way of this step alone, (3, y.size)
    probe: Array  # (2, y.size), states with a unit force in addition
    ends: Array  # (2,), times of the half steps
    forces: Array  # (points, 2), tangential and normal force on sliders and feet in the march
    marches: Indices  # (1,), marches of the last step
    before: Bodies  # Sliders and feet at the start of the step


@inline
def copy(bodies: Bodies, to: Bodies) -> None:
    """Copy the moving bodies."""
    for b in range(bodies.sliders.shape[0]):
        to.sliders[b] = bodies.sliders[b]
    for k in range(bodies.feet.shape[0]):
        to.feet[k] = bodies.feet[k]
    for i in range(bodies.contacts.shape[0]):
        to.contacts[i] = bodies.contacts[i]


@inline
def read_links(when: int, y: Array, chain: Chain) -> None:
    """Factors of all columns and their rates from a state of the march, of rigid links (n = N) or stretching ones."""
    factors, n = chain.surface.factors, chain.n
    m = factors.shape[2] // 2
    for j in range(m):
        if n == m:
            length, theta, rate = 2.0 * chain.model.links[j, rigid_links.HALF], y[j], y[n + j]
            s, c, half = math.sin(theta), math.cos(theta), math.sin(0.5 * theta)
            factors[when, VALUE, j], factors[when, RATE, j] = length * s, length * c * rate
            factors[when, VALUE, m + j], factors[when, RATE, m + j] = -2.0 * length * half * half, -length * s * rate
        else:
            for axis in range(2):
                column, i = j if axis == 1 else m + j, 2 * j + axis
                factors[when, VALUE, column], factors[when, RATE, column] = y[i + 2] - y[i], y[n + i + 2] - y[n + i]


@inline
def axial_speed(when: int, i: int, surface: Surface, bodies: Bodies) -> float:
    """Speed of the chain along x under point i at an instant of the step, m/s."""
    m, rates, contact = surface.factors.shape[2] // 2, surface.factors[when, RATE], bodies.contacts[i]
    piece, share = contact.piece, contact.xi_point_end if when == END else contact.xi_point
    if when == START:
        x = bodies.sliders[bodies.points[i].slider].x + bodies.points[i].offset
        share = (x - surface.edges[piece]) / (surface.edges[piece + 1] - surface.edges[piece])
    along = share * rates[m + piece]
    for j in range(piece):
        along += rates[m + j]
    return float(along)


@jit(no_cpython_wrapper=True)
def evaluate_chain_surface(when: int, step: int, dt: float, kind: Kind, surface: Surface, bodies: Bodies) -> None:
    """Evaluate the surface under every point (`evaluate_surface`), with the speed of its material along x."""
    for j in range(surface.stamps.size):
        surface.stamps[j] = -1
    evaluate_surface(when, 4 * step + when, dt, kind, surface, bodies)
    for i in range(bodies.points.shape[0]):
        contact, along = bodies.contacts[i], axial_speed(when, i, surface, bodies)
        if kind.normal_law == SPRING:
            contact.mean += along
            contact.surface_delta_v += along
            continue
        contact.mean += SIMPSON[when] * along
        if when == START:
            contact.start += along
        elif when == END:
            contact.end += along


@inline
def set_chain_shapes(surface: Surface, bodies: Bodies, shapes: Array) -> None:
    """Tangential and normal speed of the surface at every point per unit rate of each column, in mid-step."""
    m = surface.table.shape[2]
    for i in range(bodies.points.shape[0]):
        contact = bodies.contacts[i]
        set_shapes(i, m, surface, bodies.points[i], contact, shapes)
        for j in range(m):
            along = contact.xi_point if j == contact.piece else 0.0
            shapes[TANGENTIAL, i, m + j] = 1.0 if j < contact.piece else along


@inline
def load_joints(forces: Array, bodies: Bodies, shapes: Array, loads: Array) -> None:
    """Write dead loads at the far joints of all links (last rows) with the power of minus `forces` (points, 2)."""
    m = shapes.shape[2] // 2
    first = loads.shape[0] - m
    for axis in range(2):
        column, beyond = m if axis == 0 else 0, 0.0
        for j in range(m - 1, -1, -1):
            total = 0.0
            for i in range(forces.shape[0]):
                for s in range(2):
                    total -= bodies.points[i].weight * forces[i, s] * shapes[s, i, column + j]
            loads[first + j, rigid_links.FX + axis] = total - beyond
            beyond = total


@jit(no_cpython_wrapper=True)
def march_loaded(step: int, dt: float, kept: Array, chain: Chain, bodies: Bodies, shapes: Array) -> bool:
    """March the chain over a step with its contact forces, to states at half the step and its end (`kept`)."""
    y, clock = chain.march.y, chain.march.clock
    load_joints(chain.forces, bodies, shapes, chain.model.loads)
    for j in range(y.size):
        y[j] = chain.states[0, j]
    chain.ends[0], chain.ends[1] = (step + 0.5) * dt, (step + 1.0) * dt
    clock[TIME], clock[STEP], chain.march.counts[KEPT] = step * dt, chain.substep, 0
    status = march(rigid_links.accelerate, chain.model, chain.tableau, chain.n, chain.march, chain.ends, kept, BUDGET)
    return status == MARCHED


@jit(no_cpython_wrapper=True)
def move_surface(row: int, step: int, dt: float, kind: Kind, chain: Chain, bodies: Bodies) -> None:
    """The surface under all points in a step by three states of half steps, from a row of `chain.states` on."""
    factors, spring = chain.surface.factors, kind.normal_law == SPRING
    for when in range(factors.shape[0]):
        if when != MIDDLE:
            read_links(when, chain.states[row + (when + 1) // 2], chain)
    set_mean_rates(dt, spring, factors)
    begin_bodies(dt, spring, bodies)
    for when in range(factors.shape[0]):
        if when != HALF and (when == MIDDLE or not spring):
            evaluate_chain_surface(when, step, dt, kind, chain.surface, bodies)


@inline
def set_responses(step: int, dt: float, directions: int, chain: Chain, bodies: Bodies, shapes: Array) -> bool:
    """Mean rates of the columns by unit forces, by a march with each in addition; whether all marches succeed."""
    factors = chain.surface.factors
    for i in range(bodies.points.shape[0]):
        for s in range(directions):
            chain.forces[i, s] -= chain.load  # a force on the beam is minus that on the slider
            marched = march_loaded(step, dt, chain.probe, chain, bodies, shapes)
            chain.forces[i, s] += chain.load
            if not marched:
                return False
            read_links(HALF, chain.march.y, chain)
            for j in range(factors.shape[2]):
                shapes[2 + s, i, j] = (factors[HALF, VALUE, j] - factors[END, VALUE, j]) / (dt * chain.load)
    return True


@inline
def take_off_response(directions: int, kind: Kind, chain: Chain, bodies: Bodies, response: Response) -> None:
    """Take the response to the forces of the march off the surface: `solve` adds it again."""
    for j in range(response.rates.size):
        response.rates[j] = 0.0
    for i in range(bodies.points.shape[0]):
        for s in range(directions):
            add_response(i, s, chain.forces[i, s], response)
    for i in range(bodies.points.shape[0]):
        contact, own = bodies.contacts[i], product(i, TANGENTIAL, response)
        contact.mean -= own
        contact.end -= 2.0 * own
        if kind.normal_law == SPRING:
            across = product(i, NORMAL, response)
            contact.surface_delta_v -= own
            contact.closing -= across
            contact.vz -= bodies.points[i].face * across


@inline
def take_forces(directions: int, chain: Chain, bodies: Bodies) -> float:
    """The contact forces of the solver for the next march; largest change, N."""
    changed = 0.0
    for i in range(bodies.points.shape[0]):
        for s in range(directions):
            force = bodies.contacts[i].friction if s == 0 else bodies.contacts[i].normal
            changed, chain.forces[i, s] = max(changed, abs(force - chain.forces[i, s])), force
    return changed


@jit(no_cpython_wrapper=True)
def step_coupled(
    step: int, dt: float, kind: Kind, chain: Chain, bodies: Bodies, response: Response, journal: Journal
) -> bool:
    """A step in which forces and motion of the chain agree; whether its marches succeed."""
    directions, balance, shapes = 2 if kind.normal_two_way else 1, journal.balance[0], response.shapes
    count, changed, stale, row, before = 0, 0.0, chain.marches[0] > STALE, 0, balance.unconverged
    copy(bodies, chain.before)
    while count == 0 or (changed > AGREED * chain.load and count < CORRECTIONS):
        if not march_loaded(step, dt, chain.states[1:3], chain, bodies, shapes):
            return False
        count += 1
        copy(chain.before, bodies)
        move_surface(row, step, dt, kind, chain, bodies)
        set_chain_shapes(chain.surface, bodies, shapes)
        if stale and not set_responses(step, dt, directions, chain, bodies, shapes):
            return False
        stale = False
        take_off_response(directions, kind, chain, bodies, response)
        balance.unconverged = before  # the last solution of the step counts
        solve(dt, kind, bodies, response, balance)
        changed = take_forces(directions, chain, bodies)
    chain.marches[0] = count
    if changed > AGREED * chain.load:
        balance.unconverged = before + 1.0
    factors = chain.surface.factors
    for i in range(bodies.points.shape[0]):
        for s in range(directions):
            for j in range(factors.shape[2]):  # less the work of the contact on the chain, a part of that of its loads
                moved = shapes[s, i, j] * (factors[END, VALUE, j] - factors[START, VALUE, j])
                balance.driven += bodies.points[i].weight * chain.forces[i, s] * moved
    for j in range(chain.march.y.size):
        chain.states[0, j] = chain.states[2, j]
    return True


@inline
def on_surface(ahead: float, chain: Chain, bodies: Bodies) -> bool:
    """Whether all points are on the surface; sets their pieces `ahead` seconds on."""
    for i in range(bodies.points.shape[0]):
        x = bodies.sliders[bodies.points[i].slider].x + bodies.points[i].offset
        if x < chain.limits[0] or x > chain.limits[1]:
            return False
    return find_pieces(ahead, chain.surface.edges, bodies)


@inline
def record(row: int, step: int, span: float, kind: Kind, chain: Chain, bodies: Bodies, journal: Journal) -> None:
    """Sample by a row of `chain.states`, with means over a span of seconds."""
    for when in range(1):  # START; a constant argument would be compiled once more
        read_links(when, chain.states[row], chain)
        if kind.normal_law != SPRING and find_pieces(0.0, chain.surface.edges, bodies):
            for j in range(chain.surface.stamps.size):
                chain.surface.stamps[j] = -1
            set_start_speeds(when, 4 * step, chain.surface, bodies)
            for i in range(bodies.points.shape[0]):
                bodies.contacts[i].start += axial_speed(when, i, chain.surface, bodies)
    sample(span, kind, bodies, chain.surface.factors, journal)


@jit
def advance(
    n_steps: int,
    every: int,
    dt: float,
    kind: Kind,
    chain: Chain,
    bodies: Bodies,
    response: Response | None,
    journal: Journal,
) -> int:
    """Advance by up to n_steps from step `journal.progress`; why it returns. With no steps it records the start."""
    progress, row = journal.progress[0], 0
    if n_steps == 0:
        for i in range(bodies.points.shape[0]):
            bodies.contacts[i].normal = bodies.points[i].load
        record(row, row, math.inf, kind, chain, bodies, journal)
    for _ in range(n_steps):
        step = progress.step
        row = 0 if kind.two_way else 2 * step
        if not on_surface(0.5 * dt if kind.normal_law == SPRING else 0.0, chain, bodies):
            return OFF_PIECES
        if response is None:
            move_surface(row, step, dt, kind, chain, bodies)
            solve(dt, kind, bodies, response, journal.balance[0])
        elif not step_coupled(step, dt, kind, chain, bodies, response, journal):
            return NOT_FINITE
        close_step(step * dt, dt, kind, bodies, response, journal)
        if not are_finite(chain.surface.factors[END, VALUE, 0], bodies):
            return NOT_FINITE
        if (step + 1) % every == 0:
            record(0 if kind.two_way else row + 2, step + 1, every * dt, kind, chain, bodies, journal)
    return DONE
