"""A list judged as it stands: entries that are far off, modes that lie close together, too few frequencies."""

from functools import cache

import numpy as np
import pytest
from other_models import lumped_rod

from verify.elements.linear import solve_modes as elements
from verify.exact.closed_forms import frequency_hz
from verify.exact.modes import exact_frequency_hz
from verify.identify.compare import Asked, compared
from verify.identify.reading import Listed, Shapes
from verify.scenes.scene import load_scene
from verify.segments.linear import solve_modes as chain


@cache
def scene(name, *overrides):
    return load_scene(name, overrides)


PINNED = scene("paper").beam
CANTILEVER = scene("steel-cantilever").beam
EIGHT = np.arange(1, 9)


def of_list(hertz, of, digits=9, numbers=None, shapes=None, **asked):
    """What is said of a list that was written with so many digits."""
    written = np.array([float(f"{f:.{digits}g}") for f in hertz])
    rounding = np.array([0.5 * 10.0 ** (np.floor(np.log10(f)) - digits + 1) / f if f else 0.0 for f in written])
    listed = Listed(frequencies_hz=written, numbers=numbers, rounding=rounding, source="list", unit="Hz")
    return compared(of, Asked(**asked), listed, shapes, asked.get("count"))


def kinds(found):
    return {one.kind for one in found.told}


def gates(found):
    return {one.id: one for one in found.gates}


def closed_form(beam, n):
    return np.array([frequency_hz(beam, mode) for mode in range(1, n + 1)])


# --- far off, and still that mode ----------------------------------------------------------------------------------


def ground(stiffness):
    """Of a pinned beam on a foundation of so many EI/L^4: what every frequency is times as high."""
    return np.sqrt(1.0 + stiffness / (EIGHT * np.pi) ** 4)


LAST = np.array([8e-6, 1e-6, 9e-5, 3e-4, 4e-4, 6.4e-3, 3.2e-3, 4.1e-2])


@pytest.mark.parametrize("numbers", [None, tuple(range(1, 9))], ids=["bare", "numbered"])
@pytest.mark.parametrize(
    ("times", "worst"), [(ground(20.0), 1), (ground(8.0), 1), (1.0 + LAST, 8)], ids=["ground", "soft ground", "last"]
)
def test_a_mode_that_is_far_off_is_that_mode_and_no_gap(times, worst, numbers):
    """It was called missing, the entry none of the beam's, and the largest error was that of another."""
    found = of_list(times * closed_form(PINNED, 8), scene("paper"), numbers=numbers, kind="elements", within=0.0095)
    assert not kinds(found) & {"missing", "extra"}
    assert [(row.mode, row.entry, row.read_as) for row in found.rows] == [(n, n, n) for n in range(1, 9)]
    assert [row.error for row in found.rows] == pytest.approx(times - 1.0, abs=1e-8)
    assert gates(found)["within"].measured == pytest.approx(times.max() - 1.0, rel=1e-5)
    assert {name: gate.passed for name, gate in gates(found).items() if name != "list"} == {
        "identified": False,
        "within": False,
    }
    assert f"at mode {worst}" in found.facts()[1]
    assert not found.plain()["best"]["identified"]


@pytest.mark.parametrize("factor", [1.0, 2.0 * np.pi])
def test_an_entry_that_is_apart_from_what_the_others_fit_counts_among_the_errors(factor):
    """The last of twelve is 9 % high: eleven are a lumped chain's, and the twelfth is an error of the list."""
    whole = lumped_rod(PINNED, 49)[:12] * np.where(np.arange(12) == 11, 1.09, 1.0)
    found = of_list(factor * whole, scene("paper"), count=49, within=0.9)
    assert kinds(found) == ({"apart"} if factor == 1.0 else {"apart", "unit"})
    assert "ntry 12 is +9.0000 % off mode 12, and the others fit" in found.answer
    assert (found.found.best.candidate.mass, found.found.best.residual < 1e-8) == ("joints", True)
    assert (found.rows[-1].mode, found.rows[-1].read_as) == (12, 12)
    assert found.rows[-1].difference == pytest.approx(0.09, rel=1e-6)
    assert gates(found)["identified"].measured == pytest.approx(0.09, rel=1e-6)
    assert not found.plain()["best"]["identified"]
    assert found.size.mode == 12


def test_entries_are_judged_by_their_numbers_and_shown_as_what_they_are_read_as():
    whole, exact = lumped_rod(PINNED, 49)[:12], closed_form(PINNED, 12)
    given = np.delete(whole, 2)
    found = of_list(given, scene("paper"), count=49, within=0.2)
    assert kinds(found) == {"missing"}
    assert [row.error for row in found.rows] == pytest.approx(given / exact[:11] - 1.0, rel=1e-6)
    assert [row.read_as for row in found.rows] == [1, 2, *range(4, 13)]
    assert [row.read_error for row in found.rows] == pytest.approx(
        (whole / exact - 1.0)[[0, 1, *range(3, 12)]], rel=1e-5
    )
    assert gates(found)["within"].measured == pytest.approx(given[2] / exact[2] - 1.0, rel=1e-6)
    assert "with each entry as it is read it would be" in found.facts()[1]
    heads = [column.head for column in found.tables()[0].columns]
    assert heads[4:9] == ["error, %", "read as", "read error, %", "best, Hz", "off it, %"]
    drawn = {line.name: line for line in found.charts()[0].lines}
    assert drawn["yours, read"].x == (1, 2, *range(4, 13))
    assert drawn[found.found.best.candidate.words].y == pytest.approx(drawn["yours, read"].y, abs=1e-6)


def test_a_wrong_unit_and_an_entry_too_many_are_found_together():
    whole = lumped_rod(PINNED, 49)[:12]
    given = 2.0 * np.pi * np.sort(np.append(whole, 0.6 * whole[7] + 0.4 * whole[8]))
    found = of_list(given, scene("paper"), count=49)
    assert kinds(found) == {"unit", "extra"}
    assert [row.read_as for row in found.rows] == [*range(1, 9), None, *range(9, 13)]
    assert found.rows[8].best_hz is None


def test_an_entry_too_many_is_named_by_its_place_in_the_list():
    """Two rigid motions stand before it."""
    whole = lumped_rod(PINNED, 49)[:12]
    given = [0.0, 0.0, *np.sort(np.append(whole, 0.6 * whole[7] + 0.4 * whole[8]))]
    found = of_list(given, scene("paper"), count=49)
    assert "ntry 11 is none of the beam's bending modes" in found.answer


@pytest.mark.parametrize(("digits", "told"), [(5, set()), (12, {"missing"})])
def test_gaps_are_not_fitted_to_three_frequencies_unless_digits_bear_them_out(digits, told):
    found = of_list(lumped_rod(PINNED, 49)[[0, 1, 3]], scene("paper"), digits=digits, count=49, within=0.5)
    assert kinds(found) & {"missing", "extra", "apart"} == told
    assert not gates(found)["within"].passed


def test_an_entry_whose_shape_is_no_modes_is_judged_by_its_number():
    model, x = elements(CANTILEVER, 6, 40), np.linspace(0.0, CANTILEVER.length, 41)
    values = model.deflection(x)
    values[3] = values[0] + values[5] * abs(values[0]).max() / abs(values[5]).max()
    times = np.where(np.arange(6) == 3, 1.07, 1.0)
    shapes = Shapes(x=x, values=values)
    found = of_list(times * model.frequencies_hz, scene("steel-cantilever"), shapes=shapes, count=40, within=0.01)
    assert kinds(found) >= {"unlike"}
    assert [row.mode for row in found.rows] == list(range(1, 7))
    assert found.rows[3].read_as is None
    assert gates(found)["within"].measured == pytest.approx(0.07, rel=1e-3)


def test_one_mode_beyond_the_tolerance_is_enough_to_claim_nothing():
    """Ground of 0.24 EI/L^4: 0.12 % at the first mode, and the root mean square of eight is a third of it."""
    found = of_list(ground(0.24) * closed_form(PINNED, 8), scene("paper"), kind="elements", count=9)
    assert found.found.best.residual < 1e-3 < found.rows[0].beyond
    assert not gates(found)["identified"].passed
    assert not found.plain()["best"]["identified"]
    assert not found.answer.startswith("Your ")


# --- modes that lie close together ---------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [24, 80])
def test_two_spans_that_hardly_feel_each_other_have_no_mode_twice(count):
    """Pairs of modes 5e-5 and 6e-4 apart are the beam's own."""
    length, stiff = PINNED.length, PINNED.bending_stiffness
    stay = f"{{position={length / 2!r}, stiffness={2e6 * stiff / length**3!r}, rotational={4e4 * stiff / length!r}}}"
    of = scene("paper", f"beam.spring=[{stay}]")
    given = elements(of.beam, 8, count).frequencies_hz
    assert (given[1::2] / given[::2] - 1.0).tolist()[:2] == pytest.approx([4.7e-5, 6.0e-4], rel=0.05)
    found = of_list(given, of, count=count, within=0.9)
    assert not found.told
    assert [row.mode for row in found.rows] == list(range(1, 9))
    assert (found.found.best.candidate.mass, found.passed) == ("consistent", True)


# --- too few -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [None, 27])
@pytest.mark.parametrize("n", [1, 2])
def test_one_or_two_frequencies_do_not_tell_a_size_from_a_modulus(n, count):
    """All are 7 % of E too low, to six digits: a chain of 27 links was named for leaving 3e-4."""
    given = np.sqrt(0.93) * closed_form(CANTILEVER, n)
    found = of_list(given, scene("steel-cantilever"), digits=6, count=count, kind="segments")
    causes = {one["kind"]: one for one in found.plain()["causes"]}
    assert set(causes) == {"scale", "none"}
    assert causes["scale"]["residual"] <= causes["none"]["residual"]
    assert causes["scale"]["factor"] == pytest.approx(np.sqrt(0.93), rel=1e-3)
    assert not found.plain()["best"]["identified"]
    assert not gates(found)["identified"].passed
    assert found.answer.startswith("One frequency does not say" if n == 1 else "Two frequencies do not say")


def test_two_shapes_that_are_a_modes_are_two_frequencies_however_long_the_list():
    """Of six shapes the last four are steep steps, like no mode."""
    model, x = elements(CANTILEVER, 6, 40), np.linspace(0.0, CANTILEVER.length, 41)
    values = model.deflection(x)
    values[2:] = np.sign(np.sin(np.arange(23, 27)[:, None] * np.pi * x / CANTILEVER.length + 0.3))
    given, shapes = np.sqrt(0.93) * model.frequencies_hz, Shapes(x=x, values=values)
    found = of_list(given, scene("steel-cantilever"), digits=6, shapes=shapes, kind="segments", count=27)
    assert "unlike" in kinds(found)
    assert {one["kind"] for one in found.plain()["causes"]} == {"scale", "none"}
    assert not found.plain()["best"]["identified"]
    assert not gates(found)["identified"].passed


def test_another_size_than_was_said_is_not_found_by_two_frequencies():
    given = chain(CANTILEVER, 2, 8, wall="half").frequencies_hz
    found = of_list(given, scene("steel-cantilever"), digits=12, kind="segments", count=7)
    assert "count" not in kinds(found)
    assert not gates(found)["identified"].passed


def test_what_is_not_fitted_is_known_from_two_frequencies():
    """The exact beam; or a size that was said, to nine digits."""
    exact = of_list(closed_form(CANTILEVER, 2), scene("steel-cantilever"), digits=5, kind="elements", within=1e-4)
    assert exact.passed
    assert "do not show how the beam was divided" in exact.answer
    known = of_list(elements(CANTILEVER, 2, 3).frequencies_hz, scene("steel-cantilever"), count=3)
    assert known.found.best.candidate.mass == "consistent"
    assert gates(known)["identified"].passed


def test_three_frequencies_bear_no_factor_and_size_out():
    """A fifth of the beam's mass at 0.63 L lowers three modes by 8.7, 8.2 and 8.2 %: no modulus, no chain does that."""
    length, mass = CANTILEVER.length, 0.2 * CANTILEVER.mass_per_length * CANTILEVER.length
    heavy = scene("steel-cantilever", f"beam.mass=[{{position={0.63 * length!r}, mass={mass!r}}}]").beam
    given = [exact_frequency_hz(heavy, mode) for mode in (1, 2, 3)]
    found = of_list(given, scene("steel-cantilever"), digits=6, kind="segments")
    assert not found.plain()["best"]["identified"]
    assert not gates(found)["identified"].passed
    assert "All frequencies have the common factor" not in found.answer
