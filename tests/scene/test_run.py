"""A scene run: gates and studies once each, over one solution cache."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import load_scene, run_scene
from verify.errors import InputError
from verify.scene.run import plan

SCENE = """
name = "s"
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
[drive]
frequency_hz = 311
force = [{ position = 0.11, measured_from = "right", amplitude = 2.5 }]
[spectrum]
modes = 3
count = 12
[[gate]]
id = "segments"
quantity = "mode.frequency_error"
arguments = { model = "segment", mode = 3, count = 20 }
expect = -3.6e-5
within = 5e-6
why = "mu^4/1440"
[[gate]]
id = "wrong"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
at_most = 1.0
why = "test"
[[gate]]
id = "too-few"
quantity = "mode.frequency"
arguments = { model = "fem", mode = 40, count = 3 }
at_most = 1.0
why = "test"
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "s.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def run(path):
    steps = []
    return run_scene(path, steps.append), steps


def test_gates_pass_fail_and_cannot_be_evaluated(run):
    result, _ = run
    segments, wrong, too_few = result.gates
    assert segments.passed
    assert segments.value == pytest.approx(-3.609e-5, abs=1e-8)
    assert 0.0 < segments.fraction < 0.1
    assert "lies above 1.0" in wrong.reason
    assert too_few.reason.startswith("cannot be evaluated: mode = 40")
    assert [gate.id for gate in result.failed] == ["wrong", "too-few"]
    assert not result.passed


def test_progress_names_every_step(run):
    _, steps = run
    assert steps[:3] == ["gate segments", "gate wrong", "gate too-few"]
    assert "spectrum" in steps


def test_studies_and_what_is_skipped(run, path):
    result, _ = run
    assert "spectrum" in result.results
    assert result.results["spectrum"].tables[0].rows
    assert {one.what for one in result.skipped} == {row.what for row in plan(path) if not row.runs}
    assert "motor" in {one.what for one in result.skipped}
    assert result.seconds > 0.0


def test_frequency_and_deflection_are_exact(run):
    result, _ = run
    beam, constant = result.scene.beam, result.scene.beam.wave_constant
    k = np.arange(1, 4000) * np.pi / beam.length
    assert result.first_frequency_hz == pytest.approx(k[0] ** 2 * constant / 2.0 / np.pi, rel=1e-12)
    stiffness = beam.mass_per_length * beam.length / 2.0 * ((k**2 * constant) ** 2 - (2.0 * np.pi * 311.0) ** 2)
    x = np.linspace(0.0, beam.length, 201)
    deflection = 2.5 * np.sin(np.outer(x, k)) @ (np.sin(0.62 * k) / stiffness)
    assert result.largest_deflection == pytest.approx(abs(deflection).max(), rel=1e-6)


def test_skipped_gate_neither_passes_nor_fails(path):
    result = run_scene(path, overrides=("beam.length=0.8",))
    assert [gate.passed for gate in result.gates] == [None, None, None]
    assert all("beam.length" in gate.reason for gate in result.gates)
    assert result.gates[1].unit == "Hz"
    assert result.passed


def test_scene_value_runs_like_its_file(path):
    result = run_scene(load_scene(path))
    assert [gate.passed for gate in result.gates] == [True, False, False]


def test_beam_without_a_drive_has_no_deflection(path):
    scene = load_scene(path)
    result = run_scene(replace(scene.bare, drive=None))
    assert result.passed
    assert result.largest_deflection is None
    assert result.results == {}


def test_interrupt_ends_a_run(path):
    def interrupt(step):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_scene(path, interrupt)


def test_unknown_scene_is_refused():
    with pytest.raises(InputError, match="neither a packaged scene nor a file"):
        run_scene("papr-slidr")
