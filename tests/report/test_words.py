"""What the report and the terminal print in words holds no figure that a run did not give."""

import ast
import re
from pathlib import Path

import pytest
from sources import nodes_of

import verify
from verify.words import share_of_band

FIGURE = re.compile(
    r"(?<![\w.^/])[-+]?\d+(?:\.\d+)?\s?(?:%|Hz|kHz|cm/s|mm/s|m/s|µm|nm|mm|ms|mN|N|times)(?!\w)|(?<![\w.^/])\d+\.\d+(?![\w.])"
)
GIVEN = {
    "1.5 cm/s": "the paper's own figure",
    "15 µm": "the paper's mean speed over its millisecond",
    "1 ms": "the paper's time axis",
}
"""Figures in the words of a report that no run gives, and why they may stand there."""


EXAMPLES = ("plain.py", "design_map.py")
"""Whose figures are examples of what a user may type."""


def words_of_the_report():
    """(where, text) of every sentence that is printed: constants of the code, docstrings apart, and the template."""
    package = Path(verify.__file__).parent
    shown = [*(package / "report").glob("*.py"), *(package / "studies").rglob("*.py"), package / "words.py"]
    for path in (path for path in shown if path.name not in EXAMPLES):
        specs = {
            id(part)
            for node in nodes_of(path)
            if isinstance(node, ast.FormattedValue) and node.format_spec
            for part in ast.walk(node.format_spec)
        }
        docstrings = {id(node.value) for node in nodes_of(path) if isinstance(node, ast.Expr)}
        for node in nodes_of(path):
            if not (isinstance(node, ast.Constant) and isinstance(node.value, str)) or id(node) in specs | docstrings:
                continue
            if "<" not in node.value and '="' not in node.value and re.search("[a-z]{2}", node.value):  # no picture
                yield path.name, node.value
    template = (package / "report" / "page.html.j2").read_text("utf-8")
    for cut in (r"<style>.*?</style>", r"<script>.*?</script>", r"\{\{.*?\}\}", r"\{%.*?%\}", r"<[^>]*>"):
        template = re.sub(cut, "\n", template, flags=re.S)
    yield from (("page.html.j2", line) for line in template.splitlines())


def figures_in_words():
    return [
        (where, found) for where, text in words_of_the_report() for found in FIGURE.findall(text) if "rgba(" not in text
    ]


def test_no_sentence_of_the_report_holds_a_figure_that_a_run_did_not_give():
    assert [(where, found) for where, found in figures_in_words() if found.strip("-+ ") not in GIVEN] == []


@pytest.mark.parametrize(
    "sentence",
    [
        "elements take 0.59 times as long",
        "an error of 3.9 % at mid-span",
        "-0.00014 cm/s on segments",
        "about 147.2 here",
        "at 4276 Hz",
        "moves by 36 nm",
    ],
)
def test_a_figure_written_into_a_sentence_is_seen(sentence):
    assert FIGURE.findall(sentence)
    assert not FIGURE.findall("of order 6, (kL)^2, Eq. (3), [L/4, 3L/4], 2EI/l, N = 49, 10⁻¹²")


@pytest.mark.parametrize(
    ("share", "told"),
    [
        (None, "–"),
        (0.0, "0 %"),
        (0.3147, "31.5 %"),
        (0.9994, "99.9 %"),
        (0.9996, "under 100 %"),
        (1.0, "100 %"),
        (1.0004, "over 100 %"),
        (1.006, "101 %"),
        (float("inf"), "infinity %"),
    ],
)
def test_a_share_of_a_band_is_told_as_its_edge_only_where_it_is_there(share, told):
    assert share_of_band(share) == told
