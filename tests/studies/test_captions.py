"""Words under charts say what was found in this scene and no other."""

import re

import numpy as np
import pytest

from verify.scenes.checked import checked
from verify.scenes.scene import scene_type
from verify.studies.axial_figures import axial_study

STRIP = {
    "name": "captions",
    "title": "Pinned strip",
    "beam": {"length": 0.4, "width": 0.015, "thickness": 0.0012, "youngs_modulus": 120e9, "density": 4400.0},
    "drive": {
        "frequency_hz": 900.0,
        "force": [
            {"position": 0.03, "amplitude": 3.0, "phase_deg": 20.0},
            {"position": 0.35, "amplitude": 2.0, "phase_deg": 110.0},
        ],
    },
}


def scene_of(**more):
    return checked(STRIP | more, scene_type())


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def test_chains_are_told_to_lie_off_the_linear_one_by_what_was_found():
    """Next to the resonance of axial waves links that stretch lie farther off than rigid ones."""
    asked = {"count": 12, "forces": [10.0], "shown": 10.0, "duration": 2e-3}
    scene = scene_of(axial_inertia=asked)
    found = axial_study(scene, scene.axial_inertia)
    caption = next(chart for chart in found.charts() if chart.id == "axial-models").caption
    rigid, massless, stretching, divided = map(float, re.findall(r"\d\.\de[+-]\d\d", caption))
    lines = {name: np.array(values) for name, values in found.lines.items()}
    off = {name: rms(lines[name] - lines["linear"]) / rms(lines["linear"]) for name in lines}
    assert [rigid, massless, stretching] == pytest.approx([off[n] for n in ("full", "transverse", "elastic")], rel=0.06)
    assert divided == pytest.approx(rms(lines["linear"] - lines["exact"]) / rms(lines["exact"]), rel=0.06)
    assert stretching > 1.15 * rigid
