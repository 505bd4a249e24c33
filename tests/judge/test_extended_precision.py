"""Solvers judged by counting eigenvalues in 50-digit arithmetic, never by another float64 solver."""

from decimal import Decimal, localcontext

import numpy as np
import pytest
from msgspec.structs import replace

from verify.elements import linear as fem_beam
from verify.elements.mesh import basis_between, stiffness_matrix
from verify.errors import InputError
from verify.exact import error_laws
from verify.judge.extended_precision import chain_bands, count_below, eigenvalue_error, hermite_bands
from verify.segments import linear as segment_model

MODELS = {"segment": segment_model, "fem": fem_beam}
BEAMS = [("pinned", "pinned"), ("clamped", "clamped"), ("clamped", "free"), ("free", "free")]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    "supports", [*BEAMS, ("guided", "free"), ("pinned", "clamped"), ("guided", "guided")], ids="-".join
)
def test_frequencies_up_to_mode_fifty_are_right_to_rounding(titanium_strip, model, supports):
    beam = replace(titanium_strip, supports=supports)
    for count in (60, 400):
        found = MODELS[model].solve_modes(beam, 50, count).frequencies_hz
        for mode in (1, 2, 3, 17, 50):
            assert eigenvalue_error(beam, model, count, mode, float(found[mode - 1])) <= 2e-14


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", BEAMS, ids="-".join)
def test_ten_thousand_parts_cost_no_digit_that_matters(titanium_strip, model, supports):
    beam = replace(titanium_strip, supports=supports)
    found = MODELS[model].solve_modes(beam, 50, 10_000).frequencies_hz
    for mode in (1, 50):
        assert eigenvalue_error(beam, model, 10_000, mode, float(found[mode - 1])) <= 1e-12


def test_the_count_agrees_with_the_discrete_dispersion(titanium_strip):
    for model in MODELS:
        exact = error_laws.dispersion_frequency_hz(model, titanium_strip, 7, 90)
        assert eigenvalue_error(titanium_strip, model, 90, 7, exact) <= 1e-15
        assert eigenvalue_error(titanium_strip, model, 90, 7, exact * (1 + 3e-9)) == 5e-9
        assert eigenvalue_error(titanium_strip, model, 90, 8, exact) == np.inf


def test_the_count_of_a_matrix_worked_out_by_hand():
    """Two pinned links: K = 4, M = 2/3, one eigenvalue at 6."""
    with localcontext() as context:
        context.prec = 30
        bands = chain_bands(("pinned", "pinned"), 2)
        assert bands == ([[Decimal(4), 0, 0]], [[pytest.approx(Decimal(2) / 3), 0, 0]])
        assert (count_below(*bands, Decimal("5.999999")), count_below(*bands, Decimal("6.000001"))) == (0, 1)
        assert len(hermite_bands(("free", "guided"), 3)[0]) == 7


def test_textbook_solvers_lose_what_the_factored_form_keeps(titanium_strip):
    """Compared subjects: sparse shift-invert and banded LAPACK on the assembled K, at 3000 clamped links."""
    from scipy.linalg import eig_banded
    from scipy.sparse.linalg import eigsh

    beam = replace(titanium_strip, supports=("clamped", "free"))
    chain = segment_model.build_chain(beam, 3000)
    pencil = segment_model.chain_pencil(chain)
    strain, mass = pencil.strain_matrix(), pencil.mass_matrix()
    assembled = (strain.T * pencil.stiffness) @ strain

    def hertz(value):
        return float(np.sqrt(abs(value)) * beam.wave_constant / (2 * np.pi) / chain.unit**2)

    plain = eigsh(assembled.tocsc(), k=3, M=mass, sigma=0, v0=np.ones(pencil.n), return_eigenvectors=False).min()
    bands = np.array([np.append(assembled.diagonal(k), np.zeros(k)) for k in range(3)])
    lumped = eig_banded(bands, lower=True, eigvals_only=True, select="i", select_range=(0, 0))[0]
    own = segment_model.solve_modes(beam, 3, 3000).frequencies_hz[0]
    assert eigenvalue_error(beam, "segment", 3000, 1, own) <= 1e-13
    assert eigenvalue_error(beam, "segment", 3000, 1, hertz(plain)) > 1e-9
    assert eigenvalue_error(beam, "segment", 3000, 1, hertz(lumped)) > 1e-9


def test_scikit_fems_own_hermite_element_loses_precision_with_the_size():
    """Compared subject: its Vandermonde matrix in global coordinates against the element mapped from the reference cell."""
    from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine

    @BilinearForm
    def bending(u, v, w):
        return u.hess[0, 0] * v.hess[0, 0]

    def worst(count):
        stock = bending.assemble(Basis(MeshLine(np.linspace(0, 1, count + 1)), ElementLineHermite(), intorder=6))
        ours = stiffness_matrix(basis_between(np.linspace(0, 1, count + 1)), np.ones(count))
        exact = 12.0 * count**3
        return abs(stock[2 * count, 2 * count] / exact - 1), abs(ours[2 * count, 2 * count] / exact - 1)

    (stock_49, ours_49), (stock_1000, ours_1000) = worst(49), worst(1000)
    assert max(ours_49, ours_1000) < 1e-13
    assert stock_49 > 1e-13
    assert stock_1000 > 100 * stock_49


def test_a_chain_too_short_for_the_judge_is_refused():
    with pytest.raises(InputError, match="6 or more"):
        chain_bands(("clamped", "free"), 5)
