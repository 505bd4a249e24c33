"""The model, quantity, study and engine of CONTRIBUTING.md, registered and as entry points of another package."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.beams import STRIP_TOML
from verify import SegmentModel, load_scene, run_scene
from verify.cli import status_of
from verify.engines.base import ENGINES, chain_of
from verify.linear.registry import MODELS
from verify.quantities.base import QUANTITIES
from verify.studies.base import STUDIES

ROOT = Path(__file__).parents[1]
LINES = re.findall(r"```python\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text("utf-8"), re.DOTALL)[0]
ENTRY_POINTS = """[verify.models]
sines = toys:Sines
lost = no_such_module:Model
[verify.quantities]
toy.weight = toys:weight
[verify.studies]
load = toys:Load
[verify.engines]
Toy = toys:TOY
"""
WEIGHT = 4470.0 * 0.031 * 0.0023 * 0.73  # kg
SCENE = (
    'name = "toy"'
    + STRIP_TOML
    + """[load]
factors = [1.0, 2.5]
[[gate]]
id = "sines-mode-2"
quantity = "mode.frequency_error"
arguments = { model = "sines", mode = 2, count = 11 }
expect = 0.02
within = 1e-9
why = "2 % by construction."
[[gate]]
id = "weight"
quantity = "toy.weight"
arguments = { gravity = 9.0 }
expect = 2.09393127
within = 1e-6
why = "rho b h L g."
"""
)


@pytest.fixture
def toys(monkeypatch):
    toys = {"__name__": "toys"}
    for registry in (MODELS, QUANTITIES, STUDIES, ENGINES):
        monkeypatch.setattr(registry, "_members", dict(registry))
    exec(LINES, toys)
    MODELS.register(toys["Sines"])
    STUDIES.register(toys["Load"])
    ENGINES.register(toys["TOY"])
    return toys


@pytest.fixture
def scene(tmp_path):
    (path := tmp_path / "toy.toml").write_text(SCENE, "utf-8")
    return str(path)


def test_run_includes_registered_extensions(toys, scene):
    result = run_scene(scene)
    assert [gate.passed for gate in result.gates] == [True, True]
    assert result.results["load"].tables[0].rows[1][1] == pytest.approx(2.5 * 9.81 * WEIGHT)


def test_commands_include_registered_extensions(toys, scene, capsys):
    assert status_of(["table", scene, "--study", "convergence", "counts=7,9", "modes=3", "--json"]) == 0
    assert "Sines" in capsys.readouterr().out
    assert status_of(["choose", scene, "--mode", "2", "--error", "3%", "--json"]) == 0
    assert "Sines" in capsys.readouterr().out
    assert status_of(["measure", scene, "toy.weight", "gravity=-1"]) == 2
    assert "gravity" in capsys.readouterr().err


def test_engine_has_the_frequencies_of_the_chain(toys, scene):
    chain = chain_of(load_scene(scene).beam, 13, (), 120.0)
    solved = SegmentModel(load_scene(scene).beam, 13).modes(4).frequencies_hz
    assert toys["Dispersion"]().frequencies(chain)[3] == pytest.approx(solved[3], rel=1e-12)


def test_entry_points_extend_the_command_line(scene, tmp_path, monkeypatch):
    (info := tmp_path / "toys-1.0.dist-info").mkdir()
    (info / "METADATA").write_text("Name: toys\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text(ENTRY_POINTS, "utf-8")
    (tmp_path / "toys.py").write_text(LINES, "utf-8")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{ROOT}")
    command = [sys.executable, "-m", "verify", "run", scene, "--no-report", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["results"]["load"]["tables"][0]["rows"][0]["load"] == pytest.approx(9.81 * WEIGHT)
