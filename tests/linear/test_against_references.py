"""Three models of every beam against matrices and transfer matrices written out independently (`tests/reference`)."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BAR, BEAMS, FORCES, LADEN, PAIRS, STRIP
from tests.reference import dense, transfer
from verify.analytic_modes import ExactModel
from verify.fem_beam import HermiteModel
from verify.problem.beam import PointForce
from verify.problem.device import Device
from verify.segment_model import SegmentModel

X = np.array([0.13, 0.37, 0.58, 0.81])
HERTZ = 613.0
EULER = "euler-bernoulli"
THICK = ("rayleigh", "timoshenko")


def every(beams):
    return pytest.mark.parametrize("name", beams)


# --- The exact beam against transfer matrices in 30 digits -----------------------------------------------------------


@every(BEAMS)
def test_exact_frequencies_are_roots(name):
    beam = replace(BEAMS[name], loss_factor=0.0)
    for hertz in ExactModel(beam).modes(6).frequencies_hz[[2, 3, 5]]:
        assert transfer.has_frequency_within(beam, EULER, float(hertz), 1e-14)


@every(BEAMS)
def test_no_exact_frequency_is_missed(name):
    elements = dense.Elements(BEAMS[name], HermiteModel(BEAMS[name], 90).modes(1).nodes)
    exact = ExactModel(BEAMS[name]).modes(9).frequencies_hz
    assert elements.frequencies_hz(9) == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("theory", THICK)
@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_thick_beams_have_the_roots_of_their_theory(supports, theory):
    beam = replace(BAR, supports=supports)
    for hertz in ExactModel(beam, theory).modes(5).frequencies_hz[[0, 2, 4]]:
        assert transfer.has_frequency_within(beam, theory, float(hertz), 2e-14)


@every(["free-guided", "stepped", "tip-mass", "tension-masses"])
def test_exact_shapes_are_those_of_the_transfer(name):
    beam = BEAMS[name]
    x = X * beam.length
    hertz = float(ExactModel(beam).modes(4).frequencies_hz[3])
    expected = transfer.shape(replace(beam, loss_factor=0.0), EULER, hertz, x)
    assert ExactModel(beam).mode_shape(4, x) == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["pinned-pinned", "clamped-free", "guided-pinned", *LADEN])
def test_exact_fields_are_those_of_the_transfer(name):
    beam = BEAMS[name]
    x = X[[1, 3]] * beam.length
    expected = transfer.deflection(beam, EULER, HERTZ, FORCES, x, digits=30)
    found = ExactModel(beam).harmonic(FORCES, HERTZ).deflection(x)
    assert found == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@pytest.mark.parametrize("theory", THICK)
def test_thick_fields_deflect_and_turn_as_the_transfer(theory):
    beam = replace(BAR, supports=("clamped", "free"), loss_factor=0.02)
    force = replace(FORCES[0], position=0.31, amplitude=1.0, phase_deg=0.0)
    field = ExactModel(beam, theory).harmonic([force], 2311.0)
    expected = transfer.state(beam, theory, 2311.0, 0.31, 0.17)
    assert field.deflection(0.17)[0] == pytest.approx(expected[0], rel=1e-11)
    assert field.rotation(0.17)[0] == pytest.approx(expected[1], rel=1e-11)


@every(["clamped-free", "clamped-pinned", "stepped", "springs", "foundation"])
def test_exact_buckling_load_is_a_root(name):
    beam = replace(BEAMS[name], tension=0.0)
    load = ExactModel(beam).buckling_load()
    assert transfer.buckling_load(beam, load) == pytest.approx(load, rel=1e-11)


# --- Hermite elements against the textbook's matrices ----------------------------------------------------------------


@every(BEAMS)
def test_elements_are_the_textbooks(name):
    beam = BEAMS[name]
    modes = HermiteModel(beam, 14).modes(5)
    written = dense.Elements(beam, modes.nodes)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-8)
    _, vectors = written.modes
    shape = written.values_at(vectors[:, beam.rigid_motions + 2], X * beam.length, 0)
    found = modes.deflection(X * beam.length)[2]
    assert found == pytest.approx(shape * np.sign(shape @ found), abs=1e-7 * abs(shape).max())


@every(LADEN)
@pytest.mark.parametrize("damping", [0.0, 0.021])
def test_driven_elements_are_the_textbooks(name, damping):
    if damping and name == "losses":
        damping = 0.0
    beam = LADEN[name]
    field = HermiteModel(beam, 14).harmonic(FORCES, HERTZ, modal_damping=damping)
    written = dense.Elements(beam, HermiteModel(beam, 14).modes(1).nodes)
    vector = written.harmonic(written.load(FORCES), HERTZ, damping)
    for derivative in (0, 1):
        expected = written.values_at(vector, X * beam.length, derivative)
        found = field.derivative(X * beam.length, derivative) if derivative else field.deflection(X * beam.length)
        assert found == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["clamped-free", "stepped", "springs", "foundation"])
def test_elements_buckle_as_the_textbooks(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = dense.Elements(beam, HermiteModel(beam, 14).modes(1).nodes)
    assert HermiteModel(beam, 14).buckling_load() == pytest.approx(written.buckling(written.geometric), rel=1e-9)


@pytest.mark.parametrize("beam", [replace(BAR, supports=("clamped", "free")), replace(BAR, foundation=2e7)])
def test_sheared_elements_are_tied_polynomials(beam):
    modes = HermiteModel(beam, 9, theory="timoshenko").modes(5)
    written = dense.TimoshenkoElements(beam, modes.nodes)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-9)


# --- Rigid links against springs and masses written out --------------------------------------------------------------


@pytest.mark.parametrize("wall", ["gregory", "half"])
@every([*("-".join(pair) for pair in PAIRS), "stepped", "tension", "compression", "foundation", "losses"])
def test_links_are_springs_and_masses(name, wall):
    beam = BEAMS[name]
    modes = SegmentModel(beam, 17, wall=wall).modes(5)
    joints = dense.GREGORY if wall == "gregory" else np.array([0.5])
    written = dense.Links(beam, modes.nodes, joints)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-10)


@every(["masses", "springs", "masses-springs-steps", "tip-mass"])
def test_attachments_by_lever_move_with_their_link(name):
    beam = LADEN[name]
    modes = SegmentModel(beam, 17, attachment="lever").modes(5)
    written = dense.Links(beam, modes.nodes)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-10)


@pytest.mark.parametrize("damping", [0.0, 0.021])
@every(["pinned-pinned", "clamped-free", "guided-pinned", "tension", "foundation"])
def test_driven_links_share_forces_on_four_joints(name, damping):
    beam = BEAMS[name]
    field = SegmentModel(beam, 23).harmonic(FORCES, HERTZ, modal_damping=damping)
    written = dense.ReciprocalLinks(beam, np.linspace(0.0, beam.length, 24))
    vector = written.harmonic(written.load(FORCES), HERTZ, damping)
    expected = written.values_at(vector, X * beam.length, 0)
    assert field.deflection(X * beam.length) == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["clamped-free", "clamped-pinned", "stepped", "foundation"])
def test_links_buckle_as_their_joints(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = dense.Links(beam, SegmentModel(beam, 17).modes(1).nodes)
    assert SegmentModel(beam, 17).buckling_load() == pytest.approx(written.buckling(written.geometric), rel=1e-9)


# --- What all three share --------------------------------------------------------------------------------------------

MODELS = {
    "exact": ExactModel,
    "segment": lambda beam, **settings: SegmentModel(beam, 23, **settings),
    "fem": lambda beam, **settings: HermiteModel(beam, 14, **settings),
}
DEVICE = Device(position=0.21, stiffness=310.0, mass=1.7e-3, dashpot=2.3, rotational=0.4, rotational_dashpot=3e-4)


@every(MODELS)
@pytest.mark.parametrize("beam", ["clamped-free", "masses-springs-steps", "tension-masses"])
def test_a_sweep_is_its_single_fields(name, beam):
    model, x, hertz = MODELS[name](BEAMS[beam]), X * BEAMS[beam].length, (97.0, 613.0, 1409.0)
    single = [model.harmonic(FORCES, f).deflection(x) for f in hertz]
    assert model.harmonic(FORCES, hertz).deflection(x) == pytest.approx(np.array(single), rel=1e-8)


@every(MODELS)
def test_receptances_are_fields_of_unit_forces(name):
    model, x = MODELS[name](LADEN["tension"]), X * STRIP.length
    found = model.receptance([0.21, 0.57], [211.0, 613.0], x)
    for i, at in enumerate((0.21, 0.57)):
        assert found[1, i] == pytest.approx(model.harmonic(PointForce(position=at), 613.0).deflection(x), rel=1e-7)


@every(MODELS)
@pytest.mark.parametrize("beam", ["masses-springs-steps", "losses", "tension"])
def test_force_and_deflection_are_reciprocal(name, beam):
    model = SegmentModel(BEAMS[beam], 200) if name == "segment" else MODELS[name](BEAMS[beam])
    there = model.harmonic(PointForce(position=0.193), HERTZ, devices=DEVICE).deflection(0.541)
    here = model.harmonic(PointForce(position=0.541), HERTZ, devices=DEVICE).deflection(0.193)
    # links share forces and read deflections by different weights, both of order four
    assert there == pytest.approx(here, rel=1e-3 if name == "segment" else 1e-8)


@every(MODELS)
@pytest.mark.parametrize("loss_factor", [0.0, 0.013])
def test_forces_of_imposed_displacements_impose_them(name, loss_factor):
    model = MODELS[name](replace(LADEN["stepped"], loss_factor=loss_factor))
    drives = [PointForce(position=0.17, amplitude=2e-6), PointForce(position=0.53, amplitude=3e-6, phase_deg=71.0)]
    field = model.imposed(drives, HERTZ, devices=DEVICE)
    by_forces = model.harmonic(field.forces[:2], HERTZ, devices=DEVICE)
    for one in (field, by_forces):
        assert one.deflection([0.17, 0.53]) == pytest.approx([2e-6, 3e-6 * np.exp(1j * np.deg2rad(71.0))], rel=1e-8)


@every(MODELS)
def test_forces_of_devices_act_with_imposed_displacements(name):
    """The exact field, with a rotational device as well; all three models agree."""
    device, beam = replace(DEVICE, amplitude=0.13, phase_deg=-19.0), LADEN["stepped"]
    drives = [PointForce(position=0.17, amplitude=2e-6, phase_deg=13.0)]
    model = {"exact": ExactModel(beam), "segment": SegmentModel(beam, 400), "fem": HermiteModel(beam, 60)}[name]
    field, exact = (one.imposed(drives, HERTZ, devices=device) for one in (model, ExactModel(beam)))
    without = model.imposed(drives, HERTZ, devices=DEVICE).deflection(X[1])
    assert field.deflection(0.17) == pytest.approx(2e-6 * np.exp(1j * np.deg2rad(13.0)), rel=1e-9)
    assert field.deflection(X[1]) == pytest.approx(exact.deflection(X[1]), rel=3e-3)
    assert abs(field.deflection(X[1]) / without - 1.0) > 0.1
    assert [one.position for one in field.forces] == [0.17, 0.21, 0.21]
    assert field.forces[1].amplitude == 0.13


@every(["clamped-pinned", "masses", "tension-masses"])
def test_modes_in_time_add_up_to_the_field(name):
    model, x, omega = HermiteModel(BEAMS[name], 23), X * STRIP.length, 2.0 * np.pi * HERTZ
    basis = model.time_basis()
    modes = model.modes(len(basis.omegas))
    assert np.asarray(basis.omegas) == pytest.approx(2.0 * np.pi * modes.frequencies_hz, rel=1e-9)
    loads = sum(f.amplitude * np.exp(1j * np.deg2rad(f.phase_deg)) * modes.deflection(f.position)[:, 0] for f in FORCES)
    summed = (loads / (np.asarray(basis.omegas) ** 2 - omega**2)) @ modes.deflection(x)
    assert model.harmonic(FORCES, HERTZ).deflection(x) == pytest.approx(summed, rel=1e-6)
