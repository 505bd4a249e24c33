"""Pencils of discrete beams that the package's models are not: mass lumped, links without inertia, rods, other walls.

They are written here anew, from a beam's parts alone, and hold their stiffness factored as every pencil does.
"""

from collections.abc import Callable
from math import pi
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.division import Parts, divide
from verify.models.eigen import lowest
from verify.models.inverse import first_bending
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil

WALL_JOINTS = {"half": 0.5, "full": 1.0, "rigid": 0.0, "stiff": 0.25}
"""Compliance of the joint at a clamped wall, l/EI: 2EI/l, EI/l, a first link that the wall holds fast, and 4EI/l."""
LARGEST = 1500
"""Parts up to which these are solved."""
_LITTLE = 1e-5
"""Of a link's own m l^2/12, where links without any leave a motion without mass."""


class Line(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A beam divided into N parts from joint to joint: in mean lengths, of the beam's own EI and rho A."""

    supports: tuple[str, str]
    lengths: Array
    stiffnesses: Array
    masses: Array
    rotary: Array
    """Rho I over rho A l^2 of each part, (N,)."""
    shear: Array
    """Kappa G A l^2 over EI of each part, (N,); infinite where shear does not count."""
    rigid_lines: tuple[tuple[float, float], ...]
    """(a, b) of w = a + b x, x in mean lengths."""
    unit: float

    @property
    def n(self) -> int:
        """N."""
        return len(self.lengths)

    @property
    def walls(self) -> tuple[bool, bool]:
        """Which ends hold the slope."""
        left, right = (support in ("clamped", "guided") for support in self.supports)
        return left, right

    def free(self) -> Any:
        """Whether joints 0..N move, (N + 1,) bool."""
        free = np.ones(self.n + 1, dtype=bool)
        for end, support in zip((0, -1), self.supports, strict=True):
            free[end] = support not in ("pinned", "clamped")
        return free


def line_of(beam: Beam, count: int, theory: str) -> Line:
    """The parts of a uniform or stepped beam. Raises InputError for what these matrices do not know."""
    beam.check_added("this candidate", ("section",))
    if count > LARGEST:
        raise InputError(f"count = {count} is more than the {LARGEST} parts up to which this candidate is solved")
    parts = divide(beam, count)
    rotary, shear = np.zeros(count), np.full(count, np.inf)
    if theory != "euler-bernoulli":
        rotary, shear = _thickness(beam, parts, shear=theory == "timoshenko")
    return Line(
        supports=beam.supports,
        lengths=parts.lengths,
        stiffnesses=parts.stiffnesses,
        masses=parts.lengths * parts.masses_per_length,
        rotary=rotary,
        shear=shear,
        rigid_lines=tuple((a, b * parts.unit) for a, b in beam.rigid_lines),
        unit=parts.unit,
    )


def _thickness(beam: Beam, parts: Parts, *, shear: bool) -> tuple[Array, Array]:
    """(rotary, shear) of a `Line`. Raises InputError where a section does not say them."""
    ends = np.cumsum([piece.length for piece in beam.pieces]) / parts.unit
    middles = 0.5 * (parts.nodes[1:] + parts.nodes[:-1])
    which = np.minimum(np.searchsorted(ends, middles), len(beam.pieces) - 1)
    inertias, stiffnesses = [], []
    for piece in beam.pieces:
        if piece.rotary_inertia is None or (shear and piece.shear_stiffness is None):
            raise InputError("beam.rotary_inertia or beam.shear_stiffness is missing: this theory takes both")
        inertias.append(piece.rotary_inertia / (beam.mass_per_length * parts.unit**2))
        kappa_ga = piece.shear_stiffness if shear else None
        stiffnesses.append(np.inf if kappa_ga is None else kappa_ga * parts.unit**2 / beam.bending_stiffness)
    return np.array(inertias)[which] * parts.lengths, np.array(stiffnesses)[which]


def frequencies_hz(pencil: FactoredPencil, beam: Beam, line: Line, n_modes: int) -> Array:
    """The first elastic frequencies, (n_modes or fewer,), Hz."""
    available = min(n_modes, pencil.n - pencil.rigid_modes)
    if available < 1:
        return np.empty(0)
    bending = first_bending(line.lengths, line.stiffnesses, line.masses / line.lengths)
    values = lowest(replace(pencil, bending=bending), available).values
    return np.asarray(np.sqrt(values) * (beam.wave_constant / (2.0 * pi)) / line.unit**2)


def _differences(line: Line) -> tuple[Any, Any]:
    """(slopes of the parts from joints 0..N, (N, N + 1); jumps of slope at joints 0..N, (N + 1, N)), sparse."""
    from scipy.sparse import diags_array

    n = line.n
    slopes = diags_array([-1.0 / line.lengths, 1.0 / line.lengths], offsets=[0, 1], shape=(n, n + 1)).tocsr()
    jumps = diags_array([np.ones(n), -np.ones(n)], offsets=[0, -1], shape=(n + 1, n)).tocsr()
    return slopes, jumps


def _rigid(line: Line, free: Array, turns: Array | None = None) -> Array:
    """Rigid motions over the free joints, and over the free ones of as many turns as there are, (n, r)."""
    x = np.concatenate([[0.0], np.cumsum(line.lengths)])
    spun = np.empty(0, dtype=bool) if turns is None else turns
    motions = [np.append((a + b * x)[free], np.full(int(spun.sum()), b)) for a, b in line.rigid_lines]
    return np.array(motions).reshape(len(motions), int(free.sum() + spun.sum())).T


def _pencil(strain: Any, stiffness: Array, mass: Any, rigid: Array) -> FactoredPencil:
    """A pencil of sparse B and M; a small M is made dense, as small pencils are solved so."""
    n = mass.shape[0]
    held = np.asarray(mass.toarray()) if n <= DENSE_UNKNOWNS else mass.tocsc()

    def strained(v: Array) -> Array:
        return np.asarray(strain @ v)

    return FactoredPencil(
        n=n,
        rigid=rigid,
        strain=strained,
        stiffness=stiffness,
        strain_matrix=lambda: strain,
        mass_matrix=lambda: held,
    )


def _compliances(line: Line, wall: str) -> Array:
    """1/k of joints 0..N: two half links in a row, at a wall what its rule says; infinite where there is none."""
    from verify.segments.walls import wall_factors

    half = 0.5 * line.lengths / line.stiffnesses
    whole = np.concatenate([[2.0 * half[0]], half[:-1] + half[1:], [2.0 * half[-1]]])
    if wall not in WALL_JOINTS:
        return np.asarray(whole * wall_factors(line.supports, line.n, wall))
    ends = {"clamped": WALL_JOINTS[wall], "guided": 0.5}
    for end, support in zip((0, -1), line.supports, strict=True):
        whole[end] *= ends.get(support, np.inf)
    return whole


def _beside(values: Array) -> Array:
    """What the joints 0..N get of parts that each give both their ends the same, (N + 1,)."""
    return np.asarray(np.append(values, 0.0) + np.append(0.0, values))


def _link_mass(line: Line, mass: str) -> Any:
    """M over joints 0..N, sparse: 'links' with their own m l^2/12, 'points' without, 'joints' half of it at either."""
    from scipy.sparse import diags_array

    turn = line.rotary / line.lengths**2
    if mass == "joints":
        own, shared = 0.5 * line.masses + turn, -turn
    else:
        spin = {"links": 1.0, "points": _LITTLE if line.free().all() else 0.0}[mass] * line.masses / 12.0
        own, shared = 0.25 * line.masses + spin + turn, 0.25 * line.masses - spin - turn
    return diags_array([shared, _beside(own), shared], offsets=[-1, 0, 1]).tocsr()


def chain(beam: Beam, count: int, n_modes: int, *, wall: str, mass: str, theory: str) -> Array:
    """Frequencies of rigid links with joint springs, Hz: `mass` as in `_link_mass`. Raises InputError."""
    line = line_of(beam, count, theory)
    if wall == "welded":
        raise InputError("wall = 'welded' is no candidate here beside euler-bernoulli")
    slopes, jumps = _differences(line)
    free, compliances = line.free(), _compliances(line, wall)
    for beside, support in zip((1, -2), line.supports, strict=True):
        if support == "clamped" and wall == "rigid":
            free[beside] = False
    jointed = np.isfinite(compliances) & (compliances > 0.0)
    pencil = _pencil(
        (jumps @ slopes)[jointed][:, free],
        1.0 / compliances[jointed],
        _link_mass(line, mass)[free][:, free],
        _rigid(line, free),
    )
    return frequencies_hz(pencil, beam, line, n_modes)


def rod(beam: Beam, count: int, n_modes: int, *, wall: str) -> Array:
    """Frequencies of a discrete Timoshenko (Cosserat) rod, Hz: masses at the nodes, a turn and a shear of each part.

    Gazzola and others, "Forward and inverse problems in the mechanics of soft filaments", R. Soc. open sci. 5 (2018).
    Raises InputError.
    """
    from scipy.sparse import block_array, diags_array, eye_array

    line = line_of(beam, count, "timoshenko")
    slopes, jumps = _differences(line)
    free, compliances, turns = line.free(), _compliances(line, wall), np.ones(line.n, dtype=bool)
    for end, support in zip((0, -1), line.supports, strict=True):
        turns[end] &= not (support == "clamped" and wall == "rigid")
    jointed = np.isfinite(compliances) & (compliances > 0.0)
    strain = block_array([[None, jumps[jointed][:, turns]], [slopes[:, free], -eye_array(line.n).tocsr()[:, turns]]])
    mass = diags_array(np.append(0.5 * _beside(line.masses)[free], line.rotary[turns]))
    stiffness = np.append(1.0 / compliances[jointed], line.shear * line.lengths)
    return frequencies_hz(_pencil(strain.tocsr(), stiffness, mass, _rigid(line, free, turns)), beam, line, n_modes)


NODE_INERTIAS = {"lumped": 0.0, "lumped-rotary": 1.0 / 24.0, "hrz": 1.0 / 78.0}
"""Rotary inertia of half an element at its node over rho A l^3: none, the half element's own, and that of Hinton, Rock
and Zienkiewicz, Earthquake Eng. Struct. Dyn. 4 (1976)."""
LINEAR = ("linear", "linear-lumped")
"""Masses of elements whose deflection and turn are linear: consistent, and in the nodes."""


def elements(beam: Beam, count: int, n_modes: int, *, mass: str, theory: str) -> Array:
    """Frequencies of beam elements of two nodes, Hz: Hermite ones with `mass` of NODE_INERTIAS, or 'linear' ones.

    Each has a bending EI/l of the difference of its turns and a spring of the chord's turn against their mean: 12 EI/l
    of Hermite's cubic, in a row with kappa G A l by Timoshenko; kappa G A l alone of linear elements whose shear is
    integrated at one point ('linear' with consistent mass, 'linear-lumped'). Raises InputError.
    """
    line = line_of(beam, count, theory)
    if mass == "lumped" and theory == "euler-bernoulli":
        return _condensed(line, beam, n_modes)
    from scipy.sparse import block_array, diags_array

    n, (slopes, _) = line.n, _differences(line)
    turns = np.array([not line.walls[0], *[True] * (n - 1), not line.walls[1]])
    free = line.free()
    difference = diags_array([-np.ones(n), np.ones(n)], offsets=[0, 1], shape=(n, n + 1)).tocsr()
    mean = diags_array([np.full(n, 0.5), np.full(n, 0.5)], offsets=[0, 1], shape=(n, n + 1)).tocsr()
    strain = block_array([[None, difference[:, turns]], [slopes[:, free], -mean[:, turns]]]).tocsr()
    bending = line.stiffnesses / line.lengths
    cubic = np.zeros(n) if mass in LINEAR else line.lengths / (12.0 * line.stiffnesses)
    stiffness = np.append(bending, 1.0 / (cubic + 1.0 / (line.shear * line.lengths)))
    pencil = _pencil(strain, stiffness, _node_mass(line, mass, free, turns), _rigid(line, free, turns))
    return frequencies_hz(pencil, beam, line, n_modes)


def _node_mass(line: Line, mass: str, free: Array, turns: Array) -> Any:
    """M over the free deflections and turns of the nodes, sparse."""
    from scipy.sparse import block_diag, diags_array

    if mass == "linear":

        def shared(values: Array, kept: Array) -> Any:
            whole = diags_array([values / 6.0, _beside(values) / 3.0, values / 6.0], offsets=[-1, 0, 1])
            return whole.tocsr()[kept][:, kept]

        return block_diag([shared(line.masses, free), shared(line.rotary, turns)])
    inertias = NODE_INERTIAS.get(mass, 0.0) * line.masses * line.lengths**2 + 0.5 * line.rotary
    return diags_array(np.append(0.5 * _beside(line.masses)[free], _beside(inertias)[turns]))


def _condensed(line: Line, beam: Beam, n_modes: int) -> Array:
    """Hermite elements whose nodes have no rotary inertia, their turns eliminated: K = D^T S^{-1} D.

    D takes the nodes' deflections to the jumps of slope, S (three moments) the moments to the same jumps: S is
    l/3 and l/6 of neighbours over EI, and positive.
    """
    from scipy.linalg import cholesky, solve_triangular
    from scipy.sparse import csc_array, diags_array

    flexibility = line.lengths / line.stiffnesses
    moments = np.array([line.walls[0], *[True] * (line.n - 1), line.walls[1]])
    three = diags_array([flexibility / 6.0, _beside(flexibility) / 3.0, flexibility / 6.0], offsets=[-1, 0, 1])
    lower = cholesky(three.toarray()[moments][:, moments], lower=True)
    slopes, jumps = _differences(line)
    free = line.free()
    jump = (jumps @ slopes)[moments][:, free]
    strain: Callable[[Array], Array] = lambda v: np.asarray(solve_triangular(lower, jump @ v, lower=True))  # noqa: E731
    mass = diags_array(0.5 * _beside(line.masses)[free])
    held = mass.toarray() if mass.shape[0] <= DENSE_UNKNOWNS else mass.tocsc()
    pencil = FactoredPencil(
        n=int(free.sum()),
        rigid=_rigid(line, free),
        strain=strain,
        stiffness=np.ones(int(moments.sum())),
        strain_matrix=lambda: csc_array(solve_triangular(lower, jump.toarray(), lower=True)),
        mass_matrix=lambda: held,
    )
    return frequencies_hz(pencil, beam, line, n_modes)
