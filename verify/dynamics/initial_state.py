"""Initial states of beam and sliders: static equilibrium of beam and feet, steady state with attached mass."""

from collections.abc import Callable

import numpy as np

from verify.arrays import Array, BoolArray, ComplexArray
from verify.dynamics import layout as lay
from verify.dynamics.excitation import RESONANCE
from verify.dynamics.linear_system import Stage
from verify.dynamics.stepping import Contacts
from verify.errors import InputError
from verify.linear.time_basis import Ratio, TimeBasis

PASSES = 40
"""Most iterations of an equilibrium. The compliance of the unloaded beam is that of the loaded one up to the rotation
of its surface, so that a few iterations end in practice."""
SETTLED = 1e-14
"""Change of the surface, over its largest displacement, at which an equilibrium is at its rounding."""


def equilibrium(contacts: Contacts, surface: Callable[[Array, Array], tuple[Array, Array]], compliance: Array) -> Array:
    """Bring sliders and surface to static equilibrium, in which the points of a foot carry it without a moment.

    `surface` gives (level, slope) of the material under every point, (points,), m, under normal forces and friction;
    `compliance` (points, points), m/N, is its approximate derivative: the decrease of a depth by a unit normal force.
    Springs press but do not pull. Sets the pitches of the feet; returns the depth, (feet,), m, that a foot between two
    beams gains by its preload. Raises InputError for a foot without load.
    """
    p = contacts.points
    normal, place = _shares(contacts), np.zeros((len(contacts.feet), 3))
    friction, level = 0.0 * normal, np.full(len(normal), np.inf)
    between = _between(contacts)
    moves = np.transpose([~between, ~between & (contacts.feet[:, lay.INVERSE_INERTIA] > 0.0), between])
    for _ in range(PASSES):
        before, (level, slope) = level, surface(normal, friction)
        friction = _holding(contacts, normal, slope)
        if len(contacts.feet):
            depth = p[:, lay.INSET] + p[:, lay.FACE] * p[:, lay.IMAGE] * level
            normal, place = _carried(contacts, depth + compliance @ normal, compliance, moves)
            contacts.feet[:, lay.PITCH] = place[:, 1]
        if abs(level - before).max() <= SETTLED * abs(level).max():
            break
    return np.asarray(place[:, 2])


def _shares(contacts: Contacts) -> Array:
    """Load of every point, N, where the points of a foot share its load equally."""
    if not len(contacts.feet):
        return np.array(contacts.points[:, lay.LOAD])
    p, foot = contacts.points, contacts.indices[:, lay.OF_FOOT]
    preload = np.bincount(foot, p[:, lay.INSET] * p[:, lay.STIFF])  # between two beams
    return np.asarray(((abs(contacts.feet[:, lay.FOOT_LOAD]) + preload) / np.bincount(foot))[foot])


def _between(contacts: Contacts) -> BoolArray:
    """Which feet are between two beams that respond, (feet,): by symmetry they stay in the middle."""
    foot, weights = contacts.indices[:, lay.OF_FOOT], contacts.points[:, lay.WEIGHT]
    halved = np.bincount(foot, weights < 1.0, len(contacts.feet))[: len(contacts.feet)] > 0.0
    return np.asarray(halved & contacts.normal_two_way)


def _holding(contacts: Contacts, normal: Array, slope: Array) -> Array:
    """Coulomb friction on sliders at rest, N: what holds them, or kinetic beyond the static limit; else none."""
    slider = contacts.indices[:, lay.OF_SLIDER]
    rows, total = contacts.sliders, np.bincount(slider, normal)
    pull = rows[:, lay.EXTERNAL_FORCE].copy()
    if contacts.following:
        downhill = contacts.gravity * contacts.points[:, lay.INERTIA] * slope
        pull -= np.bincount(slider, downhill)
    pull[(rows[:, lay.INVERSE_MASS] == 0.0) | (rows[:, lay.V] != 0.0) | (rows[:, lay.STEEPNESS] > 0.0)] = 0.0
    static, kinetic = rows[:, lay.MU_STATIC] * total, rows[:, lay.MU] * total
    held = np.where(abs(pull) <= static, pull, np.clip(pull, -kinetic, kinetic))
    return np.asarray(-(held / np.where(total > 0.0, total, 1.0))[slider] * normal)


def _carried(contacts: Contacts, depth: Array, compliance: Array, moves: Array) -> tuple[Array, Array]:
    """(normal forces, places of the feet) on a linear surface that is at `depth` without them and feet at height 0.

    The depth of a point is depth - compliance N - B y with the places y of the feet, and N/k in contact; B^T N are the
    loads of the feet. `moves` (feet, 3) are the coordinates of the places that balance their loads. The set of points
    in contact is corrected until no point pulls and none without force is deep.
    """
    p, feet, foot = contacts.points, contacts.feet, contacts.indices[:, lay.OF_FOOT]
    n, m = len(p), len(feet)
    by_place, loads, springs = np.zeros((n, m, 3)), np.zeros((m, 3)), np.zeros((m, 3))
    by_place[np.arange(n), foot] = np.transpose([p[:, lay.FACE], p[:, lay.FACE] * p[:, lay.ARM], -np.ones(n)])
    loads[:, 0], springs[:, 0] = -feet[:, lay.FOOT_LOAD], feet[:, lay.SPRING_RATE]
    loads[:, 2] = -np.bincount(foot, p[:, lay.INSET] * p[:, lay.STIFF])
    moved = moves.ravel()
    b, load, rate = by_place.reshape(n, -1)[:, moved], loads.ravel()[moved], springs.ravel()[moved]
    touching, normal, place = np.ones(n, dtype=bool), np.zeros(n), np.zeros(3 * m)
    for _ in range(4 * n + 4):
        if (np.bincount(foot, touching) == 0.0).any():
            number = int(np.bincount(foot, touching).argmin()) + 1
            raise InputError(f"slider.preload leaves foot {number} without load or off the beam: raise it")
        inner = np.diag(1.0 / p[:, lay.STIFF]) + compliance
        inner, sides = inner[np.ix_(touching, touching)], b[touching]
        matrix = np.block([[inner, sides], [sides.T, -np.diag(rate)]])
        # a foot on a single point may have any pitch: the least is taken
        found = np.linalg.lstsq(matrix, np.concatenate([depth[touching], load]), rcond=None)[0]
        normal[:], normal[touching], place[moved] = 0.0, found[: touching.sum()], found[touching.sum() :]
        left = depth - compliance @ normal - b @ place[moved]
        after = np.where(touching, normal > 0.0, left > 1e-12 * abs(depth).max())
        if (after == touching).all():
            break
        touching = after
    return normal, place.reshape(m, 3)


def static_deflection(
    basis: TimeBasis, contacts: Contacts, released: Callable[[Array, float], Array], dt: float
) -> tuple[Array, Array]:
    """Static equilibrium under the sliders: modal amplitudes, (n,), sqrt(kg) m, and a rise of points, (points,), m.

    A normal force acts at the material point x + (h/2) w', square to the surface, and so has the moment (h/2) w' per
    unit force on the section. Between two beams the depth is increased until each carries the preload. The engine
    evaluates the surface under feet in the middle of a step and without its contact forces: `released` are amplitudes
    after a time without them. The equilibrium is one of steps of dt with the rise of the surface that this makes; for
    points without feet dt is 0. Sets the speed along that the contact forces of a step before would have cancelled.
    """
    p, x = contacts.points, contacts.start + contacts.points[:, lay.OFFSET]
    side, lever, slopes = p[:, lay.WEIGHT], p[:, lay.LEVER], basis.shapes(x, 1)
    if len(contacts.feet):
        side = side * p[:, lay.FACE] * p[:, lay.IMAGE]

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
        q = -(across @ (side * normal) + along @ (p[:, lay.WEIGHT] * friction)) / basis.omegas**2
        return level(released(q, 0.5 * dt)), slope

    gained = equilibrium(contacts, surface, compliance_of(basis, contacts))
    if len(contacts.feet):
        p[:, lay.INSET] += gained[contacts.indices[:, lay.OF_FOOT]]
    if dt > 0.0:
        contacts.contacts[:, lay.BEFORE] = (q - released(q, dt)) / dt @ shapes(released(q, 0.5 * dt))[1]
    return q, level(released(q, 0.5 * dt)) - level(q)


def compliance_of(basis: TimeBasis, contacts: Contacts) -> Array:
    """Decrease of the depth of every point by unit normal forces on a straight beam, (points, points), m/N."""
    p = contacts.points
    shapes = basis.shapes(contacts.start + p[:, lay.OFFSET], 0) * p[:, lay.FACE] * p[:, lay.IMAGE]
    return np.asarray((shapes.T / basis.omegas**2) @ (shapes * p[:, lay.WEIGHT]))


def steady_with_mass(basis: TimeBasis, stage: Stage, contacts: Contacts, damping: Ratio) -> ComplexArray:
    """Modal response z to bilateral masses on a steady beam, at time 0 of the stage, (n,).

    W = W_0 + G m omega^2 W at all points: a mass exerts the force m omega^2 W. Raises InputError at a resonance.
    """
    omega, x = stage.omega, contacts.start + contacts.points[:, lay.OFFSET]
    shapes, mass = basis.shapes(x, 0), contacts.points[:, lay.INERTIA]
    compliance = 1.0 / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
    loop = np.eye(len(x)) - omega**2 * (shapes.T * compliance) @ shapes * mass
    if np.linalg.svd(loop, compute_uv=False).min() < RESONANCE:
        raise InputError(f"slider.mass = {float(mass[0])!r} kg is in resonance with the drive: give beam.loss_factor")
    force = mass * omega**2 * np.linalg.solve(loop, stage.drive_shapes(x, 0)[0]) * np.exp(1j * omega * stage.origin)
    phasors = (shapes @ force) * compliance
    return stage.rows.of_state(phasors.real, (1j * omega * phasors).real)


def set_down(contacts: Contacts, stage: Stage, z: ComplexArray, rise_of_step: Array | float = 0.0) -> None:
    """Set sliders in equilibrium on the surface of free rows z: places of feet, depths, friction, normal velocities.

    `rise_of_step` is that of `static_deflection`. Raises InputError for a foot without load.
    """
    p, state, x = contacts.points, contacts.contacts, contacts.start + contacts.points[:, lay.OFFSET]
    lever, factors, rates = p[:, lay.LEVER], stage.factors(z[None], np.zeros(1))[0], stage.rates_at_start(z)
    at = np.clip(x + lever * (factors @ stage.columns(x, 1)), 0.0, stage.edges[-1])  # the material under a point
    columns = [stage.columns(at, derivative) for derivative in range(3)]
    (level, slope, bend), (rise, turn) = (factors @ one for one in columns), (rates @ one for one in columns[:2])
    along = contacts.sliders[contacts.indices[:, lay.OF_SLIDER], lay.V]
    along = along - slope * rise if contacts.following else along
    along = along * contacts.sliders[contacts.indices[:, lay.OF_SLIDER], lay.FREE]
    climb = rise + slope * (along + lever * (turn + bend * along))  # dw/dt + w' dX/dt, X = x + (h/2) w'
    foot = contacts.indices[:, lay.OF_FOOT]
    if contacts.restitution is not None:  # a rigid point moves with the surface from the start
        contacts.feet[:, lay.HEIGHT], contacts.feet[:, lay.VELOCITY_Z] = level, climb
        return
    if not len(contacts.feet):
        state[:, lay.POINT_VZ] = climb
        normal = p[:, lay.LOAD]
    else:
        level = p[:, lay.IMAGE] * (level + rise_of_step) - p[:, lay.ARM] * contacts.feet[foot, lay.PITCH]
        depth = p[:, lay.INSET] + p[:, lay.FACE] * level
        moves = np.zeros((len(contacts.feet), 3), dtype=bool)
        moves[:, 0] = ~_between(contacts)
        normal, place = _carried(contacts, depth, np.zeros((len(p), len(p))), moves)
        contacts.feet[:, lay.HEIGHT] = place[:, 0]
        state[:, lay.DEPTH] = depth - p[:, lay.FACE] * contacts.feet[foot, lay.HEIGHT]
    contacts.at_rest = True
    state[:, lay.FRICTION] = _holding(contacts, normal, slope)
    slider = contacts.sliders[contacts.indices[:, lay.OF_SLIDER]]
    above = abs(state[:, lay.FRICTION]) > slider[:, lay.MU] * normal * (1.0 + 1e-12)  # only a point that sticks has it
    state[above & (slider[:, lay.STEEPNESS] == 0.0), lay.STUCK] = 1.0
    elastic = p[:, lay.TANGENTIAL] > 0.0
    state[elastic, lay.STRETCH] = state[elastic, lay.FRICTION] / p[elastic, lay.TANGENTIAL]
