"""The compiled loop of sliders on the nonlinear chain, by the contact functions of `dynamics`.

Columns of the surface are the transverse components of the N links, then their changes along x. With one-way coupling
they follow from states at half steps. With two-way coupling every step of the chain is repeated with the contact forces
as dead loads on its joints, of equal virtual power, until forces and motion agree; the response is the exact difference
of two marches.
"""

import numpy as np

from verify.arrays import Array, Indices
from verify.chain import rigid_links
from verify.chain.runge_kutta import DONE as MARCHED
from verify.chain.runge_kutta import KEPT, STEP, TIME, march
from verify.dynamics import layout as lay
from verify.dynamics.contact_solver import solve
from verify.dynamics.integrator import add_sums, sample, update_bodies, write_events
from verify.dynamics.kinematics import (
    END,
    HALF,
    MIDDLE,
    RATE,
    START,
    VALUE,
    evaluate_surface,
    find_pieces,
    set_mean_rates,
    shape_of,
)
from verify.dynamics.point_forces import TRANSVERSE, add_response, product
from verify.jit import inline, jit

CORRECTIONS = 20  # largest number of marches of a step before it is not converged
AGREED = 1e-9  # tolerance of the change of a force between two marches, over the load
STALE = 3  # number of marches of a step after which the response is recomputed
BUDGET = 1_000_000_000  # largest number of steps of one march


@inline
def copy(source: Array, to: Array) -> None:
    """Copy the rows of a table; a slice assignment would allocate."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            to[i, j] = source[i, j]


@inline
def read_links(when: int, n: int, y: Array, links: Array, factors: Array) -> None:
    """Factors of all columns and their rates from the state of n coordinates, rigid links (n = N) or stretching."""
    m = factors.shape[2] // 2
    for j in range(m):
        if n == m:
            length, theta, rate = 2.0 * links[j, rigid_links.HALF], y[j], y[n + j]
            s, c, half = np.sin(theta), np.cos(theta), np.sin(0.5 * theta)
            factors[when, VALUE, j], factors[when, RATE, j] = length * s, length * c * rate
            factors[when, VALUE, m + j], factors[when, RATE, m + j] = -2.0 * length * half * half, -length * s * rate
        else:
            for axis in range(2):
                column, i = j if axis == 1 else m + j, 2 * j + axis
                factors[when, VALUE, column], factors[when, RATE, column] = y[i + 2] - y[i], y[n + i + 2] - y[n + i]


@inline
def evaluate_chain_surface(
    when: int, mark: int, dt: float, gravity: float, codes: Indices, table: Array, edges: Array, factors: Array,
    local: Array, stamp: Indices, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices,
) -> None:  # fmt: skip
    """Evaluate the surface under every point (`evaluate_surface`), with the speed of its material along x."""
    for j in range(stamp.size):
        stamp[j] = -1
    evaluate_surface(
        when, mark, dt, gravity, codes, table, edges, factors, local, stamp, sliders, feet, points, contacts, indices
    )
    m, spring = factors.shape[2] // 2, codes[lay.LAW] == lay.SPRING
    for i in range(points.shape[0]):
        piece, share = indices[i, lay.PIECE], contacts[i, lay.ABOVE_END if when == END else lay.ABOVE]
        if when == START:
            x = sliders[indices[i, lay.OF_SLIDER], lay.X] + points[i, lay.OFFSET]
            share = (x - edges[piece]) / (edges[piece + 1] - edges[piece])
        along = share * factors[when, RATE, m + piece]
        for j in range(piece):
            along += factors[when, RATE, m + j]
        contacts[i, lay.MEAN] += along if spring else along * (4.0 if when == MIDDLE else 1.0) / 6.0
        if spring:
            contacts[i, lay.SURFACE_DELTA_V] += along
        elif when == START:
            contacts[i, lay.START] += along
        elif when == END:
            contacts[i, lay.END] += along


@inline
def set_shapes(table: Array, edges: Array, points: Array, contacts: Array, indices: Indices, shapes: Array) -> None:
    """Tangential and normal speed of the surface at every point per unit rate of each column, in mid-step."""
    m = table.shape[2]
    for i in range(points.shape[0]):
        piece, at, above, slope = (
            indices[i, lay.PIECE], contacts[i, lay.AT], contacts[i, lay.ABOVE], contacts[i, lay.SLOPE]
        )  # fmt: skip
        length, lever, side = edges[piece + 1] - edges[piece], points[i, lay.LEVER], points[i, lay.FACE]
        for j in range(m):
            value, first, turn = shape_of(piece, j, at, above, table)
            shapes[0, i, j] = (slope * value - lever * first / length) / np.sqrt(1.0 + slope * slope)
            shapes[0, i, m + j] = 1.0 if j < piece else above if j == piece else 0.0
            shapes[1, i, j] = side * points[i, lay.IMAGE] * (value + slope * lever / length * turn)


@inline
def load_joints(forces: Array, points: Array, shapes: Array, loads: Array) -> None:
    """Write dead loads at the far joints of all links (last rows) with the power of minus `forces` (points, 2)."""
    m = shapes.shape[2] // 2
    first = loads.shape[0] - m
    for axis in range(2):
        column, beyond = m if axis == 0 else 0, 0.0
        for j in range(m - 1, -1, -1):
            total = 0.0
            for i in range(forces.shape[0]):
                for s in range(2):
                    total -= points[i, lay.WEIGHT] * forces[i, s] * shapes[s, i, column + j]
            loads[first + j, rigid_links.FX + axis] = total - beyond
            beyond = total


@jit
def advance(  # noqa: PLR0912, PLR0915  # one step in its order, as `integrator.advance`
    n_steps: int, every: int, dt: float, gravity: float, unit: float, limits: Array, links: Array, loads: Array,
    numbers: Array, scratch: Array, a: Array, c: Array, n: int, substep: float, weights: Array, k: Array, clock: Array,
    control: Array, counts: Indices, y: Array, ends: Array, states: Array, probe: Array, codes: Indices, table: Array,
    edges: Array, sliders: Array, feet: Array, points: Array, contacts: Array, indices: Indices, feet_of: Indices,
    factors: Array, local: Array, stamp: Indices, shapes: Array, response: Array, couplings: Array, spans: Array,
    block: Array, saved_sliders: Array, saved_feet: Array, saved: Array, forces: Array, marches: Indices, places: Array,
    samples: Array, heights: Array, pressures: Array, deflections: Array, events: Array, tally: Indices, sums: Array,
    before: Array, balance: Array,
) -> int:  # fmt: skip
    """Advance by up to n_steps from step tally[STEP]; returns the reason of the end.

    `states` are those of half steps, (2 steps + 1, y.size), or two-way of this step alone, (3, y.size). `unit` is the
    load, N, `limits` the ends of the surface; `forces` (points, 2) act on sliders and feet, tangential and normal.
    """
    two_way, spring, m, last = codes[lay.TWO_WAY] > 0, codes[lay.LAW] == lay.SPRING, points.shape[0], factors.shape[0]
    directions = 2 if codes[lay.NORMAL_TWO_WAY] > 0 else 1
    for _ in range(n_steps):
        step, count = tally[lay.STEP], 0
        row = 0 if two_way else 2 * step
        if not find_pieces(0.5 * dt if spring else 0.0, edges, sliders, points, indices):
            return lay.OFF_PIECES
        for i in range(m):
            x = sliders[indices[i, lay.OF_SLIDER], lay.X] + points[i, lay.OFFSET]
            if x < limits[0] or x > limits[1]:
                return lay.OFF_PIECES
        copy(sliders, saved_sliders)
        copy(feet, saved_feet)
        copy(contacts, saved)
        probing, changed = two_way and marches[0] > STALE, 0.0
        while True:
            for trial in range(-1, directions * m if probing else 0):  # then with a unit of every force in addition
                i, s, more = trial % m, trial // m, unit if trial >= 0 else 0.0
                if two_way:
                    forces[i, s] -= more
                    load_joints(forces, points, shapes, loads)
                    forces[i, s] += more
                    for j in range(y.size):
                        y[j] = states[0, j]
                    ends[0], ends[1] = (step + 0.5) * dt, (step + 1.0) * dt
                    clock[TIME], clock[STEP], counts[KEPT] = step * dt, substep, 0
                    kept = states[1:3] if trial < 0 else probe
                    if march(rigid_links.accelerate, links, loads, numbers, scratch, a, c, weights, n, y, k, clock,
                             ends, kept, control, counts, BUDGET) != MARCHED:  # fmt: skip
                        return lay.NOT_FINITE
                if trial >= 0:
                    read_links(HALF, n, y, links, factors)
                    for j in range(factors.shape[2]):
                        shapes[2 + s, i, j] = (factors[HALF, VALUE, j] - factors[END, VALUE, j]) / (dt * unit)
                    continue
                count += 1
                copy(saved_sliders, sliders)
                copy(saved_feet, feet)
                copy(saved, contacts)
                for when in range(last):
                    if when != MIDDLE:
                        read_links(when, n, states[row + (when + 1) // 2], links, factors)
                set_mean_rates(dt, spring, factors)
                for b in range(sliders.shape[0] if spring else 0):
                    sliders[b, lay.X] += 0.5 * dt * sliders[b, lay.V] * sliders[b, lay.FREE]
                for f in range(feet.shape[0]):
                    feet[f, lay.HEIGHT] += 0.5 * dt * feet[f, lay.VELOCITY_Z]
                    feet[f, lay.PITCH] += 0.5 * dt * feet[f, lay.PITCH_RATE]
                for when in range(last):
                    if when != HALF and (when == MIDDLE or not spring):
                        evaluate_chain_surface(
                            when,
                            4 * step + when,
                            dt,
                            gravity,
                            codes,
                            table,
                            edges,
                            factors,
                            local,
                            stamp,
                            sliders,
                            feet,
                            points,
                            contacts,
                            indices,
                        )
                if two_way:
                    set_shapes(table, edges, points, contacts, indices, shapes)
            probing = False
            for j in range(response.size):
                response[j] = 0.0
            for i in range(m if two_way else 0):
                for s in range(directions):
                    add_response(i, s, forces[i, s], shapes, response)
            for i in range(m if two_way else 0):  # `solve` adds the response again
                own = product(i, 0, shapes, response)
                contacts[i, lay.MEAN] -= own
                contacts[i, lay.END] -= 2.0 * own
                if spring:
                    across = product(i, TRANSVERSE, shapes, response)
                    contacts[i, lay.SURFACE_DELTA_V] -= own
                    contacts[i, lay.CLOSING] -= across
                    contacts[i, lay.LIFT] -= points[i, lay.FACE] * across
            solve(dt, codes, sliders, feet, points, contacts, indices, shapes, response, couplings, spans, block,
                  balance)  # fmt: skip
            changed = 0.0
            for i in range(m if two_way else 0):
                for s in range(directions):
                    force = contacts[i, lay.FRICTION if s == 0 else lay.NORMAL]
                    changed, forces[i, s] = max(changed, abs(force - forces[i, s])), force
            if changed <= AGREED * unit or count >= CORRECTIONS:
                break
        if two_way:
            marches[0] = count
            balance[lay.RESIDUAL] = max(balance[lay.RESIDUAL], changed)
            balance[lay.UNCONVERGED] += 1.0 if changed > AGREED * unit else 0.0
            for i in range(m):
                for s in range(directions):
                    for j in range(factors.shape[2]):  # work of the contact on the chain, a part of that of its loads
                        moved = shapes[s, i, j] * (factors[END, VALUE, j] - factors[START, VALUE, j])
                        balance[lay.DRIVEN] += points[i, lay.WEIGHT] * forces[i, s] * moved
            copy(states[2:], states)
        add_sums(dt, codes, sliders, feet, points, contacts, indices, feet_of, shapes, response, spans, sums, balance)
        update_bodies(dt, codes, sliders, feet, points, contacts, indices, spans)
        write_events(step * dt, dt, codes, sliders, points, contacts, indices, spans, events, tally)
        tally[lay.STEP] += 1
        if not np.isfinite(sliders[0, lay.V] + factors[END, VALUE, 0]):
            return lay.NOT_FINITE
        if tally[lay.STEP] % every == 0:
            for when in range(1):  # START; a constant argument would be compiled once more
                read_links(when, n, states[0 if two_way else row + 2], links, factors)
                if not spring and find_pieces(0.0, edges, sliders, points, indices):
                    evaluate_chain_surface(
                        when,
                        4 * step + 4,
                        dt,
                        gravity,
                        codes,
                        table,
                        edges,
                        factors,
                        local,
                        stamp,
                        sliders,
                        feet,
                        points,
                        contacts,
                        indices,
                    )
            sample(every * dt, codes, sliders, feet, points, contacts, indices, factors, places, samples, heights,
                   pressures, deflections, sums, before, tally)  # fmt: skip
    return lay.DONE
