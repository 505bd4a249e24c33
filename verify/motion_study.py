"""The slider for a report: the paper's Figures 3 and 4 on three models, what Eq. (3) bounds, which readings fit."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.motion import Motion
from verify.work_precision import Comparison, WorkRow, at_equal_error, run_once, work_rows

if TYPE_CHECKING:
    from verify.scene import Scene

PAPER_SPEED = 0.015
"""m/s: the mean speed that the paper reads off its Figure 3."""
DRIFT_S = 0.2
"""Seconds of steady wave: long enough for what the start adds once to fade in the mean."""
DRIFT_PERIODS = 1000
"""At most as many: 0.2 s of a drive at megahertz would be another question, and hours."""
PAPER_FORCE = 2e-3
"""N: the saturation of its Figure 4."""


class Fact(msgspec.Struct, frozen=True, kw_only=True):
    """One statement about the slider, with what was found."""

    what: str
    paper: str
    found: str
    holds: bool | None
    """None where nothing is claimed."""


class MotionStudy(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a slider."""

    runs: dict[str, Motion]
    """By model: segment, fem, analytic."""
    facts: tuple[Fact, ...]
    readings: tuple[Fact, ...]
    work: tuple[WorkRow, ...]
    answer: Comparison | None
    count: int


def motion_study(scene: "Scene", progress: Callable[[str], None] = lambda step: None) -> MotionStudy:
    """Run the scene's slider on three models, examine it, and weigh work against error. Raises InputError."""
    asked = scene.motion
    assert asked is not None
    runs = {}
    for model, count in (("segment", asked.count), ("fem", asked.count), ("analytic", None)):
        progress(f"slider on {model}")
        runs[model] = run_once(scene, model, count, ledger=True, samples=asked.samples)
    progress("slider, phase reversed")
    drifts = [_drift(one) for one in (scene, reversed_scene(scene))]
    facts = _facts(scene, runs, drifts)
    progress("slider, readings of the figures")
    work = work_rows(scene, asked.counts, progress)
    return MotionStudy(runs=runs, facts=facts, readings=_readings(scene), work=work, answer=at_equal_error(work),
                       count=asked.count)  # fmt: skip


def reversed_scene(scene: "Scene") -> "Scene":
    """The same scene with every phase turned round, and with it the wave."""
    drive = scene.drive
    assert drive is not None
    forces = tuple(replace(f, phase_deg=-f.phase_deg) for f in drive.force)
    return replace(scene, drive=replace(drive, force=forces))


def drift_seconds(scene: "Scene") -> float:
    """Of steady wave: DRIFT_S, or DRIFT_PERIODS of a fast drive."""
    assert scene.drive is not None
    return min(DRIFT_S, DRIFT_PERIODS / scene.drive.frequency_hz)


def _drift(scene: "Scene") -> float:
    """Mean speed on the exact beam's steady wave over `drift_seconds`, m/s."""
    asked = scene.motion
    assert asked is not None
    steady = replace(asked, start="steady", soft_start_periods=0.0, duration=drift_seconds(scene))
    return run_once(replace(scene, motion=steady), "analytic", None).mean_speed


def _facts(scene: "Scene", runs: dict[str, Motion], drifts: list[float]) -> tuple[Fact, ...]:
    slider, chain = scene.slider, runs["segment"]
    assert slider is not None
    limit = slider.mu * slider.normal_force
    largest = float(abs(chain.friction).max())
    time = float(chain.times[-1] - chain.times[0])
    bound = 0.5 * limit / slider.mass * time
    fastest = float(abs(chain.speed - chain.speed[0]).max())
    return (
        Fact(what="friction saturates at mu N", paper=f"±{1e3 * PAPER_FORCE:g} mN",
             found=f"largest {1e3 * largest:.4g} mN of {1e3 * limit:.4g} mN", holds=largest <= limit * (1 + 1e-12)),
        Fact(what="reversing the phases reverses the travel", paper="stated",
             found=f"{1e6 * drifts[0]:+.4g} µm/s and {1e6 * drifts[1]:+.4g} µm/s over {drift_seconds(scene):g} s of "
             "steady wave",
             holds=bool(drifts[0] * drifts[1] < 0)),
        Fact(what=f"to the left in the first {1e3 * time:.3g} ms from rest", paper="to the left",
             found=f"{1e9 * chain.displacement:+.4g} nm on {chain.count} segments, "
             f"{1e9 * runs['analytic'].displacement:+.4g} nm on the exact beam, by the way it starts",
             holds=bool(chain.displacement < 0)),
        Fact(what=f"mean speed over {1e3 * time:.3g} ms", paper=f"{-100 * PAPER_SPEED:g} cm/s",
             found=f"{100 * chain.mean_speed:+.3g} cm/s on {chain.count} segments; "
             f"Eq. (3) allows at most {100 * bound:.3g} cm/s from rest",
             holds=abs(chain.mean_speed) >= PAPER_SPEED),
        Fact(what="|dv| <= mu N t / m at every time", paper="follows from Eq. (3)",
             found=f"largest |dv| {100 * fastest:.3g} cm/s of {200 * bound:.3g} cm/s", holds=fastest <= 2.0 * bound),
    )  # fmt: skip


def _readings(scene: "Scene") -> tuple[Fact, ...]:
    """What would have to be otherwise for the paper's mean speed, each run or reckoned."""
    slider, asked = scene.slider, scene.motion
    assert slider is not None
    assert asked is not None
    pressing = slider.normal_force / slider.mass
    mean_mu = 2.0 * PAPER_SPEED / (pressing * asked.duration)
    moving = _mean(replace(scene, slider=replace(slider, speed=-PAPER_SPEED)))
    factor = mean_mu / slider.mu
    pressed = _mean(replace(scene, slider=replace(slider, preload=(factor - 1.0) * slider.mass * slider.gravity)))
    longer = 2.0 * PAPER_SPEED / (slider.mu * pressing)
    return (
        Fact(what="a friction coefficient of", paper="unknown",
             found=f"at least {mean_mu:.3g} (as a final speed {0.5 * mean_mu:.3g})", holds=None),
        Fact(what="a longer time axis", paper="1 ms",
             found=f"at least {1e3 * longer:.3g} ms at mu = {slider.mu:g}, at the limit throughout", holds=None),
        Fact(what=f"pressed on with {factor:.3g} times its weight", paper="weight alone",
             found=f"mean speed {100 * pressed:.3g} cm/s", holds=None),
        Fact(what=f"already moving at {-100 * PAPER_SPEED:g} cm/s", paper="not said",
             found=f"mean speed {100 * moving:.3g} cm/s", holds=None),
    )  # fmt: skip


def _mean(scene: "Scene") -> float:
    assert scene.motion is not None
    return run_once(scene, "segment", scene.motion.count).mean_speed


def thinned(values: "np.ndarray | Sequence[float]", most: int = 1000) -> list[float]:
    """Every so manyth value, for a chart."""
    return [float(v) for v in values[:: max(len(values) // most, 1)]]
