"""Sizes for an error of the tip's path on a moving base, and of a case of known answer."""

import json

import numpy as np
import pytest

import verify
from verify import InputError
from verify.analysis.solution_cache import SolutionCache
from verify.answers import doubling
from verify.cases.beams import CANTILEVER, EI
from verify.cli import status_of
from verify.quantities.blade import Path, path_of
from verify.scene.load import scene_from

ROD = {"length": 0.7, "bending_stiffness": 0.021, "mass_per_length": 1.3, "supports": ["pinned", "free"]}
FALL = {"duration": 0.25, "gravity": [0.4, -6.1]}


def falling(**more):
    return scene_from({"name": "falling", "beam": ROD, "base": FALL | more})


def tip(scene, **options):
    return path_of(scene, SolutionCache(scene.beam), Path(**options))


def off(found, true):
    """Largest distance of two paths (n, 2), over the way of the second."""
    return np.linalg.norm(found - true, axis=1).max() / np.linalg.norm(true - true[0], axis=1).max()


def test_the_sizes_meet_the_error_against_extrapolated_links_and_half_of_them_does_not():
    scene, error = falling(), 4e-3
    few, many = (tip(scene, model="segment", count=n, tolerance=1e-8).tip for n in (40, 80))
    true = many + (many - few) / 3.0
    links, elements, reference = verify.choose(scene, error=error).tables[0].records()
    for model, row in (("segment", links), ("fem", elements)):
        size, tolerance = row["N"], row["tolerance of a step"]
        assert off(tip(scene, model=model, count=size, tolerance=tolerance).tip, true) < 1.1 * error
        assert row["error"] <= error
        assert off(tip(scene, model=model, count=max(size // 2, 1), tolerance=tolerance).tip, true) > 1.1 * error
    assert elements["N"] < links["N"]
    assert reference["N"] > elements["N"]
    assert reference["tolerance of a step"] < elements["tolerance of a step"]


def test_a_case_has_the_sizes_of_both_of_its_models():
    error = 2e-3
    rows = {row["model"]: row for row in verify.choose("elastica-deflection", error=error).tables[0].records()}
    assert set(rows) == {"elastica-deflection", "elastica-elements"}
    count = rows["elastica-deflection"]["N"]
    errors = [verify.bend(CANTILEVER, n, 4.0 * EI).deflection / 0.66996418 - 1.0 for n in (count - 1, count)]
    assert abs(errors[1]) <= error < abs(errors[0])
    assert rows["elastica-elements"]["N"] < count


def test_a_limit_of_time_ends_the_doubling_with_a_sentence(monkeypatch):
    monkeypatch.setattr(doubling, "MINUTE", 0.0)
    with pytest.raises(InputError, match="error"):
        verify.choose(falling(), error=1e-3)
    result = verify.choose("elastica-deflection", error=1e-4)
    assert len(result.warnings) == 2
    assert all(row["error"] > 1e-4 for row in result.tables[0].records())


@pytest.mark.parametrize(
    ("scene", "error", "match"),
    [
        ("steel-cantilever", 0.01, "mode"),
        (CANTILEVER, 0.01, "mode"),
        ("creep-speed", 0.01, "fixed"),
        ("pendulum", 1e-7, "known"),
        (falling(), 1.5, "error"),
        (scene_from({"name": "lossy", "beam": ROD | {"loss_factor": 0.02}, "base": FALL}), 0.01, "loss_factor"),
        ("pendulun", 0.01, "scene"),
    ],
)
def test_what_has_no_path_is_refused(scene, error, match):
    with pytest.raises(InputError, match=match):
        verify.choose(scene, error=error)


def test_the_command_reads_the_base_of_a_scene_and_needs_a_mode_without_one(tmp_path, capsys):
    path = tmp_path / "fall.toml"
    beam = "\n".join(f"{key} = {json.dumps(value)}" for key, value in ROD.items())
    path.write_text(f'name = "fall"\n[beam]\n{beam}\n[base]\nduration = 0.2\ngravity = [0.4, -6.1]\n')
    assert status_of(["choose", str(path), "--error", "2%", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["tables"][0]["rows"]
    assert [row["model"] for row in rows[:2]] == ["links", "nonlinear elements"]
    assert all(row["error"] <= 0.02 for row in rows[:2])
    for words in (["steel-cantilever", "--error", "2%"], [str(path), "wall=half", "--error", "2%"]):
        assert status_of(["choose", *words]) == 2
        assert "mode" in capsys.readouterr().err
