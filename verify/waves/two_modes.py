"""The lumped picture of a travelling wave: two modes a quarter of a period apart.

At a point the derivatives of a mode separate both waves from both near fields:

    w - w''/k^2 = 2 (A+ + A-),   w' - w'''/k^2 = -2 i k (A+ - A-).

Along a uniform beam without losses a driven field has one standing-wave ratio between two forces. Two modes do not:
equal neighbours n, n + 1 of a pinned beam in quadrature have |A+-|^2 as 1 +- sin(pi x / L), so that the ratio is
max(tan, cot)(pi x / 2L): a pure wave at mid-span, standing at the ends. Derived here; the picture is that of
C. Vloebergh, J.-F. Collard, B. Dehez, F. Labrique, *Study of a travelling wave linear piezomotor using analytical,
finite-element and lumped parameter models*, Electrimacs 2008.
"""

import msgspec
import numpy as np

from verify.analytic_modes import ExactModel
from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.positions import Numbers, vector_on
from verify.problem.beam import Beam
from verify.validation import check_number, check_whole
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

    def local_waves(self, x: Numbers) -> tuple[ComplexArray, ComplexArray]:
        """(A+, A-) at x (m), (n,) each, in the modes' own units. Raises InputError off the beam."""
        at, model = vector_on("x", x, self.beam.length), ExactModel(self.beam)
        forward = backward = np.zeros(len(at), dtype=complex)
        factors = (1.0, self.ratio * np.exp(1j * np.deg2rad(self.phase_deg)))
        for mode, factor in zip(self.modes, factors, strict=True):
            k = np.sqrt(2.0 * np.pi * model.frequency_hz(mode) / self.beam.wave_constant)
            w = [model.mode_shape(mode, at, order) for order in range(4)]
            even, odd = factor * (w[0] - w[2] / k**2) / 4.0, 1j * factor * (w[1] - w[3] / k**2) / (4.0 * k)
            forward, backward = forward + even + odd, backward + even - odd
        return forward, backward

    def local_swr(self, x: Numbers) -> Array:
        """Local standing-wave ratio (|A+| + |A-|) / ||A+| - |A-|| at x (m), (n,), infinite where the wave stands."""
        return standing_wave_ratios(reflections(*self.local_waves(x)))
