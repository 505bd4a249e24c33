"""How a beam is divided into segments or elements: lengths and properties of the parts. Geometry, no mechanics."""

import msgspec
import numpy as np

from verify.arrays import Array
from verify.checks import check_number
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.cross_section import Piece


class Parts(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """N parts from left to right, each (N,), relative to the beam's own E, I, rho A, A and to `unit` of length."""

    unit: float
    """Metres: the mean length of a part, so that equal parts have length 1 exactly."""
    lengths: Array
    moduli: Array
    second_moments: Array
    masses_per_length: Array
    areas: Array
    equal: bool
    """Whether all parts are alike."""

    @property
    def stiffnesses(self) -> Array:
        """EI, (N,)."""
        return self.moduli * self.second_moments

    @property
    def axial_stiffnesses(self) -> Array:
        """EA, (N,)."""
        return self.moduli * self.areas

    @property
    def nodes(self) -> Array:
        """Ends of the parts, (N + 1,), in units from the left end."""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])


def divide(beam: Beam, count: int, grading: float = 1.0, pieces: tuple[Piece, ...] = ()) -> Parts:
    """Divide a beam into `count` parts whose ends fall on its steps.

    Every section gets parts in proportion to its length, at least one. `grading` is the length of a section's
    last part over that of its first, in geometric progression. `pieces`, at most `count`, stand in place of the
    beam's own where it is divided at more places than its steps. Raises InputError for fewer parts than sections
    or a grading that is not positive and finite.
    """
    check_division(beam, count, grading)
    pieces = pieces or beam.pieces
    unit = beam.length / count
    if len(pieces) == 1 and not beam.stepped and grading == 1.0:
        one = np.ones(count)
        return Parts(
            unit=unit, lengths=one, moduli=one, second_moments=one, masses_per_length=one, areas=one, equal=True
        )
    shares = part_counts([piece.length for piece in pieces], count)
    lengths = [_graded(piece.length / unit, n, grading) for piece, n in zip(pieces, shares, strict=True)]
    moduli, moments, masses, areas = np.repeat(_ratios(beam.own, pieces), shares, axis=0).T
    return Parts(
        unit=unit,
        lengths=np.concatenate(lengths),
        moduli=moduli,
        second_moments=moments,
        masses_per_length=masses,
        areas=areas,
        equal=False,
    )


def _ratios(own: Piece, pieces: tuple[Piece, ...]) -> Array:
    """E, I, rho A, A of every piece over the beam's own, (n_pieces, 4).

    Where one is given plainly, E is one everywhere and I stands for EI; without areas they are not a number.
    """
    every = (own, *pieces)
    if any(p.youngs_modulus is None for p in every):
        rows = [(1.0, p.bending_stiffness, p.mass_per_length, np.nan) for p in every]
    else:
        rows = [(p.youngs_modulus, p.second_moment, p.mass_per_length, p.area) for p in every]  # type: ignore[misc]
    table = np.array(rows, dtype=float)
    return np.asarray(table[1:] / table[0])


def check_division(beam: Beam, count: int, grading: float = 1.0) -> None:
    """Raise InputError where `divide` would."""
    check_number("grading", grading, "last over first length", above=0)
    if not 1e-3 <= grading <= 1e3:
        raise InputError(f"grading = {grading!r}: give a ratio of last to first length between 0.001 and 1000")
    if count < len(beam.pieces):
        raise InputError(f"count = {count}: a beam of {len(beam.pieces)} sections needs at least as many parts")


def part_counts(lengths: list[float], count: int) -> list[int]:
    """How many of `count` parts each section gets: in proportion to length by largest remainders, at least one."""
    shares = np.array(lengths) / sum(lengths) * count
    counts = np.maximum(np.floor(shares + 1e-9), 1.0)
    while (missing := count - counts.sum()) != 0.0:
        step = np.sign(missing)
        counts[np.where(counts + step >= 1.0, step * (shares - counts), -np.inf).argmax()] += step
    return [int(n) for n in counts]


def _graded(length: float, n: int, grading: float) -> Array:
    """N lengths in geometric progression that add up to `length`, the last `grading` times the first."""
    if grading == 1.0 or n == 1:
        return np.full(n, length / n)
    steps = grading ** (np.arange(n) / (n - 1))
    return np.asarray(steps * (length / steps.sum()))
