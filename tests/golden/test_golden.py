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

MOVED = {
    # one rule of order 4 for everything attached to a chain, in place of two: bodies and springs on segments
    "modes/bodies/segment": 6e-2, "modes/taut-bodies/segment": 6e-2, "modes/bodies-springs-steps/segment": 5e-4,
    "settings/bodies": 2e-4, "fields/bodies-springs-steps/segment": 3e-2, "modes/springs/segment": 3e-5,
    "buckling/springs/segment": 3e-7,
    # two modes of one frequency, any two of their plane are right
    "modes/ground-free/segment/s": 2.0, "modes/ground-free/fem/s": 2.0,
    # vectors of elements by singular values and not by Lanczos
    "modes/guided-pinned/fem/shape": 3e-10, "modes/stepped-arm/fem/shape": 3e-10, "modes/free-clamped/fem/shape": 3e-10,
}  # fmt: skip
"""Figures that moved for a reason, by the beginning of their names, and how far."""


def test_figures_have_not_moved() -> None:
    now = figures()
    assert sorted(now) == sorted(BEFORE)
    moved = {}
    for name, before in BEFORE.items():
        scale = float(np.abs(before).max()) or 1.0
        difference = float(np.abs(np.subtract(now[name], before)).max()) / scale
        known = [far for beginning, far in MOVED.items() if name.startswith(beginning)]
        if difference > max(known, default=TOLERANCE[name.partition("/")[0]]):
            moved[name] = difference
    assert not moved
