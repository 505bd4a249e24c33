"""Plate effect of strips: conforming finite elements, Konenkov's edge wave, published values."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.sparse import csr_array, kron
from scipy.sparse.linalg import eigsh

from tests.reference.dense import CUBICS, HELD
from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.exact.plate import plate_error, ritz_error, stiffening
from verify.problem.beam import Beam

SIZES = {"length": 0.31, "width": 0.023, "thickness": 0.0012, "youngs_modulus": 1.1e11, "density": 4400.0}


def cubics(nodes: np.ndarray, prevented: list[int]) -> list[csr_array]:
    """Hermite cubics and two derivatives at 4 Gauss points per element times the roots of their weights, 3 of (4 n, .).

    Columns are deflection and slope of each node, less those `prevented`.
    """
    lengths, (points, weights) = np.diff(nodes), np.polynomial.legendre.leggauss(4)
    rows = np.zeros((3, len(lengths), 4, 2 * len(nodes)))
    for order in range(3):
        values = np.array([Polynomial(one).deriv(order)(0.5 * (points + 1.0)) for one in CUBICS]).T
        for e, h in enumerate(lengths):
            scales = np.sqrt(0.5 * h * weights)[:, None] * h ** (np.array([0, 1, 0, 1]) - order)
            rows[order, e, :, 2 * e : 2 * e + 4] = scales * values
    return [csr_array(np.delete(one, prevented, axis=1)) for one in rows.reshape(3, -1, rows.shape[-1])]


def finite_elements(supports: tuple[str, str], aspect: float, nu: float, mode: int, n: tuple[int, int]) -> float:
    """Bicubic Hermite (Bogner-Fox-Schmit) elements on half a strip of unit width; mode by rank, right below kb = 4.73.

    The Rayleigh quotient is of strains: rounding in the assembled matrix costs the eigenvalue digits.
    """
    s, y = np.linspace(0.0, 1.0, n[0] + 1), 0.5 * np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, n[1] + 1))
    x = aspect * (s - 0.8 * np.sin(2 * np.pi * s) / (2 * np.pi))
    along = cubics(x, [*HELD[supports[0]], *(2 * n[0] + k for k in HELD[supports[1]])])
    across = cubics(y, [1])  # symmetric
    w, w_xx, w_yy, w_xy = (kron(along[i], across[j], "csr") for i, j in ((0, 0), (2, 0), (0, 2), (1, 1)))
    strains = (np.sqrt(1 - nu**2) * w_xx, w_yy + nu * w_xx, np.sqrt(2 * (1 - nu)) * w_xy)
    rigid = {("free", "free"): 2, ("pinned", "free"): 1, ("guided", "free"): 1}.get(supports, 0)
    narrow = (1 - nu**2) * (wavenumber_length(supports, mode) / aspect) ** 4
    k, m = sum(one.T @ one for one in strains).tocsc(), (w.T @ w).tocsc()
    values, vectors = eigsh(k, mode + rigid, m, sigma=-0.01 * narrow, v0=np.ones(k.shape[0]))
    shape = vectors[:, values.argmax()]
    energy = sum(np.sum((one @ shape) ** 2) for one in strains)
    return float(np.sqrt(energy / np.sum((w @ shape) ** 2) / narrow) - 1.0)


STRIPS = [
    (("clamped", "free"), 2.3, 0.29, 1, (14, 5), 2e-6),
    (("clamped", "free"), 5.3, 0.29, 4, (24, 3), 2e-6),
    (("clamped", "clamped"), 5.3, 0.17, 3, (24, 3), 2e-6),
    (("free", "free"), 5.3, 0.29, 3, (24, 3), 2e-6),
    (("pinned", "clamped"), 5.3, 0.4, 2, (24, 3), 2e-6),
    (("pinned", "free"), 4.1, -0.25, 2, (20, 3), 2e-6),
    (("guided", "free"), 2.3, 0.4, 2, (16, 4), 2e-6),
    (("clamped", "guided"), 25.0, 0.33, 22, (110, 3), 1e-5),
]


@pytest.mark.parametrize(("supports", "aspect", "nu", "mode", "mesh", "tolerance"), STRIPS)
def test_clamped_and_free_ends_agree_with_finite_elements_of_order_four(supports, aspect, nu, mode, mesh, tolerance):
    ours = ritz_error(supports, aspect, nu, mode)
    coarse, fine = (finite_elements(supports, aspect, nu, mode, (k * mesh[0], k * mesh[1])) for k in (1, 2))
    least = 12.0 if mode > 1 else 9.0  # the singular corner between clamped and free edge weighs more in mode 1
    assert least < (coarse - ours) / (fine - ours) < 17.0
    assert fine + (fine - coarse) / 15.0 == pytest.approx(ours, abs=tolerance)


@pytest.mark.parametrize(("mode", "published"), [(1, 3.492), (2, 21.43)])
def test_a_square_cantilever_lies_below_published_upper_bounds_by_less_than_one_percent(mode, published):
    """Omega a^2 sqrt(rho h / D), nu = 0.3: beam functions (Leissa, J. Sound Vib. 31, 1973; code_aster SDLS01)."""
    ours = (
        np.sqrt(0.91)
        * wavenumber_length(("clamped", "free"), mode) ** 2
        * (1 + ritz_error(("clamped", "free"), 1.0, 0.3, mode))
    )
    assert 0.99 * published < ours < published


@pytest.mark.parametrize("mode", [1, 22, 60])
@pytest.mark.parametrize(("supports", "less"), [(("pinned", "pinned"), 0.0), (("guided", "pinned"), 0.5)])
def test_the_ritz_solution_meets_the_closed_form(supports, less, mode):
    exact = stiffening(0.5 * np.pi * (mode - less) / 24.7, 0.33)
    assert ritz_error(supports, 24.7, 0.33, mode) == pytest.approx(exact, abs=2e-9)
    assert plate_error(Beam(**SIZES | {"width": 0.31 / 24.7, "supports": supports}), mode) == pytest.approx(exact)


def test_a_narrow_strip_is_a_beam():
    """Between free ends by the square of its width, at a clamped end by its width; without Poisson's ratio always."""
    assert stiffening(1e-3, 0.2) == pytest.approx(0.2**2 / (3 * 1.2) * 1e-6, rel=1e-5)
    for supports, order in ((("free", "free"), 2.0), (("clamped", "free"), 1.0)):
        own = [ritz_error(supports, aspect, 0.33, 2) for aspect in (150.0, 600.0, 2400.0)]
        assert all(np.log(a / b) / np.log(4.0) == pytest.approx(order, abs=0.02) for a, b in pairwise(own))
    assert stiffening(1.7, 0.0) == 0.0 == pytest.approx(ritz_error(("clamped", "free"), 3.0, 0.0, 3), abs=1e-14)


@pytest.mark.parametrize("nu", [0.12, 0.33, 0.49])
def test_the_lowest_wave_of_a_very_wide_strip_is_konenkovs_edge_wave(nu):
    edge = np.sqrt((1 - nu) * (3 * nu - 1 + 2 * np.sqrt(1 - 2 * nu + 2 * nu**2)) / (1 - nu**2)) - 1.0
    assert stiffening(1e5, nu) == pytest.approx(edge, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "mode", "message"),
    [
        ({"width": 0.004}, 3, "at least 5 thicknesses"),
        ({"foundation": 3e4}, 3, "beam.foundation: plate theory does not model it"),
        ({"supports": ("free", "free"), "width": 0.31}, 1, "mode = 1: .* more than half"),
        ({"supports": ("clamped", "free")}, 10**6, "unknowns"),
    ],
)
def test_a_strip_without_a_plate_solution_is_an_input_error(change, mode, message):
    with pytest.raises(InputError, match=message):
        plate_error(Beam(**(SIZES | change)), mode)
