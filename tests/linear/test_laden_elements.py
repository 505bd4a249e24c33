"""Elements with masses, springs, axial force and a foundation: orders, digits, buckling, fields, motion, refusals.

Held against states along the beam in 30 digits (`states_reference`) and closed forms written here.
"""

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference.transfer import frequency_near, state
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring

STRIP = Beam(length=0.43, width=0.017, thickness=0.013, youngs_modulus=113e9, density=4470.0)
PROPPED = replace(STRIP, supports=("clamped", "pinned"))
CANTILEVER = replace(STRIP, supports=("clamped", "free"))
L, EI, MASS = STRIP.length, STRIP.bending_stiffness, STRIP.mass_per_length * STRIP.length
PINNED = STRIP


def mass(at, heavy=0.0, rotary=0.0):
    """In lengths and masses of the beam."""
    return PointMass(position=at * L, mass=heavy * MASS, rotary_inertia=rotary * MASS * L**2)


def spring(at, stiffness=0.0, rotational=0.0):
    return PointSpring(position=at * L, stiffness=stiffness * EI / L**3, rotational=rotational * EI / L)


EVERYTHING = replace(
    STRIP,
    supports=("free", "guided"),
    tension=9 * EI / L**2,
    foundation=900 * EI / L**4,
    mass=(mass(0.2, 0.3, 0.01),),
    spring=(spring(0.6, 300, 9),),
    section=(Section(length=0.4 * L), Section(length=0.6 * L, thickness=0.019)),
)
AT_NODES = {
    "a mass and a rotary inertia at the tip": replace(CANTILEVER, mass=(mass(1.0, 0.7, 0.02),)),
    "two masses": replace(PROPPED, mass=(mass(0.2, 0.3), mass(0.6, 0.7))),
    "a rotary inertia": replace(PROPPED, mass=(mass(0.6, rotary=0.02),)),
    "a spring": replace(PROPPED, spring=(spring(0.6, 300),)),
    "a rotational spring": replace(PROPPED, spring=(spring(0.6, rotational=30),)),
    "an elastic clamp": replace(STRIP, supports=("free", "pinned"), spring=(spring(0.0, 300, 7),)),
    "a rotational spring on a pin": replace(STRIP, spring=(spring(1.0, rotational=7),)),
    "tension": replace(PROPPED, tension=23 * EI / L**2),
    "compression": replace(PROPPED, tension=-11 * EI / L**2),
    "a foundation": replace(PROPPED, foundation=900 * EI / L**4),
    "everything": EVERYTHING,
}
BETWEEN = {
    "a mass": replace(PROPPED, mass=(mass(0.137, 0.7),)),
    "a rotary inertia": replace(PROPPED, mass=(mass(0.137, rotary=0.02),)),
    "a spring": replace(PROPPED, spring=(spring(0.137, 3000),)),
    "a rotational spring": replace(PROPPED, spring=(spring(0.137, rotational=30),)),
}
COUNTS = np.array([5, 10, 20, 40, 80])


def errors(beam, counts=COUNTS, n_modes=5, theory="euler-bernoulli"):
    """Relative, (counts, modes)."""
    fine = HermiteModel(beam, 100, theory=theory).modes(n_modes).frequencies_hz
    exact = np.array([frequency_near(beam, theory, hertz) for hertz in fine])
    return np.array([HermiteModel(beam, n, theory=theory).modes(n_modes).frequencies_hz / exact - 1 for n in counts])


@pytest.mark.parametrize("added", AT_NODES)
def test_frequencies_are_of_order_four_from_above_whatever_stands_on_the_beam(added):
    found = errors(AT_NODES[added])
    assert (found > 0).all()
    orders = np.log2(found[1:-1] / found[2:])
    assert (orders > 3.8).all()
    assert (orders < 4.01).all()
    assert orders[-1] == pytest.approx(np.full(5, 3.995), abs=0.01)
    assert 1e-12 < found[-1].min() < found[-1].max() < 3e-6


@pytest.mark.parametrize("added", BETWEEN)
def test_order_four_is_kept_where_it_stands_off_the_nodes_of_equal_elements(added):
    """Stretches share the elements as their lengths are, unevenly on coarse meshes: orders over four doublings."""
    found = errors(BETWEEN[added], [20, 320])
    assert np.log2(found[0] / found[1]) / 4 == pytest.approx(np.full(5, 4.01), abs=0.02)


def discrete_hz(beam, mode, count):
    """Sine deflections and cosine slopes in the two nodal equations of equal Hermite elements, in 40 digits."""
    with mp.workdps(40):
        length, mu = mp.mpf(beam.length) / count, mode * mp.pi / count
        stiff, heavy = mp.mpf(beam.bending_stiffness), mp.mpf(beam.mass_per_length)
        pull, ground = beam.tension * length**2 / stiff, beam.foundation * length**4 / stiff
        c, s = mp.cos(mu), mp.sin(mu)
        m = [(312 + 108 * c) / 420, 26 * s / 420, (8 - 6 * c) / 420]
        bend, axial = [24 - 24 * c, -12 * s, 8 + 4 * c], [(72 - 72 * c) / 30, -6 * s / 30, (8 - 2 * c) / 30]
        k = [b + pull * a + ground * one for b, a, one in zip(bend, axial, m, strict=True)]
        a, b, d = m[0] * m[2] - m[1] ** 2, k[0] * m[2] + k[2] * m[0] - 2 * k[1] * m[1], k[0] * k[2] - k[1] ** 2
        square = 2 * d / (b + mp.sqrt(b * b - 4 * a * d))
        return mp.sqrt(square * stiff / (heavy * length**4)) / (2 * mp.pi)


@pytest.mark.parametrize(("count", "digits"), [(7, 4e-15), (49, 1e-14), (300, 5e-14), (2000, 2e-13)])
@pytest.mark.parametrize(("pull", "ground"), [(7.0, 900.0), (-9.0, 900.0), (-9.0, 0.0), (0.0, 13.0)])
def test_frequencies_under_axial_force_on_a_foundation_are_the_discrete_dispersion(pull, ground, count, digits):
    beam = replace(PINNED, tension=pull * EI / L**2, foundation=ground * EI / L**4)
    found = HermiteModel(beam, count).modes(6).frequencies_hz
    assert [float(f / discrete_hz(beam, n + 1, count) - 1) for n, f in enumerate(found)] == pytest.approx(
        [0.0] * 6, abs=digits
    )


@pytest.mark.parametrize("size", [1e6, 1e13, 1e30])
def test_springs_however_stiff_are_pins_and_spoil_no_digit(size):
    stiff = replace(STRIP, supports=("free", "guided"), spring=(spring(0.0, size), spring(1.0, size / 7)))
    pinned = replace(STRIP, supports=("pinned", "clamped"))
    for count in (20, 400):
        found = HermiteModel(stiff, count).modes(3).frequencies_hz
        off = found / HermiteModel(pinned, count).modes(3).frequencies_hz - 1
        assert (off < 1e-12).all()
        assert (off > -3000 / size - 1e-12).all()


def test_a_heavy_tip_swings_on_the_cantilevers_static_stiffness():
    """3 EI / L^3 on the tip's mass and 33/140 of the beam's."""
    beam = replace(CANTILEVER, mass=(mass(1.0, 1e6),))
    expected = np.sqrt(3 * EI / L**3 / (MASS * (1e6 + 33 / 140))) / (2 * np.pi)
    for count in (20, 300):
        assert HermiteModel(beam, count).modes(1).frequencies_hz[0] == pytest.approx(expected, rel=1e-10)


BUCKLING = {
    ("pinned", "pinned"): np.pi**2,
    ("clamped", "free"): np.pi**2 / 4,
    ("clamped", "clamped"): 4 * np.pi**2,
    ("clamped", "pinned"): 4.493409457909064**2,
    ("guided", "guided"): np.pi**2,
}


@pytest.mark.parametrize("supports", BUCKLING)
def test_elements_buckle_above_eulers_load_by_order_four(supports):
    """Wave number k of the buckled shape, mu = k l: mu^4 / 720."""
    exact = BUCKLING[supports]
    loads = {
        n: HermiteModel(replace(STRIP, supports=supports), n).buckling_load() * L**2 / EI / exact - 1 for n in (10, 20)
    }
    for count, off in loads.items():
        assert off == pytest.approx((np.sqrt(exact) / count) ** 4 / 720, rel=0.1)
    assert 3.85 < np.log2(loads[10] / loads[20]) < 4.01


def test_a_beam_on_a_foundation_buckles_in_the_shorter_wave():
    """P = (n pi / L)^2 EI + k_f (L / n pi)^2 at its least, n = 2 of this one."""
    beam = replace(PINNED, foundation=1900 * EI / L**4)
    expected = min(n**2 * np.pi**2 + 1900 / (n**2 * np.pi**2) for n in (1, 2, 3))
    assert HermiteModel(beam, 40).buckling_load() * L**2 / EI == pytest.approx(expected, rel=2e-6)
    assert expected == pytest.approx(4 * np.pi**2 + 1900 / (4 * np.pi**2))


def test_compression_up_to_the_meshs_own_buckling_is_solved_and_refused_beyond():
    load = HermiteModel(PROPPED, 20).buckling_load()
    below = HermiteModel(replace(PROPPED, tension=-0.9999 * load), 20).modes(1).frequencies_hz[0]
    assert below == pytest.approx(0.01 * HermiteModel(PROPPED, 20).modes(1).frequencies_hz[0], rel=0.05)
    for work in (
        lambda beam: HermiteModel(beam, 20).modes(1),
        lambda beam: HermiteModel(beam, 20).harmonic([PointForce(position=0.1)], 70.0),
        lambda beam: HermiteModel(beam, 20).receptance([0.1], np.array([70.0]), np.array([0.2])),
        lambda beam: HermiteModel(beam, 20).time_basis(),
    ):
        with pytest.raises(InputError, match=r"beyond its buckling: 20 elements buckle at [0-9.]+ N"):
            work(replace(PROPPED, tension=-1.0001 * load))


def test_a_beam_free_to_tilt_stands_no_compression():
    with pytest.raises(InputError, match="buckle at 0 N"):
        HermiteModel(replace(STRIP, supports=("pinned", "free"), tension=-1e-3), 20).modes(1)


@pytest.mark.parametrize("loss", [0.0, 0.03])
@pytest.mark.parametrize(
    "added", ["everything", "compression", "an elastic clamp", "a mass and a rotary inertia at the tip"]
)
def test_driven_fields_are_of_order_four_with_loss_in_the_beam_alone(added, loss):
    """Springs, axial force and foundation have none; deflections and slopes at three places."""
    beam = replace(AT_NODES[added], loss_factor=loss)
    hertz, x = 1.31 * HermiteModel(beam, 40).modes(2).frequencies_hz[1], np.array([0.1, 0.7, 0.95]) * L
    w, slope = np.array([state(beam, "euler-bernoulli", hertz, 0.4 * L, at)[:2] for at in x]).T
    found = [HermiteModel(beam, n).harmonic([PointForce(position=0.4 * L)], hertz) for n in (20, 40, 80)]
    off = np.array([abs(field.deflection(x) - w).max() / abs(w).max() for field in found])
    turned = np.array([abs(field.slope(x) - slope).max() / abs(slope).max() for field in found])
    assert np.log2(off[:-1] / off[1:]) == pytest.approx(4.0, abs=0.1)
    assert 1e-10 < off[-1] < 1e-6
    assert turned[-1] < 1e-6


def test_a_plain_section_is_the_shape_that_has_its_figures():
    plain = Beam(length=L, bending_stiffness=EI, mass_per_length=MASS / L, supports=("clamped", "free"))
    assert HermiteModel(plain, 20).modes(3).frequencies_hz == pytest.approx(
        HermiteModel(CANTILEVER, 20).modes(3).frequencies_hz, rel=1e-14
    )
