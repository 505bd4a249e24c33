"""Compiled record of a run: samples, events, and the sums of works and losses over all steps."""

import math

from verify.arrays import Array, Indices
from verify.contact import laws
from verify.contact.normal import closing_speed
from verify.contact.state import (
    BILATERAL,
    LANDS,
    LEAVES,
    SLIPS,
    SPRING,
    STICKS,
    TURNS,
    Bodies,
    Kind,
    Path,
    Record,
    Records,
    Response,
)
from verify.dynamics.state import START, VALUE, Journal
from verify.jit import inline, jit, once


@once
def add_point(
    i: int,
    dt: float,
    mean: float,
    kind: Kind,
    bodies: Bodies,
    response: Response | None,
    total: Record,
    balance: Record,
) -> None:
    """Add works and losses of a point in contact; `mean` is the mean speed of its slider, m/s."""
    point, contact = bodies.points[i], bodies.contacts[i]
    spring, force, push = kind.normal_law == SPRING, contact.friction, contact.normal
    slope_vz = contact.slope_vz if spring else 0.0
    if not spring:
        fall = (contact.point_vz - contact.closing) / dt
        if kind.normal_law == BILATERAL and point.mass > 0.0:
            fall = (point.load - push) / point.mass
            total.load_work -= dt * point.load * (contact.point_vz - 0.5 * dt * fall)
            total.slope_work += dt * push * contact.slope * mean * bodies.sliders[point.slider].free
        total.max_fall = max(total.max_fall, fall)
    loss = dt * (contact.power if spring and response is None else -force * contact.slip)
    total.friction_loss += loss
    total.tangential_work += loss + dt * force * mean
    if loss < 0.0 and not laws.stores_energy(point.law):
        balance.created -= loss
    if response is not None:
        total.friction_on_beam -= dt * point.weight * force * contact.surface
    if kind.normal_two_way or spring:
        across = dt * push * point.face * (contact.vz - slope_vz)
        total.normal_work += across
        total.normal_on_beam -= point.weight * across
    if spring:
        closing = closing_speed(point, contact, bodies.feet[point.foot])
        total.slope_work += dt * push * point.face * slope_vz
        total.contact_loss += dt * (push - point.stiffness * contact.depth) * closing


@jit(no_cpython_wrapper=True)
def add_sums(
    dt: float,
    kind: Kind,
    bodies: Bodies,
    response: Response | None,
    sums: Records,
    balance: Record,
    slider_of_foot: Indices,
) -> None:
    """Works, losses and integrals of the step; speeds of sliders and feet are still those of its start."""
    spring = kind.normal_law == SPRING
    for b in range(bodies.sliders.shape[0]):
        slider, total = bodies.sliders[b], sums[b]
        force, normal, surface, touching, sticking, n = 0.0, 0.0, 0.0, 0, 0, 0
        mean = slider.v + 0.5 * slider.delta_v
        for i in range(bodies.points.shape[0]):
            contact = bodies.contacts[i]
            if bodies.points[i].slider != b:
                continue
            n += 1
            if spring and contact.depth <= 0.0:
                continue
            add_point(i, dt, mean, kind, bodies, response, total, balance)
            force, normal = force + contact.friction, normal + contact.normal
            if contact.normal > 0.0 or not spring:
                surface, touching = surface + contact.surface, touching + 1
            sticking += 1 if contact.sticks > 0.0 else 0
        if slider.inverse_mass > 0.0:
            total.slope_work += dt * mean * slider.tilt / slider.inverse_mass
        total.external_work += dt * mean * (slider.external_force if slider.inverse_mass > 0.0 else -force)
        total.friction_time += dt * force
        total.normal_time += dt * normal
        total.touch_time += dt * touching / n
        total.stick_time += dt * sticking / n
        total.surface_time += dt * surface / max(touching, 1)
        total.max_friction = max(total.max_friction, abs(force))
    for k in range(bodies.feet.shape[0]):
        foot = bodies.feet[k]
        load = foot.load - foot.spring_rate * foot.height
        sums[slider_of_foot[k]].load_work += dt * load * (foot.velocity_z + 0.5 * foot.delta_vz)


@inline
def add_event(time: float, kind: float, i: int, bodies: Bodies, events: Array, progress: Record) -> None:
    """Count an event of point i, and record it while there is room."""
    row = progress.events
    if row < events.shape[0]:
        event = events[row]
        event[0], event[1], event[2], event[3] = time, kind, i, bodies.sliders[bodies.points[i].slider].x
    progress.events = row + 1


@jit(no_cpython_wrapper=True)
def write_events(time: float, dt: float, kind: Kind, bodies: Bodies, events: Array, progress: Record) -> None:
    """Events of the step that begins at `time`; of feet, landings by the line through both depths, in mid-step."""
    for i in range(bodies.points.shape[0]):
        contact = bodies.contacts[i]
        if kind.normal_law != SPRING:
            for e in range(contact.events):
                if contact.event_kind[e] != TURNS:
                    add_event(time + contact.event_share[e] * dt, contact.event_kind[e], i, bodies, events, progress)
            continue
        depth, before, sticks = contact.depth, contact.depth_before, contact.sticks > 0.0
        if (depth > 0.0) != (before > 0.0):
            share = 0.5 - depth / (depth - before)
            add_event(time + share * dt, LANDS if depth > 0.0 else LEAVES, i, bodies, events, progress)
        elif depth > 0.0 and sticks != (contact.sticks_before > 0.0):
            add_event(time, STICKS if sticks else SLIPS, i, bodies, events, progress)


@inline
def friction_now(slider: Record, point: Record, contact: Record) -> float:
    """Friction of a point without foot at the instant of a sample, N: the law, or the last mean where it sticks."""
    if contact.sticks > 0.0:
        return float(contact.friction)
    slip, normal = slider.v - contact.start, max(contact.normal, 0.0)
    path = Path(slip, slip, 0.0, 0.0, math.inf, 0.0, 0.0)
    return laws.slope(path, normal, slider, point, contact)[1] if slip != 0.0 else 0.0


@jit(no_cpython_wrapper=True)
def sample(span: float, kind: Kind, bodies: Bodies, factors: Array, journal: Journal) -> None:
    """Record the state at the end of a step, and means over the interval of that many seconds."""
    row, spring = journal.progress[0].samples, kind.normal_law == SPRING
    for b in range(bodies.sliders.shape[0]):
        slider, sample, total, before = (
            bodies.sliders[b],
            journal.samples[row, b],
            journal.sums[b],
            journal.sums_before[b],
        )
        sample.travelled, sample.speed = slider.x, slider.v
        sample.friction = (total.friction_time - before.friction_time) / span
        sample.normal_force = (total.normal_time - before.normal_time) / span
        sample.contact_fraction = (total.touch_time - before.touch_time) / span
        sample.stick_fraction = (total.stick_time - before.stick_time) / span
        sample.friction_loss = total.friction_loss - before.friction_loss
        sample.tangential_work = total.tangential_work - before.tangential_work
        journal.sums_before[b] = total
        speed, n = 0.0, 0
        for i in range(bodies.points.shape[0]):
            point, contact = bodies.points[i], bodies.contacts[i]
            if point.slider != b:
                continue
            surface, journal.pressures[row, i] = contact.surface, contact.normal
            if not spring:
                surface, sample.normal_force = contact.start, contact.normal
                sample.friction = friction_now(slider, point, contact)
            if contact.normal > 0.0 or not spring:
                speed, n = speed + surface, n + 1
        sample.surface_speed = speed / n if n > 0 else math.nan
    for k in range(bodies.feet.shape[0]):
        journal.heights[row, k, 0], journal.heights[row, k, 1] = bodies.feet[k].height, bodies.feet[k].pitch
    for p in range(journal.places.shape[0]):
        total_at = 0.0
        for j in range(journal.places.shape[1]):
            total_at += journal.places[p, j] * factors[START, VALUE, j]
        journal.deflections[row, p] = total_at
    journal.progress[0].samples = row + 1
