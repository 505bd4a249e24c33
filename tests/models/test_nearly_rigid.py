"""Beams whose slowest motion is nearly rigid, a bar on foam or on two long springs: other modes keep their digits."""

from math import pi

import numpy as np
import pytest
from scipy.linalg import eigh

from verify import Beam, PointForce, PointMass, PointSpring, Section, analytic_modes, fem_beam, segment_model
from verify.errors import InputError
from verify.models import polishing, response
from verify.models.eigen import _in_order, lowest
from verify.segments.assembly import build_chain, chain_pencil

LENGTH, STIFFNESS, RHO_A = 1.3, 7.0, 0.2
FACES = pytest.mark.parametrize("face", [fem_beam, segment_model], ids=["elements", "segments"])
SOFT = pytest.mark.parametrize("softness", [5.0, 3e-2, 1e-4, 1e-7, 1e-12])
"""Of what holds it, in EI/L^4: at 5 it bounces at a tenth of its first bending mode."""


def bar(**more):
    return Beam(length=LENGTH, bending_stiffness=STIFFNESS, mass_per_length=RHO_A, **more)


@FACES
@SOFT
@pytest.mark.parametrize("supports", [("free", "free"), ("guided", "free"), ("free", "guided")], ids="-".join)
def test_ground_of_any_softness_shifts_every_omega_squared_alike(face, softness, supports):
    ground, rigid = softness * STIFFNESS / LENGTH**4, 2 if supports == ("free", "free") else 1
    alone = face.solve_modes(bar(supports=supports), 4, 60).frequencies_hz
    found = face.solve_modes(bar(supports=supports, foundation=ground), 4 + rigid, 60).frequencies_hz
    expected = np.sqrt(np.append(np.zeros(rigid), alone**2) + ground / RHO_A / (2.0 * pi) ** 2)
    assert abs(found / expected - 1.0).max() < 2e-14


@FACES
def test_soft_springs_add_to_every_omega_squared_what_their_places_move(face):
    """Rayleigh's first order, whose second is the square of softness."""
    stiffness, places = 1e-8 * STIFFNESS / LENGTH**3, np.array([0.2, 0.75]) * LENGTH
    springs = tuple(PointSpring(position=float(x), stiffness=stiffness * (1 + i)) for i, x in enumerate(places))
    alone = face.solve_modes(bar(supports=("free", "free")), 4, 60)
    found = face.solve_modes(bar(supports=("free", "free"), spring=springs), 6, 60).frequencies_hz[2:]
    moved = stiffness * alone.deflection(places) ** 2 @ [1.0, 2.0]
    expected = np.sqrt(alone.frequencies_hz**2 + moved / (2.0 * pi) ** 2)
    assert abs(found / expected - 1.0).max() < 1e-12


@FACES
@pytest.mark.parametrize("softness", [1e-3, 1e-11])
def test_of_many_parts_what_bends_keeps_its_digits_beside_what_hardly_does(face, softness):
    ground = softness * STIFFNESS / LENGTH**4
    alone = face.solve_modes(bar(supports=("free", "free")), 3, 900).frequencies_hz
    found = face.solve_modes(bar(supports=("free", "free"), foundation=ground), 5, 900).frequencies_hz
    expected = np.sqrt(np.append(np.zeros(2), alone**2) + ground / RHO_A / (2.0 * pi) ** 2)
    assert abs(found / expected - 1.0).max() < 2e-13


@FACES
@pytest.mark.parametrize("parts", [60, 3000])
def test_a_bar_on_one_soft_spring_beside_a_pin_turns_as_its_spring_and_inertia_have_it(face, parts):
    """At k b^2 over the inertia about the pin, with a body: what k b^2 over EI / L bends it is next to nothing."""
    place, mass, k = 0.6 * LENGTH, 0.07, 1e-11 * STIFFNESS / LENGTH**3
    body, spring = PointMass(position=0.45, mass=mass), PointSpring(position=place, stiffness=k)
    found = face.solve_modes(bar(supports=("pinned", "free"), spring=(spring,), mass=(body,)), 1, parts)
    inertia = RHO_A * LENGTH**3 / 3.0 + mass * 0.45**2
    assert found.frequencies_hz[0] == pytest.approx(np.sqrt(k * place**2 / inertia) / (2.0 * pi), rel=3e-12)


@FACES
def test_slow_motions_are_found_whatever_is_asked_for(face):
    """One of two that are all but alike is the slower one, not a mixture; both lie far below what bends."""
    springs = (PointSpring(position=0.1, stiffness=1e-7), PointSpring(position=1.2, stiffness=3e-7))
    beam = bar(supports=("free", "free"), spring=springs)
    several = face.solve_modes(beam, 4, 300).frequencies_hz
    assert face.solve_modes(beam, 1, 300).frequencies_hz[0] == pytest.approx(several[0], rel=1e-13)
    assert several[1] < 1e-3 * several[2]


@FACES
@pytest.mark.parametrize("held", ["ground", "springs"])
def test_two_motions_that_are_nearly_rigid_are_told_apart_on_many_parts(face, held):
    """A rigid bar with a body, which bounces and rocks; mixed by rounding they were up to 0.14 per cent off."""
    ground, stiffness = 1e-7 * STIFFNESS / LENGTH**4 * (held == "ground"), 1e-7 * STIFFNESS / LENGTH**3
    springs = tuple(PointSpring(position=x, stiffness=stiffness) for x in (0.26, 0.975) if held == "springs")
    body = PointMass(position=0.4, mass=0.5, rotary_inertia=0.02)
    found = face.solve_modes(bar(supports=("free", "free"), foundation=ground, spring=springs, mass=(body,)), 3, 500)
    along = np.array([[LENGTH, LENGTH**2 / 2.0], [LENGTH**2 / 2.0, LENGTH**3 / 3.0]])
    held_by = ground * along + sum(
        one.stiffness * np.outer([1.0, one.position], [1.0, one.position]) for one in springs
    )
    moved = RHO_A * along + 0.5 * np.outer([1.0, 0.4], [1.0, 0.4]) + np.diag([0.0, 0.02])
    expected = np.sqrt(eigh(held_by, moved, eigvals_only=True)) / (2.0 * pi)
    assert abs(found.frequencies_hz[:2] / expected - 1.0).max() < 1e-7


UNEVEN = {
    "graded": (bar(supports=("free", "free"), spring=(PointSpring(position=0.8, stiffness=30.0),)), 2.7),
    "stepped": (
        bar(
            supports=("free", "free"),
            section=(Section(length=0.1, bending_stiffness=9.0), Section(length=1.2)),
            mass=(PointMass(position=LENGTH, mass=0.9),),
            spring=(PointSpring(position=0.1, stiffness=90.0),),
        ),
        1.0,
    ),
}


@pytest.mark.parametrize("case", UNEVEN)
def test_unequal_links_turn_freely_about_the_place_where_they_feel_their_spring(case):
    beam, grading = UNEVEN[case]
    chain = build_chain(beam, 17, grading=grading)
    pencil = chain_pencil(chain)
    assert abs(pencil.strain(pencil.rigid)).max() < 1e-12 * abs(pencil.rigid).max()
    strain, mass = pencil.strain_matrix().toarray(), pencil.mass_matrix()
    known = eigh(strain.T @ (pencil.stiffness[:, None] * strain), mass, eigvals_only=True)[1:4]
    assert abs(lowest(pencil, 3).values / known - 1.0).max() < 1e-10


@FACES
def test_responses_summed_over_modes_are_those_of_each_frequency_on_soft_ground_too(face):
    beam = bar(supports=("free", "free"), foundation=1e-2 * STIFFNESS / LENGTH**4)
    x, hertz = np.linspace(0.0, LENGTH, 7), np.array([1.0, 5.0, 30.0, 90.0])
    found = face.unit_responses(beam, [0.4], hertz, x, 60)[:, 0]
    known = np.array([face.solve_harmonic(beam, PointForce(position=0.4), one, 60).deflection(x) for one in hertz])
    assert (abs(found - known).max(axis=1) < 1e-8 * abs(known).max(axis=1)).all()


@FACES
@pytest.mark.parametrize("parts", [49, 2000])
@pytest.mark.parametrize("loss_factor", [0.0, 0.02])
def test_a_bar_about_a_pin_answers_a_slow_drive_as_a_rigid_one_on_its_spring(face, parts, loss_factor):
    """Bent by 1e-12 of that; with both parts of unknowns and strains of one size nothing of it was left."""
    place, at, k = 0.73 * LENGTH, 0.31 * LENGTH, 1e-12 * STIFFNESS / LENGTH**3
    springs = (PointSpring(position=place, stiffness=k),)
    beam = bar(supports=("pinned", "free"), spring=springs, loss_factor=loss_factor)
    omega2 = 0.31 * k * place**2 / (RHO_A * LENGTH**3 / 3.0)
    field = face.solve_harmonic(beam, PointForce(position=at, amplitude=0.7), np.sqrt(omega2) / (2.0 * pi), parts)
    x = np.array([0.2, 0.77, 1.0]) * LENGTH
    expected = 0.7 * at / (k * place**2 - omega2 * RHO_A * LENGTH**3 / 3.0) * x
    assert abs(field.deflection(x) / expected - 1.0).max() < 2e-11
    assert abs(field.slope(x) / expected * x - 1.0).max() < 2e-11


@FACES
@pytest.mark.parametrize("supports", [("pinned", "free"), ("free", "pinned")], ids="-".join)
def test_a_bar_that_a_soft_coil_holds_about_its_pin_loses_nothing_of_its_own_damping(face, supports):
    """At 1e-14 EI/L: the joint beside the coil was what is left of two compliances, that is nothing."""
    pin, k = LENGTH * (supports[1] == "pinned"), 1e-14 * STIFFNESS / LENGTH
    beam = bar(supports=supports, spring=(PointSpring(position=pin, rotational=k),), loss_factor=0.1)
    omega2 = 0.4 * k / (RHO_A * LENGTH**3 / 3.0)
    field = face.solve_harmonic(beam, PointForce(position=0.9), np.sqrt(omega2) / (2.0 * pi), 400)
    expected = (0.9 - pin) * (0.5 - pin) / (0.6 * k)
    assert abs(field.deflection(0.5) / expected - 1.0) < 1e-11


@FACES
@pytest.mark.parametrize("parts", [40, 300])
def test_a_bar_with_a_body_on_soft_ground_answers_a_slow_drive_as_a_rigid_one(face, parts):
    ground, body = 1e-12 * STIFFNESS / LENGTH**4, PointMass(position=0.481, mass=0.08, rotary_inertia=0.0044)
    beam = bar(supports=("free", "free"), foundation=ground, mass=(body,))
    along = np.array([[LENGTH, LENGTH**2 / 2.0], [LENGTH**2 / 2.0, LENGTH**3 / 3.0]])
    moved = RHO_A * along + 0.08 * np.outer([1.0, 0.481], [1.0, 0.481]) + np.diag([0.0, 0.0044])
    omega2 = 0.3 * ground / RHO_A
    lift, turn = np.linalg.solve(ground * along - omega2 * moved, [1.0, 0.95])
    found = face.solve_harmonic(beam, PointForce(position=0.95), np.sqrt(omega2) / (2.0 * pi), parts)
    x = np.array([0.1, 0.7, 1.3])
    assert abs(found.deflection(x) / (lift + turn * x) - 1.0).max() < 2e-11


@FACES
@pytest.mark.parametrize("parts", [10, 49])
def test_a_bar_behind_one_soft_part_turns_as_on_a_flexure_however_few_parts_there_are(face, parts):
    """Of 1e-14 EI between stiff ones: assembled it left no digit, nor did factors of elements that bend both ways."""
    soft = Section(length=0.1 * LENGTH, bending_stiffness=1e-14 * STIFFNESS)
    pieces = (Section(length=0.4 * LENGTH), soft, Section(length=0.5 * LENGTH))
    beam = bar(supports=("clamped", "free"), section=pieces)
    exact = analytic_modes.solve_modes(beam, 1).frequencies_hz[0]
    found = face.solve_modes(beam, 1, parts).frequencies_hz[0]
    assert found == pytest.approx(exact, rel=1e-7 if face is fem_beam else 1e-2)


def test_what_steps_do_not_settle_is_refused_and_told(monkeypatch):
    k = 1e-12 * STIFFNESS / LENGTH**3
    beam = bar(supports=("pinned", "free"), spring=(PointSpring(position=0.8, stiffness=k),))
    monkeypatch.setattr(response, "swing", lambda omega2: 1.0)
    with pytest.raises(InputError, match="999 unknowns is answered with less than 6 sure digits"):
        segment_model.solve_harmonic(beam, PointForce(position=0.4), 1e-9, 999)
    monkeypatch.setattr(polishing, "_STEPS", 1)
    with pytest.raises(InputError, match=r"a motion of 999 unknowns.* does not settle"):
        segment_model.solve_modes(beam, 1, 999)


PINNED = bar(supports=("pinned", "free"), spring=(PointSpring(position=0.3, stiffness=1e-3),))
IDLE = {
    "at the pin": (PointForce(position=0.0, amplitude=1.7),),
    "of no size": (PointForce(position=0.9, amplitude=0.0),),
    "two that take each other away": (PointForce(position=0.9), PointForce(position=0.9, amplitude=-1.0)),
}


@FACES
@pytest.mark.parametrize("case", IDLE)
@pytest.mark.filterwarnings("error")
def test_a_slow_force_that_moves_nothing_is_answered(face, case):
    """Its steps were nought by nought of its answer: refused as of a beam that next to nothing holds."""
    assert not face.solve_harmonic(PINNED, IDLE[case], 1e-3, 30).deflection([0.2, 0.9, 1.3]).any()


@pytest.mark.filterwarnings("error")
def test_a_slow_force_at_the_clamp_moves_no_element():
    beam = bar(supports=("clamped", "free"), foundation=1.0)
    assert not fem_beam.solve_harmonic(beam, PointForce(position=0.0), 1e-3, 30).deflection([0.2, 1.3]).any()


@FACES
@pytest.mark.filterwarnings("error")
def test_a_slow_force_is_answered_beside_one_that_moves_nothing(face):
    """As a rigid bar about its pin, which a newton bends by 2e-4 of that."""
    found = face.unit_responses(PINNED, [0.0, 0.9], [1e-3], [0.5], 30)[0, :, 0]
    held = 1e-3 * 0.3**2 - (2.0 * pi * 1e-3) ** 2 * RHO_A * LENGTH**3 / 3.0
    assert found[0] == 0.0
    assert found[1] == pytest.approx(0.9 * 0.5 / held, rel=2e-3)


@pytest.mark.parametrize("model", [analytic_modes, fem_beam, segment_model], ids=["exact", "elements", "segments"])
def test_the_softest_beam_is_told_per_newton_as_a_stiffer_one_is(model):
    """A newton bends it to slopes of 1e103, which a field of a force is refused for: a receptance is no field."""

    def over_stiffness(stiffness):
        beam = Beam(length=1e3, bending_stiffness=stiffness, mass_per_length=0.01 * stiffness)
        size = () if model is analytic_modes else (60,)
        return stiffness * model.unit_responses(beam, 400.0, [1e-9, 7e-4], [310.0, 900.0], *size)

    assert over_stiffness(1e-97) == pytest.approx(over_stiffness(3.0), rel=1e-9)


BEHIND = {"a third": (0.3, 0.3, 0.4), "one part": (0.4, 0.02, 0.58)}


@pytest.mark.parametrize(
    ("face", "width"),
    [(fem_beam, "a third"), (fem_beam, "one part"), (segment_model, "a third")],
    ids=["elements", "elements behind one part", "segments"],
)
def test_both_slow_modes_behind_a_soft_stretch_go_as_the_root_of_its_softness(face, width):
    """What divides it is alike at 1e-11 and 1e-13 EI; what rounding leaves is some 1e-21 over the softness."""

    def over_exact(softness):
        shares = zip(BEHIND[width], (1.0, softness, 1.0), strict=True)
        pieces = tuple(Section(length=share * LENGTH, bending_stiffness=soft * STIFFNESS) for share, soft in shares)
        beam = bar(supports=("clamped", "free"), section=pieces)
        return face.solve_modes(beam, 2, 50).frequencies_hz / analytic_modes.solve_modes(beam, 2).frequencies_hz

    assert abs(over_exact(1e-13) / over_exact(1e-11) - 1.0).max() < 1e-8


@FACES
@pytest.mark.parametrize("parts", [30, 800, 8000])
@pytest.mark.parametrize("softness", [1e-6, 1e-11])
def test_a_bar_on_soft_ground_tips_over_under_its_closed_load(face, parts, softness):
    """Under k L^2 / 12 (1 - k L^4 / (2520 EI)): of a stepped one 800 elements told half, 8000 eighty times as much."""
    beam = bar(supports=("free", "free"), foundation=softness * STIFFNESS / LENGTH**4)
    load = beam.foundation * LENGTH**2 / 12.0 * (1.0 - softness / 2520.0)
    assert face.buckling_load(beam, parts) == pytest.approx(load, rel=1e-11, abs=0.0)


@FACES
def test_a_stepped_bar_on_soft_ground_beyond_its_buckling_is_refused_however_many_parts_it_has(face):
    """Ground of 1e-6 EI/L^4 holds it; a mode was told as no number."""
    sections = tuple(
        Section(length=share * LENGTH, bending_stiffness=ei, mass_per_length=m)
        for share, ei, m in ((0.48, 5.3, 0.21), (0.52, 2.9, 0.05))
    )
    beam = bar(supports=("free", "free"), section=sections, foundation=1e-6, tension=-0.4)
    load = analytic_modes.buckling_load(beam)
    assert load == pytest.approx(1e-6 * LENGTH**2 / 12.0, rel=1e-6, abs=0.0)
    with pytest.raises(InputError, match=f"buckles? at {load:.4g}".partition("e-")[0]):
        face.solve_modes(beam, 3, 6000)


def test_a_square_below_nothing_is_refused():
    """As rounding of a check of buckling may leave one: half a wave under half as much again as it bears."""
    pencil = chain_pencil(build_chain(bar(supports=("pinned", "pinned"), tension=-61.0), 12))
    half_a_wave = np.sin(np.pi * np.arange(1.0, 12.0) / 12.0)[:, None]
    with pytest.raises(
        InputError, match=r"beam\.tension: a mode of 11 unknowns has an omega\^2 of -\de-03, below nothing"
    ):
        _in_order(pencil, half_a_wave, "by hand")
