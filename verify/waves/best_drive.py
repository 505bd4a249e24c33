"""The amplitude ratio and phase of a second actuator that leave no reflection.

Unit forces of two actuators make waves (A1, B1) and (A2, B2) towards +x and -x in the window. With the complex ratio r
of the second to the first force the waves are A1 + r A2 and B1 + r B2: r = -B1/B2 cancels the wave towards -x. For a
band, r minimises sum |B1 + r B2|^2 / sum |A1 + r A2|^2: it is the last singular vector of the backward part of an
orthonormal basis of all waves. The remaining forward wave (A1 B2 - A2 B1) / B2 vanishes where the unit waves are
proportional, as at an undamped resonance: then no r exists.
"""

from math import inf, isnan, nan

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import NoFigureError
from verify.waves.driven_case import DrivenCase, unit_waves
from verify.waves.operating_point import check_two
from verify.waves.two_waves import minimum_near, reflections, standing_wave_ratios, zero_field
from verify.waves.window import Window, middle_half

PROPORTIONAL, NEARLY = 1e-4, 0.05
"""Independence of the unit waves below which no ratio exists (near fields aside), and below which a note warns."""


class BestDrive(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The drive of two actuators with the least reflection, and the best of equal amplitudes."""

    frequencies_hz: Array
    """(n,), Hz, without frequencies that have no wave."""
    ratio: float
    """Amplitude ratio of second to first actuator; NaN where none exists."""
    phase_deg: float
    """Phase lead of the second actuator, in (-180, 180] degrees."""
    reflection: Array
    """Gamma, (n,): within rounding of zero for a single frequency."""
    equal_phase_deg: float
    """Phase lead of the second actuator, degrees, of least reflection with equal amplitudes."""
    equal_reflection: Array
    """Gamma of equal amplitudes at that phase, (n,)."""
    independence: float
    """Least sine of the angle between the unit waves (A1, B1) and (A2, B2) in the band; 0: proportional."""

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), the largest over the band."""
        return float(standing_wave_ratios(self.reflection).max())

    @property
    def equal_standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma) with equal amplitudes, the largest over the band."""
        return float(standing_wave_ratios(self.equal_reflection).max())

    @property
    def note(self) -> str:
        """Note on a drive near a resonance, where unit waves are proportional; else empty."""
        if self.independence >= NEARLY:
            return ""
        rest = "no ratio cancels it" if isnan(self.ratio) else f"a travelling part of {self.independence:.2g} remains"
        return f"near a resonance both actuators make the same standing wave, {rest}: choose another frequency_hz"

    def check_exists(self) -> None:
        """Raise NoFigureError where no ratio exists."""
        if isnan(self.ratio):
            raise NoFigureError(self.note)


def best_drive(
    case: DrivenCase, window: Window | None = None, *, frequencies_hz: Array | None = None, direction: int = 1
) -> BestDrive:
    """Ratio and phase of the second actuator with least reflection at the case's frequency, or over several.

    `direction` is +1 for a wave towards +x, else -1; the default window is the middle half. Raises InputError without
    two forces (displacements), and NoFigureError where no frequency has a wave.
    """
    check_two(case)
    hertz = case.frequency_hz if frequencies_hz is None else np.asarray(frequencies_hz, dtype=float)
    frequencies = np.atleast_1d(hertz)
    unit = unit_waves(case, frequencies, window or middle_half(case.beam))
    known = np.isfinite(unit.k)
    waves = unit.superposed(np.eye(2, dtype=complex))
    wanted, unwanted = (wave[known] for wave in waves[:: 1 if direction > 0 else -1])
    if not np.isfinite(wanted).all():
        raise zero_field()  # an actuator acts on a support
    sizes = np.sqrt(abs(wanted) ** 2 + abs(unwanted) ** 2).prod(axis=1)
    independence = float((abs(wanted[:, 0] * unwanted[:, 1] - wanted[:, 1] * unwanted[:, 0]) / sizes).min())
    ratio, phase, drive = nan, nan, np.full(2, nan, dtype=complex)
    if independence > PROPORTIONAL:
        both = np.concatenate([wanted, unwanted])
        scale = np.linalg.norm(both, axis=0)  # per actuator, so that a weak one loses no digits
        q, r = np.linalg.qr(both / scale)
        drive = np.linalg.solve(r, np.linalg.svd(q[len(wanted) :])[2][-1].conj()) / scale
        ratio = float(abs(drive[1]) / abs(drive[0])) if drive[0] else inf
        phase = float(np.angle(drive[1] * np.conj(drive[0]), deg=True))

    def unwanted_share(phases: Array) -> Array:
        """Root of the reflected over the total power, at equal amplitudes."""
        powers = [(abs(w[:, :1] + w[:, 1:] * np.exp(1j * phases)) ** 2).sum(axis=0) for w in (wanted, unwanted)]
        return np.asarray(np.sqrt(powers[1] / sum(powers)))

    # more than one turn, so that a minimum at 180 degrees is inside
    equal = np.exp(1j * minimum_near(unwanted_share, np.linspace(-1.04, 1.04, 105) * np.pi, 1e-12).x)
    return BestDrive(
        frequencies_hz=frequencies[known],
        ratio=ratio,
        phase_deg=phase,
        reflection=reflections(wanted @ drive, unwanted @ drive),
        equal_phase_deg=float(np.angle(equal, deg=True)),
        equal_reflection=reflections(wanted @ [1.0, equal], unwanted @ [1.0, equal]),
        independence=independence,
    )
