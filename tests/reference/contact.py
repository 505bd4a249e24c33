"""Sliders on a beam or a straight chain as one system of stiff equations, with regularised friction, by scipy's Radau.

Coulomb's law is the limit of a tanh that rises over a speed `creep`, static friction a peak that falls over ten times
that speed, an elastic tangential contact a spring that relaxes to its limit of friction in a time `relaxation`. The
surface is a piecewise cubic times modes: Hermite elements, or the spline through the joints of rigid links. The
material under a point at x stands at X = x + (h/2) w'(x); a normal force acts square to the surface.

From verify come value types alone. `python -m tests.reference.contact` computes the table of `tests/dynamics/test_contact_grid.py`.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh
from scipy.optimize import root

from tests.reference import contact_cells as grid
from tests.reference.dense import CUBICS, Elements

READ = 0.123
TANH, COULOMB, STATIC = range(3)
PRESCRIBED, FOLLOWED, SPRINGS = range(3)
"""N = load; N = load + m times the acceleration of the surface under the slider; springs and dashpots that press."""


class Surface(NamedTuple):
    """Modes of unit mass: frequencies, rad/s, ends of the pieces, m, cubics (pieces, 4, modes) in metres of each."""

    omegas: np.ndarray
    edges: np.ndarray
    cubics: np.ndarray


def elements(beam, parts):
    """Equal Hermite elements."""
    nodes = np.linspace(0.0, beam.length, parts + 1)
    values, vectors = Elements(beam, nodes).modes
    length = nodes[1]
    cubics = [(CUBICS.T * (1.0, length, 1.0, length)) @ vectors[2 * e : 2 * e + 4] for e in range(parts)]
    return Surface(np.sqrt(values), nodes, np.array(cubics) / length ** np.arange(4)[:, None])


def links(beam, count):
    """Equal rigid links between hinges with springs EI/l, at small angles; spline through y + second difference / 12."""
    length = beam.length / count
    mass, stiffness = beam.mass_per_length * length, beam.bending_stiffness / length
    joints = np.eye(count + 1)[:, 1:-1]
    means, turns = 0.5 * (joints[1:] + joints[:-1]), np.diff(joints, axis=0) / length
    bends = np.diff(turns, axis=0)
    m = mass * means.T @ means + mass * length**2 / 12.0 * turns.T @ turns
    values, vectors = eigh(stiffness * bends.T @ bends, m)
    heights = joints @ vectors
    heights[1:-1] += np.diff(heights, 2, axis=0) / 12.0
    nodes = np.linspace(0.0, beam.length, count + 1)
    return Surface(
        np.sqrt(values), nodes, CubicSpline(nodes, heights, axis=0, bc_type="natural").c[::-1].swapaxes(0, 1)
    )


class Rider(NamedTuple):
    """Numbers of sliders, feet and points as arrays, SI; a slider without feet is one point."""

    mass: np.ndarray  # (sliders,)
    start: np.ndarray
    speed: np.ndarray  # initial, or prescribed
    free: np.ndarray  # 1 where the slider's speed follows from forces
    moves: np.ndarray  # 0 at a fixed position
    pull: np.ndarray
    load: np.ndarray  # of a point without feet
    owner: np.ndarray  # (points,)
    foot: np.ndarray  # (points,)
    place: np.ndarray  # from the slider
    arm: np.ndarray  # from the middle of the foot
    face: np.ndarray
    stiffness: np.ndarray
    dashpot: np.ndarray
    tangential: np.ndarray
    foot_mass: np.ndarray  # (feet,)
    foot_inertia: np.ndarray  # inf where it does not pitch
    foot_load: np.ndarray


def rider_of(beam, sliders, speeds, fixed):
    """Arrays of sliders; `speeds` are prescribed ones or None."""
    rows, feet, each = [], [], []
    for b, (s, v, stays) in enumerate(zip(sliders, speeds, fixed, strict=True)):
        load = s.mass * s.gravity + s.preload
        each.append((s.mass, s.position, s.speed if v is None else v, v is None, not stays, s.external_force, load))
        springs = s.contact is not None and s.contact.stiffness is not None
        for f in s.feet if springs else ():
            n, c, face = f.points, s.contact, -1.0 if f.face == "lower" else 1.0
            along = c.tangential_stiffness or 0.0
            places = f.length * ((np.arange(n) + 0.5) / n - 0.5)
            shared = c.stiffness / n, c.damping / n, along / n
            rows += [(b, len(feet), f.offset + place, place, face, *shared) for place in places]
            mass = s.mass / len(s.feet) if f.mass is None else f.mass
            inertia = mass * f.length**2 / 12.0 if f.pitches and n > 1 else np.inf
            feet.append((mass, inertia, (s.mass * s.gravity + face * s.preload) / len(s.feet)))
        if not springs:
            rows.append((b, 0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0))
    points = [np.array(column) for column in zip(*rows, strict=True)]
    bodies = [np.array(column, dtype=float) for column in zip(*each, strict=True)]
    return Rider(*bodies, *points, *(np.array(c) for c in (zip(*feet, strict=True) if feet else np.zeros((3, 0)))))


@njit(cache=True)
def shapes(x, d, edges, cubics):
    """d-th derivative of all modes at x."""
    e = min(max(np.searchsorted(edges, x) - 1, 0), len(edges) - 2)
    s, c = x - edges[e], cubics[e]
    if d == 0:
        return c[0] + s * (c[1] + s * (c[2] + s * c[3]))
    if d == 1:
        return c[1] + s * (2.0 * c[2] + 3.0 * s * c[3])
    return 2.0 * c[2] + 6.0 * s * c[3]


@njit(cache=True)
def looked(i, y, r, half, edges, cubics):
    """Of point i: generalised displacements across and along (modes,), slope, rise, slip, drift and pull without g."""
    n, b = cubics.shape[2], r.owner[i]
    q, rates, x, v = y[:n], y[n : 2 * n], r.start[b] + y[2 * n + 2 * b] + r.place[i], y[2 * n + 2 * b + 1]
    lever, tilted = half * r.face[i], shapes(x, 1, edges, cubics)
    at = x + lever * (q @ tilted)
    flat, first = shapes(at, 0, edges, cubics), shapes(at, 1, edges, cubics)
    slope, rise = q @ first, rates @ flat
    across = flat + slope * lever * tilted
    along = (slope * flat - lever * first) / np.hypot(1.0, slope)
    pull = rise * (rates @ first + (q @ shapes(at, 2, edges, cubics)) * v)
    bend = q @ shapes(x, 2, edges, cubics)
    return across, along, slope, rise, v - rates @ along, -slope * rise, pull, q @ flat, rates @ tilted, bend


@njit(cache=True)
def contact_forces(y, r, normal, given, law, mu, static, steep, creep, relaxation, half, edges, cubics):
    """(N, F, rate of the stretch) of all points; `given` normal forces where they do not come from springs."""
    n, m, b = cubics.shape[2], len(r.owner), len(r.mass)
    first = 2 * n + 2 * b
    push, rub, stretching = np.zeros(m), np.zeros(m), np.zeros(m)
    for i in range(m):
        _, _, slope, rise, slip, _, _, level, turn, bend = looked(i, y, r, half, edges, cubics)
        if normal == SPRINGS:
            f, lever, v = first + 4 * r.foot[i], half * r.face[i], y[2 * n + 2 * r.owner[i] + 1] * r.moves[r.owner[i]]
            depth = r.face[i] * (level - y[f] - r.arm[i] * y[f + 2])
            closing = rise + slope * (lever * turn + v * (1.0 + lever * bend)) - y[f + 1] - r.arm[i] * y[f + 3]
            if depth > 0.0:
                push[i] = max(r.stiffness[i] * depth + r.dashpot[i] * r.face[i] * closing, 0.0)
        else:
            push[i] = given[r.owner[i]]
        pressed = max(push[i], 0.0)
        if r.tangential[i] > 0.0:
            stretch = y[first + 4 * len(r.foot_mass) + i]
            rub[i] = r.tangential[i] * stretch
            excess = abs(rub[i]) - mu * pressed
            stretching[i] = -slip - (
                np.sign(stretch) * excess / (r.tangential[i] * relaxation) if excess > 0.0 else 0.0
            )
            if law == TANH:
                share = min(max(rub[i] / (mu * pressed + 1e-300), -1.0 + 1e-9), 1.0 - 1e-9)
                stretching[i] = -slip - np.arctanh(share) / steep
        elif law == TANH:
            rub[i] = -mu * pressed * np.tanh(steep * slip)
        else:
            peak = (static - mu) * np.exp(-((slip / (10.0 * creep)) ** 2)) if law == STATIC else 0.0
            rub[i] = -pressed * (mu + peak) * np.tanh(slip / creep)
    return push, rub, stretching


@njit(cache=True)
def rates_under(
    y, load, r, push, rub, stretching, two_way, normal, following, gravity, damping, omegas, half, edges, cubics
):
    """Rates of all states under contact forces and modal loads; impulses of friction and normal force last."""
    n, m, sliders = len(omegas), len(r.owner), len(r.mass)
    first = 2 * n + 2 * sliders
    out = np.zeros(len(y))
    out[:n] = y[n : 2 * n]
    out[n : 2 * n] = load - 2.0 * damping * omegas * y[n : 2 * n] - omegas**2 * y[:n]
    for b in range(sliders):
        out[2 * n + 2 * b] = y[2 * n + 2 * b + 1] * r.moves[b]
        out[2 * n + 2 * b + 1] = r.free[b] * r.pull[b] / r.mass[b]
    for f in range(len(r.foot_mass)):
        at = first + 4 * f
        out[at], out[at + 1], out[at + 2] = y[at + 1], -r.foot_load[f] / r.foot_mass[f], y[at + 3]
    for i in range(m):
        across, along, slope, _, _, drift, pull, _, _, _ = looked(i, y, r, half, edges, cubics)
        b = r.owner[i]
        if two_way:
            out[n : 2 * n] -= rub[i] * along
            if normal != PRESCRIBED:
                out[n : 2 * n] -= push[i] * r.face[i] * across
        out[2 * n + 2 * b + 1] += r.free[b] * rub[i] / r.mass[b]
        if following:
            out[2 * n + 2 * b] += drift * r.moves[b]
            out[2 * n + 2 * b + 1] += r.free[b] * (pull - gravity * slope)
        if normal == SPRINGS:
            at = first + 4 * r.foot[i]
            out[at + 1] += r.face[i] * push[i] / r.foot_mass[r.foot[i]]
            out[at + 3] += r.face[i] * push[i] * r.arm[i] / r.foot_inertia[r.foot[i]]
        out[first + 4 * len(r.foot_mass) + i] = stretching[i]
        out[-2] += rub[i]
        out[-1] += push[i]
    return out


@njit(cache=True)
def climbing(y, r, following, half, edges, cubics):
    """Rate of the height of every slider's point on the surface, (sliders,)."""
    n, out = cubics.shape[2], np.zeros(len(r.mass))
    for i in range(len(r.owner)):
        _, _, slope, rise, _, drift, _, _, turn, bend = looked(i, y, r, half, edges, cubics)
        along = (y[2 * n + 2 * r.owner[i] + 1] + (drift if following else 0.0)) * r.moves[r.owner[i]]
        out[r.owner[i]] = rise + slope * (along + half * (bend * along + turn))
    return out


@njit(cache=True)
def rates(y, load, tick, r, two_way, normal, following, gravity, law, friction, damping, omegas, half, edges, cubics):
    """Rates of all states; a followed surface has the normal force of its acceleration, which is linear in it."""
    mu, static, steep, creep, relaxation = friction
    given, sliders = r.load.copy(), len(r.mass)
    if normal == FOLLOWED:
        accelerations = np.zeros((sliders + 1, sliders))
        for k in range(sliders + 1):  # without reactions, then with the unit load of each
            for b in range(sliders):
                given[b] = r.load[b] if k == b + 1 else 0.0
            push, rub, s = contact_forces(
                y, r, normal, given, law, mu, static, steep, creep, relaxation, half, edges, cubics
            )
            way = tick * rates_under(
                y, load, r, push, rub, s, two_way, normal, following, gravity, damping, omegas, half, edges, cubics
            )
            ahead, behind = (
                climbing(y + way, r, following, half, edges, cubics),
                climbing(y - way, r, following, half, edges, cubics),
            )
            accelerations[k] = (ahead - behind) / (2.0 * tick)
        matrix = np.eye(sliders)
        for k in range(sliders):
            matrix[:, k] -= r.mass * (accelerations[k + 1] - accelerations[0]) / r.load[k]
        given = np.linalg.solve(matrix, r.load + r.mass * accelerations[0])
    push, rub, s = contact_forces(y, r, normal, given, law, mu, static, steep, creep, relaxation, half, edges, cubics)
    return rates_under(
        y, load, r, push, rub, s, two_way, normal, following, gravity, damping, omegas, half, edges, cubics
    )


class Ran(NamedTuple):
    """Displacement of the first slider, m; impulses of all friction and normal forces, N s; deflection at READ, m."""

    displacement: float
    friction: float
    normal: float
    deflection: float


def ran(
    surface, beam, forces, hertz, sliders, duration, *, speeds, fixed, damping, soft, two_way, normal, law, creep=1e-5,
    relaxation=1e-8, rtol=1e-8,
):  # fmt: skip
    """A run from rest, or from equilibrium with two-way coupling; friction parameters are those of the first slider."""
    first, r, half = sliders[0], rider_of(beam, sliders, speeds, fixed), 0.5 * beam.thickness
    omegas, edges, cubics = surface
    n, following = len(omegas), first.kinematics == "following"
    static = first.mu if first.mu_static is None else first.mu_static
    friction = first.mu, static, first.steepness or 1.0, creep, relaxation
    push = [(f.amplitude, np.deg2rad(f.phase_deg), shapes(f.position, 0, edges, cubics)) for f in forces]
    tick = 1e-4 / omegas.max()

    def load(t):
        grown = 1.0 if t * hertz >= soft else (t * hertz / soft) ** 2 * (3.0 - 2.0 * t * hertz / soft)
        return sum(grown * f * np.cos(2.0 * np.pi * hertz * t + turn) * shape for f, turn, shape in push)

    def moved(t, y, loads=load):
        return rates(
            y, loads(t), tick, r, two_way, normal, following, first.gravity, law, friction, damping, omegas, half,
            edges, cubics,
        )  # fmt: skip

    y = np.zeros(2 * n + 2 * len(sliders) + 4 * len(r.foot_mass) + len(r.owner) + 2)
    y[2 * n + 1 : 2 * n + 2 * len(sliders) : 2] = r.speed
    y = at_rest(
        y,
        r,
        omegas[0],
        n,
        two_way and normal != PRESCRIBED,
        law != TANH,
        lambda y: moved(0.0, y, lambda t: 0.0 * omegas),
    )
    for begin, end in ((0.0, min(soft / hertz, duration)), (soft / hertz, duration)):
        if end > begin:
            y = solve_ivp(moved, (begin, end), y, method="Radau", rtol=rtol, atol=1e-13, max_step=0.02 / hertz).y[:, -1]
    return Ran(*map(float, (y[2 * n], y[-2], y[-1], shapes(READ, 0, edges, cubics) @ y[:n])))


def at_rest(y, r, omega, n, sags, creeps, accelerations):
    """The state in which beam and feet have no acceleration; a beam without reaction stays straight.

    With Coulomb's law sliders at rest creep (`creeps`) as slowly as regularised friction holds them. `omega` is the first
    frequency, rad/s, which gives the unit of displacements.
    """
    places, speeds = 2 * n + 2 * len(r.mass) + 4 * np.arange(len(r.foot_mass)), 2 * n + 1 + 2 * np.arange(len(r.mass))
    speeds = speeds[(r.free > 0.0) & (y[speeds] == 0.0)] if creeps else speeds[:0]
    pitches = places[np.isfinite(r.foot_inertia)] + 2
    unknown = np.concatenate([np.arange(n) if sags else speeds[:0], places, pitches, speeds]).astype(int)
    if not len(unknown):
        return y
    still = y.copy()
    still[2 * n + 1 : 2 * n + 2 * len(r.mass) : 2] = 0.0
    for f, at in enumerate(places):
        own = r.foot == f
        still[at] = -r.foot_load[f] / r.stiffness[own].sum()
    rows = np.concatenate([unknown[unknown < n] + n, places + 1, pitches + 1, speeds]).astype(int)

    def residual(part):
        state = still.copy()
        state[unknown] = part
        return accelerations(state)[rows]

    unit = np.where(np.isin(unknown, speeds), 1e-6, r.load.sum() / omega**2)
    scale = max(abs(residual(still[unknown])).max(), r.load.sum() / r.mass.sum())
    part = still[unknown] / unit
    for _ in range(8):  # hybrd stops at its own idea of progress
        found = root(lambda part: residual(part * unit) / scale, part, tol=1e-15)
        part = found.x
    assert abs(found.fun).max() < 1e-9, f"no equilibrium, {abs(found.fun).max():.2g}"
    y[unknown] = part * unit
    return y


TABLE = Path(__file__).with_name("contact.json")
CREEPS = {grid_size: (2e-7 * grid_size, 1e-6 * grid_size) for grid_size in (1.0, grid.SMALL)}
"""Creep, m/s, of a value and of the one that shows its uncertainty; relaxations, s, are 1e-3 of these over 1 m/s."""


def reference(cell, creep, relaxation):
    """The run of a cell."""
    speed, stays = grid.prescribed(cell)
    bodies, on_beam, two_way = grid.sliders(cell), cell.surface == "beam", cell.coupling == "two-way"
    normal = {"prescribed": PRESCRIBED, "bilateral": FOLLOWED if two_way else PRESCRIBED,
              "unilateral": SPRINGS, "hard": FOLLOWED}[cell.normal]  # fmt: skip
    law = {"tanh": TANH, "coulomb": COULOMB, "static": STATIC, "elastic": COULOMB}[cell.law]
    surface = elements(grid.STRIP, grid.PARTS["beam"]) if on_beam else links(grid.STRIP, grid.PARTS["chain"])
    return ran(
        surface, grid.STRIP, grid.forces(cell), grid.HERTZ, bodies, grid.DURATION, speeds=[speed] * len(bodies),
        fixed=[stays] * len(bodies), damping=grid.DAMPING if on_beam else 0.0, soft=2.0 if on_beam else 0.0,
        two_way=two_way, normal=normal, law=law, creep=creep, relaxation=relaxation,
    )  # fmt: skip


def line(cell):
    """(Name, values, uncertainties) of a cell."""
    creeps = CREEPS[cell.size]
    try:
        value, other = (reference(cell, creep, 1e-2 * creep / cell.size) for creep in creeps)
    except AssertionError as error:
        print(cell, error, file=sys.stderr)
        return str(cell), [np.nan] * 4, [np.nan] * 4
    return str(cell), value, [abs(a - b) for a, b in zip(value, other, strict=True)]


if __name__ == "__main__":
    table, chosen = json.loads(TABLE.read_text()) if TABLE.exists() else {}, sys.argv[1:]
    cells = [
        c for c in grid.CELLS if not grid.refused(c) and all(w in c for w in chosen) and (str(c) not in table or chosen)
    ]
    with ProcessPoolExecutor() as pool:
        for name, value, uncertainty in pool.map(line, cells):
            table[name] = {
                "value": [float(f"{v:.9g}") for v in value],
                "uncertainty": [float(f"{u:.2g}") for u in uncertainty],
            }
            print(name, table[name], flush=True)
            TABLE.write_text(
                "{\n" + ",\n".join(f"{json.dumps(n)}: {json.dumps(table[n])}" for n in sorted(table)) + "\n}\n"
            )
