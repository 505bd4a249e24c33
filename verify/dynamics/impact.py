"""Compiled rigid contact of one point: flights, impacts with restitution, riding until it lifts off.

The surface does not respond to the point, so that its motion is known at every instant: landings and lift-offs are
bracketed and bisected wherever they fall in a step. Friction is that of the laws, of impulses at an impact.
"""

import math
from typing import NamedTuple

from verify.arrays import Array
from verify.contact import laws
from verify.contact.state import LANDS, LEAVES, Bodies, Kind, Slip
from verify.dynamics.columns import rotate_half, set_factors, shift_factors
from verify.dynamics.recording import add_event, sample
from verify.dynamics.state import CHATTERS, DONE, END, NOT_FINITE, OFF_PIECES, Beam, Journal
from verify.dynamics.surface import find_pieces
from verify.jit import FAST, inline, jit

BISECTIONS = 100
"""Halvings of the interval of an event, until its ends are neighbouring numbers: 52 for one of a step's size."""
IMPACTS = 100_000  # Landings, lift-offs and pieces of a step, at most
REST = 1e-6
"""Shortest flight, as a fraction of a step: with restitution e the flights of a ball at rest sum to 1e-6/(1 - e)."""
ROUNDING = 4e-15
"""Rounding in the height of a flight, relative to the height of the surface and its speed times the time: 18 units in
the last place, of the sums over columns."""
LOW = 1e4
"""Height, over that rounding, above which a flight counts whatever energy it loses: its speed is known to 1e-4."""
RIDES, FLIES, SET_DOWN = 1.0, -1.0, 0.0  # `depth` of the point


class Ground(NamedTuple):
    """A surface that is known at every instant, and working space."""

    beam: Beam
    columns: Array  # (3, columns): factors and their first two derivatives


class Rigid(NamedTuple):
    """Constants of the point."""

    mass: float  # Across the beam, kg
    pressing: float  # Acceleration that presses it on, m/s^2
    external: float  # Acceleration of its slider by the external force, m/s^2
    lever: float
    restitution: float


class Under(NamedTuple):
    """The surface under the point."""

    level: float
    vz: float  # Rate of the level under the moving point, m/s
    slope_vz: float  # Its part by slopes
    acceleration: float  # Acceleration across of a point that rides on it, m/s^2, without w' dv/dt: mu w' of the load
    along: float  # Tangential speed of the material, m/s


@inline(fastmath=FAST)
def set_columns(time: float, since: float, ground: Ground) -> None:
    """Factors and derivatives at a time of the stage, `since` seconds after the state of the rows."""
    rows, harmonic, columns = ground.beam.rows, ground.beam.harmonic, ground.columns
    n, n_complex, omega, unit = len(rows.z_re), ground.beam.n_complex, harmonic.omega, harmonic.unit
    for j in range(n + n_complex):
        k = j if j < n else j - n_complex
        grown = math.exp(rows.rate_re[k] * since)
        c, s = grown * math.cos(rows.rate_im[k] * since), grown * math.sin(rows.rate_im[k] * since)
        real = rows.z_re[k] * c - rows.z_im[k] * s
        imaginary = rows.z_re[k] * s + rows.z_im[k] * c
        for d in range(3):
            columns[d, j] = real if j < n else -imaginary
            real, imaginary = (
                rows.rate_re[k] * real - rows.rate_im[k] * imaginary,
                rows.rate_re[k] * imaginary + rows.rate_im[k] * real,
            )
    angle, first = omega * (harmonic.origin + time), n + n_complex
    c, s, power, rate, bend = math.cos(angle), math.sin(angle), 1.0, 0.0, 0.0
    for d in range((columns.shape[1] - first) // 2):
        j = first + 2 * d
        columns[0, j], columns[0, j + 1] = power * c, -power * s
        columns[1, j], columns[1, j + 1] = rate * c - power * omega * s, -rate * s - power * omega * c
        fall = bend - omega * omega * power
        columns[2, j], columns[2, j + 1] = fall * c - 2.0 * rate * omega * s, -fall * s - 2.0 * rate * omega * c
        bend = (d + 1) * rate / unit
        rate = (d + 1) * power / unit
        power = power * time / unit


@jit(no_cpython_wrapper=True, fastmath=FAST)
def surface_at(time: float, since: float, x: float, v: float, lever: float, ground: Ground) -> Under:
    """The surface under x, which moves with v, at a time of the stage, `since` seconds after the state of the rows."""
    set_columns(time, since, ground)
    edges, table, columns, piece = ground.beam.surface.edges, ground.beam.surface.table, ground.columns, 0
    while piece < len(edges) - 2 and x > edges[piece + 1]:
        piece += 1
    length = edges[piece + 1] - edges[piece]
    at = (x - edges[piece]) / length
    for attempt in range(2):  # the material under x first, then what it does
        w, slope, curve, rise, turn, fall, lean = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            value, speed, acceleration = 0.0, 0.0, 0.0
            for j in range(columns.shape[1]):
                value += table[piece, d, j] * columns[0, j]
                speed += table[piece, d, j] * columns[1, j]
                acceleration += table[piece, d, j] * columns[2, j]
            curve = curve * at + slope
            slope = slope * at + w
            w = w * at + value
            turn = turn * at + rise
            rise = rise * at + speed
            lean = lean * at + fall
            fall = fall * at + acceleration
        slope, curve, turn, lean = slope / length, 2.0 * curve / (length * length), turn / length, lean / length
        if attempt == 0:
            at += lever * slope / length
    passed = v + lever * (turn + curve * v)
    return Under(
        w,
        rise + slope * passed,
        slope * (v + lever * curve * v),
        fall + lever * slope * lean + (2.0 * turn + curve * passed) * passed,
        (rise * slope - lever * turn) / math.sqrt(1.0 + slope * slope),
    )


@inline
def end_of_phase(
    time: float, done: float, left: float, ground: Ground, rigid: Rigid, bodies: Bodies
) -> tuple[float, bool]:
    """(Duration of the present flight or ride within what is `left` of the step, whether it ends there).

    Both halves of the rest are looked at first, then the change of sign is bisected.
    """
    slider, foot, riding = bodies.sliders[0], bodies.feet[0], bodies.contacts[0].depth > 0.0
    low, high, ended, ax = 0.0, left, False, 0.0 if riding else rigid.external
    for trial in range(2 + BISECTIONS):
        s = left * 0.5 * (trial + 1) if trial < 2 else 0.5 * (low + high)
        if (trial == 1 and ended) or (trial > 1 and not low < s < high):
            continue
        x = slider.x + slider.free * (slider.v + 0.5 * ax * s) * s
        under = surface_at(time + done + s, done + s, x, slider.free * (slider.v + ax * s), rigid.lever, ground)
        margin = foot.height + (foot.velocity_z - 0.5 * rigid.pressing * s) * s - under.level
        margin = rigid.pressing + under.acceleration if riding else margin
        if margin < 0.0:
            high, ended = s, True
        else:
            low = s
        if trial == 1 and not ended:
            break
    return high, ended


@inline
def fly(s: float, rigid: Rigid, bodies: Bodies, journal: Journal) -> None:
    """A flight of s seconds."""
    slider, foot, contact, total = bodies.sliders[0], bodies.feet[0], bodies.contacts[0], journal.sums[0]
    moved, rise = (slider.v + 0.5 * rigid.external * s) * s, (foot.velocity_z - 0.5 * rigid.pressing * s) * s
    slider.x += slider.free * moved
    slider.v += rigid.external * s
    foot.height += rise
    foot.velocity_z -= rigid.pressing * s
    total.external_work += slider.external_force * moved * (slider.inverse_mass > 0.0)
    total.load_work -= rigid.mass * rigid.pressing * rise
    contact.normal, contact.friction, contact.sticks = 0.0, 0.0, 0.0


@inline
def friction_of(start: float, gain: float, mobility: float, normal: float, bodies: Bodies) -> float:
    """Friction by the law of the point, of a force over a time or of an impulse (`mobility` 1/m, no gain)."""
    slip = Slip(start, gain, gain, start - 0.5 * gain, 0.0, mobility, mobility, 1.0, False, False)
    return laws.force(slip, normal, bodies.sliders[0], bodies.points[0], bodies.contacts[0])


@inline
def add_works(
    share: float,
    normal: float,
    force: float,
    surface: float,
    mean: float,
    across: float,
    slope_vz: float,
    bodies: Bodies,
    journal: Journal,
) -> None:
    """Works of a force over `share` seconds, or of an impulse with share 1; `across` is the work of the surface."""
    total = journal.sums[0]
    total.slope_work += share * normal * slope_vz
    total.normal_work += across - share * normal * slope_vz
    total.normal_on_beam -= across - share * normal * slope_vz
    total.tangential_work += share * force * surface
    total.friction_loss += share * force * (surface - mean)
    total.friction_time += share * force
    total.normal_time += share * normal
    if bodies.sliders[0].inverse_mass == 0.0:
        total.external_work -= mean * share * force


@inline
def ride(time: float, done: float, s: float, ground: Ground, rigid: Rigid, bodies: Bodies, journal: Journal) -> None:
    """A ride of s seconds: normal force in its middle, friction by the gain of the surface's speed."""
    slider, foot, contact, total = bodies.sliders[0], bodies.feet[0], bodies.contacts[0], journal.sums[0]
    x, v, free, lever = slider.x, slider.v, slider.free, rigid.lever
    start = surface_at(time + done, done, x, free * v, lever, ground)
    middle = surface_at(time + done + 0.5 * s, done + 0.5 * s, x + free * 0.5 * v * s, free * v, lever, ground)
    end = surface_at(time + done + s, done + s, x + free * v * s, free * v, lever, ground)
    normal, gain = (
        rigid.mass * max(rigid.pressing + middle.acceleration, 0.0),
        end.along - start.along - s * rigid.external,
    )
    contact.sticks_before = contact.sticks
    force = friction_of(v - start.along, gain, s * slider.inverse_mass, normal, bodies)
    slider.v = v + s * slider.inverse_mass * force + s * rigid.external
    mean, surface = 0.5 * (v + slider.v), 0.5 * (start.along + end.along)
    slider.x = x + free * mean * s
    under = surface_at(time + done + s, done + s, slider.x, free * slider.v, lever, ground)
    rise = under.level - foot.height
    across = 0.5 * rigid.mass * (under.vz**2 - foot.velocity_z**2) + rigid.mass * rigid.pressing * rise
    foot.height, foot.velocity_z = under.level, under.vz
    contact.normal, contact.friction, contact.surface, contact.sticks = normal, force, surface, contact.holds
    add_works(s, normal, force, surface, mean, across, middle.slope_vz, bodies, journal)
    total.load_work -= rigid.mass * rigid.pressing * rise
    total.touch_time += s
    total.stick_time += s if contact.sticks > 0.0 else 0.0
    total.max_friction = max(total.max_friction, abs(force))
    total.surface_time += s * surface
    if slider.inverse_mass > 0.0:
        total.external_work += mean * slider.external_force * s


@inline
def land(time: float, since: float, end: float, ground: Ground, rigid: Rigid, bodies: Bodies, journal: Journal) -> bool:
    """A landing: restitution across, friction of the impulse along; whether the point stays on the surface.

    It stays where the next flight is too short for the step, of `end` - `since` seconds more, or low and fed by the
    rounding of heights.
    """
    slider, foot, contact, total = bodies.sliders[0], bodies.feet[0], bodies.contacts[0], journal.sums[0]
    under = surface_at(time + since, since, slider.x, slider.free * slider.v, rigid.lever, ground)
    into = max(under.vz - foot.velocity_z, 0.0)
    impulse = rigid.mass * (1.0 + rigid.restitution) * into
    foot.height = under.level
    foot.velocity_z += impulse / rigid.mass
    total.contact_loss += 0.5 * impulse * into * (1.0 - rigid.restitution)
    v, contact.sticks_before = slider.v, 0.0
    force = friction_of(v - under.along, 0.0, slider.inverse_mass, impulse, bodies)
    slider.v = v + slider.inverse_mass * force
    add_works(
        1.0, impulse, force, under.along, 0.5 * (v + slider.v), impulse * under.vz, under.slope_vz, bodies, journal
    )
    away, load = rigid.restitution * into, rigid.pressing + under.acceleration
    if load <= 0.0:
        return False
    height = away * away / (2.0 * load)
    known = ROUNDING * (abs(under.level) + abs(under.vz) * (time + end))
    fed = (1.0 - rigid.restitution**2) * height <= known and height <= LOW * known
    if 2.0 * away > REST * end * load and not fed:
        return False
    foot.velocity_z = under.vz
    total.contact_loss += 0.5 * rigid.mass * away * away  # what is left of the bounce
    total.normal_work -= rigid.mass * away * under.vz
    total.normal_on_beam += rigid.mass * away * under.vz
    return True


@inline
def advance_point(time: float, dt: float, ground: Ground, rigid: Rigid, bodies: Bodies, journal: Journal) -> bool:
    """Advance the point by a step that begins at a time of the stage; whether it reached the end of the step."""
    slider, foot, contact, done = bodies.sliders[0], bodies.feet[0], bodies.contacts[0], 0.0
    for _ in range(IMPACTS):
        left = dt - done
        if left <= 1e-15 * dt:
            break
        if contact.depth == SET_DOWN:
            under = surface_at(time + done, done, slider.x, slider.free * slider.v, rigid.lever, ground)
            foot.height, foot.velocity_z = under.level, under.vz
            contact.depth = RIDES if rigid.pressing + under.acceleration > 0.0 else FLIES
        s, ended = end_of_phase(time, done, left, ground, rigid, bodies)
        kind = 0.0
        if contact.depth > 0.0:
            ride(time, done, s, ground, rigid, bodies, journal)
            if ended and s < left:
                kind, contact.depth = LEAVES, FLIES
        else:
            fly(s, rigid, bodies, journal)
            if ended:
                kind = LANDS
                contact.depth = RIDES if land(time, done + s, dt, ground, rigid, bodies, journal) else FLIES
        done += s
        if kind > 0.0:
            add_event(ground.beam.harmonic.origin + time + done, kind, 0, bodies, journal.events, journal.progress[0])
    return dt - done <= 1e-15 * dt


@jit
def advance_impacts(
    n_steps: int,
    every: int,
    dt: float,
    restitution: float,
    kind: Kind,
    ground: Ground,
    bodies: Bodies,
    journal: Journal,
) -> int:
    """Advance a rigid point by up to n_steps from step `journal.progress`; why it returns.

    `contacts[0].depth` is RIDES, FLIES, or SET_DOWN on the surface.
    """
    slider, foot, point, progress = bodies.sliders[0], bodies.feet[0], bodies.points[0], journal.progress[0]
    mass, beam, surface = 1.0 / foot.inverse_mass, ground.beam, ground.beam.surface
    rigid = Rigid(mass, -foot.load / mass, slider.external_force * slider.inverse_mass, point.lever, restitution)
    for _ in range(n_steps):
        time = progress.step * dt
        if not advance_point(time, dt, ground, rigid, bodies, journal):
            return CHATTERS
        rotate_half(beam.rows)
        rotate_half(beam.rows)
        progress.step += 1
        if not math.isfinite(slider.v + foot.height):
            return NOT_FINITE
        if progress.step % every == 0:
            set_factors(END, time + dt, beam)
            shift_factors(surface.factors)
            sample(every * dt, kind, bodies, surface.factors, journal)
        if not find_pieces(0.0, surface.edges, bodies):
            return OFF_PIECES
    return DONE
