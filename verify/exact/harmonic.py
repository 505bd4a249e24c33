"""Exact harmonic fields: of a uniform Euler-Bernoulli beam in spliced exponentials, of any other by `exact.driven`."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from math import pi
from typing import Any

import numpy as np

from verify.arrays import Array, ComplexArray, Indices
from verify.checks import check_word
from verify.errors import InputError, ResonanceError
from verify.exact.closed_forms import frequency_hz as mode_frequency_hz
from verify.exact.layout import HELD
from verify.linear.fields import (
    RESONANCE,
    HarmonicField,
    check_drive,
    phasor,
    refuse_resonance,
    unit_drives,
    wavenumber,
)
from verify.linear.places import Forces, Numbers, as_forces, as_typed
from verify.linear.sweeps import FIELD, HarmonicSweep, one_by_one, swept_frequencies
from verify.options import THEORIES
from verify.problem.beam import Beam, PointForce

EULER = "euler-bernoulli"
UNKNOWNS = 8
"""Complex numbers of a field on one span."""


@as_typed
def solve_harmonic(beam: Beam, forces: Forces, frequency_hz: float, theory: str = EULER) -> HarmonicField:
    """The exact steady field under harmonic point forces, e^{+i omega t}, with the beam's loss factor.

    Of a uniform Euler-Bernoulli beam from |k| L = 1 on in exponentials that decay from where they start, so that no
    frequency overflows; of any other span by span (`exact.driven`). The loss factor acts on bending and shear
    stiffness, not on springs, foundation or axial force. Raises InputError; an undamped resonance is refused.
    """
    forces = as_forces(forces)
    check_word("theory", theory, THEORIES)
    check_drive(beam, forces, frequency_hz)
    return _fields(beam, forces, np.array([frequency_hz]), theory, "").field(0)


@as_typed
def sweep_harmonic(beam: Beam, forces: Forces, frequencies_hz: Numbers, theory: str = EULER) -> HarmonicSweep:
    """The exact fields of `solve_harmonic` at many frequencies, to rounding.

    Raises InputError as `solve_harmonic` does, by index: of several resonances the first.
    """
    forces = as_forces(forces)
    check_word("theory", theory, THEORIES)
    frequencies = swept_frequencies(beam, forces, frequencies_hz, UNKNOWNS * (len(forces) + 1))
    return _fields(beam, forces, frequencies, theory, FIELD)


def _fields(beam: Beam, forces: tuple[PointForce, ...], frequencies: Array, theory: str, field: str) -> HarmonicSweep:
    """The fields at frequencies, (n,); `field` names them in messages by index."""
    named: dict[str, Any] = {"theory": theory, "model": "analytic", "count": None, "beam": beam, "forces": forces}
    if _is_spliced(beam, frequencies, theory):
        for index in resonant(beam, frequencies):
            where = f"{field}[{index}]" if field else "frequency_hz"
            _refuse_nearest_mode(beam, float(frequencies[index]), where)
        return HarmonicSweep(**named, frequencies_hz=frequencies, shapes=spliced_shapes(beam, forces, frequencies))
    from verify.exact.driven import general_field

    fields = []
    for index, frequency in enumerate(frequencies.tolist()):
        try:
            shapes, turned = general_field(beam, forces, frequency, theory)
        except InputError as error:
            if not field:
                raise
            raise type(error)(str(error).replace("frequency_hz = ", f"{field}[{index}] = ", 1)) from None
        fields.append(HarmonicField(**named, frequency_hz=frequency, shapes=shapes, turned=turned))
    return one_by_one(fields)


def _is_spliced(beam: Beam, frequencies: Array, theory: str) -> bool:
    """Whether all fields are solved in exponentials: below |k| L = 1 these lose digits."""
    if theory != EULER or not beam.uniform:
        return False
    return abs(wavenumber(beam, float(frequencies.min()))) * beam.length >= 1.0


def resonant(beam: Beam, frequencies: Array) -> Indices:
    """Which of many frequencies lie on a resonance of a uniform undamped beam."""
    if beam.loss_factor:
        return np.zeros(0, dtype=int)
    turns = np.sqrt(2.0 * pi * frequencies / beam.wave_constant) * beam.length / pi
    numbers = np.unique(np.clip(turns.astype(int)[:, None] + np.arange(-1, 3), 1, None))
    resonances = np.array([mode_frequency_hz(beam, int(n)) for n in numbers])
    return np.flatnonzero(abs(frequencies[:, None] / resonances - 1.0).min(axis=1) < RESONANCE)


def _refuse_nearest_mode(beam: Beam, frequency_hz: float, field: str) -> None:
    """Raise ResonanceError naming the mode whose frequency lies nearest."""
    turns = int((2.0 * pi * frequency_hz / beam.wave_constant) ** 0.5 * beam.length / pi)
    around = [n for n in range(turns - 1, turns + 3) if n > 0]
    mode = min(around, key=lambda n: abs(mode_frequency_hz(beam, n) - frequency_hz))
    refuse_resonance("analytic", frequency_hz, mode, mode_frequency_hz(beam, mode), field)


def spliced_shapes(
    beam: Beam, forces: Sequence[PointForce], frequencies: Array
) -> Callable[[Array, int], ComplexArray]:
    """Four exponentials on every span between forces, each decaying from the end it starts at, spliced.

    Deflection, slope and moment go on over a force; EI (1 + i eta) times the third derivative jumps by it. Of
    frequencies (n,): (x, derivative) -> (n, len(x)).
    """
    k = np.array([wavenumber(beam, float(frequency)) for frequency in frequencies])[:, None]
    inner = sorted({f.position for f in forces if 0.0 < f.position < beam.length})
    ends = np.array([0.0, *inner, beam.length])
    n_spans, stiffness = len(ends) - 1, beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
    # by force, as without losses the response to each is real
    jumps = (ends[:, None] == [force.position for force in forces]) / stiffness / k[:, :, None] ** 3
    # exponentials at both ends of every span, (n, spans, 1, 4), and their derivatives over k^d, (n, spans, 4, 4)
    decay, turns = np.exp(-k[:, :, None] * np.diff(ends)[:, None] * [1j, 1.0]), np.array([_turns(d) for d in range(4)])
    at_left = np.concatenate([np.ones_like(decay), decay], axis=2)[:, :, None] * turns
    at_right = np.concatenate([decay, np.ones_like(decay)], axis=2)[:, :, None] * turns
    left, right = (list(HELD[support]) for support in beam.supports)
    matrix = np.zeros((len(k), 4 * n_spans, 4 * n_spans), dtype=complex)
    load = np.zeros((len(k), 4 * n_spans, len(forces)), dtype=complex)
    matrix[:, :2, :4], matrix[:, 2:4, -4:] = at_left[:, 0, left], at_right[:, -1, right]
    if 3 in left:  # a force at a free or guided end is its shear
        load[:, left.index(3)] = jumps[:, 0]
    if 3 in right:
        load[:, 2 + right.index(3)] = -jumps[:, -1]
    for span in range(n_spans - 1):
        rows, columns = slice(4 * span + 4, 4 * span + 8), 4 * span
        matrix[:, rows, columns : columns + 4] = -at_right[:, span]
        matrix[:, rows, columns + 4 : columns + 8] = at_left[:, span + 1]
        load[:, 4 * span + 7] = jumps[:, span + 1]
    amplitudes = np.linalg.solve(matrix, load).reshape(len(k), n_spans, 4, len(forces))
    newtons = np.array([phasor(force) for force in forces])

    def shapes(x: Array, derivative: int) -> ComplexArray:
        span = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, n_spans - 1)
        distances = (x - ends[span], x - ends[span], ends[span + 1] - x, ends[span + 1] - x)
        units = np.zeros((len(k), len(x), len(forces)), dtype=complex)
        for wave, (q, turn) in enumerate(zip((1j, 1.0, 1j, 1.0), _turns(derivative), strict=True)):
            units += turn * amplitudes[:, span, wave] * np.exp(-q * k * distances[wave])[:, :, None]
        return np.asarray((units if beam.loss_factor else units.real) @ newtons * k**derivative)

    return shapes


def _turns(derivative: int) -> tuple[complex, ...]:
    """A derivative of e^{-ikx}, e^{-kx}, e^{ikx}, e^{kx} over k^derivative."""
    return (-1j) ** derivative, (-1.0) ** derivative, 1j**derivative, 1.0


@as_typed
def unit_responses(
    beam: Beam, positions: Numbers, frequencies_hz: Numbers, x: Numbers, theory: str = EULER
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    NaN at the frequencies of undamped resonances. Raises InputError.
    """
    check_word("theory", theory, THEORIES)
    positions, frequencies_hz, x = unit_drives(beam, positions, frequencies_hz, x)
    responses = np.full((len(frequencies_hz), len(positions), len(x)), np.nan, dtype=complex)
    if not responses.size:
        return responses
    if not _is_spliced(beam, frequencies_hz, theory):
        from verify.exact.driven import general_responses

        for i, frequency in enumerate(frequencies_hz):
            with suppress(ResonanceError):
                responses[i] = general_responses(beam, positions.tolist(), float(frequency), x, theory)
        return responses
    steady = np.full(len(frequencies_hz), True)
    steady[resonant(beam, frequencies_hz)] = False
    for j, position in enumerate(positions):
        force = PointForce(position=float(position))
        responses[steady, j] = spliced_shapes(beam, [force], frequencies_hz[steady])(x, 0)
    return responses
