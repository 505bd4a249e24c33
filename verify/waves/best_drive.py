"""The amplitude ratio and phase of a second actuator that leave no reflection.

Unit forces of two actuators make waves (A1, B1) and (A2, B2) towards +x and -x in the window; with r at the second they
make A1 + r A2 and B1 + r B2, so that r = -B1/B2 leaves no wave towards -x. Over a band one r makes
sum |B1 + r B2|^2 / sum |A1 + r A2|^2 least: the last singular vector of the backward part of an orthonormal basis of
all waves, at one frequency the same r. The forward wave that is left, (A1 B2 - A2 B1) / B2, vanishes where the unit
waves are proportional, as at an undamped resonance: then no r exists.
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
"""Independence of the unit waves below which no ratio exists, but for near fields, and below which a note says so."""


class BestDrive(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The drive of two actuators with the least reflection, and the best of equal amplitudes."""

    frequencies_hz: Array
    """(n,), the frequencies that have a wave."""
    ratio: float
    """Amplitude of the second over that of the first, forces or displacements; NaN where none exists."""
    phase_deg: float
    """Lead of the second, in (-180, 180]."""
    reflection: Array
    """Gamma, (n,): at one frequency zero but for rounding."""
    equal_phase_deg: float
    """Lead of the second at which equal amplitudes have the least reflection."""
    equal_reflection: Array
    """Gamma of equal amplitudes at that phase, (n,)."""
    independence: float
    """Sine of the angle between the unit waves (A1, B1) and (A2, B2), the least over the band; 0: proportional."""

    @property
    def standing_wave_ratio(self) -> float:
        """(1 + Gamma) / (1 - Gamma), the largest over the band."""
        return float(standing_wave_ratios(self.reflection).max())

    @property
    def equal_standing_wave_ratio(self) -> float:
        """The same of equal amplitudes."""
        return float(standing_wave_ratios(self.equal_reflection).max())

    @property
    def note(self) -> str:
        """Limit of the drive near a resonance, where unit waves are proportional; empty elsewhere."""
        if self.independence >= NEARLY:
            return ""
        left = "no ratio makes it travel" if isnan(self.ratio) else f"{self.independence:.2g} of it is left travelling"
        return f"near a resonance both actuators make the same standing wave and {left}: choose another frequency_hz"

    def check_exists(self) -> None:
        """Raise NoFigureError where no ratio exists."""
        if isnan(self.ratio):
            raise NoFigureError(self.note)


def best_drive(
    case: DrivenCase, window: Window | None = None, *, frequencies_hz: Array | None = None, direction: int = 1
) -> BestDrive:
    """The best ratio and phase of the second actuator of a case, at its frequency, or one pair over several.

    For a wave towards +x, or -x with `direction` -1; in the middle half by default. Raises InputError without two
    forces (displacements), and NoFigureError where no frequency has a wave.
    """
    check_two(case)
    frequencies = np.atleast_1d(
        case.frequency_hz if frequencies_hz is None else np.asarray(frequencies_hz, dtype=float)
    )
    unit = unit_waves(case, frequencies, window or middle_half(case.beam))
    known = np.isfinite(unit.k)
    wanted, unwanted = (
        wave[known] for wave in unit.superposed(np.eye(2, dtype=complex))[:: 1 if direction > 0 else -1]
    )
    if not np.isfinite(wanted).all():
        raise zero_field()  # an actuator acts on a support
    sizes = np.sqrt(abs(wanted) ** 2 + abs(unwanted) ** 2).prod(axis=1)
    independence = float((abs(wanted[:, 0] * unwanted[:, 1] - wanted[:, 1] * unwanted[:, 0]) / sizes).min())
    ratio, phase, drive = nan, nan, np.full(2, nan, dtype=complex)
    if independence > PROPORTIONAL:
        both = np.concatenate([wanted, unwanted])
        scale = np.linalg.norm(both, axis=0)  # of each actuator, so that a weak one costs no digits
        q, r = np.linalg.qr(both / scale)
        drive = np.linalg.solve(r, np.linalg.svd(q[len(wanted) :])[2][-1].conj()) / scale
        ratio = float(abs(drive[1]) / abs(drive[0])) if drive[0] else inf
        phase = float(np.angle(drive[1] * np.conj(drive[0]), deg=True))

    def unwanted_share(phases: Array) -> Array:
        """Root of the power of the unwanted wave over that of both, at equal amplitudes."""
        powers = [(abs(w[:, :1] + w[:, 1:] * np.exp(1j * phases)) ** 2).sum(axis=0) for w in (wanted, unwanted)]
        return np.asarray(np.sqrt(powers[1] / sum(powers)))

    # beyond one turn on both sides, so that a minimum at 180 degrees is inside
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
