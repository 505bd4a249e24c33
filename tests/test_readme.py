"""Figures in tables with a column `gate` or `where` equal the gates' expected values or what `verify measure` computes."""

import re
from functools import cache
from pathlib import Path

import pytest

from verify import load_scene
from verify.analysis.solution_cache import SolutionCache
from verify.cases.table import CASES
from verify.quantities.base import QUANTITIES, evaluate, parse_arguments
from verify.scene.file import packaged_scenes

ROOT = Path(__file__).parents[1]
PAGES = [
    ROOT / "README.md",
    ROOT / "docs" / "index.md",
    ROOT / "docs" / "limits.md",
    *sorted((ROOT / "docs" / "findings").glob("*.md")),
]
FACTORS = {"": 1.0, "%": 100.0, "Hz": 1.0, "mm": 1e3, "cm/s": 100.0, "nm": 1e9, "nm/s": 1e9, "µm": 1e6, "ms": 1e3}
NUMBER = re.compile(r"([+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)\s*(%|Hz|mm|nm/s|nm|cm/s|µm|ms)?")


def rows_of(page):
    """(question, figures, scene, sources) of every row; the scene is the one named in the row, else last in the text."""
    rows, scene, inside = [], "", False
    for line in page.read_text("utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("| ").split(" | ")]
        if not line.startswith("|"):
            scene, inside = (re.findall(r"[Ss]cene `([a-z-]+)`", line) or [scene])[-1], False
        elif cells[-1] in ("gate", "where"):
            inside = True
        elif inside and not line.startswith("|--"):
            names = re.findall(r"`([^`]+)`", cells[-1])
            own = names.pop(0) if names[0] in packaged_scenes() else scene
            rows.append((cells[0], cells[1], own, tuple(names)))
    return rows


@cache
def scene_and_cache(name):
    scene = load_scene(name)
    return scene, SolutionCache(scene.beam)


@cache
def value_of(scene, source):
    """The expected value of a gate, that of its case where it judges an error, or a quantity with arguments."""
    name, *arguments = source.split()
    loaded, solutions = scene_and_cache(scene)
    if name in QUANTITIES:
        return evaluate(name, parse_arguments(name, arguments), loaded, solutions)
    (gate,) = (gate for gate in loaded.gate if gate.id == name)
    return CASES[gate.arguments["case"]].exact if gate.quantity == "case.error" else gate.expect


def figures_of(text):
    """(digits, unit) of each figure in a cell; the unit of the last holds for all before it, except %."""
    found = [NUMBER.fullmatch(part.strip()) for part in re.split(r"[,;]", text)]
    assert all(found), text
    last = found[-1][2] or ""
    return [(one[1], one[2] or ("" if last == "%" else last)) for one in found]


def rounds_to(digits, value):
    mantissa, _, exponent = digits.partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0)
    return abs(value - float(digits)) <= 0.5000001 * 10.0**-places


ROWS = list(dict.fromkeys(row for page in PAGES for row in rows_of(page)))


def test_tables_are_read():
    assert len(ROWS) > 60
    assert not rounds_to("-0.429", 100.0 * value_of("paper", "segment-mode-22"))
    assert {row[2] for row in ROWS} > {"paper", "paper-wave", "paper-slider", "chain", "preloaded-motor", "taut-strip"}


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0][:40])
def test_printed_figures_equal_their_sources(row):
    _, text, scene, sources = row
    figures = figures_of(text)
    assert len(figures) == len(sources)
    for (digits, unit), source in zip(figures, sources, strict=True):
        assert rounds_to(digits, FACTORS[unit] * value_of(scene, source)), f"{source} = {value_of(scene, source)}"


def test_readme_is_short_and_has_two_commands_of_setting_up():
    text = (ROOT / "README.md").read_text("utf-8")
    assert len(text.splitlines()) <= 100
    assert re.findall(r"^```sh\n(.*)\n```$", text, re.MULTILINE) == [
        "pip install . && verify scenes init my.toml && verify run my.toml",
        "pip install '.[test]' && pytest",
    ]
    assert all((ROOT / link).exists() for link in re.findall(r"\]\(([^):#]+)[^)]*\)", text))
