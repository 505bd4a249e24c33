"""Observed orders of a chain's frequencies against those that it expects: walls, joints, sections, attachments, loads.

Exact frequencies are those of the exact beam, whose roots `test_against_references` verifies.
"""

from itertools import combinations_with_replacement, product

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import ABSTRACT, mass, spring, supported
from verify import Beam, ExactModel, PointMass, PointSpring, Section, SegmentModel
from verify.engines.describe import describe
from verify.errors import InputError
from verify.settings import WALLS, WallRule

LEVER, TENSIONED, SHEAR = {"attachment": "lever"}, {"joints": "tensioned"}, {"theory": "timoshenko"}
RAYLEIGH, GRADED = {"theory": "rayleigh"}, {"grading": 2.0}


def on(letters, **changes):
    return supported(ABSTRACT, letters, **changes)


def order(beam, mode, counts, spread=1, **settings):
    """Observed order of a frequency; of the worst of several neighbouring counts where an error oscillates."""
    exact = ExactModel(beam, settings.get("theory", "euler-bernoulli")).modes(mode).frequencies_hz[-1]

    def error(count):
        sizes = range(count, count + spread)
        return max(abs(SegmentModel(beam, n, **settings).modes(mode).frequencies_hz[-1] / exact - 1) for n in sizes)

    return float(np.log(error(counts[0]) / error(counts[1])) / np.log(counts[1] / counts[0]))


CASES = {}
"""Name -> (beam, settings, mode, counts, spread, expected order, lowest and highest observed)."""


def add(name, beam, mode, counts, due, low, high, spread=1, **settings):
    CASES[name] = (beam, settings, mode, counts, spread, due, due + low, due + high)


# walls
for pair in combinations_with_replacement("PCFG", 2):
    for wall in (name for name, rule in WALLS.items() if not rule.fault):
        name, settings = f"{pair[0]}{pair[1]} {wall}", {"wall": wall}
        if "C" not in pair:
            add(name, on(pair), 2, (40, 80), 4, -0.04, 0.04, **settings)
        elif wall == "five-joint":
            add(name, on(pair), 2, (80, 160), 4, 0.0, 1.1, **settings)
        elif wall != "gregory":  # its error changes its sign: `test_error_laws`
            due, band = {"half": (2, 0.01), "full": (1, 0.05), "welded": (2, 0.04), "third-order": (3, 0.02)}[wall]
            add(name, on(pair), 2, (80, 160), due, -band, band, **settings)
# attachments


def attached(at):
    return {
        "mass": {"mass": mass(ABSTRACT, at, 0.4)},
        "spring": {"spring": spring(ABSTRACT, at, 200.0)},
        "rotary inertia": {"mass": mass(ABSTRACT, at, rotary=0.01)},
        "rotational spring": {"spring": spring(ABSTRACT, at, rotational=8.0)},
    }


ATTACHED, BETWEEN = attached(0.375), attached(1 / 3)
for pair, what in product(("FF", "GP"), ATTACHED):
    high = 0.7 if what == "spring" else 0.2  # a term of order 5 as well
    # of rotary inertia between pins the errors of 320 and 400 links, 2e-12 and 3e-13, are next to rounding
    joint, fine = ((40, 80), (50, 200)) if what == "rotary inertia" else ((160, 320), (100, 400))
    add(f"{pair} {what} on a joint", on(pair, **ATTACHED[what]), 1, joint, 4, -0.2, high)
    add(f"{pair} {what} between joints", on(pair, **BETWEEN[what]), 1, fine, 4, -0.2, high)
for what, counts, due, low, high in (
    ("mass", (80, 160), 2, -0.03, 0.03),
    ("spring", (80, 160), 2, -0.03, 0.03),
    ("rotary inertia", (80, 160), 1, 0.0, 0.1),
    ("rotational spring", (80, 160), 1, -0.05, 0.05),
):
    add(f"{what} by lever", on("PP", **ATTACHED[what]), 1, counts, due, low, high, **LEVER)
for what in ("rotary inertia", "rotational spring"):
    add(f"{what} by lever between joints", on("PP", **BETWEEN[what]), 1, (40, 160), 1, -0.05, 0.05, **LEVER)
TIP = {"mass": mass(ABSTRACT, 1.0, 0.4, 0.01)}
for name, beam, mode, middle in (
    ("tip body", on("CF", **TIP), 1, 0.0),
    ("elastic clamp", on("FF", spring=spring(ABSTRACT, 0.0, 300.0, 5.0)), 3, -0.05),
    ("mass at a guided end", on("GP", mass=mass(ABSTRACT, 0.0, 0.4)), 3, 0.0),
    ("spring at a guided end", on("GF", spring=spring(ABSTRACT, 0.0, 20.0)), 2, 0.0),
    ("spring at a free end", on("PF", spring=spring(ABSTRACT, 1.0, 20.0)), 2, 0.0),
    ("mass at a free end", on("FF", mass=mass(ABSTRACT, 0.0, 0.4)), 1, 0.0),
    ("rotational spring at a pin", on("PP", spring=spring(ABSTRACT, 0.0, rotational=5.0)), 1, -0.15),
    (
        "spring and inertia at a pin",
        on("PP", spring=spring(ABSTRACT, 1.0, rotational=5.0), mass=mass(ABSTRACT, 1.0, rotary=0.01)),
        1,
        -0.2,
    ),
):
    add(name, beam, mode, (120, 240), 4, middle - 0.1, middle + 0.1)
# axial force
for pair, tension in [
    *((pair, 50.0) for pair in ("PP", "GP", "FF", "CF", "CC")),
    ("PP", -30.0),
    ("CF", -12.0),
    ("CC", -30.0),
]:
    beam, name = on(pair, tension=tension), f"{pair} {tension} N"
    add(name, beam, 1, (80, 160), 2, -0.02, 0.02)
    add(f"{name} tensioned", beam, 1, (80, 160), 4, -0.07, 0.07, **TENSIONED)
# rotary inertia and shear
for pair, theory in product(("PP", "CF", "FF", "CC", "GP", "CG"), ("rayleigh", "timoshenko")):
    add(f"{pair} {theory}", on(pair), 3, (160, 320), 2, -0.03, 0.03, theory=theory)
    if "C" not in pair:
        add(f"{pair} {theory} tensioned", on(pair), 3, (80, 160), 4, -0.05, 0.05, theory=theory, **TENSIONED)
BOTH = {"mass": mass(ABSTRACT, 0.375, 0.4), "spring": spring(ABSTRACT, 0.375, 200.0)}
for what, changes in (ATTACHED | {"mass on a spring": BOTH, "mass between joints": BETWEEN["mass"]}).items():
    add(f"sheared {what}", on("PP", **changes), 1, (250, 1000), 2, -0.06, 0.06, **SHEAR)
for name, beam in {
    "FF mass": on("FF", mass=mass(ABSTRACT, 0.0, 0.4)),
    "GP mass": on("GP", mass=mass(ABSTRACT, 0.0, 0.4)),
    "CF mass on a spring": on("CF", mass=mass(ABSTRACT, 1.0, 0.4), spring=spring(ABSTRACT, 1.0, 30.0)),
    "FF elastic clamp": on("FF", spring=spring(ABSTRACT, 0.0, 300.0, 5.0)),
}.items():
    add(f"sheared {name}", beam, 1, (320, 960), 2, -0.1, 0.1, **SHEAR)
add("sheared on a foundation", on("CF", foundation=900.0), 1, (160, 320), 2, -0.03, 0.03, **SHEAR)
# sections
BAR = Beam(length=0.7, width=0.03, thickness=0.02, youngs_modulus=70e9, density=2700.0)
STEEL = Section(length=0.4, thickness=0.012, youngs_modulus=210e9, density=7850.0)
STEP = replace(BAR, supports=("clamped", "pinned"), section=(Section(length=0.3), STEEL))
add("step", STEP, 2, (96, 192), 2, -0.03, 0.03)
add("step by Eq. (1) as printed", STEP, 2, (384, 768), 1, -0.03, 0.03, joints="printed")
add("unequal links", on("PP"), 3, (60, 120), 2, -0.05, 0.05, grading=2.5)
# two reasons at once
CANTILEVER, TAUT = replace(BAR, supports=("clamped", "free")), replace(BAR, tension=4e5)
BASED = replace(BAR, foundation=1e8)
STEPPED = replace(BAR, section=(Section(length=0.3), Section(length=0.4, thickness=0.03)))
ALIKE = replace(BAR, section=(Section(length=0.3), Section(length=0.4)))
DENSER = replace(BAR, section=(Section(length=0.3, density=8000.0), Section(length=0.4)))


def laden(beam, at, rotary=0.0):
    return replace(beam, mass=(PointMass(position=at, mass=0.3, rotary_inertia=rotary),))


COUPLE = replace(BAR, spring=(PointSpring(position=0.2613, rotational=3e3),))
for name, beam, settings, due in (
    ("foundation with shear", BASED, SHEAR | TENSIONED, 2),
    ("foundation with rotary inertia", BASED, RAYLEIGH | TENSIONED, 4),
    ("tip mass by lever with shear", laden(CANTILEVER, 0.7), SHEAR | LEVER, 1),
    ("tip mass by lever", laden(CANTILEVER, 0.7), LEVER, 4),
    ("tip mass with shear", laden(CANTILEVER, 0.7), SHEAR | TENSIONED, 4),
    ("rotational spring with shear", COUPLE, SHEAR | TENSIONED, 4),
    ("mass with shear", laden(BAR, 0.2613), SHEAR | TENSIONED, 2),
    ("mass on a step of graded links", laden(STEPPED, 0.3), GRADED, 1),
    ("mass on a step of graded links with shear", laden(STEPPED, 0.3), GRADED | SHEAR, 1),
    ("mass between equal sections of graded links", laden(ALIKE, 0.3), GRADED, 1),
    ("mass by lever on a step of graded links", laden(STEPPED, 0.3), GRADED | LEVER, 2),
    ("mass on a step", laden(STEPPED, 0.3), {}, 2),
    ("body on a step", laden(STEPPED, 0.3, 2e-3), {}, 1),
    ("body between equal sections", laden(ALIKE, 0.3, 2e-3), {}, 2),
    ("body on a step of density", laden(DENSER, 0.3, 2e-3), {}, 2),
    ("step of one modulus as printed", STEPPED, {"joints": "printed"}, 2),
    ("mass in tension", laden(TAUT, 0.2613), TENSIONED, 4),
    ("tip body in tension", replace(laden(CANTILEVER, 0.7, 2e-3), tension=4e5), TENSIONED, 4),
):
    add(name, beam, 2, (280, 560), due, -0.25, 0.25, spread=3, **settings)


@pytest.mark.parametrize("case", CASES)
def test_observed_order_is_the_expected_order(case):
    beam, settings, mode, counts, spread, due, low, high = CASES[case]
    assert SegmentModel(beam, counts[0], **settings).expected_order() == due
    assert low < order(beam, mode, counts, spread, **settings) < high


@pytest.mark.parametrize(
    ("beam", "settings", "due"),
    [
        (on("FP", spring=spring(ABSTRACT, 0.0, rotational=0.4)), {"wall": "half"}, 2),
        (on("PP", tension=3.0, spring=spring(ABSTRACT, 0.3, rotational=0.4)), TENSIONED, None),
        (laden(STEPPED, 0.3, 2e-3), SHEAR, 1),
        (replace(laden(STEPPED, 0.2, 2e-3), tension=4e5), TENSIONED, 2),
        (laden(TAUT, 0.2, 2e-3), {}, 2),
    ],
)
def test_the_expected_order_is_the_least_of_several(beam, settings, due):
    assert SegmentModel(beam, 70, **settings).expected_order() == due


@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
@pytest.mark.parametrize("pair", ["CF", "CC", "CG"])
def test_tensioned_joints_remove_the_second_order_of_a_thick_chain_with_a_clamp(pair, theory):
    """Between orders 4 and 5 before Gregory's joints change the sign of the error."""
    exact = ExactModel(on(pair), theory).modes(3).frequencies_hz[2]
    tensioned, series = (
        SegmentModel(on(pair), 160, theory=theory, joints=joints).modes(3).frequencies_hz[2] / exact - 1
        for joints in ("tensioned", "series")
    )
    assert abs(tensioned) < 0.015 * abs(series)


@pytest.mark.parametrize(
    ("weights", "due", "band"),
    [((17 / 48, 59 / 48, 43 / 48, 49 / 48), 4, 0.3), ((0.2, 1.3), 2, 0.1), ((0.7,), 1, 0.1)],
)
def test_a_new_wall_rule_is_a_row_and_its_weights_give_its_order(monkeypatch, weights, due, band):
    """The first: the end weights of differences of order 4 with summation by parts (Strand, 1994)."""
    beam = on("CF")
    with monkeypatch.context() as added:
        added.setitem(WALLS, "new", WallRule("for this test", weights))
        model = SegmentModel(beam, 40, wall="new")
        assert model.expected_order() == due
        assert order(beam, 3, (160, 320), wall="new") == pytest.approx(due, abs=band)
        chain = describe(beam, 40, wall="new").frequencies_hz(n_modes=3)
        np.testing.assert_allclose(chain, model.modes(3).frequencies_hz, rtol=1e-9)
    with pytest.raises(InputError):
        SegmentModel(beam, 40, wall="new")
