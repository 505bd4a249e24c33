"""Linear theory: deflections, slopes and stretching under the drive and under a slider along its way."""

from collections.abc import Sequence
from math import asinh, sinh
from typing import TYPE_CHECKING

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import LESS, Margin, per_cent
from verify.errors import InputError
from verify.formatting import with_unit
from verify.linear.registry import EXACT, MODELS
from verify.problem.beam import PointForce

if TYPE_CHECKING:
    from verify.linear.field import HarmonicField
    from verify.problem.slider import Slider

SLOPE = 0.1, 0.3
"""Slopes up to which linear theory is trusted, and trusted under a condition: their squares are relative lengths."""
WAYPOINTS = 9
"""Positions of a moving slider whose sag is computed: eight parts miss a thirtieth of the largest sag at most."""
STILL = 1e-4
"""Frequency of a static load over the first natural frequency: the dynamic part is its square."""


def linearity_margins(what: str, field: "HarmonicField", remedy: str, *, static: bool = False) -> list[Margin]:
    """Linear theory under a deflection w: its largest slope, whose square is a relative length, and its stretching.

    Linear models assume that an end slides. Between two ends that are pinned or clamped and fixed there is a tension
    (EA/2L) int w'^2 dx (S. Woinowsky-Krieger, J. Appl. Mech. 17 (1950) 35). With c times the linear shape w, a static
    load of work 2 U and U = 1/2 int EI w''^2 dx (and the energy of axial force and foundation) the potential energy is
    U (c^2 - 2 c) + (EA/8L) (int w'^2 dx)^2 c^4, least for c + S c^3 = 1, where S = EA (int w'^2 dx)^2 / (4 L U): a
    `static` deflection is too large by 1/c - 1 = S c^2, exact to first order. A free vibration c(t) is Duffing's, of
    omega^2 (1 + 3 S/4) at amplitude 1: 3/16 (a/r)^2 of the source for w = a sin(pi x/L), I = A r^2. S = 4: both 1.
    """
    import numpy as np

    from verify.linear.surface import piece_at
    from verify.problem.supports import FIXED

    beam, x = field.beam, np.linspace(0.0, field.beam.length, 401)
    w, tilt, bend = (abs(field.derivative(x, order)) for order in range(3))
    slope = float(tilt.max())
    bends = f"{what} bends the beam by {with_unit(float(w.max()))}"
    failure = f"{bends}, {per_cent(float(w.max()) / beam.length)} of its length"
    found = [
        Margin(
            name="linear theory under " + what,
            size=slope**2,
            fine=SLOPE[0] ** 2,
            limit=SLOPE[1] ** 2,
            condition=f"a slope of {slope:.2g} is small ({failure})",
            failure=failure,
            remedy=remedy,
            is_error=False,
            harm="premise",
        )
    ]
    known = all(piece.youngs_modulus and piece.area for piece in beam.pieces)
    if known and slope and all(FIXED[support].deflection for support in beam.supports):
        axial = beam.length / sum(piece.length / piece.axial_stiffness for piece in beam.pieces)
        bending = np.array([piece.bending_stiffness for piece in beam.pieces])[piece_at(beam, x)]
        energy = np.trapezoid(bending * bend**2 + beam.tension * tilt**2 + beam.foundation * w**2, x)
        ratio = float(axial * np.trapezoid(tilt**2, x) ** 2 / (2.0 * beam.length * energy))
        c = 2.0 / (3.0 * ratio) ** 0.5 * sinh(asinh(1.5 * (3.0 * ratio) ** 0.5) / 3.0)
        size = ratio * c**2 if static else (1.0 + 0.75 * ratio) ** 0.5 - 1.0
        much = f"{per_cent(size)} {'too much' if static else 'in frequency'}"
        found.append(
            Margin(
                name="stretching under " + what,
                size=size,
                limit=1.0,
                is_error=False,
                harm="premise",
                remedy=remedy,
                condition=f"an end may slide along the beam (otherwise {bends}, {much})",
                failure=f"{failure}, {much} unless an end slides along it",
            )
        )
    return found


def sag_margins(
    cache: SolutionCache, slider: "Slider", amplitude: float | None = None, places: Sequence[float] = ()
) -> list[Margin]:
    """Static sag of the beam under a slider's weight and preload: its slope, stretching, and curvature under feet.

    At the worst of the positions between the least and the largest of `places`, m, by default at the start. The
    curvature counts over `amplitude` of the wave, m, and only with one-way coupling, which neglects it. Empty for a
    beam with rigid-body motions and for sliders without load.
    """
    beam, start = cache.beam, slider.initial_position(cache.beam)
    first, last = (min(max(one(places), 0.0), beam.length) if places else start for one in (min, max))
    steps = WAYPOINTS if last - first > 0.01 * beam.length else 1
    positions = [first + (last - first) * i / (steps - 1) for i in range(steps)] if steps > 1 else [start]
    if beam.rigid_motions:
        return []
    try:
        model, hertz = MODELS[EXACT].build(beam), STILL * cache.exact_hz(1)
        fields = [model.harmonic(loads, hertz) for x in positions if (loads := _weights(slider, x, beam.length))]
    except InputError:
        return []
    what = "the preload" if slider.preload else "the slider's weight"
    each = [linearity_margins(what, field, LESS, static=True) for field in fields]
    found = max(each, key=lambda margins: margins[0].size, default=[])
    if fields and amplitude and slider.coupling == "one-way":
        bent = max(abs(fields[0].derivative(start + foot.offset, 2)[0]) * foot.length**2 / 8.0 for foot in slider.feet)
        found.append(
            Margin(
                name="sag under a foot relative to the wave's amplitude",
                size=float(bent) / amplitude,
                remedy="use coupling = 'two-way', or shorter feet",
            )
        )
    return found


def _weights(slider: "Slider", x: float, length: float) -> "list[PointForce]":
    """Static forces of a slider at x on the beam, N."""
    return [
        PointForce(position=min(max(x + foot.offset, 0.0), length), amplitude=size)
        for foot in slider.feet
        if not foot.mirrored and (size := slider.static_normal_force(foot) * (1.0 if foot.face == "lower" else -1.0))
    ]
