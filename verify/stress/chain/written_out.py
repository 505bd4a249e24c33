"""The nonlinear chain against its equations written out: dense matrices over absolute angles, closed by multipliers.

Links are straight bars with their mass in the middle; all that can work on a chain works on these. Nothing of the
compiled chain, of its equilibria or of its small motion but the numbers that describe it.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace as changed
from functools import cache, partial
from math import pi
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.chain import warm
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.section import Section
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held

LINKS = 7
FIXED = 2e-5
"""Seconds of a fixed step."""
STEP = 1e-5
"""Of angles, for derivatives by differences."""


@cache
def systems() -> tuple[ChainSystem, ...]:
    """Chains of unlike links: turned, shaken, heavy, pushed, pinned, on rollers with and without a spring."""
    cantilever, hinged = (_stepped(*ends) for ends in (("clamped", "free"), ("pinned", "pinned")))
    turned = Rotation(offset=0.3, rate=2.1, amplitude=0.2, frequency_hz=1.7, phase_deg=33.0)
    push = LinkLoad(link=6, at=0.02, force=(0.4, -0.7), moment=0.03, frequency_hz=2.3, phase_deg=41.0)
    dead = LinkLoad(link=4, at=0.05, force=(-0.5, 0.6), moment=-0.02, phase_deg=24.0)
    shake = Actuator(link=3, at=0.03, amplitude=0.004, frequency_hz=3.1, phase_deg=-70.0)
    lift = Actuator(link=4, at=0.05, amplitude=0.006, phase_deg=11.0)
    return (
        changed(cantilever, rotation=turned, loads=(push, dead), gravity=(1.3, -9.81)),
        changed(cantilever, actuators=(shake,), loads=(push,), axial_inertia=False),
        changed(hinged, actuators=(lift,), loads=(dead,), gravity=(3.0, -9.81)),
        changed(hinged, axial_spring=900.0, loads=(dead, push)),
        changed(cantilever, rotation=Rotation(offset=0.2, rate=3.7), axial_inertia=True),
        changed(cantilever, rotation=Rotation(rate=2.9), loads=(), stiffness=0.2 * cantilever.stiffness),
    )


def _stepped(*supports: str) -> ChainSystem:
    """Links of two sections."""
    beam: Beam = changed_beam(held(*supports))
    return build_system(beam, LINKS, joint_dashpot=0.004, grading=1.6)


def changed_beam(beam: Beam) -> Beam:
    """The strip in two thicknesses."""
    from msgspec.structs import replace

    return replace(beam, section=(Section(length=0.31, thickness=0.0011), Section(length=0.42, thickness=0.0008)))


# --- Written out ------------------------------------------------------------------------------------------------------


def hub(system: ChainSystem, t: float) -> tuple[float, float, float]:
    """Angle, rate and acceleration of the base."""
    turn = system.rotation
    omega = 2.0 * pi * turn.frequency_hz
    phase = omega * t + np.deg2rad(turn.phase_deg)
    swing, rate = turn.amplitude * np.sin(phase), turn.amplitude * omega * np.cos(phase)
    return float(turn.offset + turn.rate * t + swing), float(turn.rate + rate), float(-(omega**2) * swing)


def reach_of(system: ChainSystem, link: int, at: float) -> Array:
    """How far a point lies from each joint before it along the links: its y is reach @ sin(theta)."""
    reach = np.zeros(system.n_links)
    reach[: link - 1], reach[link - 1] = system.lengths[: link - 1], at
    return reach


def held_at(system: ChainSystem, t: float) -> list[tuple[Array, float, float]]:
    """(reach, y, y'') of the roller and of every actuator."""
    rows = [(reach_of(system, system.n_links, system.lengths[-1]), 0.0, 0.0)] if system.tip == "roller" else []
    for one in system.actuators:
        omega = 2.0 * pi * one.frequency_hz
        y = one.amplitude * float(np.cos(omega * t + np.deg2rad(one.phase_deg)))
        rows.append((reach_of(system, one.link, one.at), y, -(omega**2) * y))
    return rows


def accelerated(system: ChainSystem, t: float, angles: Array, rates: Array) -> Array:
    """Relative accelerations, (N,), by the equations of all links and the forces in held points at once."""
    turn, turning, turned = hub(system, t)
    theta, spin = turn + np.cumsum(angles), turning + np.cumsum(rates)
    c, s = np.cos(theta), np.sin(theta)
    moments = -system.stiffness * angles - system.dashpots * rates
    force, mass = moments - np.append(moments[1:], 0.0), np.diag(system.inertias.astype(float))
    for i, own in enumerate(system.masses):
        middle = reach_of(system, i + 1, 0.5 * system.lengths[i])
        along, across = -middle * s, middle * c
        force += own * (system.gravity[0] * along + system.gravity[1] * across)
        for felt, row, bend in ((system.axial_inertia, along, -middle * c), (True, across, -middle * s)):
            mass += felt * own * np.outer(row, row)
            force -= felt * own * row * (bend @ spin**2)
    for load in system.loads:
        now = np.cos(2.0 * pi * load.frequency_hz * t + np.deg2rad(load.phase_deg))
        reach = reach_of(system, load.link, load.at)
        force += now * (load.force[1] * reach * c - load.force[0] * reach * s)
        force[load.link - 1] += now * load.moment
    force += system.axial_spring * (system.lengths @ (c - 1.0)) * system.lengths * s
    rows = [(reach * c, wanted + reach @ (s * spin**2)) for reach, _, wanted in held_at(system, t)]
    size, more = len(force), len(rows)
    bordered = np.zeros((size + more, size + more))
    bordered[:size, :size] = mass
    for i, (row, _) in enumerate(rows):
        bordered[size + i, :size] = bordered[:size, size + i] = row
    found = np.linalg.solve(bordered, np.append(force, [wanted for _, wanted in rows]))[:size]
    return np.diff(found, prepend=turned)


def stirred(system: ChainSystem, t: float = 0.13) -> ChainState:
    """A bent and moving state on the held points."""
    from verify.chain.dynamics import project

    n = np.arange(1.0, system.n_links + 1.0)
    return project(system, ChainState(0.3 * np.sin(2.1 * n), 4.0 * np.cos(1.3 * n), t))[0]


# --- Errors -----------------------------------------------------------------------------------------------------------


def acceleration_error(number: float) -> float:
    """Of a stirred chain, and how far it lies off its held points, over lengths."""
    from verify.chain.dynamics import accelerations

    system = systems()[int(number)]
    state = stirred(system)
    exact = accelerated(system, state.time, state.angles, state.rates)
    worst = float(abs(accelerations(system, state) - exact).max() / abs(exact).max())
    theta = hub(system, state.time)[0] + np.cumsum(state.angles)
    for reach, y, _ in held_at(system, state.time):
        worst = largest(worst, abs(float(reach @ np.sin(theta)) - y) / system.length)
    return worst


def energy_error(number: float) -> float:
    """Of its kinetic, elastic and gravitational energy, of its joints' places and speeds, over the largest."""
    from verify.chain.dynamics import energies, positions

    system = systems()[int(number)]
    state = stirred(system)
    turn, turning, _ = hub(system, state.time)
    theta, spin = turn + np.cumsum(state.angles), turning + np.cumsum(state.rates)
    along = np.stack([np.cos(theta), np.sin(theta)], axis=1) * system.lengths[:, None]
    joints = np.vstack([np.zeros(2), np.cumsum(along, axis=0)])
    rises = np.stack([-along[:, 1], along[:, 0]], axis=1) * spin[:, None]
    speeds = np.vstack([np.zeros(2), np.cumsum(rises, axis=0)])
    middle, moving = 0.5 * (joints[1:] + joints[:-1]), 0.5 * (speeds[1:] + speeds[:-1])
    squares = moving[:, 1] ** 2 + (moving[:, 0] ** 2 if system.axial_inertia else 0.0)
    stretch = float(system.lengths @ (np.cos(theta) - 1.0))
    exact = (
        0.5 * float(system.masses @ squares + system.inertias @ spin**2),
        0.5 * float(system.stiffness @ state.angles**2) + 0.5 * system.axial_spring * stretch**2,
        -float(system.masses @ (middle @ np.array(system.gravity))),
    )
    found, (places, rates) = energies(system, state), positions(system, state)
    off = max(abs(a - b) for a, b in zip(found, exact, strict=True)) / max(map(abs, exact))
    pairs = ((places, joints), (rates, speeds))
    return largest(off, *(float(abs(a - b).max() / abs(b).max()) for a, b in pairs))


def rest_error(number: float) -> float:
    """What is left of accelerations where a chain rests under its constant loads, over those of a bent one."""
    from verify.chain.statics import solve_static

    system = _constant(systems()[int(number)])
    rest = solve_static(system)
    still = np.zeros(system.n_links)
    left = accelerated(system, 0.0, rest.angles, still)
    bent = accelerated(system, 0.0, stirred(system).angles, still)
    theta = hub(system, 0.0)[0] + np.cumsum(rest.angles)
    gaps = [abs(float(reach @ np.sin(theta)) - y) / system.length for reach, y, _ in held_at(system, 0.0)]
    return largest([float(abs(left).max() / abs(bent).max()), *gaps])


def _constant(system: ChainSystem) -> ChainSystem:
    """The same without what swings."""
    turn = system.rotation
    loads = tuple(load for load in system.loads if not load.frequency_hz)
    gravity = (0.0, 0.0) if turn.rate else system.gravity
    if turn.rate:
        loads = ()
    actuators = tuple(one for one in system.actuators if not one.frequency_hz)
    still = changed(turn, amplitude=0.0, frequency_hz=0.0, phase_deg=0.0)
    return changed(
        system, rotation=still, loads=loads, gravity=gravity, actuators=actuators, dashpots=np.zeros(system.n_links)
    )


def small_motion_error(number: float) -> float:
    """Of frequencies about rest, bent and turning: squares of them against those of derivatives by differences."""
    from verify.chain.dynamics import linearise
    from verify.chain.statics import solve_static

    system = _constant(systems()[int(number)])
    start = ChainState(np.append(0.2, np.zeros(LINKS - 1)), np.zeros(LINKS)) if number == 2 else None
    rest = solve_static(system, start)
    found = np.sort(linearise(system, rest).squares())
    n, still = system.n_links, np.zeros(system.n_links)
    free = _free(system, rest.angles)
    columns = []
    for column in np.vstack([np.hstack([np.eye(n), np.zeros((n, n))]), np.hstack([np.zeros((n, n)), np.eye(n)])]):
        q, v = column[:n] * STEP, column[n:] * STEP
        sides = [accelerated(system, 0.0, rest.angles + side * q, still + side * v) for side in (1.0, -1.0)]
        columns.append((sides[0] - sides[1]) / (2.0 * STEP))
    stiffness, damping = np.array(columns[:n]).T, np.array(columns[n:]).T
    inverse = np.linalg.pinv(free)
    m = free.shape[1]
    matrix = np.block([[np.zeros((m, m)), np.eye(m)], [inverse @ stiffness @ free, inverse @ damping @ free]])
    squares = np.sort(-(np.linalg.eigvals(matrix) ** 2).real)[::2]
    return float(abs(found[:4] / squares[:4] - 1.0).max())


def _free(system: ChainSystem, angles: Array) -> Array:
    """Columns of relative angles that keep the held points."""
    from scipy.linalg import null_space

    theta = hub(system, 0.0)[0] + np.cumsum(angles)
    rows = np.array([reach * np.cos(theta) for reach, _, _ in held_at(system, 0.0)]).reshape(-1, system.n_links)
    if not len(rows):  # of which scipy before 1.14 has no null space
        return np.eye(system.n_links)
    return np.asarray(null_space(rows @ np.tril(np.ones((system.n_links, system.n_links)))))


def upright_error(links: float) -> float:
    """Squares of frequencies of a chain that stands on its head, against those of the one that hangs, less them."""
    from verify.chain.dynamics import at_rest, linearise

    hanging = changed(
        build_system(held("pinned", "free"), int(links)), stiffness=np.zeros(int(links)), gravity=(9.81, 0.0)
    )
    down, up = (linearise(one, at_rest(one)).squares() for one in (hanging, changed(hanging, gravity=(-9.81, 0.0))))
    return float(abs(np.sort(-up) / np.sort(down) - 1.0).max())


def evaluations_error(links: float) -> float:
    """Accelerations of a run that it says it took, less six for every step, kept or not."""
    from verify.chain.dynamics import at_rest
    from verify.chain.stepping import simulate

    system = changed(systems()[0], rotation=Rotation())
    told: Any = simulate(system, at_rest(system), np.linspace(0.0, 0.02, 5), tolerance=10.0**-links).statistics
    return float(abs(told.evaluations - 6 * (told.steps + told.rejected)))


def _in_time() -> Iterator[Call]:
    """Rigid links in steps and in modes, and where they stand."""
    yield from warm.rigid()
    yield from warm.modal()


def transient_error(number: float) -> float:
    """Of a pushed chain from rest by adaptive and fixed steps, and by kicks, where their joints stand and move."""
    from scipy.integrate import solve_ivp

    from verify.chain.dynamics import at_rest, positions
    from verify.chain.splitting import modal_basis, simulate_modal
    from verify.chain.stepping import simulate

    system, times = _pushed(int(number)), np.array([0.007007, 0.011011, 0.017])
    n = system.n_links

    def rates(t: float, y: Array) -> Array:
        return np.concatenate([y[n:], accelerated(system, t, y[:n], y[n:])])

    start = at_rest(system)
    begin = np.concatenate([start.angles, start.rates])
    found = solve_ivp(rates, (0.0, times[-1]), begin, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-13)
    exact = found.y.T
    motions = [simulate(system, start, times, tolerance=1e-9, ledger=False)]
    motions.append(simulate(system, start, times, method="rk4", step=FIXED, ledger=False))
    if number:
        motions.append(simulate_modal(modal_basis(system), start, times, step=FIXED))
    worst = 0.0
    for motion in motions:
        for seen, true in ((motion.angles, exact[:, :n]), (motion.rates, exact[:, n:])):
            worst = largest(worst, float(abs(seen - true).max() / abs(true).max()))
        x = np.array([0.13, 0.6])
        joints = np.array(
            [positions(system, ChainState(y[:n], y[n:], float(t)))[0] for y, t in zip(exact, times, strict=True)]
        )
        across = np.array([np.interp(x, system.nodes, one[:, 1]) for one in joints])
        worst = largest(worst, float(abs(motion.deflection(x.tolist()) - across).max() / abs(across).max()))
    return worst


def _pushed(number: int) -> ChainSystem:
    """Without dashpots: heavy, and turned; or on a roller and pushed alone."""
    system, *_ = systems()
    load = LinkLoad(link=6, at=0.02, force=(0.02, -0.05), moment=0.003, frequency_hz=23.0, phase_deg=41.0)
    still: dict[str, Any] = {"dashpots": np.zeros(LINKS), "loads": (load,)}
    if number:
        return changed(systems()[3], axial_spring=0.0, **still)
    return changed(system, rotation=Rotation(), gravity=(0.0, 0.0), **still)


NUMBERS = tuple(float(n) for n in range(5))
_row: Callable[..., Floor] = partial(Floor, along="chain", at=NUMBERS)

ROWS: tuple[Row, ...] = (
    _row(
        id="accelerations-written-out",
        title="Accelerations of five chains, turned, shaken, pushed and held, against their equations solved densely",
        why="chain/recursion_kernels.py: the recursion to rounding.",
        promise=1e-10,
        error=acceleration_error,
        kernels=warm.rigid,
    ),
    _row(
        id="energies-written-out",
        title="Their energies, joints and speeds, against sums over all links",
        why="chain/kernels.py: to rounding.",
        promise=1e-13,
        error=energy_error,
    ),
    _row(
        id="rest-written-out",
        title="What is left of accelerations where they rest under constant loads, bent far or turning steadily",
        why="chain/statics.py: Newton's method to 1e-12 of the loads.",
        promise=1e-9,
        error=rest_error,
    ),
    _row(
        id="small-motion-written-out",
        title="Squares of four frequencies about that rest, against derivatives of the equations by differences",
        why="chain/dynamics.py: exact; differences over 1e-5 keep seven digits.",
        promise=1e-6,
        error=small_motion_error,
    ),
    Floor(
        id="transients-written-out",
        title="Two chains from rest by adaptive and fixed steps and by kicks, against their equations by DOP853",
        why="chain/stepping.py, chain/splitting.py: steps of orders 5 and 4, two kicks a step, to 1e-8 here.",
        along="chain",
        at=(0.0, 1.0),
        promise=1e-7,
        error=transient_error,
        kernels=_in_time,
    ),
    Floor(
        id="chains-upright",
        title="Growth of a chain that stands on its head, against the swing of the one that hangs",
        why="chain/small_motion.py: without springs K is of gravity alone and changes its sign with it.",
        along="links",
        at=(1, 3, 9),
        promise=1e-9,
        error=upright_error,
    ),
    Floor(
        id="accelerations-counted",
        title="Accelerations of a run in steps of Dormand and Prince, less six for each step, kept or not",
        why="chain/stepping.py: the last stage of a step is the first of the next.",
        along="digits",
        at=(5, 9),
        promise=0.5,
        error=evaluations_error,
        kernels=warm.rigid,
    ),
)
