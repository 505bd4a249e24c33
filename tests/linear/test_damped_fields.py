"""Driven pencils with their dampings against matrices written out and solved densely."""

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh

from verify.attached import PointMass
from verify.beam import Beam, PointForce
from verify.elements import linear as fem_beam
from verify.elements import sweeps as fem_sweeps
from verify.elements.mesh import build_elements
from verify.elements.pencil import damped_stiffness, element_pencil
from verify.errors import InputError
from verify.exact.modes import solve_modes as exact_modes
from verify.models.driven_pencil import damped_response, modal_receptance, probed, refuse_near_resonance
from verify.models.response import forced_response
from verify.section import Section
from verify.segments import linear as segment_model
from verify.segments import sweeps as segment_sweeps
from verify.segments.assembly import build_chain, chain_pencil

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
        omega2 = frequency**2 * scale
        free = forced_response(pencil, probed(pencil, loads_of(pencil.n)), omega2, pencil.stiffness.astype(complex))
        refuse_near_resonance(model, CLAMPED, pencil, omega2, frequency, solver.solve_modes, 20, free)

    for near in (hertz, hertz * (1 + 0.8e-9), hertz * (1 - 0.8e-9)):
        with pytest.raises(
            InputError, match=rf"undamped resonance of mode {mode} of the {model} model at {hertz!r} Hz"
        ):
            ask(near)
    for beside in (hertz * (1 + 1.3e-9), hertz * (1 - 1.3e-9), 1.01 * hertz):
        ask(beside)


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


def lossy(model, beam, n, settings):
    """(pencil, D with the beam's loss), as the model's driven verbs make them."""
    if model == "fem":
        elements, pencil = fem_beam.driven(beam, n, 1.0, settings.get("theory", "euler-bernoulli"))
        return pencil, damped_stiffness(elements, pencil)
    given = {"wall": "gregory", "joints": "series", "grading": 1.0, "theory": "euler-bernoulli"}
    chain, pencil = segment_model.driven(beam, n, given | {"attachment": "reciprocal"} | settings)
    return pencil, segment_model.damped(beam, chain, pencil, 0.0)


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
    sweeps = {"segment": segment_sweeps, "fem": fem_sweeps}
    for model, module in {"segment": segment_model, "fem": fem_beam}.items():
        field = module.solve_harmonic(beam, force, 83.0, 80, modal_damping=0.03, theory=theory)
        assert field.deflection(x) == pytest.approx(summed, rel=1e-3)
        sweep = sweeps[model].sweep_harmonic(beam, force, [80.0, 83.0], 80, modal_damping=0.03, theory=theory)
        assert sweep.deflection(x)[1] == pytest.approx(field.deflection(x), rel=1e-12)
