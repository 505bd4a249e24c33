"""Bodies that turn on a beam that is let go or thrown: their rotary inertia has its share, at ends and between.

The reference is the textbook's elements with their bodies on the nodes: a shape of third degree is its nodal values and
slopes, so that its modes' shares are v^T M w without any fit, and its energies are closed forms.
"""

import numpy as np
import pytest
from driven_reference import Elements
from hypothesis import example, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from numpy.polynomial import Polynomial
from scipy.linalg import eigh

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.motion.free_vibration import _of_lines, free_vibration
from verify.motion.simulate import simulate
from verify.segments.in_time import time_basis

L, EI, LINE = 0.83, 4.1, 0.37
BLADE = Beam(length=L, bending_stiffness=EI, mass_per_length=LINE, supports=("clamped", "free"))
INSTRUMENT = PointMass(position=L, mass=0.21, rotary_inertia=1.7e-3)
PARTS = {"analytic": None, "fem": 23, "segment": 50}
FINE = 50


def tip_body(inertia=1.7e-3, supports=("clamped", "free")):
    mass = 0.21 if supports[1] == "free" else 0.0
    return replace(BLADE, supports=supports, mass=(PointMass(position=L, mass=mass, rotary_inertia=inertia),))


def let_go(beam, shape=None, model="segment", count=None, time=1e-9, **asked):
    size = {"modes": 40} if model == "analytic" else {"count": count or PARTS[model]}
    asked = {"model": model, "samples": 2} | size | asked
    return free_vibration(beam, shape, time, **asked)


def held(supports, a=0.7):
    """A shape of third degree over s = x/L, centimetres, that ends take which are clamped, guided, pinned or free."""
    left, right = supports
    if left == "guided":
        return 0.01 * Polynomial([1 + a, 0, -1, -a])
    return (
        0.01
        * Polynomial([0, 0, 1] if left == "clamped" else [0, 1, a])
        * Polynomial([1, -1] if right == "pinned" else [1, a])
    )


def kinetic(beam, speed):
    """Half of the integral of rho A v^2, of m v^2 and of J v'^2."""
    squares, slope = (speed * speed).integ(), speed.deriv()
    bodies = ((m.position / L, m.mass, m.rotary_inertia) for m in beam.mass)
    line = beam.mass_per_length * L * (squares(1) - squares(0))
    return 0.5 * line + 0.5 * sum(m * speed(s) ** 2 + j * (slope(s) / L) ** 2 for s, m, j in bodies)


def elastic(beam, shape):
    """Half of the integral of EI w''^2, of what springs and the axial force hold."""
    bends, slope = shape.deriv(2), shape.deriv()
    bent, turned = ((one * one).integ() for one in (bends, slope))
    total = beam.bending_stiffness / L**3 * (bent(1) - bent(0)) + beam.tension / L * (turned(1) - turned(0))
    springs = ((s.position / L, s.stiffness, s.rotational) for s in beam.spring)
    return 0.5 * total + 0.5 * sum(k * shape(s) ** 2 + c * (slope(s) / L) ** 2 for s, k, c in springs)


def along(shape):
    return lambda x: shape(np.asarray(x) / L)


class Modal:
    """Modes of elements written out, let go from nodal values and slopes."""

    def __init__(self, beam):
        places = {one.position for one in (*beam.mass, *beam.spring)} - {0.0, L}
        even = np.linspace(0.0, L, FINE + 1)
        # none nearer to a place than half a part: low modes lose their digits beside an element of a hundredth of one
        far = [at for at in even if at in (0.0, L) or all(abs(at - one) > 0.5 * L / FINE for one in places)]
        nodes = np.array(sorted([*far, *places]))
        self.model = Elements(beam, [(beam.pieces[0], length) for length in np.diff(nodes)])
        keep = np.ix_(self.model.free, self.model.free)
        values, self.vectors = eigh((self.model.bent + self.model.held)[keep], self.model.mass[keep])
        self.omegas = np.sqrt(values)

    def shares(self, shape):
        s = self.model.nodes / L
        nodal = np.stack([shape(s), shape.deriv()(s) / L], axis=1).ravel()
        return self.vectors.T @ (self.model.mass @ nodal)[self.model.free]

    def after(self, time, shape, speed, zeta, x):
        sigma, turning = zeta * self.omegas, self.omegas * np.sqrt(1 - zeta**2)
        q, v = self.shares(shape), self.shares(speed)
        s = np.sin(turning * time) / turning
        now = np.exp(-sigma * time) * (q * np.cos(turning * time) + (v + sigma * q) * s)
        return np.array([self.model.row(at)[self.model.free] @ self.vectors @ now for at in x])


# ------------------------------------------------------------------------------------------------------------ at the tip


@pytest.mark.parametrize("count", [20, 40, 80, 160])
def test_a_blade_with_a_body_at_its_tip_has_the_energy_that_it_was_bent_with(count):
    """EI/2 times the integral of w''^2; a body that no inertia was counted of took thousands of times as much."""
    shape = Polynomial([0, 0, 0.011])
    found = let_go(tip_body(), along(shape), count=count).elastic[0]
    assert found == pytest.approx(elastic(tip_body(), shape), rel=0.02 / count)


@pytest.mark.parametrize("inertia", [1e-9, 3e-6, 2.7e-3, 0.4, 71.0])
@pytest.mark.parametrize("supports", [("clamped", "free"), ("pinned", "pinned"), ("guided", "pinned")])
def test_whatever_a_body_at_an_end_weighs_the_models_are_let_go_alike(supports, inertia):
    beam, shape, x = tip_body(inertia, supports), held(supports), [0.23, 0.61]
    own = Modal(beam)
    expected = own.after(0.31, shape, Polynomial([0]), 0.04, x)
    for model, part in (("analytic", 1e-5), ("fem", 1e-5), ("segment", 2e-3)):
        found = let_go(beam, along(shape), model, time=0.31, modal_damping=0.04, at=x)
        assert found.deflection[-1] == pytest.approx(expected, abs=part * 0.01), model
        assert abs(found.amplitudes[:3]) == pytest.approx(
            abs(own.shares(shape)[:3]), abs=2e-4 * abs(own.shares(shape)[0])
        )


def test_shares_of_links_come_with_order_four():
    shape = Polynomial([0, 0, 0.011])
    own = abs(Modal(tip_body()).shares(shape)[:2])
    off = [abs(abs(let_go(tip_body(), along(shape), count=n).amplitudes[:2]) - own).max() for n in (16, 32)]
    assert 3.5 < np.log2(off[0] / off[1]) < 4.6


# ------------------------------------------------------------------------------------------------------ on any beam


@st.composite
def carriers(draw):
    """A beam with bodies that turn, at its ends too where these turn, and springs; a shape and a speed that it takes."""
    supports = draw(
        st.sampled_from([("clamped", "free"), ("pinned", "pinned"), ("guided", "pinned"), ("clamped", "pinned")])
    )
    whole = LINE * L
    sizes = st.tuples(st.floats(0.02, 2.0), st.floats(-5.0, 0.0).map(lambda power: 10**power))
    places = [n / 100 for n in draw(st.lists(st.integers(5, 93), max_size=2, unique=True))]
    masses = [
        PointMass(position=s * L, mass=m * whole, rotary_inertia=j * whole * L**2)
        for s, (m, j) in zip(places, [draw(sizes) for _ in places], strict=True)
    ]
    for at, support in zip((0.0, L), supports, strict=True):
        if support in ("pinned", "free"):
            m, j = draw(sizes)
            mass = m * whole if support == "free" else 0.0
            masses.append(PointMass(position=at, mass=mass, rotary_inertia=j * whole * L**2))
    spring = PointSpring(
        position=(draw(st.integers(10, 90)) + 0.37) / 100 * L, stiffness=draw(st.floats(0.0, 60.0)) * EI / L**3 + 1.0
    )
    turned = PointSpring(position=L, rotational=draw(st.floats(0.1, 9.0)) * EI / L)
    tension = draw(st.sampled_from([0.0, 13.0]))
    beam = replace(
        BLADE,
        supports=supports,
        mass=tuple(masses),
        spring=(spring, turned) if draw(st.booleans()) else (spring,),
        tension=tension,
    )
    a = draw(st.floats(-0.9, 1.1))
    return beam, held(supports, a), 3.0 * held(supports, 0.3 - a)


@settings(max_examples=20, deadline=None)
@given(carriers())
def test_what_is_thrown_has_the_speed_of_all_that_it_carries(made):
    """Half of rho A v^2, m v^2 and J v'^2, in every model; the squares of the shares less what is left unread."""
    beam, _, speed = made
    for model, part in (("fem", 1e-5), ("segment", 2e-3)):
        found = let_go(beam, None, model, velocity=along(speed))
        assert found.kinetic[0] == pytest.approx(kinetic(beam, speed), rel=part)


NEAR_A_NODE = replace(
    BLADE,
    supports=("clamped", "free"),
    mass=(PointMass(position=L, mass=LINE * L, rotary_inertia=LINE * L**3),),
    spring=(PointSpring(position=0.26007 * L, stiffness=1.0),),
)
"""A reference with a node at the spring and one beside it lost the lowest frequency here."""


@settings(max_examples=20, deadline=None)
@given(carriers())
@example((NEAR_A_NODE, Polynomial([0, 0, 0.01]), Polynomial([0, 0, 0.03, 0.009])))
def test_let_go_and_thrown_it_is_where_elements_written_out_say(made):
    beam, shape, speed = made
    x, time, zeta = [0.19, 0.57, 0.74], 0.047, 0.03
    expected = Modal(beam).after(time, shape, speed, zeta, x)
    size = abs(shape(np.linspace(0, 1, 50))).max() + time * abs(speed(np.linspace(0, 1, 50))).max()
    for model, part in (("fem", 2e-3), ("segment", 2e-2)):
        found = let_go(beam, along(shape), model, velocity=along(speed), time=time, modal_damping=zeta, at=x)
        assert found.deflection[-1] == pytest.approx(expected, abs=part * size), model
        assert found.elastic[0] == pytest.approx(elastic(beam, shape), rel=0.1), model


@pytest.mark.parametrize("model", ["fem", "segment"])
def test_a_run_goes_on_from_a_body_let_go(model):
    beam, x = tip_body(), [0.31, L]
    asked = {"model": model, "count": PARTS[model], "modal_damping": 0.02, "at": x}
    shape = along(held(beam.supports))
    begun = free_vibration(beam, shape, 0.09, velocity=along(held(beam.supports, 0.1)), **asked)
    whole = free_vibration(beam, shape, 0.21, velocity=along(held(beam.supports, 0.1)), samples=3, **asked)
    still = PointForce(position=0.2, amplitude=1e-12)
    found = simulate(beam, still, 17.0, 0.12, continue_from=begun, ledger=False, **asked)
    assert found.deflection[-1] == pytest.approx(whole.deflection[-1], abs=1e-10)


# -------------------------------------------------------------------------------------------------- how a body turns


@pytest.mark.parametrize("model", ["analytic", "fem", "segment"])
def test_at_a_corner_a_body_turns_by_the_mean_of_both_sides(model):
    """Straight lines in a table and the same as a function: the fastest of them, a body's own J times that turn."""
    corner, up, heavy = 0.41 * L, 0.013, 9.0
    body = PointMass(position=corner, rotary_inertia=heavy)
    beam = replace(BLADE, supports=("pinned", "pinned"), mass=(body,))
    table = [0.0, corner, L], [0.0, up, 0.0]
    by_table, by_function = (let_go(beam, None, model, velocity=one) for one in (table, lambda x: np.interp(x, *table)))
    mean = 0.5 * (up / corner - up / (L - corner))
    assert by_table.kinetic[0] == pytest.approx(0.5 * heavy * mean**2 + LINE * L * up**2 / 6, rel=2e-3)
    assert by_function.amplitudes == pytest.approx(by_table.amplitudes)
    assert by_function.kinetic[0] == pytest.approx(by_table.kinetic[0], rel=1e-5)


@pytest.mark.parametrize("length", [2e-8, 0.7, 5e9])
def test_on_which_line_of_a_table_a_body_stands_is_a_matter_of_the_beams_length(length):
    """Within 1e-9 of it a corner is where the body is; a hundredth of a millionth beside it is a straight line."""
    x, values = length * np.array([0.0, 0.41, 1.0]), np.array([0.0, 0.3, -0.1])
    left, right = 0.3 / 0.41 / length, -0.4 / 0.59 / length
    places = length * np.array([0.0, 0.41 - 1e-8, 0.41 - 7e-10, 0.41 + 7e-10, 0.41 + 1e-8, 1.0])
    mean = 0.5 * (left + right)
    assert _of_lines(x, values, places) == pytest.approx([left, left, mean, mean, right, right], rel=1e-12)


def test_a_mode_that_is_given_as_a_function_is_found_alone_with_its_bodies():
    """Its slope is read on both sides of a body, where it bends of a sudden."""
    beam = replace(BLADE, mass=(PointMass(position=0.3 * L, mass=0.1, rotary_inertia=4e-3), INSTRUMENT))
    one = free_vibration(beam, 3, 1e-9, amplitude=0.01, model="analytic", modes=9, samples=2)
    x = np.linspace(0.0, L, 7)
    own = np.argmax(abs(one.amplitudes))

    def third(at):
        from verify.exact.in_time import time_basis as exact_basis

        return one.amplitudes[own] * exact_basis(beam, 9).shapes(np.asarray(at, dtype=float), 0)[own]

    found = free_vibration(beam, third, 1e-9, model="analytic", modes=9, samples=2, at=x)
    assert found.amplitudes == pytest.approx(one.amplitudes, abs=1e-8 * abs(one.amplitudes[own]))
    assert found.unread < 1e-7


def test_links_have_the_turn_of_a_body_at_an_end_beside_their_line():
    """As many modes as free joints and the body: their turns are what its inertia is orthogonal by."""
    count, inertia = 19, INSTRUMENT.rotary_inertia
    basis = time_basis(replace(BLADE, mass=(INSTRUMENT,)), count)
    assert len(basis.omegas) == count + 1
    turns = basis.body_turns()
    assert turns.shape == (count + 1, 1)
    assert inertia * (turns**2).sum() == pytest.approx(1.0)  # 1/J is what a couple on the body alone turns it by
    slopes = basis.shapes(np.array([L]), 1)
    assert turns[:2] == pytest.approx(slopes[:2], rel=1e-2)
    assert abs(turns[-1] / slopes[-1] - 1.0) > 0.01
