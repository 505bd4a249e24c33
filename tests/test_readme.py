"""Every figure of the tables of the README, the first page and the findings against a run, to the printed digits.

A row's last column says where its figures come from, one source for each: the id of a gate, a quantity with its
arguments (`mode.frequency model=analytic mode=3`), or the path of a figure in `verify run --json`
(`motion.runs.segment.mean_speed`), of the scene that the text before the table names last, or that the row names.
"""

import re
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
import pytest
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.report.plain import run_as_plain
from verify.run.gates import judge
from verify.run.runner import run_scene, workbench_for
from verify.scenes.scene import load_scene, packaged_scenes
from verify.scenes.toml import given_arguments

ROOT = Path(__file__).parent.parent
PAGES = [
    ROOT / "README.md",
    ROOT / "docs" / "index.md",
    ROOT / "docs" / "limits.md",
    *sorted((ROOT / "docs" / "findings").glob("*.md")),
]
FACTORS = {"": 1.0, "%": 100.0, "Hz": 1.0, "mm": 1e3, "cm/s": 100.0, "nm": 1e9, "µm": 1e6, "ms": 1e3}
NUMBER = re.compile(r"([+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)\s*(%|Hz|mm|nm|cm/s|µm|ms)?")

UNTESTED = {
    "run time of elements over segments at one error of the displacement": "run time, by the command",
    "MuJoCo 4.0.0 over this suite": "run time beside another engine, by its bench",
    "rounding in modes 1 and 50 of 10 000 segments or elements": "asserted by the test that the row names",
    "stock scikit-fem, its own Hermite element": "asserted by the test that the row names",
    "which of the paper's six facts hold at 30 N": "asserted by the tests that the row names",
    "tangential, from rest: mu that -1.5 cm/s takes at least": "asserted by the tests that the row names",
}
"""Rows without a source, by how they begin, and why."""


class Row(msgspec.Struct, frozen=True):
    """One row of a table."""

    question: str
    figures: str
    scene: str
    sources: tuple[str, ...]
    errors: bool
    """Whether its figures are relative errors of gates against what they expect: `error of` stands before them."""


def rows_of(text):
    """The rows of every table whose last column is `gate` or `where`."""
    rows, scene, inside = [], "", False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            scene = re.findall(r"scene `([a-z-]+)`", line)[-1] if re.search(r"scene `[a-z-]+`", line) else scene
            inside = False
        elif cells[-1] in ("gate", "where"):
            inside = True
        elif inside and set(line) - set("|-: "):
            rows.append(row_of(cells, scene))
    return rows


def row_of(cells, scene):
    question, figures, where = cells
    named = re.findall(r"`([^`]+)`", where)
    own = named[0] if named and named[0] in packaged_scenes() else None
    sources = tuple(name for name in named[bool(own) :] if is_source(name, own or scene))
    return Row(question, figures, own or scene, sources, where.startswith("error of"))


def is_source(name, scene):
    """Whether a name is a gate of the scene, a quantity with arguments or a path into a run."""
    head = name.split()[0]
    paths = (
        "motion.runs.",
        "motion.readings.",
        "motion.facts.",
        "axial_inertia.",
        "wave.rows.",
        "convergence.",
        "motor.",
    )
    with_arguments = head in QUANTITIES and len(name.split()) > 1
    return with_arguments or name.startswith(paths) or (scene and name in {gate.id for gate in load_scene(scene).gate})


@cache
def bench_of(scene):
    return workbench_for(load_scene(scene), gates_only=True)


@cache
def gate_of(scene, name):
    """(measured, expected)."""
    (gate,) = (gate for gate in load_scene(scene).gate if gate.id == name)
    found = judge(gate, load_scene(scene), bench_of(scene))
    assert found.passed, f"{name}: {found.reason}"
    return found.measured, gate.expect


@cache
def run_of(scene):
    """The studies of a scene in plain data, its gates left out."""
    return run_as_plain(run_scene(msgspec.structs.replace(load_scene(scene), gate=())), None)


def at_path(data, path):
    """A figure in plain data; of a list of models the one that is named."""
    for name in path.split("."):
        if isinstance(data, list | tuple):
            by_model = {one.get("model"): one for one in data if isinstance(one, dict)}
            data = data[int(name)] if name.isdigit() else by_model[name]
        else:
            data = data[name]
    return data


@cache
def found_by(scene, source):
    """(the figure of a source, what it was expected to be or None)."""
    head, *arguments = source.split()
    if arguments:
        checked = arguments_of(QUANTITIES[head], given_arguments(tuple(arguments)))
        return evaluate(QUANTITIES[head], checked, load_scene(scene), bench_of(scene)), None
    if head in {gate.id for gate in load_scene(scene).gate}:
        return gate_of(scene, head)
    return at_path(run_of(scene), head), None


def printed_figures(text):
    """[(digits, unit), ...] of a cell, or None where it is not figures alone; a unit at its end holds for all but %."""
    parts = [NUMBER.fullmatch(part.strip()) for part in re.split(r"[,;]", text)]
    if not all(parts):
        return None
    last = parts[-1].group(2) or ""
    return [(part.group(1), part.group(2) or (last if last != "%" else "")) for part in parts]


def prints_as(digits, value):
    """Whether a value, rounded to as many places, is what is printed; a bare 0 is rounding."""
    if float(digits) == 0.0:
        return abs(value) < 1e-9
    mantissa, _, exponent = digits.partition("e")
    places = len(mantissa.partition(".")[2]) - int(exponent or 0)
    return abs(value - float(digits)) <= 0.5 * 10.0**-places * (1 + 1e-9)


def is_right(digits, unit, value):
    """Whether a printed figure is what was found, in a number or in words."""
    if isinstance(value, str):
        return digits in re.findall(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?", value)
    return prints_as(digits, FACTORS[unit] * value)


def wrong_in(row):
    """The figures of a row that no run gives, empty where all is right."""
    printed = printed_figures(row.figures)
    if printed is None:
        return [] if in_words(row) else [row.figures]
    found = [found_by(row.scene, source) for source in row.sources]
    assert len(found) == len(printed), f"{row.question}: {len(printed)} figures of {len(found)} sources"
    values = [value / expected - 1.0 if row.errors else value for value, expected in found]
    return [digits for (digits, unit), value in zip(printed, values, strict=True) if not is_right(digits, unit, value)]


def drift(name):
    return gate_of("paper-slider", name)[0]


def pure_wave_drift():
    """-(k omega A^2 / 2)(1 + (k h / 2)^2) for the amplitude of the gate."""
    beam, omega, amplitude = load_scene("paper").beam, 2 * np.pi * 4276.0, 2.3e-7
    k = np.sqrt(omega / beam.wave_constant)
    return -0.5 * k * omega * amplitude**2 * (1 + (0.5 * k * beam.thickness) ** 2)


def in_words(row):
    """Whether a figure said in words is right."""
    found = [found_by(row.scene, source) for source in row.sources]
    if row.figures == "exact":
        return all(abs(value / expected - 1.0) < 1e-8 for value, expected in found)
    if row.figures == "twice that":
        return found[0][0] / drift("terminal-speed-flat") == pytest.approx(2.0, abs=0.01)
    if part := re.fullmatch(r"a (\d+)th", row.figures):
        return round(drift("terminal-speed-flat") / found[0][0]) == int(part.group(1))
    if row.figures == "-(k omega A²/2)(1 + (kh/2)²), against the wave":
        return found[0][0] == pytest.approx(pure_wave_drift(), rel=1e-4)
    return False


TEXTS = [page.read_text("utf-8") for page in PAGES]
ROWS = [row for text in TEXTS for row in rows_of(text)]
TESTED = list(dict.fromkeys(row for row in ROWS if row.sources))


def test_every_table_of_figures_is_seen():
    for page, text in zip(PAGES, TEXTS, strict=True):
        lines = [line for line in text.splitlines() if line.startswith("| ")]
        heads = sum(re.search(r"\| (gate|where|measured in) \|$", line) is not None for line in lines)
        elsewhere = sum(re.search(r"\| \[[^|]*\]\([^|]*\) \|$", line) is not None for line in lines)
        assert len(rows_of(text)) == len(lines) - heads - elsewhere, page.name
    assert len(TESTED) >= 55
    assert {row.scene for row in TESTED} >= {"paper", "paper-wave", "paper-slider", "chain", "steel-cantilever"}


def test_rows_without_a_source_are_those_listed():
    bare = [row.question for row in ROWS if not row.sources]
    assert len(bare) == len(UNTESTED)
    assert all(sum(question.startswith(start) for question in bare) == 1 for start in UNTESTED)


@pytest.mark.parametrize("row", TESTED, ids=lambda row: row.question[:48])
def test_a_page_prints_what_a_run_gives_and_a_digit_changed_on_it_is_seen(row):
    """Every digit of every printed figure in turn, up by one."""
    assert wrong_in(row) == []
    where = [match.start() for match in re.finditer(r"\d", row.figures)] if printed_figures(row.figures) else []
    for i in where:
        other = str((int(row.figures[i]) + 1) % 10)
        changed = msgspec.structs.replace(row, figures=row.figures[:i] + other + row.figures[i + 1 :])
        assert wrong_in(changed), f"{row.figures} -> {changed.figures}"
    if (words := re.search(r"\d(?=th)", row.figures)) is not None:
        assert wrong_in(msgspec.structs.replace(row, figures=row.figures.replace(words.group(), "9", 1)))


def test_a_sign_a_unit_and_a_gate_that_are_wrong_are_seen():
    text = "\n".join(TEXTS)
    for right, wrong in (
        ("| -0.428 % |", "| 0.428 % |"),
        ("| 4469.94 Hz |", "| 4469.94 % |"),
        ("`segment-mode-22`", "`fem-mode-22`"),
        ("| 4, 4, 6 |", "| 4, 6, 4 |"),
        ("| +5e-9, -8e-6, -6e-4 |", "| +5e-9, -8e-6, +6e-4 |"),
    ):
        assert right in text
        changed = [row for row in rows_of(text.replace(right, wrong)) if row.sources]
        assert any(wrong_in(row) for row in changed if row not in TESTED), wrong
    (row,) = (
        row for row in rows_of(text) if row.question.startswith("standing-wave ratio at the paper's 4276 Hz, exact")
    )
    assert row.sources == ("swr-law",)
    lost = [row for row in rows_of(text.replace("`swr-law`", "`swr-lore`")) if row.question == row.question]
    assert sum(not row.sources for row in lost) == len(UNTESTED) + 1


def figures_in(text):
    return set(re.findall(r"\d+\.\d+", text))


def test_every_figure_said_in_words_stands_in_a_tested_row_or_in_a_dated_bench():
    """What the README and the first page say outside their tables, to the digits of a row or rounded from it."""
    rows = {float(figure) for row in ROWS for figure in figures_in(row.figures)}
    for text in TEXTS[:2]:
        prose = "\n".join(line for line in text.splitlines() if not line.startswith(("|", "beam = ")))
        bare = {
            figure
            for figure in figures_in(prose) - {"3.11", "0.5", "0.02", "0.001", "2700.0"}
            if not any(f"{known:.{len(figure.partition('.')[2])}f}" == figure for known in rows)
        }
        assert not bare, f"{sorted(bare)} stand in no tested row"


def test_what_the_first_page_says_of_time_stands_in_the_pages_that_it_names():
    rows = [line for line in TEXTS[1].splitlines() if line.startswith("| ") and "](" in line and "times" in line]
    assert len(rows) == 3
    for line in rows:
        question, ratios, where = (cell.strip() for cell in line.strip("|").split("|"))
        link = re.search(r"\(([^)]*)\)", where)[1]
        named = " ".join((ROOT / "docs" / link).read_text("utf-8").split())
        assert ratios.removesuffix(" times") in named, f"{question}: {ratios} is not in {link}"
