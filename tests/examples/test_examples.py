"""Every example runs and ends in the number that it shows; code of the notebooks runs."""

import json
import re
import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
NUMBERS = {
    "paper_figures": ("error_22", -0.0042803, -0.0042802),
    "choose_size": ("sufficient", 42, 42),
    "stepped_cantilever": ("order", 1.99, 2.01),
    "wave_map": ("best.phase_deg", 86.8602, 86.8604),
    "slider_readings": ("speed", -0.0269, -0.0265),
    "motor_curve": ("no_load", -0.0269, -0.0264),
    "whose_frequencies": ("count", 30, 30),
    "export_chain": ("difference", 1e-15, 1e-9),
}


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Run an example and return its names; figures are drawn and closed."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    monkeypatch.setattr(plt, "show", lambda: [plt.figure(n).canvas.draw() for n in plt.get_fignums()])
    monkeypatch.setattr("tempfile.mkdtemp", lambda: str(tmp_path))
    yield lambda path: runpy.run_path(str(path))
    plt.close("all")


def test_every_example_has_a_number():
    assert sorted(NUMBERS) == sorted(path.stem for path in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("name", NUMBERS)
def test_an_example_ends_in_its_number(run, name):
    import matplotlib.pyplot as plt

    path, (variable, low, high) = EXAMPLES / f"{name}.py", NUMBERS[name]
    found = run(path)
    value = found[variable.partition(".")[0]]
    value = value["segments"] if isinstance(value, dict) else getattr(value, variable.partition(".")[2], value)
    assert low <= value <= high
    assert len(plt.get_fignums()) == 1
    assert 20 <= len(path.read_text("utf-8").splitlines()) <= 60
