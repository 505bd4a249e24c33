"""A chain with what it carries: axial force, foundation, bodies and springs, elastic ends, joints that slip.

Its unknowns are the free joint positions, the turns of bodies beyond elastic ends, and p = slip / sqrt(c) of every
joint and then every body that slips with a compliance c, so that stiff shear leaves a small mass and no large
stiffness. A joint that slips stands at the mean of both links' ends there. Strains are differences of positions and of
turns.

Energies of a link of length l, turn theta and middle z, halved: foundation k_f l z^2 + k_f l^3/12 theta^2, axial force
T l theta^2. With y = w - l^2 w''/12 the first has the form of the link's own inertia: order 4, and pinned ends shift
omega^2 by exactly k_f/rho A. The second sums to T (w'^2 + l^2/12 w''^2), so that omega^2 is off by +mu^2/12 of what T
gives it: order 2. Joints of EI - T l^2/12 in place of EI ("tensioned") take that away: order 4, and so of buckling,
where omega^2 is 0 (joints in series buckle at -mu^2/12). At a clamped wall Gregory's joints also turn the links by
-kappa l/8, +kappa l/24 off the smooth line, whose squares axial force feels: T l^3 kappa^2 (1/64 + 1/576)/2, order 3,
unless the wall's joint gives up 5/24 more (`walls.tension_excess`).

A link's thickness inertia rho I l theta^2 is an axial force -omega^2 rho I: order 2, -(beta r)^2 mu^2/12 of omega^2,
r^2 = I/A, which goes as T l/12 does: by rho I l/12 taken off the inertia where joints bend. Joints that slip by s with
kappa G A/l have, with S = 2 sin(mu/2)/l,

    EI S^4 - rho I omega^2 S^2 - rho A omega^2 (1 - l^2 S^2/6)
        - rho A omega^2/(kappa G A) (EI S^2 - rho I omega^2 - rho A omega^2 l^2/12) = 0

between pinned ends, the beam's but for terms in l^2: order 2, by the same -(beta r)^2 mu^2/12 and terms of second order
in the shear. No term in l^2 of EI or kappa G A takes that away: of EI it would leave one in omega^2 alone, of kappa G A
one in k^2 omega^2 that thickness inertia does not have at all frequencies. With rho I l/12 off where joints bend it is
(rho A omega^2/(kappa G A))^2 (EI k^2 - rho I omega^2) l^2/12, which rho A l/12 off where they slip takes away: order 4.
"""

from functools import cache
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.linear.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.segments.crowded import felt_together
from verify.segments.links import Chain, right_of, stiffness_at_joints


class _Placed(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What ground and axial force, springs and bodies make of a chain, beside its joints."""

    stiffness: Array
    """Of middles on the ground, of turns, of springs, of rotational springs, in this order."""
    n_grounded: int
    """How often all middles are held, 0 or 1."""
    n_tilted: int
    """How often all turns are held, 0 to 2."""
    springs: list[int]
    """Which of the bodies are springs."""
    rotational: list[int]
    felt: Any
    """Sparse (bodies, N + 1), weights of the joints' positions."""
    turned: Any
    """Sparse (bodies, N), of the links' turns."""
    own: Any
    """Sparse (bodies, n), slips of bodies that slip, over the unknowns."""


def loaded_pencil(chain: Chain) -> FactoredPencil:
    """K = B^T diag(d) B over joint angles, slips and what resists positions and turns, and M."""
    placed = _placed(chain)
    strains = (chain.compliances[_jointed(chain)], np.ones(_n_slips(chain)))
    return FactoredPencil(
        n=n_unknowns(chain),
        rigid=_rigid(chain, placed),
        strain=lambda free: _strain(chain, placed, free),
        stiffness=np.concatenate([1.0 / strains[0], strains[1], placed.stiffness, _held_turns(chain)[1]]),
        strain_matrix=lambda: _strain_matrix(chain, placed),
        mass_matrix=cache(lambda: _mass(chain, placed)),
        masses=lambda free: _weighed(chain, placed, free),
        uneven=True,
        below=chain.lifted,
        bending=chain.first_bending,
    )


def n_unknowns(chain: Chain) -> int:
    """How many positions, turns beyond the ends and slips."""
    return _n_free(chain) + len(_turning(chain)) + _n_slips(chain)


def lossy_stiffness(chain: Chain, stiffness: Array, loss_factor: float, dashpots: float) -> ComplexArray:
    """D of `loaded_pencil` with the beam's loss factor and dashpots beside the joints, (m,).

    What springs, ground and axial force give has no loss, be it part of a joint.
    """
    found = stiffness.astype(complex)
    there = _jointed(chain)
    series = np.zeros(chain.n_segments + 1)
    series[[0, -1]] = chain.end_compliances
    own = 1.0 / chain.own_compliances[there]
    beam = own if chain.eased is None else own / chain.eased[there]
    lossy = own + 1j * (loss_factor * beam + dashpots)
    n, slipping = len(own), _n_slips(chain)
    found[:n] = 1.0 / (1.0 / lossy + series[there])
    found[n : n + slipping] *= 1.0 + 1j * loss_factor
    return np.asarray(found)


def _n_free(chain: Chain) -> int:
    return chain.n_segments + 1 - sum(chain.held)


def _turning(chain: Chain) -> list[int]:
    """Which ends have a body that turns beyond their joint."""
    return [end for end in (0, 1) if chain.end_inertias[end]]


def _jointed(chain: Chain) -> Any:
    """Which of joints 0..N bend, (N + 1,)."""
    left, right = chain.jointed
    return np.concatenate([[left], np.ones(chain.n_segments - 1, dtype=bool), [right]])


def _slipping(chain: Chain) -> Any:
    """Which of joints 0..N slip, (N + 1,)."""
    return np.zeros(chain.n_segments + 1, dtype=bool) if chain.slips is None else np.isfinite(chain.slips)


def _n_slips(chain: Chain) -> int:
    """How many joints and bodies slip."""
    return int(_slipping(chain).sum()) + sum(body.give > 0.0 for body in chain.bodies)


def _held_turns(chain: Chain) -> tuple[list[int], Array]:
    """Ends whose turning body a spring holds, and the springs."""
    ends = [end for end in _turning(chain) if chain.end_springs[end]]
    return ends, np.array([chain.end_springs[end] for end in ends])


def positions(chain: Chain, free: Any) -> Any:
    """Joint positions, (N + 1, k): zeros at held ends."""
    found = np.zeros((chain.n_segments + 1, free.shape[1]), dtype=free.dtype)
    left, right = chain.held
    found[int(left) : chain.n_segments + 1 - right] = free[: _n_free(chain)]
    return found


def end_turns(chain: Chain, free: Any) -> Any:
    """What turns beyond the end joints, (2, k): zeros where nothing does."""
    found = np.zeros((2, free.shape[1]), dtype=free.dtype)
    for row, end in enumerate(_turning(chain)):
        found[end] = free[_n_free(chain) + row]
    return found


def slips(chain: Chain, free: Any) -> Any:
    """How far the link after each joint stands above the link before, (N + 1, k)."""
    found = np.zeros((chain.n_segments + 1, free.shape[1]), dtype=free.dtype)
    if chain.slips is not None:
        there = _slipping(chain)
        first = _n_free(chain) + len(_turning(chain))
        found[there] = np.sqrt(chain.slips[there])[:, None] * free[first : first + there.sum()]
    return found


def _shares(chain: Chain) -> Array:
    """How much of a joint's slip lies on either side of its position, (N + 1,): all of it at an end."""
    shares = np.full(chain.n_segments + 1, 0.5)
    shares[[0, -1]] = 1.0
    return shares


def turns(chain: Chain, free: Any) -> Any:
    """Turns of the links, (N, k)."""
    found = np.diff(positions(chain, free), axis=0)
    if chain.slips is not None:
        parts = _shares(chain)[:, None] * slips(chain, free)
        found = found - (parts[1:] + parts[:-1])
    return found / chain.lengths[:, None]


def middles(chain: Chain, free: Any) -> Any:
    """Positions of the links' middles, (N, k)."""
    joints = positions(chain, free)
    found = 0.5 * (joints[1:] + joints[:-1])
    if chain.slips is not None:
        parts = _shares(chain)[:, None] * slips(chain, free)
        found = found + 0.5 * (parts[:-1] - parts[1:])
    return found


def angles(chain: Chain, free: Any) -> Any:
    """Relative angles at joints 0..N, (N + 1, k); of the end link itself where nothing turns beyond its joint."""
    left, right = end_turns(chain, free)[:, None]
    return np.diff(np.concatenate([left, turns(chain, free), right]), axis=0)


def spans(chain: Chain) -> Array:
    """Length that each joint stands for, (N + 1,), the whole link's at an end."""
    return np.concatenate([chain.lengths[:1], 0.5 * (chain.lengths[1:] + chain.lengths[:-1]), chain.lengths[-1:]])


def bending(chain: Chain, free: Array) -> Array:
    """Change of the section's turn along the beam at joints 0..N, M/EI of the link that follows, (k, N + 1), 1/unit."""
    bent = angles(chain, free) / (chain.compliances * stiffness_at_joints(chain))[:, None]
    return np.asarray(bent.T if chain.eased is None else bent.T / chain.eased)


def shear_change(chain: Chain, deflections: Array, values: Array) -> Array:
    """Change of the shear angle of modes (k, N + 1) of eigenvalues (k,) at joints 0..N, (k, N + 1), 1/unit.

    By balance of transverse forces, kappa G A gamma' = (k_f - rho A omega^2) w: shear itself jumps at bodies and steps,
    where differences of it tell nothing.
    """
    assert chain.shears is not None
    force = chain.foundation - values[:, None] * right_of(chain.masses / chain.lengths)
    return np.asarray(force * deflections / right_of(chain.shears))


def _shear_change(chain: Chain, free: Array) -> Array:
    """Change of the shear angle along the beam at joints 0..N, (N + 1, k), 1/unit."""
    return np.asarray(np.gradient(_shear(chain, free), chain.nodes / chain.unit, axis=0, edge_order=2))


def _shear(chain: Chain, free: Array) -> Array:
    """The beam's shear angle at joints 0..N, (N + 1, k): force over stiffness, whatever a wall makes of its joint."""
    found = slips(chain, free)
    assert chain.slips is not None
    there = _slipping(chain)
    assert chain.softness is not None
    found[there] *= (chain.softness[there] / chain.slips[there])[:, None]
    return np.asarray(found / spans(chain)[:, None])


def corrections(chain: Chain, free: Array) -> Array:
    """What a joint that slips lacks of the beam's deflection, l^2/12 (psi' - gamma'), (k, N + 1)."""
    squares = np.zeros(chain.n_segments + 1)
    squares[:-1] += chain.lengths**2
    squares[1:] += chain.lengths**2
    squares[[0, -1]] *= 2.0
    squares[[0, -1]] *= [not held for held in chain.held]
    bent = angles(chain, free) / spans(chain)[:, None]
    bent[[0, -1]] *= [[2.0 * (support == "guided")] for support in chain.supports]
    return np.asarray((squares[:, None] / 24.0 * (bent - _shear_change(chain, free))).T)


def _own_slips(chain: Chain) -> Any:
    """Slips of bodies that slip as a sparse array over the unknowns, (bodies, n)."""
    from scipy.sparse import csr_array

    giving = [row for row, body in enumerate(chain.bodies) if body.give > 0.0]
    total = n_unknowns(chain)
    roots = np.sqrt([chain.bodies[row].give for row in giving])
    return csr_array((roots, (giving, range(total - len(giving), total))), (len(chain.bodies), total))


def _placed(chain: Chain) -> _Placed:
    """What resists middles, turns and places, and where bodies are felt."""
    from scipy.sparse import csr_array

    ground = chain.foundation * chain.lengths
    of_middles = [ground] * bool(chain.foundation)
    of_turns = [chain.tension * chain.lengths, ground * chain.lengths**2 / 12.0]
    of_turns = [row for row in of_turns if row.any()]
    springs = [row for row, body in enumerate(chain.bodies) if body.stiffness]
    rotational = [row for row, body in enumerate(chain.bodies) if body.rotational]
    each = [chain.bodies[row].stiffness for row in springs] + [chain.bodies[row].rotational for row in rotational]
    felt, turned = felt_together(chain, [body.position for body in chain.bodies], chain.attachment)
    return _Placed(
        stiffness=np.concatenate([*of_middles, *of_turns, each]),
        n_grounded=len(of_middles),
        n_tilted=len(of_turns),
        springs=springs,
        rotational=rotational,
        felt=csr_array(felt),
        turned=csr_array(turned),
        own=_own_slips(chain),
    )


def _resisted(placed: _Placed, joints: Any, centres: Any, tilts: Any, slipped: Any) -> list[Any]:
    """Rows of what `stiffness` resists, of joints' positions, middles, turns, bodies' slips, sparse or not."""
    rows = [centres] * placed.n_grounded + [tilts] * placed.n_tilted
    if placed.springs:
        rows.append(placed.felt[placed.springs] @ joints + slipped[placed.springs])
    if placed.rotational:
        rows.append(placed.turned[placed.rotational] @ tilts)
    return rows


def _strain(chain: Chain, placed: _Placed, free: Array) -> Array:
    """Everything that costs energy, (m, k)."""
    slipped = free[_n_free(chain) + len(_turning(chain)) :]
    held = end_turns(chain, free)[_held_turns(chain)[0]]
    motions = positions(chain, free), middles(chain, free), turns(chain, free), placed.own @ free
    return np.concatenate([angles(chain, free)[_jointed(chain)], slipped, *_resisted(placed, *motions), held])


def _maps(chain: Chain) -> tuple[Any, Any, Any, Any]:
    """`positions`, `middles`, `turns` and `end_turns` over the unknowns, sparse arrays where those are many."""
    from scipy.sparse import csr_array, diags_array

    n, total, free = chain.n_segments, n_unknowns(chain), _n_free(chain)
    if total <= DENSE_UNKNOWNS:  # sparse ones take ten times as long to make
        each = np.eye(total)
        return positions(chain, each), middles(chain, each), turns(chain, each), end_turns(chain, each)
    joints = diags_array(np.ones(free), offsets=-int(chain.held[0]), shape=(n + 1, free)).tocsr()
    joints.resize((n + 1, total))
    ends = csr_array(
        (np.ones(len(_turning(chain))), (_turning(chain), range(free, free + len(_turning(chain))))), (2, total)
    )
    there, first = np.flatnonzero(_slipping(chain)), free + len(_turning(chain))
    roots = np.sqrt(chain.slips[there]) if chain.slips is not None else np.zeros(0)
    parts = csr_array((_shares(chain)[there] * roots, (there, range(first, first + len(there)))), (n + 1, total))
    before, after = slice(0, n), slice(1, n + 1)
    centres = 0.5 * (joints[after] + joints[before]) + 0.5 * (parts[before] - parts[after])
    tilts = diags_array(1.0 / chain.lengths) @ (joints[after] - joints[before] - parts[after] - parts[before])
    return joints, centres, tilts.tocsr(), ends


def _bends(tilts: Any, ends: Any) -> Any:
    """`angles` of such maps, (N + 1, n)."""
    from scipy.sparse import vstack

    if isinstance(tilts, np.ndarray):
        return np.diff(np.concatenate([ends[:1], tilts, ends[1:]]), axis=0)
    around = vstack([ends[[0]], tilts, ends[[1]]]).tocsr()
    return around[1:] - around[:-1]


def _over_slips(chain: Chain, masses: Array) -> Array:
    """Masses of the joints' slips over the unknowns, (n,)."""
    found, there = np.zeros(n_unknowns(chain)), _slipping(chain)
    first = _n_free(chain) + len(_turning(chain))
    if chain.slips is not None:
        found[first : first + there.sum()] = masses[there] * chain.slips[there]
    return found


def _strain_matrix(chain: Chain, placed: _Placed) -> Any:
    """B of `_strain` as a sparse array (m, n)."""
    from scipy.sparse import csc_array, diags_array, vstack

    total, slipping = n_unknowns(chain), _n_slips(chain)
    if total <= DENSE_UNKNOWNS:
        return csc_array(_strain(chain, placed, np.eye(total)))
    joints, centres, tilts, ends = _maps(chain)
    bent = _bends(tilts, ends)[np.flatnonzero(_jointed(chain))]
    slipped = diags_array(np.ones(slipping), offsets=total - slipping, shape=(slipping, total))
    resisted = _resisted(placed, joints, centres, tilts, placed.own)
    return vstack([bent, slipped, *resisted, ends[_held_turns(chain)[0]]]).tocsc()


def _mass(chain: Chain, placed: _Placed) -> Any:
    """M, dense where unknowns are few."""
    from scipy.sparse import diags_array

    joints, centres, tilts, ends = _maps(chain)
    mass = _squares(centres, chain.masses) + _squares(tilts, chain.inertias)
    if any(chain.end_inertias):
        mass = mass + _squares(ends, np.array(chain.end_inertias))
    if chain.joint_inertias is not None:
        mass = mass - _squares(_bends(tilts, ends), chain.joint_inertias)
    if chain.slip_masses is not None:
        mass = mass - diags_array(_over_slips(chain, chain.slip_masses))
    masses, rotary = _of_bodies(chain)
    if masses.any():
        mass = mass + _squares(placed.felt @ joints + placed.own, masses)
    if rotary.any():
        mass = mass + _squares(placed.turned @ tilts, rotary)
    return np.asarray(mass) if n_unknowns(chain) <= DENSE_UNKNOWNS else mass.tocsc()


def _squares(rows: Any, weights: Array) -> Any:
    """The matrix of weights (r,) times the squares of rows (r, n), sparse or not."""
    return rows.T @ (rows * weights[:, None])


def _of_bodies(chain: Chain) -> tuple[Array, Array]:
    """Masses and rotary inertias of the bodies, (bodies,) both."""
    masses, rotary = ([getattr(body, figure) for body in chain.bodies] for figure in ("mass", "rotary_inertia"))
    return np.array(masses), np.array(rotary)


def _weighed(chain: Chain, placed: _Placed, free: Array) -> Array:
    """V (n, k) -> v^T M v by the turns themselves: M over positions drowns a large rotary inertia's (`_mass`)."""
    tilts, (masses, rotary) = turns(chain, free), _of_bodies(chain)
    total = chain.masses @ middles(chain, free) ** 2 + chain.inertias @ tilts**2
    total = total + np.array(chain.end_inertias) @ end_turns(chain, free) ** 2
    if chain.joint_inertias is not None:
        total = total - chain.joint_inertias @ angles(chain, free) ** 2
    if chain.slip_masses is not None:
        total = total - chain.slip_masses @ slips(chain, free) ** 2
    felt = placed.felt @ positions(chain, free) + placed.own @ free
    return np.asarray(total + masses @ felt**2 + rotary @ (placed.turned @ tilts) ** 2)


def _rigid(chain: Chain, placed: _Placed) -> Array:
    """The motions that nothing resists, over the unknowns, (n, 0 to 2)."""
    x = chain.nodes / chain.unit
    left, right = chain.held
    found = np.zeros((n_unknowns(chain), len(chain.lines)))
    for column, (start, tilt) in enumerate(chain.lines):
        line = start / chain.unit + tilt * x
        # about the beam's one spring, if there is one, which unequal links feel a little beside its place
        line = line - (placed.felt @ line)[placed.springs][:1].sum()
        found[: _n_free(chain), column] = line[int(left) : len(x) - right]
        found[_n_free(chain) : _n_free(chain) + len(_turning(chain)), column] = tilt
    return found
