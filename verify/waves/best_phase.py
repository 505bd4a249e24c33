"""Phases between two drives of fixed amplitudes, in closed form, at many frequencies at once.

Two drives a phase phi apart, z = e^{i phi}, make waves A+ = a + b z and A- = c + d z. Their squares are first
harmonics of phi, |a + b z|^2 = |a|^2 + |b|^2 + 2 Re(conj(a) b z). So is |A+|^2 - l^2 |A-|^2, zero at a reflection l;
and N' D - N D' of two of them, zero where their ratio is stationary. The crest speed goes as D / sqrt(S) with
D, S = |A+|^2 -+ |A-|^2, stationary where 2 D' S = D S', a quartic in z.
"""

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray

_LEAST_LEAD = 1e-8
"""Least leading coefficient of the quartic relative to its largest. It moves a root by as much as rounding of so
lopsided a companion matrix does; a stationary value changes by the square, 1e-16."""


class FirstHarmonic(msgspec.Struct, frozen=True, eq=False):
    """mean + Re(first z) over z = e^{i phi}, of n at once."""

    mean: Array
    """(n,)."""
    first: ComplexArray
    """(n,)."""

    def at(self, phase: float) -> Array:
        """Its values at one phase (rad), (n,)."""
        return np.asarray(self.mean + (self.first * np.exp(1j * phase)).real)

    def less(self, factor: float, other: "FirstHarmonic") -> "FirstHarmonic":
        """The difference from `factor` times another."""
        return FirstHarmonic(self.mean - factor * other.mean, self.first - factor * other.first)

    def zeros(self) -> Array:
        """Both phases at which it is zero, (n, 2) rad; where it has no zero, that of its least size twice."""
        size = np.abs(self.first)
        cosine = np.clip(-self.mean / np.where(size > 0.0, size, 1.0), -1.0, 1.0)
        return np.asarray(np.arccos(cosine)[:, None] * [1.0, -1.0] - np.angle(self.first)[:, None])

    def stationary_ratio(self, other: "FirstHarmonic") -> Array:
        """Both phases at which its ratio to another is stationary, (n, 2) rad."""
        mean = (np.conj(self.first) * other.first).imag
        return FirstHarmonic(mean, 1j * (other.mean * self.first - self.mean * other.first)).zeros()


def squared(still: ComplexArray, turning: ComplexArray) -> FirstHarmonic:
    """|still + turning z|^2 of amplitudes (n,)."""
    return FirstHarmonic(abs(still) ** 2 + abs(turning) ** 2, 2.0 * np.conj(still) * turning)


def stationary_speed(difference: FirstHarmonic, total: FirstHarmonic) -> Array:
    """Phases among which D / sqrt(S) is stationary, (n, 4) rad: roots of 2 D' S - D S' with D = d0 + Re(d1 z)."""
    d0, d1, s0, s1 = difference.mean, difference.first, total.mean, total.first
    second, first, middle = 0.25j * d1 * s1, 1j * (d1 * s0 - 0.5 * s1 * d0), 1.5 * (1j * d1 * np.conj(s1)).real
    rows = np.stack([second, first, middle, np.conj(first), np.conj(second)], axis=1)
    least = _LEAST_LEAD * abs(rows).max(axis=1)
    lead = np.where(abs(second) > least, second, np.where(least > 0.0, least, 1.0))
    companion = np.zeros((len(rows), 4, 4), dtype=complex)
    companion[:, 0] = -rows[:, 1:] / lead[:, None]
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    return np.asarray(np.angle(np.linalg.eigvals(companion)))


def fastest_candidates(forward: ComplexArray, backward: ComplexArray, limit: float, ends: tuple[float, float]) -> Array:
    """Phases among which the fastest crests are with a reflection up to `limit`, (n, 10) rad between both `ends`.

    forward, backward (n, 2): the amplitudes of either wave under the first and the second drive.
    """
    size = np.maximum(abs(forward).max(axis=1), abs(backward).max(axis=1))[:, None]
    waves = (wave / np.where(size > 0.0, size, 1.0) for wave in (forward, backward))
    plus, minus = (squared(wave[:, 0], wave[:, 1]) for wave in waves)
    phases = np.concatenate(
        [
            minus.less(limit**2, plus).zeros(),
            plus.less(limit**2, minus).zeros(),
            stationary_speed(plus.less(1.0, minus), plus.less(-1.0, minus)),
        ],
        axis=1,
    )
    middle = 0.5 * sum(ends)
    phases = np.clip(middle + np.remainder(phases - middle + np.pi, 2.0 * np.pi) - np.pi, *ends)
    return np.concatenate([phases, np.broadcast_to(ends, (len(phases), 2))], axis=1)
