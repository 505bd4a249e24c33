"""A sheet says of one case what a manual of verification says: problem, references, figures, bands, reasons."""

import json
import re

import pytest

from verify.report.sheets import index, markdown, sheet_of
from verify.run.gates import judge
from verify.run.runner import workbench_for
from verify.scenes.scene import STARTER, load_scene, packaged_scenes, tables_of


def sheet(name, *judged):
    scene = load_scene(name)
    bench = workbench_for(scene, gates_only=True)
    return sheet_of(scene, tables_of(name), [judge(gate, scene, bench) for gate in scene.gate if gate.id in judged])


def cells(text):
    """Every row of every table, as Markdown reads it."""
    lines = (line for line in text.splitlines() if line.startswith("|"))
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def test_a_sheet_states_the_problem_with_units_as_the_scene_states_it():
    inputs = {one.key: one for one in sheet("instrument-arm").inputs}
    assert inputs["beam.spring 1.stiffness"].value == 2e5
    assert inputs["beam.spring 1.stiffness"].meaning == "Against deflection, N/m."
    assert inputs["beam.mass 2.rotary_inertia"].value == 4e-4
    assert inputs["drive.force 2.phase_deg"].value == -83.0
    assert inputs["beam.supports"].value == ["free", "free"]
    assert "beam.bending_stiffness" not in inputs  # follows from what is given
    assert all(one.meaning for one in inputs.values())


def test_what_was_not_run_is_expected_and_not_measured():
    found = sheet("paper")
    text = markdown(found)
    assert not found.judged
    assert "| measured" not in text
    assert ["expected", "-0.00428024 ± 5e-09"] in cells(text)
    assert ["reference", "closed form ± 1.4e-09"] in cells(text)
    assert ["reference", "closed form, exact"] in cells(text)
    assert ["reference", "published ± 0.5 Hz"] in cells(text)
    assert "25 figures: 17 closed form, 1 independent method, 3 published, 4 other code." in text


def test_what_was_run_is_measured_with_its_share_of_the_band():
    found = sheet("paper", "segment-mode-22", "bracket-mode-5")
    one = next(figure for figure in found.figures if figure.id == "segment-mode-22")
    assert one.measured == pytest.approx(-0.0042802413, rel=1e-7)
    assert one.passed
    table = cells(markdown(found))
    assert ["measured", "-0.004280241, 26.7 % of its band"] in table
    assert ["measured", "230.4096 .. 231.2134 Hz, 18.4 % of its band"] in table
    assert ["measured", "–"] in table


def test_a_failed_gate_says_why():
    scene = load_scene("paper", ("gate.segment-order.expect=3.0",))
    results = [judge(gate, scene, workbench_for(scene)) for gate in scene.gate if gate.id == "segment-order"]
    text = markdown(sheet_of(scene, tables_of("paper"), results))
    assert "**failed**: measured 4.0246" in text
    assert next(gate for gate in scene.gate if gate.id == "segment-order").reference is None
    assert ["reference", "not said"] in cells(text)


def test_an_expectation_that_is_set_keeps_a_reference_that_is_set_as_well():
    said = ("gate.1.expect=3.0", "gate.0.at_most=1e-12", "gate.0.reference=regression", "gate.2.within=1e-3")
    first, _, third, *_ = load_scene("paper", (said[1], said[2], said[3])).gate
    assert (first.reference, third.reference) == ("regression", "closed form")
    assert load_scene("paper", ("gate.exact-mode-22.expect=4470.0",)).gate[2].source == ""


def test_no_cell_is_broken_by_what_a_gate_says():
    for scene in packaged_scenes():
        text = markdown(sheet(scene))
        wide = {len(row) for row in cells(text)}
        assert wide <= {2, 3, 4}, scene
        assert text.count("\n### ") == len(load_scene(scene).gate)
        assert f"<!-- drawing: {scene} -->" in text


def test_labels_are_of_one_figure_each_in_all_sheets_together():
    texts = [markdown(sheet(scene)) for scene in packaged_scenes()]
    labels = [label for text in texts for label in re.findall(r"^\((.+)\)=$", text, re.MULTILINE)]
    assert len(labels) == len(set(labels)) == sum(len(load_scene(scene).gate) for scene in packaged_scenes())
    linked = [label for text in texts for label in re.findall(r"\]\(#(.+?)\)", text)]
    assert linked == labels


def test_a_drawing_takes_its_slot():
    text = markdown(sheet("moving-load"), "![beam](beam.svg)")
    assert "\n\n![beam](beam.svg)\n\n| input" in text
    assert "<!--" not in text


def test_the_index_counts_references_and_lists_every_sheet():
    text = index([sheet("paper"), sheet("moving-load")])
    assert "29 figures: 21 closed form, 1 independent method, 3 published, 4 other code." in text
    assert "[A force that crosses a pinned beam at half its critical speed](moving-load.md)" in text
    assert "```{toctree}\n:hidden:\n\npaper\nmoving-load\n```" in text


def test_a_scene_of_ones_own_has_a_sheet_too(verify, tmp_path):
    (tmp_path / "mine.toml").write_text(STARTER.read_text("utf-8"), encoding="utf-8")
    status, out, _ = verify("catalogue", "mine.toml", "--json")
    (found,) = json.loads(out)
    assert status == 0
    assert found["references"] == {"not said": 2}
    assert found["figures"][0]["reference"] is None
    assert "2 figures: 2 not said." in verify("catalogue", "mine.toml")[1]


def test_the_command_writes_a_file_for_each_and_an_index(verify, tmp_path):
    status, out, _ = verify("catalogue", "paper", "moving-load", "--to", "sheets")
    assert (status, out) == (0, "wrote 2 sheets and index.md into sheets\n")
    assert verify("catalogue", "paper", "--to", "one")[1] == "wrote 1 sheet and index.md into one\n"
    assert sorted(path.name for path in (tmp_path / "sheets").iterdir()) == ["index.md", "moving-load.md", "paper.md"]
    assert (tmp_path / "sheets" / "paper.md").read_text("utf-8") == markdown(sheet("paper"))


def test_all_packaged_scenes_are_told_where_none_is_named(verify):
    assert [one["scene"] for one in json.loads(verify("catalogue", "--json")[1])] == list(packaged_scenes())


def test_a_run_tells_figures_and_ends_with_1_where_a_gate_fails(verify, tmp_path):
    own = STARTER.read_text("utf-8").replace("within = 0.005", "within = 0.00001")
    (tmp_path / "mine.toml").write_text(own, encoding="utf-8")
    status, out, _ = verify("catalogue", "mine.toml", "--run", "--json")
    (found,) = json.loads(out)
    assert status == 1
    assert [one["passed"] for one in found["figures"]] == [False, True]
    assert found["figures"][1]["measured"] == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("paper", "paper"), "scene = 'paper' stands twice: give every scene a name of its own, and each once"),
        (("papr",), "scene = 'papr' is neither a packaged scene nor a file: did you mean 'paper'?"),
    ],
)
def test_what_no_sheets_can_be_made_of_is_refused(verify, words, message):
    assert verify("catalogue", *words) == (2, "", f"verify: {message}\n")
