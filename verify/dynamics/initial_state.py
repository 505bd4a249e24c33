"""Initial states of beam and sliders: static equilibrium of beam and feet, steady state with attached mass."""

from collections.abc import Callable

import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray
from verify.dynamics.excitation import RESONANCE
from verify.dynamics.linear_system import Stage
from verify.dynamics.stepping import Assembly
from verify.errors import InputError
from verify.linear.time_basis import Ratio, TimeBasis

PASSES = 40
"""Most iterations of an equilibrium. The compliance of the unloaded beam is that of the loaded one up to the rotation
of its surface, so that a few iterations end in practice."""
SETTLED = 1e-14
"""Change of the surface, over its largest displacement or that by all forces in one sense where those of a clasp
cancel, at which an equilibrium is at its rounding."""
CLOSE = 1e-9  # The same above which there is none: an iteration may end in rounding above `SETTLED`, but not there


def equilibrium(assembly: Assembly, surface: Callable[[Array, Array], tuple[Array, Array]], compliance: Array) -> Array:
    """Bring sliders and surface to static equilibrium, in which the points of a foot carry it without a moment.

    `surface` gives (level, slope) of the material under every point, (points,), m, under normal forces and friction;
    `compliance` (points, points), m/N, is its approximate derivative: the decrease of a depth by a unit normal force.
    Springs press but do not pull. Sets the pitches of the feet; returns the depth, (feet,), m, that a foot between two
    beams gains by its preload. Raises InputError for a foot without load and without an equilibrium.
    """
    p, feet, foot = assembly.points, assembly.feet, assembly.points["foot"]
    place, normal = np.zeros((len(feet), 3)), np.array(p["load"])
    if len(feet):  # at first all points of a foot share its load, or its preload between two beams
        normal = ((abs(feet["load"]) + np.bincount(foot, p["inset"] * p["stiffness"])) / np.bincount(foot))[foot]
    friction, level = 0.0 * normal, np.full(len(normal), np.inf)
    between = _between(assembly)
    moves = np.transpose([~between, ~between & (assembly.feet["inverse_inertia"] > 0.0), between])
    for _ in range(PASSES):
        before, (level, slope) = level, surface(normal, friction)
        friction = _holding(assembly, normal, slope)
        if len(assembly.feet):
            depth = p["inset"] + p["face"] * p["image"] * level
            normal, place = _carried(assembly, depth + compliance @ normal, compliance, moves)
            assembly.feet["pitch"] = place[:, 1]
        change, size = abs(level - before).max(), max(abs(level).max(), (abs(compliance) @ normal).max())
        if change <= SETTLED * size:
            break
    if not change <= CLOSE * size:
        raise InputError(f"slider.preload: beam and slider have no equilibrium within {PASSES} iterations, lower it")
    return np.asarray(place[:, 2])


def _between(assembly: Assembly) -> BoolArray:
    """Which feet are between two beams that respond, (feet,): by symmetry they stay in the middle."""
    foot, weights = assembly.points["foot"], assembly.points["weight"]
    halved = np.bincount(foot, weights < 1.0, len(assembly.feet))[: len(assembly.feet)] > 0.0
    return np.asarray(halved & assembly.kind.normal_two_way)


def _holding(assembly: Assembly, normal: Array, slope: Array) -> Array:
    """Coulomb friction on sliders at rest, N: what holds them, or kinetic beyond the static limit; else none."""
    slider = assembly.points["slider"]
    rows, total = assembly.sliders, np.bincount(slider, normal)
    pull = rows["external_force"].copy()
    if assembly.kind.following:
        downhill = assembly.kind.gravity * assembly.points["mass"] * slope
        pull -= np.bincount(slider, downhill)
    pull[(rows["inverse_mass"] == 0.0) | (rows["v"] != 0.0) | (rows["steepness"] > 0.0)] = 0.0
    static, kinetic = rows["mu_static"] * total, rows["mu"] * total
    held = np.where(abs(pull) <= static, pull, np.clip(pull, -kinetic, kinetic))
    return np.asarray(-(held / np.where(total > 0.0, total, 1.0))[slider] * normal)


def _carried(assembly: Assembly, depth: Array, compliance: Array, moves: Array) -> tuple[Array, Array]:
    """(normal forces, places of the feet) on a linear surface that is at `depth` without them and feet at height 0.

    The depth of a point is depth - compliance N - B y with the places y of the feet, and N/k in contact; B^T N are the
    loads of the feet. `moves` (feet, 3) are the coordinates of the places that balance their loads. The set of points
    in contact is corrected until no point pulls and none without force is deep.
    """
    p, feet, foot = assembly.points, assembly.feet, assembly.points["foot"]
    n, m = len(p), len(feet)
    by_place, loads, springs = np.zeros((n, m, 3)), np.zeros((m, 3)), np.zeros((m, 3))
    by_place[np.arange(n), foot] = np.transpose([p["face"], p["face"] * p["arm"], -np.ones(n)])
    loads[:, 0], springs[:, 0] = -feet["load"], feet["spring_rate"]
    loads[:, 2] = -np.bincount(foot, p["inset"] * p["stiffness"])
    moved = moves.ravel()
    b, load, rate = by_place.reshape(n, -1)[:, moved], loads.ravel()[moved], springs.ravel()[moved]
    touching, normal, place = np.ones(n, dtype=bool), np.zeros(n), np.zeros(3 * m)
    for _ in range(4 * n + 4):
        if (np.bincount(foot, touching) == 0.0).any():
            number = int(np.bincount(foot, touching).argmin()) + 1
            raise InputError(f"slider.preload leaves foot {number} without load or off the beam: raise it")
        inner = np.diag(1.0 / p["stiffness"]) + compliance
        inner, sides = inner[np.ix_(touching, touching)], b[touching]
        matrix = np.block([[inner, sides], [sides.T, -np.diag(rate)]])
        # a foot on a single point may have any pitch: the least is taken
        found = np.linalg.lstsq(matrix, np.concatenate([depth[touching], load]), rcond=None)[0]
        normal[:], normal[touching], place[moved] = 0.0, found[: touching.sum()], found[touching.sum() :]
        left = depth - compliance @ normal - b @ place[moved]
        after = np.where(touching, normal > 0.0, left > 1e-12 * abs(depth).max())
        if (after == touching).all():
            return normal, place.reshape(m, 3)
        touching = after
    raise InputError("slider.preload: no set of points in contact carries the feet at rest, lower it")


def static_deflection(basis: TimeBasis, assembly: Assembly, stage: Stage) -> tuple[Array, Array]:
    """Static equilibrium under the sliders: modal amplitudes, (n,), sqrt(kg) m, and a rise of points, (points,), m.

    A normal force acts at the material point x + (h/2) w', square to the surface, and so has the moment (h/2) w' per
    unit force on the section. Between two beams the depth is increased until each carries the preload. The engine
    evaluates the surface under feet in the middle of a step and without its contact forces: the equilibrium under feet
    is one of the steps of the stage, with the rise of the surface that this makes. Sets the speed along that the
    contact forces of a step before would have cancelled.
    """
    p, x = assembly.points, assembly.start + assembly.points["offset"]
    side, lever, slopes = p["weight"], p["lever"], basis.shapes(x, 1)
    if len(assembly.feet):
        side = side * p["face"] * p["image"]
    dt, rows = stage.steps.dt if assembly.springs else 0.0, stage.rows

    def released(q: Array, seconds: float) -> Array:
        """Amplitudes after a time without contact forces."""
        return rows.state(rows.after(rows.of_state(q, 0.0 * q), seconds))[0][: len(q)] if dt else q

    def shapes(q: Array) -> tuple[Array, Array, Array]:
        """Generalised displacements of all points, normal and tangential, (n, points), and slopes, (points,)."""
        at = np.clip(x + lever * (q @ slopes), 0.0, basis.beam.length)
        flat, turned = basis.shapes(at, 0), basis.shapes(at, 1)
        slope = q @ turned
        return flat + lever * slope * slopes, (slope * flat - lever * turned) / np.hypot(1.0, slope), slope

    q = np.zeros(len(basis.omegas))

    def level(q: Array) -> Array:
        at = np.clip(x + lever * (q @ slopes), 0.0, basis.beam.length)
        return np.asarray(q @ basis.shapes(at, 0))

    def surface(normal: Array, friction: Array) -> tuple[Array, Array]:
        nonlocal q
        across, along, slope = shapes(released(q, 0.5 * dt))
        q = -(across @ (side * normal) + along @ (p["weight"] * friction)) / basis.omegas**2
        return level(released(q, 0.5 * dt)), slope

    gained = equilibrium(assembly, surface, compliance_of(basis, assembly))
    if len(assembly.feet):
        p["inset"] += gained[assembly.points["foot"]]
    if dt > 0.0:
        assembly.contacts["surface_before"] = (q - released(q, dt)) / dt @ shapes(released(q, 0.5 * dt))[1]
    return q, level(released(q, 0.5 * dt)) - level(q)


def compliance_of(basis: TimeBasis, assembly: Assembly) -> Array:
    """Decrease of the depth of every point by unit normal forces on a straight beam, (points, points), m/N."""
    p = assembly.points
    shapes = basis.shapes(assembly.start + p["offset"], 0) * p["face"] * p["image"]
    return np.asarray((shapes.T / basis.omegas**2) @ (shapes * p["weight"]))


def steady_with_mass(basis: TimeBasis, stage: Stage, assembly: Assembly, damping: Ratio) -> ComplexArray:
    """Modal response z to bilateral masses on a steady beam, at time 0 of the stage, (n,).

    W = W_0 + G m omega^2 W at all points: a mass exerts the force m omega^2 W. Raises InputError at a resonance.
    """
    omega, x = stage.omega, assembly.start + assembly.points["offset"]
    shapes, mass = basis.shapes(x, 0), assembly.points["mass"]
    compliance = 1.0 / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
    loop = np.eye(len(x)) - omega**2 * (shapes.T * compliance) @ shapes * mass
    if np.linalg.svd(loop, compute_uv=False).min() < RESONANCE:
        raise InputError(f"slider.mass = {float(mass[0])!r} kg is in resonance with the drive: give beam.loss_factor")
    force = mass * omega**2 * np.linalg.solve(loop, stage.drive_shapes(x, 0)[0]) * np.exp(1j * omega * stage.origin)
    phasors = (shapes @ force) * compliance
    return stage.rows.of_state(phasors.real, (1j * omega * phasors).real)


def set_down(assembly: Assembly, stage: Stage, z: ComplexArray, rise_of_step: Array | float = 0.0) -> None:
    """Set sliders in equilibrium on the surface of free rows z: places of feet, depths, friction, normal velocities.

    `rise_of_step` is that of `static_deflection`. Raises InputError for a foot without load.
    """
    p, state, x = assembly.points, assembly.contacts, assembly.start + assembly.points["offset"]
    lever, factors, rates = p["lever"], stage.factors(z[None], np.zeros(1))[0], stage.rates_at_start(z)
    at = np.clip(x + lever * (factors @ stage.columns(x, 1)), 0.0, stage.edges[-1])  # the material under a point
    columns = [stage.columns(at, derivative) for derivative in range(3)]
    (level, slope, bend), (rise, turn) = (factors @ one for one in columns), (rates @ one for one in columns[:2])
    along = assembly.sliders["v"][assembly.points["slider"]]
    along = along - slope * rise if assembly.kind.following else along
    along = along * assembly.sliders["free"][assembly.points["slider"]]
    rise_rate = rise + slope * (along + lever * (turn + bend * along))  # dw/dt + w' dX/dt, X = x + (h/2) w'
    foot = assembly.points["foot"]
    if assembly.restitution is not None:  # a rigid point moves with the surface from the start
        assembly.feet["height"], assembly.feet["velocity_z"] = level, rise_rate
        return
    if not len(assembly.feet):
        state["point_vz"] = rise_rate
        normal = p["load"]
    else:
        level = p["image"] * (level + rise_of_step) - p["arm"] * assembly.feet["pitch"][foot]
        depth = p["inset"] + p["face"] * level
        moves = np.zeros((len(assembly.feet), 3), dtype=bool)
        moves[:, 0] = ~_between(assembly)
        normal, place = _carried(assembly, depth, np.zeros((len(p), len(p))), moves)
        assembly.feet["height"] = place[:, 0]
        state["depth"] = depth - p["face"] * assembly.feet["height"][foot]
    assembly.at_rest = True
    state["friction"] = _holding(assembly, normal, slope)
    slider = assembly.sliders[assembly.points["slider"]]
    above = abs(state["friction"]) > slider["mu"] * normal * (1.0 + 1e-12)  # only a point that sticks has it
    state["sticks"][above & (slider["steepness"] == 0.0)] = 1.0
    elastic = p["tangential_stiffness"] > 0.0
    state["stretch"][elastic] = state["friction"][elastic] / p["tangential_stiffness"][elastic]
