"""Three models of all beams against matrices and transfer matrices written out independently (`tests/reference`)."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import BAR, BEAMS, DEVICES, FORCES, LADEN, MODELS, PAIRED, PAIRS, STRIP, close, over
from tests.reference import dense, transfer
from verify import Beam, ExactModel, HermiteModel, PointForce, PointMass, PointSpring, Section, SegmentModel
from verify.errors import InputError

X = np.array([0.13, 0.37, 0.58, 0.81])  # fractions of the length
HERTZ = 613.0
EULER = "euler-bernoulli"
THICK = ("rayleigh", "timoshenko")
OMEGA = 2.0 * np.pi * HERTZ


# --- The exact beam against transfer matrices in 30 digits -----------------------------------------------------------


EXTREME = {
    "taut": replace(STRIP, supports=("clamped", "clamped"), tension=2e4 * STRIP.bending_stiffness / STRIP.length**2),
    "on-soft-springs": replace(
        STRIP,
        supports=("free", "free"),
        spring=(soft := PointSpring(position=0.0, stiffness=19.0), replace(soft, position=0.73)),
    ),
}


@over(BEAMS | EXTREME)
def test_exact_frequencies_are_roots(name):
    beam = replace((BEAMS | EXTREME)[name], loss_factor=0.0)
    frequencies = ExactModel(beam).modes(23).frequencies_hz
    first = 3 if name == "free-on-foundation" else 1  # its first two coincide
    for mode in (first, 4, 6) if name in LADEN else (1, 2, 3, 7, 23):
        digits = 120 if name in EXTREME else 50  # e^140 in high tension
        assert transfer.has_frequency_within(beam, EULER, float(frequencies[mode - 1]), 1e-14, digits)


@over(BEAMS)
def test_the_exact_model_misses_no_frequency(name):
    elements = dense.Elements(BEAMS[name], HermiteModel(BEAMS[name], 90).modes(1).nodes)
    exact = ExactModel(BEAMS[name]).modes(9).frequencies_hz
    assert elements.frequencies_hz(9) == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("theory", THICK)
@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_thick_beams_have_the_roots_of_their_theory(supports, theory):
    """The fourth lies above the cut-off, where no part of a Timoshenko shape decays."""
    beam = replace(BAR, supports=supports)
    frequencies = ExactModel(beam, theory).modes(40).frequencies_hz
    own = beam.base_section
    assert frequencies[16] > np.sqrt(own.shear_stiffness / own.rotary_inertia) / (2 * np.pi)
    for hertz in frequencies[[0, 2, 4, 39]]:
        assert transfer.has_frequency_within(beam, theory, float(hertz), 2e-14)


@pytest.mark.parametrize(
    ("supports", "lengths"),
    [
        (("pinned", "free"), (0.11, 0.004, 0.03, 0.2, 0.007, 0.0011, 0.09, 0.05)),
        (("guided", "clamped"), (0.3, 0.0012, 0.02, 0.0009, 0.13, 0.004, 0.06, 0.11, 0.002, 0.01, 0.08)),
        (("free", "free"), (0.21, 1e-5, 0.17)),
        (("pinned", "pinned"), (0.21, 1e-6, 0.17)),
    ],
)
def test_short_sections_cost_no_digit(supports, lengths):
    """By an inertia count alone they cost five to ten: its stiffness grows as (L / shortest section)^3."""
    pieces = [
        Section(
            length=part,
            thickness=1e-3 * (1 + (3 * i) % 5),
            youngs_modulus=1e9 * (60 + (37 * i) % 211),
            density=900.0 + (1300 * i) % 7700,
        )
        for i, part in enumerate(lengths)
    ]
    beam = replace(STRIP, length=sum(lengths), section=tuple(pieces), supports=supports)
    for mode in (1, 2, 7, 24):
        assert transfer.has_frequency_within(beam, EULER, ExactModel(beam).frequency_hz(mode), 1e-14, 60)


def test_two_frequencies_that_nearly_coincide_are_separate_roots():
    pair = [ExactModel(PAIRED).frequency_hz(mode) for mode in (4, 5)]
    assert pair[1] / pair[0] - 1 == pytest.approx(2.364e-7, rel=1e-3)
    assert all(transfer.has_frequency_within(PAIRED, EULER, hertz, 1e-14, 60) for hertz in pair)


@over(["pinned-pinned", "clamped-free", "guided-pinned", *LADEN])
def test_exact_fields_are_those_of_the_transfer(name):
    x = X[[1, 3]] * BEAMS[name].length
    expected = transfer.deflection(BEAMS[name], EULER, HERTZ, FORCES, x, digits=30)
    close(ExactModel(BEAMS[name]).harmonic(FORCES, HERTZ).deflection(x), expected)


@pytest.mark.parametrize("theory", THICK)
def test_thick_fields_deflect_and_rotate_as_the_transfer(theory):
    beam = replace(BAR, supports=("clamped", "free"), loss_factor=0.02)
    field = ExactModel(beam, theory).harmonic(PointForce(position=0.31), 2311.0)
    expected = transfer.state(beam, theory, 2311.0, 0.31, 0.17)
    assert field.deflection(0.17)[0] == pytest.approx(expected[0], rel=1e-11)
    assert field.rotation(0.17)[0] == pytest.approx(expected[1], rel=1e-11)


# --- Hermite elements against the matrices of the textbook ------------------------------------------------------------


def elements(beam, count=14, devices=()):
    """Dense matrices on the same nodes, which include those devices that act against rotation."""
    nodes = tuple(PointSpring(position=one.position, stiffness=1.0) for one in devices if one.turning)
    return dense.Elements(beam, HermiteModel(replace(beam, spring=(*beam.spring, *nodes)), count).modes(1).nodes)


@over(BEAMS)
def test_all_element_modes_are_those_of_the_textbook(name):
    beam, written, model = BEAMS[name], elements(BEAMS[name]), HermiteModel(BEAMS[name], 14)
    modes = model.modes(model.n_elastic)
    assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(model.n_elastic), rel=1e-13)
    _, vectors = written.modes
    shape = written.values_at(vectors[:, beam.rigid_motions + 2], X * beam.length, 0)
    found = modes.deflection(X * beam.length)[2]
    close(found, shape * np.sign(shape @ found), 1e-7)


@over([*LADEN, "clamped-free", "free-free"])
@pytest.mark.parametrize(("damping", "devices"), [(0.0, ()), (0.021, ()), (0.0, DEVICES)])
def test_driven_elements_are_those_of_the_textbook(name, damping, devices):
    beam = BEAMS[name]
    damping = 0.0 if beam.loss_factor else damping
    written = elements(beam, devices=devices)
    more = np.zeros(written.mass.shape, dtype=complex)
    for device in devices:
        for z, order in ((device.dynamic_stiffness(OMEGA), 0), (device.rotational_dynamic_stiffness(OMEGA), 1)):
            row = written.row(device.position, order)
            more += z / (1j * OMEGA) * np.outer(row, row)
    load = written.load([*FORCES, *(one.own_force for one in devices)])
    vector = written.harmonic(load, HERTZ, damping, more)
    field = HermiteModel(beam, 14).harmonic(FORCES, HERTZ, modal_damping=damping, devices=devices)
    close(field.deflection(X * beam.length), written.values_at(vector, X * beam.length, 0))
    close(field.slope(X * beam.length), written.values_at(vector, X * beam.length, 1))


@over(["pinned-pinned", "clamped-free", "clamped-guided", "stepped", "springs", "foundation"])
def test_elements_buckle_as_those_of_the_textbook(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = elements(beam)
    assert HermiteModel(beam, 14).buckling_load() == pytest.approx(written.buckling(written.geometric), rel=1e-9)


# --- Rigid links against springs and masses written out --------------------------------------------------------------


@pytest.mark.parametrize("wall", ["gregory", "half"])
@over([*("-".join(pair) for pair in PAIRS), *LADEN])
def test_links_are_springs_and_masses(name, wall):
    """On four links the corrections of both clamps add up. Attachments by lever move with their link."""
    for count in (4, 17):
        model = SegmentModel(BEAMS[name], count, wall=wall, attachment="lever")
        modes = model.modes(min(model.n_elastic, 5))
        written = dense.Links(BEAMS[name], modes.nodes, dense.GREGORY if wall == "gregory" else np.array([0.5]))
        assert modes.frequencies_hz == pytest.approx(written.frequencies_hz(len(modes.frequencies_hz)), rel=1e-13)


@over(["clamped-free", "clamped-pinned", "stepped", "foundation"])
def test_links_buckle_as_their_joints(name):
    beam = replace(BEAMS[name], tension=0.0)
    written = dense.Links(beam, SegmentModel(beam, 17).modes(1).nodes)
    assert SegmentModel(beam, 17).buckling_load() == pytest.approx(written.buckling(written.geometric), rel=1e-9)


# --- All three models ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mass", [3e-6, 0.03, 3.0])
@pytest.mark.parametrize("name", ["segment", "fem"])
def test_bodies_on_a_hard_foundation_lower_local_modes(name, mass):
    """Below many modes 2e-7 apart. With 49 parts they err by 20 and 50 %: the shape decays within half a part."""
    bodies = (PointMass(position=0.31, mass=mass), PointMass(position=0.57, mass=3e-4))
    beam = replace(STRIP, supports=("clamped", "free"), foundation=1e11, mass=bodies)
    few, many = (MODELS[name](beam, 300).modes(n).frequencies_hz for n in (4, 299))
    assert few == pytest.approx(many[:4], rel=1e-12)
    assert few == pytest.approx(ExactModel(beam).modes(4).frequencies_hz, rel=4e-3)


@pytest.mark.parametrize("letters", ["pinned-free", "free-free"])
@over(MODELS)
def test_a_beam_free_to_rotate_carries_no_compression(name, letters):
    assert MODELS[name](BEAMS[letters]).buckling_load() == 0.0
    with pytest.raises(InputError, match="0 N"):
        MODELS[name](replace(BEAMS[letters], tension=-1e-3)).modes(1)


PLAIN = Beam(length=0.43, supports=("clamped", "free"), bending_stiffness=4100.0, mass_per_length=3.3)


@over(MODELS)
@pytest.mark.parametrize(
    ("beam", "theory", "message"),
    [
        (PLAIN, "rayleigh", r"beam\.rotary_inertia is missing: theory = 'rayleigh'"),
        (replace(PLAIN, rotary_inertia=1e-3), "timoshenko", r"beam\.shear_stiffness is missing: theory = 'timoshenko'"),
        (PLAIN, "timoshenk", "did you mean 'timoshenko'"),
        (replace(BAR, tension=12.0), "rayleigh", r"beam.tension = 12.0 N with theory = 'rayleigh'"),
        (replace(BAR, tension=-12.0), "timoshenko", r"beam.tension = -12.0 N with theory = 'timoshenko'"),
    ],
)
def test_a_theory_without_its_parameters_is_an_input_error(name, beam, theory, message):
    for work in (
        lambda: MODELS[name](beam, theory=theory).modes(1),
        lambda: MODELS[name](beam, theory=theory).harmonic(PointForce(position=0.1), 70.0),
        lambda: MODELS[name](beam, theory=theory).receptance([0.1], np.array([70.0]), np.array([0.2])),
    ):
        with pytest.raises(InputError, match=message):
            work()


def test_sizes_beyond_the_memory_are_an_input_error():
    large = HermiteModel(STRIP, 10**5)
    for work in (lambda: HermiteModel(STRIP, 10**9), lambda: SegmentModel(STRIP, 10**9), lambda: large.modes(10**5)):
        with pytest.raises(InputError, match="exceed the largest system of 10 GB"):
            work()
    with pytest.raises(InputError, match="more than 2000"):
        HermiteModel(STRIP, 1100).time_basis()
    assert HermiteModel(replace(STRIP, supports=("free", "free")), 10**6).n_elastic == 2 * 10**6
