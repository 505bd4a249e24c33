"""The lowest modes of a long straight chain, by the linear chain's own factored pencil, in relative angles."""

import numpy as np

from verify.chain.system import ChainSystem, straight_chain
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.eigen import lowest
from verify.segments.assembly import chain_pencil
from verify.segments.links import joint_masses, with_ends


def lowest_modes(system: ChainSystem, n_modes: int) -> tuple[Array, Array, Array, float]:
    """Frequencies (m,), modes and duals (m, N) in relative angles, and the tilt; m counts the roller's motion too.

    With a roller the last row is the motion that leaves its line, orthogonal to the others in mass: the chain's answer
    to a transverse force at the tip. Unit modal mass. Raises InputError for a chain that is loaded or sprung along
    its length, a joint without a spring, or more modes than there are.
    """
    _check(system, n_modes)
    unit, spring, mass = system.lengths.mean(), system.stiffness.max(), system.masses.mean()
    chain = straight_chain(system, unit=float(unit), mass=float(mass), spring=float(spring))
    pairs = lowest(chain_pencil(chain), n_modes)
    omega = np.sqrt(pairs.values * spring / mass) / unit
    places, tilt = with_ends(chain, pairs.vectors)[1:].T / np.sqrt(mass), 0.0
    if system.tip == "roller":
        normal = _answer_of_tip(system)
        places, omega, tilt = np.vstack([places, normal]), np.append(omega, 0.0), float(normal[-1])
    return omega, _angles(system, places), _duals(system, places), tilt


def _check(system: ChainSystem, n_modes: int) -> None:
    loaded = any(load.frequency_hz == 0.0 for load in system.loads) or any(system.gravity)
    if loaded or system.axial_spring or system.rotation.offset:
        raise InputError("n_modes: the lowest modes alone are those of an unloaded chain; leave n_modes out")
    if (system.stiffness[1:] == 0.0).any():
        raise InputError("chain.stiffness has joints without a spring: leave n_modes out")
    most = system.n_links - (system.tip == "roller") - int(system.stiffness[0] == 0.0 and system.tip == "free")
    if not 1 <= n_modes <= most:
        raise InputError(f"n_modes = {n_modes!r}: the chain has elastic modes 1 to {most}")


def _mass(system: ChainSystem) -> tuple[Array, Array]:
    """Mass matrix over joints 1..N, the base held: diagonal (N,) and coupling (N - 1,)."""
    diagonal, shared = joint_masses(system.masses, system.inertias, system.lengths)
    return diagonal[1:], shared[1:]


def _answer_of_tip(system: ChainSystem) -> Array:
    """M^-1 e_N over joints 1..N, of unit modal mass."""
    from scipy.linalg import solveh_banded

    diagonal, coupling = _mass(system)
    force = np.zeros(system.n_links)
    force[-1] = 1.0
    answer = solveh_banded(np.stack([np.append(0.0, coupling), diagonal]), force)
    return np.asarray(answer / np.sqrt(answer[-1]), dtype=float)


def _angles(system: ChainSystem, places: Array) -> Array:
    """Relative angles of joint positions, (m, N)."""
    slopes = np.diff(places, axis=1, prepend=0.0) / system.lengths
    return np.asarray(np.diff(slopes, axis=1, prepend=0.0), dtype=float)


def _duals(system: ChainSystem, places: Array) -> Array:
    """What takes relative angles to modal coordinates: inertia forces, summed up the chain twice, (m, N)."""
    diagonal, coupling = _mass(system)
    forces = diagonal * places
    forces[:, :-1] += coupling * places[:, 1:]
    forces[:, 1:] += coupling * places[:, :-1]
    beyond = np.cumsum(forces[:, ::-1], axis=1)[:, ::-1] * system.lengths
    return np.ascontiguousarray(np.cumsum(beyond[:, ::-1], axis=1)[:, ::-1])
