"""The compiled loop: steps of beam, sliders and feet."""

import math

from verify.arrays import Array
from verify.contact import laws
from verify.contact.points import slip_of
from verify.contact.solver import solve
from verify.contact.state import BILATERAL, SPRING, Bodies, Kind, Record, Response
from verify.dynamics.columns import (
    apply_forces,
    filter_rates,
    rotate_half,
    set_factors,
    set_mean_rates,
    set_response,
    shift_factors,
)
from verify.dynamics.recording import add_sums, sample, write_events
from verify.dynamics.state import (
    DONE,
    END,
    HALF,
    MIDDLE,
    NOT_FINITE,
    OFF_PIECES,
    RATE,
    START,
    VALUE,
    Accounts,
    Beam,
    Harmonic,
    Journal,
)
from verify.dynamics.surface import AHEAD, evaluate_surface, find_pieces, set_start_speeds
from verify.jit import FAST, inline, jit, once

POWERS = (1.0 / 6.0, 4.0 / 6.0, 3.0 / 6.0, -2.0 / 6.0)
"""Weights of powers at the start, in mid-step, at the end with the step's contact forces and, last, without them.

Simpson's rule has 1/6, 4/6, 1/6. Contact forces add half as much to a rate in mid-step as at the end, where both values
are known: 4/6 of a half of the difference are 2/6 more with them and 2/6 less without. That is exact for the power of
the drive, which is linear in the rates; the quadratic loss of modes misses a quarter of the square of what they add."""
AT_REST = 1e-13  # Slip, over the speeds of which it is a difference, at which a point moves with the surface


@inline(fastmath=FAST)
def add_powers(
    when: int, weight: float, time: float, harmonic: Harmonic, factors: Array, accounts: Accounts, balance: Record
) -> None:
    """Add the drive's power and the loss of all coordinates, with a weight in seconds, to the balance."""
    forced, loads, rates, grown = accounts.forced, accounts.loads, accounts.rates, 0.0
    angle, part = harmonic.omega * (harmonic.origin + time), time / harmonic.unit
    c, s, first = math.cos(angle), math.sin(angle), factors.shape[2] - forced.shape[0]
    for d in range(len(accounts.growth) - 1, -1, -1):
        grown = grown * part + accounts.growth[d]
    for j in range(len(rates)):
        rates[j] = factors[when, RATE, j] if first > 0 else 0.0
    for d in range(forced.shape[0]):
        rate = factors[when, RATE, first + d]
        for j in range(len(rates)):
            rates[j] += forced[d, j] * rate
    driven, lost, resisted = 0.0, 0.0, 0.0
    for j in range(len(rates)):
        loss = loads[2, j] * rates[j] * rates[j]
        driven += (loads[0, j] * c - loads[1, j] * s) * rates[j]
        lost += loss
        resisted += loads[3, j] * loss
    balance.driven += weight * grown * driven
    balance.lost += weight * lost
    balance.resisted += weight * resisted


@once
def begin_bodies(dt: float, spring: bool, bodies: Bodies) -> None:
    """Sliders with feet and feet to mid-step."""
    for b in range(bodies.sliders.shape[0] if spring else 0):
        slider = bodies.sliders[b]
        slider.x += 0.5 * dt * slider.v * slider.free
    for k in range(bodies.feet.shape[0]):
        foot = bodies.feet[k]
        foot.height += 0.5 * dt * foot.velocity_z
        foot.pitch += 0.5 * dt * foot.pitch_rate


@once
def update_point(i: int, dt: float, kind: Kind, bodies: Bodies) -> None:
    """State of the law of a point to the end of the step; without feet also the place of its slider."""
    point, contact, slider = bodies.points[i], bodies.contacts[i], bodies.sliders[bodies.points[i].slider]
    spring = kind.normal_law == SPRING
    if spring and not laws.stores_energy(point.law):
        return
    mean, normal = slider.v + 0.5 * slider.delta_v, max(contact.normal, 0.0)
    moves_along = kind.two_way and abs(contact.slip) <= AT_REST * (abs(mean) + abs(contact.surface))
    if spring or (slider.inverse_mass > 0.0 and contact.friction != 0.0 and not moves_along):
        others = contact.surface - contact.mean + contact.self_response * contact.friction
        slip = slip_of(dt, others, kind, slider, contact)
        mean = contact.surface + laws.update(slip, normal, slider, point, contact)
    if spring:
        return
    slider.x += dt * (mean * slider.free + slider.drift)
    if kind.normal_law == BILATERAL and point.mass > 0.0:
        contact.point_vz += dt * (contact.normal - point.load) / point.mass


@once
def end_bodies(dt: float, kind: Kind, bodies: Bodies) -> None:
    """Sliders and feet to the end of the step; a slider with one rigid point follows its law within the step."""
    spring = kind.normal_law == SPRING
    for i in range(bodies.points.shape[0]):
        update_point(i, dt, kind, bodies)
    for b in range(bodies.sliders.shape[0]):
        slider = bodies.sliders[b]
        slider.v += slider.delta_v
        slider.x += 0.5 * dt * slider.v * slider.free if spring else 0.0
    for k in range(bodies.feet.shape[0]):
        foot = bodies.feet[k]
        foot.velocity_z += foot.delta_vz
        foot.pitch_rate += foot.delta_pitch_rate
        foot.height += 0.5 * dt * foot.velocity_z
        foot.pitch += 0.5 * dt * foot.pitch_rate


@once
def close_step(time: float, dt: float, kind: Kind, bodies: Bodies, response: Response | None, journal: Journal) -> None:
    """Sums of the step that begins at `time`, its bodies at the end of it, its events."""
    add_sums(dt, kind, bodies, response, journal.sums, journal.balance[0], journal.slider_of_foot)
    end_bodies(dt, kind, bodies)
    write_events(time, dt, kind, bodies, journal.events, journal.progress[0])
    journal.progress[0].step += 1


@once
def advance_beam(
    last: int,
    time: float,
    dt: float,
    kind: Kind,
    beam: Beam,
    response: Response | None,
    accounts: Accounts,
    journal: Journal,
) -> None:
    """Factors at all instants of a step without its contact forces; `last` is END."""
    factors, balance = beam.surface.factors, journal.balance[0]
    for when in range(last + 1):
        if when == MIDDLE:
            continue
        if when > START:
            rotate_half(beam.rows)
            set_factors(when, time + AHEAD[when] * dt, beam)
        if accounts.kept:
            add_powers(when, dt * POWERS[when], time + AHEAD[when] * dt, beam.harmonic, factors, accounts, balance)
    if response is not None:
        filter_rates(dt, beam.n_complex, beam.rows.coarse, beam.surface.factors)
    set_mean_rates(dt, kind.normal_law == SPRING, beam.surface.factors)


@once
def evaluate_step(step: int, dt: float, kind: Kind, beam: Beam, bodies: Bodies) -> None:
    """The surface under all points: of feet in mid-step, else at the start, in the middle and at the end.

    Polynomials at the end are those at the start of the next step, where no contact force changes them.
    """
    spring = kind.normal_law == SPRING
    for when in range(beam.surface.factors.shape[0]):
        if when == HALF or (spring and when != MIDDLE):
            continue
        mark = 4 * step + (4 if when == END and not kind.two_way else when)
        evaluate_surface(when, mark, dt, kind, beam.surface, bodies)


@inline
def are_finite(surface: float, bodies: Bodies) -> bool:
    """Whether a factor of the surface and the places of all bodies are finite."""
    total = surface
    for b in range(bodies.sliders.shape[0]):
        total += bodies.sliders[b].x + bodies.sliders[b].v
    for k in range(bodies.feet.shape[0]):
        total += bodies.feet[k].height + bodies.feet[k].pitch
    return math.isfinite(total)


@once
def begin_record(start: int, dt: float, kind: Kind, beam: Beam, bodies: Bodies, journal: Journal) -> None:
    """The surface at the start of a run, and the sample there: points without feet carry their loads."""
    if find_pieces(0.0, beam.surface.edges, bodies):
        evaluate_surface(start, start, dt, kind, beam.surface, bodies)
    for i in range(bodies.points.shape[0]):
        bodies.contacts[i].normal = bodies.points[i].load
    sample(math.inf, kind, bodies, beam.surface.factors, journal)


@jit
def advance(
    n_steps: int,
    every: int,
    dt: float,
    kind: Kind,
    beam: Beam,
    bodies: Bodies,
    response: Response | None,
    accounts: Accounts,
    journal: Journal,
) -> int:
    """Advance beam and sliders by up to n_steps from step `journal.progress`; why it returns.

    With no steps it records the initial state. Time is the number of the step times dt. All arrays are advanced in
    place, together, so that they agree whenever the caller is interrupted.
    """
    surface, progress, balance = beam.surface, journal.progress[0], journal.balance[0]
    spring, last = kind.normal_law == SPRING, surface.factors.shape[0] - 1  # a constant would be compiled once more
    set_factors(last, progress.step * dt, beam)
    shift_factors(surface.factors)
    if n_steps == 0:
        begin_record(last - END, dt, kind, beam, bodies, journal)
    for _ in range(n_steps):
        step, time = progress.step, progress.step * dt
        if not find_pieces(0.5 * dt if spring else 0.0, surface.edges, bodies):
            return OFF_PIECES
        advance_beam(last, time, dt, kind, beam, response, accounts, journal)
        begin_bodies(dt, spring, bodies)
        evaluate_step(step, dt, kind, beam, bodies)
        if response is not None:
            set_response(dt, kind, beam, bodies, response)
        solve(dt, kind, bodies, response, balance)
        if response is not None:
            apply_forces(kind, beam, bodies, response.shapes)
            set_factors(last, time + dt, beam)
        close_step(beam.harmonic.origin + time, dt, kind, bodies, response, journal)
        if accounts.kept:
            add_powers(
                last, dt * POWERS[MIDDLE], time + dt, beam.harmonic, surface.factors, accounts, journal.balance[0]
            )
        if response is not None:
            filter_rates(dt, beam.n_complex, beam.rows.coarse, surface.factors)
        shift_factors(surface.factors)
        if not are_finite(surface.factors[START, VALUE, 0], bodies):
            return NOT_FINITE
        if (step + 1) % every == 0:
            if not spring and find_pieces(0.0, surface.edges, bodies):
                set_start_speeds(last - END, 4 * step + 4, surface, bodies)
            sample(every * dt, kind, bodies, surface.factors, journal)
    return DONE
