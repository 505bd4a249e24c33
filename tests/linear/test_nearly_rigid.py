"""Beams whose slowest motion is nearly rigid, a bar on foam or on two long springs: other modes keep their digits."""

from math import pi

import numpy as np
import pytest

from verify import Beam, PointForce, PointMass, PointSpring, fem_beam, segment_model

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
@pytest.mark.parametrize("parts", [30, 800, 8000])
@pytest.mark.parametrize("softness", [1e-6, 1e-11])
def test_a_bar_on_soft_ground_tips_over_under_its_closed_load(face, parts, softness):
    """Under k L^2 / 12 (1 - k L^4 / (2520 EI)): of a stepped one 800 elements told half, 8000 eighty times as much."""
    beam = bar(supports=("free", "free"), foundation=softness * STIFFNESS / LENGTH**4)
    load = beam.foundation * LENGTH**2 / 12.0 * (1.0 - softness / 2520.0)
    assert face.buckling_load(beam, parts) == pytest.approx(load, rel=1e-11, abs=0.0)
