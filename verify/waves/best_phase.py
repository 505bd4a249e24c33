"""The phase between two drives at which crests run fastest, in closed form, at many frequencies at once.

Two drives a phase phi apart, z = e^{i phi}, make waves of amplitudes A+ = a + b z and A- = c + d z. Their squares are
first harmonics of phi, |a + b z|^2 = |a|^2 + |b|^2 + 2 Re(conj(a) b z), so that each thing asked for has a closed form:

- the reflection is at its limit l where |A+|^2 = l^2 |A-|^2 or the reverse: two angles of a first harmonic each;
- the crest speed goes as D / sqrt(S), D = |A+|^2 - |A-|^2, S = |A+|^2 + |A-|^2; it is stationary where
  2 D' S = D S', a second harmonic: four roots of a quartic in z.

The fastest allowed phase of an interval is one of these or an end of it. Each is tried; none is trusted.
"""

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray

TRIED = 10
"""Phases that are tried at each frequency."""
_LEAST_LEAD = 1e-8
"""Of a quartic's largest coefficient: its first is kept above. A root moves by so much and rounding of a companion
matrix so lopsided comes to as much; what is stationary there changes by the square, 1e-16."""


class FirstHarmonic(msgspec.Struct, frozen=True, eq=False):
    """mean + Re(turn z) over z = e^{i phi}, of many at once."""

    mean: Array
    """(n,)."""
    turn: ComplexArray
    """(n,)."""

    def less(self, factor: float, other: "FirstHarmonic") -> "FirstHarmonic":
        """It less so many times the other."""
        return FirstHarmonic(self.mean - factor * other.mean, self.turn - factor * other.turn)

    def zeros(self) -> Array:
        """Both phases at which it is zero, (n, 2) radians; that at which it comes nearest where it is zero nowhere."""
        size = np.abs(self.turn)
        cosine = np.clip(-self.mean / np.where(size > 0.0, size, 1.0), -1.0, 1.0)
        return np.asarray(np.arccos(cosine)[:, None] * [1.0, -1.0] - np.angle(self.turn)[:, None])


def squared(still: ComplexArray, turning: ComplexArray) -> FirstHarmonic:
    """|still + turning z|^2 of amplitudes (n,)."""
    return FirstHarmonic(abs(still) ** 2 + abs(turning) ** 2, 2.0 * np.conj(still) * turning)


def stationary(difference: FirstHarmonic, total: FirstHarmonic) -> Array:
    """Phases among which D / sqrt(S) is stationary, (n, 4) radians.

    2 D' S - D S' with D = d0 + Re(d1 z), D' = Re(i d1 z) is real on |z| = 1; times z^2 it is a quartic in z.
    """
    d0, d1, s0, s1 = difference.mean, difference.turn, total.mean, total.turn
    second, first, middle = 0.25j * d1 * s1, 1j * (d1 * s0 - 0.5 * s1 * d0), 1.5 * (1j * d1 * np.conj(s1)).real
    rows = np.stack([second, first, middle, np.conj(first), np.conj(second)], axis=1)
    least = _LEAST_LEAD * abs(rows).max(axis=1)
    lead = np.where(abs(second) > least, second, np.where(least > 0.0, least, 1.0))
    companion = np.zeros((len(rows), 4, 4), dtype=complex)
    companion[:, 0] = -rows[:, 1:] / lead[:, None]
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    return np.asarray(np.angle(np.linalg.eigvals(companion)))


def phases_to_try(forward: ComplexArray, backward: ComplexArray, limit: float, ends: tuple[float, float]) -> Array:
    """Phases among which the fastest crests are that keep the limit, (n, TRIED) radians between both `ends`.

    forward, backward (n, 2): what the first and the second drive give of either wave.
    """
    size = np.maximum(abs(forward).max(axis=1), abs(backward).max(axis=1))[:, None]
    waves = (wave / np.where(size > 0.0, size, 1.0) for wave in (forward, backward))
    plus, minus = (squared(wave[:, 0], wave[:, 1]) for wave in waves)
    found = np.concatenate(
        [
            minus.less(limit**2, plus).zeros(),
            plus.less(limit**2, minus).zeros(),
            stationary(plus.less(1.0, minus), plus.less(-1.0, minus)),
        ],
        axis=1,
    )
    middle = 0.5 * sum(ends)
    found = np.clip(middle + np.remainder(found - middle + np.pi, 2.0 * np.pi) - np.pi, *ends)
    return np.concatenate([found, np.broadcast_to(ends, (len(found), 2))], axis=1)
