"""Error laws of discrete models: dispersion, the remainder of Gregory's joints at a clamp, signs, the mean of both."""

from functools import cache
from itertools import combinations_with_replacement, pairwise
from math import pi, sin

import numpy as np
import pytest
from msgspec.structs import replace

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
