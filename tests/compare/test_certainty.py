"""Lists that show no known discretisation, lists of models in space, and causes with a name.

References: frequency equations solved here, Timoshenko's closed form, dense elements with a taper or a crack.
"""

from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from msgspec.structs import replace
from reference.closed_lists import BETAS, euler, pinned_timoshenko, space, written
from reference.discrete_beams import rigid_links, varying_beam
from shared_lists import compared, table

from verify.compare.compare import Options, compare
from verify.compare.reading import read_words
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointMass

STEEL = {"youngs_modulus": 206e9, "density": 7850.0}
CLAMPED = Beam(length=0.45, width=0.03, thickness=0.004, supports=("clamped", "free"), **STEEL)
THICK = Beam(length=0.6, width=0.045, thickness=0.03, **STEEL)
BAR = Beam(length=1.0, width=0.15, thickness=0.1, youngs_modulus=68e9, density=2700.0, supports=("clamped", "free"))
EI, MASS = CLAMPED.bending_stiffness, CLAMPED.mass_per_length


@pytest.mark.parametrize(("nu", "kappa", "digits"), [(0.2, pi**2 / 12, 5), (0.45, 0.9, 7)])
def test_shear_of_another_nu_or_kappa_is_no_discretisation(nu, kappa, digits):
    hertz = pinned_timoshenko(THICK, nu, kappa, 8)
    data = compared(THICK, hertz, digits=digits).data
    assert (data["status"], data["best"]["model"], data["identified"]) == ("exact", "analytic", False)


@pytest.mark.parametrize(("digits", "how"), [(3, "cut"), (4, "off"), (6, "rounded")])
def test_digits_of_an_exact_list_are_no_discretisation_and_no_factor(digits, how):
    cells = [written(f, digits, how, i) for i, f in enumerate(euler(CLAMPED))]
    data = compared(CLAMPED, cells, digits=digits).data
    assert (data["status"], data["best"]["model"]) == ("exact", "analytic")
    assert data["best"]["fault"]["kind"] in ("none", "constants")
    assert data["passed"]


@pytest.mark.parametrize("decimals", [2, 4])
def test_constants_by_hand_are_constants(decimals):
    data = compared(CLAMPED, euler(CLAMPED, np.round(BETAS, decimals))).data
    assert (data["status"], data["best"]["fault"]["label"]) == ("exact", f"{decimals} decimals")


def dense(cause, size):
    if cause == "crack":
        at, softness = size
        crack = (at, EI / (softness * CLAMPED.length))
        return varying_beam(CLAMPED.length, lambda x: EI, lambda x: MASS, *CLAMPED.supports, crack)
    slope = size / CLAMPED.length
    return varying_beam(
        CLAMPED.length, lambda x: EI * (1 - slope * x) ** 3, lambda x: MASS * (1 - slope * x), "clamped", "free"
    )


@pytest.mark.parametrize(("cause", "size"), [("crack", (1, 0.01)), ("crack", (30, 0.2)), ("taper", 0.02)])
def test_cracked_and_tapered_beams_are_of_no_known_family(cause, size):
    """Cracks at 1/120 and 1/4 of the length, of 1 % and 20 % of the beam's own softness."""
    result = compared(CLAMPED, dense(cause, size)[:6], digits=7)
    assert (result.data["status"], result.data["identified"]) == ("unknown", False)
    assert result.data["best"]["fault"]["kind"] == "none"
    assert "None of the known family" in result.summary


def test_three_digits_leave_several_models_and_not_the_exact_beam():
    """Recorded as 2EI/l, N = 20; mode 5 of the exact beam is 1.3 % off."""
    strip = Beam(length=1.0, width=0.04, thickness=0.008, youngs_modulus=210e9, density=7850.0, supports=BAR.supports)
    cells = ("6.7", "42", "117", "228", "375")
    result = compare(SimpleNamespace(name="beam", beam=strip), read_words(cells), None, Options(count=20))
    assert (result.data["status"], result.data["best"]["wall"]) == ("ambiguous", "half")
    assert {one["model"] for one in result.data["alternatives"]} == {"segment", "fem"}


def test_change_at_the_wall_is_in_newton_metres():
    """Of EI/l: 2EI/l, or Gregory's compliances 3/8, 7/6, 23/24."""
    summary = compared(CLAMPED, rigid_links(CLAMPED, 20, 1.0)[:6], count=20).summary
    assert all(f"{factor * 20 * EI / CLAMPED.length:.6g}" in summary for factor in (1, 2, 8 / 3, 6 / 7, 24 / 23))


def test_motions_of_a_bar_in_space_are_sorted_in_rad_per_second():
    few = compared(BAR, [509.0, 763.0], digits=3, count=20)
    assert (few.data["unit"], few.data["passed"]) == ("rad/s", True)
    assert [row["motion"] for row in table(few, "Other motions")] == ["bending, width"]
    hertz, motions = space(BAR)
    result = compared(BAR, 2 * pi * np.array(hertz), digits=6, count=20)
    assert result.data["unit"] == "rad/s"
    assert [row["entry"] for row in table(result, "Modes")] == [
        i for i, name in enumerate(motions, 1) if name == "bending"
    ]
    assert [row["motion"] for row in table(result, "Other motions")] == [name for name in motions if name != "bending"]


@pytest.mark.parametrize(("wall", "twist"), [("full", 654.0086), (None, 0.95 * 654.0086)])
def test_motions_with_a_common_error_are_sorted(wall, twist):
    """Links with EI/l at both planes' walls and a right torsion; all frequencies 5 % too low."""
    planes = [rigid_links(one, 20, 1.0 if wall else 2.0)[:4] for one in (BAR, replace(BAR, width=0.1, thickness=0.15))]
    hertz = np.sort([*(1.0 if wall else 0.95) * np.ravel(planes), twist])[:7]
    result = compared(BAR, hertz, digits=6, count=20)
    assert [row["motion"] for row in table(result, "Other motions")].count("bending, width") == 3
    assert (result.data["best"]["wall"], result.data["best"]["fault"]["kind"]) == (
        ("full", "none") if wall else ("half", "factor")
    )


def test_pairs_of_a_round_bar_and_six_rigid_motions():
    rod = Beam(length=1.0, shape="round", diameter=0.02, supports=("free", "free"), **STEEL)
    hertz = [0.0] * 6 + list(np.repeat(np.array([4.730040745, 7.853204624]) ** 2 * rod.wave_constant / (2 * pi), 2))
    result = compared(rod, hertz, digits=7, count=20)
    assert result.data["passed"]
    assert [row["mode"] for row in table(result, "Other motions")] == [1, 2]


@pytest.mark.parametrize(("unit", "values"), [("rad2/s2", lambda f: (2 * pi * f) ** 2), ("s", lambda f: 1 / f)])
def test_squares_and_periods_are_recognised(unit, values):
    data = compared(CLAMPED, values(euler(CLAMPED)), digits=7).data
    assert (data["unit"], data["passed"]) == (unit, True)


def test_rigid_motions_of_squares_are_rounding_errors_in_any_order():
    plane = euler(BAR, [4.730040745, 7.853204624, 10.995607838])
    squares = (2 * pi * np.sort([*plane, *1.5 * plane])) ** 2
    noise = [-1e-3, 2e-3, -4e-4, 1e-3, 3e-3, 5e-3]
    data = compared(replace(BAR, supports=("free", "free")), [*noise, *squares], digits=7, count=20).data
    assert (data["unit"], data["passed"]) == ("rad2/s2", True)


def test_a_factor_that_is_not_likelier_but_agrees_is_of_too_few_frequencies():
    """Elsewhere the nearest differ by 1e-3, here all four digits agree."""
    data = compared(CLAMPED, 0.976 * rigid_links(CLAMPED, 20)[:5], digits=4).data
    assert (data["status"], data["best"]["wall"], data["best"]["fault"]["kind"]) == ("few", "half", "factor")


FACTORS = {"sqrt(g)": sqrt(9.80665), "plane strain": 1 / sqrt(1 - 0.33**2), "exchanged": 0.03 / 0.004}


@pytest.mark.parametrize("name", FACTORS)
def test_factor_has_its_name(name):
    result = compared(CLAMPED, FACTORS[name] * rigid_links(CLAMPED, 20)[:6], digits=8, count=20)
    assert result.data["best"]["fault"]["kind"] == "factor"
    assert name in result.summary


def test_mass_that_the_list_has_not_is_named():
    loaded = replace(CLAMPED, mass=(PointMass(position=0.45, mass=0.1),))
    result = compared(loaded, rigid_links(CLAMPED, 20)[:6], digits=8, count=20)
    assert result.data["best"]["fault"] == {"kind": "scene", "label": "beam.mass", "parameter": 1.0}


@pytest.mark.parametrize(("factor", "wall", "stiffness"), [(0.95, "half", 2.0), (1.02, "full", 1.0)])
def test_wrong_modulus_names_no_wrong_wall(factor, wall, stiffness):
    data = compared(CLAMPED, factor * rigid_links(CLAMPED, 20, stiffness)[:6], digits=6, count=20).data
    walls = {one["wall"] for one in (data["best"], *data["alternatives"])}
    assert wall in walls
    assert not data["identified"] or walls == {wall}
