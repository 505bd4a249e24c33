"""From which size on an accuracy is kept, against every size tried one by one."""

import pytest
from msgspec.structs import replace

from verify.errors import InputError
from verify.exact import error_laws
from verify.judge import sizing
from verify.judge.cache import SolutionCache
from verify.scene.load import load_scene


def errors_of(bench, model, mode, sizes, settings=()):
    """The size of the solved error at every size, infinite where the model has no such mode."""
    found = {}
    for count in sizes:
        try:
            found[count] = abs(bench.frequency_error(model, count, mode, settings))
        except InputError:
            found[count] = float("inf")
    return found


def by_brute_force(errors, error):
    """(the size from which on all are within, the smallest of all that are, None where it is the same)."""
    enough = max((n for n in errors if errors[n] > error), default=min(errors) - 1) + 1
    least = min((n for n in errors if errors[n] <= error), default=enough)
    return enough, least if least < enough else None


def smallest(beam, model):
    return max(len(beam.pieces), 1 + (model == "segment"))


@pytest.mark.parametrize(
    ("model", "supports", "mode", "most"),
    [
        ("segment", ("clamped", "clamped"), 3, 70),
        ("segment", ("clamped", "free"), 2, 70),
        ("segment", ("pinned", "clamped"), 4, 70),
        ("segment", ("free", "free"), 3, 70),
        ("segment", ("guided", "pinned"), 5, 70),
        ("fem", ("clamped", "guided"), 3, 40),
        ("fem", ("pinned", "pinned"), 4, 40),
    ],
)
def test_from_here_on_is_what_every_size_tried_says(titanium_strip, model, supports, mode, most):
    bench = SolutionCache(replace(titanium_strip, supports=supports))
    errors = errors_of(bench, model, mode, range(smallest(bench.beam, model), most))
    compared = 0
    for error in (0.3, 0.04, 1e-2, 1.1e-3, 3e-5, 3e-6, 1e-6):
        expected = by_brute_force(errors, error)
        if expected[0] <= most - 10:
            found = sizing.enough_from(bench, model, mode, error)
            assert (found.count, found.smaller) == expected, error
            compared += 1
    assert compared >= 4


def test_an_error_that_changes_its_sign_does_before_it_stays(titanium_strip):
    beam = replace(titanium_strip, supports=("clamped", "clamped"))
    found = sizing.enough_from(SolutionCache(beam), "segment", 3, 1e-6)
    assert (found.count, found.smaller) == (55, 33)


def test_all_of_several_modes_are_kept_and_the_one_that_asks_for_most_is_named():
    """With 2EI/l at the clamp mode 10 needs more links than mode 12."""
    bench, settings = SolutionCache(load_scene("instrument-arm").beam), (("wall", "half"),)
    found = sizing.enough_from(bench, "segment", range(1, 13), 1e-3, settings)
    alone = {mode: sizing.enough_from(bench, "segment", mode, 1e-3, settings).count for mode in (10, 12)}
    assert (found.count, found.mode) == (alone[10], 10)
    assert alone[12] < alone[10]
    twelve = next(one for one in sizing.choose(bench, 12, 1e-3, (sizing.Variant("segment", settings),)))
    assert twelve.lower == (10,)


@pytest.mark.parametrize(("model", "error"), [("segment", 0.01), ("fem", 0.035), ("fem", 1e-4)])
def test_all_of_several_modes_by_the_dispersion(titanium_strip, model, error):
    bench = SolutionCache(titanium_strip)
    errors = [errors_of(bench, model, mode, range(9, 60)) for mode in (7, 8, 9)]
    expected = by_brute_force({n: max(each[n] for each in errors) for n in errors[0]}, error)
    found = sizing.enough_from(bench, model, range(7, 10), error)
    assert (found.count, found.smaller) == expected
    assert found.mode == 9


def leading(model, beam, mode, count):
    return error_laws.leading_error(model, beam.supports, mode, count)


@pytest.mark.parametrize(
    "supports", [("clamped", "clamped"), ("clamped", "free"), ("free", "free"), ("pinned", "guided")]
)
@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("error", [3e-3, 1e-6, 1e-8, 4e-10, 3e-11])
def test_the_law_is_kept_from_there_on_and_not_before(titanium_strip, supports, model, error):
    beam = replace(titanium_strip, supports=supports)
    found = error_laws.parts_from_here_on(model, beam, 2, error)
    sizes = range(error_laws.smallest_count(beam, 2), 12_000)
    law = error_laws.expected_error if supports == ("pinned", "guided") else leading
    failing = [n for n in sizes if abs(law(model, beam, 2, n)) > error]
    assert found == max(failing, default=sizes[0] - 1) + 1
    assert found < 12_000
