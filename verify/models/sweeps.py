"""What every model's sweeps share: fields over many frequencies in one value, solved together, refused one by one.

A sweep gives what a loop over `solve_harmonic` or `solve_modes` would, to rounding, arrays in and arrays out.
"""

from collections.abc import Callable, Hashable, Sequence
from math import ceil, pi
from typing import TypeVar

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.checks import check_word, plain
from verify.cores import at_once
from verify.errors import InputError, shown
from verify.field_docs import Value
from verify.models.arrays import Array, BoolArray, ComplexArray
from verify.models.driven_pencil import check_couples, check_dense, receptance_basis, takes_all_modes
from verify.models.eigen import lowest
from verify.models.fields import RESONANCE, HarmonicField, check_forces, check_frequencies
from verify.models.pencil import DENSE_UNKNOWNS, FactoredPencil
from verify.models.places import Forces, Numbers, as_asked, keep_lines, places, real_array
from verify.models.response import distance_answered, forced_response, probe
from verify.models.stacks import PencilStack, lowest_of_each
from verify.options import THEORIES

MOST_VALUES = 50_000_000
"""Complex numbers that a sweep holds at once: 0.8 GB."""
FEW = 4
"""Frequencies up to which each is solved by itself."""
LEAST = 8
"""Beams of one layout from which on a stack takes less time than each by itself."""
TOGETHER, MODES_TOGETHER = 800, 8000
"""Beams in a stack, and modes of them, at most: enough to fill numpy's loops, few enough to stay near the processor."""
MODES_WORTH, UNKNOWNS_WORTH = 4000, 2000
"""Modes in stacks, and unknowns of beams alone, that take longer than a process does to begin: 20 ms."""
FIELD = "frequencies_hz"
Found = TypeVar("Found")
Item = TypeVar("Item")


class HarmonicSweep(Value, frozen=True, eq=False, kw_only=True):
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
        index = plain(index, "index")
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
        turned=_turned(fields),
    )


def _turned(fields: Sequence[HarmonicField]) -> Callable[[Array, int], ComplexArray] | None:
    """The turns of fields one after another, where they have any of their own."""
    if fields[0].turned is None:
        return None
    return lambda x, derivative: np.array([field.turns(x, derivative) for field in fields])


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


def of_each(which: Sequence[int], beams: Sequence[Beam], make: Callable[[Beam], Found]) -> list[Found]:
    """What is made of each of some beams; refusals say of which. Raises InputError."""
    found = []
    for index in which:
        try:
            found.append(make(beams[index]))
        except InputError as error:
            raise InputError(f"beams[{index}]: {error}") from None
    return found


def swept_response(
    pencil: FactoredPencil,
    loads: ComplexArray,
    omega2: Array,
    stiffness: ComplexArray,
    modal_damping: float,
    refuse: Callable[[int], None] | None = None,
) -> ComplexArray:
    """The responses (n, n_frequencies) to loads (n, 1), as `damped_response` gives them one by one.

    `stiffness` is (m,) or, where it changes with the frequency, (n_frequencies, m). All modes are solved once and
    summed where damping leaves them uncoupled; where it does not, and of few frequencies, each is solved as a band.
    `refuse`, of an undamped pencil, is called with the index of the first frequency at which it resonates, if there is
    one. Raises InputError for both dampings together where they couple modes.
    """
    over = np.broadcast_to(stiffness, (len(omega2), len(pencil.stiffness)))
    factors = over / pencil.stiffness
    coupled = np.ptp(factors.imag, axis=1) > 1e-15 * abs(factors).max(axis=1)
    if modal_damping:
        check_couples(factors)
        check_dense(pencil, "modal_damping")
    elif coupled.any() or len(omega2) <= FEW or not takes_all_modes(pencil):
        asked = loads if refuse is None else np.hstack([loads, probe(pencil)])
        found = [forced_response(pencil, asked, float(w2), d) for w2, d in zip(omega2, over, strict=True)]
        if refuse is not None:
            answers = zip(found, omega2, strict=True)
            near = [distance_answered(pencil, one[:, 1].real, float(w2)) for one, w2 in answers]
            _refuse_nearest(np.array(near), refuse)
        return np.hstack([one[:, :1] for one in found]).astype(complex)
    values, vectors = receptance_basis(pencil)
    if refuse is not None:
        _refuse_nearest(abs(values / omega2[:, None] - 1.0).min(axis=1), refuse)
    denominators = values * factors[:, :1] - omega2[:, None]
    if modal_damping:
        denominators = denominators + 2j * modal_damping * np.sqrt(values * omega2[:, None])
    return _combined(vectors, _combined(vectors.T, loads) / denominators.T)


def _combined(columns: Array, shares: ComplexArray) -> ComplexArray:
    """Real columns by complex shares, in half of what numpy takes, which has the columns made complex."""
    flat = np.ascontiguousarray(shares, dtype=complex).view(float)
    return np.asarray((columns @ flat).view(complex))


def _refuse_nearest(distances: Array, refuse: Callable[[int], None]) -> None:
    """Call `refuse` with the first index whose distance to a resonance is none."""
    for index in np.flatnonzero(abs(distances) <= 2.0 * RESONANCE):
        refuse(int(index))


class Stacking(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """How a model takes many beams."""

    make: Callable[[Beam, int], tuple[FactoredPencil, float]]
    """Checks a beam and a number of modes, and gives its pencil and unit, metres. Raises InputError."""
    layout: Callable[[Beam], Hashable]
    """What beams have in common that are stacked and refused alike; None for a beam that is taken alone."""
    stack: Callable[[Sequence[Beam]], PencilStack]
    """The pencils of beams of one layout, whose units are the same part of their lengths."""


def swept_modes(beams: Sequence[Beam], n_modes: int, theory: str, model: Stacking) -> Array:
    """Frequencies of many beams, (n_beams, n_modes) in Hz.

    Plain uniform beams on the same supports differ by their scale alone and share one solve, on ground too, which lifts
    every omega^2 by k_f/(rho A) and bends no mode; others of one layout are solved as one stack (`stacks`), and those
    of it that do not settle, with all that are left, each by itself. Raises InputError, naming the beam by its index.
    """
    if not beams:
        raise InputError("beams is empty: give at least one Beam")
    check_word("theory", theory, THEORIES)
    check_held(len(beams), n_modes, "beams", "beams")
    leaders = _leaders(beams, theory)
    lifted = [i for i in set(leaders) if beams[i].foundation and _is_plain(beams[i], theory)]
    groups = _groups(sorted(set(leaders) - set(lifted)), beams, model.layout)
    made = _made(sorted([*lifted, *(group[0] for group in groups)]), beams, n_modes, model)
    rows = _stacks(groups, beams, n_modes, model, made)
    alone = sorted(set(leaders) - set(rows) - set(lifted))

    def solved(i: int) -> Array:
        pencil, _ = made[i] if i in made else model.make(beams[i], n_modes)
        return lowest(pencil, n_modes).values

    worth = bool(alone) and len(alone) * made[groups[0][0]][0].n >= UNKNOWNS_WORTH
    rows |= zip(alone, _shared(solved, alone, worth), strict=True)
    rows |= {i: _without_ground(beams[i], n_modes, model) for i in lifted}
    units = {i: made[group[0]][1] / beams[group[0]].length for group in groups for i in group}
    units |= {i: made[i][1] / beams[i].length for i in lifted}
    lengths = np.array([units[i] * beam.length for i, beam in zip(leaders, beams, strict=True)])
    scales = np.array([beam.wave_constant for beam in beams]) / (2.0 * pi) / lengths**2
    values = np.concatenate([rows[i] for i in leaders]).reshape(len(beams), n_modes)
    grounds = [beam.foundation / beam.bending_stiffness * (i in lifted) for i, beam in zip(leaders, beams, strict=True)]
    return np.asarray(np.sqrt(values + (np.array(grounds) * lengths**4)[:, None]) * scales[:, None])


def _without_ground(beam: Beam, n_modes: int, model: Stacking) -> Array:
    """The values of a plain beam off its ground, those of motions without strain with them, (n_modes,)."""
    bare = replace(beam, foundation=0.0)
    left = n_modes - bare.rigid_motions
    bent = lowest(model.make(bare, left)[0], left).values if left > 0 else np.zeros(0)
    return np.concatenate([np.zeros(n_modes - len(bent)), bent])


def _made(
    which: Sequence[int], beams: Sequence[Beam], n_modes: int, model: Stacking
) -> dict[int, tuple[FactoredPencil, float]]:
    """Pencils and units of some beams, by index. Raises InputError."""
    return dict(zip(which, of_each(which, beams, lambda beam: model.make(beam, n_modes)), strict=True))


def _groups(which: Sequence[int], beams: Sequence[Beam], layout: Callable[[Beam], Hashable]) -> list[list[int]]:
    """Beams of one layout together, in the order of their first; few are not worth it and stand alone, like others."""
    together: dict[Hashable, list[int]] = {}
    for i in which:
        shared = layout(beams[i])
        together.setdefault(("alone", i) if shared is None else shared, []).append(i)
    groups = [[each] for group in together.values() if len(group) < LEAST for each in group]
    return sorted(groups + [group for group in together.values() if len(group) >= LEAST])


def _stacks(
    groups: list[list[int]],
    beams: Sequence[Beam],
    n_modes: int,
    model: Stacking,
    made: dict[int, tuple[FactoredPencil, float]],
) -> dict[int, Array]:
    """The lowest values, (n_modes,) each, of the beams that settled in a stack, by index."""
    parts = [part for group in groups if _is_stack(group, n_modes, made) for part in _parts(group, n_modes)]

    def solved(part: list[int]) -> tuple[Array, BoolArray]:
        _keep_memory()
        return lowest_of_each(model.stack([beams[i] for i in part]), n_modes)

    worth = n_modes * sum(map(len, parts)) >= MODES_WORTH
    found: dict[int, Array] = {}
    for part, (values, settled) in zip(parts, _shared(solved, parts, worth), strict=True):
        found |= {i: row for i, row, sure in zip(part, values.T, settled, strict=True) if sure}
    return found


def _shared(work: Callable[[Item], Found], items: Sequence[Item], worth: bool) -> list[Found]:
    """`work` of every item, on several cores where that is `worth` a process."""
    return at_once(work, items) if worth else [work(item) for item in items]


def _is_stack(group: list[int], n_modes: int, made: dict[int, tuple[FactoredPencil, float]]) -> bool:
    """Whether a group is worth a stack, and its beams have modes above those that are asked for."""
    pencil, _ = made[group[0]]
    return (
        len(group) >= LEAST and pencil.n <= DENSE_UNKNOWNS and 3 * (n_modes + 2) <= 2 * (pencil.n - pencil.rigid_modes)
    )


def _keep_memory() -> None:
    """Show glibc a block of 31 MB, freed untouched, so that it keeps as much of what is freed for who asks next.

    It would give every array of a stack back to the system and ask for another, which is a quarter of a stack's time.
    """
    np.empty(31 * 2**20, dtype=np.uint8)


def _parts(group: list[int], n_modes: int) -> list[list[int]]:
    """A group in equal parts of `TOGETHER` and `MODES_TOGETHER` at most, an even number of them if worth a process.

    However many cores there are: how they are cut may show in a last digit.
    """
    parts = ceil(len(group) / min(TOGETHER, max(MODES_TOGETHER // n_modes, LEAST)))
    parts += parts % 2 * (n_modes * len(group) >= MODES_WORTH)
    size = ceil(len(group) / parts)
    return [group[first : first + size] for first in range(0, len(group), size)]


def _leaders(beams: Sequence[Beam], theory: str) -> list[int]:
    """For every beam the first that has its pencil: itself, unless it is plain and differs from one by its scale.

    Or by its scale and its ground.
    """
    first: dict[object, int] = {}
    keys = ((beam.supports, beam.foundation > 0.0) if _is_plain(beam, theory) else i for i, beam in enumerate(beams))
    return [first.setdefault(key, i) for i, key in enumerate(keys)]


def _is_plain(beam: Beam, theory: str) -> bool:
    """Whether it is a thin one of one section, with nothing on it and at most ground under it."""
    return theory == "euler-bernoulli" and not beam.section and set(beam.added) <= {"foundation"}
