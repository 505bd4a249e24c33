"""Mode shapes on other people's meshes told what they are."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest

from verify import load_scene
from verify.cli import status_of
from verify.exact.modes import exact_frequency_hz, mode_shape, mode_shapes

CANTILEVER = load_scene("steel-cantilever").beam


@pytest.fixture
def judged(tmp_path, monkeypatch, capsys):
    """(exit status, what is said as plain data or as a sentence) of a mesh."""
    monkeypatch.chdir(tmp_path)

    def call(mesh, *words, scene="steel-cantilever"):
        if isinstance(mesh, meshio.Mesh):
            mesh.write("given.vtu")
            mesh = "given.vtu"
        capsys.readouterr()
        status = status_of(["compare-shapes", mesh, "--scene", scene, "--json", *words])
        out, err = capsys.readouterr()
        return status, json.loads(out) if out else err

    return call


def solid(n=4, unit=1.0, swapped=False, flipped=False):
    """A solid mesh of the cantilever, thin along z, whose sections stay plane: u = -z w', w; and other motions."""
    beam = CANTILEVER
    x, y, z = np.meshgrid(
        np.linspace(0.0, beam.length, 38),
        np.linspace(-0.5, 0.5, 4) * beam.width,
        np.linspace(-0.5, 0.5, 3) * beam.thickness,
        indexing="ij",
    )
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    place = np.arange(x.size).reshape(x.shape)
    corners = [place[i : i + 37, j : j + 3, k : k + 2] for i, j, k in
               ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]  # fmt: skip
    bent = []
    for mode in range(1, n + 1):
        w, turn = (mode_shape(beam, mode, points[:, 0], d) for d in (0, 1))
        bent.append(-3.7 * np.stack([-points[:, 2] * turn, 0.0 * w, w], axis=1))
    wide = np.stack([0.0 * x.ravel(), mode_shapes(beam, 1, points[:, 0])[0], 0.0 * x.ravel()], axis=1)
    twist = np.sin(points[:, 0])[:, None] * np.stack([0.0 * x.ravel(), -points[:, 2], points[:, 1]], axis=1)
    shapes = [bent[0], wide, *bent[1:], twist]
    if swapped:
        shapes[2], shapes[3] = shapes[3], shapes[2]
    placed = points * [-1.0, 1.0, 1.0] if flipped else points
    data = {f"EigVec_{i}": shape.astype(np.float32) for i, shape in enumerate(shapes, start=1)}
    cells = np.stack([one.ravel() for one in corners], axis=1)
    return meshio.Mesh(unit * placed, [("hexahedron", cells)], point_data=data)


def test_our_own_export_of_49_segments_is_judged_as_49_segments(judged):
    assert status_of(["export", "paper", "--modes", "12", "--to", "m.vtu"]) == 0
    status, found = judged("m.vtu", scene="paper")
    assert status == 0
    assert [row["mode"] for row in found["shapes"]] == list(range(1, 13))
    best, second = found["nearest"][:2]
    assert (best["words"], best["count"]) == ("segments, joints corrected", 49)
    assert best["error"] < 1e-12
    assert second["error"] > 1e-4
    assert found["sizes_compared"]  # at the joints of a pinned beam all models have one form
    listed = found["frequencies"]["best"]
    assert (listed["model"], listed["mass"], listed["count"]) == ("segment", "links", 49)
    assert found["shapes"][11]["frequency_error"] == pytest.approx(-2.7937e-4, abs=5e-8)
    assert found["shapes"][11]["error"] < 1e-12


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--model", "segment", "--reading", "raw"), "segments, raw joints"),
        (("--model", "segment"), "segments, joints corrected"),
        (("--model", "fem"), "elements"),
    ],
)
@pytest.mark.parametrize("suffix", ["vtu", "xdmf"])
def test_each_model_s_own_shapes_are_known_again(judged, words, expected, suffix):
    to = f"m.{suffix}"
    assert status_of(["export", "steel-cantilever", "--what", "modes", "--count", "30", *words, "--to", to]) == 0
    status, found = judged(to, "--count", "30")
    assert status == 0
    assert found["nearest"][0]["words"] == expected
    assert found["nearest"][0]["error"] < 1e-10
    assert found["nearest"][1]["error"] > 1e-4
    assert found["frequencies"]["best"]["count"] == 30


@pytest.mark.parametrize(("unit", "name"), [(1.0, "metres"), (1e3, "millimetres"), (1.0 / 0.0254, "inches")])
def test_a_solid_mesh_is_averaged_over_its_cross_sections_and_other_motions_are_left_out(judged, unit, name):
    status, found = judged(solid(unit=unit))
    assert status == 0
    assert [(row["name"], row["mode"]) for row in found["shapes"]] == [
        ("EigVec_1", 1), ("EigVec_3", 2), ("EigVec_4", 3), ("EigVec_5", 4),
    ]  # fmt: skip
    assert max(row["error"] for row in found["shapes"]) < 1e-6  # single precision
    assert found["notes"][0].startswith(f"456 points (hexahedron) in {name} along x, averaged over 38 cross-sections")
    assert "deflection along z" in found["notes"][0]
    assert found["notes"][1:] == [
        "EigVec_2 bends it across its width, left out",
        "EigVec_6 leaves its middle line where it was, left out",
        "no frequencies: no field data named after Hz or rad/s were read (meshio writes none, to a .vtu or a .vtk)",
    ]
    assert found["nearest"][0]["words"] == "the exact beam"


def test_a_mesh_the_other_way_round_is_turned(judged):
    status, found = judged(solid(flipped=True))
    assert status == 0
    assert "x runs from right to left: the shapes are taken the other way round" in found["notes"]
    assert [row["mode"] for row in found["shapes"]] == [1, 2, 3, 4]


def test_shapes_in_another_order_than_the_modes_fail(judged):
    status, found = judged(solid(swapped=True))
    assert status == 1
    assert found["exchanged"]
    assert "they are modes 1 (EigVec_1), 2 (EigVec_4), 3 (EigVec_3), 4 (EigVec_5)" in found["gates"][0]["reason"]


def line(shapes, length=CANTILEVER.length, **beside):
    """A line along y with numbers at its points."""
    n = len(shapes[0])
    points = np.zeros((n, 3))
    points[:, 1] = np.linspace(0.2, 0.2 + length, n)
    cells = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    data = {f"shape {i}": np.asarray(shape) for i, shape in enumerate(shapes, start=1)}
    return meshio.Mesh(points, [("line", cells)], point_data=data)


def test_numbers_along_any_axis_are_shapes_and_an_odd_one_is_like_no_mode(judged):
    x = np.linspace(0.0, CANTILEVER.length, 41)
    shapes = [*mode_shapes(CANTILEVER, 3, x), np.cos(40.0 * np.pi * x / CANTILEVER.length) + 0.1 * x]
    status, found = judged(line(shapes))
    assert status == 1
    assert [one["name"] for one in found["unlike"]] == ["shape 4"]
    assert "along y" in found["notes"][0]


def test_the_error_free_of_scale_is_that_of_a_known_mixture(judged):
    x = np.linspace(0.0, CANTILEVER.length, 401)
    first, second = mode_shapes(CANTILEVER, 2, x)
    _, found = judged(line([first + 0.03 * second]))
    row = found["shapes"][0]
    assert row["mode"] == 1
    assert row["error"] == pytest.approx(0.03 / np.sqrt(1.0 + 0.03**2), rel=2e-3)  # orthogonal, trapezoidal weights
    assert row["likeness"] == pytest.approx(1.0 - row["error"] ** 2, abs=1e-12)


def test_frequencies_beside_are_gated(judged):
    assert status_of(["export", "steel-cantilever", "--what", "modes", "--count", "12", "--to", "m.vtu"]) == 0
    status, found = judged("m.vtu", "--within", "0.1%", "--count", "12")
    assert status == 1
    (gate,) = [gate for gate in found["gates"] if not gate["passed"]]
    assert gate["id"] == "within"
    off = found["shapes"][4]
    assert off["frequency_error"] == pytest.approx(off["frequency_hz"] / exact_frequency_hz(CANTILEVER, 5) - 1.0)


def test_a_mode_given_twice_is_said_to_be_that_mode(judged):
    x = np.linspace(0.0, CANTILEVER.length, 31)
    first, second, third = mode_shapes(CANTILEVER, 3, x)
    status, found = judged(line([first, second, -0.7 * second, third]))
    assert status == 1
    assert found["unlike"] == [{"name": "shape 3", "best_mac": pytest.approx(1.0, abs=1e-12), "again": 2}]
    assert found["gates"][0]["reason"] == "shape 3 is like mode 2, which another shape is already (MAC 1.00)"


@pytest.mark.parametrize("size", [0.6, 1.3])
def test_sizes_of_another_normalisation_do_not_outweigh_an_exact_form(judged, size):
    """Largest values of one, for instance, of a beam that weighs a few kilograms."""
    x = np.linspace(0.0, CANTILEVER.length, 31)
    _, found = judged(line(size * mode_shapes(CANTILEVER, 5, x)))
    assert not found["sizes_compared"]
    assert found["nearest"][0]["words"] == "the exact beam"
    assert "In form nearest: the exact beam, which leaves rounding" in found["answer"]
    assert any(note.startswith("sizes lie about those of mass-normalised shapes") for note in found["notes"])


STRIP = load_scene("paper").beam


@pytest.mark.parametrize(
    ("modes", "places", "said"),
    [
        ((1, 2, 3, 4), 6, "6 places do not tell mode 3 from 7, nor mode 4 from 6: give more"),
        ((1, 2, 3), 5, "5 places do not tell mode 2 from 6, nor mode 3 from 5: give more"),
        ((1, 2, 3, 4), 31, ""),
    ],
)
def test_modes_that_few_places_confuse_stand_in_order_and_are_named(judged, modes, places, said):
    """sin(n pi x/L) and sin((2N - n) pi x/L) differ by their sign alone at N + 1 even places."""
    x = np.linspace(0.0, STRIP.length, places)
    mesh = line([(3.0 - n / 4) * np.sin(n * np.pi * x / STRIP.length) for n in modes], STRIP.length)
    status, found = judged(mesh, scene="paper")
    assert status == 0
    assert not found["exchanged"]
    assert said in found["answer"]
    assert bool(said) == ("do not tell" in found["answer"])


def test_frequencies_beside_each_other_s_shapes_are_said_to_fall(judged):
    assert status_of(["export", "paper", "--what", "modes", "--count", "12", "--modes", "3", "--to", "m.vtu"]) == 0
    second, third = map(repr, meshio.read("m.vtu").field_data["frequency_hz"][1:3].tolist())
    text = Path("m.vtu").read_text(encoding="utf-8")
    Path("m.vtu").write_text(text.replace(f"{second} {third}", f"{third} {second}"), encoding="utf-8")
    status, found = judged("m.vtu", "--count", "12", scene="paper")
    assert status == 1
    assert [gate["passed"] for gate in found["gates"] if gate["id"] == "identified"] == [False]
    assert found["notes"][-1].startswith("frequencies fall from mode 2 (83.0934 Hz) to mode 3 (36.9396 Hz): they stand")
    assert "missing" not in found["answer"]
    assert "none of the beam's bending modes" not in found["answer"]


GOOD = np.sin(np.linspace(0.0, 1.3, 9)) ** 2


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: "missing.vtu", "does not exist"),
        (lambda: line([np.where(np.arange(9) == 5, np.nan, GOOD)]), "'shape 1' is [nan] at point 5: give finite"),
        (lambda: line([GOOD], length=0.31), "is 0.31 long and the scene's beam 0.3 m: give --set beam.length"),
        (lambda: line([0.0 * GOOD]), "has no shape that bends the beam"),
        (lambda: line([np.linspace(0.0, 1.0, 9)]), "has straight lines alone"),
        (lambda: line([GOOD[:2]]), "has 2 points"),
        (lambda: meshio.Mesh(line([GOOD]).points, line([GOOD]).cells), "has no vectors or numbers at its points"),
        (lambda: meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])], point_data={"a": np.ones(3)}), "is 1 long and 1"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_beam_is_refused_in_a_sentence(judged, make, said):
    status, sentence = judged(make())
    assert status == 2
    assert said in sentence
    assert len(sentence.splitlines()) == 1


@pytest.mark.parametrize("name", ["junk.vtu", "junk.bdf", "junk.xdmf", "junk.msh", "junk.npy"])
def test_junk_is_refused_in_a_sentence_and_nothing_of_meshio_is_printed(judged, tmp_path, name):
    (tmp_path / name).write_bytes(b"<VTKFile type='x'>" + bytes(range(256)))
    status, sentence = judged(name)
    assert status == 2
    assert "is no mesh that meshio reads" in sentence
    assert len(sentence.splitlines()) == 1


def test_within_without_frequencies_is_refused(judged):
    status, sentence = judged(solid(), "--within", "1%")
    assert status == 2
    assert "within = 0.01 is for frequencies" in sentence
