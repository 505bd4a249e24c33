"""Three models of every beam against matrices and transfer matrices written out independently (`tests/reference`)."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import ARM, BAR, BEAMS, FORCES, HELD, LADEN, PAIRS, SECTIONS, STRIP
from tests.reference import dense, transfer
from verify import analytic_modes, fem_beam, segment_model

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
    for hertz in analytic_modes.solve_modes(beam, 6).frequencies_hz[[2, 3, 5]]:
        assert transfer.has_frequency_within(beam, EULER, float(hertz), 1e-14)


@every(BEAMS)
def test_no_exact_frequency_is_missed(name):
    elements = dense.Elements(BEAMS[name], fem_beam.solve_modes(BEAMS[name], 1, 90).nodes)
    exact = analytic_modes.solve_modes(BEAMS[name], 9).frequencies_hz
    assert elements.frequencies_hz(9) == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("theory", THICK)
@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_thick_beams_have_the_roots_of_their_theory(supports, theory):
    beam = replace(BAR, supports=supports)
    for hertz in analytic_modes.solve_modes(beam, 5, theory=theory).frequencies_hz[[0, 2, 4]]:
        assert transfer.has_frequency_within(beam, theory, float(hertz), 2e-14)


@every(["free-guided", "stepped", "tip-mass", "tension-masses"])
def test_exact_shapes_are_those_of_the_transfer(name):
    beam = BEAMS[name]
    x = X * beam.length
    hertz = float(analytic_modes.solve_modes(beam, 4).frequencies_hz[3])
    expected = transfer.shape(replace(beam, loss_factor=0.0), EULER, hertz, x)
    assert analytic_modes.mode_shape(beam, 4, x) == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["pinned-pinned", "clamped-free", "guided-pinned", *LADEN])
def test_exact_fields_are_those_of_the_transfer(name):
    beam = BEAMS[name]
    x = X[[1, 3]] * beam.length
    expected = transfer.deflection(beam, EULER, HERTZ, FORCES, x, digits=30)
    found = analytic_modes.solve_harmonic(beam, FORCES, HERTZ).deflection(x)
    assert found == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@pytest.mark.parametrize("theory", THICK)
def test_thick_fields_deflect_and_turn_as_the_transfer(theory):
    beam = replace(BAR, supports=("clamped", "free"), loss_factor=0.02)
    force = replace(FORCES[0], position=0.31, amplitude=1.0, phase_deg=0.0)
    field = analytic_modes.solve_harmonic(beam, [force], 2311.0, theory=theory)
    expected = transfer.state(beam, theory, 2311.0, 0.31, 0.17)
    assert field.deflection(0.17)[0] == pytest.approx(expected[0], rel=1e-11)
    assert field.turn(0.17)[0] == pytest.approx(expected[1], rel=1e-11)


@every(["clamped-free", "clamped-pinned", "stepped", "springs", "foundation"])
def test_exact_buckling_load_is_a_root(name):
    beam = replace(BEAMS[name], tension=0.0)
    load = analytic_modes.buckling_load(beam)
    assert transfer.buckling_load(beam, load) == pytest.approx(load, rel=1e-11)


# --- Hermite elements against the textbook's matrices ----------------------------------------------------------------


@every(BEAMS)
def test_elements_are_the_textbooks(name):
    beam = BEAMS[name]
    modes = fem_beam.solve_modes(beam, 5, 14)
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
    field = fem_beam.solve_harmonic(beam, FORCES, HERTZ, 14, modal_damping=damping)
    written = dense.Elements(beam, fem_beam.solve_modes(beam, 1, 14).nodes)
    vector = written.harmonic(written.load(FORCES), HERTZ, damping)
    for derivative in (0, 1):
        expected = written.values_at(vector, X * beam.length, derivative)
        found = field.derivative(X * beam.length, derivative) if derivative else field.deflection(X * beam.length)
        assert found == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["clamped-free", "stepped", "springs", "foundation"])
def test_elements_buckle_as_the_textbooks(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = dense.Elements(beam, fem_beam.solve_modes(beam, 1, 14).nodes)
    assert fem_beam.buckling_load(beam, 14) == pytest.approx(written.buckling(written.geometric), rel=1e-9)


@pytest.mark.parametrize("beam", [replace(BAR, supports=("clamped", "free")), replace(BAR, foundation=2e7)])
def test_sheared_elements_are_tied_polynomials(beam):
    modes = fem_beam.solve_modes(beam, 5, 9, theory="timoshenko")
    written = dense.TimoshenkoElements(beam, modes.nodes)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-9)


# --- Rigid links against springs and masses written out --------------------------------------------------------------


@pytest.mark.parametrize("wall", ["gregory", "half"])
@every([*("-".join(pair) for pair in PAIRS), "stepped", "tension", "compression", "foundation", "losses"])
def test_links_are_springs_and_masses(name, wall):
    beam = BEAMS[name]
    modes = segment_model.solve_modes(beam, 5, 17, wall=wall)
    joints = dense.GREGORY if wall == "gregory" else np.array([0.5])
    written = dense.Links(beam, modes.nodes, joints)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-10)


@every(["masses", "springs", "masses-springs-steps", "tip-mass"])
def test_attachments_by_lever_move_with_their_link(name):
    beam = LADEN[name]
    modes = segment_model.solve_modes(beam, 5, 17, attachment="lever")
    written = dense.Links(beam, modes.nodes)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(5), rel=1e-10)


@pytest.mark.parametrize("damping", [0.0, 0.021])
@every(["pinned-pinned", "clamped-free", "guided-pinned", "tension", "foundation"])
def test_driven_links_share_forces_on_four_joints(name, damping):
    beam = BEAMS[name]
    field = segment_model.solve_harmonic(beam, FORCES, HERTZ, 23, modal_damping=damping)
    written = dense.ReciprocalLinks(beam, np.linspace(0.0, beam.length, 24))
    vector = written.harmonic(written.load(FORCES), HERTZ, damping)
    expected = written.values_at(vector, X * beam.length, 0)
    assert field.deflection(X * beam.length) == pytest.approx(expected, abs=1e-8 * abs(expected).max())


@every(["clamped-free", "clamped-pinned", "stepped", "foundation"])
def test_links_buckle_as_their_joints(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = dense.Links(beam, segment_model.solve_modes(beam, 1, 17).nodes)
    assert segment_model.buckling_load(beam, 17) == pytest.approx(written.buckling(written.geometric), rel=1e-9)


# --- What all three share --------------------------------------------------------------------------------------------

MODELS = [
    pytest.param(lambda verb: getattr(analytic_modes, verb), (), id="exact"),
    pytest.param(lambda verb: getattr(segment_model, verb), (23,), id="segment"),
    pytest.param(lambda verb: getattr(fem_beam, verb), (14,), id="fem"),
]


@pytest.mark.parametrize(("verb", "count"), MODELS)
@every(["clamped-free", "masses-springs-steps", "tension-masses"])
def test_a_sweep_is_its_single_fields(name, verb, count):
    x, hertz = X * BEAMS[name].length, (97.0, 613.0, 1409.0)
    sweep = verb("sweep_harmonic")(BEAMS[name], FORCES, hertz, *count)
    single = [verb("solve_harmonic")(BEAMS[name], FORCES, f, *count).deflection(x) for f in hertz]
    assert sweep.deflection(x) == pytest.approx(np.array(single), rel=1e-8)


@pytest.mark.parametrize(("verb", "count"), MODELS)
def test_modes_of_many_beams_are_those_of_each(verb, count):
    beams = [HELD, replace(HELD, thickness=0.0031), replace(ARM, section=SECTIONS), LADEN["masses"]]
    single = [verb("solve_modes")(beam, 4, *count).frequencies_hz for beam in beams]
    assert verb("sweep_modes")(beams, 4, *count) == pytest.approx(np.array(single), rel=1e-12)


@pytest.mark.parametrize(("verb", "count"), MODELS)
def test_unit_responses_are_fields_of_unit_forces(verb, count):
    beam, x = LADEN["tension"], X * STRIP.length
    found = verb("unit_responses")(beam, [0.21, 0.57], [211.0, 613.0], x, *count)
    for i, at in enumerate((0.21, 0.57)):
        force = replace(FORCES[0], position=at, amplitude=1.0, phase_deg=0.0)
        assert found[1, i] == pytest.approx(
            verb("solve_harmonic")(beam, [force], 613.0, *count).deflection(x), rel=1e-7
        )


@pytest.mark.parametrize(("verb", "count"), MODELS)
@every(["masses-springs-steps", "losses", "tension"])
def test_force_and_deflection_are_reciprocal(name, verb, count):
    beam = BEAMS[name]
    if count == (23,):
        count = (200,)  # links share forces and read deflections by different weights, both of order four
    one, other = (replace(FORCES[0], position=at, amplitude=1.0, phase_deg=0.0) for at in (0.193, 0.541))
    there = verb("solve_harmonic")(beam, [one], HERTZ, *count).deflection(0.541)
    here = verb("solve_harmonic")(beam, [other], HERTZ, *count).deflection(0.193)
    assert there == pytest.approx(here, rel=1e-3 if count == (200,) else 1e-8)


@every(["clamped-pinned", "masses", "tension-masses"])
def test_modes_in_time_add_up_to_the_field(name):
    beam, x = BEAMS[name], X * STRIP.length
    basis, omega = fem_beam.time_basis(beam, 23), 2.0 * np.pi * HERTZ
    modes = fem_beam.solve_modes(beam, len(basis.omegas), 23)
    assert np.asarray(basis.omegas) == pytest.approx(2.0 * np.pi * modes.frequencies_hz, rel=1e-9)
    loads = sum(f.amplitude * np.exp(1j * np.deg2rad(f.phase_deg)) * modes.deflection(f.position)[:, 0] for f in FORCES)
    summed = (loads / (np.asarray(basis.omegas) ** 2 - omega**2)) @ modes.deflection(x)
    assert fem_beam.solve_harmonic(beam, FORCES, HERTZ, 23).deflection(x) == pytest.approx(summed, rel=1e-6)
