"""The exact harmonic field: what `analytic_modes.solve_harmonic` returns. Of a uniform beam in closed form."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import lru_cache
from math import factorial, pi, sqrt
from typing import Any, TypeAlias

import numpy as np

from verify.beam import Beam, PointForce
from verify.checks import check_word
from verify.errors import InputError, ResonanceError
from verify.exact.closed_forms import frequency_hz as mode_frequency_hz
from verify.models.arrays import Array, BoolArray, ComplexArray, Indices
from verify.models.fields import (
    RESONANCE,
    HarmonicField,
    check_drive,
    phasor,
    refuse_resonance,
    unit_drives,
    wavenumber,
)
from verify.models.places import Forces, Numbers, as_forces, as_typed
from verify.options import THEORIES


@as_typed
def solve_harmonic(beam: Beam, forces: Forces, frequency_hz: float, theory: str = "euler-bernoulli") -> HarmonicField:
    """The exact steady field under harmonic point forces, e^{+i omega t}, with the beam's loss factor.

    Of a uniform Euler-Bernoulli beam: pinned-pinned in closed form without truncation; other supports in exponentials
    that decay from where they start, so that no frequency overflows; below |k| L = 1, where both lose digits, in power
    series. Of any other span by span (`exact.driven`); the loss factor acts on its bending and shear stiffness, not on
    springs, foundation or axial force. Raises InputError; an undamped resonance is refused.
    """
    forces = as_forces(forces)
    check_word("theory", theory, THEORIES)
    if theory != "euler-bernoulli" or not beam.uniform:
        from verify.exact.driven import general_field

        shapes, turned = general_field(beam, forces, frequency_hz, theory)
    else:
        shapes, turned = _closed_form(beam, forces, frequency_hz), None
    return HarmonicField(
        theory=theory,
        model="analytic",
        count=None,
        beam=beam,
        frequency_hz=frequency_hz,
        forces=forces,
        shapes=shapes,
        turned=turned,
    )


def check_closed_form(beam: Beam, forces: Sequence[PointForce], frequency_hz: float) -> None:
    """Raise InputError for a drive of a uniform beam by Euler-Bernoulli's theory that has no steady field."""
    check_drive(beam, forces, frequency_hz)
    check_off_resonance(beam, frequency_hz)


def _closed_form(beam: Beam, forces: Sequence[PointForce], frequency_hz: float) -> Callable[[Array, int], ComplexArray]:
    check_closed_form(beam, forces, frequency_hz)
    k = wavenumber(beam, frequency_hz)
    slow, pinned = abs(k) * beam.length < 1.0, beam.supports == ("pinned", "pinned")
    solve = slow_shapes if slow else pinned_shapes if pinned else spliced_shapes
    return solve(beam, forces, k)


def uniform_shapes(
    beam: Beam, forces: Sequence[PointForce], frequencies: Array
) -> Callable[[Array, int], ComplexArray]:
    """A uniform beam's field at each of many frequencies, (x, derivative) -> (n, len(x)); short waves all at once."""
    waves = np.array([wavenumber(beam, float(frequency)) for frequency in frequencies])
    fast = abs(waves) * beam.length >= 1.0
    solve = pinned_shapes if beam.supports == ("pinned", "pinned") else spliced_shapes
    if fast.all():
        return solve(beam, forces, waves[:, None])
    parts: list[tuple[Indices, Callable[[Array, int], ComplexArray]]] = []
    if fast.any():
        parts.append((np.flatnonzero(fast), solve(beam, forces, waves[fast, None])))
    parts += [(np.array([i]), slow_shapes(beam, forces, complex(waves[i]))) for i in np.flatnonzero(~fast)]

    def shapes(x: Array, derivative: int) -> ComplexArray:
        found = np.empty((len(frequencies), len(x)), dtype=complex)
        for which, some in parts:
            found[which] = some(x, derivative)
        return found

    return shapes


def resonant(beam: Beam, frequencies: Array) -> Indices:
    """Which of many frequencies lie on a resonance of a uniform undamped beam, as `check_off_resonance` has it."""
    if beam.loss_factor:
        return np.zeros(0, dtype=int)
    turns = np.sqrt(2.0 * pi * frequencies / beam.wave_constant) * beam.length / pi
    numbers = np.unique(np.clip(turns.astype(int)[:, None] + np.arange(-1, 3), 1, None))
    resonances = np.array([mode_frequency_hz(beam, int(n)) for n in numbers])
    above = np.clip(np.searchsorted(resonances, frequencies), 0, len(resonances) - 1)
    around = np.stack([np.maximum(above - 1, 0), above], axis=1)
    return np.flatnonzero(abs(frequencies[:, None] / resonances[around] - 1.0).min(axis=1) < RESONANCE)


def check_off_resonance(beam: Beam, frequency_hz: float, field: str = "frequency_hz") -> None:
    """Raise ResonanceError where a uniform undamped beam is driven on one of its resonances."""
    if beam.loss_factor:
        return
    mode = _nearest_mode(beam, frequency_hz)
    if abs(frequency_hz / (resonance := mode_frequency_hz(beam, mode)) - 1.0) < RESONANCE:
        refuse_resonance("analytic", frequency_hz, mode, resonance, field)


def _nearest_mode(beam: Beam, frequency_hz: float) -> int:
    """The mode whose frequency lies nearest."""
    turns = sqrt(2.0 * pi * frequency_hz / beam.wave_constant) * beam.length / pi
    around = [n for n in range(int(turns) - 1, int(turns) + 3) if n > 0]
    return min(around, key=lambda n: abs(mode_frequency_hz(beam, n) - frequency_hz))


def pinned_shapes(beam: Beam, forces: Sequence[PointForce], k: Any) -> Callable[[Array, int], ComplexArray]:
    """Green's function of the pinned-pinned beam, summed over the forces: (x, derivative) -> (len(x),).

    w = F / (4 EI k^3) (-i e^{-ik(b-a)} S_ik(a) S_ik(L-b) / S_ik(L) - e^{-k(b-a)} S_k(a) S_k(L-b) / S_k(L)) with
    a = min(x, xi), b = max(x, xi), S_q(z) = 1 - e^{-2qz}. Nothing is truncated and nothing grows. Of many
    wavenumbers in a column, (n, 1): (x, derivative) -> (n, len(x)).
    """
    if not np.any(k.imag):
        return _undamped_shapes(beam, forces, k.real)
    scale = 1.0 / (4.0 * beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * k**3)
    waves = [(force, q, factor) for force in forces for q, factor in ((1j * k, -1j), (k, -1.0))]
    parts = [_fixed(q, force.position, beam.length) for force, q, _ in waves]
    sizes = [phasor(force) * scale * factor for force, _, factor in waves]

    def decays(x: Array) -> list[_Decay]:
        return [_decay(q, force.position, beam.length, x) for force, q, _ in waves]

    known = lru_cache(maxsize=1)(lambda x: decays(np.frombuffer(x)))  # deflections and slopes are read together

    def shapes(x: Array, derivative: int) -> ComplexArray:
        field = np.zeros((*np.shape(k)[:-1], len(x)), dtype=complex)
        there = known(x.tobytes()) if np.ndim(k) == 0 and len(x) <= READ_AGAIN else decays(x)
        for (_, q, _), fixed, decay, size in zip(waves, parts, there, sizes, strict=True):
            field += size * _green(q, fixed, decay, derivative)
        return field

    return shapes


def _undamped_shapes(beam: Beam, forces: Sequence[PointForce], k: Any) -> Callable[[Array, int], ComplexArray]:
    """The same of real wavenumbers: the first part is 2 sin(k a) sin(k (L - b)) / sin(k L), all real but the forces."""
    length, whole = beam.length, np.sin(k * beam.length)
    scale = 0.25 / (beam.bending_stiffness * k**3)
    sources = [
        (phasor(force), at, _fixed(k, at, length), *(2.0 * np.sin(k * far) / whole for far in (length - at, at)))
        for force in forces
        for at in (force.position,)
    ]

    def shapes(x: Array, derivative: int) -> ComplexArray:
        field = np.zeros((*np.shape(k)[:-1], len(x)), dtype=complex)
        for size, source, fixed, behind, before in sources:
            left = x <= source
            turned = (np.cos if derivative % 2 else np.sin)(k * np.where(left, x, length - x))
            turned *= np.where(left, behind, before)
            if derivative:
                turned *= (-1.0) ** (derivative // 2) * k**derivative * np.where(left, 1.0, -1.0) ** derivative
            turned -= _green(k, fixed, _decay(k, source, length, x), derivative)
            field += size * (scale * turned)
        return field

    return shapes


READ_AGAIN = 5000
"""Places up to which what was found there is kept for the next derivative."""
_Decay: TypeAlias = tuple[BoolArray, Any, Any]


def _fixed(q: Any, source: float, length: float) -> tuple[Any, Any, Any]:
    """S(xi), S(L - xi), S(L)."""
    before, behind, whole = (1.0 - np.exp(-2 * q * part) for part in (source, length - source, length))
    return before, behind, whole


def _decay(q: Any, source: float, length: float, x: Array) -> _Decay:
    """Of every x: whether it lies left of the force, e^{-2qz} of its distance z to its own end, e^{-q(b-a)}."""
    left = x <= source
    return left, np.exp(-2 * q * np.where(left, x, length - x)), np.exp(-q * abs(x - source))


def _green(q: Any, fixed: tuple[Any, Any, Any], decay: _Decay, derivative: int) -> ComplexArray:
    """A derivative of e^{-q(b-a)} S(a) S(L-b) / S(L) by x, which is a or b: each one turns a sign in S, (len(x),)."""
    (before, behind, whole), (left, own, wave) = fixed, decay
    moving = 1.0 - own if derivative % 2 == 0 else 1.0 + own
    start, end = np.where(left, moving, before), np.where(left, behind, moving)
    if derivative:
        wave = q**derivative * np.where(left, 1.0, -1.0) ** derivative * wave
    return np.asarray(wave * start * end / whole)


_NO_INERTIA = 1e-280
"""(k L)^4 below which a rigid motion overflows."""
_FREE_DERIVATIVES = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}


def slow_shapes(beam: Beam, forces: Sequence[PointForce], k: complex) -> Callable[[Array, int], ComplexArray]:
    """Krylov's functions from the left end, sum of c_d u_d(x/L) and of F L^3 / EI u_3((x - xi)/L) behind each force.

    The c_d are deflection, slope, curvature and its gradient at the left end; two of them its support sets to zero,
    the other two follow from the right end. As k goes to 0 the u_d are 1, z, z^2/2, z^3/6: the static beam. Raises
    InputError where a beam that is not held has no finite answer.
    """
    kappa = (k * beam.length) ** 4
    scale = beam.length**3 / (beam.bending_stiffness * (1.0 + 1j * beam.loss_factor))
    sources = [(force.position / beam.length, phasor(force) * scale) for force in forces]
    unknown = [d for d in range(4) if d not in _FREE_DERIVATIVES[beam.supports[0]]]
    ends = _FREE_DERIVATIVES[beam.supports[1]]
    if beam.rigid_motions and abs(kappa) < _NO_INERTIA:
        raise InputError(
            f"frequency_hz: at |k| L = {abs(k) * beam.length:.3g} a beam that no support holds moves beyond floating "
            "point, give a higher frequency_hz or other supports"
        )
    matrix = np.array([[_krylov(kappa, d, q, np.ones(1))[0] for d in unknown] for q in ends])
    right = [-sum(f * _krylov(kappa, 3, q, np.array([1.0 - xi]))[0] for xi, f in sources) for q in ends]
    amplitudes = np.linalg.solve(matrix, right)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        z = np.minimum(x / beam.length, 1.0)
        field = sum(c * _krylov(kappa, d, derivative, z) for d, c in zip(unknown, amplitudes, strict=True))
        for xi, f in sources:
            field = field + f * np.where(z >= xi, _krylov(kappa, 3, derivative, np.maximum(z - xi, 0.0)), 0.0)
        return np.asarray(field / beam.length**derivative)

    return shapes


def _krylov(kappa: complex, d: int, derivative: int, z: Array) -> ComplexArray:
    """A derivative of u_d = sum over j of kappa^j z^(4j + d) / (4j + d)!, for |kappa| and z up to 1, (len(z),)."""
    turns, left = divmod(d - derivative, 4)  # a turn past the constant brings kappa back
    terms = [kappa ** (j - turns) * z ** (4 * j + left) / factorial(4 * j + left) for j in range(6)]
    return np.asarray(sum(terms), dtype=complex)


def spliced_shapes(beam: Beam, forces: Sequence[PointForce], k: Any) -> Callable[[Array, int], ComplexArray]:
    """Four exponentials on every span between forces, each decaying from the end it starts at, spliced.

    Deflection, slope and moment go on over a force; EI (1 + i eta) times the third derivative jumps by it. Of many
    wavenumbers in a column, (n, 1): (x, derivative) -> (n, len(x)).
    """
    each = np.asarray(k)[:, 0] if np.ndim(k) else np.asarray(k)
    inner = sorted({f.position for f in forces if 0.0 < f.position < beam.length})
    ends = np.array([0.0, *inner, beam.length])
    stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
    jumps = {
        p: sum(phasor(f) for f in forces if f.position == p) / stiffness / each**3 for p in (0.0, *inner, beam.length)
    }
    rows = _end_rows(beam, k, ends, jumps)
    for span, at in enumerate(inner):
        for derivative in range(4):
            here = {j: _exponentials(k, ends, span + j, np.array([at]), derivative)[..., 0] for j in (0, 1)}
            rows.append(({span: -here[0], span + 1: here[1]}, derivative, jumps[at] if derivative == 3 else 0.0))
    matrix = np.zeros((*each.shape, len(rows), len(rows)), dtype=complex)
    right = np.zeros((*each.shape, len(rows), 1), dtype=complex)
    for row, (blocks, derivative, value) in enumerate(rows):
        for span, block in blocks.items():
            matrix[..., row, 4 * span : 4 * span + 4] = np.moveaxis(block, 0, -1) / each[..., None] ** derivative
        right[..., row, 0] = value
    amplitudes = np.linalg.solve(matrix, right).reshape(*each.shape, -1, 1, 4)

    def shapes(x: Array, derivative: int) -> ComplexArray:
        span = np.clip(np.searchsorted(ends, x, side="right") - 1, 0, len(ends) - 2)
        field = np.zeros((*each.shape, len(x)), dtype=complex)
        for j in np.unique(span):
            parts = np.moveaxis(_exponentials(k, ends, int(j), x[span == j], derivative), 0, -2)
            field[..., span == j] = (amplitudes[..., j, :, :] @ parts)[..., 0, :]
        return field

    return shapes


Row = tuple[dict[int, ComplexArray], int, Any]


def _end_rows(beam: Beam, k: Any, ends: Array, jumps: dict[float, Any]) -> list[Row]:
    """The conditions at both ends: (exponentials by span, derivative, value). A force at a free end is its shear."""
    rows: list[Row] = []
    for at, span, support, sign in (
        (0.0, 0, beam.supports[0], 1.0),
        (beam.length, len(ends) - 2, beam.supports[1], -1.0),
    ):
        for derivative in _FREE_DERIVATIVES[support]:
            block = _exponentials(k, ends, span, np.array([at]), derivative)[..., 0]
            rows.append(({span: block}, derivative, sign * jumps[at] if derivative == 3 else 0.0))
    return rows


def _exponentials(k: Any, ends: Array, span: int, x: Array, derivative: int) -> ComplexArray:
    """e^{-ik}, e^{-k} from the left end of a span and from its right end, or a derivative, (4, [n,] len(x))."""
    ahead, back = x - ends[span], ends[span + 1] - x
    rows = [(-q) ** derivative * np.exp(-q * ahead) for q in (1j * k, k)]
    rows += [q**derivative * np.exp(-q * back) for q in (1j * k, k)]
    return np.array(rows)


@as_typed
def unit_responses(
    beam: Beam, positions: Numbers, frequencies_hz: Numbers, x: Numbers, theory: str = "euler-bernoulli"
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)) complex, m/N.

    NaN at the frequencies of undamped resonances. Raises InputError.
    """
    check_word("theory", theory, THEORIES)
    positions, frequencies_hz, x = unit_drives(beam, positions, frequencies_hz, x)
    responses = np.full((len(frequencies_hz), len(positions), len(x)), np.nan, dtype=complex)
    if not responses.size:
        return responses
    if theory != "euler-bernoulli" or not beam.uniform:
        from verify.exact.driven import general_responses

        for i, frequency in enumerate(frequencies_hz):
            with suppress(ResonanceError):
                responses[i] = general_responses(beam, positions.tolist(), float(frequency), x, theory)
        return responses
    forces = [PointForce(position=float(position)) for position in positions]
    steady = np.full(len(frequencies_hz), True)
    steady[resonant(beam, frequencies_hz)] = False
    for j, force in enumerate(forces):
        responses[steady, j] = uniform_shapes(beam, [force], frequencies_hz[steady])(x, 0)
    return responses
