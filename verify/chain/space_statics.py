"""Large static bending and torsion of a cantilever in space: rigid pieces of a rod, straight or curved at rest.

A piece has the rotation R_i from its place at rest, so that a rod of any shape at rest is unloaded at R_i = 1. A joint
takes the rotation vector phi of R_{i-1}^T R_i and has the energy phi K phi / 2, K with GJ and both EI about the rod's
axes there at rest. With the spins w of the pieces (R_i becomes exp(w) R_i) the rotation between neighbours changes by
R_i^T (w_i - w_{i-1} - w_{i-1} x w_i / 2), and the joint's moment is R_i J^-1(phi) K phi,

    J^-1(phi) = 1 - phi^/2 + c phi^ phi^,     c = (1 - (t/2) cot(t/2)) / t^2,     t = |phi| ,

phi^ the matrix of phi x. The derivative of the moments by the spins, of 3 x 3 blocks in three diagonals, is exact:
Newton's method converges quadratically, in O(N) operations.
"""

from collections.abc import Callable
from math import pi
from typing import NamedTuple

import numpy as np
from msgspec import Struct, structs

from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.chain.statics import CORRECTION, LARGEST_STEP, LAST_STEP, RESIDUAL
from verify.chain.system import build_system
from verify.errors import InputError, shown
from verify.exact.torsion import shafts
from verify.formatting import one_line
from verify.linear.positions import Numbers, as_vector, real_array
from verify.problem.beam import Beam, in_plane
from verify.problem.cross_section import Section
from verify.settings import DEFAULT, Wall
from verify.validation import check_integer, check_type

SMALL = 0.1  # rad, below which c is its series: the first term left out is 2e-16 of c phi^2
LEAST = 1e-6  # step over the share of the load that is reached at which the path of equilibria is given up
ATTEMPTS = 1000  # load steps; a rod that a moment winds up ten times takes a hundred
ROUNDING = 1e-14  # rad, of a joint's angle
STEPS = 4  # of a piece in the integration of the shape at rest, an even number (Simpson)
BAND = 5
Curvature = Callable[[Array], Array]


class ChainAtRest(NamedTuple):
    """A chain of rigid pieces at rest, clamped at the origin, in the axes of the clamp."""

    joints: Array  # (N + 1, 3), m, from the clamp to the tip
    middles: Array  # (N, 3), m: centres of mass
    axes: Array  # (N + 1, 3, 3): tangent, across the width, across the thickness in columns
    springs: Array  # (N, 3), N m/rad, about these axes, GJ first
    masses: Array  # (N,), kg
    last: Array  # (3,), rad/(N m): compliances of the last half piece


class BentInSpace(Struct, frozen=True, eq=False, kw_only=True):
    """Equilibrium of a cantilever in space, in the axes of its clamp: x along, y across the width, z the thickness."""

    beam: Beam
    count: int
    """Pieces N."""
    joints: Array
    """(N + 1, 3), m: the joints from the clamp to the tip."""
    rotations: Array
    """(N, 3, 3): of each piece from its place at rest."""
    moments: Array
    """(N + 1, 3), N m: of the joints on the pieces before them, about x, y, z; the applied moment at the tip."""
    displacement: Array
    """(3,), m: of the tip from its place at rest."""
    energy: float
    """Elastic energy, J: of the joints, and of the last half piece under the applied moment."""
    rod: ChainAtRest
    """At rest."""
    loads: Array
    """(3, 3): force, N, moment, N m, gravity, m/s^2."""
    __repr__ = one_line(count="", displacement="m", energy="J")

    @property
    def tip(self) -> Array:
        """(3,), m: the free end."""
        return np.asarray(self.joints[-1])

    def frequencies_hz(self, n_modes: int = 5) -> Array:
        """First natural frequencies about the equilibrium, (n_modes,), Hz; sections have no rotary inertia.

        Order 4 at rest, whatever the shape there (docs/theory.md, "Curved rods"), and 2 under load. Raises InputError
        under a moment, and for more modes than pieces.
        """
        from scipy.linalg import eigh

        n, rod, every = self.count, self.rod, np.arange(self.count)
        check_integer("n_modes", n_modes, 1, n)
        if self.loads[1].any():
            raise InputError("moment: one of constant direction has no symmetric stiffness in space, leave it out")
        _, hessian, coupling, _ = _equations(rod, self.rotations, self.loads)
        stiffness, chords = np.zeros((n, 3, n, 3)), np.diff(self.joints, axis=0)
        stiffness[every, :, every] = hessian
        stiffness[every[:-1], :, every[1:]], stiffness[every[1:], :, every[:-1]] = coupling, coupling.swapaxes(1, 2)
        arms = np.tri(n, k=-1)[:, :, None] * chords
        arms[every, every] = (self.rotations @ (rod.middles - rod.joints[:-1])[..., None])[..., 0]
        moved = (hat(arms) * np.sqrt(rod.masses)[:, None, None, None]).transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)
        mass = (moved.T @ moved).reshape(n, 3, n, 3)
        mass[every, :, every] -= rod.masses[:, None, None] / 12.0 * hat(chords) @ hat(chords)
        pair = (mass.reshape(3 * n, -1), stiffness.reshape(3 * n, -1))
        found = eigh(*pair, eigvals_only=True, subset_by_index=[3 * n - n_modes, 3 * n - 1])
        return np.asarray(0.5 / (pi * np.sqrt(found[::-1])))


@one_blas_thread()
def bend_in_space(
    beam: Beam,
    count: int,
    force: Numbers = (0.0, 0.0, 0.0),
    *,
    moment: Numbers = (0.0, 0.0, 0.0),
    gravity: Numbers = (0.0, 0.0, 0.0),
    curvature: Curvature | None = None,
    stiffness: Numbers | None = None,
    wall: Wall = DEFAULT.wall,
) -> BentInSpace:
    """Large bending and torsion of a cantilever of `count` rigid pieces under dead loads in space.

    `force` (N) and `moment` (N m) act on the tip, `gravity` (m/s^2) on all pieces; each has components along x (the
    tangent at the clamp), y (across the width) and z (across the thickness) and a constant direction. `curvature` at
    rest: a function of arc lengths (n,), m, that returns (n, 3), 1/m: twist, and curvature about the rod's own y and z.
    `stiffness`: GJ and EI about y and z of a uniform rod, N m^2, in place of those of the section with Saint-Venant's
    torsion. Inextensible, without shear; order 2 in `count`. Along y or z alone a straight rod bends as by `bend`.

    The load grows from zero along the path of equilibria, which without a moment are stable. Raises InputError for
    supports other than clamped and free, bodies on the beam, and where that path ends.
    """
    check_type("beam", beam, Beam)
    if beam.supports != ("clamped", "free"):
        raise InputError(f"beam.supports = {beam.supports!r}: bend_in_space takes a cantilever, ('clamped', 'free')")
    check_integer("count", count, 2)
    loads = np.array([_vector(*one) for one in (("force", force), ("moment", moment), ("gravity", gravity))])
    rod = _rod(structs.replace(beam, loss_factor=0.0), count, curvature, stiffness, wall)
    rotations, share, part = np.tile(np.eye(3), (count, 1, 1)), 0.0, 1.0
    for _ in range(ATTEMPTS):
        goal = min(share + part, 1.0)
        found = _newton(rod, rotations, goal * loads)
        rotations, share, part = (rotations, share, 0.25 * part) if found is None else (found, goal, 2.0 * part)
        if share == 1.0 or part < LEAST * max(share, LEAST):
            break
    if share < 1.0:
        kind = "stable equilibria" if not loads[1].any() else "equilibria"
        raise InputError(
            f"force = {shown(force)} N: the path of {kind} ends at {share:.4g} of the load, reduce it or add a small "
            "force across the rod, or out of its plane"
        )
    state = _joints(rod, rotations)
    chords = (rotations @ np.diff(rod.joints, axis=0)[..., None])[..., 0]
    joints = np.vstack([np.zeros(3), np.cumsum(chords, axis=0)])
    own = rod.axes[-1].T @ rotations[-1].T @ loads[1]
    return BentInSpace(
        beam=beam,
        count=count,
        joints=joints,
        rotations=rotations,
        moments=np.vstack([state.moments, loads[1]]),
        displacement=joints[-1] - rod.joints[-1],
        rod=rod,
        loads=loads,
        energy=0.5 * float((rod.springs * state.angles**2).sum() + rod.last @ own**2),
    )


def _vector(name: str, value: Numbers) -> Array:
    """Three components. Raises InputError."""
    vector = as_vector(name, value)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f"{name} = {shown(value)}: give three finite numbers, along x, y and z")
    return vector


# --- The rod at rest -----------------------------------------------------------------------------------------------


def _rod(beam: Beam, count: int, curvature: Curvature | None, stiffness: Numbers | None, wall: Wall) -> ChainAtRest:
    """The chain at rest. Raises InputError."""
    if stiffness is None:
        planes = [_bar(beam, *shafts(beam)[:, :2].tolist()), beam, in_plane(beam, "width")]
    else:
        given = as_vector("stiffness", stiffness)
        if beam.section or given.shape != (3,) or not ((given > 0.0) & np.isfinite(given)).all():
            raise InputError(f"stiffness = {shown(stiffness)}: give GJ and two EI above zero, N m^2, of a uniform beam")
        planes = [_bar(beam, (beam.length, one)) for one in given.tolist()]
    system, *others = (build_system(plane, count, wall=wall) for plane in planes)
    masses = build_system(beam, count, wall=wall).masses
    bars = np.array([plane.pieces[-1].bending_stiffness for plane in planes])
    joints, middles, axes = _at_rest(system.nodes, curvature or (lambda s: np.zeros((len(s), 3))))
    springs = np.stack([one.stiffness for one in (system, *others)], axis=1)
    return ChainAtRest(joints, middles, axes, springs, masses, 0.5 * system.lengths[-1] / bars)


def _bar(beam: Beam, *pieces: tuple[float, float]) -> Beam:
    """A beam whose bending stiffness is that of torsion or of another plane, of (length, stiffness) of its pieces."""
    parts = [Section(length=length, bending_stiffness=one, mass_per_length=1.0) for length, one in pieces]
    return Beam(
        length=beam.length,
        supports=beam.supports,
        bending_stiffness=pieces[0][1],
        mass_per_length=1.0,
        section=parts if len(parts) > 1 else (),
    )


def _at_rest(nodes: Array, curvature: Curvature) -> tuple[Array, Array, Array]:
    """Joints, centres of mass and axes of the shape at rest, by Magnus's method and Simpson's rule, both of order 4."""
    from scipy.spatial.transform import Rotation

    n, steps = len(nodes) - 1, np.diff(nodes) / STEPS
    starts = (nodes[:-1, None] + steps[:, None] * np.arange(STEPS)).ravel()
    h = np.repeat(steps, STEPS)[:, None]
    gauss = (starts + (0.5 + side * 3**-0.5) * h[:, 0] for side in (-0.5, 0.5))
    first, second = (real_array("curvature", curvature(s) if callable(curvature) else curvature, "1/m") for s in gauss)
    if any(one.shape != (n * STEPS, 3) or not np.isfinite(one).all() for one in (first, second)):
        raise InputError("curvature: give a function of arc lengths (n,), m, that returns finite numbers (n, 3), 1/m")
    turns = 0.5 * h * (first + second) + 3**0.5 / 12.0 * h**2 * np.cross(first, second)
    frames = [np.eye(3)]
    for turn in Rotation.from_rotvec(turns).as_matrix():
        frames.append(frames[-1] @ turn)
    axes, at = np.array(frames), np.arange(STEPS + 1)
    tangents = axes[STEPS * np.arange(n)[:, None] + at, :, 0]
    weights = np.where(at % 2, 4.0, 2.0)
    weights[[0, -1]] = 1.0
    chords, means = (
        np.einsum("q,iqc,i->ic", weights * share / 3.0, tangents, steps) for share in (1.0, 1.0 - at / STEPS)
    )
    joints = np.vstack([np.zeros(3), np.cumsum(chords, axis=0)])
    return joints, joints[:-1] + means, axes[::STEPS]


# --- Equilibrium ---------------------------------------------------------------------------------------------------


class Joints(NamedTuple):
    """Joints of turned pieces: angles in their own axes, moments and stiffness by spins, in the clamp's axes."""

    angles: Array  # (N, 3)
    moments: Array  # (N, 3)
    stiffness: Array  # (N, 3, 3), symmetric


def _joints(rod: ChainAtRest, rotations: Array) -> Joints:
    """Moments R J^-1(phi) K phi of the joints and the symmetric part of their derivatives by R^T w."""
    from scipy.spatial.transform import Rotation

    before = np.concatenate([np.eye(3)[None], rotations[:-1]]) @ rod.axes[:-1]
    after = rotations @ rod.axes[:-1]
    phi = np.asarray(Rotation.from_matrix(np.swapaxes(before, 1, 2) @ after).as_rotvec())
    k, m, t2 = rod.springs, rod.springs * phi, (phi * phi).sum(axis=1)
    c, slope = _coefficients(t2)
    around, twice = hat(phi), np.cross(phi, np.cross(phi, m))
    moments = m - 0.5 * np.cross(phi, m) + c[:, None] * twice
    unit = np.eye(3)
    by_phi = k[:, None] * unit + 0.5 * (hat(m) - around * k[:, None])
    turn = phi[:, :, None] * m[:, None]
    by_phi += c[:, None, None] * ((phi * m).sum(axis=1)[:, None, None] * unit + 2.0 * (turn - np.swapaxes(turn, 1, 2)))
    by_phi += (slope[:, None] * twice)[:, :, None] * phi[:, None] - (c * t2)[:, None, None] * k[:, None] * unit
    by_spin = by_phi @ (unit + 0.5 * around + c[:, None, None] * around @ around)
    stiffness = after @ (0.5 * (by_spin + np.swapaxes(by_spin, 1, 2))) @ np.swapaxes(after, 1, 2)
    return Joints(phi, (after @ moments[..., None])[..., 0], stiffness)


def _coefficients(t2: Array) -> tuple[Array, Array]:
    """The factor c of J^-1, and its derivative by the angle over the angle."""
    h = 0.5 * np.sqrt(np.maximum(t2, SMALL**2))
    rest, sine = 1.0 - h / np.tan(h), np.sin(h)
    slope = ((h / sine**2 - 1.0 / np.tan(h)) / (4.0 * h**2) - rest / (2.0 * h**3)) / (4.0 * h)
    series = 1 / 12 + t2 * (1 / 720 + t2 * (1 / 30240 + t2 / 1209600))
    small = t2 < SMALL**2
    return np.where(small, series, rest / (4.0 * h**2)), np.where(small, 1 / 360 + t2 * (1 / 7560 + t2 / 201600), slope)


def _newton(rod: ChainAtRest, start: Array, loads: Array) -> Array | None:
    """Rotations in equilibrium under (force, moment, gravity), (3, 3), near a start on the path; None without."""
    from scipy.linalg import LinAlgError, solve_banded
    from scipy.spatial.transform import Rotation

    rotations, total, first = start, np.zeros((len(start), 3)), np.zeros(0)
    for _ in range(30):
        forces, hessian, coupling, scale = _equations(rod, rotations, loads)
        bands = _bands(hessian - 0.5 * hat(forces), coupling)
        forces[-1] -= loads[1]
        try:
            step = solve_banded((BAND, BAND), bands, -forces.ravel(), check_finite=False).reshape(-1, 3)
        except LinAlgError:
            return None
        largest = float(np.linalg.norm(step, axis=1).max())
        if not largest <= LARGEST_STEP:
            return None
        first, total = (first if len(first) else step), total + step
        if abs(total - first).max() > CORRECTION * abs(first).max() + LAST_STEP:
            return None
        rotations = np.asarray(Rotation.from_rotvec(step).as_matrix() @ rotations)
        if abs(forces).max() <= scale and largest < LAST_STEP:
            return rotations if loads[1].any() or _positive(_bands(hessian, coupling)) else None
    return None


def _positive(bands: Array) -> bool:
    """Whether a symmetric matrix is positive definite."""
    from scipy.linalg import LinAlgError, cholesky_banded

    try:
        cholesky_banded(bands[BAND:], lower=True)
    except LinAlgError:
        return False
    return True


def _equations(rod: ChainAtRest, rotations: Array, loads: Array) -> tuple[Array, Array, Array, float]:
    """First and second derivatives of the potential energy by the spins, and the tolerance of the first.

    (N, 3), N m; blocks (N, 3, 3) of a piece and (N - 1, 3, 3) of one with the next.
    """
    joints = _joints(rod, rotations)
    forces = joints.moments.copy()
    forces[:-1] -= joints.moments[1:]
    hessian = joints.stiffness.copy()
    hessian[:-1] += joints.stiffness[1:]
    coupling = 0.5 * hat(joints.moments[1:]) - joints.stiffness[1:]
    weights = rod.masses[:, None] * loads[2]
    beyond = loads[0] + np.cumsum(weights[::-1], axis=0)[::-1] - weights
    size = abs(joints.moments).max() + abs(loads[1]).max()
    for arms, pulls in ((np.diff(rod.joints, axis=0), beyond), (rod.middles - rod.joints[:-1], weights)):
        turned = (rotations @ arms[..., None])[..., 0]
        both = pulls[:, :, None] * turned[:, None]
        forces -= np.cross(turned, pulls)
        hessian += np.trace(both, axis1=1, axis2=2)[:, None, None] * np.eye(3) - 0.5 * (both + np.swapaxes(both, 1, 2))
        size += abs(np.cross(turned, pulls)).max()
    return forces, hessian, coupling, RESIDUAL * size + ROUNDING * float(rod.springs.max())


def _bands(diagonal: Array, upper: Array) -> Array:
    """A matrix of 3 x 3 blocks with the transposes of `upper` below its diagonal as bands, (11, 3 N)."""
    n = len(diagonal)
    bands = np.zeros((2 * BAND + 1, n, 3))
    for row in range(3):
        for column in range(3):
            bands[BAND + row - column, :, column] = diagonal[:, row, column]
            bands[BAND + row - column - 3, 1:, column] = upper[:, row, column]
            bands[BAND + row - column + 3, :-1, column] = upper[:, column, row]
    return bands.reshape(2 * BAND + 1, 3 * n)


def hat(vectors: Array) -> Array:
    """Matrices (..., 3, 3) of the products vector x, of (..., 3)."""
    return np.asarray(np.cross(vectors[..., None, :], np.eye(3)).swapaxes(-1, -2))
