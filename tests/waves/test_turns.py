"""The section's own turn by Timoshenko's theory, and what follows it: surfaces, and what bending and shear lose."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference import transfer
from verify import Beam, PointForce, analytic_modes, fem_beam, load_scene, segment_model
from verify.attached import PointMass
from verify.judge.cache import SolutionCache
from verify.quantities.base import evaluate
from verify.waves.driven import measures, power_imbalance
from verify.waves.medium import Medium

BAR = Beam(
    length=0.2,
    width=0.02,
    thickness=0.018,
    youngs_modulus=114e9,
    density=4430.0,
    poissons_ratio=0.33,
    loss_factor=0.01,
    supports=("free", "clamped"),
)
SOLVERS = {"analytic": (analytic_modes, ()), "fem": (fem_beam, (120,)), "segment": (segment_model, (400,))}
FORCE = (PointForce(position=0.045),)
EVERYWHERE = np.linspace(0.0, 0.2, 61)


def solve(model, beam, forces=FORCE, hertz=23000.0, theory="timoshenko", **settings):
    module, count = SOLVERS[model]
    return module.solve_harmonic(beam, forces, hertz, *count, theory=theory, **settings)


@pytest.mark.parametrize("supports", [("free", "clamped"), ("pinned", "guided"), ("guided", "free")], ids="-".join)
def test_every_model_turns_as_the_states_along_the_beam_do(supports):
    beam = replace(BAR, supports=supports, mass=(PointMass(position=0.13, mass=0.02, rotary_inertia=3e-6),))
    places = [0.003, 0.043, 0.11, 0.187]
    exact = np.array([transfer.state(beam, "timoshenko", 23000.0, 0.045, x)[1] for x in places])
    for model, within in (("analytic", 1e-11), ("fem", 2e-3), ("segment", 2e-3)):
        assert abs(solve(model, beam).turn(places) - exact).max() < within * abs(exact).max()


def test_what_is_clamped_keeps_its_section_upright_while_its_line_slopes():
    for model in SOLVERS:
        field = solve(model, BAR)
        size = abs(field.turn(EVERYWHERE)).max()
        assert abs(field.turn(0.2)) < 1e-12 * size
    field = solve("analytic", BAR)
    assert abs(field.slope(0.2)) > 0.1 * size


def test_shear_balances_what_the_bar_between_two_places_is_driven_with():
    """(kappa G A (w' - psi))' = -rho A omega^2 w over a stretch without forces, with the loss in kappa G A."""
    field = solve("analytic", BAR)
    stiffness = BAR.own.shear_stiffness * (1.0 + 0.01j)
    ends = [stiffness * (field.slope(x) - field.turn(x)) for x in (0.06, 0.16)]
    points, weights = np.polynomial.legendre.leggauss(40)
    swung = 0.05 * weights @ field.deflection(0.11 + 0.05 * points)
    assert ends[1] - ends[0] == pytest.approx(-BAR.mass_per_length * field.omega**2 * swung, rel=1e-11)


def test_the_turn_of_links_has_order_two_next_to_a_clamped_wall():
    beam, near = replace(BAR, supports=("clamped", "clamped")), 0.2 - np.array([0.0003, 0.0011, 0.0024])
    true = solve("analytic", beam).turn(near)
    off = [
        abs(segment_model.solve_harmonic(beam, FORCE, 23000.0, n, theory="timoshenko").turn(near) - true).max()
        for n in (200, 400)
    ]
    assert off[1] < 0.3 * off[0]


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh"])
@pytest.mark.parametrize("model", SOLVERS)
def test_what_does_not_shear_turns_as_its_line_slopes(model, theory):
    field = solve(model, BAR, theory=theory)
    assert (field.turn(EVERYWHERE) == field.slope(EVERYWHERE)).all()


def test_a_pure_wave_turns_its_sections_as_the_medium_says_with_losses_too():
    """Far from the force on a long bar with an end that swallows nothing in time: e^{-ikx} times what is left of it."""
    beam = replace(BAR, length=3.0, loss_factor=0.08, supports=("pinned", "pinned"))
    field = solve("analytic", beam, (PointForce(position=0.1),), 30000.0)
    turn = Medium(beam, "timoshenko").turn(field.omega)
    assert field.turn(1.0) / field.slope(1.0) == pytest.approx(turn, rel=1e-5)
    assert abs(turn.imag) > 1e-3


@pytest.mark.parametrize(("model", "within"), [("analytic", 1e-7), ("fem", 1e-3)])
@pytest.mark.parametrize("loss_factor", [0.005, 0.03])
def test_forces_give_what_bending_and_shear_lose_and_waves_carry(model, within, loss_factor):
    beam = replace(BAR, length=0.9, loss_factor=loss_factor, supports=("pinned", "clamped"))
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
    count = {"analytic": (), "fem": (450,)}[model]
    field = SOLVERS[model][0].solve_harmonic(beam, forces, 47000.0, *count, theory="timoshenko")
    assert abs(power_imbalance(field, measures(field, None))) < within


@pytest.mark.parametrize("hertz", [9000.0, 47000.0])
def test_the_ellipse_of_a_pure_wave_is_as_high_as_its_section_turns(hertz):
    """By the shear that carries a wave's inertia: psi = (k - rho A omega^2 / (kappa G A k)) w, times h/2."""
    beam = replace(BAR, length=0.9, loss_factor=0.0, supports=("pinned", "pinned"))
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
    field, piece = analytic_modes.solve_harmonic(beam, forces, hertz, theory="timoshenko"), beam.pieces[0]
    k = field.wavenumber.real
    turn = k - piece.mass_per_length * (2.0 * np.pi * hertz) ** 2 / (piece.shear_stiffness * k)
    assert measures(field, None).ideal_axis_ratio == pytest.approx(turn * 0.009, rel=1e-9)
    assert turn < 0.98 * k


@pytest.mark.parametrize("x", [0.001, 0.03, 0.1, 0.195])
def test_a_surface_point_near_forces_and_ends_moves_as_its_section_turns(x):
    paper = load_scene("paper-wave")
    forces = (PointForce(position=0.02), PointForce(position=0.17, phase_deg=90.0))
    given = tuple(
        replace(one, position=at, measured_from="left") for one, at in zip(paper.drive.force, (0.02, 0.17), strict=True)
    )
    assert [(f.amplitude, f.phase_deg) for f in paper.drive.force] == [(1.0, 0.0), (1.0, 90.0)]
    scene = replace(paper, beam=BAR, drive=replace(paper.drive, frequency_hz=30000.0, force=given))
    lifts, turns = np.array([transfer.state(BAR, "timoshenko", 30000.0, one.position, x)[:2] for one in forces]).T
    up, across = lifts @ [1.0, 1j], -0.009 * (turns @ [1.0, 1j])
    area = 2.0 * (np.conj(across) * up).imag / (abs(across) ** 2 + abs(up) ** 2)
    exact = np.tan(0.5 * np.arcsin(area))
    ratio = "wave.axis_ratio"
    for given, within in (({"model": "analytic"}, 1e-10), ({"model": "fem", "count": 100}, 1e-3)):
        asked = given | {"theory": "timoshenko", "x": x}
        assert evaluate(ratio, asked, scene, SolutionCache(BAR)) == pytest.approx(exact, rel=within)


@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
def test_a_chains_field_tends_to_the_exact_one_of_its_own_theory(theory):
    """What rotary inertia and shear do to a thick bar is no error of its segments: by 40 of them it is far more."""
    scene, of = load_scene("thick-bar"), "wave.order"
    given = {"model": "segment", "counts": [40, 80, 160], "of": "deflection", "window": [0.12, 0.21]}
    asked = given | {"theory": theory}
    assert evaluate(of, asked, scene, SolutionCache(scene.beam)) == pytest.approx(2.0, abs=0.1)
