"""Frequencies and damping ratios of a record of free vibration, with 95 % intervals.

y_c(t) = sum_m e^{-zeta_m w_m t} (a_cm cos d_m t + b_cm sin d_m t) + offset_c + drift_c t, with d^2 = w^2 (1 - zeta^2),
for all channels c at once. The matrix pencil (Y. Hua and T. K. Sarkar, IEEE Trans. ASSP 38 (1990) 814) starts a least
squares fit over all samples; modes are added while they lower Schwarz's criterion n ln(sum of squares) + p ln(n).
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import hypot, log, pi, sqrt

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.identify.fit import COLOURED, Fit, Model, Parameter, fit
from verify.validation import check_integer

MOST_MODES = 8  # Modes that are looked for; a record of a beam rarely has more above its noise
PENCIL = 600  # Samples of the start, thinned from the record: its Hankel matrix costs their cube
MANY = 3000  # Samples by which modes of a record of more than twice as many are counted before all are used
EVEN = 1e-3  # Largest deviation of a time from even spacing, over the spacing, that the start ignores
GAIN = 10.0  # Least fall of Schwarz's criterion by a mode: odds of 150 to 1
FEWEST = 16  # Samples of the shortest record
GROWTH = 100.0  # Exponent of a growth that the least squares may try: e^100 squared is still a number
GRAIN = 1e-8  # Amplitude of a mode over the largest of its channel, below which it is one of rounding
EXPECTED, SHIFT, LOOSE = 0.03, 3e-4, 0.01
"""Relative distance of an expected frequency; of a tone from the sum of its poles, beyond the intervals and at most."""
RELEASE, SWING, CLEARER, QUIET, BRIEF = 0.9, 0.3, 0.5, 1e-3, 0.2
"""Deflection of a beam that is released, over the largest before it swings back by SWING of the largest of all; noise
without what is before, over that of all; noise over the range that no load leaves; damping ratio of modes that may be
fitted to a load."""


@dataclass(frozen=True)
class RingMode:
    """A mode of a record; intervals contain the true value with a probability of 95 % if the noise is white."""

    hz: float  # Damped frequency, as it is counted in the record
    hz_interval: tuple[float, float]
    zeta: float  # Damping ratio; negative where the record grows
    zeta_interval: tuple[float, float]
    amplitude: tuple[float, ...]  # At the first sample, of every channel, in its unit; 0 of a constant one

    @property
    def halves(self) -> tuple[float, float]:
        """Half widths of the intervals of frequency, Hz, and damping ratio."""
        (f, g), (low, high) = self.hz_interval, self.zeta_interval
        return 0.5 * (g - f), 0.5 * (high - low)

    @property
    def undamped_hz(self) -> float:
        """Frequency without damping."""
        return self.hz / float(np.sqrt(1.0 - self.zeta**2))

    @property
    def pole(self) -> complex:
        """Of e^{2 pi pole t}, Hz."""
        return complex(-self.zeta * self.undamped_hz, self.hz)


@dataclass(frozen=True)
class RingDown:
    """Modes of a record by frequency, and whether the residuals are white.

    `noise`: sd in the unit of the signal; of several over their ranges, times the largest range.
    """

    modes: tuple[RingMode, ...]
    noise: float
    white: bool
    start: float = 0.0  # Time of the first sample that the fit uses, s
    rate: float = np.inf  # Mean number of samples a second

    @property
    def hertz(self) -> Array:
        """Damped frequencies, (m,), Hz."""
        return np.array([mode.hz for mode in self.modes])

    def tones(self, expected: Sequence[float]) -> list[RingMode]:
        """Harmonics and combination tones of a nonlinear vibration: poles that two or three of stronger modes sum to.

        `expected` frequencies, Hz, by the factor of the strongest mode, are none: those of pinned beams are sums, too.
        """
        found, poles = list[RingMode](), list[complex]()
        strong = sorted(self.modes, key=lambda mode: -max(mode.amplitude))
        factor = min((strong[0].hz / hz for hz in expected), key=lambda ratio: abs(log(ratio)), default=1.0)
        for mode in strong:
            near = min(3.0 * (hypot(mode.halves[0], mode.halves[1] * mode.hz) + SHIFT * mode.hz), LOOSE * mode.hz)
            sums = (sum(some) for n in (2, 3) for some in combinations_with_replacement(poles, n))
            known = any(abs(mode.hz / (factor * hz) - 1.0) < EXPECTED for hz in expected)
            if not known and any(abs(mode.pole - one) < near for one in sums):
                found.append(mode)
            else:
                poles += mode.pole, mode.pole.conjugate()
        return found


def ring_down(times: Sequence[float] | Array, signals: Sequence[float] | Array, n_modes: int | None = None) -> RingDown:
    """Modes of a free vibration sampled at `times` (n,), s, in `signals` (n,) or (n, channels).

    `n_modes`: default those that the record tells from its noise. Raises InputError for fewer than 16 samples, times
    that do not ascend, values that are not finite, and a record in which nothing rings. Rest or the rise of a load
    before the vibration is left out where the residuals show it.
    """
    t, y = np.asarray(times, dtype=float), np.asarray(signals, dtype=float)
    y = y.reshape(len(y), -1)
    if len(t) < FEWEST or len(t) != len(y):
        raise InputError(f"record: {len(t)} times and {len(y)} rows of signals, give {FEWEST} or more of both")
    if not (np.isfinite(t).all() and np.isfinite(y).all() and (np.diff(t) > 0.0).all()):
        raise InputError("record: give finite values at ascending times")
    if n_modes is not None:
        check_integer("n_modes", n_modes, 1, MOST_MODES)
    if not np.ptp(y, axis=0).any():
        raise InputError("record: its signals are constant, nothing rings")
    whole: RingDown | InputError
    try:
        whole = _ring(t, y, n_modes)
        quiet = whole.white or whole.noise < QUIET * float(np.ptp(y, axis=0).max())
        if quiet and not _fits_a_load(whole):
            return whole
    except InputError as error:
        whole = error
    if FEWEST <= len(t) - (first := _release(y)) < len(t):
        with suppress(InputError):
            later = _ring(t[first:], y[first:], n_modes)
            if isinstance(whole, InputError):
                return later
            clearer = later.white or later.noise < CLEARER * whole.noise
            if later.noise < whole.noise and _fits_a_load(whole) and not _fits_a_load(later):
                return later
            if clearer and (not whole.white or len(later.modes) < len(whole.modes)):
                return later
    if isinstance(whole, InputError):
        raise whole
    return whole


def _fits_a_load(ring: RingDown) -> bool:
    """Whether a mode decays at once, as one fitted to a hold or a rise of a load does."""
    return any(abs(mode.zeta) >= BRIEF for mode in ring.modes)


def _release(y: Array) -> int:
    """The last sample of signals (n, channels) near the peak of the first excursion to one side of the end's mean."""
    away = (y - y[-max(len(y) // 4, 1) :].mean(axis=0)) / np.maximum(np.ptp(y, axis=0), 1e-300)
    size = away[:, np.unravel_index(abs(away).argmax(), away.shape)[1]]
    swings = np.sign(size) * (abs(size) > SWING * abs(size).max())
    first = swings[np.flatnonzero(swings)[0]]
    back = np.flatnonzero(swings == -first)
    lobe = first * size[: back[0] if len(back) else len(size)]
    return int(np.flatnonzero(lobe >= RELEASE * lobe.max())[-1])


def _ring(t: Array, y: Array, n_modes: int | None) -> RingDown:
    """Modes of signals (n, channels). Raises InputError where nothing rings."""
    scale = np.ptp(y, axis=0)
    if not scale.any():
        raise InputError("record: its signals are constant, nothing rings")
    y, moving = y[:, scale > 0.0] / scale[scale > 0.0], np.flatnonzero(scale)
    origin = t[0]
    poles = _strongest(t - origin, y, _pencil(t - origin, y))
    orders = range(n_modes or 1, (n_modes or min(MOST_MODES, len(t) // 8)) + 1)
    if not n_modes and len(t) > 2 * MANY:
        some = np.sort(np.random.default_rng(63).permutation(len(t))[:MANY])
        if early := _order(t[some] - origin, y[some], poles, orders):
            orders = range(min(early[0], orders.stop - 2), orders.stop)
    if (best := _order(t - origin, y, poles, orders)) is None:
        raise InputError("record: no frequency rings in it above its noise, give a longer one or more samples")
    count, fitted = best
    sizes = np.zeros((count, len(scale)))
    value = {name: one.value for name, one in fitted.estimates.items()}
    for c, channel in enumerate(moving.tolist()):
        sizes[:, channel] = [
            scale[channel] * hypot(value[f"c{c},{i}"], value[f"c{c},{count + i}"]) for i in range(count)
        ]
    modes = _modes(fitted, float(t[-1] - origin), sizes)
    rate, white = (len(t) - 1) / float(t[-1] - origin), COLOURED not in fitted.rejected
    return RingDown(modes, fitted.noise * float(scale.max()), white, float(origin), rate)


def _order(t: Array, y: Array, poles: ComplexArray, orders: range) -> tuple[int, Fit] | None:
    """(number of modes, fit) by Schwarz's criterion among `orders`, of one order without it; None where none is better.

    Raises InputError where the fit of one order does not converge.
    """
    line = np.polynomial.polynomial.polyval(t, np.polynomial.polynomial.polyfit(t, y, 1)).T
    best, least = None, y.size * log(max(float(((y - line) ** 2).sum()), 1e-300))
    for m in (order for order in orders if order <= len(poles)):
        try:
            fitted = _fit(t, y, poles[:m])
        except InputError:  # of too few modes the least squares may wander
            if len(orders) == 1:
                raise
            continue
        size = y.size * log(max(float((fitted.residuals**2).sum()), 1e-300)) + (2 + 2 * y.shape[1]) * m * log(y.size)
        if size > least - GAIN and len(orders) > 1:
            break
        best, least = (m, fitted), size
    return best


def _pencil(t: Array, y: Array) -> ComplexArray:
    """Candidate poles with positive imaginary part, 1/s: of the thinned record and of its first samples.

    The former resolves slow modes, the latter keep fast ones below half their sampling rate.
    """
    spacing = t[-1] / (len(t) - 1)
    if abs(t - spacing * np.arange(len(t))).max() > EVEN * spacing:
        even = np.linspace(0.0, t[-1], len(t))
        t, y = even, np.stack([np.interp(even, t, channel) for channel in y.T], axis=1)
    line = np.polynomial.polynomial.polyfit(t, y, 1)
    rest = y - np.polynomial.polynomial.polyval(t, line).T
    found, every = list[ComplexArray](), max(len(t) // PENCIL, 1)
    while every:
        part = rest[: every * PENCIL : every]
        columns = len(part) // 3
        hankel = np.concatenate([np.lib.stride_tricks.sliding_window_view(one, columns) for one in part.T])
        _, _, right = np.linalg.svd(hankel, full_matrices=False)
        shape = right[: 2 * MOST_MODES + 2].T  # two more for what is left of offset and drift
        roots = np.linalg.eigvals(np.linalg.lstsq(shape[:-1], shape[1:], rcond=None)[0])
        poles = np.log(roots[(abs(roots) > 0.0) & (roots.imag > 0.0)]) / (spacing * every)
        found.append(poles[(poles.imag * t[-1] > pi) & (abs(poles.real) < 2.0 * abs(poles.imag))])
        every //= 8
    return np.concatenate(found)


def _strongest(t: Array, y: Array, poles: ComplexArray) -> ComplexArray:
    """Candidate poles in the order in which each leaves least of the signals beside those before it.

    At most MOST_MODES, judged at PENCIL samples that are not even, so that no frequency is thinned to another.
    """
    some = np.sort(np.random.default_rng(49).permutation(len(t))[: 2 * PENCIL])
    t, y, chosen = t[some], y[some], list[complex]()
    while len(chosen) < MOST_MODES:
        best = np.inf, 0j
        for pole in poles.tolist():
            if all(abs(pole - other) > 0.5 / t[-1] for other in chosen):
                basis = _basis(t, np.array([*chosen, pole]))
                rest = y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0]
                best = min(best, (float((rest**2).sum()), pole), key=lambda one: one[0])
        if best[0] == np.inf:
            break
        chosen.append(best[1])
    return np.array(chosen)


def _basis(t: Array, poles: ComplexArray) -> Array:
    """Decaying cosines and sines of the poles, 1 and t, (n, 2 m + 2)."""
    powers = np.outer(t, poles)
    waves = np.exp(np.minimum(powers.real, GROWTH) + 1j * powers.imag)
    return np.concatenate([waves.real, waves.imag, np.ones((len(t), 1)), t[:, None] / t[-1]], axis=1)


def _fit(t: Array, y: Array, poles: ComplexArray) -> Fit:
    """Least squares over all samples of every pole p = d (r + i)/t_n, all amplitudes, offsets and drifts."""
    (n, channels), m = y.shape, len(poles)
    weights = np.linalg.lstsq(_basis(t, poles), y, rcond=None)[0]
    known = {f"d{i}": Parameter(float(pole.imag * t[-1])) for i, pole in enumerate(poles)}
    known |= {f"r{i}": Parameter(float(pole.real / pole.imag)) for i, pole in enumerate(poles)}
    places = [(c, k) for c in range(channels) for k in range(2 * m + 2)]
    known |= {f"c{c},{k}": Parameter(float(weights[k, c])) for c, k in places}

    def predict(values: Mapping[str, float]) -> tuple[Array, dict[str, Array]]:
        d, r = (np.array([values[f"{name}{i}"] for i in range(m)]) for name in "dr")
        basis, share = _basis(t, d * (r + 1j) / t[-1]), (t / t[-1])[:, None]
        factors = np.array([values[f"c{c},{k}"] for c, k in places]).reshape(channels, -1).T
        by = {}
        for i in range(m):
            wave, turned = basis[:, [i]], basis[:, [m + i]]
            decay = share * (wave * factors[i] + turned * factors[m + i])
            turn = share * (wave * factors[m + i] - turned * factors[i])
            by[f"d{i}"], by[f"r{i}"] = (r[i] * decay + turn).T.ravel(), d[i] * decay.T.ravel()
        for c, k in places:
            column = np.zeros((channels, n))
            column[c] = basis[:, k]
            by[f"c{c},{k}"] = column.ravel()
        return (basis @ factors).T.ravel(), by

    model = Model(known, predict, t, (("time", "s"), ("signal", "")))
    return fit(model, y.T.ravel(), list(known), profiles=False)


def _modes(fitted: Fit, duration: float, sizes: Array) -> tuple[RingMode, ...]:
    """Modes of a fit above rounding by frequency, with their amplitudes `sizes`, (modes, channels)."""
    modes, loud = [], (sizes > GRAIN * sizes.max(axis=0)).any(axis=1)
    for i, size in ((i, sizes[i].tolist()) for i in np.flatnonzero(loud).tolist()):
        turns, ratio = fitted.estimates[f"d{i}"], fitted.estimates[f"r{i}"]
        hertz, low, high = (edge / (2.0 * pi * duration) for edge in (turns.value, *turns.interval))
        zeta, most, least = (-r / sqrt(1.0 + r * r) for r in (ratio.value, *ratio.interval))
        if hertz < 0.0:  # the conjugate pole
            hertz, low, high, zeta, most, least = -hertz, -high, -low, -zeta, -least, -most
        modes.append(RingMode(hertz, (low, high), zeta, (least, most), tuple(size)))
    return tuple(sorted(modes, key=lambda mode: mode.hz))
