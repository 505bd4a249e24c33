"""Finite segments: rigid links, revolute joints with torsion springs, linearised about the straight chain.

Unknowns are the transverse positions of the joints, which keep the mass matrix well conditioned. Inside, a
length is measured in mean link lengths L/N, a stiffness and a mass in those of the beam, so that equal links
have length 1 exactly.
"""

from math import pi, sin, sqrt
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.eigen import DENSE_UNKNOWNS, Array, Eigenpairs, FactoredPencil, check_size, lowest, method_name
from verify.errors import InputError
from verify.modes import Modes

FIELD = "n_segments"


class Chain(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A straight chain of N links in units of the mean link length and of the beam's EI and rho A."""

    supports: tuple[str, str]
    lengths: Array
    """(N,), link lengths."""
    compliances: Array
    """(N + 1,), 1/k of each joint; infinite where an end has none (pinned, free)."""
    masses: Array
    """(N,)."""
    inertias: Array
    """(N,), about each link's middle."""

    @property
    def n_segments(self) -> int:
        """N."""
        return len(self.lengths)

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether the left and the right end keep their transverse position."""
        left, right = (support in ("pinned", "clamped") for support in self.supports)
        return left, right

    @property
    def walls(self) -> tuple[bool, bool]:
        """Whether the left and the right end keep their slope, through a joint at the wall."""
        left, right = (support in ("clamped", "guided") for support in self.supports)
        return left, right


def joint_compliance(length_i: Any, stiffness_i: Any, length_j: Any, stiffness_j: Any) -> Any:
    """1/k of the joint between links i and j: two half links in series, l_i/(2 E_i I_i) + l_j/(2 E_j I_j).

    k = 2 E_i I_i E_j I_j / (E_i I_i l_j + E_j I_j l_i), the paper's Eq. (1) with its indices put right: as
    printed, E_i I_j l_j + E_j I_i l_i, it is no series connection unless the links are alike.
    """
    return length_i / (2.0 * stiffness_i) + length_j / (2.0 * stiffness_j)


def link_inertia(mass: Any, length: Any) -> Any:
    """M l^2 / 12: a uniform thin link about its middle."""
    return mass * length**2 / 12.0


def uniform_chain(beam: Beam, n_segments: int) -> Chain:
    """N equal links of a uniform beam."""
    lengths, ones = np.ones(n_segments), np.ones(n_segments)
    compliances = np.full(n_segments + 1, np.inf)
    compliances[1:-1] = joint_compliance(lengths[:-1], ones[:-1], lengths[1:], ones[1:])
    masses = ones * lengths
    return Chain(supports=beam.supports, lengths=lengths, compliances=compliances, masses=masses,
                 inertias=link_inertia(masses, lengths))  # fmt: skip


def unknowns(beam: Beam, n_segments: int) -> int:
    """How many joint positions the supports leave free."""
    return n_segments + 1 - sum(support in ("pinned", "clamped") for support in beam.supports)


def n_elastic(beam: Beam, n_segments: int) -> int:
    """How many elastic modes the chain has: one for each joint spring, at most one for each unknown."""
    return max(n_segments - 1 + sum(support in ("clamped", "guided") for support in beam.supports), 0)


def solve_modes(beam: Beam, n_modes: int, n_segments: int) -> Modes:
    """The first `n_modes` elastic modes of the beam as `n_segments` equal rigid links.

    Joints by Eq. (1) in its series form, links with their own rotary inertia m l^2/12 (the paper, Section
    II.A). Frequencies are those of the chain to rounding. Shapes are read at the joints with the correction
    y + delta^2 y / 12 (order 4; the raw y, order 2, is the reading "raw") and through a cubic spline between.
    Raises InputError for more modes than the chain has or sizes that do not fit into memory.
    """
    check(beam, n_modes, n_segments)
    chain = uniform_chain(beam, n_segments)
    pairs = lowest(chain_pencil(chain), n_modes)
    return _modes(beam, chain, pairs)


def check(beam: Beam, n_modes: int, n_segments: int) -> None:
    """Raise InputError, before anything is allocated, where `solve_modes` would refuse."""
    if n_segments < 2:
        raise InputError(f"{FIELD} = {n_segments!r}: a chain that bends needs at least 2 segments")
    if not set(beam.supports) <= {"pinned"}:
        raise InputError(
            f"beam.supports = {beam.supports!r}: the segment model takes pinned ends so far, use fem or analytic"
        )
    check_size(unknowns(beam, n_segments), n_modes, n_elastic(beam, n_segments), FIELD, n_segments)


def _modes(beam: Beam, chain: Chain, pairs: Eigenpairs) -> Modes:
    n = chain.n_segments
    frequencies = np.sqrt(pairs.values) * (beam.wave_constant / (2.0 * pi)) * (n / beam.length) ** 2
    nodes: Array = np.arange(n + 1.0) * (beam.length / n)
    raw = _with_ends(chain, pairs.vectors).T * _sign(chain, pairs.vectors)[:, None]
    raw /= sqrt(beam.mass_per_length * beam.length / n)

    def corrected() -> Array:
        return corrected_reading(raw)

    def shapes(x: Array, derivative: int) -> Array:
        return _spline(nodes, corrected(), x, derivative)

    return Modes(model="segment", count=n, length=beam.length, frequencies_hz=frequencies, shapes=shapes,
                 nodes=nodes, readings={"corrected": corrected, "raw": lambda: raw}, points=nodes,
                 sampled=corrected, method=pairs.method)  # fmt: skip


def corrected_reading(joints: Array) -> Array:
    """Y + delta^2 y / 12 at every joint, (n_modes, N + 1); at a pinned end delta^2 y = 0 by odd reflection."""
    corrected = joints.copy()
    corrected[:, 1:-1] += np.diff(joints, 2, axis=1) / 12.0
    return corrected


def _spline(nodes: Array, values: Array, x: Array, derivative: int) -> Array:
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(nodes, values, axis=1, bc_type="natural")(x, derivative))


def _with_ends(chain: Chain, free: Array) -> Array:
    """Positions of all joints, (N + 1, k): the unknowns with zeros at held ends."""
    return _between_zeros(free, *chain.held)


def _between_zeros(rows: Array, left: bool, right: bool) -> Array:
    """`rows` with a row of zeros before and after where asked (np.pad costs more than the whole product)."""
    padded = np.zeros((len(rows) + left + right, rows.shape[1]))
    padded[int(left) : len(padded) - right] = rows
    return padded


def _sign(chain: Chain, free: Array) -> Array:
    """+-1 for each mode, (k,): positive where the chain first moves off its left end."""
    return np.where(free[0] < 0, -1.0, 1.0)


def chain_pencil(chain: Chain) -> FactoredPencil:
    """K = B^T diag(k) B over the joint angles, and M."""
    left, right = chain.walls
    has_joint = np.concatenate([[left], np.ones(chain.n_segments - 1, dtype=bool), [right]])
    n = chain.n_segments + 1 - sum(chain.held)
    rigid = max(n - int(has_joint.sum()), 0)
    mass = mass_matrix(chain) if n > DENSE_UNKNOWNS else mass_matrix(chain, dense=True)
    return FactoredPencil(
        n=n,
        rigid_modes=rigid,
        strain=lambda free: joint_angles(chain, free),
        stiffness=1.0 / chain.compliances[has_joint],
        strain_matrix=lambda: _strain_matrix(chain),
        mass_matrix=lambda: mass,
    )


def joint_angles(chain: Chain, free: Array) -> Array:
    """Relative angles at the joints, wall joints included, (m, k): differences of link slopes, nearly exact."""
    slopes = np.diff(_with_ends(chain, free), axis=0) / chain.lengths[:, None]
    return np.diff(_between_zeros(slopes, *chain.walls), axis=0)


def _strain_matrix(chain: Chain) -> Any:
    """B of `joint_angles` as a sparse array (m, n)."""
    from scipy.sparse import diags_array

    n = chain.n_segments
    slopes = diags_array([-1.0 / chain.lengths, 1.0 / chain.lengths], offsets=[0, 1], shape=(n, n + 1)).tocsc()
    joints = diags_array([np.ones(n), -np.ones(n)], offsets=[0, -1], shape=(n + 1, n)).tocsr()
    left, right = chain.walls
    rows = slice(0 if left else 1, n + 1 if right else n)
    return joints[rows] @ slopes[:, _free_slice(chain)]


def _free_slice(chain: Chain) -> slice:
    left, right = chain.held
    return slice(int(left), chain.n_segments + 1 - int(right))


def mass_matrix(chain: Chain, *, dense: bool = False) -> Any:
    """M over the free joint positions, tridiagonal: each link m/4 (y_i + y_j)^2 + J/l^2 (y_j - y_i)^2, halved."""
    spin = chain.inertias / chain.lengths**2
    own, shared = chain.masses / 4.0 + spin, chain.masses / 4.0 - spin
    diagonal = np.zeros(chain.n_segments + 1)
    diagonal[:-1] += own
    diagonal[1:] += own
    free = _free_slice(chain)
    diagonal, off = diagonal[free], shared[free.start : free.stop - 1]
    if dense:
        return np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1)
    from scipy.sparse import diags_array

    return diags_array([off, diagonal, off], offsets=[-1, 0, 1]).tocsc()


def dispersion_frequency_hz(beam: Beam, mode: int, n_segments: int) -> float:
    """The exact frequency of mode `mode` of a pinned-pinned chain of equal links, Hz, in closed form.

    omega^2 = 48 s^4 / (3 - 2 s^2) EI / (rho A l^4), s = sin(n pi / 2N): a sine at the joints solves the
    chain's difference equations. Raises InputError for other supports or a mode the chain does not have.
    """
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {beam.supports!r}: the discrete dispersion is for pinned-pinned beams")
    if not 1 <= mode < n_segments:
        raise InputError(
            f"mode = {mode!r}: a pinned-pinned chain of {n_segments} segments has modes 1 to {n_segments - 1}"
        )
    s2 = sin(mode * pi / (2 * n_segments)) ** 2
    omega = s2 * sqrt(48.0 / (3.0 - 2.0 * s2)) * (n_segments / beam.length) ** 2 * beam.wave_constant
    return omega / (2.0 * pi)


def method(beam: Beam, n_modes: int, n_segments: int) -> str:
    """How `solve_modes` will find its eigenvalues, in words."""
    return method_name(unknowns(beam, n_segments), n_modes)
