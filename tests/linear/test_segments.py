"""Chains of rigid links: dispersion, leading errors, buckling, shapes, driven fields, close attachments."""

from itertools import combinations_with_replacement, product
from math import pi

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import ABSTRACT, supported
from tests.reference.transfer import state
from verify import Beam, ExactModel, PointForce, PointMass, PointSpring, Section, SegmentModel
from verify.errors import InputError, NoFigureError
from verify.problem.supports import SUPPORTS

L, EI, RHO_A, RHO_I, GA = 0.73, 3.7, 0.31, 3e-5, 2e4
UNORDERED = ["".join(pair) for pair in combinations_with_replacement("PCFG", 2)]


def on(letters, **changes):
    return supported(ABSTRACT, letters, **changes)


def errors(beam, count, modes, theory="euler-bernoulli", **settings):
    found = SegmentModel(beam, count, theory=theory, **settings).modes(modes).frequencies_hz
    return found / ExactModel(beam, theory).modes(modes).frequencies_hz - 1.0


# --- Frequencies -----------------------------------------------------------------------------------------------------


def discrete_hz(mode, count, theory="euler-bernoulli", tension=0.0, foundation=0.0):
    """Pinned equal links, S = 2 sin(mu / 2) / l, in 30 digits (`docs/theory.md`)."""
    with mp.workdps(30):
        link = mp.mpf(L) / count
        s2 = 4 * mp.sin(mode * mp.pi / (2 * count)) ** 2 / link**2
        soft = mp.mpf(RHO_A) / GA if theory == "timoshenko" else mp.mpf(0)
        rotary = mp.mpf(RHO_I) if theory != "euler-bernoulli" else mp.mpf(0)
        a = soft * (rotary + RHO_A * link**2 / 12)
        b = rotary * s2 + RHO_A * (1 - link**2 * s2 / 6) + soft * EI * s2
        c = EI * s2**2 + tension * s2
        square = 2 * c / (b + mp.sqrt(b * b - 4 * a * c)) + mp.mpf(foundation) / RHO_A
        return float(mp.sqrt(square) / (2 * mp.pi))


@pytest.mark.parametrize("count", [2, 8, 49, 300, 2000])
@pytest.mark.parametrize(
    ("theory", "added"),
    [
        ("euler-bernoulli", {}),
        ("euler-bernoulli", {"tension": -61.0, "foundation": 900.0}),
        ("euler-bernoulli", {"tension": 173.0, "foundation": 900.0}),
        ("rayleigh", {}),
        ("timoshenko", {}),
    ],
)
def test_pinned_links_have_the_frequencies_of_their_dispersion(theory, added, count):
    modes = 250 if (theory, count, added) == ("euler-bernoulli", 300, {}) else min(count - 1, 40)
    modes = min(modes, 20) if theory == "timoshenko" else modes  # the second family begins above
    found = SegmentModel(replace(ABSTRACT, **added), count, theory=theory).modes(modes).frequencies_hz
    exact = np.array([discrete_hz(n, count, theory, **added) for n in range(1, modes + 1)])
    assert found == pytest.approx(exact, rel=1e-13)
    assert found[:5] == pytest.approx(exact[:5], rel=3e-14 if added else 2e-14)


BETA = 2 * pi / L


def test_eq_1_as_printed_is_corrected_joints_where_the_modulus_is_uniform(titanium_strip):
    lighter = (Section(length=0.3), Section(length=0.43, density=1000.0))
    for beam in (titanium_strip, replace(titanium_strip, section=lighter)):
        printed, series = (SegmentModel(beam, 20, joints=j).modes(5).frequencies_hz for j in ("printed", "series"))
        assert printed == pytest.approx(series, rel=1e-13)


@pytest.mark.parametrize("supports", list(product(SUPPORTS, SUPPORTS)), ids="-".join)
def test_short_chains_have_all_their_elastic_modes_and_no_more(titanium_strip, supports):
    for count in (2, 3, 5):
        model = SegmentModel(replace(titanium_strip, supports=supports), count)
        if model.n_elastic:
            found = model.modes(model.n_elastic).frequencies_hz
            assert (found > 1e-3 * found[-1]).all()
            with pytest.raises(InputError, match="elastic modes"):
                model.modes(model.n_elastic + 1)


@pytest.mark.parametrize("letters", ["PP", "CF", "CC"])
def test_a_chain_buckles_with_order_two_and_a_tensioned_chain_with_order_four(letters):
    wave = {"PP": pi, "CF": pi / 2, "CC": 2 * pi}[letters]
    series, tensioned = (
        [SegmentModel(on(letters), n, joints=j).buckling_load() / (EI * (wave / L) ** 2) - 1 for n in (40, 80)]
        for j in ("series", "tensioned")
    )
    assert np.log2(series[0] / series[1]) == pytest.approx(2.0, abs=0.03)
    assert series[1] == pytest.approx(-((wave / 80) ** 2) / 12, rel=0.03)
    assert abs(tensioned[1]) < 0.02 * abs(series[1])
    if letters == "PP":
        assert np.log2(tensioned[0] / tensioned[1]) == pytest.approx(4.0, abs=0.02)


# --- Shapes ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("letters", UNORDERED)
def test_corrected_joints_are_of_order_four_and_curvatures_too(letters):
    """Next to a clamp two joints have errors l^2: order 2.5 in the L2 norm. Raw joints are of order 2."""
    clamped, off = "C" in letters, {"raw": [], "corrected": [], "curvature": []}
    for count in (80, 160):
        modes = SegmentModel(on(letters), count).modes(3)
        exact = ExactModel(on(letters)).modes(3)
        line = exact.shapes(modes.nodes, 0)[2]
        for reading in ("raw", "corrected"):
            off[reading].append(np.sqrt(np.mean((modes.readings[reading]()[2] - line) ** 2)))
        bend = exact.shapes(modes.curvature_points, 2)[2]
        off["curvature"].append(np.linalg.norm(modes.curvatures()[2] - bend) / np.linalg.norm(bend))
    orders = {name: np.log2(a / b) for name, (a, b) in off.items()}
    assert orders["raw"] == pytest.approx(2.0, abs=0.03)
    assert orders["corrected"] == pytest.approx(*(2.5, None, 0.45) if clamped else (4.0, None, 0.05))
    assert orders["curvature"] == pytest.approx(4.0, abs=0.6)  # Gregory's clamps change the sign of the error
    assert off["corrected"][1] < 0.1 * off["raw"][1]


@pytest.mark.parametrize(("joints", "bound"), [("series", 3e-4), ("tensioned", 2e-6)])
def test_curvatures_under_axial_force_are_those_of_the_beam(joints, bound):
    modes = SegmentModel(replace(ABSTRACT, tension=50.0), 160, joints=joints).modes(2)
    expected = -np.sqrt(2.0 / (RHO_A * L)) * BETA**2 * np.sin(BETA * modes.curvature_points)
    assert abs(modes.curvatures()[1] - expected).max() < bound * abs(expected).max()


STEPPED = on(
    "CF",
    section=(
        Section(length=0.31, bending_stiffness=29.6, mass_per_length=0.62, rotary_inertia=2.4e-4, shear_stiffness=4e3),
        Section(length=0.42, bending_stiffness=3.7, mass_per_length=0.31),
    ),
)
NEAR_STEP = {"mass": (PointMass(position=0.24, mass=0.07),)}


@pytest.mark.parametrize(
    ("theory", "added"),
    [
        ("euler-bernoulli", {}),
        ("rayleigh", {}),
        ("timoshenko", {}),
        ("euler-bernoulli", NEAR_STEP),
        ("timoshenko", NEAR_STEP | {"foundation": 300.0}),
        ("euler-bernoulli", {"tension": 40.0}),
    ],
)
def test_curvatures_at_a_step_are_the_moment_over_the_stiffness_of_either_section(theory, added):
    """Order 2 of all of a stepped chain, 1 at the joint of a body; by Timoshenko's theory shear jumps at both."""
    beam, found = replace(STEPPED, **added), []
    for count in (146, 292):
        modes = SegmentModel(beam, count, theory=theory).modes(2)
        exact = ExactModel(beam, theory).modes(2).shapes(modes.curvature_points, 2)
        off, largest = abs(modes.curvatures() - exact), abs(exact).max(axis=1)
        assert (off.max(axis=1) / largest < 5e-4).all()
        found.append(np.linalg.norm(off, axis=1) / np.linalg.norm(exact, axis=1))
    assert np.log2(found[0] / found[1]) == pytest.approx(np.array([2.0, 1.8]), abs=0.25)
    step = int(abs(modes.nodes - 0.31).argmin())
    before, after = modes.curvatures()[:, step - 1], modes.curvatures()[:, step]
    if theory != "timoshenko":  # shear curves the line as well
        assert after / before == pytest.approx(8.0, rel=0.2)


# --- Driven fields ---------------------------------------------------------------------------------------------------

X = np.array([0.11, 0.29, 0.64]) * L
BODY = PointMass(position=0.375 * L, mass=0.2 * RHO_A * L, rotary_inertia=0.003 * RHO_A * L**3)
STAY = PointSpring(position=0.8 * L, stiffness=900.0, rotational=3.0)


def field_order(beam, theory, counts, **settings):
    exact = np.array([state(beam, theory, 40.0, 0.5 * L, float(x))[0] for x in X])
    models = (SegmentModel(beam, count, theory=theory, **settings) for count in counts)
    fields = [model.harmonic(PointForce(position=0.5 * L), 40.0).deflection(X) for model in models]
    off = [abs(one - exact).max() / abs(exact).max() for one in fields]
    return np.log2(off[0] / off[1]) / np.log2(counts[1] / counts[0])


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
@pytest.mark.parametrize("letters", ["PP", "GP", "CF"])
def test_driven_fields_with_body_spring_foundation_and_loss_have_the_order_of_the_chain(
    letters, theory, joints, tension, expected
):
    added = {"mass": (BODY,), "spring": (STAY,), "foundation": 300.0, "loss_factor": 0.03, "tension": tension}
    counts = (160, 320) if (theory, joints) == ("rayleigh", "series") else (80, 160)
    assert field_order(on(letters, **added), theory, counts, joints=joints) == pytest.approx(expected, abs=0.3)


@pytest.mark.parametrize(
    ("load", "reading", "expected"),
    [("lever", "raw", 2.0), ("reciprocal", "raw", 2.0), ("reciprocal", "links", 2.0), ("reciprocal", "corrected", 4.0)],
)
def test_orders_of_loads_and_readings(titanium_strip, load, reading, expected):
    """Within half a link of a guided end, and within two of a pinned one."""
    beam = replace(titanium_strip, supports=("guided", "pinned"))
    forces = (PointForce(position=0.0037, amplitude=0.7), PointForce(position=0.73 * 5 / 6), PointForce(position=0.711))
    x, off = np.linspace(0.01, 0.72, 57), []
    exact = ExactModel(beam).harmonic(forces, 123.0).deflection(x)
    for n in (60, 480):
        found = SegmentModel(beam, n, load=load, reading=reading).harmonic(forces, 123.0).deflection(x)
        off.append(abs(found - exact).max() / abs(exact).max())
    assert np.log2(off[0] / off[1]) / 3 == pytest.approx(expected, abs=0.3)


@pytest.mark.parametrize("change", [{}, {"tension": 900.0}, {"foundation": 3e5}, {"tension": -70.0, "foundation": 3e4}])
@pytest.mark.parametrize("joints", ["series", "tensioned"])
def test_a_pinned_chain_resonates_at_half_waves_of_its_own_wavenumber(titanium_strip, change, joints):
    beam = replace(titanium_strip, **change)
    model = SegmentModel(beam, 23, joints=joints)
    for mode, frequency in enumerate(model.modes(9).frequencies_hz, 1):
        assert model.wavenumber(float(frequency)) * beam.length == pytest.approx(mode * np.pi, rel=1e-9)
    if not change:
        assert model.cut_off_hz == pytest.approx(48**0.5 * beam.wave_constant * (23 / beam.length) ** 2 / (2 * np.pi))
    assert model.wavenumber(model.cut_off_hz) * model.unit == pytest.approx(np.pi, rel=1e-6)
    remedy = "raise count" if change else "give count = 24 or more"
    with pytest.raises(NoFigureError, match=rf"frequency_hz = \d+\.\d+ exceeds the cut-off .* segments, {remedy}"):
        model.check_propagates(np.float64(1.001 * model.cut_off_hz))


@pytest.mark.parametrize("settings", [{}, {"theory": "rayleigh", "joints": "tensioned"}, {"theory": "timoshenko"}])
def test_a_field_decays_by_the_wavenumber_with_dashpots_in_the_joints(settings):
    model = SegmentModel(
        Beam(length=80.0, width=0.02, thickness=0.02, youngs_modulus=70e9, density=2700.0, supports=("free", "free")),
        200, joint_dashpot=200.0, reading="raw", **settings,
    )  # fmt: skip
    here, there = model.harmonic(PointForce(position=5.1), 300.0).deflection(model.unit * np.array([80.0, 81.0]))
    k = 1j * np.log(there / here) / model.unit
    assert k.imag < -0.8
    assert model.wavenumber(300.0) == pytest.approx(k, rel=1e-9)


# --- Close attachments -----------------------------------------------------------------------------------------------

BLADE = Beam(length=1.2, width=0.03, thickness=0.003, youngs_modulus=200e9, density=7800.0)
BRACKET = replace(
    BLADE, supports=("clamped", "clamped"), mass=(PointMass(position=0.013, mass=3.0, rotary_inertia=1e-2),)
)
FLANGES = replace(
    BLADE,
    supports=("pinned", "free"),
    mass=(
        PointMass(position=0.5, mass=0.3, rotary_inertia=1e-3),
        PointMass(position=0.503, mass=0.2, rotary_inertia=2e-3),
    ),
)


@pytest.mark.parametrize(
    ("beam", "worst"),
    [(BRACKET, {15: 0.03, 30: 2.5e-3, 60: 2e-4, 120: 2e-6}), (FLANGES, {30: 7e-4, 60: 5e-5, 240: 6e-8})],
)
def test_a_bracket_close_to_a_clamp_and_two_flanges_in_a_link_are_attached_as_to_the_beam(beam, worst):
    """Uncorrected weights err by up to 34 % and 0.5 %. Flanges have order four."""
    for count, error in worst.items():
        assert 0.1 * error < abs(errors(beam, count, 5)).max() < error
    if beam is FLANGES:
        coarse, fine = (abs(errors(beam, n, 5))[3] for n in (30, 120))
        assert 3.9 < np.log2(coarse / fine) / 2 < 4.3


def random_beam(seed):
    """Bodies and a spring anywhere, on any supports."""
    draw = np.random.default_rng(7000 + seed)
    supports = tuple(str(one) for one in draw.choice(["pinned", "clamped", "free", "guided"], 2))
    places = draw.uniform(0.005, 1.195, 4)
    sizes = zip(places[:3], 10 ** draw.uniform(-2, 0.6, 3), 10 ** draw.uniform(-5, -1.5, 3), strict=True)
    masses = tuple(PointMass(position=float(x), mass=float(m), rotary_inertia=float(j)) for x, m, j in sizes)
    stiffness, rotational = float(10 ** draw.uniform(2, 7)), float(10 ** draw.uniform(0, 4))
    springs = (PointSpring(position=float(places[3]), stiffness=stiffness, rotational=rotational),)
    return replace(BLADE, supports=supports, mass=masses[: int(draw.integers(1, 4))], spring=springs)


@pytest.mark.parametrize("seed", range(0, 30, 2))
def test_five_modes_of_beams_with_random_bodies_err_by_less_than_half_a_per_cent_at_forty_links(seed):
    """Uncorrected weights: over 1 % for 5 % of such beams, at most 13 %."""
    assert abs(errors(random_beam(seed), 40, 5)).max() < 5e-3


def test_two_bodies_that_approach_become_a_single_body():
    apart, together = (
        SegmentModel(replace(FLANGES, mass=(FLANGES.mass[0], replace(FLANGES.mass[1], position=0.5 + off))), 31)
        for off in (1e-7, 0.0)
    )
    assert apart.modes(4).frequencies_hz == pytest.approx(together.modes(4).frequencies_hz, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "settings", "message"),
    [
        ({"tension": 1e5}, {"joints": "tensioned"}, "leaves no stiffness in a joint"),
        ({"foundation": 1.0}, {"wall": "welded"}, "without attachments"),
        ({}, {"attachment": "levr"}, "did you mean 'lever'"),
        ({"tension": -40.0, "supports": ("clamped", "free")}, {}, "buckling load 17.1"),
    ],
)
def test_a_chain_without_a_solution_is_an_input_error(change, settings, message):
    with pytest.raises(InputError, match=message):
        SegmentModel(replace(ABSTRACT, **change), 20, **settings).modes(2)
