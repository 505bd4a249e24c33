"""Error laws of discrete models: dispersion, the remainder of Gregory's joints at a clamp, signs, the mean of both."""

from functools import cache
from itertools import combinations_with_replacement, pairwise
from math import pi, sin

import numpy as np
import pytest
from msgspec.structs import replace

from verify.analytic_modes import ExactModel
from verify.exact import error_laws
from verify.exact.closed_forms import frequency_hz, wavenumber_length
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam
from verify.segment_model import SegmentModel

STRIP = Beam(length=0.3, width=0.025, thickness=0.003, youngs_modulus=206e9, density=7850.0)
MODELS = {"segment": SegmentModel, "fem": HermiteModel}
FLOOR = 1e-12
SIZES = (20, 23, 28, 40, 57, 80, 100, 123, 160, 320)
FREE_OF_CLAMPS = list(combinations_with_replacement(("pinned", "guided", "free"), 2))
CLAMPED = (("clamped", "free"), ("clamped", "pinned"), ("clamped", "clamped"), ("guided", "clamped"))


@cache
def errors(model, supports, count):
    """Relative errors of all but two modes, of 30 at most."""
    n = min(count - 2, 30)
    beam = replace(STRIP, supports=supports)
    found = MODELS[model](beam, count).modes(n).frequencies_hz
    return [float(f) / frequency_hz(beam, mode) - 1.0 for mode, f in enumerate(found, 1)]


def dispersion_error(mu):
    """Of equal links without clamps, mu = beta L / N."""
    square = sin(mu / 2) ** 2
    return (48 * square**2 / (3 - 2 * square)) ** 0.5 / mu**2 - 1


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("supports", [*CLAMPED, ("free", "free"), ("free", "pinned"), ("guided", "free")])
def test_errors_follow_their_law_within_a_third_of_its_terms_from_twenty_parts_on(model, supports):
    """All modes up to mu = 2.5."""
    beam = replace(STRIP, supports=supports)
    for count in SIZES:
        for mode, error in enumerate(errors(model, supports, count), 1):
            mu = wavenumber_length(supports, mode) / count
            if mu <= 2.5:
                law = error_laws.expected_error(model, beam, mode, count)
                own = dispersion_error(mu) if model == "segment" else law
                size = abs(own) + abs(law - own)  # of the dispersion and of the clamps
                assert abs(error - law) <= size / 3 + FLOOR, (count, mode)


@pytest.mark.parametrize("supports", CLAMPED)
@pytest.mark.parametrize(("mode", "one", "two"), [(1, 176, 332), (3, 212, 372), (5, 240, 408), (10, 292, 480)])
def test_the_leading_terms_are_a_law_of_fine_chains_alone(supports, mode, one, two):
    """mu^4 (-1/1440 + c/12 N): a quarter off at most from these links on, a third and more at half of them."""
    first = one if supports.count("clamped") == 1 else two

    def ratio(count):
        return errors("segment", supports, count)[mode - 1] / error_laws.leading_error("segment", supports, mode, count)

    for count in (first, int(1.3 * first), 2 * first):
        if mode > 1 or count < 400:  # rounding
            assert 0.8 <= ratio(count) <= 1.25, count
    half = errors("segment", supports, first // 2)[mode - 1]
    assert abs(error_laws.leading_error("segment", supports, mode, first // 2) / half - 1) > 1 / 3
    if mode >= 3:
        assert ratio(20) < 0.5


def test_errors_of_clamped_chains_change_sign():
    """At the first of two neighbouring sizes, 16 to 160 links; the leading terms of one clamped end would at 120."""

    def signs(supports, mode):
        found = [errors("segment", supports, n)[mode - 1] for n in range(16, 162)]
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


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("count", [3, 8, 49, 700])
def test_pinned_models_have_the_frequencies_of_their_dispersion(titanium_strip, model, count):
    found = MODELS[model](titanium_strip, count).modes(min(count - 1, 40)).frequencies_hz
    law = [error_laws.dispersion_frequency_hz(model, titanium_strip, n, count) for n in range(1, len(found) + 1)]
    assert found == pytest.approx(law, rel=1e-13)


@pytest.mark.parametrize("count", [3, 12, 31, 47])
@pytest.mark.parametrize("supports", FREE_OF_CLAMPS, ids="-".join)
def test_the_mean_of_both_is_nearer_than_elements_for_seven_tenths_of_the_modes(titanium_strip, supports, count):
    """While the error of segments is below three times that of elements: mu < 0.69635 pi by both dispersions.

    Exactly on pinned and guided ends, at most a mode later per free end.
    """
    beam = replace(titanium_strip, supports=supports)
    models = [SegmentModel(beam, count), HermiteModel(beam, count)]
    modes, free = min(model.n_elastic for model in models), supports.count("free")
    exact = np.array([frequency_hz(beam, n) for n in range(1, modes + 1)])
    below, above = (model.modes(modes).frequencies_hz for model in models)
    nearer = (abs((below + above) / 2 - exact) < abs(above - exact)).tolist()
    by_law = sum(wavenumber_length(supports, n) + pi * free < 0.69635 * pi * count for n in range(1, modes + 1))
    assert sum(nearer) - free <= by_law <= sum(nearer)
    assert nearer == sorted(nearer, reverse=True)


@pytest.mark.parametrize(("model", "bound"), [("segment", 6e-5), ("fem", 3e-5)])
def test_deflection_and_slope_between_the_nodes_are_those_of_the_exact_mode(titanium_strip, model, bound):
    x = np.array([0.0, 0.0171, 0.2003, 0.4444, 0.73])
    exact, found = ExactModel(titanium_strip).modes(5), MODELS[model](titanium_strip, 49).modes(5)
    assert found.deflection(x) == pytest.approx(exact.deflection(x), rel=bound, abs=bound * exact.deflection(x).max())
    slope = exact.slope(x)
    assert found.slope(x) == pytest.approx(slope, rel=40 * bound, abs=40 * bound * abs(slope).max())
