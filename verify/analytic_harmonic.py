"""The exact harmonic field of a uniform beam: what `analytic_modes.solve_harmonic` returns."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from math import pi, sqrt

import numpy as np

from verify.beam import Beam, PointForce
from verify.closed_forms import check_uniform
from verify.closed_forms import frequency_hz as mode_frequency_hz
from verify.errors import ResonanceError
from verify.fields import (
    RESONANCE,
    ComplexArray,
    HarmonicField,
    check_drive,
    phasor,
    refuse_resonance,
    wavenumber,
)
from verify.modes import Array


def solve_harmonic(beam: Beam, forces: Sequence[PointForce], frequency_hz: float) -> HarmonicField:
    """The exact steady field under harmonic point forces, e^{+i omega t}, with the beam's loss factor.

    Pinned-pinned in closed form without truncation; other supports in exponentials that decay from where they
    start, so that no frequency overflows. Raises InputError; an undamped resonance is refused.
    """
    check_uniform(beam)
    check_drive(beam, forces, frequency_hz)
    if not beam.loss_factor:
        mode = _nearest_mode(beam, frequency_hz)
        if abs(frequency_hz / (resonance := mode_frequency_hz(beam, mode)) - 1.0) < RESONANCE:
            refuse_resonance("analytic", frequency_hz, mode, resonance)
    solve = pinned_shapes if beam.supports == ("pinned", "pinned") else spliced_shapes
    return HarmonicField(model="analytic", count=None, beam=beam, frequency_hz=frequency_hz, forces=tuple(forces),
                         shapes=solve(beam, forces, wavenumber(beam, frequency_hz)))  # fmt: skip


def _nearest_mode(beam: Beam, frequency_hz: float) -> int:
    """The mode whose frequency lies nearest."""
    turns = sqrt(2.0 * pi * frequency_hz / beam.wave_constant) * beam.length / pi
    around = [n for n in range(int(turns) - 1, int(turns) + 3) if n > 0]
    return min(around, key=lambda n: abs(mode_frequency_hz(beam, n) - frequency_hz))


def pinned_shapes(beam: Beam, forces: Sequence[PointForce], k: complex) -> Callable[[Array, int], ComplexArray]:
    """Green's function of the pinned-pinned beam, summed over the forces: (x, derivative) -> (len(x),).

    w = F / (4 EI k^3) (-i e^{-ik(b-a)} S_ik(a) S_ik(L-b) / S_ik(L) - e^{-k(b-a)} S_k(a) S_k(L-b) / S_k(L)) with
    a = min(x, xi), b = max(x, xi), S_q(z) = 1 - e^{-2qz}. Nothing is truncated and nothing grows.
    """
    scale = 1.0 / (4.0 * beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * k**3)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        field = np.zeros(len(x), dtype=complex)
        for force in forces:
            for q, factor in ((1j * k, -1j), (k, -1.0)):
                field += phasor(force) * scale * factor * _green(q, force.position, beam.length, x, derivative)
        return field

    return shapes


def _green(q: complex, source: float, length: float, x: Array, derivative: int) -> ComplexArray:
    """A derivative of e^{-q(b-a)} S(a) S(L-b) / S(L) by x, which is a or b: each one turns a sign in S, (len(x),)."""
    turned = -1.0 if derivative % 2 == 0 else 1.0
    left = x <= source
    a, b = np.minimum(x, source), np.maximum(x, source)
    from_left, from_right = np.exp(-2 * q * a), np.exp(-2 * q * (length - b))
    start = 1.0 + np.where(left, turned, -1.0) * from_left
    end = 1.0 + np.where(left, -1.0, turned) * from_right
    sign = np.where(left, 1.0, -1.0) ** derivative
    return np.asarray(q**derivative * sign * np.exp(-q * (b - a)) * start * end / (1.0 - np.exp(-2 * q * length)))


_FREE_DERIVATIVES = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


def spliced_shapes(beam: Beam, forces: Sequence[PointForce], k: complex) -> Callable[[Array, int], ComplexArray]:
    """Four exponentials on every span between forces, each decaying from the end it starts at, spliced.

    Deflection, slope and moment go on over a force; EI (1 + i eta) times the third derivative jumps by it.
    """
    inner = sorted({f.position for f in forces if 0.0 < f.position < beam.length})
    ends = np.array([0.0, *inner, beam.length])
    stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
    jumps = {
        p: sum(phasor(f) for f in forces if f.position == p) / stiffness / k**3 for p in (0.0, *inner, beam.length)
    }
    rows = _end_rows(beam, k, ends, jumps)
    for span, at in enumerate(inner):
        for derivative in range(4):
            here = {j: _exponentials(k, ends, span + j, np.array([at]), derivative)[:, 0] for j in (0, 1)}
            rows.append(({span: -here[0], span + 1: here[1]}, derivative, jumps[at] if derivative == 3 else 0.0))
    matrix, right = np.zeros((len(rows), len(rows)), dtype=complex), np.zeros(len(rows), dtype=complex)
    for row, (blocks, derivative, value) in enumerate(rows):
        for span, block in blocks.items():
            matrix[row, 4 * span : 4 * span + 4] = block / k**derivative
        right[row] = value
    amplitudes = np.linalg.solve(matrix, right).reshape(-1, 4)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        span = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, len(ends) - 2)
        field = np.zeros(len(x), dtype=complex)
        for j in np.unique(span):
            field[span == j] = amplitudes[j] @ _exponentials(k, ends, int(j), x[span == j], derivative)
        return field

    return shapes


Row = tuple[dict[int, ComplexArray], int, complex]


def _end_rows(beam: Beam, k: complex, ends: Array, jumps: dict[float, complex]) -> list[Row]:
    """The conditions at both ends: (exponentials by span, derivative, value). A force at a free end is its shear."""
    rows: list[Row] = []
    for at, span, support, sign in (
        (0.0, 0, beam.supports[0], 1.0),
        (beam.length, len(ends) - 2, beam.supports[1], -1.0),
    ):
        for derivative in _FREE_DERIVATIVES[support]:
            block = _exponentials(k, ends, span, np.array([at]), derivative)[:, 0]
            rows.append(({span: block}, derivative, sign * jumps[at] if derivative == 3 else 0.0))
    return rows


def _exponentials(k: complex, ends: Array, span: int, x: Array, derivative: int) -> ComplexArray:
    """e^{-ik}, e^{-k} from the left end of a span and from its right end, or a derivative, (4, len(x))."""
    ahead, back = x - ends[span], ends[span + 1] - x
    rows = [(-q) ** derivative * np.exp(-q * ahead) for q in (1j * k, k)]
    rows += [q**derivative * np.exp(-q * back) for q in (1j * k, k)]
    return np.array(rows)


def unit_responses(beam: Beam, positions: Sequence[float], frequencies_hz: Array, x: Array) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    NaN at the frequencies of undamped resonances.
    """
    responses = np.full((len(frequencies_hz), len(positions), len(x)), np.nan, dtype=complex)
    for i, j in np.ndindex(*responses.shape[:2]):
        with suppress(ResonanceError):
            force = PointForce(position=positions[j])
            responses[i, j] = solve_harmonic(beam, [force], float(frequencies_hz[i])).deflection(x)
    return responses
