"""Static equilibria of the nonlinear chain under dead loads, by Newton's method and continuation in the load.

The potential energy in the absolute angles theta is that of joints, constant loads, gravity, an axial spring at the
roller and, for a steadily rotating hub, centrifugal forces. Beyond its buckling load a cantilever has several
equilibria, any of which Newton's method may reach; `bend` follows the path of stable equilibria from zero load.
"""

from dataclasses import replace
from math import cos, radians
from typing import Any, NamedTuple

import numpy as np
from msgspec import Struct, structs

from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.chain.system import ChainState, ChainSystem, LinkLoad, build_system
from verify.errors import InputError, shown
from verify.formatting import one_line
from verify.linear.positions import Numbers, as_vector
from verify.problem.beam import Beam
from verify.settings import DEFAULT, Joints, Wall
from verify.validation import check_integer, check_number

RESIDUAL = 1e-9  # tolerance of the residual moment, relative to the largest moment in the chain
LAST_STEP = 1e-7  # size of a Newton step, rad, after which the next one is rounding (quadratic convergence)
LARGEST_STEP = 0.8  # largest rotation of a link in one Newton step, rad
CORRECTION = 0.5
"""Largest correction of a step along the stable path, relative to its predictor; a larger one leads to another path."""


class Potential(NamedTuple):
    """Derivatives of a chain's potential energy by its absolute angles; closure by n rollers, 0 or 1."""

    gradient: Array  # (N,), N m, without joints
    joints: Array  # (N,), N m, of the joints' energy
    geometric: Array  # (N,), N m: diagonal of the geometric stiffness of loads and axial spring
    closure: Array  # (n, N), m: derivatives of the roller's y
    closure_geometric: Array  # (n, N), m: minus its second derivatives, a diagonal
    gap: Array  # (n,), m: height of the roller
    full: Array  # (N, N), N m: stiffness by axial spring and centrifugal forces; (0, 0) without them

    def reaction(self) -> Array:
        """Upward force of the roller, (n,), N: least squares of the moment balance."""
        if not len(self.closure):
            return np.zeros(0)
        return np.asarray(np.linalg.lstsq(self.closure.T, self.gradient + self.joints, rcond=None)[0], dtype=float)


def inertia_products(system: ChainSystem) -> Array:
    """Coefficients of cos(theta_i - theta_j) in the mass matrix over absolute angles, (N, N), kg m^2."""
    lengths, masses, links = system.lengths, system.masses, np.arange(system.n_links)
    outboard = np.cumsum(masses[::-1])[::-1] - masses
    moment = 0.5 * lengths * masses + lengths * outboard
    products = lengths[np.minimum.outer(links, links)] * moment[np.maximum.outer(links, links)]
    np.fill_diagonal(products, lengths**2 * (0.25 * masses + outboard))
    return np.asarray(products)


def potential(system: ChainSystem, angles: Array, factor: float = 1.0) -> Potential:
    """The derivatives at relative angles, (N,), under `factor` times the constant loads and gravity.

    The frame rotates with a steadily rotating hub. Raises InputError for loads and supports that do not.
    """
    if system.base.moves:
        raise InputError("chain.base: an equilibrium has a base at rest or a steady hub_rate, give one of the two")
    lengths, n_closures = system.lengths, int(system.tip == "roller")
    theta = np.cumsum(angles)
    c, s = np.cos(theta), np.sin(theta)
    forces = factor * np.outer(system.masses, system.gravity)
    arms, moments = 0.5 * lengths[:, None] * forces, np.zeros(system.n_links)
    for load in system.loads:
        if load.frequency_hz == 0.0:
            force = factor * cos(radians(load.phase_deg)) * np.array([*load.force, load.moment])
            forces[load.link - 1] += force[:2]
            arms[load.link - 1] += load.at * force[:2]
            moments[load.link - 1] += force[2]
    if system.hub_rate:
        if n_closures or forces.any() or not system.axial_inertia:
            raise InputError(
                f"chain.hub_rate = {system.hub_rate!r}: a roller, gravity, dead forces and links without axial "
                "inertia do not rotate with the hub, no equilibrium exists; leave them out or give 0"
            )
        centrifugal = system.hub_rate**2 * system.base.hub_radius * system.masses  # that of the radius alone
        forces[:, 0], arms[:, 0] = centrifugal, 0.5 * lengths * centrifugal
    outboard = np.cumsum(forces[::-1], axis=0)[::-1] - forces
    along, across = (lengths[:, None] * outboard + arms).T
    spring = system.axial_spring * float(lengths @ (c - 1.0))
    gradient, full = along * s - across * c - moments - spring * lengths * s, np.zeros((0, 0))
    if system.axial_spring:
        full = system.axial_spring * np.outer(lengths * s, lengths * s)
    if system.hub_rate:
        products, difference = system.hub_rate**2 * inertia_products(system), np.subtract.outer(theta, theta)
        gradient += (products * np.sin(difference)).sum(axis=1)
        full = -products * np.cos(difference)
        np.fill_diagonal(full, np.diag(full) - full.sum(axis=1))
    joints = system.stiffness * angles
    return Potential(
        gradient=gradient,
        joints=joints - np.append(joints[1:], 0.0),
        geometric=across * s + along * c - spring * lengths * c,
        closure=(lengths * c)[None][:n_closures],
        closure_geometric=(lengths * s)[None][:n_closures],
        gap=(lengths @ s)[None][:n_closures],
        full=full,
    )


def solve_static(system: ChainSystem, start: ChainState | None = None) -> ChainState:
    """Equilibrium under the constant loads and gravity from `start` (default: the straight chain).

    Newton's method for angles and reaction, O(N) without axial spring and rotation; where it fails, continuation in
    the load. Raises InputError where that fails: an instability, or a mechanism.
    """
    angles = np.zeros(system.n_links) if start is None else np.array(start.angles, dtype=float)
    angles, share = _raise_load(system, angles, 1.0, 1e-3)
    if share < 1.0:
        raise InputError(
            f"chain.loads: no equilibrium beyond {share:.3g} of the load; reduce it, or add a support if the chain is "
            "a mechanism (in Python, give a nearer start)"
        )
    return ChainState(angles, np.zeros(system.n_links))


def _raise_load(
    system: ChainSystem, angles: Array, part: float, least: float, stable: bool = False
) -> tuple[Array, float]:
    """(equilibrium by continuation in the load, fraction of the load); below 1 where steps of size `least` fail."""
    first, done = part, 0.0
    while done < 1.0:
        share = min(done + part, 1.0)
        solution = _newton(system, angles, share, stable)
        if solution is not None:
            angles, done, part = solution, share, min(2.0 * part, share)
        elif part > least * max(done, first):
            part *= 0.25
        else:
            break
    return angles, done


def _newton(system: ChainSystem, start: Array, share: float, stable: bool) -> Array | None:
    """Relative angles in equilibrium under a fraction of the load; None if 60 steps do not converge.

    With `stable` every iterate must be stable, and corrections small against the first step: beyond a fold Newton's
    method leads to another path.
    """
    angles, first, n = start, np.zeros(0), system.n_links
    state = potential(system, angles, share)
    reaction = state.reaction()
    for _ in range(60):
        closure = reaction @ state.closure
        residual = state.gradient + state.joints - closure
        scale = sum(abs(moment).max() for moment in (state.gradient, system.stiffness * angles, closure))
        step = _stable_step(system, state) if stable else _bordered_step(system, state, reaction, residual)
        largest = np.inf if step is None else abs(step[:n]).max()
        if step is None or not np.isfinite(largest) or (stable and largest > LARGEST_STEP):
            return None
        step = step * min(1.0, LARGEST_STEP / max(largest, 1e-300))
        angles, reaction = angles + np.diff(step[:n], prepend=0.0), reaction + step[n:]
        first = first if len(first) else step
        if stable and abs(np.cumsum(angles - start) - first).max() > CORRECTION * abs(first).max():
            return None
        state = potential(system, angles, share)
        if abs(residual).max() <= RESIDUAL * scale and largest < LAST_STEP:
            return angles if not stable or _stable_step(system, state) is not None else None
    return None


def _stable_step(system: ChainSystem, state: Potential) -> Array | None:
    """Newton step (N,) of a chain with a free tip by Cholesky factors; None unless its stiffness is positive."""
    from scipy.linalg import LinAlgError, solveh_banded

    k = system.stiffness
    bands = np.array([k + np.append(k[1:], 0.0) + state.geometric, np.append(-k[1:], 0.0)])
    try:
        return np.asarray(solveh_banded(bands, -(state.gradient + state.joints), lower=True))
    except LinAlgError:
        return None


def _bordered_step(system: ChainSystem, state: Potential, reaction: Array, residual: Array) -> Array:
    """Newton step of angles and reaction, (N + n,): tridiagonal except closure, axial spring and rotation."""
    import warnings

    from scipy.sparse import block_array, csc_array, diags_array
    from scipy.sparse.linalg import MatrixRankWarning, spsolve

    k = system.stiffness
    diagonal = k + np.append(k[1:], 0.0) + state.geometric + reaction @ state.closure_geometric
    matrix: Any = diags_array([-k[1:], diagonal, -k[1:]], offsets=[-1, 0, 1]).tocsc()
    if len(state.full):
        matrix = matrix + csc_array(state.full)
    if len(reaction):
        rows = csc_array(state.closure)
        matrix = block_array([[matrix, -rows.T], [rows, None]], format="csc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MatrixRankWarning)
        return np.atleast_1d(spsolve(matrix, -np.concatenate([residual, state.gap])))


class Bent(Struct, frozen=True, eq=False, kw_only=True):
    """Equilibrium of a cantilever of rigid links, clamped at x = 0; x along the straight beam, y transverse."""

    beam: Beam
    count: int
    """Segments N."""
    joints: Array
    """(N + 1, 2), m: (x, y) from the clamp to the tip."""
    angles: Array
    """(N,), rad: rotation of each link, equal to that of the beam at the link's middle."""
    turn: float
    """Rotation of the tip, rad, including the bending of the last half link by the applied moment."""
    moments: Array
    """(N + 1,), N m: bending moment at each joint; the applied moment at the tip."""
    curvature: Array
    """(N + 1,), 1/m: moment over EI, at a step of the right section."""
    energy: float
    """Elastic energy, J: of the joints, and of the last half link under the applied moment."""
    __repr__ = one_line(count="", deflection="m", turn="rad", energy="J")

    @property
    def tip(self) -> Array:
        """(2,), m: (x, y) of the free end."""
        return np.asarray(self.joints[-1])

    @property
    def deflection(self) -> float:
        """Transverse displacement of the tip, m."""
        return float(self.joints[-1, 1])

    @property
    def shortening(self) -> float:
        """Axial displacement of the tip towards the clamp, m."""
        return self.beam.length - float(self.joints[-1, 0])


@one_blas_thread()
def bend(
    beam: Beam,
    count: int,
    load: Numbers = 0.0,
    *,
    moment: float = 0.0,
    wall: Wall = DEFAULT.wall,
    joints: Joints = DEFAULT.joints,
) -> Bent:
    """Large bending of a cantilever of `count` links under a dead `load` (N) and a `moment` (N m) at its tip.

    `load` is a transverse force, or a pair (axial, transverse), of constant direction. Tip position, rotation and
    energy converge to the elastica (K. E. Bisshopp and D. C. Drucker, Quart. Appl. Math. 3 (1945) 272) with order 2 in
    `count`. A joint represents the half links on either side; the last half link has no joint, and its bending under
    `moment` is added to rotation and energy. Under a moment alone both are exact, and with wall = "half" the circle
    closes. Beyond the buckling load the result is the stable equilibrium on the path of proportional loading from
    zero. Raises InputError for supports other than clamped and free, bodies on the beam, pure axial compression beyond
    the buckling load, and where the stable path ends.
    """
    if beam.supports != ("clamped", "free"):
        raise InputError(f"beam.supports = {beam.supports!r}: bend takes a cantilever, give ('clamped', 'free')")
    check_integer("count", count, 2)
    force = as_vector("load", load, "newton")
    if force.shape not in ((1,), (2,)):
        raise InputError(f"load = {shown(load)}: give one number across the beam, or two, along and across (newton)")
    along, across = (0.0, float(force[0])) if len(force) == 1 else (float(force[0]), float(force[1]))
    for name, value in (("force x", along), ("force y", across), ("moment", moment)):
        check_number(f"load.{name}", value, "N, N m")
    system = build_system(structs.replace(beam, loss_factor=0.0), count, wall=wall, joints=joints)
    end = LinkLoad(link=count, at=float(system.lengths[-1]), force=(along, across), moment=float(moment))
    relative = _stable_equilibrium(replace(system, loads=(end,)), along, across, float(moment))
    angles, moments = np.cumsum(relative), np.append(system.stiffness * relative, moment)
    links = system.lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    starts = np.cumsum([0.0, *(piece.length for piece in beam.pieces[:-1])])
    sections = np.searchsorted(starts, system.nodes + 1e-12 * beam.length, side="right") - 1
    curvature = moments / np.array([piece.bending_stiffness for piece in beam.pieces])[sections]
    half_link = 0.5 * float(system.lengths[-1] * curvature[-1])
    return Bent(
        beam=beam,
        count=count,
        joints=np.vstack([np.zeros(2), np.cumsum(links, axis=0)]),
        angles=angles,
        turn=float(angles[-1]) + half_link,
        moments=moments,
        curvature=curvature,
        energy=0.5 * (float(moments[:-1] @ relative) + moment * half_link),
    )


def _stable_equilibrium(system: ChainSystem, along: float, across: float, moment: float) -> Array:
    """Relative angles, (N,), of a cantilever on the stable path from zero load."""
    from scipy.linalg import eigh_tridiagonal

    k, root, size = system.stiffness, np.sqrt(system.lengths), float(np.hypot(along, across))
    diagonal, off_diagonal = (k + np.append(k[1:], 0.0)) / system.lengths, -k[1:] / (root[1:] * root[:-1])
    critical = float(eigh_tridiagonal(diagonal, off_diagonal, eigvals_only=True, select="i", select_range=(0, 0))[0])
    if along < 0.0 and not across and not moment and -along >= critical:
        raise InputError(
            f"load = {shown((along, across))} N exceeds the buckling load of {critical:.6g} N of the straight "
            "cantilever, which may buckle to either side: add a small transverse force, or reduce it"
        )
    if size < critical or (along >= 0.0 and not moment):
        angles = solve_static(system).angles
        if size < critical or _stable_step(system, potential(system, angles)) is not None:
            return angles
    angles, share = _raise_load(system, np.zeros(system.n_links), min(0.9 * critical / size, 1.0), 1e-12, stable=True)
    if share < 1.0:
        applied = f"load = {shown((along, across))} N" + (f" with moment = {shown(moment)} N m" if moment else "")
        raise InputError(
            f"{applied} buckles the cantilever (buckling load {critical:.6g} N): the path of stable equilibria ends at "
            f"{share:.6g} of it, give {'another moment' if moment else 'a larger transverse force'}, or less load"
        )
    return angles
