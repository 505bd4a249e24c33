"""What bending across its width does to a strip: a thin plate between two simply supported ends, its long edges free.

A beam's section keeps its shape; a strip's curves across its width as it bends along its length, by Poisson's ratio,
and as soon as half a wave is hardly longer than the strip is wide it can do so at its edges alone. In closed form where
a sine fits the ends (Levy; Leissa, Vibration of Plates, NASA SP-160, 1969, section 4.2).
"""

from math import sqrt, tanh

from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.problem.beam import Beam

FLATNESS = 5.0
"""Width over thickness from which on a strip is taken for a thin plate."""


def plate_error(beam: Beam, mode: int) -> float:
    """Frequency of a mode as a thin plate, relative to Euler-Bernoulli's, less one: what a beam leaves out across.

    Of the mode without a nodal line along the strip, between 0, a narrow strip's, and 1/sqrt(1 - nu^2) - 1, that of one
    which stays straight across. Thickness is not in it: see Timoshenko's theory. Raises InputError for anything but a
    uniform rectangular strip, wide beside its thickness, with pinned or guided ends and nothing on it.
    """
    width = check_strip(beam)
    half_width = 0.5 * width * wavenumber_length(beam.supports, mode) / beam.length
    return stiffening(half_width, beam.poissons_ratio)


def check_strip(beam: Beam) -> float:
    """Width in metres. Raises InputError for a beam whose bending across has no closed form here."""
    if not beam.uniform:
        raise InputError(f"beam.{beam.added[0]}: a strip with it has no closed form as a plate here, leave it out")
    if beam.width is None or beam.thickness is None:
        raise InputError("beam.width is missing: a plate's theory takes a rectangle's width and thickness")
    if beam.width < FLATNESS * beam.thickness:
        raise InputError(
            f"beam.width = {beam.width!r} m on thickness = {beam.thickness!r} m: a thin plate's theory is for strips "
            f"at least {FLATNESS:g} times as wide as thick, use theory = 'timoshenko'"
        )
    if not set(beam.supports) <= {"pinned", "guided"}:
        raise InputError(
            f"beam.supports = {beam.supports!r}: a strip has a closed form as a plate here for pinned and guided ends"
        )
    return beam.width


def stiffening(half_width: float, poissons_ratio: float) -> float:
    """Omega over the beam's, less one, of a wave along an endless strip with free edges.

    `half_width` q is its wavenumber times half its width, dimensionless. With g = omega sqrt(rho h / D) / k^2,
    deflections cosh(k sqrt(1 +- g) y) without moment and force at the edges ask for
    (1 - g - nu)^2 sqrt(1 + g) tanh(q sqrt(1 + g)) = (1 + g - nu)^2 sqrt(1 - g) tanh(q sqrt(1 - g)),
    whose lowest root lies between a narrow strip's sqrt(1 - nu^2) and 1.
    """
    narrow = sqrt(1.0 - poissons_ratio * poissons_ratio)
    below, above = narrow, 1.0
    while True:
        middle = 0.5 * (below + above)
        if not below < middle < above:
            return below / narrow - 1.0
        if _edge(middle, half_width, poissons_ratio) < 0.0:
            below = middle
        else:
            above = middle


def _edge(g: float, q: float, nu: float) -> float:
    """What is left at a free edge, negative below the root."""
    fast, slow = sqrt(1.0 + g), sqrt(1.0 - g)
    return (1.0 - g - nu) ** 2 * fast * tanh(q * fast) - (1.0 + g - nu) ** 2 * slow * tanh(q * slow)
