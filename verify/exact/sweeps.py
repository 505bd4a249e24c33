"""The exact beam over many frequencies or many beams in one call: arrays in, arrays out."""

from collections.abc import Callable, Iterable
from typing import TypeAlias

import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_word
from verify.errors import InputError
from verify.exact.harmonic import check_off_resonance, resonant, solve_harmonic, uniform_shapes
from verify.exact.modes import exact_frequency_hz
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import HarmonicField
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.models.sweeps import FIELD, HarmonicSweep, one_by_one, swept_frequencies, swept_modes
from verify.options import THEORIES

_Swept: TypeAlias = Callable[[Array, int], ComplexArray]
"""(x, derivative) -> (n, len(x))."""
EULER = "euler-bernoulli"
UNKNOWNS = 8
"""Complex numbers that a frequency's field is made of."""


@as_typed
def sweep_harmonic(beam: Beam, forces: Forces, frequencies_hz: Numbers, theory: str = EULER) -> HarmonicSweep:
    """The exact fields of `solve_harmonic` at many frequencies, in one call and to rounding.

    Uniform Euler-Bernoulli beams from |k| L = 1 on are taken all at once, all others one by one. Raises InputError as
    `solve_harmonic` does, by index: of several resonances the first.
    """
    forces = as_forces(forces)
    check_word("theory", theory, THEORIES)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, UNKNOWNS * (len(forces) + 1))
    shapes, turned = _shapes(beam, forces, frequencies, theory)
    return HarmonicSweep(
        theory=theory,
        model="analytic",
        count=None,
        beam=beam,
        frequencies_hz=frequencies,
        forces=forces,
        shapes=shapes,
        turned=turned,
    )


def _shapes(
    beam: Beam, forces: tuple[PointForce, ...], frequencies: Array, theory: str
) -> tuple[_Swept, _Swept | None]:
    """Deflections, and turns where they are none of their slopes: of a uniform beam at once, of others one by one."""
    if theory == EULER and beam.uniform:
        _refuse_resonances(beam, frequencies)
        return uniform_shapes(beam, forces, frequencies), None
    swept = one_by_one([_one(beam, forces, float(frequency), i, theory) for i, frequency in enumerate(frequencies)])
    return swept.shapes, swept.turned


def _one(beam: Beam, forces: tuple[PointForce, ...], frequency: float, index: int, theory: str) -> HarmonicField:
    """One of them as `solve_harmonic` has it; its refusal says which."""
    try:
        return solve_harmonic(beam, forces, frequency, theory)
    except InputError as error:
        raise type(error)(str(error).replace("frequency_hz = ", f"{FIELD}[{index}] = ", 1)) from None


def _refuse_resonances(beam: Beam, frequencies: Array) -> None:
    """Raise ResonanceError for the first frequency on an undamped resonance of a uniform beam, by index."""
    for index in resonant(beam, frequencies):
        check_off_resonance(beam, float(frequencies[index]), f"{FIELD}[{index}]")


@as_typed
def sweep_modes(beams: Iterable[Beam], n_modes: int, theory: str = EULER) -> Array:
    """Exact frequencies of the first modes of many beams, (n_beams, n_modes) in Hz, as `solve_modes` has them.

    Uniform Euler-Bernoulli beams on the same supports share their roots. Raises InputError as `solve_modes` does,
    naming the beam by its index.
    """
    numbers = range(1, n_modes + 1)
    return swept_modes(beams, n_modes, lambda beam: np.array([exact_frequency_hz(beam, n, theory) for n in numbers]))
