"""Lists of every kind: axial force, half links, attachments, twins, gaps, pairs and unknown lines, stocky beams.

References: closed forms, dense matrices of `reference.discrete_beams`; a stepped shaft with 13 Hermite elements and a
body of 4.2 kg, and solid elements, by other programs; NAFEMS FV5 and FV71.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from msgspec.structs import replace
from reference.closed_lists import BETAS, euler, pinned_timoshenko
from reference.discrete_beams import half_links, lumped_elements, rigid_links, tensioned
from shared_lists import CANTILEVER, PROPPED, STRIP, compared, table

from verify.compare.compare import Options, compare
from verify.compare.reading import listed
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass

TAUT = Beam(length=0.6, width=0.02, thickness=0.0008, youngs_modulus=200e9, density=7850.0, tension=120.0)
SECTIONS = (Section(length=0.22), Section(length=0.33, diameter=0.04), Section(length=0.17, diameter=0.025))
BARE = Beam(length=0.72, shape="round", diameter=0.03, youngs_modulus=206e9, density=7850.0, section=SECTIONS)
SHAFT = replace(BARE, mass=(PointMass(position=0.43, mass=4.2),))
PAIRED = [85.4018, 85.4018, 416.0723, 416.0723, 1040.81, 1040.81, 1876.143, 1876.143]
THICK = Beam(length=10.0, width=2.0, thickness=2.0, youngs_modulus=200e9, density=8000.0, poissons_ratio=0.3)


def names(result, field):
    return {one[field] for one in (result.data["best"], *result.data["alternatives"])}


@pytest.mark.parametrize(("tension", "status"), [(120.0, "exact"), (37.0, "identified")])
def test_axial_force_of_a_list_is_told_from_that_of_the_scene(tension, status):
    result = compared(TAUT, tensioned(TAUT, tension, 8), digits=6)
    assert (result.data["status"], result.data["best"]["model"]) == (status, "analytic")
    fault = result.data["best"]["fault"]
    assert fault["parameter"] == pytest.approx(tension / 120.0, rel=1e-4)
    assert result.data["passed"] == (tension == 120.0)
    assert ("69.167%" in result.summary) == (tension == 37.0)


def test_axial_force_that_is_a_little_off_is_no_common_factor():
    data = compared(TAUT, tensioned(TAUT, 119.0, 8), digits=4).data
    assert (data["best"]["model"], data["best"]["fault"]["kind"], data["identified"]) == ("analytic", "tension", False)


def test_axial_force_that_is_left_out_is_named():
    result = compared(TAUT, tensioned(TAUT, 0.0, 8), digits=6)
    best = result.data["best"]
    assert (best["model"], best["fault"]["label"], result.data["passed"]) == ("analytic", "beam.tension", False)


def test_list_shorter_than_the_pieces_is_judged():
    data = compared(BARE, [125.9627, 440.0841], digits=7, count=13).data
    assert (data["status"], data["passed"]) == ("unknown", True)


@pytest.mark.parametrize("beam", [CANTILEVER, PROPPED], ids=lambda beam: "-".join(beam.supports))
def test_half_links_at_both_ends(beam):
    data = compared(beam, half_links(beam, 10)[:4], digits=7, count=10).data
    assert (data["identified"], data["best"]["mass"], data["best"]["count"]) == (True, "halves", 10)


def test_lumped_elements_with_a_body():
    """Independent of the shaft's list by another program, which follows."""
    loaded = Beam(**STRIP, supports=("clamped", "free"), mass=(PointMass(position=0.15, mass=0.05),))
    data = compared(loaded, lumped_elements(CANTILEVER, 12, bodies=[(6, 0.05)])[:5], digits=8, count=12).data
    assert (data["identified"], data["best"]["mass"]) == (True, "lumped")
    hertz = [85.445686, 414.59245, 1026.4310, 1873.4823, 3054.2207]
    data = compared(SHAFT, hertz, digits=8, count=13).data
    assert (data["identified"], data["best"]["mass"], data["best"]["count"]) == (True, "lumped", 13)
    tonnes = compared(SHAFT, np.array(hertz) / 1000**0.5, digits=6, count=13)
    assert tonnes.data["best"]["fault"]["kind"] == "factor"
    assert "kg for t" in tonnes.summary


def test_first_link_fixed_and_a_soft_wall_with_another_factor_are_twins():
    """The first of 40 links fixed is a beam of 39 links with EI/l: both are named, no joint to change is."""
    rod = Beam(
        length=1.0, shape="round", diameter=0.01, youngs_modulus=1e9, density=1000.0, supports=("clamped", "free")
    )
    result = compared(rod, [1.869498, 11.7202, 32.82765, 64.35055, 106.411, 159.0107], digits=7)
    assert (result.data["identified"], names(result, "wall") >= {"full", "rigid"}) == (False, True)
    assert "To change" not in result.summary


def test_mass_at_the_end_and_a_compliant_clamp_are_twins():
    strip = Beam(
        length=0.5, width=0.03, thickness=0.003, youngs_modulus=200e9, density=7850.0, supports=("clamped", "free")
    )
    result = compared(strip, [5.375856, 46.64699, 143.3806, 294.606], digits=7)
    kinds = {one["fault"]["kind"] for one in (result.data["best"], *result.data["alternatives"])}
    assert (result.data["identified"], kinds) == (False, {"clamp", "tip"})
    assert "0.2 kg" in result.summary


@pytest.mark.parametrize("modes", [(2, 3), (2, 3, 4, 5, 6), (1, 2, 4, 5)])
def test_entries_of_a_list_with_gaps_are_their_modes(modes):
    result = compared(CANTILEVER, euler(CANTILEVER, [BETAS[mode - 1] for mode in modes]), digits=5, count=20)
    assert [row["mode"] for row in table(result, "Modes")] == list(modes)
    assert max(abs(row["error"]) for row in table(result, "Modes")) < 1e-3
    assert not result.data["passed"]


def test_cantilever_of_nafems_71_begins_at_its_second_mode():
    beam = Beam(
        length=10.0, width=0.125, thickness=0.125, youngs_modulus=200e9, density=8000.0, supports=("clamped", "free")
    )
    result = compared(beam, [6.323, 17.683, 34.594, 57.063, 85.017], digits=5, count=20)
    assert [row["mode"] for row in table(result, "Modes")] == [2, 3, 4, 5, 6]
    assert not any("other supports" in text for text in result.warnings)


def test_torsion_is_told_from_bending_by_the_common_error():
    """Solid elements, 1.5 % too stiff in every motion; 66.95 Hz is 3.6 % below bending 4."""
    beam = Beam(length=20.0, width=1.0, thickness=0.5, youngs_modulus=1e5, density=1e-3, poissons_ratio=0.0,
                supports=("clamped", "free"))  # fmt: skip
    result = compared(beam, [2.04991, 4.04854, 12.81504, 25.12717, 35.74168, 66.94816], digits=7, count=20)
    motions = {row["entry"]: row["motion"] for row in table(result, "Other motions")}
    assert motions == {2: "bending, width", 4: "bending, width", 6: "torsion"}


@pytest.mark.parametrize(("at", "unknown"), [(4, 914.5071), (8, 3049.9592)])
def test_unknown_line_among_pairs_is_set_aside(at, unknown):
    result = compared(SHAFT, np.insert(PAIRED, at, unknown), digits=8, count=13)
    assert [row["entry"] for row in table(result, "Modes")] == [n for n in range(1, 10, 2) if n < at] + [
        n for n in range(1, 10) if n > at + 1 and n % 2 == 0
    ]
    assert result.data["best"]["mass"] == "consistent"
    assert f"entry {at + 1}, {unknown:.7g} Hz" in result.summary


def test_stocky_list_is_judged_against_the_theory_that_it_follows():
    """Closed form by Timoshenko, whose mode 5 is 41 % below that of Euler-Bernoulli; and FV5 by solid elements."""
    result = compared(THICK, pinned_timoshenko(THICK, 0.3, 5 / 6, 5), digits=7)
    assert (result.data["status"], result.data["passed"]) == ("exact", True)
    assert "Timoshenko" in result.summary
    hertz = [42.649, 42.649, 77.542, 125.0, 148.31, 148.31, 233.10, 284.55, 284.55]
    solid = compared(THICK, hertz, digits=5, count=20, within=0.02)
    assert ([row["mode"] for row in table(solid, "Modes")], solid.data["passed"]) == ([1, 2, 3], True)


def test_wrong_links_of_a_stocky_beam_are_not_excused_by_its_theory():
    data = compared(
        THICK, HermiteModel(replace(THICK, supports=("pinned", "pinned")), 5).modes(4).frequencies_hz, digits=8
    ).data
    assert (data["identified"], data["best"]["theory"], data["best"]["count"]) == (True, "euler-bernoulli", 5)


FACTORS = {
    "g = 9.81": 9.81**0.5,
    "g = 386.4": 386.4**-0.5,
    "kg for t": 1000**-0.5,
    "E in GPa": 1e-9**0.5,
    "180/pi": 180 / np.pi,
}


@pytest.mark.parametrize("name", FACTORS)
def test_factors_have_names(name):
    result = compared(CANTILEVER, FACTORS[name] * rigid_links(CANTILEVER, 20)[:6], digits=8, count=20)
    assert name in result.summary


@pytest.mark.parametrize(
    ("hertz", "options", "message"),
    [([100.0] * 400, {}, "equal"), ([27.0, 172.0, 482.0], {"count": 10**6}, "at most 2000")],
)
def test_impossible_lists_and_sizes_are_refused_at_once(hertz, options, message):
    with pytest.raises(InputError, match=message):
        compare(SimpleNamespace(name="beam", beam=CANTILEVER), listed("list", hertz), None, Options(**options))
