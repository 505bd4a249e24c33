"""Exported files hold the values of the models, and nothing remains where writing fails."""

import csv
import json
from pathlib import Path

import meshio
import numpy as np
import pytest
from PIL import Image

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.io.export import Request, dataset, write
from verify.scene.load import load_scene

SMALL = Path(__file__).parents[1] / "report" / "small.toml"
MOVING = ("motion.duration=0.004", "motion.count=12")


@pytest.fixture(scope="module")
def scene():
    return load_scene(SMALL)


@pytest.fixture(scope="module")
def moving():
    return load_scene(SMALL, MOVING)


@pytest.fixture(scope="module")
def modes(scene):
    return dataset(scene, "modes", Request(count=12, mode=3))


def test_modes_are_those_of_the_model(scene, modes):
    exact = SolutionCache(scene.beam)
    for mode, hertz in enumerate(modes.steps, 1):
        assert 1e-7 < abs(hertz / exact.exact_hz(mode) - 1.0) < 0.03
    assert modes.x[-1] == 0.37
    assert np.allclose(modes.deflection[:, [0, -1]], 0.0, atol=1e-9 * abs(modes.deflection).max())


def test_wave_turns_once(scene):
    data = dataset(scene, "wave", Request(model="analytic", samples=8))
    w = data.points["real"] + 1j * data.points["imaginary"]
    assert np.allclose(data.deflection[1], (w * np.exp(0.25j * np.pi)).real, rtol=1e-12, atol=1e-18)
    assert data.steps[1] == pytest.approx(1.0 / 8.0 / 613.0, rel=1e-12)


def test_motion_starts_at_rest(moving):
    data = dataset(moving, "motion", Request(samples=9))
    assert data.steps[-1] == pytest.approx(0.004, rel=1e-12)
    assert abs(data.deflection[-1]).max() > 1e-8
    assert abs(data.deflection[0]).max() < 1e-12 * abs(data.deflection[-1]).max()


def test_vtu_round_trip(scene, modes, tmp_path):
    write(scene, tmp_path / "a.vtu", Request(what="modes", count=12, mode=3))
    mesh = meshio.read(tmp_path / "a.vtu")
    assert np.allclose(mesh.points[:, 0], modes.x)
    assert len(mesh.cells_dict["line"]) == 12
    for name, values in modes.points.items():
        assert np.allclose(mesh.point_data[name][:, 1], values, rtol=1e-12)


def test_xdmf_round_trip(moving, tmp_path):
    write(moving, tmp_path / "a.xdmf", Request(samples=7))
    motion = dataset(moving, "motion", Request(samples=7))
    with meshio.xdmf.TimeSeriesReader(tmp_path / "a.xdmf") as reader:
        points, _ = reader.read_points_cells()
        assert np.allclose(points[:, 0], motion.x)
        assert reader.num_steps == 7
        time, data, _ = reader.read_data(6)
    assert time == pytest.approx(0.004)
    assert np.allclose(data["deflection"][:, 1], motion.deflection[6], rtol=1e-6)


@pytest.mark.parametrize("what", ["modes", "wave", "motion"])
def test_arrays_agree_in_json_npz_csv(moving, tmp_path, what):
    request = Request(what=what, count=12, mode=3, samples=6)
    for kind in ("json", "npz", "csv"):
        write(moving, tmp_path / f"a.{kind}", request)
    data = json.loads((tmp_path / "a.json").read_text())
    with np.load(tmp_path / "a.npz") as file:
        arrays = dict(file)
    assert data["what"] == what
    assert np.array_equal(arrays["deflection"], np.array(data["deflection"]))
    head, *rows = csv.reader((tmp_path / "a.csv").read_text().splitlines())
    values = np.array(rows, float)
    if what == "motion":
        assert np.array_equal(values[:, 1:], arrays["deflection"])
        assert head[0] == "time_s"
    else:
        assert np.array_equal(values[:, 0], arrays["x"])
        assert np.array_equal(values[:, 1], np.array(data[head[1]]))


@pytest.mark.parametrize(("kind", "what", "frames"), [("png", "modes", 1), ("gif", "wave", 6), ("webp", "motion", 7)])
def test_pictures_open(moving, tmp_path, kind, what, frames):
    path = tmp_path / f"a.{kind}"
    write(moving, path, Request(what=what, count=12, samples=frames, mode=2))
    with Image.open(path) as image:
        assert image.format == kind.upper()
        assert getattr(image, "n_frames", 1) == frames
        assert len(image.convert("RGB").getcolors(1 << 20)) > 10


def test_the_chart_of_convergence_is_a_picture(scene, tmp_path):
    title = write(scene, tmp_path / "a.svg", Request(what="convergence", mode=2))
    assert title.startswith("Frequency error over N. Mode 2")
    assert "number of segments or elements" in (tmp_path / "a.svg").read_text()


REFUSED = [
    ("a.doc", {}, "no file type"),
    ("a.toml", {}, "give one of .vtu"),
    ("a.vtu", {"what": "motion"}, ".xdmf, .csv"),
    ("a.csv", {"what": "tables"}, "known are modes, wave, motion, convergence"),
    ("a.csv", {"what": "mode"}, "did you mean 'modes'"),
    ("a.csv", {"what": "motion"}, r"\[motion\]"),
    ("a.gif", {"what": "convergence"}, "give one of .png, .svg"),
    ("a.png", {"what": "convergence", "count": 9}, "convergence.counts"),
    ("a.csv", {"model": "analytic", "count": 4}, "leave it out"),
    ("a.csv", {"what": "modes", "count": 12, "mode": 400}, "400"),
    ("a.csv", {"model": "fen"}, "did you mean 'fem'"),
]


@pytest.mark.parametrize(("name", "request_", "message"), REFUSED)
def test_refused_exports_write_nothing(scene, tmp_path, name, request_, message):
    with pytest.raises(InputError, match=message):
        write(scene, tmp_path / name, Request(**request_))
    assert list(tmp_path.iterdir()) == []
