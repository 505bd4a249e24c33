"""Shapes of a beam held otherwise, factors near a unit, sizes near the one that is said: nothing is stated by them."""

import meshio
import numpy as np
import pytest
from msgspec.structs import replace

from verify import segment_model
from verify.beam import Beam
from verify.cli import status_of
from verify.exact.closed_forms import frequency_hz
from verify.exact.modes import mode_shape

SCENE = """
name = "held"
[beam]
length = 0.61
width = 0.03
thickness = 0.004
youngs_modulus = 113e9
density = 4470.0
supports = ["clamped", "free"]
"""
OWN = Beam(length=0.61, width=0.03, thickness=0.004, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free"))
X = np.linspace(0.0, 0.61, 41)


def shapes_of(supports):
    beam = replace(OWN, supports=supports)
    return np.array([mode_shape(beam, mode, X) for mode in range(1, 7)]), [frequency_hz(beam, n) for n in range(1, 7)]


@pytest.fixture
def told(tmp_path, monkeypatch, capsys):
    (tmp_path / "held.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)

    def run(*words):
        status = status_of([*words])
        return status, " ".join(capsys.readouterr().out.split())

    return run


@pytest.mark.parametrize(
    ("supports", "passes"),
    [(("clamped", "free"), True), (("clamped", "clamped"), False), (("pinned", "pinned"), False)],
)
def test_shapes_of_another_beam_do_not_pass_and_say_what_to_check(told, supports, passes):
    values, _ = shapes_of(supports)
    points = np.column_stack([X, np.zeros((41, 2))])
    lines = [("line", np.column_stack([np.arange(40), np.arange(1, 41)]))]
    data = {f"m{i + 1}": np.column_stack([0 * X, one, 0 * X]) for i, one in enumerate(values)}
    meshio.Mesh(points, lines, point_data=data).write("shapes.vtu")
    status, out = told("compare-shapes", "held.toml", "shapes.vtu", "--count", "20")
    assert status == (0 if passes else 1)
    assert ("That is hardly a mode of the beam as the scene holds it: check beam.supports." in out) != passes
    assert ("m1 is hardly mode" in out) != passes


def test_a_list_with_shapes_of_another_beam_is_known_by_its_frequencies_and_misses_no_mode(told, tmp_path):
    values, hertz = shapes_of(("clamped", "clamped"))
    (tmp_path / "list.csv").write_text("".join(f"{one!r}\n" for one in hertz))
    rows = [",".join(map(repr, map(float, [x, *values[:, i]]))) for i, x in enumerate(X)]
    (tmp_path / "modes.csv").write_text("\n".join(rows) + "\n")
    _, out = told("compare", "held.toml", "list.csv", "--modes", "modes.csv")
    assert out.startswith(
        "Shapes are hardly those of the beam as the scene holds it, that of entry 1 has a MAC of 0.63"
    )
    assert "of a clamped-clamped beam, and the scene's is not held so" in out
    assert "missing" not in out


@pytest.mark.parametrize(("factor", "unit"), [(7.5, False), (5.4, False), (2 * np.pi, True), (2 * np.pi * 1.02, True)])
def test_a_factor_is_a_wrong_unit_where_it_is_one_but_for_a_little_and_else_a_factor(told, tmp_path, factor, unit):
    (tmp_path / "list.csv").write_text("".join(f"{factor * frequency_hz(OWN, n):.9g}\n" for n in range(1, 8)))
    _, out = told("compare", "held.toml", "list.csv", "--count", "20")
    assert ("they are in rad/s" in out) == unit
    exactly = factor == 2 * np.pi
    assert out.startswith(
        "The frequencies are too large by 2 pi" if exactly else f"All frequencies have the common factor {factor:.6g}"
    )


@pytest.mark.parametrize(
    ("supports", "count", "settings"),
    [
        (("pinned", "pinned"), 17, {}),
        (("pinned", "pinned"), 15, {}),
        (("clamped", "clamped"), 16, {"wall": "half"}),
        (("clamped", "free"), 18, {"wall": "half"}),
    ],
)
def test_another_size_is_found_though_the_one_that_is_said_explains_the_list_to_a_thousandth(
    told, tmp_path, supports, count, settings
):
    """They were told to be thick, to have a slip, or to be stiffer than they are."""
    beam = replace(OWN, supports=supports)
    (tmp_path / "held.toml").write_text(SCENE.replace('"clamped", "free"', ", ".join(f'"{one}"' for one in supports)))
    hertz = segment_model.solve_modes(beam, 8, count, **settings).frequencies_hz
    (tmp_path / "list.csv").write_text("".join(f"{one:.8f}\n" for one in hertz))
    _, out = told("compare", "held.toml", "list.csv", "--count", "20")
    assert out.startswith(f"The list is that of {count} parts, not of the 20 that --count says.")
    assert f"With {count} parts it leaves nothing but rounding" in out
