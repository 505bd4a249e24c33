"""Small motion of the nonlinear chain about an equilibrium: matrices, natural frequencies, stability."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.chain.statics import inertia_products, potential
from verify.chain.system import ChainState, ChainSystem
from verify.errors import InputError
from verify.segments.walls import tension_excess, wall_factors
from verify.settings import DEFAULT, Wall


@dataclass(frozen=True, eq=False)
class Linearisation:
    """M q'' + K q = 0 with constraint q = 0, q the relative angles; N x N matrices."""

    mass: Array  # kg m^2
    stiffness: Array  # N m, with the geometric stiffness of loads and of the roller's reaction
    constraint: Array  # (n, N), m: derivatives of the roller's y; n = 0 for a free tip

    def independent(self) -> Array:
        """Basis (N, N - n) of the admissible motions; the angle with the longest lever arm is dependent.

        R. A. Wehage and E. J. Haug, J. Mech. Design 104 (1982) 247.
        """
        n = len(self.mass)
        if not len(self.constraint):
            return np.eye(n)
        row = self.constraint[0]
        pivot = int(abs(row).argmax())
        return np.delete(np.eye(n) - np.outer(np.eye(n)[pivot], row / row[pivot]), pivot, axis=1)

    def frequencies(self) -> Array:
        """Undamped circular frequencies, (N - n,), ascending, rad/s; squares within rounding are 0.

        Raises InputError at an unstable equilibrium.
        """
        from scipy.linalg import LinAlgError, eigh

        basis = self.independent()
        mass, stiffness = (basis.T @ m @ basis for m in (self.mass, self.stiffness))
        try:  # low frequencies are accurate in the inverse problem
            squares, rounding = np.asarray(1.0 / eigh(mass, stiffness, eigvals_only=True)[::-1]), 0.0
        except LinAlgError:  # unstable, or with a rigid-body rotation
            squares, rounding = eigh(stiffness, mass, eigvals_only=True), len(mass) * np.finfo(float).eps
        squares = np.where(abs(squares) <= rounding * abs(squares).max(), 0.0, squares)
        growing = squares[squares < 0.0]
        if len(growing):
            raise InputError(
                f"the equilibrium is unstable: {len(growing)} modes grow (lowest omega^2 = {growing[0]:.4g} 1/s^2), "
                "give a smaller load or another equilibrium"
            )
        return np.asarray(np.sqrt(squares))


def linearise(system: ChainSystem, state: ChainState) -> Linearisation:
    """Equations of the chain linearised about an equilibrium under constant loads, in the frame of the hub.

    About the straight chain the matrices are those of `SegmentModel`. Raises InputError for a moving state, for a chain
    perpendicular to the path of its roller, and for a bent one that rotates, whose equations are gyroscopic.
    """
    if np.any(state.rates):
        raise InputError("state.rates: the linearisation is about an equilibrium, give zero rates")
    angles = np.asarray(state.angles, dtype=float)
    at, products = potential(system, angles), inertia_products(system)
    if system.tip == "roller" and abs(at.closure).max() <= 1e-9 * system.length:
        raise InputError("state.angles: the chain is perpendicular to the path of its roller, give others")
    theta = np.cumsum(angles)
    difference = np.subtract.outer(theta, theta)
    if system.hub_rate and difference.any():
        raise InputError("state.angles: a bent chain that rotates has gyroscopic terms, give a straight one")
    transverse = products * np.outer(np.cos(theta), np.cos(theta))
    mass = (products * np.cos(difference) if system.axial_inertia else transverse) + np.diag(system.inertias)
    stiffness = np.diag(at.geometric + at.reaction() @ at.closure_geometric)
    stiffness += at.full if len(at.full) else 0.0
    sums: Any = np.tril(np.ones((system.n_links, system.n_links)))  # absolute from relative angles
    return Linearisation(
        mass=sums.T @ mass @ sums,
        stiffness=sums.T @ stiffness @ sums + np.diag(np.asarray(system.stiffness, dtype=float)),
        constraint=at.closure @ sums,
    )


def tensioned(system: ChainSystem, wall: Wall = DEFAULT.wall) -> ChainSystem:
    """The chain with joints that are softer by T l/12, T the axial force of rotation, translation and gravity along it.

    A link of length l turns as a whole where the beam under tension T bends, which changes frequencies by (k l)^2/12 of
    T's part. Joints EI/l - T l/12 take it off, with the weights of `wall` beside a clamp as under the constant T of a
    linear chain (`segments.walls`): order 4 of a uniform beam where T varies, too, along it or in time. T is that of
    the straight chain, in steady rotation or, on a base that moves, at the time of the step. For vibrations alone,
    since buckling loads err to the other side. Raises InputError where no axial force acts or a joint keeps no
    stiffness; `simulate` raises it for a moving base under dead forces and for a chain that bends far.
    """
    lengths = np.append(system.lengths[:1], 0.5 * (system.lengths[1:] + system.lengths[:-1]))
    factors = wall_factors(("clamped", "free"), system.n_links, wall)[:-1]
    weights = 1.0 / factors
    weights[0] += tension_excess(wall) / factors[0] ** 2
    softening = np.where(system.stiffness > 0.0, lengths / 12.0 * weights, 0.0)
    if system.base.moves:
        return replace(system, softening=softening)
    tension = system.tension(0.0)
    if not tension.any():
        raise InputError("chain.hub_rate = 0.0 and no gravity along the chain: no axial force softens a joint")
    stiffness = system.stiffness - tension * softening
    if (stiffness[system.stiffness > 0.0] <= 0.0).any():
        raise InputError(f"count = {system.n_links}: the axial force leaves no stiffness in a joint, give more links")
    return replace(system, stiffness=stiffness)
