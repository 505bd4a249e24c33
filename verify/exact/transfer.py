"""The motion of any beam along its length by multiple shooting, at one frequency or many.

A beam is divided into pieces of at most three wavenumbers, in which nothing grows much. Deflection, rotation, moment
and transverse force at all ends of pieces follow together from one banded system: the transfer over each piece, the
attachments at stations, and the supports (Ascher, Mattheij and Russell, Numerical Solution of Boundary Value Problems,
1988, section 4.3). In between, every quantity y of a piece has y'''' = S y'' - P y, hence its Taylor series.
Lengths, forces and frequencies are relative, as in `layout`; a case is one frequency.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError
from verify.exact.layout import HELD, SAME_PLACE, BeamLayout

ROTATION = 1  # Index of the rotation in the state (w, psi, M, V)
_REACH, _TERMS = 3.0, 32
"""Largest wavenumber times length of a piece (e^3 costs one digit), and number of terms of its Taylor series."""
_MOST_PIECES = 300_000  # Largest number of pieces of one solution, 1.5 kB each
_LOWER, _UPPER = 5, 3  # Number of diagonals of the banded system below and above the main one
_TRIES = 3  # Number of excitations per mode, one of which is far from orthogonal to the mode
_PAIR = 1e-9  # Relative distance of two frequencies that coincide
_NUDGE = 7e-16  # Relative step off a resonance at which the system is exactly singular


class Division(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A layout divided into pieces at each of n_cases frequencies; pieces and ends are numbered through all cases."""

    layout: BeamLayout
    omega2: Array  # (n_cases,), over EI / (rho A L^4)
    counts: Indices  # (n_cases, n_spans), pieces of each span
    rates: Any  # (n_cases * n_spans, 4, 4), d/dt of (w, psi, M, V), each relative to `sizes`; t is 0 to 1 over a piece
    sums: Any  # (n_cases * n_spans,), S; real without losses, as are all following arrays
    products: Any  # (n_cases * n_spans,), P
    over: Any  # (n_ends, 4, 4), transfer of the state over attachments
    sizes: Array  # (n_cases, 4), units of the state: 1, k, k^2, k^3
    span: Indices  # (n_pieces,), index of the rate of each piece
    left: Indices  # (n_pieces,), left end of each piece
    begins: Array  # (n_pieces,), x / L of that end
    lengths: Array  # (n_pieces,), relative to L
    station_ends: Indices  # (n_cases, n_stations), the end at each station


def divide(layout: BeamLayout, omega2: Array, loss_factor: float = 0.0) -> Division:
    """Divide a beam at omega^2 (n_cases,); the loss factor acts on EI and kappa G A alone. Raises InputError."""
    lossy = 1.0 + 1j * loss_factor if loss_factor else 1.0
    length, stiffness, mass, compliance, rotary = np.array(layout.spans).T
    w2 = omega2[:, None]
    bend, shear = 1.0 / (stiffness * lossy), compliance / lossy
    p, q = layout.tension - rotary * w2, mass * w2 - layout.foundation
    sums, products = p * bend - shear * q, -q * bend * (1.0 + p * shear)
    counts = np.ceil(np.sqrt(abs(sums) + np.sqrt(abs(products))) * length / _REACH).clip(1.0)
    if counts.sum() > _MOST_PIECES:
        raise InputError(
            f"frequency: the waves of this beam need {counts.sum():.0f} pieces, more than {_MOST_PIECES}: lower "
            "frequency_hz or mode, or change beam.tension or beam.foundation, which shorten the waves"
        )
    counts = counts.astype(int)
    sizes = (np.maximum(omega2, 1.0) ** 0.25)[:, None] ** np.arange(4)
    scale = sizes[:, None, :] / sizes[:, :, None]
    rates = np.zeros((len(omega2), len(length), 4, 4), dtype=sums.dtype)
    entries = {(0, 1): 1.0, (0, 3): -shear, (1, 2): bend, (2, 1): p, (2, 3): 1.0, (3, 0): q}
    pieces = length / counts
    for (i, j), entry in entries.items():
        rates[:, :, i, j] = entry * scale[:, None, i, j] * pieces
    n_pieces = int(counts.sum())
    span = np.repeat(np.arange(counts.size), counts.ravel())
    first = np.cumsum(counts.ravel()) - counts.ravel()
    within = np.arange(n_pieces) - first[span]
    lengths = pieces.ravel()[span]
    case = span // len(length)
    bounds = np.concatenate([np.zeros((len(omega2), 1), dtype=int), np.cumsum(counts, axis=1)], axis=1)
    offsets = np.cumsum(bounds[:, -1] + 1) - bounds[:, -1] - 1
    station_ends = offsets[:, None] + bounds
    dashed = any(station.dashpot or station.rotational_dashpot for station in layout.stations)
    over = np.tile(np.eye(4, dtype=complex if dashed else float), (n_pieces + len(omega2), 1, 1))
    rate: Any = 1j * np.sqrt(omega2) if dashed else 0.0
    for i, station in enumerate(layout.stations):
        along = station.stiffness - omega2 * station.mass + rate * station.dashpot
        around = station.rotational - omega2 * station.inertia + rate * station.rotational_dashpot
        over[station_ends[:, i], 3, 0] -= along * scale[:, 3, 0]
        over[station_ends[:, i], 2, 1] += around * scale[:, 2, 1]
    return Division(
        layout=layout,
        omega2=omega2,
        counts=counts,
        rates=rates.reshape(-1, 4, 4),
        sums=(sums * pieces**2).ravel(),
        products=(products * pieces**4).ravel(),
        over=over,
        sizes=sizes,
        span=span,
        left=np.arange(n_pieces) + case,
        begins=np.array(layout.positions)[span % len(length)] + within * lengths,
        lengths=lengths,
        station_ends=station_ends,
    )


def _taylor(starts: Any, sums: Any, products: Any, derivative: int = 0) -> Iterator[Any]:
    """Taylor coefficients in t of a derivative of y, from y, y', y'', y''' at t = 0, (4, ...)."""
    values, factorial = list(starts), 1.0
    for n in range(derivative + _TERMS):
        if n >= derivative:
            factorial *= max(n - derivative, 1)
            yield values[0] / factorial
        values = [*values[1:], sums * values[2] - products * values[0]]


def _starts(division: Division, states: Any, of: int = 0) -> Any:
    """(4, n_pieces, k), an entry of the state and its derivatives by t at the left end of each piece."""
    rates, here, starts = division.rates[division.span], states[division.left], []
    for _ in range(4):
        starts.append(here[:, of])
        here = rates @ here
    return np.array(starts)


def solve(division: Division, jumps: Any, imposed: Sequence[tuple[int, complex]] = ()) -> tuple[Any, Any]:
    """(states right of each end, (n_ends, 4, k), and transverse forces (n_cases, n_imposed, k)).

    jumps: jumps of the state at each end, (n_ends, 4, k). imposed: (station, deflection) pairs; the force there is the
    unknown of its end in place of the deflection. Raises LinAlgError for a singular system.
    """
    from scipy.linalg.lapack import get_lapack_funcs

    layout, left = division.layout, division.left
    # e^A is the sum of c_j A^j, j < 4, with the solutions c_j of c'''' = S c'' - P c of unit derivatives at 0
    shares: Any = sum(_taylor(np.eye(4)[:, :, None], division.sums, division.products))
    power, transfer = np.eye(4), shares[0, :, None, None] * np.eye(4)
    for share in shares[1:]:
        power = power @ division.rates
        transfer = transfer + share[:, None, None] * power
    held = np.array([division.station_ends[:, station] for station, _ in imposed], dtype=int).reshape(-1)
    over = division.over
    jumps = np.array(jumps, dtype=np.result_type(jumps, over, transfer, complex if imposed else float))
    prescribed = np.zeros_like(jumps)
    if imposed:
        over = over.copy()
        prescribed[held, 0] = np.repeat([value for _, value in imposed], len(division.omega2))[:, None]
        jumps += over @ prescribed
        over[held, :, 0] = [0.0, 0.0, 0.0, 1.0]
    n_ends = len(over)
    carry = -transfer[division.span] @ over[left]
    matrix = np.zeros((2 * _LOWER + _UPPER + 1, 4 * n_ends), dtype=carry.dtype, order="F")
    middle = _LOWER + _UPPER
    for i in range(4):
        for j in range(4):
            matrix[middle + 2 + i - j, 4 * left + j] = carry[:, i, j]
        matrix[middle - 2, 4 * left + 4 + i] = 1.0
    matrix[middle - 2, 4 * held] = 0.0
    right = np.zeros((4 * n_ends, jumps.shape[2]), dtype=jumps.dtype)
    rows = 4 * left[:, None] + 2 + np.arange(4)
    right[rows] = transfer[division.span] @ jumps[left] - prescribed[left + 1]
    starts, ends = division.station_ends[:, 0], division.station_ends[:, -1]
    for row, (at_left, at_right) in enumerate(zip(*(HELD[support] for support in layout.supports), strict=True)):
        matrix[middle + row - at_left, 4 * starts + at_left] = 1.0
        for j in range(4):
            matrix[middle + 2 + row - j, 4 * ends + j] = over[ends, at_right, j]
        right[4 * ends + 2 + row] = -jumps[ends, at_right]
    real = not np.iscomplexobj(matrix)
    if real and np.iscomplexobj(right):  # real and imaginary parts side by side
        right = right.view(float)
    (gbsv,) = get_lapack_funcs(("gbsv",), (matrix, right))
    *_, states, info = gbsv(_LOWER, _UPPER, matrix, right, overwrite_ab=True, overwrite_b=True)
    if info or not np.isfinite(states).all():
        raise np.linalg.LinAlgError("singular")
    states = np.ascontiguousarray(states)
    if real and np.iscomplexobj(jumps):
        states = states.view(complex)
    states = states.reshape(n_ends, 4, -1)
    forces = states[held, 0].reshape(len(imposed), len(division.omega2), states.shape[2]).swapaxes(0, 1)
    return over @ states + jumps, forces * division.sizes[:, 3, None, None]


class Motion(msgspec.Struct, frozen=True, eq=False):
    """Motions of a divided beam, k at each frequency."""

    division: Division
    states: Any
    """(n_ends, 4, k), right of each end."""

    def read(self, xi: Array, derivative: int, of: int = 0) -> Any:
        """Derivative by x / L at xi (n_x,), (n_cases, k, n_x), right-continuous at jumps.

        `of` = 0: deflection; 1: rotation.
        """
        division = self.division
        ends = np.cumsum(division.counts.sum(axis=1))
        begins = np.split(division.begins, ends[:-1])
        piece = np.array([begin.searchsorted(xi + SAME_PLACE, side="right") for begin in begins]).clip(1) - 1
        piece += (ends - division.counts.sum(axis=1))[:, None]
        t = ((xi - division.begins[piece]) / division.lengths[piece])[:, :, None]
        used = np.zeros(len(division.begins), dtype=bool)
        used[piece] = True
        piece = (np.cumsum(used) - 1)[piece]
        some = msgspec.structs.replace(division, span=division.span[used], left=division.left[used])
        sums, products = (values[some.span][:, None] for values in (division.sums, division.products))
        total: Any = 0.0
        for coefficients in reversed(list(_taylor(_starts(some, self.states, of), sums, products, derivative))):
            total = total * t + coefficients[piece]
        total = total / division.lengths[used][piece][:, :, None] ** derivative
        return (total * division.sizes[:, of, None, None]).swapaxes(1, 2)


def modal_motion(layout: BeamLayout, betas: Array, numbers: Indices) -> Motion:
    """Free motions of consecutive modes, of modal mass 1 over rho A L, positive next to the left end.

    numbers: mode numbers, (n,). betas: beta L of these, of the mode before and the mode after, (n + 2,).

    Inverse iteration: the largest response to a few arbitrary excitations at resonance, then the response to forces and
    couples in proportion to that motion, which excite no other mode. The second of two modes of equal frequency is
    made orthogonal to the first.
    """
    close = np.diff(betas) < _PAIR * betas[1:]
    paired, betas = close[:-1], betas[1:-1]
    alone = ~(close[:-1] | close[1:])
    n_columns = _TRIES * (2 if paired.any() else 1)
    for step in range(12):
        division = divide(layout, betas**4 * (1.0 + step * _NUDGE))
        starts = division.station_ends[:, 0]
        case = np.repeat(np.arange(len(betas)), np.diff(np.append(starts, len(division.over))))
        index = 4.0 * (np.arange(len(case)) - starts[case])[:, None, None] + np.arange(4)[:, None]
        columns = np.arange(n_columns)
        phases = index * (1.0 + 0.37 * (numbers[case][:, None, None] - columns // _TRIES) + 0.11 * (columns % _TRIES))
        try:
            largest = []  # largest response of each mode, scaled to a largest entry of 1
            for some in np.split(solve(division, np.cos(phases))[0], n_columns // _TRIES, axis=2):
                peaks = np.maximum.reduceat(abs(some).max(axis=1), starts, axis=0)
                best = some[np.arange(len(case)), :, peaks.argmax(axis=1)[case]]
                largest.append(best / peaks.max(axis=1)[case, None])
            states = np.stack(largest, axis=2)
            jumps = np.zeros_like(states)
            jumps[:, 3], jumps[:, 2] = states[:, 0], -states[:, 1]
            states = np.where(alone[case, None, None], solve(division, jumps)[0], states)
            break
        except np.linalg.LinAlgError:
            if step == 11:
                raise InputError("mode: rounding does not separate its frequency from that of its neighbour") from None
    states, other = states[:, :, :1], states[:, :, 1:]
    if paired.any():
        share = paired * _modal_mass(division, states, other) / _modal_mass(division, other, other)
        states = states - other * share[case, None, None]
    states = states / np.sqrt(_modal_mass(division, states, states))[case, None, None]
    near = Motion(division, states).read(1e-3 / numbers, 0)[np.arange(len(betas)), 0, np.arange(len(betas))]
    signs = np.ones(len(betas))
    for i, (value, at_ends) in enumerate(zip(near, np.split(states[:, 0, 0], starts[1:]), strict=True)):
        deflections = np.append(value, at_ends)
        signs[i] = np.sign(deflections[abs(deflections) > 1e-9 * abs(deflections).max()][0])
    return Motion(division, states * signs[case, None, None])


def _modal_mass(division: Division, first_states: Any, second_states: Any) -> Array:
    """Modal mass product of two motions in each case, (n_cases,), over rho A L, with attachments."""
    points, weights = np.polynomial.legendre.leggauss(12)
    powers = np.vander(0.5 * (points + 1.0), _TERMS, increasing=True)
    sums, products = (values[division.span][:, None] for values in (division.sums, division.products))
    layout, first = division.layout, np.cumsum(division.counts.sum(axis=1)) - division.counts.sum(axis=1)
    masses, rotaries = (np.array(layout.spans)[:, i] for i in (2, 4))
    total: Any = 0.0
    for of, densities, factor in ((0, masses, 1.0), (ROTATION, rotaries, division.sizes[:, 1] ** 2)):
        if densities.any():
            values = [
                powers @ np.array(list(_taylor(_starts(division, states, of), sums, products)))[:, :, 0]
                for states in (first_states, second_states)
            ]
            on_pieces = 0.5 * weights @ (values[0] * values[1]) * division.lengths
            on_pieces *= densities[division.span % len(densities)]
            total = total + np.add.reduceat(on_pieces, first) * factor
        for i, station in enumerate(layout.stations):
            body = station.inertia if of else station.mass
            if body:
                at = division.station_ends[:, i]
                total = total + body * factor * first_states[at, of, 0] * second_states[at, of, 0]
    return np.asarray(total)
