"""Chains as no scene bends, turns or cuts them: coils, all modes of long ones, limits of steps, landings."""

from dataclasses import replace as changed
from math import pi, radians, sin, sqrt
from typing import Any

import numpy as np

from verify.chain import warm
from verify.chain.system import ChainState, ChainSystem, Rotation, build_system
from verify.models.arrays import Array
from verify.motion.result import END
from verify.stress.chain.written_out import _stepped, systems
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held

LINKS = 9

# --- Modes ------------------------------------------------------------------------------------------------------------


def all_modes_error(links: float) -> float:
    """Of the modes of a chain with and without a roller as a long one has them, against dense ones; of their duals."""
    from verify.chain.splitting import modal_basis

    worst, n = 0.0, int(links)
    pairs: tuple[tuple[str, str], ...] = (("clamped", "free"), ("pinned", "pinned"))
    for ends in pairs:
        system = _stepped(*ends) if n == 7 else build_system(held(*ends), n)
        system = changed(system, dashpots=np.zeros(n))
        most = n - (ends[1] == "pinned")
        long, dense = modal_basis(system, n_modes=most), modal_basis(system)
        size = max(dense.omega)
        worst = largest(worst, float(abs(long.omega - dense.omega).max() / size), abs(long.tilt - dense.tilt))
        signs = np.sign(np.sum(long.modes * dense.modes, axis=1))[:, None]
        for own, other in ((long.modes, dense.modes), (long.duals, dense.duals)):
            worst = largest(worst, float(abs(signs * own - other).max() / abs(other).max()))
        worst = largest(worst, float(abs(long.duals @ long.modes.T - np.eye(len(long.omega))).max()))
    return worst


def drift_error(seconds: float) -> float:
    """Of a hinged chain that spins about its hinge, by the linear chain's flow: joints in line, as far as it spins."""
    from verify.chain.splitting import modal_basis, simulate_linear

    spin, system = 0.7, build_system(held("pinned", "free"), LINKS)
    start = ChainState(np.zeros(LINKS), np.append(spin, np.zeros(LINKS - 1)))
    found = simulate_linear(modal_basis(system), start, [0.4 * seconds, seconds])
    turned = np.outer([0.4 * seconds, seconds], np.append(spin, np.zeros(LINKS - 1)))
    return float(abs(found.angles - turned).max() / abs(turned).max())


# --- Coils ------------------------------------------------------------------------------------------------------------


def _coil(turn: float) -> tuple[ChainSystem, Array, Array]:
    """(a chain, absolute angles of its links, their stretches): more than a whole turn of unlike bends."""
    system = changed(build_system(held("clamped", "free"), LINKS, grading=1.7), gravity=(1.3, -9.81))
    bends = turn * (1.0 + 0.3 * np.sin(np.arange(1.0, LINKS + 1.0)))
    return system, np.cumsum(bends), 1e-3 * np.cos(np.arange(1.0, LINKS + 1.0)) * system.lengths


def stretched_error(turn: float) -> float:
    """Of the energy of a coil of links that stretch, which spins and drifts; of places on it."""
    from verify.chain.stretching import ElasticMotion

    system, angles, stretches = _coil(turn)
    ends = (system.lengths + stretches)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    joints = np.vstack([np.zeros(2), np.cumsum(ends, axis=0)])
    straight = np.stack([system.nodes, np.zeros(LINKS + 1)], axis=1)
    spin, drift, stiff = 2.3, np.array([0.4, -0.7]), np.linspace(1e4, 3e4, LINKS)
    velocities = drift + spin * np.stack([-joints[:, 1], joints[:, 0]], axis=1)
    motion = ElasticMotion(
        system=system,
        times=np.zeros(1),
        statistics=_done(),
        displacements=(joints - straight)[None],
        velocities=velocities[None],
        axial_stiffness=stiff,
    )
    middles = 0.5 * (velocities[1:] + velocities[:-1])
    turning = np.diff(velocities, axis=0)
    kinetic = 0.5 * float(system.masses @ (middles**2).sum(axis=1) + system.masses / 12.0 @ (turning**2).sum(axis=1))
    bends = np.diff(angles, prepend=0.0)
    elastic = 0.5 * float(stiff / system.lengths @ stretches**2 + system.stiffness @ bends**2)
    sunk = 0.5 * (joints[1:] + joints[:-1] - straight[1:] - straight[:-1]) @ np.array(system.gravity)
    exact = kinetic + elastic - float(system.masses @ sunk)
    at = float(system.nodes[4] + 0.3 * system.lengths[4])
    across = 0.7 * joints[4, 1] + 0.3 * joints[5, 1]
    off = (motion.energies[0] / exact - 1.0, motion.deflection([at])[0, 0] - across)
    return largest(abs(float(one)) for one in off)


def _done() -> Any:
    from verify.chain.result import ChainStatistics

    given: dict[str, Any] = {"steps": 0, "evaluations": 0, "step_s": 0.0, "set_up_s": 0.0, "wall_s": 0.0}
    return ChainStatistics(method="none", stopped=END, **given)


def coil_error(turn: float) -> float:
    """Of places on a coil of rigid links on a turned hub, and of what its books miss."""
    from verify.chain.result import ChainMotion

    system, angles, _ = _coil(turn)
    system = changed(system, rotation=Rotation(offset=0.2, rate=1.1))
    times, relative = np.array([0.0, 0.4]), np.diff(angles, prepend=0.0)
    still, lost, given = np.zeros((2, LINKS)), np.array([0.1, 0.4]), np.array([0.3, 2.5])
    motion = ChainMotion(
        system=system,
        times=times,
        statistics=_done(),
        angles=np.stack([relative, relative]),
        rates=still,
        dissipated=lost,
        work_in=given,
    )
    worst, at = 0.0, float(system.nodes[6] + 0.4 * system.lengths[6])
    for row, t in enumerate(times):
        theta = angles + 0.2 + 1.1 * t
        reach = np.append(system.lengths[:6], 0.4 * system.lengths[6])
        exact = np.array([reach @ np.cos(theta[:7]), reach @ np.sin(theta[:7])])
        worst = largest(worst, float(abs(motion.points([at])[row, 0] - exact).max()))
        state = motion.state(row)
        worst = largest(worst, float(abs(state.angles - relative).max()), abs(state.time - t))
    energies = np.sum(motion.energies(), axis=0)
    missed = float(energies[1] - energies[0]) - 2.2 + 0.3
    return largest(worst, abs(float(motion.residual()[1]) - missed) / abs(missed), abs(float(motion.residual()[0])))


def turned_error(phase: float) -> float:
    """Of a heavy chain at rest on a hub that is turned by an amplitude at a phase, against the same by an offset."""
    from verify.chain.statics import solve_static

    system = systems()[0]
    hubs = (
        Rotation(offset=0.1, amplitude=0.4, phase_deg=phase),
        Rotation(offset=0.1 + 0.4 * sin(radians(phase))),
    )
    rests = [solve_static(changed(system, rotation=hub, loads=system.loads[1:])).angles for hub in hubs]
    return float(abs(rests[0] - rests[1]).max() / abs(rests[1]).max())


def turning_error(bend: float) -> float:
    """Of what a turning base makes of a bent chain: forces, their derivatives and moments by rates, by differences.

    From the moment of inertia of its links about the base, and from their angular momentum by each link's rate.
    """
    from verify.chain.statics import centrifugal, gyroscopic

    system = systems()[4]
    n, rate, step = system.n_links, system.rotation.rate, 1e-5
    theta = bend * np.sin(1.3 * np.arange(1.0, n + 1.0))
    back = np.tril(np.tile(system.lengths, (n, 1)), -1) + 0.5 * np.diag(system.lengths)  # from the base to a middle

    def potential(at: Array) -> float:
        x, y = back @ np.cos(at), back @ np.sin(at)
        return -0.5 * rate**2 * float(system.masses @ (x**2 + y**2))

    def momentum(at: Array) -> Array:
        x, y = back @ np.cos(at), back @ np.sin(at)
        return np.asarray(rate * (system.masses @ (x[:, None] * back * np.cos(at) + y[:, None] * back * np.sin(at))))

    moved = step * np.eye(n)
    force, stiffness = centrifugal(system, theta)
    slopes = np.array([potential(theta + one) - potential(theta - one) for one in moved]) / (2.0 * step)
    further = np.array([centrifugal(system, theta + one)[0] - centrifugal(system, theta - one)[0] for one in moved])
    turned = np.array([momentum(theta + one) - momentum(theta - one) for one in moved]) / (2.0 * step)
    pairs = ((force, slopes), (stiffness, further / (2.0 * step)), (gyroscopic(system, theta), turned.T - turned))
    return largest(float(abs(found - exact).max() / abs(exact).max()) for found, exact in pairs)


# --- Steps ------------------------------------------------------------------------------------------------------------


def limit_error(damping: float) -> float:
    """Of RK4's longest stable step of one link, and of twelve without dashpots, by the roots of its motion.

    `damping` is the ratio of its dashpot to a critical one.
    """
    from scipy.optimize import brentq

    from verify.chain.dynamics import at_rest, linearise
    from verify.chain.stepping import highest_rate, step_limit

    plain = build_system(held("clamped", "free"), 1)
    inertia = float(plain.inertias[0] + 0.25 * plain.masses[0] * plain.lengths[0] ** 2)
    omega = sqrt(float(plain.stiffness[0]) / inertia)
    one = changed(plain, dashpots=np.array([2.0 * damping * omega * inertia]))
    roots = np.roots([1.0, 2.0 * damping * omega, omega**2])

    def growth(h: float) -> float:
        return float(largest(abs(1.0 + w + w**2 / 2.0 + w**3 / 6.0 + w**4 / 24.0) for w in roots * h)) - 1.0

    unit = 1.0 / float(abs(roots).max())
    exact = brentq(growth, 2.5 * unit, 3.0 * unit, xtol=1e-12 * unit)
    share = step_limit(one, at_rest(one)) / float(exact)
    worst = max(20.0 * (1.0 - share), float(share > 1.0 + 1e-7))  # a grid's last stable one
    many = build_system(held("pinned", "pinned"), 12)
    fastest = float(linearise(many, at_rest(many)).frequencies()[-1])
    state = ChainState(np.zeros(12), np.zeros(12))
    off = max(abs(highest_rate(many, state) / fastest - 1.0), abs(step_limit(many, state) * fastest / sqrt(8.0) - 1.0))
    return largest(worst, off)


# --- Landing ----------------------------------------------------------------------------------------------------------


def landing_error(ratio: float) -> float:
    """Of how fast a mass leaves a spring beside a dashpot, and of the dashpot by it, by a crossing of its motion."""
    from scipy.linalg import expm
    from scipy.optimize import brentq

    from verify.contact.landing import contact_time, damping_ratio_for, lift_off_ratio, restitution

    flow = np.array([[0.0, 1.0], [-1.0, -2.0 * ratio]])

    def pushed(t: float) -> float:
        p, v = expm(flow * t) @ np.array([0.0, 1.0])
        return float(p + 2.0 * ratio * v)

    grid = np.linspace(1e-6, 2.0 * pi, 400)
    after = next(i for i in range(1, len(grid)) if pushed(float(grid[i])) < 0.0)
    left = float(brentq(pushed, grid[after - 1], grid[after], xtol=1e-14, rtol=1e-14))
    speed = -float((expm(flow * left) @ np.array([0.0, 1.0]))[1])
    shaken = abs(1.0 - 0.7**2 / complex(1.0, 1.4 * ratio))
    pairs = [(contact_time(ratio), left), (restitution(ratio), speed), (lift_off_ratio(0.7, ratio), shaken)]
    pairs += [(damping_ratio_for(speed), ratio)] if ratio else []
    return largest(abs(found / exact - 1.0) for found, exact in pairs)


ROWS: tuple[Row, ...] = (
    Floor(
        id="modes-of-long-chains",
        title="All modes of a chain with and without a roller by the long chain's way: shapes, duals, tilt",
        why="chain/modes.py: the linear chain's factors against dense matrices of relative angles.",
        along="links",
        at=(7, 12),
        promise=1e-9,
        error=all_modes_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="chains-that-drift",
        title="A hinged chain that spins about its hinge by the linear flow, as far as it spins",
        why="chain/splitting.py: what no spring holds goes on; a root of rounding may swing instead.",
        along="s",
        at=(0.01, 0.1),
        promise=1e-6,
        error=drift_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="coils-that-stretch",
        title="Energy of a coil of links that stretch, spins, drifts and sinks, and places on it",
        why="chain/stretching.py: bars, springs and weights one by one, to rounding.",
        along="radians",
        at=(0.2, 0.9),
        promise=1e-12,
        error=stretched_error,
    ),
    Floor(
        id="coils",
        title="Places on a coil of rigid links on a turning hub, and what its books miss",
        why="chain/result.py: link by link, to rounding.",
        along="radians",
        at=(0.2, 0.9),
        promise=1e-12,
        error=coil_error,
    ),
    Floor(
        id="hubs-that-stand",
        title="A chain at rest on a hub turned by an amplitude at a phase, against one turned by as much",
        why="chain/system.py: an amplitude without a frequency stands still.",
        along="degrees",
        at=(33.0, 250.0),
        promise=1e-12,
        error=turned_error,
    ),
    Floor(
        id="turning-forces",
        title="Forces, their derivatives and moments by rates of a bent chain on a turning base, by differences",
        why="chain/statics.py: derivatives of the moment of inertia and of the angular momentum, by steps of 1e-5.",
        along="radians",
        at=(0.1, 0.8),
        promise=1e-7,
        error=turning_error,
    ),
    Floor(
        id="limits-of-rk4",
        title="RK4's longest stable step of a link with a dashpot and of twelve links, by the roots of their motion",
        why="chain/stepping.py: a grid of 1e-4, roots to 1e-3.",
        along="of critical",
        at=(0.0, 0.3, 1.7, 20.0),
        promise=2e-3,
        error=limit_error,
        kernels=warm.rigid,
    ),
    Floor(
        id="landings",
        title="How long a mass stays on a spring beside a dashpot, how fast it leaves, and the dashpot by that",
        why="contact/landing.py: closed forms, against exponentials of matrices and a root.",
        along="of critical",
        at=(0.0, 0.3, 0.98, 2.6),
        promise=1e-9,
        error=landing_error,
    ),
)
