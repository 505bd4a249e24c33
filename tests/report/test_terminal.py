"""Figures and notices as the terminal tells them: once, to the digits that count, broken where names may be."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from verify.cli import status_of
from verify.errors import InputError
from verify.report.document import _on_page
from verify.report.terminal import Hyphenated, print_found
from verify.run.gates import Band, shown_expectation
from verify.scenes.scene import Complex, load_scene
from verify.studies.told import Column, Found, Table
from verify.waves.window import check_window
from verify.words import rounded, told_once


@pytest.mark.parametrize(
    ("value", "within", "shown"),
    [
        (4469.94052, 0.001, "4469.94052"),
        (3.743511896211, 0.00012, "3.7435119"),
        (-8.2345302521e-08, 1.5e-12, "-8.2345303e-08"),
        (0.123456789, 20.0, "0.12"),
        (4.55, 1.0, "4.55"),
        (6.5, 1.0, "6.5"),
        (0.5, 50.0, "0.5"),
        (-0.00428024, 5e-9, "-0.00428024"),
        (4.0, 0.3, "4.0"),
        (1234.6, 20.0, "1234.6"),
        (1234567.8, 2e4, "1234568"),
        (0.0, 1e-7, "0.0"),
    ],
)
def test_an_expectation_has_the_digits_that_its_band_tells(value, within, shown):
    assert rounded(value, within) == shown


def test_a_complex_expectation_is_rounded_in_both_parts_and_a_bound_is_as_given():
    def band(**given):
        return Band(**{"expect": None, "within": None, "at_least": None, "at_most": None} | given)

    complex_one = band(expect=Complex(-6.68447222298735e-07, 1.77076918186928e-06), within=3e-10)
    assert shown_expectation(complex_one) == "-6.684472e-07 +1.7707692e-06i ± 3e-10"
    assert shown_expectation(band(at_least=1.7)) == "at least 1.7"
    assert shown_expectation(band(expect=230.88535783517)) == "contains 230.88535783517"


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6), st.sampled_from((-1.01, -0.998, 0.995, 1.002)))
def test_the_band_that_is_shown_passes_and_fails_what_the_judged_one_does(expect, within, off):
    """To the thousandth of the band to which its share is told."""
    shown, measured = float(rounded(expect, within)), expect + off * within
    assert (abs(measured - shown) <= within) == (abs(off) <= 1.0)


def lines_of(name, width):
    console = Console(width=width)
    with console.capture() as captured:
        console.print(Hyphenated(name))
    return [line.strip() for line in captured.get().splitlines()]


def test_a_name_is_broken_behind_its_hyphens_and_inside_a_word_only_where_it_has_to_be():
    assert lines_of("departure-at-a-tenth-of-a-newton", 14) == ["departure-at-", "a-tenth-of-a-", "newton"]
    assert lines_of("fem-49-ratio", 8) == ["fem-49-", "ratio"]
    assert lines_of("gate fem-order, gate fem-law", 15) == ["gate fem-order,", "gate fem-law"]
    assert lines_of("fem-order", 30) == ["fem-order"]
    assert lines_of("displacement-x", 6) == ["displa", "cement", "-", "x"]


def test_a_notice_that_comes_back_with_other_numbers_is_told_once_with_how_many_there_are():
    few = [f"mode = 22: the fem model at count = {n} has {2 * n} elastic modes, raise count" for n in (6, 8, 10, 6)]
    assert told_once(["first", *few, "first", "last"]) == ["first", f"{few[0]} (2 more like it)", "last"]
    assert told_once(few[:2]) == few[:2]


def test_seven_sizes_without_a_mode_are_one_notice_and_the_table_says_what_it_leaves_out(capsys, monkeypatch):
    from verify.cli import status_of

    monkeypatch.setenv("COLUMNS", "80")
    assert status_of(["table", "paper", "--modes", "22", "--counts", "6-18:2"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert out.count("elastic modes, raise count") == 2
    assert "segment model at count = 6 has 5 elastic modes, raise count (6 more like it)" in out
    assert "no room for mean %" in out


def test_a_sweep_says_how_many_points_its_table_leaves_out(capsys):
    from verify.cli import status_of

    asked = ["table", "paper-wave", "--sweep"]
    assert status_of([*asked, "frequency_hz=4200:4300:60"]) == 0
    assert "60 points, superposed; 47 of them are left out of the table, --json and --csv give them all" in " ".join(
        capsys.readouterr().out.split()
    )
    assert status_of([*asked, "frequency_hz=4200:4300:9"]) == 0
    assert "left out" not in capsys.readouterr().out


def test_what_cannot_run_for_one_reason_is_told_in_one_line(capsys):
    from verify.cli import status_of

    asked = ["plan", "paper", "--set", "spectrum.count=10000000000000", "--set", "convergence.counts=10000000000000"]
    assert status_of(asked) == 1
    whys = [told.partition(": ")[2] for told in " ".join(capsys.readouterr().out.split()).split("cannot run: ")[1:]]
    assert len(whys) == len(set(whys)) == 2


@pytest.mark.parametrize("width", [44, 60, 71, 80, 100])
def test_a_table_keeps_every_number_and_word_whole_at_any_width_and_says_what_it_leaves_out(width, capsys, monkeypatch):
    """Frequencies of 24 and 49 segments are 3609.616 and 4450.808 Hz, each on one line."""
    monkeypatch.setenv("COLUMNS", str(width))
    status_of(["table", "paper", "--counts", "24,49", "--modes", "22"])
    out = capsys.readouterr().out
    lines = out.splitlines()
    assert max(map(len, lines)) <= width
    for size, hertz in (("24", "3609.616"), ("49", "4450.808")):
        (row,) = (line for line in lines if line.split()[:1] == [size])
        assert row.split()[1] == hertz
    assert "segments" in out
    told = " ".join(out.split())
    assert ("no room for" in told) == (width < 88)
    assert ("no room for bracket" in told or ", bracket," in told) == (width < 71)


WIDE = Table(
    columns=(
        Column("model", left=True),
        *(Column(f"column{n}", ".9f", said=f"This tells {n}.") for n in range(6)),
        Column("none", said="This tells of nothing."),
    ),
    rows=(("segments", *(100.0 + n for n in range(6)), None),),
    notes=("Of all.",),
)


class WideFound(Found, frozen=True, eq=False, kw_only=True):
    """Something that tells this table."""

    def tables(self):
        return (WIDE,)


@pytest.mark.parametrize("width", [60, 80, 97])
def test_what_is_said_of_a_column_stands_only_below_a_table_that_shows_it(width, capsys, monkeypatch):
    """And a terminal as wide as is said shows all of them."""
    monkeypatch.setenv("COLUMNS", str(width))
    print_found(WideFound())
    out = " ".join(capsys.readouterr().out.split())
    heads = out.partition("–")[0]
    assert [n for n in range(6) if f"This tells {n}." in out] == [n for n in range(6) if f"column{n}" in heads]
    assert ("This tells of nothing." in out) == ("no room" not in out)
    if "no room" in out:
        monkeypatch.setenv("COLUMNS", out.split("a terminal of ")[1].split()[0])
        print_found(WideFound())
        assert "no room" not in capsys.readouterr().out


def test_a_page_says_nothing_of_a_column_that_it_leaves_out():
    (note, other) = _on_page(WIDE, ()).notes
    assert ("This tells 5." in note, "nothing" in note, other) == (True, False, "Of all.")


@pytest.mark.parametrize("width", [60, 80])
def test_a_plan_keeps_the_settings_that_tell_solves_apart(width, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(width))
    status_of(["plan", "instrument-arm"])
    out = capsys.readouterr().out
    assert "…" not in out
    assert "attachment=lever" in out
    assert "wall=third-order" in out
    assert ("no room for unknowns, vectors by" in out) == (width < 80)


def test_a_window_is_told_as_a_person_writes_it():
    with pytest.raises(InputError, match=r"window = \[0\.03425, 0\.10275\] "):
        check_window(load_scene("paper").beam, [0.05], 4276.0, (0.137 / 4, 3 * 0.137 / 4))
