"""What the studies of modes say in words: against which theory a figure is, and why a column is empty."""

import re
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

import verify
from verify.judge.variants import Variant
from verify.judge.workbench import Workbench
from verify.models.catalogue import MODELS
from verify.report.drawing import drawn as drawing_of
from verify.report.inks import dark_inks, ink
from verify.scenes.scene import load_scene
from verify.studies.chart import Axis, Chart
from verify.studies.charting import (
    GREY,
    MEAN_COLOUR,
    ON_DARK,
    OTHERS,
    PALETTE,
    PLATE,
    RAYLEIGH,
    SHADES,
    TIMOSHENKO,
    other_line,
)
from verify.studies.modes.convergence import Convergence
from verify.studies.modes.convergence_figures import Cell, ConvergenceFound, Row, _local_order, convergence
from verify.studies.modes.spectrum import Spectrum
from verify.studies.modes.spectrum_figures import spectrum

THICK = Workbench(load_scene("thick-bar").beam)


def test_a_table_of_two_theories_names_the_exact_frequency_of_each():
    told = convergence(THICK, Convergence(modes=(2,), counts=(7, 12), theory=("euler-bernoulli", "timoshenko")))
    first, _, rules, thick = told.tables()
    assert first.title == "mode 2, exact 1454.4703 Hz (Euler-Bernoulli), 1401.4956 Hz (Timoshenko)"
    assert rules.title == "mode 2 by Euler-Bernoulli and every rule of the chain, error in %"
    walls = ["wall half", "wall welded", "wall third-order", "wall five-joint"]
    assert [column.head for column in rules.columns] == ["N", "default", *walls]
    assert thick.title == "mode 2 by Timoshenko and every rule of the chain, error in %"
    assert [column.head for column in thick.columns] == ["N", "default", walls[0], *walls[2:], "joints tensioned"]


FREE = Workbench(load_scene("free-free-bar").beam)
CLAMPED = Workbench(load_scene("steel-cantilever").beam)


@pytest.mark.parametrize(
    ("bench", "asked", "by"),
    [
        (FREE, {"theory": ("timoshenko", "euler-bernoulli")}, (("theory", "euler-bernoulli"),)),
        (FREE, {"grading": (1.7, 1.0)}, (("grading", 1.0),)),
        (CLAMPED, {"wall": ("gregory", "half", "third-order")}, (("wall", "half"),)),
        (FREE, {"wall": ("gregory", "half")}, ()),  # no end is clamped: both are the same
    ],
)
def test_a_bracket_beside_several_settings_is_that_of_one_of_them_and_names_it(bench, asked, by):
    several = convergence(bench, Convergence(modes=(3,), counts=(12, 17), **asked))
    alone = convergence(bench, Convergence(modes=(3,), counts=(12, 17), **dict(by)))
    assert [row.bracket_width for row in several.rows] == [row.bracket_width for row in alone.rows]
    assert [row.mean_error for row in several.rows] == [row.mean_error for row in alone.rows]
    assert None not in [row.bracket_width for row in alone.rows]
    words = ", ".join(f"{name} {word}" for name, word in by)
    assert bool(by) == any(f"are those of {words}:" in note for note in several.rows[0].notes)
    lower, upper = bracket_lines(several)
    below, above = bracket_lines(alone)
    assert (lower.y, upper.y) == (below.y, above.y)


def test_every_rule_of_the_table_stands_in_the_plain_data_too():
    """The terminal names --csv where a column finds no room: it must be there."""
    found = convergence(CLAMPED, Convergence(modes=(1, 2), counts=(9, 14)))
    other, first, second = (found.records()[i] for i in (0, 2, 3))
    table = found.tables()[-1]
    assert set(other) == set(first)
    assert other["segment wall=half_error"] is None
    for one, column in zip(found.rules, range(1, len(table.columns)), strict=True):
        told = [row[column] for row in table.rows]
        assert [row[f"{one.variant.label}_error"] for row in (first, second)] == told


def bracket_lines(found):
    """(lower, upper) of the chart of the bound."""
    (chart,) = (chart for chart in found.charts() if chart.id == "bracket")
    return chart.lines[1], chart.lines[0]


def test_without_a_setting_that_has_a_bracket_there_is_none():
    """A free bar by Rayleigh and Timoshenko: the width of Euler-Bernoulli's bracket stood beside their errors."""
    found = convergence(FREE, Convergence(modes=(2,), counts=(20, 41), theory=("rayleigh", "timoshenko")))
    assert [(row.bracket_width, row.mean_error) for row in found.rows] == [(None, None)] * 2
    assert any("theory = 'rayleigh'" in note for note in found.rows[0].notes)
    assert "bracket" not in [chart.id for chart in found.charts()]
    row = found.records()[0]
    assert "exact_hz" not in row
    assert row["timoshenko_exact_hz"] == pytest.approx(FREE.exact_hz(2, "timoshenko"), rel=1e-12)
    assert row["rayleigh_exact_hz"] == pytest.approx(FREE.exact_hz(2, "rayleigh"), rel=1e-12)


def test_every_rule_is_by_each_of_several_theories_and_by_none_that_nobody_asks_for():
    settings = {"grading": 1.3, "joints": ("series", "tensioned")}
    both = convergence(CLAMPED, Convergence(modes=(2,), counts=(9,), theory=("rayleigh", "timoshenko"), **settings))
    found = {one.variant: one.errors for one in both.rules}
    assert {one.theory for one in found} == {"rayleigh", "timoshenko"}
    for theory in ("rayleigh", "timoshenko"):
        alone = convergence(CLAMPED, Convergence(modes=(2,), counts=(9,), theory=theory, **settings)).rules
        assert {one.variant: one.errors for one in alone} == {v: e for v, e in found.items() if v.theory == theory}
        assert "segment wall=half grading=1.3 theory=" + theory in {one.variant.label for one in alone}


def test_a_table_of_one_theory_names_its_exact_frequency():
    told = convergence(THICK, Convergence(modes=(3,), counts=(7, 12), theory="timoshenko"))
    assert told.tables()[0].title == "mode 3, exact 3747.5412 Hz"  # by a transfer matrix written apart


def test_a_theory_s_own_shift_is_not_said_to_be_against_itself():
    (told,) = spectrum(THICK, Spectrum(modes=5, count=11, theory="timoshenko")).facts()
    thick, _, theories = told.partition(", and against Euler-Bernoulli ")
    assert thick.startswith("mode 5 at N = 11 against Timoshenko: segments")
    assert "theory" not in thick
    assert theories.startswith("Rayleigh theory -")


@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
def test_a_mesh_is_called_too_fine_for_a_theory_that_leaves_something_out_alone(theory):
    chart = spectrum(THICK, Spectrum(modes=3, count=11, theory=theory)).charts()[1]
    assert ("nobody asked" in chart.caption) == (theory == "euler-bernoulli")


def test_a_rule_that_is_refused_at_every_size_says_why_and_one_that_cannot_exist_has_no_column():
    taut = load_scene("paper", ("beam.tension=1e5", 'beam.supports=["clamped","pinned"]')).beam
    rules = convergence(Workbench(taut), Convergence(modes=(1,), counts=(15, 22))).tables()[-1]
    assert any(note.startswith("joints tensioned: ") and "leaves no stiffness" in note for note in rules.notes)
    assert "wall welded" not in [column.head for column in rules.columns]


THEORIES = ("euler-bernoulli", "rayleigh", "timoshenko")


def strokes(chart):
    """Of every line with a name what it looks like."""
    return {
        one.name: (one.colour, one.dash, one.marker, all(one.hollow) and bool(one.hollow), one.width)
        for one in chart.lines
        if one.y
    }


def tube():
    """A thick one with a body, so that walls, joints and attachments all tell."""
    changes = ("beam.supports=clamped,free", "beam.mass=[{position=0.2, mass=0.3}]")
    return Workbench(load_scene("thick-bar", changes).beam)


def test_no_two_lines_of_a_chart_look_alike():
    shown = spectrum(tube(), Spectrum(modes=3, count=13, theory=THEORIES, joints=("series", "tensioned"))).charts()
    swept = Convergence(modes=(1,), counts=(9, 14), theory=THEORIES, joints=("series", "tensioned"))
    charts = {chart.id: chart for chart in (*shown, *convergence(tube(), swept).charts())}
    for name in ("mode-errors", "model-form", "errors-over-size", "rules"):
        looks = strokes(charts[name])
        assert len(looks) >= 8
        assert len(set(looks.values())) == len(looks), name


def luminance(colour):
    """Of WCAG 2.2."""
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


GREEN_BLIND = np.array(
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
)
"""Linear RGB as eyes without the green cones have it: Machado, Oliveira and Fernandes 2009, table 1, severity 1."""
CONES = np.array(
    [[0.4122215, 0.5363325, 0.0514460], [0.2119035, 0.6806995, 0.1073970], [0.0883025, 0.2817188, 0.6299787]]
)
OPPONENTS = np.array(
    [[0.2104543, 0.7936178, -0.0040720], [1.9779985, -2.4285922, 0.4505937], [0.0259040, 0.7827718, -0.8086758]]
)
"""Ottosson's Oklab 2020: of the cube roots of what `CONES` makes of linear RGB."""


def linear(colours):
    parts = np.array([[int(one[i : i + 2], 16) for i in (1, 3, 5)] for one in colours]) / 255.0
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def least_apart(colours, seen):
    """The least distance of two colours that eyes with that matrix see, Oklab, in hundredths."""
    lab = 100.0 * np.cbrt(np.clip(linear(colours) @ seen.T, 0.0, 1.0) @ CONES.T) @ OPPONENTS.T
    return min(np.linalg.norm(a - b) for a, b in combinations(lab, 2))


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_every_line_stands_out_from_its_card_and_others_look_unlike_each_other(theme):
    """By three to one, as graphics have to; lines told by colour alone also by eyes without the green cones."""
    style = (Path(verify.__file__).parent / "report" / "page.css").read_text("utf-8") + dark_inks()
    light, dark = re.findall(r"--card:(#[0-9a-f]+)", style)
    card = light.replace("#fff", "#ffffff") if theme == "light" else dark

    def shown(colour):
        """As a page of the theme has it, read from what is drawn and from the style."""
        if not (variable := re.fullmatch(r"var\((--[0-9a-f]+), (#[0-9a-f]{6})\)", ink(colour))):
            return colour
        return variable[2] if theme == "light" else re.search(rf"{variable[1]}:(#[0-9a-f]{{6}})", dark_inks())[1]

    models = [model.colour for model in MODELS.values()]
    drawn = (*OTHERS, *PALETTE, *models, *SHADES, *ON_DARK, GREY, MEAN_COLOUR, RAYLEIGH, TIMOSHENKO, PLATE)
    bright = [max(p) / min(p) for p in ((luminance(shown(c)) + 0.05, luminance(card) + 0.05) for c in drawn)]
    assert min(bright) > 3.0
    beside = [shown(colour) for colour in (*OTHERS, *models)]
    assert least_apart(beside, np.eye(3)) > 8.0
    assert least_apart(beside, GREEN_BLIND) > 8.0


def test_a_drawn_chart_has_its_colours_by_the_theme():
    chart = Chart(id="c", title="", caption="", x=Axis("x"), y=Axis("y"), lines=(other_line(2, "a", (0, 1), (1, 3)),))
    svg = drawing_of(chart).svg
    assert f"var(--{OTHERS[2][1:]}, {OTHERS[2]})" in svg
    assert f"stroke: {OTHERS[2]}" not in svg


def test_other_lines_look_unlike_each_other_when_colours_come_round_again():
    lines = [other_line(i, f"{i}", (1.0, 2.0), (3.0, 1.0)) for i in range(4 * len(OTHERS))]
    assert len({(one.colour, one.hollow, one.width) for one in lines}) == len(lines)
    known = {model.colour for model in MODELS.values()} | {GREY, MEAN_COLOUR, RAYLEIGH, TIMOSHENKO, PLATE}
    assert not known & set(OTHERS)


@pytest.mark.parametrize(("mode", "counts", "dips"), [(2, (12, 16, 20), True), (1, (5, 6), False)])
def test_a_dip_is_explained_where_an_error_changes_its_sign(mode, counts, dips):
    found = convergence(tube(), Convergence(modes=(mode,), counts=counts))
    signs = [len({e > 0 for e in one.errors if e}) for one in found.rules]
    assert (max(signs) > 1) is dips
    chart = next(chart for chart in found.charts() if chart.id == "rules")
    assert ("A dip is" in chart.caption) is dips


STRIP = load_scene("free-free-bar").beam


def test_a_mode_that_neither_model_has_is_said_of_both():
    """A free chain of 9 links has 8 elastic modes, 9 elements have 18: of 20 modes neither has the last."""
    told = spectrum(Workbench(STRIP), Spectrum(modes=20, count=9))
    assert told.in_short() == "At mode 20 and N = 9, segments have none and Hermite elements have none."
    theories, chain, elements = told.facts()
    assert "theory" in theories
    assert chain.startswith("segments: mode = 20: the segment model at count = 9 has 8 elastic modes, raise count")
    assert chain.endswith("(8 of 20 modes have an error)")
    assert elements.startswith("Hermite elements: mode = 20: the fem model at count = 9 has 18 elastic modes")


def test_a_mode_that_one_model_has_not_is_said_beside_the_other():
    told = spectrum(Workbench(STRIP), Spectrum(modes=11, count=9))
    assert "segments have none" in told.in_short()
    assert "9 Hermite elements are +" in told.in_short()
    assert any(fact.startswith("segments: mode = 11") for fact in told.facts())
    found = convergence(Workbench(STRIP), Convergence(modes=(11,), counts=(7, 9)))
    assert "segments have no such mode and Hermite elements are +" in found.in_short()


def errors_of(*errors, due=4):
    """What is said of one model's errors over sizes that double."""
    counts = [12 * 2**i for i in range(len(errors))]
    pairs = list(zip(counts, errors, strict=True))
    orders = [None, *(_local_order(*a, *b) for a, b in pairwise(pairs))]
    cells = [Cell(frequency_hz=1.0, error=e, order=order) for e, order in zip(errors, orders, strict=True)]
    rows = tuple(
        Row(
            mode=5,
            count=n,
            exact_hz={"euler-bernoulli": 1.0},
            cells={"segment": one},
            bracket_width=None,
            mean_error=None,
        )
        for n, one in zip(counts, cells, strict=True)
    )
    return ConvergenceFound(rows=rows, variants=(Variant("segment"),), slopes=(("segment", due),) if due else ())


@pytest.mark.parametrize(
    ("errors", "due", "said"),
    [
        ((0.1, 0.1 / 16, 0.1 / 256), 4, "falling at order 4.00."),
        ((0.1, 0.1 / 16, 0.1 / 16 / 362), 4, "falling at no settled order (4.00, 8.50, where 4 is due:"),
        ((0.1, 0.1 / 16 / 16, 0.1 / 16 / 256), 4, "falling at no settled order (8.00, 4.00, where 4 is due:"),
        ((0.1, 0.1 / 4, 0.1 / 16), 4, "falling at no settled order (2.00, 2.00, where 4 is due:"),
        ((0.1, 0.1 / 4, 0.1 / 16), 2, "falling at order 2.00."),
        ((0.1, 0.1 / 8, 0.1 / 64), None, "falling at order 3.00."),
        ((0.1, 0.1 / 2, 0.1 / 64), None, "falling at no settled order (1.00, 5.00:"),
        ((0.1, 0.1 / 16), 4, "falling at order 4.00 over two sizes alone."),
        ((0.1, 0.1 / 16, -0.1 / 256), 4, "with no order to the size before (rounding, or a change of sign)."),
        ((0.1, 0.01, 0.02), 4, "not falling yet with the size before."),
        ((0.1,), 4, "segments are +10.0000 % off."),
    ],
)
def test_an_order_is_told_where_it_is_settled_at_what_is_due(errors, due, said):
    assert said in errors_of(*errors, due=due).in_short()


def test_a_table_says_of_which_rule_the_orders_are_not_settled():
    """The guided bar's chain passes through zero between its sizes: 6.7 and 2.5 where 4 is due."""
    notes = load_and_tell("guided-bar").tables()[1].notes
    assert "segments: orders are not settled, 4 is due" in notes
    assert not any("orders are not settled" in note for note in load_and_tell("free-free-bar").tables()[1].notes)


def load_and_tell(name):
    scene = load_scene(name)
    return convergence(Workbench(scene.beam), scene.convergence)
