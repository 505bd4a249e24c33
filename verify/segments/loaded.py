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

from typing import Any

import numpy as np

from verify.models.arrays import Array, ComplexArray
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil, on_diagonals
from verify.segments.attached import rows_at
from verify.segments.links import Body, Chain


def loaded_pencil(chain: Chain) -> FactoredPencil:
    """K = B^T diag(d) B over joint angles, slips and what resists positions and turns, and M."""
    placed = _placed_rows(chain)
    strains = (chain.compliances[_jointed(chain)], np.ones(_n_slips(chain)))
    return FactoredPencil(
        n=n_unknowns(chain),
        rigid=_rigid(chain),
        strain=lambda free: _strain(chain, placed, free),
        stiffness=np.concatenate([1.0 / strains[0], strains[1], placed[0], _held_turns(chain)[1]]),
        strain_matrix=lambda: _strain_matrix(chain, placed),
        mass_matrix=_mass(chain),
        masses=_weigher(chain),
        uneven=True,
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
    own = 1.0 / (chain.compliances - series)[there]
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


def link_turns(chain: Chain) -> Any:
    """`turns` as a sparse array over the unknowns, (N, n)."""
    return _maps(chain)[2]


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


def _spans(chain: Chain) -> Array:
    """Length that each joint stands for, (N + 1,), the whole link's at an end."""
    return np.concatenate([chain.lengths[:1], 0.5 * (chain.lengths[1:] + chain.lengths[:-1]), chain.lengths[-1:]])


def curvatures(chain: Chain, free: Array) -> Array:
    """Curvature of the beam at joints 0..N, (k, N + 1), 1/m: w'', of bending and of changing shear."""
    bent = angles(chain, free) / chain.compliances[:, None]
    if chain.eased is not None:
        bent = bent / chain.eased[:, None]
    if chain.slips is not None:
        bent = bent + _shear_change(chain, free)
    return np.asarray(bent.T / chain.unit**2)


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
    return np.asarray(found / _spans(chain)[:, None])


def corrections(chain: Chain, free: Array) -> Array:
    """What a joint that slips lacks of the beam's deflection, l^2/12 (psi' - gamma'), (k, N + 1)."""
    squares = np.zeros(chain.n_segments + 1)
    squares[:-1] += chain.lengths**2
    squares[1:] += chain.lengths**2
    squares[[0, -1]] *= 2.0
    squares[[0, -1]] *= [not held for held in chain.held]
    bent = angles(chain, free) / _spans(chain)[:, None]
    bent[[0, -1]] *= [[2.0 * (support == "guided")] for support in chain.supports]
    return np.asarray((squares[:, None] / 24.0 * (bent - _shear_change(chain, free))).T)


def _own_slips(chain: Chain, bodies: list[Body]) -> Any:
    """Slips of bodies that slip as a sparse array over the unknowns, (b, n)."""
    from scipy.sparse import csr_array

    giving = [body for body in chain.bodies if body.give > 0.0]
    first = n_unknowns(chain) - len(giving)
    found = [(row, first + giving.index(b), np.sqrt(b.give)) for row, b in enumerate(bodies) if b.give > 0.0]
    rows, columns, values = zip(*found, strict=True) if found else ((), (), ())
    return csr_array((values, (rows, columns)), (len(bodies), n_unknowns(chain)), dtype=float)


def _placed_rows(chain: Chain) -> tuple[Array, Any, Any, Any, Any]:
    """What resists middles, turns and places: stiffnesses, and sparse rows over joints, middles, turns, unknowns."""
    from scipy.sparse import csr_array, vstack

    n = chain.n_segments
    ground = chain.foundation * chain.lengths
    of_turns = [chain.tension * chain.lengths, ground * chain.lengths**2 / 12.0]
    of_turns = [row for row in of_turns if row.any()]
    grounded = ground[: n * bool(chain.foundation)]
    springs = [body for body in chain.bodies if body.stiffness]
    rotational = [body for body in chain.bodies if body.rotational]
    felt = rows_at(chain, [b.position for b in springs], chain.attachment)[0]
    turned = rows_at(chain, [b.position for b in rotational], chain.attachment)[1]
    sizes = (len(grounded), n * len(of_turns), len(springs), len(rotational))
    links = on_diagonals({0: np.ones(n)}).tocsr()
    over_middles = [links[: sizes[0]], *(csr_array((size, n)) for size in sizes[1:])]
    over_turns = [csr_array((sizes[0], n)), *([links] * len(of_turns)), csr_array((sizes[2], n)), csr_array(turned)]
    apart = sizes[0] + sizes[1]
    over_joints = [csr_array((apart, n + 1)), csr_array(felt), csr_array((sizes[3], n + 1))]
    stiffness = [grounded, *of_turns, [b.stiffness for b in springs], [b.rotational for b in rotational]]
    total = n_unknowns(chain)
    slipping = [csr_array((apart, total)), _own_slips(chain, springs), csr_array((sizes[3], total))]
    rows = [vstack(parts).tocsr() for parts in (over_joints, over_middles, over_turns, slipping)]
    return np.concatenate([np.asarray(part, dtype=float) for part in stiffness]), rows[0], rows[1], rows[2], rows[3]


def _strain(chain: Chain, placed: tuple[Array, Any, Any, Any, Any], free: Array) -> Array:
    """Everything that costs energy, (m, k)."""
    _, over_joints, over_middles, over_turns, over_slips = placed
    resisted = over_joints @ positions(chain, free) + over_middles @ middles(chain, free)
    resisted = resisted + over_turns @ turns(chain, free) + over_slips @ free
    slipped = free[_n_free(chain) + len(_turning(chain)) :]
    held = end_turns(chain, free)[_held_turns(chain)[0]]
    return np.concatenate([angles(chain, free)[_jointed(chain)], slipped, resisted, held])


def _maps(chain: Chain) -> tuple[Any, Any, Any, Any]:
    """`positions`, `middles`, `turns` and `end_turns` as sparse arrays over the unknowns."""
    from scipy.sparse import csr_array

    n, total, free = chain.n_segments, n_unknowns(chain), _n_free(chain)
    joints = on_diagonals({-int(chain.held[0]): np.ones(free)}, (n + 1, free)).tocsr()
    joints.resize((n + 1, total))
    ends = csr_array(
        (np.ones(len(_turning(chain))), (_turning(chain), range(free, free + len(_turning(chain))))), (2, total)
    )
    there, first = np.flatnonzero(_slipping(chain)), free + len(_turning(chain))
    roots = np.sqrt(chain.slips[there]) if chain.slips is not None else np.zeros(0)
    parts = csr_array((_shares(chain)[there] * roots, (there, range(first, first + len(there)))), (n + 1, total))
    before, after = slice(0, n), slice(1, n + 1)
    centres = 0.5 * (joints[after] + joints[before]) + 0.5 * (parts[before] - parts[after])
    tilts = on_diagonals({0: 1.0 / chain.lengths}) @ (joints[after] - joints[before] - parts[after] - parts[before])
    return joints, centres, tilts.tocsr(), ends


def _over_slips(chain: Chain, masses: Array) -> Array:
    """Masses of the joints' slips over the unknowns, (n,)."""
    found, there = np.zeros(n_unknowns(chain)), _slipping(chain)
    first = _n_free(chain) + len(_turning(chain))
    if chain.slips is not None:
        found[first : first + there.sum()] = masses[there] * chain.slips[there]
    return found


def _strain_matrix(chain: Chain, placed: tuple[Array, Any, Any, Any, Any]) -> Any:
    """B of `_strain` as a sparse array (m, n)."""
    from scipy.sparse import vstack

    joints, centres, tilts, ends = _maps(chain)
    _, over_joints, over_middles, over_turns, over_slips = placed
    around = vstack([ends[[0]], tilts, ends[[1]]]).tocsr()
    bent = (around[1:] - around[:-1])[np.flatnonzero(_jointed(chain))]
    total, slipping = n_unknowns(chain), _n_slips(chain)
    slipped = on_diagonals({total - slipping: np.ones(slipping)}, (slipping, total))
    resisted = over_joints @ joints + over_middles @ centres + over_turns @ tilts + over_slips
    return vstack([bent, slipped, resisted, ends[_held_turns(chain)[0]]]).tocsc()


def _mass(chain: Chain) -> Any:
    """() -> M, made when it is first asked for."""
    from functools import cache

    @cache
    def made() -> Any:
        from scipy.sparse import csr_array, vstack

        joints, centres, tilts, ends = _maps(chain)
        inertias = on_diagonals({0: chain.inertias})
        mass = centres.T @ on_diagonals({0: chain.masses}) @ centres + tilts.T @ inertias @ tilts
        mass = mass + ends.T @ on_diagonals({0: np.array(chain.end_inertias)}) @ ends
        if chain.joint_inertias is not None:
            around = vstack([ends[[0]], tilts, ends[[1]]]).tocsr()
            bent = around[1:] - around[:-1]
            mass = mass - bent.T @ on_diagonals({0: chain.joint_inertias}) @ bent
        if chain.slip_masses is not None:
            mass = mass - on_diagonals({0: _over_slips(chain, chain.slip_masses)})
        for body in chain.bodies:
            if body.mass or body.rotary_inertia:
                felt, turned = (csr_array(row) for row in rows_at(chain, [body.position], chain.attachment))
                felt, turned = felt @ joints + _own_slips(chain, [body]), turned @ tilts
                mass = mass + body.mass * (felt.T @ felt) + body.rotary_inertia * (turned.T @ turned)
        return mass.toarray() if n_unknowns(chain) <= DENSE_UNKNOWNS else mass.tocsc()

    return made


def _weigher(chain: Chain) -> Any:
    """V (n, k) -> v^T M v by the turns themselves: M over positions drowns a large rotary inertia's (`_mass`)."""
    felt, turned = rows_at(chain, [body.position for body in chain.bodies], chain.attachment)
    masses = np.array([body.mass for body in chain.bodies])
    rotary = np.array([body.rotary_inertia for body in chain.bodies])
    own = _own_slips(chain, list(chain.bodies))

    def weigh(free: Array) -> Array:
        tilts = turns(chain, free)
        total = chain.masses @ middles(chain, free) ** 2 + chain.inertias @ tilts**2
        total = total + np.array(chain.end_inertias) @ end_turns(chain, free) ** 2
        if chain.joint_inertias is not None:
            total = total - chain.joint_inertias @ angles(chain, free) ** 2
        if chain.slip_masses is not None:
            total = total - chain.slip_masses @ slips(chain, free) ** 2
        total = total + masses @ (felt @ positions(chain, free) + own @ free) ** 2 + rotary @ (turned @ tilts) ** 2
        return np.asarray(total)

    return weigh


def _rigid(chain: Chain) -> Array:
    """The motions that nothing resists, over the unknowns, (n, 0 to 2)."""
    x = chain.nodes / chain.unit
    left, right = chain.held
    found = np.zeros((n_unknowns(chain), len(chain.lines)))
    for column, (start, tilt) in enumerate(chain.lines):
        found[: _n_free(chain), column] = (start / chain.unit + tilt * x)[int(left) : len(x) - right]
        found[_n_free(chain) : _n_free(chain) + len(_turning(chain)), column] = tilt
    return found
