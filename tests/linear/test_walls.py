"""How a chain is held at a clamped end, and what each wall costs."""

from itertools import combinations_with_replacement, product

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analytic_modes import ExactModel
from verify.errors import InputError, NoFigureError
from verify.exact import closed_forms
from verify.options import SUPPORTS, WALLS
from verify.segment_model import SegmentModel
from verify.segments import walls
from verify.segments.walls import wall_factors

PAIRS = list(product(SUPPORTS, SUPPORTS))
UNORDERED = list(combinations_with_replacement(SUPPORTS, 2))
CLAMPED = [pair for pair in UNORDERED if "clamped" in pair]


def errors(beam, mode, counts, **settings):
    exact = closed_forms.frequency_hz(beam, mode)
    return [SegmentModel(beam, n, **settings).modes(mode).frequencies_hz[-1] / exact - 1 for n in counts]


def order(beam, mode, counts, **settings):
    first, second = errors(beam, mode, counts, **settings)
    return np.log(abs(first / second)) / np.log(counts[1] / counts[0])


@pytest.mark.parametrize("supports", [pair for pair in UNORDERED if pair not in CLAMPED], ids="-".join)
@pytest.mark.parametrize("wall", WALLS)
def test_without_a_clamped_end_a_chain_is_of_order_four_whatever_the_wall(titanium_strip, supports, wall):
    """And its leading error is -mu^4/1440, mu = beta L/N."""
    beam = replace(titanium_strip, supports=supports)
    assert order(beam, 2, (40, 80), wall=wall) == pytest.approx(4.0, abs=0.04)
    leading = -((closed_forms.wavenumber_length(supports, 2) / 80) ** 4) / 1440
    assert errors(beam, 2, (80,), wall=wall)[0] == pytest.approx(leading, rel=0.02)


@pytest.mark.parametrize("supports", CLAMPED, ids="-".join)
@pytest.mark.parametrize(
    ("wall", "expected", "band"), [("half", 2.0, 0.01), ("welded", 2.0, 0.04), ("third-order", 3.0, 0.02)]
)
def test_a_clamped_end_lowers_the_order_to_that_of_its_wall(titanium_strip, supports, wall, expected, band):
    beam = replace(titanium_strip, supports=supports)
    assert order(beam, 2, (80, 160), wall=wall) == pytest.approx(expected, abs=band)
    assert SegmentModel(beam, 80, wall=wall).expected_order() == expected


@pytest.mark.parametrize("supports", CLAMPED, ids="-".join)
def test_five_corrected_joints_stay_between_orders_four_and_five(titanium_strip, supports):
    assert 4.0 < order(replace(titanium_strip, supports=supports), 2, (80, 160), wall="five-joint") < 5.1


@pytest.mark.parametrize("supports", CLAMPED, ids="-".join)
def test_gregorys_wall_tends_to_its_asymptotic_law_on_both_sides_of_the_sign_change(titanium_strip, supports):
    """mu^4 (-1/1440 + c/(12 N)) of c clamped ends."""
    beam, c = replace(titanium_strip, supports=supports), supports.count("clamped")
    laws = [
        (closed_forms.wavenumber_length(supports, 12) / n) ** 4 * (-1 / 1440 + c / (12 * n))
        for n in (60 * c, 800, 1600)
    ]
    assert laws[0] > 0 > laws[2]
    off = [abs(e / law - 1) for e, law in zip(errors(beam, 12, (800, 1600)), laws[1:], strict=True)]
    assert off[1] < 0.025
    assert off[1] < 0.5 * off[0]


@pytest.mark.parametrize(
    ("supports", "expected"),
    [(("clamped", "free"), (5.2e-9, -8.3e-6, -6.0e-4)), (("clamped", "clamped"), (3.8e-7, -3.4e-5, -1.6e-3))],
)
def test_gregorys_errors_at_forty_segments(titanium_strip, supports, expected):
    beam = replace(titanium_strip, supports=supports)
    assert [errors(beam, n, (40,))[0] for n in (1, 5, 10)] == [pytest.approx(e, rel=0.02) for e in expected]


def test_a_wall_joint_as_stiff_as_any_other_is_of_order_one(titanium_strip, monkeypatch):
    monkeypatch.setitem(walls.WALLS, "gregory", ())
    assert order(replace(titanium_strip, supports=("clamped", "free")), 2, (80, 160)) == pytest.approx(1.0, abs=0.03)


def test_corrections_of_both_walls_add_up_on_a_short_chain():
    assert wall_factors(("clamped", "clamped"), 2, "gregory") == pytest.approx(
        [1 - 5 / 8 - 1 / 24, 1 + 2 / 6, 1 - 5 / 8 - 1 / 24]
    )
    assert wall_factors(("clamped", "guided"), 3, "gregory") == pytest.approx([3 / 8, 7 / 6, 23 / 24, 1 / 2])
    assert wall_factors(("free", "clamped"), 3, "gregory") == pytest.approx([np.inf, 23 / 24, 7 / 6, 3 / 8])
    assert wall_factors(("clamped", "pinned"), 8, "gregory") == pytest.approx(
        [3 / 8, 7 / 6, 23 / 24, 1, 1, 1, 1, 1, np.inf]
    )
    # constant moment: the weights of any chain add up to its length
    for wall in ("gregory", "half", "third-order", "five-joint"):
        assert wall_factors(("clamped", "clamped"), 12, wall).sum() == pytest.approx(12.0, rel=1e-14)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_short_chains_have_all_their_elastic_modes_and_no_more(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports)
    for count in (2, 3, 5):
        model = SegmentModel(beam, count)
        if not model.n_elastic:
            continue
        found = model.modes(model.n_elastic).frequencies_hz
        assert (found > 1e-3 * found[-1]).all()
        assert np.isfinite(found).all()
        with pytest.raises(InputError, match="elastic modes"):
            model.modes(model.n_elastic + 1)


@pytest.mark.parametrize("supports", UNORDERED, ids="-".join)
def test_corrected_joints_are_of_order_four_but_two_next_to_a_clamped_wall(titanium_strip, supports):
    beam, found = replace(titanium_strip, supports=supports), {"raw": [], "corrected": []}
    for count in (80, 160):
        modes = SegmentModel(beam, count).modes(3)
        exact = ExactModel(beam).modes(3).shapes(modes.nodes, 0)[2]
        for reading, each in found.items():
            each.append(np.sqrt(np.mean((modes.readings[reading]()[2] - exact) ** 2)))
    orders = {reading: np.log2(a / b) for reading, (a, b) in found.items()}
    assert orders["raw"] == pytest.approx(2.0, abs=0.03)
    # one joint beside the wall with an error l^2 among N: order 2.5 in the L2 norm
    expected, band = (2.5, 0.45) if "clamped" in supports else (4.0, 0.05)
    assert orders["corrected"] == pytest.approx(expected, abs=band)
    assert found["corrected"][1] < 0.1 * found["raw"][1]


@pytest.mark.parametrize("supports", UNORDERED, ids="-".join)
def test_curvatures_converge_with_order_four(titanium_strip, supports):
    """Joint moments; the sign change of Gregory's walls blurs it."""
    beam, off = replace(titanium_strip, supports=supports), []
    for count in (60, 120):
        modes = SegmentModel(beam, count).modes(3)
        exact = ExactModel(beam).modes(3).shapes(modes.curvature_points, 2)[2]
        off.append(np.linalg.norm(modes.curvatures()[2] - exact) / np.linalg.norm(exact))
    assert np.log2(off[0] / off[1]) == pytest.approx(4.0, abs=0.6)


@pytest.mark.parametrize("change", [{}, {"tension": 900.0}, {"foundation": 3e5}, {"tension": -70.0, "foundation": 3e4}])
@pytest.mark.parametrize("joints", ["series", "tensioned"])
def test_a_pinned_chain_resonates_at_half_waves_of_its_own_wavenumber(titanium_strip, change, joints):
    beam = replace(titanium_strip, supports=("pinned", "pinned"), **change)
    model = SegmentModel(beam, 23, joints=joints)
    for mode, frequency in enumerate(model.modes(9).frequencies_hz, 1):
        assert model.wavenumber(float(frequency)) * beam.length == pytest.approx(mode * np.pi, rel=1e-9)
    if not change:
        assert model.cut_off_hz == pytest.approx(48**0.5 * beam.wave_constant * (23 / beam.length) ** 2 / (2 * np.pi))
    assert model.wavenumber(model.cut_off_hz) * model.unit == pytest.approx(np.pi, rel=1e-6)
    remedy = "raise count" if change else "give count = 24 or more"
    with pytest.raises(NoFigureError, match=rf"frequency_hz = \d+\.\d+ lies beyond, {remedy}"):
        model.check_propagates(np.float64(1.001 * model.cut_off_hz))
