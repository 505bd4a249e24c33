"""Plate effect: a uniform rectangular strip as a thin plate with free long edges, against Euler-Bernoulli theory.

Bending along a strip causes anticlastic bending across its width by Poisson's ratio, which beam theory neglects. A half
wave not much longer than the width suppresses it except near the edges, and so does a clamped end. Pinned and guided
ends: closed form (Levy; Leissa, Vibration of Plates, NASA SP-160, 1969, section 4.2). Clamped and free ends: Ritz
method with integrated Legendre polynomials along and Legendre polynomials across.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import sqrt, tanh
from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.problem.beam import Beam, check_features
from verify.problem.supports import FIXED

if TYPE_CHECKING:
    from verify.arrays import Array

FLATNESS = 5.0  # Smallest width over thickness for thin-plate theory
MOST_UNKNOWNS = 25_000  # Largest number of unknowns of a Ritz solution, about 2 s


def plate_error(beam: Beam, mode: int) -> float:
    """Frequency of a mode as a thin plate, relative to Euler-Bernoulli theory, less 1.

    The mode is symmetric across the width, without a nodal line along the strip: 0 for a narrow strip,
    1/sqrt(1 - nu^2) - 1 for cylindrical bending. The thickness has no influence. Exact for pinned and guided ends; an
    upper bound within about 1e-6 (|nu| <= 0.4) otherwise. Raises InputError unless the beam is a uniform rectangular
    strip, at least `FLATNESS` times as wide as thick, and for a mode without a counterpart in the plate.
    """
    check_features(beam, "plate theory")
    if beam.width is None or beam.thickness is None:
        raise InputError("beam.width is missing: plate theory needs a rectangle's width and thickness")
    if beam.width < FLATNESS * beam.thickness:
        raise InputError(
            f"beam.width = {beam.width!r} m and thickness = {beam.thickness!r} m: thin-plate theory needs a width of "
            f"at least {FLATNESS:g} thicknesses, use theory = 'timoshenko'"
        )
    if set(beam.supports) <= {"pinned", "guided"}:
        half_width = 0.5 * beam.width * wavenumber_length(beam.supports, mode) / beam.length
        return stiffening(half_width, beam.poissons_ratio)
    return ritz_error(beam.supports, beam.length / beam.width, beam.poissons_ratio, mode)


def stiffening(half_width: float, poissons_ratio: float) -> float:
    """Relative frequency difference of a wave along an infinite strip with free edges from the beam's.

    `half_width` q is its wavenumber times half its width, dimensionless. With g = omega sqrt(rho h / D) / k^2,
    deflections cosh(k sqrt(1 +- g) y) without moment and force at the edges satisfy
    (1 - g - nu)^2 sqrt(1 + g) tanh(q sqrt(1 + g)) = (1 + g - nu)^2 sqrt(1 - g) tanh(q sqrt(1 - g)),
    whose lowest root lies between a narrow strip's sqrt(1 - nu^2) and 1.
    """
    nu = poissons_ratio
    narrow = sqrt(1.0 - nu * nu)
    # bisection to adjacent floating-point numbers: in narrow strips the change of sign is within rounding
    below, above = narrow, 1.0
    while below < (g := 0.5 * (below + above)) < above:
        fast, slow = sqrt(1.0 + g), sqrt(1.0 - g)
        residual = (1.0 - g - nu) ** 2 * fast * tanh(half_width * fast)
        residual -= (1.0 + g - nu) ** 2 * slow * tanh(half_width * slow)
        below, above = (g, above) if residual < 0.0 else (below, g)
    return below / narrow - 1.0


@lru_cache(maxsize=512)
def ritz_error(supports: Sequence[str], aspect: float, poissons_ratio: float, mode: int) -> float:
    """Plate effect for any supports, by Ritz's method: an upper bound of the frequency. `aspect`: length over width.

    The energy is a sum of squares, (1 - nu^2) w_xx^2 + (w_yy + nu w_xx)^2 + 2 (1 - nu) w_xy^2 over D/2, so that the
    Rayleigh quotient has no cancellation. Of the eigenvectors near the infinite strip's frequency the mode is the one
    with more than half of its modal mass in the beam's mode, constant across the width; it is unique (Bessel). Raises
    InputError if there is none, as in strips about as wide as long.
    """
    import numpy as np
    from numpy.polynomial import legendre
    from scipy import sparse
    from scipy.sparse.linalg import eigsh

    wavenumber = 0.5 * wavenumber_length(supports, mode)  # lengths in half lengths, widths in half widths
    half_width = wavenumber / aspect
    # two terms per half wave, and terms for the ends, where the resolution is the square of the degree
    terms_along = int(2 * mode + 90 + 12 * sqrt(aspect))
    terms_across = int(10 + 0.7 * half_width)
    if terms_along * terms_across > MOST_UNKNOWNS:
        raise InputError(
            f"mode = {mode}: its plate solution on a strip of length / width = {aspect:.3g} takes "
            f"{terms_along * terms_across} unknowns, more than {MOST_UNKNOWNS}, choose a lower mode"
        )
    along = _along(supports, terms_along)
    # across, even Legendre polynomials and two derivatives in orthonormal ones, (2 terms, terms)
    norm = np.sqrt(np.arange(2 * terms_across) + 0.5)
    derived = [legendre.legder(np.diag(norm)[:, ::2], order) for order in range(3)]
    across = [sparse.csc_array(np.pad(d, ((0, len(norm) - len(d)), (0, 0))) / norm[:, None]) for d in derived]
    w, w_xx, w_yy, w_xy = (
        aspect**j * sparse.kron(along[i], across[j], "csc") for i, j in ((0, 0), (2, 0), (0, 2), (1, 1))
    )
    nu = poissons_ratio
    strains = (sqrt(1.0 - nu * nu) * w_xx, w_yy + nu * w_xx, sqrt(2.0 * (1.0 - nu)) * w_xy)

    def nearest(parts: "Sequence[Any]", motion: Any, eigenvalue: float, n: int) -> "Array":
        # a shift off the eigenvalue, so that the matrix is not singular; a fixed start makes results reproducible
        stiffness, start = sum(part.T @ part for part in parts), np.ones(motion.shape[1])
        vectors: Array = eigsh(stiffness, n, (motion.T @ motion).tocsc(), sigma=1.0001 * eigenvalue, v0=start)[1]
        return vectors

    beam = along[0] @ nearest([along[2]], along[0], wavenumber**4, 1)[:, 0]
    narrow = (1.0 - nu * nu) * wavenumber**4
    vectors = nearest(strains, w, narrow * (1.0 + stiffening(half_width, nu)) ** 2, 8)
    mass = np.sum((w @ vectors) ** 2, axis=0)
    share = (beam @ (along[0] @ vectors[::terms_across])) ** 2 / (beam @ beam) / mass
    best = int(share.argmax())
    if share[best] <= 0.5:
        raise InputError(
            f"mode = {mode}: on a strip of length / width = {aspect:.3g} no plate mode has more than half of its modal "
            f"mass in this mode of the beam ({100.0 * share[best]:.0f} %), choose a narrower strip or another mode"
        )
    energy = sum(float(np.sum((part @ vectors[:, best]) ** 2)) for part in strains)
    return sqrt(energy / float(mass[best]) / narrow) - 1.0


def _along(supports: Sequence[str], n: int) -> "list[Any]":
    """Sparse coefficients, (n, functions), of w, w', w'' in orthonormal Legendre polynomials on (-1, 1).

    Cubic Hermite functions of the free end displacements and slopes, and twice integrated polynomials from degree 2 on,
    which vanish at both ends with their slopes; their second derivatives are orthonormal.
    """
    import numpy as np
    from numpy.polynomial import legendre
    from scipy import sparse

    degree = np.arange(n)
    norm = sparse.diags_array(np.sqrt(degree + 0.5))  # P_k times this factor has unit norm
    rise = 1.0 / (2.0 * degree + 1.0)  # the integral of P_k is (P_k+1 - P_k-1) / (2 k + 1)
    integral = sparse.diags_array([rise[:-1], -rise[1:]], offsets=[-1, 1])
    bent = norm.tocsc()[:, 2:-2]
    integrated = [integral @ integral @ bent, integral @ bent, bent]
    hermite = np.array(
        [[0.5, -0.6, 0.0, 0.1], [1 / 6, -0.1, -1 / 6, 0.1], [0.5, 0.6, 0.0, -0.1], [-1 / 6, -0.1, 1 / 6, 0.1]]
    )
    cubic = hermite[[not prevented for support in supports for prevented in FIXED[support]]].T
    series = []
    for order in range(3):
        derived = legendre.legder(cubic, order)
        padded = np.pad(derived, ((0, n - len(derived)), (0, 0)))
        columns = sparse.hstack([sparse.csc_array(padded), integrated[order]])
        series.append(sparse.csc_array(sparse.diags_array(1.0 / norm.diagonal()) @ columns))
    return series
