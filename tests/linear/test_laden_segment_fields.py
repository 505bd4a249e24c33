"""Shapes, readings, steady fields and motion in time of chains with something on them, and what is refused."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference.transfer import state
from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.errors import InputError, ResonanceError
from verify.exact.modes import mode_shapes
from verify.section import Section
from verify.segments.linear import solve_harmonic, solve_modes

L, EI, RHO_A = 0.73, 3.7, 0.31
M = RHO_A * L
BARE = Beam(length=L, bending_stiffness=EI, mass_per_length=RHO_A, rotary_inertia=3e-5, shear_stiffness=2e4)
BODY = PointMass(position=0.375 * L, mass=0.2 * M, rotary_inertia=0.003 * M * L**2)
STAY = PointSpring(position=0.8 * L, stiffness=900.0, rotational=3.0)
FULL = replace(BARE, mass=(BODY,), spring=(STAY,), foundation=300.0)
X = np.array([0.11, 0.29, 0.64]) * L
AT = 0.5 * L


def field_error(beam, theory, count, frequency_hz=40.0, **settings):
    exact = np.array([state(beam, theory, frequency_hz, AT, float(x))[0] for x in X])
    found = solve_harmonic(beam, (PointForce(position=AT),), frequency_hz, count, theory=theory, **settings)
    return abs(found.deflection(X) - exact).max() / abs(exact).max()


@pytest.mark.parametrize(
    ("theory", "joints", "tension", "expected"),
    [
        ("euler-bernoulli", "series", 0.0, 4.0),
        ("euler-bernoulli", "series", -8.0, 2.0),
        ("euler-bernoulli", "tensioned", -8.0, 4.0),
        ("rayleigh", "series", 0.0, 2.15),
        ("rayleigh", "tensioned", 0.0, 4.0),
        ("timoshenko", "series", 0.0, 2.15),
    ],
)
@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("guided", "pinned"), ("clamped", "free")])
def test_a_driven_lossy_beam_with_everything_on_it(supports, theory, joints, tension, expected):
    beam = replace(FULL, supports=supports, loss_factor=0.03, tension=tension)
    first, second = (field_error(beam, theory, count, joints=joints) for count in (80, 160))
    assert np.log2(first / second) == pytest.approx(expected, abs=0.3)


def test_elastic_ends_and_tip_bodies_keep_a_driven_field_at_order_four():
    """Where the loss is the beam's, not the springs'."""
    clamp = PointSpring(position=0.0, stiffness=900.0, rotational=30.0)
    tip = replace(BODY, position=L)
    for beam in (
        replace(BARE, supports=("free", "free"), spring=(clamp,), loss_factor=0.05),
        replace(BARE, supports=("clamped", "free"), mass=(tip,), loss_factor=0.05),
    ):
        first, second = (field_error(beam, "euler-bernoulli", count) for count in (120, 240))
        assert np.log2(first / second) == pytest.approx(4.0, abs=0.15)
        assert second < 2e-7


@pytest.mark.parametrize(
    ("theory", "rotary", "bound"),
    [("euler-bernoulli", 0.0, 1e-6), ("rayleigh", 0.0, 1e-5), ("euler-bernoulli", 1.0, 2.5e-3)],
)
def test_modes_are_normalised_with_everything_that_has_mass(theory, rotary, bound):
    """Integral of rho A phi^2 + m phi^2 + J phi'^2 and the links' own turning are one, and orthogonal.

    The line's slope where a couple bends it is of order 1.
    """
    body = replace(BODY, rotary_inertia=rotary * BODY.rotary_inertia)
    beam = replace(FULL, supports=("clamped", "free"), mass=(body, PointMass(position=L, mass=0.1 * M)))
    modes = solve_modes(beam, 3, 200, theory=theory)
    x = (np.arange(4000) + 0.5) / 4000 * L
    w, slope = modes.deflection(x), modes.slope(x)
    total = RHO_A * (w @ w.T) * L / 4000
    if theory == "rayleigh":
        total += BARE.rotary_inertia * (slope @ slope.T) * L / 4000
    for one in beam.mass:
        at, turn = modes.deflection(one.position), modes.slope(one.position)
        total += one.mass * (at @ at.T) + one.rotary_inertia * (turn @ turn.T)
    assert total == pytest.approx(np.eye(3), abs=bound)


def test_the_moment_at_an_elastic_end_is_its_springs():
    """To order 2, the joints beside it read as they stand off the smooth line."""
    spring = PointSpring(position=0.0, rotational=5.0 * EI / L)
    lacks = []
    for count in (80, 160):
        modes = solve_modes(replace(BARE, spring=(spring,)), 3, count)
        lacks.append(EI * modes.curvatures()[:, 0] / (spring.rotational * modes.slope(0.0)[:, 0]) - 1.0)
    assert np.log2(lacks[0] / lacks[1]) == pytest.approx(np.full(3, 2.0), abs=0.03)
    assert lacks[1] == pytest.approx([-1.66e-4, -4.17e-4, -7.76e-4], rel=0.01)


@pytest.mark.parametrize("joints", ["series", "tensioned"])
def test_curvatures_under_axial_force_are_the_beams(joints):
    """Pinned: every mode is a sine, its curvature beta^2 times its deflection; joints of any kind read it."""
    modes = solve_modes(replace(BARE, tension=50.0), 2, 160, joints=joints)
    beta = 2 * np.pi / L
    amplitude = np.sqrt(2.0 / M)
    expected = -amplitude * beta**2 * np.sin(beta * modes.curvature_points)
    bound = 2e-6 if joints == "tensioned" else 3e-4
    assert abs(modes.curvatures()[1] - expected).max() < bound * amplitude * beta**2


STEPPED = replace(
    BARE,
    supports=("clamped", "free"),
    section=(
        Section(length=0.31, bending_stiffness=29.6, mass_per_length=0.62, rotary_inertia=2.4e-4, shear_stiffness=4e3),
        Section(length=0.42, bending_stiffness=3.7, mass_per_length=0.31),
    ),
)


@pytest.mark.parametrize(
    ("theory", "added"),
    [
        ("euler-bernoulli", {}),
        ("rayleigh", {}),
        ("timoshenko", {}),
        ("euler-bernoulli", {"mass": (PointMass(position=0.24, mass=0.07),)}),
        ("timoshenko", {"mass": (PointMass(position=0.24, mass=0.07),), "foundation": 300.0}),
        ("euler-bernoulli", {"tension": 40.0}),
    ],
)
def test_curvatures_on_a_step_are_the_moment_over_the_sections_own_stiffness(theory, added):
    """Order 2, as all of a stepped chain, 1 at a body's joint; the joint on the step has the curvature right of it.

    By Timoshenko's theory shear jumps there and at the body: its change is no difference across them.
    """
    beam, found = replace(STEPPED, **added), []
    for count in (146, 292):
        modes = solve_modes(beam, 2, count, theory=theory)
        exact = mode_shapes(beam, 2, modes.curvature_points, 2, theory)
        off, largest = abs(modes.curvatures() - exact), abs(exact).max(axis=1)
        assert (off.max(axis=1) / largest < 5e-4).all()
        found.append(np.linalg.norm(off, axis=1) / np.linalg.norm(exact, axis=1))
    assert np.log2(found[0] / found[1]) == pytest.approx(np.array([2.0, 1.8]), abs=0.25)
    step = int(abs(modes.nodes - 0.31).argmin())
    before, after = modes.curvatures()[:, step - 1], modes.curvatures()[:, step]
    if theory != "timoshenko":  # whose shear curves the line as well
        assert after / before == pytest.approx(8.0, rel=0.2)


def test_a_loaded_chain_refuses_its_own_resonance():
    resonance = float(solve_modes(FULL, 2, 20).frequencies_hz[1])
    with pytest.raises(ResonanceError, match="of mode 2 of the segment model"):
        solve_harmonic(FULL, (PointForce(position=AT),), resonance, 20)


@pytest.mark.parametrize(
    ("change", "settings", "message"),
    [
        ({"tension": 1e5}, {"joints": "tensioned"}, "leaves no stiffness in a joint"),
        ({"foundation": 1.0}, {"wall": "welded"}, "with nothing on them"),
        ({}, {"attachment": "levr"}, "did you mean 'lever'"),
        ({"tension": -40.0, "supports": ("clamped", "free")}, {}, "buckles at 17.1"),
    ],
)
def test_what_no_chain_can_do_is_refused_in_a_sentence(change, settings, message):
    with pytest.raises(InputError, match=message):
        solve_modes(replace(BARE, **change), 2, 20, **settings)
