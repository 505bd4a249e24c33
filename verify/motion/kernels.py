"""The compiled loop of a slider on a given surface, step by step."""

from verify.arrays import Array
from verify.jit import jit
from verify.motion import records as rec
from verify.motion.friction_kernels import friction, give, slip
from verify.motion.records import Given, Rider, Space
from verify.motion.surface_kernels import between, touch
from verify.motion.way_kernels import advance, until_caught, way


@jit
def slide_given(n_steps: int, dt: float, given: Given, rider: Rider, kept: Array, space: Space) -> int:
    """Steps on a surface that is given at every half step, one-way; how many were done on its piece.

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
