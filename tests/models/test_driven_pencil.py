"""Driven pencils with their dampings against matrices written out and solved densely."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh
from scipy.sparse import csc_array, diags_array

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.elements import linear as fem_beam
from verify.elements.mesh import build_elements
from verify.elements.pencil import damped_stiffness, element_pencil
from verify.errors import InputError
from verify.exact.modes import solve_modes as exact_modes
from verify.models.driven_pencil import check_dense, harmonic_response, modal_receptance
from verify.models.pencil import bordered, soft_scales
from verify.models.response import forced_response
from verify.section import Section
from verify.segments import linear as segment_model
from verify.segments.assembly import build_chain, chain_pencil

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
CLAMPED = replace(STRIP, supports=("clamped", "free"))


def damped_response(pencil, loads, omega2, stiffness, ratio):
    """The response at one frequency, (n, 1)."""
    return harmonic_response(pencil, np.asarray(loads, dtype=complex), np.array([omega2]), stiffness, ratio)


def test_a_mixed_matrix_is_scaled_by_the_powers_of_two_that_its_answers_are_scaled_back_by():
    """Of springs to either side of where the power changes: of twice another's, its answer would be twice as large."""
    springs = np.array([0.3, 0.125 * 0.9995, 0.125 * 1.0005, 7.0, 2.0**-9 * 0.9998])
    strain = np.random.default_rng(41).normal(size=(5, 3))
    scales = soft_scales(springs)
    assert list(scales) == [0.5, 0.25, 0.5, 1.0, 2.0**-5]
    corner = np.diag([0.7, -0.2, 1.9])
    found = bordered(-1.0 / springs, csc_array(strain), csc_array(corner)).toarray()
    rows = scales[:, None] * strain
    assert found == pytest.approx(np.block([[np.diag(-(scales**2) / springs), rows], [rows.T, corner]]), rel=1e-15)


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
    hertz = float(solver.solve_modes(CLAMPED, 16, 20).frequencies_hz[mode - 1])

    def ask(frequency):
        solver.solve_harmonic(CLAMPED, PointForce(position=0.2), frequency, 20)

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


L = 0.8
CARRIER = Beam(
    length=L,
    width=0.02,
    thickness=0.04,
    youngs_modulus=70e9,
    density=2700.0,
    supports=("clamped", "free"),
    loss_factor=0.05,
)
BODY, TIP = PointMass(position=0.33, mass=0.5), PointMass(position=L, mass=0.3, rotary_inertia=2e-3)
CARRIED = {
    "nothing": {},
    "a mass": {"mass": (BODY,)},
    "bodies that turn, inside and at an end": {"mass": (replace(BODY, rotary_inertia=1e-3), TIP)},
    "a step": {"section": (Section(length=0.3), Section(length=0.5, thickness=0.03))},
    "a body beyond a pin": {"supports": ("clamped", "pinned"), "mass": (replace(TIP, mass=0.0),)},
}
HELD = {
    "a spring": {"spring": (PointSpring(position=0.33, stiffness=4e4),)},
    "a spring against turning, at an end": {
        "supports": ("pinned", "free"),
        "spring": (PointSpring(position=0.0, rotational=3e3),),
    },
    "that with a body": {
        "supports": ("pinned", "free"),
        "mass": (replace(TIP, position=0.0, mass=0.0),),
        "spring": (PointSpring(position=0.0, rotational=3e3),),
    },
    "axial force": {"tension": 900.0},
    "ground": {"foundation": 5e4},
}
SETTINGS = [
    {},
    {"theory": "rayleigh", "joints": "tensioned"},
    {"theory": "timoshenko"},
    {"theory": "timoshenko", "joints": "tensioned"},
    {"attachment": "lever", "theory": "timoshenko"},
]


def lossy(model, beam, n, settings):
    """(pencil, D with the beam's loss), as the model's driven verbs make them."""
    if model == "fem":
        elements, pencil = fem_beam._driven(beam, n, 1.0, settings.get("theory", "euler-bernoulli"))
        return pencil, damped_stiffness(elements, pencil)
    given = {"wall": "gregory", "joints": "series", "grading": 1.0, "theory": "euler-bernoulli"}
    chain, pencil = segment_model._driven(beam, n, given | {"attachment": "reciprocal"} | settings)
    return pencil, segment_model.damped(beam, chain, pencil, 0.0)


@pytest.mark.parametrize("what", [*CARRIED, *HELD])
@pytest.mark.parametrize("settings", SETTINGS, ids=str)
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_everything_that_resists_has_one_loss_but_for_springs_axial_force_and_ground(what, settings, model):
    """One factor 1 + i eta on all of D leaves the modes as they are; that is what `lossless` says without any model."""
    beam = replace(CARRIER, **(CARRIED | HELD)[what])
    if beam.tension:  # there is more than one theory of a thick beam under axial force
        settings = {name: value for name, value in settings.items() if name != "theory"}
    pencil, damped = lossy(model, beam, 20, settings)
    alike = np.allclose(damped / pencil.stiffness, 1.0 + 0.05j, rtol=1e-13, atol=0.0)
    assert alike == (not beam.lossless) == (what in CARRIED)


@pytest.mark.parametrize("what", CARRIED)
@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_a_loss_and_a_ratio_together_are_the_system_solved_directly(what, theory, model):
    """(B^T D B + i omega C - omega^2 M) w = F with the model's own lossy D, and C = M Phi diag(2 zeta omega_n) Phi^T M."""
    module = {"segment": segment_model, "fem": fem_beam}[model]
    beam, zeta, hertz, x = replace(CARRIER, **CARRIED[what]), 0.03, 83.0, np.array([0.07, 0.33, 0.61])
    pencil, d = lossy(model, beam, 20, {"theory": theory})
    unit = beam.length / 20
    omega2 = (2 * np.pi * hertz / beam.wave_constant) ** 2 * unit**4
    strain, (stiffness, mass) = pencil.strain(np.eye(pencil.n)), matrices(pencil)
    values, shapes = eigh(stiffness, mass)
    damping = mass @ shapes @ np.diag(2 * zeta * np.sqrt(values)) @ shapes.T @ mass
    alone = strain.T @ (d[:, None] * strain) - omega2 * mass
    loads = loads_of(pencil.n)
    expected = np.linalg.solve(alone + 1j * np.sqrt(omega2) * damping, loads)
    found = damped_response(pencil, loads, omega2, d, zeta)
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-8 * abs(expected).max())
    field = module.solve_harmonic(beam, PointForce(position=0.2), hertz, 20, modal_damping=zeta, theory=theory)
    without = module.solve_harmonic(beam, PointForce(position=0.2), hertz, 20, theory=theory)
    assert abs(field.deflection(x) - without.deflection(x)).max() > 0.02 * abs(without.deflection(x)).max()


@pytest.mark.parametrize("what", CARRIED)
@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
def test_both_models_take_a_loss_beside_a_ratio_and_agree(what, theory):
    """Also with the exact beam's modes, each damped by its own 2 zeta omega_n omega and omega_n^2 eta, 40 of them."""
    beam, force, x = replace(CARRIER, **CARRIED[what]), PointForce(position=0.2, amplitude=1.7), np.array([0.33, 0.61])
    modes = exact_modes(beam, 40, theory=theory)
    own, omega = 2 * np.pi * modes.frequencies_hz, 2 * np.pi * 83.0
    shares = 1.7 * modes.deflection(0.2)[:, 0] / (own**2 * (1 + 0.05j) - omega**2 + 2j * 0.03 * own * omega)
    summed = shares @ modes.deflection(x)
    for module in (segment_model, fem_beam):
        field = module.solve_harmonic(beam, force, 83.0, 80, modal_damping=0.03, theory=theory)
        assert field.deflection(x) == pytest.approx(summed, rel=1e-3)
        sweep = module.sweep_harmonic(beam, force, [80.0, 83.0], 80, modal_damping=0.03, theory=theory)
        assert sweep.deflection(x)[1] == pytest.approx(field.deflection(x), rel=1e-12)


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_a_loss_beside_a_ratio_is_refused_by_the_names_of_what_loses_nothing(model):
    beam = replace(CARRIER, mass=(BODY,), tension=900.0, foundation=5e4)
    said = r"loss_factor = 0\.05 and modal_damping = 0\.03 together .* beside beam\.tension and beam\.foundation, "
    module = {"segment": segment_model, "fem": fem_beam}[model]
    with pytest.raises(InputError, match=said):
        module.solve_harmonic(beam, PointForce(position=0.2), 83.0, 20, modal_damping=0.03)
    with pytest.raises(InputError, match=said):
        module.sweep_harmonic(beam, PointForce(position=0.2), [83.0], 20, modal_damping=0.03)
    assert module.solve_harmonic(replace(beam, loss_factor=0.0), PointForce(position=0.2), 83.0, 20, modal_damping=0.03)
