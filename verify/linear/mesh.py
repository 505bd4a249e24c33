"""Division of a beam into segments or elements: lengths and properties of the parts. Geometry, no mechanics."""

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.errors import InputError
from verify.problem.beam import SHORTEST_SECTION, Beam, is_stepped
from verify.problem.cross_section import Piece
from verify.validation import check_number, check_type


class Parts(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """N parts from left to right; (N,) arrays relative to the beam's own E, I, rho A, A and to `unit` of length."""

    unit: float  # Mean length of a part, m: equal parts have length 1 exactly
    lengths: Array
    moduli: Array
    second_moments: Array
    masses_per_length: Array
    areas: Array
    equal: bool  # Whether all parts are equal
    pieces: tuple[Piece, ...]  # Pieces of the beam that are divided
    shares: list[int]  # Number of parts of each piece

    def of(self, figure: str) -> Array:
        """A property of the section of every part, (N,), SI."""
        return np.repeat([float(getattr(piece, figure)) for piece in self.pieces], self.shares)

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

    The number of parts of a piece is proportional to its length, at least one. `grading` is the length of a piece's
    last part over that of its first, in geometric progression. `pieces` (see `cut_pieces`) replace those of the beam.
    Raises InputError for fewer parts than pieces, and for a grading that is not between 0.001 and 1000.
    """
    pieces = pieces or beam.pieces
    check_division(beam, count, grading, len(pieces))
    unit, equal = beam.length / count, len(pieces) == 1 and not is_stepped(beam) and grading == 1.0
    shares, lengths = part_counts([piece.length for piece in pieces], count), [np.ones(count)]
    if not equal:
        steps = [grading ** (np.arange(n) / max(n - 1, 1)) for n in shares]
        lengths = [s * (piece.length / unit / s.sum()) for piece, s in zip(pieces, steps, strict=True)]
    every, ratios = (beam.base_section, *pieces), np.ones((1, 4))  # E, I, rho A, A of every piece over the beam's own
    if not equal and any(p.youngs_modulus is None for p in every):  # without a shape E is 1, I is EI
        ratios = np.array([(1.0, p.bending_stiffness, p.mass_per_length, np.nan) for p in every])
    elif not equal:
        ratios = np.array([(p.youngs_modulus, p.second_moment, p.mass_per_length, p.area) for p in every], dtype=float)
    moduli, moments, masses, areas = np.repeat(ratios if equal else ratios[1:] / ratios[0], shares, axis=0).T
    return Parts(
        unit=unit,
        lengths=np.concatenate(lengths),
        moduli=moduli,
        second_moments=moments,
        masses_per_length=masses,
        areas=areas,
        equal=equal,
        pieces=pieces,
        shares=shares,
    )


def cut_pieces(beam: Beam) -> tuple[Piece, ...]:
    """The pieces of a beam, cut at attachments.

    No cut at an attachment closer than the shortest section to a step, an end or another attachment.
    """
    places = sorted({attachment.position for attachment in beam.attached})
    near, pieces, start = SHORTEST_SECTION * beam.length, [], 0.0
    for piece in beam.pieces:
        left, end = start, start + piece.length
        for place in places:
            if left + near <= place <= end - near:
                pieces.append(replace(piece, length=place - left))
                left = place
        pieces.append(replace(piece, length=end - left) if left > start else piece)
        start = end
    return tuple(pieces)


def check_division(beam: Beam, count: int, grading: float = 1.0, least: int = 0) -> None:
    """Raise InputError for an invalid grading, and for fewer parts than `least` or the number of pieces."""
    check_type("beam", beam, Beam)
    check_number("grading", grading, "last over first length", at_least=1e-3, at_most=1e3)
    if count < (least := max(least, len(beam.pieces))):
        raise InputError(f"count = {count}: steps, masses and springs cut the beam into {least}, give as many parts")


def part_counts(lengths: list[float], count: int) -> list[int]:
    """Number of parts of each piece: proportional to length by largest remainders, at least one."""
    shares = np.array(lengths) / sum(lengths) * count
    counts = np.maximum(np.floor(shares + 1e-9), 1.0)
    while (missing := count - counts.sum()) != 0.0:
        step = np.sign(missing)
        counts[np.where(counts + step >= 1.0, step * (shares - counts), -np.inf).argmax()] += step
    return [int(n) for n in counts]
