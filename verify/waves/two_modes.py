"""The lumped picture of a travelling wave: two modes a quarter of a period apart; and the local waves of any field.

At a point the derivatives of a deflection separate both waves from both near fields:

    w - w''/k^2 = 2 (A+ + A-),   w' - w'''/k^2 = -2 i k (A+ - A-).

Along a uniform beam without losses a driven field has one standing-wave ratio between two forces. Two modes do not:
equal neighbours n, n + 1 of a pinned beam in quadrature have |A+-|^2 as 1 +- sin(pi x / L), so that the ratio is
max(tan, cot)(pi x / 2L): a pure wave at mid-span, standing at the ends. Derived here; the picture is that of
C. Vloebergh, J.-F. Collard, B. Dehez, F. Labrique, *Study of a travelling wave linear piezomotor using analytical,
finite-element and lumped parameter models*, Electrimacs 2008.
"""

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from verify.analytic_modes import ExactModel
from verify.arrays import Array, ComplexArray
from verify.checks import check_number, check_whole
from verify.errors import InputError
from verify.linear.field import HarmonicField
from verify.linear.positions import Numbers, vector_on
from verify.problem.beam import Beam
from verify.waves.two_waves import reflections, standing_wave_ratios


class TwoModes(msgspec.Struct, frozen=True, kw_only=True):
    """Two mass-normalised modes of a uniform beam as one wave: phi_a + ratio e^{i phase} phi_b. Raises InputError."""

    beam: Beam
    modes: tuple[int, int] = (21, 22)
    ratio: float = 1.0
    """Amplitude of the second over that of the first."""
    phase_deg: float = 90.0
    """Lead of the second, degrees."""

    def __post_init__(self) -> None:
        if not self.beam.uniform:
            raise InputError(f"beam.{self.beam.added[0]}: two modes are one wave on a uniform beam alone, leave it out")
        for mode in self.modes:
            check_whole("modes", mode, 1)
        if self.modes[0] == self.modes[1]:
            raise InputError(f"modes = {list(self.modes)}: one mode with itself stands, give two that differ")
        check_number("ratio", self.ratio, "of two amplitudes", above=0)
        check_number("phase_deg", self.phase_deg, "degrees")

    def wavenumber(self, mode: int) -> float:
        """Of one of its modes, without losses, 1/m."""
        return float(np.sqrt(2.0 * np.pi * ExactModel(self.beam).frequency_hz(mode) / self.beam.wave_constant))

    def local_waves(self, x: Numbers) -> tuple[ComplexArray, ComplexArray]:
        """(A+, A-) at x (m), (n,) each, in the modes' own units. Raises InputError off the beam."""
        at = vector_on("x", x, self.beam.length)

        def waves(mode: int) -> ComplexArray:
            return np.array(
                _waves_of(lambda x, order: ExactModel(self.beam).mode_shape(mode, x, order), self.wavenumber(mode), at)
            )

        forward, backward = waves(self.modes[0]) + self.ratio * np.exp(1j * np.deg2rad(self.phase_deg)) * waves(
            self.modes[1]
        )
        return forward, backward

    def local_swr(self, x: Numbers) -> Array:
        """Local standing-wave ratio at x (m), (n,), infinite where the wave stands."""
        return standing_wave_ratios(reflections(*self.local_waves(x)))


def local_waves(field: HarmonicField, x: Numbers) -> tuple[ComplexArray, ComplexArray]:
    """(A+, A-) at x of the exact field of a uniform beam, m, (n,) each. Raises InputError for another field."""
    if field.count is not None or not field.beam.uniform or field.theory != "euler-bernoulli":
        raise InputError(
            f"model = {field.model!r}: local waves are read from three derivatives, which the exact field of a uniform "
            "Euler-Bernoulli beam has: give that"
        )
    return _waves_of(field.shapes, field.wavenumber, vector_on("x", x, field.beam.length))


def local_swr(field: HarmonicField, x: Numbers) -> Array:
    """Standing-wave ratio at x (m) of the exact field of a uniform beam, (n,). Raises InputError for another."""
    return standing_wave_ratios(reflections(*local_waves(field, x)))


def _waves_of(shapes: Callable[[Array, int], Any], k: complex, x: Array) -> tuple[ComplexArray, ComplexArray]:
    """(A+, A-) at x of derivatives of a shape with wavenumber k, (n,) each."""
    even = 0.5 * (shapes(x, 0) - shapes(x, 2) / k**2)
    odd = 0.5j * (shapes(x, 1) - shapes(x, 3) / k**2) / k
    return 0.5 * (even + odd), 0.5 * (even - odd)
