"""Every example runs and ends in the number that it shows; code of the notebooks runs."""

import json
import runpy
import tempfile
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
NUMBERS = {
    "paper_figures": ("error_22", -0.0042803, -0.0042802),
    "choose_size": ("sufficient['segments']", 42, 42),
    "stepped_cantilever": ("order", 1.99, 2.01),
    "wave_map": ("best.phase_deg", 86.8602, 86.8604),
    "slider_readings": ("speed", -0.0269, -0.0265),
    "motor_curve": ("no_load", -0.0269, -0.0264),
    "whose_frequencies": ("count", 30, 30),
    "export_chain": ("difference", 1e-15, 1e-9),
    "catheter_modes": ("error", 2e-5, 1e-4),
    "volts_to_wave": ("ratio", 2.565, 2.566),
}
NOTEBOOKS = {
    "convergence": {"order": (1.99, 2.0), "needed": (218, 218), "error_needed": (9.9e-5, 1e-4)},
    "wave_and_slider": {"law": (1.05635, 1.05637), "chain_best": (4252, 4254), "factor": (10.2, 10.6)},
}


@pytest.fixture
def plt(monkeypatch, tmp_path):
    """Pyplot without a window, and temporary folders of the test."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    monkeypatch.setattr(plt, "show", plt.draw)
    made = tempfile.mkdtemp
    monkeypatch.setattr("tempfile.mkdtemp", lambda **where: made(**where) if where else str(tmp_path))
    yield plt
    plt.close("all")


def test_every_example_has_a_number():
    assert sorted(NUMBERS) == sorted(path.stem for path in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("name", NUMBERS)
def test_an_example_ends_in_its_number(plt, name):
    expression, low, high = NUMBERS[name]
    assert low <= eval(expression, runpy.run_path(str(EXAMPLES / f"{name}.py"))) <= high
    assert len(plt.get_fignums()) == 1


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs_from_top_to_bottom(plt, name):
    known = {}
    for cell in json.loads((EXAMPLES / "notebooks" / f"{name}.ipynb").read_text("utf-8"))["cells"]:
        assert not cell.get("outputs")
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), known)
    for variable, (low, high) in NOTEBOOKS[name].items():
        assert low <= known[variable] <= high, variable
