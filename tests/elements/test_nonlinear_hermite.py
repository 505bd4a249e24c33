"""Nonlinear Hermite elements against elasticae, rotating beams, published motions, the nonlinear and linear models."""

from dataclasses import replace
from math import pi

import msgspec
import numpy as np
import pytest
from reference.curved_rods import frequencies, helix
from reference.elastica import follower_tip
from scipy.integrate import quad_vec

from verify import (
    Beam,
    Excitation,
    HermiteModel,
    InputError,
    Keep,
    NonlinearHermite,
    PointForce,
    bend,
    large_motion,
    simulate,
)
from verify.chain import motion
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.system import ChainState, LinkLoad, build_system
from verify.elements.nonlinear_motion import RHO
from verify.elements.plane_elements import Forces
from verify.linear.step_schemes import generalised_alpha
from verify.problem.base_motion import Base, polynomial, tabulated

CANTILEVER = Beam(length=1.3, bending_stiffness=0.7, mass_per_length=2.1, supports=("clamped", "free"))
L, EI, RHO_A = CANTILEVER.length, CANTILEVER.bending_stiffness, CANTILEVER.mass_per_length
SPUN = Beam(length=10.0, bending_stiffness=1.4e4, mass_per_length=1.2, supports=("clamped", "free"))
ELASTICA = [  # P L^2/EI; deflection, shortening, rotation of the tip: elliptic integrals in 25 digits
    (0.25, 0.08274591535, 0.00411781841, 0.1242924421),
    (1.0, 0.3017207738, 0.05643323628, 0.4613519497),
    (4.0, 0.6699641813, 0.3289412422, 1.121239347),
    (10.0, 0.8106090249, 0.5549955978, 1.430285539),
]


def elements(count, beam=CANTILEVER, axial=1e7):
    """Nearly inextensible elements: EA L^2/EI = `axial`."""
    return NonlinearHermite(beam, count, axial_stiffness=axial * beam.bending_stiffness / beam.length**2)


@pytest.mark.parametrize("supports", [("clamped", "free"), ("pinned", "pinned"), ("clamped", "guided")])
def test_the_straight_beam_has_the_frequencies_of_the_linear_elements(supports):
    beam = msgspec.structs.replace(CANTILEVER, supports=supports)
    model = elements(12, beam, axial=1e6)
    linear = HermiteModel(beam, 12).modes(5).frequencies_hz
    assert model.bend().frequencies_hz()[:5] == pytest.approx(linear, rel=1e-9)  # rounding of EA in the same matrix
    assert model.bend().frequencies_hz(flapping=True)[:5] == pytest.approx(linear, rel=1e-9)


def test_an_arc_has_the_frequencies_of_an_inextensible_rod_with_order_four():
    radius = L / 2.1

    def stiffness(s):
        return np.outer(np.ones(len(s)), [1e7, 1e7, EI])  # torsion and the other plane are far above

    exact = frequencies(helix(radius, 0.0), L, stiffness, lambda s: RHO_A)[:2] / (2 * pi)
    models = (replace(elements(n, axial=1e8), curvature=lambda s: 0 * s + 1 / radius) for n in (6, 12))
    errors = [model.bend().frequencies_hz()[:2] / exact - 1 for model in models]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)
    assert errors[1] == pytest.approx(0.0, abs=5e-5)


@pytest.mark.parametrize("moment", [-1.7, 0.9])
def test_a_moment_adds_a_constant_curvature_to_that_of_a_clothoid(moment):
    moment *= EI / L

    def place(bent):
        return quad_vec(lambda s: np.exp(1j * (0.8 * s + 0.9 * s**2 + bent * s)), 0.0, L, epsabs=1e-13)[0]

    clothoid = replace(elements(32, axial=1e8), curvature=lambda s: 0.8 + 1.8 * s)
    found, exact, rest = clothoid.bend(moment=moment), place(moment / EI), place(0.0)
    assert complex(*clothoid.bend().tip) == pytest.approx(rest, abs=1e-10 * L)
    assert complex(*found.tip) == pytest.approx(exact, abs=1.5e-6 * L)
    assert complex(found.shortening, found.deflection) == pytest.approx((rest - exact).conjugate(), abs=1.5e-6 * L)
    assert found.turn == pytest.approx(moment * L / EI, abs=1.5e-6)
    assert found.energy == pytest.approx(moment**2 * L / (2 * EI), rel=1.5e-6)


@pytest.mark.parametrize("curvature", [lambda s: 1.0, lambda s: 1 / (s - s)])
def test_a_curvature_that_is_no_finite_array_is_refused(curvature):
    with pytest.raises(InputError, match="curvature"), np.errstate(divide="ignore", invalid="ignore"):
        replace(elements(4), curvature=curvature).bend()
    with pytest.raises(InputError, match="supports"):
        replace(elements(4, msgspec.structs.replace(CANTILEVER, supports=("pinned", "free"))), curvature=curvature)


def test_the_tangent_of_the_straight_beam_is_the_linear_elements_matrix():
    size = L / 3
    bend = np.array(
        [
            [12.0, 6.0 * size, -12.0, 6.0 * size],
            [6.0 * size, 4.0 * size**2, -6.0 * size, 2.0 * size**2],
            [-12.0, -6.0 * size, 12.0, -6.0 * size],
            [6.0 * size, 2.0 * size**2, -6.0 * size, 4.0 * size**2],
        ]
    )
    model = elements(3, axial=10.0)  # the rounding of the stretch times EA L^2/EI is below 1e-13
    tangent = model.elastic(model.rest)[1][1]
    assert tangent[1::2, 1::2] == pytest.approx(EI / size**3 * bend, rel=1e-13, abs=1e-13 * abs(bend).max())
    assert abs(tangent[::2, 1::2]).max() == 0.0


def test_forces_and_tangent_are_derivatives_of_the_energy_of_a_bent_and_stretched_beam():
    model, rng = elements(3, axial=40.0), np.random.default_rng(62)
    state = model.rest + rng.normal(0.0, 0.1, model.rest.shape)
    move, other = rng.normal(0.0, 1.0, (2, *state.shape))
    near = np.array([-1e-5, 1e-5])[:, None, None, None]
    energies, (gradient, hessian) = model.energy(state + near * move), model.elastic(state)
    assert (gradient * model.of_elements(move)).sum() == pytest.approx((energies[1] - energies[0]) / 2e-5, rel=1e-6)
    forces = [(model.elastic(state + one * move)[0] * model.of_elements(other)).sum() for one in (-1e-5, 1e-5)]
    twice = np.einsum("ni,nij,nj", model.of_elements(other), hessian, model.of_elements(move))
    assert twice == pytest.approx((forces[1] - forces[0]) / 2e-5, rel=1e-6)


@pytest.mark.parametrize(("load", "deflection", "shortening", "turn"), ELASTICA)
def test_a_dead_load_bends_it_to_the_elastica(load, deflection, shortening, turn):
    bent = elements(24).bend(load * EI / L**2)
    assert [bent.deflection / L, bent.shortening / L, bent.turn] == pytest.approx(
        [deflection, shortening, turn], rel=3e-6, abs=2e-8
    )


@pytest.mark.parametrize("force", [1.0, 4.0, 10.0])
def test_a_follower_force_bends_it_as_by_integration_from_the_tip(force):
    tip, turn = follower_tip(force)
    bent = elements(24).bend(follower=force * EI / L**2)
    assert [*bent.tip / L, bent.turn] == pytest.approx([*tip, turn], abs=2e-5)


def test_a_moment_rolls_it_up_to_a_circle():
    bent = elements(16, axial=1e7).bend(moment=2.0 * pi * EI / L)
    assert bent.tip / L == pytest.approx([0.0, 0.0], abs=3e-5)
    assert bent.energy == pytest.approx(2.0 * pi**2 * EI / L, rel=1e-4)


def test_a_column_is_refused_beyond_the_weight_that_it_carries_and_bends_with_a_side_force():
    heavy = 7.83734743894348 * EI / L**3 / RHO_A
    assert elements(8).bend(gravity=(-0.9999 * heavy, 0.0)).deflection == 0.0
    with pytest.raises(InputError, match="stable"):
        elements(8).bend(gravity=(-1.001 * heavy, 0.0))
    assert elements(8).bend((0.0, 1e-3 * EI / L**2), gravity=(-1.3 * heavy, 0.0)).turn > 1.0


def test_a_rotating_beam_stretches_as_by_the_closed_form_however_short_its_elements_are():
    errors = [NonlinearHermite(SPUN, n, axial_stiffness=2.8e7).bend(rate=6.0).tip[0] - 10.0 for n in (4, 8, 64)]
    errors = [extension / 5.1431745504e-4 - 1.0 for extension in errors]
    assert 2e-4 < errors[0] < 5e-4
    assert 3e-6 < errors[1] < 1e-5
    assert abs(errors[2]) < 1e-8  # rounding; without a share of EA it is 2e-3


def test_sections_without_an_area_have_the_given_axial_stiffness():
    sections = [{"length": 0.5, "bending_stiffness": 0.7}, {"length": 0.8, "bending_stiffness": 0.4}]
    beam = msgspec.convert(msgspec.to_builtins(CANTILEVER) | {"section": sections}, Beam)
    bent = NonlinearHermite(beam, 13, axial_stiffness=3e3).bend((2.0, 1e-4))
    assert bent.tip[0] - L == pytest.approx(2.0 * L / 3e3, rel=1e-6)


def test_under_a_moment_its_frequencies_are_those_of_the_chain_and_a_follower_force_is_refused():
    chain = replace(build_system(CANTILEVER, 40), loads=(LinkLoad(link=40, at=L / 40, moment=0.3),))
    angles = np.diff(bend(CANTILEVER, 40, moment=0.3).angles, prepend=0.0)
    links = linearise(chain, ChainState(angles, np.zeros(40))).frequencies()[:3] / (2.0 * pi)
    assert elements(16).bend(moment=0.3).frequencies_hz()[:3] == pytest.approx(links, rel=2e-4)
    with pytest.raises(InputError, match="follower"):
        elements(4).bend(follower=0.3).frequencies_hz()


def test_links_and_elements_move_alike_on_a_base_that_turns_and_shakes():
    beam = Beam(length=0.8, bending_stiffness=0.9, mass_per_length=1.7, supports=("clamped", "free"))
    shake = tabulated(np.linspace(0.0, 1.0, 21), 0.07 * np.sin(np.linspace(0.0, 1.0, 21) * 5.0) ** 2)
    base = Base(rotation=polynomial(0.4, 0.0, 1.3, -0.8), x=polynomial(0.0, 0.1, 0.6), y=shake, hub_radius=0.3)
    times, tips = [0.0, 0.3, 0.7], []
    for count in (20, 40):
        chain = replace(build_system(beam, count), base=base, gravity=(1.1, -4.0))
        tips.append(motion.simulate(chain, at_rest(chain), times, tolerance=1e-9).in_base()[:, -1])
    model, forces = NonlinearHermite(beam, 12, axial_stiffness=1e5), Forces(gravity=np.array([1.1, -4.0]))
    start_rate = np.zeros_like(model.rest)  # both start at rest on the moving base
    run = large_motion(model, times, forces=forces, base=base, start_rate=start_rate, tolerance=1e-8)
    assert run.tip == pytest.approx(tips[1] + (tips[1] - tips[0]) / 3.0, abs=1e-4)
    assert abs(run.tip[:, 1]).max() > 0.1


def test_a_mode_loses_the_energy_that_steps_of_the_mean_size_take_and_up_to_as_much_by_their_changes():
    model = elements(6, axial=1e4)
    omega, span = 2.0 * pi * model.bend().frequencies_hz()[1], 40.0 * 2.0 * pi
    start, shapes = model.rest.copy(), HermiteModel(CANTILEVER, 6).modes(2).shapes
    for k in (0, 1):
        start[:, k, 1] = 3e-5 * shapes(model.nodes, k)[1]
    run = large_motion(model, [0.0, span / omega], start=start, tolerance=5e-7)
    x = span / run.steps
    mean = 1.0 - np.exp(2.0 * span * generalised_alpha(RHO).undamped(np.array(x)).real)
    assert mean == pytest.approx(2.0 * span * x**3 * 0.2**3 / 1.8**3 / 2.0, rel=0.15)  # Chung and Hulbert
    assert mean < run.energy_lost < 2.0 * mean


def test_free_flight_keeps_momentum_and_energy():
    beam = Beam(length=1.0, bending_stiffness=1.0, mass_per_length=1.0, supports=("free", "free"))
    model = NonlinearHermite(beam, 8, axial_stiffness=1e3)
    s, rate = model.nodes, np.zeros_like(model.rest)
    rate[:, 0] = np.stack([0.3 + 0.0 * s, 2.0 * s - 0.4], axis=1)
    rate[:, 1, 1] = 2.0
    flight = large_motion(model, [0.0, 0.4, 1.1], start=model.rest, start_rate=rate)
    x, speeds = np.linspace(0.0, 1.0, 401), []
    for k in (0, 2):
        r, v = (
            np.array([model.weights(at).ravel() @ values[k].reshape(-1, 2) for at in x])
            for values in (flight.states, flight.rates)
        )
        speeds.append([*np.trapezoid(v, x, axis=0), np.trapezoid(r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0], x)])
    assert speeds[1] == pytest.approx(speeds[0], abs=1e-5)
    assert abs(flight.energy_lost) < 2e-5


def test_under_small_forces_it_moves_as_the_linear_elements_do():
    strip = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
    drive = (PointForce(position=0.11, amplitude=0.01), PointForce(position=0.4, amplitude=0.01, phase_deg=90.0))
    times = np.linspace(0.0, 0.02, 11)
    linear = simulate(
        strip,
        Excitation(drive, 120.0, 0.0),
        0.02,
        model="fem",
        count=12,
        start="rest",
        keep=Keep(at=(0.23,), samples=11),
    )
    bent = large_motion(NonlinearHermite(strip, 12), times, drive=drive, frequency_hz=120.0, tolerance=1e-9)
    expected = linear.deflection[:, 0]
    assert abs(bent.position(0.23)[:, 1] - expected).max() < 0.02 * abs(expected).max()


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"loss_factor": 0.01}, "loss_factor"),
        ({"tension": 3.0}, "tension"),
        ({"mass": ({"position": 0.4, "mass": 0.1},)}, "mass"),
    ],
)
def test_what_the_elements_do_not_have_is_refused(change, text):
    beam = msgspec.convert(msgspec.to_builtins(CANTILEVER) | change, Beam)
    with pytest.raises(InputError, match=text):
        NonlinearHermite(beam, 6)
    with pytest.raises(InputError, match="axial stiffness"):
        NonlinearHermite(CANTILEVER, 6).bend(1.0)
