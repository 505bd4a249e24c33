"""What a scene gives to other tools, read back by them: the numbers are those of the models."""

import csv
import json
import os
import re
import shutil
import subprocess
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

from verify import fem_beam, load_scene, segment_model
from verify.cli import status_of
from verify.errors import InputError
from verify.exports import meshes
from verify.exports.latex import document, escaped
from verify.exports.sheets import Wanted, field_sheet, modes_sheet
from verify.studies.told import Column, Table

PAPER = load_scene("paper").beam


@pytest.fixture
def export(tmp_path, monkeypatch, capsys):
    """Write a file in an empty folder: its path, once the command line has said well done."""
    monkeypatch.chdir(tmp_path)

    def call(*words, to):
        assert status_of(["export", *words, "--to", to]) == 0, capsys.readouterr().err
        return tmp_path / to

    return call


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """The sentence with which a line is refused; nothing is left behind."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        assert status_of(["export", *words]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert len(err.splitlines()) == 1
        assert os.listdir(tmp_path) == []
        return err

    return call


@pytest.mark.parametrize(("name", "solve"), [("segment", segment_model.solve_modes), ("fem", fem_beam.solve_modes)])
def test_a_vtu_of_modes_has_the_model_s_shapes_and_frequencies_to_rounding(export, name, solve):
    mesh = meshio.read(export("paper", "--model", name, "--count", "23", "--modes", "11", to="m.vtu"))
    modes = solve(PAPER, 11, 23)
    assert mesh.points[:, 0] == pytest.approx(modes.nodes, abs=1e-15)
    assert mesh.field_data["frequency_hz"] == pytest.approx(modes.frequencies_hz, rel=1e-15)
    shapes = modes.deflection(modes.nodes)
    assert sorted(mesh.point_data) == [f"mode_{n:02d}" for n in range(1, 12)]
    for n in range(11):
        assert mesh.point_data[f"mode_{n + 1:02d}"][:, 1] == pytest.approx(shapes[n], abs=1e-13 * abs(shapes[n]).max())
        assert not mesh.point_data[f"mode_{n + 1:02d}"][:, [0, 2]].any()


def test_cells_know_their_section(export):
    mesh = meshio.read(export("patched-strip", "--what", "modes", "--count", "24", to="p.vtu"))
    beam = load_scene("patched-strip").beam
    middles = mesh.points[mesh.cells_dict["line"], 0].mean(axis=1)
    ends = np.cumsum([piece.length for piece in beam.pieces])
    own = [beam.pieces[int(np.searchsorted(ends, x))].bending_stiffness for x in middles]
    assert mesh.cell_data_dict["bending_stiffness"]["line"] == pytest.approx(own, rel=1e-15)
    assert len(set(own)) == 3  # the patches are unlike, the bare strip is one


def test_raw_joints_and_corrected_ones_are_told_apart(export):
    corrected, raw = (meshio.read(export("paper", "--reading", one, to=f"{one}.vtu")) for one in ("corrected", "raw"))
    ratio = raw.point_data["mode_22"][7, 1] / corrected.point_data["mode_22"][7, 1]
    assert 1.05 < ratio < 1.3  # y + delta^2 y / 12 lies nearer to the axis


def collection(path):
    """(timestep, mesh) of every file that an index names."""
    rows = ElementTree.parse(path).getroot().find("Collection")
    return [(float(row.get("timestep")), meshio.read(path.parent / row.get("file"))) for row in rows]


def test_a_field_s_series_is_one_period_of_its_real_and_imaginary_part(export):
    path = export("paper-wave", "--model", "fem", "--count", "60", "--samples", "5", to="w.pvd")
    field = fem_beam.solve_harmonic(load_scene("paper-wave").beam, load_scene("paper-wave").forces, 4276.0, 60)
    steps = collection(path)
    assert [time for time, _ in steps] == pytest.approx(np.arange(5) / 5.0 / 4276.0, rel=1e-15)
    for time, mesh in steps:
        w = field.deflection(mesh.points[:, 0])
        assert mesh.point_data["real"][:, 1] == pytest.approx(w.real, abs=1e-18)
        now = np.real(w * np.exp(2j * np.pi * 4276.0 * time))
        assert mesh.point_data["deflection"][:, 1] == pytest.approx(now, abs=1e-12 * abs(w).max())


def test_a_motion_s_series_has_the_slider_beside_the_beam(export):
    path = export("paper-slider", "--count", "20", "--samples", "6", to="s.xdmf")
    from verify import simulate

    scene = load_scene("paper-slider")
    nodes = segment_model.solve_modes(scene.beam, 1, 20).nodes
    run = simulate(
        scene.beam, scene.forces, 4276.0, 1e-3, model="segment", count=20, soft_start_periods=2.0, slider=scene.slider,
        at=nodes, samples=6, steps_per_period=scene.motion.steps_per_period,
    )  # fmt: skip
    with meshio.xdmf.TimeSeriesReader(path) as series:
        points, _ = series.read_points_cells()
        rows = [series.read_data(i)[:2] for i in range(series.num_steps)]
    assert points[:, 0] == pytest.approx(run.points, abs=1e-15)
    assert [time for time, _ in rows] == pytest.approx(run.times, rel=1e-15)
    for i, (_, data) in enumerate(rows):
        assert data["deflection"][:, 1] == pytest.approx(run.deflection[i], abs=1e-20)
        assert data["slider_friction"][3] == pytest.approx(run.friction[i], rel=1e-15, abs=1e-18)


@pytest.mark.parametrize(("model", "to"), [("segment", "b.csv"), ("fem", "b.csv"), ("analytic", "b.csv")])
def test_a_beam_alone_in_time_is_exported_too_its_parts_end_where_it_does(export, tmp_path, model, to):
    """Forty-nine parts of two sections add up to 0.4000000000000004 m."""
    (tmp_path / "mine.toml").write_text(
        'name = "mine"\n[beam]\nlength = 0.4\nwidth = 0.02\nthickness = 0.004\nyoungs_modulus = 200e9\n'
        "density = 7800\nsection = [{length = 0.25}, {length = 0.15, thickness = 0.002}]\n"
        "[drive]\nfrequency_hz = 300\nforce = [{position = 0.1}]\n[motion]\nduration = 0.011\n"
    )
    count = () if model == "analytic" else ("--count", "49")
    path = export("mine.toml", "--what", "motion", "--model", model, *count, "--samples", "5", to=to)
    table = list(csv.reader(path.read_text("utf-8").splitlines()))
    scene = load_scene(str(tmp_path / "mine.toml"))
    from verify import simulate

    x = 0.4 if model == "analytic" else [0.4 * 0.5, 0.4]
    run = simulate(
        scene.beam,
        scene.forces,
        300.0,
        0.011,
        model=model,
        count=49 if count else None,
        at=x,
        samples=5,
        soft_start_periods=2.0,
    )
    assert len(table) > 5
    assert float(table[-1][-1]) == pytest.approx(run.deflection[-1, -1], abs=1e-15)


@pytest.mark.parametrize("model", [segment_model, fem_beam])
@pytest.mark.parametrize("count", [3, 49, 1000])
def test_the_last_node_is_the_end_of_the_beam(model, count):
    beam = load_scene("stepped-beam").beam
    nodes = model.solve_modes(beam, 1, count).nodes
    assert nodes[0] == 0.0
    assert nodes[-1] == beam.length
    assert (np.diff(nodes) > 0.0).all()


@pytest.mark.parametrize("to", ["m.vtu", "m.pvd", "m.xdmf"])
def test_pyvista_reads_the_same_numbers(export, to):
    pyvista = pytest.importorskip("pyvista", reason="pyvista is missing: pip install 'fem-segment-verify[viz]'")
    path = export("paper", "--count", "13", "--modes", "4", to=to)
    modes = segment_model.solve_modes(PAPER, 4, 13)
    shape = modes.deflection(modes.nodes)[3]
    if to == "m.vtu":
        mesh, name = pyvista.read(path), "mode_4"
        assert np.asarray(mesh.field_data["frequency_hz"]) == pytest.approx(modes.frequencies_hz, rel=1e-15)
    else:
        reader, name = pyvista.get_reader(path), "mode"
        assert reader.time_values == pytest.approx(modes.frequencies_hz, rel=1e-15)
        reader.set_active_time_value(reader.time_values[3])
        mesh = reader.read()[0]
    assert mesh.n_cells == 13
    assert np.asarray(mesh.points)[:, 0] == pytest.approx(modes.nodes, abs=1e-15)
    assert np.asarray(mesh.point_data[name])[:, 1] == pytest.approx(shape, abs=1e-15 * abs(shape).max())


def test_csv_json_and_npz_say_what_the_mesh_says(export):
    words = ("paper-wave", "--model", "analytic")
    with export(*words, to="f.csv").open() as stream:
        head, *rows = csv.reader(stream)
    table = np.array(rows, dtype=float)
    data = json.loads(export(*words, to="f.json").read_text())
    arrays = np.load(export(*words, to="f.npz"))
    w = field_sheet(load_scene("paper-wave"), Wanted(model="analytic")).at_points["real"][:, 1]
    assert (table[:, head.index("real")] == w).all()
    assert (np.array(data["real"])[:, 1] == w).all()
    assert (arrays["real"][:, 1] == w).all()
    assert data["drive_frequency_hz"] == [4276.0]
    assert arrays["deflection"].shape == (36, 201, 3)


def test_a_csv_of_modes_is_a_list_of_shapes_that_compare_takes(export, tmp_path, capsys):
    export("steel-cantilever", "--what", "modes", "--count", "30", "--modes", "5", to="m.csv")
    hertz = segment_model.solve_modes(load_scene("steel-cantilever").beam, 5, 30).frequencies_hz
    (tmp_path / "f.csv").write_text("\n".join(map(repr, hertz.tolist())))
    assert status_of(["compare", "f.csv", "--modes", "m.csv", "--scene", "steel-cantilever", "--count", "30"]) == 0
    assert "Gregory's weights" in capsys.readouterr().out


# --- LaTeX --------------------------------------------------------------------------------------------------------


def tabulars(text):
    """Columns and rows of every table, by LaTeX's own rules for its separators and braces."""
    for sides, body in re.findall(
        r"\\begin\{tabular\}\{((?:[lr]|p\{0.35\\linewidth\})+)\}(.*?)\\end\{tabular\}", text, re.S
    ):
        rows = [line for line in body.splitlines() if line and line != "\\hline"]
        assert all(line.endswith(" \\\\") for line in rows)
        yield len(re.findall(r"[lr](?![^{]*\})|p\{", sides)), [re.split(r"(?<!\\)&", line[:-3]) for line in rows]


def test_tables_in_latex_are_whole_and_hold_every_gate(export):
    text = export("steel-cantilever", to="t.tex").read_text("ascii")
    assert text.count("{") - text.count("\\{") == text.count("}") - text.count("\\}")
    found = list(tabulars(text))
    assert len(found) == text.count("\\begin{tabular}") > 3
    for n_columns, rows in found:
        assert {len(row) for row in rows} == {n_columns}
    cells = {cell.strip() for _, rows in found for row in rows for cell in row}
    assert {f"{{{gate.id}}}" for gate in load_scene("steel-cantilever").gate} <= cells
    assert not re.search(r"(?<!\\)[#%~]", text.split("\n", 1)[1])


def test_words_are_escaped():
    assert escaped("50 % of a_b & {c} \\d #1 ~ ^ $") == (
        r"50 \% of a\_b \& \{c\} \textbackslash{}d \#1 \textasciitilde{} \textasciicircum{} \$"
    )
    assert escaped("δ²y/12 ± é ☃") == r"$\delta$$^2$y/12 $\pm$ e U+2603"


def test_long_tables_are_cut_under_their_heads():
    rows = tuple((i, -0.5 * i) for i in range(1, 96))
    text = document("many", (Table(columns=(Column("n"), Column("y", "+.1f")), rows=rows),))
    assert [len(body) for _, body in tabulars(text)] == [41, 41, 16]
    assert "{95} & {$-$47.5}" in text


def wide(n_columns):
    """Eighteen figures of three beams: much wider than a page."""
    columns = (Column("field", left=True), *(Column(f"best efficiency {i}, %", ".4f") for i in range(1, n_columns)))
    rows = tuple((f"{10 * k} segments", *(k + i / 7.0 for i in range(1, n_columns))) for k in (1, 2, 3))
    return document("wide", (Table(columns=columns, rows=rows),))


def test_wide_tables_are_cut_into_those_that_a_line_holds_each_with_its_first_column():
    found = list(tabulars(wide(19)))
    assert [n for n, _ in found] == [3, 3, 3, 3, 3, 3, 3, 3, 3]
    assert [cell.strip() for _, rows in found for cell in rows[0][1:]] == [
        f"{{best efficiency {i}, \\%}}" for i in range(1, 19)
    ]
    assert {rows[2][0] for _, rows in found} == {"{20 segments} "}
    assert found[-1][1][3][2].strip() == "{5.5714}"  # 3 + 18/7


@pytest.mark.parametrize("text", [None, wide(19)], ids=["a scene's", "wide"])
def test_latex_takes_the_tables_and_none_runs_off_the_page(export, tmp_path, text):
    latex = shutil.which("pdflatex") or pytest.skip("there is no pdflatex here")
    if text is None:
        export("paper", to="t.tex")
    else:
        (tmp_path / "t.tex").write_text(text)
    (tmp_path / "d.tex").write_text("\\documentclass{article}\\begin{document}\\input{t.tex}\\end{document}")
    call = [latex, "-interaction=nonstopmode", "-halt-on-error", "d.tex"]
    said = subprocess.run(call, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert "Overfull \\hbox" not in said


# --- what is refused, and what is left behind ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("paper", "--to", "x.foo"), "has no suffix that is known"),
        (("paper", "--format", "vtk"), "format = 'vtk' is not known: did you mean 'vtu'?"),
        (("paper", "--format", "csv", "--to", "x.vtu"), "say two formats: give one"),
        (("paper", "--what", "slope"), "what = 'slope' is not known"),
        (("paper", "--what", "motion", "--to", "x.pvd"), "the scene has no [motion]"),
        (("patched-strip", "--what", "field"), "the scene has no drive with forces"),
        (("paper-slider", "--what", "motion", "--to", "x.vtu"), "one mesh holds one instant"),
        (("paper", "--what", "tables", "--to", "x.csv"), "one file holds one table"),
        (("paper", "--modes", "49"), "mode = 49: the segment model at count = 49 has 48 elastic modes"),
        (("paper", "--samples", "7"), "samples = 7: modes in vtu is no series"),
        (("paper-wave", "--modes", "7"), "modes = 7: field has no number of modes"),
        (("paper-wave", "--samples", "1", "--to", "x.pvd"), "samples = 1: give a whole number of at least 2"),
        (("paper", "--model", "fem", "--reading", "raw"), "reading = 'raw' is for shapes of segments"),
        (("paper", "--model", "analytic", "--count", "3"), "count = 3 is for models of parts"),
        (("paper", "--model", "fme"), "model = 'fme' is not known: did you mean 'fem'?"),
        (("paper", "--to", "x.tex", "--count", "3"), "count = 3: tables are those of the scene's own run"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_refused_in_a_sentence(refused, words, said):
    assert said in refused(*words)


def test_a_folder_that_takes_nothing_is_named(refused, tmp_path):
    if os.geteuid() == 0:
        assert "'/sys'" in refused("paper", "--to", "/sys/x.vtu")
        return
    (tmp_path / "closed").mkdir(mode=0o500)
    assert status_of(["export", "paper", "--to", str(tmp_path / "closed" / "x.vtu")]) == 2


def test_what_is_no_ordinary_file_is_not_replaced(tmp_path, capsys):
    pipe = tmp_path / "m.csv"
    os.mkfifo(pipe)
    assert status_of(["export", "paper", "--modes", "2", "--to", str(pipe)]) == 2
    assert "is there and is no ordinary file: name another" in capsys.readouterr().err
    assert pipe.is_fifo()
    assert os.listdir(tmp_path) == ["m.csv"]


@pytest.mark.parametrize("to", ["m.vtu", "m.pvd", "m.xdmf"])
def test_a_run_that_is_broken_off_leaves_the_old_file_and_no_part_of_a_new_one(export, tmp_path, monkeypatch, to):
    path = export("paper", "--modes", "3", "--count", "9", to=to)
    before = {one: one.read_bytes() for one in tmp_path.rglob("*") if one.is_file()}

    def broken(*given, **more):
        raise KeyboardInterrupt

    monkeypatch.setattr(meshes.meshio.vtu, "write", broken)
    monkeypatch.setattr(meshes.meshio.xdmf.TimeSeriesWriter, "write_data", broken)
    assert status_of(["export", "paper", "--modes", "2", "--to", str(path)]) == 130
    assert {one: one.read_bytes() for one in tmp_path.rglob("*") if one.is_file()} == before


def test_a_shorter_series_takes_the_place_of_a_longer_one_and_of_nothing_else(export, tmp_path):
    export("paper", "--modes", "4", to="m.pvd")
    export("paper", "--modes", "2", to="m.pvd")
    assert sorted(one.name for one in (tmp_path / "m-steps").iterdir()) == ["m_0.vtu", "m_1.vtu"]
    (tmp_path / "m-steps" / "mine.txt").write_text("kept")
    sheet = modes_sheet(load_scene("paper"), Wanted(modes=2, count=9))
    with pytest.raises(InputError, match="holds other things than"):
        meshes.write_pvd(sheet, tmp_path / "m.pvd")
    assert (tmp_path / "m-steps" / "mine.txt").read_text() == "kept"


@pytest.mark.parametrize("modes", [1_200, 100_000_000])
def test_more_exact_modes_than_are_waited_for_are_refused_with_a_time(refused, modes):
    said = refused("paper", "--what", "modes", "--model", "analytic", "--modes", str(modes))
    assert f"modes = {modes} would take about" in said
    assert "export fewer" in said
