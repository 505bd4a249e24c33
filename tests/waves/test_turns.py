"""The section's own turn by Timoshenko's theory, and what follows it: surfaces, and what bending and shear lose."""

import numpy as np
import pytest
import states_reference
from msgspec.structs import replace

from verify import Beam, PointForce, analytic_modes, fem_beam, segment_model
from verify.attached import PointMass, PointSpring
from verify.device import Device
from verify.errors import InputError, WindowError
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.waves.devices import field_with_devices
from verify.waves.driven import measures, power_imbalance
from verify.waves.imposed import driven_field
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
    exact = np.array([states_reference.response(beam, "timoshenko", 23000.0, 0.045, x)[1] for x in places])
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


@pytest.mark.parametrize(
    "more",
    [
        {"spring": (PointSpring(position=0.0, rotational=3e4),), "supports": ("pinned", "free")},
        {"mass": (PointMass(position=0.0, mass=0.02, rotary_inertia=2e-6),), "supports": ("free", "pinned")},
        {
            "mass": (PointMass(position=0.2, rotary_inertia=2e-6),),
            "spring": (PointSpring(position=0.2, rotational=3e4),),
            "supports": ("guided", "pinned"),
        },
    ],
    ids=["spring", "body", "body on a spring"],
)
def test_an_end_that_turns_against_something_turns_as_far_in_links(more):
    beam = replace(BAR, **more)
    true, found = (solve(model, beam, hertz=9000.0).turn(EVERYWHERE) for model in ("analytic", "segment"))
    assert abs(found - true).max() < 5e-4 * abs(true).max()


@pytest.mark.parametrize("model", SOLVERS)
def test_the_turn_has_the_derivative_that_it_is_told_with(model):
    field, x, h = solve(model, BAR), np.array([0.0123, 0.0917, 0.1533]), 1e-6
    steep = (field.turns(x + h, 0) - field.turns(x - h, 0)) / (2.0 * h)
    assert abs(field.turns(x, 1) - steep).max() < 1e-6 * abs(steep).max()


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh"])
@pytest.mark.parametrize("model", SOLVERS)
def test_what_does_not_shear_turns_as_its_line_slopes(model, theory):
    field = solve(model, BAR, theory=theory)
    assert (field.turn(EVERYWHERE) == field.slope(EVERYWHERE)).all()


@pytest.mark.parametrize("model", SOLVERS)
def test_sweeps_devices_and_imposed_motion_keep_the_turn(model):
    module, count = SOLVERS[model]
    alone = solve(model, BAR)
    turn = alone.turn(EVERYWHERE)
    size = abs(turn).max()
    sweep = module.sweep_harmonic(BAR, FORCE, [21000.0, 23000.0], *count, theory="timoshenko")
    assert abs(sweep.field(1).turn(EVERYWHERE) - turn).max() < 1e-9 * size

    def given(beam, forces, hertz):
        return solve(model, beam, forces, hertz)

    idle = field_with_devices(given, BAR, FORCE, 23000.0, Device(position=0.1, mass=1e-12))
    assert abs(idle.turn(EVERYWHERE) - turn).max() < 1e-6 * size
    lift = alone.deflection([0.045])[0]
    drive = [PointForce(position=0.045, amplitude=float(abs(lift)), phase_deg=float(np.rad2deg(np.angle(lift))))]
    held = driven_field(lambda forces, hertz: solve(model, BAR, forces, hertz), drive, 23000.0, "displacement")
    assert abs(held.turn(EVERYWHERE) - turn).max() < 1e-9 * size


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


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh", "timoshenko"])
@pytest.mark.parametrize("turning", ["body", "spring"])
def test_books_close_where_something_that_turns_stands_before_the_window(theory, turning):
    """Its couple makes the curvature jump inside what was one cell of the quadrature: up to 23 % were missing."""
    body, spring = PointMass(position=0.0371, mass=0.004, rotary_inertia=1e-6), PointSpring
    added = {"mass": (body,)} if turning == "body" else {"spring": (spring(position=0.0371, rotational=3000.0),)}
    sizes = {"length": 0.5, "width": 0.02, "thickness": 0.002, "youngs_modulus": 70e9, "density": 2700.0}
    beam = Beam(**sizes, supports=("clamped", "free"), loss_factor=0.02, **added)
    forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.45, amplitude=2.0, phase_deg=70.0))
    field = analytic_modes.solve_harmonic(beam, forces, 20000.0, theory=theory)
    assert abs(power_imbalance(field, measures(field, None))) < 1e-6


class Untold(type(MODELS["analytic"])):
    """The exact beam, that does not say how its sections turn."""

    name, title = "untold", "Untold"

    def solve_harmonic(self, beam, forces, frequency_hz, count, **settings):
        field = super().solve_harmonic(beam, forces, frequency_hz, count, **settings)
        return replace(field, model="untold", turned=None)


def test_a_timoshenko_field_without_a_turn_has_deflections_and_no_surface():
    field = Untold().solve_harmonic(BAR, FORCE, 23000.0, None, theory="timoshenko")
    assert abs(field.deflection(0.1)) > 0.0
    with pytest.raises(InputError, match="fields of model = 'untold' tell no turn of the section"):
        field.turn(0.1)
    assert Untold().solve_harmonic(BAR, FORCE, 23000.0, None).turn(0.1)


def test_two_waves_are_not_told_of_a_field_of_four():
    """From sqrt(kappa G A / rho I) on sections swing in waves of their own: the flux of one pair was 17 % off."""
    own = BAR.own
    fastest = float(np.sqrt(own.shear_stiffness / own.rotary_inertia)) / (2.0 * np.pi)
    beam, forces = replace(BAR, length=0.9), (PointForce(position=0.04), PointForce(position=0.86, phase_deg=60.0))
    window = (0.2, 0.7)
    below, above = (analytic_modes.solve_harmonic(beam, forces, f * fastest, "timoshenko") for f in (0.99, 1.01))
    assert abs(power_imbalance(below, measures(below, window))) < 1e-4
    with pytest.raises(WindowError, match=f"from {fastest:.6g} Hz on .* a second pair of waves"):
        measures(above, window)
    rayleigh = replace(above, theory="rayleigh", turned=None)
    assert measures(rayleigh, window).window == window


@pytest.mark.parametrize(
    ("theory", "of", "times"), [("timoshenko", "shear_stiffness", 0.5), ("rayleigh", "rotary_inertia", 3.0)]
)
def test_a_window_lies_on_the_beams_own_section_in_all_that_a_theory_makes_waves_of(theory, of, times):
    """The same pieces, written with either section as the beam's own: waves of the one were told as the other's."""
    beam, forces = replace(BAR, length=0.9), (PointForce(position=0.04), PointForce(position=0.86, phase_deg=60.0))
    outer, within = ({of: share * getattr(beam.own, of)} for share in (1.0, times))
    pieces = (Section(length=0.15, **outer), Section(length=0.6, **within), Section(length=0.15, **outer))
    owned = replace(beam, **within, section=pieces)
    here, there = (
        analytic_modes.solve_harmonic(one, forces, 23000.0, theory) for one in (owned, replace(owned, **outer))
    )
    assert here.deflection(0.47) == pytest.approx(there.deflection(0.47), rel=1e-12)
    assert measures(here, (0.2, 0.7)).window == (0.2, 0.7)
    with pytest.raises(WindowError, match=r"other than the beam's own.*as its own"):
        measures(there, (0.2, 0.7))
    plain = analytic_modes.solve_harmonic(replace(owned, **outer), forces, 23000.0)
    assert measures(plain, (0.2, 0.7)).window == (0.2, 0.7)
