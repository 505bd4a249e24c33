"""Harmonic fields over many frequencies and frequencies of many beams: what the models' sweeps share."""

from collections.abc import Callable, Iterable, Sequence

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.checks import check_whole, plain, several
from verify.errors import InputError, shown
from verify.linear.fields import HarmonicField, check_forces, check_frequencies
from verify.linear.places import Forces, Numbers, as_asked, keep_lines, places, real_array
from verify.problem.beam import Beam, PointForce

MOST_VALUES = 50_000_000
"""Complex numbers that a sweep holds at once: 0.8 GB."""
FIELD = "frequencies_hz"


class HarmonicSweep(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Steady motions Re(w(x) e^{+i omega t}) of one model under the same harmonic point forces at many frequencies."""

    model: str
    """Its name."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    beam: Beam
    """On which it runs."""
    frequencies_hz: Array
    """(n_frequencies,), of the drive, hertz, in the order in which they were given."""
    forces: tuple[PointForce, ...]
    """What drives it, newton."""
    shapes: Callable[[Array, int], ComplexArray]
    """(x, derivative) -> (n_frequencies, len(x)) complex, metres per metre^derivative."""
    theory: str = "euler-bernoulli"
    """Of the beam."""
    turned: Callable[[Array, int], ComplexArray] | None = None
    """(x, derivative) -> (n_frequencies, len(x)) complex: turn psi of the section where it is not the slope w'."""

    def __post_init__(self) -> None:
        keep_lines(self, "shapes", "turned")

    def __len__(self) -> int:
        return len(self.frequencies_hz)

    def deflection(self, x: Numbers) -> ComplexArray:
        """Complex deflection at x (metres), (n_frequencies, *shape of x), metres; a number is a row of one.

        Raises InputError off the beam.
        """
        return self._read(x, 0)

    def slope(self, x: Numbers) -> ComplexArray:
        """Complex slope at x (metres), likewise, radians. Raises InputError off the beam."""
        return self._read(x, 1)

    def _read(self, x: Numbers, derivative: int) -> ComplexArray:
        at = places("x", x, self.beam.length)
        check_held(len(self), at.size, "x")
        return as_asked(self.shapes(at.ravel(), derivative), x)

    def field(self, index: int) -> HarmonicField:
        """The field at one of the frequencies, counted from 0. Raises InputError for one that is not there."""
        index = plain(index)
        if isinstance(index, bool) or not isinstance(index, int) or not -len(self) <= index < len(self):
            raise InputError(f"index = {shown(index)}: the sweep has {len(self)} frequencies, counted from 0")
        turned = self.turned
        return HarmonicField(
            model=self.model,
            count=self.count,
            beam=self.beam,
            frequency_hz=float(self.frequencies_hz[index]),
            forces=self.forces,
            shapes=lambda x, derivative: self.shapes(x, derivative)[index],
            theory=self.theory,
            turned=None if turned is None else lambda x, derivative: turned(x, derivative)[index],
        )


def one_by_one(fields: Sequence[HarmonicField]) -> HarmonicSweep:
    """Fields of one model that were solved one after another, as a sweep."""
    first = fields[0]
    return HarmonicSweep(
        model=first.model,
        count=first.count,
        beam=first.beam,
        frequencies_hz=np.array([field.frequency_hz for field in fields]),
        forces=first.forces,
        shapes=lambda x, derivative: np.array([field.shapes(x, derivative) for field in fields]),
        theory=first.theory,
        turned=None
        if first.turned is None
        else lambda x, derivative: np.array([field.turns(x, derivative) for field in fields]),
    )


def swept_frequencies(beam: Beam, forces: Forces, frequencies_hz: Numbers, unknowns: int) -> Array:
    """The frequencies in a row, (n,). Raises InputError as `check_drive` does, by index, and for too many."""
    found = real_array(FIELD, frequencies_hz, "hertz").flatten()  # a copy, as what is kept is to be
    if not found.size:
        raise InputError(f"{FIELD} is empty: give at least one frequency in hertz")
    check_held(len(found), unknowns, FIELD)
    check_forces(beam, forces)
    check_frequencies(FIELD, found, beam)
    return found


def check_held(number: int, each: int, field: str, of: str = "frequencies") -> None:
    """Raise InputError for more numbers than are held at once: so many `of` a kind, `each` with as many."""
    if number * each > MOST_VALUES:
        raise InputError(
            f"{field}: {number} {of} of {each} numbers each are more than {MOST_VALUES:.0e}: give fewer, sweep by sweep"
        )


def swept_modes(beams: Iterable[Beam], n_modes: int, solve: Callable[[Beam], Array]) -> Array:
    """Frequencies of many beams, (n_beams, n_modes), Hz. Raises InputError, naming the beam by its index."""
    beams = several("beams", beams, Beam)
    check_whole("n_modes", n_modes, 1)
    if not beams:
        raise InputError("beams is empty: give at least one Beam")
    check_held(len(beams), n_modes, "beams", "beams")
    frequencies = np.empty((len(beams), n_modes))
    for index, beam in enumerate(beams):
        try:
            frequencies[index] = solve(beam)
        except InputError as error:
            raise InputError(f"beams[{index}]: {error}") from None
    return frequencies
