"""From which size on an accuracy is kept, against every size tried one by one."""

import pytest
from msgspec.structs import replace
from packaged_beams import packaged_beam

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.exact import error_laws
from verify.judge import sizing
from verify.judge.cache import SolutionCache
from verify.judge.variants import Variant
from verify.models.catalogue import MODELS
from verify.section import Section

STEPPED, ARM, PATCHED = map(packaged_beam, ("stepped-beam", "instrument-arm", "patched-strip"))


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


@pytest.mark.parametrize(
    ("error", "settings"), [(1e-3, ()), (9e-3, (("joints", "printed"),)), (2e-3, (("grading", 1.4),))]
)
def test_a_stepped_beam_goes_by_what_was_solved_and_says_so(error, settings):
    bench = SolutionCache(STEPPED)
    errors = errors_of(bench, "segment", 3, range(2, 81), settings)
    found = sizing.enough_from(bench, "segment", 3, error, settings)
    assert found.count <= 40
    assert (found.count, found.smaller) == by_brute_force(errors, error)
    assert found.known_by.startswith(f"N from {found.count} to ")


def test_a_body_that_falls_anywhere_within_its_link_is_followed_to_the_last_size_that_fails():
    """The error goes up and down with N: 106 links do, 107 do not."""
    bench, settings = SolutionCache(ARM), (("attachment", "lever"),)
    found = sizing.enough_from(bench, "segment", 3, 1e-3, settings)
    assert (found.count, found.smaller) == (108, 106)
    last = int(found.known_by.removeprefix("N from 108 to ").split()[0])
    assert last >= 200
    errors = errors_of(bench, "segment", 3, range(102, last + 1), settings)
    assert by_brute_force(errors, 1e-3) == (108, 106)


@pytest.mark.parametrize("place", [0.3875, 0.80511, 0.417])
def test_sizes_after_the_last_that_fails_are_gone_through_one_by_one(place):
    def reached(count):
        s = place * count % 1.0
        return (1.0 + 40.0 * s * (1.0 - s)) / count**2 <= 2e-4

    enough, _, does = sizing._scanned(reached, 2, 3, "segment", 2e-4, uneven=True)
    assert enough == max(n for n in range(2, 2000) if not reached(n)) + 1
    assert all(does[n] for n in range(enough, enough + 100))


def test_an_error_that_goes_up_and_down_far_out_is_refused_and_not_guessed():
    with pytest.raises(InputError, match="goes up and down with count here and exceeds it at count = "):
        sizing._scanned(lambda count: count % 7 != 0 or count > 2050, 2, 30, "segment", 1e-3, uneven=True)


@pytest.mark.parametrize("last", [2040, 3100, 10**9])
def test_of_one_that_wanders_beyond_what_is_gone_through_nothing_is_said_of_larger_sizes(last):
    """It said "does not reach it up to count = 4045" of one that fails up to 2600 and does from there on."""
    with pytest.raises(InputError, match=r"exceeds it at count = 20\d\d"):
        sizing._scanned(lambda count: count > last, 2, 30, "segment", 1e-3, uneven=True)


def test_a_high_mode_of_a_beam_without_an_error_law_goes_by_no_law():
    found = sizing.enough_from(SolutionCache(STEPPED), "segment", 101, 0.06)
    assert "law" not in found.known_by


def test_all_of_several_modes_are_kept_and_the_one_that_asks_for_most_is_named():
    """With 2EI/l at the clamp mode 10 needs more links than mode 12."""
    bench, settings = SolutionCache(ARM), (("wall", "half"),)
    found = sizing.enough_from(bench, "segment", range(1, 13), 1e-3, settings)
    alone = {mode: sizing.enough_from(bench, "segment", mode, 1e-3, settings).count for mode in (10, 12)}
    assert (found.count, found.mode) == (alone[10], 10)
    assert alone[12] < alone[10]
    twelve = next(one for one in sizing.choose(bench, 12, 1e-3, (sizing.Variant("segment", settings),)))
    assert twelve.lower == (10,)


def test_a_smaller_size_that_does_for_several_modes_is_told_with_the_largest_of_their_errors():
    """A pinned tube with a lump near its end: at N = 8 mode 4, which asks for most, is 0.054 % off and mode 3 0.082 %."""
    tube = Beam(
        shape="tube",
        diameter=0.03,
        wall_thickness=0.002,
        length=0.62,
        youngs_modulus=110e9,
        density=4430.0,
        supports=("pinned", "free"),
        mass=(PointMass(position=0.6, mass=0.2),),
        spring=(PointSpring(position=0.41, stiffness=2e5),),
    )
    bench = SolutionCache(tube)
    (chain,) = sizing.choose(bench, range(1, 5), 1e-3, (Variant("segment"),))
    assert (chain.count, chain.mode, chain.smaller) == (17, 4, 8)


@pytest.mark.parametrize(("model", "error"), [("segment", 0.01), ("fem", 0.035), ("fem", 1e-4)])
def test_all_of_several_modes_by_the_dispersion(titanium_strip, model, error):
    bench = SolutionCache(titanium_strip)
    errors = [errors_of(bench, model, mode, range(9, 60)) for mode in (7, 8, 9)]
    expected = by_brute_force({n: max(each[n] for each in errors) for n in errors[0]}, error)
    found = sizing.enough_from(bench, model, range(7, 10), error)
    assert (found.count, found.smaller) == expected
    assert found.mode == 9


def test_sections_alike_leave_unequal_parts_which_no_dispersion_describes(titanium_strip):
    cut = replace(titanium_strip, section=(Section(length=0.3), Section(length=0.43)))
    assert sizing.PROVEN in sizing.enough_from(SolutionCache(titanium_strip), "segment", 4, 1e-3).known_by
    assert sizing.PROVEN not in sizing.enough_from(SolutionCache(cut), "segment", 4, 1e-3).known_by


@pytest.mark.parametrize(("mode", "error"), [(40, 0.035), (40, 0.0372), (9, 0.03), (200, 0.02), (1000, 0.01)])
def test_elements_near_their_cut_off_happen_to_do(titanium_strip, mode, error):
    """Towards mu = pi their error falls from 3.7 to 0.7 %: a mesh of one element more than the mode may do."""
    law = {n: abs(error_laws.expected_error("fem", titanium_strip, mode, n)) for n in range(mode + 1, 3 * mode)}
    failing = [n for n in law if law[n] > error]
    enough = max(failing, default=mode) + 1
    least = min(n for n in law if law[n] <= error)
    assert error_laws.parts_from_here_on("fem", titanium_strip, mode, error) == enough
    assert sizing._dip("fem", titanium_strip, range(mode, mode + 1), error, enough) == (
        least if least < enough else None
    )
    if mode == 40 and error == 0.035:
        found = sizing.enough_from(SolutionCache(titanium_strip), "fem", mode, error)
        assert (found.count, found.smaller) == (44, 41)


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


def test_a_size_beyond_reach_is_refused_and_a_large_one_goes_by_the_law(titanium_strip):
    half = replace(titanium_strip, supports=("clamped", "free"))
    found = sizing.enough_from(SolutionCache(half), "segment", 12, 5e-11)
    assert found.count > 2000
    assert found.known_by == sizing.BY_LAW
    with pytest.raises(InputError, match="does not reach it up to count"):
        sizing._scanned(lambda count: False, 2, 3, "segment", 1e-9, uneven=False)


def test_sizes_are_solved_once(titanium_strip, monkeypatch):
    beam = replace(titanium_strip, supports=("clamped", "free"))
    module, solved = MODELS.named("segment"), []
    true = module.solve_modes
    monkeypatch.setattr(
        module, "solve_modes", lambda beam, n, count, **s: solved.append(count) or true(beam, n, count, **s)
    )
    found = sizing.enough_from(SolutionCache(beam), "segment", 2, 1e-5)
    assert len(solved) == len(set(solved)) <= 2 * found.count


@pytest.mark.parametrize(
    ("supports", "mode", "error"),
    [(("pinned", "pinned"), 22, 0.3), (("pinned", "pinned"), range(1, 23), 0.15), (("clamped", "free"), 7, 0.3)],
)
def test_no_law_is_told_of_elements_beyond_their_lower_branch(titanium_strip, supports, mode, error):
    """Mode 22 of 14 elements is +27.9 % off; the dispersion, which ends at 22 of them, was told as -92.5 %."""
    (fem,) = sizing.choose(SolutionCache(replace(titanium_strip, supports=supports)), mode, error, (Variant("fem"),))
    assert fem.count < fem.mode
    assert fem.expected_error is None
    assert fem.error > 0.079


def test_a_law_is_told_where_it_speaks_of_the_mode(titanium_strip):
    (chain,) = sizing.choose(SolutionCache(titanium_strip), 22, 0.3, (Variant("segment"),))
    assert chain.count == 23
    assert chain.expected_error == pytest.approx(chain.error, rel=1e-9)
    clamped = SolutionCache(replace(titanium_strip, supports=("clamped", "free")))
    (chain,) = sizing.choose(clamped, 3, 1e-3, (Variant("segment"),))
    assert chain.expected_error == pytest.approx(chain.error, rel=0.3)


@pytest.mark.parametrize(("mode", "error"), [(4, 1e-3), (9, 2e-3), (1, 7e-4)])
def test_sizes_are_looked_through_until_the_shortest_section_has_parts_of_its_own(mode, error):
    """4 mm of half a metre: with one part for them errors rise again from 144 parts on, and fall with two at 200."""
    bench = SolutionCache(PATCHED)
    found = sizing.enough_from(bench, "segment", mode, error)
    assert found.count == 200
    assert abs(bench.frequency_error("segment", 199, mode)) > error
    assert abs(bench.frequency_error("segment", 100, mode)) < error
    sizes = [*range(200, 300, 7), *range(300, 500, 23)]
    assert all(abs(bench.frequency_error("segment", size, mode)) < error for size in sizes)
