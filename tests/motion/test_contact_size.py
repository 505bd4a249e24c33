"""How fast the surface moves, and how large friction's answer is beside it: from the beam itself, formula by formula."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import PointForce
from verify.exact import modes as analytic_modes
from verify.models.catalogue import MODELS
from verify.models.fields import HarmonicField
from verify.motion.contact import FELT, coupling_of, surface_speed
from verify.motion.simulate import simulate
from verify.motion.surface import basis_of
from verify.motion.turning import couple, modal_turning, turned_by
from verify.slider import Slider

HERTZ = 1310.0
PRESSED = Slider(mass=1e-9, mu=0.23, preload=0.031)  # so light that friction alone is felt, its weight 1e-8 N


UNFELT = 0.0
"""A place that gives way to no force, m/N: the slider's inertia is not felt there, and friction alone is sized."""


TURNS = 0.31 - 0.17j
"""Of a place: its slope under a unit couple, rad/(N m)."""


def friction_size(slider, beam, frequency_hz, speed, turning=TURNS):
    """Speed that full friction gives to the surface over `speed`: the part of coupling that friction has."""
    return coupling_of(slider, beam, frequency_hz, speed, UNFELT, turning).friction_size


MISSED = {"fem": 0.067, "segment": 0.3}
"""In l/EI, the most by which parts of length l turn less under a couple than a beam."""


def turned(beam, a, frequency_hz=HERTZ):
    """Slope of an undamped pinned beam under a unit couple at a: its waves and near fields between the pins."""
    k, b = float(np.sqrt(2 * np.pi * frequency_hz / beam.wave_constant)), beam.length - a
    near = np.cosh(k * a) * np.cosh(k * b) / np.sinh(k * beam.length)
    return abs(near - np.cos(k * a) * np.cos(k * b) / np.sin(k * beam.length)) / (2 * beam.bending_stiffness * k)


def wave(beam, amplitude, k, frequency_hz=HERTZ):
    """The field amplitude e^{-ikx} on a beam, whatever drives it."""
    return HarmonicField(
        model="analytic",
        count=None,
        beam=beam,
        frequency_hz=frequency_hz,
        forces=(),
        shapes=lambda x, derivative: amplitude * (-1j * k) ** derivative * np.exp(-1j * k * x),
    )


@pytest.mark.parametrize("x", [0.0, 0.0317, 0.41, 0.73])
def test_the_surface_of_a_travelling_wave_has_one_speed_wherever_it_is_asked(titanium_strip, x):
    """|w'| = k A at every phase: its real part alone would pass through zero and change its sign."""
    field = wave(titanium_strip, 1.3e-6 * np.exp(0.7j), 47.0)
    expected = 0.5 * 0.0023 * 2 * np.pi * HERTZ * 47.0 * 1.3e-6
    assert surface_speed(field, x) == pytest.approx(expected, rel=1e-12)


def test_a_slope_that_falls_gives_the_speed_of_one_that_rises(titanium_strip):
    still = replace(titanium_strip, loss_factor=0.0)
    force = PointForce(position=0.21, amplitude=2.7)
    field = analytic_modes.solve_harmonic(still, [force], HERTZ)
    places = np.linspace(0.02, 0.71, 60)
    slopes = field.slope(places)
    assert (slopes.real < 0).sum() > 10
    assert (slopes.real > 0).sum() > 10
    step = 1e-5
    for x in places[::7]:
        rise = (field.deflection(x + step) - field.deflection(x - step))[0] / (2 * step)
        expected = 0.5 * still.thickness * 2 * np.pi * HERTZ * abs(rise)
        assert surface_speed(field, float(x)) == pytest.approx(expected, rel=1e-5, abs=1e-9)


def test_full_friction_turns_a_long_beam_as_a_pair_of_forces_at_its_surface_does(titanium_strip):
    """The moment (h/2) mu N, as two forces a hair apart on a beam of 1500 wavelengths whose losses swallow the echo."""
    k = float(np.sqrt(2 * np.pi * HERTZ / titanium_strip.wave_constant))
    apart = 1e-5 / k
    long = replace(titanium_strip, length=1500 * 2 * np.pi / k, loss_factor=0.01)
    moment = 0.5 * long.thickness * PRESSED.mu * PRESSED.normal_force
    middle = 0.4137 * long.length
    pair = [
        PointForce(position=middle - 0.5 * apart, amplitude=-moment / apart),
        PointForce(position=middle + 0.5 * apart, amplitude=moment / apart),
    ]
    answered = analytic_modes.solve_harmonic(long, pair, HERTZ)
    expected = 0.5 * long.thickness * 2 * np.pi * HERTZ * abs(answered.slope([middle]))[0]
    turns = analytic_modes.solve_harmonic(long, couple(long, middle, HERTZ), HERTZ)
    assert turned_by(turns, middle) == pytest.approx((1 - 1j) / (4 * long.bending_stiffness * k), rel=0.01)  # no echo
    found = friction_size(PRESSED, long, HERTZ, 0.0071, turned_by(turns, middle)) * 0.0071
    assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("x", [0.25, 0.0, 0.73, 0.6931])
@pytest.mark.parametrize("hertz", [0.7, 61.0, HERTZ])
def test_a_couple_turns_a_pinned_beam_as_its_waves_say(titanium_strip, x, hertz):
    """By steady fields, and by modes with what lies beyond the last of them. Parts turn too little, to first order."""
    still, omega, at = replace(titanium_strip, loss_factor=0.0), 2 * np.pi * hertz, np.array([x])
    expected = turned(still, x, hertz)
    forces = couple(still, x, hertz)
    moment = sum(force.amplitude * (force.position - x) for force in forces)
    assert (sum(force.amplitude for force in forces) * 1e-6, moment) == pytest.approx((0, 1), abs=1e-9)
    assert abs(turned_by(analytic_modes.solve_harmonic(still, forces, hertz), x)) == pytest.approx(expected, rel=1e-8)
    assert abs(modal_turning(basis_of(still, "analytic", None, 60), x, at, omega, 0.0)[0]) == pytest.approx(
        expected, rel=1e-6
    )
    for model, count in (("fem", 60), ("fem", 219), ("segment", 240), ("segment", 876)):
        field = MODELS[model].solve_harmonic(still, forces, hertz, count)
        modal = complex(modal_turning(basis_of(still, model, count, 1), x, at, omega, 0.0)[0])
        less, most = MISSED[model] * still.length / count / still.bending_stiffness, 1e-4 * expected
        for found in (turned_by(field, x), modal):
            assert expected - less - most < abs(found) < expected + most


@pytest.mark.parametrize(("change", "power"), [("thickness", 2.0), ("width", 0.0), ("density", 0.0)])
def test_friction_acts_on_a_lever_of_half_the_thickness_and_so_does_its_answer(titanium_strip, change, power):
    """What the beam does under a couple is given."""
    other = replace(titanium_strip, **{change: 1.7 * getattr(titanium_strip, change)})
    before, after = (friction_size(PRESSED, beam, HERTZ, 0.0071) for beam in (titanium_strip, other))
    assert after / before == pytest.approx(1.7**power, rel=1e-12)


def test_faster_shaking_halves_what_friction_is_beside_it(titanium_strip):
    once = friction_size(PRESSED, titanium_strip, HERTZ, 0.0071)
    assert friction_size(PRESSED, titanium_strip, HERTZ, 0.0142) == pytest.approx(0.5 * once, rel=1e-14)
    assert friction_size(PRESSED, titanium_strip, 4 * HERTZ, 0.0071) == pytest.approx(4 * once, rel=1e-14)
    assert friction_size(PRESSED, titanium_strip, HERTZ, 0.0071, -3j * TURNS) == pytest.approx(3 * once, rel=1e-14)
    assert friction_size(replace(PRESSED, mu=0.69), titanium_strip, HERTZ, 0.0071) == pytest.approx(3 * once, rel=1e-14)


@pytest.mark.parametrize(("share", "two_way"), [(0.9997, False), (1.0003, True)])
def test_friction_is_felt_from_a_thousandth_of_the_surfaces_speed_on(titanium_strip, share, two_way):
    assert FELT == 1e-3
    at_limit = friction_size(PRESSED, titanium_strip, HERTZ, 1.0) / 1e-3
    found = coupling_of(PRESSED, titanium_strip, HERTZ, at_limit / share, UNFELT, TURNS)
    assert found.relative_size == found.friction_size == pytest.approx(share * 1e-3, rel=1e-12)
    assert (found.two_way, found.forced) == (two_way, False)


@pytest.mark.parametrize(("choice", "two_way"), [("one-way", False), ("two-way", True)])
@pytest.mark.parametrize("speed", [1e-9, 1e3])
def test_a_choice_of_coupling_outweighs_its_size(titanium_strip, choice, two_way, speed):
    found = coupling_of(replace(PRESSED, coupling=choice), titanium_strip, HERTZ, speed, UNFELT, TURNS)
    assert (found.two_way, found.forced) == (two_way, True)


def test_a_surface_at_rest_feels_every_slider(titanium_strip):
    found = coupling_of(PRESSED, titanium_strip, HERTZ, 0.0, UNFELT, TURNS)
    assert found.two_way
    assert found.friction_size is None
    assert found.relative_size is None


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 240)])
def test_a_run_sizes_its_coupling_by_the_steady_surface_where_the_slider_starts(titanium_strip, model, count, start):
    """At 0.25 m a slope of both phases, of which neither part is the whole."""
    slider = Slider(mass=1e-9, mu=0.23, preload=0.031, position=0.25)
    drives = (PointForce(position=0.05, amplitude=30.0), PointForce(position=0.66, amplitude=22.0, phase_deg=71.0))
    found = simulate(
        titanium_strip,
        drives,
        HERTZ,
        2e-5,
        model=model,
        count=count,
        start=start,
        slider=slider,
        samples=2,
        ledger=False,
    ).coupling
    field = analytic_modes.solve_harmonic(titanium_strip, drives, HERTZ)
    slope = field.slope([0.25])[0]
    assert min(abs(slope.real), abs(slope.imag)) > 0.5 * abs(slope)
    turns, part = turned(titanium_strip, 0.25), titanium_strip.length / (count or np.inf)
    expected = friction_size(slider, titanium_strip, HERTZ, surface_speed(field, 0.25), turns)
    missed = MISSED.get(model, 0.0) * part / titanium_strip.bending_stiffness / turns
    assert 1 - missed - 2e-3 < found.friction_size / expected < 1 + 2e-3
    assert found.relative_size == found.friction_size > 100 * found.normal_size


def test_a_mass_held_on_the_surface_moves_it_by_its_own_force_of_inertia(titanium_strip):
    """M omega^2 |G|: a force m omega^2 w where the beam gives way by G = 3e-7 - 4e-7 i m/N."""
    gives = 3e-7 - 4e-7j
    found = coupling_of(replace(PRESSED, mass=2.3e-3), titanium_strip, HERTZ, 0.0071, gives, TURNS).normal_size
    assert found == pytest.approx(2.3e-3 * (2 * np.pi * 1310.0) ** 2 * 5e-7, rel=1e-14)
    faster = coupling_of(replace(PRESSED, mass=2.3e-3), titanium_strip, 1.7 * HERTZ, 0.0071, gives, TURNS).normal_size
    assert faster / found == pytest.approx(1.7**2, rel=1e-14)


def sized(beam, friction, inertia, **other):
    """The coupling of a slider whose friction and inertia have these sizes, in thousandths."""
    slider = replace(PRESSED, mass=2.3e-6, **other)
    speed = friction_size(slider, beam, HERTZ, 1.0) / (1e-3 * friction)
    gives = 1e-3 * inertia / (2.3e-6 * (2 * np.pi * HERTZ) ** 2)
    return coupling_of(slider, beam, HERTZ, speed, gives * np.exp(2.1j), TURNS)


@pytest.mark.parametrize(
    ("friction", "inertia", "two_way"),
    [(0.9997, 0.31, False), (1.0003, 0.31, True), (0.31, 0.9997, False), (0.31, 1.0003, True), (0.83, 0.71, False)],
)
def test_the_larger_of_friction_and_inertia_decides_and_not_their_sum(titanium_strip, friction, inertia, two_way):
    found = sized(titanium_strip, friction, inertia)
    assert found.friction_size == pytest.approx(1e-3 * friction, rel=1e-12)
    assert found.normal_size == pytest.approx(1e-3 * inertia, rel=1e-12)
    assert found.relative_size == max(found.friction_size, found.normal_size)
    assert (found.two_way, found.pushes_back, found.forced) == (two_way, two_way, False)


@pytest.mark.parametrize(("friction", "two_way"), [(0.9997, False), (1.0003, True)])
def test_the_inertia_of_a_massless_slider_decides_nothing_however_large_it_is(titanium_strip, friction, two_way):
    """It is still told, as what the simplification leaves out."""
    found = sized(titanium_strip, friction, 730.0, normal="massless")
    assert found.relative_size == found.friction_size
    assert (found.two_way, found.pushes_back) == (two_way, False)
    assert found.normal_size == pytest.approx(0.73, rel=1e-12)
    assert "0.73 of its motion" in found.note


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize(("model", "count"), [("analytic", None), ("fem", 60), ("segment", 240)])
def test_a_run_sizes_inertia_by_what_the_beam_gives_way_where_the_slider_starts(titanium_strip, model, count, start):
    """G(a, a) of a pinned beam from its waves and near fields: a hundredth above the limit is felt, below not."""
    a, b, length = 0.25, 0.48, 0.73
    k = float(np.sqrt(2 * np.pi * HERTZ / titanium_strip.wave_constant))
    wave_part, near_part = (f(k * a) * f(k * b) / f(k * length) for f in (np.sin, np.sinh))
    gives = abs(wave_part - near_part) / (2 * titanium_strip.bending_stiffness * k**3)
    felt = FELT / ((2 * np.pi * HERTZ) ** 2 * gives)
    drives = (PointForce(position=0.05, amplitude=30.0), PointForce(position=0.66, amplitude=22.0, phase_deg=71.0))
    for share, two_way in ((0.99, False), (1.01, True)):
        slider = Slider(mass=share * felt, mu=1e-4, position=a)
        found = simulate(
            titanium_strip,
            drives,
            HERTZ,
            2e-5,
            model=model,
            count=count,
            start=start,
            slider=slider,
            samples=2,
            ledger=False,
        ).coupling
        assert found.normal_size == pytest.approx(share * FELT, rel=5e-3)
        assert found.relative_size == found.normal_size > found.friction_size
        assert found.two_way == two_way
