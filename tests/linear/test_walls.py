"""How a chain is held at a clamped end, and the error laws of its walls."""

from functools import cache
from itertools import combinations_with_replacement, pairwise, product
from math import cos, exp, pi, sin

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.elements import linear as fem_beam
from verify.elements.linear import solve_modes as element_modes
from verify.errors import InputError, NoBracketError
from verify.exact import closed_forms, error_laws
from verify.exact.closed_forms import frequency_hz, wavenumber_length
from verify.options import SUPPORTS, WALLS
from verify.problem.beam import Beam
from verify.segments import linear as segment_model
from verify.segments.linear import solve_modes as segment_modes
from verify.segments.walls import wall_factors

# --- Walls ---

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


# --- Wall law ---

STRIP = Beam(length=0.3, width=0.025, thickness=0.003, youngs_modulus=206e9, density=7850.0)
SOLVED = {"segment": segment_modes, "fem": element_modes}
FLOOR = 1e-12
SIZES = (20, 23, 28, 40, 57, 80, 100, 123, 160, 320)
CLAMPED = (("clamped", "free"), ("clamped", "pinned"), ("clamped", "clamped"), ("guided", "clamped"))


@cache
def errors_wall_law(model, supports, count):
    """Of the modes 1 to 10 at least, as many as 18 of 20 parts."""
    n = min(count - 2, 30)
    beam = replace(STRIP, supports=supports)
    found = SOLVED[model](beam, n, count).frequencies_hz
    return [float(f) / frequency_hz(beam, mode) - 1.0 for mode, f in enumerate(found, 1)]


def terms(supports, mode, count):
    """The dispersion's error and the wall's, summed and integrated plainly."""
    mu, clamped = wavenumber_length(supports, mode) / count, supports.count("clamped")
    square = sin(mu / 2) ** 2
    return (48 * square**2 / (3 - 2 * square)) ** 0.5 / mu**2 - 1, -0.5 * clamped * residual(mu) / count


@cache
def residual(mu):
    """Gregory's sum of M^2 less its integral, both under a window that lets it end: smooth, one at the wall."""
    length = 4000.0 / mu
    k = np.arange(int(length) + 1.0)
    window, z = np.cos(0.5 * pi * k / length) ** 8, mu * k
    squares = (np.cos(z) - np.sin(z) + np.exp(-z)) ** 2 * window
    ends = sum(a * (cos(j * mu) - sin(j * mu) + exp(-j * mu)) ** 2 for j, a in enumerate((-5 / 8, 1 / 6, -1 / 24)))
    fine = np.linspace(0.0, length, 2_000_001)
    z = mu * fine
    step, dense = fine[1], (np.cos(z) - np.sin(z) + np.exp(-z)) ** 2 * np.cos(0.5 * pi * fine / length) ** 8
    slope = -2.0 * mu * 4.0  # of M^2 at the wall, 2 M M'
    integral = step * (dense.sum() - 0.5 * dense[0]) + step**2 / 12 * slope
    return float(squares.sum() + ends - integral)


@pytest.mark.parametrize("mu", np.linspace(0.004, 2.5, 60))
def test_what_a_wall_leaves_is_less_than_certainty_counts_with(mu):
    assert abs(error_laws.wall_residual(mu)) <= mu**4 / 6


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("supports", [*CLAMPED, ("free", "free"), ("free", "pinned"), ("guided", "free")])
def test_errors_keep_to_the_law_within_a_third_of_its_terms_from_twenty_parts_on(model, supports):
    """All modes up to mu = 2.5; the same errors_wall_law moved by half of the terms do not."""
    beam = replace(STRIP, supports=supports)
    for count in SIZES:
        for mode, error in enumerate(errors_wall_law(model, supports, count), 1):
            if wavenumber_length(supports, mode) / count <= 2.5:
                assert error_laws.is_kept(model, beam, mode, count, error, FLOOR), (count, mode)
    off = errors_wall_law(model, supports, 40)[4] + 0.75 * sum(map(abs, terms(supports, 5, 40)))
    assert not error_laws.is_kept(model, beam, 5, 40, off, FLOOR)


@pytest.mark.parametrize("supports", CLAMPED)
@pytest.mark.parametrize(("mode", "one", "two"), [(1, 176, 332), (3, 212, 372), (5, 240, 408), (10, 292, 480)])
def test_the_leading_terms_are_a_law_of_fine_chains_alone(supports, mode, one, two):
    """mu^4 (-1/1440 + c/12 N): a quarter off at most from these links on, a third and more at half of them."""
    first = one if supports.count("clamped") == 1 else two

    def ratio(count):
        return errors_wall_law("segment", supports, count)[mode - 1] / error_laws.leading_error(
            "segment", supports, mode, count
        )

    for count in (first, int(1.3 * first), 2 * first):
        if mode > 1 or count < 400:  # rounding
            assert 0.8 <= ratio(count) <= 1.25, count
    half = errors_wall_law("segment", supports, first // 2)[mode - 1]
    assert abs(error_laws.leading_error("segment", supports, mode, first // 2) / half - 1) > 1 / 3
    if mode >= 3:
        assert ratio(20) < 0.5


def test_where_errors_of_clamped_chains_change_sign():
    """At the first of two neighbouring sizes, 16 to 160 links; the leading terms of one clamped end would at 120."""

    def signs(supports, mode):
        found = [errors_wall_law("segment", supports, n)[mode - 1] for n in range(16, 162)]
        return found, [n for n, (one, other) in enumerate(pairwise(found), 16) if one * other < 0]

    assert signs(("clamped", "free"), 3)[1] == [27, 82]
    assert signs(("clamped", "pinned"), 2)[1] == [23, 87]
    assert signs(("clamped", "clamped"), 5)[1] == [63, 156]
    for supports in (("clamped", "free"), ("clamped", "pinned"), ("clamped", "guided")):
        (once,) = (n for n in signs(supports, 1)[1] if n > 20)
        assert 100 <= once <= 112
    for mode in (5, 10):
        assert max(signs(("clamped", "free"), mode)[0]) < 0.0
        assert error_laws.leading_error("segment", ("clamped", "free"), mode, 119) > 0.0


@pytest.mark.parametrize("supports", [("clamped", "free"), ("clamped", "clamped"), ("free", "free")])
@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("mode", [1, 4, 9])
@pytest.mark.parametrize("error", [1e-2, 1e-5, 3e-8])
def test_what_is_certain_is_so_at_every_size_from_there_on(model, supports, mode, error):
    beam = replace(STRIP, supports=supports)
    first = error_laws.certain_from(model, beam, mode, error)
    for count in (first, first + 1, int(1.3 * first), 2 * first):
        if count < 700:
            n = float(SOLVED[model](beam, mode, count).frequencies_hz[-1])
            assert abs(n / frequency_hz(beam, mode) - 1) <= error
        own, walls = terms(supports, mode, count) if model == "segment" else (0.0, 0.0)
        assert 4 / 3 * (abs(own) + abs(walls)) <= error * 1.0001
