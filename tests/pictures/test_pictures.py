"""Pictures: what is drawn is what the models say, and every file is whole."""

import os
import re
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from verify import analytic_modes, load_scene, segment_model
from verify.cli import status_of
from verify.pictures import drawn as scenes_drawn
from verify.pictures import film, make, solid
from verify.pictures.drawn import picture_of
from verify.pictures.picture import Solid, arrow, strip
from verify.pictures.rows import AMPLITUDE, Asked
from verify.pictures.view import STILL, view_of
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

NO_PYVISTA = "pyvista is missing: pip install 'fem-segment-verify[viz]'"


def drawn(scene, what, **asked):
    return picture_of(load_scene(scene), Asked(what=what, **asked))


def links_of(picture):
    """Corners of links, the first of what is coloured."""
    return next(one for one in picture.solids if one.values is not None and one.edges)


def middles(links):
    """Where links begin and end, (f, m, 2, 2), their middle line."""
    a, b, c, d = (links.outlines[:, :, i] for i in range(4))
    return np.stack([0.5 * (a + d), 0.5 * (b + c)], axis=2)


def factor_in(picture):
    """By how much deflections are said to be enlarged."""
    return float(re.search(r"Deflection drawn ([\d,.]+) times", picture.said[0])[1].replace(",", ""))


def test_links_are_straight_between_the_joints_of_the_chain():
    picture = drawn("steel-cantilever", "modes", mode=2, count=12)
    found = middles(links_of(picture))[0]
    modes = segment_model.solve_modes(load_scene("steel-cantilever").beam, 2, 12)
    joints = modes.readings["raw"]()[1] / abs(modes.readings["raw"]()[1]).max()
    slopes = np.diff(joints) * 12.0
    drawn_slopes = (found[:, 1, 1] - found[:, 0, 1]) / (found[:, 1, 0] - found[:, 0, 0])
    assert drawn_slopes / AMPLITUDE == pytest.approx(slopes, rel=1e-9, abs=1e-9)
    assert len(found) == 12


def test_a_wave_is_drawn_as_large_as_its_words_say():
    picture = drawn("paper-wave", "wave", count=49, moving=True)
    found = middles(links_of(picture))[:, :, 0, 1]
    scene = load_scene("paper-wave")
    field = segment_model.solve_harmonic(scene.beam, scene.forces, 4276.0, 49, reading="raw")
    largest = abs(field.deflection(np.linspace(0.0, 0.5, 50))).max()
    assert np.ptp(found) / 2.0 == pytest.approx(factor_in(picture) * largest / scene.beam.length, rel=0.06)
    assert found[:18] + found[18:] == pytest.approx(2.0 * found.mean(), abs=1e-9)  # half a period apart


def test_what_is_said_to_be_the_largest_is_the_beams_own_over_the_period():
    """Forces that leave three tenths of it at 0 degrees: a still shows the instant that has all of it, and says which."""
    size = {"length": 0.0042, "width": 0.00031, "thickness": 0.000052}
    beam = {**size, "youngs_modulus": 169e9, "density": 2330.0, "supports": ["clamped", "clamped"]}
    forces = [(0.0011, 1e-5, 20.0), (0.0033, 2e-5, -65.0)]
    drive = [dict(zip(("position", "amplitude", "phase_deg"), one, strict=True)) for one in forces]
    data = {"name": "small", "beam": beam, "drive": {"frequency_hz": 62000.0, "force": drive}}
    scene = checked(data, scene_type())
    field = analytic_modes.solve_harmonic(scene.beam, scene.forces, 62000.0).deflection(np.linspace(0.0, 0.0042, 211))
    still, film = (picture_of(scene, Asked(what="wave", moving=moving)) for moving in (False, True))
    for one in (still, film):
        told = re.search(r"the largest over the period is ([\d.]+) nm", one.said[0])
        assert 1e-9 * float(told[1]) == pytest.approx(abs(field).max(), rel=2e-3)
        assert one.scale[2] == f"+{told[1]} nm"
    degrees = float(re.fullmatch(r"(\d+)° of the period", still.notes[0])[1])
    at_it, at_first = (abs(np.real(field * np.exp(1j * np.deg2rad(one)))).max() for one in (degrees, 0.0))
    assert at_it == pytest.approx(abs(field).max(), rel=1e-3)
    assert 0.25 < at_first / at_it < 0.31


def test_joints_far_outside_their_beam_stay_below_its_words():
    """At the cut-off, where they move about twice as far as what they stand for."""
    picture = drawn("paper-wave", "wave", count=26, moving=True)
    links, words = middles(links_of(picture))[..., 1], picture.labels[0].y
    assert np.ptp(links) / 2.0 > 1.8 * factor_in(picture) * 3.31e-6 / 0.5
    assert 0.02 < words - links.max() < 0.05


def test_a_wave_travels_and_a_mode_does_not():
    """Crests of a wave come by everywhere; a mode keeps its nodes."""
    wave = middles(links_of(drawn("paper-wave", "wave", moving=True)))[:, 5:-5, 0, 1]
    mode = middles(links_of(drawn("paper", "modes", mode=22, moving=True)))[:, 5:-5, 0, 1]
    least, still = (np.ptp(one, axis=0).min() / np.ptp(one, axis=0).max() for one in (wave, mode))
    assert least > 0.5
    assert still < 0.1


def test_colours_follow_the_deflection():
    links = links_of(drawn("paper-wave", "wave"))
    y = middles(links)[0, :, 0, 1]
    assert np.corrcoef(y, links.values[0, :, 0])[0, 1] > 0.99
    assert abs(links.values).max() <= 1.0


def test_the_slider_stands_on_its_beam_and_friction_points_along_it():
    picture = drawn("paper-slider", "slider", count=49, moving=True)
    block = next(one for one in picture.solids if one.edges and one.values is None)
    foot = block.outlines[:, 0, :2].mean(axis=1)
    assert foot[:, 0] == pytest.approx(0.5, abs=0.01)  # nanometres are no travel to be seen
    edge = block.outlines[:, 0, 1] - block.outlines[:, 0, 0]
    shafts = [one for one in picture.solids if one.colour == "#d6427a" and one.outlines.shape[2] == 4]
    along = shafts[0].outlines[:, 0, 1] - shafts[0].outlines[:, 0, 0]
    turned = along[:, 0] * edge[:, 1] - along[:, 1] * edge[:, 0]
    assert abs(turned).max() < 1e-12
    assert "the largest of 72 instants is 2.97 µm); the longest arrow of them is 2 mN" in picture.said[0]
    assert picture.notes[-1] == "1.000 ms; travelled on segments -1.38 nm, on elements -0.65 nm"


def test_a_chain_rolled_up_is_a_polygon_about_the_exact_circle_at_true_scale():
    picture = drawn("chain", "chain", count=20)
    corners = middles([one for one in picture.solids if one.edges][-1])  # of the chain that is closed
    sizes = np.linalg.norm(corners[0, :, 1] - corners[0, :, 0], axis=1) / 0.84  # but for the gaps at the pins
    assert sizes == pytest.approx(0.05, rel=1e-9)
    centre = corners[0].reshape(-1, 2).mean(axis=0)
    assert centre == pytest.approx([0.0, 0.5 / np.pi], abs=0.03)
    assert "meet but for rounding" in picture.said[0]
    arc = picture.traces[-1].points[0]
    assert np.linalg.norm(arc - [0.0, 0.5 / np.pi], axis=1) == pytest.approx(0.5 / np.pi, rel=1e-9)


STEPS = {"length": 0.62, "width": 0.024, "thickness": 0.004, "youngs_modulus": 205e9, "density": 7850.0}
STEPS |= {"section": [{"length": 0.21}, {"length": 0.17, "thickness": 0.03}, {"length": 0.24, "width": 0.018}]}


def scene_of(beam):
    return checked({"name": "drawn", "title": "Drawn", "beam": beam}, scene_type())


def stepped(count, **beam):
    """A beam of three sections: the middle one 7.5 times as thick, the last one narrower."""
    return picture_of(scene_of(beam=STEPS | beam), Asked(what="modes", mode=1, count=count))


def coloured(picture, *, links):
    """Outlines (m, 4, 2) of the chain or of the bar, where in three sections they lie, and half of what they are wide."""
    solids = [one for one in picture.solids if one.values is not None and one.edges is links]
    outlines = np.concatenate([one.outlines[0] for one in solids])
    depths = np.concatenate([np.full(one.outlines.shape[1], one.depth) for one in solids])
    middle = outlines[:, :, 0].mean(axis=1)
    return outlines, np.searchsorted([0.21 / 0.62, 0.38 / 0.62], middle), depths


def thicknesses(outlines):
    """Across the middle line of each outline (m, 4, 2), over the length."""
    along = 0.5 * (outlines[:, 1] + outlines[:, 2] - outlines[:, 0] - outlines[:, 3])
    across = 0.5 * (outlines[:, 2] + outlines[:, 3] - outlines[:, 0] - outlines[:, 1])
    return abs(along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]) / np.linalg.norm(along, axis=1)


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize(("count", "middle"), [(40, 0.03), (7, 0.03), (40, 0.0061)])
def test_a_stepped_beam_is_drawn_as_thick_as_its_words_say_everywhere(links, count, middle):
    sections = [dict(one) for one in STEPS["section"]]
    sections[1]["thickness"] = middle
    picture = stepped(count, section=sections)
    factor = float(re.search(r"thickness drawn ([\d.]+) times", picture.said[0])[1])
    outlines, section, _ = coloured(picture, links=links)
    own = np.array([0.004, middle, 0.004])[section] / 0.62
    assert set(section) == {0, 1, 2}
    assert thicknesses(outlines) == pytest.approx(factor * own, rel=0.01)


def test_a_stepped_beam_is_drawn_as_wide_as_it_is():
    _, section, depths = coloured(stepped(40), links=True)
    assert depths == pytest.approx(0.5 * np.array([0.024, 0.024, 0.018])[section] / 0.62, rel=1e-9)
    assert "width" not in stepped(40).said[0]


def test_a_round_section_is_drawn_as_wide_as_it_is_thick():
    beam = {"length": 0.4, "shape": "round", "diameter": 0.022, "youngs_modulus": 205e9, "density": 7850.0}
    picture = picture_of(scene_of(beam=beam), Asked(what="modes", mode=1, count=9))
    assert links_of(picture).depth == pytest.approx(0.011 / 0.4, rel=1e-9)
    assert picture.said[0].endswith("thickness as it is.")


def test_a_section_without_sizes_is_said_to_be_a_strip():
    plain = {"length": 0.5, "bending_stiffness": 5.0, "mass_per_length": 0.2}
    sections = [
        {"length": 0.2},
        {"length": 0.3, "width": 0.03, "thickness": 0.011, "youngs_modulus": 2e9, "density": 950.0},
    ]
    picture = picture_of(scene_of(beam=plain | {"section": sections}), Asked(what="modes", mode=1, count=10))
    assert picture.said[0].endswith("; thickness as it is, of a section without sizes as a strip.")


@pytest.mark.parametrize(
    ("held", "said"),
    [
        ({"foundation": 700.0}, "as a strip; the ground below is not drawn."),
        ({"tension": 90.0}, "as a strip; the axial force is not drawn."),
        ({"foundation": 700.0, "tension": 90.0}, "as a strip; the ground below and the axial force are not drawn."),
        ({}, "as a strip."),
    ],
)
def test_what_holds_a_beam_and_is_not_drawn_is_said(held, said):
    plain = {"length": 0.5, "bending_stiffness": 5.0, "mass_per_length": 0.2, "supports": ["free", "free"]}
    picture = picture_of(scene_of(beam=plain | held), Asked(what="modes", mode=3, count=10))
    assert picture.said[0].endswith(said)


def test_thick_beams_stand_clear_of_each_other_and_of_words():
    picture = stepped(40, thickness=0.2, section=[])
    lower, upper = (coloured(picture, links=links)[0][..., 1] for links in (False, True))
    assert lower.max() < upper.min()
    words = [label.y for label in picture.labels]
    assert words[0] > upper.max()
    assert lower.max() < words[1] < upper.max()
    assert picture.box[2] <= lower.min() + 1e-9


def test_a_strip_has_no_gap_where_it_bends():
    x = np.linspace(0.0, 1.0, 50)
    outlines = strip(np.stack([x, 0.1 * np.sin(9.0 * x)], axis=1)[None], 0.01)[0]
    assert (outlines[1:, 0] == outlines[:-1, 1]).all()
    assert (outlines[1:, 3] == outlines[:-1, 2]).all()


def test_an_arrow_without_size_is_nothing():
    shaft, head = arrow(np.zeros((1, 2)), np.zeros((1, 2)), 0.1)
    assert not shaft.any()
    assert not head.any()


@pytest.mark.parametrize("slanted", [True, False])
def test_everything_lies_within_the_drawing(slanted):
    picture = drawn("paper-wave", "wave", moving=True)
    view = view_of(picture, STILL, slanted=slanted)
    for one in picture.solids:
        for depth in (-one.depth, one.depth):
            pixels = view.pixels(one.outlines, depth)
            assert pixels.min() >= -1.0
            assert (pixels.max(axis=(0, 1, 2)) <= np.array(view.size) + 1.0).all()


@pytest.fixture
def picture(tmp_path, monkeypatch, capsys):
    """(exit status, output, error output) of a line in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(make, "STILL", 640)
    monkeypatch.setattr(make, "MOVING_WIDTH", 320)

    def call(*words):
        capsys.readouterr()
        status = status_of(["picture", *words])
        return (status, *capsys.readouterr())

    return call


def shades(path):
    """Shares of a picture that are red and blue, and those of its edge that are white."""
    with Image.open(path) as opened:
        image = np.asarray(opened.convert("RGB"), dtype=int)
    r, b = image[..., 0], image[..., 2]
    edge = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    return ((r - b) > 60).mean(), ((b - r) > 60).mean(), (edge.min(axis=1) > 250).mean()


def test_a_flat_picture_shows_both_colours_and_keeps_a_margin(picture, tmp_path):
    status, out, err = picture("paper", "--mode", "4", "--count", "17", "--flat", "--to", "p.png")
    assert (status, out, err) == (0, "p.png: 1 frame\n", "")
    red, blue, white = shades(tmp_path / "p.png")
    assert 0.01 < red < 0.2
    assert 0.01 < blue < 0.2
    assert white > 0.99


@pytest.mark.parametrize("suffix", ["gif", "webp"])
def test_a_moving_picture_has_all_frames_and_begins_again(picture, tmp_path, monkeypatch, suffix):
    monkeypatch.setattr(scenes_drawn, "PERIOD", 6)
    assert picture("paper", "--mode", "1", "--count", "5", "--flat", "--to", f"p.{suffix}")[0] == 0
    with Image.open(tmp_path / f"p.{suffix}") as image:
        assert image.n_frames == 6
        assert image.info["loop"] == 0
        image.seek(5)
        image.load()
        assert 6 * image.info["duration"] == pytest.approx(2000.0, rel=0.01)


def test_a_solid_picture_is_drawn_in_a_child(picture, tmp_path):
    pytest.importorskip("pyvista", reason=NO_PYVISTA)
    status, _, err = picture("steel-cantilever", "--mode", "2", "--count", "10", "--to", "p.png")
    assert status == 0
    if err:
        pytest.skip(f"nothing solid is drawn here: {err}")
    red, blue, _ = shades(tmp_path / "p.png")
    assert red > 0.01
    assert blue > 0.005


def test_without_opengl_the_picture_is_flat_and_says_why(picture, tmp_path, monkeypatch):
    """VTK ends the process that finds none: here by asking it for a window of an X server that is not there."""
    pytest.importorskip("pyvista", reason=NO_PYVISTA)
    if not sys.platform.startswith("linux"):
        pytest.skip("windows of X servers are Linux's")
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkXOpenGLRenderWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    status, out, err = picture("paper", "--mode", "1", "--count", "6", "--to", "p.png")
    assert (status, out) == (0, "p.png: 1 frame\n")
    assert re.fullmatch(r"verify: drawn flat: VTK finds no OpenGL .* install OpenGL .* or run under xvfb-run\n", err)
    assert shades(tmp_path / "p.png")[0] > 0.01
    assert os.listdir(tmp_path) == ["p.png"]


def test_without_pyvista_the_picture_is_flat_and_says_what_to_install(picture, tmp_path, monkeypatch):
    monkeypatch.setattr(solid, "find_spec", lambda name: None)
    status, _, err = picture("paper", "--mode", "1", "--count", "6", "--to", "p.png")
    assert status == 0
    assert err == ("verify: drawn flat: pyvista is not installed, pip install 'fem-segment-verify[viz]' draws solids\n")
    assert (tmp_path / "p.png").exists()


def test_a_child_ends_with_whoever_started_it():
    """Its input is closed when its parent is gone, however that ended."""
    pytest.importorskip("pyvista", reason=NO_PYVISTA)
    code = (
        "import pickle, sys, time\nfrom verify.pictures import solid\nfrom verify.pictures.drawn import picture_of\n"
        "from verify.pictures.rows import Asked\nfrom verify.pictures.view import view_of\nfrom verify import load_scene\n"
        "import msgspec, os\np = picture_of(load_scene('paper'), Asked(what='modes', count=5))\n"
        "p = msgspec.structs.replace(p, frames=100000)\n"
        "frames = solid.solid_frames(p, view_of(p, 960, slanted=True))\n"
        "started = solid._started\n"
        "def told(errors):\n    child = started(errors)\n    print(child.pid, flush=True)\n    return child\n"
        "solid._started = told\nnext(frames)\nos._exit(0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    pid = int(done.stdout)
    for _ in range(100):
        if not _alive(pid):
            return
        subprocess.run([sys.executable, "-c", "import time; time.sleep(0.1)"], check=True)
    pytest.fail(f"the child {pid} goes on without its parent")


def _alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as stream:
            return stream.read().split(") ")[1][0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.parametrize("suffix", ["png", "gif", "webp"])
def test_a_drawing_that_is_broken_off_leaves_nothing(picture, tmp_path, monkeypatch, suffix):
    def broken(picture, view):
        yield Image.new("RGB", view.size)
        raise KeyboardInterrupt

    def at_once(picture, view):
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(make, "flat_frames", at_once if suffix == "png" else broken)
    assert picture("paper", "--count", "5", "--flat", "--to", f"p.{suffix}")[0] == 130
    assert os.listdir(tmp_path) == []


def test_an_mp4_is_whole_or_says_what_to_install(picture, tmp_path, monkeypatch):
    monkeypatch.setattr(scenes_drawn, "PERIOD", 4)
    words = ("paper", "--mode", "1", "--count", "5", "--flat", "--to", "p.mp4")
    if film.find_spec("imageio_ffmpeg") is not None:
        assert picture(*words)[0] == 0
        assert (tmp_path / "p.mp4").read_bytes()[4:8] == b"ftyp"
        (tmp_path / "p.mp4").unlink()
    monkeypatch.setattr(film, "find_spec", lambda name: None)
    status, _, err = picture(*words)
    assert status == 2
    assert "pip install imageio-ffmpeg" in err
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("paper", "--mode", "49"), "mode = 49: the segment model at count = 49 has 48 elastic modes"),
        (("paper", "--what", "wave", "--mode", "2"), "mode = 2: wave has no mode"),
        (("paper", "--what", "waves"), "what = 'waves' is not known: did you mean 'wave'?"),
        (("patched-strip", "--what", "wave"), "the scene has no drive with forces"),
        (("paper", "--what", "slider"), "the scene has no [slider]"),
        (("stepped-beam", "--what", "chain"), "the beam has beam.section"),
        (("paper", "--count", "1"), "count = 1: give a whole number of at least 2"),
        (("paper", "--count", "401"), "more than 400 links are too small to be seen"),
        (("paper", "--to", "p.jpg"), "has no suffix of a picture: give one of .png, .gif, .webp, .mp4"),
        (("paper", "--to", "/sys/p.png"), "'/sys' cannot be written to"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused_in_a_sentence(picture, tmp_path, words, said):
    status, out, err = picture(*words)
    assert (status, out) == (2, "")
    assert said in err
    assert len(err.splitlines()) == 1
    assert os.listdir(tmp_path) == []


def test_solids_are_convex():
    """As the ways of drawing take them: every outline turns one way."""
    for scene, what in (("paper-slider", "slider"), ("instrument-arm", "modes"), ("guided-bar", "modes")):
        for one in drawn(scene, what).solids:
            _check_convex(one)


def _check_convex(one: Solid):
    edges = np.roll(one.outlines, -1, axis=2) - one.outlines
    after = np.roll(edges, -1, axis=2)
    turns = edges[..., 0] * after[..., 1] - edges[..., 1] * after[..., 0]
    assert ((turns >= -1e-12).all(axis=2) | (turns <= 1e-12).all(axis=2)).all()
