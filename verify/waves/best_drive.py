"""The amplitude ratio and phase of a second actuator that leave no reflection.

Unit forces at two actuators make waves (A1, B1) and (A2, B2) towards +x and -x in the window. Under the first with 1 and
the second with r they make A1 + r A2 and B1 + r B2, so r = -B1/B2 leaves no wave towards -x. Over a band one r makes
sum |B1 + r B2|^2 / sum |A1 + r A2|^2 least: the smallest singular value of the backward part of an orthonormal basis of
all waves, which at one frequency is zero and the same r. The forward wave that is left, (A1 B2 - A2 B1) / B2, vanishes
where the unit waves are proportional, as at an undamped resonance: then no r exists.
"""

from math import inf, isnan, nan

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import StandingError
from verify.waves.best_phase import FirstHarmonic, squared
from verify.waves.driven_case import DrivenCase
from verify.waves.operating_point import check_two
from verify.waves.results import reflections, standing_wave_ratios
from verify.waves.superposition import UnitWaves, unit_waves
from verify.waves.window import Window, middle_half

HUGE = 10.0
"""Amplitude ratio, or its inverse, from which the result says so."""
PROPORTIONAL, NEARLY = 1e-9, 0.05
"""Sine of the angle between the unit waves (A1, B1) and (A2, B2) below which there is no ratio, and below which the
result says that little of the wave is left."""


class BestDrive(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The drive of two actuators with the least reflection, beside that of equal amplitudes."""

    frequencies_hz: Array
    """(n,), one or a band."""
    direction: int
    """+1 for a wave towards +x, -1 for one towards -x."""
    ratio: float
    """Amplitude of the second over that of the first, forces or displacements; NaN where there is none."""
    phase_deg: float
    """Lead of the second, in (-180, 180]."""
    reflection: Array
    """Gamma, (n,): at one frequency zero but for rounding."""
    equal_phase_deg: float
    """Lead of the second at which equal amplitudes have the least reflection."""
    equal_reflection: Array
    """Gamma of these, (n,)."""
    independence: float
    """Sine of the angle between the unit waves, the least over the band: 0 where they are proportional."""
    note: str = ""
    """What limits the drive; empty where nothing does."""

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), the largest over the band."""
        return float(standing_wave_ratios(self.reflection).max())

    @property
    def equal_standing_wave_ratio(self) -> float:
        """The same of equal amplitudes."""
        return float(standing_wave_ratios(self.equal_reflection).max())

    def check_exists(self) -> None:
        """Raise StandingError where no ratio exists."""
        if isnan(self.ratio):
            raise StandingError(self.note)


def best_drive(
    case: DrivenCase, window: Window | None = None, *, frequencies_hz: Array | None = None, direction: int = 1
) -> BestDrive:
    """The best ratio and phase of the second actuator of a case, at its frequency or one pair over several.

    The window is the middle half by default. Frequencies without a wave are left out. Raises InputError without two
    forces (displacements), and NoFigureError where no frequency has a wave.
    """
    check_two(case)
    frequencies = np.atleast_1d(np.asarray(case.frequency_hz if frequencies_hz is None else frequencies_hz, dtype=float))
    waves = unit_waves(case, frequencies, window or middle_half(case.beam))
    waves.check_any(abs(waves.k))
    known = np.isfinite(waves.k)
    wanted, unwanted = waves.forward[known], waves.backward[known]
    if direction < 0:
        wanted, unwanted = unwanted, wanted
    area = abs(wanted[:, 0] * unwanted[:, 1] - wanted[:, 1] * unwanted[:, 0])
    sizes = np.sqrt(abs(wanted) ** 2 + abs(unwanted) ** 2)
    independence = float((area / np.maximum(sizes.prod(axis=1), np.finfo(float).tiny)).min())
    drive = _least(wanted, unwanted) if independence > PROPORTIONAL else np.array([1.0, nan], dtype=complex)
    ratio = abs(drive[1] / drive[0]) if drive[0] else inf
    plus, minus = (_summed(squared(wave[:, 0], wave[:, 1])) for wave in (wanted, unwanted))
    phases = minus.stationary_ratio(plus)[0]  # of the least and of the largest |A-|^2 / |A+|^2
    equal = min(phases, key=lambda phase: float(minus.at(phase)[0] / plus.at(phase)[0]))
    return BestDrive(
        frequencies_hz=frequencies[known],
        direction=1 if direction > 0 else -1,
        ratio=float(ratio),
        phase_deg=float(np.angle(drive[1] * np.conj(drive[0]), deg=True)),
        reflection=_reflection(waves, drive),
        equal_phase_deg=float(np.angle(np.exp(1j * equal), deg=True)),
        equal_reflection=_reflection(waves, np.array([1.0, np.exp(1j * equal)])),
        independence=independence,
        note=_note(case, float(ratio), float(sizes[:, 1].mean() / sizes[:, 0].mean()), independence),
    )


def _least(wanted: ComplexArray, unwanted: ComplexArray) -> ComplexArray:
    """The drive (2,) of least unwanted over wanted wave, of unit waves (n, 2)."""
    scale = np.linalg.norm(np.concatenate([wanted, unwanted]), axis=0)  # of each actuator: a weak one is no weaker wave
    q, r = np.linalg.qr(np.concatenate([wanted, unwanted]) / scale)
    return np.asarray(np.linalg.solve(r, np.linalg.svd(q[len(wanted) :])[2][-1].conj()) / scale)


def _summed(one: FirstHarmonic) -> FirstHarmonic:
    return FirstHarmonic(one.mean.sum(keepdims=True), one.first.sum(keepdims=True))


def _reflection(waves: UnitWaves, drive: ComplexArray) -> Array:
    """Gamma, (n,), at the frequencies that have waves; NaN without a drive."""
    forward, backward = ((w[np.isfinite(waves.k)] @ drive) for w in (waves.forward, waves.backward))
    return reflections(forward, backward)


def _note(case: DrivenCase, ratio: float, response: float, independence: float) -> str:
    """What limits a drive; `response` of the second actuator over the first, in size."""
    if independence <= PROPORTIONAL:
        return (
            "both actuators make the same standing wave, as at a resonance of an undamped beam, and no ratio makes it "
            "travel: choose another frequency_hz or position"
        )
    if not 1.0 / HUGE < ratio < HUGE:
        large, factor, weak = (1, ratio, 1.0 / response) if ratio > 1.0 else (0, 1.0 / ratio, response)
        why = "it acts near a node, move it" if weak > 3.0 else "the wave is nearly that of this one alone"
        return f"the amplitude at {case.forces[large].position:g} m is {factor:.3g} times the other: {why}"
    if independence < NEARLY:
        return (
            f"both actuators make nearly the same standing wave, as near a resonance, and {independence:.2g} of it is "
            "left travelling: choose another frequency_hz"
        )
    return ""
