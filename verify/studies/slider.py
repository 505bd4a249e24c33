"""The slider for a report: its run on three models, what bounds it, and run time against error."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.motion.figures import RUN_FIGURES, Condition, condition_of
from verify.motion.result import Motion, Ride
from verify.scenes.claims import asks_for_turned
from verify.studies.work_precision import Comparison, NotCompared, Work, at_equal_error, run_once, work_of

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

MOST_SAMPLES = 100_000
DRIFT_S = 0.2
"""Seconds of steady wave: long enough for what the start adds once to fade in the mean."""
DRIFT_PERIODS = 1000
"""At most as many: 0.2 s of a drive at megahertz would be another question, and hours."""


class Finding(msgspec.Struct, frozen=True, kw_only=True):
    """One figure of the slider, with how it was found. Nothing is judged."""

    what: str
    found: str


class MotionStudy(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a slider."""

    runs: dict[str, Motion]
    """By model: segment, fem, analytic."""
    conditions: dict[str, Condition]
    figures: dict[str, dict[str, float]]
    """By model and quantity; empty where a run did not reach its end."""
    findings: tuple[Finding, ...]
    work: Work
    answer: Comparison | NotCompared
    count: int


def motion_study(scene: "Scene", progress: Callable[[str], None] = lambda step: None) -> MotionStudy:
    """Run the scene's slider on three models, and weigh work against error. Raises InputError."""
    asked = scene.motion
    assert asked is not None
    runs, conditions, figures = {}, {}, {}
    back = reversed_scene(scene) if asks_for_turned(scene.claim) else None
    for model, count in (("segment", asked.count), ("fem", asked.count), ("analytic", None)):
        progress(f"slider on {model}")
        runs[model] = run_once(scene, model, count, ledger=True, samples=max(asked.samples, every_step(scene)))
        conditions[model] = condition_of(scene, model, count)
        turned = run_once(back, model, count) if back else None
        ended = all(one is None or one.statistics.stopped == "end" for one in (runs[model], turned))
        figures[model] = figures_of(runs[model], turned) if ended else {}
    progress("slider on the steady wave")
    drifts = [_drift(one) for one in (scene, reversed_scene(scene))]
    work = work_of(scene, asked.counts, progress)
    return MotionStudy(
        runs=runs,
        conditions=conditions,
        figures=figures,
        findings=_findings(scene, runs, conditions, drifts),
        work=work,
        answer=at_equal_error(work),
        count=asked.count,
    )


def figures_of(run: "Ride", back: "Ride | None") -> dict[str, float]:
    """All figures of a run, those of the one turned round only where there is one."""
    return {name: one.of(run, back) for name, one in RUN_FIGURES.items() if back is not None or not one.turned}


def every_step(scene: "Scene") -> int:
    """Samples that keep every step of a run and shorten none; fewer of a long one."""
    assert scene.motion is not None
    assert scene.drive is not None
    steps = scene.motion.duration * scene.drive.frequency_hz * scene.motion.steps_per_period
    return int(min(steps, MOST_SAMPLES)) + 2


def reversed_scene(scene: "Scene") -> "Scene":
    """The same scene with every phase turned round, and with it the wave."""
    drive = scene.drive
    assert drive is not None
    forces = tuple(replace(f, phase_deg=-f.phase_deg) for f in drive.force)
    return replace(scene, drive=replace(drive, force=forces), readings=None)


def drift_seconds(scene: "Scene") -> float:
    """Of steady wave: DRIFT_S, or DRIFT_PERIODS of a fast drive."""
    assert scene.drive is not None
    return min(DRIFT_S, DRIFT_PERIODS / scene.drive.frequency_hz)


def _drift(scene: "Scene") -> str:
    """Mean speed over `drift_seconds` of the exact beam's steady wave, which feels no slider; or why there is none."""
    asked = scene.motion
    assert asked is not None
    steady = replace(asked, start="steady", soft_start_periods=0.0, duration=drift_seconds(scene))
    run = run_once(replace(scene, motion=steady, readings=None), "analytic", None, coupling="one-way")
    if run.statistics.stopped != "end":
        return f"none, the slider {run.statistics.stopped} after {run.end.time:.3g} s"
    return f"{1e6 * run.mean_speed:+.4g} µm/s"


def _findings(
    scene: "Scene", runs: dict[str, Motion], conditions: dict[str, Condition], drifts: list[str]
) -> tuple[Finding, ...]:
    slider, chain, exact, how = scene.slider, runs["segment"], runs["analytic"], conditions["segment"]
    assert slider is not None
    coefficient = slider.mu if slider.mu_static is None else slider.mu_static
    limit = coefficient * slider.normal_force
    named = "mu N" if slider.mu_static is None else "mu_static N"
    off = f", {100 * (chain.displacement / exact.displacement - 1):+.3g} % off it" if exact.displacement else ""
    return (
        Finding(
            what=f"mean speed ({how.run_words}, {how.force_words})",
            found=f"{100 * chain.mean_speed:+.3g} cm/s on {chain.count} segments, "
            f"{100 * exact.mean_speed:+.3g} cm/s on the exact beam",
        ),
        Finding(
            what="displacement in that run",
            found=f"{1e9 * chain.displacement:+.4g} nm on {chain.count} segments, {1e9 * exact.displacement:+.4g} "
            f"nm on the exact beam{off}",
        ),
        Finding(
            what="largest friction in that run",
            found=f"{1e3 * float(abs(chain.friction).max()):.4g} mN of {named} = {1e3 * limit:.4g} mN",
        ),
        Finding(
            what=f"mean speed over {drift_seconds(scene):g} s of steady wave ({how.kinematics}, one-way, its "
            "inertia left out, exact beam); phases reversed",
            found="; ".join(drifts),
        ),
        _bound(slider.kinematics, named, limit / slider.mass, how.duration, chain),
    )


def _bound(kinematics: str, named: str, pull: float, duration: float, chain: Motion) -> Finding:
    """What the law alone says of the speed: `pull` is the limit of friction, `named`, over m, m/s^2."""
    what = "what friction alone allows"
    fastest = float(abs(chain.speed - chain.speed[0]).max())
    if kinematics == "tangential":
        found = (
            f"tangential: the mean speed changes by at most {named} t / 2m = {50 * pull * duration:.3g} cm/s; "
            f"largest change of speed {100 * fastest:.3g} cm/s of {named} t / m = {100 * pull * duration:.3g} "
            "cm/s"
        )
    else:
        found = "following: no bound, the turning surface itself pushes the slider"
    return Finding(what=what, found=found)


def thinned(values: "np.ndarray | Sequence[float]", most: int = 1000) -> list[float]:
    """Every so manyth value, for a chart."""
    return [float(v) for v in values[:: max(len(values) // most, 1)]]
