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
    # friction of a mass that the beam carries is limited by mu times its own reaction, in place of mu (m g + preload):
    # converged 1e-4 and 3e-3 of tanh-held, all of coulomb-two-way; its T/100 is 2e-2 to 1.1e-1 from an eighth of it
    "motion/pinned-pinned/coulomb-two-way": 1.1, "motion/losses/coulomb-two-way": 1.1,
    "motion/clamped-pinned/coulomb-two-way": 1.1, "motion/pinned-pinned/tanh-held/rest": 8e-4,
    "motion/losses/tanh-held/rest": 2.5e-3, "motion/clamped-pinned/tanh-held/rest": 9e-3,
    "motion/pinned-pinned/tanh-held/steady": 1.7e-2, "motion/losses/tanh-held/steady": 1.7e-2,
    "motion/clamped-pinned/tanh-held/steady": 3e-2,
    # forces are constant over the step and the surface moves by its exact mean: order 2, at the golden step of T/100
    # 5e-7 to 2e-5 from an eighth of it, golden figures 2e-7 to 2e-5; converged, both agree to 1e-7
    "motion/pinned-pinned/tanh-massless/rest": 6e-6, "motion/losses/tanh-massless/rest": 6e-6,
    "motion/clamped-pinned/tanh-massless/rest": 9e-6, "motion/pinned-pinned/tanh-massless/steady": 9e-7,
    "motion/losses/tanh-massless/steady": 9e-6, "motion/clamped-pinned/tanh-massless/steady": 1.1e-5,
    # acceleration along the slopes by Simpson's rule: 1e-6 to 1e-5 from an eighth of it, golden 4e-7 to 1.2e-5
    "motion/pinned-pinned/following/rest": 1.6e-6, "motion/losses/following": 1.5e-6,
    "motion/clamped-pinned/following/rest": 1.9e-6, "motion/clamped-pinned/following/steady": 1e-5,
    # feet: dashpot, tanh and elastic contact by the mean of the step; from an eighth of the step as far as the golden
    # ones, 1.6e-3 springs, 2.5e-3 give and layer, 7e-5 two-way, 1.9e-3 held speed, 5e-5 hard
    "motor/pinned-pinned/springs": 8e-6, "motor/losses/springs": 8e-6, "motor/pinned-pinned/give": 9e-4,
    "motor/losses/give": 1.2e-3, "motor/pinned-pinned/two-way": 3e-5, "motor/losses/two-way": 3e-5,
    "motor/pinned-pinned/layer": 1.8e-4, "motor/losses/layer": 2.5e-4, "motor/pinned-pinned/hard": 7e-5,
    "motor/losses/hard": 7e-5, "motor/pinned-pinned/held-speed": 5e-6, "motor/losses/held-speed": 4e-6,
    # the same steps on the nonlinear chain: from an eighth of the step 4.1e-4, golden 4.2e-4
    "motor/pinned-pinned/chain": 1.2e-5, "motor/losses/chain": 1.2e-5,
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
