"""Driven pencils with their dampings against matrices written out and solved densely."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh
from scipy.sparse import diags_array

from verify.beam import Beam
from verify.elements import linear as fem_beam
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.errors import InputError
from verify.models.driven_pencil import check_dense, damped_response, modal_receptance, probed, refuse_near_resonance
from verify.models.eigen import distance_answered, forced_response, resonance_distance
from verify.models.pencil import on_diagonals
from verify.segments import linear as segment_model
from verify.segments.links import build_chain, chain_pencil

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
CLAMPED = replace(STRIP, supports=("clamped", "free"))


def pencils(beam, n):
    return {"segment": chain_pencil(build_chain(beam, n)), "fem": element_pencil(build_elements(beam, n))}


def matrices(pencil):
    """K and M, assembled."""
    strain, mass = pencil.strain(np.eye(pencil.n)), pencil.mass_matrix()
    return strain.T @ (pencil.stiffness[:, None] * strain), mass.toarray() if hasattr(mass, "toarray") else mass


def loads_of(n):
    """Two uneven loads, complex."""
    load = np.zeros((n, 1), dtype=complex)
    load[2, 0], load[n - 4, 0] = 0.7 - 0.2j, 0.3 + 0.9j
    return load


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("eta", [0.0, 0.09])
@pytest.mark.parametrize("ratio", [0.037, 0.81])
@pytest.mark.parametrize("beam", [STRIP, CLAMPED], ids=["pinned", "clamped-free"])
def test_one_ratio_in_every_mode_is_the_matrix_that_damps_every_mode_alike(beam, model, eta, ratio):
    """(K (1 + i eta) + i omega C - omega^2 M) w = F with C = M Phi diag(2 zeta omega_n) Phi^T M, all dense."""
    pencil = pencils(beam, 17)[model]
    stiffness, mass = matrices(pencil)
    values, shapes = eigh(stiffness, mass)
    damping = mass @ shapes @ np.diag(2 * ratio * np.sqrt(values)) @ shapes.T @ mass
    for omega2 in (0.3 * values[0], 0.5 * (values[3] + values[4]), 1.02 * values[7]):
        expected = np.linalg.solve(
            stiffness * (1 + 1j * eta) + 1j * np.sqrt(omega2) * damping - omega2 * mass, loads_of(pencil.n)
        )
        found = damped_response(pencil, loads_of(pencil.n), omega2, pencil.stiffness * (1 + 1j * eta), ratio)
        assert found == pytest.approx(expected, rel=2e-8, abs=1e-9 * abs(expected).max())


def test_dashpots_and_a_ratio_add_up_where_all_joints_are_alike():
    """Pinned ends: every joint has the same spring, so that dashpots leave the modes as they are."""
    pencil = pencils(STRIP, 17)["segment"]
    stiffness, mass = matrices(pencil)
    values, shapes = eigh(stiffness, mass)
    omega2, eta, dashpot, ratio = 1.02 * values[5], 0.03, 0.021, 0.017
    strain = pencil.strain(np.eye(pencil.n))
    damped = stiffness * (1 + 1j * eta) + 1j * dashpot * strain.T @ strain
    damping = mass @ shapes @ np.diag(2 * ratio * np.sqrt(values)) @ shapes.T @ mass
    expected = np.linalg.solve(damped + 1j * np.sqrt(omega2) * damping - omega2 * mass, loads_of(pencil.n))
    found = damped_response(pencil, loads_of(pencil.n), omega2, pencil.stiffness * (1 + 1j * eta) + 1j * dashpot, ratio)
    assert found == pytest.approx(expected, rel=2e-8)
    without = damped_response(pencil, loads_of(pencil.n), omega2, pencil.stiffness * (1 + 1j * eta), ratio)
    assert abs(without - found).max() > 0.05 * abs(found).max()


@pytest.mark.parametrize("dashpot", [1e-6, 0.021])
def test_dashpots_beside_a_wall_couple_the_modes_and_are_refused_together_with_a_ratio(dashpot):
    pencil = pencils(CLAMPED, 17)["segment"]
    unequal = pencil.stiffness + 1j * dashpot
    with pytest.raises(InputError, match="joint_dashpot and modal_damping together"):
        damped_response(pencil, loads_of(pencil.n), 0.3, unequal, 0.02)
    alone = damped_response(pencil, loads_of(pencil.n), 0.3, unequal, 0.0)
    assert alone == pytest.approx(forced_response(pencil, loads_of(pencil.n), 0.3, unequal), rel=1e-13)


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("eta", [0.0, 0.09])
def test_the_sum_over_all_modes_is_the_response_solved_directly(model, eta):
    """Shares of every mode at several frequencies and under several loads, with their sign."""
    pencil = pencils(CLAMPED, 17)[model]
    stiffness, mass = matrices(pencil)
    values = eigh(stiffness, mass, eigvals_only=True)
    omega2 = np.array([0.3 * values[0], 0.5 * (values[3] + values[4]), 1.02 * values[7]])
    weights = np.stack([loads_of(pencil.n)[:, 0].real, loads_of(pencil.n)[:, 0].imag], axis=1)
    modes, shares = modal_receptance(pencil, weights, omega2, eta)
    assert shares.shape == (3, 2, pencil.n)
    for i, w2 in enumerate(omega2):
        expected = np.linalg.solve(stiffness * (1 + 1j * eta) - w2 * mass, weights)
        assert modes @ shares[i].T == pytest.approx(expected, rel=2e-8, abs=1e-9 * abs(expected).max())


def test_a_sum_over_modes_has_no_value_at_an_undamped_resonance_and_one_beside_it():
    pencil = pencils(STRIP, 17)["segment"]
    values = eigh(*matrices(pencil), eigvals_only=True)
    omega2 = values[4] * np.array([1.0, 1.0 + 1e-6, 1.3])
    weights = loads_of(pencil.n).real
    _, shares = modal_receptance(pencil, weights, omega2, 0.0)
    assert np.isnan(shares[0]).all()
    assert np.isfinite(shares[1:]).all()
    assert np.isfinite(modal_receptance(pencil, weights, omega2, 1e-4)[1]).all()


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("mode", [1, 6, 15])
def test_a_resonance_is_refused_by_its_number_and_frequency_and_none_beside_it(model, mode):
    """Up to 2e-9 of omega^2, which is 1e-9 of the frequency."""
    solver = {"segment": segment_model, "fem": fem_beam}[model]
    pencil = pencils(CLAMPED, 20)[model]
    hertz = float(solver.solve_modes(CLAMPED, 16, 20).frequencies_hz[mode - 1])
    scale = (2 * np.pi / CLAMPED.wave_constant) ** 2 * (CLAMPED.length / 20) ** 4

    def ask(frequency):
        refuse_near_resonance(model, CLAMPED, pencil, frequency**2 * scale, frequency, solver.solve_modes, 20)

    for near in (hertz, hertz * (1 + 0.8e-9), hertz * (1 - 0.8e-9)):
        with pytest.raises(
            InputError, match=rf"undamped resonance of mode {mode} of the {model} model at {hertz!r} Hz"
        ):
            ask(near)
    for beside in (hertz * (1 + 1.3e-9), hertz * (1 - 1.3e-9), 1.01 * hertz):
        ask(beside)


def test_all_modes_are_taken_up_to_the_dense_size_and_not_beyond():
    within, beyond = pencils(STRIP, 1001)["segment"], pencils(STRIP, 1002)["segment"]
    assert (within.n, beyond.n) == (1000, 1001)
    check_dense(within, "this")
    with pytest.raises(InputError, match=r"^this takes all 1001 modes of the model: lower count to 250 or less"):
        check_dense(beyond, "this")
    for ask in (
        lambda: modal_receptance(beyond, np.ones((1001, 1)), np.ones(1), 0.1),
        lambda: damped_response(beyond, np.ones((1001, 1)), 1.0, beyond.stiffness + 0j, 0.1),
    ):
        with pytest.raises(InputError, match="takes all 1001 modes"):
            ask()


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_one_factorisation_answers_a_drive_and_how_far_its_resonance_is(model):
    """The drive as by itself to the last digit; the distance near the fifth mode is that distance."""
    pencil = pencils(CLAMPED, 23)[model]
    values, stiffness = eigh(*matrices(pencil), eigvals_only=True), pencil.stiffness.astype(complex)
    for omega2, near in ((values[4] * (1.0 - 3e-7), 3e-7), (values[4] * (1.0 + 2e-6), -2e-6), (1.2 * values[7], None)):
        both = damped_response(pencil, probed(pencil, loads_of(pencil.n)), omega2, stiffness, 0.0)
        alone = damped_response(pencil, loads_of(pencil.n), omega2, stiffness, 0.0)
        assert both.shape == (pencil.n, 2)
        assert np.array_equal(both[:, :1], alone)
        found = distance_answered(pencil, both[:, 1].real, omega2)
        assert found == pytest.approx(resonance_distance(pencil, omega2), rel=1e-6)
        assert near is None or found == pytest.approx(near, rel=1e-3)


@pytest.mark.parametrize(
    ("values", "shape"),
    [
        ({0: [1.5, -2.0, 0.25]}, None),
        ({-1: [3.0, 4.0], 0: [1.0, 2.0j, 5.0], 1: [-7.0, 8.0]}, None),
        ({0: [1.0, 2.0], 1: [3.0, 4.0]}, (2, 3)),
        ({-2: [5.0, 6.0, 7.0]}, (5, 3)),
        ({3: []}, (0, 3)),
    ],
)
def test_diagonals_lie_where_scipy_lays_them(values, shape):
    found = on_diagonals({above: np.array(each) for above, each in values.items()}, shape)
    if shape == (0, 3):
        assert found.shape == shape
        return
    known = diags_array(list(values.values()), offsets=list(values), shape=shape, dtype=found.dtype)
    assert found.shape == known.shape
    assert np.array_equal(found.toarray(), known.toarray())
