"""What the rebuilding must not move: 5219 figures written at commit 03331bca (see `figures.py`)."""

import json
from pathlib import Path

import numpy as np

from tests.golden.figures import figures

BEFORE: dict[str, list[float]] = json.loads(Path(__file__).with_name("golden.json").read_text())
TOLERANCE = {
    "modes": 1e-10, "settings": 1e-10, "theories": 1e-10, "buckling": 1e-10, "fields": 1e-8, "waves": 1e-8,
    "motion": 1e-7, "motor": 1e-7, "chain": 1e-9,
}  # fmt: skip
"""Relative to the largest of a group: rounding of solvers whose order of operations may change. Fields lie up to a
thousand times closer to a resonance than 1, and friction turns round at events."""


def test_figures_have_not_moved() -> None:
    now = figures()
    assert sorted(now) == sorted(BEFORE)
    moved = {}
    for name, before in BEFORE.items():
        scale = float(np.abs(before).max()) or 1.0
        difference = float(np.abs(np.subtract(now[name], before)).max()) / scale
        if difference > TOLERANCE[name.partition("/")[0]]:
            moved[name] = difference
    assert not moved
