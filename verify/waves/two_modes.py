"""The lumped-parameter model of a travelling wave: two modes in quadrature.

The derivatives of a mode at a point separate both waves from both near fields:

    w - w''/k^2 = 2 (A+ + A-),   w' - w'''/k^2 = -2 i k (A+ - A-).

A driven field of a uniform undamped beam has a constant standing-wave ratio between two forces, two modes do not:
equal neighbours n, n + 1 of a pinned beam in quadrature have |A+-|^2 as 1 +- sin(pi x / L), so that the ratio is
max(tan, cot)(pi x / 2L): travelling at mid-span, standing at the ends. Derived here; the model is that of
C. Vloebergh, J.-F. Collard, B. Dehez, F. Labrique, *Study of a travelling wave linear piezomotor using analytical,
finite-element and lumped parameter models*, Electrimacs 2008.
"""

import numpy as np

from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.positions import Numbers, vector_on
from verify.problem.beam import Beam, check_features
from verify.waves.two_waves import reflections, standing_wave_ratios


def lumped_swr(beam: Beam, x: Numbers, modes: tuple[int, int] = (21, 22)) -> Array:
    """Local standing-wave ratio (|A+| + |A-|) / ||A+| - |A-|| at x (m), (n,), of phi_a + i phi_b, mass-normalised.

    Infinite for a standing wave. Raises InputError off the beam, for equal modes and for a non-uniform beam.
    """
    check_features(beam, "the two-mode model")
    if modes[0] == modes[1]:
        raise InputError(f"modes = {list(modes)}: give two different modes")
    at, model = vector_on("x", x, beam.length), ExactModel(beam)
    forward = backward = np.zeros(len(at), dtype=complex)
    for mode, factor in zip(modes, (1.0, 1j), strict=True):
        k = np.sqrt(2.0 * np.pi * model.frequency_hz(mode) / beam.wave_constant)
        w = [model.mode_shape(mode, at, order) for order in range(4)]
        even, odd = factor * (w[0] - w[2] / k**2) / 4.0, 1j * factor * (w[1] - w[3] / k**2) / (4.0 * k)
        forward, backward = forward + even + odd, backward + even - odd
    return standing_wave_ratios(reflections(forward, backward))
