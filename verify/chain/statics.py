"""Static equilibrium of the nonlinear chain by Newton with continuation in the load; its forces in absolute angles."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.chain.system import ChainState, ChainSystem, held_points
from verify.errors import InputError

TOLERANCE = 1e-9
"""Residual moment, relative to the largest moment in the chain."""
SETTLED = 1e-7
"""Radians: after a Newton step this small the next one would be rounding."""
MAX_TURN = 0.8
"""Radians that a Newton step may turn a link."""


@dataclass(frozen=True, eq=False)
class Forces:
    """Generalised forces of a chain at absolute angles theta, and their derivatives."""

    moments: Array
    """(N,), N m: gradient of the potential energy, joints apart."""
    springs: Array
    """(N,): gradient of the joints' energy."""
    geometric: Array
    """(N,): second derivatives of the loads' potential, a diagonal."""
    reach_x: Array
    """(N,), metres: derivatives of the tip's x."""
    held_rows: Array
    """(n_held, N), metres: derivatives of the held points' y."""
    held_bends: Array
    """(n_held, N), metres: minus their second derivatives, a diagonal each."""
    gaps: Array
    """(n_held,), metres: how far the held points are off."""
    turning: Array
    """(N, N), N m: stiffness by the centrifugal forces of a turning base; (0, 0) where it does not turn."""

    def multipliers(self) -> Array:
        """Forces on the held points, (n_held,), upwards, newton: least squares of the equilibrium of moments."""
        if not len(self.held_rows):
            return np.zeros(0)
        return np.asarray(np.linalg.lstsq(self.held_rows.T, self.moments + self.springs, rcond=None)[0], dtype=float)


def mass_products(system: ChainSystem) -> Array:
    """What the cosines of differences of angles are multiplied with in the kinetic energy, (N, N), kg m^2."""
    lengths, masses = system.lengths, system.masses
    half, links = lengths / 2.0, np.arange(system.n_links)
    beyond = np.cumsum(masses[::-1])[::-1] - masses
    moment = half * masses + lengths * beyond
    product = lengths[np.minimum.outer(links, links)] * moment[np.maximum.outer(links, links)]
    np.fill_diagonal(product, half**2 * masses + lengths**2 * beyond)
    return np.asarray(product)


def mass_matrix(system: ChainSystem, theta: Array) -> Array:
    """Mass matrix over the absolute angles, (N, N)."""
    c, s = np.cos(theta), np.sin(theta)
    turning = np.outer(c, c) + (np.outer(s, s) if system.axial_inertia else 0.0)
    return np.asarray(mass_products(system) * turning + np.diag(system.inertias))


def centrifugal(system: ChainSystem, theta: Array) -> tuple[Array, Array]:
    """Gradient (N,) and second derivatives (N, N) of minus half rate^2 times the moment of inertia about the base.

    That moment is the sum of `mass_products` times cos(theta_i - theta_j). Raises InputError where something acts on
    the chain that does not turn with the base.
    """
    _refuse_still(system)
    angles = np.subtract.outer(theta, theta)
    products = system.rotation.rate**2 * mass_products(system)
    stiffness = -products * np.cos(angles)
    np.fill_diagonal(stiffness, 0.0)
    np.fill_diagonal(stiffness, -stiffness.sum(axis=1))
    return np.asarray((products * np.sin(angles)).sum(axis=1)), stiffness


def gyroscopic(system: ChainSystem, theta: Array) -> Array:
    """Moments by rates of a chain whose base turns, (N, N), N m s, antisymmetric; none where it is straight."""
    return np.asarray(2.0 * system.rotation.rate * mass_products(system) * np.sin(np.subtract.outer(theta, theta)))


def _refuse_still(system: ChainSystem) -> None:
    """Raise InputError for what keeps its direction while the base turns: there is no equilibrium then."""
    dead = any(load.frequency_hz == 0.0 and any(load.force) for load in system.loads)
    still = system.tip == "roller" or system.actuators or any(system.gravity) or dead or not system.axial_inertia
    if still:
        raise InputError(
            f"rotation.rate = {system.rotation.rate!r}: a roller, actuators, gravity, dead forces and inertia across "
            "alone do not turn with the base, so that there is no equilibrium; leave them out or give rate = 0"
        )


def forces_at(system: ChainSystem, angles: Array, factor: float) -> Forces:
    """Forces at relative angles under `factor` times the constant loads, gravity and displacements.

    Where the base turns steadily the angles are those in the turning frame and centrifugal forces are among them.
    Raises InputError where no equilibrium can turn with it.
    """
    theta = system.rotation.constant + np.cumsum(angles)
    c, s = np.cos(theta), np.sin(theta)
    lengths, spin, turning = system.lengths, np.zeros(system.n_links), np.zeros((0, 0))
    if system.rotation.rate:
        spin, turning = centrifugal(system, theta)
    push, lever_x, lever_y, turn = _load_sums(system, factor)
    beyond = np.cumsum(push[::-1], axis=0)[::-1] - push
    ax, ay = lengths * beyond[:, 0] + lever_x, lengths * beyond[:, 1] + lever_y
    stretch = system.axial_spring * float((lengths * (c - 1.0)).sum())
    joints = system.stiffness * angles
    springs = joints - np.append(joints[1:], 0.0)
    reach_x = -lengths * s
    return Forces(
        moments=-(ay * c - ax * s) - turn + stretch * reach_x + spin,
        springs=springs,
        geometric=ay * s + ax * c - stretch * lengths * c,
        reach_x=reach_x,
        turning=turning,
        **_held(system, theta, factor),
    )


def _load_sums(system: ChainSystem, factor: float) -> tuple[Array, Array, Array, Array]:
    """Forces on each link, (N, 2), their first moments from the near joint along x and y, and free moments."""
    push = factor * np.outer(system.masses, system.gravity)
    lever = push * (system.lengths / 2.0)[:, None]
    turn = np.zeros(system.n_links)
    for load in system.loads:
        if load.frequency_hz == 0.0:
            now = factor * np.cos(np.deg2rad(load.phase_deg))
            force = now * np.array(load.force)
            push[load.link - 1] += force
            lever[load.link - 1] += load.at * force
            turn[load.link - 1] += now * load.moment
    return push, lever[:, 0], lever[:, 1], turn


def _held(system: ChainSystem, theta: Array, factor: float) -> dict[str, Array]:
    """Rows, bends and gaps of the held points; a harmonic actuator rests in its middle."""
    c, s = np.cos(theta), np.sin(theta)
    wanted = [0.0] * (system.tip == "roller") + [
        factor * a.amplitude * np.cos(np.deg2rad(a.phase_deg)) if a.frequency_hz == 0.0 else 0.0
        for a in system.actuators
    ]
    reach = np.zeros((len(wanted), system.n_links))
    for row, (link, at) in zip(reach, held_points(system), strict=True):
        row[: link - 1] = system.lengths[: link - 1]
        row[link - 1] = at
    return {"held_rows": reach * c, "held_bends": reach * s, "gaps": reach @ s - np.array(wanted)}


def solve_static(system: ChainSystem, start: ChainState | None = None) -> ChainState:
    """Equilibrium under the constant loads, gravity and displacements, from a start (straight unless given).

    Newton on angles and held forces at once, in O(N); where it fails the load is raised in smaller parts. Raises
    InputError where no part converges: an instability, or a mechanism.
    """
    angles = np.zeros(system.n_links) if start is None else np.array(start.angles, dtype=float)
    done, part = 0.0, 1.0
    while done < 1.0:
        wanted = min(done + part, 1.0)
        found = _newton(system, angles, wanted)
        if found is not None:
            angles, done, part = found, wanted, 2.0 * part
        elif part > 1e-3:
            part *= 0.25
        else:
            raise InputError(
                f"chain.loads: no equilibrium found beyond {done:.3g} of the load; give less of it, or a support "
                "where the chain is a mechanism (in Python, a start nearer to it)"
            )
    return ChainState(angles, np.zeros(system.n_links))


def _newton(system: ChainSystem, angles: Array, factor: float) -> Array | None:
    """Relative angles in equilibrium under a share of the load; None where 60 steps do not suffice."""
    found = forces_at(system, angles, factor)
    held = found.multipliers()
    for _ in range(60):
        residual = np.concatenate([found.moments + found.springs - held @ found.held_rows, found.gaps])
        scale = abs(found.moments).max() + abs(system.stiffness * angles).max() + abs(held @ found.held_rows).max()
        step = _newton_step(system, found, held, residual)
        if step is None:
            return None
        turn = step[: system.n_links]
        share = min(1.0, MAX_TURN / max(abs(turn).max(), 1e-300))
        angles, held = angles + share * np.diff(turn, prepend=0.0), held + share * step[system.n_links :]
        if abs(residual[: system.n_links]).max() <= TOLERANCE * scale and abs(turn).max() < SETTLED:
            return angles
        found = forces_at(system, angles, factor)
    return None


def _newton_step(system: ChainSystem, found: Forces, held: Array, residual: Array) -> Array | None:
    """Change of angles and held forces: tridiagonal, bordered by held points and axial spring."""
    import warnings

    from scipy.sparse import block_array, csc_array, diags_array
    from scipy.sparse.linalg import MatrixRankWarning, spsolve

    k = system.stiffness
    diagonal = k + np.append(k[1:], 0.0) + found.geometric + held @ found.held_bends
    core: Any = diags_array([-k[1:], diagonal, -k[1:]], offsets=[-1, 0, 1])
    if len(found.turning):
        core = core + csc_array(found.turning)
    border, corner = found.held_rows, np.zeros(len(held))
    if system.axial_spring:
        border, corner = np.vstack([border, found.reach_x]), np.append(corner, 1.0 / system.axial_spring)
        residual = np.append(residual, 0.0)
    matrix = core.tocsc()
    if len(border):
        rows = csc_array(border)
        matrix = block_array([[core, -rows.T], [rows, diags_array(corner)]], format="csc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MatrixRankWarning)
        step = np.atleast_1d(spsolve(matrix, -residual))
    return step[: system.n_links + len(held)] if np.isfinite(step).all() else None
