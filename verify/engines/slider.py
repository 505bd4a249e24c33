"""A slider beside the motion of an engine's chain, one-way: Eq. (3) with the surface speed of that chain under it."""

from functools import lru_cache
from math import ceil

import numpy as np
from scipy.interpolate import CubicSpline

from verify.arrays import Array
from verify.engines.base import Chain, Run
from verify.errors import InputError
from verify.jit import jit
from verify.problem.slider import Slider
from verify.segment_model import SegmentModel
from verify.segments.reading import contact_line

STEPS = 128
"""Steps of the slider a drive period: error 6e-6 on the paper's beam."""
STAYS = 1e-3
"""Largest displacement over the length of a link; the surface is read at the first position."""


def displacement(chain: Chain, run: Run, slider: Slider) -> tuple[Array, Array]:
    """(times, displacements of the slider), (n + 1,) each, s and m. Raises InputError for one that moves far."""
    end = float(run.times[-1])
    n = ceil(STEPS * chain.frequency_hz * end)
    half_steps = np.linspace(0.0, end, 2 * n + 1)
    speeds = CubicSpline(run.times, surface_speed(chain, run, slider.initial_position(chain.rigid.beam)))(half_steps)
    rate, steepness = slider.mu * slider.normal_force / slider.mass, slider.steepness or 0.0
    moved = slide(speeds, end / n, rate, steepness, slider.speed, np.zeros(n + 1))
    if not abs(moved).max() <= STAYS * chain.rigid.links[0].length:
        raise InputError(f"engines: the slider moves by {abs(moved).max():.2g} m, give a shorter duration")
    return half_steps[::2], moved


def surface_speed(chain: Chain, run: Run, x: float) -> Array:
    """Speed of the surface along its tangent at x, (m,), m/s, as of `dynamics`."""
    lengths, lever = np.array([link.length for link in chain.rigid.links]), chain.rigid.beam.surface_distance
    shapes = contact_shapes(chain, x)
    slope = (lengths * np.sin(run.angles)) @ shapes[:, 1]
    rise, turn, bend = ((lengths * np.cos(run.angles) * run.rates) @ shapes).T
    # the material over x is at x + lever slope of the mid-line
    return np.asarray((slope * rise - lever * (turn + lever * slope * bend)) / np.hypot(1.0, slope))


@lru_cache(maxsize=4)
def contact_shapes(chain: Chain, x: float) -> Array:
    """Contact line at x and its first two derivatives per unit transverse step of every link, (N, 3)."""
    n = chain.rigid.count
    up = np.triu(np.ones((n, n + 1)), 1)  # a step of one link displaces all joints after it
    line = contact_line(SegmentModel(chain.rigid.beam, n).chain, up)
    return np.hstack([line([x], derivative) for derivative in range(3)])


@jit
def slide(speeds: Array, dt: float, rate: float, steepness: float, speed: float, moved: Array) -> Array:
    """Displacements (n + 1,) under v' = -rate tanh(steepness (v - u)), u at half steps (2 n + 1,), by RK4."""
    x, v = 0.0, speed
    for k in range(moved.size - 1):
        u, middle, last = speeds[2 * k], speeds[2 * k + 1], speeds[2 * k + 2]
        one = -rate * np.tanh(steepness * (v - u))
        two = -rate * np.tanh(steepness * (v + 0.5 * dt * one - middle))
        three = -rate * np.tanh(steepness * (v + 0.5 * dt * two - middle))
        four = -rate * np.tanh(steepness * (v + dt * three - last))
        x += dt * v + dt * dt / 6.0 * (one + two + three)
        v += dt / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        moved[k + 1] = x
    return moved
