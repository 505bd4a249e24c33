"""Layouts of lists, Python models, meshes, and the command."""

import json

import meshio
import numpy as np
import pytest
from reference.universal_files import write_universal
from shared_lists import CANTILEVER, DATA, exudyn, table

from verify.cli import status_of
from verify.compare.compare import Options
from verify.compare.reading import read_frequencies, read_shapes, read_words, solve_model
from verify.compare.shapes import compare_shapes, read_mesh
from verify.errors import InputError

SOLVER = "1 {0} 3341.453 57.80530 9.2 {1}\n2 {0} 53754.19 231.8495 36.9 {1}\n3 {0} 270657.7 520.2477 82.8 {1}\n"
LAYOUTS = {
    "decimal commas": ("9,2\n36,9\n82,8\n", "Hz", None),
    "semicolons": ("mode;f/Hz\n1;9,2\n2;36,9\n5;82,8\n", "Hz", (1, 2, 5)),
    "header in rad/s": ("mode\tomega [rad/s]\n1\t57.8053\n2\t231.8495\n3\t520.2477\n", "rad/s", (1, 2, 3)),
    "named column": ("mode,damping,freq_hz\n1,0.01,9.2\n2,0.02,36.9\n3,0.01,82.8\n", "Hz", (1, 2, 3)),
    "Fortran": ("f [kHz]\n9.2D-3\n3.69D-2\n8.28D-2\n", "kHz", None),
    "Python list": ("[np.float64(9.2), 36.9, 82.8]", "Hz", None),
    "names and units": ("f1 = 9.2Hz\nf2 = 36.9Hz\nf3 = 82.8Hz\n", "Hz", None),
    "eigenvalues": ("mode;eigenvalue\n1;3341.453\n2;53754.19\n3;270657.7\n", "rad2/s2", (1, 2, 3)),
    "periods": ("n period\n1 0.108695652\n2 0.0271002710\n3 0.0120772947\n", "s", (1, 2, 3)),
    "CalculiX": (
        "1 0.0 0.0 0.0\n2 0.1 0.0 0.0\n MODE NO    EIGENVALUE   FREQUENCY\n"
        + SOLVER.format("", "0.0")
        + "\n 1 0.1 0.2 0.3 0.4\n",
        "Hz",
        None,
    ),
    "Nastran": ("R E A L   E I G E N V A L U E S\n" + SOLVER.format("1", "1.0 3341.453"), "Hz", None),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_layout_is_read(tmp_path, name):
    text, unit, numbers = LAYOUTS[name]
    (tmp_path / "list.txt").write_text(text, encoding="utf-8")
    given = read_frequencies(tmp_path / "list.txt")
    assert given.hertz == pytest.approx([9.2, 36.9, 82.8], rel=1e-5)
    assert (given.unit, given.numbers) == (unit, numbers)


def test_rigid_motions_of_a_solver_have_eigenvalues_of_any_sign_and_size(tmp_path):
    (tmp_path / "list.dat").write_text(
        "1 -0.371D-02 0.0 0.0 0.06\n2 0.2D-02 0.04472136 0.00711763\n3 40.0 6.324555 1.006584"
    )
    assert read_frequencies(tmp_path / "list.dat").hertz == pytest.approx([0.0, 0.00711763, 1.006584])


@pytest.mark.parametrize("words", [("27,57 172,56",), ("27,57", "172,56"), ("27.57,172.56",), ("[27.57, 172.56]",)])
def test_typed_lists_with_commas(words):
    assert read_words(words).values == pytest.approx([27.57, 172.56])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "0 rows of numbers"),
        ("9.2\n36.9 a b\n82.8\n", "row 2 has other columns"),
        ("9.2\nabc\n", "row 2: 'abc' is not a number"),
        ("9.2 1.5\n36.9 2.5\n", "2 columns that may be frequencies"),
        ("mode;hz\n2;9.2\n1;36.9\n", "do not count upwards"),
    ],
)
def test_bad_list_is_one_sentence(tmp_path, text, message):
    (tmp_path / "list.txt").write_text(text)
    with pytest.raises(InputError, match=message):
        read_frequencies(tmp_path / "list.txt")


@pytest.mark.parametrize(
    ("text", "message"), [("0.2;1\n0.1;2\n0.3;1\n", "ascending x"), ("0.1;0\n0.2;0\n0.3;0\n", "zero or not finite")]
)
def test_bad_shapes_are_one_sentence(tmp_path, text, message):
    (tmp_path / "shapes.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        read_shapes(tmp_path / "shapes.csv", 0.3)


MODEL = """
from verify.segment_model import SegmentModel as Model

def function(beam, n_modes, count):
    return Model(beam, count, wall="third-order").modes(n_modes).frequencies_hz

def broken(beam, n_modes, count):
    raise ZeroDivisionError("no stiffness")
"""


def test_python_models(tmp_path, monkeypatch):
    (tmp_path / "user_models.py").write_text(MODEL)
    monkeypatch.chdir(tmp_path)
    for name in ("function", "Model"):
        given = solve_model(f"user_models:{name}", CANTILEVER, 25, 6)
        assert (len(given.hertz), given.hertz[0]) == (6, pytest.approx(27.58, rel=5e-3))
    for name, message in {"user_models:broken": "no stiffness", "absent:f": "ModuleNotFoundError"}.items():
        with pytest.raises(InputError, match=message):
            solve_model(name, CANTILEVER, 25, 6)


def solid(path, scale=1000.0):
    """Write the Exudyn shapes on a hexahedral mesh of the strip in millimetres and return the path."""
    _, x, shapes = exudyn()
    x = np.concatenate([[0.0], x, [0.3]])
    ends = 2.0 * shapes[:, -1:] - shapes[:, -2:-1]
    shapes = np.concatenate([0.0 * ends, shapes, ends], axis=1)
    corners = ((0.0, 0.0), (0.025, 0.0), (0.025, 0.003), (0.0, 0.003))
    points = np.array([[place, *corner] for place in x for corner in corners])
    cells = [list(range(4 * i, 4 * i + 8)) for i in range(len(x) - 1)]
    data = {f"mode_{i}": np.outer(np.repeat(shape, 4), [0.0, 0.0, 1.0]) for i, shape in enumerate(shapes, start=1)}
    data["sideways"] = np.outer(np.repeat(shapes[0], 4), [0.0, 1.0, 0.0])
    meshio.Mesh(points * scale, [("hexahedron", cells)], point_data=data).write(path)
    return path


class TestMesh:
    """Shapes on meshes."""

    scene = type("Scene", (), {"name": "beam", "beam": CANTILEVER})

    def test_shapes_on_a_solid_are_paired(self, tmp_path):
        mesh = read_mesh(solid(tmp_path / "modes.vtu"), 0.3)
        assert "in mm, 32 cross-sections along x" in mesh.notes[0]
        assert "sideways does not bend the beam across its thickness" in mesh.notes[1]
        result = compare_shapes(self.scene, mesh)
        assert [row["mode"] for row in table(result, "Shapes")] == list(range(1, 9))
        assert min(row["MAC"] for row in table(result, "Shapes")) > 0.99
        assert result.data["passed"]
        assert table(result, "Models by shape error")[0]["model"] == "segments, raw joints"

    @pytest.mark.parametrize("kind", [55, 58])
    def test_measured_modes_at_sensors(self, tmp_path, kind):
        pytest.importorskip("pyuff")
        hertz, x, shapes = exudyn()
        write_universal(tmp_path / "modes.uff", kind, hertz[:3], x[2:-1:2], shapes[:3, 2:-1:2])
        mesh = read_mesh(tmp_path / "modes.uff", 0.3)
        assert mesh.frequencies.hertz == pytest.approx(hertz[:3], rel=3e-3)
        result = compare_shapes(self.scene, mesh, Options(count=30))
        assert [row["mode"] for row in table(result, "Shapes")] == [1, 2, 3]
        assert result.data["passed"]

    def test_bad_meshes_are_one_sentence(self, tmp_path):
        (tmp_path / "text.vtu").write_text("no mesh")
        wrong = {tmp_path / "text.vtu": "is no mesh", tmp_path / "absent.vtu": "does not exist"}
        wrong[solid(tmp_path / "long.vtu", scale=1.7)] = "set beam.length"
        for path, message in wrong.items():
            with pytest.raises(InputError, match=message):
                read_mesh(path, 0.3)


class TestCommand:
    """`verify compare` on the recorded Exudyn list."""

    def run(self, capsys, *words):
        status = status_of(["compare", "steel-cantilever", *map(str, words)])
        return status, *capsys.readouterr()

    @pytest.mark.parametrize(("within", "status"), [("1%", 0), ("0.005", 1)])
    def test_accuracy_decides_the_exit_status(self, capsys, within, status):
        words = (DATA / "exudyn-cantilever.csv", "--count", 30, "--within", within, "--json")
        code, out, err = self.run(capsys, *words)
        assert (code, json.loads(out)["passed"], err) == (status, status == 0, "")

    @pytest.mark.parametrize(
        ("words", "message"),
        [
            ((), "Give either FILE or FREQUENCIES, or --model."),
            (("27.6", "absent.csv"), "give one file, or numbers alone"),
            (("27.6", "--within", "x"), "give a relative error"),
        ],
    )
    def test_bad_input_is_status_2(self, capsys, words, message):
        status, out, err = self.run(capsys, *words)
        assert (status, out) == (2, "")
        assert message in err
