"""Every support in every model, and what a clamped wall does to a chain."""

from itertools import combinations_with_replacement, product

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes
from verify.elements import linear as fem_beam
from verify.errors import InputError, NoBracketError
from verify.exact import closed_forms, error_laws
from verify.judge import compare
from verify.judge.cache import SolutionCache
from verify.options import SUPPORTS, WALLS
from verify.segments import linear as segment_model
from verify.segments.walls import wall_factors

PAIRS = list(product(SUPPORTS, SUPPORTS))
UNORDERED = list(combinations_with_replacement(SUPPORTS, 2))
SOLVERS = {"segment": segment_model.solve_modes, "fem": fem_beam.solve_modes}


def errors(beam, mode, counts, model="segment", **settings):
    exact = closed_forms.frequency_hz(beam, mode)
    return [SOLVERS[model](beam, mode, n, **settings).frequencies_hz[mode - 1] / exact - 1 for n in counts]


def order(beam, mode, counts, model="segment", **settings):
    first, second = errors(beam, mode, counts, model, **settings)
    return np.log(abs(first / second)) / np.log(counts[1] / counts[0])


@pytest.mark.parametrize("supports", [p for p in UNORDERED if "clamped" not in p], ids="-".join)
@pytest.mark.parametrize("wall", WALLS)
def test_without_a_clamped_end_a_chain_is_of_order_four_whatever_the_wall(titanium_strip, supports, wall):
    beam = replace(titanium_strip, supports=supports)
    assert order(beam, 2, (40, 80), wall=wall) == pytest.approx(4.0, abs=0.04)
    assert errors(beam, 2, (80,), wall=wall)[0] == pytest.approx(
        error_laws.leading_error("segment", supports, 2, 80), rel=0.02
    )


@pytest.mark.parametrize("supports", [p for p in UNORDERED if "clamped" in p], ids="-".join)
@pytest.mark.parametrize(
    ("wall", "expected", "band"), [("half", 2.0, 0.01), ("welded", 2.0, 0.04), ("third-order", 3.0, 0.02)]
)
def test_a_clamped_end_lowers_the_order_to_that_of_its_wall(titanium_strip, supports, wall, expected, band):
    beam = replace(titanium_strip, supports=supports)
    assert order(beam, 2, (80, 160), wall=wall) == pytest.approx(expected, abs=band)


@pytest.mark.parametrize("supports", [p for p in UNORDERED if "clamped" in p], ids="-".join)
def test_five_corrected_joints_stay_between_orders_four_and_five(titanium_strip, supports):
    assert 4.0 < order(replace(titanium_strip, supports=supports), 2, (80, 160), wall="five-joint") < 5.1


@pytest.mark.parametrize("supports", [p for p in UNORDERED if "clamped" in p], ids="-".join)
def test_gregorys_wall_tends_to_its_asymptotic_law_on_both_sides_of_the_sign_change(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports)
    c = supports.count("clamped")
    for count in (60 * c, 1600):
        law = error_laws.leading_error("segment", supports, 12, count)
        assert (law > 0) is (count < 120 * c)
    ratios = [
        e / error_laws.leading_error("segment", supports, 12, n)
        for e, n in zip(errors(beam, 12, (800, 1600)), (800, 1600), strict=True)
    ]
    assert abs(ratios[1] - 1) < 0.025
    assert abs(ratios[1] - 1) < 0.5 * abs(ratios[0] - 1)


@pytest.mark.parametrize(
    ("supports", "expected"),
    [(("clamped", "free"), (5.2e-9, -8.3e-6, -6.0e-4)), (("clamped", "clamped"), (3.8e-7, -3.4e-5, -1.6e-3))],
)
def test_gregorys_errors_at_forty_segments(titanium_strip, supports, expected):
    beam = replace(titanium_strip, supports=supports)
    found = [errors(beam, n, (40,))[0] for n in (1, 5, 10)]
    assert found == [pytest.approx(e, rel=0.02) for e in expected]


def test_a_wall_joint_as_stiff_as_any_other_is_of_order_one(titanium_strip, monkeypatch):
    from verify.segments import walls as chain_walls

    monkeypatch.setitem(chain_walls._CORRECTIONS, "gregory", ())
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
        for module in (segment_model, fem_beam):
            n = module.n_elastic(beam, count)
            if n == 0:
                continue
            found = module.solve_modes(beam, n, count).frequencies_hz
            assert (found > 1e-3 * found[-1]).all()
            assert np.isfinite(found).all()
            with pytest.raises(InputError, match="more than the"):
                module.solve_modes(beam, n + 1, count)


@pytest.mark.parametrize("supports", UNORDERED, ids="-".join)
def test_the_bracket_holds_for_every_mode_a_chain_has(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports)
    settings = (("wall", "half"),) if "clamped" in supports else ()
    for count in range(2, 25):
        n = min(segment_model.n_elastic(beam, count), fem_beam.n_elastic(beam, count))
        if n == 0:
            continue
        bench = SolutionCache(beam)
        bench.modes("segment", count, n, settings)
        bench.modes("fem", count, n)
        for mode in range(1, n + 1):
            found = bench.bracket(mode, count, settings)
            assert found.lower < bench.exact_hz(mode) < found.upper, (count, mode)


@pytest.mark.parametrize(
    ("change", "settings", "reason"),
    [
        ({"supports": ("clamped", "free")}, (), "wall=half bounds it"),
        ({"supports": ("clamped", "free")}, (("wall", "five-joint"),), "wall = 'five-joint'"),
        ({}, (("grading", 1.3),), "with grading = 1.3"),
        ({"section": "steps"}, (), "stepped beam"),
    ],
)
def test_a_bracket_that_is_no_theorem_is_refused_with_the_reason(titanium_strip, change, settings, reason):
    from verify.section import Section

    if "section" in change:
        change = {"section": (Section(length=0.3), Section(length=0.43, thickness=0.001))}
    with pytest.raises(NoBracketError, match=reason):
        SolutionCache(replace(titanium_strip, **change)).bracket(3, 20, settings)


def test_a_bracket_thinner_than_rounding_is_refused(titanium_strip):
    with pytest.raises(NoBracketError, match="smaller count"):
        SolutionCache(titanium_strip).bracket(1, 1500)


@pytest.mark.parametrize("supports", [p for p in UNORDERED if "clamped" not in p], ids="-".join)
def test_the_mean_of_both_models_is_of_order_six_without_a_clamped_end(titanium_strip, supports):
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    first, second = (bench.frequency_error("mean", n, 6) for n in (40, 80))
    assert np.log2(first / second) == pytest.approx(6.0, abs=0.12)


@pytest.mark.parametrize("supports", UNORDERED, ids="-".join)
def test_corrected_joints_are_of_order_four_but_two_next_to_a_clamped_wall(titanium_strip, supports):
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    found = {r: [bench.shape_error("segment", n, 3, r) for n in (80, 160)] for r in ("raw", "corrected")}
    orders = {reading: np.log2(a / b) for reading, (a, b) in found.items()}
    assert orders["raw"] == pytest.approx(2.0, abs=0.03)
    # one joint beside the wall of an error l^2 among N: order 2.5 in the L2 norm
    assert orders["corrected"] == pytest.approx(
        2.5 if "clamped" in supports else 4.0, abs=0.45 if "clamped" in supports else 0.05
    )
    assert found["corrected"][1] < 0.1 * found["raw"][1]


@pytest.mark.parametrize("supports", UNORDERED, ids="-".join)
@pytest.mark.parametrize(("model", "expected", "band"), [("segment", 4.0, 0.6), ("fem", 3.0, 0.05)])
def test_curvatures_converge(titanium_strip, supports, model, expected, band):
    """Joint moments with order 4 (the sign change of Gregory's walls blurs it), Gauss points with order 3."""
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    first, second = (bench.curvature_error(model, n, 3) for n in (60, 120))
    assert np.log2(first / second) == pytest.approx(expected, abs=band)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_nodes_of_a_mode_stand_where_the_exact_mode_has_them(titanium_strip, supports, model):
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    exact = bench.node_positions("analytic", None, 4)
    found = bench.node_positions(model, 60, 4)
    assert len(found) == len(exact)
    assert found == pytest.approx(exact, abs=2e-5 * titanium_strip.length)


def test_settings_that_do_not_exist_are_refused(titanium_strip):
    with pytest.raises(InputError, match="did you mean 'gregory'"):
        segment_model.solve_modes(titanium_strip, 2, 9, wall="gregry")
    with pytest.raises(InputError, match="did you mean 'printed'"):
        segment_model.solve_modes(titanium_strip, 2, 9, joints="print")
    with pytest.raises(InputError, match="grading"):
        fem_beam.solve_modes(titanium_strip, 2, 9, grading=0.0)
    with pytest.raises(InputError, match="equal segments"):
        segment_model.solve_modes(titanium_strip, 2, 9, wall="welded", grading=2.0)


def test_welded_shapes_of_both_mirror_images_are_of_order_two(titanium_strip):
    for supports in (("clamped", "free"), ("free", "clamped")):
        beam, errors = replace(titanium_strip, supports=supports), []
        for n in (40, 80):
            modes = segment_model.solve_modes(beam, 2, n, wall="welded")
            exact = analytic_modes.mode_shape(beam, 2, modes.nodes)
            errors.append(
                compare.shape_error(exact, modes.readings["corrected"]()[1], compare.node_weights(modes.nodes))
            )
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2.03, abs=0.03)
