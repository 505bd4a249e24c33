"""What a drive makes of a pencil, to rounding, however softly it is held and however slow the drive is.

The mixed matrix [[-1/d, B], [B^T, -omega^2 M]] has the forces in the strains beside the unknowns. Of unknowns in a
unit s it is [[-1/(s d), B], [B^T, -omega^2 s M]]. With s = 1 rows are exchanged for what bends as well, and what holds
a motion that does not bend, a soft spring or its own inertia, is added to bending stiffness and lost in its rounding: a
beam about a pin on a spring of 1e-8 EI/L^3 was 2e-6 off on 49 parts. With s = 1/omega both corners are small beside B
where motion is slow. Rows are exchanged for those of B then, which carries motions along the beam in numbers of order
one.

What little is lost beside springs, ground or axial force, which lie anywhere between, a solution for what is left of
load and strains gives back (iterative refinement; Higham, Accuracy and Stability of Numerical Algorithms, chapter 12):
strains are differences of differences, and unknowns are summed in two parts, as what is left over would be rounding of
their sum.
"""

from math import inf, log10
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.banded import BandAnswer, band_of
from verify.linear.fields import RESONANCE
from verify.linear.inverse import start_of
from verify.linear.pencil import DENSE_UNKNOWNS, FactoredPencil, bordered, factorised, soft_scales, swing, too_large

_SLOW = 1e-3
"""Of the stiffest strain over n^4: omega^2 below which more than 1e-11 may be lost, of 900 drawn beams up to 6e-6."""
_STEPS = 4
_SETTLED = 1e-11
"""Of the answer: a step after which there is no other, as it leaves about its square."""
_LOST = 1e-6
"""Of the answer: a last step with which it is refused."""


class _SparseAnswer(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """As `BandAnswer`, of a mixed matrix that is no narrow band."""

    factor: Any
    scales: Array
    """Of forces, (m,)."""
    found: Any
    """(m + n, k)."""
    unit: float

    @property
    def forces(self) -> Any:
        """In the strains, (m, k)."""
        return self.scales[:, None] * self.found[: len(self.scales)]

    @property
    def unknowns(self) -> Any:
        """(n, k)."""
        return self.unit * self.found[len(self.scales) :]

    def to(self, lacking: Any, loads: Any) -> "_SparseAnswer":
        """The answer to strains (m, k) that are lacking and to loads (n, k)."""
        right = np.concatenate([self.scales[:, None] * lacking / self.unit, loads]).astype(complex)
        return replace(self, found=self.factor.solve(right))


_Answer = BandAnswer | _SparseAnswer


def forced_response(pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray) -> ComplexArray:
    """V with (B^T diag(stiffness) B - omega^2 M) v = load, through the mixed matrix, (n, k) complex.

    `loads` is (n, k); `stiffness` (m,) is complex where there is damping. Raises InputError where the matrix is
    singular, and where digits cannot be vouched for.
    """
    answer = _answer(pencil, loads, omega2, stiffness)
    if pencil.uneven and omega2 * pencil.n**4 < _SLOW * abs(pencil.stiffness).max():
        return _refined(pencil, answer, loads, omega2, stiffness)
    return np.asarray(answer.unknowns)


def _answer(pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray) -> _Answer:
    """That of the mixed matrix as it is factorised."""
    unit = swing(omega2)
    try:
        if not pencil.bands:
            small = pencil.n <= DENSE_UNKNOWNS
            strain = pencil.strain(np.eye(pencil.n)) if small else pencil.strain_matrix()
            pencil.bands.append(band_of(strain, pencil.mass_matrix()))
        band = pencil.bands[0]
        found = None if band is None else band.answer(loads, omega2, stiffness, unit)
    except MemoryError:
        raise too_large(pencil.n) from None
    return found or _by_sparse_factors(pencil, loads, omega2, stiffness, unit)


def _by_sparse_factors(
    pencil: FactoredPencil, loads: Any, omega2: float, stiffness: ComplexArray, unit: float
) -> _SparseAnswer:
    """The same where the mixed matrix is no narrow band. Raises InputError where it is singular."""
    from scipy.sparse import csc_array

    diagonal = -1.0 / (unit * stiffness)
    scales = soft_scales(np.asarray(abs(1.0 / diagonal), dtype=float))
    mixed = bordered(diagonal, pencil.strain_matrix(), -omega2 * unit * csc_array(pencil.mass_matrix()))
    right = np.zeros((len(scales) + pencil.n, loads.shape[1]), dtype=complex)
    right[len(scales) :] = loads
    factor = factorised(mixed.astype(complex), "choose another frequency_hz or count")
    return _SparseAnswer(factor=factor, scales=scales, found=factor.solve(right), unit=unit)


def _refined(
    pencil: FactoredPencil, answer: _Answer, loads: Any, omega2: float, stiffness: ComplexArray
) -> ComplexArray:
    """The unknowns (n, k) of an answer to loads (n, k), and what answers what they leave, until a step is small.

    Where there is no load (at a pin, at a clamp, of forces that take each other away) there is no motion, and no step.
    Raises InputError where steps stay large, but for an undamped resonance, which whoever drives refuses.
    """
    transposed, mass, step = pencil.transposed(), pencil.mass_matrix(), inf
    driven = loads.any(axis=0)
    forces, found, rest = answer.forces, answer.unknowns, None
    elastic: Any = (stiffness if np.iscomplexobj(found) else stiffness.real)[:, None]
    for _ in range(_STEPS):
        lacking = forces / elastic - pencil.strain(found)
        left = loads - transposed @ forces + omega2 * (mass @ found)
        if rest is not None:
            lacking, left = lacking - pencil.strain(rest), left + omega2 * (mass @ rest)
        more = answer.to(lacking, left)
        change, last = more.unknowns, step
        step = float((abs(change).max(axis=0)[driven] / abs(found).max(axis=0)[driven]).max(initial=0.0))
        forces, (found, rest) = forces + more.forces, _summed(found, change if rest is None else rest + change)
        if not _SETTLED < step < last:
            break
    if not step < _LOST and not _resonates(pencil, found[:, driven], loads[:, driven], omega2, stiffness):
        raise InputError(
            f"frequency_hz: so slow a drive of {pencil.n} unknowns is answered with less than {-log10(_LOST):.0f} sure "
            "digits, as next to nothing holds the beam: lower count, raise the frequency, or hold the beam better"
        )
    return np.asarray(found)


def _resonates(pencil: FactoredPencil, found: Any, loads: Any, omega2: float, stiffness: ComplexArray) -> bool:
    """Whether an answer (n, k) to loads (n, k) without loss is a mode, of which digits tell nothing more."""
    carried = (found.conj() * (pencil.mass_matrix() @ found)).sum(axis=0).real
    distances = abs((found.conj() * loads).sum(axis=0)) / (omega2 * carried)
    return not stiffness.imag.any() and bool((distances <= 2.0 * RESONANCE).any())


def _summed(first: Any, second: Any) -> tuple[Any, Any]:
    """A sum and what rounding takes from it, where the second is the smaller (Dekker)."""
    total = first + second
    return total, second - (total - first)


def resonance_distance(pencil: FactoredPencil, omega2: float) -> float:
    """How far the nearest eigenvalue lies from omega^2, signed and relative: one step of inverse iteration.

    Exact where it is small, which is where it matters; far from a resonance an estimate.
    """
    answer = forced_response(pencil, probe(pencil), omega2, pencil.stiffness.astype(complex))
    return distance_answered(pencil, answer[:, 0].real, omega2)


def probe(pencil: FactoredPencil) -> Array:
    """The load (n, 1) of that step."""
    return np.asarray(pencil.mass_matrix() @ start_of(pencil.n))


def distance_answered(pencil: FactoredPencil, answer: Array, omega2: float) -> float:
    """The same of the answer (n,) to `probe`."""
    return float(answer @ probe(pencil)[:, 0] / (answer @ (pencil.mass_matrix() @ answer)) / omega2)
