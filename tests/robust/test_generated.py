"""Scenes and command lines that nobody wrote: each is answered, refused in a sentence, or a fault of the suite's.

160 of them by default and 40 of a second kind. `pytest -m hostile` takes 10 000 and 1000 others, for an hour or two.
"""

from functools import cache

import pytest
from drawn_further_lines import further_line
from drawn_lines import drawn_line
from watched import timeless, wrong_with

from verify.bench import running

IN_A_ROW = 20
MANY = 100


@pytest.fixture(autouse=True)
def imports_are_timed_once(monkeypatch):
    """In 15 processes of their own: the same for every bench."""
    monkeypatch.setattr(running, "import_costs", cache(running.import_costs))


def complaints(seeds, draw=drawn_line):
    """What is wrong, by the number that draws it again: `drawn_line(number)`, `further_line(number)`."""
    found = {seed: wrong_with(draw(seed))[1] for seed in seeds}
    return {seed: wrong for seed, wrong in found.items() if wrong}


@pytest.mark.parametrize("row", range(8))
def test_a_drawn_line_is_answered_or_refused_and_the_same_the_second_time(row):
    assert complaints(range(IN_A_ROW * row, IN_A_ROW * (row + 1))) == {}


@pytest.mark.parametrize("row", range(2))
def test_a_line_of_the_second_kind_is_answered_or_refused_and_the_same_the_second_time(row):
    assert complaints(range(5000 + IN_A_ROW * row, 5000 + IN_A_ROW * (row + 1)), further_line) == {}


@pytest.mark.hostile
@pytest.mark.parametrize("row", range(100))
def test_ten_thousand_drawn_lines_are_answered_or_refused(row):
    assert complaints(range(1000 + MANY * row, 1000 + MANY * (row + 1))) == {}


@pytest.mark.hostile
@pytest.mark.parametrize("row", range(10))
def test_a_thousand_lines_of_the_second_kind_are_answered_or_refused(row):
    assert complaints(range(MANY * row, MANY * (row + 1)), further_line) == {}


def test_the_second_kind_is_drawn_alike_too_and_asks_for_what_the_first_does_not():
    lines = [further_line(seed) for seed in range(200)]
    assert lines == [further_line(seed) for seed in range(200)]
    assert {"export", "picture", "compare-shapes", "diff", "report", "bench", "catalogue"} <= {
        line.words[0] for line in lines
    }
    scenes = b"".join(line.files["scene.toml"] for line in lines)
    for key in (b"motor", b"foot", b"contact", b"layer_stiffness", b"restitution", b"device", b"methods", b"bench",
                b"stress", b"uncertainty", b"pull"):  # fmt: skip
        assert b'"%s"' % key in scenes or b"%s = " % key in scenes, key


def test_what_is_drawn_is_the_same_for_one_number_and_of_every_kind():
    lines = [drawn_line(seed) for seed in range(600)]
    assert lines == [drawn_line(seed) for seed in range(600)]
    commands = {line.words[0] for line in lines}
    assert {"run", "plan", "measure", "table", "choose", "compare", "init", "show", "keys", "schema"} <= commands
    scenes = b"".join(data for line in lines for name, data in line.files.items() if name.endswith("toml"))
    for key in (b"tension", b"foundation", b"rotational", b"rotary_inertia", b"section", b"slider", b"motion",
                b"timoshenko", b"tube", b"readings", b"axial_inertia", b"wave = ", b"claim", b"nan", b"\\u001b"):  # fmt: skip
        assert key in scenes, key


def test_columns_of_times_are_left_out_of_what_is_compared_and_no_others():
    """In quoted cells too, and the last column or not."""
    told = 'method,warm_s,error,rounds\n"links, lever",{},0.25,{}\n'
    assert timeless(told.format(0.004, 9)) == timeless(told.format(0.008, 4))
    assert timeless(told.format(0.004, 9)) != timeless(told.replace("0.25", "0.26").format(0.004, 9))
    ruled = "| method | warm_s | error |\n| links, lever | {} | 0.25 |\n"
    assert timeless(ruled.format(0.004)) == timeless(ruled.format(0.008))
    assert timeless(ruled.format(0.004)) != timeless(ruled.replace("lever", "pin").format(0.004))
