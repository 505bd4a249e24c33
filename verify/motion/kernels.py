"""The compiled loop of a slider on a moving surface, step by step: what `stepping` feeds and the chain's `ride` too."""

import numpy as np

from verify.arrays import Array
from verify.jit import inline, jit
from verify.motion import records as rec
from verify.motion.books_kernels import account, by_parts, correct_powers, loss, power, pulled
from verify.motion.contact_kernels import feel, push_back, set_levers, set_reads
from verify.motion.friction_kernels import friction, give, slip
from verify.motion.records import Books, Given, Here, Kept, Law, Rider, Space, Surface
from verify.motion.surface_kernels import between, climb, find_piece, rotate_half, set_factors, set_local, touch
from verify.motion.way_kernels import advance, felt_way, until_caught, way


@inline(forceinline=True)
def _see(
    row: int,
    time: float,
    x: float,
    v: float,
    piece: int,
    fresh: bool,
    surface: Surface,
    law: Law,
    books: Books,
    space: Space,
) -> None:
    """Fill one row of `space.seen`: the surface at x and, with open books, the powers of drive and damping."""
    factors, local, seen = space.factors, space.local, space.seen
    if fresh:
        set_factors(time, surface.modes, surface.drive, factors)
        set_local(surface.table, piece, factors, local)
    touch(local, surface.edges, piece, x, v, law, seen, row)
    if books.open:
        seen[row, rec.POWER] = power(surface.drive, books, time, factors)
        seen[row, rec.LOSS] = loss(surface.modes, books.answers, factors)


@inline
def _correct_pull(dt: float, x: float, v: float, piece: int, edges: Array, law: Law, space: Space) -> None:
    """Inertia and drift along the surface at the end of a step with what the contact has added, half at mid-step."""
    seen = space.seen
    surface, pull, drift = seen[2, rec.SURFACE], seen[2, rec.PULL], seen[2, rec.DRIFT]
    touch(space.local, edges, piece, x, v, law, seen, rec.AT_END)
    seen[2, rec.SURFACE] = surface
    seen[1, rec.DRIFT] += 0.5 * (seen[2, rec.DRIFT] - drift)
    space.slip[rec.GIVEN_END] += 0.5 * dt * (seen[2, rec.PULL] - pull)


@inline
def _answer(
    end: float, dt: float, x: float, v: float, here: Here, surface: Surface, rider: Rider, books: Books, space: Space
) -> tuple[float, float]:
    """The beam feels the slider, which is seen at x with speed v at the end of the step; works of `push_back`."""
    motion, law = rider.motion, rider.law
    if law.held:
        set_reads(surface, here.piece, space.local, x, law.half)
    else:
        feel(dt, motion, law, space.seen)
    works = push_back(motion[rec.V], motion[rec.STUCK] > 0.0, dt, here, surface, rider, space)
    if law.held:
        fall = (law.load - motion[rec.NORMAL]) / law.mass
        motion[rec.FALL] = fall if fall > motion[rec.FALL] else motion[rec.FALL]
    set_factors(end, surface.modes, surface.drive, space.factors)
    if books.open:
        correct_powers(end, surface, books, space)
    if law.following:
        set_local(surface.table, here.piece, space.factors, space.local)
        _correct_pull(dt, x, v, here.piece, surface.edges, law, space)
    return works


@inline(forceinline=True)
def _starts(v: float, grip: float, dt: float, two_way: bool | None, seen: Array) -> float:
    """The slider's acceleration at the start of a step, by which its place in the step is foreseen."""
    if two_way is None:
        grip = until_caught(grip, v - seen[0, rec.SURFACE], dt)
    return float(seen[0, rec.PULL] + grip)


@inline(forceinline=True)
def _step(
    number: int,
    dt: float,
    piece: int,
    fresh: bool,
    looking: bool,
    two_way: bool | None,
    surface: Surface,
    rider: Rider,
    books: Books,
    space: Space,
) -> None:
    """One step of beam and slider, or its first row alone where one only looks.

    `two_way` is the rider's, by itself so that numba drops what a step has not.
    """
    motion, law, seen = rider.motion, rider.law, space.seen
    x, v, stuck = motion[rec.X], motion[rec.V], motion[rec.STUCK] > 0.0
    here, pressed, lifted, x1, v1, grip, rate, along = Here(piece, 0.0, 0.0, 0.0), 0.0, 0.0, x, v, 0.0, 0.0, 0.0
    for row in range(1 if looking else 3):
        t = 0.5 * row * dt
        if row > 0:
            rotate_half(surface.modes)
            x1, v1 = x + t * along + 0.5 * t * t * rate, v + t * rate
        _see(row, (number + 0.5 * row) * dt, x1, v1, piece, fresh or row > 0, surface, law, books, space)
        if row == 0:
            grip = 0.0 if stuck else friction(v - seen[0, rec.SURFACE], law.static, law)
            rate, along = _starts(v, grip, dt, two_way, seen), v + seen[0, rec.DRIFT]
        if two_way is not None and row == 0:
            for d in range(space.local.shape[1]):
                space.local[rec.BEFORE, d] = space.local[rec.STILL, d]
        if two_way is not None and row == 1:
            here = set_levers(surface, piece, space.local, x1, law.half)
    if looking:  # height, climb and load of a slider that is put on
        seen[2, rec.SURFACE] = seen[0, rec.SURFACE]
        motion[rec.HEIGHT], motion[rec.NORMAL] = seen[0, rec.LEVEL], law.load
        motion[rec.CLIMB] = climb(space.local, surface.edges, piece, x, v + seen[0, rec.DRIFT], law.half)
        return
    give(dt, seen, space.slip)
    if two_way is not None:
        pressed, lifted = _answer((number + 1) * dt, dt, x1, v1, here, surface, rider, books, space)
        moved = felt_way(v, stuck, rate, dt, law, seen, space.slip)
    else:
        feel(dt, motion, law, seen)
        slip(v, stuck, 0.0, 0.0, 0.0, law.static, law, dt, space)
        moved = way(v, rate, dt, law.slope, law, seen, space.slip)
    advance(moved, grip, dt, law.slope, law, motion, seen, space.slip)
    if books.open:
        turned, spared = 0.0, 0.0
        if law.following:
            turned, spared = pulled(v, motion[rec.V], moved, dt, law.mass, seen, space.slip)
        if two_way is None:
            pressed = by_parts(v, motion[rec.V], moved, dt, law.mass, seen) + spared
        account(v, motion[rec.V], pressed, turned, dt, law.mass, books.ledger, seen)
        books.ledger[rec.LIFTED] += lifted


@jit
def slide(n_steps: int, dt: float, surface: Surface, rider: Rider, books: Books, kept: Kept, space: Space) -> int:
    """Advance beam and slider by up to n_steps from step number tally[STEP]; why it came back.

    No steps: it sets the slider's height and climb, and keeps one sample as it stands, without friction if it sticks.
    Time is the step's number times dt. Modes, motion, ledger and tally are advanced in place, together, so that they
    agree whenever the caller is interrupted.
    """
    motion, tally, took = rider.motion, kept.tally, space.slip
    piece, fresh, looking = rec.NOUGHT, True, n_steps == 0
    for _ in range(1 if looking else n_steps):
        here = find_piece(surface.edges, motion[rec.X], piece)
        if here < 0:
            return rec.OFF_PIECES
        fresh = fresh or here != piece or rider.two_way is not None
        piece, number = here, tally[rec.STEP]
        _step(number, dt, piece, fresh, looking, rider.two_way, surface, rider, books, space)
        fresh = False
        tally[rec.STEP] += not looking
        if not np.isfinite(motion[rec.V] + space.factors[rec.STILL, 0]):
            return rec.NOT_FINITE
        if took[rec.N_EVENTS] > 0.0:
            began = surface.drive.origin + number * dt
            for i in range(int(took[rec.N_EVENTS])):  # all are counted, as many recorded as there is room for
                row, at = tally[rec.EVENTS], rec.FIRST_EVENT + 2 * i
                if row < len(kept.events):
                    kept.events[row, 0], kept.events[row, 1] = began + took[at], took[at + 1]
                    kept.events[row, 2] = motion[rec.X]
                tally[rec.EVENTS] += 1
        if tally[rec.STEP] % kept.every == 0:
            _keep(dt, motion, rider.law, kept, space)
            tally[rec.SAMPLES] += 1
    return rec.DONE


@inline
def _keep(dt: float, motion: Array, law: Law, kept: Kept, space: Space) -> None:
    """Write one sample; friction that sticks is the step's mean."""
    surface, row, points, rows = space.seen[2, rec.SURFACE], kept.tally[rec.SAMPLES], kept.points, kept.kept
    rows[row, rec.KEPT_X], rows[row, rec.KEPT_V], rows[row, rec.KEPT_SURFACE] = motion[rec.X], motion[rec.V], surface
    rows[row, rec.KEPT_NORMAL] = motion[rec.NORMAL]
    mean = space.slip[rec.CHANGE] / dt
    rows[row, rec.KEPT_FRICTION] = (
        mean if motion[rec.STUCK] > 0.0 else friction(motion[rec.V] - surface, law.static, law)
    )
    for p in range(points.shape[0]):
        total = 0.0
        for j in range(points.shape[1]):
            total += points[p, j] * space.factors[rec.STILL, j]
        kept.deflections[row, p] = total


@jit
def slide_given(n_steps: int, dt: float, given: Given, rider: Rider, kept: Array, space: Space) -> int:
    """The same steps on a surface that is given at every half step, one way; how many were done on its piece.

    `kept` is (n_steps + 1, 4), `KEPT_X` and so on; friction that sticks is the step's mean.
    """
    motion, law, seen, edges = rider.motion, rider.law, space.seen, given.edges
    for number in range(n_steps + 1):
        x, v, stuck = motion[rec.X], motion[rec.V], motion[rec.STUCK] > 0.0
        if x < edges[0] or x > edges[1]:
            return number - 1 if number > 0 else 0
        touch(given.local[2 * number], edges, rec.NOUGHT, x, v, law, seen, rec.AT_START)
        seen[0, rec.SURFACE] += between(given.along[2 * number], edges, rec.NOUGHT, x)
        r = v - seen[0, rec.SURFACE]
        grip = 0.0 if stuck else friction(r, law.static, law)
        kept[number, rec.KEPT_X], kept[number, rec.KEPT_V], kept[number, rec.KEPT_SURFACE] = x, v, seen[0, rec.SURFACE]
        kept[number, rec.KEPT_FRICTION] = space.slip[rec.CHANGE] / dt if stuck else grip
        if number == n_steps:
            break
        rate, ahead = seen[0, rec.PULL] + until_caught(grip, r, dt), v + seen[0, rec.DRIFT]
        for row in range(1, 3):
            t, half = 0.5 * row * dt, 2 * number + row
            there = x + t * ahead + 0.5 * t * t * rate
            touch(given.local[half], edges, rec.NOUGHT, there, v + t * rate, law, seen, row)
            seen[row, rec.SURFACE] += between(given.along[half], edges, rec.NOUGHT, there)
        give(dt, seen, space.slip)
        slip(v, stuck, 0.0, 0.0, 0.0, law.static, law, dt, space)
        moved = way(v, rate, dt, law.slope, law, seen, space.slip)
        advance(moved, grip, dt, law.slope, law, motion, seen, space.slip)
    return n_steps
